"""The motor of a scene: a slider that may leave the beam, held, free and from rest, on every field."""

from math import pi
from typing import TYPE_CHECKING, Annotated, get_args

import msgspec
from msgspec import Meta

from verify.checks import Relative, check_number
from verify.errors import InputError, near_name, written
from verify.models.catalogue import MODELS
from verify.models.naming import Among
from verify.motor.combine import CHAIN
from verify.options import OF_THE_CHAIN, Links, Start
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.beam import Beam
    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.motor.case import MotorCase
    from verify.scenes.scene import Scene
    from verify.studies.motor_figures import MotorFound
    from verify.studies.told import Found

STEPS_PER_PERIOD = 61
SECONDS, PLACES = 0.02, 8
"""Of the runs from rest, unless given."""
PER_FIELD = 2
"""Steps of progress of one field: held, free."""
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
    """Ratio of every mode, in a steady field too; half the loss factor of the beam unless given."""
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


class MotorStudy(Study[Motor, "MotorFound"]):
    """Held speeds, free runs, runs from rest."""

    name, section, work = "motor", Motor, "in time"
    slides = True
    title = "The motor"

    def skipped(self, scene: "Scene") -> str:
        """Without [motor], or without a slider that it could run."""
        if scene.slider is not None and scene.slider.contact is not None:
            return "the scene has no [motor], which runs a slider that may leave the beam"
        return "the scene has no [motor]"

    def check_on(self, asked: Motor, scene: "Scene") -> None:
        """Raise InputError for a scene without forces, or without a slider that may leave its beam."""
        if not scene.forces:
            raise InputError("motor: a motor's beam moves under a [drive] with forces, add them")
        if scene.slider is None or scene.slider.contact is None:
            missing = "[slider] with [slider.contact]" if scene.slider is None else "[slider.contact]"
            raise InputError(f"motor: its slider may leave the beam, add {missing}; one that never does is of [motion]")
        assert scene.drive is not None
        periods = asked.seconds * scene.drive.frequency_hz
        if CHAIN in asked.models and periods > REST_PERIODS:
            raise InputError(
                f"motor.chain = {asked.seconds!r} s is {periods:.3g} periods of the drive: give at most "
                f"{REST_PERIODS}, {written(float(f'{0.995 * REST_PERIODS / scene.drive.frequency_hz:.3g}'))} s"
            )

    def check_run(self, asked: Motor, scene: "Scene") -> None:
        """Raise InputError for what does not combine, feet that do not fit, a chain that is not run."""
        from verify.models.places import as_forces
        from verify.models.underfoot import check_one_ground
        from verify.motor.combine import check_combines
        from verify.motor.feet import check_on_beam
        from verify.quantities.simulated import check_forced

        check_forced(scene, "a motor")
        assert scene.slider is not None
        starts = {"steady": asked.linear, asked.start: asked.linear}
        starts |= {"rest": tuple({*starts.get("rest", ()), *asked.models})} if CHAIN in asked.models else {}
        for start, models in starts.items():
            for model in models:
                check_combines(model, start, scene.slider)
        put = (scene.slider.start_on(scene.beam), *(places_from_rest(asked, scene) if asked.from_rest else ()))
        for x in put:
            check_on_beam(scene.slider, scene.beam, x)
        check_one_ground(scene.beam, put)
        as_forces(scene.forces)
        self._check_models(asked, scene)

    def _check_models(self, asked: Motor, scene: "Scene") -> None:
        """Raise InputError for a beam that a field does not move, or a number of parts that does not carry the wave."""
        from verify.exact.in_time import check_beam

        assert scene.drive is not None
        if "analytic" in asked.linear or CHAIN in asked.models:
            check_beam(scene.beam, "take analytic and chain out of motor.models")
        for model in asked.linear:
            if MODELS[model].sized:
                MODELS[model].check_carried(scene.beam, asked.count, scene.drive.frequency_hz)
        if CHAIN in asked.models:
            _check_chained(scene.beam)

    def models(self, asked: Motor, scene: "Scene") -> tuple[str, ...]:
        """The linear fields."""
        return asked.linear

    def told(self, asked: Motor, scene: "Scene") -> str:
        """On what, and how much of it."""
        assert scene.slider is not None
        titles = ", ".join(_titled(name) for name in asked.linear)
        points = sum(foot.points * (2 if foot.mirrored else 1) for foot in scene.slider.feet)
        rest = ""
        if CHAIN in asked.models:
            rest = f"; from rest over {asked.seconds:g} s on {' and '.join(asked.chained)} links beside them"
        return (
            f"{points} contact point{'s' * (points > 1)} on {titles}: {asked.speeds} held speeds, {asked.periods} "
            f"periods free{rest}"
        )

    def n_steps(self, asked: Motor, scene: "Scene") -> int:
        """Of each field two, and one from rest; the moving picture."""
        return PER_FIELD * len(asked.linear) + len(asked.from_rest) + 1

    def n_motions(self, asked: Motor, scene: "Scene") -> int:
        """Held speeds, a search for no load counted as one; free runs; those from rest; one period for the picture."""
        return len(asked.linear) * (asked.speeds + 1 + FREE_RUNS) + RUNS * asked.put * len(asked.from_rest) + 1

    def kernels(self, asked: Motor, scene: "Scene") -> "Iterable[Call]":
        """The slider's, on a beam and on every chain that is asked for."""
        from verify.chain import warm as chain
        from verify.motor import warm

        assert scene.slider is not None
        yield from warm.on_beam(scene.slider)
        for links in asked.chained if CHAIN in asked.models else ():
            yield from chain.rigid() if links == "rigid" else chain.stretching()
            yield from warm.on_chain(scene.slider.law)

    def run(
        self, asked: Motor, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "MotorFound":
        """See `motor_study`."""
        from verify.studies.motor_figures import motor_study

        self._check_models(asked, scene)
        return motor_study(scene, asked, step)


def _check_chained(beam: "Beam") -> None:
    """Raise InputError for a beam that no nonlinear chain of [motor] is made of."""
    from verify.chain.system import check_buildable

    if beam.supports != ("pinned", "pinned"):
        raise InputError(
            f"motor.models has the chain, with beam.supports = {list(beam.supports)!r}: give a beam that is "
            "pinned at both ends, or leave the chain out"
        )
    check_buildable(beam)
    beam.check_added("the nonlinear chain", ("section",), "take chain out of motor.models")


def _titled(model: str) -> str:
    return MODELS[model].title or MODELS[model].name


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
