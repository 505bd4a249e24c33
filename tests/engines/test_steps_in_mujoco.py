"""MuJoCo's own steps against the predicted multipliers, limits, frequencies and damping ratios, in its six settings."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.engines.test_integrators import STRIP, apart, strip
from verify import SegmentModel
from verify.engines.choice import armature
from verify.engines.integrators import scheme_of
from verify.engines.steps import Simulated
from verify.engines.writers import mjcf

mujoco = pytest.importorskip("mujoco")
SETTINGS = ["Euler", "implicit", "implicitfast", "Euler without eulerdamp", "RK4", "discrete"]


@pytest.fixture(autouse=True)
def _quiet():
    """The default handler of warnings writes a file."""
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda text: None)
    yield
    mujoco.set_mju_user_warning(before)


class Engine:
    """A chain in MuJoCo: states (q, v) after a step, its matrices."""

    def __init__(self, chain, step, setting, damping=None, inertias=None):
        self.model = model = mujoco.MjModel.from_xml_string(mjcf(chain, step))
        model.opt.integrator = getattr(mujoco.mjtIntegrator, f"mjINT_{setting.split()[0].upper()}")
        model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_AUTORESET
        if "without" in setting:
            model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_EULERDAMP
        if damping is not None:
            model.dof_damping[:] = damping
        if inertias is not None:
            model.dof_armature[:] = inertias
        self.data, self.scheme = mujoco.MjData(model), scheme_of("mujoco", setting)

    def run(self, state, steps=1):
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:], self.data.qvel[:] = np.split(np.asarray(state, dtype=float), 2)
        mujoco.mj_step(self.model, self.data, nstep=steps)
        return np.append(self.data.qpos, self.data.qvel)

    def multipliers(self):
        """By central differences of one step about rest."""
        return np.linalg.eigvals(
            np.array([(self.run(e) - self.run(-e)) / 2e-6 for e in 1e-6 * np.eye(2 * self.model.nv)]).T
        )

    def grows(self, step):
        """Whether noise of 1e-9 grows in 2500 steps."""
        self.model.opt.timestep = step
        noise = 1e-9 * np.random.default_rng(5).standard_normal(2 * self.model.nv)
        end = abs(self.run(noise, 2500)[: self.model.nv])
        return not end.max() < 1e-6


def simulated(chain, engine, step, **more):
    """The prediction from the engine's own masses, springs and dashpots."""
    model, data = engine.model, engine.data
    mass = np.zeros((model.nv, model.nv))
    mujoco.mj_resetData(model, data)
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, mass)
    stiffness = np.diag(np.reshape(model.jnt_stiffness, (model.nv, -1))[:, 0])
    return Simulated(
        mass, np.diag(np.reshape(model.dof_damping, (model.nv, -1))[:, 0]), stiffness, step, engine.scheme, **more
    )


@pytest.mark.parametrize("setting", SETTINGS)
def test_multipliers_with_unequal_dashpots(setting):
    step = 2e-5 if setting == "RK4" else 1e-4
    damping = 2e-5 * np.arange(1.0, 13.0) ** 1.5
    engine = Engine(strip(12), step, setting, damping)
    predicted = simulated(strip(12), engine, step)
    assert apart(engine.multipliers(), predicted.multipliers) < 1e-7
    for other in {scheme_of("mujoco", one) for one in SETTINGS} - {engine.scheme}:
        wrong = Simulated(predicted.mass, predicted.damping, predicted.stiffness, step, other)
        assert apart(engine.multipliers(), wrong.multipliers) > 1e-6
    limit = predicted.limit
    assert limit == np.inf or (engine.grows(1.01 * limit) and not engine.grows(0.99 * limit))


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("zeta", [0.0, 0.001, 0.01])
def test_limit_to_one_percent(setting, zeta):
    chain = SegmentModel(STRIP, 8).rigid_chain(damping=zeta)
    limit = chain.simulated(1e-3, "mujoco", setting).limit
    engine = Engine(chain, 1e-3, setting)
    if limit == np.inf:
        assert not any(engine.grows(step) for step in (1e-3, 0.05))
        return
    assert engine.grows(1.01 * limit)
    assert not engine.grows(0.99 * limit)


@pytest.mark.parametrize(("setting", "step"), [(one, 1e-4) for one in SETTINGS[:3]] + [
    ("Euler without eulerdamp", 2e-5), ("RK4", 3e-5), ("discrete", 1e-4), ("discrete", 1e-3)])  # fmt: skip
def test_records_of_free_vibration(setting, step):
    """Frequency and damping ratio by a recurrence of three samples, x = 0.2 to 0.3 apart."""
    chain = strip(12, 0.01)
    engine, run = Engine(chain, step, setting), chain.simulated(step, "mujoco", setting)
    for mode in range(3):
        shape, apart_by = run.modal[2][:, mode], max(1, round(0.25 / (run.modal[0][mode] * step)))
        state, record = np.append(1e-6 * shape / abs(shape).max(), np.zeros(12)), []
        for _ in range(60):
            record.append(run.mass @ shape @ state[:12])
            state = engine.run(state, apart_by)
        first, second = np.linalg.lstsq(np.stack([record[1:-1], record[:-2]], axis=1), record[2:], rcond=None)[0]
        s = np.log(np.roots([1.0, -first, -second])[0].astype(complex)) / (apart_by * step)
        assert abs(s.imag) / (2 * np.pi) == pytest.approx(run.modes.hz[mode], rel=1e-6)
        assert -s.real / abs(s) == pytest.approx(run.modes.zeta[mode], abs=1e-6)


def test_armature_makes_the_trapezoidal_rule():
    for step, zeta in ((1e-3, 0.005), (2e-3, 0.003)):
        chain = strip(12, zeta)
        engine = Engine(chain, step, "Euler", inertias=armature(chain.simulated(step, "mujoco")))
        assert apart(engine.multipliers(), chain.simulated(step, "exudyn", "TrapezoidalIndex2").multipliers) < 1e-8
        assert not engine.grows(step)
        assert Engine(strip(12, 0.0), step, "Euler").grows(step)
    chain = strip(8)
    step = 400.0 / chain.simulated(1e-3, "mujoco").omega_max
    for share, grows in ((0.45, True), (0.55, False)):
        stiffness = [joint.hinges[0].stiffness for joint in chain.joints[:-1]]
        assert Engine(chain, step, "Euler", share * step * np.array(stiffness)).grows(step) == grows


def test_supports_of_the_far_end_by_an_equality_are_approximate():
    """Frequencies of a pinned beam, undamped, in the file that `verify` writes."""
    chain = SegmentModel(replace(STRIP, supports=("pinned", "pinned")), 8)
    run = chain.rigid_chain().simulated(1e-3, "mujoco", "discrete")
    assert (run.modes.hz[[0, 2]], run.modes.zeta[[0, 2]]) == (
        pytest.approx([19.147, 131.56], rel=1e-4), pytest.approx([0.06019, 0.42628], abs=1e-4))  # fmt: skip
