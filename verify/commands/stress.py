"""The stress table: promises pushed until they break."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from verify.commands.shared import GATE_FAILED, as_line, json_alone, print_json, progress
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.stress.figures import StressFound
    from verify.stress.kind import Outcome, Row


@click.command()
@click.argument("ids", nargs=-1, metavar="[ID]...")
@click.option("--list", "listed", is_flag=True, help="Name every row and run none.")
@click.option(
    "--seconds",
    "cap",
    type=float,
    metavar="CAP",
    help="Leave out, by name, rows that take longer. Default: VERIFY_PATIENCE where it is set.",
)
@click.option("--csv", "layout", flag_value="csv", help="Print comma-separated values.")
@click.option("--markdown", "layout", flag_value="markdown", help="Print a Markdown table.")
@click.option(
    "--reports", "folder", default="reports", show_default=True, metavar="PATH", help="Folder for the HTML report."
)
@click.option("--no-report", is_flag=True, help="Measure only; write nothing.")
@json_alone
def stress(
    ids: tuple[str, ...],
    listed: bool,
    cap: float | None,
    layout: str | None,
    folder: str,
    no_report: bool,
    as_json: bool,
) -> None:
    """Push every promise until it breaks, and print where; exit 1 when one is not held.

    Each row is told as soon as it is measured, and Ctrl-C keeps what was. Example: `verify stress tip-mass taut`
    """
    from verify.files import writable_folder
    from verify.patience import own_limit
    from verify.stress.figures import chosen, told
    from verify.stress.figures import stress as measured

    if cap is not None and not cap > 0.0:
        raise InputError(f"--seconds {cap!r}: give seconds above 0")
    cap = own_limit() if cap is None else cap
    rows = chosen(ids, quick=False)
    if listed:
        _show_rows(rows, as_json)
        return
    target = None if no_report else writable_folder(Path(folder), "reports") / "stress-table.html"
    found: list[Outcome | str] = []
    broken_off, quiet = False, as_json or bool(layout)
    with progress(len(rows), quiet=quiet) as step:
        try:
            for one in measured(rows, step, cap=cap):  # what came before an interrupt stays
                found.append(one)
                if not (quiet or isinstance(one, str)):
                    click.echo(_measured(one), err=True)
        except KeyboardInterrupt:
            broken_off = True
    result = told(found)
    if found or not broken_off:  # of nothing measured there is nothing to say
        _show(result, as_json, layout, None if broken_off else target)
    if broken_off:
        raise KeyboardInterrupt
    if not result.held:
        raise SystemExit(GATE_FAILED)


def _show_rows(rows: "Sequence[Row]", as_json: bool) -> None:
    """Rows that are not run."""
    if as_json:
        print_json([{"id": row.id, "title": row.title, "promise": row.promised} for row in rows])
        return
    for row in rows:
        click.echo(f"{row.id:34} {row.title}")


def _measured(one: "Outcome") -> str:
    """A row as soon as it is measured."""
    return f"{'held' if one.held else 'NOT HELD':8} {one.seconds:6.1f} s  {one.id}"


def _show(found: "StressFound", as_json: bool, layout: str | None, target: Path | None) -> None:
    if target is not None:
        _write(found, target)
    if as_json:
        print_json(found.plain() | {"report": str(target) if target else None})
    elif layout:
        from verify.report.plain import text_of

        click.echo(text_of(found, layout), nl=False)
    else:
        from verify.report.terminal import print_found

        print_found(found, every_table=False)
        if target is not None:
            click.echo(f"report: {target}")


def _write(found: "StressFound", target: Path) -> None:
    """The page of the table alone. Raises InputError."""
    import sys

    from verify.report.html import write_report
    from verify.run.runner import RunResult
    from verify.scenes.scene import load_scene
    from verify.stress.figures import PUSHED

    seconds = sum(one.seconds for one in found.outcomes)
    scene = load_scene("stress")
    result = RunResult(
        scene=scene,
        gates=(),
        found={"stress": found},
        solves=(),
        n_fields=0,
        n_motions=0,
        seconds=seconds,
        others={PUSHED: len(found.outcomes)},
    )
    write_report(result, target, command=as_line(["verify", *sys.argv[1:]]))
