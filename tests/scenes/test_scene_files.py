"""Scene files: what is read, overridden, refused, and in which words."""

import math
import re
import string

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import load_scene
from verify.errors import InputError
from verify.scenes.scene import STARTER, packaged_scenes
from verify.scenes.toml import literal, split_assignment
from verify.slider import changed

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


def scene_of(tmp_path, text, *overrides):
    path = tmp_path / "s.toml"
    path.write_text(text, encoding="utf-8")
    return load_scene(path, overrides)


def test_the_packaged_scenes_load_by_name():
    assert "paper" in packaged_scenes()
    assert "starter" not in packaged_scenes()
    assert load_scene("paper").beam.supports == ("pinned", "pinned")


def test_the_starter_is_a_scene_whose_gates_pass():
    from verify import run_scene

    assert run_scene(STARTER).passed


def test_a_scene_at_any_path_is_loaded_with_numbers_as_floats(tmp_path):
    scene = scene_of(tmp_path, 'name = "s"' + BEAM + GATE)
    assert scene.beam.density == 4470.0
    assert scene.gate[0].arguments == {"model": "analytic", "mode": 3}


@pytest.mark.parametrize(
    ("assignment", "read"),
    [
        ("beam.length=0.4", lambda s: s.beam.length == 0.4),
        ("beam.supports=pinned,pinned", lambda s: s.beam.supports == ("pinned", "pinned")),
        ('beam.supports=["free", "guided"]', lambda s: s.beam.supports == ("free", "guided")),
        ("gate.g.within=0.25", lambda s: s.gate[0].within == 0.25),
        ("gate.0.within=0.25", lambda s: s.gate[0].within == 0.25),
        ("spectrum.count=31", lambda s: s.spectrum.count == 31),
        ("title=A strip", lambda s: s.title == "A strip"),
    ],
)
def test_an_override_reaches_its_value(tmp_path, assignment, read):
    assert read(scene_of(tmp_path, 'name = "s"' + BEAM + GATE, assignment))


@pytest.mark.parametrize(
    ("assignment", "message"),
    [
        ("beam.lenght=0.4", r"beam\.lenght is not a known key: did you mean 'length'"),
        ("baem.length=0.4", r"baem is not a known key: did you mean 'beam'"),
        ("beam.length=long", r"beam\.length = 'long': give a number"),
        ("beam.length=80cm", r"beam\.length = '80cm': give a number alone, in SI units"),
        ("beam.loss_factor=2 percent", r"beam\.loss_factor = '2 percent': give a number alone, in SI units"),
        ("beam.length=2%", r"beam\.length = '2%': give a number$"),
        ("beam.supports=cantilever", r"= 'cantilever': give a list, 2 of pinned, clamped, free, guided with commas"),
        ("gate.g.arguments=a", r"gate\.g\.arguments = 'a': give a table$"),
        ("convergence.counts=few", r"convergence\.counts = 'few': give a list$"),
        ("beam.length=0,4", r"beam\.length = \[0, 4\]: give one number, with a point before its decimals"),
        ("spectrum.count=2,4", r"spectrum\.count = \[2, 4\]: give one whole number"),
        ("beam.length=-1", r"beam\.length = -1\.0: give a finite number above 0"),
        ("beam.length=nan", r"beam\.length = nan: give a finite number above 0"),
        ("beam.length=inf", r"beam\.length = inf"),
        ("beam.supports=pined,pinned", r"beam\.supports\[0\] = 'pined' is not known: did you mean 'pinned'"),
        ("beam.supports=pinned", r"beam\.supports = 'pinned'"),
        ("beam.length.x=1", r"--set beam\.length is a value"),
        ("gate.h.within=1", r"--set gate\.h names no entry"),
        ("gate.g.within=0", r"gate\.g\.within = 0"),
        ("spectrum.count=0", r"spectrum\.count = 0: give a whole number >= 1"),
        ("spectrum.count=4.5", r"spectrum\.count = 4\.5: give a whole number"),
        ("drive.frequency_hz=0", r"drive\.frequency_hz = 0"),
        ("convergence.counts=[]", r"convergence\.counts = \[\]"),
        ("length", r"not an assignment"),
        ("=3", r"not an assignment"),
    ],
)
def test_a_wrong_override_is_one_sentence_with_field_value_and_remedy(tmp_path, assignment, message):
    with pytest.raises(InputError, match=message) as caught:
        scene_of(tmp_path, 'name = "s"' + BEAM + GATE, assignment)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("scene", "assignment", "message"),
    [
        ("paper", "drive.force.position=0.1", "those of drive.force are numbered, write drive.force.0 to 1"),
        ("instrument-arm", "beam.mass.mass=0.1", "those of beam.mass are numbered, write beam.mass.0"),
        ("paper", "gate.fem-odrer.within=1", "did you mean 'fem-order'?"),
        ("paper", "convergence.counts.x=1", "those of convergence.counts are numbered, write convergence.counts.0 to"),
    ],
)
def test_an_override_that_names_no_entry_of_a_list_is_told_how_they_are_named(scene, assignment, message):
    with pytest.raises(InputError, match=f"names no entry: {re.escape(message)}"):
        load_scene(scene, (assignment,))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name = ", "is not TOML"),
        ('name = "s"', "beam is missing"),
        ('name = "s"\nbeam = 3', "beam = 3: give a table"),
        ('name = "../evil"' + BEAM, r"name = '\.\./evil'"),
        ('name = "s"\nextra = 1' + BEAM, "extra is not a known key"),
        ('name = "s"' + BEAM + GATE + GATE, r"gate\.g stands twice"),
        (
            'name = "s"' + BEAM + GATE.replace("within", "withn"),
            r"gate\.g\.withn is not a known key: did you mean 'within'",
        ),
        ('name = "s"' + BEAM + "[drive]\nfrequency_hz = 9\nforce = [{ position = 0.74 }]", "lies off the beam"),
    ],
)
def test_a_broken_scene_is_one_sentence(tmp_path, text, message):
    with pytest.raises(InputError, match=message):
        scene_of(tmp_path, text)


def test_a_byte_order_mark_is_no_part_of_a_scene(tmp_path):
    path = tmp_path / "s.toml"
    path.write_text('name = "s"' + BEAM, encoding="utf-8-sig")
    assert load_scene(path).name == "s"


def test_a_key_that_is_set_twice_is_told_with_both_values(tmp_path):
    text = 'name = "s"' + BEAM + GATE
    with pytest.raises(InputError, match=r"^beam\.length is set to 0\.4 and to 0\.7: set it once$"):
        scene_of(tmp_path, text, "beam.length=0.4", "beam.width=0.013", " beam.length = 0.7")
    assert scene_of(tmp_path, text, "beam.length=0.4", "beam.width=0.013").beam.length == 0.4


@pytest.mark.parametrize("overrides", ["beam.length=0.4", 3, (3,), None, {"beam.length": 0.4}])
def test_overrides_that_are_no_list_of_words_are_one_sentence(overrides):
    with pytest.raises(InputError, match="give a list of 'key=value' words"):
        load_scene("paper", overrides)


def test_files_that_cannot_be_read_are_one_sentence(tmp_path):
    for path in (tmp_path / "none.toml", tmp_path, tmp_path / "no" / "folder.toml"):
        with pytest.raises(InputError, match="cannot be read"):
            load_scene(path)
    binary = tmp_path / "b.toml"
    binary.write_bytes(b"\xff\xfe\x00name")
    with pytest.raises(InputError, match="UTF-8"):
        load_scene(binary)
    with pytest.raises(InputError, match="did you mean 'paper'"):
        load_scene("papr")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("22", 22),
        ("-0.5", -0.5),
        ("1e-3", 1e-3),
        ("true", True),
        ("segment", "segment"),
        ("20,40,80", [20, 40, 80]),
        ("[1, 2]", [1, 2]),
        ('"a,b"', "a,b"),
        ("0.125, 0.375", [0.125, 0.375]),
        ("a b", "a b"),
        ("pinned,free", ["pinned", "free"]),
        (".03", 0.03),
        ("-.03", -0.03),
        ("+.5e-3", 5e-4),
        ("3.", 3.0),
        ("3.e2", 300.0),
        (".1,.3", [0.1, 0.3]),
        ("[.1, 3.]", [0.1, 3.0]),
        ("{ end = .2, of = [-.1, 1] }", {"end": 0.2, "of": [-0.1, 1]}),
        ('".5"', ".5"),
        ("a.5", "a.5"),
        ("./.5", "./.5"),
        (".", "."),
        ("1.2.3", "1.2.3"),
    ],
)
def test_values_are_toml_literals_bare_words_or_lists(text, value):
    assert literal(text) == value
    assert split_assignment(f"key={text}") == ("key", value)


def test_a_force_measured_from_the_right_end_follows_the_length():
    for length in (0.5, 0.4):
        near, far = load_scene("paper", (f"beam.length={length}",)).forces
        assert (near.position, near.phase_deg) == (0.0116, 0.0)
        assert (far.position, far.phase_deg) == (pytest.approx(length - 0.0116, rel=1e-15), 90.0)


KEYS = st.sampled_from(
    [
        "beam",
        "gate",
        "drive",
        "spectrum",
        "convergence",
        "length",
        "mode",
        "x",
        "wave",
        "count",
        "counts",
        "model",
        "quantity",
        "frequency_hz",
        "phase_deg",
        "force",
        "kind",
        "reflection_limit",
    ]
)
LEAVES = st.one_of(
    st.none().map(lambda _: "x"),
    st.booleans(),
    st.integers(-5, 10**30),
    st.floats(),
    st.text(string.printable, max_size=5),
)
TREES = st.recursive(
    LEAVES, lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=3), max_leaves=8
)


@settings(max_examples=300, deadline=None)
@given(
    st.dictionaries(
        st.sampled_from(["name", "beam", "gate", "drive", "convergence", "sensitivity", "spectrum", "wave"]), TREES
    )
)
def test_no_tree_of_values_gives_anything_but_a_scene_or_a_sentence(tree):
    from verify.scenes.checked import checked
    from verify.scenes.scene import scene_type

    try:
        checked(tree, scene_type())
    except InputError as error:
        assert str(error)


WAVES = st.fixed_dictionaries(
    {},
    optional={
        "count": LEAVES,
        "counts": st.lists(LEAVES, max_size=3),
        "model": LEAVES,
        "quantity": LEAVES,
        "frequency_hz": st.lists(LEAVES, min_size=2, max_size=4),
        "phase_deg": st.lists(LEAVES, min_size=2, max_size=4),
        "reflection_limit": LEAVES,
        "operating_loss_factor": LEAVES,
        "window": LEAVES,
    },
)


@settings(max_examples=200, deadline=None)
@given(WAVES, st.dictionaries(st.sampled_from(["frequency_hz", "kind", "force"]), TREES))
def test_no_wave_table_gives_anything_but_a_scene_or_a_sentence(wave, drive):
    from verify.scenes.checked import checked
    from verify.scenes.scene import scene_type

    beam = {"length": 0.73, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470}
    two = {"frequency_hz": 433.0, "force": [{"position": 0.02}, {"position": 0.7}]}
    for shaken in (two, two | drive):
        try:
            scene = checked({"name": "s", "beam": beam, "drive": shaken, "wave": wave}, scene_type())
        except InputError as error:
            assert str(error)
            assert "\n" not in str(error)
        else:
            span = scene.wave.frequency_hz
            assert span is None or span[0] < span[1]


SIZES = st.floats(1e-9, 1e3)


@settings(max_examples=150, deadline=None)
@given(
    SIZES,
    SIZES,
    SIZES,
    st.floats(1.0, 1e13),
    st.floats(1e-3, 1e6),
    st.integers(2, 30),
    st.floats(1e-6, 1e6),
)
def test_relative_errors_do_not_depend_on_size_or_material(length, width, thickness, modulus, density, count, scale):
    """Dimensional analysis: the error of a mode is a function of n and N alone, to rounding."""
    from verify.beam import Beam
    from verify.judge.workbench import Workbench

    assume(1e-12 < thickness / length < 1e12)  # femtometres beside kilometres leave floating point, and are refused
    assume(1e-12 < thickness / (length * scale) < 1e12)
    mode = 1 + count // 3
    beam = Beam(length=length, width=width, thickness=thickness, youngs_modulus=modulus, density=density)
    other = Beam(length=length * scale, width=width, thickness=thickness, youngs_modulus=modulus, density=density)
    for model in ("segment", "fem"):
        if mode < count:
            errors = [Workbench(b).frequency_error(model, count, mode) for b in (beam, other)]
            assert math.isclose(*errors, rel_tol=0, abs_tol=1e-13)


RIDDEN = "\n[slider]\nmass = 0.0031\nmu = 0.17\nslope = 310.0\n"


def test_another_law_of_friction_leaves_behind_what_only_the_first_has(tmp_path):
    """K is of Eq. (3) alone, a static coefficient of Coulomb's law alone: beside the other they did nothing."""
    text = 'name = "s"' + BEAM + GATE + RIDDEN
    sticks = scene_of(tmp_path, text, "slider.law=coulomb").slider
    assert (sticks.slope, sticks.steepness, sticks.mu) == (None, None, 0.17)
    creeps = scene_of(tmp_path, text, "slider.slope=470").slider
    assert creeps.steepness == 470.0
    assert changed(creeps, law="coulomb", mu=0.19, mu_static=0.23) == replace(sticks, mu=0.19, mu_static=0.23)
    assert changed(replace(sticks, mu_static=0.23), law="tanh") == replace(sticks, law="tanh")
    assert replace(sticks, law="tanh").steepness == 1e4
    with pytest.raises(InputError, match=r"slider.slope = 470.0 is K of Eq. \(3\), .* has none, leave it out$"):
        scene_of(tmp_path, text, "slider.law=coulomb", "slider.slope=470")
    with pytest.raises(InputError, match=r"slider.slope = 310.0 is K of Eq. \(3\)"):
        scene_of(tmp_path, text + 'law = "coulomb"\n')
