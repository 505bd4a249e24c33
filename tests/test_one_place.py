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
