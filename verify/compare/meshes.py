"""Mode shapes of a beam on a mesh of any format of meshio, or measured, averaged over the cross-sections."""

import re
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array
from verify.compare.reading import FrequencyList, ModeShapes, checked_shapes, listed
from verify.errors import InputError
from verify.files import exists
from verify.io.mode_files import UNIVERSAL, read_points

UNITS = {"m": 1.0, "mm": 1e3, "cm": 1e2, "inch": 39.37007874}
"""Number of length units per metre."""
SAME = 1e-6
"""Distance along the beam, relative to its length, of points in one cross-section."""
SLENDER, ACROSS, LENGTH = 0.5, 0.5, 1e-3
"""Largest thickness over length; least fraction of a shape's squares across the thickness; error of the length."""
_RADIANS = re.compile(r"rad|omega", re.IGNORECASE)
_FREQUENCY = re.compile(r"hz|hertz|freq|rad|omega", re.IGNORECASE)


class MeshShapes(msgspec.Struct, frozen=True, eq=False):
    """Shapes along a beam from a mesh, their frequencies if any, and notes on ignored arrays."""

    source: str
    shapes: ModeShapes
    names: tuple[str, ...]
    frequencies: FrequencyList | None
    notes: tuple[str, ...]


def read_mesh(path: Path, length: float) -> MeshShapes:
    """Deflections across the thickness of a beam of this length, m, from vectors or numbers at the points of a mesh.

    The axis is the longest direction, the thickness the shortest. Field data named after Hz or rad/s, and the times of
    an xdmf series, are frequencies. Raises InputError.
    """
    source = f"file = {str(path)!r}"
    if not exists(path, "file"):
        raise InputError(f"{source} does not exist: give a mesh, for instance a .vtu")
    points, arrays, field = read_points(path, source)
    if len(points) < 3 or not np.isfinite(points).all():
        raise InputError(f"{source} has {len(points)} points, or infinite ones: give three or more finite points")
    real = {name: v.astype(float) for name, v in arrays.items() if v.dtype.kind == "f" and len(v) == len(points)}
    vectors = {name: v[:, :3] for name, v in real.items() if v.ndim == 2 and v.shape[1] > 1}
    vectors = vectors or {name: v.reshape(len(v), -1) for name, v in real.items() if v[0].size == 1}
    if not vectors or not all(np.isfinite(v).all() for v in vectors.values()):
        raise InputError(f"{source} has no finite vectors or numbers at its points: write the modes as point data")
    sizes = np.ptp(points, axis=0)
    along, first = int(np.argmax(sizes)), next(iter(vectors.values()))
    others = sorted((axis for axis in range(len(sizes)) if axis != along), key=lambda axis: sizes[axis])
    if len(others) == 2 and sizes[others[1]] <= 1.01 * sizes[others[0]] and first.shape[1] == 3:  # the one with motion
        moved = sum((v**2).sum(axis=0) / (v**2).sum() for v in vectors.values() if v.any())
        others.sort(key=lambda axis: -float(np.asarray(moved)[axis]))
    across, wide = others[0], others[-1]
    if max(sizes[across], sizes[wide]) > SLENDER * sizes[along]:
        raise InputError(f"{source} is {sizes[along]:.4g} long and {sizes[wide]:.4g} wide: give the mesh of a beam")
    unit = next((u for u, factor in UNITS.items() if abs(sizes[along] / (factor * length) - 1.0) < LENGTH), None)
    start, last = points[:, along].min(), 1.0
    if unit is None and path.suffix.lower() in UNIVERSAL and start >= 0.0:  # sensors need not be at the ends
        start, last = 0.0, points[:, along].max() / length
        unit = next((u for u, factor in UNITS.items() if 0.5 < last / factor < 1.0 + LENGTH), None)
        last /= UNITS[unit or "m"]
    if unit is None:
        lengths = f"{sizes[along]:.6g} long, the beam {length!r} m"
        raise InputError(f"{source} is {lengths}: set beam.length to that of the mesh")
    x = points[:, along] - start
    order = np.argsort(x, kind="stable")
    station = np.append(0, np.cumsum(np.diff(x[order]) > SAME * x.max()))[np.argsort(order)]
    counts = np.bincount(station)
    places = np.bincount(station, weights=x) / counts
    places[[0, -1]] = x.min(), x.max()
    bent: dict[str, Array] = {}
    notes = [f"{len(points)} points in {unit}, {len(places)} cross-sections along {'xyz'[along]}."]
    for name, vector in vectors.items():
        means = np.array([np.bincount(station, weights=part) / counts for part in vector.T])
        column = min(across, len(means) - 1)
        squares = (means[:, station] ** 2).sum(axis=1)
        if squares[column] > ACROSS * (vector**2).sum():
            bent[name] = means[column]
        else:
            notes.append(f"{name} does not bend the beam across its thickness: ignored.")
    if not bent:
        raise InputError(f"{source} has no shape that bends the beam across its thickness: write bending modes")
    shapes = ModeShapes(x=places * (last * length / places[-1]), values=np.array(list(bent.values())))
    frequencies = _frequencies(field, len(vectors), [list(vectors).index(name) for name in bent], source)
    return MeshShapes(source, checked_shapes(shapes, length, source), tuple(bent), frequencies, tuple(notes))


def _frequencies(field: dict[str, Any], n: int, chosen: list[int], source: str) -> FrequencyList | None:
    """Frequencies of the chosen shapes from field data, or None. Raises InputError for another number."""
    name = next((name for name in field if _FREQUENCY.search(name)), None)
    if name is None:
        return None
    values = np.asarray(field[name], dtype=float).ravel()
    if len(values) != n:
        raise InputError(f"{source}: field data {name!r} has {len(values)} values for {n} shapes: give one for each")
    return listed(source, values[chosen].tolist(), unit="rad/s" if _RADIANS.search(name) else "Hz", declared=True)
