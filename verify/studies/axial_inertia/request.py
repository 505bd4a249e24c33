"""What a scene asks about a chain's axial inertia, and how much work that is."""

from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from verify.beam import Beam
from verify.checks import check_number
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.scene import Drive, Scene


STEPS_PER_RADIAN = 15
"""Of a chain's fastest mode, which the tolerance of the study takes."""


LINK_STEP_S = 2e-7
"""Seconds that a link takes in a step."""


STEPPED, BESIDE = 3, 6
"""Nonlinear chains under each force; models side by side, three of which are linear and are not stepped."""


class AxialInertia(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask how far a chain of rigid links departs from the linear one through its axial inertia, over the force."""

    forces: Annotated[tuple[float, ...], Meta(min_length=1)] = (0.1, 1.0, 10.0, 30.0)
    """Newton: amplitudes that all forces of the drive take in turn."""
    shown: float = 10.0
    """Newton: the amplitude at which all models stand side by side."""
    count: Annotated[int, Meta(ge=2, le=250)] = 49
    """Links, and elements beside them; an adaptive step costs O(N^3) over a given time."""
    duration: float = 1e-3
    """Seconds from rest."""
    x: float | None = None
    """Metres from the left end where the deflection is read; mid-span unless given."""

    def __post_init__(self) -> None:
        for i, force in enumerate(self.forces):
            check_number(f"axial_inertia.forces[{i}]", force, "newton", above=0)
        check_number("axial_inertia.shown", self.shown, "newton", above=0)
        check_number("axial_inertia.duration", self.duration, "seconds", above=0)
        if self.x is not None:
            check_number("axial_inertia.x", self.x, "metres", above=0)

    def check_on(self, beam: Beam, drive: "Drive | None") -> None:
        """Raise InputError unless the beam is a chain with a tip that slides, undamped and driven by forces."""
        if drive is None or drive.kind != "force" or not drive.force:
            raise InputError("axial_inertia: the chain is driven by forces, give the scene a [drive] of kind force")
        beam.check_added("axial_inertia")
        if beam.supports not in (("pinned", "pinned"), ("clamped", "pinned"), ("clamped", "free")):
            raise InputError(
                f"axial_inertia with beam.supports = {list(beam.supports)!r}: give a uniform beam that is pinned or "
                "clamped on the left and pinned, or free behind a clamp, on the right"
            )
        if beam.loss_factor:
            raise InputError(
                f"axial_inertia with beam.loss_factor = {beam.loss_factor!r}: its chains move undamped, give 0"
            )
        if self.x is not None and self.x > beam.length:
            raise InputError(f"axial_inertia.x = {self.x!r} lies off the beam: give up to {beam.length!r} m")


def steps_of(asked: AxialInertia, scene: "Scene") -> float:
    """Of each nonlinear chain, about."""
    fastest = 4.0 * 3.0**0.5 * (asked.count / scene.beam.length) ** 2 * scene.beam.wave_constant
    return float(max(STEPS_PER_RADIAN * fastest * asked.duration, 1.0))


def n_stepped(asked: AxialInertia) -> int:
    """Nonlinear chains: under every force and side by side."""
    return STEPPED * (len(asked.forces) + 1)
