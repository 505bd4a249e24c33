"""One way of driving in one condition: what is driven, and what is seen of its exact field."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Literal, TypeAlias

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.device import Device
from verify.errors import ResonanceError
from verify.models.catalogue import MODELS
from verify.waves.case import DrivenCase
from verify.waves.devices import powers
from verify.waves.driven import driven
from verify.waves.found import STANDING, reflections
from verify.waves.lumped import local_waves

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene
    from verify.studies.methods.study import Methods

Way: TypeAlias = Literal["device", "forces"]
WAYS: tuple[Way, ...] = ("device", "forces")
WORDS: dict[Way, str] = {"device": "device", "forces": "two forces"}


class Seen(msgspec.Struct, frozen=True, kw_only=True):
    """One way of driving in one condition."""

    reflection: float
    """Halfway from the force to a load, or to the middle; 0 where it is rounding."""
    behind: float
    """Halfway from there to the device."""
    amplitude: float
    """Of the stronger wave before a load, metres."""
    runs_on: bool
    """Whether the stronger wave runs from the force to the device."""
    given: tuple[float, ...]
    """Power that each force gives, watt."""
    absorbed: float
    """Power that the device takes, watt; 0 without one."""


class Setting(msgspec.Struct, frozen=True, kw_only=True):
    """What is driven: the beam with its force, the device, and the force in its place."""

    beam: Beam
    force: PointForce
    device: Device
    second: PointForce
    hertz: float

    def case(self, way: Way, *, off_hz: float = 0.0, load: Device | None = None) -> DrivenCase:
        """The exact beam one way, so many hertz off, perhaps with a load on it."""
        devices = (self.device,) if way == "device" else ()
        return DrivenCase(
            beam=self.beam,
            model="analytic",
            count=None,
            forces=(self.force,) if way == "device" else (self.force, self.second),
            frequency_hz=self.hertz + off_hz,
            devices=(*devices, load) if load else devices,
        )

    def reads(self, load: float | None) -> tuple[float, float]:
        """Halfway from the force to a load and from there to the device, metres; without one to the middle."""
        start, end = self.force.position, self.device.position
        middle = 0.5 * (start + end) if load is None else load
        return 0.5 * (start + middle), 0.5 * (middle + end)


def setting_of(scene: "Scene", asked: "Methods") -> Setting:
    """What a scene with one force and one device drives, and the force that the other way has for the device."""
    (force,), (device,) = scene.forces, scene.devices
    assert scene.drive is not None
    second = replace(force, position=device.position, phase_deg=force.phase_deg + asked.phase_deg)
    return Setting(beam=scene.beam, force=force, device=device, second=second, hertz=scene.drive.frequency_hz)


def seen_of(setting: Setting, case: DrivenCase, bench: "Workbench") -> Seen | None:
    """The waves of a case, and what its forces give; None on a resonance."""
    try:
        field = driven(case, bench)
    except ResonanceError:
        return None
    load = next((device.position for device in case.devices if device != setting.device), None)
    plus, minus = local_waves(field, np.array(setting.reads(load)))
    found = reflections(plus, minus)
    before, behind = np.where(found < STANDING, 0.0, found)  # less is rounding
    on = abs(plus[0]) >= abs(minus[0])
    speeds = abs(field.omega * field.deflection([device.position for device in case.devices])) ** 2
    taken = [0.5 * device.dashpot * float(v) for device, v in zip(case.devices, speeds, strict=True)]
    return Seen(
        reflection=float(before),
        behind=float(behind),
        amplitude=float(max(abs(plus[0]), abs(minus[0]))),
        runs_on=bool(on == (setting.device.position > setting.force.position)),
        given=powers(field, case.forces),
        absorbed=taken[0] if setting.device in case.devices else 0.0,
    )


class Row(msgspec.Struct, frozen=True, kw_only=True):
    """One condition, both ways; None where the way knows no such condition, or the beam is in resonance."""

    what: str
    value: float
    """Hertz off, factor, kilograms or N s/m."""
    device: Seen | None
    forces: Seen | None


def worst(rows: Sequence[Row], way: Way) -> float | None:
    """The largest reflection over conditions; None where one is not known."""
    found = [getattr(row, way) for row in rows]
    return max(one.reflection for one in found) if all(found) else None


def model_title(model: str, count: int | None) -> str:
    """'49 segments', 'exact beam'."""
    return f"{count} {MODELS[model].parts}" if count else MODELS[model].title
