"""The three models that come with the package, as the registry holds them: verbs, words, and the laws known of them."""

from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar, cast

from verify.errors import InputError
from verify.linear.kind import Model

if TYPE_CHECKING:
    from types import ModuleType

    from verify.arrays import Array, ComplexArray
    from verify.linear.fields import HarmonicField
    from verify.linear.modes import Modes
    from verify.linear.sweeps import HarmonicSweep
    from verify.linear.time_basis import TimeBasis
    from verify.problem.beam import Beam, PointForce


Verb = TypeVar("Verb", bound=Callable[..., Any])


class Exact(Model):
    """The exact beam, which has no parts."""

    name = "analytic"
    parts = title = "exact beam"
    colour = "#8a8f98"
    sized = False
    modal_settings = field_settings = ("theory",)

    def check(self, beam: "Beam", n_modes: int, count: int = 0, **settings: Any) -> None:
        """Raise InputError for a theory that the beam has not the figures for, and for one that has buckled."""
        from verify.linear.theory import check_theory

        check_theory(beam, settings.get("theory", "euler-bernoulli"))
        if beam.tension < 0.0:
            from verify.exact.buckling import check_stable

            check_stable(beam)

    def solve_modes(self, beam: "Beam", n_modes: int, count: int | None = None, **settings: Any) -> "Modes":
        """In closed form, or by the characteristic equation."""
        from verify.exact.modes import solve_modes

        return solve_modes(beam, n_modes, **settings)

    def solve_harmonic(
        self, beam: "Beam", forces: "Sequence[PointForce]", frequency_hz: float, count: int | None, **settings: Any
    ) -> "HarmonicField":
        """In closed form."""
        from verify.exact.harmonic import solve_harmonic

        return solve_harmonic(beam, forces, frequency_hz, **settings)

    def sweep_harmonic(
        self, beam: "Beam", forces: "Sequence[PointForce]", frequencies_hz: "Array", count: int | None, **settings: Any
    ) -> "HarmonicSweep":
        """All at once."""
        from verify.exact.harmonic import sweep_harmonic

        return sweep_harmonic(beam, forces, frequencies_hz, **settings)

    def unit_responses(
        self,
        beam: "Beam",
        positions: "Sequence[float]",
        frequencies_hz: "Array",
        x: "Array",
        count: int | None,
        **settings: Any,
    ) -> "ComplexArray":
        """In closed form."""
        from verify.exact.harmonic import unit_responses

        return unit_responses(beam, positions, frequencies_hz, x, **settings)

    def time_basis(self, beam: "Beam", count: int | None, modes: int, line: str) -> "TimeBasis":
        """The first modes, the rest following at once."""
        from verify.exact.in_time import time_basis

        return time_basis(beam, modes)

    def buckling_load(self, beam: "Beam", count: int | None, **settings: Any) -> float:
        """By the characteristic equation at rest."""
        from verify.exact.buckling import buckling_load

        return buckling_load(beam)


def named_count(verb: Verb) -> Verb:
    """A model's verb whose refusals name `count`, which its user wrote, where its module has a word of its own."""

    @wraps(verb)
    def named(self: "Discrete", *given: Any, **more: Any) -> Any:
        try:
            return verb(self, *given, **more)
        except InputError as error:
            if self.field not in str(error):
                raise
            raise type(error)(str(error).replace(self.field, "count")) from None

    return cast(Verb, named)


class Discrete(Model):
    """A model of parts whose verbs are the functions of a module, and whose dispersion is known."""

    home: str
    """The module of modes and fields."""
    field: str
    """What that module calls the number of its parts."""
    size_settings: tuple[str, ...] = ()
    """Settings that its number of unknowns depends on."""

    @property
    def verbs(self) -> "ModuleType":
        """That module, imported when first asked for."""
        from importlib import import_module

        return import_module(self.home)

    @named_count
    def check(self, beam: "Beam", n_modes: int, count: int, **settings: Any) -> None:
        """Raise InputError for modes that it cannot solve."""
        self.verbs.check(beam, n_modes, count, **settings)

    def _of_size(self, settings: dict[str, Any]) -> dict[str, Any]:
        return {name: value for name, value in settings.items() if name in self.size_settings}

    @named_count
    def n_elastic(self, beam: "Beam", count: int, **settings: Any) -> int:
        """How many elastic modes it has."""
        return int(self.verbs.n_elastic(beam, count, **self._of_size(settings)))

    def unknowns(self, beam: "Beam", count: int, **settings: Any) -> int:
        """How many unknowns are solved for."""
        return int(self.verbs.unknowns(beam, count, **self._of_size(settings)))

    @named_count
    def solve_modes(self, beam: "Beam", n_modes: int, count: int, **settings: Any) -> "Modes":
        """The first elastic modes."""
        found: Modes = self.verbs.solve_modes(beam, n_modes, count, **settings)
        return found

    @named_count
    def solve_harmonic(
        self, beam: "Beam", forces: "Sequence[PointForce]", frequency_hz: float, count: int | None, **settings: Any
    ) -> "HarmonicField":
        """The steady field under harmonic forces."""
        found: HarmonicField = self.verbs.solve_harmonic(beam, forces, frequency_hz, count, **settings)
        return found

    @named_count
    def sweep_harmonic(
        self, beam: "Beam", forces: "Sequence[PointForce]", frequencies_hz: "Array", count: int | None, **settings: Any
    ) -> "HarmonicSweep":
        """All at once."""
        found: HarmonicSweep = self.verbs.sweep_harmonic(beam, forces, frequencies_hz, count, **settings)
        return found

    @named_count
    def unit_responses(
        self,
        beam: "Beam",
        positions: "Sequence[float]",
        frequencies_hz: "Array",
        x: "Array",
        count: int | None,
        **settings: Any,
    ) -> "ComplexArray":
        """By all modes at once."""
        found: ComplexArray = self.verbs.unit_responses(beam, positions, frequencies_hz, x, count, **settings)
        return found

    def wavenumber(self, beam: "Beam", count: int, frequency_hz: float) -> complex:
        """By its discrete dispersion, which is known of Euler-Bernoulli beams that nothing pulls or carries."""
        from verify.exact.error_laws import discrete_wavenumber

        return discrete_wavenumber(self.name, beam, count, frequency_hz)

    def check_carried(self, beam: "Beam", count: int, frequency_hz: float) -> None:
        """Raise NoFigureError beyond the end of its dispersion."""
        from verify.exact.error_laws import check_carried

        check_carried(self.name, beam, count, frequency_hz)


class Segments(Discrete):
    """Rigid links and joint springs."""

    name, home, field = "segment", "verify.segments.linear", "n_segments"
    parts = title = "segments"
    colour = "#2f80ed"
    bounds = "below"
    fewest = 2
    size_settings = ("theory", "attachment")
    modal_settings = ("wall", "joints", "grading", "theory", "attachment")
    field_settings = ("modal_damping", "joint_dashpot", "load", "reading", "wall", "joints", "theory", "attachment")
    lines = ("spline", "raw")

    @named_count
    def buckling_load(self, beam: "Beam", count: int | None, **settings: Any) -> float:
        """Of its joints under the links' turns."""
        from verify.segments.buckling import buckling_load

        assert count is not None
        return buckling_load(beam, count, **settings)

    def order(self, beam: "Beam", **settings: Any) -> int | None:
        """4 on equal links between pinned, guided, free and Gregory's ends; less by each rule that is of a lower one.

        As measured and derived in `segments.orders`, `.loaded` and `.attached`, and held in their tests.
        """
        from verify.segments.orders import order_of

        return order_of(beam, **settings)

    @named_count
    def time_basis(self, beam: "Beam", count: int | None, modes: int, line: str) -> "TimeBasis":
        """All its modes."""
        from verify.segments.in_time import time_basis

        assert count is not None
        return time_basis(beam, count, line=line)  # type: ignore[arg-type]


class Elements(Discrete):
    """Hermite beam elements."""

    name, home, field = "fem", "verify.elements.linear", "n_elements"
    parts, title = "elements", "Hermite elements"
    colour = "#e8760c"
    bounds = "above"
    modal_settings = ("grading", "theory")
    field_settings = ("modal_damping", "theory")
    unknowns_per_part = 2
    size_settings = ("theory",)
    library = "scikit-fem"

    @named_count
    def buckling_load(self, beam: "Beam", count: int | None, **settings: Any) -> float:
        """Of the mesh."""
        from verify.elements.linear import buckling_load

        assert count is not None
        return buckling_load(beam, count, **settings)

    def order(self, beam: "Beam", **settings: Any) -> int | None:
        """4: nodes stand on the steps."""
        return 4

    @named_count
    def time_basis(self, beam: "Beam", count: int | None, modes: int, line: str) -> "TimeBasis":
        """All its modes."""
        from verify.elements.in_time import time_basis

        assert count is not None
        return time_basis(beam, count)
