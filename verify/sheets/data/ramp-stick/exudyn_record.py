"""Record of the case ramp-stick in Exudyn: a mass under its weight along the slope, friction by a bristle. CC0-1.0."""

import argparse

import exudyn
import numpy as np
from exudyn.itemInterface import (
    CoordinateSpringDamperExt,
    LoadCoordinate,
    MarkerNodeCoordinate,
    Mass1D,
    Node1D,
    NodeGenericData,
    NodePointGround,
)

MASS, MU, ANGLE, END, RATE = 1.3, 0.45, np.radians(17.0), 2.0, 100.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.0001, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    parser.add_argument("--bristle", type=float, default=1e6, help="stiffness while the block sticks, N/m")
    given = parser.parse_args()
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    block = system.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[0.0]))
    system.AddObject(Mass1D(mass=MASS, nodeNumber=block))
    ground = system.AddNode(NodePointGround())
    marks = [system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=0)) for node in (ground, block)]
    system.AddLoad(LoadCoordinate(markerNumber=marks[1], load=MASS * 9.81 * np.sin(ANGLE)))
    state = system.AddNode(NodeGenericData(initialCoordinates=[1.0, 0.0, 0.0], numberOfDataCoordinates=3))
    system.AddObject(
        CoordinateSpringDamperExt(
            markerNumbers=marks,
            nodeNumber=state,
            dynamicFrictionForce=MU * MASS * 9.81 * np.cos(ANGLE),
            stickingStiffness=given.bristle,
            stickingDamping=2.0 * np.sqrt(given.bristle * MASS) * 0.1,
            frictionProportionalZone=0.0,
        )
    )
    system.Assemble()
    rows = [(0.0, 0.0)]
    every = round(1.0 / (RATE * given.step))
    counter = [0]

    def record(mbs: exudyn.MainSystem, time: float) -> bool:
        counter[0] += 1
        if counter[0] % every == 0:
            rows.append((time, float(np.ravel(mbs.GetNodeOutput(block, exudyn.OutputVariableType.Coordinates))[0])))
        return True

    system.SetPostStepUserFunction(record)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(END / given.step)
    settings.timeIntegration.endTime = END
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    system.SolveDynamic(settings)
    np.savetxt(given.out, rows, delimiter=",", fmt="%.9g", header="time,position", comments="")


if __name__ == "__main__":
    main()
