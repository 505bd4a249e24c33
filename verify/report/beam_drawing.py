"""A drawing of a scene's beam: supports, sections, attached parts, devices, forces and slider, each at its position.

Lengths along the beam are to scale. Heights are not; sections keep their order of thickness.
"""

from itertools import pairwise
from math import nan
from typing import Any

from verify.formatting import with_unit
from verify.options import DRIVE_UNITS
from verify.report.plotting import INK, MODEL_COLORS
from verify.report.result import Figure

WIDTH, EDGE = 8.4, 0.83
"""Width of the drawing and of the margin at each end of the beam, inches."""
BODY, SLIDER, FORCE, SPRING, SOFT = MODEL_COLORS["segment"], MODEL_COLORS["fem"], "#cc3f76", "#2a9d5c", "#7d8590"
THINNEST, THICKEST = 0.10, 0.34
"""Drawn thickness of sections, inches."""
LETTER, ROW = 0.078, 0.17
"""Width of a character and height of a row of text, inches."""
UNITS = {"dashpot": "N s/m", "stiffness": "N/m", "mass": "kg", "rotational_dashpot": "N m s", "amplitude": "N"}
UNITS |= {"rotational": "N m/rad", "rotary_inertia": "kg m²", "resistance": "Ω", "inductance": "H", "capacitance": "F"}
UP = (nan, nan)  # lifts the pen
WALL = [(0.0, -0.37), (0.0, 0.37), *(p for i in range(6) for p in (UP, (0.0, 0.12 * i - 0.29), (0.1, 0.12 * i - 0.37)))]
SYMBOLS = {
    "clamped": WALL,
    "guided": [(0.03, 0.1), (0.09, 0.1), UP, (0.03, -0.1), (0.09, -0.1), UP, *((x + 0.12, y) for x, y in WALL)],
    "pinned": [(0.0, 0.0), (-0.13, -0.2), (0.13, -0.2), (0.0, 0.0), UP, (-0.2, -0.22), (0.2, -0.22)],
    "spring": [(0.0, 0.0), (0.0, -0.06), *((0.07 * (-1) ** (i + 1), -0.1 - 0.045 * i) for i in range(6)),
               (0.0, -0.37), (0.0, -0.42), UP, (-0.14, -0.42), (0.14, -0.42)],
    "dashpot": [(0.0, 0.0), (0.0, 0.24), UP, (-0.06, 0.24), (0.06, 0.24), UP, (-0.1, 0.14), (-0.1, 0.34), (0.1, 0.34),
                (0.1, 0.14), UP, (0.0, 0.34), (0.0, 0.5), UP, (-0.15, 0.5), (0.15, 0.5)],
}  # fmt: skip
"""Polylines from a point of the beam, inches; supports are those of the right end."""


def beam_figure(scene: Any) -> Figure:
    """The drawing as a figure; `scene` needs `beam`, `drive`, `forces`, `devices`, `shunts` and `slider`."""
    from matplotlib.figure import Figure as MatplotlibFigure

    bottom, top = _Sketch(scene, MatplotlibFigure().subplots()).extent
    beam = scene.beam
    counts = {"sections": beam.section, "masses": beam.mass, "springs": beam.spring, "forces": scene.forces}
    counts |= {"devices": scene.devices, "shunts": scene.shunts, "sliders": (scene.slider,) if scene.slider else ()}
    there = "".join(f", {name}: {len(items)}" for name, items in counts.items() if items)
    return Figure(
        id="beam",
        title="The beam",
        caption=f"{_length(beam.length)} long, {beam.supports[0]} at the left, {beam.supports[1]} at the right{there}.",
        draw=lambda ax: _Sketch(scene, ax).frame(),
        size=(WIDTH, top - bottom),
    )


def _length(x: float) -> str:
    return with_unit(x, form=".4g")


def _values(one: Any) -> list[str]:
    values = ((getattr(one, name, None), unit) for name, unit in UNITS.items())
    return [f"{value:.4g} {unit}" for value, unit in values if value]


class _Sketch:
    """Draws everything on axes whose unit is an inch; keeps the places of texts and the heights of bodies."""

    def __init__(self, scene: Any, ax: Any) -> None:
        self.ax, self.beam, beam = ax, scene.beam, scene.beam
        self.taken: list[tuple[float, float, float, float]] = []
        self.bodies: list[tuple[float, float]] = []
        sizes = [(piece.bending_stiffness / piece.mass_per_length) ** 0.5 for piece in beam.pieces]
        spread, ends = max(sizes) - min(sizes), [0.0]
        growth = [(size - min(sizes)) / spread if spread else 0.25 for size in sizes]
        self.heights = [THINNEST + (THICKEST - THINNEST) * share for share in growth]
        for piece, height in zip(beam.pieces, self.heights, strict=True):
            ends.append(ends[-1] + piece.length)
            self.box(self.at(ends[-2]), -0.5 * height, self.at(piece.length) - EDGE, height, BODY, alpha=0.45)
        self.ends = ends
        self.loads()
        self.attached()
        for x, support, out in ((0.0, beam.supports[0], -1), (beam.length, beam.supports[1], 1)):
            if support != "free":
                self.symbol(support, self.at(x), -self.half(x) if support == "pinned" else 0.0, mirror=out)
            self.text(self.at(x), -self.half(x) - 0.26, [support], down=True)
        if scene.slider:
            self.slider(scene.slider)
        if len(beam.pieces) == 1:
            size = f"EI = {beam.bending_stiffness:.4g} N m²"
            if beam.thickness is not None and beam.width is not None:
                size = f"{_length(beam.width)} × {_length(beam.thickness)}"
            elif beam.diameter is not None:
                size = f"⌀ {_length(beam.diameter)}"
            self.text(0.5 * WIDTH, -self.heights[0], [size], down=True)
        for place, one in [*((device.position, device) for device in scene.devices), *scene.shunts]:
            self.symbol("dashpot", self.at(place), self.half(place), SPRING)
            self.text(self.at(place), self.half(place) + 0.55, _values(one))
        for force in scene.forces:
            phase, x = f", {force.phase_deg:g}°" if force.phase_deg else "", self.at(force.position)
            y = max([self.half(force.position), *(top for at, top in self.bodies if abs(at - x) < 0.25)])
            self.arrow((x, y + 0.6), (x, y + 0.03), FORCE)
            amplitude = f"{force.amplitude:.4g} {DRIVE_UNITS[scene.drive.kind]}{phase}"
            self.text(x, y + 0.64, [f"x = {_length(force.position)}", amplitude])
        if scene.drive is not None:
            self.text(0.5 * WIDTH, self.extent[1], [f"drive at {scene.drive.frequency_hz:g} Hz"])

    def frame(self) -> None:
        self.ax.set_axis_off()
        self.ax.set(xlim=(0.0, WIDTH), ylim=self.extent, aspect="equal")

    def attached(self) -> None:
        for spring in self.beam.spring:
            x, y = self.at(spring.position), self.half(spring.position)
            if spring.stiffness:
                self.symbol("spring", x, -y, SPRING)
                self.taken.append((x - 0.15, x + 0.15, -y - 0.44, -y))
                self.text(x, -y - 0.46, [f"{spring.stiffness:.4g} N/m"], down=True)
            if spring.rotational:
                self.ax.plot(x, 0.0, color=SPRING, marker="$↺$", markersize=16.0)
                self.text(x, y + 0.12, [f"{spring.rotational:.4g} N m/rad"])
        for mass in self.beam.mass:
            x, y = self.at(mass.position), self.half(mass.position)
            self.ax.plot(x, y + 0.11, color=INK, marker="o", markersize=15.0)
            self.bodies.append((x, y + 0.24))
            self.text(x, y + 0.26, _values(mass))

    @property
    def extent(self) -> tuple[float, float]:
        """Lowest and highest place of what is drawn."""
        heights = [*self.ax.dataLim.intervaly, *(y for place in self.taken for y in place[2:])]
        return min(heights) - 0.05, max(heights) + 0.05

    def at(self, x: float) -> float:
        return float(EDGE + (WIDTH - 2 * EDGE) * x / self.beam.length)

    def half(self, x: float) -> float:
        """Half the drawn thickness at x."""
        inside = (end * (1.0 + 1e-12) >= x for _, end in pairwise(self.ends))
        return 0.5 * next((h for h, here in zip(self.heights, inside, strict=True) if here), self.heights[-1])

    def symbol(self, name: str, x: float, y: float, color: str = INK, mirror: int = 1) -> None:
        points = [(x + mirror * dx, y + dy) for dx, dy in SYMBOLS[name]]
        self.ax.plot(*zip(*points, strict=True), color=color, linewidth=1.3)

    def box(self, x: float, y: float, width: float, height: float, color: str, **more: Any) -> None:
        from matplotlib.patches import Rectangle

        look: dict[str, Any] = {"facecolor": color, "edgecolor": color, "alpha": 0.75} | more
        self.ax.add_patch(Rectangle((x, y), width, height, **look))

    def arrow(self, tail: tuple[float, float], head: tuple[float, float], color: str) -> None:
        style = {"arrowstyle": "-|>,head_width=0.22,head_length=0.45", "color": color, "linewidth": 1.8}
        self.ax.annotate("", head, tail, arrowprops=style | {"shrinkA": 0.0, "shrinkB": 0.0})
        self.ax.update_datalim([tail, head])

    def text(self, x: float, y: float, rows: list[str], down: bool = False) -> None:
        """Text above y, or below it: moved away from the beam, row by row, until nothing else stands there."""
        half = 0.5 * LETTER * max(map(len, rows))
        x = min(max(x, half), WIDTH - half)
        low, high = (y - ROW * len(rows), y) if down else (y, y + ROW * len(rows))
        crossed = [(b, t) for left, right, b, t in self.taken if left < x + half and right > x - half]
        while any(b < high - 0.01 and t > low + 0.01 for b, t in crossed):
            low, high = (low - ROW, high - ROW) if down else (low + ROW, high + ROW)
        self.taken.append((x - half, x + half, low, high))
        for i, row in enumerate(rows):
            self.ax.text(x, high - ROW * (i + 0.5), row, ha="center", va="center", fontsize=8.5)

    def loads(self) -> None:
        """Foundation and axial force."""
        beam, left, right = self.beam, EDGE, WIDTH - EDGE
        if beam.foundation:
            self.box(left, -0.36, right - left, 0.36 - 0.5 * self.heights[0], "none", hatch="////", edgecolor=SOFT)
            self.taken.append((left, right, -0.38, 0.0))
            self.text(0.5 * WIDTH, -0.4, [f"foundation {beam.foundation:.4g} N/m²"], down=True)
        if beam.tension:
            for x, out in ((left - 0.14, -1), (right + 0.14, 1)):
                tail, head = sorted((x, x + 0.32 * out), reverse=(out > 0) != (beam.tension > 0))
                self.arrow((tail, 0.0), (head, 0.0), SPRING)
            self.text(WIDTH - 0.3, 0.2, [f"{beam.tension:.4g} N"])

    def slider(self, slider: Any) -> None:
        start, words = slider.initial_position(self.beam), [f"slider {with_unit(1e3 * slider.mass, 'g', '.4g')}"]
        places = [(start + foot.offset, max(self.at(foot.length) - EDGE, 0.2), foot) for foot in slider.foot]
        words.append(f"feet: {len(places)}" if places else f"μ = {slider.mu:g}")
        for x, length, foot in places or [(start, 0.4, None)]:
            y = -self.half(x) - 0.22 if foot and foot.face == "lower" else self.half(x) + 0.02
            self.box(self.at(x) - 0.5 * length, y, length, 0.2, SLIDER)
            self.bodies.append((self.at(x), y + 0.2))
            if foot and foot.mirrored:
                self.box(self.at(x) - 0.5 * length - 0.2, y + 0.28, length + 0.4, 2 * self.half(x), BODY, alpha=0.25)
                self.bodies.append((self.at(x), y + 0.28 + 2 * self.half(x)))
            self.taken.append((self.at(x) - 0.5 * length, self.at(x) + 0.5 * length, y, y + 0.2))
        self.text(self.at(start), max(top for _, top in self.bodies) + 0.04, [", ".join(words)])
