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
  bend_in_space, BentInSpace                                   the same in space, of rods curved at rest
  choose, engine_chain, curve_chain                            enough segments and elements; joints in N m/rad, files
  compare_frequencies, judge_file                              a list of another program; a file of rigid bodies
  judge_case                                                   the record of a run of a case in any engine
  verdict                                                      how far a model can be trusted at a mode or a drive
  NonlinearHermite, BentElements, large_motion, NonlinearMotion    nonlinear elements: statics, rotation, time
  Base, polynomial, tabulated, Forces                          their prescribed base and loads
  load_scene, run_scene                                        a scene file, its gates and studies
  InputError                                                   invalid input, in one sentence

  beam = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
  SegmentModel(beam, n_segments=49).modes(22).frequencies_hz

The command line is `verify --help`.
"""

import ast
from functools import cache
from importlib import import_module
from pathlib import Path

__version__ = "0.1.0"


@cache
def _homes() -> dict[str, str]:
    """Module of every public name: the stub beside this file, which type checkers read, imports them all."""
    stub = ast.parse(Path(__file__).with_suffix(".pyi").read_text("utf-8"))
    imports = [node for node in stub.body if isinstance(node, ast.ImportFrom)]
    return {alias.name: str(node.module) for node in imports for alias in node.names}


def __getattr__(name: str) -> object:
    """Import a public name at its first use."""
    if name == "__all__":
        return __dir__()
    if name.startswith("_") or name not in _homes():
        raise AttributeError(f"module 'verify' has no attribute {name!r}")
    home = _homes()[name]
    return import_module(f"verify.{name}") if home == "verify" else getattr(import_module(home), name)


def __dir__() -> list[str]:
    """All public names, imported or not."""
    return sorted([*_homes(), "__version__"])
