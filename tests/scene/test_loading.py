"""Scene files: what they hold, and every error of a file at once."""

import json

import pytest

from verify import load_scene
from verify.errors import InputError
from verify.scene.load import STARTER, copy_with_name, packaged_scenes, read_text, scene_from, tables_of
from verify.scene.model import Claim
from verify.scene.schema import scene_schema, sections
from verify.scene.warnings import unit_warnings

BEAM = """
[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470
"""
GATE = """
[[gate]]
id = "g"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 3 }
expect = 1.0
within = 1.0
why = "test"
"""
SCENE = 'name = "s"' + BEAM + GATE


def scene_of(tmp_path, text, *overrides):
    path = tmp_path / "s.toml"
    path.write_text(text, encoding="utf-8")
    return load_scene(path, overrides)


def errors(tmp_path, text):
    """The sentences with which a scene is refused."""
    with pytest.raises(InputError) as caught:
        scene_of(tmp_path, text)
    return list(caught.value.sentences)


@pytest.mark.parametrize("name", [*packaged_scenes(), str(STARTER)])
def test_packaged_scene_loads(name):
    scene = load_scene(name)
    assert scene.gate
    assert scene.title
    assert all(gate.reference for gate in scene.gate) or name == str(STARTER)
    assert unit_warnings(scene) == ()
    assert scene_from(tables_of(name)) == scene


def test_numbers_are_floats_and_studies_their_own_types(tmp_path):
    scene = scene_of(tmp_path, SCENE + "[spectrum]\nmodes = 7\n[motion]\nduration = 0.02\n" + DRIVE)
    assert isinstance(scene.beam.density, float)
    assert scene.studies["spectrum"].modes == 7
    assert scene.motion.duration == 0.02
    assert scene.bare.studies == {}
    assert scene.bare.gate == ()
    assert scene.bare.forces == scene.forces


DRIVE = "[drive]\nfrequency_hz = 310\nforce = [{ position = 0.11, measured_from = 'right', amplitude = 2 }]\n"


def test_force_measured_from_the_right_follows_the_length(tmp_path):
    for length in (0.73, 0.4):
        (force,) = scene_of(tmp_path, SCENE + DRIVE, f"beam.length={length}").forces
        assert force.position == pytest.approx(length - 0.11, rel=1e-15)
        assert force.amplitude == 2.0


def test_device_measured_from_the_right(tmp_path):
    device = "[[drive.device]]\nposition = 0.08\nmeasured_from = 'right'\ndashpot = 3.5\n"
    (found,) = scene_of(tmp_path, SCENE + DRIVE + device).devices
    assert (found.position, found.dashpot) == (pytest.approx(0.65), 3.5)
    with pytest.raises(InputError, match=r"drive\.device: \[spectrum\] does not model it"):
        scene_of(tmp_path, SCENE + DRIVE + device + "[spectrum]\n")


def test_byte_order_mark_and_line_ends_are_ignored(tmp_path):
    path = tmp_path / "s.toml"
    path.write_bytes(b"\xef\xbb\xbf" + SCENE.replace("\n", "\r\n").encode())
    assert load_scene(path).name == "s"


def test_every_error_of_a_file_is_listed(tmp_path):
    text = SCENE.replace("width", "widht").replace("mode = 3 }", "mod = 3 }").replace("expect", "expct")
    text = "colour = 'red'\n" + text + "[spectrum]\nmodes = 0\n[convergence]\ncounts = 'x'\n"
    assert [sentence.split(" = ")[0].split(":")[0] for sentence in errors(tmp_path, text)] == [
        "colour is not a known key",
        "spectrum.modes",
        "convergence.counts",
        "beam.widht is not a known key",
        "gate.g.expct is not a known key",
        "gate.g",
    ]


@pytest.mark.parametrize(
    ("old", "new", "sentences"),
    [
        ("0.73", "'long'", ["beam.length = 'long': give a number"]),
        ("0.73", "'73cm'", ["beam.length = '73cm': give a number alone, in SI units: 0.08 for 80 mm"]),
        ("0.73", "[0, 73]", ["beam.length = [0, 73]: give one number, with a point before its decimals"]),
        ("0.73", "1" + 400 * "0", ["beam.length = a whole number of 1329 bits: write a large number as 1e30"]),
        ("length", "lenght", ["beam.lenght is not a known key: did you mean 'length'?"]),
        ("length = 0.73", "", ["beam.length is missing: give it a value"]),
        ('id = "g"', "", ["gate[0].id is missing: give it a value"]),
        (GATE, GATE + GATE, ["gate.g occurs twice: give every gate its own id"]),
        (
            "density = 4470",
            "density = 4470\nsupports = ['pinned', 'fre']",
            ["beam.supports[1] = 'fre': it is not known, did you mean 'free'?"],
        ),
        ("mode.frequency", "mode.frequncy", ["gate.g: quantity = 'mode.frequncy' is not known: did you mean 'mode.frequency'?"]),
    ],
)  # fmt: skip
def test_error_sentence_names_field_value_and_remedy(tmp_path, old, new, sentences):
    assert errors(tmp_path, SCENE.replace(old, new, 1)) == sentences


def test_parts_that_do_not_fit_together_are_listed(tmp_path):
    text = SCENE + GATE + "[drive]\nfrequency_hz = 90.0\nforce = [{ position = 0.74 }]\n"
    assert errors(tmp_path, text) == [
        "gate.g occurs twice: give every gate its own id",
        "drive.force.position = 0.74 lies off the beam: give a position between 0 and 0.73 m",
    ]


def test_long_list_of_errors_is_cut(tmp_path):
    wrong = "".join(GATE.replace('"g"', f'"g{i}"').replace("within", "withn") for i in range(44))
    found = errors(tmp_path, SCENE + wrong)
    assert len(found) == 31
    assert found[-1] == "and 14 more"


def test_unreadable_files_are_refused(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path, tmp_path / "no" / "folder.toml"):
        with pytest.raises(InputError, match="cannot be read"):
            load_scene(path)
    (tmp_path / "b.toml").write_bytes(b"\xff\xfe\x00name")
    with pytest.raises(InputError, match="UTF-8"):
        load_scene(tmp_path / "b.toml")
    (tmp_path / "c.toml").write_text("name = ")
    with pytest.raises(InputError, match="is not TOML"):
        load_scene(tmp_path / "c.toml")
    with pytest.raises(InputError, match="did you mean 'paper'"):
        load_scene("papr")


def test_claim_agrees_within_its_tolerance():
    claim = {"id": "c", "source": "a paper", "quantity": "slider.mean_speed", "read": "stated"}
    number = Claim(**claim, value=-0.015, tolerance=5e-4)
    assert number.agrees(-0.0154)
    assert not number.agrees(-0.0156)
    assert not number.agrees(float("nan"))
    assert Claim(**claim, value="negative").agrees(-1e-9)
    assert not Claim(**claim, value="positive").agrees(-1e-9)
    assert Claim(**claim, at_least=0.02).agrees(0.03)
    assert not Claim(**claim, at_least=0.02, at_most=0.025).agrees(0.03)


def test_copy_keeps_comments_under_another_name():
    text = read_text(STARTER)
    copied = copy_with_name(text, "mine")
    assert copied == text.replace('name = "my-beam"', 'name = "mine"')
    assert copy_with_name("name = 'a'  # own\n", "b").startswith('#:schema ./verify.schema.json\nname = "b"  # own')


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("113e9", "113", "speed of sound"),
        ("4470", "4.47e6", "above that of any solid"),
        ("0.0023", "2.3", "m thick and"),
        ("width = 0.031", "width = 31", "m wide and"),
        ("length = 0.73", "length = 730", "its own weight bends it"),
        ("length = 0.73\nwidth = 0.031\nthickness = 0.0023", "length = 730\nwidth = 31\nthickness = 2.3", "a mass of"),
    ],
)
def test_other_units_are_warned_about(tmp_path, old, new, words):
    text = SCENE.replace(old, new)
    if words == "above that of any solid":
        text = text.replace("113e9", "113e12")
    (warning,) = unit_warnings(scene_of(tmp_path, text))
    assert words in warning


def test_schema_describes_every_key():
    schema = scene_schema()
    json.dumps(schema)
    assert schema["properties"]["beam"]["allOf"] == [{"$ref": "#/$defs/Beam"}]
    assert {"spectrum", "motor", "sweep"} <= set(schema["properties"])
    assert "studies" not in schema["properties"]
    for name, kind in sections().items():
        for key, own in scene_schema(name)["properties"].items():
            assert own.get("description") or "$ref" in own, (name, key, kind)
    assert scene_schema("beam.mass")["properties"]["rotary_inertia"]["description"].startswith("About the fixing")
    assert "mode.frequency" in schema["$defs"]["Gate"]["properties"]["quantity"]["enum"]
    with pytest.raises(InputError, match="did you mean 'beam'"):
        scene_schema("baem")
