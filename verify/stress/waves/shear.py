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
from verify.stress.largest import largest
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
PARTS: dict[str, tuple[int | None, dict[str, str], float]] = {
    "analytic": (None, {}, 1.0),
    "fem": (80, {}, 20.0),
    "segment": (160, {"joints": "tensioned"}, 1.0),
}
"""How many, on which settings, and how many times as much is left to the turn's derivative, of order 2 in elements.

Elements end on forces and the device, joints stand on them."""


def states_of(beam: Beam, device: Device | None = DEVICE) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Deflection, turn and its derivative at `PLACES` under the forces, with a device on the beam, (n,) each."""
    omega, resists = 2.0 * pi * HERTZ, {}
    if device:
        resists = {device.position: (device.stiffness - omega**2 * device.mass + 1j * omega * device.dashpot, 0.0)}
    stops = [*PLACES.tolist(), *resists, *(force.position for force in FORCES)]
    states = States(beam, "timoshenko", omega**2, stops, resists)
    under, ends = states.under(FORCES), [states.end(x) for x in PLACES.tolist()]
    bends: ComplexArray = np.array([(states.rates[min(i, len(states.rates) - 1)] @ under[i])[1] for i in ends])
    return under[ends, 0], under[ends, 1] / beam.length, bends / beam.length**2


def turn_error(number: float, model: str) -> float:
    """Of turn and its derivative over their largest, or of the surface's axis ratio, of both bars, by one model."""
    from verify.models.catalogue import MODELS
    from verify.waves.devices import field_with_devices
    from verify.waves.measures import ellipse, surface_motion

    def solve(beam: Beam, forces: Sequence[PointForce], hertz: float) -> "HarmonicField":
        count, settings, _ = PARTS[model]
        return MODELS[model].solve_harmonic(beam, forces, hertz, count, theory="timoshenko", **settings)

    worst = 0.0
    for bar in (THICK, LIGHT):
        beam = replace(bar, supports=SUPPORTS[int(number)])
        deflection, turn, bend = states_of(beam)
        field = field_with_devices(solve, beam, FORCES, HERTZ, DEVICE)
        worst = largest(worst, float(abs(field.turn(PLACES) - turn).max() / abs(turn).max()))
        off = abs(field.turns(PLACES, 1) - bend).max() / abs(bend).max()
        worst = largest(worst, float(off) / PARTS[model][2])
        exact = ellipse(-0.5 * 0.015 * turn, deflection)[0]
        found = ellipse(surface_motion(beam, field.turn(PLACES)), field.deflection(PLACES))[0]
        inside = abs(deflection) > 0.02 * abs(deflection).max()
        worst = largest(worst, float(abs(found - exact)[inside].max()))
    return worst


def along_error(number: float) -> float:
    """150 times what links that slip lack of the turn along both bars, whatever its size, and 5 of its derivative.

    What loads take of them, order 2, changes the size alone. The rest is of order 4, beside a free end 3: 3e-5 and
    1e-3 of 160 links, which come to what the row promises of the size.
    """
    from verify.models.catalogue import MODELS

    worst, (count, settings, _) = 0.0, PARTS["segment"]
    for bar in (THICK, LIGHT):
        beam = replace(bar, supports=SUPPORTS[int(number)])
        _, turn, bend = states_of(beam, None)
        field = MODELS["segment"].solve_harmonic(beam, FORCES, HERTZ, count, theory="timoshenko", **settings)
        found = field.turns(PLACES, 0)
        size = np.vdot(turn, found) / np.vdot(turn, turn)
        bent = field.turns(PLACES, 1) / size
        worst = largest(worst, 150.0 * float(abs(found / size - turn).max() / abs(turn).max()))
        worst = largest(worst, 5.0 * float(abs(bent - bend).max() / abs(bend).max()))
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
        worst = largest(worst, abs(power_imbalance(field, measures(field, None))))
    return worst


def _turns(model: str, title: str, why: str, promise: float) -> Row:
    return Floor(
        id=f"turns-of-{title}",
        title=f"Turn of the section, how it changes, and axis ratio of thick bars with a device, by {title}, in states",
        why=why,
        along="supports",
        at=(0, 1, 2, 3),
        promise=promise,
        error=lambda number: max(turn_error(number, model), along_error(number) if model == "segment" else 0.0),
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
