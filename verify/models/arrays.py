"""The arrays of every room, by one name each: float64 and complex128, and what chooses among them."""

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Numbers: TypeAlias = float | Sequence[float] | Array
"""As users type them: one, a list, an array."""
