"""Named figures of contact in closed form: a driving layer, a mass that leaves the surface, a device that absorbs."""

from math import pi
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from msgspec import Meta

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.models import catalogue
from verify.models.catalogue import MODELS
from verify.models.naming import model_meta
from verify.quantities.cases import drive_frequency
from verify.quantities.kind import Arguments, AtFrequency, Quantity, Size

if TYPE_CHECKING:
    from verify.beam import PointForce
    from verify.device import Device as OnBeam
    from verify.scenes.scene import Scene
    from verify.waves.absorber import Ending


_WHOLE = "of the whole beam, with its other forces and devices; half-infinite unless given"


class Layer(Arguments, frozen=True, kw_only=True):
    """A rigid slider on the crests of a wave, through a layer of springs."""

    reads: ClassVar[tuple[str, ...]] = ()
    contact_half_angle: Annotated[float, Meta(gt=0, lt=pi, description="of the wave's phase, radians")]
    epsilon: Annotated[
        float, Meta(ge=0, description="2 mu kappa/(kappa_t k h), the layer's give along the surface; 0 is Coulomb's")
    ] = 0.0


class LayerAt(Layer, frozen=True, kw_only=True):
    """The same at a speed of the slider."""

    speed_ratio: Annotated[float, Meta(description="over the speed of the surface at the crests")]


class CoulombLayerAt(Arguments, frozen=True, kw_only=True):
    """The same without give along the surface."""

    reads: ClassVar[tuple[str, ...]] = ()
    contact_half_angle: Annotated[float, Meta(gt=0, lt=pi, description="of the wave's phase, radians")]
    speed_ratio: Annotated[float, Meta(ge=0, lt=1, description="over the speed of the surface at the crests")]


class Shaken(Arguments, frozen=True, kw_only=True):
    """A mass on a surface that shakes across."""

    reads: ClassVar[tuple[str, ...]] = ()
    acceleration_ratio: Annotated[
        float, Meta(gt=1, description="A omega^2 over the acceleration that presses it down, above 1")
    ]


class Landing(Arguments, frozen=True, kw_only=True):
    """A mass that lands on a spring beside a dashpot: by its damping ratio, or by all three."""

    reads: ClassVar[tuple[str, ...]] = ()
    damping_ratio: Annotated[float, Meta(ge=0, description="of the mass on its contact, c/(2 sqrt(k m))")] | None = None
    mass: Annotated[float, Meta(gt=0, description="that lands, kg")] | None = None
    stiffness: Annotated[float, Meta(gt=0, description="of the contact's spring, N/m")] | None = None
    damping: Annotated[float, Meta(ge=0, description="of its dashpot, N s/m")] | None = None

    def __post_init__(self) -> None:
        parts = {name: getattr(self, name) for name in ("mass", "stiffness", "damping")}
        missing = [name for name, value in parts.items() if value is None]
        if self.damping_ratio is not None and len(missing) < len(parts):
            name = next(name for name in parts if name not in missing)
            raise InputError(f"{name} = {parts[name]!r}: with damping_ratio it says the same twice, leave it out")
        if self.damping_ratio is None and missing:
            raise InputError(f"{missing[0]} is missing: give damping_ratio, or mass, stiffness and damping")


class Device(AtFrequency, frozen=True, kw_only=True):
    """A place for a device near the right end."""

    position: Annotated[float, Meta(ge=0, description="metres from the right end")]


class Absorbing(Device, frozen=True, kw_only=True):
    """A device there: by its dashpot and spring, or by its resistance over the matched one's, its spring matched."""

    turning: Annotated[bool, Meta(description="whether it acts against turning there; else across")] = False
    resistance: Annotated[float, Meta(ge=0, description="of its dashpot, kg/s; N m s turning")] | None = None
    stiffness: (
        Annotated[float, Meta(ge=0, description="of its spring, N/m; N m/rad turning; with resistance")] | None
    ) = None
    mass: Annotated[float, Meta(ge=0, description="kg; kg m^2 turning; with resistance")] | None = None
    ratio: Annotated[float, Meta(ge=0, description="of its resistance to the matched one")] | None = None
    model: Annotated[str, model_meta(_WHOLE, "solve_harmonic")] | None = None
    count: Size | None = None
    alone: Annotated[bool, Meta(description="without the scene's other devices; with model")] = False

    def __post_init__(self) -> None:
        if self.model is not None:
            catalogue.check_count(self.model, self.count)
        elif self.count is not None:
            raise InputError(f"count = {self.count!r}: a half-infinite beam has no parts, give model as well")
        elif self.alone:
            raise InputError("alone = True: a half-infinite beam has no other device, give model as well")
        if (self.ratio is None) == (self.resistance is None):
            raise InputError(f"ratio = {self.ratio!r} and resistance = {self.resistance!r}: give one of the two")
        for name in ("stiffness", "mass"):
            if self.ratio is not None and (value := getattr(self, name)) is not None:
                raise InputError(f"{name} = {value!r}: with ratio spring and mass are the matched ones, leave it out")


def _layer_speed(a: Layer, scene: "Scene", bench: Workbench) -> float:
    from verify.contact.layer import no_load_speed

    return no_load_speed(a.contact_half_angle, a.epsilon)


def _layer_force(a: LayerAt, scene: "Scene", bench: Workbench) -> float:
    from verify.contact.layer import force

    return force(a.contact_half_angle, a.speed_ratio, a.epsilon)


def _layer_efficiency(a: CoulombLayerAt, scene: "Scene", bench: Workbench) -> float:
    from verify.contact.layer import efficiency

    return efficiency(a.contact_half_angle, a.speed_ratio)


def _landing(a: Shaken, scene: "Scene", bench: Workbench) -> float:
    from verify.contact.bouncing import landing_phase

    return landing_phase(a.acceleration_ratio)


def _restitution(a: Landing, scene: "Scene", bench: Workbench) -> float:
    from verify.contact.landing import damping_ratio, restitution

    if a.mass is None or a.stiffness is None or a.damping is None:
        assert a.damping_ratio is not None
        return restitution(a.damping_ratio)
    return restitution(damping_ratio(a.mass, a.stiffness, a.damping))


def _ending(a: Device, scene: "Scene", *, turning: bool = False) -> "Ending":
    """Raises InputError off the beam, and on a support where a device does nothing."""
    from verify.waves.absorber import ending

    if a.position >= scene.beam.length:
        raise InputError(f"position = {a.position!r} lies off the beam: give less than {scene.beam.length!r} m")
    hertz, support = drive_frequency(a, scene), scene.beam.supports[1]
    return ending(scene.beam, hertz, a.position, support, turning=turning)


def _impedance(a: Device, scene: "Scene", bench: Workbench) -> complex:
    return _ending(a, scene).matched


def _turning_impedance(a: Device, scene: "Scene", bench: Workbench) -> complex:
    return _ending(a, scene, turning=True).matched


def _device(a: Absorbing, scene: "Scene", matched: complex) -> complex:
    """Its impedance, kg/s, where `matched` reflects nothing."""
    omega = 2.0 * pi * drive_frequency(a, scene)
    if a.ratio is not None:
        return complex(a.ratio * matched.real, matched.imag)
    return complex(a.resistance or 0.0, omega * (a.mass or 0.0) - (a.stiffness or 0.0) / omega)


def _reflection(a: Absorbing, scene: "Scene", bench: Workbench) -> float:
    from verify.waves.absorber import reflection

    end = _ending(a, scene, turning=a.turning)
    impedance = _device(a, scene, end.matched)
    return reflection(impedance, end) if a.model is None else _left_on_beam(a, scene, impedance)


def _left_on_beam(a: Absorbing, scene: "Scene", impedance: complex) -> float:
    """The same of a model's whole beam, between its forces and the device, in the middle half."""
    from verify.device import of_impedance
    from verify.waves.devices import field_with_devices
    from verify.waves.driven import measured_alone

    assert a.model is not None
    model, hertz, (forces, others) = MODELS.named(a.model), drive_frequency(a, scene), _beside(a, scene)
    if impedance:
        own = of_impedance(scene.beam.length - a.position, impedance, 2.0 * pi * hertz, turning=a.turning)
        others = [*others, own]
    field = field_with_devices(
        lambda beam, given, hertz: model.solve_harmonic(beam, given, hertz, a.count),
        scene.beam,
        forces,
        hertz,
        others,
    )
    return measured_alone(field, None, "reflection")


def _beside(a: Absorbing, scene: "Scene") -> "tuple[list[PointForce], list[OnBeam]]":
    """Forces and devices of the scene beside a device, which stands in the place of what acts where it does.

    Raises InputError where no force is left, or one of them stands in the middle half.
    """
    from verify.waves.measures import middle_half
    from verify.waves.window import check_window

    beam, at = scene.beam, scene.beam.length - a.position
    if scene.drive is not None and scene.drive.kind != "force":
        raise InputError(f"drive.kind = {scene.drive.kind!r}: beside a device forces drive the beam, give 'force'")
    forces = [force for force in scene.forces if abs(force.position - at) > 1e-9 * beam.length]
    others = [one for one in scene.devices if not a.alone and abs(one.position - at) > 1e-9 * beam.length]
    if not forces:
        raise InputError("drive.force: no force is left beside the device to drive the beam, add one")
    places = [at, *(force.position for force in forces), *(one.position for one in others if one.across)]
    turning = [one.position for one in others if one.turning]
    check_window(beam, places, drive_frequency(a, scene), middle_half(beam), turning)
    return forces, others


def _needs_device(a: Device, scene: "Scene") -> tuple[()]:
    """Raise InputError where no device can stand."""
    _ending(a, scene, turning=isinstance(a, Absorbing) and a.turning)
    if isinstance(a, Absorbing) and a.model is not None:
        _beside(a, scene)
    return ()


def _needs_turning(a: Device, scene: "Scene") -> tuple[()]:
    """The same against turning."""
    _ending(a, scene, turning=True)
    return ()


CONTACT_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "slider.winkler_speed_ratio",
        "1",
        "No-load speed of a rigid slider on a driving layer of springs, over the speed of the crests.",
        Layer,
        "closed form",
        _layer_speed,
    ),
    Quantity(
        "slider.layer_force",
        "1",
        "Force on that slider at a speed, over mu N.",
        LayerAt,
        "closed form",
        _layer_force,
    ),
    Quantity(
        "slider.layer_efficiency",
        "1",
        "Power on that slider over power into the layer, with Coulomb's friction.",
        CoulombLayerAt,
        "closed form",
        _layer_efficiency,
    ),
    Quantity(
        "contact.landing_phase",
        "rad",
        "Phase of a shaking surface at which a mass that has left it lands first.",
        Shaken,
        "closed form",
        _landing,
    ),
    Quantity(
        "contact.restitution",
        "1",
        "Speed after over speed before a landing on a spring beside a dashpot, which press and do not pull.",
        Landing,
        "closed form",
        _restitution,
    ),
    Quantity(
        "wave.absorber_impedance",
        "kg/s",
        "Impedance of a device near the right end that reflects nothing: force over velocity.",
        Device,
        "harmonic",
        _impedance,
        needs=_needs_device,
        devices=True,
    ),
    Quantity(
        "wave.absorber_turning_impedance",
        "N m s",
        "The same of one against turning: couple over speed of turning.",
        Device,
        "harmonic",
        _turning_impedance,
        needs=_needs_turning,
        devices=True,
    ),
    Quantity(
        "wave.absorber_reflection",
        "1",
        "Gamma that a device leaves of a wave from the left: there on a half-infinite beam, or a model's middle half.",
        Absorbing,
        "harmonic",
        _reflection,
        needs=_needs_device,
        devices=True,
    ),
)
