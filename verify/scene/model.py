"""The types of a scene file: drive, gates, claims, and the scene with its studies. Values, no numerics."""

from collections.abc import Iterator
from math import inf
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta

from verify.actuators.on_beam import BeamInTime, beam_in_time
from verify.actuators.patch import Patch
from verify.actuators.shunt import Load
from verify.actuators.transducers import Transducer
from verify.errors import InputError, raise_all
from verify.formatting import one_line
from verify.problem.base_motion import Base, Prescribed, polynomial, still, tabulated
from verify.problem.beam import Beam, PointForce, check_frequency
from verify.problem.device import Device
from verify.problem.slider import Slider
from verify.problem.supports import check_free
from verify.scene.file import NamedBeam
from verify.settings import DriveKind, Reference
from verify.validation import RULE, check_number, check_position, unit


class SceneForce(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point force, positioned from one end of the beam."""

    position: Annotated[float, unit("m")]
    """Distance from the end that `measured_from` names, m."""
    measured_from: Literal["left", "right"] = "left"
    """End of the beam from which `position` is measured."""
    amplitude: float = 1.0
    """N, N m, m, V or A by the kind of the drive."""
    phase_deg: float = 0.0
    """Phase of cos(omega t + phase), degrees."""

    def on(self, beam: Beam) -> PointForce:
        """The force in the beam's coordinate. Raises InputError for a position off the beam."""
        x = _from_left("drive.force.position", self.position, self.measured_from, beam)
        return PointForce(position=x, amplitude=self.amplitude, phase_deg=self.phase_deg)


class SceneDevice(Device, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A device, positioned from one end of the beam."""

    measured_from: Literal["left", "right"] = "left"
    """End of the beam from which `position` is measured."""

    def on(self, beam: Beam) -> Device:
        """The device in the beam's coordinate. Raises InputError off the beam or on a support."""
        fields = {name: getattr(self, name) for name in Device.__struct_fields__}
        fields["position"] = _from_left("drive.device.position", self.position, self.measured_from, beam)
        device = Device(**fields)
        device.check_on("device", beam.length, beam.supports)
        return device


class SceneShunt(Load, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A passive actuator with an electrical load, of the same design as the drive's, positioned from one end."""

    position: Annotated[float, unit("m")]
    """Of its tip, or of the middle of a patch, m from the end that `measured_from` names."""
    measured_from: Literal["left", "right"] = "left"
    """End of the beam from which `position` is measured."""

    def on(self, beam: Beam) -> tuple[float, Load]:
        """Position from the left end, m, and load. Raises InputError for a position off the beam."""
        load = Load(**{name: getattr(self, name) for name in Load.__struct_fields__})
        return _from_left("drive.shunt.position", self.position, self.measured_from, beam), load


def _from_left(field: str, position: float, side: str, beam: Beam) -> float:
    """Distance from the left end of a position measured from one end. Raises InputError off the beam."""
    check_number(field, position, "metres")
    check_position(field, position, beam.length)
    return position if side == "left" else beam.length - position


class Drive(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Harmonic excitation at one frequency: forces, moments or displacements at points, or actuators."""

    frequency_hz: Annotated[float, unit("Hz")]
    """Hz."""
    kind: DriveKind = "force"
    """Meaning of the amplitudes: N, N m, m, V or A. The paper does not say; its frequency rule fits forces."""
    force: tuple[SceneForce, ...] = ()
    """Point forces, moments, imposed displacements, or voltages or currents of actuators, by `kind`."""
    actuator: Transducer | Patch | None = None
    """Design of all actuators, for `kind` voltage or current and for shunts: stack, bar-33, bar-31, langevin, patch."""
    shunt: tuple[SceneShunt, ...] = ()
    """Passive actuators with an electrical load."""
    device: tuple[SceneDevice, ...] = ()
    """Impedances on the beam beside the forces, absorbing or driving: in the steady state only."""

    def __post_init__(self) -> None:
        check_number("drive.frequency_hz", self.frequency_hz, "hertz", above=0)
        if self.device and self.kind == "displacement":
            raise InputError(f"drive.kind = {self.kind!r}: with a drive.device the drive is by forces, give 'force'")
        if self.actuator is None and (self.shunt or self.kind in ("voltage", "current")):
            cause = "drive.shunt" if self.shunt else f"drive.kind = {self.kind!r}"
            raise InputError(f"drive.actuator is missing: {cause} needs the design of an actuator, give it a kind")
        if self.actuator and self.force and not self.shunt and self.kind not in ("voltage", "current"):
            remedy = "give 'voltage' or 'current', or leave drive.actuator out"
            raise InputError(f"drive.kind = {self.kind!r}: its amplitudes are not those of a drive.actuator, {remedy}")


class TimeTable(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A prescribed motion as values at times, between which a spline of degree 5 interpolates."""

    times: tuple[float, ...]
    """Six or more, ascending from 0, s."""
    values: tuple[float, ...]
    """Angle, rad, or coordinate, m, at each time."""


class MovingBase(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Prescribed motion of the base that carries the left end of the beam, which starts straight and moving with it.

    A motion is a table, or the coefficients of a polynomial in time: [0, 0, 0.2] is 0.2 t^2.
    """

    duration: Annotated[float, unit("s")]
    """Duration, s."""
    rotation: tuple[float, ...] | TimeTable = ()
    """Angle, rad."""
    x: tuple[float, ...] | TimeTable = ()
    """Coordinate of the axis of rotation along the beam at angle 0, m."""
    y: tuple[float, ...] | TimeTable = ()
    """Coordinate of the axis of rotation across the beam at angle 0, m."""
    hub_radius: float = 0.0
    """Distance of the beam's left end from the axis of rotation, m."""
    gravity: tuple[float, float] = (0.0, 0.0)
    """Along x and y of the ground, m/s^2."""

    def __post_init__(self) -> None:
        check_number("base.duration", self.duration, "seconds", above=0)
        for component in self.gravity:
            check_number("base.gravity", component, "m/s^2")
        _ = self.motion

    @property
    def motion(self) -> Base:
        """The motion in time. Raises InputError for a table that is none."""
        motions: dict[str, Prescribed] = {}
        for name in ("rotation", "x", "y"):
            motion = getattr(self, name)
            try:
                if isinstance(motion, TimeTable):
                    motions[name] = tabulated(motion.times, motion.values)
                else:
                    motions[name] = polynomial(*motion) if motion else still
            except InputError as error:
                raise InputError(f"base.{name}.{error}") from None
        return Base(hub_radius=self.hub_radius, **motions)


class Complex(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A complex expected value, { re, im }."""

    re: float
    """Real part, in the quantity's unit."""
    im: float
    """Imaginary part, in the quantity's unit."""

    def __post_init__(self) -> None:
        check_number("expect.re", self.re, "in the quantity's unit")
        check_number("expect.im", self.im, "in the quantity's unit")


_ID = "letters, digits, _ and -, with a letter or digit first"


class Limits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What gates and claims share: a quantity of interest and limits of its value."""

    id: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$", extra={RULE: _ID})]
    """Letters, digits, _ and -; the name in `--set gate.ID.within=...` and in pytest."""
    quantity: str
    """Name of the quantity, see `verify quantities`."""
    arguments: dict[str, Any] = {}
    """Arguments of the quantity by name."""
    at_least: float | None = None
    """Lower limit."""
    at_most: float | None = None
    """Upper limit."""

    def check(self, field: str, *numbers: str, other: object) -> None:
        """Raise InputError for numbers that are not finite, limits in the wrong order, and limits beside `other`."""
        for name in (*numbers, "at_least", "at_most"):
            if isinstance(value := getattr(self, name), float | int):
                check_number(f"{field}.{name}", value, "in the quantity's unit")
        if self.at_least is not None and self.at_most is not None and self.at_least > self.at_most:
            raise InputError(f"{field}.at_least = {self.at_least!r} is above at_most = {self.at_most!r}: exchange them")
        if (other is None) == (self.limits == ""):
            raise InputError(f"{field}.{numbers[0]}: give {numbers[0]} with {numbers[1]}, or at_least, at_most")

    @property
    def bounds(self) -> tuple[float, float]:
        """Lower and upper limit; infinite where a side is open."""
        return -inf if self.at_least is None else self.at_least, inf if self.at_most is None else self.at_most

    @property
    def limits(self) -> str:
        """'at least 0.02, at most 0.03'."""
        sides = (("at least", self.at_least), ("at most", self.at_most))
        return ", ".join(f"{side} {value:g}" for side, value in sides if value is not None)


class Gate(Limits, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An acceptance criterion: a quantity and the band in which its value has to lie.

    `expect` with `within` is a two-sided band, for a complex `expect = { re, im }` a disc; `at_least` and `at_most`
    bound one side each; a bracket (`mode.bracket`) takes `expect` alone, the value that it has to contain. Raises
    InputError where the band is none of these.
    """

    expect: float | Complex | None = None
    """Expected value, in the quantity's unit; { re, im } for a complex one."""
    within: float | None = None
    """Half the width of the band, or the radius of the disc, in the quantity's unit."""
    reference: Reference | None = None
    """Kind of the reference for the expected value."""
    why: Annotated[str, Meta(min_length=1)]
    """Source of the expected value: equation, publication or derivation, and its accuracy where it matters."""

    def __post_init__(self) -> None:
        if self.within is not None and (self.expect is None or self.within <= 0):
            raise InputError(f"gate.{self.id}.within = {self.within!r}: give it above 0 and together with expect")
        self.check(f"gate.{self.id}", "expect", "within", other=self.expect)


class Claim(Limits, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A published statement as a quantity of this package. It is compared with the computed value and is no gate.

    `value` is a number with a `tolerance`, or a sign; `at_least` and `at_most` bound one side each. A quantity of the
    slider without arguments is computed on the scene's own run. Raises InputError where it is none of these.
    """

    source: Annotated[str, Meta(min_length=1)]
    """Author, place and wording of the statement."""
    value: float | Literal["negative", "positive"] | None = None
    """Published number, or its sign."""
    tolerance: float | None = None
    """Half the last printed digit, or the reading error of a figure."""
    read: Literal["stated", "figure", "follows"]
    """Whether the source states it, shows it in a figure, or implies it."""

    def __post_init__(self) -> None:
        if (self.number is None) != (self.tolerance is None) or (self.tolerance is not None and self.tolerance <= 0):
            remedy = "give one above 0 with a number as value, none with a sign or a limit"
            raise InputError(f"claim.{self.id}.tolerance = {self.tolerance!r}: {remedy}")
        self.check(f"claim.{self.id}", "value", "tolerance", other=self.value)

    @property
    def number(self) -> float | None:
        """The published number; None for a sign or a limit."""
        return float(self.value) if isinstance(self.value, float | int) else None

    @property
    def expected(self) -> str:
        """'-0.015 ± 0.0005', 'negative', 'at least 0.02, at most 0.03'."""
        return self.limits or (f"{self.value:g} ± {self.tolerance:g}" if self.number is not None else str(self.value))

    def agrees(self, computed: float) -> bool:
        """Whether a computed value agrees with the statement; NaN never does."""
        if isinstance(self.value, str):
            return computed < 0.0 if self.value == "negative" else computed > 0.0
        if self.value is not None and self.tolerance is not None:
            return abs(computed - self.value) <= self.tolerance
        low, high = self.bounds
        return low <= computed <= high


class Scene(NamedBeam, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What exists, what is published about it, and which gates and studies run. Raises InputError.

    In a scene file the sections of studies stand beside these keys: [spectrum], [motor], ... (see `verify schema`).
    """

    drive: Drive | None = None
    """Harmonic excitation."""
    slider: Slider | None = None
    """Slider on the beam."""
    base: MovingBase | None = None
    """Prescribed motion of the base, for large motion in the plane."""
    claim: tuple[Claim, ...] = ()
    """Published statements, compared with computed values."""
    gate: tuple[Gate, ...] = ()
    """Acceptance criteria."""
    studies: dict[str, Any] = msgspec.field(default_factory=dict)
    """Studies by the names of their sections; in a file they stand at the top level."""
    __repr__ = one_line(name="", title="", gate="", studies="")

    def __post_init__(self) -> None:
        raise_all(list(self._errors()))

    def _errors(self) -> Iterator[str]:
        """A sentence for every inconsistency between parts that are right by themselves."""
        for table, entries in (("gate", self.gate), ("claim", self.claim)):
            ids = [entry.id for entry in entries]
            for name in dict.fromkeys(ids):
                if ids.count(name) > 1:
                    yield f"{table}.{name} occurs twice: give every {table} its own id"
        try:
            if self.drive is not None:
                check_frequency("drive.frequency_hz", self.drive.frequency_hz, self.beam)
            forces, _, shunts = self.forces, self.devices, self.shunts
            kind, actuator = (self.drive.kind, self.drive.actuator) if self.drive else ("force", None)
            bending = kind in ("voltage", "current") and isinstance(actuator, Patch)  # at its ends
            patches = [*(force.position for force in forces if bending), *(x for x, _ in shunts)]
            if isinstance(actuator, Patch) and patches:
                actuator.on(self.beam, patches)
            for force in forces if not (bending or kind == "displacement") else ():
                across, turning = {"amplitude": force.amplitude}, dict[str, float]()
                if kind == "moment":
                    across, turning = turning, across
                check_free("drive.force", force.position, self.beam.length, self.beam.supports, across, turning)
            if self.slider is not None:
                self.slider.initial_position(self.beam)
        except InputError as error:
            yield from error.sentences

    @property
    def motion(self) -> Any:
        """The section [motion]; None where the scene has none."""
        return self.studies.get("motion")

    @property
    def forces(self) -> tuple[PointForce, ...]:
        """Forces of the drive in the beam's coordinate."""
        return tuple(force.on(self.beam) for force in self.drive.force) if self.drive else ()

    @property
    def devices(self) -> tuple[Device, ...]:
        """Devices of the drive in the beam's coordinate."""
        return tuple(device.on(self.beam) for device in self.drive.device) if self.drive else ()

    @property
    def shunts(self) -> tuple[tuple[float, Load], ...]:
        """(position from the left end, m, load) of the drive's shunts."""
        return tuple(shunt.on(self.beam) for shunt in self.drive.shunt) if self.drive else ()

    @property
    def beside(self) -> str:
        """The field of the drive that few quantities and studies model: a device or a shunt; else empty."""
        if self.drive is None:
            return ""
        return "drive.device" if self.drive.device else "drive.shunt" if self.drive.shunt else ""

    def in_time(self, forces: tuple[PointForce, ...], frequency_hz: float) -> BeamInTime:
        """Beam and loads of the drive in time, with these amplitudes. Raises InputError for displacements."""
        kind, actuator = (self.drive.kind, self.drive.actuator) if self.drive else ("force", None)
        return beam_in_time(self.beam, kind, forces, actuator, frequency_hz, self.shunts)

    @property
    def bare(self) -> "Scene":
        """The scene without studies, claims and gates."""
        return msgspec.structs.replace(self, studies={}, claim=(), gate=())
