"""The error of many modes at one size, beside what other beam theories would change."""

from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from verify.models.catalogue import discrete
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.judge.workbench import Need, Workbench
    from verify.scenes.scene import Scene
    from verify.studies.spectrum_figures import SpectrumFound
    from verify.studies.told import Found


class Spectrum(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the error of modes 1..modes of the discrete models at one size."""

    modes: Annotated[int, Meta(ge=1, le=10_000)] = 22
    """How many modes, from the first."""
    count: Annotated[int, Meta(ge=1)] = 49
    """Segments and elements."""


class SpectrumStudy(Study[Spectrum, "SpectrumFound"]):
    """One solve for each model."""

    name, section, work = "spectrum", Spectrum, "modes"
    title = "Error spectrum"

    def needs(self, asked: Spectrum, scene: "Scene") -> "tuple[Need, ...]":
        """Each model once."""
        from verify.judge.workbench import Need

        return tuple(Need(model.name, asked.count, asked.modes) for model in discrete("solve_modes", scene.beam))

    def run(
        self, asked: Spectrum, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "SpectrumFound":
        """See `spectrum_figures.spectrum`."""
        from verify.studies.spectrum_figures import spectrum

        step("error spectrum")
        return spectrum(bench, asked)
