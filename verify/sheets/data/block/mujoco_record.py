"""Record a block with friction in MuJoCo: python mujoco_record.py, beside sheet.toml. CC0-1.0. Needs mujoco and numpy.

A ball without rotation on a spring and a belt, or a box on a level plane under inclined gravity, which is a ramp. A
contact of MuJoCo has one coefficient of friction: where the sheet has two, it is the static one until the block slips
faster than --slip, the kinetic one until the slip has almost ended. Most cases fail with MuJoCo's defaults and pass
with --cone elliptic --noslip 20 --solref 0.004, belt-stick-slip with --step 0.0005 too.
"""

import argparse
import tomllib

import mujoco
import numpy as np

SCENE = """<mujoco>
  <option timestep="{step}" integrator="{integrator}" cone="{cone}" impratio="{impratio}" noslip_iterations="{noslip}"/>
  <default><geom friction="{mu} 0 0" solref="{solref} 1"/></default>
  <worldbody>
    {floor}
    <body pos="0 0 0.02" euler="0 0 {heading}">{block}</body>
  </worldbody>
</mujoco>"""
PLANE = '<geom type="plane" size="5 5 0.1"/>'
# so heavy that friction does not slow it
BELT = '<body pos="0 0 -0.05"><joint type="slide" axis="1 0 0"/><geom type="box" size="3 0.2 0.05" mass="1e6"/></body>'
BALL = """
      <joint type="slide" axis="1 0 0" stiffness="{stiffness_n_per_m}"/>
      <joint type="slide" axis="0 1 0"/>
      <joint type="slide" axis="0 0 1"/>
      <geom type="sphere" size="0.02" mass="{mass_kg}"/>"""
BOX = '<freejoint/><geom type="box" size="0.05 0.04 0.02" mass="{mass_kg}"/>'

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--step", type=float, default=0.002, help="time step, s")
parser.add_argument("--out", default="run.csv")
parser.add_argument("--integrator", default="Euler")
parser.add_argument("--cone", default="pyramidal", choices=["pyramidal", "elliptic"])
parser.add_argument("--impratio", type=float, default=1.0)
parser.add_argument("--noslip", type=int, default=0, help="iterations of the solver without slip")
parser.add_argument("--solref", type=float, default=0.02, help="time constant of the contact, s")
parser.add_argument("--slip", type=float, default=1e-5, help="slip at which static friction ends, m/s")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    sheet = tomllib.load(file)
given, step = sheet["parameters"], options.step
static = given.get("static_friction_coefficient") or given["friction_coefficient"]
kinetic = given.get("kinetic_friction_coefficient", static)
heading, angle = (np.radians(given.get(name, 0.0)) for name in ("heading_deg", "angle_deg"))
up, side = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
launched, sprung = given.get("speed_m_per_s", 0.0), "stiffness_n_per_m" in given
start, belt = given.get("start_m", 0.0), given.get("belt_speed_m_per_s", 0.0)
parts = {"floor": BELT if belt else PLANE, "block": (BALL if sprung else BOX).format(**given)}
scene = SCENE.format(mu=static, heading=np.degrees(heading), **parts, **vars(options))
model = mujoco.MjModel.from_xml_string(scene)
model.opt.gravity[:] = given["gravity_m_per_s2"] * np.array([*(-np.sin(angle) * up), -np.cos(angle)])
data = mujoco.MjData(model)
first = 1 if belt else 0  # coordinate of the block, after that of the belt
place, speed = data.qpos[first : first + 2], data.qvel[first : first + 2]
for _ in range(round(0.5 / step) if sprung else 0):  # the contact settles under the weight while the block is held
    data.qpos[0], place[0], data.qvel[:] = 0.0, start, 0.0
    mujoco.mj_step(model, data)
data.qpos[0], place[0], data.time = 0.0, start, 0.0
speed[:] = launched * up
data.qvel[: first + 1] += belt
sign = 1.0 if sprung or launched else -1.0  # down the slope where the box starts at rest

COLUMNS = {
    "time": lambda: data.time,
    "position": lambda: sign * (place @ up),
    "speed": lambda: sign * (speed @ up),
    "sideways": lambda: place @ side,
}
every, sticks, rows = max(round(1.0 / (given["rate_hz"] * step)), 1), True, []
for _ in range(round(given["duration_s"] * given["rate_hz"]) + 1):
    rows.append([COLUMNS[name]() for name in sheet["columns"]])
    for _ in range(every):
        mujoco.mj_step(model, data)
        sticks = data.qvel[0] - speed[0] < options.slip * (1.0 if sticks else 0.1)
        model.geom_friction[:, 0] = static if sticks else kinetic
np.savetxt(options.out, rows, delimiter=",", fmt="%.9g", header=",".join(sheet["columns"]), comments="")
