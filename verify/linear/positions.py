"""Positions along a beam and forces on it as users give them: a number or many, one force or many."""

from collections.abc import Sequence
from typing import Any, TypeAlias, TypeVar

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown
from verify.problem.beam import Beam, PointForce, check_frequency
from verify.validation import as_tuple, check_position

Numbers: TypeAlias = float | Sequence[float] | Array
"""One, a list or an array."""
Forces: TypeAlias = PointForce | Sequence[PointForce]
"""One force alone stands for a list of it."""
Values = TypeVar("Values", bound=np.ndarray[Any, Any])
SLACK = 1e-12
"""Distance off an end, relative to the length, that is rounding."""


def real_array(field: str, value: object, unit: str) -> Array:
    """Numbers in any arrangement as an array of the same shape. Raises InputError for what is no real number."""
    try:
        given = np.asarray(value)
    except ValueError:  # rows of different lengths
        given = np.empty(0, dtype=object)
    if given.dtype.kind not in "iuf" or np.ma.is_masked(value):
        raise InputError(f"{field} = {shown(value)}: give a number, a list or an array of numbers ({unit})")
    return given.astype(float, copy=False)


def as_vector(field: str, value: object, unit: str = "SI") -> Array:
    """Numbers in a row, (n,); one alone is a row of one. Raises InputError for rows of rows and what is no number."""
    row = np.atleast_1d(real_array(field, value, unit))
    if row.ndim > 1:
        raise InputError(f"{field} has the shape {row.shape}: give a number, or numbers in one row ({unit})")
    return row


def positions_on(field: str, value: object, length: float) -> Array:
    """Positions on a beam, m, of the shape given. Raises InputError where one lies off it."""
    x = real_array(field, value, "metres")
    off = x[~((x >= -SLACK * length) & (x <= length * (1.0 + SLACK)))]
    if off.size:
        raise InputError(f"{field} = {float(off[0])!r} lies off the beam: give positions between 0 and {length!r} m")
    return x


def vector_on(field: str, value: object, length: float) -> Array:
    """The same in a row, (n,), clipped to the beam. Raises InputError."""
    return np.clip(positions_on(field, as_vector(field, value, "metres"), length), 0.0, length)


def reshape_like(values: Values, x: Numbers) -> Values:
    """Values at x in a row, (..., n), in the arrangement of x, (..., *shape of x): a number is a row of one."""
    shape = np.shape(x)
    return values if len(shape) < 2 else values.reshape(values.shape[:-1] + shape)


def forces_on(beam: Beam, forces: Forces) -> tuple[PointForce, ...]:
    """A force, or several, as a tuple. Raises InputError for a position off the beam and for anything else."""
    acting = as_tuple("forces", forces, PointForce)
    for force in acting:
        check_position("force.position", force.position, beam.length)
    return acting


def frequencies_on(beam: Beam, frequency_hz: Numbers) -> Array:
    """Frequencies in a row, (n,), Hz. Raises InputError for none, and for one that is not positive and finite."""
    row = as_vector("frequency_hz", frequency_hz, "hertz")
    if not row.size:
        raise InputError("frequency_hz is empty: give at least one frequency in hertz")
    for value in {float(row.min()), float(row.max())}:  # a NaN is both
        check_frequency("frequency_hz", value, beam)
    return row
