"""`DiscreteModel`: the methods of `BeamModel` for discrete models, in terms of their `StructuralSystem`.

A subclass defines the system, the weights of its unknowns at a position, and their interpolation. Unknowns are
dimensionless: lengths in `unit`, stiffnesses in EI and masses in rho A unit.
"""

from abc import abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import replace
from functools import cache, cached_property, partial
from math import pi, sqrt
from typing import Any

import numpy as np
from msgspec import structs

from verify.arrays import Array, ComplexArray, Curve, Numeric, Sparse
from verify.errors import InputError, NoFigureError, ResonanceError
from verify.linear.base import BeamModel, Devices
from verify.linear.field import HarmonicField, acting_on, phasor, point_force
from verify.linear.modes import Modes
from verify.linear.positions import Forces, Loads, Numbers, as_vector, frequencies_on, vector_on
from verify.linear.system import FEW, LOST, SUPERPOSED, StructuralSystem, memory
from verify.linear.time_basis import TimeBasis, check_supported
from verify.problem.beam import PointForce, PointLoad, PointMoment, is_lossless, rigid_lines
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass
from verify.validation import check_choice, check_integer, check_number


class DiscreteModel(BeamModel):
    """A discrete model; see `BeamModel` for arguments, results and errors of its methods."""

    @property
    @abstractmethod
    def unit(self) -> float:
        """Mean length of a part, m."""

    @property
    @abstractmethod
    def n_unknowns(self) -> int:
        """Number n of unknowns, computed without building the system."""

    @property
    @abstractmethod
    def system(self) -> StructuralSystem:
        """Stiffness and mass, also beyond buckling; a cached property."""

    @abstractmethod
    def load_rows(self, positions: Array, *, rotation: bool = False) -> Sparse:
        """Weights of the unknowns for a unit force (or couple) at each position (m), sparse (n_positions, n).

        The row of a couple also gives the rotation at a device.
        """

    def device_rows(self, positions: Array) -> Sparse:
        """Weights of the unknowns for deflection and force of devices at positions (m), sparse (n_positions, n)."""
        return self.load_rows(positions)

    @abstractmethod
    def line(self, unknowns: Numeric) -> Curve:
        """Deflection for unknowns (n, k): (x in m, derivative) -> (k, len(x)), per metre^derivative."""

    def rotation_line(self, unknowns: Numeric) -> Curve | None:
        """Section rotation for unknowns (n, k): (x in m, derivative) -> (k, len(x)); None where it is the slope."""
        return None

    @abstractmethod
    def lossy_stiffness(self, omega: float) -> Numeric:
        """Stiffness d with losses of material and dashpots at omega (rad/s), (m,); real without losses."""

    @abstractmethod
    def leading_sign(self, vectors: Array) -> Array:
        """+-1 for each vector (n, k), (k,): the sign of the deflection next to the left end."""

    @abstractmethod
    def modes_of(self, vectors: Array) -> dict[str, Any]:
        """Fields of `Modes` except frequencies and shapes, for mass-normalised vectors (n, k)."""

    @abstractmethod
    def time_line(self, vectors: Array, line: str) -> dict[str, Any]:
        """Fields `shapes`, `edges`, `degree` of `TimeBasis`, and `turns` where bodies do not follow the slope."""

    @property
    @abstractmethod
    def edges(self) -> Array:
        """Ends of the pieces on which deflections are polynomials, (pieces + 1,), m."""

    @property
    @abstractmethod
    def cut_off_hz(self) -> float:
        """Cut-off frequency, Hz: half a wavelength on one part; waves propagate below it."""

    @property
    def n_elastic(self) -> int:
        """Number of elastic modes."""
        return max(self.n_unknowns - self.beam.rigid_motions, 0)

    @property
    def _omega_unit(self) -> float:
        """Unit of omega, rad/s."""
        return self.beam.wave_constant / self.unit**2

    @property
    def _tension(self) -> float:
        """Axial force T unit^2/EI."""
        return self.beam.tension * self.unit**2 / self.beam.bending_stiffness

    @property
    def _foundation(self) -> float:
        """Foundation k_f unit^4/EI."""
        return self.beam.foundation * self.unit**4 / self.beam.bending_stiffness

    @property
    def _tilts(self) -> bool:
        """Whether the beam without its axial force has a rigid-body rotation."""
        return any(b for _, b in rigid_lines(structs.replace(self.beam, tension=0.0)))

    def check_memory(self, n_modes: int = 0) -> None:
        """Raise InputError for a system of more than 10 GB (`system.memory`), before it is built."""
        if memory(self.n_unknowns, n_modes) > 10e9:
            raise InputError(
                f"count = {self.count}: {self.n_unknowns} unknowns with {n_modes} modes exceed the largest system of "
                f"10 GB, lower the number of {self.parts} or of modes"
            )

    def check_propagates(self, frequency_hz: float) -> None:
        """Raise NoFigureError at and beyond `cut_off_hz`."""
        if frequency_hz >= (limit := self.cut_off_hz):
            beam, n = self.beam, self.count or 0
            plain = self.theory == "euler-bernoulli" and not (beam.section or beam.tension or beam.foundation)
            raise NoFigureError(
                f"count = {n}: frequency_hz = {float(frequency_hz)!r} exceeds the cut-off {limit:.6g} Hz of {n} "
                f"{self.parts}, "
                # the cut-off of equal parts without tension and foundation is proportional to their number squared
                + (f"give count = {int(n * sqrt(frequency_hz / limit)) + 1} or more" if plain else "raise count")
            )

    @cached_property
    def stable_system(self) -> StructuralSystem:
        """The system. Raises InputError where the beam's axial force exceeds the buckling load."""
        if self.beam.tension < 0.0:
            load = 0.0 if self._tilts else -self.beam.tension * self.system.buckling_factor()
            if -self.beam.tension >= load:
                raise InputError(
                    f"beam.tension = {self.beam.tension!r} N exceeds the buckling load {load:.6g} N of {self.count} "
                    f"{self.parts}: compress the beam less or support it better"
                )
        return self.system

    # --- Modes, buckling, motion in time -------------------------------------------------------------------------

    def modes(self, n_modes: int) -> Modes:
        """The first elastic modes. Raises InputError for too many, within rounding, and for compression to buckling."""
        check_integer("n_modes", n_modes, 1)
        if n_modes > self.n_elastic:
            raise InputError(
                f"n_modes = {n_modes}: the {self.name} model at count = {self.count} has {self.n_elastic} elastic "
                "modes, raise count"
            )
        self.check_memory(n_modes)
        try:
            values, vectors = self.stable_system.modes(n_modes)
        except np.linalg.LinAlgError:
            text = f"{self.count} {self.parts} are within rounding: give sections that differ less, or a lower count"
            raise InputError(f"beam: modes of {text}") from None
        vectors = self._normalised(vectors)
        return Modes(
            model=self.name,
            count=self.count,
            length=self.beam.length,
            frequencies_hz=np.sqrt(values) * (self._omega_unit / (2.0 * pi)),
            shapes=self.line(vectors),
            method=self.stable_system.method(n_modes),
            **self.modes_of(vectors),
        )

    def _normalised(self, vectors: Array) -> Array:
        """Vectors (n, k) of dimensionless unit modal mass in 1/sqrt(kg), positive next to the left end."""
        return np.asarray(vectors * (self.leading_sign(vectors) / sqrt(self.beam.mass_per_length * self.unit)))

    def buckling_load(self) -> float:
        """Lowest buckling load in compression, N, without shear; 0 for a beam with a rigid-body rotation."""
        if self._tilts:
            return 0.0
        load = float(self.beam.bending_stiffness / self.beam.length**2)
        beam = structs.replace(self.beam, tension=-load)
        compressed: DiscreteModel = replace(self, beam=beam, theory="euler-bernoulli")  # type: ignore[type-var]
        return load * compressed.system.buckling_factor()

    def time_basis(self, *, modes: int | None = None, line: str = "spline") -> TimeBasis:
        """All modes for motion in time. Raises InputError for rigid-body motions, and for too many unknowns."""
        check_supported(self.beam)
        check_choice("line", line, self.lines)
        if modes is not None:
            raise InputError(f"modes = {modes!r} is for model = analytic: {self.name} uses all its modes, leave it out")
        values, vectors = self.stable_system.all_modes
        ratios = None
        if self.beam.loss_factor and is_lossless(self.beam):
            # half the loss factor times the lossy fraction of each modal stiffness
            energies = self.stable_system.strain(vectors) ** 2
            ratios = 0.5 * (np.imag(self.lossy_stiffness(1.0)) @ energies) / (self.stable_system.stiffness @ energies)
        vectors = self._normalised(vectors)
        return TimeBasis(
            model=self.name,
            count=self.count,
            beam=self.beam,
            omegas=np.sqrt(values) * self._omega_unit,
            loads=cache(lambda position: np.asarray((self.load_rows(np.array([position])) @ vectors)[0])),
            turning_loads=lambda x: np.asarray((self.load_rows(np.array([x]), rotation=True) @ vectors)[0] / self.unit),
            method="all modes",
            ratios=ratios,
            **self.time_line(vectors, line),
        )

    # --- Harmonic motion -----------------------------------------------------------------------------------------

    def harmonic(
        self, forces: Loads, frequency_hz: Numbers, *, devices: Devices = (), modal_damping: float = 0.0
    ) -> HarmonicField:
        """The steady field under harmonic point forces and moments.

        Many frequencies: superposition of all modes, unless damping couples them.
        """
        acting, stationed = self.check_stationed(forces, devices, frequency_hz)
        if (cut := self._cut_for((*acting, *stationed))) is not self:
            field = cut.harmonic(acting, frequency_hz, devices=stationed, modal_damping=modal_damping)
            return structs.replace(field, beam=self.beam)
        check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
        frequencies = frequencies_on(self.beam, frequency_hz)
        blocked, omegas = tuple(device.own_force for device in stationed if device.amplitude), 2.0 * pi * frequencies
        loads, omega2 = self._loads(acting, blocked), (omegas / self._omega_unit) ** 2
        impedances = self._impedances(stationed, float(omegas[0]))
        loss = self._shared_loss(omegas) if modal_damping or (self._many(omegas) and not impedances) else None
        if modal_damping and (loss is None or impedances):
            coupling = "devices" if impedances else "a loss in a part of the stiffness"
            raise InputError(
                f"modal_damping = {modal_damping!r} with {coupling}: the modes are coupled, give one of the two"
            )
        if loss is not None:
            parts = self.stable_system.harmonic_sweep(loads, omega2, loss, modal_damping)[..., 0]
            if (at := np.flatnonzero(np.isnan(parts[0, :, 0]))).size:
                raise self._at_resonance(float(frequencies[at[0]]))
        else:
            parts, rows = np.empty((2, len(omegas), len(loads)), dtype=complex), [each[1:] for each in impedances]
            for i, (omega, w2) in enumerate(zip(omegas.tolist(), omega2.tolist(), strict=True)):
                try:
                    steady = self.stable_system.steady(loads, w2, self.lossy_stiffness(omega), rows)
                except np.linalg.LinAlgError:
                    raise self._at_resonance(float(frequencies[i])) from None
                parts[:, i] = steady[0][:, 0], steady[1][:, 0]
        reactions = self._reactions(impedances, parts[:, 0].sum(axis=0))
        return self._field(parts, frequency_hz, (*acting, *blocked, *reactions), stationed)

    def imposed(self, displacements: Forces, frequency_hz: float, *, devices: Devices = ()) -> HarmonicField:
        """The steady field under imposed harmonic displacements, which are constraint rows of the system.

        Deflections of a chain have other weights than forces: the constraints are scaled to the deflections.
        """
        drives, stationed = self.check_stationed(displacements, devices, frequency_hz, PointForce)
        if (cut := self._cut_for(stationed)) is not self:
            return structs.replace(cut.imposed(drives, frequency_hz, devices=stationed), beam=self.beam)
        omega = 2.0 * pi * float(frequencies_on(self.beam, frequency_hz)[0])
        blocked = tuple(device.own_force for device in stationed if device.amplitude)
        places, p = np.array([drive.position for drive in drives]), len(drives)
        rows = self.load_rows(places)
        if np.linalg.matrix_rank(rows.toarray()) < p:
            raise InputError(
                "drive.force.position: two displacements are imposed at one position, or one at a support without "
                "deflection, move one or leave it out"
            )
        impedances = self._impedances(stationed, omega)
        try:
            bent, moved, forces = self.stable_system.steady(
                np.hstack([np.zeros((self.n_unknowns, p)), self._loads((), blocked)]),
                (omega / self._omega_unit) ** 2,
                self.lossy_stiffness(omega),
                [each[1:] for each in impedances],
                rows,
                np.eye(p, p + 1),
            )
        except np.linalg.LinAlgError:
            raise self._at_resonance(frequency_hz) from None
        read, scale = self.line(bent + moved)(places, 0), self.beam.bending_stiffness / self.unit**3
        shares = np.linalg.solve(read[:p].T, np.array([phasor(drive) for drive in drives]) - read[p])
        bent, moved, forces = (each @ np.append(shares, 1.0) for each in (bent, moved, forces))
        holding = [point_force(at, force * scale) for at, force in zip(places.tolist(), forces, strict=True)]
        reactions = self._reactions(impedances, bent + moved)
        return self._field(
            np.stack([bent, moved])[:, None], float(frequency_hz), (*holding, *blocked, *reactions), stationed
        )

    def receptance(self, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> ComplexArray:
        """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)), m/N."""
        at, frequencies = vector_on("positions", positions, self.beam.length), frequencies_on(self.beam, frequencies_hz)
        read, omegas = vector_on("x", x, self.beam.length), 2.0 * pi * frequencies
        loads = self.load_rows(at).toarray().T * (self.unit**3 / self.beam.bending_stiffness)
        omega2 = (omegas / self._omega_unit) ** 2
        if self._many(omegas) and (loss := self._shared_loss(omegas)) is not None:
            # interpolate the modes once instead of every response
            receptances, acting, responding = self.stable_system.modal_receptances(omega2, loss)
            weights, shapes = acting.T @ loads, self.line(responding)(read, 0)
            return np.asarray(np.einsum("mp,fm,mx->fpx", weights, receptances, shapes, optimize=True), dtype=complex)
        result = np.full((len(frequencies), len(at), len(read)), np.nan, dtype=complex)
        for i, (omega, w2) in enumerate(zip(omegas.tolist(), omega2.tolist(), strict=True)):
            try:
                bent, moved, _ = self.stable_system.steady(loads, w2, self.lossy_stiffness(omega))
            except np.linalg.LinAlgError:
                continue
            result[i] = self.line(bent + moved)(read, 0)
        return result

    def _loads(self, acting: Sequence[PointLoad], blocked: Sequence[PointForce]) -> ComplexArray:
        """Dimensionless loads of forces, moments and active devices, (n, 1)."""
        loads = np.zeros((self.n_unknowns, 1), dtype=complex)
        moments = [load for load in acting if isinstance(load, PointMoment)]
        forces = [load for load in acting if not isinstance(load, PointMoment)]
        turning = partial(self.load_rows, rotation=True)
        each = ((self.load_rows, forces, 1.0), (turning, moments, self.unit), (self.device_rows, blocked, 1.0))
        for rows, some, lever in each:
            if some:
                weights = rows(np.array([load.position for load in some])).T
                loads += weights @ np.array([[phasor(load) / lever] for load in some])
        return np.asarray(loads * (self.unit**3 / self.beam.bending_stiffness))

    def cut_at(self, positions: Iterable[float]) -> "DiscreteModel":
        """The model with negligible bodies at positions, m; itself if it has bodies at all of them.

        Bodies place nodes, and elastic joints at the ends; elsewhere a moment is of order 1 or 2, a device of order 3.
        """
        beam, negligible = self.beam, 1e-15 * self.beam.mass_per_length * self.unit**3
        bodies = {attachment.position for attachment in beam.attached if attachment.rotary_inertia}
        missing = sorted(set(positions) - bodies)
        if not missing:
            return self
        mass = [PointMass(position=position, rotary_inertia=negligible) for position in missing]
        return replace(self, beam=structs.replace(beam, mass=(*beam.mass, *mass)))  # type: ignore[type-var]

    def _cut_for(self, acting: Sequence[PointLoad | Device]) -> "DiscreteModel":
        """`cut_at` moments and devices against rotation."""
        return self.cut_at(one.position for one in acting if getattr(one, "turning", isinstance(one, PointMoment)))

    def _many(self, omegas: Array) -> bool:
        """Whether all modes cost less than one factorisation per frequency."""
        return len(omegas) > FEW and self.n_unknowns <= SUPERPOSED

    def _shared_loss(self, omegas: Array) -> float | None:
        """The loss factor common to all stiffnesses and frequencies; None where they differ and couple the modes."""
        first, last = (self.lossy_stiffness(float(omega)) for omega in (omegas[0], omegas[-1]))
        losses = np.imag(first / self.stable_system.stiffness)
        shared = np.ptp(losses) <= 1e-15 * (1.0 + losses.max()) and np.array_equal(first, last)
        return float(losses[0]) if shared else None

    def _at_resonance(self, frequency_hz: float) -> ResonanceError:
        return ResonanceError(
            f"frequency_hz = {frequency_hz!r} is an undamped resonance of the {self.name} model, or leaves it fewer "
            "than four digits: give the beam a loss_factor, choose another frequency or lower count"
        )

    def _impedances(self, devices: Sequence[Device], omega: float) -> list[tuple[float | None, Any, complex]]:
        """(position or None for a rotation, row, dimensionless dynamic stiffness) of each impedance."""
        impedances, scale = list[tuple[float | None, Any, complex]](), self.unit / self.beam.bending_stiffness
        for device in devices:
            at = np.array([device.position])
            if (across := device.dynamic_stiffness(omega)) != 0.0:
                impedances.append((device.position, self.device_rows(at), across * (self.unit**2 * scale)))
            if (turning := device.rotational_dynamic_stiffness(omega)) != 0.0:
                impedances.append((None, self.load_rows(at, rotation=True), turning * scale))
        return impedances

    def _reactions(self, impedances: Sequence[Any], unknowns: ComplexArray) -> list[PointForce]:
        """Forces that devices exert on the beam, N."""
        scale = self.beam.bending_stiffness / self.unit**3
        return [
            point_force(at, complex(-scale * z * (row @ unknowns)[0])) for at, row, z in impedances if at is not None
        ]

    def _field(
        self, parts: ComplexArray, frequency_hz: Any, loads: tuple[PointLoad, ...], devices: Sequence[Device]
    ) -> HarmonicField:
        """The field for elastic and rigid-body unknowns (2, n_frequencies, n); of one frequency if a number.

        Rigid-body motions have no curvature; that of their rounded sum with bending is rounding at low frequency.
        """
        single, sampled = np.ndim(frequency_hz) == 0, np.linspace(0.0, self.beam.length, 33)

        def joined(lines: Sequence[Any], shift: int) -> Curve:
            checked = {0}

            def both(lines: Sequence[Any], x: Array, derivative: int, order: int) -> Any:
                return sum(line(x, derivative) for line in (lines if order < 2 else lines[:1]))

            def read(x: Array, derivative: int) -> Numeric:
                if (order := derivative + shift) not in checked:
                    # rounding of deflections over the length of a part, measured as a few units of the last place
                    noise = abs(both(deflections, sampled, 0, order)).max(axis=1) * 8.0 * 2.0**-52 / self.unit**order
                    size = abs(both(lines, sampled, derivative, order)).max(axis=1)
                    if (bad := np.flatnonzero((noise > LOST * size) & (size > 0.0))).size:
                        raise NoFigureError(
                            f"frequency_hz = {float(np.atleast_1d(frequency_hz)[bad[0]])!r} leaves derivative {order} "
                            f"of the {self.name} model's deflection fewer than four digits: raise it or lower count"
                        )
                    checked.add(order)
                values = both(lines, x, derivative, order)
                return np.asarray(values[0] if single else values)

            return read

        def conjugate(load: PointLoad) -> complex:
            at, turning = np.array([load.position]), isinstance(load, PointMoment)
            row = self.load_rows(at, rotation=True) / self.unit if turning else self.device_rows(at)
            return complex((row @ parts[:, 0].sum(axis=0))[0])

        moving = parts if self.stable_system.n_rigid else parts[:1]
        deflections, rotations = ([line(part.T) for part in moving] for line in (self.line, self.rotation_line))
        return HarmonicField(
            model=self.name,
            count=self.count,
            beam=self.beam,
            frequency_hz=float(frequency_hz) if single else as_vector("frequency_hz", frequency_hz),
            shapes=joined(deflections, 0),
            theory=self.theory,
            edges=self.edges,
            rotation_shapes=None if rotations[0] is None else joined(rotations, 1),
            conjugate=conjugate,
            **acting_on(loads, devices),
        )
