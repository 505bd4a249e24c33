"""`--set key=value`: what it reaches, what it refuses, and which gates it makes void."""

import pytest

from verify import load_scene
from verify.convert import literal
from verify.errors import InputError
from verify.scene.load import tables_of, toml_text
from verify.scene.run import effective_overrides, plan, skipped_gates

SCENE = """
name = "s"
[beam]
length = 0.73
width = 0.031
thickness = 0.0023
youngs_modulus = 113e9
density = 4470
[drive]
frequency_hz = 310
force = [{ position = 0.11 }, { position = 0.52, phase_deg = 70 }]
[slider]
mass = 0.0031
mu = 0.17
slope = 310.0
[[gate]]
id = "frequency"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 3 }
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
    (tmp_path / "s.toml").write_text(SCENE)
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
        ("beam.length=long", r"beam\.length = 'long': give a number"),
        ("beam.length=80cm", r"beam\.length = '80cm': give a number alone, in SI units"),
        ("beam.length=2%", r"beam\.length = '2%': give a number"),
        ("beam.length=0,4", r"beam\.length = \[0, 4\]: give one number, with a point"),
        ("beam.length=-1", r"beam\.length = -1\.0: give a finite number above 0"),
        ("beam.length=nan", r"beam\.length = nan: give a finite number"),
        ("beam.length=-inf", r"beam\.length = -inf: give a finite number"),
        ("beam.supports=cantilever", r"beam\.supports = 'cantilever': give a list"),
        ("beam.supports=pined,pinned", r"beam\.supports\[0\] = 'pined': it is not known, did you mean 'pinned'"),
        ("beam.length.x=1", r"--set beam\.length is a value, not a table"),
        ("gate.wvae.at_least=1", r"--set gate\.wvae is no entry of the list: did you mean 'wave'"),
        ("drive.force.position=0.1", r"--set drive\.force\.position is no entry of the list: known are 0, 1"),
        ("drive.force.2.position=0.1", r"--set drive\.force\.2 is no entry"),
        ("gate.frequency.within=0", r"gate\.frequency\.within = 0\.0: give it above 0"),
        ("gate.frequency.arguments.mode=0", r"gate\.frequency: mode = 0: give a whole number >= 1"),
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


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("22", 22),
        ("-0.5", -0.5),
        ("1e-3", 1e-3),
        ("-.03", -0.03),
        ("3.e2", 300.0),
        ("true", True),
        ("segment", "segment"),
        ('"a,b"', "a,b"),
        ("20,40", [20, 40]),
        ("[1, 2]", [1, 2]),
        ("a b", "a b"),
        (".", "."),
        ("1.2.3", "1.2.3"),
    ],
)
def test_value_is_a_literal_a_word_or_a_list(text, value):
    assert literal(text, "x") == value


def test_tables_with_overrides_are_written_as_toml(path, tmp_path):
    written = tmp_path / "written.toml"
    written.write_text(toml_text(tables_of(path, ("beam.length=0.9",))))
    assert load_scene(written) == load_scene(path, ("beam.length=0.9",))


def skipped(path, *overrides):
    return skipped_gates(load_scene(path, overrides), effective_overrides(path, overrides))


def test_gate_of_another_system_is_skipped(path):
    both = skipped(path, "beam.length=0.8")
    assert both == dict.fromkeys(("frequency", "wave"), "stated for other values: --set beam.length")
    assert list(skipped(path, "drive.frequency_hz=311")) == ["wave"]
    assert skipped(path, "slider.mass=0.1") == {}
    assert skipped(path, "gate.frequency.arguments.mode=4") == {
        "frequency": "stated for other values: --set gate.frequency.arguments.mode"
    }


def test_gate_applies_to_the_same_system_and_to_a_new_band(path):
    assert skipped(path, "beam.length=0.73", "beam.tension=0") == {}
    assert list(skipped(path, "beam.length=0.8", "gate.frequency.expect=80")) == ["wave"]
    assert list(skipped(path, "beam.length=0.8", "gate.frequency.within=0.5")) == ["frequency", "wave"]
    assert list(skipped(path, "beam.length=0.8", "gate.0.expect=96.0")) == ["wave"]


def test_plan_says_what_runs_and_what_is_skipped(path):
    rows = {(row.kind, row.what): row for row in plan(path, ("drive.frequency_hz=311", "spectrum.modes=3"))}
    assert rows["gate", "frequency"].runs
    assert rows["gate", "frequency"].why == "mode.frequency"
    assert not rows["gate", "wave"].runs
    assert "drive.frequency_hz" in rows["gate", "wave"].why
    assert rows["study", "spectrum"].runs
    assert not rows["study", "motor"].runs
    assert rows["study", "motor"].why == "no [motor] in the scene"
