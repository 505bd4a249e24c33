"""Run time against error of a slider's displacement: segments and elements with the same contact code."""

from collections.abc import Callable
from math import exp, log
from statistics import median
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from verify.compare import check_reference, relative_error
from verify.motion_arguments import SliderInTime
from verify.motions import described, slider_of
from verify.patience import check_work
from verify.simulate import simulate
from verify.slider_run import slider_seconds

if TYPE_CHECKING:
    from verify.motion import Motion
    from verify.scene import Scene

ROUNDS = 7


class WorkRow(msgspec.Struct, frozen=True, kw_only=True):
    """One model at one size."""

    model: str
    count: int
    rows: int
    """Modes that are advanced in every step."""
    displacement: float
    error: float
    """Relative to the exact beam at the same step."""
    run_ms_per_ms: float
    """Wall milliseconds of the loop for a simulated millisecond, median of interleaved rounds."""
    set_up_ms: float


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """Segments against elements at one error."""

    error: float
    segment_ms_per_ms: float
    fem_ms_per_ms: float

    @property
    def ratio(self) -> float:
        """How many times longer the elements take."""
        return self.fem_ms_per_ms / self.segment_ms_per_ms


def work_rows(
    scene: "Scene", counts: tuple[int, ...], progress: Callable[[str], None] = lambda step: None
) -> tuple[WorkRow, ...]:
    """Both models at every size; the exact beam is the reference. Raises InputError."""
    _check_rounds(scene, counts)
    exact = run_once(scene, "analytic", None).displacement
    check_reference(exact)
    cases = [(model, n) for model in ("segment", "fem") for n in counts]
    runs: dict[tuple[str, int], list[Motion]] = {case: [] for case in cases}
    for number in range(ROUNDS):
        progress(f"slider, work against error, round {number + 1}")
        for model, n in cases:
            runs[model, n].append(run_once(scene, model, n))
    return tuple(_row(model, n, found, exact) for (model, n), found in runs.items())


def _check_rounds(scene: "Scene", counts: tuple[int, ...]) -> None:
    """Raise InputError where all rounds together would take too long."""
    assert scene.motion is not None
    assert scene.drive is not None
    steps = scene.motion.duration * scene.drive.frequency_hz * scene.motion.steps_per_period
    seconds = ROUNDS * sum(slider_seconds(steps, 3 * n, two_way=False) for n in counts)
    check_work("motion.counts", list(counts), 2.0 * seconds, "give fewer or smaller ones, or a shorter duration")


def run_once(scene: "Scene", model: str, count: int | None, ledger: bool = False, samples: int = 2) -> "Motion":
    """The scene's slider on one model, without its ledger unless asked for."""
    a = SliderInTime(model=model, count=count)  # type: ignore[arg-type]
    asked = described(a, scene)
    per_period = scene.motion.steps_per_period if scene.motion else 64
    slider = replace(slider_of(a, scene), coupling="one-way") if not ledger else slider_of(a, scene)
    return simulate(scene.beam, slider=slider, step=1.0 / (per_period * asked["frequency_hz"]), samples=samples,
                    ledger=ledger, patient=False, **asked)  # fmt: skip


def _row(model: str, count: int, found: "list[Motion]", exact: float) -> WorkRow:
    length = found[0].duration
    return WorkRow(
        model=model, count=count, rows=len(found[0].end.q), displacement=found[0].displacement,
        error=relative_error(found[0].displacement, exact),
        run_ms_per_ms=median(m.statistics.wall_s for m in found) / length,
        set_up_ms=1e3 * median(m.statistics.set_up_s for m in found),
    )  # fmt: skip


def at_equal_error(rows: tuple[WorkRow, ...]) -> Comparison | None:
    """Both models at the smallest error that both reach, interpolated in logarithms; None where they share none."""
    lines = {model: [r for r in rows if r.model == model and r.error] for model in ("segment", "fem")}
    spans = [(min(abs(r.error) for r in line), max(abs(r.error) for r in line)) for line in lines.values() if line]
    if len(spans) < 2 or max(low for low, _ in spans) > min(high for _, high in spans):
        return None
    error = max(low for low, _ in spans)
    times = {model: _time_at(line, error) for model, line in lines.items()}
    return Comparison(error=error, segment_ms_per_ms=times["segment"], fem_ms_per_ms=times["fem"])


def _time_at(line: list[WorkRow], error: float) -> float:
    """Run time at an error on the line through the two neighbours, in logarithms."""
    ordered = sorted(line, key=lambda r: abs(r.error))
    after = next((i for i, r in enumerate(ordered) if abs(r.error) >= error), len(ordered) - 1)
    a, b = ordered[max(after - 1, 0)], ordered[after]
    if a is b or a.error == b.error:
        return b.run_ms_per_ms
    part = log(error / abs(a.error)) / log(abs(b.error / a.error))
    return exp(log(a.run_ms_per_ms) + part * log(b.run_ms_per_ms / a.run_ms_per_ms))
