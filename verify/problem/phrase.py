"""A beam in one line: '1 m x 40 x 8 mm steel, clamped-free'."""

import re
from typing import Any

from verify.errors import InputError, near_name, shown
from verify.problem.cross_section import SIZES
from verify.problem.materials import MATERIALS, SPELLINGS
from verify.problem.supports import SUPPORTS
from verify.validation import NUMBER, in_si

EXAMPLE = "1 m x 40 x 8 mm steel, clamped-free"
PREFIX = "beam: "  # begins a scene's name that is a beam in one line (see `scene.load.load_scene`)
CONSTANTS = {"E": ("youngs_modulus", "Pa"), "rho": ("density", "kg/m^3"), "nu": ("poissons_ratio", "1")}


def beam_table(phrase: str) -> dict[str, Any]:
    """The fields of a uniform beam, SI, from 'LENGTH x WIDTH x THICKNESS MATERIAL, LEFT-RIGHT'.

    Other sections are 'round DIAMETER' and 'tube DIAMETER x WALL'. A size without a unit has that of the next one.
    MATERIAL is one of `materials.MATERIALS`, E=69GPa rho=2.7g/cm3, or both; nu is of interest for shear alone.
    'cantilever' is clamped-free. Raises InputError.
    """
    body, _, ends = phrase.rpartition(",")
    left, _, right = ends.strip().lower().replace("cantilever", "clamped-free").partition("-")
    if left not in SUPPORTS or right not in SUPPORTS:
        raise InputError(f"beam = {shown(phrase)}: end it by two of {', '.join(SUPPORTS)}, as in '{EXAMPLE}'")
    parts = re.split(r"\s*[x×]\s*(?=[\d.]|round|tube)", body.replace(",", " ").strip())
    sizes = [re.fullmatch(rf"(round\s+|tube\s+)?({NUMBER})\s*(\S*)\s*(.*)", part) for part in parts]
    matches = [size for size in sizes if size]
    shape = (matches[1][1] or "rectangle").strip() if len(matches) > 1 else ""
    names = ("length", *SIZES.get(shape, ()))
    if len(matches) < len(sizes) or len(names) != len(matches) or any(size[4] for size in matches[:-1]):
        raise InputError(f"beam = {shown(phrase)}: write length, section and material as in '{EXAMPLE}'")
    table: dict[str, Any] = {"supports": [left, right]} | ({"shape": shape} if shape != "rectangle" else {})
    unit = ""
    for name, size in zip(reversed(names), reversed(matches), strict=True):
        unit = size[3] or unit
        table[name] = in_si(f"{size[2]} {unit}", "m", f"beam.{name}")
    return table | _material(matches[-1][4])


def _material(text: str) -> dict[str, float]:
    """Elastic constants and density of a named material, of E=... rho=... nu=..., or of both."""
    named, *pairs = re.split(r"\s*\b(\w+)\s*=\s*", text)
    plain = named.strip().lower()
    material = MATERIALS.get(SPELLINGS.get(plain, plain))
    if material is None and (named or not pairs):
        raise InputError(f"material = {named!r} is not known, give E and rho: {near_name(plain, tuple(MATERIALS))}")
    values = {name: getattr(material, name) for name, _ in CONSTANTS.values()} if material else {}
    for key, value in zip(pairs[::2], pairs[1::2], strict=True):
        if key not in CONSTANTS:
            raise InputError(f"beam: {key} = {value} is no constant of a material, give E, rho and nu")
        field, si = CONSTANTS[key]
        values[field] = in_si(value, si, f"beam.{field}")
    return values
