"""What `compare` shows of lists by closed forms: its tables, its chart, its sentences; what is run with what."""

from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import numpy as np

from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.lists.members import AT, EXACT, MODES, PARTS, lines, listed
from verify.stress.references.beams import STRIP


class Given(NamedTuple):
    """A list, and what becomes of it."""

    hertz: Array
    read: tuple[int, ...]
    """As which mode each entry is read."""
    factor: float
    """By which all are off; 1.0: none."""
    best: Array
    """Hz of the best candidate, of the modes that are read."""
    words: str
    parts: int | None
    order: int | None


FACTOR = 1.013
CHAIN = np.array(listed("segment", "points"))
LISTS = (
    Given(CHAIN, tuple(range(1, MODES + 1)), 1.0, CHAIN, "without their own inertia", PARTS, 2),
    Given(FACTOR * np.array(EXACT), tuple(range(1, MODES + 1)), FACTOR, np.array(EXACT), "the exact beam", None, None),
    Given(
        np.delete(CHAIN, 3),
        (1, 2, 3, *range(5, MODES + 1)),
        1.0,
        np.delete(CHAIN, 3),
        "without their own inertia",
        PARTS,
        2,
    ),
)


def _compared(given: Given) -> Any:
    from verify.identify.compare import Asked, compare
    from verify.scenes.scene import Scene

    with TemporaryDirectory() as folder:
        path = Path(folder) / "list.csv"
        path.write_text(lines(given.hertz))
        asked = Asked(frequencies=path, count=given.parts or 11)
        return compare(Scene(name="listed", title="", beam=STRIP), asked)


def _near(found: Any, exact: Any) -> bool:
    return bool(np.allclose(np.asarray(found, dtype=float), exact, rtol=1e-9, atol=1e-9))


def shown_error(number: float) -> float:
    """How many of its tables, lines and sentences are not what the list, the exact beam and the best candidate say.

    Of a list that lacks a mode the chart shows the entries as they are read alone.
    """
    given, exact = LISTS[int(number)], np.array(EXACT)
    found, wrong, n = _compared(given), 0, len(given.hertz)
    scaled, shifted = given.factor != 1.0, given.read != tuple(range(1, n + 1))
    read = exact[np.array(given.read) - 1]
    errors, freed = given.hertz / exact[:n] - 1.0, given.hertz / given.factor / read - 1.0
    modes, candidates = found.tables()
    columns = [np.arange(1, n + 1), np.arange(1, n + 1), given.hertz, exact[:n], errors]
    columns += [given.hertz / given.factor] * scaled + [given.read] * shifted + [freed] * (scaled or shifted)
    columns += [given.best]
    wrong += len(modes.columns) != len(columns) + 1 or any(row[-1] != "rounding" for row in modes.rows)
    wrong += not _near([row[:-1] for row in modes.rows], np.array(columns).T)
    wrong += len(modes.notes) != scaled + shifted
    first = candidates.rows[0]
    wrong += given.words not in first[0] or first[1:4] != (given.parts, given.order, "rounding") or first[4] > 1e-9
    left = [row[3] for row in candidates.rows[1:]]
    wrong += len(left) < 3 or any(b != "rounding" and a == "rounding" for a, b in zip(left[1:], left, strict=False))
    (chart,) = found.charts()
    own = [line for line in chart.lines if line.name.startswith("yours")]
    wrong += [line.joined for line in own] != len(own) * [False] or len(own) != 1 + scaled
    wrong += not _near(own[0].y, 100.0 * (freed if shifted else errors)) or not _near(own[-1].y, 100.0 * freed)
    wrong += [int(x) for x in own[-1].x] != list(given.read) or any(chart.lines[0].y)
    best = next(line for line in chart.lines if given.words in line.name)
    wrong += not _near(best.y, 100.0 * (given.best / read - 1.0)) or [int(x) for x in best.x] != list(given.read)
    worst = int(np.argmax(abs(errors)))
    wrong += f"{100.0 * errors[worst]:+.4f} %, at mode {worst + 1}" not in found.facts()[1].replace(
        "\N{MINUS SIGN}", "-"
    )
    wrong += ("of your list as it is" in found.facts()[1]) is not (scaled or shifted)
    return float(wrong)


def sentences_error(unlike: float) -> float:
    """How many cells and words about sines, one of them with a share of another, are not theirs."""
    from verify.identify.shapes import Given as Shapes
    from verify.identify.shapes import judge_shapes
    from verify.scenes.scene import Scene

    sines = np.sin(np.outer([1.0, 2.0, 3.0, 5.0], np.pi * AT / STRIP.length))
    order = (0, 1, 2) if unlike else (1, 0, 3)
    values = sines[list(order)] + np.array([[unlike], [0.0], [0.0]]) * sines[3]
    given = Shapes(
        source="list",
        x=AT,
        values=values,
        names=("a", "b", "c"),
        numbers=None,
        frequencies_hz=None,
        rounding=0.0,
        notes=(),
    )
    found = judge_shapes(Scene(name="listed", title="", beam=STRIP), given, None, None)
    table, models = found.tables()
    read = [((1, 2, 3, 5)[i], name) for i, name in zip(order, "abc", strict=True)]
    wrong = [(row[1], row[0]) for row in table.rows] != sorted(read)
    wrong |= [row[3] == "rounding" for row in table.rows] != ([False, True, True] if unlike else [True, True, True])
    said = "3 shapes are of modes 1 to 3, the worst" if unlike else "3 shapes are of modes 1, 2, 5, each in form"
    wrong |= not found.answer.startswith(said) or "In form nearest: " not in found.answer
    (gate,) = found.gates
    wrong |= gate.passed is not bool(unlike) or found.passed is not bool(unlike)
    wrong |= "they are modes 1 (b), 2 (a), 5 (c)" not in gate.reason if not unlike else bool(gate.reason)
    sizes = [0.0 if row[1] == "rounding" else row[1] for row in models.rows]
    wrong |= sizes != sorted(sizes) or models.title != "Models beside, by form alone"
    return float(wrong)


def combined_error(cells: float) -> float:
    """How many cells of field, friction, contact, slider and coupling are told to be run by what they are not."""
    from verify.motor.combine import combinations

    found = {cell[:5]: cell[5] for cell in combinations()}
    wrong = int(len(found) != int(cells))
    for (field, friction, normal, shape, coupling), told in found.items():
        chain, alone = field == "chain", coupling == "one-way"
        runs = {
            "springs": "run_motor" if (alone or not chain) and (shape != "layer" or friction == "coulomb") else "",
            "hard": "run_motor" if shape == "point" and alone and not chain else "",
            "always on": "" if shape != "point" or (chain and not alone) else "chain.ride" if chain else "simulate",
        }[normal]
        wrong += told != runs if runs else not told.startswith("refused: ")
    return float(wrong)


ROWS: tuple[Row, ...] = (
    Floor(
        id="what-compare-shows",
        title="Tables, chart and sentences of a list as it is, of one that is scaled, of one that lacks a mode",
        why="identify/told.py: what is shown is what was given, read and found.",
        along="list",
        at=tuple(range(len(LISTS))),
        promise=0.5,
        error=shown_error,
    ),
    Floor(
        id="sentences-about-shapes",
        title="Tables, sentence and gate about sines in order and out of it, plain and with a share of another",
        why="identify/shapes_told.py: likewise.",
        along="share of the fifth sine",
        at=(0.0, 0.04),
        promise=0.5,
        error=sentences_error,
    ),
    Floor(
        id="what-is-run-with-what",
        title="Fields, frictions, contacts, sliders and couplings, by what each is run or that it is refused",
        why="motor/combine.py: every cell.",
        along="cells",
        at=(144.0,),
        promise=0.5,
        error=combined_error,
    ),
)
