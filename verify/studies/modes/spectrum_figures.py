"""Errors of many modes at one size, and how they are told."""

from contextlib import suppress
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.exact.plate_strip import plate_error
from verify.judge.variants import Variant
from verify.judge.workbench import Workbench, comparable, has_bracket
from verify.options import THEORIES
from verify.studies.chart import Chart
from verify.studies.told import Found
from verify.words import percent, theory_name

if TYPE_CHECKING:
    from verify.studies.modes.spectrum import Spectrum


class SpectrumFound(Found, frozen=True, eq=False, kw_only=True):
    """Frequency and model-form errors over mode number at one size."""

    count: int
    modes: tuple[int, ...]
    errors: dict[str, tuple[float | None, ...]]
    """By the label of each variant; None for a mode that it does not have or that no mode of its looks like."""
    theories: dict[str, tuple[float, ...]]
    """Errors of other theories against Euler-Bernoulli, by name; without those that the beam has no figures for."""
    theory: str
    """Against which the errors are."""
    bracketed: bool
    """Whether the models bound the exact frequency from both sides."""
    variants: tuple[Variant, ...] = ()
    """Of the errors."""
    left_out: tuple[str, ...] = ()
    """Which models of other packages are not here, and why."""
    missing: dict[str, str] = msgspec.field(default_factory=dict)
    """By the label of each variant without the last mode: why."""
    bench: Workbench | None = None
    """Where the modes are, for their shapes."""

    def charts(self) -> tuple[Chart, ...]:
        """Signed errors, and their sizes beside the theories'."""
        from verify.studies.modes.charts import spectrum_charts

        return spectrum_charts(self)

    def in_short(self) -> str:
        """Errors of the last mode beside what the thickest theory says that this one leaves out."""
        pairs = [(one.title, self.errors[one.label][-1]) for one in self.variants]
        found = [f"{self.count} {title} are {percent(value)} off" for title, value in pairs if value is not None]
        none = [f"{title} have none" for title, value in pairs if value is None]
        if not found:
            return f"At mode {self.modes[-1]} and N = {self.count}, {' and '.join(none)}." if none else ""
        return f"At mode {self.modes[-1]}, against exact {self.theory}, {' and '.join(found + none)}{self._beyond()}."

    def _beyond(self) -> str:
        """What Euler-Bernoulli's theory leaves out of the last mode: through the thickness, and across the width."""
        if self.theory != theory_name(THEORIES[0]):
            return ""
        left = {name: f"{percent(values[-1])} ({theory_name(name)})" for name, values in self.theories.items()}
        across = left.pop(PLATE, None)
        told = [*list(left.values())[-1:], *([across] if across else ())]
        return f"; the theory itself leaves out {' and '.join(told)}" if told else ""

    def facts(self) -> tuple[str, ...]:
        """The last mode's errors, those of theories against Euler-Bernoulli."""
        found = [
            f"{one.title} {percent(value)}"
            for one in self.variants
            if (value := self.errors[one.label][-1]) is not None
        ]
        theories = [f"{theory_name(theory)} theory {percent(values[-1])}" for theory, values in self.theories.items()]
        euler = theory_name(THEORIES[0])
        if found and theories and self.theory != euler:
            theories[0] = f"and against {euler} {theories[0]}"
        where = f"mode {self.modes[-1]} at N = {self.count} against {self.theory if found else euler}"
        said = [*found, *theories]
        lacking = (f"{one.title}: {self.missing[one.label]}" for one in self.variants if one.label in self.missing)
        return (*((f"{where}: {', '.join(said)}",) if said else ()), *lacking, *self.left_out)

    def plain(self) -> object:
        """Errors by the variant's label."""
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
    variants = asked.variants(models)
    errors = {one.label: _errors(bench, one, asked) for one in variants}
    modes = tuple(range(1, asked.modes + 1))
    return SpectrumFound(
        count=asked.count,
        modes=modes,
        errors=errors,
        variants=variants,
        theory=" and ".join(theory_name(word) for word in dict.fromkeys(one.theory for one in variants)),
        theories=_theory_errors(bench, modes),
        bracketed=has_bracket(bench.beam) and len(variants) == len(models) and asked.combinations == ((),),
        left_out=tuple(left_out.values()),
        missing={one.label: _why(bench, one, asked, errors[one.label]) for one in variants if not _has(errors, one)},
        bench=bench,
    )


def _has(errors: dict[str, tuple[float | None, ...]], one: Variant) -> bool:
    """Whether a variant has the last mode."""
    return errors[one.label][-1] is not None


def _why(bench: Workbench, one: Variant, asked: "Spectrum", errors: tuple[float | None, ...]) -> str:
    """Why a variant has no figure of the last mode, and of how many it has one."""
    known = sum(error is not None for error in errors)
    why = bench.error_or_why(one.model, asked.count, asked.modes, one.settings)[1]
    return f"{why} ({known} of {asked.modes} modes have an error)"


def _errors(bench: Workbench, one: Variant, asked: "Spectrum") -> tuple[float | None, ...]:
    """Errors of modes 1..modes; the last first, so that one solve serves all."""
    modes = range(asked.modes, 0, -1)
    return tuple(bench.error_or_why(one.model, asked.count, n, one.settings)[0] for n in modes)[::-1]


PLATE = "plate"
"""Beside the beam theories: bending across the width, which none of them has."""
MOST_GENERAL = 200
"""Modes whose thick-beam frequencies are found one by one where they have no closed form."""


def _theory_errors(bench: Workbench, modes: tuple[int, ...]) -> dict[str, tuple[float, ...]]:
    """What each other theory changes, relative; none that the beam has not the figures or the patience for."""
    closed = bench.beam.supports == ("pinned", "pinned") and bench.beam.uniform
    if not closed and len(modes) > MOST_GENERAL:
        return {}
    found = {}
    for theory in THEORIES[1:]:
        with suppress(InputError):
            found[theory] = tuple(bench.exact_hz(n, theory) / bench.exact_hz(n) - 1.0 for n in modes)
    with suppress(InputError):
        found[PLATE] = tuple(plate_error(bench.beam, n) for n in modes)
    return found
