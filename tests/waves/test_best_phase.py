"""The fastest allowed phase between two drives, against every phase of a fine circle."""

import numpy as np
import pytest

from verify.waves.best_phase import TRIED, phases_to_try

CIRCLE = 4001
CASES = 400


def waves(seed, scale=3e-6):
    """Amplitudes of both drives in either wave, (CASES, 2) each, all sizes and phases different."""
    parts = np.random.default_rng(seed).standard_normal((4, CASES, 2))
    return scale * (parts[0] + 1j * parts[1]), 0.7 * scale * (parts[2] + 1j * parts[3])


def figures(forward, backward, phases):
    """(reflection, crest speed but for a factor), (n, p) each."""
    plus, minus = (abs(w[:, :1] + w[:, 1:] * np.exp(1j * phases)) ** 2 for w in (forward, backward))
    reflection = np.sqrt(np.minimum(plus, minus) / np.maximum(plus, minus))
    return reflection, abs(plus - minus) / np.sqrt(plus + minus)


def fastest(forward, backward, limit, phases):
    """The largest allowed speed among phases, (n,); 0 where none is allowed."""
    reflection, speed = figures(forward, backward, phases)
    return np.where(reflection <= limit + 1e-13, speed, 0.0).max(axis=1)


@pytest.mark.parametrize("limit", [0.05, 0.1, 0.43, 0.97])
@pytest.mark.parametrize("ends", [(0.087, 3.05), (-3.05, -0.087), (0.4, 1.7)])
def test_no_phase_of_a_fine_circle_beats_the_ten_that_are_tried(limit, ends):
    forward, backward = waves(11)
    tried = phases_to_try(forward, backward, limit, ends)
    assert tried.shape == (CASES, TRIED)
    assert ((tried >= ends[0]) & (tried <= ends[1])).all()
    found = fastest(forward, backward, limit, tried)
    every = fastest(forward, backward, limit, np.linspace(*ends, CIRCLE))
    assert (found >= every * (1.0 - 1e-15)).all()
    assert np.count_nonzero(every) > 9
    allowed = every > 0.0  # a fine circle comes as near as its steps are small
    assert found[allowed] == pytest.approx(every[allowed], rel=5e-3)


@pytest.mark.parametrize("scale", [1e-60, 1.0, 1e60, 1e-190, 1e160])
def test_amplitudes_of_any_size_have_the_same_best_phase(scale):
    forward, backward = waves(7, 1.0)
    plain = phases_to_try(forward, backward, 0.3, (0.1, 3.0))
    assert np.sort(phases_to_try(scale * forward, scale * backward, 0.3, (0.1, 3.0))) == pytest.approx(
        np.sort(plain), abs=1e-7
    )
