"""A slider on the nonlinear chain: the contact code of the linear beams, fed with the chain's own surface.

One way: the chain moves first, kept twice in every step of the slider. Its joints give the paper's C2 spline over the
material coordinate, corrected by y + delta^2 y/12 (as in `chain.corrected_reading`); its links shorten the chain, and
the surface moves along with them.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicSpline

from verify.beam import Beam, check_number
from verify.chain.stepping import ChainMotion
from verify.chain.stretching import ElasticMotion
from verify.errors import InputError
from verify.models.arrays import Array
from verify.motion.contact import law_entries
from verify.motion.stepping import contact_space, fresh_motion
from verify.slider import Slider


@dataclass(frozen=True, kw_only=True, eq=False)
class ChainRide:
    """What a slider did on a chain."""

    chain: ChainMotion | ElasticMotion
    times: Array
    """(n + 1,), s."""
    travelled: Array
    """(n + 1,), metres along +x from the start."""
    speed: Array
    """(n + 1,), m/s."""
    friction: Array
    """(n + 1,), newton on the slider."""
    surface_speed: Array
    """(n + 1,), m/s."""
    stopped: str
    """end, or left the piece of the chain it began on."""

    @property
    def displacement(self) -> float:
        """From the start to the end, metres."""
        return float(self.travelled[-1])

    @property
    def mean_speed(self) -> float:
        """Displacement over duration, m/s."""
        return self.displacement / float(self.times[-1] - self.times[0])


def half_steps(duration: float, step: float) -> Array:
    """The times at which the chain has to be kept for steps no longer than `step`, (2 n + 1,), s."""
    check_number("duration", duration, "seconds", above=0)
    check_number("step", step, "seconds", above=0)
    n = int(np.ceil(duration / step * (1.0 - 1e-12)))
    return np.linspace(0.0, duration, 2 * n + 1)


def ride(chain: ChainMotion | ElasticMotion, beam: Beam, slider: Slider) -> ChainRide:
    """A slider carried by a chain, rigid or stretching, whose states stand at `half_steps`.

    Raises InputError where the times are not evenly spaced and odd in number, for two-way coupling, which the chain's
    own integrators do not know, for the links' edges as a contact line, and for a beam of unlike thicknesses.
    """
    from verify.motion import kernels

    times = chain.times
    if len(times) < 3 or len(times) % 2 == 0 or np.ptp(np.diff(times)) > 1e-9 * times[-1]:
        raise InputError(f"times: {len(times)} states do not stand twice in every step, give them at half_steps(...)")
    if slider.coupling == "two-way":
        raise InputError("slider.coupling = 'two-way': a nonlinear chain carries a slider one way, give 'one-way'")
    if slider.line != "spline":
        raise InputError(f"slider.line = {slider.line!r}: a nonlinear chain is touched along its spline, give 'spline'")
    if any(section.thickness not in (None, beam.thickness) for section in beam.section):
        raise InputError("beam.section has a thickness of its own: a slider rides on a beam of one thickness, give one")
    start = slider.start_on(beam)
    local, along, edges = _surface(chain, start)
    n_steps, dt = len(times) // 2, 2.0 * float(times[1] - times[0])
    kept = np.zeros((n_steps + 1, 4))
    motion = fresh_motion(slider.speed)
    done = kernels.slide_given(
        n_steps, dt, local, along, edges - start, motion, law_entries(slider, beam), kept, *contact_space()
    )
    return ChainRide(
        chain=chain,
        times=times[: 2 * done + 1 : 2],
        travelled=kept[: done + 1, 0],
        speed=kept[: done + 1, 1],
        friction=slider.mass * kept[: done + 1, 2],
        surface_speed=kept[: done + 1, 3],
        stopped="end" if done == n_steps else "left the piece of the chain it began on",
    )


def _surface(chain: ChainMotion | ElasticMotion, x: float) -> tuple[Array, Array, Array]:
    """(polynomials of deflection and velocity on the piece at x, speed of its middle along x, its ends).

    (n, 2, 4) in the local coordinate from 0 to 1, (n,) in m/s, (2,) metres.
    """
    nodes = chain.system.nodes
    piece = int(np.clip(np.searchsorted(nodes, x, side="right") - 1, 0, chain.system.n_links - 1))
    heights, rises, along = (
        _of_stretching(chain, piece) if isinstance(chain, ElasticMotion) else _of_rigid(chain, piece)
    )
    reading = _reading(nodes, piece)
    local = np.stack([steps @ reading for steps in (heights, rises)], axis=1)
    return np.ascontiguousarray(local), np.ascontiguousarray(along), nodes[piece : piece + 2]


def _of_rigid(chain: ChainMotion, piece: int) -> tuple[Array, Array, Array]:
    """From joint to joint the step across and its rate, (n, N) each, and the speed of a link's middle along x, (n,)."""
    theta, lengths = chain.directions(), chain.system.lengths
    spins = np.cumsum(chain.rates, axis=1)
    back = -lengths * np.sin(theta) * spins
    along = np.cumsum(back, axis=1)[:, piece] - 0.5 * back[:, piece]
    return lengths * np.sin(theta), lengths * np.cos(theta) * spins, along


def _of_stretching(chain: ElasticMotion, piece: int) -> tuple[Array, Array, Array]:
    """The same of links that stretch evenly."""
    heights, rises = (np.diff(parts[:, :, 1], axis=1) for parts in (chain.displacements, chain.velocities))
    return heights, rises, chain.velocities[:, piece : piece + 2, 0].mean(axis=1)


def _reading(nodes: Array, piece: int) -> Array:
    """What every step from joint to joint gives to the spline through corrected joints on one piece, (N, 4) in xi."""
    lengths = np.diff(nodes)
    steps = np.eye(len(lengths))
    joints = np.concatenate([np.zeros((len(steps), 1)), np.cumsum(steps, axis=1)], axis=1)
    corrected = joints.copy()
    squares = (lengths[1:] ** 2 + lengths[:-1] ** 2) / 12.0
    corrected[:, 1:-1] += squares * np.diff(steps / lengths, axis=1) / (lengths[1:] + lengths[:-1])
    coefficients = CubicSpline(nodes, corrected, axis=1, bc_type="natural").c[::-1, piece]
    return np.asarray((coefficients * lengths[piece] ** np.arange(4)[:, None]).T)
