"""Record of the case decay in MuJoCo: a block on a spring and a plane with friction. CC0-1.0."""

import argparse

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}" impratio="{impratio}" noslip_iterations="{noslip}"
    gravity="0 0 -9.81"/>
  <worldbody>
    <geom type="plane" size="5 5 0.1" friction="{mu} 0 0" solref="{solref} 1"/>
    <body pos="0 0 0.02">
      <joint name="x" type="slide" axis="1 0 0" stiffness="{stiffness}"/>
      <joint name="y" type="slide" axis="0 1 0"/>
      <joint name="z" type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.02" mass="1.3" friction="{mu} 0 0" solref="{solref} 1"/>
    </body>
  </worldbody>
</mujoco>"""
MU, STIFFNESS, START, END, RATE = 0.067, 210.0, 0.0431, 2.5, 250.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.002, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--integrator", default="Euler")
    parser.add_argument("--cone", default="pyramidal", choices=["pyramidal", "elliptic"])
    parser.add_argument("--impratio", type=float, default=1.0)
    parser.add_argument("--noslip", type=int, default=0, help="iterations of the solver without slip")
    parser.add_argument("--solref", type=float, default=0.02, help="time constant of the contact, s")
    given = vars(parser.parse_args())
    out, step = given.pop("out"), given["step"]
    model = mujoco.MjModel.from_xml_string(SCENE.format(mu=MU, stiffness=STIFFNESS, **given))
    data = mujoco.MjData(model)
    for _ in range(round(0.5 / step)):  # the contact settles under the weight while the block is held
        data.qpos[0], data.qvel[0] = START, 0.0
        mujoco.mj_step(model, data)
    data.qpos[0], data.qvel[0], data.time = START, 0.0, 0.0
    every, rows = max(round(1.0 / (RATE * step)), 1), [(0.0, START)]
    while data.time < END - 0.5 * step:
        mujoco.mj_step(model, data, every)
        rows.append((data.time, data.qpos[0]))
    np.savetxt(out, rows, delimiter=",", fmt="%.9g", header="time,position", comments="")


if __name__ == "__main__":
    main()
