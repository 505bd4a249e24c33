"""Files written whole or not at all."""

import os
from errno import ENAMETOOLONG
from pathlib import Path

from verify.errors import InputError, shown

STALE_S = 600.0
"""Seconds after which a part that nobody went on with is one that a killed run left."""


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
    """Write a text file through a neighbour and a rename, so that no reader ever sees half of it.

    A run that is killed in between leaves its neighbour behind; whoever writes the same file later takes it away.
    """
    import tempfile

    exists(path, field)
    handle = None
    try:
        _sweep(path)
        handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".part")
        with os.fdopen(handle, "w", encoding="utf-8", errors="backslashreplace") as stream:
            stream.write(text)
        os.chmod(name, 0o666 & ~_umask())
        os.replace(name, path)
    except OSError as error:
        raise InputError(f"{field} = {str(path)!r} cannot be written ({error.strerror or error})") from None
    finally:
        if handle is not None and os.path.exists(name):
            os.unlink(name)


def _sweep(path: Path) -> None:
    """Take away what killed runs left of this file; what is younger may be another run's, which goes on."""
    from contextlib import suppress
    from glob import escape
    from time import time

    for part in path.parent.glob(f".{escape(path.name)}.*.part"):
        with suppress(OSError):
            if time() - part.lstat().st_mtime > STALE_S:
                part.unlink()


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
