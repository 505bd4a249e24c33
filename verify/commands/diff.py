"""`verify diff`: what changed between two saved runs."""

from pathlib import Path
from typing import Any

import click

from verify.commands.shared import GATE_FAILED, format_options, show
from verify.report.archive import compare_runs, read_runs


@click.command()
@click.argument("before", metavar="A")
@click.argument("after", metavar="B")
@format_options
def diff(before: str, after: str, **formats: Any) -> None:
    """Show gates, inputs and versions that differ between A and B; exit 1 where a gate that passed does not any more.

    Each is a run.json, the folder of a run, of a scene's runs (the newest) or of all reports (the newest of each).
    Example: `verify diff reports/paper/2026-03-01_14-05-09-271828 reports/paper`
    """
    result = compare_runs(read_runs(Path(before), "A"), read_runs(Path(after), "B"))
    show(result, **formats)
    if result.data["broken"]:
        raise SystemExit(GATE_FAILED)
