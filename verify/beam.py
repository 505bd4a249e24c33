"""What a beam is: geometry, material, supports and the forces on it. Data, no numerics."""

from math import inf, isfinite, log10
from typing import Literal, get_args

import msgspec

from verify.errors import InputError, near_name

Support = Literal["pinned", "clamped", "free", "guided"]
SUPPORTS: tuple[str, ...] = get_args(Support)


def check_number(field: str, value: object, unit: str, *, above: float = -inf, below: float = inf) -> None:
    """Raise InputError unless `value` is a finite number strictly between `above` and `below`."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and isfinite(value) and above < value < below:  # type: ignore[arg-type, operator]
        return
    limits = [f"above {above:g}"] * (above > -inf) + [f"below {below:g}"] * (below < inf)
    wanted = " ".join(["a finite number", " and ".join(limits)]).strip()
    raise InputError(f"{field} = {value!r}: give {wanted} ({unit})")


class Beam(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A straight uniform beam of rectangular section, vibrating across its thickness.

    All values are SI: metres, pascals, kilograms per cubic metre. Raises InputError where a size is not a
    finite positive number or a support is unknown.
    """

    length: float
    """L, metres."""
    width: float
    """Width of the section, metres."""
    thickness: float
    """h, the height of the section in the direction of vibration, metres."""
    youngs_modulus: float
    """E, pascals."""
    density: float
    """rho, kg/m^3."""
    supports: tuple[Support, Support] = ("pinned", "pinned")
    """Left (x = 0) and right (x = L) end: pinned, clamped, free or guided."""
    poissons_ratio: float = 0.33
    """nu; used by Timoshenko's theory alone."""
    shear_coefficient: float = 5.0 / 6.0
    """kappa of a rectangle; used by Timoshenko's theory alone."""

    def __post_init__(self) -> None:
        check_number("beam.length", self.length, "metres", above=0)
        check_number("beam.width", self.width, "metres", above=0)
        check_number("beam.thickness", self.thickness, "metres", above=0)
        check_number("beam.youngs_modulus", self.youngs_modulus, "pascals", above=0)
        check_number("beam.density", self.density, "kg/m^3", above=0)
        check_number("beam.poissons_ratio", self.poissons_ratio, "dimensionless", above=-1, below=0.5000001)
        check_number("beam.shear_coefficient", self.shear_coefficient, "dimensionless", above=0)
        if len(self.supports) != 2:
            raise InputError(f"beam.supports = {self.supports!r}: give two, for the left and the right end")
        for support in self.supports:
            if support not in SUPPORTS:
                raise InputError(f"beam.supports has {support!r}: {near_name(str(support), SUPPORTS)}")
        if self._decades() > 200:
            raise InputError("beam: its sizes lie too many powers of ten apart for floating point, check their units")

    def _decades(self) -> float:
        """The largest power of ten, up or down, among EI, rho A and EI / (rho A L^4)."""
        b, h, e, rho, length = (
            log10(v) for v in (self.width, self.thickness, self.youngs_modulus, self.density, self.length)
        )
        return max(abs(e + b + 3 * h), abs(rho + b + h), abs(e - rho + 2 * h - 4 * length), abs(2 * length))

    @property
    def area(self) -> float:
        """A, square metres."""
        return self.width * self.thickness

    @property
    def second_moment(self) -> float:
        """I, metres to the fourth."""
        return self.width * self.thickness**3 / 12.0

    @property
    def bending_stiffness(self) -> float:
        """EI, N m^2."""
        return self.youngs_modulus * self.second_moment

    @property
    def mass_per_length(self) -> float:
        """Rho A, kg/m."""
        return self.density * self.area

    @property
    def wave_constant(self) -> float:
        """Sqrt(EI / (rho A)), m^2/s: omega = beta^2 times this."""
        return float((self.youngs_modulus / self.density / 12.0) ** 0.5 * self.thickness)


class PointForce(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A transverse harmonic point force, amplitude cos(omega t + phase).

    Raises InputError where a value is not finite or the position is negative; whether the position lies on a
    beam is checked where force and beam meet.
    """

    position: float
    """x, metres from the left end."""
    amplitude: float = 1.0
    """Newton."""
    phase_deg: float = 0.0
    """Degrees, leading (e^{+i omega t})."""

    def __post_init__(self) -> None:
        check_number("force.position", self.position, "metres")
        check_number("force.amplitude", self.amplitude, "newton")
        check_number("force.phase_deg", self.phase_deg, "degrees")
        if self.position < 0:
            raise InputError(
                f"force.position = {self.position!r}: give a position on the beam (metres from the left end)"
            )
