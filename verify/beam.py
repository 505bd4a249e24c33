"""What a beam is: geometry, material, supports and the forces on it. Data, no numerics."""

from math import inf, log10, pi, sqrt
from operator import index
from sys import float_info

import msgspec

from verify.errors import InputError, near_name, shown
from verify.options import SUPPORTS, Support

LARGEST = float_info.max
FIGURE_DECADES = 100
"""Powers of ten within which a beam's derived figures lie, so that their squares and cubes are numbers too."""
SHORTEST_SECTION = 1e-6
"""Of the beam's length."""
CONTRAST = 1e15
"""Of EI / l^3 between two sections: beyond it the softer one is lost in the rounding of the stiffer one."""
MOST_WAVES = 1e6
"""Along a beam, from end to end: more take too many points, and their phase loses its digits."""


def check_number(
    field: str, value: object, unit: str, *, above: float = -inf, below: float = inf, at_least: float = -inf
) -> None:
    """Raise InputError unless `value` is a finite number, at least `at_least`, strictly between `above` and `below`."""
    number = isinstance(value, int | float) and not isinstance(value, bool)
    if number and -LARGEST <= value <= LARGEST and above < value < below and value >= at_least:  # type: ignore[operator]
        return
    limits = [f"above {above:g}"] * (above > -inf) + [f"of at least {at_least:g}"] * (at_least > -inf)
    limits += [f"below {below:g}"] * (below < inf)
    wanted = " ".join(["a finite number", " and ".join(limits)]).strip()
    raise InputError(f"{field} = {shown(value)}: give {wanted} ({unit})")


def check_whole(field: str, value: object, least: int) -> None:
    """Raise InputError unless `value` is a whole number of at least `least`."""
    try:
        whole = index(value)  # type: ignore[arg-type]
    except TypeError:
        raise InputError(f"{field} = {shown(value)}: give a whole number of at least {least}") from None
    if isinstance(value, bool) or whole < least:
        raise InputError(f"{field} = {shown(value)}: give a whole number of at least {least}")


class Section(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A piece of a stepped beam. What it leaves out is as in the beam it belongs to. SI."""

    length: float
    """Metres."""
    width: float | None = None
    thickness: float | None = None
    youngs_modulus: float | None = None
    density: float | None = None

    def __post_init__(self) -> None:
        for field in ("length", "width", "thickness", "youngs_modulus", "density"):
            if (value := getattr(self, field)) is not None:
                check_number(f"beam.section.{field}", value, "SI", above=0)


class Piece(msgspec.Struct, frozen=True, kw_only=True):
    """A stretch of constant section, everything stated."""

    length: float
    """Metres."""
    youngs_modulus: float
    """Pascals."""
    second_moment: float
    """I, metres to the fourth."""
    mass_per_length: float
    """Rho A, kg/m."""
    area: float
    """A, square metres."""

    @property
    def axial_stiffness(self) -> float:
        """EA, newton."""
        return self.youngs_modulus * self.area

    @property
    def bending_stiffness(self) -> float:
        """EI, N m^2."""
        return self.youngs_modulus * self.second_moment


class Beam(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A straight beam of rectangular section, uniform or stepped, vibrating across its thickness.

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
    loss_factor: float = 0.0
    """eta of the harmonic field: E (1 + i eta) everywhere. At a resonance it equals a modal damping ratio eta/2."""
    section: tuple[Section, ...] = ()
    """Pieces from left to right where the beam is stepped; their lengths add up to `length`."""

    def __post_init__(self) -> None:
        check_number("beam.length", self.length, "metres", above=0)
        check_number("beam.width", self.width, "metres", above=0)
        check_number("beam.thickness", self.thickness, "metres", above=0)
        check_number("beam.youngs_modulus", self.youngs_modulus, "pascals", above=0)
        check_number("beam.density", self.density, "kg/m^3", above=0)
        check_number("beam.poissons_ratio", self.poissons_ratio, "dimensionless", above=-1, below=0.5000001)
        check_number("beam.shear_coefficient", self.shear_coefficient, "dimensionless", above=0)
        check_number("beam.loss_factor", self.loss_factor, "0 means undamped", at_least=0, below=10)
        if len(self.supports) != 2:
            raise InputError(f"beam.supports = {self.supports!r}: give two, for the left and the right end")
        for support in self.supports:
            if support not in SUPPORTS:
                raise InputError(f"beam.supports has {support!r}: {near_name(str(support), SUPPORTS)}")
        self._check_figures("beam", Section(length=self.length))
        self._check_sections()

    def _check_sections(self) -> None:
        total = sum(section.length for section in self.section)
        if self.section and abs(total - self.length) > 1e-9 * self.length:
            raise InputError(
                f"beam.section lengths add up to {total!r} m and beam.length = {self.length!r} m: make them equal"
            )
        for i, section in enumerate(self.section):
            if section.length < SHORTEST_SECTION * self.length:
                raise InputError(
                    f"beam.section[{i}].length = {section.length!r} m is less than {SHORTEST_SECTION:g} of "
                    f"beam.length = {self.length!r} m: leave it out or check its unit"
                )
            self._check_figures(f"beam.section[{i}]", section)
        stiff = [piece.bending_stiffness / piece.length**3 for piece in self.pieces]
        if max(stiff) > CONTRAST * min(stiff):
            stiffest, softest = stiff.index(max(stiff)), stiff.index(min(stiff))
            raise InputError(
                f"beam.section[{stiffest}] is {max(stiff) / min(stiff):.1e} times as stiff (EI / l^3) as "
                f"beam.section[{softest}], more than {CONTRAST:g}: make them more alike, or leave out what is rigid or "
                "too short to bend"
            )

    def _check_figures(self, where: str, section: Section) -> None:
        """Raise InputError where a size, or a figure made of several, leaves what floating point carries."""
        b, h, e, rho = (log10(value) for value in self._sizes(section))
        length = log10(self.length)
        decades = {
            "width": b,
            "thickness": h,
            "youngs_modulus": e,
            "density": rho,
            "length": length,
            "youngs_modulus * width * thickness^3": e + b + 3 * h,
            "density * width * thickness": rho + b + h,
            "youngs_modulus * thickness^2 / (density * length^4)": e - rho + 2 * h - 4 * length,
        }
        for figure, power in decades.items():
            if abs(power) > FIGURE_DECADES:
                raise InputError(
                    f"{where}: {figure} is about 1e{power:+.0f} (SI), and beyond 1e+-{FIGURE_DECADES} figures made of "
                    "it leave floating point: check their units"
                )

    @property
    def stepped(self) -> bool:
        """Whether any piece differs from the beam's own section."""
        own = (self.youngs_modulus, self.second_moment, self.mass_per_length)
        return any((p.youngs_modulus, p.second_moment, p.mass_per_length) != own for p in self.pieces)

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The stretches of constant section from left to right; one for a uniform beam."""
        return tuple(self._piece(section) for section in self.section or (Section(length=self.length),))

    def _sizes(self, section: Section) -> tuple[float, float, float, float]:
        """(width, thickness, E, rho) of a section, the beam's own where it says nothing."""
        return (
            self.width if section.width is None else section.width,
            self.thickness if section.thickness is None else section.thickness,
            self.youngs_modulus if section.youngs_modulus is None else section.youngs_modulus,
            self.density if section.density is None else section.density,
        )

    def _piece(self, section: Section) -> Piece:
        width, thickness, modulus, density = self._sizes(section)
        return Piece(
            length=section.length,
            youngs_modulus=modulus,
            second_moment=width * thickness**3 / 12.0,
            mass_per_length=density * (width * thickness),
            area=width * thickness,
        )

    @property
    def rigid_motions(self) -> int:
        """How many rigid motions the supports leave: 0, 1 or 2."""
        held = sum(support in ("pinned", "clamped") for support in self.supports)
        turned = any(support in ("clamped", "guided") for support in self.supports)
        return int(held == 0) + int(held <= 1 and not turned)

    def mirrored(self) -> "Beam":
        """The same beam seen from the other side."""
        left, right = self.supports
        return msgspec.structs.replace(self, supports=(right, left), section=self.section[::-1])

    @property
    def area(self) -> float:
        """A, square metres, where no section says otherwise; so for the following."""
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


def check_frequency(field: str, frequency_hz: float, beam: Beam) -> None:
    """Raise InputError unless a frequency is positive and its waves on the beam are long enough to be followed."""
    check_number(field, frequency_hz, "hertz", above=0)
    waves = sqrt(frequency_hz) / sqrt(2.0 * pi * beam.wave_constant) * beam.length
    if waves > MOST_WAVES:
        raise InputError(
            f"{field} = {frequency_hz!r} Hz bends this beam in {waves:.1e} waves from end to end, more than "
            f"{MOST_WAVES:g}: lower it or check the beam's units"
        )


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
