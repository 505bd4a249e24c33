"""Named figures of energy in time, and of a beam that is let go from a shape."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from msgspec import Meta

from verify import options
from verify.checks import Relative
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import compiled
from verify.quantities.chain_arguments import Chained
from verify.quantities.kind import Arguments, MovingModel, Quantity, Size, check_count
from verify.quantities.motion_arguments import InTime

if TYPE_CHECKING:
    from verify.motion.free_vibration import FreeVibration
    from verify.scenes.scene import Scene

SAMPLES = 32
"""Of a motion that waves are measured of, in each period."""


class Shaken(Chained, frozen=True, kw_only=True):
    """A clamped chain on which a base that turns, a load, an actuator and dashpots work."""

    reads: ClassVar[tuple[str, ...]] = ()
    tip: Annotated[options.Tip, Meta(description="free, or a roller on an axial spring")] = "free"
    tolerance: Annotated[float, Meta(gt=0, lt=0.1, description="of the adaptive step")] = 1e-9


class Booked(InTime, frozen=True, kw_only=True):
    """A line of the books of the driven beam from rest."""

    of: Annotated[
        Literal["work_in", "kinetic", "elastic", "damped"],
        Meta(description="work of the forces from the start; what is in the beam at `time`; what it lost until then"),
    ]


class Released(Arguments, frozen=True, kw_only=True):
    """The scene's beam let go at rest from two straight lines, or thrown with speeds along them."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    model: MovingModel = "segment"
    count: Size | None = None
    modes: Annotated[int, Meta(ge=1, description="the exact beam keeps; default 400")] | None = None
    place: Annotated[float, Meta(gt=0, description="where the lines meet, metres; at both ends they are 0")]
    height: Annotated[float, Meta(description="of the lines there, metres, at t = 0")] = 0.0
    speed: Annotated[float, Meta(description="of the lines there, m/s, at t = 0")] = 0.0
    time: Annotated[float, Meta(gt=0, description="seconds from the release")]
    modal_damping: (
        Annotated[Relative, Meta(ge=0, lt=1, description="ratio of every mode; default what the loss factor comes to")]
        | None
    ) = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        if self.modes is not None and self.count is not None:
            raise InputError(
                f"modes = {self.modes!r} is for model = analytic: {self.model} keeps all it has, leave it out"
            )


class ReleasedAt(Released, frozen=True, kw_only=True):
    """A place on it."""

    places: ClassVar[tuple[str, ...]] = ("x",)
    x: Annotated[float, Meta(description="metres from the left end")]


class ReleasedEnergy(Released, frozen=True, kw_only=True):
    """What is in it."""

    of: Annotated[Literal["kinetic", "elastic"], Meta(description="which part of the energy")]


class MeasuredInTime(InTime, frozen=True, kw_only=True):
    """Waves measured of a motion, from its end back over whole periods: all, its start with them, unless given."""

    window: Annotated[tuple[float, float], Meta(description="metres, start and end")]
    points: Annotated[int, Meta(ge=4, le=2000, description="evenly spaced, that are watched")] = 40
    periods: (
        Annotated[int, Meta(ge=1, description="the last so many of the drive, all of them unless given")] | None
    ) = None


def between_forces(a: MeasuredInTime, scene: "Scene") -> tuple[()]:
    """Raise InputError for a window in which two waves are not alone."""
    from verify.quantities.simulated import motion_case
    from verify.waves.window import check_window

    case = motion_case(a, scene)
    check_window(scene.beam, [force.position for force in case.forces], case.frequency_hz, a.window)
    return ()


def _reflection(a: MeasuredInTime, scene: "Scene", bench: Workbench) -> float:
    import numpy as np

    from verify.models.places import places
    from verify.quantities.simulated import motion_case
    from verify.waves.series import measure_series

    between_forces(a, scene)
    case, (start, end) = motion_case(a, scene), a.window
    x = places("window", np.linspace(start, end, a.points), scene.beam.length)
    samples = int(SAMPLES * case.duration * case.frequency_hz) + 1
    run = case.run(at=[float(one) for one in x], samples=samples)
    all_of_it = case.duration * case.frequency_hz
    if a.periods is not None and a.periods > all_of_it:
        raise InputError(
            f"periods = {a.periods!r}: the motion has {all_of_it:.4g} of them, give fewer or a longer time"
        )
    last = samples if a.periods is None else SAMPLES * a.periods
    return measure_series(scene.beam, x, run.times[-last:], run.deflection[-last:], case.frequency_hz).reflection


def _booked(a: Booked, scene: "Scene", bench: Workbench) -> float:
    from verify.quantities.simulated import motion_case

    case = motion_case(a, scene)
    key = ("books", case)
    if key not in bench.motions:
        bench.motions[key] = case.run(ledger=True)
    books = bench.motions[key].ledger
    if books is None:
        raise InputError(f"start = {case.start!r}: a beam in its steady state is not booked, give start = 'rest'")
    return float(getattr(books, a.of))


def _shaken_imbalance(a: Shaken, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.shaken_imbalance(a.links, a.tip, a.tolerance, bench.tell)


def _let_go(a: Released, scene: "Scene", at: tuple[float, ...]) -> "FreeVibration":
    from verify.motion.free_vibration import free_vibration

    length = scene.beam.length
    if not a.place < length:
        raise InputError(f"place = {a.place!r} lies off the beam: give a distance between 0 and {length!r} m")
    lines = ((0.0, a.place, length), (0.0, a.height, 0.0)), ((0.0, a.place, length), (0.0, a.speed, 0.0))
    if not (a.height or a.speed):
        raise InputError("height = 0.0 and speed = 0.0: give one of them, else nothing moves")
    return free_vibration(
        scene.beam,
        lines[0] if a.height else None,
        a.time,
        velocity=lines[1] if a.speed else None,
        model=a.model,
        count=a.count,
        modes=a.modes,
        modal_damping=a.modal_damping,
        at=at,
        samples=2,
    )


def _deflection(a: ReleasedAt, scene: "Scene", bench: Workbench) -> float:
    return float(_let_go(a, scene, (a.x,)).deflection[-1, 0])


def _energy(a: ReleasedEnergy, scene: "Scene", bench: Workbench) -> float:
    """Raises InputError for one that is the corner's, whose lines take ever more of it the more modes there are."""
    from verify.motion.free_vibration import CORNERED

    found = _let_go(a, scene, ())
    if (share := found.faster_half(a.of)) > CORNERED:
        raise InputError(
            f"time = {a.time!r} s: {100.0 * share:.2g} % of the {a.of} energy is then in the faster half of the modes, "
            "as where lines meet in a corner, and grows with their number; give modal_damping and a later time, or a "
            "speed alone, whose energy has an end"
        )
    return float(getattr(found, a.of)[-1])


ENERGY_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "motion.energy",
        "J",
        "A line of the books of the driven beam without a slider, from rest.",
        Booked,
        "in time",
        _booked,
    ),
    Quantity(
        "motion.released_deflection",
        "m",
        "Deflection of a beam that was let go from two straight lines, or thrown along them.",
        ReleasedAt,
        "in time",
        _deflection,
    ),
    Quantity(
        "motion.released_energy", "J", "Kinetic or elastic energy of such a beam.", ReleasedEnergy, "in time", _energy
    ),
    Quantity(
        "motion.reflection",
        "1",
        "Gamma of two waves fitted, wavenumber and all, to the phasors of the driven beam's motion in a window.",
        MeasuredInTime,
        "in time",
        _reflection,
        needs=between_forces,
    ),
    Quantity(
        "chain.imbalance",
        "1",
        "What the books miss of a chain that base, load and actuator shake, over what its dashpots lose.",
        Shaken,
        "in time",
        _shaken_imbalance,
        kernels=compiled.stepped,
    ),
)
