"""The result of a comparison: modes, candidates, faults, required N and acceptance as tables; one figure."""

from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import is_uneven
from verify.analysis.verdict import Margin, void
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.fit import FAULTS, TOLERANCE, Data, Fit, Identification
from verify.compare.reading import FrequencyList
from verify.problem.beam import Beam
from verify.report.result import Column, Figure, Result, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 10
"""Largest number of candidates in the table; all are in the data."""
STATUS = {
    "identified": "Identified",
    "ambiguous": "Ambiguous: other candidates or faults agree within a factor of two of the rms difference. Best",
    "exact": "No discretisation detected: the exact beam agrees within a factor of two of the rms difference. Best",
    "few": "Too few frequencies to identify a model. Nearest",
    "unknown": "No known candidate agrees within 0.1 %. Nearest",
}
POWERS = {"E": 2.0, "rho": -2.0, "thickness or diameter": 1.0, "length": -0.5}
"""Parameters that change all frequencies by a common factor, with the power of the factor."""
TIP_MASS = "A cantilever with clamp stiffness k_r = c EI/L has the frequencies of one with a tip mass rho A L / c."
TIP_LINK = "EI/l at the wall (a fixed first link) is equivalent to 2EI/l with twice the mass (no mass) at the free end."
UNEVEN = "With steps or attachments inside a part a larger N may exceed the tolerance."
ENTRY = (Column("entry"), Column("mode"), Column("listed", "Hz", ".7g"), Column("exact", "Hz", ".7g"))
RMS = (Column("rms", format=".3g", percent=True), Column("largest", format=".3g", percent=True))


class Entry(msgspec.Struct, frozen=True):
    """A frequency of the list: entry from 1, and mode from 1 by position, number or shape."""

    entry: int
    mode: int
    listed_hz: float
    exact_hz: float
    mac: float | None

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
    required: list[tuple[Candidate | int | None, ...]],
    warnings: list[str],
    within: float | None,
) -> Result:
    """The result of a comparison with acceptance `data["passed"]`; `warnings` are faults of the list.

    `required`: candidates, modes, and N for 1 % and 0.1 %.
    """
    best, beam = fits.best, data.beam
    faults = (best.fault.kind != "none") + len(warnings)
    checks = [("faults of the list", float(faults), 0.0, not faults)]
    checks.append(
        ("largest difference from the best candidate", best.largest, TOLERANCE, fits.status not in ("few", "unknown"))
    )
    if within is not None:
        worst = max(abs(row.error) for row in rows)
        checks.append(("largest error against the exact beam", worst, within, worst <= within))
    words = {id(one): "equivalent" for one in fits.equivalent} | {id(one): "alternative" for one in fits.alternatives}
    words[id(best)] = "best"
    lines: list[Any] = [
        (one.candidate.label, one.count, one.candidate.order(beam), one.rms, one.largest, words.get(id(one), ""))
        for one in fits.ranking[:SHOWN]
    ]
    notes = ["rms: log frequency differences. Equivalent: equal frequencies. Alternative: rms below twice the best."]
    columns = [Column("candidate"), Column("N"), Column("order"), *RMS, Column("status")]
    tables = [_modes(best, rows), Table("Candidates", columns, lines, notes)]
    if len(fits.tested) > 1:
        columns = [Column("fault"), Column("value"), Column("candidate"), Column("N"), *RMS]
        lines = [(FAULTS[f.fault.kind][0], value(f), f.candidate.label, f.count, f.rms, f.largest) for f in fits.tested]
        tables.append(Table("Faults tested, the likeliest first", columns, lines))
    if best.fault.kind == "factor":
        held, bare = bool(beam.spring or beam.foundation or beam.tension), best.candidate.theory == EULER
        kept = {"E": not held, "rho": not beam.mass}
        bare &= not (held or beam.mass)
        lines = [(name, best.parameter**power - 1.0) for name, power in POWERS.items() if kept.get(name, bare)]
        columns = [Column("parameter"), Column("change", format="+.3g", percent=True)]
        tables.append(Table("Parameters that alone explain the factor", columns, lines))
    if required:
        columns = [Column("model"), Column("mode"), Column("N for 1 %"), Column("N for 0.1 %")]
        lines = [(one.label, *counts) for one, *counts in required]  # type: ignore[union-attr]
        tables.append(Table("Required N", columns, lines, [UNEVEN] * is_uneven(beam)))
    columns = [Column("criterion"), Column("value", format=".3g"), Column("at most", format=".3g"), Column("passed")]
    tables.append(Table("Acceptance", columns, [(*check[:3], "yes" if check[3] else "no") for check in checks]))
    size = f", N = {best.count}" if best.count else ""
    summary = f"{STATUS[fits.status]}: {best.candidate.label}{size}, rms difference {best.rms:.2g}."
    if best.fault.kind != "none":
        summary += f" Fault of the list: {FAULTS[best.fault.kind][0]} {value(best)}."
    if set(beam.supports) == {"clamped", "free"} and beam.uniform:
        clamp = any(one.fault.kind == "clamp" for one in (best, *fits.alternatives))
        lumped = best.candidate.mass == "joints" and best.candidate.wall in ("full", "rigid")
        warnings = [*warnings, *[TIP_MASS] * clamp, *[TIP_LINK] * lumped]
    about: dict[str, Any] = {"scene": scene, "source": source.source, "unit": source.unit}
    about |= {"passed": all(check[3] for check in checks), "status": fits.status, "best": _plain(best, beam)}
    groups = {"equivalent": fits.equivalent, "alternatives": fits.alternatives, "candidates": fits.ranking}
    about |= {name: [_plain(one, beam) for one in group] for name, group in groups.items()}
    mode, off = max((row.mode for row in rows), default=1), max((abs(row.error) for row in rows), default=0.0)
    own = Margin(name="error of the list", size=off, condition="this error of the list is acceptable")
    margins = [*beam_margins(SolutionCache(beam), [], mode=mode), own]
    if not all(check[3] for check in checks):
        margins.append(void("the list", f"{', '.join(c[0] for c in checks if not c[3])} beyond the limit"))
    figure = _figure(beam, fits, rows)
    return Result(summary, tables, [figure], warnings=warnings, data=about, margins=margins)


def _figure(beam: Beam, fits: Identification, rows: list[Entry]) -> Figure:
    """Errors of the list, the best and the next candidate."""
    best = fits.best
    following = next((one for one in fits.ranking[1:] if one not in fits.equivalent), None)
    n = max(row.mode for row in rows)

    def draw(ax: "Axes") -> None:
        exact = frequencies_hz(Candidate(model=EXACT), beam, None, n)
        ax.plot([row.mode for row in rows], [100.0 * row.error for row in rows], "o", label="list")
        for fit, style in ((best, "-"), (following, "--")):
            if fit is not None:
                hertz = frequencies_hz(fit.candidate, beam, fit.count, n)
                errors = 100.0 * (hertz / exact[: len(hertz)] - 1.0)
                ax.plot(np.arange(1, len(hertz) + 1), errors, style, label=fit.candidate.label)
        ax.set(xlabel="mode", ylabel="frequency error, %")
        ax.legend()

    caption = "Errors against the exact Euler-Bernoulli beam. Points: the list. Lines: the best and the next candidate."
    return Figure("compare", "Frequencies and best candidates", caption, draw)


def _modes(best: Fit, rows: list[Entry]) -> Table:
    """Table of frequencies of the list, the exact beam and the best candidate, with and without the fault."""
    fault, shaped = best.fault, any(row.mac is not None for row in rows)
    faulty, factor = fault.kind != "none", best.parameter if fault.kind in ("unit", "factor") else 1.0
    columns = [*ENTRY, Column("error", format=".4g", percent=True)]
    columns += [Column("read as mode"), Column("corrected", "Hz", ".7g")] * faulty
    columns += [Column("candidate", "Hz", ".7g"), Column("difference", format=".3g", percent=True)]
    columns += [Column("MAC", format=".4f")] * shaped
    place, lines = {int(entry): i for i, entry in enumerate(fault.entries)}, []
    for i, row in enumerate(rows):
        at, corrected = place.get(i), row.listed_hz / factor
        off = None if at is None else float(best.differences[at])
        line: list[Any] = [row.entry, row.mode, row.listed_hz, row.exact_hz, row.error]
        line += [None if at is None else int(fault.modes[at]) + 1, corrected] * faulty
        lines.append([*line, None if off is None else corrected / (1.0 + off), off, *[row.mac] * shaped])
    return Table("Modes", columns, sorted(lines, key=lambda line: line[1]))


def value(fit: Fit) -> str:
    """The parameter of a fault as text."""
    parameter = f"{fit.parameter:.6g}" if fit.fault.kind in ("unit", "factor", "clamp") else ""
    words = " ".join(word for word in (parameter, fit.fault.label) if word)
    return f"N = {fit.count}" if fit.fault.kind == "count" else words


def _plain(fit: Fit, beam: Beam) -> dict[str, Any]:
    one = fit.candidate
    plain = msgspec.structs.asdict(one) | {"label": one.label, "order": one.order(beam), "count": fit.count}
    fault = {"kind": fit.fault.kind, "label": fit.fault.label, "parameter": fit.parameter}
    return plain | {"rms": fit.rms, "largest": fit.largest, "fault": fault}
