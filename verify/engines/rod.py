"""A rod along a curve in a plane or in space: its stiffnesses, mass and section frame, from a table of points.

The curve is a cubic spline through the points, by its arc length. Columns are linear between points, and EI by columns
of sizes; a point that is given twice is a step. `u` is the direction in which bending with EI deflects, `u` x tangent
that of EI2. At the start `u` lies in the plane of a table of x and y, else it is the normal nearest to z (x where the
curve starts along z); from there it is transported without rotation about the tangent, and turned about it by `roll`.
"""

import csv
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property, lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from verify.arrays import Array
from verify.errors import InputError, near_name, raise_all, shown
from verify.exact.torsion import shafts
from verify.files import read_text
from verify.problem.beam import Beam, in_plane
from verify.problem.cross_section import ALL_SIZES
from verify.problem.phrase import beam_table
from verify.validation import as_tuple, in_si

UNITS = {"x": "m", "y": "m", "z": "m", "EI": "N m^2", "EI2": "N m^2", "GJ": "N m^2", "rho_A": "kg/m", "rho_Ip": "kg m",
         "roll": "deg", "width": "m", "thickness": "m", "diameter": "m", "wall_thickness": "m", "E": "Pa",
         "rho": "kg/m^3", "nu": "1"}  # fmt: skip
"""Columns and their SI units, but for the angle."""
MATERIAL = {"E": "youngs_modulus", "rho": "density", "nu": "poissons_ratio"}
VALUES = ("EI", "EI2", "GJ", "rho_A", "rho_Ip", "roll", "width", "thickness")
"""Columns of `Rod.values`."""
POWERS = np.array([(1, 3, 0), (3, 1, 0), (3, 3, -2), (1, 1, 0), (1, 1, 2), *[(0, 0, 0)] * 3])
"""Of width, thickness and diagonal in them: exact but for GJ, Saint-Venant's A^4/40I, of which the ratio varies little.
"""
HEAD = re.compile(r"\s*(\w+)\s*(?:[\[(](.*)[\])])?\s*")
HUGE, MEET = 1e50, 1e-4
"""Limit of values; distance of the ends over the length up to which a curve is closed."""
CLAMPED = "clamped at its first point, free at its last"
LARGEST = 10_000_000
"""Bytes of a table, as of a scene with long lists."""
GAUSS = np.polynomial.legendre.leggauss(8)
"""Points and weights between two changes of a value: 1/EI to 1e-9 where EI changes 10 times, moments to rounding."""
STRAIGHT = 1e-6
"""Length less the distance of the ends over the length up to which a curve is straight: a bow of 6e-4."""
ALONG_Z = 0.99
"""Cosine to z from which the first section is placed by x: 8 degrees."""


@dataclass(frozen=True, eq=False)
class Rod:
    """`points`, m, (P, 3), and `values` there, (P, 8), in the order of VALUES, SI, radians; in a plane or in space."""

    points: Array
    values: Array
    in_space: bool
    start: Array
    """`u` at the start but for its part along the tangent, (3,)."""
    sized: tuple[str, ...] = ()
    """Names of values that are of a section, whose sizes are linear between points."""

    @cached_property
    def _spline(self) -> tuple[Array, Callable[..., Array]]:
        return spline(self.points)

    @property
    def s(self) -> Array:
        """Arc length at the points, m, (P,)."""
        return self._spline[0]

    @cached_property
    def bent(self) -> bool:
        """Whether the curve is no straight line."""
        return bool(np.linalg.norm(self.points[-1] - self.points[0]) < (1.0 - STRAIGHT) * self.s[-1])

    @property
    def turning(self) -> float:
        """Angles between the tangents at the points together, rad."""
        tangents = self._spline[1](np.unique(self.s), 1)
        tangents /= np.linalg.norm(tangents, axis=1)[:, None]
        return float(np.arccos(np.clip((tangents[1:] * tangents[:-1]).sum(axis=1), -1.0, 1.0)).sum())

    def place(self, s: Array) -> Array:
        """Points at arc lengths, m, (n, 3)."""
        return np.asarray(self._spline[1](s))

    def at(self, s: Array) -> Array:
        """`values` at arc lengths, (n, 8)."""
        powers = POWERS * np.isin(VALUES, self.sized)[:, None]

        def section(sizes: Array) -> Array:
            sides = np.column_stack([sizes, np.hypot(*sizes.T)])
            return np.asarray((sides[:, None] ** powers).prod(axis=2))

        rest = self.values / section(self.values[:, 6:])
        values = np.stack([np.interp(s, self.s, one) for one in rest.T], axis=1)
        return np.asarray(values * section(values[:, 6:]))

    def frames(self, s: Array) -> Array:
        """Frames (tangent, `u` x tangent, `u`) at ascending arc lengths from 0, (n, 3, 3).

        `u` is carried along without rotation about the tangent by double reflection, order 4 (Wang et al., ACM
        Transactions on Graphics 27, 2008), and turned by the roll.
        """
        places, tangents, roll = self.place(s), self._spline[1](s, 1), self.at(s)[:, 5, None]
        tangents /= np.linalg.norm(tangents, axis=1)[:, None]
        u = self.start - (self.start @ tangents[0]) * tangents[0]
        every = [u / np.linalg.norm(u)]
        for t, chord, ahead in zip(tangents, np.diff(places, axis=0), tangents[1:], strict=False):
            both, share = np.array([every[-1], t]), 2.0 / (chord @ chord)
            u, back = both - share * np.outer(both @ chord, chord)
            over = ahead - back
            u = u - 2.0 * (u @ over) / (over @ over) * over
            every.append(u - (u @ ahead) * ahead)
        along = np.array(every) / np.linalg.norm(every, axis=1)[:, None]
        along = np.cos(roll) * along + np.sin(roll) * np.cross(tangents, along)
        return np.stack([tangents, np.cross(along, tangents), along], axis=2)

    @cached_property
    def jumps(self) -> Array:
        """Arc lengths at which EI, EI2 or GJ jumps, m."""
        at = np.flatnonzero(np.diff(self.s) == 0.0)
        return np.asarray(self.s[at[(self.values[at, :3] != self.values[at + 1, :3]).any(axis=1)]])

    def quadrature(self, cuts: Array) -> tuple[Array, Array]:
        """Points and weights between all points of the table and `cuts`, (n,), m."""
        edges = np.unique(np.concatenate([self.s, cuts]))
        half = 0.5 * np.diff(edges)[:, None]
        return (edges[:-1, None] + half * (1.0 + GAUSS[0])).ravel(), (half * GAUSS[1]).ravel()


def spline(points: Array) -> tuple[Array, Callable[..., Array]]:
    """(arc length at points, (P,), m, place by arc length) of the curve through points, (P, 3), some twice."""
    from scipy.interpolate import CubicSpline

    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    apart = np.append(True, steps > 1e-9 * steps.sum())
    places, x, w = points[apart], *GAUSS
    knots = np.append(0.0, np.cumsum(steps[apart[1:]]))
    for _ in range(4):  # the spline by its own length: its speed differs from 1 by the error of the spline
        curve, h = CubicSpline(knots, places), np.diff(knots)
        at = knots[:-1, None] + 0.5 * h[:, None] * (1.0 + x)
        knots = np.append(0.0, np.cumsum(0.5 * h * (np.linalg.norm(curve(at, 1), axis=2) @ w)))
    return knots[np.cumsum(apart) - 1], CubicSpline(knots, places)


def read_rod(path: Path, overrides: Sequence[str] = (), section: str = "", in_space: bool = False) -> Rod:
    """The rod of a table with a header: x, y and, in space, z, and the columns of UNITS, 'width [mm]' with units.

    `overrides`: 'key=value' of what is one value for all. `section`: 'round 2 mm E=1GPa rho=1.2g/cm3', as of a beam.
    `in_space`: a table of x and y as one with z = 0. Raises InputError.
    """
    table, fixed = _table(path), dict[str, float]()
    count, space = len(table["x"]), in_space or "z" in table
    for word in as_tuple("overrides", overrides, str):
        name, _, text = (part.strip() for part in word.partition("="))
        if name not in UNITS or name in {*table, "z"}:
            text = near_name(name, tuple(UNITS)[3:]) if name not in UNITS else f"{name} belongs to the table"
            raise InputError(f"--set {shown(word)}: {text}")
        fixed[name] = in_si(text, UNITS[name], name)
    if "," in str(section):
        raise InputError(f"section = {shown(section)}: give size and material alone, a curve is {CLAMPED}")
    own = beam_table(f"1 m x {section}, clamped-free") | {"supports": ("clamped", "free")} if section else {}
    rows = [fixed | {name: float(column[i]) for name, column in table.items()} for i in range(count)]
    each = [_values(tuple(sorted(row.items())), tuple(own.items()), space, path.name) for row in rows]
    points = np.stack([table.get(name, np.zeros(count)) for name in "xyz"], axis=1)
    values = np.array([one for one, _ in each])
    if not (abs(np.hstack([points, values])) < HUGE).all():
        raise InputError(f"{path.name}: a value is not below {HUGE:g}, check its unit")
    steps, ahead = np.diff(points, axis=0), points - points[0]
    if not np.linalg.norm(ahead[-1]) > MEET * np.linalg.norm(steps, axis=1).sum():
        raise InputError(f"{path.name}: its ends meet, give an open curve, {CLAMPED}")
    tangent = ahead[np.linalg.norm(ahead, axis=1) > 0.0][0]
    tangent /= np.linalg.norm(tangent)
    start = np.array([-tangent[1], tangent[0], 0.0]) if "z" not in table else np.eye(3)[2]
    start = np.eye(3)[0] if abs(tangent @ start) > ALONG_Z else start
    return Rod(points, values, space, start, each[0][1])


def _table(path: Path) -> dict[str, Array]:
    """The columns, SI but for angles. Raises InputError."""
    lines = [line for line in read_text(path, "curve", LARGEST).splitlines() if line.strip() and line[0] != "#"]
    rows = list(csv.reader(lines, delimiter=";" if ";" in (lines or [""])[0] else ","))
    heads = [HEAD.fullmatch(word) for word in (rows or [[]])[0]]
    names = [head[1] if head else word.strip() for head, word in zip(heads, (rows or [[]])[0], strict=True)]
    texts = [f"{shown(one)} is no column: {near_name(one, tuple(UNITS))}" for one in names if one not in UNITS]
    texts += [f"column {one} is there {names.count(one)} times, leave one" for one in UNITS if names.count(one) > 1]
    if not {"x", "y"} <= {*names} and not (texts and {*names} & UNITS.keys()):
        texts = ["name its columns x, y and, in space, z in a header, such as x [mm],y [mm],EI,rho_A"]
    texts += [f"it has {len(rows) - 1} points, give two or more"] * (not texts and len(rows) < 3)
    for i, row in enumerate(rows[1:], start=1):
        texts += [f"row {i} has {len(row)} cells, its header {len(names)}"] * (not texts and len(row) != len(names))
    raise_all([f"{path.name}: {text}" for text in texts])
    table = dict[str, Array]()
    for name, head, cells in zip(names, heads, zip(*rows[1:], strict=True), strict=True):
        unit = head[2] if head and head[2] not in (None, UNITS[name]) else ""
        places = (f"{path.name}, row {i}: {name}" for i in range(1, len(rows)))
        table[name] = np.array([in_si(f"{one} {unit}", UNITS[name], at) for one, at in zip(cells, places, strict=True)])
    return table


@lru_cache(maxsize=4096)
def _values(
    row: tuple[tuple[str, float], ...], section: tuple[tuple[str, Any], ...], space: bool, name: str
) -> tuple[list[float], tuple[str, ...]]:
    """VALUES of a point by its columns: directly, or from sizes and material; the names of the latter. InputError."""
    given, made, sized = dict(row), dict[str, float](), tuple[str, ...]()
    fields = dict(section) | {MATERIAL.get(key, key): x for key, x in row if key in ALL_SIZES or key in MATERIAL}
    if {"diameter", "wall_thickness"} & set(fields):
        fields["shape"] = "tube" if "wall_thickness" in fields else "round"
    needed = ("EI", "GJ", "rho_A", "rho_Ip") if space else ("EI", "rho_A")
    if fields and not set(needed) <= set(given):
        beam = Beam(**{"length": 1.0} | fields)
        made = {"EI": beam.bending_stiffness, "rho_A": beam.mass_per_length}
        if space:
            _, made["GJ"], made["rho_Ip"] = shafts(beam)[0].tolist()
            made["EI2"] = in_plane(beam, "width").bending_stiffness
        sized = tuple(made.keys() - given)
    elif unused := MATERIAL.keys() & given:
        raise InputError(f"{name}: {min(unused)} has no effect next to {', '.join(needed)}, leave it out")
    made |= {key: fields[key] for key in ("width", "thickness", "diameter") if key in fields} | given
    made.setdefault("EI2", made.get("EI", 0.0))
    for key in (*needed, "EI2"):
        if not made.get(key, 0.0) > 0.0:
            fault = "is not above 0" if key in made else "is missing"
            remedy = "polar inertia per length, kg m, " if key == "rho_Ip" else ""
            raise InputError(f"{name}: {key} {fault}, give {remedy}a column or --set {key}=..., or a section")
    thick = made.get("diameter", 0.0)
    drawn = made.get("width", thick), made.get("thickness", thick)
    return [*(made.get(key, 1.0) for key in VALUES[:5]), np.radians(made.get("roll", 0.0)), *drawn], sized
