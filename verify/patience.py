"""Work estimated before it is begun: what would take too long without a word is refused."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NoReturn

from verify.errors import InputError, shown, written

PATIENCE_S = 20.0
"""Seconds of work that are begun without asking."""
VARIABLE = "VERIFY_PATIENCE"
"""The environment variable that says otherwise, in seconds."""


def check_work(field: str, value: object, seconds: float, remedy: str) -> None:
    """Raise InputError where work is estimated to take longer than is waited for.

    Estimates are of one slow core and from above; they count operations, so that they do not depend on the day.
    """
    if not waited_for(seconds):
        _refuse(field, value, f"would take about {_words(seconds)}, more", remedy)


def check_taken(field: str, value: object, seconds: float, remedy: str) -> None:
    """The same of work that is under way, and of which so much is known: how much is left nobody knows."""
    if not waited_for(seconds):
        _refuse(field, value, "takes longer", remedy)


def _refuse(field: str, value: object, takes: str, remedy: str) -> NoReturn:
    told = written(value) if isinstance(value, float) else shown(value)
    raise InputError(
        f"{field} = {told} {takes} than the {_limit():g} s that are waited for: {remedy}, or set {VARIABLE} to more "
        "seconds"
    )


def waited_for(seconds: float) -> bool:
    """Whether work that is estimated to take so long is begun without a word. Raises InputError for no such limit."""
    return seconds <= _limit()


@contextmanager
def patient(seconds: float) -> Iterator[None]:
    """Wait for that much work in the meantime, whatever the environment says."""
    before = os.environ.get(VARIABLE)
    os.environ[VARIABLE] = f"{seconds!r}"
    try:
        yield
    finally:
        del os.environ[VARIABLE]
        if before is not None:
            os.environ[VARIABLE] = before


def _words(seconds: float) -> str:
    for most, unit, name in ((120.0, 1.0, "s"), (7200.0, 60.0, "minutes"), (172800.0, 3600.0, "hours")):
        if seconds < most:
            return f"{seconds / unit:.0f} {name}"
    return f"{seconds / 86400.0:.2g} days"


def _limit() -> float:
    """Seconds. Raises InputError where the variable is no number above 0."""
    return own_limit() or PATIENCE_S


def own_limit() -> float | None:
    """The seconds that the environment says; None where it says none. Raises InputError for no number above 0."""
    given = os.environ.get(VARIABLE, "")
    if not given:
        return None
    try:
        seconds = float(given)
    except ValueError:
        seconds = 0.0
    if not seconds > 0.0:
        raise InputError(f"{VARIABLE} = {given!r}: give seconds above 0 in the environment, or leave it unset")
    return seconds
