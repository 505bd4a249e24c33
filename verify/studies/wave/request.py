"""What a scene asks about its driven beam."""

from typing import Annotated

import msgspec

from verify.checks import Relative, check_number
from verify.models.naming import model_meta
from verify.studies.modes.convergence import Counts


class Wave(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the driven beam: the motor's figures over sizes, envelopes, ellipses, a map with operating points."""

    count: Annotated[int, msgspec.Meta(ge=1)] = 49
    """Segments and elements of the envelopes and, with `model`, of the map."""
    counts: Counts = (49, 98, 196)
    """Segments and elements of the motor's figures."""
    model: Annotated[str, model_meta("of the map", "solve_harmonic")] = "segment"
    quantity: str = "wave.standing_wave_ratio"
    """What the map shows."""
    frequency_hz: tuple[float, float, int] | None = None
    """Start, end and steps of the map; a tenth below and above the scene's drive unless given."""
    phase_deg: tuple[float, float, int] = (0.0, 180.0, 91)
    """Start, end and steps of the map, degrees between the two forces."""
    reflection_limit: Relative = 0.1
    """Largest reflection, relative, that an operating point may have."""
    operating_loss_factor: Relative = 1e-3
    """For the operating points where the beam is undamped: without losses the crest speed has no bound."""

    def __post_init__(self) -> None:
        spans = {"frequency_hz": self.frequency_hz, "phase_deg": self.phase_deg}
        for name, span in spans.items():
            if span is None:
                continue
            start, end, steps = span
            check_number(f"wave.{name}[0]", start, "start of the map", above=0 if name == "frequency_hz" else -3600)
            check_number(f"wave.{name}[1]", end, "end of the map", above=start)
            check_number(f"wave.{name}[2]", steps, "steps of the map", above=1, below=2001)
        check_number("wave.reflection_limit", self.reflection_limit, "relative", above=0, below=1)
        check_number("wave.operating_loss_factor", self.operating_loss_factor, "eta", above=0, below=1)


MAP_STEPS = 121


SPREAD = 0.1
"""Of the drive's frequency, below and above it, that a map covers unless it is told."""


def around(drive_hz: float, steps: int) -> tuple[float, float, int]:
    """Start, end and steps of the frequencies about a drive's."""
    return (1.0 - SPREAD) * drive_hz, (1.0 + SPREAD) * drive_hz, steps
