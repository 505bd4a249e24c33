"""The readings of a slider as a chart."""

from typing import TYPE_CHECKING

from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import GREY, numbers, plain_line
from verify.studies.readings.words import met_words, start_words

if TYPE_CHECKING:
    from verify.studies.readings.figures import Reading, ReadingsFound

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
    lines = [
        _way(name, readings, _COLOURS[i % len(_COLOURS)], BESIDE ** (i - 0.5 * (len(ways) - 1)))
        for i, (name, readings) in enumerate(ways.items())
    ]
    claimed = {abs(c.number): c.id for c in study.claims if c.quantity == "slider.mean_speed" and c.number}
    forces = [max(one.condition.forces) for one in study.readings]
    ends = (min(forces), max(forces))
    for value, name in claimed.items():
        lines.append(plain_line(f"claimed: {name}", GREY, ends, [100 * value] * 2, width=2.0, dash="dash"))
    return (
        Chart(
            id="slider-readings",
            title=f"Readings of the slider: size of the mean speed over the force, {_model(study)}",
            caption="Full: towards -x, open: towards +x. A colour is one kinematics and one start (soft: the periods "
            "over which the forces grow), drawn a little beside its force. Points of a colour above one another differ "
            "in place, mu and K. Under the cursor: the claims that hold, by letter.",
            x=Axis("force, N", log=True),
            y=Axis("size of the mean speed, cm/s", log=True),
            lines=tuple(lines),
        ),
    )


def _model(study: "ReadingsFound") -> str:
    return study.readings[0].condition.model_words


def _way(name: tuple[str, str], readings: "list[Reading]", colour: str, beside: float) -> Line:
    """One colour, drawn at its forces times `beside`."""
    ended = [one for one in readings if one.speed]
    return Line(
        name=f"{name[0]}, {name[1]}",
        x=numbers(beside * max(one.condition.forces) for one in ended),
        y=numbers(100 * abs(one.speed or 0.0) for one in ended),
        colour=colour,
        marker="circle",
        joined=False,
        hollow=tuple((one.speed or 0.0) >= 0 for one in ended),
        said=tuple(_hover(one) for one in ended),
    )


def _hover(reading: "Reading") -> str:
    speed = 100 * (reading.speed or 0.0)
    return f"{speed:+.3g} cm/s; {reading.condition.words}; holds: {met_words(reading)}"
