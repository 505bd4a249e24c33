"""Beams and comparisons that tests of this folder share; each search runs once."""

from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from verify.compare.compare import Options, compare
from verify.compare.reading import listed, read_frequencies
from verify.problem.beam import Beam
from verify.problem.cross_section import Section

DATA = Path(__file__).parent / "data"
STRIP = {"length": 0.3, "width": 0.025, "thickness": 0.003, "youngs_modulus": 206e9, "density": 7850.0}
CANTILEVER = Beam(**STRIP, supports=("clamped", "free"))
PROPPED = Beam(**STRIP, supports=("clamped", "pinned"))
HELD = Beam(**STRIP, supports=("clamped", "clamped"))
FREE = Beam(**STRIP, supports=("free", "free"))
STEPS = (Section(length=0.125, thickness=0.004), Section(length=0.175, youngs_modulus=70e9, density=2700.0))
STEPPED = Beam(**STRIP, section=STEPS, supports=("clamped", "pinned"))


@cache
def _compared(beam, hertz, cells, options):
    return compare(SimpleNamespace(name="beam", beam=beam), listed("list", hertz, cells), None, options)


def compared(beam, hertz, digits=None, **options):
    """The result of a list of Hz, perhaps rounded to so many significant digits."""
    cells = tuple(f"{f:.{digits - 1}e}" if digits else repr(float(f)) for f in hertz)
    return _compared(beam, tuple(map(float, cells)), cells, Options(**options))


@cache
def recorded(name, beam, **options):
    """The result of a list of `data`."""
    return compare(SimpleNamespace(name="beam", beam=beam), read_frequencies(DATA / name), None, Options(**options))


def table(result, title):
    """Rows of a table, by column."""
    return next(one for one in result.tables if one.title == title).records()


def exudyn():
    """(frequencies in Hz (8,), places (30,), shapes (8, 30)) of 30 links with 2EI/l at the wall."""
    shapes = np.loadtxt(DATA / "exudyn-cantilever-shapes.csv", delimiter=",", skiprows=1)
    return np.loadtxt(DATA / "exudyn-cantilever.csv", delimiter=",", skiprows=1)[:, 1], shapes[:, 0], shapes[:, 1:].T
