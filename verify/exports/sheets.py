"""Sheets of a scene: its modes, its steady field, its motion in time, by any of the models."""

import msgspec
import numpy as np

from verify.checks import check_whole
from verify.errors import InputError
from verify.exports.sheet import Sheet, across, cells_of
from verify.judge.workbench import Workbench, no_such_mode
from verify.models.arrays import Array
from verify.models.catalogue import MODELS, check_count
from verify.models.modes import Modes
from verify.motion.request import STEPS_PER_PERIOD
from verify.options import READINGS
from verify.patience import check_work
from verify.quantities.motion_arguments import InTime, SliderInTime
from verify.quantities.simulated import motion_case, slider_of, steps_per_period
from verify.scenes.scene import Scene

SEGMENTS = "segment"
COUNT = 49
"""Segments and elements where nobody says."""
MODES = 10
"""Where nobody says."""
FINE = 200
"""Parts between which the exact beam is read, at least, and PER_MODE for every mode."""
PER_MODE = 20
PLAIN_S, OTHER_S = 1.6e-5, 6e-5
"""Seconds over the square of a number of exact modes, of which each is read at places in proportion to it: of a plain
beam, and of one without closed form. Measured: 9.5 s and 2.5 GB of 800 plain ones."""
INSTANTS, MOST = 36, 100_000
"""Of a period; and at most."""
SAMPLES = 101
"""Of a motion."""


class Wanted(msgspec.Struct, frozen=True, kw_only=True):
    """What of a scene, by which model."""

    model: str = SEGMENTS
    count: int | None = None
    """Segments or elements; the scene's own unless given."""
    modes: int | None = None
    """How many, from the first."""
    samples: int | None = None
    """Instants of a motion or of a period."""
    reading: str | None = None
    """Of a chain's joints: corrected unless given."""


def described(model: str, count: int | None) -> str:
    """'49 segments'; a model without parts by its title."""
    return f"{count} {MODELS[model].parts}" if count is not None else "the exact beam"


def count_of(scene: Scene, wanted: Wanted, sections: tuple[str, ...]) -> int | None:
    """Parts of the model: as wanted, else as the first of these sections of the scene says. Raises InputError."""
    if wanted.count is not None:
        check_whole("count", wanted.count, 1)
        check_count(wanted.model, wanted.count)
        return wanted.count
    if not MODELS.named(wanted.model).sized:
        return None
    return next((its.count for name in sections if (its := getattr(scene, name, None)) is not None), COUNT)


def places_of(scene: Scene, count: int | None, model: str, n_modes: int = 0) -> Array:
    """Where a model is read, (n,), metres: at its own nodes, the exact beam evenly. Raises InputError."""
    if count is None:
        return np.linspace(0.0, scene.beam.length, max(FINE, PER_MODE * n_modes) + 1)
    return np.asarray(Workbench(scene.beam).modes(model, count, 1).nodes)


def modes_sheet(scene: Scene, wanted: Wanted) -> Sheet:
    """Mass-normalised shapes, a vector each in 1/sqrt(kg), frequencies beside. Raises InputError."""
    scene.refuse_devices("a sheet of modes")
    count = count_of(scene, wanted, ("spectrum",))
    modes = solved_modes(scene, wanted.model, count, _n_modes(scene, wanted, count))
    x, shapes, read = _read(modes, wanted)
    vectors = across(shapes)
    digits = len(str(modes.n_modes))
    names = [f"mode_{n:0{digits}d}" for n in range(1, modes.n_modes + 1)]
    return Sheet(
        what="modes",
        told=f"modes 1 to {modes.n_modes} of {described(wanted.model, count)}{read}",
        x=x,
        cells=cells_of(scene.beam, x),
        at_points=dict(zip(names, vectors, strict=True)),
        beside={"frequency_hz": np.asarray(modes.frequencies_hz)},
        steps=np.asarray(modes.frequencies_hz),
        step_name="frequency_hz",
        stepped={"mode": vectors},
        histories={},
    )


def solved_modes(scene: Scene, model: str, count: int | None, n_modes: int) -> Modes:
    """Modes of a model of parts, or of the exact beam. Raises InputError."""
    if count is None:
        return MODELS[model].solve_modes(scene.beam, n_modes, None)  # type: ignore[arg-type]
    return Workbench(scene.beam).modes(model, count, n_modes)


def _n_modes(scene: Scene, wanted: Wanted, count: int | None) -> int:
    """How many: as wanted, else as the scene asks elsewhere, as far as there are so many. Raises InputError."""
    model = MODELS[wanted.model]
    most = model.n_elastic(scene.beam, count) if count is not None else None
    if wanted.modes is not None:
        check_whole("modes", wanted.modes, 1)
        if most is not None and wanted.modes > most:
            raise InputError(no_such_mode(wanted.modes, wanted.model, count or 0, most))
        if most is None:
            each = PLAIN_S if scene.beam.uniform else OTHER_S
            check_work("modes", wanted.modes, each * float(min(wanted.modes, 10**9)) ** 2, "export fewer")
        return wanted.modes
    spectrum, convergence = getattr(scene, "spectrum", None), getattr(scene, "convergence", None)
    asked = spectrum.modes if spectrum else max(convergence.modes) if convergence else MODES
    return min(asked, most or asked)


def _read(modes: Modes, wanted: Wanted) -> tuple[Array, Array, str]:
    """(x, shapes there (n_modes, len(x)), which reading in words). Raises InputError for one that there is not."""
    if wanted.reading is None:
        x = modes.nodes if modes.count is not None else np.linspace(0.0, modes.length, _fine(modes.n_modes))
        return x, modes.deflection(x), ""
    if wanted.reading not in modes.readings:
        known = ", ".join(name for name in READINGS if name in modes.readings) or "none"
        raise InputError(f"reading = {wanted.reading!r} is none of the {modes.model} model's: known {known}")
    return modes.nodes, modes.readings[wanted.reading](), f", read {wanted.reading}"


def _fine(n_modes: int) -> int:
    return max(FINE, PER_MODE * n_modes) + 1


def field_sheet(scene: Scene, wanted: Wanted) -> Sheet:
    """The steady answer to the scene's drive, metres and radians, and a period of it. Raises InputError."""
    from verify.waves.case import DrivenCase
    from verify.waves.driven import driven

    if scene.drive is None or not scene.forces:
        raise InputError("what = 'field': the scene has no drive with forces, add [drive] or ask for modes")
    count = count_of(scene, wanted, ("wave",))
    case = DrivenCase(
        beam=scene.beam,
        model=wanted.model,
        count=count,
        forces=scene.forces,
        frequency_hz=scene.drive.frequency_hz,
        kind=scene.drive.kind,
        devices=scene.devices,
    )
    field = driven(case, Workbench(scene.beam))
    x = places_of(scene, count, wanted.model)
    w, slope = field.deflection(x), field.slope(x)
    k = _instants(wanted, INSTANTS)
    phases = 2.0 * np.pi * np.arange(k) / k
    swept = np.real(w[None, :] * np.exp(1j * phases)[:, None])
    return Sheet(
        what="field",
        told=f"the steady field of {described(wanted.model, count)} at {scene.drive.frequency_hz:g} Hz",
        x=x,
        cells=cells_of(scene.beam, x),
        at_points={
            "real": across(w.real),
            "imaginary": across(w.imag),
            "amplitude": np.abs(w),
            "phase_deg": np.rad2deg(np.angle(w)),
            "slope_real": np.asarray(slope.real),
            "slope_imaginary": np.asarray(slope.imag),
        },
        beside={"frequency_hz": np.array([scene.drive.frequency_hz])},
        steps=phases / field.omega,
        step_name="time_s",
        stepped={"deflection": across(swept)},
        histories={},
    )


def motion_sheet(scene: Scene, wanted: Wanted) -> Sheet:
    """The scene's beam in time as its [motion] asks, with its slider where it has one. Raises InputError."""
    if scene.motion is None:
        raise InputError("what = 'motion': the scene has no [motion], add it or --set motion.duration=1e-3")
    count = count_of(scene, wanted, ("motion",))
    x = places_of(scene, count, wanted.model)
    slider = slider_of(SliderInTime(model=wanted.model, count=count), scene) if scene.slider else None
    found = motion_case(InTime(model=wanted.model, count=count), scene).run(
        slider=slider,
        at=x.tolist(),
        samples=_instants(wanted, SAMPLES),
        steps_per_period=steps_per_period(scene) if slider else STEPS_PER_PERIOD,
        patient=False,
    )
    if found.statistics.interrupted:
        raise KeyboardInterrupt
    named = ("position", "speed", "friction", "surface_speed", "normal_force")
    on_it = {f"slider_{name}": np.asarray(getattr(found, name)) for name in named} if slider else {}
    short = "" if found.statistics.finished else f", up to where it {found.statistics.stopped}"
    return Sheet(
        what="motion",
        told=f"{len(found.times)} instants of {described(wanted.model, count)}"
        f"{' with the slider' if slider else ''}, 0 to {found.times[-1]:g} s{short}",
        x=x,
        cells=cells_of(scene.beam, x),
        at_points={},
        beside={"frequency_hz": np.array([scene.drive.frequency_hz])} if scene.drive else {},
        steps=found.times,
        step_name="time_s",
        stepped={"deflection": across(found.deflection)},
        histories=on_it,
    )


def _instants(wanted: Wanted, default: int) -> int:
    """Raise InputError for fewer than two or more than MOST."""
    if wanted.samples is None:
        return default
    check_whole("samples", wanted.samples, 2)
    if wanted.samples > MOST:
        raise InputError(f"samples = {wanted.samples}: give at most {MOST}")
    return wanted.samples
