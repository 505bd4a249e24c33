"""What values at nodes come to under weights, and up to how many nodes what is made of them is kept."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from verify.models.arrays import Array

KEPT = 4000
"""Nodes up to which a basis is kept for who asks next: about a kilobyte each."""


def weighed(values: Iterable[Any], weights: Iterable[Array]) -> Any:
    """The sum of values, each an array written over, times their weights, one after another."""
    total = None
    for value, weight in zip(values, weights, strict=True):
        np.multiply(value, weight, out=value)
        if total is None:
            total = value
        else:
            total += value
    return total
