"""Fields that take each other away: what a beam that floats alone does where devices or displacements hold it."""

from collections.abc import Sequence
from math import sqrt

import numpy as np

from verify.arrays import ComplexArray
from verify.errors import InputError

_KEPT = 1e-5
"""Of a sum: rounding of its terms with which it is refused. What was lost was a twentieth of it to all of it."""
_BENT = 1e-5
"""Of how far its forces bend a beam: no sum is held against less. What a stiff device takes off its own place is that
little, of a beam that floats or not, and rounding of what bends it tells as little of it as of any other place."""


def check_kept(
    weights: Sequence[complex],
    read: Sequence[ComplexArray],
    newtons: Sequence[float],
    unit: float,
    frequency_hz: float,
) -> None:
    """Raise InputError where a sum of fields, by weights (n,) and readings (n, p), is lost in their rounding.

    A drive at r of what bends first moves a floating beam 1/r^2 as far as its forces bend it. These are so many newtons
    in each field, (n,), and `unit` is the beam's `unit_response`, m/N. Beams that do not float always pass.
    """
    terms = np.array(weights)[:, None] * np.array(read)
    bent = unit * float(abs(np.array(weights)) @ np.array(newtons))
    left, taken = max(abs(terms.sum(axis=0)).max(), _BENT * bent), abs(terms).sum(axis=0).max()
    lost = float(np.finfo(float).eps * taken)
    if lost > _KEPT * left:
        enough = 1.05 * frequency_hz * sqrt(lost / (_KEPT * left))
        raise InputError(
            f"frequency_hz = {float(frequency_hz)!r}: the beam alone moves {taken / left:.0e} times as far as it does "
            "where the drive holds it, so that its digits are lost: raise the frequency, to at "
            f"least {enough:.2g} Hz, or let beam.spring hold the beam, in place of a device that is a spring or where "
            "a displacement is imposed"
        )
