"""Lists of frequencies and shapes by closed forms, told by `compare` what they are and what is wrong with them."""

from collections.abc import Iterator
from functools import cache
from math import pi
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam
from verify.stress.judge.sizes_chosen import turned_error
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.told_of_runs import timoshenko_rate
from verify.stress.references.beams import STRIP, held
from verify.stress.references.textbook import assembled

# --- Members of the family --------------------------------------------------------------------------------------------

PARTS, MODES = 14, 8
MEMBERS: tuple[tuple[str, str], ...] = (
    ("segment", "links"),
    ("segment", "points"),
    ("segment", "joints"),
    ("fem", "consistent"),
    ("fem", "lumped-rotary"),
    ("fem", "hrz"),
)
ROTARY = {"lumped-rotary": 1.0 / 12.0, "hrz": 1.0 / 39.0}
"""Of a node, over m l^2: what both elements beside it leave there. Lumped without it they are the chain of links."""


def turned_rate(model: str, mass: str, mu: float) -> float:
    """Omega l^2 / sqrt(EI / (rho A)) of a sine of turn mu from part to part, by what a node or a joint has."""
    if mass in ("links", "consistent"):
        return mu**2 * (1.0 + turned_error(model, mu))
    c, s = np.cos(mu), np.sin(mu)
    if model == "segment":
        return float(2.0 * (1.0 - c) / np.sqrt(0.5 * (1.0 + c) if mass == "points" else 1.0))
    stiffness = np.array([[24.0 - 24.0 * c, 12.0 * s], [12.0 * s, 8.0 + 4.0 * c]])
    return float(np.sqrt(np.linalg.eigvals(stiffness / np.array([[1.0], [ROTARY[mass]]])).real.min()))


@cache
def listed(model: str, mass: str, parts: int = PARTS) -> tuple[float, ...]:
    """Hertz of the strip between pins."""
    unit = STRIP.wave_constant * (parts / STRIP.length) ** 2 / (2.0 * pi)
    return tuple(unit * turned_rate(model, mass, mode * pi / parts) for mode in range(1, MODES + 1))


EXACT = tuple(STRIP.wave_constant * (mode * pi / STRIP.length) ** 2 / (2.0 * pi) for mode in range(1, MODES + 1))


def told_of(text: str, beam: Beam = STRIP, **asked: Any) -> dict[str, Any]:
    """What is said of a list, as plain data."""
    from verify.identify.compare import Asked, compare
    from verify.scenes.scene import Scene

    with TemporaryDirectory() as folder:
        path = Path(folder) / "list.csv"
        path.write_text(text)
        return compare(Scene(name="listed", title="", beam=beam), Asked(frequencies=path, **asked)).plain()


def lines(hertz: Any, form: str = ".17g") -> str:
    """A list without a head."""
    return "\n".join(format(float(one), form) for one in hertz)


def member_error(number: float) -> float:
    """How much a member's list is taken for another's, or its errors and the parts that would do for others."""
    model, mass = MEMBERS[int(number)]
    hertz = listed(model, mass)
    found = told_of(lines(hertz), count=PARTS, mode=5, error=0.01)
    best, needed, wrong = found["best"], found["parts_needed"], float(not found["passed"])
    wrong += (best["model"], best["mass"], best["theory"], best["count"]) != (model, mass, "euler-bernoulli", PARTS)
    wrong += bool(found["told"]) or not best["identified"] or not best["residual"] < 1e-10
    errors = {n: abs(turned_rate(model, mass, 5.0 * pi / n) / (5.0 * pi / n) ** 2 - 1.0) for n in range(6, 200)}
    wrong += needed["count"] != max((n for n, error in errors.items() if error > 0.01), default=5) + 1
    for row, given, exact in zip(found["modes"], hertz, EXACT, strict=True):
        wrong += (
            not abs(row["error"] - (given / exact - 1.0)) <= 1e-12 or not abs(row["exact_hz"] / exact - 1.0) <= 1e-12
        )
    return float(wrong)


# --- Lists that are not as they should be -----------------------------------------------------------------------------


def mended_error(number: float) -> float:
    """How much of what is wrong with a list is not said of it, or not by how much."""
    found, kinds, own = FAULTY[int(number)]()
    best, wrong = found["best"], float([one["kind"] for one in found["told"]] != kinds)
    wrong += found["passed"] is bool(kinds)
    return float(wrong + sum(best[name] != value for name, value in own.items()))


def _in_radians() -> Any:
    """With a head, numbers and a unit."""
    hertz = listed("fem", "consistent", 11)
    text = "\n".join(f"{n},{2.0 * pi * one:.17g}" for n, one in enumerate(hertz, start=1))
    found = told_of(f"mode,omega [rad/s]\n{text}", count=11)
    wrong = found["unit"] != "rad/s" or not abs(found["modes"][7]["frequency_hz"] / hertz[7] - 1.0) <= 1e-12
    return found, ["wrong"] * wrong, {"model": "fem", "mass": "consistent", "count": 11}


def _another_unit() -> Any:
    """In rad/s, and nobody says so."""
    found = told_of(lines(2.0 * pi * one for one in listed("segment", "links")), count=PARTS)
    return found, ["unit"], {"model": "segment", "mass": "links", "count": PARTS, "identified": True}


def _scaled() -> Any:
    """By one factor."""
    found = told_of(lines(1.013 * one for one in EXACT), count=11)
    wrong = not abs(found["factor"] - 1.013) <= 1e-9
    return found, ["scale"] + ["wrong"] * wrong, {"model": "analytic"}


def _one_missing() -> Any:
    """The fourth mode."""
    found = told_of(lines(np.delete(listed("segment", "links"), 3)), count=PARTS)
    wrong = [row["read_as"] for row in found["modes"] if row["entry"]] != [1, 2, 3, 5, 6, 7, 8]
    return found, ["missing"] + ["wrong"] * wrong, {"model": "segment", "mass": "links", "count": PARTS}


def _one_rigid() -> Any:
    """A motion that the pins do not leave."""
    return told_of(lines([1e-5, *listed("segment", "links")]), count=PARTS), ["rigid"], {"mass": "links"}


def _another_count() -> Any:
    """Of twice as many parts as are said."""
    return told_of(lines(listed("segment", "joints", 22)), count=11), ["count"], {"mass": "joints", "count": 22}


def _soft() -> Any:
    """Of ten elements, written out, on a spring of 50 EI / L in place of a clamp; a mass at the tip would do too."""
    from verify.stress.references.dense import Elements

    beam, count = held("clamped", "free"), 10
    spring = PointSpring(position=0.0, rotational=50.0 * beam.bending_stiffness / beam.length)
    soft = replace(beam, supports=("pinned", "free"), spring=(spring,))
    hertz = Elements(soft, np.linspace(0.0, beam.length, count + 1)).hertz(MODES)
    found = told_of(lines(hertz), beam, count=count, kind="elements")
    clamps = [one["clamp"] for one in found["causes"]]
    wrong = (
        clamps[0] is None or not abs(clamps[0]["k_r_L_over_EI"] / 50.0 - 1.0) <= 1e-6 or clamps[0]["ends"] != ["left"]
    )
    own = {"model": "fem", "mass": "consistent", "count": count}
    return found, ["clamp", "twin"] + ["wrong"] * wrong, own


def _rounded() -> Any:
    """To five digits, within 2 %."""
    found = told_of(lines(listed("segment", "links"), ".5g"), count=PARTS, within=0.02)
    wrong = not found["passed"] or len(found["gates"]) != 3
    return found, ["wrong"] * wrong, {"mass": "links", "count": PARTS, "identified": True}


def _thick() -> Any:
    """The exact beam that shears."""
    found = told_of(lines(timoshenko_rate(mode) / (2.0 * pi) for mode in range(1, MODES + 1)), count=11)
    return found, [], {"model": "analytic", "theory": "timoshenko", "identified": True}


def _two_elements() -> Any:
    """Of two elements where four are said: the smallest size there is to be looked at."""
    from scipy.linalg import eigh

    roots = np.sqrt(eigh(*(one.toarray() for one in assembled("fem", STRIP.supports, 2)), eigvals_only=True))
    found = told_of(lines(roots * STRIP.wave_constant * (2.0 / STRIP.length) ** 2 / (2.0 * pi)), count=4)
    return found, ["count"], {"model": "fem", "mass": "consistent", "count": 2}


FAULTY = (
    _in_radians,
    _another_unit,
    _scaled,
    _one_missing,
    _one_rigid,
    _another_count,
    _soft,
    _rounded,
    _thick,
    _two_elements,
)


NOISE = np.exp([0.061, -0.043, 0.008, -0.072, 0.033, 0.054, -0.019, -0.038])


def _unclaimed() -> Iterator[bool]:
    """Of noise of 5 % about 1.3 times a list, of pairs too few for a fit, of a chain of one link."""
    from verify.identify.alignment import in_order_of
    from verify.identify.family import family, frequencies_hz
    from verify.identify.fitting import judged_fit

    found = told_of(lines(1.3 * NOISE * EXACT), count=11, kind="elements")
    yield not found["told"] and not found["passed"]
    yield (found["factor"], found["unit"], found["best"]["identified"]) == (1.0, "Hz", False)
    member = family(STRIP)[0]
    for paired, n, fits in ((3, 7, False), (4, 7, True), (2, 3, False), (3, 3, True), (2, 2, True), (3, 6, False)):
        pairs, still = in_order_of(paired), np.zeros(paired)
        fit = judged_fit(member, 9, pairs, still, 1.0, still, 0.0, n)
        yield bool(np.isfinite(fit.score)) is fits
    for one in family(STRIP):
        if one.packaged and one.model == "segment":
            yield frequencies_hz(one, STRIP, 1, 5).shape == (0,)


def unclaimed_error(number: float) -> float:
    """How much is claimed of lists that are nothing, and of sizes that have no frequencies."""
    return float(sum(not right for right in _unclaimed()))


def orders_error(number: float) -> float:
    """Of the order of mode 2 of each member of a family, seen between 40 and 80 parts; above 3 where signs change."""
    from verify.identify.family import EXACT as BEAM_ITSELF
    from verify.identify.family import exact_hz, family, frequencies_hz

    beam, worst = held(*ENDS[int(number)]), 0.0
    exact = float(exact_hz(beam, 2)[-1])
    for one in family(beam):
        if one.theory != "euler-bernoulli" or one.model == BEAM_ITSELF:
            continue
        coarse, fine = (abs(float(frequencies_hz(one, beam, n, 2)[-1]) / exact - 1.0) for n in (40, 80))
        order = float(np.log2(coarse / fine))
        crossed = one.wall in ("gregory", "five-joint") and one.mass == "links"
        worst = largest(worst, max(3.0 - order, 0.0) if crossed else abs(order - (one.order or 0)))
    return worst


ENDS = (("pinned", "pinned"), ("clamped", "free"), ("guided", "clamped"), ("free", "free"))

# --- Shapes -----------------------------------------------------------------------------------------------------------

AT = np.array([0.0, 0.03, 0.08, 0.11, 0.17, 0.21, 0.26, 0.31, 0.37, 0.4, 0.46, 0.5, 0.55, 0.61, 0.66, 0.7, 0.73])


def shapes_error(unlike: float) -> float:
    """Of sines in another order, of any scale and beside a rigid motion: names, likeness and least errors.

    The first has a share of the fifth sine in it, whose square is what its likeness lacks.
    """
    from verify.identify.shapes import Given, judge_shapes
    from verify.scenes.scene import Scene

    sines = np.sin(np.outer([1.0, 2.0, 3.0, 5.0], pi * AT / STRIP.length))
    values = np.array([3.0 * sines[1], unlike * sines[3] - sines[0], 0.2 + 1.1 * AT, 0.4 * sines[2]])
    given = Given(
        source="list",
        x=AT,
        values=values,
        names=("b", "a", "r", "c"),
        numbers=None,
        frequencies_hz=None,
        rounding=0.0,
        notes=(),
    )
    found = judge_shapes(Scene(name="listed", title="", beam=STRIP), given, None, None)
    wrong = [(row.name, row.mode) for row in found.rows] != [("a", 1), ("b", 2), ("c", 3)]
    wrong |= not found.exchanged or bool(found.unlike)
    wrong |= [note[:2] for note in found.notes] != ["r:"]
    lengths = np.diff(AT)
    weights = 0.5 * (np.append(lengths, 0.0) + np.append(0.0, lengths))
    one, other = values[1], sines[0]
    squares = [float(weights @ (a * b)) for a, b in ((one, other), (one, one), (other, other))]
    likeness = squares[0] ** 2 / squares[1] / squares[2]
    exact = [(likeness, np.sqrt(1.0 - likeness)), (1.0, 0.0), (1.0, 0.0)]
    off = [max(abs(row.likeness - a), abs(row.error - b)) for row, (a, b) in zip(found.rows, exact, strict=True)]
    return float(largest(*off, wrong))


ROWS: tuple[Row, ...] = (
    Floor(
        id="lists-of-members",
        title="Lists by the dispersions of six discrete beams, told which they are, their errors and enough parts",
        why="identify: members of the family are known by their frequencies alone.",
        along="member",
        at=tuple(range(len(MEMBERS))),
        promise=0.5,
        error=member_error,
    ),
    Floor(
        id="lists-with-faults",
        title="Lists in another unit, scaled, with a mode missing or too many, of a soft clamp, told what is wrong",
        why="identify: each reading is taken up where it explains what the plain one does not.",
        along="list",
        at=tuple(range(len(FAULTY))),
        promise=0.5,
        error=mended_error,
    ),
    Floor(
        id="lists-of-nothing",
        title="A list that is nothing, fits of too few of its entries, a chain of one link: nothing is claimed",
        why="identify/causes.py, fitting.py: what is told of a list has to be borne out.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=unclaimed_error,
    ),
    Floor(
        id="orders-of-members",
        title="Orders that members of a family declare, seen between 40 and 80 parts",
        why="identify/family.py: the next order is seen as well on so few parts.",
        along="supports",
        at=tuple(range(len(ENDS))),
        promise=0.1,
        error=orders_error,
    ),
    Floor(
        id="shapes-of-sines",
        title="Sines in another order beside a rigid motion, told which modes they are and by how much they are off",
        why="identify/shapes.py: likeness and least error by the trapezoidal rule, to rounding.",
        along="share of the fifth sine",
        at=(0.04,),
        promise=1e-9,
        error=shapes_error,
    ),
)
