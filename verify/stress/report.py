"""Outcomes of stress checks as a result: one table, a chart, data."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from verify.report.result import Column, Figure, Result, Table
from verify.stress.engine import Outcome, registry

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLUMNS = [Column("check"), Column("parameter"), Column("range"), Column("tolerance", format=".3g")]
COLUMNS += [Column("worst", format=".2g"), Column("breaks at"), Column("standard", format=".1g")]
NOTE = "worst: largest error over the range; standard: that of the standard method."


def record(outcome: Outcome) -> dict[str, Any]:
    """An outcome as data."""
    check, names = registry()[outcome.id], ("worst", "passed", "breaks_at", "breaks_by", "seconds", "points")
    return {
        **{name: getattr(check, name) for name in ("id", "title", "parameter", "tolerance")},
        **{"from": check.values[0], "to": check.values[-1]},
        **{name: getattr(outcome, name) for name in names},
        "baseline": max((error for _, error in outcome.baseline), default=None),
        "baseline_name": check.baseline[0] if check.baseline else "",
    }


def result(outcomes: Sequence[Outcome]) -> Result:
    """Table, chart and data of what was measured."""
    records = [record(one) for one in outcomes]
    failed = [one["id"] for one in records if not one["passed"]]
    rows = [
        [one["id"], one["parameter"], f"{one['from']:.3g} .. {one['to']:.3g}", one["tolerance"], one["worst"]]
        for one in records
    ]
    for row, one in zip(rows, records, strict=True):
        row += [f"{one['breaks_at']:.3g} {one['breaks_by']}" if one["breaks_by"] else None, one["baseline"]]
    caption = "Largest error over the guaranteed range, over its tolerance."
    title, size = "Worst error as a fraction of the tolerance", (6.4, 0.6 + 0.17 * len(records))
    figures = [Figure("stress-fraction", title, caption, lambda ax: _fractions(ax, records), size)]
    return Result(
        summary=f"{len(records) - len(failed)} of {len(records)} checks are within their tolerance.",
        tables=[Table("Stress checks", COLUMNS, rows, [NOTE])],
        figures=figures,
        warnings=[f"{name} fails" for name in failed],
        data={"checks": records},
    )


def _fractions(ax: "Axes", records: Sequence[dict[str, Any]]) -> None:
    ax.barh([one["id"] for one in records], [max(one["worst"] / one["tolerance"], 1e-6) for one in records])
    ax.axvline(1.0, linestyle="--")
    ax.set(xscale="log", xlabel="worst / tolerance", xlim=(1e-6, 10.0))
    ax.invert_yaxis()
    ax.tick_params(axis="y", labelsize=7)
