"""The driven beam: standing-wave ratio and crest speed over N, envelope, surface ellipses, where to drive."""

import dataclasses
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

import msgspec
from msgspec import Meta

from verify.checks import Relative, check_number
from verify.errors import InputError, WindowError
from verify.models.naming import Among, model_meta
from verify.studies.base import Progress, Study
from verify.studies.convergence import Counts, size_axis

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as MatplotlibFigure

    from verify.judge.cache import SolutionCache
    from verify.models.fields import HarmonicField
    from verify.report.result import Figure, Result
    from verify.scene.model import Scene
    from verify.waves.case import DrivenCase
    from verify.waves.driven import Operation
    from verify.waves.operating_point import OperatingPoint

Span: TypeAlias = tuple[float, float, int]
Row: TypeAlias = dict[str, Any]
Fields: TypeAlias = "dict[str, HarmonicField]"
FRAMES = 36
LARGEST_RATIO = 10.0
"""Standing-wave ratio at which the map is cut off."""
SURFACE = "#cc3f76"


class Wave(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The steady wave of the scene's drive, measured in the window [L/4, 3L/4]."""

    name: ClassVar[str] = "wave"
    title: ClassVar[str] = "The driven beam"

    count: Annotated[int, Meta(ge=1, description="Segments and elements of envelopes, map and operating points.")] = 49
    counts: Annotated[Counts, Meta(description="Segments and elements of the errors over N.")] = (49, 98, 196)
    model: Annotated[str, model_meta("of the map and the operating points", "unit_responses")] = "segment"
    frequency_hz: Annotated[
        Span | None, Meta(description="Start, end and steps of the map, Hz; 10 % around the drive unless set.")
    ] = None
    phase_deg: Annotated[
        Span, Meta(description="Start, end and steps of the map: lead of the second force, degrees.")
    ] = (0.0, 180.0, 91)
    reflection_limit: Annotated[
        Relative, Meta(gt=0, lt=1, description="Largest reflection of the fastest operating point.")
    ] = 0.1
    operating_loss_factor: Annotated[
        Relative, Meta(gt=0, lt=1, description="Loss factor of map and operating points where the beam is undamped.")
    ] = 1e-3

    def __post_init__(self) -> None:
        for name in ("frequency_hz", "phase_deg"):
            start, end, steps = getattr(self, name) or (1.0, 2.0, 2)
            check_number(f"wave.{name}[0]", start, "start of the map", above=0.0 if name == "frequency_hz" else -3600.0)
            check_number(f"wave.{name}[1]", end, "end of the map", above=start)
            check_number(f"wave.{name}[2]", steps, "steps of the map", above=1, below=2001)

    def check(self, scene: "Scene") -> None:
        """Raise InputError without two forces, for a beam without waves, a window or a size that does not suit them."""
        from verify.models.catalogue import MODELS, discrete
        from verify.waves.measures import middle_half
        from verify.waves.window import check_window

        if len(scene.forces) != 2 or scene.drive is None:
            raise InputError("wave: the study needs a [drive] with two forces, add them")
        for verb in ("solve_harmonic", "unit_responses"):
            Among(verb).check(self.model, "wave.model")
        MODELS["analytic"].check(scene.beam, 1, 0)
        places, frequency = [force.position for force in scene.forces], scene.drive.frequency_hz
        try:
            check_window(scene.beam, places, frequency, middle_half(scene.beam))
        except WindowError as error:
            raise WindowError(
                f"wave: its window [L/4, 3L/4] does not suit this beam ({error}): leave [wave] out, and use gates with "
                "a window of their own"
            ) from None
        bare = msgspec.structs.replace(scene.beam, mass=(), spring=())
        for model in discrete("solve_harmonic", scene.beam) if bare.uniform else ():
            for count in self.counts:
                model.check_carried(bare, count, frequency)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Solve the fields of all models. Raises InputError."""
        from msgspec.structs import replace

        from verify.models.catalogue import MODELS, discrete
        from verify.report.result import Column, Result, Table
        from verify.waves.case import DrivenCase
        from verify.waves.driven import driven, measured_alone
        from verify.waves.operating_point import operating_points

        exact = DrivenCase(
            beam=scene.beam,
            model="analytic",
            count=None,
            forces=scene.forces,
            frequency_hz=scene.drive.frequency_hz,
            kind=scene.drive.kind,
        )
        models = [model.name for model in discrete("solve_harmonic", scene.beam)]
        rows: list[Row] = []
        for model, count in [("analytic", None), *((model, count) for model in models for count in self.counts)]:
            name = f"{count} {MODELS[model].title}" if count else MODELS[model].title
            progress(name)
            rows.append(
                {"name": name, "model": model, "N": count} | _waves(replace(exact, model=model, count=count), cache)
            )
        progress("operating points")
        beam = replace(scene.beam, loss_factor=scene.beam.loss_factor or self.operating_loss_factor)
        case = replace(exact, beam=beam, model=self.model, count=self.count if MODELS[self.model].sized else None)
        points, problems = operating_points(case, self.reflection_limit)
        fields = {"analytic": driven(exact, cache)}
        fields |= {model: driven(replace(exact, model=model, count=self.count), cache) for model in models}
        other = replace(exact, kind="displacement" if exact.kind == "force" else "force")
        ratio = measured_alone(driven(other, cache), None, "standing_wave_ratio")
        wave = [Column("SWR", format=".5g"), Column("axis ratio", format="+.5f")]
        wave += [Column("crest speed", "m/s", "+.5g", prefix=True)]
        best = [Column("best frequency", "Hz", ".2f"), *(dataclasses.replace(c, name=f"{c.name} there") for c in wave)]
        wave_table = Table(
            f"The wave over N, at {exact.frequency_hz:g} Hz and at each model's frequency of least reflection",
            [Column("model"), Column("N"), *wave, *best],
            [(MODELS[row["model"]].title, row["N"], *_cells(row["drive"])[1:], *_cells(row["best"])) for row in rows],
            [
                "SWR: standing-wave ratio in [L/4, 3L/4]. Axis ratio: mean over its whole half wavelengths.",
                f"With {other.kind}s of the same phases imposed the exact standing-wave ratio is {ratio:.5g}.",
            ],
        )
        at = [Column("operating point"), Column("frequency", "Hz", ".2f"), Column("phase", "°", ".2f")]
        at += [Column("reflection", format=".4f"), Column("crest speed", "m/s", "+.5g", prefix=True)]
        at += [Column("reflection per Hz", "1/Hz", ".2g"), Column("reflection per degree", "1/°", ".2g")]
        title = f"Where to drive, {MODELS[self.model].title}, loss factor {beam.loss_factor:g}"
        keys = ("frequency_hz", "phase_deg", "reflection", "crest_speed", "per_hertz", "per_degree")
        point_table = Table(title, at, [(_point_name(p), *(getattr(p, key) for key in keys)) for p in points])
        size = self.count if self.count in self.counts else max(self.counts)
        ratios = [f"{r['name']} {r['drive'].standing_wave_ratio:.5g}" for r in rows if r["N"] in (None, size)]
        return Result(
            summary=f"Standing-wave ratio at {exact.frequency_hz:g} Hz in [L/4, 3L/4]: {', '.join(ratios)}.",
            tables=[wave_table, point_table],
            figures=self._figures(rows, fields, case, points),
            movies=[_movie(fields, self.count)],
            warnings=[
                *(f"{row['name']}: {row['note']}." for row in rows if row["note"]),
                *(f"{_point_name(point)}: {point.note}." for point in points if point.note),
                *map(str, problems),
            ],
            data={"rows": rows, "points": points, "other_drive_standing_wave_ratio": ratio},
        )

    def _figures(
        self, rows: list[Row], fields: Fields, case: "DrivenCase", points: "tuple[OperatingPoint, ...]"
    ) -> "list[Figure]":
        from verify.report.result import Figure

        _, _, magnified, widest = _ellipses(fields["analytic"])
        return [
            Figure(
                "wave-envelopes",
                f"Envelope of the wave, N = {self.count}",
                "A pure travelling wave on one section without losses has a flat envelope; ripples are reflection. "
                "Near forces and ends the near field decays.",
                lambda ax: _draw_envelopes(ax, fields),
            ),
            Figure(
                "wave-ellipses",
                "Surface ellipses along the beam, exact field",
                f"To scale they are up to {widest:.3g} times as wide as high; motion along the beam is magnified "
                f"{magnified:.2g} times. Dots: t = 0.",
                lambda ax: _draw_ellipses(ax, fields["analytic"]),
            ),
            Figure(
                "wave-map",
                "Standing-wave ratio over frequency and phase",
                f"Window [L/4, 3L/4], loss factor {case.beam.loss_factor:g}, cut off at {LARGEST_RATIO:g}. Markers: "
                "operating points.",
                lambda ax: self._draw_map(ax, case, points),
            ),
            Figure(
                "wave-sizes",
                "Error of the standing-wave ratio over N",
                "Against the exact beam: solid at the drive's frequency, dotted each model at its own frequency of "
                "least reflection.",
                lambda ax: self._draw_sizes(ax, rows),
            ),
        ]

    def _draw_map(self, ax: "Axes", case: "DrivenCase", points: "tuple[OperatingPoint, ...]") -> None:
        import numpy as np

        from verify.waves.operating_point import landscape

        span = self.frequency_hz or (0.9 * case.frequency_hz, 1.1 * case.frequency_hz, 121)
        frequencies, phases = np.linspace(*span), np.linspace(*self.phase_deg)
        reflection, _ = landscape(case).over(frequencies, phases)
        ratio = (1.0 + reflection) / np.maximum(1.0 - reflection, 1e-12)
        mesh = ax.pcolormesh(frequencies, phases, np.minimum(ratio, LARGEST_RATIO).T, shading="nearest", cmap="viridis")
        ax.figure.colorbar(mesh, ax=ax, label="standing-wave ratio")
        for point, marker in zip(points, ("o", "*"), strict=False):
            ax.plot(
                point.frequency_hz, point.phase_deg, marker, color="#ff5a36", markersize=9, label=_point_name(point)
            )
        ax.set(xlabel="frequency, Hz", ylabel="phase of the second force, °", xlim=(span[0], span[1]))
        ax.grid(False)
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)

    def _draw_sizes(self, ax: "Axes", rows: list[Row]) -> None:
        from verify.models.catalogue import MODELS
        from verify.report.plotting import MODEL_COLORS

        for model in dict.fromkeys(row["model"] for row in rows[1:]):
            own = [row for row in rows if row["model"] == model]
            color, title = MODEL_COLORS.get(model, MODELS[model].colour), MODELS[model].title
            for key, style, text in (("drive", "-o", "at the drive"), ("best", ":o", "at its best frequency")):
                pairs = [(row["N"], row[key], rows[0][key]) for row in own]
                known = [(n, abs(a.standing_wave_ratio - b.standing_wave_ratio)) for n, a, b in pairs if a and b]
                if known:
                    ax.loglog(*zip(*known, strict=True), style, color=color, label=f"{title}, {text}")
        size_axis(ax, self.counts)
        ax.set_ylabel("|difference of the standing-wave ratio|")
        ax.legend()


def _waves(case: "DrivenCase", cache: "SolutionCache") -> Row:
    """The wave at the drive's frequency, and at the model's own frequency of least reflection if there is one."""
    from msgspec.structs import replace

    from verify.waves.driven import SEARCH_SPAN, driven, operation, quietest_drive
    from verify.waves.operating_point import edge_note

    row = {"drive": operation(driven(case, cache)), "best": None, "note": ""}
    try:
        found = quietest_drive(case, SEARCH_SPAN, None, cache)
    except InputError as error:
        return row | {"note": str(error)}
    if found.at_edge:
        return row | {"note": edge_note("the reflection falls off", found.x)}
    return row | {"best": operation(driven(replace(case, frequency_hz=found.x), cache))}


def _cells(one: "Operation | None") -> tuple[float | None, ...]:
    return (one.frequency_hz, one.standing_wave_ratio, one.axis_ratio, one.crest_speed) if one else (None,) * 4


def _point_name(point: "OperatingPoint") -> str:
    return "least reflection" if point.what.startswith("least") else "largest crest speed"


def _ellipses(field: "HarmonicField") -> tuple[Any, Any, float, float]:
    """Motion of 13 surface points of the middle half over one period.

    (x with the motion along the beam magnified so that neighbours do not touch, (13, FRAMES + 1), height likewise,
    metres, that magnification, largest true ratio of width to height).
    """
    import numpy as np

    from verify.waves.measures import lifted

    turn = np.exp(2j * np.pi * np.arange(FRAMES + 1) / FRAMES)
    places = np.linspace(0.25, 0.75, 13) * field.beam.length
    along = (lifted(field.beam, field.turn(places))[:, None] * turn).real
    up = (field.deflection(places)[:, None] * turn).real
    magnified = float(0.42 * (places[1] - places[0]) / abs(along).max())
    ratio = np.ptp(along, axis=1) / np.maximum(np.ptp(up, axis=1), 1e-300)
    return places[:, None] + magnified * along, up, magnified, float(ratio.max())


def _draw_envelopes(ax: "Axes", fields: Fields) -> None:
    import numpy as np

    from verify.models.catalogue import MODELS
    from verify.report.plotting import MODEL_COLORS
    from verify.units import unit_of, unit_over

    length = fields["analytic"].beam.length
    x = np.linspace(0.0, length, 601)
    lines = {model: abs(field.deflection(x)) for model, field in fields.items()}
    along, up = unit_of(length), unit_over(float(line.max()) for line in lines.values())
    for model, line in lines.items():
        color, width = MODEL_COLORS.get(model, MODELS[model].colour), 1.4 if MODELS[model].sized else 4.0
        ax.plot(along.factor * x, up.factor * line, color=color, linewidth=width, label=MODELS[model].title)
    ax.set(xlabel=f"x, {along.name}", ylabel=f"amplitude, {up.name}")
    ax.legend()


def _draw_ellipses(ax: "Axes", field: "HarmonicField") -> None:
    from verify.report.plotting import MODEL_COLORS
    from verify.units import unit_of, unit_over

    x, up, *_ = _ellipses(field)
    along, height = unit_of(field.beam.length), unit_over([float(abs(up).max())])
    ax.plot((along.factor * x).T, (height.factor * up).T, color=MODEL_COLORS["segment"])
    ax.plot(along.factor * x[:, 0], height.factor * up[:, 0], "o", color=SURFACE)
    ax.set(xlabel=f"x, {along.name}", ylabel=f"deflection, {height.name}")


def _movie(fields: Fields, count: int) -> Any:
    from verify.report.result import Movie

    def animate(figure: "MatplotlibFigure") -> "FuncAnimation":
        import numpy as np
        from matplotlib.animation import FuncAnimation

        from verify.models.catalogue import MODELS
        from verify.report.plotting import MODEL_COLORS
        from verify.units import unit_of, unit_over

        exact, ax = fields["analytic"], figure.subplots()
        x_surface, height, *_ = _ellipses(exact)
        places = {m: np.linspace(0.0, exact.beam.length, (count if MODELS[m].sized else 160) + 1) for m in fields}
        waves = {model: field.deflection(places[model]) for model, field in fields.items()}
        along, up = unit_of(exact.beam.length), unit_over(float(abs(wave).max()) for wave in waves.values())
        lines = {}
        for model in fields:
            style = {"analytic": "-", "segment": "-o"}.get(model, "x")
            color, width = MODEL_COLORS.get(model, MODELS[model].colour), 1.2 if MODELS[model].sized else 4.0
            (lines[model],) = ax.plot(
                along.factor * places[model], np.zeros(len(places[model])), style, color=color, linewidth=width
            )
            lines[model].set(label=MODELS[model].title, markersize=3.0)
        (points,) = ax.plot([], [], "o", color=SURFACE, label="surface points")
        top = 1.15 * max(up.factor * float(abs(wave).max()) for wave in waves.values())
        ax.set(xlabel=f"x, {along.name}", ylabel=f"deflection, {up.name}", ylim=(-top, top))
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)

        def update(frame: int) -> list[Any]:
            turn = np.exp(2j * np.pi * frame / FRAMES)
            for model, line in lines.items():
                line.set_ydata(up.factor * (waves[model] * turn).real)
            points.set_data(along.factor * x_surface[:, frame], up.factor * height[:, frame])
            return [*lines.values(), points]

        return FuncAnimation(figure, update, frames=FRAMES, interval=60)

    caption = (
        "One period of the drive. Links are straight between their joints. The motion of surface points along the beam "
        "is magnified as in the ellipses."
    )
    return Movie("wave-moving", f"The wave over one period, N = {count}", caption, animate)
