"""The modal basis of a beam's motion in time: free modes, their shapes, and their loads by point forces."""

from collections.abc import Callable, Sequence
from functools import cache
from math import comb, factorial
from typing import TypeAlias

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.formatting import one_line
from verify.linear.positions import Numbers, positions_on, reshape_like
from verify.problem.beam import Beam, PointLoad, PointMoment

Ratio: TypeAlias = float | Array  # Damping ratio of all modes, or of each mode, (n,)


class TimeBasis(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The free modes of one model, of unit modal mass (SI)."""

    model: str  # Name of the model
    count: int | None  # Segments or elements; None for the exact beam, whose modes are truncated
    beam: Beam
    omegas: Array  # (n,), rad/s, undamped
    shapes: Callable[[Array, int], Array]
    """(x, derivative) -> (n, len(x)), in 1/sqrt(kg) per metre^derivative; right-continuous at jumps. Signs as in
    `Modes`: positive next to the left end."""
    loads: Callable[[float], Array]
    """Position in metres -> (n,), the load of every mode under a unit transverse force there."""
    turning_loads: Callable[[float], Array]
    """Position in metres -> (n,), the load of every mode under a unit moment there."""
    edges: Array  # (pieces + 1,), m: ends of the pieces, on which shapes are polynomials of `degree`
    degree: int  # Degree of the polynomials of the shapes
    method: str  # Origin of the modes, for a summary
    tail: Callable[[Sequence[PointLoad], float, Ratio], Callable[[Array, int], ComplexArray]] | None = None
    """Steady response of the truncated modes: (forces, frequency_hz, damping) -> (x, derivative) -> (len(x),) complex.

    None where no mode is truncated.
    """
    ratios: Array | None = None
    """(n,), damping ratio of each mode: half the beam's loss factor times the lossy fraction of the modal stiffness.
    None where all stiffness is lossy: half the loss factor for every mode."""
    turns: Callable[[], Array] | None = None
    """() -> (n, attachments): rotation of `beam.attached`; None where it is the slope of the shapes there."""
    __repr__ = one_line(model="", count="", omegas="rad/s", method="")

    def modal_load(self, load: PointLoad) -> Array:
        """Load of every mode under a force or moment of unit amplitude, (n,)."""
        return self.turning_loads(load.position) if isinstance(load, PointMoment) else self.loads(load.position)

    def attached_turns(self) -> Array:
        """Rotation of `beam.attached`, (n, attachments), 1/(sqrt(kg) m)."""
        if self.turns is not None:
            return self.turns()
        return np.asarray(self.shapes(np.array([attachment.position for attachment in self.beam.attached]), 1))

    def deflection(self, x: Numbers) -> Array:
        """Shapes at x (m), (n, *shape of x), 1/sqrt(kg). Raises InputError off the beam."""
        return reshape_like(self.shapes(positions_on("x", x, self.beam.length).ravel(), 0), x)


def damping_in(basis: TimeBasis, ratio: float | None) -> Ratio:
    """The damping ratio of all modes or (n,) of each: `ratio`, or by the beam's loss factor if None.

    Raises InputError for an overdamped mode.
    """
    if ratio is not None or basis.ratios is None:
        return 0.5 * basis.beam.loss_factor if ratio is None else ratio
    if basis.ratios.max() >= 1.0:
        worst = int(basis.ratios.argmax())
        raise InputError(
            f"beam.loss_factor = {basis.beam.loss_factor!r} makes mode {worst + 1} overdamped (damping ratio "
            f"{basis.ratios[worst]:.3g}): give a smaller one or modal_damping"
        )
    return basis.ratios


def taylor_table(shapes: Callable[[Array, int], Array], edges: Array, first: int, last: int, degree: int) -> Array:
    """Coefficients in xi = (x - edge) / length of pieces first..last-1, (pieces, degree + 1, rows).

    Expanded about the middle of each piece: an edge that rounds to the wrong side of a node would have the polynomial
    of the neighbour.
    """
    lengths = np.diff(edges[first : last + 1])
    middles = edges[first:last] + 0.5 * lengths
    parts = np.array([shapes(middles, d) * lengths**d / factorial(d) for d in range(degree + 1)])
    return np.ascontiguousarray(np.einsum("kd,drp->pkr", _from_middle(degree), parts))


@cache
def _from_middle(degree: int) -> Array:
    """Coefficients about xi = 0 from those about xi = 1/2, (degree + 1, degree + 1)."""
    powers = range(degree + 1)
    return np.array([[comb(d, k) * (-0.5) ** (d - k) if d >= k else 0.0 for d in powers] for k in powers])


def check_supported(beam: Beam) -> None:
    """Raise InputError for supports with rigid-body motions."""
    if beam.rigid_motions:
        raise InputError(
            f"beam.supports = {list(beam.supports)!r} allow {beam.rigid_motions} rigid-body motion(s), in which the "
            "beam may drift away: clamp an end, pin both, or give beam.spring"
        )
