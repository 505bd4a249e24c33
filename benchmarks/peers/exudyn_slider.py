"""Exudyn with the slider as a mass on one coordinate; friction as a user function of the links' angular velocities."""

from time import perf_counter

import numpy as np

from benchmarks.peers.case import Case, count
from benchmarks.peers.exudyn_chain import assemble, settings_for
from benchmarks.peers.slider import Run, Sled, surface_speed


def prepare(case: Case, sled: Sled) -> Run:
    """A run with forces and friction. Assembly is done anew for each, outside of what the engine integrates."""
    import exudyn as exu
    from exudyn import utilities as items

    def run(step: float, end: float) -> tuple[float, float, float]:
        steps, _ = count(step, end)
        system, nodes, _ = assemble(case)
        node = system.AddNode(items.Node1D(referenceCoordinates=[0.0]))
        system.AddObject(items.Mass1D(mass=sled.mass, nodeNumber=node))
        marker = system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=0))

        def rub(system: object, t: float, load: object) -> float:
            read = system.GetNodeOutput  # type: ignore[attr-defined]
            x = sled.start + float(np.ravel(read(node, exu.OutputVariableType.Coordinates))[0])
            v = float(np.ravel(read(node, exu.OutputVariableType.Coordinates_t))[0])
            near = min(max(int(x / case.link), 2), case.n - 3)
            spins = np.zeros(case.n)
            for j in range(near - 2, near + 3):
                spins[j] = read(nodes[j], exu.OutputVariableType.AngularVelocity)[2]
            return sled.force(v - surface_speed(case, sled, spins, x))

        system.AddLoad(items.LoadCoordinate(markerNumber=marker, load=1.0, loadUserFunction=rub))
        system.Assemble()
        settings = settings_for(steps, end)
        begun = perf_counter()
        system.SolveDynamic(settings, solverType=exu.DynamicSolverType.GeneralizedAlpha)
        seconds = perf_counter() - begun
        kinds = (exu.OutputVariableType.Coordinates, exu.OutputVariableType.Coordinates_t)
        distance, speed = (float(np.ravel(system.GetNodeOutput(node, kind))[0]) for kind in kinds)
        return distance, speed, seconds

    return run
