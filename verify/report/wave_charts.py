"""Charts of the driven beam as plain plotly figure data."""

from typing import TYPE_CHECKING, Any

import numpy as np

from verify.report.charts import COLOUR, GREY, NAME, Figure, axes, chart

if TYPE_CHECKING:
    from verify.studies.wave import WaveStudy

CLIPPED = 10.0
"""The largest standing-wave ratio that a map tells from larger ones."""


def wave_charts(study: "WaveStudy") -> list[dict[str, Any]]:
    """Envelopes, ellipses, map, figures over sizes."""
    return [_envelopes(study), _ellipses(study), _map(study), _sizes(study)]


def _damping(study: "WaveStudy") -> str:
    return "Undamped. " if study.undamped else "With the beam's loss factor. "


def _envelopes(study: "WaveStudy") -> dict[str, Any]:
    names = {"analytic": "exact", "segment": NAME["segment"], "fem": NAME["fem"]}
    colours = {"analytic": GREY, **COLOUR}
    x = [1e3 * v for v in study.x]
    data: list[Figure] = [
        {
            "type": "scatter",
            "mode": "lines",
            "name": names[model],
            "x": x,
            "y": [1e6 * v for v in values],
            "line": {"color": colours[model], "width": 4 if model == "analytic" else 1.6},
        }
        for model, values in study.envelopes.items()
    ]
    return chart(
        "wave-envelopes",
        f"Envelope of the wave, N = {study.count}",
        _damping(study) + "A pure travelling wave has a flat envelope; ripples are reflection. Near the ends the "
        "standing wave of each actuator remains.",
        data,
        axes("x, mm", "amplitude, µm"),
    )


def _ellipses(study: "WaveStudy") -> dict[str, Any]:
    """Paths of surface points, drawn where they are; across enlarged against up, and saying so."""
    across = max(max(map(abs, e.across)) for e in study.ellipses)
    up = max(max(map(abs, e.up)) for e in study.ellipses)
    gap = (study.ellipses[1].x - study.ellipses[0].x) * 1e3
    magnified = 0.42 * gap / (1e3 * across)
    data: list[Figure] = []
    for e in study.ellipses:
        x = [1e3 * (e.x + magnified * v) for v in e.across]
        y = [1e6 * v for v in e.up]
        data.append(
            {
                "type": "scatter",
                "mode": "lines",
                "x": x,
                "y": y,
                "showlegend": False,
                "hoverinfo": "skip",
                "line": {"color": COLOUR["segment"]},
            }
        )
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": x[:1],
                "y": y[:1],
                "showlegend": False,
                "name": f"x = {1e3 * e.x:.1f} mm",
                "marker": {"color": COLOUR["fem"], "size": 6},
            }
        )
    ratio = across / up
    return chart(
        "wave-ellipses",
        "Surface ellipses along the beam, exact field",
        f"Drawn to scale they are slivers ({ratio:.3f} as wide as high): motion along the beam is magnified "
        f"{magnified:.2g} times, across it the axis has its own scale. Dots: where each point is at t = 0.",
        data,
        axes("x, mm", "up, µm"),
    )


def _map(study: "WaveStudy") -> dict[str, Any]:
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
    for point, symbol in zip(study.points, ("circle", "star"), strict=False):
        label = f"{point.what}: {point.frequency_hz:.1f} Hz, {point.phase_deg:.1f}°"
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": label,
                "x": [point.frequency_hz],
                "y": [point.phase_deg],
                "marker": {
                    "symbol": symbol,
                    "size": 13,
                    "color": "#ff5a36",
                    "line": {"color": "#ffffff", "width": 1.5},
                },
            }
        )
    return chart(
        "wave-map",
        f"{name} over frequency and phase, {study.map.of}",
        _map_caption(study),
        data,
        axes("frequency, Hz", "phase of the second force relative to the first, degrees"),
    )


def _map_caption(study: "WaveStudy") -> str:
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


def _sizes(study: "WaveStudy") -> dict[str, Any]:
    exact = study.rows[0]
    data: list[Figure] = []
    for model in ("segment", "fem"):
        rows = [row for row in study.rows if row.model == model]
        for name, dash, pick in (("at the drive", "solid", "drive"), ("at its own best frequency", "dot", "best")):
            known = [row for row in rows if getattr(row, pick) and getattr(exact, pick)]
            excess = [
                abs(getattr(row, pick).standing_wave_ratio - getattr(exact, pick).standing_wave_ratio) for row in known
            ]
            data.append(
                {
                    "type": "scatter",
                    "mode": "lines+markers",
                    "name": f"{NAME[model]}, {name}",
                    "x": [row.count for row in known],
                    "y": excess,
                    "line": {"color": COLOUR[model], "dash": dash},
                }
            )
    log = {"type": "log", "exponentformat": "power"}
    counts = sorted({row.count for row in study.rows if row.count})
    ticks = {"type": "log", "tickvals": counts, "ticktext": [str(n) for n in counts]}
    return chart(
        "wave-sizes",
        "Error of the standing-wave ratio over N",
        "A small error of frequency spoils the wave at a fixed drive; driven at its own best frequency a coarse model "
        "carries nearly as pure a wave as the exact beam.",
        data,
        axes("segments or elements N", "difference to exact", xaxis=ticks, yaxis=log),
    )
