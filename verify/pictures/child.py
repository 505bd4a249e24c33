"""Solids drawn by pyvista in a process of its own: `python -m verify.pictures.child`, started by `solid`.

Reads a picture and its view from standard input, and writes every frame to standard output as it is done. VTK ends a
process that finds no OpenGL, which is this one then. It ends when whoever started it is gone: its input is closed.
"""

import os
import pickle
import struct
import sys
import threading
from typing import IO, Any

import numpy as np

from verify.models.arrays import Array, Indices
from verify.pictures.picture import COLOURS, INK, Picture, Solid, Trace, at_frame
from verify.pictures.view import View

HEAD = struct.Struct("<Q")
DONE = b"done"


def main() -> None:
    """Draw what is asked for. What VTK prints goes to the error stream."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    asked = sys.stdin.buffer
    (size,) = HEAD.unpack(asked.read(HEAD.size))
    picture, view = pickle.loads(asked.read(size))
    threading.Thread(target=_end_with, args=(asked,), daemon=True).start()
    _draw(picture, view, out)
    out.write(DONE)
    out.flush()
    os._exit(0)  # what VTK does at the end of a process is nothing that anybody waits for


def _end_with(asked: IO[bytes]) -> None:
    """Wait for whoever started this process, and end when it does."""
    asked.read()
    os._exit(1)


def _draw(picture: Picture, view: View, out: IO[bytes]) -> None:
    import pyvista

    pyvista.OFF_SCREEN = True
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(view.size), lighting="none")
    plotter.set_background("white")
    plotter.enable_anti_aliasing("ssaa")
    _light(plotter, pyvista)
    solids = [(solid, _add_solid(plotter, pyvista, solid)) for solid in picture.solids]
    traces = [(trace, _add_trace(plotter, pyvista, trace, view)) for trace in picture.traces]
    _look(plotter, view)
    for frame in range(picture.frames):
        for solid, mesh in solids:
            mesh.points[:] = points_of(solid, frame)
            if solid.values is not None:
                mesh.point_data["colour"][:] = np.tile(at_frame(solid.values, frame).reshape(-1), 2)
            mesh.Modified()
        for trace, mesh in traces:
            mesh.points[:] = _trace_points(trace, frame)
            mesh.Modified()
        plotter.render()
        image = np.ascontiguousarray(plotter.screenshot(return_img=True)[:, :, :3])
        out.write(image.tobytes())
        out.flush()


def points_of(solid: Solid, frame: int) -> Array:
    """Corners of all outlines in front of the plane, then of all behind it, (2 m k, 3)."""
    flat = at_frame(solid.outlines, frame).reshape(-1, 2)
    sides = [np.column_stack([flat, np.full(len(flat), z)]) for z in (solid.depth, -solid.depth)]
    return np.concatenate(sides)


def faces_of(m: int, k: int) -> Indices:
    """Front, back and the k sides of m outlines, as VTK has them: the number of corners, then which."""
    rows = []
    for i in range(m):
        front, behind = i * k, (m + i) * k
        rows += [k, *range(front, front + k), k, *range(behind + k - 1, behind - 1, -1)]
        for j in range(k):
            nxt = (j + 1) % k
            rows += [4, front + j, behind + j, behind + nxt, front + nxt]
    return np.array(rows)


def _add_solid(plotter: Any, pyvista: Any, solid: Solid) -> Any:
    m, k = solid.outlines.shape[1:3]
    mesh = pyvista.PolyData(points_of(solid, 0), faces_of(m, k))
    given: dict[str, Any] = {"color": solid.colour}
    if solid.values is not None:
        mesh.point_data["colour"] = np.tile(at_frame(solid.values, 0).reshape(-1), 2)
        given = {"scalars": "colour", "clim": (-1.0, 1.0), "cmap": _colours(), "show_scalar_bar": False}
    plotter.add_mesh(mesh, show_edges=solid.edges, edge_color=INK, line_width=1.0, smooth_shading=False, **given)
    return mesh


def _colours() -> list[str]:
    """256 of them, by the same rule as the scale below the picture."""
    from verify.pictures.view import colours

    assert COLOURS
    return [f"#{int(r):02x}{int(g):02x}{int(b):02x}" for r, g, b in np.rint(colours(np.linspace(-1.0, 1.0, 256)))]


def _add_trace(plotter: Any, pyvista: Any, trace: Trace, view: View) -> Any:
    points = _trace_points(trace, 0)
    mesh = pyvista.PolyData(points, lines=np.concatenate([[len(points)], np.arange(len(points))]))
    plotter.add_mesh(mesh, color=trace.colour, line_width=trace.width * view.size[0] / 960.0, lighting=False)
    return mesh


def _trace_points(trace: Trace, frame: int) -> Array:
    flat = at_frame(trace.points, frame)
    return np.column_stack([flat, np.full(len(flat), trace.depth)])


def _light(plotter: Any, pyvista: Any) -> None:
    """From above on the left, and a little from everywhere."""
    plotter.add_light(pyvista.Light(position=(-0.6, 1.6, 2.0), light_type="camera light", intensity=0.75))
    plotter.add_light(pyvista.Light(position=(0.5, 0.2, 2.0), light_type="camera light", intensity=0.4))


def _look(plotter: Any, view: View) -> None:
    camera = plotter.camera
    camera.focal_point = tuple(view.centre)
    camera.position = tuple(view.centre + 4.0 * view.towards)
    camera.up = tuple(view.up)
    camera.parallel_projection = True
    camera.parallel_scale = 0.5 * view.size[1] / view.scale
    camera.clipping_range = (0.1, 10.0)


if __name__ == "__main__":
    main()
