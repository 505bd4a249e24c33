"""How linear the chain of rigid links is: laws of its axial inertia, the study, its words, and what it refuses."""

import json

import numpy as np
import pytest
from msgspec.structs import replace
from packaged import last_of_each

from verify import load_scene, run_scene
from verify.chain.departure import chain_deflection, departure, departure_of, driven_chain, linear_chain, rms
from verify.cli import status_of
from verify.errors import InputError
from verify.exact.modes import solve_harmonic
from verify.motion.validity import NONLINEAR, axial_inertia_size
from verify.quantities.catalogue import arguments_of, evaluate, quantity
from verify.report.plain import run_as_plain
from verify.run.plan import plan_scene
from verify.run.runner import n_steps, workbench_for
from verify.studies.axial_inertia import figures as axial_figures
from verify.words import work_in_words

SMALL = (
    "axial_inertia.count=21",
    "axial_inertia.forces=[2.0, 6.0]",
    "axial_inertia.shown=6.0",
    "axial_inertia.duration=4e-4",
    "axial_inertia.x=0.13",
)


def small(*more):
    return load_scene("chain", last_of_each(*SMALL, *more))


def studied(scene, **more):
    return axial_figures.axial_study(scene, scene.axial_inertia, **more)


@pytest.fixture(scope="module")
def study():
    return studied(small())


def driven(count=21, duration=4e-4, x=0.13, **more):
    return driven_chain(small(), "test", count, duration, x)


def test_a_departure_is_held_against_the_linear_chains_rms():
    linear = np.array([3.0, -4.0, 5.0, 0.0])
    found = departure_of(linear + np.array([0.0, 0.2, 0.0, -0.1]), linear)
    assert found.at_end == pytest.approx(0.1 / np.sqrt(12.5))
    assert found.rms == pytest.approx(np.sqrt(0.05 / 4) / np.sqrt(12.5))


@pytest.mark.parametrize("links", ["full", "transverse", "elastic"])
def test_departures_grow_with_the_square_of_the_force(links):
    case = driven()
    small_one, large_one = (departure(case, force, links).rms for force in (2.0, 6.0))
    assert large_one / small_one == pytest.approx(9.0, rel=0.02)


def test_the_scale_is_that_of_the_departure_and_grows_with_it(study):
    for row in study.rows:
        assert 0.1 < row.full.rms / row.size < 5.0
        assert row.linear == (row.size <= NONLINEAR)
    assert study.rows[1].size / study.rows[0].size == pytest.approx(9.0, rel=0.01)


def test_links_that_stretch_keep_a_part_of_the_axial_inertia_and_massless_ones_next_to_none(study):
    for row in study.rows:
        assert 0.01 * row.full.rms < row.elastic.rms < 0.5 * row.full.rms
        assert row.transverse.rms < 0.01 * row.full.rms


def test_the_linear_chain_is_the_small_force_limit_of_every_chain():
    case = driven()
    for links in ("full", "transverse", "elastic"):
        found = chain_deflection(case, 1e-2, links) / 1e-2
        assert rms(found - linear_chain(case)) < 2e-6 * rms(linear_chain(case)), links


def test_side_by_side_the_exact_field_is_the_beams_and_finer_chains_come_nearer():
    errors = []
    for count in (49, 98):
        scene = small(f"axial_inertia.count={count}")
        rows = {row.model: row for row in studied(scene).beside}
        assert list(rows) == ["exact", "fem", "linear", "full", "transverse", "elastic"]
        assert rows["exact"].error == 0.0
        errors.append([rows[model].error for model in ("fem", "linear", "transverse")])
    assert (np.array(errors[1]) < 0.4 * np.array(errors[0])).all()


def test_the_exact_field_is_a_sum_of_the_beams_modes(study):
    """Written out again: undamped modes of unit modal mass from rest."""
    from verify.exact import modes as analytic_modes

    scene = small()
    modes = analytic_modes.solve_modes(scene.beam, 300)
    omega, drive, end = 2 * np.pi * modes.frequencies_hz, 2 * np.pi * 4276.0, study.times[-1]
    total = 0.0
    for force in scene.forces:
        phase = np.deg2rad(force.phase_deg)
        gain = modes.deflection([0.13])[:, 0] * modes.deflection([force.position])[:, 0] * 6.0
        answer = np.cos(drive * end + phase) - np.cos(phase) * np.cos(omega * end)
        total += (gain * (answer + drive / omega * np.sin(phase) * np.sin(omega * end))) @ (1 / (omega**2 - drive**2))
    assert study.lines["exact"][-1] == pytest.approx(total, rel=1e-5)


def test_the_quantity_is_the_studys_figure(study):
    scene, found = small(), quantity("chain.axial_departure")
    for links in ("full", "transverse", "elastic"):
        for of in ("end", "rms"):
            words = {"segments": 21, "force": 6.0, "time": 4e-4, "x": 0.13, "inertia": links, "of": of}
            value = evaluate(found, arguments_of(found, words), scene, workbench_for(scene))
            row = getattr(study.rows[1], links)
            assert value == pytest.approx(row.at_end if of == "end" else row.rms, rel=1e-9)


def test_every_force_of_the_drive_takes_the_amplitude(study):
    """Amplitudes of the scene do not count; places and phases do."""
    other = studied(small("drive.force.0.amplitude=3.0"))
    assert other.rows[0] == study.rows[0]
    moved = studied(small("drive.force.0.phase_deg=20.0"))
    assert moved.rows[0].full.rms != pytest.approx(study.rows[0].full.rms, rel=1e-3)


def test_a_clamped_and_free_chain_departs_too():
    scene = small("beam.supports=clamped,free")
    row = studied(scene).rows[1]
    assert row.full.rms > 10 * row.transverse.rms


def test_there_is_one_definition_of_the_size():
    """The study's, the margins' and the plan's: a steady field's mean square slope at its own frequency."""
    from verify.motion.simulate import simulate

    beam = load_scene("paper-slider").beam
    forces = [one.on(beam) for one in load_scene("paper-slider").drive.force]
    field = solve_harmonic(beam, forces, 4100.0)
    slopes = abs(field.slope(np.linspace(0, beam.length, 400)))
    size = axial_inertia_size(beam, 4100.0, 0.5 * float((slopes**2).mean()))
    assert size == pytest.approx((abs(field.wavenumber) * beam.length) ** 2 * 0.5 * (slopes**2).mean(), rel=1e-9)
    margins = simulate(beam, forces, 4100.0, 1e-4, model="analytic", start="steady").margins
    assert margins.nonlinearity == pytest.approx(size, rel=1e-6)


def test_the_plan_says_up_to_which_force_the_linear_chain_will_do():
    scene = load_scene("chain")
    plan = plan_scene(scene)
    (choice,) = plan.chosen
    limit = float(choice.what.split()[4])
    forces = [replace(one, amplitude=limit) for one in scene.forces]
    slopes = abs(solve_harmonic(scene.beam, forces, 4276.0).slope(np.linspace(0, 0.5, 400)))
    assert axial_inertia_size(scene.beam, 4276.0, 0.5 * float((slopes**2).mean())) == pytest.approx(NONLINEAR, rel=0.05)
    assert choice.what.endswith("N, nonlinear above")
    assert "decided by the axial inertia" in choice.why
    assert any(who.startswith("axial_inertia (") and "18 motions of N = 49, 15 of them" in who for who in plan.stepped)
    assert "scikit-fem" not in {one.what for one in plan.skipped}


def test_the_plan_counts_the_chains_gates_as_what_they_are():
    plan = plan_scene(load_scene("chain"))
    assert plan.closed_forms == ()
    assert "gate hanging-limit" in plan.compiled
    assert {"gate ten-newton", "gate departure-at-one-newton", "gate energy-is-kept"} <= set(plan.stepped)
    assert not {"numba", "time stepping"} & {one.what for one in plan.skipped}
    without = plan_scene(replace(load_scene("chain"), axial_inertia=None))
    assert "axial_inertia study" in {one.what for one in without.skipped}
    assert without.chosen == ()


def test_a_run_carries_the_study_in_plain_data_and_counts_its_motions():
    scene = replace(small(), gate=())
    steps = []
    result = run_scene(scene, steps.append)
    assert len(steps) == n_steps(scene) == 3
    assert result.n_motions == 2 * 3 + 6
    assert "12 motions in time" in work_in_words(0, 0, result.n_motions)
    plain = json.loads(json.dumps(run_as_plain(result, None)))["axial_inertia"]
    assert [row["force"] for row in plain["rows"]] == [2.0, 6.0]
    assert plain["rows"][1]["full"]["at_end"] == result.found["axial_inertia"].rows[1].full.at_end
    assert plain["beside"][3]["model"] == "full"
    assert (plain["count"], plain["x"], plain["duration"], plain["shown"]) == (21, 0.13, 4e-4, 6.0)


def test_the_terminal_names_linear_and_nonlinear(capsys):
    words = last_of_each("gate=[]", *SMALL, "axial_inertia.forces=[2.0, 30.0]")
    assert status_of(["run", "chain", "--no-report", *(w for word in words for w in ("--set", word))]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "2 N: linear" in said
    assert "30 N: nonlinear" in said


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("axial_inertia.forces=[1.0, -2.0]", r"axial_inertia.forces\[1\] = -2.0: give a finite number above 0"),
        ("axial_inertia.forces=[]", "axial_inertia.forces"),
        ("axial_inertia.forces=[inf]", r"axial_inertia.forces\[0\] = inf: give a finite number"),
        ("axial_inertia.shown=0.0", "axial_inertia.shown = 0.0"),
        ("axial_inertia.count=1", "axial_inertia.count = 1"),
        ("axial_inertia.count=251", "axial_inertia.count = 251"),
        ("axial_inertia.duration=0.0", "axial_inertia.duration = 0.0: give a finite number above 0"),
        ("axial_inertia.x=0.6", "axial_inertia.x = 0.6 lies off the beam: give up to 0.5 m"),
        ("axial_inertia.x=-0.1", "axial_inertia.x = -0.1"),
        ("axial_inertia.force=1.0", "axial_inertia.force is not a known key: did you mean 'forces'"),
        ("drive.kind=displacement", "axial_inertia: the chain is driven by forces"),
        ("drive.force=[]", "axial_inertia: the chain is driven by forces"),
        ("beam.supports=pinned,clamped", "axial_inertia with beam.supports"),
        ("beam.supports=pinned,free", "axial_inertia with beam.supports"),
        ("beam.loss_factor=0.02", "axial_inertia with beam.loss_factor = 0.02: its chains move undamped, give 0"),
    ],
)
def test_a_scene_that_cannot_be_asked_is_refused(override, message):
    with pytest.raises(InputError, match=message):
        load_scene("chain", (override,))


def test_a_run_that_would_take_too_long_is_refused_with_its_estimate():
    """By steps of the fastest mode, not by seconds: those of a slow beam are long."""
    with pytest.raises(InputError, match=r"axial_inertia.duration = 2.5 would take about .* shorten it, or give fewer"):
        studied(small("axial_inertia.duration=2.5"))


def test_a_place_that_does_not_move_is_refused():
    """Equal forces in opposite phase leave the middle at rest."""
    with pytest.raises(InputError, match=r"x = 0.25: the beam does not move there"):
        studied(small("axial_inertia.x=0.25", "drive.force.0.phase_deg=180.0"))


def test_a_place_off_the_chain_is_refused_to_a_quantity_too():
    scene, found = small(), quantity("chain.axial_departure")
    with pytest.raises(InputError, match=r"x = 0.7 lies off the beam: give a place between 0 and 0.5 m"):
        evaluate(found, arguments_of(found, {"segments": 9, "force": 1.0, "x": 0.7}), scene, workbench_for(scene))


def test_a_force_that_turns_the_links_about_is_refused():
    with pytest.raises(InputError, match=r"under 50000.0 N the links turn by .* rad in the rms: give a smaller force"):
        studied(small("axial_inertia.forces=[2.0, 5e4]"))


def test_long_runs_keep_enough_samples_of_every_period():
    case = driven(duration=0.02)
    assert len(case.times) >= 40 * 4276 * 0.02
    assert len(driven(duration=1e-4).times) == 1001


def test_departures_along_the_beam_range_as_far_as_independent_equations_say():
    """Dense multiplier equations by DOP853 less the dense modal sum, at 10 N after 1 ms, at the tenths of the beam."""
    by_tenths = [1.3270, 3.70659, 4.05710, 4.927033, 3.8963973, 2.52522, 0.501337, 1.71129, 1.41796]
    case = driven_chain(load_scene("chain"), "test", 49, 1e-3, None)
    row = axial_figures.force_row(case, 10.0, linear_chain(case))
    assert 100 * np.array(row.along) == pytest.approx([min(by_tenths), max(by_tenths)], rel=1e-4)
    assert 100 * row.full.at_end == pytest.approx(by_tenths[4], rel=1e-5)
    near_the_end = driven_chain(load_scene("chain"), "test", 49, 1e-3, 0.006)
    assert departure(near_the_end, 10.0, "full").at_end == pytest.approx(0.0585, rel=1e-3)


def test_the_range_leaves_out_what_does_not_move():
    """Equal forces in opposite phase leave the middle at rest."""
    scene = small("axial_inertia.x=0.13", "drive.force.0.phase_deg=180.0")
    case = driven_chain(scene, "test", 21, 4e-4, 0.13)
    low, high = axial_figures.force_row(case, 2.0, linear_chain(case)).along
    assert 0.0 < low < high < 0.1


def test_the_plan_counts_the_steps_of_this_beam():
    def steps(*more):
        (who,) = (w for w in plan_scene(load_scene("chain", more)).stepped if w.startswith("axial_inertia ("))
        return float(who.split("about ")[1].split()[0])

    assert steps() == pytest.approx(1448, rel=0.1)
    assert steps("beam.thickness=0.003") == pytest.approx(3 * steps(), rel=0.05)
    assert steps("axial_inertia.count=98") == pytest.approx(4 * steps(), rel=0.05)


def test_a_study_as_rows_holds_every_departure_under_a_name_of_its_own(study):
    row = study.records()[1]
    assert len(row) == 12
    assert (row["transverse_rms"], row["elastic_rms"]) == (study.rows[1].transverse.rms, study.rows[1].elastic.rms)
    assert row["deflection_rms"] == study.rows[1].deflection_rms
