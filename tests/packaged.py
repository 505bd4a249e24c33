"""Packaged scenes run once for all tests of a process."""

from functools import cache

from verify.report.html import page
from verify.report.plain import run_as_plain
from verify.run.runner import run_scene


@cache
def ran(scene):
    """(the result, every step it told)."""
    steps = []
    return run_scene(scene, steps.append), tuple(steps)


@cache
def told(scene):
    """The same in plain data."""
    return run_as_plain(ran(scene)[0], None)


@cache
def html_of(scene):
    """The page of its report."""
    return page(ran(scene)[0], f"verify run {scene}")
