"""Other engines as methods of our sets: modes, the nonlinear chain, a slider under a step load.

What they are given and give is said in `verify.peers`; one that is missing is named, and the others go on.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Protocol, cast

from msgspec.structs import replace

from verify.bench.field_set import forces_of, relative_rms
from verify.bench.kind import Case, Entry, Judged, Line, Reference, Told
from verify.bench.study import Settled
from verify.errors import InputError
from verify.models.arrays import Array

if TYPE_CHECKING:
    from verify.beam import Beam, PointForce
    from verify.bench.chain_set import Chain
    from verify.scenes.scene import Scene
    from verify.slider import Slider

ROOM = "verify.peers"
FIRST_STEP, RUNGS = 1.0 / 12.0, 7
"""Of the drive's period, the longest step; and how often it is halved."""
STEP_LINK_S, START_S = 4e-6, 0.1
"""Of a step of one link, and of a model made, from above."""
LEAST_SAMPLES = 40
SAMPLES = 41
"""Of our own slider, so few that its longest step fits between two of them."""


class PeerRun(Protocol):
    """What an engine gave; see `verify.peers.case.PeerRun`."""

    times: Array
    deflection: Array
    distance: Array
    speed: Array
    seconds: float


class Adapter(Protocol):
    """An engine; see `verify.peers.catalogue.PeerAdapter`."""

    def frequencies(self, case: object) -> Array | None:
        """(n_modes,), Hz."""

    def prepare(self, case: object, sled: object | None) -> Callable[[float, float], PeerRun]:
        """(step, end), seconds -> a run from rest."""


class Catalogue(Protocol):
    """What of the room of engines is used here."""

    PEERS: Mapping[str, object]

    def installed(self, peer: Any) -> str | None:
        """Its version, None where it is not installed."""

    def adapter(self, peer: Any) -> Adapter:
        """The engine, imported now."""


class Cases(Protocol):
    """What engines are given."""

    def case_of(self, beam: "Beam", n: int, forces: "Sequence[PointForce]", frequency_hz: float) -> object:
        """A chain. Raises InputError for a beam that engines do not take."""

    def sled_of(self, beam: "Beam", slider: "Slider") -> object:
        """A slider. Raises InputError for one that does more than they are asked to."""


def catalogue() -> Catalogue | None:
    """The room of engines; None where there is none."""
    return cast(Catalogue, import_module(f"{ROOM}.catalogue")) if find_spec(ROOM) else None


def given() -> Cases:
    """How a beam and a slider are put to engines."""
    return cast(Cases, import_module(f"{ROOM}.case"))


def engines() -> tuple[dict[str, Adapter], tuple[str, ...]]:
    """(those that are installed, a sentence for each that is not)."""
    room = catalogue()
    found: dict[str, Adapter] = {}
    absent = []
    for name, peer in room.PEERS.items() if room else ():
        if room is None or room.installed(peer) is None:
            absent.append(f"{name} is skipped: it is not installed, pip install 'fem-segment-verify[peers]'")
            continue
        try:
            found[name] = room.adapter(peer)
        except InputError as error:
            absent.append(f"{name} is skipped: {error}")
    return found, tuple(absent)


def versions() -> dict[str, str]:
    """Of the engines that are installed, by name."""
    room = catalogue()
    found = {name: room.installed(peer) for name, peer in room.PEERS.items()} if room else {}
    return {name: version for name, version in found.items() if version}


def frequency_entries(scene: "Scene", its: Settled) -> tuple[tuple[Entry, ...], tuple[str, ...]]:
    """Natural frequencies of the chain in other engines, and who is left out."""
    ready, absent = engines()
    entries, refused = [], list(absent)
    for name, engine in ready.items():
        line = Line(name=name, orders=(4.0, 4.0), settings={"engine": name})
        for count in its.counts:
            try:
                case = given().case_of(scene.beam, count, (), scene.drive.frequency_hz if scene.drive else 1.0)
            except InputError as error:
                refused.append(f"{name} is skipped: {error}")
                break

            def prepare(engine: Adapter = engine, case: object = case, name: str = name) -> Callable[[], Told]:
                if engine.frequencies(case) is None:
                    raise InputError(f"{name} has no natural frequencies")
                return lambda: Told(engine.frequencies(case))

            seconds = START_S + STEP_LINK_S * count**2
            entries.append(Entry(line=line, size=1.0 / count, count=count, estimate_s=seconds, prepare=prepare))
    return tuple(entries), tuple(dict.fromkeys(refused))


def _ladder(
    name: str, engine: Adapter, case: object, sled: object | None, period: float, end: float, count: int
) -> Iterator[Entry]:
    """One engine over its steps; what it gives as (times, deflection), with a slider as (times, distance, speed)."""
    line = Line(name=name, orders=(1.0, 4.0), refined="step", settings={"engine": name})

    def prepare(step: float) -> Callable[[], Told]:
        advance = engine.prepare(case, sled)

        def run() -> Told:
            found = advance(step, end)
            if broke := getattr(found, "broke", ""):
                raise InputError(f"{name} broke: {broke}")
            if len(found.times) < min(LEAST_SAMPLES, round(end / step)):
                raise InputError(f"{name} kept {len(found.times)} samples, too few to tell")
            answer = (found.times, found.deflection) if sled is None else (found.times, found.distance, found.speed)
            return Told(answer, getattr(found, "set_up_s", None), found.seconds)

        return run

    for step in (FIRST_STEP * period / 2**k for k in range(RUNGS)):
        seconds = START_S + STEP_LINK_S * count * end / step
        yield Entry(
            line=line,
            size=step,
            count=count,
            estimate_s=seconds,
            prepare=partial(prepare, step),
            sets_up=True,
            settings={"step": step},
        )


def chain_entries(scene: "Scene", its: Settled, chain: "Chain") -> tuple[tuple[Entry, ...], tuple[str, ...]]:
    """The nonlinear chain in other engines, read at mid-span, and who is left out."""
    ready, absent = engines()
    assert scene.drive is not None
    try:
        case = given().case_of(scene.beam, chain.count, scene.forces, scene.drive.frequency_hz) if ready else None
        if ready and its.x != 0.5 * scene.beam.length:
            raise InputError(f"x = {its.x:g} m, and engines are read at mid-span")
    except InputError as error:
        return (), (*absent, *(f"{name} is skipped: {error}" for name in ready))
    ladders = (
        _ladder(name, engine, case, None, chain.period, chain.duration, chain.count) for name, engine in ready.items()
    )
    return tuple(entry for ladder in ladders for entry in ladder), absent


def slider_cases(scene: "Scene", its: Settled) -> Iterator[Case]:
    """A slider under a step load, one-way, at each number of links; nothing without engines."""
    ready, absent = engines()
    if not ready and not absent:
        return
    assert scene.drive is not None
    assert scene.slider is not None
    assert scene.motion is not None
    slider, period = replace(scene.slider, coupling="one-way"), 1.0 / scene.drive.frequency_hz
    for count in its.chains:
        try:
            forces = forces_of(scene, "slider")
            case = given().case_of(scene.beam, count, forces, scene.drive.frequency_hz) if ready else None
            sled = given().sled_of(scene.beam, slider) if ready else None
            why: tuple[str, ...] = absent
        except InputError as error:
            case, why = None, (*absent, *(f"{name} is skipped: {error}" for name in ready))
        ladders = (
            _ladder(name, engine, case, sled, period, its.duration, count)
            for name, engine in ready.items()
            if case is not None
        )
        theirs = tuple(entry for ladder in ladders for entry in ladder)
        ours = tuple(_own(scene, its, slider, period, count)) if theirs else ()
        yield Case(
            set="slider",
            about=f"step load, N = {count}",
            question="way and speed, rms over time",
            condition=f"one-way coupling, {1e3 * its.duration:.3g} ms from rest under a step load; ours is linear",
            entries=(*ours, *theirs),
            pairs=tuple((OURS, name) for name in dict.fromkeys(entry.line.name for entry in theirs)),
            judge=_converged((*ours, *theirs)),
            wanted=(1e-3, 1e-5),
            notes=why,
        )


OURS = "segments, modal steps"


def _own(scene: "Scene", its: Settled, slider: "Slider", period: float, count: int) -> Iterator[Entry]:
    from verify.motion.simulate import simulate

    assert scene.drive is not None
    frequency = scene.drive.frequency_hz

    def run(step: float) -> Told:
        found = simulate(
            scene.beam,
            scene.forces,
            frequency,
            its.duration,
            count=count,
            slider=slider,
            step=step,
            samples=SAMPLES,
            ledger=False,
            patient=False,
        )
        answer = found.times, found.travelled, found.speed
        return Told(answer, found.statistics.set_up_s, found.statistics.wall_s)

    line = Line(name=OURS, model="segment", orders=(1.0, 4.0), refined="step")
    for step in (FIRST_STEP * period / 2**k for k in range(RUNGS)):
        seconds = START_S + its.duration / step * 1e-5
        yield Entry(
            line=line,
            size=step,
            count=count,
            estimate_s=seconds,
            prepare=partial(partial, run, step),
            sets_up=True,
            settings={"step": step},
        )


def _converged(entries: tuple[Entry, ...]) -> Callable[[], Callable[[Entry, Any], Judged]]:
    """Every engine against its own run at its shortest step: readings of a surface differ.

    How well that is known is what the step twice as long changes, which at order 1 is its own error.
    """
    known: dict[str, tuple[tuple[Array, ...], float, Reference]] = {}

    def made(name: str) -> tuple[tuple[Array, ...], float, Reference]:
        own = sorted((one for one in entries if one.line.name == name), key=lambda one: one.size)
        finest, next_to = (one.prepare()().answer for one in own[:2])
        step = own[0].size
        return finest, step, Reference(f"its own run at a step of {step:.3g} s", _apart(next_to, finest))

    def judge() -> Callable[[Entry, Any], Judged]:
        def error(entry: Entry, answer: Any) -> Judged:
            name = entry.line.name
            if name not in known:
                known[name] = made(name)
            finest, step, reference = known[name]
            if entry.size == step:
                raise InputError(f"{name}: its shortest step is its own reference")
            return Judged(_apart(answer, finest), reference)

        return error

    return judge


def _apart(found: tuple[Array, ...], true: tuple[Array, ...]) -> float:
    """The larger of the relative rms errors of way and speed, each (times, way, speed)."""
    from scipy.interpolate import CubicSpline

    pairs = zip(found[1:], true[1:], strict=True)
    return max(relative_rms(one, CubicSpline(true[0], other)(found[0])) for one, other in pairs)
