"""The beam: geometry, material, supports, attached masses and springs, point forces. Values, no numerics."""

from functools import lru_cache
from math import pi, sqrt
from typing import Any

import msgspec

from verify.checks import Relative, check_number, settle
from verify.errors import InputError, near_name, written
from verify.options import SUPPORTS, Support
from verify.problem.cross_section import (
    Piece,
    Section,
    Sizes,
    check_decades,
    check_used,
    merged,
    piece_of,
    shear_coefficient,
)
from verify.problem.point_attachments import PointMass, PointSpring
from verify.problem.supports import HOLDS

SHORTEST_SECTION = 1e-6
"""Relative to the beam's length."""
CONTRAST = 1e15
"""Ratio of EI / l^3 between two sections beyond which the softer one is lost in rounding."""
MOST_WAVES = 1e6
"""Wavelengths along a beam: more take too many points, and their phase loses its digits."""
KEPT = 4096
"""Beams whose pieces are cached, about a kilobyte each."""


class Beam(Sizes, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A straight beam, uniform or stepped, vibrating across its thickness, with attached masses and springs.

    The section is given by shape, sizes, E and rho, or by `bending_stiffness` and `mass_per_length`, which are defined
    for every beam. SI units. Raises InputError for a size that is not finite and positive, an incomplete or
    contradictory section, an unknown support, and an attachment off the beam.
    """

    length: float
    """L, m."""
    supports: tuple[Support, Support] = ("pinned", "pinned")
    """Left (x = 0) and right (x = L) end: pinned, clamped, free or guided."""
    poissons_ratio: float = 0.33
    """nu, for Timoshenko theory and plate theory only."""
    loss_factor: Relative = 0.0
    """eta of the harmonic field, E (1 + i eta). At a resonance it equals a modal damping ratio eta/2, times the share
    of bending and shear in the mode's stiffness where springs, a foundation or an axial force contribute."""
    section: tuple[Section, ...] = ()
    """Sections of a stepped beam from left to right; their lengths add up to `length`."""
    mass: tuple[PointMass, ...] = ()
    """Attached rigid bodies."""
    spring: tuple[PointSpring, ...] = ()
    """Springs to the ground."""
    tension: float = 0.0
    """Axial force, N, along the undeformed beam; negative is compression."""
    foundation: float = 0.0
    """Stiffness of a Winkler foundation, N/m^2 (N/m per metre of beam)."""

    def __post_init__(self) -> None:
        settle(self, "beam", section=Section, mass=PointMass, spring=PointSpring)
        check_number("beam.length", self.length, "metres", above=0)
        self.check_sizes("beam")
        check_number("beam.poissons_ratio", self.poissons_ratio, "dimensionless", above=-1, at_most=0.5)
        check_number("beam.loss_factor", self.loss_factor, "0 means undamped", at_least=0, below=10)
        check_number("beam.tension", self.tension, "newton, negative is compression")
        check_number("beam.foundation", self.foundation, "N/m^2, 0 means none", at_least=0)
        self._check_supports()
        check_decades(self, self.length, "beam")
        self._check_sections()
        if not self.section:  # sections inherit what they leave out
            check_used(self, "beam")
        self._check_attached()

    def _check_supports(self) -> None:
        if not isinstance(self.supports, tuple) or len(self.supports) != 2:
            raise InputError(f"beam.supports = {self.supports!r}: give two, for the left and the right end")
        for support in self.supports:
            if support not in SUPPORTS:
                raise InputError(f"beam.supports has {support!r}: {near_name(str(support), SUPPORTS)}")

    def _check_sections(self) -> None:
        total = sum(section.length for section in self.section)
        if self.section and abs(total - self.length) > 1e-9 * self.length:
            raise InputError(
                f"beam.section lengths add up to {written(total)} m and beam.length = {written(self.length)} m: make "
                "them equal"
            )
        for i, section in enumerate(self.section):
            if section.length < SHORTEST_SECTION * self.length:
                raise InputError(
                    f"beam.section[{i}].length = {section.length!r} m is less than {SHORTEST_SECTION:g} of "
                    f"beam.length = {self.length!r} m: leave it out or check its unit"
                )
            check_decades(merged(section, self), self.length, f"beam.section[{i}]")
        stiff = [piece.bending_stiffness / piece.length**3 for piece in self.pieces]
        if max(stiff) > CONTRAST * min(stiff):
            stiffest, softest = stiff.index(max(stiff)), stiff.index(min(stiff))
            raise InputError(
                f"beam.section[{stiffest}] is {max(stiff) / min(stiff):.1e} times as stiff (EI / l^3) as "
                f"beam.section[{softest}], more than {CONTRAST:g}: make them more alike, or leave out what is rigid or "
                "too short to bend"
            )

    def _check_attached(self) -> None:
        """Raise InputError for an attachment off the beam, and for one without effect at a support."""
        acts = [
            (f"beam.mass[{i}]", m.position, ("mass", "rotary_inertia"), (m.mass, m.rotary_inertia))
            for i, m in enumerate(self.mass)
        ]
        acts += [
            (f"beam.spring[{i}]", s.position, ("stiffness", "rotational"), (s.stiffness, s.rotational))
            for i, s in enumerate(self.spring)
        ]
        for where, position, fields, values in acts:
            if position > self.length:
                raise InputError(
                    f"{where}.position = {position!r} lies off the beam: give one between 0 and {self.length!r} m"
                )
            for at, support in zip((0.0, self.length), self.supports, strict=True):
                for field, value, held in zip(fields, values, HOLDS[support], strict=True):
                    if value and held and position == at:
                        raise InputError(
                            f"{where}.{field} = {value!r} would do nothing at a {support} end: leave it out, "
                            "or choose another support"
                        )

    @property
    def own(self) -> Piece:
        """The beam's own section over its whole length."""
        return _own(self)

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The stretches of constant section from left to right; one for a uniform beam."""
        return _pieces(self)

    @property  # type: ignore[misc]
    def bending_stiffness(self) -> float:
        """EI of the beam's own section, N m^2: as given, or from the shape."""
        return self.own.bending_stiffness

    @property  # type: ignore[misc]
    def mass_per_length(self) -> float:
        """Rho A of the beam's own section, kg/m."""
        return self.own.mass_per_length

    @property  # type: ignore[misc]
    def shear_coefficient(self) -> float:
        """Kappa of Timoshenko theory of the beam's own section."""
        return shear_coefficient(self, self.poissons_ratio)

    @property
    def stepped(self) -> bool:
        """Whether any piece differs from the beam's own section."""
        own = self.own
        return bool(self.section) and any(msgspec.structs.replace(p, length=own.length) != own for p in self.pieces)

    @property
    def added(self) -> tuple[str, ...]:
        """Names of the fields that a uniform beam between two supports does not have."""
        there = {
            "section": self.stepped,
            "mass": self.mass,
            "spring": self.spring,
            "tension": self.tension,
            "foundation": self.foundation,
        }
        return tuple(name for name, value in there.items() if value)

    @property
    def uniform(self) -> bool:
        """Whether it has one section and no attachments, as closed forms assume."""
        return not self.added

    @property
    def lossless(self) -> tuple[str, ...]:
        """Names of the fields with stiffness and no loss factor: springs, tension, foundation."""
        return tuple(name for name in self.added if name in ("spring", "tension", "foundation"))

    def check_added(self, who: str, takes: tuple[str, ...] = (), instead: str = "ask for something else") -> None:
        """Raise InputError for added fields that `who` does not model, those in `takes` excepted."""
        for name in self.added:
            if name not in takes:
                raise InputError(f"beam.{name}: {who} takes none, leave it out or {instead}")

    @property
    def rigid_lines(self) -> tuple[tuple[float, float], ...]:
        """Rigid motions w = a + b x without stiffness, as (a, b) with x in m: none, one or two."""
        ends = zip((0.0, self.length), self.supports, strict=True)
        places = {at for at, support in ends if HOLDS[support].deflection}
        places |= {spring.position for spring in self.spring if spring.stiffness}
        turned = any(HOLDS[support].rotation for support in self.supports) or bool(self.tension)
        turned |= any(spring.rotational for spring in self.spring)
        if self.foundation or len(places) > 1 or (places and turned):
            return ()
        if places:
            return ((-places.pop(), 1.0),)
        return ((1.0, 0.0),) if turned else ((1.0, 0.0), (-0.5 * self.length, 1.0))

    @property
    def rigid_motions(self) -> int:
        """Number of rigid motions: 0, 1 or 2."""
        return len(self.rigid_lines)

    def mirrored(self) -> "Beam":
        """The mirror image of the beam."""
        left, right = self.supports

        def turned(one: Any) -> Any:
            return msgspec.structs.replace(one, position=self.length - one.position)

        return msgspec.structs.replace(
            self,
            supports=(right, left),
            section=self.section[::-1],
            mass=tuple(map(turned, self.mass[::-1])),
            spring=tuple(map(turned, self.spring[::-1])),
        )

    @property
    def surface_distance(self) -> float:
        """From the neutral line to the surface of the beam's own section, m. Raises InputError where unknown."""
        distance = self.own.extreme_fibre
        if distance is None:
            raise InputError(
                "beam.extreme_fibre is missing: the motion of a surface depends on how far it lies from the neutral "
                "line, give it in metres"
            )
        return distance

    @property
    def area(self) -> float:
        """A of the beam's own section, m^2. Raises InputError where unknown."""
        return self._of_shape(self.own.area)

    @property
    def second_moment(self) -> float:
        """I of the beam's own section, m^4. Raises InputError where unknown."""
        return self._of_shape(self.own.second_moment)

    def _of_shape(self, value: float | None) -> float:
        if value is None:
            raise InputError("beam.shape: a section given by its stiffness has no sizes, give its shape and sizes")
        return value

    @property
    def wave_constant(self) -> float:
        """sqrt(EI / (rho A)) of the beam's own section, m^2/s: omega = beta^2 times this."""
        made = (self.youngs_modulus, self.density, self.thickness)
        if None not in made and self.shape in (None, "rectangle"):
            modulus, density, thickness = made
            return float((modulus / density / 12.0) ** 0.5 * thickness)  # type: ignore[operator]
        return sqrt(self.bending_stiffness / self.mass_per_length)


@lru_cache(maxsize=KEPT)
def _own(beam: Beam) -> Piece:
    return piece_of(beam, beam.length, "beam", beam.poissons_ratio)


@lru_cache(maxsize=KEPT)
def _pieces(beam: Beam) -> tuple[Piece, ...]:
    if not beam.section:
        return (beam.own,)
    pieces = ((merged(section, beam), section.length) for section in beam.section)
    return tuple(
        piece_of(section, length, f"beam.section[{i}]", beam.poissons_ratio, beam.own)
        for i, (section, length) in enumerate(pieces)
    )


def check_frequency(field: str, frequency_hz: float, beam: Beam) -> None:
    """Raise InputError unless a frequency is positive and its wavelength is not too short for the beam."""
    check_number(field, frequency_hz, "hertz", above=0)
    waves = sqrt(frequency_hz) / sqrt(2.0 * pi * beam.wave_constant) * beam.length
    if waves > MOST_WAVES:
        raise InputError(
            f"{field} = {frequency_hz!r} Hz has {waves:.1e} wavelengths along this beam, more than "
            f"{MOST_WAVES:g}: lower it or check the beam's units"
        )


class PointForce(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A transverse harmonic point force, amplitude cos(omega t + phase).

    Raises InputError where a value is not finite or the position is negative; a position off the beam is refused by
    the functions that take both.
    """

    position: float
    """x, m from the left end."""
    amplitude: float = 1.0
    """N."""
    phase_deg: float = 0.0
    """Phase, degrees (e^{+i omega t})."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("force.position", self.position, "metres")
        check_number("force.amplitude", self.amplitude, "newton")
        check_number("force.phase_deg", self.phase_deg, "degrees")
        if self.position < 0:
            raise InputError(
                f"force.position = {self.position!r}: give a position on the beam (metres from the left end)"
            )
