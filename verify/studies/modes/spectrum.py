"""The error of many modes at one size, beside what other beam theories would change."""

from typing import TYPE_CHECKING, Annotated

from msgspec import Meta

from verify.judge.variants import Rules
from verify.models.catalogue import discrete
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.judge.workbench import Need, Workbench
    from verify.scenes.scene import Scene
    from verify.studies.modes.spectrum_figures import SpectrumFound
    from verify.studies.told import Found


class Spectrum(Rules, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the error of modes 1..modes of the discrete models at one size, each rule of them side by side."""

    modes: Annotated[int, Meta(ge=1, le=10_000)] = 22
    """How many modes, from the first."""
    count: Annotated[int, Meta(ge=1)] = 49
    """Segments and elements."""


class SpectrumStudy(Study[Spectrum, "SpectrumFound"]):
    """One solve for each model."""

    name, section, work = "spectrum", Spectrum, "modes"
    title = "Error spectrum"

    def needs(self, asked: Spectrum, scene: "Scene") -> "tuple[Need, ...]":
        """Each variant once."""
        from verify.judge.workbench import Need

        variants = asked.variants(model.name for model in discrete("solve_modes", scene.beam))
        return tuple(Need(one.model, asked.count, asked.modes, one.settings) for one in variants)

    def run(
        self, asked: Spectrum, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "SpectrumFound":
        """See `spectrum_figures.spectrum`."""
        from verify.studies.modes.spectrum_figures import spectrum

        step("error spectrum")
        return spectrum(bench, asked)
