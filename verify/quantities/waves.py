"""Quantities of the driven beam in its steady state: field, wave measures, best drive, power, absorbing devices."""

from collections.abc import Callable
from math import pi
from typing import TYPE_CHECKING, Annotated, Literal

from msgspec import Meta
from msgspec.structs import replace

from verify import settings
from verify.actuators.patch import Patch
from verify.errors import InputError
from verify.linear.registry import EXACT, MODELS
from verify.quantities import options as opt
from verify.quantities.base import Place, Scene, quantity
from verify.settings import DEFAULT
from verify.validation import Relative, check_sizes

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.linear.field import HarmonicField
    from verify.travelling_wave import BestDrive, DrivenCase, WaveMeasures
    from verify.waves.impedance_matching import Ending

Window = Annotated[tuple[float, float], Meta(description="start and end, m; default: L/4 to 3L/4")]
DRIVEN = ("beam", "drive")


class FieldSettings(opt.DriveOptions, frozen=True, kw_only=True):
    """Drive, losses and settings of a harmonic field."""

    loss_factor: Annotated[Relative, Meta(description="eta in E (1 + i eta); default: the beam's")] | None = None
    drive: Annotated[settings.DriveKind, Meta(description="kind of drive; default: the scene's")] | None = None
    theory: settings.Theory = DEFAULT.theory
    load: settings.Load = DEFAULT.load
    reading: settings.Reading = DEFAULT.reading
    wall: settings.Wall = DEFAULT.wall
    joints: settings.Joints = DEFAULT.joints
    attachment: settings.Attachment = DEFAULT.attachment


class FieldOptions(FieldSettings, frozen=True, kw_only=True):
    """A model of the driven beam with its losses and settings."""

    model: opt.FieldModel = "analytic"
    count: opt.Size | None = None


def driven_case(scene: Scene, options: FieldSettings, model: str = "", count: int | None = None) -> "DrivenCase":
    """The driven beam of a scene with these options; `FieldOptions` include the model. Raises InputError."""
    from verify.waves.driven_case import DrivenCase

    if isinstance(options, FieldOptions):
        model, count = options.model, options.count
    opt.check_count(model, count)
    of_case = (*opt.DriveOptions.__struct_fields__, "loss_factor", "drive", "model", "count")
    chosen = dict(opt.check_settings(model, opt.not_default(options, without=of_case)))
    beam = scene.beam if options.loss_factor is None else replace(scene.beam, loss_factor=options.loss_factor)
    kind = options.drive or (scene.drive.kind if scene.drive else "force")
    forces, actuator = options.forces(scene), scene.drive.actuator if scene.drive else None
    if isinstance(actuator, Patch) and (scene.shunts or kind in ("voltage", "current")):
        driven = [force.position for force in forces] if kind in ("voltage", "current") else []
        actuator, beam = actuator.bonded(beam), actuator.on(beam, [*driven, *(x for x, _ in scene.shunts)])
    return DrivenCase(
        model=MODELS.named(model).build(beam, count, **chosen),
        forces=forces,
        frequency_hz=opt.drive_frequency(scene, options.frequency_hz),
        kind=kind,
        devices=tuple(scene.devices),
        actuator=actuator,
        shunts=scene.shunts,
    )


def driven_field(scene: Scene, cache: "SolutionCache", options: FieldOptions) -> "HarmonicField":
    """The steady field of a scene with these options. Raises InputError."""
    from verify.waves.driven_case import driven

    return driven(driven_case(scene, options), cache)


def measured(case: "DrivenCase", cache: "SolutionCache", window: tuple[float, float] | None = None) -> "WaveMeasures":
    """The wave of a case in a window (default: middle half) with the model's wavenumber. Raises InputError."""
    from verify.travelling_wave import measure, middle_half
    from verify.waves.driven_case import driven

    field = driven(case, cache)
    return measure(field, window or middle_half(case.beam), case.wavenumber(case.frequency_hz))


@quantity("wave.deflection", unit="m", reads=DRIVEN, devices=True)
def deflection(scene: Scene, cache: "SolutionCache", options: FieldOptions, *, x: Place) -> complex:
    """Complex deflection amplitude at x, convention e^{+i omega t}."""
    return complex(driven_field(scene, cache, options).deflection(x)[0])


def _measure(figure: str) -> Callable[..., float]:
    def measure(scene: Scene, cache: "SolutionCache", options: FieldOptions, *, window: Window | None = None) -> float:
        return float(getattr(measured(driven_case(scene, options), cache, window), figure))

    return measure


MEASURES = {
    "standing_wave_ratio": ("1", "Standing-wave ratio (1 + Gamma)/(1 - Gamma) of two waves fitted in the window."),
    "reflection": ("1", "Reflection Gamma: weaker over stronger wave amplitude at the middle of the window."),
    "travelling_index": (
        "1",
        "Feeny's index 1/cond([Re w, Im w]) over whole half wavelengths; (1 - Gamma)/(1 + Gamma) for two waves.",
    ),
    "signed_area_spread": ("1", "Spread (max - min)/|mean| of the signed area of the surface ellipses in the window."),
    "crest_speed": (
        "m/s",
        "Surface velocity along +x at crests of rms amplitude; its sign is against the energy flux.",
    ),
    "energy_flux": ("W", "Power transmitted towards +x at the middle of the window by the two fitted waves."),
}
for _name, (_unit, _text) in MEASURES.items():
    quantity(f"wave.{_name}", unit=_unit, summary=_text, reads=DRIVEN, devices=True)(_measure(_name))


@quantity("wave.axis_ratio", unit="1", reads=DRIVEN, devices=True)
def axis_ratio(
    scene: Scene, cache: "SolutionCache", options: FieldOptions, *, x: Place | None = None, window: Window | None = None
) -> float:
    """Signed axis ratio of the surface ellipse at x, or its mean in the window; negative for a wave towards +x."""
    from verify.travelling_wave import ellipse, surface_motion

    if x is not None and window is not None:
        raise InputError(f"window = {list(window)} with x = {x!r}: give one of the two")
    if x is None:
        return measured(driven_case(scene, options), cache, window).mean_axis_ratio
    field = driven_field(scene, cache, options)
    return float(ellipse(surface_motion(field.beam, field.rotation(x), x=x), field.deflection(x))[0][0])


@quantity("wave.power_imbalance", unit="1", reads=DRIVEN, devices=True)
def power_imbalance(
    scene: Scene, cache: "SolutionCache", options: FieldOptions, *, window: Window | None = None
) -> float:
    """Relative residual of the power balance: left force - losses up to the middle of the window - energy flux."""
    from verify.travelling_wave import power_imbalance

    case = driven_case(scene, options)
    if case.places[1]:
        raise InputError("drive.device: a power balance takes transverse devices and forces, leave others out")
    return power_imbalance(driven_field(scene, cache, options), measured(case, cache, window))


@quantity("wave.best_frequency", unit="Hz", reads=DRIVEN, devices=True)
def best_frequency(
    scene: Scene,
    options: FieldOptions,
    *,
    window: Window | None = None,
    span: Annotated[Relative, Meta(gt=0, lt=0.5, description="search range relative to the drive's frequency")] = 0.015,
) -> float:
    """Drive frequency of least reflection near the scene's drive frequency."""
    from verify.travelling_wave import best_frequency

    return best_frequency(driven_case(scene, options), span, window)


Direction = Annotated[Literal["+x", "-x"], Meta(description="direction of the wave")]


def pure_drive(scene: Scene, options: FieldOptions, window: Window | None, direction: Direction) -> "BestDrive":
    """The drive without reflection towards one end. Raises InputError where there is none."""
    from verify.travelling_wave import best_drive

    best = best_drive(driven_case(scene, options), window, direction=1 if direction == "+x" else -1)
    best.check_exists()
    return best


@quantity("wave.best_ratio", unit="1", reads=DRIVEN, devices=True)
def best_ratio(
    scene: Scene, options: FieldOptions, *, window: Window | None = None, direction: Direction = "+x"
) -> float:
    """Amplitude ratio of the second to the first actuator that leaves no reflection."""
    return pure_drive(scene, options, window, direction).ratio


@quantity("wave.best_ratio_phase", unit="deg", reads=DRIVEN, devices=True)
def best_ratio_phase(
    scene: Scene, options: FieldOptions, *, window: Window | None = None, direction: Direction = "+x"
) -> float:
    """Phase lead of the second actuator that leaves no reflection, in (-180, 180] degrees."""
    return pure_drive(scene, options, window, direction).phase_deg


@quantity("wave.order", unit="1", reads=DRIVEN, devices=True)
def order(
    scene: Scene,
    cache: "SolutionCache",
    options: FieldSettings,
    *,
    model: opt.DiscreteField,
    counts: opt.Sizes,
    of: Annotated[
        Literal["standing_wave_ratio", "axis_ratio", "deflection"],
        Meta(description="measure whose error is observed; deflection: at the middle of the window"),
    ] = "standing_wave_ratio",
    window: Window | None = None,
) -> float:
    """Observed order of a wave measure in N, reference: exact field; an error outside the asymptotic range."""
    from verify.analysis.comparison import asymptotic_order, relative_error
    from verify.travelling_wave import middle_half
    from verify.waves.driven_case import driven

    check_sizes("counts", counts)
    middle = 0.5 * sum(window or middle_half(scene.beam))

    def figure(case: "DrivenCase") -> complex:
        if of == "deflection":
            return complex(driven(case, cache).deflection(middle)[0])
        return complex(getattr(measured(case, cache, window), "mean_" * (of == "axis_ratio") + of))

    cases = [driven_case(scene, options, model, count) for count in counts]
    exact = MODELS[EXACT].build(cases[0].beam, theory=options.theory)
    reference = figure(replace(cases[0], model=exact))
    return asymptotic_order(counts, [relative_error(figure(case), reference) for case in cases])


@quantity("wave.lumped_swr", unit="1", reads=("beam",), devices=True)
def lumped_swr(
    scene: Scene,
    *,
    x: Place,
    modes: Annotated[tuple[opt.Mode, opt.Mode], Meta(description="numbers of the two modes")] = (21, 22),
) -> float:
    """Local standing-wave ratio of two equal modes in quadrature (lumped-parameter model)."""
    from verify.waves.two_modes import lumped_swr

    return float(lumped_swr(scene.beam, x, modes)[0])


@quantity("wave.fastest_crests", unit="m/s", reads=DRIVEN)
def fastest_crests(
    scene: Scene, *, limit: Annotated[Relative, Meta(gt=0, lt=1, description="largest reflection")] = 0.1
) -> float:
    """Largest crest speed at reflections up to `limit`: forces in place, frequency within 1.5 %, phase 5 to 175 deg."""
    from verify.travelling_wave import maximum_crest_speed

    return maximum_crest_speed(driven_case(scene, FieldOptions()), limit).crest_speed


FromRightEnd = Annotated[float, Meta(ge=0, description="distance from the right end, m")]


def _ending(scene: Scene, position: float, frequency_hz: float | None, turning: bool = False) -> "Ending":
    from verify.waves.impedance_matching import ending

    if position >= scene.beam.length:
        raise InputError(f"position = {position!r} lies off the beam: give less than {scene.beam.length!r} m")
    hertz = opt.drive_frequency(scene, frequency_hz)
    return ending(scene.beam, hertz, position, scene.beam.supports[1], turning=turning)


@quantity("wave.absorber_impedance", unit="kg/s", reads=DRIVEN, devices=True)
def absorber_impedance(scene: Scene, *, position: FromRightEnd, frequency_hz: opt.Frequency | None = None) -> complex:
    """Matched impedance (force over velocity) of a transverse device near the right end: no reflection."""
    return _ending(scene, position, frequency_hz).matched


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
    from verify.waves.impedance_matching import reflection

    if (ratio is None) == (resistance is None):
        raise InputError(f"ratio = {ratio!r} and resistance = {resistance!r}: give one of the two")
    if ratio is not None and stiffness:
        raise InputError(f"stiffness = {stiffness!r}: ratio implies the matched spring, leave it out")
    hertz, end = opt.drive_frequency(scene, frequency_hz), _ending(scene, position, frequency_hz, turning)
    if ratio is not None:
        impedance = complex(ratio * end.matched.real, end.matched.imag)
    else:
        impedance = complex(resistance or 0.0, -stiffness / (2.0 * pi * hertz))
    if model is None:
        return reflection(impedance, end)
    return _reflection_on_beam(scene, scene.beam.length - position, impedance, hertz, turning)


def _reflection_on_beam(scene: Scene, x: float, impedance: complex, hertz: float, turning: bool) -> float:
    """Gamma in the middle half of the beam with a device at x, which replaces forces and devices at x."""
    from verify.problem.device import of_impedance
    from verify.travelling_wave import measure, middle_half

    opt.check_forces(scene, "an absorbing device")
    if scene.shunts:
        raise InputError("drive.shunt: the reflection of a device is computed without shunts, leave them out")
    tolerance = 1e-9 * scene.beam.length
    forces = [force for force in scene.forces if abs(force.position - x) > tolerance]
    devices = [one for one in scene.devices if abs(one.position - x) > tolerance]
    if not forces:
        raise InputError("drive.force: the only force is at the device, add another at a distance")
    if impedance:
        devices.append(of_impedance(x, impedance, 2.0 * pi * hertz, turning=turning))
    field = MODELS[EXACT].build(scene.beam).harmonic(forces, hertz, devices=devices)
    return measure(field, middle_half(scene.beam), field.wavenumber).reflection
