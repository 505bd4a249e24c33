"""Natural frequencies by Exudyn, MuJoCo and PyElastica, as the tests of `verify compare` hold them.

    python -m benchmarks.frequency_lists FOLDER
    python -m benchmarks.frequency_lists sets [STEP [PART OF A NAME]]

The steel cantilever and the paper's beam, recorded with Exudyn 1.13.6, MuJoCo 4.0.0 and PyElastica 1.0.0. `sets` counts
the statuses of larger sets of lists than the tests have, every STEP-th of them, and prints lists that are surely wrong.
"""

# mypy: disallow-untyped-calls=False
import sys
from collections import Counter
from collections.abc import Iterator
from importlib import import_module
from itertools import islice, product
from math import pi
from pathlib import Path
from types import SimpleNamespace

import numpy as np
from msgspec.structs import replace
from scipy.linalg import eigh

from tests.reference.closed_lists import BETAS, euler, pinned_timoshenko, written
from tests.reference.discrete_beams import half_links, lumped_elements, rigid_links, tensioned, varying_beam
from verify.compare.compare import Options, compare
from verify.compare.reading import listed
from verify.engines.base import ENGINES, chain_of
from verify.exact.closed_forms import frequency_hz
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam, in_plane
from verify.problem.point_attachments import PointMass
from verify.problem.supports import Support
from verify.segment_model import SegmentModel
from verify.settings import Theory

PAIRS: tuple[tuple[Support, Support], ...]
THEORIES: tuple[Theory, ...] = ("euler-bernoulli", "rayleigh", "timoshenko")
PAIRS = (("clamped", "free"), ("clamped", "clamped"), ("clamped", "pinned"), ("pinned", "pinned"))

CANTILEVER = Beam(length=0.3, width=0.025, thickness=0.003, youngs_modulus=206e9, density=7850.0)
WIDTH, THICKNESS, MODULUS, DENSITY = 0.02, 0.001, 70e9, 2700.0
PAPER = Beam(length=0.5, width=WIDTH, thickness=THICKNESS, youngs_modulus=MODULUS, density=DENSITY)


def exudyn_cantilever(n: int, n_modes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(frequencies in Hz, x of the links' middles, deflections there (n_modes, n)): a wall joint of 2EI/l."""
    import exudyn as exu
    from exudyn import utilities as items

    link, mass = CANTILEVER.length / n, CANTILEVER.mass_per_length * CANTILEVER.length / n
    system = exu.SystemContainer().AddSystem()
    ground, half, middles = system.AddObject(items.ObjectGround()), link / 2, (np.arange(n) + 0.5) * link
    nodes = [system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0])) for x in middles]
    body = {"mass": mass, "inertia": mass * link**2 / 12.0}
    bodies = [system.AddObject(items.ObjectRigidBody2D(nodeNumber=node, **body)) for node in nodes]

    def point(body: int, x: float) -> int:
        return int(system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0.0, 0.0])))

    fixed = system.AddNode(items.NodePointGround())
    turns = [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))]
    turns += [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2)) for node in nodes]
    for i, one in enumerate(bodies):
        before = point(bodies[i - 1], half) if i else point(ground, 0.0)
        system.AddObject(items.RevoluteJoint2D(markerNumbers=[before, point(one, -half)]))
        stiffness = CANTILEVER.bending_stiffness / link * (1.0 if i else 2.0)
        system.AddObject(items.CoordinateSpringDamper(markerNumbers=turns[i : i + 2], stiffness=stiffness))
    system.Assemble()
    frequencies, vectors = system.ComputeODE2Eigenvalues(convert2Frequencies=True, useAbsoluteValues=True)
    order = np.argsort(frequencies)[:n_modes]
    return np.asarray(frequencies)[order], middles, np.asarray(vectors)[1::3, order].T


def elastica_pinned(n: int, n_modes: int, poissons_ratio: float) -> np.ndarray:
    """Frequencies in Hz of PyElastica's Cosserat rod with pinned ends: it has no modal analysis, so by differences.

    Its inner forces and couples under a small deflection of each node and turn of each element, in the plane x-z.
    """
    width, thickness, density, modulus = WIDTH, THICKNESS, DENSITY, MODULUS
    area, shear, link = width * thickness, modulus / (2.0 * (1.0 + poissons_ratio)), PAPER.length / n
    axes = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    stiffness = {"youngs_modulus": modulus, "shear_modulus": shear}
    rod = import_module("elastica.rod.cosserat_rod").CosseratRod.straight_rod(
        n, *axes, PAPER.length, np.sqrt(area / np.pi), density, **stiffness
    )
    moments = np.array([thickness * width**3, width * thickness**3]) / 12.0
    moments = np.append(moments, moments.sum())
    rod.bend_matrix[:] = rod.shear_matrix[:] = rod.mass_second_moment_of_inertia[:] = 0.0
    for i, (bend, force) in enumerate(((modulus, 5 / 6 * shear), (modulus, 5 / 6 * shear), (shear, modulus))):
        rod.bend_matrix[i, i], rod.shear_matrix[i, i] = bend * moments[i], force * area
        rod.mass_second_moment_of_inertia[i, i] = density * link * moments[i]

    def inner(motion: np.ndarray) -> np.ndarray:
        rod.position_collection[2], turns = motion[: n + 1], motion[n + 1 :]
        c, s, frames = np.cos(turns), np.sin(turns), rod.director_collection
        frames[:] = 0.0
        frames[0, 0], frames[0, 2], frames[1, 1], frames[2, 0], frames[2, 2] = -s, c, -1.0, c, s
        rod.compute_internal_forces_and_torques(0.0)
        return np.concatenate([rod.internal_forces[2], rod.internal_torques[1]])

    matrix = np.array([(inner(-step) - inner(step)) / 2e-7 for step in 1e-7 * np.eye(2 * n + 1)])
    free = [i for i in range(2 * n + 1) if i not in (0, n)]
    matrix = 0.5 * (matrix + matrix.T)[np.ix_(free, free)]
    mass = np.concatenate([rod.mass, rod.mass_second_moment_of_inertia[1, 1]])[free]
    return np.asarray(np.sqrt(eigh(matrix, np.diag(mass), eigvals_only=True)[:n_modes]) / (2.0 * pi))


def sets() -> Iterator[tuple[str, Beam, list[float], int, int | None, set[str | None]]]:
    """(set, beam, Hz, digits, N, walls that may be identified) of lists whose origin is known."""
    ends = PAIRS[0]
    thin = Beam(length=0.45, width=0.03, thickness=0.004, youngs_modulus=206e9, density=7850.0, supports=ends)
    ei, mass, length = thin.bending_stiffness, thin.mass_per_length, thin.length
    for h, nu, kappa, digits in product((0.01, 0.03, 0.06), (0.2, 0.25, 0.3, 0.35, 0.45), (5 / 6, pi**2 / 12), (5, 7)):
        thick = Beam(length=0.6, width=1.5 * h, thickness=h, youngs_modulus=206e9, density=7850.0)
        yield "shear of other nu and kappa", thick, pinned_timoshenko(thick, nu, kappa, 8).tolist(), digits, None, set()
    for pair, n, digits, how in product(PAIRS, (4, 6, 8, 10), (3, 4, 5, 6), ("rounded", "cut", "off")):
        beam = Beam(length=0.45, width=0.03, thickness=0.004, youngs_modulus=206e9, density=7850.0, supports=pair)
        hertz = [frequency_hz(beam, mode) for mode in range(1, n + 1)]
        cells = [written(f, digits, how, i) for i, f in enumerate(hertz)]
        yield "digits of exact lists", beam, cells, digits, None, set()
    for at, softness, n, digits in product((1, 2, 6, 12, 36), (0.003, 0.03, 0.3), (5, 8, 20), (6, 15)):
        hertz = varying_beam(length, lambda x: ei, lambda x: mass, *ends, (at, ei / (softness * length)))
        yield "cracks", thin, hertz[:n].tolist(), digits, None, set()
    for taper, n, digits in product((0.01, -0.05, 0.2, 0.5), (5, 8, 20), (6, 15)):
        slope = taper / length
        hertz = varying_beam(
            length, lambda x, s=slope: ei * (1 - s * x) ** 3, lambda x, s=slope: mass * (1 - s * x), *ends
        )
        yield "tapers", thin, hertz[:n].tolist(), digits, None, set()
    for factor, (name, wall), digits, n, count in product(
        (0.9, 0.95, 0.976, 1.02, 1.05), (("half", 2.0), ("full", 1.0)), (4, 5, 6), (5, 8), (20, None)
    ):
        hertz = factor * rigid_links(thin, 20, wall)[:n]
        yield "wrong modulus", thin, hertz.tolist(), digits, count, {name}
    yield from causes(thin)
    sizes = product((1.2, 1.5, 3.3), (0.01, 0.1), PAIRS, THEORIES, (6, 9))
    for ratio, thickness, pair, theory, n in sizes:
        bar = Beam(length=1.0, width=ratio * thickness, thickness=thickness, youngs_modulus=68e9, density=2700.0,
                   supports=pair)  # fmt: skip
        planes = bar, in_plane(bar, "width")
        both = np.ravel([HermiteModel(one, 20, theory=theory).modes(n).frequencies_hz for one in planes])
        yield "both planes in rad/s", bar, (2.0 * pi * np.sort(both)[:n]).tolist(), 6, 20, {None}
        if "clamped" in pair and theory == THEORIES[0]:
            both = np.ravel([SegmentModel(one, 20, wall="full").modes(n).frequencies_hz for one in planes])
            yield "both planes, EI/l at the wall", bar, np.sort(both)[:n].tolist(), 6, 20, {"full"}


def causes(thin: Beam) -> Iterator[tuple[str, Beam, list[float], int, int | None, set[str | None]]]:
    """As `sets`: axial force, half links, bodies, twins and missing modes of a cantilever."""
    length = thin.length
    taut = Beam(length=0.6, width=0.02, thickness=0.0008, youngs_modulus=200e9, density=7850.0, tension=120.0)
    for tension, n, digits in product((120.0, 119.0, 37.0, 0.0, 300.0), (5, 8), (4, 6)):
        yield "tension", taut, tensioned(taut, tension, n).tolist(), digits, None, {None}
    for pair, size, n, digits in product((PAIRS[0], PAIRS[2]), (7, 10, 24), (4, 6), (5, 7)):
        beam = Beam(length=0.45, width=0.03, thickness=0.004, youngs_modulus=206e9, density=7850.0, supports=pair)
        yield "half links", beam, half_links(beam, size)[:n].tolist(), digits, None, {None}
    for size, share, digits in product((8, 12, 20), (0.25, 0.5, 1.0), (5, 7)):
        body, node = PointMass(position=share * length, mass=0.2), round(share * size)
        hertz = lumped_elements(thin, size, bodies=[(node, body.mass)])[:5]
        yield "lumped with a mass", replace(thin, mass=(body,)), hertz.tolist(), digits, None, {None}
    for mass, n, digits in product((0.02, 0.2, 1.0), (4, 6), (5, 7)):
        loaded = replace(thin, mass=(PointMass(position=length, mass=mass),))
        yield (
            "twin: a mass at the end",
            thin,
            HermiteModel(loaded, 80).modes(n).frequencies_hz.tolist(),
            digits,
            None,
            set(),
        )
    for size, n, digits in product((15, 40), (5, 7), (5, 7)):
        hertz = 1.3 * rigid_links(thin, size)[:n] * (1.0 if n == 5 else 1.05)
        yield "twin: factor and wall", thin, hertz.tolist(), digits, None, {"half"}
    for first, n, wall in product((1, 2, 3), (2, 3, 5, 8), (None, 2.0, 1.0)):
        whole = (
            euler(thin, [*BETAS, *((i - 0.5) * pi for i in range(7, 12))])
            if wall is None
            else rigid_links(thin, 30, wall)
        )
        walls: set[str | None] = {"half"} if wall == 2.0 else {"full"} if wall else {None}
        yield "leading modes missing", thin, whole[first : first + n].tolist(), 6, None, walls


def judge(step: int, part: str = "") -> None:
    """Print the statuses by set, and the lists that are identified as what they are not; `part` of a set's name."""
    tally: Counter[tuple[str, str, str]] = Counter()
    for name, beam, hertz, digits, count, walls in islice((one for one in sets() if part in one[0]), 0, None, step):
        cells = [f"{value:.{digits - 1}e}" for value in hertz]
        source = listed("list", [float(cell) for cell in cells], cells)
        result = compare(SimpleNamespace(name="beam", beam=beam), source, None, Options(count=count))
        tally[name, result.data["status"], result.data["best"]["fault"]["kind"]] += 1
        if result.data["identified"] and result.data["best"]["wall"] not in walls:
            print("wrong:", name, cells, result.summary)
    for key, number in sorted(tally.items()):
        print(*key, number, sep=", ")


def main(folder: Path) -> None:
    """Write the lists and the shapes."""
    frequencies, x, shapes = exudyn_cantilever(30, 8)
    lines = [f"{mode},{value!r}" for mode, value in enumerate(map(float, frequencies), start=1)]
    (folder / "exudyn-cantilever.csv").write_text("\n".join(["mode,frequency_hz", *lines]) + "\n")
    rows = [",".join(repr(float(v)) for v in (at, *shapes[:, i])) for i, at in enumerate(x)]
    head = ",".join(["x", *(f"mode_{mode}" for mode in range(1, len(shapes) + 1))])
    (folder / "exudyn-cantilever-shapes.csv").write_text("\n".join([head, *rows]) + "\n")
    elastica = "".join(f"{value:.3f}\n" for value in elastica_pinned(49, 22, 0.33))
    (folder / "pyelastica-paper.txt").write_text(elastica.replace(".", ","))
    omegas = 2.0 * pi * np.asarray(ENGINES["MuJoCo"].adapter().frequencies(chain_of(PAPER, 49, (), 1.0)))[:22]
    text = "\n".join(f"{mode}\t{value:.6f}" for mode, value in enumerate(omegas, start=1))
    (folder / "mujoco-paper.tsv").write_text(f"mode\tomega [rad/s]\n{text}\n")


if __name__ == "__main__":
    if sys.argv[1] == "sets":
        judge(int(sys.argv[2]) if len(sys.argv) > 2 else 1, *sys.argv[3:4])
    else:
        main(Path(sys.argv[1]))
