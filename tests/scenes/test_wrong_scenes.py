"""All that is wrong with a scene is said at once, a sentence for each, gates by their ids."""

import pytest

from verify.errors import InputError, WrongSceneError
from verify.scenes.scene import load_scene

SCENE = """
name = "s"
[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470
"""


def wrong(tmp_path, text):
    """The sentences with which a scene is refused."""
    path = tmp_path / "s.toml"
    path.write_text(text)
    with pytest.raises(InputError) as caught:
        load_scene(path)
    return list(caught.value.sentences)


def gate(name, rest="expect = 1.0\nwithin = 0.25"):
    return f'[[gate]]\nid = "{name}"\nquantity = "mode.frequency"\nwhy = "w"\n{rest}\n'


def test_every_section_and_every_gate_is_named_at_once(tmp_path):
    text = SCENE.replace("width", "widht") + "[spectrum]\nmodes = 0\n[wave]\ncount = 'x'\n"
    text += (
        gate("fine")
        + gate("loose", "expect = 1.0")
        + gate("none", "at_least = 2\nat_most = 1")
        + gate("odd", "xpct = 3")
    )
    assert [sentence.partition(":")[0] for sentence in wrong(tmp_path, text)] == [
        "beam.widht is not a known key",
        "spectrum.modes = 0",
        "wave.count = 'x'",
        "gate.none.at_least = 2.0 is above at_most = 1.0",
        "gate.odd.xpct is not a known key",
    ]


def test_two_things_wrong_in_one_section_are_two_sentences(tmp_path):
    text = SCENE.replace("0.73", "'long'").replace("113e9", "true")
    assert wrong(tmp_path, text) == [
        "beam.length = 'long': give a number",
        "beam.youngs_modulus = True: give a number",
    ]


def test_parts_that_do_not_go_together_are_all_named(tmp_path):
    text = SCENE + "[drive]\nfrequency_hz = 90.0\nforce = [{ position = 0.74 }]\n" + gate("twice") + gate("twice")
    assert wrong(tmp_path, text) == [
        "gate.twice stands twice: give every gate an id of its own",
        "drive.force.position = 0.74 lies off the beam: give a position between 0 and 0.73 m",
    ]


def test_steps_of_a_slider_that_is_not_there_are_refused(tmp_path):
    """They were dropped without a word: a beam alone is known in closed form."""
    driven = SCENE + "[drive]\nfrequency_hz = 90.0\nforce = [{ position = 0.21 }]\n[motion]\nsteps_per_period = 37\n"
    assert wrong(tmp_path, driven) == [
        "motion.steps_per_period = 37 is a slider's and the scene has none: a beam alone takes no steps, leave it out "
        "or add [slider]"
    ]
    ridden = tmp_path / "ridden.toml"
    ridden.write_text(driven + "[slider]\nmass = 1e-3\nmu = 0.2\n")
    assert load_scene(ridden).motion.steps_per_period == 37


def test_a_gate_without_an_id_is_named_by_its_place(tmp_path):
    found = wrong(tmp_path, SCENE + gate("first") + gate("x").replace('id = "x"\n', ""))
    assert found == ["gate[1].id is missing: give it a value"]


def test_a_misspelt_key_is_not_called_missing_as_well(tmp_path):
    assert wrong(tmp_path, SCENE.replace("length", "lenght")) == [
        "beam.lenght is not a known key: did you mean 'length'?"
    ]


def test_one_thing_wrong_is_a_plain_error_with_its_sentence_alone(tmp_path):
    with pytest.raises(InputError) as caught:
        load_scene("paper", ("spectrum.count=0",))
    assert type(caught.value) is InputError
    assert caught.value.sentences == (str(caught.value),) == ("spectrum.count = 0: give a whole number >= 1",)


def test_more_than_anybody_reads_is_counted(tmp_path):
    found = wrong(tmp_path, SCENE + "".join(gate(f"g{i}", "expct = 1") for i in range(44)))
    assert len(found) == 31
    assert found[0] == "gate.g0.expct is not a known key: did you mean 'expect'?"
    assert found[-1] == "and 14 more"


def test_overrides_that_name_nothing_are_all_named():
    with pytest.raises(WrongSceneError) as caught:
        load_scene("paper", ("gate.nobody.within=1", "beam.length.x=2"))
    assert [sentence.split(" is ")[0].split(" names ")[0] for sentence in caught.value.sentences] == [
        "--set gate.nobody",
        "--set beam.length",
    ]


@pytest.mark.parametrize("gates", ["[{}]", "[3]", '["id"]', "{}"])
def test_gates_that_are_none_are_refused_whatever_is_set_of_them(gates):
    with pytest.raises(InputError, match="gate"):
        load_scene("paper", ("gate.0.expect=1.3", f"gate={gates}"))
