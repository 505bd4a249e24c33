"""The nonlinear chain in time: conservation, reversal, known motions, orders, limits, and what stops a run."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from chain_reference import by_multipliers, woinowsky_krieger
from scipy.integrate import solve_ivp
from test_dynamics import beam, odd_chain, some_state

from verify.beam import PointForce
from verify.chain import kernels, splitting_kernels
from verify.chain import stepping as chain_motion
from verify.chain.dynamics import at_rest, energies, linearise, positions, project
from verify.chain.splitting import linear_deflection, modal_basis, simulate_linear, simulate_modal
from verify.chain.stepping import simulate, step_limit
from verify.chain.system import Actuator, ChainState, ChainSystem, LinkLoad, Rotation, build_system
from verify.errors import InputError
from verify.motion.validity import axial_inertia_size
from verify.segments import linear as segment_model


def free_chain(n=6, **more):
    """Undamped, without loads, its base at rest."""
    still = {"dashpots": np.zeros(n), "loads": (), "rotation": Rotation(), "gravity": (0.0, 0.0)}
    return odd_chain(n, n, **{**still, **more})


def energy_of(system, state):
    return sum(energies(system, state))


@pytest.mark.parametrize(
    "kind",
    [
        {},
        {"tip": "roller"},
        {"tip": "roller", "axial_spring": 300.0},
        {"axial_inertia": False},
        {"gravity": (2.0, -9.81)},
    ],
    ids=lambda kind: " ".join(kind) or "free tip",
)
def test_an_undamped_chain_keeps_its_energy_and_falls_short_with_the_tolerance(kind):
    system = free_chain(**kind)
    start = project(system, ChainState(0.3 * some_state(system, 1).angles, 0.5 * some_state(system, 2).rates))[0]
    drifts = []
    for tolerance in (1e-6, 1e-9):
        motion = simulate(system, start, [0.05, 0.1, 0.2], tolerance=tolerance)
        drifts.append(abs(motion.residual()).max() / energy_of(system, start))
    assert drifts[1] < 1e-6
    assert drifts[1] < 0.05 * drifts[0]


def test_a_free_tip_leaves_the_angular_momentum_about_a_pinned_base_alone():
    system = free_chain(7, stiffness=np.array([0.0, 2.0, 1.0, 3.0, 0.5, 2.5, 1.5]))
    start = ChainState(some_state(system, 4).angles, some_state(system, 5).rates)

    def momentum(state):
        place, speed = positions(system, state)
        middle, drift = (place[1:] + place[:-1]) / 2, (speed[1:] + speed[:-1]) / 2
        swept = middle[:, 0] * drift[:, 1] - middle[:, 1] * drift[:, 0]
        return float(system.masses @ swept + system.inertias @ np.cumsum(state.rates))

    motion = simulate(system, start, [0.1, 0.4], tolerance=1e-10)
    assert momentum(motion.state(1)) == pytest.approx(momentum(start), rel=1e-7)


def test_time_reversed_the_chain_returns():
    system = free_chain(6, tip="roller")
    start = project(system, ChainState(0.3 * some_state(system, 1).angles, 0.3 * some_state(system, 2).rates))[0]
    there = simulate(system, start, [0.11], tolerance=1e-11).state(0)
    back = simulate(system, ChainState(there.angles, -there.rates), [0.11], tolerance=1e-11).state(0)
    assert abs(there.angles - start.angles).max() > 0.05
    assert back.angles == pytest.approx(start.angles, abs=1e-7)
    assert -back.rates == pytest.approx(start.rates, abs=1e-7 * abs(start.rates).max())


@pytest.mark.parametrize("method", ["adaptive", "rk4"])
def test_one_link_with_spring_and_dashpot_decays_as_an_oscillator(method):
    inertia, spring, dashpot = 3e-5 + 0.02 * 0.05**2, 0.7, 1.3e-3
    one = np.ones(1)
    system = ChainSystem(
        lengths=0.1 * one, masses=0.02 * one, inertias=3e-5 * one, stiffness=spring * one, dashpots=dashpot * one
    )
    rate, omega = dashpot / (2 * inertia), np.sqrt(spring / inertia - (dashpot / (2 * inertia)) ** 2)
    times = np.linspace(0.01, 0.3, 7)
    options = {"step": 2e-4} if method == "rk4" else {"tolerance": 1e-10}
    motion = simulate(system, ChainState(0.4 * one, 0 * one), times, method=method, **options)
    exact = 0.4 * np.exp(-rate * times) * (np.cos(omega * times) + rate / omega * np.sin(omega * times))
    assert motion.angles[:, 0] == pytest.approx(exact, abs=3e-7)
    assert motion.dissipated[-1] == pytest.approx(0.5 * spring * 0.16 - energy_of(system, motion.state(-1)), rel=1e-5)


def test_a_turning_hub_drives_one_link_as_its_spring_says():
    one, inertia, spring = np.ones(1), 4e-5 + 0.03 * 0.06**2, 0.9
    hub = Rotation(amplitude=0.3, frequency_hz=5.0)
    system = ChainSystem(
        lengths=0.12 * one,
        masses=0.03 * one,
        inertias=4e-5 * one,
        stiffness=spring * one,
        dashpots=0 * one,
        rotation=hub,
    )
    own, drive = np.sqrt(spring / inertia), 2 * np.pi * 5.0
    times = np.linspace(0.02, 0.5, 9)
    motion = simulate(system, ChainState(0 * one, -0.3 * drive * one), times, tolerance=1e-11)
    gain = 0.3 * own**2 / (own**2 - drive**2)
    exact = gain * (np.sin(drive * times) - drive / own * np.sin(own * times))
    assert motion.angles[:, 0] + 0.3 * np.sin(drive * times) == pytest.approx(exact, abs=1e-7)
    assert abs(motion.residual()).max() < 1e-7 * motion.work_in.max()


@pytest.mark.parametrize(
    "extra",
    [
        {},
        {"tip": "roller", "axial_spring": 50.0},
        {
            "tip": "roller",
            "actuators": (Actuator(link=4, at=0.01, amplitude=2e-3, frequency_hz=30.0, phase_deg=-90.0),),
        },
    ],
)
def test_the_energy_ledger_closes_with_loads_dashpots_hub_and_actuators(extra):
    system = odd_chain(6, 6, **extra)
    start = project(system, ChainState(np.zeros(6), np.zeros(6)))[0]
    motion = simulate(system, start, np.linspace(0.0, 0.1, 11), tolerance=1e-10)
    assert motion.dissipated[-1] > 1e-3 * abs(motion.work_in).max()
    assert abs(motion.residual()).max() < 2e-6 * abs(motion.work_in).max()


def test_an_actuator_keeps_its_point_where_it_is_told():
    hold = Actuator(link=3, at=0.02, amplitude=3e-3, frequency_hz=25.0, phase_deg=30.0)
    system = free_chain(6, actuators=(hold,), tip="roller")
    start, _ = project(system, ChainState(np.zeros(6), np.zeros(6)))
    times = np.linspace(0.0, 0.1, 23)
    motion = simulate(system, start, times, tolerance=1e-9)
    x = float(system.lengths[:2].sum() + 0.02)
    told = 3e-3 * np.cos(2 * np.pi * 25.0 * times + np.deg2rad(30.0))
    assert motion.deflection([x])[:, 0] == pytest.approx(told, abs=1e-7)
    assert motion.deflection([system.length])[:, 0] == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_a_double_pendulum_agrees_with_independent_integrators(method):
    g, still = (0.0, -9.81), np.zeros(2)
    system = ChainSystem(
        lengths=np.array([0.31, 0.22]),
        masses=np.array([0.12, 0.2]),
        inertias=np.array([1e-3, 7e-4]),
        stiffness=still,
        dashpots=still,
        gravity=g,
    )
    start = ChainState(np.array([0.9, -1.7]), np.array([0.3, 2.0]))

    def slope(t, y):
        return np.concatenate([y[2:], by_multipliers(system, t, y[:2], y[2:])])

    exact = solve_ivp(
        slope, (0.0, 0.8), np.concatenate([start.angles, start.rates]), method=method, rtol=1e-9, atol=1e-11
    )
    motion = simulate(system, start, [0.8], tolerance=1e-11)
    assert np.concatenate([motion.angles[0], motion.rates[0]]) == pytest.approx(exact.y[:, -1], abs=2e-6)
    assert abs(motion.angles[0]).max() > 1.0


@pytest.mark.parametrize("method", ["DOP853", "Radau"])
def test_a_driven_chain_on_its_roller_agrees_with_independent_integrators(method):
    system = driven(6, 200.0)

    def slope(t, y):
        return np.concatenate([y[6:], by_multipliers(system, t, y[:6], y[6:])])

    exact = solve_ivp(slope, (0.0, 6e-4), np.zeros(12), method=method, rtol=1e-9, atol=1e-11)
    motion = simulate(system, at_rest(system), [6e-4], tolerance=1e-11)
    assert motion.angles[0] == pytest.approx(exact.y[:6, -1], abs=3e-8)
    assert abs(motion.angles[0]).max() > 1e-3


@pytest.mark.parametrize("dependent", [2, 5, 6])
def test_no_result_depends_on_which_angle_is_dependent(dependent):
    system = odd_chain(6, 6, tip="roller", rotation=Rotation())
    start = at_rest(system, 0.1 * some_state(system, 8).angles)
    one, other = (simulate(system, start, [0.05, 0.1], tolerance=1e-11, dependent=[d]) for d in (1, dependent))
    assert other.angles == pytest.approx(one.angles, abs=1e-8)
    assert positions(system, other.state(1))[0][-1, 1] == pytest.approx(0.0, abs=1e-9)


def test_a_roller_carried_past_the_pivots_turn_takes_another_pivot():
    """A crank that turns all the way round and a rod hardly longer: folded back, the crank's angle decides nothing."""
    still = np.zeros(2)
    system = ChainSystem(
        lengths=np.array([0.2, 0.21]),
        masses=np.array([0.2, 0.1]),
        inertias=np.array([2e-4, 6e-4]),
        stiffness=still,
        dashpots=still,
        tip="roller",
    )
    start, _ = project(system, ChainState(np.array([0.4, -0.6]), np.array([30.0, -40.0])), [2])
    motion = simulate(system, start, np.linspace(0.0, 1.0, 50), tolerance=1e-10)
    assert np.ptp(motion.angles[:, 0]) > 2 * np.pi
    assert motion.statistics.pivot_changes > 0
    assert abs(motion.residual()).max() < 1e-6 * energy_of(system, start)


def test_a_crank_between_an_actuator_and_a_roller_takes_other_pivots_between_two_looks_at_the_keyboard(monkeypatch):
    """The same crank, its rod's end moved a little, and a link from there to the roller: two angles are dependent."""
    monkeypatch.setattr(chain_motion, "_BUDGET", 60)
    still = np.zeros(3)
    system = ChainSystem(
        lengths=np.array([0.2, 0.201, 0.3]),
        masses=np.array([0.2, 0.1, 0.05]),
        inertias=np.array([2e-4, 6e-4, 3e-4]),
        stiffness=still,
        dashpots=still,
        tip="roller",
        actuators=(Actuator(link=2, at=0.201, amplitude=1e-5, frequency_hz=3.0),),
    )
    start, _ = project(system, ChainState(np.array([0.4, -0.6, 0.2]), np.array([30.0, -40.0, 10.0])))
    motion = simulate(system, start, np.linspace(0.0, 1.0, 50), tolerance=1e-10)
    assert motion.statistics.finished
    assert np.ptp(motion.angles[:, 0]) > 2 * np.pi
    assert motion.statistics.pivot_changes > 0
    assert abs(motion.residual()).max() < 1e-6 * energy_of(system, start)


def test_small_motion_is_the_linear_chains():
    which, n = beam(), 15
    modes = segment_model.solve_modes(which, 3, n)
    system = build_system(which, n)
    shape = modes.readings["raw"]()[2] * 1e-7
    theta = np.arcsin(np.diff(shape) / system.lengths)
    period = 1 / modes.frequencies_hz[2]
    motion = simulate(
        system, at_rest(system, np.diff(theta, prepend=0.0)), [period / 4, period / 2, period], tolerance=1e-11
    )
    middle = motion.deflection([float(system.nodes[4])])[:, 0]
    assert middle == pytest.approx(shape[4] * np.array([0.0, -1.0, 1.0]), abs=1e-6 * abs(shape[4]))


def large_amplitude_ratio(n, amplitude):
    """Frequency of the first mode of a hinged chain between immovable ends over the linear chain's."""
    which = beam()
    system = build_system(which, n, immovable=True)
    radius = which.thickness / np.sqrt(12)
    shape = amplitude * radius * np.sin(np.pi * np.arange(n + 1) / n)
    theta = np.arcsin(np.diff(shape) / system.lengths)
    linear = linearise(system, at_rest(system)).frequencies()[0]
    times = np.linspace(0.0, 2.4 / linear, 600)
    motion = simulate(system, at_rest(system, np.diff(theta, prepend=0.0)), times, tolerance=1e-10, ledger=False)
    middle = motion.deflection([which.length / 2])[:, 0]
    k = int(np.argmax(middle < 0))
    crossing = np.interp(0.0, [middle[k], middle[k - 1]], [times[k], times[k - 1]])
    return np.pi / 2 / crossing / linear


@pytest.mark.parametrize("n", [2, 5, 16])
@pytest.mark.parametrize("amplitude", [0.7, 2.0])
def test_immovable_ends_stiffen_as_woinowsky_and_krieger_say(n, amplitude):
    """With any number of links: stretch and bending are short of the beam's by one and the same factor."""
    assert large_amplitude_ratio(n, amplitude) == pytest.approx(woinowsky_krieger(amplitude), rel=3e-6 * amplitude**2)


def driven(n, amplitude, **more):
    forces = [
        PointForce(position=0.012, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=0.41, amplitude=amplitude),
    ]
    return build_system(beam(), n, forces, 3800.0, **more)


def rms(values):
    return float(np.sqrt(np.mean(values**2)))


def test_fixed_steps_converge_with_order_four():
    system, times = driven(12, 3.0), [4e-4]
    exact = simulate(system, at_rest(system), times, tolerance=1e-12).angles
    errors = [
        abs(simulate(system, at_rest(system), times, method="rk4", step=h).angles - exact).max() for h in (2e-5, 1e-5)
    ]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4.0, abs=0.3)


def test_kicked_motion_is_the_same_at_times_of_any_spacing():
    """Several of them within one step as well: what is kept is the flow from the step's start."""
    system = driven(12, 60.0)
    basis = modal_basis(system)
    even = np.linspace(1e-5, 2e-4, 77)
    some = even[[0, 2, 3, 11, 30, 31, 45, 76]]
    every, few = (simulate_modal(basis, at_rest(system), t, step=1.3e-5).deflection([0.2]) for t in (even, some))
    assert few == pytest.approx(every[[0, 2, 3, 11, 30, 31, 45, 76]], rel=1e-10, abs=1e-13)


@pytest.mark.parametrize(("kicks", "amplitude"), [(1, 60.0), (2, 60.0), (3, 60.0)])
def test_kicks_are_of_order_two_and_two_kicks_far_better_than_one(kicks, amplitude):
    system, times = driven(20, amplitude), np.linspace(1e-5, 6e-4, 60)
    exact = simulate(system, at_rest(system), times, tolerance=1e-11).deflection([0.2])
    basis = modal_basis(system)
    errors = [
        rms(simulate_modal(basis, at_rest(system), times, step=h, kicks=kicks).deflection([0.2]) - exact) / rms(exact)
        for h in (1e-5, 5e-6)
    ]
    assert np.log2(errors[0] / errors[1]) > 1.8
    assert errors[1] < (3e-4 if kicks == 1 else 3e-5)


@pytest.mark.parametrize("n", [3, 5, 8])
def test_kicks_feel_the_rates_of_all_modes_whether_they_are_even_or_odd_in_number(n):
    """Few links under large forces; what a lost rate leaves does not fall with the step."""
    system, times = driven(n, 600.0), np.linspace(1e-5, 6e-4, 60)
    exact = simulate(system, at_rest(system), times, tolerance=1e-12).deflection([0.2])
    basis = modal_basis(system)
    runs = [simulate_modal(basis, at_rest(system), times, step=h).deflection([0.2]) for h in (1e-5, 5e-6)]
    errors = [rms(run - exact) for run in runs]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.1, abs=0.15)


def test_kicks_beat_fixed_steps_at_the_same_work_and_pass_their_limit():
    system, times = driven(60, 10.0), np.linspace(5e-6, 5e-4, 100)
    exact = simulate(system, at_rest(system), times, tolerance=1e-9).deflection([0.2])
    limit = step_limit(system, at_rest(system))
    kicked = simulate_modal(modal_basis(system), at_rest(system), times, step=2 * limit, kicks=1)
    stepped = simulate(system, at_rest(system), times, method="rk4", step=0.9 * limit)
    error, rival = (rms(m.deflection([0.2]) - exact) / rms(exact) for m in (kicked, stepped))
    assert error < 5e-3
    assert kicked.statistics.evaluations < 0.35 * stepped.statistics.evaluations
    assert (kicked.statistics.rejected, stepped.statistics.rejected) == (0, 0)
    assert error < rival


def test_modes_left_out_move_as_the_linear_chains_and_cost_a_part_of_the_nonlinearity():
    """What they add to the axial inertia is lost: up to a quarter of the nonlinear part here, nothing of the linear."""
    system, times = driven(70, 40.0), np.linspace(5e-6, 5e-4, 100)
    exact = simulate(system, at_rest(system), times, tolerance=1e-9).deflection([0.2])
    basis = modal_basis(system)
    linear = rms(simulate_linear(basis, at_rest(system), times).deflection([0.2]) - exact)
    few, all_ = (
        rms(simulate_modal(basis, at_rest(system), times, step=1e-5, n_modes=m).deflection([0.2]) - exact)
        for m in (46, 69)
    )
    assert all_ < 0.02 * linear < few < 0.4 * linear


def test_the_exact_linear_flow_is_the_limit_of_small_forces():
    system, times = driven(25, 1e-3), np.linspace(0.0, 5e-4, 80)
    exact = simulate(system, at_rest(system), times, tolerance=1e-11).deflection([0.2, 0.31])
    flow = simulate_linear(modal_basis(system), at_rest(system), times).deflection([0.2, 0.31])
    assert rms(flow - exact) < 1e-7 * rms(exact)


def test_one_points_linear_motion_is_read_without_all_the_others():
    system, times = driven(25, 2.0), np.linspace(3e-5, 5e-4, 83)
    basis, start = modal_basis(system), at_rest(driven(25, 2.0), np.linspace(-1e-4, 1e-4, 25))
    flow = simulate_linear(basis, start, times).deflection([0.21])[:, 0]
    assert linear_deflection(basis, start, times, 0.21) == pytest.approx(flow, abs=1e-6 * abs(flow).max())
    with pytest.raises(InputError, match="evenly spaced"):
        linear_deflection(basis, start, np.array([0.0, 1e-5, 3e-5]), 0.21)


def test_samples_inside_a_step_are_as_good_as_its_ends():
    system = driven(12, 3.0)
    times = np.linspace(0.0, 4e-4, 173)
    exact = simulate(system, at_rest(system), times, tolerance=1e-12)
    motion = simulate(system, at_rest(system), times, method="rk4", step=1e-5)
    ends = simulate(system, at_rest(system), np.arange(1, 41) * 1e-5, method="rk4", step=1e-5)
    best = simulate(system, at_rest(system), np.arange(1, 41) * 1e-5, tolerance=1e-12)
    assert rms(motion.angles - exact.angles) < 1.5 * rms(ends.angles - best.angles)
    assert rms(motion.rates - exact.rates) < 6 * rms(ends.rates - best.rates)


@pytest.mark.parametrize("n", [10, 40])
def test_the_stable_step_is_that_of_the_fastest_mode(n):
    system = driven(n, 1.0)
    fastest = linearise(system, at_rest(system)).frequencies()[-1]
    assert step_limit(system, at_rest(system)) == pytest.approx(2 * np.sqrt(2) / fastest, rel=3e-3)
    assert step_limit(replace(system, dashpots=np.full(n, 1e-2)), at_rest(system)) < 2.5 / fastest


def test_one_points_linear_motion_is_the_same_whichever_way_its_times_run():
    system, times = driven(9, 2.0), np.linspace(3e-5, 5e-4, 31)
    basis = modal_basis(system)
    forth, back = (linear_deflection(basis, at_rest(system), t, 0.21) for t in (times, times[::-1]))
    assert back[::-1] == pytest.approx(forth, abs=1e-9 * abs(forth).max())


def test_a_step_above_the_limit_is_refused_with_the_limit():
    system = driven(20, 1.0)
    limit = step_limit(system, at_rest(system))
    with pytest.raises(InputError, match=rf"step = .* lies above the stability limit {limit:.4g} s of rk4"):
        simulate(system, at_rest(system), [1e-3], method="rk4", step=1.02 * limit)
    assert simulate(system, at_rest(system), [1e-3], method="rk4", step=0.98 * limit).finished


def test_a_run_that_has_become_cheap_is_not_refused_for_a_dear_beginning():
    """What is left is told by the cheaper of all that is done and of the last part."""
    machine = SimpleNamespace(clock=[0.0], samples=[0.0, 1.0], counts=[0, 0, 0])
    pace = chain_motion._Pace(SimpleNamespace(m=machine, system=SimpleNamespace(n_links=8)), most=9e5)
    machine.clock[0], machine.counts[2] = 0.1, 4000
    assert pace.part() == pytest.approx(0.1)
    machine.clock[0], machine.counts[2] = 0.2, 14_000
    with pytest.raises(InputError, match="accelerations of links"):
        pace.part()
    machine.clock[0], machine.counts[2] = 0.3, 14_500
    assert pace.part() == pytest.approx(0.3)


def test_a_run_that_diverges_stops_at_once_and_keeps_what_it_has(monkeypatch):
    monkeypatch.setattr(chain_motion, "refuse_unstable", lambda *given: None)
    system = driven(20, 1.0)
    limit = step_limit(system, at_rest(system))
    times = np.linspace(0.0, 5e-2, 500)
    motion = simulate(system, at_rest(system), times, method="rk4", step=1.1 * limit)
    assert motion.statistics.stopped.startswith("diverged at t = ")
    assert not motion.finished
    assert 0 < len(motion.times) < 500
    assert motion.statistics.steps * 1.1 * limit < 0.5 * times[-1]
    assert np.isfinite(motion.angles).all()


def test_ctrl_c_returns_what_is_kept(monkeypatch):
    true, calls = kernels.march, []

    def interrupted(flat, run, budget, work):
        calls.extend([1] * (budget > 0))
        if len(calls) > 3:
            raise KeyboardInterrupt
        return true(flat, run, budget, work)

    monkeypatch.setattr(kernels, "march", interrupted)
    monkeypatch.setattr(chain_motion, "_BUDGET", 400)
    system = driven(20, 1.0)
    motion = simulate(system, at_rest(system), np.linspace(0.0, 1e-2, 400), method="rk4", step=2e-5)
    assert motion.statistics.stopped.startswith("interrupted at t = ")
    assert 10 < len(motion.times) < 400


def test_ctrl_c_returns_the_kicks_that_were_taken(monkeypatch):
    true, calls = splitting_kernels.march_modal, []

    def interrupted(*given):
        calls.append(1)
        if len(calls) > 2:
            raise KeyboardInterrupt
        return true(*given)

    monkeypatch.setattr(splitting_kernels, "march_modal", interrupted)
    system = driven(8, 1.0)
    motion = simulate_modal(modal_basis(system), at_rest(system), np.linspace(0.0, 1e-2, 400), step=1e-5)
    assert motion.statistics.stopped.startswith("interrupted at t = ")
    assert 100 < len(motion.times) < 400


def test_kicks_too_strong_for_their_step_are_stopped_and_said():
    system = driven(20, 3e4)
    motion = simulate_modal(modal_basis(system), at_rest(system), np.linspace(0.0, 5e-3, 50), step=1e-4)
    assert motion.statistics.stopped.startswith("diverged at t = ")
    assert len(motion.times) < 50
    assert np.isfinite(motion.angles).all()


def test_axial_inertia_makes_the_roller_ended_chain_nonlinear_with_the_square_of_its_slopes():
    times, departures = np.linspace(0.0, 8e-4, 161), []
    for amplitude in (3.0, 6.0):
        system = driven(49, amplitude)
        linear = simulate_linear(modal_basis(system), at_rest(system), times).deflection([0.215])
        full = simulate(system, at_rest(system), times, tolerance=1e-9, ledger=False)
        light = simulate(replace(system, axial_inertia=False), at_rest(system), times, tolerance=1e-9, ledger=False)
        departures.append(rms(full.deflection([0.215]) - linear) / rms(linear))
        size = axial_inertia_size(beam(), 3800.0, rms(full.directions()) ** 2)
        assert 0.2 < departures[-1] / size < 5.0
        assert rms(light.deflection([0.215]) - linear) < 0.02 * departures[-1] * rms(linear)
    assert departures[1] / departures[0] == pytest.approx(4.0, rel=0.05)


def test_an_inconsistent_start_is_projected_and_said():
    system = driven(9, 1.0)
    bent = ChainState(np.full(9, 0.02), np.full(9, 0.5))
    motion = simulate(system, bent, [0.0, 1e-5])
    assert motion.statistics.started.startswith("projected onto the held points")
    assert positions(system, motion.state(0))[0][-1, 1] == pytest.approx(0.0, abs=1e-14)
    assert simulate(system, at_rest(system), [1e-5]).statistics.started == "consistent"
    kicked = simulate_modal(modal_basis(system), bent, [1e-5], step=1e-5)
    assert kicked.statistics.started == motion.statistics.started


def test_results_repeat_to_the_last_bit():
    system = driven(12, 5.0)
    first, second = (simulate(system, at_rest(system), [1e-4, 3e-4]).angles for _ in range(2))
    assert np.array_equal(first, second)


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"method": "euler"}, "method = 'euler' is not known"),
        ({"method": "rk4"}, "step = None: give a step"),
        ({"step": 1e-6}, "none with 'adaptive'"),
        ({"method": "rk4", "step": -1e-6}, "step = -1e-06"),
        ({"tolerance": 0.0}, "tolerance = 0.0"),
        ({"times": [0.1, 0.1]}, "times: give ascending"),
        ({"times": []}, "times: give ascending"),
        ({"times": [-1.0]}, "from 0.0 s on"),
        ({"times": [np.nan]}, "times: give ascending"),
        ({"dependent": [1, 2]}, "dependent = "),
    ],
)
def test_bad_requests_are_refused(request_, message):
    system = driven(8, 1.0)
    with pytest.raises(InputError, match=message):
        simulate(system, at_rest(system), request_.pop("times", [1e-4]), **request_)


@pytest.mark.parametrize(
    ("request_", "message"),
    [
        ({"step": 0.0}, "step = 0.0"),
        ({"step": 1e-5, "kicks": 4}, "kicks = 4"),
        ({"step": 1e-5, "n_modes": 8}, "there are modes 1 to 7"),
    ],
)
def test_bad_requests_of_kicks_are_refused(request_, message):
    system = driven(8, 1.0)
    with pytest.raises(InputError, match=message):
        simulate_modal(modal_basis(system), at_rest(system), [1e-4], **request_)


@pytest.mark.parametrize(
    "supports", [("pinned", "pinned"), ("clamped", "free"), ("clamped", "pinned"), ("pinned", "free")]
)
def test_the_lowest_modes_alone_are_the_first_of_all(supports):
    system = build_system(beam(*supports), 24, [PointForce(position=0.1)], 900.0)
    every, few = modal_basis(system), modal_basis(system, n_modes=9)
    rigid = supports == ("pinned", "free")
    held = supports[1] == "pinned"
    same = slice(int(rigid), 9 + int(rigid))
    assert few.omega[:9] == pytest.approx(every.omega[same], rel=1e-9)
    assert abs(few.shares[:, :9]) == pytest.approx(abs(every.shares[:, same]), rel=1e-6)
    assert few.duals @ few.modes.T == pytest.approx(np.eye(9 + held), abs=1e-9)
    assert few.tilt == pytest.approx(every.tilt, rel=1e-9)


def test_three_thousand_links_move_in_steps_a_thousand_times_the_explicit_limit():
    times, step = np.linspace(1e-5, 3e-4, 30), 1e-5
    forces = [PointForce(position=0.043, amplitude=10.0, phase_deg=-90.0), PointForce(position=0.387, amplitude=10.0)]

    def middle(n):
        system = build_system(beam(), n, forces, 3800.0)
        motion = simulate_modal(modal_basis(system, n_modes=50), at_rest(system), times, step=step, kicks=1)
        return motion.deflection([0.215])[:, 0]

    long = build_system(beam(), 3000)
    assert step > 1000 * 2 * np.sqrt(2) / (np.sqrt(48) * beam().wave_constant / long.lengths[0] ** 2)
    assert rms(middle(3000) - middle(1000)) < 3e-3 * rms(middle(1000))


@pytest.mark.parametrize(
    ("change", "request_", "message"),
    [
        ({}, {"n_modes": 8}, "elastic modes 1 to 7"),
        ({"gravity": (0.0, -9.81)}, {"n_modes": 3}, "unloaded chain"),
        ({"stiffness": np.zeros(8)}, {"n_modes": 3}, "joints without a spring"),
        ({}, {"n_modes": 3, "rest": ChainState(np.zeros(8), np.zeros(8))}, "give n_modes or rest"),
    ],
)
def test_lowest_modes_that_are_not_there_are_refused(change, request_, message):
    with pytest.raises(InputError, match=message):
        modal_basis(replace(driven(8, 1.0), **change), **request_)


def test_what_has_no_modal_flow_is_refused():
    with pytest.raises(InputError, match="no modal flow"):
        modal_basis(free_chain(6, actuators=(Actuator(link=2, at=0.01),)))


def test_places_off_the_chain_are_refused():
    motion = simulate(driven(8, 1.0), at_rest(driven(8, 1.0)), [1e-5])
    with pytest.raises(InputError, match="lies off the chain"):
        motion.deflection([0.5])


def test_a_constant_end_moment_bends_a_damped_cantilever_to_its_equilibrium():
    from verify.chain.statics import solve_static

    system = build_system(beam("clamped", "free"), 5, joint_dashpot=2e-2)
    system = replace(system, loads=(LinkLoad(link=5, at=0.0, moment=0.5),))
    motion = simulate(system, at_rest(system), [8.0], tolerance=1e-6)
    assert motion.angles[0] == pytest.approx(solve_static(system).angles, abs=1e-5)


@pytest.mark.parametrize("step", [2e-4, 1e-3])
def test_a_roller_that_goes_far_is_on_its_line_to_rounding_whatever_the_step(step):
    """Links turn by 0.8 rad: Newton's method goes on until nothing is left, from above and below the line."""
    system = build_system(beam(), 9, [PointForce(position=0.1, amplitude=0.3)], 60.0)
    start, _ = project(system, ChainState(np.r_[0.9, np.full(8, -0.21)], np.zeros(9)))
    moved = simulate_modal(modal_basis(system), start, np.linspace(0.0, 0.02, 21), step=step)
    leans, turns = np.cumsum(moved.angles, axis=1), np.cumsum(moved.rates, axis=1)
    heights, climbs = np.sin(leans) @ system.lengths, (np.cos(leans) * turns) @ system.lengths
    assert moved.statistics.finished
    assert np.ptp(moved.angles[:, 0]) > 0.5
    assert abs(heights).max() < 1e-14
    assert abs(climbs).max() < 1e-12 * abs(turns).max()
