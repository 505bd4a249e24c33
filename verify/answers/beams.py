"""A beam in the forms in which a question names one."""

from pathlib import Path
from typing import TypeAlias

from verify.problem.beam import Beam
from verify.scene.file import NamedBeam, load_beam
from verify.validation import check_type

AnyBeam: TypeAlias = Beam | NamedBeam | str | Path
"""A beam, the name of a packaged scene, the path of one, or a phrase 'beam: 1 m x 40 x 8 mm steel'."""


def named(beam: Beam | NamedBeam | str | Path) -> NamedBeam:
    """A beam with a name. Raises InputError."""
    if isinstance(beam, str | Path):
        return load_beam(beam)
    check_type("beam", beam, Beam, NamedBeam)
    return NamedBeam(name="beam", beam=beam) if isinstance(beam, Beam) else beam
