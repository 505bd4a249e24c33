"""Registry of the models: those of this package, and subclasses of `BeamModel` of other packages."""

from verify.errors import InputError
from verify.linear.base import BeamModel
from verify.problem.beam import Beam
from verify.registry import Registry

EXACT = "analytic"  # Name of the exact beam
MEAN = "mean"  # Name of the mean of the models below and above the exact frequencies


def _problem_of(model: object) -> str:
    if not (isinstance(model, type) and issubclass(model, BeamModel)):
        return "is not a subclass of verify.linear.base.BeamModel: derive it"
    return "bounds the exact frequencies, as two models of the package do: leave `bounds` out" if model.bounds else ""


MODELS: Registry[type[BeamModel]] = Registry(
    "model",
    "verify.models",
    homes={
        EXACT: "verify.analytic_modes:ExactModel",
        "segment": "verify.segment_model:SegmentModel",
        "fem": "verify.fem_beam:HermiteModel",
    },
    refuses=_problem_of,
)
"""Classes; `MODELS.named(name).build(beam, count, **settings)` is the model of a beam."""


def discrete(verb: str = "modes", beam: Beam | None = None) -> tuple[type[BeamModel], ...]:
    """Discrete models that implement a method; with a beam, without models of other packages that cannot solve it."""
    able = (model for model in MODELS.values() if model.sized and model.can(verb))
    return tuple(model for model in able if beam is None or model.name in MODELS.built_in or _solves(model, beam))


def _solves(model: type[BeamModel], beam: Beam) -> bool:
    try:
        model.build(beam, max(model.fewest, len(beam.pieces)))
    except InputError:
        return False
    return True


def bounding() -> tuple[type[BeamModel], type[BeamModel]]:
    """The model below the exact frequencies, and the one above."""
    sides = {MODELS[name].bounds: MODELS[name] for name in MODELS.built_in}
    return sides["below"], sides["above"]
