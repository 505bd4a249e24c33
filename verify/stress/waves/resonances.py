"""What stands on a beam, or holds it, where the beam alone resonates: Green's function of a pinned strip."""

from decimal import Decimal, localcontext

import numpy as np

from verify.beam import PointForce
from verify.device import Device
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP
from verify.stress.references.decimals import DIGITS, PI, sin, sinh

MODE = 7
BESIDE = (0.0, 1e-12, -3e-10, 2e-9, -1e-7, 1e-5)
"""Of the resonance, relative, from it."""
AT, FROM, STANDS = 0.45 * STRIP.length, 0.08 * STRIP.length, 0.19 * STRIP.length
"""Where the field is read, driven and damped."""


def green(hertz: float, x: float, source: float) -> Decimal:
    """Deflection of the strip at x under a unit force, m/N, within the digits that are set."""
    k = (2 * PI * Decimal(hertz) / Decimal(STRIP.wave_constant)).sqrt()
    low, high = Decimal(min(x, source)), Decimal(STRIP.length) - Decimal(max(x, source))
    parts = [of(k * low) * of(k * high) / of(k * Decimal(STRIP.length)) for of in (sin, sinh)]
    return (parts[0] - parts[1]) / (2 * Decimal(STRIP.bending_stiffness) * k**3)


def damped_error(dashpot: float) -> float:
    """Of the exact field with one dashpot, on the resonance of the bare strip and beside it."""
    from verify.exact.closed_forms import frequency_hz
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.devices import field_with_devices

    worst, devices = 0.0, (Device(position=STANDS, dashpot=dashpot),)
    for part in BESIDE:
        hertz = frequency_hz(STRIP, MODE) * (1.0 + part)
        with localcontext() as context:
            context.prec = DIGITS
            resists, own = 2 * PI * Decimal(hertz) * Decimal(dashpot), green(hertz, STANDS, STANDS)
            taken = resists * green(hertz, AT, STANDS) * green(hertz, STANDS, FROM) / (1 + (resists * own) ** 2)
            exact = complex(float(green(hertz, AT, FROM) - resists * own * taken), -float(taken))
        found = field_with_devices(solve_harmonic, STRIP, (PointForce(position=FROM),), hertz, devices)
        worst = largest(worst, abs(complex(found.shapes(np.array([AT]), 0)[0]) / exact - 1.0))
    return worst


def held_error(off: float) -> float:
    """Of the exact field under a displacement imposed so many half waves off a node of the resonance."""
    from verify.exact.closed_forms import frequency_hz
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.imposed import driven_field

    worst, place = 0.0, (3.0 + off) * STRIP.length / MODE
    for part in BESIDE:
        hertz = frequency_hz(STRIP, MODE) * (1.0 + part)
        with localcontext() as context:
            context.prec = DIGITS
            exact = float(green(hertz, AT, place) / green(hertz, place, place))
        drives = (PointForce(position=place),)
        found = driven_field(lambda forces, f: solve_harmonic(STRIP, forces, f), drives, hertz, "displacement")
        worst = largest(worst, abs(complex(found.shapes(np.array([AT]), 0)[0]) / exact - 1.0))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="resonances-damped",
        title="The exact field with ever lighter dashpots where the bare strip resonates, against Green's function",
        why="waves/poles.py: rounding of the frequency over the damping ratio, 1e-9 under the lightest.",
        along="N s/m",
        at=(100.0, 1.0, 1e-2, 1e-4, 1e-6),
        promise=1e-6,
        error=damped_error,
    ),
    Floor(
        id="held-beside-nodes",
        title="The exact field under a displacement ever nearer to a node of the bare strip's resonance",
        why="waves/poles.py: rounding of the frequency over the distance to the held strip's own, 2e-8 at 1e-4.",
        along="half waves",
        at=(0.3, 1e-2, 1e-3, 1e-4),
        promise=1e-7,
        error=held_error,
    ),
)
