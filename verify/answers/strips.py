"""A strip or cable on the table: stiffness, clamp and damping from records, and the command that makes its chain."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from msgspec.structs import replace

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import per_cent
from verify.answers.beams import AnyBeam, named
from verify.blas import one_blas_thread
from verify.compare.record import COLOURED, need_record
from verify.errors import InputError
from verify.identify.ring_down import ring_down
from verify.identify.strip import Strip, identify_strip
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table

FAR = 3.0
"""Factor between the stiffness that is given and the result beyond which the mode numbers are in doubt."""


@one_blas_thread()
def identify_records(
    beam: AnyBeam, records: Sequence[str | Path], lengths: Sequence[float] = (), n_modes: int | None = None
) -> Result:
    """EI, compliance of the clamp and damping of a clamped-free strip from records of one or more free lengths.

    `beam`: as of `choose`, its modulus a guess. `lengths`: of the records, m, default that of the beam. `n_modes`: of
    every record, default those above its noise. `data["chain"]`: what `--set` and `--damping` of a chain need. Raises
    InputError.
    """
    own = named(beam).beam
    if not records or len(lengths) not in (0, len(records)):
        raise InputError(f"length: {len(lengths)} for {len(records)} records, give one for each record, or none")
    beams = [replace(own, length=length) for length in lengths] or [own] * len(records)
    rings = [ring_down(*need_record(Path(path))[:2], n_modes) for path in records]
    strip = identify_strip(beams, rings)
    warnings = [COLOURED] * (not all(ring.white for ring in rings))
    if strip.left_out:
        lost = ", ".join(f"{hz:.4g}" for hz in strip.left_out)
        warnings.append(f"left out, of no mode of the strip or too near half the sampling rate: {lost} Hz")
    if not 1.0 / FAR < (factor := strip.stiffness.value / own.bending_stiffness) < FAR:
        warnings.append(f"EI is {factor:.2g} times the one that is given: check section, material and length")
    if strip.rough:
        warnings.append("frequencies differ by more than their noise from those of the strip: intervals by the misfit")
    highest = max(number for _, number, _ in strip.modes)
    data: dict[str, object] = {"chain": _chain(beams[0], strip)}
    for name, one in (("bending_stiffness", strip.stiffness), ("compliance", strip.compliance)):
        data[name] = one and {"value": one.value, "interval": one.interval, "unit": one.unit}
    data |= {"damping": {"terms": strip.damping.terms, "law": strip.damping.law}}
    tables = [_quantities(beams[0], strip), _modes(beams, records, strip)]
    fitted = replace(beams[0], youngs_modulus=(own.youngs_modulus or 0.0) * factor)
    margins = beam_margins(SolutionCache(fitted), (), mode=highest)
    return Result(_summary(beams, strip), tables, warnings=warnings, margins=margins, data=data)


def _summary(beams: Sequence[Beam], strip: Strip) -> str:
    """What is found, and what the records do not separate."""
    ei, soft, beam = strip.stiffness, strip.compliance, beams[0]
    text = f"EI = {ei.value:.5g} ± {0.5 * (ei.interval[1] - ei.interval[0]):.2g} N m2"
    if soft is None:
        text += " for a rigid clamp, the least value: these frequencies do not separate EI from the clamp, whose "
        text += "compliance C raises EI by 4 C EI2/L; give a record of another free length."
    else:
        value = f"{soft.value:.3g} ± {0.5 * (soft.interval[1] - soft.interval[0]):.2g}"
        value = f"at most {soft.interval[1]:.2g}" if soft.interval[0] <= 0.0 else value
        text += f", compliance of the clamp {value} rad/(N m), by noise alone: errors of theory of 0.1 % in "
        text += f"frequencies change EI by {per_cent(strip.spread)}."
    mass, change = f"{beam.mass_per_length:.4g} kg/m", f"{0.4 / beam.length:.2g} %"
    text += f" Damping: {strip.damping.law}. Frequencies determine EI over the mass, taken as {mass}, and the free "
    return f"{text}lengths, of which 1 mm changes EI by {change}."


def _quantities(beam: Beam, strip: Strip) -> Table:
    """Values with 95 % intervals."""
    ei, soft, hz = strip.stiffness, strip.compliance, min(one.hz for *_, one in strip.modes)
    modulus = np.array([ei.value, *ei.interval]) * (beam.youngs_modulus or np.nan) / beam.bending_stiffness
    rows = [("bending stiffness EI", "N m2", ei.value, *ei.interval), ("Young's modulus", "Pa", *modulus.tolist())]
    if soft:
        rows.append(("compliance of the clamp C", "rad/(N m)", soft.value, *soft.interval))
        rows.append(("C EI/L", "1", *(x * ei.value / beam.length for x in (soft.value, *soft.interval))))
    zeta, half = strip.damping.ratio(hz)
    rows.append((f"loss factor at {hz:.4g} Hz", "1", *(2.0 * (zeta + side * half) for side in (0.0, -1.0, 1.0))))
    columns = [Column("quantity"), Column("unit"), *(Column(x, format=".5g") for x in ("value", "lower", "upper"))]
    return Table("Strip, with 95 % intervals", columns, rows)


def _modes(beams: Sequence[Beam], records: Sequence[str | Path], strip: Strip) -> Table:
    """Frequencies and damping ratios, measured and fitted."""
    columns = [Column("record"), Column("length", "m", ".4g"), Column("mode"), Column("measured", "Hz", ".6g")]
    columns += [Column("fitted", "Hz", ".6g"), Column("off", percent=True, format="+.2g")]
    columns += [Column(name, percent=True, format=".3g") for name in ("damping", "± (95 %)", "fitted damping")]
    rows = []
    for (record, number, mode), off in zip(strip.modes, strip.off.tolist(), strict=True):
        figures = (mode.undamped_hz, mode.undamped_hz / (1.0 + off), off, mode.zeta, mode.halves[1])
        name, fitted = Path(records[record]).name, strip.damping.ratio(mode.hz)[0]
        rows.append((name, beams[record].length, number, *figures, fitted))
    return Table("Modes", columns, rows, ["Undamped frequencies."])


def _chain(beam: Beam, strip: Strip) -> dict[str, object]:
    """The fields of the first record's beam that a chain takes, as of `--set`, and its damping."""
    modulus = strip.stiffness.value / beam.bending_stiffness * (beam.youngs_modulus or 0.0)
    fields = [f"beam.length={beam.length:.6g}", f"beam.youngs_modulus={modulus:.6g}"]
    if (soft := strip.compliance) and soft.interval[0] > 0.0:
        spring = f"[{{position=0, rotational={1.0 / soft.value:.6g}}}]"
        fields += ["beam.supports=pinned,free", f"beam.spring={spring}"]
    first = [(number, strip.damping.ratio(mode.hz)[0]) for record, number, mode in strip.modes if record == 0]
    most = 2 if strip.damping.terms[[0, 2]].any() else 1  # dashpots alone are a viscosity
    damped = [(number, ratio) for number, ratio in first if ratio > 0.0][:most]
    ratios, numbers = " ".join(f"{100.0 * ratio:.3g}%" for _, ratio in damped), ",".join(str(n) for n, _ in damped)
    return {"set": fields, "damping": f"{ratios} at {numbers}" if damped else "0"}
