"""How far a nonlinear chain departs from the linear one through its axial inertia, from rest and undamped.

Rigid links cannot stretch, so that bending draws the tip in and takes the mass of the chain along: an inertia of
relative size (kL)^2 <theta^2>, which grows with the square of the force, whatever the amplitude is in thicknesses.
Links that stretch as the beam does (EA / l) have it too, less or more of it.
"""

from math import ceil
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.chain.confirmed import confirm_stretching
from verify.chain.dynamics import at_rest
from verify.chain.from_rest import point_forces
from verify.chain.problems import Progress, transient, unheard
from verify.chain.result import ChainMotion
from verify.chain.splitting import linear_deflection, modal_basis
from verify.chain.stretching import simulate_elastic
from verify.chain.system import axial_stiffness, build_system
from verify.chain.work import MOST, check_kept, check_modes_of
from verify.errors import InputError, written
from verify.models.arrays import Array
from verify.options import Inertia

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

Links = Inertia
"""Rigid links; rigid links without inertia along x; links of the beam's own EA / l."""
SAMPLES, SAMPLES_PER_PERIOD = 1001, 40
"""Kept at least, and in a period of the drive."""
TOLERANCE = 1e-10
"""Of the adaptive step: the smallest departure asked for lies far above what it leaves."""

STILL = 1e-9
"""A place moves less than this share of the free beam's answer as a whole, 1 / (m omega^2), by rounding alone."""

TENTHS = 10
"""Parts of the beam, between which the departure is read too."""

TURNED = 0.3
"""Radians in the rms: links that turn further are no driven beam."""


class Departure(msgspec.Struct, frozen=True, kw_only=True):
    """How far a chain's deflection lies from the linear chain's at one place, over the linear one's rms there."""

    at_end: float
    """At the end of the run."""
    rms: float
    """Over the run."""


class Driven(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A chain from rest under harmonic forces, read at one place."""

    beam: Beam
    forces: tuple[PointForce, ...]
    """Their amplitudes are those of each run."""
    frequency_hz: float
    count: int
    x: float
    """Metres from the left end."""
    times: Array
    """(n,), evenly from 0, seconds."""

    def under(self, force: float) -> tuple[PointForce, ...]:
        """The forces with an amplitude in newton."""
        return tuple(replace(one, amplitude=force) for one in self.forces)


def driven_chain(scene: "Scene", who: str, count: int, duration: float, x: float | None) -> Driven:
    """The scene's beam as a chain for `duration` seconds, read at mid-span unless `x` is given. Raises InputError."""
    forces = point_forces(scene, who)
    assert scene.drive is not None
    frequency = scene.drive.frequency_hz
    n = max(SAMPLES, ceil(SAMPLES_PER_PERIOD * frequency * duration) + 1)
    check_kept(n, count, f"time = {written(duration)} s at drive.frequency_hz = {frequency!r}")
    check_modes_of(count, 2 if scene.beam.supports[1] == "pinned" else 1)
    place = 0.5 * scene.beam.length if x is None else x
    if place > scene.beam.length:
        raise InputError(f"x = {x!r} lies off the beam: give a place between 0 and {scene.beam.length!r} m")
    return Driven(
        beam=scene.beam,
        forces=forces,
        frequency_hz=frequency,
        count=count,
        x=place,
        times=np.linspace(0.0, duration, n),
    )


def linear_chain(driven: Driven) -> Array:
    """Deflection of the linear chain for 1 N, exact in time, (n,), metres. Raises InputError where it is none."""
    system = build_system(driven.beam, driven.count, driven.under(1.0), driven.frequency_hz)
    found = linear_deflection(modal_basis(system), at_rest(system), driven.times, driven.x)
    if not _moves(driven, found):
        raise InputError(f"x = {driven.x!r}: the beam does not move there under these forces; give another place")
    return found


def _moves(driven: Driven, unit: Array) -> bool:
    """Whether a deflection for 1 N is more than rounding."""
    mass = sum(piece.mass_per_length * piece.length for piece in driven.beam.pieces)
    return rms(unit) >= STILL / (mass * (2.0 * np.pi * driven.frequency_hz) ** 2)


def rigid_chain(
    driven: Driven, force: float, *, axial_inertia: bool = True, progress: Progress = unheard
) -> ChainMotion:
    """The nonlinear chain of rigid links, converged in time. Raises InputError."""
    motion = transient(
        driven.beam,
        driven.under(force),
        driven.frequency_hz,
        driven.times.tolist(),
        driven.count,
        axial_inertia=axial_inertia,
        tolerance=TOLERANCE,
        progress=progress,
    )
    turned = rms(motion.directions())
    if turned > TURNED:
        raise InputError(f"under {force!r} N the links turn by {turned:.2g} rad in the rms: give a smaller force")
    return motion


def elastic_chain(driven: Driven, force: float) -> Array:
    """Deflection of the chain whose links stretch as the beam does, (n,), metres. Raises InputError."""
    system = build_system(driven.beam, driven.count, driven.under(force), driven.frequency_hz)
    motion = simulate_elastic(system, axial_stiffness(driven.beam, driven.count), driven.times, most=MOST)
    if not motion.finished and not motion.statistics.interrupted:
        raise InputError(f"the stretching chain under {force!r} N {motion.statistics.stopped}: give a smaller force")
    confirm_stretching(motion, MOST)
    return np.asarray(motion.deflection([driven.x])[:, 0])


def chain_deflection(driven: Driven, force: float, links: Links, progress: Progress = unheard) -> Array:
    """Deflection of one nonlinear chain, (n,), metres. Raises InputError."""
    if links == "elastic":
        return elastic_chain(driven, force)
    motion = rigid_chain(driven, force, axial_inertia=links == "full", progress=progress)
    return np.asarray(motion.deflection([driven.x])[:, 0])


def departure(driven: Driven, force: float, links: Links, progress: Progress = unheard) -> Departure:
    """How far one nonlinear chain lies from the linear one. Raises InputError."""
    return departure_of(chain_deflection(driven, force, links, progress), force * linear_chain(driven))


def along_the_beam(driven: Driven, motion: ChainMotion, force: float) -> tuple[float, float]:
    """Least and largest departure at the end of a motion, at the tenths of the beam that move. Raises InputError."""
    places = [driven.x, *(np.arange(1, TENTHS) * driven.beam.length / TENTHS).tolist()]
    system = build_system(driven.beam, driven.count, driven.under(1.0), driven.frequency_hz)
    basis, start = modal_basis(system), at_rest(system)
    units = [linear_deflection(basis, start, driven.times, x) for x in places]
    found = [
        departure_of(line, force * unit).at_end
        for line, unit in zip(motion.deflection(places).T, units, strict=True)
        if _moves(driven, unit)
    ]
    return min(found), max(found)


def departure_of(deflection: Array, linear: Array) -> Departure:
    """The difference of two deflections (n,) at the end and in the rms, over the second's rms.

    Raises InputError where the second is nothing that squares can be made of.
    """
    gap, scale = deflection - linear, rms(linear)
    if not scale:
        raise InputError("force: under it the linear chain does not move where it is read, give a larger force or x")
    return Departure(at_end=float(abs(gap[-1])) / scale, rms=rms(gap) / scale)


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))
