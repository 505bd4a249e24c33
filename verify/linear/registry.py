"""The models by name: those of this package, and subclasses of `BeamModel` that another package registers."""

from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.registry import Registry

if TYPE_CHECKING:
    from verify.linear.base import BeamModel
    from verify.problem.beam import Beam

EXACT = "analytic"
"""Name of the exact beam."""
MEAN = "mean"
"""Middle of the model below and the model above, where a frequency may have it in place of a model."""


def _problem_of(model: object) -> str:
    from verify.linear.base import BeamModel

    if not (isinstance(model, type) and issubclass(model, BeamModel)):
        return "is no subclass of verify.linear.base.BeamModel: make it one"
    return "bounds the exact frequencies, as two models of the package do: leave `bounds` out" if model.bounds else ""


MODELS: "Registry[type[BeamModel]]" = Registry(
    "model",
    "verify.models",
    homes={
        EXACT: "verify.analytic_modes:ExactModel",
        "segment": "verify.segment_model:SegmentModel",
        "fem": "verify.fem_beam:HermiteModel",
    },
    refuses=_problem_of,
    classes=True,
)
"""Classes; `MODELS.named(name).build(beam, count, **settings)` is the model of a beam."""


def discrete(verb: str = "modes", beam: "Beam | None" = None) -> "tuple[type[BeamModel], ...]":
    """All models of parts with a verb; with a beam, those of other packages that do not take it are left out."""
    able = (model for model in MODELS.values() if model.sized and model.can(verb))
    return tuple(model for model in able if beam is None or model.name in MODELS.built_in or _takes(model, beam))


def _takes(model: "type[BeamModel]", beam: "Beam") -> bool:
    try:
        model.build(beam, max(model.fewest, len(beam.pieces)))
    except InputError:
        return False
    return True


def bounding() -> "tuple[type[BeamModel], type[BeamModel]]":
    """The model below the exact frequencies, and the one above."""
    sides = {MODELS[name].bounds: MODELS[name] for name in MODELS.built_in}
    return sides["below"], sides["above"]


def check_count(name: str, count: int | None, field: str = "model") -> None:
    """Raise InputError for a model of parts without their number, or one without parts with one."""
    MODELS.named(name, field).check_count(count)
