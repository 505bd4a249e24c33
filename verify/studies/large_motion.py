"""A beam on a moving base: rigid links and nonlinear elements in time, their difference as the uncertainty."""

from collections.abc import Callable
from typing import Annotated, Any

import numpy as np
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, verdict_of
from verify.convert import convert
from verify.errors import InputError
from verify.formatting import unit_over, with_unit
from verify.quantities.blade import COUNTS, AxialStiffness, Path, TipPath, Tolerance, elements, path_of
from verify.report.plotting import MODEL_COLORS, MovingLine
from verify.report.result import Column, Figure, Movie, Result, Table
from verify.studies.base import Axes, Progress, Scene, Study
from verify.studies.charts import THIN, Line, beam_movie, line_chart, percent, si

FRAMES = 96
LOOSER = 10.0  # factor of the tolerance with the smaller numbers: their difference has the error of the steps
TIME = ("time", "s")
COLUMNS = [Column("model"), Column("N"), si("largest lag", "m"), si("lag at", "s"), si("largest lead", "m")]
COLUMNS += [si("lead at", "s"), Column("x at the end", "m", ".7g"), Column("y at the end", "m", ".4g")]
COLUMNS += [si("root moment", "N m"), percent("path off", ".2g")]
NOTE = (
    "In the frame of the base: x along the straight beam, y across it, lead towards +y, lag towards -y. Path off: "
    "largest distance of the tip from that of the most elements, over the largest motion of the tip; fewer links and "
    "elements with ten times the tolerance. Planar, undamped, without shear and rotary inertia of the section; links "
    "do not stretch."
)
AT_REST = "Linear models, their modes and waves are those of a base at rest: they do not apply to this motion."


class LargeMotion(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The beam on the moving base of [base], by rigid links and by nonlinear elements."""

    name, title = "large-motion", "The beam on a moving base"

    links: Annotated[int, Meta(ge=2, le=1000, description="Rigid links, and twice as many.")] = COUNTS["segment"]
    elements: Annotated[int, Meta(ge=2, le=1000, description="Nonlinear elements, and twice as many.")] = COUNTS["fem"]
    tolerance: Tolerance = 1e-7
    axial_stiffness: AxialStiffness | None = None
    samples: Annotated[int, Meta(ge=8, le=100_000, description="Stored instants, ends included.")] = 401

    def check(self, scene: Scene) -> None:
        """Raise InputError without [base], with a [drive], and for a beam that no moving base carries."""
        if scene.base is None:
            raise InputError("large-motion: the base of the beam moves by [base], add it")
        if scene.drive is not None:
            raise InputError("drive: a beam on a moving base has none, leave out [drive] or [base]")
        if scene.beam.supports[0] not in ("clamped", "pinned") or scene.beam.supports[1] != "free":
            raise InputError(
                f"beam.supports = {scene.beam.supports!r}: a moving base carries the left end alone, give "
                "('clamped', 'free') or ('pinned', 'free')"
            )

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Simulate both models with two numbers each. Raises InputError."""
        self.check(scene)
        runs = list[tuple[str, int, TipPath]]()
        for model, count, looser in (
            ("segment", self.links, LOOSER),
            ("segment", 2 * self.links, 1.0),
            ("fem", self.elements, LOOSER),
            ("fem", 2 * self.elements, 1.0),
        ):
            progress(f"{count} {TITLES[model]}")
            tolerance = min(looser * self.tolerance, 1e-2)
            options = {"axial_stiffness": self.axial_stiffness, "samples": self.samples, "tolerance": tolerance}
            path = path_of(scene, cache, convert({"model": model, "count": count, **options}, Path))
            runs.append((TITLES[model], count, path))
        _, links, fewer, best = (path for *_, path in runs)
        between, coarse = links.distance(best), fewer.distance(best)
        remedy = "give more large-motion.links and .elements, or a smaller .tolerance"
        margins = [
            Margin(name=name, size=size, harm="discretisation", remedy=remedy)
            for name, size in (
                (f"difference of {2 * self.links} links and {2 * self.elements} elements", between),
                (f"numbers and steps of {self.elements} and {2 * self.elements} elements", coarse),
            )
        ]
        (lag, at), unsure = max(best.largest_lag, best.largest_lead), between * best.moved
        stated = f"Largest deflection of the tip {with_unit(lag)} at {at:.4g} s, ± {with_unit(unsure)}"
        valid = verdict_of(margins).level != "not trusted"
        axial, notes = elements(scene, self.elements, self.axial_stiffness).axial_stiffness, [NOTE, AT_REST]
        if axial is not None and self.axial_stiffness is None:
            notes.append(f"EA is unknown: elements stretch by up to a millionth, with {with_unit(axial, 'N')}.")
        return Result(
            summary=f"{stated}: by elements, and the difference of links from them." if valid else "",
            tables=[Table("Tip on the moving base", COLUMNS, _rows(runs, best), notes)],
            figures=_figures(links, best),
            movies=[Movie("large-motion", "Links and elements in the frame of the base", MOVIE, _movie(links, best))],
            data={"times": best.times, "links": links.tip, "elements": best.tip, "axial_stiffness": axial},
            margins=margins,
        )


TITLES = {"segment": "links", "fem": "nonlinear elements"}
STYLES: dict[str, dict[str, Any]] = {
    "fem": {"color": MODEL_COLORS["fem"], "linewidth": 2.0 * THIN, "label": TITLES["fem"]},
    "segment": {"color": MODEL_COLORS["segment"], "linewidth": THIN, "label": TITLES["segment"]},
}
MOVIE = "In the frame of the base, drawn to scale along each axis."


def _rows(runs: list[tuple[str, int, TipPath]], best: TipPath) -> list[tuple[Any, ...]]:
    """A row of each run."""
    rows: list[tuple[Any, ...]] = []
    for name, count, path in runs:
        figures = *path.largest_lag, *path.largest_lead, *path.tip[-1].tolist(), path.root_moment
        rows.append((name, count, *figures, path.distance(best) if path is not best else None))
    return rows


def _figures(links: TipPath, best: TipPath) -> list[Figure]:
    """Deflection and shortening of the tip over time by both models."""

    def lines(read: Callable[[TipPath], Any]) -> list[Line]:
        styles = ({key: value for key, value in style.items() if key != "label"} for style in STYLES.values())
        both = zip(STYLES, (best, links), styles, strict=True)
        return [(TITLES[model], path.times, read(path), style) for model, path, style in both]

    across, along = lines(lambda path: path.tip[:, 1]), lines(lambda path: path.line[0, -1, 0] - path.tip[:, 0])
    caption = "In the frame of the base; lead is positive."
    return [
        line_chart("tip-deflection", "Deflection of the tip", caption, across, TIME, ("y", "m")),
        line_chart("tip-shortening", "Shortening of the tip", caption, along, TIME, ("L - x", "m")),
    ]


def _movie(links: TipPath, best: TipPath) -> Callable[[Axes], Any]:
    """Both models over each other."""
    kept = np.unique(np.linspace(0, len(best.times) - 1, FRAMES).round().astype(int))
    unit, length = unit_over([float(best.times[-1])], "s"), float(best.line[0, -1, 0])
    forms = zip((best, links), ("-", "-o"), STYLES.values(), strict=True)
    lines: list[MovingLine] = [
        (path.line[kept, :, 0], path.line[kept, :, 1], form, {"markersize": 3} | style) for path, form, style in forms
    ]
    height = max(float(abs(best.line[..., 1]).max()), 0.01 * length)
    texts = [f"{unit.factor * t:.2f} {unit.name}" for t in best.times[kept].tolist()]
    return beam_movie(lines, length, height, texts, left=min(0.0, float(best.line[..., 0].min())))
