"""Kinds of arrays, by what they hold."""

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
"""Positions in other arrays."""
Integer = NDArray[np.int64]
Flags = NDArray[np.bool_]
