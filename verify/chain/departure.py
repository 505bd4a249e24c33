"""Departure of the nonlinear chain from the linear chain by axial inertia.

Rigid links do not stretch: bending shortens the chain and accelerates its mass along x, an inertia of relative size
(kL)^2 <theta^2>, which grows with the square of the force. It is smaller for links that stretch with EA/l.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import product
from math import ceil, pi
from typing import Any

import numpy as np
from msgspec import structs

from verify.arrays import Array
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import linearise
from verify.chain.motion import ChainMotion, Progress, from_rest
from verify.chain.system import ChainSystem, build_system, link_at
from verify.errors import InputError
from verify.problem.beam import Beam, PointForce
from verify.settings import Inertia, Links, Load

NODE = 1e-9
"""Displacement over that of the free beam, F / (m omega^2), below which a position is a node within rounding."""
START_PHASES = (0.0, 45.0, 90.0, 135.0)  # phases of the drive at the start, deg; 180 more mirrors the motion


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


@dataclass(frozen=True, kw_only=True)
class DrivenChain:
    """A chain from rest under harmonic forces.

    `inertia`: rigid links with axial inertia ("full") or without ("transverse"), or links that stretch ("elastic").
    """

    beam: Beam
    forces: Sequence[PointForce]
    frequency_hz: float
    count: int
    load: Load = "lever"
    inertia: Inertia = "full"
    progress: Progress = lambda part: None

    def motion(self, times: Sequence[float] | Array, tolerance: float = 1e-9) -> ChainMotion:
        """The nonlinear motion at these times.

        Raises InputError for a run that diverges, and for large rotations that a second run does not confirm.
        """
        links: Links = "stretching" if self.inertia == "elastic" else "rigid"
        settings: dict[str, Any] = {"load": self.load, "axial_inertia": self.inertia != "transverse", "links": links}
        system = build_system(self.beam, self.count, self.forces, self.frequency_hz, **settings)
        return from_rest(system, np.asarray(times, dtype=float), tolerance=tolerance, progress=self.progress)

    def linear(self) -> ChainSystem:
        """The system of the linear chain, of rigid links."""
        return build_system(self.beam, self.count, self.forces, self.frequency_hz, load=self.load)

    def departure(self, duration: float, x: float | None = None) -> tuple[float, float]:
        """Deflection at x (default: mid-span) less the linear one at the end, and its rms, over the rms of the latter.

        Of the links of both chains. Raises InputError at a node.
        """
        x = 0.5 * self.beam.length if x is None else x
        times = np.linspace(0.0, duration, max(1001, ceil(40 * self.frequency_hz * duration) + 1))
        system = self.linear()
        linear = linear_deflection(system, times, x)
        largest = max(abs(load.force[1]) for load in system.loads)
        if not rms(linear) > NODE * largest / (system.masses.sum() * (2.0 * pi * self.frequency_hz) ** 2):
            raise InputError(f"x = {x!r}: these forces do not move the beam at this position, give another")
        gap = self.motion(times, 1e-10).deflection([x], reading="links")[:, 0] - linear
        return float(abs(gap[-1])) / rms(linear), rms(gap) / rms(linear)

    def departure_over_beam(self, duration: float) -> float:
        """The same at the end of a run, rms over the joints, `START_PHASES` and the wave in either direction."""
        gaps, lines, times = [], [], np.array([0.0, duration])
        for sign, shift in product((1.0, -1.0), START_PHASES):
            forces = [structs.replace(force, phase_deg=sign * force.phase_deg + shift) for force in self.forces]
            chain = replace(self, forces=forces)
            joints = chain.linear().nodes[1:-1]
            lines.append(linear_deflection(chain.linear(), times, joints)[-1])
            gaps.append(chain.motion(times).deflection(joints.tolist(), reading="links")[-1] - lines[-1])
        return rms(np.array(gaps)) / rms(np.array(lines))


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))
