"""What looks like another unit in a scene, and what is asked in vain: remarks, which refuse nothing."""

from typing import TYPE_CHECKING

from verify.beam import Beam
from verify.words import number

if TYPE_CHECKING:
    from collections.abc import Iterator

    from verify.scenes.scene import Scene
    from verify.section import Piece

SOUND = (30.0, 30_000.0)
"""Speeds of sound along a bar, sqrt(E/rho), that materials have, from soft rubber to diamond, m/s."""
DENSE = 25_000.0
"""Above osmium, kg/m^3."""
WIDE = 5.0
"""Times its length: a strip so wide is none."""
HEAVY_KG = 1e5
"""A beam in millimetres that is read as metres weighs a thousand million times as much as it does."""
LONG_M = 5.0
"""Below it nobody gave millimetres for metres."""
GRAVITY = 9.81


def remarks_on(scene: "Scene") -> tuple[str, ...]:
    """A sentence for each field that looks like another unit, each section in vain, each gate judged by too little."""
    beam = scene.beam
    materials = dict.fromkeys(said for piece in beam.pieces if (said := _material(piece)))
    return (*materials, *_lengths(beam), *_in_vain(scene), *_uncertain(scene))


def _uncertain(scene: "Scene") -> "Iterator[str]":
    """Gates whose reference is known less well than they judge."""
    for gate in scene.gate:
        if gate.within is not None and gate.uncertainty is not None and gate.uncertainty > gate.within:
            yield (
                f"gate.{gate.id}.uncertainty = {gate.uncertainty:g} is more than its within = {gate.within:g}: its "
                "reference may lie outside the band itself, widen the band or find a better one"
            )


def _in_vain(scene: "Scene") -> "Iterator[str]":
    """Sections of a study's own that has nothing to find in such a scene."""
    from verify.studies.catalogue import STUDIES

    for name in STUDIES.built_in:
        own = getattr(scene, name, None) if STUDIES[name].section is not None else None
        if own is not None and STUDIES[name].asked(scene) is None:
            yield f"[{name}] is left out: {STUDIES[name].skipped(scene)}"


def _material(piece: "Piece") -> str:
    """That sound would be slower or faster in it than in anything."""
    if piece.youngs_modulus is None or not piece.area:
        return ""
    density = piece.mass_per_length / piece.area
    speed = (piece.youngs_modulus / density) ** 0.5
    if SOUND[0] <= speed <= SOUND[1]:
        heavier = f"beam.density = {number(density, 6)} is read as kg/m³: no solid has more than {DENSE:g}"
        return f"{heavier}; 7.85 g/cm³ is 7850 kg/m³" if density > DENSE else ""
    return (
        f"beam.youngs_modulus = {number(piece.youngs_modulus, 6)} and beam.density = {number(density, 6)} are read as "
        f"Pa and kg/m³: sound would travel at {_short(speed)} m/s in this material; 206 GPa is 206e9 Pa, 7.85 g/cm³ is "
        "7850 kg/m³"
    )


def _lengths(beam: Beam) -> "Iterator[str]":
    """That it is thicker than long, heavier than what is built in one piece, or cannot bear its own weight."""
    known = [(2.0 * piece.extreme_fibre, piece.area) for piece in beam.pieces if piece.extreme_fibre and piece.area]
    thick = max((height for height, _ in known), default=0.0)
    wide = max((area / height for height, area in known), default=0.0)
    if thick > beam.length:
        yield f"{_read_so(beam)}: it would be {_short(thick)} m thick and {_short(beam.length)} m long; 2 mm is 0.002 m"
    elif wide > WIDE * beam.length:
        yield f"{_read_so(beam)}: it would be {_short(wide)} m wide and {_short(beam.length)} m long; 20 mm is 0.02 m"
    if beam.length < LONG_M:
        return
    mass = sum(piece.mass_per_length * piece.length for piece in beam.pieces)
    if mass > HEAVY_KG:
        yield f"{_read_so(beam)}: it would weigh {_short(1e-3 * mass)} t; 137 mm is 0.137 m"
    elif (sag := _sag(beam)) > beam.length:
        yield f"{_read_so(beam)}: its own weight would bend it by {_short(sag)} m; 137 mm is 0.137 m"


def _read_so(beam: Beam) -> str:
    sizes = {"length": beam.length, "width": beam.width, "thickness": beam.thickness, "diameter": beam.diameter}
    told = [f"beam.{name} = {number(value, 6)}" for name, value in sizes.items() if value is not None]
    return f"{', '.join(told)} {'are' if len(told) > 1 else 'is'} read as metres"


def _short(value: float) -> str:
    """To three digits, without a power of ten where a person writes none."""
    return f"{float(f'{value:.3g}'):.0f}" if 100.0 <= value < 1e7 else f"{value:.3g}"


def _sag(beam: Beam) -> float:
    """5 q L⁴ / 384 EI of its softest stretch; nothing where something else bears it."""
    if beam.tension or beam.foundation or beam.spring:
        return 0.0
    line = sum(piece.mass_per_length * piece.length for piece in beam.pieces) / beam.length
    stiffness = min(piece.bending_stiffness for piece in beam.pieces)
    return float(5.0 / 384.0 * line * GRAVITY * beam.length**4 / stiffness)
