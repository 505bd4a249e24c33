"""MuJoCo with the slider as a body on a slide joint; friction as an applied force in the control callback."""

from time import perf_counter

import numpy as np

from benchmarks.peers.case import Case, count
from benchmarks.peers.mujoco_chain import _model_text
from benchmarks.peers.slider import Run, Sled, surface_speed


def _with_slider(case: Case, sled: Sled, step: float) -> str:
    """The chain's XML and one more body."""
    body = (
        f'<body name="sled" pos="{sled.start!r} 0 0.01"><joint name="slide" type="slide" axis="1 0 0"/>'
        f'<inertial pos="0 0 0" mass="{sled.mass!r}" diaginertia="1e-9 1e-9 1e-9"/></body>'
    )
    return _model_text(case, step).replace("</worldbody>", body + "</worldbody>")


def prepare(case: Case, sled: Sled) -> Run:
    """A run with forces and friction; models are compiled once for each step, outside what is timed."""
    return _prepared(case, sled, pushed=True)


def prepare_bare(case: Case, sled: Sled) -> Run:
    """The same steps with nothing called back: what the engine alone costs."""
    return _prepared(case, sled, pushed=False)


def _prepared(case: Case, sled: Sled, *, pushed: bool) -> Run:
    import mujoco

    models: dict[float, tuple[object, object]] = {}
    places = [case.place(x) for x, _, _ in case.forces]
    n = case.n

    def push(model: object, data: object) -> None:
        for (i, where), force in zip(places, case.now(data.time), strict=True):  # type: ignore[attr-defined]
            data.xfrc_applied[i + 1, 2] = force  # type: ignore[attr-defined]
            data.xfrc_applied[i + 1, 4] = -(where - case.link / 2) * force  # type: ignore[attr-defined]
        spins = np.cumsum(data.qvel[:n])  # type: ignore[attr-defined]
        surface = surface_speed(case, sled, spins, sled.start + data.qpos[n])  # type: ignore[attr-defined]
        data.qfrc_applied[n] = sled.force(data.qvel[n] - surface)  # type: ignore[attr-defined]

    def run(step: float, end: float) -> tuple[float, float, float]:
        steps, step = count(step, end)
        if step not in models:
            model = mujoco.MjModel.from_xml_string(_with_slider(case, sled, step))
            models[step] = model, mujoco.MjData(model)
        model, data = models[step]
        mujoco.mj_resetData(model, data)
        mujoco.set_mjcb_control(push if pushed else None)
        begun = perf_counter()
        try:
            for _ in range(steps if pushed else 1):
                mujoco.mj_step(model, data, nstep=1 if pushed else steps)
        finally:
            mujoco.set_mjcb_control(None)
        return float(data.qpos[n]), float(data.qvel[n]), perf_counter() - begun

    return run
