"""All fields from rest, undamped, under forces that are switched on at once: the only start of a nonlinear chain.

An undamped beam never comes to a steady wave, and where a slider ends depends on where it was put. So it is put at many
places of one wavelength, the wave runs both ways, and what is said of a field is a mean over all of these with its
standard error; what halved steps change stands beside it.
"""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import sqrt
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.cores import for_each
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.motor.case import MotorCase
from verify.motor.combine import CHAIN
from verify.motor.figures import crest_speed
from verify.motor.result import uninterrupted
from verify.options import Links
from verify.studies.charting import thinned
from verify.studies.kind import Progress
from verify.studies.motor.request import HELD, RUNS, case_of, places_from_rest
from verify.units import in_words, time_in_words, unit_over

if TYPE_CHECKING:
    from verify.motor.result import MotorRun
    from verify.scenes.scene import Scene
    from verify.studies.motor.request import Motor

SURE = 2.0
"""Standard errors from which on a mean is told."""


class Departure(msgspec.Struct, frozen=True, kw_only=True):
    """How far a field's sliders end from those of the first field, metres along +x."""

    mean: float
    error: float
    """Standard error of that mean, over the starts."""
    rms: float

    @property
    def told(self) -> bool:
        """Whether there is one."""
        return abs(self.mean) > SURE * self.error


class RestHeld(msgspec.Struct, frozen=True, kw_only=True):
    """One field's sliders held at one speed and at their places, means over the last half of each run."""

    speed: float
    """m/s along +x."""
    force: float
    """Mean friction along +x over mu times what presses on, over the places."""
    error: float
    """Its standard error."""
    halved: float | None
    """The same in half the steps; None where that was not run."""


class RestField(msgspec.Struct, frozen=True, kw_only=True):
    """One field's sliders, from rest."""

    model: str
    links: Links
    ends: tuple[float, ...]
    """Metres along +x, of every place, then of every place with the wave turned round."""
    halved: tuple[float, ...]
    """The same in half the steps."""
    curve: tuple[RestHeld, ...]
    """From standing still to the speed of the crests, the way that the wave pushes."""
    turned: tuple[RestHeld, ...]
    """The same with the wave turned round."""
    times: tuple[float, ...]
    way: tuple[float, ...]
    """Metres, at those times, of the slider at the scene's own place."""
    whole: bool
    """Whether all runs reached their end."""
    drawn: float | None = None
    """Speed along x of a chain's links under sliders that stand still, over that of the crests, rms over time and all
    starts: bending draws them in. None of a linear field, which leaves that out."""

    @property
    def title(self) -> str:
        """'exact beam', 'rigid links'."""
        return f"{self.links} links" if self.model == CHAIN else MODELS[self.model].title

    @property
    def stepped(self) -> float:
        """What halved steps change, rms, metres."""
        return float(np.sqrt(np.mean((np.array(self.ends) - np.array(self.halved)) ** 2)))

    @property
    def push(self) -> tuple[float, float]:
        """(force over mu N on a slider that stands still, as far as it turns round with the wave, its error)."""
        there, back = self.curve[0], self.turned[0]
        way = 1.0 if self.turned[-1].speed > 0.0 else -1.0
        return 0.5 * way * (back.force - there.force), 0.5 * sqrt(there.error**2 + back.error**2)

    @property
    def push_stepped(self) -> float:
        """What halved steps change of it."""
        there, back = self.curve[0], self.turned[0]
        return 0.5 * abs((back.halved or 0.0) - (there.halved or 0.0) - (back.force - there.force))

    @property
    def bias(self) -> tuple[float, float]:
        """(what does not turn round with the wave, along +x, its error)."""
        there, back = self.curve[0], self.turned[0]
        return 0.5 * (back.force + there.force), self.push[1]

    def own(self, turned: bool) -> float:
        """Of the scene's own place."""
        n = len(self.ends) // 2
        return self.ends[n // 2 + n * turned]


class FromRest(msgspec.Struct, frozen=True, kw_only=True):
    """The runs from rest."""

    force: float
    """Newton, of the largest force of the drive."""
    preload: float
    """Newton."""
    seconds: float
    size: float
    """(kL)^2 <theta^2> of the steady linear chain under those forces."""
    places: tuple[float, ...]
    """Metres."""
    fields: tuple[RestField, ...]

    @property
    def n_runs(self) -> int:
        """Of sliders."""
        return RUNS * len(self.places) * len(self.fields)

    def departure(self, one: RestField) -> Departure:
        """From the first field."""
        apart = np.array(one.ends) - np.array(self.fields[0].ends)
        error = float(apart.std(ddof=1)) / sqrt(len(apart))
        return Departure(mean=float(apart.mean()), error=error, rms=float(np.sqrt((apart**2).mean())))


def rest_runs(scene: "Scene", asked: "Motor", way: float, progress: Progress) -> FromRest | None:
    """Every field from every start, shared among the cores; None where no chain was asked for. Raises InputError.

    `way` is that of the steady wave's push, +1 or -1.
    """
    if not asked.from_rest:
        return None
    case, places = _scaled(scene, asked), places_from_rest(asked, scene)
    crests, n = way * crest_speed(case), len(asked.from_rest)

    def run(field: tuple[str, Links]) -> tuple[RestField, float]:
        model, links = field
        return _field(replace(case, model=model, count=asked.sized(model), links=links), asked, places, crests)

    found = for_each(run, asked.from_rest, lambda number: progress(f"from rest on {number} of {n} fields"))
    return FromRest(
        force=max(abs(force.amplitude) for force in case.forces),
        preload=case.slider.preload,
        seconds=asked.seconds,
        size=next(size for one, size in reversed(found) if one.model == CHAIN),
        places=places,
        fields=tuple(one for one, _ in found),
    )


def _scaled(scene: "Scene", asked: "Motor") -> MotorCase:
    """The scene's motor from rest, its forces as asked for and what presses in proportion."""
    case = replace(case_of(asked, scene, asked.linear[0]), start="rest", soft_start_periods=0.0, modal_damping=0.0)
    if asked.chain_force is None:
        return case
    factor = asked.chain_force / max(abs(force.amplitude) for force in case.forces)
    slider = case.slider
    pressed = replace(slider, preload=factor * slider.preload, gravity=factor * slider.gravity)
    return case.driven(factor).on(pressed)


def _field(case: MotorCase, asked: "Motor", places: tuple[float, ...], crests: float) -> tuple[RestField, float]:
    """All starts of one field, and how nonlinear its chain is; `crests` is their speed, m/s, with its way."""
    halved = replace(case, steps_per_period=2 * case.steps_per_period)
    held = tuple(crests * k / (HELD - 1) for k in range(HELD))
    there = _runs(case, asked.seconds, places, held)
    back = _runs(case.turned(), asked.seconds, places, tuple(-speed for speed in held))
    fine = _runs(halved, asked.seconds, places, held[:1])
    fine_back = _runs(halved.turned(), asked.seconds, places, held[:1])
    shown = there[0][len(places) // 2]
    found = RestField(
        model=case.model,
        links=case.links,
        ends=tuple(float(run.travelled[-1]) for run in (*there[0], *back[0])),
        halved=tuple(float(run.travelled[-1]) for run in (*fine[0], *fine_back[0])),
        curve=tuple(_held(row, fine[k] if k == 1 else ()) for k, row in enumerate(there) if k),
        turned=tuple(_held(row, fine_back[k] if k == 1 else ()) for k, row in enumerate(back) if k),
        times=tuple(thinned(shown.times, 200)),
        way=tuple(thinned(shown.travelled, 200)),
        whole=all(_whole(rows) for rows in (there, back, fine, fine_back)),
        drawn=_drawn((*there[1], *back[1]), crests),
    )
    return found, shown.motor_margins.chain or 0.0


def _drawn(runs: "Sequence[MotorRun]", crests: float) -> float | None:
    """Of `RestField`; `crests` is their speed, m/s."""
    speeds = [run.motor_margins.drawn for run in runs]
    if crests == 0.0 or None in speeds:
        return None
    return float(np.sqrt(np.mean(np.square(np.array(speeds, dtype=float)))) / abs(crests))


def _whole(rows: "list[tuple[MotorRun, ...]]") -> bool:
    return all(run.statistics.stopped == "end" for row in rows for run in row)


def _held(runs: "Sequence[MotorRun]", fine: "Sequence[MotorRun]") -> RestHeld:
    """Means over the last half of the runs, and over their places."""
    forces = _forces(runs)
    return RestHeld(
        speed=float(runs[0].speed[-1]),
        force=float(forces.mean()),
        error=float(forces.std(ddof=1)) / sqrt(len(forces)),
        halved=float(_forces(fine).mean()) if fine else None,
    )


def _forces(runs: "Sequence[MotorRun]") -> Array:
    """(n,), over mu N."""
    slider = runs[0].slider
    assert slider is not None
    means = [float(run.friction[len(run.friction) // 2 :].mean()) for run in runs]
    return np.asarray(np.array(means) / (slider.mu * slider.normal_force))


def _runs(
    case: MotorCase, seconds: float, places: tuple[float, ...], held: tuple[float, ...]
) -> "list[tuple[MotorRun, ...]]":
    """Free sliders at all places, then those held at each speed: on one beam, which moves once and feels none."""
    from verify.motor.run import run_motors

    each = [(speed, x) for speed in (None, *held) for x in places]
    found = run_motors(
        case.beam,
        case.forces,
        case.frequency_hz,
        seconds,
        sliders=[replace(case.slider, position=x) for _, x in each],
        held_speed=[speed for speed, _ in each],
        frozen=[speed is not None for speed, _ in each],
        model=case.model,
        count=case.count,
        modes=case.modes,
        start="rest",
        modal_damping=0.0,
        links=case.links,
        samples=int(seconds * case.frequency_hz) + 2,
        steps_per_period=case.steps_per_period,
    )
    for one in found:
        uninterrupted(one)
    return [found[k : k + len(places)] for k in range(0, len(found), len(places))]


def what_stands(found: FromRest) -> Iterator[str]:
    """What the runs say of the chains beside the beam; withheld where it is within twice its standard error."""
    starts = 2 * len(found.places)
    first = found.fields[0].title
    yield (
        f"from rest, undamped, {found.force:g} N switched on at once, {time_in_words(found.seconds)}, (kL)^2 <theta^2> "
        f"= {found.size:.2g}, {starts} starts ({len(found.places)} places of one wavelength, the wave either way): "
        f"where a slider ends against that on the {first}, "
        + "; ".join(_departs(found, one) for one in found.fields[1:])
    )
    yield "held still in those runs, force over mu N that turns round with the wave, and that does not: " + "; ".join(
        f"{one.title} {_pm(*one.push)}, {_pm(*one.bias)}" for one in found.fields
    )
    chains = [one for one in found.fields if one.model == CHAIN]
    if drawn := [f"{one.title} {one.drawn:.2g}" for one in chains if one.drawn is not None]:
        yield (
            "bending draws a chain in, and its surface goes along x with it: under sliders held still, rms over the "
            f"crests' speed, {', '.join(drawn)}; linear fields have none of that, whatever the axial inertia"
        )
    for one, other in pairwise(chains):
        yield _nearer(found, one, other)


def _pm(mean: float, error: float) -> str:
    return f"{mean:+.3f} +- {error:.2g}"


def _departs(found: FromRest, one: RestField) -> str:
    gone = found.departure(one)
    unit = unit_over((gone.mean, gone.error))
    error = float(f"{unit.factor * gone.error:.2g}")
    mean = f"{unit.factor * gone.mean:+.3g} +- {error:g} {unit.name}"
    said = mean if gone.told else f"no mean that is told from its error ({mean})"
    return f"on {one.title} {said}, rms {in_words(gone.rms)}, halved steps {in_words(one.stepped, form='.2g')}"


def _error_of(beam: RestField, one: RestField, other: RestField) -> float:
    """Standard error of how much nearer one of two pushes is to the beam's, whose own counts where it lies between."""
    between = (one.push[0] - beam.push[0]) * (other.push[0] - beam.push[0]) < 0.0
    return sqrt(one.push[1] ** 2 + other.push[1] ** 2 + (2.0 * beam.push[1] * between) ** 2)


def _nearer(found: FromRest, one: RestField, other: RestField) -> str:
    """Which of two pushes more nearly as the first field does, standing still."""
    beam = found.fields[0]
    far = [abs(each.push[0] - beam.push[0]) for each in (one, other)]
    error, stepped = _error_of(beam, one, other), one.push_stepped + other.push_stepped
    pair = f"{one.title} push {far[0]:.3f} mu N otherwise, {other.title} {far[1]:.3f}"
    if abs(far[0] - far[1]) <= max(SURE * error, stepped):
        return (
            f"which chain pushes more nearly as the {beam.title} does is withheld ({pair}, apart by less than errors)"
        )
    near = other if far[0] > far[1] else one
    return f"{near.title} push more nearly as the {beam.title} does in these runs ({pair})"
