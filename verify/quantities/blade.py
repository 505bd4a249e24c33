"""Quantities of a beam on a moving base: the path of its tip, frequencies and extension in steady rotation.

Both models are planar and undamped, without shear and rotary inertia of the section; links do not stretch.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from math import hypot, pi
from time import perf_counter
from typing import TYPE_CHECKING, Annotated, Any, Literal

import msgspec
import numpy as np
from msgspec import Meta

from verify import settings
from verify.arrays import Array
from verify.errors import InputError
from verify.linear.positions import SLACK
from verify.problem.base_motion import Base
from verify.problem.beam import Beam
from verify.quantities.base import Scene, figures, quantity
from verify.quantities.options import Mode, Size
from verify.validation import check_integer, unit

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.chain.system import ChainSystem
    from verify.elements.nonlinear import NonlinearHermite
    from verify.scene.model import MovingBase

STIFF = 1e8  # EA over EI/L^2 of elements whose EA is unknown: rounding leaves eight digits of bending
COUNTS = {"segment": 20, "fem": 8}
"""Numbers within 0.1 % of the tip's path of a spin-up over ten periods (docs/findings/large-motion.md)."""
MOST_STEPS = {"segment": 1e7, "fem": 1e6}
"""Time steps at which a run is refused: minutes of 20 links; of 8 elements twenty minutes, and 1 GB of states."""
TOLD = 2.0  # s of a run after which the time that it takes on is told
Model = Annotated[Literal["segment", "fem"], Meta(description="segment: rigid links; fem: nonlinear elements")]
AxialStiffness = Annotated[
    float, unit("N"), Meta(gt=0, description="EA of elements, N; default: the section's, 1e8 EI/L^2 where unknown")
]
Rate = Annotated[float, unit("rad/s"), Meta(description="of the base, rad/s; default: at the end of [base]")]
Tolerance = Annotated[float, Meta(gt=0, le=1e-2, description="error of a time step over the length")]


@dataclass(frozen=True, eq=False, kw_only=True)
class TipPath:
    """Motion of a beam in the frame of its base, x along the straight beam and y across it: +y leads, -y lags."""

    times: Array
    """(n,), s."""
    line: Array
    """(n, points, 2), m: joints of links or nodes of elements, the tip last."""
    root_moments: Array
    """(n,), N m: bending moment at the base."""
    step: float
    """Mean time step, s."""
    energy_lost: float = 0.0
    """By the steps of elements, over the largest energy; of any sign."""

    @property
    def tip(self) -> Array:
        """(n, 2), m."""
        return self.line[:, -1]

    @property
    def root_moment(self) -> float:
        """Largest moment at the base, N m, at the samples."""
        return float(abs(self.root_moments).max())

    @property
    def moved(self) -> float:
        """Largest distance of the tip from its start, m, at least 1 % of the length."""
        return max(float(np.linalg.norm(self.tip - self.tip[0], axis=1).max()), 0.01 * float(self.tip[0, 0]))

    def distance(self, other: "TipPath") -> float:
        """Largest distance of the two tips at a time, over that which the other one moves."""
        return float(np.linalg.norm(self.tip - other.tip, axis=1).max()) / other.moved

    def largest(self, sign: float) -> tuple[float, float]:
        """Largest deflection of the tip towards +y or -y, m, and its time, s, between the samples; 0 for rounding."""
        from scipy.interpolate import CubicSpline

        curve = CubicSpline(self.times, sign * self.tip[:, 1])
        turns = curve.derivative().roots(extrapolate=False)
        at = np.concatenate([self.times, turns[np.isfinite(turns)]])
        best = float(at[np.argmax(curve(at))])
        size = float(curve(best))
        return (size, best) if size > SLACK * self.tip[0, 0] else (0.0, 0.0)


class Path(msgspec.Struct, frozen=True, kw_only=True):
    """A model of the beam on the base of the scene, and its time steps."""

    model: Model = "fem"
    count: Size | None = None
    tolerance: Tolerance = 1e-7
    axial_stiffness: AxialStiffness | None = None
    joints: settings.Joints = "series"
    samples: Annotated[int, Meta(ge=8, le=100_000, description="instants of the path")] = 401


def path_of(scene: Scene, cache: "SolutionCache", path: Path) -> TipPath:
    """The motion on the scene's base from the straight beam that moves with it. Raises InputError."""
    return told_path(scene, cache, path, lambda left: None)


def told_path(scene: Scene, cache: "SolutionCache", path: Path, progress: Callable[[str], object]) -> TipPath:
    """That of `path_of`; `progress` is called with the time that a run of more than `TOLD` seconds takes on."""
    if scene.base is None:
        raise InputError("base is missing: add [base] with a duration and a rotation, x or y")
    base, run = scene.base, _of_links if path.model == "segment" else _of_elements
    times, count = np.linspace(0.0, base.duration, path.samples), path.count or COUNTS[path.model]
    return cache.once(("blade", base, path), lambda: run(scene.beam, base, path, count, times, _left(progress)))


def elements(beam: Beam, count: int, axial_stiffness: float | None) -> "NonlinearHermite":
    """Nonlinear elements with the given EA, else that of the sections, else a large one. Raises InputError."""
    from verify.elements.nonlinear import NonlinearHermite

    if axial_stiffness is None and any(piece.youngs_modulus is None or piece.area is None for piece in beam.pieces):
        axial_stiffness = STIFF * beam.bending_stiffness / beam.length**2
    return NonlinearHermite(beam, count, axial_stiffness=axial_stiffness)


def links(beam: Beam, count: int, joints: settings.Joints, **motion: Any) -> "ChainSystem":
    """Rigid links on a base, whose joints may follow the axial force. Raises InputError."""
    from verify.chain.linearisation import tensioned
    from verify.chain.system import build_system

    system = replace(build_system(beam, count, joints="printed" if joints == "printed" else "series"), **motion)
    return tensioned(system) if joints == "tensioned" else system


def _left(progress: Callable[[str], object]) -> Callable[[float], None]:
    """Of the share of a run that is done: tell once the time that the rest takes at the pace of the first steps."""
    began, told = perf_counter(), False

    def done(share: float) -> None:
        nonlocal told
        if not told and share > 0.0 and (passed := perf_counter() - began) > TOLD:
            told = True
            progress(f"about {passed * (1.0 / share - 1.0):.2g} s left")

    return done


def _of_elements(
    beam: Beam, base: "MovingBase", path: Path, count: int, times: Array, done: Callable[[float], None]
) -> TipPath:
    from verify.elements.nonlinear_motion import large_motion
    from verify.elements.plane_elements import Forces

    model, weight = elements(beam, count, path.axial_stiffness), Forces(gravity=np.array(base.gravity))
    rate, start = base.motion.rotation(0.0)[1], model.rest
    if rate and beam.supports[0] == "clamped":  # else the beam rings along its length
        start = model.bend(rate=rate, hub_radius=base.hub_radius).state
    run = large_motion(
        model,
        times,
        forces=weight,
        base=base.motion,
        start=start,
        tolerance=path.tolerance,
        progress=done,
        most_steps=MOST_STEPS[path.model],
    )
    (r0, a0), (r1, a1) = np.moveaxis(run.states[:, :2], 0, -2)
    size = float(model.nodes[1])
    bend = 6.0 * (r1 - r0) / size**2 - (4.0 * a0 + 2.0 * a1) / size  # r'' of the cubic at its left end
    curvature = (a0[:, 0] * bend[:, 1] - a0[:, 1] * bend[:, 0]) / (a0 * a0).sum(axis=1)
    stiffness = beam.pieces[0].bending_stiffness * (beam.supports[0] == "clamped")
    return TipPath(
        times=times,
        line=run.states[:, :, 0],
        root_moments=stiffness * curvature,
        step=base.duration / run.steps,
        energy_lost=run.energy_lost,
    )


def _of_links(
    beam: Beam, base: "MovingBase", path: Path, count: int, times: Array, done: Callable[[float], None]
) -> TipPath:
    from verify.chain.kinematics import at_rest
    from verify.chain.motion import check_moved, simulate

    system = links(beam, count, path.joints, base=base.motion, gravity=base.gravity)
    run = simulate(
        system, at_rest(system), times, tolerance=path.tolerance, progress=done, most_steps=MOST_STEPS[path.model]
    )
    check_moved(run)
    step = base.duration / run.statistics.steps
    return TipPath(times=times, line=run.in_base(), root_moments=run.root_moments(), step=step)


blade = figures("blade", path_of, reads=("beam", "base"))
blade("lag", "m", "Largest deflection of the tip towards -y of the base.", read=lambda path: path.largest(-1.0)[0])
blade("lead", "m", "Largest deflection of the tip towards +y of the base.", read=lambda path: path.largest(1.0)[0])
blade("tip_x", "m", "Coordinate of the tip along the straight beam at the end.", read=lambda path: path.tip[-1, 0])
blade("tip_y", "m", "Coordinate of the tip across the straight beam at the end.", read=lambda path: path.tip[-1, 1])
blade("root_moment", "N m", "Largest bending moment at the base.")


class Rotating(msgspec.Struct, frozen=True, kw_only=True):
    """A model of the beam in steady rotation, about its straight equilibrium without gravity."""

    mode: Mode
    model: Model = "fem"
    count: Size | None = None
    rate: Rate | None = None
    joints: settings.Joints = "series"
    axial_stiffness: AxialStiffness | None = None

    def frequency_hz(self, scene: Scene, *, flapping: bool) -> float:
        """Natural frequency, Hz. Raises InputError."""
        from verify.chain.kinematics import at_rest
        from verify.chain.linearisation import linearise

        count, (rate, radius) = self.count or 2 * COUNTS[self.model], _rotation(scene, self.rate)
        check_integer("count", count, self.mode)
        if self.model == "fem":
            spun = elements(scene.beam, count, self.axial_stiffness).bend(rate=rate, hub_radius=radius)
            return float(spun.frequencies_hz(flapping=flapping)[self.mode - 1])
        system = links(scene.beam, count, self.joints, hub_rate=rate, base=Base(hub_radius=radius))
        omega = float(linearise(system, at_rest(system)).frequencies()[self.mode - 1])
        # in the plane the centrifugal force takes the square of the rate off the stiffness over the mass
        return (hypot(omega, rate) if flapping else omega) / (2.0 * pi)


def _rotation(scene: Scene, rate: float | None) -> tuple[float, float]:
    """The given rate of rotation, else that at the end of [base], rad/s, and the hub radius, m. Raises InputError."""
    if scene.base is not None:
        motion, end = scene.base.motion, scene.base.duration
        return motion.rotation(end)[1] if rate is None else rate, motion.hub_radius
    if rate is None:
        raise InputError("rate is missing: give it, or add [base] with a rotation")
    return rate, 0.0


@quantity("blade.lead_lag", unit="Hz", reads=("beam", "base"))
def lead_lag(scene: Scene, rotating: Rotating) -> float:
    """Natural frequency in the plane of steady rotation, relative to the base."""
    return rotating.frequency_hz(scene, flapping=False)


@quantity("blade.flap", unit="Hz", reads=("beam", "base"))
def flap(scene: Scene, rotating: Rotating) -> float:
    """Natural frequency across the plane of steady rotation, of a beam whose EI is the same there."""
    return rotating.frequency_hz(scene, flapping=True)


@quantity("blade.extension", unit="m", reads=("beam", "base"))
def extension(scene: Scene, *, count: Size = 16, rate: Rate | None = None) -> float:
    """Extension of a beam of known EA in steady rotation, by nonlinear elements."""
    from verify.elements.nonlinear import NonlinearHermite

    speed, radius = _rotation(scene, rate)
    return float(NonlinearHermite(scene.beam, count).bend(rate=speed, hub_radius=radius).tip[0]) - scene.beam.length
