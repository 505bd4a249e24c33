"""Words under charts say what was found in this scene and no other."""

import re

import numpy as np
import pytest
from msgspec.structs import replace
from packaged import last_of_each

from verify import load_scene
from verify.attached import PointMass
from verify.errors import WindowError
from verify.judge.workbench import Workbench
from verify.quantities.catalogue import QUANTITIES, arguments_of, evaluate
from verify.run.runner import run_scene, workbench_for
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type
from verify.slider import changed
from verify.studies.axial_inertia.figures import axial_study
from verify.studies.modes.sensitivity import Sensitivity
from verify.studies.modes.sensitivity_figures import sensitivity
from verify.studies.slider.figures import places_of, slider_study
from verify.studies.slider.movie import slider_movie
from verify.studies.slider.work_precision import run_once
from verify.studies.wave.charts import wave_charts
from verify.studies.wave.figures import MotorRow, OffSearch, motor_rows_table, wave_study
from verify.waves.driven import Operation
from verify.words import work_in_words

STRIP = {
    "name": "captions",
    "title": "Pinned strip",
    "beam": {"length": 0.4, "width": 0.015, "thickness": 0.0012, "youngs_modulus": 120e9, "density": 4400.0},
    "drive": {
        "frequency_hz": 900.0,
        "force": [
            {"position": 0.03, "amplitude": 3.0, "phase_deg": 20.0},
            {"position": 0.35, "amplitude": 2.0, "phase_deg": 110.0},
        ],
    },
}


def scene_of(**more):
    return checked(STRIP | more, scene_type())


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


@pytest.mark.parametrize("known", [True, False])
def test_a_table_of_motors_speaks_of_best_frequencies_where_there_are_columns_of_them(known):
    at = Operation(frequency_hz=90.0, standing_wave_ratio=1.4, axis_ratio=-0.1, crest_speed=0.02)
    row = MotorRow(model="segment", count=9, drive=at, best=at if known else OffSearch(88.0))
    told = motor_rows_table((row,)).notes[0]
    assert ("right at the model's own best" in told) == known
    assert told.endswith("at 90 Hz, the drive's frequency" + ", right at the model's own best" * known)


def test_chains_are_told_to_lie_off_the_linear_one_by_what_was_found():
    """Next to the resonance of axial waves links that stretch lie farther off than rigid ones."""
    asked = {"count": 12, "forces": [10.0], "shown": 10.0, "duration": 2e-3}
    scene = scene_of(axial_inertia=asked)
    found = axial_study(scene, scene.axial_inertia)
    caption = next(chart for chart in found.charts() if chart.id == "axial-models").caption
    rigid, massless, stretching, divided = map(float, re.findall(r"\d\.\de[+-]\d\d", caption))
    lines = {name: np.array(values) for name, values in found.lines.items()}
    off = {name: rms(lines[name] - lines["linear"]) / rms(lines["linear"]) for name in lines}
    assert [rigid, massless, stretching] == pytest.approx([off[n] for n in ("full", "transverse", "elastic")], rel=0.06)
    assert divided == pytest.approx(rms(lines["linear"] - lines["exact"]) / rms(lines["exact"]), rel=0.06)
    assert stretching > 1.15 * rigid


SLIDER = {"mass": 2e-3, "mu": 0.05, "slope": 500.0, "position": 0.1, "coupling": "one-way"}


def ride(speed):
    """The words under a slider that starts along the strip with a speed, and its places."""
    motion = {"duration": 0.01, "count": 20, "counts": [10, 20]}
    scene = scene_of(slider=SLIDER | {"speed": speed}, motion=motion)
    run = run_once(scene, "segment", 20, samples=400, at=places_of(scene, 20))
    return slider_movie(Ran(run))[0].caption, run


class Ran:
    """A study by its one run."""

    count = 20

    def __init__(self, run):
        self.subject = run


def test_a_slider_that_goes_far_is_told_where_it_goes():
    caption, run = ride(5.0)
    low, high = map(float, re.search(r"between ([\d.]+) and ([\d.]+) mm", caption).groups())
    assert (low, high) == pytest.approx((1e3 * run.position.min(), 1e3 * run.position.max()), rel=1e-3)
    assert high - low == pytest.approx(50.0, rel=0.1)
    assert "too little to be seen" not in caption


def test_a_slider_that_hardly_moves_is_told_so():
    caption, run = ride(0.0)
    assert 0.0 < np.ptp(run.position) < 1e-4
    assert "too little to be seen" in caption


def waves(*overrides):
    """Captions of the wave's charts by their ids, and the study."""
    quick = ("wave.counts=[49,98]", "wave.frequency_hz=4200,4300,5", "wave.phase_deg=0,180,7")
    scene = load_scene("paper-wave", last_of_each(*quick, *overrides))
    study = wave_study(scene, Workbench(scene.beam), scene.wave)
    return {chart.id: chart.caption for chart in wave_charts(study)}, study


@pytest.mark.parametrize(
    ("more", "theory", "rules"),
    [
        ({}, True, ""),
        ({"tension": -3.0}, False, "Joints side by side."),
        ({"supports": ["clamped", "pinned"]}, True, "Walls side by side."),
        ({"tension": 40.0, "mass": [{"position": 0.13, "mass": 0.02}]}, False, "Joints and attachments side by side."),
    ],
)
def test_captions_of_modes_name_what_is_drawn(more, theory, rules):
    """A beam under axial force has no other theory beside it; rules differ in what the beam has."""
    asked = {"spectrum": {"modes": 3, "count": 12}, "convergence": {"modes": [2], "counts": [12, 16]}}
    scene = scene_of(beam=STRIP["beam"] | {"supports": ["pinned", "pinned"]} | more, **asked)
    charts = {one.id: one for found in run_scene(scene).found.values() for one in found.charts()}
    split = charts["error-split"]
    assert any(name.startswith("theory") for name in split.bars.names) is theory
    assert ("Theory: what" in split.caption) is theory
    assert charts["rules"].caption.startswith(rules) if rules else "rules" not in charts


@pytest.mark.parametrize("fibre", [0.0005, 0.02])
def test_ellipses_are_as_flat_as_they_are(fibre):
    """Of waves of 135.4 / m, by reflection wider and narrower: upright with half a millimetre, lying with 20."""
    captions, study = waves(f"beam.extreme_fibre={fibre}")
    ratios = [np.ptp(one.across) / np.ptp(one.up) for one in study.ellipses]
    told = re.search(r"they are ([\d.]+)(?: to ([\d.]+))? times as wide as high", captions["wave-ellipses"])
    low, high = float(told[1]), float(told[2] or told[1])
    assert (low, high) == pytest.approx((min(ratios), max(ratios)), rel=5e-3)
    assert np.sqrt(min(ratios) * max(ratios)) == pytest.approx(135.4 * fibre, rel=0.01)


def test_models_are_told_to_lie_off_at_the_drive_and_at_their_best_by_what_was_found():
    captions, study = waves()
    exact, *others = study.rows
    drive, best = map(float, re.findall(r"\d\.\de[+-]\d\d", captions["wave-sizes"]))
    assert drive == pytest.approx(
        max(abs(row.drive.standing_wave_ratio - exact.drive.standing_wave_ratio) for row in others), rel=0.06
    )
    assert best == pytest.approx(
        max(abs(row.best.standing_wave_ratio - exact.best.standing_wave_ratio) for row in others), rel=0.06
    )
    assert ("errors of frequency" in captions["wave-sizes"]) is (best < 0.1 * drive)


def test_models_that_are_as_far_off_at_their_best_are_not_called_wrong_in_frequency():
    """Driven at a resonance's flank with much loss, a coarse chain has no wave that is nearly as pure."""
    captions, study = waves("beam.loss_factor=0.2", "drive.frequency_hz=4200", "wave.counts=[32]")
    exact, *others = study.rows
    apart = [abs(row.drive.standing_wave_ratio - exact.drive.standing_wave_ratio) for row in others]
    assert f"{max(apart):.1e}" in captions["wave-sizes"]
    assert "spoil" not in captions["wave-sizes"]


def test_modulus_and_density_move_a_bare_beam_by_half_and_a_laden_one_by_what_was_solved():
    bare = load_scene("paper").beam
    (plain,) = sensitivity(bare, Sensitivity(mode=2)).charts()
    assert "one per cent of modulus or density moves mode 2 by half a per cent." in plain.caption
    mass = 0.3 * bare.mass_per_length * bare.length
    taut = replace(bare, tension=310.0, mass=(PointMass(position=0.11, mass=mass),))
    found = sensitivity(taut, Sensitivity(mode=2))
    middle = found.frequencies_hz[2][12]
    step = found.moduli[13] / found.moduli[12]
    stiff = np.log(found.frequencies_hz[2][13] / middle) / np.log(step)
    assert 0.0 < stiff < 0.2
    (chart,) = found.charts()
    assert "does not go with sqrt(E / rho)" in chart.caption
    told = float(chart.caption.partition("moves mode 2 by ")[2].split()[0])
    assert told == pytest.approx(stiff, rel=0.02)
    assert "half a per cent" not in chart.caption
    assert chart.title == "Mode 2 over modulus and density"  # given, and inferred from nothing


@pytest.mark.parametrize(
    ("law", "said"), [("tanh", "slider and surface pass each other faster than 1/K"), ("coulomb", "while it sticks")]
)
def test_friction_is_said_to_hang_on_the_speed_between_slider_and_surface(law, said):
    scene = load_scene("paper-slider", ("motion.counts=[9, 13]", "motion.count=11", "motion.duration=6e-4"))
    scene = replace(scene, gate=(), claim=(), readings=None, slider=changed(scene.slider, law=law))
    caption = next(one.caption for one in run_scene(scene).found["motion"].charts() if one.id == "slider-force")
    assert said in caption
    assert "as soon as the surface moves" not in caption


@pytest.mark.parametrize(
    ("quantity", "told"),
    [
        ("chain.hanging_frequency", "1 equilibria and modes of the nonlinear chain"),
        ("chain.rollup_gap", "1 equilibria and modes of the nonlinear chain"),
        ("friction.creep_speed", "closed forms only"),
    ],
)
def test_an_equilibrium_of_the_nonlinear_chain_is_no_closed_form(quantity, told):
    scene = load_scene("chain" if quantity.startswith("chain") else "paper-slider")
    bench, kind = workbench_for(scene, gates_only=True), QUANTITIES[quantity]
    gate = next(one for one in scene.gate if one.quantity == quantity)
    evaluate(kind, arguments_of(kind, gate.arguments), scene, bench)
    assert work_in_words(len(bench.solves), bench.n_fields, bench.n_motions, bench.others) == told


def test_a_wave_study_names_a_remedy_that_it_has():
    """It reads the middle half of the beam, and has no window to choose."""
    stepped = ["beam.section=[{length=0.33}, {length=0.17, thickness=0.002}]"]
    with pytest.raises(
        WindowError, match=r"leave \[wave\] out, and ask for figures by gates with a window of their own"
    ):
        run_scene(replace(load_scene("paper-wave", tuple(stepped)), gate=(), claim=()))


def test_the_mean_speed_of_a_ride_is_told_and_no_swing():
    """A slider that starts with a speed is carried by no swing of the surface."""
    motion = {"duration": 0.004, "count": 20, "counts": [10, 20]}
    found = slider_study(scene_of(slider=SLIDER | {"speed": -3.0}, motion=motion))
    caption = next(chart.caption for chart in found.charts() if chart.id == "slider-speeds")
    told = float(re.search(r"at ([^ ]+) mm/s", caption)[1])
    assert told == pytest.approx(1e3 * found.subject.displacement / 0.004, rel=1e-2)
    assert told == pytest.approx(-3e3, rel=0.05)
