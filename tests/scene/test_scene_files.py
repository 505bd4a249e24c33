"""Scene files: loading, errors, overrides."""

import json

import pytest

from tests.beams import STRIP_TOML
from verify import load_scene
from verify.errors import InputError
from verify.scene.file import STARTER, packaged_scenes, toml_text
from verify.scene.load import scene_from, tables_of
from verify.scene.model import Claim
from verify.scene.run import scene_warnings, skipped_gates
from verify.scene.schema import scene_schema, sections

# --- Loading ---

GATE = """
[[gate]]
id = "g"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 3 }
expect = 1.0
within = 1.0
why = "test"
"""
SCENE = 'name = "s"' + STRIP_TOML + GATE


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
    assert scene_warnings(scene) == ()
    assert scene_from(tables_of(name)) == scene


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
        ("0.73", "'long'", ["beam.length = 'long': give a finite number above 0 (m)"]),
        ("0.73", "'73cm'", ["beam.length = '73cm': give a number alone, in SI units: 0.08 for 80 mm"]),
        ("0.73", "[0, 73]", ["beam.length = [0, 73]: give one number, with a point before its decimals"]),
        ("0.73", "1" + 400 * "0", ["beam.length = a whole number of 1329 bits: give a finite number above 0 (m)"]),
        ("length = 0.73", "", ["beam.length is missing: give it a value"]),
        ('id = "g"', "", ["gate[0].id is missing: give it a value"]),
        ("mode.frequency", "mode.frequncy", ["gate.g: quantity = 'mode.frequncy' is not known: did you mean 'mode.frequency'?"]),
    ],
)  # fmt: skip
def test_error_sentence_names_field_value_and_remedy(tmp_path, old, new, sentences):
    assert errors(tmp_path, SCENE.replace(old, new, 1)) == sentences


def test_a_kind_that_is_no_word_is_not_known(tmp_path):
    found = errors(tmp_path, SCENE + DRIVE + "[drive.actuator]\nkind = []\n")
    assert any(sentence.startswith("drive.actuator.kind = [] is not known") for sentence in found)


def test_unreadable_files_are_refused(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path, tmp_path / "no" / "folder.toml"):
        with pytest.raises(InputError, match=r"does not exist|folder"):
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


def test_gate_on_a_signed_error_without_a_lower_limit_is_warned_about(tmp_path):
    gate = '[[gate]]\nid = "e"\nquantity = "mode.frequency_error"\nwhy = "w"\nat_most = 0.01\n'
    text = SCENE + gate + 'arguments = { model = "segment", mode = 2, count = 9 }\n'
    assert ["accepts any negative" in one for one in scene_warnings(scene_of(tmp_path, text))] == [True]
    assert scene_warnings(scene_of(tmp_path, text + "at_least = -0.01\n")) == ()


def test_schema_describes_every_key():
    schema = scene_schema()
    json.dumps(schema)
    assert schema["properties"]["beam"]["allOf"] == [{"$ref": "#/$defs/Beam"}]
    assert {"spectrum", "motor", "sweep"} <= set(schema["properties"])
    assert "studies" not in schema["properties"]
    for name, kind in sections().items():
        for key, own in scene_schema(name)["properties"].items():
            assert own.get("description") or "$ref" in own, (name, key, kind)
    assert scene_schema("beam.mass")["properties"]["rotary_inertia"]["description"].startswith(
        "Rotary inertia about the fixing"
    )
    assert "mode.frequency" in schema["$defs"]["Gate"]["properties"]["quantity"]["enum"]
    with pytest.raises(InputError, match="did you mean 'beam'"):
        scene_schema("baem")


# --- Overrides ---

SCENE_OVERRIDES = f"""
name = "s"{STRIP_TOML}
[drive]
frequency_hz = 310
force = [{{ position = 0.11 }}, {{ position = 0.52, phase_deg = 70 }}]
[slider]
mass = 0.0031
mu = 0.17
slope = 310.0
[[gate]]
id = "frequency"
quantity = "mode.frequency"
arguments = {{ model = "analytic", mode = 3 }}
expect = 96.0
within = 1.0
reference = "closed form"
why = "test"
[[gate]]
id = "wave"
quantity = "wave.standing_wave_ratio"
at_least = 1.0
why = "test"
"""


@pytest.fixture
def path(tmp_path):
    (tmp_path / "s.toml").write_text(SCENE_OVERRIDES)
    return tmp_path / "s.toml"


@pytest.mark.parametrize(
    ("assignment", "read"),
    [
        ("beam.length=0.8", lambda s: s.beam.length == 0.8),
        ("beam.supports=pinned,free", lambda s: s.beam.supports == ("pinned", "free")),
        ('beam.supports=["free", "guided"]', lambda s: s.beam.supports == ("free", "guided")),
        ("beam.loss_factor=2%", lambda s: s.beam.loss_factor == 0.02),
        ("beam.thickness=.002", lambda s: s.beam.thickness == 0.002),
        ("gate.frequency.within=0.25", lambda s: s.gate[0].within == 0.25),
        ("gate.1.at_least=0.25", lambda s: s.gate[1].at_least == 0.25),
        ("drive.force.1.phase_deg=-70", lambda s: s.forces[1].phase_deg == -70.0),
        ("spectrum.count=31", lambda s: s.studies["spectrum"].count == 31),
        ("convergence.counts=10-30:10", lambda s: s.studies["convergence"].counts == (10, 20, 30)),
        ("convergence.modes=1-3,7", lambda s: s.studies["convergence"].modes == (1, 2, 3, 7)),
        ("convergence.modes=4", lambda s: s.studies["convergence"].modes == (4,)),
        ("title=A strip", lambda s: s.title == "A strip"),
        ("motion.duration=0.3ms", lambda s: s.motion.duration == pytest.approx(3e-4, rel=1e-14)),
        ("beam.length=23 in", lambda s: s.beam.length == pytest.approx(0.5842, rel=1e-14)),
        ("beam.youngs_modulus=69GPa", lambda s: s.beam.youngs_modulus == pytest.approx(6.9e10, rel=1e-14)),
        ("drive.frequency_hz=0.31kHz", lambda s: s.drive.frequency_hz == pytest.approx(310.0, rel=1e-14)),
        ("slider.law=coulomb", lambda s: (s.slider.slope, s.slider.mu) == (None, 0.17)),
        ("gate.frequency.expect=97", lambda s: s.gate[0].reference is None),
    ],
)
def test_override_reaches_its_value(path, assignment, read):
    assert read(load_scene(path, (assignment,)))


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("beam.lenght=0.4", r"^beam\.lenght is not a known key: did you mean 'length'\?$"),
        ("baem.length=0.4", r"^baem is not a known key: did you mean 'beam'\?$"),
        ("beam.length=80hm", r"beam\.length = '80hm': give a number with one of the units m, cm, mm"),
        ("beam.tension=3mm", r"beam\.tension = '3mm': give a number with one of the units N, mN, kN"),
        ("beam.foundation=3kN", r"beam\.foundation = '3kN': give a number alone, in N/m"),
        ("beam.length=2%", r"beam\.length = '2%': give a finite number"),
        ("beam.supports=cantilever", r"beam\.supports = 'cantilever': give a list"),
        ("beam.length.x=1", r"--set beam\.length is a value, not a table"),
        ("gate.wvae.at_least=1", r"--set gate\.wvae is no entry of the list: did you mean 'wave'"),
        ("drive.force.position=0.1", r"--set drive\.force\.position is no entry of the list: known are 0, 1"),
        ("drive.force.2.position=0.1", r"--set drive\.force\.2 is no entry"),
        ("gate.frequency.within=0", r"gate\.frequency\.within = 0\.0: give it above 0"),
        ("gate.frequency.arguments.mode=0", r"gate\.frequency: mode = 0: give a whole number of at least 1"),
        ("spectrum.count=4.5", r"spectrum\.count = 4\.5: give a whole number"),
        ("convergence.counts=[]", r"convergence\.counts = \[\]: give a list"),
        ("convergence.counts=30-10", r"convergence\.counts = '30-10': write a range upwards"),
        ("convergence.counts=1-999999999", "at most 10000 numbers"),
        ("studies.spectrum.count=3", "studies is not a known key"),
        ("length", "is not an assignment"),
        ("=3", "is not an assignment"),
        ("beam.length=", "is not an assignment"),
        ("slider.law=coulomb slope=3", "slider.law"),
    ],
)
def test_wrong_override_is_refused(path, assignment, message):
    with pytest.raises(InputError, match=message) as caught:
        load_scene(path, (assignment,))
    assert "\n" not in str(caught.value)


def test_key_is_set_once(path):
    with pytest.raises(InputError, match=r"--set beam\.length occurs twice: set it once"):
        load_scene(path, ("beam.length=0.4", "beam.width=0.013", " beam.length = 0.7"))


@pytest.mark.parametrize("overrides", ["beam.length=0.4", 3, (3,), None, {"beam.length": 0.4}])
def test_overrides_are_a_list_of_words(overrides):
    with pytest.raises(InputError, match="give a list of 'key=value' words"):
        load_scene("paper", overrides)


def test_tables_with_overrides_are_written_as_toml(path, tmp_path):
    written = tmp_path / "written.toml"
    written.write_text(toml_text(tables_of(path, ("beam.length=0.9",))))
    assert load_scene(written) == load_scene(path, ("beam.length=0.9",))


def skipped(path, *overrides):
    return skipped_gates(load_scene(path, overrides), overrides)


def test_gate_of_another_system_is_skipped(path):
    both = skipped(path, "beam.length=0.8")
    assert both == dict.fromkeys(("frequency", "wave"), "stated for other values: --set beam.length")
    assert list(skipped(path, "drive.frequency_hz=311")) == ["wave"]
    assert skipped(path, "slider.mass=0.1") == {}
    assert skipped(path, "gate.frequency.arguments.mode=4") == {
        "frequency": "stated for other values: --set gate.frequency.arguments.mode"
    }


def test_gate_applies_to_a_new_band(path):
    assert list(skipped(path, "beam.length=0.8", "gate.frequency.expect=80")) == ["wave"]
    assert list(skipped(path, "beam.length=0.8", "gate.frequency.within=0.5")) == ["frequency", "wave"]
    assert list(skipped(path, "beam.length=0.8", "gate.0.expect=96.0")) == ["wave"]
