"""Charts of the slider."""

from typing import TYPE_CHECKING

from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Bars, Chart, Line
from verify.studies.charting import BROAD, GREY, model_line, plain_line, thinned
from verify.units import Unit, unit_of, unit_over

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.models.arrays import Array
    from verify.motion.result import Motion
    from verify.studies.slider.figures import SliderFound


SLIDER = "#2f80ed"


def slider_charts(study: "SliderFound") -> tuple[Chart, ...]:
    """Way and force on three models, the surface under the slider, the ride, the books, work against error."""
    from verify.studies.slider.movie import slider_movie

    charts = (_trajectory(study), _force(study), _speeds(study), *slider_movie(study), *_books(study))
    return (*charts, *([] if study.work.left else [_work(study)]), *_split(study))


SATURATES = {
    "tanh": "Friction is more than three quarters of mu N where slider and surface pass each other faster than 1/K",
    "coulomb": "Friction is mu N while the slider slips on the surface, and what holds it while it sticks",
}
"""By the law of friction, what is seen of its limit."""


def _how(study: "SliderFound") -> str:
    """Under which condition."""
    how = study.condition
    return f"{how.run_words}, {how.force_words}"


def _set_up(study: "SliderFound") -> str:
    """What is not on the axis: the time before the loop, from the least to the most."""
    spans = []
    for model in dict.fromkeys(row.model for row in study.work.rows):
        times = [row.set_up_ms for row in study.work.rows if row.model == model]
        spans.append(f"{min(times):.2g} to {max(times):.2g} ms for {MODELS[model].title}")
    return f"the set-up before the loop is not counted: {' and '.join(spans)}"


def _lines(study: "SliderFound", read: "Callable[[Motion], Array]", unit: Unit) -> tuple[Line, ...]:
    """One line for every model, in this unit, those without parts broad and first."""
    time, order = _time(study), sorted(study.runs, key=lambda name: MODELS[name].sized)
    return tuple(
        plain_line(
            MODELS[name].title,
            MODELS[name].colour,
            [time.factor * t for t in thinned(study.runs[name].times)],
            [unit.factor * v for v in thinned(read(study.runs[name]))],
            width=1.6 if MODELS[name].sized else BROAD,
        )
        for name in order
    )


def _time(study: "SliderFound") -> Unit:
    """Of the axis of time."""
    return unit_of(study.condition.duration, "s")


def _trajectory(study: "SliderFound") -> Chart:
    unit = unit_over(x for run in study.runs.values() for x in run.travelled.tolist())
    return Chart(
        id="slider-trajectory",
        title=f"Way of the slider, N = {study.count}",
        caption=f"Distance from the start, along +x: {_how(study)}.",
        x=Axis(f"time, {_time(study).name}"),
        y=Axis(f"distance, {unit.name}"),
        lines=_lines(study, lambda run: run.travelled, unit),
    )


def _force(study: "SliderFound") -> Chart:
    unit = unit_over((f for run in study.runs.values() for f in run.friction.tolist()), "N")
    return Chart(
        id="slider-force",
        title=f"Tangential force on the slider, N = {study.count}",
        caption=f"{SATURATES[study.condition.law]}: {_how(study)}.",
        x=Axis(f"time, {_time(study).name}"),
        y=Axis(f"force, {unit.name}"),
        lines=_lines(study, lambda run: run.friction, unit),
    )


def _speeds(study: "SliderFound") -> Chart:
    run = study.subject
    times = [_time(study).factor * t for t in thinned(run.times)]
    speeds = (("surface under the slider", run.surface_speed, GREY), ("slider", run.speed, SLIDER))
    return Chart(
        id="slider-speeds",
        title="Speed of the slider and of the surface under it, segments",
        caption=f"In the mean over the run the slider goes at {1e3 * run.mean_speed:+.4g} mm/s: {_how(study)}.",
        x=Axis(f"time, {_time(study).name}"),
        y=Axis("speed, mm/s"),
        lines=tuple(
            plain_line(name, colour, times, [1e3 * v for v in thinned(values)]) for name, values, colour in speeds
        ),
    )


def _books(study: "SliderFound") -> tuple[Chart, ...]:
    """Where the work of the forces went; nothing where it was not booked."""
    ledger = study.subject.ledger
    if ledger is None:
        return ()
    entries = {
        "work of the forces": ledger.work_in,
        "kinetic, beam": ledger.kinetic,
        "elastic, beam": ledger.elastic,
        "damped in the beam": ledger.damped,
        "rubbed off": ledger.rubbed,
        "gained by the slider": ledger.slider,
        "turning and gravity on the slider": ledger.turned,
        "friction on the beam": ledger.contact_on_beam,
        "normal reaction on the beam": ledger.normal_on_beam,
    }
    told = [("missed by the books", ledger.residual), *[one for one in entries.items() if one[1]][::-1]]
    unit = unit_over((value for _, value in told), "J")
    bars = Bars(
        names=tuple(name for name, _ in told),
        values=tuple(unit.factor * value for _, value in told),
        colours=(GREY, *[SLIDER] * (len(told) - 1)),
        words=tuple(f"{unit.factor * value:.3g}" for _, value in told),
    )
    return (
        Chart(
            id="slider-books",
            title=f"Where the energy went, N = {study.count}",
            caption="From the start of the run to its end, segments; kinetic and elastic are what is in the beam at "
            "the end, a sag under the slider that it had from the start with it. What the books miss is quadrature "
            f"over a step; under one-way coupling the beam is not charged with friction: {_how(study)}.",
            x=Axis(f"energy, {unit.name}"),
            y=Axis(""),
            bars=bars,
        ),
    )


def _split(study: "SliderFound") -> tuple[Chart, ...]:
    """Of the slider's displacement: what the division, the step and the linear model leave, each by itself."""
    rows = [row for row in study.work.rows if row.count == min(r.count for r in study.work.rows)]
    parts = {
        f"division, {row.count} {MODELS[row.model].title}": (abs(row.error), MODELS[row.model].colour) for row in rows
    }
    parts["time step, half the step"] = (study.work.step_floor, GREY)
    parts["axial inertia left out, (kL)² ⟨θ²⟩"] = (study.subject.margins.nonlinearity, "#9b6bdf")
    shown = [(name, size, colour) for name, (size, colour) in parts.items() if size > 0.0][::-1]
    return (
        Chart(
            id="slider-split",
            title="What the error of the slider's displacement is made of",
            caption="Division: against the exact beam. Time step: what half of it changes. Both of runs one-way, on a "
            "beam that does not feel the slider. Axial inertia: the number that says what a linear model leaves out of "
            f"a chain of rigid links: {_how(study)}.",
            x=Axis("relative", log=True),
            y=Axis(""),
            bars=Bars(
                names=tuple(name for name, _, _ in shown),
                values=tuple(size for _, size, _ in shown),
                colours=tuple(colour for _, _, colour in shown),
                words=tuple(f"{size:.1e}" for _, size, _ in shown),
            ),
        ),
    )


def _work(study: "SliderFound") -> Chart:
    lines = []
    for model in dict.fromkeys(row.model for row in study.work.rows):
        rows = [row for row in study.work.rows if row.model == model]
        sizes = tuple(str(r.count) for r in rows)
        errors = [abs(r.error) for r in rows]
        lines.append(model_line(model, errors, [r.run_ms_per_ms for r in rows], beside=sizes))
    return Chart(
        id="slider-work",
        title="Run time against the error of the slider's displacement",
        caption=f"The same contact code on all; sizes beside the points. Lower left is better; {_set_up(study)}.",
        x=Axis("error of the displacement against the exact beam", log=True),
        y=Axis("processor ms per simulated ms", log=True),
        lines=tuple(lines),
    )
