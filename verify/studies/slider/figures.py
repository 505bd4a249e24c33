"""The slider for a report: its run on three models, what bounds it, and run time against error."""

from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.models.catalogue import bounding, discrete
from verify.motion.figures import RUN_FIGURES, Condition, left_in_words
from verify.motion.result import Motion, Slid
from verify.scenes.claims import asks_for_turned
from verify.studies.chart import Chart
from verify.studies.conditions import condition_of
from verify.studies.kind import Progress
from verify.studies.slider.work_precision import (
    Comparison,
    NotCompared,
    Work,
    WorkFound,
    answer_in_words,
    at_equal_error,
    run_once,
    work_of,
)
from verify.studies.told import Found, Table
from verify.units import in_words, unit_over

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

MOST_SAMPLES = 100_000
DRIFT_S = 0.2
"""Seconds of steady wave, of which the last half counts: what the start adds once is over by then, or is told."""
DRIFT_PERIODS = 1000
"""At most as many: 0.2 s of a drive at megahertz would be another question, and hours."""
ALIKE = 0.02
"""Relative: the two halves of what counts are told apart where they differ by more."""


class Finding(msgspec.Struct, frozen=True, kw_only=True):
    """One figure of the slider, with how it was found. Nothing is judged."""

    what: str
    found: str


class SliderFound(Found, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of a slider."""

    runs: dict[str, Motion]
    """By model: segment, fem, analytic."""
    conditions: dict[str, Condition]
    figures: dict[str, dict[str, float]]
    """By model and quantity; empty where a run did not reach its end."""
    findings: tuple[Finding, ...]
    work: Work
    answer: Comparison | NotCompared
    count: int
    n_motions: int
    """Simulations that were done."""

    @property
    def subject(self) -> Motion:
        """The run on segments, which figures are about unless they say otherwise."""
        return self.runs[bounding()[0].name]

    @property
    def condition(self) -> Condition:
        """How that was run."""
        return self.conditions[bounding()[0].name]

    def in_short(self) -> str:
        """What was found first, with its condition."""
        first = next(iter(self.findings), None)
        return f"{first.what[:1].upper()}{first.what[1:]}: {first.found}." if first else ""

    def facts(self) -> tuple[str, ...]:
        """What was found, how far it can be believed, and what it costs."""
        margins = self.subject.margins
        believed = (
            f"margins of the run: acceleration over what presses the slider on {margins.lift_off:.3g}, "
            f"(kL)^2 <theta^2> {margins.nonlinearity:.1e}"
        )
        return (*(f"{one.what}: {one.found}" for one in self.findings), believed, answer_in_words(self.answer))

    def tables(self) -> tuple[Table, ...]:
        """How far the runs can be believed, and run time against error."""
        from verify.studies.slider.tables import margins_table, work_table

        return margins_table(self), work_table(self.work)

    def charts(self) -> tuple[Chart, ...]:
        """Way and force on every model, the surface under the slider, work against error."""
        from verify.studies.slider.charts import slider_charts

        return slider_charts(self)

    def plain(self) -> Any:
        """Displacements and margins by model, findings, work against error."""
        runs = {model: _run_as_plain(self, model) for model in self.runs}
        return {"runs": runs, "findings": msgspec.to_builtins(self.findings)} | WorkFound(work=self.work).plain()

    def records(self) -> list[dict[str, Any]]:
        """Rows of the work against error."""
        return WorkFound(work=self.work).records()

    def motions(self) -> int:
        """All of them."""
        return self.n_motions


def _run_as_plain(study: SliderFound, model: str) -> dict[str, Any]:
    run = study.runs[model]
    return {
        "displacement": run.displacement,
        "mean_speed": run.mean_speed,
        "largest_friction": run.largest_friction,
        "condition": msgspec.to_builtins(study.conditions[model]),
        "figures": study.figures[model],
        "coupling": msgspec.to_builtins(run.coupling),
        "margins": msgspec.to_builtins(run.margins),
        "ledger": msgspec.to_builtins(run.ledger),
        "statistics": msgspec.to_builtins(run.statistics),
        "notes": list(run.notes),
    }


def slider_study(scene: "Scene", progress: Progress = lambda step: None) -> SliderFound:
    """Run the scene's slider on every model, and weigh work against error. Raises InputError."""
    asked = scene.motion
    assert asked is not None
    runs, conditions, figures = {}, {}, {}
    back = reversed_scene(scene) if asks_for_turned(scene.claim) else None
    models: dict[str, int | None] = {model.name: asked.count for model in discrete("time_basis", scene.beam)}
    for model, count in (models | {"analytic": None}).items():
        progress(f"slider on {model}")
        joints = places_of(scene, count) if model == bounding()[0].name else ()
        samples = max(asked.samples, every_step(scene))
        runs[model] = run_once(scene, model, count, ledger=True, samples=samples, at=joints)
        conditions[model] = condition_of(scene, model, count)
        turned = run_once(back, model, count) if back else None
        ended = all(one is None or one.statistics.stopped == "end" for one in (runs[model], turned))
        figures[model] = figures_of(runs[model], turned) if ended else {}
    progress("slider on the steady wave")
    drifts = [_drift(one) for one in (scene, reversed_scene(scene))]
    work = work_of(scene, asked.counts, progress)
    return SliderFound(
        runs=runs,
        conditions=conditions,
        figures=figures,
        findings=_findings(scene, runs, conditions, drifts),
        work=work,
        answer=at_equal_error(work),
        count=asked.count,
        n_motions=len(runs) * (2 if back else 1) + len(drifts) + work.n_runs,
    )


def places_of(scene: "Scene", count: int | None) -> list[float]:
    """Joints of a chain of equal links, (count + 1,), metres."""
    n = count or 1
    return [scene.beam.length * (k / n) for k in range(n + 1)]


def figures_of(run: Slid, back: Slid | None) -> dict[str, float]:
    """All figures of a run, those of the one turned round only where there is one."""
    return {name: one.of(run, back) for name, one in RUN_FIGURES.items() if back is not None or not one.turned}


def every_step(scene: "Scene") -> int:
    """Samples that keep every step of a run and shorten none; fewer of a long one."""
    assert scene.motion is not None
    assert scene.drive is not None
    steps = scene.motion.duration * scene.drive.frequency_hz * scene.motion.steps_per_period
    return int(min(steps, MOST_SAMPLES)) + 2


def reversed_scene(scene: "Scene") -> "Scene":
    """The same scene with every phase turned round, and with it the wave."""
    drive = scene.drive
    assert drive is not None
    forces = tuple(replace(f, phase_deg=-f.phase_deg) for f in drive.force)
    return replace(scene.bare, drive=replace(drive, force=forces))


def drift_seconds(scene: "Scene") -> float:
    """Of steady wave: DRIFT_S, or DRIFT_PERIODS of a fast drive, in four parts of whole periods."""
    assert scene.drive is not None
    frequency = scene.drive.frequency_hz
    return 4.0 * max(round(0.25 * min(DRIFT_S * frequency, DRIFT_PERIODS)), 1) / frequency


def _drift(scene: "Scene") -> str:
    """Mean speed on the exact beam's steady wave, which feels no slider; or why there is none.

    Over the last half of `drift_seconds`; where its own halves differ, that of the last with that of the one before.
    """
    asked = scene.motion
    assert asked is not None
    steady = replace(asked, start="steady", soft_start_periods=0.0, duration=drift_seconds(scene))
    run = run_once(replace(scene.bare, motion=steady), "analytic", None, coupling="one-way", samples=5)
    if run.statistics.stopped != "end":
        return f"none, the slider {run.statistics.stopped} after {run.end.time:.3g} s"
    *_, before, last = run.position[1:] - run.position[:-1]
    quarter = 0.25 * run.duration
    mean = 0.5 * (before + last) / quarter
    if abs(last - before) <= ALIKE * abs(before + last):
        return f"{1e6 * mean:+.4g} µm/s"
    return f"not settled, {1e6 * last / quarter:+.3g} µm/s after {1e6 * before / quarter:+.3g} µm/s"


def _findings(
    scene: "Scene", runs: dict[str, Motion], conditions: dict[str, Condition], drifts: list[str]
) -> tuple[Finding, ...]:
    subject = bounding()[0].name
    slider, chain, exact, how = scene.slider, runs[subject], runs["analytic"], conditions[subject]
    assert slider is not None
    coefficient = slider.mu if slider.mu_static is None else slider.mu_static
    limit = coefficient * slider.normal_force
    named = "mu N" if slider.mu_static is None else "mu_static N"
    way = unit_over((chain.displacement, exact.displacement))
    left = [words for run in (chain, exact) if (words := left_in_words(run, how.duration))]
    off = f", {100 * (chain.displacement / exact.displacement - 1):+.3g} % off it" if exact.displacement else ""
    return (
        Finding(
            what=f"mean speed ({how.run_words}, {how.force_words})",
            found=f"{100 * chain.mean_speed:+.3g} cm/s on {chain.count} segments, "
            f"{100 * exact.mean_speed:+.3g} cm/s on the exact beam",
        ),
        Finding(
            what="displacement in that run",
            found=f"{way.factor * chain.displacement:+.4g} {way.name} on {chain.count} segments, "
            f"{way.factor * exact.displacement:+.4g} {way.name} on the exact beam{off}",
        ),
        *([Finding(what="end of that run, until which these are", found="; ".join(left))] if left else []),
        Finding(
            what="largest friction in that run",
            found=f"{in_words(chain.largest_friction, 'N', '.4g')} of {named} = {in_words(limit, 'N', '.4g')}",
        ),
        Finding(
            what=f"mean speed over the last half of {drift_seconds(scene):.3g} s of steady wave ({how.kinematics}, "
            f"one-way, its inertia left out, exact beam), from {100.0 * slider.speed:g} cm/s; phases reversed",
            found="; ".join(drifts),
        ),
        _bound(slider.kinematics, named, limit / slider.mass, min(how.duration, chain.end.time), chain),
    )


def _bound(kinematics: str, named: str, pull: float, duration: float, chain: Motion) -> Finding:
    """What the law alone says of the speed: `pull` is the limit of friction, `named`, over m, m/s^2."""
    what = "what friction alone allows"
    fastest = float(abs(chain.speed - chain.speed[0]).max())
    if kinematics == "tangential":
        found = (
            f"tangential: the mean speed changes by at most {named} t / 2m = {50 * pull * duration:.3g} cm/s; "
            f"largest change of speed {100 * fastest:.3g} cm/s of {named} t / m = {100 * pull * duration:.3g} "
            "cm/s"
        )
    else:
        found = "following: no bound, the turning surface itself pushes the slider"
    return Finding(what=what, found=found)
