"""Finite segments against finite elements against exact beam theory: how far to trust them, at what cost.

What there is (`help` of each says its fields, shapes and units; everything is SI):

  Beam, Section, PointMass, PointSpring, PointForce, Slider    what exists
  Device                                                       what takes up a wave, or drives it, beside the forces
  ExactModel, HermiteModel, SegmentModel                       models of a beam: modes, harmonic, imposed, ...
  Modes, HarmonicField                                         what those return
  travelling_wave                                              the wave that a field carries: measure, WaveMeasures
  simulate, Motion                                             a driven beam in time, with sliders or without
  run_motor, run_motors, MotorRun, Contact, Foot               sliders that may leave the beam, on feet of many points
  free_vibration, FreeVibration                                a beam let go from a shape, without forces
  bend, Bent                                                   a chain under a large load at its tip
  load_scene, run_scene                                        a scene file, and what its gates and studies find
  InputError                                                   bad input, in one sentence

  beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
  SegmentModel(beam, n_segments=49).modes(22).frequencies_hz

The command line is `verify --help`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify import travelling_wave
    from verify.analytic_modes import ExactModel
    from verify.chain.statics import Bent, bend
    from verify.dynamics.free_vibration import FreeVibration, free_vibration
    from verify.dynamics.result import Motion
    from verify.dynamics.simulate import simulate
    from verify.errors import InputError
    from verify.fem_beam import HermiteModel
    from verify.linear.field import HarmonicField
    from verify.linear.modes import Modes
    from verify.motor.result import MotorRun
    from verify.motor.run import run_motor, run_motors
    from verify.problem.beam import Beam, PointForce
    from verify.problem.cross_section import Section
    from verify.problem.device import Device
    from verify.problem.point_attachments import PointMass, PointSpring
    from verify.problem.slider import Contact, Foot, Slider
    from verify.scene.load import load_scene
    from verify.scene.run import run_scene
    from verify.segment_model import SegmentModel
    from verify.travelling_wave import WaveMeasures

__all__ = [
    "Beam", "Bent", "Contact", "Device", "ExactModel", "Foot", "FreeVibration", "HarmonicField", "HermiteModel",
    "InputError", "Modes", "Motion", "MotorRun", "PointForce", "PointMass", "PointSpring", "Section",
    "SegmentModel", "Slider", "WaveMeasures", "__version__", "bend", "free_vibration", "load_scene", "run_motor",
    "run_motors", "run_scene", "simulate", "travelling_wave",
]  # fmt: skip
__version__ = "0.1.0"

_HOMES = {
    "verify": ("travelling_wave",),
    "verify.analytic_modes": ("ExactModel",),
    "verify.fem_beam": ("HermiteModel",),
    "verify.segment_model": ("SegmentModel",),
    "verify.problem.point_attachments": ("PointMass", "PointSpring"),
    "verify.problem.beam": ("Beam", "PointForce"),
    "verify.chain.statics": ("Bent", "bend"),
    "verify.problem.device": ("Device",),
    "verify.errors": ("InputError",),
    "verify.linear.field": ("HarmonicField",),
    "verify.linear.modes": ("Modes",),
    "verify.dynamics.free_vibration": ("FreeVibration", "free_vibration"),
    "verify.dynamics.result": ("Motion",),
    "verify.dynamics.simulate": ("simulate",),
    "verify.motor.result": ("MotorRun",),
    "verify.motor.run": ("run_motor", "run_motors"),
    "verify.scene.load": ("load_scene",),
    "verify.scene.run": ("run_scene",),
    "verify.problem.cross_section": ("Section",),
    "verify.problem.slider": ("Contact", "Foot", "Slider"),
    "verify.travelling_wave": ("WaveMeasures",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}


def __getattr__(name: str) -> Any:
    """Import a public name at its first use."""
    if name not in _HOME:
        raise AttributeError(f"module 'verify' has no attribute {name!r}")
    home = _HOME[name]
    return import_module(f"verify.{name}") if home == "verify" else getattr(import_module(home), name)


def __dir__() -> list[str]:
    """All public names, imported or not."""
    return sorted(__all__)
