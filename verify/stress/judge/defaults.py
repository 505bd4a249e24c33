"""What verbs take unless they are told, as their pages have it; linear chains that go on from where they were."""

from importlib import import_module
from inspect import Parameter, signature
from typing import Any

import numpy as np

from verify.beam import PointForce
from verify.chain import warm
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import held

TAKEN = """
elements.linear:solve_modes grading=1.0
elements.linear:solve_harmonic modal_damping=0.0 grading=1.0
elements.linear:buckling_load grading=1.0
elements.sweeps:sweep_harmonic modal_damping=0.0 grading=1.0
elements.sweeps:sweep_modes grading=1.0
segments.linear:solve_modes grading=1.0
segments.linear:solve_harmonic modal_damping=0.0 joint_dashpot=0.0 grading=1.0
segments.buckling:buckling_load grading=1.0
segments.assembly:build_chain grading=1.0
segments.orders:order_of grading=1.0
segments.sweeps:sweep_harmonic modal_damping=0.0 joint_dashpot=0.0 grading=1.0
segments.sweeps:sweep_modes grading=1.0
exact.modes:mode_shape derivative=0
exact.modes:mode_shapes derivative=0
models.division:divide grading=1.0
models.division:check_division grading=1.0
chain.bending:bend load=0.0 moment=0.0
chain.problems:rollup_gap turns=1.0
chain.problems:transient axial_inertia=True most=400000000.0
chain.problems:contact_line_error grading=1.0
chain.ride:ride_from_rest tolerance=1e-09 most=400000000.0
chain.splitting:simulate_modal kicks=2 most=inf
chain.stepping:simulate tolerance=1e-08 ledger=True most=inf
chain.stretching:simulate_elastic immovable=False most=inf
chain.system:build_system frequency_hz=0.0 grading=1.0 joint_dashpot=0.0 axial_inertia=True immovable=False
chain.system:axial_stiffness grading=1.0
chain.system:straight_chain unit=1.0 mass=1.0 spring=1.0
chain.system:Rotation offset=0.0 rate=0.0 amplitude=0.0 frequency_hz=0.0 phase_deg=0.0
chain.system:LinkLoad moment=0.0 frequency_hz=0.0 phase_deg=0.0
chain.system:Actuator amplitude=0.0 frequency_hz=0.0 phase_deg=0.0
chain.system:ChainSystem axial_spring=0.0 axial_inertia=True
chain.system:ChainState time=0.0
motion.case:MotionCase.run samples=2 steps_per_period=64 ledger=False patient=True
motion.free_vibration:free_vibration samples=201
motion.simulate:simulate soft_start_periods=0.0 samples=201 steps_per_period=64 ledger=True patient=True
motor.case:MotorCase count=49 soft_start_periods=0.0 steps_per_period=61
motor.on_wave:over_a_wave epsilon=0.0 mu=0.2 points=61 steps_per_period=256 amplitude=1e-09
motor.run:run_motor soft_start_periods=0.0 samples=201 steps_per_period=61 frozen=False patient=True
motor.run:run_motors soft_start_periods=0.0 samples=201 steps_per_period=61 frozen=False patient=True
motor.shooting:periodic speed=0.0 tolerance=1e-10 settle=100
motor.figures:at_speed periods=46080
motor.figures:started periods=4000
contact.landing:lift_off_ratio damping_ratio=0.0
contact.layer:force epsilon=0.0
contact.layer:no_load_speed epsilon=0.0
waves.absorber:beam_impedance turning=False
waves.absorber:matched_impedance turning=False
waves.absorber:matched_device turning=False
waves.measures:surface_motion turn=1.0
waves.operating_point:operating_points limit=0.1
waves.lumped:TwoModes ratio=1.0 phase_deg=90.0
judge.compare:shape_error typical=0.0
judge.crossing:Point spread=0.0
judge.crossing:within between=True
judge.variants:Rules grading=1.0
identify.compare:Asked error=0.001
identify.reading:read_frequencies sorted_list=True
"""
"""Room, module, verb or value; its numbers and switches with what they are unless told."""


def taken_error(number: float) -> float:
    """How many verbs and values take other numbers, or switches the other way, where nobody tells."""
    wrong = 0
    for line in TAKEN.split("\n")[1:-1]:
        name, *expected = line.split()
        module, _, path = name.partition(":")
        found: Any = import_module(f"verify.{module}")
        for part in path.split("."):
            found = getattr(found, part)
        plain = [
            f"{one.name}={one.default!r}"
            for one in signature(found).parameters.values()
            if one.default is not Parameter.empty and isinstance(one.default, bool | int | float)
        ]
        wrong += sorted(plain) != sorted(expected)
    return float(wrong)


def going_on_error(links: float) -> float:
    """Of linear chains under a drive, on from where they were at a third of the time, over the largest; kept places."""
    from verify.chain.splitting import linear_deflection, modal_basis, simulate_linear
    from verify.chain.system import ChainState, build_system

    n, worst = int(links), 0.0
    for ends in (("pinned", "pinned"), ("clamped", "free"), ("pinned", "free")):
        forces = (PointForce(position=0.31, amplitude=0.02, phase_deg=20.0),)
        basis = modal_basis(build_system(held(*ends), n, forces, 37.0))
        still = ChainState(np.zeros(n), np.zeros(n), 0.0)
        times = np.linspace(0.0, 0.03, 13)
        whole = simulate_linear(basis, still, times)
        at = ChainState(whole.angles[4], whole.rates[4], float(times[4]))
        rest = simulate_linear(basis, at, times[4:])
        pairs = [(rest.angles, whole.angles[4:]), (rest.rates, whole.rates[4:]), (rest.times, times[4:])]
        for x in (0.2, 0.61):
            line = linear_deflection(basis, still, times, x)
            pairs += [(linear_deflection(basis, at, times[4:], x), line[4:]), (line, whole.deflection([x])[:, 0])]
        worst = largest(worst, *(float(abs(one - other).max() / (abs(other).max() or 1.0)) for one, other in pairs))
        done = (whole.statistics.steps, whole.statistics.evaluations, whole.statistics.stopped, whole.statistics.method)
        worst = largest(worst, float(done != (0, 0, "end", "linear, exact")), float(whole.dissipated.any()))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="unless-they-are-told",
        title="Numbers and switches of verbs and values where nobody gives them",
        why="docs: signatures of the API.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=taken_error,
    ),
    Floor(
        id="linear-chains-that-go-on",
        title="Linear chains under a drive, on from where they were, and read at a place, against the run as a whole",
        why="chain/splitting.py: exact at any time.",
        along="links",
        at=(3.0, 8.0),
        promise=1e-7,
        error=going_on_error,
        kernels=warm.rigid,
    ),
)
