"""Who wants figures of a scene: its gates, its claims and its studies, each with the work and the solves behind it."""

from collections.abc import Callable, Iterable
from functools import partial
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.judge.workbench import Need
from verify.models.compiling import Call
from verify.motion.figures import RUN_FIGURES
from verify.quantities.catalogue import QUANTITIES, arguments_of, models_named, needs_of, quantity
from verify.quantities.kind import Work
from verify.scenes.claims import Claim
from verify.studies.catalogue import asked_of
from verify.studies.claims import is_of_study

if TYPE_CHECKING:
    from verify.scenes.scene import Gate, Scene


class Ask(msgspec.Struct, frozen=True, kw_only=True):
    """Somebody who wants figures."""

    kind: str
    """gate, claim or study."""
    name: str
    told: str = ""
    """What a study will do."""
    works: tuple[Work, ...] = ("closed form",)
    """Kinds of what is done for it, one at least."""
    needs: tuple[Need, ...] = ()
    models: tuple[str, ...] = ()
    """Models that are used beside the needs, by name."""
    slides: bool = False
    """Whether the scene's slider is run."""
    searches: bool = False
    """Whether it goes through sizes of which only the first is known beforehand."""
    motions: int = 0
    """Simulations in time that a study will do."""
    kernels: Callable[[], Iterable[Call]] = tuple
    """Compiled loops that are run for it; a compiler is loaded by whoever asks. Raises InputError."""
    problem: str = ""
    """Why it cannot be evaluated; empty where it can."""

    @property
    def who(self) -> str:
        """'gate swr-law', 'wave (...)'."""
        if self.kind == "study":
            return f"{self.name} ({self.told})" if self.told else self.name
        return f"{self.kind} {self.name}"

    @property
    def short(self) -> str:
        """The same where many stand in a row: a gate by its name alone."""
        return self.name if self.kind == "gate" else self.who

    @property
    def closed_form(self) -> bool:
        """Whether nothing is solved for it: the exact beam's modes are closed forms."""
        return not self.problem and not self.needs and set(self.works) <= {"closed form", "modes"}


def asks_of(scene: "Scene", *, gates_only: bool = False) -> list[Ask]:
    """Everything in a scene that wants a figure."""
    gates = [_figure_ask("gate", gate, scene) for gate in scene.gate]
    if gates_only:
        return gates
    return [*gates, *(_figure_ask("claim", claim, scene) for claim in scene.claim), *_study_asks(scene)]


def studies_in_turn(scene: "Scene") -> list[Ask]:
    """Every study, listed or not, by its name and kernels alone."""
    return [
        Ask(kind="study", name=study.name, kernels=partial(study.kernels, asked, scene))
        for study, asked in asked_of(scene)
    ]


def _figure_ask(kind: str, one: "Gate | Claim", scene: "Scene") -> Ask:
    """A figure that a gate or a claim names."""
    try:
        found = quantity(one.quantity)
        if isinstance(one, Claim) and is_of_study(one, scene):
            return Ask(kind=kind, name=one.id, works=(found.work,), slides=True)
        arguments = arguments_of(found, one.arguments)
        needs = needs_of(found, arguments, scene)
    except InputError as error:
        return Ask(kind=kind, name=one.id, problem=str(error))
    return Ask(
        kind=kind,
        name=one.id,
        works=(found.work,),
        needs=needs,
        models=(*found.models, *models_named(arguments)),
        slides=found.arguments.slides,
        searches=found.searches,
        kernels=partial(found.kernels, arguments, scene),
    )


def _study_asks(scene: "Scene") -> Iterable[Ask]:
    """Those that a plan lists as a whole."""
    for study, asked in asked_of(scene):
        if not study.listed:
            continue
        try:
            study.check_run(asked, scene)
        except InputError as error:
            yield Ask(
                kind="study",
                name=study.name,
                works=study.works_on(asked, scene),
                models=study.models(asked, scene),
                slides=study.slides,
                problem=str(error),
            )
            continue
        yield Ask(
            kind="study",
            name=study.name,
            told=study.told(asked, scene),
            works=study.works_on(asked, scene),
            needs=study.needs(asked, scene),
            models=study.models(asked, scene),
            slides=study.slides,
            motions=study.n_motions(asked, scene),
            kernels=partial(study.kernels, asked, scene),
        )


def wrong_figures(data: dict[str, Any]) -> list[str]:
    """A sentence for every gate and claim in a scene's plain tables whose quantity or arguments are wrong."""
    wrong = []
    for kind in ("gate", "claim"):
        entries = data.get(kind)
        for one in entries if isinstance(entries, list) else ():
            name = one.get("quantity") if isinstance(one, dict) else None
            given = one.get("arguments", {}) if isinstance(one, dict) else None
            of_run = kind == "claim" and name in RUN_FIGURES and not given  # found on the study's own runs
            if isinstance(name, str) and isinstance(given, dict) and not of_run:
                try:
                    arguments_of(quantity(name), given)
                except InputError as error:
                    wrong.append(f"{kind}.{one.get('id', '?')}: {error}")
    return wrong


def check_per_cents(scene: "Scene", overrides: tuple[str, ...]) -> None:
    """Raise InputError for a gate's band given in per cent where its figure has a unit."""
    gates = {gate.id: gate for gate in scene.gate}
    for key, _, value in (text.partition("=") for text in overrides):
        table, _, name = key.strip().partition(".")
        gate = gates.get(name.rpartition(".")[0]) if table == "gate" else None
        if gate is None or not value.rstrip().endswith("%") or gate.quantity not in QUANTITIES:
            continue
        if (unit := quantity(gate.quantity).unit) != "1":
            raise InputError(f"--set {key}={value}: {gate.quantity} is in {unit}, give the band in {unit} as well")


def kinds_of_work(asks: Iterable[Ask]) -> dict[Any, tuple[Ask, ...]]:
    """Asks without a problem by what is done for them."""
    return every_work(ask for ask in asks if not ask.problem)


def every_work(asks: Iterable[Ask]) -> dict[Any, tuple[Ask, ...]]:
    """Asks by what is done, or would be, for them."""
    found: dict[Any, tuple[Ask, ...]] = {}
    for ask in asks:
        for work in ("closed form",) if ask.closed_form else ask.works:
            found[work] = (*found.get(work, ()), ask)
    return found
