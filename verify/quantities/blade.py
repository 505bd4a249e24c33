"""Quantities of a beam on a moving base: the path of its tip, frequencies and extension in steady rotation.

Both models are planar and undamped, without shear and rotary inertia of the section; links do not stretch.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import hypot, pi
from typing import TYPE_CHECKING, Annotated, Literal

import msgspec
import numpy as np
from msgspec import Meta, structs

from verify import settings
from verify.arrays import Array
from verify.errors import InputError
from verify.linear.positions import SLACK
from verify.quantities.base import Scene, figures, quantity
from verify.quantities.options import Mode, Size
from verify.validation import check_integer, unit

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.elements.nonlinear import NonlinearHermite
    from verify.scene.model import MovingBase

STIFF = 1e6  # EA of elements with unknown EA over EI/L^2 and over the inertia forces: they stretch by a millionth
COUNTS = {"segment": 20, "fem": 8}
"""Numbers within 0.1 % of the tip's path of a spin-up over ten periods (docs/findings/large-motion.md)."""
Model = Annotated[Literal["segment", "fem"], Meta(description="segment: rigid links; fem: nonlinear elements")]
AxialStiffness = Annotated[
    float, unit("N"), Meta(gt=0, description="EA of elements, N; default: the section's, inextensible where unknown")
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

    @property
    def tip(self) -> Array:
        """(n, 2), m."""
        return self.line[:, -1]

    @cached_property
    def largest_lag(self) -> tuple[float, float]:
        """Largest deflection of the tip towards -y, m, and its time, s, between the samples."""
        return self._largest(-1.0)

    @cached_property
    def largest_lead(self) -> tuple[float, float]:
        """Largest deflection of the tip towards +y, m, and its time, s, between the samples."""
        return self._largest(1.0)

    @property
    def root_moment(self) -> float:
        """Largest moment at the base, N m, at the samples."""
        return float(abs(self.root_moments).max())

    @property
    def moved(self) -> float:
        """Largest distance of the tip from its start, m."""
        return float(np.linalg.norm(self.tip - self.tip[0], axis=1).max())

    def distance(self, other: "TipPath") -> float:
        """Largest distance of the two tips at a time, over that which the other one moves."""
        apart = float(np.linalg.norm(self.tip - other.tip, axis=1).max())
        return apart / other.moved if other.moved else float(apart > 0.0)

    def _largest(self, sign: float) -> tuple[float, float]:
        from scipy.interpolate import CubicSpline

        curve = CubicSpline(self.times, sign * self.tip[:, 1])
        turns = curve.derivative().roots(extrapolate=False)
        at = np.concatenate([self.times, turns[np.isfinite(turns)]])
        best = int(np.argmax(curve(at)))
        size = float(curve(at[best]))
        return (size, float(at[best])) if size > SLACK * self.tip[0, 0] else (0.0, 0.0)  # without rounding


class Path(msgspec.Struct, frozen=True, kw_only=True):
    """A model of the beam on the base of the scene, and its time steps."""

    model: Model = "fem"
    count: Size | None = None
    tolerance: Tolerance = 1e-7
    axial_stiffness: AxialStiffness | None = None
    samples: Annotated[int, Meta(ge=8, le=100_000, description="instants of the path")] = 401


def path_of(scene: Scene, cache: "SolutionCache", path: Path) -> TipPath:
    """The path of the tip on the scene's base. Raises InputError."""
    base, key = base_of(scene), ("blade", scene.base, path)
    if key not in cache.motors:
        times = np.linspace(0.0, base.duration, path.samples)
        path = structs.replace(path, count=path.count or COUNTS[path.model])
        cache.motors[key] = (_of_links if path.model == "segment" else _of_elements)(scene, base, path, times)
    stored: TipPath = cache.motors[key]
    return stored


def base_of(scene: Scene) -> "MovingBase":
    """The scene's base. Raises InputError without one."""
    if scene.base is None:
        raise InputError("base is missing: add [base] with a duration and a rotation, x or y")
    base: MovingBase = scene.base
    return base


def elements(scene: Scene, count: int, axial_stiffness: float | None, rate: float | None = None) -> "NonlinearHermite":
    """Nonlinear elements with the given EA, else that of the section, else a large one for the base's inertia forces.

    Those at `rate`, rad/s, or over the prescribed motion. Raises InputError.
    """
    from verify.elements.nonlinear import NonlinearHermite

    beam = scene.beam
    if axial_stiffness is None and not axial_known(scene):
        bending, force = beam.bending_stiffness / beam.length**2, 0.0
        if scene.base is not None:
            base, motion = scene.base, scene.base.motion
            reach = base.hub_radius + beam.length
            for t in np.linspace(0.0, base.duration, 201).tolist() if rate is None else ():
                _, spin, turn = motion.rotation(t)
                shaken = hypot(motion.x(t)[2], motion.y(t)[2]) + hypot(*base.gravity)
                force = max(force, reach * (spin**2 + abs(turn)) + shaken)
            force = max(force, reach * (rate or 0.0) ** 2) * beam.mass_per_length * beam.length
        axial_stiffness = STIFF * max(bending, force)
    return NonlinearHermite(beam, count, axial_stiffness=axial_stiffness)


def axial_known(scene: Scene) -> bool:
    """Whether the sections of the beam have an axial stiffness."""
    return all(piece.youngs_modulus is not None and piece.area is not None for piece in scene.beam.pieces)


def _of_elements(scene: Scene, base: "MovingBase", path: Path, times: Array) -> TipPath:
    from verify.elements.nonlinear_motion import large_motion
    from verify.elements.plane_elements import Forces

    model = elements(scene, path.count or 0, path.axial_stiffness)
    weight = Forces(gravity=np.array(base.gravity))
    run = large_motion(model, times, forces=weight, base=base.motion, tolerance=path.tolerance)
    (r0, a0), (r1, a1) = np.moveaxis(run.states[:, :2], 0, -2)
    size = float(model.nodes[1])
    bend = 6.0 * (r1 - r0) / size**2 - (4.0 * a0 + 2.0 * a1) / size  # r'' of the cubic at its left end
    curvature = (a0[:, 0] * bend[:, 1] - a0[:, 1] * bend[:, 0]) / (a0 * a0).sum(axis=1)
    stiffness = scene.beam.pieces[0].bending_stiffness * (scene.beam.supports[0] == "clamped")
    return TipPath(times=times, line=run.states[:, :, 0], root_moments=stiffness * curvature)


def _of_links(scene: Scene, base: "MovingBase", path: Path, times: Array) -> TipPath:
    from verify.chain.kinematics import at_rest
    from verify.chain.motion import check_moved, simulate
    from verify.chain.system import build_system

    system = build_system(scene.beam, path.count or 0)
    system = replace(system, base=base.motion, gravity=base.gravity)
    run = simulate(system, at_rest(system), times, tolerance=path.tolerance)
    check_moved(run)
    return TipPath(times=times, line=run.in_base(), root_moments=system.stiffness[0] * run.angles[:, 0])


blade = figures("blade", path_of, reads=("beam", "base"))
blade("lag", "m", "Largest deflection of the tip towards -y of the base.", read=lambda path: path.largest_lag[0])
blade("lag_time", "s", "Time of the largest deflection of the tip towards -y.", read=lambda path: path.largest_lag[1])
blade("lead", "m", "Largest deflection of the tip towards +y of the base.", read=lambda path: path.largest_lead[0])
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
        from verify.chain.linearisation import linearise, tensioned
        from verify.chain.system import build_system
        from verify.problem.base_motion import Base

        count, rate = self.count or 2 * COUNTS[self.model], rate_of(scene, self.rate)
        check_integer("count", count, self.mode)
        radius = scene.base.hub_radius if scene.base else 0.0
        if self.model == "fem":
            spun = elements(scene, count, self.axial_stiffness, rate).bend(rate=rate, hub_radius=radius)
            return float(spun.frequencies_hz(flapping=flapping)[self.mode - 1])
        system = build_system(scene.beam, count, joints="printed" if self.joints == "printed" else "series")
        system = replace(system, hub_rate=rate, base=Base(hub_radius=radius))
        system = tensioned(system) if self.joints == "tensioned" else system
        omega = float(linearise(system, at_rest(system)).frequencies()[self.mode - 1])
        # in the plane the centrifugal force takes the square of the rate off the stiffness over the mass
        return (hypot(omega, rate) if flapping else omega) / (2.0 * pi)


def rate_of(scene: Scene, rate: float | None) -> float:
    """The given rate of rotation, else that of the scene's base at its end, rad/s. Raises InputError without one."""
    if rate is not None:
        return rate
    base = base_of(scene)
    return base.motion.rotation(base.duration)[1]


@quantity("blade.lead_lag", unit="Hz", reads=("beam", "base"))
def lead_lag(scene: Scene, rotating: Rotating) -> float:
    """Natural frequency in the plane of steady rotation, relative to the base."""
    return rotating.frequency_hz(scene, flapping=False)


@quantity("blade.flap", unit="Hz", reads=("beam", "base"))
def flap(scene: Scene, rotating: Rotating) -> float:
    """Natural frequency across the plane of steady rotation, of a beam whose EI is the same there."""
    return rotating.frequency_hz(scene, flapping=True)


@quantity("blade.extension", unit="m", reads=("beam", "base"))
def extension(
    scene: Scene, *, count: Size = 16, rate: Rate | None = None, axial_stiffness: AxialStiffness | None = None
) -> float:
    """Extension of the beam in steady rotation by nonlinear elements."""
    if axial_stiffness is None and not axial_known(scene):
        raise InputError("axial_stiffness is missing: the section has none, give it or the beam's shape and material")
    radius = scene.base.hub_radius if scene.base else 0.0
    spun = elements(scene, count, axial_stiffness).bend(rate=rate_of(scene, rate), hub_radius=radius)
    return float(spun.tip[0]) - scene.beam.length
