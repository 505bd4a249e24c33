"""A beam let go from a shape: closed forms of one mode, a plucked beam's series, energy, and what goes on from there."""

import numpy as np
import pytest
from motion_reference import FORCES, FREQUENCY, STRIP
from msgspec.structs import replace

from verify.beam import PointForce
from verify.errors import InputError
from verify.exact.closed_forms import frequency_hz
from verify.exact.modes import mode_shape
from verify.motion.free_vibration import free_vibration
from verify.motion.simulate import simulate
from verify.section import Section
from verify.slider import Slider

L, LINE, EI = STRIP.length, STRIP.mass_per_length, STRIP.bending_stiffness
MODELS = {"analytic": None, "segment": 29, "fem": 17}
CANTILEVER = replace(STRIP, supports=("clamped", "free"))


def freed(shape, duration=7.3e-3, beam=STRIP, model="segment", **asked):
    return free_vibration(beam, shape, duration, model=model, **{"count": MODELS.get(model), **asked})


def omega(n):
    return (n * np.pi / L) ** 2 * np.sqrt(EI / LINE)


def sine(n, size=1.0):
    return lambda x: size * np.sin(n * np.pi * x / L)


# ---------------------------------------------------------------------------------------------------------- one mode


@pytest.mark.parametrize("model", MODELS)
def test_a_mode_let_go_decays_and_turns_by_its_own_frequency(model):
    """W = A e^{-zeta omega t} (cos(omega_d t) + zeta / sqrt(1 - zeta^2) sin(omega_d t)), at rest at first."""
    zeta, at = 0.037, L / 6  # where mode 3 is largest
    found = freed(3, model=model, amplitude=-2.1e-3, modal_damping=zeta, at=at)
    own, root = 2 * np.pi * found.frequencies_hz[2], np.sqrt(1 - zeta**2)
    turn, decay = own * root * found.times, np.exp(-zeta * own * found.times)
    expected = -2.1e-3 * decay * (np.cos(turn) + zeta / root * np.sin(turn))
    assert found.deflection.shape == (201, 1)
    assert found.deflection[0, 0] == pytest.approx(-2.1e-3, rel=2e-6)  # largest a little beside, on parts
    expected *= found.deflection[0, 0] / -2.1e-3
    assert found.deflection[:, 0] == pytest.approx(expected, abs=1e-12 * 2.1e-3)
    assert found.velocity[:, 0] == pytest.approx(2.1e-3 * own / root * decay * np.sin(turn), abs=2e-6 * 2.1e-3 * own)
    assert found.frequencies_hz[2] == pytest.approx(omega(3) / (2 * np.pi), rel={"analytic": 1e-14}.get(model, 2e-4))
    assert found.unread == 0.0


@pytest.mark.parametrize("model", MODELS)
def test_a_loss_factor_is_twice_the_ratio_unless_one_is_given(model):
    lossy = replace(STRIP, loss_factor=0.046)
    by_loss, by_ratio = (
        freed(2, beam=beam, model=model, amplitude=1e-3, modal_damping=ratio, at=0.1)
        for beam, ratio in ((lossy, None), (STRIP, 0.023))
    )
    assert np.array_equal(by_loss.deflection, by_ratio.deflection)
    assert by_loss.damping == 0.023


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("mode", [1, 2, 4])
def test_the_largest_deflection_of_a_cantilevers_mode_is_its_tips_and_it_first_moves_upwards(model, mode):
    found = freed(mode, beam=CANTILEVER, model=model, amplitude=1.3e-3, at=[0.02 * L, L])
    assert found.deflection[0, 0] > 0.0
    sign = np.sign(mode_shape(CANTILEVER, mode, L))
    assert found.deflection[0, 1] == pytest.approx(sign * 1.3e-3, rel={"segment": 2e-3}.get(model, 1e-5))


# -------------------------------------------------------------------------------------------------------- any shape


@pytest.mark.parametrize("model", MODELS)
def test_a_shape_and_a_velocity_of_two_modes_go_on_as_those_two(model):
    asked = {"velocity": sine(3, 0.7), "at": [0.11, 0.29], "modal_damping": 0.009, "model": model}
    found = freed(sine(2, 1.9e-3), **asked)
    times, expected = found.times[:, None], 0.0
    for n, size, speed in ((2, 1.9e-3, 0.0), (3, 0.0, 0.7)):
        own = 2 * np.pi * found.frequencies_hz[n - 1]
        damped, decay = own * np.sqrt(1 - 0.009**2), np.exp(-0.009 * own * times)
        turning = size * np.cos(damped * times) + (speed + 0.009 * own * size) / damped * np.sin(damped * times)
        expected = expected + decay * turning * np.sin(n * np.pi * found.points / L)
    assert found.deflection == pytest.approx(expected, abs={"analytic": 1e-13}.get(model, 3e-5) * 1.9e-3)


@pytest.mark.parametrize(("model", "counts"), [("segment", (20, 40)), ("fem", (10, 20))])
def test_a_smooth_shape_is_taken_with_order_four(model, counts):
    def bump(x):
        return 1e-3 * np.sin(np.pi * x / L) * np.exp(0.7 * np.cos(np.pi * x / L))  # straight at pinned ends

    left = [freed(bump, model=model, count=n).unread for n in counts]
    assert 3.5 < np.log2(left[0] / left[1]) < 4.6
    assert left[1] < 1e-3


@pytest.mark.parametrize(
    ("model", "count", "within"), [("analytic", None, 2e-6), ("segment", 120, 2e-2), ("fem", 60, 1e-2)]
)
def test_a_plucked_beam_moves_as_its_series(model, count, within):
    """q_n = 2 h / (n^2 pi^2 r (1 - r)) sin(n pi r) for straight lines up to h at r L; each mode is a cosine."""
    r, h, at = 0.31, 1.7e-3, np.array([0.13, 0.27, 0.401])
    kept = None if count else 300
    found = freed(([0.0, r * L, L], [0.0, h, 0.0]), 1.9e-2, model=model, count=count, modes=kept, at=at, samples=41)
    n = np.arange(1, 301)
    shares = 2 * h / (n**2 * np.pi**2 * r * (1 - r)) * np.sin(n * np.pi * r)
    series = np.cos(np.outer(found.times, omega(n))) @ (shares[:, None] * np.sin(np.outer(n, np.pi * at / L)))
    if model == "analytic":
        assert found.deflection == pytest.approx(series, abs=within * h)
    assert found.amplitudes[:4] * np.sqrt(2 / (LINE * L)) == pytest.approx(
        shares[:4] * np.sign(found.amplitudes[:4] * shares[:4]), rel=1e-4, abs=1e-9 * h
    )
    assert found.deflection[:3] == pytest.approx(series[:3], abs=within * h)


def test_a_function_of_one_number_and_a_constant_are_shapes_too():
    import math

    by_array = freed(sine(2, 1e-3), at=0.2).deflection
    assert freed(lambda x: 1e-3 * math.sin(2 * math.pi * x / L), at=0.2).deflection == pytest.approx(
        by_array, abs=1e-15
    )
    drawn = [0.0, 0.2, L], [0.0, 1e-3, 0.0]
    assert np.array_equal(freed(np.array(drawn), at=0.2).deflection, freed(list(drawn), at=[0.2]).deflection)
    third = freed(np.int64(3), amplitude=np.float32(0.5), at=0.2).deflection
    assert np.array_equal(third, freed(3, amplitude=0.5, at=0.2).deflection)
    struck = freed(None, velocity=lambda x: 0.3)
    assert struck.kinetic[0] == pytest.approx(0.5 * LINE * L * 0.3**2, rel=0.02)  # a pinned end cannot be struck
    assert struck.elastic[0] == 0.0


# ----------------------------------------------------------------------------------------------------------- energy


@pytest.mark.parametrize("model", MODELS)
def test_what_a_static_force_has_put_in_is_there_and_stays(model):
    """Half of F times its deflection a^2 b^2 F / (3 EI L)."""
    force, a = 3.1, 0.37 * L
    b = L - a

    def bent(x):
        near, far = np.minimum(x, a), np.minimum(L - x, b)
        left = force * b * near * (L**2 - b**2 - near**2) / (6 * EI * L)
        right = force * a * far * (L**2 - a**2 - far**2) / (6 * EI * L)
        return np.where(x <= a, left, right)

    found = freed(bent, 0.07, model=model, samples=61)
    stored = 0.5 * force**2 * a**2 * b**2 / (3 * EI * L)
    assert found.elastic[0] == pytest.approx(stored, rel={"analytic": 1e-6}.get(model, 3e-3))
    assert found.kinetic[0] == 0.0
    assert found.kinetic + found.elastic == pytest.approx(np.full(61, found.elastic[0]), rel=1e-12)
    assert found.kinetic.max() > 0.5 * stored


@pytest.mark.parametrize("model", MODELS)
def test_a_damped_mode_keeps_its_share_over_whole_periods_and_never_gains(model):
    zeta = 0.021
    own = 2 * np.pi * freed(2, model=model, amplitude=1e-3).frequencies_hz[1]
    period = 2 * np.pi / (own * np.sqrt(1 - zeta**2))
    found = freed(2, 5 * period, model=model, amplitude=1e-3, modal_damping=zeta, samples=501)
    energy = found.kinetic + found.elastic
    assert energy[::100] == pytest.approx(energy[0] * np.exp(-2 * zeta * own * found.times[::100]), rel=1e-10)
    assert np.all(np.diff(energy) <= 0.0)


def test_the_mass_of_a_stepped_cantilever_is_felt_where_it_is():
    """Struck with the velocity of x, it holds the kinetic energy of every piece."""
    beam = replace(CANTILEVER, section=(Section(length=0.13), Section(length=0.3, thickness=0.0007, density=7900.0)))
    pieces = [(0.0, 0.13, LINE), (0.13, 0.43, 7900.0 * 0.017 * 0.0007)]
    expected = sum(0.5 * mass * 1.1**2 * (end**3 - start**3) / 3 for start, end, mass in pieces)
    for model, count in (("segment", 86), ("fem", 43)):
        found = freed(None, beam=beam, model=model, count=count, velocity=lambda x: 1.1 * x)
        assert found.kinetic[0] == pytest.approx(expected, rel=1e-4)


# ------------------------------------------------------------------------------------------------------ going on


@pytest.mark.parametrize("model", MODELS)
def test_a_drive_goes_on_from_a_free_vibration_as_the_sum_of_both(model):
    asked = {"model": model, "count": MODELS[model], "modal_damping": 0.017, "at": [0.1, 0.3]}
    begun = free_vibration(STRIP, 2, 3.1e-3, amplitude=1e-4, **asked)
    whole = free_vibration(STRIP, 2, 3.1e-3 + 2e-3, amplitude=1e-4, samples=511, **asked)
    both = simulate(STRIP, FORCES, FREQUENCY, 2e-3, continue_from=begun, ledger=False, **asked)
    early = simulate(STRIP, FORCES, FREQUENCY, 2e-3, ledger=False, **asked)
    late = [replace(f, phase_deg=f.phase_deg + 360 * FREQUENCY * 3.1e-3) for f in FORCES]
    driven = simulate(STRIP, late, FREQUENCY, 2e-3, ledger=False, **asked)
    assert both.times[0] == pytest.approx(3.1e-3)
    assert both.deflection[-1] == pytest.approx(driven.deflection[-1] + whole.deflection[-1], abs=1e-12)
    assert abs(both.deflection[-1] - early.deflection[-1] - whole.deflection[-1]).max() > 1e-7


def test_a_slider_rides_where_simulate_goes_on():
    begun = free_vibration(STRIP, 1, 1e-4, amplitude=5e-4, count=11)
    weak = PointForce(position=0.1, amplitude=1e-9)
    slider = Slider(mass=1e-3, mu=0.2, slope=120.0, position=0.15, coupling="one-way")
    found = simulate(STRIP, weak, FREQUENCY, 2e-3, count=11, slider=slider, continue_from=begun)
    still = simulate(STRIP, weak, FREQUENCY, 2e-3, count=11, slider=slider)
    assert abs(found.displacement) > 1e3 * abs(still.displacement)


# ------------------------------------------------------------------------------------------------------- bad input


@pytest.mark.parametrize(
    ("shape", "asked", "said"),
    [
        (3, {}, "amplitude is missing: give mode 3"),
        (0, {"amplitude": 1e-3}, "shape = 0"),
        (29, {"amplitude": 1e-3}, "shape = 29: the segment model has 28 modes"),
        (3, {"amplitude": np.nan}, "amplitude = nan"),
        (np.sin, {"amplitude": 1e-3}, "amplitude = 0.001 is that of a mode"),
        (None, {}, "shape is None and so is velocity"),
        (True, {}, "shape = True"),
        ("plucked", {}, "shape = 'plucked': give a function"),
        ([0.0, 1.0, 0.0], {}, "give a function of x, a pair"),
        (([0.0, 0.2, L], [0.0, 1e-3]), {}, "shape has x of the shape (3,) and values of (2,)"),
        (([0.0, 0.2, 0.4], [0.0, 1e-3, 0.0]), {}, "shape[0] runs from 0.0 to 0.4"),
        (([0.0, 0.3, 0.2, L], [0.0, 1e-3, 0.0, 0.0]), {}, "let x ascend"),
        (([0.0, 0.2, L], [0.0, np.inf, 0.0]), {}, "give as many finite ones"),
        (lambda x: x[:3], {}, "shape(x) answers"),
        (lambda x: np.full(len(x), np.nan), {}, "give as many finite numbers"),
        (lambda x: "high", {}, "shape(x) = 'high'"),
        (sine(1), {"velocity": 2}, "velocity = 2: give a function"),
        (sine(1), {"duration": 0.0}, "duration = 0.0"),
        (sine(1), {"modal_damping": 1.0}, "modal_damping = 1.0"),
        (sine(1), {"samples": 1}, "samples = 1"),
        (sine(1), {"at": 0.5}, "at = 0.5 lies off the beam"),
        (sine(1), {"count": None}, "count is missing"),
        (sine(1), {"model": "analytic", "count": 11}, "count = 11 is for models of parts"),
        (sine(1), {"model": "segmnt"}, "model = 'segmnt'"),
        (
            sine(1),
            {"beam": replace(STRIP, supports=("free", "free"))},
            "in which a beam that is driven or let go may drift",
        ),
        (sine(1), {"modes": 5}, "modes = 5 is for model = analytic: segment keeps all it has, leave it out"),
        (sine(1), {"count": 4000}, "lower count or modes"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_bad_input_is_refused_in_one_sentence(shape, asked, said):
    with pytest.raises(InputError) as found:
        freed(shape, **{"model": "segment", **asked})
    assert said in str(found.value)
    assert "\n" not in str(found.value)


def test_the_exact_frequency_is_that_of_the_notes():
    found = freed(1, model="analytic", amplitude=1e-3, modes=30)
    assert found.notes == ("modes: the first 30, the others left out", "damping: a ratio 0 of every mode")
    assert found.frequencies_hz[29] == pytest.approx(frequency_hz(STRIP, 30), rel=1e-14)


# ------------------------------------------------------------------------------------------------- where it is held


@pytest.mark.parametrize(
    ("supports", "values", "said"),
    [
        (("pinned", "pinned"), (1.0, 1e-3, 0.0), "shape = 1.0 m at x = 0.0 m, where the beam is pinned"),
        (("pinned", "pinned"), (0.0, 1e-3, -2e-3), f"shape = -0.002 m at x = {L!r} m, where the beam is pinned"),
        (("clamped", "free"), (1e-5, 1e-3, 2e-3), "shape = 1e-05 m at x = 0.0 m, where the beam is clamped"),
        (("guided", "clamped"), (0.2, 0.1, 1e-4), f"shape = 0.0001 m at x = {L!r} m, where the beam is clamped"),
    ],
)
@pytest.mark.parametrize("model", MODELS)
def test_a_shape_that_leaves_a_support_is_refused_with_place_and_value(model, supports, values, said):
    table = ((0.0, 0.3 * L, L), values)
    for shape in (table, lambda x: np.interp(x, *table)):
        with pytest.raises(InputError) as found:
            freed(shape, beam=replace(STRIP, supports=supports), model=model)
        assert said in str(found.value)


@pytest.mark.parametrize(
    ("supports", "values"),
    [
        (("pinned", "pinned"), (1e-17, 1e-3, -1e-16)),
        (("clamped", "free"), (0.0, 1e-3, 2e-3)),
        (("guided", "pinned"), (2e-3, 1e-3, 0.0)),
    ],
)
@pytest.mark.parametrize("model", MODELS)
def test_a_shape_may_round_where_the_beam_is_held_and_be_anything_where_it_is_not(model, supports, values):
    at = np.array([0.0, 0.3 * L, L])
    found = freed((at, values), beam=replace(STRIP, supports=supports), model=model, at=at)
    assert found.deflection[0] == pytest.approx(values, abs=4e-5)


@pytest.mark.parametrize("model", MODELS)
def test_what_a_start_misses_of_a_table_at_its_own_places_is_told(model):
    at, values = np.array([0.0, 0.31 * L, L]), np.array([0.0, 1.7e-3, 0.0])
    found = freed((at, values), model=model, at=at)
    off = found.deflection[0, 1] - values[1]
    assert 0.0 < abs(off) < 0.05 * 1.7e-3
    assert found.notes[-1] == (f"start: {off:+.2g} m off the shape at x = {at[1]:g} m, the most at its own places")
    assert not any(note.startswith("start: ") for note in freed(sine(2), model=model).notes)


@pytest.mark.parametrize("model", MODELS)
def test_corners_have_more_elastic_energy_with_every_mode_and_notes_say_so(model):
    """A tip force's static shape has EI w''^2/2 = F^2 L^3 / 6 EI of it; pulled up straight it has a corner at the wall."""

    def bent(x):
        return 7e-4 * (x / L) ** 2 * (3.0 - x / L)

    smooth = freed(bent, beam=CANTILEVER, model=model)
    assert smooth.elastic[0] == pytest.approx(0.5 * EI * 12.0 * 7e-4**2 / L**3, rel=2e-3)
    assert not any(note.startswith("energies") for note in smooth.notes)
    counts = {"count": 2 * MODELS[model]} if MODELS[model] else {"modes": 800}
    straight, finer = (freed(lambda x: 1.4e-3 * x / L, beam=CANTILEVER, model=model, **more) for more in ({}, counts))
    assert finer.elastic[0] > 1.8 * straight.elastic[0] > 3.0 * smooth.elastic[0]
    (note,) = (note for note in straight.notes if note.startswith("energies"))
    share = straight.amplitudes**2 * straight.frequencies_hz**2
    assert note.startswith(
        f"energies: {100 * share[len(share) // 2 :].sum() / share.sum():.2g} % of the elastic energy"
    )


@pytest.mark.parametrize("length", [0.031, 47.0])
def test_how_far_a_mode_may_move_is_told_in_lengths_of_its_beam(length):
    """To slopes of 1e100, whose squares are still numbers."""
    beam = replace(STRIP, length=length)
    most = 1e100 * length
    found = freed(2, beam=beam, amplitude=0.97 * most, at=length / 4, samples=2)
    assert found.deflection[0, 0] == pytest.approx(0.97 * most, rel=1e-6)
    for sign in (-1.0, 1.0):
        with pytest.raises(InputError, match=r"amplitude = .*: give a finite number of at least -"):
            freed(2, beam=beam, amplitude=1.03 * sign * most)


def test_what_is_damped_out_rests_as_long_as_its_turns_are_numbers():
    """Then it is refused as what is not damped: of 1e100 radians and more no power is a number."""
    omega = 2.0 * np.pi * frequency_hz(STRIP, 1)
    rested = freed(1, 1e99 / omega / 100.0, amplitude=0.01, modal_damping=0.1, count=2, at=L / 2, samples=2)
    assert rested.deflection[-1, 0] == 0.0
    with pytest.raises(InputError, match=r"duration = .* is more than .* periods of the highest mode"):
        freed(1, 1.2e100 / omega, amplitude=0.01, modal_damping=0.1, count=2)
