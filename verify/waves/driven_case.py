"""A driven beam as one value: a model, what drives it at one frequency, and the devices on it."""

from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.linear.base import BeamModel
from verify.linear.field import HarmonicField, wavenumber
from verify.problem.beam import Beam, PointForce
from verify.problem.device import Device

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache


class DrivenCase(msgspec.Struct, frozen=True, kw_only=True):
    """One model under harmonic forces, or with displacements imposed, at one frequency.

    Raises InputError for a device that its beam cannot have, and for one with a force beside imposed displacements.
    """

    model: BeamModel
    forces: tuple[PointForce, ...]
    """Amplitudes in N, or in m where `kind` is displacement."""
    frequency_hz: float
    kind: str = "force"
    devices: tuple[Device, ...] = ()

    def __post_init__(self) -> None:
        for device in self.devices:
            device.check_on(self.beam)
            if device.amplitude and self.kind != "force":
                raise InputError(
                    f"drive.kind = {self.kind!r}: beside imposed displacements a device has no force of its own, leave "
                    "drive.device.amplitude out"
                )

    @property
    def beam(self) -> Beam:
        """The model's beam."""
        return self.model.beam

    @property
    def acting(self) -> tuple[PointForce, ...]:
        """The forces, those of active devices among them."""
        return (*self.forces, *(device.own_force for device in self.devices if device.amplitude))

    @property
    def passive(self) -> tuple[Device, ...]:
        """The devices without their own forces."""
        return tuple(replace(d, amplitude=0.0) for d in self.devices if d.turning or d.stiffness or d.mass or d.dashpot)

    def field(self, forces: tuple[PointForce, ...], frequency_hz: float) -> HarmonicField:
        """The field under other forces (displacements) at another frequency. Raises InputError."""
        self.model.check_propagates(frequency_hz)
        solve = self.model.harmonic if self.kind == "force" else self.model.imposed
        return solve(forces, frequency_hz, devices=self.passive)

    def wavenumber(self, frequency_hz: float) -> complex:
        """Of waves in the model, 1/m: by its discrete dispersion where that is known, else the beam's.

        Raises NoFigureError at a frequency whose waves do not run along its parts.
        """
        self.model.check_propagates(frequency_hz)
        if self.beam.section:
            return wavenumber(self.beam, frequency_hz, self.model.theory)
        return self.model.wavenumber(frequency_hz)


def driven(case: DrivenCase, cache: "SolutionCache") -> HarmonicField:
    """The field of a case, stored in the cache. Raises InputError."""
    if case not in cache.fields:
        cache.fields[case] = case.field(case.acting, case.frequency_hz)
    return cache.fields[case]
