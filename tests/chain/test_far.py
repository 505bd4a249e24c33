"""Links that turn far: kicks that still follow them, and motions that nobody can know."""

from types import SimpleNamespace

import numpy as np
import pytest
from chain_reference import by_multipliers
from scipy.integrate import solve_ivp

from verify.beam import Beam, PointForce
from verify.chain import far, problems
from verify.chain.dynamics import energies
from verify.chain.problems import first_shape, transient
from verify.chain.ride import ride_from_rest
from verify.chain.splitting import modal_basis, simulate_modal
from verify.chain.stepping import simulate
from verify.chain.system import ChainState, build_system
from verify.errors import InputError
from verify.slider import Slider

STRIP = Beam(length=0.8, width=0.025, thickness=0.001, youngs_modulus=210e9, density=7850)
HERTZ, LINKS = 12.0, 8
TIMES = np.array([0.01, 0.02, 0.03, 0.04])


def pushed(force, times=TIMES, links=LINKS, **more):
    """The hinged strip from rest under a force off its middle."""
    return transient(STRIP, [PointForce(position=0.31, amplitude=force, phase_deg=30.0)], HERTZ, times, links, **more)


def by_hand(force):
    """Relative angles of the same by dense multipliers and DOP853, (n, N)."""
    system = pushed(force, [1e-4]).system
    found = solve_ivp(
        lambda t, y: np.concatenate([y[LINKS:], by_multipliers(system, t, y[:LINKS], y[LINKS:])]),
        (0.0, TIMES[-1]),
        np.zeros(2 * LINKS),
        method="DOP853",
        rtol=1e-10,
        atol=1e-13,
        t_eval=TIMES,
    )
    return found.y[:LINKS].T


def test_no_link_starts_upright_or_steeper():
    """Two links of 0.4 m meet 0.4 m above their ends where both stand upright."""
    system = build_system(STRIP, 2)
    assert first_shape(system, 0.39).angles == pytest.approx([np.arcsin(0.39 / 0.4), -2.0 * np.arcsin(0.39 / 0.4)])
    with pytest.raises(InputError, match="amplitude: a link would rise by 1 of its own length"):
        first_shape(system, 0.4)


@pytest.mark.parametrize("force", [60.0, 200.0])
def test_kicks_follow_links_that_turn_far_with_order_two(force):
    exact = by_hand(force)
    runs = [pushed(force, method="modal", step=step) for step in (1e-5, 5e-6)]
    errors = [np.sqrt(np.mean((run.angles - exact) ** 2)) for run in runs]
    assert runs[0].statistics.furthest > (2.2 if force == 200.0 else 0.5)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.2)
    assert errors[1] < 2e-3


def test_kicks_leave_the_tip_on_its_line_however_far_links_turn():
    runs = [pushed(200.0, method="modal", step=step) for step in (1e-5, 5e-6)]
    for run in runs:
        assert run.statistics.furthest > 2.2
        assert abs(run.deflection([0.8])[2:]).max() < 1e-9 * abs(run.deflection([0.4])).max()


def let_go(height, seconds, step):
    """The strip from rest at a height of its first shape by kicks: the start, and what is kept of it."""
    system = build_system(STRIP, LINKS)
    start = first_shape(system, height * STRIP.length)
    return start, simulate_modal(modal_basis(system), start, [seconds], step=step)


@pytest.mark.parametrize("height", [0.05, 0.25])
def test_an_undamped_chain_that_bends_far_keeps_its_energy_to_the_square_of_the_step(height):
    drifts = []
    for step in (2e-4, 1e-4):
        start, motion = let_go(height, 0.3, step)
        drifts.append(abs(sum(energies(motion.system, motion.state(0))) / sum(energies(motion.system, start)) - 1.0))
    assert drifts[1] < 1e-3
    assert drifts[1] < 0.4 * drifts[0]


def test_kicks_run_backwards_return_to_a_far_start_with_the_square_of_the_step():
    missed = []
    for step in (1e-4, 5e-5):
        start, there = let_go(0.25, 0.1, step)
        state = ChainState(there.angles[0], -there.rates[0])
        back = simulate_modal(modal_basis(there.system), state, [0.1], step=step)
        assert abs(there.angles[0] - start.angles).max() > 0.1
        missed.append(abs(back.angles[0] - start.angles).max())
    assert missed[1] < 1e-3
    assert missed[1] < 0.35 * missed[0]


@pytest.mark.parametrize("more", [{}, {"method": "rk4", "step": 2e-5}, {"method": "modal", "step": 5e-6}])
def test_a_far_motion_that_is_known_is_told_by_every_method(more):
    exact = by_hand(200.0)
    found = pushed(200.0, **more)
    assert np.cumsum(found.angles, axis=1) == pytest.approx(np.cumsum(exact, axis=1), abs=0.01)


@pytest.mark.parametrize(
    ("more", "field"),
    [
        ({}, r"tolerance = 1e-09 leaves .*, and with tolerance = 1e-08 "),
        ({"tolerance": 2e-3}, r"tolerance = 0.002 leaves .*, and with tolerance = 0.0002 "),
        ({"method": "rk4", "step": 2e-5}, r"step = 2e-05 leaves .*, and with step = 1e-05 "),
        ({"method": "modal", "step": 2e-5}, r"step = 2e-05 leaves .*, and with step = 4e-05 "),
    ],
)
def test_a_chaotic_motion_is_refused_with_what_to_change(more, field):
    with pytest.raises(
        InputError, match=field + r".*; give a smaller (step|tolerance), a shorter time or smaller"
    ) as why:
        pushed(3000.0, [0.05], 20, **more)
    assert len(str(why.value)) < 250


def test_a_tighter_tolerance_tells_what_a_looser_one_cannot():
    with pytest.raises(InputError, match=r"tolerance = 1e-09 leaves the motion unknown after 0.05 s"):
        pushed(1000.0, [0.05], 20)
    assert pushed(1000.0, [0.05], 20, tolerance=1e-11).deflection([0.4])[0, 0] == pytest.approx(0.03789, abs=2e-5)


def test_two_tolerances_part_by_several_times_what_the_tighter_one_misses():
    one, other, best = (pushed(500.0, [0.03], 20, tolerance=tolerance) for tolerance in (1e-7, 1e-6, 1e-11))
    assert 3.0 < far.gaps(one, other)[0] / far.gaps(best, one)[0] < 50.0


@pytest.mark.parametrize(
    "more", [{}, {"tolerance": 1e-6}, {"method": "rk4", "step": 2e-5}, {"method": "modal", "step": 2e-5}]
)
def test_a_motion_of_small_turns_takes_one_run_and_a_far_one_two(more, monkeypatch):
    runs = []
    for name in ("simulate", "simulate_modal"):
        true = getattr(problems, name)
        monkeypatch.setattr(problems, name, lambda *given, true=true, **kind: runs.append(1) or true(*given, **kind))
    assert pushed(10.0).statistics.furthest < far.FAR
    assert len(runs) == 1
    runs.clear()
    pushed(10.0, **more)
    assert len(runs) == 1
    runs.clear()
    pushed(60.0, **more)
    assert len(runs) == 2


def test_the_second_run_of_a_far_motion_is_the_smaller_part_of_the_work():
    system = build_system(STRIP, 20, [PointForce(position=0.31, amplitude=200.0)], HERTZ)
    start = ChainState(np.zeros(20), np.zeros(20))
    first, again = (
        simulate(system, start, [0.03], tolerance=t, ledger=False).statistics.evaluations
        for t in (1e-9, far.second("adaptive", 1e-9))
    )
    assert again < 0.75 * first


def test_links_that_stretch_and_turn_far_are_confirmed_by_half_their_step_or_refused():
    """Where the slider's figures and the departure's come from."""
    slider = Slider(mass=1e-3, mu=0.2, slope=100.0, position=0.31, coupling="one-way")

    def carried(force):
        forces = [PointForce(position=0.31, amplitude=force, phase_deg=30.0)]
        return ride_from_rest(STRIP, forces, HERTZ, slider, LINKS, 0.02, step=1e-3, links="stretching")

    assert abs(carried(200.0).chain.displacements[..., 1]).max() > 0.1
    with pytest.raises(InputError, match=r"step of the stretching chain = .* leaves the motion unknown after") as why:
        carried(4e4)
    assert str(why.value).endswith("; give a shorter time or smaller forces")


def test_heights_of_rigid_links_are_those_of_their_joints():
    from verify.chain import places

    moved = pushed(3.0)
    joints = places.place(moved.system, moved.times, moved.angles, moved.rates).joints
    assert abs(joints[:, 1:, 1]).max() > 1e-5
    assert far._heights(moved) == pytest.approx(joints[:, 1:, 1], rel=1e-13, abs=1e-18)


def test_a_second_run_that_is_broken_off_breaks_off_the_first():
    """What it would have confirmed nobody knows: the request to end goes on to whoever asked."""
    far_away = pushed(1500.0, links=4)
    broken = SimpleNamespace(statistics=SimpleNamespace(interrupted=True))
    with pytest.raises(KeyboardInterrupt):
        far.refuse_unknown(far_away, "adaptive", 1e-9, lambda tolerance: broken)
