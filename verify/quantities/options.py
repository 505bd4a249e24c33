"""Annotated argument types and the option groups that several quantities share."""

from collections.abc import Sequence
from typing import Annotated

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify import settings
from verify.analysis.solution_cache import Settings
from verify.errors import InputError, near_name
from verify.linear.registry import MEAN, MODELS
from verify.problem.beam import PointForce, check_frequency
from verify.quantities.base import MODEL_NAME, Place, Scene
from verify.validation import Relative, unit


class ModelName(msgspec.Struct, frozen=True):
    """The models that an argument accepts."""

    verb: str  # method of `BeamModel` that the models implement
    sized: bool = False  # whether only discrete models are accepted
    mean: bool = False  # whether "mean", the middle of the models below and above, is accepted

    def names(self) -> tuple[str, ...]:
        """Accepted names in alphabetical order."""
        models = [m for m in MODELS.values() if m.can(self.verb) and (m.sized or not self.sized)]
        return (*sorted(m.name for m in models), *([MEAN] if self.mean else []))

    def check(self, name: str, field: str = "model") -> None:
        """Raise InputError, which suggests the nearest name, for a name that is not accepted."""
        if not (self.mean and name == MEAN):
            model = MODELS.get(name)
            if model is None or not model.can(self.verb) or (self.sized and not model.sized):
                raise InputError(f"{field} = {name!r} is not known: {near_name(name, self.names())}")


def model_name(description: str, verb: str, *, sized: bool = False, mean: bool = False) -> Meta:
    """Annotation of an argument that names a model."""
    return Meta(description=description, extra={MODEL_NAME: ModelName(verb, sized, mean)})


Mode = Annotated[int, Meta(ge=1, description="mode number, from 1, elastic modes only")]
Size = Annotated[int, Meta(ge=1, description="N, number of segments or elements; not for model = analytic")]
Sizes = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(description="three or more N, for instance 20,40,80")]
AnyModel = Annotated[str, model_name("model of the beam; mean: middle of segment and fem", "modes", mean=True)]
ModesModel = Annotated[str, model_name("model of the beam", "modes")]
DiscreteModel = Annotated[str, model_name("discrete model of the beam", "modes", sized=True)]
FieldModel = Annotated[str, model_name("model of the beam", "harmonic")]
DiscreteField = Annotated[str, model_name("discrete model of the beam", "harmonic", sized=True)]
TimeModel = Annotated[str, model_name("model of the beam", "time_basis")]
Frequency = Annotated[float, unit("Hz"), Meta(gt=0, description="drive frequency, Hz; default: the scene's")]
ModalDamping = Annotated[Relative, Meta(ge=0, lt=1, description="damping ratio of every mode")]
Wall = settings.Wall
TimeTheory = Annotated[settings.Theory, Meta(description="beam theory; in time Euler-Bernoulli alone")]
SoftStart = Annotated[float, Meta(ge=0, description="growth of the forces, in drive periods; default: the scene's")]
ForceAmplitude = Annotated[float, unit("N"), Meta(ge=0, description="amplitude of all forces, N; default: the scene's")]
Mu = Annotated[float, Meta(gt=0, description="coefficient of friction")]
Slope = Annotated[float, Meta(gt=0, description="K of Eq. (3), s/m")]
Mass = Annotated[float, unit("kg"), Meta(gt=0, description="mass, kg")]


def check_count(model: str, count: int | None) -> None:
    """Raise InputError for a discrete model without `count`, or the exact beam with `count`."""
    if model != MEAN:
        MODELS.named(model).check_count(count)
    elif count is None:
        raise InputError(f"count is missing: give the number of segments or elements for model = {MEAN}")


def check_settings(model: str, chosen: Settings) -> Settings:
    """The settings. Raises InputError for a setting that the model does not have."""
    for name, value in chosen:
        if name not in MODELS.named(model).settings():
            able = [m.name for m in MODELS.values() if name in m.settings()]
            raise InputError(f"{name} = {value!r} is for model = {' or '.join(able) or 'none'}, not for {model}")
    return chosen


class ModelOptions(settings.ModelSettings, frozen=True, kw_only=True):
    """Settings of the discrete models."""

    @property
    def settings(self) -> Settings:
        """Settings that differ from their defaults."""
        return not_default(self, without=("model", "mode", "count", "counts"))


class OneMode(ModelOptions, frozen=True, kw_only=True):
    """One mode of one model."""

    model: ModesModel
    mode: Mode
    count: Size | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        if self.model != MEAN:
            check_settings(self.model, self.settings)


class OneModeOrMean(OneMode, frozen=True, kw_only=True):
    """One mode of one model or of the mean of segment and fem."""

    model: AnyModel


class OneDiscreteMode(OneMode, frozen=True, kw_only=True):
    """One mode of one discrete model."""

    model: DiscreteModel
    count: Size


class DriveOptions(msgspec.Struct, frozen=True, kw_only=True):
    """The drive, by default the scene's."""

    frequency_hz: Frequency | None = None
    phase_deg: Annotated[float, Meta(description="phase of the second force; default: the scene's")] | None = None
    position: Annotated[Place, Meta(description="d, m: forces at d and L - d; default: the scene's")] | None = None

    def forces(self, scene: Scene, amplitude: float | None = None) -> tuple[PointForce, ...]:
        """The scene's forces with these positions, phase and amplitude (N). Raises InputError."""
        forces = list(scene.forces)
        if not forces:
            raise InputError("drive.force is missing: add force = [{ position = ... }] to [drive]")
        for name in ("position", "phase_deg"):
            if getattr(self, name) is not None and len(forces) != 2:
                raise InputError(f"{name} is for two forces and the scene has {len(forces)}: leave it out")
        if self.position is not None:
            positions = (self.position, scene.beam.length - self.position)
            forces = [replace(force, position=x) for force, x in zip(forces, positions, strict=True)]
        if self.phase_deg is not None:
            forces[1] = replace(forces[1], phase_deg=self.phase_deg)
        if amplitude is not None:
            forces = [replace(force, amplitude=amplitude) for force in forces]
        return tuple(forces)


def drive_frequency(scene: Scene, frequency_hz: float | None = None) -> float:
    """`frequency_hz`, by default that of the drive, Hz. Raises InputError where it is missing or too high."""
    hertz = frequency_hz if frequency_hz is not None else scene.drive.frequency_hz if scene.drive else None
    if hertz is None:
        raise InputError("frequency_hz is missing and the scene has no drive: give frequency_hz in hertz")
    check_frequency("frequency_hz", float(hertz), scene.beam)
    return float(hertz)


def check_forces(scene: Scene, subject: str) -> None:
    """Raise InputError for a drive that is not by forces."""
    if scene.drive is not None and scene.drive.kind != "force":
        raise InputError(f"drive.kind = {scene.drive.kind!r}: {subject} takes imposed forces, give kind = 'force'")


def check_theory(subject: str, theory: settings.Theory) -> None:
    """Raise InputError for a theory that `subject` does not have."""
    if theory != "euler-bernoulli":
        both = "leave it out and compare wave.standing_wave_ratio by both theories"
        raise InputError(f"theory = {theory!r}: {subject} has Euler-Bernoulli theory alone, {both}")


def not_default(group: msgspec.Struct, without: Sequence[str] = ()) -> Settings:
    """(name, value) of the fields of an option group that differ from their defaults, except those in `without`."""
    fields = [field for field in msgspec.structs.fields(type(group)) if field.name not in without]
    return tuple((f.name, getattr(group, f.name)) for f in fields if getattr(group, f.name) != f.default)
