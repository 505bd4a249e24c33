"""Cross-sections, by shape and sizes or by stiffness and mass, and the properties that follow."""

from math import pi
from typing import Annotated, Any

import msgspec
from msgspec.structs import asdict

from verify.errors import InputError
from verify.settings import Shape
from verify.validation import check_number, unit, validate

SIZES = {"rectangle": ("width", "thickness"), "round": ("diameter",), "tube": ("diameter", "wall_thickness")}
"""The sizes of each shape."""
ALL_SIZES = {size for sizes in SIZES.values() for size in sizes}
Metres = Annotated[float, unit("m", gt=0)]


class CrossSection(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, repr_omit_defaults=True):
    """Input of a cross-section: shape, sizes and material, or its stiffness and mass. SI."""

    shape: Shape | None = None
    """rectangle (default), round or tube."""
    width: Metres | None = None
    """Width of a rectangle, m."""
    thickness: Metres | None = None
    """h of a rectangle, in the direction of vibration, m."""
    diameter: Metres | None = None
    """Outer diameter of a round section or a tube, m."""
    wall_thickness: Metres | None = None
    """Wall thickness of a tube, m."""
    youngs_modulus: Annotated[float, unit("Pa", gt=0)] | None = None
    """E, Pa."""
    density: Annotated[float, unit("kg/m^3", gt=0)] | None = None
    """rho, kg/m^3."""
    bending_stiffness: Annotated[float, unit("N m^2", gt=0)] | None = None
    """EI, N m^2, in place of sizes and E."""
    mass_per_length: Annotated[float, unit("kg/m", gt=0)] | None = None
    """rho A, kg/m, in place of sizes and rho."""
    extreme_fibre: Metres | None = None
    """Distance of the surface from the neutral line, m; default: that of the shape."""
    shear_stiffness: Annotated[float, unit("N", gt=0)] | None = None
    """kappa G A, N, for Timoshenko theory; default: that of the shape."""
    shear_coefficient: Annotated[float, unit("dimensionless", gt=0)] | None = None
    """kappa, for Timoshenko theory; default 5/6 for a rectangle, Cowper (1966) for round sections."""
    rotary_inertia: Annotated[float, unit("kg m", gt=0)] | None = None
    """rho I, kg m, for Rayleigh and Timoshenko theory; default: that of the shape."""


class Section(CrossSection, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A section of a stepped beam; it inherits missing fields from the beam. SI."""

    length: Metres
    """m."""

    def __post_init__(self) -> None:
        validate(self, "beam.section")


class Piece(msgspec.Struct, frozen=True, kw_only=True):
    """A piece of constant section with all its properties. SI."""

    length: float  # metres
    bending_stiffness: float  # EI, N m^2
    mass_per_length: float  # rho A, kg/m
    youngs_modulus: float | None = None
    """E, Pa. This, `second_moment` and `area` are None for a section defined by its stiffness."""
    second_moment: float | None = None  # I, m^4
    area: float | None = None  # A, m^2
    extreme_fibre: float | None = None  # distance of the surface from the neutral line, m
    shear_stiffness: float | None = None  # kappa G A, N
    rotary_inertia: float | None = None  # rho I, kg m

    @property
    def axial_stiffness(self) -> float:
        """EA, N. Raises InputError where unknown."""
        if self.youngs_modulus is None or self.area is None:
            raise InputError(
                "beam.bending_stiffness: a section defined by it has no axial stiffness, give its shape, sizes and "
                "youngs_modulus instead"
            )
        return self.youngs_modulus * self.area


def set_fields(section: CrossSection) -> dict[str, Any]:
    """The fields of a cross-section that are not None, by name."""
    fields = asdict(section)  # not by attributes, which are the derived values on a beam
    return {name: fields[name] for name in CrossSection.__struct_fields__ if fields[name] is not None}


def merged(section: Section, beam: CrossSection) -> dict[str, Any]:
    """The fields of a section and those inherited from its beam: shape, sizes of the same shape, material.

    A section defined by stiffness or mass does not inherit the beam's modulus or density.
    """
    fields, inherited = set_fields(section), set_fields(beam)
    names = ["shape"]
    if fields.get("shape", inherited.get("shape", "rectangle")) == inherited.get("shape", "rectangle"):
        names += [*SIZES[inherited.get("shape", "rectangle")], "shear_coefficient"]
    names += [] if "bending_stiffness" in fields else ["youngs_modulus"]
    names += [] if "mass_per_length" in fields else ["density"]
    return {name: inherited[name] for name in names if name in inherited} | fields


def piece_of(fields: dict[str, Any], length: float, where: str, nu: float, base: Piece | None = None) -> Piece:
    """Properties of a section from its fields; `length` in m, `nu` is Poisson's ratio.

    `base` is the beam's own piece, from which a section inherits properties that it neither sets nor derives. Raises
    InputError for a field that is missing, does not belong to the shape, or contradicts another.
    """
    shape = fields.get("shape", "rectangle")
    made = _derived(fields, shape, nu, where)
    inherited: dict[str, Any] = {}
    if base is not None:
        of_stiffness = not {*ALL_SIZES, "youngs_modulus", "density"} & set(fields)
        names = ("bending_stiffness", "mass_per_length", "shear_stiffness", "rotary_inertia") if of_stiffness else ()
        inherited = {name: getattr(base, name) for name in ("extreme_fibre", *names)}
    direct = {name: fields[name] for name in Piece.__struct_fields__ if name in fields and name != "youngs_modulus"}
    for name, material in (("bending_stiffness", "youngs_modulus"), ("mass_per_length", "density")):
        if name in direct and name in made and abs(direct[name] - made[name]) > 1e-12 * made[name]:
            raise InputError(
                f"{where}.{name} = {direct[name]!r} contradicts the shape and material, which make {made[name]!r}: "
                "give one of the two, and extreme_fibre for the position of the surface"
            )
        if name not in inherited | made | direct:
            missing = next((field for field in (*SIZES[shape], material) if field not in fields), name)
            raise InputError(
                f"{where}.{missing} is missing: a {shape} needs {', '.join(SIZES[shape])}, youngs_modulus and density; "
                "or give bending_stiffness and mass_per_length"
            )
    return Piece(length=length, **inherited | made | direct)


def _derived(fields: dict[str, Any], shape: str, nu: float, where: str) -> dict[str, float]:
    """The properties that follow from the sizes of a shape and the material. Raises InputError."""
    for size in (field for field in fields if field in ALL_SIZES and field not in SIZES[shape]):
        owner = next(name for name, sizes in SIZES.items() if size in sizes)
        raise InputError(
            f"{where}.{size} = {fields[size]!r} does not belong to a {shape}: leave it out or give shape = {owner!r}"
        )
    if not set(SIZES[shape]) <= set(fields):
        return {}
    if shape == "rectangle":
        width, thickness = fields["width"], fields["thickness"]
        area, fibre, kappa = width * thickness, 0.5 * thickness, 5.0 / 6.0
        moment = area * thickness * thickness / 12.0
    else:
        diameter = fields["diameter"]
        wall = fields.get("wall_thickness", 0.5 * diameter)
        if shape == "tube":
            check_number(f"{where}.wall_thickness", wall, "m", above=0, below=0.5 * diameter)
        area, square = pi * (diameter - wall) * wall, (1.0 - 2.0 * wall / diameter) ** 2
        moment, fibre = area * diameter * diameter * (1.0 + square) / 16.0, 0.5 * diameter
        # hollow circle, Cowper, J. Appl. Mech. 33 (1966); `square` is (inner over outer diameter)^2
        whole = 6.0 * (1.0 + nu) * (1.0 + square) ** 2
        kappa = whole / ((7.0 + 6.0 * nu) * (1.0 + square) ** 2 + (20.0 + 12.0 * nu) * square)
    made = {"area": area, "extreme_fibre": fibre}
    if (modulus := fields.get("youngs_modulus")) is not None:
        shear = fields.get("shear_coefficient", kappa) * modulus / (2.0 * (1.0 + nu)) * area
        made |= {"youngs_modulus": modulus, "second_moment": moment, "bending_stiffness": modulus * moment}
        made |= {"shear_stiffness": shear}
    if (density := fields.get("density")) is not None:
        made |= {"mass_per_length": density * area, "rotary_inertia": density * moment}
    return made
