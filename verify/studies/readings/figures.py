"""Which published claims about a slider hold under which reading of what their source leaves open. Nothing is tuned."""

from collections.abc import Iterator, Sequence
from itertools import product
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.cores import for_each
from verify.errors import InputError
from verify.motion.figures import CHAIN, Condition
from verify.scenes.claims import Claim, asks_for_turned
from verify.studies.chart import Chart
from verify.studies.conditions import condition_of
from verify.studies.kind import Progress
from verify.studies.readings.chain_rides import Chains
from verify.studies.readings.request import NAMES, ReadingsAsk
from verify.studies.slider.figures import figures_of, reversed_scene
from verify.studies.slider.work_precision import run_once
from verify.studies.told import Found, Table

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

LISTS = ("kinematics", "normal", "soft_start_periods", "positions", "forces", "mu", "slope")
"""What is varied, the slowest first."""
GROUPED_BY = LISTS[:4]
"""A row of the table is one of each of these."""


class Reading(msgspec.Struct, frozen=True, kw_only=True):
    """One combination, run on one model."""

    condition: Condition
    mass: float
    """kg."""
    figures: dict[str, float]
    """By quantity; empty where the run did not reach its end."""
    met: tuple[bool, ...]
    """Whether each claim about the run holds, in their order."""
    lift_off: float | None
    """Acceleration of the surface over what presses the slider on; above 1 a real slider lifts off. None on a chain."""
    nonlinearity: float | None
    """(kL)^2 <theta^2>, which the linear model leaves out; None on the nonlinear chain."""
    stopped: str = "end"

    @property
    def n_met(self) -> int:
        """How many claims hold."""
        return sum(self.met)

    @property
    def speed(self) -> float | None:
        """Mean speed, m/s; None where the run did not reach its end."""
        return self.figures.get("slider.mean_speed")


class Group(msgspec.Struct, frozen=True, kw_only=True):
    """All readings of one model, one kinematics, one start and one place."""

    readings: tuple[Reading, ...]
    best: Reading
    """The first of those that meet most claims."""
    exact: Reading | None
    """That one on the exact beam; None where it was not run there."""

    @property
    def speeds(self) -> tuple[float, float] | None:
        """From the lowest to the highest mean speed, m/s."""
        found = [one.speed for one in self.readings if one.speed is not None]
        return (min(found), max(found)) if found else None

    def n_meeting(self, claim: int) -> int:
        """How many of them meet a claim, counted from 0."""
        return sum(one.met[claim] for one in self.readings)


class Turn(msgspec.Struct, frozen=True, kw_only=True):
    """How often a claim's verdict turns with one thing alone."""

    claim: str
    by: str
    pairs: int
    """Neighbouring readings that differ in that alone."""
    turned: int


class Bound(msgspec.Struct, frozen=True, kw_only=True):
    """What friction alone can give a slider from rest, held against a claimed mean speed."""

    claimed: float
    least_mu: float
    """Below it the claim cannot hold in the tangential kinematics from rest: 2 |v| m / (N t)."""
    n_above: int
    """Tangential readings with mu from there on."""
    fastest: float | None
    """The largest mean speed of those towards the claimed side, m/s; None without any."""


class ReadingsFound(Found, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of the readings."""

    claims: tuple[Claim, ...]
    """About the slider's run."""
    groups: tuple[Group, ...]
    turns: tuple[Turn, ...]
    bounds: tuple[Bound, ...]
    searched: dict[str, tuple[float | str, ...]]
    """The lists, whole."""
    n_runs: int

    @property
    def readings(self) -> tuple[Reading, ...]:
        """All of them, in the order of the lists."""
        return tuple(one for group in self.groups for one in group.readings)

    def facts(self) -> tuple[str, ...]:
        """What was searched, and what friction alone allows."""
        from verify.studies.readings.words import bound_words, searched_words

        return (f"readings: {searched_words(self)}", *(bound_words(bound) for bound in self.bounds))

    def tables(self) -> tuple[Table, ...]:
        """What each group meets, the best of each, what verdicts turn with, all readings."""
        from verify.studies.readings.tables import reading_tables

        return reading_tables(self)

    def charts(self) -> tuple[Chart, ...]:
        """Mean speed over the force."""
        from verify.studies.readings.charts import reading_charts

        return reading_charts(self)

    def plain(self) -> Any:
        """All readings with their conditions, figures and verdicts; the best of each group and the exact beam's."""
        claims = [claim.id for claim in self.claims]

        def plain(reading: "Reading | None") -> dict[str, Any] | None:
            found: dict[str, Any] | None = msgspec.to_builtins(reading)
            return found and found | {"met": dict(zip(claims, found["met"], strict=True))}

        groups = [
            {"readings": [plain(one) for one in group.readings], "best": plain(group.best), "exact": plain(group.exact)}
            for group in self.groups
        ]
        return {
            "claims": claims,
            "searched": self.searched,
            "n_runs": self.n_runs,
            "groups": groups,
            "turns": msgspec.to_builtins(self.turns),
            "bounds": msgspec.to_builtins(self.bounds),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row for each reading: how it was run, what was found, which claims it meets, SI."""
        claims = [claim.id for claim in self.claims]
        return [
            {**msgspec.to_builtins(one.condition), "forces": max(one.condition.forces), "mass": one.mass}
            | {name: one.figures.get(name) for name in self._figures()}
            | {f"meets {claim}": met for claim, met in zip(claims, one.met, strict=True)}
            | {"stopped": one.stopped}
            for one in self.readings
        ]

    def _figures(self) -> list[str]:
        return list(dict.fromkeys(name for one in self.readings for name in one.figures))

    def motions(self) -> int:
        """All runs."""
        return self.n_runs


def searched_of(scene: "Scene", asked: ReadingsAsk) -> dict[str, tuple[float | str, ...]]:
    """What each thing is varied over, the scene's own value where no list is given."""
    slider, motion = scene.slider, scene.motion
    assert slider is not None
    assert motion is not None
    soft = motion.soft_start if motion.start == "rest" else None
    own: dict[str, float | str | None] = {
        "kinematics": slider.kinematics,
        "normal": slider.normal,
        "soft_start_periods": soft,
        "positions": slider.start_on(scene.beam),
        "forces": None,
        "mu": slider.mu,
        "slope": slider.steepness,
    }
    return {name: tuple(getattr(asked, name)) or (() if own[name] is None else (own[name],)) for name in LISTS}  # type: ignore[misc]


def readings_study(scene: "Scene", asked: ReadingsAsk, progress: Progress = lambda step: None) -> ReadingsFound:
    """Run every reading, judge the claims, run the best on the exact beam. Raises InputError."""
    claims = tuple(claim for claim in scene.claim if claim.of_run)
    searched = searched_of(scene, asked)
    drawn: dict[tuple[float | str | None, ...], list[tuple[Scene, Reading]]] = {}
    varied = list(product(*(searched[name] or (None,) for name in LISTS)))
    scenes = [read_as(scene, asked, dict(zip(LISTS, values, strict=True))) for values in varied]

    def judged(read: "Scene") -> Reading:
        return reading(read, claims, asked.model, read.motion.count)  # type: ignore[union-attr]

    every_reading = for_each(judged, scenes, lambda number: progress(f"reading {number} of {asked.n_readings}"))
    for values, read, found in zip(varied, scenes, every_reading, strict=True):
        drawn.setdefault(values[: len(GROUPED_BY)], []).append((read, found))
    best = {key: max(rows, key=lambda row: row[1].n_met) for key, rows in drawn.items()}
    shown = sorted(best, key=lambda key: -best[key][1].n_met)[: asked.shown]
    on_exact = for_each(
        lambda read: reading(read, claims, "analytic", None),
        [best[key][0] for key in shown],
        lambda number: progress(f"exact beam beside the best readings, {number}"),
    )
    exact = dict(zip(shown, on_exact, strict=True))
    groups = tuple(
        Group(readings=tuple(one for _, one in rows), best=best[key][1], exact=exact.get(key))
        for key, rows in drawn.items()
    )
    every = [one for group in groups for one in group.readings]
    chained = _on_the_chain([row for rows in drawn.values() for row in rows], claims, progress) if asked.chain else ()
    riding = [one for group in chained for one in group.readings]
    runs = (2 if asks_for_turned(claims) else 1) * (len(every) + len(exact) + len(riding))
    return ReadingsFound(
        claims=claims,
        groups=(*groups, *chained),
        turns=tuple(_turns(claims, every, searched)),
        bounds=tuple(_bounds(scene, claims, every + riding)),
        searched=searched,
        n_runs=runs,
    )


def _on_the_chain(
    rows: "Sequence[tuple[Scene, Reading]]", claims: Sequence[Claim], progress: Progress
) -> tuple[Group, ...]:
    """Those readings of a massless slider whose forces act at once, on the nonlinear chain of as many links."""
    chains, drawn = Chains({}), dict[tuple[str, float], list[Reading]]()
    at_once = [row for row in rows if not row[1].condition.soft_start_periods and row[1].condition.normal == "massless"]
    on_chain = for_each(
        lambda scene: chain_reading(scene, claims, chains),
        [scene for scene, _ in at_once],
        lambda number: progress(f"reading {number} of {len(at_once)} on the nonlinear chain"),
    )
    for (_, linear), found in zip(at_once, on_chain, strict=True):
        drawn.setdefault((linear.condition.kinematics, linear.condition.position), []).append(found)
    return tuple(
        Group(readings=tuple(found), best=max(found, key=lambda one: one.n_met), exact=None) for found in drawn.values()
    )


def chain_reading(scene: "Scene", claims: Sequence[Claim], chains: Chains) -> Reading:
    """One combination on the nonlinear chain; one on which it breaks off says so."""
    slider, motion = scene.slider, scene.motion
    assert slider is not None
    assert motion is not None
    stopped, figures = "end", {}
    try:
        run = chains.ride(scene, motion.count)
        back = chains.ride(reversed_scene(scene), motion.count) if asks_for_turned(tuple(claims)) else None
        ends = [one.statistics.stopped for one in (run, back) if one is not None]
        stopped = next((end for end in ends if end != "end"), "end")
        figures = figures_of(run, back) if stopped == "end" else {}
    except InputError as error:
        stopped = str(error)
    return Reading(
        condition=condition_of(scene, CHAIN, motion.count),
        mass=slider.mass,
        figures=figures,
        met=_verdicts(claims, figures),
        lift_off=None,
        nonlinearity=None,
        stopped=stopped,
    )


def _verdicts(claims: Sequence[Claim], figures: dict[str, float]) -> tuple[bool, ...]:
    return tuple(bool(figures) and claim.holds(figures[claim.quantity]) for claim in claims)


def read_as(scene: "Scene", asked: ReadingsAsk, values: "dict[str, float | str | None]") -> "Scene":
    """The scene with one combination in place of its own slider, start and forces."""
    slider, motion, drive = scene.slider, scene.motion, scene.drive
    assert slider is not None
    assert motion is not None
    assert drive is not None
    force, mu = values["forces"], values["mu"]
    mass = slider.mass
    if asked.saturation is not None:
        mass = (asked.saturation / float(mu or slider.mu) - slider.preload) / slider.gravity
    own = {
        "kinematics": values["kinematics"],
        "normal": values["normal"],
        "position": values["positions"],
        "slope": values["slope"],
        "mu": mu,
    }
    forces = drive.force if force is None else tuple(replace(one, amplitude=float(force)) for one in drive.force)
    return replace(
        scene.bare,
        gate=(),
        drive=replace(drive, force=forces),
        slider=replace(slider, mass=mass, **own),
        motion=replace(
            motion,
            soft_start_periods=values["soft_start_periods"] or 0.0,
            count=asked.count or motion.count,
            duration=asked.duration or motion.duration,
        ),
    )


def reading(scene: "Scene", claims: Sequence[Claim], model: str, count: int | None) -> Reading:
    """One combination on one model, with every figure that claims may ask for. Raises InputError."""
    assert scene.slider is not None
    run = run_once(scene, model, count, samples=2)
    back = run_once(reversed_scene(scene), model, count) if asks_for_turned(tuple(claims)) else None
    ends = {one.statistics.stopped for one in (run, back) if one is not None} - {"end"}
    figures = {} if ends else figures_of(run, back)
    return Reading(
        condition=condition_of(scene, model, count),
        mass=scene.slider.mass,
        figures=figures,
        met=_verdicts(claims, figures),
        lift_off=run.margins.lift_off,
        nonlinearity=run.margins.nonlinearity,
        stopped=" and ".join(sorted(ends)) or "end",
    )


def _turns(
    claims: Sequence[Claim], readings: Sequence[Reading], searched: dict[str, tuple[float | str, ...]]
) -> Iterator[Turn]:
    """For every claim and everything varied: neighbours in that list alone whose verdicts differ."""
    sizes = [max(len(searched[name]), 1) for name in LISTS]
    for i, claim in enumerate(claims):
        stride = len(readings)
        for name, size in zip(LISTS, sizes, strict=True):
            stride //= size
            pairs = [(j, j + stride) for j in range(len(readings)) if (j // stride) % size < size - 1]
            if pairs:
                turned = sum(readings[a].met[i] != readings[b].met[i] for a, b in pairs)
                yield Turn(claim=claim.id, by=NAMES[name], pairs=len(pairs), turned=turned)


def _bounds(scene: "Scene", claims: Sequence[Claim], readings: Sequence[Reading]) -> Iterator[Bound]:
    """Of every mean speed that is claimed as a number; none for a slider that is pressed on or moves already."""
    slider = scene.slider
    assert slider is not None
    tangential = [one for one in readings if one.condition.kinematics == "tangential" and one.speed is not None]
    if slider.preload or slider.speed or not tangential or slider.law != "tanh":
        return
    for claim in claims:
        if claim.quantity != "slider.mean_speed" or not claim.number:
            continue
        least = 2.0 * abs(claim.number) / (slider.gravity * tangential[0].condition.duration)
        side = 1.0 if claim.number > 0 else -1.0
        above = [side * one.speed for one in tangential if one.speed is not None and one.condition.mu >= least]
        yield Bound(
            claimed=claim.number, least_mu=least, n_above=len(above), fastest=side * max(above) if above else None
        )
