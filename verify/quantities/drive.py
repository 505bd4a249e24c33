"""Quantities of actuators on a driven beam: force per volt, power, and the wave under voltages."""

from math import pi
from typing import Annotated, TypeVar

from msgspec import Meta
from msgspec.structs import replace

from verify.actuators.on_beam import ActuatorState
from verify.actuators.patch import Patch
from verify.actuators.port import Port
from verify.actuators.transducers import Longitudinal
from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.linear.field import lossless_wavenumber
from verify.quantities import options as opt
from verify.quantities.actuator import scene_actuator
from verify.quantities.base import Scene, figures, quantity
from verify.quantities.waves import (
    DRIVEN,
    DirectedOptions,
    FieldOptions,
    WaveOptions,
    driven_case,
    pure_drive,
    wave_in_window,
)
from verify.travelling_wave import WaveMeasures

Options = TypeVar("Options", bound=FieldOptions)
Number = Annotated[int, Meta(ge=1, description="number of the actuator in drive.force, then in drive.shunt, from 1")]


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


def _voltages(options: Options) -> Options:
    return replace(options, drive="voltage") if options.drive is None else options


def _wave(scene: Scene, cache: SolutionCache, options: WaveOptions) -> WaveMeasures:
    return wave_in_window(scene, cache, _voltages(options))


wave = figures("wave", _wave, reads=DRIVEN, devices=True)
wave(
    "voltage_ratio",
    "1",
    "Standing-wave ratio with the drive's amplitudes as voltages of its actuators.",
    "standing_wave_ratio",
)
wave(
    "voltage_direction",
    "1",
    "Direction of the stronger wave under voltages: +1 towards +x, -1 towards -x.",
    "waves.direction",
)


@quantity("wave.pure_voltage_phase", unit="deg", reads=DRIVEN, devices=True)
def pure_voltage_phase(scene: Scene, options: DirectedOptions) -> float:
    """Phase lead of the second of two equal voltages with least reflection, in (-180, 180] degrees."""
    return pure_drive(scene, _voltages(options)).equal_phase_deg


def _actuator(scene: Scene, options: FieldOptions, actuator: int) -> ActuatorState:
    """The ports of an actuator, from 1. Raises InputError."""
    case = driven_case(scene, options)
    if case.kind == "displacement" or not (case.electrical or case.shunts):
        raise InputError(f"drive.kind = {case.kind!r}: no actuator takes electrical power, give 'voltage' or 'current'")
    states = case.actuated(case.acting, case.frequency_hz).actuators
    if actuator > len(states):
        raise InputError(f"actuator = {actuator!r}: the drive has {len(states)} actuators, give at most that")
    return states[actuator - 1]


@quantity("drive.power", unit="W", reads=DRIVEN, devices=True)
def power(scene: Scene, options: FieldOptions, *, actuator: Number = 1) -> float:
    """Mean electrical power into an actuator; negative where it returns power to its source or feeds a load."""
    return _actuator(scene, options, actuator).power_in


@quantity("drive.current", unit="A", reads=DRIVEN, devices=True)
def current(scene: Scene, options: FieldOptions, *, actuator: Number = 1) -> float:
    """Amplitude of the current into an actuator, by which an amplifier is chosen."""
    return abs(_actuator(scene, options, actuator).current)
