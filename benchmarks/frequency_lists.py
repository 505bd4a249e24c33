"""Natural frequencies by Exudyn, MuJoCo and PyElastica, as `tests/identify/data` holds them.

    python -m benchmarks.frequency_lists tests/identify/data

Run where `peers` and pyelastica are installed; nothing of `verify` is used. The steel cantilever and the paper's beam,
SI. Recorded with Exudyn 1.13.6, MuJoCo 4.0.0 and PyElastica 1.0.0.
"""

import sys
from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np
from scipy.linalg import eigh, null_space


@dataclass(frozen=True)
class Strip:
    """A uniform strip of rectangular section, divided into n rigid links."""

    length: float
    width: float
    thickness: float
    modulus: float
    density: float
    n: int

    @property
    def link(self) -> float:
        """Length of a link."""
        return self.length / self.n

    @property
    def mass(self) -> float:
        """Of a link."""
        return self.density * self.width * self.thickness * self.link

    @property
    def inertia(self) -> float:
        """Of a thin link about its middle."""
        return self.mass * self.link**2 / 12.0

    @property
    def spring(self) -> float:
        """EI / l."""
        return self.modulus * self.width * self.thickness**3 / 12.0 / self.link


CANTILEVER = Strip(0.3, 0.025, 0.003, 206e9, 7850.0, 30)
PAPER = Strip(0.5, 0.02, 0.001, 70e9, 2700.0, 49)


def exudyn_cantilever(strip: Strip, n_modes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """(frequencies in Hz, x of the links' middles, deflections there (n_modes, n)): a wall joint of 2EI/l."""
    import exudyn as exu
    from exudyn import utilities as items

    system = exu.SystemContainer().AddSystem()
    ground, half = system.AddObject(items.ObjectGround()), strip.link / 2
    middles = (np.arange(strip.n) + 0.5) * strip.link
    nodes = [system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0])) for x in middles]
    bodies = [
        system.AddObject(items.ObjectRigidBody2D(mass=strip.mass, inertia=strip.inertia, nodeNumber=node))
        for node in nodes
    ]

    def point(body: int, x: float) -> int:
        return system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0.0, 0.0]))

    fixed = system.AddNode(items.NodePointGround())
    turns = [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=fixed, coordinate=0))]
    turns += [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2)) for node in nodes]
    for i, body in enumerate(bodies):
        before = point(bodies[i - 1], half) if i else point(ground, 0.0)
        system.AddObject(items.RevoluteJoint2D(markerNumbers=[before, point(body, -half)]))
        stiffness = strip.spring * (1.0 if i else 2.0)
        system.AddObject(items.CoordinateSpringDamper(markerNumbers=turns[i : i + 2], stiffness=stiffness))
    system.Assemble()
    frequencies, vectors = system.ComputeODE2Eigenvalues(convert2Frequencies=True, useAbsoluteValues=True)
    order = np.argsort(frequencies)[:n_modes]
    return np.asarray(frequencies)[order], middles, np.asarray(vectors)[1::3, order].T


def mujoco_pinned(strip: Strip, n_modes: int) -> np.ndarray:
    """Frequencies in Hz of hinges in a tree whose far end a fixed tendon keeps at y = 0 (linear in the angles)."""
    import mujoco

    link, spin = strip.link, strip.inertia
    bodies = "".join(
        f'<body pos="{0.0 if i == 0 else link!r} 0 0"><joint name="hinge{i}" type="hinge" axis="0 -1 0" '
        f'stiffness="{0.0 if i == 0 else strip.spring!r}"/><inertial pos="{link / 2!r} 0 0" mass="{strip.mass!r}" '
        f'diaginertia="{spin / 50!r} {spin!r} {spin!r}"/>'
        for i in range(strip.n)
    )
    levers = "".join(f'<joint joint="hinge{i}" coef="{link * (strip.n - i)!r}"/>' for i in range(strip.n))
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>'
        '<option gravity="0 0 0" jacobian="dense"><flag contact="disable"/></option>'
        f'<worldbody>{bodies}{"</body>" * strip.n}</worldbody><tendon><fixed name="end">{levers}</fixed></tendon>'
        '<equality><tendon tendon1="end"/></equality></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    mass = np.zeros((model.nv, model.nv))
    try:
        mujoco.mj_fullM(model, data, mass)
    except TypeError:  # before version 4
        mujoco.mj_fullM(model, mass, data.qM)
    closure = np.array(data.efc_J).reshape(-1, model.nv)
    free = null_space(closure)
    stiffness = np.diag(np.asarray(model.jnt_stiffness).reshape(model.nv, -1)[:, 0])
    squares = eigh(free.T @ stiffness @ free, free.T @ mass @ free, eigvals_only=True)
    return np.sqrt(squares[:n_modes]) / (2.0 * pi)


def elastica_pinned(strip: Strip, n_modes: int, poissons_ratio: float) -> np.ndarray:
    """Frequencies in Hz of PyElastica's Cosserat rod with pinned ends: it has no modal analysis, so by differences.

    Its inner forces and couples under a small deflection of each node and turn of each element, in the plane x-z.
    """
    from elastica.rod.cosserat_rod import CosseratRod

    n, area = strip.n, strip.width * strip.thickness
    modulus = strip.modulus
    shear = modulus / (2.0 * (1.0 + poissons_ratio))
    axes = np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    rod = CosseratRod.straight_rod(
        n, *axes, strip.length, np.sqrt(area / np.pi), strip.density, youngs_modulus=modulus, shear_modulus=shear
    )
    moments = np.array([strip.thickness * strip.width**3, strip.width * strip.thickness**3]) / 12.0
    moments = np.append(moments, moments.sum())
    rod.bend_matrix[:] = rod.shear_matrix[:] = rod.mass_second_moment_of_inertia[:] = 0.0
    for i, (bend, push) in enumerate(
        zip((modulus, modulus, shear), (5 / 6 * shear, 5 / 6 * shear, modulus), strict=True)
    ):
        rod.bend_matrix[i, i], rod.shear_matrix[i, i] = bend * moments[i], push * area
        rod.mass_second_moment_of_inertia[i, i] = strip.density * strip.link * moments[i]

    def inner(motion: np.ndarray) -> np.ndarray:
        rod.position_collection[2], turns = motion[: n + 1], motion[n + 1 :]
        c, s, frames = np.cos(turns), np.sin(turns), rod.director_collection
        frames[:] = 0.0
        frames[0, 0], frames[0, 2], frames[1, 1], frames[2, 0], frames[2, 2] = -s, c, -1.0, c, s
        rod.compute_internal_forces_and_torques(0.0)
        return np.concatenate([rod.internal_forces[2], rod.internal_torques[1]])

    steps = 1e-7 * np.eye(2 * n + 1)
    stiffness = np.array([(inner(-step) - inner(step)) / 2e-7 for step in steps])
    free = [i for i in range(2 * n + 1) if i not in (0, n)]
    stiffness = 0.5 * (stiffness + stiffness.T)[np.ix_(free, free)]
    mass = np.concatenate([rod.mass, rod.mass_second_moment_of_inertia[1, 1]])[free]
    return np.sqrt(eigh(stiffness, np.diag(mass), eigvals_only=True)[:n_modes]) / (2.0 * pi)


def main(folder: Path) -> None:
    """Write the lists and the shapes."""
    frequencies, x, shapes = exudyn_cantilever(CANTILEVER, 8)
    lines = [f"{mode},{value!r}" for mode, value in enumerate(map(float, frequencies), start=1)]
    (folder / "exudyn-cantilever.csv").write_text("\n".join(["mode,frequency_hz", *lines]) + "\n")
    rows = [",".join(repr(float(v)) for v in (at, *shapes[:, i])) for i, at in enumerate(x)]
    head = ",".join(["x", *(f"mode_{mode}" for mode in range(1, len(shapes) + 1))])
    (folder / "exudyn-cantilever-shapes.csv").write_text("\n".join([head, *rows]) + "\n")
    (folder / "pyelastica-paper.txt").write_text(
        "".join(f"{value:.3f}\n" for value in elastica_pinned(PAPER, 22, 0.33)).replace(".", ",")
    )
    omegas = 2.0 * pi * mujoco_pinned(PAPER, 22)
    text = "\n".join(f"{mode}\t{value:.6f}" for mode, value in enumerate(omegas, start=1))
    (folder / "mujoco-paper.tsv").write_text(f"mode\tomega [rad/s]\n{text}\n")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
