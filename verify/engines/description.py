"""A beam as a chain of rigid bodies in plain units, for engines of multibody dynamics.

x is along the beam, z the deflection across its thickness, y across its width. N rigid links, N + 1 joints: joint 0
between the wall and link 0, joint j between links j - 1 and j, joint N between the last link and what is behind the far
end. In space every joint has hinges for both bending planes and for torsion. Angles are relative: a hinge turns all
links beyond it. A pinned or clamped end is fixed in z (and y) and free along x; every support prevents the twist.
Attached bodies and springs are fixed to their rigid link, half to either link where they turn at a joint; a body is
part of the mass, centre and inertia of its link.

The joints in bending are those of `SegmentModel`. In torsion a link is a disk at the centre of its inertia, between
springs GJ/l, 2GJ/l at a wall: order 2 by reflection at both kinds of ends, the leading relative error is -(k l)^2/24
at the wavenumber k without attached bodies and springs.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from math import pi
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import msgspec
import numpy as np

from verify.arrays import Array
from verify.errors import InputError
from verify.exact.torsion import shafts, torsion_hz
from verify.formatting import one_line
from verify.problem.beam import Beam, check_features, in_plane, with_attachments
from verify.problem.cross_section import merged, set_fields
from verify.problem.point_attachments import PointSpring
from verify.problem.supports import FIXED
from verify.settings import WALLS, Theory
from verify.validation import check_choice, check_integer, check_number, check_type

if TYPE_CHECKING:
    from verify.engines.steps import Simulated

Axis = Literal["bending", "width", "torsion", "coupled"]
AXES: tuple[Axis, ...] = ("bending", "width", "torsion")
"""Rotation about -y, z and x; deflections in z and y. All are "coupled" in a chain that is curved at rest."""
MOST_LINKS = 2000
"""Largest N: the matrices are dense."""
DENSE = 150
"""N from which a few modes take less time by Lanczos' method than all of them."""


class Hinge(msgspec.Struct, frozen=True):
    """A rotation about one axis with its spring, N m/rad (0 is free), its dashpot, N m s, and its armature, kg m^2."""

    axis: Axis
    stiffness: float
    damping: float = 0.0
    armature: float = 0.0


class Steps(NamedTuple):
    """The time step, s, for which a chain is made, and the integrator, by the names of `integrators`."""

    step: float
    engine: str
    integrator: str = ""


class Joint(msgspec.Struct, frozen=True):
    """A joint at x = `position`, m; without hinges it is rigid."""

    position: float
    hinges: tuple[Hinge, ...]

    def hinge(self, axis: Axis) -> Hinge | None:
        """The hinge about an axis."""
        return next((hinge for hinge in self.hinges if hinge.axis == axis), None)


class Link(msgspec.Struct, frozen=True):
    """A rigid link with its bodies from x = `start`, m: centre of mass from there, inertia about it, kg m^2.

    `off`: y and z of the centre of mass of a piece of a curve, m.
    """

    start: float
    length: float
    mass: float
    centre: float
    inertia: tuple[float, float, float]
    off: tuple[float, float] = (0.0, 0.0)


class Spring(msgspec.Struct, frozen=True):
    """A spring, N/m, and a dashpot, N s/m, from a link to the ground along z, or `rotational` about y, N m, N m s."""

    position: float
    link: int
    rotational: bool
    stiffness: float
    damping: float = 0.0


@dataclass(frozen=True, eq=False)
class RigidChain:
    """N + 1 joints, N links, springs to the ground, and the frequencies of exactly this chain.

    `beam` runs from joint 0 on; `mirrored`: joint 0 is at the right end of the scene's beam. `wall`: rule of the joints
    at a clamped end. `damping`: ratio of the first mode about every axis; that of others is in proportion to frequency.
    `theory`: of the exact beam. `viscosity`, N s/m^2, of MuJoCo's medium: drag. `steps`: for which it is made, with
    what holds for them in `remarks`; `meant`: without their armature and compensation.
    """

    beam: Beam
    wall: str
    joints: tuple[Joint, ...]
    links: tuple[Link, ...]
    springs: tuple[Spring, ...] = ()
    damping: float = 0.0
    in_space: bool = False
    mirrored: bool = False
    theory: Theory = "euler-bernoulli"
    viscosity: float = 0.0
    steps: Steps | None = None
    remarks: tuple[str, ...] = ()
    meant: "RigidChain | None" = None
    straight, parts, along, reference = True, "links", "the beam", "the exact beam"
    __repr__ = one_line(count="links", wall="", theory="", damping="")

    @property
    def count(self) -> int:
        """N."""
        return len(self.links)

    @property
    def axes(self) -> tuple[Axis, ...]:
        """Axes of the hinges."""
        return AXES if self.in_space else AXES[:1]

    @property
    def motions(self) -> tuple[Axis, ...]:
        """Axes that vibrate apart."""
        return self.axes

    def drawn(self, j: int) -> tuple[float, float]:
        """Width and thickness of a link, or twice its diameter, m; a hundredth of the length where unknown."""
        ends, beam = np.cumsum([section.length for section in self.beam.section[:-1]]), self.beam
        at = int(np.searchsorted(ends, self.links[j].start + self.links[j].centre))
        fields = merged(beam.section[at], beam) if beam.section else set_fields(beam)
        width, thick = (fields.get(one, fields.get("diameter", 0.01 * beam.length)) for one in ("width", "thickness"))
        return width, thick

    def rest_angle(self, j: int) -> float:
        """Rotation between the links at a joint, rad, 0 at the wall."""
        first, last = self.rest(j)[1]
        return (j > 0) * float(2.0 * np.arcsin(min(np.linalg.norm(first @ last - np.eye(3)) / 8.0**0.5, 1.0)))

    def rest(self, j: int) -> tuple[Array, Array]:
        """(place of joint j in the link before, m, rotations from there to its axes and on to its link) at rest."""
        x = self.links[j - 1].length if j else self.joints[0].position
        return np.array([x, 0.0, 0.0]), np.stack([np.eye(3)] * 2)

    @property
    def supported(self) -> tuple[bool, bool]:
        """Whether each end has no deflection."""
        left, right = (FIXED[support].deflection for support in self.beam.supports)
        return left, right

    def unknowns(self, axis: Axis) -> list[tuple[str, int, float]]:
        """(name, joint, stiffness): the deflection of joint 0 where that is free, then hinges in front of links."""
        slide = [] if self.supported[0] or axis == "torsion" else [(f"slide_{axis}", 0, 0.0)]
        every = [(j, joint.hinge(axis)) for j, joint in enumerate(self.joints[:-1])]
        return slide + [(f"joint{j}_{axis}", j, hinge.stiffness) for j, hinge in every if hinge]

    def rows(self, axis: Axis, links: Any, x: Any) -> tuple[Array, Array]:
        """(deflections, rotations) of points x (m) of links by the `unknowns`, (p, n) each."""
        names, joints, _ = zip(*self.unknowns(axis), strict=True)
        slides = np.array([name.startswith("slide") for name in names])
        turned = (np.array(joints) <= np.asarray(links)[:, None]) * (1.0 - slides)
        return turned * (np.asarray(x)[:, None] - [self.joints[j].position for j in joints]) + slides, turned

    def constraints(self, axis: Axis) -> Array:
        """Rows over the unknowns that the supports of the far end make zero, (0 to 2, n)."""
        across, turned = self.rows(axis, [self.count - 1], [self.joints[-1].position])
        rows = [across] if self.supported[1] and axis != "torsion" else []
        rows += [] if self.joints[-1].hinge(axis) else [turned]
        return np.vstack([across[:0], *rows])

    def matrices(self, axis: Axis = "bending") -> tuple[Array, Array]:
        """(mass, stiffness) over the `unknowns`, without the constraints, (n, n)."""
        about = {"bending": 1, "width": 2, "torsion": 0}[axis]
        x, masses, inertias = np.array([(k.start + k.centre, k.mass, k.inertia[about]) for k in self.links]).T
        across, turned = self.rows(axis, range(self.count), x)
        mass = (turned.T * inertias) @ turned
        if axis != "torsion":
            mass += (across.T * masses) @ across
        stiffness = np.diag([spring for *_, spring in self.unknowns(axis)])
        for _, row, spring, _ in self.grounded(axis):
            stiffness += spring * np.outer(row, row)
        return mass, stiffness

    @property
    def closed(self) -> bool:
        """Whether the far end has a support, or a spring acts between a link and the ground."""
        return any(len(self.constraints(axis)) or [*self.grounded(axis)] for axis in self.axes)

    def grounded(self, axis: Axis) -> Iterator[tuple[str, Array, float, float]]:
        """(name, row over the unknowns, stiffness, damping) of springs to the ground and of joint N."""
        for i, spring in enumerate(self.springs if axis == "bending" else ()):
            across, turned = self.rows(axis, [spring.link], [spring.position])
            yield f"spring{i}", (turned if spring.rotational else across)[0], spring.stiffness, spring.damping
        if (far := self.joints[-1].hinge(axis)) and far.stiffness:
            row = self.rows(axis, [self.count - 1], [self.joints[-1].position])[1][0]
            yield f"joint{self.count}_{axis}", row, far.stiffness, far.damping

    def frequencies_hz(self, axis: Axis = "bending", n_modes: int | None = None) -> Array:
        """Elastic frequencies of the chain, (n_modes,) or all, ascending, Hz."""
        return _frequencies(self, axis, n_modes if self.count > DENSE and n_modes else None)[:n_modes]

    def exact_hz(self, axis: Axis = "bending", n_modes: int = 3) -> Array:
        """Frequencies of the exact beam by `theory`, or of its shaft, (n_modes,), Hz."""
        if axis == "torsion":
            left, right = (support != "free" for support in self.beam.supports)
            bodies = [(one.position, one.rotary_inertia) for one in self.beam.attached if one.massive]
            return torsion_hz(shafts(self.beam), (left, right), n_modes, bodies)
        from verify.analytic_modes import ExactModel

        exact = ExactModel(in_plane(self.beam, axis), self.theory)
        return np.array([exact.frequency_hz(mode) for mode in range(1, n_modes + 1)])

    def errors(self, axis: Axis = "bending", n_modes: int = 3) -> Array:
        """Relative errors of the first frequencies against the exact beam, (n_modes,)."""
        hertz = self.frequencies_hz(axis, n_modes)
        return np.asarray(hertz / self.exact_hz(axis, len(hertz)) - 1.0)

    def drag(self, axis: Axis = "bending") -> Array:
        """Dashpots of the `viscosity` over the `unknowns`, by the inertia box of every link as in MuJoCo, (n, n)."""
        x, mass, inertia = zip(*((k.start + k.centre, k.mass, k.inertia) for k in self.links), strict=True)
        sides = np.sqrt(np.maximum(6.0 * (np.array(inertia) @ (1.0 - 2.0 * np.eye(3))) / np.array(mass)[:, None], 0.0))
        across, turned = self.rows(axis, range(self.count), x)
        size = pi * self.viscosity * sides.mean(axis=1)
        moved = (across.T * 3.0 * size) @ across * (axis != "torsion")
        return np.asarray(moved + (turned.T * size * sides.mean(axis=1) ** 2) @ turned)

    def simulated(self, step: float, engine: str, setting: str = "", axis: Axis | None = None) -> "Simulated":
        """Damped modes, multipliers and stability limit in an engine's steps, s, by a setting of `integrators`.

        About all axes or one, with the armature of its hinges. Raises InputError for an unknown engine or setting.
        """
        from verify.engines.integrators import scheme_of
        from verify.engines.steps import simulated_chain

        return simulated_chain(self, step, scheme_of(engine, setting), axis)


@lru_cache(maxsize=16)
def _frequencies(chain: RigidChain, axis: Axis, few: int | None = None) -> Array:
    """`RigidChain.frequencies_hz`: all, or a `few` of a chain from a wall on."""
    springs = np.array([spring for *_, spring in chain.unknowns(axis)])
    if few and few < chain.count // 4 and not chain.closed and springs.all():
        from scipy.sparse.linalg import eigsh

        mass, root = chain.matrices(axis)[0], 1.0 / np.sqrt(springs)
        flexible = eigsh(mass * np.outer(root, root), few, return_eigenvectors=False, v0=root)
        return np.asarray(np.sort(0.5 / (pi * np.sqrt(flexible))))
    loose = int(set(chain.beam.supports) == {"free"}) if axis == "torsion" else in_plane(chain.beam, axis).rigid_motions
    return small_motion_hz(*chain.matrices(axis), chain.constraints(axis), loose)


def small_motion_hz(mass: Array, stiffness: Array, constraints: Array, loose: int = 0) -> Array:
    """Elastic natural frequencies, ascending, Hz, of matrices (n, n) whose unknowns `constraints` (m, n) make zero.

    The largest eigenvalues of the inverse problem are the lowest modes without loss of digits; a shift makes the
    stiffness of a system with `loose` rigid-body motions positive definite. Raises InputError within rounding.
    """
    from scipy.linalg import LinAlgError, eigh, null_space

    if len(constraints):
        basis = null_space(constraints)
        mass, stiffness = basis.T @ mass @ basis, basis.T @ stiffness @ basis
    try:
        shift = eigh(stiffness, mass, eigvals_only=True, subset_by_index=[loose, loose])[0] if loose else 0.0
        values = eigh(mass, stiffness + shift * mass, eigvals_only=True)[::-1][loose:]
        if (values <= 0.0).any() or (values * shift > 1.0).any():
            raise LinAlgError
    except LinAlgError:
        text = "beam: frequencies of its chain are within rounding: give sections that differ less"
        raise InputError(text) from None
    return np.asarray(np.sqrt(1.0 / values - shift) / (2.0 * pi))


def rigid_chain(
    made: Callable[..., Any], beam: Beam, count: int, wall: str, in_space: bool = False, damping: float = 0.0
) -> RigidChain:
    """`describe` with the chain `made` by `SegmentModel` in each plane."""
    check_type("beam", beam, Beam)
    check_features(beam, "a chain for an engine", ("section", "attached"), "give forces in the engine")
    check_choice("wall", wall, [name for name, rule in WALLS.items() if not rule.first])
    check_integer("count", count, 2, MOST_LINKS)
    check_number("damping", damping, "damping ratio, 0 means none", at_least=0, below=1)
    first, last = ((sum(FIXED[support]), FIXED[support].deflection) for support in beam.supports)
    if mirrored := first < last:
        beam = beam.mirrored()
    turning = [one.position for one in beam.attached if one.rotary_inertia]
    # a spring behind an end is in series with the joints of a wall, order 4; others act on their link
    behind = [s for s in beam.attached if s.rotational and s.position in {0.0, beam.length} - {*turning}]
    series = tuple(PointSpring(position=s.position, rotational=s.rotational) for s in behind)
    unloaded, rule = with_attachments(beam, spring=series), WALLS[wall]
    linear = "full" if rule.fault else wall  # `SegmentModel` has no rule that is a fault: its weight follows below
    models = {a: made(in_plane(unloaded, a), count, wall=linear) for a in AXES[: 1 + in_space]}
    chain, parts, unit = models["bending"].chain, models["bending"].links, models["bending"].unit
    springs = {axis: m.beam.bending_stiffness / unit / m.chain.compliances for axis, m in models.items()}
    walls = [end for end, support in zip((0, count), beam.supports, strict=True) if support == "clamped" and rule.fault]
    fixed = [] if rule.weights[0] else walls
    for stiffness in springs.values() if not fixed else ():
        stiffness[walls] /= rule.weights[0]
    lengths, sections = parts.lengths * unit, np.zeros((count, 3))
    masses = lengths * parts.masses_per_length * beam.mass_per_length
    bodies = [
        (link, m.position - chain.nodes[link], share * m.mass, share * m.rotary_inertia)
        for m in beam.attached
        if m.massive
        for link, share in _shares(chain, m.position, m.rotary_inertia)
    ]
    if in_space:
        twist, spin = np.repeat(shafts(beam)[:, 1:], parts.shares, axis=0).T
        sections = np.stack([spin, *(model.links.of("rotary_inertia") for model in models.values())], axis=1)
        springs["torsion"] = _torsion_springs(lengths, twist, spin * lengths, bodies, beam.supports)
    inertias = np.outer(masses * lengths**2 / 12.0, [not in_space, 1.0, 1.0]) + sections * lengths[:, None]
    centres = 0.5 * lengths
    for link, x, mass, inertia in bodies:
        share, apart = mass / (masses[link] + mass), x - centres[link]
        inertias[link] += inertia + share * masses[link] * apart**2 * np.array([0.0, 1.0, 1.0])
        centres[link] += share * apart
        masses[link] += mass
    nodes, values = chain.nodes.tolist(), {axis: k.tolist() for axis, k in springs.items()}
    hinges = [() if j in fixed else tuple(Hinge(a, k[j]) for a, k in values.items()) for j in range(count + 1)]
    sizes = (values.tolist() for values in (lengths, masses, centres))
    links = tuple(map(Link, nodes, *sizes, map(tuple, inertias.tolist())))
    ground = tuple(_ground_springs(beam, chain, {spring.position for spring in behind}))
    theory: Theory = "rayleigh" if in_space else "euler-bernoulli"
    rigid = RigidChain(beam, wall, tuple(map(Joint, nodes, hinges)), links, ground, 0.0, in_space, mirrored, theory)
    times = {axis: damping / (pi * float(rigid.frequencies_hz(axis, 1)[0])) for axis in rigid.axes if damping}
    return with_dashpots(rigid, times, damping) if damping else rigid


def _ground_springs(beam: Beam, chain: Any, behind: set[float]) -> Iterator[Spring]:
    """Springs between links and the ground; rotational ones at positions `behind` an end are in its joint."""
    for spring in beam.attached:
        turning = 0.0 if spring.position in behind else spring.rotational
        for link, share in _shares(chain, spring.position, turning):
            for rotational, k in ((False, spring.stiffness), (True, turning)):
                if k:
                    yield Spring(spring.position, link, rotational, share * k)


def _torsion_springs(lengths: Array, twist: Array, spin: Array, bodies: list[Any], supports: Sequence[str]) -> Array:
    """Joints in torsion, (N + 1,), N m/rad, of links with GJ `twist` (N m^2) and polar inertia `spin` (kg m^2).

    A disk is at the centre of the inertia of its link and of the bodies on it: order 1 otherwise.
    """
    spin, moment = spin.copy(), np.zeros(len(spin))
    for link, x, _, inertia in bodies:
        spin[link] += inertia
        moment[link] += inertia * (x - 0.5 * lengths[link])
    before, after = ((0.5 * lengths + sign * moment / spin) / twist for sign in (1.0, -1.0))
    before[0] = before[0] if supports[0] != "free" else np.inf
    after[-1] = after[-1] if supports[1] != "free" else np.inf
    return np.asarray(1.0 / (np.append(before, 0.0) + np.append(0.0, after)))


def with_dashpots(chain: RigidChain, times: dict[Axis, float], ratio: float) -> RigidChain:
    """The chain with dashpots over springs of `times`, s, by which the first mode about every axis has `ratio`."""

    def damped(spring: Any, axis: Axis) -> Any:
        return msgspec.structs.replace(spring, damping=times[axis] * spring.stiffness)

    joints = tuple(Joint(joint.position, tuple(damped(h, h.axis) for h in joint.hinges)) for joint in chain.joints)
    return replace(chain, joints=joints, springs=tuple(damped(s, "bending") for s in chain.springs), damping=ratio)


def _shares(chain: Any, position: float, turning: float) -> list[tuple[int, float]]:
    """(link, share) of an attachment: half to both links at a joint where it turns."""
    from verify.segments.attachments import link_at

    links, along = link_at(chain, np.array([position]))
    link = int(links[0])
    return [(link - 1, 0.5), (link, 0.5)] if turning and along[0] == 0.0 and link else [(link, 1.0)]
