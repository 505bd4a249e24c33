"""What a study is: a section of a scene, what it needs, what it will do, and how it is run."""

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeAlias, TypeVar

import msgspec

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.judge.workbench import Need, Workbench
    from verify.models.compiling import Call
    from verify.quantities.kind import Work
    from verify.scenes.scene import Scene
    from verify.studies.told import Found

Progress: TypeAlias = Callable[[str], None]
"""Told each step before it starts."""


Asked = TypeVar("Asked")
Out = TypeVar("Out", bound="Found")


class Study(Generic[Asked, Out]):
    """What a scene can ask for in a section of its own: a subclass with a name, that section's type, and `run`.

    One is registered by `STUDIES.register(Mine())` or as an entry point of the group `verify.studies`. What it
    imports at its top is paid for by every command that reads a scene.
    """

    name: ClassVar[str]
    """Of its section in a scene, of its key in JSON."""
    title: ClassVar[str] = ""
    """Above its part of the page; the name unless given."""
    section: ClassVar[type[msgspec.Struct] | None] = None
    """The type of its section; None where it stands on what a scene has anyway."""
    work: "ClassVar[Work]" = "closed form"
    devices: ClassVar[bool] = False
    """Whether it takes a drive with devices; one that does not is refused beside them."""
    slides: ClassVar[bool] = False
    """Whether it runs the scene's slider."""
    listed: ClassVar[bool] = True
    """Whether a plan lists it; not one whose figures a plan lists one by one."""
    of_source: ClassVar[bool] = False
    """Whether it holds what somebody published beside what is found: on the page that comes first."""
    nothing: ClassVar[Any] = None
    """In JSON where the scene does not ask for it."""

    def asked(self, scene: "Scene") -> Asked | None:
        """What the scene asks of it; None where nothing."""
        return getattr(scene, self.name, None)

    def skipped(self, scene: "Scene") -> str:
        """Why it is left out where the scene asks nothing of it."""
        return f"the scene has no [{self.name}]"

    def check_on(self, asked: Asked, scene: "Scene") -> None:
        """Raise InputError where the scene has not what it takes."""

    def check_run(self, asked: Asked, scene: "Scene") -> None:
        """Raise InputError, before anything is solved, for what `run` would refuse."""

    def needs(self, asked: Asked, scene: "Scene") -> "tuple[Need, ...]":
        """Solves that it will ask for."""
        return ()

    def models(self, asked: Asked, scene: "Scene") -> tuple[str, ...]:
        """Models that it uses beside its `needs`, by name."""
        return ()

    def takes(self, asked: Asked, scene: "Scene") -> tuple[str, ...]:
        """Studies before it whose findings it takes, by name."""
        return ()

    def choices(self, asked: Asked, scene: "Scene") -> tuple[tuple[str, str], ...]:
        """(which simpler model will do, why, with the size of what it neglects), for the plan."""
        return ()

    def works_on(self, asked: Asked, scene: "Scene") -> "tuple[Work, ...]":
        """What kinds of work it is on this scene."""
        return (self.work,)

    def told(self, asked: Asked, scene: "Scene") -> str:
        """What it will do, in a few words, for the plan."""
        return ""

    def n_steps(self, asked: Asked, scene: "Scene") -> int:
        """How often it reports progress."""
        return 1

    def n_motions(self, asked: Asked, scene: "Scene") -> int:
        """How many simulations in time it will do."""
        return 0

    def kernels(self, asked: Asked, scene: "Scene") -> "Iterable[Call]":
        """Compiled loops that it will run, called with values of the right kinds, in order of need."""
        return ()

    def run(self, asked: Asked, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress) -> Out:
        """Do it; `done` has what the studies before it found. Raises InputError."""
        raise NotImplementedError(f"the study {self.name} does not say how it is run")
