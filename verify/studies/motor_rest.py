"""All fields from rest, undamped, under forces that are switched on at once: the only start of a nonlinear chain.

An undamped beam never comes to a steady wave, and where a slider ends depends on where it was put. So it is put at many
places of one wavelength, the wave runs both ways, and what is said of a field is a mean over all of these with its
standard error; what halved steps change stands beside it.
"""

from collections.abc import Iterator
from itertools import pairwise
from math import sqrt
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.motor.case import MotorCase
from verify.motor.combine import CHAIN
from verify.options import Links
from verify.studies.charting import thinned
from verify.studies.kind import Progress
from verify.studies.motor import CONDITIONS, case_of, places_from_rest

if TYPE_CHECKING:
    from verify.motor.result import MotorRun
    from verify.scenes.scene import Scene
    from verify.studies.motor import Motor

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


class RestField(msgspec.Struct, frozen=True, kw_only=True):
    """One field's sliders, from rest."""

    model: str
    links: Links
    ends: tuple[float, ...]
    """Metres along +x, of every place, then of every place with the wave turned round."""
    halved: tuple[float, ...]
    """The same in half the steps."""
    forces: tuple[float, ...]
    """Mean friction over each run, newton along +x."""
    times: tuple[float, ...]
    way: tuple[float, ...]
    """Metres, at those times, of the slider at the scene's own place."""
    whole: bool
    """Whether all runs reached their end."""

    @property
    def title(self) -> str:
        """'exact beam', 'rigid links'."""
        return f"{self.links} links" if self.model == CHAIN else MODELS[self.model].title

    @property
    def stepped(self) -> float:
        """What halved steps change, rms, metres."""
        return float(np.sqrt(np.mean((np.array(self.ends) - np.array(self.halved)) ** 2)))

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
        return CONDITIONS * len(self.places) * len(self.fields)

    def departure(self, one: RestField) -> Departure:
        """From the first field."""
        apart = np.array(one.ends) - np.array(self.fields[0].ends)
        error = float(apart.std(ddof=1)) / sqrt(len(apart))
        return Departure(mean=float(apart.mean()), error=error, rms=float(np.sqrt((apart**2).mean())))


def rest_runs(scene: "Scene", asked: "Motor", progress: Progress) -> FromRest | None:
    """Every field from every start; None where no chain was asked for. Raises InputError."""
    if not asked.from_rest:
        return None
    case, places = _scaled(scene, asked), places_from_rest(asked, scene)
    fields, size = [], 0.0
    for model, links in asked.from_rest:
        progress(f"from rest on {links + ' links' if model == CHAIN else model}")
        own = replace(case, model=model, count=asked.sized(model), links=links)
        found, nonlinear = _field(own, asked.chain, places)
        fields.append(found)
        size = nonlinear if model == CHAIN else size
    return FromRest(
        force=max(abs(force.amplitude) for force in case.forces),
        preload=case.slider.preload,
        seconds=asked.chain,
        size=size,
        places=places,
        fields=tuple(fields),
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


def _field(case: MotorCase, seconds: float, places: tuple[float, ...]) -> tuple[RestField, float]:
    """All starts of one field, and how nonlinear its chain is."""
    halved = replace(case, steps_per_period=2 * case.steps_per_period)
    runs = [_run(one, seconds, places) for one in (case, case.turned(), halved, halved.turned())]
    first, shown = [*runs[0], *runs[1]], runs[0][len(places) // 2]
    found = RestField(
        model=case.model,
        links=case.links,
        ends=tuple(float(run.travelled[-1]) for run in first),
        halved=tuple(float(run.travelled[-1]) for run in (*runs[2], *runs[3])),
        forces=tuple(float(run.friction[1:].mean()) for run in first),
        times=tuple(thinned(shown.times, 200)),
        way=tuple(thinned(shown.travelled, 200)),
        whole=all(run.statistics.stopped == "end" for row in runs for run in row),
    )
    return found, shown.motor_margins.chain or 0.0


def _run(case: MotorCase, seconds: float, places: tuple[float, ...]) -> "tuple[MotorRun, ...]":
    """Sliders at all places on one beam, which does not feel them."""
    from verify.motor.run import run_motors

    return run_motors(
        case.beam,
        case.forces,
        case.frequency_hz,
        seconds,
        sliders=[replace(case.slider, position=x) for x in places],
        model=case.model,
        count=case.count,
        modes=case.modes,
        start="rest",
        modal_damping=0.0,
        links=case.links,
        samples=int(seconds * case.frequency_hz) + 2,
        steps_per_period=case.steps_per_period,
    )


def what_stands(found: FromRest) -> Iterator[str]:
    """What the runs say of the chains beside the beam; withheld where it is within twice its standard error."""
    starts = 2 * len(found.places)
    first = found.fields[0].title
    yield (
        f"from rest, undamped, {found.force:g} N switched on at once, {1e3 * found.seconds:g} ms, (kL)^2 <theta^2> = "
        f"{found.size:.2g}, {starts} starts ({len(found.places)} places of one wavelength, the wave either way): where "
        f"a slider ends against that on the {first}, " + "; ".join(_departs(found, one) for one in found.fields[1:])
    )
    chains = [one for one in found.fields if one.model == CHAIN]
    for one, other in pairwise(chains):
        yield _nearer(found, one, other)


def _departs(found: FromRest, one: RestField) -> str:
    gone = found.departure(one)
    mean = f"{1e6 * gone.mean:+.3g} +- {1e6 * gone.error:.2g} um"
    said = mean if gone.told else f"no mean that is told from its error ({mean})"
    return f"on {one.title} {said}, rms {1e6 * gone.rms:.3g} um, halved steps {1e6 * one.stepped:.2g} um"


def _nearer(found: FromRest, one: RestField, other: RestField) -> str:
    """Which of two is nearer the first field, start by start."""
    first: Array = np.array(found.fields[0].ends)
    apart = abs(np.array(one.ends) - first) - abs(np.array(other.ends) - first)
    mean, error = float(apart.mean()), float(apart.std(ddof=1)) / sqrt(len(apart))
    pair = f"{one.title} against {other.title}: by {1e6 * mean:+.3g} +- {1e6 * error:.2g} um a start"
    beam = found.fields[0].title
    if abs(mean) <= max(SURE * error, one.stepped + other.stepped):
        return f"which chain is nearer the {beam} is withheld ({pair}, no more than its error allows)"
    return f"{(other if mean > 0 else one).title} are nearer the {beam} ({pair} farther)"
