"""Inputs that are read only where they are ordinary files; files and folders that are written whole or not at all."""

import atexit
import os
import shutil
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from io import FileIO
from pathlib import Path

from verify.errors import InputError, shown

TEXT, MESH = 50_000_000, 2_000_000_000
"""Largest text, of which Python's objects are 60 times as large, and largest mesh, which is read as arrays, bytes."""


def exists(path: Path, field: str) -> bool:
    """Whether a file or folder exists. Raises InputError for an impossible name, or in a folder closed to the user."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except (OSError, ValueError) as error:  # too long, a loop of links, a null byte, no permission
        why = getattr(error, "strerror", None) or error
        raise InputError(f"{field} = {shown(str(path))} cannot be reached ({why}): give another") from None
    return True


def readable(path: Path, field: str, most: int = TEXT) -> Path:
    """The path, of an ordinary file of at most `most` bytes that can be opened. Raises InputError naming `field`.

    A pipe or a device is refused before it is opened, which may wait for ever.
    """
    subject = f"{field} = {shown(str(path))}"
    if not exists(path, field):
        raise InputError(f"{subject} does not exist: give a file")
    if not path.is_file():
        what = "a folder: give a file in it" if path.is_dir() else "a pipe or a device: write it to a file first"
        raise InputError(f"{subject} is {what}")
    try:
        with path.open("rb"):
            size = path.stat().st_size
    except OSError as error:
        raise InputError(f"{subject} cannot be read ({error.strerror}): give another file") from None
    if size > most:
        raise InputError(f"{subject} has {size / 1e6:.6g} MB: give at most {most / 1e6:g} MB, the part that is needed")
    return path


def read_text(path: Path, field: str, most: int = TEXT) -> str:
    """The text of an ordinary file, or of standard input for '-', with newlines as LF. Raises InputError."""
    data = sys.stdin.buffer.read(most + 1) if str(path) == "-" else readable(path, field, most).read_bytes()
    if len(data) > most:
        raise InputError(f"{field} = '-' has more than {most / 1e6:g} MB: give the part that is needed")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise InputError(f"{field} = {shown(str(path))} is not text in UTF-8: save it as UTF-8") from None


@contextmanager
def _written(path: Path, field: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        why = f"({error.strerror or error}): name another place"
        raise InputError(f"{field} = {shown(str(path))} cannot be written to {why}") from None


def append(stream: FileIO, data: bytes, field: str) -> None:
    """Write all of `data` to a file without a buffer, unless the disk, a quota or a limit allows less: InputError."""
    with _written(Path(stream.name), field):
        while data:
            data = data[stream.write(data) :]


def writable_folder(folder: Path, field: str) -> Path:
    """Make `folder` and check that a file can be written in it. Raises InputError naming `field`."""
    with _written(folder, field):
        exists(folder, field)
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder


def write_whole(path: Path, text: str, field: str = "file") -> None:
    """Write a text file through a temporary neighbour and a rename, so that no reader sees half of it."""
    with whole(path, field) as part:
        part.write_text(text, encoding="utf-8", errors="backslashreplace", newline="\n")


@contextmanager
def whole(path: Path, field: str = "file") -> Iterator[Path]:
    """A temporary neighbour that becomes `path` at the end, and is deleted where anything is raised in between.

    Raises InputError where the file cannot be written.
    """
    if exists(path, field) and not path.is_file():  # a rename would replace a device by an ordinary file
        raise InputError(f"{field} = {str(path)!r} is there and is no ordinary file: name another")
    with _written(path, field), _scratch(path) as scratch:
        part = scratch / path.name
        yield part
        os.replace(part, path)


def write_folder(folder: Path, texts: Mapping[str, str], field: str = "folder") -> None:
    """Write text files by their names into a new folder, whole or not at all. Raises InputError."""
    with _written(folder.parent, field), _scratch(folder.parent) as scratch:
        part = scratch / folder.name
        part.mkdir()
        for name, text in texts.items():
            (part / name).write_text(text, encoding="utf-8", errors="backslashreplace")
        folder.parent.mkdir(exist_ok=True)
        os.replace(part, folder)


@contextmanager
def _scratch(path: Path) -> Iterator[Path]:
    """A hidden temporary folder beside `path`."""
    folder = path.parent / f".{path.name[:40]}.{os.urandom(4).hex()}.part"
    remove = partial(shutil.rmtree, folder, ignore_errors=True)
    atexit.register(remove)  # before the folder is there: an interrupt may come at any later place, this one's end too
    try:
        folder.mkdir(mode=0o700)
        yield folder
    finally:
        remove()
        atexit.unregister(remove)
