"""A scene run: whatever it asks for is evaluated once, and nothing else."""

from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import TYPE_CHECKING, Any

import msgspec

from verify.judge.workbench import Solve, Workbench
from verify.run.gates import GateResult, judge
from verify.run.plan import CHAIN_IN_TIME, STUDIES, asks_of
from verify.scenes.scene import Scene, load_scene

if TYPE_CHECKING:
    from verify.studies.axial_inertia import AxialStudy
    from verify.studies.claims import ClaimResult
    from verify.studies.modes import Row, SensitivityStudy, SpectrumStudy
    from verify.studies.readings import ReadingsStudy
    from verify.studies.slider import MotionStudy
    from verify.studies.wave import WaveStudy


class RunResult(msgspec.Struct, frozen=True, kw_only=True):
    """Everything a scene asked for."""

    scene: Scene
    gates: tuple[GateResult, ...]
    spectrum: "SpectrumStudy | None"
    convergence: "tuple[Row, ...] | None"
    sensitivity: "SensitivityStudy | None"
    wave: "WaveStudy | None"
    motion: "MotionStudy | None"
    readings: "ReadingsStudy | None"
    axial_inertia: "AxialStudy | None"
    claims: "tuple[ClaimResult, ...]"
    """Shown beside what is found; they pass no judgement on the run."""
    solves: tuple[Solve, ...]
    n_fields: int
    """How many driven fields were solved, those of superposed maps not counted."""
    n_motions: int
    """How many simulations gates asked for, those of a slider's studies, and those of a study of axial inertia."""
    seconds: float

    @property
    def passed(self) -> bool:
        """Whether every gate passed."""
        return all(gate.passed for gate in self.gates)


def workbench_for(scene: Scene, *, gates_only: bool = False) -> Workbench:
    """A workbench that knows everything the scene will ask for, so that each size is solved once."""
    return Workbench(scene.beam, (need for ask in asks_of(scene, gates_only=gates_only) for need in ask.needs))


def run_scene(scene: Scene | str | Path, progress: Callable[[str], None] = lambda step: None) -> RunResult:
    """Run a scene (or a packaged name, or a path). `progress` is told each step before it starts.

    Raises InputError where the scene is wrong; a gate that fails or cannot be evaluated is in the result.
    """
    found = scene if isinstance(scene, Scene) else load_scene(scene)
    start = perf_counter()
    bench = workbench_for(found)
    gates = []
    for gate in found.gate:
        progress(f"gate {gate.id}")
        gates.append(judge(gate, found, bench))
    studied = _studies(found, bench, progress)
    claims: tuple[ClaimResult, ...] = ()
    if found.claim:
        from verify.studies.claims import claim_results

        claims = claim_results(found, bench, studied["motion"], progress)
    return RunResult(
        scene=found,
        gates=tuple(gates),
        **studied,
        claims=claims,
        solves=tuple(bench.solves),
        n_fields=bench.n_fields,
        n_motions=_n_motions(found, bench, **studied),
        seconds=perf_counter() - start,
    )


def _studies(scene: Scene, bench: Workbench, progress: Callable[[str], None]) -> dict[str, Any]:
    """Every study of `RunResult` by name, None where the scene does not ask for it."""
    done: dict[str, Any] = dict.fromkeys(STUDIES)
    if scene.spectrum or scene.convergence or scene.sensitivity:
        from verify.studies import modes as studies

        if scene.spectrum:
            progress("error spectrum")
            done["spectrum"] = studies.spectrum(bench, scene.spectrum)
        if scene.convergence:
            done["convergence"] = studies.convergence(bench, scene.convergence, progress)
        if scene.sensitivity:
            done["sensitivity"] = studies.sensitivity(scene.beam, scene.sensitivity)
    if scene.wave:
        from verify.studies.wave import wave_study

        done["wave"] = wave_study(scene, bench, scene.wave, progress)
    if scene.motion and scene.slider:
        from verify.studies.slider import motion_study

        done["motion"] = motion_study(scene, progress)
    if scene.readings:
        from verify.studies.readings import readings_study

        done["readings"] = readings_study(scene, progress)
    if scene.axial_inertia:
        from verify.studies.axial_inertia import axial_study

        done["axial_inertia"] = axial_study(scene, progress)
    return done


def _n_motions(scene: Scene, bench: Workbench, motion: Any, readings: Any, axial_inertia: Any, **others: Any) -> int:
    """Simulations of a beam or a chain behind gates and studies."""
    chains = sum(gate.quantity in CHAIN_IN_TIME for gate in scene.gate)
    axial = 3 * len(axial_inertia.rows) + len(axial_inertia.lines) if axial_inertia else 0
    slid = (len(motion.runs) if motion else 0) + (readings.n_runs if readings else 0)
    return len(bench.motions) + chains + axial + slid


def n_steps(scene: Scene) -> int:
    """How many times `run_scene` reports progress."""
    sizes = len(scene.convergence.counts) if scene.convergence else 0
    waves = 2 * len(scene.wave.counts) + 1 if scene.wave else 0
    motion = 11 if scene.motion and scene.slider else 0
    asked = scene.readings
    slid = asked.n_readings + asked.n_chain(scene) + min(asked.shown, asked.n_groups) if asked else 0
    axial = len(scene.axial_inertia.forces) + 1 if scene.axial_inertia else 0
    return len(scene.gate) + bool(scene.spectrum) + sizes + waves + motion + slid + axial + len(scene.claim)
