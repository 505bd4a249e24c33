"""Errors of many modes at one size, and how they are told."""

from typing import TYPE_CHECKING, Any

from verify.exact.closed_forms import frequency_hz
from verify.judge.workbench import Workbench, comparable, is_bracketed
from verify.models.catalogue import MODELS
from verify.options import THEORIES
from verify.studies.told import Chart, Found
from verify.words import percent

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.studies.spectrum import Spectrum


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
    left_out: tuple[str, ...] = ()
    """Which models of other packages are not here, and why."""

    def charts(self) -> tuple[Chart, ...]:
        """Signed errors, and their sizes beside the theories'."""
        from verify.studies.mode_charts import spectrum_charts

        return spectrum_charts(self)

    def facts(self) -> tuple[str, ...]:
        """The last mode's errors."""
        found = [
            f"{MODELS[model].title} {percent(values[-1])}"
            for model, values in self.errors.items()
            if values[-1] is not None
        ]
        found += [f"{theory.capitalize()} theory {percent(values[-1])}" for theory, values in self.theories.items()]
        where = f"mode {self.modes[-1]} at N = {self.count} against Euler-Bernoulli"
        return (*((f"{where}: {', '.join(found)}",) if found else ()), *self.left_out)

    def plain(self) -> object:
        """Errors by the model's name."""
        return {"count": self.count, "modes": self.modes, **self.errors, "theories": self.theories}

    def records(self) -> list[dict[str, Any]]:
        """A row for each mode."""
        columns = self.errors | self.theories
        return [
            {"mode": mode, "count": self.count, **{f"{name}_error": values[i] for name, values in columns.items()}}
            for i, mode in enumerate(self.modes)
        ]


def spectrum(bench: Workbench, asked: "Spectrum") -> SpectrumFound:
    """Errors of modes 1..modes at one size. Raises InputError for a size that cannot be solved."""
    models, left_out = comparable(bench.beam, (asked.count,), asked.modes)
    modes = tuple(range(1, asked.modes + 1))
    return SpectrumFound(
        count=asked.count,
        modes=modes,
        errors={m: tuple(bench.error_or_why(m, asked.count, n)[0] for n in reversed(modes))[::-1] for m in models},
        theories=_theory_errors(bench.beam, modes),
        bracketed=is_bracketed(bench.beam),
        left_out=tuple(left_out.values()),
    )


def _theory_errors(beam: "Beam", modes: tuple[int, ...]) -> dict[str, tuple[float, ...]]:
    if beam.supports != ("pinned", "pinned") or not beam.uniform:
        return {}
    return {t: tuple(frequency_hz(beam, n, t) / frequency_hz(beam, n) - 1.0 for n in modes) for t in THEORIES[1:]}
