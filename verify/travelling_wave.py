"""A field in, wave measures and surface ellipses out; fields with devices. The room is `verify.waves`."""

from verify.waves.absorber import matched_device
from verify.waves.devices import field_with_devices
from verify.waves.found import TwoWaves, WaveMeasures
from verify.waves.measures import (
    ellipse,
    fit_waves,
    measure,
    middle_half,
    surface_motion,
    two_waves,
)
from verify.waves.series import measure_series, phasors

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
