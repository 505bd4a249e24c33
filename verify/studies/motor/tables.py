"""Tables of a motor: its figures on every field, force over speed, margins, runs from rest."""

from typing import TYPE_CHECKING, Any

import msgspec

from verify.models.catalogue import MODELS
from verify.studies.motor.words import unsettled
from verify.studies.told import Column, Read, Table
from verify.units import time_in_words

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from verify.motor.figures import AtSpeed
    from verify.studies.motor.figures import FieldFound, MotorFound
    from verify.studies.motor.from_rest import FromRest, RestHeld

ROUNDING = 1e-9
"""Share of a way that is none."""


def motor_tables(found: "MotorFound") -> tuple[Table, ...]:
    """All of them."""
    rest = (_rest(found.rest), _rest_curve(found.rest)) if found.rest else ()
    return (_overview(found), _force_speed(found), _margins(found), *rest)


OVERVIEW: tuple[Read, ...] = (
    (Column("field", left=True), lambda one: one.title),
    (Column("crests, cm/s", ".4f", 100.0, wide=True), lambda one: one.crest_speed),
    (Column("no load, cm/s", "+.4f", 100.0), lambda one: one.no_load.speed if one.no_load else None),
    (Column("free, cm/s", "+.4f", 100.0), lambda one: one.free.speed if one.free.settled else None),
    (Column("stall", "+.4f", si="N"), lambda one: one.stall.force if one.stall.settled("force") else None),
    (Column("most power", ".4g", wide=True, si="W"), lambda one: one.most_power),
    (Column("best efficiency", "bare size"), lambda one: one.best_efficiency),
    (Column("touching", "bare size", wide=True), lambda one: one.free.contact_share),
    (Column("sticking", "bare size", wide=True), lambda one: one.free.stuck_share),
    (Column("start", "duration"), lambda one: one.start_time if one.free.goes else None),
    (Column("stop", "duration"), lambda one: one.stop_time if one.free.goes else None),
    (Column("turn", "duration"), lambda one: one.reversal_time if one.free.goes else None),
    (Column("wear", ".4g", wide=True, si="W"), lambda one: one.free.wear_power),
    (Column("dashpots", ".4g", wide=True, si="W"), lambda one: one.free.damped_power),
    (Column("s per s", ".2g", wide=True), lambda one: one.free.run_ms_per_ms),
)
"""Of a `FieldFound`."""
MARGINS: tuple[Read, ...] = (
    (Column("field", left=True), lambda one: one.title),
    (Column("epsilon", ".3g"), lambda one: one.margins.epsilon),
    (Column("sag", ".3g", si="m"), lambda one: one.margins.sag),
    (Column("amplitude", ".4g", si="m"), lambda one: one.amplitude),
    (Column("contact's radians a step", ".2g"), lambda one: one.margins.step),
    (Column("axial inertia", ".1e"), lambda one: one.margins.chain),
    (Column("normal load felt", ".1e"), lambda one: one.coupling.normal_size),
    (Column("friction felt", ".1e"), lambda one: one.coupling.friction_size),
    (Column("free run's halves, cm/s", ".1e", 100.0), lambda one: one.free.spread),
    (Column("shooting missed", ".1e"), lambda one: one.shooting.return_error if one.shooting else None),
    (Column("largest multiplier", ".5f"), lambda one: one.shooting.largest_multiplier if one.shooting else None),
)
"""The same."""
FROM_REST: tuple[Read, ...] = (
    (Column("field", left=True), lambda row: row[0].title),
    (Column("own place", "+.4g", wide=True, si="m"), lambda row: row[0].own(False)),
    (Column("wave turned", "+.4g", wide=True, si="m"), lambda row: row[0].own(True)),
    (Column("apart", "+.3g", si="m"), lambda row: row[1].mean),
    (Column("error", ".2g", si="m"), lambda row: row[1].error),
    (Column("rms", ".3g", si="m"), lambda row: row[1].rms),
    (Column("steps halved", ".2g", wide=True, si="m"), lambda row: row[0].stepped),
    (Column("push", "+.3f"), lambda row: row[0].push[0]),
    (Column("bias", "+.3f"), lambda row: row[0].bias[0]),
    (Column("error", ".2g"), lambda row: row[0].push[1]),
    (Column("steps halved", ".1e", wide=True), lambda row: row[0].push_stepped),
    (Column("drawn in", ".2g", wide=True), lambda row: row[0].drawn),
)
"""Of a `RestField` and its `Departure` from the first."""


def _overview(found: "MotorFound") -> Table:
    return Table.over(
        found.fields,
        OVERVIEW,
        title="The motor on every field",
        before="Held figures are means over periods of a slider kept at its place; free, touching, sticking and wear "
        "are means over the last quarter of a free run.",
        notes=(
            "Start, stop and turn: until 1 - 1/e of the way is made from the slider's own speed, with the drive cut "
            "off at once, with its phases turned round at once: a beam that does not swing on, which a real one does "
            "for its own time. Shares are of contact points and of time, in per "
            "cent. Most power and best efficiency are those of the speeds below. Last column: run time over simulated "
            "time of the free run.",
            *unsettled(found.fields, found.hard),
        ),
        shown="both",
    )


def _force_speed(found: "MotorFound") -> Table:
    """With power and efficiency."""
    shaky = any(not at.settled() for one in found.fields for at in one.curve)
    spread: tuple[Read, ...] = ((Column("+-", ".1g", si="N"), lambda at: at.spread),) if shaky else ()
    return _over_speed(
        [(one.title, one.curve) for one in found.fields],
        lambda title: (
            (Column(title, "+.4f", si="N"), lambda at: at.force),
            *spread,
            (Column("power", "+.4g", wide=True, si="W"), lambda at: at.power if at.settled("force") else None),
            (
                Column("efficiency %", "bare size", wide=True),
                lambda at: at.efficiency if at.settled("force", "powers") else None,
            ),
        ),
        title="Force over speed",
        before="Friction on the slider along +x at speeds up to that of the crests, the way that it pushes; a dash "
        "where the slider drives the surface"
        + (", or where its mean has not settled: how far that may be off stands beside it." if shaky else "."),
    )


def _over_speed(
    curves: "Sequence[tuple[str, Sequence[AtSpeed | RestHeld]]]",
    columns: "Callable[[str], Sequence[Read]]",
    **told: str,
) -> Table:
    """A row for every speed, with these columns of every field, whose title and curve are given."""
    speed: Read = Column("speed, cm/s", "+.4f", 100.0), lambda row: row[0].speed
    others = [(column, _of(field, read)) for field, (title, _) in enumerate(curves) for column, read in columns(title)]
    rows = zip(*(curve for _, curve in curves), strict=True)
    return Table.over(rows, [speed, *others], shown="both", **told)


def _of(field: int, read: "Callable[[Any], Any]") -> "Callable[[Any], Any]":
    """The same of one field in a row of them."""
    return lambda row: read(row[field])


def _margins(found: "MotorFound") -> Table:
    return Table.over(
        found.fields,
        MARGINS,
        title="How far these figures can be believed",
        notes=found.doubts or ("Every margin is small.",),
    )


def _rest(rest: "FromRest") -> Table:
    """Where sliders end on every field."""
    return Table.over(
        ((one, rest.departure(one)) for one in rest.fields),
        FROM_REST,
        title=f"From rest, {time_in_words(rest.seconds)} under {rest.force:g} N",
        before=f"Undamped, forces switched on at once, as a nonlinear chain starts; preload {rest.preload:.3g} N, the "
        f"slider put at {len(rest.places)} places of one wavelength, the wave either way.",
        notes=(
            "Own place: where the slider ends that starts where the scene puts it. Apart: mean, over all "
            "starts, of how much farther along +x it ends than on the first field, with its standard error and its "
            "rms. Steps halved: what that changes, rms. Push and bias: the force on a slider that stands still, over "
            "mu N, that turns round with the wave, and that does not. Drawn in: speed along x of the links under it, "
            "rms over that of the crests.",
        ),
        shown="both",
    )


def _rest_curve(rest: "FromRest") -> Table:
    """Force over speed of all fields from rest."""
    return _over_speed(
        [(one.title, (*reversed(one.curve), *one.turned)) for one in rest.fields],
        lambda title: (
            (Column(title, "+.3f"), lambda at: at.force),
            (Column("error", ".2g", wide=True), lambda at: at.error),
        ),
        title="Force over speed from rest, over mu N",
        before="The same runs, held at each speed and at each place, means over their last half: above with the wave "
        "as the scene says, below with it turned round.",
    )


def at_speed_as_plain(at: "AtSpeed") -> dict[str, Any]:
    """With what follows from it."""
    plain: dict[str, Any] = msgspec.to_builtins(at)
    if at.taken_up < ROUNDING:
        plain["taken_up"] = 0.0
    return plain | {"power": at.power, "efficiency": at.efficiency}


def rest_as_plain(rest: "FromRest") -> dict[str, Any]:
    """For JSON, with what follows from it."""
    plain: dict[str, Any] = msgspec.to_builtins(rest)
    for kept, one in zip(plain["fields"], rest.fields, strict=True):
        (push, error), (bias, _) = one.push, one.bias
        kept |= {
            "push": push,
            "bias": bias,
            "push_standard_deviation": error,
            "apart": msgspec.to_builtins(rest.departure(one)),
        }
    return plain


def field_as_plain(one: "FieldFound") -> dict[str, Any]:
    """For JSON."""
    plain: dict[str, Any] = msgspec.to_builtins(one)
    plain["curve"] = [at_speed_as_plain(at) for at in one.curve]
    plain["no_load"] = at_speed_as_plain(one.no_load) if one.no_load else None
    if one.margins.sag is not None:
        plain["margins"]["sag"] = round(one.margins.sag, 12)  # loads that balance leave rounding
    plain["title"] = MODELS[one.model].title
    return plain
