"""Charts of the driven beam as plain plotly figure data."""

from typing import TYPE_CHECKING

import numpy as np

from verify.models.catalogue import MODELS
from verify.studies.charting import LOG, Figure, axes, model_line, plain_line, sizes_axis
from verify.studies.told import Chart

if TYPE_CHECKING:
    from verify.studies.wave_figures import Ellipse, WaveFound
    from verify.waves.driven import Operation
    from verify.waves.operating_point import OperatingPoint

_ELLIPSE, _POINT = "#2f80ed", "#e8760c"
CLIPPED = 10.0
"""The largest standing-wave ratio that a map tells from larger ones."""


def wave_charts(study: "WaveFound") -> tuple[Chart, ...]:
    """Envelopes, ellipses, map, figures over sizes."""
    return _envelopes(study), _ellipses(study), _map(study), _sizes(study)


def _damping(study: "WaveFound") -> str:
    return "Undamped. " if study.undamped else "With the beam's loss factor. "


def _envelopes(study: "WaveFound") -> Chart:
    x = [1e3 * v for v in study.x]
    return Chart(
        "wave-envelopes",
        f"Envelope of the wave, N = {study.count}",
        _damping(study) + "A pure travelling wave has a flat envelope; ripples are reflection. Near the ends the "
        "standing wave of each actuator remains.",
        [_envelope(model, x, [1e6 * v for v in values]) for model, values in study.envelopes.items()],
        axes("x, mm", "amplitude, µm"),
    )


def _envelope(name: str, x: list[float], y: list[float]) -> Figure:
    model = MODELS[name]
    return plain_line(model.title, model.colour, x, y, 1.6 if model.sized else 4)


def _ellipses(study: "WaveFound") -> Chart:
    """Paths of surface points, drawn where they are; across enlarged against up, and saying so."""
    across = max(max(map(abs, e.across)) for e in study.ellipses)
    up = max(max(map(abs, e.up)) for e in study.ellipses)
    gap = (study.ellipses[1].x - study.ellipses[0].x) * 1e3
    magnified = 0.42 * gap / (1e3 * across)
    data = [trace for e in study.ellipses for trace in _path(e, magnified)]
    ratio = across / up
    return Chart(
        "wave-ellipses",
        "Surface ellipses along the beam, exact field",
        f"Drawn to scale they are slivers ({ratio:.3f} as wide as high): motion along the beam is magnified "
        f"{magnified:.2g} times, across it the axis has its own scale. Dots: where each point is at t = 0.",
        data,
        axes("x, mm", "up, µm"),
    )


def _path(one: "Ellipse", magnified: float) -> list[Figure]:
    """The path of a surface point, and where it is at t = 0."""
    x = [1e3 * (one.x + magnified * v) for v in one.across]
    y = [1e6 * v for v in one.up]
    path: Figure = {
        "type": "scatter",
        "mode": "lines",
        "x": x,
        "y": y,
        "showlegend": False,
        "hoverinfo": "skip",
        "line": {"color": _ELLIPSE},
    }
    start = {
        "type": "scatter",
        "mode": "markers",
        "x": x[:1],
        "y": y[:1],
        "showlegend": False,
        "name": f"x = {1e3 * one.x:.1f} mm",
        "marker": {"color": _POINT, "size": 6},
    }
    return [path, start]


def _marked(point: "OperatingPoint", symbol: str) -> Figure:
    """An operating point on the map."""
    return {
        "type": "scatter",
        "mode": "markers",
        "name": f"{point.what}: {point.frequency_hz:.1f} Hz, {point.phase_deg:.1f}°",
        "x": [point.frequency_hz],
        "y": [point.phase_deg],
        "marker": {"symbol": symbol, "size": 13, "color": "#ff5a36", "line": {"color": "#ffffff", "width": 1.5}},
    }


def _map(study: "WaveFound") -> Chart:
    found = study.map
    name = found.quantity.removeprefix("wave.").replace("_", " ").capitalize()
    values = np.clip(found.values.T, None, CLIPPED) if found.quantity == "wave.standing_wave_ratio" else found.values.T
    rounded = [[None if not np.isfinite(v) else float(f"{v:.4g}") for v in row] for row in values]
    data: list[Figure] = [
        {
            "type": "heatmap",
            "x": list(found.axes[0].values),
            "z": rounded,
            "y": [phase - study.first_phase_deg for phase in found.axes[1].values],
            "colorscale": "Viridis",
            "reversescale": True,
            "colorbar": {"thickness": 12},
            "hoverongaps": False,
        }
    ]
    data += [_marked(p, symbol) for p, symbol in zip(study.points, ("circle", "star"), strict=False)]
    return Chart(
        "wave-map",
        f"{name} over frequency and phase, {study.map.of}",
        _map_caption(study),
        data,
        axes("frequency, Hz", "phase of the second force relative to the first, degrees"),
    )


def _map_caption(study: "WaveFound") -> str:
    """Window, damping, what is clipped or missing, and where the wave would be pure if this drive makes it so."""
    clipped = study.map.quantity == "wave.standing_wave_ratio"
    return " ".join(
        [
            f"In the window [L/4, 3L/4], with loss factor {study.operating_loss_factor:g}, as the operating points.",
            *([f"Values above {CLIPPED:g} are drawn as {CLIPPED:g}."] if clipped else []),
            *(
                [
                    "Without losses the wave would be pure along phase = -kL (modulo 360°), at any frequency that "
                    "is no resonance."
                ]
                if study.pure_phase
                else []
            ),
            *(f"{reason}." for reason in study.map.reasons),
        ]
    )


def _sizes(study: "WaveFound") -> Chart:
    exact, models = study.rows[0], dict.fromkeys(row.model for row in study.rows if row.count)
    data = []
    for model in models:
        rows = [row for row in study.rows if row.model == model]
        drives = [(row.count, _apart(row.drive, exact.drive)) for row in rows]
        bests = [(row.count, _apart(row.best, exact.best)) for row in rows]
        for name, dash, points in (("at the drive", "solid", drives), ("at its own best frequency", "dot", bests)):
            known = [(count, y) for count, y in points if y is not None]
            trace = model_line(model, [count for count, _ in known], [y for _, y in known], line={"dash": dash})
            data.append(trace | {"name": f"{trace['name']}, {name}"})
    return Chart(
        "wave-sizes",
        "Error of the standing-wave ratio over N",
        "A small error of frequency spoils the wave at a fixed drive; driven at its own best frequency a coarse model "
        "carries nearly as pure a wave as the exact beam.",
        data,
        axes(
            "number of parts N",
            "difference to exact",
            xaxis=sizes_axis(row.count for row in study.rows if row.count),
            yaxis=LOG,
        ),
    )


def _apart(one: "Operation | None", other: "Operation | None") -> float | None:
    return abs(one.standing_wave_ratio - other.standing_wave_ratio) if one and other else None
