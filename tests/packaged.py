"""Packaged scenes run once for all tests: what their runs found, told, called and planned, as data that workers share."""

import fcntl
import os
import sys
from collections import namedtuple
from functools import cache
from pathlib import Path
from unittest import mock

import msgspec

from verify.report.html import page
from verify.report.plain import run_as_plain
from verify.run.kernels_asked import kernels_asked
from verify.run.runner import run_scene
from verify.scenes.scene import load_scene

SHARED: Path | None = None
"""Folder of all workers of one session; None where there is one process."""

Kernel = namedtuple("Kernel", "name types")


class Ran(msgspec.Struct, frozen=True):
    """One run: figures, the page of its report, steps told, studies, how many motions, solves in words, kernels.

    `called` are kernels that Python called, `by_gate` those of each gate, `planned` those of its plan.
    """

    told: dict
    html: str
    steps: list[str]
    studies: list[str]
    motions: int
    solves: list[str]
    called: list[Kernel]
    by_gate: dict[str, list[Kernel]]
    planned: list[Kernel]


@cache
def ran(scene):
    """Run by whoever asks first; who asks meanwhile waits."""
    if SHARED is None:
        return _run(scene)
    kept = SHARED / f"{scene}.json"
    with open(SHARED / f"{scene}.lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not kept.exists():
            kept.write_bytes(msgspec.json.encode(_run(scene)))
    return msgspec.json.decode(kept.read_bytes(), type=Ran)


def _run(scene):
    steps, starts, called = [], [], []

    def begin(step):
        if step.startswith("gate ") and len(called) > max(starts, default=0):
            forget()  # what one gate called, the next calls for the first time too
        steps.append(step)
        starts.append(len(called))

    with mock.patch.dict(os.environ, {"VERIFY_JOBS": "1"}), listening(called):  # nobody compiles ahead
        result = run_scene(scene, begin)
    return Ran(
        told=run_as_plain(result, None),
        html=page(result, f"verify run {scene}"),
        steps=steps,
        studies=list(result.found),
        motions=sum(found.motions() for found in result.found.values()),
        solves=[solve_in_words(one) for one in result.solves],
        called=called,
        by_gate={
            step.removeprefix("gate "): called[start:end]
            for step, start, end in zip(steps, starts, [*starts[1:], len(called)], strict=True)
            if step.startswith("gate ")
        },
        planned=[named(kernel, map(kernel.typeof_pyval, given)) for kernel, given in kernels_asked(load_scene(scene))],
    )


def solve_in_words(one):
    """Size, settings, unknowns and method."""
    return repr((one.model, one.count, one.settings, one.unknowns, one.method))


def named(kernel, types):
    return Kernel(f"{kernel.py_func.__module__.removeprefix('verify.')}.{kernel.__name__}", str(tuple(types)))


INNER = {"chain.recursion_kernels.hub_motion"}
"""Compiled ahead by itself since several others have it in them; Python does not call it."""


def names(kernels):
    """Without the types that they are called with."""
    return {name for name, _ in kernels} - INNER


def listening(called):
    """Kernels that Python calls for the first time are noted; those that were called before are forgotten first."""
    from numba.core.dispatcher import _DispatcherBase

    ask = _DispatcherBase._compile_for_args

    def asked(kernel, *given):
        called.append(named(kernel, map(kernel.typeof_pyval, given)))
        return ask(kernel, *given)

    forget()
    return mock.patch.object(_DispatcherBase, "_compile_for_args", asked)


def forget():
    """What was compiled in this process: a kernel is asked for again when it is called."""
    from numba.core.dispatcher import Dispatcher

    modules = [module for name, module in list(sys.modules.items()) if name.startswith("verify.")]
    for kernel in {id(one): one for module in modules for one in vars(module).values()}.values():
        if isinstance(kernel, Dispatcher):
            kernel.overloads.clear()
            kernel._reset_overloads()


def told(scene):
    return ran(scene).told


def html_of(scene):
    return ran(scene).html


def last_of_each(*assignments):
    """'key=value' words, of every key the last: a small scene and what a test has of its own instead."""
    return tuple({text.partition("=")[0]: text for text in assignments}.values())
