"""The driven beam: standing-wave ratio and crest speed over N, envelopes, surface ellipses."""

from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.margins import against_exact, beam_margins, marked, sufficient_count
from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError, WindowError
from verify.formatting import unit_of, unit_over
from verify.linear.registry import EXACT, MODELS, discrete
from verify.quantities.waves import FieldOptions, driven_case, measured
from verify.report.result import Column, Figure, Movie, Result, Table
from verify.studies.base import Progress, Study
from verify.studies.charts import model_style, plot_lines, si, sized_title
from verify.studies.convergence import Counts

if TYPE_CHECKING:
    from collections.abc import Callable

    from matplotlib.axes import Axes

    from verify.linear.field import HarmonicField
    from verify.scene.model import Scene
    from verify.travelling_wave import BestDrive, DrivenCase

Row: TypeAlias = dict[str, Any]
Fields: TypeAlias = "dict[str, HarmonicField]"
FRAMES, POINTS = 36, 13
SURFACE = "#cc3f76"
ENVELOPES = (
    "A pure travelling wave on one section without losses has a flat envelope; ripples are reflection. Near forces and "
    "ends the near field decays."
)
MOVIE = (
    "One period of the drive. Links are straight between their joints. The motion of surface points along the beam is "
    "magnified as in the ellipses."
)


class Wave(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The steady wave of the scene's drive, measured in the window [L/4, 3L/4]."""

    name: ClassVar[str] = "wave"
    title: ClassVar[str] = "The driven beam"

    count: Annotated[int, Meta(ge=1, description="Segments and elements; by default within 1 %.")] | None = None
    counts: Annotated[Counts, Meta(description="Of the errors over N; else 1, 2, 4 times count.")] | None = None

    def check(self, scene: "Scene") -> None:
        """Raise InputError without two forces, for a beam without waves, a window or a size that does not suit them."""
        from verify.waves.window import check_span, check_waves, middle_half

        if len(scene.forces) != 2 or scene.drive is None:
            raise InputError("wave: the study needs a [drive] with two forces, add them")
        case = driven_case(scene, FieldOptions())
        positions, frequency = [force.position for force in scene.forces], scene.drive.frequency_hz
        try:
            check_span(case.beam, [*positions, *case.places[0]], middle_half(case.beam), case.places[1])
            check_waves(scene.beam, frequency, middle_half(scene.beam))
        except WindowError as error:
            raise WindowError(
                f"wave: its window [L/4, 3L/4] does not suit this beam ({error}): use quantities or gates "
                "with a window of their own, and leave a section [wave] out"
            ) from None
        bare = msgspec.structs.replace(scene.beam, mass=(), spring=())
        for model in discrete("harmonic", scene.beam) if bare.uniform else ():
            for count in filter(None, (self.count, *(self.counts or ()))):
                model.build(bare, count).check_propagates(frequency)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Solve the fields of all models. Raises InputError."""
        import numpy as np
        from msgspec.structs import replace

        from verify.travelling_wave import best_drive
        from verify.waves.driven_case import driven

        drive = scene.drive
        assert drive is not None
        exact = driven_case(scene, FieldOptions())
        models = [model.name for model in discrete("harmonic", scene.beam)]
        n = self.count or sufficient_count(cache, frequency_hz=drive.frequency_hz)
        counts = self.counts or (n, 2 * n, 4 * n)
        rows: list[Row] = []
        for model, count in [(EXACT, None), *((model, count) for model in models for count in counts)]:
            row: Row = {"name": sized_title(model, count), "model": model, "N": count}
            progress(row["name"])
            rows.append(row | _waves(replace(exact, model=MODELS[model].build(exact.beam, count)), cache))
        fields = {EXACT: driven(exact, cache)}
        for model in models:
            fields[model] = driven(replace(exact, model=MODELS[model].build(exact.beam, n)), cache)
        other = replace(exact, kind="displacement" if exact.kind == "force" and not exact.shunts else "force")
        direction = -1 if rows[0]["drive"]["crest_speed"] > 0.0 else 1  # crests move against the wave
        against, best = measured(other, cache), best_drive(exact, direction=direction)
        ratio, end = against.standing_wave_ratio, {1: "+x", -1: "-x"}

        columns = [Column("model"), Column("N"), Column("SWR", format=".5g"), Column("axis ratio", format="+.5f")]
        columns += [si("crest speed", "m/s", "+.5g"), Column("best frequency", "Hz", ".2f")]
        columns += [Column("SWR there", format=".5g"), Column("axis ratio there", format="+.5f")]
        columns += [si("crest speed there", "m/s", "+.5g")]
        columns = columns if (better := any(row["best"] for row in rows)) else columns[:5]
        notes = [
            "SWR: standing-wave ratio in [L/4, 3L/4]. Axis ratio: mean over its whole half wavelengths. Crest speed: "
            "of the surface at the rms amplitude, against the wave."
            + " Right: at its own frequency of least reflection."
            * better,
            f"With {other.kind}s of the same phases imposed the exact standing-wave ratio is {ratio:.5g}, the stronger "
            f"wave towards {end[against.waves.direction]}.",
        ]
        cells = [(MODELS[r["model"]].title, r["N"], *_cells(r["drive"])[1:], *_cells(r["best"])) for r in rows]
        cells = [row[: len(columns)] for row in cells]
        size = n if n in counts else max(counts)
        margins = beam_margins(cache, [(m, n) for m in models], frequency_hz=drive.frequency_hz)
        swr = {row["name"]: row["drive"]["standing_wave_ratio"] for row in rows if row["N"] in (None, size)}
        exact_swr = rows[0]["drive"]["standing_wave_ratio"]
        margins += [against_exact("standing-wave ratio", *one, exact_swr) for one in swr.items()]
        ratios = [f"{name} {value:.5g}" for name, value in swr.items()]
        x, up, magnified, widest = ellipses(fields["analytic"])
        paths = [("", x[i], up[i], {"color": "#2f80ed"}) for i in range(POINTS)]
        start = ("", x[:, 0], up[:, 0], {"color": SURFACE, "marker": "o", "linestyle": ""})
        draw_paths = partial(plot_lines, lines=[*paths, start], x=("x", "m"), y=("deflection", "m"))
        caption = f"To scale to {widest:.3g} times as wide as high; along the beam magnified {magnified:.2g} times."
        at = np.linspace(0.0, scene.beam.length, 601)
        lines = [(MODELS[m].title, at, abs(field.deflection(at)), model_style(m)) for m, field in fields.items()]
        draw_envelopes = partial(plot_lines, lines=lines, x=("x", "m"), y=("amplitude", "m"))
        envelope = marked(f"Envelope of the wave, N = {n}", margins)
        reverse = "" if against.waves.direction == direction else f", against that of {other.kind}s of the same phases"
        reasons: dict[str, list[str]] = {}
        for row in rows:
            reasons.setdefault(row["note"], []).append(row["name"])
        ratios_of_best = {"best_ratio": best.ratio, "best_ratio_phase_deg": best.phase_deg}
        return Result(
            summary=f"The stronger wave runs towards {end[direction]}{reverse}. Standing-wave ratio at "
            f"{drive.frequency_hz:g} Hz in [L/4, 3L/4]: {', '.join(ratios)}.",
            tables=[
                Table(f"The wave over N, at {drive.frequency_hz:g} Hz", columns, cells, notes),
                _drives(best, exact, exact_swr, end[direction]),
            ],
            figures=[
                Figure("wave-envelopes", envelope, ENVELOPES, draw_envelopes),
                Figure("wave-ellipses", "Surface ellipses along the beam, exact field", caption, draw_paths),
            ],
            movies=[Movie("wave-moving", marked(f"One period, N = {n}", margins), MOVIE, _movie(fields, n))],
            warnings=[f"{', '.join(names)}: {note}." for note, names in reasons.items() if note],
            data={"rows": rows, "other_drive_standing_wave_ratio": ratio, **ratios_of_best},
            margins=margins,
        )


def _waves(case: "DrivenCase", cache: "SolutionCache") -> Row:
    """The wave at the drive's frequency, and at the model's own frequency of least reflection if there is one."""
    from msgspec.structs import replace

    from verify.travelling_wave import best_frequency

    row = {"drive": _operation(case, cache), "best": None, "note": ""}
    try:
        return row | {"best": _operation(replace(case, frequency_hz=best_frequency(case)), cache)}
    except InputError as error:
        return row | {"note": str(error)}


def _operation(case: "DrivenCase", cache: "SolutionCache") -> dict[str, float]:
    wave = measured(case, cache)
    return {
        "frequency_hz": case.frequency_hz,
        "standing_wave_ratio": wave.standing_wave_ratio,
        "axis_ratio": wave.mean_axis_ratio,
        "crest_speed": wave.crest_speed,
    }


def _cells(one: dict[str, float] | None) -> tuple[float | None, ...]:
    return tuple(one.values()) if one else (None,) * 4


def _drives(best: "BestDrive", case: "DrivenCase", ratio: float, end: str) -> "Table":
    """The scene's drive, the best of equal amplitudes, and the best ratio, for waves towards the same end."""
    from verify.waves.operating_point import lead_deg

    first, second = (force.amplitude for force in case.forces)
    columns = [Column("drive"), Column("amplitude ratio", format=".4g"), Column("phase, deg", format=".2f")]
    rows = [
        ("the scene's", second / first if first else None, lead_deg(case), ratio),
        ("best at equal amplitudes", 1.0, best.equal_phase_deg, best.equal_standing_wave_ratio),
        ("best ratio", best.ratio, best.phase_deg, best.standing_wave_ratio),
    ]
    notes = [f"Second over first {case.kind}; exact beam, wave towards {end}.", f"{best.note}."][: 1 + bool(best.note)]
    return Table("Two actuators without reflection", [*columns, Column("SWR", format=".5g")], rows, notes)


def ellipses(field: "HarmonicField") -> tuple[Any, Any, float, float]:
    """Motion of surface points of the middle half over one period.

    (x with the motion along the beam magnified so that neighbours do not touch, (POINTS, FRAMES + 1), height likewise,
    metres, that magnification, largest true ratio of width to height).
    """
    import numpy as np

    from verify.travelling_wave import surface_motion

    turn = np.exp(2j * np.pi * np.arange(FRAMES + 1) / FRAMES)
    places = np.linspace(0.25, 0.75, POINTS) * field.beam.length
    along = (surface_motion(field.beam, field.rotation(places), places)[:, None] * turn).real
    up = (field.deflection(places)[:, None] * turn).real
    magnified = float(0.42 * (places[1] - places[0]) / abs(along).max())
    ratio = np.ptp(along, axis=1) / np.maximum(np.ptp(up, axis=1), 1e-300)
    return places[:, None] + magnified * along, up, magnified, float(ratio.max())


def _movie(fields: Fields, count: int) -> "Callable[[Axes], Any]":
    def set_up(ax: "Axes") -> Any:
        import numpy as np

        exact = fields["analytic"]
        x_surface, height, *_ = ellipses(exact)
        places = {m: np.linspace(0.0, exact.beam.length, (count if MODELS[m].sized else 160) + 1) for m in fields}
        waves = {model: field.deflection(places[model]) for model, field in fields.items()}
        along, up = unit_of(exact.beam.length), unit_over(float(abs(wave).max()) for wave in waves.values())
        top = 1.15 * up.factor * max(float(abs(wave).max()) for wave in waves.values())
        lines = {}
        for model, x in places.items():
            style = {"analytic": "-", "segment": "-o"}.get(model, "x")
            (lines[model],) = ax.plot(along.factor * x, 0.0 * x, style, markersize=3.0, **model_style(model))
            lines[model].set_label(MODELS[model].title)
        (points,) = ax.plot([], [], "o", color=SURFACE, label="surface points")
        ax.set(xlabel=f"x, {along.name}", ylabel=f"deflection, {up.name}", ylim=(-top, top))
        ax.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=4)

        def update(frame: int) -> list[Any]:
            turn = np.exp(2j * np.pi * frame / FRAMES)
            for model, line in lines.items():
                line.set_ydata(up.factor * (waves[model] * turn).real)
            points.set_data(along.factor * x_surface[:, frame], up.factor * height[:, frame])
            return [*lines.values(), points]

        return update, range(FRAMES)

    return set_up
