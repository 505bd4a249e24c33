"""Figures of some forty unsymmetric beams and scenes, by the public verbs: what the rebuilding must not move.

`python -m tests.golden.figures FILE` writes them as JSON. The file `golden.json` beside this one was written at commit
03331bca, before anything was rebuilt, and is never written again; both are deleted when the rebuilding ends.
"""

import json
import sys
from collections.abc import Iterator
from contextlib import suppress
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify import (
    Beam,
    Contact,
    Device,
    ExactModel,
    Foot,
    HermiteModel,
    InputError,
    PointForce,
    PointMass,
    PointSpring,
    Section,
    SegmentModel,
    Slider,
    bend,
    free_vibration,
    simulate,
    travelling_wave,
)
from verify.chain.slider_on_chain import slide_on_chain

STRIP = Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
ENDS = ("pinned", "clamped", "free", "guided")
STEPS = (
    Section(length=0.31, thickness=0.0023),
    Section(length=0.17, thickness=0.0035, width=0.027),
    Section(length=0.25, thickness=0.0029, youngs_modulus=71e9, density=2710.0),
)


def beams() -> dict[str, Beam]:
    """Every pair of ends but free motions without stiffness, steps, bodies, springs, axial force, ground, losses."""
    made = {f"{left}-{right}": replace(STRIP, supports=(left, right)) for left in ENDS for right in ENDS}
    held = replace(STRIP, supports=("clamped", "pinned"))
    arm = replace(STRIP, supports=("clamped", "free"))
    mass = (PointMass(position=0.47, mass=0.041, rotary_inertia=3.1e-5), PointMass(position=0.66, mass=0.012))
    spring = (PointSpring(position=0.29, stiffness=810.0), PointSpring(position=0.61, stiffness=95.0, rotational=0.7))
    return made | {
        "stepped": replace(held, section=STEPS),
        "stepped-arm": replace(arm, section=STEPS),
        "bodies": replace(arm, mass=mass),
        "springs": replace(held, spring=spring),
        "bodies-springs-steps": replace(arm, mass=mass, spring=spring, section=STEPS),
        "tip-body": replace(arm, mass=(PointMass(position=0.73, mass=0.09, rotary_inertia=2.3e-4),)),
        "taut": replace(held, tension=140.0),
        "compressed": replace(held, tension=-19.0),
        "ground": replace(held, foundation=5.1e3),
        "ground-free": replace(STRIP, supports=("free", "free"), foundation=37.0),
        "taut-bodies": replace(held, tension=61.0, mass=mass),
        "losses": replace(STRIP, loss_factor=0.013),
        "tube": Beam(
            length=1.37, shape="tube", diameter=0.031, wall_thickness=0.0027, youngs_modulus=71e9, density=2710.0,
            supports=("clamped", "guided"),
        ),
        "thick": Beam(
            length=0.41, width=0.03, thickness=0.037, youngs_modulus=206e9, density=7850.0, poissons_ratio=0.29
        ),
        "paper": Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0),
    }  # fmt: skip


FORCES = (
    PointForce(position=0.017, amplitude=1.3, phase_deg=11.0),
    PointForce(position=0.697, amplitude=0.8, phase_deg=97.0),
)
DRIVEN_HZ = 613.0
SIZED: dict[str, Any] = {"segment": SegmentModel, "fem": HermiteModel}


def modes_of(beam: Beam, sized: dict[str, int]) -> Iterator[tuple[str, Any]]:
    """Frequencies, shapes, slopes and curvatures by three models."""
    x = np.array([0.037, 0.283, 0.611]) * beam.length
    exact = ExactModel(beam).modes(7)
    yield "analytic/frequency", exact.frequencies_hz
    yield "analytic/shape", exact.shapes(x, 0)[[0, 4]]
    yield "analytic/curvature", exact.shapes(x, 2)[[1, 6]]
    for name, n in sized.items():
        found = SIZED[name](beam, n).modes(9)
        yield f"{name}/frequency", found.frequencies_hz
        yield f"{name}/shape", found.deflection(x)[[0, 4]]
        yield f"{name}/slope", found.slope(x)[[1, 6]]


def settings_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    """Walls, joints, theories, attachments, gradings; what a beam does not take is left out."""
    options: list[dict[str, Any]] = [{"wall": wall} for wall in ("half", "welded", "third-order", "five-joint")]
    options += [{"joints": "printed"}, {"joints": "tensioned"}, {"attachment": "lever"}, {"grading": 1.7}]
    for option in options:
        with suppress(InputError):
            label = "-".join(map(str, *option.items()))
            yield label, SegmentModel(beam, 23, **option).modes(5).frequencies_hz
    yield "fem-grading", HermiteModel(beam, 23, grading=1.7).modes(5).frequencies_hz


def theories_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    for theory in ("rayleigh", "timoshenko"):
        yield f"analytic/{theory}", ExactModel(beam, theory).modes(5).frequencies_hz
        for name, model in SIZED.items():
            yield f"{name}/{theory}", model(beam, 23, theory=theory).modes(5).frequencies_hz


def fields_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    """Harmonic fields, waves in the middle half, unit responses, buckling."""
    x = np.array([0.13, 0.37, 0.58, 0.81]) * beam.length
    forces = [replace(one, position=one.position * beam.length / 0.73) for one in FORCES]
    fields = {
        "analytic": ExactModel(beam).harmonic(forces, DRIVEN_HZ),
        "segment": SegmentModel(beam, 61).harmonic(forces, DRIVEN_HZ),
        "fem": HermiteModel(beam, 53).harmonic(forces, DRIVEN_HZ),
    }
    for name, field in fields.items():
        yield f"{name}/deflection", field.deflection(x)
        yield f"{name}/slope", field.slope(x)
    yield "fem/damped", HermiteModel(beam, 53).harmonic(forces, DRIVEN_HZ, modal_damping=0.021).deflection(x)
    yield "segment/damped", SegmentModel(beam, 61).harmonic(forces, DRIVEN_HZ, modal_damping=0.021).deflection(x)
    at = [0.21 * beam.length, 0.77 * beam.length]
    yield "analytic/unit", ExactModel(beam).receptance(at, [211.0, 613.0], x)
    yield "segment/unit", SegmentModel(beam, 61).receptance(at, [211.0, 613.0], x)
    yield "fem/unit", HermiteModel(beam, 53).receptance(at, [211.0, 613.0], x)
    yield "sweep", HermiteModel(beam, 53).harmonic(forces, [97.0, 613.0]).deflection(x)


def waves_of(beam: Beam, frequency_hz: float) -> Iterator[tuple[str, Any]]:
    """Measures of the wave in the middle half by three models, with a device as well."""
    forces = [replace(one, position=one.position * beam.length / 0.73) for one in FORCES]
    fields = {
        "analytic": ExactModel(beam).harmonic(forces, frequency_hz),
        "segment": SegmentModel(beam, 97).harmonic(forces, frequency_hz),
        "fem": HermiteModel(beam, 97).harmonic(forces, frequency_hz),
    }
    device = Device(position=0.9 * beam.length, dashpot=2.3, stiffness=310.0, mass=1.7e-3)
    fields["analytic-device"] = ExactModel(beam).harmonic(forces, frequency_hz, devices=device)
    for name, field in fields.items():
        found = travelling_wave.measure(field, travelling_wave.middle_half(beam))
        yield (
            f"{name}/measures",
            [
                found.reflection, found.standing_wave_ratio, found.envelope, found.travelling_index,
                found.mean_axis_ratio, found.ideal_axis_ratio, found.crest_speed, found.energy_flux,
            ],
        )  # fmt: skip
        yield f"{name}/amplitudes", [found.waves.forward, found.waves.backward]
        yield f"{name}/area", found.s3_range


def buckling_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    yield "analytic", ExactModel(beam).buckling_load()
    yield "segment", SegmentModel(beam, 37).buckling_load()
    yield "fem", HermiteModel(beam, 31).buckling_load()


def motions_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    """A beam in time, let go, and with sliders of several laws."""
    forces = [replace(one, position=one.position * beam.length / 0.73) for one in FORCES]
    at = [0.31 * beam.length, 0.77 * beam.length]
    for model, count in (("segment", 31), ("fem", 29), ("analytic", None)):
        run = simulate(
            beam, forces, DRIVEN_HZ, 4e-3, model=model, count=count, at=at, samples=9, soft_start_periods=1.5
        )
        yield f"{model}/driven", run.deflection[1:]
    free = free_vibration(beam, 2, 9e-3, amplitude=1.1e-4, model="fem", count=29, at=at, samples=7, modal_damping=0.017)
    yield "fem/released", free.deflection
    sliders = {
        "tanh-massless": Slider(mass=2.3e-3, mu=0.31, normal="massless", coupling="two-way", position=0.27),
        "tanh-held": Slider(mass=2.3e-3, mu=0.31, preload=0.7, coupling="two-way", speed=0.013),
        "one-way": Slider(mass=2.3e-3, mu=0.31, slope=700.0, coupling="one-way"),
        "following": Slider(mass=2.3e-3, mu=0.31, coupling="one-way", kinematics="following"),
        "coulomb": Slider(mass=2.3e-3, mu=0.31, law="coulomb", mu_static=0.37, coupling="one-way", speed=0.004),
        "coulomb-two-way": Slider(mass=2.3e-3, mu=0.31, law="coulomb", coupling="two-way"),
    }
    for name, slider in sliders.items():
        for start in ("rest", "steady"):
            run = simulate(
                beam, forces, DRIVEN_HZ, 3e-3, model="segment", count=31, slider=slider, start=start,
                soft_start_periods=1.5 if start == "rest" else 0.0, steps_per_period=96, step=1e-3 / DRIVEN_HZ * 10,
                samples=7,
            )  # fmt: skip
            yield f"{name}/{start}", [run.travelled[1:], run.speed[1:], run.friction[1:]]


def motors_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    """Sliders that may leave the beam: springs, a layer, hard contact, several points, a held speed, a chain."""
    forces = [replace(one, position=one.position * beam.length / 0.73, amplitude=0.5) for one in FORCES]
    springs = Contact(stiffness=1.1e6, damping=17.0)
    give = Contact(stiffness=1.1e6, damping=17.0, tangential_stiffness=4.3e5)
    layer = Contact(layer_stiffness=2.3e7, damping=11.0, layer_tangential_stiffness=9e6)
    body = {"mass": 0.021, "mu": 0.23, "preload": 1.7}
    sliders = {
        "springs": Slider(**body, contact=springs, law="coulomb", coupling="one-way"),
        "give": Slider(**body, contact=give, law="coulomb", coupling="one-way", foot=(Foot(length=0.03, points=5),)),
        "two-way": Slider(**body, contact=springs, coupling="two-way", foot=(Foot(length=0.03, points=5),)),
        "layer": Slider(**body, contact=layer, law="coulomb", coupling="one-way", foot=(Foot(length=0.03, points=7),)),
        "hard": Slider(**body, contact=Contact(restitution=0.3), coupling="one-way"),
    }
    for name, slider in sliders.items():
        run = simulate(beam, forces, DRIVEN_HZ, 3e-3, slider=slider, model="fem", count=23, samples=7)
        yield name, [run.travelled[1:], run.speed[1:], run.friction[1:], run.normal_force[1:]]
    held = simulate(
        beam, forces, DRIVEN_HZ, 3e-3, slider=sliders["give"], model="fem", count=23, prescribed_speed=0.011
    )
    yield "held-speed", [held.friction[1::40], held.normal_force[1::40]]
    plain = replace(beam, loss_factor=0.0)
    chain = slide_on_chain(plain, forces, DRIVEN_HZ, 3e-3, slider=sliders["springs"], count=19, samples=5)
    yield "chain", [chain.travelled[1:], chain.normal_force[1:]]


def chains_of(beam: Beam) -> Iterator[tuple[str, Any]]:
    """The nonlinear chain: statics, large amplitudes, driven, carrying a slider."""
    arm = replace(beam, supports=("clamped", "free"), loss_factor=0.0)
    for load in (1.3, 17.0):
        bent = bend(arm, 23, load=load, moment=0.11)
        yield f"bend-{load:g}", [bent.tip[0], bent.tip[1], bent.turn, bent.energy]
    for wall in ("half", "third-order"):
        bent = bend(arm, 17, load=(3.1, 7.9), wall=wall)
        yield f"bend-{wall}", [bent.tip[0], bent.tip[1], bent.turn, bent.energy]


def figures() -> dict[str, list[float]]:
    """All of them by name, each a flat list; complex numbers as real and imaginary part."""
    made = beams()
    found: dict[str, Any] = {}

    def take(prefix: str, each: Iterator[tuple[str, Any]]) -> None:
        for name, value in each:
            found[f"{prefix}/{name}"] = value

    for name, beam in made.items():
        take(f"modes/{name}", modes_of(beam, {"segment": 31, "fem": 27}))
    for name in ("clamped-pinned", "clamped-free", "stepped", "bodies", "taut"):
        take(f"settings/{name}", settings_of(made[name]))
    for name in ("thick", "pinned-clamped", "clamped-free", "free-free", "stepped-arm"):
        take(f"theories/{name}", theories_of(made[name]))
    for name in ("pinned-pinned", "clamped-free", "guided-pinned", "stepped", "bodies-springs-steps", "taut", "ground",
                 "losses", "tube"):  # fmt: skip
        take(f"fields/{name}", fields_of(made[name]))
    for name, hertz in (("pinned-pinned", 1901.0), ("losses", 1333.0), ("clamped-free", 2503.0), ("paper", 4276.0)):
        take(f"waves/{name}", waves_of(made[name], hertz))
    for name in ("pinned-pinned", "clamped-free", "clamped-clamped", "stepped", "springs", "ground"):
        take(f"buckling/{name}", buckling_of(made[name]))
    for name in ("pinned-pinned", "losses", "clamped-pinned"):
        take(f"motion/{name}", motions_of(made[name]))
    for name in ("pinned-pinned", "losses"):
        take(f"motor/{name}", motors_of(made[name]))
    take("chain", chains_of(STRIP))
    return {name: flat(value) for name, value in found.items()}


def flat(value: Any) -> list[float]:
    """A value as a flat list of floats."""
    array = np.asarray(value).ravel()
    return [float(part) for one in array for part in ((one.real, one.imag) if np.iscomplexobj(array) else (one,))]


if __name__ == "__main__":
    with open(sys.argv[1], "w", encoding="utf-8") as file:
        json.dump(figures(), file, indent=0)
