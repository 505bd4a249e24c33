"""What `verify table` can tabulate: any study of a scene, and figures over sizes or axes that no scene asks for."""

import math
from collections.abc import Callable, Mapping
from typing import Any

import msgspec

from verify.errors import InputError
from verify.judge.variants import DEFAULTS, Rules
from verify.judge.workbench import Workbench
from verify.scenes.checked import checked
from verify.scenes.given import whole_numbers
from verify.scenes.scene import Scene
from verify.scenes.toml import given_arguments, literal
from verify.studies.catalogue import STUDIES, asked_of
from verify.studies.kind import Progress
from verify.studies.modes.convergence import Convergence, ConvergenceStudy, Counts
from verify.studies.told import Found


class Job(msgspec.Struct, frozen=True):
    """One table, or a few of one study."""

    n_steps: int
    run: Callable[[Progress], Found]


RULES = tuple(f"--{name}" for name in DEFAULTS)
BESIDE = {
    "": ("--modes", "--counts", *RULES),
    "--wave": ("--counts",),
    "--slider": ("--counts",),
    "--sweep": ("--quantity",),
}
"""Which options go with which table; the first is the table that no option asks for."""


def check_options(tables: Mapping[str, object], options: Mapping[str, object]) -> None:
    """Raise InputError for two tables at once, or for an option of another table, which would change nothing."""
    asked = [name for name, given in tables.items() if given]
    if len(asked) > 1:
        raise InputError(f"{asked[0]} and {asked[1]} ask for two tables: give one of them")
    table = asked[0] if asked else ""
    for option in (name for name, given in options.items() if given and name not in BESIDE.get(table, ())):
        others = " or ".join(name or "the table of all models" for name, known in BESIDE.items() if option in known)
        raise InputError(f"{option} belongs to {others}: leave it out" + (f" beside {table}" if table else ""))


def study_of(scene: Scene, name: str) -> Job:
    """What a study of the scene finds. Raises InputError for one that the scene does not ask for."""
    study = STUDIES.named(name, "--of")
    asked = study.asked(scene)
    if asked is None:
        raise InputError(f"--of {name}: {study.skipped(scene)}")
    taken = set(study.takes(asked, scene))
    jobs = [*((other, its) for other, its in asked_of(scene) if other.name in taken), (study, asked)]
    bench = Workbench(scene.beam, (need for one, its in jobs for need in one.needs(its, scene)))

    def run(step: Progress) -> Found:
        done: dict[str, Found] = {}
        for one, its in jobs:
            done[one.name] = one.run(its, scene, bench, done, step)
        return done[name]

    return Job(sum(one.n_steps(its, scene) for one, its in jobs), run)


def rules_of(words: Mapping[str, str]) -> Rules:
    """How models are set up, as typed: one word or several with commas. Raises InputError."""
    return checked({name: literal(text, name) for name, text in words.items()}, Rules)


def convergence(scene: Scene, modes: str | None, counts: str | None, rules: Mapping[str, str] | None = None) -> Job:
    """Errors and run time of modes over sizes. Raises InputError."""
    scene.refuse_devices("a table of modes")
    study = ConvergenceStudy()
    asked = msgspec.to_builtins(study.asked(scene) or Convergence())
    asked |= {name: _listed(text, name) for name, text in (("modes", modes), ("counts", counts)) if text is not None}
    asked |= {name: literal(text, name) for name, text in (rules or {}).items()}
    request = checked(asked, Convergence)
    return Job(study.n_steps(request, scene), lambda step: study.run(request, scene, Workbench(scene.beam), {}, step))


def motor(scene: Scene, counts: str | None) -> Job:
    """SWR, axis ratio and crest speed over sizes, at the drive's frequency and at each model's best."""
    from verify.studies.wave.request import Wave
    from verify.studies.wave.study import WaveStudy

    given = _listed(counts, "counts") if counts is not None else (WaveStudy().asked(scene) or Wave()).counts
    sizes = checked(list(given), Counts, "counts")
    if len(scene.forces) != 2:
        raise InputError("--wave takes a scene with two forces: add them to its [drive]")

    def run(step: Progress) -> Found:
        from verify.studies.wave.figures import MotorFound, motor_table

        return MotorFound(rows=motor_table(scene, Workbench(scene.beam), tuple(sizes), step))

    return Job(2 * len(sizes), run)


def slider(scene: Scene, counts: str | None) -> Job:
    """The slider's displacement, its error and its run time over sizes, all models. Raises InputError."""
    from verify.studies.slider.request import ROUNDS

    if scene.slider is None or scene.motion is None:
        raise InputError("--slider takes a scene with [slider] and [motion], for instance paper-slider")
    sizes = checked(list(_listed(counts, "counts") if counts is not None else scene.motion.counts), Counts, "counts")

    def run(step: Progress) -> Found:
        from verify.studies.slider.work_precision import WorkFound, work_of

        return WorkFound(work=work_of(scene, tuple(sizes), step))

    return Job(ROUNDS, run)


def sweep(scene: Scene, sweeps: tuple[str, ...], quantity: str, arguments: tuple[str, ...]) -> Job:
    """A wave quantity over one or two axes. Raises InputError."""
    from verify.studies.wave.design_map import design_map, parse_axis

    axes = tuple(parse_axis(text, scene.drive.frequency_hz if scene.drive else None) for text in sweeps)
    given = given_arguments(arguments)
    for axis in axes:
        if axis.name in given:
            raise InputError(f"{axis.name} = {given[axis.name]!r}: is swept, give it once, to --sweep")
    n_points = math.prod(len(axis.values) for axis in axes)
    return Job(n_points, lambda step: design_map(quantity, given, axes, scene, Workbench(scene.beam), step))


def _listed(text: str, field: str) -> list[Any]:
    """'1,5,22', '1-5' or '10-50:10' as a list. Raises InputError for a range that is none."""
    value = whole_numbers(literal(text, field), field)
    return value if isinstance(value, list) else [value]
