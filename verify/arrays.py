"""The arrays of every room, by one name each: float64 and complex128, and what chooses among them."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
