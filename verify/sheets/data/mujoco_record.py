"""Record the run of a case in MuJoCo: python mujoco_record.py, beside sheet.toml and model.xml. CC0-1.0.

Needs mujoco and numpy. Loads, start, step and columns are those of the sheet; --step and --model try others.
"""

import argparse
import tomllib

import mujoco
import numpy as np

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--model", default="model.xml")
parser.add_argument("--step", type=float, help="s; default: that of the sheet, or of the model if less")
parser.add_argument("--out", default="run.csv")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    sheet = tomllib.load(file)
case = sheet["chain"]
model = mujoco.MjModel.from_xml_path(options.model)
data = mujoco.MjData(model)
every = case["every_s"]
per_sample = max(round(every / (options.step or min(case["step_s"], model.opt.timestep)) - 1e-9), 1)
model.opt.timestep = every / per_sample
model.opt.gravity[:] = case.get("gravity", (0, 0, 0))
model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY

mujoco.mj_forward(model, data)
tip = model.site("tip").id
body = model.site_bodyid[tip]
names = [model.joint(j).name for j in range(model.njnt)]
bending = [j for j, name in enumerate(names) if name.endswith("bending")]
torsion = [j for j, name in enumerate(names) if name.endswith("torsion")]
ground = sum(data.energy)
for joints, moments in (  # static angles of small motion: moment over stiffness
    (bending, case.get("start_force", 0.0) * (data.site_xpos[tip, 0] - data.xanchor[bending, 0])),
    (torsion, np.full(len(torsion), case.get("start_moment", 0.0))),
):
    if moments.any():
        data.qpos[model.jnt_qposadr[joints]] = moments / model.jnt_stiffness[joints]
data.qpos[model.jnt_qposadr[bending[0]]] += case.get("start_angle", 0.0)
mujoco.mj_forward(model, data)

COLUMNS = {
    "time": lambda: data.time,
    "deflection": lambda: data.site_xpos[tip, 2],
    "tip_x": lambda: data.site_xpos[tip, 0],
    "tip_y": lambda: data.site_xpos[tip, 1],
    "tip_z": lambda: data.site_xpos[tip, 2],
    "angle": lambda: sum(data.qpos[model.jnt_qposadr[bending]]),
    "twist": lambda: sum(data.qpos[model.jnt_qposadr[torsion]]),
    "energy": lambda: sum(data.energy) - ground,
}
force, moment = (np.array(case.get(name, (0, 0, 0)), float) for name in ("tip_force", "tip_moment"))
ramp = case.get("ramp_s", 0.0)
rows = []
for _ in range(round(case["duration_s"] / every) + 1):
    rows.append([COLUMNS[name]() for name in sheet["columns"]])
    for _ in range(per_sample):
        if force.any() or moment.any():
            share = min(data.time / ramp, 1.0) if ramp else 1.0
            data.qfrc_applied[:] = 0.0
            mujoco.mj_applyFT(model, data, share * force, share * moment, data.site_xpos[tip], body, data.qfrc_applied)
        mujoco.mj_step(model, data)
    if data.warning[mujoco.mjtWarning.mjWARN_BADQACC].number:
        raise SystemExit(f"diverges at {model.opt.timestep:.3g} s: give a smaller --step")
    mujoco.mj_forward(model, data)  # places and energies of this instant
np.savetxt(options.out, rows, delimiter=",", header=",".join(sheet["columns"]), comments="", fmt="%.15g")
print(f"wrote {options.out}: {len(rows)} rows, step {model.opt.timestep:.3g} s")
