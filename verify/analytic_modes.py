"""The exact beam by three theories: modes, harmonic fields, buckling, motion in time.

Frequencies are the roots of one characteristic equation, which counts those below a trial (`exact.characteristic`);
shapes and fields are multiple-shooting solutions with devices and imposed displacements at their stations
(`exact.transfer`). Steps, point masses with rotary inertia, springs, axial force and foundation are exact. The loss
factor acts on the beam's own bending and shear stiffness; springs, foundation and axial force lose nothing.
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
from verify.linear.base import BeamModel
from verify.linear.field import HarmonicField, phasor, point_force, wavenumber
from verify.linear.modes import Modes
from verify.linear.positions import Forces, Numbers, frequencies_on, positions_on, reshape_like, vector_on
from verify.linear.time_basis import TimeBasis, check_held
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.validation import check_whole

EXACT_MODES = 400
"""Modes of a time basis unless another number is requested; the rest responds without delay."""
MOST_MODES = 100_000
RESONANCE = 1e-9
"""Relative distance to an undamped resonance within which a drive is refused: the response would be rounding."""
_TAYLOR_DEGREE = 8
"""Of the contact line in time: the fastest mode is followed to 1e-9, the others far closer."""
_TOGETHER = 32
"""Modes of one multiple-shooting solution."""
_SWEPT_TOGETHER = 128
"""Frequencies of one such solution."""
_SAME = 1e-9
"""Relative distance at which two frequencies are one, with a plane of shapes."""


@dataclass(frozen=True)
class ExactModel(BeamModel):
    """The exact beam by Euler-Bernoulli's, Rayleigh's or Timoshenko's theory. Raises InputError for what that lacks."""

    name: ClassVar[str] = "analytic"
    parts: ClassVar[str] = "exact beam"
    title: ClassVar[str] = "exact beam"
    colour: ClassVar[str] = "#8a8f98"
    sized: ClassVar[bool] = False
    modal_settings: ClassVar[tuple[str, ...]] = ("theory",)

    beam: Beam
    theory: str = "euler-bernoulli"

    def __post_init__(self) -> None:
        self.check_theory()

    @property
    def n_elastic(self) -> int:
        """Number of elastic modes that can be requested; the beam's own number is infinite."""
        return MOST_MODES

    @cached_property
    def layout(self) -> BeamLayout:
        """Spans and stations. Raises InputError for a compression beyond buckling."""
        return self._stationed()

    # --- Modes ---

    def frequency_hz(self, mode: int) -> float:
        """Frequency of one elastic mode, Hz, to rounding. Raises InputError.

        Modes rank by frequency: above sqrt(kappa G A / rho I) a Timoshenko beam has a second family among them.
        """
        closed_forms.check_mode(mode)
        return (
            wavenumber_length(self.layout, mode + self.beam.rigid_motions) ** 2
            * self.beam.wave_constant
            / (2.0 * pi * self.beam.length**2)
        )

    def _omega2(self, frequency_hz: Any) -> Any:
        """Dimensionless omega^2, over EI / (rho A L^4)."""
        return (2.0 * pi * frequency_hz * self.beam.length**2 / self.beam.wave_constant) ** 2

    def modes(self, n_modes: int) -> Modes:
        """The first elastic modes; shapes have derivatives of any order. Raises InputError."""
        check_whole("n_modes", n_modes, 1, MOST_MODES)
        frequencies = np.array([self.frequency_hz(mode) for mode in range(1, n_modes + 1)])

        blocks = [range(first, min(first + _TOGETHER, n_modes + 1)) for first in range(1, n_modes + 1, _TOGETHER)]
        empty = np.empty(0)
        return Modes(
            model=self.name,
            count=None,
            length=self.beam.length,
            frequencies_hz=frequencies,
            shapes=lambda x, derivative: np.concatenate([self._shapes(some, x, derivative) for some in blocks]),
            nodes=empty,
            points=empty,
            sampled=lambda: np.empty((n_modes, 0)),
            curvature_points=empty,
            curvatures=lambda: np.empty((n_modes, 0)),
            method="closed form" if self.theory == "euler-bernoulli" and self.beam.uniform else "counted",
        )

    def mode_shape(self, mode: int, x: Numbers, derivative: int = 0) -> Array:
        """Mass-normalised shape of one elastic mode, or a derivative of any order, at x (m), (*shape of x), SI.

        Positive where the beam first moves off its left end, from the right where it jumps; attached masses and rotary
        inertia belong to the modal mass. By Timoshenko's theory the deflection. Raises InputError.
        """
        closed_forms.check_mode(mode)
        check_whole("derivative", derivative, 0)
        at = positions_on("x", x, self.beam.length).ravel()
        return reshape_like(self._shapes(range(mode, mode + 1), at, derivative)[0], x)

    def _shapes(self, modes: range, x: Array, derivative: int) -> Array:
        scale = (self.beam.mass_per_length * self.beam.length) ** -0.5 / self.beam.length**derivative
        values = _modal_motion(self, modes).read(np.minimum(x / self.beam.length, 1.0), derivative)
        return np.asarray(values[:, 0] * scale)

    # --- Harmonic fields ---

    def harmonic(
        self,
        forces: Forces,
        frequency_hz: Numbers,
        *,
        devices: Device | Sequence[Device] = (),
        modal_damping: float = 0.0,
    ) -> HarmonicField:
        """The exact steady field under harmonic point forces; see `BeamModel.harmonic`.

        Raises InputError, also for a modal damping, and ResonanceError.
        """
        if modal_damping:
            raise InputError(
                f"modal_damping = {modal_damping!r} is for models of parts: give the exact beam loss_factor = "
                f"{2.0 * modal_damping!r}"
            )
        return self._field(*self.check_stationed(forces, devices), (), frequency_hz)

    def imposed(
        self, displacements: Forces, frequency_hz: float, *, devices: Device | Sequence[Device] = ()
    ) -> HarmonicField:
        """The exact steady field under imposed harmonic displacements, amplitudes in m; see `BeamModel.imposed`."""
        drives, stationed = self.check_stationed(displacements, devices)
        length = self.beam.length
        places = sorted(drive.position for drive in drives)
        held = [at for at, support in zip((0.0, length), self.beam.supports, strict=True) if support[:4] in "pinnclam"]
        close = [b - a <= _SAME * length for a, b in pairwise(places)]
        if any(close) or any(abs(at - end) <= _SAME * length for at in places for end in held):
            raise InputError(
                "drive.force.position: displacements are imposed at one place twice, or at a support without "
                "deflection: move one, or leave it out"
            )
        return self._field((), stationed, drives, frequency_hz)

    def _field(
        self,
        forces: tuple[PointForce, ...],
        devices: tuple[Device, ...],
        drives: tuple[PointForce, ...],
        frequency_hz: Numbers,
    ) -> HarmonicField:
        """The field under forces (N), with devices, under imposed displacements (`drives`, m)."""
        beam, frequencies, one = self.beam, frequencies_on(self.beam, frequency_hz), np.ndim(frequency_hz) == 0
        if (devices or drives) and not one:
            raise InputError("frequency_hz has several values: with devices give one at a time")
        forces = (*forces, *(device.own_force for device in devices if device.amplitude))
        layout = self._stationed(tuple(force.position for force in (*forces, *drives)), devices)
        self._check_resonance(frequencies, drives, devices)
        imposed = [(layout.station_at(drive.position / beam.length), phasor(drive)) for drive in drives]
        loads = [(force.position, np.array([phasor(force)])) for force in forces]
        blocks = np.split(frequencies, range(_SWEPT_TOGETHER, len(frequencies), _SWEPT_TOGETHER))
        solved = [self._solve(layout, block, loads, imposed) for block in blocks]

        def read(x: Array, derivative: int, of: int = 0) -> ComplexArray:
            xi, scale = np.minimum(x / beam.length, 1.0), beam.length ** (derivative + of)
            values = np.concatenate([motion.read(xi, derivative, of)[:, 0] for motion, _ in solved]) / scale
            return np.asarray(values[0] if one else values, dtype=complex)

        omega = 2.0 * pi * float(frequencies[0])
        holding = [
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
            frequency_hz=float(frequencies[0]) if one else frequencies,
            forces=(*holding, *forces, *reactions),
            shapes=read,
            theory=self.theory,
            rotation_shapes=(lambda x, d: read(x, d, ROTATION)) if self.theory == "timoshenko" else None,
            couples=tuple(device.position for device in devices if device.turning),
        )

    def receptance(self, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> ComplexArray:
        """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)), m/N.

        NaN at the frequencies of undamped resonances. Raises InputError.
        """
        at, frequencies = vector_on("positions", positions, self.beam.length), frequencies_on(self.beam, frequencies_hz)
        xi = vector_on("x", x, self.beam.length) / self.beam.length
        layout = self._stationed(tuple(at.tolist()))
        steady = np.flatnonzero(np.array(self._resonances(self.layout, frequencies)) == 0)
        loads = list(zip(at.tolist(), np.eye(len(at)), strict=True))
        responses = np.full((len(frequencies), len(at), len(xi)), np.nan, dtype=complex)
        for block in np.split(steady, range(_SWEPT_TOGETHER, len(steady), _SWEPT_TOGETHER)) if len(steady) else ():
            responses[block] = self._solve(layout, frequencies[block], loads)[0].read(xi, 0)
        return responses

    def _stationed(self, positions: tuple[float, ...] = (), devices: Sequence[Device] = ()) -> BeamLayout:
        """The layout with further stations at positions (m), and with devices."""
        check_stable(self.beam)
        return layout_of(self.beam, self.theory, positions, tuple(devices))

    def _solve(
        self,
        layout: BeamLayout,
        frequencies: Array,
        loads: Sequence[tuple[float, Array]],
        imposed: Sequence[tuple[int, complex]] = (),
    ) -> tuple[Motion, ComplexArray]:
        """(motions in m under loads (position, (k,) N), forces in N of imposed displacements, (n_f, n_imposed, k))."""
        division = divide(layout, self._omega2(frequencies), self.beam.loss_factor)
        unit, n_loads = self.beam.bending_stiffness / self.beam.length**3, len(loads[0][1]) if loads else 1
        dtype = complex if any(np.iscomplexobj(values) for _, values in loads) else float
        jumps = np.zeros((len(division.over), 4, n_loads), dtype=dtype)
        for position, values in loads:
            ends = division.station_ends[:, layout.station_at(position / self.beam.length)]
            jumps[ends, 3] += values / unit / division.sizes[:, 3:]
        try:
            states, forces = solve(division, jumps, imposed)
        except np.linalg.LinAlgError:
            raise InputError(
                f"frequency_hz = {float(frequencies[0])!r}: a beam that no support holds moves beyond floating point, "
                "give a higher frequency_hz or other supports"
            ) from None
        return Motion(division, states), forces * unit

    def _resonances(self, layout: BeamLayout, frequencies: Array) -> list[int]:
        """Number, rigid motions included, of the undamped resonance at each frequency; 0 where there is none."""
        if self.beam.loss_factor:
            return [0] * len(frequencies)
        low, high = self._omega2(frequencies * (1.0 - RESONANCE)), self._omega2(frequencies * (1.0 + RESONANCE))
        counts = [[count_at(layout, omega2).below for omega2 in side.tolist()] for side in (low, high)]
        return [up_to if up_to > below else 0 for below, up_to in zip(*counts, strict=True)]

    def _check_resonance(self, frequencies: Array, drives: Sequence[PointForce], devices: Sequence[Device]) -> None:
        """Raise ResonanceError at an undamped resonance of the beam with its devices, held at imposed displacements."""
        length = self.beam.length
        layout = self._stationed(tuple(drive.position for drive in drives), devices)
        layout = with_stations(layout, [(one.position / length, Station(support="pinned")) for one in drives])
        numbers = self._resonances(layout, frequencies)
        if any(numbers) and (damped := [one for one in devices if one.dashpot or one.rotational_dashpot]):
            # a motion is undamped where it is also one of the beam held at its dashpots
            support = {(True, False): "pinned", (False, True): "guided", (True, True): "clamped"}
            held = [Station(support=support[one.dashpot > 0.0, one.rotational_dashpot > 0.0]) for one in damped]
            fixed = with_stations(layout, [(d.position / length, at) for d, at in zip(damped, held, strict=True)])
            still = self._resonances(fixed, frequencies)
            numbers = [n if m else 0 for n, m in zip(numbers, still, strict=True)]
        for frequency, number in zip(frequencies.tolist(), numbers, strict=True):
            if number and (mode := number if devices or drives else number - self.beam.rigid_motions):
                where = " with its devices or imposed displacements" if devices or drives else ""
                resonance = wavenumber_length(layout, number) ** 2 * self.beam.wave_constant / (2.0 * pi * length**2)
                raise ResonanceError(
                    f"frequency_hz = {frequency!r} lies {abs(frequency / resonance - 1.0):.1e} (relative) from the "
                    f"undamped resonance of mode {mode} of the {self.name} model{where} at {resonance!r} Hz: give the "
                    "beam a loss_factor or choose another frequency"
                )

    # --- Buckling, waves, motion in time ---

    def buckling_load(self) -> float:
        """The smallest compression at which the beam buckles, N: Euler's load. Raises InputError."""
        return buckling_load(self.beam)

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber of propagating waves in the beam's own section by its theory, 1/m."""
        return wavenumber(self.beam, frequency_hz, self.theory)

    def time_basis(self, *, modes: int | None = None, line: str = "spline") -> TimeBasis:
        """The first `modes` modes (400) and what the others add to a steady field.

        Of beams of sections and point masses: a damping ratio is the same in every mode, so that springs, foundation
        and axial force, which lose nothing, are refused. Raises InputError, also for rigid-body motions.
        """
        beam, n_modes = self.beam, EXACT_MODES if modes is None else modes
        check_in_time(beam)
        if self.theory != "euler-bernoulli":
            raise InputError(f"theory = {self.theory!r}: the exact beam in time is of euler-bernoulli, choose that")
        check_whole("modes", n_modes, 1, MOST_MODES)
        own = self.modes(n_modes)
        omegas = 2.0 * pi * own.frequencies_hz
        spans, inner = np.array(self.layout.spans), np.array(self.layout.positions[1:-1]) * beam.length
        ratios = spans[:, 2] / spans[:, 1]  # rho A / EI over that of the beam's own section
        read = lru_cache(maxsize=16)(lambda x, derivative: own.shapes(np.frombuffer(x), derivative))

        def fourth(omega: Any, x: Array) -> Array:
            """beta^4 at x: the fourth derivative over the deflection."""
            return np.asarray(omega**2 / beam.wave_constant**2 * ratios[np.searchsorted(inner, x, side="right")])

        def shapes(x: Array, derivative: int) -> Array:
            rounds, rest = divmod(derivative, 4)
            return np.asarray(read(x.tobytes(), rest) * fourth(omegas[:, None], x) ** rounds)

        def tail(forces: Sequence[PointForce], frequency_hz: float, damping: Any) -> Callable[[Array, int], Any]:
            """The exact field less the part of the modes: what far faster modes respond without delay."""
            lossy = ExactModel(replace(beam, loss_factor=2.0 * float(damping)))
            field = lossy.harmonic(forces, frequency_hz)
            loads = sum(phasor(one) * shapes(np.array([one.position]), 0)[:, 0] for one in forces)
            part = loads / (omegas**2 * (1.0 + 2j * damping) - field.omega**2)
            return lambda x, derivative: field.shapes(x, derivative) - part @ shapes(x, derivative)

        # cells of 0.4 wavenumbers of the fastest mode at most
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
            edges=np.concatenate([np.zeros(1), *pieces]),
            degree=_TAYLOR_DEGREE,
            method=f"the first {n_modes} exact modes, the rest without delay",
            tail=tail,
        )


def check_in_time(beam: Beam, instead: str = "give model = 'fem' or 'segment'") -> None:
    """Raise InputError for a beam without an exact time basis; `instead` is the remedy in the message."""
    beam.check_added("the exact beam in time", ("section", "mass"), instead)
    check_held(beam)


@lru_cache(maxsize=256)  # a basis of 400 modes has some twenty blocks
def _modal_motion(model: ExactModel, modes: range) -> Motion:
    """The motions of some modes, in a row."""
    numbers, rigid = range(modes[0] - 1, modes[-1] + 2), model.beam.rigid_motions
    betas = [wavenumber_length(model.layout, mode + rigid) if mode else 0.0 for mode in numbers]
    return modal_motion(model.layout, np.array(betas), np.array(modes))
