"""Units that a person types after a number, as factors to SI."""

import re

from verify.errors import InputError, shown

FACTORS = {
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "nm": 1e-9, "in": 0.0254, "ft": 0.3048},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "psi": 6894.757293168361, "ksi": 6894757.293168361},
    "kg/m^3": {"kg/m3": 1.0, "g/cm3": 1e3, "lb/in3": 0.45359237 / 0.0254**3},
    "kg": {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "lb": 0.45359237},
    "N": {"N": 1.0, "mN": 1e-3, "kN": 1e3, "lbf": 4.4482216152605},
    "Hz": {"Hz": 1.0, "kHz": 1e3, "MHz": 1e6},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6},
    "m/s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "um/s": 1e-6},
}  # factor of every unit to the SI unit of the key; lb is the international pound, lbf its weight (NIST SP 811, B.8)
NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
ALIKE = str.maketrans({"^": "", "³": "3", "µ": "u", "μ": "u"})


def in_si(text: str, si: str, field: str) -> float:
    """A number with one of the units of `si`, or with none in SI: '40 mm' is 0.04 of 'm'. Raises InputError."""
    units = FACTORS.get(si, {})
    match = re.fullmatch(rf"\s*({NUMBER})\s*(\S*)\s*", text)
    unit = match[2].translate(ALIKE) if match else ""
    if match is None or (unit and unit not in units):
        choices = f" with one of the units {', '.join(units)}" if units else ""
        raise InputError(f"{field} = {shown(text)}: give a number{choices}, without a unit it is in {si}")
    return float(match[1]) * units.get(unit, 1.0)
