"""The driven beam: standing-wave ratio and crest speed over N, envelopes, surface ellipses."""

from collections.abc import Callable
from contextlib import suppress
from typing import Annotated, Any, TypeAlias

import numpy as np
from msgspec import Meta
from msgspec.structs import replace

from verify.analysis.margins import SHEAR, against_exact, marked, sufficient_count
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.variants import not_default
from verify.analysis.verdict import Margin, verdict_of
from verify.errors import InputError, WindowError
from verify.linear.field import HarmonicField, travelling_wavenumber
from verify.linear.registry import EXACT, MODELS, discrete
from verify.quantities.waves import FieldOptions, driven_case, measured
from verify.report.plotting import MovingLine
from verify.report.result import Column, Figure, Movie, Result, Table
from verify.settings import DEFAULT, Theory
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import beam_movie, line_chart, model_style, si, sized_title, table
from verify.studies.convergence import Counts
from verify.studies.tables import scene_margins
from verify.travelling_wave import BestDrive, DrivenCase, best_drive, best_frequency, surface_motion
from verify.waves.driven_case import driven
from verify.waves.operating_point import lead_deg
from verify.waves.window import check_span, check_waves, middle_half

Row: TypeAlias = dict[str, Any]
Fields: TypeAlias = dict[str, HarmonicField]
FRAMES, POINTS = 36, 13
SURFACE = "#cc3f76"
WAVES = (
    "SWR: standing-wave ratio in [L/4, 3L/4]. Axis ratio: mean over its whole half wavelengths. Crest speed: of the "
    "surface at the rms amplitude along +x, against the wave: negative for a wave towards +x."
)
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

    name, title = "wave", "The driven beam"
    reads = ("drive",)

    theory: Theory = DEFAULT.theory
    count: Annotated[int, Meta(ge=1, description="Segments and elements; by default within 1 %.")] | None = None
    counts: Annotated[Counts, Meta(description="Of the errors over N; else 1, 2, 4 times count.")] | None = None

    def check(self, scene: Scene) -> None:
        """Raise InputError without two forces, for a beam without waves, a window or a size that does not suit them."""
        if len(scene.forces) != 2 or scene.drive is None:
            raise InputError("wave: the study needs a [drive] with two forces, add them")
        case = driven_case(scene, FieldOptions(theory=self.theory))
        positions, frequency = [force.position for force in scene.forces], scene.drive.frequency_hz
        try:
            check_span(case.beam, [*positions, *case.places[0]], middle_half(case.beam), case.places[1])
            check_waves(scene.beam, frequency, middle_half(scene.beam))
        except WindowError as error:
            remedy = "use quantities or gates with a window of their own, and leave a section [wave] out"
            raise WindowError(f"wave: its window [L/4, 3L/4] does not suit this beam ({error}): {remedy}") from None
        bare = replace(scene.beam, mass=(), spring=())
        for model in discrete("harmonic", scene.beam) if bare.uniform else ():
            for count in filter(None, (self.count, *(self.counts or ()))):
                model.build(bare, count, **dict(not_default({"theory": self.theory}))).check_propagates(frequency)

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Solve the fields of all models. Raises InputError."""
        assert scene.drive is not None
        exact, hertz = driven_case(scene, FieldOptions(theory=self.theory)), scene.drive.frequency_hz
        models = [model.name for model in discrete("harmonic", scene.beam)]
        n = self.count or sufficient_count(cache, frequency_hz=hertz)
        counts = self.counts or (n, 2 * n, 4 * n)
        sizes = [(EXACT, None), *((model, count) for model in models for count in counts)]
        rows = [_waves(exact, model, count, cache, progress) for model, count in sizes]
        cases = [_sized(exact, *size) for size in ((EXACT, None), *((model, n) for model in models))]
        fields = {case.model.name: driven(case, cache) for case in cases}
        other = replace(exact, kind="displacement" if exact.kind == "force" and not exact.shunts else "force")
        direction = -1 if rows[0]["drive"]["crest_speed"] > 0.0 else 1  # crests move against the wave
        against, best = measured(other, cache), best_drive(exact, direction=direction)
        ratio, end = against.standing_wave_ratio, {1: "+x", -1: "-x"}

        margins, swr, moved = self._margins(scene, cache, rows, n, best)
        exact_swr = rows[0]["drive"]["standing_wave_ratio"]
        ratios = ", ".join(f"{name} {value:.5g}" for name, value in swr.items())
        reverse = "" if against.waves.direction == direction else f", against that of {other.kind}s of the same phases"
        reasons: dict[str, list[str]] = {}
        for row in rows:
            reasons.setdefault(row["note"], []).append(row["name"])
        imposed = (
            f"With {other.kind}s of the same phases imposed the exact standing-wave ratio is {ratio:.5g}, the stronger "
            f"wave towards {end[against.waves.direction]}."
        )
        summary = f"The stronger wave runs towards {end[direction]}{reverse}. Standing-wave ratio at "
        summary += f"{hertz:g} Hz in [L/4, 3L/4]: {ratios}."
        return Result(
            summary=summary if verdict_of(margins).holds else "",
            tables=[_over_size(hertz, rows, imposed), _drives(best, exact, exact_swr, end[direction], moved)],
            figures=_figures(fields, marked(f"Envelope of the wave, N = {n}", margins)),
            movies=[Movie("wave-moving", marked(f"One period, N = {n}", margins), MOVIE, _movie(fields, n))],
            warnings=[f"{', '.join(names)}: {note}." for note, names in reasons.items() if note],
            data={"rows": rows, "other_drive_standing_wave_ratio": ratio}
            | {"best_ratio": best.ratio, "best_ratio_phase_deg": best.phase_deg},
            margins=margins,
        )

    def _margins(
        self, scene: Scene, cache: SolutionCache, rows: list[Row], n: int, best: BestDrive
    ) -> tuple[list[Margin], dict[str, float], BestDrive | None]:
        """(margins, standing-wave ratio by title, the best drive by Timoshenko theory where shear changes the wave)."""
        ratio = {row["name"]: row["drive"]["standing_wave_ratio"] for row in rows}
        models = dict.fromkeys(row["model"] for row in rows if row["N"])
        settings, hertz = not_default({"theory": self.theory}), scene.drive.frequency_hz if scene.drive else 0.0
        sizes = [(model, n) for model in models]
        margins = scene_margins(scene, cache, sizes, frequency_hz=hertz, settings=settings, steady=True)
        size = n if any(row["N"] == n for row in rows) else max(row["N"] or 0 for row in rows)
        for row in (row for row in rows if row["N"] in (None, size)):
            larger = [one["name"] for one in rows if one["model"] == row["model"] and (one["N"] or 0) > size]
            given = row["name"], ratio[row["name"]], ratio[rows[0]["name"]]
            margins.append(against_exact("standing-wave ratio", *given, finer={name: ratio[name] for name in larger}))
        shown = {row["name"]: ratio[row["name"]] for row in rows if row["N"] in (None, size)}
        sheared = next((one for one in margins if one.name == SHEAR and one.level == "not trusted"), None)
        moved = None
        if sheared is not None:
            with suppress(InputError):
                other = driven_case(scene, FieldOptions(theory="timoshenko"))
                moved = best_drive(other, direction=1 if rows[0]["drive"]["crest_speed"] <= 0.0 else -1)
                with_it = f"its phase for a pure wave is {moved.phase_deg:.1f} degrees, not {best.phase_deg:.1f}"
                margins[margins.index(sheared)] = replace(sheared, failure=f"{sheared.failure}; {with_it}")
        return margins, shown, moved


def _sized(case: DrivenCase, model: str, count: int | None) -> DrivenCase:
    """A case on another model of the same theory."""
    settings = dict(not_default({"theory": case.model.theory}))
    return replace(case, model=MODELS[model].build(case.beam, count, **settings))


def _over_size(hertz: float, rows: list[Row], imposed: str) -> Table:
    """The wave of each model and size at the drive, and at its own frequency of least reflection where one has it."""

    def read(where: str, name: str) -> Callable[[Row], Any]:
        return lambda row: row[where][name] if row[where] else None

    def figures(where: str, suffix: str = "") -> dict[Column, Any]:
        columns = {Column(f"SWR{suffix}", format=".5g"): read(where, "standing_wave_ratio")}
        columns |= {Column(f"axis ratio{suffix}", format="+.5f"): read(where, "axis_ratio")}
        return columns | {si(f"crest speed{suffix}", "m/s", "+.5g"): read(where, "crest_speed")}

    columns: dict[Column, Any] = {Column("model"): lambda row: MODELS[row["model"]].title, Column("N"): "N"}
    columns |= figures("drive")
    if better := any(row["best"] for row in rows):
        columns |= {Column("best frequency", "Hz", ".2f"): read("best", "frequency_hz")} | figures("best", " there")
    notes = WAVES + " Right: at its own frequency of least reflection." * better, imposed
    return table(f"The wave over N, at {hertz:g} Hz", rows, columns, *notes)


def _waves(exact: DrivenCase, model: str, count: int | None, cache: SolutionCache, progress: Progress) -> Row:
    """The wave at the drive's frequency, and at the model's own frequency of least reflection if there is one."""
    progress(name := sized_title(model, count))
    case = _sized(exact, model, count)
    row = {"name": name, "model": model, "N": count, "drive": _operation(case, cache), "best": None, "note": ""}
    try:
        return row | {"best": _operation(replace(case, frequency_hz=best_frequency(case)), cache)}
    except InputError as error:
        return row | {"note": str(error)}


def _operation(case: DrivenCase, cache: SolutionCache) -> dict[str, float]:
    wave = measured(case, cache)
    operation = {"frequency_hz": case.frequency_hz, "standing_wave_ratio": wave.standing_wave_ratio}
    return operation | {"axis_ratio": wave.mean_axis_ratio, "crest_speed": wave.crest_speed}


def _drives(best: BestDrive, case: DrivenCase, ratio: float, end: str, moved: BestDrive | None) -> Table:
    """The scene's drive, the best of equal amplitudes, and the best ratio, for waves towards the same end.

    `moved`: the best by Timoshenko theory.
    """
    first, second = (force.amplitude for force in case.forces)
    columns = [Column("drive"), Column("amplitude ratio", format=".4g"), Column("phase, deg", format=".2f")]
    rows = [
        ("the scene's", second / first if first else None, lead_deg(case), ratio),
        ("best at equal amplitudes", 1.0, best.equal_phase_deg, best.equal_standing_wave_ratio),
        ("best ratio", best.ratio, best.phase_deg, best.standing_wave_ratio),
    ]
    if moved is not None:
        rows.append(("best ratio, Timoshenko theory", moved.ratio, moved.phase_deg, moved.standing_wave_ratio))
    notes = [f"Second over first {case.kind}; exact beam, wave towards {end}.", f"{best.note}."][: 1 + bool(best.note)]
    return Table("Two actuators without reflection", [*columns, Column("SWR", format=".5g")], rows, notes)


def ellipses(field: HarmonicField) -> tuple[Any, Any, float, float]:
    """Motion of surface points about the middle over one period: of the middle half, at most three half waves of it.

    Fewer than two points in half a wave show a wave of another length.

    (x with the motion along the beam magnified so that neighbours do not touch, (POINTS, FRAMES + 1), height likewise,
    metres, that magnification, largest true ratio of width to height).
    """
    turn = np.exp(2j * np.pi * np.arange(FRAMES + 1) / FRAMES)
    half = min(0.25, 1.5 / max(_half_waves(field), 1.0))
    places = np.linspace(0.5 - half, 0.5 + half, POINTS) * field.beam.length
    along = (surface_motion(field.beam, field.rotation(places), places)[:, None] * turn).real
    up = (field.deflection(places)[:, None] * turn).real
    magnified = float(0.42 * (places[1] - places[0]) / abs(along).max())
    ratio = np.ptp(along, axis=1) / np.maximum(np.ptp(up, axis=1), 1e-300)
    return places[:, None] + magnified * along, up, magnified, float(ratio.max())


def _half_waves(field: HarmonicField) -> float:
    """Half waves of the drive along the beam; 0 where no wave travels."""
    return (travelling_wavenumber(field.beam, float(field.frequency_hz)) or 0.0) * field.beam.length / np.pi


def _sampled(field: HarmonicField) -> Any:
    """Positions for smooth lines, at least 16 in half a wave, m."""
    return np.linspace(0.0, field.beam.length, max(601, int(16 * _half_waves(field)) + 1))


def _figures(fields: Fields, title: str) -> list[Figure]:
    """Amplitude over the beam on each model, paths of surface points of the exact beam."""
    along, x = ("x", "m"), _sampled(fields[EXACT])
    lines = [(MODELS[m].title, x, abs(field.deflection(x)), model_style(m)) for m, field in fields.items()]
    places, up, magnified, widest = ellipses(fields[EXACT])
    paths = [("", places[i], up[i], {"color": "#2f80ed"}) for i in range(POINTS)]
    start = ("", places[:, 0], up[:, 0], {"color": SURFACE, "marker": "o", "linestyle": ""})
    caption = f"To scale to {widest:.3g} times as wide as high; along the beam magnified {magnified:.2g} times."
    surface = "Surface ellipses along the beam, exact field"
    return [
        line_chart("wave-envelopes", title, ENVELOPES, lines, along, ("amplitude", "m")),
        line_chart("wave-ellipses", surface, caption, [*paths, start], along, ("deflection", "m")),
    ]


def _movie(fields: Fields, count: int) -> Callable[[Axes], Any]:
    """The beam on each model, and surface points of the exact beam, over a period."""
    turn = np.exp(2j * np.pi * np.arange(FRAMES) / FRAMES)[:, None]
    length, (x_surface, height, *_) = fields[EXACT].beam.length, ellipses(fields[EXACT])
    lines, largest = list[MovingLine](), 0.0
    for model, field in fields.items():
        x = np.linspace(0.0, length, count + 1) if MODELS[model].sized else _sampled(field)
        wave = field.deflection(x)
        largest = max(largest, float(abs(wave).max()))
        form = {"analytic": "-", "segment": "-o"}.get(model, "x")
        style = {"markersize": 3.0, "label": MODELS[model].title} | model_style(model)
        lines.append((x, (wave * turn).real, form, style))
    lines.append((x_surface.T, height.T, "o", {"color": SURFACE, "label": "surface points"}))
    return beam_movie(lines, length, largest, [""] * FRAMES)
