"""Charts of the driven beam."""

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from verify.models.catalogue import MODELS
from verify.studies.chart import Axis, Chart, Line, Map, Marker
from verify.studies.charting import BROAD, in_units, model_line, numbers, plain_line, sizes_axis
from verify.studies.wave.movie import magnification, wave_movie
from verify.units import Unit, unit_of, unit_over
from verify.waves.operating_point import OFF

if TYPE_CHECKING:
    from collections.abc import Sequence

    from verify.studies.wave.figures import Ellipse, WaveFound
    from verify.waves.driven import Operation
    from verify.waves.operating_point import OperatingPoint

_ELLIPSE, _POINT = "#2f80ed", "#e8760c"
CLIPPED = 10.0
"""The largest standing-wave ratio that a map tells from larger ones."""
TINY = 1e-300
"""Metres: a point that does not rise at all is told as endlessly wide."""
MOSTLY = 0.1
"""Of a difference at the drive is left at the best frequency at most, where its frequency is called its cause."""


def wave_charts(study: "WaveFound") -> tuple[Chart, ...]:
    """Envelopes, ellipses, the wave as it runs, map, figures over sizes."""
    moving = wave_movie(study.snapshots, study.ellipses, study.count)
    return _envelopes(study), _ellipses(study), moving, _map(study), _sizes(study)


def _damping(study: "WaveFound") -> str:
    return "Undamped. " if study.undamped else "With the beam's loss factor. "


def _envelopes(study: "WaveFound") -> Chart:
    along, up = unit_of(study.x[-1]), unit_over(v for values in study.envelopes.values() for v in values)
    broad_first = sorted(study.envelopes.items(), key=lambda item: MODELS[item[0]].sized)
    return Chart(
        id="wave-envelopes",
        title=f"Envelope of the wave, N = {study.count}",
        caption=_damping(study) + "On one section without losses a pure travelling wave has a flat envelope; "
        "ripples are reflection. Next to forces and ends there is a part that decays.",
        x=Axis(f"x, {along.name}"),
        y=Axis(f"amplitude, {up.name}"),
        lines=tuple(in_units(_envelope(model, study.x, values), along, up) for model, values in broad_first),
    )


def _envelope(name: str, x: "Sequence[float]", y: "Sequence[float]") -> Line:
    model = MODELS[name]
    return plain_line(model.title, model.colour, x, y, width=1.6 if model.sized else BROAD)


def _ellipses(study: "WaveFound") -> Chart:
    """Paths of surface points, drawn where they are; across enlarged against up, and saying so."""
    magnified = magnification(study.ellipses)
    wide = [float(np.ptp(e.across) / max(np.ptp(e.up), TINY)) for e in study.ellipses]
    along, up = unit_of(study.x[-1]), unit_over(v for e in study.ellipses for v in e.up)
    return Chart(
        id="wave-ellipses",
        title="Surface ellipses along the beam, exact field",
        caption=f"Drawn to scale they are {_from_to(wide)} times as wide as high. Here motion along the beam is drawn "
        f"{magnified:.2g} times as large, and across it the axis has its own scale. Dots: where each point is at "
        "t = 0.",
        x=Axis(f"x, {along.name}"),
        y=Axis(f"up, {up.name}"),
        lines=tuple(in_units(one, along, up) for e in study.ellipses for one in _path(e, magnified, along)),
    )


def _from_to(values: list[float]) -> str:
    """The least and the largest to three digits, or the one where they are alike."""
    low, high = f"{min(values):.3g}", f"{max(values):.3g}"
    return low if low == high else f"{low} to {high}"


def _path(one: "Ellipse", magnified: float, along: Unit) -> tuple[Line, Line]:
    """The path of a surface point, and where it is at t = 0."""
    x, y = [one.x + magnified * v for v in one.across], one.up
    path = plain_line("path", _ELLIPSE, x, y, keyed=False, guide=True)
    said = (f"x = {along.factor * one.x:.4g} {along.name}",)
    start = Line(
        name="at t = 0",
        colour=_POINT,
        x=numbers(x[:1]),
        y=numbers(y[:1]),
        marker="circle",
        joined=False,
        keyed=False,
        said=said,
    )
    return path, start


def _marked(point: "OperatingPoint", symbol: Marker) -> Line:
    """An operating point on the map."""
    return Line(
        name=f"{point.what}: {point.frequency_hz:.5g} Hz, {point.phase_deg:.1f}°",
        x=(point.frequency_hz,),
        y=(point.phase_deg,),
        colour="#ff5a36",
        marker=symbol,
        size=11.0,
        joined=False,
    )


def _map(study: "WaveFound") -> Chart:
    found = study.map
    name = found.quantity.removeprefix("wave.").replace("_", " ").capitalize()
    most = CLIPPED if found.quantity == "wave.standing_wave_ratio" else None
    values = found.values.T if most is None else np.clip(found.values.T, None, most)
    marks: tuple[Marker, ...] = ("circle", "star")
    return Chart(
        id="wave-map",
        title=f"{name} over frequency and phase, {study.map.of}",
        caption=_map_caption(study),
        x=Axis("frequency, Hz"),
        y=Axis("phase of the second force to the first, °"),
        map=Map(
            name=name.lower(),
            x=tuple(map(float, found.axes[0].values)),
            y=tuple(float(phase - study.first_phase_deg) for phase in found.axes[1].values),
            values=tuple(numbers(row) for row in values),
            most=most,
        ),
        lines=tuple(_marked(point, symbol) for point, symbol in zip(study.points, marks, strict=False)),
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
    lines = []
    for model in models:
        rows = [row for row in study.rows if row.model == model]
        drives = [(row.count, _apart(row.drive, exact.drive)) for row in rows]
        bests = [(row.count, _apart(row.known_best, exact.known_best)) for row in rows]
        for name, dash, points in (("at the drive", "solid", drives), ("at its own best frequency", "dot", bests)):
            known = [(count, y) for count, y in points if y is not None]
            if not known:
                continue
            own = model_line(model, [count for count, _ in known], [y for _, y in known], dash=dash)
            lines.append(replace(own, name=f"{own.name}, {name}"))
    return Chart(
        id="wave-sizes",
        title="Error of the standing-wave ratio over N",
        caption=_best_told(study),
        x=sizes_axis("number of parts N", (row.count for row in study.rows if row.count)),
        y=Axis("difference to exact", log=True),
        lines=tuple(lines),
    )


def _best_told(study: "WaveFound") -> str:
    """How far models lie off at the drive and each at its best frequency; what that says of the cause, if it does."""
    exact, sized = study.rows[0], [row for row in study.rows if row.count]
    drives = _largest([_apart(row.drive, exact.drive) for row in sized])
    bests = _largest([_apart(row.known_best, exact.known_best) for row in sized])
    told = [] if drives is None else [f"Models lie up to {drives:.1e} off at the drive's frequency"]
    told += [] if bests is None else [f"up to {bests:.1e} each at its own best"]
    cause = drives is not None and bests is not None and bests < MOSTLY * drives
    words = ", ".join(told) + (": at the drive it is errors of frequency that spoil the wave." if cause else ".")
    off = sum(row.off_search for row in study.rows)
    if not off:
        return words
    return f"{words} Of {off} of {len(study.rows)} models no best frequency is known: the reflection falls {OFF}."


def _largest(apart: "Sequence[float | None]") -> float | None:
    """Of what is known and finite."""
    return max((one for one in apart if one is not None and np.isfinite(one)), default=None)


def _apart(one: "Operation | None", other: "Operation | None") -> float | None:
    return abs(one.standing_wave_ratio - other.standing_wave_ratio) if one and other else None
