"""Quantities over the Cartesian product of scene keys and quantity arguments, on all cores."""

import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

import msgspec
from msgspec import Meta

from verify.analysis.margins import beam_margins, run_margins, sag_margins
from verify.analysis.solution_cache import Settings, SolutionCache
from verify.analysis.variants import DEFAULTS, Variant
from verify.analysis.verdict import Margin
from verify.errors import InputError, near_name, shown
from verify.linear.registry import EXACT, MODELS
from verify.parallel import VARIABLE, map_processes
from verify.quantities.base import QUANTITIES, as_text, evaluate
from verify.report.result import Column, Figure, Result, Table
from verify.scene.load import scene_from
from verify.studies.base import Progress, Study
from verify.studies.claims import computed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.scene.model import Scene

MOST = 100_000
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
        tables, known = _tables(scene), {name for one in wanted for name in one.schema.__struct_fields__}
        for name in [*self.arguments, *(key.strip() for keys in self.over for key in keys.split(","))]:
            if "." in name:
                _put(tables, name.split("."), name, None)
            elif name not in known:
                remedy = near_name(name, tuple(known))
                raise InputError(f"sweep: {name} is no argument of {', '.join(self.quantities)}: {remedy}")
        if self.claims and not scene.claim:
            raise InputError("sweep.claims = true, and the scene has no [[claim]]: add one, or leave it out")

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Evaluate the quantities over every combination of the lists in `over`, the first key slowest.

        Runs on as many processes as VERIFY_JOBS says, else as there are cores. Returns one table with a row for each
        combination, and a chart of each quantity over one or two lists. Raises InputError for an unknown quantity, key
        or argument; a combination that raises it is a row with the reason.
        """
        self.check(scene)
        tables = _tables(scene)
        combinations = _combinations(self.over)
        values = map_processes(
            _evaluate,
            [(tables, self, one) for one in combinations],
            lambda i: progress(f"combination {i + 1} of {len(combinations)}"),
            max_workers=None if os.environ.get(VARIABLE) else os.cpu_count(),
        )
        rows = [one | found for one, found in zip(combinations, values, strict=True)]
        margins = [margin for row in rows for margin in row.pop("margins")]
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


def _evaluate(task: tuple[dict[str, Any], Sweep, dict[str, Any]]) -> dict[str, Any]:
    """Values by quantity, claims that agree, reason for a missing value, worst margin, of one combination."""
    tables, study, combination = task
    row: dict[str, Any] = dict.fromkeys(study.quantities) | {AGREE: 0, "reason": None, "margins": ()}
    try:
        for key, value in combination.items():
            tables = _put(tables, key.split("."), key, value) if "." in key else tables
        scene = scene_from(tables)
        cache = SolutionCache(scene.beam)
        arguments = study.arguments | {key: value for key, value in combination.items() if "." not in key}
        for one in _quantities(study.quantities):
            own = {k: v for k, v in arguments.items() if k in one.schema.__struct_fields__}
            row[one.name] = evaluate(one.name, own, scene, cache)
            row["margins"] += (*quantity_margins(one.name, own, scene, cache),)
        for claim in scene.claim if study.claims else ():
            row[AGREE] += claim.agrees(computed(claim, scene, cache))
    except InputError as error:
        row["reason"] = str(error)
    return row


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
    """Condition of `wave.crest_speed`, inverse to |w| at the crests, and of `mode.order`, near the order in theory."""
    from verify.analysis.comparison import ORDER_SPREAD

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


def _tables(scene: "Scene") -> dict[str, Any]:
    """The scene as in a file, without gates and without the sweep, which would check itself."""
    tables = {name: msgspec.to_builtins(getattr(scene, name)) for name in scene.__struct_fields__ if name != "gate"}
    studies = tables.pop("studies")
    return tables | {name: study for name, study in studies.items() if name != "sweep"}


def _put(node: Any, path: list[str], key: str, value: Any) -> Any:
    """A copy of plain tables with another value at a path. Raises InputError for a path that does not exist."""
    head, *rest = path
    names = dict(enumerate(node)) if isinstance(node, list | tuple) else node if isinstance(node, dict) else {}
    known = {str(name): one for name, one in names.items()}
    if head not in known and not (head == "*" and isinstance(node, list | tuple) and node):
        raise InputError(f"sweep.over.{key}: {head} is not known: {near_name(head, tuple(known))}")
    for name, one in known.items():
        if head in ("*", name):
            known[name] = _put(one, rest, key, value) if rest else value
    return list(known.values()) if isinstance(node, list | tuple) else known


def _cell(value: Any) -> Any:
    """A value of a table: numbers, words; anything else as text."""
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return str(value) if isinstance(value, list | tuple | dict) else as_text(value)


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
