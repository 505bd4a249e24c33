"""Charts of a chain's axial inertia as plain plotly figure data."""

from typing import TYPE_CHECKING, Any

from verify.motion.validity import NONLINEAR
from verify.report.charts import COLOUR, GREY, Figure, axes, chart
from verify.studies.slider import thinned

if TYPE_CHECKING:
    from verify.studies.axial_inertia import AxialStudy

NAMES = {
    "exact": "exact field",
    "fem": "Hermite elements",
    "linear": "linear chain",
    "full": "chain of rigid links",
    "transverse": "rigid links without axial inertia",
    "elastic": "links that stretch by EA/l",
}
_COLOURS = {
    "exact": GREY,
    "fem": COLOUR["fem"],
    "linear": COLOUR["mean"],
    "full": COLOUR["segment"],
    "transverse": COLOUR["rayleigh"],
    "elastic": COLOUR["timoshenko"],
}


def axial_charts(study: "AxialStudy") -> list[dict[str, Any]]:
    """Every model at one force in time, and the departure from the linear chain over the force."""
    return [_lines(study), _departures(study)]


def _lines(study: "AxialStudy") -> dict[str, Any]:
    times = [1e3 * t for t in thinned(study.times)]
    data: list[Figure] = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": NAMES[model],
            "x": times,
            "y": [1e6 * w for w in thinned(line)],
            "line": {
                "color": _COLOURS[model],
                "width": 4 if model == "exact" else 1.6,
                "dash": "dot" if model in ("transverse", "elastic") else "solid",
            },
        }
        for model, line in study.lines.items()
    ]
    return chart(
        "axial-models",
        f"Deflection at x = {study.x:g} m under {study.shown:g} N, N = {study.count}",
        "From rest, undamped. Chains without axial inertia, or with links that stretch, lie on the linear chain; what "
        "separates it from the exact field is the division into links, not the nonlinearity.",
        data,
        axes("time, ms", "deflection, µm"),
    )


def _departures(study: "AxialStudy") -> dict[str, Any]:
    rows = sorted(study.rows, key=lambda row: row.force)
    forces = [row.force for row in rows]
    data: list[Figure] = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": f"{NAMES[links]}, {word}",
            "x": forces,
            "y": [getattr(getattr(row, links), of) for row in rows],
            "line": {"color": _COLOURS[links], "dash": "solid" if of == "at_end" else "dash"},
        }
        for links in ("full", "transverse", "elastic")
        for of, word in (("at_end", "at the end"), ("rms", "rms"))
    ]
    data.append(
        {
            "type": "scatter",
            "mode": "lines",
            "name": "(kL)² ⟨θ²⟩",
            "x": forces,
            "y": [row.size for row in rows],
            "line": {"color": GREY, "width": 4},
        }
    )
    log = {"type": "log", "exponentformat": "power"}
    return chart(
        "axial-departures",
        f"Departure from the linear chain at x = {study.x:g} m over the force, N = {study.count}",
        "Over the linear chain's rms deflection: at the end of the run, and as rms over the run. Grey: the number that "
        f"decides between linear and nonlinear, felt from {NONLINEAR:g} on.",
        data,
        axes("force, N", "departure, relative", xaxis=log | {"exponentformat": "none"}, yaxis=log),
    )
