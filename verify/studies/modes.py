"""Figures over many modes or sizes: the error spectrum, convergence with run time, sensitivity to material."""

from collections.abc import Callable, Iterator
from math import log
from typing import TYPE_CHECKING

import msgspec

from verify.errors import InputError
from verify.exact.closed_forms import THEORIES, frequency_hz
from verify.judge.workbench import Workbench, model_module
from verify.patience import check_work
from verify.timing import interleaved_medians

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.scenes.scene import Convergence, Sensitivity, Spectrum

MODELS = ("segment", "fem")


class Cell(msgspec.Struct, frozen=True, kw_only=True):
    """One mode of one model at one size. None where the model has no such mode there."""

    frequency_hz: float | None = None
    error: float | None = None
    order: float | None = None
    """Observed between this size and the one before; None at the first and where rounding rules."""
    run_time_s: float | None = None
    """Median of warm repeats of the whole solve, set-up included, for all modes of the table up to the last."""


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """Both models at one size for one mode."""

    mode: int
    count: int
    exact_hz: float
    segment: Cell
    fem: Cell
    bracket_width: float | None
    """(upper - lower) / mean; None where there is no bracket."""
    mean_error: float | None
    """Error of the middle of the bracket."""
    notes: tuple[str, ...] = ()
    """Why a cell is empty."""


class SpectrumStudy(msgspec.Struct, frozen=True, kw_only=True):
    """Frequency and model-form errors over mode number at one size."""

    count: int
    modes: tuple[int, ...]
    segment: tuple[float | None, ...]
    fem: tuple[float | None, ...]
    theories: dict[str, tuple[float, ...]]
    """Errors of other beam theories against Euler-Bernoulli; empty where they have no closed form."""


class SensitivityStudy(msgspec.Struct, frozen=True, kw_only=True):
    """One exact frequency over modulus and density."""

    mode: int
    moduli: tuple[float, ...]
    densities: tuple[float, ...]
    frequencies_hz: tuple[tuple[float, ...], ...]
    """[density][modulus], Hz."""
    published_hz: float | None


def spectrum(bench: Workbench, asked: "Spectrum") -> SpectrumStudy:
    """Errors of modes 1..modes at one size. Raises InputError for a size that cannot be solved."""
    for model in MODELS:
        check_size(bench.beam, model, asked.count, asked.modes)
    modes = tuple(range(1, asked.modes + 1))
    errors = {m: tuple(_error(bench, m, asked.count, n)[0] for n in reversed(modes))[::-1] for m in MODELS}
    return SpectrumStudy(
        count=asked.count,
        modes=modes,
        segment=errors["segment"],
        fem=errors["fem"],
        theories=_theory_errors(bench.beam, modes),
    )


def _theory_errors(beam: "Beam", modes: tuple[int, ...]) -> dict[str, tuple[float, ...]]:
    if beam.supports != ("pinned", "pinned") or beam.stepped:
        return {}
    return {t: tuple(frequency_hz(beam, n, t) / frequency_hz(beam, n) - 1.0 for n in modes) for t in THEORIES[1:]}


def _error(bench: Workbench, model: str, count: int, mode: int) -> tuple[float | None, str]:
    """(signed frequency error, '') or (None, why there is none)."""
    try:
        return bench.frequency_error(model, count, mode), ""
    except InputError as error:
        return None, str(error)


def convergence(
    bench: Workbench, asked: "Convergence", progress: Callable[[str], None] = lambda step: None
) -> tuple[Row, ...]:
    """Rows by mode, then by size. `progress` is told the size about to be solved. Raises InputError."""
    for count in asked.counts:
        for model in MODELS:
            check_size(bench.beam, model, count, max(asked.modes))
    _check_together(bench.beam, asked.counts, max(asked.modes))
    seconds = {}
    for count in asked.counts:
        progress(f"{count} segments and elements")
        seconds[count] = _timed_pair(bench, count, max(asked.modes))
    rows: list[Row] = []
    for mode in asked.modes:
        previous: Row | None = None
        for count in asked.counts:
            previous = _row(bench, mode, count, seconds[count], previous)
            rows.append(previous)
    return tuple(rows)


def check_size(beam: "Beam", model: str, count: int, n_modes: int) -> None:
    """Raise InputError for a size that cannot be solved at all, before any work on it."""
    module = model_module(model)
    module.check(beam, max(min(n_modes, module.n_elastic(beam, count)), 1), count)


def _check_together(beam: "Beam", counts: tuple[int, ...], n_modes: int) -> None:
    """Raise InputError where all solves, each done and then timed, would take too long."""
    from verify.models.eigen import solve_seconds

    sizes = [(model_module(model), count) for count in counts for model in MODELS]
    seconds = sum(
        solve_seconds(module.unknowns(beam, n), min(n_modes, module.n_elastic(beam, n))) for module, n in sizes
    )
    check_work("counts", list(counts), 2.0 * seconds, "give fewer or smaller ones")


def _timed_pair(bench: Workbench, count: int, n_modes: int) -> dict[str, float]:
    """Seconds of a warm solve for each model, medians of rounds in which the models take turns."""
    solves = {}
    for model in MODELS:
        module = model_module(model)
        n = min(n_modes, module.n_elastic(bench.beam, count))
        solves[model] = lambda module=module, n=n: module.solve_modes(bench.beam, n, count)
        bench.modes(model, count, n)
    return dict(zip(MODELS, interleaved_medians(list(solves.values())), strict=True))


def _row(bench: Workbench, mode: int, count: int, seconds: dict[str, float], previous: Row | None) -> Row:
    cells, notes = {}, []
    for model in MODELS:
        before = getattr(previous, model) if previous else None
        cells[model], note = _cell(bench, model, mode, count, seconds[model], before, previous)
        notes += [note] if note else []
    width = mean_error = None
    try:
        found = bench.bracket(mode, count)
        width, mean_error = found.relative_width, bench.frequency_error("mean", count, mode)
    except InputError as error:
        notes += [str(error)] if not notes else []
    return Row(
        mode=mode,
        count=count,
        exact_hz=bench.exact_hz(mode),
        segment=cells["segment"],
        fem=cells["fem"],
        bracket_width=width,
        mean_error=mean_error,
        notes=tuple(notes),
    )


def _cell(
    bench: Workbench, model: str, mode: int, count: int, seconds: float, before: Cell | None, previous: Row | None
) -> tuple[Cell, str]:
    error, note = _error(bench, model, count, mode)
    if error is None:
        return Cell(), note
    order = _local_order(previous.count, before.error, count, error) if previous and before else None
    frequency = bench.paired_frequency_hz(model, count, mode)
    return Cell(frequency_hz=frequency, error=error, order=order, run_time_s=seconds), ""


def _local_order(count_1: int, error_1: float | None, count_2: int, error_2: float) -> float | None:
    """The order between two sizes; None where an error is rounding, changes sign or the sizes are equal."""
    from verify.judge.compare import ORDER_FLOOR

    if error_1 is None or count_1 == count_2 or error_1 * error_2 <= 0 or min(abs(error_1), abs(error_2)) < ORDER_FLOOR:
        return None
    return log(error_1 / error_2) / log(count_2 / count_1)


def sensitivity(beam: "Beam", asked: "Sensitivity", steps: int = 25) -> SensitivityStudy:
    """The exact frequency over modulus (`steps` values) for five densities around the scene's."""
    from msgspec import structs

    def spread(value: float, part: float, n: int) -> Iterator[float]:
        return (value * (1.0 + part * (2.0 * i / (n - 1) - 1.0)) for i in range(n))

    moduli = tuple(spread(beam.youngs_modulus, asked.modulus_spread, steps))
    densities = tuple(spread(beam.density, asked.density_spread, 5))
    table = tuple(
        tuple(frequency_hz(structs.replace(beam, youngs_modulus=e, density=rho), asked.mode) for e in moduli)
        for rho in densities
    )
    return SensitivityStudy(
        mode=asked.mode, moduli=moduli, densities=densities, frequencies_hz=table, published_hz=asked.published_hz
    )
