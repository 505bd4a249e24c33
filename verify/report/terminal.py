"""What a person sees in the terminal: tables and progress, drawn with rich."""

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from rich.box import SIMPLE_HEAD
from rich.console import Console, ConsoleOptions, RenderableType
from rich.measure import Measurement
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from verify.errors import InputError, printable
from verify.run.gates import shown_expectation
from verify.run.remarks import remarks_on
from verify.run.scale import scale_in_words
from verify.words import cell, figure, in_a_row, percent, seconds_in_words, share_of_band, told_once, work_in_words

if TYPE_CHECKING:
    from verify.identify.shapes_told import ShapesJudged
    from verify.identify.told import Compared
    from verify.judge.sizing import Choice
    from verify.judge.workbench import Workbench
    from verify.run.gates import GateResult
    from verify.run.plan import Plan
    from verify.run.runner import RunResult
    from verify.studies.told import Column, Found
    from verify.studies.told import Table as StudyTable

UNKNOWN_WIDTH = 80
NARROW = 88
"""Below this many characters a table leaves out what is wide."""


class Terminal(Console):
    """Standard output without highlighting of numbers; what lies between two colons stays as it is."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(highlight=False, emoji=False, **settings)
        if self.width < 1:  # COLUMNS=0, as some containers have it, is no width
            self.width = UNKNOWN_WIDTH

    def render(self, renderable: RenderableType, options: ConsoleOptions | None = None) -> Iterable[Segment]:
        """As rich draws it, with what a title or a path would have the terminal obey escaped."""
        for segment in super().render(renderable, options):
            plain = segment.control or segment.text == "\n" or segment.text.isprintable()
            yield segment if plain else _harmless(segment)

    def on_broken_pipe(self) -> None:
        """Leave it to the command line, which ends without a word."""
        raise BrokenPipeError


def _harmless(segment: Segment) -> Segment:
    lines = (printable(line) for line in segment.text.split("\n"))
    return Segment("\n".join(lines), segment.style)


def print_run(result: "RunResult", report: Path | None, kept: Path | None = None) -> None:
    """Gates, what the studies found, the verdict, where the report lies and is kept."""
    console = Terminal()
    console.print(Text(result.scene.title or result.scene.name, style="bold"))
    print_remarks(remarks_on(result.scene), console)
    if judged := tuple(gate for gate in result.gates if gate.applicable):
        console.print(_gate_table(judged))
    for reason, names in _by_reason((gate.reason, gate.id) for gate in result.failed).items():
        console.print(Text(f"{in_a_row('gate', names, len(names))}: {reason}", style="red"))
    for reason, names in _by_reason((gate.reason, gate.id) for gate in result.set_aside).items():
        console.print(Text(f"not applicable: {in_a_row('gate', names)}, {reason}"))
    for found in result.found.values():
        _print_found(console, found, every_table=False)
    if scale := scale_in_words(result.scene):
        console.print(Text(scale))
    work = work_in_words(len(result.solves), result.n_fields, result.n_motions, result.others)
    console.print(f"{_verdict(result)} in {seconds_in_words(result.seconds)}: {work}")
    if report is not None:
        console.print(f"report: {report}", soft_wrap=True, markup=False)
    if kept is not None:
        console.print(f"kept: {kept}", soft_wrap=True, markup=False)


def print_remarks(remarks: Iterable[str], console: Console) -> None:
    """What looks like another unit."""
    for remark in remarks:
        console.print(Text(f"remark: {remark}", style="yellow"))


def _verdict(result: "RunResult") -> str:
    n, aside = len(result.gates), len(result.set_aside)
    beside = f", {aside} not applicable" if aside else ""
    if result.failed:
        return f"[bold red]{len(result.failed)} of {n - aside} gates failed[/]{beside}"
    if n == aside:
        return f"no gate applies of {n}" if n else "the scene has no gates"
    return f"[bold green]all {n - aside} gates passed[/]{beside}"


def _by_reason(pairs: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    """Names by the sentence that they share, so that it is printed once."""
    found: dict[str, list[str]] = {}
    for reason, name in pairs:
        found.setdefault(reason, []).append(name)
    return found


def print_compared(result: "Compared | ShapesJudged", report: Path | None) -> None:
    """What somebody's model is; its modes, the candidates, the gates, where the report lies."""
    console = Terminal()
    answer, *facts = result.facts()
    console.print(Text(answer, style="bold"))
    for fact in facts:
        console.print(Text(fact))
    for table in result.tables():
        shown = _print_table(console, table)
        _print_notes(console, [*shown.notes, *_without_room([shown])])
    console.print(_gate_table(result.gates))
    for gate in result.gates:
        if not gate.passed:
            console.print(Text(f"gate {gate.id}: {gate.reason}", style="red"))
    if report is not None:
        console.print(f"report: {report}", soft_wrap=True, markup=False)


def print_found(found: "Found", *, every_table: bool = True) -> None:
    """What a study found: its facts and all its tables, or those of a run. Raises InputError where it has neither."""
    if not found.facts() and not found.tables():
        raise InputError("--of: the study has no table that a terminal holds, ask for --csv, --markdown or --json")
    _print_found(Terminal(), found, every_table=every_table)


def _print_found(console: Console, found: "Found", *, every_table: bool) -> None:
    for fact in found.facts():
        console.print(Text(fact))
    shown = [_print_table(console, table) for table in found.tables() if every_table or table.shown != "page"]
    notes = [note for one in shown for note in one.notes]
    _print_notes(console, [*told_once(notes), *_without_room(shown, ", --csv too")])


def _print_notes(console: Console, notes: Iterable[str]) -> None:
    for note in notes:
        console.print(Text(f"– {note}", style="dim"))


class _Shown(NamedTuple):
    """What is still to be said of a table that is printed."""

    notes: tuple[str, ...]
    left_out: tuple[str, ...]
    """Heads of columns for which there is no room."""
    whole: int
    """Characters that all of its columns take."""


def _without_room(shown: Sequence[_Shown], other: str = "") -> tuple[str, ...]:
    """The sentence about columns for which there is no room, where there are any; `other` ways to see them."""
    heads = dict.fromkeys(head for one in shown for head in one.left_out)
    if not heads:
        return ()
    width = max(one.whole for one in shown if one.left_out)
    return (f"no room for {', '.join(heads)}: a terminal of {width} characters shows it{other}",)


def _print_table(console: Console, table: "StudyTable") -> _Shown:
    """Title, what it says before, and the rows."""
    if table.title:
        console.print(Text(table.title, style="bold"))
    if table.before:
        console.print(Text(table.before))
    wanted = [i for i, column in enumerate(table.columns) if console.width >= NARROW or not column.wide]
    rows = [[_written(value, column) for value, column in zip(row, table.columns, strict=True)] for row in table.rows]
    shown = _with_room(console.width, table.columns, rows, wanted)
    heads = [table.columns[i] for i in shown]
    least = [_least(table.columns[i], [row[i] for row in rows]) for i in shown]
    drawn = _empty_table(heads, least) if any(column.head for column in heads) else _grid(heads)
    for row in rows:
        drawn.add_row(*(Text(row[i]) for i in shown))
    console.print(drawn)
    columns = range(len(table.columns))
    whole = 1 + sum(1 + _least(table.columns[i], [row[i] for row in rows]) for i in columns)
    left_out = tuple(table.columns[i].head for i in columns if i not in shown)
    return _Shown(table.below(shown), left_out, max(whole, NARROW))


def _written(value: Any, column: "Column") -> str:
    return cell(value, column.form, column.factor, column.unit)


def _with_room(
    width: int, columns: "Sequence[Column]", rows: Sequence[Sequence[str]], wanted: Sequence[int]
) -> list[int]:
    """Columns that stand side by side with every number whole: the last ones of numbers go first."""
    shown = list(wanted)
    least = {i: _least(columns[i], [row[i] for row in rows]) for i in shown}
    while sum(least[i] + 1 for i in shown) + 1 > width:
        numbers = [i for i in shown if not columns[i].left]
        if len(numbers) < 2:
            break
        shown.remove(numbers[-1])
    return shown


def _least(column: "Column", cells: Sequence[str]) -> int:
    """Characters that a column takes at least: its longest number, or word, and the longest word above it."""
    told = [column.head, *cells] if column.left else [column.head]
    words = max((len(word) for text in told for word in text.split()), default=1)
    return min(words, _WORD) if column.left else max(words, *map(len, cells), 1)


_WORD = 16
"""Characters of a word that may be broken."""


def _empty_table(columns: "list[Column]", least: Sequence[int]) -> Table:
    """Numbers stand right and are never broken where there is room; words stand left and are folded."""
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=0)
    for column, width in zip(columns, least, strict=True):
        if column.left:
            table.add_column(column.head, overflow="fold")
        else:
            table.add_column(column.head, justify="right", overflow="fold", min_width=width)
    return table


def _grid(columns: "list[Column]") -> Table:
    """Rows without heads: a word, and what it is about."""
    table = Table.grid(padding=(0, 1))
    for _ in columns:
        table.add_column()
    return table


class Hyphenated:
    """A name, or a few, broken into lines behind hyphens and spaces."""

    def __init__(self, name: str) -> None:
        self._parts = re.findall(r"[^- ]*[- ]|[^- ]+", name)

    def __rich_measure__(self, console: Console, options: ConsoleOptions) -> Measurement:
        """From its longest part to all of it."""
        return Measurement(max(map(len, self._parts)), sum(map(len, self._parts)))

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Text]:
        """Line by line, each as long as there is room."""
        lines = [""]
        for part in self._parts:
            if len(lines[-1]) + len(part.rstrip()) > options.max_width and lines[-1]:
                lines.append("")
            lines[-1] += part
        yield from (Text(line.rstrip(), overflow="fold") for line in lines)


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
        unit = "" if gate.unit == "1" else gate.unit
        share, expected = share_of_band(gate.share), shown_expectation(gate.band)
        table.add_row(mark, Hyphenated(gate.id), figure(gate.measured), expected, unit, share)
    return table


def print_choices(
    bench: "Workbench", mode: int | range, error: float, choices: "list[Choice]", left_out: dict[str, str]
) -> None:
    """What `verify choose` found, and which of the models costs less."""
    console = Terminal()
    several = isinstance(mode, range)
    console.print(f"[bold]{_modes_told(bench, mode, error, choices)}: enough from")
    table = Table(box=SIMPLE_HEAD, pad_edge=False, show_header=True)
    for name in ("model", "N", *["for mode"] * several, "unknowns", "error", "error law", "time"):
        table.add_column(name, justify="left" if name == "model" else "right", no_wrap=name != "model")
    for one in choices:
        table.add_row(
            one.variant.title,
            str(one.count),
            *[str(one.mode)] * several,
            str(one.unknowns),
            percent(one.error),
            percent(one.expected_error),
            seconds_in_words(one.run_time_s),
        )
    console.print(table)
    for one in choices:
        less = f"cannot be built ({one.unbuilt})" if one.unbuilt else "does not"
        console.print(Text(f"{one.variant.title}: N = {one.count - 1} {less}; {one.known_by}"))
        if one.smaller:
            worst = f"{percent(one.smaller_error)}{' at worst' * several}"
            console.print(Text(f"  N = {one.smaller} happens to do as well, with {worst}"))
        if one.lower:
            console.print(Text(f"  {_lower_told(one)}"))
    for model, why in left_out.items():
        console.print(Text(f"– {model} is left out: {why}", style="dim"))
    console.print("[dim]errors solved at N; time of a warm solve, set-up included[/]")


def _modes_told(bench: "Workbench", mode: int | range, error: float, choices: "list[Choice]") -> str:
    """'mode 3[/] within 0.1 % of the exact 297.3527 Hz', with the end of what is bold."""
    within = f"within {percent(error, sign=False)} of the exact"
    if isinstance(mode, range):
        return f"modes {mode[0]} to {mode[-1]}[/] {within} frequencies"
    theories = dict.fromkeys(one.variant.theory for one in choices)
    return f"mode {mode}[/] {within} {' and '.join(f'{bench.exact_hz(mode, theory):.4f} Hz' for theory in theories)}"


def _lower_told(one: "Choice") -> str:
    """Which modes below are not within the error, and how to ask for them."""
    which = f"mode {one.lower[0]} is" if len(one.lower) == 1 else f"modes {', '.join(map(str, one.lower))} are"
    return f"at N = {one.count} {which} not within it: --mode 1-{one.mode} asks for all"


_TIGHT = 80
"""Below this many characters a plan leaves out how its solves are done."""
_ASKED = 13
"""Characters left to who asks for a solve, where the settings of a model are long."""


def _print_solves(console: Console, plan: "Plan") -> None:
    """A row for each solve; settings stay whole, how it is done is left out where there is no room."""
    tight = console.width < _TIGHT
    table = Table(box=SIMPLE_HEAD, pad_edge=False, padding=(0, 1, 0, 0))
    table.add_column("model", overflow="fold")
    for name in ("N", "modes", *(() if tight else ("unknowns",))):
        table.add_column(name, justify="right", no_wrap=True)
    if not tight:
        table.add_column("vectors by", no_wrap=True)
    table.add_column("asked by", overflow="fold", min_width=_ASKED)
    for solve in plan.solves:
        sizes = [str(solve.count), str(solve.n_modes)] + ([] if tight else [str(solve.unknowns), solve.method])
        model = " ".join([solve.model, *(f"{name}={value}" for name, value in solve.settings)])
        table.add_row(model, *sizes, Hyphenated(_who(solve.asked_by)))
    console.print(table)
    if tight:
        note = f"– no room for unknowns, vectors by: a terminal of {_TIGHT} characters shows them, --json too"
        console.print(Text(note, style="dim"))


def print_plan(plan: "Plan") -> None:
    """What will run, what is skipped, what cannot work."""
    console = Terminal()
    unable = len({problem.who for problem in plan.problems})
    console.print(f"[bold]{plan.scene}[/] will run" + (f", but for {unable} asked for that cannot" if unable else ""))
    if plan.solves:
        _print_solves(console, plan)
    for words, names in (
        ("more sizes, looked through one after another", plan.searched),
        ("closed forms", plan.closed_forms),
        ("matrices assembled", plan.assembled),
        ("harmonic fields", plan.harmonic),
        ("equilibria and modes of the nonlinear chain", plan.compiled),
        ("promises pushed on beams of their own", plan.promises),
        ("motion in time", plan.stepped),
    ):
        if names:
            console.print(f"{words}, for {_who(names)}", markup=False)
    for chosen in plan.chosen:
        console.print(f"  {chosen.what}: {chosen.why}", markup=False)
    console.print("[bold]skipped[/]")
    for skipped in plan.skipped:
        console.print(f"  {skipped.what}: {skipped.why}", markup=False)
    for why, who in _by_reason((problem.why, problem.who) for problem in plan.problems).items():
        console.print(Text(f"cannot run: {', '.join(dict.fromkeys(who))}: {why}", style="red"))


def _who(names: tuple[str, ...]) -> str:
    return ", ".join(names[:2]) + (f" and {len(names) - 2} more" if len(names) > 2 else "")


@contextmanager
def progress_bar(n_steps: int) -> Iterator[Callable[[str], None]]:
    """A bar on the error stream that disappears when done."""
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

    from verify.models.compiling import heard

    columns = (TextColumn("{task.description}"), BarColumn(), TextColumn("{task.completed}/{task.total}"))
    with Progress(*columns, TimeElapsedColumn(), console=Console(stderr=True), transient=True) as bar:
        task = bar.add_task("starting", total=n_steps)
        started, before = False, "starting"

        def step(name: str) -> None:
            nonlocal started, before
            bar.update(task, description=name, advance=1 if started else 0)
            started, before = True, name

        def hear(compiling: str) -> None:
            bar.update(task, description=compiling or before, refresh=True)

        with heard(hear):
            yield step
