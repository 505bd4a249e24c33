"""MuJoCo's control callback in machine code: it is called at every stage of a step, and Python at none.

The engine's own bindings take a C function for a callback (Python Bindings, Callbacks) and call it without Python. It
finds what it reads and writes at addresses, and what the case is in numbers, both of the run that is under way.
"""

import ctypes
from functools import cache
from math import cos, isfinite, pi, radians, tanh
from typing import Any, NamedTuple

import numpy as np

from verify.models.arrays import Array
from verify.peers.case import Case, Sled, cubic

MOST_FORCES = 64
ROW = 6
"""Of a body's applied force and moment."""


class Push(NamedTuple):
    """The C function, and what it reads of the run that is under way."""

    function: Any
    """A ctypes pointer to it."""
    places: Any
    """(8,), whole numbers: addresses of time, qpos, qvel, xfrc_applied and qfrc_applied; links, forces, sliders."""
    numbers: Array
    """(7,): omega, length of a link; friction over the slider's, slope, half a thickness, start; unused."""
    forces: Array
    """(MOST_FORCES, 4): of each its body, amplitude, phase in radians, lever about the body's middle."""
