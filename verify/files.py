"""Files and folders written whole or not at all."""

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from errno import EEXIST, ENAMETOOLONG, ENOTEMPTY
from pathlib import Path

from verify.errors import InputError, shown

STALE_S = 600.0
"""Seconds after which a part that nobody went on with is one that a killed run left."""
NAMES = 1000
"""Numbers that are tried behind a folder's name before it is given up."""


def exists(path: Path, field: str) -> bool:
    """Whether there is a file or folder. Raises InputError for what can be no name: too long, or with a null byte."""
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    except OSError as error:
        if error.errno != ENAMETOOLONG:
            return True  # whoever opens it hears why it cannot
        raise InputError(f"{field} = {shown(str(path))} is too long for a file name: shorten it") from None
    except ValueError:  # a null byte, or what the file system cannot encode
        raise InputError(
            f"{field} = {shown(str(path))} can be no file name: give one without such characters"
        ) from None
    return True


def check_no_scene(path: Path, field: str) -> None:
    """Raise InputError for a file that what is written would take the place of a scene in."""
    if path.suffix.lower() == ".toml":
        raise InputError(f"{field} = {str(path)!r} ends in .toml, as scenes do, and this is none: give another name")


def writable_folder(folder: Path, field: str) -> Path:
    """Make `folder` and prove that a file can be written there. Raises InputError naming `field`."""
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
    """Write a text file through a neighbour and a rename, so that no reader ever sees half of it."""
    with whole(path, field) as part:
        part.write_text(text, encoding="utf-8", errors="backslashreplace", newline="\n")


@contextmanager
def whole(path: Path, field: str = "file") -> Iterator[Path]:
    """A neighbour to write to, which becomes `path` at the end and is gone where anything is raised in between.

    A run that is killed leaves its neighbour behind; whoever writes the same file later takes it away. Raises
    InputError where the file cannot be written.
    """
    import tempfile

    if exists(path, field) and not path.is_file():  # a rename would put an ordinary file in the place of a device
        raise InputError(f"{field} = {str(path)!r} is there and is no ordinary file: name another")
    name = ""
    try:
        _sweep(path)
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
    """A neighbour to write files to, which takes the place of the folder `path` at the end, likewise.

    What stood there before goes with it: files of that suffix alone. Raises InputError where there is anything else.
    """
    import shutil
    import tempfile

    _check_only(path, suffix, field)
    _sweep(path)
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


def _check_only(path: Path, suffix: str, field: str) -> None:
    """Raise InputError where `path` is there and is no folder of files of that suffix alone."""
    if not exists(path, field):
        return
    if not path.is_dir() or any(one.suffix != suffix for one in path.iterdir()):
        raise InputError(f"{field}: {str(path)!r} is there and holds other things than {suffix} files: name another")


def _sweep(path: Path) -> None:
    """Take away what killed runs left of this file; what is younger may be another run's, which goes on."""
    from glob import escape
    from time import time

    for part in path.parent.glob(f".{escape(path.name)}.*.part"):
        with suppress(OSError):
            if time() - part.lstat().st_mtime > STALE_S:
                _delete(part)


def write_folder(folder: Path, texts: Mapping[str, str], field: str = "folder") -> Path:
    """Write text files, by their names, into a new folder that is there whole or not at all; returns where it is.

    It is made beside the folder that it will lie in, and renamed: where the name is taken, another run's perhaps, a
    number stands behind it. Raises InputError.
    """
    import tempfile

    exists(folder, field)
    home, part = folder.parent, None
    try:
        _sweep(home)
        part = Path(tempfile.mkdtemp(dir=home.parent, prefix=f".{home.name}.", suffix=".part"))
        for name, text in texts.items():
            (part / name).write_text(text, encoding="utf-8", errors="backslashreplace")
        part.chmod(0o777 & ~_umask())
        return _moved(part, folder)
    except OSError as error:
        raise InputError(f"{field} = {str(home)!r} cannot be written to ({error.strerror or error})") from None
    finally:
        if part is not None and part.exists():
            _delete(part)
            with suppress(OSError):
                home.rmdir()  # which it does where it is empty, and nowhere else


def _moved(part: Path, folder: Path) -> Path:
    """Rename a folder to the first name behind those that are taken, whoever else looks for one. Raises OSError.

    A number that is free again, because its folder was taken away, is not used: the order of names is that of time.
    """
    from glob import escape

    behind = (one.name.rpartition("-")[2] for one in folder.parent.glob(f"{escape(folder.name)}-*"))
    numbers = [int(number) for number in behind if number.isascii() and number.isdigit()]
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
    """Take a folder away: first its name, so that nobody finds half of it. Does nothing where it cannot."""
    gone = folder.parent.parent / f".{folder.parent.name}.{folder.name}.part"
    with suppress(OSError):
        os.replace(folder, gone)
        _delete(gone)


def _delete(part: Path) -> None:
    """A file, or a folder and what is in it."""
    import shutil

    if part.is_dir() and not part.is_symlink():
        shutil.rmtree(part, ignore_errors=True)
    else:
        part.unlink()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
