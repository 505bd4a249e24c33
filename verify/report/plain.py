"""Results as plain data and text: JSON, CSV, Markdown."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec

from verify.errors import InputError
from verify.scenes.scene import literal

if TYPE_CHECKING:
    from verify.judge.sizing import Choice
    from verify.judge.workbench import Workbench
    from verify.motion.result import Motion
    from verify.run.runner import RunResult
    from verify.studies.axial_inertia import AxialStudy
    from verify.studies.modes import Row
    from verify.studies.readings import Reading, ReadingsStudy
    from verify.studies.slider import MotionStudy
    from verify.studies.wave import WaveStudy
    from verify.studies.work_precision import Work


def run_as_plain(result: "RunResult", report: Path | None) -> dict[str, Any]:
    """A run for `verify run --json`."""
    return {
        "scene": result.scene.name,
        "passed": result.passed,
        "gates": msgspec.to_builtins(result.gates),
        "spectrum": msgspec.to_builtins(result.spectrum),
        "convergence": [flat_row(row) for row in result.convergence or ()],
        "sensitivity": msgspec.to_builtins(result.sensitivity),
        "wave": wave_as_plain(result.wave) if result.wave else None,
        "motion": motion_as_plain(result.motion) if result.motion else None,
        "readings": readings_as_plain(result.readings) if result.readings else None,
        "claims": [msgspec.to_builtins(one) | {"departure": one.departure} for one in result.claims],
        "axial_inertia": axial_as_plain(result.axial_inertia) if result.axial_inertia else None,
        "solves": msgspec.to_builtins(result.solves),
        "seconds": result.seconds,
        "report": str(report) if report else None,
    }


def wave_as_plain(study: "WaveStudy") -> dict[str, Any]:
    """A wave study: the motor's rows and operating points."""
    return {
        "rows": msgspec.to_builtins(study.rows),
        "points": msgspec.to_builtins(study.points),
        "notes": list(study.notes),
    }


def motion_as_plain(study: "MotionStudy") -> dict[str, Any]:
    """A slider study: displacements and margins by model, findings, work against error."""
    runs = {
        model: {
            "displacement": run.displacement,
            "mean_speed": run.mean_speed,
            "largest_friction": largest(run),
            "condition": msgspec.to_builtins(study.conditions[model]),
            "figures": study.figures[model],
            "coupling": msgspec.to_builtins(run.coupling),
            "margins": msgspec.to_builtins(run.margins),
            "ledger": msgspec.to_builtins(run.ledger),
            "statistics": msgspec.to_builtins(run.statistics),
            "notes": list(run.notes),
        }
        for model, run in study.runs.items()
    }
    return {"runs": runs, "findings": msgspec.to_builtins(study.findings)} | work_as_plain(study.work)


def work_as_plain(work: "Work") -> dict[str, Any]:
    """Run time against error, and both models at one error or why they are not compared."""
    from verify.studies.work_precision import Comparison, at_equal_error

    answer = at_equal_error(work)
    plain: dict[str, Any] = msgspec.to_builtins(answer)
    if isinstance(answer, Comparison):
        plain |= {"ratio": answer.ratio, "whole_ratio": answer.whole_ratio}
    return {"work": msgspec.to_builtins(work.rows), "step_floor": work.step_floor, "answer": plain}


def readings_as_plain(study: "ReadingsStudy") -> dict[str, Any]:
    """All readings with their conditions, figures and verdicts; the best of each group on the exact beam beside."""
    claims = [claim.id for claim in study.claims]

    def plain(reading: "Reading | None") -> dict[str, Any] | None:
        found: dict[str, Any] | None = msgspec.to_builtins(reading)
        return found and found | {"met": dict(zip(claims, found["met"], strict=True))}

    groups = [
        {"readings": [plain(one) for one in group.readings], "best": plain(group.best), "exact": plain(group.exact)}
        for group in study.groups
    ]
    return {
        "claims": claims,
        "searched": study.searched,
        "n_runs": study.n_runs,
        "groups": groups,
        "turns": msgspec.to_builtins(study.turns),
        "bounds": msgspec.to_builtins(study.bounds),
    }


def axial_as_plain(study: "AxialStudy") -> dict[str, Any]:
    """A study of a chain's axial inertia: departures over the force, models side by side at one of them."""
    return {
        "count": study.count,
        "duration": study.duration,
        "x": study.x,
        "rows": msgspec.to_builtins(study.rows),
        "shown": study.shown,
        "beside": msgspec.to_builtins(study.beside),
    }


def largest(run: "Motion") -> float:
    """The largest friction force of a run, newton."""
    return float(abs(run.friction).max())


def flat_row(row: "Row") -> dict[str, Any]:
    """One row of the convergence table with one level of names."""
    flat: dict[str, Any] = {"mode": row.mode, "count": row.count, "exact_hz": row.exact_hz}
    for model in ("segment", "fem"):
        flat |= {f"{model}_{name}": value for name, value in msgspec.to_builtins(getattr(row, model)).items()}
    return flat | {"bracket_width": row.bracket_width, "mean_error": row.mean_error, "notes": list(row.notes)}


def finite(data: Any) -> Any:
    """Plain data with None for numbers that JSON cannot hold."""
    if isinstance(data, float):
        return data if math.isfinite(data) else None
    if isinstance(data, dict):
        return {key: finite(value) for key, value in data.items()}
    return [finite(value) for value in data] if isinstance(data, list | tuple) else data


def mode_number(text: str) -> int:
    """A mode number as typed. Raises InputError."""
    value = literal(text, "mode")
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"mode = {text!r}: give a whole number from 1")
    return value


def accuracy(text: str) -> float:
    """A relative error as typed, '1%' or '0.01'. Raises InputError unless it lies between 1e-12 and 1."""
    value = literal(text.strip().removesuffix("%"), "error")
    number = isinstance(value, int | float) and not isinstance(value, bool)
    error = float(value) / (100.0 if text.strip().endswith("%") else 1.0) if number else 0.0
    if not 1e-12 <= error < 1.0:
        raise InputError(f"error = {text!r}: give a relative error from 1e-12 up to 1, for instance 1% or 0.01")
    return error


def choice_as_plain(bench: "Workbench", mode: int, error: float, choices: "list[Choice]") -> dict[str, Any]:
    """An answer of `verify choose --json`."""
    return {"mode": mode, "error": error, "exact_hz": bench.exact_hz(mode), "choices": msgspec.to_builtins(choices)}
