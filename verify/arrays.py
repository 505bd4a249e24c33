"""Types of arrays: float64, complex128, and the indices and masks that select from them."""

from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
Numeric: TypeAlias = NDArray[Any]
"""Real or complex numbers."""
Sparse: TypeAlias = Any
"""A sparse array of scipy, which has no types."""
Curve: TypeAlias = Callable[[Array, int], Numeric]
"""(x in m, derivative) -> values (k, len(x))."""
