"""Other engines as methods of our sets: modes, the nonlinear chain, a slider under a step load, and how they break.

What they are given and give is said in `verify.peers`; one that is missing is named, and the others go on. An engine is
run in steps that are halved from its own longest on; what it takes at an error lies between two of them.
"""

from collections.abc import Callable, Iterator
from functools import partial
from math import ceil, isnan, log2
from typing import TYPE_CHECKING

from verify.bench.kind import Entry, Line, Run, Told
from verify.bench.request import Settled
from verify.errors import InputError
from verify.judge.workbench import no_such_mode
from verify.peers.breaking import Break, pushed
from verify.peers.case import Case as Links
from verify.peers.case import Sled, case_of, clocks, since
from verify.peers.catalogue import PEERS, PeerAdapter, adapter, installed, missing
from verify.peers.references import explicit_limit

if TYPE_CHECKING:
    from verify.bench.chain_set import Chain
    from verify.scenes.scene import Scene

FIRST_STEP, FIRST_IMPLICIT, BELOW_LIMIT = 1.0 / 12.0, 1.0 / 100.0, 0.99
"""Of the drive's period, the longest step, and of one without a limit, which order 2 makes long soon; of that limit."""
RUNGS, MORE = 7, 1
"""Steps of an engine, each half of the one before; and so many more at order 2."""
ENOUGH = 100.0
"""Links up to which so many come to the least error that is asked for."""
STEP_LINK_S, STEP_LINKS_S, START_S = 6e-6, 1e-7, 0.1
"""From above: of a step by links, and by links squared where matrices are full; of a model made."""
START_LINKS_S, MODES_S = 6e-6, 6e-8
"""From above: of a model by links squared, of all modes by links cubed."""
LEAST_SAMPLES = 40
"""Of a run, from which on they tell an error."""
PART_S = 0.5
"""Of a longer run, what rounds repeat."""


def engines() -> tuple[dict[str, PeerAdapter], tuple[str, ...]]:
    """(those that are installed, a sentence for each that is not)."""
    absent = tuple(why for peer in PEERS.values() if (why := missing(peer)))
    return {peer.name: adapter(peer) for peer in PEERS.values() if not missing(peer)}, absent


def versions() -> dict[str, str]:
    """Of the engines that are installed, by name."""
    return {peer.name: version for peer in PEERS.values() if (version := installed(peer))}


def frequency_entries(scene: "Scene", its: Settled, mode: int) -> tuple[tuple[Entry, ...], tuple[str, ...]]:
    """Natural frequencies of the chain in other engines, all up to a mode at least, and who is left out."""
    ready, absent = engines()
    hertz = scene.drive.frequency_hz if scene.drive else 1.0
    chains, refused = [], []
    for count in its.counts:
        try:
            chains.append(case_of(scene.beam, count, (), hertz))
        except InputError as error:
            refused.append(str(error))
    entries = tuple(_modes_of(name, engine, links, mode) for name, engine in ready.items() for links in chains)
    left = (f"{name} is left out{' of some sizes' * bool(chains)}: {why}" for name in ready for why in refused)
    return entries, (*absent, *dict.fromkeys(left))


def _modes_of(name: str, engine: PeerAdapter, links: Links, mode: int) -> Entry:
    """One engine's modes of one chain."""
    line = Line(name=name, orders=(4.0, 4.0), settings={"engine": name})
    prepare: Callable[[], Run] = partial(partial, _frequencies, name, engine, links, mode)
    seconds = START_S + MODES_S * links.n**3
    return Entry(line=line, size=1.0 / links.n, count=links.n, estimate_s=seconds, prepare=prepare)


def _frequencies(name: str, engine: PeerAdapter, links: Links, mode: int) -> Told:
    found = engine.frequencies(links)
    if found is None:
        raise InputError(f"{name} has no natural frequencies")
    if len(found) < mode:
        raise InputError(no_such_mode(mode, name, links.n, len(found)))
    return Told(found)


def first_steps(period: float, end: float, limit: float, *, implicit: bool = False) -> int:
    """How many of its longest steps a run takes, each of the drive's period or of the limit of stability."""
    first = FIRST_IMPLICIT * period if implicit else min(FIRST_STEP * period, BELOW_LIMIT * limit)
    return max(ceil(end / first * (1.0 - 1e-9)), LEAST_SAMPLES)


def further(count: int) -> int:
    """Steps more at the fine end where no limit shortens them: more links, higher modes that a load rings."""
    return max(0, ceil(log2(count / ENOUGH)))


def ladder(name: str, engine: PeerAdapter, links: Links, sled: Sled | None, end: float) -> Iterator[Entry]:
    """One engine over its steps; what it gives as (times, deflection), with a slider as (times, distance, speed)."""
    implicit, dense = PEERS[name].implicit, PEERS[name].dense
    line = Line(name=name, orders=(1.0, 4.0), refined="step", settings={"engine": name})
    least = first_steps(1.0 / links.frequency, end, explicit_limit(links), implicit=implicit)
    set_up = START_S + START_LINKS_S * links.n**2
    each = STEP_LINK_S * links.n + dense * STEP_LINKS_S * links.n**2
    for steps in (least * 2**k for k in range(RUNGS + (MORE + further(links.n)) * implicit)):
        run = partial(_run, name, engine, links, sled, end, steps)
        part = max(round(PART_S / each), 1)
        yield Entry(
            line=line,
            size=end / steps,
            count=links.n,
            estimate_s=set_up + steps * each,
            prepare=partial(partial, run, steps),
            part=partial(partial, run, part) if part < steps else None,
            part_s=set_up + part * each,
            settings={"step": end / steps},
        )


def _run(name: str, engine: PeerAdapter, links: Links, sled: Sled | None, end: float, steps: int, taken: int) -> Told:
    """So many of a run's steps, from the model on. Raises InputError where it broke or took other steps."""
    begun, step = clocks(), end / steps
    found = engine.prepare(links, sled)(step, taken * step)
    wall, cpu = since(begun)
    if found.broke:
        raise InputError(f"{name} broke: {found.broke}")
    if abs(found.steps - taken) > 1:
        raise InputError(f"{name} took {found.steps} steps where {taken} were asked for")
    if len(found.times) < min(LEAST_SAMPLES, taken):
        raise InputError(f"{name} kept {len(found.times)} samples, too few to tell")
    answer = (found.times, found.deflection) if sled is None else (found.times, found.distance, found.speed)
    whole, loop = (wall, found.seconds) if isnan(found.cpu_s) else (cpu, found.cpu_s)
    return Told(answer, max(whole - loop, 0.0), loop, taken / steps)


def chain_entries(scene: "Scene", its: Settled, chain: "Chain") -> tuple[tuple[Entry, ...], tuple[str, ...]]:
    """The nonlinear chain in other engines, read at mid-span, and who is left out."""
    ready, absent = engines()
    if not ready:
        return (), absent
    assert scene.drive is not None
    try:
        if its.x != 0.5 * scene.beam.length:
            raise InputError(f"x = {its.x:g} m, and engines are read at mid-span")
        links = case_of(scene.beam, chain.count, scene.forces, scene.drive.frequency_hz)
    except InputError as error:
        return (), (*absent, *(f"{name} is left out: {error}" for name in ready))
    ladders = (ladder(name, engine, links, None, chain.duration) for name, engine in ready.items())
    return tuple(entry for one in ladders for entry in one), absent


def breaks(scene: "Scene", its: Settled) -> tuple[tuple[Break, ...], tuple[str, ...]]:
    """What every engine does beyond what it bears, at each number of links, and who is left out."""
    from verify.bench.field_set import forces_of

    forces, (ready, absent) = forces_of(scene, "push"), engines()
    found, refused = [], list(absent)
    assert scene.drive is not None
    for name in ready:
        try:
            for count in its.chains:
                links = case_of(scene.beam, count, forces, scene.drive.frequency_hz)
                found.append(pushed(name, links, its.duration))
        except InputError as error:
            refused.append(f"{name} is not pushed: {error}")
    return tuple(found), tuple(refused)
