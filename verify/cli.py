"""The command line: a group whose commands are imported when they are called."""

import os
import sys
from errno import EDQUOT, EFBIG, EIO, ENOSPC
from importlib import import_module
from io import StringIO, TextIOWrapper
from signal import SIG_IGN, SIGINT, signal
from typing import Any, NoReturn

import click

from verify import __version__
from verify.errors import InputError, printable

BAD_INPUT, INTERRUPTED, BROKEN_PIPE = 2, 130, 141
COMMANDS = {
    "run": "Run gates and studies of scenes and write reports.",
    "plan": "Show which gates and studies of a scene run, and why not.",
    "scenes": "List the packaged scenes; show one, or write a new one.",
    "quantities": "List the quantities and their arguments.",
    "measure": "Evaluate a quantity of a scene.",
    "table": "Run one study of a scene and print its tables.",
    "choose": "Smallest number of segments and elements for an accuracy.",
    "chain": "Joints and links as rigid bodies for MuJoCo, Gazebo, Drake.",
    "sweep": "Evaluate quantities over lists of values.",
    "compare": "Identify the discretisation behind natural frequencies.",
    "identify": "Stiffness, clamp and damping of a strip from records.",
    "cases": "Problems of known answer for any engine: sheets, files.",
    "judge": "Judge the table of numbers of a run of a case.",
    "bench": "Measure run time over error of all methods.",
    "stress": "Run the numerical stress checks.",
    "export": "Write modes, the driven wave or the motion to a file.",
    "diff": "Show what differs between saved runs.",
    "schema": "List the keys of a scene file.",
}
"""The commands, which are the modules of `verify.commands`, with their line in `verify --help`, which imports none."""


class BrokenPipe(Exception):  # noqa: N818
    """Standard output is closed. Click turns BrokenPipeError into exit status 1, that of a failed gate."""


class Commands(click.Group):
    """The commands, each imported on first use."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Names in the order of a session."""
        return list(COMMANDS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """The command of a name; None where there is none."""
        if cmd_name not in COMMANDS:
            return None
        command: click.Command = getattr(import_module(f"verify.commands.{cmd_name}"), cmd_name)
        return command

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of the commands."""
        with formatter.section("Commands"):
            formatter.write_dl(list(COMMANDS.items()))

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise BrokenPipe from None


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="verify")
def cli() -> None:
    """Verify finite-segment models of vibrating beams: how far they can be trusted, and what that costs in run time.

    SCENE is the name of a packaged scene (`verify scenes`) or the path of a TOML file (`verify scenes init`).
    Exit status: 0 success, 1 a gate or check failed, 2 bad input, 130 interrupted, 141 broken pipe.
    VERIFY_JOBS in the environment sets the number of processes, all cores unless set.
    """


def status_of(argv: list[str] | None = None) -> int:
    """Run a command line and return its exit status; messages go to the error stream."""
    try:
        cli.main(args=argv, prog_name="verify", standalone_mode=False)
        sys.stdout.flush()
        return 0
    except InputError as error:
        status, sentences = BAD_INPUT, list(error.sentences)
    except click.ClickException as error:
        text = StringIO()
        error.show(text)
        click.echo("\n".join(map(printable, text.getvalue().splitlines())), err=True)
        return error.exit_code
    except (click.Abort, KeyboardInterrupt):
        status, sentences = INTERRUPTED, ["interrupted"]
    except (BrokenPipe, BrokenPipeError):
        status, sentences = BROKEN_PIPE, []
    except OSError as error:
        if error.errno not in (ENOSPC, EIO, EFBIG, EDQUOT) or error.filename is not None:
            raise
        status = BAD_INPUT
        sentences = [f"standard output = {error.strerror}: free disk space, or write elsewhere"]
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except SystemExit as stop:
        return stop.code if isinstance(stop.code, int) else BAD_INPUT
    if status == BROKEN_PIPE:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # nothing is left to be flushed at exit
    for sentence in sentences:
        click.echo(f"verify: {sentence}", err=True)
    return status


def main() -> NoReturn:
    """Entry point of the command `verify`.

    This process is its own: BLAS has one thread from the start, while `one_blas_thread` only stops the others.
    """
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    os.environ.setdefault("VERIFY_JOBS", str(os.cpu_count() or 1))
    os.environ["MPLBACKEND"] = "agg"  # charts go to files, whatever shows those of other programs
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by the caller, as for jobs without a terminal
            setattr(sys, name, open(os.devnull, "w", encoding="utf-8"))  # noqa: SIM115  # until the process ends
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    try:
        status = status_of()
        signal(SIGINT, SIG_IGN)  # an interrupt of the interpreter's end would be printed as an ignored exception
    except KeyboardInterrupt:
        status = INTERRUPTED
    sys.exit(status)
