"""A chain of rigid links from a file of an engine against the exact beam it means: faults, errors, corrections.

The compliance of a joint is w times that of the half links next to it, of the whole link at a wall. The rule of a file
is the one by which all its joints have the same EI. Without a beam next to it, EI and rho A are those of the file.
"""

import re
from dataclasses import dataclass
from math import pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from xml.etree import ElementTree

import numpy as np

from verify.analysis.verdict import FINE, LIMIT, Margin, per_cent
from verify.arrays import Array
from verify.engines.description import Axis, Body, Hinge, Joint, Link, RigidChain, in_plane
from verify.engines.reading import Line, Solid, lines, read
from verify.errors import InputError, shown
from verify.exact.torsion import shafts, torsion_hz
from verify.problem.beam import Beam
from verify.problem.materials import MATERIALS
from verify.problem.point_attachments import PointMass
from verify.problem.supports import FIXED
from verify.segments.walls import WALLS, wall_factors

if TYPE_CHECKING:
    from verify.report.result import Result

HELD = (np.nan, 23 / 12, 7 / 12)
"""Factors w behind a first link fixed to the wall, order 3 (Press et al., Numerical Recipes, open extended formula)."""
RULES = {"gregory": "Gregory's joints", "half": "2EI/l", "full": "EI/l", "third-order": "weights 5/12, 13/12",
         "five-joint": "five-joint weights", "rigid": "first link fixed",
         "held": "first link fixed, adapted joints,"}  # fmt: skip
SPACINGS = ("", "the mean length", "the length of the link beyond", "the length of the link before")
FACTORS = {16 / (3 * pi): "a square section's for a round one, 1.3029 in frequency", 16.0: "diameter for radius",
           3 * pi / 16: "a round section's for a square one", 1 / 16: "radius for diameter"}  # fmt: skip
ALIKE, SAME = 2e-3, 1e-9
"""Relative differences up to which joints have the same EI by a rule, and a stiffness stays as it is."""


@dataclass(frozen=True, eq=False)
class Plane(RigidChain):
    """A chain about one axis, with armatures of its hinges, kg m^2, and its exact beam or shaft."""

    axis: Axis = "bending"
    armatures: tuple[float, ...] = ()
    shaft: Any = None
    theory: Any = "euler-bernoulli"

    def matrices(self, axis: Axis = "bending") -> tuple[Array, Array]:
        """(mass with armatures, stiffness) as in `RigidChain`."""
        mass, stiffness = super().matrices(axis)
        return mass + np.diag(self.armatures), stiffness

    def exact_hz(self, axis: Axis = "bending", n_modes: int = 3) -> Array:
        """Frequencies of the exact beam or shaft, (n_modes,), Hz."""
        from verify.analytic_modes import ExactModel

        if axis == "torsion":
            bodies = [(one.position, one.rotary_inertia) for one in self.beam.mass]
            return torsion_hz(self.shaft, (self.supported[0], False), n_modes, bodies)
        exact = ExactModel(self.beam, self.theory)
        return np.array([exact.frequency_hz(mode) for mode in range(1, n_modes + 1)])


class Judged(NamedTuple):
    """A chain as it is, with correct joints, and with correct links and a hinge at the wall as well.

    `stiffness`: EI or GJ, N m^2. `springs`: correct ones, N m/rad. `faults`: text, and the chain without the fault.
    """

    line: Line
    present: Plane
    correct: Plane
    best: Plane
    rule: str
    stiffness: float
    springs: Array
    faults: list[tuple[str, Plane]]
    advice: str


def judge(line: Line, beam: Beam | None = None, theory: str = "euler-bernoulli") -> Judged:
    """The rules of a chain and what is wrong with it. `beam`: the one it means, in the plane of the line."""
    (lengths, masses, _, inertias), k, bends = line.links.T, line.springs, line.axis != "torsion"
    n, edges, held, wall = len(k), np.append(0.0, np.cumsum(lengths)), bool(np.isnan(k[0])), bool(k[0] > 0.0)
    support: Any = "clamped" if held or wall else "pinned" if bends else "free"
    scale, expected, bodies = np.ones(n), np.median(masses / lengths) * lengths, line.bodies
    if beam is not None:
        if bends and beam.supports != (support, "free"):
            raise InputError(f"the beam is {'-'.join(beam.supports)}, the chain {support}-free, give one like it")
        at = np.searchsorted(np.cumsum([one.length for one in beam.pieces])[:-1], 0.5 * (edges[1:] + edges[:-1]))
        shaft = np.empty((0, 3)) if bends else shafts(beam)
        values = (np.array([one.bending_stiffness for one in beam.pieces]) if bends else shaft[:, 1])[at]
        scale, expected = values / values[0], np.array([one.mass_per_length for one in beam.pieces])[at] * lengths
        points = [(int(np.searchsorted(edges[1:-1], one.position)), one) for one in beam.mass]
        bodies = [(i, one.position - edges[i], one.mass, one.rotary_inertia) for i, one in points]
    else:
        bodies = [*bodies, *_bodies_in_links(line, expected)]
    soft = lengths / scale
    bases = [0.5 * (np.append(soft[0], soft[:-1]) + soft)]
    if np.ptp(lengths) > 1e-4 * lengths.mean():
        bases += [np.full(n, lengths.mean()), lengths, np.append(lengths[0], lengths[:-1])]
    rule, spacing, stiffness, text = _rule(k, bases, support, bends)
    factor, named = _square(line, stiffness, expected) if beam is None and bends else (1.0, "")
    reference = stiffness / factor if beam is None else float(values[0])
    ratio, even = stiffness / reference, bends and np.ptp(soft[:3]) < 1e-4 * soft[0]
    hinged = reference / bases[0] / wall_factors((support, "free"), n, "gregory" if even else "half")[:-1]
    behind = np.append(HELD if even and n > len(HELD) else [np.nan, 1.5], np.ones(n))[:n]
    springs = reference / bases[0] / behind if held else hinged
    if beam is None:
        spin = float(np.median(inertias / (masses * lengths**2)) - 1 / 12) * expected[0] * lengths[0]
        spots = [(float(min(edges[i] + x, edges[-1])), m, own) for i, x, m, own in bodies]
        beam = Beam(
            length=float(edges[-1]), supports=(support, "free"), bending_stiffness=reference,
            mass_per_length=float(expected[0] / lengths[0]), rotary_inertia=spin if spin > 0.0 else None,
            mass=tuple(PointMass(position=x, mass=m, rotary_inertia=own) for x, m, own in spots if x > SAME),
        )  # fmt: skip
        shaft = np.array([[beam.length, reference, np.median(inertias / lengths)]])

    def chain(springs: Array, links: Array = line.links, bodies: Any = line.bodies, armature: bool = True) -> Plane:
        kind: Axis = "bending" if bends else "torsion"
        hinges = [() if np.isnan(one) else (Hinge(kind, float(one)),) for one in [*springs, 0.0]]
        rows = zip(edges.tolist(), links.tolist(), strict=False)
        return Plane(
            beam=beam, wall=rule, axis=kind, shaft=shaft, theory=theory,
            joints=tuple(map(Joint, edges.tolist(), hinges)),
            links=tuple(Link(x, length, mass, centre, (own,) * 3) for x, (length, mass, centre, own) in rows),
            bodies=tuple(Body(float(edges[i] + x), i, m, own) for i, x, m, own in bodies),
            armatures=tuple(armature * line.armatures[~np.isnan(springs)]),
        )  # fmt: skip

    own = expected * lengths**2 / 12.0 if bends and not line.solid else inertias
    rods = np.stack([lengths, expected, 0.5 * lengths, own], axis=1)
    faults, best = list[tuple[str, Plane]](), chain(hinged, rods, bodies, False)
    fixed = np.where(np.arange(n) < 5, ratio * springs * bases[0] / bases[spacing], k)
    if held or (wall and max(abs(fixed / k - 1.0)) > ALIKE):
        faults.append((text, chain(ratio * hinged if held else fixed)))
    if spacing:
        faults.append((f"stiffness from {SPACINGS[spacing]} in place of two half links in series",
                       chain(k * bases[spacing] / bases[0])))  # fmt: skip
    if abs(ratio - 1.0) > ALIKE:
        named = named or next((f": {what}" for one, what in FACTORS.items() if abs(ratio / one - 1.0) < 0.01), "")
        faults.append((f"stiffness {ratio:.5g} times that of the beam{named}", chain(k / ratio)))
    if bends and (wrong := _inertia_faults(line, expected, bodies)):
        faults.append((wrong, chain(k, rods, bodies, False)))
    advice = _advice(line.axis, hinged, best) if held else ""
    return Judged(line, chain(k), chain(springs), best, text, stiffness, springs, faults, advice)


def _advice(axis: str, springs: Array, best: Plane) -> str:
    """What a hinge at the wall in a first link without one leaves."""
    first, errors = springs[:3], 100.0 * best.errors(best.axis, min(3, len(springs)))
    words = f"{axis}: a hinge at the wall and {', '.join(f'{one:.6g}' for one in first)} N m/rad from it on leave "
    return words + ", ".join(f"{error:+.2g} %" for error in errors)


def _rule(k: Array, bases: list[Array], support: str, bends: bool) -> tuple[str, int, float, str]:
    """(rule at the wall, spacing, EI, text): the first ones by which all joints have the same EI, else the nearest."""
    held = bool(np.isnan(k[0]))
    names = [name for name in WALLS if name != "welded" and (bends or name in ("half", "full"))]
    names = ["rigid", "held"] if held else names if support == "clamped" else ["full"]
    rows = [HELD if name == "held" else 1.0 + np.array(WALLS.get(name, ())) for name in names]
    fits = [(k * base * np.append(row, np.ones(len(k)))[: len(k)])[k > 0.0] for base in bases for row in rows]
    spreads = [round(float(fit.std() / fit.mean()), 6) for fit in fits]
    best = int(np.argmin(spreads))
    rule, spacing, stiffness = names[best % len(names)], best // len(names), float(np.median(fits[best]))
    text = RULES[rule]
    if spreads[best] > ALIKE:
        inner = [(k * base)[1:] for base in bases]
        spacing = int(np.argmin([round(float(one.std() / one.mean()), 6) for one in inner]))
        stiffness, text = float(np.median(inner[spacing])), "irregular joints"
        if inner[spacing].std() < ALIKE * stiffness:
            text = f"{k[0] * bases[spacing][0] / stiffness:.4g} EI/l"
    text = f"{text} at the wall" if support == "clamped" else f"{support} end"
    return rule, spacing, stiffness, text if bends else text.replace("EI", "GJ")


def _square(line: Line, stiffness: float, expected: Array) -> tuple[float, str]:
    """(factor, its name) by which EI of a drawn section exceeds that of the material with its density."""
    shape, width, depth = line.section or ("", 1.0, 1.0)
    area, second = width * depth, width * depth**3 / 12.0
    if shape == "round":
        area, second = pi * depth**2 / 4.0, pi * depth**4 / 64.0
    values = np.array([expected[0] / line.links[0, 0] / area, stiffness / second])
    for one in MATERIALS.values() if shape else ():
        for factor, what in FACTORS.items():
            if np.allclose(values, [one.density, factor * one.youngs_modulus], rtol=0.015):
                return factor, f": {what}"
    return 1.0, ""


def _bodies_in_links(line: Line, expected: Array) -> list[tuple[int, float, float, float]]:
    """Bodies (link, position from its joint, mass, inertia) in few links heavier than `expected`, kg."""
    lengths, masses, centres, inertias = line.links.T
    heavy, more, middle = np.flatnonzero(masses > 1.01 * expected), masses - expected, 0.5 * lengths
    x = (masses * centres - expected * middle) / np.where(more, more, 1.0)
    own = expected * (lengths**2 / 12.0 + (middle - centres) ** 2) + more * (x - centres) ** 2
    rest = np.maximum(inertias - own, 0.0)
    few = heavy.size <= max(1, len(masses) // 4)
    return [(int(i), float(x[i]), float(more[i]), float(rest[i])) for i in heavy if few]


def _inertia_faults(line: Line, expected: Array, bodies: list[Any]) -> str:
    """What is wrong with the masses, centres and inertias of the links."""
    lengths, masses, centres, inertias = line.links.T
    plain = np.array([all(i != j for i, *_ in bodies) for j in range(len(masses))]) | (len(bodies) >= len(masses))
    q = float(np.median((inertias / (masses * lengths**2))[plain]))
    wrong = list[str]()
    if not (0.98 / 12 < q < 1.02 / 12 or line.solid):
        words = "point masses" if q < 1e-3 else f"inertia {q:.3g} m l^2"
        wrong.append(words + " about the joint" * (abs(q - 1 / 3) < 0.01) + " in place of m l^2/12")
    if (off := plain & (abs(centres / lengths - 0.5) > 0.01)).any():
        wrong.append(f"centre of mass at {centres[off][0] / lengths[off][0]:.3g} l in place of l/2")
    if (change := plain * abs(masses / expected - 1.0)).max() > 0.01:
        i = int(change.argmax())
        wrong.append(f"mass of link {i} {masses[i] / expected[i]:.4g} times rho A l")
    if line.armatures.any():
        wrong.append(f"armature of {line.armatures.max() / np.median(expected * lengths**2 / 12):.3g} m l^2/12")
    return ", ".join(wrong)


def _in_its_plane(line: Line, beam: Beam, name: str) -> Beam:
    """The beam from the wall of a line on, turned to the plane whose EI is nearer. Raises InputError."""
    beam.check_features("the comparison of a file", ("section", "mass"))
    beam = beam.mirrored() if sum(FIXED[beam.supports[0]]) < sum(FIXED[beam.supports[1]]) else beam
    if abs((length := float(line.links[:, 0].sum())) / beam.length - 1.0) > 0.01:
        raise InputError(f"{name}: its chain is {length:.6g} m long, the beam {beam.length:.6g} m")
    planes, stiffness = [in_plane(beam, axis) for axis in ("bending", "width")], judge(line).stiffness
    nearest = int(np.argmin([abs(np.log(stiffness / one.bending_stiffness)) for one in planes]))
    return beam if line.axis == "torsion" else planes[nearest]


def judge_file(
    path: Path, beam: Beam | None, modes: int = 5, within: float | None = None, theory: str = "euler-bernoulli",
    corrected: Path | None = None,
) -> "Result":  # fmt: skip
    """The result of the chain in a file, acceptance in `data["passed"]`: all errors are `within`, by default 1 %.

    `corrected`: file to write, with correct stiffnesses. Raises InputError for a file that is not such a chain.
    """
    from verify.report.result import Column, Result, Table

    (kind, solids), judged = read(path), list[Judged]()
    for line in lines(solids, path.name):
        judged.append(judge(line, beam and _in_its_plane(line, beam, path.name), theory))
    rows, faults, joints, margins, data = list[Any](), list[Any](), list[Any](), list[Margin](), list[Any]()
    limits: dict[str, Any] = {"fine": within or FINE, "limit": within or LIMIT}
    for one in judged:
        kind_, n, axis = one.present.axis, len(one.springs), one.line.axis
        m = min(modes, len(one.present.frequencies_hz(kind_)))
        hertz, exact = one.present.frequencies_hz(kind_, m), one.present.exact_hz(kind_, m)
        errors, after = hertz / exact - 1.0, one.correct.frequencies_hz(kind_, m) / exact - 1.0
        rows += zip([axis] * m, range(1, m + 1), exact, hertz, errors, after, strict=True)
        for text, without in one.faults:
            effects = hertz / without.frequencies_hz(kind_, m) - 1.0
            worst = int(abs(effects).argmax())
            size, where = float(abs(effects[worst])), f"at mode {worst + 1} in {axis}"
            faults.append((axis, text, effects[0], effects[-1]))
            remedy = "add a hinge at the wall" if one.advice and text == one.rule else "set the joints below"
            remedy = "give the links m l^2/12 about l/2, no armature" if without.links != one.present.links else remedy
            margins.append(Margin(name=text, size=size, where=where, condition=f"{text} is acceptable", remedy=remedy,
                                  failure=f"{text}: {per_cent(size)} {where}", **limits))  # fmt: skip
        least, what = float(abs(one.best.errors(kind_, m)[-1])), f"{n} links"
        what += " with the inertia of their sections" * (one.line.solid and theory == "euler-bernoulli")
        margins.append(Margin(name=f"discretisation by {what}", size=least, remedy="give more links",
                              where=f"at mode {m} in {axis}", condition=f"{what} are enough", **limits))  # fmt: skip
        pairs = [[None if np.isnan(k) else float(k) for k in each] for each in (one.line.springs, one.springs)]
        changes = [new / old - 1.0 if old and new else None for old, new in zip(*pairs, strict=True)]
        changes = [change if change and abs(change) > SAME else None for change in changes]
        joints += zip(map(str, range(n)), one.line.joints, [axis] * n, *pairs, changes, strict=True)
        own, faulty = one.present.beam, [text for text, _ in one.faults]
        about: dict[str, Any] = {"axis": axis, "links": n, "rule": one.rule, "faults": faulty, "length": own.length}
        about |= {"stiffness": one.stiffness, "mass_per_length": own.mass_per_length, "supports": own.supports}
        data.append(about | {"frequencies_hz": hertz, "exact_hz": exact, "error": errors, "corrected_error": after})
    warnings = [one.advice for one in judged if one.advice]
    warnings += [_write(path, kind, solids, judged, corrected)] if corrected else []
    error = [Column(name, format="+.3g", percent=True) for name in ("error", "corrected", "mode 1", "last", "change")]
    named, hz = [Column("axis"), Column("mode")], [Column(name, "Hz", ".7g") for name in ("exact", "file")]
    springs = [Column(name, "N m/rad", ".6g") for name in ("present", "correct")]
    tables = [Table("Frequencies", [*named, *hz, *error[:2]], rows)]
    if faults:
        tables += [Table("Faults, each alone, in frequency", [named[0], Column("fault"), *error[2:4]], faults)]
    tables += [Table("Joints", [*map(Column, ("joint", "name", "axis")), *springs, error[4]], joints)]
    names = {"torsion": "GJ"}
    rules = [f"{j.line.axis}: {j.rule}, {names.get(j.line.axis, 'EI')} = {j.stiffness:.6g} N m2" for j in judged]
    sizes = f"{data[0]['links']} rigid links, {data[0]['length']:.6g} m, {data[0]['mass_per_length']:.6g} kg/m"
    summary = f"{sizes}; {'; '.join(rules)}."
    passed = max(float(abs(one["error"]).max()) for one in data) <= limits["fine"]
    return Result(summary, tables, warnings=warnings, margins=margins, data={"passed": passed, "chains": data})


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
        tags = [tag for tag in re.finditer(rb"(?s)<(?:free)?joint\b(?:[^>\"']|\"[^\"]*\"|'[^']*')*", text)
                if text.rfind(b"<worldbody", 0, tag.start()) > text.rfind(b"</worldbody", 0, tag.start())]  # fmt: skip
        compiled = {move.joint: move.stiffness for one in solids for move in one.moves}
        bodies = [[one.tag for one in body] for body in ElementTree.fromstring(data).iter("body")]
        behind = any("joint" in names[names.index("body") :] for names in bodies if "body" in names)
        alike = len(tags) == len(compiled) and not behind
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
