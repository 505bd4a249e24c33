"""Quantities of the driven beam in its steady state: field, wave measures, sensitivities, power, absorbing devices."""

from collections.abc import Callable
from math import pi
from typing import TYPE_CHECKING, Annotated, Any, Literal

from msgspec import Meta
from msgspec.structs import replace

from verify import options
from verify.checks import Relative, check_sizes
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.models.naming import model_meta
from verify.quantities import options as opt
from verify.quantities.base import Place, Scene, quantity

if TYPE_CHECKING:
    from verify.judge.cache import SolutionCache
    from verify.models.fields import HarmonicField
    from verify.waves.absorber import Ending
    from verify.waves.case import DrivenCase

Window = Annotated[tuple[float, float], Meta(description="m, start and end; default L/4 to 3L/4")]
Loss = Annotated[Relative, Meta(description="eta of E (1 + i eta); default: the beam's")]
Imposed = Annotated[options.DriveKind, Meta(description="what is imposed; default: the scene's")]
DRIVEN = ("beam", "drive")


class FieldSettings(opt.DriveOptions, frozen=True, kw_only=True):
    """Drive, losses and settings of a harmonic field."""

    loss_factor: Loss | None = None
    drive: Imposed | None = None
    modal_damping: Annotated[Relative, Meta(description="damping ratio of every mode; fem and segment")] = 0.0
    joint_dashpot: Annotated[float, Meta(description="N m s at every joint; segment")] = 0.0
    load: Annotated[options.Load, Meta(description="distribution of a force over joints; segment")] = "reciprocal"
    reading: Annotated[options.Reading, Meta(description="interpolation between joints; segment")] = "corrected"
    wall: opt.Wall = "gregory"
    joints: opt.Joints = "series"
    theory: opt.Theory = "euler-bernoulli"
    attachment: opt.Attachment = "reciprocal"

    def check_loss_factor_alone(self, what: str) -> None:
        """Raise InputError for another damping, where `what` takes a loss factor alone."""
        for name in ("modal_damping", "joint_dashpot"):
            if value := getattr(self, name):
                raise InputError(f"{name} = {value!r}: {what} takes a loss_factor alone, give that instead")


class FieldOptions(FieldSettings, frozen=True, kw_only=True):
    """A model of the driven beam with its losses and settings."""

    model: opt.FieldModel = "analytic"
    count: opt.Size | None = None


class UnitOptions(opt.DriveOptions, frozen=True, kw_only=True):
    """A model of the driven beam whose field is a superposition of unit drives."""

    model: opt.UnitModel = "analytic"
    count: opt.Size | None = None
    loss_factor: Loss | None = None
    drive: Imposed | None = None
    theory: opt.Theory = "euler-bernoulli"


def driven_case(
    scene: Scene, options: FieldSettings | UnitOptions, model: str = "", count: int | None = None
) -> "DrivenCase":
    """The driven beam of a scene with these options, by their model unless given. Raises InputError."""
    from verify.waves.case import DrivenCase

    if isinstance(options, FieldOptions | UnitOptions):
        model, count = options.model, options.count
    opt.check_count(model, count)
    of_case = (*opt.DriveOptions.__struct_fields__, "loss_factor", "drive", "model", "count")
    settings = opt.check_settings(model, opt.not_default(options, without=of_case), "field")
    loss = options.loss_factor
    return DrivenCase(
        beam=scene.beam if loss is None else replace(scene.beam, loss_factor=loss),
        model=model,
        count=count,
        forces=options.forces(scene),
        frequency_hz=options.frequency(scene),
        kind=options.drive or (scene.drive.kind if scene.drive else "force"),
        settings=settings,
        devices=tuple(scene.devices),
    )


def driven_field(scene: Scene, cache: "SolutionCache", options: FieldOptions) -> "HarmonicField":
    """The steady field of a scene with these options. Raises InputError."""
    from verify.waves.driven import driven

    return driven(driven_case(scene, options), cache)


def _at_place(read: "Callable[[HarmonicField, float], Any]") -> Callable[..., complex]:
    def at_place(scene: Scene, cache: "SolutionCache", options: FieldOptions, *, x: Place) -> complex:
        return complex(read(driven_field(scene, cache, options), x)[0])

    return at_place


for _name, _unit, _text, _read in (
    ("deflection", "m", "Complex deflection, e^{+i omega t}.", lambda field, x: field.deflection(x)),
    ("slope", "rad", "Complex slope of the deflection, e^{+i omega t}.", lambda field, x: field.slope(x)),
    ("curvature", "1/m", "Complex second derivative of the deflection.", lambda field, x: field.derivative(x, 2)),
):
    quantity(f"wave.{_name}", unit=_unit, summary=_text, reads=DRIVEN, devices=True)(_at_place(_read))


def _measure(figure: str) -> Callable[..., float]:
    def measure(scene: Scene, cache: "SolutionCache", options: FieldOptions, *, window: Window | None = None) -> float:
        from verify.waves.driven import measured_alone

        return float(measured_alone(driven_field(scene, cache, options), window, figure))

    return measure


MEASURES = {
    "standing_wave_ratio": ("1", "(1 + Gamma)/(1 - Gamma) of two waves fitted by least squares over the window."),
    "reflection": ("1", "Gamma, weaker over stronger wave, at the middle of the window."),
    "envelope": ("1", "(max - min)/(max + min) of |w| over the window; Gamma for two waves."),
    "travelling_index": (
        "1",
        "1/cond([Re w, Im w]) over whole half wavelengths; (1 - Gamma)/(1 + Gamma) for two waves.",
    ),
    "signed_area_spread": ("1", "(max - min)/|mean| of the signed area of the surface ellipses over the window."),
    "crest_speed": ("m/s", "Surface speed at the wave crests along +x."),
    "energy_flux": ("W", "Power transmitted towards +x at the middle of the window by the two fitted waves."),
}
for _name, (_unit, _text) in MEASURES.items():
    quantity(f"wave.{_name}", unit=_unit, summary=_text, reads=DRIVEN, devices=True)(_measure(_name))


@quantity("wave.axis_ratio", unit="1", reads=DRIVEN, devices=True)
def axis_ratio(
    scene: Scene, cache: "SolutionCache", options: FieldOptions, *, x: Place | None = None, window: Window | None = None
) -> float:
    """Signed axis ratio of the surface ellipse at x, or its mean over whole half wavelengths; below 0 towards +x."""
    from verify.waves.driven import measured_alone
    from verify.waves.measures import ellipse, surface_motion

    if x is not None and window is not None:
        raise InputError(f"window = {list(window)} with x = {x!r}: give one of the two")
    field = driven_field(scene, cache, options)
    if x is None:
        return float(measured_alone(field, window, "mean_axis_ratio"))
    return float(ellipse(surface_motion(field.beam, field.turn(x), x=x), field.deflection(x))[0][0])


@quantity("wave.power_imbalance", unit="1", reads=DRIVEN, devices=True)
def power_imbalance(
    scene: Scene, cache: "SolutionCache", options: FieldOptions, *, window: Window | None = None
) -> float:
    """Power of the left force less losses up to the window's middle less flux there, over that flux."""
    from verify.waves.driven import measures, power_imbalance

    options.check_loss_factor_alone("a power balance")
    if any(device.turning for device in scene.devices):
        raise InputError("drive.device: a power balance takes transverse devices alone, leave its rotational terms out")
    field = driven_field(scene, cache, options)
    return power_imbalance(field, measures(field, window))


@quantity("wave.best_frequency", unit="Hz", reads=DRIVEN, devices=True)
def best_frequency(
    scene: Scene,
    cache: "SolutionCache",
    options: FieldOptions,
    *,
    window: Window | None = None,
    span: Annotated[Relative, Meta(gt=0, lt=0.5, description="search range relative to the drive's frequency")] = 0.015,
) -> float:
    """Frequency of least reflection near the drive's."""
    from verify.waves.driven import best_frequency

    return best_frequency(driven_case(scene, options), span, window, cache)


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
        Meta(description="whose error; deflection at the middle of the window"),
    ] = "standing_wave_ratio",
    window: Window | None = None,
) -> float:
    """Observed order of a wave measure's error against the exact field; outside the asymptotic range an InputError."""
    from verify.waves.driven import wave_order

    check_sizes("counts", counts)
    options.check_loss_factor_alone("the exact beam")
    return wave_order(driven_case(scene, options, model, counts[0]), counts, window, of, cache)


@quantity("wave.lumped_swr", unit="1", reads=("beam",), devices=True)
def lumped_swr(
    scene: Scene,
    *,
    x: Place,
    modes: Annotated[tuple[opt.Mode, opt.Mode], Meta(description="mode numbers of the two")] = (21, 22),
    ratio: Annotated[float, Meta(gt=0, description="amplitude of the second over the first, mass-normalised")] = 1.0,
    phase_deg: Annotated[float, Meta(description="lead of the second")] = 90.0,
) -> float:
    """Local standing-wave ratio of two modes in quadrature, the lumped-parameter model of the wave."""
    from verify.waves.lumped import TwoModes

    return float(TwoModes(beam=scene.beam, modes=modes, ratio=ratio, phase_deg=phase_deg).local_swr(x)[0])


@quantity("wave.receptance", unit="m/N", reads=DRIVEN)
def receptance(
    scene: Scene,
    *,
    model: opt.UnitModel = "analytic",
    count: opt.Size | None = None,
    position: Annotated[Place, Meta(description="m, of the force")],
    x: Place,
    frequency_hz: opt.Frequency | None = None,
    loss_factor: Loss | None = None,
    theory: opt.Theory = "euler-bernoulli",
) -> complex:
    """Deflection at x under a unit force at `position`."""
    from verify.waves.unit_waves import receptance

    opt.check_count(model, count)
    beam = scene.beam if loss_factor is None else replace(scene.beam, loss_factor=loss_factor)
    return receptance(model, beam, position, opt.drive_frequency(scene, frequency_hz), x, count, theory)


def _sensitivity(attribute: str) -> Callable[..., float]:
    def sensitivity(scene: Scene, options: UnitOptions) -> float:
        from verify.waves.operating_point import driven_point

        return float(getattr(driven_point(driven_case(scene, options)), attribute))

    return sensitivity


for _name, _unit, _text in (
    ("hertz", "1/Hz", "Change of the reflection over half a hertz, mean of both sides."),
    ("degree", "1/degree", "Change of the reflection over half a degree of phase, mean of both sides."),
):
    quantity(f"wave.reflection_per_{_name}", unit=_unit, summary=_text, reads=DRIVEN)(_sensitivity(f"per_{_name}"))


@quantity("wave.fastest_crests", unit="m/s", reads=DRIVEN)
def fastest_crests(
    scene: Scene,
    options: UnitOptions,
    *,
    limit: Annotated[Relative, Meta(gt=0, lt=1, description="largest reflection")] = 0.1,
) -> float:
    """Largest crest speed with a reflection up to `limit`, within 1.5 % of the frequency and phases of 5 to 175 deg."""
    from verify.waves.operating_point import fastest_point

    return fastest_point(driven_case(scene, options), limit).crest_speed


FromRightEnd = Annotated[float, Meta(ge=0, description="m from the right end")]


def _ending(scene: Scene, position: float, frequency_hz: float, turning: bool = False) -> "Ending":
    from verify.waves.absorber import ending

    if position >= scene.beam.length:
        raise InputError(f"position = {position!r} lies off the beam: give less than {scene.beam.length!r} m")
    return ending(scene.beam, frequency_hz, position, scene.beam.supports[1], turning=turning)


@quantity("wave.absorber_impedance", unit="kg/s", reads=DRIVEN, devices=True)
def absorber_impedance(scene: Scene, *, position: FromRightEnd, frequency_hz: opt.Frequency | None = None) -> complex:
    """Impedance, force over velocity, of a transverse device near the right end that reflects nothing."""
    return _ending(scene, position, opt.drive_frequency(scene, frequency_hz)).matched


@quantity("wave.absorber_reflection", unit="1", reads=DRIVEN, devices=True)
def absorber_reflection(
    scene: Scene,
    *,
    position: FromRightEnd,
    frequency_hz: opt.Frequency | None = None,
    turning: Annotated[bool, Meta(description="rotational device, else transverse")] = False,
    ratio: Annotated[float, Meta(ge=0, description="resistance over the matched one, spring matched")] | None = None,
    resistance: Annotated[float, Meta(ge=0, description="of the dashpot, kg/s; rotational N m s")] | None = None,
    stiffness: (Annotated[float, Meta(ge=0, description="with resistance, N/m; rotational N m/rad")] | None) = None,
    mass: Annotated[float, Meta(ge=0, description="with resistance, kg; rotational kg m^2")] | None = None,
    model: (
        Annotated[str, model_meta("of the whole beam; default: a half-infinite beam", "solve_harmonic")] | None
    ) = None,
    count: opt.Size | None = None,
    alone: Annotated[bool, Meta(description="with model: without the scene's other devices")] = False,
) -> float:
    """Gamma behind an absorbing device: of a half-infinite beam, or of a model's whole beam in its middle half."""
    from verify.waves.absorber import reflection

    if model is not None:
        opt.check_count(model, count)
    elif count is not None or alone:
        given = "alone = True" if count is None else f"count = {count!r}"
        raise InputError(f"{given}: a half-infinite beam has no such option, give model as well")
    if (ratio is None) == (resistance is None):
        raise InputError(f"ratio = {ratio!r} and resistance = {resistance!r}: give one of the two")
    for name, value in (("stiffness", stiffness), ("mass", mass)):
        if ratio is not None and value is not None:
            raise InputError(f"{name} = {value!r}: with ratio spring and mass are the matched ones, leave it out")
    hertz = opt.drive_frequency(scene, frequency_hz)
    end, omega = _ending(scene, position, hertz, turning), 2.0 * pi * hertz
    if ratio is not None:
        impedance = complex(ratio * end.matched.real, end.matched.imag)
    else:
        impedance = complex(resistance or 0.0, omega * (mass or 0.0) - (stiffness or 0.0) / omega)
    if model is None:
        return reflection(impedance, end)
    return _reflection_on_beam(scene, scene.beam.length - position, impedance, hertz, turning, model, count, alone)


def _reflection_on_beam(
    scene: Scene, x: float, impedance: complex, hertz: float, turning: bool, model: str, count: int | None, alone: bool
) -> float:
    """Gamma in the middle half between the other forces and a device at x, which replaces what acts there."""
    from verify.device import of_impedance
    from verify.waves.devices import field_with_devices
    from verify.waves.driven import measured_alone

    opt.check_forces(scene, "an absorbing device")
    tolerance = 1e-9 * scene.beam.length
    forces = [force for force in scene.forces if abs(force.position - x) > tolerance]
    devices = [one for one in scene.devices if not alone and abs(one.position - x) > tolerance]
    if not forces:
        raise InputError("drive.force: none is left beside the device, add one elsewhere")
    if impedance:
        devices.append(of_impedance(x, impedance, 2.0 * pi * hertz, turning=turning))
    solver = MODELS.named(model)
    field = field_with_devices(
        lambda beam, forces, hertz: solver.solve_harmonic(beam, forces, hertz, count),
        scene.beam,
        forces,
        hertz,
        devices,
    )
    return measured_alone(field, None, "reflection")
