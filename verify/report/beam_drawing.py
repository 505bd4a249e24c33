"""A drawing of a scene's beam as SVG: supports, sections, what stands on it, forces, the slider, all where they are.

Lengths along the beam are to scale; heights are not, but sections keep their order of thickness. Lines follow the page.
Words are laid where nothing else stands: beside what they name, else farther from the beam.
"""

from collections.abc import Iterator
from math import log10
from typing import TYPE_CHECKING, TypeAlias

import msgspec

from verify.options import Support
from verify.report.labels import Box, Label, placed, words_at
from verify.units import in_words

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.device import Device
    from verify.scenes.scene import Scene
    from verify.section import Piece
    from verify.slider import Foot, Slider

BROAD, NARROW = (860.0, 60.0), (400.0, 48.0)
"""Width of the picture and of its margins: for a page, for a phone."""
LEAST, MOST = 5.0, 24.0
"""Thickness of the thinnest and the thickest section."""
ARROW = 46.0
"""Length of a force."""
PLATE, TOOTH = 9.0, 6.0
"""Thickness of a foot, and length of its contact points."""
POINT_FOOT, TEETH = 14.0, 24
"""Length of a foot of one point; contact points that are drawn at most."""
STAGE = "#e8760c"
INK, SOFT, BODY, FORCE, SPRING = "var(--ink)", "var(--soft)", "var(--bar)", "#d6427a", "#2a9d5c"

Drawn: TypeAlias = "Box | Label | str"
"""What a part of the picture consists of: room that words keep clear of, words, strokes."""


class View(msgspec.Struct, frozen=True):
    """Where on the picture a place of the beam is; its neutral line is at height 0, downwards positive."""

    beam: "Beam"
    width: float
    edge: float

    def at(self, x: float) -> float:
        """Across the picture, of a place in metres."""
        return self.edge + (self.width - 2 * self.edge) * x / self.beam.length


def beam_drawing(scene: "Scene", size: tuple[float, float] = BROAD) -> str:
    """The whole picture."""
    view = View(scene.beam, *size)
    parts = list(_parts(scene, view))
    boxes = [one for one in parts if isinstance(one, Box)]
    words, boxes = placed([one for one in parts if isinstance(one, Label)], boxes, view.width)
    top = min(box.top for box in boxes) - 6.0
    bottom = max(box.bottom for box in boxes) + 32.0
    strokes = [one for one in parts if isinstance(one, str)] + words + list(_length(view, bottom - 10.0))
    return (
        f'<svg viewBox="0 {top:.0f} {view.width:g} {bottom - top:.0f}" role="img" aria-label="{_told(scene)}" '
        f'style="width:100%;max-width:{view.width:g}px;display:block;margin:auto" font-size="12" fill="none">'
        f"{''.join(strokes)}</svg>"
    )


def _parts(scene: "Scene", view: View) -> Iterator[Drawn]:
    """Everything that stands in the picture; of words the first have the choice of places."""
    yield from _foundation(view)
    yield from _pieces(view)
    yield from _supports(view)
    yield from _springs(view)
    yield from _masses(view)
    yield from _devices(scene, view)
    yield from _tension(view)
    if scene.slider is not None:
        yield from _slider(scene.slider, view)
    yield from _forces(scene, view)


def _told(scene: "Scene") -> str:
    """The picture in words."""
    beam = scene.beam
    words = [f"A beam of {_metres(beam.length)}, {beam.supports[0]} at the left and {beam.supports[1]} at the right"]
    counts = {"sections": beam.section, "bodies": beam.mass, "springs": beam.spring, "forces": scene.forces}
    counts |= {"devices": scene.devices}
    words += [f"{len(found)} {name}" for name, found in counts.items() if found]
    return ", ".join([*words, *(["a slider"] if scene.slider else [])])


def _metres(x: float) -> str:
    """A length with a unit that suits it."""
    return in_words(x, form=".4g")


def _line(*points: tuple[float, float], colour: str = INK, width: float = 1.4, more: str = "") -> str:
    d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return f'<path d="{d}" stroke="{colour}" stroke-width="{width:g}"{more}/>'


def _heights(beam: "Beam") -> list[float]:
    """Of each piece, by (EI over the mass of a metre)^(1/2), which of a rectangle is its thickness."""
    sizes = [log10(piece.bending_stiffness / piece.mass_per_length) for piece in beam.pieces]
    low, span = min(sizes), max(sizes) - min(sizes)
    if span == 0.0:
        return [8.0] * len(sizes)
    return [LEAST + (MOST - LEAST) * (size - low) / span for size in sizes]


def _half(beam: "Beam", x: float) -> float:
    """Half the height of the beam as it is drawn at x."""
    end = 0.0
    heights = _heights(beam)
    for piece, height in zip(beam.pieces, heights, strict=True):
        end += piece.length
        if x <= end * (1.0 + 1e-12):
            return 0.5 * height
    return 0.5 * heights[-1]


def _pieces(view: View) -> Iterator[Drawn]:
    beam, start = view.beam, 0.0
    for piece, height in zip(beam.pieces, _heights(beam), strict=True):
        x, width = view.at(start), view.at(piece.length) - view.edge
        yield (
            f'<rect x="{x:.1f}" y="{-0.5 * height:.1f}" width="{width:.1f}" height="{height:.1f}" '
            f'fill="{BODY}" fill-opacity=".35" stroke="{BODY}"/>'
        )
        yield Box(x, -0.5 * height, x + width, 0.5 * height)
        start += piece.length
    if len(beam.pieces) == 1:
        yield Label(0.5 * view.width, 14.0, (_section_words(beam.pieces[0], beam),), down=True)


def _section_words(piece: "Piece", beam: "Beam") -> str:
    if beam.thickness is not None and beam.width is not None:
        return f"{_metres(beam.width)} × {_metres(beam.thickness)}"
    if beam.diameter is not None:
        return f"⌀ {_metres(beam.diameter)}"
    return f"EI = {piece.bending_stiffness:.4g} N m²"


def _supports(view: View) -> Iterator[Drawn]:
    beam = view.beam
    ends: tuple[tuple[float, Support, float], ...] = ((0.0, beam.supports[0], -1.0), (beam.length, beam.supports[1], 1))
    for x, support, out in ends:
        at, half = view.at(x), _half(beam, x)
        if support == "clamped":
            yield from _wall(at, out, half)
        elif support == "guided":
            yield from _wall(at + 9 * out, out, half)
            for up in (-0.5, 0.5):
                yield f'<circle cx="{at + 4.5 * out:.1f}" cy="{16 * up:.1f}" r="3.5" stroke="{INK}"/>'
        elif support == "pinned":
            yield from _foot(at, half, rolls=out > 0)
        yield Label(at, half + 8.0, (support,), down=True)


def _wall(at: float, out: float, half: float) -> Iterator[Drawn]:
    tall = half + 16
    yield _line((at, -tall), (at, tall), width=2)
    yield Box(min(at, at + 9 * out), -tall, max(at, at + 9 * out), tall + 7)
    for k in range(6):
        y = -tall + 2 * tall * (k + 0.5) / 6
        yield _line((at, y), (at + 9 * out, y + 7), colour=SOFT, width=1)


def _foot(at: float, half: float, *, rolls: bool) -> Iterator[Drawn]:
    y = half
    yield _line((at, y), (at - 11, y + 18), (at + 11, y + 18), (at, y), more=' stroke-linejoin="round"')
    if rolls:
        yield f'<circle cx="{at - 6:.1f}" cy="{y + 22:.1f}" r="3.2" stroke="{INK}"/>'
        yield f'<circle cx="{at + 6:.1f}" cy="{y + 22:.1f}" r="3.2" stroke="{INK}"/>'
    ground = y + (27 if rolls else 19)
    yield _line((at - 16, ground), (at + 16, ground), colour=SOFT)
    yield Box(at - 16, y, at + 16, ground)


def _springs(view: View) -> Iterator[Drawn]:
    for spring in view.beam.spring:
        at, half = view.at(spring.position), _half(view.beam, spring.position)
        if spring.stiffness:
            zigzag = [(at + (6 if k % 2 else -6), half + 8 + 4 * k) for k in range(6)]
            yield _line((at, half), (at, half + 5), *zigzag, (at, half + 32), (at, half + 36), colour=SPRING)
            yield _line((at - 11, half + 36), (at + 11, half + 36), colour=SOFT)
            yield Box(at - 11, half, at + 11, half + 37)
            yield Label(at, half + 40, (f"{spring.stiffness:.4g} N/m",), down=True)
        if spring.rotational:
            yield f'<path d="M{at + 12:.1f} 0a12 12 0 1 1 -12 -12" stroke="{SPRING}" stroke-width="1.6"/>'
            yield Box(at - 12, -12, at + 12, 12)
            yield Label(at, -half - 10, (f"{spring.rotational:.4g} N m/rad",))


def _devices(scene: "Scene", view: View) -> Iterator[Drawn]:
    """Above the beam, clear of its supports, a dashpot to the ground; what the device has in words."""
    for device in scene.devices:
        at, y = view.at(device.position), -_half(view.beam, device.position)
        cup, ground = y - 12, y - 36
        yield _line((at, y), (at, cup - 8), colour=SPRING)
        yield _line((at - 5, cup - 8), (at + 5, cup - 8), colour=SPRING)
        yield _line((at - 8, cup), (at - 8, cup - 16), (at + 8, cup - 16), (at + 8, cup), colour=SPRING)
        yield _line((at, cup - 16), (at, ground), colour=SPRING)
        yield _line((at - 12, ground), (at + 12, ground), colour=SOFT)
        yield Box(at - 12, ground - 1, at + 12, y)
        yield Label(at, ground - 4, (f"x = {_metres(device.position)}", *_device_words(device)))


def _device_words(device: "Device") -> tuple[str, ...]:
    """Each thing that it has."""
    units = {
        "dashpot": "N s/m",
        "stiffness": "N/m",
        "mass": "kg",
        "rotational_dashpot": "N m s",
        "rotational": "N m/rad",
        "rotary_inertia": "kg m²",
        "amplitude": "N",
    }
    return tuple(f"{value:.4g} {unit}" for name, unit in units.items() if (value := getattr(device, name)))


def _masses(view: View) -> Iterator[Drawn]:
    for mass in view.beam.mass:
        at, y = view.at(mass.position), -_half(view.beam, mass.position)
        yield f'<circle cx="{at:.1f}" cy="{y - 9:.1f}" r="9" fill="{INK}" fill-opacity=".75"/>'
        yield Box(at - 9, y - 18, at + 9, y)
        words = [f"{mass.mass:.4g} kg"] * bool(mass.mass)
        words += [f"{mass.rotary_inertia:.4g} kg m²"] * bool(mass.rotary_inertia)
        yield Label(at, y - 20, tuple(words))


def _tension(view: View) -> Iterator[Drawn]:
    if not view.beam.tension:
        return
    pull = view.beam.tension > 0
    for at, out in ((view.edge - 8, -1.0), (view.width - view.edge + 8, 1.0)):
        near, far = at + 6 * out, at + 36 * out
        yield from _arrow((near if pull else far, 0.0), (far if pull else near, 0.0), SPRING)
        yield Box(min(near, far), -4, max(near, far), 4)
    yield Label(view.width - 4, -8, (f"{view.beam.tension:.4g} N",))


def _foundation(view: View) -> Iterator[Drawn]:
    if not view.beam.foundation:
        return
    left, right, n = view.edge, view.width - view.edge, int(view.width / 34)
    for k in range(n):
        at = left + (right - left) * (k + 0.5) / n
        yield _line((at, 0.0), (at - 4, 14.0), (at + 4, 22.0), (at, 34.0), colour=SOFT, width=0.9)
    yield _line((left, 34.0), (right, 34.0), colour=SOFT)
    yield Box(left, 0.0, right, 35.0)
    yield Label(0.5 * view.width, 36.0, (f"foundation {view.beam.foundation:.4g} N/m²",), down=True)


def _arrow(tail: tuple[float, float], head: tuple[float, float], colour: str) -> Iterator[str]:
    """A shaft with a head."""
    (x0, y0), (x1, y1) = tail, head
    size = 6.0 / max(((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5, 1e-9)
    ux, uy = size * (x1 - x0), size * (y1 - y0)
    yield _line(tail, (x1 - ux, y1 - uy), colour=colour, width=2)
    points = f"{x1:.1f},{y1:.1f} {x1 - 1.5 * ux - 0.7 * uy:.1f},{y1 - 1.5 * uy + 0.7 * ux:.1f} "
    yield f'<polygon points="{points}{x1 - 1.5 * ux + 0.7 * uy:.1f},{y1 - 1.5 * uy - 0.7 * ux:.1f}" fill="{colour}"/>'


def _forces(scene: "Scene", view: View) -> Iterator[Drawn]:
    """Arrows that stand on the beam, or on what it carries there."""
    if scene.drive is None:
        return
    unit = "N" if scene.drive.kind == "force" else "m"
    for force in scene.forces:
        at, y = view.at(force.position), -_half(view.beam, force.position) - _carried(scene, view, force.position)
        yield from _arrow((at, y - ARROW), (at, y - 2), FORCE)
        yield Box(at - 5, y - ARROW, at + 5, y)
        phase = f", {force.phase_deg:g}°" if force.phase_deg else ""
        yield Label(at, y - ARROW - 2, (f"x = {_metres(force.position)}", f"{force.amplitude:.4g} {unit}{phase}"))
    yield Label(0.5 * view.width, -MOST - ARROW, (f"driven at {scene.drive.frequency_hz:g} Hz",))


def _carried(scene: "Scene", view: View, x: float) -> float:
    """Height of what the beam carries at x: a body, the slider."""
    near = 20.0 / (view.width - 2 * view.edge) * view.beam.length
    slider = scene.slider.start_on(view.beam) if scene.slider is not None else None
    if any(abs(mass.position - x) < 0.5 * near for mass in view.beam.mass):
        return 18.0
    if scene.slider is not None and scene.slider.foot:
        return PLATE + TOOTH if any(_stands_over(foot, slider or 0.0, x, near) for foot in scene.slider.foot) else 0.0
    return 17.0 if slider is not None and abs(slider - x) < near else 0.0


def _stands_over(foot: "Foot", start: float, x: float, near: float) -> bool:
    return foot.face == "upper" and abs(start + foot.offset - x) < 0.5 * (foot.length + near)


def _slider(slider: "Slider", view: View) -> Iterator[Drawn]:
    if slider.foot:
        yield from _feet(slider, view)
        return
    x = slider.start_on(view.beam)
    at, y = view.at(x), -_half(view.beam, x)
    yield f'<rect x="{at - 16:.1f}" y="{y - 17:.1f}" width="32" height="16" rx="2" fill="{STAGE}" fill-opacity=".8"/>'
    yield Box(at - 16, y - 17, at + 16, y)
    yield Label(at, y - 19, (f"slider, {in_words(1e3 * slider.mass, 'g', '.4g')}, mu {slider.mu:g}",))


def _feet(slider: "Slider", view: View) -> Iterator[Drawn]:
    """Feet on the faces that they stand on, with a tooth for every contact point; a second beam over mirrored ones."""
    x = slider.start_on(view.beam)
    tops = []
    for foot in slider.foot:
        middle = x + foot.offset
        half, up = _half(view.beam, middle), 1.0 if foot.face == "lower" else -1.0
        length = max(view.at(foot.length) - view.edge, POINT_FOOT)
        left = view.at(middle) - 0.5 * length
        near, far = up * half, up * (half + TOOTH + PLATE)
        yield _plate(left, length, up * (half + TOOTH))
        for k in range(min(foot.points, TEETH)):
            at = left + length * (k + 0.5) / min(foot.points, TEETH)
            yield _line((at, near), (at, up * (half + TOOTH)), colour=STAGE)
            if foot.mirrored:
                yield _line((at, far), (at, far - TOOTH), colour=STAGE)
        if foot.mirrored:
            far -= TOOTH + 2.0 * half
            yield (
                f'<rect x="{left - 12:.1f}" y="{far:.1f}" width="{length + 24:.1f}" height="{2 * half:.1f}" '
                f'fill="{BODY}" fill-opacity=".2" stroke="{BODY}" stroke-dasharray="4 3"/>'
            )
        yield Box(left, min(near, far), left + length, max(near, far))
        tops.append(min(near, far))
    words = f"slider on {len(slider.foot)} f{'ee' if len(slider.foot) > 1 else 'oo'}t"
    yield Label(view.at(x), min(tops) - 3, (f"{words}, {in_words(1e3 * slider.mass, 'g', '.4g')}, mu {slider.mu:g}",))


def _plate(left: float, length: float, edge: float) -> str:
    top = edge if edge > 0 else edge - PLATE
    return (
        f'<rect x="{left:.1f}" y="{top:.1f}" width="{length:.1f}" height="{PLATE:g}" rx="2" fill="{STAGE}" '
        'fill-opacity=".8"/>'
    )


def _length(view: View, y: float) -> Iterator[str]:
    left, right = view.edge, view.width - view.edge
    yield _line((left, y), (right, y), colour=SOFT, width=1)
    for at in (left, right):
        yield _line((at, y - 5), (at, y + 5), colour=SOFT, width=1)
    yield words_at(0.5 * view.width, y - 6, _metres(view.beam.length))
