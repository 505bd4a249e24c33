"""Longitudinal transducers with one tip: bars, the stack of layers, the Langevin transducer.

A base, a passive or piezoelectric line, and the tip, whose outward velocity and force are the mechanical port.
"""

from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, TypeAlias

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.actuators.materials import PIEZO, Direction, Form, MaterialName, PiezoMaterial
from verify.actuators.port import Actuator, Port
from verify.validation import Relative, unit, validate

if TYPE_CHECKING:
    from verify.actuators.bar import Line, PiezoLine

Base = Literal["fixed", "free"] | Annotated[float, unit("N/m", gt=0)]
Loss = Annotated[Relative, unit("loss tangent", ge=0, lt=1)]
LOSSES = ("dielectric_loss", "mechanical_loss", "piezoelectric_loss")


class Parts(NamedTuple):
    """A transducer from its base to its tip."""

    back: "Line | None"
    active: "PiezoLine"
    front: "Line | None"


class Longitudinal(Actuator, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """What all longitudinal transducers share. Raises InputError for values outside their limits."""

    material: MaterialName | PiezoMaterial = "pzt-4"
    """Piezoelectric ceramic: pzt-4, pzt-8, or a table of its constants."""
    base: Base = "free"
    """Support of the far end: fixed, free, or the stiffness of a spring, N/m."""
    dielectric_loss: Loss | None = None
    """tan delta of the free ceramic; default: the material's."""
    mechanical_loss: Loss | None = None
    """1/Q of the ceramic; default: the material's."""
    piezoelectric_loss: Annotated[Relative, unit("loss tangent", gt=-1, lt=1)] | None = None
    """Loss tangent of d31 and d33; default: the material's."""
    form: Form = "mason"
    """Mason's three-port, KLM, or the equivalent circuit: equal, but for the truncation of the circuit."""
    branches: Annotated[int, Meta(ge=1, le=100_000)] = 20
    """Number of branches of the equivalent circuit."""

    def __post_init__(self) -> None:
        validate(self, "actuator")
        _ = self.ceramic

    @cached_property
    def ceramic(self) -> PiezoMaterial:
        """The material with the transducer's own losses. Raises InputError where they make it a source of energy."""
        material = PIEZO[self.material] if isinstance(self.material, str) else self.material
        own = {name: value for name in LOSSES if (value := getattr(self, name)) is not None}
        return replace(material, **own) if own else material

    @property
    def lossless(self) -> "Longitudinal":
        """The transducer without losses."""
        return replace(self, **dict.fromkeys(LOSSES, 0.0))

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

    def _piezo(self, direction: Direction, **sizes: Any) -> "PiezoLine":
        from verify.actuators.bar import piezo_line

        return piezo_line(self.ceramic, direction, form=self.form, branches=self.branches, **sizes)


class Bar33(Longitudinal, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="bar-33"):
    """A slender bar with electrodes on its end faces: the wave runs along the field."""

    length: Annotated[float, unit("m", gt=0)]
    """Distance of the electrodes, m."""
    area: Annotated[float, unit("m^2", gt=0)]
    """Area of its section, m^2."""

    @cached_property
    def parts(self) -> Parts:
        """The bar."""
        return Parts(None, self._piezo("33", length=self.length, area=self.area, gap=self.length), None)


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
        area, gap = self.width * self.thickness, self.thickness
        return Parts(None, self._piezo("31", length=self.length, area=area, gap=gap), None)


class Stack(Longitudinal, frozen=True, kw_only=True, forbid_unknown_fields=True, tag_field="kind", tag="stack"):
    """Layers of alternating polarity, mechanically in series and electrically in parallel, on a fixed base.

    The layers have the voltage in common, so that their waves have the speed of short-circuited electrodes. The bar
    with a common electric displacement, C0 -> n^2 C0 and h -> h/n, has the same stiffness, mass and force factor, but
    its resonances are up to 5 % higher in PZT-4. Bonds and electrodes are left out.
    """

    layers: Annotated[int, Meta(ge=1)]
    """Number of layers."""
    layer_thickness: Annotated[float, unit("m", gt=0)]
    """m."""
    area: Annotated[float, unit("m^2", gt=0)]
    """Area of its section, m^2."""
    layering: Literal["layers", "one-bar"] = "layers"
    """layers: exact; one-bar: as a single bar, well below the first resonance."""
    base: Base = "fixed"
    """Support of the far end: fixed, free, or the stiffness of a spring, N/m."""

    @cached_property
    def parts(self) -> Parts:
        """The layers."""
        joined, layers = (self.layers, 1) if self.layering == "one-bar" else (1, self.layers)
        gap = self.layer_thickness
        return Parts(None, self._piezo("33", length=joined * gap, area=self.area, gap=gap, layers=layers), None)


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
    loss_factor: Loss = 0.0
    """E (1 + i eta)."""

    def __post_init__(self) -> None:
        validate(self, "actuator.mass")

    def line(self, area: float) -> "Line":
        """The mass as a line; `area` (m^2) is that of the rings."""
        from verify.actuators.bar import Line

        speed = (self.youngs_modulus * (1.0 + 1j * self.loss_factor) / self.density) ** 0.5
        return Line(impedance=self.density * speed * (self.area or area), speed=speed, length=self.length)


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

    @property
    def lossless(self) -> "Langevin":
        """The transducer without losses."""
        masses = {name: replace(mass, loss_factor=0.0) for name in ("front", "back") if (mass := getattr(self, name))}
        return replace(self, **dict.fromkeys(LOSSES, 0.0), **masses)

    @cached_property
    def parts(self) -> Parts:
        """Back mass, rings, front mass."""
        gap = self.ring_thickness
        rings = self._piezo("33", length=gap, area=self.area, gap=gap, layers=self.rings)
        return Parts((self.back or self.front).line(self.area), rings, self.front.line(self.area))


Transducer: TypeAlias = Stack | Bar33 | Bar31 | Langevin
"""The transducers of a scene, by their `kind`: stack, bar-33, bar-31, langevin."""
