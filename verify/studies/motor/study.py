"""The motor of a scene: a slider that may leave the beam, held, free and from rest, on every field."""

from typing import TYPE_CHECKING

from verify.errors import InputError, written
from verify.models.catalogue import MODELS
from verify.motor.combine import CHAIN
from verify.studies.kind import Progress, Study
from verify.studies.motor.request import FREE_RUNS, REST_PERIODS, RUNS, Motor, places_from_rest

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.beam import Beam
    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.scenes.scene import Scene
    from verify.studies.motor.figures import MotorFound
    from verify.studies.told import Found

PER_FIELD = 2
"""Steps of progress of one field: held, free."""


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
        from verify.studies.motor.figures import motor_study

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
