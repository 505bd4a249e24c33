"""Frequencies and damping of records of known modes."""

from math import pi

import numpy as np
import pytest

from verify.errors import InputError
from verify.identify.ring_down import ring_down


def record(times, modes, noise=0.0, seed=0, offset=0.0, drift=0.0):
    """Sum of decaying cosines (damped Hz, ratio, amplitude, phase) with noise, an offset and a drift."""
    y = offset + drift * times
    for hz, zeta, size, phase in modes:
        decay = 2.0 * pi * hz * zeta / np.sqrt(1.0 - zeta**2)
        y = y + size * np.exp(-decay * times) * np.cos(2.0 * pi * hz * times + phase)
    return y + noise * np.random.default_rng(seed).standard_normal(len(times))


@pytest.mark.parametrize(
    ("n", "end", "modes"),
    [
        (500, 1.3, [(6.81, 0.011, 1.0, 0.3)]),
        (90, 0.27, [(6.81, 0.05, 1.0, 0.3)]),  # less than two periods
        (400, 0.4, [(68.1, 0.61, 1.0, 0.0)]),  # as MuJoCo's implicit Euler leaves a mode
        (
            3000,
            2.0,
            [(6.81, 0.01, 1.0, 0.3), (42.6, 0.02, 0.2, 1.0), (44.0, 0.01, 0.1, 0.0), (119.0, 0.005, 0.05, 2.0)],
        ),
        (900, 1.1, [(5.2, -0.004, 1.0, 0.2)]),  # a chain that makes energy
    ],
)
def test_modes_of_a_noisy_record_are_found_within_their_intervals(n, end, modes):
    times = np.linspace(0.0, end, n)
    found = ring_down(times, record(times, modes, noise=1e-3, offset=0.4, drift=-0.2).astype(np.float32))
    assert len(found.modes) == len(modes)
    assert found.noise == pytest.approx(1e-3, rel=0.2)
    for mode, (hz, zeta, size, _) in zip(found.modes, modes, strict=True):
        half = [0.5 * (high - low) for low, high in (mode.hz_interval, mode.zeta_interval)]
        assert [mode.hz, mode.zeta] == pytest.approx([hz, zeta], abs=2.0 * max(half))  # four standard deviations
        assert abs(mode.hz - hz) < 2.0 * half[0]
        assert abs(mode.zeta - zeta) < 2.0 * half[1]
        assert mode.amplitude[0] == pytest.approx(size, rel=0.05)


def test_without_noise_all_digits_of_single_precision_are_used():
    times = np.linspace(0.0, 3.0, 1000)
    modes = [(5.0, 0.01, 1.0, 0.2), (31.3, 0.01, 0.3, 0.1), (87.7, 0.01, 0.1, 0.0)]
    found = ring_down(times, record(times, modes).astype(np.float32))
    assert found.hertz == pytest.approx([5.0, 31.3, 87.7], rel=1e-8)
    assert [mode.zeta for mode in found.modes] == pytest.approx([0.01] * 3, rel=1e-6)


def test_two_signals_share_their_modes_and_uneven_samples_are_taken_as_they_are():
    rng = np.random.default_rng(7)
    times = np.sort(rng.uniform(0.0, 2.0, 700))
    shared = [(3.1, 0.02), (17.0, 0.015)]
    signals = [
        record(times, [(*pole, size, 0.4) for pole, size in zip(shared, sizes, strict=True)], noise=2e-3, seed=seed)
        for seed, sizes in enumerate(((1.0, 0.02), (0.01, 0.5)))
    ]
    found = ring_down(times, np.stack([signals[0], np.full(700, 0.3), signals[1]], axis=1))
    assert [mode.amplitude[1] for mode in found.modes] == [0.0, 0.0]  # a channel that does not move
    assert [found.modes[0].amplitude[0], found.modes[1].amplitude[2]] == pytest.approx([1.0, 0.5], rel=0.02)
    assert found.hertz == pytest.approx([3.1, 17.0], rel=1e-3)
    assert [mode.zeta for mode in found.modes] == pytest.approx([0.02, 0.015], rel=0.03)


def test_intervals_contain_the_truth_in_95_of_100_records():
    times, modes = np.linspace(0.0, 1.7, 220), [(4.3, 0.03, 1.0, 0.5), (11.0, 0.02, 0.4, 1.2)]
    hits = np.zeros(4)
    for seed in range(150):
        found = ring_down(times, record(times, modes, noise=0.02, seed=seed), n_modes=2)
        for i, (mode, (hz, zeta, _, _)) in enumerate(zip(found.modes, modes, strict=True)):
            hits[2 * i] += mode.hz_interval[0] <= hz <= mode.hz_interval[1]
            hits[2 * i + 1] += mode.zeta_interval[0] <= zeta <= mode.zeta_interval[1]
    assert (hits / 150 >= 0.89).all()
    assert hits.sum() / 600 == pytest.approx(0.95, abs=0.03)


@pytest.mark.parametrize(
    ("times", "signal", "text"),
    [
        (np.linspace(0.0, 1.0, 9), np.ones(9), "16 or more"),
        (np.linspace(0.0, 1.0, 50), np.ones(50), "constant"),
        (np.zeros(50), np.arange(50.0), "ascending"),
        (np.linspace(0.0, 1.0, 50), np.full(50, np.nan), "finite"),
        (np.linspace(0.0, 1.0, 200), np.random.default_rng(3).standard_normal(200), "rings"),
    ],
)
def test_a_record_in_which_nothing_rings_is_refused(times, signal, text):
    with pytest.raises(InputError, match=text):
        ring_down(times, signal)


@pytest.mark.parametrize("seed", range(3))
def test_modes_of_a_strip_that_is_held_before_its_release_are_those_of_the_free_part(seed):
    """A deflection held for 50 ms, then two modes, by a camera of 240 frames a second, its positions rounded."""
    times = np.arange(384) / 240.0
    modes = [(7.786, 0.0043, 11.64, 0.0), (48.99, 0.0043, 0.36, 0.0)]
    held = np.where(times < 0.05, 12.0, record(np.maximum(times - 0.05, 0.0), modes))
    found = ring_down(times, np.round(held + 0.12 * np.random.default_rng(seed).standard_normal(384), 1))
    assert len(found.modes) == 2
    for mode, (hz, zeta, *_) in zip(found.modes, modes, strict=True):
        assert abs(mode.hz - hz) < 2.0 * mode.halves[0]  # four standard deviations
        assert abs(mode.zeta - zeta) < 2.0 * mode.halves[1]
