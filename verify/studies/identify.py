"""Parameters of friction or of the beam, identified from data of a scene or from synthetic data, with intervals."""

from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import msgspec
import numpy as np
from msgspec import Meta

from verify.analysis.plausibility import unit_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, void
from verify.arrays import Array
from verify.dynamics.arguments import Keep
from verify.dynamics.simulate import simulate
from verify.errors import InputError
from verify.identify import beam, friction
from verify.identify.fit import Fit, Model, fit
from verify.quantities.slider import TimeOptions, motion_arguments
from verify.report.result import Column, Figure, Result, Table
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import line_chart, plot_lines
from verify.validation import check_number, unit

NOTES = (
    "Intervals of 95 %: lower and upper by Fisher information and Student's t (normal distribution for a known noise), "
    "and by profile likelihood, which has no end where the data do not bound the parameter.",
    "Noise: standard deviation, relative for frequencies and responses. Fit, white: probabilities of residuals that "
    "are larger, and more correlated, if the model holds.",
)
WHAT = "Speed of the slider in free decay, under a growing force, or on the driven beam; natural frequencies; "
WHAT += "receptance H."
PARAMETERS = [Column("parameter"), Column("value", format=".6g"), Column("unit"), Column("sd", format=".3g")]
PARAMETERS += [Column(name, format=".6g") for name in ("lower", "upper", "profile lower", "profile upper")]
PARAMETERS += [Column("verdict")]
TESTS = [Column(name, format=".3g") for name in ("noise", "degrees of freedom", "chi^2", "fit", "white")]
RESIDUALS = "Data less fit, over the standard deviation of the noise; 95 % lie within 2 if the model holds."
Sensor = Literal["displacement", "velocity", "acceleration"]
Noise = Annotated[float, Meta(gt=0, description="Standard deviation of the data, relative for frequencies and |H|.")]


class Synthetic(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Data of the model with normal noise."""

    noise: Noise
    """Standard deviation of the noise, in the unit of the data; relative for frequencies and |H|."""
    span: tuple[float, float]
    """First and last time, s, mode number, or frequency, Hz."""
    points: Annotated[int, Meta(ge=2, le=100_000)] = 200
    """Number of times or frequencies."""
    true: dict[str, float] = {}
    """True values by parameter; by default those of the scene."""
    seed: int = 0
    """Seed of the random numbers."""


class Identify(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A fit of parameters to data: `x` and `y`, a file, or synthetic."""

    name, title = "identify", "Identification"
    files = ("file",)

    what: Annotated[Literal["friction-decay", "breakaway", "run", "frequencies", "response"], Meta(description=WHAT)]
    parameters: Annotated[tuple[str, ...], Meta(min_length=1, description="Parameters to fit.")]
    start: Annotated[dict[str, float], Meta(description="Start, or fixed value; by default the scene's.")] = {}  # noqa: RUF012
    noise: Annotated[Noise | None, Meta(description="Standard deviation of the data; estimated unless set.")] = None
    x: Annotated[tuple[float, ...], Meta(description="Times, s, mode numbers, or frequencies, Hz.")] = ()
    y: Annotated[tuple[float, ...], Meta(description="Speeds, m/s, frequencies, Hz, or |H|, m/N.")] = ()
    file: Annotated[str | None, Meta(description="Columns x, y, for H also phase or re, im; or .uff.")] = None
    synthetic: Annotated[Synthetic | None, Meta(description="Data of the model with noise.")] = None
    force_rate: Annotated[float, unit("N/s"), Meta(gt=0, description="Growth of the force of a breakaway, N/s.")] = 1.0
    force_at: Annotated[float, unit("m"), Meta(ge=0, description="Position of the force of H, m.")] = 0.0
    sensor_at: Annotated[float, unit("m"), Meta(ge=0, description="Position of the sensor of H, m.")] = 0.0
    sensor: Annotated[Sensor, Meta(description="What the data of H divide by the force.")] = "displacement"
    model: Annotated[str, Meta(description="Model of the beam under a run.")] = "fem"
    count: Annotated[int, Meta(ge=1, description="Its size.")] | None = None
    profiles: Annotated[bool | None, Meta(description="Profiles; computed for wide intervals unless set.")] = None

    def check(self, scene: Scene) -> None:
        """Raise InputError for unknown parameters, missing or doubled data, and a scene without what they need."""
        if (bool(self.x or self.y), self.file is not None, self.synthetic is not None).count(True) != 1:
            raise InputError("identify: give x and y, or a file, or synthetic")
        if len(self.x) != len(self.y):
            raise InputError(f"identify.y has {len(self.y)} values and x {len(self.x)}: give as many")
        self.model_of(scene, np.array([1.0])).values({}, self.parameters)

    def model_of(self, scene: Scene, x: Array, phase: bool = True) -> Model:
        """The model at x (n,). Raises InputError."""
        names = (*self.parameters, *self.start, *(self.synthetic.true if self.synthetic else ()))
        if self.what == "frequencies":
            return beam.frequencies(scene.beam, names, x)
        if self.what == "response":
            for field, x_of in (("force_at", self.force_at), ("sensor_at", self.sensor_at)):
                check_number(f"identify.{field}", x_of, "metres, on the beam", at_most=scene.beam.length)
            return beam.response(scene.beam, names, x, self.force_at, self.sensor_at, phase=phase)
        if scene.slider is None:
            raise InputError("slider is missing: add [slider] with mass and mu to the scene")
        if self.what == "friction-decay":
            return friction.decay(scene.slider, x)
        if self.what == "breakaway":
            return friction.breakaway(scene.slider, x, self.force_rate)

        def simulated(slider: Any, until: float) -> Any:
            arguments = motion_arguments(scene, TimeOptions(model=self.model, count=self.count, time=until))
            samples = int(16.0 * until * arguments["excitation"].frequency_hz) + 2
            return simulate(**arguments, slider=slider, keep=Keep(samples=samples))

        return friction.run(scene.slider, names, x, simulated)

    def data(self, scene: Scene) -> tuple[Model, Array]:
        """(model, y of the model as measured). Raises InputError."""
        if (synthetic := self.synthetic) is not None:
            (low, high), modes = synthetic.span, self.what == "frequencies"
            x = np.arange(low, high + 0.5) if modes else np.linspace(low, high, synthetic.points)
            model = self.model_of(scene, x)
            exact = model.predict(model.values(synthetic.true))[0]
            noise = synthetic.noise * np.random.default_rng(synthetic.seed).standard_normal(len(exact))
            return model, exact + noise
        x, y, phase = np.array(self.x), np.array(self.y), None
        if self.file is not None:
            from verify.compare.reading import read_frequencies, read_series

            if self.what == "frequencies":
                listed = read_frequencies(Path(self.file))
                x, y = np.array(listed.numbers or range(1, len(listed.values) + 1)), listed.hertz
            else:
                x, y, phase = read_series(Path(self.file))
        if self.what == "response":  # without 0 Hz, where spectra begin
            x, y, phase = x[x != 0.0], y[x != 0.0], None if phase is None else phase[x != 0.0]
        if not np.isfinite([*x, *y, *(() if phase is None else phase)]).all() or (x < 0.0).any():
            raise InputError("identify: a value of x or y is not finite, or x is below zero, leave it out")
        model, order = self.model_of(scene, x, phase is not None), get_args(Sensor).index(self.sensor)
        if self.what != "response" and (phase is not None or order):
            raise InputError(f"identify.what = {self.what!r}: its data have no phase or sensor, leave these out")
        if model.logs and (y <= 0.0).any():
            raise InputError("identify.y: a frequency or |H| is not positive, leave it out")
        y = np.log(y / (2.0 * np.pi * x) ** order) if model.logs else y
        return model, y if phase is None else np.concatenate([y, phase - 0.5 * np.pi * order])

    def fitted(self, scene: Scene, cache: SolutionCache) -> tuple[Model, Array, Fit]:
        """(model, data, fit), computed once. Raises InputError."""

        def fitted() -> tuple[Model, Array, Fit]:
            model, data = self.data(scene)
            true = self.synthetic.true if self.synthetic else {}
            start = {name: value for name, value in true.items() if name not in self.parameters} | self.start
            return model, data, fit(model, data, self.parameters, start=start, noise=self.noise, profiles=self.profiles)

        return cache.once(("identify", msgspec.json.encode(self), scene.beam, scene.slider, scene.drive), fitted)

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Fit the parameters. Raises InputError."""
        progress(f"fit of {', '.join(self.parameters)}")
        model, data, result = self.fitted(scene, cache)
        margins = unit_margins(scene.beam) + [void("the fit", words, leads=True) for words in result.rejected]
        identified, rows = list[str](), list[list[Any]]()
        for estimate in result.estimates.values():
            name, half = estimate.name, 0.5 * (estimate.interval[1] - estimate.interval[0])
            if estimate.reason:
                margins.append(void(name, f"{name} is not identifiable, {estimate.reason}"))
            else:
                identified.append(f"{name} = {estimate.value:.6g} ± {half:.2g} {estimate.unit}".rstrip())
                size = half / abs(estimate.value)
                margins.append(Margin(name=f"95 % interval of {name}", size=size, fine=np.inf, limit=np.inf))
            sd, ends = estimate.sd if estimate.sd < np.inf else None, estimate.profile or (None, None)
            verdict = f"not identifiable: {estimate.reason}" if estimate.reason else "identified"
            rows.append([name, estimate.value, estimate.unit, sd, *estimate.interval, *ends, verdict])
        tests = [result.noise, result.freedom, result.chi2, result.fitness, result.whiteness]
        return Result(
            summary=f"{', '.join(identified)} (95 %)." if identified and not result.rejected else "",
            tables=[Table("Parameters", PARAMETERS, rows, NOTES), Table("Residuals", TESTS, [tests])],
            figures=self._figures(model, data, result),
            warnings=[f"{words[0].upper()}{words[1:]}." for words in result.rejected],
            data={"residuals": result.residuals},
            margins=margins,
        )

    def _figures(self, model: Model, data: Array, result: Fit) -> list[Figure]:
        x, n, points = model.x, len(model.x), {"linestyle": "None", "marker": "."}
        shown = [np.exp(values[:n]) if model.logs else values[:n] for values in (data, result.curve)]
        residuals = result.residuals.reshape(model.channels, -1) / result.noise
        channels = ("|H|", "phase") if model.channels > 1 else ("",)
        lines = [(name, x, channel, points) for name, channel in zip(channels, residuals, strict=True)]

        def draw(ax: Axes) -> None:
            measured = points | {"color": "#7d8590"}
            plot_lines(ax, [("data", x, shown[0], measured), ("fit", x, shown[1], {})], *model.labels)
            ax.set_yscale("log" if self.what == "response" else "linear")

        y = ("residual over its sd", "")
        return [
            Figure("identify-fit", "Data and fit", "Least squares.", draw),
            line_chart("identify-residuals", "Residuals", RESIDUALS, lines, model.labels[0], y),
        ]
