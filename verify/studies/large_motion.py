"""A beam on a moving base: rigid links and nonlinear elements in time, their difference as the uncertainty."""

from functools import partial
from math import log, pi
from typing import Annotated, Any

import numpy as np
from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import Margin, per_cent, verdict_of
from verify.arrays import Array
from verify.elements.nonlinear_motion import RHO
from verify.errors import InputError
from verify.formatting import unit_over, with_unit
from verify.linear.step_schemes import DORMAND_PRINCE, generalised_alpha
from verify.quantities.blade import COUNTS, AxialStiffness, Path, TipPath, Tolerance, elements, told_path
from verify.report.plotting import MovingLine
from verify.report.result import Column, Movie, Result, Table
from verify.settings import Joints
from verify.studies.base import Progress, Scene, Study
from verify.studies.charts import beam_movie, line_chart, model_style, percent, si
from verify.validation import convert

FRAMES = 96
LOOSER = 10.0  # factor of the tolerance with the smaller numbers: their difference has the error of the steps
COLUMNS = [Column("model"), Column("N"), si("largest lag", "m"), si("lag at", "s"), si("largest lead", "m")]
COLUMNS += [si("lead at", "s"), Column("x at the end", "m", ".7g"), Column("y at the end", "m", ".4g")]
COLUMNS += [si("root moment", "N m"), percent("path off", ".2g")]
DAMPING = [Column("mode"), si("frequency", "Hz")]
for _title in ("elements", "links"):
    DAMPING += [Column(f"ωh, {_title}", format=".3g"), percent(f"damping, {_title}", ".2g")]
CAPTION = "In the frame of the base: lead towards +y, lag towards -y."
NOTES = [
    "In the frame of the base: x along the straight beam, y across it, lead towards +y, lag towards -y. Path off: "
    "largest distance of the tip from that of the most elements, over the largest motion of the tip or 1 % of the "
    "length; fewer links and elements with ten times the tolerance. Planar, undamped, without shear and rotary inertia "
    "of the section; links do not stretch.",
    "Linear models, their modes and waves are those of a base at rest: they do not apply to this motion.",
]
MODES = 6  # whose numerical damping is shown
DAMPING_NOTE = (
    "Vibration about the straight beam at rest, undamped, in even steps of the mean size; steps that adapt take up to "
    "twice as much, and rotation raises frequencies. Elements: generalised-alpha, which takes more than half of the "
    "amplitude of modes faster than the last row during the motion; links: Dormand and Prince's method."
)
TITLES = {"segment": "links", "fem": "nonlinear elements"}
STYLES = {"segment": model_style("segment"), "fem": {**model_style("fem"), "linewidth": 3.0}}


class LargeMotion(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The beam on the moving base of [base], by rigid links and by nonlinear elements."""

    name, title = "large-motion", "The beam on a moving base"
    reads = ("base", "drive")

    links: Annotated[int, Meta(ge=2, le=1000, description="Rigid links, and twice as many.")] = COUNTS["segment"]
    elements: Annotated[int, Meta(ge=2, le=1000, description="Nonlinear elements, and twice as many.")] = COUNTS["fem"]
    tolerance: Tolerance = 1e-7
    joints: Joints = "series"
    axial_stiffness: AxialStiffness | None = None
    samples: Annotated[int, Meta(ge=8, le=100_000, description="Stored instants, ends included.")] = 401

    def check(self, scene: Scene) -> None:
        """Raise InputError without [base], with a [drive], and for a beam that no moving base carries."""
        if scene.base is None:
            raise InputError("large-motion: the base of the beam moves by [base], add it")
        if scene.drive is not None or scene.slider is not None:
            raise InputError("base: a beam on a moving base has no [drive] and no [slider], leave out these or [base]")
        if scene.beam.supports not in (("clamped", "free"), ("pinned", "free")):
            raise InputError(
                f"beam.supports = {scene.beam.supports!r}: a moving base carries the left end alone, give "
                "('clamped', 'free') or ('pinned', 'free')"
            )

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Simulate both models with two numbers each. Raises InputError."""
        runs = list[tuple[str, int, TipPath]]()
        for model, least in (("segment", self.links), ("fem", self.elements)):
            for count, looser in ((least, LOOSER), (2 * least, 1.0)):
                what = f"{count} {TITLES[model]}"
                progress(what)
                options: dict[str, Any] = {"axial_stiffness": self.axial_stiffness, "samples": self.samples}
                options |= {"model": model, "count": count, "tolerance": min(looser * self.tolerance, 1e-2)}
                options |= {"joints": self.joints}
                path = told_path(scene, cache, convert(options, Path), partial(told, progress, what))
                runs.append((TITLES[model], count, path))
        _, links, fewer, best = (path for *_, path in runs)
        between = links.distance(best)
        margins = self._margins(between, fewer.distance(best), abs(best.energy_lost))
        size, at = max(best.largest(-1.0), best.largest(1.0))
        stated = f"Largest deflection of the tip {with_unit(size)} at {at:.4g} s, ± {with_unit(between * best.moved)}"
        axial, notes = elements(scene.beam, self.elements, self.axial_stiffness).axial_stiffness, list(NOTES)
        hertz = np.array([cache.exact_hz(mode) for mode in range(1, MODES + 1)])
        if axial is not None and self.axial_stiffness is None:
            notes.append(f"EA is unknown: elements have 1e8 EI/L^2, {with_unit(axial, 'N')}.")
        rows = [
            (
                *run,
                *path.largest(-1.0),
                *path.largest(1.0),
                *path.tip[-1],
                path.root_moment,
                path.distance(best) or None,
            )
            for *run, path in runs
        ]
        both = (("fem", best), ("segment", links))
        lines = [(TITLES[model], path.times, path.tip[:, 1], STYLES[model]) for model, path in both]
        valid = verdict_of(margins).level != "not trusted"
        return Result(
            summary=f"{stated}: by elements, and the difference of links from them." if valid else "",
            tables=[Table("Tip on the moving base", COLUMNS, rows, notes), _damping(hertz, links, best)],
            figures=[line_chart("tip", "Deflection of the tip", CAPTION, lines, ("time", "s"), ("y", "m"))],
            movies=[_movie(links, best)],
            data={"times": best.times, "links": links.tip, "elements": best.tip, "axial_stiffness": axial},
            margins=margins,
        )

    def _margins(self, between: float, refined: float, energy: float) -> list[Margin]:
        """Of the difference of models, of numbers and steps, and of the energy that steps take or add."""
        finest = f"{2 * self.elements} elements"
        remedy = "give more large-motion.links and .elements, or a smaller .tolerance; links never stretch"
        sources = {
            f"difference of {2 * self.links} links and {finest}": between,
            f"numbers and steps of {self.elements} and {finest}": refined,
        }
        steps = Margin(
            name="energy that time steps take or add",
            size=energy,
            condition=f"the time steps of {finest} may take or add energy",
            failure=f"the time steps of {finest} are too long, they take or add {per_cent(energy)} of the energy",
            remedy="give a smaller large-motion.tolerance",
            harm="discretisation",
        )
        both = [Margin(name=name, size=size, harm="discretisation", remedy=remedy) for name, size in sources.items()]
        return [*both, steps]


def told(progress: Progress, what: str, left: str) -> None:
    """Call `progress` with a run and the time that it takes on."""
    progress(f"{what}, {left}")


def _damping(hertz: Array, links: TipPath, best: TipPath) -> Table:
    """Numerical damping per mode of both models, and the frequency above which half of a mode is lost by elements'."""
    x, rows = 2.0 * pi * hertz, list[tuple[object, ...]]()
    alpha, steps = generalised_alpha(RHO), best.times[-1] / best.step
    every = np.geomspace(1e-4, 1e3, 7001)
    decay = -alpha.undamped(every).real * every * steps
    half = float(np.interp(log(2.0), decay, every, right=np.nan)) / best.step
    for mode, omega in [*enumerate(x.tolist(), start=1), ("half lost", half)]:
        figures = list[float | None]()
        for scheme, path in ((alpha, best), (DORMAND_PRINCE, links)):
            s = scheme.undamped(np.array(omega * path.step))
            figures += [omega * path.step, max(0.0, float(-s.real / abs(s)))]
        rows.append((str(mode), omega / (2.0 * pi), *figures))
    return Table("Numerical damping of the time steps", DAMPING, rows, [DAMPING_NOTE])


def _movie(links: TipPath, best: TipPath) -> Movie:
    """Both models over each other."""
    kept = np.unique(np.linspace(0, len(best.times) - 1, FRAMES).round().astype(int))
    unit, length = unit_over([float(best.times[-1])], "s"), float(best.line[0, -1, 0])
    lines: list[MovingLine] = [
        (*np.moveaxis(path.line[kept], -1, 0), form, {"markersize": 3, "label": TITLES[model]} | STYLES[model])
        for model, path, form in (("fem", best, "-"), ("segment", links, "-o"))
    ]
    height = max(float(abs(best.line[..., 1]).max()), 0.01 * length)
    texts = [f"{unit.factor * t:.2f} {unit.name}" for t in best.times[kept].tolist()]
    animate = beam_movie(lines, length, height, texts, left=min(0.0, float(best.line[..., 0].min())))
    return Movie("large-motion", "Links and elements in the frame of the base", CAPTION, animate)
