"""Large motion: links and nonlinear elements that reach an error, and their processor time.

    python -m benchmarks.large_motion

Static cases: error of the figure. Motions: largest distance of the tip's path from the model's own converged one, over
the largest lag of the spin-up or the pendulum's length; numbers and tolerances are tried in turn, and the row is the
fastest that keeps the error. Links: explicit Dormand-Prince steps; elements: generalised-alpha, implicit. Where Exudyn
is installed, its ANCF cables, with steps, s, in place of tolerances.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from importlib.util import find_spec
from itertools import product
from time import process_time
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.cases import pendulum, spin_up
from verify.cases.table import CASES
from verify.chain.kinematics import at_rest
from verify.chain.motion import simulate
from verify.chain.system import build_system
from verify.elements.nonlinear import NonlinearHermite
from verify.elements.nonlinear_motion import large_motion
from verify.elements.plane_elements import Forces
from verify.problem.base_motion import Base

Try = Callable[[], Any]
LIMITS = (1e-2, 1e-3, 1e-4)
SPUN, SWUNG = np.linspace(0.0, 15.0, 301), np.linspace(0.0, 1.0, 101)
WEIGHT = np.array([0.0, -1.0])


def spun_links(n: int, tolerance: float) -> Array:
    """(301, 2), m, in the frame of the hub."""
    system = replace(build_system(spin_up.BEAM, n), base=Base(rotation=spin_up.hub))
    return simulate(system, at_rest(system), SPUN, tolerance=tolerance).in_base()[:, -1]


def spun_elements(n: int, tolerance: float) -> Array:
    """(301, 2), m."""
    model = NonlinearHermite(spin_up.BEAM, n, axial_stiffness=spin_up.EA)
    return large_motion(model, SPUN, base=Base(rotation=spin_up.hub), tolerance=tolerance).tip


def swung_links(n: int, tolerance: float) -> Array:
    """(101, 2), m."""
    system = replace(build_system(pendulum.BEAM, n), gravity=(0.0, -1.0))
    return simulate(system, at_rest(system), SWUNG, tolerance=tolerance).joints()[:, -1]


def swung_elements(n: int, tolerance: float) -> Array:
    """(101, 2), m."""
    model = NonlinearHermite(pendulum.BEAM, n, axial_stiffness=pendulum.EA)
    return large_motion(model, SWUNG, forces=Forces(gravity=WEIGHT), tolerance=tolerance).tip


def swung_cables(n: int, step: float) -> Array:
    """(101, 2), m: Exudyn's ANCF cable elements with reduced integration of EA, generalised-alpha, radius 0.9."""
    import exudyn
    from exudyn.beams import GenerateStraightLineANCFCable
    from exudyn.itemInterface import Cable2D, SensorNode

    system = exudyn.SystemContainer().AddSystem()
    stiffness = {"physicsBendingStiffness": 0.01, "physicsAxialStiffness": pendulum.EA, "useReducedOrderIntegration": 1}
    cable = Cable2D(physicsMassPerLength=1.0, **stiffness)
    held = {"massProportionalLoad": [0, -1.0, 0], "fixedConstraintsNode0": [1, 1, 0, 0]}
    nodes = GenerateStraightLineANCFCable(system, [0, 0, 0], [1, 0, 0], n, cable, **held)[0]
    position = exudyn.OutputVariableType.Position
    sensor = system.AddSensor(SensorNode(nodeNumber=nodes[-1], storeInternal=True, outputVariableType=position))
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(SWUNG[-1] / step)
    settings.timeIntegration.endTime = float(SWUNG[-1])
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 0.9
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = 0.01
    settings.show.computationTime = False
    system.SolveDynamic(settings)
    rows = np.array(system.GetSensorStoredData(sensor))
    return np.stack([np.interp(SWUNG, rows[:, 0], rows[:, 1 + axis]) for axis in (0, 1)], axis=1)


def runs(run: Callable[[int, float], Array], sizes: list[int], tolerances: list[float]) -> Iterator[tuple[str, Try]]:
    """All tries of a motion: what, and its path."""
    for n, tolerance in product(sizes, tolerances):
        yield f"{n}, {tolerance:g}", lambda n=n, tolerance=tolerance: run(n, tolerance)


def row(name: str, tries: list[tuple[str, Try]], error: Callable[[Any], float]) -> None:
    """Print the fastest try within each limit."""
    measured = []
    for what, attempt in tries:
        attempt()
        began = process_time()
        result = attempt()
        measured.append((process_time() - began, what, error(result)))
    cells = []
    for limit in LIMITS:
        good = min((one for one in measured if abs(one[2]) <= limit), default=None)
        cells.append(f"{good[1]}: {1e3 * good[0]:.3g} ms" if good else "not reached")
    print(f"| {name} | {' | '.join(cells)} |", flush=True)


def static(name: str, sizes: list[int]) -> None:
    """A row of a case without time."""
    row(name, [(str(n), lambda n=n: CASES[name].error(n)) for n in sizes], float)


def main() -> None:
    """Print the table."""
    print("| case: N, tolerance | 1 % | 0.1 % | 0.01 % |\n|---|---|---|---|")
    links, elements = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128], [2, 3, 4, 6, 8, 12, 16, 24]
    for case in ("elastica-deflection", "rotating-cantilever-1", "rotating-cantilever-3"):
        static(case, [n for n in links if n > 4])
    for case in ("elastica-elements", "rotating-cantilever-elements-1", "rotating-cantilever-elements-3"):
        static(case, [n for n in elements if n > 3])
    paths: tuple[Any, ...] = (
        ("spin-up, links", spun_links, [4, 6, 8, 12, 16, 24, 32, 48], [1e-3, 1e-4, 1e-5, 1e-6], (32, 64, 1e-8)),
        ("spin-up, elements", spun_elements, [4, 6, 8, 12], [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 3e-9], (12, 16, 1e-9)),
        ("pendulum, links", swung_links, [6, 8, 12, 16, 24, 32, 48, 64, 96], [1e-3, 1e-4, 1e-5, 1e-6], (48, 96, 1e-9)),
        ("pendulum, elements", swung_elements, [4, 6, 8, 12, 16], [1e-4, 1e-5, 1e-6, 1e-7, 1e-8], (16, 24, 1e-9)),
    )
    if find_spec("exudyn"):
        paths += (("pendulum, ANCF cables", swung_cables, [4, 6, 8, 12, 16, 24, 32], [2e-2, 1e-2, 5e-3], None),)
    for name, run, sizes, tolerances, limit in paths:
        if limit:  # ANCF cables have the limit of the elements
            coarse, fine, sharp = limit
            first, last = run(coarse, sharp), run(fine, sharp)
            order = 2 if run in (spun_links, swung_links) else 4
            true = last + (last - first) / ((fine / coarse) ** order - 1.0)
        size = abs(true[:, 1]).max() if "spin" in name else 1.0
        tries = list(runs(run, sizes, tolerances))
        row(name, tries, lambda path, true=true, size=size: float(abs(path - true).max() / size))


if __name__ == "__main__":
    main()
