"""`BeamModel`, the interface of every model of a vibrating beam: a beam, a size, settings, and verbs."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import fields
from typing import Any, ClassVar, Literal, TypeAlias

from verify.arrays import ComplexArray
from verify.errors import InputError
from verify.linear.field import HarmonicField, wavenumber
from verify.linear.modes import Modes
from verify.linear.positions import Forces, Numbers, forces_on
from verify.linear.time_basis import TimeBasis
from verify.options import THEORIES
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device
from verify.validation import as_tuple, check_choice, check_integer, check_type

Devices: TypeAlias = Device | Sequence[Device]
"""One device alone stands for a list of it."""

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
        self, forces: Forces, frequency_hz: Numbers, *, devices: Devices = (), modal_damping: float = 0.0
    ) -> HarmonicField:
        """The steady field under harmonic point forces, e^{+i omega t}, at one frequency or many.

        `devices` are impedances on the beam, at one frequency. Damping: the beam's loss factor, or `modal_damping`,
        the ratio of every mode. Raises InputError, and ResonanceError at an undamped resonance.
        """
        raise self._has_no("harmonic")

    def imposed(self, displacements: Forces, frequency_hz: float, *, devices: Devices = ()) -> HarmonicField:
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
        """Wavenumber of waves in it, 1/m; by default that of the exact beam of the same theory."""
        return wavenumber(self.beam, frequency_hz, self.theory)

    def check_propagates(self, frequency_hz: float) -> None:  # noqa: B027
        """Raise NoFigureError for a frequency above the cut-off of its parts."""

    def check_n_modes(self, n_modes: int) -> None:
        """Raise InputError unless it has so many elastic modes."""
        check_integer("n_modes", n_modes, 1)
        if n_modes > self.n_elastic:
            raise InputError(
                f"n_modes = {n_modes}: the {self.name} model at count = {self.count} has {self.n_elastic} elastic "
                "modes, raise count"
            )

    def check_theory(self) -> None:
        """Raise InputError for an unknown theory, and for one that the beam has no figures for."""
        check_type("beam", self.beam, Beam)
        check_choice("theory", self.theory, THEORIES)
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

    def check_stationed(self, forces: Forces, devices: Devices) -> tuple[tuple[PointForce, ...], Any]:
        """(forces, devices) as tuples. Raises InputError for one off the beam or without effect, and for none."""
        acting, stationed = forces_on(self.beam, forces), as_tuple("devices", devices, Device)
        for device in stationed:
            device.check_on(self.beam)
        if not acting and not any(device.amplitude for device in stationed):
            raise InputError(
                "no forces or displacements and no device with an amplitude: give a PointForce, or a device a force"
            )
        return acting, stationed

    def _has_no(self, verb: str) -> InputError:
        from verify.linear.registry import MODELS

        able = ", ".join(model.name for model in MODELS.values() if model.can(verb))
        return InputError(f"model = {self.name!r} has no {verb.replace('_', ' ')}: choose one of {able}")
