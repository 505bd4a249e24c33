"""Lists of beams whose clamps give, told which end, by how much, of which member; one cause of a list or another.

Each list is a member's own, written down with a spring in place of its clamp; or a number with its limit beside it.
"""

from collections.abc import Callable, Iterator
from math import exp, log, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.limits.as_written import misplaced
from verify.stress.references.beams import held
from verify.stress.references.lists import FREE, clamp_giving, data_of, family_of, fit_of, told_of

# --- Clamps that give -------------------------------------------------------------------------------------------------

MODES, PARTS = 5, 11
BOTH, PROPPED = held("clamped", "clamped"), held("pinned", "clamped")
SOFT: tuple[tuple[Beam, tuple[str, ...], float, float, int | None, str], ...] = (
    (FREE, ("left",), 37.3, 1e-3, PARTS, "analytic"),
    (BOTH, ("left", "right"), 12.7, 1.0, PARTS, "half"),
    (PROPPED, ("right",), 88.0, 1.0, None, "consistent"),
)
"""A beam, which ends give, k_r L / EI, what a unit makes of hertz, parts that are said, a member."""


def _others() -> list[Any]:
    """Those that it is not looked for beside."""
    from verify.identify.family import Candidate

    plain = Candidate(model="segment", joints="series", mass="links")
    return [replace(plain, wall="welded"), replace(plain, mass="points"), replace(plain, attachment="lever")]


def _softened(beam: Beam, ends: tuple[str, ...], stiffness: float) -> Beam:
    at = {"left": 0.0, "right": beam.length}
    rotational = stiffness * beam.bending_stiffness / beam.length
    supports = tuple("pinned" if name in ends else one for name, one in zip(at, beam.supports, strict=True))
    springs = tuple(PointSpring(position=at[name], rotational=rotational) for name in ends)
    return replace(beam, supports=supports, spring=springs)


def soft_error(number: float) -> float:
    """How far the stiffness of a clamp that gives is missed, relative, 1 where another end, member or unit is told."""
    from verify.identify.family import frequencies_hz
    from verify.identify.yielding import frequencies_of, yielding

    beam, ends, stiffness, unit, count, name = SOFT[int(number)]
    every = count if len(ends) == 1 else None
    family, size = family_of(every), None if name == "analytic" else PARTS
    hertz = frequencies_hz(family[name], _softened(beam, ends, stiffness), size, MODES)
    found = yielding(data_of(beam, np.array(hertz) * unit, (*family.values(), *_others())), count)
    alone = [one for one in found if one.best.clamp is not None and one.best.clamp.ends == ends]
    mine = [one for told in alone for one in told.fits if one.candidate == family[name]]
    if len(alone) != 1 or len(mine) != 1 or mine[0].clamp is None or mine[0].count != size:
        return 1.0
    wrong = _read_otherwise(alone[0], mine[0], unit)
    theories = [one.theory for one in {one.candidate for one in alone[0].fits} & {*family.values()}]
    wrong |= sorted(theories) != ["euler-bernoulli"] * (6 if every else 3) + ["rayleigh"] * (3 if every else 0)
    wrong |= len(theories) != len(alone[0].fits)
    wrong |= not abs(frequencies_of(data_of(beam, hertz, ()), mine[0]) / hertz - 1.0).max() <= 1e-9
    clamp, rotational = mine[0].clamp, stiffness * beam.bending_stiffness / beam.length
    return largest(abs(clamp.stiffness / stiffness - 1.0), abs(clamp.rotational / rotational - 1.0), float(wrong))


def _read_otherwise(told: Any, mine: Any, unit: float) -> bool:
    """Whether a list is read in another unit, at another cost, or leaves more than rounding."""
    cost = 9.0 + 5.0 * (unit != 1.0)
    wrong = (told.reading.factor, told.reading.cost, told.reading.aligned, mine.factor) != (unit, cost, False, unit)
    wrong |= not (told.best.residual <= 1e-9 and mine.residual <= 1e-9)
    return bool(wrong or not abs(mine.score - MODES * log(1e-9) - cost) <= 1.0)


def weight_error(place: float) -> float:
    """Of what noise does to a fitted clamp, and of how frequencies go with it: by two exact lists beside each other."""
    from verify.identify.alignment import in_order_of
    from verify.identify.clamps import loss_of
    from verify.identify.family import exact_hz
    from verify.identify.yielding import _fit, _slope

    compliance = float(np.geomspace(1e-4, 1.0 / 0.3, 400)[int(place)] * (1.0 - 1e-9))
    pairs, loss = in_order_of(MODES), loss_of(PROPPED, ("right",), MODES)
    at = [exact_hz(_softened(PROPPED, ("right",), 1.0 / c), MODES) for c in (compliance / 1.001, compliance * 1.001)]
    exact = np.log(at[1] / at[0]) / log(1.001**2)
    worst = float(abs(_slope(loss, compliance, pairs) - exact).max() / abs(exact).max())
    data = data_of(PROPPED, np.array(at[0]), ())
    logs = np.array([0.01, -0.02, 0.015, 0.004, -0.03])
    one = _fit(data, family_of(None)["half"], 14, ("right",), compliance, logs)
    worst = largest(worst, abs(one.weight / float(np.linalg.norm(exact)) - 1.0))
    wrong = not abs(one.differences - np.expm1(logs)).max() <= 1e-15 or one.count != 14 or one.factor != 1.0
    wrong |= not abs(one.residual / float(np.sqrt(np.mean(logs**2))) - 1.0) <= 1e-12
    wrong |= not abs(one.score - MODES * log(one.residual) - 9.0) <= 1e-6 or one.clamp is None
    return largest(worst, float(wrong))


# --- One cause or another ---------------------------------------------------------------------------------------------


def _rounded(rounding: float) -> Any:
    return SimpleNamespace(rounding=np.array([0.0, rounding, 1.0]), listed=np.zeros(5), paired=None)


def _limits() -> Iterator[tuple[float, bool, Callable[[float], bool]]]:
    """Of what is claimed of a list: a residual, a rounding, a factor beside their limits."""
    from verify.identify import causes, causes_told, yielding
    from verify.identify.fitting import SCALED, likelier, same

    chain, exact = family_of(None)["half"], family_of(None)["analytic"]
    yield 0.02, True, lambda left: yielding.borne_out(fit_of(residual=left, clamp=clamp_giving(3.0)))
    yield 0.2 / 40.0, True, lambda left: yielding.borne_out(fit_of(residual=left, clamp=clamp_giving(40.0)))
    yield 0.04, True, lambda left: yielding.borne_out(fit_of(residual=left, clamp=clamp_giving(3.0)), 2.0)
    yield 1e-9, True, lambda left: yielding.settled(fit_of(residual=left), _rounded(1e-12))
    yield 3e-7, True, lambda left: yielding.settled(fit_of(residual=left), _rounded(3e-7))
    yield 1e-8, True, lambda digits: causes._sharply(told_of(fit_of()), _rounded(digits))
    yield 1e-8, True, lambda digits: causes._plainly(told_of(fit_of()), _rounded(digits), None)
    yield 1e-9, True, lambda left: causes._plainly(told_of(fit_of(residual=left)), _rounded(1e-3), 9)
    yield 1e-6, True, lambda digits: causes._unfitted(told_of(fit_of()), _rounded(digits), 9)
    yield 1e-3, True, lambda left: causes._exactly(told_of(fit_of(candidate=exact, residual=left)))
    yield 1e-3, True, lambda left: causes._exactly(told_of(fit_of(), (fit_of(candidate=exact, residual=left),)))
    yield 5e-3, False, lambda by: causes._by_factor(fit_of(factor=exp(by)))
    yield 5e-3, False, lambda by: causes._by_factor(fit_of(factor=exp(-by) * 2.0 * pi))
    yield 0.02 * 0.03, True, lambda left: causes._by_factor(fit_of(factor=exp(-0.03), residual=left))
    noisy = told_of(fit_of(), reading=SCALED, systematic=True)
    yield 0.02, True, lambda left: causes._credible(replace(noisy, fits=(fit_of(factor=0.1, residual=left),)))
    yield 1e-3, True, lambda left: causes._credible(told_of(fit_of(residual=left), reading=SCALED))
    yield 1e-3 * 0.03, False, lambda left: causes_told.loosely(fit_of(factor=exp(0.03), residual=left))
    yield 1e-9, False, lambda left: causes_told.loosely(fit_of(residual=left))
    yield 3e-3, True, lambda left: likelier(fit_of(residual=1e-3), fit_of(residual=left), 5) < 3.0**5
    yield 4e-4, True, lambda left: likelier(fit_of(residual=0.0), fit_of(residual=left), 2) < 17.0
    off = np.array([0.0, 1.0, -0.3, 0.0, 0.0])
    yield 1e-8, True, lambda by: same(fit_of(differences=by * off), fit_of(candidate=chain))


def _counted() -> Iterator[bool]:
    """Whether enough entries are left to bear out what was fitted: True where something is wrong."""
    from verify.identify import causes
    from verify.identify.alignment import Pairs, in_order_of
    from verify.identify.fitting import PLAIN, SCALED

    exact = family_of(None)["analytic"]
    loose, sharp = _rounded(1e-3), _rounded(1e-10)
    rough = {"residual": 0.01}
    for n, count, clamp, reading, enough in (
        (2, 9, None, PLAIN, True),
        (2, None, None, PLAIN, False),
        (3, None, None, PLAIN, True),
        (3, None, None, SCALED, False),
        (4, None, None, SCALED, True),
        (2, 9, None, SCALED, False),
        (2, 9, clamp_giving(20.0), PLAIN, False),
        (3, 9, clamp_giving(20.0), PLAIN, True),
        (3, None, clamp_giving(20.0), PLAIN, False),
    ):
        one = told_of(fit_of(pairs=in_order_of(n), clamp=clamp, **rough), reading=reading)
        yield causes._tested(one, loose, count) is not enough
    yield not causes._tested(told_of(fit_of(pairs=in_order_of(2))), sharp, None)
    plain = told_of(fit_of(pairs=in_order_of(2), **rough), (fit_of(candidate=exact),))
    yield (
        not causes._tested(plain, loose, None)
        or causes._tested(told_of(fit_of(pairs=in_order_of(1))), loose, 9) is True
    )
    for modes, data, filled in (
        ((0, 1, 3, 4, 5), loose, True),
        ((0, 1, 3, 5, 8), loose, False),
        ((0, 1, 3, 5, 8), sharp, True),
    ):
        gaps = Pairs(entries=np.arange(5), modes=np.array(modes))
        yield causes._fills(told_of(fit_of(pairs=gaps)), data) is not filled
        yield causes._fills(told_of(fit_of(pairs=gaps, residual=2e-3)), data)


def _weighed() -> Iterator[bool]:
    """Whether causes that leave as little are named beside the best, no other ones: True where something is wrong."""
    from verify.identify import causes
    from verify.identify.fitting import PLAIN, SCALED

    data, exact = _rounded(1e-5), family_of(None)["analytic"]
    near, far = 1e-3 * 2.4, 1e-3 * 2.6  # 2.5^5 is about a hundred
    yield causes._weighed([], data, 9) is not None
    for left, beside in ((near, 1), (far, 0)):
        one, other = told_of(fit_of(residual=1e-3)), told_of(fit_of(residual=left, score=1.0))
        found = causes._weighed([other, one], data, 9)
        yield found is None or len(found.rivals) != beside or found.best is not one.best
    dear = told_of(fit_of(residual=1e-3, score=1.0), reading=SCALED)
    own = told_of(fit_of(residual=1e-3))
    free = told_of(fit_of(residual=1e-3, score=1.0), (fit_of(candidate=exact, residual=near),), reading=SCALED)
    spent = told_of(fit_of(residual=1e-3, score=1.0), (fit_of(candidate=exact, residual=far),), reading=SCALED)
    for one, count, beside in (
        (dear, None, False),
        (dear, 9, False),
        (free, None, True),
        (free, 9, False),
        (spent, None, False),
    ):
        yield causes._as_good(own, one, 1e-5, count) is not beside
    yield causes._as_good(dear, told_of(fit_of(residual=1e-3), reading=PLAIN), 1e-5, 9) is not True


def causes_error(number: float) -> float:
    """How many limits are elsewhere of what is claimed to be behind a list, by what is left and what was fitted."""
    return misplaced(tuple(_limits())) + float(sum((*_counted(), *_weighed())))


# --- Lists told whole -------------------------------------------------------------------------------------------------


def _identified(listed: Array, count: int | None, rounding: float = 0.0) -> Any:
    """What is behind a list of the free beam, of three members."""
    from verify.identify.causes import identify

    family = family_of(None)
    some = (family["half"], family["consistent"], family["analytic"])
    return identify(data_of(FREE, np.array(listed), some, rounding, more=1), count)


def _own_and_true() -> tuple[Any, Any, Array, Array]:
    """The chain and the exact beam, and frequencies of both."""
    from verify.identify.family import frequencies_hz

    chain, exact = family_of(None)["half"], family_of(None)["analytic"]
    return chain, exact, frequencies_hz(chain, FREE, PARTS, 9), frequencies_hz(exact, FREE, None, 9)


def _few() -> Iterator[bool]:
    """One or two frequencies, plain or scaled: True where something else is told of them."""
    chain, exact, own, true = _own_and_true()
    found = _identified(true[:2], PARTS)
    yield found.short or found.best.factor != 1.0 or found.best.candidate != exact
    found = _identified(own[:2], PARTS)
    yield found.short or found.best.candidate != chain or bool(found.rivals)
    found = _identified(own[:2], PARTS, 1e-5)
    yield not found.short or found.best.candidate != chain
    found = _identified(1.7 * true[:1], None)
    yield (
        not found.short
        or found.reading.factor is not None
        or bool(found.rivals)
        or abs(found.best.factor - 1.7) > 1e-12
    )
    found = _identified(1.004 * true[:1], None)
    yield not found.short or found.reading.factor is not None or [one.reading.factor for one in found.rivals] != [1.0]


def _many() -> Iterator[bool]:
    """Lists scaled, plain, with a gap or of nothing that is known: True where something else is told of them."""
    chain, _, own, true = _own_and_true()
    found = _identified(1.013 * own, PARTS)
    yield (
        found.short
        or found.best.candidate != chain
        or abs(found.best.factor / 1.013 - 1.0) > 1e-12
        or bool(found.rivals)
    )
    found = _identified(own[:6], None)
    yield found.short or (found.best.candidate, found.best.count, found.best.residual) != (chain, PARTS, 0.0)
    found = _identified(np.delete(own, 3), PARTS)
    yield found.best.pairs.modes.tolist() != [0, 1, 2, 4, 5, 6, 7, 8] or found.best.candidate != chain
    far = _identified(true * np.array([1.0, 1.3, 0.8, 1.2, 0.9, 1.25, 0.85, 1.1, 1.0]), PARTS)
    yield far.best.factor != 1.0 or far.best.clamp is not None or far.explained


def lists_error(number: float) -> float:
    """How often another cause is told of a list of three members than what was done to it."""
    return float(sum((*_few(), *_many())))


ROWS: tuple[Row, ...] = (
    Floor(
        id="clamps-that-give",
        title="Lists of members on springs in place of clamps, in any unit: which end gives and how much",
        why="identify/yielding.py: the spring that fits best, to what its frequencies settle at.",
        along="list",
        at=tuple(range(len(SOFT))),
        promise=1e-8,
        error=soft_error,
    ),
    Floor(
        id="weight-of-a-clamp",
        title="How frequencies go with a clamp's compliance, and what noise does to one that is fitted",
        why="identify/yielding.py: the slope of what exact frequencies lose, of a spline.",
        along="compliance of four hundred",
        at=(140.0, 290.0),
        promise=5e-4,
        error=weight_error,
    ),
    Floor(
        id="causes-and-their-limits",
        title="What may be claimed to be behind a list: limits on both sides, entries that bear it out, rivals",
        why="identify/causes.py, causes_told.py, yielding.py: what each limit is said to be.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=causes_error,
    ),
    Floor(
        id="causes-of-lists",
        title="One or two frequencies, lists with gaps, scaled and plain, told what they are and what may be claimed",
        why="identify/causes.py: the likeliest, and beside it what leaves as little.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=lists_error,
    ),
)
