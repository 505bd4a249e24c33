"""Quantities of the scene's transducer, drive.actuator, with a free tip."""

from typing import Annotated, Any, Literal

from msgspec import Meta

from verify.actuators import resonances
from verify.actuators.port import Actuator
from verify.actuators.transducers import Longitudinal
from verify.errors import InputError
from verify.quantities.base import Scene, quantity
from verify.validation import unit

Resonance = Annotated[int, Meta(ge=1, description="electrical resonance, from 1")]
Element = Annotated[Literal["capacitance", "inductance"], Meta(description="C_n in F, or L_n in H")]
Hertz = Annotated[float, unit("Hz"), Meta(gt=0, description="frequency, Hz")]
DRIVE = ("drive",)


def scene_actuator(scene: Scene, kind: type = Actuator, example: str = "stack") -> Any:
    """The scene's actuator. Raises InputError where it has none of this kind."""
    actuator = scene.drive.actuator if scene.drive is not None else None
    if not isinstance(actuator, kind):
        remedy = f"give kind = {example!r} and its sizes"
        if actuator is None:
            raise InputError(f"drive.actuator is missing: add [drive.actuator], and {remedy}")
        own = type(actuator).__name__.lower()
        raise InputError(f"drive.actuator is a {own}, for which this quantity is not defined: {remedy}")
    return actuator


@quantity("actuator.resonance", unit="Hz", reads=DRIVE)
def resonance(scene: Scene, *, n: Resonance = 1) -> float:
    """Frequency of the transducer with short-circuited electrodes, without losses."""
    return float(resonances.resonances(scene_actuator(scene, Longitudinal), n)[-1])


@quantity("actuator.antiresonance", unit="Hz", reads=DRIVE)
def antiresonance(scene: Scene, *, n: Resonance = 1) -> float:
    """Frequency of the transducer with open electrodes, without losses."""
    return float(resonances.antiresonances(scene_actuator(scene, Longitudinal), n)[-1])


@quantity("actuator.coupling", unit="1", reads=DRIVE)
def coupling(scene: Scene, *, n: Resonance = 1) -> float:
    """Effective electromechanical coupling factor, sqrt(1 - (f_r/f_a)^2)."""
    return resonances.coupling(scene_actuator(scene, Longitudinal), n)


@quantity("actuator.impedance", unit="ohm", reads=DRIVE)
def impedance(scene: Scene, *, frequency_hz: Hertz) -> complex:
    """Electrical impedance of the transducer with its losses."""
    return complex(resonances.impedance(scene_actuator(scene, Longitudinal), frequency_hz))


@quantity("actuator.branch", unit="F or H", reads=DRIVE)
def branch(scene: Scene, *, n: Resonance = 1, element: Element = "capacitance") -> float:
    """Capacitance or inductance of a branch of the equivalent circuit (Butterworth and Van Dyke)."""
    return float(getattr(resonances.branch(scene_actuator(scene, Longitudinal), n), element))
