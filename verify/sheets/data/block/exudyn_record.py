"""Record a block with friction in Exudyn: python exudyn_record.py, beside sheet.toml. CC0-1.0. Needs exudyn and numpy.

A mass of one coordinate, on a spring or under its weight along the slope; friction is a bristle. The frame is that of
the belt, in which the anchor of the spring moves backwards and the block starts at rest.
"""

import argparse
import tomllib

import exudyn
import numpy as np
from exudyn import utilities as items

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--sheet", default="sheet.toml")
parser.add_argument("--step", type=float, default=0.0001, help="time step, s")
parser.add_argument("--out", default="run.csv")
parser.add_argument("--bristle", type=float, default=1e6, help="stiffness while the block sticks, N/m")
parser.add_argument("--decay", type=float, default=1e-4, help="slip over which static friction ends, m/s")
options = parser.parse_args()

with open(options.sheet, "rb") as file:
    sheet = tomllib.load(file)
given = sheet["parameters"]
static = given.get("static_friction_coefficient") or given["friction_coefficient"]
kinetic = given.get("kinetic_friction_coefficient", static)
mass, angle = given["mass_kg"], np.radians(given.get("angle_deg", 0.0))
launched = given.get("speed_m_per_s", 0.0)
weight = mass * given["gravity_m_per_s2"] * np.array([np.cos(angle), np.sin(angle)])  # normal, along the slope
container = exudyn.SystemContainer()
system = container.AddSystem()
belt, spring = given.get("belt_speed_m_per_s", 0.0), given.get("stiffness_n_per_m", 0.0)
ground = system.AddNode(items.NodePointGround())
nodes, marks = [], [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))]
for size, start, speed in ((mass, given.get("start_m", 0.0), launched), (1e9, 0.0, -belt)):
    nodes.append(system.AddNode(items.Node1D(initialCoordinates=[start], initialVelocities=[speed])))
    system.AddObject(items.Mass1D(mass=size, nodeNumber=nodes[-1]))
    marks.append(system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[-1], coordinate=0)))
plane, block, anchor = marks
system.AddObject(items.CoordinateSpringDamper(markerNumbers=[anchor if belt else plane, block], stiffness=spring))
# along the slope downwards where the block starts at rest
system.AddLoad(items.LoadCoordinate(markerNumber=block, load=-weight[1] if launched else weight[1]))
system.AddObject(
    items.CoordinateSpringDamperExt(
        markerNumbers=[plane, block],
        nodeNumber=system.AddNode(items.NodeGenericData(initialCoordinates=[1.0, 0.0, 0.0], numberOfDataCoordinates=3)),
        dynamicFrictionForce=kinetic * weight[0],
        staticFrictionOffsetForce=(static - kinetic) * weight[0],
        stickingStiffness=options.bristle,
        stickingDamping=0.2 * np.sqrt(options.bristle * mass),
        exponentialDecayStatic=options.decay,
        frictionProportionalZone=0.0,
    )
)
kinds = exudyn.OutputVariableType
sensors = [
    system.AddSensor(items.SensorNode(nodeNumber=node, storeInternal=True, outputVariableType=kind))
    for node, kind in ((nodes[0], kinds.Coordinates), (nodes[1], kinds.Coordinates), (nodes[0], kinds.Coordinates_t))
]
system.Assemble()
settings = exudyn.SimulationSettings()
settings.timeIntegration.numberOfSteps = round(given["duration_s"] / options.step)
settings.timeIntegration.endTime = given["duration_s"]
settings.timeIntegration.verboseMode = 0
settings.solution.sensors.writePeriod = 1.0 / given["rate_hz"]
settings.solution.file.write = False
system.SolveDynamic(settings)
place, moved, speed = (system.GetSensorStoredData(sensor) for sensor in sensors)
columns = {"time": place[:, 0], "position": place[:, 1] - moved[:, 1], "speed": speed[:, 1]}
columns["sideways"] = np.zeros(len(place))  # in which the mass is not free
table = np.column_stack([columns[name] for name in sheet["columns"]])
np.savetxt(options.out, table, delimiter=",", fmt="%.9g", header=",".join(sheet["columns"]), comments="")
