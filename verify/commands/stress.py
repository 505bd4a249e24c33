"""The stress checks."""

from typing import Any

import click

from verify.commands.shared import GATE_FAILED, format_options, progress, show
from verify.stress.engine import result, run, select


@click.command()
@click.argument("ids", nargs=-1, metavar="[ID]...")
@click.option("--slow", is_flag=True, help="Run the checks that take minutes as well.")
@click.option("--list", "listed", is_flag=True, help="List the checks and run none.")
@format_options
def stress(ids: tuple[str, ...], slow: bool, listed: bool, **formats: Any) -> None:
    """Run the numerical stress checks and report where each tolerance is exceeded; exit 1 where one fails.

    Each check measures an error along one parameter, up to where it exceeds its tolerance or the input is refused.
    Example: `verify stress tip-mass near-resonance`
    """
    checks = select(ids, slow=slow or listed)
    if listed:
        for check in checks:
            click.echo(f"{check.id:28} {check.title}")
        return
    with progress(len(checks), quiet=any(formats.values())) as step:
        step(checks[0].id)
        outcomes = run(checks, progress=step)
    show(result(outcomes), **formats)
    if not all(outcome.passed for outcome in outcomes):
        raise SystemExit(GATE_FAILED)
