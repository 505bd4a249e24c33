"""Common materials at room temperature, each with the source of its values."""

import msgspec


class Material(msgspec.Struct, frozen=True):
    """Elastic constants and density, SI."""

    youngs_modulus: float  # E, Pa
    density: float  # rho, kg/m^3
    poissons_ratio: float  # nu
    source: str


MATERIALS = {
    "steel": Material(210e9, 7850.0, 0.3, "structural steel, EN 1993-1-1, 3.2.6; EN 1991-1-1, table A.4"),
    "stainless": Material(200e9, 7900.0, 0.3, "1.4301 (304), EN 1993-1-4, 2.1.3; EN 10088-1"),
    "aluminium": Material(70e9, 2700.0, 0.3, "EN 1999-1-1, 3.2.5"),
    "titanium": Material(110e9, 4430.0, 0.31, "Ti-6Al-4V annealed, MMPDS, 5.4.1"),
    "brass": Material(97e9, 8490.0, 0.32, "C36000, Copper Development Association"),
    "copper": Material(117e9, 8910.0, 0.33, "C11000, Copper Development Association"),
    "glass": Material(70e9, 2500.0, 0.2, "soda-lime glass, EN 572-1"),
    "silicon": Material(169e9, 2330.0, 0.064, "along <110> on a (100) wafer, Hopcroft et al., J. MEMS 19 (2010)"),
    "concrete": Material(33e9, 2500.0, 0.2, "C30/37, EN 1992-1-1, table 3.1; EN 1991-1-1, table A.1"),
}
SPELLINGS = {"aluminum": "aluminium", "stainless steel": "stainless"}
