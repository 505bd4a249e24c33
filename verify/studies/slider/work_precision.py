"""Run time against error of a slider's displacement: segments and elements with the same contact code."""

from math import log, pi
from statistics import median
from time import process_time
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.judge.compare import check_reference, relative_error
from verify.judge.crossing import ABOVE_FLOOR, ASTRAY, at_error, too_few
from verify.models.catalogue import bounding, discrete
from verify.motion.figures import felt_in_words, left_in_words
from verify.motion.stepping import slider_seconds
from verify.patience import check_work
from verify.quantities.motion_arguments import SliderInTime
from verify.quantities.simulated import MODES, motion_case, slider_of
from verify.studies.kind import Progress
from verify.studies.slider.request import EXACT, ROUNDS
from verify.studies.told import Found, Table
from verify.timing import forget, spread
from verify.units import time_in_words

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.motion.result import Motion
    from verify.scenes.scene import Scene

WINDOW_S = 3e-5
"""Of one mode of a beam that is not uniform, in one window around the slider."""
NO_ERROR = 1e-14
"""Relative: errors up to that are none, and fall at no order."""
AGREED = 0.6
"""Spread of a ratio of times from which on repetitions do not agree on it."""


class WorkRow(msgspec.Struct, frozen=True, kw_only=True):
    """One model at one size."""

    model: str
    count: int
    rows: int
    """Modes that are advanced in every step."""
    displacement: float
    error: float
    """Relative to the exact beam at the same step."""
    order: float | None
    """Observed from the size before; None at the first, and where an error is none or changes its sign."""
    run_ms_per_ms: float
    """Processor milliseconds of the compiled loop for a simulated millisecond, median of interleaved rounds."""
    set_up_ms: float
    """Of all else from scene to result: modes, tables, margins; nothing of it is kept from the round before."""
    run_spread: float = 0.0
    """Of the loop's time between the quartiles of the rounds, relative."""
    whole_spread: float = 0.0
    """The same of loop and set-up together."""


class Work(msgspec.Struct, frozen=True, kw_only=True):
    """Both models at every size, and what the step itself leaves."""

    rows: tuple[WorkRow, ...]
    step_floor: float
    """Relative change of the exact beam's displacement when the step is halved."""
    duration: float
    """Of the motion, seconds."""
    orders: dict[str, int]
    """At which the errors of each model fall on the beam, as theory has it; without those of which nobody says it."""
    n_runs: int
    """Simulations that were done."""
    felt: str = ""
    """Why the beam feels the scene's own slider, in words; empty where it does not, as in these runs."""
    left: str = ""
    """That the exact beam's run ended before its time, in words; empty where it did not."""


class WorkFound(Found, frozen=True, eq=False, kw_only=True):
    """Run time against error alone."""

    work: Work

    def tables(self) -> tuple[Table, ...]:
        """The one."""
        from verify.studies.slider.tables import work_table

        return (work_table(self.work),)

    def facts(self) -> tuple[str, ...]:
        """Both models at one error, or why they are not compared."""
        return (answer_in_words(at_equal_error(self.work)),)

    def records(self) -> list[dict[str, Any]]:
        """Rows with one level of names."""
        return [msgspec.to_builtins(row) for row in self.work.rows]

    def plain(self) -> dict[str, Any]:
        """Rows, and both models at one error or why they are not compared."""
        answer = at_equal_error(self.work)
        plain: dict[str, Any] = msgspec.to_builtins(answer)
        if isinstance(answer, Comparison):
            plain |= {"ratio": answer.ratio, "whole_ratio": answer.whole_ratio}
        return {"work": self.records(), "step_floor": self.work.step_floor, "answer": plain}


class Timed(msgspec.Struct, frozen=True, kw_only=True):
    """One run, and what it took of the processor."""

    found: "Motion"
    whole_s: float
    """From scene to result."""

    @property
    def loop_s(self) -> float:
        """Of the compiled loop, in its one thread."""
        return self.found.statistics.loop_s


class Cost(msgspec.Struct, frozen=True, kw_only=True):
    """What one model costs at an error."""

    run_ms_per_ms: float
    set_up_ms: float
    run_spread: float
    """The larger of the two sizes that it lies between, relative."""
    whole_spread: float


class Comparison(msgspec.Struct, frozen=True, kw_only=True):
    """Segments against elements at one error."""

    error: float
    segment: Cost
    fem: Cost
    duration: float
    """Of the motion, seconds."""

    @property
    def ratio(self) -> float:
        """How many times longer the elements take in the loop."""
        return self.fem.run_ms_per_ms / self.segment.run_ms_per_ms

    @property
    def whole_ratio(self) -> float:
        """The same for the whole run, set-up included."""
        return self._whole(self.fem) / self._whole(self.segment)

    @property
    def spread(self) -> float:
        """Of `ratio`, relative."""
        return self.fem.run_spread + self.segment.run_spread

    @property
    def whole_spread(self) -> float:
        """Of `whole_ratio`, relative."""
        return self.fem.whole_spread + self.segment.whole_spread

    def _whole(self, cost: Cost) -> float:
        return cost.set_up_ms + 1e3 * self.duration * cost.run_ms_per_ms


class NotCompared(msgspec.Struct, frozen=True, kw_only=True):
    """Why times stand for nothing, and what to change."""

    why: str
    remedy: str


def work_of(scene: "Scene", counts: tuple[int, ...], progress: Progress = lambda step: None) -> Work:
    """Both models at every size; the exact beam is the reference. Raises InputError."""
    _check_rounds(scene, counts)
    found_exact, floor = _exact_run(scene)
    exact = found_exact.displacement
    check_reference(exact)
    cases = [(model.name, n) for model in discrete("time_basis", scene.beam) for n in sorted(set(counts))]
    runs: dict[tuple[str, int], list[Timed]] = {case: [] for case in cases}
    for number in range(ROUNDS):
        progress(f"slider, work against error, round {number + 1}")
        for model, n in cases:
            runs[model, n].append(_timed(scene, model, n))
    assert scene.motion is not None
    rows: list[WorkRow] = []
    for (model, n), found in runs.items():
        before = rows[-1] if rows and rows[-1].model == model else None
        rows.append(_row(model, n, found, exact, before))
    n_runs = EXACT + ROUNDS * len(cases)
    assert scene.slider is not None
    assert found_exact.coupling is not None
    return Work(
        rows=tuple(rows),
        step_floor=floor,
        duration=scene.motion.duration,
        orders={model.name: due for model in bounding() if (due := model.order(scene.beam))},
        n_runs=n_runs,
        felt=felt_in_words(scene.slider.coupling, found_exact.coupling),
        left=left_in_words(found_exact, scene.motion.duration),
    )


def _check_rounds(scene: "Scene", counts: tuple[int, ...]) -> None:
    """Raise InputError where all rounds together would take too long."""
    assert scene.motion is not None
    assert scene.drive is not None
    steps = scene.motion.duration * scene.drive.frequency_hz * scene.motion.steps_per_period
    rounds = 2.0 * ROUNDS * sum(slider_seconds(steps, 3 * n, two_way=False) for n in counts)
    exact = (1 + 2) * slider_seconds(steps, MODES, two_way=False) + EXACT * _windows_seconds(scene)
    if exact > rounds:
        check_work("motion.duration", scene.motion.duration, rounds + exact, "shorten it")
    check_work("motion.counts", list(counts), rounds + exact, "give fewer or smaller ones, or a shorter duration")


def _windows_seconds(scene: "Scene") -> float:
    """An estimate from above of the shapes that one exact run reads on its way; nothing of a uniform beam's.

    Friction alone moves the slider from rest, by mu N / m at most: it comes into so many cells of 0.4 wavenumbers of
    the fastest mode, in each of which all modes are carried along their spans.
    """
    slider, motion, beam = scene.slider, scene.motion, scene.beam
    assert motion is not None
    if slider is None or beam.uniform:
        return 0.0
    way = slider.speed * motion.duration + 0.5 * slider.mu * slider.normal_force / slider.mass * motion.duration**2
    cells = 1.0 + MODES * pi / 0.4 * min(abs(way) / beam.length, 1.0)
    return cells * MODES * WINDOW_S


def exact_way(scene: "Scene") -> tuple[float, float]:
    """The exact beam's displacement, and by what share half the step changes it. Raises InputError where it is none."""
    found, floor = _exact_run(scene)
    return found.displacement, floor


def _exact_run(scene: "Scene") -> "tuple[Motion, float]":
    """The slider on the exact beam, and by what share half the step changes its displacement. Raises InputError."""
    assert scene.motion is not None
    finer = replace(scene.motion, steps_per_period=2 * scene.motion.steps_per_period)
    found, closer = (
        run_once(one, "analytic", None, coupling="one-way") for one in (scene, replace(scene.bare, motion=finer))
    )
    if found.displacement == 0.0:
        if left := left_in_words(found, scene.motion.duration):
            raise InputError(f"{left}: no error can be relative to that, shorten motion.duration or start it elsewhere")
        raise InputError("the slider does not move on the exact beam: no error can be relative to that, drive it")
    return found, abs(closer.displacement / found.displacement - 1.0)


def run_once(
    scene: "Scene",
    model: str,
    count: int | None,
    *,
    ledger: bool = False,
    samples: int = 2,
    coupling: str | None = None,
    at: "Sequence[float]" = (),
) -> "Motion":
    """The scene's slider on one model, coupled as it says unless told otherwise; the deflection kept `at` places."""
    a = SliderInTime(model=model, count=count, coupling=coupling)  # type: ignore[arg-type]
    per_period = scene.motion.steps_per_period if scene.motion else 64
    found = motion_case(a, scene).run(
        slider=slider_of(a, scene), steps_per_period=per_period, samples=samples, ledger=ledger, patient=False, at=at
    )
    if found.statistics.interrupted:
        raise KeyboardInterrupt
    return found


def _timed(scene: "Scene", model: str, count: int) -> Timed:
    """A run of which nothing was solved before."""
    forget()
    began = process_time()
    found = run_once(scene, model, count, coupling="one-way")
    return Timed(found=found, whole_s=process_time() - began)


def _row(model: str, count: int, times: list[Timed], exact: float, before: WorkRow | None) -> WorkRow:
    found, loops = times[0].found, [one.loop_s for one in times]
    error = relative_error(found.displacement, exact)
    loop, whole = median(loops), median(one.whole_s for one in times)
    return WorkRow(
        model=model,
        count=count,
        rows=len(found.end.q),
        displacement=found.displacement,
        error=error,
        order=log(before.error / error) / log(count / before.count) if before and before.error * error > 0 else None,
        run_ms_per_ms=loop / found.duration,
        set_up_ms=1e3 * max(whole - loop, 0.0),
        run_spread=spread(loops) / loop if loop else 0.0,
        whole_spread=spread([one.whole_s for one in times]) / whole if whole else 0.0,
    )


def at_equal_error(work: Work) -> Comparison | NotCompared:
    """Both models at the smallest error that both reach, by logarithms, where errors fall at their order."""
    if work.felt:
        return NotCompared(
            why=f"the beam feels the scene's own slider ({work.felt}), and these runs are of one that it does not",
            remedy="give slider.coupling = 'one-way' to ask for that",
        )
    if work.left:
        return NotCompared(why=work.left, remedy="give a shorter motion.duration, or start it elsewhere")
    both = bounding()
    lines = {model.name: [row for row in work.rows if row.model == model.name] for model in both}
    unfit = (_unfit(model.parts, lines[model.name], work, work.orders.get(model.name)) for model in both)
    problem = next((found for found in unfit if found), None)
    if problem is not None:
        return problem
    spans = [(abs(line[-1].error), abs(line[0].error)) for line in lines.values()]
    error = max(low for low, _ in spans)
    if error > min(high for _, high in spans):
        words = ", ".join(
            f"{name} {100 * low:.3g} to {100 * high:.3g} %"
            for name, (low, high) in zip((model.parts for model in both), spans, strict=True)
        )
        return NotCompared(why=f"the models share no error ({words})", remedy="give counts that overlap in error")
    segment, fem = (_cost_at(line, error) for line in lines.values())
    found = Comparison(error=error, segment=segment, fem=fem, duration=work.duration)
    apart = max(found.spread, found.whole_spread)
    if apart > AGREED:
        return NotCompared(
            why=f"repetitions of one run lie {100 * apart:.0f} % apart", remedy="run it again while the machine is idle"
        )
    return found


def _unfit(name: str, line: list[WorkRow], work: Work, due: int | None) -> NotCompared | None:
    """Why the errors of one model do not fall at the order that is due; None where they do."""
    if len(line) < 3:
        return NotCompared(why=too_few(len(line)), remedy="give three counts or more")
    if not all(row.run_ms_per_ms and row.set_up_ms for row in line):
        return NotCompared(why=f"a time of {name} is below the resolution of the clock", remedy="give larger counts")
    low, high = min(row.error for row in line), max(row.error for row in line)
    if max(-low, high) <= NO_ERROR:
        why = f"{name} are right to rounding at every count, the wave hardly moves the slider"
        return NotCompared(why=why, remedy="give it less speed, more mu or another position")
    span = f"between {100 * low:+.3g} % and {100 * high:+.3g} %"
    calmer = "give a longer soft start, a smaller slope K or a finer step (steps_per_period), or larger counts"
    if low <= 0.0 <= high:
        return NotCompared(why=f"errors of {name} jump {span}", remedy=calmer)
    least, floor = abs(line[-1].error), work.step_floor
    if least < ABOVE_FLOOR * floor:
        return NotCompared(
            why=f"errors of {name} down to {100 * least:.2g} % lie too near the {100 * floor:.2g} % by which half the "
            "step changes the exact beam's displacement",
            remedy="give a finer step (steps_per_period) or smaller counts",
        )
    return _astray(name, line, due, calmer, span)


def _astray(name: str, line: list[WorkRow], due: int | None, remedy: str, span: str) -> NotCompared | None:
    """Where errors fall at another order than the one that is due, or nobody knows that; None where they do."""
    if due is None:
        return NotCompared(why=f"nobody knows the order of the errors of {name}", remedy="compare their rows")
    orders = [row.order for row in line[1:] if row.order is not None]
    if not any(abs(order - due) > ASTRAY for order in orders):
        return None
    seen = ", ".join(f"{order:.1f}" for order in orders)
    return NotCompared(why=f"errors of {name} do not fall at order {due} but at {seen} ({span})", remedy=remedy)


def _cost_at(line: list[WorkRow], error: float) -> Cost:
    """Times at an error on the line through the two neighbours, in logarithms; errors fall along it."""
    errors = [abs(row.error) for row in line]

    def between(name: str) -> float:
        return at_error(errors, [getattr(row, name) for row in line], error)

    fine = next((i for i, own in enumerate(errors) if own <= error), len(line) - 1)
    pair = line[max(fine - 1, 0) : fine + 1]
    return Cost(
        run_ms_per_ms=between("run_ms_per_ms"),
        set_up_ms=between("set_up_ms"),
        run_spread=max(row.run_spread for row in pair),
        whole_spread=max(row.whole_spread for row in pair),
    )


def answer_in_words(answer: "Comparison | NotCompared") -> str:
    """Both models at one error, loop and set-up; or why nothing is compared, and what to change."""
    if isinstance(answer, NotCompared):
        return f"run times at equal error are not compared: {answer.why}; {answer.remedy}"
    fem, segment = answer.fem, answer.segment
    return (
        f"on a beam that does not feel its slider, at an error of {100 * answer.error:.3g} % of the displacement, "
        "Hermite elements take "
        f"{_times(answer.ratio, answer.spread)} as segments in the loop ({fem.run_ms_per_ms:.2g} and "
        f"{segment.run_ms_per_ms:.2g} ms for a simulated ms), {_times(answer.whole_ratio, answer.whole_spread)} for "
        f"the whole run of {time_in_words(answer.duration)}, with a set-up of {fem.set_up_ms:.2g} and "
        f"{segment.set_up_ms:.2g} ms (processor time in one thread)"
    )


def _times(ratio: float, spread: float) -> str:
    """'1.8 times (spread 12 %) as long'; no figure where they do not differ beyond the spread."""
    if abs(log(ratio)) <= spread:
        return f"within the spread of {100 * spread:.0f} % as long"
    return f"{ratio:.2g} times (spread {100 * spread:.0f} %) as long"
