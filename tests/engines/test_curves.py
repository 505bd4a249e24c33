"""Rods along a curve as chains: against a Ritz method, straight beams, and the engines' own matrices."""

import json
from xml.etree import ElementTree

import numpy as np
import pytest

from tests.engines.test_chain_files import as_mjcf, as_urdf, by_script, hertz
from tests.reference.curved_rods import frequencies
from verify import Beam, ExactModel, Section
from verify.answers.chains import engine_chain
from verify.answers.curves import curve_chain
from verify.cli import status_of
from verify.engines.curved import curved_chain
from verify.engines.rod import read_rod
from verify.errors import InputError

R, RISE = 0.3, 0.12
SPEED = np.hypot(R, RISE)
"""Of a helix, m/rad: curvature R/SPEED^2, torsion RISE/SPEED^2."""


def table(path, **columns):
    rows = zip(*(np.broadcast_to(one, np.shape(columns["x"])).tolist() for one in columns.values()), strict=True)
    path.write_text("\n".join([",".join(columns), *(",".join(map(repr, row)) for row in rows)]) + "\n")
    return path


def helix_frame(s, roll=0.0):
    """Tangent, u x tangent, u: Frenet's frame less its torsion, from the normal nearest to z, and a roll."""
    a = s / SPEED
    t = np.stack([R * np.cos(a), R * np.sin(a), RISE + 0 * a], axis=1) / SPEED
    n = np.stack([-np.sin(a), np.cos(a), 0 * a], axis=1)
    angle = (np.pi / 2 - RISE / SPEED**2 * s + roll)[:, None]
    u = np.cos(angle) * n + np.sin(angle) * np.cross(t, n)
    return np.stack([t, np.cross(u, t), u], axis=2)


def helix(path, turn=2.4, points=60):
    """(file, frequencies by Ritz) of a helix whose EI, mass and roll are linear in s."""
    a = np.linspace(0.0, turn, points)
    length, f = SPEED * turn, a / turn
    ei, ei2, gj = 2.0 * (1 - 0.4 * f), 5.0 * (1 - 0.4 * f), 1.1 * (1 - 0.2 * f)
    path = table(path, x=R * np.sin(a), y=R * (1 - np.cos(a)), z=RISE * a, EI=ei, EI2=ei2, GJ=gj,
                 rho_A=0.4 * (1 - 0.3 * f), rho_Ip=3e-5, roll=40.0 * f)  # fmt: skip
    at = lambda s: s / length  # noqa: E731
    stiff = lambda s: [1.1, 2.0, 5.0] * (1 - np.outer(at(s), [0.2, 0.4, 0.4]))  # noqa: E731
    frame = lambda s: helix_frame(s, np.radians(40.0 * at(s)))  # noqa: E731
    spin = 3e-5 * np.array([1, 2 / 7, 5 / 7])
    return path, frequencies(frame, length, stiff, lambda s: 0.4 * (1 - 0.3 * at(s)), spin)[:5] / (2 * np.pi)


def test_a_helix_converges_to_ritz_with_order_four(tmp_path):
    path, exact = helix(tmp_path / "helix.csv", points=240)
    rod = read_rod(path)
    chains = [curved_chain(rod, np.linspace(0.0, rod.s[-1], n + 1)) for n in (20, 40)]
    errors = [one.frequencies_hz(n_modes=4) / exact[:4] - 1.0 for one in chains]
    assert np.log2((errors[0] / errors[1])[[0, 3]]) == pytest.approx(4.0, abs=0.45)  # the others are near zero
    assert 2e-5 < abs(errors[0]).max() < 5e-5
    assert chains[0].exact_hz(n_modes=5) == pytest.approx(
        exact, rel=3e-6
    )  # the estimate is ten times as good as the chain


ARC = np.linspace(0.0, np.pi / 2, 200)


@pytest.mark.parametrize("space", [False, True])
def test_a_quarter_circle_in_its_plane_and_out_of_it_has_order_four(space, tmp_path):
    path = table(tmp_path / "arc.csv", x=np.sin(ARC), y=1 - np.cos(ARC), EI=2.0, EI2=3.0, GJ=1.5, rho_A=0.7,
                 rho_Ip=1e-5)  # fmt: skip
    stiffness, spin = ([1.5, 2, 3], 1e-5 * np.array([1, 0.4, 0.6])) if space else ([1e9, 2, 1e9], 0)

    def frame(s):
        t, u = np.stack([np.cos(s), np.sin(s), 0 * s], axis=1), np.stack([-np.sin(s), np.cos(s), 0 * s], axis=1)
        return np.stack([t, np.cross(u, t), u], axis=2)

    exact = frequencies(frame, np.pi / 2, lambda s: stiffness, lambda s: 0.7, spin)[:3] / (2 * np.pi)
    rod = read_rod(path, in_space=space)
    chains = [curved_chain(rod, np.linspace(0.0, rod.s[-1], n + 1)) for n in (20, 40)]
    errors = [one.frequencies_hz(n_modes=3) / exact - 1 for one in chains]
    assert np.log2((errors[0] / errors[1])[[0, 2]]) == pytest.approx(4.0, abs=0.35)  # the second is near zero in space
    assert 2e-5 < abs(errors[0]).max() < 4e-4


@pytest.mark.parametrize("space", [False, True])
def test_a_straight_curve_is_the_straight_beam(space, tmp_path):
    beam = Beam(
        length=0.9, width=0.04, thickness=0.007, youngs_modulus=7e10, density=2700.0, supports=("clamped", "free")
    )
    path = table(tmp_path / "line.csv", **{"x": [0.0, 0.31, 0.9], "y": 0.0} | ({"z": 0.0} if space else {}))
    one = curve_chain(path, 11, section="40 x 7 mm E=70GPa rho=2700kg/m3", in_space=space).data
    two = engine_chain(beam, 11, in_space=space).data
    for mine, other in zip(one["joints"], two["joints"], strict=True):
        for hinge, right in zip(mine.hinges, other.hinges, strict=True):
            assert (hinge.axis, hinge.stiffness) == (right.axis, pytest.approx(right.stiffness, rel=1e-11))
    for mine, other in zip(one["links"], two["links"], strict=True):
        assert [mine.mass, mine.centre, *mine.inertia] == pytest.approx(
            [other.mass, other.centre, *other.inertia], rel=1e-11
        )
    mine = one["expected"]["coupled" if space else "bending"]["frequencies_hz"]
    other = sorted(hz for each in two["expected"].values() for hz in each["frequencies_hz"])[:3]
    assert mine == pytest.approx(other, rel=1e-9)


def test_a_stepped_line_has_order_two_against_the_exact_beam(tmp_path):
    sections = Section(length=0.4), Section(length=0.6, bending_stiffness=0.7, mass_per_length=0.2)
    beam = Beam(length=1.0, bending_stiffness=3.0, mass_per_length=0.5, section=sections, supports=("clamped", "free"))
    path = table(
        tmp_path / "step.csv", x=[0.0, 0.4, 0.4, 1.0], y=0.0, EI=[3.0, 3.0, 0.7, 0.7], rho_A=[0.5, 0.5, 0.2, 0.2]
    )
    exact = np.array([ExactModel(beam).frequency_hz(mode) for mode in (1, 2, 3)])
    runs = [curve_chain(path, n).data["expected"]["bending"]["frequencies_hz"] for n in (10, 20, 40)]
    errors = [np.array(one) / exact - 1.0 for one in runs]
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2.0, abs=0.3)
    assert 1e-4 < abs(errors[1]).max() < 6e-3
    off = curve_chain(path, 13).data["expected"]["bending"]["frequencies_hz"] / exact - 1.0
    assert abs(off).max() < 2e-2  # a step inside a link, by the integral of its compliance


@pytest.mark.parametrize("damping", ["2% at 3", "2% at 8 Hz"])
def test_dashpots_give_the_ratio_of_a_mode_or_at_a_frequency(damping, tmp_path):
    found = curve_chain(helix(tmp_path / "helix.csv")[0], 20, damping=damping).data
    hertz = found["expected"]["coupled"]["frequencies_hz"][2] if damping.endswith("3") else 8.0
    hinges = [hinge for joint in found["joints"][:-1] for hinge in joint.hinges]
    assert [h.damping / h.stiffness for h in hinges] == pytest.approx([0.04 / (2 * np.pi * hertz)] * 60, rel=1e-9)


def test_sizes_between_points_are_those_of_a_cone(tmp_path):
    path = table(tmp_path / "cone.csv", x=[0.0, 1.2], y=0.0, diameter=[6e-3, 3e-3])
    joints = curve_chain(path, 12, overrides=["E=2GPa", "rho=900"], error=0.3).data["joints"]
    assert joints[7].hinges[0].stiffness == pytest.approx(2e9 * np.pi / 64 * 4.25e-3**4 / 0.1, rel=1e-9)
    path = table(tmp_path / "wedge.csv", x=[0.0, 1.2], y=0.0, z=0.0, width=[0.02, 0.008], thickness=[6e-3, 3e-3])
    found = curve_chain(path, 12, overrides=["E=2GPa", "rho=900", "nu=0.3"], error=0.3).data
    b, h, ratio = 0.013, 4.25e-3, 4.25 / 13
    saint_venant = b * h**3 * (1 / 3 - 0.21 * ratio * (1 - ratio**4 / 12))  # Roark, to 0.5 %
    stiffness = [2e9 * b * h**3 / 12, 2e9 * h * b**3 / 12, 2e9 / 2.6 * saint_venant]
    assert [one.stiffness * 0.1 for one in found["joints"][7].hinges] == pytest.approx(stiffness, rel=5e-3)
    bending = [one.stiffness * 0.1 for one in found["joints"][7].hinges[:2]]
    assert bending == pytest.approx(stiffness[:2], rel=1e-9)
    assert sum(link.mass for link in found["links"]) == pytest.approx(900 * 1.2 * (0.014 * 4.5e-3 + 0.012 * 3e-3 / 12))


@pytest.mark.parametrize("space", [False, True])
def test_a_chain_for_a_step_runs_as_its_table_states(space, tmp_path):
    """The fewest links at a step: poles of MuJoCo's own transition matrix."""
    mujoco = pytest.importorskip("mujoco")
    path = helix(tmp_path / "helix.csv")[0] if space else table(
        tmp_path / "arc.csv", x=np.sin(ARC), y=1 - np.cos(ARC), EI=0.2, rho_A=0.7
    )  # fmt: skip
    wanted = {"step": 4e-3, "engine": "mujoco", "damping": "2% at 1", "mode": 2}
    result = curve_chain(path, path=tmp_path / "rod.xml", **wanted)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "rod.xml"))
    data, n = mujoco.MjData(model), model.nv
    mujoco.mj_forward(model, data)
    matrix = np.zeros((2 * n, 2 * n))
    mujoco.mjd_transitionFD(model, data, 1e-7, True, matrix, None, None, None)
    values = np.linalg.eigvals(matrix)
    poles = sorted(np.log(values[values.imag > 0]) / model.opt.timestep, key=abs)[:2]
    (ran,) = (one for one in result.tables if one.title == "As it runs")
    assert model.opt.timestep == wanted["step"]
    assert [row[4] for row in ran.rows] == pytest.approx([s.imag / (2 * np.pi) for s in poles], rel=1e-6)
    assert [row[7] for row in ran.rows] == pytest.approx([-s.real / abs(s) for s in poles], rel=1e-4)
    with pytest.raises(InputError, match="a step of"):
        curve_chain(path, **wanted | {"step": 0.1})


def as_sdf(chain, path):
    """Frequencies by absolute poses and axes in the links, as of SDF 1.6."""
    from scipy.spatial.transform import Rotation

    from verify.engines.writers import write

    write(chain, path / "rod.sdf")
    model = ElementTree.parse(path / "rod.sdf").find("model")
    poses = np.array([link.findtext("pose").split() for link in model.findall("link")], float)
    turns = Rotation.from_euler("xyz", poses[:, 3:]).as_matrix()
    joints, mass = model.findall("joint"), 0.0
    axes = np.array(
        [turn @ np.array(one.findtext("axis/xyz").split(), float) for turn, one in zip(turns, joints, strict=True)]
    )
    for i, inertial in enumerate(link.find("inertial") for link in model.findall("link")):
        centre = poses[i, :3] + turns[i] @ np.array(inertial.findtext("pose").split()[:3], float)
        own = turns[i] @ np.diag([float(inertial.findtext(f"inertia/i{d}{d}")) for d in "xyz"]) @ turns[i].T
        rows = np.hstack([np.cross(axes, centre - poses[:, :3]), axes]) * (np.arange(len(axes)) <= i)[:, None]
        mass = mass + float(inertial.findtext("mass")) * rows[:, :3] @ rows[:, :3].T + rows[:, 3:] @ own @ rows[:, 3:].T
    return hertz(mass, np.diag([float(joint.findtext("axis/dynamics/spring_stiffness")) for joint in joints]))


ENGINES = {
    "mujoco": as_mjcf,
    "exudyn": by_script("exudyn"),
    "pinocchio": by_script("pinocchio"),
    "urdf": as_urdf,
    "sdf": as_sdf,
}


@pytest.mark.parametrize("engine", ENGINES)
def test_an_engine_has_the_frequencies_of_the_table(engine, tmp_path):
    """Links of unequal length, twisted sections, springs at rest at zero angles of bodies with rest poses."""
    rod = read_rod(helix(tmp_path / "helix.csv")[0])
    chain = curved_chain(rod, rod.s[-1] * np.linspace(0, 1, 8) ** 1.3)
    assert np.ravel(ENGINES[engine](chain, tmp_path))[:6] == pytest.approx(chain.frequencies_hz(n_modes=6), rel=3e-8)


def test_the_tip_of_the_engine_is_at_the_end_of_the_curve(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    path = helix(tmp_path / "helix.csv")[0]
    curve_chain(path, 12, path=tmp_path / "rod.xml")
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "rod.xml"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert data.site("tip").xpos == pytest.approx([R * np.sin(2.4), R * (1 - np.cos(2.4)), RISE * 2.4], abs=1e-6)
    # of a uniform arc l^2/12R off its chord, away from the axis
    h = 2.4 / 12 * SPEED
    off = np.hypot(*model.body_ipos[model.body_mass > 1e-6][:, 1:].T)
    assert off[4] == pytest.approx(h**2 * R / SPEED**2 / 12, rel=0.01)


def test_links_run_from_point_to_point_without_a_count(tmp_path):
    path = table(
        tmp_path / "branch.csv",
        x=[0.0, 0.02, 0.07, 0.1],
        y=[0.0, 0.01, 0.01, -0.02],
        diameter=[4e-3, 3.5e-3, 3e-3, 2e-3],
    )
    made = tmp_path / "branch.json"
    words = ["--set", "E=2GPa", "--set", "rho=900", "--mode", "2", "--error", "30%", "--to", str(made)]
    assert status_of(["chain", str(path), *words]) == 0
    links = json.loads(made.read_text())["links"]
    assert [one["length"] for one in links] == pytest.approx(
        [np.hypot(0.02, 0.01), 0.05, np.hypot(0.03, 0.03)], rel=1e-9
    )


ROWS = "\n0,0,1,1\n1,0.2,1,1\n2,1,1,1"
BAD = {
    "EI is missing": ("x,y\n0,0\n1,0\n2,1", ()),
    "rho_Ip is missing": ("x,y,z,EI,GJ,rho_A\n0,0,0,1,1,1\n1,0,0,1,1,1", ()),
    "no column: did you mean 'EI'": ("x,y,Ei,rho_A" + ROWS, ()),
    "column EI is there 2 times": ("x,y,EI,EI" + ROWS, ()),
    "in a header": (ROWS[1:], ()),
    "it has 1 points": ("x,y\n0,0", ()),
    "such as x": ("", ()),
    "row 2: y": ("x,y,EI,rho_A\n0,0,1,1\n1,,1,1", ()),
    "row 1: y = '0 kg'": ("x,y [kg],EI,rho_A" + ROWS, ()),
    "row 2: EI = 'nan": ("x,y,EI,rho_A\n0,0,1,1\n1,1,nan,1", ()),
    "row 1 has 4 cells, its header 3": ("x,y,EI" + ROWS, ()),
    "is not below 1e.50": ("x,y,EI,rho_A\n0,0,1,1\n1e200,0,1,1", ()),
    "ends meet": ("x,y,EI,rho_A\n0,0,1,1\n1,1,1,1\n0,2,1,1\n0,0,1,1", ()),
    "belongs to the table": ("x,y,EI,rho_A" + ROWS, ("EI=2",)),
    "E has no effect": ("x,y,EI,rho_A" + ROWS, ("E=2GPa",)),
    "overrides has 3": ("x,y,EI,rho_A" + ROWS, (3,)),
    "is not above 0": ("x,y,EI,rho_A\n0,0,-1,1\n1,0,1,1", ()),
}


@pytest.mark.parametrize("text", BAD)
def test_what_is_wrong_with_a_table_is_one_sentence(text, tmp_path):
    (tmp_path / "curve.csv").write_text(BAD[text][0])
    with pytest.raises(InputError, match=text):
        curve_chain(tmp_path / "curve.csv", 5, overrides=BAD[text][1])
