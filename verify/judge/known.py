"""How it is known that sizes beyond those that were solved keep an accuracy: by an error law that those kept to."""

from math import inf

from verify.errors import InputError
from verify.exact.error_laws import KEPT, KEPT_FROM, expected_error, has_law, is_kept
from verify.judge.cache import Settings, SolutionCache
from verify.judge.compare import ORDER_FLOOR
from verify.models.catalogue import MODELS

UNKNOWN = "neither larger nor smaller ones were looked through"


def kept(bench: SolutionCache, model: str, modes: range, count: int, does: dict[int, bool]) -> str:
    """That larger sizes do by the error law, where every size tried from here on keeps to it; empty where one does not.

    Which of its terms' sizes an error may differ by is counted in for those that were not tried (`certain_from`).
    """
    sizes = [n for n in does if n >= max(count, KEPT_FROM)]
    for n in sizes:
        found = {mode: bench.frequency_error(model, n, mode) for mode in modes}
        if not all(is_kept(model, bench.beam, mode, n, off, ORDER_FLOOR) for mode, off in found.items()):
            return ""
    return f"do by the error law, to which those from {sizes[0]} on keep within a third of its terms" if sizes else ""


def solved(count: int, does: dict[int, bool], beyond: str = "") -> str:
    """Which sizes from `count` on do, by what was solved, and what of larger ones: `beyond`, else that none was."""
    last = count
    while does.get(last + 1):
        last += 1
    end = max(does)
    one_by_one = f"all N from {count} to {last} do" * (last > count)
    tried = f"those tried up to {end}" * (end > last)
    said = f"{one_by_one}, and {tried}" if one_by_one and tried else one_by_one or f"{tried or f'N = {count}'} do"
    return f"{said}; larger ones {beyond or 'were not solved'}"


def by_law(bench: SolutionCache, model: str, mode: int, count: int) -> str:
    """What is said of larger sizes where a size was found next to the error law's answer alone."""
    if not has_law(bench.beam, mode, count):
        return UNKNOWN
    off = abs(bench.frequency_error(model, count, mode) / expected_error(model, bench.beam, mode, count) - 1.0)
    if off > KEPT:
        return UNKNOWN
    return f"every larger N does by the error law, {off:.1%} off here; smaller ones were not looked through"


def worst_of(bench: SolutionCache, model: str, modes: range, count: int, settings: Settings) -> int:
    """Which of the modes has the largest error at a size; the highest where the size has not all of them."""
    if len(modes) == 1:
        return modes[0]
    found = {mode: bench.error_or_why(model, count, mode, settings)[0] for mode in modes}
    return max(modes, key=lambda mode: (inf if (error := found[mode]) is None else abs(error), mode))


def largest_error(bench: SolutionCache, model: str, modes: range, count: int, settings: Settings) -> float:
    """The error, signed, of the mode that is furthest off at a size that has them all."""
    return bench.frequency_error(model, count, worst_of(bench, model, modes, count, settings), settings)


def unbuilt(bench: SolutionCache, model: str, settings: Settings, count: int, mode: int) -> str:
    """Why a model of so many parts is refused; empty where it is solved, or has not so many modes."""
    try:
        if MODELS.named(model).n_elastic(bench.beam, count, **dict(settings)) >= mode:
            bench.frequency_error(model, count, mode, settings)
    except InputError as refused:
        return str(refused)
    return ""
