"""What a run says in short: in the terminal, its gates as a table, and everything as plain data."""

import platform
from contextlib import suppress
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version
from math import ceil, log10
from typing import TYPE_CHECKING, Any

from verify.estimate import as_text
from verify.parallel import versions
from verify.report.result import Column, Table, plain, print_verdict
from verify.studies.base import STUDIES

if TYPE_CHECKING:
    from rich.console import Console

    from verify.report.archive import Saved
    from verify.scene.run import RunResult

LONG = 30  # rows of a table beyond which its title stands for it
VERDICTS = {True: "pass", False: "FAIL", None: "skipped"}


def study_title(run: "RunResult", name: str) -> str:
    """Heading of a study."""
    study = run.scene.studies.get(name) or STUDIES.get(name)
    return getattr(study, "title", "") or name.replace("_", " ").capitalize()


def gates_sentence(run: "RunResult") -> str:
    """'All 18 gates passed, the worst is first-mode with 65.8 % of its tolerance.', or failures and skips."""
    text, used = run.gates_in_words, [(gate.fraction, gate.id) for gate in run.gates if gate.fraction is not None]
    if used and run.passed:
        most, name = max(used)
        text += f", {'the worst is ' * (len(used) > 1)}{name} with {100.0 * most:.3g} % of its tolerance"
    return f"{text[:1].upper()}{text[1:]}."


def expected(gate: Any) -> str:
    """The acceptance criterion of a gate in the digits that its tolerance needs: '4469.9 ± 0.5', 'at least 0.9'."""
    if gate.expect is None:
        return str(gate.limits)
    value = complex(gate.expect.re, gate.expect.im) if hasattr(gate.expect, "re") else float(gate.expect)
    if gate.within is None:
        return f"contains {as_text(value, '.9g')}"
    digits = max(ceil(log10(abs(value) / gate.within)), 1) + 2 if value else 3
    return f"{as_text(value, f'.{digits}g')} ± {gate.within:g}"


def gates_table(run: "RunResult") -> Table:
    """All gates, failed ones first, whose reasons the page has above."""
    rows: list[tuple[Any, ...]] = []
    for gate in sorted(run.gates, key=lambda gate: gate.passed is not False):
        quantity = " ".join([gate.gate.quantity, *(f"{key}={value}" for key, value in gate.gate.arguments.items())])
        measured = None if gate.value is None else as_text(gate.value, ".7g")
        unit = "" if gate.unit == "1" else gate.unit
        row = VERDICTS[gate.passed], gate.id, quantity, expected(gate.gate), measured, unit, gate.fraction
        rows.append((*row, gate.gate.why if gate.passed is False else gate.reason or gate.gate.why))
    columns = [Column(name) for name in ("verdict", "gate", "quantity", "expected", "measured", "unit")]
    return Table("Gates", [*columns, Column("of tolerance", format=".3g", percent=True), Column("why")], rows)


def environment() -> dict[str, str]:
    """Versions, machine and date."""
    values = {"date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"), **versions()}
    values["system"] = f"{platform.system()} {platform.machine()}"
    for name in ("matplotlib", "exudyn", "mujoco", "pin"):
        with suppress(PackageNotFoundError):  # the engines are optional
            values[name] = version(name)
    return values


def run_data(run: "RunResult", command: str = "") -> dict[str, Any]:
    """Everything for JSON: verdict, gates, results, skipped parts, the scene's values, environment, command."""
    gates = [
        {"id": gate.id, "quantity": gate.gate.quantity, "arguments": plain(gate.gate.arguments)}
        | {"expected": expected(gate.gate), "value": plain(gate.value), "unit": gate.unit, "passed": gate.passed}
        | {"fraction": plain(gate.fraction), "reason": gate.reason, "why": gate.gate.why}
        for gate in run.gates
    ]
    scene = plain(run.scene)
    scene.pop("gate", None)
    return {
        "scene": run.scene.name,
        "passed": run.passed,
        "verdict": run.verdict.to_dict(),
        "seconds": run.seconds,
        "gates": gates,
        "results": {name: result.to_dict() for name, result in run.results.items()},
        "skipped": [{"what": part.what, "why": part.why} for part in run.skipped],
        "inputs": scene,
        "environment": environment(),
        "command": command,
    }


def print_run(run: "RunResult", console: "Console", saved: "Saved | None" = None) -> None:
    """Print a run: its verdict first, and at the end again with the gates, where a terminal stops."""
    console.print(run.scene.title or run.scene.name, style="bold")
    gates, skipped = gates_in_short(run), [gate for gate in run.gates if gate.passed is None]
    if run.results or gates.rows:
        print_verdict(run.verdict, console, brief=True)
    for name, result in run.results.items():
        console.print()
        console.print(study_title(run, name), style="bold")
        result.print(console, LONG)
    if gates.rows:
        console.print()
        gates.print(console)
    console.print()
    for reason in dict.fromkeys(gate.reason for gate in skipped):
        names = ", ".join(gate.id for gate in skipped if gate.reason == reason)
        console.print(f"skipped {names}: {reason}", style="dim")
    for warning in run.warnings:
        console.print(f"warning: {warning}", style="yellow")
    for gate in run.failed:
        console.print(f"FAIL {gate.id}: {gate.reason}", style="red")
    print_verdict(run.verdict, console, f" ({run.seconds:.3g} s)")
    console.print(gates_sentence(run))
    if saved is not None:
        console.print(f"report: {saved.page}", soft_wrap=True)


def gates_in_short(run: "RunResult") -> Table:
    """The gates that ran in five columns that fit 80 characters; the page has them in full."""
    rows = []
    for gate in (gate for gate in run.gates if gate.passed is not None):
        measured = None if gate.value is None else f"{as_text(gate.value, '.7g')} {gate.unit}".removesuffix(" 1")
        rows.append((VERDICTS[gate.passed], gate.id, measured, expected(gate.gate), gate.fraction))
    names = ("verdict", "gate", "measured", "expected")
    return Table("Gates", [*map(Column, names), Column("of tolerance", format=".3g", percent=True)], rows)
