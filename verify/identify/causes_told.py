"""What is behind a list, in words: the unit, the factor or the clamp, or those of them that it does not tell apart."""

from math import inf, isfinite, log, pi

from verify.beam import Beam
from verify.identify.fitting import FLOOR, PLAIN, UNITS, Fit, Identified, beyond_unit
from verify.identify.pairing import Found
from verify.words import percent

_LITTLE = 1e-3
"""Of what a common factor changes: one that leaves more is not claimed, but told as the nearest."""

_SHOWN = 5e-5
"""Relative: what is fitted is told in four digits."""
_SIZES = {"rectangle": "the thickness", "round": "the diameter", "tube": "its diameters, outer and inner,"}
_BESIDE = {"mass": "bodies", "spring": "springs", "tension": "axial force", "foundation": "foundation"}
"""What one thing alone leaves as it is."""


def cause_of(found: Identified, beam: Beam) -> tuple[Found, ...]:
    """What is to be told of a list: its one cause, or all that leave about as much; of one as it stands nothing."""
    if not found.rivals:
        kind = kind_of(found)
        return (Found(kind=kind, words=_words(found, beam)),) if kind != "none" else ()
    causes, number = (found, *found.rivals), len(found.best.pairs.entries)
    each = "; ".join(f"({letter}) {_among(one, beam)}" for letter, one in zip("abcdef", causes, strict=False))
    says = {1: "one frequency does not say", 2: "two frequencies do not say"}.get(number, "this list does not say")
    words = f"{says} which it is, or whether it is one of them, and none is claimed: {each}"
    return (Found(kind="causes", words=words, wrong=all(kind_of(one) != "none" for one in causes)),)


def kind_of(found: Identified) -> str:
    """unit, scale, clamp, or none."""
    if found.best.clamp is not None:
        return "clamp"
    if found.reading.factor is None:
        return "scale"
    return "unit" if found.reading.factor in UNITS else "none"


def plain_cause(found: Identified, beam: Beam) -> dict[str, object]:
    """A cause in JSON."""
    best = found.best
    clamp = best.clamp
    return {
        "kind": kind_of(found),
        "words": _words(found, beam),
        "factor": best.factor,
        "clamp": None
        if clamp is None
        else {"ends": list(clamp.ends), "k_r_L_over_EI": clamp.stiffness, "k_r": clamp.rotational},
        "give_or_take": found.give_or_take if isfinite(found.give_or_take) else None,
        "residual": best.residual,
        "nearest": nearest(best),
    }


def nearest(one: Fit) -> str:
    """A candidate and its size."""
    return one.candidate.words + (f" with N = {one.count}" if one.count else "")


def left(one: Fit) -> str:
    """What a candidate leaves of the list."""
    return "nothing but rounding" if one.residual <= FLOOR else percent(one.residual, sign=False)


def _among(found: Identified, beam: Beam) -> str:
    """One of several causes: what it is, what is nearest by it, what that leaves."""
    return f"{_words(found, beam, loose=False)}, which leaves {left(found.best)} with {nearest(found.best)}"


def _words(found: Identified, beam: Beam, *, loose: bool = True) -> str:
    """What a cause is; `loose` with what is left of the list where that is too much to claim it."""
    kind, best = kind_of(found), found.best
    unit = unit_in_words(found.reading.factor or 1.0, found.read_as)
    said = [f"the frequencies are {unit}"] if unit else []
    if best.clamp is not None:
        words = best.clamp.words + _give_or_take(found)
        said += [words if found.explained else f"nearest comes a clamp that gives: {words}{_and_left(best) * loose}"]
    if kind == "scale":
        plainly = not (loosely(best) or (loose and found.short))
        return _scale_words(found, beam, plainly=plainly) + _and_left(best) * (loose and not plainly)
    return "; ".join(said) or ("nothing is off" if found.reading == PLAIN else "modes are missing or too many")


_HERTZ = {
    "in Hz": 1.0,
    "in kHz": 1e3,
    "in rad/s": 0.5 / pi,
    "in mHz": 1e-3,
    "per minute": 1.0 / 60.0,
    "in rad/ms": 0.5e3 / pi,
}
"""How many a frequency of one is that is given so."""


def unit_in_words(factor: float, read_as: str) -> str:
    """What unit frequencies are in that were read in another and are off by a factor; empty where none brings it.

    Of frequencies read in hertz with what else may have been done to them.
    """
    if factor not in UNITS or read_as == "Hz":
        return UNITS.get(factor, "")
    per = _HERTZ[f"in {read_as}"] / factor
    given = (name for name, hertz in _HERTZ.items() if abs(log(hertz / per)) < FLOOR)
    return f"{UNITS[factor].partition(':')[0]}: they are {next(given, 'in another unit')}, not in {read_as}"


def _and_left(best: Fit) -> str:
    return f", and {left(best)} is left"


def loosely(best: Fit) -> bool:
    """Whether what a factor leaves over is not quite nothing beside what it changes: it is told, and not claimed."""
    change = abs(log(beyond_unit(best.factor)[0]))
    return best.residual > max(FLOOR, _LITTLE * change)


def _give_or_take(found: Identified) -> str:
    """How far what was fitted may be off, where its digits show it."""
    off = found.give_or_take
    return f", give or take {100.0 * off:.2g} %" if _SHOWN < off < inf else ""


def _scale_words(found: Identified, beam: Beam, *, plainly: bool) -> str:
    """One factor on all frequencies, and what alone it may be of on this beam."""
    best = found.best
    factor, unit = beyond_unit(best.factor)
    had = "all frequencies have the common factor" if plainly else "nearest comes a common factor of all frequencies,"
    beside = f": {unit_in_words(unit, found.read_as)}; beyond that {factor:.6g}, so that" if unit != 1.0 else ""
    made = made_by(factor, beam, best.candidate.theory)
    return f"{had} {best.factor:.6g}{_give_or_take(found)}{beside or ':'} {made}"


def made_by(factor: float, beam: Beam, theory: str) -> str:
    """What is off where a factor on all frequencies is of one thing alone."""
    first, *others = [(name, _change(factor**power)) for name, power in _alone(beam, theory)] or [("", "")]
    if not first[0]:
        there = " and ".join(_BESIDE[name] for name in beam.added if name in _BESIDE)
        return f"neither E nor rho nor a size alone makes one on this beam, with its {there}"
    joined = "".join(f"{', ' * bool(i)}{'' if i else ' '}or {name} {by}" for i, (name, by) in enumerate(others))
    return f"{'in all sections alike ' * beam.stepped}{first[0]} is {first[1]}{joined}"


def _alone(beam: Beam, theory: str) -> list[tuple[str, float]]:
    """What alone changes all frequencies of a beam by one factor, and in which power of it.

    EI / (rho A L^4) where that is all there is. E leaves springs, ground and axial force as they are, rho bodies, sizes
    all of them, and what is thick another slenderness.
    """
    held, bodies = bool(beam.spring or beam.foundation or beam.tension), bool(beam.mass)
    sized = not held and not bodies and theory == "euler-bernoulli"
    found = [("E", 2.0)] * (not held) + [("rho", -2.0)] * (not bodies)
    return found + ([*_across(beam), ("the length", -0.5)] if sized else [])


def _across(beam: Beam) -> list[tuple[str, float]]:
    """The size of all sections by which EI / (rho A) goes, by its shape's name; nothing where sizes are not known."""
    if any(piece.second_moment is None or piece.area is None for piece in beam.pieces):
        return []
    shapes = {section.shape or beam.shape or "rectangle" for section in beam.section} or {beam.shape or "rectangle"}
    return [(_SIZES[shapes.pop()], 1.0)] if len(shapes) == 1 else []


def _change(ratio: float) -> str:
    return f"{100.0 * (ratio - 1.0):+.3g} %" if 0.5 < ratio < 2.0 else f"{ratio:.4g} times the scene's"
