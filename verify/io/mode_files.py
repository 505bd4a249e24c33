"""Points and vectors of mode shapes from meshes (any format of meshio) and universal files of measurements (pyuff)."""

import io
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, one_line
from verify.files import MESH, readable

UNIVERSAL = (".uff", ".unv")  # suffixes of universal files


def is_mesh(suffix: str) -> bool:
    """Whether files with this suffix are universal files or meshes."""
    import meshio

    return suffix in (*UNIVERSAL, *meshio.extension_to_filetypes)


def read_points(path: Path, source: str) -> tuple[Array, dict[str, Array], dict[str, Any]]:
    """(points (n, 3), arrays at them, field data with frequencies). Raises InputError."""
    readable(path, "file", MESH)
    if path.suffix.lower() not in UNIVERSAL:
        return _mesh(path, source)
    try:
        return _universal(path, source)
    except InputError:
        raise
    except (ValueError, LookupError, TypeError):  # columns of unequal length, sets without their fields
        raise InputError(f"{source} has a set that is cut or damaged: write sets 15 and 55, or 15 and 58") from None


def _universal(path: Path, source: str) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """`read_points` of sets 15 or 2411 and 55, else peaks of responses, sets 58, with their `resolution` in Hz.

    At a peak of the sum of squared responses their imaginary part is the shape. Raises InputError.
    """
    sets = _sets(path, source)
    of = {kind: [one for one in sets if one["type"] == kind] for kind in (15, 2411, 55, 58)}
    node = {
        int(n): xyz for one in of[15] + of[2411] for n, *xyz in zip(*map(one.get, ("node_nums", *"xyz")), strict=True)
    }
    modes: list[tuple[float, dict[int, Array]]] = []
    field: dict[str, Array] = {}
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
        field["resolution"] = np.diff(of[58][0]["x"][:2])
    shared = sorted(set(node).intersection(*(shape for _, shape in modes)))
    if not modes or len(shared) < 3:
        raise InputError(f"{source} has {len(modes)} modes at {len(shared)} points: write sets 15 and 55, or 15 and 58")
    arrays = {f"mode_{i}": np.array([shape[n] for n in shared]) for i, (_, shape) in enumerate(modes, start=1)}
    field["hz"] = np.array([hertz for hertz, _ in modes])
    return np.array([node[n] for n in shared], dtype=float), arrays, field


def read_response(path: Path, source: str) -> tuple[Array, ComplexArray]:
    """(frequencies, response), (n,) each, of the first set 58 of a universal file. Raises InputError."""
    first = next((one for one in _sets(path, source) if one["type"] == 58), None)
    if first is None:
        raise InputError(f"{source} has no response: write a set 58")
    return np.asarray(first["x"], dtype=float), np.asarray(first["data"], dtype=complex)


def _sets(path: Path, source: str) -> list[dict[str, Any]]:
    """The sets of a universal file. Raises InputError."""
    try:
        import pyuff
    except ImportError:
        raise InputError(f"{source} needs pyuff: pip install fem-segment-verify[measured]") from None
    try:
        return [pyuff.UFF(str(path)).read_sets(i) for i in range(pyuff.UFF(str(path)).get_n_sets())]
    except Exception as error:  # its reader raises plain ones
        why = one_line(str(error))[:200]
        raise InputError(f"{source} is cut or no universal file (pyuff: {why}): write sets 15 and 55") from None


def _mesh(path: Path, source: str) -> tuple[Array, dict[str, Array], dict[str, Array]]:
    """`read_points` by meshio, which prints and exits on failure. Raises InputError."""
    import meshio

    output = io.StringIO()
    try:
        with redirect_stdout(output), redirect_stderr(output), np.errstate(all="ignore"):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:  # readers of many formats raise many types
        printed = output.getvalue() if isinstance(error, SystemExit) else str(error)
        why = one_line(" ".join(printed.split()) or "it is cut or damaged")[:200]
        raise InputError(f"{source} is no mesh that meshio reads ({why}): save the mesh as .vtu") from None
    arrays = {str(name): np.asarray(values) for name, values in mesh.point_data.items()}
    return np.asarray(mesh.points, dtype=float), arrays, {str(k): np.asarray(v) for k, v in mesh.field_data.items()}
