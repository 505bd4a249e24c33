"""Record of the case capstan in MuJoCo: a chain of links on a turning drum, held at its ends. CC0-1.0.

A tree of links hinged at the contacts: the first link goes from the held end to the first contact, and a constant force
pulls the last contact along the tangent. The drum is so heavy that friction does not slow it. A contact is a small
sphere whose lowest point is the hinge, so that friction has no lever.
"""

import argparse

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}" impratio="{impratio}" gravity="0 0 0"/>
  <default>
    <joint type="hinge" axis="0 -1 0"/>
    <geom friction="{mu} 0 0" solref="{solref} 1" solimp="0.95 0.95 0.001 0.5 2"/>
  </default>
  <worldbody>
    <body>
      <joint/>
      <geom type="cylinder" size="{radius} 0.05" euler="90 0 0" mass="1e6" contype="1" conaffinity="0"/>
    </body>{links}
  </worldbody>
  <sensor><force site="held"/></sensor>
</mujoco>"""
LINK = """
    <body pos="{x} 0 {z}">
      <joint damping="{damping}"/>{held}
      <inertial pos="{mid_x} 0 {mid_z}" mass="0.1" diaginertia="1e-5 1e-5 1e-5"/>
      <geom type="sphere" size="0.002" pos="{tip_x} 0 {tip_z}" contype="0" conaffinity="1"/>"""
MU, WRAP, RADIUS, HOLD, FREE, END, RATE = 0.23, 3.5, 0.1, 27.0, 0.2, 3.0, 100.0


def at(angle: float) -> np.ndarray:
    """Direction from the axis of the drum."""
    return np.array([np.cos(angle), np.sin(angle)])


def chain(count: int, damping: float) -> str:
    """Nested bodies: from the held end to the first contact, and from each contact to the next."""
    angles = WRAP * (np.arange(count) + 0.5) / count
    nodes = [RADIUS * at(angles[0]) - [0.0, FREE], *(RADIUS * at(angle) for angle in angles)]
    text, before = "", np.zeros(2)
    for i, angle in enumerate(angles):
        link, held = nodes[i + 1] - nodes[i], '<site name="held"/>' if i == 0 else ""
        tip, start = link + 0.002 * at(angle), nodes[i] - before
        points = dict(zip(("x", "z", "mid_x", "mid_z", "tip_x", "tip_z"), (*start, *(0.5 * link), *tip), strict=True))
        text, before = text + LINK.format(damping=damping, held=held, **points), nodes[i]
    return text + "</body>" * count


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.0005, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--count", type=int, default=8, help="contacts")
    parser.add_argument("--integrator", default="Euler")
    parser.add_argument("--cone", default="elliptic", choices=["pyramidal", "elliptic"])
    parser.add_argument("--impratio", type=float, default=1.0)
    parser.add_argument("--solref", type=float, default=0.005, help="time constant of the contacts, s")
    parser.add_argument("--damping", type=float, default=0.2, help="of the hinges, N m s/rad")
    given = vars(parser.parse_args())
    out, step, count = given.pop("out"), given["step"], given.pop("count")
    links = chain(count, given.pop("damping"))
    model = mujoco.MjModel.from_xml_string(SCENE.format(mu=MU, radius=RADIUS, links=links, **given))
    data = mujoco.MjData(model)
    last = RADIUS * at(WRAP * (1.0 - 0.5 / count))
    force, end = HOLD * np.array([-np.sin(WRAP), 0.0, np.cos(WRAP)]), np.array([last[0], 0.0, last[1]])
    data.qvel[0] = 0.08 / count / RADIUS  # faster, the slip lifts light contacts; slower, it is creep
    mujoco.mj_forward(model, data)
    data.xfrc_applied[-1] = *force, *np.cross(end - data.xipos[-1], force)  # a force sensor misses qfrc_applied
    every, rows = max(round(1.0 / (RATE * step)), 1), []
    while data.time < END - 0.5 * step:
        mujoco.mj_step(model, data, every)
        rows.append((data.time, HOLD, np.linalg.norm(data.sensordata)))
    np.savetxt(out, rows, delimiter=",", fmt="%.9g", header="time,hold,pull", comments="")


if __name__ == "__main__":
    main()
