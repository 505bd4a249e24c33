"""Common materials at room temperature, each value with its source."""

import msgspec

from verify.errors import InputError, near_name


class Material(msgspec.Struct, frozen=True, kw_only=True):
    """Elastic constants and density, SI."""

    youngs_modulus: float
    """E, Pa."""
    density: float
    """rho, kg/m^3."""
    poissons_ratio: float
    """nu."""
    source: str


MATERIALS = {
    "steel": Material(
        youngs_modulus=210e9, density=7850.0, poissons_ratio=0.3, source="EN 1993-1-1, 3.2.6; EN 1991-1-1, table A.4"
    ),
    "stainless": Material(
        youngs_modulus=200e9, density=7900.0, poissons_ratio=0.3, source="EN 1993-1-4, 2.1.3; EN 10088-1, 1.4301"
    ),
    "aluminium": Material(
        youngs_modulus=70e9, density=2700.0, poissons_ratio=0.3, source="EN 1999-1-1, 3.2.5"
    ),
    "titanium": Material(
        youngs_modulus=110e9, density=4430.0, poissons_ratio=0.31, source="Ti-6Al-4V annealed, MMPDS, 5.4.1"
    ),
    "brass": Material(
        youngs_modulus=97e9, density=8490.0, poissons_ratio=0.32, source="C36000, Copper Development Association"
    ),
    "copper": Material(
        youngs_modulus=117e9, density=8910.0, poissons_ratio=0.33, source="C11000, Copper Development Association"
    ),
    "glass": Material(
        youngs_modulus=70e9, density=2500.0, poissons_ratio=0.2, source="soda-lime glass, EN 572-1"
    ),
    "silicon": Material(
        youngs_modulus=169e9, density=2330.0, poissons_ratio=0.064,
        source="along <110> on a (100) wafer, Hopcroft, Nix and Kenny, J. MEMS 19 (2010), table 1",
    ),
    "concrete": Material(
        youngs_modulus=33e9, density=2500.0, poissons_ratio=0.2, source="C30/37, EN 1992-1-1, table 3.1; EN 1991-1-1"
    ),
}  # fmt: skip
SPELLINGS = {"aluminum": "aluminium", "stainless steel": "stainless"}


def material_named(name: str) -> Material:
    """A material by its name. Raises InputError."""
    plain = name.strip().lower()
    found = MATERIALS.get(SPELLINGS.get(plain, plain))
    if found is None:
        raise InputError(f"material = {name!r} is not known: {near_name(plain, tuple(MATERIALS))}, or give E and rho")
    return found
