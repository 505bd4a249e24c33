"""Small motion of the nonlinear chain: bases that turn, equilibria that do not hold, and what is said of them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh

from verify.beam import Beam
from verify.chain.dynamics import accelerations, at_rest, linearise
from verify.chain.problems import UNIT_CANTILEVER, turning_frequency
from verify.chain.small_motion import Linearisation
from verify.chain.splitting import linear_deflection, modal_basis, simulate_linear, simulate_modal
from verify.chain.statics import solve_static
from verify.chain.stepping import simulate
from verify.chain.system import Actuator, ChainState, ChainSystem, LinkLoad, Rotation, build_system
from verify.errors import InputError

FLAPPING = {
    3.0: (4.797278532363, 23.3202636743, 62.98496748068),
    12.0: (13.17015048751, 37.60311233119, 79.61447848946),
}
"""Omega sqrt(rho A L^4 / EI) of a cantilever that turns, across its plane: power series of 40 digits."""


def hinged(n, share, length=0.43):
    """A hinged beam of n links pressed with a share of Euler's load, and its mass and stiffness."""
    which = Beam(length=length, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0)
    system = build_system(which, n)
    push = share * np.pi**2 * which.bending_stiffness / length**2
    load = LinkLoad(link=n, at=float(system.lengths[-1]), force=(-push, 0.0))
    return replace(system, loads=(load,)), which, push


def odd_turning(rate, moment=0.3, n=6):
    """Uneven links with dashpots, bent by moments, on a base that turns."""
    rng = np.random.default_rng(3)
    lengths, masses = rng.uniform(0.02, 0.07, n), rng.uniform(0.01, 0.04, n)
    loads = (LinkLoad(link=3, at=0.01, moment=moment), LinkLoad(link=n, at=0.01, moment=0.4 * moment))
    return ChainSystem(
        lengths=lengths,
        masses=masses,
        inertias=masses * lengths**2 / 9,
        stiffness=np.linspace(0.5, 4.0, n),
        dashpots=np.full(n, 2e-3),
        rotation=Rotation(offset=0.2, rate=rate),
        loads=loads,
    )


@pytest.mark.parametrize("speed", FLAPPING)
@pytest.mark.parametrize("mode", [1, 2, 3])
def test_lead_lag_of_a_turning_cantilever_comes_from_flapping_with_order_two(speed, mode):
    exact = np.sqrt(FLAPPING[speed][mode - 1] ** 2 - speed**2)
    errors = [turning_frequency(mode, n, speed) / exact - 1.0 for n in (80, 160, 320)]
    assert 1e-6 < errors[2] < 2e-5
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert orders[1] == pytest.approx(2.0, abs=0.03)
    assert abs(orders[1] - 2.0) <= abs(orders[0] - 2.0) + 0.01


def test_a_clamp_that_stands_still_has_the_linear_chains_order_four():
    errors = [turning_frequency(2, n, 0.0, "five-joint") - 4.694091132974**2 for n in (20, 40)]
    assert abs(errors[1]) < 1e-4
    assert np.log2(abs(errors[0] / errors[1])) > 3.7


@pytest.mark.parametrize("speed", [0.0, 5.0])
def test_a_turning_chain_let_go_swings_at_the_frequency_of_its_linearisation(speed):
    system = replace(build_system(UNIT_CANTILEVER, 8), rotation=Rotation(rate=speed))
    linear = linearise(system, at_rest(system))
    omega = linear.frequencies()[0]
    shape = eigh(linear.stiffness, linear.mass)[1][:, 0]
    start = ChainState(1e-5 * shape / abs(shape).max(), np.zeros(8))
    times = np.linspace(0.0, 2.6 * 2 * np.pi / omega, 4001)
    angle = simulate(system, start, times, tolerance=1e-11).angles[:, 0]
    down = np.flatnonzero((angle[:-1] * angle[1:] < 0.0) & (angle[1:] < angle[:-1]))
    assert len(down) in (2, 3)
    crossed = times[down] + angle[down] / (angle[down] - angle[down + 1]) * times[1]
    swing = abs(np.diff(crossed))[0]
    assert 2 * np.pi / swing == pytest.approx(omega, rel=2e-6)
    assert omega == pytest.approx({0.0: 1.01499995, 5.0: 1.75821176}[speed], rel=1e-7)


def test_a_bent_turning_equilibrium_has_the_derivatives_of_its_accelerations():
    """By angles the centrifugal stiffness, by rates the gyroscopic moments."""
    system = odd_turning(30.0)
    rest = solve_static(system)
    assert abs(accelerations(system, rest)).max() < 1e-9 * abs(accelerations(system, at_rest(system))).max()
    assert np.ptp(np.cumsum(rest.angles)) > 0.4
    linear, h, still = linearise(system, rest), 1e-5, np.zeros(6)

    def slope(make):
        return np.array(
            [(accelerations(system, make(h * e)) - accelerations(system, make(-h * e))) / (2 * h) for e in np.eye(6)]
        ).T

    by_angles = slope(lambda step: ChainState(rest.angles + step, still))
    by_rates = slope(lambda step: ChainState(rest.angles, step))
    assert by_angles == pytest.approx(-np.linalg.solve(linear.mass, linear.stiffness), abs=1e-8 * abs(by_angles).max())
    damping = linear.damping + linear.gyroscopic
    assert by_rates == pytest.approx(-np.linalg.solve(linear.mass, damping), abs=1e-7 * abs(by_rates).max())
    assert abs(linear.gyroscopic).max() > abs(linear.damping).max()
    assert linear.gyroscopic == pytest.approx(-linear.gyroscopic.T)


def test_bent_turning_squares_solve_the_quadratic_eigenproblem():
    system = replace(odd_turning(30.0), dashpots=np.zeros(6))
    linear = linearise(system, solve_static(system))
    for omega in np.sqrt(linear.squares()):
        matrix = linear.stiffness + 1j * omega * linear.gyroscopic - omega**2 * linear.mass
        values = np.linalg.svd(matrix / abs(matrix).max(), compute_uv=False)
        assert values[-1] < 1e-9 * values[0]


@pytest.mark.parametrize("n", [9, 200])
@pytest.mark.parametrize("share", [0.5, 1.5])
def test_squares_of_a_pressed_chain_are_signed_and_those_of_the_closed_form(n, share):
    system, which, push = hinged(n, share)
    half, link = np.sin(np.arange(1, n) * np.pi / (2 * n)), which.length / n
    exact = (16 * half**4 * which.bending_stiffness / link**4 - 4 * half**2 * push / link**2) / (
        (1 - 2 * half**2 / 3) * which.mass_per_length
    )
    found = linearise(system, at_rest(system)).squares()
    assert (found[0] < 0) == (share > 1)
    assert found[:5] == pytest.approx(exact[:5], rel=1e-12)
    assert found == pytest.approx(np.sort(exact), rel=1e-7)


@pytest.mark.parametrize(("share", "words"), [(1.5, "mode 1 grows"), (5.0, "modes 1 to 2 grow")])
def test_what_is_unstable_is_named_and_neither_a_frequency_nor_a_flow_is_made_of_it(share, words):
    system = hinged(200, share)[0]
    message = rf"the equilibrium is unstable: {words} \(omega\^2 = -.* 1/s\^2, e-fold in .* s\)"
    with pytest.raises(InputError, match=message):
        linearise(system, at_rest(system)).frequencies()
    with pytest.raises(InputError, match=message):
        modal_basis(system)


def test_a_chain_that_grows_in_time_grows_as_its_square_says():
    system = hinged(12, 1.5)[0]
    linear = linearise(system, at_rest(system))
    basis, rate = linear.independent(), np.sqrt(-linear.squares()[0])
    shape = basis @ eigh(basis.T @ linear.stiffness @ basis, basis.T @ linear.mass @ basis)[1][:, 0]
    start = ChainState(1e-7 * shape / abs(shape).max(), np.zeros(12))
    motion = simulate(system, start, [0.0, 2.0 / rate], tolerance=1e-10)
    assert motion.angles[-1] == pytest.approx(np.cosh(2.0) * start.angles, rel=1e-5, abs=1e-9 * abs(start.angles).max())


def test_motions_without_a_spring_are_zero_and_not_unstable():
    which = Beam(
        length=0.43, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0, supports=("pinned", "free")
    )
    for n in (2, 40, 300):
        linear = linearise(build_system(which, n), at_rest(build_system(which, n)))
        assert linear.squares()[0] == linear.frequencies()[0] == 0.0
        assert linear.squares()[1] > 0.0


def test_a_hanging_chain_upside_down_falls_and_one_link_under_a_roller_has_no_motion():
    n, still = 7, np.zeros(7)
    up = ChainSystem(
        lengths=np.full(n, 0.1),
        masses=np.full(n, 0.02),
        inertias=np.full(n, 2e-5),
        stiffness=still,
        dashpots=still,
        gravity=(-9.81, 0.0),
    )
    assert (linearise(up, at_rest(up)).squares() < 0.0).all()
    with pytest.raises(InputError, match="modes 1 to 7 grow"):
        linearise(up, at_rest(up)).frequencies()
    one = hinged(1, 0.0)[0]
    assert linearise(one, at_rest(one)).squares().shape == (0,)


def test_a_gyroscope_may_hold_what_springs_let_go_or_flutter():
    """I q'' + G q' - diag(1, 2) q = 0: omega^2 = 3 +- sqrt 7 at G = 3, complex at G = 2."""

    def spun(g):
        turn = g * np.array([[0.0, 1.0], [-1.0, 0.0]])
        return Linearisation(
            mass=np.eye(2),
            damping=np.zeros((2, 2)),
            stiffness=-np.diag([1.0, 2.0]),
            constraint=np.zeros((0, 2)),
            gyroscopic=turn,
        )

    assert spun(3.0).squares() == pytest.approx([3 - np.sqrt(7), 3 + np.sqrt(7)], rel=1e-12)
    with pytest.raises(InputError, match=r"it flutters at .* rad/s and grows with .* 1/s"):
        spun(2.0).frequencies()
    with pytest.raises(InputError, match="modes 1 to 2 grow"):
        spun(0.1).frequencies()


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"tip": "roller"}, "a roller"),
        ({"actuators": (Actuator(link=2, at=0.01),)}, "an actuator"),
        ({"gravity": (0.0, -9.81)}, "gravity"),
        ({"loads": (LinkLoad(link=2, at=0.01, force=(0.1, 0.0)),)}, "a dead force"),
        ({"axial_inertia": False}, "inertia across one direction alone"),
    ],
)
def test_what_does_not_turn_with_the_base_is_refused(change, what):
    system = replace(odd_turning(30.0), **change)
    state = ChainState(np.zeros(6), np.zeros(6))
    for ask in (lambda: linearise(system, state), lambda: solve_static(system, state)):
        with pytest.raises(InputError, match=rf"rotation.rate = 30.0: {what} does not turn with the base"):
            ask()
    assert len(linearise(replace(system, rotation=Rotation(offset=0.2)), state).squares())


def test_a_harmonic_force_does_not_keep_a_turning_chain_from_its_equilibrium():
    system = replace(odd_turning(30.0), loads=(LinkLoad(link=2, at=0.01, force=(0.1, 0.2), frequency_hz=5.0),))
    assert linearise(system, at_rest(system)).frequencies()[0] > 0.0


def test_an_amplitude_without_a_frequency_is_a_part_of_the_offset():
    bent = replace(odd_turning(0.0), rotation=Rotation(offset=0.5), gravity=(0.0, -9.81))
    same = replace(bent, rotation=Rotation(offset=0.2, amplitude=0.6, phase_deg=30.0))
    rests = [solve_static(system) for system in (bent, same)]
    assert rests[1].angles == pytest.approx(rests[0].angles, rel=1e-12)
    assert abs(accelerations(same, rests[1])).max() < 1e-8 * abs(accelerations(same, at_rest(same))).max()
    squares = [linearise(s, r).squares() for s, r in zip((bent, same), rests, strict=True)]
    assert squares[1] == pytest.approx(squares[0], rel=1e-10)


def test_a_state_that_moves_is_no_equilibrium():
    system = odd_turning(0.0)
    with pytest.raises(InputError, match=r"state.rates: a chain is linearised about an equilibrium"):
        linearise(system, ChainState(np.zeros(6), np.full(6, 0.1)))


def test_a_linear_flow_refuses_dashpots_and_kicks_with_all_modes_take_them():
    which = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=68e9, density=2650.0)
    system = build_system(which, 7, joint_dashpot=3e-5)
    basis, start = modal_basis(system), at_rest(system, np.linspace(-2e-4, 3e-4, 7))
    for ask in (
        lambda: simulate_linear(basis, start, [0.01]),
        lambda: linear_deflection(basis, start, np.linspace(0.0, 0.01, 3), 0.2),
        lambda: simulate_modal(basis, start, [0.01], step=1e-5, n_modes=3),
    ):
        with pytest.raises(InputError, match=r"chain.dashpots up to 3e-05 N m s: the linear flow is undamped"):
            ask()
    kicked = simulate_modal(basis, start, [0.01], step=2e-6).angles
    assert kicked == pytest.approx(simulate(system, start, [0.01], tolerance=1e-10).angles, rel=1e-4, abs=1e-8)
