"""A beam as a chain of rigid bodies: its joints, its frequencies, and every file in its engine."""

import json
import runpy
from xml.etree import ElementTree

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh, null_space

from verify import Beam, PointMass, PointSpring, Section, SegmentModel
from verify.cli import status_of
from verify.engines.describe import describe
from verify.engines.description import AXES
from verify.engines.writers import mjcf, write
from verify.exact.torsion import shafts, torsion_constant, torsion_hz
from verify.problem.beam import in_plane
from verify.problem.phrase import beam_table
from verify.validation import convert

PHRASE = "1 m x 40 x 8 mm steel, clamped-free"
STEEL = convert(beam_table(PHRASE), Beam)
GRIPPER = replace(
    STEEL,
    section=(Section(length=0.37), Section(length=0.63, thickness=0.005, width=0.03)),
    mass=(PointMass(position=1.0, mass=0.3, rotary_inertia=1e-3), PointMass(position=0.23, mass=0.2)),
)
STEPPED = replace(GRIPPER, spring=(PointSpring(position=0.71, stiffness=3e3),))
PROPPED = replace(STEEL, supports=("pinned", "clamped"), mass=(PointMass(position=0.41, mass=0.1),),
                  spring=(PointSpring(position=0.73, stiffness=2e4, rotational=70.0),))  # fmt: skip
CASES = {
    "gripper": GRIPPER, "floating": replace(STEEL, supports=("free", "free")), "stepped": STEPPED, "propped": PROPPED,
    "guided": replace(STEEL, supports=("guided", "pinned")),
}  # fmt: skip
"""The first two have no support at the far end and no spring to the ground."""
COUNTS = (8, 20, 100)
SHIFT = 1e4
"""Of omega^2, near the lowest elastic one: neither that nor a rigid motion then costs the others their digits."""


def hertz(mass, stiffness, held=()):
    """Elastic frequencies, ascending, of matrices under constraint rows; one radian per second is no motion."""
    basis = null_space(np.array(held)) if len(held) else np.eye(len(mass))
    mass, stiffness = basis.T @ mass @ basis, basis.T @ stiffness @ basis
    omega2 = 1.0 / eigh(mass, stiffness + SHIFT * mass, eigvals_only=True)[::-1] - SHIFT
    return np.sqrt(omega2[omega2 > 1e-2]) / (2 * np.pi)


def mujoco_hz(path, stiffnesses=None):
    """Elastic frequencies of a file by MuJoCo's mass matrix, tendons and equalities, and springs of the file or by name."""
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_path(str(path))
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    tendons = np.zeros((model.ntendon, model.nv))
    for i, (first, length) in enumerate(zip(model.tendon_adr, model.tendon_num, strict=True)):
        parts = slice(first, first + length)
        tendons[i, model.jnt_dofadr[model.wrap_objid[parts]]] = model.wrap_prm[parts]
    springs = np.diag(np.reshape(model.jnt_stiffness, (model.nv, -1))[:, 0])
    if stiffnesses:
        springs = np.diag([stiffnesses[model.joint(j).name] for j in range(model.njnt)])
    if model.ntendon:
        springs = springs + (tendons.T * np.reshape(model.tendon_stiffness, (model.ntendon, -1))[:, 0]) @ tendons
    return hertz(mass, springs, tendons[model.eq_obj1id])


def as_mjcf(chain, path):
    write(chain, path / "beam.xml")
    return mujoco_hz(path / "beam.xml")


def by_script(engine):
    def run(chain, path):
        pytest.importorskip(engine)
        write(chain, path / f"beam_{engine}.py")
        names = runpy.run_path(str(path / f"beam_{engine}.py"))
        values = np.asarray(names["frequencies_hz"](names["build"]()))
        return values[values > 0.02]

    return run


def springs_beside(path):
    """Stiffnesses by name of the file next to a URDF."""
    joints = enumerate(json.loads(path.with_name(path.name + ".json").read_text())["joints"])
    return {f"joint{j}_{hinge['axis']}": hinge["stiffness"] for j, one in joints for hinge in one["hinges"]}


def as_urdf(chain, path):
    """In Pinocchio, with the stiffnesses of the file next to it."""
    pin = pytest.importorskip("pinocchio")
    assert "URDF has no joint springs" in write(chain, path / "beam.urdf")
    model = pin.buildModelFromUrdf(str(path / "beam.urdf"))
    mass = np.triu(pin.crba(model, model.createData(), pin.neutral(model)))
    springs = springs_beside(path / "beam.urdf")
    return hertz(mass + np.triu(mass, 1).T, np.diag([springs.get(name, 0.0) for name in list(model.names)[1:]]))


def as_sdf(chain, path):
    """A serial tree along x: each joint turns or moves all links beyond it."""
    write(chain, path / "beam.sdf")
    model = ElementTree.parse(path / "beam.sdf").find("model")
    links, joints = model.findall("link"), model.findall("joint")
    at = np.array([float(link.findtext("pose").split()[0]) for link in links])
    axes = np.array([joint.findtext("axis/xyz").split() for joint in joints], float)
    turns, mass = np.array([[joint.get("type") == "revolute"] for joint in joints]), np.zeros((len(at),) * 2)
    for body, inertial in enumerate(link.find("inertial") for link in links):
        arms = np.cross(axes, np.outer(at[body] + float(inertial.findtext("pose").split()[0]) - at, [1, 0, 0]))
        row = np.where(turns, np.hstack([arms, axes]), np.hstack([axes, 0 * axes])).T * (np.arange(len(at)) <= body)
        weights = [inertial.findtext(one) for one in (*["mass"] * 3, "inertia/ixx", "inertia/iyy", "inertia/izz")]
        mass += (row.T * np.array(weights, float)) @ row
    return hertz(mass, np.diag([float(joint.findtext("axis/dynamics/spring_stiffness")) for joint in joints]))


ENGINES = {"mujoco": as_mjcf, "exudyn": by_script("exudyn"), "pinocchio": by_script("pinocchio"), "urdf": as_urdf,
           "sdf": as_sdf}  # fmt: skip


@pytest.mark.parametrize("in_space", [False, True])
@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("engine", ENGINES)
def test_engines_have_the_frequencies_of_the_chain_in_both_planes_and_torsion(engine, count, in_space, tmp_path):
    names = list(CASES)[: 2 if engine in ("urdf", "sdf") else None]
    if count == 100:  # the others take seconds
        names = [] if in_space and engine != "mujoco" else names[:1]
    for name in names:
        chain = describe(CASES[name], count, in_space=in_space, damping=0.01)
        found = ENGINES[engine](chain, tmp_path / name)
        own = np.sort(np.concatenate([chain.frequencies_hz(axis) for axis in chain.axes]))[:7]
        assert found[:7] == pytest.approx(own, rel=1e-9), name
        for axis in chain.axes:
            exact, errors = chain.exact_hz(axis, 3), chain.errors(axis, 3)
            nearest = [found[abs(found - f).argmin()] for f in exact * (1 + errors)]
            assert np.array(nearest) / exact - 1 == pytest.approx(errors, abs=1e-9), (name, axis)


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("beam", CASES.values(), ids=CASES)
def test_chain_is_the_segment_model_with_the_lever_rule(beam, count):
    if beam is PROPPED:
        beam = replace(beam, spring=(PointSpring(position=0.73, stiffness=2e4),))  # a couple at no joint is shared
    model = SegmentModel(beam, count, attachment="lever")
    assert describe(beam, count).frequencies_hz()[:5] == pytest.approx(model.modes(5).frequencies_hz, rel=1e-9)
    space = describe(beam, count, in_space=True)
    for axis in AXES[:2]:
        model = SegmentModel(in_plane(beam, axis), count, attachment="lever", theory="rayleigh")
        assert space.frequencies_hz(axis)[:5] == pytest.approx(model.modes(5).frequencies_hz, rel=1e-9)


def test_joints_of_a_steel_cantilever():
    chain = SegmentModel(STEEL, 20).rigid_chain()
    springs = [joint.hinges[0].stiffness for joint in chain.joints]
    assert springs == pytest.approx([19114.6667, 6144.0, 7479.65217, *[7168.0] * 17, 0.0], rel=1e-8)
    # links with the rotary inertia of their sections against the Euler-Bernoulli beam
    inert = {wall: describe(STEEL, 20, wall=wall, in_space=True).frequencies_hz()[2] for wall in ("gregory", "full")}
    against = {wall: f / describe(STEEL, 20).exact_hz()[2] - 1 for wall, f in inert.items()}
    assert against == pytest.approx({"gregory": -2.24e-4, "full": -4.54e-2}, rel=0.01)
    fourteen = [describe(STEEL, 14, wall=wall).errors()[0] for wall in ("rigid", "full", "half")]
    assert fourteen == pytest.approx([0.0768, -0.0668, -0.0023], abs=1e-4)
    # a spring behind an end is in series with the joints of a wall
    beam = replace(STEEL, supports=("pinned", "free"), spring=(PointSpring(position=0.0, rotational=900.0),))
    coarse, fine = (abs(describe(beam, n).errors()[2]) for n in (10, 20))
    assert 3.8 < np.log2(coarse / fine) < 5.2
    # an inertia at a joint is shared by both links
    beam = replace(STEEL, mass=(PointMass(position=0.6, rotary_inertia=2e-3),))
    assert describe(beam, 80).errors()[2] == pytest.approx(2.1e-4, rel=0.02)  # on one of them -2.5e-3


def test_torsion_constants_and_exact_frequencies():
    assert torsion_constant("rectangle", 1.0, 1.0) == pytest.approx(0.1405770, rel=1e-6)  # Timoshenko and Goodier
    assert torsion_constant("rectangle", 0.1, 1.0) == pytest.approx(0.3123e-3, rel=2e-4)
    assert torsion_constant("tube", 0.05, 0.004) == pytest.approx(np.pi / 32 * (0.05**4 - 0.042**4), rel=1e-14)
    shaft = shafts(STEEL)
    ((_, stiffness, inertia),) = shaft
    speed = np.sqrt(stiffness / inertia)
    assert torsion_hz(shaft, (True, False), 3) == pytest.approx(speed / 4 * np.array([1, 3, 5]), rel=1e-13)
    k = 2 * np.pi * torsion_hz(shaft, (True, False), 2, [(1.0, 3e-4)]) / speed
    assert k * np.tan(k) == pytest.approx([inertia / 3e-4] * 2, rel=1e-11)
    step = np.array([[0.3, 5.0, 2e-5], [0.7, 1.0, 7e-5]])
    k = 2 * np.pi * np.outer(step[:, 0] * np.sqrt(step[:, 2] / step[:, 1]), torsion_hz(step, (True, False), 4))
    assert np.tan(k[0]) * np.tan(k[1]) == pytest.approx([np.sqrt(5.0 * 2e-5 / (1.0 * 7e-5))] * 4, rel=1e-10)


def test_torsion_is_of_order_two_with_an_inertia_at_the_tip():
    errors = [describe(STEPPED, n, in_space=True).errors("torsion", 1)[0] for n in (25, 50, 100)]
    assert all(1.7 < rate < 2.3 for rate in np.diff(-np.log2(np.abs(errors))))
    assert -1e-4 < errors[0] < -1e-5


def test_dashpots_give_the_damping_ratio():
    mujoco = pytest.importorskip("mujoco")
    chain = describe(STEPPED, 12, damping=0.013)
    model = mujoco.MjModel.from_xml_string(mjcf(chain))
    mass, stiffness = chain.matrices()
    damping = np.diag(np.reshape(model.dof_damping, (model.nv, -1))[:, 0])
    for _, row, _, dashpot in chain.grounded("bending"):
        damping = damping + dashpot * np.outer(row, row)
    values, shapes = eigh(stiffness, mass)
    ratios = np.diag(shapes.T @ damping @ shapes) / (2 * np.sqrt(values))
    assert ratios == pytest.approx(0.013 * np.sqrt(values / values[0]), rel=1e-9)


@pytest.mark.parametrize("kind", [".xml", ".sdf", ".urdf", "_exudyn.py", "_pinocchio.py", ".json", ".csv"])
def test_every_file_has_the_dashpots(kind, tmp_path):
    chain, path = describe(GRIPPER, 12, in_space=True, damping=0.013), tmp_path / f"beam{kind}"
    write(chain, path)
    text = path.read_text()
    assert all(repr(hinge.damping) in text for joint in chain.joints[:-1] for hinge in joint.hinges)


REFUSED = {
    "--count 497 --to b.xml": "count = 497", "--to b.py": "to = 'b.py'", '--set beam.supports=["clamped","pinned"] --to b.sdf':
    "SDF has no support of the far end", "--count 4 --mode 6": "count = 4", "--damping 150%": "damping",
    "--wall rigid --to b.xml": "wall = 'rigid'", "--set beam.tension=5": "beam.tension",
    "--space --set beam.rotary_inertia=1e-3": "beam.rotary_inertia", "--count 1": "count = 1",
}  # fmt: skip


@pytest.mark.parametrize("words", REFUSED)
def test_bad_input_is_a_sentence_and_writes_nothing(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert status_of(["chain", "--beam", PHRASE, *words.split()]) == 2
    assert REFUSED[words] in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_command_chooses_n_and_writes_the_file(tmp_path, capsys):
    path = tmp_path / "beam.sdf"
    assert status_of(["chain", "--beam", PHRASE, "--error", "0.01%", "--json", "--to", str(path)]) == 0
    data = json.loads(capsys.readouterr().out)
    count = data["count"]
    assert abs(describe(STEEL, count).errors()[2]) <= 1e-4 < abs(describe(STEEL, count - 1).errors()[2])
    assert len(data["joints"]) == count + 1 == len(data["tables"][0]["rows"])
    assert path.read_text().count("<spring_stiffness>") == count
    assert status_of(["chain", "--beam", PHRASE, "--count", "20"]) == 0
    assert "4 to 19" in capsys.readouterr().out
