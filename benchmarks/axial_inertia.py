"""How linear a chain of rigid links is: the axial inertia of a roller-ended chain, beside linear models and the beam.

The paper's beam from rest for one millisecond at 4276 Hz, 49 links, forces sin at 11.6 mm from the left end and cos at
11.6 mm from the right. Rigid links cannot stretch, so that bending draws the tip in and takes the mass of the chain
along: an inertia of relative size (kL)^2 <theta^2> that grows with the square of the force, whatever the amplitude is
in thicknesses. Links that stretch as the beam does (EA / l) keep a twelfth of it; taken stiffer, they go over into the
rigid ones.
Run: python -m benchmarks.axial_inertia
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from verify import analytic_modes, fem_beam
from verify.beam import Beam, PointForce
from verify.chain_dynamics import at_rest
from verify.chain_elastic import simulate_elastic
from verify.chain_modal import modal_basis, simulate_linear
from verify.chain_motion import ChainMotion, simulate
from verify.chain_system import build_system
from verify.modes import Modes

Array = NDArray[np.float64]
BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FREQUENCY, LINKS, MIDDLE = 4276.0, 49, 0.25
TIMES = np.linspace(0.0, 1e-3, 1001)


def forces(amplitude: float) -> list[PointForce]:
    """Sin at d, cos at L - d."""
    return [
        PointForce(position=0.0116, amplitude=amplitude, phase_deg=-90.0),
        PointForce(position=BEAM.length - 0.0116, amplitude=amplitude),
    ]


def modal_sum(modes: Modes, drives: Sequence[PointForce], x: float) -> Array:
    """Deflection at x from rest by a sum over undamped modes of unit modal mass, (n_times,)."""
    omega, drive = 2 * np.pi * modes.frequencies_hz, 2 * np.pi * FREQUENCY
    total = np.zeros(len(TIMES))
    for force in drives:
        phase = np.deg2rad(force.phase_deg)
        gain = modes.deflection([x])[:, 0] * modes.deflection([force.position])[:, 0] * force.amplitude
        turns = np.outer(TIMES, omega)
        answer = np.cos(drive * TIMES + phase)[:, None] - np.cos(phase) * np.cos(turns)
        answer += drive / omega * np.sin(phase) * np.sin(turns)
        total += answer @ (gain / (omega**2 - drive**2))
    return total


def chain(amplitude: float, *, axial_inertia: bool) -> ChainMotion:
    """The nonlinear chain, converged in time."""
    system = build_system(BEAM, LINKS, forces(amplitude), FREQUENCY, axial_inertia=axial_inertia)
    return simulate(system, at_rest(system), TIMES, tolerance=1e-10, ledger=False)


def stretching(amplitude: float, factor: float = 1.0) -> Array:
    """Mid-span of the chain with links of `factor` times the beam's EA / l, (n_times,)."""
    system = build_system(BEAM, LINKS, forces(amplitude), FREQUENCY)
    motion = simulate_elastic(system, factor * BEAM.youngs_modulus * BEAM.area, TIMES)
    return motion.deflection([MIDDLE])[:, 0]


def rms(values: Array) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    """Print the size of the effect over the force, then all models side by side."""
    system = build_system(BEAM, LINKS, forces(1.0), FREQUENCY)
    linear = simulate_linear(modal_basis(system), at_rest(system), TIMES)
    unit = linear.deflection([MIDDLE])[:, 0]
    beam = modal_sum(analytic_modes.solve_modes(BEAM, 400), forces(1.0), MIDDLE)
    elements = modal_sum(fem_beam.solve_modes(BEAM, 2 * LINKS - 2, LINKS), forces(1.0), MIDDLE)
    wave = np.sqrt(2 * np.pi * FREQUENCY / BEAM.wave_constant) * BEAM.length
    print("departure of the nonlinear chain from the linear one at mid-span, over the linear one's rms")
    kinds = ("rigid links", "no axial inertia", "EA/l", "100 EA/l")
    print(f"{'force':>8}{'rms w':>10}{'(kL)^2<th^2>':>14}" + "".join(f"{kind:>20}" for kind in kinds))
    print(" " * 32 + f"{'at 1 ms':>11}{'rms':>9}" * len(kinds))
    for amplitude in (0.1, 1.0, 10.0, 30.0):
        full, transverse = (chain(amplitude, axial_inertia=kind) for kind in (True, False))
        theta, scale = full.directions(), amplitude * rms(unit)
        fields = [motion.deflection([MIDDLE])[:, 0] for motion in (full, transverse)]
        gaps = [field - amplitude * unit for field in (*fields, stretching(amplitude), stretching(amplitude, 100.0))]
        print(
            f"{amplitude:>6g} N{rms(fields[0]) * 1e6:>7.2f} um{(wave * rms(theta)) ** 2:>14.1e}"
            + "".join(f"{abs(gap[-1]) / scale:>11.1e}{rms(gap) / scale:>9.1e}" for gap in gaps)
        )
    print("\nmid-span at 10 N: rms of the difference to the exact Euler-Bernoulli field over its rms, and w at 1 ms")
    rows = {
        "exact field (400 modes)": 10 * beam,
        f"Hermite elements, {LINKS}": 10 * elements,
        f"linear chain, {LINKS}": 10 * unit,
        "chain of rigid links": chain(10.0, axial_inertia=True).deflection([MIDDLE])[:, 0],
        "  without axial inertia": chain(10.0, axial_inertia=False).deflection([MIDDLE])[:, 0],
        "  links with EA / l": stretching(10.0),
    }
    for name, values in rows.items():
        print(f"{name:<26}{rms(values - 10 * beam) / rms(10 * beam):>10.1e}{values[-1] * 1e6:>12.4f} um")


if __name__ == "__main__":
    main()
