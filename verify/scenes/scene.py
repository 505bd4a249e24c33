"""A scene file read, checked, and turned into values: what exists, and what is asked of it."""

from pathlib import Path
from typing import Annotated, Any, Literal, TypeAlias

import msgspec
from msgspec import Meta

from verify.beam import Beam, PointForce, check_frequency, check_number
from verify.errors import InputError, near_name, shown
from verify.files import exists
from verify.options import DriveKind, Start
from verify.scenes.checked import checked
from verify.scenes.claims import Claim, ReadingsAsk
from verify.slider import Slider

PACKAGED = Path(__file__).parent
STARTER = PACKAGED / "starter.toml"
_LARGE = "TOML's whole numbers have 64 bits, write a large number as 1e30"

Count: TypeAlias = Annotated[int, Meta(ge=1)]
Counts: TypeAlias = Annotated[tuple[Count, ...], Meta(min_length=1)]


class SceneForce(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A point force as a scene states it: its distance from one end of the beam."""

    position: float
    """Metres from the end that `measured_from` names."""
    measured_from: Literal["left", "right"] = "left"
    amplitude: float = 1.0
    phase_deg: float = 0.0

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


class Drive(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What shakes the beam at one frequency: harmonic point forces, or displacements imposed at points."""

    frequency_hz: float
    kind: DriveKind = "force"
    """What the amplitudes mean: newton, or metres. The paper does not say; its frequency rule fits forces."""
    force: tuple[SceneForce, ...] = ()

    def __post_init__(self) -> None:
        check_number("drive.frequency_hz", self.frequency_hz, "hertz", above=0)


class Spectrum(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the error of modes 1..modes of both discrete models at one size."""

    modes: Annotated[int, Meta(ge=1, le=10_000)] = 22
    count: Count = 49


class Convergence(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the error of a few modes of both discrete models over several sizes."""

    modes: Counts = (1, 5, 22)
    counts: Counts = (10, 20, 49, 98)


class Sensitivity(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask how one exact frequency moves with modulus and density, beside a figure somebody published."""

    mode: Count
    published_hz: float | None = None
    modulus_spread: float = 0.03
    density_spread: float = 0.03

    def __post_init__(self) -> None:
        check_number("sensitivity.modulus_spread", self.modulus_spread, "relative", above=0, below=1)
        check_number("sensitivity.density_spread", self.density_spread, "relative", above=0, below=1)
        if self.published_hz is not None:
            check_number("sensitivity.published_hz", self.published_hz, "hertz", above=0)


class Wave(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the driven beam: the motor's figures over sizes, envelopes, ellipses, a map with operating points."""

    count: Count = 49
    """Segments and elements of the envelopes and, with `model`, of the map."""
    counts: Counts = (49, 98, 196)
    model: Literal["analytic", "fem", "segment"] = "segment"
    quantity: str = "wave.standing_wave_ratio"
    frequency_hz: tuple[float, float, int] = (4000.0, 4600.0, 121)
    """Start, end and steps of the map."""
    phase_deg: tuple[float, float, int] = (0.0, 180.0, 91)
    reflection_limit: float = 0.1
    operating_loss_factor: float = 1e-3
    """For the operating points where the beam is undamped: without losses the crest speed has no bound."""

    def __post_init__(self) -> None:
        for name in ("frequency_hz", "phase_deg"):
            start, end, steps = getattr(self, name)
            check_number(f"wave.{name}[0]", start, "start of the map", above=0 if name == "frequency_hz" else -3600)
            check_number(f"wave.{name}[1]", end, "end of the map", above=start)
            check_number(f"wave.{name}[2]", steps, "steps of the map", above=1, below=2001)
        check_number("wave.reflection_limit", self.reflection_limit, "relative", above=0, below=1)
        check_number("wave.operating_loss_factor", self.operating_loss_factor, "eta", above=0, below=1)


class MotionAsk(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the driven beam in time: from rest or steady, with the scene's slider if there is one."""

    duration: float = 1e-3
    """Seconds."""
    start: Start = "rest"
    soft_start_periods: float = 0.0
    """Over which the forces grow; 0 is a step load, because cos(0) = 1."""
    modal_damping: float | None = None
    """Ratio of every mode; half the beam's loss factor unless given."""
    count: Count = 49
    """Segments and elements of the figures."""
    counts: Counts = (49, 98, 196)
    """Of the work against error."""
    steps_per_period: Count = 128
    """At least; more where the start excites faster modes."""
    samples: Annotated[int, Meta(ge=2, le=100_000)] = 1001

    def __post_init__(self) -> None:
        check_number("motion.duration", self.duration, "seconds", above=0)
        check_number("motion.soft_start_periods", self.soft_start_periods, "periods", at_least=0)
        if self.modal_damping is not None:
            check_number("motion.modal_damping", self.modal_damping, "ratio", at_least=0, below=1)
        if self.start == "steady" and self.soft_start_periods:
            raise InputError(
                f"motion.soft_start_periods = {self.soft_start_periods!r} with start = 'steady': a steady beam has no "
                "start, leave it out"
            )


class AxialInertia(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask how far a chain of rigid links departs from the linear one through its axial inertia, over the force."""

    forces: Annotated[tuple[float, ...], Meta(min_length=1)] = (0.1, 1.0, 10.0, 30.0)
    """Newton: amplitudes that all forces of the drive take in turn."""
    shown: float = 10.0
    """Newton: the amplitude at which all models stand side by side."""
    count: Annotated[int, Meta(ge=2, le=250)] = 49
    """Links, and elements beside them; an adaptive step costs O(N^3) over a given time."""
    duration: float = 1e-3
    """Seconds from rest."""
    x: float | None = None
    """Metres from the left end where the deflection is read; mid-span unless given."""

    def __post_init__(self) -> None:
        for i, force in enumerate(self.forces):
            check_number(f"axial_inertia.forces[{i}]", force, "newton", above=0)
        check_number("axial_inertia.shown", self.shown, "newton", above=0)
        check_number("axial_inertia.duration", self.duration, "seconds", above=0, below=0.1)
        if self.x is not None:
            check_number("axial_inertia.x", self.x, "metres", above=0)

    def check_on(self, beam: Beam, drive: Drive | None) -> None:
        """Raise InputError unless the beam is a chain with a tip that slides, undamped and driven by forces."""
        if drive is None or drive.kind != "force" or not drive.force:
            raise InputError("axial_inertia: the chain is driven by forces, give the scene a [drive] of kind force")
        if beam.supports not in (("pinned", "pinned"), ("clamped", "pinned"), ("clamped", "free")) or beam.stepped:
            raise InputError(
                f"axial_inertia with beam.supports = {list(beam.supports)!r}: give a uniform beam that is pinned or "
                "clamped on the left and pinned, or free behind a clamp, on the right"
            )
        if beam.loss_factor:
            raise InputError(
                f"axial_inertia with beam.loss_factor = {beam.loss_factor!r}: its chains move undamped, give 0"
            )
        if self.x is not None and self.x > beam.length:
            raise InputError(f"axial_inertia.x = {self.x!r} lies off the beam: give up to {beam.length!r} m")


class Complex(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A complex expectation, { re, im }."""

    re: float
    im: float

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
    quantity: str
    arguments: dict[str, Any] = {}
    expect: float | Complex | None = None
    within: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    why: Annotated[str, Meta(min_length=1)]

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


class Scene(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What exists, what is published about it, and what is asked. What is not asked does not run."""

    name: Annotated[str, Meta(pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$", max_length=120)]
    """Also of its report's file, hence not longer."""
    title: str = ""
    description: str = ""
    beam: Beam
    drive: Drive | None = None
    spectrum: Spectrum | None = None
    convergence: Convergence | None = None
    sensitivity: Sensitivity | None = None
    wave: Wave | None = None
    slider: Slider | None = None
    motion: MotionAsk | None = None
    readings: ReadingsAsk | None = None
    axial_inertia: AxialInertia | None = None
    claim: tuple[Claim, ...] = ()
    gate: tuple[Gate, ...] = ()

    def __post_init__(self) -> None:
        _check_ids("gate", [gate.id for gate in self.gate])
        _check_ids("claim", [claim.id for claim in self.claim])
        for claim in self.claim:
            if claim.of_run and (self.slider is None or self.motion is None):
                missing = "slider" if self.slider is None else "motion"
                raise InputError(
                    f"claim.{claim.id} is about the run of a slider and the scene has no [{missing}]: add it, or give "
                    "the claim arguments of its own"
                )
        if self.drive is not None:
            check_frequency("drive.frequency_hz", self.drive.frequency_hz, self.beam)
        forces = self.forces  # built here, so that one off the beam is refused with the scene
        if self.wave is not None and len(forces) != 2:
            raise InputError("wave: the studies of a wave take a [drive] with two forces, add them")
        if self.slider is not None:
            self.slider.start_on(self.beam)
        if self.motion is not None and not forces:
            raise InputError("motion: a beam moves in time under a [drive] with forces, add them")
        if self.axial_inertia is not None:
            self.axial_inertia.check_on(self.beam, self.drive)
        if self.readings is not None:
            self.readings.check_on(self)

    @property
    def forces(self) -> tuple[PointForce, ...]:
        """The driving forces in the beam's own coordinate."""
        return tuple(force.on(self.beam) for force in self.drive.force) if self.drive else ()


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


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file. Raises InputError where it cannot be read or is not TOML."""
    import tomllib

    exists(path, "scene")
    try:
        data = tomllib.loads(path.read_bytes().decode("utf-8-sig"))
        return {key: _whole(value, f"scene file {str(path)!r}: {key}") for key, value in data.items()}
    except OSError as error:
        raise InputError(f"scene file {str(path)!r} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise InputError(f"scene file {str(path)!r} is not text in UTF-8: save it as TOML in UTF-8") from None
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise InputError(f"scene file {str(path)!r} is not TOML: {error}") from None
    except InputError:
        raise
    except ValueError:  # Python reads no whole number of more than 4300 digits
        raise InputError(f"scene file {str(path)!r} has a number of thousands of digits: {_LARGE}") from None


def _whole(data: Any, where: str) -> Any:
    """The same data. Raises InputError for a whole number beyond TOML's 64 bits, named by its key."""
    if isinstance(data, dict | list):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            _whole(value, f"{where}[{key}]" if isinstance(data, list) else f"{where}.{key}")
    if isinstance(data, int) and not -(2**63) <= data < 2**63:
        raise InputError(f"{where} = {shown(data)}: {_LARGE}")
    return data


def literal(text: str, field: str = "value") -> Any:
    """A TOML literal; a bare word is a string; comma-separated values are a list. Raises InputError.

    `field` is what messages call it.
    """
    import tomllib

    try:
        return _whole(tomllib.loads(f"value = {text}")["value"], field)
    except InputError:
        raise
    except (ValueError, KeyError, RecursionError):  # tomllib's own, and Python's for more than 4300 digits
        if "," in text and not text.lstrip().startswith(("[", "{", '"', "'")):
            return [literal(part.strip(), field) for part in text.split(",") if part.strip()]
        return text


def split_assignment(text: str) -> tuple[str, Any]:
    """'key=value' as key and literal. Raises InputError where there is no '='."""
    key, equals, value = text.partition("=")
    if not equals or not key.strip() or not value.strip():
        raise InputError(f"{text!r} is not an assignment: write key=value, for instance mode=22")
    return key.strip(), literal(value.strip(), key.strip())


def given_arguments(assignments: tuple[str, ...]) -> dict[str, Any]:
    """'key=value' words as a dict. Raises InputError where a key stands twice."""
    given: dict[str, Any] = {}
    for text in assignments:
        key, value = split_assignment(text)
        if key in given:
            raise InputError(f"{key} is given twice, as {given[key]!r} and {value!r}: give it once")
        given[key] = value
    return given


def override(data: dict[str, Any], assignment: str) -> None:
    """Set one value of a scene's tables in place: 'beam.length=0.4', 'gate.ID.within=1e-6'."""
    key, value = split_assignment(assignment)
    *parents, last = key.split(".")
    here: Any = data
    for depth, step in enumerate(parents):
        here = _entry(here, step, ".".join(parents[: depth + 1]))
    if isinstance(here, list):
        here[_position(here, last, key)] = value
    else:
        here[last] = value


def _entry(here: Any, step: str, field: str) -> Any:
    """The table or list below `here`; a missing table is made, so that the checker can name it."""
    here = here[_position(here, step, field)] if isinstance(here, list) else here.setdefault(step, {})
    if not isinstance(here, dict | list):
        raise InputError(f"--set {field} is a value, not a table: set {field} itself")
    return here


def _position(entries: list[Any], step: str, field: str) -> int:
    """Where in a list an entry stands: by its id, or by its number from 0."""
    numbers = [str(i) for i in range(len(entries))]
    names = [str(e.get("id", i)) if isinstance(e, dict) else i for i, e in zip(numbers, entries, strict=True)]
    for known in (names, numbers):
        if step in known:
            return known.index(step)
    raise InputError(f"--set {field} names no entry: {near_name(step, names) if names else 'the list is empty'}")


def load_scene(name_or_path: str | Path, overrides: tuple[str, ...] = ()) -> Scene:
    """A packaged scene by name, any other by path, with 'key=value' overrides. Raises InputError."""
    if not isinstance(overrides, tuple | list) or not all(isinstance(text, str) for text in overrides):
        raise InputError(f"overrides = {overrides!r}: give a list of 'key=value' words")
    data = read_toml(scene_path(str(name_or_path)))
    for assignment in overrides:
        override(data, assignment)
    return checked(data, Scene)
