"""What a study is: a section of a scene that runs itself and returns a `Result`."""

from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar, TypeAlias

import msgspec

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.registry import Registry
from verify.report.result import Result
from verify.scene.model import Scene as Scene  # noqa: PLC0414

if TYPE_CHECKING:
    from matplotlib.axes import Axes as Axes  # noqa: PLC0414
else:  # a stand-in for annotations: charts alone load matplotlib
    Axes = Any

Progress: TypeAlias = Callable[[str], None]  # called with the name of each step before it starts


class Study(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A section of a scene file. A subclass is the section's type: its fields are the options, `run` computes.

    Other packages add one by an entry point of the group `verify.studies`, or by `STUDIES.register(Mine)`.
    """

    name: ClassVar[str] = ""  # name of its section in a scene and of its key in JSON
    title: ClassVar[str] = ""  # heading on the page
    devices: ClassVar[bool] = False  # whether it accepts a drive with devices and shunts on the beam
    accepts: ClassVar[tuple[str, ...]] = ()  # those of the two that it accepts otherwise
    reads: ClassVar[tuple[str, ...] | None] = None  # tables of a scene besides the beam; None where it may read any
    files: ClassVar[tuple[str, ...]] = ()  # fields that are paths, relative to the folder of the scene file

    @property
    def steps(self) -> int:
        """Number of steps of a study that takes minutes, which `verify table` counts; 0 for the others."""
        return 0

    def check(self, scene: Scene) -> None:
        """Raise InputError where the scene lacks what the study needs, or has what it does not model."""

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Compute the study. Raises InputError."""
        raise NotImplementedError


OWN: tuple[str, ...] = ("spectrum", "convergence", "wave", "motion", "motor", "control", "identify")
OWN += ("large-motion", "claims", "sweep", "optimise", "sensitivity")
HOMES = {name: f"verify.studies.{name.replace('-', '_')}:{name.title().replace('-', '')}" for name in OWN}
STUDIES: Registry[type[Study]] = Registry("study", "verify.studies", homes=HOMES)
"""Study classes by the name of their section, in the order in which they run."""


def studies_of(scene: Scene) -> list[tuple[str, Study]]:
    """(name, study) of the scene's sections and of the implied ones, in the order of `STUDIES`.

    [[claim]] implies `claims`, [base] `large-motion`, a [drive] with two forces `wave` where it runs with its defaults.
    [motion] without a slider has settings for quantities in time and is no study.
    """
    studies: dict[str, Study] = dict(scene.studies)
    if scene.slider is None:
        studies.pop("motion", None)
    if scene.claim:
        studies.setdefault("claims", STUDIES["claims"]())
    if scene.base:
        studies.setdefault("large-motion", STUDIES["large-motion"]())
    if "wave" not in studies and len(scene.forces) == 2 and not scene.beside:
        wave = STUDIES["wave"]()
        with suppress(InputError):
            wave.check(scene)
            studies["wave"] = wave
    return [(name, studies[name]) for name in STUDIES if name in studies]


def result_of(name: str, scene: Scene, cache: SolutionCache, progress: Progress = lambda step: None) -> Result:
    """The result of a study of the scene, computed once for gates and report. Raises InputError without the study."""
    study = dict(studies_of(scene)).get(name)
    if study is None:
        raise InputError(f"study = {name!r} is not in the scene: add [{name}]")
    return cache.once(("study", name, id(scene)), lambda: (scene, study.run(scene, cache, progress)))[1]
