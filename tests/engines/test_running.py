"""Files as they run: against one step in closed form, MuJoCo's matrices and MuJoCo's own motion."""

import re
from math import atan, hypot, inf, log, pi, sqrt

import numpy as np
import pytest
from scipy.linalg import eigh

from tests.engines.test_chain_files import STEEL
from tests.engines.test_foreign_files import STRIP
from verify.cli import status_of
from verify.engines.describe import describe
from verify.engines.judgement import judge_file
from verify.engines.writers import mjcf, write
from verify.errors import InputError

mujoco = pytest.importorskip("mujoco")


def written(path, count=20, *, beam=STEEL, step=2e-3, integrator="Euler", edit=("", ""), **more):
    """An MJCF file in steps of an integrator, with a regular expression replaced."""
    text = re.sub(*edit, mjcf(describe(beam, count, **more)))
    path.write_text(re.sub('timestep="[^"]*" integrator="[^"]*"', f'timestep="{step}" integrator="{integrator}"', text))
    return path


def matrices(model, among=""):
    """M, C, K of MuJoCo, of hinges whose names have a word."""
    data, mass = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    data.qpos[:] = model.qpos_spring
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    some = np.ix_(*[[j for j in range(model.njnt) if among in model.joint(j).name]] * 2)
    diagonals = (np.diag(np.reshape(one, (model.nv, -1))[:, 0]) for one in (model.dof_damping, model.jnt_stiffness))
    return mass[some], *(one[some] for one in diagonals)


def omegas(model, among=""):
    mass, _, stiffness = matrices(model, among)
    return np.sqrt(eigh(stiffness, mass, eigvals_only=True))


def load(path, step=None):
    model = mujoco.MjModel.from_xml_path(str(path))
    model.opt.timestep = step or model.opt.timestep
    model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
    return model


def grows(path, step=None):
    """Whether noise of 1e-9 grows in 2500 steps of MuJoCo."""
    model = load(path, step)
    data = mujoco.MjData(model)
    data.qpos[:] = 1e-9 * np.random.default_rng(5).standard_normal(model.nq)
    mujoco.mj_step(model, data, nstep=2500)
    return not abs(data.qpos).max() < 1e-6


def recorded(path, mode):
    """(f, zeta) of MuJoCo's free vibration in an undamped mode, by a recurrence of three samples."""
    model = load(path)
    mass, _, stiffness = matrices(model)
    omega2, shapes = eigh(stiffness, mass)
    shape, data = shapes[:, mode - 1], mujoco.MjData(model)
    apart, record = max(1, round(0.3 / (sqrt(omega2[mode - 1]) * model.opt.timestep))), []
    data.qpos[:] = 1e-6 * shape / abs(shape).max()
    for _ in range(30):
        record.append(mass @ shape @ data.qpos)
        mujoco.mj_step(model, data, nstep=apart)
    first, second = np.linalg.lstsq(np.stack([record[1:-1], record[:-2]], axis=1), record[2:], rcond=None)[0]
    s = np.log(np.roots([1.0, -first, -second])[0].astype(complex)) / (apart * model.opt.timestep)
    return abs(s.imag) / (2 * pi), -s.real / abs(s)


def simulated(result, axis="bending"):
    return [row for row in result.tables[1].records() if row["axis"] == axis]


def test_a_cable_at_two_milliseconds_diverges(tmp_path, capsys):
    path, out = written(tmp_path / "b.xml"), tmp_path / "out.xml"
    assert status_of(["compare", str(path), "--mode", "3", "--corrected", str(out)]) == 1
    first = capsys.readouterr().out.replace("\n", " ")
    top = omegas(load(path))[-1]
    assert (2e-3 * top, 2e6 / top) == pytest.approx((65.5, 61.07), rel=1e-3)
    assert "diverges (omega_max h = 65.5, limit 2): time step at most 61 µs, or 33 substeps" in first
    run = judge_file(path, None, 3).data["run"]
    assert (run["limit"], run["substeps"], run["stable"]) == (pytest.approx(2 / top, rel=1e-6), 33, False)
    assert [grows(path, share * run["limit"]) for share in (0.99, 1.01)] == [False, True]
    assert (judge_file(out, None, 3).data["passed"], grows(out)) == (True, False)


@pytest.mark.parametrize(("integrator", "step"), [("discrete", 2e-3), ("implicitfast", 5e-5)])
def test_frequency_and_damping_are_those_of_the_engine(tmp_path, integrator, step):
    path = written(tmp_path / "c.xml", step=step, integrator=integrator, damping=0.01)
    result = judge_file(path, None, 3)
    for mode, row in enumerate(simulated(result), 1):
        found = recorded(path, mode)
        assert row["simulated"] == pytest.approx(found[0], rel=1e-5)
        assert row["simulated damping"] == pytest.approx(found[1], abs=1e-5)
        assert row["added"] == pytest.approx(row["simulated damping"] - row["damping"], abs=1e-12)
    assert result.data["passed"] == (integrator != "discrete")
    if integrator == "discrete":
        assert (row["simulated"], row["simulated damping"]) == pytest.approx((68.14, 0.606), rel=1e-3)
        assert (row["meant"], row["damping"]) == pytest.approx((117.29 * sqrt(1 - 0.1755**2), 0.1755), rel=1e-3)
        assert "mode 3 runs at 68.1 Hz with 61 % damping, 43 points of it the integrator's" in result.verdict.headline
        assert result.data["run"]["limit"] == inf


def test_limit_holds_with_dashpots_of_one_value(tmp_path):
    """Without them it is 166 microseconds."""
    path = written(tmp_path / "in.xml", 14, beam=STRIP, step=5e-4, edit=('damping="[^"]*"', 'damping="0.02"'))
    result = judge_file(path, None, 3, corrected=tmp_path / "out.xml")
    limit = result.data["run"]["limit"]
    assert (2 / omegas(load(path))[-1], limit) == pytest.approx((1.66e-4, 2.735e-4), rel=2e-3)
    assert (grows(path), grows(path, 1.01 * limit), grows(path, 0.99 * limit)) == (True, True, False)
    assert judge_file(tmp_path / "out.xml", None, 3).data["passed"]
    path.write_text(path.read_text().replace("<option", '<option><flag eulerdamp="disable"/></option><option'))
    limit = judge_file(path, None, 3).data["run"]["limit"]
    assert limit < 1.4e-4
    assert (grows(path, 1.01 * limit), grows(path, 0.99 * limit)) == (True, False)


def implicit_euler(omega, step):
    """(f, zeta) of an undamped mode."""
    size, angle = log(1 + (omega * step) ** 2) / 2, atan(omega * step)
    return angle / (2 * pi * step), size / hypot(size, angle)


@pytest.mark.parametrize("suffix", ["sdf", "urdf"])
def test_files_without_a_step_are_judged_in_space_only(tmp_path, suffix):
    path, chain = tmp_path / f"beam.{suffix}", describe(STEEL, 20)
    write(chain, path)
    result = judge_file(path, None, 3)
    assert (result.data["run"], result.data["passed"]) == ({}, True)
    assert "in space only" in result.verdict.headline
    for engine, step in (("DART", 1e-3), ("drake:SAP, PD gains", 1e-4)):
        rows = simulated(judge_file(path, None, 3, engine=engine, step=step))
        found = [(row["simulated"], row["simulated damping"]) for row in rows]
        expected = [implicit_euler(2 * pi * hz, step) for hz in chain.frequencies_hz(n_modes=3)]
        assert np.array(found) == pytest.approx(np.array(expected), rel=1e-9)
    run = judge_file(path, None, 3, engine="drake", step=1e-4).data["run"]
    assert run["limit"] == pytest.approx(1 / (pi * chain.frequencies_hz()[-1]), rel=1e-6)
    gazebo = judge_file(path, None, 3, engine="gazebo", step=1e-4).data["run"]
    steps = np.array([run["accurate_steps"][0], *gazebo["accurate_steps"]])  # in frequency, frequency, damping
    assert steps * 2 * pi * chain.frequencies_hz()[2] == pytest.approx([0.483, 0.175, 0.02], rel=0.01)
    with pytest.raises(InputError, match="its frequencies depend"):
        judge_file(path, None, 3, engine="newton:XPBD", step=1e-4)
    assert status_of(["compare", str(path), "--engine", "gazebo", "--step", "1ms"]) == 1
    assert status_of(["compare", str(path), "--engine", "gazebo", "--step", "10us"]) == 0
    assert status_of(["compare", "steel-cantilever", "27.6", "--step", "1ms"]) == 2


def test_step_of_an_sdf_world(tmp_path):
    path, out = tmp_path / "beam.sdf", tmp_path / "out.sdf"
    write(describe(STEEL, 20), path)
    physics = '<world name="w"><physics type="{}"><max_step_size>0.001</max_step_size></physics><model'
    for kind, known in (("dart", True), ("ode", False)):
        text = path.read_text().replace("<model", physics.format(kind)).replace("</model>", "</model></world>")
        (tmp_path / "world.sdf").write_text(text)
        result = judge_file(tmp_path / "world.sdf", None, 3, corrected=out)
        assert bool(result.data["run"]) == known
        assert result.data["passed"] != known
        assert judge_file(out, None, 3).data["passed"]
        assert float(re.search("<max_step_size>([^<]*)", out.read_text())[1]) < (3e-5 if known else 1)


def test_the_axis_that_sets_the_step_and_the_joint_at_the_wall_in_torsion(tmp_path):
    path, out = written(tmp_path / "s.xml", step=4e-5, in_space=True), tmp_path / "out.xml"
    limit, axis = min((2 / omegas(load(path), axis)[-1], axis) for axis in ("bending", "width", "torsion"))
    run = judge_file(path, None, 3).data["run"]
    assert (run["axis"], run["limit"]) == (axis, pytest.approx(limit, rel=1e-6))
    half = r'(joint0_torsion.*?stiffness=")([\d.]+)', lambda old: f"{old[1]}{float(old[2]) / 2!r}"
    written(path, step=4e-5, in_space=True, edit=half)
    for beam in (None, STEEL):
        result = judge_file(path, beam, 2, corrected=out)
        shaft = next(one for one in result.data["chains"] if one["axis"] == "torsion")
        thin, wide = 0.008, 0.04  # Roark's formula for a rectangle
        twist = wide * thin**3 * (1 / 3 - 0.21 * thin / wide * (1 - (thin / wide) ** 4 / 12)) * 210e9 / 2.6
        exact = np.array([1, 3]) / 4 * sqrt(twist / (7850 * thin * wide * (thin**2 + wide**2) / 12))
        assert shaft["exact_hz"] == pytest.approx(exact, rel=2e-3)
        assert shaft["frequencies_hz"] == pytest.approx(omegas(load(path), "torsion")[:2] / (2 * pi), rel=1e-9)
        assert (len(shaft["faults"]), shaft["error"][0]) == (1, pytest.approx(-1 / 41, rel=0.05))
        right = omegas(load(out), "torsion")[:2] / (2 * pi)
        assert right / shaft["exact_hz"] - 1 == pytest.approx(-((np.array([1, 3]) * pi / 40) ** 2) / 24, rel=0.01)


@pytest.mark.parametrize(
    "case", ["0.9 -z 0.0075", "1.2 -z 0.0133", "0.13 x 0.0083", "0.2 -x -0.0128", "296 y 0", "296 -z 5"]
)
def test_a_weight_that_changes_the_first_frequency_is_named(tmp_path, case):
    """EI/L^2, direction, change by the tangent about equilibrium in MuJoCo 4.0.0."""
    weight, change = (float(case.split()[i]) for i in (0, 2))
    pull = [weight * 358.4 / 2.512 * (-1 if "-" in case.split()[1] else 1) * (axis in case) for axis in "xyz"]
    gravity = f'gravity="{" ".join(map(str, pull))}"'
    path = written(tmp_path / "rope.xml", step=1e-5, edit=('gravity="0 0 0"', gravity))
    result = judge_file(path, None, 3)
    assert result.data["passed"] == (abs(change) < 0.01)
    words = ("not judged under gravity", f"{weight:.3g} EI/L^2")
    assert all((word in result.verdict.headline) != result.data["passed"] for word in words)
    if weight == 1.2:
        assert result.verdict.margins[0].size == pytest.approx(change, rel=0.03)


def test_armature_counts_to_the_integrator(tmp_path):
    """h^2 k/4 on every hinge makes the trapezoidal rule of MuJoCo's Euler."""
    step, rule = 1e-3, ('stiffness="([^"]*)"', lambda k: f'{k[0]} armature="{1e-6 * float(k[1]) / 4!r}"')
    path = written(tmp_path / "in.xml", step=step, edit=rule)
    result, chain = judge_file(path, None, 3, within=0.05), describe(STEEL, 20)
    omega = 2 * pi * chain.frequencies_hz(n_modes=3)
    assert [row["file"] for row in simulated(result)] == pytest.approx(omega / (2 * pi), rel=1e-9)
    trapezoidal = np.arctan(omega * step / 2) / (pi * step)
    assert [row["simulated"] for row in simulated(result)] == pytest.approx(trapezoidal, rel=1e-9)
    assert (result.data["passed"], grows(path)) == (True, False)
    assert 1e-3 < result.data["run"]["limit"] < 1.01e-3  # right at one step
