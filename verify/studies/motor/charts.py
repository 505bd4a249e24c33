"""Charts of a motor: force, power and efficiency over speed, the foot's own motion, shares, starting and stopping."""

from typing import TYPE_CHECKING

from verify.models.catalogue import MODELS
from verify.motor.combine import CHAIN
from verify.studies.chart import Axis, Chart, Dash, Line
from verify.studies.charting import BROAD, DASHES, PALETTE, in_units, key, line, plain_line
from verify.studies.motor.movie import motor_movie
from verify.units import in_words, unit_of, unit_over

if TYPE_CHECKING:
    from collections.abc import Callable

    from verify.motor.figures import AtSpeed
    from verify.studies.motor.figures import FieldFound, History, MotorFound
    from verify.studies.motor.from_rest import RestField

CHAINS = {"rigid": PALETTE[1], "stretching": PALETTE[2]}
"""Colours of nonlinear chains by their links."""
KINDS: dict[str, tuple[str, Dash]] = {
    "start": ("started", "solid"),
    "stop": ("drive cut off", "dot"),
    "reversal": ("phases turned round", "dash"),
}
UNSETTLED = " Left out where its mean has not settled; the table has it, with how far it may be off."
SHARES: dict[str, tuple[str, Dash]] = {"contact": ("touching", "solid"), "stuck": ("sticking", "dot")}


def motor_charts(found: "MotorFound") -> tuple[Chart, ...]:
    """The contact line first, then what it does; no curve over speed where no mean has settled."""
    return (
        *motor_movie(found),
        *(chart for chart in (_force(found), _power(found), _efficiency(found)) if not chart.empty),
        _portrait(found),
        _over_time(found, "motor-shares", SHARES),
        _over_time(found, "motor-way", KINDS),
        *_rest(found),
    )


def _width(model: str) -> float:
    return 1.6 if MODELS[model].sized else BROAD


def _curves(found: "MotorFound", read: "Callable[[AtSpeed], float | None]") -> tuple[Line, ...]:
    """Over speed, one of each field, those without parts broad and first."""
    order = sorted(found.fields, key=lambda one: MODELS[one.model].sized)
    return tuple(
        plain_line(
            one.title,
            MODELS[one.model].colour,
            [100.0 * at.speed for at in one.curve],
            [read(at) for at in one.curve],
            width=_width(one.model),
        )
        for one in order
    )


def _efficient(at: "AtSpeed") -> float | None:
    """Per cent; None where the slider drives the surface, or has not settled."""
    told = at.efficiency is not None and at.settled("force", "powers")
    return 100.0 * (at.efficiency or 0.0) if told else None


def _force(found: "MotorFound") -> Chart:
    limit = found.mu * found.fields[0].stall.normal_force
    unit = unit_of(limit, "N")
    speeds = [100.0 * at.speed for at in found.fields[0].curve]
    way = -1.0 if found.fields[0].stall.force < 0.0 else 1.0
    guide = plain_line("mu N", "#8a8f98", speeds, [way * unit.factor * limit] * len(speeds), dash="dash", guide=True)
    shaky = "" if all(at.settled("force") for one in found.fields for at in one.curve) else UNSETTLED
    return Chart(
        id="motor-force",
        title="Force over speed",
        caption="Friction on the slider along +x, held at each speed and kept at its place, means over periods. "
        f"Dashed: mu N = {in_words(limit, 'N')}, all points slipping one way.{shaky}",
        x=Axis("speed, cm/s"),
        y=Axis(f"force, {unit.name}"),
        lines=(guide, *_curves(found, lambda at: unit.factor * at.force if at.settled("force") else None)),
    )


def _power(found: "MotorFound") -> Chart:
    unit = unit_over((at.power for one in found.fields for at in one.curve), "W")
    return Chart(
        id="motor-power",
        title="Power over speed",
        caption="Force times speed: what the motor gives to a load at that speed. Below nought the load drives it.",
        x=Axis("speed, cm/s"),
        y=Axis(f"power, {unit.name}"),
        lines=_curves(found, lambda at: unit.factor * at.power if at.settled("force") else None),
    )


def _efficiency(found: "MotorFound") -> Chart:
    return Chart(
        id="motor-efficiency",
        title="Efficiency of the contact over speed",
        caption="That power over what the surface gives along the beam; the rest is rubbed off. What the contact's "
        "dashpots take across it, and what the wave loses at its ends, is not in it.",
        x=Axis("speed, cm/s"),
        y=Axis("efficiency, %"),
        lines=_curves(found, _efficient),
    )


def _of_kind(found: "MotorFound", kind: str) -> "list[tuple[FieldFound, History]]":
    """Fields that have it, those without parts first."""
    kept = found.drawn.histories[kind]
    order = sorted(found.fields, key=lambda one: MODELS[one.model].sized)
    return [(one, kept[one.model]) for one in order if one.model in kept]


def _portrait(found: "MotorFound") -> Chart:
    up = unit_over(z for _, kept in _of_kind(found, "portrait") for z in kept.x)
    return Chart(
        id="motor-portrait",
        title="The first foot across the beam: its rate over its height",
        caption="After the free run, over forty periods of the drive, about the mean of each. A motion that repeats "
        "itself is a closed loop; one that bounces without a pattern fills a patch.",
        x=Axis(f"height from its mean, {up.name}"),
        y=Axis("rate, mm/s"),
        lines=tuple(
            plain_line(
                one.title,
                MODELS[one.model].colour,
                [up.factor * z for z in kept.x],
                [1e3 * v for v in kept.y],
                width=_width(one.model),
            )
            for one, kept in _of_kind(found, "portrait")
        ),
    )


_TOLD = {
    "motor-shares": (
        "Shares of contact over time",
        "Of contact points and of each period, from where the slider is put down: how many touch, and how many stick.",
        "share, %",
        1.0,
    ),
    "motor-way": (
        "Starting, stopping, turning round",
        "Speed at the end of every period: from the slider's own speed; with the drive cut off at once; with all its "
        "phases turned round at once. The beam's field ends or turns with its drive: that it would ring is left out.",
        "speed, cm/s",
        1.0,
    ),
}


def _over_time(found: "MotorFound", name: str, kinds: dict[str, tuple[str, Dash]]) -> Chart:
    """Fields by colour, kinds by dash."""
    title, caption, axis, _ = _TOLD[name]
    time = unit_over((t for kind in kinds for _, kept in _of_kind(found, kind) for t in kept.x), "s")
    fields = {one.model: one for kind in kinds for one, _ in _of_kind(found, kind)}
    lines = [
        plain_line(
            one.title,
            MODELS[one.model].colour,
            [time.factor * t for t in kept.x],
            [100.0 * v for v in kept.y],
            dash=dash,
            width=_width(one.model) if dash == DASHES[0] else 1.6,
            group=one.title,
            keyed=kind == next(iter(kinds)),
        )
        for kind, (_, dash) in kinds.items()
        for one, kept in _of_kind(found, kind)
    ]
    keys = [key(words, dash=dash) for kind, (words, dash) in kinds.items() if _of_kind(found, kind)]
    return Chart(
        id=name,
        title=title,
        caption=caption,
        x=Axis(f"time, {time.name}"),
        y=Axis(axis),
        lines=(*lines, *(keys if fields else ())),
    )


def _rest(found: "MotorFound") -> tuple[Chart, ...]:
    """The slider's way on every field from rest."""
    rest = found.rest
    if rest is None:
        return ()
    time, way = unit_of(rest.seconds, "s"), unit_over(x for run in rest.fields for x in run.way)
    order = sorted(rest.fields, key=lambda one: one.model != CHAIN and MODELS[one.model].sized)
    own, turned = ("left", "right") if rest.fields[0].curve[-1].speed < 0.0 else ("right", "left")
    return (
        Chart(
            id="motor-rest",
            title=f"From rest: the slider's way at {rest.force:g} N",
            caption="From its own place, undamped, forces switched on at once, which is how a nonlinear chain starts: "
            f"the wave never settles. (kL)² ⟨θ²⟩ = {rest.size:.2g} of the drive's own motion.",
            x=Axis(f"time, {time.name}"),
            y=Axis(f"distance, {way.name}"),
            lines=tuple(in_units(_way(run), time, way) for run in order),
        ),
        Chart(
            id="motor-rest-force",
            title=f"From rest: force over speed at {rest.force:g} N",
            caption="Means over the last half of those runs and over all places, over mu N. "
            f"On the {own} the wave as the scene says, on the {turned} turned round. A motor that pushes with its wave "
            "is below nought on one side of standing still and above it on the other.",
            x=Axis("speed, cm/s"),
            y=Axis("force over mu N"),
            lines=tuple(line for one in order for line in _held_lines(one)),
        ),
    )


def _held_lines(one: "RestField") -> tuple[Line, ...]:
    chain = one.model == CHAIN
    return tuple(
        line(
            one.title,
            CHAINS[one.links] if chain else MODELS[one.model].colour,
            [100.0 * at.speed for at in curve],
            [at.force for at in curve],
            dash="dash" if chain else "solid",
            said=tuple(f"{at.force:+.3f} ± {at.error:.2g}" for at in curve),
            keyed=not k,
            group=one.title,
        )
        for k, curve in enumerate((one.curve, one.turned))
    )


def _way(run: "RestField") -> Line:
    chain = run.model == CHAIN
    return plain_line(
        run.title,
        CHAINS[run.links] if chain else MODELS[run.model].colour,
        run.times,
        run.way,
        width=1.6 if chain or MODELS[run.model].sized else BROAD,
        dash="dash" if chain else "solid",
    )
