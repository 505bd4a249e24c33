"""Verification of finite-segment models of vibrating beams against finite elements and exact beam theory.

Public names (`help` of a name lists fields, shapes and units; everything is SI):

  Beam, Section, PointMass, PointSpring, Slider                the problem
  PointForce, PointMoment                                      harmonic loads
  Device                                                       impedance on a driven beam: absorber or actuator
  ExactModel, HermiteModel, SegmentModel                       models of a beam: modes, harmonic, imposed, ...
  Modes, HarmonicField                                         their results
  mode_errors, ModeErrors                                      errors of the modes of one model against another
  travelling_wave                                              the wave in a field: measure, WaveMeasures
  Stack, Bar33, Bar31, Langevin, EndMass, Patch                piezoelectric actuators; PiezoMaterial: their ceramic
  on_beam, Mounted, Load                                       actuators on a driven beam, with electrical loads
  simulate, Motion                                             a driven beam in time, with sliders or alone
  Excitation, PrescribedSlider, Step, Keep                     arguments of `simulate`
  Contact, Foot                                                unilateral contact of sliders, feet of several points
  free_vibration, FreeVibration                                a beam released from a shape, without forces
  bend, Bent                                                   a nonlinear chain under a large load at its tip
  load_scene, run_scene                                        a scene file, its gates and studies
  InputError                                                   invalid input, in one sentence

  beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
  SegmentModel(beam, n_segments=49).modes(22).frequencies_hz

The command line is `verify --help`.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from verify import travelling_wave
    from verify.actuators.materials import PiezoMaterial
    from verify.actuators.on_beam import Mounted, on_beam
    from verify.actuators.patch import Patch
    from verify.actuators.shunt import Load
    from verify.actuators.transducers import Bar31, Bar33, EndMass, Langevin, Stack
    from verify.analysis.comparison import ModeErrors, mode_errors
    from verify.analytic_modes import ExactModel
    from verify.chain.statics import Bent, bend
    from verify.dynamics.arguments import Excitation, Keep, PrescribedSlider, Step
    from verify.dynamics.free_vibration import FreeVibration, free_vibration
    from verify.dynamics.result import Motion
    from verify.dynamics.simulate import simulate
    from verify.errors import InputError
    from verify.fem_beam import HermiteModel
    from verify.linear.field import HarmonicField
    from verify.linear.modes import Modes
    from verify.problem.beam import Beam, PointForce, PointMoment
    from verify.problem.cross_section import Section
    from verify.problem.device import Device
    from verify.problem.point_attachments import PointMass, PointSpring
    from verify.problem.slider import Contact, Foot, Slider
    from verify.scene.load import load_scene
    from verify.scene.run import run_scene
    from verify.segment_model import SegmentModel
    from verify.travelling_wave import WaveMeasures

__all__ = [
    "Bar31", "Bar33", "Beam", "Bent", "Contact", "Device", "EndMass", "ExactModel", "Excitation", "Foot",
    "FreeVibration", "HarmonicField", "HermiteModel", "InputError", "Keep", "Langevin", "Load", "ModeErrors", "Modes",
    "Motion", "Mounted", "Patch", "PiezoMaterial", "PointForce", "PointMass", "PointMoment", "PointSpring",
    "PrescribedSlider", "Section", "SegmentModel", "Slider", "Stack", "Step", "WaveMeasures", "__version__", "bend",
    "free_vibration", "load_scene", "mode_errors", "on_beam", "run_scene", "simulate", "travelling_wave",
]  # fmt: skip
__version__ = "0.1.0"

_HOME = {
    "Beam": "problem.beam", "PointForce": "problem.beam", "PointMoment": "problem.beam", "Device": "problem.device",
    "Section": "problem.cross_section",
    "PointMass": "problem.point_attachments", "PointSpring": "problem.point_attachments", "Contact": "problem.slider",
    "Foot": "problem.slider", "Slider": "problem.slider", "ExactModel": "analytic_modes", "HermiteModel": "fem_beam",
    "SegmentModel": "segment_model", "HarmonicField": "linear.field", "Modes": "linear.modes",
    "ModeErrors": "analysis.comparison", "mode_errors": "analysis.comparison",
    "WaveMeasures": "travelling_wave", "simulate": "dynamics.simulate", "Motion": "dynamics.result",
    "Excitation": "dynamics.arguments", "PrescribedSlider": "dynamics.arguments", "Step": "dynamics.arguments",
    "Keep": "dynamics.arguments",
    "free_vibration": "dynamics.free_vibration", "FreeVibration": "dynamics.free_vibration",
    "bend": "chain.statics", "Bent": "chain.statics", "PiezoMaterial": "actuators.materials",
    "Stack": "actuators.transducers", "Bar33": "actuators.transducers", "Bar31": "actuators.transducers",
    "Langevin": "actuators.transducers", "EndMass": "actuators.transducers", "Patch": "actuators.patch",
    "Load": "actuators.shunt", "Mounted": "actuators.on_beam", "on_beam": "actuators.on_beam",
    "load_scene": "scene.load", "run_scene": "scene.run", "InputError": "errors",
}  # fmt: skip


def __getattr__(name: str) -> Any:
    """Import a public name at its first use."""
    if name == "travelling_wave":
        return import_module("verify.travelling_wave")
    if name not in _HOME:
        raise AttributeError(f"module 'verify' has no attribute {name!r}")
    return getattr(import_module(f"verify.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    """All public names, imported or not."""
    return sorted(__all__)
