"""Piezoelectric ceramics: constants of the stress-charge form with their sources, and those derived from them."""

from functools import cached_property
from math import sqrt
from typing import Annotated, Literal, NamedTuple

import msgspec
from msgspec import Meta

from verify.errors import InputError
from verify.validation import unit, validate

EPS0 = 8.8541878128e-12  # Permittivity of vacuum, F/m (CODATA 2018)
Direction = Literal["33", "31"]  # Wave along the field, or across it
Form = Literal["mason", "klm", "circuit"]
"""Mason's three-port, the model of Krimholtz, Leedom and Matthaei, or the circuit of Butterworth and Van Dyke."""
Stiffness = Annotated[float, unit("Pa"), Meta(description="cE, Pa")]
Stress = Annotated[float, unit("C/m^2"), Meta(description="e, C/m^2")]
Permittivity = Annotated[float, unit("relative", gt=0), Meta(description="epsS over that of vacuum")]


class Derived(NamedTuple):
    """Constants of the strain-charge form that act in slender bars, without losses."""

    s11: float  # sE11, 1/Pa
    s33: float  # sE33, 1/Pa
    s33_open: float  # sD33 = sE33 (1 - k33^2), 1/Pa
    d31: float  # C/N
    d33: float  # C/N
    eps33: float  # epsT33, F/m
    k31: float  # |d31| / sqrt(sE11 epsT33)
    k33: float  # |d33| / sqrt(sE33 epsT33)


class PiezoMaterial(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """A ceramic poled along 3 (6mm): T = cE S - e^t E, D = e S + epsS E (IEEE Std 176-1987, Table 8).

    The constants are those without shear, which act in slender bars and layers. Raises InputError for constants of an
    unstable material.
    """

    c11: Stiffness
    c12: Stiffness
    c13: Stiffness
    c33: Stiffness
    e31: Stress
    e33: Stress
    eps33: Permittivity
    density: Annotated[float, unit("kg/m^3", gt=0), Meta(description="rho, kg/m^3")]
    source: str = ""
    """Publication of the constants."""

    def __post_init__(self) -> None:
        validate(self, "material")
        if min(self.c11 - abs(self.c12), (self.c11 + self.c12) * self.c33 - 2.0 * self.c13**2) <= 0.0:
            raise InputError(
                f"material.c11 = {self.c11!r}: c11 to c33 are not positive definite, check the constants and their unit"
            )

    @cached_property
    def derived(self) -> Derived:
        """Compliances, piezoelectric constants, permittivity and coupling factors: sE = cE^-1, d = e sE."""
        import numpy as np

        e = np.array([self.e31, self.e31, self.e33])
        rows = [[self.c11, self.c12, self.c13], [self.c12, self.c11, self.c13], [self.c13, self.c13, self.c33]]
        s = np.linalg.inv(rows)
        d, eps33 = e @ s, EPS0 * self.eps33 + float(e @ s @ e)
        s11, s33, d31, d33 = float(s[0, 0]), float(s[2, 2]), float(d[0]), float(d[2])
        k31, k33 = abs(d31) / sqrt(s11 * eps33), abs(d33) / sqrt(s33 * eps33)
        return Derived(s11, s33, s33 * (1.0 - k33**2), d31, d33, eps33, k31, k33)


MaterialName = Literal["pzt-4", "pzt-8"]
PIEZO: dict[str, PiezoMaterial] = {
    "pzt-4": PiezoMaterial(
        c11=139e9,
        c12=77.8e9,
        c13=74.3e9,
        c33=115e9,
        e31=-5.2,
        e33=15.1,
        eps33=635.0,
        density=7500.0,
        source="D. Berlincourt, D. Curran, H. Jaffe, Physical Acoustics I-A (1964), Ch. 3",
    ),
    "pzt-8": PiezoMaterial(
        c11=146.88e9,
        c12=81.09e9,
        c13=81.05e9,
        c33=131.71e9,
        e31=-3.875,
        e33=13.91,
        eps33=561.6,
        density=7600.0,
        source="inverse of sE, d, epsT in D. Berlincourt, H. Krueger, C. Near, Morgan Electro Ceramics TP-226",
    ),
}
"""Catalogue constants without losses. Catalogues give tan delta 0.004 for both, Q 500 (PZT-4) and 1000 (PZT-8)."""
