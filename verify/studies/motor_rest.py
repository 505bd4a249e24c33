"""All fields from rest, undamped, under forces that are switched on at once: the only start of a nonlinear chain."""

from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import replace

from verify.models.catalogue import MODELS
from verify.motor.case import MotorCase
from verify.motor.combine import CHAIN
from verify.options import Links
from verify.studies.charting import thinned
from verify.studies.kind import Progress
from verify.studies.motor import case_of

if TYPE_CHECKING:
    from verify.scenes.scene import Scene
    from verify.studies.motor import Motor

CLOSE = "segment"
"""The linear chain, of which the nonlinear ones are made."""
EXACT = "analytic"


class RestRun(msgspec.Struct, frozen=True, kw_only=True):
    """One field's slider, from rest."""

    model: str
    links: Links
    travelled: float
    """Metres along +x at the end."""
    force: float
    """Mean friction over all of the run, newton along +x."""
    contact_share: float
    times: tuple[float, ...]
    way: tuple[float, ...]
    """Metres, at those times."""
    stopped: str

    @property
    def title(self) -> str:
        """'exact beam', 'chain of rigid links'."""
        return f"chain of {self.links} links" if self.model == CHAIN else MODELS[self.model].title


class Variant(msgspec.Struct, frozen=True, kw_only=True):
    """All fields under one condition."""

    what: str
    """'as the scene says', 'halved steps'."""
    runs: tuple[RestRun, ...]

    def of(self, model: str, links: Links = "rigid") -> RestRun | None:
        """A field's run; None where it was not asked for."""
        return next((run for run in self.runs if run.model == model and (model != CHAIN or run.links == links)), None)


class FromRest(msgspec.Struct, frozen=True, kw_only=True):
    """The runs from rest."""

    force: float
    """Newton, of the first force of the drive."""
    preload: float
    """Newton."""
    seconds: float
    size: float
    """(kL)^2 <theta^2> of the steady linear chain under those forces."""
    variants: tuple[Variant, ...]

    @property
    def n_runs(self) -> int:
        """All of them."""
        return sum(len(one.runs) for one in self.variants)

    @property
    def runs(self) -> tuple[RestRun, ...]:
        """As the scene says."""
        return self.variants[0].runs


def rest_runs(scene: "Scene", asked: "Motor", progress: Progress) -> FromRest | None:
    """Every field under every condition; None where no chain was asked for. Raises InputError."""
    if not asked.from_rest:
        return None
    scaled = _scaled(scene, asked)
    variants, size = [], 0.0
    for what, case in _conditions(scaled, asked):
        progress(f"from rest, {what}")
        runs = []
        for model, links in asked.from_rest:
            run, nonlinear = _run(case, asked, model, links)
            runs.append(run)
            size = size or nonlinear or 0.0
        variants.append(Variant(what=what, runs=tuple(runs)))
    return FromRest(
        force=scaled.forces[0].amplitude,
        preload=scaled.slider.preload,
        seconds=asked.chain,
        size=size,
        variants=tuple(variants),
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


def _conditions(case: MotorCase, asked: "Motor") -> tuple[tuple[str, MotorCase], ...]:
    """What is changed, each by itself: a figure that one of them turns round is not a figure of the field."""
    quarter = 0.25 * 2.0 * 3.141592653589793 / (2.0 * 3.141592653589793 * case.frequency_hz / case.beam.wave_constant) ** 0.5
    x = case.slider.start_on(case.beam)
    up, down = (case.on(replace(case.slider, position=x + way * quarter)) for way in (1.0, -1.0))
    return (
        ("as the scene says", case),
        ("steps halved", replace(case, steps_per_period=2 * asked.steps_per_period)),
        ("a quarter of a wave to the right", up),
        ("a quarter of a wave to the left", down),
        ("phases turned round", case.turned()),
    )


def _run(case: MotorCase, asked: "Motor", model: str, links: Links) -> tuple[RestRun, float | None]:
    """One run, and how nonlinear its chain is."""
    own = replace(case, model=model, count=asked.sized(model), links=links)
    run = own.run(asked.chain, samples=int(asked.chain * case.frequency_hz) + 2)
    found = RestRun(
        model=model,
        links=links,
        travelled=float(run.travelled[-1]),
        force=float(run.friction[1:].mean()),
        contact_share=float(run.contact_share[1:].mean()),
        times=tuple(thinned(run.times, 200)),
        way=tuple(thinned(run.travelled, 200)),
        stopped=run.statistics.stopped,
    )
    return found, run.motor_margins.chain if model == CHAIN else None


def apart(variant: Variant, one: tuple[str, Links], other: tuple[str, Links]) -> float | None:
    """How far two fields' sliders end from each other, metres; None where one was not run to its end."""
    a, b = variant.of(*one), variant.of(*other)
    if a is None or b is None or a.stopped != "end" or b.stopped != "end":
        return None
    return abs(a.travelled - b.travelled)


def nearer(found: FromRest, to: str) -> tuple[int, int] | None:
    """(in how many conditions stretching links end nearer to a field than rigid ones, of how many); None without."""
    pairs = [(apart(one, (CHAIN, "stretching"), (to, "rigid")), apart(one, (CHAIN, "rigid"), (to, "rigid")))
             for one in found.variants]  # fmt: skip
    whole = [(a, b) for a, b in pairs if a is not None and b is not None]
    return (sum(a < b for a, b in whole), len(whole)) if whole else None


def what_stands(found: FromRest) -> tuple[str, ...]:
    """What the runs say of the chains beside the beam; withheld where a condition turns it round."""
    how = (
        f"from rest, undamped, forces of {found.force:g} N switched on at once, {1e3 * found.seconds:g} ms, "
        f"(kL)^2 <theta^2> = {found.size:.2g}"
    )
    told = []
    for to, name in ((CLOSE, "the linear chain of as many links"), (EXACT, "the exact beam")):
        count = nearer(found, to)
        if count is None:
            continue
        near, of = count
        told.append(f"{_verdict(near, of)} {name} ({how})")
    return tuple(told)


def _verdict(near: int, of: int) -> str:
    if near == of:
        return f"in all {of} conditions the slider on stretching links ends nearer than on rigid ones to that on"
    if near == 0:
        return f"in all {of} conditions the slider on rigid links ends nearer than on stretching ones to that on"
    return f"withheld, as stretching links win {near} of {of} conditions: which chain ends nearer to the slider on"
