"""What a person sees in the terminal: tables and progress, drawn with rich."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from verify.words import figure, number, percent, seconds_in_words, work_in_words

if TYPE_CHECKING:
    from verify.judge.sizing import Choice
    from verify.run.gates import GateResult
    from verify.run.plan import Plan
    from verify.run.runner import RunResult
    from verify.studies.axial_inertia import AxialStudy
    from verify.studies.claims import ClaimResult
    from verify.studies.design_map import DesignMap
    from verify.studies.modes import Cell, Row
    from verify.studies.readings import ReadingsStudy
    from verify.studies.slider import MotionStudy
    from verify.studies.wave import MotorRow, Operation
    from verify.studies.work_precision import Work


class Terminal(Console):
    """Standard output without highlighting of numbers."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(highlight=False, **settings)

    def on_broken_pipe(self) -> None:
        """Leave it to the command line, which ends without a word."""
        raise BrokenPipeError


def print_run(result: "RunResult", report: Path | None) -> None:
    """Verdict, gates, where the report lies."""
    console = Terminal()
    console.print(Text(result.scene.title or result.scene.name, style="bold"))
    if result.gates:
        console.print(_gate_table(result.gates))
    for gate in result.gates:
        if not gate.passed:
            console.print(Text(f"gate {gate.id}: {gate.reason}", style="red"))
    n_failed = sum(not gate.passed for gate in result.gates)
    verdict = (
        f"[bold red]{n_failed} of {len(result.gates)} gates failed[/]"
        if n_failed
        else (f"[bold green]all {len(result.gates)} gates passed[/]" if result.gates else "the scene has no gates")
    )
    if result.motion:
        _print_slider(console, result.motion)
    if result.claims:
        _print_claims(console, result.claims)
    if result.readings:
        _print_readings(console, result.readings)
    if result.axial_inertia:
        _print_axial(console, result.axial_inertia)
    console.print(f"{verdict} in {seconds_in_words(result.seconds)}: {work_in_words(result)}")
    if report is not None:
        console.print(f"report: {report}", soft_wrap=True, markup=False)


def _print_slider(console: Console, study: "MotionStudy") -> None:
    """What the slider was found to do, how far that can be believed, and what it costs."""
    from verify.studies.claim_words import answer_in_words

    for finding in study.findings:
        console.print(Text(f"{finding.what}: {finding.found}"))
    margins = study.runs["segment"].margins
    console.print(
        Text(
            f"margins of the run: acceleration over what presses the slider on {margins.lift_off:.3g}, "
            f"(kL)^2 <theta^2> {margins.nonlinearity:.1e}"
        )
    )
    console.print(Text(answer_in_words(study.answer)))


def _print_claims(console: Console, claims: "tuple[ClaimResult, ...]") -> None:
    """Who says what, what is found, and how."""
    from verify.studies.claim_words import VERDICT, claimed_words, found_words

    for condition, group in groupby(claims, key=lambda claim: claim.condition):
        console.print(Text.assemble(("published claims", "bold"), f", found with {condition}" if condition else ""))
        for claim in group:
            found = Text(f"{claim.id}: {claimed_words(claim)}; found {found_words(claim)}")
            source = Text(f"{claim.source} ({claim.read})", style="dim")
            table = Table.grid(padding=(0, 1))
            table.add_column(width=8)
            table.add_row(VERDICT[claim.holds], found)
            table.add_row("", source)
            console.print(table)


def _print_readings(console: Console, study: "ReadingsStudy") -> None:
    """Which claims each group of readings meets, the best of each on the exact beam too, what verdicts turn with."""
    from verify.studies.claim_words import (
        best_cells,
        bound_words,
        cm_per_s,
        group_cells,
        legend,
        letter,
        searched_words,
        turn_words,
    )

    console.print(Text(f"readings: {searched_words(study)}"))
    head = ("model", "kinematics", "start", "place")
    letters = [letter(i) for i in range(len(study.claims))]
    met = _plain_table((*head, "from", "to", *letters), left=3)
    best = _plain_table((*head, "N", "mu", "K", "cm/s", "meets", "exact", "meets"), left=3)
    for group in study.groups:
        counts = [f"{group.n_meeting(i)}" for i in range(len(letters))]
        met.add_row(*group_cells(group), *(cm_per_s(v) for v in group.speeds or (None, None)), *counts)
        best.add_row(*group_cells(group), *best_cells(group))
    each = len(study.groups[0].readings)
    counted = f", and how many of {each} readings each claim holds in:" if study.claims else f" of {each} readings:"
    console.print(f"mean speeds from and to, cm/s{counted}")
    console.print(Text(legend(study)))
    console.print(met)
    chosen = "the first of those that meet most claims" if study.claims else "the first of each row"
    console.print(f"{chosen}, and the same on the exact beam")
    console.print(best)
    if study.turns:
        console.print("what a verdict turns with: share of neighbouring linear readings, one thing apart, that differ")
    for name, turns in turn_words(study):
        console.print(Text(f"{name}: {turns}"))
    for bound in study.bounds:
        console.print(Text(bound_words(bound)))


def _plain_table(names: tuple[str, ...], left: int) -> Table:
    """An empty table whose first columns are words."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    for i, name in enumerate(names):
        table.add_column(name, justify="left" if i < left else "right", overflow="fold")
    return table


def _print_axial(console: Console, study: "AxialStudy") -> None:
    """How linear the chain of rigid links was found to be."""
    for row in study.rows:
        verdict = "linear" if row.linear else "nonlinear"
        low, high = row.along
        console.print(
            Text(
                f"{row.force:g} N: {verdict}, (kL)^2 <theta^2> {row.size:.1e}; rigid links lie "
                f"{row.full.at_end:.1e} off after {1e3 * study.duration:g} ms at x = {study.x:g} m, "
                f"{low:.1e} to {high:.1e} at the tenths of the beam"
            )
        )


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


def print_table(rows: "tuple[Row, ...]") -> None:
    """The convergence table, one block for each mode."""
    console = Terminal()
    for mode, group in groupby(rows, key=lambda row: row.mode):
        block = list(group)
        console.print(f"[bold]mode {mode}[/]  exact {block[0].exact_hz:.4f} Hz")
        console.print(_mode_table(block, wide=console.width >= 88))
        notes = dict.fromkeys(note for row in block for note in row.notes)
        for note in notes:
            console.print(Text(f"– {note}", style="dim"))
        if notes:
            console.print()
    console.print(
        "[dim]frequencies in Hz, errors against exact Euler-Bernoulli and bracket width in %, order from the size "
        "before, warm solve in ms[/]"
    )


def _mode_table(rows: "list[Row]", *, wide: bool) -> Table:
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    model = ("error %", "order", "ms")
    for name in ("N", "segments", *model, "Hermite", *model, "bracket", *(["mean %"] if wide else [])):
        table.add_column(name, justify="right", no_wrap=True)
    for row in rows:
        mean = [_bare_percent(row.mean_error)] if wide else []
        width = _bare_percent(row.bracket_width).lstrip("+")
        table.add_row(str(row.count), *_cells(row.segment), *_cells(row.fem), width, *mean)
    return table


def _cells(cell: "Cell") -> tuple[str, str, str, str]:
    frequency = "–" if cell.frequency_hz is None else f"{cell.frequency_hz:.7g}"
    order = "–" if cell.order is None else f"{cell.order:.2f}"
    time = "–" if cell.run_time_s is None else f"{1e3 * cell.run_time_s:.3g}"
    return frequency, _bare_percent(cell.error), order, time


def _bare_percent(value: float | None) -> str:
    """A relative figure in per cent without the sign for it, at most nine characters."""
    if value is None:
        return "–"
    return f"{100 * value:+.4f}" if abs(value) >= 1e-4 else f"{100 * value:+.2e}".replace("e-0", "e-")


def print_motor(rows: "tuple[MotorRow, ...]") -> None:
    """The motor's figures over sizes, at the drive's frequency and at each model's own best."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    pick = ("SWR", "axis ratio", "mm/s")
    for name in ("model", "N", *pick, "best Hz", *pick):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=True)
    for row in rows:
        best = (f"{row.best.frequency_hz:.2f}", *_operation(row.best)) if row.best else ("–",) * 4
        table.add_row(row.model, str(row.count or "–"), *_operation(row.drive), *best)
    console = Terminal()
    console.print(table)
    drive = f"{rows[0].drive.frequency_hz:g} Hz"
    console.print(
        f"[dim]window [L/4, 3L/4], axis ratios over its whole half wavelengths; left at {drive}, the drive's "
        "frequency, right at the model's own best[/]"
    )
    for row in rows:
        if row.note:
            console.print(Text(f"– {row.model}{f', N = {row.count}' if row.count else ''}: {row.note}", style="dim"))


def _operation(one: "Operation") -> tuple[str, str, str]:
    """SWR, axis ratio and crest speed, at most 8, 8 and 9 characters."""
    ratio = one.standing_wave_ratio
    return f"{ratio:.5f}" if ratio < 10 else number(ratio, 4), f"{one.axis_ratio:+.5f}", f"{1e3 * one.crest_speed:+.5g}"


def print_work(work: "Work") -> None:
    """A slider's run time against its error, and both models at one error."""
    from verify.studies.claim_words import answer_in_words
    from verify.studies.work_precision import at_equal_error

    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    for name in ("model", "N", "modes", "displacement, nm", "error %", "order", "ms per ms", "set-up ms"):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=True)
    for row in work.rows:
        order = "–" if row.order is None else f"{row.order:.2f}"
        table.add_row(
            row.model,
            str(row.count),
            str(row.rows),
            f"{1e9 * row.displacement:+.6f}",
            _bare_percent(row.error),
            order,
            f"{row.run_ms_per_ms:.3g}",
            f"{row.set_up_ms:.3g}",
        )
    console = Terminal()
    console.print(table)
    console.print(
        f"[dim]errors against the exact beam at the same step, half of which changes it by "
        f"{100 * work.step_floor:.1g} %; run time of the loop for a simulated millisecond and set-up, "
        "medians of interleaved rounds[/]"
    )
    console.print(Text(answer_in_words(at_equal_error(work))))


def print_map(found: "DesignMap") -> None:
    """A design map: whose it is, its extremes, and a coarse look at the whole."""
    import numpy as np

    console = Terminal()
    console.print(Text(f"{found.quantity} of {found.of}"))
    finite = np.isfinite(found.values)
    for word, pick, other in (("least", np.argmin, np.inf), ("largest", np.argmax, -np.inf)):
        if finite.any():
            at = np.unravel_index(int(pick(np.where(finite, found.values, other))), finite.shape)
            place = ", ".join(f"{axis.name} = {axis.values[i]:g}" for axis, i in zip(found.axes, at, strict=True))
            unit = f" {found.unit}" if found.unit != "1" else ""
            console.print(f"{word} {found.quantity} = {found.values[at]:.6g}{unit} at {place}")
    if not finite.any():
        console.print("no point has a finite figure")
    console.print(_map_table(found))
    console.print(f"[dim]{finite.size} points, {found.method}; --json and --csv give them all[/]")
    for reason in found.reasons:
        console.print(Text(f"– {reason}", style="dim"))


def _map_table(found: "DesignMap") -> Table:
    """At most 13 by 7 of a map's values."""
    import numpy as np

    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    first, *second = found.axes
    table.add_column(" \\ ".join(axis.name for axis in found.axes), justify="right", no_wrap=True)
    grid = found.values.reshape(len(first.values), -1)
    few = ((grid.shape[0], 13), (grid.shape[1], 7))
    rows, columns = (np.unique(np.linspace(0, n - 1, most).round().astype(int)) for n, most in few)
    for j in columns:
        head = f"{second[0].values[j]:g}" if second else found.quantity
        table.add_column(head, justify="right", overflow="fold")
    for i in rows:
        table.add_row(f"{first.values[i]:g}", *(number(float(v), 4) for v in grid[i, columns]))
    return table


def print_choices(exact_hz: float, mode: int, error: float, choices: "list[Choice]") -> None:
    """What `verify choose` found, and which of the models costs less."""
    console = Terminal()
    console.print(
        f"[bold]mode {mode}[/] within {percent(error, sign=False)} of the exact {exact_hz:.4f} Hz: enough from"
    )
    table = Table(box=SIMPLE_HEAD, pad_edge=False, show_header=True)
    for name in ("model", "N", "unknowns", "error", "error law", "time"):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=True)
    names = {"segment": "segments", "fem": "Hermite elements"}
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
    studies_first = sorted(names, key=lambda name: name.startswith("gate "))
    short = [name.removeprefix("gate ") for name in studies_first]
    return ", ".join(short[:2]) + (f" and {len(short) - 2} more" if len(short) > 2 else "")


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
