"""Departure of the nonlinear chain from the linear one by its axial inertia, from rest and undamped.

Rigid links cannot stretch, so that bending draws the tip in and takes the mass of the chain along: an inertia of
relative size (kL)^2 <theta^2>, which grows with the square of the force, whatever the amplitude is in thicknesses.
Links that stretch as the beam does (EA / l) have it too, less or more of it.
"""

from collections.abc import Callable

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array
from verify.chain.confirmed import confirm_stretching
from verify.chain.dynamics import at_rest, linearise
from verify.chain.problems import transient
from verify.chain.result import ChainMotion
from verify.chain.stretching import simulate_elastic
from verify.chain.system import ChainSystem, axial_stiffness, build_system, circular, link_at
from verify.errors import InputError
from verify.options import Inertia
from verify.problem.beam import Beam, PointForce

SAMPLES, SAMPLES_PER_PERIOD = 1001, 40
"""Least number of samples, and in a period of the drive."""
TOLERANCE = 1e-10
"""Of the adaptive step."""
STILL = 1e-9
"""Share of 1 / (m omega^2), the free beam's response, below which a place does not move but by rounding."""
TENTHS = 10
"""Parts of the beam at whose ends the departure is read too."""
TURNED = 0.3
"""Radians, rms: links that turn further are no driven beam."""


class Departure(msgspec.Struct, frozen=True, kw_only=True):
    """Difference of a chain's deflection from the linear chain's at one place, over the linear one's rms there."""

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

    def system(self, force: float) -> ChainSystem:
        """The chain under forces of that amplitude, newton. Raises InputError."""
        return build_system(self.beam, self.count, self.under(force), self.frequency_hz)


def linear_chain(driven: Driven) -> Array:
    """Deflection of the linear chain for 1 N, exact in time, (n,), metres. Raises InputError where it vanishes."""
    found = linear_deflection(driven.system(1.0), driven.times, driven.x)
    if not _moves(driven, found):
        raise InputError(f"x = {driven.x!r}: the beam does not move there under these forces; give another place")
    return found


def linear_deflection(system: ChainSystem, times: Array, x: float) -> Array:
    """Deflection of the linearised chain from rest, straight and undamped, by all its modes, (n,), metres.

    The system's loads are transverse and harmonic. Raises InputError for x off the chain.
    """
    from scipy.linalg import eigh

    if not 0.0 <= x <= system.length:
        raise InputError(f"x = {x!r} lies off the beam: give a place between 0 and {system.length!r} m")
    linear = linearise(system, at_rest(system))
    basis = linear.independent()
    values, vectors = eigh(basis.T @ linear.stiffness @ basis, basis.T @ linear.mass @ basis)
    modes, omega = basis @ vectors, np.sqrt(np.maximum(values, 0.0))

    def reach(link: int, at: float) -> Array:
        """Derivatives of the y of a point by the relative angles, (N,), metres."""
        nodes = system.nodes
        reached: Array = np.maximum(nodes[link - 1] + at - nodes[:-1], 0.0) * (np.arange(system.n_links) < link)
        return reached

    read, turn = modes.T @ reach(*link_at(system, x)), np.outer(times, omega)
    slow = omega == 0.0
    sines = np.where(slow, times[:, None], np.sin(turn) / np.where(slow, 1.0, omega))
    found = np.zeros(len(times))
    for load in system.loads:
        drive, phase = circular(load.frequency_hz), np.deg2rad(load.phase_deg)
        gap = omega**2 - drive**2
        floor = 1e-6 * drive**2
        share = read * (modes.T @ reach(load.link, load.at)) * load.force[1] / np.where(abs(gap) < floor, floor, gap)
        free = np.cos(phase) * np.cos(turn) - drive * np.sin(phase) * sines
        found += np.cos(drive * times + phase) * share.sum() - free @ share
    return found


def _moves(driven: Driven, unit: Array) -> bool:
    """Whether a deflection for 1 N is more than rounding."""
    mass = sum(piece.mass_per_length * piece.length for piece in driven.beam.pieces)
    return rms(unit) >= STILL / (mass * circular(driven.frequency_hz) ** 2)


def rigid_chain(
    driven: Driven,
    force: float,
    *,
    axial_inertia: bool = True,
    progress: Callable[[float], None] = lambda part: None,
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


def chain_deflection(
    driven: Driven, force: float, links: Inertia, progress: Callable[[float], None] = lambda part: None
) -> Array:
    """Deflection of a nonlinear chain with full, transverse or elastic axial inertia, (n,), metres.

    Raises InputError.
    """
    if links != "elastic":
        motion = rigid_chain(driven, force, axial_inertia=links == "full", progress=progress)
        return np.asarray(motion.deflection([driven.x])[:, 0])
    stretched = simulate_elastic(driven.system(force), axial_stiffness(driven.beam, driven.count), driven.times)
    confirm_stretching(stretched)
    return np.asarray(stretched.deflection([driven.x])[:, 0])


def departure(
    driven: Driven, force: float, links: Inertia, progress: Callable[[float], None] = lambda part: None
) -> Departure:
    """Departure of one nonlinear chain from the linear one. Raises InputError."""
    return departure_of(chain_deflection(driven, force, links, progress), force * linear_chain(driven))


def along_the_beam(driven: Driven, motion: ChainMotion, force: float) -> tuple[float, float]:
    """Least and largest departure at the end of a motion, at the tenths of the beam that move. Raises InputError."""
    places = [driven.x, *(np.arange(1, TENTHS) * driven.beam.length / TENTHS).tolist()]
    units = [linear_deflection(driven.system(1.0), driven.times, x) for x in places]
    found = [
        departure_of(line, force * unit).at_end
        for line, unit in zip(motion.deflection(places).T, units, strict=True)
        if _moves(driven, unit)
    ]
    return min(found), max(found)


def departure_of(deflection: Array, linear: Array) -> Departure:
    """Difference of two deflections (n,) at the end and in the rms, over the second's rms.

    Raises InputError where the second vanishes.
    """
    gap, scale = deflection - linear, rms(linear)
    if not scale:
        raise InputError("force: the linear chain does not move at x, give a larger force or another x")
    return Departure(at_end=float(abs(gap[-1])) / scale, rms=rms(gap) / scale)


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))
