"""What is typed: ranges where whole numbers are listed, per cents where a number is relative, TOML written and read."""

import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from verify.errors import InputError
from verify.quantities.catalogue import arguments_of, quantity
from verify.report.plain import mode_numbers
from verify.scenes.given import fraction, type_at_key, whole_numbers
from verify.scenes.scene import load_scene, packaged_scenes, scene_path, scene_type
from verify.scenes.toml import literal, read_text, read_toml
from verify.scenes.writing import renamed, toml_text


@pytest.mark.parametrize(
    ("text", "numbers"),
    [
        ("1-5", [1, 2, 3, 4, 5]),
        ("1-3,7", [1, 2, 3, 7]),
        ("10-50:10", [10, 20, 30, 40, 50]),
        ("10-48:15, 100", [10, 25, 40, 100]),
        ("7-7", [7]),
        ("1,5,22", [1, 5, 22]),
        ("12", 12),
    ],
)
def test_a_range_is_the_numbers_from_its_start_up_to_its_end(text, numbers):
    assert whole_numbers(literal(text), "counts") == numbers


@pytest.mark.parametrize("text", ["5-1", "3-9:0", "1-99999", "1-999999999999999999"])
def test_a_range_that_is_empty_or_endless_is_one_sentence(text):
    with pytest.raises(InputError, match=f"counts = '{text}' is "):
        whole_numbers(literal(text), "counts")


def test_what_is_no_range_is_left_to_the_type_to_refuse():
    assert whole_numbers(["a-b", 3], "counts") == ["a-b", 3]
    assert whole_numbers("1.5-3", "counts") == "1.5-3"


@pytest.mark.parametrize(("text", "value"), [("0.1%", 0.001), ("25 %", 0.25), ("x%", "x%"), (0.02, 0.02)])
def test_a_per_cent_is_a_hundredth(text, value):
    assert fraction(text) == value


def test_ranges_and_per_cents_reach_what_they_are_set_for():
    scene = load_scene(
        "paper",
        (
            "convergence.modes=2-4,9",
            "convergence.counts=10-50:20",
            "beam.loss_factor=0.4%",
            "gate.segment-mode-22.within=1%",
        ),
    )
    assert (scene.convergence.modes, scene.convergence.counts) == ((2, 3, 4, 9), (10, 30, 50))
    assert scene.beam.loss_factor == 0.004
    assert next(gate for gate in scene.gate if gate.id == "segment-mode-22").within == 0.01


def test_a_size_in_metres_is_no_per_cent_and_a_title_may_look_like_a_range():
    with pytest.raises(InputError, match=r"beam\.length = '40%': give a number"):
        load_scene("paper", ("beam.length=40%",))
    assert load_scene("paper", ("title=1-5",)).title == "1-5"


def test_the_arguments_of_a_quantity_take_them_too():
    order = arguments_of(quantity("mode.order"), {"model": "fem", "mode": 5, "counts": "20-60:20"})
    assert order.counts == (20, 40, 60)
    needed = arguments_of(quantity("mode.count_needed"), {"model": "fem", "mode": 5, "error": "0.1%"})
    assert needed.error == 0.001
    with pytest.raises(InputError, match="mode = '5%'"):
        arguments_of(quantity("mode.count_needed"), {"model": "fem", "mode": "5%", "error": 0.1})


def test_a_key_that_there_is_not_has_no_type():
    assert type_at_key(scene_type(), "beam.sections.0.length") is None
    assert type_at_key(scene_type(), "beam.section.0.length") is float


@pytest.mark.parametrize("scene", packaged_scenes())
def test_a_scene_written_as_toml_is_read_as_it_was(scene):
    data = read_toml(scene_path(scene))
    assert tomllib.loads(toml_text(data)) == data


VALUES = st.recursive(
    st.one_of(
        st.booleans(),
        st.integers(-(2**63), 2**63 - 1),
        st.floats(allow_nan=False),
        st.text(st.characters(exclude_categories=["Cs"])),
    ),
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.text('ab -."é', max_size=3), inner, max_size=3)
    ),
    max_leaves=8,
)


@given(st.dictionaries(st.text("abc-_. é", max_size=4), VALUES, max_size=4))
def test_any_tables_written_as_toml_are_read_as_they_were(data):
    assert tomllib.loads(toml_text(data)) == data


def test_what_a_terminal_would_obey_is_written_by_its_number():
    r"""A title as its file has it, `\u202egnp`, turned the line of `verify show` round."""
    data = {"title": "a\u202egnp\x7f\x9b2J\u2028", "beam": {"\u200b": "é²\U0001f600"}}
    text = toml_text(data)
    assert tomllib.loads(text) == data
    assert all(c.isprintable() or c == "\n" for c in text)
    assert "é²\U0001f600" in text


def test_a_copied_scene_keeps_its_comments_under_another_name():
    own = read_text(scene_path("steel-cantilever"))
    copy = renamed(own, "mine")
    assert tomllib.loads(copy) == {**tomllib.loads(own), "name": "mine"}
    assert [line for line in own.splitlines() if "#" in line] == [
        line for line in copy.splitlines() if "#" in line and not line.startswith("#:schema")
    ]


def test_a_name_inside_a_table_is_not_the_scenes():
    with pytest.raises(InputError, match="no name on a line of its own"):
        renamed("[beam]\nname = 'x'\n", "mine")


def test_a_model_that_is_missing_is_told_with_those_there_are():
    with pytest.raises(InputError, match=r"^model is missing: give one of analytic, fem, segment"):
        arguments_of(quantity("mode.frequency"), {"mode": 3})
    with pytest.raises(InputError, match=r"^modell is not a known key: did you mean 'model'"):
        arguments_of(quantity("mode.frequency"), {"mode": 3, "modell": "fem"})
    assert arguments_of(quantity("wave.reflection"), {}).model == "analytic"


def test_several_modes_are_a_range():
    assert mode_numbers("2-4") == range(2, 5)
    with pytest.raises(InputError, match=r"^mode = '1,3': give one mode, or all from one to another, as 1-12"):
        mode_numbers("1,3")
