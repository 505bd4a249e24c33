"""Run a scene and judge its gates."""

from pathlib import Path

import click

from verify.commands.shared import (
    command_line,
    json_alone,
    load,
    overridden,
    print_json,
    progress,
    scene_name,
)

GATE_FAILED = 1


@click.command()
@scene_name
@overridden
@click.option(
    "--reports", "folder", default="reports", show_default=True, metavar="PATH", help="Folder for the HTML report."
)
@click.option("--no-report", is_flag=True, help="Judge only; write nothing.")
@json_alone
def run(scene: str, overrides: tuple[str, ...], folder: str, no_report: bool, as_json: bool) -> None:
    """Run everything SCENE asks for; write its report; exit 1 when a gate fails.

    Where --set changes what exists (beam, drive, slider, motion), the report is named after it, and gates that were
    stated for something else are not applicable: neither passed nor failed, unless their band is set as well.
    Example: `verify run paper --set beam.length=0.4`
    """
    from verify.files import writable_folder
    from verify.run.applies import report_name
    from verify.run.runner import n_steps, run_scene

    asked = load(scene, overrides)
    target = None if no_report else writable_folder(Path(folder), "reports") / f"{report_name(asked, overrides)}.html"
    with progress(n_steps(asked), quiet=as_json) as step:
        result = run_scene(asked, step, overrides)
    if target is not None:
        from verify.report.html import write_report

        write_report(result, target, command=command_line("run", scene, overrides))
    if as_json:
        from verify.report.plain import run_as_plain

        print_json(run_as_plain(result, target))
    else:
        from verify.report.terminal import print_run

        print_run(result, target)
    if not result.passed:
        raise SystemExit(GATE_FAILED)
