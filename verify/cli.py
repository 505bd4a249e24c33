"""The command line. Every command imports what it needs when it runs, and nothing before."""

import os
import sys
from contextlib import suppress
from importlib import import_module
from io import TextIOWrapper
from typing import Any, NoReturn

import click

from verify import __version__
from verify.errors import InputError

BAD_INPUT, INTERRUPTED, NO_READER = 2, 130, 141


class ReaderGoneError(Exception):
    """Whoever read standard output has left."""


COMMANDS = {
    "run": "run",
    "table": "table",
    "bench": "bench",
    "measure": "measure",
    "choose": "choose",
    "compare": "compare",
    "quantities": "quantities:list_quantities",
    "plan": "plan",
    "stress": "stress",
    "scenes": "scenes",
    "init": "scenes:init",
    "show": "scenes:show",
    "keys": "keys",
    "schema": "keys:schema",
    "warm-up": "warm_up:warm_up",
}
"""Where each command is: a module of `commands`, and its name there where that is another."""


class Commands(click.Group):
    """The commands, each imported when it is asked for.

    A broken pipe is told apart from a failed gate, which click ends with the same status.
    """

    def list_commands(self, ctx: click.Context) -> list[str]:
        """By the alphabet, as click has them."""
        return sorted(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """One of them, None where there is none."""
        if cmd_name not in COMMANDS:
            return None
        module, _, name = COMMANDS[cmd_name].partition(":")
        found: click.Command = getattr(import_module(f"verify.commands.{module}"), name or module)
        return found

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
    than 20 s is refused with its estimate; VERIFY_PATIENCE in the environment gives more seconds. Readings are shared
    among all cores; VERIFY_JOBS gives another number of processes.
    """


def status_of(argv: list[str] | None = None) -> int:
    """Run a command line and return its exit status; messages go to the error stream."""
    try:
        result = cli.main(args=argv, prog_name="verify", standalone_mode=False)
        sys.stdout.flush()
        _tell_of_unusable()
        _tell_of_compiling()
    except (BrokenPipeError, ReaderGoneError):
        _hush()
        return NO_READER
    except InputError as error:
        for sentence in error.sentences:
            click.echo(f"verify: {sentence}", err=True)
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
        _tell_of_compiling()
    return result if isinstance(result, int) else 0


def _tell_of_unusable() -> None:
    """A sentence for each entry point of other packages that a command looked at and had to leave out."""
    if "verify.registry" in sys.modules:
        from verify.registry import unusable

        for why in unusable():
            click.echo(f"verify: left out: {why}", err=True)


def _cores() -> str:
    """How many processes share independent work (`cores`), unless the environment says."""
    return str(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1)


def _tell_of_compiling() -> None:
    """A sentence where kernels had to be compiled and no folder keeps them."""
    if "verify.models.compiling" in sys.modules:
        from verify.models.compiling import told

        for sentence in told():
            click.echo(f"verify: {sentence}", err=True)


def _hush() -> None:
    """Whoever read standard output has gone: leave the interpreter nothing to say about it at its end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main() -> NoReturn:
    """Entry point of the command `verify`, behind `__main__`.

    The matrices here are small or sparse: BLAS threads only get in each other's way, so one is the default. What a
    terminal cannot show is escaped, and what scipy imports for others is not read (`asleep`).
    """
    from verify.asleep import put_to_sleep

    put_to_sleep()
    os.environ.setdefault("VERIFY_JOBS", _cores())
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    sys.exit(status_of())
