"""Somebody's mesh of a beam with mode shapes on it, in whatever format meshio reads: shapes along one axis.

Points at one place along the beam, a cross-section, are averaged: what is left is the deflection of a beam. Imported
only where a mesh is read, because meshio is.
"""

import io
import re
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import meshio
import msgspec
import numpy as np

from verify.errors import InputError, one_line, shown
from verify.files import exists
from verify.identify.shapes import Given
from verify.models.arrays import Array

SAME_PLACE = 1e-6
"""Of the length: points nearer along the beam stand in one cross-section."""
SLENDER = 0.5
"""Across over along: what is thicker is no beam."""
UNITS = {1.0: "metres", 1e3: "millimetres", 1e2: "centimetres", 39.37007874: "inches"}
NEAR = 1e-3
"""By how much the length of a mesh may differ from the scene's, relative."""
FAR, MOST = 4, 500
"""Numbers in names beyond so many times the shapes are no mode numbers; and shapes that a file may have."""
ACROSS = 0.5
"""Share of a shape's squares that has to lie across the thickness."""
_UNHEARD = "no frequencies: no field data named after Hz or rad/s were read (meshio writes none, to a .vtu or a .vtk)"
_HERTZ = re.compile(r"hz|hertz|freq", re.IGNORECASE)
_RADIAN = re.compile(r"rad|omega", re.IGNORECASE)


class _Read(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What stands in a file."""

    points: Array
    """(n, 3)."""
    arrays: dict[str, Array]
    """(n,) or (n, m) each, by name, in the file's order."""
    field: dict[str, Array]
    kinds: str
    """Of cells, in words."""


class _Axes(msgspec.Struct, frozen=True):
    """0, 1 or 2 of each direction."""

    along: int
    across: int
    sideways: int


def read_shapes_of_mesh(path: Path, length: float) -> Given:
    """Shapes along a beam of this length (metres) from a mesh of it, solid, shell or line. Raises InputError."""
    where = f"file = {shown(str(path))}"
    read = _of_series(path) or _of_file(path, where)
    _check_points(read, where)
    names, vectors = _candidates(read, where)
    axes, unit = _axes(read.points, vectors, where), _unit(read.points, length, where)
    x = read.points[:, _along(read.points)]
    x = x - x.min()
    stations, index = _stations(x)
    kept, values, left_out = _deflections(names, vectors, axes, index, len(stations), where)
    numbers = _numbers(names)
    order = np.argsort([numbers[i] for i in kept], kind="stable") if numbers else np.arange(len(kept))
    chosen = [kept[i] for i in order]
    hertz, rounding = _frequencies(read.field, len(names), where)
    return Given(
        source=where,
        x=stations * (length / stations[-1]),
        values=values[order],
        names=tuple(names[i] for i in chosen),
        numbers=tuple(numbers[i] for i in chosen) if numbers else None,
        frequencies_hz=None if hertz is None else hertz[chosen],
        rounding=rounding,
        notes=(_told(read, axes, len(stations), unit), *left_out, *([_UNHEARD] if hertz is None else [])),
    )


def _of_file(path: Path, where: str) -> _Read:
    """By meshio, which prints and exits where it cannot. Raises InputError."""
    if not exists(path, "file"):
        raise InputError(f"{where} does not exist: give a mesh that meshio reads, for instance a .vtu")
    said = io.StringIO()
    try:
        with redirect_stdout(said), redirect_stderr(said):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # a reader of forty formats breaks in as many ways
        why = str(error) if str(error) not in ("", "1") else said.getvalue().strip() or type(error).__name__
        raise InputError(f"{where} is no mesh that meshio reads ({one_line(why)[:200]}): save it as .vtu") from None
    kinds = sorted({block.type for block in mesh.cells} - {"vertex"})
    field = {str(name): np.atleast_1d(np.asarray(values)) for name, values in mesh.field_data.items()}
    return _Read(
        points=np.asarray(mesh.points, dtype=float),
        arrays={str(name): np.asarray(values) for name, values in mesh.point_data.items()},
        field=field,
        kinds=", ".join(kinds) or "no cells",
    )


def _of_series(path: Path) -> _Read | None:
    """A series in xdmf, whose steps are modes and whose times are frequencies in Hz; None for anything else."""
    if path.suffix.lower() != ".xdmf":
        return None
    try:
        with meshio.xdmf.TimeSeriesReader(path) as reader:
            points, cells = reader.read_points_cells()
            steps = [reader.read_data(i)[:2] for i in range(reader.num_steps)]
    except Exception:  # no series, or no xdmf: meshio's own reader says what it is
        return None
    first = {f"step_{i:03d}": next(iter(data.values())) for i, (_, data) in enumerate(steps, start=1) if data}
    times = np.array([float(time) for time, _ in steps])
    rising = len(times) > 0 and bool((times > 0.0).all() and (np.diff(times) > 0.0).all())
    kinds = ", ".join(sorted({block.type for block in cells}))
    points = np.asarray(points, dtype=float)
    return _Read(points=points, arrays=first, field={"frequency_hz": times} if rising else {}, kinds=kinds)


def _check_points(read: _Read, where: str) -> None:
    if read.points.ndim != 2 or len(read.points) < 3 or read.points.shape[1] not in (2, 3):
        raise InputError(f"{where} has {len(read.points)} points: give a mesh of a beam, three or more along it")
    if not np.isfinite(read.points).all():
        bad = int(np.flatnonzero(~np.isfinite(read.points).all(axis=1))[0])
        raise InputError(f"{where}: point {bad} lies at {read.points[bad].tolist()}: give finite coordinates")


def _candidates(read: _Read, where: str) -> tuple[list[str], list[Array]]:
    """Arrays that may be modes: vectors (n, 2 or 3), or where there is none scalars as (n, 1). Raises InputError."""
    n = len(read.points)
    real = {
        name: values.astype(float)
        for name, values in read.arrays.items()
        if values.dtype.kind == "f" and len(values) == n
    }
    vectors = {name: v[:, : min(v.shape[1], 3)] for name, v in real.items() if v.ndim == 2 and v.shape[1] > 1}
    scalars = {name: v.reshape(n, 1) for name, v in real.items() if v.ndim == 1 or (v.ndim == 2 and v.shape[1] == 1)}
    found = vectors or scalars
    if not found:
        names = ", ".join(read.arrays) or "none"
        raise InputError(f"{where} has no vectors or numbers at its points (point data: {names}): write modes as such")
    if len(found) > MOST:
        raise InputError(f"{where} has {len(found)} arrays at its points: give at most {MOST} modes")
    for name, values in found.items():
        if not np.isfinite(values).all():
            bad = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
            raise InputError(f"{where}: {shown(name)} is {values[bad].tolist()} at point {bad}: give finite numbers")
    return list(found), list(found.values())


def _along(points: Array) -> int:
    """The axis along which the mesh is longest."""
    return int(np.argmax(np.ptp(points, axis=0)))


def _axes(points: Array, vectors: list[Array], where: str) -> _Axes:
    """Along: the longest. Across: the thinner of the others, of a line the one in which most happens."""
    sizes = np.ptp(points, axis=0)
    along = _along(points)
    others = [axis for axis in range(points.shape[1]) if axis != along]
    if max(sizes[others]) > SLENDER * sizes[along]:
        raise InputError(
            f"{where} is {sizes[along]:.4g} long and {max(sizes[others]):.4g} across: give the mesh of a beam along an "
            "axis"
        )
    if len(others) == 1:
        return _Axes(along, others[0], others[0])
    thin, wide = sorted(others, key=lambda axis: sizes[axis])
    if sizes[wide] <= 1.01 * sizes[thin] and vectors[0].shape[1] == 3:
        squares = sum((v**2).sum(axis=0) / (v**2).sum() for v in vectors if v.any())
        thin, wide = sorted(others, key=lambda axis: -float(np.asarray(squares)[axis]))
    return _Axes(along, thin, wide)


def _unit(points: Array, length: float, where: str) -> str:
    """In which the mesh is drawn, in words. Raises InputError where its length is not the scene's in any."""
    found = float(np.ptp(points[:, _along(points)]))
    for factor, name in UNITS.items():
        if abs(found / (factor * length) - 1.0) < NEAR:
            return name
    raise InputError(
        f"{where} is {found:.6g} long and the scene's beam {length!r} m: give --set beam.length, or the scene of this "
        "beam"
    )


def _stations(x: Array) -> tuple[Array, Any]:
    """(places along the beam (n,), the one that each point stands at)."""
    order = np.argsort(x, kind="stable")
    new = np.concatenate([[0], np.cumsum(np.diff(x[order]) > SAME_PLACE * x.max())])
    index = np.empty(len(x), dtype=int)
    index[order] = new
    places = np.bincount(index, weights=x) / np.bincount(index)
    places[[0, -1]] = 0.0, x.max()
    return places, index


def _deflections(
    names: list[str], vectors: list[Array], axes: _Axes, index: Any, n: int, where: str
) -> tuple[list[int], Array, tuple[str, ...]]:
    """(which are shapes of bending across the thickness, (k, n), why others are left out). Raises InputError."""
    kept, values, left_out = [], [], []
    counts = np.bincount(index, minlength=n)
    for i, (name, vector) in enumerate(zip(names, vectors, strict=True)):
        if not vector.any():
            left_out.append(f"{name} is zero everywhere, left out")
            continue
        unit = vector / abs(vector).max()
        means = np.stack([np.bincount(index, weights=part, minlength=n) / counts for part in unit.T], axis=1)
        column = min(axes.across, means.shape[1] - 1) if means.shape[1] > 1 else 0
        shares = (means[index] ** 2).sum(axis=0) / (unit**2).sum()
        if shares[column] < ACROSS:
            left_out.append(f"{name} {_other(shares, axes)}, left out")
            continue
        kept.append(i)
        values.append(means[:, column] * abs(vector).max())
    if not kept:
        raise InputError(f"{where} has no shape that bends the beam across its thickness: {'; '.join(left_out[:3])}")
    return kept, np.array(values), tuple(left_out)


def _other(shares: Array, axes: _Axes) -> str:
    """What a vector field is that does not bend the beam across its thickness."""
    if shares[axes.along] >= ACROSS:
        return "moves along the beam"
    return "bends it across its width" if shares[axes.sideways] >= ACROSS else "leaves its middle line where it was"


def _numbers(names: list[str]) -> list[int] | None:
    """The mode number in each name, where all have one, no two the same, and none far beyond how many there are."""
    found = [re.findall(r"\d+", name) for name in names]
    numbers = [int(one[-1]) for one in found if one]
    whole = (
        len(numbers) == len(names) == len(set(numbers)) and min(numbers) >= 1 and max(numbers) <= FAR * len(names) + 50
    )
    return numbers if whole else None


def _frequencies(field: dict[str, Array], n: int, where: str) -> tuple[Array | None, float]:
    """(frequencies (n,) in Hz or None, their rounding). Raises InputError for another number than there are shapes."""
    for name, values in field.items():
        if values.dtype.kind not in "fiu" or not (_HERTZ.search(name) or _RADIAN.search(name)):
            continue
        given = values.ravel().astype(float)
        if len(given) != n:
            raise InputError(
                f"{where}: field data {shown(name)} has {len(given)} values for {n} shapes: give one for each"
            )
        if not (np.isfinite(given).all() and (given >= 0.0).all()):
            raise InputError(f"{where}: field data {shown(name)} has {given[~(given >= 0.0)][:1]}: give frequencies")
        hertz = given / (2.0 * np.pi) if _RADIAN.search(name) and not _HERTZ.search(name) else given
        return hertz, float(np.finfo(values.dtype).eps) if values.dtype.kind == "f" else 1e-16
    return None, 1e-16


def _told(read: _Read, axes: _Axes, n_stations: int, unit: str) -> str:
    """What was done with the mesh."""
    n = len(read.points)
    averaged = (
        f"averaged over {n_stations} cross-sections" if n > n_stations else f"taken at {n_stations} places as they are"
    )
    return (
        f"{n} points ({read.kinds}) in {unit} along {'xyz'[axes.along]}, {averaged}; deflection along "
        f"{'xyz'[axes.across]}"
    )
