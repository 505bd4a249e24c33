"""What the runs of a case in some engine show: figures, errors, orders, likely causes, a verdict."""

from collections.abc import Mapping, Sequence
from math import inf, isfinite, log, nan
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from msgspec.structs import replace

from verify.analysis.verdict import Margin, void
from verify.blas import one_blas_thread
from verify.errors import InputError
from verify.report.result import Column, Result, Table
from verify.sheets.causes import causes
from verify.sheets.faults import PEAK, noise_of
from verify.sheets.reading import Run, value
from verify.sheets.sheet import Figure, Sheet, load
from verify.validation import check_integer

CLASSES = {"A": 0.01, "B": 0.1, "C": 1.0}
"""Class of an error over the largest that passes."""
SLACK = 0.3
"""Of an observed order below the expected one: sizes far from the limit have less."""


class Read(NamedTuple):
    """A figure in one run; not a number, and why, where the record does not have it."""

    figure: Figure
    value: float
    error: float
    lost: str = ""

    def known(self, number: float) -> float | None:
        """A number of it, None where the record does not have it."""
        return None if self.lost else number

    @property
    def share(self) -> float:
        """Of the largest error that passes."""
        return inf if self.lost else self.figure.share(self.value)

    @property
    def grade(self) -> str:
        """The best class, '' where it fails."""
        return next((name for name, share in CLASSES.items() if self.share <= share), "")


@one_blas_thread()
def judge_case(
    case: str, records: Sequence[str | Path], *, counts: Sequence[int] | None = None, within: float | None = None
) -> Result:
    """Compare runs of a case in any engine with its exact values.

    `case`: name of a sheet (`verify cases`) or the path of one. `records`: tables with the sheet's columns, of one or
    more runs; the last is judged. `counts`: the number of links, or of steps, of every run, for orders. `within`:
    largest error in place of the sheet's. `data["passed"]` says whether the last run passes. Raises InputError for a
    table without the columns, and for one in which the figures cannot be read.
    """
    sheet = load(case)
    if not records:
        raise InputError("records: give the table of a run")
    if counts is not None and len(counts) != len(records):
        raise InputError(f"counts = {list(counts)}: give one for each of the {len(records)} records")
    for count in counts or ():
        check_integer("counts", count, 1)
    given = [within is not None and one.read != "first" and one.exact for one in sheet.figures]
    figures = [replace(one, within=within) if own else one for one, own in zip(sheet.figures, given, strict=True)]
    sizes: Sequence[int | None] = counts or [None] * len(records)
    read = [Run(sheet, Path(path), size) for path, size in zip(records, sizes, strict=True)]
    runs = [[_read(sheet, one, run) for one in figures] for run in read]
    orders = _orders(figures, runs, counts) if counts and len(runs) > 1 else {}
    if all(one.lost for one in runs[-1]):
        raise InputError(runs[-1][0].lost)
    last = {one.figure.name: one.value for one in runs[-1] if not one.lost}
    known = causes(sheet, read[-1], [one.figure for one in runs[-1]], last)
    whys = [known.get(one.figure.name, "") if one.share > 1.0 else "" for one in runs[-1]]
    unread = {one.lost: one for one in reversed(runs[-1]) if one.lost}.values()  # one sentence of a mode's two figures
    judged = [(one, why) for one, why in zip(runs[-1], whys, strict=True) if not one.lost or one in unread]
    margins = [_margin(one, why, leads=whys.count(why) == 1) for one, why in judged]
    large = [one.figure for one in runs[-1] if one.share > CLASSES["B"] and one.figure.order]  # else others matter
    falling = [_order_margin(one, orders[one.name]) for one in large if one.name in orders]
    margins += falling
    notes = [*read[-1].notes, *[f"The record cannot tell {sheet.blind}."] * bool(sheet.blind)]
    heard = {name: noise_of(read[-1], name) for name in read[-1].signals}
    notes += [f"Noise of {name!r}: {text}." for name, text in heard.items() if text]
    titles = [Path(path).name for path in records]
    titles = titles if counts is None else [f"{name}, N = {n}" for name, n in zip(titles, counts, strict=True)]
    figures_read = [_data(one, why, orders) for one, why in zip(runs[-1], whys, strict=True)]
    passed = all(margin.level != "not trusted" for margin in margins)
    data = {"case": case, "passed": passed, "figures": figures_read}
    data["orders"] = {one.name: one.failure if one.level == "not trusted" else None for one in falling}
    return Result(sheet.title, _tables(case, titles, runs, orders, notes), margins=margins, data=data)


def _data(one: Read, why: str, orders: Mapping[str, float]) -> dict[str, object]:
    """A figure of the judged run for programs."""
    figure = one.figure
    found = {"figure": figure.name, "value": one.value, "error": one.error, "class": one.grade or None}
    found |= {"exact": figure.exact, "source": figure.source, "order": orders.get(figure.name)}
    return found | {"cause": why or None, "lost": one.lost or None, "passed": one.share <= 1.0}


def _tables(
    case: str, titles: list[str], runs: list[list[Read]], orders: Mapping[str, float], notes: Sequence[str]
) -> list[Table]:
    """Figures of all runs, and the orders of their errors; `notes`: what is not as in the file of the last."""
    columns = [Column("figure"), Column("run"), Column("value", "", ".7g"), Column("exact", "", ".9g"), Column("unit")]
    columns += [Column("error", format="+.3g"), Column("passes within", format=".3g"), Column("class")]
    note = "Errors are relative, absolute where the exact value is 0. Class A: a hundredth of what passes; B: a tenth."
    rows = list[list[object]]()
    for title, run in zip(titles, runs, strict=True):
        for one in run:
            figure, grade = one.figure, one.grade or ("not read" if one.lost else "fails")
            rows.append([figure.name, title, one.known(one.value), figure.exact, figure.unit or "1"])
            rows[-1] += [one.known(one.error), figure.within, grade]
    tables = [Table(f"Figures of {case}", columns, rows, [note, *notes])]
    shown = [
        (x.figure.name, orders[x.figure.name], x.figure.order or None) for x in runs[-1] if x.figure.name in orders
    ]
    if shown:
        heads = [Column("figure"), Column("observed order", format=".3g"), Column("expected, at least")]
        tables.append(Table("Orders", heads, shown))
    return tables


def _read(sheet: Sheet, figure: Figure, run: Run) -> Read:
    try:
        found = value(sheet, figure, run)
    except InputError as error:
        return Read(figure, nan, nan, str(error))
    if figure.read == "first":  # noise is not of the start
        figure = replace(figure, uncertainty=PEAK * run.noise(figure.column))
    return Read(figure, found, figure.error(found))


def _margin(one: Read, why: str, *, leads: bool) -> Margin:
    """The error of a figure, as a fraction of what passes where it is not relative.

    `leads`: whether the cause is that of no other figure; a wrong start then explains the rest.
    """
    cause, _, remedy = why.partition(": ")
    if one.lost:
        text = one.lost.partition(": ")[2] or one.lost
        return void(one.figure.meaning, f"{text}: {cause}" if why else text, remedy)
    figure, unit = one.figure, f" {one.figure.unit}".rstrip(" 1")
    failure = f"{figure.meaning} is {one.value:.5g}{unit} for {figure.exact:.5g}{unit}"
    relative = bool(figure.exact)
    size, limit = (abs(one.error), figure.within) if relative else (one.share, 1.0)
    failure += f": {cause}" if cause else ""
    return Margin(
        name=figure.meaning,
        size=size if one.share > 1.0 else min(size, limit),
        fine=limit,
        limit=limit,
        is_error=relative,
        failure=failure,
        remedy=remedy,
        harm="premise" if why and leads and figure.read == "first" else "model form" if why else "discretisation",
    )


def _orders(figures: Sequence[Figure], runs: list[list[Read]], counts: Sequence[int]) -> dict[str, float]:
    """Observed order of every figure with an error in the last two runs, against the exact value."""
    found = {}
    for one, before, after in zip(figures, *runs[-2:], strict=True):
        if counts[-1] == counts[-2]:
            raise InputError(f"counts = {list(counts)}: the last two are equal, give runs of different sizes")
        floor = 3.0 * one.uncertainty / (abs(one.exact) or 1.0)
        if isfinite(before.error + after.error) and min(abs(before.error), abs(after.error)) > floor:
            found[one.name] = log(abs(before.error / after.error)) / log(counts[-1] / counts[-2])
    return found


def _order_margin(figure: Figure, order: float) -> Margin:
    """An order far below the expected one: an error that more links or smaller steps do not lower as they should."""
    short = max(figure.order - order, 0.0)
    failure = f"the error of {figure.name} falls with order {order:.2g}, a right model has {figure.order} or more"
    remedy = "halve the time step with the size, then look for a part of the model that does not depend on it"
    if order < 0.0:
        remedy = "give the runs in the order of --counts, then look for a part of the model that the size makes worse"
    return Margin(
        name=f"order of {figure.name}",
        size=short,
        fine=SLACK,
        limit=1.0 - SLACK,
        is_error=False,
        failure=failure,
        condition=f"the order {order:.2g} of {figure.name} rises to {figure.order} by smaller time steps or more links",
        remedy=remedy,
    )


def junit(result: Result) -> str:
    """The figures of a judged run, and the orders of large errors, as JUnit XML, a test each."""
    figures, orders = result.data["figures"], result.data["orders"]
    failed = sum(not one["passed"] for one in figures) + sum(map(bool, orders.values()))
    count = len(figures) + len(orders)
    suite = ElementTree.Element("testsuite", name=result.data["case"], tests=str(count), failures=str(failed))
    for one in figures:
        test = ElementTree.SubElement(suite, "testcase", classname=result.data["case"], name=one["figure"])
        if not one["passed"]:
            text = one["lost"] or f"{one['figure']} = {one['value']:.7g}, error {one['error']:+.3g}"
            ElementTree.SubElement(test, "failure", message=text).text = one["cause"] or text
    for name, text in orders.items():
        test = ElementTree.SubElement(suite, "testcase", classname=result.data["case"], name=name)
        if text:
            ElementTree.SubElement(test, "failure", message=text).text = text
    return '<?xml version="1.0" encoding="utf-8"?>\n' + ElementTree.tostring(suite, encoding="unicode") + "\n"


def page(result: Result, command: str, seconds: float) -> str:
    """The judgement as an HTML page: verdict, figures, orders, sources."""
    from verify.report.page import Section, render

    assert result.verdict
    sections = [Section(table.title.lower().replace(" ", "-"), table.title, tables=[table]) for table in result.tables]
    values = {"title": result.summary, "level": result.verdict.level, "verdict": result.verdict.headline}
    return render(
        result.data["case"], sections, others=result.verdict.others, command=command, seconds=seconds, **values
    )
