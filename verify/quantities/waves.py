"""Quantities of the driven beam in its steady state: field, wave, best drive, absorbing devices, voltages, power."""

from math import pi
from typing import Annotated, Literal

from msgspec import Meta
from msgspec.structs import replace

from verify import settings, travelling_wave
from verify.actuators.on_beam import ActuatorState
from verify.actuators.patch import Patch
from verify.analysis.comparison import asymptotic_order, relative_error
from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.errors import InputError
from verify.linear.registry import EXACT, MODELS
from verify.problem.device import of_impedance
from verify.quantities import options as opt
from verify.quantities.base import Place, Scene, figures, quantity
from verify.travelling_wave import WaveMeasures, measure
from verify.validation import Relative, check_sizes
from verify.waves import operating_point, two_modes
from verify.waves.best_drive import BestDrive, best_drive
from verify.waves.driven_case import DrivenCase, driven
from verify.waves.impedance_matching import Ending, ending
from verify.waves.window import middle_half

Number = Annotated[int, Meta(ge=1, description="number of the actuator in drive.force, then in drive.shunt, from 1")]
Window = Annotated[tuple[float, float], Meta(description="start and end, m; default: L/4 to 3L/4")]
DRIVEN = ("beam", "drive")


class FieldSettings(opt.DriveOptions, frozen=True, kw_only=True):
    """Drive, losses and settings of a harmonic field."""

    loss_factor: Annotated[Relative, Meta(description="eta in E (1 + i eta); default: the beam's")] | None = None
    drive: Annotated[settings.DriveKind, Meta(description="kind of drive; default: the scene's")] | None = None
    theory: settings.Theory = settings.DEFAULT.theory
    load: settings.Load = settings.DEFAULT.load
    reading: settings.Reading = settings.DEFAULT.reading
    wall: settings.Wall = settings.DEFAULT.wall
    joints: settings.Joints = settings.DEFAULT.joints
    attachment: settings.Attachment = settings.DEFAULT.attachment


class FieldOptions(FieldSettings, frozen=True, kw_only=True):
    """A model of the driven beam with its losses and settings."""

    model: opt.FieldModel = "analytic"
    count: opt.Size | None = None


class WaveOptions(FieldOptions, frozen=True, kw_only=True):
    """A driven beam and the window in which its wave is measured."""

    window: Window | None = None


class DirectedOptions(WaveOptions, frozen=True, kw_only=True):
    """A driven beam and the wave that its drive shall make."""

    direction: Annotated[Literal["+x", "-x"], Meta(description="direction of the wave")] = "+x"


def driven_case(scene: Scene, options: FieldSettings, model: str = "", count: int | None = None) -> DrivenCase:
    """The driven beam of a scene with these options; `FieldOptions` include the model. Raises InputError."""
    if isinstance(options, FieldOptions):
        model, count = options.model, options.count
    opt.check_count(model, count)
    of_case = (*opt.DriveOptions.__struct_fields__, "loss_factor", "drive", "model", "count", "window", "direction")
    chosen = dict(opt.check_settings(model, opt.not_default(options, without=of_case)))
    beam = scene.beam if options.loss_factor is None else replace(scene.beam, loss_factor=options.loss_factor)
    kind = options.drive or (scene.drive.kind if scene.drive else "force")
    forces, actuator = options.forces(scene), scene.drive.actuator if scene.drive else None
    if isinstance(actuator, Patch) and (scene.shunts or kind in ("voltage", "current")):
        positions = [force.position for force in forces] if kind in ("voltage", "current") else []
        actuator, beam = actuator.bonded(beam), actuator.on(beam, [*positions, *(x for x, _ in scene.shunts)])
    return DrivenCase(
        model=MODELS.named(model).build(beam, count, **chosen),
        forces=forces,
        frequency_hz=opt.drive_frequency(scene, options.frequency_hz),
        kind=kind,
        devices=tuple(scene.devices),
        actuator=actuator,
        shunts=scene.shunts,
    )


def measured(case: DrivenCase, cache: SolutionCache, window: tuple[float, float] | None = None) -> WaveMeasures:
    """The wave of a case in a window (default: middle half) with the model's wavenumber. Raises InputError."""
    field = driven(case, cache)
    return measure(field, window or middle_half(case.beam), case.wavenumber(case.frequency_hz))


@quantity("wave.deflection", unit="m", reads=DRIVEN, devices=True)
def deflection(scene: Scene, cache: SolutionCache, options: FieldOptions, *, x: Place) -> complex:
    """Complex deflection amplitude at x, convention e^{+i omega t}."""
    return complex(driven(driven_case(scene, options), cache).deflection(x)[0])


def wave_in_window(scene: Scene, cache: SolutionCache, options: WaveOptions) -> WaveMeasures:
    """The wave of a scene with these options. Raises InputError."""
    return measured(driven_case(scene, options), cache, options.window)


wave = figures("wave", wave_in_window, reads=DRIVEN, devices=True)
wave("standing_wave_ratio", "1", "Standing-wave ratio (1 + Gamma)/(1 - Gamma) of two waves fitted in the window.")
wave("reflection", "1", "Reflection Gamma: weaker over stronger wave amplitude at the middle of the window.")
wave(
    "travelling_index",
    "1",
    "Feeny's index 1/cond([Re w, Im w]) over whole half wavelengths; (1 - Gamma)/(1 + Gamma) for two waves.",
)
wave("signed_area_spread", "1", "Spread (max - min)/|mean| of the signed area of the surface ellipses in the window.")
wave("crest_speed", "m/s", "Surface velocity along +x at crests of rms amplitude; its sign is against the energy flux.")
wave("energy_flux", "W", "Power transmitted towards +x at the middle of the window by the two fitted waves.")


@quantity("wave.axis_ratio", unit="1", reads=DRIVEN, devices=True)
def axis_ratio(scene: Scene, cache: SolutionCache, options: WaveOptions, *, x: Place | None = None) -> float:
    """Signed axis ratio of the surface ellipse at x, or its mean in the window; negative for a wave towards +x."""
    if x is None:
        return wave_in_window(scene, cache, options).mean_axis_ratio
    if options.window is not None:
        raise InputError(f"window = {list(options.window)} with x = {x!r}: give one of the two")
    return float(travelling_wave.axis_ratio(driven(driven_case(scene, options), cache), x)[0])


wave(
    "power_imbalance",
    "1",
    "Relative residual of the power balance: left force - losses up to the middle of the window - energy flux.",
)


Span = Annotated[Relative, Meta(gt=0, lt=0.5, description="search range relative to the drive's frequency")]


@quantity("wave.best_frequency", unit="Hz", reads=DRIVEN, devices=True)
def best_frequency(scene: Scene, options: WaveOptions, *, span: Span = 0.015) -> float:
    """Drive frequency of least reflection near the scene's drive frequency."""
    return operating_point.best_frequency(driven_case(scene, options), span, options.window)


Ratio = Annotated[float, Meta(gt=1, description="largest standing-wave ratio; default: 1.1 times the least")]


@quantity("wave.frequency_band", unit="Hz", reads=DRIVEN, devices=True)
def frequency_band(scene: Scene, options: WaveOptions, *, limit: Ratio | None = None, span: Span = 0.015) -> Bracket:
    """Tolerance of the drive frequency: the interval around the best one with a standing-wave ratio up to `limit`."""
    return Bracket(*operating_point.frequency_band(driven_case(scene, options), limit, span, options.window))


def pure_drive(scene: Scene, options: DirectedOptions) -> BestDrive:
    """The drive without reflection towards one end. Raises InputError where there is none."""
    best = best_drive(driven_case(scene, options), options.window, direction=1 if options.direction == "+x" else -1)
    best.check_exists()
    return best


pure = figures("wave", pure_drive, reads=DRIVEN, devices=True)
pure("best_ratio", "1", "Amplitude ratio of the second to the first actuator that leaves no reflection.", "ratio")
pure(
    "best_ratio_phase",
    "deg",
    "Phase lead of the second actuator that leaves no reflection, in (-180, 180] degrees.",
    "phase_deg",
)


Measure = Annotated[
    Literal["standing_wave_ratio", "axis_ratio", "deflection"],
    Meta(description="measure whose error is observed; deflection: at the middle of the window"),
]


@quantity("wave.order", unit="1", reads=DRIVEN, devices=True)
def order(
    scene: Scene,
    cache: SolutionCache,
    options: FieldSettings,
    *,
    model: opt.DiscreteField,
    counts: opt.Sizes,
    of: Measure = "standing_wave_ratio",
    window: Window | None = None,
) -> float:
    """Observed order of a wave measure in N, reference: exact field; an error outside the asymptotic range."""
    check_sizes("counts", counts)
    middle = 0.5 * sum(window or middle_half(scene.beam))

    def figure(case: DrivenCase) -> complex:
        if of == "deflection":
            return complex(driven(case, cache).deflection(middle)[0])
        return complex(getattr(measured(case, cache, window), "mean_" * (of == "axis_ratio") + of))

    cases = [driven_case(scene, options, model, count) for count in counts]
    exact = MODELS[EXACT].build(cases[0].beam, theory=options.theory)
    reference = figure(replace(cases[0], model=exact))
    return asymptotic_order(counts, [relative_error(figure(case), reference) for case in cases])


TwoModes = Annotated[tuple[opt.Mode, opt.Mode], Meta(description="numbers of the two modes")]
Limit = Annotated[Relative, Meta(gt=0, lt=1, description="largest reflection")]


@quantity("wave.lumped_swr", unit="1", reads=("beam",), devices=True)
def lumped_swr(scene: Scene, *, x: Place, modes: TwoModes = (21, 22)) -> float:
    """Local standing-wave ratio of two equal modes in quadrature (lumped-parameter model)."""
    return float(two_modes.lumped_swr(scene.beam, x, modes)[0])


@quantity("wave.fastest_crests", unit="m/s", reads=DRIVEN)
def fastest_crests(scene: Scene, *, limit: Limit = 0.1) -> float:
    """Largest crest speed at reflections up to `limit`: forces in place, frequency within 1.5 %, phase 5 to 175 deg."""
    return operating_point.maximum_crest_speed(driven_case(scene, FieldOptions()), limit).crest_speed


FromRightEnd = Annotated[float, Meta(ge=0, description="distance from the right end, m")]


def ending_at(
    scene: Scene, *, position: FromRightEnd, frequency_hz: opt.Frequency | None = None, turning: bool = False
) -> Ending:
    """The half-infinite beam with a device near the scene's right end. Raises InputError."""
    if position >= scene.beam.length:
        raise InputError(f"position = {position!r} lies off the beam: give less than {scene.beam.length!r} m")
    hertz = opt.drive_frequency(scene, frequency_hz)
    return ending(scene.beam, hertz, position, scene.beam.supports[1], turning=turning)


@quantity("wave.absorber_impedance", unit="kg/s", reads=DRIVEN, devices=True)
def absorber_impedance(scene: Scene, *, position: FromRightEnd, frequency_hz: opt.Frequency | None = None) -> complex:
    """Matched impedance (force over velocity) of a transverse device near the right end: no reflection."""
    return ending_at(scene, position=position, frequency_hz=frequency_hz).matched


@quantity("wave.absorber_reflection", unit="1", reads=DRIVEN, devices=True)
def absorber_reflection(
    scene: Scene,
    *,
    position: FromRightEnd,
    frequency_hz: opt.Frequency | None = None,
    turning: Annotated[bool, Meta(description="rotational device instead of a transverse one")] = False,
    ratio: Annotated[float, Meta(ge=0, description="resistance over matched resistance; matched spring")] | None = None,
    resistance: Annotated[float, Meta(ge=0, description="dashpot, kg/s; rotational: N m s")] | None = None,
    stiffness: Annotated[float, Meta(ge=0, description="spring beside resistance, N/m; rotational: N m/rad")] = 0.0,
    model: Annotated[Literal["analytic"], Meta(description="finite beam; default: half-infinite beam")] | None = None,
) -> float:
    """Reflection Gamma at an absorbing device on a half-infinite beam, or in the middle half of the scene's beam."""
    if (ratio is None) == (resistance is None):
        raise InputError(f"ratio = {ratio!r} and resistance = {resistance!r}: give one of the two")
    if ratio is not None and stiffness:
        raise InputError(f"stiffness = {stiffness!r}: ratio implies the matched spring, leave it out")
    omega = 2.0 * pi * (hertz := opt.drive_frequency(scene, frequency_hz))
    end = ending_at(scene, position=position, frequency_hz=hertz, turning=turning)
    if ratio is not None:
        impedance = complex(ratio * end.matched.real, end.matched.imag)
    else:
        impedance = complex(resistance or 0.0, -stiffness / omega)
    if model is None:
        return end.reflection(impedance)
    opt.check_forces(scene, "an absorbing device")
    if scene.shunts:
        raise InputError("drive.shunt: the reflection of a device is computed without shunts, leave them out")
    x, tolerance = scene.beam.length - position, 1e-9 * scene.beam.length  # it replaces forces and devices at x
    forces = [force for force in scene.forces if abs(force.position - x) > tolerance]
    devices = [device for device in scene.devices if abs(device.position - x) > tolerance]
    if not forces:
        raise InputError("drive.force: the only force is at the device, add another at a distance")
    if impedance:
        devices.append(of_impedance(x, impedance, omega, turning=turning))
    field = MODELS[EXACT].build(scene.beam).harmonic(forces, hertz, devices=devices)
    return measure(field, middle_half(scene.beam), field.wavenumber).reflection


def _voltage_wave(scene: Scene, cache: SolutionCache, options: WaveOptions) -> WaveMeasures:
    return wave_in_window(scene, cache, replace(options, drive=options.drive or "voltage"))


voltage = figures("wave", _voltage_wave, reads=DRIVEN, devices=True)
voltage(
    "voltage_ratio",
    "1",
    "Standing-wave ratio with the drive's amplitudes as voltages of its actuators.",
    "standing_wave_ratio",
)
voltage(
    "voltage_direction",
    "1",
    "Direction of the stronger wave under voltages: +1 towards +x, -1 towards -x.",
    "waves.direction",
)


@quantity("wave.pure_voltage_phase", unit="deg", reads=DRIVEN, devices=True)
def pure_voltage_phase(scene: Scene, options: DirectedOptions) -> float:
    """Phase lead of the second of two equal voltages with least reflection, in (-180, 180] degrees."""
    return pure_drive(scene, replace(options, drive=options.drive or "voltage")).equal_phase_deg


def _actuator(scene: Scene, options: FieldOptions, actuator: int) -> ActuatorState:
    """The ports of an actuator, from 1. Raises InputError."""
    case = driven_case(scene, options)
    if case.kind == "displacement" or not (case.electrical or case.shunts):
        raise InputError(f"drive.kind = {case.kind!r}: no actuator takes electrical power, give 'voltage' or 'current'")
    states = case.actuated(case.acting, case.frequency_hz).actuators
    if actuator > len(states):
        raise InputError(f"actuator = {actuator!r}: the drive has {len(states)} actuators, give at most that")
    return states[actuator - 1]


@quantity("drive.power", unit="W", reads=DRIVEN, devices=True)
def power(scene: Scene, options: FieldOptions, *, actuator: Number = 1) -> float:
    """Mean electrical power into an actuator; negative where it returns power to its source or feeds a load."""
    return _actuator(scene, options, actuator).power_in


@quantity("drive.current", unit="A", reads=DRIVEN, devices=True)
def current(scene: Scene, options: FieldOptions, *, actuator: Number = 1) -> float:
    """Amplitude of the current into an actuator, by which an amplifier is chosen."""
    return abs(_actuator(scene, options, actuator).current)
