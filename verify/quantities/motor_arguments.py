"""Typed arguments of a motor's figures, and the slider that they describe."""

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from msgspec import Meta
from msgspec.structs import replace

from verify import options
from verify.checks import Relative
from verify.errors import InputError
from verify.quantities.kind import WHAT_EXISTS, DriveArguments, MovingModel, Size, check_count
from verify.quantities.motion_arguments import check_law
from verify.slider import changed

if TYPE_CHECKING:
    from verify.scenes.scene import Scene
    from verify.slider import Contact, Foot, Slider


Positive = Annotated[float, Meta(gt=0)]


class Motor(DriveArguments, frozen=True, kw_only=True):
    """The scene's motor, one model's beam in its steady state, with what is given instead."""

    places: ClassVar[tuple[str, ...]] = ("position", "slider_position")
    reads: ClassVar[tuple[str, ...]] = WHAT_EXISTS
    slides: ClassVar[bool] = True

    model: MovingModel = "segment"
    count: Size | None = None
    force: Annotated[float, Meta(ge=0, description="of every force, newton; default: the scene's")] | None = None
    modal_damping: Annotated[Relative, Meta(ge=0, lt=1, description="ratio of every mode")] | None = None
    steps_per_period: Annotated[int, Meta(ge=4, description="at least; more where the contact is stiff")] = 61
    mu: Annotated[float, Meta(gt=0, description="coefficient of friction")] | None = None
    slope: Annotated[float, Meta(gt=0, description="K of Eq. (3), s/m")] | None = None
    mass: Annotated[float, Meta(gt=0, description="kg")] | None = None
    law: Annotated[options.Law, Meta(description="Eq. (3), or true sticking")] | None = None
    coupling: Annotated[options.CouplingChoice, Meta(description="whether the beam feels it")] | None = None
    preload: Annotated[float, Meta(ge=0, description="newton pressing it on beside its weight")] | None = None
    slider_position: Annotated[float, Meta(description="where it is put, metres")] | None = None
    stiffness: Annotated[float, Meta(gt=0, description="of each foot's contact, N/m")] | None = None
    damping: Annotated[float, Meta(ge=0, description="of each foot's contact, N s/m")] | None = None
    tangential_stiffness: Annotated[float, Meta(gt=0, description="of each foot along the surface, N/m")] | None = None
    restitution: Annotated[float, Meta(ge=0, le=1, description="of a hard contact")] | None = None
    points: Annotated[int, Meta(ge=1, description="of every foot")] | None = None
    foot_length: Annotated[float, Meta(gt=0, description="of every foot, metres")] | None = None

    def __post_init__(self) -> None:
        check_count(self.model, self.count)
        check_law(self.law, self.slope)


class Held(Motor, frozen=True, kw_only=True):
    """Its slider held still, at its place."""

    periods: Annotated[int, Meta(ge=24, description="of the drive, at most, until the means have settled")] = 46_080


class AtSpeedOf(Held, frozen=True, kw_only=True):
    """Its slider held at a speed, at its place."""

    speed: Annotated[float, Meta(description="along +x, m/s")] = 0.0


class ForceAt(Held, frozen=True, kw_only=True):
    """The same at a speed that has to be said."""

    speed: Annotated[float, Meta(description="along +x, m/s")]


class FreeRun(Motor, frozen=True, kw_only=True):
    """Its slider free, from rest."""

    periods: Annotated[int, Meta(ge=2, description="of the drive, that are run")] = 2000
    pull: Annotated[float, Meta(description="on the slider along +x, newton")] | None = None


class UnderWay(FreeRun, frozen=True, kw_only=True):
    """The same, at its end."""

    last: Annotated[int, Meta(ge=2, description="periods at the end of which the mean is taken")] = 200

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.last >= self.periods:
            raise InputError(f"last = {self.last!r} of periods = {self.periods!r}: take the mean of fewer than all")


class OfRun(FreeRun, frozen=True, kw_only=True):
    """A line of its energy books over the work of the surface on it."""

    of: Annotated[
        Literal["damped", "impacts", "rubbed", "residual"],
        Meta(description="lost in dashpots, in hard landings, in friction; what the books miss"),
    ]


def slider_on_feet(a: Motor, scene: "Scene") -> "Slider":
    """The scene's slider with what is given instead of its own. Raises InputError where it never leaves the beam."""
    if scene.slider is None:
        raise InputError("the scene has no slider: add [slider] with mass, mu and [slider.contact]")
    if scene.slider.contact is None:
        raise InputError("slider.contact is missing: a motor's slider may leave the beam, add [slider.contact]")
    own = {name: getattr(a, name) for name in ("mu", "slope", "mass", "law", "coupling", "preload")}
    own |= {"position": a.slider_position, "pull": getattr(a, "pull", None)}
    touching = {name: getattr(a, name) for name in ("stiffness", "damping", "tangential_stiffness", "restitution")}
    contact = replace(scene.slider.contact, **_given(touching))
    standing = _given({"points": a.points, "length": a.foot_length})
    feet = tuple(replace(foot, **standing) for foot in scene.slider.feet) if standing else scene.slider.foot
    _check_length(a.foot_length, contact, feet)
    return changed(scene.slider, contact=contact, foot=feet, **_given(own))


def _check_length(length: float | None, contact: "Contact", feet: "tuple[Foot, ...]") -> None:
    """Raise InputError for a length on which a foot of one point does not touch."""
    layered = contact.layer_stiffness is not None or contact.layer_tangential_stiffness is not None
    if length is not None and (contact.hard or (not layered and any(foot.points == 1 for foot in feet))):
        remedy = "leave it out" if contact.hard else "give points as well"
        raise InputError(f"foot_length = {length!r} of a foot of one point, which touches at its middle: {remedy}")


def _given(settings: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in settings.items() if value is not None}
