"""Somebody's mode shapes of a scene's beam judged: which exact mode each is, how far off, whose model's it is nearest.

MAC: Allemang, "The modal assurance criterion - twenty years of use and abuse", Sound and Vibration 37 (2003). The error
of a shape is free of its scale: the least of |a s - e| / |e| over a, whose square is 1 - MAC without rounding's floor.
"""

from collections.abc import Callable, Iterator
from itertools import pairwise

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.identify.compare import Asked, compared
from verify.identify.family import CHAIN, ELEMENTS
from verify.identify.fitting import FLOOR
from verify.identify.pairing import reference_shapes
from verify.identify.reading import Listed, Shapes, check_shapes
from verify.identify.shapes_told import ALIKE, ROUNDING, Nearness, Resembling, ShapeRow, ShapesJudged, Unlike
from verify.identify.told import Compared
from verify.judge.compare import LIKENESS, mac, node_weights, pair_modes
from verify.models.arrays import Array, BoolArray, Indices
from verify.models.catalogue import MODELS
from verify.scenes.scene import Scene

SPARE = 4
"""Exact modes beyond those that names and number speak of."""
NORMALISED = 0.5
"""By how much the sizes of mass-normalised shapes may differ from the exact ones, all of them."""
FLIPPED = 0.1
"""By how much the mean MAC has to rise for a beam to be taken as the other way round."""
STRAIGHT = 1e-6
"""Of a shape: what a straight line may leave of a rigid motion."""
IN_ORDER = 1e-6
"""MAC that a mode of a shape's own place is worth more than the last: of modes that places do not tell apart."""
UNTOLD = 0.05
"""MAC by which a shape has to be more like its own mode than like another one."""
FAR = 3
"""Times a mode's number: beyond it nobody takes another for it."""


class Given(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Somebody's shapes along a beam, whoever read them."""

    source: str
    x: Array
    """(n,), metres from the left end, rising."""
    values: Array
    """(k, n)."""
    names: tuple[str, ...]
    """Of each shape."""
    numbers: tuple[int, ...] | None
    """Of modes, where the names say them."""
    frequencies_hz: Array | None
    """(k,), where they are known."""
    rounding: float
    """Of a frequency, relative."""
    notes: tuple[str, ...]
    """What was done to get them, and what was left out."""


class _Paired(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Shapes in the order of the exact modes that they are."""

    entries: Indices
    """(m,), of the given shapes, from 0."""
    modes: Indices
    """(m,), from 0, rising."""
    likeness: Array
    """(m,), MAC."""
    unlike: tuple[Unlike, ...]
    """Shapes that are no mode's, or one's that another shape is."""


def judge_shapes(scene: Scene, given: Given, count: int | None, within: float | None) -> ShapesJudged:
    """Every shape paired with an exact mode, and frequencies judged as `compare` does where there are any.

    `count` parts are those of the model that they are of, where somebody knows. Raises InputError.
    """
    check_shapes(Shapes(x=given.x, values=given.values), scene.beam.length, given.source)
    if within is not None and given.frequencies_hz is None:
        raise InputError(
            f"within = {within!r} is for frequencies, and {given.source} gave none: leave it out, or write field data "
            "named after Hz or rad/s into a .vtu"
        )
    given, notes = _elastic(given, scene.beam)
    given, turned = _turned(given, scene.beam)
    exact = _exact(given, scene.beam, given.x)
    paired = _pair(given, exact)
    found = _of_frequencies(scene, given, paired, count, within)
    size = _size(found, count, given)
    near = tuple(_nearness(scene.beam, given, paired, size, found))
    like_normalised = _normalised(given, paired, exact)
    scaled = like_normalised and _sizes_tell(near)
    untold = () if scaled or not like_normalised else (_SIZES,)
    return ShapesJudged(
        scene=scene.name,
        source=given.source,
        notes=(*given.notes, *notes, *turned, *_falling(found), *untold),
        rows=tuple(_rows(given, paired, exact, found)),
        unlike=paired.unlike,
        exchanged=bool((np.diff(paired.entries) < 0).any()),
        resembling=tuple(_resembling(scene.beam, given, paired)),
        n_points=len(given.x),
        count=size,
        normalised=scaled,
        nearest=tuple(sorted((one.by_size if scaled else one.by_form for one in near), key=lambda one: one.error)),
        compared=found,
    )


_SIZES = "sizes lie about those of mass-normalised shapes and tell no model: forms alone are compared"


def _weights(x: Array) -> Array:
    return np.sqrt(node_weights(x))


def _elastic(given: Given, beam: Beam) -> tuple[Given, tuple[str, ...]]:
    """Without rigid motions, which are straight lines. Raises InputError where nothing else is there."""
    line = np.stack([np.ones_like(given.x), given.x], axis=1)
    rest = given.values - (line @ np.linalg.lstsq(line, given.values.T, rcond=None)[0]).T
    bent = np.linalg.norm(rest, axis=1) > STRAIGHT * np.linalg.norm(given.values, axis=1)
    if bent.all():
        return given, ()
    if not bent.any():
        raise InputError(f"{given.source} has straight lines alone, no mode's shape: give elastic modes")
    names = ", ".join(name for name, kept in zip(given.names, bent, strict=True) if not kept)
    return _kept(given, bent), (f"{names}: a rigid motion, left out",)


def _kept(given: Given, which: BoolArray) -> Given:
    """Some of the shapes."""
    at = np.flatnonzero(which)
    return msgspec.structs.replace(
        given,
        values=given.values[at],
        names=tuple(given.names[i] for i in at),
        numbers=None if given.numbers is None else tuple(given.numbers[i] for i in at),
        frequencies_hz=None if given.frequencies_hz is None else given.frequencies_hz[at],
    )


def _exact(given: Given, beam: Beam, x: Array) -> Array:
    """Exact shapes, (n_modes, len(x)): as many as the names and the places let there be."""
    n = max(len(given.names), *(given.numbers or (0,))) + SPARE
    return reference_shapes(beam, max(len(given.names), min(n, len(x) - 2)), x)


def _turned(given: Given, beam: Beam) -> tuple[Given, tuple[str, ...]]:
    """The other way round where the beam's own shapes are so: its left end was their right one."""
    other = msgspec.structs.replace(given, x=beam.length - given.x[::-1], values=given.values[:, ::-1])
    here, there = (float(_likeness(one, _exact(one, beam, one.x)).max(axis=1).mean()) for one in (given, other))
    if there > here + FLIPPED:
        return other, ("x runs from right to left: the shapes are taken the other way round",)
    return given, ()


def _likeness(given: Given, exact: Array) -> Array:
    """MAC of every shape with every exact one, (k, n_modes)."""
    weights = _weights(given.x)
    values = given.values / abs(given.values).max(axis=1, keepdims=True)  # squares of any unit are numbers
    return mac(values * weights, exact * weights)


def _pair(given: Given, exact: Array) -> _Paired:
    """One exact mode for every shape that is like one, in order where places do not tell. Raises InputError."""
    every = _likeness(given, exact)
    own = np.array(given.numbers or range(1, len(every) + 1)) - 1
    apart = abs(np.arange(every.shape[1]) - own[:, None])
    modes, _ = pair_modes(every - IN_ORDER * apart / max(apart.max(), 1))
    likeness = every[np.arange(len(modes)), modes]
    like = likeness >= LIKENESS
    if not like.any():
        raise InputError(
            f"{given.source}: no shape is like one of the beam's (best MAC {float(every.max()):.2f}): check the "
            "scene's supports and which arrays are modes"
        )
    order = np.flatnonzero(like)[np.argsort(modes[like], kind="stable")]
    unlike = tuple(_unlike(given.names[i], every[i]) for i in np.flatnonzero(~like))
    return _Paired(entries=order, modes=modes[order], likeness=likeness[order], unlike=unlike)


def _unlike(name: str, likeness: Array) -> Unlike:
    """A shape that has no mode of its own, by its MAC with every exact one, (n_modes,)."""
    best = int(likeness.argmax())
    again = best + 1 if likeness[best] >= LIKENESS else None
    return Unlike(name=name, best_mac=float(likeness[best]), again=again)


def _resembling(beam: Beam, given: Given, paired: _Paired) -> Iterator[Resembling]:
    """Which other modes the shapes are as much like, at places that are fewer than two in a half wave."""
    highest, n_places = int(paired.modes.max()) + 1, len(given.x)
    if n_places - 1 > 2 * highest:
        return
    kept = _kept(given, np.isin(np.arange(len(given.names)), paired.entries))
    rows = np.argsort(np.argsort(paired.entries))
    every = _likeness(kept, reference_shapes(beam, min(FAR * highest, 2 * n_places), given.x))[rows]
    for row, mode, likeness in zip(every, paired.modes, paired.likeness, strict=True):
        near = np.flatnonzero(row[: FAR * (int(mode) + 1)] > likeness - UNTOLD)
        others = [int(other) + 1 for other in near if other != mode]
        if others:
            yield Resembling(mode=int(mode) + 1, others=tuple(others))


def _falling(found: Compared | None) -> tuple[str, ...]:
    """Where frequencies fall from a mode to the next, in words."""
    told = [(row.mode, row.frequency_hz) for row in found.rows if row.mode is not None] if found else []
    return tuple(
        f"frequencies fall from mode {a} ({above:.6g} Hz) to mode {b} ({below:.6g} Hz): they stand beside each other's "
        "shapes, or these modes change places in your model"
        for (a, above), (b, below) in pairwise(sorted(told))
        if below < above
    )


def _of_frequencies(
    scene: Scene, given: Given, paired: _Paired, count: int | None, within: float | None
) -> Compared | None:
    """What the frequencies of the paired shapes are, by their mode numbers. Raises InputError."""
    if given.frequencies_hz is None:
        return None
    hertz = given.frequencies_hz[paired.entries]
    listed = Listed(
        frequencies_hz=hertz,
        numbers=tuple(int(mode) + 1 for mode in paired.modes),
        rounding=np.full(len(hertz), given.rounding),
        source=given.source,
        unit="Hz",
    )
    if count is None and (known := _of_places(scene, listed, within, len(given.x) - 1)) is not None:
        return known
    return compared(scene, Asked(count=count, within=within), listed, None, count)


def _of_places(scene: Scene, listed: Listed, within: float | None, count: int) -> Compared | None:
    """What they are with a part between any two places, where that leaves nothing but rounding: no search of sizes."""
    try:
        found = compared(scene, Asked(count=count, within=within), listed, None, count)
    except InputError:  # no model has so few parts, or so many take too long
        return None
    best = found.found.best
    return found if best.candidate.sized and best.count == count and best.residual <= FLOOR else None


def scale_free(shape: Array, exact: Array, weights: Array) -> float:
    """The least of |a s - e| / |e| over a: all (n,)."""
    s, e = shape * weights, exact * weights
    return float(np.linalg.norm(e - s * (s @ e) / (s @ s)) / np.linalg.norm(e))


def _with_size(shape: Array, exact: Array, weights: Array) -> float:
    """The same of mass-normalised shapes, which have a size: free of sign alone."""
    s, e = shape * weights, exact * weights
    return float(min(np.linalg.norm(e - s), np.linalg.norm(e + s)) / np.linalg.norm(e))


def _normalised(given: Given, paired: _Paired, exact: Array) -> bool:
    """Whether all shapes have about the size of mass-normalised ones, so that sizes tell as well."""
    weights = _weights(given.x)
    own = np.linalg.norm(given.values[paired.entries] * weights, axis=1)
    sizes = own / np.linalg.norm(exact[paired.modes] * weights, axis=1)
    return bool((abs(sizes - 1.0) < NORMALISED).all())


def _size(found: Compared | None, count: int | None, given: Given) -> int:
    """Of the models that shapes are held against: as said, as the frequencies tell, else a part between two places."""
    if count is not None:
        return count
    known = found.found.best.count if found is not None and found.found.explained else None
    return known or len(given.x) - 1


class _Near(msgspec.Struct, frozen=True, kw_only=True):
    """How far all shapes lie from those of one model."""

    by_form: Nearness
    by_size: Nearness
    """The same of shapes that have a size, as mass-normalised ones."""


def _nearness(beam: Beam, given: Given, paired: _Paired, count: int, found: Compared | None) -> Iterator[_Near]:
    """How far all shapes lie from those of each model, root mean square over the modes."""
    weights, own = _weights(given.x), given.values[paired.entries]
    for words, size, shapes in _models(beam, given.x, int(paired.modes.max()) + 1, count, found):
        try:
            theirs = shapes()[paired.modes]
        except InputError:  # this beam, or so few parts, is none of its own
            continue
        form, with_size = (
            Nearness(words=words, count=size, error=_mean_square(error, own, theirs, weights))
            for error in (scale_free, _with_size)
        )
        yield _Near(by_form=form, by_size=with_size)


def _mean_square(error: Callable[[Array, Array, Array], float], own: Array, theirs: Array, weights: Array) -> float:
    """The root of the mean square of errors of shapes (k, n)."""
    errors = np.array([error(one, other, weights) for one, other in zip(own, theirs, strict=True)])
    return float(np.sqrt(np.mean(errors**2)))


def _sizes_tell(near: tuple[_Near, ...]) -> bool:
    """Whether sizes tell models apart: those of the nearest fit as well as its forms do, and no forms fit better.

    Shapes of another normalisation, by chance about as large, are as large as those of no model.
    """
    if not near:
        return False
    best = min(near, key=lambda one: one.by_size.error)
    least = min(one.by_form.error for one in near)
    return max(best.by_size.error, best.by_form.error) <= max(ALIKE * min(best.by_form.error, least), ROUNDING)


def _models(
    beam: Beam, x: Array, n: int, count: int, found: Compared | None
) -> Iterator[tuple[str, int | None, Callable[[], Array]]]:
    """(words, parts, shapes at x (n, len(x)) when asked for), a chain by the rules that frequencies tell."""
    best = found.found.best.candidate if found is not None and found.found.explained else None
    rules = dict(best.settings) if best is not None and best.model == CHAIN and best.packaged else {}

    def chain_corrected() -> Array:
        return np.asarray(MODELS[CHAIN].solve_modes(beam, n, count, **rules).deflection(x))

    def chain_raw() -> Array:
        modes = MODELS[CHAIN].solve_modes(beam, n, count, **rules)
        return np.array([np.interp(x, modes.nodes, shape) for shape in modes.readings["raw"]()])

    yield "the exact beam", None, lambda: reference_shapes(beam, n, x)
    yield "elements", count, lambda: MODELS[ELEMENTS].solve_modes(beam, n, count).deflection(x)
    yield "segments, joints corrected", count, chain_corrected
    yield "segments, raw joints", count, chain_raw


def _rows(given: Given, paired: _Paired, exact: Array, found: Compared | None) -> Iterator[ShapeRow]:
    weights = _weights(given.x)
    known = {} if found is None else {row.mode: row for row in found.rows}
    for entry, mode, likeness in zip(paired.entries, paired.modes, paired.likeness, strict=True):
        row = known.get(int(mode) + 1)
        yield ShapeRow(
            name=given.names[entry],
            mode=int(mode) + 1,
            likeness=float(likeness),
            error=scale_free(given.values[entry], exact[mode], weights),
            frequency_hz=row.frequency_hz if row else None,
            exact_hz=row.exact_hz if row else None,
            frequency_error=row.error if row else None,
        )
