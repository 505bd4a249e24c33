"""How far a chain of rigid links departs from the linear one through its axial inertia, over the force."""

from typing import TYPE_CHECKING

from verify.models.catalogue import discrete
from verify.studies.axial_inertia.request import BESIDE, STEPPED, AxialInertia, n_stepped, steps_of
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.scenes.scene import Scene
    from verify.studies.axial_inertia.figures import AxialFound
    from verify.studies.told import Found


class AxialInertiaStudy(Study[AxialInertia, "AxialFound"]):
    """Three nonlinear chains under every force, and all models beside one another at one of them."""

    name, section, work = "axial_inertia", AxialInertia, "in time"
    title = "How linear the chain of rigid links is"

    def check_on(self, asked: AxialInertia, scene: "Scene") -> None:
        """Raise InputError unless the beam is a chain with a tip that slides, undamped and driven by forces."""
        asked.check_on(scene.beam, scene.drive)

    def models(self, asked: AxialInertia, scene: "Scene") -> tuple[str, ...]:
        """All that can."""
        return tuple(model.name for model in discrete("time_basis"))

    def choices(self, asked: AxialInertia, scene: "Scene") -> tuple[tuple[str, str], ...]:
        """Up to which force the linear chain will do: linear or nonlinear is decided by its axial inertia."""
        from verify.studies.axial_inertia.figures import linear_up_to

        return linear_up_to(asked, scene)

    def told(self, asked: AxialInertia, scene: "Scene") -> str:
        """What is run, and how long."""
        forces = ", ".join(f"{force:g}" for force in asked.forces)
        steps, stepped = steps_of(asked, scene), n_stepped(asked)
        return (
            f"rigid, massless along x and stretching links at {forces} N, all models at {asked.shown:g} N: "
            f"{self.n_motions(asked, scene)} motions of N = {asked.count}, {stepped} of them in about {steps:.2g} "
            "steps each"
        )

    def n_steps(self, asked: AxialInertia, scene: "Scene") -> int:
        """A step for each force, and the models side by side."""
        return len(asked.forces) + 1

    def n_motions(self, asked: AxialInertia, scene: "Scene") -> int:
        """Stepped and closed form alike."""
        return STEPPED * len(asked.forces) + BESIDE

    def kernels(self, asked: AxialInertia, scene: "Scene") -> "Iterable[Call]":
        """Rigid links and those that stretch."""
        from verify.chain import warm

        yield from warm.rigid()
        yield from warm.stretching()

    def run(
        self, asked: AxialInertia, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "AxialFound":
        """See `axial_study`."""
        from verify.studies.axial_inertia.figures import axial_study

        return axial_study(scene, asked, step)
