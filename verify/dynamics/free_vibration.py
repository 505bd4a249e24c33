"""Free vibration of a beam from an initial shape and velocity, exact in the modes of the model."""

from collections.abc import Callable, Sequence
from math import sqrt
from typing import TypeAlias

import numpy as np
from msgspec import Struct

from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.dynamics.excitation import check_damping, modal_rows
from verify.dynamics.linear_system import basis_of
from verify.dynamics.result import EndState
from verify.errors import InputError, shown
from verify.formatting import one_line
from verify.linear.numerics import extremes
from verify.linear.positions import Numbers, real_array, vector_on
from verify.linear.time_basis import Ratio, TimeBasis, damping_in
from verify.problem.beam import Beam
from verify.validation import check_integer, check_number

Shape: TypeAlias = int | Callable[..., Numbers] | tuple[Sequence[float] | Array, Sequence[float] | Array]
"""A mode number, a function of x (m), or positions and values with linear interpolation."""
GAUSS = 6  # Gauss points per piece of the shapes: squares of cubics are integrated exactly
MOST_SAMPLES = 1_000_000
NEAR = 1e-6
"""Half interval of the difference quotient for the rotation of a body, relative to the length; largest deflection of
an initial shape at a supported end, relative to its maximum."""
CORNERED = 0.05  # Fraction of the elastic energy in the upper half of the modes above which the shape has corners
CORNERS = "energies: the initial shape has corners, so that its elastic energy grows with the number of modes"


class FreeVibration(Struct, frozen=True, eq=False, kw_only=True):
    """A beam that vibrates freely from an initial shape and velocity."""

    model: str
    """Name of the model."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    damping: Ratio
    """Damping ratio zeta of all modes, or (m,) of each mode where part of the stiffness is lossless."""
    times: Array
    """(n,), seconds from the release."""
    points: Array
    """(p,), m: positions of deflection and velocity."""
    deflection: Array
    """(n, p), m."""
    velocity: Array
    """(n, p), m/s."""
    kinetic: Array
    """(n,), J."""
    elastic: Array
    """(n,), J. For shapes with corners it grows with the number of modes (`notes`)."""
    frequencies_hz: Array
    """(m,), undamped natural frequencies of the model, ascending."""
    amplitudes: Array
    """(m,), sqrt(kg) m: modal amplitudes q of the initial shape, w = sum q phi, phi as in `Modes`."""
    truncation: float
    """Truncation error of the initial shape, rms over rms (weighted by mass and rotary inertia); 0 without a shape."""
    end: EndState
    """State from which `simulate` continues (`start`)."""
    notes: tuple[str, ...]
    """Method of the modes; corners of the initial shape."""
    __repr__ = one_line(model="", count="", times="s", deflection="m", frequencies_hz="Hz")


@one_blas_thread()
def free_vibration(
    beam: Beam,
    shape: Shape | None,
    duration: float,
    *,
    amplitude: float | None = None,
    velocity: Shape | None = None,
    model: str = "segment",
    count: int | None = None,
    modes: int | None = None,
    modal_damping: float | None = None,
    at: Numbers = (),
    samples: int = 201,
) -> FreeVibration:
    """A beam released at t = 0 from a shape (m) with a velocity (m/s), without forces.

    The modal amplitudes of the shape are phi^T M w, a least-squares fit weighted by mass and rotary inertia. Each mode
    is q = Re(z e^{(-zeta + i sqrt(1 - zeta^2)) omega t}), exact at any time (L. Meirovitch, Analytical Methods in
    Vibrations, 1967, ch. 5). Bodies rotate with the slope of the shape, at a corner with the mean of both sides.
    Raises InputError for invalid arguments, and for a beam with rigid-body motions.

    Parameters
    ----------
    beam, duration : Beam, float
        Supported against rigid-body motions; seconds.
    shape, velocity : callable, pair, int or None
        A function of x, a pair (x, values) with linear interpolation from 0 to L, or None for zero. `shape` may be a
        mode number with `amplitude`. Values are zero at pinned and clamped ends.
    amplitude : float, optional
        Largest deflection of the mode of `shape`, m, positive next to the left end.
    model, count, modes, modal_damping : str, int, int, float
        Model, number of segments or elements, number of modes of the exact beam (default: 400), damping ratio of every
        mode (default: by the beam's loss factor).
    at, samples : float or sequence, int
        Positions of deflection and velocity, (p,), m; number of times from 0 to `duration`.
    """
    check_number("duration", duration, "seconds", above=0)
    check_damping(beam, modal_damping)
    check_integer("samples", samples, 2, MOST_SAMPLES)
    points = vector_on("at", at, beam.length)
    basis = basis_of(beam, model, count, modes)
    damping, start = damping_in(basis, modal_damping), _start(basis, shape, amplitude, velocity)
    return _released(basis, damping, *start, np.linspace(0.0, duration, samples), points)


def _released(
    basis: TimeBasis, damping: Ratio, q: Array, rates: Array, truncation: float, times: Array, points: Array
) -> FreeVibration:
    """The vibration from modal amplitudes q and their rates, (m,)."""
    rows = modal_rows(basis, (), damping)
    z0, shapes, parts = rows.of_state(q, rates), basis.shapes(points, 0), []
    for block in np.array_split(times, 1 + times.size * q.size // 10_000_000):  # memory
        z = rows.after(z0, block)
        now, speed = z.real, (rows.rates * z).real
        energies = 0.5 * (speed**2).sum(axis=1), 0.5 * now**2 @ basis.omegas**2
        parts.append((now @ shapes, speed @ shapes, *energies))
    modal = q**2 * basis.omegas**2
    corners = modal[len(q) // 2 :].sum() > CORNERED * modal.sum()
    deflection, velocity, kinetic, elastic = (np.concatenate(part) for part in zip(*parts, strict=True))
    end, model, count = float(times[-1]), basis.model, basis.count
    return FreeVibration(
        model=model,
        count=count,
        damping=damping,
        times=times,
        points=points,
        deflection=deflection,
        velocity=velocity,
        kinetic=kinetic,
        elastic=elastic,
        frequencies_hz=basis.omegas / (2.0 * np.pi),
        amplitudes=q,
        truncation=truncation,
        end=EndState(beam=basis.beam, model=model, count=count, time=end, q=now[-1], rates=speed[-1]),
        notes=(f"modes: {basis.method}", *((CORNERS,) if corners else ())),
    )


def _start(
    basis: TimeBasis, shape: Shape | None, amplitude: float | None, velocity: Shape | None
) -> tuple[Array, Array, float]:
    """(q, dq/dt, truncation error of the shape) at the start, q and dq/dt (m,). Raises InputError."""
    if shape is None and velocity is None:
        raise InputError("shape and velocity are None: give at least one of them")
    rest = np.zeros(len(basis.omegas)), 0.0
    rates = rest[0] if velocity is None else _projected(basis, "velocity", velocity)[0]
    if not isinstance(shape, int) or isinstance(shape, bool):
        if amplitude is not None:
            raise InputError(f"amplitude = {amplitude!r} belongs to a mode: give a mode number as shape, or drop it")
        q, truncation = rest if shape is None else _projected(basis, "shape", shape)
        return q, rates, truncation
    check_integer("shape", shape, 1, len(basis.omegas))
    if amplitude is None:
        raise InputError(f"amplitude is missing: give the largest deflection of mode {shape} in metres")
    length, own = basis.beam.length, slice(shape - 1, shape)
    check_number("amplitude", amplitude, "metres", at_least=-1e100 * length, at_most=1e100 * length)
    x = np.linspace(0.0, length, 20 * shape + 41)
    least, largest = extremes(lambda x: np.asarray(basis.shapes(x, 0)[own][0]), x)
    size, values = max(largest, -least), basis.shapes(x, 0)[own][0]
    q = np.zeros(len(basis.omegas))
    q[own] = amplitude * np.sign(values[np.argmax(abs(values) > 1e-3 * size)]) / size
    return q, rates, 0.0


def _projected(basis: TimeBasis, name: str, shape: Shape) -> tuple[Array, float]:
    """(modal amplitudes of a shape, (m,), truncation error, rms over rms). Raises InputError."""
    beam = basis.beam
    function, breaks = _function(name, shape, beam.length)
    if name == "shape":
        ends = np.array([0.0, beam.length])
        largest = abs(function(np.linspace(0.0, beam.length, 33))).max()
        for support, place, value in zip(beam.supports, ends.tolist(), function(ends).tolist(), strict=True):
            if support in ("pinned", "clamped") and abs(value) > NEAR * largest:
                raise InputError(f"shape = {value!r} m at x = {place!r} m, where the beam is {support}: give 0")
    # Gauss points between the edges of the pieces, the steps of the beam and the corners of the initial shape
    steps = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    pieces = basis.edges if basis.count is not None else np.append(basis.edges[:-1:3], beam.length)
    edges = np.union1d(np.union1d(pieces, steps), breaks)
    edges = edges[np.append(True, np.diff(edges) > 1e-12 * beam.length)]
    abscissae, weights = np.polynomial.legendre.leggauss(GAUSS)
    half = 0.5 * np.diff(edges)[:, None]
    x = (edges[:-1, None] + half * (1.0 + abscissae)).ravel()
    masses = np.array([piece.mass_per_length for piece in beam.pieces])
    weight = (half * weights).ravel() * masses[np.clip(np.searchsorted(steps, x, side="right") - 1, 0, len(masses) - 1)]
    shapes, values = basis.shapes(x, 0), function(x)
    if beam.attached:
        places, masses, inertias = np.array([(a.position, a.mass, a.rotary_inertia) for a in beam.attached]).T
        # difference quotient across the body: at a corner the mean of both sides
        left, right = np.maximum(places - NEAR * beam.length, 0.0), np.minimum(places + NEAR * beam.length, beam.length)
        turns = (function(right) - function(left)) / (right - left)
        shapes = np.hstack([shapes, basis.shapes(places, 0), basis.attached_turns()])
        values = np.concatenate([values, function(places), turns])
        weight = np.concatenate([weight, masses, inertias])
    weighted = shapes * weight
    q = np.linalg.solve(weighted @ shapes.T, weighted @ values)
    size = float(weight @ values**2)
    return q, sqrt(float(weight @ (values - q @ shapes) ** 2) / size) if size > 0.0 else 0.0


def _function(name: str, shape: Shape, length: float) -> tuple[Callable[[Array], Array], Array]:
    """(the shape as a function of positions (n,), positions of its corners, m). Raises InputError."""
    if callable(shape):

        def values(x: Array) -> Array:
            try:
                result: object = shape(x)
            except (TypeError, ValueError):  # a function of one number
                result = [shape(float(one)) for one in x]
            array = real_array(f"{name}(x)", result, "SI")
            if array.shape not in ((), x.shape) or not np.isfinite(array).all():
                raise InputError(f"{name}(x) = {shown(result)} for {len(x)} positions: return as many finite numbers")
            return np.broadcast_to(array, x.shape)

        return values, np.empty(0)
    if not isinstance(shape, list | tuple | np.ndarray) or len(shape) != 2:
        raise InputError(f"{name} = {shown(shape)}: give a function of x, a pair (x, values), or a mode as shape")
    x, y = real_array(f"{name}[0]", shape[0], "metres"), real_array(f"{name}[1]", shape[1], "SI")
    if x.ndim != 1 or x.shape != y.shape or len(x) < 2 or not np.isfinite(y).all():
        raise InputError(f"{name} has x of the shape {x.shape} and values of {y.shape}: give as many finite ones")
    if not (np.diff(x) > 0).all() or max(abs(x[0]), abs(x[-1] - length)) > 1e-9 * length:
        raise InputError(f"{name}[0] = {shown(shape[0])}: give x that ascends from 0 to {length!r} m")
    return lambda at: np.asarray(np.interp(at, x, y)), x
