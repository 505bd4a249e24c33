"""Which model natural frequencies of another program come from."""

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from verify.answers.beams import AnyBeam, named
from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.compare.compare import Options
from verify.compare.compare import compare as compare_list
from verify.compare.reading import UNITS, FrequencyList, ModeShapes, listed, read_frequencies
from verify.compare.record import as_list, listed_modes, read_record, with_record
from verify.compare.shapes import compare_shapes, read_mesh
from verify.identify.ring_down import ring_down
from verify.io.mode_files import is_mesh
from verify.report.result import Result
from verify.validation import check_choice, check_number, check_type, convert

KINDS = "segments", "elements"
"""Kinds of candidates."""
TEXT = {"", ".csv", ".txt", ".tsv", ".dat", ".f06", ".asc"}
"""Suffixes of lists of frequencies, in addition to those that are of no mesh."""


@one_blas_thread()
def compare_frequencies(
    beam: AnyBeam,
    frequencies: Sequence[float] | Array | FrequencyList | str | Path,
    *,
    unit: str | None = None,
    shapes: ModeShapes | None = None,
    count: int | None = None,
    kind: str | None = None,
    mode: int | None = None,
    within: float = 0.01,
    theory: str | None = None,
    progress: Callable[[str], None] = lambda step: None,
) -> Result:
    """Identify the discretisation behind natural frequencies of a beam, and their errors against the exact beam.

    `beam`: as of `choose`. `frequencies`: (n,), Hz or in `unit` (rad/s, rad2/s2, s, ...), or a file of them: text, a
    solver's output, a mesh with mode shapes, measured modes; or a record of free vibration with a time column, whose
    undamped frequencies are compared and whose damping ratios are in the last table. `shapes`: of the modes, (n,
    points). `count`: N of the model, None for any. `kind`: "segments" or "elements". `mode`: for the required N, None
    for the last. `within`: accepted relative error, and `data["passed"]` says whether it is kept. Raises InputError.
    """
    check_number("within", within, "relative, of a frequency", above=0)
    for field, value, choices in (("unit", unit, tuple(UNITS)), ("kind", kind, KINDS)):
        if value is not None:
            check_choice(field, value, choices)
    if shapes is not None:
        check_type("shapes", shapes, ModeShapes)
    scene, options = named(beam), Options(count=count, kind=kind, mode=mode, within=within, theory=theory)
    if isinstance(frequencies, str | Path):
        path, suffix = Path(frequencies), Path(frequencies).suffix.lower()
        if suffix not in TEXT and is_mesh(suffix):
            return compare_shapes(scene, read_mesh(path, scene.beam.length), options)
        if str(path) != "-" and (record := read_record(path)):
            ring = ring_down(record.times, record.signals)
            modes = listed_modes(ring, scene.beam)
            found = compare_list(scene, as_list(modes, f"record {str(path)!r}"), shapes, options, progress)
            return with_record(found, ring, modes, record, scene.beam)
        given = read_frequencies(path, unit)
    elif isinstance(frequencies, FrequencyList):
        given = frequencies
    else:
        values = convert(np.asarray(frequencies).tolist(), tuple[float, ...], "frequencies")
        given = listed("frequencies", values, unit=unit or "Hz", declared=unit is not None)
    return compare_list(scene, given, shapes, options, progress)
