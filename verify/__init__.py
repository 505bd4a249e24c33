"""Finite segments against finite elements against exact beam theory: how far to trust them, at what cost.

What there is (`help` of each says its fields, shapes and units; everything is SI):

  Beam, Section, PointMass, PointSpring, PointForce, Slider    what exists
  Device                                                       what takes up a wave, or drives it, beside the forces
  analytic_modes, fem_beam, segment_model                      the three models: solve_modes, solve_harmonic, ...
  Modes, HarmonicField                                         what those return
  sweep_harmonic, sweep_modes of each                          many frequencies (HarmonicSweep) or beams in one call
  travelling_wave                                              what kind of wave a field carries: measure, WaveMeasures
  simulate, Motion                                             a driven beam in time, with a slider or without
  run_motor, run_motors, MotorRun, Contact, Foot               sliders that may leave the beam, on feet of many points
  free_vibration, FreeVibration                                a beam let go from a shape, without forces
  bend, Bent                                                   a chain under a large load at its tip
  load_scene, run_scene                                        a scene file, and what its gates and studies find
  InputError                                                   bad input, in one sentence

  beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
  segment_model.solve_modes(beam, n_modes=22, n_segments=49).frequencies_hz

The command line is `verify --help`.
"""

TYPE_CHECKING = (
    False  # `typing` takes longer than all of this, and an interrupt while it is read finds nobody to answer
)
if TYPE_CHECKING:
    from typing import Any

    from verify import analytic_modes, fem_beam, segment_model, travelling_wave
    from verify.attached import PointMass, PointSpring
    from verify.beam import Beam, PointForce
    from verify.chain.bending import Bent, bend
    from verify.device import Device
    from verify.errors import InputError
    from verify.models.fields import HarmonicField
    from verify.models.modes import Modes
    from verify.models.sweeps import HarmonicSweep
    from verify.motion.free_vibration import FreeVibration, free_vibration
    from verify.motion.result import Motion
    from verify.motion.simulate import simulate
    from verify.motor.result import MotorRun
    from verify.motor.run import run_motor, run_motors
    from verify.run.runner import run_scene
    from verify.scenes.scene import load_scene
    from verify.section import Section
    from verify.slider import Contact, Foot, Slider
    from verify.waves.found import WaveMeasures

__all__ = [
    "Beam",
    "Bent",
    "Contact",
    "Device",
    "Foot",
    "FreeVibration",
    "HarmonicField",
    "HarmonicSweep",
    "InputError",
    "Modes",
    "Motion",
    "MotorRun",
    "PointForce",
    "PointMass",
    "PointSpring",
    "Section",
    "Slider",
    "WaveMeasures",
    "__version__",
    "analytic_modes",
    "bend",
    "fem_beam",
    "free_vibration",
    "load_scene",
    "run_motor",
    "run_motors",
    "run_scene",
    "segment_model",
    "simulate",
    "travelling_wave",
]
__version__ = "0.1.0"

_HOME = {
    "Beam": "verify.beam",
    "Bent": "verify.chain.bending",
    "Contact": "verify.slider",
    "Device": "verify.device",
    "Foot": "verify.slider",
    "FreeVibration": "verify.motion.free_vibration",
    "HarmonicField": "verify.models.fields",
    "HarmonicSweep": "verify.models.sweeps",
    "InputError": "verify.errors",
    "Modes": "verify.models.modes",
    "Motion": "verify.motion.result",
    "MotorRun": "verify.motor.result",
    "PointForce": "verify.beam",
    "PointMass": "verify.attached",
    "PointSpring": "verify.attached",
    "Section": "verify.section",
    "Slider": "verify.slider",
    "WaveMeasures": "verify.waves.found",
    "bend": "verify.chain.bending",
    "free_vibration": "verify.motion.free_vibration",
    "load_scene": "verify.scenes.scene",
    "run_motor": "verify.motor.run",
    "run_motors": "verify.motor.run",
    "run_scene": "verify.run.runner",
}
_FACES = {"analytic_modes", "fem_beam", "segment_model", "simulate", "travelling_wave"}
"""Modules below this one; `simulate` is also the verb, since it can be called."""


def __getattr__(name: str) -> "Any":
    """Import a public name from its home when it is first asked for, so that `import verify` costs nothing."""
    from importlib import import_module

    if name in _FACES:
        return import_module(f"verify.{name}")
    if name not in _HOME:
        raise AttributeError(f"module 'verify' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    """What there is, imported or not."""
    return sorted(__all__)
