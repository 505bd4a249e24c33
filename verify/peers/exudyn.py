"""Exudyn: plane rigid bodies in redundant coordinates, revolute joints, its trapezoidal rule of index 2.

That rule has no numerical damping, order 2 and no limit of the step. It holds joints by their speeds: held by their
places, as its generalised-alpha method does unless told otherwise, rounding grows as the step to the power of -2. A
slider is a mass on one coordinate whose load, a user function, reads the angular velocities of the links under it.

What it does when it breaks: where Newton's iteration stalls it halves its own step, down to its smallest, and then
raises an error that says neither when nor why; its solver's records do. A run here tells them.
"""

from collections.abc import Callable
from contextlib import redirect_stdout
from io import StringIO
from time import perf_counter
from typing import Any

import numpy as np

from verify.models.arrays import Array
from verify.peers.case import SAMPLES, Case, PeerRun, Sled, clocks, count, near, since, surface_speed

NEWTON, WITH_SLIDER = 1e-7, 1e-9
"""Of the residual, relative: one correction of the chain meets the first; friction, no part of the Jacobian and a small
one of the residual, takes more, and its slider goes astray in short steps without it."""


class Exudyn:
    """The engine behind the room's interface."""

    def frequencies(self, case: Case) -> Array:
        """By its own eigenvalue solver, which eliminates the constraints."""
        system, _, _ = assemble(case)
        system.Assemble()
        with redirect_stdout(StringIO()):
            found, _ = system.ComputeODE2Eigenvalues(convert2Frequencies=True, useAbsoluteValues=True)
        return np.sort(np.asarray(found, dtype=float))[-(case.n - 1) :]

    def prepare(self, case: Case, sled: Sled | None = None) -> Callable[[float, float], PeerRun]:
        """Nothing can be made beforehand: the engine does not start anew from rest without being assembled again."""

        def run(step: float, end: float) -> PeerRun:
            steps, _ = count(step, end)
            began = perf_counter()
            system, nodes, bodies = assemble(case)
            sensors = [_mid_span(case, system, bodies)] + (_add_slider(case, sled, system, nodes) if sled else [])
            system.Assemble()
            settings = settings_for(steps, end, WITH_SLIDER if sled else NEWTON)
            ready = clocks()
            raised = _solve(system, settings)
            seconds, cpu_s = since(ready)
            kept = [
                np.array(system.GetSensorStoredData(sensor)).reshape(-1, 4 if i == 0 else 2)[1:]
                for i, sensor in enumerate(sensors)
            ]
            solver = system.sys["dynamicSolver"]
            return PeerRun(
                times=kept[0][:, 0],
                deflection=kept[0][:, 2],
                distance=kept[1][:, 1] if sled else np.zeros(0),
                speed=kept[2][:, 1] if sled else np.zeros(0),
                seconds=seconds,
                cpu_s=cpu_s,
                set_up_s=ready[0] - began,
                steps=_good(solver, raised),
                broke=_broke(solver, steps, raised) if raised else "",
            )

        return run


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
    for k, force in enumerate(case.forces):
        link, where = case.place(force.position)

        def pull(_: object, t: float, __: object, k: int = k) -> list[float]:
            return [0.0, case.now(t)[k], 0.0]

        marker = point(bodies[link], where - half)
        load = items.LoadForceVector(markerNumber=marker, loadVector=[0.0, 1.0, 0.0], loadVectorUserFunction=pull)
        system.AddLoad(load)
    return system, nodes, bodies


def _mid_span(case: Case, system: Any, bodies: list[int]) -> int:
    """The sensor of mid-span."""
    import exudyn as exu
    from exudyn import utilities as items

    middle, at = case.place(0.5 * case.length)
    sensor = items.SensorBody(
        bodyNumber=bodies[middle],
        localPosition=[at - case.link / 2, 0.0, 0.0],
        storeInternal=True,
        writeToFile=False,
        outputVariableType=exu.OutputVariableType.Position,
    )
    return int(system.AddSensor(sensor))


def _add_slider(case: Case, sled: Sled, system: Any, nodes: list[int]) -> list[int]:
    """A mass on one coordinate and its friction; the sensors of its distance and speed."""
    import exudyn as exu
    from exudyn import utilities as items

    place, rate = exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t
    spin = exu.OutputVariableType.AngularVelocity
    node = system.AddNode(
        items.Node1D(referenceCoordinates=[0.0], initialCoordinates=[0.0], initialVelocities=[sled.speed])
    )
    system.AddObject(items.Mass1D(mass=sled.mass, nodeNumber=node))
    marker = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

    def rub(mbs: Any, t: float, load: object) -> float:
        x = sled.start + float(np.ravel(mbs.GetNodeOutput(node, place))[0])
        v = float(np.ravel(mbs.GetNodeOutput(node, rate))[0])
        first = near(case, x) - 2
        spins = [float(mbs.GetNodeOutput(nodes[j], spin)[2]) for j in range(first, first + 5)]
        return sled.force(v - surface_speed(case, sled, spins, x, first))

    system.AddLoad(items.LoadCoordinate(markerNumber=marker, load=1.0, loadUserFunction=rub))
    return [
        int(
            system.AddSensor(
                items.SensorNode(nodeNumber=node, storeInternal=True, writeToFile=False, outputVariableType=kind)
            )
        )
        for kind in (place, rate)
    ]


def settings_for(steps: int, end: float, tolerance: float) -> Any:
    """Modified Newton to a relative tolerance of its residual, sparse matrices."""
    import exudyn as exu

    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, end
    settings.timeIntegration.verboseMode = 0
    settings.timeIntegration.newton.useModifiedNewton = True
    settings.timeIntegration.newton.relativeTolerance = tolerance
    settings.timeIntegration.newton.absoluteTolerance = 1e-12
    settings.timeIntegration.newton.numericalDifferentiation.minimumCoordinateSize = 1
    _put(settings, False, "solution.file.write", "solutionSettings.writeSolutionToFile")
    _put(settings, end / min(SAMPLES, steps), "solution.sensors.writePeriod", "solutionSettings.sensorsWritePeriod")
    _put(settings, exu.LinearSolverType.EigenSparse, "linearSolver.solverType", "linearSolverType")
    return settings


def _put(settings: Any, value: object, path: str, before: str) -> None:
    """Put a value where the engine keeps it now, or kept it before."""
    for names in (path.split("."), before.split(".")):
        owner = settings
        for name in names[:-1]:
            owner = getattr(owner, name, None)
        if hasattr(owner, names[-1]):
            setattr(owner, names[-1], value)
            return
    raise AttributeError(f"Exudyn's settings have neither {path} nor {before}: another version is needed")


def _solve(system: Any, settings: Any) -> str:
    """Integrates; what the engine raised, if it did. What it prints is taken in."""
    import exudyn as exu

    with redirect_stdout(StringIO()):
        try:
            system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2, showHints=False)
        except exu.SolverError as error:
            return str(error) or "an error"
    return ""


def _good(solver: Any, raised: str) -> int:
    """Steps that it finished: its index is of the next one, and where it raised of the one after that."""
    return int(solver.it.currentStepIndex) - (2 if raised else 1)


def _broke(solver: Any, steps: int, raised: str) -> str:
    """When it gave up, and what its solver's records say."""
    it, conv = solver.it, solver.conv
    return (
        f"at t = {float(it.currentTime):.4g} s it raised {raised!r}: Newton's iteration stalled at a residual of "
        f"{float(conv.residual):.2g} after it had cut its step to {float(it.currentStepSize):.2g} s; "
        f"{_good(solver, raised)} steps were finished where {steps} were asked for, "
        f"{int(it.newtonStepsCount)} iterations in all"
    )
