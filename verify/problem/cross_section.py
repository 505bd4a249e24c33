"""Cross-sections, by shape and sizes or by stiffness and mass, and the properties that follow."""

from collections.abc import Callable
from math import log10, pi

import msgspec

from verify.checks import check_number, check_word, settle
from verify.errors import InputError
from verify.options import SHAPES, Shape

SAME = 1e-12
"""Relative difference up to which a stiffness does not contradict the sizes beside it."""
FIGURE_DECADES = 100
"""Powers of ten within which derived properties lie, so that their squares and cubes are finite."""

_UNITS = {
    "width": "metres",
    "thickness": "metres",
    "diameter": "metres",
    "wall_thickness": "metres",
    "youngs_modulus": "pascals",
    "density": "kg/m^3",
    "bending_stiffness": "N m^2",
    "mass_per_length": "kg/m",
    "extreme_fibre": "metres",
    "shear_stiffness": "newton",
    "shear_coefficient": "dimensionless",
    "rotary_inertia": "kg m",
}


class Sizes(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A cross-section: shape, sizes and material, or its properties directly. SI."""

    shape: Shape | None = None
    """rectangle (default), round or tube."""
    width: float | None = None
    """Width of a rectangle, m."""
    thickness: float | None = None
    """h of a rectangle, in the direction of vibration, m."""
    diameter: float | None = None
    """Outer diameter of a round section or a tube, m."""
    wall_thickness: float | None = None
    """Wall thickness of a tube, m."""
    youngs_modulus: float | None = None
    """E, Pa."""
    density: float | None = None
    """rho, kg/m^3."""
    bending_stiffness: float | None = None
    """EI, N m^2, in place of sizes and E."""
    mass_per_length: float | None = None
    """rho A, kg/m, in place of sizes and rho."""
    extreme_fibre: float | None = None
    """Distance of the surface from the neutral line, m; by default from the shape."""
    shear_stiffness: float | None = None
    """kappa G A, N, for Timoshenko theory; by default from the shape."""
    shear_coefficient: float | None = None
    """kappa, for Timoshenko theory; default 5/6 for a rectangle, Cowper (1966) for round sections."""
    rotary_inertia: float | None = None
    """rho I, kg m, for Rayleigh and Timoshenko theory; by default from the shape."""

    def check_sizes(self, where: str) -> None:
        """Raise InputError for a size that is not finite and positive."""
        for field, unit in _UNITS.items():
            if (value := _given(self, field)) is not None:
                check_number(f"{where}.{field}", value, unit, above=0)
        if self.shape is not None:
            check_word(f"{where}.shape", self.shape, SHAPES)


class Section(Sizes, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A section of a stepped beam; what it leaves out is inherited from the beam. SI."""

    length: float
    """m."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("beam.section.length", self.length, "metres", above=0)
        self.check_sizes("beam.section")


class Piece(msgspec.Struct, frozen=True, kw_only=True):
    """A stretch of constant section with all its properties. SI."""

    length: float
    """Metres."""
    bending_stiffness: float
    """EI, N m^2."""
    mass_per_length: float
    """Rho A, kg/m."""
    youngs_modulus: float | None = None
    """E, Pa; None where the stiffness is given directly, as are the next two."""
    second_moment: float | None = None
    """I, m^4."""
    area: float | None = None
    """A, m^2."""
    extreme_fibre: float | None = None
    """From the neutral line to the surface, m."""
    shear_stiffness: float | None = None
    """kappa G A, N."""
    rotary_inertia: float | None = None
    """rho I, kg m."""

    @property
    def axial_stiffness(self) -> float:
        """EA, N. Raises InputError where unknown."""
        if self.youngs_modulus is None or self.area is None:
            raise InputError(
                "beam.bending_stiffness: a section given by its stiffness has no axial one, give its shape, sizes and "
                "youngs_modulus instead"
            )
        return self.youngs_modulus * self.area


class _Form(msgspec.Struct, frozen=True):
    """Formulas of a shape."""

    sizes: tuple[str, ...]
    area: Callable[[Sizes], float]
    second_moment: Callable[[Sizes], float]
    fibre: Callable[[Sizes], float]
    shear_coefficient: Callable[[Sizes, float], float]
    """As a function of Poisson's ratio."""
    powers: tuple[int, ...]
    """Powers of the sizes in the second moment, for its order of magnitude."""


def _given(sizes: Sizes, field: str) -> float | None:
    """A field as given; on a beam a property of the same name returns the derived value."""
    value: float | None = getattr(Sizes, field).__get__(sizes)
    return value


def _of(sizes: Sizes, field: str) -> float:
    value: float = getattr(sizes, field)
    return value


def _bore(sizes: Sizes) -> float:
    """Inner over outer diameter of a tube."""
    return 1.0 - 2.0 * _of(sizes, "wall_thickness") / _of(sizes, "diameter")


def _cowper(bore: float, poissons_ratio: float) -> float:
    """Shear coefficient of a round section, hollow by `bore` (Cowper, J. Appl. Mech. 33, 1966)."""
    hollow, square = bore * bore, (1.0 + bore * bore) ** 2
    solid = (7.0 + 6.0 * poissons_ratio) * square
    return 6.0 * (1.0 + poissons_ratio) * square / (solid + (20.0 + 12.0 * poissons_ratio) * hollow)


_FORMS = {
    "rectangle": _Form(
        ("width", "thickness"),
        lambda s: _of(s, "width") * _of(s, "thickness"),
        lambda s: _of(s, "width") * _of(s, "thickness") ** 3 / 12.0,
        lambda s: 0.5 * _of(s, "thickness"),
        lambda s, nu: 5.0 / 6.0,
        (1, 3),
    ),
    "round": _Form(
        ("diameter",),
        lambda s: pi / 4.0 * _of(s, "diameter") ** 2,
        lambda s: pi / 64.0 * _of(s, "diameter") ** 4,
        lambda s: 0.5 * _of(s, "diameter"),
        lambda s, nu: _cowper(0.0, nu),
        (4,),
    ),
    "tube": _Form(
        ("diameter", "wall_thickness"),
        lambda s: pi * (_of(s, "diameter") - _of(s, "wall_thickness")) * _of(s, "wall_thickness"),
        lambda s: (
            pi
            / 8.0
            * (_of(s, "diameter") - _of(s, "wall_thickness"))
            * _of(s, "wall_thickness")
            * _of(s, "diameter") ** 2
            * (1.0 + _bore(s) ** 2)
            / 2.0
        ),
        lambda s: 0.5 * _of(s, "diameter"),
        lambda s, nu: _cowper(_bore(s), nu),
        (3, 1),
    ),
}
_MADE_OF = ("width", "thickness", "diameter", "wall_thickness", "youngs_modulus", "density")
"""Fields from which a section's properties follow."""


def piece_of(section: Sizes, length: float, where: str, poissons_ratio: float, base: Piece | None = None) -> Piece:
    """Properties of a section, from its shape or as given; `length` in m.

    `base` is the beam's own piece, from which a section inherits what it neither gives nor derives. Raises InputError
    where something is missing, does not fit the shape, or contradicts itself.
    """
    form = _FORMS[section.shape or "rectangle"]
    _check_fits(section, form, where)
    shaped = all(getattr(section, size) is not None for size in form.sizes)
    modulus, density = (section.youngs_modulus, section.density) if shaped else (None, None)
    area = form.area(section) if shaped else None
    moment = form.second_moment(section) if shaped else None
    coefficient = shear_coefficient(section, poissons_ratio) if shaped else None
    shear_modulus = None if modulus is None else modulus / (2.0 * (1.0 + poissons_ratio))
    alike = base is not None and not any(_given(section, field) is not None for field in _MADE_OF)
    kept = base if alike else None
    return Piece(
        length=length,
        bending_stiffness=_stated(section, "bending_stiffness", _times(modulus, moment), where, kept),
        mass_per_length=_stated(section, "mass_per_length", _times(density, area), where, kept),
        youngs_modulus=modulus,
        second_moment=moment if modulus is not None else None,
        area=area,
        extreme_fibre=_known("extreme_fibre", section, form.fibre(section) if shaped else None, base),
        shear_stiffness=_known("shear_stiffness", section, _times(_times(coefficient, shear_modulus), area), kept),
        rotary_inertia=_known("rotary_inertia", section, _times(density, moment), kept),
    )


def shear_coefficient(section: Sizes, poissons_ratio: float) -> float:
    """Kappa as given, or of the shape."""
    given = _given(section, "shear_coefficient")
    return _FORMS[section.shape or "rectangle"].shear_coefficient(section, poissons_ratio) if given is None else given


def _known(field: str, section: Sizes, made: float | None, base: Piece | None) -> float | None:
    """A property that may be unknown: as given, else from the sizes, else the beam's."""
    given = _given(section, field)
    if given is None and made is None and base is not None:
        given = getattr(base, field)
    return made if given is None else given


def _stated(section: Sizes, field: str, made: float | None, where: str, base: Piece | None) -> float:
    """A required property. Raises InputError where it is unknown or contradicts the sizes."""
    given = _given(section, field)
    if given is not None and made is not None and abs(given - made) > SAME * made:
        raise InputError(
            f"{where}.{field} = {given!r} beside a shape and a material that make {made!r}: give one of them, and "
            "extreme_fibre for where the surface lies"
        )
    value = made if made is not None else given
    if value is None and base is not None:
        value = getattr(base, field)
    if value is None:
        raise _missing(section, field, where)
    return value


def _missing(section: Sizes, figure: str, where: str) -> InputError:
    """The error that names the missing field."""
    shape = section.shape or "rectangle"
    fields = (*_FORMS[shape].sizes, "youngs_modulus" if figure == "bending_stiffness" else "density")
    first = next((field for field in fields if _given(section, field) is None), figure)
    return InputError(
        f"{where}.{first} is missing: a {shape} needs {', '.join(_FORMS[shape].sizes)}, youngs_modulus and density; or "
        "give bending_stiffness and mass_per_length"
    )


def merged(section: Section, whole: Sizes) -> Sizes:
    """A section with shape, sizes and material that it leaves out inherited from its beam.

    Where it gives stiffness or mass directly, the beam's modulus or density is not inherited.
    """
    shape = section.shape or whole.shape
    same = (section.shape or "rectangle") == (whole.shape or "rectangle") or section.shape is None
    sizes = _FORMS[shape or "rectangle"].sizes if same else ()
    plain = {"youngs_modulus": section.bending_stiffness, "density": section.mass_per_length}
    inherited = [*sizes, *["shear_coefficient"] * same, *(field for field, given in plain.items() if given is None)]
    own = {field: _given(section, field) for field in _UNITS}
    filled = {field: _given(whole, field) for field in inherited if own[field] is None}
    return Sizes(**own | filled, shape=shape)


def _times(one: float | None, other: float | None) -> float | None:
    return None if one is None or other is None else one * other


def _check_fits(section: Sizes, form: _Form, where: str) -> None:
    """Raise InputError for a size of another shape, and for a tube without a bore."""
    shape = section.shape or "rectangle"
    for size in ("width", "thickness", "diameter", "wall_thickness"):
        if getattr(section, size) is not None and size not in form.sizes:
            owner = next(name for name, other in _FORMS.items() if size in other.sizes)
            raise InputError(
                f"{where}.{size} = {getattr(section, size)!r} is no size of a {shape}: leave it out, or give "
                f"shape = {owner!r}"
            )
    if shape == "tube" and section.diameter is not None and section.wall_thickness is not None:
        check_number(f"{where}.wall_thickness", section.wall_thickness, "metres", above=0, below=0.5 * section.diameter)


def check_used(section: Sizes, where: str) -> None:
    """Raise InputError for shape fields without effect in a section given by stiffness and mass."""
    form = _FORMS[section.shape or "rectangle"]
    shaped = all(_given(section, size) is not None for size in form.sizes)
    for field in () if shaped else ("shape", *_MADE_OF, "shear_coefficient"):
        if (value := _given(section, field)) is not None:
            raise InputError(
                f"{where}.{field} = {value!r} makes nothing beside bending_stiffness and mass_per_length: leave it "
                f"out, or give {', '.join(form.sizes)}, youngs_modulus and density instead of them"
            )
    kappa = _given(section, "shear_coefficient")
    if kappa is not None and (section.youngs_modulus is None or _given(section, "shear_stiffness") is not None):
        raise InputError(
            f"{where}.shear_coefficient = {kappa!r} makes nothing without youngs_modulus or beside shear_stiffness: "
            "leave it out"
        )


def check_decades(section: Sizes, piece_length: float, where: str) -> None:
    """Raise InputError where a size or a derived property leaves the range of floating point."""
    form = _FORMS[section.shape or "rectangle"]
    logs = {field: log10(value) for field in _UNITS if (value := _given(section, field)) is not None}
    decades = dict(logs) | {"length": log10(piece_length)}
    moment = area = None
    if all(size in logs for size in form.sizes):
        moment = sum(power * logs[size] for power, size in zip(form.powers, form.sizes, strict=True))
        area = sum(logs[size] for size in form.sizes) * (2.0 if form.sizes == ("diameter",) else 1.0)
    made = " * ".join(f"{s}^{p}" if p > 1 else s for p, s in zip(form.powers, form.sizes, strict=True))
    stiffness = logs.get("bending_stiffness")
    if moment is not None and "youngs_modulus" in logs:
        stiffness = decades[f"youngs_modulus * {made}"] = logs["youngs_modulus"] + moment
    mass = logs.get("mass_per_length")
    if area is not None and "density" in logs:
        mass = decades[f"density * {' * '.join(form.sizes)}"] = logs["density"] + area
    if stiffness is not None and mass is not None:
        decades["bending stiffness / (mass per length * length^4)"] = stiffness - mass - 4.0 * decades["length"]
    for figure, power in decades.items():
        if abs(power) > FIGURE_DECADES:
            raise InputError(
                f"{where}: {figure} is about 1e{power:+.0f} (SI), and beyond 1e+-{FIGURE_DECADES} derived "
                "properties overflow: check their units"
            )
