"""Mode shapes of a beam on a mesh (any format of meshio), or measured (universal files), averaged over cross-sections."""

import io
import re
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array
from verify.compare.reading import FrequencyList, ModeShapes, checked_shapes, listed
from verify.errors import InputError, one_line
from verify.files import exists

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
    measured = path.suffix.lower() in (".uff", ".unv")
    points, arrays, field = _universal(path, source) if measured else _series(path) or _mesh(path, source)
    if len(points) < 3 or not np.isfinite(points).all():
        raise InputError(f"{source} has {len(points)} points, or infinite ones: give three or more finite points")
    real = {name: v.astype(float) for name, v in arrays.items() if v.dtype.kind == "f" and len(v) == len(points)}
    vectors = {name: v[:, :3] for name, v in real.items() if v.ndim == 2 and v.shape[1] > 1}
    vectors = vectors or {name: v.reshape(len(v), -1) for name, v in real.items() if v[0].size == 1}
    if not vectors or not all(np.isfinite(v).all() for v in vectors.values()):
        raise InputError(f"{source} has no finite vectors or numbers at its points: write the modes as point data")
    sizes = np.ptp(points, axis=0)
    along = int(np.argmax(sizes))
    others = sorted((axis for axis in range(len(sizes)) if axis != along), key=lambda axis: sizes[axis])
    first = next(iter(vectors.values()))
    if len(others) == 2 and sizes[others[1]] <= 1.01 * sizes[others[0]] and first.shape[1] == 3:  # the one with motion
        moved = sum((v**2).sum(axis=0) / (v**2).sum() for v in vectors.values() if v.any())
        others.sort(key=lambda axis: -float(np.asarray(moved)[axis]))
    across, wide = others[0], others[-1]
    if max(sizes[across], sizes[wide]) > SLENDER * sizes[along]:
        raise InputError(f"{source} is {sizes[along]:.4g} long and {sizes[wide]:.4g} wide: give the mesh of a beam")
    unit = next((u for u, factor in UNITS.items() if abs(sizes[along] / (factor * length) - 1.0) < LENGTH), None)
    start, end = points[:, along].min(), length
    if unit is None and measured and start >= 0.0:  # sensors need not be at the ends
        last = points[:, along].max() / length
        unit = next((u for u, factor in UNITS.items() if 0.5 < last / factor < 1.0 + LENGTH), None)
        start, end = 0.0, length * last / UNITS.get(unit or "", 1.0)
    if unit is None:
        lengths = f"{sizes[along]:.6g} long, the beam {length!r} m"
        raise InputError(f"{source} is {lengths}: set beam.length to that of the mesh")
    x = points[:, along] - start
    order = np.argsort(x, kind="stable")
    station = np.empty(len(x), dtype=int)
    station[order] = np.append(0, np.cumsum(np.diff(x[order]) > SAME * x.max()))
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
    shapes = ModeShapes(x=places * (end / places[-1]), values=np.array(list(bent.values())))
    chosen = [list(vectors).index(name) for name in bent]
    frequencies = _frequencies(field, len(vectors), chosen, source)
    return MeshShapes(source, checked_shapes(shapes, length, source), tuple(bent), frequencies, tuple(notes))


def _mesh(path: Path, source: str) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """(points, arrays at them, field data) by meshio, which prints and exits on failure. Raises InputError."""
    import meshio

    output = io.StringIO()
    try:
        with redirect_stdout(output), redirect_stderr(output):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # readers of many formats raise many types
        why = one_line(str(error) or output.getvalue())[:200]
        raise InputError(f"{source} cannot be read by meshio ({why}): save the mesh as .vtu") from None
    arrays = {str(name): np.asarray(values) for name, values in mesh.point_data.items()}
    return np.asarray(mesh.points, dtype=float), arrays, {str(k): np.asarray(v) for k, v in mesh.field_data.items()}


def _universal(path: Path, source: str) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """`_mesh` of a universal file: points of sets 15 or 2411; modes of sets 55, else peaks of the responses of sets 58.

    At a peak of the sum of squared responses their imaginary part is the shape. Raises InputError.
    """
    try:
        import pyuff
    except ImportError:
        raise InputError(f"{source} needs pyuff: pip install fem-segment-verify[measured]") from None
    try:
        sets = [pyuff.UFF(str(path)).read_sets(i) for i in range(pyuff.UFF(str(path)).get_n_sets())]
    except Exception as error:  # its reader raises plain ones
        raise InputError(f"{source} cannot be read by pyuff ({one_line(str(error))[:200]}): write sets 15, 55") from None
    of = {kind: [one for one in sets if one["type"] == kind] for kind in (15, 2411, 55, 58)}
    node = {int(n): xyz for one in of[15] + of[2411] for n, *xyz in zip(*map(one.get, ("node_nums", *"xyz")), strict=True)}
    modes: list[tuple[float, dict[int, Array]]] = []
    for one in of[55]:
        vectors = np.array([one["r1"], one["r2"], one["r3"]]).T
        vectors = (vectors * np.exp(-0.5j * np.angle((vectors**2 + 0j).sum()))).real
        hertz = one["freq"] if "freq" in one else abs(one["eig"]) / (2.0 * np.pi)
        modes.append((float(hertz), dict(zip(map(int, one["node_nums"]), vectors, strict=True))))
    if not modes and of[58]:
        from scipy.signal import find_peaks

        moving = "rsp" if len({one["rsp_node"] for one in of[58]}) > 1 else "ref"  # or a roving hammer
        power = np.log(sum(abs(one["data"]) ** 2 for one in of[58]))
        for i in find_peaks(power, prominence=np.log(10.0))[0]:
            a, b, c = power[i - 1 : i + 2]
            hertz = float(of[58][0]["x"][i] + 0.5 * (a - c) / (a - 2.0 * b + c) * np.diff(of[58][0]["x"][i : i + 2])[0])
            shape = {int(one[f"{moving}_node"]): np.zeros(3) for one in of[58]}
            for one in of[58]:
                axis = int(one[f"{moving}_dir"])
                shape[int(one[f"{moving}_node"])][abs(axis) - 1] += np.sign(axis) * one["data"][i].imag
            modes.append((hertz, shape))
    shared = sorted(set(node).intersection(*(shape for _, shape in modes)))
    if not modes or len(shared) < 3:
        raise InputError(f"{source} has {len(modes)} modes at {len(shared)} points: write sets 15 and 55, or 15 and 58")
    arrays = {f"mode_{i}": np.array([shape[n] for n in shared]) for i, (_, shape) in enumerate(modes, start=1)}
    return np.array([node[n] for n in shared], dtype=float), arrays, {"hz": np.array([hertz for hertz, _ in modes])}


def _series(path: Path) -> tuple[Array, dict[str, Array], dict[str, Any]] | None:
    """`_mesh` of an xdmf series with one mode per step and frequencies in Hz as times; None for other files."""
    import meshio

    if path.suffix.lower() != ".xdmf":
        return None
    try:
        with meshio.xdmf.TimeSeriesReader(path) as reader:
            points, _ = reader.read_points_cells()
            steps = [reader.read_data(i)[:2] for i in range(reader.num_steps)]
    except Exception:  # not a series
        return None
    arrays = {f"step_{i}": np.asarray(next(iter(data.values()))) for i, (_, data) in enumerate(steps, start=1)}
    times = np.array([float(time) for time, _ in steps])
    return np.asarray(points, dtype=float), arrays, {"hz": times} if (np.diff(times, prepend=0.0) > 0.0).all() else {}


def _frequencies(field: dict[str, Any], n: int, chosen: list[int], source: str) -> FrequencyList | None:
    """Frequencies of the chosen shapes from field data, or None. Raises InputError for another number."""
    name = next((name for name in field if _FREQUENCY.search(name)), None)
    if name is None:
        return None
    values = np.asarray(field[name], dtype=float).ravel()
    if len(values) != n:
        raise InputError(f"{source}: field data {name!r} has {len(values)} values for {n} shapes: give one for each")
    return listed(source, values[chosen].tolist(), unit="rad/s" if _RADIANS.search(name) else "Hz", declared=True)
