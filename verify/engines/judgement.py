"""A chain of rigid links from a file of an engine against the exact beam it means: errors, corrections, verdict."""

import itertools
import re
from functools import partial
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any
from xml.etree import ElementTree

import numpy as np

from verify.analysis.plausibility import unit_margins
from verify.analysis.verdict import FINE, Margin, per_cent
from verify.engines.curve_faults import lost_angles
from verify.engines.curved_files import judge_rod, needs_rod, rod_under_gravity
from verify.engines.line import Line, lines
from verify.engines.reading import DRAG, Solid, read
from verify.engines.rules import SAME, SQUARE, Judged, clamped, elastic_clamp, half_links, judge
from verify.engines.running import in_space_only, judge_runs, setting_of, under_gravity
from verify.engines.section_axes import contradictions, planes
from verify.engines.stiffness_law import MANY
from verify.engines.twist import judge_twist
from verify.errors import InputError, shown
from verify.files import whole
from verify.formatting import with_unit
from verify.problem.beam import Beam, check_features, in_plane
from verify.problem.supports import FIXED

if TYPE_CHECKING:
    from verify.report.result import Result, Table

STIFFNESS = {"bending": "EI", "torsion": "GJ"}
NOTICED = 0.1
"""Part of the acceptance up to which an error of a mode may grow by a correction."""


def _from_wall(line: Line, beam: Beam, name: str) -> Beam:
    """The beam from the wall of a line on. Raises InputError."""
    beam = beam.mirrored() if sum(FIXED[beam.supports[0]]) < sum(FIXED[beam.supports[1]]) else beam
    held = clamped(beam) if elastic_clamp(beam) else beam
    check_features(held, "the comparison of a file", ("section", "bodies"))
    if abs((length := float(line.links[:, 0].sum())) / beam.length - 1.0) > 0.01:
        remedy = ": a first link without a joint must be a body" * (length < beam.length)
        raise InputError(f"{name}: its chain is {length:.6g} m long, the beam {beam.length:.6g} m{remedy}")
    return beam


def _judged(bending: list[Line], twists: list[Line], beam: Beam | None, theory: str) -> list[Judged]:
    """The rules of a straight chain in each plane and, where a shaft explains it, in torsion."""
    judged = [judge(line, beam and in_plane(beam, line.axis), theory) for line in bending]
    return judged + [one for line in twists if (one := judge_twist(line, beam))]


def judge_file(
    path: Path,
    beam: Beam | None,
    modes: int = 5,
    within: float = FINE,
    theory: str | None = None,
    corrected: Path | None = None,
    engine: str = "",
    step: float | None = None,
) -> "Result":
    """The result of the chain in a file as it runs, acceptance in `data["passed"]`: all errors are `within`.

    `theory`: by default "euler-bernoulli" in a plane, "rayleigh" in space where links have the rotary inertia of their
    drawn sections. `corrected`: file to write, with correct stiffnesses and a time step that runs. `engine` "NAME" or
    "NAME:INTEGRATOR", `step` in s: in place of those of the file. Raises InputError for another file.
    """
    from verify.report.result import Column, Result, Table

    if corrected and corrected.suffix.lower() != path.suffix.lower():
        raise InputError(f"corrected = {shown(str(corrected))}: the format stays, end the name with {path.suffix}")
    kind, solids, gravity, own = read(path)
    setting, every = setting_of(own, engine, step), lines(solids, path.name)
    if (rod := beam is None and needs_rod(every[0])) and theory:
        raise InputError(f"theory = {shown(theory)}: a chain that is curved or graded has none to choose, leave it out")
    if beam and every[0].curve.bent:
        raise InputError(f"{path.name}: its chain is curved and the beam is straight, give the file alone")
    in_space = len(found := [line for line in every if line.axis != "torsion"]) > 1 and all(one.solid for one in found)
    theory = theory or ("rayleigh" if in_space else "euler-bernoulli")
    beam = beam and _from_wall(found[0], beam, path.name)
    axes = planes(found, beam)
    found = [line._replace(axis=axis) for line, axis in zip(found, axes, strict=True)]
    judged = judge_rod(every, path.name) if rod else _judged(found, every[len(found) :], beam, theory)
    if rod and setting.viscosity:
        setting = setting._replace(note="; ".join(filter(None, [DRAG, setting.note])))
    lone = every[len(judged) :]
    columns = [Column("axis"), Column("mode"), *(Column(name, "Hz", ".7g") for name in ("exact", "file"))]
    columns += [Column(name, format="+.3g", percent=True) for name in ("error", "corrected")]
    motions = judged[: 1 if rod else None]  # of a rod all axes vibrate together
    each, margins_of, worse, data = zip(*(_assess(one, modes, within) for one in motions), strict=True)
    rows, margins = list(itertools.chain(*each)), list(itertools.chain(*margins_of))
    exact = [one["exact_hz"] for one in data] + [np.full(len(rows) // len(motions), np.nan)] * len(lone)
    run = partial(judge_runs, exact=exact, beam=judged[0].present.beam, setting=setting, within=within)
    ran = run([judged[0].present] if rod else [*(one.line for one in judged), *lone])
    units = unit_margins(beam or judged[0].correct.beam)
    others = [*units, *ran.margins, *(rod_under_gravity if rod else under_gravity)(judged, solids, gravity, within)]
    notes = ["Exact is the rod of the joints, estimated by links in 2 and 4 parts, of long chains in 1 and 2."] * rod
    tables = [Table("Frequencies", columns, rows, notes), *ran.tables, *map(_joints, judged)]
    warnings = [text for one in judged for text in one.advice]
    clashes, changes = [*contradictions(found, axes, beam), *lost_angles(every)], _changes(judged)
    for text, size, remedy in clashes:
        words: dict[str, Any] = {"name": text, "remedy": remedy, "failure": f"{text}: {per_cent(size)}"}
        others.append(Margin(size=size, fine=within, limit=within, harm="premise", **words))
    warnings += [*ran.warnings, *_hints(solids, judged, beam, lone), *filter(None, worse)]
    if corrected and (clashes or any(worse) or (rod and judged[0].odd)):
        why = clashes[0][-1] if clashes else "it would be worse" if any(worse) else "a joint is off the law"
        warnings.append(f"{shown(str(corrected))} is not written: {why}")
    elif corrected:
        right = [one.line._replace(springs=one.springs) for one in judged]
        last = run([judged[0].correct] if rod else [*right, *lone]).data.get("within", 0.0)
        warnings.append(_write(path, kind, solids, changes, corrected, 0.0 if step else last))
        warnings += [f"run {shown(str(corrected))} at a time step of {with_unit(last, 's')}"] if step and last else []
    rules = [f"{one.line.axis}: {one.rule}, {STIFFNESS[one.line.turns]} {one.means}" for one in judged]
    sizes = f"{data[0]['links']} rigid links, {data[0]['length']:.6g} m, {data[0]['mass_per_length']:.6g} kg/m"
    summary = f"{'; '.join([sizes, *rules])}. {ran.summary}".strip()
    worst = max([one.size for one in others] + [float(abs(one["error"]).max()) for one in data])
    margins = others + (margins if ran.data else [in_space_only(one) for one in margins])
    known = {"passed": worst <= within, "chains": list(data), "rules": rules, "run": ran.data}
    return Result(summary, tables, warnings=warnings, margins=margins, data=known)


def _changes(judged: list[Judged]) -> dict[str, float]:
    """Correct stiffnesses by the names of joints that have others."""
    each = [zip(one.line.joints, one.springs.tolist(), one.line.springs, strict=True) for one in judged]
    return {name: k for pairs in each[::-1] for name, k, old in pairs if name and abs(k - old) > SAME * k}


def _joints(one: Judged) -> "Table":
    """Joints of a chain, of one that means a rod with the rest angles, the links beyond and what they mean."""
    from verify.report.result import Column, Table

    line, number = one.line, range(len(one.springs))
    columns, cells = [Column("joint"), Column("name")], list[Any]([number, line.joints])
    if not one.present.straight:
        lengths = line.links[:, 0]
        columns += [Column("rest angle", "deg", ".4g"), Column("length", "m", ".5g")]
        columns += [Column(STIFFNESS[line.turns], "N m2", ".5g")]
        cells += [np.degrees([one.present.rest_angle(j) for j in number]), lengths, line.springs * half_links(lengths)]
    columns += [Column(name, "N m/rad", ".6g") for name in ("present", "correct")]
    changes = one.springs / np.where(line.springs > 0.0, line.springs, np.nan) - 1.0
    cells += [line.springs, one.springs, np.where(abs(changes) > SAME, changes, np.nan)]
    columns.append(Column("change", format="+.3g", percent=True))
    shown = [[None if isinstance(x, float) and np.isnan(x) else x for x in each] for each in cells]
    return Table(f"Joints in {line.axis}", columns, list(zip(*shown, strict=True)))


def _assess(one: Judged, modes: int, within: float) -> tuple[Any, list[Margin], str, dict[str, Any]]:
    """(rows of frequencies, margins, why correct joints do not help, data) of a chain."""
    n, hertz, changes = len(one.springs), one.present.frequencies_hz(one.line.turns, modes), _changes([one])
    axis = one.line.axis if one.present.straight else one.present.motions[0]
    m, exact = len(hertz), one.present.exact_hz(one.line.turns, len(hertz))
    errors, after = hertz / exact - 1.0, one.correct.frequencies_hz(one.line.turns, m) / exact - 1.0
    rows = list(zip([axis] * m, range(1, m + 1), exact, hertz, errors, after, strict=True))
    limits: dict[str, Any] = {"fine": within, "limit": within}
    margins, text, worst = list[Margin](), "; ".join(one.faults), int(abs(errors).argmax())
    size, where = float(abs(errors[worst])), f"at mode {worst + 1} in {axis}"
    cause, worse = _cause(one), ""
    lost = np.flatnonzero(abs(after) > np.maximum(abs(errors), NOTICED * within))
    if changes and len(lost):
        numbers, (old, new) = ", ".join(str(1 + mode) for mode in lost), (100.0 * x[lost[0]] for x in (errors, after))
        worse = f"errors of the file cancel at mode {numbers} in {axis}, the joints below are worse"
        worse += f" ({old:+.3g} to {new:+.3g} %): {cause}"
    remedy = "set the joints below" + f", {cause}" * bool(one.odd) if changes and not worse else cause
    if text:
        failure = f"{text}: {per_cent(size)} {where}"
        margins.append(Margin(name=text, size=size, where=where, remedy=remedy, failure=failure, **limits))
    if (changes and not worse) or not text:
        worst = int(abs(after).argmax())
        size, where = float(abs(after[worst])), f"at mode {worst + 1} in {axis}"
        what = f"{n} links with correct joints" + f", but {'; '.join(one.links)}" * bool(one.links)
        margins.append(Margin(name=what, size=size, where=where, remedy=cause, **limits))
    own = one.present.beam
    about: dict[str, Any] = {"axis": axis, "links": n, "rule": one.rule, "faults": one.faults, "length": own.length}
    about |= {"stiffness": one.stiffness, "mass_per_length": own.mass_per_length, "supports": own.supports}
    about |= {"frequencies_hz": hertz, "exact_hz": exact, "error": errors, "corrected_error": after, "odd": [*one.odd]}
    return rows, margins, worse, about


def _cause(one: Judged) -> str:
    """What to change where other stiffnesses do not help, the largest cause first."""
    lengths, usual = one.line.links[:, 0], float(np.median(one.line.links[:, 0]))
    if long := [j for j in range(len(lengths)) if lengths[j] > 1.5 * usual]:
        names = " and ".join(f"{one.line.joints[j] or 'the wall'} ({lengths[j]:.4g} m)" for j in long[:2])
        return f"divide the link behind {names} into links of {usual:.4g} m"
    if one.links and one.line.axis == "torsion":
        return "give the links the polar inertia of the beam"
    if one.links:
        return "give the links the mass of the beam, m l^2/12 about l/2"
    if one.odd:
        text = " or give a scene that has it" * (not one.line.curve.bent)
        return f"set joint {', '.join(f'{name} to {k:.6g} N m/rad' for name, k in [*one.odd.items()][:MANY])}{text}"
    return one.remedy


def _hints(solids: list[Solid], judged: list[Judged], beam: Beam | None, untwisted: list[Line]) -> list[str]:
    """What the frequencies leave out: ball joints, torsion, free hinges; the modulus that EI means for round links."""
    hints = list[str]()
    if any(one.line.ball for one in judged):
        hints.append("a ball joint is read as three hinges of one stiffness, that of bending; torsion is not judged")
    elif untwisted:
        hints.append("torsion is not judged: joints and inertias are of no uniform shaft, give a scene with sections")
    sprung = {joint for one in [*(each.line for each in judged), *untwisted] for joint in one.joints}
    free = [move.joint for one in solids for move in one.moves if not (move.stiffness or move.joint in sprung)]
    if free:
        hints.append(f"joint {shown(free[0])}{f' and {len(free) - 1} more' * (len(free) > 1)} turns freely: not judged")
    radius = float(np.median([one.radius for one in solids if one.moves and one.radius] or 0.0))
    if beam is None and radius > 0.0:
        modulus = judged[0].stiffness / (0.25 * pi * radius**4) / 1e9
        text = f"E = {modulus:.4g} GPa, or {modulus / SQUARE:.4g} GPa if it is a square section's; check by --beam"
        hints.append(f"round links of {2e3 * radius:.4g} mm: EI is that of {text}")
    return hints


def _write(path: Path, kind: str, solids: list[Solid], new: dict[str, float], out: Path, step: float) -> str:
    """The file with stiffnesses `new` by joint, a time step, s, but for 0, and nothing else changed; what was written.

    Raises InputError.
    """
    edits, data = list[tuple[int, int, str]](), path.read_bytes()
    text = re.sub(rb"(?s)<!--.*?-->", lambda comment: b" " * len(comment[0]), data)
    if kind != "mujoco":
        for name, k in new.items():
            joint = name.removesuffix(" axis2")  # the second of a universal joint
            within = rf"(?:(?!</joint>).)*?<axis{'2' * (joint != name)}\b" if kind == "sdf" else ""
            tag, field, spring = ("joint", "name", "spring_s") if kind == "sdf" else ("gazebo", "reference", "springS")
            head = rf"(?s)<{tag}\s[^>]*{field}\s*=\s*[\"']{re.escape(joint)}[\"']{within}"
            spot = re.search(rf"{head}(?:(?!</{tag}>).)*?<{spring}tiffness>([^<]*)".encode(), text)
            edits += [(*spot.span(1), repr(k))] if spot else []
    else:
        tags = [
            tag
            for tag in re.finditer(rb"(?s)<(?:free)?joint\b(?:[^>\"']|\"[^\"]*\"|'[^']*')*", text)
            if text.rfind(b"<worldbody", 0, tag.start()) > text.rfind(b"</worldbody", 0, tag.start())
        ]
        compiled = {move.joint: move.stiffness for one in solids for move in one.moves}
        bodies = [[one.tag for one in body] for body in ElementTree.fromstring(data).iter("body")]
        behind = any("joint" in names[names.index("body") :] for names in bodies if "body" in names)
        alike = len(tags) == len(compiled) and not behind and b"springdamper" not in text  # it overrides stiffness
        for found, (joint, present) in zip(tags, compiled.items(), strict=False):
            each = (rb"\s" + word + rb"\s*=\s*[\"']\s*([^\"'\s]*)" for word in (b"name", b"stiffness"))
            named, own = (re.search(one, found[0]) for one in each)
            alike &= not named or named[1].decode() == joint
            alike &= not own or abs(float(own[1]) - present) <= 1e-9 * abs(present)
            place = (found.start() + own.start(1), found.start() + own.end(1)) if own else (found.start() + 6,) * 2
            if joint in new:
                edits.append((*place, repr(new[joint]) if own else f' stiffness="{new[joint]!r}"'))
        if not alike:
            raise InputError(f"{path.name}: its joints are not in its text in order, write it by mj_saveLastXML first")
    if step:
        attribute = rb"<option\b[^>]*?\stimestep\s*=\s*[\"']([^\"']*)"
        spots = list(re.finditer(rb"<max_step_size>([^<]*)" if kind == "sdf" else attribute, text))
        edits += [(*spot.span(1), repr(step)) for spot in spots]
        if not spots and (begun := re.search(rb"<mujoco\b[^>]*>", text)):
            edits.append((begun.end(), begun.end(), f'\n<option timestep="{step!r}"/>'))
    for start, end, word in sorted(edits, reverse=True):
        data = data[:start] + word.encode() + data[end:]
    with whole(out, "corrected") as part:
        part.write_bytes(data)
    what = ["other stiffnesses"] * bool(new) + [f"the time step {with_unit(step, 's')}"] * bool(step)
    return f"wrote {shown(str(out))}: " + (f"{' and '.join(what)}, nothing else" if what else "nothing is to change")
