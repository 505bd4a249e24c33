"""What many rooms speak of has one name in one place."""

import ast
from typing import get_args

import pytest
from sources import PACKAGE, nodes_of, paths, tree_of

from verify import options

LISTS = {name: get_args(kind) for name, kind in vars(options).items() if len(get_args(kind)) > 1}


def literals(path):
    """The words of every Literal written out in a file."""
    for node in nodes_of(path):
        if isinstance(node, ast.Subscript) and getattr(node.value, "id", "") == "Literal":
            parts = node.slice.elts if isinstance(node.slice, ast.Tuple) else [node.slice]
            yield tuple(part.value for part in parts)


def test_words_to_choose_from_are_listed_once():
    stated = {tuple(sorted(words)) for words in LISTS.values()}
    for path in paths():
        if path.name != "options.py":
            assert not stated & {tuple(sorted(words)) for words in literals(path)}, path


@pytest.mark.parametrize("name", LISTS)
def test_every_list_says_in_one_breath_what_its_words_mean(name):
    nodes = tree_of(PACKAGE / "options.py").body
    at = next(i for i, node in enumerate(nodes) if getattr(getattr(node, "targets", [None])[0], "id", "") == name)
    said = next(node.value.value for node in nodes[at:] if isinstance(node, ast.Expr))
    assert [word for word in LISTS[name] if f"{word}:" not in said] == []


def test_arrays_have_their_names_from_one_module():
    named = {str(path.relative_to(PACKAGE)) for path in paths() if "NDArray" in path.read_text("utf-8")}
    assert named == {"models/arrays.py", "asleep.py"}  # which stands in for the module that has them


SETTLED = {
    "attachment": "'reciprocal'",
    "axial_inertia": "True",
    "derivative": "0",
    "epsilon": "0.0",
    "frozen": "False",
    "gates_only": "False",
    "grading": "1.0",
    "immovable": "False",
    "joint_dashpot": "0.0",
    "joints": "'series'",
    "patient": "True",
    "settings": "()",
    "soft_start_periods": "0.0",
    "support": "'pinned'",
    "theory": "'euler-bernoulli'",
    "turning": "False",
}
"""What a verb takes where nobody says."""


def default_values(node):
    """(name, default as written) of what a function takes without being given."""
    given, named = node.args.posonlyargs + node.args.args, node.args.kwonlyargs
    written = [None] * (len(given) - len(node.args.defaults)) + node.args.defaults + node.args.kw_defaults
    return [(arg.arg, ast.unparse(one)) for arg, one in zip(given + named, written, strict=True) if one]


def test_what_nobody_says_is_the_same_to_every_verb():
    """The same beam by two verbs is else two beams; of the suite's own references some are of one theory by name."""
    seen = set()
    for path in paths():
        if "stress" not in path.parts:
            for node in nodes_of(path):
                for name, value in default_values(node) if isinstance(node, ast.FunctionDef) else ():
                    one = value.replace("EULER", SETTLED["theory"])
                    assert one == SETTLED.get(name, one), f"{path}:{node.lineno} {node.name}: {name} = {value}"
                    seen.add(name)
    assert seen >= SETTLED.keys()
