"""Record of the case slider-on-wave in MuJoCo: a rigid foot on the crests of a travelling wave. CC0-1.0.

Each contact of the foot is a sphere above a heavy plate of its own, which has height and velocity of the surface at the
place of the sphere. The elastic layer is the compliance of the contacts.
"""

import argparse

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" cone="elliptic" impratio="{impratio}" gravity="0 0 -9.81"/>
  <worldbody>
    <body>
      <joint type="slide" axis="1 0 0"/>
      <joint type="slide" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="{mass}" diaginertia="1 1 1"/>
      {spheres}
    </body>
    {plates}
  </worldbody>
  <contact>{pairs}</contact>
</mujoco>"""
PLATE = """
    <body pos="0 {y} -0.05" gravcomp="1"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
      <geom name="plate{i}" type="box" size="2 0.01 0.05" mass="1e6" contype="0" conaffinity="0"/></body>"""
SPHERE = '<geom name="sphere{i}" type="sphere" size="0.005" pos="{x} {y} 0.005" mass="0" contype="0" conaffinity="0"/>'
PAIR = '<pair geom1="plate{i}" geom2="sphere{i}" condim="3" friction="{mu} {mu} 0 0 0" {soft}/>'
MASS, MU, LAYER, LEVER = 0.8, 0.05, 5.41e4, 0.02  # kg; -; N/m for each metre of foot; m
AMPLITUDE, LENGTH, HERTZ, END, RATE = 0.002, 0.37, 20.0, 2.0, 500.0
OMEGA, K = 2.0 * np.pi * HERTZ, 2.0 * np.pi / LENGTH
IMPEDANCE = 0.1  # low, so that the compliance of a contact has little inertia


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.0005, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--count", type=int, default=24, help="contacts of the foot")
    parser.add_argument("--impratio", type=float, default=100.0)
    parser.add_argument("--slip-damping", type=float, default=5.0, help="of friction below its limit, 1/s")
    given = parser.parse_args()
    numbers, step = range(given.count), given.step
    x = LENGTH * (np.arange(given.count) + 0.5) / given.count
    soft = f'solimp="{IMPEDANCE} {IMPEDANCE} 0.001 0.5 2" solref="-1 -1" solreffriction="-1e-9 -{given.slip_damping}"'
    model = mujoco.MjModel.from_xml_string(
        SCENE.format(
            step=step,
            impratio=given.impratio,
            mass=MASS,
            spheres="".join(SPHERE.format(i=i, x=x[i], y=0.03 * i) for i in numbers),
            plates="".join(PLATE.format(i=i, y=0.03 * i) for i in numbers),
            pairs="".join(PAIR.format(i=i, mu=MU, soft=soft) for i in numbers),
        )
    )
    # the force of a contact is solref[0] r/(d R), with R = (1 - d)/d times the inverse mass that MuJoCo gives the foot
    spring = LAYER * LENGTH / given.count * (1.0 - IMPEDANCE) * model.body_invweight0[1, 0]
    model.pair_solref[:, 0] = -spring
    model.pair_solref[:, 1] = -0.02 * spring / OMEGA
    data = mujoco.MjData(model)
    data.qpos[1] = AMPLITUDE * np.cos(1.3)
    every, rows = max(round(1.0 / (RATE * step)), 1), []
    while data.time < END - 0.5 * step:
        rows.append((data.time, data.qpos[0], data.qvel[0], data.qpos[1]))
        for _ in range(every):
            phase = OMEGA * data.time - K * (x + data.qpos[0])
            data.qpos[2::2], data.qpos[3::2] = 0.0, AMPLITUDE * np.cos(phase)
            data.qvel[2::2] = -LEVER * K * OMEGA * AMPLITUDE * np.cos(phase)
            data.qvel[3::2] = -AMPLITUDE * (OMEGA - K * data.qvel[0]) * np.sin(phase)
            mujoco.mj_step(model, data)
    np.savetxt(given.out, rows, delimiter=",", fmt="%.9g", header="time,position,speed,height", comments="")


if __name__ == "__main__":
    main()
