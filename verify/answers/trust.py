"""How far a model can be trusted."""

from verify.analysis.margins import beam_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import not_default
from verify.analysis.verdict import Verdict, verdict_of
from verify.blas import one_blas_thread
from verify.errors import InputError
from verify.linear.base import BeamModel
from verify.validation import check_integer, check_number, check_type


@one_blas_thread()
def verdict(model: BeamModel, *, mode: int | None = None, frequency_hz: float | None = None) -> Verdict:
    """How far a model of a beam can be trusted at a mode (from 1), or at a drive of a frequency, Hz: give one of them.

    The worst of discretisation, shear and rotary inertia, and bending across the width. `level` is "trusted",
    "conditional" or "not trusted", `headline` the sentence. Results have a `verdict` of their own. Raises InputError.
    """
    check_type("model", model, BeamModel)
    if (mode is None) == (frequency_hz is None):
        raise InputError("mode: give a mode or frequency_hz, one of the two")
    if frequency_hz is None:
        check_integer("mode", mode, 1)
    else:
        check_number("frequency_hz", frequency_hz, "hertz", above=0)
    settings = not_default({name: getattr(model, name) for name in model.settings()})
    sizes = [(model.name, model.count)]
    return verdict_of(
        beam_margins(SolutionCache(model.beam), sizes, mode=mode, frequency_hz=frequency_hz, settings=settings)
    )
