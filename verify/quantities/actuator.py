"""Quantities of the scene's transducer, drive.actuator, with a free tip."""

from typing import Annotated, Literal

from msgspec import Meta

from verify.actuators.transducers import Longitudinal
from verify.errors import InputError
from verify.quantities.base import Scene, quantity
from verify.validation import unit

Resonance = Annotated[int, Meta(ge=1, description="electrical resonance, from 1")]
Element = Annotated[Literal["capacitance", "inductance"], Meta(description="C_n in F, or L_n in H")]
Hertz = Annotated[float, unit("Hz"), Meta(gt=0, description="frequency, Hz")]
DRIVE = ("drive",)


def _transducer(scene: Scene) -> Longitudinal:
    """The scene's transducer. Raises InputError where it has none."""
    actuator = scene.drive.actuator if scene.drive is not None else None
    if not isinstance(actuator, Longitudinal):
        raise InputError("drive.actuator is missing: add [drive.actuator] with kind = 'stack', layers and their sizes")
    return actuator


@quantity("actuator.resonance", unit="Hz", reads=DRIVE)
def resonance(scene: Scene, *, n: Resonance = 1) -> float:
    """Frequency of the transducer with short-circuited electrodes, without losses."""
    from verify.actuators.resonances import resonances

    return float(resonances(_transducer(scene), n)[-1])


@quantity("actuator.antiresonance", unit="Hz", reads=DRIVE)
def antiresonance(scene: Scene, *, n: Resonance = 1) -> float:
    """Frequency of the transducer with open electrodes, without losses."""
    from verify.actuators.resonances import antiresonances

    return float(antiresonances(_transducer(scene), n)[-1])


@quantity("actuator.coupling", unit="1", reads=DRIVE)
def coupling(scene: Scene, *, n: Resonance = 1) -> float:
    """Effective electromechanical coupling factor, sqrt(1 - (f_r/f_a)^2)."""
    from verify.actuators.resonances import coupling

    return coupling(_transducer(scene), n)


@quantity("actuator.impedance", unit="ohm", reads=DRIVE)
def impedance(scene: Scene, *, frequency_hz: Hertz) -> complex:
    """Electrical impedance of the transducer with its losses."""
    from verify.actuators.resonances import impedance

    return complex(impedance(_transducer(scene), frequency_hz))


@quantity("actuator.branch", unit="F or H", reads=DRIVE)
def branch(scene: Scene, *, n: Resonance = 1, element: Element = "capacitance") -> float:
    """Capacitance or inductance of a branch of the equivalent circuit (Butterworth and Van Dyke)."""
    from verify.actuators.resonances import branch

    return float(getattr(branch(_transducer(scene), n), element))
