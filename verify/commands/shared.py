"""What commands share: options of one name, a result on standard output, progress on the error stream."""

import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import click

from verify.errors import InputError, printable
from verify.files import whole, writable_folder, write_whole
from verify.parallel import cluster
from verify.problem.materials import MATERIALS
from verify.problem.phrase import EXAMPLE, PREFIX
from verify.report.plotting import figure_files
from verify.report.result import Result, to_json
from verify.validation import unit

if TYPE_CHECKING:
    from rich.console import Console
    from rich.segment import Segment

CHAINS = ".xml", ".mjcf", ".sdf", ".urdf"
"""Suffixes of chains of rigid bodies."""
GATE_FAILED = 1
"""Exit status where a gate or check failed."""

Seconds = Annotated[float, unit("s")]
Metres = Annotated[float, unit("m")]
Hertz = Annotated[float, unit("Hz")]
scene_argument = click.argument("scene")


class BeamCommand(click.Command):
    """A command that has `--beam PHRASE` in place of its argument SCENE, or of the option that names a scene."""

    def __init__(self, *values: Any, **options: Any) -> None:
        super().__init__(*values, **options)
        text = f"A beam in place of SCENE: '{EXAMPLE}'. Sections: WIDTH x THICKNESS, round DIAMETER, tube DIAMETER x "
        text += f"WALL. Materials: {', '.join(MATERIALS)}, or E=69GPa rho=2.7g/cm3."
        self.params.append(click.Option(["--beam"], metavar="PHRASE", expose_value=False, help=text))

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Insert the phrase in front, as the name of the scene or after the option."""
        if not args and any(parameter.required for parameter in self.params):
            examples = re.findall("Example: `([^`]+)`", " ".join((self.help or "").split()))
            ctx.fail(f"Missing arguments, for example: {examples[0]}")
        for word, following in pairwise([*args, ""]):
            name, _, phrase = word.partition("=")
            if name == "--beam":
                option = [x.opts[0] for x in self.params if x.name == "scene" and isinstance(x, click.Option)]
                return super().parse_args(ctx, [*option, PREFIX + (phrase or following), *args])
        return super().parse_args(ctx, args)


_SET = "Override a value of the scene: beam.length=0.4, gate.ID.within=0.01 (in the quantity's unit)."
overrides_option = click.option("--set", "overrides", multiple=True, metavar="KEY=VALUE", help=_SET)
json_option = click.option("--json", "as_json", is_flag=True, help="Print JSON and nothing else.")
csv_option = click.option("--csv", "as_csv", is_flag=True, help="Print the first table as CSV, in SI units.")
markdown_option = click.option("--markdown", "as_markdown", is_flag=True, help="Print the first table as Markdown.")


def cluster_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add `--scheduler` and `--local-cluster`, which run the command inside `parallel.cluster`."""

    def enter(ctx: click.Context, option: click.Parameter, where: str | int | None) -> None:
        if where is not None:
            ctx.with_resource(cluster(where))

    hidden: Any = {"callback": enter, "expose_value": False}
    scheduler = "Run on the workers of this dask scheduler, tcp://HOST:8786 (extra `cluster`)."
    local, number = "Run on a dask cluster of N processes of this machine.", click.IntRange(min=1)
    command = click.option("--scheduler", metavar="ADDRESS", help=scheduler, **hidden)(command)
    return click.option("--local-cluster", metavar="N", type=number, help=local, **hidden)(command)


def format_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add `--json`, `--csv` and `--markdown`, passed as `as_json`, `as_csv`, `as_markdown` (see `show`)."""
    return json_option(csv_option(markdown_option(command)))


def output_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add the options of `format_options`, and `--charts`."""
    text = "Write the charts to FOLDER as SVG and PNG."
    return click.option("--charts", metavar="FOLDER", help=text)(format_options(command))


def show(
    result: Result, *, as_json: bool = False, as_csv: bool = False, as_markdown: bool = False, charts: str | None = None
) -> None:
    """Print a result on standard output: for a person, or in one of the formats for programs; write its charts.

    Exit status 1 where `data` says that it has not passed. Raises click.UsageError for more than one format, InputError
    for CSV or Markdown of a result without a table.
    """
    if as_json + as_csv + as_markdown > 1:
        raise click.UsageError("--json, --csv and --markdown exclude each other: give one of them.")
    if as_json:
        print_json(result.to_dict())
    elif as_csv or as_markdown:
        if not result.tables:
            option = "--csv" if as_csv else "--markdown"
            raise InputError(f"{option}: this result has no table, leave it out or use --json")
        text = result.tables[0].csv() if as_csv else result.tables[0].markdown()
        click.echo(printable(text, "\n\t"), nl=False)
    else:
        result.print(console())
    if charts is not None:
        folder = writable_folder(Path(charts), "--charts")
        for figure in result.figures:
            svg, png = figure_files(figure)
            write_whole(folder / f"{figure.id}.svg", svg, "--charts")
            with whole(folder / f"{figure.id}.png", "--charts") as part:
                part.write_bytes(png)
    if not result.data.get("passed", True):
        raise SystemExit(GATE_FAILED)


def print_json(value: Any) -> None:
    """Print plain data as JSON on standard output."""
    click.echo(to_json(value), nl=False)


def console() -> "Console":
    """Standard output for rich: as wide as the terminal, 100 columns where it is none, without markup."""
    from rich.console import Console

    class Output(Console):
        def on_broken_pipe(self) -> None:
            """Leave a closed pipe to `cli`: rich would exit with the status of a failed gate."""
            raise BrokenPipeError

        def render(self, *args: Any, **options: Any) -> Iterator["Segment"]:
            """Escape what names and titles from files would have a terminal do."""
            for part in super().render(*args, **options):
                yield part if part.control else part._replace(text=printable(part.text, "\n"))

    width = None if sys.stdout.isatty() else 100
    return Output(file=sys.stdout, markup=False, highlight=False, emoji=False, width=width)


@contextmanager
def progress(total: int | None = None, *, quiet: bool = False, lines: bool = False) -> Iterator[Callable[[str], None]]:
    """A bar on the error stream where that is a terminal; elsewhere silence, or with `lines` a line for each step.

    The context is a function to call with the name of each step before the step; `total` is the number of steps
    where it is known, from which the bar estimates the time that remains.
    """
    if quiet or not sys.stderr.isatty():
        yield lambda step: click.echo(step, err=True) if lines and not quiet else None
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    left = [TimeRemainingColumn(), TextColumn("left,")] if total else []
    what = TextColumn("{task.description}", markup=False)
    columns = (SpinnerColumn(), BarColumn(20), TimeElapsedColumn(), *left, what)
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("", total=total)
        done = -1

        def advance(step: str) -> None:
            nonlocal done
            done += 1
            bar.update(task, description=step, completed=done if total else None)

        yield advance
