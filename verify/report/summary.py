"""What a run says in short: its verdict, its gates as a table, and everything as plain data."""

from contextlib import suppress
from datetime import UTC, datetime
from math import ceil, log10
from typing import TYPE_CHECKING, Any

from verify.report.result import MISSING, Column, Table, plain

if TYPE_CHECKING:
    from verify.scene.run import RunResult

VERDICTS = {True: "pass", False: "FAIL", None: "skipped"}


def study_title(run: "RunResult", name: str) -> str:
    """Heading of a study."""
    from verify.studies.base import STUDIES

    study = run.scene.studies.get(name) or STUDIES.get(name)
    return getattr(study, "title", "") or name.replace("_", " ").capitalize()


def gates_sentence(run: "RunResult") -> str:
    """'All 18 gates passed, the worst is first-mode with 65.8 % of its tolerance.', or failures and skips."""
    text, used = run.gates_in_words, [(one.fraction, one.id) for one in run.gates if one.fraction is not None]
    if used and run.passed:
        most, name = max(used)
        text += f", {'the worst is ' * (len(used) > 1)}{name} with {100.0 * most:.3g} % of its tolerance"
    return f"{text[:1].upper()}{text[1:]}."


def expected(gate: Any) -> str:
    """The acceptance criterion of a gate in the digits that its tolerance needs: '4469.9 ± 0.5', 'at least 0.9'."""
    if gate.expect is not None:
        if gate.within is None:
            return f"contains {value_text(gate.expect, '.9g')}"
        size = abs(complex(gate.expect.re, gate.expect.im)) if hasattr(gate.expect, "re") else abs(gate.expect)
        digits = max(ceil(log10(size / gate.within)), 1) + 2 if size else 3
        return f"{value_text(gate.expect, f'.{digits}g')} ± {gate.within:g}"
    return str(gate.limits)


def value_text(value: Any, form: str = ".7g") -> str:
    """A measured value: a number, a complex number, or a bracket as 'lower to upper'."""
    if value is None:
        return MISSING
    if hasattr(value, "lower"):
        return f"{value.lower:{form}} to {value.upper:{form}}"
    if hasattr(value, "re"):
        value = complex(value.re, value.im)
    if isinstance(value, complex):
        return f"{value.real:{form}} {'+-'[value.imag < 0]} {abs(value.imag):{form}}i"
    return format(value, form)


def gates_table(run: "RunResult") -> Table:
    """All gates, failed ones first."""
    gates = sorted(run.gates, key=lambda gate: gate.passed is not False)
    rows: list[tuple[Any, ...]] = []
    for one in gates:
        quantity = " ".join([one.gate.quantity, *(f"{key}={value}" for key, value in one.gate.arguments.items())])
        measured = expected(one.gate), value_text(one.value), "" if one.unit == "1" else one.unit, one.fraction
        rows.append((VERDICTS[one.passed], one.gate.id, quantity, *measured, one.reason or one.gate.why))
    columns = [Column(name) for name in ("verdict", "gate", "quantity", "expected", "measured", "unit")]
    return Table("Gates", [*columns, Column("of tolerance", format=".3g", percent=True), Column("why")], rows)


def environment() -> dict[str, str]:
    """Versions, machine and date."""
    import platform
    from importlib.metadata import PackageNotFoundError, version

    from verify.parallel import versions

    values = {"date": datetime.now(UTC).strftime("%Y-%m-%d %H:%M UTC"), **versions()}
    values["system"] = f"{platform.system()} {platform.machine()}"
    for name in ("matplotlib", "exudyn", "mujoco", "pin"):
        with suppress(PackageNotFoundError):  # the engines are optional
            values[name] = version(name)
    return values


def run_data(run: "RunResult", command: str = "") -> dict[str, Any]:
    """Everything for JSON: verdict, gates, results, skipped parts, the scene's values, environment, command."""
    gates = [
        {"id": one.gate.id, "quantity": one.gate.quantity, "arguments": plain(one.gate.arguments)}
        | {"expected": expected(one.gate), "value": plain(one.value), "unit": one.unit, "passed": one.passed}
        | {"fraction": plain(one.fraction), "reason": one.reason, "why": one.gate.why}
        for one in run.gates
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
        "skipped": [{"what": one.what, "why": one.why} for one in run.skipped],
        "inputs": scene,
        "environment": environment(),
        "command": command,
    }
