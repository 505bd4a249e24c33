"""What a model of a vibrating beam is: a name, words, a colour, and the verbs that it has."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

from verify.errors import InputError

if TYPE_CHECKING:
    from verify.arrays import Array, ComplexArray
    from verify.linear.fields import HarmonicField
    from verify.linear.modes import Modes
    from verify.linear.sweeps import HarmonicSweep
    from verify.linear.time_basis import TimeBasis
    from verify.problem.beam import Beam, PointForce

Setting = str | float


class Model:
    """A model: a subclass with a `name` and the verbs that it has. A verb that it has not is refused by name.

    One is registered by `MODELS.register(Mine())` or as an entry point of the group `verify.models`. `count` is the
    number of its parts; None, and nothing else, for a model that has none.
    """

    name: str
    """As a scene or a command line says it."""
    parts: str = "parts"
    """What a count of it counts: 'segments'."""
    title: str = ""
    """What a chart or a table calls it; its name unless given."""
    colour: str = "#8f5bd1"
    """Of its lines in charts."""
    sized: bool = True
    """Whether it has parts."""
    bounds: Literal["below", "above"] | None = None
    """On which side of the exact frequencies it is known to lie, uniform beams without a clamped end."""
    fewest: int = 1
    """Parts that it has at least."""
    modal_settings: tuple[str, ...] = ()
    """Keywords of its `solve_modes`: of wall, joints, grading."""
    field_settings: tuple[str, ...] = ()
    """Keywords of its `solve_harmonic`: of modal_damping, joint_dashpot, load, reading."""
    lines: tuple[str, ...] = ("spline",)
    """Contact lines that a slider may run on."""
    unknowns_per_part: int = 1
    """About."""
    library: str = ""
    """What it needs beside numpy and scipy, which a scene that does not ask for it does not load."""

    def __init_subclass__(cls) -> None:
        """One that has no title is called by its name."""
        cls.title = cls.title or getattr(cls, "name", "")

    def refuses(self, beam: "Beam") -> str:
        """Why it does not take a beam at all, so that studies leave it out; empty where it does."""
        return ""

    def can(self, verb: str) -> bool:
        """Whether it has a verb of its own."""
        return getattr(type(self), verb) is not getattr(Model, verb)

    def check(self, beam: "Beam", n_modes: int, count: int, **settings: Any) -> None:
        """Raise InputError for modes that it cannot solve, before any work on them."""
        if n_modes > self.n_elastic(beam, count):
            raise InputError(
                f"mode = {n_modes}: the {self.name} model at count = {count} has {self.n_elastic(beam, count)} elastic "
                "modes, raise count"
            )

    def n_elastic(self, beam: "Beam", count: int, **settings: Any) -> int:
        """How many elastic modes it has; rigid motions are none."""
        return self.unknowns(beam, count, **settings) - beam.rigid_motions

    def unknowns(self, beam: "Beam", count: int, **settings: Any) -> int:
        """How many unknowns are solved for."""
        return self.unknowns_per_part * count

    def order(self, beam: "Beam", **settings: Any) -> int | None:
        """The order in the number of parts at which its frequencies converge on a beam; None where nobody says."""
        return None

    def solve_modes(self, beam: "Beam", n_modes: int, count: int, **settings: Any) -> "Modes":
        """The first elastic modes. Raises InputError."""
        raise self._has_no("solve_modes", "modes")

    def solve_harmonic(
        self, beam: "Beam", forces: "Sequence[PointForce]", frequency_hz: float, count: int | None, **settings: Any
    ) -> "HarmonicField":
        """The steady field under harmonic forces. Raises InputError."""
        raise self._has_no("solve_harmonic", "harmonic fields")

    def sweep_harmonic(
        self, beam: "Beam", forces: "Sequence[PointForce]", frequencies_hz: "Array", count: int | None, **settings: Any
    ) -> "HarmonicSweep":
        """The fields at many frequencies, one after another unless a model knows better. Raises InputError."""
        from verify.linear.sweeps import one_by_one

        fields = [self.solve_harmonic(beam, forces, float(f), count, **settings) for f in frequencies_hz]
        return one_by_one(fields)

    def unit_responses(
        self,
        beam: "Beam",
        positions: "Sequence[float]",
        frequencies_hz: "Array",
        x: "Array",
        count: int | None,
        **settings: Any,
    ) -> "ComplexArray":
        """Deflection at x under a unit force at each position, (n_f, n_positions, len(x)), m/N. Raises InputError."""
        raise self._has_no("unit_responses", "fields of unit forces")

    def time_basis(self, beam: "Beam", count: int | None, modes: int, line: str) -> "TimeBasis":
        """Its free modes for motion in time; an endless model keeps the first `modes`. Raises InputError."""
        raise self._has_no("time_basis", "motion in time")

    def buckling_load(self, beam: "Beam", count: int | None, **settings: Any) -> float:
        """The compression at which it buckles first, newton. Raises InputError."""
        raise self._has_no("buckling_load", "buckling load")

    def wavenumber(self, beam: "Beam", count: int, frequency_hz: float) -> complex:
        """At which waves run in it, 1/m; that of the beam itself unless a model knows its own. Raises InputError.

        By Euler-Bernoulli's theory, without axial force and ground: under these and by another theory nobody asks for
        it, and waves are measured with the beam's wavenumber, whose difference from the model's shows as reflection.
        """
        from verify.linear.fields import wavenumber

        return wavenumber(beam, frequency_hz)

    def check_carried(self, beam: "Beam", count: int, frequency_hz: float) -> None:
        """Raise NoFigureError for a frequency at which no wave runs along its parts."""

    def _has_no(self, verb: str, what: str) -> InputError:
        from verify.linear.catalogue import MODELS

        able = ", ".join(model.name for model in MODELS.values() if model.can(verb))
        return InputError(f"model = {self.name!r} has no {what} ({verb}): choose one of {able}")
