"""Parts that an accuracy takes of members of the family, against every size by their dispersion; what does with fewer.

And what a choice of parts says beside its count: errors that are expected, the worst of several modes, modes below.
"""

from collections.abc import Iterator
from math import inf, pi
from typing import Any

from msgspec.structs import replace

from verify.beam import Beam
from verify.stress.judge.sizes_chosen import pinned_error
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.lists.members import MEMBERS, turned_rate
from verify.stress.references.beams import LADEN, STEPPED, STRIP, held

# --- Sizes by dispersion ----------------------------------------------------------------------------------------------

ASKED: tuple[tuple[int, float], ...] = ((1, 0.05), (2, 0.02), (3, 0.013), (4, 0.1), (5, 0.09))
"""A mode and an error, which no mode of as many parts keeps: between pins that is the nodes' turning."""
MOST = 45
RARE = 1.5e-6
"""An error that links without their own inertia keep from more than a thousand parts on alone."""
BETTER = {"points": "the links' own inertia m l^2/12", "joints": "the links' own inertia m l^2/12"} | dict.fromkeys(
    ("hrz", "lumped-rotary"), "consistent mass"
)


def _member(model: str, mass: str, **more: Any) -> Any:
    from verify.identify.family import Candidate

    given: dict[str, Any] = {"joints": "series", "order": 2} if model == "segment" else {}
    return Candidate(model=model, mass=mass, **(given | more))


def _first(model: str, mass: str, mode: int, error: float) -> int:
    """From which size on a mode of the strip between pins is within an error, by its dispersion at every size."""
    far = (n for n in range(mode + 1, MOST) if abs(_off(model, mass, mode * pi / n)) > error)
    return max(far, default=mode) + 1


def _off(model: str, mass: str, mu: float) -> float:
    return turned_rate(model, mass, mu) / mu**2 - 1.0


def _tried(first: int, fewest: int) -> tuple[int, int]:
    """(the last size that is tried, the last of all those from the first on): 15 % apart until five in a row do.

    Halved between the last that fails and the next that does.
    """
    size, low, does = fewest, fewest - 1, set[int]()
    while len(does) < 5:
        if size >= first:
            does.add(size)
        else:
            low = size
        size = max(size + 1, round(1.15 * size))
    high = min(does)
    assert low < first <= high
    end = first
    while end + 1 in does:
        end += 1
    return max(does), end


def _known_by(first: int, fewest: int) -> str:
    last, end = _tried(first, fewest)
    one_by_one, tried = f"all N from {first} to {end} do", f"those tried up to {last}"
    said = [one_by_one] * (end > first) + [tried if end > first else f"{tried} do"] * (last > end)
    return f"{', and '.join(said)}; larger ones were not solved"


def members_error(number: float) -> float:
    """How often a member's parts for an accuracy, how they are known, or what does with fewer is another."""
    from verify.identify.sizing import enough

    model, mass = MEMBERS[int(number)]
    own, wrong = _member(model, mass), 0
    best = "links" if model == "segment" else "consistent"
    for mode, error in ASKED[1:3] if mass == best else ASKED:
        found = enough(STRIP, own, mode, error)
        first, fewest = max(_first(model, mass, mode, error), mode, 2), max(mode, 2)
        fewer = max(_first(model, best, mode, error), mode, 2)
        wrong += found.count != first or (found.mode, found.error) != (mode, error)
        if mass == best:
            wrong += (found.better, found.better_count) != ("", None)
            continue
        wrong += found.known_by != _known_by(first, fewest)
        wrong += (found.better, found.better_count) != ((BETTER[mass], fewer) if fewer < first else ("", None))
    if mass == "points":  # of order 2, beyond a thousand
        rare = enough(STRIP, own, 2, RARE)
        wrong += (rare.count, rare.better, rare.better_count) != (None, BETTER[mass], _first(model, best, 2, RARE))
    return float(wrong)


# --- Sizes one by one -------------------------------------------------------------------------------------------------


def _beyond(own: Any, mode: int, error: float, sizes: range) -> list[int]:
    """Sizes at which a member's mode on the stepped strip is beyond an error, each solved for itself."""
    from verify.identify.family import exact_hz, frequencies_hz

    exact = float(exact_hz(STEPPED, mode)[-1])
    found = {n: frequencies_hz(own, STEPPED, n, mode) for n in sizes}
    return [n for n, hz in found.items() if len(hz) < mode or abs(float(hz[-1]) / exact - 1.0) > error]


def gone_through_error(number: float) -> float:
    """How often parts on a beam with a step within a part are not those from which on every size does.

    By all sizes up to twice as many, which are gone through one by one.
    """
    from verify.identify.sizing import parts_for

    wrong = 0
    for model, mass, mode, error in (
        ("segment", "points", 2, 0.02),
        ("segment", "points", 3, 0.01),
        ("fem", "hrz", 3, 0.02),
    ):
        own = _member(model, mass)
        found = parts_for(STEPPED, own, mode, error)
        if found is None:
            return inf
        count, said = found
        beyond = _beyond(own, mode, error, range(mode, 2 * count))
        wrong += max(beyond, default=mode) + 1 != count
        wrong += not said.startswith(f"all N from {count} to {2 * (count - 1)} do")
    return float(wrong)


# --- What does with fewer ---------------------------------------------------------------------------------------------

GREGORY = "Gregory's weights 3/8, 7/6, 23/24 at the wall"
OWN, MENDED = BETTER["points"], "tensioned joints"


def _rules() -> Iterator[tuple[Beam, Any, tuple[str | None, str | None] | None, str]]:
    """A beam, a member; wall and joints of the best rule that is known of its kind, and what it is called."""
    clamped = held("clamped", "free")
    taut, both = replace(STRIP, tension=40.0), replace(clamped, tension=40.0)
    yield STRIP, _member("segment", "points"), (None, "series"), OWN
    yield STRIP, _member("segment", "links"), None, ""
    yield clamped, _member("segment", "links", wall="full"), ("gregory", "series"), GREGORY
    yield clamped, _member("segment", "points", wall="half"), ("gregory", "series"), f"{GREGORY} and {OWN}"
    yield clamped, _member("segment", "links", wall="gregory"), None, ""
    yield taut, _member("segment", "links"), (None, "tensioned"), MENDED
    yield taut, _member("segment", "links", joints="tensioned"), None, ""
    yield STEPPED, _member("segment", "links", joints="printed"), (None, "series"), "Eq. (1) in series"
    lever = _member("segment", "links", attachment="lever")
    yield LADEN, lever, (None, "series"), "reciprocal weights for what is fixed to it"
    yield (
        both,
        _member("segment", "points", wall="rigid"),
        ("gregory", "tensioned"),
        f"{GREGORY} and {OWN} and {MENDED}",
    )
    yield STRIP, _member("segment", "joints", shearing=True, theory="timoshenko"), (None, "series"), OWN
    yield STRIP, _member("fem", "consistent"), None, ""
    yield STRIP, _member("fem", "lumped", theory="rayleigh"), (None, None), "consistent mass"
    yield STRIP, _member("analytic", "", theory="rayleigh"), None, ""


def better_error(number: float) -> float:
    """How often what does with fewer parts is another rule, of another theory, or called otherwise.

    Also where the member itself is none on a beam.
    """
    from verify.identify.sizing import _better, enough
    from verify.judge.sizing import enough_from
    from verify.judge.workbench import Workbench

    wrong, none = 0, enough(LADEN, _member("segment", "points"), 2, 0.003)
    wrong += (none.count, none.known_by, none.better) != (None, "", OWN)
    wrong += none.better_count != enough_from(Workbench(LADEN), "segment", 2, 0.003).count
    for beam, own, rules, words in _rules():
        found, said = _better(beam, own)
        wrong += said != words or (found is None) is not (rules is None)
        if found is not None:
            mass = "links" if own.model == "segment" else "consistent"
            wrong += (found.wall, found.joints) != rules or (found.model, found.mass) != (own.model, mass)
            wrong += found.theory != own.theory or found.shearing or found.attachment is not None
    return float(wrong)


# --- What a choice says -----------------------------------------------------------------------------------------------


def _dips(error: float, modes: range) -> int | None:
    """The smallest size below forty that happens to do of elements, where one between does not."""
    within = {n: all(abs(pinned_error("fem", mode, n)) <= error for mode in modes) for n in range(32, 40)}
    if len(modes) > 1:
        return next((n for n, does in within.items() if does and n < 39), None)
    return 32 if within[32] and not all(within.values()) else None


def beside_error(number: float) -> float:
    """How far errors that are told of a choice lie from the dispersion's; wrong modes count one each."""
    from verify.judge.known import worst_of
    from verify.judge.sizing import Enough, _dip, _expected, _lower
    from verify.judge.variants import Variant
    from verify.judge.workbench import Workbench

    bench, off, wrong = Workbench(STRIP), 0.0, 0
    for model, mode, count in (("segment", 2, 9), ("fem", 3, 7), ("segment", 5, 6)):
        told = _expected(model, STRIP, mode, count)
        off = inf if told is None else max(off, abs(told / pinned_error(model, mode, count) - 1.0))
    none = (("segment", STEPPED, 2, 9), ("analytic", STRIP, 2, 9), ("fem", STRIP, 6, 3))
    wrong += sum(_expected(model, beam, mode, count) is not None for model, beam, mode, count in none)
    for modes, count in ((range(1, 4), 12), (range(27, 32), 32), (range(19, 24), 24), (range(3, 6), 6)):
        worst = max(modes, key=lambda mode: (abs(pinned_error("fem", mode, count)), mode))
        wrong += worst_of(bench, "fem", modes, count, ()) != worst
    wrong += worst_of(bench, "segment", range(2, 10), 7, ()) != 9 or worst_of(bench, "segment", range(4, 5), 2, ()) != 4
    for error in (0.0347, 0.036, 0.0369, 0.04):
        wrong += _dips(error, range(31, 32)) != _dip("fem", STRIP, 31, error, 40)
        wrong += _dips(error, range(30, 32)) != _dip("fem", STRIP, range(30, 32), error, 40)
        lower = tuple(n for n in range(1, 31) if abs(pinned_error("fem", n, 32)) > error)
        wrong += _lower(bench, Variant("fem"), Enough(count=32, mode=31, known_by=""), error) != lower
    return largest(off, float(wrong))


ROWS: tuple[Row, ...] = (
    Floor(
        id="parts-enough-of-members",
        title="Parts for an accuracy of six discrete beams, how they are known, and what does with fewer",
        why="identify/sizing.py: 15 % apart until five in a row do, halved between.",
        along="member",
        at=tuple(range(len(MEMBERS))),
        promise=0.5,
        error=members_error,
    ),
    Floor(
        id="parts-enough-beside-steps",
        title="The same where a step falls within a part, of links without their own inertia and lumped elements",
        why="identify/sizing.py: sizes after the last that fails are gone through one by one.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=gone_through_error,
    ),
    Floor(
        id="rules-that-do-with-fewer",
        title="The best rule that is known of a kind of model, on fourteen beams and members, and what it is called",
        why="identify/sizing.py: consistent mass, Gregory's weights, links' own inertia, joints.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=better_error,
    ),
    Floor(
        id="errors-beside-a-choice",
        title="Errors that are expected, the worst of several modes, modes below and sizes that happen to do",
        why="judge/sizing.py, known.py: by the discrete dispersion.",
        along="1",
        at=(1.0,),
        promise=1e-9,
        error=beside_error,
    ),
)
