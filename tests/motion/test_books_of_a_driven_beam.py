"""Books of a driven beam without a slider: closed integrals, against a quadrature and against themselves."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_reference import FORCES, FREQUENCY, STRIP

from verify.beam import PointForce
from verify.motion import energy
from verify.motion.energy import driven_ledger
from verify.motion.exponentials import multiplied, weighted_powers
from verify.motion.forcing import SMOOTH_STEP, state_of
from verify.motion.request import laid_out
from verify.motion.surface import basis_of, free_at, stages_from_rest

BITS = 500
PLACES = (
    0.0,
    1e-9j,
    0.3 - 0.2j,
    0.99j,
    -1.01,
    1.01j,
    -5.0,
    7.3j,
    -3.1 + 6.2j,
    20.2j,
    39.5j,
    -31.0 + 20.0j,
    79.0j,
    -83.0,
)


def by_series(z, highest):
    """Integrals of p^k e^{z p} in whole numbers of 2^-500, sum of z^j / (j! (j + k + 1)), to the last digit."""
    one = 1 << BITS
    real, imaginary = int(z.real * 2.0**60) * (one >> 60), int(z.imag * 2.0**60) * (one >> 60)
    term, sums = (one, 0), [[0, 0] for _ in range(highest + 1)]
    for j in range(500):
        for k, part in enumerate(sums):
            part[0] += term[0] // (j + k + 1)
            part[1] += term[1] // (j + k + 1)
        term = (
            ((term[0] * real - term[1] * imaginary) >> BITS) // (j + 1),
            ((term[0] * imaginary + term[1] * real) >> BITS) // (j + 1),
        )
    return np.array([complex(a / one, b / one) for a, b in sums])


@pytest.mark.parametrize("highest", [0, 3, 61])
def test_integrals_of_powers_and_exponentials_keep_their_digits_for_any_rate(highest):
    """A rate near the number of its powers is where neither direction of the recurrence is at its best."""
    z = np.round(np.array(PLACES, dtype=complex) * 2.0**30) / 2.0**30
    found = weighted_powers(z, np.exp(z), highest)
    exact = np.array([by_series(one, highest) for one in z]).T
    assert found.shape == (highest + 1, len(z))
    assert abs(found / exact - 1.0).max() < 3e-13
    assert abs(found - exact).max() < 4e-16


@pytest.mark.parametrize("z", [1e3j, -200.0 + 997j, -3e3 + 2j, -0.5 + 3e4j])
def test_so_do_those_of_fast_turns(z):
    """By Gauss's six points in ten panels to a radian."""
    points, weights = np.polynomial.legendre.leggauss(6)
    panels = int(10 * abs(z))
    p = ((np.arange(panels)[:, None] + 0.5 * (1 + points)) / panels).ravel()
    measure = np.tile(0.5 * weights / panels, panels)
    expected = np.array([np.sum(measure * p**k * np.exp(z * p)) for k in range(7)])
    found = weighted_powers(np.array([z]), np.exp(np.array([z])), 6)[:, 0]
    assert abs(found - expected).max() < 3e-15


def test_products_of_polynomials_are_those_of_numpy():
    a, b = np.array([[1.5, -2.0, 0.25], [0.0, 3.0, 1.0]]), np.array([[2.0 + 1j, 1j], [0.5, -4.0]])
    for row, one, other in zip(multiplied(a, b), a, b, strict=True):
        assert row == pytest.approx(np.polynomial.polynomial.polymul(one, other))


def run_of(pieces, zeta=0.0, hertz=FREQUENCY, rest=0.0, model="segment", count=9, forces=FORCES, modes=14):
    """(stages, basis) under an envelope and, for `rest` seconds, the amplitudes as they are given."""
    basis = basis_of(STRIP, model, count, modes)
    grown = [(seconds, np.array(c, dtype=float)) for seconds, c in pieces]
    laid = laid_out(sum(seconds for seconds, _ in grown) + rest, grown, 1.0, 10)
    return stages_from_rest(basis, forces, 2 * np.pi * hertz, zeta, laid, 0.0), basis


def booked(stages, basis):
    return driven_ledger(stages, basis, stages[0].start(*np.zeros((2, len(basis.omegas)))))


def by_quadrature(stages, n):
    """(work, damped) from rest, six points of Gauss to a quarter of the fastest period of what turns or decays."""
    points, weights = np.polynomial.legendre.leggauss(6)
    q, rates, work, damped = np.zeros(n), np.zeros(n), 0.0, 0.0
    for stage in stages:
        modes, z = stage.modal, stage.start(q, rates)
        fastest = max(np.sqrt(modes.squares.max()), stage.omega, 20.0 / stage.duration)
        half = 0.5 * stage.duration / (panels := int(stage.duration * fastest * 2.0 / np.pi) + 1)
        for panel in range(panels):
            for point, weight in zip(points, weights, strict=True):
                t = half * (2 * panel + 1 + point)
                moving = state_of(modes, free_at(stage, z, t))[1] + stage.forced.state(t)[1]
                grown = np.polynomial.Polynomial(stage.growth)(t / stage.unit_s)
                load = (modes.loads * grown * np.exp(1j * stage.omega * (t + stage.origin))).real
                work += half * weight * load @ moving
                damped += half * weight * (2 * modes.sigmas) @ moving**2
        q, rates = stage.state(free_at(stage, z, stage.duration), stage.duration)
    return work, damped


SOFT = (1.7 / FREQUENCY, SMOOTH_STEP)
BUMPY = ((3e-4, (0.2, -1.3, 2.0, 0.0, 0.7)), (5e-4, (1.6, -2.2)), (1e-5, (-0.6, 1.0, 3.0)))
SINE = (PointForce(position=0.117, amplitude=2.3, phase_deg=-90.0),)


@pytest.mark.parametrize(
    ("pieces", "asked"),
    [
        ((SOFT,), {"rest": 7e-4}),
        ((SOFT,), {"rest": 7e-4, "zeta": 0.013}),
        ((SOFT,), {"rest": 7e-4, "zeta": 0.31, "model": "fem", "count": 4}),
        ((SOFT,), {"zeta": 0.013, "model": "analytic", "count": None}),
        (BUMPY, {"rest": 4e-4, "zeta": 0.004}),
        (BUMPY, {"rest": 4e-4, "zeta": 0.97}),
        (BUMPY, {"zeta": 0.01, "hertz": 37.0, "model": "analytic", "count": None, "modes": 6}),
        ((), {"rest": 9e-4, "zeta": 0.02}),
        ((), {"rest": 9e-4, "zeta": 0.999, "hertz": 37.0}),
        (((1.3e-3, (0.0, 1.0)),), {"zeta": 0.02, "hertz": 90.0, "forces": SINE}),
    ],
)
def test_closed_integrals_are_those_of_a_quadrature(pieces, asked):
    stages, basis = run_of(pieces, **asked)
    books = booked(stages, basis)
    work, damped = by_quadrature(stages, len(basis.omegas))
    assert books.work_in == pytest.approx(work, rel=2e-12, abs=0.0)
    assert books.damped == pytest.approx(damped, rel=2e-12, abs=0.0)
    assert abs(books.residual) < 1e-13 * (books.work_in + books.damped)


def most_energy(stages, n):
    """Of 40 states in each stage, joules: what the forces had put in at most, but for what was damped."""
    q, rates, most = np.zeros(n), np.zeros(n), 0.0
    for stage in stages:
        z = stage.start(q, rates)
        for t in np.linspace(0.0, stage.duration, 40):
            q, rates = stage.state(free_at(stage, z, t), t)
            most = max(most, 0.5 * float(rates @ rates + stage.modal.squares @ q**2))
    return most


numbers = st.floats(-3.0, 3.0)


@settings(max_examples=150, deadline=None)
@given(
    pieces=st.lists(st.tuples(st.floats(1e-5, 0.3), st.lists(numbers, min_size=1, max_size=4)), min_size=1, max_size=3),
    zeta=st.one_of(st.just(0.0), st.floats(1e-7, 0.9999)),
    mode=st.integers(0, 6),
    off=st.one_of(st.floats(0.003, 0.4), st.floats(-0.99, -0.003)),
    phases=st.tuples(st.floats(-180.0, 180.0), st.floats(-180.0, 180.0)),
)
def test_the_books_close_to_rounding_under_any_envelope(pieces, zeta, mode, off, phases):
    """Beside a resonance, far off, between the modes, damped up to where nothing swings: 5e-12 of 8000, 4e-15 of half.

    What is left is the state's at the end, of a mode that beats by half a radian to two while its forces grow.
    """
    forces = [
        PointForce(position=f.position, amplitude=f.amplitude, phase_deg=p) for f, p in zip(FORCES, phases, strict=True)
    ]
    own = basis_of(STRIP, "segment", 9, 0).omegas[mode] / (2 * np.pi)
    stages, basis = run_of(pieces, zeta, hertz=own * (1 + off), rest=1e-3, forces=forces)
    books = booked(stages, basis)
    assert abs(books.residual) <= 1e-10 * (most_energy(stages, len(basis.omegas)) + books.damped)


@pytest.mark.parametrize("zeta", [0.0, 1e-7, 1e-3, 0.1])
@pytest.mark.parametrize("soft", [0.0, 2.0, 5e4])
def test_the_books_close_after_a_hundred_thousand_periods(zeta, soft):
    """Phases of 1e6 radians are right to 1e-10; those of the work are the same ones as of the state at the end."""
    pieces = ((soft / FREQUENCY, SMOOTH_STEP),) if soft else ()
    stages, basis = run_of(pieces, zeta, rest=1e5 / FREQUENCY, count=30)
    books = booked(stages, basis)
    assert abs(books.residual) < 1e-13 * (most_energy(stages, len(basis.omegas)) + books.damped)


@pytest.mark.parametrize("short", [1e-4, 1e-6, 1e-9])
@pytest.mark.parametrize("pieces", [(), (SOFT,)])
def test_the_books_close_next_to_critical_damping(pieces, short):
    """Two exponentials of nearly one rate: their squares cancel like (sigma / omega_d)^2, 1e9 at the last."""
    books = booked(*run_of(pieces, 1.0 - short, rest=1e-3))
    assert abs(books.residual) < 1e-12 * books.work_in
    beside = booked(*run_of(pieces, 1.0 - 1.1 * short, rest=1e-3))
    assert books.damped == pytest.approx(beside.damped, rel=0.2 * short + 1e-12, abs=0.0)


@pytest.mark.parametrize("zeta", [1e-7, 2e-4])
@pytest.mark.parametrize("off", [1e-4, 1e-6])
def test_what_constant_forces_next_to_a_resonance_give_has_no_square_of_its_phasors(off, zeta):
    """The forced and the free part are each 1 / (off omega T) of the motion, which is over before it has beaten."""
    own = basis_of(STRIP, "segment", 9, 0).omegas[0] / (2 * np.pi)
    stages, basis = run_of((), zeta, hertz=own * (1 + off), rest=0.3 / own)
    books = booked(stages, basis)
    work, damped = by_quadrature(stages, len(basis.omegas))
    floor = 1e-15 / off
    assert books.work_in == pytest.approx(work, rel=floor, abs=0.0)
    assert books.damped == pytest.approx(damped, rel=floor, abs=0.0)
    assert abs(books.residual) < floor * books.work_in


@pytest.mark.parametrize("hertz", [1.0, 1e-3, 1e-6])
def test_a_slow_sine_keeps_its_digits_where_it_has_hardly_begun(hertz):
    """Its force is Re(-i F e^{i omega t}): of |F|^2 less than (omega T)^2 is left."""
    turn = 2 * np.pi * hertz * 1e-3
    sine, basis = run_of(((1e-3, SMOOTH_STEP),), 0.02, hertz=hertz, forces=SINE)
    slope = PointForce(position=SINE[0].position, amplitude=SINE[0].amplitude * turn)
    line, _ = run_of(((1e-3, (0.0, *SMOOTH_STEP)),), 0.02, hertz=1e-9, forces=(slope,))
    books, straight = booked(sine, basis), booked(line, basis)
    near = turn**2 + 4e-16 / turn  # cos(-90 degrees) is 6e-17
    assert books.work_in == pytest.approx(straight.work_in, rel=near, abs=0.0)
    assert books.damped == pytest.approx(straight.damped, rel=near, abs=0.0)
    assert abs(books.residual) < 2e-15 / turn * books.work_in  # of the state's, a difference of two phasors


def test_the_work_of_the_books_grows_as_the_modes_and_not_with_time(monkeypatch):
    """A quadrature took points for every quarter of the fastest period, N^2 of them, with N modes each."""
    seen = []

    def counted(z, end, highest):
        seen.append(len(z) * (highest + 1))
        return weighted_powers(z, end, highest)

    monkeypatch.setattr(energy, "weighted_powers", counted)

    def figures(count, seconds):
        seen.clear()
        booked(*run_of(((seconds, SMOOTH_STEP),), 0.01, rest=1e-3, count=count))
        return sum(seen)

    short, long, many = figures(21, 0.01), figures(21, 10.0), figures(81, 0.01)
    assert long < 1.5 * short
    assert many < 4.2 * short
