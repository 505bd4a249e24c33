"""The nonlinear chain: its run time beside the linear models', and the force with which it drives a motor.

    python -m benchmarks.chain [time] [motor]

time: deflection at 0.37 L of the paper's beam from rest under 1 N, 1 ms, step load; error rms over time against 1600
modes of the exact beam, processor time, minimum of 7 rounds in turns. motor: scene preloaded-motor from rest under a
step load, preload in proportion to the drive, feet held at standstill at 16 places of one wavelength, the wave in
either direction; mean force over mu N in the second half of the run: the part that reverses with the wave (push) and
the part that does not (bias, along +x), with standard errors.
"""

import sys
from collections.abc import Callable
from itertools import product
from math import pi, sqrt
from time import process_time
from typing import Any

import numpy as np
from msgspec.structs import replace
from scipy.interpolate import CubicSpline

from verify import Excitation, Keep, PrescribedSlider, Step, load_scene, simulate
from verify.arrays import Array
from verify.chain import motion as chain_motion
from verify.chain.kinematics import at_rest
from verify.chain.slider_on_chain import slide_on_chain
from verify.chain.system import build_system

SCENE = load_scene("preloaded-motor")
BEAM, HZ = SCENE.beam, 4276.0
SLIDER: Any = SCENE.slider
PLACES = 16


def chain_deflection(count: int, x: float, times: Array) -> Array:
    """(n,), m, with the reading of linear segments: the spline through y + delta^2 y / 12."""
    forces = [replace(force, amplitude=1.0) for force in SCENE.forces]
    system = build_system(BEAM, count, forces, HZ, load="reciprocal")
    motion = chain_motion.simulate(system, at_rest(system), times, tolerance=1e-4)
    y = np.hstack([np.zeros((len(times), 1)), motion.deflection(system.nodes[1:].tolist())])
    y[:, 1:-1] += np.diff(y, 2, axis=1) / 12.0
    return np.asarray(CubicSpline(system.nodes, y, axis=1, bc_type="natural")(x))


def run_time() -> None:
    """Print error and time of segments, elements and the nonlinear chain."""
    x, times = 0.37 * BEAM.length, np.linspace(0.0, 1e-3, 201)
    forces = [replace(force, amplitude=1.0) for force in SCENE.forces]

    def linear(model: str, count: int | None, modes: int | None = None) -> Array:
        settings: dict[str, Any] = {"model": model, "count": count, "modes": modes}
        keep = Keep(at=x, samples=len(times))
        return simulate(BEAM, Excitation(forces, HZ), 1e-3, keep=keep, **settings).deflection[:, 0]

    exact = linear("analytic", None, 1600)
    cases: dict[tuple[str, int], Callable[[int], Array]] = {}
    for n in (49, 98, 147, 196):
        cases["segments", n] = lambda n: linear("segment", n)
        cases["elements", n] = lambda n: linear("fem", n)
        cases["nonlinear chain", n] = lambda n: chain_deflection(n, x, times)
    seconds: dict[tuple[str, int], list[float]] = {key: [] for key in cases}
    errors = {}
    for _ in range(8):
        for key, case in cases.items():
            began = process_time()
            found = case(key[1])
            seconds[key].append(process_time() - began)
            errors[key] = float(np.sqrt(np.mean((found - exact) ** 2) / np.mean(exact**2)))
    print("| model | N | error | ms |\n|---|--:|--:|--:|")
    for key, spent in seconds.items():
        print(f"| {key[0]} | {key[1]} | {errors[key]:.1e} | {1e3 * min(spent[1:]):.1f} |")


def push_and_bias(model: Any, count: Any, force: float, duration: float) -> tuple[Array, Array]:
    """(places,) each, over mu N; `model` is a linear one or the links of the chain."""
    wavelength = 2.0 * pi * sqrt(sqrt(BEAM.bending_stiffness / BEAM.mass_per_length) / (2.0 * pi * HZ))
    scale = force / SCENE.forces[0].amplitude
    slider = replace(SLIDER, preload=scale * SLIDER.preload)
    places = [0.5 * BEAM.length + (k - PLACES // 2) / PLACES * wavelength for k in range(PLACES)]
    held = [PrescribedSlider(replace(slider, position=x), 0.0, fixed_position=True) for x in places]
    how: dict[str, Any] = {"slider": held, "step": Step(per_period=61), "keep": Keep(samples=int(duration * HZ) + 2)}
    means = []
    for sign in (1.0, -1.0):
        forces = [replace(f, amplitude=force, phase_deg=sign * f.phase_deg) for f in SCENE.forces]
        drive = BEAM, Excitation(forces, HZ), duration
        if model in ("rigid", "stretching"):
            run = slide_on_chain(*drive, count=count, links=model, **how)
        else:
            run = simulate(*drive, model=model, count=count, start="rest", modal_damping=0.0, **how)
        means.append(run.friction[len(run.friction) // 2 :].mean(axis=0) / (slider.mu * slider.preload))
    return 0.5 * (means[1] - means[0]), 0.5 * (means[0] + means[1])


def motor() -> None:
    """Print push and bias."""
    print("| drive, N | run, ms | model | N | push | bias |\n|--:|--:|---|--:|---|---|")
    cases = [("analytic", None), *product(("segment", "rigid", "stretching"), (49, 98))]
    grid = [(30.0, 0.02, *case) for case in (*cases, *product(("rigid", "stretching"), (147, 196)))]
    grid += [(force, duration, *case) for force, duration in ((30.0, 0.04), (3.0, 0.02)) for case in cases]
    for force, duration, model, count in grid:
        cells = [
            f"{part.mean():+.2f} ± {part.std(ddof=1) / sqrt(PLACES):.2f}"
            for part in push_and_bias(model, count, force, duration)
        ]
        print(f"| {force:g} | {1e3 * duration:g} | {model} | {count or ''} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    for name, run in (("time", run_time), ("motor", motor)):
        if name in sys.argv[1:] or len(sys.argv) == 1:
            run()
