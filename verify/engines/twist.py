"""Torsion of a chain in a file next to the exact shaft that it means."""

from dataclasses import dataclass, field

import numpy as np

from verify.arrays import Array
from verify.engines.description import Axis, Hinge, Joint, Link, RigidChain
from verify.engines.line import Line
from verify.engines.rules import Judged
from verify.engines.stiffness_law import ALIKE
from verify.errors import InputError
from verify.exact.torsion import shafts, torsion_hz
from verify.problem.beam import Beam

UNEVEN = 0.01
"""Relative difference of polar inertias per length from which they are not those of one shaft."""


@dataclass(frozen=True, eq=False)
class Shaft(RigidChain):
    """A chain with hinges in torsion, and length, GJ, rho I_p of the `pieces` of the exact shaft, (pieces, 3)."""

    pieces: Array = field(default_factory=lambda: np.empty((0, 3)))

    def frequencies_hz(self, axis: Axis = "torsion", n_modes: int | None = None) -> Array:
        """Of torsion, whatever the axis."""
        return super().frequencies_hz("torsion", n_modes)

    def exact_hz(self, axis: Axis = "torsion", n_modes: int = 3) -> Array:
        """Of torsion, whatever the axis."""
        bodies = [(body.position, body.rotary_inertia) for body in self.beam.mass]
        return torsion_hz(self.pieces, (True, False), n_modes, bodies)


def judge_twist(line: Line, meant: Beam, beam: Beam | None) -> Judged | None:
    """The rule of the joints in torsion, by GJ and polar inertia of `beam` or, without, of the file; `meant`: its beam.

    None where the joint at the wall is free, where polar inertias are those of no section, and where no uniform shaft
    explains a file, and for a beam without sections.
    """
    (lengths, _, _, inertias), k = line.links.T, line.springs
    held, half, edges = bool(np.isnan(k[0])), 0.5 * lengths, np.append(0.0, np.cumsum(lengths))

    def series(soft: Array) -> Array:
        """Compliances of joints between half links; all of a fixed link is in the joint behind."""
        both = soft + np.append(0.0, soft[:-1])
        return np.append([np.nan] * held, both[held:] + np.eye(len(both) - held)[0] * soft[0] * held)

    whole = k * series(half)
    twist, spin = float(np.nanmedian(whole[1:])), float(np.median(inertias / lengths))
    uneven = np.ptp(whole[1:]) > ALIKE * twist or np.ptp(inertias / lengths) > UNEVEN * spin
    if not (line.solid and (held or k[0] > 0.0) and (k[1:] > 0.0).all()) or line.ball or (uneven and not beam):
        return None
    try:
        pieces = np.array([[edges[-1], twist, spin]]) if beam is None else shafts(beam)
    except InputError:
        return None
    at = np.searchsorted(np.cumsum(pieces[:, 0])[:-1], edges[:-1] + half)
    springs = 1.0 / series(half / pieces[at, 1])

    def chain(values: Array) -> Shaft:
        hinges = [() if np.isnan(one) else (Hinge("torsion", float(one)),) for one in [*values, 0.0]]
        rows = zip(edges.tolist(), line.links.tolist(), strict=False)
        links = tuple(Link(x, length, mass, centre, (own,) * 3) for x, (length, mass, centre, own) in rows)
        return Shaft(meant, "", tuple(map(Joint, edges.tolist(), hinges)), links, pieces=pieces)

    expected = pieces[at, 2] * lengths
    wall, inner, mass = k[0] / springs[0], float(np.median((k / springs)[1:])), float(np.median(inertias / expected))
    rule = "first link fixed" if held else f"{2.0 * wall / inner:.4g} GJ/l at the wall"
    faults = [f"{rule} in place of 2 GJ/l"] if abs(wall / inner - 1.0) > ALIKE else []
    faults += [f"torsional stiffness {inner:.5g} times that of the beam"] if abs(inner - 1.0) > ALIKE else []
    links = [f"polar inertia {mass:.4g} times that of the beam"] if abs(mass - 1.0) > UNEVEN else []
    return Judged(line, chain(k), chain(springs), rule, twist, springs, faults + links, links, [], [])
