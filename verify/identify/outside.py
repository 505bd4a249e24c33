"""A model class of somebody else, imported, asked for its modes, and held to what they have to be."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from importlib import import_module
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from verify.beam import Beam
from verify.checks import check_whole
from verify.errors import InputError, shown
from verify.identify.reading import Listed, Shapes, check_rising, check_shapes

POINTS = 201
"""Places at which shapes are read."""
MODES = 10
"""Asked for where nobody says how many."""


class Answered(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What a model gave."""

    listed: Listed
    shapes: Shapes | None
    count: int | None


def asked_of(name: str, beam: Beam, count: int | None, n_modes: int | None) -> Answered:
    """The first modes of a model 'package.module:Class' on a beam.

    Its `solve_modes(beam, n_modes, count)` returns something with `frequencies_hz`, (n_modes,) ascending, and, where it
    knows shapes, `deflection(x)`, (n_modes, len(x)). Raises InputError, with the verb, for a name that cannot be
    imported, verbs that are missing or raise, wrong shapes, and numbers that are none.
    """
    model = _imported(name)
    if getattr(model, "sized", True):
        if count is None:
            raise InputError(f"count is missing: give --count, the number of parts of --model {name}")
        check_whole("count", count, int(getattr(model, "fewest", 1)))
    wanted = n_modes or _available(model, beam, count, name)
    found = _called(name, "solve_modes", lambda: model.solve_modes(beam, wanted, count))
    if not hasattr(found, "frequencies_hz"):
        raise InputError(
            f"model = {name!r}: solve_modes returns {shown(found)}, without frequencies_hz: return what has it"
        )
    frequencies = _array(name, "frequencies_hz", found.frequencies_hz, (wanted,))
    for i, value in enumerate(frequencies):
        if not value > 0.0:
            raise InputError(f"model = {name!r}: frequencies_hz[{i}] = {float(value)!r}: elastic modes are above zero")
    check_rising([float(f) for f in frequencies], f"model = {name!r}", range(1, wanted + 1))
    listed = Listed(
        frequencies_hz=frequencies, numbers=None, rounding=np.full(wanted, 1e-16), source=f"model {name}", unit="Hz"
    )
    return Answered(listed=listed, shapes=_shapes(name, found, beam, wanted), count=count)


def _shapes(name: str, found: Any, beam: Beam, n_modes: int) -> Shapes | None:
    """Deflections along the beam, where the model has them."""
    deflection = getattr(found, "deflection", None)
    if deflection is None:
        return None
    x = np.linspace(0.0, beam.length, POINTS)
    values = _array(name, "deflection(x)", _called(name, "deflection", lambda: deflection(x)), (n_modes, POINTS))
    shapes = Shapes(x=x, values=values)
    check_shapes(shapes, beam.length, f"model = {name!r}")
    return shapes


def _imported(name: str) -> Any:
    """The model of that name, one instance of a class. Raises InputError."""
    module, colon, attribute = name.partition(":")
    if not (colon and module and attribute):
        raise InputError(f"model = {name!r}: write it as package.module:Class")
    try:
        with _here(), redirect_stdout(sys.stderr):
            found = import_module(module)
    except ImportError as error:
        raise InputError(f"model = {name!r} cannot be imported ({error}): check the name, or where you stand") from None
    except (Exception, SystemExit) as error:  # whatever a module of somebody else's does when it is imported
        raise InputError(f"model = {name!r} breaks when it is imported: {type(error).__name__}: {error}") from None
    if not hasattr(found, attribute):
        raise InputError(f"model = {name!r}: {module} has no {attribute}")
    kind = getattr(found, attribute)
    model = _called(name, "__init__", kind) if isinstance(kind, type) else kind
    from verify.models.kind import Model

    if not (model.can("solve_modes") if isinstance(model, Model) else callable(getattr(model, "solve_modes", None))):
        raise InputError(f"model = {name!r} has no solve_modes(beam, n_modes, count): give it that verb")
    return model


@contextmanager
def _here() -> Iterator[None]:
    """Modules in the working folder are found, as they are by `python -m`."""
    here = str(Path.cwd())
    sys.path.insert(0, here)
    try:
        yield
    finally:
        sys.path.remove(here)


def _available(model: Any, beam: Beam, count: int | None, name: str) -> int:
    """How many modes to ask for: what it has, at most `MODES`."""
    if count is None or not hasattr(model, "n_elastic"):
        return MODES
    have: int = _called(name, "n_elastic", lambda: int(model.n_elastic(beam, count)))
    if have < 1:
        raise InputError(f"count = {count}: model {name} has no elastic mode at that size, raise it")
    return min(MODES, have)


def _called(name: str, verb: str, call: Any) -> Any:
    """What a verb returns; what it prints goes to the error stream. Raises InputError for whatever it raises."""
    try:
        with redirect_stdout(sys.stderr):
            return call()
    except InputError:
        raise
    except (Exception, SystemExit) as error:
        raise InputError(f"model = {name!r}: {verb} raises {type(error).__name__}: {error}") from None


def _array(name: str, what: str, value: Any, shape: tuple[int, ...]) -> Any:
    """Finite numbers of a shape. Raises InputError where they are not."""
    if np.iscomplexobj(value):
        raise InputError(f"model = {name!r}: {what} is complex: give real numbers")
    try:
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"model = {name!r}: {what} = {shown(value)} is no array of numbers") from None
    if array.shape != shape:
        raise InputError(f"model = {name!r}: {what} has the shape {array.shape}, and {shape} was asked for")
    if not np.isfinite(array).all():
        where = ", ".join(map(str, np.argwhere(~np.isfinite(array))[0]))
        raise InputError(f"model = {name!r}: {what}[{where}] is not finite: mend the model")
    return array
