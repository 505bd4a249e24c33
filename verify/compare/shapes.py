"""Comparison of mode shapes on a mesh with the exact shapes and with those of the models.

MAC: Allemang, "The modal assurance criterion - twenty years of use and abuse", Sound and Vibration 37 (2003). The error
of a shape is independent of its scale: the minimum of |a s - e| / |e| over a.
"""

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np

from verify.analysis.comparison import LOW_MAC, node_weights
from verify.arrays import Array, Indices
from verify.compare.candidates import CHAIN, ELEMENTS
from verify.compare.compare import Options, compare, exact_shapes, pair_shapes
from verify.compare.meshes import MeshShapes
from verify.compare.reading import ModeShapes
from verify.errors import InputError
from verify.linear.registry import MODELS
from verify.problem.beam import Beam
from verify.report.result import Column, Result, Table

STRAIGHT, TURNED = 1e-6, 0.1
"""Largest nonlinear fraction of a rigid-body motion; gain in mean MAC that identifies a reversed beam."""
UNLIKE = f"A shape has a MAC below {LOW_MAC} with all modes of the beam: check beam.supports."
DISORDER = "The shapes are not in the order of the modes."
COARSE = "The mesh has fewer than two cross-sections per half wave: higher modes are aliased."


def compare_shapes(scene: Any, mesh: MeshShapes, options: Options | None = None) -> Result:
    """Mode, MAC and error of shapes on a mesh of the scene's beam, nearest model; frequencies as in `compare`.

    Raises InputError. `data["passed"]` says whether every shape is a mode's, in order, and the frequencies pass.
    """
    beam, options, x, values = scene.beam, options or Options(), mesh.shapes.x, mesh.shapes.values
    line = np.stack([np.ones_like(x), x])
    rest = values - np.linalg.lstsq(line.T, values.T, rcond=None)[0].T @ line
    bent = np.flatnonzero(np.linalg.norm(rest, axis=1) > STRAIGHT * np.linalg.norm(values, axis=1))
    if not len(bent):
        raise InputError(f"{mesh.source} has rigid-body motions only: write elastic modes")
    values, names = values[bent], [mesh.names[i] for i in bent]
    notes = [*mesh.notes, *[f"{name} is a rigid-body motion: ignored." for name in mesh.names if name not in names]]
    modes, mac = pair_shapes(beam, x, values)
    other = pair_shapes(beam, beam.length - x[::-1], values[:, ::-1])
    if other[1].mean() > mac.mean() + TURNED:
        x, values, (modes, mac) = beam.length - x[::-1], values[:, ::-1], other
        notes.append("x runs from right to left in the mesh.")
    weights, n = np.sqrt(node_weights(x)), int(modes.max()) + 1
    exact = exact_shapes(beam, n, x)
    errors = [scale_free_error(s * weights, exact[mode] * weights) for s, mode in zip(values, modes, strict=True)]
    order = np.argsort(modes, kind="stable")
    rows = [(names[i], int(modes[i]) + 1, float(mac[i]), errors[i]) for i in order]
    error = Column("shape error", format=".3g", percent=True)
    tables = [Table("Shapes", [Column("shape"), Column("mode"), Column("MAC", format=".6f"), error], rows, notes)]
    faults = {UNLIKE: (mac < LOW_MAC).any(), DISORDER: (np.diff(modes) < 0).any(), COARSE: len(x) - 1 < 2 * n}
    warnings = [words for words, holds in faults.items() if holds]
    listed = None
    if mesh.frequencies is not None:
        own = mesh.frequencies
        frequencies = msgspec.structs.replace(own, values=own.values[bent], digits=own.digits[bent])
        listed = compare(scene, frequencies, ModeShapes(x=x, values=values), options)
    known = None if listed is None else listed.data["best"]["count"]
    near = _nearest(beam, x, values, modes, options.count or known or len(x) - 1)
    tables.append(Table("Models by shape error", [Column("model"), Column("N"), error], near))
    passed = not (faults[UNLIKE] or faults[DISORDER])
    summary = f"{len(rows)} shapes, lowest MAC {mac.min():.4f}; nearest model by shape: {near[0][0]}."
    data = {"scene": scene.name, "source": mesh.source, "passed": passed}
    if listed is None:
        return Result(summary, tables, warnings=warnings, data=data)
    data = dict(listed.data) | {"passed": passed and listed.data["passed"]}
    tables, warnings = [*tables, *listed.tables], [*warnings, *listed.warnings]
    return replace(listed, summary=f"{summary} {listed.summary}", tables=tables, warnings=warnings, data=data)


def scale_free_error(shape: Array, exact: Array) -> float:
    """Minimum of |a s - e| / |e| over a for weighted shapes (n,)."""
    return float(np.linalg.norm(exact - shape * (shape @ exact) / (shape @ shape)) / np.linalg.norm(exact))


def _nearest(beam: Beam, x: Array, values: Array, modes: Indices, count: int) -> list[tuple[str, int | None, float]]:
    """(model, N, rms shape error over the modes), nearest first."""
    n, weights = int(modes.max()) + 1, np.sqrt(node_weights(x))
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
    rows = []
    for name, (shapes, size) in models.items():
        pairs = zip(values * weights, shapes[modes] * weights, strict=True)
        rows.append((name, size, float(np.sqrt(np.mean([scale_free_error(*pair) ** 2 for pair in pairs])))))
    return sorted(rows, key=lambda row: row[2])
