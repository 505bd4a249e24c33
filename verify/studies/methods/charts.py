"""Charts of both ways of driving."""

from typing import TYPE_CHECKING

from verify.studies.chart import Axis, Chart, Dash, Line, Mark
from verify.studies.charting import GREY, MEAN_COLOUR, PALETTE, in_units, plain_line, unbroken
from verify.studies.charting import line as dotted
from verify.studies.methods.seen import WAYS, WORDS
from verify.units import unit_of, unit_over

if TYPE_CHECKING:
    from verify.studies.methods.figures import MethodsFound
    from verify.studies.methods.seen import Seen, Way

COLOURS: "dict[Way, str]" = {"device": "#2f80ed", "forces": "#e8760c"}
LUMPED = PALETTE[1]
MOST = 20.0
"""The largest local standing-wave ratio that is drawn; larger ones are left out."""


def methods_charts(found: "MethodsFound") -> tuple[Chart, ...]:
    """Over frequency, detuning and load, along the beam."""
    return _frequency(found), _amplitude(found), _detuning(found), _load(found), _along(found), _envelopes(found)


def _said(found: "MethodsFound") -> str:
    return f"{found.damping.capitalize()}, exact field, equal forces of {found.force:g} N. "


def _frequency(found: "MethodsFound") -> Chart:
    x = [found.hertz + row.value for row in found.frequencies]
    return Chart(
        id="methods-frequency",
        title="Reflection over frequency, nothing retuned",
        caption=_said(found) + "The device keeps its dashpot, spring and mass, the second force its phase. "
        f"With two forces the beam keeps its resonances, where the wave stands. Read at {found.at(found.read_at)}: "
        "with losses reflection hangs on the place.",
        x=Axis("frequency, Hz"),
        y=Axis("reflection"),
        lines=tuple(
            plain_line(
                WORDS[way], COLOURS[way], x, [one.reflection if one else None for one in _all(found, way)], width=2.0
            )
            for way in WAYS
        ),
        marks=_marks(found),
    )


def _amplitude(found: "MethodsFound") -> Chart:
    up = unit_over(one.amplitude for way in WAYS for one in _all(found, way) if one)
    x = [found.hertz + row.value for row in found.frequencies]
    return Chart(
        id="methods-amplitude",
        title="Amplitude of the stronger wave over frequency",
        caption=_said(found) + "Where two forces meet a resonance the wave grows and stands.",
        x=Axis("frequency, Hz"),
        y=Axis(f"amplitude, {up.name}", log=True),
        lines=tuple(
            plain_line(
                WORDS[way],
                COLOURS[way],
                x,
                [up.factor * one.amplitude if one else None for one in _all(found, way)],
                width=2.0,
            )
            for way in WAYS
        ),
        marks=_marks(found),
    )


def _marks(found: "MethodsFound") -> tuple[Mark, ...]:
    """The drive, and the bare beam's resonances in the span."""
    resonances = [one for one in found.resonances if abs(one[1] - found.hertz) <= found.span_hz]
    return Mark(found.hertz, "drive", GREY), *(Mark(hertz, f"mode {mode}", GREY) for mode, hertz in resonances)


def _all(found: "MethodsFound", way: "Way") -> "list[Seen | None]":
    return [getattr(row, way) for row in found.frequencies]


def _detuning(found: "MethodsFound") -> Chart:
    s = [row.factor for row in found.detuned]
    law = plain_line("|s - 1|/(s + 1)", GREY, s, [abs(f - 1.0) / (f + 1.0) for f in s], width=4.0, guide=True)
    each: tuple[tuple[str, str, list[float | None], Dash], ...] = (
        ("dashpot of the device", COLOURS["device"], [row.dashpot for row in found.detuned], "solid"),
        ("its spring and mass", MEAN_COLOUR, [row.reactance for row in found.detuned], "dash"),
        ("second force", COLOURS["forces"], [row.force for row in found.detuned], "solid"),
    )
    lines = tuple(
        dotted(name, colour, s, y, dash=dash) for name, colour, y, dash in each if any(v is not None for v in y)
    )
    return Chart(
        id="methods-detuning",
        title="Reflection where one thing is off by a factor",
        caption=_said(found)
        + f"At {found.hertz:g} Hz. Grey: {unbroken('|s - 1|/(s + 1)')}, what a matched device leaves whose "
        "dashpot is off by s.",
        x=Axis("factor s", log=True, ticks=tuple(f for f in s if f in (0.25, 0.5, 1.0, 2.0, 4.0))),
        y=Axis("reflection"),
        lines=(law, *lines),
    )


def _along(found: "MethodsFound") -> Chart:
    unit = unit_of(found.along.everywhere[-1])
    x = [unit.factor * v for v in found.along.x]
    first, second = found.along.modes

    def drawn(values: tuple[float, ...]) -> list[float | None]:
        return [v if v <= MOST else None for v in values]

    fields = [
        plain_line(f"field, {WORDS[way]}", COLOURS[way], x, drawn(found.along.ratios[way]), width=2.0) for way in WAYS
    ]
    lumped = plain_line(
        f"modes {first} and {second} in quadrature", LUMPED, x, drawn(found.along.lumped), width=2.0, dash="dash"
    )
    return Chart(
        id="methods-along",
        title="Local standing-wave ratio along the beam",
        caption=f"{found.damping.capitalize()}, at {found.hertz:g} Hz, between force and device. The lumped picture "
        f"has two modes alone and knows no actuator. Ratios above {MOST:g} are not drawn.",
        x=Axis(f"x, {unit.name}"),
        y=Axis("standing-wave ratio", log=True, ticks=(1.0, 2.0, 5.0, 10.0, 20.0)),
        lines=(*fields, lumped),
    )


def _load(found: "MethodsFound") -> Chart:
    unit = unit_over((1e3 * row.value for row in found.masses), "g")
    masses = [1e3 * unit.factor * row.value for row in found.masses]
    lines: list[Line] = []
    for way in WAYS:
        rows = [getattr(row, way) for row in found.masses]
        for name, of, dash in (("before it", "reflection", "solid"), ("behind it", "behind", "dot")):
            values = [getattr(one, of) if one else None for one in rows]
            lines.append(dotted(f"{WORDS[way]}, {name}", COLOURS[way], masses, values, dash=dash))
    return Chart(
        id="methods-load",
        title="Reflection under a mass that rides on the beam",
        caption=_said(found)
        + f"At {found.hertz:g} Hz, the mass at {found.at(found.load_position)}; before it is towards "
        "the force.",
        x=Axis(f"mass, {unit.name}", log=True),
        y=Axis("reflection"),
        lines=tuple(lines),
    )


def _envelopes(found: "MethodsFound") -> Chart:
    unit = unit_of(found.along.everywhere[-1])
    up = unit_over(v for values in found.along.amplitudes.values() for v in values)
    x, widths = found.along.everywhere, {"device": 2.0, "forces": 1.6}
    return Chart(
        id="methods-envelopes",
        title="Envelope of the wave, both ways",
        caption=_said(found) + f"At {found.hertz:g} Hz. A pure travelling wave has a flat envelope.",
        x=Axis(f"x, {unit.name}"),
        y=Axis(f"amplitude, {up.name}"),
        lines=tuple(
            in_units(plain_line(WORDS[way], COLOURS[way], x, found.along.amplitudes[way], width=widths[way]), unit, up)
            for way in WAYS
        ),
    )
