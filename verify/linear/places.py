"""Places along a beam and forces on it as users type them: a number or many, one force or many."""

from collections.abc import Callable, Sequence
from functools import wraps
from itertools import chain, repeat
from typing import Any, ParamSpec, TypeAlias, TypeVar

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.checks import check_kind, check_unmasked, check_whole, plain, several
from verify.errors import InputError, shown
from verify.problem.beam import Beam, PointForce

Numbers: TypeAlias = float | Sequence[float] | Array
"""One, a list or an array."""
Forces: TypeAlias = PointForce | Sequence[PointForce]
"""One force alone stands for a list of it."""
Values = TypeVar("Values", bound=np.ndarray[Any, Any])
Given = ParamSpec("Given")
Found = TypeVar("Found")
SLACK = 1e-12
"""Of the length: as far off an end a place is one that rounding put there."""


def as_typed(verb: Callable[Given, Found]) -> Callable[Given, Found]:
    """The verb, which then takes numpy's scalars for counts and figures, and a force alone for a list of it.

    What is no Beam where a verb begins with one is refused.
    """
    begins = getattr(verb, "__code__", None)
    fields = begins.co_varnames[: begins.co_argcount] if begins is not None else ()
    on_beam = fields[:1] == ("beam",)

    def settled(field: str, value: Any) -> Any:
        return (value,) if isinstance(value, PointForce) else plain(value)

    @wraps(verb)
    def called(*args: Given.args, **named: Given.kwargs) -> Found:
        if on_beam and (args or "beam" in named):
            check_kind("beam", args[0] if args else named["beam"], Beam)
        given = map(settled, chain(fields, repeat("a value")), args)
        return verb(*given, **{name: settled(name, value) for name, value in named.items()})

    return called


def in_a_row(field: str, value: object, unit: str = "SI") -> Array:
    """Numbers in a row, (n,); one alone is a row of one. Raises InputError for rows of rows and what is no number."""
    found = np.atleast_1d(real_array(field, value, unit))
    if found.ndim > 1:
        raise InputError(f"{field} has the shape {found.shape}: give a number, or numbers in one row ({unit})")
    return found


def real_array(field: str, value: object, unit: str) -> Array:
    """Numbers in any arrangement as an array of the same shape. Raises InputError for what is no real number."""
    return _numbers(field, value, unit, "iuf").astype(float, copy=False)


def complex_array(field: str, value: object, unit: str) -> ComplexArray:
    """Numbers in any arrangement, real or complex, likewise."""
    return _numbers(field, value, unit, "iufc").astype(complex, copy=False)


def _numbers(field: str, value: object, unit: str, kinds: str) -> Array:
    """What is an array of numbers of some of numpy's kinds, none of which is masked."""
    check_unmasked(field, value, unit)
    try:
        given = np.asarray(value)
    except ValueError:  # rows of different lengths
        given = np.empty(0, dtype=object)
    if given.dtype.kind not in kinds:
        raise InputError(f"{field} = {shown(value)}: give a number, a list or an array of numbers ({unit})")
    return given


def places(field: str, value: object, length: float) -> Array:
    """Positions on a beam, an array of the shape that was given. Raises InputError where one lies off it."""
    found = real_array(field, value, "metres")
    off = found[~((found >= -SLACK * length) & (found <= length * (1.0 + SLACK)))]
    if off.size:
        raise InputError(f"{field} = {float(off[0])!r} lies off the beam: give positions between 0 and {length!r} m")
    return found


def within(nodes: Array, length: float) -> Array:
    """Ends of parts, the last at the end of the beam where a sum of lengths leaves it by a rounding."""
    if abs(nodes[-1] - length) <= SLACK * length:
        nodes[-1] = length
    return nodes


def places_in_a_row(field: str, value: object, length: float) -> Array:
    """The same in a row, (n,), a copy: what a rounding puts off the beam is at its end. Raises InputError."""
    return np.clip(places(field, in_a_row(field, value, "metres"), length), 0.0, length)


def as_asked(found: Values, x: Numbers) -> Values:
    """What was read at x in a row, (..., n), in the arrangement of x, (..., *shape of x): a number is a row of one."""
    shape = np.shape(x)
    return found if len(shape) < 2 else found.reshape(found.shape[:-1] + shape)


class Line:
    """A line along a beam as who knows it gives it, (x, derivative) -> its values; what is no derivative is refused."""

    __slots__ = ("given",)

    def __init__(self, given: Callable[[Array, int], Any]) -> None:
        self.given = given

    def __call__(self, x: Array, derivative: int) -> Any:
        """The derivative at x. Raises InputError where it is no whole number of at least 0."""
        check_whole("derivative", derivative, 0)
        return self.given(x, derivative)


def keep_lines(value: msgspec.Struct, *fields: str) -> None:
    """Make the lines that a frozen value holds, where it holds any, such that refuse what is no derivative."""
    for field in fields:
        line = getattr(value, field)
        if line is not None and not isinstance(line, Line):
            msgspec.structs.force_setattr(value, field, Line(line))


def as_forces(forces: Forces) -> tuple[PointForce, ...]:
    """The forces as a tuple, one force alone too. Raises InputError for what is none."""
    return several("forces", forces, PointForce)
