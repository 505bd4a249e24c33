"""Record the spin-up in MuJoCo: python mujoco_record.py, beside sheet.toml and model.xml. CC0-1.0.

Needs mujoco and numpy. The hub is a hinge of an inertia beside which that of the beam is nothing, and the torque is
that of its acceleration.
"""

import argparse
import tomllib
from math import cos, pi, sin

import mujoco
import numpy as np

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--model", default="model.xml")
parser.add_argument("--step", type=float, help="s; default: that of the sheet")
parser.add_argument("--out", default="run.csv")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    sheet = tomllib.load(file)
case, given = sheet["chain"], sheet["parameters"]
INERTIA = 1e9  # kg m^2, of the hub: the beam's is 400
WALL = '<joint name="joint0_bending"'
with open(options.model) as file:
    hub = f'<joint name="hub" type="hinge" axis="0 -1 0" armature="{INERTIA!r}"/>'
    model = mujoco.MjModel.from_xml_string(file.read().replace(WALL, hub + WALL, 1))
data = mujoco.MjData(model)
every = case["every_s"]
per_sample = max(round(every / (options.step or case["step_s"])), 1)
step = model.opt.timestep = every / per_sample
end, rate = given["spin_up_s"], given["final_rate_rad_per_s"]
tip, rows = model.site("tip").id, []
for _ in range(round(case["duration_s"] / every) + 1):
    mujoco.mj_forward(model, data)
    x, _, z = data.site_xpos[tip]
    angle = data.qpos[0]
    rows.append([data.time, z * cos(angle) - x * sin(angle)])
    for _ in range(per_sample):
        middle = data.time + 0.5 * step
        acceleration = rate / end * (1.0 - cos(2.0 * pi * middle / end)) if middle < end else 0.0
        data.qfrc_applied[0] = INERTIA * acceleration
        mujoco.mj_step(model, data)
np.savetxt(options.out, rows, delimiter=",", header="time,across", comments="", fmt="%.15g")
print(f"wrote {options.out}: {len(rows)} rows, step {step:.3g} s")
