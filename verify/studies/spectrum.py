"""The error of many modes at one size, beside what other beam theories would change."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from verify.exact.closed_forms import THEORIES, frequency_hz
from verify.models.catalogue import discrete
from verify.studies.kind import Chart, Found, Progress, Study
from verify.words import percent

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.judge.workbench import Need, Workbench
    from verify.scenes.scene import Scene


class Spectrum(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the error of modes 1..modes of the discrete models at one size."""

    modes: Annotated[int, Meta(ge=1, le=10_000)] = 22
    count: Annotated[int, Meta(ge=1)] = 49


class SpectrumFound(Found, frozen=True, eq=False, kw_only=True):
    """Frequency and model-form errors over mode number at one size."""

    count: int
    modes: tuple[int, ...]
    errors: dict[str, tuple[float | None, ...]]
    """By model; None for a mode that it does not have or that no mode of its looks like."""
    theories: dict[str, tuple[float, ...]]
    """Errors of other beam theories against Euler-Bernoulli; empty where they have no closed form."""
    bracketed: bool
    """Whether the models bound the exact frequency from both sides."""

    def charts(self) -> tuple[Chart, ...]:
        """Signed errors, and their sizes beside the theories'."""
        from verify.studies.mode_charts import spectrum_charts

        return spectrum_charts(self)

    def facts(self) -> tuple[str, ...]:
        """The last mode's errors."""
        from verify.models.catalogue import MODELS

        found = [
            f"{MODELS[model].title} {percent(values[-1])}"
            for model, values in self.errors.items()
            if values[-1] is not None
        ]
        found += [f"{theory.capitalize()} theory {percent(values[-1])}" for theory, values in self.theories.items()]
        where = f"mode {self.modes[-1]} at N = {self.count} against Euler-Bernoulli"
        return (f"{where}: {', '.join(found)}",) if found else ()

    def plain(self) -> object:
        """Errors by the model's name."""
        return {"count": self.count, "modes": self.modes, **self.errors, "theories": self.theories}


class SpectrumStudy(Study[Spectrum, SpectrumFound]):
    """One solve for each model."""

    name, section, work = "spectrum", Spectrum, "modes"
    title = "Error spectrum"

    def needs(self, asked: Spectrum, scene: "Scene") -> "tuple[Need, ...]":
        """Each model once."""
        from verify.judge.workbench import Need

        return tuple(Need(model.name, asked.count, asked.modes) for model in discrete())

    def run(
        self, asked: Spectrum, scene: "Scene", bench: "Workbench", done: Mapping[str, Found], step: Progress
    ) -> SpectrumFound:
        """Errors of modes 1..modes at one size. Raises InputError for a size that cannot be solved."""
        from verify.judge.workbench import check_size, is_bracketed

        step("error spectrum")
        models = [model.name for model in discrete()]
        for model in models:
            check_size(bench.beam, model, asked.count, asked.modes)
        modes = tuple(range(1, asked.modes + 1))
        return SpectrumFound(
            count=asked.count,
            modes=modes,
            errors={m: tuple(bench.error_or_why(m, asked.count, n)[0] for n in reversed(modes))[::-1] for m in models},
            theories=_theory_errors(bench.beam, modes),
            bracketed=is_bracketed(bench.beam),
        )


def _theory_errors(beam: "Beam", modes: tuple[int, ...]) -> dict[str, tuple[float, ...]]:
    if beam.supports != ("pinned", "pinned") or beam.stepped:
        return {}
    return {t: tuple(frequency_hz(beam, n, t) / frequency_hz(beam, n) - 1.0 for n in modes) for t in THEORIES[1:]}
