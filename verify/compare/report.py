"""The result of a comparison: modes, candidates, faults, required N and acceptance as tables; one figure."""

from math import pi
from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import is_uneven, not_default
from verify.analysis.verdict import Margin, per_cent, void
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.effects import CAUSES
from verify.compare.fit import FAULTS, Data, Fit, Identification
from verify.compare.reading import FrequencyList
from verify.compare.sorting import ACROSS, BENDING
from verify.errors import InputError
from verify.problem.beam import Beam, is_lossless
from verify.report.result import Column, Figure, Result, Table
from verify.settings import WALLS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 10
"""Largest number of candidates in the table; all are in the data."""
STATUS = {
    "identified": "Identified",
    "ambiguous": "Ambiguous, within the rounding of its digits several models agree; the likeliest",
    "exact": "No discretisation detected",
    "few": "Too few frequencies to identify a model; one of those that agree",
    "unknown": "None of the known family; nearest",
}
TWIN = 1e-7
"""Difference of explanations whose frequencies are equal: that of a parameter by least squares."""
POWERS = {"E": 2.0, "rho": -2.0, "thickness or diameter": 1.0, "length": -0.5}
"""Parameters that change all frequencies by a common factor, with the power of the factor."""
TIP_MASS = "A cantilever with clamp stiffness k_r = c EI/L has the frequencies of one with a tip mass rho A L / c."
UNEVEN = "With steps or attachments inside a part a larger N may exceed the tolerance."
_ROOTS = {f"{g:g}": g**0.5 for g in (9.80665, 9.81, 386.09, 386.4)}  # m/s^2 and in/s^2, as programs have them
FACTORS = {
    **{f"weight for mass, 1/sqrt(g), g = {g}": 1.0 / root for g, root in _ROOTS.items()},
    **{f"mass for weight, sqrt(g), g = {g}": root for g, root in _ROOTS.items()},
    "metres for inches": 0.0254,
    "inches for metres": 1.0 / 0.0254,
    "kg for t, 1/sqrt(1000)": 1e3**-0.5,
    "t for kg, sqrt(1000)": 1e3**0.5,
    "radians for degrees, pi/180": pi / 180.0,
    "degrees for radians, 180/pi": 180.0 / pi,
    "mm for m, or E in MPa": 1e-3,
    "m for mm, or MPa as Pa": 1e3,
    "E in GPa": 10.0**-4.5,
    "GPa as Pa": 10.0**4.5,
    "rad/s for Hz, 2 pi": 2.0 * pi,
    "Hz for rad/s, 1/(2 pi)": 0.5 / pi,
}
"""Common factors of lists with the confusion that causes them."""
ENTRY = (Column("entry"), Column("mode"), Column("listed", "Hz", ".7g"), Column("exact", "Hz", ".7g"))
RMS = (Column("rms", format=".3g", percent=True), Column("largest", format=".3g", percent=True))


class Entry(msgspec.Struct, frozen=True):
    """A frequency of the list: entry from 1, its motion, and mode from 1 by position, number or shape."""

    entry: int
    mode: int
    listed_hz: float
    exact_hz: float
    mac: float | None
    motion: str = BENDING

    @property
    def error(self) -> float:
        """Error relative to the exact frequency."""
        return self.listed_hz / self.exact_hz - 1.0


def result_of(
    scene: str,
    source: FrequencyList,
    data: Data,
    fits: Identification,
    rows: list[Entry],
    required: list[tuple[Any, ...]],
    warnings: list[str],
    options: Any,
) -> Result:
    """The result of a comparison with acceptance `data["passed"]`; `warnings` are faults of the list.

    `required`: candidates, modes, and N for 1 % and 0.1 %. `options`: `compare.Options`.
    """
    best, beam, kind, within = fits.best, data.beam, fits.best.fault.kind, options.within
    claimed = fits.status in ("identified", "ambiguous")
    misread = claimed and (kind in ("missing", "extra", "tension") or best.fault.label == "beam.tension")
    faults = [f"the list has a fault: {FAULTS[kind][0]} {value(best, beam)}"] * misread + warnings
    bent = [row for row in rows if row.motion in (BENDING, ACROSS)]
    worst = max(bent, key=lambda row: abs(row.error))
    off, passed = abs(worst.error), abs(worst.error) <= within and not faults
    coarse = best.rms == 0.0 and best.digits > 1e-8
    agreement = ", within the rounding of its digits" if coarse else f", rms difference {best.rms:.2g}"
    summary = f"{STATUS[fits.status]}: {_title(best, beam)}{agreement * (fits.status != 'ambiguous')}."
    others = fits.alternatives if fits.status in ("identified", "ambiguous", "exact") else ()
    summary += _others(data, fits, others)
    if source.unit != "Hz" and not source.declared:
        summary += f" The values are read as {source.unit}."
    chains = {(fit.candidate.wall, fit.candidate.joints, fit.count) for fit in (best, *others)}
    if claimed and len(chains) == 1 and (change := _change(best, beam)):  # no joint that another of them has not
        summary += f"\nTo change: {change}"
    about: dict[str, Any] = {"scene": scene, "source": source.source, "unit": source.unit, "passed": passed}
    about |= {"status": fits.status, "identified": fits.status == "identified", "best": _plain(best, beam)}
    groups = {"equivalent": fits.equivalent, "alternatives": fits.alternatives, "candidates": fits.ranking}
    about |= {name: [_plain(fit, beam) for fit in group] for name, group in groups.items()}
    failure = f"the list is {per_cent(off)} too {'low' if worst.error < 0.0 else 'high'} at mode {worst.mode}"
    error = Margin(
        name="error of the list", size=off, where=f"at mode {worst.mode}", fine=within, limit=within, failure=failure
    )
    settings = not_default({"theory": options.theory})
    margins = [*beam_margins(SolutionCache(beam), [], mode=max(row.mode for row in bent), settings=settings), error]
    margins += [void(f"the list ({text})", text.rstrip(".")) for text in faults]
    checks: list[Any] = [("faults of the list", float(len(faults)), 0.0, "no" if faults else "yes")]
    checks.append(("largest error against the exact beam", off, within, "yes" if off <= within else "no"))
    columns = [Column("criterion"), Column("value", format=".3g"), Column("at most", format=".3g"), Column("passed")]
    tables = [*_tables(fits, beam, rows, required), Table("Acceptance", columns, checks)]
    kinds = {fit.fault.kind for fit in (best, *others)}
    if "clamp" in kinds and beam.uniform and set(beam.supports) == {"clamped", "free"}:
        warnings = [*warnings, TIP_MASS]
    figures = [_figure(beam, fits, rows, options.theory)] if any(row.motion == BENDING for row in rows) else []
    return Result(summary, tables, figures, warnings=warnings, data=about, margins=margins)


def _others(data: Data, fits: Identification, others: tuple[Fit, ...]) -> str:
    """Sentences on other explanations that agree, and on a nearer one that is no evidence."""
    best, nearer, text, beam = fits.best, fits.tested[0], "", data.beam
    if others:
        more = f"; and {len(others) - 3} more" if len(others) > 3 else ""
        text += f" Others that agree: {'; '.join(_title(one, beam) for one in others[:3])}{more}."
        alike = [one.differences for one in others if one.candidate.sized == best.candidate.sized]
        twins = len(alike) == len(others) and all(one.shape == best.differences.shape for one in alike)
        twins = twins and bool((abs(np.array(alike) - best.differences) < TWIN).all())
        which = "Their frequencies are equal: shapes or drawings" if twins else "More digits or modes"
        text += f" {which} distinguish them." * (fits.status == "ambiguous")
    if fits.status == "unknown" and nearer.rms < 0.5 * best.rms:
        agrees = data.agrees(nearer)
        why = "Within the digits, but of too few entries for its parameters" if agrees else "Nearer"
        far = "" if agrees else f", not within the digits: rms difference {nearer.rms:.2g}"
        text += f" {why}: {_title(nearer, beam)}{far}."
    return text


def _change(best: Fit, beam: Beam) -> str:
    """The joints to change in a chain with a wrong rule at the wall or at steps, N m/rad; empty without one."""
    from verify.engines.describe import describe

    wall, texts = best.candidate.wall or "", []
    try:
        half, gregory = (describe(beam, best.count or 1, wall=rule) for rule in ("half", "gregory"))
    except InputError:  # for example with tension, or without a discretisation
        return ""
    if wall and WALLS[wall].order == 1 and "clamped" in beam.supports:
        two, *three = (joint.hinges[0].stiffness for joint in (half.joints[0], *gregory.joints[:3]))
        weight = WALLS[wall].weights[0]
        now = f"{0.5 * two / weight:.6g}" if weight else "fixed"
        each = "each wall" if beam.supports == ("clamped", "clamped") else "the wall"
        better = ", ".join(f"{stiffness:.6g}" for stiffness in three)
        texts = [f"the joint at {each} ({now}) to {two:.6g} N m/rad = 2EI/l, or the first three to {better} (Gregory)"]
    if best.candidate.joints in ("printed", "outboard", "inboard", "mean"):
        steps = np.cumsum([piece.length for piece in half.beam.pieces[:-1]])
        at = [joint for joint in half.joints if np.isclose(joint.position, steps).any()]
        each = ", ".join(f"{joint.hinges[0].stiffness:.6g} N m/rad at {joint.position:.6g} m" for joint in at)
        texts += [f"joints at steps to those of two half links in series, {each}"]
    return f"{'; '.join(texts)}. All joints: `verify chain ... --count {best.count}`." if texts else ""


def _figure(beam: Beam, fits: Identification, rows: list[Entry], theory: str) -> Figure:
    """Errors of the list, the best and the next candidate."""
    best = fits.best
    following = next((fit for fit in fits.ranking[1:] if fit not in fits.equivalent), None)
    rows = [row for row in rows if row.motion == BENDING]
    n = max(row.mode for row in rows)

    def draw(ax: "Axes") -> None:
        exact = frequencies_hz(Candidate(model=EXACT, theory=theory), beam, None, n)
        ax.plot([row.mode for row in rows], [100.0 * row.error for row in rows], "o", label="list")
        for fit, style in ((best, "-"), (following, "--")):
            if fit is not None:
                hertz = frequencies_hz(fit.candidate, beam, fit.count, n)
                errors = 100.0 * (hertz / exact[: len(hertz)] - 1.0)
                ax.plot(np.arange(1, len(hertz) + 1), errors, style, label=fit.candidate.label)
        ax.set(xlabel="mode", ylabel="frequency error, %")
        ax.legend()

    caption = f"Errors against the exact {theory.capitalize()} beam. Points: the list. Lines: the best two candidates."
    return Figure("compare", "Frequencies and best candidates", caption, draw)


def _tables(fits: Identification, beam: Beam, rows: list[Entry], required: list[tuple[Any, ...]]) -> list[Table]:
    """Modes, other motions, candidates, faults, parameters, required N."""
    best, sizes = fits.best, [Column("candidate"), Column("N")]
    tables = [_modes(best, [row for row in rows if row.motion == BENDING])]
    lines: list[Any] = [(row.entry, row.motion, row.mode, row.listed_hz, row.exact_hz, row.error) for row in rows]
    if lines := [line for line in lines if line[1] != BENDING]:
        columns = [ENTRY[0], Column("motion"), *ENTRY[1:], Column("error", format=".4g", percent=True)]
        tables.append(Table("Other motions", columns, lines))
    words = {id(fit): "equivalent" for fit in fits.equivalent} | {id(fit): "alternative" for fit in fits.alternatives}
    words[id(best)] = "nearest" if fits.status in ("few", "unknown") else "best"
    lines = [
        (fit.candidate.label, fit.count, fit.candidate.order(beam), fit.rms, fit.largest, words.get(id(fit), ""))
        for fit in fits.ranking[:SHOWN]
    ]
    notes = ["rms: log frequency differences. Equivalent: equal frequencies. Alternative: agrees as well."]
    tables.append(Table("Candidates", [*sizes, Column("order"), *RMS, Column("status")], lines, notes))
    if fits.status == "unknown" or any(fit.fault.kind != "none" for fit in (best, *fits.alternatives)):
        lines = [
            (FAULTS[fit.fault.kind][0], value(fit, beam), fit.candidate.label, fit.count, fit.rms, fit.largest)
            for fit in fits.tested
        ]
        columns = [Column("fault"), Column("value"), *sizes, *RMS]
        tables.append(Table("Faults tested, the likeliest first", columns, lines))
    if best.fault.kind == "factor":
        held, heavy = is_lossless(beam), any(attachment.massive for attachment in beam.attached)
        euler = best.candidate.theory == EULER and not (held or heavy)
        possible = {"E": not held, "rho": not heavy}
        lines = [(name, best.parameter**power - 1.0) for name, power in POWERS.items() if possible.get(name, euler)]
        columns = [Column("parameter"), Column("change", format="+.3g", percent=True)]
        tables.append(Table("Parameters that alone explain the factor", columns, lines))
    columns = [Column("model"), Column("mode"), Column("N for 1 %"), Column("N for 0.1 %")]
    lines = [(candidate.label, *counts) for candidate, *counts in required]
    return [*tables, Table("Required N", columns, lines, [UNEVEN] * is_uneven(beam))]


def _title(fit: Fit, beam: Beam) -> str:
    """A candidate with its N and fault as text."""
    size = f", N = {fit.count}" if fit.count and fit.fault.kind != "count" else ""
    fault = "" if fit.fault.kind == "none" else f" with {FAULTS[fit.fault.kind][0]} {value(fit, beam)}"
    return f"{fit.candidate.label}{size}{fault}"


def _modes(best: Fit, rows: list[Entry]) -> Table:
    """Table of frequencies of the list, the exact beam and the best candidate, with and without the fault."""
    fault, shaped = best.fault, any(row.mac is not None for row in rows)
    faulty, factor = fault.kind not in ("none", "scene"), best.parameter if fault.kind == "factor" else 1.0
    columns = [*ENTRY, Column("error", format=".4g", percent=True)]
    columns += [Column("read as mode"), Column("corrected", "Hz", ".7g")] * faulty
    columns += [Column("candidate", "Hz", ".7g"), Column("difference", format=".3g", percent=True)]
    columns += [Column("MAC", format=".4f")] * shaped
    place, lines = {int(entry): i for i, entry in enumerate(fault.entries)}, []
    for row in rows:
        at, corrected = place.get(row.entry - 1), row.listed_hz / factor
        off = None if at is None else float(best.differences[at])
        line: list[Any] = [row.entry, row.mode, row.listed_hz, row.exact_hz, row.error]
        line += [None if at is None else int(fault.modes[at]) + 1, corrected] * faulty
        lines.append([*line, None if off is None else corrected / (1.0 + off), off, *[row.mac] * shaped])
    return Table("Modes", columns, sorted(lines, key=lambda line: line[1]))


def value(fit: Fit, beam: Beam) -> str:
    """The parameter of a fault as text, with the names of a factor that fits them."""
    kind = fit.fault.kind
    if kind == "count":
        return f"N = {fit.count}"
    words = [f"{fit.parameter:.6g}"] * (kind == "factor" or kind in CAUSES) + [fit.fault.label]
    if kind == "tension":
        off = fit.parameter - 1.0
        words.append(
            f"({fit.parameter * beam.tension:.6g} N, {abs(off):.3%} of T {'left out' if off < 0.0 else 'more'})"
        )
    if kind == "tip":
        whole = sum(piece.mass_per_length * piece.length for piece in beam.pieces)
        words.append(f"({fit.parameter * whole:.6g} kg that the scene lacks)")
    if kind == "factor":
        factors = FACTORS | {"plane strain, 1/sqrt(1 - nu^2)": (1.0 - beam.poissons_ratio**2) ** -0.5}
        if beam.width and beam.thickness and beam.width != beam.thickness and beam.uniform:
            factors["width and thickness exchanged"] = beam.width / beam.thickness
        offs = {name: abs(fit.parameter / factor - 1.0) for name, factor in factors.items()}
        near = min(offs.values())  # of several values of g the nearest
        names = [name for name, off in offs.items() if off < max(fit.rms, fit.digits, 1e-5) and off <= near + 1e-6]
        words += [f"({' or '.join(names)})"] * bool(names)
    return " ".join(word for word in words if word)


def _plain(fit: Fit, beam: Beam) -> dict[str, Any]:
    candidate = fit.candidate
    plain = msgspec.structs.asdict(candidate) | {"label": candidate.label, "order": candidate.order(beam)}
    fault = {"kind": fit.fault.kind, "label": fit.fault.label, "parameter": fit.parameter}
    return plain | {"count": fit.count, "rms": fit.rms, "largest": fit.largest, "fault": fault}
