"""Chains under dead loads beyond buckling, and along a driven one: against joints in a row and a root by steps.

From its tip a cantilever of links is a chain of sums: what a joint carries tells by how much it turns, and so the link
before. The tip's own angle is the one unknown, and the clamp's angle the one equation; followed from no load in small
steps of it.
"""

from dataclasses import replace
from functools import cache
from math import cos, sin

import numpy as np

from verify.beam import Beam, PointForce
from verify.chain import warm
from verify.chain.bending import bend
from verify.chain.departure import Driven, along_the_beam
from verify.chain.dynamics import at_rest
from verify.chain.splitting import modal_basis, simulate_linear
from verify.chain.system import ChainSystem, build_system
from verify.models.arrays import Array
from verify.stress.chain.written_out import changed_beam
from verify.stress.kind import Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.beams import held

LINKS = 7
STEPS = 300
"""Of a load that grows."""
LOADS = (
    (-1.8, 0.05, 0.0),
    (-3.1, 0.4, -0.2),
    (-1.4, -0.3, 0.35),
    (-0.7, 0.5, 0.1),
    (0.9, -1.6, 0.7),
    (0.4, 3.3, 0.0),
)
"""Along and across, over the buckling load; moment over it and the beam's length."""


@cache
def _chain() -> tuple[Beam, ChainSystem, float]:
    """A cantilever in two thicknesses, its chain, and the load along that buckles it."""
    beam = changed_beam(held("clamped", "free"))
    system = build_system(beam, LINKS)
    return beam, system, _buckling(system)


def _buckling(system: ChainSystem) -> float:
    """By halving: the least push along under which the straight chain is no least of energy."""
    k, low, high = system.stiffness, 0.0, 2.0 * float(system.stiffness[0] / system.lengths[0])
    springs = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    for _ in range(200):
        middle = 0.5 * (low + high)
        firm = np.linalg.eigvalsh(springs - middle * np.diag(system.lengths))[0] > 0.0
        low, high = (middle, high) if firm else (low, middle)
    return low


def _at_the_clamp(system: ChainSystem, tip: float, load: tuple[float, float, float]) -> tuple[float, Array]:
    """(the angle that is left at the clamp of a chain whose last link has one, angles of all links)."""
    along, across, moment = load
    angles, angle = np.zeros(system.n_links), tip
    for i in reversed(range(system.n_links)):
        angles[i] = angle
        moment += float(system.lengths[i]) * (across * cos(angle) - along * sin(angle))
        angle -= moment / float(system.stiffness[i])
    return angle, angles


def _led(system: ChainSystem, load: tuple[float, float, float]) -> Array:
    """Angles, (N,), under a load that has grown from nothing in small steps."""
    tip, grown = 0.0, np.zeros(system.n_links)
    for step in range(1, STEPS + 1):
        part = tuple(one * step / STEPS for one in load)
        for _ in range(9):
            left, grown = _at_the_clamp(system, tip, part)  # type: ignore[arg-type]
            rise = (_at_the_clamp(system, tip + 1e-7, part)[0] - left) / 1e-7  # type: ignore[arg-type]
            tip -= left / rise
            if abs(left) < 1e-13:
                break
    return grown


def led_error(number: float) -> float:
    """Of angles, of the tip over the length, of moments, of curvatures and of the energy under one of the loads."""
    beam, system, least = _chain()
    along, across, moment = LOADS[int(number)]
    load = along * least, across * least, moment * least * beam.length
    exact, found = _led(system, load), bend(beam, LINKS, load[:2], moment=load[2])
    tip = np.array([system.lengths @ np.cos(exact), system.lengths @ np.sin(exact)])
    turned = np.diff(exact, prepend=0.0)
    beyond = 0.5 * float(system.lengths[-1]) * load[2] / beam.pieces[-1].bending_stiffness
    energy = 0.5 * float(system.stiffness @ turned**2) + 0.5 * load[2] * beyond
    moments = np.append(system.stiffness * turned, load[2])
    off = [abs(found.angles - exact).max(), abs(found.tip - tip).max() / beam.length, found.energy / energy - 1.0]
    off += [abs(found.moments - moments).max() / abs(moments).max(), found.turn - exact[-1] - beyond]
    ends = np.cumsum([piece.length for piece in beam.pieces[:-1]])
    on = (system.nodes[:, None] > ends - 1e-9 * beam.length).sum(axis=1)  # the piece that begins where two meet
    bends = found.curvature * np.array([piece.bending_stiffness for piece in beam.pieces])[on]
    off += [abs(bends - moments).max() / abs(moments).max()]
    return largest(abs(float(one)) for one in off)


def along_error(number: float) -> float:
    """Of the least and the largest departure along a chain whose last state is not the linear one's.

    With an even number of tenths read, in the middle or aside; a tenth at the clamp's own place moves by nothing.
    """
    beam, system, _ = _chain()
    force = 1e-4
    driven = Driven(
        beam=beam,
        forces=(PointForce(position=0.6),),
        frequency_hz=37.0,
        count=LINKS,
        x=(0.31, 0.52)[int(number)],
        times=np.linspace(0.0, 0.02, 9),
    )
    moved = build_system(beam, LINKS, driven.under(force), driven.frequency_hz)
    linear = simulate_linear(modal_basis(moved), at_rest(moved), driven.times)
    bent = linear.angles * (1.0 + np.outer(np.arange(9.0) == 8.0, np.cos(np.arange(1.0, LINKS + 1.0))))
    found = along_the_beam(driven, replace(linear, angles=bent), force)
    places = np.append(driven.x, np.arange(1, 10) * beam.length / 10)
    reach = np.clip(places[:, None] - system.nodes[:-1], 0.0, system.lengths)
    exact = [
        abs(float(gap[-1])) / float(np.sqrt(np.mean(line**2)))
        for line, gap in (
            (np.cumsum(linear.angles, axis=1) @ row, np.cumsum(bent - linear.angles, axis=1) @ row) for row in reach
        )
    ]
    return largest(abs(found[0] / min(exact) - 1.0), abs(found[1] / max(exact) - 1.0))


def pushed(share: float) -> object:
    """A cantilever pushed along alone, by a share of what buckles it."""
    beam, _, least = _chain()
    return bend(beam, LINKS, (-share * least, 0.0))


ROWS: tuple[Row, ...] = (
    Floor(
        id="bent-beyond-buckling",
        title="A cantilever of unlike links led beyond its buckling load: angles, tip, moments, curvatures, energy",
        why="chain/load_path.py: the equilibrium that stays stable, to Newton's own rounding; against its joints in a "
        "row from the tip, the tip's angle followed in 300 steps of the load.",
        along="load",
        at=tuple(float(number) for number in range(len(LOADS))),
        promise=1e-12,
        error=led_error,
    ),
    Floor(
        id="departure-along-the-chain",
        title="The least and the largest departure of a chain along its length",
        why="chain/departure.py: by sums over links; small angles leave their squares, 1e-9.",
        along="run",
        at=(0.0, 1.0),
        promise=1e-9,
        error=along_error,
        kernels=warm.rigid,
    ),
    Refusal(
        id="pushed-along-alone",
        title="A straight cantilever pushed by its buckling load and a millionth more",
        why="chain/load_path.py: there it leaves to neither side rather than the other.",
        along="buckling loads",
        at=(1.000001, 2.3),
        taken=(0.999999,),
        names=("load = ", "buckling load of 1.22062 N"),
        ask=pushed,
    ),
)
