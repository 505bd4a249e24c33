"""Run time against error of every method that a scene gives something to do."""

from typing import TYPE_CHECKING

from verify.bench.request import Bench
from verify.bench.sets import SETS, settled
from verify.errors import InputError
from verify.models.catalogue import discrete
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.bench.found import BenchFound
    from verify.judge.workbench import Need, Workbench
    from verify.quantities.kind import Work
    from verify.scenes.scene import Scene
    from verify.studies.told import Found


class BenchStudy(Study[Bench, "BenchFound"]):
    """Every set in turn: its reference, first calls, then rounds in which its methods take turns."""

    name, section, work = "bench", Bench, "modes"
    title = "Run time against error"

    def check_on(self, asked: Bench, scene: "Scene") -> None:
        """Raise InputError for a place off the beam."""
        if asked.x is not None and asked.x >= scene.beam.length:
            raise InputError(f"bench.x = {asked.x!r} lies off the beam: give less than {scene.beam.length!r} m")

    def needs(self, asked: Bench, scene: "Scene") -> "tuple[Need, ...]":
        """Of modes, each model at each size, with every rule of the chain that makes a difference."""
        from verify.judge.variants import Variant, every_rule
        from verify.judge.workbench import Need

        its = settled(asked, scene)
        if "modes" not in its.sets:
            return ()
        every = (*(Variant(m.name) for m in discrete("solve_modes", scene.beam)), *every_rule(scene.beam))
        return tuple(Need(one.model, n, max(its.modes), one.settings) for n in its.counts for one in every)

    def models(self, asked: Bench, scene: "Scene") -> tuple[str, ...]:
        """All."""
        return tuple(model.name for model in discrete("solve_modes", scene.beam))

    def works_on(self, asked: Bench, scene: "Scene") -> "tuple[Work, ...]":
        """Of every set that is run."""
        return tuple(dict.fromkeys(work for name in settled(asked, scene).sets for work in SETS[name].works))

    def told(self, asked: Bench, scene: "Scene") -> str:
        """Which sets, at which sizes, for how long at most."""
        its = settled(asked, scene)
        sizes = ", ".join(str(n) for n in its.counts)
        return f"{', '.join(its.sets)} at N = {sizes}, about {asked.seconds:g} s of work at most"

    def n_steps(self, asked: Bench, scene: "Scene") -> int:
        """One for each set, for the processes of their own, and for pushing."""
        return len(settled(asked, scene).sets) + int(asked.imports) + int(asked.cold) + int(asked.push)

    def run(
        self, asked: Bench, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "BenchFound":
        """See `benched`."""
        from verify.bench.running import benched

        return benched(asked, scene, bench, step)
