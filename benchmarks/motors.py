"""How long one second of a motor takes, on every field, one way and two way, with a point and with 32 points.

    python -m benchmarks.motors [ROUNDS]

Seconds of the processor in one thread for one second of the paper's beam at 4276 Hz, 49 parts, 61 steps to a period at
least, from runs of a tenth of a second, warm: medians of ROUNDS (5) in turns. The nonlinear chain moves itself first;
its figures are of 10 ms.
"""

import platform
import sys
from datetime import date
from statistics import median
from time import process_time

from msgspec.structs import replace

from verify import Beam, Contact, Foot, PointForce, Slider, run_motor
from verify.bench.machine import machine

BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
FORCES = (PointForce(position=0.0116, amplitude=3.0), PointForce(position=0.4884, amplitude=3.0, phase_deg=90.0))
POINT = Slider(mass=0.05, mu=0.2, law="coulomb", preload=0.5, contact=Contact(stiffness=3e6, damping=20.0))
SLIDERS = {"a point": POINT, "32 points": replace(POINT, foot=(Foot(length=0.0465, points=32),))}
FIELDS = {"segment": 49, "fem": 49, "analytic": None, "chain": 49}
SECONDS, CHAIN_SECONDS = 0.1, 0.01


def second(model: str, shape: str, law: str, coupling: str) -> float:
    """Processor seconds for one second."""
    slider, chain = replace(SLIDERS[shape], law=law, coupling=coupling), model == "chain"
    seconds = CHAIN_SECONDS if chain else SECONDS
    start = {"start": "rest", "modal_damping": 0.0} if chain else {}
    began = process_time()
    run_motor(BEAM, FORCES, 4276.0, seconds, slider=slider, model=model, count=FIELDS[model], samples=11, **start)
    return (process_time() - began) / seconds


def main(rounds: int) -> None:
    """Print the table."""
    cases = [
        (model, shape, law, coupling)
        for model in FIELDS
        for shape in SLIDERS
        for law in ("coulomb", "tanh")
        for coupling in ("one-way", "two-way")
        if not (model == "chain" and coupling == "two-way")
    ]
    times: dict[tuple[str, ...], list[float]] = {case: [] for case in cases}
    for turn in range(rounds + 1):
        for case in cases:
            spent = second(*case)
            if turn:  # the first compiles
                times[case].append(spent)
    named = f"{machine()['processor']}, Python {platform.python_version()}"
    print(f"{date.today()}: {named}; medians of {rounds} in turns.\n")
    print("| field | slider | friction | coupling | processor seconds for one second |\n|---|---|---|---|---|")
    for case, spent in times.items():
        print(f"| {' | '.join(case)} | {median(spent):.3f} |")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
