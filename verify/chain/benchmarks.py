"""Benchmark problems of the nonlinear chain, and its departure from the linear chain by axial inertia.

Rigid links do not stretch: bending shortens the chain and accelerates its mass along x, an inertia of relative size
(kL)^2 <theta^2>, which grows with the square of the force. It is smaller for links that stretch with EA/l.
"""

from collections.abc import Sequence
from dataclasses import replace
from itertools import product
from math import ceil, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
from msgspec import structs

from verify.arrays import Array
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.motion import ChainMotion, Progress, check_moved, from_rest, simulate
from verify.chain.statics import bend
from verify.chain.system import ChainState, ChainSystem, LinkLoad, build_system, link_at, straight_chain
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.segments.chain import link_inertia
from verify.settings import Inertia, Links, Load, Tip, Wall
from verify.validation import check_integer, check_number

CANTILEVER = Beam(
    length=1.0, width=1.2, thickness=0.01, youngs_modulus=1e7, density=1000.0, supports=("clamped", "free")
)
EI, OMEGA = CANTILEVER.bending_stiffness, sqrt(CANTILEVER.bending_stiffness / CANTILEVER.mass_per_length)
"""EI of `CANTILEVER`, N m^2, and sqrt(EI / (rho A L^4)), rad/s."""
NODE = 1e-9
"""Displacement over that of the free beam, F / (m omega^2), below which a position is a node within rounding."""
START_PHASES = (0.0, 45.0, 90.0, 135.0)  # phases of the drive at the start, deg; 180 more mirrors the motion


def rollup_gap(count: int, wall: Wall = "half", turns: float = 1.0) -> float:
    """Distance between the ends over L of a cantilever under an end moment 2 pi EI / L times `turns`.

    Equal joints, with 2EI/l at the wall, close the circle exactly; Gregory's weights leave a gap.
    """
    return float(np.hypot(*bend(CANTILEVER, count, moment=2.0 * pi * turns * EI, wall=wall).tip))


def hanging_frequency(mode: int, count: int) -> float:
    """Natural frequency omega sqrt(L / g) of uniform links without springs that hang from a pin.

    sqrt(3/2) for one link; it converges to j_{0,n} / 2 (Daniel Bernoulli) with order 2. Raises InputError for more
    modes than links.
    """
    check_integer("segments", count, mode)
    unit, zero = np.full(count, 1.0 / count), np.zeros(count)
    links = {"lengths": unit, "masses": unit, "inertias": link_inertia(unit, unit)}
    system = ChainSystem(**links, stiffness=zero, dashpots=zero, gravity=(1.0, 0.0))
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1])


def rotating_frequency(mode: int, count: int, speed: float) -> float:
    """Lead-lag frequency omega sqrt(rho A L^4 / EI) of a rotating cantilever, hub speed `speed` in the same unit.

    Its square is the square of the flapping frequency less that of the speed (A. D. Wright et al., J. Appl. Mech. 49
    (1982) 197). Order 2, due to the centrifugal force. Raises InputError for more modes than links.
    """
    check_integer("segments", count, mode)
    system = replace(build_system(CANTILEVER, count), hub_rate=speed * OMEGA)
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1]) / OMEGA


def _sine_shape(
    beam: Beam, count: int, amplitude: float, axial_spring: float = 0.0
) -> tuple[ChainSystem, ChainState, float]:
    """(chain between hinges, state at rest with w = amplitude sin(pi x / L), first linear frequency, rad/s)."""
    if beam.supports != ("pinned", "pinned"):
        raise InputError(f"beam.supports = {list(beam.supports)!r}: this benchmark takes pinned ends, give those")
    check_integer("segments", count, 2)
    check_number("amplitude", amplitude / beam.length, "of the length at mid-span", above=0, at_most=0.1)
    system = replace(build_system(beam, count), axial_spring=axial_spring)
    rise = np.diff(amplitude * np.sin(pi * np.arange(count + 1) / count)) / system.lengths
    start = at_rest(system, np.diff(np.arcsin(rise), prepend=0.0))
    return system, start, float(linearise(system, at_rest(system)).frequencies()[0])


def large_amplitude_frequency(
    beam: Beam, amplitude: float, count: int, progress: Progress = lambda part: None
) -> float:
    """First frequency between immovable hinges over the linear one; `amplitude` in radii of gyration sqrt(I/A).

    The immovable end is a roller with an axial spring EA / L. S. Woinowsky-Krieger (J. Appl. Mech. 17 (1950) 35): q'' +
    q + a^2/4 q^3 = 0, which a chain of equal links obeys but for the square of its slopes. Raises InputError for a
    beam that is not uniform or not between hinges, and an amplitude below 1e-6 (rounding) or above L/10.
    """
    piece = beam.pieces[0]
    if not beam.uniform or piece.second_moment is None or piece.area is None:
        raise InputError("beam: this benchmark takes a uniform beam with a shape, sizes and youngs_modulus")
    check_number("amplitude", amplitude, "radii of gyration", at_least=1e-6)
    height = amplitude * sqrt(piece.second_moment / piece.area)
    system, start, linear = _sine_shape(beam, count, height, piece.axial_stiffness / beam.length)
    times = np.linspace(0.0, 1.01 * pi / 2 / linear, 801)
    motion = simulate(system, start, times, tolerance=1e-10, progress=progress)
    check_moved(motion)
    middle = motion.deflection([0.5 * beam.length], reading="links")[:, 0]
    k = int(np.argmax(middle <= 0.0))  # stiffer than linear: zero within a quarter of the linear period
    return pi / 2.0 / float(np.interp(0.0, [middle[k], middle[k - 1]], [times[k], times[k - 1]])) / linear


def energy_drift(
    beam: Beam, count: int, step: float | None = None, tolerance: float = 1e-8, progress: Progress = lambda part: None
) -> float:
    """Largest relative change of energy of an undamped roller-ended chain released from L/20 sin(pi x/L).

    Over a period of the linear first mode, by RK4 with `step` (s), adaptive for None. Raises InputError.
    """
    system, start, linear = _sine_shape(beam, count, 0.05 * beam.length)
    times = np.linspace(0.0, 2.0 * pi / linear, 65)
    motion = simulate(system, start, times, step=step, tolerance=tolerance, progress=progress)
    check_moved(motion)
    kinetic, elastic, _ = motion.energies()
    return float(abs(motion.residual()).max() / (kinetic + elastic)[0])


def energy_balance_error(count: int, tip: Tip, tolerance: float, progress: Progress = lambda part: None) -> float:
    """Largest residual of a chain's energy balance over its damping loss.

    Work is done by a hub that rotates, an eccentric harmonic load with a moment, and dashpots; the tip
    is free, or a roller with an axial spring.
    """
    check_integer("segments", count, 3)
    force, moment, hertz = (0.2 * EI, -0.4 * EI), 0.13 * EI, 0.9 * OMEGA
    load = LinkLoad(link=count, at=0.3 / count, force=force, moment=moment, frequency_hz=hertz, phase_deg=40.0)
    system = replace(
        build_system(CANTILEVER, count),
        dashpots=np.full(count, 0.03 * count * EI / OMEGA),
        tip=tip,
        axial_spring=40.0 * EI if tip == "roller" else 0.0,
        hub_rate=0.25 * OMEGA,
        loads=(load,),
    )
    times = np.linspace(0.0, 1.0 / OMEGA, 17)
    motion = simulate(system, at_rest(system), times, tolerance=tolerance, progress=progress)
    check_moved(motion)
    return float(abs(motion.residual()).max() / motion.states[-1, -2])


def contact_line_error(beam: Beam, mode: int, count: int, x: float) -> float:
    """Largest error of the contact line's slope in a mode on the piece at x, over the largest slope.

    Reference: the exact mode. Order 3, at a clamped wall 1.
    """
    from verify.analytic_modes import ExactModel
    from verify.segment_model import SegmentModel
    from verify.segments.reading import contact_line

    check_integer("segments", count, 2)
    system, exact = build_system(beam, count), ExactModel(beam)
    joints = SegmentModel(beam, count).modes(mode).readings["raw"]()[mode - 1]
    link, _ = link_at(system, x)
    edges, xi = system.nodes[link - 1 : link + 1], np.linspace(0.0, 1.0, 17)
    powers = contact_line(straight_chain(system), joints[None]).c[::-1, link - 1, 0] * np.ptp(edges) ** np.arange(4)
    slope = np.polynomial.polynomial.polyval(xi, np.polynomial.polynomial.polyder(powers)) / np.ptp(edges)
    error = slope - exact.mode_shape(mode, edges[0] + xi * np.ptp(edges), 1)
    return float(abs(error).max()) / float(abs(exact.mode_shape(mode, system.nodes, 1)).max())


def linear_deflection(system: ChainSystem, times: Array, x: float | Array) -> Array:
    """Deflection at x of the undamped linearised chain from rest by modal superposition, (n,) or (n, len(x)), m.

    On the straight links; for a straight system with transverse harmonic loads.
    """
    from scipy.linalg import eigh

    linear = linearise(system, at_rest(system))
    basis = linear.independent()
    values, vectors = eigh(basis.T @ linear.stiffness @ basis, basis.T @ linear.mass @ basis)
    modes, omega = basis @ vectors, np.sqrt(np.maximum(values, 0.0))

    def at(link: int, distance: float) -> Array:
        """Modal displacements of a point of a link."""
        arms = np.maximum(system.nodes[link - 1] + distance - system.nodes[:-1], 0.0)
        return np.asarray(modes.T @ (arms * (np.arange(system.n_links) < link)))

    turn = np.outer(times, omega)
    integral = times[:, None] * np.sinc(turn / pi)  # sin(omega t) / omega
    reading = np.array([at(*link_at(system, place)) for place in np.atleast_1d(x).tolist()])
    deflection = np.zeros((len(times), len(reading)))
    for load in system.loads:
        drive, phase = 2.0 * pi * load.frequency_hz, np.deg2rad(load.phase_deg)
        detuning, floor = omega**2 - drive**2, 1e-6 * drive**2
        detuning = np.where(abs(detuning) < floor, floor, detuning)
        share = reading * at(load.link, load.at) * load.force[1] / detuning
        free = np.cos(phase) * np.cos(turn) - drive * np.sin(phase) * integral
        deflection += np.outer(np.cos(drive * times + phase), share.sum(axis=1)) - free @ share.T
    return deflection if np.ndim(x) else deflection[:, 0]


def transient(
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    times: Sequence[float] | Array,
    count: int,
    *,
    load: Load = "reciprocal",
    inertia: Inertia = "full",
    tolerance: float = 1e-9,
    progress: Progress = lambda part: None,
) -> ChainMotion:
    """The chain from rest under harmonic forces; rigid links ("full", "transverse") or links that stretch ("elastic").

    Raises InputError for a run that diverges, and for large rotations that a second run does not confirm.
    """
    links: Links = "stretching" if inertia == "elastic" else "rigid"
    settings: dict[str, Any] = {"load": load, "axial_inertia": inertia != "transverse", "links": links}
    system = build_system(beam, count, forces, frequency_hz, **settings)
    return from_rest(system, np.asarray(times, dtype=float), tolerance=tolerance, progress=progress)


class Departure(NamedTuple):
    """Deflection of the nonlinear less the linear chain at one position, over the rms of the latter."""

    end: float  # value at the end of the run
    rms: float


def departure(
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    duration: float,
    count: int,
    *,
    x: float | None = None,
    load: Load = "lever",
    inertia: Inertia = "full",
    progress: Progress = lambda part: None,
) -> Departure:
    """Effect of axial inertia on the deflection at x (default: mid-span) from rest. Raises InputError at a node.

    Of the links of both chains.
    """
    x = 0.5 * beam.length if x is None else x
    times = np.linspace(0.0, duration, max(1001, ceil(40 * frequency_hz * duration) + 1))
    system = build_system(beam, count, forces, frequency_hz, load=load)
    linear = linear_deflection(system, times, x)
    largest = max(abs(load.force[1]) for load in system.loads)
    if not rms(linear) > NODE * largest / (system.masses.sum() * (2.0 * pi * frequency_hz) ** 2):
        raise InputError(f"x = {x!r}: these forces do not move the beam at this position, give another")
    settings: dict[str, Any] = {"load": load, "inertia": inertia, "progress": progress}
    motion = transient(beam, forces, frequency_hz, times, count, **settings, tolerance=1e-10)
    gap = motion.deflection([x], reading="links")[:, 0] - linear
    return Departure(float(abs(gap[-1])) / rms(linear), rms(gap) / rms(linear))


def departure_over_beam(
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    duration: float,
    count: int,
    *,
    load: Load = "lever",
    inertia: Inertia = "full",
    progress: Progress = lambda part: None,
) -> float:
    """Deflection of the nonlinear chain less the linear one's at the end of a run from rest, over the latter, rms.

    Over the joints, `START_PHASES` of the drive and the wave in either direction.
    """
    gaps, lines, times = [], [], np.array([0.0, duration])
    for sign, shift in product((1.0, -1.0), START_PHASES):
        drive = [structs.replace(force, phase_deg=sign * force.phase_deg + shift) for force in forces]
        system = build_system(beam, count, drive, frequency_hz, load=load)
        lines.append(linear_deflection(system, times, system.nodes[1:-1])[-1])
        motion = transient(beam, drive, frequency_hz, times, count, load=load, inertia=inertia, progress=progress)
        gaps.append(motion.deflection(system.nodes[1:-1].tolist(), reading="links")[-1] - lines[-1])
    return rms(np.array(gaps)) / rms(np.array(lines))


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))
