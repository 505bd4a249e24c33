"""What `verify table` can tabulate: any study of a scene, and figures over sizes or axes that no scene asks for."""

import math
from collections.abc import Callable
from typing import Any

import msgspec

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.scenes.checked import checked
from verify.scenes.scene import Scene
from verify.scenes.toml import given_arguments, literal
from verify.studies.catalogue import STUDIES
from verify.studies.convergence import Convergence, ConvergenceStudy, Counts
from verify.studies.kind import Progress
from verify.studies.told import Found


class Job(msgspec.Struct, frozen=True):
    """One table, or a few of one study."""

    n_steps: int
    run: Callable[[Progress], Found]


def study_of(scene: Scene, name: str) -> Job:
    """What a study of the scene finds. Raises InputError for one that the scene does not ask for."""
    study = STUDIES.named(name, "--of")
    asked = study.asked(scene)
    if asked is None:
        raise InputError(f"--of {name}: {study.skipped(scene)}")
    bench = Workbench(scene.beam, study.needs(asked, scene))
    return Job(study.n_steps(asked, scene), lambda step: study.run(asked, scene, bench, {}, step))


def convergence(scene: Scene, modes: str | None, counts: str | None) -> Job:
    """Errors and run time of modes over sizes. Raises InputError."""
    study = ConvergenceStudy()
    asked = msgspec.to_builtins(study.asked(scene) or Convergence())
    asked |= {name: _listed(text) for name, text in (("modes", modes), ("counts", counts)) if text is not None}
    request = checked(asked, Convergence)
    return Job(study.n_steps(request, scene), lambda step: study.run(request, scene, Workbench(scene.beam), {}, step))


def motor(scene: Scene, counts: str | None) -> Job:
    """SWR, axis ratio and crest speed over sizes, at the drive's frequency and at each model's best."""
    from verify.studies.wave import Wave, WaveStudy

    given = _listed(counts) if counts is not None else (WaveStudy().asked(scene) or Wave()).counts
    sizes = checked(list(given), Counts, "counts")
    if len(scene.forces) != 2:
        raise InputError("--wave takes a scene with two forces: add them to its [drive]")

    def run(step: Progress) -> Found:
        from verify.studies.wave_figures import MotorFound, motor_table

        return MotorFound(rows=motor_table(scene, Workbench(scene.beam), tuple(sizes), step))

    return Job(2 * len(sizes), run)


def slider(scene: Scene, counts: str | None) -> Job:
    """The slider's displacement, its error and its run time over sizes, all models. Raises InputError."""
    from verify.studies.slider import ROUNDS

    if scene.slider is None or scene.motion is None:
        raise InputError("--slider takes a scene with [slider] and [motion], for instance paper-slider")
    sizes = checked(list(_listed(counts) if counts is not None else scene.motion.counts), Counts, "counts")

    def run(step: Progress) -> Found:
        from verify.studies.work_precision import WorkFound, work_of

        return WorkFound(work=work_of(scene, tuple(sizes), step))

    return Job(ROUNDS, run)


def sweep(scene: Scene, sweeps: tuple[str, ...], quantity: str, arguments: tuple[str, ...]) -> Job:
    """A wave quantity over one or two axes. Raises InputError."""
    from verify.studies.design_map import design_map, parse_axis

    axes = tuple(parse_axis(text) for text in sweeps)
    given = given_arguments(arguments)
    n_points = math.prod(len(axis.values) for axis in axes)
    return Job(n_points, lambda step: design_map(quantity, given, axes, scene, Workbench(scene.beam), step))


def _listed(text: str) -> list[Any]:
    value = literal(text)
    return value if isinstance(value, list) else [value]
