"""Known problems solved by the nonlinear chain: figures that have a reference outside this suite."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import pi, sqrt

import numpy as np

from verify.beam import Beam, PointForce
from verify.chain import link_inertia
from verify.chain_dynamics import at_rest, linearise, positions
from verify.chain_modal import modal_basis, simulate_linear, simulate_modal
from verify.chain_motion import ChainMotion, simulate
from verify.chain_statics import solve_static
from verify.chain_system import ChainState, ChainSystem, LinkLoad, build_system
from verify.chain_walls import Wall
from verify.errors import InputError


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
    system = build_system(UNIT_CANTILEVER, n_segments, wall=wall)
    at = float(system.lengths[-1])
    system = replace(system, loads=(LinkLoad(link=system.n_links, at=at, force=(0.0, load * UNIT_STIFFNESS)),))
    x, y = _tip(system)
    return TipPlace(deflection=y, shortening=1.0 - x)


def rollup_gap(n_segments: int, wall: Wall = "half", turns: float = 1.0) -> float:
    """Distance of the ends over L of a cantilever under an end moment 2 pi EI / L times `turns`.

    With equal joints, a wall joint 2EI/l among them, the circle closes exactly; Gregory's weights leave a gap.
    """
    system = build_system(UNIT_CANTILEVER, n_segments, wall=wall)
    moment = 2.0 * pi * turns * UNIT_STIFFNESS
    return float(np.hypot(*_tip(replace(system, loads=(LinkLoad(link=system.n_links, at=0.0, moment=moment),)))))


def _tip(system: ChainSystem) -> tuple[float, float]:
    x, y = positions(system, solve_static(system))[0][-1]
    return float(x), float(y)


UNIT_CANTILEVER = Beam(length=1.0, width=1.2, thickness=0.01, youngs_modulus=1e7, density=1000.0,
                       supports=("clamped", "free"))  # fmt: skip
UNIT_STIFFNESS = UNIT_CANTILEVER.bending_stiffness


def hanging_frequency(mode: int, n_segments: int) -> float:
    """Omega sqrt(L / g) of a chain of uniform links hanging from a pin, without springs.

    sqrt(3/2) for one link, j_{0,n} / 2 (Daniel Bernoulli) in the limit of many, approached with order 2. Raises
    InputError for more modes than links.
    """
    if mode > n_segments:
        raise InputError(f"mode = {mode!r}: a hanging chain of {n_segments} segments has as many modes")
    lengths, masses, still = (np.full(n_segments, value) for value in (1.0 / n_segments, 1.0 / n_segments, 0.0))
    system = ChainSystem(lengths=lengths, masses=masses, inertias=link_inertia(masses, lengths), stiffness=still,
                         dashpots=still, gravity=(1.0, 0.0))  # fmt: skip
    return float(linearise(system, at_rest(system)).frequencies()[mode - 1])


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


def large_amplitude_frequency(beam: Beam, amplitude: float, n_segments: int) -> float:
    """Frequency over the linear chain's, first mode between immovable hinges, `amplitude` in radii of gyration.

    The radius is h / sqrt(12); the immovable end is a roller with an axial spring EA / L. S. Woinowsky-Krieger (J.
    Appl. Mech. 17 (1950) 35): q'' + q + a^2/4 q^3 = 0, to which a chain of any number of equal links comes but for
    the square of its slopes. Raises InputError for an amplitude that the links do not reach.
    """
    system = build_system(_hinged(beam), n_segments, immovable=True)
    height = amplitude * beam.thickness / sqrt(12.0)
    _check_height(height, system)
    linear = float(linearise(system, at_rest(system)).frequencies()[0])
    times = np.linspace(0.0, 1.01 * pi / 2 / linear, 801)
    motion = simulate(system, first_shape(system, height), times, tolerance=1e-10, ledger=False)
    _finished(motion)
    middle = motion.deflection([0.5 * beam.length])[:, 0]
    if not (k := int(np.argmax(middle <= 0.0))):
        raise InputError("amplitude: the middle is not back within a quarter of the linear period, give another one")
    crossing = float(np.interp(0.0, [middle[k], middle[k - 1]], [times[k], times[k - 1]]))
    return pi / 2.0 / crossing / linear


def _hinged(beam: Beam) -> Beam:
    from msgspec.structs import replace as changed

    return changed(beam, supports=("pinned", "pinned"))


def _check_height(height: float, system: ChainSystem) -> None:
    if not 0.0 < height <= 0.1 * system.length:
        raise InputError(f"amplitude: the middle would stand {height:.3g} m off; give a positive one up to L / 10")


def energy_drift(
    beam: Beam, n_segments: int, amplitude: float, periods: float, step: float | None, tolerance: float
) -> float:
    """Largest change of the energy of an undamped roller-ended chain, over what it was let go with.

    Let go at rest from amplitude L sin(pi x / L); `periods` are the linear first mode's. Raises InputError.
    """
    system = build_system(_hinged(beam), n_segments)
    _check_height(amplitude * system.length, system)
    linear = float(linearise(system, at_rest(system)).frequencies()[0])
    times = np.linspace(0.0, 2.0 * pi * periods / linear, 65)
    start = first_shape(system, amplitude * system.length)
    motion = (
        simulate(system, start, times, tolerance=tolerance)
        if step is None
        else simulate(system, start, times, method="rk4", step=step)
    )
    _finished(motion)
    kinetic, elastic, _ = motion.energies()
    return float(abs(motion.residual()).max() / (kinetic + elastic)[0])


def transient(
    beam: Beam, forces: Sequence[PointForce], frequency_hz: float, times: Sequence[float], n_segments: int, *,
    step: float | None = None, method: str = "adaptive", axial_inertia: bool = True, tolerance: float = 1e-9,
) -> ChainMotion:  # fmt: skip
    """The chain from rest under harmonic forces A cos(2 pi f t + phase) on its links.

    `method` is "adaptive", "rk4" or "modal" (two kicks) with a step, or "linear" for the exact linear flow. Raises
    InputError.
    """
    system = build_system(beam, n_segments, forces, frequency_hz, axial_inertia=axial_inertia)
    start = at_rest(system)
    if method == "linear":
        motion = simulate_linear(modal_basis(system), start, times)
    elif method == "modal":
        if step is None:
            raise InputError("step is missing: give a step in seconds with method = 'modal'")
        motion = simulate_modal(modal_basis(system), start, times, step=step)
    elif method == "rk4":
        motion = simulate(system, start, times, method="rk4", step=step, ledger=False)
    else:
        motion = simulate(system, start, times, step=step, tolerance=tolerance, ledger=False)
    _finished(motion)
    return motion


def _finished(motion: ChainMotion) -> None:
    """Raise InputError where a run stopped before its end."""
    if not motion.finished:
        raise InputError(f"the chain's motion {motion.statistics.stopped}: give a smaller step or a smaller load")
