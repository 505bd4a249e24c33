"""Record of the case restitution in Exudyn: three masses meet a spring and dashpot without tension. CC0-1.0."""

import argparse

import exudyn
import numpy as np
from exudyn.itemInterface import CoordinateSpringDamper, MarkerNodeCoordinate, Mass1D, Node1D, NodePointGround

MASS, STIFFNESS, RATIOS, SPEED, GAP, END, RATE = 0.7, 3500.0, (0.05, 0.2, 0.5), 1.3, 0.001, 0.1, 2000.0


def force(mbs, time, item, height, speed, stiffness, damping, offset):
    """Force of the spring on the mass, towards the wall: none where it would be tensile, and none above the wall."""
    return min(stiffness * height + damping * speed, 0.0) if height < 0.0 else 0.0


def main() -> None:
    """Simulate and write the record."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--step", type=float, default=0.00002, help="time step, s")
    parser.add_argument("--out", default="run.csv")
    given = parser.parse_args()
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    ground = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))
    balls = []
    for ratio in RATIOS:
        ball = system.AddNode(Node1D(referenceCoordinates=[0.0], initialCoordinates=[GAP], initialVelocities=[-SPEED]))
        balls.append(ball)
        system.AddObject(Mass1D(mass=MASS, nodeNumber=ball))
        marks = [ground, system.AddMarker(MarkerNodeCoordinate(nodeNumber=ball, coordinate=0))]
        damping = 2.0 * ratio * np.sqrt(STIFFNESS * MASS)
        system.AddObject(
            CoordinateSpringDamper(
                markerNumbers=marks, stiffness=STIFFNESS, damping=damping, springForceUserFunction=force
            )
        )
    system.Assemble()
    rows, every, counter = [(0.0, *(-SPEED for _ in balls))], round(1.0 / (RATE * given.step)), [0]

    def record(mbs: exudyn.MainSystem, time: float) -> bool:
        counter[0] += 1
        if counter[0] % every == 0:
            speeds = (mbs.GetNodeOutput(ball, exudyn.OutputVariableType.Coordinates_t) for ball in balls)
            rows.append((time, *(float(np.ravel(speed)[0]) for speed in speeds)))
        return True

    system.SetPostStepUserFunction(record)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(END / given.step)
    settings.timeIntegration.endTime = END
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    system.SolveDynamic(settings)
    header = "time,speed_a,speed_b,speed_c"
    np.savetxt(given.out, rows, delimiter=",", fmt="%.9g", header=header, comments="")


if __name__ == "__main__":
    main()
