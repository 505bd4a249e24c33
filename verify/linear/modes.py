"""What every model's `solve_modes` returns."""

from collections.abc import Callable

import msgspec

from verify.arrays import Array
from verify.linear.positions import Numbers, positions_on, reshape_like


class Modes(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Elastic modes of one model, ascending; mode n stands at index n - 1.

    Shapes are normalised to unit modal mass (integral of rho A phi^2 dx = 1 kg m^2 / m^2, for a discrete
    model with its own mass matrix) and positive where the beam first moves off its left end.
    """

    model: str
    """Its name."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    length: float
    """L, metres."""
    frequencies_hz: Array
    """(n_modes,), ascending."""
    shapes: Callable[[Array, int], Array]
    """(x, derivative) -> (n_modes, len(x)); x in metres."""
    nodes: Array
    """(n_nodes,), metres: joints or element ends, both ends of the beam included; empty for the exact beam."""
    readings: dict[str, Callable[[], Array]] = msgspec.field(default_factory=dict)
    """Ways to read the deflection at `nodes`, by name, the default first: () -> (n_modes, n_nodes)."""
    points: Array
    """(n_points,), metres, evenly spaced: where this model knows its shape with nothing added."""
    sampled: Callable[[], Array]
    """() -> deflection at `points`, (n_modes, n_points)."""
    curvature_points: Array
    """(n_curvatures,), metres: where this model knows its curvature best."""
    curvatures: Callable[[], Array]
    """() -> curvature at `curvature_points`, (n_modes, n_curvatures), in 1/(m^2 sqrt(kg)); on a step right of it."""
    method: str = "closed form"
    """How the eigenvalues were found."""

    @classmethod
    def of_shapes(
        cls,
        model: str,
        count: int | None,
        frequencies_hz: Array,
        nodes: Array,
        shapes: Callable[[Array, int], Array],
        method: str = "closed form",
    ) -> "Modes":
        """Modes of a model that knows its shapes anywhere, with as many derivatives: (x, derivative) -> (n, len(x)).

        `nodes` (n_nodes,) are the ends of its parts, both ends of the beam included, evenly spaced.
        """
        return cls(
            model=model,
            count=count,
            length=float(nodes[-1]),
            frequencies_hz=frequencies_hz,
            shapes=shapes,
            nodes=nodes,
            readings={"shapes": lambda: shapes(nodes, 0)},
            points=nodes,
            sampled=lambda: shapes(nodes, 0),
            curvature_points=nodes,
            curvatures=lambda: shapes(nodes, 2),
            method=method,
        )

    @property
    def n_modes(self) -> int:
        """How many modes are here."""
        return len(self.frequencies_hz)

    def deflection(self, x: Numbers) -> Array:
        """Mass-normalised deflection at x (metres), (n_modes, *shape of x), in 1/sqrt(kg); a number is a row of one.

        Raises InputError.
        """
        return reshape_like(self.shapes(self._on_beam(x), 0), x)

    def slope(self, x: Numbers) -> Array:
        """d/dx of `deflection`, of the same shape, in 1/(m sqrt(kg)). Raises InputError."""
        return reshape_like(self.shapes(self._on_beam(x), 1), x)

    def _on_beam(self, x: Numbers) -> Array:
        """The positions in a row. Raises InputError where one lies off the beam."""
        return positions_on("x", x, self.length).ravel()
