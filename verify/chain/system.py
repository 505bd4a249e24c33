"""Description of the nonlinear chain: rigid links, joints, supports, loads.

Links are numbered 1..N from the base; joint i lies at the near end of link i. x runs along the straight chain, y
across it. Coordinates are the paper's relative joint angles q_i = theta_i - theta_{i-1}.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from math import pi

import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.linear.mesh import divide
from verify.problem.base_motion import FIXED, Base
from verify.problem.beam import Beam, PointForce, PointLoad, check_features
from verify.segment_model import SegmentModel
from verify.segments.attachments import joint_weights
from verify.segments.chain import Chain
from verify.settings import DEFAULT, LINKS, WALLS, Joints, Links, Load, Tip, Wall
from verify.validation import check_choice, check_number


@dataclass(frozen=True, kw_only=True)
class LinkLoad:
    """A dead force and moment on one link, times cos(2 pi f t + phase)."""

    link: int  # 1..N
    at: float  # metres from the link's near joint
    force: tuple[float, float] = (0.0, 0.0)  # (F_x, F_y), N, of constant direction
    moment: float = 0.0  # N m
    frequency_hz: float = 0.0
    phase_deg: float = 0.0


@dataclass(frozen=True, kw_only=True, eq=False)
class ChainSystem:
    """N rigid links, joint springs and dashpots, a hub, a tip, loads. SI."""

    lengths: Array  # (N,)
    masses: Array  # (N,)
    inertias: Array  # (N,), kg m^2, about the middles
    stiffness: Array  # (N,), N m/rad; the first at the hub; 0 for a pin
    dashpots: Array  # (N,), N m s/rad
    softening: Array = field(default_factory=lambda: np.zeros(0))
    """(N,), m: stiffness that joints lose per `tension` on a moving base (`linearisation.tensioned`); (0,): none."""
    tip: Tip = "free"
    axial_spring: float = 0.0  # spring against axial motion of the roller, N/m; EA/L models an immovable end
    axial_stiffness: Array = field(default_factory=lambda: np.zeros(0))
    """(N,), EA of links that stretch, N; (0,) of rigid ones."""
    axial_inertia: bool = True  # whether links have inertia along x, which rigid links overestimate
    gravity: tuple[float, float] = (0.0, 0.0)  # m/s^2
    hub_rate: float = 0.0  # steady angular velocity of the hub, rad/s, whose angle at time 0 is 0
    base: Base = FIXED
    """Prescribed motion of the hub, for rigid links with a free tip; beside `hub_rate` its radius alone."""
    loads: tuple[LinkLoad, ...] = ()

    @property
    def n_links(self) -> int:
        """N."""
        return len(self.lengths)

    def hub(self, times: float | Array) -> tuple[Array, Array]:
        """Angle, rad, and rate, rad/s, of the hub at times (...)."""
        at = np.asarray(times, dtype=float)
        if not self.base.moves:
            return self.hub_rate * at, np.full_like(at, self.hub_rate)
        angle, rate, _ = np.array([self.base.rotation(t) for t in at.ravel().tolist()]).reshape(-1, 3).T
        return angle.reshape(at.shape), rate.reshape(at.shape)

    def tension(self, times: float | Array) -> Array:
        """Axial forces in the joints of the straight chain that follows its hub at times (...), (..., N), N."""
        angle, rate = (one[..., None] for one in self.hub(times))
        at = np.asarray(times, dtype=float).ravel().tolist()
        moving = np.array([(self.base.x(t)[2], self.base.y(t)[2]) for t in at]).reshape(*angle.shape[:-1], 2)
        along = ((self.gravity - moving) * np.concatenate([np.cos(angle), np.sin(angle)], axis=-1)).sum(-1)
        radius = self.base.hub_radius + 0.5 * (self.nodes[1:] + self.nodes[:-1])
        pull = self.masses * (radius * rate**2 + along[..., None])
        return np.asarray(np.cumsum(pull[..., ::-1], axis=-1)[..., ::-1])

    @property
    def load_table(self) -> Array:
        """Distance from the near joint, force, moment, angular frequency, phase, link from 0 of all loads, (n, 7)."""
        rows = [
            (p.at, *p.force, p.moment, 2.0 * pi * p.frequency_hz, np.deg2rad(p.phase_deg), p.link - 1)
            for p in self.loads
        ]
        return np.array(rows, dtype=float).reshape(len(rows), 7)

    @property
    def rigid(self) -> bool:
        """Whether links do not stretch."""
        return not len(self.axial_stiffness)

    @property
    def length(self) -> float:
        """Length of the straight chain, m."""
        return float(self.lengths.sum())

    @property
    def nodes(self) -> Array:
        """Joints of the straight chain, (N + 1,), metres."""
        return np.concatenate([[0.0], np.cumsum(self.lengths)])


@dataclass(frozen=True, eq=False)
class ChainState:
    """Relative angles and rates at one time."""

    angles: Array  # (N,), rad; the first from the hub's direction
    rates: Array  # (N,), rad/s
    time: float = 0.0  # s


def build_system(
    beam: Beam,
    n_segments: int,
    forces: Sequence[PointLoad] = (),
    frequency_hz: float = 0.0,
    *,
    load: Load = "lever",
    wall: Wall = DEFAULT.wall,
    joints: Joints = DEFAULT.joints,
    joint_dashpot: float = 0.0,
    axial_inertia: bool = True,
    links: Links = "rigid",
) -> ChainSystem:
    """The nonlinear chain of a beam, its joints those of `segment_model`, under transverse harmonic forces.

    Pinned or clamped on the left; free, or pinned as a roller, on the right. `load` applies a force to its link
    ("lever") or to the four joints around it ("reciprocal"); `links` that are "stretching" have the EA of their
    section. Raises InputError for other supports, a loss factor, and forces off the beam.
    """
    check_choice("links", links, LINKS)
    left, right = beam.supports
    if left not in ("pinned", "clamped") or right not in ("pinned", "free"):
        raise InputError(
            f"beam.supports = {beam.supports!r}: the nonlinear chain starts at a pinned or clamped end and ends free "
            "or pinned (as a roller); give such a pair, mirrored where need be"
        )
    if wall in WALLS and WALLS[wall].first:
        raise InputError(f"wall = {wall!r} is for the linear chain: choose another wall")
    if beam.loss_factor:
        raise InputError(f"beam.loss_factor = {beam.loss_factor!r}: a nonlinear chain has no complex modulus, give 0")
    check_features(beam, "the nonlinear chain", ("section",))
    check_number("joint_dashpot", joint_dashpot, "N m s, 0 means none", at_least=0)
    chain = SegmentModel(beam, n_segments, wall=wall, joints=joints).chain
    unit, mass = chain.unit, beam.mass_per_length
    stiffness = beam.bending_stiffness / unit / chain.compliances[:-1]
    axial = np.zeros(0)
    if links == "stretching":
        axial = divide(beam, n_segments).axial_stiffnesses * beam.base_section.axial_stiffness
    system = ChainSystem(
        lengths=chain.lengths * unit,
        masses=chain.masses * mass * unit,
        inertias=chain.inertias * mass * unit**3,
        stiffness=stiffness,
        dashpots=np.where(stiffness > 0.0, joint_dashpot, 0.0),
        axial_stiffness=axial,
        axial_inertia=axial_inertia,
        tip="roller" if right == "pinned" else "free",
    )
    return replace(system, loads=_link_loads(system, chain, forces, frequency_hz, load))


def _link_loads(
    system: ChainSystem, chain: Chain, forces: Sequence[PointLoad], frequency_hz: float, rule: Load
) -> tuple[LinkLoad, ...]:
    """Harmonic forces across the chain as loads of its links. Raises InputError for moments, and off the beam."""
    loads = list[LinkLoad]()
    for force in forces:
        if not isinstance(force, PointForce):
            raise InputError(f"forces has a {type(force).__name__}: a nonlinear chain takes PointForce alone, give it")
        if force.position > system.length * (1.0 + 1e-12):
            raise InputError(f"force.position = {force.position!r} lies off the beam: give up to {system.length!r} m")
        if rule == "lever":
            shares = [(*link_at(system, force.position), 1.0)]
        else:
            weights = joint_weights(chain, np.array([force.position]), rule).toarray()[0]
            shares = [
                (max(i, 1), float(system.lengths[i - 1]) if i else 0.0, float(weights[i]))
                for i in np.flatnonzero(weights).tolist()
            ]
        drive = {"frequency_hz": frequency_hz, "phase_deg": force.phase_deg}
        loads += [LinkLoad(link=i, at=at, force=(0.0, part * force.amplitude), **drive) for i, at, part in shares]
    return tuple(loads)


def straight_chain(system: ChainSystem) -> Chain:
    """The linear chain of a straight system, in SI; its base is a wall if it has a spring."""
    springs = np.append(system.stiffness, 0.0)
    return Chain(
        supports=("clamped" if springs[0] else "pinned", "pinned" if system.tip == "roller" else "free"),
        unit=1.0,
        lengths=system.lengths,
        compliances=np.divide(1.0, springs, out=np.full(len(springs), np.inf), where=springs > 0.0),
        masses=system.masses,
        inertias=system.inertias,
    )


def link_at(system: ChainSystem, position: float) -> tuple[int, float]:
    """The link at a position of the straight chain, 1..N, and the distance from its near joint, m."""
    nodes = system.nodes
    i = int(np.clip(np.searchsorted(nodes, position, side="right") - 1, 0, system.n_links - 1))
    return i + 1, float(np.clip(position - nodes[i], 0.0, system.lengths[i]))
