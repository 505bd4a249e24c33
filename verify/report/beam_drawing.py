"""A drawing of a scene's beam: supports, sections, attached parts, devices, forces and slider, each at its position.

Lengths along the beam are to scale. Heights are not; sections keep their order of thickness.
"""

from typing import Any

from verify.formatting import with_unit
from verify.problem.beam import Beam, attachment_kinds
from verify.report.plotting import INK, MODEL_COLORS
from verify.report.result import Figure
from verify.settings import DRIVE_UNITS

WIDTH, NARROW = 8.4, 4.2
"""Width of the drawing, inches: on a page, and on one of a telephone, where letters of the other would be too small."""
EDGE = 0.1  # margin at each end of the beam over the width of the drawing
BODY, SLIDER, FORCE, SPRING, SOFT = MODEL_COLORS["segment"], MODEL_COLORS["fem"], "#cc3f76", "#2a9d5c", "#7d8590"
THINNEST, THICKEST = 0.10, 0.34  # drawn thickness of sections, inches
LETTER, ROW = 0.078, 0.17  # width of a character and height of a row of text, inches
ELECTRICAL = ("voltage", "current")
DEVICE_UNITS = {"dashpot": "N s/m", "stiffness": "N/m", "mass": "kg", "rotational_dashpot": "N m s"}
DEVICE_UNITS |= {"rotational": "N m/rad", "rotary_inertia": "kg m²", "amplitude": "N"}


def beam_figure(scene: Any, width: float = WIDTH) -> Figure:
    """The drawing as a figure, `width` in inches; `scene` needs `beam`, `drive`, `forces`, `devices` and `slider`."""
    from matplotlib.figure import Figure as MatplotlibFigure

    sketch = _Sketch(scene, MatplotlibFigure().subplots(), width)
    beam: Beam = scene.beam
    kind = scene.drive.kind if scene.drive is not None else "force"
    what = "actuators" if kind in ELECTRICAL else f"{kind}s"
    attached = {f"{name}{'e' * name.endswith('s')}s": getattr(beam, name) for name in attachment_kinds(type(beam))}
    counts = {"sections": beam.section, **attached, what: scene.forces}
    counts |= {"devices": scene.devices, "shunts": scene.shunts, "sliders": (scene.slider,) if scene.slider else ()}
    there = "".join(f", {name}: {len(items)}" for name, items in counts.items() if items)
    return Figure(
        id="beam" if width == WIDTH else "beam-narrow",
        title="The beam",
        caption=f"{_length(beam.length)} long, {beam.supports[0]} at the left, {beam.supports[1]} at the right{there}.",
        draw=lambda ax: _Sketch(scene, ax, width).frame(),
        size=(width, sketch.top - sketch.bottom),
    )


def _length(x: float) -> str:
    return with_unit(x, form=".4g")


class _Sketch:
    """Draws everything on axes whose unit is an inch; keeps the extent and the places taken by text."""

    def __init__(self, scene: Any, ax: Any, width: float) -> None:
        self.ax, self.beam, self.width, self.edge = ax, scene.beam, width, max(EDGE * width, 0.5)
        self.top, self.bottom = 0.4, -0.4
        self.taken: list[tuple[float, float, float, float]] = []
        sizes = [(piece.bending_stiffness / piece.mass_per_length) ** 0.5 for piece in self.beam.pieces]
        spread = max(sizes) - min(sizes)
        growth = [(size - min(sizes)) / spread if spread else 0.25 for size in sizes]
        self.heights = [THINNEST + (THICKEST - THINNEST) * share for share in growth]
        self.sections()
        self.attached()
        for x, support, out in ((0.0, self.beam.supports[0], -1), (self.beam.length, self.beam.supports[1], 1)):
            self.support(self.at(x), self.half(x), support, out)
        self.slider(scene.slider)
        if len(self.beam.pieces) == 1:
            size = f"EI = {self.beam.bending_stiffness:.4g} N m²"
            if self.beam.thickness is not None and self.beam.width is not None:
                size = f"{_length(self.beam.width)} × {_length(self.beam.thickness)}"
            elif self.beam.diameter is not None:
                size = f"⌀ {_length(self.beam.diameter)}"
            self.text(0.5 * self.width, -self.heights[0], [size], down=True)
        for device in scene.devices:
            words = [f"{value:.4g} {u}" for name, u in DEVICE_UNITS.items() if (value := getattr(device, name))]
            self.dashpot(self.at(device.position), self.half(device.position), words)
        for x, load in scene.shunts:
            parts = (("resistance", "Ω"), ("inductance", "H"), ("capacitance", "F"))
            words = [f"{value:.4g} {u}" for name, u in parts if (value := getattr(load, name)) is not None]
            self.actuator(scene.drive.actuator, x, self.half(x), [f"shunt, x = {_length(x)}", *words], SPRING)
        kind = scene.drive.kind if scene.drive is not None else "force"
        for force in scene.forces:
            phase = f", {force.phase_deg:g}°" if force.phase_deg else ""
            x, y = self.at(force.position), self.half(force.position) + self.load(scene, force.position)
            words = [f"x = {_length(force.position)}", f"{force.amplitude:.4g} {DRIVE_UNITS[kind]}{phase}"]
            if kind in ELECTRICAL:
                self.actuator(scene.drive.actuator, force.position, y, words, FORCE)
                continue
            if kind == "moment":
                self.line((x, y + 0.2), color=FORCE, width=0.0, marker="$↺$", markersize=16.0)
            else:
                self.arrow((x, y + 0.6), (x, y + 0.03), FORCE)
            self.text(x, y + (0.4 if kind == "moment" else 0.64), words)
        if scene.drive is not None:
            self.text(0.5 * self.width, self.top, [f"drive at {scene.drive.frequency_hz:g} Hz"])

    def frame(self) -> None:
        self.ax.set_axis_off()
        self.ax.set(xlim=(0.0, self.width), ylim=(self.bottom, self.top), aspect="equal")

    def at(self, x: float) -> float:
        return float(self.edge + (self.width - 2 * self.edge) * x / self.beam.length)

    def half(self, x: float) -> float:
        end = 0.0
        for piece, height in zip(self.beam.pieces, self.heights, strict=True):
            end += piece.length
            if x <= end * (1.0 + 1e-12):
                return 0.5 * height
        return 0.5 * self.heights[-1]

    def load(self, scene: Any, x: float) -> float:
        """Height of a mass or slider that stands on the beam near x."""
        near = 0.25 * self.beam.length / (self.width - 2 * self.edge)
        if any(abs(mass.position - x) < near for mass in self.beam.attached if mass.massive):
            return 0.24
        return 0.22 if scene.slider and abs(scene.slider.initial_position(self.beam) - x) < near else 0.0

    def line(self, *points: tuple[float, float], color: str = INK, width: float = 1.3, **more: Any) -> None:
        self.ax.plot(*zip(*points, strict=True), color=color, linewidth=width, **more)
        self.top = max(self.top, *(y + 0.05 for _, y in points))
        self.bottom = min(self.bottom, *(y - 0.05 for _, y in points))

    def box(self, x: float, y: float, width: float, height: float, color: str, **more: Any) -> None:
        from matplotlib.patches import Rectangle

        self.ax.add_patch(Rectangle((x, y), width, height, facecolor=color, edgecolor=color, **{"alpha": 0.75} | more))
        self.top, self.bottom = max(self.top, y + height + 0.05), min(self.bottom, y - 0.05)

    def arrow(self, tail: tuple[float, float], head: tuple[float, float], color: str) -> None:
        style = {"arrowstyle": "-|>,head_width=0.22,head_length=0.45", "color": color, "linewidth": 1.8}
        self.ax.annotate("", head, tail, arrowprops=style | {"shrinkA": 0.0, "shrinkB": 0.0})
        self.top, self.bottom = max(self.top, tail[1], head[1]), min(self.bottom, tail[1], head[1])

    def text(self, x: float, y: float, rows: list[str], down: bool = False) -> None:
        """Text above y, or below it: moved away from the beam, row by row, until nothing else stands there."""
        half = 0.5 * LETTER * max(map(len, rows))
        x = min(max(x, half), self.width - half)
        low, high = (y - ROW * len(rows), y) if down else (y, y + ROW * len(rows))
        crossed = [(b, t) for left, right, b, t in self.taken if left < x + half and right > x - half]
        while any(b < high - 0.01 and t > low + 0.01 for b, t in crossed):
            low, high = (low - ROW, high - ROW) if down else (low + ROW, high + ROW)
        self.taken.append((x - half, x + half, low, high))
        for i, row in enumerate(rows):
            self.ax.text(x, high - ROW * (i + 0.5), row, ha="center", va="center", fontsize=8.5)
        self.top, self.bottom = max(self.top, high), min(self.bottom, low)

    def sections(self) -> None:
        beam, start = self.beam, 0.0
        for piece, height in zip(beam.pieces, self.heights, strict=True):
            self.box(self.at(start), -0.5 * height, self.at(piece.length) - self.edge, height, BODY, alpha=0.45)
            start += piece.length
        if beam.foundation:
            n = int(4 * self.width)
            for i in range(n):
                x = self.edge + (self.width - 2 * self.edge) * (i + 0.5) / n
                zigzag = ((x, 0.0), (x - 0.05, -0.16), (x + 0.05, -0.26), (x, -0.36))
                self.line(*zigzag, color=SOFT, width=0.8, zorder=0)
            self.line((self.edge, -0.36), (self.width - self.edge, -0.36), color=SOFT)
            self.taken.append((self.edge, self.width - self.edge, -0.38, 0.0))
            self.text(0.5 * self.width, -0.4, [f"foundation {beam.foundation:.4g} N/m²"], down=True)
        if beam.tension:
            for x, out in ((self.edge - 0.14, -1), (self.width - self.edge + 0.14, 1)):
                tail, head = sorted((x, x + 0.32 * out), reverse=(out > 0) != (beam.tension > 0))
                self.arrow((tail, 0.0), (head, 0.0), SPRING)
            self.text(self.width - 0.3, 0.2, [f"{beam.tension:.4g} N"])

    def support(self, x: float, half: float, support: str, out: int) -> None:
        if support in ("clamped", "guided"):
            wall, tall = (x if support == "clamped" else x + 0.12 * out), half + 0.2
            self.line((wall, -tall), (wall, tall), width=2.0)
            for i in range(6):
                y = -tall + 2 * tall * (i + 0.7) / 6
                self.line((wall, y), (wall + 0.1 * out, y - 0.08), color=SOFT, width=0.9)
            if support == "guided":
                self.line((x + 0.06 * out, 0.1), (x + 0.06 * out, -0.1), width=0.0, marker="o", markersize=5.0)
        elif support == "pinned":
            self.line((x, -half), (x - 0.13, -half - 0.2), (x + 0.13, -half - 0.2), (x, -half))
            self.line((x - 0.2, -half - 0.22), (x + 0.2, -half - 0.22), color=SOFT)
        self.text(x, -half - 0.26, [support], down=True)

    def attached(self) -> None:
        for spring in self.beam.attached:
            x, y = self.at(spring.position), -self.half(spring.position)
            if spring.stiffness:
                zigzag = [(x + (0.07 if i % 2 else -0.07), y - 0.1 - 0.045 * i) for i in range(6)]
                self.line((x, y), (x, y - 0.06), *zigzag, (x, y - 0.37), (x, y - 0.42), color=SPRING)
                self.line((x - 0.14, y - 0.42), (x + 0.14, y - 0.42), color=SOFT)
                self.taken.append((x - 0.15, x + 0.15, y - 0.44, y))
                self.text(x, y - 0.46, [f"{spring.stiffness:.4g} N/m"], down=True)
            if spring.rotational:
                self.line((x, 0.0), color=SPRING, width=0.0, marker="$↺$", markersize=16.0)
                self.text(x, -y + 0.12, [f"{spring.rotational:.4g} N m/rad"])
        for mass in (attachment for attachment in self.beam.attached if attachment.massive):
            x, y = self.at(mass.position), self.half(mass.position)
            self.line((x, y + 0.11), width=0.0, marker="o", markersize=15.0)
            values = ((mass.mass, "kg"), (mass.rotary_inertia, "kg m²"))
            self.text(x, y + 0.26, [f"{value:.4g} {unit}" for value, unit in values if value])

    def actuator(self, design: Any, position: float, y: float, words: list[str], color: str) -> None:
        """A patch on its sides of the beam, to scale along it; else a column of layers between beam and base."""
        x, tall = self.at(position), 0.42
        if hasattr(design, "sides"):
            tall, length = 0.09, self.at(design.length) - self.edge
            for low in (y, -self.half(position) - tall)[: design.sides]:
                self.box(x - 0.5 * length, low, length, tall, color)
        else:
            self.box(x - 0.09, y, 0.18, tall, color, alpha=0.4)
            for i in range(1, 7):
                self.line((x - 0.09, y + tall * i / 7), (x + 0.09, y + tall * i / 7), color=color, width=0.8)
            self.line((x - 0.15, y + tall), (x + 0.15, y + tall), color=SOFT)
        self.text(x, y + tall + 0.05, words)

    def dashpot(self, x: float, y: float, words: list[str]) -> None:
        self.line((x, y), (x, y + 0.24), color=SPRING)
        self.line((x - 0.06, y + 0.24), (x + 0.06, y + 0.24), color=SPRING)
        cup = ((x - 0.1, y + 0.14), (x - 0.1, y + 0.34), (x + 0.1, y + 0.34), (x + 0.1, y + 0.14))
        self.line(*cup, color=SPRING)
        self.line((x, y + 0.34), (x, y + 0.5), color=SPRING)
        self.line((x - 0.15, y + 0.5), (x + 0.15, y + 0.5), color=SOFT)
        self.text(x, y + 0.55, words)

    def slider(self, slider: Any) -> None:
        if slider is None:
            return
        start = slider.initial_position(self.beam)
        if not slider.foot:
            x, y = self.at(start), self.half(start)
            self.box(x - 0.2, y + 0.02, 0.4, 0.2, SLIDER)
            self.text(x, y + 0.26, [f"slider {with_unit(1e3 * slider.mass, 'g', '.4g')}, μ = {slider.mu:g}"])
            return
        tops = []
        for foot in slider.foot:
            x, half = self.at(start + foot.offset), self.half(start + foot.offset)
            length, sign = max(self.at(foot.length) - self.edge, 0.2), -1.0 if foot.face == "lower" else 1.0
            near, far = sorted((sign * (half + 0.08), sign * (half + 0.2)))
            self.box(x - 0.5 * length, near, length, far - near, SLIDER)
            self.taken.append((x - 0.5 * length, x + 0.5 * length, near - 0.05, far + 0.05))
            for i in range(min(foot.points, 24)):
                tooth = x - 0.5 * length + length * (i + 0.5) / min(foot.points, 24)
                self.line((tooth, sign * half), (tooth, sign * (half + 0.08)), color=SLIDER)
            if foot.mirrored:
                self.box(x - 0.5 * length - 0.2, far + 0.08, length + 0.4, 2 * half, BODY, alpha=0.25, linestyle="--")
                far += 0.1 + 2 * half
            tops.append(far)
        rows = [f"slider {with_unit(1e3 * slider.mass, 'g', '.4g')}, feet: {len(slider.foot)}"]
        self.text(self.at(start), max(tops) + 0.08, rows)
