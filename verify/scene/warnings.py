"""Plausibility warnings: values that look like another unit."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from verify.scene.model import Scene

if TYPE_CHECKING:
    from verify.problem.beam import Beam
    from verify.problem.cross_section import Piece

SOUND = (30.0, 30_000.0)  # sqrt(E/rho) of materials, soft rubber to diamond, m/s
MAX_DENSITY = 25_000.0  # above osmium, kg/m^3
MAX_WIDTH = 5.0  # of a strip over its length
MAX_MASS = 1e5  # kg; a beam in millimetres read as metres has 1e9 times its mass
LONG = 5.0  # m; no beam in millimetres is shorter than this when read as metres
GRAVITY = 9.81


def unit_warnings(scene: Scene) -> tuple[str, ...]:
    """A sentence for each value that looks like another unit."""
    beam = scene.beam
    found = dict.fromkeys(one for piece in beam.pieces for one in _material(piece))
    return (*found, *_lengths(beam))


def _material(piece: "Piece") -> Iterator[str]:
    if piece.youngs_modulus is None or not piece.area:
        return
    density = piece.mass_per_length / piece.area
    speed = (piece.youngs_modulus / density) ** 0.5
    if not SOUND[0] <= speed <= SOUND[1]:
        yield (
            f"beam.youngs_modulus = {piece.youngs_modulus:.6g} Pa and beam.density = {density:.6g} kg/m³ give a speed "
            f"of sound of {speed:.3g} m/s: check the units (206 GPa is 206e9, 7.85 g/cm³ is 7850)"
        )
    elif density > MAX_DENSITY:
        yield f"beam.density = {density:.6g} kg/m³ is above that of any solid: check the unit (7.85 g/cm³ is 7850)"


def _lengths(beam: "Beam") -> Iterator[str]:
    """Thicker or much wider than long, too heavy, or bent by its own weight by more than its length."""
    known = [(2.0 * piece.extreme_fibre, piece.area) for piece in beam.pieces if piece.extreme_fibre and piece.area]
    thickness = max((height for height, _ in known), default=0.0)
    width = max((area / height for height, area in known), default=0.0)
    mass = sum(piece.mass_per_length * piece.length for piece in beam.pieces)
    if thickness > beam.length:
        yield f"beam: {thickness:.3g} m thick and {beam.length:.3g} m long, check the units (2 mm is 0.002)"
    elif width > MAX_WIDTH * beam.length:
        yield f"beam: {width:.3g} m wide and {beam.length:.3g} m long, check the units (20 mm is 0.02)"
    if beam.length < LONG:
        return
    if mass > MAX_MASS:
        yield f"beam: a mass of {1e-3 * mass:.3g} t, check the units (137 mm is 0.137)"
    elif not (beam.tension or beam.foundation or beam.spring):
        stiffness = min(piece.bending_stiffness for piece in beam.pieces)
        sag = 5.0 / 384.0 * mass / beam.length * GRAVITY * beam.length**4 / stiffness
        if sag > beam.length:
            yield f"beam: its own weight bends it by {sag:.3g} m, check the units (137 mm is 0.137)"
