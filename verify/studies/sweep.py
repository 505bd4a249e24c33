"""Quantities over the Cartesian product of scene keys and quantity arguments, on all cores or on a cluster.

A sweep may write its rows to a file of JSON lines as they complete, from which the same sweep continues after a kill.
The first line has the versions, a hash of the scene, and the sweep; each further one has a combination, its values, and
what `Sweep.run` needs beside them. When all are there the file is sorted: then it is the same, byte for byte, whatever
computed it.
"""

import json
import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from hashlib import sha256
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, TypeAlias

import msgspec
from msgspec import Meta

from verify.analysis.margins import beam_margins, run_margins, sag_margins
from verify.analysis.solution_cache import Bracket, Settings, SolutionCache
from verify.analysis.variants import DEFAULTS, Variant
from verify.analysis.verdict import Margin, badness
from verify.errors import InputError, near_name, shown
from verify.estimate import as_plain, as_text
from verify.files import exists, write_whole
from verify.linear.registry import EXACT, MODELS
from verify.parallel import completed, versions, workers
from verify.quantities.base import QUANTITIES, evaluate
from verify.report.result import Column, Figure, Result, Table
from verify.scene.load import scene_from
from verify.studies.base import Progress, Study
from verify.studies.claims import computed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.scene.model import Scene

Request: TypeAlias = tuple[str, dict[str, Any]]  # name and arguments of a quantity
MOST = 100_000
UNREAD = ("spectrum", "convergence", "wave", "sweep", "optimise", "sensitivity")
AGREE = "claims that agree"
UNEVEN = 2.0, 25.0
"""Standing-wave ratios up to which a crest speed is that of all crests, and up to which it is one under a condition."""
WIDE = 30.0  # ratio of largest to smallest value from which an axis is logarithmic


class Sweep(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Quantities over every combination of the lists in `over`.

    A key of `over` with a dot is a key of the scene ("beam.youngs_modulus", "drive.force.0.phase_deg", with * for all
    entries), one without is an argument of the quantities. Several keys joined by commas vary together, through a list
    of lists.
    """

    name: ClassVar[str] = "sweep"
    title: ClassVar[str] = "Sweep"
    devices: ClassVar[bool] = True

    quantities: Annotated[tuple[str, ...], Meta(min_length=1, description="Names, see `verify quantities`.")]
    over: Annotated[dict[str, list[Any]], Meta(min_length=1, description="Values by scene key or argument.")]
    arguments: Annotated[dict[str, Any], Meta(description="Fixed arguments, where a quantity has them.")] = (
        msgspec.field(default_factory=dict)
    )
    claims: Annotated[bool, Meta(description="Count the scene's claims that agree in each combination.")] = False

    def check(self, scene: "Scene") -> None:
        """Raise InputError for an unknown quantity, scene key or argument, and for an empty list."""
        _combinations(self.over)
        wanted = _quantities(self.quantities)
        tables, known = plain_tables(scene), {name for one in wanted for name in one.schema.__struct_fields__}
        for name in [*self.arguments, *(key.strip() for keys in self.over for key in keys.split(","))]:
            if "." in name:
                _put(tables, name.split("."), f"sweep.over.{name}", None)
            elif name not in known:
                remedy = near_name(name, tuple(known))
                raise InputError(f"sweep: {name} is no argument of {', '.join(self.quantities)}: {remedy}")
        if self.claims and not scene.claim:
            raise InputError("sweep.claims = true, and the scene has no [[claim]]: add one, or leave it out")

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress, file: Path | None = None) -> "Result":
        """Evaluate the quantities over every combination of the lists in `over`, the first key slowest.

        Runs on as many processes as VERIFY_JOBS says, or on the workers of `parallel.cluster`.
        Rows are appended to `file`; those that it already has are not computed. Returns one table with a row for each
        combination, and a chart of each quantity over one or two lists. Raises InputError for an unknown quantity, key
        or argument, and for a file of another sweep; a combination that raises it is a row with the reason.
        """
        self.check(scene)
        tables, combinations = plain_tables(scene), _combinations(self.over)
        header = _header(self, tables) if file else b""
        lines = _lines(file, header) if file else {}
        todo = [i for i in range(len(combinations)) if i not in lines]
        tasks = [(tables, self, combinations[i], i) for i in todo]
        # unbuffered: an interrupt comes before or after a whole line
        with open(file or os.devnull, "ab", buffering=0) as out, workers(len(todo) - 1) as executor:
            for i, line in completed(_evaluate, tasks, executor, first_here=True):
                out.write(line)
                lines[todo[i]] = line
                progress(f"combination {len(lines)} of {len(combinations)}")
        if file:
            write_whole(file, b"".join((header, *(lines[i] for i in sorted(lines)))).decode(), "--to")
        rows = [_row(lines[i]) for i in range(len(combinations))]
        found = sorted((margin for row in rows for margin in row.pop("margins")), key=badness)
        margins = list({margin.name: margin for margin in found}.values())  # of each the worst combination's
        if "count" in combinations[0]:  # coarse sizes are the subject, not a fault
            margins = [margin for margin in margins if not margin.name.startswith("discretisation")]
        wanted, failed = _quantities(self.quantities), sum(row["reason"] is not None for row in rows)
        columns = [Column(key, format=".6g") for key in combinations[0]]
        columns += [Column(one.name, "" if one.unit == "1" else one.unit, ".7g") for one in wanted]
        columns += [Column(AGREE)] * self.claims + [Column("reason")] * bool(failed)
        cells = [tuple(_cell(row[column.name]) for column in columns) for row in rows]
        note, where = f"Claims of the scene: {len(scene.claim)}.", " and ".join(self.over)
        return Result(
            summary=f"{len(rows)} combinations, {failed} without a value.",
            tables=[Table(f"Sweep over {where}", columns, cells, [note] * self.claims)],
            figures=[
                Figure(f"sweep-{one.name}", f"{one.name} over {where}", one.summary, partial(_draw, self, rows, one))
                for one in wanted
                if len(self.over) <= 2 and any(_number(row[one.name]) for row in rows)
            ],
            data={"rows": rows},
            margins=margins,
        )


def _evaluate(task: tuple[dict[str, Any], Sweep, dict[str, Any], int]) -> bytes:
    """The line of one combination: values by quantity, claims that agree, reason for a missing value, margins."""
    tables, study, combination, number = task
    row: dict[str, Any] = dict.fromkeys(study.quantities) | {AGREE: 0, "reason": None, "margins": []}
    try:
        requests: list[Request] = [(name, {}) for name in study.quantities]
        scene, cache, requests = varied(tables, requests, study.arguments | combination)
        for name, arguments in requests:
            row[name] = as_plain(evaluate(name, arguments, scene, cache))
            row["margins"] += map(msgspec.to_builtins, quantity_margins(name, arguments, scene, cache))
        for claim in scene.claim if study.claims else ():
            row[AGREE] += claim.agrees(computed(claim, scene, cache))
    except InputError as error:
        row["reason"] = str(error)
    return json.dumps({"row": number, "combination": combination, **row}).encode() + b"\n"


def _row(line: bytes) -> dict[str, Any]:
    """The combination and the values of a line, with its margins."""
    row = json.loads(line)
    del row["row"]
    return {**row.pop("combination"), **row, "margins": msgspec.convert(row["margins"], list[Margin])}


def _header(study: Sweep, tables: Mapping[str, Any]) -> bytes:
    """The first line of a sweep's file."""
    digest = sha256(json.dumps({**tables, "title": "", "description": ""}, sort_keys=True).encode()).hexdigest()
    provenance = {"versions": versions(), "scene": tables["name"], "sha256 of the scene": digest}
    return json.dumps(provenance | {"sweep": msgspec.to_builtins(study)}).encode() + b"\n"


def _lines(file: Path, header: bytes) -> dict[int, bytes]:
    """Lines by number of the combinations that a file has; a new file gets its header. Raises InputError."""
    text = file.read_bytes() if exists(file, "--to") and file.is_file() else b""
    first, *lines = text.splitlines(keepends=True) or [header]
    lines = [line for line in lines if line.endswith(b"\n")]  # a kill may leave half of one
    try:
        own, other = json.loads(header), json.loads(first)
        differing = [name for name in own if own[name] != other[name]]
        found = {json.loads(line)["row"]: line for line in lines}
    except (ValueError, KeyError, TypeError):
        differing, found = ["contents"], {}
    if differing:
        what = f"has the rows of another sweep (other {', '.join(differing)}): name another file, or delete it"
        raise InputError(f"--to {shown(str(file))} {what}")
    write_whole(file, b"".join((header, *lines)).decode(), "--to")
    return found


def quantity_margins(name: str, arguments: Mapping[str, Any], scene: "Scene", cache: "SolutionCache") -> "list[Margin]":
    """Margins of a quantity that the cache has evaluated: of its model at its mode or drive, and of its runs."""
    quantity = QUANTITIES.named(name)
    known = {f.name: f.default for f in msgspec.structs.fields(quantity.schema) if not f.required} | dict(arguments)
    mode, hertz = known.get("mode"), known.get("frequency_hz")
    if hertz is None and "drive" in quantity.reads and scene.drive is not None:
        hertz = scene.drive.frequency_hz
    found: list[Margin] = []
    if "beam" in quantity.reads and (isinstance(mode, int) or hertz is not None):
        settings = tuple((key, known[key]) for key in DEFAULTS if known.get(key) not in (None, DEFAULTS[key]))
        size = (known["model"], known.get("count")) if known.get("model") in MODELS else (EXACT, None)
        at = {"mode": mode} if isinstance(mode, int) else {"frequency_hz": hertz}
        with suppress(InputError):
            if not name.endswith(("order", ".count_needed")):  # which frequency errors of beam theory do not change
                found += beam_margins(cache, [size], **at, settings=settings)
        found += figure_margins(name, arguments, scene, cache, settings)
    runs = [*cache.motions.values(), *(one.run for one in cache.motors.values() if hasattr(one, "run"))]
    if scene.slider is not None and (sliding := [run for run in runs if run.coupling is not None]):
        found += [one for run in sliding for one in run_margins(run, scene.slider, MODELS[run.model].title)]
        found += sag_margins(cache, scene.slider)
    return found


def figure_margins(
    name: str, arguments: Mapping[str, Any], scene: "Scene", cache: SolutionCache, settings: Settings = ()
) -> list[Margin]:
    """Conditions of `wave.crest_speed`, of a free slider on a wave, and of `mode.order`, near the order in theory."""
    from verify.analysis.comparison import ORDER_SPREAD
    from verify.studies.motor import path_margins

    if name in ("motor.free_speed", "motor.start_time"):
        return path_margins(arguments.get("model", "segment"), arguments.get("count"), scene, cache)
    if name == "wave.crest_speed":
        ratio: Any = evaluate("wave.standing_wave_ratio", arguments, scene, cache)
        fast = f"the fastest over the slowest crests along the beam are the standing-wave ratio, {ratio:.3g}"
        return [Margin(name="variation of the crest speed along the beam", size=ratio, fine=UNEVEN[0], limit=UNEVEN[1],
                       condition=f"the crest speed of the rms amplitude is meant ({fast})", is_error=False,
                       failure=f"a nearly standing wave has no crest speed: {fast}")]  # fmt: skip
    known = name == "mode.order" and arguments["model"] in MODELS
    if (order := Variant(arguments["model"], settings).expected_order(cache.beam) if known else None) is None:
        return []
    observed: Any = evaluate(name, arguments, scene, cache)
    condition = f"the sizes count as asymptotic: the observed order is {observed:.2f}, in theory {order}"
    return [Margin(name="observed order", size=abs(observed - order), fine=0.2 * ORDER_SPREAD, limit=ORDER_SPREAD,
                   condition=condition, is_error=False)]  # fmt: skip


def _quantities(names: Sequence[str]) -> list[Any]:
    return [QUANTITIES.named(name) for name in names]


def _combinations(over: Mapping[str, Sequence[Any]]) -> list[dict[str, Any]]:
    """Values by key of every combination, the first key slowest. Raises InputError."""
    axes, size = [], 1
    for joined, values in over.items():
        keys = [key.strip() for key in joined.split(",")]
        together = [value if len(keys) > 1 else [value] for value in values]
        if not values or any(not isinstance(row, list) or len(row) != len(keys) for row in together):
            each = f"lists of {len(keys)} values" if len(keys) > 1 else "values"
            raise InputError(f"sweep.over.{joined} = {shown(list(values))}: give {each}, one at least")
        axes.append([dict(zip(keys, row, strict=True)) for row in together])
        size *= len(values)
    if size > MOST:
        raise InputError(f"sweep.over has {size} combinations: give at most {MOST}")
    return [{key: value for part in parts for key, value in part.items()} for parts in product(*axes)]


def plain_tables(scene: "Scene") -> dict[str, Any]:
    """The scene as in a file, without gates, and without studies that no quantity reads or that call this."""
    tables = {name: msgspec.to_builtins(getattr(scene, name)) for name in scene.__struct_fields__ if name != "gate"}
    studies = tables.pop("studies")
    return tables | {name: study for name, study in studies.items() if name not in UNREAD}


def varied(
    tables: dict[str, Any], requests: Sequence[Request], values: Mapping[str, Any]
) -> "tuple[Scene, SolutionCache, list[Request]]":
    """The scene, its cache and the quantities (name, arguments) with other values by key; keys may be joined by commas.

    A key with a dot is one of the scene, one without an argument of the quantities that have it. Raises InputError.
    """
    kinds = [QUANTITIES.named(name).types for name, _ in requests]
    known = dict.fromkeys(key for types in kinds for key in types)
    for joined, value in values.items():
        for key in joined.split(",") if "." in joined else ():
            tables = _put(tables, key.strip().split("."), joined, value)
        if "." not in joined and joined not in known:
            raise InputError(f"{joined} is no argument of the quantities: {near_name(joined, tuple(known))}")
    found = []
    for (name, arguments), types in zip(requests, kinds, strict=True):
        found.append((name, arguments | {key: value for key, value in values.items() if key in types}))
        QUANTITIES[name].bind(found[-1][1])
    scene = scene_from(tables)
    return scene, SolutionCache(scene.beam), found


def value_at(tables: dict[str, Any], key: str, requests: Sequence[Request]) -> Any:
    """The value of a scene's key, of the first of several, or of an argument; None where it has none."""
    if "." not in key:
        return next((arguments[key] for _, arguments in requests if key in arguments), None)
    here: Any = tables
    for step in key.partition(",")[0].strip().split("."):
        _put(here, [step], key, None)  # which refuses an unknown one
        here = here[0 if step == "*" else int(step)] if isinstance(here, list | tuple) else here[step]
    return here


def _put(node: Any, path: list[str], field: str, value: Any) -> Any:
    """A copy of plain tables with another value at a path. Raises InputError for a path that does not exist."""
    head, *rest = path
    names = dict(enumerate(node)) if isinstance(node, list | tuple) else node if isinstance(node, dict) else {}
    known = {str(name): one for name, one in names.items()}
    if head not in known and not (head == "*" and isinstance(node, list | tuple) and node):
        raise InputError(f"{field}: {head} is not known: {near_name(head, tuple(known))}")
    for name, one in known.items():
        if head in ("*", name):
            known[name] = _put(one, rest, field, value) if rest else value
    return list(known.values()) if isinstance(node, list | tuple) else known


def _cell(value: Any) -> Any:
    """A value of a table: numbers, words; anything else as text."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    kind = {("re", "im"): complex, ("lower", "upper"): Bracket}.get(tuple(value)) if isinstance(value, dict) else None
    return as_text(kind(*value.values())) if kind else str(value)


def _draw(study: Sweep, rows: list[dict[str, Any]], quantity: Any, ax: "Axes") -> None:
    """A line over one list, lines or a colour map over two, by whether the second has words; gaps without a value."""
    import numpy as np

    unit = "" if quantity.unit == "1" else f", {quantity.unit}"
    values = np.array([row[quantity.name] if _number(row[quantity.name]) else np.nan for row in rows], dtype=float)
    first, *second = study.over.items()
    places = [_place(ax, "x", *first)]
    label = f"{quantity.name}{unit}"
    if second and _rising(second[0][1]):
        places.append(_place(ax, "y", *second[0]))
        mesh = ax.pcolormesh(*places, values.reshape(len(places[0]), -1).T, shading="nearest", cmap="viridis")
        ax.figure.colorbar(mesh, ax=ax, label=label)
        ax.grid(False)
        return
    keys = [key.rpartition(".")[2] for key in second[0][0].split(",")] if second else []
    names = [f"{', '.join(keys)} = {_label(value)}" for value in second[0][1]] if second else [""]
    for name, own in zip(names, values.reshape(len(places[0]), -1).T, strict=True):
        ax.plot(places[0], own, "-o", label=name)
    if np.nanmin(values) > 0.0 and np.nanmax(values) > WIDE * np.nanmin(values):
        ax.set_yscale("log")
    ax.set_ylabel(label)
    if second:
        ax.legend()


def _rising(given: list[Any]) -> bool:
    return all(map(_number, given)) and sorted(set(given)) == given


def _place(ax: "Axes", axis: str, key: str, given: list[Any]) -> list[Any]:
    """Label and scale an axis for a list; the coordinates of its values."""
    getattr(ax, f"set_{axis}label")(key)
    if not _rising(given):
        getattr(ax, f"set_{axis}ticks")(range(len(given)), [_label(value) for value in given])
        return list(range(len(given)))
    if given[0] > 0.0 and given[-1] / given[0] > WIDE:
        getattr(ax, f"set_{axis}scale")("log")
    return given


def _label(value: Any) -> str:
    return f"{value:g}" if _number(value) else ", ".join(map(_label, value)) if isinstance(value, list) else str(value)


def _number(value: Any) -> bool:
    return isinstance(value, float | int) and not isinstance(value, bool)
