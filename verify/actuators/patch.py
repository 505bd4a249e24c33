"""Piezoelectric patches bonded to a beam: unimorph and bimorph.

Beam theory of the laminate (E. F. Crawley, J. de Luis, AIAA J. 25:1373 (1987), perfect bond; J. G. Smits, W.-S. Choi,
IEEE Trans. UFFC 38:256 (1991)): plane sections, no axial force, stress along the beam alone. With the field E3 = V/t
along the poling the stress is T1 = (S1 - d31 E3)/s11E, so that the transformed section has the modulus 1/s11E in the
layers and a voltage adds a constant bending moment over the patch. The field is taken as constant through a layer. The
true one, of constant D3, stiffens the layer against its own bending by k31^2/(1 - k31^2). The bond is thin and rigid;
free edges relieve the stress within about a layer's thickness, so the patch is long against t.
"""

from typing import Annotated, Any

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.actuators.materials import PIEZO, MaterialName, PiezoMaterial
from verify.actuators.port import Actuator, Port
from verify.errors import InputError
from verify.problem.beam import SHORTEST_SECTION, Beam, check_features
from verify.problem.cross_section import CrossSection, Section, piece_of, set_fields
from verify.validation import Relative, check_number, unit, validate


class Laminate(msgspec.Struct, frozen=True, kw_only=True):
    """The section of a beam under its patch, short-circuited. SI."""

    neutral_axis: float  # distance from the beam's mid-plane to the neutral line, towards the patch, m
    lever: float  # distance from the neutral line to the middle of a layer, m
    axial_stiffness: float  # EA, N
    bending_stiffness: float  # EI, N m^2
    mass_per_length: float  # kg/m
    rotary_inertia: float  # rho I about the neutral line, kg m
    extreme_fibre: float
    """Distance from the neutral line to the beam's bare surface, or with two layers to that of a layer, m."""


class Patch(Actuator, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="patch"):
    """Layers of ceramic on one side (unimorph) or both sides (bimorph, in antiphase) of a rectangular beam.

    The layers are electrically in parallel. A positive voltage bends the ends of the beam towards the first layer, +w,
    for d31 < 0. Raises InputError for an invalid value.
    """

    length: Annotated[float, unit("m", gt=0)]
    """Along the beam, m."""
    thickness: Annotated[float, unit("m", gt=0)]
    """Of a layer, between its electrodes, m."""
    width: Annotated[float, unit("m", gt=0)] | None = None
    """Across the beam, m; default: the beam's width."""
    sides: Annotated[int, Meta(ge=1, le=2)] = 2
    """1: a layer on the side of +w; 2: a layer on either side."""
    material: MaterialName | PiezoMaterial = "pzt-4"
    """Ceramic: pzt-4, pzt-8, or a table of its constants."""
    dielectric_loss: Annotated[Relative, unit("tan delta", ge=0, lt=1)] = 0.0
    """tan delta of the free ceramic; bending of the layers has no loss."""
    substrate: CrossSection | None = None
    """Rectangular section under the patch; default: that of the beam to which `bonded` fixes the patch."""

    def __post_init__(self) -> None:
        validate(self, "patch")
        section = self.substrate
        if section is not None:
            validate(section, "patch.substrate")
            piece = piece_of(set_fields(section), 1.0, "patch.substrate", 0.33)
            if section.shape not in (None, "rectangle") or piece.youngs_modulus is None or not section.width:
                sizes = "width, thickness, youngs_modulus and density"
                raise InputError(f"patch.substrate: a patch is on a rectangular section, give the beam's {sizes}")
            if self.width is not None:
                check_number("patch.width", self.width, "metres, at most the beam's width", at_most=section.width)

    @property
    def ceramic(self) -> PiezoMaterial:
        """The constants of the material."""
        return PIEZO[self.material] if isinstance(self.material, str) else self.material

    def bonded(self, beam: Beam) -> "Patch":
        """The patch on the section of a beam. Raises InputError for a beam that is not rectangular."""
        return replace(self, substrate=CrossSection(**set_fields(beam)))

    @property
    def _sizes(self) -> tuple[float, float]:
        """(width of the patch, thickness of the beam), m. Raises InputError without a beam."""
        section = self.substrate
        if section is None or section.width is None or section.thickness is None:
            raise InputError("patch.substrate is missing: bond the patch to a beam first, patch.bonded(beam)")
        return self.width or section.width, section.thickness

    @property
    def laminate(self) -> Laminate:
        """The transformed section over the patch. Raises InputError without a beam."""
        (width, h), t, n, ceramic = self._sizes, self.thickness, self.sides, self.ceramic
        bare = piece_of(set_fields(self.substrate), 1.0, "patch.substrate", 0.33)  # type: ignore[arg-type]
        layer, mass = width * t / ceramic.derived.s11, width * t * ceramic.density
        axial, distance = bare.axial_stiffness + n * layer, 0.5 * (h + t)
        offset = layer * distance / axial if n == 1 else 0.0
        lever = distance - offset
        own = t**2 / 12.0 + lever**2
        return Laminate(
            neutral_axis=offset,
            lever=lever,
            axial_stiffness=axial,
            bending_stiffness=bare.bending_stiffness + bare.axial_stiffness * offset**2 + n * layer * own,
            mass_per_length=bare.mass_per_length + n * mass,
            rotary_inertia=bare.mass_per_length * (h**2 / 12.0 + offset**2) + n * mass * own,
            extreme_fibre=0.5 * h + (offset if n == 1 else t),
        )

    @property
    def moment_per_volt(self) -> float:
        """B = -n e31 width lever, N m/V, e31 = d31/s11E: bending moment per volt, curvature w'' > 0 positive."""
        derived = self.ceramic.derived
        return -self.sides * derived.d31 / derived.s11 * self._sizes[0] * self.laminate.lever

    @property
    def capacitance(self) -> complex:
        """C at equal slopes of both ends, F: n epsS area/t, and for a unimorph the charge of its free extension."""
        one, (width, _), n = self.ceramic.derived, self._sizes, self.sides
        clamped = one.eps33 * (1.0 - 1j * self.dielectric_loss) - one.d31**2 / one.s11  # epsS
        extension = (one.d31 / one.s11 * width) ** 2 / self.laminate.axial_stiffness if n == 1 else 0.0
        return self.length * (n * clamped * width / self.thickness + extension)

    def port(self, omega: Any) -> Port:
        """Moments +F and -F at the right and left end, v the rate of the difference of the slopes there, rad/s.

        The short-circuit stiffness and the mass are those of the beam from `on`, so Z = 0; a shunt adds the stiffness
        i omega B^2/(Y + Y_el) against the difference of the slopes.
        """
        return Port(
            force_factor=self.moment_per_volt,
            short_impedance=0.0 * omega,
            blocked_admittance=1j * omega * self.capacitance,
        )

    def on(self, beam: Beam, positions: Any) -> Beam:
        """The beam with patches centred at `positions` (m), a number or several: stepped, short-circuited.

        The shear stiffness remains that of the bare beam. Raises InputError for patches that overlap or lie off the
        beam, and for a beam that is stepped or not rectangular.
        """
        check_features(beam, "a beam under patches", ("attached", "tension", "foundation"))
        section = self.bonded(beam).laminate
        laminate = {
            name: getattr(section, name)
            for name in ("bending_stiffness", "mass_per_length", "rotary_inertia", "extreme_fibre")
        } | {"shear_stiffness": beam.base_section.shear_stiffness}
        if self.length > beam.length:
            raise InputError(f"patch.length = {self.length!r}: give at most the beam's length, {beam.length!r} m")
        centres = sorted(positions) if hasattr(positions, "__iter__") else [positions]
        sections, end = list[Section](), 0.0
        for centre in centres:
            left, length = centre - 0.5 * self.length, self.length
            if left < end - 1e-9 * beam.length or left + length > beam.length * (1.0 + 1e-9):
                raise InputError(
                    f"position = {centre!r} m: the patch overlaps another or the beam's end, keep {self.length!r} m "
                    f"free between 0 and {beam.length!r} m"
                )
            if left - end > SHORTEST_SECTION * beam.length:
                sections.append(Section(length=left - end))
            sections.append(Section(length=length, **laminate))
            end = left + length
        if beam.length - end > SHORTEST_SECTION * beam.length:
            sections.append(Section(length=beam.length - end))
        return replace(beam, section=tuple(sections))
