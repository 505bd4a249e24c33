"""Which models there are: those of the package, and any that is registered under `verify.models`."""

from verify.errors import InputError
from verify.models.kind import Model
from verify.registry import Registry

MODELS: Registry[Model] = Registry(
    "model",
    "verify.models",
    homes={
        "analytic": "verify.judge.subjects:Exact",
        "segment": "verify.judge.subjects:Segments",
        "fem": "verify.judge.subjects:Elements",
    },
)


def discrete(verb: str = "solve_modes") -> tuple[Model, ...]:
    """All models of parts that have a verb."""
    return tuple(model for model in MODELS.values() if model.sized and model.can(verb))


def bounding() -> tuple[Model, Model]:
    """The model that is known to lie below the exact frequencies, and the one above."""
    sides = {MODELS[name].bounds: MODELS[name] for name in MODELS.own()}
    return sides["below"], sides["above"]


def check_count(name: str, count: int | None, field: str = "model") -> None:
    """Raise InputError for a model of parts without their number, or one that has none with one."""
    sized = MODELS.named(name, field).sized
    if sized and count is None:
        raise InputError(f"count is missing: give the number of segments or elements for model = {name}")
    if not sized and count is not None:
        raise InputError(f"count = {count!r} is for models of parts: {name} has none, leave it out")
