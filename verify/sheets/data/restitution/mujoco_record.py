"""Record of the case restitution in MuJoCo: three balls meet a wall of spring and dashpot. CC0-1.0.

A contact of MuJoCo with solref = (-k, -c) and a constant solimp d, that of a body of one contact against the world, is
exactly the spring k and dashpot c per unit of mass without tension: the force is d m (-c v/d - k d r/d^2).
"""

import argparse

import mujoco
import numpy as np

BALL = """
    <body pos="{x} 0 0.031">
      <joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.03" mass="{mass}" solref="{solref}" solimp="0.9 0.9 0.001 0.5 2" priority="1"/>
    </body>"""
SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 0"/>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>{balls}
  </worldbody>
</mujoco>"""
MASS, STIFFNESS, RATIOS, SPEED, END, RATE = 0.7, 3500.0, (0.05, 0.2, 0.5), 1.3, 0.1, 2000.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.0001, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--integrator", default="Euler")
    parser.add_argument("--default-contact", action="store_true", help="solref = 0.02 1 instead of spring and dashpot")
    given = parser.parse_args()
    rate, balls = np.sqrt(STIFFNESS / MASS), ""
    for i, ratio in enumerate(RATIOS):
        solref = "0.02 1" if given.default_contact else f"{-(rate**2)} {-2.0 * ratio * rate}"
        balls += BALL.format(x=0.2 * i, mass=MASS, solref=solref)
    model = mujoco.MjModel.from_xml_string(SCENE.format(step=given.step, integrator=given.integrator, balls=balls))
    data = mujoco.MjData(model)
    data.qvel[:] = -SPEED
    every, rows = max(round(1.0 / (RATE * given.step)), 1), [(0.0, *data.qvel)]
    while data.time < END - 0.5 * given.step:
        mujoco.mj_step(model, data, every)
        rows.append((data.time, *data.qvel))
    header = "time,speed_a,speed_b,speed_c"
    np.savetxt(given.out, rows, delimiter=",", fmt="%.9g", header=header, comments="")


if __name__ == "__main__":
    main()
