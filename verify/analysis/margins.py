"""Margins: the sizes of the effects that a result neglects, from beam, model, count, mode or drive, slider and runs.

Units, linearity, sag and slope under sliders, one-way coupling, lift-off, convergence, shear and rotary inertia,
bending across the width, discretisation and cut-off of the parts; `verdict` derives the level from them.
"""

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from math import inf, pi
from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.analysis.linearity import linearity_margins, sag_margins
from verify.analysis.plausibility import unit_margins
from verify.analysis.solution_cache import EULER, Settings, SolutionCache, theory_of
from verify.analysis.variants import Variant
from verify.analysis.verdict import FINE, LIMIT, MORE, Margin, per_cent, three_digits, void
from verify.errors import InputError
from verify.exact.closed_forms import theory_ratio, wavenumber_length
from verify.exact.error_laws import LAWS, error_at
from verify.exact.plate import FLATNESS, plate_error, stiffening
from verify.formatting import with_unit
from verify.linear.registry import MODELS, discrete

if TYPE_CHECKING:
    from verify.dynamics.result import Motion
    from verify.linear.field import HarmonicField
    from verify.problem.slider import Slider

SHEAR = "shear and rotary inertia"
MOST_PLATES = 60
"""Mode up to which the plate effect is that of the mode, about 0.1 s each, and beyond it of its wave."""
OFF = 0.05
"""Discretisation error from which a chart is marked."""


def result_margins(
    cache: SolutionCache,
    sizes: Sequence[tuple[str, int | None]] = (),
    *,
    mode: int | None = None,
    frequency_hz: float | None = None,
    settings: Settings = (),
    field: "HarmonicField | None" = None,
    slider: "Slider | None" = None,
    runs: "Sequence[tuple[str, Motion]]" = (),
    path: float = 0.0,
    amplitude: float | None = None,
    steady: bool = False,
) -> list[Margin]:
    """All margins of a result, whoever prints it.

    Those of the beam (see `beam_margins`) at `mode` or at the wave of `frequency_hz`, of the steady motion `field`
    under the drive, of the slider's sag along its way, and of the runs, each with the title of its model. The way is
    that of the runs, without any `path` from the start, m. `amplitude` is that of the wave under the slider, m;
    `steady` says whether the result has a choice of the beam theory.
    """
    found, beam = unit_margins(cache.beam), cache.beam
    if field is not None:
        found += linearity_margins("the drive", field, "drive it less")
    if slider is not None:
        start = slider.initial_position(beam)
        moved = [float(x) for _, run in runs for x in run.position.ravel()] or [start + path]
        found += sag_margins(cache, slider, amplitude, [start, *moved])
        found += [margin for title, run in runs for margin in run_margins(run, slider, title)]
    if mode or frequency_hz:
        found += beam_margins(cache, sizes, mode=mode, frequency_hz=frequency_hz, settings=settings, steady=steady)
    return found


def beam_margins(
    cache: SolutionCache,
    sizes: Sequence[tuple[str, int | None]],
    *,
    mode: int | None = None,
    frequency_hz: float | None = None,
    settings: Settings = (),
    steady: bool = False,
) -> list[Margin]:
    """Margins of a beam and its models (name, count) at a mode, or at the wave of a frequency, Hz; give one of the two.

    Discretisation at a mode is the solved error against the exact beam, at a wave the error of the dispersion at its
    wavenumber. `steady`: whether another theory may be chosen at a wave. Raises InputError for a mode that the exact
    beam does not have.
    """
    beam, where = cache.beam, f"at mode {mode}" if mode else f"at {frequency_hz:g} Hz"
    k = _wavenumber(cache, mode, frequency_hz)
    found = unit_margins(beam)
    found += [_discretisation(cache, model, n, mode, frequency_hz or 0.0, settings, where) for model, n in sizes if n]
    if k is None:
        return found
    theory = theory_of(settings)
    if theory != "timoshenko":  # Rayleigh's has the inertia, the smaller part
        if any(piece.shear_stiffness is None or piece.rotary_inertia is None for piece in beam.pieces):
            left_out = "shear, rotary inertia and bending across the width may be left out, unknown without a shape"
            unknown = Margin(name="beam theory", size=0.0, fine=-1.0, condition=left_out, where=where, is_error=False)
            return [*found, unknown]
        rigid = replace(beam.base_section, shear_stiffness=None)
        size = 1.0 - theory_ratio(beam.base_section, k) / (1.0 if theory == EULER else theory_ratio(rigid, k))
        if mode:
            with suppress(InputError):
                size = abs(cache.exact_hz(mode, "timoshenko") / cache.exact_hz(mode, theory) - 1.0)
        tune = "retune the drive by wave.best_frequency theory=timoshenko, or use a thinner beam"
        remedy = "use theory = 'timoshenko'" if mode or steady else tune
        found.append(Margin(name=SHEAR, size=size, where=where, remedy=remedy))
    width = max((one.width for one in (beam, *beam.section) if one.width), default=0.0)
    if width and beam.thickness and width >= FLATNESS * beam.thickness:  # a strip
        size, half = stiffening(0.5 * k * width, beam.poissons_ratio), pi / k
        if mode and mode <= MOST_PLATES:
            with suppress(InputError):
                size = abs(plate_error(beam, mode))
        short = f" (half a wave, {with_unit(half)}, is shorter than the width)" if half < width else ""
        found.append(
            Margin(
                name="bending across the width",
                size=size,
                where=where,
                condition=f"bending across the width may be left out{short}",
                remedy="no beam theory has it: use a plate, or a narrower strip",
            )
        )
    return found if mode else [_against_spacing(one, 2.0 * pi / (k * beam.length)) for one in found]


def _against_spacing(margin: Margin, spacing: float) -> Margin:
    """A frequency error at a driven wave, limited by half the relative spacing of the modes, 2 pi / (k L).

    It changes the reflection of a wave between two modes by k L/4 times itself, which is fine up to FINE.
    """
    limit, fine = min(margin.limit, 0.5 * spacing), min(margin.fine, 2.0 / pi * FINE * spacing)
    if not margin.is_error or margin.size <= limit:
        return replace(margin, limit=limit, fine=fine) if margin.is_error else margin
    failure = (
        f"{margin.name} change{'s' * (margin.name != SHEAR)} frequencies by {per_cent(margin.size)} {margin.where}, "
        f"where modes are {per_cent(spacing)} apart: the wave may be a standing one or travel the other way"
    )
    return replace(margin, limit=limit, fine=fine, failure=margin.failure or failure)


def _wavenumber(cache: SolutionCache, mode: int | None, frequency_hz: float | None) -> float | None:
    """Wavenumber of the mode, or of the drive in the beam's own section, 1/m; None where no wave travels."""
    from verify.linear.field import travelling_wavenumber

    if mode and cache.beam.uniform:
        return wavenumber_length(cache.beam.supports, mode) / cache.beam.length
    return travelling_wavenumber(cache.beam, cache.exact_hz(mode) if mode else frequency_hz or 0.0)


def _discretisation(
    cache: SolutionCache, model: str, count: int, mode: int | None, hertz: float, settings: Settings, where: str
) -> Margin:
    """Solved error at a mode; error of the dispersion at a driven wave, on beams without one that of the next mode."""
    beam, title = cache.beam, f"{count} {Variant(model, settings).title}"
    name, k = f"discretisation of {title}", None if mode else _wavenumber(cache, None, hertz)
    try:
        if mode is None:
            MODELS[model].build(beam, count).check_propagates(hertz)
        if k is not None and beam.uniform and model in LAWS and theory_of(settings) == EULER:
            error = error_at(model, beam, k * beam.length / count, count)
        else:
            error = cache.frequency_error(model, count, mode or _mode_above(cache, hertz), settings)
    except InputError as problem:
        return void(name, f"{title} have no answer {where} ({problem})")
    remedy, side = "", "low" if error < 0.0 else "high"
    if abs(error) > FINE and beam.uniform and not settings:  # by the error law, without a scan
        with suppress(InputError):
            enough = sufficient_count(cache, modes=mode or 0, frequency_hz=hertz, models=(model,))
            remedy = f"give more: {enough} are within {per_cent(FINE)}"
    return Margin(
        name=name,
        size=abs(error),
        where=where,
        condition=f"{title} may lie too {side}",
        failure=f"{title} are {per_cent(error)} too {side} {where}",
        remedy=remedy,
        harm="discretisation",
    )


def _mode_above(cache: SolutionCache, frequency_hz: float) -> int:
    """The first mode at or above a frequency."""
    top = 4
    while cache.exact_hz(top) < frequency_hz:
        top *= 2
    return bisect_left(range(1, top + 1), frequency_hz, key=cache.exact_hz) + 1


def sufficient_count(
    cache: SolutionCache, *, modes: int = 0, frequency_hz: float | None = None, models: Sequence[str] = ()
) -> int:
    """The number of parts from which on all models keep 1 % in frequency, at a mode or at a driven wave.

    Raises InputError where no practical number does.
    """
    from verify.analysis.sizing import LARGEST, sufficient_size

    names = models or [one.name for one in discrete() if one.name in MODELS.built_in]
    k = None if modes else _wavenumber(cache, None, frequency_hz)
    if modes or k is None or not cache.beam.uniform:
        mode = modes or _mode_above(cache, frequency_hz or 0.0)
        return max(sufficient_size(cache, name, mode, FINE).count for name in names)
    turns, last = k * cache.beam.length, 0
    count = first = max(int(turns / pi) + 1, 2)
    while count <= max(2 * last, first + 8):  # an error that changes sign is small by accident once
        if count > LARGEST:
            raise InputError(f"frequency_hz = {frequency_hz!r}: more than {LARGEST} parts are needed, lower it")
        if any(abs(error_at(name, cache.beam, turns / count, count)) > FINE for name in names if name in LAWS):
            last = count
        count += max(count // 500, 1)
    return max(last + 1, first)


def against_exact(
    what: str, model: str, value: float, exact: float, rounding: float = 0.0, finer: Mapping[str, float] | None = None
) -> Margin:
    """Difference from the exact beam, which answers up to 100 %: large near a resonance at a small frequency error.

    Values that differ by up to `rounding` are equal. `finer` has the values of larger sizes by title: where none is
    half as far off, more parts are no remedy.
    """
    size = 0.0 if abs(value - exact) <= rounding else abs(value / exact - 1.0) if exact else inf
    off, limit = f"{what} of {model} is off by {per_cent(size)}", inf if size <= 1.0 else 1.0
    return Margin(
        name=f"{what} of {model}",
        size=size,
        limit=limit,
        condition=f"the exact beam answers: {off}",
        failure=f"{off} of the exact beam's",
        remedy=_finer(model, size, exact, finer or {}),
        harm="discretisation",
    )


def _finer(model: str, size: float, exact: float, finer: Mapping[str, float]) -> str:
    """The size that helps, the first within 10 % or the best; a loss factor near a resonance, where none does."""
    off = {title: abs(value / exact - 1.0) if exact else inf for title, value in finer.items()}
    if not off:
        return f"give more than {model}"
    best = next((title for title, one in off.items() if one <= LIMIT), min(off, key=lambda title: off[title]))
    if off[best] < 0.5 * size:
        return f"give more: {best} are off by {per_cent(off[best])}"
    return f"more do not help ({best} are off by {per_cent(off[best])}): drive off the resonance, or give a loss_factor"


def marked(title: str, margins: Iterable[Margin]) -> str:
    """Title of a chart, marked where the discretisation error exceeds 5 %."""
    off = [one.failure for one in margins if one.name.startswith("discretisation") and one.size > OFF]
    return f"{title} ({', '.join(off)})" if off else title


def run_margins(run: "Motion", slider: "Slider", title: str) -> list[Margin]:
    """Coupling, lift-off, linearity and convergence of a slider's run on a model with this title."""
    from verify.dynamics.step_control import CONVERGED

    status, margins, coupling, found = run.statistics, run.margins, run.coupling, list[Margin]()
    if not status.finished:
        end = with_unit(run.end.time, "s")
        found.append(void("the run", f"the slider {status.stopped} on the {title} after {end}", "give a shorter time"))
    if slider.contact is None:
        falls = f"the slider lifts off: the surface falls away with {three_digits(margins.lift_off)} times the "
        falls += "acceleration that weight and preload give it"
        found.append(
            Margin(
                name="lift-off", size=margins.lift_off, fine=1.0, limit=1.0, failure=falls, is_error=False, remedy=MORE
            )
        )
    if coupling is not None and not (coupling.two_way and slider.normal == "bilateral"):
        size = max(coupling.normal_size, 0.0 if coupling.two_way else coupling.friction_size or 0.0)
        much = f"by {per_cent(size)}" if size < inf else "where the drive does not move it"
        remedy = "use slider.normal = 'bilateral'" if coupling.two_way else "use slider.coupling = 'two-way'"
        found.append(
            Margin(
                name="one-way coupling",
                size=size,
                condition="the contact need not act on the wave",
                failure=f"the contact changes the surface motion {much}",
                remedy=remedy,
            )
        )
    change, missed = status.step_change or 0.0, status.unconverged / max(status.steps, 1)
    failure = f"halving the time step changes the displacement by {per_cent(change)}"
    found += [
        Margin(name="axial inertia of the links", size=margins.nonlinearity, remedy="drive it less"),
        Margin(
            name="time step",
            harm="discretisation",
            size=change,
            fine=CONVERGED,
            limit=CONVERGED,
            failure=failure,
            remedy="give a shorter step, or a shorter time",
        ),
        Margin(
            name="contact forces that did not converge",
            size=missed,
            limit=FINE,
            remedy="raise steps_per_period",
            harm="discretisation",
        ),
        Margin(
            name="time steps in a period of the contact",
            harm="discretisation",
            size=margins.contact_step**2 / 24.0,
            remedy="raise steps_per_period",
        ),
    ]
    return [one for one in found if not one.size <= 0.0]
