"""Whatever a scene's tables hold, loading gives a scene or an InputError."""

import string
from copy import deepcopy

from hypothesis import given, settings
from hypothesis import strategies as st

from verify import InputError
from verify.scene.file import packaged_scenes
from verify.scene.load import scene_from, tables_of
from verify.scene.model import Scene
from verify.scene.schema import sections

KEYS = sorted({key for kind in sections().values() for key in kind.__struct_fields__})
LEAVES = st.one_of(
    st.booleans(),
    st.integers(-5, 10**30),
    st.floats(),
    st.sampled_from(["pinned", "force", "coulomb", "segment", "mode.frequency", "1-5", ""]),
    st.text(string.printable, max_size=5),
)
TREES = st.recursive(
    LEAVES,
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.sampled_from(KEYS), inner, max_size=3),
    max_leaves=8,
)
WHOLE = {name: tables_of(name) for name in packaged_scenes()}


def check(tables):
    """A scene, or sentences on one line each."""
    try:
        assert isinstance(scene_from(tables), Scene)
    except InputError as error:
        assert error.sentences
        assert all(sentence and "\n" not in sentence for sentence in error.sentences)


@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from([*KEYS, *sections()]), TREES, max_size=6))
def test_any_tables_give_a_scene_or_sentences(tables):
    check(tables)


@settings(max_examples=200, deadline=None)
@given(st.data())
def test_packaged_scene_with_changed_values(data):
    """One to three values of a packaged scene replaced, removed or renamed."""
    tables = deepcopy(WHOLE[data.draw(st.sampled_from(sorted(WHOLE)))])
    tables["gate"] = tables["gate"][:3]
    for _ in range(data.draw(st.integers(1, 3))):
        here = tables
        while True:
            key = data.draw(st.sampled_from(sorted(here) if isinstance(here, dict) else range(len(here))))
            if not (isinstance(here[key], dict | list) and here[key]) or data.draw(st.integers(0, 3)) == 0:
                break
            here = here[key]
        if isinstance(here, dict) and data.draw(st.booleans()):
            here[data.draw(st.sampled_from(KEYS))] = here.pop(key)
        else:
            here[key] = data.draw(TREES)
        if not tables:
            break
    check(tables)
