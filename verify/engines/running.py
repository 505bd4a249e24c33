"""A chain of a file in the steps of its engine: whether it diverges, what runs, and which part is the integrator's.

Small vibration about rest, with the dashpots of the file. Armature counts to the integrator, by which it is chosen.
"""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace
from math import hypot, inf, isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

import msgspec
import numpy as np

from verify.analysis.verdict import Margin, per_cent, three_digits, void
from verify.arrays import Array
from verify.engines.description import RigidChain, Steps
from verify.engines.integrators import integrator_of, scheme_of
from verify.engines.line import Line
from verify.engines.reading import Setting, Solid
from verify.engines.rules import Judged, rigid
from verify.engines.steps import Simulated, simulated_chain
from verify.errors import InputError
from verify.formatting import floored, with_unit
from verify.problem.beam import Beam
from verify.validation import check_number

if TYPE_CHECKING:
    from verify.report.result import Result, Table

ADDED = 0.1
"""Damping by the integrator, over that of the file and over the permitted error, from which it is named."""
SAG = 0.6
"""Change of the first frequency of a cantilever over the square of its sag by linear theory over its length.

By the tangent at the equilibrium of 20 links: 0.60 at sags of 0.01 to 0.1.
"""
BUCKLING = 7.837
"""Weight of a standing cantilever that buckles, EI/L^2 (Greenhill, 1881). W changes omega_1^2 by about W/BUCKLING."""


class Motion(NamedTuple):
    """A chain about one axis: as in the file and as it runs, with armature; `exact`: undamped Hz of its beam, (m,)."""

    axis: str
    exact: Array
    file: Simulated
    run: Simulated

    def rows(self) -> list[tuple[Any, ...]]:
        """Axis and mode; f as meant, in the file and simulated, change; zeta of the file and simulated, added."""
        part, found = slice(self.file.rigid, self.file.rigid + len(self.exact)), list[tuple[Any, ...]]()
        file, run = self.file.modes, self.run.modes
        figures = (one[part].tolist() for one in (file.file_hz, file.file_zeta, run.hz, run.zeta))
        for mode, (exact, hz, zeta, now, after) in enumerate(zip(self.exact.tolist(), *figures, strict=False), 1):
            meant, change = exact * max(1.0 - zeta**2, 0.0) ** 0.5, now / hz - 1.0 if hz else 0.0
            ratios = (one if abs(one) > 1e-12 else 0.0 for one in (zeta, after, after - zeta))  # rounding
            found.append((self.axis, mode, meant, hz, now, change, *ratios))
        return found


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
    return setting._replace(step=step or setting.step)


def _motion(line: Line | RigidChain, exact: Array, beam: Beam, setting: Setting) -> Motion:
    """The matrices of a line, or of a chain of all its axes, in the steps of a setting."""
    if isinstance(line, RigidChain):
        chain, axis, about = line, line.motions[0], line.motions[0]
    else:
        chain = replace(rigid(line, line.springs, beam, ""), viscosity=setting.viscosity)
        axis, about = line.axis, line.turns
    run = simulated_chain(chain, setting.step, scheme_of(*setting[:2]), about)
    bare = replace(run, mass=chain.matrices(about)[0])
    return Motion(axis, exact, bare if (bare.mass != run.mass).any() else run, run)


def judge_runs(
    lines: Sequence[Line | RigidChain], exact: Sequence[Array], beam: Beam, setting: Setting, within: float
) -> "Result":
    """Chains in the steps of a setting, `exact` undamped Hz of their beams; no `data` where the setting is unknown.

    `data["within"]`: step, s, within all errors, 0 where this one is or none is known.
    """
    from verify.report.result import Result

    lacks = [f"--{name}" for name, known in (("engine", setting.engine), ("step", isfinite(setting.step))) if not known]
    if lacks:
        text = f"in space only: give {' and '.join(lacks)} for the verdict over the file as it runs"
        return Result(warnings=[text])
    motions = [_motion(line, hertz, beam, setting) for line, hertz in zip(lines, exact, strict=True)]
    rows, warnings = [row for one in motions for row in one.rows()], [setting.note] if setting.note else []
    worst = min(motions, key=lambda one: (one.run.limit, -one.run.omega_max))
    run, limit, at = worst.run, float(worst.run.limit), f" in {worst.axis}" * (len(motions) > 1)
    name, remark = " ".join(setting[:2]), integrator_of(*setting[:2]).remark
    warnings += [f"{name}: {remark}"] if remark and (setting.engine != "MuJoCo" or not run.stable) else []
    if armature := any(one.file is not one.run for one in motions):
        text = "armature counts to the integrator, is right at one step and for small vibration"
        warnings.append(text + ", undamped about one axis only" * bool(at))
    steps, accuracy = _accurate(motions, within), f"{per_cent(within)} at mode {len(worst.exact)}"
    remedy = f"time step at most {_time(min(steps))} for {accuracy}" if 0.0 < min(steps) < limit else ""
    remedy = remedy if min(limit, *steps) else "choose another integrator"
    if run.stable:
        margin, more = _error(rows, bool(at), "the integrator" + " and armature" * armature, within)
        step = with_unit(setting.step, "s")
        margin, warnings = msgspec.structs.replace(margin, name=f"time step of {step}", remedy=remedy), warnings + more
    else:
        damped = " with its dashpots" * any(one.file.damping.any() for one in motions)
        x = [f"{run.omega_max * h:.3g}" for h in (setting.step, limit)]
        text = f"diverges{at} (omega_max h = {x[0]}, limit {x[1]}{damped})"
        text += f": time step at most {_time(limit)}, or {run.substeps} substeps" if limit else " at every step"
        margin = void("time step", text, remedy, leads=True)
    bounds = [f"stable up to {_time(limit)}{at}" if 0.0 < limit < inf else "stable at every step"] if limit else []
    for what, h in zip(("frequency", "damping"), steps, strict=True):
        bounds += [f"{accuracy} in {what} up to {_time(h)}"] if 0.0 < h < inf else []
    words = f"{name}, {with_unit(setting.step, 's')}: {', '.join([*bounds, 'small vibration about rest'])}."
    data = {"engine": name, "step": setting.step, "limit": limit, "stable": run.stable, "substeps": run.substeps}
    good = min(0.5 * limit, *steps) if margin.level != "trusted" else inf
    data |= {"omega_max": run.omega_max, "axis": worst.axis, "accurate_steps": steps}
    keys = "axis", "mode", "meant_hz", "file_hz", "simulated_hz", "change", "damping", "simulated_damping", "added"
    data["modes"] = [dict(zip(keys, row, strict=True)) for row in rows]
    data["within"] = floored(good, 2) if 0.0 < good < inf else 0.0
    return Result(words, [_table(rows)], warnings=warnings, margins=[margin], data=data)


def chain_runs(chain: RigidChain, steps: Steps, modes: int, within: float) -> "tuple[Table, Margin, list[str]]":
    """(modes as meant and simulated, margin of the one that differs most, warnings) of a chain for its steps."""
    motions, scheme = list[Motion](), scheme_of(*steps[1:])
    for axis in chain.motions:
        file, run = (simulated_chain(one, steps.step, scheme, axis) for one in (chain.meant or chain, chain))
        motions.append(Motion(axis, chain.exact_hz(axis, modes), file, run))
    rows, step = [row for one in motions for row in one.rows()], with_unit(steps.step, "s")
    margin, warnings = _error(rows, len(motions) > 1, "the integrator", within)
    words = {"name": f"time step of {step}", "remedy": "give a shorter step"}
    text = "the far end is held by an equality, which acts after the dashpots: with them to about 1e-3 of f"
    notes = [*chain.remarks, *[text] * (steps.engine == "MuJoCo" and chain.closed and chain.damping > 0.0)]
    remark = integrator_of(*steps[1:]).remark
    notes += [f"{' '.join(steps[1:])}: {remark}"] if remark and steps.engine != "MuJoCo" else []
    return _table(rows, notes), msgspec.structs.replace(margin, **words), warnings


def _accurate(motions: Sequence[Motion], within: float) -> list[float]:
    """Largest steps, s, at which frequency, and damping ratio, of the last mode are `within` those of the file.

    inf: every step, and with armature, which is right at one step.
    """
    found = [inf, inf]
    for one in (each for each in motions if each.file is each.run):
        with suppress(InputError):  # an overdamped mode has no frequency
            mode = one.file.rigid + len(one.exact)
            steps = [float(one.file.step_for(mode, within, damping=damping)) for damping in (False, True)]
            found = [min(pair) for pair in zip(found, steps, strict=True)]
    return found


def _error(rows: list[tuple[Any, ...]], several: bool, cause: str, within: float) -> tuple[Margin, list[str]]:
    """(margin of the mode that differs most from the file, what is added to the damping where that is permitted)."""
    sizes = [hypot(row[5], row[8]) if isfinite(row[5]) else inf for row in rows]
    axis, mode, _, hz, now, _, zeta, after, added = rows[int(np.argmax(sizes))]
    size, where = max(sizes), f" in {axis}" * several
    text = f"mode {mode}{where} flips its sign at every step"
    if size < inf:
        share = f", {100.0 * added:.2g} points of it {cause}'s" * (added >= 0.0005)
        text = f"mode {mode}{where} runs at {three_digits(now)} Hz with {per_cent(after)} damping"
        text += f"{share}, in place of {three_digits(hz)} Hz with {per_cent(zeta)}"
    margin = Margin(name="", where=f"at mode {mode} in {axis}", failure=text, size=size, fine=within, limit=within)
    axis, mode, *_, zeta, after, added = max(rows, key=lambda row: row[8])
    if size > within or added <= ADDED * max(zeta, within):
        return margin, []
    return margin, [f"damping {per_cent(after)} at mode {mode} in {axis} in place of {per_cent(zeta)}, by {cause}"]


def _table(rows: list[tuple[Any, ...]], notes: Sequence[str] = ()) -> "Table":
    """Modes as meant, in the file, and as they run."""
    from verify.report.result import Column, Table

    hz = [Column(name, "Hz", ".6g") for name in ("meant", "file", "simulated")]
    signed = [Column(name, format="+.3g", percent=True) for name in ("change", "added")]
    ratios = [Column(name, format=".3g", percent=True) for name in ("damping", "simulated damping")]
    columns = [Column("axis"), Column("mode"), *hz, signed[0], *ratios, signed[1]]
    cells = [[None if isinstance(x, float) and not isfinite(x) else x for x in row] for row in rows]
    note = "Damped frequencies, meant those of the exact beam with the damping of the file; added by the integrator."
    return Table("As it runs", columns, cells, [note, *notes])


def under_gravity(judged: Sequence[Judged], solids: Sequence[Solid], gravity: Array, within: float) -> list[Margin]:
    """The margin of a weight that changes the first frequency of a cantilever by more than is permitted.

    Along the chain, or across by its sag. A weight that is not uniform counts by its moment about the wall.
    """
    every, found = {name for one in judged for name in one.line.joints}, list[tuple[float, str]]()
    places = [one.moves[0].at for one in solids if any(move.joint in every for move in one.moves)]
    along = (places[-1] - places[0]) / np.linalg.norm(places[-1] - places[0])
    for line, stiffness in ((one.line, one.stiffness) for one in judged if one.line.axis != "torsion"):
        lengths, masses, centres, _ = line.links.T
        moment, length = float(masses @ (np.cumsum(lengths) - lengths + centres)), float(lengths.sum())
        uneven = 2.0 * moment / length / float(masses.sum())
        down, pull = (  # weights in EI/L^2
            float(gravity @ one) * float(masses.sum()) * length**2 / stiffness
            for one in (np.cross(np.array(line.about.split(), dtype=float), along), along)
        )
        sag = uneven * abs(down) / 8.0 if line.springs[0] or abs(down) < 0.01 else inf  # a free joint at the wall
        text = f"its weight, {abs(down):.3g} EI/L^2, bends it by {sag:.2g} of its length (linear theory)"
        found.append((SAG * sag**2, text))
        change = 0.5 * max(uneven * pull / BUCKLING, -1.0)
        text = f"{'raises' if pull > 0.0 else 'lowers'} its first frequency by about {per_cent(change)}"
        text = text if change > -0.5 else "buckles it"
        found.append((abs(change), f"its weight along it, {abs(pull):.3g} EI/L^2, {text}"))
    return gravity_margin(*max(found), within)


def gravity_margin(size: float, text: str, within: float) -> list[Margin]:
    """The margin of a weight of relative effect `size`, none where that is `within`."""
    words: dict[str, Any] = {"name": "gravity", "failure": f"not judged under gravity: {text}"}
    words["remedy"] = "set gravity to zero for the frequencies without it"
    return [Margin(size=size, fine=within, limit=within, harm="premise", **words)] if size > within else []


def in_space_only(margin: Margin) -> Margin:
    """A margin of a file whose steps are unknown."""
    words = {key: f"{text}, in space only" for key in ("where", "failure") if (text := getattr(margin, key))}
    return msgspec.structs.replace(margin, **words)


def _time(step: float) -> str:
    """A step that is at most this one, in three digits."""
    return with_unit(floored(step, 3), "s")
