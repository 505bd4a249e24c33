"""A driven linear beam in time as rows of shapes and time factors: what the compiled loop and the closed form read."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.linear.positions import SLACK
from verify.linear.registry import MODELS
from verify.linear.surface import LEFT_BEAM, ContactRange
from verify.linear.time_basis import Ratio, TimeBasis, taylor_table
from verify.motion.forcing import CONSTANT, Answer, Modal, advanced, answer, free_part, modal, state_of, turns
from verify.problem.beam import Beam, PointForce

if TYPE_CHECKING:
    from verify.linear.field import HarmonicField

Shapes = Callable[[Array, int], Array]
ANALYTIC_DEGREE = 8


class Stage(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A stretch of time in which the forces keep one form; its own time begins at 0."""

    modal: Modal
    forced: Answer | None
    """None where the drive's rows are a steady field."""
    free_shapes: Shapes
    """(n, len(x)); n = 0 where no mode is free."""
    drive_shapes: Shapes
    """(2 (degree + 1), len(x)): real and imaginary part of every power of t."""
    from_modes: Callable[[Array, Array, int], Array] | None
    """The same from the modes' shapes at x, where the drive's rows are made of them."""
    load_rows: Callable[[float], Array]
    """Position of a force -> (rows,), its reading of all rows: what its power is made of, reciprocal to its load."""
    edges: Array
    degree: int
    omega: float
    origin: float
    unit_s: float
    growth: Array
    """Amplitude of the forces as a polynomial in t / unit_s, (degree + 1,)."""
    n_steps: int
    dt: float
    every: int
    """A sample is kept after so many steps."""
    ends: tuple[str, str] = (LEFT_BEAM, LEFT_BEAM)
    """What a slider has done that goes beyond the first edge, and beyond the last."""

    def rows(self, x: Array, derivative: int = 0) -> Array:
        """All shapes at x, (rows, len(x))."""
        free = self.free_shapes(x, derivative)
        return np.concatenate(
            [
                free,
                self.drive_shapes(x, derivative) if self.from_modes is None else self.from_modes(free, x, derivative),
            ]
        )

    def table(self, first: int, last: int) -> Array:
        """Polynomials of pieces first..last-1, (pieces, degree + 1, rows)."""
        return taylor_table(self.rows, self.edges, first, last, self.degree)

    def drive_factors(self, t: Array) -> Array:
        """Time factors of the drive's rows, (len(t), 2 (degree + 1))."""
        turn = np.exp(1j * self.omega * (t + self.origin))
        degree = 0 if self.forced is None else self.forced.amplitudes.shape[1] - 1
        powers = (t[:, None] / self.unit_s) ** np.arange(degree + 1) * turn[:, None]
        return np.stack([powers.real, -powers.imag], axis=2).reshape(len(t), -1)

    def beyond(self, first: float, last: float) -> str:
        """What a slider has done of which the points from `first` to `last`, metres, have gone beyond an edge."""
        return self.ends[0 if self.edges[0] - first > last - self.edges[-1] else 1]

    @property
    def answers(self) -> Array:
        """The forced part of every mode over the drive's time factors, (n, drive rows); zero in a steady field."""
        if self.forced is None:
            return np.zeros((len(self.modal.squares), 2))
        return interleaved(self.forced.amplitudes)

    def deflection(self, z: Array, t: Array, x: Array) -> Array:
        """Closed form, (len(t), len(x)): free modes from z at t = 0 and the drive."""
        factors = np.concatenate([advanced(self.modal, z, t), self.drive_factors(t)], axis=1)
        return np.asarray(factors @ self.rows(x))

    @property
    def sample_times(self) -> Array:
        """When samples are kept, (n,), seconds from the start of the stage, which is not among them."""
        return self.every * self.dt * np.arange(1.0, self.n_steps // self.every + 1)

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.n_steps * self.dt

    def start(self, q: Array, rates: Array) -> Array:
        """The free modes' z where all of the motion begins with (q, rates), (2, n)."""
        forced_q, forced_rates = self.forced.state(0.0) if self.forced else (np.zeros(len(q)), np.zeros(len(q)))
        return free_part(self.modal, q - forced_q, rates - forced_rates)

    def state(self, z: Array, t: float) -> tuple[Array, Array]:
        """All of every mode's motion at time t, where its free part then is z."""
        forced_q, forced_rates = self.forced.state(t) if self.forced else (0.0, 0.0)
        q, rates = state_of(self.modal, z)
        return q + forced_q, rates + forced_rates


def interleaved(amplitudes: ComplexArray) -> Array:
    """Real and imaginary parts in turns, (n, k) complex -> (n, 2 k)."""
    return np.stack([amplitudes.real, amplitudes.imag], axis=2).reshape(len(amplitudes), 2 * amplitudes.shape[1])


def free_at(stage: Stage, z: Array, t: float) -> Array:
    """The free modes after the time t, (2, n)."""
    real, imaginary = turns(stage.modal, t)
    return np.array([z[0] * real - z[1] * imaginary, z[0] * imaginary + z[1] * real])


def basis_of(beam: Beam, model: str, count: int | None, modes: int | None, line: str = "spline") -> TimeBasis:
    """The free modes of a model by name. Raises InputError."""
    return MODELS.named(model).build(beam, count).time_basis(modes=modes, line=line)


def check_line(model: str, start: str, line: str) -> None:
    """Raise InputError where the rigid links' own edges are asked for and cannot be had."""
    if line not in MODELS.named(model).lines:
        raise InputError(
            f"slider.line = 'raw' is the edge of rigid links, which model = {model} has none of: leave it out"
        )
    if line == "raw" and start == "steady":
        raise InputError("slider.line = 'raw' is for a start from rest: its steady state is read through the spline")


class Steps(msgspec.Struct, frozen=True):
    """How a stretch of time is cut."""

    n: int
    dt: float
    every: int
    """Steps from one sample to the next."""


def cut(duration: float, longest: float, samples: int) -> Steps:
    """Equal steps no longer than `longest`, a whole number of them from sample to sample."""
    every = max(int(np.ceil(duration / longest / samples * (1.0 - 1e-12))), 1)
    return Steps(every * samples, duration / (every * samples), every)


class Growth(msgspec.Struct, frozen=True, eq=False):
    """A stretch of time in which the forces' amplitude is one polynomial of (t / duration)."""

    steps: Steps
    coefficients: Array


def stages_from_rest(
    basis: TimeBasis,
    forces: Sequence[PointForce],
    omega: float,
    damping: Ratio,
    pieces: Sequence[Growth],
    origin: float,
) -> list[Stage]:
    """One stage for every piece of the forces' envelope."""
    modes, stages = modal(basis, forces, damping), []
    tail = basis.tail(forces, omega / (2.0 * np.pi), damping) if basis.tail else None
    if tail:  # its third derivative jumps where a force acts
        basis = replace(basis, edges=np.union1d(basis.edges, [f.position for f in forces]))
    for piece in pieces:
        duration = piece.steps.n * piece.steps.dt
        forced = answer(modes, omega, piece.coefficients, duration, origin)
        stages.append(_stage(basis, forced, modes, piece, tail))
        origin += duration
    return stages


def _stage(
    basis: TimeBasis, forced: Answer, modes: Modal, piece: Growth, tail: Callable[[Array, int], ComplexArray] | None
) -> Stage:
    steps, answers = piece.steps, interleaved(forced.amplitudes)
    growth = np.zeros(forced.amplitudes.shape[1])  # of the tail, which follows at once
    growth[: len(piece.coefficients)] = piece.coefficients

    def from_modes(free: Array, x: Array, derivative: int) -> Array:
        parts = answers.T @ free
        return np.asarray(parts + interleaved(np.outer(tail(x, derivative), growth)).T) if tail else parts

    def drive(x: Array, derivative: int) -> Array:
        return from_modes(basis.shapes(x, derivative), x, derivative)

    def load_rows(position: float) -> Array:
        loads = basis.loads(position)
        parts = loads @ forced.amplitudes
        if tail:
            parts = parts + growth * tail(np.array([position]), 0)[0]
        return np.concatenate([loads, np.stack([parts.real, parts.imag], axis=1).ravel()])

    return Stage(
        modal=modes,
        forced=forced,
        free_shapes=basis.shapes,
        drive_shapes=drive,
        from_modes=from_modes,
        load_rows=load_rows,
        edges=to_the_end(basis.edges, basis.beam),
        degree=basis.degree,
        omega=forced.omega,
        origin=forced.origin,
        unit_s=forced.unit_s,
        growth=growth,
        n_steps=steps.n,
        dt=steps.dt,
        every=steps.every,
    )


def on_ground(stage: Stage, ground: ContactRange) -> Stage:
    """The stage for a slider that stays on a stretch of the beam: its pieces end there."""
    if ground.ends == stage.ends:  # all of the beam
        return stage
    near = SLACK * float(stage.edges[-1])
    inner = stage.edges[(stage.edges > ground.start + near) & (stage.edges < ground.end - near)]
    return replace(stage, edges=np.concatenate([[ground.start], inner, [ground.end]]), ends=ground.ends)


def to_the_end(edges: Array, beam: Beam) -> Array:
    """Edges of which the last is the beam's end to the last digit."""
    return np.append(edges[:-1], beam.length)


NO_MODES = Modal(sigmas=np.empty(0), omegas=np.empty(0), squares=np.empty(0), loads=np.empty(0, dtype=complex))


def steady_stage(field: "HarmonicField", steps: Steps, origin: float, basis: TimeBasis | None, damping: Ratio) -> Stage:
    """A beam in its steady state; with a basis its modes are there to be pushed, at rest at first."""
    edges, degree = steady_edges(field)
    if basis:
        edges, degree = np.union1d(edges, basis.edges), max(degree, basis.degree)

    def drive(x: Array, derivative: int) -> Array:
        higher, rest = divmod(derivative, 4) if field.count is None and field.beam.uniform else (0, derivative)
        values = field.shapes(x, rest) * field.wavenumber ** (4 * higher)
        return np.array([values.real, values.imag])

    def nothing(x: Array, derivative: int) -> Array:
        return np.empty((0, len(x)))

    def load_rows(position: float) -> Array:
        own = basis.loads(position) if basis else np.empty(0)
        return np.concatenate([own, drive(np.array([position]), 0)[:, 0]])

    modes = modal(basis, (), damping) if basis else NO_MODES
    return Stage(
        modal=modes,
        forced=None,
        free_shapes=basis.shapes if basis else nothing,
        drive_shapes=drive,
        from_modes=None,
        load_rows=load_rows,
        edges=to_the_end(edges, field.beam),
        degree=degree,
        omega=field.omega,
        origin=origin,
        unit_s=1.0,
        growth=CONSTANT,
        n_steps=steps.n,
        dt=steps.dt,
        every=steps.every,
    )


def steady_edges(field: "HarmonicField") -> tuple[Array, int]:
    """Where the pieces of a field begin, metres, and the degree of its polynomials."""
    length = field.beam.length
    if field.count is None:
        beam = field.beam
        softest = max(p.mass_per_length / p.bending_stiffness for p in beam.pieces) * beam.wave_constant**2
        cells = int(np.ceil(length * abs(field.wavenumber) * softest**0.25 / 0.3)) + 1
        steps = np.cumsum([piece.length for piece in beam.pieces[:-1]])
        fixed = [*(m.position for m in beam.mass), *(s.position for s in beam.spring)]
        places = [*(f.position for f in field.forces), *steps, *fixed]
        return np.union1d(np.linspace(0.0, length, cells + 1), places), ANALYTIC_DEGREE
    from verify.linear.mesh import divide

    parts: Any = divide(field.beam, field.count)
    return np.asarray(parts.nodes * parts.unit), 3
