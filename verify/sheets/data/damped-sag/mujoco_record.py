"""Record of the case damped-sag in MuJoCo: a strip of rigid links sags under its weight, damped twice. CC0-1.0."""

import argparse

import mujoco
import numpy as np

LENGTH, WIDTH, THICKNESS, YOUNG, DENSITY, GRAVITY = 0.3, 0.025, 0.003, 206e9, 7850.0, 9.81
STIFFNESS, LINE = YOUNG * WIDTH * THICKNESS**3 / 12.0, DENSITY * WIDTH * THICKNESS  # N m^2, kg/m
DAMPING = {"sag_light": 0.0005, "sag_heavy": 0.002}  # dashpot over spring, s
END, RATE = 2.0, 200.0


def strip(count: int, damping: float, ratio: float = 0.0, inertias: np.ndarray | None = None) -> str:
    """MJCF: joints EI/l, 2EI/l at the wall; with `inertias` spring and dashpot are those of `springdamper`."""
    link, bodies = LENGTH / count, ""
    mass = LINE * link
    inertia = mass * link**2 / 12.0
    for i in range(count):
        spring = STIFFNESS / link * (2.0 if i == 0 else 1.0)
        text = f'stiffness="{spring}" damping="{damping * spring}"'
        if inertias is not None:  # a time constant that gives the right spring at a ratio of 0.5
            text = f'springdamper="{2.0 * np.sqrt(inertias[i] / spring)} {ratio}"'
        bodies += f'<body pos="{link * (i > 0)} 0 0"><joint type="hinge" axis="0 -1 0" {text}/>'
        bodies += f'<inertial pos="{0.5 * link} 0 0" mass="{mass}" diaginertia="{inertia} {inertia} {inertia}"/>'
    option = f'<option gravity="0 0 {-GRAVITY}"/>'
    bodies += f'<site name="tip" pos="{link} 0 0"/>' + "</body>" * count
    return f"<mujoco>{option}<worldbody>{bodies}</worldbody></mujoco>"


def main() -> None:
    """Simulate both and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=2.5e-5, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--count", type=int, default=12, help="links")
    parser.add_argument(
        "--springdamper", action="store_true", help="damping ratios 0.5 and 0.6, which change the spring"
    )
    given = parser.parse_args()
    every, columns = max(round(1.0 / (RATE * given.step)), 1), []
    for damping, ratio in zip(DAMPING.values(), (0.5, 0.6), strict=True):
        model = mujoco.MjModel.from_xml_string(strip(given.count, damping))
        if given.springdamper:
            inertias = 1.0 / model.dof_invweight0
            model = mujoco.MjModel.from_xml_string(strip(given.count, damping, ratio, inertias))
        model.opt.timestep = given.step
        data, rows = mujoco.MjData(model), []
        while data.time < END + 0.5 * given.step:
            mujoco.mj_forward(model, data)
            rows.append((data.time, -data.site("tip").xpos[2]))
            mujoco.mj_step(model, data, every)
        columns.append(np.array(rows))
    table = np.column_stack([columns[0], columns[1][:, 1]])
    np.savetxt(given.out, table, delimiter=",", fmt="%.9g", header=",".join(["time", *DAMPING]), comments="")


if __name__ == "__main__":
    main()
