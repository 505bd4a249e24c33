"""`verify run`: gates and studies of one or several scenes, with reports."""

from collections.abc import Callable
from contextlib import suppress
from itertools import count
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import click

from verify.commands.shared import GATE_FAILED, console, json_option, overrides_option, print_json, progress

CANNOT_RUN = 2
ALL_TAKE = ", on two cores about a minute, twice that on the first run, which compiles kernels"


class Task(NamedTuple):
    """One scene to run; picklable."""

    scene: str
    overrides: tuple[str, ...]
    reports: Path | None
    keep: int
    command: str


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@overrides_option
@click.option("--to", "folder", default="reports", show_default=True, metavar="FOLDER", help="Folder of the reports.")
@click.option("--no-report", is_flag=True, help="Write no files.")
@click.option(
    "--keep", type=click.IntRange(0), default=5, show_default=True, metavar="N", help="Saved runs of a scene."
)
@json_option
def run(
    scenes: tuple[str, ...], overrides: tuple[str, ...], folder: str, no_report: bool, keep: int, as_json: bool
) -> None:
    """Run gates and studies of SCENE and write its report; exit 1 where a gate fails.

    With several scenes, or none for all packaged ones, they run in parallel and FOLDER/index.html links to their
    reports. The latest report is FOLDER/SCENE.html; FOLDER/SCENE/TIME has the saved runs (index.html, run.json), which
    `verify diff` compares.

    With --set gates that hold for other values are skipped. Example: `verify run paper --set beam.length=0.4`
    """
    from verify.files import writable_folder
    from verify.scene.load import load_scene, packaged_scenes

    names = scenes or packaged_scenes()
    if len(names) == 1:
        load_scene(names[0], overrides)  # refused before a folder is made
    reports = None if no_report else writable_folder(Path(folder), "--to")
    tasks = [Task(name, overrides, reports, keep, _command_line((name,), overrides)) for name in names]
    if len(tasks) == 1:
        _run_one(tasks[0], as_json)
    else:
        _run_several(tasks, as_json, _command_line(scenes, overrides), "" if scenes else ALL_TAKE)


def _run_one(task: Task, as_json: bool) -> None:
    from verify.report.summary import run_data
    from verify.report.terminal import print_run
    from verify.scene.load import load_scene
    from verify.scene.run import plan
    from verify.studies.base import studies_of

    scene = load_scene(task.scene, task.overrides)
    steps = sum(row.runs for row in plan(scene, task.overrides)) + sum(study.steps for _, study in studies_of(scene))
    with progress(steps, quiet=as_json) as step:
        result, _, saved = _saved(task, step)
    if as_json:
        print_json(run_data(result, task.command) | {"page": str(saved.page) if saved else None})
    else:
        print_run(result, console(), saved)
    if not result.passed:
        raise SystemExit(GATE_FAILED)


def _run_several(tasks: list[Task], as_json: bool, command: str, expected: str) -> None:
    from verify.parallel import map_processes
    from verify.report.index import index_result, write_index

    start = perf_counter()
    with progress(len(tasks), quiet=as_json, lines=True) as step:
        step(f"{len(tasks)} scenes{expected}")
        done, turns = count(1), _turns(tasks)

        def completed(turn: int) -> None:
            step(f"{next(done)} of {len(tasks)} scenes: {tasks[turns[turn]].scene}")

        by_turn = map_processes(_line_of, [tasks[i] for i in turns], completed)
    lines = [by_turn[turns.index(i)] for i in range(len(tasks))]
    reports = tasks[0].reports
    if reports is not None:
        write_index(lines, reports / "index.html", command, perf_counter() - start)
    if as_json:
        print_json({"passed": all(line["passed"] for line in lines), "scenes": lines})
    else:
        index_result(lines).print(console())
        if reports is not None:
            click.echo(f"report: {reports / 'index.html'}")
    if any(line["passed"] is None for line in lines):
        raise SystemExit(CANNOT_RUN)
    if not all(line["passed"] for line in lines):
        raise SystemExit(GATE_FAILED)


def _turns(tasks: list[Task]) -> list[int]:
    """Indices of tasks in the order in which they run: the longest first, with the number of gates as a measure.

    A short one is before them, since the first runs alone; all scenes with contact except one are last, since they
    share kernels, which that one compiles meanwhile.
    """
    from verify.errors import InputError
    from verify.scene.load import load_scene

    def weight(i: int) -> tuple[bool, int]:
        with suppress(InputError):
            scene = load_scene(tasks[i].scene, tasks[i].overrides)
            contact = any(gate.quantity.startswith(("contact.", "friction.")) for gate in scene.gate)
            return contact or scene.slider is not None, -len(scene.gate)
        return False, 0

    turns = sorted(range(len(tasks)), key=weight)
    k = max(sum(not weight(i)[0] for i in turns) - 1, 0)
    return turns[k : k + 2] + turns[:k] + turns[k + 2 :] if len(turns) > 2 else [*range(len(turns))]


def _line_of(task: Task) -> dict[str, Any]:
    """The line of one scene in the index; the work of one process."""
    from verify.errors import InputError
    from verify.report.index import failed_line, scene_line

    try:
        return scene_line(*_saved(task))
    except InputError as error:
        return failed_line(task.scene, error.sentences)


def _saved(task: Task, step: Callable[[str], None] = lambda step: None) -> tuple[Any, str, Any]:
    """(result, name of the report, saved run) of a scene; None where no report is written."""
    from verify.report.archive import report_name, save_run
    from verify.scene.run import run_scene

    result = run_scene(task.scene, step, task.overrides)
    name = report_name(result.scene.name, task.overrides)
    return result, name, save_run(result, task.reports, name, task.command, task.keep) if task.reports else None


def _command_line(scenes: tuple[str, ...], overrides: tuple[str, ...]) -> str:
    from shlex import join

    return join(["verify", "run", *scenes, *(word for text in overrides for word in ("--set", text))])
