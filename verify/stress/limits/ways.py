"""Which way is taken: methods by size, beams that share a stack, shifts that it starts from; links of any length."""

from functools import partial
from importlib import import_module
from math import ceil, pi
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import Beam
from verify.models.arrays import Array
from verify.section import Section
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import PLAIN
from verify.stress.references.beams import STRIP, held

# --- Methods ----------------------------------------------------------------------------------------------------------

METHODS = (
    (250, 1, False, "dense"),
    (250, 250, False, "dense"),
    (251, 62, False, "sparse"),
    (251, 63, False, "dense SVD"),
    (250, 1, True, "dense inverse"),
    (251, 63, True, "dense inverse"),
    (251, 62, True, "sparse"),
)
"""Unknowns, modes, whether parts are unlike: how vectors are found."""
THIN = replace(STRIP, section=(Section(length=0.4), Section(length=0.33, thickness=0.0001)))
SOLVED: tuple[tuple[Beam, int, int, str], ...] = (
    (STRIP, 9, 40, "dense"),
    (STRIP, 3, 130, "sparse"),
    (STRIP, 70, 130, "dense SVD"),
    (THIN, 3, 40, "dense inverse"),
)
"""Beam, modes, elements, how they are found."""
CLOSED: tuple[tuple[Beam, int, str, str], ...] = (
    (held("clamped", "free"), 900, "euler-bernoulli", "closed form"),
    (STRIP, 3, "timoshenko", "closed form"),
    (STRIP, 500, "rayleigh", "closed form"),
    (STRIP, 500, "timoshenko", "counted"),
    (held("clamped", "free"), 3, "rayleigh", "counted"),
    (THIN, 3, "euler-bernoulli", "counted"),
)
"""Beam, exact modes, theory, how they are found: the cut-off of the strip lies below its mode 500."""
DIVIDED: tuple[tuple[tuple[int, ...], int, list[int]], ...] = (
    ((3, 5, 2), 7, [2, 4, 1]),
    ((1, 1000, 1), 5, [1, 3, 1]),
    ((1, 6, 6, 1), 7, [1, 2, 3, 1]),
    ((1, 10, 10, 1), 11, [1, 4, 5, 1]),
)
"""Lengths of sections, parts, how many each gets: by largest remainders, at least one, and a tie goes to the left."""
UNITS = (1.0, 0.001, 0.073, 1.1, 7.3e-9)
"""Metres, in which shares that are whole are so but for rounding."""
LAYOUTS: tuple[tuple[int, int, int, int, bool], ...] = (
    (7, 60, 5, 0, False),
    (8, 60, 5, 0, True),
    (8, 250, 5, 0, True),
    (8, 251, 5, 0, False),
    (9, 30, 18, 0, True),
    (9, 30, 19, 0, False),
    (9, 32, 18, 2, True),
    (9, 31, 18, 2, False),
)
"""Beams, unknowns, modes, rigid motions: whether they are one stack."""
SHARED: tuple[tuple[int, int, tuple[int, ...]], ...] = (
    (801, 2, (401, 400)),
    (800, 4, (800,)),
    (800, 5, (400, 400)),
    (79, 50, (79,)),
    (160, 100, (80, 80)),
    (170, 100, (43, 43, 43, 41)),
    (9, 8000, (5, 4)),
)
"""Beams, modes, in what parts."""


def methods_error(number: float) -> float:
    """How often a problem is solved or divided another way than its size, its parts and its company say."""
    from verify.exact import modes as exact
    from verify.models import sweeps
    from verify.models.catalogue import MODELS
    from verify.models.division import part_counts
    from verify.models.eigen import method_name
    from verify.models.intervals import rule_over
    from verify.waves.measures import sample_points, window_rule

    wrong = sum(method_name(n, modes, unlike) != name for n, modes, unlike, name in METHODS)
    wrong += sum(MODELS["fem"].solve_modes(beam, modes, n).method != name for beam, modes, n, name in SOLVED)
    wrong += sum(exact.solve_modes(beam, n, theory).method != name for beam, n, theory, name in CLOSED)
    wrong += sum(part_counts([u * one for one in every], n) != each for every, n, each in DIVIDED for u in UNITS)
    for size, n, modes, rigid, shares in LAYOUTS:
        pencil: Any = SimpleNamespace(n=n, rigid_modes=rigid)
        wrong += sweeps._is_stack([3, *range(5, 4 + size)], modes, {3: (pencil, 1.0)}) is not shares
    for size, modes, parts in SHARED:
        cut = sweeps._parts(list(range(2, size + 2)), modes)
        wrong += tuple(map(len, cut)) != parts or [one for part in cut for one in part] != list(range(2, size + 2))
    k, window = 37.0, (0.13, 0.61)
    halves = (window[1] - window[0]) * k / pi
    wrong += len(window_rule(window, k).x) != len(rule_over(window, ceil(2.0 * halves)).x)
    wrong += len(window_rule((0.13, 0.14), k).x) != len(rule_over((0.13, 0.14), 1).x)
    wrong += len(sample_points(window, k)) != ceil(24.0 * halves) + 1
    return float(wrong)


# --- Shifts -----------------------------------------------------------------------------------------------------------

BODY = PointMass(position=0.3, mass=0.05)
STACKED: tuple[Beam, ...] = tuple(
    replace(
        PLAIN,
        length=0.6,
        supports=("clamped", "pinned"),
        section=(
            Section(length=0.2, bending_stiffness=3.1 + i, mass_per_length=0.27),
            Section(length=0.4, bending_stiffness=2.0, mass_per_length=0.2 + 0.03 * i),
        ),
    )
    for i in range(4)
)


def shifts_error(modes: float) -> float:
    """How far shifts of stacks lie from their modes, of the way to the next in fourth roots; all of them settle."""
    from verify.models.isolated import isolated
    from verify.models.stacks import lowest_of_each
    from verify.stress.modes.mixed_stacks import of_links

    n, worst, parts = int(modes), 0.0, 31
    for beams in (STACKED, tuple(replace(one, supports=("free", "guided"), mass=(BODY,)) for one in STACKED)):
        elements = import_module("verify.elements.stacks").element_stack(list(beams), parts, 1.0, "euler-bernoulli")
        chains = import_module("verify.segments.stacks").chain_stack(list(beams), parts, of_links({}))
        for stack in (elements, chains):
            values, settled = lowest_of_each(stack, n + 1)
            with np.errstate(all="ignore"):
                shifts: Array = isolated(stack.pencils, stack.rigid_modes, n) ** 0.25
            roots = values**0.25
            steps = np.diff(roots, axis=0, prepend=-roots[:1])
            off = abs(shifts - roots[:-1]) / np.minimum(steps[1:], steps[:-1])
            worst = largest(worst, float(off.max()), float(not settled.all()))
    return worst


# --- Unlike lengths ---------------------------------------------------------------------------------------------------

THICK = replace(PLAIN, shear_stiffness=900.0, rotary_inertia=3e-6)
HEAVY = (PointMass(position=0.3, mass=0.05, rotary_inertia=2e-5),)
UNEVEN = replace(
    PLAIN,
    section=(
        Section(length=0.25, bending_stiffness=3.1, mass_per_length=0.41),
        Section(length=0.36, bending_stiffness=3.1, mass_per_length=0.27),
    ),
)
GRADED: tuple[tuple[Beam, str, float], ...] = (
    (held("clamped", "free"), "euler-bernoulli", 1.0),
    (replace(THICK, supports=("clamped", "free")), "timoshenko", 1.0),
    (replace(THICK, supports=("guided", "pinned")), "timoshenko", 1.0),
    (replace(THICK, supports=("clamped", "guided")), "rayleigh", 1.0),
    (replace(PLAIN, supports=("free", "pinned"), mass=HEAVY, foundation=900.0), "euler-bernoulli", 1.0),
    (replace(PLAIN, supports=("pinned", "guided"), tension=23.0), "euler-bernoulli", 1.0),
    (replace(UNEVEN, supports=("free", "guided"), foundation=900.0), "euler-bernoulli", 2.0),
)
"""Beam, theory, how many times as much is left to it as to others."""
AT = np.array([0.09, 0.17, 0.33, 0.44, 0.57])
OFF = {"segment": (0.004, 0.003, 0.007), "fem": (6e-5, 6e-4, 0.012)}
"""Of frequencies, shapes and slopes, over the square of the turn of a part."""


def graded_error(parts: float) -> float:
    """Of frequencies, shapes and slopes of parts that grow by half from end to end, over what is left to each."""
    from verify.models.catalogue import MODELS

    n, worst = int(parts), 0.0
    for beam, theory, times in GRADED:
        exact = MODELS["analytic"].solve_modes(beam, 3, n, theory=theory)
        for model in ("segment", "fem"):
            more = {"joints": "tensioned"} if model == "segment" and (beam.tension) else {}
            found = MODELS[model].solve_modes(beam, 3, n, theory=theory, grading=1.5, **more)
            scale = times * (np.arange(2.0, 5.0) * pi / n) ** 2
            off = abs(found.frequencies_hz / exact.frequencies_hz - 1.0)
            worst = largest(worst, float((off / scale).max() / OFF[model][0]))
            for derivative in (0, 1):
                one, other = found.shapes(AT, derivative), exact.shapes(AT, derivative)
                one = one * np.sign((one * other).sum(axis=1))[:, None]
                off = abs(one - other).max(axis=1) / abs(other).max(axis=1)
                worst = largest(worst, float((off / scale).max() / OFF[model][1 + derivative]))
    return worst


_row = partial(Floor, promise=0.5)
ROWS: tuple[Row, ...] = (
    _row(
        id="ways-by-size",
        title="How modes are found, beams divided, which share a stack, in how many points a window is read",
        why="models/eigen.py, division.py, sweeps.py, exact/modes.py, waves/measures.py: sizes of docstrings.",
        along="1",
        at=(1.0,),
        error=methods_error,
    ),
    Floor(
        id="shifts-beside-modes",
        title="Shifts of stacks of elements and links from counts and determinants, against the modes that settle",
        why="models/isolated.py: as near as what moves less in a round, squared.",
        along="modes",
        at=(2.0, 9.0),
        promise=0.001,
        error=shifts_error,
    ),
    Floor(
        id="graded-parts",
        title="Modes, shapes and slopes of links and elements that grow by half along the beam, by every theory",
        why="segments/links.py, elements/mesh.py: order 2 in the turn of a part, or better.",
        along="parts",
        at=(24.0,),
        promise=1.0,
        error=graded_error,
    ),
)
