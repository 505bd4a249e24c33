"""A chain of rigid links from a file of an engine against the exact beam it means: faults, their errors, corrections.

Compliances of the joints are w times the half links next to them in series, over EI. w of the joints at the wall is the
rule; a rule that makes EI of all joints equal is that of the file. Without a beam, EI and rho A are those of the file.
"""

import json
import re
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from typing import Any, NamedTuple
from xml.parsers import expat

import msgspec
import numpy as np

from verify.arrays import Array
from verify.engines.description import Axis, Body, Hinge, Joint, Link, RigidChain, in_plane
from verify.engines.reading import Line, lines, read
from verify.errors import InputError, shown
from verify.exact.torsion import Shaft, shafts, torsion_hz
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointMass
from verify.problem.supports import FIXED
from verify.segments.walls import WALLS, wall_factors

HELD = (0.0, 1.0 + 239 / 240, 1.0 - 67 / 240, 1.0 - 41 / 80, 1.0 + 71 / 240)
"""w behind a first link fixed to the wall: the least corrections of 1 with the sums 1/2, 1/12 and 0 over j^0, j, j^2."""
RULES = {
    "gregory": "Gregory's joints at the wall",
    "half": "2EI/l at the wall",
    "full": "EI/l at the wall",
    "third-order": "weights 5/12, 13/12 at the wall",
    "five-joint": "five-joint weights at the wall",
    "rigid": "first link held by the wall",
    "held": "first link held by the wall, joints behind it corrected",
}
SPACINGS = ("half links in series", "stiffness from the mean length", "stiffness from the link beyond the joint",
            "stiffness from the link before the joint")  # fmt: skip
ALIKE = 2e-3
"""Largest relative spread of EI over the joints by one rule."""
FACTORS = {
    16 / (3 * pi): "the square section's stiffness for a round one, sqrt = 1.3029 in frequency",
    3 * pi / 16: "the round section's stiffness for a square one",
    16.0: "the diameter for the radius",
    1 / 16: "the radius for the diameter",
}


@dataclass(frozen=True, eq=False)
class Plane(RigidChain):
    """A chain about one axis, with armatures of its hinges, kg m^2, and its own exact beam or shaft."""

    axis: Axis = "bending"
    armatures: tuple[float, ...] = ()
    shaft: tuple[Shaft, ...] = ()
    theory: Any = "euler-bernoulli"

    def matrices(self, axis: Axis = "bending") -> tuple[Array, Array]:
        """(mass with armatures, stiffness) as in `RigidChain`."""
        mass, stiffness = super().matrices(axis)
        return mass + np.diag(np.append(np.zeros(len(mass) - len(self.armatures)), self.armatures)), stiffness

    def exact_hz(self, axis: Axis = "bending", n_modes: int = 3) -> Array:
        """Frequencies of the exact beam or shaft, (n_modes,), Hz."""
        from verify.analytic_modes import ExactModel

        if self.shaft:
            bodies = [(one.position, one.rotary_inertia) for one in self.beam.mass]
            return torsion_hz(self.shaft, (self.beam.supports[0] == "clamped", False), n_modes, bodies)
        exact = ExactModel(self.beam, self.theory)
        return np.array([exact.frequency_hz(mode) for mode in range(1, n_modes + 1)])


class Judged(NamedTuple):
    """What a line of a file is: its beam, its rules, EI or GJ (N m^2), faults with the chain that lacks each."""

    line: Line
    read: Plane
    correct: Plane
    rule: str
    stiffness: float
    springs: Array
    faults: list[tuple[str, Plane]]
    advice: list[str]


def judge(line: Line, beam: Beam | None = None, theory: str = "euler-bernoulli") -> Judged:
    """The rules of a chain and what is wrong with it. `beam`: that of the scene, in the plane of the line."""
    (lengths, masses, centres, inertias), k = line.links.T, line.springs
    n, bends, edges = len(k), line.axis != "torsion", np.append(0.0, np.cumsum(lengths))
    held, wall, length = bool(np.isnan(k[0])), bool(k[0] > 0.0) and not line.slides, float(edges[-1])
    support = ("guided" if k[0] else "free") if line.slides else "clamped" if held or wall else "pinned"
    support = "free" if not bends and support == "pinned" else support
    scale, extra, per_length = np.ones(n), list(line.bodies), float(np.median(masses / lengths))
    shaft: tuple[Shaft, ...] = ()
    if beam is not None:
        at = np.searchsorted(np.cumsum([piece.length for piece in beam.pieces])[:-1], 0.5 * (edges[1:] + edges[:-1]))
        shaft = () if bends else tuple(shafts(beam))
        values = np.array(
            [piece.bending_stiffness if bends else shaft[i].stiffness for i, piece in enumerate(beam.pieces)]
        )
        scale, expected = values[at] / values[at][0], np.array([p.mass_per_length for p in beam.pieces])[at] * lengths
    else:
        expected = per_length * lengths
        for i in np.flatnonzero(masses > 1.01 * expected) if sum(masses > 1.01 * expected) <= max(1, n // 4) else ():
            more = float(masses[i] - expected[i])
            x = float((masses[i] * centres[i] - 0.5 * expected[i] * lengths[i]) / more)
            own = expected[i] * (lengths[i] ** 2 / 12.0 + (0.5 * lengths[i] - centres[i]) ** 2)
            extra.append((int(i), x, more, max(float(inertias[i] - own - more * (x - centres[i]) ** 2), 0.0)))

    before = np.append(0.0, (lengths / scale)[:-1])
    first = np.arange(n) == 0
    bases = [np.where(first, lengths / scale, 0.5 * (before + lengths / scale))]
    if np.ptp(lengths) > 1e-4 * lengths.mean():
        bases += [np.full(n, lengths.mean()), lengths, np.where(first, lengths, before)]

    def weights(rule: str) -> Array:
        """w of the joints by a rule at the wall."""
        row = np.array(HELD) - 1.0 if rule == "held" else np.array(WALLS.get(rule, ()))
        w = np.ones(n)
        w[: len(row)] += row[:n]
        return w

    names = [name for name in WALLS if name != "welded" and (bends or name in ("half", "full"))]
    names = names if wall or (support == "guided" and not held) else ["rigid", "held"] if held else ["full"]
    uses = np.flatnonzero(k > 0.0)
    fits = [(k * base * weights(name))[uses] for base in bases for name in names]
    spreads = [float(fit.std() / fit.mean()) for fit in fits]
    best = int(np.argmin(np.round(spreads, 6)))
    rule, spacing, stiffness = names[best % len(names)], best // len(names), float(np.median(fits[best]))
    text, w = RULES[rule], weights(rule)
    if spreads[best] > ALIKE:
        inner = [(k * base)[uses[uses > 0]] for base in bases]
        spacing = int(np.argmin([round(float(one.std() / one.mean()), 6) for one in inner]))
        stiffness = float(np.median(inner[spacing]))
        w = np.where(first, stiffness / np.where(k > 0, k * bases[spacing], 1.0), 1.0) if wall else np.ones(n)
        text = f"{1 / w[0]:.4g} EI/l at the wall" if wall else "irregular joints"
    text = text if wall or held or support == "guided" else f"{support} end"
    text = text if bends else text.replace("EI", "GJ")

    even = np.ptp(lengths[:3] / scale[:3]) < 1e-4 * lengths[0]
    ideal = wall_factors((support, "free"), n, "gregory" if even and bends else "half")[:-1]
    close = np.array([0.0, 1.5, *[1.0] * n])[:n]
    behind = weights("held") if even and bends and n >= len(HELD) else close
    reference = stiffness if beam is None else float(values[at][0])
    with np.errstate(divide="ignore"):
        target = reference / (bases[0] * (behind if held else ideal))
        target[0] = np.nan if held else target[0]
        hinged = reference / (bases[0] * ideal)
    if beam is None:
        moments = float(np.median(inertias / lengths))
        q = float(np.median(inertias / (masses * lengths**2)))
        bodies = {(round(edges[i] + x, 12), m, inertia) for i, x, m, inertia in extra}
        points = [PointMass(position=min(max(x, 0.0), length), mass=m, rotary_inertia=i) for x, m, i in bodies]
        beam = Beam(
            length=length, supports=(support, "free"), bending_stiffness=stiffness, mass_per_length=per_length,
            mass=tuple(points), rotary_inertia=max((q - 1 / 12) * per_length * float(np.median(lengths)) ** 2, 0) or None,
        )  # fmt: skip
        shaft = () if bends else (Shaft(length, stiffness, moments),)

    def chain(springs: Array, links: Array = line.links, parts: Any = line.bodies, armature: bool = True) -> Plane:
        kind: Axis = "bending" if bends else "torsion"
        hinges = [() if np.isnan(one) else (Hinge(kind, float(one)),) for one in [*springs, 0.0]]
        armatures = [float(a) * armature for a, one in zip(line.armatures, springs, strict=True) if not np.isnan(one)]
        return Plane(
            beam=beam, wall=rule, axis=kind, armatures=tuple(armatures), shaft=shaft, theory=theory,
            joints=tuple(Joint(float(x), hinge) for x, hinge in zip(edges, hinges, strict=True)),
            links=tuple(Link(float(x), *map(float, one[:3]), (float(one[3]),) * 3) for x, one in zip(edges, links)),
            bodies=tuple(Body(float(edges[i] + x), i, m, inertia) for i, x, m, inertia in parts),
        )  # fmt: skip

    read, faults, ratio = chain(k), list[tuple[str, Plane]](), stiffness / reference
    near, advice = np.arange(n) < 5, list[str]()
    fixed = np.where(near, ratio * target, k)
    if (wall or held or support == "guided") and np.nanmax(abs(fixed / k - 1.0)) > ALIKE:
        faults.append((text, chain(fixed)))
    if spacing:
        faults.append(
            (
                f"{SPACINGS[spacing]} in place of half links in series",
                chain(k * bases[spacing] / np.where(first, bases[spacing], bases[0])),
            )
        )
    if abs(ratio - 1.0) > ALIKE:
        named = next((f": {what}" for factor, what in FACTORS.items() if abs(ratio / factor - 1.0) < 0.01), "")
        faults.append((f"stiffness {ratio:.5g} times that of the beam{named}", chain(k / ratio)))
    faults += _masses(line, expected, extra, chain, k)
    if held:
        better = chain(np.where(np.isnan(hinged), 0.0, hinged))
        errors = ", ".join(f"{error:+.2g} %" for error in 100.0 * better.errors(better.axis, min(3, n)))
        first3 = ", ".join(f"{one:.6g}" for one in hinged[:3])
        advice.append(
            f"a hinge at the wall in the first link, and {first3} N m/rad from it on, leave {errors} at modes 1 to {min(3, n)}"
        )
    return Judged(line, read, chain(target), text, stiffness, target, faults, advice)


def _masses(line: Line, expected: Array, extra: Any, chain: Any, k: Array) -> list[tuple[str, Plane]]:
    """What is wrong with the inertias of the links, with the chain whose links are uniform rods and the bodies."""
    (lengths, masses, centres, inertias), wrong = line.links.T, list[str]()
    rods, q = expected * lengths**2 / 12.0, float(np.median(inertias / (masses * lengths**2)))
    if line.axis == "torsion":
        return []
    shape, _, depth = line.sizes or ("box", 0.0, 0.0)
    section = depth**2 / (16.0 if shape == "round" else 12.0)
    largest = 1 / 12 + 2.0 * section / float(np.median(lengths)) ** 2
    if not 0.98 / 12 < q < 1.02 * largest:
        name = "point masses" if q < 1e-3 else f"inertia {q:.3g} m l^2"
        name += " about the joint" if abs(q - 1 / 3) < 0.01 else ""
        wrong.append(f"{name} in place of m l^2/12")
    if abs(r := float(np.median(centres / lengths)) - 0.5) > 0.01:
        wrong.append(f"centre of mass at {r + 0.5:.3g} l in place of l/2")
    bare = masses - np.array([sum(m for i, _, m, _ in extra if i == j) for j in range(len(masses))])
    if (off := abs((bare if extra != line.bodies else masses) / expected - 1.0)).max() > 0.01:
        wrong.append(f"mass of link {int(off.argmax())} is {masses[off.argmax()] / expected[off.argmax()]:.4g} rho A l")
    if line.armatures.any():
        wrong.append(
            f"armature {line.armatures.max():.3g} kg m2, {line.armatures.max() / np.median(rods):.3g} m l^2/12"
        )
    links = np.stack([lengths, expected, 0.5 * lengths, rods + expected * section], axis=1)
    return [("; ".join(wrong), chain(k, links, extra, False))] if wrong else []


def judge_file(path: Path, beam: Beam | None, modes: int, within: float | None, theory: str, out: Path | None) -> Any:
    """The `Result` of a file, with `data["passed"]`; `out` is the corrected file. Raises InputError."""
    from verify.analysis.verdict import FINE, LIMIT, Margin, per_cent
    from verify.report.result import Column, Result, Table

    kind, solids = read(path)
    judged = []
    for line in lines(solids, path.name):
        own = None
        if beam is not None:
            turned = beam.mirrored() if sum(FIXED[beam.supports[0]]) < sum(FIXED[beam.supports[1]]) else beam
            planes = [in_plane(turned, axis) for axis in ("bending", "width")]
            values = [judge(line).stiffness / one.bending_stiffness for one in planes]
            own = planes[int(np.argmin(abs(np.log(values))))] if line.axis != "torsion" else turned
            own.check_features("a chain of a file", ("section", "mass"))
        judged.append(judge(line, own, theory))
    faults, rows, joints, margins, warnings = list[Any](), list[Any](), list[Any](), list[Margin](), list[str]()
    data, worst = list[Any](), 0.0
    for one in judged:
        axis, n = one.line.axis, min(modes, len(one.read.frequencies_hz(one.read.axis)))
        exact, hertz = one.read.exact_hz(one.read.axis, n), one.read.frequencies_hz(one.read.axis, n)
        errors, better = hertz / exact - 1.0, one.correct.frequencies_hz(one.read.axis, n) / exact - 1.0
        rows += zip([axis] * n, range(1, n + 1), exact, hertz, errors, better, strict=True)
        springs, fine, worst = one.line.springs, within or FINE, max(worst, float(abs(errors).max()))
        for text, without in one.faults:
            effects = hertz / without.frequencies_hz(one.read.axis, n) - 1.0
            m = int(abs(effects).argmax())
            faults.append((axis, text, effects[0], effects[-1]))
            size = float(abs(effects[m]))
            margins.append(Margin(name=f"{text}, {axis},", size=size, where=f"at mode {m + 1}", fine=fine,
                                  limit=within or LIMIT, condition=f"{text} is acceptable", remedy="Correct the joints",
                                  failure=f"{text}: {per_cent(size)} at mode {m + 1} in {axis}"))  # fmt: skip
        count = len(springs)
        margins.append(Margin(name=f"discretisation of {count} links in {axis}", size=float(abs(better[-1])), fine=fine,
                              limit=within or LIMIT, where=f"at mode {n}", remedy="give more links",
                              condition=f"{count} links are enough in {axis}"))  # fmt: skip
        present, target = ([None if np.isnan(k) else float(k) for k in each] for each in (springs, one.springs))
        change = [None if k is None or not k else want / k - 1.0 for k, want in zip(present, target, strict=True)]
        names = ["/".join(own) for own in one.line.joints]
        joints += zip(map(str, range(count)), names, [axis] * count, present, target, change, strict=True)
        warnings += one.advice
        data.append({"axis": axis, "links": count, "rule": one.rule, "supports": one.read.beam.supports,
                     "length": one.read.beam.length, "stiffness": one.stiffness, "faults": [text for text, _ in one.faults],
                     "mass_per_length": one.read.beam.mass_per_length, "frequencies_hz": hertz, "exact_hz": exact,
                     "error": errors, "corrected_error": better})  # fmt: skip
    if out is not None:
        warnings.append(_write(path, kind, solids, judged, out))
    columns = [Column("axis"), Column("mode"), Column("exact", "Hz", ".7g"), Column("this file", "Hz", ".7g")]
    columns += [Column(name, format="+.3g", percent=True) for name in ("error", "with correct joints")]
    tables = [Table("Frequencies", columns, rows)]
    columns = [
        Column("axis"),
        Column("fault"),
        *(Column(f"at mode {m}", format="+.3g", percent=True) for m in ("1", "n")),
    ]
    tables += [Table("Faults, each alone, in frequency", columns, faults)] if faults else []
    columns = [Column("joint"), Column("name"), Column("axis")]
    columns += [Column(name, "N m/rad", ".6g") for name in ("present", "correct")] + [
        Column("change", format="+.3g", percent=True)
    ]
    tables.append(Table("Joints", columns, joints))
    first = judged[0]
    summary = f"{len(first.springs)} rigid links, {', '.join(dict.fromkeys(one.rule for one in judged))}; "
    summary += (
        f"the beam: {first.read.beam.length:.6g} m, "
        + ", ".join(
            f"{'GJ' if one.line.axis == 'torsion' else 'EI'} {one.stiffness / (1.0):.6g} N m2" for one in judged
        )
        + f", {first.read.beam.mass_per_length:.6g} kg/m."
    )
    return Result(
        summary,
        tables,
        warnings=warnings,
        margins=margins,
        data={"source": path.name, "passed": worst <= (within or FINE), "chains": data},
    )


def _write(path: Path, kind: str, solids: Any, judged: list[Judged], out: Path) -> str:
    """The file with other stiffnesses and nothing else changed; returns a sentence."""
    from verify.files import whole, write_whole
    from verify.report.result import to_json

    new: dict[str, float] = {}
    for one in judged:
        for names, k, present in zip(one.line.joints, one.springs, one.line.springs, strict=True):
            if len(names) > 1:
                raise InputError(
                    f"corrected = {shown(str(out))}: joints {' and '.join(names)} are in series, merge them"
                )
            if names and present:
                new.setdefault(names[0], float(k))
    data = path.read_bytes()
    if kind == "urdf":
        beside, name = (
            json.loads(path.with_name(path.name + ".json").read_text("utf-8")),
            out.with_name(out.name + ".json"),
        )
        for j, joint in enumerate(beside.get("joints", ())):
            for hinge in joint["hinges"]:
                hinge["stiffness"] = new.get(f"joint{j}_{hinge['axis']}", hinge["stiffness"])
        write_whole(name, to_json(beside if "joints" in beside else beside | new), "corrected")
    elif kind == "sdf":
        for key, k in new.items():
            joint, _, axis = key.partition("/")
            pattern = rf'(?s)(<joint\s[^>]*name\s*=\s*["\']{re.escape(joint)}["\'](?:(?!</joint>).)*?<{axis or "axis"}>'
            pattern += r"(?:(?!</joint>).)*?<spring_stiffness>)[^<]*"
            data = re.sub(pattern.encode(), lambda found: found[1] + repr(k).encode(), data, count=1)  # noqa: B023
    else:
        spots, inside, parser = list[int](), list[str](), expat.ParserCreate()

        def start(tag: str, _: Any) -> None:
            if tag in ("joint", "freejoint") and "worldbody" in inside:
                spots.append(parser.CurrentByteIndex)
            inside.append(tag)

        parser.StartElementHandler, parser.EndElementHandler = start, lambda _: inside.pop()
        parser.Parse(data, True)
        compiled = {move.joint: move.stiffness for one in solids for move in one.moves}
        tags = [re.match(rb"(?s)<\w+(?:[^>\"']|\"[^\"]*\"|'[^']*')*", data[at:]) for at in spots]
        own = rb"(\sstiffness\s*=\s*[\"']\s*)([^\"'\s]+)"
        stated = [re.search(own, tag[0]) for tag in tags if tag]
        named = [re.search(rb"\sname\s*=\s*[\"']([^\"']*)", tag[0]) for tag in tags if tag]
        if len(stated) != len(compiled) or any(
            (name and name[1].decode() != joint) or (number and abs(float(number[2]) - k) > 1e-9 * k)
            for name, number, (joint, k) in zip(named, stated, compiled.items(), strict=True)
        ):
            raise InputError(
                f"{path.name}: its joints are not all in its text in their order (include, replicate), write it out by "
                "mujoco.mj_saveLastXML first"
            )
        for joint, at, tag, number in reversed(list(zip(compiled, spots, tags, stated, strict=True))):
            if tag and joint in new:
                text = repr(new[joint]).encode()
                fresh = (
                    re.sub(own, lambda found: found[1] + text, tag[0], count=1)
                    if number
                    else tag[0][:6] + b' stiffness="' + text + b'"' + tag[0][6:]
                )  # noqa: B023
                data = data[:at] + fresh + data[at + len(tag[0]) :]
    with whole(out, "corrected") as part:
        part.write_bytes(data)
    return f"wrote {out}: other stiffnesses, nothing else"
