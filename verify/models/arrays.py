"""The arrays of every room, by one name each: float64 and complex128, and what chooses among them."""

from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Real = TypeVar("Real", np.float64, np.int64)


def distinct(values: NDArray[Real]) -> NDArray[Real]:
    """Each value once, ascending: numpy's `unique` of real numbers, which looks for masked arrays first."""
    ordered = np.sort(values, axis=None)
    first = np.ones(len(ordered), dtype=bool)
    first[1:] = ordered[1:] != ordered[:-1]
    return ordered[first]
