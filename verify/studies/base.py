"""What a study is: a section of a scene that runs itself and returns a `Result`."""

from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING, ClassVar, TypeAlias

import msgspec

from verify.errors import InputError, near_name

if TYPE_CHECKING:
    from verify.judge.cache import SolutionCache
    from verify.judge.variants import Variant
    from verify.report.result import Result
    from verify.scene.model import Scene

Progress: TypeAlias = Callable[[str], None]
"""Called with the name of each step before it starts."""


class Study(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A section of a scene file. A subclass is the section's type: its fields are the options, `run` computes.

    Other packages add one by an entry point of the group `verify.studies`, or by `STUDIES.register(name, Mine)`.
    """

    title: ClassVar[str] = ""
    """Heading on the page."""
    devices: ClassVar[bool] = False
    """Whether it accepts a drive with devices on the beam."""

    def check(self, scene: "Scene") -> None:
        """Raise InputError where the scene lacks what the study needs, or has what it does not model."""

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Compute the study. Raises InputError."""
        raise NotImplementedError


class Studies(Mapping[str, type[Study]]):
    """Study classes by the name of their section, in the order in which they run; imported on first use."""

    def __init__(self, homes: Mapping[str, str]) -> None:
        """`homes`: 'module:class' by name."""
        self._homes = dict(homes)
        self._classes: dict[str, type[Study]] = {}
        self._entry_points_read = False
        self.built_in = tuple(homes)

    def named(self, name: str) -> type[Study]:
        """The class of that name. Raises InputError with the nearest name."""
        if name not in self:
            raise InputError(f"study = {name!r} is not known: {near_name(name, tuple(self))}")
        return self[name]

    def register(self, name: str, study: type[Study]) -> None:
        """Add a study for this process."""
        self._classes[name] = study
        self._homes.setdefault(name, f"{study.__module__}:{study.__qualname__}")

    def __getitem__(self, name: str) -> type[Study]:
        if name not in self._homes:
            self._read_entry_points()
        if name not in self._classes:
            module, _, attribute = self._homes[name].partition(":")
            try:
                self._classes[name] = getattr(import_module(module), attribute)
            except (ImportError, AttributeError) as error:
                raise InputError(f"study = {name!r} cannot be imported ({error}): repair its package") from error
        return self._classes[name]

    def __contains__(self, name: object) -> bool:
        if name not in self._homes:
            self._read_entry_points()
        return name in self._homes

    def __iter__(self) -> Iterator[str]:
        self._read_entry_points()
        return iter(tuple(self._homes))

    def __len__(self) -> int:
        return len(tuple(iter(self)))

    def _read_entry_points(self) -> None:
        if not self._entry_points_read:
            from importlib.metadata import entry_points

            self._entry_points_read = True
            for point in entry_points(group="verify.studies"):
                self._homes.setdefault(point.name, point.value)


STUDIES = Studies(
    {
        "spectrum": "verify.studies.spectrum:Spectrum",
        "convergence": "verify.studies.convergence:Convergence",
        "wave": "verify.studies.wave:Wave",
        "motion": "verify.studies.motion:Motion",
        "motor": "verify.studies.motor:Motor",
        "axial_inertia": "verify.studies.axial_inertia:AxialInertia",
        "claims": "verify.studies.claims:Claims",
        "sweep": "verify.studies.sweep:Sweep",
    }
)


def studies_of(scene: "Scene") -> list[tuple[str, Study]]:
    """(name, study) of the scene's sections and of the implied ones, in the order of `STUDIES`.

    `claims` is implied by [[claim]], `wave` by a [drive] with two forces on a beam where it runs with its defaults.
    """
    found = dict(scene.studies)
    if scene.claim:
        found.setdefault("claims", STUDIES["claims"]())
    if len(scene.forces) == 2 and "wave" not in found:
        wave = STUDIES["wave"]()
        try:
            wave.check(scene)
            found["wave"] = wave
        except InputError:
            pass
    order = [name for name in STUDIES if name in found]
    return [(name, found[name]) for name in order]


def variant_colors(variants: "tuple[Variant, ...]") -> "dict[Variant, str]":
    """The colour of a model for its first variant, others from the colour cycle."""
    from verify.models.catalogue import MODELS
    from verify.report.plotting import CYCLE, MODEL_COLORS

    colors: dict[Variant, str] = {}
    seen: set[str] = set()
    for one in variants:
        own = MODEL_COLORS.get(one.model, MODELS[one.model].colour)
        colors[one] = CYCLE[len(colors) % len(CYCLE)] if one.model in seen else own
        seen.add(one.model)
    return colors
