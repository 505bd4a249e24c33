"""Record the cables in MuJoCo: python mujoco_record.py, beside sheet.toml. CC0-1.0. Needs mujoco and numpy."""

import argparse
import tomllib

import mujoco
import numpy as np

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--count", type=int, default=16, help="parts of equal span, an even number")
parser.add_argument("--step", type=float, default=2e-4, help="s")
parser.add_argument("--out", default="run.csv")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    sheet = tomllib.load(file)
given, n = sheet["parameters"], options.count
span, tension = given["span_m"], given["horizontal_tension_N"]
load = given["mass_per_length_kg_per_m"] * given["gravity_m_per_s2"]
x = [span * i / n for i in range(n + 1)]
z = [-0.5 * load / tension * one * (span - one) for one in x]
lengths = [float(np.hypot(x[i + 1] - x[i], z[i + 1] - z[i])) for i in range(n)]
forces = [tension * length * n / span for length in lengths]
bodies, sites, tendons = "", "", ""
cables = [name.removeprefix("z_") for name in sheet["columns"][1:]]
for row, cable in enumerate(cables):
    axial = given[f"axial_stiffness_{cable}_N"]
    for i in range(n + 1):
        site = f'<site name="{cable}_{i}" pos="0 0 0"/>'
        if 0 < i < n:
            mass = given["mass_per_length_kg_per_m"] * span / n
            bodies += f'<body name="{cable}_{i}" pos="{x[i]!r} {row} {z[i]!r}"><joint type="slide" axis="1 0 0"/>'
            bodies += f'<joint name="{cable}_{i}" type="slide" axis="0 0 1"/>'
            bodies += f'<inertial pos="0 0 0" mass="{mass!r}" diaginertia="1 1 1"/>{site}</body>\n'
        else:
            sites += site.replace('"0 0 0"', f'"{x[i]!r} {row} {z[i]!r}"')
    for i in range(n):
        natural = lengths[i] / (1.0 + forces[i] / axial)  # unstretched
        tendons += f'<spatial stiffness="{axial / natural!r}" springlength="{natural!r}">'
        tendons += f'<site site="{cable}_{i}"/><site site="{cable}_{i + 1}"/></spatial>\n'
model = mujoco.MjModel.from_xml_string(
    f'<mujoco><option integrator="RK4" timestep="{options.step!r}" gravity="0 0 {-given["gravity_m_per_s2"]!r}"/>'
    f"<worldbody>{bodies}{sites}</worldbody><tendon>{tendons}</tendon></mujoco>"
)
data = mujoco.MjData(model)
for cable in cables:
    for i in range(1, n):
        data.qvel[model.jnt_dofadr[model.joint(f"{cable}_{i}").id]] = 0.001 * np.sin(np.pi * x[i] / span)
middles, rows = [model.body(f"{cable}_{n // 2}").id for cable in cables], []
for _ in range(801):
    mujoco.mj_forward(model, data)
    rows.append([data.time, *data.xpos[middles, 2]])
    for _ in range(round(0.01 / options.step)):
        mujoco.mj_step(model, data)
np.savetxt(options.out, rows, delimiter=",", header=",".join(sheet["columns"]), comments="", fmt="%.15g")
print(f"wrote {options.out}: {len(rows)} rows, step {options.step:.3g} s")
