"""The result of a comparison: modes, candidates, faults, required N and acceptance as tables; one figure."""

from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from verify.beam import Beam
from verify.compare.candidates import EXACT, Candidate, frequencies_hz
from verify.compare.fit import TOLERANCE, Data, Fit, Identification
from verify.compare.reading import FrequencyList
from verify.report.result import Column, Figure, Result, Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 10
"""Candidates in the table; all are in the data."""
STATUS = {
    "identified": "Identified",
    "ambiguous": "Ambiguous: other candidates or faults agree within a factor of two of the rms difference. Best",
    "exact": "No discretisation visible: the exact beam agrees within a factor of two of the rms difference. Best",
    "few": "Too few frequencies to identify a model. Nearest",
    "unknown": "No known candidate agrees within 0.1 %. Nearest",
}
FAULTS = {
    "none": "none",
    "unit": "wrong unit",
    "count": "another N",
    "factor": "common factor",
    "missing": "missing mode",
    "extra": "extra entry",
    "clamp": "compliant clamp, k_r in EI/L",
}
POWERS = {"E": 2.0, "rho": -2.0, "thickness or diameter": 1.0, "length": -0.5}
"""What alone changes all frequencies by a factor, and in which power of it."""
TIP_MASS = (
    "A clamp of k_r = c EI/L at one end of a cantilever and a mass of rho A L / c at the other have the same frequencies."
)
TIP_LINK = (
    "EI/l at the wall, or a fixed first link, has the frequencies of 2EI/l with twice the mass, or none, at the free end."
)


class Entry(msgspec.Struct, frozen=True, kw_only=True):
    """A frequency of the list."""

    entry: int
    """From 1."""
    mode: int
    """From 1, by its place, number or shape."""
    given_hz: float
    exact_hz: float
    mac: float | None


class Required(msgspec.Struct, frozen=True, kw_only=True):
    """N that tolerances require."""

    candidate: Candidate
    mode: int
    counts: tuple[int | None, ...]
    """For 1 % and 0.1 %; None: none found."""


def result_of(
    scene: Any,
    given: FrequencyList,
    options: Any,
    data: Data,
    found: Identification,
    rows: list[Entry],
    sizes: list[Required],
    warnings: list[str],
) -> Result:
    """Everything that a comparison computed."""
    best, beam = found.best, data.beam
    faulty = best.fault.kind != "none"
    known = found.status in ("identified", "ambiguous", "exact")
    errors = [row.given_hz / row.exact_hz - 1.0 for row in rows]
    checks = [
        ("faults of the list", float(faulty), 0.0, not faulty),
        ("largest difference from the best candidate", best.largest, TOLERANCE, known),
    ]
    if options.within is not None:
        worst = max(map(abs, errors))
        checks.append(("largest error against the exact beam", worst, options.within, worst <= options.within))
    passed = all(check[-1] for check in checks)
    size = f", N = {best.count}" if best.count else ""
    summary = f"{STATUS[found.status]}: {best.candidate.label}{size}, rms difference {best.rms:.2g}."
    summary += f" Fault of the list: {FAULTS[best.fault.kind]}, {_value(best)}." if faulty else ""
    tables = [_modes(beam, best, rows, errors), _candidates(beam, found), _faults(found), *_alone(beam, best)]
    if sizes:
        columns = [Column("model"), Column("mode"), Column("N for 1 %"), Column("N for 0.1 %")]
        needed = [(one.candidate.label, one.mode, *one.counts) for one in sizes]
        tables.append(Table("Required N", columns, needed, ["The error of all larger N that were solved is smaller."]))
    columns = [Column("criterion"), Column("value", format=".3g"), Column("at most", format=".3g"), Column("passed")]
    tables.append(Table("Acceptance", columns, [(*check[:3], "yes" if check[3] else "no") for check in checks]))
    if set(beam.supports) == {"clamped", "free"} and beam.uniform:
        clamp = any(one.fault.kind == "clamp" for one in (best, *found.alternatives))
        lumped = best.candidate.mass == "joints" and best.candidate.wall in ("full", "rigid")
        warnings += [TIP_MASS] * clamp + [TIP_LINK] * lumped
    return Result(
        summary=summary,
        tables=tables,
        figures=[_figure(beam, found, rows, errors)],
        warnings=warnings,
        data={
            "scene": scene.name,
            "source": given.source,
            "unit": given.unit,
            "status": found.status,
            "passed": passed,
            "best": _plain(best, beam),
            "equivalent": [_plain(one, beam) for one in found.equivalent],
            "alternatives": [_plain(one, beam) for one in found.alternatives],
            "candidates": [_plain(one, beam) for one in found.ranking],
            "required": sizes,
        },
    )


def _value(fit: Fit) -> str:
    """The parameter of a fault as text."""
    parameter = f"{fit.parameter:.6g}" if fit.fault.kind in ("unit", "factor", "clamp") else ""
    return " ".join(word for word in (parameter, fit.fault.label) if word) or f"N = {fit.count}"


def _plain(fit: Fit, beam: Beam) -> dict[str, Any]:
    one = fit.candidate
    fault = {"kind": fit.fault.kind, "label": fit.fault.label, "parameter": fit.parameter}
    plain = msgspec.structs.asdict(one) | {"label": one.label, "order": one.order(beam), "count": fit.count}
    return plain | {"rms": fit.rms, "largest": fit.largest, "fault": fault}


def _modes(beam: Beam, best: Fit, rows: list[Entry], errors: list[float]) -> Table:
    """Every frequency beside the exact one and that of the best candidate, with the fault and without."""
    faulty, factor = best.fault.kind != "none", best.parameter if best.fault.kind in ("unit", "factor") else 1.0
    place = {int(entry): i for i, entry in enumerate(best.fault.entries)}
    columns = [Column("entry"), Column("mode"), Column("given", "Hz", ".7g"), Column("exact", "Hz", ".7g")]
    columns += [Column("error", format=".4g", percent=True)]
    columns += [Column("read as mode"), Column("corrected", "Hz", ".7g")] * faulty
    columns += [Column("candidate", "Hz", ".7g"), Column("difference", format=".3g", percent=True)]
    shaped = any(row.mac is not None for row in rows)
    lines = []
    for i, (row, error) in enumerate(zip(rows, errors, strict=True)):
        line: list[Any] = [row.entry, row.mode, row.given_hz, row.exact_hz, error]
        at = place.get(i)
        corrected, off = row.given_hz / factor, None if at is None else float(best.differences[at])
        line += [None if at is None else int(best.fault.modes[at]) + 1, corrected] * faulty
        line += [None if off is None else corrected / (1.0 + off), off, *[row.mac] * shaped]
        lines.append(line)
    return Table("Modes", [*columns, *[Column("MAC", format=".4f")] * shaped], sorted(lines, key=lambda one: one[1]))


def _candidates(beam: Beam, found: Identification) -> Table:
    """The best candidates."""
    columns = [Column("candidate"), Column("N"), Column("order"), Column("rms difference", format=".3g", percent=True)]
    columns += [Column("largest", format=".3g", percent=True), Column("status")]
    words = {id(one): "equivalent" for one in found.equivalent} | {id(one): "alternative" for one in found.alternatives}
    words[id(found.best)] = "best"
    rows = [
        (one.candidate.label, one.count, one.candidate.order(beam), one.rms, one.largest, words.get(id(one), ""))
        for one in found.ranking[:SHOWN]
    ]
    notes = ["Equivalent: the same frequencies. Alternative: within a factor of two of the best rms difference."]
    return Table("Candidates", columns, rows, notes)


def _faults(found: Identification) -> Table:
    """Every kind of fault that was tested, by its best candidate."""
    columns = [Column("fault of the list"), Column("value"), Column("candidate"), Column("N")]
    columns += [Column("rms difference", format=".3g", percent=True), Column("status")]
    rows = []
    for one in found.tested:
        word = "diagnosis" if one.fault.kind == found.best.fault.kind else ""
        word = "alternative" if any(one.fault is other.fault for other in found.alternatives) and not word else word
        value = "" if one.fault.kind == "none" else _value(one)
        rows.append((FAULTS[one.fault.kind], value, one.candidate.label, one.count, one.rms, word))
    return Table("Faults tested", columns, rows)


def _alone(beam: Beam, best: Fit) -> list[Table]:
    """What alone explains a common factor on this beam, and by how much it would be off."""
    if best.fault.kind != "factor":
        return []
    held = bool(beam.spring or beam.foundation or beam.tension)
    bare = not held and not beam.mass and best.candidate.theory == "euler-bernoulli"
    kept = {"E": not held, "rho": not beam.mass, "thickness or diameter": bare, "length": bare}
    rows = [(name, best.parameter**power - 1.0) for name, power in POWERS.items() if kept[name]]
    columns = [Column("parameter"), Column("change", format="+.3g", percent=True)]
    return [Table("Parameters that alone explain the factor", columns, rows)] if rows else []


def _figure(beam: Beam, found: Identification, rows: list[Entry], errors: list[float]) -> Figure:
    """Frequency errors over the mode: of the list, the best candidate and the next."""
    n = max(row.mode for row in rows)
    following = next((one for one in found.ranking[1:] if one not in found.equivalent), None)

    def draw(ax: "Axes") -> None:
        exact = frequencies_hz(Candidate(model=EXACT), beam, None, n)
        ax.plot([row.mode for row in rows], 100.0 * np.array(errors), "o", label="list")
        for fit, style in ((found.best, "-"), (following, "--")):
            if fit is not None:
                hertz = frequencies_hz(fit.candidate, beam, fit.count, n)
                ax.plot(np.arange(1, len(hertz) + 1), 100.0 * (hertz / exact[: len(hertz)] - 1.0), style, label=fit.candidate.label)
        ax.set(xlabel="mode", ylabel="frequency error, %")
        ax.legend()

    caption = "Points: the list as given, against the exact beam (Euler-Bernoulli). Lines: candidates on a rigid clamp."
    return Figure("compare", "Frequencies beside the best candidates", caption, draw)
