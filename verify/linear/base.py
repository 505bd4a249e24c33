"""What a model of a vibrating beam is: an object that holds a beam, its size and its settings, and answers by verbs.

`BeamModel` is the interface that every model has. `DiscreteModel` writes each verb once over a `StructuralSystem`,
for models of parts: they give the system, how a place weighs its unknowns, and the line through them.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from functools import cached_property
from math import pi, sqrt
from typing import Any, ClassVar, Literal

import numpy as np
from msgspec import structs

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, ResonanceError
from verify.linear.field import HarmonicField, phasor, point_force, wavenumber
from verify.linear.modes import Modes
from verify.linear.positions import Forces, Numbers, as_vector, forces_on, frequencies_on, vector_on
from verify.linear.system import FEW, SUPERPOSED, StructuralSystem, memory
from verify.linear.time_basis import TimeBasis, check_held
from verify.options import THEORIES
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass
from verify.validation import check_kind, check_number, check_whole, check_word, several

_NEEDS = {"rayleigh": ("rotary_inertia",), "timoshenko": ("rotary_inertia", "shear_stiffness")}


class BeamModel(ABC):
    """A model of one beam. Subclasses are frozen dataclasses: `beam`, the number of parts if any, then settings.

    Another package registers one by `MODELS.register(cls)` or an entry point of the group `verify.models`; a verb that
    it does not override is refused by name.
    """

    name: ClassVar[str]
    """In a scene or on a command line."""
    parts: ClassVar[str] = "parts"
    """What its count counts: 'segments'."""
    title: ClassVar[str] = ""
    """In charts and tables; the name unless given."""
    colour: ClassVar[str] = "#8f5bd1"
    """Of its lines in charts."""
    sized: ClassVar[bool] = True
    """Whether it has parts."""
    bounds: ClassVar[Literal["below", "above"] | None] = None
    """Side of the exact frequencies on which it lies, on uniform beams without a clamped end."""
    fewest: ClassVar[int] = 1
    """Least number of parts."""
    library: ClassVar[str] = ""
    """Package that it needs beside numpy and scipy."""
    lines: ClassVar[tuple[str, ...]] = ("spline",)
    """Contact lines on which a slider can run."""
    modal_settings: ClassVar[tuple[str, ...]] = ()
    """Settings that its frequencies depend on, among those of `analysis.variants`."""
    beam: Beam
    theory: str = "euler-bernoulli"

    def __init_subclass__(cls) -> None:
        """One without a title is called by its name."""
        cls.title = cls.title or getattr(cls, "name", "")

    @classmethod
    def build(cls, beam: Beam, count: int | None = None, **settings: Any) -> "BeamModel":
        """The model of a beam by the number of parts, None for a model without. Raises InputError."""
        cls.check_count(count)
        for name, value in settings.items():
            if name not in cls.settings():
                raise InputError(f"{name} = {value!r} is no setting of the {cls.name} model: leave it out")
        return cls(beam, count, **settings) if cls.sized else cls(beam, **settings)  # type: ignore[call-arg]

    @classmethod
    def check_count(cls, count: int | None) -> None:
        """Raise InputError for a missing number of parts, and for one where there are none."""
        if cls.sized == (count is None):
            raise InputError(
                f"count is missing: give the number of {cls.parts} for model = {cls.name}"
                if cls.sized
                else f"count = {count!r} is for models of parts: {cls.name} has none, leave it out"
            )

    @classmethod
    def settings(cls) -> tuple[str, ...]:
        """Names of its settings: its fields after the beam and the number of parts."""
        return tuple(one.name for one in fields(cls))[1 + cls.sized :]  # type: ignore[arg-type]

    @classmethod
    def can(cls, verb: str) -> bool:
        """Whether it has a verb of its own."""
        return getattr(cls, verb) is not getattr(BeamModel, verb)

    @property
    def count(self) -> int | None:
        """Number of parts; None for a model without."""
        return None

    @property
    @abstractmethod
    def n_elastic(self) -> int:
        """Number of elastic modes; rigid-body motions are not counted."""

    def modes(self, n_modes: int) -> Modes:
        """The first elastic modes. Raises InputError."""
        raise self._has_no("modes")

    def harmonic(
        self,
        forces: Forces,
        frequency_hz: Numbers,
        *,
        devices: Device | Sequence[Device] = (),
        modal_damping: float = 0.0,
    ) -> HarmonicField:
        """The steady field under harmonic point forces, e^{+i omega t}, at one frequency or many.

        `devices` are impedances on the beam, at one frequency. Damping: the beam's loss factor, or `modal_damping`,
        the ratio of every mode. Raises InputError, and ResonanceError at an undamped resonance.
        """
        raise self._has_no("harmonic")

    def imposed(
        self, displacements: Forces, frequency_hz: float, *, devices: Device | Sequence[Device] = ()
    ) -> HarmonicField:
        """The steady field under imposed harmonic displacements: amplitudes in metres; its first forces impose them.

        Raises InputError for two at one position or one at a support without deflection, and ResonanceError.
        """
        raise self._has_no("imposed")

    def receptance(self, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> ComplexArray:
        """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)), m/N.

        NaN at the frequencies of undamped resonances. Raises InputError.
        """
        raise self._has_no("receptance")

    def time_basis(self, *, modes: int | None = None, line: str = "spline") -> TimeBasis:
        """Its free modes for motion in time; a model without parts keeps the first `modes`. Raises InputError."""
        raise self._has_no("time_basis")

    def buckling_load(self) -> float:
        """Least compression at which it buckles, by Euler-Bernoulli theory, N, whatever the beam's own axial force."""
        raise self._has_no("buckling_load")

    def expected_order(self) -> int | None:
        """Order in the number of parts at which its frequencies converge; None where it is not known."""
        return None

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber of waves in it, 1/m; that of the exact beam unless its dispersion is known."""
        return wavenumber(self.beam, frequency_hz)

    def check_propagates(self, frequency_hz: float) -> None:  # noqa: B027
        """Raise NoFigureError for a frequency above the cut-off of its parts."""

    def check_n_modes(self, n_modes: int) -> None:
        """Raise InputError unless it has so many elastic modes."""
        check_whole("n_modes", n_modes, 1)
        if n_modes > self.n_elastic:
            raise InputError(
                f"n_modes = {n_modes}: the {self.name} model at count = {self.count} has {self.n_elastic} elastic "
                "modes, raise count"
            )

    def check_theory(self) -> None:
        """Raise InputError for an unknown theory, and for one that the beam has no figures for."""
        check_kind("beam", self.beam, Beam)
        check_word("theory", self.theory, THEORIES)
        if self.theory != "euler-bernoulli" and self.beam.tension:
            raise InputError(
                f"beam.tension = {self.beam.tension!r} N with theory = {self.theory!r}: there is more than one such "
                "theory, leave the axial force out or choose euler-bernoulli"
            )
        for i, piece in enumerate(self.beam.pieces):
            for figure in _NEEDS.get(self.theory, ()):
                if getattr(piece, figure) is None:
                    where = f"beam.section[{i}]" if self.beam.section else "beam"
                    raise InputError(
                        f"{where}.{figure} is missing: theory = {self.theory!r} needs it, give it, or a shape with its "
                        "sizes, youngs_modulus and density"
                    )

    def check_stationed(self, forces: Forces, devices: Device | Sequence[Device]) -> tuple[Any, Any]:
        """(forces, devices) as tuples. Raises InputError for one off the beam or without effect, and for none."""
        acting, stationed = forces_on(self.beam, forces), several("devices", devices, Device)
        for device in stationed:
            device.check_on(self.beam)
        if not acting and not any(device.amplitude for device in stationed):
            raise InputError("forces is empty and no device has an amplitude: give a PointForce, or a device a force")
        return acting, stationed

    def _has_no(self, verb: str) -> InputError:
        from verify.linear.registry import MODELS

        able = ", ".join(model.name for model in MODELS.values() if model.can(verb))
        return InputError(f"model = {self.name!r} has no {verb.replace('_', ' ')}: choose one of {able}")


class DiscreteModel(BeamModel):
    """A model of parts. Unknowns are dimensionless: lengths in `unit`, stiffnesses in EI and masses in rho A unit."""

    @property
    @abstractmethod
    def unit(self) -> float:
        """Mean length of a part, m."""

    @property
    @abstractmethod
    def n_unknowns(self) -> int:
        """Number of unknowns, known without building the system."""

    @property
    @abstractmethod
    def system(self) -> StructuralSystem:
        """Its stiffness and mass, stable or not; a cached property."""

    @cached_property
    def stable_system(self) -> StructuralSystem:
        """The system. Raises InputError where the beam's axial force buckles it."""
        if self.beam.tension < 0.0:
            load = 0.0 if self._tilts else -self.beam.tension * self.system.buckling_factor()
            if -self.beam.tension >= load:
                raise InputError(
                    f"beam.tension = {self.beam.tension!r} N compresses the beam beyond its buckling: {self.count} "
                    f"{self.parts} buckle at {load:.6g} N, compress it less or hold it better"
                )
        return self.system

    @abstractmethod
    def load_rows(self, positions: Array, *, rotation: bool = False) -> Any:
        """Weights of the unknowns for a unit force (or couple) at each position (m), sparse (n_positions, n).

        A device reads its rotation by the same row.
        """

    def device_rows(self, positions: Array) -> Any:
        """The same of devices, which read their deflection, and exert a force of their own, by them."""
        return self.load_rows(positions)

    @abstractmethod
    def line(self, unknowns: Any) -> Callable[[Array, int], Any]:
        """The beam's deflection of unknowns (n, k): (x in m, derivative) -> (k, len(x)), per metre^derivative."""

    def rotation_line(self, unknowns: Any) -> Callable[[Array, int], Any] | None:
        """The same of the section's rotation, rad per metre^derivative; None where it is the slope."""
        return None

    @abstractmethod
    def lossy_stiffness(self, omega: float) -> Any:
        """D of the system with the losses of the material and of dashpots at omega (rad/s), (m,).

        Real where nothing is lost.
        """

    @abstractmethod
    def leading_sign(self, vectors: Array) -> Array:
        """+-1 for each vector (n, k), (k,): positive where the beam first moves off its left end."""

    @abstractmethod
    def modes_of(self, vectors: Array) -> dict[str, Any]:
        """Fields of `Modes` other than frequencies and shapes, of mass-normalised vectors (n, k)."""

    @property
    def n_elastic(self) -> int:
        """Number of elastic modes."""
        return max(self.n_unknowns - self.beam.rigid_motions, 0)

    @property
    def _tilts(self) -> bool:
        """Whether the beam without its axial force rotates freely as a whole."""
        return any(b for _, b in structs.replace(self.beam, tension=0.0).rigid_lines)

    def check_memory(self, n_modes: int = 0) -> None:
        """Raise InputError, before anything is built, for a system of more than 10 GB: `system.memory`."""
        if memory(self.n_unknowns, n_modes) > 10e9:
            raise InputError(
                f"count = {self.count}: {self.n_unknowns} unknowns with {n_modes} modes exceed the largest system of "
                f"10 GB, lower the number of {self.parts} or of modes"
            )

    @property
    def _omega_unit(self) -> float:
        """rad/s of a dimensionless frequency of 1."""
        return self.beam.wave_constant / self.unit**2

    def modes(self, n_modes: int) -> Modes:
        """The first elastic modes. Raises InputError for more than it has, and for a compression beyond buckling."""
        self.check_n_modes(n_modes)
        self.check_memory(n_modes)
        values, vectors = self.stable_system.modes(n_modes)
        vectors = self.normalised(vectors)
        return Modes(
            model=self.name,
            count=self.count,
            length=self.beam.length,
            frequencies_hz=np.sqrt(values) * (self._omega_unit / (2.0 * pi)),
            shapes=self.line(vectors),
            method=self.stable_system.method(n_modes),
            **self.modes_of(vectors),
        )

    def normalised(self, vectors: Array) -> Array:
        """Vectors of dimensionless unit modal mass (n, k) in 1/sqrt(kg), positive off the left end."""
        return np.asarray(vectors * (self.leading_sign(vectors) / sqrt(self.beam.mass_per_length * self.unit)))

    def harmonic(
        self,
        forces: Forces,
        frequency_hz: Numbers,
        *,
        devices: Device | Sequence[Device] = (),
        modal_damping: float = 0.0,
    ) -> HarmonicField:
        """The steady field under harmonic point forces, by `StructuralSystem.harmonic`; see `BeamModel.harmonic`.

        Many frequencies are superposed from all modes where damping does not couple them.
        """
        acting, stationed = self.check_stationed(forces, devices)
        if (cut := self._cut_at(stationed)) is not None:
            field = cut.harmonic(acting, frequency_hz, devices=stationed, modal_damping=modal_damping)
            return structs.replace(field, beam=self.beam)
        frequencies = frequencies_on(self.beam, frequency_hz)
        if stationed and np.ndim(frequency_hz):
            raise InputError("frequency_hz has several values: with devices give one at a time")
        own = [device.own_force for device in stationed if device.amplitude]
        loads = self._loads(acting, own)
        rows = self._device_rows(stationed, 2.0 * pi * float(frequencies[0]))
        unknowns = self._responses(loads, frequencies, modal_damping, rows)[:, :, 0]
        reactions = self._reactions(stationed, unknowns[0], 2.0 * pi * float(frequencies[0]))
        return self._field(unknowns, frequency_hz, (*acting, *own, *reactions), stationed)

    def _loads(self, forces: Sequence[PointForce], own: Sequence[PointForce]) -> ComplexArray:
        """Dimensionless loads of forces and of devices' own forces, (n, 1)."""
        loads = np.zeros((self.n_unknowns, 1), dtype=complex)
        for rows, acting in ((self.load_rows, forces), (self.device_rows, own)):
            if acting:
                weights = rows(np.array([force.position for force in acting])).T
                loads += weights @ np.array([[phasor(force)] for force in acting])
        return np.asarray(loads * (self.unit**3 / self.beam.bending_stiffness))

    def _cut_at(self, devices: Sequence[Device]) -> "DiscreteModel | None":
        """The model with negligible bodies at devices against rotation, None where it has bodies there.

        A model divides its beam, and lets its ends rotate, at bodies; a couple elsewhere is of order 1 or 2.
        """
        beam, negligible = self.beam, 1e-15 * self.beam.mass_per_length * self.unit**3
        bodies = {mass.position for mass in beam.mass if mass.rotary_inertia}
        positions = sorted({device.position for device in devices if device.turning} - bodies)
        if not positions:
            return None
        mass = [PointMass(position=position, rotary_inertia=negligible) for position in positions]
        return replace(self, beam=structs.replace(beam, mass=(*beam.mass, *mass)))  # type: ignore[type-var]

    def _responses(
        self, loads: Any, frequencies: Array, modal_damping: float, rows: Sequence[tuple[Any, complex]] = ()
    ) -> ComplexArray:
        """Unknowns (n_frequencies, n, k) under dimensionless loads (n, k)."""
        check_number("modal_damping", modal_damping, "0 means none", at_least=0, below=1)
        omegas = 2.0 * pi * frequencies
        omega2 = (omegas / self._omega_unit) ** 2
        loss = self._shared_loss(omegas)
        if modal_damping and (loss is None or rows):
            raise InputError(
                f"modal_damping = {modal_damping!r} beside {'devices' if rows else 'a loss in a part of the stiffness'}"
                ": the modes would couple, give one of the two"
            )
        if modal_damping or (self._superposes(omegas) and not rows):
            found = self.stable_system.harmonic_sweep(loads, omega2, loss or 0.0, modal_damping)
            if (at := np.flatnonzero(np.isnan(found[:, 0, 0]))).size:
                raise self._at_resonance(float(frequencies[at[0]]))
            return found
        found = np.empty((len(omegas), *loads.shape), dtype=complex)
        for i, w2 in enumerate(omega2):
            try:
                found[i] = self.stable_system.harmonic(loads, float(w2), self.lossy_stiffness(float(omegas[i])), rows)
            except np.linalg.LinAlgError:
                raise self._at_resonance(float(frequencies[i])) from None
        return found

    def _shared_loss(self, omegas: Array) -> float | None:
        """The loss factor of every stiffness at every frequency; None where they differ and couple the modes."""
        first, last = (self.lossy_stiffness(float(omega)) for omega in (omegas[0], omegas[-1]))
        losses = np.imag(first / self.stable_system.stiffness)
        shared = np.ptp(losses) <= 1e-15 * (1.0 + losses.max()) and np.array_equal(first, last)
        return float(losses[0]) if shared else None

    def _superposes(self, omegas: Array) -> bool:
        """Whether all modes cost less than a factorisation for each frequency, and are not coupled."""
        return len(omegas) > FEW and self.stable_system.n <= SUPERPOSED and self._shared_loss(omegas) is not None

    def _at_resonance(self, frequency_hz: float) -> ResonanceError:
        return ResonanceError(
            f"frequency_hz = {frequency_hz!r} is an undamped resonance of the {self.name} model: give the beam a "
            "loss_factor or choose another frequency"
        )

    def _device_rows(self, devices: Sequence[Device], omega: float) -> list[tuple[Any, complex]]:
        """(row, dimensionless dynamic stiffness) of each device against deflection and rotation."""
        rows, stiffness = list[tuple[Any, complex]](), self.beam.bending_stiffness
        for device in devices:
            at = np.array([device.position])
            if (across := device.dynamic_stiffness(omega)) != 0.0:
                rows.append((self.device_rows(at), across * (self.unit**3 / stiffness)))
            if (turning := device.rotational_dynamic_stiffness(omega)) != 0.0:
                rows.append((self.load_rows(at, rotation=True), turning * (self.unit / stiffness)))
        return rows

    def _reactions(self, devices: Sequence[Device], unknowns: ComplexArray, omega: float) -> list[PointForce]:
        """Forces that devices exert on the beam, N."""
        across = [device for device in devices if device.dynamic_stiffness(omega) != 0.0]
        places = np.array([device.position for device in across])
        read = self.device_rows(places) @ unknowns if across else np.zeros(0)
        return [
            point_force(device.position, -device.dynamic_stiffness(omega) * complex(w))
            for device, w in zip(across, read, strict=True)
        ]

    def _field(
        self, unknowns: ComplexArray, frequency_hz: Any, forces: tuple[PointForce, ...], devices: Sequence[Device]
    ) -> HarmonicField:
        """The field of unknowns (n_frequencies, n), of one frequency where one is given."""
        line, rotation, one = self.line(unknowns.T), self.rotation_line(unknowns.T), np.ndim(frequency_hz) == 0

        def first(read: Callable[[Array, int], Any]) -> Callable[[Array, int], Any]:
            return (lambda x, derivative: read(x, derivative)[0]) if one else read

        return HarmonicField(
            model=self.name,
            count=self.count,
            beam=self.beam,
            frequency_hz=float(frequency_hz) if one else as_vector("frequency_hz", frequency_hz),
            forces=forces,
            shapes=first(line),
            theory=self.theory,
            rotation_shapes=None if rotation is None else first(rotation),
            couples=tuple(device.position for device in devices if device.turning),
        )

    def imposed(
        self, displacements: Forces, frequency_hz: float, *, devices: Device | Sequence[Device] = ()
    ) -> HarmonicField:
        """The steady field under imposed harmonic displacements: constraint rows of the system; see `BeamModel`.

        Chains read deflections by other weights than those of a force: the constraints are scaled to what is read.
        """
        drives, stationed = self.check_stationed(displacements, devices)
        if (cut := self._cut_at(stationed)) is not None:
            return structs.replace(cut.imposed(drives, frequency_hz, devices=stationed), beam=self.beam)
        omega = 2.0 * pi * float(frequencies_on(self.beam, frequency_hz)[0])
        places, own = np.array([drive.position for drive in drives]), [d.own_force for d in stationed if d.amplitude]
        rows, p = self.load_rows(places), len(drives)
        if np.linalg.matrix_rank(rows.toarray()) < len(drives):
            raise InputError(
                "drive.force.position: displacements are imposed at one place twice, or at a support without "
                "deflection: move one, or leave it out"
            )
        loads = self._loads((), own)
        try:
            responses, forces = self.stable_system.prescribed(
                rows,
                np.eye(p, p + 1),
                np.hstack([np.zeros((self.n_unknowns, p)), loads]),
                (omega / self._omega_unit) ** 2,
                self.lossy_stiffness(omega),
                self._device_rows(stationed, omega),
            )
        except np.linalg.LinAlgError:
            raise self._at_resonance(frequency_hz) from None
        read, scale = self.line(responses)(places, 0), self.beam.bending_stiffness / self.unit**3
        shares = np.linalg.solve(read[:p].T, np.array([phasor(drive) for drive in drives]) - read[p])
        unknowns, forces = (each @ np.append(shares, 1.0) for each in (responses, forces))
        holding = [point_force(at, force * scale) for at, force in zip(places.tolist(), forces, strict=True)]
        reactions = self._reactions(stationed, unknowns, omega)
        return self._field(unknowns[None], float(frequency_hz), (*holding, *own, *reactions), stationed)

    def receptance(self, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> ComplexArray:
        """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)), m/N."""
        at, frequencies = vector_on("positions", positions, self.beam.length), frequencies_on(self.beam, frequencies_hz)
        read, scale = vector_on("x", x, self.beam.length), self.unit**3 / self.beam.bending_stiffness
        loads = self.load_rows(at).toarray().T * scale
        omegas = 2.0 * pi * frequencies
        if self._superposes(omegas):
            # shapes are read once, of modes, and not of every response
            omega2, loss = (omegas / self._omega_unit) ** 2, self._shared_loss(omegas) or 0.0
            receptances, acting, responding = self.stable_system.modal_receptances(omega2, loss)
            weights, shapes = acting.T @ loads, self.line(responding)(read, 0)
            found = np.einsum("mp,fm,mx->fpx", weights, receptances, shapes, optimize=True)
            return np.asarray(found, dtype=complex)
        found = np.full((len(frequencies), len(at), len(read)), np.nan, dtype=complex)
        for i, omega in enumerate(omegas):
            try:
                response = self.stable_system.harmonic(
                    loads, float(omega / self._omega_unit) ** 2, self.lossy_stiffness(float(omega))
                )
            except np.linalg.LinAlgError:
                continue
            found[i] = self.line(response)(read, 0)
        return found

    def buckling_load(self) -> float:
        """The compression at which it buckles first, N, without shear; 0 where nothing keeps the beam from tilting."""
        if self._tilts:
            return 0.0
        load = float(self.beam.bending_stiffness / self.beam.length**2)
        beam = structs.replace(self.beam, tension=-load)
        compressed: DiscreteModel = replace(self, beam=beam, theory="euler-bernoulli")  # type: ignore[type-var]
        return load * compressed.system.buckling_factor()

    def time_basis(self, *, modes: int | None = None, line: str = "spline") -> TimeBasis:
        """All its modes for motion in time. Raises InputError for rigid-body motions, and for too many unknowns."""
        check_held(self.beam)
        check_word("line", line, self.lines)
        if modes is not None:
            raise InputError(f"modes = {modes!r} is for model = analytic: {self.name} keeps all it has, leave it out")
        values, vectors = self.stable_system.all_modes
        lossy = self.lossy_stiffness(1.0)
        ratios = None
        if self.beam.loss_factor and self.beam.lossless:
            # half of the loss factor times the share of what has loss in each mode's stiffness
            energies = self.stable_system.strain(vectors) ** 2
            ratios = 0.5 * (np.imag(lossy) @ energies) / (self.stable_system.stiffness @ energies)
        vectors = self.normalised(vectors)
        return TimeBasis(
            model=self.name,
            count=self.count,
            beam=self.beam,
            omegas=np.sqrt(values) * self._omega_unit,
            loads=lambda position: np.asarray((self.load_rows(np.array([position])) @ vectors)[0]),
            method="all modes",
            ratios=ratios,
            **self.time_line(vectors, line),
        )

    @abstractmethod
    def time_line(self, vectors: Array, line: str) -> dict[str, Any]:
        """Fields `shapes`, `edges`, `degree` and, where bodies rotate otherwise, `turns` of `TimeBasis`."""
