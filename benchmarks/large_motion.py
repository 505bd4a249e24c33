"""Large motion: links, nonlinear elements and other programs that reach an error, and their processor time.

    python -m benchmarks.large_motion

Static cases: error of the figure, by the least number. Motions: largest distance of the tip's path from the model's own
converged one, over the largest lag of the spin-up or the pendulum's length; numbers and tolerances are tried in turn,
and the row is the fastest that keeps the error. Links: explicit steps of Dormand and Prince's method with a tolerance,
or of RK4 at 0.95 of its stability limit; elements: generalised-alpha, implicit. Where they are installed, MuJoCo's
chain of the same links (RK4; at rest under damping for the elastica) and Exudyn's ANCF cables, with steps, s, in place
of tolerances.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from itertools import product
from math import log
from time import process_time
from typing import Any

import numpy as np

from benchmarks.large_motion_peers import bent_cables, cables_in_exudyn, links_in_mujoco
from verify.arrays import Array
from verify.cases import pendulum, spin_up
from verify.cases.beams import CANTILEVER, EI, OMEGA
from verify.cases.table import CASES
from verify.chain.kinematics import at_rest
from verify.chain.linearisation import tensioned
from verify.chain.motion import simulate, step_limit
from verify.chain.system import ChainSystem, build_system
from verify.elements.nonlinear import NonlinearHermite
from verify.elements.nonlinear_motion import large_motion
from verify.elements.plane_elements import Forces
from verify.problem.base_motion import Base

Try = Callable[[], Any]
Run = Callable[[int, float], Array]
LIMITS = (1e-2, 1e-3, 1e-4)
SPUN, SWUNG = np.linspace(0.0, 15.0, 301), np.linspace(0.0, 1.0, 101)
WEIGHT = np.array([0.0, -1.0])
RK4, SHARE = 0.0, 0.95  # in place of a tolerance; of the stability limit


def own_steps(system: ChainSystem, tolerance: float) -> dict[str, float]:
    """Arguments of `simulate`."""
    return {"tolerance": tolerance} if tolerance else {"step": SHARE * step_limit(system)}


def spun_links(n: int, tolerance: float, joints: Callable[[ChainSystem], ChainSystem] = lambda same: same) -> Array:
    """(301, 2), m, in the frame of the hub."""
    system = joints(replace(build_system(spin_up.BEAM, n), base=Base(rotation=spin_up.hub)))
    return simulate(system, at_rest(system), SPUN, **own_steps(system, tolerance)).in_base()[:, -1]


def spun_mujoco(n: int, _: float) -> Array:
    """(301, 2), m, in the frame of the hub."""
    system = build_system(spin_up.BEAM, n)
    return links_in_mujoco(system, SPUN, SHARE * step_limit(system), hub=spin_up.hub)


def spun_elements(n: int, tolerance: float) -> Array:
    """(301, 2), m."""
    model = NonlinearHermite(spin_up.BEAM, n, axial_stiffness=spin_up.EA)
    return large_motion(model, SPUN, base=Base(rotation=spin_up.hub), tolerance=tolerance).tip


def spun_cables(n: int, step: float) -> Array:
    """(301, 2), m."""
    return cables_in_exudyn(spin_up.BEAM, spin_up.EA, n, SPUN, step, hub=spin_up.hub)


def swinging(n: int) -> ChainSystem:
    """The links of the pendulum."""
    return replace(build_system(pendulum.BEAM, n), gravity=(0.0, -1.0))


def swung_links(n: int, tolerance: float) -> Array:
    """(101, 2), m."""
    system = swinging(n)
    return simulate(system, at_rest(system), SWUNG, **own_steps(system, tolerance)).joints()[:, -1]


def swung_mujoco(n: int, _: float) -> Array:
    """(101, 2), m."""
    system = swinging(n)
    return links_in_mujoco(system, SWUNG, SHARE * step_limit(system))


def swung_elements(n: int, tolerance: float) -> Array:
    """(101, 2), m."""
    model = NonlinearHermite(pendulum.BEAM, n, axial_stiffness=pendulum.EA)
    return large_motion(model, SWUNG, forces=Forces(gravity=WEIGHT), tolerance=tolerance).tip


def swung_cables(n: int, step: float) -> Array:
    """(101, 2), m."""
    return cables_in_exudyn(pendulum.BEAM, pendulum.EA, n, SWUNG, step, gravity=(0.0, -1.0))


def bent_mujoco(n: int) -> float:
    """Error of the elastica by the rest after 20/omega_1 in implicit steps of 0.3/omega_1 with a damping of 0.7."""
    omega = 3.516 * OMEGA
    chain, times = build_system(CANTILEVER, n), np.linspace(0.0, 20.0 / omega, 11)
    rest = {"force": 4.0 * EI, "damping": 1.4 / omega, "integrator": "discrete"}
    return float(links_in_mujoco(chain, times, 0.3 / omega, **rest)[-1, 1]) / CASES["elastica-deflection"].exact - 1.0


def bent_exudyn(n: int) -> float:
    """Error of the elastica."""
    return bent_cables(CANTILEVER, 1e5 * EI, n, 4.0 * EI) / CASES["elastica-deflection"].exact - 1.0


def runs(run: Run, sizes: list[int], tolerances: list[float]) -> Iterator[tuple[str, Try]]:
    """All tries of a motion: what, and its path."""
    for n, tolerance in product(sizes, tolerances):
        yield f"{n}, {f'{tolerance:g}' if tolerance else 'RK4'}", partial(run, n, tolerance)


def timed(attempt: Try) -> tuple[float, Any]:
    """Processor time, s, of the second call, and its result."""
    attempt()
    began = process_time()
    result = attempt()
    return process_time() - began, result


def row(name: str, tries: list[tuple[str, Try]], error: Callable[[Any], float], *, fewest: bool = False) -> None:
    """Print the fastest try within each limit, or that of the fewest parts."""
    measured = []
    for what, attempt in tries:
        time, result = timed(attempt)
        measured.append((time, what, error(result)))
    cells = []
    for limit in LIMITS:
        within = [one for one in measured if abs(one[2]) <= limit]
        good = within[0] if fewest and within else min(within, default=None)
        cells.append(f"{good[1]}: {1e3 * good[0]:.3g} ms" if good else "not reached")
    print(f"| {name} | {' | '.join(cells)} |", flush=True)


def extrapolated(run: Run, coarse: int, fine: int, sharp: float, order: int) -> Array:
    """The converged path of a model."""
    first, last = run(coarse, sharp), run(fine, sharp)
    return np.asarray(last + (last - first) / ((fine / coarse) ** order - 1.0))


def growth(name: str, run: Run, sizes: list[int], tolerance: float) -> None:
    """Print times by number, and the power of the number with which the last two grow."""
    times = [timed(partial(run, n, tolerance))[0] for n in sizes]
    power = log(times[-1] / times[-2]) / log(sizes[-1] / sizes[-2])
    print(
        f"| {name} | {', '.join(f'{n}: {1e3 * t:.3g} ms' for n, t in zip(sizes, times, strict=True))} | {power:.2f} |"
    )


def main() -> None:
    """Print the tables."""
    mujoco, exudyn = (find_spec(name) is not None for name in ("mujoco", "exudyn"))
    links, elements = [4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128], [3, 4, 6, 8, 12, 16, 24]
    print("| case: N, tolerance or step | 1 % | 0.1 % | 0.01 % |\n|---|---|---|---|")
    statics: list[tuple[str, Callable[[int], float], list[int], bool]] = [
        ("elastica: links", CASES["elastica-deflection"].error, links, True),
        ("elastica: elements", CASES["elastica-elements"].error, elements, True),
        ("elastica: MuJoCo's links", bent_mujoco, links, mujoco),
        ("elastica: Exudyn's cables", bent_exudyn, elements, exudyn),
        ("column at 60 degrees: links", CASES["buckled-60-deflection"].error, [*links, 192, 256], True),
        ("column at 60 degrees: elements", CASES["buckled-elements-60-deflection"].error, elements, True),
    ]
    for mode in (1, 3):
        for models, case, sizes in (
            ("links", "rotating-cantilever", links),
            ("links, tensioned", "rotating-cantilever-tensioned", links[3:]),  # fewer have a joint without stiffness
            ("elements", "rotating-cantilever-elements", elements[1:]),
        ):
            fitting = [n for n in sizes if n > mode]
            statics.append((f"rotating, mode {mode}: {models}", CASES[f"{case}-{mode}"].error, fitting, True))
    for name, error, sizes, installed in statics:
        if installed:
            row(name, [(str(n), partial(error, n)) for n in sizes], float, fewest=True)

    soft = partial(spun_links, joints=tensioned)
    spun, stretched = extrapolated(soft, 32, 64, 1e-9, 4), extrapolated(spun_elements, 12, 16, 1e-9, 4)
    fallen, fallen_elements = extrapolated(swung_links, 48, 96, 1e-9, 2), extrapolated(swung_elements, 16, 24, 1e-9, 4)
    few, some, steps = (
        [6, 8, 10, 12, 16, 20, 24, 32],
        [4, 6, 8, 12, 16, 24, 32, 48, 64, 96],
        [0.01, 0.005, 0.0025, 1.25e-3],
    )
    fine = [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 3e-9]
    motions: list[tuple[str, Run, Array, list[int], list[float], bool]] = [
        ("spin-up: links", spun_links, spun, [4, *few, 48], [1e-5, RK4], True),
        ("spin-up: links, tensioned", soft, spun, few, [1e-5, RK4], True),
        ("spin-up: elements", spun_elements, stretched, [4, 6, 8, 12], fine, True),
        ("spin-up: MuJoCo's links", spun_mujoco, spun, [4, *few, 48], [RK4], mujoco),
        ("spin-up: Exudyn's cables", spun_cables, stretched, [4, 6, 8, 12, 16, 24], steps, exudyn),
        ("pendulum: links", swung_links, fallen, some, [1e-3, 1e-4, 1e-5, RK4], True),
        ("pendulum: elements", swung_elements, fallen_elements, [4, 6, 8, 12, 16], fine[:-1], True),
        ("pendulum: MuJoCo's links", swung_mujoco, fallen, some, [RK4], mujoco),
        ("pendulum: Exudyn's cables", swung_cables, fallen_elements, [4, 6, 8, 12, 16, 24, 32], [0.02, *steps], exudyn),
    ]
    for name, run, true, sizes, tolerances, installed in motions:
        if installed:
            size = abs(true[:, 1]).max() if "spin" in name else 1.0
            row(
                name,
                list(runs(run, sizes, tolerances)),
                lambda path, true=true, size=size: abs(path - true).max() / size,
            )

    print("\n| spin-up, by number | time | power |\n|---|---|---|")
    growth("links, RK4", spun_links, [8, 16, 32, 64], RK4)
    growth("elements, 1e-6", spun_elements, [8, 16, 32, 64], 1e-6)
    if mujoco:
        growth("MuJoCo's links, RK4", spun_mujoco, [8, 16, 32], RK4)
    if exudyn:
        growth("Exudyn's cables, 0.005 s", spun_cables, [8, 16, 32, 64], 0.005)


if __name__ == "__main__":
    main()
