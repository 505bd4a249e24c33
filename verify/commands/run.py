"""`verify run`: gates and studies of one or several scenes, with reports."""

from collections.abc import Callable, Mapping
from itertools import count
from pathlib import Path
from shlex import join
from time import perf_counter
from typing import Any, NamedTuple

import click

from verify.commands.shared import GATE_FAILED, console, json_option, overrides_option, print_json, progress
from verify.errors import InputError
from verify.files import writable_folder
from verify.parallel import map_processes
from verify.report.archive import Saved, report_name, save_run
from verify.report.page import failed_line, index_result, scene_line, write_index
from verify.report.summary import print_run, run_data
from verify.scene.file import packaged_scenes
from verify.scene.load import load_scene
from verify.scene.model import Scene
from verify.scene.run import RunResult, plan, run_scene
from verify.studies.base import studies_of

CANNOT_RUN = 2
ALL_TAKE = ", on two cores about a minute, twice that on the first run, which compiles kernels"


class Task(NamedTuple):
    """One scene to run; picklable."""

    scene: Scene
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
    """Run gates and studies of SCENE and write its report; exit 1 where a gate fails, or it has gates and nothing ran.

    With several scenes, or none for all packaged ones, they run in parallel and FOLDER/index.html links to their
    reports. The latest report is FOLDER/SCENE.html; FOLDER/SCENE/TIME has the saved runs (index.html, run.json), which
    `verify diff` compares.

    With --set gates that hold for other values are skipped. Example: `verify run paper --set beam.length=0.4`
    """
    names = scenes or packaged_scenes()
    loaded, failed = dict[str, Scene](), dict[str, dict[str, Any]]()
    for name in names:
        try:
            loaded[name] = load_scene(name, overrides)
        except InputError as error:
            if len(names) == 1:
                raise  # before a folder is made
            failed[name] = failed_line(name, error.sentences)
    reports = None if no_report else writable_folder(Path(folder), "--to")
    tasks = {
        name: Task(scene, overrides, reports, keep, _command_line((name,), overrides)) for name, scene in loaded.items()
    }
    if len(names) == 1:
        _run_one(tasks[names[0]], as_json)
        return
    start = perf_counter()
    by_name = failed | _run_several(tasks, "" if scenes else ALL_TAKE, quiet=as_json)
    lines = [by_name[name] for name in names]
    if reports is not None:
        write_index(lines, reports / "index.html", _command_line(scenes, overrides), perf_counter() - start)
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


def _run_one(task: Task, as_json: bool) -> None:
    studies = studies_of(task.scene)
    steps = sum(row.runs for row in plan(task.scene, task.overrides)) + sum(study.steps for _, study in studies)
    with progress(steps, quiet=as_json) as step:
        result, _, saved = _saved(task, step)
    if as_json:
        print_json(run_data(result, task.command) | {"page": str(saved.page) if saved else None})
    else:
        print_run(result, console(), saved)
    if not result.passed:
        raise SystemExit(GATE_FAILED)


def _run_several(tasks: Mapping[str, Task], expected: str, *, quiet: bool) -> dict[str, dict[str, Any]]:
    """Lines of the index by scene, computed in parallel."""
    order, done = _order(tasks), count(1)
    with progress(len(tasks), quiet=quiet, lines=True) as step:
        step(f"{len(tasks)} scenes{expected}")

        def completed(i: int) -> None:
            step(f"{next(done)} of {len(tasks)} scenes: {order[i]}")

        return dict(zip(order, map_processes(_line_of, [tasks[name] for name in order], completed), strict=True))


def _order(tasks: Mapping[str, Task]) -> list[str]:
    """Scenes in the order in which they run: the longest first, with the number of gates as a measure.

    A short one is before them, since the first runs alone; all scenes with contact except one are last, since they
    share kernels, which that one compiles meanwhile.
    """

    def contact(name: str) -> bool:
        scene = tasks[name].scene
        return scene.slider is not None or any(
            gate.quantity.startswith(("contact.", "friction.")) for gate in scene.gate
        )

    order = sorted(tasks, key=lambda name: (contact(name), -len(tasks[name].scene.gate)))
    k = max(sum(not contact(name) for name in order) - 1, 0)
    return order[k : k + 2] + order[:k] + order[k + 2 :] if len(order) > 2 else list(tasks)


def _line_of(task: Task) -> dict[str, Any]:
    """The line of one scene in the index; the work of one process."""
    try:
        return scene_line(*_saved(task))
    except InputError as error:
        return failed_line(task.scene.name, error.sentences)


def _saved(task: Task, step: Callable[[str], None] = lambda step: None) -> tuple[RunResult, str, Saved | None]:
    """(result, name of the report, saved run) of a scene; None where no report is written."""
    result = run_scene(task.scene, step, task.overrides)
    name = report_name(result.scene.name, task.overrides)
    return result, name, save_run(result, task.reports, name, task.command, task.keep) if task.reports else None


def _command_line(scenes: tuple[str, ...], overrides: tuple[str, ...]) -> str:
    return join(["verify", "run", *scenes, *(word for text in overrides for word in ("--set", text))])
