"""A scene run: whatever it asks for is evaluated once, and nothing else."""

from collections.abc import Iterable
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

import msgspec

from verify.errors import InputError
from verify.judge.workbench import Solve, Workbench
from verify.models.ahead import compiled_ahead
from verify.run.applies import applicable, not_applicable, that_change
from verify.run.asks import Ask, asks_of, studies_in_turn
from verify.run.gates import GateResult, judge, set_aside
from verify.run.kernels_asked import kernels_of, ready_first
from verify.scenes.scene import Scene, load_scene
from verify.studies.catalogue import STUDIES, asked_of
from verify.studies.kind import Progress, Study
from verify.studies.told import Found


class RunResult(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Everything a scene asked for."""

    scene: Scene
    gates: tuple[GateResult, ...]
    found: dict[str, Found]
    """What the studies found, by their names; claims among them are shown, they pass no judgement on the run."""
    solves: tuple[Solve, ...]
    n_fields: int
    """How many driven fields were solved, those of superposed maps not counted."""
    n_motions: int
    """How many simulations in time gates and studies did."""
    seconds: float
    others: dict[str, int] = msgspec.field(default_factory=dict)
    """Work of kinds that no workbench solves, by name."""

    @property
    def passed(self) -> bool:
        """Whether every gate passed that applies."""
        return not self.failed

    @property
    def failed(self) -> tuple[GateResult, ...]:
        """Gates outside their bands, or that could not be evaluated."""
        return tuple(gate for gate in self.gates if gate.passed is False)

    @property
    def set_aside(self) -> tuple[GateResult, ...]:
        """Gates that do not apply to what the scene was run with."""
        return tuple(gate for gate in self.gates if not gate.applicable)


def workbench_for(scene: Scene, *, gates_only: bool = False) -> Workbench:
    """A workbench that knows everything the scene will ask for, so that each size is solved once."""
    return _workbench(scene, asks_of(scene, gates_only=gates_only))


def _workbench(scene: Scene, asks: Iterable[Ask]) -> Workbench:
    return Workbench(scene.beam, (need for ask in asks for need in ask.needs))


def run_scene(
    scene: Scene | str | Path, progress: Progress = lambda step: None, overrides: tuple[str, ...] = ()
) -> RunResult:
    """Run a scene (or a packaged name, or a path). `progress` is told each step before it starts.

    Of a scene that was loaded with `overrides` the gates are set aside that were stated for something else. Raises
    InputError where the scene is wrong; a gate that fails or cannot be evaluated is in the result.
    """
    asked_scene = scene if isinstance(scene, Scene) else load_scene(scene, overrides)
    overrides = overrides if isinstance(scene, Scene) else that_change(scene, overrides)
    start = perf_counter()
    aside = not_applicable(asked_scene, overrides)
    applying = applicable(asked_scene, overrides)
    asks = asks_of(applying)
    bench = _workbench(applying, asks)
    gates: dict[int, GateResult] = {}
    found: dict[str, Found] = {}
    studies = list(asked_of(asked_scene))
    tasks = [*_gate_asks(asked_scene, asks), *studies_in_turn(asked_scene)]
    with compiled_ahead(partial(kernels_of, asks)) as ahead:
        for number in ready_first(tasks, ahead):
            if number < len(asked_scene.gate):
                gate = asked_scene.gate[number]
                progress(f"gate {gate.id}")
                why = aside.get(gate.id)
                gates[number] = set_aside(gate, why) if why else judge(gate, asked_scene, bench)
            else:
                study, asked = studies[number - len(asked_scene.gate)]
                found[study.name] = _done(study, asked, asked_scene, bench, found, progress).under(overrides)
    return RunResult(
        scene=asked_scene,
        gates=tuple(gates[number] for number in range(len(gates))),
        found=found,
        solves=tuple(sorted(bench.solves, key=lambda one: (one.model, one.count, repr(one.settings)))),
        n_fields=bench.n_fields,
        n_motions=bench.n_motions + sum(one.motions() for one in found.values()),
        seconds=perf_counter() - start,
        others=bench.others,
    )


def _gate_asks(scene: Scene, asks: Iterable[Ask]) -> list[Ask]:
    """Of every gate; those that are set aside ask for nothing."""
    asked = {ask.name: ask for ask in asks if ask.kind == "gate"}
    return [asked.get(gate.id, Ask(kind="gate", name=gate.id)) for gate in scene.gate]


def _done(
    study: Study[Any, Any], asked: Any, scene: Scene, bench: Workbench, found: dict[str, Found], progress: Progress
) -> Found:
    """What a study found. Raises InputError, also for one of another package that breaks, by its name."""
    try:
        done: Found = study.run(asked, scene, bench, found, progress)
    except InputError:
        raise
    except Exception as error:
        if study.name in STUDIES.built_in:
            raise
        raise InputError(f"study = {study.name!r} breaks: {type(error).__name__}: {error}") from error
    return done


def n_steps(scene: Scene) -> int:
    """How many times `run_scene` reports progress."""
    return len(scene.gate) + sum(study.n_steps(asked, scene) for study, asked in asked_of(scene))
