"""Conversion and checks of positions, frequencies and forces: one or several."""

from collections.abc import Sequence
from typing import Any, TypeAlias, TypeVar

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, shown
from verify.problem.beam import Beam, PointForce, PointLoad, PointMoment, check_frequency
from verify.problem.supports import check_free
from verify.validation import as_tuple, check_position

Numbers: TypeAlias = float | Sequence[float] | Array  # A number, a list or an array
Forces: TypeAlias = PointForce | Sequence[PointForce]  # One force, or several
Loads: TypeAlias = PointLoad | Sequence[PointLoad]  # One force or moment, or several
Kind = TypeVar("Kind", bound=PointLoad)
Values = TypeVar("Values", bound=np.ndarray[Any, Any])
SLACK = 1e-12  # Distance of a position beyond an end, relative to the length, that is rounding


def real_array(field: str, value: object, unit: str) -> Array:
    """Numbers as an array of the same shape. Raises InputError for values that are not real numbers."""
    try:
        array = np.asarray(value)
    except ValueError:  # rows of different lengths
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "iuf" or np.ma.is_masked(value):
        raise InputError(f"{field} = {shown(value)}: give a number, a list or an array of numbers ({unit})")
    return array.astype(float, copy=False)


def as_vector(field: str, value: object, unit: str = "SI") -> Array:
    """One or several numbers as an array (n,). Raises InputError for more dimensions and non-numbers."""
    row = np.atleast_1d(real_array(field, value, unit))
    if row.ndim > 1:
        raise InputError(f"{field} has the shape {row.shape}: give a number, or numbers in one row ({unit})")
    return row


def positions_on(field: str, value: object, length: float) -> Array:
    """Positions on a beam, m, as an array of the same shape. Raises InputError for a position off the beam."""
    x = real_array(field, value, "metres")
    off = x[~((x >= -SLACK * length) & (x <= length * (1.0 + SLACK)))]
    if off.size:
        raise InputError(f"{field} = {float(off[0])!r} lies off the beam: give positions between 0 and {length!r} m")
    return x


def vector_on(field: str, value: object, length: float) -> Array:
    """Positions on a beam, m, as an array (n,), clipped to the beam. Raises InputError."""
    return np.clip(positions_on(field, as_vector(field, value, "metres"), length), 0.0, length)


def reshape_like(values: Values, x: Numbers) -> Values:
    """Reshape values (..., n) at x to (..., *shape of x); (..., 1) for a number."""
    shape = np.shape(x)
    return values if len(shape) < 2 else values.reshape(values.shape[:-1] + shape)


def loads_on(beam: Beam, forces: Kind | Sequence[Kind], kind: type[Kind]) -> tuple[Kind, ...]:
    """One or several loads of a kind as a tuple. Raises InputError for a position off the beam and for other types."""
    acting = as_tuple("forces", forces, kind)
    for force in acting:
        check_position("force.position", force.position, beam.length)
        if isinstance(force, PointMoment):
            check_free("force", force.position, beam.length, beam.supports, {}, {"amplitude": force.amplitude})
    return acting


def frequencies_on(beam: Beam, frequency_hz: Numbers) -> Array:
    """Frequencies as an array (n,), Hz. Raises InputError for none, and for one that is not positive and finite."""
    row = as_vector("frequency_hz", frequency_hz, "hertz")
    if not row.size:
        raise InputError("frequency_hz is empty: give at least one frequency in hertz")
    for value in {float(row.min()), float(row.max())}:  # a NaN is both
        check_frequency("frequency_hz", value, beam)
    return row
