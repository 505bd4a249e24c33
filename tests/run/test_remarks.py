"""What looks like another unit is remarked and never refused; a run says hertz and metres beside its percentages."""

import json

import numpy as np
import pytest

from verify import load_scene
from verify.cli import status_of
from verify.exact.harmonic import solve_harmonic
from verify.exact.modes import exact_frequency_hz
from verify.run.plan import plan_scene
from verify.run.remarks import remarks_on
from verify.run.scale import scale_in_words
from verify.scenes.scene import packaged_scenes

PUSH = "drive={frequency_hz = 3000.0, force = [{position = 0.03, amplitude = 2.0}]}"
GATE = """gate=[{id = "g", quantity = "mode.frequency", arguments = {model = "analytic", mode = 1}, at_least = 1.0, \
why = "It is asked."}]"""
THEORIES = ("euler-bernoulli", "timoshenko")
ARM = """
name = "arm"
[beam]
length = 0.137
width = 0.0093
thickness = 0.00071
youngs_modulus = 206e9
density = 7810
supports = ["clamped", "free"]
[spectrum]
modes = 3
"""


def arm(tmp_path, *overrides):
    path = tmp_path / "arm.toml"
    path.write_text(ARM, "utf-8")
    return load_scene(path, overrides)


@pytest.mark.parametrize("name", packaged_scenes())
def test_no_packaged_scene_is_remarked_on(name):
    assert remarks_on(load_scene(name)) == ()


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (("beam.youngs_modulus=206",), ("beam.youngs_modulus = 206 ", "0.162 m/s")),
        (("beam.youngs_modulus=206e3",), ("beam.youngs_modulus = 206000 ", "5.14 m/s")),
        (("beam.density=7.81",), ("beam.density = 7.81 ", "162000 m/s")),
        (
            ("beam.length=137", "beam.width=9.3", "beam.thickness=0.71"),
            ("beam.length = 137, beam.width = 9.3, beam.thickness = 0.71 are read as metres", "weigh 7070 t"),
        ),
        (("beam.length=137",), ("beam.length = 137", "its own weight would bend it by")),
        (("beam.thickness=0.71",), ("beam.thickness = 0.71 are read", "would be 0.71 m thick and 0.137 m long")),
        (("beam.width=9.3",), ("beam.width = 9.3, ", "would be 9.3 m wide and 0.137 m long; 20 mm is 0.02 m")),
        (("beam.density=7.81e6", "beam.youngs_modulus=206e9"), ("beam.density = 7.81e+06 ", "more than 25000; 7.85 g")),
    ],
)
def test_each_field_that_looks_like_another_unit_is_named_with_what_it_would_mean(tmp_path, overrides, said):
    """sqrt(206 / 7810) = 0.162; 137 x 9.3 x 0.71 x 7810 = 7.07e6 kg."""
    (remark,) = remarks_on(arm(tmp_path, *overrides))
    assert all(words in remark for words in said), remark


@pytest.mark.parametrize(
    "overrides",
    [
        ("beam.length=1.2e-6", "beam.width=6e-8", "beam.thickness=2e-8"),
        ("beam.length=1200", "beam.width=0.6", "beam.thickness=8", "beam.tension=1e7"),
        ("beam.length=30", "beam.width=0.3", "beam.thickness=0.6"),
        ("beam.youngs_modulus=1e6", "beam.density=1100"),
        ("beam.thickness=0.13", "beam.width=0.6", "beam.density=22600"),
        ("beam.youngs_modulus=1.05e12", "beam.density=3500"),
    ],
)
def test_small_long_soft_and_stiff_beams_are_run_and_the_plain_ones_without_a_word(tmp_path, overrides):
    scene = arm(tmp_path, *overrides)
    heavy = scene.beam.mass_per_length * scene.beam.length > 1e5
    assert len(remarks_on(scene)) == heavy


def test_a_run_in_millimetres_says_so_in_every_face_and_ends_well(tmp_path, capsys):
    arm(tmp_path)
    line = ["run", str(tmp_path / "arm.toml"), "--reports", str(tmp_path), "--set", "beam.youngs_modulus=206"]
    assert status_of(line) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "remark: beam.youngs_modulus = 206 " in out
    assert "The beam's first mode is at 0.00099244" in out
    page = next(tmp_path.glob("arm*.html")).read_text("utf-8")
    assert "Remark: beam.youngs_modulus = 206 " in page
    assert "first mode is at 0.00099244" in page
    assert status_of([*line, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["remarks"][0].startswith("beam.youngs_modulus = 206 ")
    assert status_of(["plan", *line[1:2], *line[4:]]) == 0
    assert capsys.readouterr().out.startswith("remark: beam.youngs_modulus = 206 ")


def test_the_scale_is_the_first_frequency_and_how_far_a_driven_beam_bends(tmp_path):
    """1.8751^2 / (2 pi L^2) sqrt(E/12 rho) h = 31.38 Hz; far below it a force F at the tip bends F L^3 / 3 EI."""
    still = arm(tmp_path)
    assert scale_in_words(still) == "The beam's first mode is at 31.384 Hz."
    bent = 0.03 * 0.137**3 / (3 * 206e9 * 0.0093 * 0.00071**3 / 12)
    pushed = arm(tmp_path, "drive={frequency_hz = 0.11, force = [{position = 0.137, amplitude = 0.03}]}")
    assert scale_in_words(pushed).endswith(
        f"driven at 0.11 Hz, it deflects by up to {1e6 * bent:.3g} µm in the steady state."
    )
    (why,) = [one.why for one in plan_scene(pushed).skipped if one.what == "harmonic response"]
    assert why.endswith("fields are solved for how far the beam deflects alone")  # told above, and not skipped


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        (("beam.section=[{length = 0.05, density = 2700.0}, {length = 0.087}]",), "a beam of 2 sections has more than"),
        (("beam.section=[]",), ""),
        (("motion.duration=0.1", PUSH), ""),  # it says how gates and benches in time are run
    ],
)
def test_a_section_that_no_study_answers_is_remarked_on(tmp_path, capsys, overrides, said):
    overrides = ("sensitivity.mode=2", *overrides)
    found = remarks_on(arm(tmp_path, *overrides))
    assert len(found) == bool(said)
    if said:
        assert found[0].startswith(f"[sensitivity] is left out: {said}")
        line = ["run", str(tmp_path / "arm.toml"), "--no-report", *(f"--set={one}" for one in overrides)]
        assert status_of(line) == 0
        assert "remark: [sensitivity] is left out" in capsys.readouterr().out


def test_the_scale_is_by_the_theories_that_are_asked_for(tmp_path):
    """A stub that shear makes softer: no figure of another theory stands under what was asked."""
    stub = (
        "beam.thickness=0.031",
        "beam.length=0.1",
        'beam.supports=["clamped", "clamped"]',
        "spectrum.theory=timoshenko",
    )
    both = arm(tmp_path, *stub, PUSH, GATE)
    plain, soft = (exact_frequency_hz(both.beam, 1, theory=theory) for theory in THEORIES)
    assert 0.55 * plain < soft < 0.8 * plain
    assert scale_in_words(arm(tmp_path, *stub)) == f"The beam's first mode is at {soft:.5g} Hz by Timoshenko theory."
    told = scale_in_words(both)
    assert f"at {plain:.5g} Hz by Euler-Bernoulli theory and {soft:.5g} Hz by Timoshenko theory; driven at" in told
    x = np.linspace(0.0, 0.1, 201)
    fields = [solve_harmonic(both.beam, both.forces, 3000.0, theory=theory) for theory in THEORIES]
    first, second = (float(abs(field.deflection(x)).max()) for field in fields)
    assert second > 1.3 * first
    assert told.endswith(
        f"up to {1e9 * first:.3g} nm by Euler-Bernoulli theory and {1e9 * second:.3g} nm by Timoshenko theory in the "
        "steady state."
    )


@pytest.mark.parametrize(("force", "said"), [(0.03, ""), (1.9, "of its length: linear"), (40.0, " times its length: ")])
def test_what_bends_farther_than_linear_theory_goes_is_not_told_without_a_word(tmp_path, force, said):
    told = scale_in_words(
        arm(tmp_path, f"drive={{frequency_hz = 0.11, force = [{{position = 0.137, amplitude = {force}}}]}}")
    )
    assert told.endswith("in the steady state.") == (not said)
    assert said in told


@pytest.mark.parametrize(("uncertainty", "remarked"), [(0.4, False), (0.6, True)])
def test_a_gate_that_judges_by_less_than_its_reference_is_known_to_is_remarked_on(tmp_path, uncertainty, remarked):
    gate = (
        'gate=[{id = "g", quantity = "mode.frequency", arguments = {model = "analytic", mode = 1}, expect = 31.4, '
        f'within = 0.5, reference = "published", uncertainty = {uncertainty}, source = "page 3", why = "It is asked."}}]'
    )
    found = remarks_on(arm(tmp_path, gate))
    assert len(found) == remarked
    if remarked:
        assert found[0].startswith("gate.g.uncertainty = 0.6 is more than its within = 0.5: ")
