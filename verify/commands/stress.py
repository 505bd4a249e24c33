"""The stress checks."""

from pathlib import Path

import click

from verify.commands.shared import GATE_FAILED, format_options, progress, show


@click.command()
@click.argument("ids", nargs=-1, metavar="[ID]...")
@click.option("--slow", is_flag=True, help="Run the checks that take minutes as well.")
@click.option("--list", "listed", is_flag=True, help="List the checks and run none.")
@click.option("--jobs", type=click.IntRange(1), metavar="N", help="Number of processes. Default: VERIFY_JOBS.")
@click.option("--charts", metavar="FOLDER", help="Write the charts there as SVG.")
@format_options
def stress(
    ids: tuple[str, ...],
    slow: bool,
    listed: bool,
    jobs: int | None,
    charts: str | None,
    as_json: bool,
    as_csv: bool,
    as_markdown: bool,
) -> None:
    """Run the numerical stress checks and report where each tolerance is exceeded; exit 1 where one fails.

    Each check measures an error along one parameter, up to where it exceeds its tolerance or the input is refused.
    Costs are measured last, one at a time. Example: `verify stress tip-mass near-resonance`
    """
    from verify.stress.engine import run, select

    checks = select(ids, slow=slow or listed)
    if listed:
        for one in checks:
            click.echo(f"{one.id:28} {one.title}")
        return
    from verify.stress.report import result

    with progress(len(checks), quiet=as_json or as_csv or as_markdown) as step:
        step(checks[0].id)
        outcomes = run(checks, jobs, step)
    found = result(outcomes)
    show(found, as_json=as_json, as_csv=as_csv, as_markdown=as_markdown)
    if charts:
        from verify.files import writable_folder, write_whole
        from verify.report.plotting import figure_svg

        folder = writable_folder(Path(charts), "--charts")
        for figure in found.figures:
            write_whole(folder / f"{figure.id}.svg", figure_svg(figure))
    if not all(one.passed for one in outcomes):
        raise SystemExit(GATE_FAILED)
