"""A driven beam as one value: whose field is solved, under what, at which frequency."""

from typing import Any

import msgspec

from verify.beam import Beam, PointForce
from verify.models.catalogue import MODELS


class DrivenCase(msgspec.Struct, frozen=True, kw_only=True):
    """One model's beam under forces, or with displacements imposed, at one frequency."""

    beam: Beam
    model: str
    count: int | None
    """Segments or elements; None for a model without parts."""
    forces: tuple[PointForce, ...]
    """Amplitudes in newton, or in metres where `kind` is displacement."""
    frequency_hz: float
    kind: str = "force"
    settings: tuple[tuple[str, Any], ...] = ()
    """Keywords of the model's `solve_harmonic` other than their defaults."""

    def check_carried(self) -> None:
        """Raise CutOffError where no wave of this frequency runs along the model's parts."""
        if self.count is not None and self.beam.uniform:
            MODELS.named(self.model).check_carried(self.beam, self.count, self.frequency_hz)
