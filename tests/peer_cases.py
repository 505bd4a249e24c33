"""A chain that is symmetric in nothing, what drives it, and how far a run of it is off."""

import numpy as np

from verify.beam import PointForce

FORCES = (
    PointForce(position=0.0731, amplitude=0.013, phase_deg=-37.0),
    PointForce(position=0.5219, amplitude=0.021, phase_deg=71.0),
    PointForce(position=0.0797, amplitude=0.005, phase_deg=160.0),
)
"""The first and the last on one link of 13, not on joints."""
FREQUENCY = 1234.5


def relative_rms(values, exact):
    """Rms of a difference over the rms of what is exact."""
    return float(np.sqrt(np.mean((values - exact) ** 2) / np.mean(exact**2)))


def deflection_error(run, exact):
    """Of mid-span over the samples that a run kept, which broke nowhere."""
    assert not run.broke
    assert len(run.times) >= 40
    return relative_rms(run.deflection, exact(run.times))


def ride_error(run, exact):
    """The larger of those of a slider's distance and of its speed."""
    assert not run.broke
    assert len(run.times) >= 40
    pairs = zip((run.distance, run.speed), exact(run.times), strict=True)
    return max(relative_rms(found, true) for found, true in pairs)
