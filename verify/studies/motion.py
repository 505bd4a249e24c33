"""The slider of a scene in time: displacement, velocity, friction on every model, validity margins."""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
from msgspec import Meta
from msgspec.structs import replace

from verify.analysis.margins import against_exact, marked, run_margins, sufficient_count
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, verdict_of
from verify.analytic_modes import check_in_time
from verify.dynamics.arguments import Keep, Step
from verify.dynamics.result import Motion as Run
from verify.dynamics.simulate import simulate
from verify.dynamics.step_control import exchanged
from verify.errors import InputError
from verify.formatting import unit_over
from verify.linear.positions import SLACK
from verify.linear.registry import MODELS, bounding, discrete
from verify.problem.slider import Contact
from verify.quantities.slider import TimeOptions, motion_arguments
from verify.report.plotting import MovingLine
from verify.report.result import Column, Figure, Movie, Result, Table
from verify.settings import Start
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import Line, beam_movie, line_chart, model_style, percent, si, sized_title, table
from verify.studies.tables import reduction_margins, scene_margins
from verify.validation import Relative, check_number, unit

STEPS_PER_PERIOD = 128
MOST_SAMPLES = 100_000
FRAMES = 96
LONG = 10  # durations of a long run
TIME = ("time", "s")
KEYS = ["displacement", "mean_speed", "largest_friction", "mean_friction", "mean_surface_speed", "coupling", "margins"]
KEYS += ["energy", "statistics", "notes"]  # of a run, for JSON
SLIDER, FRICTION = "#d96c05", "#cc3f76"
GROWTH = "Periods over which the forces grow; 2 from rest unless set, 0 is a step load."
MOVIE = "Links are straight between their joints; bar: friction on the slider, relative to its largest value."


Damping = Annotated[Relative, Meta(description="Damping ratio of every mode; from the beam's loss factor unless set.")]


def check_start(table: str, start: Start, soft_start_periods: float | None) -> None:
    """Raise InputError for forces that grow in a steady beam."""
    if start == "steady" and soft_start_periods:
        raise InputError(f"{table}.soft_start_periods = {soft_start_periods!r}: a steady beam has no start, drop it")


def check_driven(table: str, scene: Scene) -> None:
    """Raise InputError for a scene without forces, and for a drive that has no equivalent in time."""
    if not scene.forces or scene.drive is None:
        raise InputError(f"{table}: a beam moves in time under a [drive] with forces, add them")
    scene.in_time(scene.forces, scene.drive.frequency_hz)


class Motion(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The driven beam in time with the scene's slider; also the settings of quantities in time."""

    name, title, accepts = "motion", "The slider", ("drive.shunt",)
    reads = ("drive", "slider", "motion")

    duration: Annotated[float, unit("s"), Meta(description="Duration, s.")] = 1e-3
    start: Annotated[Start, Meta(description="Beam at the start: at rest or in its steady state.")] = "rest"
    soft_start_periods: Annotated[float | None, Meta(description=GROWTH)] = None
    modal_damping: Damping | None = None
    count: Annotated[int, Meta(ge=1, description="Segments and elements; by default within 1 %.")] | None = None
    steps_per_period: Annotated[int, Meta(ge=1, description="Steps of the slider in a period, at least.")] = 128
    samples: Annotated[int, Meta(ge=2, le=100_000, description="Stored instants, ends included.")] = 1001

    def __post_init__(self) -> None:
        check_number("motion.duration", self.duration, "seconds", above=0)
        if self.soft_start_periods is not None:
            check_number("motion.soft_start_periods", self.soft_start_periods, "periods", at_least=0)
        if self.modal_damping is not None:
            check_number("motion.modal_damping", self.modal_damping, "ratio", at_least=0, below=1)
        check_start("motion", self.start, self.soft_start_periods)

    def check(self, scene: Scene) -> None:
        """Raise InputError without forces, and for steps without a slider."""
        check_driven("motion", scene)
        if scene.slider is None and self.steps_per_period != STEPS_PER_PERIOD:
            raise InputError(f"motion.steps_per_period = {self.steps_per_period!r}: only a slider takes steps, drop it")

    def size(self, scene: Scene, cache: SolutionCache) -> int:
        """Segments and elements: as given, or the fewest within 1 % at the drive. Raises InputError."""
        return self.count or sufficient_count(cache, frequency_hz=scene.drive.frequency_hz if scene.drive else None)

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Simulate the slider on every model. Raises InputError, also without a slider."""
        slider = scene.slider
        if slider is None:
            raise InputError("motion: its study moves a slider, add [slider], or measure a quantity in time")
        scene = replace(scene, studies={**scene.studies, "motion": self})
        assert scene.drive is not None
        count = self.size(scene, cache)
        steps = self.duration * scene.drive.frequency_hz * self.steps_per_period
        check_in_time(scene.beam, "leave [motion] out, whose runs are compared with the exact beam")
        # the springs and sections of actuators are beyond the exact beam in time
        exact = scene.in_time(scene.forces, scene.drive.frequency_hz).beam == scene.beam
        nodes = np.linspace(0.0, scene.beam.length, count + 1)
        runs: dict[str, Run] = {}
        for model in (*["analytic"] * exact, *(model.name for model in discrete("time_basis", scene.beam))):
            progress(f"slider on {MODELS[model].title}")
            runs[model] = simulate(
                **motion_arguments(scene, TimeOptions(model=model, count=count if MODELS[model].sized else None)),
                slider=slider,
                step=Step(per_period=self.steps_per_period),
                keep=Keep(at=nodes, samples=max(self.samples, int(min(steps, MOST_SAMPLES)) + 2)),
            )
        sizes = [(run.model, run.count) for run in runs.values()]
        titled, hertz = [(_title(run), run) for run in runs.values()], scene.drive.frequency_hz
        margins = scene_margins(scene, cache, sizes, slider=slider, frequency_hz=hertz, runs=titled)
        margins += reduction_margins(scene)
        if exact:
            true, near = runs["analytic"].displacement, SLACK * scene.beam.length
            displacements = [(_title(run), run.displacement) for run in runs.values()]
            margins += [against_exact("displacement", *moved, true, near) for moved in displacements]
        chain, valid = runs[bounding()[0].name], verdict_of(margins).level != "not trusted"
        speeds = ", ".join(f"{_title(run)} {100 * run.mean_speed:+.3g} cm/s" for run in runs.values())
        condition = f"{slider.kinematics} kinematics, start {self.start}, {1e3 * self.duration:g} ms"
        return Result(
            summary=f"Mean speed of the slider ({condition}): {speeds}." if valid else "",
            tables=[_table(runs), *([readings(scene)] if exact and slider.contact is None else [])],
            figures=_figures(runs, chain, count, margins),
            movies=[Movie("slider-moving", f"The slider on the wave, {_title(chain)}", MOVIE, _movie(chain))],
            data={"runs": {model: {key: getattr(run, key) for key in KEYS} for model, run in runs.items()}},
            margins=margins,
        )


def readings(scene: Scene) -> Table:
    """Mean speed of the one slider on the exact beam by every reading of it, with the margins of each.

    A point on the surface by both kinematics, a long run, and a contact that may open: the scene's, or a hard one.
    """
    assert scene.slider is not None
    mounted = scene.slider
    point = replace(mounted, contact=None, foot=(), external_force=0.0, preload_stiffness=0.0)
    opening = replace(point, kinematics="tangential", normal="bilateral", line="spline", contact=Contact())
    rows: list[tuple[Any, ...]] = []
    for name, assumption, slider, times in (
        ("tangential", "stays on the surface and moves along it alone", replace(point, kinematics="tangential"), 1),
        ("following", "stays on it and moves with it across the beam", replace(point, kinematics="following"), 1),
        (f"{mounted.kinematics}, long", "the same after its start", point, LONG),
        ("contact that opens", "lifts off and lands", mounted if mounted.contact else opening, LONG),
    ):
        duration = times * scene.motion.duration
        try:
            arguments = motion_arguments(scene, TimeOptions(model="analytic", time=duration))
            run = simulate(**arguments, slider=slider, keep=Keep(samples=2))
            verdict = verdict_of(run_margins(run, slider, "exact beam"))
            worst = verdict.margins[0].text if verdict.margins else ""
            rows.append((name, assumption, duration, run.mean_speed, verdict.level, worst))
        except InputError as error:
            hard = "two-way coupling with hard contact" if slider is opening and mounted.coupling == "two-way" else ""
            rows.append((name, assumption, duration, None, "not computed", hard or str(error)))
    columns = [Column("reading"), Column("the slider"), si("time", "s"), si("mean speed", "m/s", "+.4g")]
    valid = ", ".join(row[0] for row in rows if row[3] is not None and row[4] != "not trusted")
    note = f"Valid by its own margins: {valid or 'none'}. A mean over the start is not the speed of a motor."
    return Table("Speed of the slider", [*columns, Column("verdict"), Column("worst margin")], rows, [note])


def _figures(runs: dict[str, Run], chain: Run, count: int, margins: list[Margin]) -> list[Figure]:
    """Displacement and friction on each model; velocities of the slider and of the chain's surface."""
    surface = ("surface under the slider", chain.times, chain.surface_speed, {"color": "#7d8590"})
    velocities = [surface, ("slider", chain.times, chain.speed, {"color": SLIDER})]

    def each(figure: str) -> list[Line]:
        return [(_title(run), run.times, getattr(run, figure), model_style(run.model)) for run in runs.values()]

    return [
        line_chart(
            f"slider-{name.split(maxsplit=1)[0]}", marked(title, margins), "Along +x.", lines, TIME, (name, unit)
        )
        for name, unit, title, lines in (
            ("displacement", "m", f"Displacement of the slider, N = {count}", each("travelled")),
            ("velocity", "m/s", f"Velocity of the slider and the surface, {_title(chain)}", velocities),
            ("friction force", "N", f"Friction force on the slider, N = {count}", each("friction")),
        )
    ]


def _title(run: Run) -> str:
    return sized_title(run.model, run.count)


def _table(runs: dict[str, Run]) -> Table:
    exact, all_runs = runs["analytic"].displacement if "analytic" in runs else 0.0, runs.values()
    moves = any(abs(exact) > SLACK * run.end.beam.length for run in all_runs)

    def imbalance(run: Run) -> float | None:
        return abs(run.energy.residual) / exchanged(run) if run.energy and exchanged(run) else None

    results = {
        Column("model"): _title,
        si("displacement", "m", "+.5g"): lambda run: run.displacement,
        percent("error", "+.3g"): lambda run: (
            run.displacement / exact - 1.0 if moves and run.model != "analytic" else None
        ),
        si("mean speed", "m/s", "+.5g"): lambda run: run.mean_speed,
        si("largest friction", "N"): lambda run: run.largest_friction,
        Column("steps"): lambda run: run.statistics.steps,
        Column("energy imbalance", format=".1e"): imbalance,
    }
    return table("Slider on each model", all_runs, results)


def _movie(run: Run) -> Callable[[Axes], Any]:
    """The links with the slider on them, and the friction on it as a bar."""
    kept = np.unique(np.linspace(0, len(run.times) - 1, FRAMES).round().astype(int))
    time, length = unit_over([float(run.times[-1])], "s"), float(run.points[-1])
    place, deflection = run.position[kept, None], run.deflection[kept]
    height = np.array([np.interp(x, run.points, w) for x, w in zip(place, deflection, strict=True)])
    bar = 0.08 * length * run.friction[kept, None] / (float(abs(run.friction).max()) or 1.0)
    friction = {"color": FRICTION, "linewidth": 3.0, "label": "friction on the slider"}
    lines: list[MovingLine] = [
        (run.points, deflection, "-o", {"markersize": 3, "label": _title(run)} | model_style(run.model)),
        (np.hstack([place, place + bar]), np.hstack([height, height]), "-", friction),
        (place, height, "s", {"color": SLIDER, "markersize": 10, "label": "slider"}),
    ]
    texts = [f"{time.factor * t:.3f} {time.name}" for t in run.times[kept]]
    return beam_movie(lines, length, float(abs(run.deflection).max()), texts)
