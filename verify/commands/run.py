"""Run a scene, or several, and judge their gates."""

from pathlib import Path

import click

from verify.commands.shared import (
    GATE_FAILED,
    command_line,
    json_alone,
    load,
    overridden,
    print_json,
    progress,
)


@click.command()
@click.argument("scenes", nargs=-1, metavar="[SCENE]...")
@overridden
@click.option(
    "--reports", "folder", default="reports", show_default=True, metavar="PATH", help="Folder for the HTML reports."
)
@click.option(
    "--keep",
    "most",
    type=click.IntRange(min=0),
    default=5,
    show_default=True,
    metavar="N",
    help="Keep the N newest runs of a name in a folder of their own, and take older ones away.",
)
@click.option("--no-report", is_flag=True, help="Judge only; write nothing.")
@json_alone
def run(
    scenes: tuple[str, ...], overrides: tuple[str, ...], folder: str, most: int, no_report: bool, as_json: bool
) -> None:
    """Run everything SCENE asks for; write its report; exit 1 when a gate fails.

    Without SCENE all packaged scenes are run, side by side where cores allow, and with several those; their reports
    stand behind one page, index.html. A scene that cannot run does not stop the others; the exit status is 2 then.

    The latest report of a scene is PATH/SCENE.html. That page is kept in PATH/SCENE/TIME as well, beside run.json,
    which `verify report` and `verify diff` read.

    Where --set changes what exists (beam, drive, slider, motion), the report is named after it, and gates that were
    stated for something else are not applicable: neither passed nor failed, unless their band is set as well.
    Example: `verify run paper --set beam.length=0.4`
    """
    reports = None if no_report else Path(folder)
    if len(scenes) == 1:
        _run_one(scenes[0], overrides, reports, most, as_json)
    else:
        from verify.commands.suite import run_several

        run_several(scenes, overrides, reports, most, as_json)


def _run_one(scene: str, overrides: tuple[str, ...], folder: Path | None, most: int, as_json: bool) -> None:
    """One scene, and what it says in full."""
    from verify.files import writable_folder
    from verify.run.applies import TAKEN, check_free, report_name, that_change
    from verify.run.runner import n_steps, run_scene

    asked = load(scene, overrides)
    changes = that_change(scene, overrides)
    name = report_name(asked, changes)
    if folder is not None:
        check_free(name, TAKEN)
        writable_folder(folder, "reports")
        if most:
            from verify.report.kept import folder_for

            folder_for(folder, name)
    with progress(n_steps(asked), quiet=as_json) as step:
        result = run_scene(asked, step, changes)
    written = None
    if folder is not None:
        from verify.report.kept import keep

        written = keep(result, folder, name, command_line("run", (scene,), overrides), most)
    latest, kept = (written.latest, written.folder) if written else (None, None)
    if as_json:
        from verify.report.plain import run_as_plain

        print_json(run_as_plain(result, latest))
    else:
        from verify.report.terminal import print_run

        print_run(result, latest, kept)
    if not result.passed:
        raise SystemExit(GATE_FAILED)
