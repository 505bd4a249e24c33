"""Charts of modes: errors over mode number and size, the bracket, run time, material."""

from itertools import groupby
from math import pi
from typing import TYPE_CHECKING

from verify.exact.error_laws import MEAN_LIMIT
from verify.judge.compare import EIGENVALUE_FLOOR
from verify.models.catalogue import bounding
from verify.options import THEORIES
from verify.studies.charting import (
    DASHES,
    GREY,
    LOG,
    MEAN_COLOUR,
    PALETTE,
    RAYLEIGH,
    SYMBOLS,
    TIMOSHENKO,
    Figure,
    axes,
    line,
    model_line,
    percent,
    sizes_axis,
)
from verify.studies.told import Chart
from verify.words import theory_name

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.studies.convergence_figures import ConvergenceFound, Row
    from verify.studies.sensitivity_figures import SensitivityFound
    from verify.studies.spectrum_figures import SpectrumFound

_THEORIES = {"rayleigh": RAYLEIGH, "timoshenko": TIMOSHENKO}


def spectrum_charts(study: "SpectrumFound") -> tuple[Chart, ...]:
    """Signed errors, and their sizes beside the theories'."""
    charts = (_signed_errors(study), _model_form(study))
    return tuple(one for one in charts if one.data)


def convergence_charts(found: "ConvergenceFound") -> tuple[Chart, ...]:
    """Errors over sizes, the rules of the chain, the bracket, run time against error."""
    charts = (_convergence(found), _rules(found), _bracket(found), _work(found))
    return tuple(one for one in charts if one.data)


def _variant_line(
    found: "ConvergenceFound | SpectrumFound",
    label: str,
    x: "Sequence[float]",
    y: "Sequence[float | None]",
    **style: Figure,
) -> Figure:
    """The line of a variant: its model's where there is one of it, else a colour of its own."""
    one = next(variant for variant in found.variants if variant.label == label)
    kin = [variant for variant in found.variants if variant.model == one.model]
    if len(kin) == 1 or kin[0] == one:
        return model_line(one.model, x, y, **style) | {"name": one.title}
    return line(one.title, PALETTE[kin.index(one) % len(PALETTE)], x, y, **style)


def _rules(found: "ConvergenceFound") -> Chart:
    """One line for each rule of the chain, the default in the model's colour."""
    data = []
    for i, one in enumerate(found.rules):
        y = percent(one.errors, size=True)
        plain = line(one.variant.title, PALETTE[i % len(PALETTE)], one.counts, y)
        data.append(plain if one.variant.settings else model_line(one.variant.model, one.counts, y))
    mode = found.rules[0].mode if found.rules else 0
    return Chart(
        id="rules",
        title=f"Every rule of the chain on this beam, mode {mode}",
        caption="Walls, joints and attachments side by side. A dip is where an error changes its sign: after it the "
        "error grows once more before it falls for good.",
        data=data,
        layout=axes(
            "number of segments N",
            "size of the frequency error, %",
            xaxis=sizes_axis(n for one in found.rules for n in one.counts),
            yaxis=LOG,
        ),
    )


def _signed_errors(study: "SpectrumFound") -> Chart:
    below = " Rigid links with rotary inertia lie below, Hermite elements above." if study.bracketed else ""
    return Chart(
        id="mode-errors",
        title=f"Frequency error over mode number, N = {study.count}",
        caption=f"Signed, against exact {study.theory}.{below}",
        data=[_variant_line(study, label, study.modes, percent(values)) for label, values in study.errors.items()],
        layout=axes("mode number", "frequency error, %"),
    )


def _model_form(study: "SpectrumFound") -> Chart:
    errors = study.errors if study.theories else {}  # without a theory beside them they say nothing new
    data = [_variant_line(study, label, study.modes, percent(v, size=True)) for label, v in errors.items()]
    for theory, values in study.theories.items():
        sizes = percent(values, size=True)
        data.append(line(theory_name(theory), _THEORIES[theory], study.modes, sizes, line={"dash": "dash"}))
    plain = study.theory == theory_name(THEORIES[0])
    moral = " A mesh finer than that answers a question nobody asked." if plain else ""
    return Chart(
        id="model-form",
        title=f"Discretisation beside model form, N = {study.count}",
        caption="Solid: what dividing the beam costs. Dashed: what Euler-Bernoulli theory leaves out, rotary inertia "
        "(Rayleigh) and shear as well (Timoshenko)." + moral,
        data=data,
        layout=axes("mode number", "size of the frequency error, %", yaxis=LOG),
    )


def _by_mode(rows: "tuple[Row, ...]") -> "dict[int, list[Row]]":
    return {mode: list(group) for mode, group in groupby(rows, key=lambda row: row.mode)}


def _mode_styles(rows: "tuple[Row, ...]") -> "list[tuple[list[Row], Figure, Figure]]":
    """(rows of one mode, trace style, grey legend entry that explains the dash) for each mode."""
    styles = []
    for i, (mode, group) in enumerate(_by_mode(rows).items()):
        style: Figure = {"line": {"dash": DASHES[i % 5]}, "marker": {"symbol": SYMBOLS[i % 5]}}
        styles.append((group, style, line(f"mode {mode}", GREY, [None], [None], **style)))
    return styles


def _mean_line(x: list[int], y: list[float | None], **style: Figure) -> Figure:
    return line("mean of both", MEAN_COLOUR, x, y, **style)


def _convergence(found: "ConvergenceFound") -> Chart:
    rows = found.rows
    data, keys = [], []
    for group, style, key in _mode_styles(rows):
        counts = [row.count for row in group]
        errors = {m: percent([row.cells[m].error for row in group], size=True) for m in group[0].cells}
        traces = [_variant_line(found, label, counts, values, **style) for label, values in errors.items()]
        traces.append(_mean_line(counts, percent([row.mean_error for row in group], size=True), **style))
        data += [trace for trace in traces if any(v is not None for v in trace["y"])]
        keys.append(key)
    means = any(row.mean_error is not None for row in rows)
    guides = [_slope(found, order) for order in (*dict.fromkeys(o for _, o in found.slopes), *([6] if means else []))]
    return Chart(
        id="convergence",
        title="Convergence with the number of segments or elements",
        caption=(mean_in_words(found) + " " if means else "")
        + "Grey: the slopes that theory gives these models on this beam. "
        f"At about {100.0 * EIGENVALUE_FLOOR:.0e} % rounding takes over.",
        data=[*_named_once(data), *guides, *keys],
        layout=axes(
            "number of parts N",
            "size of the frequency error, %",
            xaxis=sizes_axis(row.count for row in rows),
            yaxis=LOG,
        ),
    )


def _named_once(traces: list[Figure]) -> list[Figure]:
    """Traces of which each name stands in the legend once, and is switched with all its kin."""
    named: set[str] = set()
    once = []
    for trace in traces:
        once.append(trace | {"showlegend": trace["name"] not in named, "legendgroup": trace["name"]})
        named.add(trace["name"])
    return once


def mean_in_words(found: "ConvergenceFound") -> str:
    """What the mean of both models is good for, by what was solved: it is farther off than elements on few parts."""
    above = next(one.label for one in found.variants if one.model == bounding()[1].name)
    errors = [(row, row.mean_error, row.cells[above].error) for row in found.rows]
    farther = [f"mode {row.mode} at N = {row.count}" for row, m, e in errors if m and e and abs(m) >= abs(e)]
    order = "The mean of both is of order 6, because the leading errors cancel"
    if not farther:
        return f"{order}, and here always nearer than elements alone."
    named = ", ".join(farther[:3]) + (f" and {len(farther) - 3} more" if len(farther) > 3 else "")
    return f"{order}, but farther off than elements alone beyond about n = {MEAN_LIMIT / pi:.1f} N: {named}."


def _slope(found: "ConvergenceFound", order: int) -> Figure:
    """A reference slope above the coarsest solved point of a variant that has this order; 6 is that of the mean."""
    label = next((label for label, own in found.slopes if own == order), None)
    points = [(row.count, row.cells[label].error if label else row.mean_error) for row in found.rows]
    start = next(((n, e) for n, e in points if e), None)
    if start is None:
        return {"type": "scatter", "x": [], "y": [], "name": f"slope {order}"}
    counts = sorted({row.count for row in found.rows if row.count >= start[0]})
    y = [250.0 * abs(start[1]) * (start[0] / n) ** order for n in counts]
    return {
        "type": "scatter",
        "mode": "lines",
        "name": f"slope {order}",
        "x": counts,
        "y": y,
        "hoverinfo": "skip",
        "line": {"color": GREY, "width": 1, "dash": "dot" if label is None else "solid"},
    }


def _bracket(found: "ConvergenceFound") -> Chart:
    """The bound of the highest mode, relative to the exact frequency."""
    mode, group = max(_by_mode(found.rows).items())
    labels = {model.name: next(one.label for one in found.variants if one.model == model.name) for model in bounding()}
    group = [row for row in group if row.bracket_width is not None]
    counts = [row.count for row in group]
    lower, upper = (
        model_line(name, counts, percent([row.cells[label].error for row in group])) for name, label in labels.items()
    )
    lower |= {"fill": "tonexty", "fillcolor": "rgba(138,143,152,0.18)"}
    mean = _mean_line(counts, percent([row.mean_error for row in group]))
    return Chart(
        id="bracket",
        title=f"Two-sided bound on mode {mode}",
        caption="The exact frequency (zero) lies in the grey band for every N: no reference solution is needed to know "
        "that.",
        data=[upper, lower, mean] if group else [],
        layout=axes("number of parts N", "against the exact frequency, %", xaxis=sizes_axis(counts)),
    )


def _work(found: "ConvergenceFound") -> Chart:
    data, keys = [], []
    for group, style, key in _mode_styles(found.rows):
        for label in group[0].cells:
            solved = [(row.cells[label], row.count) for row in group if row.cells[label].error is not None]
            times = [1e3 * (cell.run_time_s or 0.0) for cell, _ in solved]
            sizes = percent([cell.error for cell, _ in solved], size=True)
            trace = _variant_line(found, label, times, sizes, **style)
            data += [trace | {"text": [f"N = {count}" for _, count in solved]}] if solved else []
        keys.append(key)
    return Chart(
        id="work-precision",
        title="Run time against error",
        caption="A warm solve from beam to modes, set-up included, median of interleaved repeats on the machine named "
        "below. Lower left is better. scikit-fem's assembly is part of the Hermite time.",
        data=[*_named_once(data), *keys] if data else [],
        layout=axes("run time, ms", "size of the frequency error, %", xaxis=LOG, yaxis=LOG),
    )


def sensitivity_chart(study: "SensitivityFound") -> Chart:
    """The frequency over the modulus, a line for each density."""
    shades = ("#56c7c2", "#3fa7d6", "#2f80ed", "#6d6fe0", RAYLEIGH)
    moduli = [e / 1e9 for e in study.moduli]
    data: list[Figure] = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": f"ρ = {rho:.0f} kg/m³",
            "x": moduli,
            "y": list(row),
            "line": {"color": shades[i], "width": 3 if i == 2 else 1.5},
        }
        for i, (rho, row) in enumerate(zip(study.densities, study.frequencies_hz, strict=True))
    ]
    caption = (
        f"Exact Euler-Bernoulli: frequency goes with sqrt(E / rho), so that one per cent of modulus or density moves "
        f"mode {study.mode} by half a per cent."
    )
    if study.published_hz:
        data.append(_published(study.published_hz, moduli))
        caption += " The dashed line is the published figure: every crossing is a material that fits it."
    return Chart(
        id="sensitivity",
        title=f"Mode {study.mode} over the inferred modulus and density",
        caption=caption,
        data=data,
        layout=axes("Young's modulus, GPa", f"frequency of mode {study.mode}, Hz"),
    )


def _published(frequency_hz: float, moduli: list[float]) -> Figure:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": f"published {frequency_hz:g} Hz",
        "x": [moduli[0], moduli[-1]],
        "y": [frequency_hz] * 2,
        "line": {"color": TIMOSHENKO, "dash": "dash"},
    }
