"""Charts of modes: errors over mode number and size, the bracket, run time, material."""

from itertools import groupby, pairwise
from math import log, pi
from typing import TYPE_CHECKING, Any

from msgspec.structs import replace

from verify.exact.error_laws import MEAN_LIMIT
from verify.judge.compare import EIGENVALUE_FLOOR
from verify.judge.variants import DEFAULTS, Variant
from verify.judge.workbench import for_model
from verify.models.catalogue import MODELS, bounding
from verify.options import THEORIES
from verify.studies.chart import Axis, Bars, Chart, Line
from verify.studies.charting import (
    DASHES,
    GREY,
    MEAN_COLOUR,
    PLATE,
    RAYLEIGH,
    SHADES,
    SYMBOLS,
    TIMOSHENKO,
    key,
    line,
    model_line,
    other_line,
    percent,
    plain_line,
    sizes_axis,
    unbroken,
)
from verify.words import theory_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.studies.chart import Dash
    from verify.studies.modes.convergence_figures import ConvergenceFound, Row
    from verify.studies.modes.sensitivity_figures import SensitivityFound
    from verify.studies.modes.spectrum_figures import SpectrumFound

GUIDES: "dict[int, Dash]" = {2: "dashdot", 4: "solid", 6: "dot"}
"""Of a slope, by its order."""
CANCELLED = 6
"""Order of the mean of segments and elements of order 4, whose leading errors are of one size and two signs."""
_THEORIES = {"rayleigh": RAYLEIGH, "timoshenko": TIMOSHENKO, "plate": PLATE}


def spectrum_charts(study: "SpectrumFound") -> tuple[Chart, ...]:
    """Signed errors, their sizes beside the theories', what the last mode's is made of, shapes."""
    from verify.studies.modes.shape_charts import shapes_chart

    shapes = shapes_chart(study.bench, study.variants, study.count, study.modes[-1]) if study.bench else ()
    charts = (_signed_errors(study), _model_form(study), _split(study), *shapes)
    return tuple(one for one in charts if not one.empty)


def convergence_charts(found: "ConvergenceFound") -> tuple[Chart, ...]:
    """Errors over sizes, the rules of the chain, the bracket, run time against error."""
    charts = (_convergence(found), _rules(found), _bracket(found), _work(found))
    return tuple(one for one in charts if not one.empty)


def _variant_line(
    found: "ConvergenceFound | SpectrumFound",
    label: str,
    x: "Sequence[float]",
    y: "Sequence[float | None]",
    **style: Any,
) -> Line:
    """The line of a variant: its model's where it is the first of it, else one of its own."""
    first = {variant.model: variant for variant in reversed(found.variants)}
    others = [variant.label for variant in found.variants if variant != first[variant.model]]
    one = next(variant for variant in found.variants if variant.label == label)
    if label not in others:
        return model_line(one.model, x, y, name=one.title, **style)
    return other_line(others.index(label), one.title, x, y, **style)


def _rules(found: "ConvergenceFound") -> Chart:
    """One line for each rule of the chain, the default in the model's colour."""
    lines = []
    for i, one in enumerate(found.rules):
        y = percent(one.errors, size=True)
        plain = not one.variant.settings
        lines.append(
            model_line(one.variant.model, one.counts, y) if plain else other_line(i, one.variant.title, one.counts, y)
        )
    mode = found.rules[0].mode if found.rules else 0
    return Chart(
        id="rules",
        title=f"Every rule of the chain on this beam, mode {mode}",
        caption=f"{_turned(found)} side by side.{_DIP if _turns(found) else ''}",
        x=sizes_axis("number of segments N", (n for one in found.rules for n in one.counts)),
        y=Axis("size of the frequency error, %", log=True),
        lines=tuple(lines),
    )


def _turned(found: "ConvergenceFound") -> str:
    """In which settings the rules differ: 'Walls and joints'."""
    words = ("walls", "joints", "gradings", "theories", "attachments")
    known = dict(zip(DEFAULTS, words, strict=True))
    given = [dict(one.variant.settings) for one in found.rules]
    turned = [word for name, word in known.items() if len({one.get(name) for one in given}) > 1]
    return " and ".join(filter(None, (", ".join(turned[:-1]), *turned[-1:]))).capitalize()


_DIP = " A dip is where an error changes its sign, not where a rule is better."


def _turns(found: "ConvergenceFound") -> bool:
    """Whether the error of any rule has another sign at one size than at the one before."""
    known = [[e for e in one.errors if e] for one in found.rules]
    return any(a * b < 0.0 for errors in known for a, b in pairwise(errors))


def _signed_errors(study: "SpectrumFound") -> Chart:
    below = " Rigid links with rotary inertia lie below, Hermite elements above." if study.bracketed else ""
    return Chart(
        id="mode-errors",
        title=f"Frequency error over mode number, N = {study.count}",
        caption=f"Signed, against exact {study.theory}.{below}",
        x=Axis("mode number"),
        y=Axis("frequency error, %"),
        lines=tuple(_variant_line(study, label, study.modes, percent(v)) for label, v in study.errors.items()),
    )


def _model_form(study: "SpectrumFound") -> Chart:
    errors = study.errors if study.theories else {}  # without a theory beside them they say nothing new
    lines = [_variant_line(study, label, study.modes, percent(v, size=True)) for label, v in errors.items()]
    for theory, values in study.theories.items():
        sizes = percent(values, size=True)
        lines.append(line(theory_name(theory), _THEORIES[theory], study.modes, sizes, dash="dash"))
    plain = study.theory == theory_name(THEORIES[0])
    across = "; and bending across the width (Plate)" if "plate" in study.theories else ""
    moral = " A mesh finer than that answers a question nobody asked." if plain else ""
    return Chart(
        id="model-form",
        title=f"Discretisation beside model form, N = {study.count}",
        caption="Solid: what dividing the beam costs. Dashed: what Euler-Bernoulli theory leaves out, rotary inertia "
        f"(Rayleigh) and shear as well (Timoshenko){across}." + moral,
        x=Axis("mode number"),
        y=Axis("size of the frequency error, %", log=True),
        lines=tuple(lines),
    )


def _split(study: "SpectrumFound") -> Chart:
    """Of the last mode's frequency: division, theory, rounding, each by itself."""
    found = [(one, study.errors[one.label][-1]) for one in study.variants]
    parts = [(f"division, {one.title}", abs(e), MODELS[one.model].colour) for one, e in found if e]
    parts += [(f"theory, {theory_name(t)}", abs(v[-1]), _THEORIES[t]) for t, v in study.theories.items() if v[-1]]
    parts.append(("rounding, at most", EIGENVALUE_FLOOR, GREY))
    theory = "Theory: what Euler-Bernoulli's leaves out. " if study.theories else ""
    return Chart(
        id="error-split",
        title=f"What the error of mode {study.modes[-1]} is made of, N = {study.count}",
        caption=f"Division into parts: against the exact beam of the same theory. {theory}Rounding: the floor of the "
        "eigenvalues. Nothing is stepped in time here, so that no step has a share.",
        x=Axis("relative", log=True),
        y=Axis(""),
        bars=Bars(
            names=tuple(name for name, _, _ in parts[::-1]),
            values=tuple(size for _, size, _ in parts[::-1]),
            colours=tuple(colour for _, _, colour in parts[::-1]),
            words=tuple(f"{size:.1e}" for _, size, _ in parts[::-1]),
        )
        if len(parts) > 1
        else None,
    )


def _by_mode(rows: "tuple[Row, ...]") -> "dict[int, list[Row]]":
    return {mode: list(group) for mode, group in groupby(rows, key=lambda row: row.mode)}


def _mode_styles(rows: "tuple[Row, ...]") -> "list[tuple[list[Row], dict[str, Any], Line]]":
    """(rows of one mode, style of its lines, grey legend entry that explains it) for each mode."""
    styles = []
    for i, (mode, group) in enumerate(_by_mode(rows).items()):
        style: dict[str, Any] = {"dash": DASHES[i % 5], "marker": SYMBOLS[i % 5]}
        styles.append((group, style, key(f"mode {mode}", **style)))
    return styles


def _mean_line(x: list[int], y: "Sequence[float | None]", **style: Any) -> Line:
    return line("mean of both", MEAN_COLOUR, x, y, **style)


def _convergence(found: "ConvergenceFound") -> Chart:
    rows = found.rows
    lines: list[Line] = []
    keys = []
    for group, style, entry in _mode_styles(rows):
        counts = [row.count for row in group]
        errors = {m: percent([row.cells[m].error for row in group], size=True) for m in group[0].cells}
        traces = [_variant_line(found, label, counts, values, **style) for label, values in errors.items()]
        traces.append(_mean_line(counts, percent([row.mean_error for row in group], size=True), **style))
        lines += [one for one in traces if any(v is not None for v in one.y)]
        keys.append(entry)
    means = any(row.mean_error is not None for row in rows)
    orders = dict.fromkeys([*(order for _, order in found.slopes), *([_mean_order(found)] if means else [])])
    guides = [_slope(found, order) for order in orders]
    return Chart(
        id="errors-over-size",
        title="Convergence with the number of segments or elements",
        caption=(mean_in_words(found) + " " if means else "")
        + "Grey: the slopes that theory gives these models on this beam. "
        f"At about {unbroken(f'{100.0 * EIGENVALUE_FLOOR:.0e} %')} rounding takes over.",
        x=sizes_axis("number of parts N", (row.count for row in rows)),
        y=Axis("size of the frequency error, %", log=True),
        lines=(*_named_once(lines), *guides, *keys),
    )


def _named_once(lines: list[Line]) -> list[Line]:
    """Lines of which each name stands in the legend once, and is switched with all its kin."""
    named: set[str] = set()
    once = []
    for one in lines:
        once.append(replace(one, keyed=one.name not in named, group=one.name))
        named.add(one.name)
    return once


def _bounding_labels(found: "ConvergenceFound") -> dict[str, str]:
    """By model, the label of the variant that the bracket is made of."""
    names = [model.name for model in bounding()]
    return {name: Variant(name, for_model(name, found.bracketed.settings)).label for name in names}


def _mean_order(found: "ConvergenceFound") -> int:
    """Of the middle of the bracket: of equal orders both errors cancel, else the lower one stays."""
    orders = dict(found.slopes)
    low, high = (orders[label] for label in _bounding_labels(found).values())
    return CANCELLED if low == high else min(low, high)


def mean_in_words(found: "ConvergenceFound") -> str:
    """What the mean of both models is good for, by what was solved: it is farther off than elements on few parts."""
    order = _mean_order(found)
    if order != CANCELLED:
        return f"The mean of both is of order {order}, the segments' own at this wall: nothing cancels."
    above = _bounding_labels(found)[bounding()[1].name]
    errors = [(row, row.mean_error, row.cells[above].error) for row in found.rows]
    farther = [f"mode {row.mode} at N = {row.count}" for row, m, e in errors if m and e and abs(m) >= abs(e)]
    cancel = f"The mean of both is of order {order}, because the leading errors cancel"
    if not farther:
        return f"{cancel}, and here always nearer than elements alone."
    named = ", ".join(farther[:3]) + (f" and {len(farther) - 3} more" if len(farther) > 3 else "")
    return f"{cancel}, but farther off than elements alone beyond about n = {MEAN_LIMIT / pi:.1f} N: {named}."


def _slope(found: "ConvergenceFound", order: int) -> Line:
    """A reference slope above the coarsest solved point of a variant that has this order; 6 is that of the mean."""
    label = next((label for label, own in found.slopes if own == order), None)
    points = [(row.count, row.cells[label].error if label else row.mean_error) for row in found.rows]
    start = next(((n, e) for n, e in points if e), None)
    dash = GUIDES.get(order, "longdash")
    if start is None:
        return plain_line(f"slope {order}", GREY, (), (), guide=True)
    counts = sorted({row.count for row in found.rows if row.count >= start[0]})
    y = [250.0 * abs(start[1]) * (start[0] / n) ** order for n in counts]
    return plain_line(f"slope {order}", GREY, counts, y, width=1.0, dash=dash, guide=True)


def _bracket(found: "ConvergenceFound") -> Chart:
    """The bound of the highest mode, relative to the exact frequency."""
    mode, group = max(_by_mode(found.rows).items())
    labels = _bounding_labels(found)
    group = [row for row in group if row.bracket_width is not None]
    counts = [row.count for row in group]
    lower, upper = (
        model_line(name, counts, percent([row.cells[label].error for row in group])) for name, label in labels.items()
    )
    mean = _mean_line(counts, percent([row.mean_error for row in group]))
    return Chart(
        id="bracket",
        title=f"Two-sided bound on mode {mode}",
        caption="The exact frequency (zero) lies in the grey band for every N: no reference solution is needed to know "
        "that." + (f" Here {found.bracketed.told}." if found.bracketed.told else ""),
        x=sizes_axis("number of parts N", counts),
        y=Axis("against the exact frequency, %"),
        lines=(upper, replace(lower, filled=True), mean) if group else (),
    )


def _work(found: "ConvergenceFound") -> Chart:
    lines: list[Line] = []
    keys = []
    for group, style, entry in _mode_styles(found.rows):
        for label in group[0].cells:
            solved = [(row.cells[label], row.count) for row in group if row.cells[label].error is not None]
            times = [1e3 * (cell.run_time_s or 0.0) for cell, _ in solved]
            sizes = percent([cell.error for cell, _ in solved], size=True)
            said = tuple(f"N = {count}" for _, count in solved)
            lines += [_variant_line(found, label, times, sizes, said=said, **style)] if solved else []
        keys.append(entry)
    return Chart(
        id="work-precision",
        title="Run time against error",
        caption="A warm solve from beam to modes, set-up included, median of interleaved repeats on the machine named "
        "below. Lower left is better. scikit-fem's assembly is part of the Hermite time.",
        x=Axis("run time, ms", log=True),
        y=Axis("size of the frequency error, %", log=True),
        lines=(*_named_once(lines), *keys) if lines else (),
    )


def sensitivity_chart(study: "SensitivityFound") -> Chart:
    """The frequency over the modulus, a line for each density."""
    moduli = [e / 1e9 for e in study.moduli]
    lines = [
        plain_line(f"ρ = {rho:.0f} kg/m³", SHADES[i], moduli, row, width=3.0 if i == 2 else 1.5)
        for i, (rho, row) in enumerate(zip(study.densities, study.frequencies_hz, strict=True))
    ]
    caption = f"Exact Euler-Bernoulli: {_moved_by(study)}."
    if study.published_hz:
        lines.append(_published(study.published_hz, moduli))
        crossed = any(min(row) <= study.published_hz <= max(row) for row in study.frequencies_hz)
        fits = "every crossing is a material that fits it" if crossed else "no material drawn here fits it"
        caption += f" The dashed line is the published figure: {fits}."
    return Chart(
        id="modulus-density",
        title=f"Mode {study.mode} over modulus and density",
        caption=caption,
        x=Axis("Young's modulus, GPa"),
        y=Axis(f"frequency of mode {study.mode}, Hz"),
        lines=tuple(lines),
    )


PLAINLY = 1e-4
"""How far exponents of modulus and density may lie from 1/2 and -1/2 where nothing but the beam counts."""


def _moved_by(study: "SensitivityFound") -> str:
    """What one per cent of modulus or density does, by what was solved: half on a beam that carries nothing else."""
    table = study.frequencies_hz
    stiff = log(table[2][-1] / table[2][0]) / log(study.moduli[-1] / study.moduli[0])
    middle = len(study.moduli) // 2
    heavy = log(table[-1][middle] / table[0][middle]) / log(study.densities[-1] / study.densities[0])
    if max(abs(stiff - 0.5), abs(heavy + 0.5)) < PLAINLY:
        half = f"one per cent of modulus or density moves mode {study.mode} by half a per cent"
        return f"frequency goes with sqrt(E / rho), so that {half}"
    of = "with what stands on the beam, holds or pulls it, frequency does not go with sqrt(E / rho)"
    return f"{of}: one per cent of modulus moves mode {study.mode} by {stiff:+.3g} %, one of density by {heavy:+.3g} %"


def _published(frequency_hz: float, moduli: list[float]) -> Line:
    ends = (moduli[0], moduli[-1])
    return plain_line(f"published {frequency_hz:g} Hz", TIMOSHENKO, ends, [frequency_hz] * 2, dash="dash")
