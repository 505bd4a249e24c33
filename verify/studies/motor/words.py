"""What a motor's figures say in sentences, and which of them are withheld."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from verify.motion.contact import FELT
from verify.motion.validity import NONLINEAR
from verify.motor.settling import BLOCK
from verify.units import in_words
from verify.words import seconds_in_words

if TYPE_CHECKING:
    from verify.motor.figures import AtSpeed
    from verify.slider import Slider
    from verify.studies.motor.figures import FieldFound, MotorFound

SAGS = 0.1
"""Of the amplitude under the slider: a static deflection that is felt."""
MORE = 0.05
"""Of what presses at rest: by so much more feet press in a run before it is told."""
STAYS = 0.9
"""Of points and time that touch: feet that rise and fall with the surface."""
COARSE = 1e-3
"""Relative error of a swing on the springs, which steps leave."""
SETTLED = 0.01
"""Relative: a free run whose speed is so near that without force has come to its end."""
SAME = 1e-9
"""Relative: figures so near each other are told as one, whatever blocks differ by."""
NU = 0.4
LAYER = 2.0 * (1.0 - NU) / (1.0 - 2.0 * NU)
"""Stiffness of a confined layer of that Poisson's ratio, across over along."""


def in_short_of(found: "MotorFound") -> str:
    """Speed without load and stall force on the first field; both ways to the speed where they lie apart."""
    one = found.fields[0]
    speed, held = one.free.speed, one.no_load.speed if one.no_load else one.free.speed
    runs = f"runs at {100 * speed:+.4g} cm/s without load"
    if not one.free.settled:
        runs = "does not come to a speed in its free run"
    elif not one.free.goes:
        runs = f"comes to no speed beyond {_small(one)}, by which halves of its free run differ,"
    elif abs(held - speed) > SETTLED * abs(held):
        runs = (
            f"is at {100 * speed:+.4g} cm/s at the end of its free run, without force at {100 * held:+.4g} cm/s held,"
        )
    if not one.stall.settled("force"):
        does = "bounces so that" if one.stall.bounces else "stays on the surface, but"
        return f"The motor {runs} and {does} its force standing still has not settled, on the {one.title}."
    return f"The motor {runs} and pushes with {_pushes(one)} standing still, on the {one.title}."


def _pushes(one: "FieldFound") -> str:
    """The force standing still; both where another motion repeats itself as well."""
    held = in_words(one.stall.force, "N", "+.4g")
    if one.shooting is None or abs(one.shooting.force - one.stall.force) <= max(
        one.stall.spread, SETTLED * abs(one.stall.force)
    ):
        return held
    return f"{held} or, by how it began, with {in_words(one.shooting.force, 'N', '+.4g')}"


def facts_of(found: "MotorFound") -> tuple[str, ...]:
    """Speeds, forces, times, agreement of ways to the same figure, cost."""
    from verify.studies.motor.from_rest import what_stands

    told = [line for one in found.fields for line in _of_field(one)]
    rest = tuple(what_stands(found.rest)) if found.rest else ()
    return (*told, *rest, *_fields_agree(found.fields), *found.doubts)


def _of_field(one: "FieldFound") -> Iterator[str]:
    where = f"on the {one.title}"
    free = one.free
    if free.stopped != "end":
        yield f"free run {where}: the slider {free.stopped} before its end"
    yield f"speed without load {where}: {_two_ways(one)}"
    yield f"standing still {where}: {_stall(one)}"
    times = {"start": one.start_time, "stop": one.stop_time, "turning round": one.reversal_time}
    at_once = ", of a beam that is still or turned round at once" if one.stop_time or one.reversal_time else ""
    words = ", ".join(f"{name} {seconds_in_words(value)}" for name, value in times.items() if value is not None)
    none = "none, the speed is not reached within the run" if free.goes else "withheld, it comes to no speed"
    none += f" beyond {_small(one)}" if free.settled and not free.goes else ""
    yield f"time constants {where}: {words + at_once if words and free.goes else none}"
    yield f"one second of motor {where}: {free.run_ms_per_ms:.2g} s of run time"


def _two_ways(one: "FieldFound") -> str:
    """Held and free, with what tells them apart."""
    free = f"{100 * one.free.speed:+.5g} cm/s in the free run (its last quarter's halves differ by {_small(one)})"
    if one.no_load is None:
        if all(at.settled("force") for at in one.curve):
            return f"{free}; none of the held speeds is without force"
        return f"{free}; which held speed is without force is withheld, forces have not settled"
    apart = abs(one.no_load.speed - one.free.speed)
    spread = one.free.spread
    meant = (
        f"they differ by {apart / abs(one.free.speed):.2g} of it, more than that"
        if apart > spread
        else "whether they differ is withheld, the spread is larger"
    )
    return f"{free}, {100 * one.no_load.speed:+.5g} cm/s held at its place: {meant}"


def _small(one: "FieldFound") -> str:
    return f"{100 * one.free.spread:.1g} cm/s"


def _stall(one: "FieldFound") -> str:
    held = _held_still(one.stall)
    if one.shooting is None:
        return f"{held}; no motion that repeats itself after a period was found"
    apart = abs(one.shooting.force - one.stall.force)
    if apart <= SAME * abs(one.stall.force):
        return f"{held}, the same in the motion that repeats itself"
    said = "more than that" if apart > one.stall.spread else "no more than that"
    return (
        f"{held}, {in_words(one.shooting.force, 'N', '+.5g')} in the motion that repeats itself: "
        f"{in_words(apart, 'N', '.1g')} apart, {said}"
    )


def _held_still(at: "AtSpeed") -> str:
    """The mean, with what it is a mean of and how far it may be off."""
    force, spread = in_words(at.force, "N", "+.5g"), in_words(at.spread, "N", ".1g")
    if not at.settled("force"):
        return (
            f"not settled after {at.periods} periods, {force} +- {spread} as a mean over the last {at.window} of them"
        )
    said = f"blocks differ by {spread}" if at.window == BLOCK else f"the last {at.window}, +- {spread}"
    return f"{force} as a mean over periods ({said})"


def unsettled(fields: "Sequence[FieldFound]", hard: bool) -> Iterator[str]:
    """What bounces, creeps or has not come to rest, so that its means have not settled, and what to do."""
    for one in fields:
        loss = f"{'less slider.contact.restitution' if hard else 'more slider.contact.damping'} "
        loss += "or more slider.preload"
        shaky = [at for at in one.curve if not at.settled()]
        crept, other = [[at for at in shaky if at.crept is creeps] for creeps in (True, False)]
        more = "ask for one figure over more periods (verify measure slider.force_speed)"
        calmer, swing = f"give {loss}, or {more}", "not come to rest, all points on the surface"
        for does, of, remedy in (
            ("bouncing", [at for at in other if at.bounces], calmer),
            ("creeping, all points on the surface", [at for at in crept if not at.bounces], more),
            ("creeping, points leaving the surface", [at for at in crept if at.bounces], more),
            (swing, [at for at in other if not at.bounces], calmer),
        ):
            if of:
                yield (
                    f"{does}: on the {one.title} means at {len(of)} of {len(one.curve)} held speeds have not settled "
                    f"after {max(at.periods for at in of)} periods; what stands on them is withheld: {remedy}"
                )
        if not one.free.settled:
            yield (
                f"free run: on the {one.title} its last quarter is no steady end, halves differ by {_small(one)} where "
                f"crests run at {100 * one.crest_speed:.3g} cm/s: raise motor.periods, or give {loss}"
            )


def _fields_agree(fields: "Sequence[FieldFound]") -> Iterator[str]:
    """How far apart the fields' free speeds lie."""
    whole = [one for one in fields if one.free.stopped == "end"]
    if len(whole) < 2:
        return
    speeds = [one.free.speed for one in whole]
    apart, spread = max(speeds) - min(speeds), max(one.free.spread for one in whole)
    if apart <= spread:
        yield "fields: whether they differ in speed is withheld, each is known to less than that"
        return
    yield f"fields: their free speeds lie within {apart / max(abs(v) for v in speeds):.2g} of the largest"


def _pressed_more(one: "FieldFound", slider: "Slider") -> str:
    """By how much more feet press in the run than at rest, as those between two beams do, whose crests press them."""
    known = slider.normal_force > 0.0 and one.stall.settled("normal force")
    ratio = one.stall.normal_force / slider.normal_force if known else 0.0
    return f"; in the run feet press {ratio:.3g} times as much, and bend it the more" if ratio > 1.0 + MORE else ""


def doubts(
    fields: "Sequence[FieldFound]", slider: "Slider", wavenumber: float | None, thickness: float
) -> tuple[str, ...]:
    """A sentence for every margin that is not small, of the first field unless fields differ in it."""
    one = fields[0]
    margins = one.margins
    hard = slider.contact is not None and slider.contact.hard
    told = [*unsettled(fields, hard)]
    if wavenumber is not None:
        told += _of_epsilon(margins.epsilon, slider.mu, wavenumber, thickness)
    elif margins.epsilon is None and not hard:
        told.append(
            "epsilon: 2 mu kappa/(kappa_t k h) is withheld, on the beam's foundation no wave travels at the drive's "
            "frequency"
        )
    if margins.sag is None:
        told.append(
            "sag: what presses would push away or turn a beam that nothing holds, which a one-way run leaves out"
        )
    elif not margins.sag_taken and margins.sag > SAGS * one.amplitude:
        told.append(
            f"sag: what presses at rest bends the beam by {in_words(margins.sag)}, {margins.sag / one.amplitude:.2g} "
            f"times the amplitude under the slider, which a one-way run leaves out{_pressed_more(one, slider)}"
        )
    touching = max(field.free.contact_share for field in fields)
    if touching > STAYS:
        told.append(
            f"climb: points touch for {100 * touching:.3g} % of the time; how fast feet rise, times the slope under "
            f"them, is left out of their slip: of the order of A/h = {one.amplitude / thickness:.2g} of mu times what "
            "presses"
        )
    worst = max(field.margins.step**2 / 24.0 for field in fields)
    if worst > COARSE:
        told.append(f"step: a swing on the contact's springs is {worst:.1e} off in its period; raise steps_per_period")
    chain = max(field.margins.chain or 0.0 for field in fields)
    if chain > NONLINEAR:
        told.append(
            f"chain: the axial inertia of a roller-ended chain of rigid links, (kL)^2 <theta^2> = {chain:.2g} of the "
            "motion, is left out by every linear field"
        )
    size = max(one.coupling.normal_size, one.coupling.friction_size or 0.0)
    if not one.coupling.two_way and size > FELT:
        told.append(
            f"coupling: one-way as slider.coupling says, although what presses the feet on moves the surface by "
            f"{size:.2g} of its motion (felt from {FELT:g} on)"
        )
    return tuple(told)


def _of_epsilon(epsilon: float | None, mu: float, wavenumber: float, thickness: float) -> Iterator[str]:
    """What the contact's give along the surface leaves of Coulomb's law at every point."""
    if epsilon is None:
        return
    layer = 2.0 * mu * LAYER / (wavenumber * thickness)
    if not epsilon:
        if layer > SAGS:
            yield (
                f"epsilon: 0, the contact does not give way along the surface, as the scene says; a confined layer of "
                f"nu = {NU:g} would have 2 mu kappa/(kappa_t k h) = {layer:.2g} and stick nearly everywhere"
            )
    elif epsilon > SAGS:
        yield (
            f"epsilon: 2 mu kappa/(kappa_t k h) = {epsilon:.3g}, so that points give way before they slip; the runs "
            "have that, Coulomb's closed forms of a layer do not"
        )
