"""A run that was kept, rendered again."""

from pathlib import Path

import click

from verify.commands.shared import page_at


@click.command()
@click.argument("run", metavar="RUN.json")
@click.option("--to", "target", metavar="FILE.html", help="Where to. Default: index.html beside RUN.json.")
def report(run: str, target: str | None) -> None:
    """Render the report of a run that was kept again; nothing is computed.

    Example: `verify report reports/paper/2026-03-01_14-05-09/run.json --to paper.html`
    """
    from verify.files import exists, write_whole
    from verify.report.html import rendered
    from verify.report.kept import FILE, PAGE, read_kept

    given = page_at(target) if target is not None else None
    exists(Path(run), "run")  # which refuses a name that no file can have
    path = Path(run) / FILE if Path(run).is_dir() else Path(run)
    kept = read_kept(path, "run")
    page = given or path.parent / (PAGE if path.name == FILE else f"{path.stem}.html")
    write_whole(page, rendered(kept.document), "--to")
    click.echo(f"report: {page}")
