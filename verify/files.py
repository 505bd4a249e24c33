"""Files and folders that are written whole or not at all."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from errno import EEXIST, ENAMETOOLONG, ENOTEMPTY
from pathlib import Path

from verify.errors import InputError, shown

STALE_S = 600.0
"""Age, s, at which a temporary neighbour belongs to a killed run."""
NAMES = 1000
"""Numbers tried behind a folder's name."""


def exists(path: Path, field: str) -> bool:
    """Whether there is a file or folder. Raises InputError for an impossible name: too long, or with a null byte."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError as error:
        if error.errno != ENAMETOOLONG:
            return True  # opening it gives the reason
        raise InputError(f"{field} = {shown(str(path))} is too long for a file name: shorten it") from None
    except ValueError:  # a null byte, or not encodable
        raise InputError(
            f"{field} = {shown(str(path))} can be no file name: give one without such characters"
        ) from None
    return True


def check_no_scene(path: Path, field: str) -> None:
    """Raise InputError for output to a .toml file, which would replace a scene."""
    if path.suffix.lower() == ".toml":
        raise InputError(f"{field} = {str(path)!r} ends in .toml, as scenes do, and this is none: give another name")


def writable_folder(folder: Path, field: str) -> Path:
    """Make `folder` and check that a file can be written there. Raises InputError naming `field`."""
    import tempfile

    exists(folder, field)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError as error:
        raise InputError(
            f"{field} = {str(folder)!r} cannot be written to ({error.strerror or error}): name another folder"
        ) from None


def write_whole(path: Path, text: str, field: str = "file") -> None:
    """Write a text file through a temporary neighbour and a rename, so that no reader sees half of it."""
    with whole(path, field) as part:
        part.write_text(text, encoding="utf-8", errors="backslashreplace", newline="\n")


@contextmanager
def whole(path: Path, field: str = "file") -> Iterator[Path]:
    """A temporary neighbour that becomes `path` at the end, and is deleted where anything is raised in between.

    Raises InputError where the file cannot be written.
    """
    import tempfile

    if exists(path, field) and not path.is_file():  # a rename would replace a device by an ordinary file
        raise InputError(f"{field} = {str(path)!r} is there and is no ordinary file: name another")
    name = ""
    try:
        _delete_stale(path)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
        os.close(handle)
        yield Path(name)
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, path)
    except OSError as error:
        raise InputError(f"{field} = {str(path)!r} cannot be written ({error.strerror or error})") from None
    finally:
        if name and os.path.exists(name):
            os.unlink(name)


@contextmanager
def whole_folder(path: Path, suffix: str, field: str = "file") -> Iterator[Path]:
    """A temporary folder that replaces the folder `path` at the end.

    Raises InputError where `path` holds anything but files of that suffix.
    """
    import shutil
    import tempfile

    if exists(path, field) and (not path.is_dir() or any(one.suffix != suffix for one in path.iterdir())):
        raise InputError(f"{field}: {str(path)!r} is there and holds other things than {suffix} files: name another")
    _delete_stale(path)
    name = ""
    try:
        name = tempfile.mkdtemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
        fresh, old = Path(name) / "new", Path(name) / "old"
        fresh.mkdir()
        yield fresh
        if path.exists():
            os.replace(path, old)
        os.replace(fresh, path)
    except OSError as error:
        raise InputError(f"{field} = {str(path)!r} cannot be written ({error.strerror or error})") from None
    finally:
        if name:
            shutil.rmtree(name, ignore_errors=True)


def write_folder(folder: Path, texts: Mapping[str, str], field: str = "folder") -> Path:
    """Write text files by their names into a new folder, whole or not at all; returns its path.

    Where the name is taken, a number is appended. Raises InputError.
    """
    import tempfile

    exists(folder, field)
    home, part = folder.parent, None
    try:
        _delete_stale(home)
        part = Path(tempfile.mkdtemp(dir=home.parent, prefix=f".{home.name}.", suffix=".part"))
        for name, text in texts.items():
            (part / name).write_text(text, encoding="utf-8", errors="backslashreplace")
        part.chmod(0o777 & ~_umask())
        return _renamed(part, folder)
    except OSError as error:
        raise InputError(f"{field} = {str(home)!r} cannot be written to ({error.strerror or error})") from None
    finally:
        if part is not None and part.exists():
            _delete(part)
            with suppress(OSError):
                home.rmdir()  # only if empty


def _renamed(part: Path, folder: Path) -> Path:
    """Rename a folder to the first free name after those in use, so that names are in order of time. Raises OSError."""
    from glob import escape

    suffixes = (one.name.rpartition("-")[2] for one in folder.parent.glob(f"{escape(folder.name)}-*"))
    numbers = [int(number) for number in suffixes if number.isascii() and number.isdigit()]
    first = max(numbers, default=int(folder.exists())) + 1
    for number in range(first, first + NAMES):
        there = folder if number == 1 else folder.with_name(f"{folder.name}-{number}")
        folder.parent.mkdir(exist_ok=True)
        if there.exists():
            continue
        try:
            os.replace(part, there)
        except OSError as error:
            if not there.exists() and error.errno not in (EEXIST, ENOTEMPTY):
                raise
        else:
            return there
    raise FileExistsError(EEXIST, "every name that was tried is taken")


def delete_folder(folder: Path) -> None:
    """Delete a folder, renamed first so that no reader finds half of it. Does nothing where it cannot."""
    gone = folder.parent.parent / f".{folder.parent.name}.{folder.name}.part"
    with suppress(OSError):
        os.replace(folder, gone)
        _delete(gone)


def _delete_stale(path: Path) -> None:
    """Delete temporary neighbours of this file that killed runs left; younger ones may belong to a running process."""
    from glob import escape
    from time import time

    for part in path.parent.glob(f".{escape(path.name)}.*.part"):
        with suppress(OSError):
            if time() - part.lstat().st_mtime > STALE_S:
                _delete(part)


def _delete(part: Path) -> None:
    import shutil

    if part.is_dir() and not part.is_symlink():
        shutil.rmtree(part, ignore_errors=True)
    else:
        part.unlink()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
