"""What a person sees in the terminal: tables and progress, drawn with rich."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.words import cell, figure, percent, seconds_in_words, work_in_words

if TYPE_CHECKING:
    from verify.identify.told import Compared
    from verify.judge.sizing import Choice
    from verify.run.gates import GateResult
    from verify.run.plan import Plan
    from verify.run.runner import RunResult
    from verify.studies.told import Column, Found
    from verify.studies.told import Table as StudyTable

NARROW = 88
"""Below this many characters a table leaves out what is wide."""


class Terminal(Console):
    """Standard output without highlighting of numbers."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(highlight=False, **settings)

    def on_broken_pipe(self) -> None:
        """Leave it to the command line, which ends without a word."""
        raise BrokenPipeError


def print_run(result: "RunResult", report: Path | None) -> None:
    """Gates, what the studies found, the verdict, where the report lies."""
    console = Terminal()
    console.print(Text(result.scene.title or result.scene.name, style="bold"))
    if result.gates:
        console.print(_gate_table(result.gates))
    for gate in result.gates:
        if not gate.passed:
            console.print(Text(f"gate {gate.id}: {gate.reason}", style="red"))
    for found in result.found.values():
        _print_found(console, found, every_table=False)
    work = work_in_words(len(result.solves), result.n_fields, result.n_motions)
    console.print(f"{_verdict(result)} in {seconds_in_words(result.seconds)}: {work}")
    if report is not None:
        console.print(f"report: {report}", soft_wrap=True, markup=False)


def _verdict(result: "RunResult") -> str:
    n_failed = sum(not gate.passed for gate in result.gates)
    if n_failed:
        return f"[bold red]{n_failed} of {len(result.gates)} gates failed[/]"
    return f"[bold green]all {len(result.gates)} gates passed[/]" if result.gates else "the scene has no gates"


def print_compared(result: "Compared", report: Path | None) -> None:
    """What somebody's model is; its modes, the candidates, the gates, where the report lies."""
    console = Terminal()
    answer, *facts = result.facts()
    console.print(Text(answer, style="bold"))
    for fact in facts:
        console.print(Text(fact))
    for table in result.tables():
        _print_table(console, table)
        for note in table.notes:
            console.print(Text(f"– {note}", style="dim"))
    console.print(_gate_table(result.gates))
    for gate in result.gates:
        if not gate.passed:
            console.print(Text(f"gate {gate.id}: {gate.reason}", style="red"))
    if report is not None:
        console.print(f"report: {report}", soft_wrap=True, markup=False)


def print_found(found: "Found") -> None:
    """What a study found: its facts and all its tables. Raises InputError where it has neither."""
    if not found.facts() and not found.tables():
        raise InputError("--of: the study has no table that a terminal holds, ask for --csv, --markdown or --json")
    _print_found(Terminal(), found, every_table=True)


def _print_found(console: Console, found: "Found", *, every_table: bool) -> None:
    for fact in found.facts():
        console.print(Text(fact))
    seen: dict[str, None] = {}
    for table in found.tables():
        if every_table or table.shown != "page":
            _print_table(console, table)
            seen |= dict.fromkeys(table.notes)
    for note in seen:
        console.print(Text(f"– {note}", style="dim"))


def _print_table(console: Console, table: "StudyTable") -> None:
    """Title, what it says before, and the rows; wide columns where there is room."""
    if table.title:
        console.print(Text(table.title, style="bold"))
    if table.before:
        console.print(Text(table.before))
    shown = [i for i, column in enumerate(table.columns) if console.width >= NARROW or not column.wide]
    heads = [table.columns[i] for i in shown]
    drawn = _empty_table(heads) if any(column.head for column in heads) else _grid(heads)
    for row in table.rows:
        drawn.add_row(*(Text(_written(row[i], table.columns[i])) for i in shown))
    console.print(drawn)


def _written(value: Any, column: "Column") -> str:
    return cell(value, column.form, column.factor, column.unit)


def _empty_table(columns: "list[Column]") -> Table:
    """Numbers stand right and are never broken where there is room; words stand left and are folded."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    for column in columns:
        table.add_column(column.head, justify="left" if column.left else "right", overflow="fold")
    return table


def _grid(columns: "list[Column]") -> Table:
    """Rows without heads: a word, and what it is about."""
    table = Table.grid(padding=(0, 1))
    for _ in columns:
        table.add_column()
    return table


def _gate_table(gates: "tuple[GateResult, ...]") -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    table.add_column("", no_wrap=True)
    table.add_column("gate", overflow="fold")
    table.add_column("measured", justify="right", overflow="fold")
    table.add_column("expected", justify="right", overflow="fold")
    table.add_column("", no_wrap=True)
    table.add_column("of band", justify="right", no_wrap=True)
    for gate in gates:
        mark = Text("pass", style="green") if gate.passed else Text("FAIL", style="bold red")
        share = "–" if gate.share is None else f"{100 * gate.share:.3g} %"
        unit = "" if gate.unit == "1" else gate.unit
        table.add_row(mark, gate.id, figure(gate.measured), gate.expected, unit, share)
    return table


def print_choices(exact_hz: float, mode: int, error: float, choices: "list[Choice]", left_out: dict[str, str]) -> None:
    """What `verify choose` found, and which of the models costs less."""
    console = Terminal()
    console.print(
        f"[bold]mode {mode}[/] within {percent(error, sign=False)} of the exact {exact_hz:.4f} Hz: enough from"
    )
    table = Table(box=SIMPLE_HEAD, pad_edge=False, show_header=True)
    for name in ("model", "N", "unknowns", "error", "error law", "time"):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=True)
    names = {one.model: MODELS[one.model].title for one in choices}
    for one in choices:
        table.add_row(
            names[one.model],
            str(one.count),
            str(one.unknowns),
            percent(one.error),
            percent(one.expected_error),
            seconds_in_words(one.run_time_s),
        )
    console.print(table)
    for one in choices:
        console.print(Text(f"{names[one.model]}: N = {one.count - 1} does not; {one.known_by}"))
        if one.smaller:
            console.print(Text(f"  N = {one.smaller} happens to do as well, with {percent(one.smaller_error)}"))
    for model, why in left_out.items():
        console.print(Text(f"– {model} is left out: {why}", style="dim"))
    console.print("[dim]errors solved at N; time of a warm solve, set-up included[/]")


def print_plan(plan: "Plan") -> None:
    """What will run, what is skipped, what cannot work."""
    console = Terminal()
    console.print(f"[bold]{plan.scene}[/] will run")
    table = Table(box=SIMPLE_HEAD, pad_edge=False)
    for name in ("model", "N", "modes", "unknowns"):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=True)
    table.add_column("vectors by", no_wrap=True)
    table.add_column("asked by", overflow="fold")
    for solve in plan.solves:
        sizes = (str(n) for n in (solve.count, solve.n_modes, solve.unknowns))
        model = " ".join([solve.model, *(f"{name}={value}" for name, value in solve.settings)])
        table.add_row(model, *sizes, solve.method, _who(solve.asked_by))
    if plan.solves:
        console.print(table)
    if plan.closed_forms:
        console.print(f"closed forms, for {_who(plan.closed_forms)}")
    if plan.assembled:
        console.print(f"matrices assembled, for {_who(plan.assembled)}")
    if plan.harmonic:
        console.print(f"harmonic fields, for {_who(plan.harmonic)}")
    if plan.compiled:
        console.print(f"equilibria and modes of the nonlinear chain, for {_who(plan.compiled)}")
    if plan.stepped:
        console.print(f"motion in time, for {_who(plan.stepped)}")
    for chosen in plan.chosen:
        console.print(f"  {chosen.what}: {chosen.why}", markup=False)
    console.print("[bold]skipped[/]")
    for skipped in plan.skipped:
        console.print(f"  {skipped.what}: {skipped.why}", markup=False)
    for problem in plan.problems:
        console.print(Text(f"cannot run: {problem.who}: {problem.why}", style="red"))


def _who(names: tuple[str, ...]) -> str:
    return ", ".join(names[:2]) + (f" and {len(names) - 2} more" if len(names) > 2 else "")


@contextmanager
def progress_bar(n_steps: int) -> Iterator[Callable[[str], None]]:
    """A bar on the error stream that disappears when done."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}/{task.total}"))
    with Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starting", total=n_steps)
        started = False

        def step(name: str) -> None:
            nonlocal started
            bar.update(task, description=name, advance=1 if started else 0)
            started = True

        yield step
