"""A slider on the nonlinear chain, one-way: the contact code of the linear beams on the chain's own surface.

The chain moves first, with two states in every step of the slider. Its joints define the paper's C2 contact line over
the material coordinate (`segments.reading.contact_line`); its links shorten the chain, and the surface moves along with
every point of them.
"""

from collections.abc import Callable, Sequence
from time import perf_counter
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from verify.arrays import Array
from verify.chain.motion import ChainMotion, ElasticMotion, from_rest
from verify.chain.system import ChainSystem, axial_stiffness, build_system, straight_chain
from verify.dynamics.linear_system import Steps, damped_field, steady_stage
from verify.dynamics.request import check_step
from verify.dynamics.result import END, Statistics
from verify.dynamics.validity import Coupling, coupling_of, field_receptance
from verify.errors import InputError, written
from verify.linear.surface import section_at
from verify.motion.records import KEPT_FRICTION, Given, Rider
from verify.motion.stepping import contact_space, fresh_motion, law_of, of_all_steps
from verify.options import Links
from verify.problem.beam import Beam, PointForce
from verify.problem.slider import Slider
from verify.segments.reading import contact_line, contact_piece
from verify.validation import check_number, check_whole

if TYPE_CHECKING:
    pass


class SliderLedger(msgspec.Struct, frozen=True, kw_only=True):
    """Energy balance of the slider, joules, from the start of the run to its end: given + turned = gained + rubbed."""

    given: float
    """Work of friction on the slider at the speed of the surface; one-way, it is not taken from the chain."""
    turned: float
    """Work of the turning tangent and of gravity along it on a slider that follows the surface."""
    gained: float
    """Kinetic energy of the slider, at its end less at its start."""
    rubbed: float
    """Friction loss."""
    residual: float
    """Forces by the law at the steps' ends, integrated through a cubic spline, against the speed of the steps; order 4
    where friction is smooth, 1 where it jumps, or sticks and is the step's mean."""


class ChainRide(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Motion of a slider on a chain."""

    times: Array
    """(n,), s."""
    slider: Slider
    start: float
    """Initial position, m from the left end."""
    travelled: Array
    """(n,), m along +x."""
    speed: Array
    """(n,), m/s."""
    friction: Array
    """(n,), tangential force on the slider, N."""
    surface_speed: Array
    """(n,), tangential velocity of the surface under the slider, m/s."""
    mean_friction: float
    """Of all steps, N; NaN without a step."""
    largest_friction: float
    """Of all steps, N."""
    mean_surface_speed: float
    """Of all steps, m/s."""
    coupling: Coupling | None
    notes: tuple[str, ...]
    statistics: Statistics
    chain: ChainMotion | ElasticMotion
    """The chain's own motion."""
    ledger: SliderLedger | None
    """None of a run that ended at its start."""

    @property
    def displacement(self) -> float:
        """From the start to the end, m."""
        return float(self.travelled[-1])

    @property
    def mean_speed(self) -> float:
        """Displacement over duration, m/s."""
        return self.displacement / float(self.times[-1])


def half_steps(duration: float, step: float) -> Array:
    """Times of the chain's states for slider steps no longer than `step`, (2 n + 1,), s. Raises InputError."""
    check_number("duration", duration, "seconds", above=0)
    check_number("step", step, "seconds", above=0)
    n = int(np.ceil(duration / step * (1.0 - 1e-12)))
    return np.linspace(0.0, duration, 2 * n + 1)


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
    progress: Callable[[float], None] = lambda part: None,
) -> ChainRide:
    """A slider on a chain from rest under forces that act at once, undamped, in steps no longer than `step`.

    `links` are rigid, moved by adaptive steps of `tolerance`, or stretch by the beam's own EA / l. Raises InputError
    for a two-way slider and one of coupling "auto" that the chain would feel, for a chain that diverges, and where the
    slider leaves the link on which it began.
    """
    check_whole("segments", n_segments, 2)
    check_number("step", step, "seconds", above=0)
    check_step(step, frequency_hz)
    check_rideable(slider)
    system = build_system(beam, n_segments, forces, frequency_hz, load="reciprocal")
    times, coupling = half_steps(duration, step), coupling_on_chain(beam, forces, frequency_hz, n_segments, slider)
    axial = axial_stiffness(beam, n_segments)
    moved = from_rest(system, links, axial, times, tolerance=tolerance, progress=progress)
    found = ride(moved, beam, slider, coupling)
    if not found.statistics.finished:
        start = slider.start_on(beam)
        on_joint = float(abs(system.nodes - start).min()) <= 1e-6 * system.length / system.n_links
        remedy = "another number of segments, or another slider.position" if on_joint else "a shorter time"
        raise InputError(
            f"slider.position = {start!r} m: the slider {found.statistics.stopped} after {found.times[-1]:.6g} s of "
            f"{written(duration)} s, give {remedy}"
        )
    return found


def check_rideable(slider: Slider) -> None:
    """Raise InputError for a slider with two-way coupling, on the links' edges, or that may leave the surface."""
    slider.check_stays()
    if slider.coupling == "two-way":
        raise InputError("slider.coupling = 'two-way': a nonlinear chain carries a slider one way, give 'one-way'")
    if slider.line != "spline":
        raise InputError(f"slider.line = {slider.line!r}: a nonlinear chain is touched along its spline, give 'spline'")


def coupling_on_chain(
    beam: Beam, forces: Sequence[PointForce], frequency_hz: float, n_segments: int, slider: Slider
) -> Coupling:
    """Sizes of the coupling on the straight, steady chain: those of the segment model."""
    field = damped_field("segment", n_segments, beam, tuple(forces), frequency_hz, None)
    stage = steady_stage(field, Steps(1, 1.0 / frequency_hz, 1), 0.0, None, 0.0)
    receptance = field_receptance(beam, "segment", n_segments, frequency_hz, None)
    return coupling_of(beam, (slider,), (slider.start_on(beam),), stage, receptance)


def ride(chain: ChainMotion | ElasticMotion, beam: Beam, slider: Slider, coupling: Coupling | None = None) -> ChainRide:
    """A one-way slider on a chain, rigid or stretching, whose states stand at `half_steps`. Raises InputError."""
    from verify.motion import kernels

    began, times, start = perf_counter(), chain.times, slider.start_on(beam)
    if len(times) < 3 or len(times) % 2 == 0 or np.ptp(np.diff(times)) > 1e-9 * times[-1]:
        raise InputError(f"times: {len(times)} states do not stand twice in every step, give them at half_steps(...)")
    check_rideable(slider)
    n_steps, dt = len(times) // 2, 2.0 * float(times[1] - times[0])
    local, along, edges = _surface(chain, start)
    given, kept = Given(local, along, edges - start), np.zeros((n_steps + 1, 4))
    under = section_at(beam, start)
    rider = Rider(fresh_motion(slider.speed), law_of(slider, under))
    ready = perf_counter()
    done = kernels.slide_given(n_steps, dt, given, rider, kept, contact_space())
    wall, kept, ends = perf_counter() - ready, kept[: done + 1], slice(0, 2 * done + 1, 2)
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
        notes=(),
        statistics=Statistics(
            steps=done,
            evaluations=2 * done + 1,
            step_s=dt,
            set_up_s=ready - began,
            wall_s=wall,
            stopped=END if done == n_steps else "left the piece of the chain it began on",
        ),
    )


def _ledger(slider: Slider, half: float, times: Array, kept: Array, local: Array, edges: Array) -> SliderLedger | None:
    """The balance from the steps' ends; `local` (n, 2, 4) are polynomials on the slider's piece between `edges`."""
    from scipy.interpolate import CubicSpline

    if len(times) < 2:
        return None

    def over_time(values: Array) -> float:
        return float(CubicSpline(times, values).integrate(times[0], times[-1]))

    x, v, friction, surface = kept[:, 0], kept[:, 1], slider.mass * kept[:, 2], kept[:, 3]
    given, own, turned = over_time(friction * surface), over_time(friction * v), 0.0
    if slider.kinematics == "following":
        turned = over_time(slider.mass * v * _tangent_force(slider, half, local, edges, x, v))
    gained = 0.5 * slider.mass * float(v[-1] ** 2 - v[0] ** 2)
    return SliderLedger(given=given, turned=turned, gained=gained, rubbed=given - own, residual=own + turned - gained)


def _tangent_force(slider: Slider, half: float, local: Array, edges: Array, x: Array, v: Array) -> Array:
    """Acceleration of a following slider by the turning tangent and gravity along it, (n,), m/s^2.

    dw/dt (d2w/dxdt + w'' v) - g w' at the material point under x.
    """
    length = float(edges[1] - edges[0])

    def line(row: int, at: Array, derivative: int) -> Array:
        """One polynomial of each step, at a place of its own, or its derivative by x, (n,)."""
        derived = np.polynomial.polynomial.polyder(local[:, row], derivative, axis=1) / length**derivative
        return np.asarray(sum(derived[:, power] * at**power for power in range(derived.shape[1])))

    xi = (x - edges[0]) / length
    at = xi + half * line(0, xi, 1) / length
    return np.asarray(line(1, at, 0) * (line(1, at, 1) + line(0, at, 2) * v) - slider.gravity * line(0, at, 1))


def _surface(chain: ChainMotion | ElasticMotion, x: float) -> tuple[Array, Array, Array]:
    """(polynomials of deflection and velocity on the piece at x, speeds of its ends along x, these ends).

    (n, 2, 4) in the local coordinate from 0 to 1, (n, 2) in m/s, (2,) metres.
    """
    piece = piece_at(chain.system, x)
    heights, rises, along = joint_steps(chain)
    local, edges = touched(chain.system, np.stack([heights, rises], axis=1), x)
    return np.ascontiguousarray(local), np.ascontiguousarray(along[:, piece : piece + 2]), edges


def joint_steps(chain: ChainMotion | ElasticMotion) -> tuple[Array, Array, Array]:
    """Steps across from joint to joint and their rates, (n, N) each, and the joints' speeds along x, (n, N + 1)."""
    if isinstance(chain, ElasticMotion):
        heights, rises = (np.diff(parts[:, :, 1], axis=1) for parts in (chain.displacements, chain.velocities))
        return heights, rises, chain.velocities[:, :, 0]
    theta, lengths, spins = chain.directions(), chain.system.lengths, np.cumsum(chain.rates, axis=1)
    back = np.cumsum(-lengths * np.sin(theta) * spins, axis=1)
    return lengths * np.sin(theta), lengths * np.cos(theta) * spins, np.pad(back, ((0, 0), (1, 0)))


def touched(system: ChainSystem, steps: Array, x: float) -> tuple[Array, Array]:
    """The contact line on the piece at x of a chain that rises by `steps` (..., N) from joint to joint, metres.

    (..., 4), coefficients of the local coordinate from 0 to 1, and the piece's ends, (2,).
    """
    piece = piece_at(system, x)
    one_step_up = np.triu(np.ones((system.n_links, system.n_links + 1)), 1)  # all joints beyond a step rise with it
    return steps @ contact_piece(straight_chain(system), one_step_up, piece), system.nodes[piece : piece + 2]


def line_rows(system: ChainSystem) -> Array:
    """Polynomials of the whole contact line per unit step up at each joint, (N, pieces, 4), powers from 0 to 1."""
    up = np.triu(np.ones((system.n_links, system.n_links + 1)), 1)
    powers = contact_line(straight_chain(system), up).c[::-1]  # (4, pieces, N)
    lengths = np.diff(system.nodes)
    return np.asarray(np.moveaxis(powers * lengths[None, :, None] ** np.arange(4)[:, None, None], 0, 2).swapaxes(0, 1))


def piece_at(system: ChainSystem, x: float) -> int:
    """The link at x, from 0."""
    return int(np.clip(np.searchsorted(system.nodes, x, side="right") - 1, 0, system.n_links - 1))
