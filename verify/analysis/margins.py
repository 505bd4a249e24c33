"""Margins: the sizes of what a result leaves out, from the beam, the model, its count, and the mode or drive.

Discretisation, shear and rotary inertia, bending across the width, cut-off of the parts, sag and slope under sliders,
one-way coupling, lift-off, convergence and linearity; `report.verdict` derives the verdict from them.
"""

from bisect import bisect_left
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from math import inf, pi
from typing import TYPE_CHECKING, Any

from verify.analysis.solution_cache import EULER, Settings, SolutionCache, theory_of
from verify.errors import InputError
from verify.exact.closed_forms import theory_ratio, wavenumber_length
from verify.exact.error_laws import LAWS, error_at
from verify.formatting import with_unit
from verify.linear.registry import EXACT, MODELS, discrete
from verify.report.verdict import FINE, Margin, per_cent, void

if TYPE_CHECKING:
    from verify.dynamics.result import Motion
    from verify.linear.field import HarmonicField
    from verify.problem.slider import Slider
    from verify.scene.model import Scene

Sizes = Sequence[tuple[str, int | None]]
"""(model, count) of the models that answer; None for the exact beam."""
MOST_PLATES = 60
"""Mode up to which the plate effect is that of the mode, about 0.1 s each, and beyond it of its wave."""
SLOPE = 0.1, 0.3
"""Slopes up to which linear theory is trusted, and trusted under a condition: their squares are relative lengths."""
POINTS = 401
OFF = 0.05
"""Discretisation error from which a chart is marked."""
STILL = 1e-4
"""Frequency of a static load over the first natural frequency: the dynamic part is its square."""


def beam_margins(
    cache: SolutionCache,
    sizes: Sizes,
    *,
    mode: int | None = None,
    frequency_hz: float | None = None,
    settings: Settings = (),
) -> list[Margin]:
    """Margins of a beam and its models at a mode, or at the wave of a frequency, Hz; give one of the two.

    Discretisation at a mode is the solved error against the exact beam, at a wave the error of the dispersion at its
    wavenumber. Raises InputError for a mode that the exact beam does not have.
    """
    beam, where = cache.beam, f"at mode {mode}" if mode else f"at {frequency_hz:g} Hz"
    k = _wavenumber(cache, mode, frequency_hz)
    found = [_discretisation(cache, one, mode, frequency_hz, settings, where) for one in sizes if one[1]]
    if k is None:
        return found
    if theory_of(settings) == EULER:
        if any(piece.shear_stiffness is None or piece.rotary_inertia is None for piece in beam.pieces):
            unknown = "shear, rotary inertia and bending across the width, unknown without a shape,"
            return [*found, Margin(name=unknown, size=0.0, where=where, is_error=False)]
        # waves in a section are as long as the fourth root of EI / rho A
        own = beam.own.mass_per_length / beam.own.bending_stiffness
        waves = [(p, k * (p.mass_per_length / p.bending_stiffness / own) ** 0.25) for p in beam.pieces]
        shear = max(1.0 - theory_ratio(piece, wavenumber) for piece, wavenumber in waves)
        if mode:
            with suppress(InputError):
                shear = abs(cache.exact_hz(mode, "timoshenko") / cache.exact_hz(mode) - 1.0)
        found.append(
            Margin(name="shear and rotary inertia", size=shear, where=where, remedy="use theory = 'timoshenko'")
        )
    return [*found, *_plate(cache, k, mode, where)]


def _wavenumber(cache: SolutionCache, mode: int | None, frequency_hz: float | None) -> float | None:
    """Of the mode, or of the wave in the beam's own section, 1/m; None where no wave travels."""
    from verify.linear.field import travelling_wavenumber

    if mode and cache.beam.uniform:
        return wavenumber_length(cache.beam.supports, mode) / cache.beam.length
    return travelling_wavenumber(cache.beam, cache.exact_hz(mode) if mode else frequency_hz or 0.0)


def _discretisation(
    cache: SolutionCache,
    size: tuple[str, int | None],
    mode: int | None,
    frequency_hz: float | None,
    settings: Settings,
    where: str,
) -> Margin:
    model, count = size
    assert count is not None
    name = f"discretisation of {count} {MODELS[model].title}"
    try:
        if mode is None:
            assert frequency_hz is not None
            MODELS[model].build(cache.beam, count).check_propagates(frequency_hz)
            error = _dispersion_error(cache, model, count, frequency_hz)
        else:
            error = cache.frequency_error(model, count, mode, settings)
    except InputError as problem:
        return void(name, f"{count} {MODELS[model].title} have no answer {where} ({problem})")
    remedy = ""
    if abs(error) > FINE:
        with suppress(InputError):
            enough = sufficient_count(cache, modes=mode or 0, frequency_hz=frequency_hz, models=(model,))
            remedy = f"give more: {enough} are within {per_cent(FINE)}"
    side = "low" if error < 0.0 else "high"
    return Margin(
        name=name,
        size=abs(error),
        where=where,
        condition=f"a frequency that is {per_cent(error)} {side} is good enough, of {count} {MODELS[model].title}",
        failure=f"{count} {MODELS[model].title} are {per_cent(error)} {side} {where}",
        remedy=remedy,
    )


def _dispersion_error(cache: SolutionCache, model: str, count: int, frequency_hz: float) -> float:
    """Relative frequency error of a model at a driven wave, signed. Raises InputError."""
    k, beam = _wavenumber(cache, None, frequency_hz), cache.beam
    if k is not None and beam.uniform and model in LAWS:
        mu = k * beam.length / count
        if mu >= pi:
            raise InputError(f"count = {count}: half a wave is shorter than a part")
        return error_at(model, beam, mu, count)
    return cache.frequency_error(model, count, _mode_above(cache, frequency_hz))


def _mode_above(cache: SolutionCache, frequency_hz: float) -> int:
    """The first mode at or above a frequency."""
    top = 4
    while cache.exact_hz(top) < frequency_hz:
        top *= 2
    return bisect_left(range(1, top + 1), frequency_hz, key=cache.exact_hz) + 1


def _plate(cache: SolutionCache, k: float, mode: int | None, where: str) -> list[Margin]:
    """Bending across the width of a strip; none of sections that are no strip."""
    from verify.exact.plate import FLATNESS, plate_error, stiffening

    beam = cache.beam
    width = max((one.width for one in (beam, *beam.section) if one.width), default=0.0)
    if not width or not beam.thickness or width < FLATNESS * beam.thickness:
        return []
    size = stiffening(0.5 * k * width, beam.poissons_ratio)
    if mode and mode <= MOST_PLATES:
        with suppress(InputError):
            size = abs(plate_error(beam, mode))
    half = pi / k
    short = f" (half a wave, {with_unit(half)}, is shorter than the width)" if half < width else ""
    condition = f"bending across the width may be left out{short}"
    return [Margin(name="bending across the width", size=size, where=where, condition=condition,
                   remedy="no beam theory has it: use a plate, or a narrower strip")]  # fmt: skip


def sufficient_count(
    cache: SolutionCache,
    *,
    modes: int = 0,
    frequency_hz: float | None = None,
    models: Sequence[str] = (),
    error: float = FINE,
) -> int:
    """The fewest parts with which all models keep an error in frequency, at a mode or at a driven wave.

    From this number on: larger ones keep it too. Raises InputError where no practical number does.
    """
    from verify.analysis.sizing import LARGEST, sufficient_size

    names = models or [one.name for one in discrete() if one.name in MODELS.built_in]
    k = None if modes else _wavenumber(cache, None, frequency_hz)
    if modes or k is None or not cache.beam.uniform:
        mode = modes or _mode_above(cache, frequency_hz or 0.0)
        return max(sufficient_size(cache, name, mode, error).count for name in names)
    turns, last = k * cache.beam.length, 0
    count = first = max(int(turns / pi) + 1, 2)
    while count <= max(2 * last, first + 8):  # an error that changes sign is small by accident once
        if count > LARGEST:
            raise InputError(f"frequency_hz = {frequency_hz!r}: more than {LARGEST} parts are needed, lower it")
        if any(abs(error_at(name, cache.beam, turns / count, count)) > error for name in names if name in LAWS):
            last = count
        count += max(count // 500, 1)
    return max(last + 1, first)


def default_count(scene: "Scene", cache: SolutionCache, count: int | None, modes: int = 0) -> int:
    """The count of a study: as given, or the fewest parts that keep 1 % at its last mode or its drive."""
    if count is not None:
        return count
    return sufficient_count(cache, modes=modes, frequency_hz=scene.drive.frequency_hz if scene.drive else None)


def marked(title: str, margins: Iterable[Margin]) -> str:
    """The title of a chart, with the discretisation that is more than 5 % off."""
    off = max((m for m in margins if m.name.startswith("discretisation") and m.size > OFF),
              key=lambda m: m.size, default=None)  # fmt: skip
    if off is None:
        return title
    what = off.name.removeprefix("discretisation of ")
    return f"{title} – {what} are {per_cent(off.size) if off.size < inf else 'beyond their range:'} off {off.where}"


# --- Drive and sliders -----------------------------------------------------------------------------------------------


def slope_margin(what: str, deflection: float, slope: float, length: float) -> Margin:
    """Linear theory under a deflection (m) with a largest slope (rad): the square of the slope is a relative length."""
    share = f"{with_unit(deflection)}, {per_cent(deflection / length)} of its length"
    return Margin(
        name=f"linear theory, {what} bends the beam by {share}:",
        size=slope**2,
        fine=SLOPE[0] ** 2,
        limit=SLOPE[1] ** 2,
        condition=f"a slope of {slope:.2g} is small ({what} bends the beam by {share})",
        failure=f"{what} bends the beam by {share}",
        remedy="press it less, or make the beam stiffer",
        is_error=False,
    )


def drive_margins(field: "HarmonicField") -> list[Margin]:
    """Linear theory under the steady motion of a drive."""
    import numpy as np

    x = np.linspace(0.0, field.beam.length, POINTS)
    one = slope_margin("the drive", abs(field.deflection(x)).max(), abs(field.slope(x)).max(), field.beam.length)
    return [Margin(**{name: getattr(one, name) for name in one.__struct_fields__} | {"remedy": "drive it less"})]


def sag_margins(cache: SolutionCache, slider: "Slider", amplitude: float | None = None) -> list[Margin]:
    """Static sag of the beam under a slider's weight and preload: its slope, and its curvature under the feet.

    The latter over the amplitude of the wave (m), where one-way coupling leaves it out. None of a beam whose rigid
    motions nothing prevents.
    """
    import numpy as np

    from verify.problem.beam import PointForce

    beam, start = cache.beam, slider.start_on(cache.beam)
    loads = [
        PointForce(position=min(max(start + foot.offset, 0.0), beam.length), amplitude=size)
        for foot in slider.feet
        if not foot.mirrored and (size := slider.pressing(foot) * (1.0 if foot.face == "lower" else -1.0))
    ]
    if beam.rigid_motions or not loads:
        return []
    try:
        still = MODELS[EXACT].build(beam).harmonic(loads, STILL * cache.exact_hz(1))
    except InputError:
        return []
    x = np.linspace(0.0, beam.length, POINTS)
    found = [slope_margin("the preload" if slider.preload else "the slider's weight", abs(still.deflection(x)).max(),
                          abs(still.slope(x)).max(), beam.length)]  # fmt: skip
    if amplitude and slider.coupling == "one-way":
        bent = max(abs(still.derivative(start + foot.offset, 2)[0]) * foot.length**2 / 8.0 for foot in slider.feet)
        found.append(
            Margin(
                name="sag under a foot, in wave amplitudes,",
                size=float(bent) / amplitude,
                condition=f"feet may lie on a surface that the preload bends by {bent / amplitude:.2g} wave amplitudes",
                failure=f"the preload bends the surface under a foot by {bent / amplitude:.2g} wave amplitudes, which "
                "one-way coupling leaves out",
                remedy="use coupling = 'two-way', or shorter feet",
                is_error=False,
            )
        )
    return found


def run_margins(run: "Motion", slider: "Slider", title: str) -> list[Margin]:
    """Coupling, lift-off, linearity and convergence of a slider's run on a model with this title."""
    from verify.dynamics.step_control import CONVERGED

    status, margins, coupling, found = run.statistics, run.margins, run.coupling, list[Margin]()
    if not status.finished:
        end = with_unit(run.end.time, "s")
        found.append(void("the run", f"the slider {status.stopped} on the {title} after {end}", "give a shorter time"))
    if slider.contact is None:
        falls = f"the surface falls away with {margins.lift_off:.3g} times the acceleration of weight and preload"
        found.append(Margin(name="lift-off", size=margins.lift_off, fine=1.0, limit=1.0, is_error=False,
                            failure=f"the slider lifts off: {falls}",
                            remedy="press it more, or model its contact by [slider.contact]"))  # fmt: skip
    if coupling is not None and not (coupling.two_way and slider.normal == "held"):
        friction = 0.0 if coupling.two_way else coupling.friction_size or 0.0
        size = max(coupling.normal_size, friction)
        two_way = "slider.normal = 'held'" if coupling.two_way else "slider.coupling = 'two-way'"
        much = f"by {per_cent(size)}" if size < inf else "where the drive does not move it"
        found.append(Margin(name="one-way coupling", size=size, remedy=f"use {two_way}",
                            condition="the contact need not act on the wave",
                            failure=f"the contact changes the surface motion {much}"))  # fmt: skip
    found.append(Margin(name="axial inertia of the links, (kL)² ⟨θ²⟩,", size=margins.nonlinearity,
                        condition="the axial inertia of the links may be left out",
                        failure=f"linear theory leaves out axial inertia of {per_cent(margins.nonlinearity)}",
                        remedy="drive it less"))  # fmt: skip
    change = status.step_change
    found.append(Margin(name="time step", size=change or 0.0, fine=CONVERGED, limit=CONVERGED,
                        failure=f"halving the time step changes the displacement by {per_cent(change or 0.0)}",
                        remedy="give a shorter step, or a shorter time"))  # fmt: skip
    missed = status.unconverged / max(status.steps, 1)
    found.append(Margin(name="steps without converged contact forces", size=missed, fine=1e-3, limit=0.01,
                        is_error=False, remedy="raise steps_per_period"))  # fmt: skip
    found.append(Margin(name="period of the contact in these steps", size=margins.contact_step**2 / 24.0,
                        remedy="raise steps_per_period"))  # fmt: skip
    return [one for one in found if one.size > 0.0]


def quantity_margins(name: str, arguments: Mapping[str, Any], scene: "Scene", cache: SolutionCache) -> list[Margin]:
    """Margins of a quantity that the cache has evaluated: of its model at its mode or drive, and of its runs."""
    import msgspec

    from verify.analysis.variants import DEFAULTS
    from verify.quantities.base import QUANTITIES

    quantity = QUANTITIES.named(name)
    known = {f.name: f.default for f in msgspec.structs.fields(quantity.schema) if not f.required} | dict(arguments)
    mode, hertz = known.get("mode"), known.get("frequency_hz")
    if hertz is None and "drive" in quantity.reads and scene.drive is not None:
        hertz = scene.drive.frequency_hz
    found = list[Margin]()
    if "beam" in quantity.reads and (isinstance(mode, int) or hertz is not None):
        settings = tuple((key, known[key]) for key in DEFAULTS if known.get(key) not in (None, DEFAULTS[key]))
        size = (known["model"], known.get("count")) if known.get("model") in MODELS else (EXACT, None)
        at = {"mode": mode} if isinstance(mode, int) else {"frequency_hz": hertz}
        with suppress(InputError):
            found += beam_margins(cache, [size], **at, settings=settings)
    if scene.slider is not None:
        runs = [*cache.motions.values(), *(one.run for one in cache.motors.values() if hasattr(one, "run"))]
        sliding = [run for run in runs if run.coupling is not None]
        found += [one for run in sliding for one in run_margins(run, scene.slider, MODELS[run.model].title)]
        found += sag_margins(cache, scene.slider) if sliding else []
    return found
