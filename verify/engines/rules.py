"""The rule of the joints of a chain of rigid links, the beam that they mean, what is wrong, correct joints.

The compliance of a joint is w times that of the half links next to it, of the whole link at a wall. The rule of a file
is the one by which all its joints have the same EI. Without a beam next to it, EI and rho A are those of the file.
"""

import itertools
from math import isnan, pi
from typing import Any, NamedTuple

import msgspec
import numpy as np

from verify.arrays import Array
from verify.engines.description import Hinge, Joint, Link, RigidChain
from verify.engines.line import Line
from verify.engines.stiffness_law import ALIKE, ROUGH, Law, fitted_law
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass
from verify.segments.walls import wall_factors
from verify.settings import WALLS, wall_label

HELD = (np.nan, 23 / 12, 7 / 12)
"""Factors w behind a first link fixed to the wall, order 3 (Press et al., Numerical Recipes, open extended formula)."""
ADAPTED = "first link fixed, adapted joints, at the wall"
SERIES = "fixed link in series with its joint at the wall"
"""All of a first link that is fixed is in its joint, as with half a link at the wall and EI/l behind: order 2."""
IRREGULAR = "irregular joints at the wall"
WEIGHTS = {wall_label(name): rule.weights for name, rule in WALLS.items() if not rule.first and all(rule.weights)}
"""Weights at a wall by the rule in words."""
SPACINGS = ("", "the mean length", "the length of the link beyond", "the length of the link before")
SQUARE = 16 / (3 * pi)
"""Second moment of area of a square over that of the circle in it."""
MORE = "give more links"
SAME = 1e-9
"""Relative difference up to which a stiffness stays as it is, and a place is the wall."""


def weights_of(rule: str, n: int) -> Array:
    """Weights of n joints by the rule at the wall in words: 1 but for those of WEIGHTS."""
    return np.append(WEIGHTS.get(rule, ()), np.ones(n))[:n]


class Judged(NamedTuple):
    """A chain as it is and with correct joints, whose axis is "bending" in either plane, or "torsion".

    `stiffness`: EI at the wall, N m^2. `springs`: correct ones, N m/rad. `faults`: of joints and links; `links`: those
    of links. `advice`: what else to know of the joints. `odd`: joints off the law of the others, the stiffness by
    it. `means`: EI or GJ in words. `remedy`: what is better than more links.
    """

    line: Line
    present: RigidChain
    correct: RigidChain
    rule: str
    stiffness: float
    springs: Array
    faults: list[str]
    links: list[str]
    advice: list[str]
    odd: dict[str, float]
    means: str
    remedy: str = MORE


def judge(line: Line, beam: Beam | None = None, theory: Any = "euler-bernoulli") -> Judged:
    """The rules of a chain and what is wrong with it. `beam`: the one it means, in the plane of the line."""
    if beam is not None and elastic_clamp(beam):
        return _on_spring(line, beam, theory)
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
    meant = None if beam is None else float(values[0])
    rule, spacing, stiffness, law = _fitted(line, lengths / scale, expected, support, meant)
    along = (law.joints, np.ones(n)) if law.kind == "smooth" else (np.full(n, law.links[0]), law.links[0] / law.links)
    soft = lengths / scale * along[1]
    reference, base = meant or stiffness, half_links(soft) * law.links[0] / along[0]
    even = np.ptp(soft[:3]) < 1e-4 * soft[0]
    best = "gregory" if even else "half"
    hinged = reference / base / wall_factors((support, "free"), n, best)[:-1]
    behind = np.append(HELD, np.ones(n))[:n] if even and n > len(HELD) else np.append(np.nan, _weld(soft)[1:])
    springs = reference / base / behind if held else hinged
    if beam is None and law.kind:  # no scene explains them: nothing but the joints at the wall changes
        springs = np.where(np.isin(range(n), law.odd) | (np.arange(n) >= (3 if even else 1)), k, springs)
    beam = beam or _meant(line, expected, support, law.links)

    right = wall_label(best), *([] if even else [SERIES])
    wall = [rule] if rule not in right and support == "clamped" else []
    joints, links = _faults(line, expected, sum(one.mass for one in beam.mass), spacing, stiffness / reference)
    odd = law.faults(line.joints, k * half_links(lengths / scale) / law.joints)
    inside = reference / base
    steps = 1 + np.flatnonzero(np.diff(law.links)) if law.kind != "smooth" else np.zeros(0, int)
    steps = steps[abs(k[steps] / inside[steps] - 1.0) > ALIKE]
    advice = _advice(line, law, inside, steps, hinged if held and wall else None)
    right_ones = inside / weights_of(rule, n)
    names = {line.joints[j]: float(right_ones[j]) for j in (*law.odd, *steps) if meant is None}
    means, faults = f"= {stiffness:.6g} N m2", wall + odd + joints + links
    text = rule if support == "clamped" else f"{support} end"
    present, correct = (rigid(line, each, beam, rule, theory) for each in (k, springs))
    return Judged(line, present, correct, text, stiffness, springs, faults, links, advice, names, means)


def elastic_clamp(beam: Beam) -> float:
    """Stiffness of the rotational spring, N m/rad, that holds a pinned left end and is all that is elastic; else 0."""
    alone = beam.supports == ("pinned", "free") and len(beam.spring) == 1
    spring = beam.spring[0] if alone else None
    return spring.rotational if spring and not (spring.position or spring.stiffness) else 0.0


def clamped(beam: Beam) -> Beam:
    """The beam without its elastic clamp."""
    return msgspec.structs.replace(beam, supports=("clamped", "free"), spring=())


def _on_spring(line: Line, beam: Beam, theory: Any) -> Judged:
    """The chain of a beam on a rotational spring, in series with the joint of a clamp."""
    wall, k = elastic_clamp(beam), line.springs.copy()
    k[0] = 1.0 / max(1.0 / k[0] - 1.0 / wall, SAME / wall)
    found = judge(line._replace(springs=k), clamped(beam), theory)
    springs = found.springs.copy()
    springs[0] = 1.0 / (1.0 / springs[0] + 1.0 / wall)
    present, correct = (rigid(line, each, beam, found.rule, theory) for each in (line.springs, springs))
    rule = f"{found.rule}, on a spring of {wall:.6g} N m/rad"
    return found._replace(line=line, present=present, correct=correct, springs=springs, rule=rule)


def rigid(line: Line, springs: Array, beam: Beam, rule: str, theory: Any = "rayleigh") -> RigidChain:
    """A line with springs, (N,), N m/rad, as a chain about `line.turns`."""
    edges = np.append(0.0, np.cumsum(line.links[:, 0])).tolist()
    each = np.pad([springs, line.dashpots, line.armatures], ((0, 0), (0, 1))).T.tolist()
    hinges = [() if isnan(k) else (Hinge(line.turns, k, dashpot, armature),) for k, dashpot, armature in each]
    rows = zip(edges, line.links.tolist(), strict=False)
    links = tuple(Link(x, length, mass, centre, (own,) * 3) for x, (length, mass, centre, own) in rows)
    return RigidChain(beam, rule, tuple(map(Joint, edges, hinges)), links, theory=theory)


def half_links(soft: Array) -> Array:
    """Two half links in series at the joints: their length over EI, (N,), of that of the links."""
    return np.asarray(0.5 * (np.append(soft[0], soft[:-1]) + soft))


def _weld(soft: Array) -> Array:
    """Factors w of SERIES."""
    weld = np.ones(len(soft))
    weld[1] = 1.0 + soft[0] / (soft[0] + soft[1])
    if soft[-1] < 0.75 * soft[-2]:  # half a link at the end too, where the moment is small
        weld[-1] = 1.0 + soft[-1] / (soft[-2] + soft[-1])
    return weld


def _fitted(line: Line, soft: Array, expected: Array, support: str, meant: float | None) -> tuple[str, int, float, Law]:
    """(rule at the wall, spacing, EI there, law of EI) of a chain whose links have the masses `expected`, kg.

    `meant`: EI of a scene. The law has no kind where one EI and the rule explain all joints. Raises InputError.
    """
    (lengths, masses, *_), k, n, bases = line.links.T, line.springs, len(soft), [half_links(soft)]
    if np.ptp(lengths) > 1e-4 * lengths.mean():
        bases += [np.full(n, lengths.mean()), lengths, np.append(lengths[0], lengths[:-1])]
    rule, spacing, stiffness = _rule(k, bases, support, _weld(soft))
    if rule != IRREGULAR:
        return rule, spacing, stiffness, Law("", np.full(n, stiffness), np.full(n, stiffness), [])
    if meant is None and np.sum(abs(masses - expected) > 0.01 * expected) > max(1, n // 4):
        raise InputError("masses and stiffnesses of the links vary: give the tapered or stepped beam as a scene")
    rule, law = at_wall(k * bases[0], line.joints, support, soft, meant)
    return rule, 0, float(law.links[0]), law


def at_wall(values: Array, names: list[str], support: str, soft: Array, meant: float | None = None) -> tuple[str, Law]:
    """(rule in words of the joints at the wall, law of EI, without a `meant` EI without one of them off the rule).

    `values`: EI of the joints, (N,); `soft`: lengths of the links over EI. Raises InputError.
    """
    n = len(values)
    rule, _, level = _rule(values, [np.ones(n)], support, _weld(soft))
    if rule != IRREGULAR:
        return rule, Law("constant", np.full(n, level), np.full(n, level), [])
    law = fitted_law(values, np.append(0.0, np.cumsum(soft[:-1])), names, meant)
    steady = np.where(np.isin(range(n), law.odd), 1.0, values / law.joints)
    alike = 0.5 * ROUGH if law.kind in ("smooth", "nearly constant") else ALIKE
    rule, *_ = _rule(steady, [np.ones(n)], support, _weld(soft), alike)
    for j in (1, 2) if rule == IRREGULAR and meant is None and n > 3 else ():  # or one of them is off a rule, too
        others = _rule(np.where(np.arange(n) == j, 0.0, steady), [np.ones(n)], support, _weld(soft))[0]
        if others != IRREGULAR:
            return others, law._replace(odd=[j, *law.odd])
    return rule, law


def _advice(line: Line, law: Law, inside: Array, steps: Array, hinged: Array | None) -> list[str]:
    """What else to know of the joints; `hinged`: better ones than a fixed link, `inside`: two half links in series."""
    found = []
    if hinged is not None:
        first = ", ".join(f"{one:.6g}" for one in hinged[:3])
        found.append(f"better than a fixed link is a hinge at the wall, with {first} N m/rad from it on")
    if np.ptp(law.links):
        ends = " to ".join(f"{one:.6g}" for one in law.links[[0, -1]])
        found.append(f"EI of the joints is {law.kind}, {ends} N m2: the exact beam has it, give another one as a scene")
    for j in steps:
        text = f"two half links in series have {inside[j]:.6g} N m/rad"
        found.append(f"joint {line.joints[j]} at a step has {line.springs[j]:.6g}, {text}")
    return [f"{line.axis}: {one}" for one in found]


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


def _meant(line: Line, expected: Array, support: Any, stiffness: Array) -> Beam:
    """The beam of a file: bodies on the few links heavier than `expected`, kg, whose inertia the links leave.

    `stiffness`: EI of the links, (N,), N m^2; links of one EI in a row are a section.
    """
    lengths, masses, centres, inertias = line.links.T
    ends, middle, more, heavy = np.cumsum(lengths), 0.5 * lengths, masses - expected, masses > 1.01 * expected
    heavy &= heavy.sum() <= max(1, len(masses) // 4)
    x = (masses * centres - expected * middle) / np.where(heavy, more, 1.0)
    own = inertias - expected * (lengths**2 / 12.0 + (middle - centres) ** 2) - more * (x - centres) ** 2
    spots = np.stack([np.minimum(ends - lengths + x, ends[-1]), more, np.maximum(own, 0.0)], axis=1)[heavy].tolist()
    spin = float(np.median(inertias / (masses * lengths**2)) - 1 / 12) * expected[0] * lengths[0]
    starts = [0, *(1 + np.flatnonzero(np.diff(stiffness))).tolist(), len(ends)]
    sizes = [(float(lengths[a:b].sum()), float(stiffness[a])) for a, b in itertools.pairwise(starts)]
    section = tuple(Section(length=length, bending_stiffness=ei) for length, ei in sizes)
    return Beam(
        length=float(ends[-1]),
        supports=(support, "free"),
        bending_stiffness=float(stiffness[0]),
        section=section if len(section) > 1 else (),
        mass_per_length=float(expected[0] / lengths[0]),
        rotary_inertia=spin if spin > 0.0 else None,
        mass=tuple(PointMass(position=x, mass=m, rotary_inertia=own) for x, m, own in spots if x > SAME),
    )


def _rule(k: Array, bases: list[Array], support: str, weld: Array, alike: float = ALIKE) -> tuple[str, int, float]:
    """(rule in words, spacing, EI): the first ones by which all joints have EI `alike`; `weld`: that of SERIES."""
    held = bool(np.isnan(k[0]))
    names = ["rigid", ADAPTED, SERIES] if held else ["full"]
    if support == "clamped" and not held:
        names = [name for name, rule in WALLS.items() if not rule.first and rule.weights[0]]
    others: Any = {ADAPTED: HELD, SERIES: weld}
    rows = [np.array(others[name] if name in others else WALLS[name].weights) for name in names]
    fits = [(k * base * np.append(row, np.ones(len(k)))[: len(k)])[k > 0.0] for base in bases for row in rows]
    spreads = [round(float(np.std(fit / fit.mean())), 6) for fit in fits]
    best = int(np.argmin(spreads))
    name, spacing, stiffness = names[best % len(names)], best // len(names), float(np.median(fits[best]))
    text = wall_label(name) if name in WALLS else name
    if spreads[best] > alike:
        inner = (k * bases[0])[1:]
        spacing, stiffness, text = 0, float(np.median(inner)), IRREGULAR
        if np.std(inner / stiffness) < alike:
            text = f"{k[0] * bases[0][0] / stiffness:.4g} EI/l at the wall"
    return text, spacing, stiffness
