"""The elastic modes of a beam model."""

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.formatting import one_line
from verify.linear.numerics import zeros
from verify.linear.positions import Numbers, positions_on, reshape_like

EMPTY = np.empty(0)


class Modes(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Elastic modes of one model, ascending; mode n has index n - 1.

    Shapes are normalised to unit modal mass (integral of rho A phi^2 dx = 1 kg m^2 / m^2, for a discrete
    model with its own mass matrix) and positive next to the left end.
    """

    model: str
    """Name of the model."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    length: float
    """L, m."""
    frequencies_hz: Array
    """(n_modes,), ascending."""
    shapes: Callable[[Array, int], Array]
    """(x, derivative) -> (n_modes, len(x)); x in m."""
    nodes: Array = EMPTY
    """(n_nodes,), m: joints or element ends, both ends of the beam included; empty for the exact beam."""
    readings: dict[str, Callable[[], Array]] = msgspec.field(default_factory=dict)
    """Readings of the deflection at `nodes` by name, default first: () -> (n_modes, n_nodes)."""
    points: Array = EMPTY
    """(n_points,), m, evenly spaced positions at which the shape needs no interpolation; empty for the exact beam."""
    sampled: Callable[[], Array] = lambda: EMPTY
    """() -> deflection at `points`, (n_modes, n_points)."""
    curvature_points: Array = EMPTY
    """(n_curvatures,), m: positions of most accurate curvature."""
    curvatures: Callable[[], Array] = lambda: EMPTY
    """() -> curvature at `curvature_points`, (n_modes, n_curvatures), in 1/(m^2 sqrt(kg)); from the right at a step."""
    method: str = "closed form"
    """Method of the eigenvalues."""
    __repr__ = one_line(model="", count="", frequencies_hz="Hz")

    @classmethod
    def of_shapes(cls, nodes: Array, shapes: Callable[[Array, int], Array], **fields: Any) -> "Modes":
        """Modes from continuous shapes with two or more derivatives: (x, derivative) -> (n, len(x)).

        `nodes` (n_nodes,) are the evenly spaced ends of the parts, including both ends of the beam; `fields` are model,
        count, frequencies_hz and optionally method.
        """
        return cls(
            length=float(nodes[-1]),
            shapes=shapes,
            nodes=nodes,
            readings={"shapes": lambda: shapes(nodes, 0)},
            points=nodes,
            sampled=lambda: shapes(nodes, 0),
            curvature_points=nodes,
            curvatures=lambda: shapes(nodes, 2),
            **fields,
        )

    @property
    def n_modes(self) -> int:
        """Number of modes."""
        return len(self.frequencies_hz)

    def deflection(self, x: Numbers) -> Array:
        """Mass-normalised deflection at x (m), (n_modes, *shape of x), 1/sqrt(kg). Raises InputError off the beam."""
        return reshape_like(self.shapes(positions_on("x", x, self.length).ravel(), 0), x)

    def node_positions(self, mode: int) -> Array:
        """Positions of the nodes of a mode, from 1, between the ends of the beam, m, ascending, (n_zeros,)."""
        return zeros(lambda x: self.deflection(x)[mode - 1], self.length, mode)

    def at_nodes(self, reading: str | None = None) -> Array:
        """Deflection at `nodes` by a reading (default: the first), (n_modes, n_nodes). Raises InputError."""
        if reading is not None and reading not in self.readings:
            raise InputError(f"reading = {reading!r} is not a reading of {self.model}: give {', '.join(self.readings)}")
        return self.readings[reading or next(iter(self.readings))]()

    def slope(self, x: Numbers) -> Array:
        """d/dx of the deflection, of the same shape, 1/(m sqrt(kg)). Raises InputError off the beam."""
        return reshape_like(self.shapes(positions_on("x", x, self.length).ravel(), 1), x)
