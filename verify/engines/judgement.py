"""A chain of rigid links from a file of an engine against the exact beam it means: faults, errors, corrections.

The compliance of a joint is w times that of the half links next to it, of the whole link at a wall. The rule of a file
is the one by which all its joints have the same EI. Without a beam next to it, EI and rho A are those of the file.
"""

import re
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from verify.analysis.verdict import FINE, Margin, per_cent
from verify.arrays import Array
from verify.engines.description import Hinge, Joint, Link, RigidChain
from verify.engines.reading import Line, Solid, lines, read
from verify.errors import InputError, shown
from verify.problem.beam import Beam, check_features, in_plane
from verify.problem.point_attachments import PointMass
from verify.problem.supports import FIXED
from verify.segments.walls import wall_factors
from verify.settings import WALLS, wall_label

if TYPE_CHECKING:
    from verify.report.result import Result

HELD = (np.nan, 23 / 12, 7 / 12)
"""Factors w behind a first link fixed to the wall, order 3 (Press et al., Numerical Recipes, open extended formula)."""
ADAPTED = "first link fixed, adapted joints, at the wall"
SERIES = "fixed link in series with its joint at the wall"
"""All of a first link that is fixed is in its joint, as with half a link at the wall and EI/l behind: order 2."""
IRREGULAR = "irregular joints at the wall"
SPACINGS = ("", "the mean length", "the length of the link beyond", "the length of the link before")
SQUARE = 16 / (3 * pi)
"""Second moment of area of a square over that of the circle in it."""
ALIKE, SAME = 2e-3, 1e-9
"""Relative differences up to which joints have the same EI by a rule, and a stiffness stays as it is."""


class Judged(NamedTuple):
    """A chain as it is and with correct joints, whose axis is "bending" in either plane.

    `stiffness`: EI, N m^2. `springs`: correct ones, N m/rad. `faults`: of joints and links; `links`: those of links.
    `advice`: a better wall than a fixed link, or ''.
    """

    line: Line
    present: RigidChain
    correct: RigidChain
    rule: str
    stiffness: float
    springs: Array
    faults: list[str]
    links: list[str]
    advice: str


def judge(line: Line, beam: Beam | None = None, theory: Any = "euler-bernoulli") -> Judged:
    """The rules of a chain and what is wrong with it. `beam`: the one it means, in the plane of the line."""
    (lengths, masses, *_), k = line.links.T, line.springs
    n, edges, held = len(k), np.append(0.0, np.cumsum(lengths)), bool(np.isnan(k[0]))
    support: Any = "clamped" if held or k[0] > 0.0 else "pinned"
    scale, expected = np.ones(n), np.median(masses / lengths) * lengths
    if beam is not None:
        if beam.supports != (support, "free"):
            raise InputError(f"the beam is {'-'.join(beam.supports)}, the chain {support}-free, give one like it")
        at = np.searchsorted(np.cumsum([one.length for one in beam.pieces])[:-1], 0.5 * (edges[1:] + edges[:-1]))
        values = np.array([one.bending_stiffness for one in beam.pieces])[at]
        scale, expected = values / values[0], np.array([one.mass_per_length for one in beam.pieces])[at] * lengths
    soft = lengths / scale
    bases = [0.5 * (np.append(soft[0], soft[:-1]) + soft)]
    if np.ptp(lengths) > 1e-4 * lengths.mean():
        bases += [np.full(n, lengths.mean()), lengths, np.append(lengths[0], lengths[:-1])]
    weld = np.ones(n)
    weld[1] = 1.0 + soft[0] / (soft[0] + soft[1])
    if soft[-1] < 0.75 * soft[-2]:  # half a link at the end too, where the moment is small
        weld[-1] = 1.0 + soft[-1] / (soft[-2] + soft[-1])
    rule, spacing, stiffness = _rule(k, bases, support, weld)
    if beam is None and rule == IRREGULAR and np.sum(abs(masses - expected) > 0.01 * expected) > max(1, n // 4):
        raise InputError("masses and stiffnesses of the links vary: give the tapered or stepped beam as a scene")
    reference = stiffness if beam is None else float(values[0])
    even = np.ptp(soft[:3]) < 1e-4 * soft[0]
    best = "gregory" if even else "half"
    hinged = reference / bases[0] / wall_factors((support, "free"), n, best)[:-1]
    behind = np.append(HELD, np.ones(n))[:n] if even and n > len(HELD) else np.append(np.nan, weld[1:])
    springs = reference / bases[0] / behind if held else hinged
    beam = beam or _meant(line, expected, support, reference)
    bodies = sum(attachment.mass for attachment in beam.attached)

    def chain(springs: Array) -> RigidChain:
        hinges = [() if np.isnan(one) else (Hinge("bending", float(one)),) for one in [*springs, 0.0]]
        rows = zip(edges.tolist(), line.links.tolist(), strict=False)
        links = tuple(Link(x, length, mass, centre, (own,) * 3) for x, (length, mass, centre, own) in rows)
        joints = tuple(map(Joint, edges.tolist(), hinges))
        return RigidChain(beam, rule, joints, links, theory=theory)

    right = wall_label(best), *([] if even else [SERIES])
    wall = [rule] if rule not in right and support == "clamped" else []
    joints, links = _faults(line, expected, bodies, spacing, stiffness / reference)
    first = ", ".join(f"{one:.6g}" for one in hinged[:3])
    advice = f"{line.axis}: better than a fixed link is a hinge at the wall, with {first} N m/rad from it on"
    text = rule if support == "clamped" else f"{support} end"
    faults, advice = wall + joints + links, advice * (held and bool(wall))
    return Judged(line, chain(k), chain(springs), text, stiffness, springs, faults, links, advice)


def _faults(line: Line, expected: Array, bodies: float, spacing: int, ratio: float) -> tuple[list[str], list[str]]:
    """What is wrong with joints but for the wall, EI `ratio` times that of the beam, and with links.

    `expected`: masses of the links without the `bodies` of the beam, kg.
    """
    (lengths, masses, centres, inertias), joints, found = line.links.T, list[str](), list[str]()
    if spacing:
        joints.append(f"stiffness from {SPACINGS[spacing]} in place of two half links in series")
    if abs(ratio - 1.0) > ALIKE:
        words = ": a square section's for a round one, 1.3029 in frequency" * (abs(ratio / SQUARE - 1.0) < 0.01)
        joints.append(f"stiffness {ratio:.5g} times that of the beam{words}")
    ratios = inertias / (masses * lengths**2), centres / lengths, masses / expected
    inertia, centre, mass = (float(np.median(one)) for one in ratios)
    if not (0.98 / 12 < inertia < 1.02 / 12 or line.solid):
        words = "point masses" if inertia < 1e-3 else f"inertia {inertia:.3g} m l^2"
        found.append(words + " about the joint" * (abs(inertia - 1 / 3) < 0.01) + " in place of m l^2/12")
    if abs(centre - 0.5) > 0.01:
        found.append(f"centre of mass at {centre:.3g} l in place of l/2")
    if abs(mass - 1.0) > 0.01:
        found.append(f"mass {mass:.4g} times that of the beam")
    elif abs(more := masses.sum() - expected.sum() - bodies) > 0.01 * (expected.sum() + bodies):
        found.append(f"bodies {abs(more):.4g} kg {'heavier' if more > 0.0 else 'lighter'} than those of the beam")
    return joints, found


def _meant(line: Line, expected: Array, support: Any, stiffness: float) -> Beam:
    """The beam of a file: bodies on the few links heavier than `expected`, kg, whose inertia the links leave."""
    lengths, masses, centres, inertias = line.links.T
    ends, middle, more, heavy = np.cumsum(lengths), 0.5 * lengths, masses - expected, masses > 1.01 * expected
    heavy &= heavy.sum() <= max(1, len(masses) // 4)
    x = (masses * centres - expected * middle) / np.where(heavy, more, 1.0)
    own = inertias - expected * (lengths**2 / 12.0 + (middle - centres) ** 2) - more * (x - centres) ** 2
    spots = np.stack([np.minimum(ends - lengths + x, ends[-1]), more, np.maximum(own, 0.0)], axis=1)[heavy].tolist()
    spin = float(np.median(inertias / (masses * lengths**2)) - 1 / 12) * expected[0] * lengths[0]
    return Beam(
        length=float(ends[-1]),
        supports=(support, "free"),
        bending_stiffness=stiffness,
        mass_per_length=float(expected[0] / lengths[0]),
        rotary_inertia=spin if spin > 0.0 else None,
        mass=tuple(PointMass(position=x, mass=m, rotary_inertia=own) for x, m, own in spots if x > SAME),
    )


def _rule(k: Array, bases: list[Array], support: str, weld: Array) -> tuple[str, int, float]:
    """(rule in words, spacing, EI): the first ones by which all joints have the same EI; `weld`: that of SERIES."""
    held = bool(np.isnan(k[0]))
    names = ["rigid", ADAPTED, SERIES] if held else ["full"]
    if support == "clamped" and not held:
        names = [name for name, rule in WALLS.items() if not rule.first and rule.weights[0]]
    others: Any = {ADAPTED: HELD, SERIES: weld}
    rows = [np.array(others[name] if name in others else WALLS[name].weights) for name in names]
    fits = [(k * base * np.append(row, np.ones(len(k)))[: len(k)])[k > 0.0] for base in bases for row in rows]
    spreads = [round(float(fit.std() / fit.mean()), 6) for fit in fits]
    best = int(np.argmin(spreads))
    name, spacing, stiffness = names[best % len(names)], best // len(names), float(np.median(fits[best]))
    text = wall_label(name) if name in WALLS else name
    if spreads[best] > ALIKE:
        inner = (k * bases[0])[1:]
        spacing, stiffness, text = 0, float(np.median(inner)), IRREGULAR
        if inner.std() < ALIKE * stiffness:
            text = f"{k[0] * bases[0][0] / stiffness:.4g} EI/l at the wall"
    return text, spacing, stiffness


def _in_its_plane(line: Line, beam: Beam, name: str) -> Beam:
    """The beam from the wall of a line on, turned to the plane whose EI is nearer. Raises InputError."""
    check_features(beam, "the comparison of a file", ("section", "bodies"))
    beam = beam.mirrored() if sum(FIXED[beam.supports[0]]) < sum(FIXED[beam.supports[1]]) else beam
    if abs((length := float(line.links[:, 0].sum())) / beam.length - 1.0) > 0.01:
        remedy = ": a first link without a joint must be a body" * (length < beam.length)
        raise InputError(f"{name}: its chain is {length:.6g} m long, the beam {beam.length:.6g} m{remedy}")
    planes, steps = [in_plane(beam, axis) for axis in ("bending", "width")], line.links[:, 0]
    stiffness = float(np.median(0.5 * (steps[1:] + steps[:-1]) * line.springs[1:]))
    return min(planes, key=lambda one: abs(np.log(stiffness / one.bending_stiffness)))


def judge_file(
    path: Path,
    beam: Beam | None,
    modes: int = 5,
    within: float = FINE,
    theory: str | None = None,
    corrected: Path | None = None,
) -> "Result":
    """The result of the chain in a file, acceptance in `data["passed"]`: all errors are `within`.

    `theory`: by default "euler-bernoulli" in a plane, "rayleigh" in space where links have the rotary inertia of their
    drawn sections. `corrected`: file to write, with correct stiffnesses. Raises InputError for another file.
    """
    from verify.report.result import Column, Result, Table

    if corrected and corrected.suffix.lower() != path.suffix.lower():
        raise InputError(f"corrected = {shown(str(corrected))}: the format stays, end the name with {path.suffix}")
    (kind, solids, gravity), judged = read(path), list[Judged]()
    found = lines(solids, path.name)
    in_space = len(found) > 1 and all(line.solid for line in found)
    theory = theory or ("rayleigh" if in_space else "euler-bernoulli")
    for line in found:
        judged.append(judge(line, beam and _in_its_plane(line, beam, path.name), theory))
    error = [Column(name, format="+.3g", percent=True) for name in ("error", "corrected", "change")]
    hz = [Column(name, "Hz", ".7g") for name in ("exact", "file")]
    springs = [Column(name, "N m/rad", ".6g") for name in ("present", "correct")]
    rows, margins, data = list[Any](), list[Margin](), list[Any]()
    tables = [Table("Frequencies", [Column("axis"), Column("mode"), *hz, *error[:2]], rows)]
    limits, warnings = dict[str, Any](fine=within, limit=within), list[str]()
    for one in judged:
        n, axis, hertz = len(one.springs), one.line.axis, one.present.frequencies_hz(n_modes=modes)
        m, exact = len(hertz), one.present.exact_hz(n_modes=len(hertz))
        errors, after = hertz / exact - 1.0, one.correct.frequencies_hz(n_modes=m) / exact - 1.0
        warnings += [one.advice] if one.advice else []
        rows += zip([axis] * m, range(1, m + 1), exact, hertz, errors, after, strict=True)
        pairs = [[None if np.isnan(k) else float(k) for k in each] for each in (one.line.springs, one.springs)]
        changes = [new / old - 1.0 if old and new else None for old, new in zip(*pairs, strict=True)]
        changes = [change if change and abs(change) > SAME else None for change in changes]
        each = list(zip(range(n), one.line.joints, *pairs, changes, strict=True))
        tables.append(Table(f"Joints in {axis}", [Column("joint"), Column("name"), *springs, error[2]], each))
        text, worst, what = "; ".join(one.faults), int(abs(errors).argmax()), f"{n} links with correct joints"
        mass = "give the links the mass of the beam, m l^2/12 about l/2"
        size, where = float(abs(errors[worst])), f"at mode {worst + 1} in {axis}"
        remedy = "set the joints below" if any(changes) else mass
        if text:
            failure = f"{text}: {per_cent(size)} {where}"
            margins.append(Margin(name=text, size=size, where=where, remedy=remedy, failure=failure, **limits))
        if any(changes) and abs(after[0]) > max(abs(errors[0]), within):
            warnings.append(f"{axis}: errors of the file cancel at mode 1, give links of one length and these joints")
        if any(changes) or not text:
            size, where = float(abs(after[-1])), f"at mode {m} in {axis}"
            what, remedy = (f"{what}, but {'; '.join(one.links)}", mass) if one.links else (what, "give more links")
            margins.append(Margin(name=what, size=size, where=where, remedy=remedy, **limits))
        own = one.present.beam
        about: dict[str, Any] = {"axis": axis, "links": n, "rule": one.rule, "faults": one.faults, "length": own.length}
        about |= {"stiffness": one.stiffness, "mass_per_length": own.mass_per_length, "supports": own.supports}
        data.append(about | {"frequencies_hz": hertz, "exact_hz": exact, "error": errors, "corrected_error": after})
    warnings += _hints(solids, gravity, judged, beam)
    warnings += [_write(path, kind, solids, judged, corrected)] if corrected else []
    rules = [f"{one.line.axis}: {one.rule}, EI = {one.stiffness:.6g} N m2" for one in judged]
    sizes = f"{data[0]['links']} rigid links, {data[0]['length']:.6g} m, {data[0]['mass_per_length']:.6g} kg/m"
    summary = f"{sizes}; {'; '.join(rules)}."
    passed = max(float(abs(one["error"]).max()) for one in data) <= within
    return Result(summary, tables, warnings=warnings, margins=margins, data={"passed": passed, "chains": data})


def _hints(solids: list[Solid], gravity: Array, judged: list[Judged], beam: Beam | None) -> list[str]:
    """What the frequencies leave out: ball joints, gravity along the chain; the modulus that EI means for round links.

    Gravity counts from a tenth of EI/L^2 on, which changes the first frequency of a cantilever by about 0.6 %.
    """
    hints, own, named = list[str](), judged[0].present.beam, {name for one in judged for name in one.line.joints}
    moving = [one for one in solids if any(move.joint in named for move in one.moves)]
    if any(len({move.joint for move in one.moves}) < len(one.moves) for one in moving):
        hints.append("a ball joint is read as three hinges of one stiffness, that of bending; torsion is not judged")
    along = moving[-1].moves[0].at - moving[0].moves[0].at
    weight = own.mass_per_length * own.length * abs(float(gravity @ along)) / float(np.linalg.norm(along))
    if (ratio := weight * own.length**2 / judged[0].stiffness) > 0.1:
        hints.append(f"gravity acts along the chain, its weight is {ratio:.3g} EI/L^2: the frequencies are without it")
    radius = float(np.median([one.radius for one in moving]))
    if beam is None and radius > 0.0:
        modulus = judged[0].stiffness / (0.25 * pi * radius**4) / 1e9
        text = f"E = {modulus:.4g} GPa, or {modulus / SQUARE:.4g} GPa if it is a square section's; check by --beam"
        hints.append(f"round links of {2e3 * radius:.4g} mm: EI is that of {text}")
    return hints


def _write(path: Path, kind: str, solids: list[Solid], judged: list[Judged], out: Path) -> str:
    """The file with other stiffnesses and nothing else changed; returns a sentence. Raises InputError."""
    from verify.files import whole

    new, edits, data = dict[str, float](), list[tuple[int, int, str]](), path.read_bytes()
    for one in judged:
        for name, k, old in zip(one.line.joints, one.springs, one.line.springs, strict=True):
            if name and abs(k - old) > SAME * k:
                new.setdefault(name, float(k))  # a ball has one stiffness: that of bending
    text = re.sub(rb"(?s)<!--.*?-->", lambda comment: b" " * len(comment[0]), data)
    if kind != "mujoco":
        tag, field, spring = ("joint", "name", "spring_") if kind == "sdf" else ("gazebo", "reference", "spring")
        ahead, after = rf"(?s)<{tag}\s[^>]*{field}\s*=\s*[\"']", rf"[\"'].*?<{spring}[sS]tiffness>([^<]*)"
        for name, k in new.items():
            if spot := re.search((ahead + re.escape(name) + after).encode(), text):
                edits.append((*spot.span(1), repr(k)))
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
            named, own = (
                re.search(rb"\s" + word + rb"\s*=\s*[\"']\s*([^\"'\s]*)", found[0]) for word in (b"name", b"stiffness")
            )
            alike &= not named or named[1].decode() == joint
            alike &= not own or abs(float(own[1]) - present) <= 1e-9 * abs(present)
            place = (found.start() + own.start(1), found.start() + own.end(1)) if own else (found.start() + 6,) * 2
            if joint in new:
                edits.append((*place, repr(new[joint]) if own else f' stiffness="{new[joint]!r}"'))
        if not alike:
            raise InputError(f"{path.name}: its joints are not in its text in order, write it by mj_saveLastXML first")
    for start, end, word in sorted(edits, reverse=True):
        data = data[:start] + word.encode() + data[end:]
    with whole(out, "corrected") as part:
        part.write_bytes(data)
    return f"wrote {shown(str(out))}: other stiffnesses, nothing else"
