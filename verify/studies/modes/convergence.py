"""The error of a few modes over several sizes, and what each solve costs."""

from typing import TYPE_CHECKING, Annotated, TypeAlias

from msgspec import Meta

from verify.errors import InputError
from verify.judge.variants import Rules, Variant
from verify.models.catalogue import MODELS, discrete
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.beam import Beam
    from verify.judge.workbench import Need, Workbench
    from verify.scenes.scene import Scene
    from verify.studies.modes.convergence_figures import ConvergenceFound
    from verify.studies.told import Found

Counts: TypeAlias = Annotated[tuple[Annotated[int, Meta(ge=1)], ...], Meta(min_length=1)]


class Convergence(Rules, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the error of a few modes of the discrete models over several sizes, each rule of them side by side."""

    modes: Counts = (1, 5, 22)
    """Which modes, from 1."""
    counts: Counts = (10, 20, 49, 98)
    """Segments and elements."""


def _is_built(beam: "Beam", rule: Variant, count: int) -> bool:
    """Whether a rule that nobody asked for can be built of so many parts: joints may have no stiffness left."""
    try:
        MODELS.named(rule.model).check(beam, 1, count, **dict(rule.settings))
    except InputError:
        return False
    return True


class ConvergenceStudy(Study[Convergence, "ConvergenceFound"]):
    """Every model at every size, each solved and then timed."""

    name, section, work = "convergence", Convergence, "modes"
    title = "Convergence"
    nothing = ()

    def needs(self, asked: Convergence, scene: "Scene") -> "tuple[Need, ...]":
        """Each model at each size; for the last mode every rule of the chain that makes a difference there."""
        from verify.judge.workbench import Need

        def of(one: Variant, count: int) -> Need:
            return Need(one.model, count, max(asked.modes), one.settings)

        own = asked.variants(model.name for model in discrete("solve_modes", scene.beam))
        beside = [one for one in asked.every_rule(scene.beam) if one not in own]
        return tuple(
            of(one, count)
            for count in asked.counts
            for one in (*own, *(rule for rule in beside if _is_built(scene.beam, rule, count)))
        )

    def n_steps(self, asked: Convergence, scene: "Scene") -> int:
        """One for each size."""
        return len(asked.counts)

    def run(
        self, asked: Convergence, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "ConvergenceFound":
        """See `convergence_figures.convergence`."""
        from verify.studies.modes.convergence_figures import convergence

        return convergence(bench, asked, step)
