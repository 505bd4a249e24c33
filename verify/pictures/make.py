"""A picture from what is asked for to its file."""

from collections.abc import Iterator
from pathlib import Path

import msgspec
from PIL import Image

from verify.errors import InputError, near_name, shown
from verify.files import writable_folder
from verify.options import PICTURED
from verify.pictures.drawn import picture_of
from verify.pictures.film import MOVING, SUFFIXES, check_writable, write_film
from verify.pictures.flat import flat_frames
from verify.pictures.lettering import lettered
from verify.pictures.picture import Picture
from verify.pictures.rows import Asked
from verify.pictures.solid import NotDrawnError, check_drawable, solid_frames
from verify.pictures.view import MOVING as MOVING_WIDTH
from verify.pictures.view import STILL, view_of
from verify.scenes.scene import Scene


class Made(msgspec.Struct, frozen=True, kw_only=True):
    """What was drawn where, and why flat where it is."""

    path: Path
    frames: int
    why_flat: str


def make_picture(scene: Scene, what: str, mode: int | None, count: int | None, to: Path | None, flat: bool) -> Made:
    """Draw something of a scene into a file. Raises InputError, before anything is solved where it can be told."""
    if what not in PICTURED:
        raise InputError(f"what = {what!r} is not known: {near_name(what, PICTURED)}")
    path = _path_of(scene, what, to)
    moving = path.suffix.lower() in MOVING
    check_writable(path.suffix.lower())
    picture = picture_of(scene, Asked(what=what, mode=mode, count=count, moving=moving))
    width = MOVING_WIDTH if moving else STILL
    why = "" if flat else _why_not()
    if not flat and not why:
        try:
            _write(picture, path, width, solid=True)
            return Made(path=path, frames=picture.frames, why_flat="")
        except NotDrawnError as missing:
            why = str(missing)
    _write(picture, path, width, solid=False)
    return Made(path=path, frames=picture.frames, why_flat=why)


def _why_not() -> str:
    try:
        check_drawable()
    except NotDrawnError as missing:
        return str(missing)
    return ""


def _write(picture: Picture, path: Path, width: int, *, solid: bool) -> None:
    view = view_of(picture, width, slanted=solid)
    drawings: Iterator[Image.Image] = (solid_frames if solid else flat_frames)(picture, view)
    write_film(lettered(picture, view, drawings), path, picture.frames, picture.seconds)


def _path_of(scene: Scene, what: str, to: Path | None) -> Path:
    """The file, in a folder that takes it. Raises InputError."""
    path = Path(f"{scene.name}-{what}.png") if to is None else to / f"{scene.name}-{what}.png" if to.is_dir() else to
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"to = {shown(str(path))} has no suffix of a picture: give one of {', '.join(SUFFIXES)}")
    writable_folder(path.parent, "to")
    if path.is_dir():
        raise InputError(f"to = {shown(str(path))} is a folder: name a file in it")
    return path
