"""Both ways of driving in words and tables: each sentence under the condition that it was computed for."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from verify.studies.methods.seen import WAYS, WORDS, model_title, worst
from verify.studies.told import Column, Table
from verify.units import in_words, unit_of

if TYPE_CHECKING:
    from verify.studies.methods.figures import MethodsFound


def condition(found: "MethodsFound") -> str:
    """What every figure is of."""
    first, second = (found.at(place) for place in found.places)
    return (
        f"exact beam, {found.damping}, {found.force:g} N from each actuator, force at {first}, device or second "
        f"force ({found.phase_deg:g}°) at {second}"
    )


def short(found: "MethodsFound") -> str:
    """Both at the drive and off it, in one sentence."""
    driven, *off = found.edges
    if not (driven.device and driven.forces):
        return ""
    device, forces = driven.device.reflection, driven.forces.reflection
    at = (
        f"The reflection at {found.hertz:g} Hz, read at {found.at(found.read_at)}, is {device:.2g} with the device "
        f"and {forces:.2g} with two forces"
    )
    sides = [
        f"{row.what} it is {row.device.reflection:.2g} and {row.forces.reflection:.2g}"
        for row in off
        if row.device and row.forces
    ]
    return f"{at}; with nothing retuned, {', '.join(sides)}." if sides else f"{at}."


def facts(found: "MethodsFound") -> tuple[str, ...]:
    """Each with the condition that it was computed for."""
    return tuple(fact for say in (_frequency, _power, _detuning, _load, _lumped, _rides) for fact in say(found))


def _frequency(found: "MethodsFound") -> Iterator[str]:
    """Which way bears the span better, where one does."""
    device, forces = (worst(found.frequencies, way) for way in WAYS)
    n, span = len(found.frequencies), f"within {found.span_hz:g} Hz of {found.hertz:g} Hz"
    span = f"{span}, {n} frequencies, {found.damping}, read at {found.at(found.read_at)}, nothing retuned"
    if device is None or forces is None:
        yield f"{span}: a frequency is a resonance of the undamped beam under two forces, where nothing is compared"
        return
    figures = f"the largest reflection is {device:.3g} with the device and {forces:.3g} with two forces"
    yield f"{span}: {figures}" + _better(device, forces)
    (lower, below), (upper, above) = found.resonances
    if below <= found.hertz <= above:
        yield (
            f"two forces leave the beam its resonances: {found.hertz:g} Hz lies between mode {lower} at {below:.5g} Hz "
            f"and mode {upper} at {above:.5g} Hz"
        )


def _better(device: float, forces: float, does: str = "bears a change of frequency better") -> str:
    if abs(device - forces) <= 0.1 * max(device, forces):
        return ", which tells neither from the other"
    return f", so that the way with {'the device' if device < forces else 'two forces'} {does}"


def _power(found: "MethodsFound") -> Iterator[str]:
    driven = found.edges[0]
    if driven.device and driven.forces:
        one, (first, second) = driven.device, driven.forces.given
        yield (
            f"at {found.hertz:g} Hz with {found.force:g} N: the force beside the device gives "
            f"{_watts(one.given[0])}, of which the device takes {_watts(one.absorbed)}; of two forces the first gives "
            f"{_watts(first)} and the second {_watts(second)}; the waves are {in_words(one.amplitude, form='.4g')} "
            f"and {in_words(driven.forces.amplitude, form='.4g')}"
        )


def _watts(power: float) -> str:
    return in_words(power, "W", ".4g")


def _detuning(found: "MethodsFound") -> Iterator[str]:
    for row in found.detuned:
        left = [
            f"{value:.3g} ({what})"
            for what, value in (
                ("the device's dashpot", row.dashpot),
                ("its spring and mass", row.reactance),
                ("the second force", row.force),
            )
            if value is not None
        ]
        if row.factor == 2.0:
            yield f"at {found.hertz:g} Hz, one thing twice what it was: the reflection is {', '.join(left)}"


def _load(found: "MethodsFound") -> Iterator[str]:
    """Of the heaviest mass; which way reflects less before it, where one does."""
    heaviest = found.masses[-1]
    device, forces = heaviest.device, heaviest.forces
    if device and forces:
        at = f"{found.at(found.load_position)}, at {found.hertz:g} Hz, {found.damping}"
        yield (
            f"with {heaviest.what} on the beam at {at}: behind it the reflection is {device.behind:.3g} with the "
            f"device and {forces.behind:.3g} with two forces, "
            f"before it {device.reflection:.3g} and {forces.reflection:.3g}"
            + _better(device.reflection, forces.reflection, "sends less back there")
        )


def _lumped(found: "MethodsFound") -> Iterator[str]:
    if found.picture:
        first, second = found.along.modes
        at = ", ".join(f"{lumped:.4g} at {found.at(x)}" for x, lumped, _ in found.picture)
        fields = [field for *_, field in found.picture]
        yield (
            f"modes {first} and {second} alone, equal and a quarter of a period apart, have a local standing-wave "
            f"ratio of {at}, whatever drives them; the field of two forces at {found.hertz:g} Hz, {found.damping}, has "
            f"{min(fields):.4g}" + (f" to {max(fields):.4g}" if max(fields) > 1.001 * min(fields) else "") + " there"
        )


def _rides(found: "MethodsFound") -> Iterator[str]:
    for ride in found.rides:
        if ride.off_hz == 0.0 and ride.device is not None and ride.forces is not None:
            yield (
                f"at {found.hertz:g} Hz and {found.force:g} N the slider's mean speed is {1e6 * ride.device:.4g} µm/s "
                f"with the device and {1e6 * ride.forces:.4g} µm/s with two forces ({found.slider})"
            )


def tables(found: "MethodsFound") -> tuple[Table, ...]:
    """Side by side; under load and detuned; by each model; the lumped picture."""
    return tuple(table for table in (_beside(found), _off(found), _models(found), _picture(found)) if table.rows)


def _beside(found: "MethodsFound") -> Table:
    rides = {ride.off_hz: ride for ride in found.rides}
    rows = []
    for row in found.edges:
        for way in WAYS:
            seen, ride = getattr(row, way), rides.get(row.value)
            powers = (seen.given[0], seen.given[1] if way == "forces" else -seen.absorbed) if seen else (None, None)
            figures = (seen.reflection, seen.amplitude) if seen else (None, None)
            way_on = ("onwards" if seen.runs_on else "back") if seen else None
            speed = (getattr(ride, way) if ride else None,) if found.rides else ()
            rows.append((row.what, WORDS[way], way_on, *figures, *powers, *speed))
    return Table.of(
        (
            Column("condition", left=True),
            Column("way", left=True),
            Column("runs", left=True),
            Column("reflection", ".3g"),
            Column("wave", ".4g", si="m"),
            Column("force", "+.4g", si="W"),
            Column("other", "+.4g", si="W"),
            *((Column("slider, µm/s", "+.4g", 1e6),) if found.rides else ()),
        ),
        tuple(rows),
        title="Two ways of driving, side by side",
        notes=(
            f"E{condition(found)[1:]}; reflections and waves are read at {found.at(found.read_at)}: with losses they "
            "hang on the place. Nothing is retuned. Power into the beam: of the force, and of device or second "
            "force.",
            *([f"Slider {found.slider}."] if found.slider else []),
        ),
        shown="both",
    )


def _off(found: "MethodsFound") -> Table:
    rows: list[tuple[str, str, float | None, float | None]] = []
    for load in (*found.masses, *found.dashpots):
        for way in WAYS:
            seen = getattr(load, way)
            rows.append(
                (f"load of {load.what}", WORDS[way], *((seen.reflection, seen.behind) if seen else (None, None)))
            )
    for one in found.detuned:
        for what, way, left in (
            ("dashpot", WAYS[0], one.dashpot),
            ("spring and mass", WAYS[0], one.reactance),
            ("second force", WAYS[1], one.force),
        ):
            if left is not None:
                rows.append((f"{what} times {one.factor:g}", WORDS[way], left, left))
    return Table(
        title="Loaded and detuned",
        columns=(
            Column("condition", left=True),
            Column("way", left=True),
            Column("reflection before", ".3g"),
            Column("behind", ".3g"),
        ),
        rows=tuple(rows),
        notes=(
            f"At {found.hertz:g} Hz, {condition(found)}; loads at {found.at(found.load_position)}, read halfway to "
            "the force and to the device. One thing is changed in each row.",
        ),
        folded=True,
    )


def _models(found: "MethodsFound") -> Table:
    return Table(
        title="Both on every model",
        columns=(Column("model", left=True), *(Column(f"SWR, {WORDS[way]}", ".5f") for way in WAYS)),
        rows=tuple((model_title(row.model, row.count), row.device, row.forces) for row in found.models),
        notes=(f"Standing-wave ratio in the window [L/4, 3L/4] at {found.hertz:g} Hz, {found.damping}.",),
    )


def _picture(found: "MethodsFound") -> Table:
    along = unit_of(found.along.everywhere[-1])
    first, second = found.along.modes
    return Table(
        title="The lumped picture of the wave",
        columns=(
            Column(f"x, {along.name}", ".4g", along.factor),
            Column(f"modes {first} and {second} in quadrature", ".4f"),
            Column("field of two forces", ".4f"),
        ),
        rows=found.picture,
        notes=(
            f"Local standing-wave ratio. The picture has two modes, equal and 90° apart, and knows no actuator; the "
            f"field is the exact one at {found.hertz:g} Hz, {found.damping}.",
        ),
    )
