"""The closed forms against figures that share nothing with them: dense matrices, the suite's models, stepping."""

import msgspec
import numpy as np
import pytest
from peer_cases import FORCES, FREQUENCY
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.linalg import eigh

from verify import segment_model
from verify.beam import PointForce
from verify.chain.dynamics import at_rest
from verify.chain.splitting import linear_deflection, modal_basis
from verify.chain.stepping import step_limit
from verify.chain.system import build_system
from verify.peers import references
from verify.peers.case import case_of


def matrices(case):
    """Mass and stiffness over inner joints' positions, assembled link by link."""
    n, link = case.n, case.link
    mass, stiffness, bend = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1)), np.array([1.0, -2.0, 1.0]) / link
    means, turns = np.array([0.5, 0.5]), np.array([-1.0, 1.0]) / link
    for i in range(n):
        mass[i : i + 2, i : i + 2] += case.mass * np.outer(means, means) + case.inertia * np.outer(turns, turns)
    for i in range(1, n):
        stiffness[i - 1 : i + 2, i - 1 : i + 2] += case.spring * np.outer(bend, bend)
    return mass[1:-1, 1:-1], stiffness[1:-1, 1:-1]


def test_frequencies_are_those_of_matrices_and_of_the_suites_segments(titanium_strip, asymmetric_case):
    closed = references.frequencies(asymmetric_case)
    dense = np.sqrt(eigh(*matrices(asymmetric_case)[::-1], eigvals_only=True)) / (2 * np.pi)
    assert closed == pytest.approx(dense, rel=1e-10)
    modes = segment_model.solve_modes(titanium_strip, 12, n_segments=13)
    assert closed == pytest.approx(modes.frequencies_hz, rel=1e-13)


def test_the_motion_from_rest_is_that_of_the_suites_chain_at_any_point(titanium_strip, asymmetric_case):
    system = build_system(titanium_strip, 13, list(FORCES), FREQUENCY)
    basis, times = modal_basis(system), np.linspace(1e-5, 7e-3, 141)
    for x in (0.31, 0.365):
        chain = linear_deflection(basis, at_rest(system), times, x)
        own = references.deflection(asymmetric_case, times, x)
        assert np.abs(own - chain).max() < 1e-10 * np.abs(chain).max()
    assert references.deflection(asymmetric_case, times) == pytest.approx(own, rel=1e-9)  # mid-span unless given


def test_the_limit_of_explicit_steps_is_the_chains_own(titanium_strip):
    case = case_of(titanium_strip, 31, FORCES, FREQUENCY)
    system = build_system(titanium_strip, 31, list(FORCES), FREQUENCY)
    assert references.explicit_limit(case) == pytest.approx(step_limit(system, at_rest(system)), rel=1e-3)


def test_a_slider_on_a_still_chain_slows_down_by_the_exact_law(titanium_strip, sled):
    """sinh(K v) = sinh(K v0) exp(-mu N K t / m)."""
    still = case_of(titanium_strip, 13, [PointForce(position=0.2, amplitude=0.0)], FREQUENCY)
    ride = references.ride(still, sled, 3e-4, 600)
    rate = sled.friction * sled.slope / sled.mass
    exact = np.arcsinh(np.sinh(sled.slope * sled.speed) * np.exp(-rate * ride.times)) / sled.slope
    assert ride.speed == pytest.approx(exact, rel=1e-7)
    assert 0.0 < exact[-1] < 0.2 * sled.speed
    assert ride.distance[-1] == pytest.approx(np.trapezoid(exact, ride.times), rel=1e-5)


def ridden(case, sled, times):
    """The same slider and chain stepped together on dense matrices, the surface read by scipy's cubics."""
    mass, stiffness = matrices(case)
    n, link = case.n, case.link
    joints = link * np.arange(n + 1)
    levers = np.zeros((len(case.forces), n + 1))
    for row, force in zip(levers, case.forces, strict=True):
        i = int(force.position / link)
        row[i + 1] = force.position / link - i
        row[i] = 1.0 - row[i + 1]
    inverse = np.linalg.inv(mass)

    def surface(rates, x):
        spins = np.diff(np.concatenate([[0.0], rates, [0.0]])) / link
        means = np.concatenate([[np.nan], 0.5 * (spins[1:] + spins[:-1]), [np.nan]])
        slopes = (means[2:] - means[:-2]) / (2 * link)
        inner = slice(2, n - 1)
        return -sled.half_thickness * CubicHermiteSpline(joints[inner], means[inner], slopes[1 : n - 2])(x)

    def rates(t, state):
        y, w, (x, v) = state[: n - 1], state[n - 1 : -2], state[-2:]
        load = np.array(case.now(t)) @ levers[:, 1:-1]
        pull = -sled.friction * np.tanh(sled.slope * (v - surface(w, sled.start + x))) / sled.mass
        return np.concatenate([w, inverse @ (load - stiffness @ y), [v, pull]])

    begin = np.zeros(2 * n)
    begin[-1] = sled.speed
    found = solve_ivp(rates, (0.0, times[-1]), begin, "DOP853", times, rtol=1e-10, atol=1e-16)
    return found.y[-2:]


def test_a_ride_is_that_of_chain_and_slider_stepped_together(asymmetric_case, sled):
    times = np.linspace(4e-5, 8e-4, 20)
    distance, speed = references.ride(asymmetric_case, sled, 8e-4, 4000).at(times)
    true = ridden(asymmetric_case, sled, times)
    assert np.abs(distance - true[0]).max() < 1e-7 * np.abs(true[0]).max()
    assert np.abs(speed - true[1]).max() < 1e-7 * np.abs(true[1]).max()


def test_the_ride_of_a_packaged_number_of_steps_names_its_uncertainty(paper_beam, sled):
    """Halving the steps of the paper's case at 49 links changes less than 1e-10, at an eighth of the steps 1e-6."""
    case = case_of(paper_beam, 49, [PointForce(position=0.0116, amplitude=0.1)], 4276.0)
    there = msgspec.structs.replace(sled, start=0.27)
    fine, coarse = (references.ride(case, there, 2e-4, steps) for steps in (4000, 2000))
    assert np.abs(fine.speed[::2] - coarse.speed).max() < 1e-10 * np.abs(fine.speed).max()
