"""Files and folders that are written whole or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path

from verify.errors import InputError, shown


def exists(path: Path, field: str) -> bool:
    """Whether a file or folder exists. Raises InputError for an impossible name: too long, or with a null byte."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except PermissionError:
        return True  # opening it gives the reason
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError(f"{field} = {shown(str(path))} can be no file name ({why}): give another") from None
    return True


@contextmanager
def _written(path: Path, field: str) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        why = f"({error.strerror or error}): name another place"
        raise InputError(f"{field} = {str(path)!r} cannot be written to {why}") from None


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
    folder = Path(tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name[:80]}.", suffix=".part"))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)
