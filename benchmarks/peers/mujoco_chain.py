"""MuJoCo: hinges in a tree; y_N = 0 as a fixed tendon (linear in the angles) held by a soft equality; its own RK4."""

import numpy as np

from benchmarks.peers.case import Array, Case, Run, count, every

SAMPLES = 200


def _model_text(case: Case, step: float) -> str:
    """The chain in MuJoCo's XML; bending happens in the x-z plane, about -y."""
    link, spin = case.link, case.inertia
    bodies = "".join(
        f'<body name="link{i}" pos="{0.0 if i == 0 else link!r} 0 0">'
        f'<joint name="hinge{i}" type="hinge" axis="0 -1 0" stiffness="{0.0 if i == 0 else case.spring!r}"/>'
        f'<inertial pos="{link / 2!r} 0 0" mass="{case.mass!r}" diaginertia="{spin / 50!r} {spin!r} {spin!r}"/>'
        for i in range(case.n)
    )
    levers = "".join(f'<joint joint="hinge{i}" coef="{link * (case.n - i)!r}"/>' for i in range(case.n))
    return (
        '<mujoco><compiler angle="radian" inertiafromgeom="false" boundmass="0" boundinertia="0"/>'
        f'<option timestep="{step!r}" integrator="RK4" gravity="0 0 0" iterations="20" tolerance="1e-14">'
        '<flag contact="disable"/></option>'
        f"<size memory='200M'/><worldbody>{bodies}{'</body>' * case.n}</worldbody>"
        f'<tendon><fixed name="closure">{levers}</fixed></tendon><equality><tendon tendon1="closure" '
        f'solref="{2 * step!r} 1" solimp="0.9999 0.9999 0.001 0.5 2"/></equality></mujoco>'
    )


def prepare(case: Case) -> Run:
    """A run of the chain; the model of each step is compiled once, outside what is timed."""
    import mujoco

    places = [case.place(x) for x, _, _ in case.forces]
    middle, at = case.place(case.length / 2)
    models: dict[float, tuple[object, object]] = {}

    def push(model: object, data: object) -> None:
        """The forces, also within a Runge-Kutta step."""
        for (i, where), force in zip(places, case.now(data.time), strict=True):  # type: ignore[attr-defined]
            data.xfrc_applied[i + 1, 2] = force  # type: ignore[attr-defined]
            data.xfrc_applied[i + 1, 4] = -(where - case.link / 2) * force  # type: ignore[attr-defined]

    def run(step: float, end: float) -> tuple[Array, Array]:
        steps, step = count(step, end)
        if step not in models:
            model = mujoco.MjModel.from_xml_string(_model_text(case, step))
            models[step] = model, mujoco.MjData(model)
        model, data = models[step]
        mujoco.mj_resetData(model, data)
        look, seen = every(steps, SAMPLES), []
        mujoco.set_mjcb_control(push)
        try:
            for k in range(1, steps + 1):
                mujoco.mj_step(model, data)
                if k % look == 0:
                    seen.append((k * step, np.cumsum(data.qpos[: middle + 1])))
        finally:
            mujoco.set_mjcb_control(None)
        if data.warning.number.any() if hasattr(data.warning, "number") else any(w.number for w in data.warning):
            return np.array([t for t, _ in seen]), np.full(len(seen), np.nan)  # it resets itself when it diverges
        return read(seen, case.link, at)

    return run


def read(seen: list[tuple[float, Array]], link: float, at: float) -> tuple[Array, Array]:
    """Times and deflections of the middle from the absolute angles of the links up to it."""
    angles = np.array([theta for _, theta in seen])
    reach = np.append(np.full(angles.shape[1] - 1, link), at)
    return np.array([t for t, _ in seen]), np.sin(angles) @ reach
