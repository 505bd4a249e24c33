"""Record the run of a case in Exudyn: python exudyn_record.py, beside sheet.toml and model_exudyn.py. CC0-1.0.

Needs exudyn, numpy and scipy. Loads, start, step and columns are those of the sheet; the integrator is the trapezoidal
rule, which damps nothing, or with --radius generalised alpha.
"""

import argparse
import tomllib

import exudyn as exu
import model_exudyn as chain
import numpy as np
from exudyn import utilities as items

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--step", type=float, help="s; default: that of the sheet")
parser.add_argument("--radius", type=float, default=1.0, help="spectral radius of generalised alpha")
parser.add_argument("--out", default="run.csv")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    sheet = tomllib.load(file)
case = sheet["chain"]
system, tree, last = chain.build(), 0, len(chain.TREE) - 1
names, _, offsets, springs = (list(one) for one in list(zip(*chain.TREE, strict=True))[:4])
bending = -1.0 * np.array([name.endswith("bending") for name in names])  # upwards is negative about y
torsion = np.array([name.endswith("torsion") for name in names])
length = chain.TIP[2]
places = np.cumsum(offsets)
start = bending * case.get("start_force", 0.0) * (length - places) + torsion * case.get("start_moment", 0.0)
if start.any():
    start = start / np.array(springs)
start[np.flatnonzero(bending)[0]] -= case.get("start_angle", 0.0)
system.SetNodeParameter(0, "initialCoordinates", start.tolist())
system.SetObjectParameter(tree, "gravity", list(case.get("gravity", (0, 0, 0))))
at = {"objectNumber": tree, "linkNumber": last, "localPosition": [chain.TIP[1], 0.0, 0.0]}
marker = system.AddMarker(items.MarkerKinematicTreeRigid(**at))
ramp = case.get("ramp_s", 0.0)


def grown(mbs, t, load):
    """The load at a time."""
    return np.array(load) * (min(t / ramp, 1.0) if ramp else 1.0)


for key, kind, function in (
    ("tip_force", items.LoadForceVector, "loadVectorUserFunction"),
    ("tip_moment", items.LoadTorqueVector, "loadVectorUserFunction"),
):
    if any(case.get(key, ())):
        system.AddLoad(kind(markerNumber=marker, loadVector=case[key], **{function: grown}))
position = items.SensorKinematicTree(**at, storeInternal=True, outputVariableType=exu.OutputVariableType.Position)
angles = items.SensorNode(nodeNumber=0, storeInternal=True, outputVariableType=exu.OutputVariableType.Coordinates)
rates = items.SensorNode(nodeNumber=0, storeInternal=True, outputVariableType=exu.OutputVariableType.Coordinates_t)
position, angles, rates = map(system.AddSensor, (position, angles, rates))
system.Assemble()

every = case["every_s"]
per_sample = max(round(every / (options.step or case["step_s"])), 1)
settings = exu.SimulationSettings()
settings.timeIntegration.endTime = case["duration_s"]
settings.timeIntegration.numberOfSteps = round(case["duration_s"] / every) * per_sample
settings.timeIntegration.generalizedAlpha.spectralRadius = options.radius
settings.timeIntegration.newton.relativeTolerance = 1e-10
settings.timeIntegration.newton.useModifiedNewton = True
settings.timeIntegration.verboseMode = 0
settings.solution.sensors.writePeriod = every
settings.solution.file.write = False
system.SolveDynamic(settings)
place, turned = (system.GetSensorStoredData(sensor) for sensor in (position, angles))
columns = {"time": place[:, 0], "tip_x": place[:, 1], "tip_y": place[:, 2], "tip_z": place[:, 3]}
columns |= {"deflection": place[:, 3], "angle": turned[:, 1:] @ bending, "twist": turned[:, 1:] @ torsion}
if "energy" in sheet["columns"]:  # of links that turn about parallel axes, from their own motion
    masses, centres, inertias = (np.array(one) for one in list(zip(*chain.TREE, strict=True))[5:])
    inertias = inertias[:, 1]
    speed = system.GetSensorStoredData(rates)[:, 1:]
    phi, spin = -np.cumsum(turned[:, 1:], axis=1), -np.cumsum(speed, axis=1)
    part = np.array([*offsets[1:], 0.0])  # of a link to its next joint
    along = np.stack([np.cos(phi), np.sin(phi)])
    across = np.stack([-np.sin(phi), np.cos(phi)]) * spin
    before = np.cumsum(part * along, axis=2) - part * along + centres * along
    moving = np.cumsum(part * across, axis=2) - part * across + centres * across
    gravity = np.array(case.get("gravity", (0, 0, 0)))[[0, 2]]
    rest = np.stack([places + centres, np.zeros(len(places))])[:, None]
    kinetic = 0.5 * (masses * (moving**2).sum(axis=0)).sum(axis=1) + 0.5 * (inertias * spin**2).sum(axis=1)
    springy = 0.5 * (np.array(springs) * turned[:, 1:] ** 2).sum(axis=1)
    columns["energy"] = kinetic + springy - ((before - rest) * gravity[:, None, None] * masses).sum(axis=(0, 2))
table = np.column_stack([columns[name] for name in sheet["columns"]])
np.savetxt(options.out, table, delimiter=",", header=",".join(sheet["columns"]), comments="", fmt="%.15g")
print(f"wrote {options.out}: {len(table)} rows, step {every / per_sample:.3g} s")
