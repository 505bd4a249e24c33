"""Exudyn: plane rigid bodies in redundant coordinates, revolute joints, its trapezoidal rule of index 2.

The rule has order 2, no numerical damping and no step limit, and constrains velocities: with constrained positions
rounding grows as 1 / step^2. If Newton's iteration fails the engine halves its step, then raises an error.
"""

from contextlib import redirect_stdout
from io import StringIO
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.base import SAMPLES, Chain, Run

TOLERANCE = 1e-7
"""Relative tolerance of Newton's residual."""


class Exudyn:
    """The adapter."""

    def frequencies(self, chain: Chain) -> Array:
        """Natural frequencies by the engine's eigenvalue solver, which eliminates the constraints."""
        system, _ = assemble(chain)
        system.Assemble()
        with redirect_stdout(StringIO()):
            hertz, _ = system.ComputeODE2Eigenvalues(convert2Frequencies=True, useAbsoluteValues=True)
        return np.sort(np.asarray(hertz, dtype=float))[1 - chain.rigid.count :]

    def run(self, chain: Chain, steps: int, end: float) -> Run:
        """Motion by the trapezoidal rule: modified Newton, sparse matrices, sensors at `SAMPLES` times."""
        import exudyn as exu
        from exudyn import utilities as items

        system, bodies = assemble(chain)
        middle, at = chain.locate(0.5 * chain.rigid.beam.length)
        position = {"outputVariableType": exu.OutputVariableType.Position, "storeInternal": True, "writeToFile": False}
        place = [at - chain.rigid.links[0].centre, 0.0, 0.0]
        sensor = system.AddSensor(items.SensorBody(bodyNumber=bodies[middle], localPosition=place, **position))
        system.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, end
        settings.timeIntegration.verboseMode = 0
        newton = settings.timeIntegration.newton
        newton.useModifiedNewton = True
        newton.relativeTolerance, newton.absoluteTolerance = TOLERANCE, 1e-12
        newton.numericalDifferentiation.minimumCoordinateSize = 1
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = end / min(SAMPLES, steps)
        failure = ""
        with redirect_stdout(StringIO()):
            try:
                rule = exu.DynamicSolverType.TrapezoidalIndex2
                system.SolveDynamic(settings, solverType=rule, showHints=False)
            except exu.SolverError as error:
                failure = f"it raised {str(error) or 'an error'!r}"
        times, _, deflection, _ = np.array(system.GetSensorStoredData(sensor)).reshape(-1, 4)[1:].T
        done = int(system.sys["dynamicSolver"].it.currentStepIndex) - (2 if failure else 1)
        return Run(times, deflection, done, failure)


def assemble(chain: Chain) -> tuple[Any, list[int]]:
    """(system, bodies) of the chain with its springs, its roller and its forces."""
    import exudyn as exu
    from exudyn import utilities as items

    links, joints = chain.rigid.links, chain.rigid.joints
    half = links[0].centre
    system = exu.SystemContainer().AddSystem()
    ground = system.AddObject(items.ObjectGround())
    middles = [[link.start + half, 0.0, 0.0] for link in links]
    nodes = [system.AddNode(items.NodeRigidBody2D(referenceCoordinates=place)) for place in middles]
    body = {"mass": links[0].mass, "inertia": links[0].inertia[1]}
    bodies = [system.AddObject(items.ObjectRigidBody2D(nodeNumber=node, **body)) for node in nodes]

    def point(body: int, x: float) -> int:
        return int(system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0.0, 0.0])))

    turns = [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2)) for node in nodes]
    system.AddObject(items.RevoluteJoint2D(markerNumbers=[point(ground, 0.0), point(bodies[0], -half)]))
    for i, joint in enumerate(joints[1:-1]):
        stiffness = joint.hinges[0].stiffness
        ends = [point(bodies[i], half), point(bodies[i + 1], -half)]
        system.AddObject(items.RevoluteJoint2D(markerNumbers=ends))
        system.AddObject(items.CoordinateSpringDamper(markerNumbers=turns[i : i + 2], stiffness=stiffness))
    tip = system.AddMarker(items.MarkerBodyRigid(bodyNumber=bodies[-1], localPosition=[half, 0.0, 0.0]))
    far = system.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=[joints[-1].position, 0.0, 0.0]))
    system.AddObject(items.GenericJoint(markerNumbers=[far, tip], constrainedAxes=[0, 1, 0, 0, 0, 0]))
    for k, force in enumerate(chain.forces):
        link, at = chain.locate(force.position)

        def load(_: object, t: float, __: object, k: int = k) -> list[float]:
            return [0.0, chain.force_values(t)[k], 0.0]

        at_force = {"markerNumber": point(bodies[link], at - half), "loadVectorUserFunction": load}
        system.AddLoad(items.LoadForceVector(loadVector=[0.0, 1.0, 0.0], **at_force))
    return system, bodies
