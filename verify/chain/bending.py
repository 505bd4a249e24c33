"""A cantilever of rigid links under a large dead load at its tip: where its joints come to lie."""

from dataclasses import replace

import numpy as np
from msgspec import structs

from verify.beam import Beam
from verify.chain.load_path import led_to
from verify.chain.system import LinkLoad, build_system
from verify.chain.work import STATIC_LINKS, check_links
from verify.checks import check_number, check_whole, check_word
from verify.errors import InputError, shown
from msgspec import Struct
from verify.models.arrays import Array
from verify.models.places import Numbers, as_typed, in_a_row
from verify.options import JOINTS, Joints, Wall
from verify.segments.linear import check


class Bent(Struct, frozen=True, eq=False, kw_only=True):
    """A cantilever of rigid links in equilibrium, clamped at x = 0; x along the straight beam, y across it."""

    beam: Beam
    """As it was given."""
    count: int
    """Segments N."""
    joints: Array
    """(N + 1, 2), metres: (x, y) from the clamp to the tip."""
    angles: Array
    """(N,), radians: of every link from the straight beam, as the beam is turned at the link's middle."""
    turn: float
    """Radians: of the tip, half a link beyond the last link's middle, which the applied moment bends."""
    moments: Array
    """(N + 1,), N m: carried by every joint, the applied one at the tip."""
    curvature: Array
    """(N + 1,), 1/m: moment over EI there, of the piece on the right where two meet."""
    energy: float
    """Elastic energy, joules: of the joints, and of the half link up to the tip under the applied moment."""

    @property
    def tip(self) -> Array:
        """(2,), metres: (x, y) of the free end."""
        return np.asarray(self.joints[-1])

    @property
    def deflection(self) -> float:
        """Y of the tip, metres."""
        return float(self.joints[-1, 1])

    @property
    def shortening(self) -> float:
        """By how much the tip has come back along x, metres."""
        return self.beam.length - float(self.joints[-1, 0])


@as_typed
def bend(
    beam: Beam,
    count: int,
    load: Numbers = 0.0,
    *,
    moment: float = 0.0,
    wall: Wall = "gregory",
    joints: Joints = "series",
) -> Bent:
    """A cantilever of `count` links under a dead `load` (newton) and a `moment` (N m) at its tip, however large.

    `load` is one number across the straight beam, or a pair (along, across); it keeps its direction as the beam bends.
    A load that follows the tip has no place in the chain's statics. The reference is the elastica (K. E. Bisshopp and
    D. C. Drucker, Quart. Appl. Math. 3 (1945) 272), approached with order 2 in `count` by tip, turn and energy. A joint
    stands for the half links on either side; the half link up to the tip has none, and bends under `moment` alone: its
    part of turn and energy is added. Under a moment alone both are exact, and with wall = "half" the circle closes.
    Beyond the buckling load, where a chain has several equilibria, the load grows from nothing, and the equilibrium is
    the stable one that it leads to. Raises InputError for supports other than clamped and free, what stands on the
    beam, a push along alone beyond the buckling load, and where no equilibrium is found.
    """
    _check_cantilever(beam, joints)
    check_whole("count", count, 2)
    along, across = _along_and_across(load)
    check_number("moment", moment, "N m")
    check_links(count, 2, STATIC_LINKS, "an equilibrium takes a time in proportion to its links")
    check(beam, 1, count, wall=wall, joints=joints)
    system = build_system(structs.replace(beam, loss_factor=0.0), count, wall=wall, joints=joints)
    end = LinkLoad(link=count, at=float(system.lengths[-1]), force=(along, across), moment=float(moment))
    turned = led_to(replace(system, loads=(end,)), along, across, float(moment))
    angles, moments = np.cumsum(turned), np.append(system.stiffness * turned, moment)
    steps = system.lengths[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    curvature = moments / _stiffness_at(beam, system.nodes)
    beyond = 0.5 * float(system.lengths[-1] * curvature[-1])
    return Bent(
        beam=beam,
        count=count,
        joints=np.vstack([np.zeros(2), np.cumsum(steps, axis=0)]),
        angles=angles,
        turn=float(angles[-1]) + beyond,
        moments=moments,
        curvature=curvature,
        energy=0.5 * (float(moments[:-1] @ turned) + moment * beyond),
    )


def _check_cantilever(beam: Beam, joints: Joints) -> None:
    """Raise InputError for a beam and joints that are not bent."""
    if beam.supports != ("clamped", "free"):
        raise InputError(f"beam.supports = {beam.supports!r}: bend takes a cantilever, give ('clamped', 'free')")
    if beam.tension:
        raise InputError(f"beam.tension = {beam.tension!r} N: bend takes it as load = (along, across), leave it out")
    check_word("joints", joints, JOINTS)
    if joints == "tensioned":
        raise InputError("joints = 'tensioned' are of a beam.tension, bend has none: give 'series' or 'printed'")


def _along_and_across(load: Numbers) -> tuple[float, float]:
    """The parts of a load, newton. Raises InputError."""
    force = in_a_row("load", load, "newton")
    if force.shape not in ((1,), (2,)):
        raise InputError(f"load = {shown(load)}: give one number across the beam, or two, along and across (newton)")
    return (float(force[0]), float(force[1])) if len(force) == 2 else (0.0, float(force[0]))


def _stiffness_at(beam: Beam, x: Array) -> Array:
    """EI at places of the straight beam, (n,), of the piece on the right where two meet."""
    starts = np.cumsum([0.0, *(piece.length for piece in beam.pieces[:-1])])
    values = np.array([piece.bending_stiffness for piece in beam.pieces])
    return np.asarray(values[np.searchsorted(starts, x + 1e-12 * beam.length, side="right") - 1])
