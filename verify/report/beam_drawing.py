"""A drawing of a scene's beam as SVG: supports, sections, what stands on it, forces, the slider, all where they are.

Lengths along the beam are to scale; heights are not, but sections keep their order of thickness. Lines follow the page.
"""

from collections.abc import Iterator
from math import log10
from typing import TYPE_CHECKING

from verify.options import Support

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.scenes.scene import Scene
    from verify.section import Piece
    from verify.slider import Slider

WIDTH, HEIGHT, EDGE = 860.0, 190.0, 60.0
AXIS = 105.0
"""Height of the neutral line in the picture, downwards."""
LEAST, MOST = 5.0, 24.0
"""Thickness of the thinnest and the thickest section."""
INK, SOFT, BODY, FORCE, SPRING = "var(--ink)", "var(--soft)", "var(--bar)", "#d6427a", "#2a9d5c"


def beam_drawing(scene: "Scene") -> str:
    """The whole picture."""
    beam = scene.beam
    parts = [*_foundation(beam), *_pieces(beam), *_supports(beam), *_springs(beam), *_masses(beam), *_tension(beam)]
    if scene.slider is not None:
        parts += _slider(scene.slider, beam)
    parts += _forces(scene)
    parts += _length(beam)
    return (
        f'<svg viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{_told(scene)}" '
        f'style="width:100%;max-width:{WIDTH:g}px;display:block;margin:auto" font-size="12" fill="none">'
        f"{''.join(parts)}</svg>"
    )


def _told(scene: "Scene") -> str:
    """The picture in words."""
    beam = scene.beam
    words = [f"A beam of {_metres(beam.length)}, {beam.supports[0]} at the left and {beam.supports[1]} at the right"]
    counts = {"sections": beam.section, "bodies": beam.mass, "springs": beam.spring, "forces": scene.forces}
    words += [f"{len(found)} {name}" for name, found in counts.items() if found]
    return ", ".join([*words, *(["a slider"] if scene.slider else [])])


def _place(beam: "Beam", x: float) -> float:
    return EDGE + (WIDTH - 2 * EDGE) * x / beam.length


def _metres(x: float) -> str:
    """A length with a unit that suits it."""
    for limit, factor, unit in ((1e-6, 1e9, "nm"), (1e-3, 1e6, "µm"), (1.0, 1e3, "mm"), (1e3, 1.0, "m")):
        if x < limit:
            return f"{factor * x:.4g} {unit}"
    return f"{1e-3 * x:.4g} km"


def _line(*points: tuple[float, float], colour: str = INK, width: float = 1.4, more: str = "") -> str:
    d = "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points)
    return f'<path d="{d}" stroke="{colour}" stroke-width="{width:g}"{more}/>'


def _text(x: float, y: float, words: str, anchor: str = "middle", colour: str = SOFT) -> str:
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}">{words}</text>'


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


def _pieces(beam: "Beam") -> Iterator[str]:
    start = 0.0
    for piece, height in zip(beam.pieces, _heights(beam), strict=True):
        x, width = _place(beam, start), _place(beam, piece.length) - EDGE
        yield (
            f'<rect x="{x:.1f}" y="{AXIS - 0.5 * height:.1f}" width="{width:.1f}" height="{height:.1f}" '
            f'fill="{BODY}" fill-opacity=".35" stroke="{BODY}"/>'
        )
        start += piece.length
    if len(beam.pieces) == 1:
        yield _text(0.5 * WIDTH, AXIS + 27, _section_words(beam.pieces[0], beam))


def _section_words(piece: "Piece", beam: "Beam") -> str:
    if beam.thickness is not None and beam.width is not None:
        return f"{_metres(beam.width)} × {_metres(beam.thickness)}"
    if beam.diameter is not None:
        return f"⌀ {_metres(beam.diameter)}"
    return f"EI = {piece.bending_stiffness:.4g} N m²"


def _supports(beam: "Beam") -> Iterator[str]:
    kinds: dict[Support, int] = {}
    for x, support, out in ((0.0, beam.supports[0], -1.0), (beam.length, beam.supports[1], 1.0)):
        kinds[support] = kinds.get(support, 0) + 1
        at, half = _place(beam, x), _half(beam, x)
        if support == "clamped":
            yield from _wall(at, out, half)
        elif support == "guided":
            yield from _wall(at + 9 * out, out, half)
            for up in (-0.5, 0.5):
                yield f'<circle cx="{at + 4.5 * out:.1f}" cy="{AXIS + 16 * up:.1f}" r="3.5" stroke="{INK}"/>'
        elif support == "pinned":
            yield from _foot(at, half, rolls=out > 0)
        yield _text(at, AXIS + (62 if support == "pinned" else 44), support)


def _wall(at: float, out: float, half: float) -> Iterator[str]:
    tall = half + 16
    yield _line((at, AXIS - tall), (at, AXIS + tall), width=2)
    for k in range(6):
        y = AXIS - tall + 2 * tall * (k + 0.5) / 6
        yield _line((at, y), (at + 9 * out, y + 7), colour=SOFT, width=1)


def _foot(at: float, half: float, *, rolls: bool) -> Iterator[str]:
    y = AXIS + half
    yield _line((at, y), (at - 11, y + 18), (at + 11, y + 18), (at, y), more=' stroke-linejoin="round"')
    if rolls:
        yield f'<circle cx="{at - 6:.1f}" cy="{y + 22:.1f}" r="3.2" stroke="{INK}"/>'
        yield f'<circle cx="{at + 6:.1f}" cy="{y + 22:.1f}" r="3.2" stroke="{INK}"/>'
    ground = y + (27 if rolls else 19)
    yield _line((at - 16, ground), (at + 16, ground), colour=SOFT)


def _springs(beam: "Beam") -> Iterator[str]:
    for spring in beam.spring:
        at, y = _place(beam, spring.position), AXIS + _half(beam, spring.position)
        if spring.stiffness:
            zigzag = [(at + (6 if k % 2 else -6), y + 8 + 4 * k) for k in range(6)]
            yield _line((at, y), (at, y + 5), *zigzag, (at, y + 32), (at, y + 36), colour=SPRING)
            yield _line((at - 11, y + 36), (at + 11, y + 36), colour=SOFT)
            yield _text(at, y + 50, f"{spring.stiffness:.4g} N/m")
        if spring.rotational:
            yield f'<path d="M{at + 12:.1f} {AXIS:.1f}a12 12 0 1 1 -12 -12" stroke="{SPRING}" stroke-width="1.6"/>'
            yield _text(at, AXIS - 20, f"{spring.rotational:.4g} N m/rad")


def _masses(beam: "Beam") -> Iterator[str]:
    for mass in beam.mass:
        at, y = _place(beam, mass.position), AXIS - _half(beam, mass.position)
        yield f'<circle cx="{at:.1f}" cy="{y - 9:.1f}" r="9" fill="{INK}" fill-opacity=".75"/>'
        words = [f"{mass.mass:.4g} kg"] * bool(mass.mass) + [f"{mass.rotary_inertia:.4g} kg m²"] * bool(
            mass.rotary_inertia
        )
        anchor = "end" if at > WIDTH - 2 * EDGE else "start" if at < 2 * EDGE else "middle"
        yield _text(at, y - 24, ", ".join(words), anchor)


def _tension(beam: "Beam") -> Iterator[str]:
    if not beam.tension:
        return
    pull = 1.0 if beam.tension > 0 else -1.0
    for at, out in ((EDGE - 8, -1.0), (WIDTH - EDGE + 8, 1.0)):
        tail, head = (at + 12 * out, at + 40 * out) if pull > 0 else (at + 40 * out, at + 12 * out)
        yield from _arrow((tail, AXIS), (head, AXIS), SPRING)
    yield _text(WIDTH - 4, AXIS - 10, f"{beam.tension:.4g} N", "end")


def _foundation(beam: "Beam") -> Iterator[str]:
    if not beam.foundation:
        return
    y = AXIS + 34
    for k in range(25):
        at = EDGE + (WIDTH - 2 * EDGE) * (k + 0.5) / 25
        yield _line((at, AXIS), (at - 4, AXIS + 14), (at + 4, AXIS + 22), (at, y), colour=SOFT, width=0.9)
    yield _line((EDGE, y), (WIDTH - EDGE, y), colour=SOFT)
    yield _text(0.5 * WIDTH, y + 28, f"foundation {beam.foundation:.4g} N/m²")


def _arrow(tail: tuple[float, float], head: tuple[float, float], colour: str) -> Iterator[str]:
    """A shaft with a head."""
    (x0, y0), (x1, y1) = tail, head
    size = 6.0 / max(((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5, 1e-9)
    ux, uy = size * (x1 - x0), size * (y1 - y0)
    yield _line(tail, (x1 - ux, y1 - uy), colour=colour, width=2)
    points = f"{x1:.1f},{y1:.1f} {x1 - 1.5 * ux - 0.7 * uy:.1f},{y1 - 1.5 * uy + 0.7 * ux:.1f} "
    yield f'<polygon points="{points}{x1 - 1.5 * ux + 0.7 * uy:.1f},{y1 - 1.5 * uy - 0.7 * ux:.1f}" fill="{colour}"/>'


def _forces(scene: "Scene") -> Iterator[str]:
    if scene.drive is None:
        return
    unit, beam = ("N" if scene.drive.kind == "force" else "m"), scene.beam
    for force in scene.forces:
        at, y = _place(beam, force.position), AXIS - _half(beam, force.position)
        yield from _arrow((at, y - 46), (at, y - 2), FORCE)
        phase = f", {force.phase_deg:g}°" if force.phase_deg else ""
        yield _text(at, y - 53, f"{force.amplitude:.4g} {unit}{phase}", colour=FORCE)
        yield _text(at, y - 67, f"x = {_metres(force.position)}")
    yield _text(0.5 * WIDTH, 20, f"{scene.drive.frequency_hz:g} Hz")


def _slider(slider: "Slider", beam: "Beam") -> Iterator[str]:
    x = slider.start_on(beam)
    at, y = _place(beam, x), AXIS - _half(beam, x)
    yield f'<rect x="{at - 16:.1f}" y="{y - 17:.1f}" width="32" height="16" rx="2" fill="#e8760c" fill-opacity=".8"/>'
    yield _text(at, y - 24, f"slider, {1e3 * slider.mass:.4g} g, mu {slider.mu:g}")


def _length(beam: "Beam") -> Iterator[str]:
    y = HEIGHT - 14
    yield _line((EDGE, y), (WIDTH - EDGE, y), colour=SOFT, width=1)
    for at in (EDGE, WIDTH - EDGE):
        yield _line((at, y - 5), (at, y + 5), colour=SOFT, width=1)
    yield _text(0.5 * WIDTH, y - 4, _metres(beam.length))
