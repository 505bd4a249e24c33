"""A scene run: every gate and study once, over one solution cache; a gate alone; what a run would do, unsolved."""

from collections.abc import Callable, Sequence
from math import hypot, isfinite
from pathlib import Path
from time import perf_counter
from typing import Any, TypeAlias

import msgspec

from verify.analysis.solution_cache import Bracket, SolutionCache
from verify.analysis.verdict import Margin, Verdict, verdict_of, void
from verify.blas import one_blas_thread
from verify.errors import InputError, raise_all
from verify.quantities.base import QUANTITIES, evaluate
from verify.report.result import Result
from verify.scene.load import load_scene, study_errors
from verify.scene.model import Complex, Gate, Scene
from verify.studies.base import STUDIES, result_of, studies_of
from verify.studies.tables import premises

ADD = "add a gate or a study, see docs/your-beam.md"
Progress: TypeAlias = Callable[[str], None]


class GateResult(msgspec.Struct, frozen=True, kw_only=True):
    """One gate's verdict: the row of a terminal or a page, and the outcome of a pytest item."""

    gate: Gate
    value: Any = None
    """A float, a complex number or a `Bracket`; None where the gate was skipped or could not be evaluated."""
    unit: str = ""
    passed: bool | None = None  # None where the gate was skipped
    fraction: float | None = None
    """Fraction of the tolerance: 0 in the middle of the band, 1 at its edge; None where the band has no width."""
    reason: str = ""  # why it failed or was skipped
    seconds: float = 0.0
    margins: tuple[Margin, ...] = ()
    """What its value rests on: units, drive, slider's sag. Errors of the model are a matter of the tolerance."""

    @property
    def id(self) -> str:
        """Id of the gate."""
        return self.gate.id


class PlanRow(msgspec.Struct, frozen=True):
    """One gate or study of a scene, and whether it runs."""

    what: str
    kind: str
    runs: bool
    why: str = ""  # why it is skipped; of a gate that runs its quantity


class RunResult(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Everything that a scene's gates and studies computed."""

    scene: Scene
    gates: tuple[GateResult, ...]
    """In the order of the file, skipped ones included."""
    results: dict[str, Result]
    """Results of the studies by the names of their sections."""
    skipped: tuple[PlanRow, ...]
    """Gates and studies that did not run, with the reason."""
    warnings: tuple[str, ...]
    """Implausible gates."""
    margins: tuple[Margin, ...] = ()
    """Units, linear theory under the drive and under the weight of the slider."""
    seconds: float

    def __repr__(self) -> str:
        """The verdict and the gates in words."""
        return f"<RunResult {self.scene.name}: {self.verdict.headline} {self.gates_in_words}>"

    @property
    def failed(self) -> tuple[GateResult, ...]:
        """Gates outside their bands, or that could not be evaluated."""
        return tuple(result for result in self.gates if result.passed is False)

    @property
    def passed(self) -> bool:
        """Whether no gate failed; not where the scene has gates, and neither they nor a study ran."""
        skipped = all(gate.passed is None for gate in self.gates)
        return not self.failed and not (self.gates and skipped and not self.results)

    @property
    def gates_in_words(self) -> str:
        """'all 27 gates passed', '2 of 27 gates failed', 'no gate ran'; with the number that `--set` skips."""
        judged = sum(gate.passed is not None for gate in self.gates)
        every = f"all {judged} gates" if judged > 1 else "1 gate"
        text = f"{every} passed" if judged else "no gate ran" if self.gates else "the scene has no gates"
        text = f"{len(self.failed)} of {judged} gate{'s' * (judged > 1)} failed" if self.failed else text
        skipped = len(self.gates) - judged
        return f"{text} ({skipped} skipped: --set changes the values that they are stated for)" if skipped else text

    @property
    def verdict(self) -> Verdict:
        """The worst of all studies, of linear theory under the drive, and of the gates."""
        margins = [*self.margins, *(margin for result in self.results.values() for margin in result.margins)]
        judged = any(gate.passed is not None for gate in self.gates)
        if self.failed:
            failed = ", ".join(result.id for result in self.failed)
            margins.append(void("gates", f"{self.gates_in_words}, {failed}", leads=True))
        elif not (judged or self.results):
            remedy = "leave --set out, or set gate.ID.expect for the new values" if self.gates else ADD
            margins.append(void("the run", "no study and no gate ran, so nothing is judged", remedy))
        verdict = verdict_of(margins)
        if verdict.level != "trusted" or any(margin.is_error for margin in margins) or not judged:
            return verdict
        headline = f"Trusted as far as its gates: {self.gates_in_words}."
        return Verdict(level="trusted", headline=headline, margins=verdict.margins)


def scene_warnings(scene: Scene) -> tuple[str, ...]:
    """A sentence for each gate that accepts any negative error."""
    return tuple(
        f"gate {gate.id}: at_most alone accepts any negative value: give at_least too, or expect and within"
        for gate in scene.gate
        if gate.at_most is not None and gate.at_least is None
        if gate.quantity.endswith("error") and not gate.quantity.endswith(("shape_error", "curvature_error"))  # norms
    )


@one_blas_thread()
def run_scene(
    scene: Scene | str | Path, progress: Progress = lambda step: None, overrides: Sequence[str] = ()
) -> RunResult:
    """Run a scene (or a packaged name, or a path). `progress` is called with the name of each step before it starts.

    Overrides ('beam.length=0.4') skip the gates stated for the values of the file. Raises InputError where the scene
    is invalid or a study cannot run; a gate that fails or cannot be evaluated is in the result.
    """
    start = perf_counter()
    loaded, rows = _planned(scene, overrides)
    cache = SolutionCache(loaded.beam)
    gates = []
    for gate, row in zip(loaded.gate, rows, strict=False):
        progress(f"gate {gate.id}")
        if row.runs:
            gates.append(run_gate(gate, loaded, cache))
        else:
            gates.append(GateResult(gate=gate, unit=QUANTITIES[gate.quantity].unit, reason=row.why))
    results = {}
    for name, _ in studies_of(loaded):
        progress(name)
        results[name] = result_of(name, loaded, cache, progress)
    return RunResult(
        scene=loaded,
        gates=tuple(gates),
        results=results,
        skipped=tuple(row for row in rows if not row.runs),
        warnings=scene_warnings(loaded),
        margins=premises(loaded, cache),
        seconds=perf_counter() - start,
    )


def plan(scene: Scene | str | Path, overrides: Sequence[str] = ()) -> tuple[PlanRow, ...]:
    """Which gates and studies of a scene run, which are skipped and why. Nothing is solved. Raises InputError."""
    return tuple(_planned(scene, overrides)[1])


def _planned(scene: Scene | str | Path, overrides: Sequence[str]) -> tuple[Scene, list[PlanRow]]:
    """The scene, and its gates in their order, then the studies."""
    loaded = scene if isinstance(scene, Scene) else load_scene(scene, overrides)
    running = dict(studies_of(loaded))
    if loaded is scene:  # which may be built in Python
        raise_all(list(study_errors(loaded, running | loaded.studies)))
    skip = skipped_gates(loaded, overrides)
    rows = [PlanRow(gate.id, "gate", gate.id not in skip, skip.get(gate.id, gate.quantity)) for gate in loaded.gate]
    rows += [PlanRow(name, "study", True) for name in running]
    tables = {name: f"[{name}]" for name in STUDIES} | {"claims": "[[claim]]", "large-motion": "[base]"}
    absent = {name: f"no {table} in the scene" for name, table in tables.items()}
    absent |= dict.fromkeys(loaded.studies, "settings of quantities in time: the study needs [slider]")
    rows += [PlanRow(name, "study", False, absent[name]) for name in STUDIES if name not in running]
    return loaded, rows


def skipped_gates(scene: Scene, overrides: Sequence[str]) -> dict[str, str]:
    """Gates by id that hold for other values than `--set` gives, and why.

    A gate runs where its quantity reads no overridden table and its arguments are its own, or where its band was set
    as well.
    """
    keys = list(dict.fromkeys(text.partition("=")[0].strip() for text in overrides))
    skip = {}
    for i, gate in enumerate(scene.gate):
        names = (f"gate.{gate.id}", f"gate.{i}")
        if gate.quantity not in QUANTITIES or any(
            f"{name}.{limit}" in keys for name in names for limit in ("expect", "at_least", "at_most")
        ):
            continue
        reads = QUANTITIES[gate.quantity].reads
        arguments = [key for key in keys if key.startswith(tuple(f"{name}.arguments" for name in names))]
        values = [key for key in keys if key.split(".")[0] in reads]
        if arguments or values:
            skip[gate.id] = f"stated for other values: --set {', '.join(arguments or values)}"
    return skip


def run_gate(gate: Gate, scene: Scene, cache: SolutionCache) -> GateResult:
    """Evaluate one gate. Never raises: a gate that cannot be evaluated fails with the reason."""
    start = perf_counter()
    unit, value, fraction, margins = "", None, None, tuple[Margin, ...]()
    try:
        unit = QUANTITIES.named(gate.quantity).unit_of(gate.arguments)
        value = evaluate(gate.quantity, gate.arguments, scene, cache)
        reason, fraction = _verdict(gate, value)
        margins = premises(scene, cache, QUANTITIES[gate.quantity].reads)
    except InputError as error:
        reason = f"cannot be evaluated: {error}"
    except Exception as error:  # a defect of this package, or of another one's quantity
        reason = f"cannot be evaluated: {type(error).__name__}: {error}"
    seconds = perf_counter() - start
    told: dict[str, Any] = {"value": value, "unit": unit, "fraction": fraction, "reason": reason, "margins": margins}
    return GateResult(gate=gate, passed=not reason, seconds=seconds, **told)


def _verdict(gate: Gate, value: Any) -> tuple[str, float | None]:
    """(reason for failing or '', fraction of the tolerance)."""
    expected, within = gate.expect, gate.within
    if isinstance(value, Bracket) and isinstance(expected, float) and within is None:
        inside = value.lower < expected < value.upper
        outside = f"{value.lower!r} to {value.upper!r} does not contain {expected!r}"
        return "" if inside else outside, _fraction(expected, value.lower, value.upper)
    if isinstance(value, complex) and isinstance(expected, Complex) and within is not None:
        fraction = hypot(value.real - expected.re, value.imag - expected.im) / within
        return "" if fraction <= 1.0 else f"{value!r} lies outside the disc", fraction
    if isinstance(value, float | int) and not isfinite(value):
        return f"{value!r} is not finite", None
    if isinstance(value, float | int) and isinstance(expected, float) == (within is not None):
        low, high = gate.bounds
        if isinstance(expected, float) and within is not None:
            low, high = expected - within, expected + within
        side = f"below {low!r}" if value < low else f"above {high!r}"
        return "" if low <= value <= high else f"{value!r} lies {side}", _fraction(value, low, high)
    kinds = {Bracket: "a bracket needs expect alone", complex: "a complex value needs expect = { re, im } with within"}
    remedy = kinds.get(type(value), "a real value needs expect with within, or at_least, at_most")
    return f"{value!r}: {remedy}", None


def _fraction(value: float, low: float, high: float) -> float | None:
    """Distance from the band's middle over half its width; of a one-sided band the ratio to its limit."""
    if isfinite(low) and isfinite(high):
        half = 0.5 * (high - low)
        return abs(value - 0.5 * (low + high)) / half if half > 0 else None
    if isfinite(high) and high > 0:
        return max(value, 0.0) / high
    return low / value if isfinite(low) and low > 0 and value > 0 else None
