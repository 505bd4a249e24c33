"""Compile all kernels, for images and machines that run often."""

import os
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import click

from verify.commands.shared import json_alone, print_json
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.models.compiling import Compiled

FOLDER = "NUMBA_CACHE_DIR"
SLOWEST = 5


@click.command()
@json_alone
def warm_up(as_json: bool) -> None:
    """Compile all kernels and keep them, so that no run has to.

    They are kept in the folder NUMBA_CACHE_DIR of the environment or, without that, beside the package, or in the
    user's cache. Those that are there already are left alone. Example: `NUMBA_CACHE_DIR=/opt/kernels verify warm-up`
    """
    from verify.models import compiling

    began = perf_counter()
    folders = _folders()
    _compile_all()
    if compiling.unkept:
        raise InputError(f"compiled kernels cannot be written to {', '.join(folders)}: set {FOLDER} to another folder")
    own = [one for one in compiling.compiled if not one.kernel.startswith("numba.")]
    found = {
        "seconds": perf_counter() - began,
        "folders": folders,
        "kernels": [{"kernel": one.kernel, "seconds": one.seconds} for one in own],
    }
    if as_json:
        print_json(found)
    else:
        _print(found, own)


def _folders() -> list[str]:
    """Where kernels are kept. Raises InputError where nothing can be."""
    from verify.files import writable_folder
    from verify.models import compiling

    if named := os.environ.get(FOLDER):
        writable_folder(Path(named), FOLDER)
    kernels = [kernel for kernel, _ in _calls()]
    if compiling.unkept:
        raise InputError(f"no folder for compiled kernels can be written to: set {FOLDER} to one that can")
    return sorted({str(kernel.stats.cache_path) for kernel in kernels})


def _calls() -> list[tuple[Any, tuple[Any, ...]]]:
    from verify.chain import warm as chain
    from verify.motion import warm as motion
    from verify.motor import warm as motor
    from verify.stress.motion.friction import one_step, spans

    return [*motion.calls(), *chain.calls(), *motor.calls(), *one_step(), *spans()]


def _compile_all() -> None:
    from verify.models.ahead import compiled_ahead

    with compiled_ahead(_calls):
        for kernel, given in _calls():
            kernel.compile(tuple(kernel.typeof_pyval(value) for value in given))


def _print(found: dict[str, Any], own: "list[Compiled]") -> None:
    if own:
        click.echo(f"compiled {len(own)} kernels in {found['seconds']:.1f} s, the slowest of them:")
        for one in sorted(own, key=lambda one: -one.seconds)[:SLOWEST]:
            click.echo(f"  {one.kernel}  {one.seconds:.2f} s")
    else:
        click.echo(f"all kernels were there already, looked at in {found['seconds']:.1f} s")
    for folder in found["folders"]:
        click.echo(f"kept in {folder}")
