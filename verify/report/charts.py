"""Charts as plain plotly figure data: dicts of lists, no figure objects, so that building them costs little.

Colours carry meaning and are the same in every chart; text, grid and background come from the page's theme.
"""

from collections.abc import Iterable
from math import pi
from typing import TYPE_CHECKING, Any

from verify.exact.error_laws import MEAN_LIMIT
from verify.judge.compare import EIGENVALUE_FLOOR

if TYPE_CHECKING:
    from verify.run.runner import RunResult
    from verify.studies.modes import Row, SensitivityStudy, SpectrumStudy

Figure = dict[str, Any]

GREY = "#8a8f98"
COLOUR = {
    "segment": "#2f80ed",
    "fem": "#e8760c",
    "mean": "#2a9d5c",
    "rayleigh": "#9b6bdf",
    "timoshenko": "#d6427a",
    "key": GREY,
}
NAME = {
    "segment": "segments",
    "fem": "Hermite elements",
    "mean": "mean of both",
    "rayleigh": "Rayleigh",
    "timoshenko": "Timoshenko",
    "key": "key",
}
DASHES = ("solid", "dash", "dot", "dashdot", "longdash")
SYMBOLS = ("circle", "square", "diamond", "triangle-up", "x")


def charts_of(result: "RunResult") -> list[dict[str, Any]]:
    """Every chart of modes the scene asked for: {"id", "title", "caption", "figure"}."""
    charts = []
    if result.spectrum:
        charts += [_signed_errors(result.spectrum, bracketed(result)), _model_form(result.spectrum)]
    if result.convergence:
        charts += [_convergence(result.convergence), _bracket(result.convergence), _work(result.convergence)]
    if result.sensitivity:
        charts.append(_sensitivity(result.sensitivity))
    return [one for one in charts if one["figure"]["data"]]


def bracketed(result: "RunResult") -> bool:
    """Whether segments lie below and elements above for this beam."""
    from verify.errors import NoBracketError
    from verify.judge.workbench import check_bracket

    try:
        check_bracket(result.scene.beam, ())
    except NoBracketError:
        return False
    return True


def chart(name: str, title: str, caption: str, data: list[Figure], layout: Figure) -> dict[str, Any]:
    """One chart of the page."""
    return {"id": name, "title": title, "caption": caption, "figure": {"data": data, "layout": layout}}


def axes(x: str, y: str, **more: Any) -> Figure:
    """A layout with titled axes and settings for either."""
    layout: Figure = {"xaxis": {"title": {"text": x}}, "yaxis": {"title": {"text": y}}}
    for axis, settings in more.items():
        layout[axis] |= settings
    return layout


def _line(model: str, x: Iterable[Any], y: Iterable[Any], **more: Any) -> Figure:
    trace: Figure = {
        "type": "scatter",
        "mode": "lines+markers",
        "name": NAME[model],
        "x": list(x),
        "y": list(y),
        "line": {"color": COLOUR[model]},
        "marker": {"color": COLOUR[model], "size": 6},
    }
    line = trace["line"] | more.pop("line", {})
    marker = trace["marker"] | more.pop("marker", {})
    return trace | more | {"line": line, "marker": marker}


def _percent(values: Iterable[float | None], *, size: bool = False) -> list[float | None]:
    return [None if v is None else 100.0 * (abs(v) if size else v) for v in values]


def _signed_errors(study: "SpectrumStudy", two_sided: bool) -> dict[str, Any]:
    below = " Rigid links with rotary inertia lie below, Hermite elements above." if two_sided else ""
    data = [_line(m, study.modes, _percent(getattr(study, m))) for m in ("segment", "fem")]
    return chart(
        "mode-errors",
        f"Frequency error over mode number, N = {study.count}",
        f"Signed, against exact Euler-Bernoulli.{below}",
        data,
        axes("mode number", "frequency error, %"),
    )


def _model_form(study: "SpectrumStudy") -> dict[str, Any]:
    models = ("segment", "fem") if study.theories else ()  # without a theory beside them they say nothing new
    data = [_line(m, study.modes, _percent(getattr(study, m), size=True)) for m in models]
    for theory, errors in study.theories.items():
        data.append(_line(theory, study.modes, _percent(errors, size=True), line={"dash": "dash"}))
    return chart(
        "model-form",
        f"Discretisation beside model form, N = {study.count}",
        "Solid: what dividing the beam costs. Dashed: what Euler-Bernoulli theory leaves out, rotary inertia "
        "(Rayleigh) and shear as well (Timoshenko). A mesh finer than that answers a question nobody asked.",
        data,
        axes("mode number", "size of the frequency error, %", yaxis={"type": "log", "exponentformat": "power"}),
    )


def _by_mode(rows: "tuple[Row, ...]") -> "dict[int, list[Row]]":
    groups: dict[int, list[Row]] = {}
    for row in rows:
        groups.setdefault(row.mode, []).append(row)
    return groups


def _mode_styles(rows: "tuple[Row, ...]") -> list[tuple[list[Any], Figure, Figure]]:
    """(rows of one mode, trace style, grey legend entry that explains the dash) for each mode."""
    styles = []
    for i, (mode, group) in enumerate(_by_mode(rows).items()):
        style: Figure = {"line": {"dash": DASHES[i % 5]}, "marker": {"symbol": SYMBOLS[i % 5]}}
        key = _line("key", [None], [None], **style) | {"name": f"mode {mode}"}
        styles.append((group, style, key))
    return styles


def _convergence(rows: "tuple[Row, ...]") -> dict[str, Any]:
    data, keys, named = [], [], set()
    for group, style, key in _mode_styles(rows):
        errors = {m: [getattr(row, m).error for row in group] for m in ("segment", "fem")}
        errors["mean"] = [row.mean_error for row in group]
        for model, values in errors.items():
            if any(v is not None for v in values):
                trace = _line(model, [row.count for row in group], _percent(values, size=True), **style)
                data.append(trace | {"showlegend": model not in named, "legendgroup": model})
                named.add(model)
        keys.append(key)
    means = "mean" in named
    data += [_slope(rows, 4), *([_slope(rows, 6)] if means else []), *keys]
    log = {"type": "log", "exponentformat": "power"}
    return chart(
        "convergence",
        "Convergence with the number of segments or elements",
        (mean_in_words(rows) + " " if means else "")
        + f"Grey: reference slopes. At about {100.0 * EIGENVALUE_FLOOR:.0e} % rounding takes over.",
        data,
        axes("segments or elements N", "size of the frequency error, %", xaxis=_sizes(rows), yaxis=log),
    )


def mean_in_words(rows: "tuple[Row, ...]") -> str:
    """What the mean of both models is good for, by what was solved: it is farther off than elements on few parts."""
    errors = [(row, row.mean_error, row.fem.error) for row in rows]
    farther = [f"mode {row.mode} at N = {row.count}" for row, m, e in errors if m and e and abs(m) >= abs(e)]
    order = "The mean of both is of order 6, because the leading errors cancel"
    if not farther:
        return f"{order}, and here always nearer than elements alone."
    named = ", ".join(farther[:3]) + (f" and {len(farther) - 3} more" if len(farther) > 3 else "")
    return f"{order}, but farther off than elements alone beyond about n = {MEAN_LIMIT / pi:.1f} N: {named}."


def _sizes(rows: "Iterable[Row]") -> Figure:
    """A logarithmic axis with a tick at every size that was solved."""
    counts = sorted({row.count for row in rows})
    return {"type": "log", "tickvals": counts, "ticktext": [str(n) for n in counts]}


def _slope(rows: "tuple[Row, ...]", order: int) -> Figure:
    """A reference slope through the coarsest solved point of the last mode that has two sizes."""
    points = [(row.count, row.mean_error if order == 6 else row.segment.error) for row in rows]
    start = next(((n, e) for n, e in points if e), None)
    if start is None:
        return {"type": "scatter", "x": [], "y": [], "name": f"slope {order}"}
    counts = sorted({row.count for row in rows if row.count >= start[0]})
    y = [250.0 * abs(start[1]) * (start[0] / n) ** order for n in counts]
    return {
        "type": "scatter",
        "mode": "lines",
        "name": f"slope {order}",
        "x": counts,
        "y": y,
        "hoverinfo": "skip",
        "line": {"color": GREY, "width": 1, "dash": "dot" if order == 6 else "solid"},
    }


def _bracket(rows: "tuple[Row, ...]") -> dict[str, Any]:
    """The bound of the highest mode, relative to the exact frequency."""
    mode, group = max(_by_mode(rows).items())
    group = [row for row in group if row.bracket_width is not None]
    counts = [row.count for row in group]
    upper = _line("fem", counts, _percent([row.fem.error for row in group]))
    lower = _line("segment", counts, _percent([row.segment.error for row in group]))
    lower |= {"fill": "tonexty", "fillcolor": "rgba(138,143,152,0.18)"}
    mean = _line("mean", counts, _percent([row.mean_error for row in group]))
    return chart(
        "bracket",
        f"Two-sided bound on mode {mode}",
        "The exact frequency (zero) lies in the grey band for every N: no reference solution is needed to know that.",
        [upper, lower, mean] if group else [],
        axes("segments or elements N", "against the exact frequency, %", xaxis=_sizes(group)),
    )


def _work(rows: "tuple[Row, ...]") -> dict[str, Any]:
    data, keys, named = [], [], set()
    for group, style, key in _mode_styles(rows):
        for model in ("segment", "fem"):
            cells = [(getattr(row, model), row.count) for row in group]
            solved = [(cell, count) for cell, count in cells if cell.error is not None]
            trace = _line(
                model,
                [1e3 * cell.run_time_s for cell, _ in solved],
                _percent([cell.error for cell, _ in solved], size=True),
                **style,
            )
            if solved:
                labels = [f"N = {count}" for _, count in solved]
                data.append(trace | {"text": labels, "showlegend": model not in named, "legendgroup": model})
                named.add(model)
        keys.append(key)
    log = {"type": "log", "exponentformat": "power"}
    return chart(
        "work-precision",
        "Run time against error",
        "A warm solve from beam to modes, set-up included, median of interleaved repeats on the machine named below. "
        "Lower left is better. scikit-fem's assembly is part of the Hermite time.",
        data + keys,
        axes("run time, ms", "size of the frequency error, %", xaxis=log, yaxis=log),
    )


def _sensitivity(study: "SensitivityStudy") -> dict[str, Any]:
    shades = ("#56c7c2", "#3fa7d6", "#2f80ed", "#6d6fe0", "#9b6bdf")
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
        data.append(
            {
                "type": "scatter",
                "mode": "lines",
                "name": f"published {study.published_hz:g} Hz",
                "x": [moduli[0], moduli[-1]],
                "y": [study.published_hz] * 2,
                "line": {"color": "#d6427a", "dash": "dash"},
            }
        )
        caption += " The dashed line is the published figure: every crossing is a material that fits it."
    layout = axes("Young's modulus, GPa", f"frequency of mode {study.mode}, Hz")
    return chart("sensitivity", f"Mode {study.mode} over the inferred modulus and density", caption, data, layout)
