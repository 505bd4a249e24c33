"""A driven beam as one value: whose field is solved, under what, at which frequency."""

from typing import Any

import msgspec

from verify.errors import InputError
from verify.linear.catalogue import MODELS
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device


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
    devices: tuple[Device, ...] = ()
    """What stands on the beam beside the forces."""

    def check_devices(self) -> None:
        """Raise InputError for a device that this beam cannot have, or beside displacements that are imposed."""
        for device in self.devices:
            device.check_on(self.beam)
        if self.devices and self.kind != "force":
            raise InputError(f"drive.kind = {self.kind!r}: beside a device forces drive the beam, give 'force'")

    def check_no_devices(self, what: str) -> None:
        """Raise InputError for something that knows forces alone."""
        if self.devices:
            raise InputError(
                f"drive.device at {self.devices[0].position:g} m: {what} superposes two forces without a device, leave "
                "it out"
            )

    def check_carried(self) -> None:
        """Raise NoFigureError where no wave of this frequency runs along the model's parts."""
        if self.count is not None and self.beam.uniform:
            MODELS.named(self.model).check_carried(self.beam, self.count, self.frequency_hz)
