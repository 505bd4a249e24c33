"""Fields that take each other away: what a beam that floats alone does where devices or displacements hold it."""

from collections.abc import Sequence

import numpy as np

from verify.errors import InputError
from verify.models.arrays import ComplexArray

_KEPT = 1e-5
"""Of a sum: rounding of its terms with which it is refused. What was lost was a twentieth of it to all of it."""


def check_kept(weights: Sequence[complex], read: Sequence[ComplexArray], frequency_hz: float) -> None:
    """Raise InputError where a sum of fields, by weights (n,) and readings (n, p), is lost in their rounding.

    A drive at r of what bends first moves a floating beam 1/r^2 as far as its forces bend it.
    """
    terms = np.array(weights)[:, None] * np.array(read)
    left, taken = abs(terms.sum(axis=0)).max(), abs(terms).sum(axis=0).max()
    if np.finfo(float).eps * taken > _KEPT * left > 0.0:
        raise InputError(
            f"frequency_hz = {float(frequency_hz)!r}: the beam alone moves {taken / left:.0e} times as far as it does "
            "where the drive holds it, so that its digits are lost: raise the frequency, or give beam.spring in place "
            "of a device"
        )
