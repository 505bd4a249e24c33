"""The public names in a script of a user: types of lists, and one line for each result."""

from pathlib import Path

import pytest

import verify as v

SCRIPT = """
import numpy as np
import verify as v

beam = v.Beam(
    length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0, supports=["clamped", "free"],
    mass=[v.PointMass(position=0.5, mass=0.01)], spring=[v.PointSpring(position=0.2, stiffness=100.0)],
    section=[v.Section(length=0.2), v.Section(length=0.3, thickness=0.002)],
)
model = v.SegmentModel(beam, n_segments=49)
modes = model.modes(5)
first: float = float(modes.frequencies_hz[0])
errors = v.mode_errors(modes, v.ExactModel(beam).modes(5))
forces = [v.PointForce(position=0.2), v.PointMoment(position=0.5)]
field = model.harmonic(forces, [100.0, 120.0])
amplitudes = abs(field.deflection(np.linspace(0.0, 0.5, 11)))
one, many = field.deflection(0.3), field.deflection([0.1, 0.2])
left, right = beam.supports
body: float = beam.mass[0].mass
feet = v.Slider(mass=0.001, mu=0.3, contact=v.Contact(stiffness=1e5), foot=[v.Foot(points=3, length=0.001)])
drive = v.Excitation(forces, 100.0)
motion = v.simulate(beam, drive, 0.05, model="fem", count=20, slider=[feet, v.Slider(mass=0.002, mu=0.2)])
free = v.free_vibration(beam, lambda x: x**2, 0.1, count=20)
bent = v.bend(beam, 20, [0.1, 0.2])
"""
WRONG = """
import verify as v

v.Beam(length=0.5, supports=["clamped", "fee"])
v.Beam(length=0.5, mass=[v.PointSpring(position=0.2, stiffness=100.0)])
"""
SIZES = {"length": 0.5, "width": 0.02, "thickness": 0.001, "youngs_modulus": 70e9, "density": 2700.0}
PLAIN = v.Beam(**SIZES)


def check_types(path: Path, text: str) -> str:
    mypy = pytest.importorskip("mypy.api")
    path.write_text(text, encoding="utf-8")
    output, errors, _ = mypy.run(["--strict", str(path)])
    return output + errors


def test_a_type_checker_accepts_lists_wherever_they_are_documented(tmp_path):
    assert "error" not in check_types(tmp_path / "user.py", SCRIPT)
    assert check_types(tmp_path / "wrong.py", WRONG).count("error:") == 2


def test_lists_are_held_as_tuples():
    beam = v.Beam(**SIZES, supports=["clamped", "free"], mass=[v.PointMass(position=0.5, mass=0.01)])
    assert beam == v.Beam(**SIZES, supports=("clamped", "free"), mass=(v.PointMass(position=0.5, mass=0.01),))
    assert hash(beam) == hash(v.Beam(**SIZES, supports=("clamped", "free"), mass=beam.mass))


def results():
    """(name of the result, words of its line)."""
    model, drive = v.SegmentModel(PLAIN, 49), v.Excitation([v.PointForce(position=0.1)], 100.0)
    modes = model.modes(5)
    yield modes, ("segment", "49", "9.23", "Hz")
    yield v.mode_errors(modes, v.ExactModel(PLAIN).modes(5)), ("frequency",)
    yield v.ExactModel(PLAIN).harmonic(v.PointForce(position=0.1), [90.0, 120.0]), ("analytic", "90 to 120 Hz")
    field = v.ExactModel(PLAIN).harmonic(v.PointForce(position=0.1), 700.0)
    yield field, ("700 Hz",)
    yield v.travelling_wave.measure(field, (0.2, 0.45)), ("0.2 to 0.45 m",)
    yield model.system, ("48 unknowns",)
    yield model.time_basis(), ("49", "rad/s")
    yield model.rigid_chain(), ("49 links",)
    yield v.simulate(PLAIN, drive, 0.05, count=20, slider=v.Slider(mass=0.001, mu=0.2)), ("0.05 s", "travelled")
    motion = v.simulate(PLAIN, drive, 0.05, count=20, keep=v.Keep([0.1, 0.2]))
    yield motion, ("deflection", "m (")
    yield motion.end, ("0.05 s",)
    yield v.free_vibration(PLAIN, lambda x: x * (0.5 - x), 0.1, count=20), ("0.1 s", "Hz")
    yield v.bend(v.Beam(**SIZES, supports=["clamped", "free"]), 20, 0.1), ("20", "rad", "J")
    scene = v.load_scene("free-free-bar")
    yield scene, (scene.name,)
    yield v.run_scene(scene), (scene.name, "gates passed")


def test_a_result_is_one_line_with_its_sizes_and_units():
    for result, words in results():
        text = repr(result)
        assert len(text) < 200, text
        assert "\n" not in text, text
        assert not {word for word in ("lambda", "<function", "array(") if word in text}, text
        assert not [word for word in words if word not in text], text


def test_a_value_is_printed_as_it_is_written():
    names = {"Beam": v.Beam, "PointMass": v.PointMass}
    beam = v.Beam(**SIZES, supports=["clamped", "free"], mass=[v.PointMass(position=0.5, mass=0.01)])
    assert eval(repr(beam), names) == beam
    assert len(repr(beam)) < 200


def test_names_of_a_beam_are_its_fields_and_figures():
    figures = [
        "attached",
        "base_section",
        "mirrored",
        "pieces",
        "rigid_motions",
        "surface_distance",
        "uniform",
        "wave_constant",
    ]
    shown = {name for name in dir(v.Beam) if not name.startswith("_")}
    assert shown == {*v.Beam.__struct_fields__, *figures}
    assert all(getattr(v.Beam, name).__doc__ for name in figures)
