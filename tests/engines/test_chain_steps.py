"""Chains that are chosen for a time step: they run in MuJoCo as promised, and what does not run is refused."""

import shlex
from math import inf, pi, sqrt

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh

from verify import Beam, engine_chain
from verify.cli import status_of
from verify.engines.choice import default_steps
from verify.engines.damping import asked, damped
from verify.engines.describe import describe
from verify.engines.description import Steps
from verify.engines.judgement import judge_file
from verify.errors import InputError
from verify.problem.phrase import beam_table
from verify.validation import convert

PHRASE = "1 m x 40 x 8 mm steel, clamped-free"
STEEL = convert(beam_table(PHRASE), Beam)
FIRST = 6.684133  # Hz, of the exact beam
PINNED = replace(STEEL, supports=("pinned", "pinned"))


def rows(result, title):
    """Rows of a table by the names of its columns."""
    table = next(one for one in result.tables if one.title == title)
    return [dict(zip((column.name for column in table.columns), row, strict=True)) for row in table.rows]


class Engine:
    """A file in MuJoCo."""

    def __init__(self, path):
        self.mujoco = pytest.importorskip("mujoco")
        self.model = model = self.mujoco.MjModel.from_xml_path(str(path))
        self.data, self.mass = self.mujoco.MjData(model), np.zeros((model.nv, model.nv))
        self.mujoco.mj_forward(model, self.data)
        self.mujoco.mj_fullM(model, self.data, self.mass)
        self.mass -= np.diag(model.dof_armature)
        springs = np.diag(np.reshape(model.jnt_stiffness, (model.nv, -1))[:, 0])
        self.squares, self.shapes = eigh(springs, self.mass)

    def vibration(self, mode, largest=1e-6):
        """(Hz, damping ratio) of free vibration from a mode, by a recurrence of samples a quarter of a radian apart."""
        shape, data = self.shapes[:, mode - 1], self.data
        every = max(1, round(0.25 / (sqrt(self.squares[mode - 1]) * self.model.opt.timestep)))
        self.mujoco.mj_resetData(self.model, data)
        data.qpos[:], record = largest * shape / abs(shape).max(), []
        for _ in range(60):
            record.append(self.mass @ shape @ data.qpos)
            self.mujoco.mj_step(self.model, data, nstep=every)
        first, second = np.linalg.lstsq(np.stack([record[1:-1], record[:-2]], axis=1), record[2:], rcond=None)[0]
        s = np.log(np.roots([1.0, -first, -second])[0].astype(complex)) / (every * self.model.opt.timestep)
        return abs(s.imag) / (2 * pi), -s.real / abs(s)

    def grows(self):
        """Whether noise of 1e-9 grows in 2500 steps."""
        self.mujoco.mj_resetData(self.model, self.data)
        self.data.qvel[:] = 1e-9 * np.random.default_rng(5).standard_normal(self.model.nv)
        self.mujoco.mj_step(self.model, self.data, nstep=2500)
        return bool(any(one.number for one in self.data.warning)) or not abs(self.data.qpos).max() < 1e-5


FILES = {  # step, mode, damping, other options; the mode that vibrates, its ratio as asked, within
    "plain": (2e-3, 1, "1%", {}, 1, 0.01, 2e-5),
    "armature": (2e-3, 1, "1%", {"count": 8}, 1, 0.01, 2e-5),
    "two modes": (4e-4, 2, "1% 2% at 1,2", {}, 2, 0.02, 6e-5),
    "band": (2e-4, 2, "2% 5-50Hz within 30%", {}, 2, 0.02, 6e-3),
    "at a mode": (2e-4, 2, "1% at 2", {"engine": "mujoco:RK4"}, 2, 0.01, 2e-5),
    "compensated": (1e-3, 1, "3% compensated", {"engine": "MuJoCo:discrete"}, 1, 0.03, 3e-5),
    "undamped": (2e-3, 1, 0.0, {}, 1, 0.0, 1e-6),
    "explicit dashpots": (1e-4, 2, 0.001, {"engine": "mujoco:Euler without eulerdamp"}, 1, 0.001, 1e-5),
    "in space": (5e-5, 1, 0.01, {"in_space": True}, 1, 0.01, 1e-4),
    "largest step": (None, 3, 0.02, {"count": 8}, 1, 0.02, 1e-4),
    "largest step of RK4": (None, 3, 0.0, {"count": 8}, 1, 0.0, 1e-6),
}


@pytest.mark.parametrize("name", FILES)
def test_file_runs_in_mujoco_as_its_table_says(name, tmp_path):
    step, highest, damping, options, mode, zeta, near = FILES[name]
    result = engine_chain(STEEL, mode=highest, step=step, damping=damping, path=tmp_path / "beam.xml", **options)
    assert result.verdict.level == "trusted"  # of all errors, too
    engine, promised = Engine(tmp_path / "beam.xml"), rows(result, "As it runs")[mode - 1]
    assert not engine.grows()
    assert engine.model.dof_armature.any() == (name == "armature")
    hertz, ratio = engine.vibration(mode)
    assert hertz == pytest.approx(promised["simulated"], rel=1e-5)
    assert ratio == pytest.approx(promised["simulated damping"], abs=1e-6)
    assert ratio == pytest.approx(zeta, abs=near)
    judged = judge_file(tmp_path / "beam.xml", None, highest)
    assert judged.data["passed"] == (name != "compensated")  # of which the file says nothing
    assert rows(judged, "As it runs")[mode - 1]["simulated damping"] == pytest.approx(ratio, abs=1e-6)
    if mode == 1:
        assert hertz == pytest.approx(FIRST * sqrt(1 - zeta**2), rel=0.005)
    if name == "armature":  # a release of 0.3 rad at the wall does not diverge
        assert engine.vibration(1, 0.3)[0] == pytest.approx(hertz, rel=0.05)


def closed(n, mode):
    """Angular frequency of a chain of n links between pins, 1/s."""
    s = np.sin(mode * pi / (2 * n))
    return sqrt(16 * s**4 / (1 - 2 * s * s / 3)) * sqrt(210e9 * 0.008**2 / 12 / 7850) * n**2


def test_table_of_the_trade_by_closed_forms():
    step, mode = 2e-4, 2
    result = engine_chain(PINNED, mode=mode, step=step, engine="drake", damping=0.01)
    found = rows(result, "Links for the step")
    assert [row["links"] for row in found if row["it"] == "is chosen"] == [len(result.data["links"])]
    assert len(found) > 2
    for row in found:
        n = row["links"]
        top, x, zeta = closed(n, n - 1), closed(n, mode) * step, 0.01 * closed(n, mode) / closed(n, 1)
        fast = 0.01 * top / closed(n, 1)
        assert row["step limit"] == pytest.approx((2 * fast + 2 * sqrt(fast**2 + 1)) / top, rel=1e-9)
        d = 2 * zeta * x
        decay, angle = np.log(1 + d) / 2, np.arccos((2 + d - x * x) / (2 * sqrt(1 + d)))
        space = closed(n, mode) / ((mode * pi) ** 2 * sqrt(210e9 * 0.008**2 / 12 / 7850)) - 1
        time = angle / (x * sqrt(1 - zeta**2)) - 1
        assert row["space"] == pytest.approx(space, rel=1e-6)
        assert row["time"] == pytest.approx(time, rel=1e-6)
        assert row["error"] == pytest.approx((1 + space) * (1 + time) - 1, rel=1e-6)
        assert row["damping added"] == pytest.approx(decay / np.hypot(decay, angle) - zeta, rel=1e-6)
        small = max(abs(space), abs(row["error"])) <= 0.01
        assert (row["it"] in ("is chosen", "runs")) == small


@pytest.mark.parametrize(("engine", "sign"), [("drake", -1), ("newton", 1)])
def test_armature_belongs_to_the_step_and_to_the_scheme(engine, sign):
    step = 1e-3
    chosen = engine_chain(STEEL, 6, mode=1, step=step, engine=engine, damping=0.0006)
    beta = next(row["armature, h² k"] for row in rows(chosen, "Links for the step") if row["it"] == "is chosen")
    for joint in chosen.data["joints"][:-1]:
        (hinge,) = joint.hinges
        assert hinge.armature == pytest.approx(beta * step**2 * hinge.stiffness + sign * step * hinge.damping / 2)
        assert hinge.armature > 0.0
    assert 1 / 12 <= beta <= 1 / 4
    with pytest.raises(InputError, match="diverge"):  # without dashpots it is not offered
        engine_chain(STEEL, 6, mode=1, step=step, engine=engine)


def test_largest_step_without_one():
    chain = describe(PINNED, 8)
    top = closed(8, 7)
    assert default_steps(chain).steps.step * top == pytest.approx(sqrt(2), rel=0.05)  # half of RK4's limit
    damping = damped(chain, asked("3%"), None)
    fast = 0.03 * top / closed(8, 1)
    half = default_steps(damping, Steps(inf, "MuJoCo", "RK4"), 1).steps.step
    assert 0.9 < half * top * (fast + sqrt(fast**2 - 1)) / (2.7853 / 2) <= 1.0
    steps = default_steps(damping, None, 3, 0.02).steps
    for step, accurate in ((steps.step, True), (1.1 * steps.step, False)):
        modes, at = damping.simulated(step, "MuJoCo").modes, 2
        errors = modes.hz[at] / modes.file_hz[at] - 1, modes.zeta[at] - modes.file_zeta[at]
        assert bool(max(map(abs, errors)) <= 0.01) == accurate


def test_ratios_as_asked():
    chain = describe(STEEL, 10)
    omega = 2 * pi * chain.frequencies_hz()

    def ratios(text):
        modes = damped(chain, asked(text), None).simulated(1.0, "exudyn").modes
        return modes.file_zeta[:3]

    assert ratios("1.5%") == pytest.approx(0.015 * omega[:3] / omega[0], rel=1e-8)
    assert ratios("2% at 3") == pytest.approx(0.02 * omega[:3] / omega[2], rel=1e-8)
    first, asked_for = omega[:2], np.array([0.01, 0.07])
    fitted = sum(first / asked_for) / sum((first / asked_for) ** 2)
    assert ratios("1% 7% at 1,2 within 60%")[:2] == pytest.approx(fitted * first, rel=1e-7)
    assert ratios(f"2% at {omega[1] / (2 * pi):.12g}Hz") == pytest.approx(ratios("2% at 2"), rel=1e-9)
    assert ratios("3% 10-14 Hz") == pytest.approx(0.03 * omega[:3] / (2 * pi * 12), rel=1e-8)  # of the mean


REFUSED = {
    "--step 2ms --engine MuJoCo --count 20": ("omega_max h = 65.5, limit 2", "step of", "implicitfast"),
    "--step 2ms --engine MuJoCo --damping 1% --mode 2": ("give mode 1", "discrete have"),
    "--step 1ms --engine Gazebo --damping 5% --mode 1": ("compensated", "2.1 %"),
    "--step 1ms --engine Gazebo:DART --space --mode 1": ("in one plane",),
    "--step 1ms": ("engine",),
    "--damping lots": ("1% at 2",),
    "--damping '1% compensated'": ("step",),
    "--damping '1% at 9' --count 5": ("9",),
    "--damping '0.5% compensated' --step 1ms --engine dart": ("238 µs",),
    "--damping '2% 5-50Hz' --step 0.1ms --engine dart": ("81.8", "within 82%"),
}


@pytest.mark.parametrize("words", REFUSED)
def test_refused_with_what_would_run(words, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    line = ["chain", "--beam", PHRASE, *shlex.split(words), "--to", "b.json"]
    assert status_of(line) == 2
    text = capsys.readouterr().err
    assert all(part in text for part in REFUSED[words]), text
    assert not list(tmp_path.iterdir())


def test_a_step_that_is_named_runs():
    chain = {"mode": 2, "damping": "1%", "engine": "mujoco"}
    with pytest.raises(InputError, match="670 µs"):
        engine_chain(STEEL, step=2e-3, **chain)
    assert engine_chain(STEEL, step=6.7e-4, **chain).verdict.level == "trusted"
