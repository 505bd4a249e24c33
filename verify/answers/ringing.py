"""A record of free vibration beside the chain of rigid bodies whose run it is: measured, simulated, in the file."""

from collections.abc import Sequence
from dataclasses import replace
from math import hypot, isfinite
from pathlib import Path
from typing import Any, NamedTuple

from verify.analysis.verdict import Margin, per_cent, three_digits, void
from verify.compare.record import COLOURED, need_record
from verify.errors import InputError
from verify.identify.ring_down import RingMode, ring_down
from verify.report.result import Column, Result, Table

ALIKE = 0.3
"""Distance of two poles over their size up to which they may be of one mode; modes 4 and 5 of a clamp are 0.4 apart."""
COMMON = 0.1
"""Spread of the frequency ratios over their distance from 1 up to which one factor explains them."""


class Pair(NamedTuple):
    """A mode of a record and that of the run (`data["run"]["modes"]`) which it is."""

    mode: RingMode
    run: dict[str, Any]

    @property
    def off(self) -> float:
        """Relative difference of the frequencies, measured less simulated."""
        return self.mode.hz / float(self.run["simulated_hz"]) - 1.0

    @property
    def more(self) -> float:
        """Difference of the damping ratios."""
        return self.mode.zeta - float(self.run["simulated_damping"])

    @property
    def size(self) -> float:
        """Both differences beyond the intervals of the record."""
        hz, zeta = self.mode.halves
        return hypot(max(abs(self.off) - hz / self.mode.hz, 0.0), max(abs(self.more) - zeta, 0.0))


def with_run(result: Result, path: Path, within: float) -> Result:
    """The judgement of a chain's file (`judge_file`) with a record of its run beside the modes as it runs.

    `data["record"]` has the pairs, and `data["passed"]` requires that they are `within` each other, relative in
    frequency and in points of damping, beyond the intervals of the record. Raises InputError.
    """
    record = need_record(path)
    if not (modes := result.data["run"].get("modes")):
        raise InputError(f"file {str(path)!r}: a record is compared with a run, give --engine and --step")
    ring = ring_down(record.times, record.signals)
    tones = ring.tones([run["simulated_hz"] for run in modes if isfinite(run["simulated_hz"]) and run["simulated_hz"]])
    pairs = _pairs([mode for mode in ring.modes if mode not in tones], modes)
    columns = [Column("entry"), Column("mode"), Column("measured", "Hz", ".6g"), Column("±", "Hz", ".2g")]
    columns += [Column("as it runs", "Hz", ".6g"), Column("exact beam", "Hz", ".6g")]
    formats = {"off": "+.2g", "damping": ".4g", "±": ".2g", "as it runs": ".3g", "added": ".3g"}
    columns += [Column(name, percent=True, format=form) for name, form in formats.items()]
    rows = list[tuple[object, ...]]()
    for entry, mode in enumerate(ring.modes, start=1):
        one, (hz, zeta) = pairs.get(mode), mode.halves
        run = one.run if one else {"mode": "tone", "axis": "bending"} if mode in tones else {}
        name = run["mode"] if run.get("axis") == "bending" else f"{run['mode']} in {run['axis']}" if run else None
        first = (entry, name, mode.hz, hz, run.get("simulated_hz"), run.get("meant_hz"), one and one.off)
        rows.append((*first, mode.zeta, zeta, run.get("simulated_damping"), run.get("added")))
    margin, text = _verdict(ring.modes, [*pairs.values()], within)
    notes = ["Damped frequencies with 95 % intervals; added: damping by the integrator.", *record.notes]
    if beyond := [one.hz for one in ring.modes if one not in pairs and one.hz > max(m["simulated_hz"] for m in modes)]:
        notes.append(f"Above the modes of the file that are compared: {', '.join(map(three_digits, beyond))} Hz.")
    known = dict(result.data) | {"passed": result.data["passed"] and margin.size <= within}
    known["record"] = [mode.__dict__ | {"run": pairs[mode].run if mode in pairs else None} for mode in ring.modes]
    return replace(
        result,
        summary=f"{text}{result.summary}",
        tables=[Table("Record and run", columns, rows, notes), *result.tables],
        margins=[margin, *result.margins],
        warnings=[*result.warnings, *[COLOURED] * (not ring.white)],
        data=known,
    )


def _pairs(ring: Sequence[RingMode], modes: list[dict[str, Any]]) -> dict[RingMode, Pair]:
    """Modes of a record with those of the run whose poles are nearest, each used once, up to ALIKE."""
    close = list[tuple[float, int, int]]()
    for k, run in enumerate(modes):
        hz, zeta = run["simulated_hz"], run["simulated_damping"]
        if isfinite(hz) and hz > 0.0 and abs(zeta) < 1.0:
            pole = complex(-zeta * hz / (1.0 - zeta**2) ** 0.5, hz)
            close += [(abs(one.pole - pole) / abs(pole), i, k) for i, one in enumerate(ring)]
    found, used = dict[int, Pair](), set[int]()
    for distance, i, k in sorted(close):
        if distance <= ALIKE and i not in found and k not in used:
            found[i] = Pair(ring[i], modes[k])
            used.add(k)
    return {ring[i]: found[i] for i in sorted(found)}


def _verdict(ring: Sequence[RingMode], pairs: list[Pair], within: float) -> tuple[Margin, str]:
    """(margin, sentence of a record that agrees) of measured and simulated modes."""
    name, words = "record of the run", ", ".join(three_digits(mode.hz) for mode in ring)
    if not pairs:
        text = f"the record's frequencies ({words} Hz) are none of the file's as it runs"
        return void(name, text, "give the file and step of the run, and the unit of times ('t_ms')", leads=True), ""
    worst, factors = max(pairs, key=lambda one: one.size), [1.0 + one.off for one in pairs]
    mode, run, factor = worst.mode, worst.run, sum(factors) / len(factors)
    remedy, after = "compare step, integrator, gravity and joints of the run with the file", run["simulated_damping"]
    what = f"has {per_cent(mode.zeta)} damping in place of {per_cent(after)}"
    if abs(worst.off) > abs(worst.more):
        what = (
            f"is {per_cent(worst.off)} {'high' if worst.off > 0.0 else 'low'} ({three_digits(mode.hz)} Hz in place of "
        )
        what += f"{three_digits(run['simulated_hz'])} Hz)"
        if len(factors) > 1 and max(factors) - min(factors) < COMMON * abs(factor - 1.0):
            remedy = (
                f"all modes are by the factor {factor:.4g}: stiffness over mass is {factor**2:.4g} times the file's"
            )
    elif abs(mode.zeta - run["damping"]) < 0.5 * abs(worst.more):
        remedy = "the run has the file's damping without the integrator's: give its step and integrator"
    where, more = f"mode {run['mode']} in {run['axis']}", max(pairs, key=lambda one: float(one.run["added"]))
    failure = f"the record disagrees with the file as it runs: {where} {what}"
    limits: dict[str, Any] = {"fine": within, "limit": within, "harm": "premise", "remedy": remedy}
    margin = Margin(name=name, size=worst.size, where=f"at {where}", failure=failure, **limits)
    if worst.size > within:
        return margin, ""
    text = f"The record is that of the file as it runs: {len(pairs)} mode{'s' * (len(pairs) > 1)} within "
    text += f"{per_cent(max(abs(one.off) for one in pairs))} in frequency, "
    text += f"{max(100.0 * abs(one.more) for one in pairs):.2g} points of damping"
    if (added := more.run["added"]) > within:
        text += (
            f"; mode {more.run['mode']} rings at {per_cent(more.mode.zeta)} damping, {100.0 * added:.2g} points of it "
        )
        text += "the integrator's"
    return margin, f"{text}. "
