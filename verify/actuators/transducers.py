"""Longitudinal transducers with one tip: bars, the stack of layers, the Langevin transducer.

A base, passive and piezoelectric lines, and the tip, whose outward velocity and force are the mechanical port.
"""

from functools import cached_property
from math import sqrt
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, TypeAlias

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.actuators.materials import PIEZO, Direction, Form, MaterialName, PiezoMaterial
from verify.actuators.port import Actuator, Port
from verify.errors import InputError
from verify.validation import Relative, unit, validate

if TYPE_CHECKING:
    from verify.actuators.bar import Line, PiezoLine

Base = Literal["fixed", "free"] | Annotated[float, unit("N/m", gt=0)]


class Parts(NamedTuple):
    """A transducer from its base to its tip."""

    back: "Line | None"
    active: "PiezoLine"
    front: "Line | None"


class Longitudinal(Actuator, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """What all longitudinal transducers share.

    Losses are those of the strain-charge form, which catalogues measure: sE (1 - i/Q), d (1 - i p), epsT (1 - i tan
    delta) with e^{+i omega t} (R. Holland, IEEE Trans. Sonics Ultrason. 14:18, 1967). Raises InputError for values
    outside their limits, and for a piezoelectric loss that makes the ceramic a source of energy.
    """

    material: MaterialName | PiezoMaterial = "pzt-4"
    """Piezoelectric ceramic: pzt-4, pzt-8, or a table of its constants."""
    base: Base = "free"
    """Support of the far end: fixed, free, or the stiffness of a spring, N/m."""
    dielectric_loss: Annotated[Relative, unit("tan delta", ge=0, lt=1)] = 0.0
    """tan delta of the free ceramic."""
    mechanical_loss: Annotated[Relative, unit("1/Q", ge=0, lt=1)] = 0.0
    """1/Q with short-circuited electrodes."""
    piezoelectric_loss: Annotated[Relative, unit("loss tangent", gt=-1, lt=1)] = 0.0
    """Loss tangent of d31 and d33."""
    form: Form = "mason"
    """Mason's three-port, KLM, or the equivalent circuit: equal, but for the truncation of the circuit."""
    branches: Annotated[int, Meta(ge=1, le=100_000)] = 20
    """Number of branches of the equivalent circuit."""

    def __post_init__(self) -> None:
        validate(self, "actuator")
        if self.piezoelectric_loss:
            derived = self.ceramic.derived
            limit = sqrt(self.dielectric_loss * self.mechanical_loss) / max(derived.k33, derived.k31, 1e-300)
            if abs(self.piezoelectric_loss) > limit * (1.0 + 1e-12):
                raise InputError(
                    f"actuator.piezoelectric_loss = {self.piezoelectric_loss!r} makes the ceramic a source of energy: "
                    f"give at most sqrt(dielectric_loss mechanical_loss)/k = {limit:.6g}"
                )

    @property
    def ceramic(self) -> PiezoMaterial:
        """The constants of the material, without losses."""
        return PIEZO[self.material] if isinstance(self.material, str) else self.material

    def bar_constants(self, direction: Direction) -> tuple[complex, complex, complex]:
        """(sE, d, epsT33) of a slender bar with losses: 1/Pa, C/N, F/m."""
        real = self.ceramic.derived
        compliance, d = (real.s33, real.d33) if direction == "33" else (real.s11, real.d31)
        return (
            compliance * (1.0 - 1j * self.mechanical_loss),
            d * (1.0 - 1j * self.piezoelectric_loss),
            real.eps33 * (1.0 - 1j * self.dielectric_loss),
        )

    @property
    def lossless(self) -> "Longitudinal":
        """The transducer without losses."""
        return replace(self, dielectric_loss=0.0, mechanical_loss=0.0, piezoelectric_loss=0.0)

    @cached_property
    def parts(self) -> Parts:
        """Its lines from base to tip."""
        raise NotImplementedError

    def port(self, omega: Any) -> Port:
        """The port at the tip at angular frequencies omega (rad/s), a number or (n,)."""
        back, active, front = self.parts
        base = {"fixed": None, "free": 0.0}[self.base] if isinstance(self.base, str) else self.base / (1j * omega)
        port = active.three_port(omega).port(base if back is None else back.input_impedance(omega, base))
        return port if front is None else front.after(omega, port)

    def _line(self, direction: Direction, *, length: float, area: float, gap: float, layers: int = 1) -> "PiezoLine":
        """A bar of cross-section `area` (m^2), or equal layers; `gap` (m) is the distance of the electrodes.

        C0 = epsT (1 - k^2) A l/gap^2 and N = d A/(sE gap).
        """
        from verify.actuators.bar import PiezoLine

        compliance, d, permittivity = self.bar_constants(direction)
        clamped, density = 1.0 - d**2 / (compliance * permittivity), self.ceramic.density
        speed = (density * compliance * (clamped if direction == "33" else 1.0)) ** -0.5
        return PiezoLine(
            impedance=density * speed * area,
            speed=speed,
            length=length,
            capacitance=permittivity * clamped * area * length / gap**2,
            force_factor=d * area / (compliance * gap),
            along=direction == "33",
            form=self.form,
            branches=self.branches,
            layers=layers,
        )


class Bar33(Longitudinal, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="bar-33"):
    """A slender bar with electrodes on its end faces: the wave runs along the field."""

    length: Annotated[float, unit("m", gt=0)]
    """Distance of the electrodes, m."""
    area: Annotated[float, unit("m^2", gt=0)]
    """Area of its section, m^2."""

    @cached_property
    def parts(self) -> Parts:
        """The bar."""
        return Parts(None, self._line("33", length=self.length, area=self.area, gap=self.length), None)


class Bar31(Longitudinal, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="bar-31"):
    """A slender bar with electrodes on its long sides: the wave runs across the field."""

    length: Annotated[float, unit("m", gt=0)]
    """m."""
    width: Annotated[float, unit("m", gt=0)]
    """Width of the electrodes, m."""
    thickness: Annotated[float, unit("m", gt=0)]
    """Distance of the electrodes, m."""

    @cached_property
    def parts(self) -> Parts:
        """The bar."""
        area = self.width * self.thickness
        return Parts(None, self._line("31", length=self.length, area=area, gap=self.thickness), None)


class Stack(Longitudinal, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="stack"):
    """Layers of alternating polarity, mechanically in series and electrically in parallel, on a fixed base.

    The layers have the voltage in common, so that their waves have the speed of short-circuited electrodes. The usual
    single bar with a common electric displacement, C0 -> n^2 C0 and h -> h/n, has the same stiffness, mass and force
    factor, but its resonances are up to 5 % higher in PZT-4. Bonds and electrodes are left out.
    """

    layers: Annotated[int, Meta(ge=1)]
    """Number of layers."""
    layer_thickness: Annotated[float, unit("m", gt=0)]
    """m."""
    area: Annotated[float, unit("m^2", gt=0)]
    """Area of its section, m^2."""
    base: Base = "fixed"
    """Support of the far end: fixed, free, or the stiffness of a spring, N/m."""

    @cached_property
    def parts(self) -> Parts:
        """The layers."""
        gap = self.layer_thickness
        return Parts(None, self._line("33", length=gap, area=self.area, gap=gap, layers=self.layers), None)


class EndMass(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A cylinder of metal at the end of a Langevin transducer."""

    length: Annotated[float, unit("m", gt=0)]
    """m."""
    youngs_modulus: Annotated[float, unit("Pa", gt=0)]
    """E, Pa."""
    density: Annotated[float, unit("kg/m^3", gt=0)]
    """rho, kg/m^3."""
    area: Annotated[float, unit("m^2", gt=0)] | None = None
    """Area of its section, m^2; default: that of the rings."""

    def __post_init__(self) -> None:
        validate(self, "actuator.mass")


class Langevin(Longitudinal, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="langevin"):
    """Rings of ceramic between two metal masses (P. Langevin, 1920); the tip is the front mass's end.

    The bolt, the bonds and the radius are left out: the masses are slender against the wavelength.
    """

    rings: Annotated[int, Meta(ge=1)]
    """Number of rings, electrically in parallel."""
    ring_thickness: Annotated[float, unit("m", gt=0)]
    """m."""
    area: Annotated[float, unit("m^2", gt=0)]
    """Area of a ring, m^2."""
    front: EndMass
    """Mass at the tip."""
    back: EndMass | None = None
    """Mass at the base; default: that of the tip."""

    @cached_property
    def parts(self) -> Parts:
        """Back mass, rings, front mass."""
        from verify.actuators.bar import Line

        gap, masses = self.ring_thickness, (self.back or self.front, self.front)
        speeds = [(mass.youngs_modulus / mass.density) ** 0.5 for mass in masses]
        back, front = (
            Line(impedance=mass.density * speed * (mass.area or self.area), speed=speed, length=mass.length)
            for mass, speed in zip(masses, speeds, strict=True)
        )
        return Parts(back, self._line("33", length=gap, area=self.area, gap=gap, layers=self.rings), front)


Transducer: TypeAlias = Stack | Bar33 | Bar31 | Langevin
"""The transducers of a scene, by their `kind`: stack, bar-33, bar-31, langevin."""
