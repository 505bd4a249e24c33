"""Modes and errors as arrays: MAC, pairing, shape errors, observed order, grid convergence index."""

from collections.abc import Sequence
from itertools import pairwise
from math import inf, log
from typing import TypeVar

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError, NoFigureError
from verify.formatting import one_line
from verify.linear.modes import Modes

T = TypeVar("T", float, complex)
EIGENVALUE_FLOOR = 2e-14
"""Bound of rounding in a relative frequency error (measured: 1.1e-14 up to 10^4 segments or elements)."""
ORDER_FLOOR = 50 * EIGENVALUE_FLOOR  # smallest error for an observed order; below it rounding affects the order
ORDER_SPREAD = 0.5
"""Largest distance of orders from size to size from the theoretical one, or their middle, in the asymptotic range."""
AT_REST = 1e-11
"""Fraction of the typical size below which a shape is zero, such as mode 3 of a pinned beam at the nodes of 3 parts."""
LEAST_MAC = 0.5  # smallest MAC of paired modes
LOW_MAC = 0.8
"""MAC below which supports are different: 0.62 and 0.75 between the first modes of a clamped beam and a cantilever;
mode 6 of a cantilever of 20 links has 0.996 with the exact one."""

SAFETY = 1.25  # factor of safety on the extrapolated error for three sizes (Roache)
VALUE_ROUNDING = 1e-12  # relative difference of values that is rounding
_LOWEST, _HIGHEST = 1e-3, 40.0  # range of observed orders


def relative_error(value: T, exact: T) -> T:
    """(value - exact) / exact, signed or complex. Raises NoFigureError where the exact value is zero or infinite."""
    if not exact or not np.isfinite(exact):
        raise NoFigureError(
            f"the exact value is {'infinite' if exact else 'zero'} and has no relative error: change the drive or the "
            "position"
        )
    return (value - exact) / exact


def mac(reference: Array, shapes: Array) -> Array:
    """Modal assurance criterion of every pair, (n_reference, n_shapes), 0 to 1; shapes are (n, n_points).

    Allemang, "The modal assurance criterion - twenty years of use and abuse", Sound and Vibration 37 (2003).
    """
    cross = reference @ shapes.T
    squares = np.einsum("ij,ij->i", reference, reference)[:, None] * np.einsum("ij,ij->i", shapes, shapes)
    return np.asarray(np.divide(cross**2, squares, out=np.zeros_like(cross), where=squares > 0.0))


def pair_modes(macs: Array) -> tuple[Indices, Array]:
    """Index of the computed mode of every exact mode, and their MAC, (n_reference,) arrays.

    The one-to-one pairing with the largest sum of MAC values; `macs` is (n_reference, n_shapes).
    """
    if (macs.argmax(axis=1) == np.arange(len(macs))).all():
        index = np.arange(len(macs))
    else:
        from scipy.optimize import linear_sum_assignment

        index = np.asarray(linear_sum_assignment(-macs)[1])
    return index, macs[np.arange(len(index)), index]


def paired_index(modes: Modes, exact_shapes: Array, mode: int, stride: int) -> int:
    """The index in `modes` of the mode that pairs with exact mode `mode`.

    exact_shapes (n_modes, n_points) at modes.points[::stride]. Raises InputError below `LEAST_MAC`.
    """
    index, macs = pair_modes(mac(exact_shapes, modes.sampled()[:, ::stride]))
    if macs[mode - 1] < LEAST_MAC:
        raise InputError(
            f"mode = {mode}: no {modes.model} mode at count = {modes.count} has this shape "
            f"(best MAC {macs[mode - 1]:.2f}), raise count"
        )
    return int(index[mode - 1])


def node_weights(nodes: Array) -> Array:
    """Trapezoidal weights of ascending positions, (n_nodes,)."""
    gaps = np.diff(nodes)
    return np.asarray(0.5 * (np.append(gaps, 0.0) + np.append(0.0, gaps)))


def shape_error(exact: Array, computed: Array, weights: Array, typical: float = 0.0) -> float:
    """Relative L2 distance of two mass-normalised shapes up to sign; all (n_nodes,).

    Raises NoFigureError if the exact shape is below `AT_REST` times its `typical` size at every node.
    """
    size = float(weights @ exact**2)
    if size <= (AT_REST * typical) ** 2 * float(weights.sum()):
        raise NoFigureError("count: the exact shape is zero at every node, raise it")
    distances = [float(weights @ (computed * sign - exact) ** 2) for sign in (1.0, -1.0)]
    return float(np.sqrt(min(distances) / size))


class ModeErrors(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Errors of computed against exact modes, paired by MAC; arrays are (n,), n the smaller number of modes."""

    computed: Modes
    exact: Modes
    index: Indices
    """Index of the computed mode of every exact mode."""
    mac: Array
    """MAC of the pairs."""
    __repr__ = one_line(frequency="", mac="")

    @property
    def frequency(self) -> Array:
        """Signed relative errors of the frequencies."""
        exact = self.exact.frequencies_hz[: len(self.index)]
        return np.asarray(self.computed.frequencies_hz[self.index] / exact - 1.0)

    def shape(self, reading: str | None = None) -> Array:
        """Relative L2 errors of the mass-normalised deflection at the nodes by a reading. Raises InputError."""
        return self._errors(self.computed.nodes, 0, self.computed.at_nodes(reading))

    @property
    def curvature(self) -> Array:
        """Relative L2 errors of the curvature at joints or Gauss points."""
        return self._errors(self.computed.curvature_points, 2, self.computed.curvatures())

    def _errors(self, x: Array, derivative: int, computed: Array) -> Array:
        exact, weights = self.exact.shapes(x, derivative), node_weights(x)
        typical = float(abs(exact).max())
        return np.array([shape_error(exact[n], computed[i], weights, typical) for n, i in enumerate(self.index)])


def mode_errors(computed: Modes, exact: Modes) -> ModeErrors:
    """Errors of modes against exact ones of the same beam: `mode_errors(model.modes(22), exact.modes(22))`.

    A pair with a small `mac` has no meaning. Raises InputError for beams of different lengths.
    """
    if computed.length != exact.length:
        raise InputError(f"length = {computed.length!r} m and {exact.length!r} m: give two models of one beam")
    shapes = exact.deflection(computed.points)[: computed.n_modes]
    index, macs = pair_modes(mac(shapes, computed.sampled()))
    return ModeErrors(computed=computed, exact=exact, index=index, mac=macs)


def observed_order(counts: Sequence[float], errors: Sequence[complex], label: str = "") -> float:
    """Minus the least-squares slope of log |error| over log count; `errors` signed or complex.

    `label` names sizes other than counts: 'steps = [...]'. Raises InputError for fewer than three different sizes, an
    error that changes sign (or phase by more than 90 degrees), and one below `ORDER_FLOOR`.
    """
    label = label or f"counts = {list(counts)}"
    sizes, values = np.asarray(counts, dtype=float), np.asarray(errors, dtype=complex)
    least, wrong = abs(values).min(initial=np.inf), ""
    if len(sizes) < 3 or len(set(counts)) != len(sizes):
        wrong = "an observed order needs three or more different sizes"
    elif not np.isfinite(values).all():
        wrong = "an error is not finite, choose another mode or quantity"
    elif least < ORDER_FLOOR:
        wrong = f"an error of {least:.1e} is within rounding ({ORDER_FLOOR:.0e}), use coarser sizes or a higher mode"
    elif (np.outer(values, values.conj()).real < 0.0).any():
        wrong = "the error changes sign between these sizes and has no order, choose others"
    if wrong:
        raise InputError(f"{label}: {wrong}")
    return float(-np.polyfit(np.log(sizes), np.log(abs(values)), 1)[0])


def asymptotic_order(
    counts: Sequence[float], errors: Sequence[complex], expected: int | None = None, label: str = ""
) -> float:
    """`observed_order` in the asymptotic range: orders from size to size within `ORDER_SPREAD` of `expected`.

    Without `expected`, of the middle between them. Raises InputError outside the asymptotic range: sizes are
    too coarse, or the error is about to change sign.
    """
    order = observed_order(counts, errors, label)
    by_size = sorted(zip(counts, np.abs(errors), strict=True))
    orders = [float(np.log(e / f) / np.log(m / n)) for (n, e), (m, f) in pairwise(by_size)]
    middle = 0.5 * (min(orders) + max(orders)) if expected is None else expected
    if min(orders) <= 0.0 or max(orders) - middle > ORDER_SPREAD or middle - min(orders) > ORDER_SPREAD:
        listed = ", ".join(f"{one:.2f}" for one in orders)
        raise InputError(
            f"{label or f'counts = {list(counts)}'}: outside the asymptotic range, orders from size to size are "
            f"{listed}{'' if expected is None else f' and {expected} is expected'}: choose other sizes"
        )
    return order


class GridConvergence(msgspec.Struct, frozen=True, kw_only=True):
    """Estimate of the discretisation error at the finest of three sizes."""

    value: float  # value at the finest size
    order: float | None  # observed order; None where the values do not converge
    extrapolated: float  # Richardson extrapolation to vanishing part length; `value` without an observed order
    index: float  # GCI: half width of the uncertainty band about `value`, relative to it; infinite without an order


def grid_convergence(counts: Sequence[int], values: Sequence[float], expected: int | None = None) -> GridConvergence:
    """Observed order, extrapolated value and grid convergence index of a value at three sizes, without an exact one.

    Richardson extrapolation with Roache's uncertainty (J. Fluids Eng. 116 (1994) 405) by the procedure of Celik et al.
    (J. Fluids Eng. 130 (2008) 078001), with h = L/N.

    `expected` is the theoretical order. It replaces a higher observed order, which is due to errors that are about to
    change sign; this raises the fraction of bands that contain the exact frequency from 0.90 to 0.97 on uniform beams
    without attachments (tests/analysis). With one body on segments it is about 0.8.
    Raises InputError unless there are three different sizes, and for differences within rounding.
    """
    from scipy.optimize import brentq

    if len(set(counts)) != 3:
        raise InputError(f"counts = {list(counts)}: a grid convergence index needs three different sizes")
    (n1, f1), (n2, f2), (n3, f3) = sorted(zip(counts, values, strict=True), reverse=True)  # the finest first
    r21, r32, e21, e32 = n1 / n2, n2 / n3, f2 - f1, f3 - f2
    if min(abs(e21), abs(e32)) <= VALUE_ROUNDING * abs(f1):
        raise InputError(f"counts = {list(counts)}: differences of the values are within rounding, use coarser sizes")
    sign = 1.0 if e32 / e21 > 0.0 else -1.0

    def excess(p: float) -> float:
        """Zero at the root p of e32 / e21 = r21^p (r32^p - s) / (r21^p - s), s the sign of the ratio."""
        return p * log(r21) + log((r32**p - sign) / (r21**p - sign)) - log(abs(e32 / e21))

    if not excess(_LOWEST) < 0.0 < excess(_HIGHEST):
        return GridConvergence(value=f1, order=None, extrapolated=f1, index=inf)
    order = float(brentq(excess, _LOWEST, _HIGHEST))
    used = order if expected is None else min(order, expected)
    correction = -e21 / (r21**used - 1.0)
    return GridConvergence(value=f1, order=order, extrapolated=f1 + correction, index=SAFETY * abs(correction / f1))
