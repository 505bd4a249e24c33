"""Record of the case ramp-slip in MuJoCo: a box launched up an incline, stops and slides back. CC0-1.0."""

import argparse

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}" impratio="{impratio}" gravity="{gravity}"/>
  <worldbody>
    <geom type="plane" size="5 5 0.1" friction="{mu} 0 0"/>
    <body pos="0 0 0.02" euler="0 0 {heading}">
      <freejoint/>
      <geom type="box" size="0.05 0.04 0.02" mass="1.3" friction="{mu} 0 0"/>
    </body>
  </worldbody>
</mujoco>"""
MU, ANGLE, HEADING, SPEED, GRAVITY, END, RATE = 0.3, np.radians(25.0), 30.0, 1.1, 9.81, 1.0, 250.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.002, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--integrator", default="Euler")
    parser.add_argument("--cone", default="pyramidal", choices=["pyramidal", "elliptic"])
    parser.add_argument("--impratio", type=float, default=1.0)
    parser.add_argument("--heading", type=float, default=HEADING, help="of the slope from the x axis, degrees")
    given = vars(parser.parse_args())
    out, step, heading = given.pop("out"), given["step"], np.radians(given["heading"])
    up, side = (np.array([np.cos(angle), np.sin(angle)]) for angle in (heading, heading + 0.5 * np.pi))
    # the incline is level and gravity is inclined: the same problem
    gravity = (*(-GRAVITY * np.sin(ANGLE) * up), -GRAVITY * np.cos(ANGLE))
    model = mujoco.MjModel.from_xml_string(SCENE.format(mu=MU, gravity="{} {} {}".format(*gravity), **given))
    data = mujoco.MjData(model)
    data.qvel[:2] = SPEED * up
    every, rows = max(round(1.0 / (RATE * step)), 1), [(0.0, 0.0, SPEED, 0.0)]
    while data.time < END - 0.5 * step:
        mujoco.mj_step(model, data, every)
        rows.append((data.time, data.qpos[:2] @ up, data.qvel[:2] @ up, data.qpos[:2] @ side))
    np.savetxt(out, rows, delimiter=",", fmt="%.9g", header="time,position,speed,sideways", comments="")


if __name__ == "__main__":
    main()
