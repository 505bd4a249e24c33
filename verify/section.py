"""A section of a beam by its shape, or plainly by its stiffness and mass: sizes in, the figures of a piece out."""

from collections.abc import Callable
from math import log10, pi

import msgspec

from verify.checks import check_number, check_word, settle
from verify.errors import InputError
from verify.options import SHAPES, Shape

SAME = 1e-12
"""Relative: a stiffness given beside sizes that make the same one is no contradiction."""
FIGURE_DECADES = 100
"""Powers of ten within which a beam's derived figures lie, so that their squares and cubes are numbers too."""

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
    """What a section is made of: a shape with its sizes and material, or its figures plainly. SI."""

    shape: Shape | None = None
    """rectangle, round or tube; a rectangle unless given."""
    width: float | None = None
    """Of a rectangle, metres."""
    thickness: float | None = None
    """h of a rectangle, its height in the direction of vibration, metres."""
    diameter: float | None = None
    """Of a round section or a tube, outside, metres."""
    wall_thickness: float | None = None
    """Of a tube, metres."""
    youngs_modulus: float | None = None
    """E, pascals."""
    density: float | None = None
    """rho, kg/m^3."""
    bending_stiffness: float | None = None
    """EI, N m^2, in place of sizes and modulus."""
    mass_per_length: float | None = None
    """Rho A, kg/m, in place of sizes and density."""
    extreme_fibre: float | None = None
    """How far the surface lies from the neutral line, metres; of a shape it is known."""
    shear_stiffness: float | None = None
    """kappa G A, newton, used by Timoshenko's theory alone; of a shape it is known."""
    shear_coefficient: float | None = None
    """kappa, used by Timoshenko's theory alone; 5/6 of a rectangle, Cowper's of a round section unless given."""
    rotary_inertia: float | None = None
    """Rho I per length, kg m, used by Rayleigh's and Timoshenko's theories alone; of a shape it is known."""

    def check_sizes(self, where: str) -> None:
        """Raise InputError for a size that is none, and one that belongs to another shape."""
        for field, unit in _UNITS.items():
            if (value := _given(self, field)) is not None:
                check_number(f"{where}.{field}", value, unit, above=0)
        if self.shape is not None:
            check_word(f"{where}.shape", self.shape, SHAPES)


class Section(Sizes, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A piece of a stepped beam. What it leaves out is as in the beam it belongs to. SI."""

    length: float
    """Metres."""

    def __post_init__(self) -> None:
        settle(self)
        check_number("beam.section.length", self.length, "metres", above=0)
        self.check_sizes("beam.section")


class Piece(msgspec.Struct, frozen=True, kw_only=True):
    """A stretch of constant section, everything stated that is known of it. SI."""

    length: float
    """Metres."""
    bending_stiffness: float
    """EI, N m^2."""
    mass_per_length: float
    """Rho A, kg/m."""
    youngs_modulus: float | None = None
    """Pascals; None where the stiffness is given plainly, as are the next two."""
    second_moment: float | None = None
    """I, metres to the fourth."""
    area: float | None = None
    """A, square metres."""
    extreme_fibre: float | None = None
    """From the neutral line to the surface, metres."""
    shear_stiffness: float | None = None
    """kappa G A, newton."""
    rotary_inertia: float | None = None
    """Rho I, kg m."""

    @property
    def axial_stiffness(self) -> float:
        """EA, newton. Raises InputError where it is not known."""
        if self.youngs_modulus is None or self.area is None:
            raise InputError(
                "beam.bending_stiffness: a section given by its stiffness has no axial one, give its shape, sizes and "
                "youngs_modulus instead"
            )
        return self.youngs_modulus * self.area


class _Form(msgspec.Struct, frozen=True):
    """What the sizes of a shape make."""

    sizes: tuple[str, ...]
    area: Callable[[Sizes], float]
    second_moment: Callable[[Sizes], float]
    fibre: Callable[[Sizes], float]
    shear_coefficient: Callable[[Sizes, float], float]
    """By Poisson's ratio."""
    powers: tuple[int, ...]
    """Of the sizes in the second moment, about, for its power of ten."""


def _given(sizes: Sizes, field: str) -> float | None:
    """A field as it was given, though a beam answers with what follows from it."""
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
"""Of which a section's figures are made."""


def piece_of(section: Sizes, length: float, where: str, poissons_ratio: float, base: Piece | None = None) -> Piece:
    """The figures of a section, `length` in metres, by its shape or as they are given.

    `base` is the piece of the beam that a section belongs to, whose figures stand where it gives none and has no
    shape to make them of. Raises InputError where something is missing, does not fit the shape, or is given twice
    and not alike.
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
    """Kappa as it is given, or as the shape has it."""
    given = _given(section, "shear_coefficient")
    return _FORMS[section.shape or "rectangle"].shear_coefficient(section, poissons_ratio) if given is None else given


def _known(field: str, section: Sizes, made: float | None, base: Piece | None) -> float | None:
    """A figure that may stay unknown: as given, else as sizes make it, else as the beam has it."""
    given = _given(section, field)
    if given is None and made is None and base is not None:
        given = getattr(base, field)
    return made if given is None else given


def _stated(section: Sizes, field: str, made: float | None, where: str, base: Piece | None) -> float:
    """A figure that has to be known. Raises InputError where it is not, and where it is given twice and not alike."""
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
    """What to give so that a figure is known."""
    shape = section.shape or "rectangle"
    fields = (*_FORMS[shape].sizes, "youngs_modulus" if figure == "bending_stiffness" else "density")
    first = next((field for field in fields if _given(section, field) is None), figure)
    return InputError(
        f"{where}.{first} is missing: a {shape} needs {', '.join(_FORMS[shape].sizes)}, youngs_modulus and density; or "
        "give bending_stiffness and mass_per_length"
    )


def merged(section: Section, whole: Sizes) -> Sizes:
    """A section with what it leaves out of shape, sizes and material as in its beam.

    Where it gives a stiffness or a mass plainly, the beam's modulus or density is not put beside it.
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
    """Raise InputError for a size that the shape does not have, and a tube without a bore."""
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
    """Raise InputError for what a section given by its figures has of a shape, which would make nothing."""
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
    """Raise InputError where a size, or a figure made of several, leaves what floating point carries."""
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
                f"{where}: {figure} is about 1e{power:+.0f} (SI), and beyond 1e+-{FIGURE_DECADES} figures made of "
                "it leave floating point: check their units"
            )
