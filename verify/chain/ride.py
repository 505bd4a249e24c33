"""A slider on the nonlinear chain: the contact code of the linear beams, fed with the chain's own surface.

One way: the chain moves first, kept twice in every step of the slider, which is refused where the chain would feel it.
Its joints give the paper's C2 line over the material coordinate (`segments.reading.contact_line`); its links shorten
the chain, and the surface moves along with every point of them.
"""

from collections.abc import Callable, Sequence
from time import perf_counter

import msgspec
import numpy as np

from verify.beam import Beam, PointForce
from verify.chain.confirmed import check_known, from_rest
from verify.chain.result import ChainMotion
from verify.chain.stretching import ElasticMotion
from verify.chain.system import (
    ChainSystem,
    LinkLoad,
    Rotation,
    axial_stiffness,
    build_system,
    circular,
    straight_chain,
)
from verify.chain.work import MOST, STATIC_LINKS, check_kept, check_links
from verify.checks import check_number
from verify.errors import InputError, written
from verify.models.arrays import Array, ComplexArray
from verify.models.response import forced_response
from verify.models.underfoot import standing_at
from verify.motion.contact import Coupling, coupling_of, law_of
from verify.motion.records import KEPT_FRICTION, Given, Rider
from verify.motion.request import check_seen
from verify.motion.result import END, Slid, Statistics
from verify.motion.stepping import contact_space, fresh_motion, of_all_steps
from verify.options import Links
from verify.segments.assembly import chain_pencil
from verify.segments.links import Chain, free_joints, with_ends
from verify.segments.loads import joint_weights
from verify.segments.reading import contact_line, contact_piece
from verify.slider import Slider


class SliderLedger(msgspec.Struct, frozen=True, kw_only=True):
    """Where the slider's energy went, joules, from the start of the run to its end.

    What friction gives, `given`, and what the turning surface gives, `turned`, is gained or rubbed away.
    """

    given: float
    """Work of friction on the slider at the speed of the surface; the chain, moved one way, is not charged with it."""
    turned: float
    """Work of the turning tangent and of gravity along it on a slider that follows the surface."""
    gained: float
    """Kinetic energy of the slider, at its end less at its start."""
    rubbed: float
    """Lost in friction."""
    residual: float
    """What the books miss: forces by the law at the steps' ends, integrated through a cubic spline, against the speed
    that the steps have made; order 4 where friction is smooth, 1 where it jumps, or sticks and is the step's mean."""


class ChainRide(Slid, frozen=True, eq=False, kw_only=True):
    """What a slider did on a chain."""

    chain: ChainMotion | ElasticMotion
    """The chain's own motion."""
    ledger: SliderLedger | None
    """None of a run that was over at its start."""


def half_steps(duration: float, step: float) -> Array:
    """The times at which the chain has to be kept for steps no longer than `step`, (2 n + 1,), s."""
    check_number("duration", duration, "seconds", above=0)
    check_number("step", step, "seconds", above=0)
    n = int(np.ceil(duration / step * (1.0 - 1e-12)))
    return np.linspace(0.0, duration, 2 * n + 1)


def ride(chain: ChainMotion | ElasticMotion, beam: Beam, slider: Slider) -> ChainRide:
    """A slider carried by a chain, rigid or stretching, whose states stand at `half_steps`.

    Raises InputError for times that are not evenly spaced and odd in number; for a slider that is coupled two-way, or
    one of coupling "auto" that the chain would feel (`coupling_on_chain`), which the chain's integrators do not know;
    for the links' edges as a contact line; for a turned base; and for another beam than the chain's.
    """
    from verify.motion import kernels

    began, times, start = perf_counter(), chain.times, slider.start_on(beam)
    _check_times(times)
    check_rideable(chain.system, beam, slider)
    coupling = coupling_on_chain(chain.system, beam, slider)
    n_steps, dt = len(times) // 2, 2.0 * float(times[1] - times[0])
    local, along, edges = _surface(chain, start)
    given, kept = Given(local, along, edges - start), np.zeros((n_steps + 1, 4))
    under = standing_at(beam, start)
    rider = Rider(fresh_motion(slider.speed), law_of(slider, under), two_way=None)
    ready = perf_counter()
    done = kernels.slide_given(n_steps, dt, given, rider, kept, contact_space())
    wall, kept, ends = perf_counter() - ready, kept[: done + 1], slice(0, 2 * done + 1, 2)
    stopped = END if done == n_steps else "left the piece of the chain it began on"
    statistics = Statistics(
        steps=done, evaluations=2 * done + 1, step_s=dt, set_up_s=ready - began, wall_s=wall, stopped=stopped
    )
    mean_friction, hardest, mean_surface = of_all_steps(rider.motion, slider.mass, done * dt)
    return ChainRide(
        chain=chain,
        times=times[ends],
        slider=slider,
        start=start,
        travelled=kept[:, 0],
        speed=kept[:, 1],
        friction=slider.mass * kept[:, KEPT_FRICTION],
        surface_speed=kept[:, 3],
        mean_friction=mean_friction,
        largest_friction=hardest,
        mean_surface_speed=mean_surface,
        coupling=coupling,
        ledger=_ledger(slider, under.surface_distance, times[ends], kept, local[ends], given.edges),
        notes=(coupling.note if coupling else "coupling: one-way; no harmonic load says what the chain would feel",),
        statistics=statistics,
    )


def _check_times(times: Array) -> None:
    if len(times) < 3 or len(times) % 2 == 0 or np.ptp(np.diff(times)) > 1e-9 * times[-1]:
        raise InputError(f"times: {len(times)} states do not stand twice in every step, give them at half_steps(...)")


def check_rideable(system: ChainSystem, beam: Beam, slider: Slider) -> None:
    """Raise InputError for a slider that is felt or on the links' edges, and for a turned chain or another beam's."""
    slider.check_stays()
    if slider.coupling == "two-way":
        raise InputError("slider.coupling = 'two-way': a nonlinear chain carries a slider one way, give 'one-way'")
    if slider.line != "spline":
        raise InputError(f"slider.line = {slider.line!r}: a nonlinear chain is touched along its spline, give 'spline'")
    if system.rotation != Rotation():
        raise InputError("chain.rotation: a slider rides on a chain whose base does not turn, give none")
    supports = straight_chain(system).supports
    if supports != beam.supports or abs(system.length / beam.length - 1.0) > 1e-9:
        raise InputError(
            f"beam.supports = {list(beam.supports)!r}, beam.length = {beam.length!r} m: the chain has "
            f"{list(supports)!r} and {system.length:.6g} m, give the beam that it was built from"
        )


def coupling_on_chain(system: ChainSystem, beam: Beam, slider: Slider) -> Coupling | None:
    """How much the chain would feel the slider: the larger sizes at its loads' frequencies, straight and steady.

    None where no harmonic load drives it. Raises InputError where coupling is "auto" and no size is known or one lies
    above `contact.FELT`, with the figure.
    """
    springs = bool((system.stiffness[1:] > 0.0).all())
    frequencies = {load.frequency_hz for load in system.loads if load.frequency_hz > 0.0} if springs else set()
    found = [_sized(system, beam, slider, frequency) for frequency in frequencies]
    sizes = [np.inf if one.relative_size is None else one.relative_size for one in found]
    felt = found[int(np.argmax(sizes))] if found else None
    if slider.coupling == "auto" and (felt is None or felt.two_way):
        raise InputError(
            f"slider.coupling = 'auto': {felt.told if felt else 'no harmonic load says how the chain moves'}, and a "
            "nonlinear chain carries one that it does not feel: give a lighter slider, normal = 'massless', or "
            "'one-way' to leave out what the chain would feel"
        )
    return felt


def _sized(system: ChainSystem, beam: Beam, slider: Slider, frequency_hz: float) -> Coupling:
    """Sizes of friction and inertia at one frequency: slope under the loads, answers to a unit force and a couple."""
    chain, x, omega = straight_chain(system), slider.start_on(beam), circular(frequency_hz)
    pencil = chain_pencil(chain)
    dashpots = system.dashpots[system.n_links - len(pencil.stiffness) :]
    stiffness: ComplexArray = np.asarray(pencil.stiffness + 1j * omega * dashpots)
    drive = sum(_on_joints(system, load) for load in system.loads if load.frequency_hz == frequency_hz)
    unit, couple = joint_weights(chain, x, "reciprocal"), _couple(system, chain, x)
    loads = np.stack([drive, unit, couple], axis=1)[free_joints(chain)]
    joints = with_ends(chain, forced_response(pencil, loads, omega**2, stiffness)).T
    real, imaginary = (contact_line(chain, part) for part in (joints.real, joints.imag))
    slopes = real(x, 1) + 1j * imaginary(x, 1)
    under = standing_at(beam, x)
    speed = under.surface_distance * omega * float(abs(slopes[0]))
    return coupling_of(slider, under, frequency_hz, speed, complex(real(x)[1], imaginary(x)[1]), complex(slopes[2]))


def _couple(system: ChainSystem, chain: Chain, x: float) -> Array:
    """Weights of all joints for a unit couple at x, (N + 1,), 1/m: the derivative over its place of a force's.

    Cubic along a link, so that four places on it tell it.
    """
    link = _piece_at(system, x)
    start, length = float(system.nodes[link]), float(system.lengths[link])
    places = np.array([0.125, 0.375, 0.625, 0.875])
    weights = np.stack([joint_weights(chain, start + length * s, "reciprocal") for s in places])
    powers = np.linalg.solve(np.vander(places, increasing=True), weights)
    return np.asarray(
        np.array([0.0, 1.0, 2.0, 3.0]) * ((x - start) / length) ** np.array([0, 0, 1, 2]) @ powers / length
    )


def _on_joints(system: ChainSystem, load: LinkLoad) -> ComplexArray:
    """A load's transverse force and moment on the joints at the ends of its link, (N + 1,) complex, newton."""
    length = float(system.lengths[load.link - 1])
    share, couple = load.at / length, load.moment / length
    found = np.zeros(system.n_links + 1, dtype=complex)
    found[load.link - 1] = (1.0 - share) * load.force[1] - couple
    found[load.link] = share * load.force[1] + couple
    return np.asarray(found * np.exp(1j * np.deg2rad(load.phase_deg)))


def ride_from_rest(
    beam: Beam,
    forces: Sequence[PointForce],
    frequency_hz: float,
    slider: Slider,
    n_segments: int,
    duration: float,
    *,
    step: float,
    links: Links = "rigid",
    tolerance: float = 1e-9,
    most: float = MOST,
    progress: Callable[[float], None] = lambda part: None,
) -> ChainRide:
    """A slider on a chain from rest under forces that act at once, undamped, in steps no longer than `step`.

    `links` are rigid, moved by adaptive steps of `tolerance`, or stretch by the beam's own EA / l. Raises InputError,
    before the chain moves, for whatever `ride` or the chain refuses; also for a run that takes too much, breaks off, or
    takes the slider off the piece of the chain that it began on.
    """
    check_known(links)
    check_number("step", step, "seconds", above=0)
    check_seen(step, frequency_hz)
    system = _driven(beam, forces, frequency_hz, n_segments)
    check_kept(2.0 * duration / step + 1.0, n_segments, f"time = {written(duration)} s in steps of {step:.3g} s")
    times = half_steps(duration, step)
    check_rideable(system, beam, slider)
    coupling_on_chain(system, beam, slider)
    axial = axial_stiffness(beam, n_segments)
    moved = from_rest(system, links, axial, times, tolerance=tolerance, settable=True, most=most, progress=progress)
    found = ride(moved, beam, slider)
    if not found.statistics.finished:
        raise InputError(
            f"the slider {found.statistics.stopped} after {found.times[-1]:.6g} s of {written(duration)} s: "
            f"{_start_elsewhere(system, slider.start_on(beam))}"
        )
    return found


def _start_elsewhere(system: ChainSystem, start: float) -> str:
    """What to do about a slider that leaves its piece: at once where it starts on a joint, as mid-span of even N.

    At an end of the beam no number of segments helps.
    """
    joint = float(system.nodes[np.argmin(abs(system.nodes - start))])
    if abs(joint - start) > 1e-6 * system.length / system.n_links:
        return "shorten time or start it elsewhere"
    if joint in (system.nodes[0], system.nodes[-1]):
        return f"it starts at the end of the beam at {joint:.6g} m; start it farther in"
    return (
        f"it starts on the joint at {joint:.6g} m, where pieces meet; give a number of segments that has none there "
        "(an odd one for mid-span), or start it between two joints"
    )


def _driven(beam: Beam, forces: Sequence[PointForce], frequency_hz: float, n_segments: int) -> ChainSystem:
    """The chain of a beam under its forces. Raises InputError."""
    check_links(n_segments, 2, STATIC_LINKS, "a slider's contact line goes through two links or more")
    return build_system(beam, n_segments, forces, frequency_hz, load="reciprocal")


def _ledger(slider: Slider, half: float, times: Array, kept: Array, local: Array, edges: Array) -> SliderLedger | None:
    """The slider's books from what stands at the steps' ends, `local` (n, 2, 4) on its piece between `edges`."""
    if len(times) < 2:
        return None
    x, v, friction, surface = kept[:, 0], kept[:, 1], slider.mass * kept[:, 2], kept[:, 3]
    given, own = _over(times, friction * surface), _over(times, friction * v)
    follows = slider.kinematics == "following"
    turned = _over(times, slider.mass * v * _pull(slider, half, local, edges, x, v)) if follows else 0.0
    gained = 0.5 * slider.mass * float(v[-1] ** 2 - v[0] ** 2)
    return SliderLedger(given=given, turned=turned, gained=gained, rubbed=given - own, residual=own + turned - gained)


def _over(times: Array, values: Array) -> float:
    """Integral over time through a cubic spline."""
    from scipy.interpolate import CubicSpline

    return float(CubicSpline(times, values).integrate(times[0], times[-1]))


def _pull(slider: Slider, half: float, local: Array, edges: Array, x: Array, v: Array) -> Array:
    """What the turning tangent and gravity along it add to a following slider's speed, (n,), m/s^2.

    dw/dt (d2w/dxdt + w'' v) - g w' at the material point under x.
    """
    length = float(edges[1] - edges[0])
    xi = (x - edges[0]) / length
    slope = _power_sum(local[:, 0], xi, 1) / length
    at = xi + half * slope / length
    slope, bend = (_power_sum(local[:, 0], at, d) / length**d for d in (1, 2))
    rise, turn = (_power_sum(local[:, 1], at, d) / length**d for d in (0, 1))
    return np.asarray(rise * (turn + bend * v) - slider.gravity * slope)


def _power_sum(coefficients: Array, at: Array, derivative: int) -> Array:
    """Polynomials (n, 4), each at a place of its own, or their derivatives, (n,)."""
    derived = np.polynomial.polynomial.polyder(coefficients, derivative, axis=1)
    return np.asarray(sum(derived[:, power] * at**power for power in range(derived.shape[1])))


def _surface(chain: ChainMotion | ElasticMotion, x: float) -> tuple[Array, Array, Array]:
    """(polynomials of deflection and velocity on the piece at x, speeds of its ends along x, these ends).

    (n, 2, 4) in the local coordinate from 0 to 1, (n, 2) in m/s, (2,) metres.
    """
    piece = _piece_at(chain.system, x)
    heights, rises, along = (
        _of_stretching(chain, piece) if isinstance(chain, ElasticMotion) else _of_rigid(chain, piece)
    )
    local, edges = touched(chain.system, np.stack([heights, rises], axis=1), x)
    return np.ascontiguousarray(local), np.ascontiguousarray(along), edges


def touched(system: ChainSystem, steps: Array, x: float) -> tuple[Array, Array]:
    """The contact line on the piece at x of a chain that rises by `steps` (..., N) from joint to joint, metres.

    (..., 4), coefficients of the local coordinate from 0 to 1, and the piece's ends, (2,).
    """
    piece = _piece_at(system, x)
    one_step_up = np.triu(np.ones((system.n_links, system.n_links + 1)), 1)  # what lies beyond a step rises with it
    return steps @ contact_piece(straight_chain(system), one_step_up, piece), system.nodes[piece : piece + 2]


def _piece_at(system: ChainSystem, x: float) -> int:
    return int(np.clip(np.searchsorted(system.nodes, x, side="right") - 1, 0, system.n_links - 1))


def _of_rigid(chain: ChainMotion, piece: int) -> tuple[Array, Array, Array]:
    """From joint to joint the step across and its rate, (n, N) each, and speeds of a link's ends along x, (n, 2)."""
    theta, lengths = chain.directions(), chain.system.lengths
    spins = np.cumsum(chain.rates, axis=1)
    back = -lengths * np.sin(theta) * spins
    far = np.cumsum(back, axis=1)[:, piece]
    return lengths * np.sin(theta), lengths * np.cos(theta) * spins, np.stack([far - back[:, piece], far], axis=1)


def _of_stretching(chain: ElasticMotion, piece: int) -> tuple[Array, Array, Array]:
    """The same of links that stretch evenly."""
    heights, rises = (np.diff(parts[:, :, 1], axis=1) for parts in (chain.displacements, chain.velocities))
    return heights, rises, chain.velocities[:, piece : piece + 2, 0]
