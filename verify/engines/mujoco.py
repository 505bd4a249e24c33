"""MuJoCo: a tree of hinges with the far end constrained by a fixed tendon, linear in the angles; its RK4 or Euler.

Bending is in the x-z plane, about -y. The tendon is a soft equality, as stiff as the engine allows. Forces are torques
of actuators by tendons, linear in time within a step; all steps are one call of `mujoco.rollout`. Beyond its stability
limit the engine resets itself without an error, with which a run stops.
"""

from functools import lru_cache

import numpy as np

from verify.arrays import Array
from verify.engines.base import Chain, Run, centred
from verify.engines.description import small_motion_hz
from verify.engines.writers import mjcf


class Mujoco:
    """The adapter."""

    def frequencies(self, chain: Chain) -> Array:
        """Natural frequencies from the engine's mass matrix, closure and joint stiffnesses."""
        import mujoco

        model = mujoco.MjModel.from_xml_string(mjcf(chain.rigid, 1e-6))
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        mass = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, mass)
        stiffness = np.diag(np.reshape(model.jnt_stiffness, (model.nv, -1))[:, 0])
        return small_motion_hz(mass, stiffness, np.reshape(data.efc_J, (-1, model.nv)))

    def run(self, chain: Chain, steps: int, end: float, order: int = 4) -> Run:
        """Motion by the engine's Runge-Kutta method, or by its semi-implicit Euler steps."""
        import mujoco
        from mujoco.rollout import rollout

        h, n = end / steps, chain.rigid.count
        model = mujoco.MjModel.from_xml_string(driven(chain, h, order))
        data = mujoco.MjData(model)
        values = chain.force_values(h * np.arange(-1, steps + 2))
        # nodes of the best continuous piecewise linear force, whose error has no mean over neighbouring steps: order 4
        nodes = values[1:-1] - np.diff(values, 2, axis=0) / 12.0
        data.act[:] = nodes[0]
        whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
        start = np.zeros(mujoco.mj_stateSize(model, whole))
        mujoco.mj_getState(model, data, start, whole)
        before = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(lambda text: None)  # the default handler writes a file
        try:
            states, _ = rollout(model, data, start, np.diff(nodes, axis=0) / h)
        finally:
            mujoco.set_mju_user_warning(before)
        states = np.vstack([start, states[0]])
        late = states[1:, 0] < h * (np.arange(steps) + 0.5)
        done = int(late.argmax()) + 1 if late.any() else steps + 1
        failure = f"at t = {done * h:.4g} s it reset itself to its start" if late.any() else ""
        angles, rates = np.cumsum(states[:done, 1 : 1 + 2 * n].reshape(done, 2, n), axis=2).transpose(1, 0, 2)
        return Run(np.linspace(0.0, (done - 1) * h, done), angles, centred(rates) if order == 2 else rates, failure)


@lru_cache(maxsize=16)
def driven(chain: Chain, step: float, order: int) -> str:
    """The chain as MJCF with an actuator for every force, which integrates its control."""
    names, forces = [name for name, *_ in chain.rigid.unknowns("bending")], ""
    for i, row in enumerate(chain.torques.tolist()):
        each = zip(names, row, strict=True)
        coefs = "".join(f'<joint joint="{name}" coef="{coef!r}"/>' for name, coef in each if coef)
        forces += f'<tendon><fixed name="force{i}">{coefs}</fixed></tendon>\n'
        forces += f'<actuator><general tendon="force{i}" dyntype="integrator"/></actuator>\n'
    text = mjcf(chain.rigid, step).replace("</mujoco>", forces + "</mujoco>")
    return text if order == 4 else text.replace('integrator="RK4"', 'integrator="Euler"')
