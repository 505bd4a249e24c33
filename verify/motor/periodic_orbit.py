"""Periodic orbit of a motor by shooting: fixed point of the period map, by Newton's method.

A. H. Nayfeh and B. Balachandran, Applied Nonlinear Dynamics, Wiley 1995, sec. 7.1.2 (shooting) and 3.2 (multipliers).
"""

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.dynamics.arguments import PrescribedSlider
from verify.dynamics.contact_assembly import assemble
from verify.dynamics.result import FOOT_STATE, EndState, Motion
from verify.errors import InputError
from verify.formatting import one_line
from verify.motor.steady_state import MotorCase

ROUNDS = 12
DIFFERENCE = 1e-4  # Step of the difference quotients, over the scale of a coordinate
REPEATS = 1e-3
"""Largest residual, over the scale of a coordinate; impacts on dashpots are discontinuous in the time step."""


class PeriodicOrbit(Struct, frozen=True, eq=False, kw_only=True):
    """Motion of the feet with the period of the drive."""

    run: Motion  # Motion over the period
    residual: float  # Largest change of a coordinate over the period, relative to its scale
    multipliers: ComplexArray  # (n,), eigenvalues of the Jacobian of the period map (Floquet multipliers)
    __repr__ = one_line(residual="", largest_multiplier="")

    @property
    def largest_multiplier(self) -> float:
        """Largest magnitude of the multipliers; stable below 1."""
        return float(max(abs(self.multipliers)))


def periodic_orbit(
    case: MotorCase, speed: float = 0.0, *, tolerance: float = 1e-10, settle: int = 100
) -> PeriodicOrbit:
    """Periodic orbit of a slider at a prescribed speed, m/s, one-way coupled to a steady beam.

    Newton's method starts after `settle` periods. Scales: the range h of the heights, h / foot length for pitches, and
    these times omega for rates. Raises InputError where Newton's method does not converge.
    """
    slider = case.slider
    if slider.coupling != "one-way" or case.start != "steady":
        raise InputError(f"slider.coupling = {slider.coupling!r}: a periodic orbit needs one-way coupling, choose it")
    run = case.run(settle, 61 * settle + 1, None, speed)
    height = float(np.ptp(run.height[-61:]) + np.abs(run.end.feet[:, 0]).max()) + 1e-12
    arm = float(np.abs(run.point_offsets).max()) or 1.0
    scale = np.multiply.outer([height, height / arm], [1.0, 2.0 * np.pi * case.frequency_hz]).ravel()
    held = PrescribedSlider(slider, speed, fixed_position=True)
    feet = assemble(case.beam, [held], (slider.initial_position(case.beam),)).feet
    moves = np.stack([feet["inverse_mass"], feet["inverse_inertia"]], axis=1) > 0.0
    free = np.flatnonzero(np.repeat(moves, 2, axis=1).ravel())
    size = np.tile(scale, len(moves))[free]

    def shifted(state: EndState, feet: Array, by: Array) -> EndState:
        """A state with feet whose free coordinates are shifted."""
        assert state.contact is not None
        feet, records = feet.copy(), state.contact.feet.copy()
        feet.flat[free] += by * size
        for name, values in zip(FOOT_STATE, feet.T, strict=True):
            records[name] = values
        return replace(state, contact=state.contact._replace(feet=records))

    def period(start: Motion, by: Array) -> Motion:
        return case.run(1.0, 2, replace(start, end=shifted(start.end, start.end.feet, by)), speed)

    def coordinates(one: Motion) -> Array:
        return np.asarray(one.end.feet.flat[free] / size)

    still, best = np.zeros(len(free)), None
    for _ in range(ROUNDS):
        after = period(run, still)
        ends = [coordinates(period(run, row)) for row in DIFFERENCE * np.eye(len(free))]
        jacobian = (np.array(ends) - coordinates(after)).T / DIFFERENCE
        change = coordinates(after) - coordinates(run)
        residual = float(np.abs(change).max())
        if best is None or residual < best.residual:
            best = PeriodicOrbit(run=after, residual=residual, multipliers=np.linalg.eigvals(jacobian).astype(complex))
        if residual <= tolerance:
            return best
        step = np.linalg.lstsq(np.eye(len(free)) - jacobian, change, rcond=None)[0]
        run = replace(after, end=shifted(after.end, run.end.feet, np.asarray(step)))
    if best is None or best.residual > REPEATS:
        raise InputError(f"speed = {speed!r} m/s: no motion repeats after one period, use means over many periods")
    return best
