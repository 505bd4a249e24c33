"""What MuJoCo's Python callback costs: the same steps of the paper's slider with it, and without, so without forces.

`verify bench paper-slider --sets slider` has MuJoCo with its callback, which brings forces and friction; without it
nothing moves, and there is no error to hold a time against. Steps are those at which it comes to 1e-3 and to 1e-5.
Run where the `peers` extra is installed: OMP_NUM_THREADS=1 python -m benchmarks.callback
"""

from statistics import median

from verify.beam import Beam, PointForce
from verify.peers.case import case_of, sled_of
from verify.peers.mujoco import Mujoco
from verify.slider import Slider

BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FORCES = (PointForce(position=0.0116, amplitude=0.1), PointForce(position=0.4884, amplitude=0.1, phase_deg=90.0))
SLIDER = Slider(mass=1e-3, mu=0.2, slope=1e4, coupling="one-way")
STEPS = {49: (7.0e-6, 1.8e-6), 99: (2.0e-6, 6.9e-7)}
ROUNDS, TURN = 9, 100
"""Rounds, and steps to a turn."""


def main() -> None:
    """Print processor time of a step with and without it, and the ratio, for each size and step."""
    for links, steps in STEPS.items():
        case, sled = case_of(BEAM, links, FORCES, 4276.0), sled_of(BEAM, SLIDER)
        runs = (Mujoco().prepare(case, sled), Mujoco().bare(case, sled))
        for step in steps:
            rounds = [[run(step, TURN * step).cpu_s / TURN for run in runs] for _ in range(ROUNDS)]
            pushed, bare = (1e6 * median(times) for times in zip(*rounds, strict=True))
            ratio = median(a / b for a, b in rounds)
            print(f"N = {links}, {1e6 * step:g} us: {pushed:.1f} us a step, {bare:.1f} without it, {ratio:.2f} times")


if __name__ == "__main__":
    main()
