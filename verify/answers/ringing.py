"""A record of free vibration beside the chain of rigid bodies whose run it is: measured, simulated, in the file."""

from dataclasses import replace
from math import hypot, isfinite
from pathlib import Path
from typing import Any

from verify.analysis.verdict import Margin, per_cent, three_digits, void
from verify.compare.record import read_record
from verify.errors import InputError
from verify.identify.ring_down import RingMode, ring_down
from verify.report.result import Column, Result, Table

ALIKE = 0.3
"""Distance of two poles over their size up to which they may be of one mode; modes 4 and 5 of a clamp are 0.4 apart."""
COMMON = 0.1
"""Spread of the frequency ratios over their distance from 1 up to which one factor explains them."""


def with_run(result: Result, path: Path, within: float) -> Result:
    """The judgement of a chain's file (`judge_file`) with a record of its run beside the modes as it runs.

    `data["record"]` has the pairs, and `data["passed"]` requires that they are `within` each other, relative in
    frequency and in points of damping, beyond the intervals of the record. Raises InputError.
    """
    if (record := read_record(path)) is None:
        raise InputError(f"file {str(path)!r} is no record: give 16 rows or more of a time 't' and signals")
    if not (modes := result.data["run"].get("modes")):
        raise InputError(f"file {str(path)!r}: a record is compared with a run, give --engine and --step")
    ring = ring_down(record.times, record.signals)
    pairs = _pairs(ring.modes, modes)
    rows = [_row(entry, mode, one) for entry, (mode, one) in enumerate(pairs, start=1)]
    columns = [Column("entry"), Column("mode"), Column("measured", "Hz", ".6g")]
    columns += [Column("±", "Hz", ".2g"), Column("as it runs", "Hz", ".6g"), Column("exact beam", "Hz", ".6g")]
    columns += [Column("off", percent=True, format="+.2g"), Column("damping", percent=True, format=".4g")]
    columns += [Column("±", percent=True, format=".2g")]
    columns += [Column(name, percent=True, format=".3g") for name in ("as it runs", "added")]
    margin, text = _verdict(pairs, within)
    notes = ["Damped frequencies with 95 % intervals; added: damping by the integrator.", *record.notes]
    if beyond := [one.hz for one, match in pairs if not match and one.hz > max(m["simulated_hz"] for m in modes)]:
        notes.append(f"Above the modes of the file that are compared: {', '.join(map(three_digits, beyond))} Hz.")
    warnings = [*result.warnings]
    if not ring.white:
        warnings.append("the residuals of the record are not white: more modes or nonlinear, its intervals too short")
    found = [mode.__dict__ | {"run": one} for mode, one in pairs]
    known = dict(result.data) | {"record": found, "passed": result.data["passed"] and margin.size <= within}
    tables = [Table("Record and run", columns, rows, notes), *result.tables]
    margins = [margin, *result.margins]
    summary = f"{text}{result.summary}"
    return replace(result, summary=summary, tables=tables, margins=margins, warnings=warnings, data=known)


def _pole(hz: float, zeta: float) -> complex:
    """A pole over 2 pi of damped frequency and damping ratio."""
    return complex(-zeta * hz / (1.0 - zeta**2) ** 0.5, hz)


def _pairs(ring: tuple[RingMode, ...], modes: list[dict[str, Any]]) -> list[tuple[RingMode, dict[str, Any] | None]]:
    """Every mode of a record with the one of the run whose pole is nearest, each used once; None beyond ALIKE."""
    close = list[tuple[float, int, int]]()
    for i, one in enumerate(ring):
        for k, mode in enumerate(modes):
            hz, zeta = mode["simulated_hz"], mode["simulated_damping"]
            if isfinite(hz) and hz > 0.0 and abs(zeta) < 1.0:
                pole = _pole(hz, zeta)
                close.append((abs(_pole(one.hz, one.zeta) - pole) / abs(pole), i, k))
    matched, used = dict[int, dict[str, Any]](), set[int]()
    for distance, i, k in sorted(close):
        if distance <= ALIKE and i not in matched and k not in used:
            matched[i] = modes[k]
            used.add(k)
    return [(one, matched.get(i)) for i, one in enumerate(ring)]


def _row(entry: int, mode: RingMode, one: dict[str, Any] | None) -> tuple[object, ...]:
    """A row of the table."""
    halves = [0.5 * (high - low) for low, high in (mode.hz_interval, mode.zeta_interval)]
    if one is None:
        return entry, None, mode.hz, halves[0], None, None, None, mode.zeta, halves[1], None, None
    hz, zeta, after = (one[key] for key in ("simulated_hz", "damping", "simulated_damping"))
    run = (hz, one["meant_hz"], mode.hz / hz - 1.0)
    name = one["mode"] if one["axis"] == "bending" else f"{one['mode']} in {one['axis']}"
    return entry, name, mode.hz, halves[0], *run, mode.zeta, halves[1], after, after - zeta


def _beyond(value: float, interval: tuple[float, float], expected: float) -> float:
    """Distance of an expected value from an interval, signed as value - expected; 0 inside."""
    low, high = interval
    return 0.0 if low <= expected <= high else low - expected if value > expected else high - expected


def _verdict(pairs: list[tuple[RingMode, dict[str, Any] | None]], within: float) -> tuple[Margin, str]:
    """(margin, sentence of a record that agrees) of measured and simulated modes."""
    both = [(mode, one) for mode, one in pairs if one]
    name, words = "record of the run", ", ".join(three_digits(mode.hz) for mode, _ in pairs)
    if not both:
        text = f"the record's frequencies ({words} Hz) are none of the file's as it runs"
        return void(
            name, text, "give the file and step of this run, and the unit of its times ('t_ms')", leads=True
        ), ""
    sizes = list[tuple[float, float, RingMode, dict[str, Any]]]()
    for mode, one in both:
        off = _beyond(mode.hz, mode.hz_interval, one["simulated_hz"]) / one["simulated_hz"]
        sizes.append((off, _beyond(mode.zeta, mode.zeta_interval, one["simulated_damping"]), mode, one))
    off, more, mode, one = max(sizes, key=lambda row: hypot(*row[:2]))
    size, hz, after = hypot(off, more), one["simulated_hz"], one["simulated_damping"]
    change, damping = mode.hz / hz - 1.0, f"{per_cent(mode.zeta)} damping in place of {per_cent(after)}"
    text = f"mode {one['mode']} in {one['axis']} has {damping}"
    if abs(off) > abs(more):
        text = f"mode {one['mode']} in {one['axis']} is {per_cent(change)} {'high' if change > 0.0 else 'low'} "
        text += f"({three_digits(mode.hz)} Hz in place of {three_digits(hz)} Hz)"
    ratios = [mode.hz / one["simulated_hz"] for mode, one in both]
    factor, remedy = sum(ratios) / len(ratios), "compare step, integrator, gravity and joints of the run with the file"
    if abs(off) <= abs(more) and abs(mode.zeta - one["damping"]) < 0.5 * abs(mode.zeta - after):
        remedy = "the run has the file's damping without the integrator's: give its step and integrator"
    elif len(ratios) > 1 and max(ratios) - min(ratios) < COMMON * abs(factor - 1.0):
        remedy = (
            f"all modes are by the factor {factor:.4g}: stiffness over mass is {factor**2:.4g} times that of the file"
        )
    failure = f"the record disagrees with the file as it runs: {text}"
    limits: dict[str, Any] = {"fine": within, "limit": within, "harm": "premise", "remedy": remedy}
    margin = Margin(name=name, size=size, where=f"at mode {one['mode']}", failure=failure, **limits)
    worst = max(abs(mode.hz / one["simulated_hz"] - 1.0) for mode, one in both)
    points = max(abs(mode.zeta - one["simulated_damping"]) for mode, one in both)
    first = max(both, key=lambda pair: pair[1]["simulated_damping"] - pair[1]["damping"])
    added = first[1]["simulated_damping"] - first[1]["damping"]
    text = f"The record is that of the file as it runs: {len(both)} mode{'s' * (len(both) > 1)} "
    text += f"within {per_cent(worst)} in frequency, {100.0 * points:.2g} points of damping"
    if added > within:
        text += (
            f"; mode {first[1]['mode']} rings at {per_cent(first[0].zeta)} damping, {100.0 * added:.2g} points of it "
        )
        text += "the integrator's"
    return margin, f"{text}. " if size <= within else ""
