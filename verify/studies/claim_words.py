"""Claims and readings in words and cells, for the terminal and for the page."""

from typing import TYPE_CHECKING

from verify.studies.readings import NAMES, Reading, ReadingsStudy

if TYPE_CHECKING:
    from verify.studies.claims import ClaimResult
    from verify.studies.readings import Bound, Group
    from verify.studies.work_precision import Comparison, NotCompared

UNITS = {"soft_start_periods": " periods", "positions": " m", "forces": " N", "slope": " s/m"}
LEAST_SHOWN = 1e-4
VERDICT = {True: "holds", False: "fails", None: "unknown"}


def letter(number: int) -> str:
    """The name of a claim in a table, from 0."""
    return chr(ord("A") + number) if number < 26 else str(number + 1)


def met_words(reading: "Reading | None") -> str:
    """'ABF': which claims a reading meets."""
    if reading is None:
        return "–"
    if reading.stopped != "end":
        return "broke off"
    return "".join(letter(i) for i, met in enumerate(reading.met) if met) or "none"


def value_words(value: float | None, unit: str) -> str:
    """A figure with its unit."""
    return "–" if value is None else f"{value:+.5g}" + unit_words(unit)


def unit_words(unit: str) -> str:
    """A unit behind a number; nothing where there is none."""
    return "" if unit in ("", "1") else f" {unit}"


def claimed_words(claim: "ClaimResult") -> str:
    """What is claimed, with its unit where it is a number."""
    return claim.claimed + ("" if claim.claimed in ("negative", "positive") else unit_words(claim.unit))


def off_words(claim: "ClaimResult") -> str:
    """How far what is found lies from the exact beam's; nothing where it does not."""
    far = claim.departure is not None and abs(claim.departure) >= LEAST_SHOWN
    return f"{100 * claim.departure:+.2g} % off" if claim.departure is not None and far else ""


def other_verdict(claim: "ClaimResult") -> str:
    """What the exact beam says of a claim, where it says otherwise."""
    if claim.exact_holds is None or claim.exact_holds == claim.holds:
        return ""
    return "there it holds" if claim.exact_holds else "there it does not hold"


def found_words(claim: "ClaimResult") -> str:
    """What was found, with the exact beam's beside it and the distance between them."""
    if claim.found is None:
        return f"cannot be evaluated: {claim.reason}"
    text = value_words(claim.found, claim.unit)
    if claim.exact is None:
        return text
    beside = (value_words(claim.exact, claim.unit), off_words(claim), other_verdict(claim))
    return f"{text} (exact beam {', '.join(part for part in beside if part)})"


def cm_per_s(speed: float | None) -> str:
    """A speed, short."""
    if speed is None:
        return "–"
    return f"{100 * speed:+.3g}" if abs(speed) < 1e-5 else f"{100 * speed:+.4f}"[:8]


def start_words(periods: float) -> str:
    """A start in a cell."""
    return f"soft, {periods:g}" if periods else "at once"


def searched_words(study: ReadingsStudy) -> str:
    """What was searched: all lists, how many readings and runs, on what."""
    lists = "; ".join(
        f"{NAMES[name]} {', '.join(v if isinstance(v, str) else f'{v:g}' for v in values)}{UNITS.get(name, '')}"
        for name, values in study.searched.items()
        if values
    )
    how, n = study.readings[0].condition, sum(one.condition.model != "chain" for one in study.readings)
    chain = len(study.readings) - n
    also = f"; those at once also on the nonlinear chain of {how.count} rigid links ({chain})" if chain else ""
    return (
        f"{n} readings, every combination of {lists} and no other; {how.model_words}, {1e3 * how.duration:g} ms "
        f"from the start{also}; {study.n_runs} runs in all. Nothing is fitted."
    )


def bound_words(bound: "Bound") -> str:
    """What friction alone allows, and how far it is from being reached."""
    reached = (
        f"of {bound.n_above} such readings on all models and places with mu from there on the fastest that way "
        f"has {cm_per_s(bound.fastest)} cm/s, {100 * bound.fastest / bound.claimed:.2g} % of it"
        if bound.fastest is not None
        else "no reading has such a mu"
    )
    return (
        f"In the tangential kinematics, from rest, friction alone moves the slider: a mean speed of "
        f"{100 * bound.claimed:g} cm/s takes mu of at least {bound.least_mu:.3g} there, which need not be enough: "
        f"{reached}. In the following kinematics the turning surface pushes the slider too, and mu sets no such "
        "bound."
    )


def legend(study: ReadingsStudy) -> str:
    """'A to-the-left, B mean-speed': which claim a letter is."""
    return ", ".join(f"{letter(i)} {claim.id}" for i, claim in enumerate(study.claims))


def turn_words(study: ReadingsStudy) -> list[tuple[str, str]]:
    """(letter and id of a claim, what its verdict turns with)."""
    lines = []
    for i, claim in enumerate(study.claims):
        turns = sorted((t for t in study.turns if t.claim == claim.id and t.turned), key=lambda t: -t.turned / t.pairs)
        parts = ", ".join(f"{t.by} {100 * t.turned / t.pairs:.0f} %" for t in turns)
        lines.append((f"{letter(i)} {claim.id}", parts or "nothing that was varied"))
    return lines


def group_cells(group: "Group") -> list[str]:
    """Model, kinematics (and a slider that is held), start, place of a row."""
    how = group.best.condition
    kinematics = how.kinematics if how.normal == "massless" else f"{how.kinematics}, {how.normal}"
    start = "steady" if how.start == "steady" else start_words(how.soft_start_periods)
    return ["chain" if how.model == "chain" else "linear", kinematics, start, f"{how.position:g}"]


def best_cells(group: "Group") -> list[str]:
    """Force, mu and K of the reading that meets most claims, its speed and verdicts, the exact beam's beside them."""
    best, exact = group.best, group.exact
    how = best.condition
    slope = "–" if how.law == "coulomb" else f"{how.slope:g}"
    return [
        how.force_words.removesuffix(" N"),
        f"{how.mu:g}",
        slope,
        cm_per_s(best.speed),
        met_words(best),
        cm_per_s(exact.speed) if exact else "–",
        met_words(exact),
    ]


def answer_in_words(answer: "Comparison | NotCompared") -> str:
    """Both models at one error, loop and set-up; or why nothing is compared, and what to change."""
    from verify.studies.work_precision import NotCompared

    if isinstance(answer, NotCompared):
        return f"run times at equal error are not compared: {answer.why}; {answer.remedy}"
    fem, segment = answer.fem, answer.segment
    return (
        f"at an error of {100 * answer.error:.3g} % of the displacement Hermite elements take {answer.ratio:.2f} times "
        f"as long as segments in the loop ({fem.run_ms_per_ms:.3g} and {segment.run_ms_per_ms:.3g} ms for a simulated "
        f"ms), after a set-up of {fem.set_up_ms:.3g} and {segment.set_up_ms:.3g} ms: {answer.whole_ratio:.2f} times "
        f"for the whole run of {1e3 * answer.duration:g} ms"
    )
