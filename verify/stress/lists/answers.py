"""What is answered about a list: sentences from what was found, gates and rows of entries."""

from collections.abc import Iterator
from math import pi
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held
from verify.stress.references.lists import FREE, clamp_giving, data_of, family_of, fit_of, told_of

# --- Sentences --------------------------------------------------------------------------------------------------------

OFF = np.array([1e-4, -2e-4, 1.5e-4, -1e-4, 2e-4])
IT = "our chain follows the 2EI/l rule at the wall, order 2"
BESIDE = "a chain that follows the 2EI/l rule at the wall with N = 9"


def _answered(found: Any, **given: Any) -> Any:
    """What is told of it, with gates that it passes unless others are given."""
    from verify.identify.gates import _gate
    from verify.identify.told import Compared

    plain: dict[str, Any] = {
        "scene": "it",
        "beam": FREE,
        "source": "list",
        "unit": "Hz",
        "theory": "euler-bernoulli",
        "found": found,
        "told": (),
        "rows": (),
        "size": None,
        "gates": (_gate("identified", 0.0, 1e-3, "", "", "1"),),
        "solved": 7,
        "seconds": 0.1,
        "left_out": {},
    }
    return Compared(**(plain | given))


def _members() -> tuple[Any, Any, Any, Any]:
    """A chain's fit, the exact beam's with other frequencies, elements' with the same and with others."""
    family = family_of(None)
    chain = fit_of(candidate=replace(family["half"], order=2), residual=2e-4, differences=OFF)
    exact = fit_of(candidate=family["analytic"], count=None, residual=3e-4, differences=2.0 * OFF)
    other = fit_of(candidate=family["consistent"], count=8, residual=2e-4, differences=OFF.copy())
    return chain, exact, other, replace(other, differences=3.0 * OFF, residual=6e-4)


def _identities() -> Iterator[bool]:
    """Of what a model is, surely or probably: True where it is told otherwise."""
    from verify.identify.fitting import SCALED
    from verify.identify.gates import _gate

    chain, exact, same, other = _members()
    far = (_gate("identified", 2e-3, 1e-3, "off", "", "1"),)
    loose = replace(chain, factor=1.02)
    slight = replace(loose, residual=1.9e-5)
    for told, given, said in (
        (told_of(chain), {}, f"Y{IT}"),
        (told_of(chain, (same,)), {}, f"Y{IT}"),
        (told_of(chain, (other,)), {}, f"Probably y{IT}"),
        (told_of(chain), {"gates": far}, f"Probably y{IT}"),
        (told_of(loose, reading=SCALED), {}, f"Probably y{IT}"),
        (told_of(slight, reading=SCALED), {}, f"Y{IT}"),
        (told_of(loose), {}, f"Y{IT}"),
        (told_of(chain, rivals=(told_of(exact),)), {}, ""),
        (told_of(exact), {}, "Your frequencies are those of the exact beam"),
    ):
        yield _answered(told, **given)._identity() != said
    unseen = _answered(told_of(chain, (exact,)))
    yield not unseen._identity().endswith(f"divided too finely; the nearest is {BESIDE}") or unseen._claimed()


def _unclaimed() -> Iterator[bool]:
    """Of lists that are too short, too rough or too smooth for a model to be named: True where it is told otherwise."""
    from verify.identify.alignment import in_order_of

    chain, _, _, _ = _members()
    few = _answered(told_of(replace(chain, pairs=in_order_of(2)), short=True))._identity()
    yield few != f"two frequencies do not say which model it is: the nearest, {BESIDE}, leaves 0.0200 %"
    rough = told_of(replace(chain, residual=0.03))
    for left_out, known in (({}, "the known family"), ({"a": "b"}, "what is known of the family on this beam")):
        words = f"none of {known} fits: the nearest, {BESIDE}, leaves 3.0000 %"
        yield _answered(rough, left_out=left_out)._identity() != words
    smooth = _answered(told_of(chain, systematic=True))._identity()
    yield not smooth.startswith("nothing of the known family is it quite")
    yield not smooth.endswith("leaves 0.0200 %, which goes smoothly with the mode")


def _parts() -> Iterator[bool]:
    """Of parts for an accuracy: True where it is told otherwise."""
    from verify.identify.sizing import Enough

    chain, _, other, _ = _members()
    size = Enough(mode=5, error=0.002, count=31, known_by="", better="weights", better_count=12)
    plain, none, at = replace(size, better=""), replace(size, count=None), "for 0.2 % at mode 5"
    for found, one, theory, words in (
        (chain, size, "euler-bernoulli", f"; 31 links {at} (12 with weights)"),
        (chain, plain, "rayleigh", f"; 31 links {at} by the theory euler-bernoulli"),
        (chain, none, "euler-bernoulli", f"; no number of links found {at} (12 with weights)"),
        (other, plain, "euler-bernoulli", f"; 31 elements {at}"),
        (chain, None, "euler-bernoulli", ""),
    ):
        yield _answered(told_of(found), size=one, theory=theory)._parts() != words


def _sureties() -> Iterator[bool]:
    """Of how surely, and of what it is not: True where it is told otherwise."""
    from verify.identify.fitting import PLAIN, Identified

    chain, _, same, other = _members()
    element = "cubic Hermite elements with consistent mass with N = 8"
    next_one = f"next, with 0.0600 %, 3 times as much, comes {element}"
    told = Identified(fits=(chain, other), reading=PLAIN, alike=(), systematic=False)
    yield _answered(told)._surety() != f"With 9 parts it leaves 0.0200 %; {next_one}"
    alike = f"no list can tell it from {element}, of the same frequencies"
    yield _answered(told_of(chain, (same,)))._surety() != f"With 9 parts it leaves 0.0200 %; {alike}"
    doubtful = f"this list does not tell it from {element}"
    yield _answered(told_of(chain, (other,)))._surety() != f"With 9 parts it leaves 0.0200 %; {doubtful}"
    plain = replace(told, fits=(replace(chain, residual=0.0, count=None), other))
    yield _answered(plain)._surety() != f"So read, it leaves nothing but rounding; next, with 0.0600 %, comes {element}"
    yield (
        _answered(told_of(chain, rivals=(told,)))._surety() != ""
        or _answered(told_of(chain, short=True))._surety() != ""
    )


def _charts() -> Iterator[bool]:
    """Of what is drawn, and what a list is called there that is scaled or read otherwise: True where it is another."""
    from verify.identify.alignment import Pairs
    from verify.identify.family import frequencies_hz
    from verify.identify.fitting import PLAIN, Identified
    from verify.identify.pairing import Elastic
    from verify.identify.rows import rows_of

    chain, _, _, other = _members()
    own, true = frequencies_hz(chain.candidate, FREE, 9, 6), frequencies_hz(family_of(None)["analytic"], FREE, None, 6)
    elastic, off = Elastic(kept=np.arange(5), numbers=None, told=()), "(as given they lie off the chart)"
    gap = Pairs(entries=np.arange(5), modes=np.array([0, 1, 2, 4, 5]))
    for factor, pairs, drawn, words in (
        (1.0, chain.pairs, ["yours"], "yours"),
        (1.37, chain.pairs, ["yours", "yours, scaled"], "yours, and yours over 1.37, as diagnosed"),
        (2.5, chain.pairs, ["yours, scaled"], f"yours over 2.5, as diagnosed {off}"),
        (0.4, chain.pairs, ["yours, scaled"], f"yours over 0.4, as diagnosed {off}"),
        (1.0, gap, ["yours, read"], f"yours as read {off}"),
    ):
        best = replace(chain, factor=factor, pairs=pairs)
        listed = factor * own[pairs.modes]
        rows = rows_of(data_of(FREE, listed, (), more=1), told_of(best), true, {}, elastic)
        for fits, beside in (((best,), []), ((best, other), [other.candidate.words])):
            found = Identified(fits=fits, reading=PLAIN, alike=(), systematic=False)
            told = _answered(found, rows=rows)
            (chart,) = told.charts()
            yield [line.name for line in chart.lines] != ["exact", *drawn, chain.candidate.words, *beside]
            yield not chart.caption.startswith(f"Points: {words}, against the exact beam (euler-bernoulli).")


def _causes() -> Iterator[bool]:
    """Of one cause or several, claimed or not: True where it is told otherwise."""
    from verify.identify.causes_told import cause_of
    from verify.identify.fitting import PLAIN, SCALED, Reading

    chain, _, _, _ = _members()
    scaled = replace(chain, factor=1.02, residual=1e-6, differences=np.zeros(5), weight=2.0)
    loose, short = replace(scaled, residual=3e-4), told_of(scaled, reading=SCALED, short=True)
    made = "E is +4.04 % or rho -3.88 %, or the thickness +2 %, or the length -0.985 %"
    claimed, nearest = f"all frequencies have the common factor 1.02: {made}", "nearest comes a common factor of all"
    radians = Reading(factor=2.0 * pi, aligned=False, cost=5.0)
    unit = "the frequencies are too large by 2 pi: they are in rad/s, not Hz"
    soft = told_of(replace(chain, clamp=clamp_giving(16.0)), reading=PLAIN)
    turns = (
        f"the clamped left end turns against a spring of k_r = 16 EI/L ({clamp_giving(16.0).rotational:.6g} N m/rad)"
    )
    for found, kind, words in (
        (told_of(scaled, reading=SCALED), "scale", claimed),
        (told_of(loose, reading=SCALED), "scale", f"{nearest} frequencies, 1.02: {made}, and 0.0300 % is left"),
        (short, "scale", f"{nearest} frequencies, 1.02: {made}, and 0.0001 % is left"),
        (told_of(replace(scaled, factor=2.0 * pi), reading=radians), "unit", unit),
        (soft, "clamp", turns),
        (replace(soft, systematic=True), "clamp", f"nearest comes a clamp that gives: {turns}, and 0.0200 % is left"),
    ):
        told = cause_of(found, FREE)
        yield [(one.kind, one.words) for one in told] != [(kind, words)] or not told[0].wrong
    yield cause_of(told_of(chain), FREE) != ()
    both = cause_of(replace(told_of(scaled, reading=SCALED), rivals=(soft, told_of(chain))), FREE)
    says = "this list does not say which it is, or whether it is one of them, and none is claimed: "
    first = f"(a) {claimed}, which leaves 0.0001 % with {BESIDE}"
    second = f"(b) {turns}, which leaves 0.0200 % with {BESIDE}"
    third = f"(c) nothing is off, which leaves 0.0200 % with {BESIDE}"
    yield [(one.words, one.wrong) for one in both] != [(f"{says}{first}; {second}; {third}", False)]


def _twins() -> Iterator[bool]:
    """Of what stands for a wall at the free end, and of a clamp: True where it is told otherwise."""
    from verify.identify.twins import twin_of

    chain, _, _, _ = _members()
    for wall, mass, theory, said in (
        ("full", "joints", "euler-bernoulli", "a whole mass in place of half a one at its free end"),
        ("rigid", "joints", "euler-bernoulli", "2EI/l at the wall and no mass at its free end"),
        ("half", "joints", "euler-bernoulli", ""),
        ("full", "points", "euler-bernoulli", ""),
        ("full", "joints", "timoshenko", ""),
    ):
        one = replace(chain, candidate=replace(chain.candidate, wall=wall, mass=mass, theory=theory))
        words = " ".join(two.words for two in twin_of(FREE, told_of(one)))
        yield bool(words) is not bool(said) or said not in words
        yield bool(twin_of(held("clamped", "clamped"), told_of(one))) or bool(twin_of(STRIP, told_of(one)))
        yield bool(twin_of(FREE, told_of(one, systematic=True)))
    soft = twin_of(FREE, told_of(replace(chain, clamp=clamp_giving(16.0))))
    heavy = f"0.0625 rho A L ({0.0625 * FREE.mass_per_length * FREE.length:.4g} kg)"
    yield [one.wrong for one in soft] != [False] or heavy not in soft[0].words


def sentences_error(number: float) -> float:
    """How often what a list is, how surely, or what no list can tell is said in other words."""
    return float(sum((*_identities(), *_unclaimed(), *_parts(), *_sureties(), *_charts(), *_causes(), *_twins())))


# --- Entries ----------------------------------------------------------------------------------------------------------


def rows_error(factor: float) -> float:
    """How far rows of a list with a factor and a mode missing are off; gates of them count one each."""
    from verify.identify.alignment import Pairs
    from verify.identify.family import frequencies_hz
    from verify.identify.pairing import Elastic
    from verify.identify.rows import gaps_of, rows_of

    chain, exact = family_of(None)["half"], family_of(None)["analytic"]
    own, true = frequencies_hz(chain, FREE, 9, 6), frequencies_hz(exact, FREE, None, 6)
    noise = np.array([1.0, 1.0 + 3e-4, 1.0, 1.0 - 5e-4, 1.0 - 2e-4])
    listed = factor * np.delete(own, 3) * noise
    pairs = Pairs(entries=np.array([0, 1, 2, 4]), modes=np.array([0, 1, 2, 5]))
    best = fit_of(candidate=chain, pairs=pairs, factor=factor, differences=np.zeros(4))
    data = data_of(FREE, listed, (), 1e-4, more=1)
    elastic = Elastic(kept=np.arange(1, 6), numbers=None, told=())
    rows, worst, wrong = rows_of(data, told_of(best), true, {2: 0.9}, elastic), 0.0, 0
    at = {0: 0, 1: 1, 2: 2, 4: 5}
    for i, row in enumerate(rows):
        wrong += (row.mode, row.entry, row.likeness) != (i + 1, i + 2, 0.9 if i == 2 else None)
        worst = largest(worst, abs(row.error - (listed[i] / true[i] - 1.0)), abs(row.given_hz / listed[i] - 1.0))
        wrong += (row.scaled_hz is None) is not (factor == 1.0) or (row.read_as is None) is not (i not in at)
        if i in at:
            beyond = max(abs(noise[i] - 1.0) - 1e-4, 0.0)
            read = listed[i] / factor / true[at[i]] - 1.0, noise[i] - 1.0, beyond
            given = row.read_error, row.difference, row.beyond
            worst = largest(worst, *(1.0 if a is None else abs(a - b) for a, b in zip(given, read, strict=True)))
            wrong += row.read_as != at[i] + 1
    said = [one.words for one in gaps_of(data, best, elastic)]
    wrong += said != ["modes 4, 5 are missing from the list", "entry 5 is none of the beam's bending modes"]
    apart = fit_of(candidate=chain, pairs=Pairs(entries=pairs.entries, modes=pairs.entries), factor=factor)
    told = [one.words for one in gaps_of(data_of(FREE, factor * own[:5] * noise, ()), apart, elastic)]
    wrong += [one.split(", and")[0] for one in told] != ["entry 5 is -0.0500 % off mode 4"]
    wrong += sum(_gated(best, rows, factor))
    return float(largest(worst, wrong))


def _gated(best: Any, rows: Any, factor: float) -> Iterator[bool]:
    """Of gates of rows: True where one passes that should not, or tells another mode."""
    from verify.identify.gates import judged
    from verify.identify.pairing import Found

    size = max(abs(row.error) for row in rows)
    mended = (Found(kind="unit", words="off"), Found(kind="leaving", words="so", wrong=False))
    for told, within, passed in (
        ((), None, [True, True]),
        (mended, None, [False, True]),
        ((), 0.999 * size, [True, True, False]),
        ((), 1.001 * size, [True, True, True]),
    ):
        yield [gate.passed for gate in judged(told_of(best), told, rows, within)] != passed
    for short, systematic in ((True, False), (False, True)):
        yield judged(told_of(best, short=short, systematic=systematic), (), rows, None)[1].passed is not False
    errors = (0.01, -0.04, 0.002, 0.03, 0.02, 0.02, 0.02, 0.02)
    for n, modes in ((3, "s 1, 2"), (7, "s 1, 2, 4, 5, 6, 7"), (8, "s 1, 2, 4, 5, 6, 7 and more"), (1, " 1")):
        many = tuple(replace(rows[0], mode=i + 1, error=errors[i]) for i in range(n))
        gate, worst = judged(told_of(best), (), many, 0.005)[2], "-4" if n > 1 else "+1"
        yield not gate.reason.startswith(f"beyond it: mode{modes}; the largest error is {worst}") or bool(gate.passed)
        yield (gate.measured, gate.share, gate.applicable) != (0.04 if n > 1 else 0.01, gate.measured / 0.005, True)
    off = tuple(replace(row, beyond=None if row.beyond is None else 10.0 * row.beyond) for row in rows)
    over = f" over {factor:.6g}" if factor != 1.0 else ""
    said = judged(told_of(best), (), off, None)[1].reason
    yield said != f"mode 2{over} is +0.0300 % off the nearest candidate"


ROWS: tuple[Row, ...] = (
    Floor(
        id="answers-in-words",
        title="What a model is, surely or probably, what no list can tell, parts for an accuracy, in words and drawn",
        why="identify/told.py, twins.py: sentence by sentence, from what was found.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=sentences_error,
    ),
    Floor(
        id="rows-of-a-list",
        title="Entries of a list with a gap and noise, one by one, with a factor and without, and their gates",
        why="identify/rows.py, gates.py: against the exact beam, and as they are read.",
        along="factor",
        at=(1.0, 1.37),
        promise=1e-12,
        error=rows_error,
    ),
)
