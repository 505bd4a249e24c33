"""Record of the case swinging-chain in MuJoCo: hinged rods fall from level. CC0-1.0."""

import argparse

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" gravity="0 0 -9.81">
    <flag energy="enable" contact="disable"/>
  </option>
  <worldbody>{rods}</worldbody>
</mujoco>"""
ROD = """<body pos="{x} 0 0"><joint type="hinge" axis="0 -1 0"/>
  <inertial pos="0.06 0 0" mass="0.05" diaginertia="1e-9 6e-5 6e-5"/>"""
COUNT, LENGTH, MASS, GRAVITY, END, RATE = 5, 0.12, 0.05, 9.81, 2.0, 250.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.002, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--integrator", default="Euler")
    given = parser.parse_args()
    rods = "".join(ROD.format(x=LENGTH * (i > 0)) for i in range(COUNT)) + "</body>" * COUNT
    scene = SCENE.format(step=given.step, integrator=given.integrator, rods=rods)
    model = mujoco.MjModel.from_xml_string(scene)
    data = mujoco.MjData(model)
    hanging = -MASS * GRAVITY * LENGTH * 0.5 * COUNT**2
    every, rows = max(round(1.0 / (RATE * given.step)), 1), []
    while data.time < END + 0.5 * given.step:
        mujoco.mj_forward(model, data)  # energies of this instant
        rows.append((data.time, sum(data.energy) - hanging))
        mujoco.mj_step(model, data, every)
    np.savetxt(given.out, rows, delimiter=",", fmt="%.9g", header="time,energy", comments="")


if __name__ == "__main__":
    main()
