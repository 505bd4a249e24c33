"""MuJoCo: a tree of hinges with the far end constrained by a fixed tendon, linear in the angles; MuJoCo's RK4.

Bending is in the x-z plane, about -y. The tendon is a soft equality, as stiff as the engine allows. Forces are applied
in the control callback, a Python function at every stage; a C function takes half the time at 49 links. Beyond its
stability limit the engine resets itself without an error; a run stops when its time decreases.
"""

from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.base import SAMPLES, Chain, Run
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

    def run(self, chain: Chain, steps: int, end: float) -> Run:
        """Motion by the engine's Runge-Kutta method."""
        import mujoco

        h = end / steps
        middle, at = chain.locate(0.5 * chain.rigid.beam.length)
        reach = np.append([link.length for link in chain.rigid.links[:middle]], at)
        samples: list[tuple[float, float]] = []

        def run_up_to(k: int, failure: str = "") -> Run:
            times, heights = np.array(samples).reshape(-1, 2).T
            return Run(times, heights, k, failure)

        model = mujoco.MjModel.from_xml_string(mjcf(chain.rigid, h))
        data = mujoco.MjData(model)
        before = mujoco.get_mju_user_warning()
        mujoco.set_mju_user_warning(lambda text: None)  # the default handler writes a file
        mujoco.set_mjcb_control(_loads(chain))
        try:
            for k in range(1, steps + 1):
                mujoco.mj_step(model, data)
                if data.time < (k - 0.5) * h:
                    return run_up_to(k - 1, f"at t = {k * h:.4g} s it reset itself to its start")
                if k % max(steps // SAMPLES, 1) == 0:
                    samples.append((k * h, float(np.sin(np.cumsum(data.qpos[: middle + 1])) @ reach)))
        finally:
            mujoco.set_mjcb_control(None)
            mujoco.set_mju_user_warning(before)
        return run_up_to(steps)


def _loads(chain: Chain) -> Any:
    """The control callback."""
    half, at = chain.rigid.links[0].centre, [chain.locate(force.position) for force in chain.forces]
    places = [(link + 1, x - half) for link, x in at]
    bodies = sorted({body for body, _ in places})

    def control(model: Any, data: Any) -> None:
        data.xfrc_applied[bodies] = 0.0
        for (body, lever), force in zip(places, chain.force_values(data.time), strict=True):
            data.xfrc_applied[body, 2] += force
            data.xfrc_applied[body, 4] -= lever * force

    return control
