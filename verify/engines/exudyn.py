"""Exudyn: plane rigid bodies in redundant coordinates, revolute joints, its trapezoidal rule of index 2.

The rule has order 2, no numerical damping and no step limit, and constrains velocities: with constrained positions
rounding grows as 1 / step^2. If Newton's iteration fails the engine halves its step, then raises an error.
"""

from contextlib import redirect_stdout
from io import StringIO
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.engines.base import Chain, Run

TOLERANCE = 0.04
"""Relative tolerance of Newton's residual over (omega h)^2, to which the error of the rule is in proportion.

One iteration a step of the paper's beam down to errors of 3e-4, two below.
"""


class Exudyn:
    """The adapter."""

    def frequencies(self, chain: Chain) -> Array:
        """Natural frequencies by the engine's eigenvalue solver, which eliminates the constraints."""
        system = assemble(chain)
        system.Assemble()
        with redirect_stdout(StringIO()):
            hertz, _ = system.ComputeODE2Eigenvalues(convert2Frequencies=True, useAbsoluteValues=True)
        return np.sort(np.asarray(hertz, dtype=float))[1 - chain.rigid.count :]

    def run(self, chain: Chain, steps: int, end: float, order: int = 2) -> Run:
        """Motion by the trapezoidal rule, of order 2: modified Newton, sparse matrices."""
        import exudyn as exu

        system = assemble(chain)
        times, states = list[float](), list[Array]()

        def keep(system: Any, t: float) -> bool:
            if not times or t > times[-1] + 1e-3 * end / steps:  # the engine may add a step of rounding at the end
                now = system.systemData
                times.append(t)
                states.append(np.stack([now.GetODE2Coordinates(), now.GetODE2Coordinates_t()]))
            return True

        system.SetPostStepUserFunction(keep)
        system.Assemble()
        settings = exu.SimulationSettings()
        settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = steps, end
        settings.timeIntegration.verboseMode = 0
        newton = settings.timeIntegration.newton
        newton.useModifiedNewton = True
        newton.relativeTolerance = TOLERANCE * (2.0 * np.pi * chain.frequency_hz * end / steps) ** 2
        newton.absoluteTolerance = 1e-12
        newton.numericalDifferentiation.minimumCoordinateSize = 1
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        settings.solution.file.write = False
        failure = ""
        with redirect_stdout(StringIO()):
            try:
                rule = exu.DynamicSolverType.TrapezoidalIndex2
                system.SolveDynamic(settings, solverType=rule, showHints=False)
            except exu.SolverError as error:
                failure = f"it raised {str(error) or 'an error'!r}"
        angles, rates = np.array(states)[:, :, 2::3].transpose(1, 0, 2)
        return Run(np.array(times), angles, rates, failure)


def assemble(chain: Chain) -> Any:
    """The system of the chain with its springs, its roller and its forces."""
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
    forces = []
    for k, j in zip(*np.nonzero(chain.shares[:, 1:]), strict=True):  # joint j + 1 is the far end of link j
        forces.append(symbolic(system, chain, int(k), float(chain.shares[k, j + 1])))
        load = {"loadVector": [0.0, 1.0, 0.0], "loadVectorUserFunction": forces[-1]}
        system.AddLoad(items.LoadForceVector(markerNumber=point(bodies[j], half), **load))
    system.sys["forces"] = forces  # expressions must outlive the run
    return system


def symbolic(system: Any, chain: Chain, k: int, share: float) -> Any:
    """A share of force k as the engine's own expression, which it evaluates without Python."""
    from exudyn import symbolic as expressions
    from exudyn.utilities import CreateSymbolicUserFunction

    force, hertz, periods = chain.forces[k], chain.frequency_hz, chain.soft_start_periods

    def load(mbs: Any, t: Any, loadVector: Any) -> list[Any]:  # noqa: N803  # the engine's names
        value = share * force.amplitude * expressions.cos(2.0 * np.pi * hertz * t + float(np.radians(force.phase_deg)))
        if periods:
            p = expressions.min(t * (hertz / periods), expressions.Real(1.0))
            value = p * p * (3.0 - 2.0 * p) * value
        return [0.0, value, 0.0]

    return CreateSymbolicUserFunction(system, load, "loadVectorUserFunction", itemTypeName="LoadForceVector")
