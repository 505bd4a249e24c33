"""Record the ring in MuJoCo: python mujoco_record.py, beside sheet.toml. CC0-1.0. Needs mujoco and numpy.

The chain is cut at joint N, whose spring is a tendon over all other joints; an equality, as stiff as the step allows,
closes it.
"""

import argparse
import tomllib
from math import cos, pi, sin

import mujoco
import numpy as np

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--count", type=int, default=40, help="links")
parser.add_argument("--step", type=float, default=1e-4, help="s")
parser.add_argument("--out", default="run.csv")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    given = tomllib.load(file)["parameters"]
n, step = options.count, options.step
turn, length = 2.0 * pi / n, 2.0 * pi * given["radius_m"] / n
area = given["width_m"] * given["thickness_m"]
stiffness = given["youngs_modulus_Pa"] * area * given["thickness_m"] ** 2 / 12.0 / length
mass = given["density_kg_per_m3"] * area * length
inertia = mass * length**2 / 12.0
half = 0.5 * turn
free = '<joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/><joint type="hinge" axis="0 -1 0"/>'
bodies = ""
for j in range(n):
    pose = f'pos="{length!r} 0 0" quat="{cos(half)!r} 0 {-sin(half)!r} 0"' if j else ""
    spring = f'<joint name="joint{j}" type="hinge" axis="0 -1 0" stiffness="{stiffness!r}"/>' if j else free
    bodies += f'<body name="link{j}" {pose}>{spring}<inertial pos="{0.5 * length!r} 0 0" mass="{mass!r}" '
    bodies += f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>\n'
cut = "".join(f'<joint joint="joint{j}" coef="1"/>' for j in range(1, n))
model = mujoco.MjModel.from_xml_string(
    '<mujoco><compiler angle="radian" boundmass="0" boundinertia="0"/><size memory="100M"/>'
    f'<option integrator="implicitfast" timestep="{step!r}" gravity="0 0 0" tolerance="1e-14" iterations="50"/>'
    f'<worldbody>{bodies}<site name="end" pos="{length!r} 0 0"/>{"</body>" * n}</worldbody>'
    f'<tendon><fixed stiffness="{stiffness!r}" springlength="0">{cut}</fixed></tendon>'
    f'<equality><connect body1="link{n - 1}" body2="link0" anchor="{length!r} 0 0" solref="{2.0 * step!r} 1" '
    'solimp="0.9999 0.9999 0.001 0.5 2"/></equality></mujoco>'
)
data = mujoco.MjData(model)
angles = [sum(cos(k * turn * j) for k in (2, 3, 4)) * given["start_angle_rad"] for j in range(n)]
data.qpos[3:] = angles[1:]
rows = []
for _ in range(2001):
    rows.append([data.time, -data.qpos[3:].sum()])  # the turns of all joints add up to that of the polygon
    for _ in range(round(0.001 / step)):
        mujoco.mj_step(model, data)
np.savetxt(options.out, rows, delimiter=",", header="time,bend", comments="", fmt="%.15g")
print(f"wrote {options.out}: {len(rows)} rows, step {step:.3g} s")
