"""The command line. Every command imports what it needs when it runs, and nothing before."""

import atexit
import os
import sys
from contextlib import suppress
from errno import EBADF, EDQUOT, EFBIG, EIO, ENOSPC
from importlib import import_module
from io import StringIO, TextIOWrapper
from typing import Any, NoReturn, TextIO

import click

from verify import __version__
from verify.ending import TERMINATED, end_tidily
from verify.errors import InputError, one_line
from verify.patience import own_limit

BAD_INPUT, INTERRUPTED, NO_READER = 2, 130, 141
NO_ROOM = (ENOSPC, EDQUOT, EFBIG, EIO, EBADF)
"""What a stream says that takes no more."""


class ReaderGoneError(Exception):
    """Whoever read standard output has left."""


COMMANDS = {
    "run": "run",
    "table": "table",
    "bench": "bench",
    "measure": "measure",
    "choose": "choose",
    "compare": "compare",
    "compare-shapes": "compare_shapes:compare_shapes",
    "export": "export",
    "picture": "picture",
    "quantities": "quantities:list_quantities",
    "plan": "plan",
    "report": "report",
    "diff": "diff",
    "stress": "stress",
    "catalogue": "catalogue",
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
        """Run the command that was asked for. Raises InputError for a patience that is none, before that."""
        own_limit()
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise ReaderGoneError from None


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="verify")
def cli() -> None:
    """Say how far a finite-segment model of a vibrating beam can be trusted, and what that costs in run time.

    SCENE is the name of a packaged scene (see `verify scenes`) or the path of a TOML file (see `verify init`).
    Exit status: 0 all well, 1 a gate failed or a plan cannot run, 2 bad input, 130 interrupted, 141 nobody reads on,
    143 terminated. What would take more than 20 s is refused with its estimate; VERIFY_PATIENCE in the environment
    gives more seconds. Readings are shared among all cores; VERIFY_JOBS gives another number of processes.
    """


def status_of(argv: list[str] | None = None) -> int:
    """Run a command line and return its exit status; messages go to the error stream."""
    try:
        result = cli.main(args=argv, prog_name="verify", standalone_mode=False)
        sys.stdout.flush()
        _tell_of_unusable()
        _tell_of_compiling()
    except (BrokenPipeError, ReaderGoneError):
        _hush(sys.stdout)
        return NO_READER
    except InputError as error:
        _complain(*error.sentences)
        return BAD_INPUT
    except click.ClickException as error:
        return _shown(error)
    except (click.Abort, KeyboardInterrupt):
        _complain("interrupted; nothing half-written is left")
        return INTERRUPTED
    except OSError as error:
        if error.errno not in NO_ROOM or error.filename is not None:
            raise
        _hush(sys.stdout)
        _complain(f"what is printed cannot be written ({error.strerror}): make room, or send it elsewhere")
        return BAD_INPUT
    except SystemExit as stop:
        result = stop.code if isinstance(stop.code, int) else BAD_INPUT
        if result == TERMINATED:
            _complain("terminated; nothing half-written is left")
        _tell_of_unusable()
        _tell_of_compiling()
    return result if isinstance(result, int) else 0


def _complain(*sentences: str) -> None:
    """Sentences on the error stream, unless it takes no more."""
    try:
        for sentence in sentences:
            click.echo(f"verify: {sentence}", err=True)
    except OSError:
        _hush(sys.stderr)


def _shown(error: click.ClickException) -> int:
    """What click says of a command line, with nothing in it that a terminal would obey."""
    said = StringIO()
    error.show(said)
    try:
        click.echo("\n".join(map(one_line, said.getvalue().splitlines())), err=True)
    except OSError:
        _hush(sys.stderr)
    return error.exit_code


def _tell_of_unusable() -> None:
    """A sentence for each entry point of other packages that a command looked at and had to leave out."""
    if "verify.registry" in sys.modules:
        from verify.registry import unusable

        _complain(*(f"left out: {why}" for why in unusable()))


def _cores() -> str:
    """How many processes share independent work (`cores`), unless the environment says."""
    return str(len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1)


def _tell_of_compiling() -> None:
    """A sentence where kernels had to be compiled and no folder keeps them."""
    if "verify.models.compiling" in sys.modules:
        from verify.models.compiling import told

        _complain(*told())


def _hush(stream: TextIO) -> None:
    """Whoever read a stream has gone: leave the interpreter nothing to say about it at its end."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def main() -> NoReturn:
    """Entry point of the command `verify`, behind `__main__`.

    The matrices here are small or sparse: BLAS threads only get in each other's way, so one is the default. What a
    terminal cannot show is escaped, and what scipy imports for others is not read (`asleep`). A stream that was closed
    leads nowhere: else the next file that is opened would get its number, and what is printed. Who is told to end
    tidies up first.
    """
    from verify.asleep import put_to_sleep

    put_to_sleep()
    os.environ.setdefault("VERIFY_JOBS", _cores())
    for library in ("OPENBLAS", "MKL", "OMP"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    for name in ("stdin", "stdout", "stderr"):
        if getattr(sys, name) is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), "r" if name == "stdin" else "w"))
    end_tidily()
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    _end(status_of())


def _end(status: int) -> NoReturn:
    """End at once, after whatever asked to be done at the end.

    To take an interpreter down object by object takes a tenth of a second, two where kernels were compiled, and changes
    nothing. Whoever traces or profiles the run gets the long way, to write down what was seen.
    """
    if _is_watched():
        sys.exit(status)
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (OSError, ValueError):
            _hush(stream)
    os._exit(status)


def _is_watched() -> bool:
    """Whether a tracer, a profiler or, from Python 3.12 on, a monitor looks at this process."""
    monitoring = getattr(sys, "monitoring", None)
    tools = () if monitoring is None else map(monitoring.get_tool, range(6))
    return bool(sys.gettrace() or sys.getprofile() or any(tools))
