"""Tables of a motor: its figures on every field, force over speed, margins, runs from rest."""

from typing import TYPE_CHECKING, Any

import msgspec

from verify.models.catalogue import MODELS
from verify.studies.told import Column, Table

if TYPE_CHECKING:
    from verify.motor.figures import AtSpeed
    from verify.studies.motor_figures import FieldFound, MotorFound
    from verify.studies.motor_rest import Departure, FromRest, RestField


def motor_tables(found: "MotorFound") -> tuple[Table, ...]:
    """All of them."""
    rest = (_rest(found.rest), _rest_curve(found.rest)) if found.rest else ()
    return (_overview(found), _force_speed(found), _margins(found), *rest)


def _overview(found: "MotorFound") -> Table:
    columns = (
        Column("field", left=True),
        Column("crests, cm/s", ".4f", 100.0, wide=True),
        Column("no load, cm/s", "+.4f", 100.0),
        Column("free, cm/s", "+.4f", 100.0),
        Column("stall, mN", "+.4f", 1e3),
        Column("most power, mW", ".4g", 1e3, wide=True),
        Column("best efficiency", "bare size"),
        Column("touching", "bare size", wide=True),
        Column("sticking", "bare size", wide=True),
        Column("start", "duration"),
        Column("stop", "duration"),
        Column("turn", "duration"),
        Column("wear, mW", ".4g", 1e3, wide=True),
        Column("dashpots, mW", ".4g", 1e3, wide=True),
        Column("s per s", ".2g", wide=True),
    )
    return Table(
        title="The motor on every field",
        before="Held figures are means over periods of a slider kept at its place; free, touching, sticking and wear "
        "are means over the last quarter of a free run.",
        columns=columns,
        rows=tuple(_of_field(one) for one in found.fields),
        notes=(
            "Start, stop and turn: until 1 - 1/e of the way is made from the slider's own speed, with the drive cut "
            "off at once, with its phases turned round at once. Shares are of contact points and of time, in per "
            "cent. Most power and best efficiency are those of the speeds below. Last column: run time over simulated "
            "time of the free run.",
        ),
        shown="both",
    )


def _of_field(one: "FieldFound") -> tuple[Any, ...]:
    free = one.free
    return (
        one.title,
        one.crest_speed,
        one.no_load.speed if one.no_load else None,
        free.speed,
        one.stall.force,
        one.most_power.power,
        one.best_efficiency,
        free.contact_share,
        free.stuck_share,
        one.start_time,
        one.stop_time,
        one.reversal_time,
        free.wear_power,
        free.damped_power,
        free.run_ms_per_ms,
    )


def _force_speed(found: "MotorFound") -> Table:
    """A row for every speed, with force, power and efficiency of every field."""
    columns = [Column("speed, cm/s", "+.4f", 100.0)]
    for one in found.fields:
        columns += [
            Column(f"{one.title}, mN", "+.4f", 1e3),
            Column("power, mW", "+.4g", 1e3, wide=True),
            Column("efficiency %", "bare size", wide=True),
        ]
    rows = []
    for k, at in enumerate(found.fields[0].curve):
        cells: list[float | None] = [at.speed]
        for one in found.fields:
            cells += [one.curve[k].force, one.curve[k].power, one.curve[k].efficiency]
        rows.append(tuple(cells))
    return Table(
        title="Force over speed",
        before="Friction on the slider along +x at speeds up to that of the crests, the way that it pushes; a dash "
        "where the slider drives the surface.",
        columns=tuple(columns),
        rows=tuple(rows),
        shown="both",
    )


def _margins(found: "MotorFound") -> Table:
    return Table(
        title="How far these figures can be believed",
        columns=(
            Column("field", left=True),
            Column("epsilon", ".3g"),
            Column("sag, µm", ".3g", 1e6),
            Column("amplitude, µm", ".4g", 1e6),
            Column("contact's radians a step", ".2g"),
            Column("axial inertia", ".1e"),
            Column("normal load felt", ".1e"),
            Column("friction felt", ".1e"),
            Column("free run's halves, cm/s", ".1e", 100.0),
            Column("shooting missed", ".1e"),
            Column("largest multiplier", ".5f"),
        ),
        rows=tuple(
            (
                one.title,
                one.margins.epsilon,
                one.margins.sag,
                one.amplitude,
                one.margins.step,
                one.margins.chain,
                one.coupling.normal_size,
                one.coupling.friction_size,
                one.free.spread,
                one.shooting.return_error if one.shooting else None,
                one.shooting.largest_multiplier if one.shooting else None,
            )
            for one in found.fields
        ),
        notes=found.doubts or ("Every margin is small.",),
    )


def _rest(rest: "FromRest") -> Table:
    """Where sliders end on every field."""
    gone = [rest.departure(one) for one in rest.fields]
    return Table(
        title=f"From rest, {1e3 * rest.seconds:g} ms under {rest.force:g} N",
        before=f"Undamped, forces switched on at once, as a nonlinear chain starts; preload {rest.preload:.3g} N, the "
        f"slider put at {len(rest.places)} places of one wavelength, the wave either way.",
        columns=(
            Column("field", left=True),
            Column("own place, µm", "+.4g", 1e6, wide=True),
            Column("wave turned, µm", "+.4g", 1e6, wide=True),
            Column("apart, µm", "+.3g", 1e6),
            Column("error, µm", ".2g", 1e6),
            Column("rms, µm", ".3g", 1e6),
            Column("steps halved, µm", ".2g", 1e6, wide=True),
            Column("push", "+.3f"),
            Column("bias", "+.3f"),
            Column("error", ".2g"),
            Column("steps halved", ".1e", wide=True),
        ),
        rows=tuple(
            (*_ends(one, away), one.push[0], one.bias[0], one.push[1], one.push_stepped)
            for one, away in zip(rest.fields, gone, strict=True)
        ),
        notes=(
            "Own place: where the slider ends that starts where the scene puts it. Apart: mean, over all "
            "starts, of how much farther along +x it ends than on the first field, with its standard error and its "
            "rms. Steps halved: what that changes, rms. Push and bias: the force on a slider that stands still, over "
            "mu N, that turns round with the wave, and that does not.",
        ),
        shown="both",
    )


def _ends(one: "RestField", away: "Departure") -> tuple[Any, ...]:
    return one.title, one.own(False), one.own(True), away.mean, away.error, away.rms, one.stepped


def _rest_curve(rest: "FromRest") -> Table:
    """Force over speed of all fields from rest."""
    columns = [Column("speed, cm/s", "+.4f", 100.0)]
    for one in rest.fields:
        columns += [Column(one.title, "+.3f"), Column("error", ".2g", wide=True)]
    rows = []
    for k in range(-len(rest.fields[0].curve), len(rest.fields[0].turned)):
        cells: list[float] = []
        for one in rest.fields:
            at = one.curve[-1 - k] if k < 0 else one.turned[k]
            cells += [at.speed] * (not cells) + [at.force, at.error]
        rows.append(tuple(cells))
    return Table(
        title="Force over speed from rest, over mu N",
        before="The same runs, held at each speed and at each place, means over their last half: above with the wave "
        "as the scene says, below with it turned round.",
        columns=tuple(columns),
        rows=tuple(rows),
        shown="both",
    )


def at_speed_as_plain(at: "AtSpeed") -> dict[str, Any]:
    """With what follows from it."""
    plain: dict[str, Any] = msgspec.to_builtins(at)
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
    plain["margins"]["sag"] = round(one.margins.sag, 12)  # loads that balance leave rounding
    plain["title"] = MODELS[one.model].title
    return plain
