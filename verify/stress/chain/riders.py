"""Sliders and feet that ride on chains in large motion, by the places of joints that are told."""

from collections.abc import Iterator
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np

from verify.beam import PointForce
from verify.chain.result import ChainMotion, ChainStatistics
from verify.chain.stretching import ElasticMotion
from verify.chain.system import build_system
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.slider import Contact, Foot, Slider
from verify.stress.chain.written_out import changed_beam
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import held

LINKS, PERIOD = 7, 0.02
DONE = ChainStatistics(steps=1, evaluations=1, step_s=1.0, set_up_s=0.0, wall_s=0.0, stopped="end", method="told")


class Swung:
    """Links in a large motion that is told: at times, as rigid links, and as joints of links that may stretch."""

    def __init__(self) -> None:
        from verify.chain.ride import half_steps

        self.beam = changed_beam(held("clamped", "free"))
        self.system = build_system(self.beam, LINKS)
        self.times = half_steps(0.4 * PERIOD, 0.01 * PERIOD)
        angles, rates, lengths = *self.links(self.times), self.system.lengths
        moving = np.stack([-np.sin(angles) * rates * lengths, np.cos(angles) * rates * lengths], axis=2)
        places = np.stack([(np.cos(angles) - 1.0) * lengths, np.sin(angles) * lengths], axis=2)
        self.speeds, self.places = (
            np.pad(np.cumsum(one, axis=1), ((0, 0), (1, 0), (0, 0))) for one in (moving, places)
        )
        nothing = np.zeros(len(self.times))
        self.rigid = ChainMotion(
            system=self.system,
            times=self.times,
            statistics=DONE,
            angles=np.diff(angles, axis=1, prepend=0.0),
            rates=np.diff(rates, axis=1, prepend=0.0),
            dissipated=nothing,
            work_in=nothing,
        )

    def links(self, times: Array) -> tuple[Array, Array]:
        """Absolute angles of links and their rates, (n, N) each: large, of no symmetry."""
        n, turn = np.arange(1.0, LINKS + 1.0), 2.0 * pi / PERIOD
        size, lead = 0.3 * np.cos(1.7 * n) / np.sqrt(n), 0.9 * n
        angle = turn * times[:, None] + lead
        return size * np.sin(angle), size * turn * np.cos(angle)

    def stretching(self, beside: Array) -> ElasticMotion:
        """The same joints, moved along as a whole beside, (n,), m/s."""
        also = self.speeds + np.stack([beside, np.zeros(len(beside))], axis=1)[:, None]
        return ElasticMotion(
            system=self.system,
            times=self.times,
            statistics=DONE,
            displacements=self.places,
            velocities=also,
            axial_stiffness=1.0,
        )


def ridden_error(share: float) -> float:
    """Of the surface's speed under a slider on links in large motion, over its largest, against joints that are told.

    Joints of links that stretch stand where those of rigid ones do; and all of them moved along by one speed beside
    carry the slider by that much more.
    """
    from verify.chain.ride import ride

    swung = Swung()
    start = float(swung.system.nodes[3] + share * swung.system.lengths[3])
    slider = Slider(mass=1e-3, mu=0.23, slope=0.1, gravity=1e-9, position=start, coupling="one-way")
    found = ride(swung.rigid, swung.beam, slider).surface_speed
    size = float(abs(found).max())
    beside = size * np.cos(9.0 * swung.times / PERIOD)
    still = ride(swung.stretching(0.0 * beside), swung.beam, slider).surface_speed
    moved = ride(swung.stretching(beside), swung.beam, slider).surface_speed
    return float(largest(abs(still - found).max(), abs(moved - beside[::2] - found).max()) / size)


def under_feet_error(place: float) -> float:
    """Of the surface under all feet on links in large motion: its heights, how fast they rise and go along, its edges.

    Against the line through the joints that are told, in the middle of every step.
    """
    from types import SimpleNamespace

    from verify.chain.system import straight_chain
    from verify.motor.feet import Placed
    from verify.motor.on_chain import surface_given
    from verify.segments.reading import contact_line

    swung = Swung()
    nodes, feet = (
        swung.system.nodes,
        (Foot(length=0.02, points=3, offset=-0.01), Foot(length=0.01, points=2, offset=0.015)),
    )
    slider = Slider(mass=1e-3, mu=0.2, contact=Contact(stiffness=1.0), foot=feet, position=place)
    ground = SimpleNamespace(edges=np.array([float(nodes[1]), float(nodes[-1])]))
    plan: Any = SimpleNamespace(stages=[ground], placed=(Placed(slider, place),))
    ends = np.searchsorted(nodes, [place - 0.02, place + 0.02])
    first, last = max(int(ends[0]) - 1 - 2, 1), min(int(ends[1]) - 1 + 2, LINKS - 1)
    worst = 0.0
    for moved in (swung.rigid, swung.stretching(np.zeros(len(swung.times)))):
        given, edges = surface_given(moved, plan)
        if len(edges) != last + 2 - first or abs(edges - nodes[first : last + 2]).max() > 1e-15:
            return 1.0
        along = swung.speeds[1::2, first : last + 2, 0]
        worst = largest(worst, float(abs(given.along - along).max() / abs(along).max()))
        for which, rows in enumerate((swung.places, swung.speeds)):
            line = contact_line(straight_chain(swung.system), rows[1::2, :, 1])
            for share in (0.0, 0.3, 0.9):
                exact = np.stack([line(a + share * (b - a)) for a, b in pairwise(edges)], axis=1)
                found = given.local[:, :, which] @ share ** np.arange(4.0)
                worst = largest(worst, float(abs(found - exact).max() / abs(exact).max()))
    return worst


def small_error(size: float) -> float:
    """Of heights of a slider's feet on the nonlinear chain in a small motion, against the linear one, over the largest.

    What they part by is of second order in what drives them.
    """
    from verify.motor.run import run_motor

    beam = held("pinned", "pinned")
    forces = (
        PointForce(position=0.06, amplitude=size),
        PointForce(position=0.65, amplitude=0.7 * size, phase_deg=80.0),
    )
    slider = Slider(
        mass=2e-3,
        mu=0.2,
        slope=100.0 / size,
        gravity=0.0,
        preload=0.3 * size,
        position=0.34,
        coupling="one-way",
        contact=Contact(stiffness=3e4, damping=5.0),
        foot=(Foot(length=0.02, points=3),),
    )
    asked: dict[str, Any] = {"count": 7, "start": "rest", "samples": 6, "slider": slider, "step": 1e-5}
    bent, straight = (run_motor(beam, forces, 170.0, 0.6 / 170.0, model=one, **asked) for one in ("chain", "segment"))
    pairs = ((bent.height, straight.height), (bent.pitch, straight.pitch), (bent.pressures, straight.pressures))
    return largest(float(abs(one - other).max() / abs(other).max()) for one, other in pairs)


def _given() -> Iterator[Call]:
    from verify.motion import warm

    return warm.on_chain("tanh")


def _small() -> Iterator[Call]:
    from verify.chain import warm
    from verify.motor import warm as of_motors

    yield from warm.rigid()
    yield from of_motors.on_chain("tanh")
    yield from of_motors.on_springs("tanh", "one-way")


ROWS: tuple[Row, ...] = (
    Floor(
        id="ridden-links-in-large-motion",
        title="Surface speed under a slider on links in large motion, rigid and stretching, against joints told",
        why="chain/ride.py: the same line through the same joints, and their own speed along, to rounding.",
        along="share of a link",
        at=(0.1, 0.83),
        promise=1e-12,
        error=ridden_error,
        kernels=_given,
    ),
    Floor(
        id="under-all-feet-on-a-chain",
        title="The surface under a motor's feet on links in large motion: heights, rates, speed along, where it ends",
        why="motor/on_chain.py: the line through joints in the middle of every step, to rounding.",
        along="m",
        at=(0.13, 0.287, 0.4, 0.44, 0.7),
        promise=1e-12,
        error=under_feet_error,
    ),
    Floor(
        id="motor-on-a-small-chain",
        title="Feet on the nonlinear chain in a small motion, against the linear one: heights, pitch, pressures",
        why="motor/on_chain.py: they part by the square of what drives them.",
        along="N",
        at=(1e-3,),
        promise=1e-7,
        error=small_error,
        kernels=_small,
    ),
)
