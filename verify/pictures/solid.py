"""Solids drawn by a child: started, listened to, ended; what it lacks in one sentence."""

import os
import pickle
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path
from typing import IO

from PIL import Image

import verify
from verify.pictures.child import DONE, HEAD
from verify.pictures.picture import Picture
from verify.pictures.view import View

FIRST_S, FRAME_S = 90.0, 5.0
"""Seconds that a child may take to begin, and for every frame."""
REMEDY = "pip install 'fem-segment-verify[viz]'"


class NotDrawnError(Exception):
    """Nothing solid can be drawn here; the message says why, and what would help."""


def check_drawable() -> None:
    """Raise NotDrawnError where pyvista is missing."""
    if find_spec("pyvista") is None:
        raise NotDrawnError(f"pyvista is not installed, {REMEDY} draws solids")


def solid_frames(picture: Picture, view: View) -> Iterator[Image.Image]:
    """Every frame of the drawing, without words, as the child has it. Raises NotDrawnError."""
    check_drawable()
    with tempfile.TemporaryFile() as errors:
        child = _started(errors)
        timer = threading.Timer(FIRST_S + FRAME_S * picture.frames, child.kill)
        timer.daemon = True
        timer.start()
        try:
            yield from _frames(child, picture, view)
        except (BrokenPipeError, EOFError):
            child.wait()
            raise NotDrawnError(_why(child.returncode, errors)) from None
        finally:
            timer.cancel()
            child.kill()
            child.wait()
            for pipe in (child.stdin, child.stdout):
                _close(pipe)


def _close(pipe: IO[bytes] | None) -> None:
    try:
        if pipe is not None:
            pipe.close()
    except BrokenPipeError:
        pass


def _started(errors: IO[bytes]) -> "subprocess.Popen[bytes]":
    """A Python that finds this very package."""
    home = str(Path(verify.__file__).parent.parent)
    paths = os.pathsep.join([home, *filter(None, [os.environ.get("PYTHONPATH")])])
    return subprocess.Popen(
        [sys.executable, "-m", "verify.pictures.child"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=errors,
        env=os.environ | {"PYTHONPATH": paths},
    )


def _frames(child: "subprocess.Popen[bytes]", picture: Picture, view: View) -> Iterator[Image.Image]:
    """Raises EOFError where the child ends before it is done."""
    assert child.stdin is not None
    assert child.stdout is not None
    asked = pickle.dumps((picture, view))
    child.stdin.write(HEAD.pack(len(asked)) + asked)
    child.stdin.flush()
    size = 3 * view.size[0] * view.size[1]
    for _ in range(picture.frames):
        data = child.stdout.read(size)
        if len(data) < size:
            raise EOFError
        yield Image.frombytes("RGB", view.size, data)
    if child.stdout.read(len(DONE)) != DONE:
        raise EOFError


def _why(status: int, errors: IO[bytes]) -> str:
    """What was missing, as far as the child could say it, and what helps."""
    errors.seek(0)
    said = errors.read().decode("utf-8", "replace").strip().splitlines()
    helps = "install OpenGL (apt install libgl1 libegl1) or run under xvfb-run"
    if said and said[-1].startswith(("ImportError", "ModuleNotFoundError")):
        what = said[-1].partition(": ")[2]
        return f"pyvista cannot be imported ({what[:120]}), {helps}" if "lib" in what else f"{what[:120]}, {REMEDY}"
    if status == -9:
        return f"VTK did not come to an end, {helps}"
    how = f"by signal {-status}" if status < 0 else f"with status {status}"
    return f"VTK finds no OpenGL that works here and ended {how}, {helps}"
