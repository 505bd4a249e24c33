"""Quantities of the scene's actuator: a transducer with a free tip, on a driven beam, and with a shunt."""

from math import pi
from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta
from msgspec.structs import replace

from verify.actuators import resonances
from verify.actuators.patch import Patch
from verify.actuators.port import Actuator, Port
from verify.actuators.shunt import Circuit, Load, ShuntedMode, absorbing_load
from verify.actuators.transducers import Longitudinal
from verify.errors import InputError
from verify.linear.field import lossless_wavenumber
from verify.linear.registry import EXACT, MODELS
from verify.quantities import options as opt
from verify.quantities.base import Place, Scene, quantity
from verify.quantities.waves import DRIVEN, FromRightEnd, ending_at
from verify.validation import Relative, unit
from verify.waves.impedance_matching import Ending

Resonance = Annotated[int, Meta(ge=1, description="electrical resonance, from 1")]
Element = Annotated[Literal["capacitance", "inductance"], Meta(description="C_n in F, or L_n in H")]
Hertz = Annotated[float, unit("Hz"), Meta(gt=0, description="frequency, Hz")]
ShortHz = Annotated[float, unit("Hz"), Meta(gt=0, description="frequency of the mode with short-circuited electrodes")]
Ohm = Annotated[float, unit("ohm"), Meta(gt=0, description="resistance; default: that of the optimum")]
Henry = Annotated[float, unit("H"), Meta(gt=0, description="inductance; default: that of the optimum")]
Figure = Annotated[Literal["resistance", "inductance"], Meta(description="ohm or H")]
Optimum = Annotated[
    Literal["resistance", "inductance", "peak", "loss_factor"],
    Meta(description="ohm, H, or without a unit; loss_factor: Im/Re of the stiffness at short_hz"),
]
Detuning = Annotated[Relative, Meta(gt=-1, description="relative error of the inductance")]
DRIVE = ("drive",)


def scene_actuator(scene: Scene, kind: type = Actuator, example: str = "stack") -> Any:
    """The scene's actuator. Raises InputError where it has none of this kind."""
    actuator = scene.drive.actuator if scene.drive is not None else None
    if not isinstance(actuator, kind):
        remedy = f"give kind = {example!r} and its sizes"
        if actuator is None:
            raise InputError(f"drive.actuator is missing: add [drive.actuator], and {remedy}")
        name = type(actuator).__name__.lower()
        raise InputError(f"drive.actuator is a {name}, for which this quantity is not defined: {remedy}")
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


def _port(scene: Scene, frequency_hz: float | None) -> Port:
    """The port of the scene's transducer."""
    actuator: Longitudinal = scene_actuator(scene, Longitudinal)
    return actuator.port(2.0 * pi * opt.drive_frequency(scene, frequency_hz))


@quantity("drive.force_per_volt", unit="N/V", reads=DRIVEN, devices=True)
def force_per_volt(scene: Scene, *, frequency_hz: opt.Frequency | None = None) -> float:
    """Magnitude of the blocked force of an actuator per volt."""
    return abs(complex(_port(scene, frequency_hz).force_factor))


@quantity("drive.moment_per_volt", unit="N m/V", reads=DRIVEN, devices=True)
def moment_per_volt(scene: Scene) -> float:
    """Magnitude of the bending moment of a patch per volt."""
    patch: Patch = scene_actuator(scene, Patch, "patch")
    return abs(patch.bonded(scene.beam).moment_per_volt)


@quantity("drive.impedance_ratio", unit="1", reads=DRIVEN, devices=True)
def impedance_ratio(scene: Scene, *, frequency_hz: opt.Frequency | None = None) -> float:
    """Dynamic stiffness omega |Z| of a short-circuited actuator over EI k^3: far above 1 it imposes displacements."""
    hertz, port = opt.drive_frequency(scene, frequency_hz), _port(scene, frequency_hz)
    stiffness = scene.beam.bending_stiffness * abs(lossless_wavenumber(scene.beam, hertz)) ** 3
    return 2.0 * pi * hertz * abs(complex(port.short_impedance)) / stiffness


class ShuntOptions(msgspec.Struct, frozen=True, kw_only=True):
    """A mode with an actuator, and its shunt: coupling K, or a mode of the beam under the scene's patch."""

    circuit: Annotated[Circuit, Meta(description="shunt; hagood: series R-L by the transfer-function rule")] = "series"
    coupling: Annotated[Relative, Meta(gt=0, description="K = sqrt((f_open/f_short)^2 - 1)")] | None = None
    short_hz: ShortHz = 1.0 / (2.0 * pi)
    capacitance: Annotated[float, unit("F"), Meta(gt=0, description="blocked capacitance, with coupling, F")] = 1.0
    negative: Annotated[Relative, Meta(gt=0, description="negative capacitance over the actuator's")] | None = None
    mode: Annotated[int, Meta(ge=1, description="mode of the beam under the scene's patch, for coupling")] | None = None
    position: Annotated[Place, Meta(description="centre of this patch, m from the left end")] | None = None

    def best(self, scene: Scene) -> tuple[ShuntedMode, Load]:
        """The mode and the optimum load of the circuit. Raises InputError."""
        if self.coupling is not None and self.mode is None:
            omega = 2.0 * pi * self.short_hz
            mode = ShuntedMode(coupling=self.coupling, omega=omega, capacitance=self.capacitance)
        elif self.coupling is None and self.mode is not None and self.position is not None:
            patch = scene_actuator(scene, Patch, "patch")
            modes = MODELS[EXACT].build(patch.on(scene.beam, self.position)).modes(self.mode + 60)
            mode = ShuntedMode.bonded(modes, patch.bonded(scene.beam), self.position, self.mode)
        else:
            raise InputError(f"coupling = {self.coupling!r}, mode = {self.mode!r}: give coupling, or mode and position")
        return mode, mode.optimum(self.circuit, None if self.negative is None else self.negative * mode.capacitance)


@quantity("shunt.peak", unit="1", reads=DRIVEN)
def peak(scene: Scene, shunt: ShuntOptions, *, resistance: Ohm | None = None, inductance: Henry | None = None) -> float:
    """Largest response of a shunted mode over its static deflection with short-circuited electrodes."""
    mode, load = shunt.best(scene)
    if inductance is not None:
        load.part("inductance")  # raises InputError for a circuit without one
        load = replace(load, inductance=inductance)
    return mode.peak(replace(load, resistance=resistance or load.resistance))


@quantity("shunt.optimum", unit="1, ohm or H", reads=DRIVEN)
def optimum(scene: Scene, shunt: ShuntOptions, *, figure: Optimum = "peak") -> float:
    """Optimum of a shunt in closed form: its resistance, inductance, peak of the response, or loss factor."""
    mode, load = shunt.best(scene)
    if figure in ("peak", "loss_factor"):
        return float(getattr(mode, figure)(load))
    return load.part(figure)


def _absorber(scene: Scene, position: float, frequency_hz: float | None) -> tuple[Port, Ending, Load, float]:
    """(port, beam behind it, matched load, omega) of the scene's actuator. Raises InputError."""
    end = ending_at(scene, position=position, frequency_hz=frequency_hz)
    omega = 2.0 * pi * opt.drive_frequency(scene, frequency_hz)
    port = _port(scene, frequency_hz)
    return port, end, absorbing_load(port, end.matched, omega), omega


@quantity("shunt.absorber", unit="ohm or H", reads=DRIVEN, devices=True)
def absorber(
    scene: Scene, *, position: FromRightEnd, frequency_hz: opt.Frequency | None = None, figure: Figure = "resistance"
) -> float:
    """Series load with which the scene's actuator near the right end absorbs a wave: its resistance or inductance."""
    return _absorber(scene, position, frequency_hz)[2].part(figure)


@quantity("shunt.reflection", unit="1", reads=DRIVEN, devices=True)
def reflection(
    scene: Scene, *, position: FromRightEnd, frequency_hz: opt.Frequency | None = None, detuning: Detuning = 0.0
) -> float:
    """Reflection Gamma at the scene's actuator near the right end with the matched load, its inductance detuned."""
    port, end, load, omega = _absorber(scene, position, frequency_hz)
    load = replace(load, inductance=load.part("inductance") * (1.0 + detuning))
    return end.reflection(port.loaded_impedance(load.admittance(omega)))
