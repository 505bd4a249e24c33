"""Units: what no beam is, in any unit that its values may be meant in. Closed forms, microseconds."""

from math import pi, sqrt

from verify.analysis.verdict import Margin, three_digits, void
from verify.exact.closed_forms import wavenumber_length
from verify.problem.beam import Beam

SOUND = 20.0, 30_000.0
"""sqrt(E/rho) of solids, m/s: soft rubber and foam 30, lead 1200, steel 5100, beryllium 12 600, diamond 17 300."""
MAX_DENSITY = 25_000.0
"""Above osmium, kg/m^3."""
MAX_WIDTH = 5.0
"""Of a strip over its length."""
SLOWEST, LOWEST = 3e-3, 1e-3
"""Speed of the wave of mode 1, m/s, and frequency, Hz, below those of any beam that stands without tension: a steel
tape of 5 m x 0.1 mm has 0.09 m/s and 9 mHz."""
GRAVITY = 9.81
HEAVY, SOFT = 1e5, 0.02
"""A solid piece above 100 t, kg, and its deflection under its own weight over its length, g / (omega_1^2 L): a ship's
shaft of 60 m and 300 t has 0.017, a leaf spring in millimetres read as metres 2.5 and more."""
SLENDER, MAX_SOLID, MAX_MASS = 5.0, 1e6, 2e7
"""Length over thickness of what is no block. Mass, kg, above any solid bar's of metal, glass or fibres (ingots end at
600 t), and above that of any beam of one section: a gram in millimetres read as metres is 1000 t."""
STRUCTURAL = 2600.0, 4000.0
"""Density, kg/m^3, or speed of sound, m/s, from which a material is not concrete, stone or plastic."""


def unit_margins(beam: Beam) -> list[Margin]:
    """A void margin that leads where values of the beam look like another unit, else none.

    Sag alone says nothing: a fishing rod sags and a bridge does not. Large structures have a stiffness and a mass per
    length, or a tension, and their waves and frequencies stay within the bounds.
    """
    problem = _material(beam) or _sizes(beam) or _wave(beam) or _weight(beam)
    return [void("units", f"a unit is wrong: {problem[0]}", f"give {problem[1]}", leads=True)] if problem else []


def _material(beam: Beam) -> tuple[str, str] | None:
    for piece in beam.pieces:
        if piece.youngs_modulus is None or not piece.area:
            continue
        density = piece.mass_per_length / piece.area
        speed, values = sqrt(piece.youngs_modulus / density), f"beam.density = {density:.6g} kg/m³"
        if not SOUND[0] <= speed <= SOUND[1]:
            both = f"beam.youngs_modulus = {piece.youngs_modulus:.6g} Pa and {values}"
            sound = f"a speed of sound of {three_digits(speed)} m/s, in solids it is {SOUND[0]:g} to {SOUND[1]:g} m/s"
            return f"{both} give {sound}", "pascals and kg/m³: 206 GPa is 206e9, 7.85 g/cm³ is 7850"
        if density > MAX_DENSITY:
            return f"{values} is above that of any solid", "kg/m³: 7.85 g/cm³ is 7850"
    return None


def _sizes(beam: Beam) -> tuple[str, str] | None:
    solid = [(2.0 * piece.extreme_fibre, piece.area) for piece in beam.pieces if piece.extreme_fibre and piece.area]
    thickness, length = max((height for height, _ in solid), default=0.0), f"{beam.length:.3g} m long"
    width = max((area / height for height, area in solid), default=0.0)
    if thickness > beam.length:
        return f"the beam is {thickness:.3g} m thick and {length}", "metres: 2 mm is 0.002"
    if width > MAX_WIDTH * beam.length:
        return f"the beam is {width:.3g} m wide and {length}", "metres: 20 mm is 0.02"
    return None


def _frequency(beam: Beam) -> float:
    """The first frequency as a uniform beam of the stiffest and lightest of its pieces, Hz: none is higher."""
    stiff = max(piece.bending_stiffness for piece in beam.pieces)
    light = min(piece.mass_per_length for piece in beam.pieces)
    return (wavenumber_length(beam.supports, 1) / beam.length) ** 2 * sqrt(stiff / light) / (2.0 * pi)


def _wave(beam: Beam) -> tuple[str, str] | None:
    hertz, remedy = _frequency(beam), "N m² and kg/m: 1 N mm² is 1e-6, 1 g/mm is 1"
    speed = 2.0 * pi * hertz * beam.length / wavenumber_length(beam.supports, 1)
    if beam.youngs_modulus is not None:
        remedy = "metres: 137 mm is 0.137"
    if speed > SOUND[1]:
        return f"bending waves of mode 1 travel at {three_digits(speed)} m/s, faster than sound in any solid", remedy
    held = beam.tension > 0.0 or beam.foundation or beam.spring
    if not held and (speed < SLOWEST or hertz < LOWEST):
        return f"a beam of {beam.length:.3g} m has a first frequency of {hertz:.2g} Hz", remedy
    return None


def _weight(beam: Beam) -> tuple[str, str] | None:
    """A solid bar of more than any bar's mass, or one that is heavy and far too soft for it."""
    piece, mass = beam.base_section, sum(piece.mass_per_length * piece.length for piece in beam.pieces)
    if piece.youngs_modulus is None or not piece.area or not piece.extreme_fibre:
        return None
    density, hollow = piece.mass_per_length / piece.area, beam.shape == "tube"
    structural = density >= STRUCTURAL[0] or sqrt(piece.youngs_modulus / density) >= STRUCTURAL[1]
    slender = beam.length > SLENDER * 2.0 * piece.extreme_fibre
    free = not (hollow or beam.tension > 0.0 or beam.foundation or beam.spring)
    soft = GRAVITY / ((2.0 * pi * _frequency(beam)) ** 2 * beam.length)
    if mass > MAX_MASS or (mass > MAX_SOLID and structural and slender and not hollow):
        why = f"a mass of {three_digits(1e-3 * mass)} t"
    elif free and mass > HEAVY and soft > SOFT:
        why = f"a mass of {three_digits(1e-3 * mass)} t at a first frequency of {_frequency(beam):.2g} Hz"
    else:
        return None
    return f"a beam of {beam.length:.3g} m x {2.0 * piece.extreme_fibre:.3g} m has {why}", "metres: 137 mm is 0.137"
