"""A bench run: cases of every set, what fits into the time, rows, sentences, what processes of their own paid."""

from time import process_time
from typing import TYPE_CHECKING

from msgspec.structs import replace

from verify.bench.costs import compile_costs, import_costs
from verify.bench.found import BenchFound
from verify.bench.kind import Case
from verify.bench.machine import load, machine, today, versions
from verify.bench.measuring import Clock, Outcome, fitting, measured
from verify.bench.peer_set import breaks
from verify.bench.peer_set import versions as engine_versions
from verify.bench.request import Bench
from verify.bench.rows import ChildCost, Row
from verify.bench.sentences import sentences_of
from verify.bench.sets import all_cases, settled
from verify.errors import InputError
from verify.peers.breaking import Break
from verify.studies.kind import Progress

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene


SHARED = (
    "cold: methods of a set are compiled in turn in one process, what several of them need is told of the first alone"
)


def benched(
    asked: Bench,
    scene: "Scene",
    bench: "Workbench",
    step: Progress = lambda step: None,
    clock: Clock = process_time,
) -> BenchFound:
    """Everything a [bench] asks for. `step` is told the set about to be run. Raises InputError."""
    cases, notes, refused = all_cases(asked, scene, bench)
    left_out, estimate = fitting(cases, asked.seconds)
    outcomes, unanswered = _outcomes(cases, left_out, asked, step, clock)
    refused += unanswered
    if not any(one.row.rounds for _, found in outcomes for one in found):
        short = [f"all takes longer than seconds = {asked.seconds:g}, give more"] * bool(left_out)
        raise InputError(f"bench: nothing is left to measure: {'; '.join([*short, *refused, *notes])}")
    pushed: tuple[Break, ...] = ()
    if asked.push:
        step("bench, other engines pushed")
        pushed, unbroken = breaks(scene, settled(asked, scene))
        notes += unbroken
    sets = tuple(dict.fromkeys(case.set for case in cases))
    if asked.imports:
        step("bench, imports")
    imports = import_costs(sets) if asked.imports else []
    if asked.cold:
        step("bench, compiling")
    compiling = compile_costs(scene, sets) if asked.cold else {}
    if asked.cold and not compiling:
        notes.append(f"cold: nothing of {', '.join(sets)} is compiled")
    elif asked.cold:
        notes.append(SHARED)
    return BenchFound(
        scene=scene.name,
        date=today(),
        machine=machine(),
        versions=versions() | engine_versions(),
        load=load(),
        costs=(*imports, *(ChildCost(f"compile {name}, {one}", s) for (name, one), s in compiling.items())),
        rows=tuple(_compiled(one.row, compiling) for _, found in outcomes for one in found),
        sentences=tuple(told for case, found in outcomes for told in sentences_of(case, found, scene.name)),
        pushed=pushed,
        refused=tuple(refused),
        notes=tuple(notes),
        estimate_s=estimate,
    )


def _outcomes(
    cases: list[Case], left_out: dict[int, str], asked: Bench, step: Progress, clock: Clock
) -> tuple[list[tuple[Case, list[Outcome]]], list[str]]:
    """(every case with what came of its methods, why others have no answer)."""
    outcomes: list[tuple[Case, list[Outcome]]] = []
    refused: list[str] = []
    shown = ""
    for case in cases:
        if case.set != shown:
            step(f"bench, {case.name}")
            shown = case.set
        try:
            outcomes.append((case, measured(case, left_out, asked.rounds, asked.seconds / len(cases), clock)))
        except InputError as error:
            refused.append(f"{case.name} is left out: {error}")
    return outcomes, refused


def _compiled(row: Row, compiling: dict[tuple[str, str], float]) -> Row:
    """The row with what its method's compiling took, where that was timed."""
    seconds = compiling.get((row.set, row.method))
    return row if seconds is None or row.left_out else replace(row, compile_s=seconds)
