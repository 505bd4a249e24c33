"""Motion of a driven beam without a slider: the forced part, the free part, starts, continuation, refusals."""

import re

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from motion_reference import FORCES, FREQUENCY, STRIP, linear_motion
from msgspec.structs import replace

from verify.beam import PointMass
from verify.errors import InputError, ResonanceError
from verify.motion.forcing import SMOOTH_STEP, Modal, advanced, answer, free_part, state_of, turns
from verify.motion.free_vibration import free_vibration
from verify.motion.simulate import simulate
from verify.motion.surface import basis_of, cut
from verify.motor.run import run_motor
from verify.segment_model import solve_harmonic
from verify.segments.assembly import build_chain
from verify.segments.loads import joint_weights
from verify.slider import Contact, Slider

frequencies = st.floats(30.0, 9e4)
ratios = st.floats(0.0, 0.4)


@pytest.mark.parametrize("zeta", [0.0, 2e-4])
@pytest.mark.parametrize(
    ("off", "periods"), [(0.07, 2.0), (1e-3, 2.0), (1e-5, 1.3), (-3e-7, 9.0), (-0.95, 0.02), (0.4, 1e-4)]
)
def test_a_soft_start_keeps_its_digits_next_to_a_resonance_and_however_short(off, periods, zeta):
    """Duhamel's integral by Gauss; powers of the growth alone would cancel like (1/(T |omega_n - omega|))^4."""
    drive, growth = 2 * np.pi * FREQUENCY, periods / FREQUENCY
    own = drive * (1 + off)
    modes = one_mode(own, zeta, load=1.0 + 0j)
    forced = answer(modes, drive, SMOOTH_STEP, growth, 0.3)
    q0, rate0 = forced.state(0.0)
    z, t = free_part(modes, -q0, -rate0), 0.83 * growth
    x, weights = np.polynomial.legendre.leggauss(200)
    then, damped = 0.5 * t * (x + 1), modes.omegas[0]
    push = (then / growth) ** 2 * (3 - 2 * then / growth) * np.cos(drive * (then + 0.3))
    answered = np.exp(-zeta * own * (t - then)) * np.sin(damped * (t - then)) / damped
    expected = 0.5 * t * np.sum(weights * push * answered)
    found = advanced(modes, z, t)[0, 0] + forced.state(t)[0][0]
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-12 * min(growth / own, growth**2))


def one_mode(omega, zeta, load=1.7 - 0.6j):
    return Modal(
        sigmas=np.array([zeta * omega]),
        omegas=np.array([omega * np.sqrt(1 - zeta**2)]),
        squares=np.array([omega**2]),
        loads=np.array([load]),
    )


@settings(max_examples=80, deadline=None)
@given(
    own=frequencies,
    zeta=ratios,
    drive=st.one_of(st.just(0.0), frequencies),
    part=st.floats(0.0, 1.0),
    unit=st.floats(1e-5, 3.0),
    origin=st.floats(0.0, 2.0),
    growth=st.lists(st.floats(-3.0, 3.0), min_size=1, max_size=5),
)
def test_the_forced_part_satisfies_its_equation_for_any_polynomial_times_a_harmonic(
    own, zeta, drive, part, unit, origin, growth
):
    """Q'' + 2 zeta w q' + w^2 q = Re(F p(t/T) e^{i omega (t + origin)}), derivatives by hand from Q."""
    if len(growth) == 1 and abs(drive / own - 1) < 1e-6 and zeta < 1e-6:
        return
    modes, growth = one_mode(own, zeta), np.array(growth)
    found = answer(modes, drive, growth, unit, origin)
    poly = np.polynomial.Polynomial(found.amplitudes[0])
    p, first, second = (poly.deriv(d)(part) / unit**d if d else poly(part) for d in range(3))
    turn = np.exp(1j * drive * (part * unit + origin))
    q, rate = p * turn, (first + 1j * drive * p) * turn
    bend = (second + 2j * drive * first - drive**2 * p) * turn
    left = (bend + 2 * zeta * own * rate + own**2 * q).real
    right = (modes.loads[0] * np.polynomial.Polynomial(growth)(part) * turn).real
    scale = abs(bend) + abs(own**2 * q) + 2 * zeta * own * abs(rate) + abs(right)
    powers = abs(found.amplitudes[0]) @ part ** np.arange(found.amplitudes.shape[1])
    assert left == pytest.approx(right, abs=1e-10 * (scale + own**2 * powers + drive**2 * powers) + 1e-12)
    state = found.state(part * unit)
    assert state[0][0] == pytest.approx(q.real, abs=1e-9 * powers + 1e-300)
    assert state[1][0] == pytest.approx(rate.real, abs=1e-9 * (abs(rate) + (drive + 1 / unit) * powers) + 1e-300)


@settings(max_examples=60, deadline=None)
@given(
    own=frequencies,
    zeta=ratios,
    t1=st.floats(0, 0.02),
    t2=st.floats(0, 0.02),
    q=st.floats(-1, 1),
    rate=st.floats(-1, 1),
)
def test_a_free_mode_moves_as_a_group(own, zeta, t1, t2, q, rate):
    """First t1, then t2, is t1 + t2; the start is given back; its own equation is its motion."""
    modes = one_mode(own, zeta)
    z = free_part(modes, np.array([q]), np.array([rate * own]))
    assert state_of(modes, z)[0][0] == q
    assert state_of(modes, z)[1][0] == pytest.approx(rate * own, abs=1e-12 * own)

    def after(z, t):
        turn = turns(modes, t)
        both = (z[0] + 1j * z[1]) * (turn[0] + 1j * turn[1])
        return np.array([both.real, both.imag])

    once, twice = after(z, t1 + t2), after(after(z, t1), t2)
    assert twice == pytest.approx(once, abs=1e-11 * abs(z).max() + 1e-300)
    assert advanced(modes, z, t1 + t2)[0, 0] == pytest.approx(once[0, 0], abs=1e-13 * abs(z).max() + 1e-300)
    # closed form of a damped oscillator
    damped, t = own * np.sqrt(1 - zeta**2), t1 + t2
    exact = np.exp(-zeta * own * t) * (
        q * np.cos(damped * t) + (rate * own + zeta * own * q) / damped * np.sin(damped * t)
    )
    assert once[0, 0] == pytest.approx(exact, abs=1e-11 * abs(z).max() + 1e-300)


@pytest.mark.parametrize(("soft", "zeta"), [(0.0, 0.0), (1.7, 0.0), (0.0, 0.03), (2.3, 0.011)])
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_motion_from_rest_is_that_of_the_assembled_matrices_by_dop853(model, soft, zeta):
    """Step load or soft start, damped or not; ratio zeta of every mode is C = 2 zeta M sqrt(M^-1 K)."""
    n = 6
    mass, stiffness, loads, reading = matrices(model, n)
    values, vectors = np.linalg.eig(np.linalg.solve(mass, stiffness))
    root = (vectors * np.sqrt(values)) @ np.linalg.inv(vectors)
    nodes = np.arange(1, n) * STRIP.length / n
    found = simulate(
        STRIP,
        FORCES,
        FREQUENCY,
        2.9e-3,
        model=model,
        count=n,
        soft_start_periods=soft,
        modal_damping=zeta,
        at=nodes,
        samples=41,
    )
    free = linear_motion(mass, stiffness, 2 * zeta * mass @ root, loads, found.times, soft / FREQUENCY)
    expected = free @ reading.T
    assert found.deflection == pytest.approx(expected, abs=1e-8 * abs(expected).max())
    assert found.statistics.steps == 0


PIECES = ((0.7e-3, [0.0, 0.4, 0.6]), (0.5e-3, [1.0, 0.0, -0.3]), (0.4e-3, [0.7, 0.2]))
"""They end at 0.9, from where the forces jump to all of them."""


def part_of(pieces, t):
    """Of the forces at t, by the pieces (seconds, coefficients) as `simulate` tells them: p = t/seconds in each."""
    for seconds, coefficients in pieces:
        if t < seconds:
            return sum(c * (t / seconds) ** d for d, c in enumerate(coefficients))
        t -= seconds
    return 1.0


@pytest.mark.parametrize("model", ["segment", "fem"])
def test_an_envelope_is_polynomials_of_the_time_within_each_piece_over_its_length(model):
    n = 6
    mass, stiffness, loads, reading = matrices(model, n)
    nodes = np.arange(1, n) * STRIP.length / n
    found = simulate(STRIP, FORCES, FREQUENCY, 2.9e-3, model=model, count=n, at=nodes, envelope=PIECES, samples=59)
    free = linear_motion(mass, stiffness, 0.0 * mass, loads, found.times, growth=lambda t: part_of(PIECES, t))
    expected = free @ reading.T
    assert found.deflection == pytest.approx(expected, abs=2e-7 * abs(expected).max())
    assert "forces grow over 0.0016 s to 0.9 times what is given, and jump to that" in found.notes


def test_an_envelope_of_the_smooth_step_is_a_soft_start():
    asked = {"count": 9, "at": [0.171], "samples": 30}
    soft = simulate(STRIP, FORCES, FREQUENCY, 2e-3, soft_start_periods=1.7, **asked)
    pieces = simulate(STRIP, FORCES, FREQUENCY, 2e-3, envelope=[(1.7 / FREQUENCY, [0, 0, 3, -2])], **asked)
    assert np.array_equal(pieces.deflection, soft.deflection)
    assert pieces.notes == soft.notes
    assert any(note.startswith("forces grow over") and "jump" not in note for note in soft.notes)


@pytest.mark.parametrize(
    ("n_pieces", "seconds", "samples", "kept"),
    [
        (8, 1e-4, 5, 10),  # a start, eight ends and that of the run
        (8, 1e-4, 10, 10),
        (8, 1e-4, 11, 11),
        (9, 1.5e-4, 11, 11),  # of which each has one and a half times its share
        (2, 1e-3, 2, 3),  # which fill the run
        (1, 1e-3, 41, 41),
    ],
)
def test_as_many_times_are_kept_as_are_asked_for_or_one_for_each_stretch(n_pieces, seconds, samples, kept):
    pieces = [(seconds, [0.3, 0.7])] * n_pieces
    found = simulate(STRIP, FORCES, FREQUENCY, 2e-3, count=5, at=[0.1], envelope=pieces, samples=samples)
    assert found.deflection.shape == (kept, 1)
    assert (found.times[0], found.times[-1]) == pytest.approx((0.0, 2e-3), rel=1e-12)
    ends = seconds * np.arange(1, n_pieces + 1)
    assert all(abs(found.times - end).min() < 1e-12 for end in ends)


def matrices(model, n):
    """(M, K, loads, reading at the inner nodes) in SI, from element matrices written here, pinned ends."""
    length, ei, line = STRIP.length / n, STRIP.bending_stiffness, STRIP.mass_per_length
    if model == "fem":
        h = length
        k = (
            ei
            / h**3
            * np.array(
                [
                    [12, 6 * h, -12, 6 * h],
                    [6 * h, 4 * h * h, -6 * h, 2 * h * h],
                    [-12, -6 * h, 12, -6 * h],
                    [6 * h, 2 * h * h, -6 * h, 4 * h * h],
                ]
            )
        )
        m = (
            line
            * h
            / 420
            * np.array(
                [
                    [156, 22 * h, 54, -13 * h],
                    [22 * h, 4 * h * h, 13 * h, -3 * h * h],
                    [54, 13 * h, 156, -22 * h],
                    [-13 * h, -3 * h * h, -22 * h, 4 * h * h],
                ]
            )
        )
        size = 2 * n + 2
        mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
        for e in range(n):
            mass[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += m
            stiffness[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += k
        free = [i for i in range(size) if i not in (0, size - 2)]
        loads = []
        for f in FORCES:
            e = int(f.position / h)
            s, row = f.position / h - e, np.zeros(size)
            row[2 * e : 2 * e + 4] = [
                1 - 3 * s**2 + 2 * s**3,
                h * (s - 2 * s**2 + s**3),
                3 * s**2 - 2 * s**3,
                h * (s**3 - s**2),
            ]
            loads.append(row[free])
        reading = np.eye(size)[2:-2:2][:, free]
        return mass[np.ix_(free, free)], stiffness[np.ix_(free, free)], np.array(loads), reading
    mass, stiffness = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
    for j in range(n):  # a rigid link: mass m, inertia m l^2/12
        mass[j : j + 2, j : j + 2] += line * length * np.array([[2, 1], [1, 2]]) / 6
    for j in range(1, n):
        turn = np.zeros(n + 1)
        turn[j - 1 : j + 2] = np.array([1, -2, 1]) / length
        stiffness += ei / length * np.outer(turn, turn)
    inner = slice(1, n)
    loads = [joint_weights(build_chain(STRIP, n), f.position, "reciprocal")[inner] for f in FORCES]
    bend = np.diag(np.full(n - 1, 10 / 12)) + np.diag(np.full(n - 2, 1 / 12), 1) + np.diag(np.full(n - 2, 1 / 12), -1)
    return mass[inner, inner], stiffness[inner, inner], np.array(loads), bend


@settings(max_examples=15, deadline=None)
@given(first=st.floats(1e-4, 4e-3), second=st.floats(1e-4, 4e-3), zeta=st.sampled_from([0.0, 0.02]))
def test_a_run_that_continues_another_is_one_long_run(first, second, zeta):
    asked = {"model": "segment", "count": 17, "modal_damping": zeta, "at": [0.1, 0.33]}
    begun = simulate(STRIP, FORCES, FREQUENCY, first, **asked)
    ended = simulate(STRIP, FORCES, FREQUENCY, second, continue_from=begun, **asked)
    whole = simulate(STRIP, FORCES, FREQUENCY, first + second, **asked)
    scale = abs(whole.deflection).max()
    assert ended.times[0] == begun.times[-1]
    assert ended.deflection[0] == pytest.approx(begun.deflection[-1], abs=1e-12 * scale)
    assert ended.deflection[-1] == pytest.approx(whole.deflection[-1], abs=1e-9 * scale)
    assert ended.end.time == pytest.approx(first + second)


@pytest.mark.parametrize("model", ["analytic", "segment"])
def test_damped_motion_from_rest_ends_in_the_steady_state(model):
    """After forty time constants of the first mode; the exact beam's far modes follow at once."""
    count = None if model == "analytic" else 24
    asked = {"model": model, "count": count, "modal_damping": 0.05, "at": [0.171], "ledger": False}
    asked |= {} if count else {"modes": 60}
    begun = simulate(STRIP, FORCES, FREQUENCY, 8.0, samples=2, **asked)
    late = simulate(STRIP, FORCES, FREQUENCY, 2 / FREQUENCY, continue_from=begun, samples=50, **asked)
    exact = simulate(STRIP, FORCES, FREQUENCY, 2 / FREQUENCY, start="steady", samples=50, **asked | {"modes": None})
    phases = 2 * np.pi * FREQUENCY * np.array([late.times, exact.times])
    fits = [
        np.linalg.lstsq(np.array([np.cos(p), np.sin(p)]).T, m.deflection[:, 0], rcond=None)[0]
        for p, m in zip(phases, (late, exact), strict=True)
    ]
    band = 1e-9 if model == "segment" else 1e-2  # structural for viscous off resonance in the exact field
    assert fits[0] == pytest.approx(fits[1], abs=band * abs(np.array(fits)).max())


def test_damping_acts_in_every_steady_field():
    """A ratio of every mode lowers the steady answer of all three models alike, and the notes say what stands for it."""

    def amplitude(model, zeta):
        count = None if model == "analytic" else 60
        found = simulate(
            STRIP,
            FORCES,
            FREQUENCY,
            1 / FREQUENCY,
            model=model,
            count=count,
            start="steady",
            at=[0.171],
            modal_damping=zeta,
            samples=400,
        )
        return abs(found.deflection).max(), found.notes

    bare = {model: amplitude(model, 0.0) for model in ("analytic", "segment", "fem")}
    lossy = {model: amplitude(model, 0.08) for model in bare}
    shares = [lossy[model][0] / bare[model][0] for model in bare]
    assert shares == pytest.approx([shares[0]] * 3, rel=0.05)
    assert max(shares) < 0.9
    assert not any("damping" in note for note in bare["segment"][1])
    assert any("ratio 0.08" in note for note in lossy["segment"][1])
    assert any("loss factor 0.16" in note and "in place of a ratio 0.08" in note for note in lossy["analytic"][1])


def test_a_resonance_without_damping_is_refused_and_with_damping_is_not():
    own = float(basis_of(STRIP, "fem", 12, 0).omegas[4] / (2 * np.pi))
    for start in ("rest", "steady"):
        with pytest.raises(ResonanceError, match="mode 5"):
            simulate(STRIP, FORCES, own, 1e-3, model="fem", count=12, start=start)
        simulate(STRIP, FORCES, own, 1e-3, model="fem", count=12, start=start, modal_damping=0.01)


@pytest.mark.parametrize("given", [{"step": 1e-6}, {"steps_per_period": 63}])
def test_steps_of_a_beam_without_a_slider_are_refused(given):
    (name,) = given
    with pytest.raises(InputError, match=f"{name} = .* is a slider's: a beam alone takes no steps"):
        simulate(STRIP, FORCES, FREQUENCY, 2e-3, count=9, **given)


def test_a_beam_without_a_slider_is_known_after_years():
    """Nothing is stepped: a damped beam is in its steady state after 3e10 periods of the drive, off by their phase."""
    years = 3e10 / FREQUENCY
    late = simulate(STRIP, FORCES, FREQUENCY, years, count=9, modal_damping=0.013, at=[0.2], samples=2).deflection[-1]
    field = solve_harmonic(STRIP, FORCES, FREQUENCY, 9, modal_damping=0.013).deflection([0.2])
    assert late == pytest.approx((field * np.exp(2j * np.pi * FREQUENCY * years)).real, abs=1e-4 * abs(field[0]))


@pytest.mark.parametrize(
    ("hertz", "zeta", "known", "whose"),
    [(1e-9, 0.0, 0.9, "highest mode"), (1e-9, 1e-14, 0.9, "highest mode"), (1e6, 0.01, 1.0, "the drive")],
)
def test_a_phase_that_rounding_has_taken_is_refused(hertz, zeta, known, whose):
    """Of free modes as of the drive: 1e12 periods are known to 1e-3 rad, of a mode that is damped out any number."""
    highest = float(basis_of(STRIP, "fem", 9, 0).omegas[-1] / (2 * np.pi)) if zeta < 1e-3 else hertz
    given = {"model": "fem", "count": 9, "modal_damping": zeta, "samples": 2}
    simulate(STRIP, FORCES, hertz, known * 1e12 / highest, **given)
    with pytest.raises(InputError, match=f"more than 1e\\+12 periods of .*{whose}"):
        simulate(STRIP, FORCES, hertz, 1.1e12 / highest, **given)


@pytest.mark.parametrize(("zeta", "known"), [(4e-12, False), (1e-15, False), (1e-18, False), (7e-12, True)])
def test_a_mode_that_is_damped_out_after_its_phase_is_lost_is_refused(zeta, known):
    """40 nepers take 6.4 / zeta periods: what is left of a mode at its end is not all that was told of it before."""
    lowest = float(basis_of(STRIP, "fem", 4, 0).omegas[0])
    given = {"model": "fem", "count": 4, "modal_damping": zeta, "at": [0.1], "samples": 5}
    if known:
        assert abs(free_vibration(STRIP, 1, 50.0 / (zeta * lowest), amplitude=1e-3, **given).deflection[-1]) < 1e-20
        return
    with pytest.raises(InputError, match="more than 1e\\+12 periods of the highest mode that is not damped out before"):
        free_vibration(STRIP, 1, 50.0 / (zeta * lowest), amplitude=1e-3, **given)


@pytest.mark.parametrize(("zeta", "soft"), [(0.0, 0.0), (0.02, 1.5)])
@pytest.mark.parametrize("model", ["segment", "fem"])
def test_the_books_of_a_driven_beam_close(model, zeta, soft):
    """Work of the forces against what is in the beam and what was lost: rounding is what they miss."""
    books = simulate(
        STRIP, FORCES, FREQUENCY, 2.7e-3, model=model, count=11, modal_damping=zeta, soft_start_periods=soft
    ).ledger
    assert books.work_in > 0
    assert abs(books.residual) < 1e-13 * books.work_in
    assert (books.damped > 1e-3 * books.work_in) == (zeta > 0)
    assert books.work_in == pytest.approx(books.kinetic + books.elastic + books.damped, rel=1e-13, abs=0.0)


@settings(max_examples=60, deadline=None)
@given(duration=st.floats(1e-6, 10.0), steps=st.floats(0.3, 5e4), samples=st.integers(1, 300))
def test_steps_fill_their_stretch_and_are_no_longer_than_asked(duration, steps, samples):
    found = cut(duration, duration / steps, samples)
    assert found.n * found.dt == pytest.approx(duration, rel=1e-12)
    assert found.n == found.every * samples
    assert found.dt <= duration / steps * (1 + 1e-9)
    assert found.dt > 0.49 * min(duration / steps, duration / samples)


@pytest.mark.parametrize(
    ("changed", "message"),
    [
        (
            {"count": 12},
            "continue_from is of model = 'segment', count = 9 and this run of model = 'segment', count = 12",
        ),
        ({"model": "fem", "count": 4}, "count = 9 and this run of model = 'fem', count = 4: give both the same"),
        ({"beam": {"thickness": 2.1e-3}}, "continue_from is of another beam"),
        ({"beam": {"mass": (PointMass(position=0.11, mass=3e-3),)}}, "continue_from is of another beam"),
    ],
)
def test_a_run_goes_on_in_the_modes_of_the_same_beam_and_model(changed, message):
    """As many modes are not the same modes: four elements have the eight of nine segments."""
    begun = simulate(STRIP, FORCES, FREQUENCY, 1e-3, count=9)
    asked = {"count": 9, **changed}
    beam = replace(STRIP, **asked.pop("beam", {}))
    with pytest.raises(InputError, match=re.escape(message)):
        simulate(beam, FORCES, FREQUENCY, 1e-3, continue_from=begun, **asked)


def test_a_run_goes_on_with_other_losses_and_not_from_a_steady_beam():
    begun = simulate(STRIP, FORCES, FREQUENCY, 1e-3, count=9)
    simulate(replace(STRIP, loss_factor=0.07), FORCES, FREQUENCY, 1e-3, count=9, continue_from=begun)
    steady = simulate(replace(STRIP, loss_factor=0.01), FORCES, FREQUENCY, 1e-3, count=9, start="steady")
    with pytest.raises(InputError, match="start = 'steady', which has no free modes"):
        simulate(STRIP, FORCES, FREQUENCY, 1e-3, count=9, continue_from=steady)
    exact = simulate(STRIP, FORCES, FREQUENCY, 1e-3, model="analytic", modes=30)
    with pytest.raises(InputError, match="continue_from has 30 modes and this run 31: give both the same modes"):
        simulate(STRIP, FORCES, FREQUENCY, 1e-3, model="analytic", modes=31, continue_from=exact)


ON_BEAM = Slider(mass=2e-2, mu=0.2, position=0.17, coupling="two-way")
ASKED = {"count": 9, "at": [0.1, 0.33], "samples": 5, "ledger": False}


@pytest.mark.parametrize("slider", [None, ON_BEAM], ids=["bare", "with a slider"])
def test_a_steady_run_does_not_go_on_from_one_whose_modes_have_the_forces_in_them(slider):
    """The deflection jumped to 3.5 times what it was: the steady field stood beside modes that held it already."""
    lossy = replace(STRIP, loss_factor=0.05)
    begun = simulate(lossy, FORCES, FREQUENCY, 1e-3, slider=slider, **ASKED)
    for put in (None, ON_BEAM):
        with pytest.raises(InputError, match="would be there twice: give start = 'rest', which goes on from where"):
            simulate(lossy, FORCES, FREQUENCY, 1e-3, start="steady", slider=put, continue_from=begun, **ASKED)
    went = simulate(lossy, FORCES, FREQUENCY, 1e-3, slider=ON_BEAM, continue_from=begun, **ASKED)
    assert went.deflection[0] == pytest.approx(begun.deflection[-1], rel=1e-12)


def test_modes_beside_a_steady_field_go_on_beside_it_alone():
    lossy = replace(STRIP, loss_factor=0.05)
    begun = simulate(lossy, FORCES, FREQUENCY, 1e-3, start="steady", slider=ON_BEAM, **ASKED)
    with pytest.raises(InputError, match="start = 'rest': continue_from is a run with start = 'steady', whose modes"):
        simulate(lossy, FORCES, FREQUENCY, 1e-3, continue_from=begun, **ASKED)
    with pytest.raises(InputError, match=r"no free modes where no slider pushes back, .* coupling = 'two-way'"):
        simulate(lossy, FORCES, FREQUENCY, 1e-3, start="steady", continue_from=begun, **ASKED)
    went = simulate(lossy, FORCES, FREQUENCY, 1e-3, start="steady", slider=ON_BEAM, continue_from=begun, **ASKED)
    assert went.deflection[0] == pytest.approx(begun.deflection[-1], rel=1e-12)


def test_a_beam_let_go_does_not_go_on_beside_a_steady_field():
    begun = free_vibration(STRIP, 2, 1e-3, amplitude=1e-4, count=9)
    with pytest.raises(InputError, match="give start = 'rest'"):
        simulate(STRIP, FORCES, FREQUENCY, 1e-3, start="steady", slider=ON_BEAM, continue_from=begun, **ASKED)


@pytest.mark.parametrize(("first", "then"), [("rest", "steady"), ("steady", "rest")])
def test_a_motor_goes_on_from_its_own_start(first, then):
    motor = replace(ON_BEAM, contact=Contact(stiffness=4e5))
    lossy = replace(STRIP, loss_factor=0.05)
    begun = run_motor(lossy, FORCES, FREQUENCY, 1e-3, slider=motor, count=9, start=first, samples=3)
    with pytest.raises(InputError, match=f"start = '{then}': continue_from is (no |a )run with start = 'steady'"):
        run_motor(lossy, FORCES, FREQUENCY, 1e-3, slider=motor, count=9, start=then, samples=3, continue_from=begun)
    run_motor(lossy, FORCES, FREQUENCY, 1e-3, slider=motor, count=9, start=first, samples=3, continue_from=begun)
    faster = replace(motor, speed=0.23)
    with pytest.raises(
        InputError, match=r"by its end, and slider.speed = 0.23 m/s: it goes on as it goes, leave its sp"
    ):
        run_motor(lossy, FORCES, FREQUENCY, 1e-3, slider=faster, count=9, start=first, samples=3, continue_from=begun)


def test_a_slider_goes_on_where_it_was_and_is_put_nowhere_else():
    """Its mass and friction may be others; a place or a speed that would not count is refused."""
    slider = replace(ON_BEAM, speed=0.031)
    begun = simulate(STRIP, FORCES, FREQUENCY, 1e-3, slider=slider, **ASKED)
    for put in (slider, replace(slider, mass=3e-2, mu=0.1), replace(slider, position=None, speed=0.0),
                replace(slider, position=begun.end.position, speed=begun.end.speed)):  # fmt: skip
        went = simulate(STRIP, FORCES, FREQUENCY, 1e-3, slider=put, continue_from=begun, **ASKED)
        assert (went.position[0], went.speed[0]) == pytest.approx((begun.end.position, begun.end.speed), rel=1e-12)
    for name, value in (("position", 0.19), ("position", 0.0), ("speed", 0.3)):
        with pytest.raises(
            InputError, match=rf"^slider\.{name} = {value}: the slider goes on as continue_from left it"
        ):
            simulate(
                STRIP, FORCES, FREQUENCY, 1e-3, slider=replace(slider, **{name: value}), continue_from=begun, **ASKED
            )
    bare = simulate(STRIP, FORCES, FREQUENCY, 1e-3, **ASKED)
    went = simulate(STRIP, FORCES, FREQUENCY, 1e-3, slider=slider, continue_from=bare, **ASKED)
    assert (went.position[0], went.speed[0]) == pytest.approx((0.17, 0.031), rel=1e-12)
