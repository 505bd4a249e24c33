"""Outcomes of stress checks as a result: a table and data."""

from collections.abc import Sequence
from dataclasses import asdict

from verify.report.result import Column, Result, Table
from verify.stress.engine import Outcome, registry

COLUMNS = [Column("check"), Column("parameter"), Column("range"), Column("tolerance", format=".3g")]
COLUMNS += [Column("worst", format=".2g"), Column("breaks at"), Column("standard", format=".1g")]
NOTE = "worst: largest error over the range; standard: that of the standard method."


def result(outcomes: Sequence[Outcome]) -> Result:
    """Table and data of the outcomes."""
    records = []
    for outcome in outcomes:
        check = registry()[outcome.id]
        own = {name: getattr(check, name) for name in ("id", "title", "parameter", "tolerance")}
        own |= {"from": check.values[0], "to": check.values[-1]} | asdict(outcome)
        own["baseline"] = max((error for _, error in outcome.baseline), default=None)
        records.append(own | {"baseline_name": check.baseline[0] if check.baseline else ""})
    failed = [one["id"] for one in records if not one["passed"]]
    rows = []
    for one in records:
        breaks = f"{one['breaks_at']:.3g} {one['breaks_by']}" if one["breaks_by"] else None
        values = f"{one['from']:.3g} .. {one['to']:.3g}", one["tolerance"], one["worst"], breaks, one["baseline"]
        rows.append((one["id"], one["parameter"], *values))
    return Result(
        summary=f"{len(records) - len(failed)} of {len(records)} checks are within their tolerance.",
        tables=[Table("Stress checks", COLUMNS, rows, [NOTE])],
        warnings=[f"{name} fails" for name in failed],
        data={"checks": records},
    )
