"""Types of arrays: float64, complex128, and the indices and masks that select from them."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
ComplexArray = NDArray[np.complex128]
Indices = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
