"""What a scene will run, what it will not, and why: known before anything is solved."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec.structs import replace

from verify.errors import InputError
from verify.judge.workbench import Key, Settings, merged, no_such_mode
from verify.models.catalogue import MODELS
from verify.run.applies import applicable, not_applicable
from verify.run.asks import Ask, asks_of, every_work, kinds_of_work
from verify.scenes.scene import MotionAsk
from verify.studies.catalogue import STUDIES, asked_of
from verify.words import in_a_row

if TYPE_CHECKING:
    from verify.scenes.scene import Scene


class PlannedSolve(msgspec.Struct, frozen=True, kw_only=True):
    """One solve, done once for all who asked."""

    model: str
    count: int
    settings: Settings
    n_modes: int
    unknowns: int
    method: str
    asked_by: tuple[str, ...]


class Choice(msgspec.Struct, frozen=True):
    """Something this scene does not pay for, or a simpler model that will do."""

    what: str
    why: str


class Problem(msgspec.Struct, frozen=True):
    """Something asked that will fail, known beforehand."""

    who: str
    why: str


class Plan(msgspec.Struct, frozen=True, kw_only=True):
    """Everything `verify plan` prints."""

    scene: str
    solves: tuple[PlannedSolve, ...]
    closed_forms: tuple[str, ...]
    harmonic: tuple[str, ...]
    """Who asks for a driven field, solved when asked for."""
    stepped: tuple[str, ...]
    """Who asks for motion in time: friction and sliders by steps, a beam alone in closed form."""
    chosen: tuple[Choice, ...]
    """Simpler models taken where the neglected part is small, with its size."""
    skipped: tuple[Choice, ...]
    problems: tuple[Problem, ...]
    compiled: tuple[str, ...] = ()
    """Who asks for equilibria or modes of the nonlinear chain."""
    assembled: tuple[str, ...] = ()
    """Who asks for matrices of which nothing is solved."""
    promises: tuple[str, ...] = ()
    """Who pushes a promise on beams of its own: with solves, fields and motions that are not listed."""
    motions: int = 0
    """Simulations in time that the studies will do."""
    searched: tuple[str, ...] = ()
    """Who goes through sizes until one is enough: of those solves only the first is listed."""


def plan_scene(scene: "Scene", overrides: tuple[str, ...] = ()) -> Plan:
    """What will be solved, evaluated in closed form, or skipped, of a scene that was loaded with `overrides`."""
    asks = asks_of(applicable(scene, overrides))
    solves, problems = [], [(ask.who, ask.problem) for ask in asks if ask.problem]
    for key, n_wanted in sorted(merged(need for ask in asks for need in ask.needs).items()):
        who = tuple(a.who for a in asks if any((n.model, n.count, n.settings) == key for n in a.needs))
        try:
            solves.append(_planned(scene, key, n_wanted, who))
            problems += _beyond(scene, asks, key)
        except InputError as error:
            problems += [(one, str(error)) for one in who]
    told = {who for who, _ in problems}
    problems += [(ask.who, why) for ask in asks if ask.who not in told and (why := _unstable(scene, ask))]
    by_work = {work: tuple(ask.who for ask in found) for work, found in kinds_of_work(asks).items()}
    return Plan(
        scene=scene.name,
        solves=tuple(solves),
        closed_forms=by_work.get("closed form", ()),
        harmonic=by_work.get("harmonic", ()),
        stepped=by_work.get("in time", ()),
        compiled=by_work.get("equilibrium", ()),
        assembled=by_work.get("matrices", ()),
        promises=by_work.get("promise", ()),
        chosen=_chosen(scene, asks),
        skipped=(*_set_aside(scene, overrides), *_skipped(scene, asks)),
        problems=tuple(Problem(*pair) for pair in problems),
        motions=sum(ask.motions for ask in asks),
        searched=tuple(ask.who for ask in asks if ask.searches and not ask.problem),
    )


def _unstable(scene: "Scene", ask: Ask) -> str:
    """Why a beam has no vibration that somebody asks for; empty where it has."""
    vibrates = {"modes", "harmonic"} & {*ask.works} or ("in time" in ask.works and ask.kind == "study")
    if scene.beam.tension >= 0.0 or not vibrates:
        return ""
    from verify.exact.buckling import check_stable

    try:
        check_stable(scene.beam)
    except InputError as error:
        return str(error)
    return ""


def _set_aside(scene: "Scene", overrides: tuple[str, ...]) -> tuple[Choice, ...]:
    """Gates that do not apply, together where the reason is one."""
    by_reason: dict[str, list[str]] = {}
    for name, why in not_applicable(scene, overrides).items():
        by_reason.setdefault(why, []).append(name)
    return tuple(Choice(in_a_row("gate", names), why) for why, names in by_reason.items())


def _beyond(scene: "Scene", asks: list[Ask], key: Key) -> list[tuple[str, str]]:
    """Gates and claims about a mode that a model at this size does not have; studies take those that are there."""
    name, count, settings = key
    most = MODELS.named(name).n_elastic(scene.beam, count, **dict(settings))
    return [
        (ask.who, no_such_mode(need.n_modes, name, count, most))
        for ask in asks
        for need in ask.needs
        if ask.kind != "study" and (need.model, need.count, need.settings) == key and need.n_modes > most
    ]


def _planned(scene: "Scene", key: Key, n_wanted: int, who: tuple[str, ...]) -> PlannedSolve:
    name, count, settings = key
    model = MODELS.named(name)
    if scene.beam.tension < 0.0:
        MODELS["analytic"].check(scene.beam, 1, 0)  # one sentence of what has buckled, not one for each size
    n_modes = max(min(n_wanted, model.n_elastic(scene.beam, count, **dict(settings))), 1)
    model.check(scene.beam, n_modes, count, **dict(settings))
    return PlannedSolve(
        model=name,
        count=count,
        settings=settings,
        n_modes=n_modes,
        unknowns=model.unknowns(scene.beam, count, **dict(settings)),
        asked_by=who,
        method=model.method(scene.beam, n_modes, count, **dict(settings)),
    )


def _chosen(scene: "Scene", asks: list[Ask]) -> tuple[Choice, ...]:
    """Simpler models that will do, by size."""
    if not scene.forces or not scene.beam.uniform or scene.devices:
        return ()
    chosen: list[tuple[str, str]] = []
    if scene.slider is not None and any(ask.slides and not ask.problem for ask in asks):
        from verify.run.choices import slider_choices

        chosen += slider_choices(scene)
    for study, asked in asked_of(scene):
        chosen += study.choices(asked, scene)
    return tuple(Choice(*pair) for pair in chosen)


def skipped_by(scene: "Scene") -> tuple[Choice, ...]:
    """What a scene leaves out, with the reason."""
    return _skipped(scene, asks_of(scene))


def _skipped(scene: "Scene", asks: list[Ask]) -> tuple[Choice, ...]:
    """What this scene leaves out, with the reason; what is asked for and cannot run is not left out.

    What promises take nobody knows before they are pushed: beside one nothing but studies is said to be left out.
    """
    work, left = every_work(asks), []
    if "promise" in work:
        return tuple(_skipped_studies(scene))
    if not set(work) - {"closed form"}:
        left.append(Choice("numpy, scipy, scikit-fem", "nothing asked needs a discrete model: closed forms only"))
    else:
        used = {need.model for ask in asks for need in ask.needs} | {name for ask in asks for name in ask.models}
        libraries = {MODELS[name].library for name in used if name in MODELS}
        left += [
            Choice(model.library, f"nothing asked needs the model {model.name}, {model.title}")
            for model in (MODELS[name] for name in MODELS.built_in)
            if model.library and model.library not in libraries
        ]
    if scene.drive is None:
        left.append(Choice("harmonic response", "the scene has no drive"))
    elif "harmonic" not in work:
        left.append(Choice("harmonic response", _without_fields(scene, "in time" in work)))
    if "in time" not in work:
        left.append(Choice("time stepping", "modes and harmonic fields only: linear, nothing depends on the past"))
        left += [] if "equilibrium" in work else [Choice("numba", "nothing asked is stepped")]
    return (*left, *_skipped_slider(scene, asks), *_skipped_studies(scene))


def _without_fields(scene: "Scene", in_time: bool) -> str:
    """Why nothing is found of the steady field, and for what it is solved all the same."""
    if not scene.forces:
        return "no gate and no study asks for the driven beam"
    steady = " and for what is steady in time" if in_time else ""
    return f"no gate and no study is of it, fields are solved for how far the beam deflects{steady} alone"


def _skipped_slider(scene: "Scene", asks: list[Ask]) -> list[Choice]:
    if scene.slider is None:
        return [Choice("contact search", "the scene has no slider")]
    if not any(ask.slides for ask in asks):
        return [Choice("slider", f"nothing runs it: {_who_could_run_it(scene)}")]
    return []


LONG = 10.0
"""Periods of the drive that a run is advised to take where it is shorter than its forces take to grow unless given."""


def _who_could_run_it(scene: "Scene") -> str:
    """The section to add for a study that runs the slider as it stands; where none does, why not the one it is for."""
    own = "motion" if scene.slider is not None and scene.slider.contact is None else "motor"
    others = [name for name in STUDIES.built_in if STUDIES[name].slides and name not in ("motion", own)]
    refused: dict[str, str] = {}
    for name, more, asked in (one for study in (own, *others) for one in _as_it_comes(study, scene)):
        try:
            STUDIES[name].check_run(asked, replace(scene, **{name: asked}))
        except InputError as error:
            refused[name] = str(error)
        else:
            return f"add [{name}]{more}"
    return f"[{own}] would be refused, {refused[own]}"


def _as_it_comes(name: str, scene: "Scene") -> "Iterator[tuple[str, str, Any]]":
    """(study, what to give its section, that section) where nothing is given, and where a run lasts long enough."""
    section = STUDIES[name].section
    if section is not None:
        yield name, "", section()
        return
    yield name, "", MotionAsk()
    if scene.drive is not None:
        seconds = float(f"{LONG / scene.drive.frequency_hz:.2g}")
        yield name, f" with duration = {seconds:g}", MotionAsk(duration=seconds)


def _skipped_studies(scene: "Scene") -> list[Choice]:
    asked = {study.name for study, _ in asked_of(scene)}
    studies = [STUDIES[name] for name in STUDIES.built_in if name not in asked]
    return [Choice(f"{study.name} study", study.skipped(scene)) for study in studies]
