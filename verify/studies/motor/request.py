"""What a scene asks about its motor, and what that comes to: a case, places."""

from math import pi
from typing import TYPE_CHECKING, Annotated, get_args

import msgspec
from msgspec import Meta

from verify.checks import Relative, check_number
from verify.errors import InputError, near_name
from verify.models.catalogue import MODELS
from verify.models.naming import Among
from verify.motor.combine import CHAIN
from verify.options import OF_THE_CHAIN, Links, Start

if TYPE_CHECKING:
    from verify.motor.case import MotorCase
    from verify.scenes.scene import Scene


STEPS_PER_PERIOD = 61


SECONDS, PLACES = 0.02, 8
"""Of the runs from rest, unless given."""


REST_PERIODS = 1000
"""Of the drive, at most, in which all fields are run from rest beside the chain."""


FREE_RUNS = 3
"""Under way, cut off, turned round."""


HELD = 3
"""Speeds of the runs from rest, from standing still to that of the crests."""


RUNS = 2 * (1 + HELD) + 2 * 2
"""From rest at each place: the wave either way, free and held; free and still in half the steps."""


class Motor(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the motor: force over speed, no load, starting, stopping, turning round, and how far to believe it."""

    models: Annotated[tuple[str, ...], Meta(min_length=1)] = ("analytic", "segment", "fem")
    """Fields under the slider; 'chain' is the nonlinear chain, which runs from rest beside the others."""
    count: Annotated[int, Meta(ge=2, le=250)] = 49
    """Segments, elements and links."""
    speeds: Annotated[int, Meta(ge=2, le=201)] = 9
    """Points of the force-speed curve, from standing still to the speed of the crests."""
    periods: Annotated[int, Meta(ge=20, le=100_000)] = 2000
    """Of the drive in a free run, and at most in stopping and turning round."""
    start: Start = "steady"
    """How the beam stands when the free run begins: driven for long, or at rest."""
    soft_start_periods: float = 0.0
    """Of a beam at rest, over which its forces grow."""
    modal_damping: Relative | None = None
    """Ratio of every mode, in a steady field too; what the beam's loss factor comes to in each unless given."""
    steps_per_period: Annotated[int, Meta(ge=16, le=4096)] = STEPS_PER_PERIOD
    """At least; more where the contact is stiff."""
    chain: float | None = None
    """Seconds from rest, undamped, of all fields beside the nonlinear chain of `models`; 0.02 unless given."""
    chain_force: float | None = None
    """Newton, of every force in those runs, with all that presses in proportion; the scene's unless given."""
    links: tuple[Links, ...] | None = None
    """Of that chain; rigid and stretching unless given."""
    places: Annotated[int, Meta(ge=2, le=64)] | None = None
    """Of one wavelength about the slider's own, at which it is put in those runs; 8 unless given."""

    def __post_init__(self) -> None:
        check_number("motor.soft_start_periods", self.soft_start_periods, "periods of the drive", at_least=0)
        self._check_chain()
        if self.modal_damping is not None:
            check_number("motor.modal_damping", self.modal_damping, "ratio", at_least=0, below=1)
        for name in self.linear:
            if name not in MODELS or not MODELS[name].can("time_basis"):
                known = (*Among("time_basis").names(), CHAIN)
                raise InputError(f"motor.models has {name!r}, which is not known: {near_name(name, known)}")
        for name, one in (("models", self.models), ("links", self.chained)):
            if len(set(one)) < len(one):
                raise InputError(f"motor.{name} = {list(one)!r} has one twice: give each once")
        if not self.linear:
            raise InputError("motor.models has the nonlinear chain alone: add a linear field to hold it against")
        if self.start == "steady" and self.soft_start_periods:
            raise InputError(
                f"motor.soft_start_periods = {self.soft_start_periods!r} with start = 'steady': a steady beam has no "
                "start, leave it out"
            )

    def _check_chain(self) -> None:
        """Raise InputError for what the runs from rest cannot have, and for what is of them where there are none."""
        for name in OF_THE_CHAIN:
            if CHAIN not in self.models and (value := getattr(self, name)) is not None:
                given = list(value) if isinstance(value, tuple) else value
                raise InputError(
                    f"motor.{name} = {given!r} is of runs from rest beside the nonlinear chain, which motor.models "
                    "has not: add 'chain' there, or leave it out"
                )
        check_number("motor.chain", self.seconds, "seconds", above=0)
        if self.chain_force is not None:
            check_number("motor.chain_force", self.chain_force, "newton", above=0)
        if self.links == ():
            raise InputError("motor.links = [] with the chain among motor.models: give rigid, stretching or both")

    @property
    def seconds(self) -> float:
        """Of the runs from rest."""
        return SECONDS if self.chain is None else self.chain

    @property
    def chained(self) -> tuple[Links, ...]:
        """Links of the chain in those runs."""
        return get_args(Links) if self.links is None else self.links

    @property
    def put(self) -> int:
        """At how many places of a wavelength the slider is put in those runs."""
        return PLACES if self.places is None else self.places

    @property
    def linear(self) -> tuple[str, ...]:
        """The linear fields."""
        return tuple(name for name in self.models if name != CHAIN)

    @property
    def from_rest(self) -> tuple[tuple[str, Links], ...]:
        """(field, links) of the runs from rest: every linear field, every chain; none without a chain."""
        if CHAIN not in self.models:
            return ()
        return (*((name, "rigid") for name in self.linear), *((CHAIN, links) for links in self.chained))

    def sized(self, model: str) -> int | None:
        """Segments or elements; None of a field without."""
        return self.count if model == CHAIN or MODELS[model].sized else None


def case_of(asked: Motor, scene: "Scene", model: str) -> "MotorCase":
    """The scene's motor on a linear field in its steady state."""
    from verify.motor.case import MotorCase

    assert scene.drive is not None
    assert scene.slider is not None
    return MotorCase(
        beam=scene.beam,
        forces=scene.forces,
        frequency_hz=scene.drive.frequency_hz,
        slider=scene.slider,
        model=model,
        count=asked.sized(model),
        modal_damping=asked.modal_damping,
        steps_per_period=asked.steps_per_period,
    )


def places_from_rest(asked: Motor, scene: "Scene") -> tuple[float, ...]:
    """Over one wavelength about the slider's own place, which is one of them, metres."""
    from verify.models.fields import lossless_wavenumber
    from verify.models.underfoot import standing_at

    assert scene.drive is not None
    assert scene.slider is not None
    x, n = scene.slider.start_on(scene.beam), asked.put
    length = 2.0 * pi / abs(lossless_wavenumber(standing_at(scene.beam, x), scene.drive.frequency_hz))
    return tuple(x + (k - n // 2) / n * length for k in range(n))
