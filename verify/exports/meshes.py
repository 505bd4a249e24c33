"""Sheets as meshes that VTK, ParaView and others read: by meshio, what it does not write put in beside.

Imported only where a mesh is written, because meshio is.
"""

from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

import meshio
import numpy as np

from verify.exports.sheet import Sheet
from verify.files import whole, whole_folder
from verify.models.arrays import Array

GRID = "<UnstructuredGrid>"


def mesh_of(sheet: Sheet, at_points: dict[str, Array]) -> meshio.Mesh:
    """The sheet's line with these arrays at its points."""
    return meshio.Mesh(
        sheet.points,
        [("line", sheet.lines)],
        point_data={name: np.ascontiguousarray(values) for name, values in at_points.items()},
        cell_data={name: [values] for name, values in sheet.cells.items()},
    )


def write_vtu(sheet: Sheet, path: Path) -> None:
    """One mesh with all that stands at its points, and what stands beside as field data. Raises InputError."""
    with whole(path, "to") as part:
        _write_one(sheet, part, sheet.at_points, sheet.beside)


def _write_one(sheet: Sheet, part: Path, at_points: dict[str, Array], beside: dict[str, Array]) -> None:
    """Meshio reads field data of a vtu and writes none: it goes in where the file format has it, with all digits."""
    meshio.vtu.write(str(part), mesh_of(sheet, at_points))
    text = part.read_text("utf-8")
    data = "".join(_field(name, values) for name, values in beside.items())
    part.write_text(text.replace(GRID, f"{GRID}<FieldData>{data}</FieldData>", 1), "utf-8")


def _field(name: str, values: Array) -> str:
    numbers = " ".join(repr(float(value)) for value in values)
    head = f'type="Float64" Name={quoteattr(name)} NumberOfTuples="{len(values)}" format="ascii"'
    return f"<DataArray {head}>{numbers}</DataArray>"


def write_pvd(sheet: Sheet, path: Path) -> None:
    """An index of meshes, one for each step, in the folder of its name beside it. Raises InputError.

    The format is ParaView's: a collection of files with the time at which each stands. The folder is there before it.
    """
    folder = path.with_name(f"{path.stem}-steps")
    digits = len(str(len(sheet.steps)))
    names = [f"{path.stem}_{i:0{digits}d}.vtu" for i in range(len(sheet.steps))]
    with whole(path, "to") as index:
        index.write_text(_collection(sheet, folder.name, names), "utf-8")
        with whole_folder(folder, ".vtu", "to") as fresh:
            for i, name in enumerate(names):
                _write_one(sheet, fresh / name, _at_step(sheet, i), _beside_step(sheet, i))


def _at_step(sheet: Sheet, i: int) -> dict[str, Array]:
    """What stands at the points at one step; of a field also what the series is made of."""
    fixed = {} if sheet.what == "modes" else sheet.at_points
    return {name: values[i] for name, values in sheet.stepped.items()} | fixed


def _beside_step(sheet: Sheet, i: int) -> dict[str, Array]:
    now = {name: values[i : i + 1] for name, values in sheet.histories.items()}
    return {**sheet.beside, sheet.step_name: sheet.steps[i : i + 1], **now}


def _collection(sheet: Sheet, folder: str, names: list[str]) -> str:
    rows = "".join(
        f'    <DataSet timestep={quoteattr(repr(float(step)))} part="0" file={quoteattr(f"{folder}/{name}")}/>\n'
        for step, name in zip(sheet.steps, names, strict=True)
    )
    return (
        '<?xml version="1.0"?>\n'
        f"<!-- {escape(sheet.told).replace('--', '-')}; timestep is {sheet.step_name} -->\n"
        '<VTKFile type="Collection" version="0.1">\n  <Collection>\n'
        f"{rows}  </Collection>\n</VTKFile>\n"
    )


def write_xdmf(sheet: Sheet, path: Path) -> None:
    """A series in one file, its numbers as text, so that nothing needs HDF5. Raises InputError."""
    fixed = {} if sheet.what == "modes" else sheet.at_points
    with whole(path, "to") as part, meshio.xdmf.TimeSeriesWriter(part, data_format="XML") as writer:
        writer.write_points_cells(sheet.points, [("line", sheet.lines)])
        for i, step in enumerate(sheet.steps):
            now = {name: np.ascontiguousarray(values[i]) for name, values in sheet.stepped.items()}
            on_it = {name: np.full(len(sheet.x), values[i]) for name, values in sheet.histories.items()}
            writer.write_data(float(step), point_data=now | (fixed if i == 0 else {}) | on_it)
