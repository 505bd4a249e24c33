"""Numbers in order, each once."""

from typing import TypeVar

import numpy as np

from verify.models.arrays import Array, Indices

Numbers = TypeVar("Numbers", Array, Indices)


def distinct(values: Numbers) -> Numbers:
    """Each value once, ascending: numpy's `unique` of real numbers, which looks for masked arrays first."""
    ordered = np.sort(values, axis=None)
    first = np.ones(len(ordered), dtype=bool)
    first[1:] = ordered[1:] != ordered[:-1]
    return ordered[first]
