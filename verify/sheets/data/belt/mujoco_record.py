"""Record of the case belt in MuJoCo: a block on a spring on a moving belt. CC0-1.0."""

import argparse

import mujoco
import numpy as np

# the belt is a slab so heavy that friction does not slow it
SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}" impratio="{impratio}" noslip_iterations="{noslip}"
    gravity="0 0 -9.81"/>
  <default><geom friction="{mu} 0 0" solref="{solref} 1"/></default>
  <worldbody>
    <body pos="0 0 -0.05">
      <joint type="slide" axis="1 0 0"/>
      <geom type="box" size="3 0.2 0.05" mass="1e6"/>
    </body>
    <body pos="0 0 0.02">
      <joint type="slide" axis="1 0 0" stiffness="{stiffness}"/>
      <joint type="slide" axis="0 1 0"/>
      <joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.02" mass="1.3"/>
    </body>
  </worldbody>
</mujoco>"""
MU, STIFFNESS, SPEED, END, RATE = 0.31, 210.0, 0.11, 3.0, 250.0


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
    mujoco.mj_step(model, data, round(0.5 / step))  # the contact settles under the weight on a belt at rest
    data.qpos[:2], data.qvel[:2], data.time = 0.0, SPEED, 0.0
    every, rows = max(round(1.0 / (RATE * step)), 1), [(0.0, 0.0)]
    while data.time < END - 0.5 * step:
        mujoco.mj_step(model, data, every)
        rows.append((data.time, data.qpos[1]))
    np.savetxt(out, rows, delimiter=",", fmt="%.9g", header="time,position", comments="")


if __name__ == "__main__":
    main()
