"""`BeamModel`, the interface of all models of a vibrating beam: a beam, a size, settings, and methods."""

from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import fields
from functools import cache
from typing import Any, ClassVar, Literal, TypeAlias

import numpy as np

from verify.arrays import ComplexArray
from verify.blas import one_blas_thread
from verify.errors import InputError
from verify.linear.field import HarmonicField, wavenumber
from verify.linear.modes import Modes
from verify.linear.positions import Forces, Kind, Loads, Numbers, loads_on
from verify.linear.time_basis import TimeBasis
from verify.problem.beam import Beam, PointForce, PointLoad
from verify.problem.device import Device
from verify.settings import DEFAULT, check_setting
from verify.validation import as_tuple, check_type

Devices: TypeAlias = Device | Sequence[Device]  # One device, or several

VERBS = ("modes", "harmonic", "imposed", "receptance", "time_basis", "buckling_load")
"""Methods of a model that compute."""
_NEEDS = {"rayleigh": ("rotary_inertia",), "timoshenko": ("rotary_inertia", "shear_stiffness")}


class BeamModel(ABC):
    """A model of one beam. Subclasses are frozen dataclasses: `beam`, the number of parts if any, then settings.

    Another package registers a model by `MODELS.register(cls)` or an entry point of the group `verify.models`. A method
    that a model does not override raises InputError. The `VERBS` of every model run with one thread of BLAS.
    """

    name: ClassVar[str]
    """Name in scenes and on the command line."""
    parts: ClassVar[str] = "parts"
    """Name of the parts that `count` counts, for instance 'segments'."""
    title: ClassVar[str] = ""
    """Title in charts and tables; default: the name."""
    colour: ClassVar[str] = "#8f5bd1"
    """Line colour in charts."""
    sized: ClassVar[bool] = True
    """Whether the model is discrete."""
    bounds: ClassVar[Literal["below", "above"] | None] = None
    """Side of the exact frequencies on which its own lie, for uniform beams of equal parts without a clamped end."""
    fewest: ClassVar[int] = 1
    """Smallest number of parts."""
    library: ClassVar[str] = ""
    """Package that the model needs besides numpy and scipy."""
    lines: ClassVar[tuple[str, ...]] = ("spline",)
    """Contact lines on which a slider can run."""
    beam: Beam
    theory: str = DEFAULT.theory

    def __init_subclass__(cls) -> None:
        """The default title is the name; methods that compute have one thread of BLAS."""
        cls.title = cls.title or getattr(cls, "name", "")
        for verb in VERBS:
            if verb in vars(cls):
                setattr(cls, verb, one_blas_thread()(vars(cls)[verb]))

    def __post_init__(self) -> None:
        """Raise InputError for an unknown setting, and for missing section properties of the theory."""
        check_type("beam", self.beam, Beam)
        for name in self.settings():
            if (value := getattr(self, name)) is not getattr(type(self), name, None):  # a default is valid
                check_setting(name, value)
        if self.theory != "euler-bernoulli" and self.beam.tension:
            raise InputError(
                f"beam.tension = {self.beam.tension!r} N with theory = {self.theory!r}: the theory is not unique, "
                "leave the axial force out or choose euler-bernoulli"
            )
        for i, piece in enumerate(self.beam.pieces):
            for figure in _NEEDS.get(self.theory, ()):
                if getattr(piece, figure) is None:
                    where = f"beam.section[{i}]" if self.beam.section else "beam"
                    raise InputError(
                        f"{where}.{figure} is missing: theory = {self.theory!r} needs it, give it, or a shape with its "
                        "sizes, youngs_modulus and density"
                    )

    @classmethod
    def build(cls, beam: Beam, count: int | None = None, **settings: Any) -> "BeamModel":
        """The model of a beam with `count` parts, None for the exact beam. Raises InputError."""
        cls.check_count(count)
        for name, value in settings.items():
            if name not in cls.settings():
                raise InputError(f"{name} = {value!r} is not a setting of the {cls.name} model: leave it out")
        return cls(beam, count, **settings) if cls.sized else cls(beam, **settings)  # type: ignore[call-arg]

    @classmethod
    def check_count(cls, count: int | None) -> None:
        """Raise InputError for a discrete model without a number of parts, or the exact beam with one."""
        if cls.sized == (count is None):
            raise InputError(
                f"count is missing: give the number of {cls.parts} for model = {cls.name}"
                if cls.sized
                else f"count = {count!r} is for discrete models: leave it out for model = {cls.name}"
            )

    @classmethod
    @cache
    def settings(cls) -> tuple[str, ...]:
        """Names of the settings: the fields after the beam and the number of parts."""
        return tuple(field.name for field in fields(cls))[1 + cls.sized :]  # type: ignore[arg-type]

    @classmethod
    def can(cls, verb: str) -> bool:
        """Whether the model implements a method of this interface."""
        return getattr(cls, verb) is not getattr(BeamModel, verb)

    @property
    def count(self) -> int | None:
        """Number of parts; None for the exact beam."""
        return None

    @property
    @abstractmethod
    def n_elastic(self) -> int:
        """Number of elastic modes; rigid-body motions are not counted."""

    def modes(self, n_modes: int) -> Modes:
        """The first elastic modes. Raises InputError."""
        raise self._has_no("modes")

    def harmonic(
        self, forces: Loads, frequency_hz: Numbers, *, devices: Devices = (), modal_damping: float = 0.0
    ) -> HarmonicField:
        """The steady field under harmonic point forces and moments, e^{+i omega t}, at one frequency or many.

        `devices` are impedances on the beam (one frequency only). Damping: the beam's loss factor, or `modal_damping`,
        the damping ratio of every mode. Raises InputError, and ResonanceError at an undamped resonance.
        """
        raise self._has_no("harmonic")

    def imposed(self, displacements: Forces, frequency_hz: float, *, devices: Devices = ()) -> HarmonicField:
        """The steady field under imposed harmonic displacements, amplitudes in m; their forces are the first `forces`.

        Raises InputError for two at one position or one at a support without deflection, and ResonanceError.
        """
        raise self._has_no("imposed")

    def receptance(self, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> ComplexArray:
        """Deflection at x under a unit force at each position, (n_frequencies, n_positions, len(x)), m/N.

        NaN at the frequencies of undamped resonances. Raises InputError.
        """
        raise self._has_no("receptance")

    def time_basis(self, *, modes: int | None = None, line: str = "spline") -> TimeBasis:
        """Free modes for motion in time; of the exact beam the first `modes`. Raises InputError."""
        raise self._has_no("time_basis")

    def buckling_load(self) -> float:
        """Lowest buckling load in compression, Euler-Bernoulli theory, N; the beam's own axial force is ignored."""
        raise self._has_no("buckling_load")

    def expected_order(self) -> int | None:
        """Order of convergence of the frequencies in the number of parts; None if unknown."""
        return None

    def wavenumber(self, frequency_hz: float) -> complex:
        """Wavenumber of waves in the model, 1/m; default: that of the exact beam of the same theory."""
        return wavenumber(self.beam, frequency_hz, self.theory)

    def check_propagates(self, frequency_hz: float) -> None:  # noqa: B027
        """Raise NoFigureError for a frequency above the cut-off of the parts."""

    def cut_at(self, positions: Iterable[float]) -> "BeamModel":
        """The model for moments or actuators at positions, m: elements with nodes, chains with elastic ends there."""
        return self

    def check_stationed(
        self,
        forces: Kind | Sequence[Kind],
        devices: Devices,
        frequency_hz: Numbers,
        kind: type[Kind] = PointLoad,  # type: ignore[assignment]
    ) -> tuple[tuple[Kind, ...], tuple[Device, ...]]:
        """(loads, devices) as tuples. Raises InputError for no loads, no effect, and what takes one frequency alone."""
        acting, stationed = loads_on(self.beam, forces, kind), as_tuple("devices", devices, Device)
        for device in stationed:
            device.check_on("device", self.beam.length, self.beam.supports)
        if not acting and not any(device.amplitude for device in stationed):
            raise InputError(
                "no forces or displacements and no device with an amplitude: give a PointForce, or a device a force"
            )
        if np.ndim(frequency_hz) and (stationed or kind is PointForce):
            raise InputError("frequency_hz has several values: give one with devices or imposed displacements")
        return acting, stationed

    def _has_no(self, verb: str) -> InputError:
        return InputError(
            f"model = {self.name!r} has no {verb.replace('_', ' ')}: choose analytic, segment or fem, which have all"
        )
