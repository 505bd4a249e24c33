"""Mode shapes on a mesh compared with the exact ones and with those of the models.

MAC: Allemang, "The modal assurance criterion - twenty years of use and abuse", Sound and Vibration 37 (2003). The error
of a shape is free of its scale: the least of |a s - e| / |e| over a.
"""

from dataclasses import replace
from typing import Any

import msgspec
import numpy as np

from verify.beam import Beam
from verify.compare.candidates import CHAIN, ELEMENTS
from verify.compare.compare import Options, compare, exact_shapes, pair_shapes
from verify.compare.meshes import MeshShapes
from verify.compare.reading import ModeShapes
from verify.errors import InputError
from verify.judge.compare import HARDLY, node_weights
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.report.result import Column, Result, Table

STRAIGHT = 1e-6
"""Share of a shape beside a straight line, below which it is a rigid motion."""


def compare_shapes(scene: Any, mesh: MeshShapes, options: Options | None = None) -> Result:
    """Modes, MAC and error of the shapes on a mesh of the scene's beam, the nearest model, and of frequencies as `compare`.

    Raises InputError. `data["passed"]` says whether every shape is a mode's, in order, and the frequencies pass.
    """
    beam, options, x = scene.beam, options or Options(), mesh.shapes.x
    line = np.stack([np.ones_like(x), x])
    values = mesh.shapes.values
    rest = values - np.linalg.lstsq(line.T, values.T, rcond=None)[0].T @ line
    bent = np.flatnonzero(np.linalg.norm(rest, axis=1) > STRAIGHT * np.linalg.norm(values, axis=1))
    if not len(bent):
        raise InputError(f"{mesh.source} has rigid motions alone: write elastic modes")
    notes = [f"{name} is a rigid motion: left out." for i, name in enumerate(mesh.names) if i not in bent]
    values, names = values[bent], [mesh.names[i] for i in bent]
    reversed_mac = pair_shapes(beam, x=beam.length - x[::-1], values=values[:, ::-1])[1]
    modes, mac = pair_shapes(beam, x=x, values=values)
    if reversed_mac.mean() > mac.mean() + 0.1:
        x, values = beam.length - x[::-1], values[:, ::-1]
        modes, mac = pair_shapes(beam, x=x, values=values)
        notes.append("x runs from right to left in the mesh.")
    weights = np.sqrt(node_weights(x))
    exact = exact_shapes(beam, int(modes.max()) + 1, x)
    like = mac >= HARDLY
    rows = [
        (names[i], int(modes[i]) + 1, float(mac[i]), scale_free_error(values[i] * weights, exact[modes[i]] * weights))
        for i in np.argsort(modes, kind="stable")
    ]
    columns = [Column("shape"), Column("mode"), Column("MAC", format=".6f")]
    tables = [Table("Shapes", [*columns, Column("error of the form", format=".3g", percent=True)], rows, [*mesh.notes, *notes])]
    in_order = bool((np.diff(modes) > 0).all())
    warnings = ["A shape is hardly one of the beam's modes (MAC below 0.8): check beam.supports."] * (not like.all())
    warnings += ["The shapes are not in the order of the modes."] * (not in_order)
    warnings += ["So few places do not distinguish higher modes from lower ones."] * (len(x) - 1 <= 2 * int(modes.max()) + 2)
    frequencies = None
    if mesh.frequencies is not None and like.any():
        hertz, rounding = mesh.frequencies.hertz[bent], mesh.frequencies.rounding[bent]
        given = msgspec.structs.replace(mesh.frequencies, hertz=hertz, rounding=rounding)
        frequencies = compare(scene, given, ModeShapes(x=x, values=values), options)
        tables += frequencies.tables
        warnings += frequencies.warnings
    best = frequencies.data["best"] if frequencies is not None else {"model": "", "count": None}
    count = options.count or best["count"] or len(x) - 1
    near = _nearest(beam, x, values, modes, count)
    tables.insert(1, Table("Models by the form of their shapes", [Column("model"), Column("N"), Column("error", format=".3g", percent=True)], near))
    passed = bool(like.all()) and in_order and (frequencies is None or frequencies.data["passed"])
    summary = f"{len(rows)} shapes, lowest MAC {mac.min():.4f}; nearest by form: {near[0][0]}." if near else ""
    if frequencies is not None:
        return replace(frequencies, summary=f"{summary} {frequencies.summary}", tables=tables, warnings=warnings, data=dict(frequencies.data) | {"passed": passed})
    return Result(summary, tables, warnings=warnings, data={"scene": scene.name, "source": mesh.source, "passed": passed})


def scale_free_error(shape: Array, exact: Array) -> float:
    """The least of |a s - e| / |e| over a; both (n,), weighted."""
    return float(np.linalg.norm(exact - shape * (shape @ exact) / (shape @ shape)) / np.linalg.norm(exact))


def _nearest(beam: Beam, x: Array, values: Array, modes: Array, count: int) -> list[tuple[str, int | None, float]]:
    """(model, N, rms error of the form over the modes), the nearest first."""
    n, weights = int(modes.max()) + 1, np.sqrt(node_weights(x))
    models = {"exact beam": (exact_shapes(beam, n, x), None)}
    for name, model in (("elements", ELEMENTS), ("segments, joints corrected", CHAIN)):
        try:
            solved = MODELS[model].solve_modes(beam, n, count)
        except InputError:  # so few parts have fewer modes
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
