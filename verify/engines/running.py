"""A chain of a file in the steps of its engine: whether it diverges, what runs, and which part is the integrator's.

Small vibration about rest, with the dashpots of the file. Armature counts to the integrator, by whose rules it is
chosen. Under gravity a chain is judged where its weight changes the first frequency by less than is permitted.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from math import floor, hypot, inf, isfinite, log10
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np

from verify.analysis.verdict import Margin, per_cent, three_digits, void
from verify.arrays import Array
from verify.engines.integrators import TRAPEZOIDAL, integrator_of, scheme_of
from verify.engines.line import Line
from verify.engines.reading import Setting, Solid
from verify.engines.steps import Modes, Simulated
from verify.errors import InputError
from verify.formatting import with_unit
from verify.validation import check_number

if TYPE_CHECKING:
    from verify.report.result import Table

NOTICED = 0.1
"""Damping by the integrator, over that of the file, from which it is named."""
ROUNDING = 1e-12
"""Damping ratio that is none."""
SAG = 0.6
"""Change of the first frequency over the square of the sag by linear theory over the length.

A uniform cantilever of 20 links about its equilibrium: 0.60 at sags of 0.01 to 0.1.
"""


class Motion(NamedTuple):
    """A chain about one axis: as in the file and as it runs, with armature; `exact` undamped Hz of its beam, (m,).

    `across`, `turned`: deflections and rotations of the centres of mass over the unknowns, (N, n). `first`: number of
    the first elastic mode.
    """

    line: Line
    exact: Array
    file: Simulated
    run: Simulated
    across: Array
    turned: Array
    first: int

    def figures(self) -> tuple[Modes, Array, Array]:
        """(elastic modes of the file and as they run, change of frequency, of the damping ratio), (m,) each."""
        part = slice(self.first, self.first + len(self.exact))
        file, run = self.file.modes, self.run.modes
        figures = (one[part] for one in (file.file_hz, file.file_zeta, run.hz, run.zeta))
        modes = Modes(*(np.where(abs(one) < ROUNDING, 0.0, one) for one in figures))
        still = modes.file_hz == 0.0
        change = np.where(still, 0.0, modes.hz / np.where(still, 1.0, modes.file_hz) - 1.0)
        return modes, change, modes.zeta - modes.file_zeta


class Ran(NamedTuple):
    """What `judge_runs` finds: `words` of the summary; `step` within all errors, s, 0: none is needed or known."""

    margins: list[Margin]
    words: str
    warnings: list[str]
    tables: "list[Table]"
    step: float
    data: dict[str, Any]


def setting_of(setting: Setting, engine: str, step: float | None) -> Setting:
    """That of a file, but `engine` 'NAME' or 'NAME:INTEGRATOR' and `step`, s, where given. Raises InputError."""
    name, _, integrator = engine.partition(":")
    if name and (integrator or name.casefold() != setting.engine.casefold()):
        setting = setting._replace(engine=name, integrator=integrator)
    if setting.engine:
        row = integrator_of(*setting[:2])
        setting = setting._replace(engine=row.engine, integrator=row.setting)
    if step is not None:
        check_number("step", step, "s", above=0)
    return setting if step is None else setting._replace(step=step)


def motion(line: Line, exact: Array, setting: Setting) -> Motion:
    """The matrices of a line in the steps of a setting; where that is unknown, in some."""
    (lengths, masses, centres, inertias), hinged = line.links.T, ~np.isnan(line.springs)
    edges = np.cumsum(lengths) - lengths
    turned = np.tril(np.ones((len(edges), len(edges))))[:, hinged]
    across = turned * (edges + centres)[:, None] - turned * edges[hinged]
    mass = (turned.T * inertias) @ turned
    if line.axis != "torsion":
        mass += (across.T * masses) @ across
    damping, stiffness, armature = (np.diag(one[hinged]) for one in (line.dashpots, line.springs, line.armatures))
    known = setting.engine and isfinite(setting.step)
    step, scheme = (setting.step, scheme_of(*setting[:2])) if known else (1.0, TRAPEZOIDAL)
    file = Simulated(mass, damping, stiffness, step, scheme)
    run = replace(file, mass=mass + armature) if armature.any() else file
    return Motion(line, exact, file, run, across, turned, int((file.modal[0] == 0.0).sum()))


def judge_runs(motions: Sequence[Motion], setting: Setting, within: float) -> Ran:
    """Margins, a sentence and a table of chains in the steps of a setting, by the modes that `exact` has."""
    lacks = [f"--{name}" for name, known in (("engine", setting.engine), ("step", isfinite(setting.step))) if not known]
    if lacks:
        text = f"in space only: give {' and '.join(lacks)}, by which the verdict is over the file as it runs"
        return Ran([], "", [text], [], 0.0, {})
    worst = min(motions, key=lambda one: (one.run.limit, -one.run.omega_max))
    limit, where = worst.run.limit, f" in {worst.line.axis}" if len(motions) > 1 else ""
    steps, warnings = accurate_steps(motions, within), [setting.note] if setting.note else []
    remark = integrator_of(*setting[:2]).remark
    if remark and (not worst.run.stable or setting.engine != "MuJoCo"):
        warnings.append(f"{' '.join(setting[:2])}: {remark}")
    good = _floor(min(0.5 * limit, *steps), 2)
    top, number = worst.run.omega_max, max(len(one.exact) for one in motions)
    remedy = f"time step at most {_time(min(steps))} for {per_cent(within)} at mode {number}"
    remedy = "choose another integrator" if not min(limit, *steps) else remedy * bool(min(steps) < limit)
    if not worst.run.stable:
        damped = " with its dashpots" if any(one.file.damping.any() for one in motions) else ""
        text = f"diverges{where} (omega_max h = {top * setting.step:.3g}, limit {top * limit:.3g}{damped})"
        text += f": time step at most {_time(limit)}, or {worst.run.substeps} substeps" if limit else " at every step"
        margins = [void("time step", text, remedy, leads=True)]
    else:
        margins, more = _errors(motions, setting, within, remedy)
        warnings += more
    if any(one.line.armatures.any() for one in motions):
        text = "armature counts to the integrator, is right for one step and for small vibration"
        warnings.append(text + ", undamped in one plane only" * (len(motions) > 1))
    bounds = [f"stable up to {_time(limit)}{where}" if isfinite(limit) else "stable at every step"]
    named = zip(("frequency", "damping"), steps, strict=True)
    bounds += [
        f"{per_cent(within)} in {name} at mode {number} up to {_time(each)}" for name, each in named if each < inf
    ]
    words = f"{' '.join(setting[:2])}, {with_unit(setting.step, 's')}: {', '.join(bounds)}; small vibration about rest."
    about = {"engine": setting.engine, "integrator": setting.integrator, "step": setting.step, "limit": limit}
    about |= {"stable": worst.run.stable, "substeps": worst.run.substeps, "omega_max": top, "axis": worst.line.axis}
    about |= {"accurate_steps": steps, "modes": {one.line.axis: one.figures()[0]._asdict() for one in motions}}
    passed = all(one.level == "trusted" for one in margins)
    return Ran(margins, words, warnings, [_table(motions)], 0.0 if passed else good, about)


def accurate_steps(motions: Sequence[Motion], within: float) -> tuple[float, float]:
    """Largest steps, s, at which frequency, and damping ratio, of the last of the modes are `within` that of the file.

    inf: every step. Armature, which is right for one step, is left out.
    """
    found = [inf, inf]
    for one in motions:
        for i, damping in enumerate((False, True)):
            with suppress(InputError):  # an overdamped mode has no frequency
                mode = one.first + len(one.exact)
                found[i] = min(found[i], one.file.step_for(mode, within, damping=damping))
    return found[0], found[1]


def _errors(motions: Sequence[Motion], setting: Setting, within: float, remedy: str) -> tuple[list[Margin], list[str]]:
    """(margin of the mode that differs most from the file, what its integrator adds to the damping)."""
    rows = [
        (hypot(c, z) if isfinite(c) else inf, c, z, mode, one, modes)
        for one in motions
        for modes, change, share in [one.figures()]
        for mode, (c, z) in enumerate(zip(change.tolist(), share.tolist(), strict=True))
    ]
    size, _, share, mode, one, modes = max(rows, key=lambda row: row[0])
    where = f" in {one.line.axis}" if len(motions) > 1 else ""
    whose = "the integrator's" + " and armature's" * bool(one.line.armatures.any())
    text, points = f"mode {mode + 1}{where} flips its sign at every step", f"{100.0 * abs(share):.2g} points"
    if isfinite(size):
        pairs = (modes.hz[mode], modes.zeta[mode]), (modes.file_hz[mode], modes.file_zeta[mode])
        now, file = (f"{three_digits(hz)} Hz with {per_cent(zeta)}" for hz, zeta in pairs)
        share_text = f", {points} {'of it' if share > 0.0 else 'less by'} {whose}" if abs(share) >= 0.0005 else ""
        text = f"mode {mode + 1}{where} runs at {now} damping{share_text}, in place of {file}"
    sizes: dict[str, Any] = {"size": size, "fine": within, "limit": within, "remedy": remedy}
    name, where = f"time step of {with_unit(setting.step, 's')}", f"at mode {mode + 1} in {one.line.axis}"
    more = [row for row in rows if row[2] > NOTICED * row[-1].file_zeta[row[3]] + 1e-6]
    warnings = []
    if more and size <= within:
        _, _, share, mode, one, modes = max(more, key=lambda row: row[2])
        text = f"{per_cent(modes.zeta[mode])} damping at mode {mode + 1} in {one.line.axis}"
        warnings.append(f"{text} in place of {per_cent(modes.file_zeta[mode])}, by {whose}")
    return [Margin(name=name, where=where, failure=text, **sizes)], warnings


def _table(motions: Sequence[Motion]) -> "Table":
    """Modes as meant, in the file, and as they run."""
    from verify.report.result import Column, Table

    columns = [Column("axis"), Column("mode"), *(Column(name, "Hz", ".6g") for name in ("meant", "file", "simulated"))]
    columns += [Column("change", format="+.3g", percent=True)]
    columns += [Column(name, format=".3g", percent=True) for name in ("damping", "simulated damping")]
    columns += [Column("added", format="+.3g", percent=True)]
    rows = list[tuple[Any, ...]]()
    for one in motions:
        modes, change, share = one.figures()
        damped = one.exact * np.sqrt(np.maximum(1.0 - modes.file_zeta**2, 0.0))
        figures = damped, modes.file_hz, modes.hz, change, modes.file_zeta, modes.zeta, share
        lists = [[x if isfinite(x) else None for x in each.tolist()] for each in figures]
        rows += zip([one.line.axis] * len(damped), range(1, 1 + len(damped)), *lists, strict=True)
    note = "Damped frequencies, meant those of the exact beam with the damping of the file; added by the integrator."
    return Table("As it runs", columns, rows, [note])


def under_gravity(motions: Sequence[Motion], solids: Sequence[Solid], gravity: Array, within: float) -> list[Margin]:
    """The margin of a weight that changes the first frequency by more than is permitted, along the chain or across."""
    every, found = {name for one in motions for name in one.line.joints}, list[tuple[float, str]]()
    places = [one.moves[0].at for one in solids if any(move.joint in every for move in one.moves)]
    along = (places[-1] - places[0]) / np.linalg.norm(places[-1] - places[0])
    for one in (each for each in motions if each.line.axis != "torsion"):
        (lengths, masses, centres, _), springs = one.line.links.T, np.diag(one.file.stiffness)
        length, edges = float(lengths.sum()), np.cumsum(lengths) - lengths
        down = float(gravity @ np.cross(np.array(one.line.about.split(), dtype=float), along))
        unit = float(np.median(springs)) * length / len(lengths) / length**2 / float(masses.sum())
        soft = np.divide(1.0, springs, out=np.full(len(springs), inf), where=springs > 0.0)
        angles = soft * (masses @ one.across) * down if down else np.zeros(len(soft))
        sag = abs(float(angles @ (length - edges[~np.isnan(one.line.springs)]))) / length
        text = f"its weight, {abs(down) / unit:.3g} EI/L^2, bends it by {sag:.2g} of its length (linear theory)"
        found.append((SAG * sag**2, text))
        beyond = lengths * (masses.sum() - np.cumsum(masses)) + centres * masses
        shape = one.file.modal[2][:, one.first]
        tension = float(gravity @ along) * float(beyond @ (one.turned @ shape) ** 2)
        change = 0.5 * tension / float(shape @ one.file.stiffness @ shape)
        text = f"its weight along it, {abs(float(gravity @ along)) / unit:.3g} EI/L^2, changes its first frequency"
        found.append((abs(change), f"{text} by {100.0 * change:+.2g} %"))
    size, text = max(found)
    if size <= within:
        return []
    words: dict[str, Any] = {
        "failure": f"not judged under gravity: {text}",
        "remedy": "set gravity to zero to judge it without",
    }
    return [Margin(name="gravity", size=size, fine=within, limit=within, leads=True, **words)]


def in_space_only(margin: Margin) -> Margin:
    """A margin of a file whose steps are unknown."""
    words = {key: f"{text}, in space only" for key in ("where", "failure") if (text := getattr(margin, key))}
    return msgspec.structs.replace(margin, **words)


def _time(step: float) -> str:
    """A step that is at most this one, in three digits."""
    return with_unit(_floor(step, 3), "s")


def _floor(value: float, digits: int) -> float:
    """The number of so many digits below; 0 of what is not finite and positive."""
    if not 0.0 < value < inf:
        return 0.0
    unit = 10.0 ** (floor(log10(value) + 1e-9) + 1 - digits)
    return float(f"{floor(value / unit + 1e-9) * unit:.{digits}g}")
