"""Which models there are: those of the package, and any that is registered under `verify.models`."""

from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.linear.kind import Model
from verify.registry import Registry

if TYPE_CHECKING:
    from verify.problem.beam import Beam


def _wrong(model: object) -> str:
    """What a model from outside cannot be."""
    if not isinstance(model, Model):
        return "is no subclass of verify.linear.kind.Model: make it one"
    return "bounds nothing here: two models of the package do, leave `bounds` out" if model.bounds else ""


MODELS: Registry[Model] = Registry(
    "model",
    "verify.models",
    homes={
        "analytic": "verify.analysis.subjects:Exact",
        "segment": "verify.analysis.subjects:Segments",
        "fem": "verify.analysis.subjects:Elements",
    },
    refuses=_wrong,
)


def discrete(verb: str = "solve_modes", beam: "Beam | None" = None) -> tuple[Model, ...]:
    """All models of parts that have a verb and, if one is given, take the beam."""
    able = (model for model in MODELS.values() if model.sized and model.can(verb))
    return tuple(model for model in able if beam is None or not model.refuses(beam))


def bounding() -> tuple[Model, Model]:
    """The model that is known to lie below the exact frequencies, and the one above."""
    sides = {MODELS[name].bounds: MODELS[name] for name in MODELS.built_in}
    return sides["below"], sides["above"]


EXACT_MODES = 400
"""That the exact beam keeps in time unless told otherwise."""


def check_count(name: str, count: int | None, field: str = "model") -> None:
    """Raise InputError for a model of parts without their number, or one that has none with one."""
    sized = MODELS.named(name, field).sized
    if sized and count is None:
        raise InputError(f"count is missing: give the number of segments or elements for model = {name}")
    if not sized and count is not None:
        raise InputError(f"count = {count!r} is for models of parts: {name} has none, leave it out")


def kept_modes(name: str, modes: int | None, otherwise: int) -> int:
    """How many modes a model without parts keeps in time, `otherwise` unless given.

    Raises InputError where they are given to a model of parts, which keeps all that it has.
    """
    if modes is not None and MODELS.named(name).sized:
        raise InputError(f"modes = {modes!r} is for model = analytic: {name} keeps all it has, leave it out")
    return otherwise if modes is None else modes
