"""Free vibration of a beam from an initial shape and velocity, exact in the modes of its model."""

from collections.abc import Callable, Sequence
from math import sqrt
from typing import TypeAlias

import msgspec
import numpy as np
from msgspec import Struct

from verify.arrays import Array
from verify.errors import InputError, shown
from verify.linear.numerics import extremes
from verify.linear.positions import Numbers, real_array, vector_on
from verify.linear.time_basis import Ratio, TimeBasis, damping_in
from verify.motion.forcing import check_free_phases, free_part, modal, state_of
from verify.motion.result import EndState
from verify.motion.surface import basis_of
from verify.problem.beam import Beam
from verify.validation import check_number, check_whole

Shape: TypeAlias = int | Callable[..., Numbers] | tuple[Sequence[float] | Array, Sequence[float] | Array]
"""A mode's number, a function of x (metres), or places and values with straight lines between them."""
GAUSS = 6
"""Points in each piece of the shapes' polynomials: squares of cubics are summed exactly."""
FINE = 3
"""The exact modes' pieces are so many times finer than Gauss's points need: 0.4 radians of the fastest."""
POINTS = 30_000_000
"""Shapes at places, or modes at times, held at once."""
MOST_SAMPLES = 1_000_000
STEP = 5e-4
"""Of the beam's length: between the five values that a function's slope is read from, at most."""
FORWARD = np.array([-25.0, 48.0, -36.0, 16.0, -3.0]) / 12.0
"""Weights of five values one step apart for the slope at the first: order 4."""
ON = 1e-9
"""Of the beam's length: so near to a place a corner is at it."""
HELD = ("pinned", "clamped")
"""Ends where nothing is deflected."""
ROUNDED = 1e-6
"""Of its largest value: what a shape may have at such an end by rounding."""
ENDS = 33
"""Places at which a shape's size is seen, both ends among them."""
NEAR = 1e-3
"""Of its largest value: what a mode's shape has where it first moves off its left end."""
CORNERED = 0.05
"""Share of the faster half of the modes in the elastic energy above which the shape has corners."""
CORNERS = "energies: the initial shape has corners, its elastic energy grows with the number of modes"


class FreeVibration(Struct, frozen=True, eq=False, kw_only=True):
    """A beam that vibrates freely from an initial shape and velocity."""

    model: str
    """Its name."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    damping: Ratio
    """Ratio zeta of every mode, or (m,), of each where springs, ground or an axial force have no loss."""
    times: Array
    """(n,), seconds from the release."""
    points: Array
    """(p,), metres: places of the deflection."""
    deflection: Array
    """(n, p), metres."""
    velocity: Array
    """(n, p), m/s."""
    kinetic: Array
    """(n,), joules."""
    elastic: Array
    """(n,), joules. Of a shape with corners it grows with the number of modes, as `notes` state."""
    frequencies_hz: Array
    """(m,), of the model's modes, undamped, ascending."""
    amplitudes: Array
    """(m,), sqrt(kg) m: every mode's share q of the initial shape, w = sum q phi, phi as in `Modes`."""
    unread: float
    """What the modes leave of the initial shape, rms over rms (weighted by mass, turns of bodies by their rotary
    inertia); 0 without one."""
    end: EndState
    """State from which `simulate` continues (`continue_from`)."""
    notes: tuple[str, ...]
    """Method of the modes; corners of the initial shape."""


class _Known(msgspec.Struct, frozen=True, eq=False):
    """A model's shapes at the points of a quadrature over its beam, and the turns of bodies with a rotary inertia."""

    length: float
    """Of the beam, metres."""
    x: Array
    """(n,), metres."""
    turning: Array
    """(b,), metres: where such bodies stand."""
    marks: Array
    """Metres, in no order: both ends, and where a beam's shape may bend of a sudden."""
    weights: Array
    """(n + b,): kg of every point, kg m^2 of every such body."""
    shapes: Array
    """(m, n + b)."""


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
    """A beam released at t = 0 from a shape (metres) with a velocity (m/s), without forces.

    The shape's share in each mode is phi^T M w, least squares weighted by mass and rotary inertia; then every mode is
    q = Re(z e^{(-zeta + i sqrt(1 - zeta^2)) omega t}), exact at any time (L. Meirovitch, Analytical Methods in
    Vibrations, 1967, ch. 5). Bodies turn as the shape does where they stand, at a corner by the mean of both sides.

    Parameters
    ----------
    beam : Beam
        Without rigid-body motions.
    shape, velocity : callable, pair, int or None
        Each a function of x, a pair (x, values) with straight lines between the places from 0 to L, or None for zero.
        `shape` may be a mode number with `amplitude`; it is 0 where the beam is held.
    duration : float
        Seconds.
    amplitude : float, optional
        Largest deflection of that mode, metres, positive where it first moves off its left end.
    model, count, modes : str, int, int
        Model, its number of segments or elements, and the modes of the exact beam (400 unless given).
    modal_damping : float, optional
        Damping ratio of every mode; unless given that of the beam's loss factor at each mode.
    at : float or sequence
        Places of deflection and velocity, (p,), metres.
    samples : int
        Number of times from 0 to `duration`.

    Returns
    -------
    FreeVibration
        `simulate` continues it with a slider or forces (`continue_from`).

    Raises
    ------
    InputError
        For bad arguments, and for a beam with rigid-body motions.
    """
    zeta = 0.5 * beam.loss_factor if modal_damping is None else modal_damping
    check_number("duration", duration, "seconds", above=0)
    field = "half of beam.loss_factor" if modal_damping is None else "modal_damping"
    check_number(field, zeta, "ratio of every mode", at_least=0, below=1)
    check_whole("samples", samples, 2)
    if samples > MOST_SAMPLES:
        raise InputError(f"samples = {samples!r}: keep between 2 and {MOST_SAMPLES} of them")
    points = vector_on("at", at, beam.length)
    basis = basis_of(beam, model, count, modes)
    damping = damping_in(basis, modal_damping)
    check_free_phases(basis, damping, duration)
    q, rates, unread = _start(basis, shape, amplitude, velocity)
    return _motion(basis, damping, points, np.linspace(0.0, duration, samples), q, rates, unread)


def _start(
    basis: TimeBasis, shape: Shape | None, amplitude: float | None, velocity: Shape | None
) -> tuple[Array, Array, float]:
    """(q, dq/dt) of every mode at the start, and what they leave of the shape. Raises InputError."""
    if shape is None and velocity is None:
        raise InputError("shape is None and so is velocity: give one of them, or both, else nothing moves")
    if isinstance(velocity, int):
        raise InputError(f"velocity = {velocity!r}: give a function of x or a pair (x, values) in m/s")
    numbered = isinstance(shape, int) and not isinstance(shape, bool)
    if amplitude is not None and not numbered:
        raise InputError(f"amplitude = {amplitude!r} is that of a mode: give shape a mode's number, or leave it out")
    drawn = {"shape": None if numbered else shape, "velocity": velocity}
    breaks = [_breaks(name, given, basis.beam.length) for name, given in drawn.items() if given is not None]
    if drawn["shape"] is not None:
        _check_held(basis.beam, drawn["shape"])
    still = np.zeros(len(basis.omegas)), 0.0
    known = _quadrature(basis, np.concatenate(breaks)) if breaks else None
    found = {name: _shares(known, name, given) if known else still for name, given in drawn.items()}
    q, unread = (_mode(basis, shape, amplitude), 0.0) if isinstance(shape, int) and numbered else found["shape"]
    return q, found["velocity"][0], unread


def _mode(basis: TimeBasis, mode: int, amplitude: float | None) -> Array:
    """One mode alone, its largest deflection `amplitude` metres. Raises InputError."""
    check_whole("shape", mode, 1)
    if mode > len(basis.omegas):
        raise InputError(f"shape = {mode}: the {basis.model} model has {len(basis.omegas)} modes, raise count or modes")
    if amplitude is None:
        raise InputError(f"amplitude is missing: give mode {mode} its largest deflection in metres")
    most = 1e100 * basis.beam.length
    check_number("amplitude", amplitude, "metres", at_least=-most, at_most=most)

    def along(x: Array) -> Array:
        return np.asarray(basis.shapes(x, 0)[mode - 1])

    x = np.linspace(0.0, basis.beam.length, 20 * mode + 41)
    least, largest = extremes(along, x)
    size, values = max(largest, -least), along(x)
    first = values[np.argmax(abs(values) > NEAR * size)]
    q = np.zeros(len(basis.omegas))
    q[mode - 1] = amplitude * np.sign(first) / size
    return q


def _breaks(name: str, given: Shape, length: float) -> Array:
    """Where straight lines meet in what was given, metres; empty for a function. Raises InputError."""
    if callable(given):
        return np.empty(0)
    if not isinstance(given, list | tuple | np.ndarray) or len(given) != 2:
        raise InputError(
            f"{name} = {shown(given)}: give a function of x, a pair (x, values), or a mode's number with its amplitude"
        )
    x, values = real_array(f"{name}[0]", given[0], "metres"), real_array(f"{name}[1]", given[1], "SI")
    if x.ndim != 1 or x.shape != values.shape or len(x) < 2 or not np.isfinite(values).all():
        raise InputError(f"{name} has x of the shape {x.shape} and values of {values.shape}: give as many finite ones")
    if not (np.diff(x) > 0).all() or abs(x[0]) > 1e-9 * length or abs(x[-1] - length) > 1e-9 * length:
        raise InputError(
            f"{name}[0] runs from {float(x[0])!r} to {float(x[-1])!r}: let x ascend from 0 to {length!r} m"
        )
    return x


def _check_held(beam: Beam, shape: Shape) -> None:
    """Raise InputError for a shape that is not 0 at an end where the beam is held."""
    values = _values("shape", shape, np.linspace(0.0, beam.length, ENDS))
    for support, place, value in zip(beam.supports, (0.0, beam.length), values[[0, -1]], strict=True):
        if support in HELD and abs(value) > ROUNDED * abs(values).max():
            raise InputError(
                f"shape = {float(value)!r} m at x = {place!r} m, where the beam is {support}: let it be 0 there, or "
                "give the beam another support"
            )


def _shares(known: "_Known", name: str, given: Shape | None) -> tuple[Array, float]:
    """Every mode's share of a shape, (m,), and what is left of it: the least mean square by mass and inertia."""
    if given is None:
        return np.zeros(len(known.shapes)), 0.0
    values = np.concatenate([_values(name, given, known.x), _slopes(name, given, known)])
    weighed = known.shapes * known.weights
    q = np.linalg.solve(weighed @ known.shapes.T, weighed @ values)
    size = float(known.weights @ values**2)
    left = float(known.weights @ (values - q @ known.shapes) ** 2)
    return np.asarray(q, dtype=float), sqrt(left / size) if size > 0.0 else 0.0


def _values(name: str, given: Shape, x: Array) -> Array:
    """What was given, at x, (n,). Raises InputError where a function does not answer with as many finite numbers."""
    if not callable(given):
        places, values = given  # type: ignore[misc]
        return np.asarray(np.interp(x, places, values))
    answer: object
    try:
        answer = given(x)
    except (TypeError, ValueError):  # it takes one number at a time
        answer = [given(float(one)) for one in x]
    values = real_array(f"{name}(x)", answer, "SI")
    if values.shape not in ((), x.shape) or not np.isfinite(values).all():
        raise InputError(f"{name}(x) answers {shown(answer)} to {len(x)} places: give as many finite numbers")
    return np.broadcast_to(values, x.shape)


def _slopes(name: str, given: Shape, known: "_Known") -> Array:
    """Of what was given where bodies turn with it, (b,): the mean of both sides, as bends and corners lie there."""
    if not len(known.turning):
        return np.empty(0)
    if not callable(given):
        x, values = given  # type: ignore[misc]
        return _of_lines(np.asarray(x, dtype=float), np.asarray(values, dtype=float), known.turning)
    sides = np.array([_one_sided(name, given, known, side) for side in (-1.0, 1.0)])
    return np.asarray(np.nanmean(sides, axis=0))


def _of_lines(x: Array, values: Array, places: Array) -> Array:
    """Slopes of straight lines between x at places, (b,), at a corner the mean of both."""
    lines, near = np.diff(values) / np.diff(x), ON * x[-1]
    sides = [np.searchsorted(x, places + side, side="right") - 1 for side in (-near, near)]
    return np.asarray(np.mean([lines[np.clip(side, 0, len(lines) - 1)] for side in sides], axis=0))


def _one_sided(name: str, given: Shape, known: "_Known", side: float) -> Array:
    """A function's slopes on one side of the bodies, (b,), from five values each; NaN where no beam is left."""
    ahead = side * (known.marks - known.turning[:, None])
    room = np.where(ahead > ON * known.length, ahead, np.inf).min(axis=1)
    steps, there = np.minimum(STEP * known.length, 0.25 * room), np.isfinite(room)
    x = known.turning[there, None] + side * steps[there, None] * np.arange(5.0)
    found = np.full(len(steps), np.nan)
    if there.any():
        found[there] = side * (_values(name, given, x.ravel()).reshape(-1, 5) @ FORWARD) / steps[there]
    return found


def _quadrature(basis: TimeBasis, breaks: Array) -> _Known:
    """Gauss's points between the edges of the shapes, the steps of the beam and `breaks`. Raises InputError."""
    beam = basis.beam
    steps = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    pieces = basis.edges if basis.count is not None else np.append(basis.edges[:-1:FINE], beam.length)
    edges = np.union1d(np.union1d(pieces, steps), breaks)
    edges = edges[np.append(True, np.diff(edges) > 1e-12 * beam.length)]
    if (n := GAUSS * len(edges) * len(basis.omegas)) > POINTS:
        raise InputError(
            f"shape: {len(basis.omegas)} modes are read at {GAUSS * len(edges)} places, {n:.1e} figures and more than "
            f"{POINTS:.0e}: lower count or modes, or give a mode's number"
        )
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    half = 0.5 * np.diff(edges)[:, None]
    x = (edges[:-1, None] + half * (1.0 + points)).ravel()
    masses = np.array([piece.mass_per_length for piece in beam.pieces])
    line = masses[np.clip(np.searchsorted(steps, x, side="right") - 1, 0, len(masses) - 1)]
    places = np.array([mass.position for mass in beam.mass])
    heavy = np.array([mass.mass for mass in beam.mass])
    x = np.concatenate([x, places])
    inertias = np.array([mass.rotary_inertia for mass in beam.mass])
    shapes, turns = basis.shapes(x, 0), inertias > 0.0
    if turns.any():
        shapes = np.hstack([shapes, basis.body_turns()[:, turns]])
    every = np.concatenate([(half * weights).ravel() * line, heavy, inertias[turns]])
    marks = np.concatenate([steps, places, [spring.position for spring in beam.spring]])
    return _Known(beam.length, x, places[turns], marks, every, shapes)


def _motion(
    basis: TimeBasis, damping: Ratio, points: Array, times: Array, q: Array, rates: Array, unread: float
) -> FreeVibration:
    """The motion from (q, dq/dt) at 0, in blocks of times that fit in memory."""
    modes = modal(basis, (), damping)
    z, shapes = free_part(modes, q, rates), basis.shapes(points, 0)
    blocks = np.array_split(times, max(times.size * q.size // POINTS, 1) + 1)
    deflection, velocity, kinetic, elastic = [], [], [], []
    for block in blocks:
        decay, turn = np.exp(-np.outer(block, modes.sigmas)), np.outer(block, modes.omegas)
        c, s = decay * np.cos(turn), decay * np.sin(turn)
        now, speed = state_of(modes, np.array([z[0] * c - z[1] * s, z[0] * s + z[1] * c]))
        deflection.append(now @ shapes)
        velocity.append(speed @ shapes)
        kinetic.append(0.5 * (speed**2).sum(axis=1))
        elastic.append(0.5 * now**2 @ modes.squares)
    energies = q**2 * modes.squares
    corners = energies[len(q) // 2 :].sum() > CORNERED * energies.sum()
    return FreeVibration(
        model=basis.model,
        count=basis.count,
        damping=damping,
        times=times,
        points=points,
        deflection=np.concatenate(deflection),
        velocity=np.concatenate(velocity),
        kinetic=np.concatenate(kinetic),
        elastic=np.concatenate(elastic),
        frequencies_hz=basis.omegas / (2.0 * np.pi),
        amplitudes=q,
        unread=float(unread),
        end=EndState(
            beam=basis.beam,
            model=basis.model,
            count=basis.count,
            time=float(times[-1]),
            q=now[-1],
            rates=speed[-1],
        ),
        notes=(f"modes: {basis.method}", *((CORNERS,) if corners else ())),
    )
