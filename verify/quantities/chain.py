"""Named figures of the nonlinear chain."""

from typing import TYPE_CHECKING, Any

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import beforehand, compiled
from verify.quantities.chain_arguments import (
    ContactLine,
    Departing,
    FreeMotion,
    FromRest,
    Hanging,
    LargeAmplitude,
    Ridden,
    RolledUp,
    TipUnderLoad,
    Turning,
)
from verify.quantities.kind import Quantity

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.chain.ride import ChainRide
    from verify.scenes.scene import Scene


def _cantilever_tip(a: TipUnderLoad, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return float(getattr(chain_studies.cantilever_tip(a.load, a.links, a.wall), a.component))


def _rollup_gap(a: RolledUp, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.rollup_gap(a.links, a.wall)


def _hanging_frequency(a: Hanging, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.hanging_frequency(a.mode, a.links)


def _turning_frequency(a: Turning, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.turning_frequency(a.mode, a.links, a.speed, a.wall)


def _large_amplitude_frequency(a: LargeAmplitude, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.large_amplitude_frequency(scene.beam, a.amplitude, a.links, bench.tell)


def _energy_drift(a: FreeMotion, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.energy_drift(
        scene.beam, a.links, a.amplitude, a.periods, a.step, a.tolerance or 1e-8, bench.tell
    )


def _transient_deflection(a: FromRest, scene: "Scene", bench: Workbench) -> float:
    from msgspec.structs import replace

    from verify.chain import problems as chain_studies
    from verify.chain.from_rest import point_forces

    forces = point_forces(scene, "chain.transient_deflection")
    assert scene.drive is not None
    if a.x > scene.beam.length:
        raise InputError(f"x = {a.x!r} lies off the chain: give up to {scene.beam.length!r} m")
    if a.force is not None:
        forces = tuple(replace(force, amplitude=a.force) for force in forces)
    method = a.method or ("rk4" if a.step is not None else "adaptive")
    motion = chain_studies.transient(
        scene.beam,
        forces,
        scene.drive.frequency_hz,
        [a.time],
        a.links,
        step=a.step,
        method=method,
        axial_inertia=a.inertia == "full",
        tolerance=a.tolerance,
        progress=bench.tell,
    )
    bench.n_unkept_motions += 1
    return float(motion.deflection([a.x])[0, 0])


def _axial_departure(a: Departing, scene: "Scene", bench: Workbench) -> float:
    from verify.chain.departure import departure, driven_chain

    driven = driven_chain(scene, "chain.axial_departure", a.links, a.time, a.x)
    found = departure(driven, a.force, a.inertia, bench.tell)
    return found.at_end if a.of == "end" else found.rms


def _contact_line_error(a: ContactLine, scene: "Scene", bench: Workbench) -> float:
    from verify.chain.problems import contact_line_error

    if a.x > scene.beam.length:
        raise InputError(f"x = {a.x!r} lies off the chain: give up to {scene.beam.length!r} m")
    return contact_line_error(scene.beam, a.mode, a.links, a.x, wall=a.wall, grading=a.grading)


def _ridden(figure: "Callable[[ChainRide], float]") -> "Callable[[Ridden, Scene, Workbench], float]":
    """One figure of the slider's run on the chain."""

    def evaluate(a: Ridden, scene: "Scene", bench: Workbench) -> float:
        return figure(_ride(a, scene, bench))

    return evaluate


def _ride(a: Ridden, scene: "Scene", bench: Workbench) -> "ChainRide":
    from msgspec.structs import replace

    from verify.chain.from_rest import point_forces
    from verify.chain.ride import ride_from_rest
    from verify.motion.request import STEPS_PER_PERIOD
    from verify.quantities.simulated import slider_of

    motion, slider = scene.motion, slider_of(a, scene)
    if motion is not None and a.soft_start_periods is not None:
        motion = replace(motion, soft_start_periods=a.soft_start_periods)
    forces = point_forces(replace(scene, motion=motion), "a slider on the nonlinear chain")
    assert scene.drive is not None
    time = beforehand.ride_time(a, scene)
    steps = motion.steps_per_period if motion else STEPS_PER_PERIOD
    found = ride_from_rest(
        scene.beam,
        [replace(force, amplitude=a.force) for force in forces] if a.force is not None else forces,
        scene.drive.frequency_hz,
        slider,
        a.segments,
        time,
        step=a.step or 1.0 / (steps * scene.drive.frequency_hz),
        links=a.links,
        progress=bench.tell,
    )
    bench.n_unkept_motions += 1
    return found


def _imbalance(run: "ChainRide") -> float:
    """What the slider's books miss over what friction rubs away."""
    assert run.ledger is not None
    return abs(run.ledger.residual) / run.ledger.rubbed


BALANCED = 0.01
"""Of what friction rubs away: books that miss more are of forces that turn round within a step."""


def _largest_friction(run: "ChainRide") -> float:
    """Raises InputError for one below the law's limit of a run whose books do not close."""
    slider = run.slider
    assert slider is not None
    saturated = run.largest_friction >= (1.0 - 1e-9) * slider.mu * slider.normal_force
    if not saturated and (missing := _imbalance(run)) > BALANCED:
        raise InputError(
            f"step = {run.statistics.step_s:.3g} s: the slider's books miss {100.0 * missing:.2g} % of what is rubbed "
            "away, so that its largest friction is not known; give a shorter step"
        )
    return run.largest_friction


CHAIN_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "chain.cantilever_tip",
        "1",
        "Tip of a cantilever under a dead transverse force: w/L or 1 - x/L.",
        TipUnderLoad,
        "equilibrium",
        _cantilever_tip,
    ),
    Quantity(
        "chain.rollup_gap",
        "1",
        "Distance of the ends over L under an end moment 2 pi EI/L.",
        RolledUp,
        "equilibrium",
        _rollup_gap,
    ),
    Quantity(
        "chain.hanging_frequency",
        "1",
        "Omega sqrt(L/g) of a hanging chain of uniform links.",
        Hanging,
        "equilibrium",
        _hanging_frequency,
    ),
    Quantity(
        "chain.turning_frequency",
        "1",
        "Omega sqrt(rho A L^4/EI), lead-lag, of a cantilever whose clamp turns.",
        Turning,
        "equilibrium",
        _turning_frequency,
    ),
    Quantity(
        "chain.large_amplitude_frequency",
        "1",
        "First frequency between immovable hinges over the linear one.",
        LargeAmplitude,
        "in time",
        _large_amplitude_frequency,
        needs=beforehand.buildable,
        kernels=compiled.stepped,
    ),
    Quantity(
        "chain.energy_drift",
        "1",
        "Largest change of energy of an undamped chain over its energy.",
        FreeMotion,
        "in time",
        _energy_drift,
        needs=beforehand.buildable,
        kernels=compiled.stepped,
    ),
    Quantity(
        "chain.transient_deflection",
        "m",
        "Deflection of the chain from rest under the scene's forces.",
        FromRest,
        "in time",
        _transient_deflection,
        needs=beforehand.pushable,
        kernels=compiled.transient,
    ),
    Quantity(
        "chain.axial_departure",
        "1",
        "Nonlinear chain less the linear one, from rest, over the linear one's rms.",
        Departing,
        "in time",
        _axial_departure,
        needs=beforehand.buildable,
        kernels=compiled.departing,
    ),
    Quantity(
        "chain.contact_line_error",
        "1",
        "Slope of the contact line on the chain in a mode less the beam's, over the largest slope.",
        ContactLine,
        "equilibrium",
        _contact_line_error,
        needs=beforehand.buildable,
    ),
    *(
        Quantity(
            f"chain.slider_{name}",
            unit,
            summary,
            Ridden,
            "in time",
            _ridden(figure),
            needs=beforehand.rideable,
            kernels=compiled.ridden,
        )
        for name, unit, summary, figure in (
            (
                "displacement",
                "m",
                "Of the scene's slider along +x on the nonlinear chain.",
                lambda run: run.displacement,
            ),
            ("mean_speed", "m/s", "Displacement over time.", lambda run: run.mean_speed),
            ("largest_friction", "N", "Largest friction force on it.", _largest_friction),
            ("imbalance", "1", "What the slider's energy ledger misses, over what friction rubs away.", _imbalance),
        )
    ),
)
