"""How many parts modes ask for by the error law, and which of several the most, before any is solved for."""

from typing import TYPE_CHECKING

from verify.exact.error_laws import LAWS, parts_from_here_on, smallest_count
from verify.models.catalogue import MODELS
from verify.models.eigen import solve_seconds
from verify.patience import check_work

if TYPE_CHECKING:
    from verify.beam import Beam

_PARTS = 3
"""The discrete dispersion's answers and the solved ones lie closer: none of 32 tried differed. Those of other laws, at
clamped and free ends, may lie apart by as many again."""


def count_guess(model: str, beam: "Beam", mode: int, error: float) -> int:
    """Where to begin: the error law's answer, on a stepped beam the fewest parts that have the mode."""
    if not beam.uniform or model not in LAWS:
        return smallest_count(beam, mode)
    return parts_from_here_on(model, beam, mode, error)


def demanding(model: str, beam: "Beam", guesses: dict[int, int], proven: bool) -> list[int]:
    """Those of the modes, with the law's answer for each, of which one may ask for the most; all but of a proven law.

    Raises InputError where two solves of each of them would take longer than is waited for.
    """
    least = max(guesses.values()) - _PARTS if proven else 0
    near = [mode for mode, guess in guesses.items() if guess >= least]
    unknowns = MODELS.named(model).unknowns
    seconds = sum(2.0 * solve_seconds(unknowns(beam, guesses[mode]), mode) for mode in near)
    check_work("mode", max(guesses), seconds, "ask for lower modes or a larger error")
    return near
