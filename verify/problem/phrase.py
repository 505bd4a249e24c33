"""A beam in one line: '1 m x 40 x 8 mm steel, clamped-free'."""

import re
from typing import Any

from verify.errors import InputError, shown
from verify.options import SUPPORTS
from verify.problem.beam import Beam
from verify.problem.materials import material_named
from verify.units import LENGTHS, NUMBER, in_si

EXAMPLE = "'1 m x 40 x 8 mm steel, clamped-free'"
SIZE = rf"(?:(round|tube)\s+)?({NUMBER})\s*({'|'.join(LENGTHS)})?\b"
SHAPES = {(None, 2): ("width", "thickness"), ("round", 1): ("diameter",), ("tube", 2): ("diameter", "wall_thickness")}
"""Fields by the word before a section's sizes and their number."""
CONSTANTS = {"E": ("youngs_modulus", "Pa"), "rho": ("density", "kg/m^3"), "nu": ("poissons_ratio", "1")}


def beam_from(phrase: str) -> Beam:
    """A uniform beam from its length and section, material and supports.

    'LENGTH x WIDTH x THICKNESS MATERIAL, LEFT-RIGHT', for a round section 'LENGTH x round DIAMETER', for a tube
    'LENGTH x tube DIAMETER x WALL'. A size without a unit has that of the next one. The material is one of
    `materials.MATERIALS`, or E=69GPa rho=2.7g/cm3 with nu=0.3 where shear is of interest. 'cantilever' is
    clamped-free. Raises InputError.
    """
    body, comma, ends = phrase.rpartition(",")
    if not comma:
        raise InputError(f"beam = {shown(phrase)} names no supports: write {EXAMPLE}")
    sizes, rest = [], body.strip()
    while found := re.match(SIZE, rest):
        sizes.append(found.groups())
        rest = rest[found.end() :].lstrip()
        if not (times := re.match(r"[x×]\s*", rest)):
            break
        rest = rest[times.end() :]
    fields = SHAPES.get((sizes[1][0] if len(sizes) > 1 else None, len(sizes) - 1))
    if fields is None or sizes[-1][2] is None:
        raise InputError(f"beam = {shown(phrase)}: write length and section with units, {EXAMPLE}")
    values, unit = [], ""
    for _, number, own in reversed(sizes):
        unit = own or unit
        values.append(in_si(f"{number} {unit}", "m", "beam"))
    values.reverse()
    own_fields: dict[str, Any] = dict(zip(fields, values[1:], strict=True))
    if sizes[1][0]:
        own_fields["shape"] = sizes[1][0]
    return Beam(length=values[0], supports=_supports(ends), **own_fields, **_material(rest))


def _supports(text: str) -> tuple[Any, Any]:
    left, dash, right = text.strip().lower().replace("cantilever", "clamped-free").partition("-")
    if not dash or left not in SUPPORTS or right not in SUPPORTS:
        raise InputError(f"supports = {shown(text.strip())}: write two of {', '.join(SUPPORTS)}, clamped-free")
    return left, right


def _material(text: str) -> dict[str, float]:
    """Elastic constants and density of a named material or of E=... rho=... nu=..."""
    if "=" not in text:
        known = material_named(text)
        return {name: getattr(known, name) for name, _ in CONSTANTS.values()}
    pairs = re.findall(r"(\w+)\s*=\s*([^\s=]+(?:\s+[^\s=]+(?=\s|$)(?!\s*=))?)", text)
    values = {}
    for key, value in pairs:
        if key not in CONSTANTS:
            raise InputError(f"beam.{key} = {value}: give E, rho and, for shear, nu")
        field, unit = CONSTANTS[key]
        values[field] = in_si(value, unit, key)
    if not {"youngs_modulus", "density"} <= set(values):
        raise InputError(f"material = {shown(text)}: give both E and rho, E=69GPa rho=2700")
    return values
