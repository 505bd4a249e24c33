"""What every public verb tells of beams and sliders that are alike in nothing, in any units and in any words."""

from typing import NamedTuple

import numpy as np
from msgspec.structs import replace

from verify import (
    Beam,
    Contact,
    Foot,
    PointForce,
    PointMass,
    PointSpring,
    Section,
    Slider,
    analytic_modes,
    bend,
    fem_beam,
    free_vibration,
    run_motor,
    segment_model,
    simulate,
    travelling_wave,
)
from verify.chain.dynamics import at_rest
from verify.chain.ride import ride_from_rest
from verify.chain.splitting import modal_basis, simulate_modal
from verify.chain.stepping import simulate as simulate_chain
from verify.chain.stretching import simulate_elastic
from verify.chain.system import axial_stiffness, build_system

MODELS = {"analytic": (analytic_modes, ()), "fem": (fem_beam, (23,)), "segment": (segment_model, (23,))}
X = np.array([0.0, 0.11, 0.29, 0.37, 0.61, 0.83])


class Units(NamedTuple):
    """What a metre, a kilogram and a second of SI are called, and in which words a beam and what acts on it are told."""

    metre: float = 1.0
    kilogram: float = 1.0
    second: float = 1.0

    def length(self, value):
        return value * self.metre

    def mass(self, value):
        return value * self.kilogram

    def time(self, value):
        return value * self.second

    def rate(self, value):
        return value / self.second

    def speed(self, value):
        return value * self.metre / self.second

    def acceleration(self, value):
        return value * self.metre / self.second**2

    def force(self, value):
        return value * self.kilogram * self.metre / self.second**2

    def spring(self, value):
        return value * self.kilogram / self.second**2

    def dashpot(self, value):
        return value * self.kilogram / self.second

    def energy(self, value):
        return value * self.kilogram * self.metre**2 / self.second**2

    def inertia(self, value):
        return value * self.kilogram * self.metre**2

    def pressure(self, value):
        return value * self.kilogram / self.metre / self.second**2

    def line(self, value):
        return value * self.kilogram / self.metre

    def bending(self, value):
        return self.energy(value) * self.metre

    def none(self, value):
        return value

    def beam(self, beam):
        return beam

    def pushes(self, forces):
        return forces

    def slider(self, slider):
        return slider


def strip(u, **more):
    sizes = {"length": u.length(0.83), "width": u.length(0.027), "thickness": u.length(0.0019)}
    return u.beam(Beam(**sizes, youngs_modulus=u.pressure(193e9), density=u.line(7900.0) / u.metre**2, **more))


def laden(u, **more):
    """Of three sections, with two bodies, two springs, a pull, ground beneath and losses."""
    parts = ((0.29, 4.1, 0.37), (0.08, 31.0, 0.9), (0.46, 2.3, 0.31))
    beam = Beam(
        length=u.length(0.83),
        bending_stiffness=u.bending(2.3),
        mass_per_length=u.line(0.31),
        section=tuple(
            Section(length=u.length(long), bending_stiffness=u.bending(ei), mass_per_length=u.line(rho))
            for long, ei, rho in parts
        ),
        mass=(
            PointMass(position=u.length(0.11), mass=u.mass(0.03), rotary_inertia=u.inertia(2e-4)),
            PointMass(position=u.length(0.61), mass=u.mass(0.11)),
        ),
        spring=(
            PointSpring(position=u.length(0.37), stiffness=u.spring(230.0)),
            PointSpring(position=u.length(0.83), rotational=u.energy(3.7)),
        ),
        **{"tension": u.force(9.0), "foundation": u.pressure(41.0), "loss_factor": 0.013} | more,
    )
    return u.beam(beam)


def forces(u, size=1.0):
    return u.pushes(
        [
            PointForce(position=u.length(0.11), amplitude=u.force(1.4 * size)),
            PointForce(position=u.length(0.53), amplitude=u.force(0.7 * size), phase_deg=70.0),
        ]
    )


def slider(u, **more):
    given = {"mass": u.mass(0.021), "mu": 0.3, "preload": u.force(0.4), "gravity": u.acceleration(9.81)}
    return u.slider(Slider(**given, position=u.length(0.377), **more))


def grip(u, value=70.0):
    """K of Eq. (3)."""
    return {"slope": value / u.speed(1.0)}


def modes(u, model, theory, beam=laden):
    module, size = MODELS[model]
    found = module.solve_modes(beam(u), 5, *size, theory=theory)
    yield u.rate, found.frequencies_hz
    yield lambda value: value / u.kilogram**0.5, found.deflection(u.length(X))


def sheared(u):
    return strip(u, supports=("clamped", "free"))


def fields(u, model, beam):
    module, size = MODELS[model]
    hertz = u.rate(np.array([3.1, 44.0, 317.0]))
    if hasattr(module, "sweep_harmonic"):
        yield u.length, module.sweep_harmonic(beam(u), forces(u), hertz, *size).deflection(u.length(X))
    units = module.unit_responses(beam(u), u.length(np.array([0.2, 0.7])), hertz, u.length(X), *size)
    yield lambda value: value / u.spring(1.0), units
    field = module.solve_harmonic(beam(u), forces(u), float(hertz[1]), *size)
    yield u.length, field.deflection(u.length(X))


def waves(u, model):
    module, size = MODELS[model]
    beam = strip(u, loss_factor=0.01)
    found = travelling_wave.measure(
        module.solve_harmonic(beam, forces(u), u.rate(971.0), *size), tuple(u.length(np.array([0.21, 0.43])))
    )
    yield u.length, [found.waves.forward, found.waves.backward]
    yield u.none, [found.envelope, found.travelling_index, found.waves.residual]
    device = travelling_wave.matched_device(beam, u.rate(971.0), u.length(0.799))
    yield u.dashpot, device.dashpot
    taken = travelling_wave.field_with_devices(
        lambda *one: module.solve_harmonic(*one, *size), beam, forces(u), u.rate(971.0), [device]
    )
    yield u.length, taken.deflection(u.length(X))


def loads(u, model):
    module, size = MODELS[model]
    for supports in (("clamped", "free"), ("pinned", "pinned")):
        beam = laden(u, tension=0.0, loss_factor=0.0, supports=supports)
        yield u.force, module.buckling_load(beam, *size)


def let_go(u, model):
    size = {"modes": 30} if model == "analytic" else {"count": 23}
    beam = laden(u, supports=("clamped", "free"))
    if model == "analytic":  # which takes neither springs nor a pull in time
        beam = replace(beam, spring=(), tension=0.0, foundation=0.0)
    shape = u.length(np.array([0.0, 0.110005, 0.61, 0.83])), u.length(np.array([0.0, 0.003, 0.01, 0.007]))
    found = free_vibration(
        beam,
        shape,
        u.time(0.3),
        velocity=lambda x: u.speed((x / u.length(0.83)) ** 2),
        model=model,
        at=u.length(X),
        **size,
    )
    yield u.length, found.deflection
    yield u.energy, [found.kinetic, found.elastic]


def carried(u, model, start="rest", **more):
    size = {"modes": 40} if model == "analytic" and start == "rest" else {} if model == "analytic" else {"count": 31}
    more = (grip(u) if "law" not in more else {}) | more
    asked = {"model": model, "start": start, "modal_damping": 0.02, "at": u.length(X), **size}
    found = simulate(strip(u), forces(u, 40.0), u.rate(433.0), u.time(0.02), slider=slider(u, **more), **asked)
    yield u.length, found.deflection
    yield u.length, found.travelled
    yield u.speed, found.speed
    if found.ledger is not None:
        yield u.energy, [found.ledger.rubbed, found.ledger.work_in, found.ledger.residual]


def bent(u):
    beam = strip(u, supports=("clamped", "free"))
    found = bend(beam, 17, u.force(np.array([-30.0, 60.0])), moment=u.energy(4.0))
    yield u.length, found.joints
    yield u.energy, found.energy


def chains(u):
    beam = strip(u)
    system = build_system(beam, 12, forces(u, 90.0), u.rate(433.0), axial_inertia=True)
    times = u.time(np.linspace(0.0, 4e-3, 9))
    for found in (
        simulate_chain(system, at_rest(system), times),
        simulate_chain(system, at_rest(system), times, method="rk4", step=u.time(2e-7)),
        simulate_modal(modal_basis(system), at_rest(system), times, step=u.time(2e-6)),
        simulate_elastic(system, axial_stiffness(beam, 12), times, step=u.time(2e-7)),
    ):
        yield u.length, found.deflection(u.length(X))


def ridden(u):
    given = slider(u, coupling="one-way", **grip(u))
    found = ride_from_rest(strip(u), forces(u, 40.0), u.rate(433.0), given, 12, u.time(0.004), step=u.time(2e-5))
    yield u.length, found.travelled
    yield u.speed, found.speed


def motors(u, contact, model="segment"):
    on = {"contact": contact(u), "pull": u.force(-0.02)}
    if contact is hard:
        on |= grip(u) | {"coupling": "one-way"}
    else:
        feet = Foot(length=u.length(0.03), points=3), Foot(length=u.length(0.01), points=2, offset=u.length(0.05))
        on |= {"foot": feet, "preload_stiffness": u.spring(3.0), "law": "coulomb"}
    given = slider(u, **on)
    size = {"modes": 40} if model == "analytic" else {"count": 31}
    asked = {"modal_damping": 0.02, "at": u.length(X), "model": model} | size
    found = run_motor(strip(u), forces(u, 40.0), u.rate(433.0), u.time(0.01), slider=given, **asked)
    yield u.length, found.deflection
    yield u.length, found.height
    yield u.force, found.normal_force


def soft(u):
    return Contact(stiffness=u.spring(2e5), damping=u.dashpot(3.0), tangential_stiffness=u.spring(7e4))


def layered(u):
    return Contact(layer_stiffness=u.pressure(4e6), layer_tangential_stiffness=u.pressure(1e6))


def hard(u):
    return Contact(restitution=0.3)


CASES = {
    **{f"modes {m} {t}": (modes, m, t) for m in MODELS for t in ("euler-bernoulli",)},
    **{f"modes {m} timoshenko": (modes, m, "timoshenko", sheared) for m in MODELS},
    **{f"fields {m} {b.__name__}": (fields, m, b) for m in MODELS for b in (laden, sheared)},
    **{f"waves {m}": (waves, m) for m in MODELS},
    **{f"buckling {m}": (loads, m) for m in MODELS},
    **{f"let go {m}": (let_go, m) for m in MODELS},
    **{f"carried {m}": (carried, m) for m in MODELS},
    "carried softly": (lambda u, m: carried(u, m, coupling="two-way"), "fem"),
    "carried by coulomb": (lambda u, m: carried(u, m, law="coulomb", coupling="one-way"), "segment"),
    "carried along the surface": (lambda u, m: carried(u, m, kinematics="following", coupling="one-way"), "segment"),
    "carried steadily": (lambda u, m: carried(u, m, "steady", coupling="one-way"), "analytic"),
    "bent": (bent,),
    "chains": (chains,),
    "ridden": (ridden,),
    "motor on springs": (motors, soft),
    "motor that hops": (motors, hard),
    "motor on a layer": (motors, layered, "analytic"),
}
