"""Both ways of driving side by side: on the paper's beam as it is known, and on a stranger's, by waves written out here."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import Beam, InputError, PointForce, PointMass, analytic_modes, load_scene, simulate
from verify.device import Device
from verify.judge.workbench import Workbench
from verify.run.plan import plan_scene
from verify.run.runner import run_scene
from verify.scenes.checked import checked
from verify.scenes.scene import scene_type
from verify.studies.methods.figures import methods_study, slider_speed
from verify.studies.methods.study import Methods, MethodsStudy
from verify.units import unit_of
from verify.waves.absorber import matched_device
from verify.waves.devices import field_with_devices

STEEL = {"length": 1.1, "width": 0.034, "thickness": 0.0027, "youngs_modulus": 206e9, "density": 7850.0}
HERTZ = 1730.0
STRIP = Beam(**STEEL)
"""No size of the paper's."""
MATCHED = matched_device(STRIP, HERTZ, STRIP.length - 0.031)
ABSORBER = {
    "position": 0.031,
    "measured_from": "right",
    "dashpot": MATCHED.dashpot,
    "stiffness": MATCHED.stiffness,
    "mass": MATCHED.mass,
}
SLIDER = {"mass": 2e-3, "mu": 0.17, "slope": 900.0, "normal": "massless", "position": 0.47}


def scene_of(methods=None, device=None, **more):
    """The strip under one force of 1.7 N, with a device in place of the second."""
    scene = {
        "name": "a-strangers",
        "beam": STEEL,
        "drive": {
            "frequency_hz": HERTZ,
            "force": [{"position": 0.043, "amplitude": 1.7, "phase_deg": 12.0}],
            "device": [device or ABSORBER],
        },
        "methods": methods or {"span_hz": 37.0, "steps": 5, "duration": 0.02},
    }
    return checked(scene | more, scene_type())


def found_of(scene):
    return methods_study(scene, Workbench(scene.beam), scene.methods)


STRANGER = found_of(scene_of())


def test_the_papers_beam_has_the_figures_that_are_known():
    """REFERENCE-motor, section 2: 0.029 / 0.028 beside 0.97 / 0.95 at 200 Hz off; 1.056 beside 2.414 at L/4."""
    scene = load_scene("absorbing-end", ("methods.steps=3", "methods.duration=0.002"))
    found = found_of(scene)
    driven, below, above = found.edges
    assert (driven.device.reflection, driven.forces.reflection) == (0.0, pytest.approx(0.0274058, abs=2e-6))
    assert (below.device.reflection, above.device.reflection) == pytest.approx((0.02937264, 0.02840074), abs=1e-7)
    assert (below.forces.reflection, above.forces.reflection) == pytest.approx((0.974557, 0.954233), abs=1e-6)
    assert not above.forces.runs_on
    assert np.array(found.picture) == pytest.approx(
        np.array([(x, 1.0 + (x != 0.25) * 2**0.5, 1.0563563) for x in (0.125, 0.25, 0.375)]), abs=1e-6
    )
    assert "the largest reflection is 0.0294 with the device" in found.facts()[0]
    assert "mode 21 at 4072.8 Hz and mode 22 at 4469.9 Hz" in found.facts()[1]
    assert "the way with two forces sends less back there" in found.facts()[4]


def test_equal_forces_make_equal_waves_at_the_papers_frequency_and_the_second_takes_what_the_first_gives():
    """1/2 |F|^2 Re Y_b = 23.297 mW runs to the device."""
    driven = found_of(load_scene("absorbing-end", ("methods.steps=3", "methods.duration=0.002"))).edges[0]
    assert driven.device.given[0] == pytest.approx(0.5 * (1 / (17.5004854396 + 8.3265416490j)).real, rel=1e-7)
    assert driven.device.absorbed == pytest.approx(driven.device.given[0], rel=1e-9)
    assert sum(driven.forces.given) == pytest.approx(0.0, abs=1e-9)
    assert driven.forces.amplitude / driven.device.amplitude == pytest.approx(1.001, abs=1e-3)


def point_reflection(impedance, beam=STRIP, hertz=HERTZ):
    """|Gamma| of what stands on an endless strip: w = e^{-ikx} + F G(x), F = -i omega Z w(0)."""
    omega = 2 * np.pi * hertz
    k = (beam.mass_per_length * omega**2 / beam.bending_stiffness) ** 0.25
    scale = 4 * beam.bending_stiffness * k**3
    force = -1j * omega * impedance / (1 - 1j * omega * impedance * (1 + 1j) / scale)
    return abs(force * -1j / scale)


def test_before_a_load_there_is_what_an_endless_beam_would_send_back_and_behind_it_nothing():
    omega = 2 * np.pi * HERTZ
    for row in STRANGER.masses:
        assert row.device.reflection == pytest.approx(point_reflection(1j * omega * row.value), abs=1e-6)
    for row in STRANGER.dashpots:
        assert row.device.reflection == pytest.approx(point_reflection(row.value), abs=1e-6)
        assert row.device.behind == 0.0
        assert row.device.given[0] > row.device.absorbed


def test_a_dashpot_off_by_a_factor_leaves_that_and_a_second_force_off_by_it_nearly_that():
    for row in STRANGER.detuned:
        s = row.factor
        assert row.dashpot == pytest.approx(abs(s - 1) / (s + 1), abs=1e-9)
        assert (row.reactance > 1e-3) is (s != 1.0)


def test_two_forces_stand_where_the_mirrored_pair_does():
    """The same pair seen from its other end: phase and place exchanged, the wave runs the other way."""
    scene = scene_of()
    pair = [
        PointForce(position=STRIP.length - 0.031, amplitude=1.7, phase_deg=102.0),
        PointForce(position=0.043, amplitude=1.7, phase_deg=12.0),
    ]
    field = analytic_modes.solve_harmonic(STRIP, pair, HERTZ)
    x = np.linspace(0.0, STRIP.length, len(STRANGER.along.everywhere))
    assert np.array(STRANGER.along.amplitudes["forces"]) == pytest.approx(abs(field.deflection(x)), rel=1e-9, abs=1e-18)
    assert STRANGER.places == (0.043, pytest.approx(STRIP.length - 0.031))
    assert scene.methods.phase_deg == 90.0


def test_every_model_drives_both_ways_alike():
    exact, *others = STRANGER.models
    assert exact.device == pytest.approx(1.0, abs=5e-7)
    assert {row.model for row in others} == {"segment", "fem"}
    for row in others:
        assert 0.0 < abs(row.device - 1.0) < 2e-2
        assert abs(row.forces / exact.forces - 1.0) < 2e-2


def test_the_lumped_picture_is_that_of_the_modes_around_the_drive():
    lower, upper = STRANGER.along.modes
    first, second = (analytic_modes.frequency_hz(STRIP, mode) for mode in (lower, upper))
    assert upper == lower + 1
    assert first < HERTZ < second
    assert STRANGER.picture[0][1] == pytest.approx(1 + 2**0.5, rel=1e-9)


def test_the_slider_rides_on_a_devices_field_as_on_that_of_a_beam_that_carries_the_same():
    """A mass of the drive's, and one of the beam's own."""
    scene = scene_of(slider=SLIDER)
    forces = [PointForce(position=0.043, amplitude=9.0), PointForce(position=1.069, amplitude=7.0, phase_deg=81.0)]
    body = Device(position=0.83, mass=0.0031)
    field = field_with_devices(analytic_modes.solve_harmonic, STRIP, forces, HERTZ, [body])
    periods = 34
    own = Beam(**STEEL, mass=[PointMass(position=0.83, mass=0.0031)])
    motion = simulate(
        own,
        forces,
        HERTZ,
        periods / HERTZ,
        model="analytic",
        start="steady",
        slider=replace(scene.slider, coupling="one-way"),
        samples=periods + 1,
    )
    wanted = (motion.travelled[-1] - motion.travelled[17]) * HERTZ / 17
    assert abs(wanted) > 1e-6
    assert slider_speed(scene, field, periods / HERTZ) == pytest.approx(wanted, rel=1e-6)


def test_the_slider_is_run_on_both_at_three_frequencies_and_its_condition_stands_beside_it():
    found = found_of(scene_of(slider=SLIDER))
    assert [ride.off_hz for ride in found.rides] == [-37.0, 0.0, 37.0]
    assert found.motions() == 6
    assert all(ride.device < 0.0 for ride in found.rides)
    assert "one-way, tangential kinematics, mu = 0.17, K = 900 s/m, from x = 0.47 m" in found.facts()[-1]
    assert not STRANGER.rides
    assert len(STRANGER.tables()[0].columns) == len(found.tables()[0].columns) - 1


INPUTS = {
    "phase_deg": 71.0,
    "span_hz": 29.0,
    "steps": 7,
    "factors": [0.3, 1.9],
    "load_position": 0.41,
    "load_mass": [2e-4],
    "load_dashpot": [2.0],
    "modes": [9, 12],
    "count": 150,
    "duration": 0.013,
}


@pytest.mark.parametrize("name", INPUTS)
def test_every_input_of_the_study_moves_what_it_finds(name):
    base = {"span_hz": 37.0, "steps": 5, "duration": 0.02}
    first, second = (found_of(scene_of(asked, slider=SLIDER)).plain() for asked in (base, base | {name: INPUTS[name]}))
    kept = {"slider", "span_hz", "phase_deg", "load_position", "count"}
    assert any(first[key] != second[key] for key in first if key not in kept)


def test_no_input_of_the_study_is_left_out_of_that():
    assert set(INPUTS) == set(Methods.__struct_fields__)


def test_a_conclusion_stands_only_where_it_was_found():
    """With a device that is far off nothing speaks for it; below the first mode no two lie around the drive."""
    poor = found_of(scene_of({"span_hz": 2.0, "steps": 3}, ABSORBER | {"dashpot": 0.002}))
    assert poor.edges[0].device.reflection > 0.9
    assert "the way with two forces bears a change of frequency better" in poor.facts()[0]
    first, _ = found_of(scene_of({"steps": 3, "span_hz": 1.0})).resonances
    assert first[0] > 1
    assert any("lies between mode" in fact for fact in STRANGER.facts())


def test_a_lossy_beam_says_its_loss():
    found = found_of(scene_of(beam=STEEL | {"loss_factor": 0.003}))
    assert "loss factor 0.003" in found.tables()[0].notes[0]
    assert found.edges[0].device.absorbed < found.edges[0].device.given[0]


def test_the_study_tells_its_charts_and_what_it_takes_home():
    charts = STRANGER.charts()
    assert [chart.id.removeprefix("methods-") for chart in charts] == [
        "frequency",
        "amplitude",
        "detuning",
        "load",
        "along",
        "envelopes",
    ]
    assert not any(chart.empty for chart in charts)
    start, end = STRANGER.places
    unit = unit_of(STRANGER.along.everywhere[-1])
    place = f"{unit.factor * (start + (end - start) / 4):g} {unit.name}"
    assert any(f"Read at {place}" in chart.caption for chart in charts)
    assert any(f"read at {place}" in fact for fact in STRANGER.facts())
    assert any(f"are read at {place}" in note for table in STRANGER.tables() for note in table.notes)
    assert STRANGER.in_short().startswith(f"The reflection at 1730 Hz, read at {place}, is 0 with the")
    assert "37 Hz below it is " in STRANGER.in_short()


def test_the_plan_says_what_is_run():
    plan = plan_scene(scene_of(slider=SLIDER))
    assert plan.stepped == (
        "methods (exact fields over 74 Hz, load and detuning, segments and Hermite elements at N = 196, the slider for "
        "20 ms on each)",
    )
    assert plan.motions == 6
    still = plan_scene(scene_of())
    assert (len(still.harmonic), still.stepped, still.motions) == (1, (), 0)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (
            {"drive": {"frequency_hz": HERTZ, "force": [{"position": 0.1}]}},
            "one force and one device, and finds 1 and 0",
        ),
        ({"device": ABSORBER | {"rotational": 3.0}}, r"device at 1\.069 m: give it stiffness, mass or dashpot alone"),
        ({"methods": {"span_hz": 1800.0}}, r"methods\.span_hz = 1800\.0 is not below drive\.frequency_hz = 1730\.0"),
        ({"methods": {"load_position": 0.02}}, r"methods\.load_position = 0\.02 does not lie between force and device"),
        ({"methods": {"factors": [1.0, -2.0]}}, r"methods\.factors = -2\.0: give"),
        ({"methods": {"load_mass": [0.0]}}, r"methods\.load_mass = 0\.0: give"),
        ({"beam": STEEL | {"mass": [{"position": 0.3, "mass": 0.1}]}}, r"leave beam\.mass out"),
    ],
)
def test_what_the_study_cannot_compare_is_refused(change, said):
    with pytest.raises(InputError, match=said):
        scene_of(**change)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"motion": {}}, r"motion: a beam in time knows no drive\.device, and one stands at 1\.069 m: leave out"),
        ({"motion": {}}, r"leave out drive\.device or \[motion\]; a gate of the steady wave, as wave\.reflection, and"),
        ({"spectrum": {}}, r"spectrum: this study knows no drive\.device"),
        ({"wave": {}}, r"wave: this study knows no drive\.device.*: leave out drive\.device or \[wave\]; a gate of"),
        ({"device": ABSORBER | {"stiffness": -1.0}}, r"device\.stiffness = -1\.0"),
        ({"device": ABSORBER | {"position": 0.0}}, r"device\.position = 1\.1 m stands on a pinned support"),
        ({"device": ABSORBER | {"position": 1.2}}, r"drive\.device\.position = 1\.2 lies off the beam"),
    ],
)
def test_what_knows_no_device_is_refused_by_name(change, said):
    with pytest.raises(InputError, match=said):
        scene_of(**change)


@pytest.mark.parametrize(
    ("quantity", "arguments"),
    [
        ("mode.frequency", {"model": "analytic", "mode": 3}),
        ("motion.deflection", {"model": "segment", "count": 20, "x": 0.3, "time": 1e-3}),
        ("chain.transient_deflection", {"time": 1e-3, "x": 0.3, "segments": 5}),
        ("slider.displacement", {"model": "segment", "count": 20, "time": 1e-3}),
        ("wave.receptance", {"position": 0.2, "x": 0.3}),
        ("wave.fastest_crests", {}),
    ],
)
def test_a_figure_that_knows_no_device_is_refused_by_name_in_plan_and_run(quantity, arguments):
    gate = {"id": "g", "quantity": quantity, "arguments": arguments, "at_most": 1e9, "why": "asked"}
    scene = scene_of(slider=SLIDER, gate=[gate], methods=None)
    scene = replace(scene, methods=None)
    said = f"{quantity} knows no drive.device, and one stands at 1.069 m"
    (problem,) = plan_scene(scene).problems
    assert problem.why.startswith(said)
    (judged,) = run_scene(scene).gates
    assert judged.passed is False
    assert said in judged.reason


def test_a_picture_and_a_sheet_draw_the_wave_with_its_device():
    from verify.exports.sheets import Wanted, field_sheet

    sheet = field_sheet(scene_of(), Wanted(model="analytic"))
    inside = (sheet.x > 0.3) & (sheet.x < 0.8)
    assert np.ptp(sheet.at_points["amplitude"][inside]) < 1e-4 * sheet.at_points["amplitude"][inside].mean()


def test_the_study_is_one_of_the_catalogues():
    from verify.studies.catalogue import STUDIES

    assert isinstance(STUDIES["methods"], MethodsStudy)


def test_where_two_forces_meet_a_resonance_there_is_a_gap_and_no_comparison():
    """Mode 24 of the undamped strip lies at the upper end of the span; the device takes the resonance away."""
    upper = next(f for n in range(1, 60) if (f := analytic_modes.frequency_hz(STRIP, n)) > HERTZ)
    found = found_of(scene_of({"span_hz": upper - HERTZ, "steps": 3, "duration": 0.01}, slider=SLIDER))
    above = found.edges[2]
    assert above.forces is None
    assert above.device.reflection < 0.1
    assert (found.rides[2].device, found.rides[2].forces, found.motions()) == (None, None, 4)
    assert "a frequency is a resonance of the undamped beam under two forces" in found.facts()[0]
    assert found.tables()[0].rows[5][2:] == (None,) * len(found.tables()[0].columns[2:])
    assert "Hz above" not in found.in_short()


def test_under_a_heavy_load_two_forces_send_less_back_before_it_and_the_device_nothing_behind():
    """On the paper's beam with 3 g at mid-span: 0.546 and 0 with the device, 0.346 on both sides with two forces."""
    found = found_of(load_scene("absorbing-end", ("methods.steps=3", "methods.duration=0.002")))
    heaviest = found.masses[-1]
    assert heaviest.value == 3e-3
    endless = point_reflection(2j * np.pi * 4276.0 * 3e-3, load_scene("absorbing-end").beam, 4276.0)
    assert (heaviest.device.reflection, heaviest.device.behind) == (pytest.approx(endless, abs=1e-6), 0.0)
    assert heaviest.forces.reflection == pytest.approx(heaviest.forces.behind, rel=1e-6)
    assert heaviest.forces.reflection < heaviest.device.reflection


@pytest.mark.parametrize(
    "asked",
    [
        ["table", "absorbing-end", "--modes", "1-3"],
        ["picture", "absorbing-end", "--what", "modes", "--to", "x.png"],
        ["picture", "absorbing-end", "--what", "chain", "--to", "x.webp"],
        ["export", "absorbing-end", "--what", "modes", "--to", "x.csv"],
        ["bench", "absorbing-end"],
        ["table", "absorbing-end", "--sweep", "phase_deg=0:90:3"],
    ],
)
def test_no_command_passes_over_a_device(asked, capsys, tmp_path, monkeypatch):
    from verify.cli import status_of

    monkeypatch.chdir(tmp_path)
    assert status_of(asked) == 2
    said = capsys.readouterr().err
    assert "knows no drive.device, and one stands at 0.4884 m" in said or "for two forces, the scene has 1" in said
    assert not list(tmp_path.iterdir())


def test_a_power_balance_that_cannot_count_what_turns_is_refused():
    gate = {"id": "g", "quantity": "wave.power_imbalance", "at_most": 1.0, "why": "asked"}
    scene = replace(scene_of(gate=[gate]), methods=None)
    assert run_scene(scene).passed
    turning = {"position": 0.2, "rotational_dashpot": 0.01}
    scene = checked(
        {"name": "t", "beam": STEEL, "gate": [gate]}
        | {"drive": {"frequency_hz": HERTZ, "force": [{"position": 0.04}], "device": [turning]}},
        scene_type(),
    )
    (judged,) = run_scene(scene).gates
    assert "a power balance counts what acts across alone, leave rotational" in judged.reason
