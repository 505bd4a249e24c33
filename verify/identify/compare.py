"""Somebody's model of a scene's beam compared: read, paired, identified, sized, judged."""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import product
from pathlib import Path
from time import perf_counter
from typing import get_args

import msgspec
import numpy as np

from verify.beam import Beam
from verify.checks import check_whole
from verify.errors import InputError
from verify.identify.causes import identify
from verify.identify.causes_told import cause_of
from verify.identify.family import CHAIN, ELEMENTS, EXACT, Candidate, Solver, exact_hz, family
from verify.identify.fitting import PLAIN, Data, Identified
from verify.identify.gates import judged
from verify.identify.outside import asked_of
from verify.identify.pairing import Elastic, Found, by_number, by_shape, elastic_of, missing, swapped
from verify.identify.reading import Listed, Shapes, read_frequencies, read_shapes
from verify.identify.rows import Row, gaps_of, rows_of
from verify.identify.sizing import Enough, enough
from verify.identify.told import Compared
from verify.identify.twins import twin_of
from verify.identify.yielding import CREDIBLE
from verify.judge.compare import HARDLY
from verify.models.arrays import Array
from verify.options import Support
from verify.patience import check_work
from verify.scenes.scene import Scene
from verify.words import percent

SPARE = 4
"""Modes beyond the list that candidates are solved for: as many may be missing from it."""
_SHARP, _FAR_LESS = 1e-7, 0.02
"""Relative: what is left of a list that has its digits, and what of another's rest shows that to be a likeness."""
_OTHER_COUNT = 10.0
"""By how much, in logarithms of likelihood, another number of parts than was said has to be likelier."""
_TELLING = 5
"""Modes from which on a list is held against all numbers of parts: of fewer, one or the other always fits."""
KINDS = {"segments": CHAIN, "elements": ELEMENTS}
"""What somebody may say that he built."""


class Asked(msgspec.Struct, frozen=True, kw_only=True):
    """What is compared, and how."""

    frequencies: Path | None = None
    """A list of natural frequencies."""
    shapes: Path | None = None
    """Mode shapes to it."""
    model: str | None = None
    """'package.module:Class' in their place."""
    count: int | None = None
    """Parts of the model; None where nobody says."""
    unit: str | None = None
    """Hz, kHz or rad/s, where the list's head is not to say it."""
    kind: str | None = None
    """segments or elements, where somebody says what he built."""
    mode: int | None = None
    """At which an error is asked for; the last of the list unless given."""
    error: float = 1e-3
    """For which parts are counted."""
    within: float | None = None
    """What errors against the exact beam are allowed."""
    theory: str = "euler-bernoulli"
    """Of the exact beam that errors are against."""


def compare(scene: Scene, asked: Asked) -> Compared:
    """What a list of frequencies, or a model, of the scene's beam is, how surely, how far off. Raises InputError."""
    return compared(scene, asked, *_given(scene, asked))


def compared(scene: Scene, asked: Asked, listed: Listed, shapes: Shapes | None, count: int | None) -> Compared:
    """The same of a list that was read already, perhaps with shapes, of so many parts if that is known."""
    beam, start = scene.beam, perf_counter()
    if asked.mode is not None and asked.mode > listed.n:
        raise InputError(f"mode = {asked.mode}: {listed.source} has {listed.n} modes, ask for one of them")
    n_modes = max(listed.n, *(listed.numbers or (0,))) + SPARE
    members = _wanted(family(beam), asked.kind)
    check_patience(n_modes, count, len(members))
    exact = exact_hz(beam, n_modes, asked.theory)
    elastic = elastic_of(listed, beam, exact)
    solver = Solver(beam, n_modes)
    data = Data(
        listed=listed.frequencies_hz[elastic.kept],
        rounding=listed.rounding[elastic.kept],
        family=members,
        solver=solver,
        read_as=listed.unit,
        paired=by_number(elastic.numbers) if elastic.numbers else None,
    )
    data, told, likeness = _by_shapes(scene, data, shapes, elastic, count)
    found, recounted = _identified(data, count)
    told = (
        *elastic.told,
        *told,
        *_of_list(scene.beam, found, data, elastic),
        *recounted,
        *_of_supports(scene, found, data),
    )
    told = (*told, *twin_of(beam, found))
    best = found.best
    rows = rows_of(data, found, exact, likeness, elastic)
    mode = asked.mode or max(row.read_as or 1 for row in rows)
    size = enough(beam, best.candidate, mode, asked.error) if best.candidate.sized else None
    return _told(scene, asked, listed, found, told, rows, size, solver, perf_counter() - start)


def check_patience(n_modes: int, count: int | None, candidates: int) -> None:
    """Raise InputError, before anything is solved, for a list or a size that keeps somebody waiting without a word.

    As measured on one slow core (`_sizes_seconds`, `_search_seconds`). What a list is held against beside the size that
    is said, where that does not explain it, has its own estimate.
    """
    if count is not None:
        check_work("count", count, _sizes_seconds(n_modes, [count]), "compare a coarser model")
        return
    remedy = "give fewer frequencies, --kind, what you built, or --count, the parts of your model"
    check_work("modes", n_modes, _search_seconds(n_modes, candidates), remedy)


def _sizes_seconds(n_modes: int, counts: Sequence[int]) -> float:
    """What known sizes take: the time of their sparse solves."""
    return 1.2e-3 * sum(counts) * max(n_modes / 10.0, 1.0)


def _search_seconds(n_modes: int, candidates: int) -> float:
    """What all sizes take: about thirty of every candidate are solved, the dense ones by the cube of the modes.

    Of lists that nothing fits, 14, 50 and 100 modes of a clamped beam took 0.18, 0.40 and 0.73 s for each candidate,
    told 0.18, 0.40 and 0.85.
    """
    hundreds = n_modes / 100.0
    return candidates * (0.1 + 0.55 * hundreds + 0.2 * hundreds**3)


def _given(scene: Scene, asked: Asked) -> tuple[Listed, Shapes | None, int | None]:
    """The list, shapes, and the number of parts, from files or from a model. Raises InputError."""
    if (asked.frequencies is None) == (asked.model is None):
        raise InputError("give a file of frequencies, or --model package.module:Class: one of them")
    if asked.count is not None:
        check_whole("count", asked.count, 1)
    if asked.mode is not None:
        check_whole("mode", asked.mode, 1)
    if asked.model is not None:
        if asked.shapes is not None or asked.unit is not None:
            option = "--modes" if asked.shapes is not None else "--unit"
            raise InputError(f"{option} belongs to a file of frequencies: leave it out beside --model")
        answered = asked_of(asked.model, scene.beam, asked.count, asked.mode)
        return answered.listed, answered.shapes, answered.count
    assert asked.frequencies is not None
    listed = read_frequencies(asked.frequencies, asked.unit, sorted_list=asked.shapes is None)
    shapes = read_shapes(asked.shapes, scene.beam.length, listed.n) if asked.shapes is not None else None
    return listed, shapes, asked.count


def _wanted(members: tuple[Candidate, ...], kind: str | None) -> tuple[Candidate, ...]:
    """The candidates of the kind that somebody says he built; exact ones stay."""
    return members if kind is None else tuple(one for one in members if one.model in (KINDS[kind], EXACT))


def _by_shapes(
    scene: Scene, data: Data, shapes: Shapes | None, elastic: Elastic, count: int | None
) -> tuple[Data, tuple[Found, ...], dict[int, float]]:
    """(the data paired by shape, what is to be told of it, MAC by entry). By order where shapes alone are exchanged."""
    if shapes is None:
        return data, (), {}
    pairs, likeness, told = by_shape(scene.beam, shapes, elastic.kept)
    worst = int(likeness.argmin())
    if likeness[worst] < HARDLY:
        words = (
            f"shapes are hardly those of the beam as the scene holds it, that of entry "
            f"{int(elastic.kept[pairs.entries[worst]]) + 1} has a MAC of {likeness[worst]:.2f} with mode "
            f"{int(pairs.modes[worst]) + 1}, the nearest: check beam.supports; frequencies are taken in their order"
        )
        return data, (*told, Found(kind="unlike", words=words)), {}
    told = (*told, *swapped(pairs), *missing(pairs, elastic.kept))
    paired = msgspec.structs.replace(data, paired=pairs)
    rises = bool((np.diff(data.listed) >= 0.0).all())
    if rises and any(one.kind == "swapped" for one in told):
        one, other = identify(paired, count), identify(msgspec.structs.replace(data, paired=None), count)
        if other is not None and (one is None or other.best.score < one.best.score):
            told = tuple(_of_shapes_alone(found) for found in told)
            return data, told, {}
    return paired, told, dict(zip(map(int, pairs.entries), map(float, likeness), strict=True))


def _of_shapes_alone(found: Found) -> Found:
    if found.kind != "swapped":
        return found
    words = f"the columns of shapes are exchanged, the frequencies are not: {found.words}"
    return msgspec.structs.replace(found, words=words)


def _identified(data: Data, count: int | None) -> tuple[Identified, tuple[Found, ...]]:
    """What the list is at the given size, or else beside it or at any. Raises InputError where nothing is so large.

    Of so few frequencies that none is claimed at the given size, another would be a fitted one. What explains a list at
    its size but not to its last digits may be another size's by chance: that is taken where it leaves far less.
    """
    found = identify(data, count)
    known = found is not None and (found.short or (_sharp(found) and found.best.candidate.sized))
    if count is not None and not known:
        beside = [size for size in {2 * count, count // 2, *range(count - 2, count + 3)} - {count} if size > 1]
        n_modes = data.solver.n_modes
        seconds = _sizes_seconds(n_modes, beside) + _search_seconds(n_modes, len(data.family))
        try:
            check_work("count", f"other than {count}", seconds, "give fewer frequencies, --kind or a coarser model")
        except InputError as why:
            told = Found(kind="unsearched", words=f"other sizes were not looked at: {why}", wrong=False)
            return _of_that_size(found, data, count), (told,)
        other = _explaining(data, sorted(beside))
        if len(data.listed) >= _TELLING and not (other is not None and _sharp(other)):
            anywhere = _explaining(data, [None])
            if anywhere is not None and anywhere.reading == PLAIN and (other is None or _sharper(anywhere, other)):
                other = anywhere
        if other is not None and found is not None and found.explained and not _sharper(other, found):
            other = None
        if other is not None and (found is None or other.best.score < found.best.score - _OTHER_COUNT):
            words = f"the list is that of {other.best.count} parts, not of the {count} that --count says"
            return other, (Found(kind="count", words=words),)
    return _of_that_size(found, data, count), ()


def _sharp(found: Identified) -> bool:
    """Whether it explains the list to digits that no other size would have by chance."""
    return found.explained and found.best.residual <= _SHARP


def _sharper(one: Identified, other: Identified) -> bool:
    """Whether it leaves so much less that the other's is a likeness."""
    return one.best.residual <= _FAR_LESS * other.best.residual


def _of_that_size(found: Identified | None, data: Data, count: int | None) -> Identified:
    """What was found. Raises InputError where nothing is so large."""
    if found is None or (count is not None and not any(fit.candidate.sized for fit in found.fits)):
        n = len(data.listed)
        raise InputError(f"count = {count}: no model of so few parts has the {n} modes of the list, raise count")
    return found


def _explaining(data: Data, counts: Sequence[int | None]) -> Identified | None:
    """The best of what explains the list at one of these sizes, None being any; None where nothing does."""
    found = [identify(data, count) for count in counts]
    good = [one for one in found if one is not None and one.explained and one.best.candidate.sized]
    return min(good, key=lambda one: one.best.score, default=None)


def _of_list(beam: Beam, found: Identified, data: Data, elastic: Elastic) -> tuple[Found, ...]:
    """What the best reading of a list says of it: its unit, a common factor, a clamp, what is missing or apart."""
    gaps = gaps_of(data, found.best, elastic) if data.paired is None else ()
    return (*cause_of(found, beam), *gaps)


def _of_supports(scene: Scene, found: Identified, data: Data) -> tuple[Found, ...]:
    """The supports whose exact frequencies the lower half of an unexplained list is nearest to, the scene's or others.

    Of the scene's own, where the list leaves them.
    """
    n = max(min(len(data.listed) // 2, 6), 2)
    if found.best.residual <= CREDIBLE or len(data.listed) < n:
        return ()
    own = exact_hz(scene.beam, len(data.listed))
    near = {scene.beam: _apart(data.listed[:n], own[:n])}
    for other in _held_otherwise(scene.beam):
        with suppress(InputError):  # something on the beam stands where these supports hold it
            near[other] = _apart(data.listed[:n], exact_hz(other, n))
    best = min(near, key=lambda one: near[one])
    if near[best] > CREDIBLE:
        return ()
    within = f"the first {n} frequencies lie within {max(100.0 * near[best], 0.01):.2g} % of those of"
    if best != scene.beam:
        words = f"{within} a {'-'.join(best.supports)} beam, and the scene's is not held so"
        return (Found(kind="supports", words=words),)
    leaving = np.flatnonzero(abs(np.log(data.listed / own)) > CREDIBLE)
    if not len(leaving):
        return ()
    first = int(leaving[0])
    words = f"{within} the scene's beam, and number {first + 1} is the first that leaves it"
    off = percent(float(data.listed[first] / own[first] - 1.0))
    return (Found(kind="leaving", words=f"{words}, {off} off", wrong=False),)


def _apart(listed: Array, exact: Array) -> float:
    """The largest ratio of frequencies, as a logarithm."""
    return float(abs(np.log(listed / exact)).max())


def _held_otherwise(beam: Beam) -> Iterator[Beam]:
    """The beam on every other pair of supports; one of two that are each other's mirror image."""
    seen = {beam}
    for supports in product(get_args(Support), repeat=2):
        with suppress(InputError):
            other = msgspec.structs.replace(beam, supports=supports)
            if other not in seen and other.mirrored() not in seen:
                seen.add(other)
                yield other


def _told(
    scene: Scene,
    asked: Asked,
    listed: Listed,
    found: Identified,
    told: tuple[Found, ...],
    rows: tuple[Row, ...],
    size: Enough | None,
    solver: Solver,
    seconds: float,
) -> Compared:
    return Compared(
        scene=scene.name,
        beam=scene.beam,
        source=listed.source,
        unit=listed.unit,
        theory=asked.theory,
        found=found,
        told=told,
        rows=rows,
        size=size,
        gates=judged(found, told, rows, asked.within),
        solved=len(solver.asked),
        seconds=seconds,
        left_out={one.words: why for one, why in solver.left_out.items()},
    )
