"""A beam with arrays on it, as any mesh format takes it: values, no format in it."""

import msgspec
import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array, Indices


class Sheet(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A line of points along a beam, what is known at each, and how it goes on over steps.

    x runs along the beam, y across its thickness, z across its width; all values are SI.
    """

    what: str
    """modes, field or motion."""
    told: str
    """What it is, as a noun."""
    x: Array
    """(n,), metres, ascending."""
    cells: dict[str, Array]
    """(n - 1,) each: of the beam between two points."""
    at_points: dict[str, Array]
    """(n,) or (n, 3) each."""
    beside: dict[str, Array]
    """(m,) each: frequencies and other figures of the whole."""
    steps: Array
    """(k,): what the series goes over; empty where there is none."""
    step_name: str
    """time_s or frequency_hz."""
    stepped: dict[str, Array]
    """(k, n, 3) each."""
    histories: dict[str, Array]
    """(k,) each: of the slider."""

    @property
    def points(self) -> Array:
        """(n, 3), metres."""
        return across(self.x, 0)

    @property
    def lines(self) -> Indices:
        """(n - 1, 2): the points between which the beam's parts lie."""
        first = np.arange(len(self.x) - 1)
        return np.stack([first, first + 1], axis=1)


def across(values: Array, axis: int = 1) -> Array:
    """Numbers (..., n) as vectors (..., n, 3) along one axis: y unless said otherwise."""
    vectors = np.zeros((*np.shape(values), 3))
    vectors[..., axis] = values
    return vectors


def cells_of(beam: Beam, x: Array) -> dict[str, Array]:
    """EI (N m^2), rho A (kg/m) and the number of the section, from 0, of the beam between x (n,), (n - 1,) each."""
    ends = np.cumsum([piece.length for piece in beam.pieces])
    index = np.minimum(np.searchsorted(ends, 0.5 * (x[1:] + x[:-1])), len(beam.pieces) - 1)
    return {
        "section": index.astype(float),
        "bending_stiffness": np.array([piece.bending_stiffness for piece in beam.pieces])[index],
        "mass_per_length": np.array([piece.mass_per_length for piece in beam.pieces])[index],
    }
