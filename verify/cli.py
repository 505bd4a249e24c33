"""The command line. Every command imports what it needs when it runs, and nothing before."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from verify import __version__
from verify.cli_compare import compare
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

PERCENT = 100
BAD_INPUT, GATE_FAILED, INTERRUPTED, NO_READER = 2, 1, 130, 141

_overrides = click.option(
    "--set", "overrides", multiple=True, metavar="KEY=VALUE", help="Override a value of the scene: beam.length=0.4."
)
_as_json = click.option("--json", "as_json", is_flag=True, help="Print JSON and nothing else.")
_scene = click.argument("scene")


class ReaderGoneError(Exception):
    """Whoever read standard output has left."""


class Commands(click.Group):
    """The commands. A broken pipe is told apart from a failed gate, which click ends with the same status."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command that was asked for."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise ReaderGoneError from None


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="verify")
def cli() -> None:
    """Say how far a finite-segment model of a vibrating beam can be trusted, and what that costs in run time.

    SCENE is the name of a packaged scene (see `verify scenes`) or the path of a TOML file (see `verify init`).
    Exit status: 0 all well, 1 a gate failed, 2 bad input, 130 interrupted, 141 nobody reads on. What would take more
    than 20 s is refused with its estimate; VERIFY_PATIENCE in the environment gives more seconds.
    """


@cli.command()
@_scene
@_overrides
@click.option(
    "--reports", "folder", default="reports", show_default=True, metavar="PATH", help="Folder for the HTML report."
)
@click.option("--no-report", is_flag=True, help="Judge only; write nothing.")
@_as_json
def run(scene: str, overrides: tuple[str, ...], folder: str, no_report: bool, as_json: bool) -> None:
    """Run everything SCENE asks for; write its report; exit 1 when a gate fails."""
    from verify.files import writable_folder
    from verify.run.runner import n_steps, run_scene

    asked = _load(scene, overrides)
    target = None if no_report else writable_folder(Path(folder), "reports") / f"{asked.name}.html"
    with _progress(n_steps(asked), quiet=as_json) as step:
        result = run_scene(asked, step)
    if target is not None:
        from verify.report.html import write_report

        write_report(result, target, command=_command_line("run", scene, overrides))
    if as_json:
        from verify.report.plain import run_as_plain

        _print_json(run_as_plain(result, target))
    else:
        from verify.report.terminal import print_run

        print_run(result, target)
    if not result.passed:
        raise SystemExit(GATE_FAILED)


@cli.command()
@_scene
@click.argument("arguments", nargs=-1, metavar="[KEY=VALUE]...")
@_overrides
@click.option("--modes", metavar="LIST", help="Modes, for instance 1,5,22. Default: the scene's [convergence].")
@click.option("--counts", metavar="LIST", help="Segments and elements, for instance 10,20,49,98.")
@click.option("--of", "study", metavar="STUDY", help="Whatever a study of SCENE finds, by the name of its section.")
@click.option("--wave", is_flag=True, help="The motor's figures over the counts instead of modes.")
@click.option("--slider", is_flag=True, help="The slider's displacement and its run time over the counts.")
@click.option(
    "--sweep",
    "sweeps",
    multiple=True,
    metavar="AXIS=START:END:STEPS",
    help="A wave quantity over one or two axes: frequency_hz, phase_deg, position, loss_factor, count.",
)
@click.option(
    "--quantity",
    help="What a sweep maps, with its other arguments as KEY=VALUE. Default: wave.standing_wave_ratio.",
)
@_as_json
@click.option("--csv", "layout", flag_value="csv", help="Print comma-separated values.")
@click.option("--markdown", "layout", flag_value="markdown", help="Print a Markdown table.")
def table(
    scene: str,
    arguments: tuple[str, ...],
    overrides: tuple[str, ...],
    modes: str | None,
    counts: str | None,
    study: str | None,
    wave: bool,
    slider: bool,
    sweeps: tuple[str, ...],
    quantity: str | None,
    as_json: bool,
    layout: str | None,
) -> None:
    """All discrete models side by side; any study; the motor's figures or the slider's over sizes; or a sweep."""
    from verify.run import tables

    asked = _load(scene, overrides)
    if arguments and not sweeps:
        raise InputError(f"{arguments[0]!r}: KEY=VALUE arguments belong to a --sweep")
    tables.check_options(
        {"--of": study is not None, "--sweep": sweeps, "--slider": slider, "--wave": wave},
        {"--modes": modes is not None, "--counts": counts is not None, "--quantity": quantity is not None},
    )
    if study is not None:
        job = tables.study_of(asked, study)
    elif sweeps:
        job = tables.sweep(asked, sweeps, quantity or "wave.standing_wave_ratio", arguments)
    elif slider:
        job = tables.slider(asked, counts)
    else:
        job = tables.motor(asked, counts) if wave else tables.convergence(asked, modes, counts)
    with _progress(job.n_steps, quiet=as_json or bool(layout)) as step:
        found = job.run(step)
    if as_json or layout:
        from verify.report.plain import text_of

        click.echo(text_of(found, layout or "json"), nl=False)
    else:
        from verify.report.terminal import print_found

        print_found(found)


@cli.command()
@click.argument("quantity")
@click.argument("arguments", nargs=-1, metavar="[KEY=VALUE]...")
@click.option("--scene", default="paper", show_default=True, help="Whose beam and drive.")
@_overrides
@_as_json
def measure(quantity: str, arguments: tuple[str, ...], scene: str, overrides: tuple[str, ...], as_json: bool) -> None:
    """Any named QUANTITY: `verify measure mode.frequency_error model=segment mode=22 count=49`."""
    from verify.judge.workbench import Workbench
    from verify.quantities import catalogue as quantities
    from verify.scenes.toml import given_arguments

    found = quantities.quantity(quantity)
    given = given_arguments(arguments)
    checked = quantities.arguments_of(found, given)
    asked = _load(scene, overrides)
    bench = Workbench(asked.beam)
    with _progress(PERCENT, quiet=as_json) as step:
        bench.tell = _in_percent(step)
        value = quantities.evaluate(found, checked, asked, bench)
    if isinstance(value, float) and isnan(value):
        raise InputError(f"{quantity} is not a number for these arguments: they lie beyond what floating point carries")
    plain = quantities.as_plain(value)
    if as_json:
        shown = quantities.arguments_as_plain(checked, given)
        _print_json({"quantity": quantity, "arguments": shown, "value": plain, "unit": found.unit})
    else:
        click.echo(f"{quantity} = {quantities.in_words(plain)} {found.unit}".removesuffix(" 1"))


@cli.command()
@click.option("--mode", required=True, metavar="N", help="Mode number from 1.")
@click.option("--error", required=True, metavar="E", help="Largest frequency error: 1% or 0.01.")
@click.option("--scene", default="paper", show_default=True, help="Whose beam.")
@_overrides
@_as_json
def choose(mode: str, error: str, scene: str, overrides: tuple[str, ...], as_json: bool) -> None:
    """From how many segments or elements on an accuracy is kept, how that is known, and what they cost."""
    from verify.judge.workbench import Workbench
    from verify.report.plain import accuracy, choice_as_plain, mode_number

    wanted, number = accuracy(error), mode_number(mode)
    beam = _load(scene, overrides).beam
    from verify.judge.sizing import choose_of_all

    bench = Workbench(beam)
    choices, left_out = choose_of_all(bench, number, wanted)
    if as_json:
        _print_json(choice_as_plain(bench, number, wanted, choices, left_out))
    else:
        from verify.report.terminal import print_choices

        print_choices(bench.exact_hz(number), number, wanted, choices, left_out)


@cli.command("quantities")
@_as_json
def list_quantities(as_json: bool) -> None:
    """List the named quantities with their arguments, units and defaults."""
    from verify.quantities.catalogue import described

    listed = described()
    if as_json:
        _print_json(listed)
        return
    for one in listed:
        click.secho(one["quantity"], bold=True, nl=False)
        click.echo(f"  [{one['unit']}]  {one['summary']}")
        for argument in one["arguments"]:
            default = "required" if argument["required"] else f"default {argument['default']}"
            click.echo(f"    {argument['name']:<13} {argument['type']}; {default}. {argument['meaning']}".rstrip())


@cli.command()
@_scene
@_overrides
@_as_json
def plan(scene: str, overrides: tuple[str, ...], as_json: bool) -> None:
    """Print what SCENE will run, what is skipped, and why. Solves nothing."""
    from verify.run.plan import plan_scene

    planned = plan_scene(_load(scene, overrides))
    if as_json:
        import msgspec

        _print_json(msgspec.to_builtins(planned))
    else:
        from verify.report.terminal import print_plan

        print_plan(planned)


@cli.command()
@_as_json
def scenes(as_json: bool) -> None:
    """List the packaged scenes."""
    from verify.scenes.scene import load_scene, packaged_scenes

    found = [load_scene(name) for name in packaged_scenes()]
    if as_json:
        _print_json([{"scene": s.name, "title": s.title, "gates": len(s.gate)} for s in found])
        return
    for one in found:
        click.secho(one.name, bold=True, nl=False)
        click.echo(f"  {one.title} ({len(one.gate)} gates)")


@cli.command()
@click.argument("path")
@click.option("--force", is_flag=True, help="Replace a file that is there.")
@_as_json
def init(path: str, force: bool, as_json: bool) -> None:
    """Write a commented scene to PATH to start from."""
    from verify.files import exists, write_whole
    from verify.scenes.scene import STARTER

    if path.startswith("--"):
        raise InputError(f"path = {path!r} looks like an option: write it as './{path}'")
    if exists(Path(path), "path") and not force:
        raise InputError(f"path = {path!r} exists: name another file, or replace it with --force")
    write_whole(Path(path), STARTER.read_text("utf-8"), "path")
    if as_json:
        _print_json({"path": path, "next": ["verify", "run", path]})
    else:
        click.echo(f"wrote {path}; next: verify run {path}")


cli.add_command(compare)


def _load(scene: str, overrides: tuple[str, ...]) -> "Scene":
    from verify.scenes.scene import load_scene

    return load_scene(scene, overrides)


def _print_json(data: Any) -> None:
    import json

    from verify.report.plain import finite

    click.echo(json.dumps(finite(data), indent=2, allow_nan=False))


def _command_line(command: str, scene: str, overrides: tuple[str, ...]) -> str:
    from shlex import join

    return join(["verify", command, scene, *(word for text in overrides for word in ("--set", text))])


def _in_percent(step: Callable[[str], None]) -> Callable[[float], None]:
    """Parts of a whole, told to a bar of a hundred steps."""
    shown = 0

    def tell(part: float) -> None:
        nonlocal shown
        while shown < int(PERCENT * part):
            shown += 1
            step("motion in time")

    return tell


@contextmanager
def _progress(n_steps: int, *, quiet: bool) -> Iterator[Callable[[str], None]]:
    """A bar on the error stream where somebody looks at it; silence elsewhere."""
    if quiet or not sys.stderr.isatty():
        yield lambda step: None
        return
    from verify.report.terminal import progress_bar

    with progress_bar(n_steps) as step:
        yield step


def status_of(argv: list[str] | None = None) -> int:
    """Run a command line and return its exit status; messages go to the error stream."""
    try:
        result = cli.main(args=argv, prog_name="verify", standalone_mode=False)
        sys.stdout.flush()
        _tell_of_unusable()
    except (BrokenPipeError, ReaderGoneError):
        _hush()
        return NO_READER
    except InputError as error:
        click.echo(f"verify: {error}", err=True)
        return BAD_INPUT
    except click.ClickException as error:
        error.show()
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        click.echo("verify: interrupted; nothing half-written is left", err=True)
        return INTERRUPTED
    except SystemExit as stop:
        result = stop.code if isinstance(stop.code, int) else BAD_INPUT
        _tell_of_unusable()
    return result if isinstance(result, int) else 0


def _tell_of_unusable() -> None:
    """A sentence for each entry point of other packages that a command looked at and had to leave out."""
    if "verify.registry" in sys.modules:
        from verify.registry import unusable

        for why in unusable():
            click.echo(f"verify: left out: {why}", err=True)


def _hush() -> None:
    """Whoever read standard output has gone: leave the interpreter nothing to say about it at its end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main() -> NoReturn:
    """Entry point of the command `verify`, behind `__main__`.

    The matrices here are small or sparse: BLAS threads only get in each other's way, so one is the default. What a
    terminal cannot show is escaped.
    """
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    sys.exit(status_of())
