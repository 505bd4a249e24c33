"""How many parts an accuracy takes and where the cheaper method changes, against every size tried one by one."""

from collections.abc import Iterator
from functools import cache, partial
from math import cos, log, pi, sin, sqrt

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import PointForce
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STEPPED, STRIP, held

MOST = 90
"""Parts, up to which every size is tried."""
ASKED = (0.1, 0.02, 0.01, 1e-3, 1e-5)


@cache
def pinned_error(model: str, mode: int, count: int) -> float:
    """Relative, of a frequency between pins."""
    return turned_error(model, mode * pi / count)


def turned_error(model: str, mu: float) -> float:
    """Relative, of the frequency of a sine of turn mu from part to part, by the two equations of a node."""
    c, s = cos(mu), sin(mu)
    if model == "segment":
        return 2.0 * (1.0 - c) / mu**2 / sqrt(1.0 - (1.0 - c) / 3.0) - 1.0
    stiffness = np.array([[24.0 - 24.0 * c, 12.0 * s], [12.0 * s, 8.0 + 4.0 * c]])
    mass = np.array([[312.0 + 108.0 * c, -26.0 * s], [-26.0 * s, 8.0 - 6.0 * c]]) / 420.0
    return sqrt(float(min(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real))) / mu**2 - 1.0


def enough_error(mode: float) -> float:
    """By how many parts the size from which on an error is kept is missed, both models, pinned, every error."""
    from verify.judge.sizing import enough_from

    bench, number, missed = Workbench(STRIP), int(mode), 0
    for model in ("segment", "fem"):
        errors = {n: abs(pinned_error(model, number, n)) for n in range(number + 1, MOST)}
        for asked in ASKED:
            exact = max((n for n, error in errors.items() if error > asked), default=number) + 1
            if exact < MOST // 2:
                missed += abs(enough_from(bench, model, number, asked).count - exact)
    return float(missed)


def solves_error(mode: float) -> float:
    """Solves beyond the two that a right guess costs, on a beam whose law is proven: the size, and one part less."""
    from verify.judge.sizing import enough_from

    more = 0
    for model in ("segment", "fem"):
        for asked in (0.01, 1e-3, 1e-5):
            bench = Workbench(STRIP)
            enough_from(bench, model, int(mode), asked)
            more += max(len(bench.solves) - 2, 0)
    return float(more)


def scanned_error(mode: float) -> float:
    """The same of sizes on a clamped and a stepped beam, where errors change their sign, against all sizes."""
    from verify.judge.sizing import choose_of_all, enough_from

    number, missed = int(mode), 0.0
    for beam, rules in ((held("clamped", "free"), ((), (("wall", "half"),))), (STEPPED, ((),))):
        bench = Workbench(beam)
        for model in ("segment", "fem"):
            for settings in rules if model == "segment" else ((),):
                found = enough_from(bench, model, number, 0.01, settings)
                errors = {n: abs(bench.frequency_error(model, n, number, settings)) for n in range(number + 2, 30)}
                kept = max((n for n, error in errors.items() if error > 0.01), default=number + 1) + 1
                least = next((n for n in range(number + 2, kept) if errors[n] <= 0.01), None)
                missed += abs(found.count - kept) + (found.smaller != least)
    choices, left_out = choose_of_all(Workbench(held("clamped", "free")), number, 0.01)
    told = {(one.model, one.settings): (one.count, one.error) for one in choices}
    counts = [told["segment", (("wall", "half"),)][0], told["segment", ()][0], told["fem", ()][0]]
    missed += float(bool(left_out) or len(told) != 3 or sorted(counts, reverse=True)[0] != counts[0])
    missed += sum(not abs(error) <= 0.01 for _, error in told.values())
    return missed


LADEN = replace(held("clamped", "free"), mass=(PointMass(position=0.41, mass=0.06),))
"""A body falls anywhere within a part, so that errors go up and down with the size."""


def several_error(most: float) -> float:
    """Of sizes from which on modes 1 to so many are all kept, and which asks for most, against all sizes."""
    from verify.judge.sizing import enough_from

    asked, wrong = range(1, int(most) + 1), 0.0
    for beam in (LADEN, STRIP):
        bench = Workbench(beam)
        for model in ("segment", "fem"):
            found = enough_from(bench, model, asked, 0.01)
            off = {n: [_error_at(bench, model, n, mode) for mode in asked] for n in range(2, 13)}
            count = max((n for n, errors in off.items() if max(errors) > 0.01), default=1) + 1
            worst = max(asked, key=lambda mode: off[count - 1][mode - 1]) if count > 2 else found.mode
            wrong += abs(found.count - count) + (found.mode != worst)
    return wrong


def _error_at(bench: Workbench, model: str, count: int, mode: int) -> float:
    """Of a frequency; 1 where so few parts have it not."""
    try:
        return abs(bench.frequency_error(model, count, mode))
    except InputError:
        return 1.0


def carried_error(count: float) -> float:
    """Of wavenumbers on coarse parts with loss: what is left of a node's equations, over how they change with it."""
    from verify.exact.error_laws import cut_off_hz, discrete_wavenumber

    worst, beam = 0.0, replace(STRIP, loss_factor=0.04)
    part = beam.length / count
    for share in (0.02, 0.3, 0.7, 0.97):
        for model in ("segment", "fem"):
            hertz = share * cut_off_hz(model, beam, int(count))
            root = (2.0 * pi * hertz / beam.wave_constant * part**2) ** 2 / (1.0 + 0.04j)
            turn = discrete_wavenumber(model, beam, int(count), hertz) * part
            left, above, below = (_node(model, turn * (1.0 + d), root) for d in (0.0, 1e-5, -1e-5))
            off = abs(left / ((above - below) / 2e-5))
            worst = largest(worst, off, turn.imag > 0.0, *_laden_turns(model, count, turn, hertz))
    return worst


def _laden_turns(model: str, count: float, turn: complex, hertz: float) -> Iterator[float]:
    """By how much waves of fields with a body, or a spring, alone on the beam turn otherwise than without."""
    from verify.models.catalogue import MODELS
    from verify.waves.driven import own_wavenumber

    laden = ({"mass": (PointMass(position=0.41, mass=0.06),)}, {"spring": (PointSpring(position=0.2, stiffness=90.0),)})
    for added in laden:
        beam = replace(STRIP, loss_factor=0.04, **added)
        field = MODELS[model].solve_harmonic(beam, [PointForce(position=0.3)], hertz, int(count))
        yield abs(own_wavenumber(field) * beam.length / count - turn)


def _node(model: str, turn: complex, root: complex) -> complex:
    """Nought where a wave of such a turn from part to part runs."""
    c, s = np.cos(turn), np.sin(turn)
    if model == "segment":
        return complex(4.0 * (1.0 - c) ** 2 - root * (1.0 - (1.0 - c) / 3.0))
    stiffness = np.array([[24.0 - 24.0 * c, 12.0 * s], [12.0 * s, 8.0 + 4.0 * c]])
    mass = np.array([[312.0 + 108.0 * c, -26.0 * s], [-26.0 * s, 8.0 - 6.0 * c]]) / 420.0
    return complex(np.linalg.det(stiffness - root * mass))


def gallop_error(start: float) -> float:
    """By how far the first of all sizes that reach is missed from a guess, and how many sizes are tried beyond need."""
    from verify.judge.sizing import _around

    wrong = 0.0
    for first in (2, 3, 17, 40, 41, 333):
        tried: list[int] = []

        def reached(count: int, first: int = first, tried: list[int] = tried) -> bool:
            tried.append(count)
            return count >= first

        wrong += abs(_around(reached, int(start), 2, "segment", 0.01) - first)
        away = abs(int(start) - first)
        wrong += len(tried) > 2 * (log(away + 2.0) / log(2.0)) + 3
    return wrong


def crossing_error(order: float) -> float:
    """Of where one method becomes the cheaper: errors N^-p at costs a N^q and b N^r, in closed form."""
    from verify.judge.crossing import Crossing, Point, Stretch, Unearned, converging, crossing, within

    sizes, steeper = (10.0, 20.0, 40.0, 80.0), order + 0.5
    exact = sqrt(sizes[-1] ** -order * sizes[0] ** -steeper)  # in the middle of what both reach
    dear = 1e-4 * exact ** (1.6 / steeper - 1.0 / order)
    first = [Point(1.0 / n, n**-order, 1e-4 * n, 0.03) for n in sizes]
    second = [Point(1.0 / n, -(n**-steeper), dear * n**1.6, 0.05) for n in sizes]
    lines = [converging(points, (power, power), 0.0) for points, power in ((first, order), (second, steeper))]
    if not all(isinstance(line, Stretch) for line in lines):
        return 1.0
    met = crossing(*lines)  # type: ignore[arg-type]
    if not isinstance(met, Crossing) or len(met.crossings) != 1:
        return 1.0
    worst = abs(met.crossings[0] / exact - 1.0) + abs(met.spread - 0.08)
    for wanted in (0.7 * sizes[1] ** -order, 2.0 * sizes[0] ** -order):
        cost = 1e-4 * max(wanted ** (-1.0 / order), sizes[0])
        worst = largest(worst, abs((within(first, wanted) or 0.0) / cost - 1.0))
    unearned = (
        (first[:2], order, "sizes show no order"),
        ([Point(1.0 / n, 0.9, 1.0) for n in sizes], order, "are no answers"),
        ([Point(1.0 / n, 1e-15, 1.0) for n in sizes], order, "are rounding"),
        (first, order + 2.0, "fall not at order"),
    )
    for points, known, words in unearned:
        why = converging(points, (known, known), 1e-12)
        worst += not (isinstance(why, Unearned) and words in why.why)
    return float(worst + (within(first, 1e-30) is not None))


def guesses_error(mode: float) -> float:
    """Of expected errors, times mu^4 for what the reference loses, and of the size from which on they are kept."""
    from verify.exact.error_laws import expected_error, parts_from_here_on

    worst, number = 0.0, int(mode)
    for model in ("segment", "fem"):
        own = {n: pinned_error(model, number, n) for n in range(number + 1, MOST)}
        pairs = ((expected_error(model, STRIP, number, n) - error, n) for n, error in own.items())
        worst = largest(worst, *(abs(off) * (number * pi / n) ** 4 for off, n in pairs))
        for asked in ASKED:
            exact = max((n for n, error in own.items() if abs(error) > asked), default=number) + 1
            if exact < MOST // 2:
                worst = largest(worst, float(abs(parts_from_here_on(model, STRIP, number, asked) - exact)))
    return worst


def clamped_guess_error(error: float) -> float:
    """Of the size by the law mu^4 (-1/1440 + c / (12 N)) of clamped chains, over all sizes up to 2000."""
    from verify.exact.error_laws import parts_from_here_on

    wrong = 0.0
    for beam, clamps, beta in (
        (held("clamped", "free"), 1, 4.694091132974175),
        (held("clamped", "clamped"), 2, 7.853204624095838),
    ):
        n = np.arange(3, 2001)
        errors = abs((beta / n) ** 4 * (-1.0 / 1440.0 + clamps / (12.0 * n)))
        exact = int(n[errors > error].max(initial=2)) + 1
        wrong += abs(parts_from_here_on("segment", beam, 2, error) - exact)
        plain = int(n[(beta / n) ** 4 / 1440.0 > error].max(initial=2)) + 1
        wrong += abs(parts_from_here_on("fem", replace(beam, length=1.1), 2, error) - plain)
    return wrong


_row = partial(Floor, promise=0.5)
ROWS: tuple[Row, ...] = (
    _row(
        id="sizes-between-pins",
        title="The size from which on an error is kept, six errors, both models, against every size",
        why="judge/sizing.py: proven by the dispersion, to a part.",
        along="mode",
        at=(1, 2, 3, 7),
        error=enough_error,
    ),
    _row(
        id="sizes-cost-two-solves",
        title="Solves beyond two that such a size costs",
        why="judge/sizing.py: the law's guess is right, it and one part less are solved.",
        along="mode",
        at=(1, 3, 7),
        error=solves_error,
    ),
    _row(
        id="sizes-where-errors-change-sign",
        title="Sizes and lesser ones that happen to do, on a clamped and a stepped beam, against a scan of all",
        why="judge/sizing.py: sizes are gone through, to a part; the literature's wall needs most.",
        along="mode",
        at=(4,),
        error=scanned_error,
    ),
    _row(
        id="sizes-from-a-guess",
        title="The first size that reaches, from guesses near and far, and sizes tried beyond two for each doubling",
        why="judge/sizing.py: steps that double, then halving.",
        along="guess",
        at=(2, 39, 41, 300),
        error=gallop_error,
    ),
    Floor(
        id="errors-expected",
        title="Errors by the dispersion of links and elements, and sizes by them, against every size",
        why="exact/error_laws.py: to rounding.",
        along="mode",
        at=(1, 2, 5),
        promise=1e-12,
        error=guesses_error,
    ),
    _row(
        id="errors-expected-at-clamps",
        title="Sizes by the leading law at clamped ends, which is zero at N = 120 c, against every size",
        why="exact/error_laws.py: to a part.",
        along="error",
        at=(3e-11, 1e-10, 1e-7, 1e-4, 1e-2),
        error=clamped_guess_error,
    ),
    Floor(
        id="where-the-cheaper-changes",
        title="Where of two methods with powers for errors and costs the cheaper changes, and what is not compared",
        why="judge/crossing.py: straight lines in logarithms, to rounding.",
        along="order",
        at=(2.0, 3.0, 4.0),
        promise=1e-12,
        error=crossing_error,
    ),
    _row(
        id="sizes-of-several-modes",
        title="Sizes from which on several modes are kept, and which asks for most, with a body on parts and without",
        why="judge/sizing.py: sizes are gone through, to a part.",
        along="modes",
        at=(3,),
        error=several_error,
    ),
    Floor(
        id="waves-on-coarse-parts",
        title="Wavenumbers on coarse parts with loss, to just below where no wave runs, by a node's equations",
        why="exact/error_laws.py: roots of a quadratic, to rounding.",
        along="parts",
        at=(3, 20),
        promise=1e-12,
        error=carried_error,
    ),
)
