"""The readings of a slider as plain plotly figure data."""

from typing import TYPE_CHECKING

from verify.studies.charting import GREY, LOG, Figure, axes
from verify.studies.reading_words import met_words, start_words
from verify.studies.told import Chart

if TYPE_CHECKING:
    from verify.studies.reading_figures import Reading, ReadingsFound

_COLOURS = ("#2f80ed", "#e8760c", "#2a9d5c", "#8f5bd1", "#b8860b", GREY)

BESIDE = 1.09
"""From one colour's place to the next, as a factor of the force."""


def reading_charts(study: "ReadingsFound") -> tuple[Chart, ...]:
    """Mean speed over the force, one colour for kinematics and start, towards -x full and towards +x open."""
    ways: dict[tuple[str, str], list[Reading]] = {}
    for one in study.readings:
        how = one.condition
        start = "steady" if how.start == "steady" else start_words(how.soft_start_periods)
        ways.setdefault((how.kinematics, "nonlinear chain" if how.nonlinear else start), []).append(one)
    data = [
        _way(name, readings, _COLOURS[i % len(_COLOURS)], BESIDE ** (i - 0.5 * (len(ways) - 1)))
        for i, (name, readings) in enumerate(ways.items())
    ]
    claimed = {abs(c.number): c.id for c in study.claims if c.quantity == "slider.mean_speed" and c.number}
    forces = [max(one.condition.forces) for one in study.readings]
    for value, name in claimed.items():
        data.append(
            {
                "type": "scatter",
                "mode": "lines",
                "name": f"claimed: {name}",
                "x": [min(forces), max(forces)],
                "y": [100 * value] * 2,
                "line": {"color": GREY, "width": 2, "dash": "dash"},
            }
        )
    return (
        Chart(
            "slider-readings",
            f"Readings of the slider: size of the mean speed over the force, {_model(study)}",
            "Full: towards -x, open: towards +x. A colour is one kinematics and one start (soft: the periods over "
            "which the forces grow), drawn a little beside its force. Points of a colour above one another differ in "
            "place, mu and K. On hover: the claims that hold, by letter.",
            data,
            axes("force, N", "size of the mean speed, cm/s", xaxis=LOG | {"exponentformat": "none"}, yaxis=LOG),
        ),
    )


def _model(study: "ReadingsFound") -> str:
    return study.readings[0].condition.model_words


def _way(name: tuple[str, str], readings: "list[Reading]", colour: str, beside: float) -> Figure:
    """One colour, drawn at its forces times `beside`."""
    ended = [one for one in readings if one.speed]
    return {
        "type": "scatter",
        "mode": "markers",
        "name": f"{name[0]}, {name[1]}",
        "x": [beside * max(one.condition.forces) for one in ended],
        "y": [100 * abs(one.speed or 0.0) for one in ended],
        "text": [_hover(one) for one in ended],
        "hoverinfo": "text",
        "marker": {
            "color": colour,
            "size": 7,
            "line": {"color": colour, "width": 1.5},
            "symbol": ["circle" if (one.speed or 0.0) < 0 else "circle-open" for one in ended],
        },
    }


def _hover(reading: "Reading") -> str:
    speed = 100 * (reading.speed or 0.0)
    return f"{speed:+.3g} cm/s; {reading.condition.words}; holds: {met_words(reading)}"
