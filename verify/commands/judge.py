"""`verify judge`: a verdict on the runs of a case in any engine."""

from pathlib import Path
from time import perf_counter
from typing import Any

import click

from verify.commands import shared
from verify.commands.choose import relative_error
from verify.files import write_whole
from verify.sheets.judge import judge_case, junit, page
from verify.validation import convert, typed


@click.command()
@click.argument("case")
@click.argument("records", nargs=-1, required=True, metavar="RUN...")
@click.option("--counts", metavar="N,...", help="Links, or steps, of every run: for the order of the errors.")
@click.option("--within", metavar="E", help="Largest relative error that passes. Default: that of the sheet.")
@click.option("--junit", "junit_file", metavar="FILE", help="Write the figures as JUnit XML, a test each.")
@click.option("--report", metavar="FILE", help="Write the page (HTML).")
@shared.format_options
def judge(
    case: str,
    records: tuple[str, ...],
    counts: str | None,
    within: str | None,
    junit_file: str | None,
    report: str | None,
    **formats: Any,
) -> None:
    """Judge the table of numbers that a run of CASE gave in any engine: error, order, class, likely cause.

    RUN is a table with the columns of `verify cases CASE`; of several the last one is judged. Exit status 1 where a
    figure is off by more than passes. Example: `verify judge ring-down run10.csv run20.csv --counts 10,20`
    """
    sizes = None if counts is None else convert(typed(counts, tuple[int, ...], "counts"), tuple[int, ...], "counts")
    limit = None if within is None else relative_error(within)
    begun = perf_counter()
    result = judge_case(case, records, counts=sizes, within=limit)
    if junit_file:
        write_whole(Path(junit_file), junit(result), "junit")
    if report:
        command = " ".join(["verify judge", case, *records, *(["--counts", counts] if counts else [])])
        write_whole(Path(report), page(result, command, perf_counter() - begun), "report")
    shared.show(result, **formats)
