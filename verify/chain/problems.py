"""Benchmark problems of the nonlinear chain, with references outside this package."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np

from verify.chain.confirmed import refuse_unknown
from verify.chain.dynamics import at_rest, linearise, positions, project
from verify.chain.result import ChainMotion
from verify.chain.statics import solve_static
from verify.chain.stepping import Method, simulate
from verify.chain.system import Actuator, ChainState, ChainSystem, LinkLoad, Rotation, build_system
from verify.errors import InputError
from verify.options import Tip, Wall
from verify.problem.beam import Beam, PointForce
from verify.segments.chain import link_inertia
from verify.validation import check_whole

Progress = Callable[[float], None]
"""Called with the fraction of a motion done, 0 to 1."""

LINEAR = 1e-6
"""Amplitude in radii of gyration up to which a chain is linear to 1e-13."""


@dataclass(frozen=True, kw_only=True)
class TipPlace:
    """Where a loaded tip stands, over the length."""

    deflection: float
    """w / L."""
    shortening: float
    """1 - x / L."""


def cantilever_tip(load: float, n_segments: int, wall: Wall = "gregory") -> TipPlace:
    """A cantilever's tip under a dead transverse force there, `load` = P L^2 / EI.

    The reference is the elastica by elliptic integrals: K. E. Bisshopp and D. C. Drucker, Quart. Appl. Math. 3 (1945)
    272. Order 2 in the number of segments. Raises InputError where no equilibrium is found.
    """
    check_whole("segments", n_segments, 1)
    system = build_system(UNIT_CANTILEVER, n_segments, wall=wall)
    at = float(system.lengths[-1])
    system = replace(system, loads=(LinkLoad(link=system.n_links, at=at, force=(0.0, load * UNIT_STIFFNESS)),))
    x, y = _tip(system)
    return TipPlace(deflection=y, shortening=1.0 - x)


def rollup_gap(n_segments: int, wall: Wall = "half", turns: float = 1.0) -> float:
    """Distance of the ends over L of a cantilever under an end moment 2 pi EI / L times `turns`.

    With equal joints, a wall joint 2EI/l among them, the circle closes exactly; Gregory's weights leave a gap. Raises
    InputError where no equilibrium is found.
    """
    check_whole("segments", n_segments, 1)
    system = build_system(UNIT_CANTILEVER, n_segments, wall=wall)
    moment = 2.0 * pi * turns * UNIT_STIFFNESS
    return float(np.hypot(*_tip(replace(system, loads=(LinkLoad(link=system.n_links, at=0.0, moment=moment),)))))


def _tip(system: ChainSystem) -> tuple[float, float]:
    x, y = positions(system, solve_static(system))[0][-1]
    return float(x), float(y)


UNIT_CANTILEVER = Beam(
    length=1.0, width=1.2, thickness=0.01, youngs_modulus=1e7, density=1000.0, supports=("clamped", "free")
)
UNIT_STIFFNESS = UNIT_CANTILEVER.bending_stiffness


def hanging_frequency(mode: int, n_segments: int) -> float:
    """Omega sqrt(L / g) of a chain of uniform links hanging from a pin, without springs.

    sqrt(3/2) for one link, j_{0,n} / 2 (Daniel Bernoulli) in the limit of many, approached with order 2. Raises
    InputError for more modes than links.
    """
    check_whole("segments", n_segments, mode)
    lengths, masses, still = (np.full(n_segments, value) for value in (1.0 / n_segments, 1.0 / n_segments, 0.0))
    system = ChainSystem(
        lengths=lengths,
        masses=masses,
        inertias=link_inertia(masses, lengths),
        stiffness=still,
        dashpots=still,
        gravity=(1.0, 0.0),
    )
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1])


def turning_frequency(mode: int, n_segments: int, speed: float, wall: Wall = "gregory") -> float:
    """Omega sqrt(rho A L^4 / EI) of a cantilever in the plane in which its clamp turns, `speed` in the same unit.

    Lead-lag: its square is that of the flapping beam less the speed's (A. D. Wright et al., J. Appl. Mech. 49 (1982)
    197, has flapping). Approached with order 2: the wave that bends is answered with order 4, the centrifugal pull with
    order 2. Raises InputError for more modes than links.
    """
    check_whole("segments", n_segments, mode)
    system = build_system(UNIT_CANTILEVER, n_segments, wall=wall)
    unit = sqrt(UNIT_STIFFNESS / UNIT_CANTILEVER.mass_per_length)
    system = replace(system, rotation=Rotation(rate=speed * unit))
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1]) / unit


def first_shape(system: ChainSystem, amplitude: float) -> ChainState:
    """At rest, the joints on amplitude sin(pi x / L), metres. Raises InputError where a link is too short for it."""
    heights = amplitude * np.sin(pi * np.arange(system.n_links + 1) / system.n_links)
    sines = np.diff(heights) / system.lengths
    if not (steepest := float(abs(sines).max())) < 1.0:
        raise InputError(
            f"amplitude: a link would rise by {steepest:.3g} of its own length, give a lower one or other segments"
        )
    theta = np.arcsin(sines)
    return at_rest(system, np.diff(theta, prepend=0.0))


def large_amplitude_frequency(
    beam: Beam, amplitude: float, n_segments: int, progress: Progress = lambda part: None
) -> float:
    """Frequency over the linear chain's, first mode between immovable hinges, `amplitude` in radii of gyration.

    The radius is sqrt(I / A); the immovable end is a roller with an axial spring EA / L. S. Woinowsky-Krieger (J.
    Appl. Mech. 17 (1950) 35): q'' + q + a^2/4 q^3 = 0, to which a chain of any number of equal links comes but for
    the square of its slopes. Raises InputError for an amplitude that the links do not reach, or below `LINEAR`, and for
    a beam that is not uniform, not between hinges, or damped.
    """
    if not abs(amplitude) >= LINEAR:
        raise InputError(f"amplitude = {amplitude!r} radii of gyration is not resolved, give at least {LINEAR:g}")
    _check_hinged(beam, n_segments)
    piece = beam.pieces[0]
    if not beam.uniform or piece.second_moment is None or piece.area is None:
        raise InputError("beam: this benchmark takes a uniform beam with a shape, sizes and youngs_modulus")
    height = amplitude * sqrt(piece.second_moment / piece.area)
    system = build_system(beam, n_segments, immovable=True)
    _check_height(height, system)
    linear = float(linearise(system, at_rest(system)).frequencies()[0])
    times = np.linspace(0.0, 1.01 * pi / 2 / linear, 801)
    motion = simulate(system, first_shape(system, height), times, tolerance=1e-10, ledger=False, progress=progress)
    _finished(motion)
    middle = motion.deflection([0.5 * beam.length])[:, 0]
    if not (k := int(np.argmax(middle <= 0.0))):
        raise InputError("amplitude: the middle is not back within a quarter of the linear period, give another one")
    crossing = float(np.interp(0.0, [middle[k], middle[k - 1]], [times[k], times[k - 1]]))
    return pi / 2.0 / crossing / linear


def _check_hinged(beam: Beam, n_segments: int) -> None:
    if beam.supports != ("pinned", "pinned"):
        raise InputError(f"beam.supports = {list(beam.supports)!r}: this benchmark is of a beam with pinned ends")
    check_whole("segments", n_segments, 2)


def _check_height(height: float, system: ChainSystem) -> None:
    if not 0.0 < height <= 0.1 * system.length:
        raise InputError(f"amplitude: mid-span would stand {height:.3g} m off; give a positive one up to L / 10")


def energy_drift(
    beam: Beam,
    n_segments: int,
    amplitude: float,
    periods: float,
    step: float | None,
    tolerance: float,
    progress: Progress = lambda part: None,
) -> float:
    """Largest change of the energy of an undamped roller-ended chain, over what it was let go with.

    Let go at rest from amplitude L sin(pi x / L); `periods` are the linear first mode's. Raises InputError, also for
    a beam that is not between hinges, or damped.
    """
    _check_hinged(beam, n_segments)
    system = build_system(beam, n_segments)
    _check_height(amplitude * system.length, system)
    linear = float(linearise(system, at_rest(system)).frequencies()[0])
    times = np.linspace(0.0, 2.0 * pi * periods / linear, 65)
    start = first_shape(system, amplitude * system.length)
    motion = (
        simulate(system, start, times, tolerance=tolerance, progress=progress)
        if step is None
        else simulate(system, start, times, method="rk4", step=step, progress=progress)
    )
    _finished(motion)
    kinetic, elastic, _ = motion.energies()
    return float(abs(motion.residual()).max() / (kinetic + elastic)[0])


def shaken_imbalance(n_segments: int, tip: Tip, tolerance: float, progress: Progress = lambda part: None) -> float:
    """Largest residual of a chain's energy balance over the loss of its dashpots.

    All kinds of work act on this chain: a base that turns and swings, a load off its link's middle with a moment, an
    actuator, dashpots; its tip is free or a roller on an axial spring. Raises InputError.
    """
    check_whole("segments", n_segments, 3)
    system, stiff = build_system(UNIT_CANTILEVER, n_segments), UNIT_STIFFNESS
    unit, link = sqrt(stiff / UNIT_CANTILEVER.mass_per_length), 1.0 / n_segments
    push = LinkLoad(
        link=n_segments,
        at=0.3 * link,
        force=(0.2 * stiff, -0.4 * stiff),
        moment=0.13 * stiff,
        frequency_hz=0.9 * unit,
        phase_deg=40.0,
    )
    system = replace(
        system,
        dashpots=np.full(n_segments, 0.003 * n_segments * stiff / unit),
        tip=tip,
        axial_spring=40.0 * stiff if tip == "roller" else 0.0,
        rotation=Rotation(offset=0.1, rate=0.05 * unit, amplitude=0.2, frequency_hz=0.7 * unit, phase_deg=20.0),
        loads=(push,),
        actuators=(Actuator(link=2, at=0.4 * link, amplitude=0.03, frequency_hz=0.4 * unit, phase_deg=-70.0),),
    )
    start, _ = project(system, ChainState(np.zeros(n_segments), np.zeros(n_segments)))
    times = np.linspace(0.0, 1.0 / unit, 17)
    motion = simulate(system, start, times, tolerance=tolerance, progress=progress)
    _finished(motion)
    return float(abs(motion.residual()).max() / motion.dissipated[-1])


def transient(
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    times: Sequence[float],
    n_segments: int,
    *,
    step: float | None = None,
    method: Method = "adaptive",
    axial_inertia: bool = True,
    tolerance: float | None = None,
    progress: Progress = lambda part: None,
) -> ChainMotion:
    """The chain from rest under harmonic forces A cos(2 pi f t + phase) on its links.

    `method` is "adaptive" with a tolerance (default 1e-9) or "rk4" with a step. Raises InputError, also for a far
    motion that a second run with another step or tolerance does not confirm (`chain.confirmed`).
    """
    if method != "adaptive" and tolerance is not None:
        raise InputError(f"tolerance = {tolerance!r} is for method = 'adaptive': {method!r} takes none, leave it out")
    system = build_system(beam, n_segments, forces, frequency_hz, axial_inertia=axial_inertia)

    def run(value: float) -> ChainMotion:
        chosen: dict[str, float] = {"step": value} if fixed else {"tolerance": value}
        return simulate(system, at_rest(system), times, method=method, ledger=False, progress=progress, **chosen)

    fixed = step is not None
    given = (tolerance or 1e-9) if step is None else step
    motion = run(given)
    _finished(motion)
    refuse_unknown(motion, "step" if fixed else "tolerance", given, run)
    return motion


def contact_line_error(
    beam: Beam, mode: int, n_segments: int, x: float, *, wall: Wall = "gregory", grading: float = 1.0
) -> float:
    """Largest error of the slope that a slider on the nonlinear chain sees on the piece at x, over the largest slope.

    The chain stands in a mode of the linear one, a millionth of its length high; the exact mode is the reference.
    Order 3, beside a clamped wall 1. Raises InputError, also for a stepped beam: its exact shapes are not known here.
    """
    from verify.analytic_modes import ExactModel
    from verify.chain.ride import touched
    from verify.segment_model import SegmentModel

    check_whole("segments", n_segments, 2)
    system = build_system(beam, n_segments, wall=wall, grading=grading)
    modes = SegmentModel(beam, n_segments, wall=wall, grading=grading).modes(mode)
    joints = modes.readings["raw"]()[mode - 1]
    size = 1e-6 * beam.length / float(abs(joints).max())
    pieces, edges = touched(system, size * np.diff(joints), x)
    xi = np.linspace(0.0, 1.0, 17)
    found = np.polynomial.polynomial.polyval(xi, np.polynomial.polynomial.polyder(pieces)) / (size * np.ptp(edges))
    model = ExactModel(beam)
    exact = model.mode_shape(mode, edges[0] + xi * np.ptp(edges), 1)
    largest = float(abs(model.mode_shape(mode, system.nodes, 1)).max())
    return float(abs(found - exact).max()) / largest


def _finished(motion: ChainMotion) -> None:
    """Raise InputError where a run stopped before its end."""
    if not motion.finished:
        raise InputError(f"the chain's motion {motion.statistics.stopped}: give a smaller step or a smaller load")
