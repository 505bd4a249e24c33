"""Exudyn: plane rigid bodies in redundant coordinates, revolute joints, its generalised-alpha integrator."""

from typing import Any

import numpy as np

from benchmarks.peers.case import Array, Case, Run, count

SAMPLES = 200


def assemble(case: Case) -> tuple[Any, list[int], list[int]]:
    """(system, nodes, bodies) of the chain with its springs, its roller and its forces; not assembled yet."""
    import exudyn as exu
    from exudyn import utilities as items

    half = case.link / 2
    system = exu.SystemContainer().AddSystem()
    ground = system.AddObject(items.ObjectGround())
    nodes = [
        system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[(i + 0.5) * case.link, 0.0, 0.0]))
        for i in range(case.n)
    ]
    bodies = [
        system.AddObject(items.ObjectRigidBody2D(mass=case.mass, inertia=case.inertia, nodeNumber=node))
        for node in nodes
    ]

    def point(body: int, x: float) -> int:
        return int(system.AddMarker(items.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0.0, 0.0])))

    turns = [system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=2)) for node in nodes]
    system.AddObject(items.RevoluteJoint2D(markerNumbers=[point(ground, 0.0), point(bodies[0], -half)]))
    for i in range(case.n - 1):
        ends = [point(bodies[i], half), point(bodies[i + 1], -half)]
        system.AddObject(items.RevoluteJoint2D(markerNumbers=ends))
        system.AddObject(items.CoordinateSpringDamper(markerNumbers=turns[i : i + 2], stiffness=case.spring))
    tip = system.AddMarker(items.MarkerBodyRigid(bodyNumber=bodies[-1], localPosition=[half, 0.0, 0.0]))
    far = system.AddMarker(items.MarkerBodyRigid(bodyNumber=ground, localPosition=[case.length, 0.0, 0.0]))
    system.AddObject(items.GenericJoint(markerNumbers=[far, tip], constrainedAxes=[0, 1, 0, 0, 0, 0]))
    for k, (x, _, _) in enumerate(case.forces):
        link, where = case.place(x)

        def pull(_: object, t: float, __: object, k: int = k) -> list[float]:
            return [0.0, case.now(t)[k], 0.0]

        system.AddLoad(
            items.LoadForceVector(
                markerNumber=point(bodies[link], where - half), loadVector=[0.0, 1.0, 0.0], loadVectorUserFunction=pull
            )
        )
    return system, nodes, bodies


def settings_for(steps: int, end: float) -> Any:
    """The integrator without numerical damping, modified Newton, sparse matrices."""
    import exudyn as exu

    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, end
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.generalizedAlpha.spectralRadius = 1.0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.relativeTolerance = 1e-8
    settings.timeIntegration.newton.absoluteTolerance = 1e-12
    settings.timeIntegration.newton.numericalDifferentiation.minimumCoordinateSize = 1
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = end / SAMPLES
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    return settings


def prepare(case: Case) -> Run:
    """A run of the chain. Assembly is part of a run: the engine does not start anew from rest without it."""
    import exudyn as exu
    from exudyn import utilities as items

    middle, at = case.place(case.length / 2)

    def run(step: float, end: float) -> tuple[Array, Array]:
        steps, _ = count(step, end)
        system, _, bodies = assemble(case)
        sensor = system.AddSensor(
            items.SensorBody(
                bodyNumber=bodies[middle],
                localPosition=[at - case.link / 2, 0.0, 0.0],
                storeInternal=True,
                writeToFile=False,
                outputVariableType=exu.OutputVariableType.Position,
            )
        )
        system.Assemble()
        system.SolveDynamic(settings_for(steps, end), solverType=exu.DynamicSolverType.GeneralizedAlpha)
        seen = np.array(system.GetSensorStoredData(sensor))
        return seen[1:, 0], seen[1:, 2]

    return run
