"""Surfaces and losses of beams that shear: the section's own turn of every model, against states along the beam."""

from collections.abc import Sequence
from math import pi
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.device import Device
from verify.models.arrays import ComplexArray
from verify.stress.kind import Floor, Row
from verify.stress.modes.any_beam import States

if TYPE_CHECKING:
    from verify.models.fields import HarmonicField

THICK = Beam(
    length=0.2,
    width=0.02,
    thickness=0.015,
    youngs_modulus=211e9,
    density=7830.0,
    poissons_ratio=0.29,
    loss_factor=0.013,
    supports=("free", "clamped"),
)
"""A steel bar, whose sections turn by half of the slope at 21 kHz."""
LIGHT = replace(THICK, youngs_modulus=114e9, density=4430.0, poissons_ratio=0.33)
SUPPORTS = (("free", "clamped"), ("pinned", "guided"), ("clamped", "pinned"), ("guided", "free"))
FORCES = (PointForce(position=0.025, amplitude=1.4, phase_deg=-35.0), PointForce(position=0.165, phase_deg=80.0))
DEVICE = Device(position=0.08, stiffness=2.1e5, mass=0.011, dashpot=31.0)
PLACES = np.array([0.0, 0.0007, 0.014, 0.031, 0.062, 0.104, 0.137, 0.171, 0.1994, 0.2])
"""Metres: ends, near fields, and what lies between."""
HERTZ = 21000.0
PARTS: dict[str, tuple[int | None, dict[str, str]]] = {
    "analytic": (None, {}),
    "fem": (80, {}),
    "segment": (160, {"joints": "tensioned"}),
}
"""Elements end on forces and the device, joints stand on them."""


def states_of(beam: Beam) -> tuple[ComplexArray, ComplexArray]:
    """Deflection and turn at `PLACES` under the forces, with the device on the beam, (n,) both."""
    omega = 2.0 * pi * HERTZ
    across = DEVICE.stiffness - omega**2 * DEVICE.mass + 1j * omega * DEVICE.dashpot
    stops = [*PLACES.tolist(), DEVICE.position, *(force.position for force in FORCES)]
    states = States(beam, "timoshenko", omega**2, stops, {DEVICE.position: (across, 0.0)})
    under = states.under(FORCES)
    found = under[[states.end(x) for x in PLACES.tolist()]]
    return found[:, 0], found[:, 1] / beam.length


def turn_error(number: float, model: str) -> float:
    """Of the turn over its largest, or of the surface's axis ratio, of both bars on two supports, by one model."""
    from verify.models.catalogue import MODELS
    from verify.waves.devices import field_with_devices
    from verify.waves.measures import ellipse, surface_motion

    def solve(beam: Beam, forces: Sequence[PointForce], hertz: float) -> "HarmonicField":
        count, settings = PARTS[model]
        return MODELS[model].solve_harmonic(beam, forces, hertz, count, theory="timoshenko", **settings)

    worst = 0.0
    for bar in (THICK, LIGHT):
        beam = replace(bar, supports=SUPPORTS[int(number)])
        deflection, turn = states_of(beam)
        field = field_with_devices(solve, beam, FORCES, HERTZ, DEVICE)
        worst = max(worst, float(abs(field.turn(PLACES) - turn).max() / abs(turn).max()))
        exact = ellipse(-0.5 * 0.015 * turn, deflection)[0]
        found = ellipse(surface_motion(beam, field.turn(PLACES)), field.deflection(PLACES))[0]
        inside = abs(deflection) > 0.02 * abs(deflection).max()
        worst = max(worst, float(abs(found - exact)[inside].max()))
    return worst


def lost_error(loss_factor: float) -> float:
    """Of the balance of power of both bars, made long: what the forces give, bending and shear take, and waves carry.

    The loss factor takes eta omega / 2 of EI |psi'|^2 and of kappa G A |w' - psi|^2.
    """
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.driven import measures, power_imbalance

    worst = 0.0
    for bar in (THICK, LIGHT):
        beam = replace(bar, length=0.9, loss_factor=loss_factor, supports=("pinned", "clamped"))
        forces = (PointForce(position=0.04, amplitude=3.0), PointForce(position=0.86, amplitude=2.0, phase_deg=60.0))
        field = solve_harmonic(beam, forces, 47000.0, "timoshenko")
        worst = max(worst, abs(power_imbalance(field, measures(field, None))))
    return worst


def _turns(model: str, title: str, why: str, promise: float) -> Row:
    return Floor(
        id=f"turns-of-{title}",
        title=f"Turn of the section and axis ratio of the surface of thick bars with a device, by {title}, in states",
        why=why,
        along="supports",
        at=(0, 1, 2, 3),
        promise=promise,
        error=lambda number: turn_error(number, model),
    )


ROWS: tuple[Row, ...] = (
    _turns("analytic", "exact-beam", "exact/driven.py: the turn is one of the states, to rounding.", 1e-11),
    _turns("fem", "elements", "elements/shear.py: the turn is quadratic in each of 80 elements.", 4e-4),
    _turns("segment", "segments", "segments/turned.py: order 2; what a device takes of 160 links that slip, 1.", 6e-3),
    Floor(
        id="power-lost-by-shear",
        title="What forces give, bending and shear lose, and waves carry, of thick bars with losses",
        why="waves/driven.py: both moduli have the loss; near fields leave 1e-8 so far from the forces.",
        along="eta",
        at=(0.004, 0.02, 0.05),
        promise=1e-7,
        error=lost_error,
    ),
)
