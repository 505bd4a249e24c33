"""A scene file read, checked, and turned into values: what exists, and what is asked of it."""

from collections.abc import Callable, Iterable, Iterator
from functools import lru_cache, partial
from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias, cast

import msgspec
from msgspec import Meta

from verify.beam import Beam, PointForce, check_frequency
from verify.checks import Relative, check_number
from verify.device import Device, check_moved
from verify.errors import InputError, near_name, raise_all, shown
from verify.files import exists
from verify.motion.starting import soft_start
from verify.options import REFERENCES, DriveKind, Reference, Start
from verify.scenes.checked import checked
from verify.scenes.claims import Claim
from verify.scenes.given import as_meant, type_at_key
from verify.scenes.overrides import forget_what_is_no_more, set_twice
from verify.scenes.problems import MOST, problems
from verify.scenes.sections import ON_WHAT_EXISTS, SECTIONS
from verify.scenes.toml import override, read_toml
from verify.slider import Slider

PACKAGED = Path(__file__).parent
STARTER = PACKAGED / "starter.toml"

Count: TypeAlias = Annotated[int, Meta(ge=1)]
Counts: TypeAlias = Annotated[tuple[Count, ...], Meta(min_length=1)]


class SceneForce(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point force as a scene states it: its distance from one end of the beam."""

    position: float
    """Metres from the end that `measured_from` names."""
    measured_from: Literal["left", "right"] = "left"
    """The end of the beam from which `position` counts."""
    amplitude: float = 1.0
    """Newton, or metres where the drive imposes displacements."""
    phase_deg: float = 0.0
    """Degrees, of cos(omega t + phase)."""

    def on(self, beam: Beam) -> PointForce:
        """The force in the beam's own coordinate. Raises InputError where it lies off the beam."""
        check_number("drive.force.position", self.position, "metres")
        if not 0 <= self.position <= beam.length:
            raise InputError(
                f"drive.force.position = {self.position!r} lies off the beam: "
                f"give a position between 0 and {beam.length!r} m"
            )
        x = self.position if self.measured_from == "left" else beam.length - self.position
        return PointForce(position=x, amplitude=self.amplitude, phase_deg=self.phase_deg)


class SceneDevice(Device, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A device as a scene states it: its distance from one end of the beam."""

    measured_from: Literal["left", "right"] = "left"
    """The end of the beam from which `position` counts."""

    def on(self, beam: Beam) -> Device:
        """The device in the beam's own coordinate. Raises InputError where it is off the beam or on a support."""
        own = {name: getattr(self, name) for name in Device.__struct_fields__}
        if not self.position <= beam.length:
            raise InputError(
                f"drive.device.position = {self.position!r} lies off the beam: "
                f"give a position between 0 and {beam.length!r} m"
            )
        if self.measured_from == "right":
            own["position"] = beam.length - self.position
        found = Device(**own)
        found.check_on(beam)
        return found


class Drive(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What shakes the beam at one frequency: harmonic point forces, or displacements imposed at points."""

    frequency_hz: float
    """Hertz."""
    kind: DriveKind = "force"
    """What the amplitudes mean: newton, or metres. The paper does not say; its frequency rule fits forces."""
    force: tuple[SceneForce, ...] = ()
    """Where it acts, how strongly and with which phase."""
    device: tuple[SceneDevice, ...] = ()
    """What stands on the beam beside the forces and takes up the wave, or drives it: in the steady state alone."""

    def __post_init__(self) -> None:
        check_number("drive.frequency_hz", self.frequency_hz, "hertz", above=0)
        if self.device and self.kind != "force":
            raise InputError(f"drive.kind = {self.kind!r}: beside a drive.device forces drive the beam, give 'force'")


STEPS_PER_PERIOD = 128
"""Of a slider in a scene, unless given."""


class MotionAsk(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the driven beam in time: from rest or steady, with the scene's slider if there is one."""

    duration: float = 1e-3
    """Seconds."""
    start: Start = "rest"
    soft_start_periods: float | None = None
    """Over which the forces grow: two from rest unless given. 0 is a step load, because cos(0) = 1, under which a
    slider's path does not converge with the size."""
    modal_damping: Relative | None = None
    """Ratio of every mode; what the beam's loss factor comes to in each unless given."""
    count: Count = 49
    """Segments and elements of the figures."""
    counts: Counts = (49, 98, 196)
    """Of the work against error."""
    steps_per_period: Count = STEPS_PER_PERIOD
    """A slider's, at least; more where the start excites faster modes. Another is refused without a slider."""
    samples: Annotated[int, Meta(ge=2, le=100_000)] = 1001
    """Instants that are kept, both ends among them."""

    def __post_init__(self) -> None:
        check_number("motion.duration", self.duration, "seconds", above=0)
        if self.soft_start_periods is not None:
            check_number("motion.soft_start_periods", self.soft_start_periods, "periods", at_least=0)
        if self.modal_damping is not None:
            check_number("motion.modal_damping", self.modal_damping, "ratio", at_least=0, below=1)
        if self.start == "steady" and self.soft_start_periods:
            raise InputError(
                f"motion.soft_start_periods = {self.soft_start_periods!r} with start = 'steady': a steady beam has no "
                "start, leave it out"
            )

    @property
    def soft_start(self) -> float:
        """Periods over which the forces grow; 0 where the motion has no start."""
        return soft_start(self.start, self.soft_start_periods)


class Complex(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A complex expectation, { re, im }."""

    re: float
    """Real part, in the quantity's own unit."""
    im: float
    """Imaginary part, likewise."""

    def __post_init__(self) -> None:
        check_number("expect.re", self.re, "in the quantity's own unit")
        check_number("expect.im", self.im, "in the quantity's own unit")


class Gate(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """One named figure and the band it has to lie in.

    `expect` with `within` is a two-sided band, for a complex `expect = { re, im }` a disc; `at_least` and
    `at_most` bound one side each; a two-sided bound
    (`mode.bracket`) needs `expect` alone, the value it has to contain. Raises InputError where the band is
    none of these.
    """

    id: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9_-]*$")]
    """Letters, digits, _ and -; by it `--set gate.ID.within=...` and pytest name the gate."""
    quantity: str
    """As `verify quantities` names it."""
    arguments: dict[str, Any] = {}
    """Of the quantity, by name."""
    expect: Relative | Complex | None = None
    """The middle of the band, in the quantity's own unit; { re, im } where it is complex."""
    within: Relative | None = None
    """Half the width of the band; of a complex expectation its radius."""
    at_least: Relative | None = None
    """The lowest value that passes."""
    at_most: Relative | None = None
    """The highest value that passes."""
    reference: Reference | None = None
    uncertainty: Relative | None = None
    """How far the reference may itself be off, digits left out included; 0 where it is exact."""
    source: str = ""
    """Of the reference, in a few words: an equation, a publication, a derivation."""
    why: Annotated[str, Meta(min_length=1)]
    """Where the expectation comes from."""

    def __post_init__(self) -> None:
        for name in ("expect", "within", "at_least", "at_most"):
            if (value := getattr(self, name)) is not None and not isinstance(value, Complex):
                check_number(f"gate.{self.id}.{name}", value, "in the quantity's own unit")
        if self.within is not None and (self.expect is None or self.within <= 0):
            raise InputError(f"gate.{self.id}.within = {self.within!r}: give it above 0 and together with expect")
        bounded = self.at_least is not None or self.at_most is not None
        if bounded == (self.expect is not None):
            raise InputError(f"gate.{self.id} has no clear band: give expect with within, or at_least, at_most")
        if self.at_least is not None and self.at_most is not None and self.at_least > self.at_most:
            raise InputError(
                f"gate.{self.id}.at_least = {self.at_least!r} is above at_most = {self.at_most!r}: exchange them"
            )
        self._check_reference()

    def _check_reference(self) -> None:
        """Raise InputError for an uncertainty that is none, or for one, or a source, of a reference not said."""
        if self.uncertainty is not None:
            check_number(f"gate.{self.id}.uncertainty", self.uncertainty, "in the quantity's own unit", at_least=0)
        for name, given in (("uncertainty", self.uncertainty is not None), ("source", bool(self.source))):
            if given and self.reference is None:
                raise InputError(
                    f"gate.{self.id}.{name} = {shown(getattr(self, name))} is of a reference that is not said: "
                    f"give gate.{self.id}.reference as one of {', '.join(REFERENCES)}"
                )


class Scene(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What exists, what is published about it, and what is asked. What is not asked does not run.

    A scene that is loaded has a field for the section of every study beside these; see `scene_type`.
    """

    name: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=120)]
    """Of the scene, also of its report's file, hence no longer than a file's name."""
    title: str = ""
    """Above its report."""
    description: str = ""
    """A sentence below the title."""
    beam: Beam
    drive: Drive | None = None
    slider: Slider | None = None
    motion: MotionAsk | None = None
    claim: tuple[Claim, ...] = ()
    gate: tuple[Gate, ...] = ()

    def __post_init__(self) -> None:
        raise_all(list(dict.fromkeys(self._wrong())), MOST)

    def _wrong(self) -> Iterator[str]:
        """A sentence for everything that does not go together, though each part is right by itself."""
        for check in (self._check_names, self._check_claims, self._check_what_exists, *self._section_checks()):
            try:
                check()
            except InputError as error:
                yield from error.sentences

    def _check_names(self) -> None:
        _check_ids("gate", [gate.id for gate in self.gate])
        _check_ids("claim", [claim.id for claim in self.claim])

    def _check_what_exists(self) -> None:
        """Raise InputError for a drive or a slider that this beam cannot have."""
        if self.drive is not None:
            check_frequency("drive.frequency_hz", self.drive.frequency_hz, self.beam)
        forces, _ = self.forces, self.devices  # built here, so that one off the beam is refused with the scene
        if self.drive is not None and self.drive.kind == "force":
            check_moved(forces, self.beam)
        if self.slider is not None:
            self.slider.start_on(self.beam)
        if self.motion is not None:
            self._check_motion(self.motion)

    def _check_motion(self, asked: MotionAsk) -> None:
        """Raise InputError for a motion without forces or with devices, and for steps without a slider to take them."""
        if not self.forces:
            raise InputError("motion: a beam moves in time under a [drive] with forces, add them")
        self.refuse_devices("motion: a beam in time", "motion")
        if self.slider is None and asked.steps_per_period != STEPS_PER_PERIOD:
            raise InputError(
                f"motion.steps_per_period = {asked.steps_per_period!r} is a slider's and the scene has none: a beam "
                "alone takes no steps, leave it out or add [slider]"
            )

    def _section_checks(self) -> Iterator[Callable[[], None]]:
        """What each study's section asks of the rest of the scene."""
        for name in self.__struct_fields__[len(Scene.__struct_fields__) :]:
            if (asked := getattr(self, name)) is not None:
                if not getattr(SECTIONS[name], "devices", False):
                    yield partial(self.refuse_devices, f"{name}: this study", name)
                yield partial(SECTIONS[name].check_on, asked, self)

    def _check_claims(self) -> None:
        """Raise InputError for a claim about a run that the scene has not."""
        for claim in self.claim:
            if claim.of_run and (self.slider is None or self.motion is None):
                missing = "slider" if self.slider is None else "motion"
                raise InputError(
                    f"claim.{claim.id} is about the run of a slider and the scene has no [{missing}]: add it, or give "
                    "the claim arguments of its own"
                )

    @property
    def bare(self) -> "Scene":
        """What exists alone, without the sections of studies: the scene that a study varies."""
        return Scene(**{name: getattr(self, name) for name in Scene.__struct_fields__})

    @property
    def forces(self) -> tuple[PointForce, ...]:
        """The driving forces in the beam's own coordinate."""
        return tuple(force.on(self.beam) for force in self.drive.force) if self.drive else ()

    @property
    def devices(self) -> tuple[Device, ...]:
        """The drive's devices in the beam's own coordinate."""
        return tuple(device.on(self.beam) for device in self.drive.device) if self.drive else ()

    def refuse_devices(self, what: str, section: str = "") -> None:
        """Raise InputError, for something that knows no device on the beam, where the drive has one.

        `section` is the scene's own that asks for it.
        """
        for device in self.devices:
            either = f"drive.device or [{section}]" if section else "drive.device"
            raise InputError(
                f"{what} knows no drive.device, and one stands at {device.position:g} m: leave out {either}; a gate of "
                "the steady wave, as wave.reflection, and [methods] know it, and everything knows [[beam.spring]] and "
                "[[beam.mass]]"
            )


def scene_type(keys: Iterable[str] | None = None) -> type[Scene]:
    """`Scene` with a field for the section of every study: those among `keys` of their type, or all of them.

    A study of another package is looked up where a key is not known here. Raises InputError where it cannot be used.
    """
    for key in set(keys or ()) - {*Scene.__struct_fields__, *SECTIONS.own()}:
        SECTIONS.get(key)  # looks into other packages
    names = [name for name in SECTIONS.own() if name not in ON_WHAT_EXISTS]
    wanted = set(names) if keys is None else set(keys)
    return _with_sections(tuple((name, SECTIONS[name].section if name in wanted else None) for name in names))


@lru_cache(maxsize=64)
def _with_sections(sections: tuple[tuple[str, type[msgspec.Struct] | None], ...]) -> type[Scene]:
    """None in place of a type: nothing can stand there, and nothing is imported for it."""
    fields = [(name, kind and kind | None, None) for name, kind in sections]
    made = msgspec.defstruct(
        "Scene", fields, bases=(Scene,), frozen=True, kw_only=True, forbid_unknown_fields=True, module=__name__
    )
    return cast(type[Scene], made)


def _check_ids(table: str, ids: list[str]) -> None:
    """Raise InputError where an id stands twice."""
    seen: set[str] = set()
    for one in ids:
        if one in seen:
            raise InputError(f"{table}.{one} stands twice: give every {table} an id of its own")
        seen.add(one)


def packaged_scenes() -> tuple[str, ...]:
    """The names of the scenes that come with the package."""
    return tuple(sorted(path.stem for path in PACKAGED.glob("*.toml") if path != STARTER))


def scene_path(name_or_path: str) -> Path:
    """The file of a packaged scene, or the path itself. Raises InputError for an unknown name."""
    if name_or_path in packaged_scenes():
        return PACKAGED / f"{name_or_path}.toml"
    path = Path(name_or_path)
    if exists(path, "scene") or path.suffix or len(path.parts) != 1:
        return path
    remedy = near_name(name_or_path, packaged_scenes())
    raise InputError(f"scene = {shown(name_or_path)} is neither a packaged scene nor a file: {remedy}")


def load_scene(name_or_path: str | Path, overrides: tuple[str, ...] = ()) -> Scene:
    """A packaged scene by name, any other by path, with 'key=value' overrides.

    Raises InputError, or WrongSceneError with a sentence for each where several things are wrong.
    """
    data = tables_of(name_or_path, overrides)
    kind = scene_type(data)
    try:
        return checked(data, kind)
    except InputError:
        raise_all(problems(data, kind), MOST)
        raise


def tables_of(name_or_path: str | Path, overrides: tuple[str, ...] = ()) -> dict[str, Any]:
    """The plain tables of a scene with its overrides, not yet checked. Raises InputError."""
    if not isinstance(overrides, tuple | list) or not all(isinstance(text, str) for text in overrides):
        raise InputError(f"overrides = {overrides!r}: give a list of 'key=value' words")
    data = read_toml(scene_path(str(name_or_path)))
    wrong = set_twice(overrides)
    for assignment in overrides:
        try:
            override(data, assignment, _meant)
        except InputError as error:
            wrong += error.sentences
    raise_all(wrong, MOST)
    forget_what_is_no_more(data, overrides)
    return data


def _meant(value: Any, key: str) -> Any:
    """What an override gives, as the type of its key takes it."""
    return as_meant(value, type_at_key(scene_type([key.split(".", maxsplit=1)[0]]), key), key)
