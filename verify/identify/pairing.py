"""Which mode each entry of a list is: by its shape, by its number, and what is no elastic mode at all."""

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.identify.alignment import Pairs
from verify.identify.reading import Listed, Shapes
from verify.judge.compare import LIKENESS, mac, node_weights, pair_modes
from verify.models.arrays import Array, Indices

_TINY = 3e-3
"""Of the entry above it: a frequency that is rounding, where the exact beam has no such gap."""
_FARTHEST = 1e6
"""Times the beam's own frequencies: beyond it a list is of something else."""
_TWICE = 1e-3
"""Closer than this two entries are one mode, unless the exact beam has two so close there."""
_PAIRED = 3.0
"""Times that: up to here a model of few parts may bring two modes of the beam as close."""


class Found(msgspec.Struct, frozen=True, kw_only=True):
    """Something about a list that is to be told."""

    kind: str
    """What it is about: unit, scale, clamp, causes, missing, extra, apart, twice, rigid, swapped, count, supports,
    leaving, twin, unlike or unsearched."""
    words: str
    """A sentence without its full stop."""
    wrong: bool = True
    """Whether the list is to be mended."""


class Elastic(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A list without what is no elastic mode of its own."""

    kept: Indices
    """(k,): which entries of the list, from 0."""
    numbers: tuple[int, ...] | None
    """Their mode numbers, from 1 of elastic ones, where the list has numbers that say more than their order."""
    told: tuple[Found, ...]


def elastic_of(listed: Listed, beam: Beam, exact: Array) -> Elastic:
    """The entries that are elastic modes: without leading rigid ones and repeated ones. Raises InputError for none."""
    values = listed.frequencies_hz
    rigid, told = _n_rigid(values, exact), []
    if rigid == len(values):
        raise InputError(f"{listed.source} holds zeros alone: give the frequencies of elastic modes")
    _check_sizes(listed, rigid, exact)
    if rigid:
        told.append(_rigid_words(rigid, beam))
    kept = list(range(rigid, rigid + 1))
    twice = []
    for i in range(rigid + 1, len(values)):
        if abs(values[i] / values[kept[-1]] - 1.0) < _TWICE and not _close_there(exact, len(kept)):
            twice.append(i)
        else:
            kept.append(i)
    if twice:
        rows = ", ".join(str(i + 1) for i in twice[:5]) + (" and more" if len(twice) > 5 else "")
        said = f"entries {rows} of the list repeat" if len(twice) > 1 else f"entry {rows} of the list repeats"
        told.append(Found(kind="twice", words=f"{said} the one before: a mode is there twice"))
    return Elastic(kept=np.array(kept, dtype=np.intp), numbers=_numbers(listed, kept, rigid), told=tuple(told))


def _close_there(exact: Array, place: int) -> bool:
    """Whether the beam's mode at a place, from 0, is about as close to the one before: two spans, hardly coupled."""
    return bool(exact[place] / exact[place - 1] - 1.0 < _PAIRED * _TWICE)


def _check_sizes(listed: Listed, rigid: int, exact: Array) -> None:
    """Raise InputError for a frequency that no unit and no model brings anywhere near the beam's own."""
    for value in listed.frequencies_hz[rigid:]:
        if not float(exact[0]) / _FARTHEST < value < float(exact[-1]) * _FARTHEST:
            raise InputError(
                f"{listed.source} has {float(value)!r} Hz, and the beam's modes lie from {float(exact[0]):.6g} Hz on: "
                "check the scene, or the unit"
            )


def _n_rigid(values: Array, exact: Array) -> int:
    """How many leading entries are far below the next, as no elastic mode of the beam is."""
    for k in range(min(len(values), 6), 0, -1):
        below = float(values[:k].max())
        if below == 0.0 and (k == len(values) or values[k] > 0.0):
            return k
        gap = float(exact[k - 1] / exact[k]) if k < len(exact) else 1.0
        if k < len(values) and below < _TINY * min(gap * 4.0, 1.0) * values[k]:
            return k
    return 0


def _rigid_words(rigid: int, beam: Beam) -> Found:
    entries = "the first entry is a rigid motion" if rigid == 1 else f"the first {rigid} entries are rigid motions"
    wrong = rigid != beam.rigid_motions
    has = {0: "none", 1: "one"}.get(beam.rigid_motions, str(beam.rigid_motions))
    words = f"{entries}, left out" + (f"; the scene's beam has {has}: hold yours as it is held" if wrong else "")
    return Found(kind="rigid", words=words, wrong=wrong)


def _numbers(listed: Listed, kept: list[int], rigid: int) -> tuple[int, ...] | None:
    """Mode numbers of what is kept; None where they are but the order in which its frequencies rise."""
    if listed.numbers is None:
        return None
    shift = rigid if rigid and listed.numbers[0] == 1 else 0
    numbers = tuple(listed.numbers[i] - shift for i in kept)
    in_order = numbers == tuple(range(1, len(kept) + 1)) and bool((np.diff(listed.frequencies_hz[kept]) >= 0.0).all())
    return None if in_order or len(kept) < listed.n - rigid else numbers


def by_number(numbers: tuple[int, ...]) -> Pairs:
    """The pairs that mode numbers say."""
    return Pairs(entries=np.arange(len(numbers)), modes=np.array(numbers, dtype=np.intp) - 1)


def reference_shapes(beam: Beam, n_modes: int, x: Array) -> Array:
    """Shapes of the beam's own modes at x, (n_modes, len(x)): exact ones, or where none are known of fine elements."""
    from verify.exact.modes import mode_shapes

    try:
        return mode_shapes(beam, n_modes, x)
    except InputError:
        from verify.elements.linear import solve_modes

        return solve_modes(beam, n_modes, max(10 * n_modes, 8 * len(beam.pieces))).deflection(x)


def by_shape(beam: Beam, shapes: Shapes, kept: Indices) -> tuple[Pairs, Array, tuple[Found, ...]]:
    """(the pairs that shapes say, their MAC (k,), what is to be told). Raises InputError where no shape is a mode's."""
    values = shapes.values[kept]
    values = values / abs(values).max(axis=1, keepdims=True)  # in whatever unit: squares of it are numbers
    n = len(values)
    weights = np.sqrt(node_weights(shapes.x))
    reference = reference_shapes(beam, max(n, min(n + 4, len(shapes.x) - 2)), shapes.x)
    modes, likeness = pair_modes(mac(values * weights, reference * weights))
    like = likeness >= LIKENESS
    if not like.any():
        raise InputError(
            f"modes: no shape is like one of the beam's (best MAC {float(likeness.max()):.2f}): check the unit of x "
            "and which column is which mode"
        )
    told = [
        Found(kind="unlike", words=f"the shape of entry {kept[i] + 1} is like no mode's (best MAC {likeness[i]:.2f})")
        for i in np.flatnonzero(~like)
    ]
    entries = np.flatnonzero(like)
    return Pairs(entries=entries, modes=modes[like]), likeness[like], tuple(told)


def swapped(pairs: Pairs) -> tuple[Found, ...]:
    """Neighbouring entries that stand in the wrong order, and modes that are missing between."""
    told, modes = [], [int(mode) + 1 for mode in pairs.modes]
    ordered = sorted(modes)
    wrong = [(a, b) for a, b in zip(modes, ordered, strict=True) if a != b]
    if wrong:
        names = ", ".join(str(b) for _, b in wrong)
        verb = "are exchanged" if len(wrong) == 2 else "stand in another order"
        told.append(Found(kind="swapped", words=f"modes {names} {verb}: by their shapes they are {_listed(wrong)}"))
    return tuple(told)


def _listed(wrong: list[tuple[int, int]]) -> str:
    return ", ".join(str(a) for a, _ in wrong)


def missing(pairs: Pairs, kept: Indices) -> tuple[Found, ...]:
    """Modes below the last that none of the entries that are kept is, and those of them that are no mode."""
    told = []
    there = {int(mode) + 1 for mode in pairs.modes}
    gone = [mode for mode in range(1, max(there) + 1) if mode not in there]
    if gone:
        verb = "mode {} is missing" if len(gone) == 1 else "modes {} are missing"
        told.append(Found(kind="missing", words=verb.format(", ".join(map(str, gone))) + " from the list"))
    extra = sorted(set(range(len(kept))) - {int(i) for i in pairs.entries})
    if extra:
        verb = "entry {} is none of the beam's bending modes" if len(extra) == 1 else "entries {} are no bending modes"
        told.append(Found(kind="extra", words=verb.format(", ".join(str(kept[i] + 1) for i in extra))))
    return tuple(told)
