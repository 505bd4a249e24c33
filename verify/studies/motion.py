"""The slider of a scene in time: displacement and velocity on three models, validity margins, errors over N."""

from math import log
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from msgspec import Meta

from verify.checks import Relative, check_number
from verify.errors import InputError
from verify.options import Start
from verify.studies.base import Progress, Study
from verify.studies.charts import model_style, percent, plot_errors, plot_lines, si
from verify.studies.convergence import Counts

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as MatplotlibFigure

    from verify.judge.cache import SolutionCache
    from verify.motion.result import Motion as Run
    from verify.report.result import Movie, Result, Table
    from verify.scene.model import Scene

STEPS_PER_PERIOD = 128
MOST_SAMPLES = 100_000
FRAMES = 96
SLIDER, FRICTION = "#d96c05", "#cc3f76"
LARGE = 0.1
"""Size of a neglected effect beyond which a summary is omitted."""
WARNINGS = {
    "lift-off": "Lift-off: the surface falls away with {:.3g} times the acceleration that weight and preload give the "
    "slider; a slider free to lift off leaves it, which this contact law forbids.",
    "coupling": "Coupling: the inertia of a slider held on the surface changes its motion by {:.1%}; a "
    "normal contact without it is not valid for such a slider.",
    "axial": "Nonlinearity: linear models neglect an axial inertia (kL)² ⟨θ²⟩ = {:.2g} of a chain of rigid links.",
    "step": "Time step: halving it changes the displacement by {:.1%}, not converged.",
}
ERRORS = "Against the exact beam at the same time step."
MOVIE = "Links are straight between their joints; bar: friction on the slider, relative to its largest value."
ENERGIES = {
    "work_in": "work of the forces",
    "kinetic": "kinetic energy of the beam",
    "elastic": "elastic energy of the beam",
    "damped": "dissipated in the beam",
    "rubbed": "dissipated by friction",
    "slider": "kinetic energy gained by the slider",
    "turned": "work of rotation and gravity on the slider",
    "contact_on_beam": "work of friction on the beam",
    "normal_on_beam": "work of the normal reaction on the beam",
    "residual": "imbalance",
}


class Motion(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The driven beam in time with the scene's slider; also the settings of quantities in time."""

    name: ClassVar[str] = "motion"
    title: ClassVar[str] = "The slider"

    duration: Annotated[float, Meta(description="Duration, s.")] = 1e-3
    start: Annotated[Start, Meta(description="State of the beam at the start: at rest or in its steady state.")] = (
        "rest"
    )
    soft_start_periods: Annotated[
        float | None,
        Meta(description="Periods over which the forces grow; 2 from rest unless set. 0 is a step load: cos(0) = 1."),
    ] = None
    modal_damping: Annotated[
        Relative | None, Meta(description="Damping ratio of every mode; from the beam's loss factor unless set.")
    ] = None
    count: Annotated[int, Meta(ge=1, description="Segments and elements.")] = 49
    counts: Annotated[Counts, Meta(description="Segments and elements of the errors over N.")] = (49, 98, 196)
    steps_per_period: Annotated[int, Meta(ge=1, description="Steps of the slider in a period, at least.")] = (
        STEPS_PER_PERIOD
    )
    samples: Annotated[int, Meta(ge=2, le=100_000, description="Stored instants, ends included.")] = 1001

    def __post_init__(self) -> None:
        check_number("motion.duration", self.duration, "seconds", above=0)
        if self.soft_start_periods is not None:
            check_number("motion.soft_start_periods", self.soft_start_periods, "periods", at_least=0)
        if self.modal_damping is not None:
            check_number("motion.modal_damping", self.modal_damping, "ratio", at_least=0, below=1)
        if self.start == "steady" and self.soft_start_periods:
            raise InputError(
                f"motion.soft_start_periods = {self.soft_start_periods!r} with start = 'steady': a steady beam has no "
                "start, leave it out"
            )

    @property
    def soft_start(self) -> float:
        """Periods over which the forces grow; 0 for a steady beam."""
        from verify.motion.starting import soft_start

        return soft_start(self.start, self.soft_start_periods)

    def check(self, scene: "Scene") -> None:
        """Raise InputError without forces, and for steps without a slider."""
        if not scene.forces or scene.drive is None or scene.drive.kind != "force":
            raise InputError("motion: a beam moves in time under a [drive] of kind force, add its forces")
        if scene.slider is None and self.steps_per_period != STEPS_PER_PERIOD:
            raise InputError(
                f"motion.steps_per_period = {self.steps_per_period!r} belongs to a slider: a beam alone takes no "
                "steps, leave it out or add [slider]"
            )

    def simulate(self, scene: "Scene", model: str, count: int | None, *, refine: int = 1, store: bool = False) -> "Run":
        """The scene's slider on one model. Raises InputError.

        `refine` divides the time step; `store` keeps every step, the deflection at the joints and the energy balance.
        """
        import numpy as np

        from verify.motion.simulate import simulate

        steps = self.duration * scene.drive.frequency_hz * self.steps_per_period
        run = simulate(
            scene.beam,
            scene.forces,
            scene.drive.frequency_hz,
            self.duration,
            model=model,
            count=count,
            start=self.start,
            soft_start_periods=self.soft_start,
            modal_damping=self.modal_damping,
            slider=scene.slider,
            at=np.linspace(0.0, scene.beam.length, (count or self.count) + 1).tolist() if store else (),
            samples=max(self.samples, int(min(steps, MOST_SAMPLES)) + 2) if store else 2,
            steps_per_period=refine * self.steps_per_period,
            ledger=store,
        )
        if run.statistics.interrupted:
            raise KeyboardInterrupt
        return run

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Simulate the slider on every model and at every size. Raises InputError."""
        from verify.exact.in_time import check_beam
        from verify.models.catalogue import MODELS, bounding, discrete
        from verify.report.result import Figure, Result

        check_beam(scene.beam, "leave [motion] out, whose runs are compared with the exact beam")
        models = [model.name for model in discrete("time_basis", scene.beam)]
        runs: dict[str, Run] = {}
        for model in ("analytic", *models):
            progress(f"slider on {MODELS[model].title}")
            count = self.count if MODELS[model].sized else None
            runs[model] = self.simulate(scene, model, count, store=True)
        errors, step_error = self._errors(scene, models, runs, progress)
        chain = runs[bounding()[0].name]
        warnings, valid = self._warnings(runs)
        speeds = ", ".join(f"{_title(run)} {100 * run.mean_speed:+.3g} cm/s" for run in runs.values())
        condition = f"{scene.slider.kinematics} kinematics, start {self.start}, {1e3 * self.duration:g} ms"
        time, size = ("time", "s"), f"N = {self.count}"
        paths = [(_title(run), run.times, run.travelled, model_style(run.model)) for run in runs.values()]
        forces = [(_title(run), run.times, run.friction, model_style(run.model)) for run in runs.values()]
        speed = [
            ("surface under the slider", chain.times, chain.surface_speed, {"color": "#7d8590"}),
            ("slider", chain.times, chain.speed, {"color": SLIDER}),
        ]
        return Result(
            summary=f"Mean speed of the slider ({condition}): {speeds}." if valid else "",
            tables=[*_tables(runs, chain), _error_table(errors, step_error)],
            figures=[
                Figure(
                    "slider-displacement",
                    f"Displacement of the slider, {size}",
                    "From its start, along +x.",
                    lambda ax: plot_lines(ax, paths, time, ("displacement", "m")),
                ),
                Figure(
                    "slider-velocity",
                    f"Velocity of the slider and of the surface under it, {_title(chain)}",
                    "Along +x.",
                    lambda ax: plot_lines(ax, speed, time, ("velocity", "m/s")),
                ),
                Figure(
                    "slider-friction",
                    f"Friction force on the slider, {size}",
                    "Along +x; its limit is mu N.",
                    lambda ax: plot_lines(ax, forces, time, ("friction force", "N")),
                ),
                *[
                    Figure(
                        "slider-errors", "Error of the displacement over N", ERRORS, lambda ax: _draw_errors(ax, errors)
                    )
                ]
                * bool(errors),
            ],
            movies=[_movie(chain)],
            warnings=warnings,
            data={"runs": {model: _plain(run) for model, run in runs.items()}, "errors": errors},
        )

    def _errors(
        self, scene: "Scene", models: list[str], runs: "dict[str, Run]", progress: Progress
    ) -> tuple[list[dict[str, Any]], float | None]:
        """(a row for each model and size, relative change of the exact displacement by half the step)."""
        exact = runs["analytic"].displacement
        if not exact or not all(run.statistics.finished for run in runs.values()):
            return [], None
        progress("slider on exact beam, half the step")
        step_error = abs(self.simulate(scene, "analytic", None, refine=2).displacement / exact - 1.0)
        rows: list[dict[str, Any]] = []
        for model in models:
            before: tuple[int, float] | None = None
            for count in sorted(set(self.counts)):
                progress(f"slider on {model}, N = {count}")
                displacement = self.simulate(scene, model, count).displacement
                error = displacement / exact - 1.0
                order = None
                if before and before[1] * error > 0.0:
                    order = log(before[1] / error) / log(count / before[0])
                row = {"model": model, "N": count, "displacement": displacement, "error": error, "order": order}
                rows.append(row)
                before = count, error
        return rows, step_error

    def _warnings(self, runs: "dict[str, Run]") -> tuple[list[str], bool]:
        """(what is not converged or outside its range of validity, whether the summary holds nevertheless)."""
        from verify.motion.contact import FELT
        from verify.motion.judged_step import KNOWN
        from verify.motion.validity import NONLINEAR

        warnings = [
            f"{_title(run)}: the slider {run.statistics.stopped}, after {1e3 * run.end.time:.4g} ms."
            for run in runs.values()
            if not run.statistics.finished
        ]
        stopped = bool(warnings)
        lift_off = max(run.margins.lift_off for run in runs.values())
        axial = max(run.margins.nonlinearity for run in runs.values())
        moved = max(run.statistics.moved or 0.0 for run in runs.values())
        one_way = [run.coupling for run in runs.values() if run.coupling and not run.coupling.pushes_back]
        normal = max((coupling.normal_size for coupling in one_way), default=0.0)
        limits = {"lift-off": (lift_off, 1.0), "coupling": (normal, FELT), "axial": (axial, NONLINEAR)}
        limits |= {"step": (moved, KNOWN)}
        warnings += [WARNINGS[key].format(value) for key, (value, limit) in limits.items() if value > limit]
        return warnings, not stopped and lift_off <= 1.0 and max(normal, axial) < LARGE and moved <= KNOWN


def _title(run: "Run") -> str:
    from verify.models.catalogue import MODELS

    return f"{run.count} {MODELS[run.model].title}" if run.count else MODELS[run.model].title


def _tables(runs: "dict[str, Run]", chain: "Run") -> "list[Table]":
    from verify.report.result import Column, Table

    exact = runs["analytic"].displacement
    rows, validity = [], []
    for run in runs.values():
        error = run.displacement / exact - 1.0 if exact and run.model != "analytic" else None
        balance = run.ledger.residual / run.ledger.work_in if run.ledger and run.ledger.work_in else None
        own = (run.displacement, error, run.mean_speed, run.largest_friction, run.statistics.steps, balance)
        rows.append((_title(run), *own))
        coupling, margins = run.coupling, run.margins
        assert coupling is not None
        sizes = ("two-way" if coupling.two_way else "one-way", coupling.friction_size, coupling.normal_size)
        frequency = (margins.model_form, margins.discretisation)
        validity.append((_title(run), *sizes, margins.lift_off, margins.nonlinearity, *frequency))
    results = [Column("model"), si("displacement", "m", "+.5g"), percent("error", "+.3g")]
    results += [si("mean speed", "m/s", "+.5g"), si("largest friction", "N"), Column("steps")]
    results += [Column("energy imbalance", format=".1e")]
    limits = [Column("model"), Column("coupling"), Column("friction coupling", format=".1e")]
    limits += [Column("normal coupling", format=".1e"), Column("lift-off", format=".3g")]
    limits += [Column("(kL)² ⟨θ²⟩", format=".1e"), percent("theory", "+.3g"), percent("discretisation", "+.3g")]
    notes = [
        "Coupling: change of the surface's motion by full friction and by the inertia of the slider held on it.",
        "Lift-off: largest downward acceleration of the surface over that by weight and preload.",
        "Theory (Timoshenko) and discretisation: frequency error at the mode nearest to the drive.",
    ]
    energies = [(text, getattr(chain.ledger, key)) for key, text in ENERGIES.items()]
    return [
        Table("Slider on each model", results, rows),
        Table("Validity of these runs", limits, validity, notes),
        Table(f"Energy balance, {_title(chain)}", [Column("energy"), si("value", "J")], energies),
    ]


def _error_table(rows: list[dict[str, Any]], step_error: float | None) -> "Table":
    from verify.models.catalogue import MODELS
    from verify.report.result import Column, Table

    columns = [Column("model"), Column("N"), si("displacement", "m", "+.7g"), percent("error")]
    notes = [] if step_error is None else [f"Half the time step changes the exact value by {100 * step_error:.1g} %."]
    cells = [(MODELS[row["model"]].title, *list(row.values())[1:]) for row in rows]
    return Table("Displacement over N, against the exact beam", [*columns, Column("order", format=".2f")], cells, notes)


def _plain(run: "Run") -> dict[str, Any]:
    keys = ("displacement", "mean_speed", "largest_friction", "mean_friction", "mean_surface_speed")
    return {key: getattr(run, key) for key in (*keys, "coupling", "margins", "ledger", "statistics", "notes")}


def _draw_errors(ax: "Axes", rows: list[dict[str, Any]]) -> None:
    from verify.models.catalogue import MODELS

    lines = []
    for model in dict.fromkeys(row["model"] for row in rows):
        own = [row for row in rows if row["model"] == model]
        errors = [100 * row["error"] for row in own]
        lines.append((MODELS[model].title, model_style(model)["color"], "-o", [row["N"] for row in own], errors))
    plot_errors(ax, lines, "|error of the displacement|, %")


def _movie(run: "Run") -> "Movie":
    from verify.report.result import Movie

    def animate(figure: "MatplotlibFigure") -> "FuncAnimation":
        import numpy as np
        from matplotlib.animation import FuncAnimation

        from verify.units import unit_of, unit_over

        kept = np.unique(np.linspace(0, len(run.times) - 1, FRAMES).round().astype(int))
        ax, along = figure.subplots(), unit_of(float(run.points[-1]))
        up, time = unit_over([float(abs(run.deflection).max())]), unit_over([float(run.times[-1])], "s")
        x, friction = along.factor * run.points, run.friction / (float(abs(run.friction).max()) or 1.0)
        (links,) = ax.plot(x, 0.0 * x, "-o", markersize=3, label=_title(run), **model_style(run.model))
        (force,) = ax.plot([], [], color=FRICTION, linewidth=3.0, label="friction on the slider")
        (block,) = ax.plot([], [], "s", color=SLIDER, markersize=10, label="slider")
        top = 1.2 * up.factor * float(abs(run.deflection).max())
        ax.set(xlabel=f"x, {along.name}", ylabel=f"deflection, {up.name}", ylim=(-top, top))
        clock = ax.text(0.99, 0.02, "", transform=ax.transAxes, ha="right")
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=3)

        def update(k: int) -> list[Any]:
            place, height = (
                along.factor * run.position[k],
                float(np.interp(run.position[k], run.points, run.deflection[k])),
            )
            links.set_ydata(up.factor * run.deflection[k])
            force.set_data([place, place + 0.08 * x[-1] * friction[k]], [up.factor * height] * 2)
            block.set_data([place], [up.factor * height])
            clock.set_text(f"{time.factor * run.times[k]:.3f} {time.name}")
            return [links, force, block, clock]

        return FuncAnimation(figure, update, frames=kept.tolist(), interval=60)

    return Movie("slider-moving", f"The slider on the wave, {_title(run)}", MOVIE, animate)
