"""TOML read and overridden: plain tables, before anything is made of them."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from verify.errors import InputError, NoTomlError, near_name, shown
from verify.files import exists

_LARGE = "TOML's whole numbers have 64 bits, write a large number as 1e30"
_DECIMAL = re.compile(r"(?<![\w.])([+-]?)(?:(\d+)\.|\.(\d+))((?:[eE][+-]?\d+)?)(?![\w.])")
"""A number with nothing on one side of its point."""


def read_text(path: Path) -> str:
    """The text of a scene file. Raises NoTomlError where it cannot be read."""
    exists(path, "scene")
    if path.exists() and not (path.is_file() or path.is_dir()):  # a pipe or a device has no end
        raise NoTomlError(f"scene file {str(path)!r} is no file that ends: write the scene to one")
    try:
        return path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")
    except OSError as error:
        raise NoTomlError(f"scene file {str(path)!r} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise NoTomlError(f"scene file {str(path)!r} is not text in UTF-8: save it as TOML in UTF-8") from None


def read_toml(path: Path) -> dict[str, Any]:
    """The tables of a TOML file. Raises NoTomlError where there is none, InputError for a number that is too large."""
    import tomllib

    text = read_text(path)
    try:
        return {key: _whole(value, f"scene file {str(path)!r}: {key}") for key, value in tomllib.loads(text).items()}
    except (tomllib.TOMLDecodeError, RecursionError) as error:
        raise NoTomlError(f"scene file {str(path)!r} is not TOML: {error}") from None
    except InputError:
        raise
    except ValueError:  # Python reads no whole number of more than 4300 digits
        raise InputError(f"scene file {str(path)!r} has a number of thousands of digits: {_LARGE}") from None


def _whole(data: Any, where: str) -> Any:
    """The same data. Raises InputError for a whole number beyond TOML's 64 bits, named by its key."""
    if isinstance(data, dict | list):
        for key, value in data.items() if isinstance(data, dict) else enumerate(data):
            _whole(value, f"{where}[{key}]" if isinstance(data, list) else f"{where}.{key}")
    if isinstance(data, int) and not -(2**63) <= data < 2**63:
        raise InputError(f"{where} = {shown(data)}: {_LARGE}")
    return data


def literal(text: str, field: str = "value") -> Any:
    """A TOML literal; a bare word is a string; comma-separated values are a list. Raises InputError.

    Numbers may begin or end with their point, as .5 and 3. do: TOML wants the nought, who types does not. `field` is
    what messages call it.
    """
    _check_text(text, field)
    for spelt in dict.fromkeys((text, _with_noughts(text))):
        try:
            value = _value(spelt)
        except (ValueError, KeyError, RecursionError):  # tomllib's own, and Python's for more than 4300 digits
            continue
        return _whole(value, field)
    if "," in text and not text.lstrip().startswith(("[", "{", '"', "'")):
        return [literal(part.strip(), field) for part in text.split(",") if part.strip()]
    return text


def _value(text: str) -> Any:
    import tomllib

    return tomllib.loads(f"value = {text}")["value"]


def _with_noughts(text: str) -> str:
    """.5 as 0.5 and 3. as 3.0, where nothing is quoted."""
    if "." not in text or '"' in text or "'" in text:
        return text
    return _DECIMAL.sub(lambda n: f"{n[1]}{n[2] or 0}.{n[3] or 0}{n[4]}", text)


def _check_text(text: str, field: str) -> None:
    """Raise InputError for bytes of a command line that are no UTF-8: nothing could write them."""
    if not text.isascii() and any("\ud800" <= character <= "\udfff" for character in text):
        raise InputError(f"{field} = {shown(text)} is not text in UTF-8: type it again")


def split_assignment(text: str) -> tuple[str, Any]:
    """'key=value' as key and literal. Raises InputError where there is no '='."""
    _check_text(text, "assignment")
    key, equals, value = text.partition("=")
    if not equals or not key.strip() or not value.strip():
        raise InputError(f"{text!r} is not an assignment: write key=value, for instance mode=22")
    return key.strip(), literal(value.strip(), key.strip())


def given_arguments(assignments: tuple[str, ...]) -> dict[str, Any]:
    """'key=value' words as a dict. Raises InputError where a key stands twice."""
    given: dict[str, Any] = {}
    for text in assignments:
        key, value = split_assignment(text)
        if key in given:
            raise InputError(f"{key} is given twice, as {given[key]!r} and {value!r}: give it once")
        given[key] = value
    return given


def override(data: dict[str, Any], assignment: str, meant: Callable[[Any, str], Any]) -> None:
    """Set one value of a scene's tables in place: 'beam.length=0.4', 'gate.ID.within=1e-6'.

    `meant` makes of a literal and its key what stands in the table.
    """
    key, literally = split_assignment(assignment)
    value = meant(literally, key)
    *parents, last = key.split(".")
    here: Any = data
    for depth, step in enumerate(parents):
        here = _entry(here, step, ".".join(parents[: depth + 1]))
    if isinstance(here, list):
        here[_position(here, last, key)] = value
    else:
        here[last] = value


def _entry(here: Any, step: str, field: str) -> Any:
    """The table or list below `here`; a missing table is made, so that the checker can name it."""
    here = here[_position(here, step, field)] if isinstance(here, list) else here.setdefault(step, {})
    if not isinstance(here, dict | list):
        raise InputError(f"--set {field} is a value, not a table: set {field} itself")
    return here


def _position(entries: list[Any], step: str, field: str) -> int:
    """Where in a list an entry stands: by its id, or by its number from 0."""
    numbers = [str(i) for i in range(len(entries))]
    names = [str(e.get("id", i)) if isinstance(e, dict) else i for i, e in zip(numbers, entries, strict=True)]
    for known in (names, numbers):
        if step in known:
            return known.index(step)
    what = field.removesuffix(f".{step}")
    if not names:
        raise InputError(f"--set {field} names no entry: the list is empty")
    if names == numbers:
        last = f" to {names[-1]}" if len(names) > 1 else ""
        raise InputError(f"--set {field} names no entry: those of {what} are numbered, write {what}.0{last}")
    raise InputError(f"--set {field} names no entry: {near_name(step, names)}")
