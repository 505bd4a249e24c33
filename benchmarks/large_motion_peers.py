"""Chains of links in MuJoCo and ANCF cables in Exudyn on the problems of `benchmarks.large_motion`.

A hub that turns as prescribed is in MuJoCo a hinge with an armature of 1e9 kg m^2 under the torque of its acceleration,
in Exudyn the slope of the first node. An equilibrium is in Exudyn that of its static solver, in MuJoCo, which has none,
the rest to which a damped motion comes.
"""

from math import cos, sin
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.chain.system import ChainSystem
from verify.problem.base_motion import Prescribed
from verify.problem.beam import Beam

ARMATURE = 1e9  # the beam's moment at the hub, 3e2 N m, changes the acceleration by 1e-6
RADIUS = 0.9  # spectral radius of Exudyn's generalised-alpha method, its default
RESIDUAL = 1e-5
"""Absolute tolerance of Exudyn's Newton iteration, N: its default, 1e-10, is below the rounding of EA, so that steps
fail and are halved down to microseconds."""


def links_in_mujoco(
    system: ChainSystem,
    times: Array,
    step: float,
    *,
    hub: Prescribed | None = None,
    force: float = 0.0,
    damping: float = 0.0,
    integrator: str = "RK4",
) -> Array:
    """Path of the tip, (n, 2), m, in the frame of the hub, from rest; steps divide the spacing of the times from 0.

    `force` is a dead one across at the tip, `damping` that of the joints over their stiffness, s.
    """
    import mujoco
    from mujoco.rollout import rollout

    bodies, near, n = "", 0.0, system.n_links
    for length, mass, inertia, stiffness in zip(
        *(one.tolist() for one in (system.lengths, system.masses, system.inertias, system.stiffness)), strict=True
    ):
        bodies += f'<body pos="{near!r} 0 0"><inertial pos="{length / 2!r} 0 0" mass="{mass!r}" '
        bodies += f'diaginertia="{inertia!r} {inertia!r} {inertia!r}"/>'
        bodies += f'<joint axis="0 0 1" stiffness="{stiffness!r}" damping="{float(damping * stiffness)!r}"/>'
        near = length
    tip = f'<body pos="{near!r} 0 0"><inertial pos="0 0 0" mass="1e-9" diaginertia="1e-9 1e-9 1e-9"/></body>'
    if hub:
        joint = f'<joint name="hub" axis="0 0 1" armature="{ARMATURE!r}"/>'
        bodies = f'<body><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>{joint}{bodies}'
    across = f"{system.gravity[0]!r} {system.gravity[1]!r} 0"
    model = mujoco.MjModel.from_xml_string(
        '<mujoco><compiler boundmass="0" boundinertia="0" inertiafromgeom="false"/><size memory="200M"/>'
        f'<option integrator="{integrator}" gravity="{across}"/>'
        f"<worldbody>{bodies}{tip}{'</body>' * (n + bool(hub))}</worldbody></mujoco>"
    )
    each = max(round((times[1] - times[0]) / step), 1)
    model.opt.timestep = (times[1] - times[0]) / each
    data, steps = mujoco.MjData(model), each * (len(times) - 1)
    spec, control = mujoco.mjtState.mjSTATE_QFRC_APPLIED, np.zeros((1, model.nv))
    if hub:
        control = np.zeros((steps, model.nv))
        rates = np.array([hub(time)[1] for time in model.opt.timestep * np.arange(steps + 1)])
        control[:, 0] = ARMATURE * np.diff(rates) / model.opt.timestep
    elif force:
        spec, control = mujoco.mjtState.mjSTATE_XFRC_APPLIED, np.zeros((1, 6 * model.nbody))
        control[0, -5] = force
    whole = mujoco.mjtState.mjSTATE_FULLPHYSICS
    start = np.zeros(mujoco.mj_stateSize(model, whole))
    mujoco.mj_getState(model, data, start, whole)
    mujoco.set_mju_user_warning(lambda text: None)  # of a run that grows; the default handler writes a file
    states, _ = rollout(model, data, start, control, control_spec=int(spec), nstep=steps)
    angles = np.vstack([start, states[0, each - 1 :: each]])[:, 1 + bool(hub) : 1 + model.nq]
    turns = np.cumsum(angles, axis=1)
    return np.stack([np.cos(turns) @ system.lengths, np.sin(turns) @ system.lengths], axis=1)


def cables_in_exudyn(
    beam: Beam,
    axial_stiffness: float,
    count: int,
    times: Array,
    step: float,
    *,
    hub: Prescribed | None = None,
    gravity: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """Path of the tip, (n, 2), m, in the frame of the hub: ANCF cables with reduced integration of EA."""
    import exudyn

    system, tip = _cables(beam, axial_stiffness, count, hub, gravity)
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.numberOfSteps = round(times[-1] / step)
    settings.timeIntegration.endTime = float(times[-1])
    settings.timeIntegration.generalizedAlpha.spectralRadius = RADIUS
    settings.timeIntegration.newton.absoluteTolerance = RESIDUAL
    settings.timeIntegration.verboseMode = 0
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = float(times[1] - times[0])
    settings.show.computationTime = False
    system.SolveDynamic(settings)
    rows = np.array(system.GetSensorStoredData(tip))
    at, x, y = rows[:, :3].T
    angle = np.array([hub(time)[0] if hub else 0.0 for time in at.tolist()])
    path = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    return np.stack([np.interp(times, at, line) for line in path], axis=1)


def bent_cables(beam: Beam, axial_stiffness: float, count: int, force: float) -> float:
    """Deflection, m, of a cantilever of ANCF cables under a dead force across at its tip."""
    import exudyn

    system, tip = _cables(beam, axial_stiffness, count, None, (0.0, 0.0), force)
    settings = exudyn.SimulationSettings()
    settings.staticSolver.numberOfLoadSteps = 4
    settings.staticSolver.verboseMode = 0
    settings.solution.file.write = False
    system.SolveStatic(settings)
    return float(system.GetSensorValues(tip)[1])


def _cables(
    beam: Beam, axial: float, count: int, hub: Prescribed | None, gravity: tuple[float, float], force: float = 0.0
) -> tuple[Any, int]:
    """The assembled system and the sensor of its tip."""
    import exudyn
    from exudyn.beams import GenerateStraightLineANCFCable
    from exudyn.itemInterface import (
        Cable2D,
        CoordinateConstraint,
        Force,
        MarkerNodeCoordinate,
        MarkerNodePosition,
        NodePointGround,
        SensorNode,
    )

    system = exudyn.SystemContainer().AddSystem()
    cable = Cable2D(
        physicsMassPerLength=beam.mass_per_length,
        physicsBendingStiffness=beam.bending_stiffness,
        physicsAxialStiffness=axial,
        useReducedOrderIntegration=1,
    )
    held = [1, 1, 0, 0 if hub or beam.supports[0] == "pinned" else 1]
    more = {"massProportionalLoad": [*gravity, 0.0]} if any(gravity) else {}
    line = ([0, 0, 0], [beam.length, 0, 0], count, cable)
    nodes = GenerateStraightLineANCFCable(system, *line, fixedConstraintsNode0=held, **more)[0]
    if hub:
        ground = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))
        slopes = (lambda t: cos(hub(t)[0]) - 1.0, lambda t: sin(hub(t)[0]))
        for coordinate, slope in zip((2, 3), slopes, strict=True):
            marker = system.AddMarker(MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
            system.AddObject(
                CoordinateConstraint(
                    markerNumbers=[ground, marker],
                    offset=0.0,
                    offsetUserFunction=lambda system, t, item, offset, slope=slope: slope(t),
                )
            )
    if force:
        end = system.AddMarker(MarkerNodePosition(nodeNumber=nodes[-1]))
        system.AddLoad(Force(markerNumber=end, loadVector=[0.0, force, 0.0]))
    position = exudyn.OutputVariableType.Position
    sensor = system.AddSensor(SensorNode(nodeNumber=nodes[-1], storeInternal=True, outputVariableType=position))
    system.Assemble()
    return system, sensor
