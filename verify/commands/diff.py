"""What changed between two runs that were kept."""

from pathlib import Path

import click

from verify.commands.shared import json_alone, page_at, print_json

BROKEN = 1


@click.command()
@click.argument("before", metavar="A")
@click.argument("after", metavar="B")
@click.option("--to", "target", metavar="FILE.html", help="Write a page as well.")
@json_alone
def diff(before: str, after: str, target: str | None, as_json: bool) -> None:
    """Say what changed from A to B: gates first, then claims and what is said, versions, inputs.

    Each is a run.json, the folder of a run, a folder of runs (its newest is taken) or a folder of reports (the newest
    of every name). Exit 1 where a gate that was held in A fails in B, whatever else changed.
    Example: `verify diff reports/paper/2026-03-01_14-05-09 reports/paper`
    """
    from verify.files import write_whole
    from verify.report.diff import as_plain, differences, rendered
    from verify.report.kept import runs_at

    page = page_at(target) if target is not None else None
    found = differences(runs_at(Path(before), "A"), runs_at(Path(after), "B"), (before, after))
    if page is not None:
        write_whole(page, rendered(found), "--to")
    if as_json:
        print_json(as_plain(found))
    else:
        from verify.report.terminal_suite import print_differences

        print_differences(found, page)
    if found.broken:
        raise SystemExit(BROKEN)
