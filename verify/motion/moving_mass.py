"""A mass held on a vibrating beam: how much the beam feels it, and how beam and mass stand at the start of a run."""

from typing import TYPE_CHECKING

import numpy as np

from verify.errors import InputError
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import RESONANCE
from verify.models.time_basis import Ratio, TimeBasis
from verify.models.underfoot import standing_at

if TYPE_CHECKING:
    from verify.motion.surface import Stage
    from verify.slider import Slider

PASSES = 4
"""Each shortens what is left of the way by (h/2) w'' and more."""


def modal_receptance(basis: TimeBasis, x: float, omega: float, damping: Ratio) -> ComplexArray:
    """Deflection of every mode under a unit force e^{i omega t} at x, (n,): phi / (omega_n^2 - omega^2 + ...)."""
    stiff = basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega
    return np.asarray(basis.shapes(np.array([x]), 0)[:, 0] / stiff)


def receptance(basis: TimeBasis, x: float, omega: float, damping: Ratio) -> complex:
    """G(x, x) of the modes, m/N."""
    return complex(basis.shapes(np.array([x]), 0)[:, 0] @ modal_receptance(basis, x, omega, damping))


def weighed_down(basis: TimeBasis, x: float, load: float) -> Array:
    """Modes of a beam at rest under a weight on its surface at x, (n,): it acts at the material x + (h/2) w' there.

    Square to the surface, so that it also turns what is under it, by (h/2) w'.
    """
    half, here = standing_at(basis.beam, x).surface_distance, basis.shapes(np.array([x]), 1)[:, 0]
    still = np.zeros(len(basis.omegas))
    for _ in range(PASSES):
        at = np.array([min(max(x + half * float(still @ here), 0.0), basis.beam.length)])
        lean = half * float(still @ basis.shapes(at, 1)[:, 0])
        still = -load * (basis.shapes(at, 0)[:, 0] + lean * here) / basis.omegas**2
    return np.asarray(still)


def carried_along(basis: TimeBasis, stage: "Stage", x: float, slider: "Slider", damping: Ratio) -> tuple[Array, Array]:
    """What the slider's mass at rest at x adds to a steady beam at the stage's time 0: (q, dq/dt), (n,) each.

    W = W_0 / (1 - m omega^2 G): the mass pushes with m omega^2 W. Raises InputError where that is a resonance.
    """
    omega = stage.omega
    answer = modal_receptance(basis, x, omega, damping)
    given = stage.drive_shapes(np.array([x]), 0)[:, 0]
    loop = 1.0 - slider.mass * omega**2 * receptance(basis, x, omega, damping)
    if abs(loop) < RESONANCE:
        raise InputError(
            f"slider.mass = {slider.mass!r} kg held at {x!r} m is in resonance with the drive: give the beam a "
            "loss_factor or choose another mass"
        )
    push = slider.mass * omega**2 * (given[0] + 1j * given[1]) / loop * np.exp(1j * omega * stage.origin)
    phasors = push * answer
    return phasors.real, (1j * omega * phasors).real
