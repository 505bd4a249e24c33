"""Run time against error of every method that a scene gives something to do."""

from typing import TYPE_CHECKING, Annotated, TypeAlias

import msgspec
from msgspec import Meta

from verify.checks import check_number
from verify.errors import InputError
from verify.judge.variants import every_rule
from verify.models.catalogue import discrete
from verify.options import BENCH_SETS, BenchSet
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.bench.found import BenchFound
    from verify.judge.workbench import Need, Workbench
    from verify.scenes.scene import Scene
    from verify.studies.told import Found

Counts: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=2)], ...], Meta(min_length=1)]
Modes: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(min_length=1)]
COUNTS, MODES, CHAIN = (24, 49, 98, 196), (1, 5, 22), (49,)
PERIODS = 4.0
"""Of the drive, that a motion lasts where the scene does not say how long."""


class Bench(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for run time against error: of modes, harmonic fields, motions in time, sliders and nonlinear chains."""

    sets: Annotated[tuple[BenchSet, ...], Meta(min_length=1)] | None = None
    """What methods are compared in; all that the scene asks for unless given."""
    counts: Counts | None = None
    """Segments and elements; those of the scene's [convergence] or [motion] unless given."""
    modes: Modes | None = None
    """Which modes; those of the scene's [convergence] unless given."""
    duration: float | None = None
    """Seconds of beams and chains in time; the scene's [motion], else four periods of the drive, unless given. The
    slider's own run lasts as its [motion] says."""
    x: float | None = None
    """Metres from the left end where motions are read; mid-span unless given."""
    seconds: float = 20.0
    """Of work, estimated: the largest that does not fit is left out, and named."""
    rounds: Annotated[int, Meta(ge=3, le=99)] = 9
    """In which all methods take turns, at most."""
    peers: bool = True
    """Whether other engines take part, where they are installed."""
    push: bool = False
    """Whether other engines are pushed until they break, at each number of links: up to a minute each."""
    imports: bool = True
    """Whether imports are timed, in processes of their own."""
    cold: bool = False
    """Whether compiling is timed, in processes of their own with nothing kept on disk."""

    def __post_init__(self) -> None:
        check_number("bench.seconds", self.seconds, "seconds", above=0)
        if self.duration is not None:
            check_number("bench.duration", self.duration, "seconds", above=0)
        if self.x is not None:
            check_number("bench.x", self.x, "metres", above=0)
        for name in ("sets", "counts", "modes"):
            given = getattr(self, name) or ()
            if len(set(given)) != len(given):
                raise InputError(f"bench.{name} = {list(given)!r} names one twice: give each once")


class Settled(msgspec.Struct, frozen=True, kw_only=True):
    """What is asked with the scene's own in place of what is not given."""

    sets: tuple[BenchSet, ...]
    counts: tuple[int, ...]
    chains: tuple[int, ...]
    """Links of the nonlinear chains."""
    modes: tuple[int, ...]
    duration: float
    x: float
    peers: bool


def settled(asked: Bench, scene: "Scene") -> Settled:
    """What a scene's [bench] comes to. Raises InputError for a drive with devices."""
    scene.refuse_devices("a bench")
    convergence, axial = getattr(scene, "convergence", None), getattr(scene, "axial_inertia", None)
    duration = scene.motion.duration if scene.motion else getattr(axial, "duration", None)
    if duration is None and scene.drive:
        duration = PERIODS / scene.drive.frequency_hz
    own = convergence.counts if convergence else scene.motion.counts if scene.motion else COUNTS
    asking = next((one for one in (axial, scene.motion, getattr(scene, "motor", None)) if one), None)
    chain = (asking.count,) if asking else CHAIN
    return Settled(
        sets=asked.sets or tuple(name for name in BENCH_SETS if not unasked(name, scene)),  # type: ignore[misc]
        counts=tuple(sorted(asked.counts or (n for n in own if n > 1))),
        chains=tuple(sorted(asked.counts or chain)),
        modes=asked.modes or (convergence.modes if convergence else MODES),
        duration=asked.duration or duration or 0.0,
        x=asked.x if asked.x is not None else 0.5 * scene.beam.length,
        peers=asked.peers,
    )


def unasked(name: str, scene: "Scene") -> str:
    """Why a set is left out that nobody names; empty where the scene has what it takes."""
    driven = scene.drive is not None and any(force.amplitude for force in scene.drive.force)
    if name in ("harmonic", "transient") and not driven:
        return "nothing drives the beam"
    if name == "slider" and (scene.slider is None or scene.motion is None):
        return f"the scene has no [{'slider' if scene.slider is None else 'motion'}]"
    if name == "chain" and not _chained(scene):
        return "nothing in the scene asks for the nonlinear chain: name it in sets"
    return "nothing drives the beam" if name == "chain" and not driven else ""


def _chained(scene: "Scene") -> bool:
    """Whether a study or a gate of a scene asks for the nonlinear chain."""
    motor = getattr(scene, "motor", None)
    studied = getattr(scene, "axial_inertia", None) is not None or (motor is not None and "chain" in motor.models)
    return studied or any(gate.quantity.startswith("chain.") for gate in scene.gate)


class BenchStudy(Study[Bench, "BenchFound"]):
    """Every set in turn: its reference, first calls, then rounds in which its methods take turns."""

    name, section, work = "bench", Bench, "modes"
    title = "Run time against error"

    def check_on(self, asked: Bench, scene: "Scene") -> None:
        """Raise InputError for a place off the beam."""
        if asked.x is not None and asked.x >= scene.beam.length:
            raise InputError(f"bench.x = {asked.x!r} lies off the beam: give less than {scene.beam.length!r} m")

    def needs(self, asked: Bench, scene: "Scene") -> "tuple[Need, ...]":
        """Of modes, each model at each size, with every rule of the chain that makes a difference."""
        from verify.judge.variants import Variant
        from verify.judge.workbench import Need

        its = settled(asked, scene)
        if "modes" not in its.sets:
            return ()
        every = (*(Variant(m.name) for m in discrete("solve_modes", scene.beam)), *every_rule(scene.beam))
        return tuple(Need(one.model, n, max(its.modes), one.settings) for n in its.counts for one in every)

    def models(self, asked: Bench, scene: "Scene") -> tuple[str, ...]:
        """All."""
        return tuple(model.name for model in discrete("solve_modes", scene.beam))

    def told(self, asked: Bench, scene: "Scene") -> str:
        """Which sets, at which sizes, for how long at most."""
        its = settled(asked, scene)
        sizes = ", ".join(str(n) for n in its.counts)
        return f"{', '.join(its.sets)} at N = {sizes}, about {asked.seconds:g} s of work at most"

    def n_steps(self, asked: Bench, scene: "Scene") -> int:
        """One for each set, for the processes of their own, and for pushing."""
        return len(settled(asked, scene).sets) + int(asked.imports) + int(asked.cold) + int(asked.push)

    def run(
        self, asked: Bench, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "BenchFound":
        """See `benched`."""
        from verify.bench.running import benched

        return benched(asked, scene, bench, step)
