"""Units that a person types after a number, as factors to SI."""

import re

from verify.errors import InputError, shown

LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "in": 0.0254, "ft": 0.3048}
STRESSES = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "N/mm2": 1e6, "psi": 6894.757293168361}
STRESSES |= {"ksi": 1e3 * STRESSES["psi"]}
DENSITIES = {"kg/m3": 1.0, "g/cm3": 1e3, "lb/in3": 0.45359237 / 0.0254**3}
FACTORS = {
    "m": LENGTHS,
    "Pa": STRESSES,
    "kg/m^3": DENSITIES,
    "kg": {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "lb": 0.45359237},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "lbf": 4.4482216152605},
    "Hz": {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
}
"""Factors of every unit to the SI unit of the key; lb is the international pound, lbf its weight (NIST SP 811, B.8)."""
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"


def in_si(text: str, si: str, field: str) -> float:
    """A number with one of the units of `si`, or with none in SI: '40 mm' is 0.04 of 'm'. Raises InputError."""
    units = FACTORS.get(si, {})
    found = re.fullmatch(rf"\s*({NUMBER})\s*(\S*)\s*", text)
    if found is None or (found[2] and _plain(found[2]) not in units):
        known = f" with one of the units {', '.join(units)}" if units else ""
        raise InputError(f"{field} = {shown(text)}: give a number in {si}, or one{known}")
    return float(found[1]) * (units[_plain(found[2])] if found[2] else 1.0)


def _plain(unit: str) -> str:
    """A unit as in the tables: 'kg/m³' and 'kg/m^3' are 'kg/m3', 'µm' is 'um'."""
    return unit.replace("^", "").replace("³", "3").replace("²", "2").replace("µ", "u").replace("μ", "u")
