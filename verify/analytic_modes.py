"""The exact model of a beam, the paper's reference for its chain of segments (Section II.A).

The deflection w and the rotation psi of the sections satisfy

    (kappa G A (w' - psi))' + T w'' - k_f w = rho A d2w/dt2,    (EI psi')' + kappa G A (w' - psi) = rho I d2psi/dt2,

which is Timoshenko theory; w' = psi is Rayleigh theory, w' = psi and rho I = 0 Euler-Bernoulli theory: between pinned
ends EI w'''' = rho A omega^2 w has the frequencies (n pi / L)^2 sqrt(EI / rho A) / 2 pi; mode 22 of the paper's beam is
at 4470 Hz (printed: 4467 Hz). In general frequencies are roots of a characteristic equation, with a count of the roots
below a trial value (`exact.characteristic`); shapes and harmonic fields come from multiple shooting (`exact.transfer`).
Sections, point masses with rotary inertia, springs, axial force T and foundation k_f are exact. The loss factor acts on
EI and kappa G A; springs, foundation and axial force have no losses.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise
from math import pi
from typing import Any, ClassVar

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, ResonanceError
from verify.exact import closed_forms
from verify.exact.characteristic import buckling_load, check_stable, count_at, wavenumber_length
from verify.exact.layout import BeamLayout, Station, layout_of, with_stations
from verify.exact.transfer import ROTATION, Motion, divide, modal_motion, solve
from verify.linear.base import BeamModel, Devices
from verify.linear.field import HarmonicField, acting_on, phasor, point_force
from verify.linear.modes import Modes
from verify.linear.positions import Forces, Loads, Numbers, frequencies_on, positions_on, reshape_like, vector_on
from verify.linear.system import RESONANCE
from verify.linear.time_basis import TimeBasis, check_supported
from verify.problem.beam import Beam, PointForce, PointLoad, PointMoment, check_features
from verify.problem.device import Device
from verify.problem.supports import FIXED
from verify.settings import DEFAULT
from verify.validation import check_integer

EXACT_MODES = 400  # default number of modes of a time basis; higher modes respond quasi-statically
MOST_MODES = 100_000
_TAYLOR_DEGREE = 8
"""Degree of the shapes' polynomials in time integration: error 1e-9 for the highest mode, less for lower modes."""
_TOGETHER, _SWEPT_TOGETHER = 32, 128  # number of modes, or frequencies of a sweep, in one multiple-shooting solution
_SAME_PLACE = 1e-9
"""Distance, relative to the beam's length, below which two imposed displacements have the same position."""
_NEAR = 1e-4  # relative distance to an undamped resonance within which field and modal part differ by rounding alone
_LOSSES = 0.06 * np.arange(1.0, 7.0)
"""Relative loss factors from which a tail is extrapolated to zero loss: error 1e-9, the product of their squares."""


@dataclass(frozen=True)
class ExactModel(BeamModel):
    """The exact beam by the theory "euler-bernoulli", "rayleigh" or "timoshenko".

    Raises InputError for missing section properties, and for an axial force in Rayleigh or Timoshenko theory.
    """

    name: ClassVar[str] = "analytic"
    parts: ClassVar[str] = "exact beam"
    title: ClassVar[str] = "exact beam"
    colour: ClassVar[str] = "#8a8f98"
    sized: ClassVar[bool] = False

    beam: Beam
    theory: str = DEFAULT.theory

    @property
    def n_elastic(self) -> int:
        """Largest number of modes of one call; the beam has infinitely many."""
        return MOST_MODES

    @cached_property
    def layout(self) -> BeamLayout:
        """Spans and stations. Raises InputError for a compression beyond buckling."""
        return self._stationed()

    # --- Modes ---

    def frequency_hz(self, mode: int) -> float:
        """Frequency of one elastic mode, Hz, to rounding. Raises InputError.

        Modes are numbered by frequency; above sqrt(kappa G A / rho I) a Timoshenko beam has a second family of modes.
        """
        closed_forms.check_mode(mode)
        return float(self._hertz(wavenumber_length(self.layout, mode + self.beam.rigid_motions)))

    def _hertz(self, beta: Any) -> Any:
        """Frequency at beta L."""
        return beta**2 * self.beam.wave_constant / (2.0 * pi * self.beam.length**2)

    def _omega2(self, frequency_hz: Any) -> Any:
        """Dimensionless omega^2, over EI / (rho A L^4)."""
        return (2.0 * pi * frequency_hz * self.beam.length**2 / self.beam.wave_constant) ** 2

    def modes(self, n_modes: int) -> Modes:
        """The first elastic modes; shapes have derivatives of any order. Raises InputError."""
        check_integer("n_modes", n_modes, 1, MOST_MODES)
        layout, rigid = self.layout, self.beam.rigid_motions
        betas = np.array([wavenumber_length(layout, mode + rigid) for mode in range(1, n_modes + 1)])
        together = n_modes if layout.plain else _TOGETHER
        blocks = [range(first, min(first + together, n_modes + 1)) for first in range(1, n_modes + 1, together)]
        return Modes(
            model=self.name,
            count=None,
            length=self.beam.length,
            frequencies_hz=self._hertz(betas),
            shapes=lambda x, derivative: np.concatenate([self._shapes(some, x, derivative) for some in blocks]),
            method="closed form" if layout.plain else "counted",
        )

    def mode_shape(self, mode: int, x: Numbers, derivative: int = 0) -> Array:
        """Mass-normalised shape of one elastic mode, or a derivative of any order, at x (m), (*shape of x), SI.

        Positive next to the left end, right-continuous at jumps; the modal mass includes attached masses and rotary
        inertia. In Timoshenko theory the deflection. Raises InputError.
        """
        closed_forms.check_mode(mode)
        check_integer("derivative", derivative, 0)
        at = positions_on("x", x, self.beam.length).ravel()
        return reshape_like(self._shapes(range(mode, mode + 1), at, derivative)[0], x)

    def _shapes(self, modes: range, x: Array, derivative: int) -> Array:
        scale = (self.beam.mass_per_length * self.beam.length) ** -0.5 / self.beam.length**derivative
        return np.asarray(scale * _unit_shapes(self, modes)(np.minimum(x / self.beam.length, 1.0), derivative))

    # --- Harmonic fields ---

    def harmonic(
        self, forces: Loads, frequency_hz: Numbers, *, devices: Devices = (), modal_damping: float = 0.0
    ) -> HarmonicField:
        """The exact steady field under harmonic point forces and moments; see `BeamModel.harmonic`.

        Raises InputError, also for a modal damping, and ResonanceError.
        """
        if modal_damping:
            raise InputError(
                f"modal_damping = {modal_damping!r} is for discrete models: give the beam loss_factor = "
                f"{2.0 * modal_damping!r} instead"
            )
        return self._field(*self.check_stationed(forces, devices, frequency_hz), (), frequency_hz)

    def imposed(self, displacements: Forces, frequency_hz: float, *, devices: Devices = ()) -> HarmonicField:
        """The exact steady field under imposed harmonic displacements, amplitudes in m; see `BeamModel.imposed`."""
        drives, stationed = self.check_stationed(displacements, devices, frequency_hz, PointForce)
        length = self.beam.length
        places = sorted(drive.position for drive in drives)
        fixed = [at for at, end in zip((0.0, length), self.beam.supports, strict=True) if FIXED[end].deflection]
        gaps = [b - a for a, b in pairwise(places)] + [abs(at - end) for at in places for end in fixed]
        if any(gap <= _SAME_PLACE * length for gap in gaps):
            raise InputError(
                "drive.force.position: two displacements are imposed at one position, or one at a support without "
                "deflection, move one or leave it out"
            )
        return self._field((), stationed, drives, frequency_hz)

    def _field(
        self,
        forces: tuple[PointLoad, ...],
        devices: tuple[Device, ...],
        drives: tuple[PointForce, ...],
        frequency_hz: Numbers,
    ) -> HarmonicField:
        """The field under loads (N, N m) and imposed displacements (`drives`, m), with devices."""
        beam, frequencies, single = self.beam, frequencies_on(self.beam, frequency_hz), np.ndim(frequency_hz) == 0
        forces = (*forces, *(device.own_force for device in devices if device.amplitude))
        layout = self._stationed(tuple(force.position for force in (*forces, *drives)), devices)
        self._check_resonance(frequencies, drives, devices)
        imposed = [(layout.station_at(drive.position / beam.length), phasor(drive)) for drive in drives]
        loads = [(force.position, np.array([phasor(force)]), isinstance(force, PointMoment)) for force in forces]
        blocks = np.split(frequencies, range(_SWEPT_TOGETHER, len(frequencies), _SWEPT_TOGETHER))
        solved = [self._solve(layout, block, loads, imposed) for block in blocks]

        def read(x: Array, derivative: int, of: int = 0) -> ComplexArray:
            xi, scale = np.minimum(x / beam.length, 1.0), beam.length ** (derivative + of)
            values = np.concatenate([motion.read(xi, derivative, of)[:, 0] for motion, _ in solved]) / scale
            return np.asarray(values[0] if single else values, dtype=complex)

        omega = 2.0 * pi * float(frequencies[0])
        constraint_forces = [
            point_force(drive.position, complex(force))
            for drive, force in zip(drives, solved[0][1][0, :, 0], strict=True)
        ]
        across = [device for device in devices if device.dynamic_stiffness(omega) != 0.0]
        at = read(np.array([device.position for device in across]), 0) if across else ()
        reactions = [
            point_force(device.position, -device.dynamic_stiffness(omega) * complex(w))
            for device, w in zip(across, at, strict=True)
        ]
        return HarmonicField(
            model=self.name,
            count=None,
            beam=beam,
            frequency_hz=float(frequencies[0]) if single else frequencies,
            shapes=read,
            theory=self.theory,
            rotation_shapes=(lambda x, d: read(x, d, ROTATION)) if self.theory == "timoshenko" else None,
            **acting_on((*constraint_forces, *forces, *reactions), devices),
        )

    def receptance(self, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> ComplexArray:
        """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)), m/N.

        NaN at the frequencies of undamped resonances. Raises InputError.
        """
        at, frequencies = vector_on("positions", positions, self.beam.length), frequencies_on(self.beam, frequencies_hz)
        xi = vector_on("x", x, self.beam.length) / self.beam.length
        layout = self._stationed(tuple(at.tolist()))
        steady = np.flatnonzero(np.array(self._resonances(self.layout, frequencies)) == 0)
        loads = [(place, unit, False) for place, unit in zip(at.tolist(), np.eye(len(at)), strict=True)]
        responses = np.full((len(frequencies), len(at), len(xi)), np.nan, dtype=complex)
        for block in np.split(steady, range(_SWEPT_TOGETHER, len(steady), _SWEPT_TOGETHER)) if len(steady) else ():
            responses[block] = self._solve(layout, frequencies[block], loads)[0].read(xi, 0)
        return responses

    def _stationed(self, positions: tuple[float, ...] = (), devices: Sequence[Device] = ()) -> BeamLayout:
        """The layout with additional stations at positions (m) and devices."""
        check_stable(self.beam)
        return layout_of(self.beam, self.theory, positions, tuple(devices))

    def _solve(
        self,
        layout: BeamLayout,
        frequencies: Array,
        loads: Sequence[tuple[float, Array, bool]],
        imposed: Sequence[tuple[int, complex]] = (),
    ) -> tuple[Motion, ComplexArray]:
        """(motions in m under loads, forces in N at imposed displacements, (n_f, n_imposed, k)).

        A load is (position, (k,) N or N m, whether it is a moment).
        """
        division = divide(layout, self._omega2(frequencies), self.beam.loss_factor)
        unit, n_loads = self.beam.bending_stiffness / self.beam.length**3, len(loads[0][1]) if loads else 1
        dtype = complex if any(np.iscomplexobj(values) for _, values, _ in loads) else float
        jumps = np.zeros((len(division.over), 4, n_loads), dtype=dtype)
        for position, values, moment in loads:
            ends = division.station_ends[:, layout.station_at(position / self.beam.length)]
            if moment:  # M jumps by the couple on the beam with the opposite sign
                jumps[ends, 2] -= values / (unit * self.beam.length) / division.sizes[:, 2:3]
            else:
                jumps[ends, 3] += values / unit / division.sizes[:, 3:]
        try:
            states, forces = solve(division, jumps, imposed)
        except np.linalg.LinAlgError:
            raise InputError(
                f"frequency_hz = {float(frequencies[0])!r}: the rigid-body motion of an unsupported beam overflows, "
                "give a higher frequency_hz or other supports"
            ) from None
        return Motion(division, states), forces * unit

    def _resonances(self, layout: BeamLayout, frequencies: Array) -> list[int]:
        """Number of the undamped resonance at each frequency, rigid-body motions included; 0 off resonance."""
        if self.beam.loss_factor:
            return [0] * len(frequencies)
        low, high = self._omega2(frequencies * (1.0 - RESONANCE)), self._omega2(frequencies * (1.0 + RESONANCE))
        counts = [[count_at(layout, omega2).below for omega2 in side.tolist()] for side in (low, high)]
        return [up_to if up_to > below else 0 for below, up_to in zip(*counts, strict=True)]

    def _check_resonance(self, frequencies: Array, drives: Sequence[PointForce], devices: Sequence[Device]) -> None:
        """Raise ResonanceError at an undamped resonance of the beam with devices and imposed displacements."""
        length = self.beam.length
        layout = self._stationed(tuple(drive.position for drive in drives), devices)
        layout = with_stations(layout, [(drive.position / length, Station(support="pinned")) for drive in drives])
        numbers = self._resonances(layout, frequencies)
        if any(numbers) and (damped := [device for device in devices if device.dashpot or device.rotational_dashpot]):
            # a motion is undamped where it is also a motion of the beam with its dashpots locked
            support = {(True, False): "pinned", (False, True): "guided", (True, True): "clamped"}
            locked = [Station(support=support[d.dashpot > 0.0, d.rotational_dashpot > 0.0]) for d in damped]
            fixed = with_stations(layout, [(d.position / length, at) for d, at in zip(damped, locked, strict=True)])
            numbers = [n if m else 0 for n, m in zip(numbers, self._resonances(fixed, frequencies), strict=True)]
        for frequency, number in zip(frequencies.tolist(), numbers, strict=True):
            if number and (mode := number if devices or drives else number - self.beam.rigid_motions):
                where = " with its devices or imposed displacements" if devices or drives else ""
                resonance = float(self._hertz(wavenumber_length(layout, number)))
                raise ResonanceError(
                    f"frequency_hz = {frequency!r} lies {abs(frequency / resonance - 1.0):.1e} (relative) from the "
                    f"undamped resonance of mode {mode} of the {self.name} model{where} at {resonance!r} Hz: give the "
                    "beam a loss_factor or choose another frequency"
                )

    # --- Buckling, waves, motion in time ---

    def buckling_load(self) -> float:
        """Lowest buckling load in compression, N (Euler). Raises InputError."""
        return buckling_load(self.beam)

    def time_basis(self, *, modes: int | None = None, line: str = "spline") -> TimeBasis:
        """The first `modes` modes (default: 400) and the quasi-static response of the higher modes.

        For Euler-Bernoulli beams with steps and point masses, whose damping ratio is the same in every mode; the
        lossless stiffness of springs, foundation and axial force would make it differ. Raises InputError, also for
        rigid-body motions.
        """
        beam, n_modes = self.beam, EXACT_MODES if modes is None else modes
        check_in_time(beam)
        if self.theory != "euler-bernoulli":
            raise InputError(f"theory = {self.theory!r}: the exact beam in time takes euler-bernoulli alone, choose it")
        check_integer("modes", n_modes, 1, MOST_MODES)
        modes_of_beam = self.modes(n_modes)
        omegas = 2.0 * pi * modes_of_beam.frequencies_hz
        spans, inner = np.array(self.layout.spans), np.array(self.layout.positions[1:-1]) * beam.length
        ratios = spans[:, 2] / spans[:, 1]  # rho A / EI over that of the beam's own section
        read = lru_cache(maxsize=16)(lambda x, derivative: modes_of_beam.shapes(np.frombuffer(x), derivative))

        def fourth(omega: Any, x: Array) -> Array:
            """beta^4 at x, the ratio of the fourth derivative to the deflection."""
            return np.asarray(omega**2 / beam.wave_constant**2 * ratios[np.searchsorted(inner, x, side="right")])

        def shapes(x: Array, derivative: int) -> Array:
            rounds, order = divmod(derivative, 4)
            return np.asarray(read(x.tobytes(), order) * fourth(omegas[:, None], x) ** rounds)

        def without_modes(forces: Sequence[PointLoad], frequency_hz: float, loss: float) -> Callable[..., Any]:
            field = ExactModel(replace(beam, loss_factor=loss)).harmonic(forces, frequency_hz)
            at = ((force, np.array([force.position]), int(isinstance(force, PointMoment))) for force in forces)
            loads = sum(phasor(force) * shapes(x, order)[:, 0] for force, x, order in at)
            part = loads / (omegas**2 * (1.0 + 1j * loss) - field.omega**2)
            return lambda x, derivative: field.shapes(x, derivative) - part @ shapes(x, derivative)

        def tail(forces: Sequence[PointLoad], frequency_hz: float, damping: Any) -> Callable[[Array, int], Any]:
            if damping or abs(2.0 * pi * frequency_hz / omegas - 1.0).min() > _NEAR:
                return without_modes(forces, frequency_hz, 2.0 * float(damping))
            ratio = frequency_hz / self.frequency_hz(n_modes + 1)
            return _lossless(lambda forces, loss: without_modes(forces, frequency_hz, loss), forces, ratio)

        # cells of at most 0.4 over the wavenumber of the highest mode
        stops = np.array(self.layout.positions) * beam.length
        stops[-1] = beam.length
        cells = np.ceil(np.diff(stops) * (omegas[-1] / beam.wave_constant * np.sqrt(ratios)) ** 0.5 / 0.4).astype(int)
        pieces = [np.linspace(a, b, n + 2)[1:] for (a, b), n in zip(pairwise(stops), cells, strict=True)]
        return TimeBasis(
            model=self.name,
            count=None,
            beam=beam,
            omegas=omegas,
            shapes=shapes,
            loads=lambda position: shapes(np.array([position]), 0)[:, 0],
            turning_loads=lambda position: shapes(np.array([position]), 1)[:, 0],
            edges=np.concatenate([np.zeros(1), *pieces]),
            degree=_TAYLOR_DEGREE,
            method=f"the first {n_modes} exact modes, higher modes quasi-static",
            tail=tail,
        )


def _lossless(
    field: Callable[[Sequence[PointLoad], float], Callable[..., Any]], forces: Sequence[PointLoad], ratio: float
) -> Callable[[Array, int], Any]:
    """The exact field less the part of the modes, (forces, loss factor) -> field, for loss factor 0 near a resonance.

    This difference is finite at an undamped resonance of a mode, where the field does not exist. Its mean over the loss
    factors +eta and -eta is a series in eta^2, extrapolated to eta = 0 from `_LOSSES`, which are within the radius of
    convergence: the distance to the resonance of the first truncated mode, of which the drive has the `ratio`.
    """
    losses = _LOSSES * (1.0 - ratio**2)
    squares = losses**2
    weights = (squares / (squares - squares[:, None] + np.diag(squares))).prod(axis=1)  # Lagrange's, at zero
    mirrored = [replace(force, phase_deg=-force.phase_deg) for force in forces]
    pairs = [[field(some, loss) for some in (forces, mirrored)] for loss in losses.tolist()]
    return lambda x, derivative: sum(
        0.5 * weight * (part(x, derivative) + mirror(x, derivative).conj())
        for weight, (part, mirror) in zip(weights, pairs, strict=True)
    )


def check_in_time(beam: Beam, remedy: str = "give model = 'fem' or 'segment'") -> None:
    """Raise InputError for a beam without an exact time basis; `remedy` ends the message."""
    check_features(beam, "the exact beam in time", ("section", "bodies"), remedy)
    check_supported(beam)


@lru_cache(maxsize=256)  # a basis of 400 modes has some twenty blocks
def _unit_shapes(model: ExactModel, modes: range) -> Callable[[Array, int], Array]:
    """Shapes of consecutive modes: (x / L, derivative) -> (n, n_x), of modal mass 1 over rho A L."""
    numbers, rigid = range(modes[0] - 1, modes[-1] + 2), model.beam.rigid_motions
    betas = np.array([wavenumber_length(model.layout, mode + rigid) if mode else 0.0 for mode in numbers])
    if model.layout.plain:
        return closed_forms.unit_shapes(model.layout.supports, betas[1:-1])
    motion = modal_motion(model.layout, betas, np.array(modes))
    return lambda xi, derivative: np.asarray(motion.read(xi, derivative)[:, 0])
