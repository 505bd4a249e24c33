"""Readings of a slider in words and cells."""

from typing import TYPE_CHECKING

from verify.studies.readings.request import NAMES
from verify.units import time_in_words

if TYPE_CHECKING:
    from verify.studies.readings.figures import Bound, Group, Reading, ReadingsFound

UNITS = {"soft_start_periods": " periods", "positions": " m", "forces": " N", "slope": " s/m"}


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


def cm_per_s(speed: float | None) -> str:
    """A speed, short."""
    if speed is None:
        return "–"
    return f"{100 * speed:+.3g}" if abs(speed) < 1e-5 else f"{100 * speed:+.4f}"[:8]


def start_words(periods: float) -> str:
    """A start in a cell."""
    return f"soft, {periods:g}" if periods else "at once"


def searched_words(study: "ReadingsFound") -> str:
    """What was searched: all lists, how many readings and runs, on what."""
    lists = "; ".join(
        f"{NAMES[name]} {', '.join(v if isinstance(v, str) else f'{v:g}' for v in values)}{UNITS.get(name, '')}"
        for name, values in study.searched.items()
        if values
    )
    how, n = study.readings[0].condition, sum(not one.condition.nonlinear for one in study.readings)
    chain = len(study.readings) - n
    also = f"; those at once also on the nonlinear chain of {how.count} rigid links ({chain})" if chain else ""
    return (
        f"{n} readings, every combination of {lists} and no other; {how.model_words}, {time_in_words(how.duration)} "
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


def legend(study: "ReadingsFound") -> str:
    """'A to-the-left, B mean-speed': which claim a letter is."""
    return ", ".join(f"{letter(i)} {claim.id}" for i, claim in enumerate(study.claims))


def turn_words(study: "ReadingsFound") -> list[tuple[str, str]]:
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
    return [how.kind_words, kinematics, start, f"{how.position:g}"]


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
