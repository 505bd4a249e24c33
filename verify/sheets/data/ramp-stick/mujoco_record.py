"""Record of the case ramp-stick in MuJoCo: a box on an incline below the friction angle. CC0-1.0."""

import argparse

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}" impratio="{impratio}" noslip_iterations="{noslip}"
    gravity="{gravity_x} 0 {gravity_z}"/>
  <worldbody>
    <geom type="plane" size="5 5 0.1" friction="{mu} 0 0"/>
    <body pos="0 0 0.02">
      <freejoint/>
      <geom type="box" size="0.05 0.04 0.02" mass="1.3" friction="{mu} 0 0"/>
    </body>
  </worldbody>
</mujoco>"""
MU, ANGLE, GRAVITY, END, RATE = 0.45, np.radians(17.0), 9.81, 2.0, 100.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.002, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--integrator", default="Euler")
    parser.add_argument("--cone", default="pyramidal", choices=["pyramidal", "elliptic"])
    parser.add_argument("--impratio", type=float, default=1.0)
    parser.add_argument("--noslip", type=int, default=0, help="iterations of the solver without slip")
    given = vars(parser.parse_args())
    out, step = given.pop("out"), given["step"]
    # the incline is level and gravity is inclined: the same problem, with x down the slope
    slope = {"gravity_x": GRAVITY * np.sin(ANGLE), "gravity_z": -GRAVITY * np.cos(ANGLE), "mu": MU}
    model = mujoco.MjModel.from_xml_string(SCENE.format(**slope, **given))
    data = mujoco.MjData(model)
    every, rows = max(round(1.0 / (RATE * step)), 1), [(0.0, 0.0)]
    while data.time < END - 0.5 * step:
        mujoco.mj_step(model, data, every)
        rows.append((data.time, data.qpos[0]))
    np.savetxt(out, rows, delimiter=",", fmt="%.9g", header="time,position", comments="")


if __name__ == "__main__":
    main()
