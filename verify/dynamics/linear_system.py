"""A driven linear beam in time: complex modal rows and rows of the drive in consecutive stages."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.actuators.on_beam import ActuatedBeam, Mounted, on_beam
from verify.arrays import Array, ComplexArray
from verify.dynamics.excitation import CONSTANT, NO_ROWS, Forced, Rows, interleaved
from verify.linear.positions import SLACK
from verify.linear.registry import MODELS
from verify.linear.surface import LEFT_BEAM, ContactRange
from verify.linear.time_basis import TimeBasis, taylor_table
from verify.problem.beam import Beam, PointLoad, PointMoment, is_lossless

NO_READINGS = np.empty((1, 0), dtype=complex)
EXACT_DEGREE = 8
"""Degree of the polynomials for the exact steady field on pieces of 0.3 rad of its waves: error is rounding."""


class Steps(msgspec.Struct, frozen=True):
    """Equal time steps of a stage."""

    n: int
    dt: float
    every: int  # Steps from sample to sample

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.n * self.dt


def cut(duration: float, longest: float, samples: int) -> Steps:
    """Equal steps no longer than `longest`, an integer number from sample to sample."""
    every = max(int(np.ceil(duration / longest / samples * (1.0 - 1e-12))), 1)
    return Steps(every * samples, duration / (every * samples), every)


class Stage(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """An interval with one polynomial envelope of the forces; its time t starts at 0."""

    rows: Rows = NO_ROWS
    forced: Forced | None = None  # None where the drive's rows are a steady field
    shapes: Callable[[Array, int], Any] = lambda x, derivative: np.empty((0, len(x)))
    """(x, derivative) -> psi, (n, len(x)), 1/sqrt(kg) per metre^derivative; n = 0 without free modes."""
    field: Callable[[Array, int, Any], ComplexArray]
    """(x, derivative, psi) -> shapes of the drive, one for each power of t, (degree + 1, len(x)), m."""
    edges: Array  # (pieces + 1,), m: ends of the pieces, on which shapes are polynomials of `degree`
    degree: int
    omega: float
    origin: float = 0.0  # Start time of the stage, s
    unit_s: float = 1.0
    envelope: Array = CONSTANT  # Amplitude of the forces as a polynomial in t / unit_s
    steps: Steps
    complex_rows: int = 0  # Number of rows with complex psi, which are the last ones
    readings: ComplexArray = NO_READINGS  # (powers of t, outputs): shapes of the drive for the outputs `rows.readings`
    ends: tuple[str, str] = (LEFT_BEAM, LEFT_BEAM)  # Messages for a slider beyond the first edge, and beyond the last

    @property
    def duration(self) -> float:
        """Seconds."""
        return self.steps.duration

    @property
    def powers(self) -> int:
        """Number of powers of time in the drive; each has two columns, real and imaginary part."""
        return 1 if self.forced is None else self.forced.forward.shape[1]

    @property
    def sample_times(self) -> Array:
        """Times of the samples, (n,), s from the start of the stage, without the start."""
        return self.steps.every * self.steps.dt * np.arange(1.0, self.steps.n // self.steps.every + 1)

    def columns(self, x: Array, derivative: int = 0) -> Array:
        """All shapes at x, (columns, len(x)): Re psi, Im psi of the complex rows, then the drive.

        The drive has two columns for each power of t, real and imaginary part.
        """
        psi = self.shapes(x, derivative)
        return self._columns(psi, self.field(x, derivative, psi))

    def outputs(self, x: Array) -> Array:
        """Columns of the deflection at x and of the readings, (columns, len(x) + readings)."""
        if not self.readings.size:
            return self.columns(x)
        psi = self.rows.readings.reshape(len(self.rows.rates), self.readings.shape[1])
        return np.hstack([self.columns(x), self._columns(psi, self.readings)])

    def _columns(self, psi: Any, drive: ComplexArray) -> Array:
        imaginary = psi[len(psi) - self.complex_rows :].imag
        return np.concatenate([psi.real, imaginary, interleaved(drive.T).T])

    def factors(self, z: ComplexArray, t: Array) -> Array:
        """Factors of the columns at times t, (len(t), columns), for free rows z (len(t), n).

        Those of the drive are a real part and minus an imaginary part for each power of t.
        """
        column, powers = t[:, None], np.arange(self.powers)
        drive = (column / self.unit_s) ** powers * np.exp(1j * self.omega * (column + self.origin))
        imaginary = z[:, z.shape[1] - self.complex_rows :].imag
        return np.concatenate([z.real, -imaginary, interleaved(drive.conj())], axis=1)

    def table(self, first: int, last: int) -> Array:
        """Polynomial coefficients of pieces first..last-1, (pieces, degree + 1, columns)."""
        return taylor_table(self.columns, self.edges, first, last, self.degree)

    def drive_shapes(self, x: Array, derivative: int) -> ComplexArray:
        """Shapes of the drive, one for each power of t, (degree + 1, len(x)), m per metre^derivative."""
        return self.field(x, derivative, self.shapes(x, derivative))

    def rates_at_start(self, z: ComplexArray) -> Array:
        """Time derivatives of the factors at time 0 for free rows z, (columns,)."""
        rates = self.rows.rates * z
        drive = np.array([1j * self.omega, 1.0 / self.unit_s, *(0.0,) * self.powers])[: self.powers]
        drive *= np.exp(1j * self.omega * self.origin)
        imaginary = rates[len(rates) - self.complex_rows :].imag
        return np.concatenate([rates.real, -imaginary, interleaved(drive[None].conj())[0]])

    def deflection(self, z: ComplexArray, t: Array, x: Array) -> Array:
        """Deflection (m) and readings in closed form, (len(t), outputs): free rows from z at t = 0, and the drive."""
        if not len(x) and not self.readings.size:
            return np.empty((len(t), 0))
        return np.asarray(self.factors(self.rows.after(z, t), t) @ self.outputs(x))

    def free(self, z: ComplexArray) -> ComplexArray:
        """Free part at the start of a motion with total state z, (n,)."""
        return z - self.forced.at(0.0) if self.forced else z

    def whole(self, z: ComplexArray, t: float) -> ComplexArray:
        """Total state at time t with free part z, (n,)."""
        return z + self.forced.at(t) if self.forced else z

    def beyond(self, first: float, last: float) -> str:
        """Message for a slider with points from `first` to `last`, m, of which one is beyond an edge."""
        return self.ends[0 if self.edges[0] - first > last - self.edges[-1] else 1]

    def within(self, contact: ContactRange) -> "Stage":
        """The stage with pieces in a contact range alone."""
        if contact.ends == self.ends:  # the whole beam
            return self
        near = SLACK * float(self.edges[-1])
        inner = self.edges[(self.edges > contact.start + near) & (self.edges < contact.end - near)]
        return replace(self, edges=np.concatenate([[contact.start], inner, [contact.end]]), ends=contact.ends)

    def stepped(self, longest: float, closer: int = 1) -> "Stage":
        """The stage in steps no longer than `longest`, with `closer` times as many samples."""
        return replace(self, steps=cut(self.duration, longest, closer * (self.steps.n // self.steps.every)))


def basis_of(
    beam: Beam, model: str, count: int | None, modes: int | None, line: str = "spline", loads: Sequence[PointLoad] = ()
) -> TimeBasis:
    """The free modes of a model by name, with nodes or elastic ends at moments among the loads. Raises InputError."""
    moments = tuple(load.position for load in loads if isinstance(load, PointMoment))
    return _basis(MODELS.named(model), beam, count, modes, line, moments)


@lru_cache(maxsize=2)  # of the runs of a study of sliders, steps or drives; 2000 modes have 160 MB
def _basis(
    kind: Any, beam: Beam, count: int | None, modes: int | None, line: str, moments: tuple[float, ...]
) -> TimeBasis:
    basis: TimeBasis = kind.build(beam, count).cut_at(moments).time_basis(modes=modes, line=line)
    return basis


@lru_cache(maxsize=8)  # of all windows of a motor at a fixed position
def steady_beam(
    model: str,
    count: int | None,
    beam: Beam,
    forces: tuple[PointLoad, ...],
    hertz: float,
    damping: float | None,
    circuits: tuple[Mounted, ...] = (),
) -> ActuatedBeam:
    """The steady state of a model with damping ratio `damping`; None: the beam's loss factor. Raises InputError."""
    kind, modal_damping = MODELS.named(model), 0.0
    if damping is not None and (damping != 0.5 * beam.loss_factor or is_lossless(beam)):
        # the exact field has no modes: a loss factor of twice the ratio is equivalent
        modal_damping = damping if kind.sized else 0.0
        beam = replace(beam, loss_factor=0.0 if kind.sized else 2.0 * damping)
    built = kind.build(beam, count)
    if circuits:
        return on_beam(built, circuits, hertz, forces=forces, modal_damping=modal_damping)
    return ActuatedBeam(field=built.harmonic(forces, hertz, modal_damping=modal_damping), actuators=())
