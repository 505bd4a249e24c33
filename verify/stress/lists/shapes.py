"""Shapes of somebody else's at few places: which modes they are and might be; entries left out, in words."""

from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.limits.as_written import misplaced
from verify.stress.references.beams import STRIP, held

X = np.linspace(0.0, STRIP.length, 6)
"""Five gaps, on which mode n looks like mode 10 - n."""
SIZE = float(np.sqrt(2.0 / (STRIP.mass_per_length * STRIP.length)))
"""Of a mass-normalised sine."""


def _sines(modes: list[int], x: Array = X) -> Array:
    return np.asarray(SIZE * np.sin(np.outer(modes, pi * x / STRIP.length)))


def _given(values: Array, numbers: tuple[int, ...] | None = None, x: Array = X) -> Any:
    from verify.identify.shapes import Given

    names = tuple("abcdefg"[: len(values)])
    return Given(
        source="it",
        x=x,
        values=values,
        names=names,
        numbers=numbers,
        frequencies_hz=None,
        rounding=0.0,
        notes=(),
    )


def _of_size(size: float) -> bool:
    from verify.identify.shapes import _normalised

    paired: Any = SimpleNamespace(entries=np.array([1, 0]), modes=np.array([0, 1]))
    return _normalised(_given(np.array([1.0, -size])[:, None] * _sines([2, 1])), paired, _sines([1, 2, 3]))


def _bends(part: float) -> bool:
    """Whether a line with so much of an even wave on it is left among the modes."""
    from verify.identify.shapes import _elastic

    wave = np.array([1.0, -1.0, -1.0, 1.0])  # no part of any line
    line = np.array([1.0, 3.0, 5.0, 7.0])
    size = part / np.sqrt(1.0 - part**2) * np.linalg.norm(line) / 2.0
    x = np.linspace(0.0, STRIP.length, 4)
    kept, told = _elastic(_given(np.array([line + size * wave, wave]), (4, 7), x), STRIP)
    return kept.names == ("a", "b") and not told and kept.numbers == (4, 7)


def shapes_error(number: float) -> float:
    """How often shapes at six places are taken for other modes, the other way round, or likenesses are not told."""
    from verify.identify.shapes import _elastic, _pair, _resembling, _turned

    given = _given(np.array([[3.0], [-0.2], [1e-6], [40.0]]) * _sines([2, 1, 4, 3]))
    paired = _pair(given, _sines([1, 2, 3, 4]))
    wrong = paired.entries.tolist() != [1, 0, 3, 2] or paired.modes.tolist() != [0, 1, 2, 3] or bool(paired.unlike)
    found = [(one.mode, one.others) for one in _resembling(STRIP, given, paired)]
    wrong |= found != [(3, (7,)), (4, (6,))] or not abs(paired.likeness - 1.0).max() <= 1e-12
    few = _given(_sines([1, 2]))
    wrong |= list(_resembling(STRIP, few, _pair(few, _sines([1, 2, 3])))) != []
    both = _sines([3, 1, 7, 2])
    for name, mode in ((1, 0), (3, 2)):
        one = _pair(_given(_sines([3]), (name,)), both)
        wrong |= one.modes.tolist() != [mode]
    strange = _pair(_given(np.vstack([_sines([1]), _sines([1]), np.eye(6)[2]])), _sines([1, 2, 3]))
    told = [(one.name, one.again, round(one.best_mac, 2)) for one in strange.unlike]
    wrong |= strange.entries.tolist() != [0] or told != [("b", 1, 1.0), ("c", None, 0.36)]
    beam, x = held("clamped", "free"), np.array([0.0, 0.11, 0.37, 0.52, 0.73])
    bent = np.array([x**2 * (3.0 * 0.73 - x), x**2 * (x - 0.56)])
    same, quiet = _turned(_given(bent, None, x), beam)
    other, said = _turned(_given(bent[:, ::-1], None, 0.73 - x[::-1]), beam)
    wrong |= bool(quiet) or not abs(same.values - bent).max() <= 0.0 or len(said) != 1
    wrong |= not abs(other.values - bent).max() <= 0.0 or not abs(other.x - x).max() <= 1e-15
    line = np.linspace(1.0, 2.0, 6)
    rest, left = _elastic(_given(np.vstack([line, _sines([1])]), (1, 2)), STRIP)
    wrong |= left != ("a: a rigid motion, left out",) or rest.names != ("b",) or rest.numbers != (2,)
    return misplaced(
        ((0.5, False, _of_size), (1.5, True, _of_size), (1e-6, False, _bends)),
    ) + float(wrong)


def words_error(number: float) -> float:
    """How often entries that are rigid motions or there twice are told in other words, or other numbers are kept."""
    from verify.identify.pairing import elastic_of
    from verify.identify.reading import Listed

    exact, wrong = np.array([10.0, 40.0, 90.0, 160.0]), False
    rigid = "the first entry is a rigid motion, left out; the scene's beam has none"
    cases: tuple[tuple[list[float], Any, bool, list[int], Any, list[str]], ...] = (
        ([10.0, 40.0], None, False, [0, 1], None, []),
        (
            [0.0, 10.0, 40.0],
            (1, 2, 3),
            False,
            [1, 2],
            None,
            [rigid],
        ),
        ([0.0, 1e-9, 10.0, 90.0], (1, 2, 3, 5), True, [2, 3], (1, 3), ["the first 2 entries are rigid motions"]),
        ([10.0, 10.0, 40.0, 40.001, 90.0], None, False, [0, 2, 4], None, ["entries 2, 4 of the list repeat"]),
        ([10.0, 40.0, 40.001], (1, 2, 3), False, [0, 1], None, ["entry 3 of the list repeats the one before"]),
        ([40.0, 10.0, 90.0], (2, 3, 4), False, [0, 1, 2], (2, 3, 4), []),
    )
    for hertz, numbers, free, kept, named, said in cases:
        n = len(hertz)
        listed = Listed(frequencies_hz=np.array(hertz), numbers=numbers, rounding=np.zeros(n), source="it", unit="Hz")
        found = elastic_of(listed, held("free", "free") if free else STRIP, exact)
        wrong |= found.kept.tolist() != kept or found.numbers != named or len(found.told) != len(said)
        wrong |= not all(one.words.startswith(words) for one, words in zip(found.told, said, strict=False))
        wrong |= any(one.wrong is not (one.kind == "twice" or not free) for one in found.told)
    return float(wrong)


ROWS: tuple[Row, ...] = (
    Floor(
        id="shapes-at-few-places",
        title="Sines at six places: which modes they are and might be, the other way round, straight ones, limits",
        why="identify/shapes.py: by MAC, in order where places do not tell.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=shapes_error,
    ),
    Floor(
        id="entries-left-out",
        title="Rigid motions and repeated entries of lists, told by their rows",
        why="identify/pairing.py: what is no elastic mode of its own.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=words_error,
    ),
)
