"""Mode shapes of a beam on a mesh of any format of meshio, or measured, averaged over the cross-sections; their errors.

MAC: Allemang, "The modal assurance criterion - twenty years of use and abuse", Sound and Vibration 37 (2003). The error
of a shape is independent of its scale: the minimum of |a s - e| / |e| over a.
"""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.analysis.comparison import LOW_MAC, node_weights
from verify.analysis.plausibility import unit_margins
from verify.arrays import Array, Indices
from verify.compare.candidates import CHAIN, ELEMENTS
from verify.compare.compare import Options, compare, exact_shapes, pair_shapes
from verify.compare.reading import FrequencyList, ModeShapes, checked_shapes, listed
from verify.errors import InputError, shown
from verify.io.mode_files import UNIVERSAL, read_points
from verify.linear.registry import MODELS
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table

UNITS = {"m": 1.0, "mm": 1e3, "cm": 1e2, "inch": 39.37007874}  # length units per metre
SAME = 1e-6
"""Distance along the beam, relative to its length, of points in one cross-section."""
SLENDER, ACROSS, LENGTH = 0.5, 0.5, 1e-3
"""Largest thickness over length; least fraction of a shape's squares across the thickness; error of the length."""
_RADIANS = re.compile(r"rad|omega", re.IGNORECASE)
_FREQUENCY = re.compile(r"hz|hertz|freq|rad|omega", re.IGNORECASE)
STRAIGHT, TURNED = 1e-6, 0.1
"""Largest nonlinear fraction of a rigid-body motion; gain in mean MAC that identifies a reversed beam."""


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
    source = f"file = {shown(str(path))}"
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
    frequencies = _frequencies(field, [name in bent for name in vectors], source)
    return MeshShapes(source, checked_shapes(shapes, length, source), tuple(bent), frequencies, tuple(notes))


def _frequencies(field: dict[str, Any], chosen: list[bool], source: str) -> FrequencyList | None:
    """Frequencies of the chosen shapes from field data, or None. Raises InputError for another number."""
    for name in filter(_FREQUENCY.search, field):
        values = np.asarray(field[name], dtype=float).ravel()
        if len(values) != len(chosen):
            raise InputError(f"{source}: {name!r} has {len(values)} values, {len(chosen)} shapes: give one for each")
        unit = "rad/s" if _RADIANS.search(name) else "Hz"
        read = listed(source, values[chosen].tolist(), unit=unit, declared=True)
        coarse = 0.5 * float(field.get("resolution", [0.0])[0]) / read.values  # a peak lies between two spectral lines
        return msgspec.structs.replace(read, digits=np.maximum(read.digits, coarse))
    return None


def compare_shapes(scene: Any, mesh: MeshShapes, options: Options | None = None) -> Result:
    """Mode, MAC and error of shapes on a mesh of the scene's beam, nearest model; frequencies as in `compare`.

    Raises InputError. `data["passed"]` says whether every shape is a mode's, in order, and the frequencies pass.
    """
    beam, options, x, values = scene.beam, options or Options(), mesh.shapes.x, mesh.shapes.values
    rest = np.sqrt(np.polyfit(x, values.T, 1, full=True)[1])
    bent = np.flatnonzero(rest > STRAIGHT * np.linalg.norm(values, axis=1))
    if not len(bent):
        raise InputError(f"{mesh.source} has rigid-body motions only: write elastic modes")
    values, names = values[bent], [mesh.names[i] for i in bent]
    notes = [*mesh.notes, *[f"{name} is a rigid-body motion: ignored." for name in mesh.names if name not in names]]
    modes, mac = pair_shapes(beam, x, values)
    other = pair_shapes(beam, beam.length - x[::-1], values[:, ::-1])
    if other[1].mean() > mac.mean() + TURNED:
        x, values, (modes, mac) = beam.length - x[::-1], values[:, ::-1], other
        notes.append("x runs from right to left in the mesh.")
    n = int(modes.max()) + 1
    errors = shape_errors(values, exact_shapes(beam, n, x)[modes], x)
    order = np.argsort(modes, kind="stable")
    rows = [(names[i], int(modes[i]) + 1, float(mac[i]), float(errors[i])) for i in order]
    error = Column("shape error", format=".3g", percent=True)
    tables = [Table("Shapes", [Column("shape"), Column("mode"), Column("MAC", format=".6f"), error], rows, notes)]
    faults: dict[str, Any] = {
        f"A shape has a MAC below {LOW_MAC} with all modes of the beam: check beam.supports.": (mac < LOW_MAC).any(),
        "The shapes are not in the order of the modes.": (np.diff(modes) < 0).any(),
    }
    passed = not any(faults.values())
    faults["The mesh has fewer than two cross-sections per half wave: higher modes are aliased."] = len(x) - 1 < 2 * n
    warnings, listed = [text for text, holds in faults.items() if holds], None
    if mesh.frequencies is not None:
        own = mesh.frequencies
        frequencies = msgspec.structs.replace(own, values=own.values[bent], digits=own.digits[bent])
        listed = compare(scene, frequencies, ModeShapes(x=x, values=values), options)
    known = None if listed is None else listed.data["best"]["count"]
    near = _nearest(beam, x, values, modes, options.count or known or len(x) - 1)
    tables.append(Table("Models by shape error", [Column("model"), Column("N"), error], near))
    summary = f"{len(rows)} shapes, lowest MAC {mac.min():.4f}; nearest model by shape: {near[0][0]}."
    data = {"scene": scene.name, "source": mesh.source, "passed": passed}
    if listed is None:
        return Result(summary, tables, warnings=warnings, data=data, margins=unit_margins(beam))
    data = dict(listed.data) | {"passed": passed and listed.data["passed"]}
    tables, warnings = [*tables, *listed.tables], [*warnings, *listed.warnings]
    return replace(listed, summary=f"{summary} {listed.summary}", tables=tables, warnings=warnings, data=data)


def shape_errors(shapes: Array, exact: Array, x: Array) -> Array:
    """Minimum of |a s - e| / |e| over a, (k,), for shapes and exact ones (k, n) at x (n,), weighted by length."""
    s, e = (values * np.sqrt(node_weights(x)) for values in (shapes, exact))
    scales = np.sum(s * e, axis=1, keepdims=True) / np.sum(s**2, axis=1, keepdims=True)
    return np.asarray(np.linalg.norm(e - scales * s, axis=1) / np.linalg.norm(e, axis=1))


def _nearest(beam: Beam, x: Array, values: Array, modes: Indices, count: int) -> list[tuple[str, int | None, float]]:
    """(model, N, rms shape error over the modes), nearest first."""
    n = int(modes.max()) + 1
    models: dict[str, tuple[Array, int | None]] = {"exact beam": (exact_shapes(beam, n, x), None)}
    for name, model in (("elements", ELEMENTS), ("segments, joints corrected", CHAIN)):
        try:
            solved = MODELS[model].build(beam, count).modes(n)
        except InputError:  # too few parts for these modes
            continue
        models[name] = (np.asarray(solved.deflection(x)), count)
        if model == CHAIN:
            raw = [np.interp(x, solved.nodes, shape) for shape in solved.readings["raw"]()]
            models["segments, raw joints"] = (np.array(raw), count)
    errors = {name: np.sqrt(np.mean(shape_errors(values, one[modes], x) ** 2)) for name, (one, _) in models.items()}
    return [(name, models[name][1], float(errors[name])) for name in sorted(models, key=errors.__getitem__)]
