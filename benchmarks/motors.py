"""Processor seconds for one second of a motor on every model, one-way and two-way, with a point and with 32 points.

    python -m benchmarks.motors [ROUNDS]

The paper's beam at 4276 Hz, 49 parts, runs of 0.1 s, warm, medians of ROUNDS (5) in turns.
"""

import sys
from itertools import product
from statistics import median
from time import process_time

from msgspec.structs import replace

from verify import Beam, Contact, Excitation, Foot, Keep, PointForce, Slider, simulate
from verify.report.summary import environment

BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FORCES = (PointForce(position=0.0116, amplitude=3.0), PointForce(position=0.4884, amplitude=3.0, phase_deg=90.0))
EXCITATION = Excitation(FORCES, 4276.0)
POINT = Slider(mass=0.05, mu=0.2, law="coulomb", preload=0.5, contact=Contact(stiffness=3e6, damping=20.0))
SLIDERS = {"a point": POINT, "32 points": replace(POINT, foot=(Foot(length=0.0465, points=32),))}
FIELDS = {"segment": 49, "fem": 49, "analytic": None}


def seconds(model: str, shape: str, law: str, coupling: str) -> float:
    """For one second."""
    slider, began = replace(SLIDERS[shape], law=law, coupling=coupling), process_time()
    simulate(BEAM, EXCITATION, 0.1, slider=slider, model=model, count=FIELDS[model], keep=Keep(samples=11))
    return (process_time() - began) / 0.1


def main(rounds: int) -> None:
    """Print the table."""
    cases = list(product(FIELDS, SLIDERS, ("coulomb", "tanh"), ("one-way", "two-way")))
    table = [[seconds(*case) for case in cases] for _ in range(rounds + 1)][1:]  # the first compiles
    print(", ".join(environment().values()), "\n")
    print("| field | slider | friction | coupling | processor seconds for one second |\n|---|---|---|---|---|")
    for case, spent in zip(cases, zip(*table, strict=True), strict=True):
        print(f"| {' | '.join(case)} | {median(spent):.3f} |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
