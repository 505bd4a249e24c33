"""A field in, wave measures and surface ellipses out; fields with devices. The room is `verify.waves`."""

from verify.waves.devices import field_with_devices
from verify.waves.impedance_matching import matched_device
from verify.waves.results import TwoWaves, WaveMeasures
from verify.waves.series import measure_series, phasors
from verify.waves.two_waves import (
    ellipse,
    fit_waves,
    measure,
    middle_half,
    surface_motion,
    two_waves,
)

__all__ = [
    "TwoWaves",
    "WaveMeasures",
    "ellipse",
    "field_with_devices",
    "fit_waves",
    "matched_device",
    "measure",
    "measure_series",
    "middle_half",
    "phasors",
    "surface_motion",
    "two_waves",
]
