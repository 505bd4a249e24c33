"""Published statements beside the computed values: claimed, computed, whether they agree, source. No gate."""

from typing import Any

from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import missing
from verify.errors import InputError
from verify.quantities.base import QUANTITIES, evaluate
from verify.report.result import Column, Result
from verify.scene.model import Claim
from verify.studies.base import Progress, Scene, Study
from verify.studies.charts import table, unit_symbol

READ = {"stated": "stated", "figure": "read off a figure", "follows": "implied"}
COLUMNS = {Column("claim"): "id", Column("quantity"): "quantity", Column("claimed"): "claimed"}
COLUMNS |= {Column("computed", format="+.5g"): "computed", Column("unit"): "unit", Column("agrees"): "agrees"}
COLUMNS |= {Column("exact beam", format="+.5g"): "exact", Column("exact beam agrees"): "exact_agrees"}
COLUMNS |= {Column("source"): "source"}
NOTES = [
    "A claim without arguments is computed on the scene's own slider: segments (motion.count), exact beam.",
    "Each agrees, or does not, under the scene's conditions only; the verdict of a run is that of its gates.",
]


class Claims(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The scene's claims. There is no section of this name: [[claim]] implies it."""

    name, title, devices = "claims", "Published statements and computed values", True

    def check(self, scene: Scene) -> None:
        """Raise InputError for a claim on the scene's slider where the scene runs none."""
        for claim in scene.claim:
            if of_scene(claim) and (scene.slider is None or scene.motion is None):
                subject = f"claim.{claim.id} is about the scene's slider and the scene has no"
                table_name = "slider" if scene.slider is None else "motion"
                raise InputError(f"{subject} [{table_name}]: add it, or give the claim arguments")

    def run(self, scene: Scene, cache: SolutionCache, progress: Progress) -> Result:
        """Evaluate every claim; one that cannot be evaluated is a row with the reason."""
        rows, reasons = list[dict[str, Any]](), list[str]()
        for claim in scene.claim:
            progress(f"claim {claim.id}")
            row: dict[str, Any] = {"id": claim.id, "quantity": claim.quantity, "claimed": claim.expected}
            row |= {"computed": None, "unit": "", "agrees": None, "exact": None, "exact_agrees": None}
            row["source"] = f"{claim.source} ({READ[claim.read]})"
            try:
                quantity = QUANTITIES.named(claim.quantity, f"claim.{claim.id}.quantity")
                row["unit"] = unit_symbol(quantity.unit_of(claim.arguments))
                row["computed"] = computed(claim, scene, cache)
                row["agrees"] = claim.agrees(row["computed"])
                if of_scene(claim):
                    row["exact"] = computed(claim, scene, cache, model="analytic", count=None)
                    row["exact_agrees"] = claim.agrees(row["exact"])
            except InputError as error:
                reasons.append(f"{claim.id}: {error}")
            rows.append(row)
        agree = [row["agrees"] for row in rows if row["agrees"] is not None]
        return Result(
            summary=f"{sum(agree)} of {len(agree)} published statements agree with the computed values." * bool(agree),
            tables=[table("Claimed and computed", rows, COLUMNS, *NOTES)],
            margins=missing("claims", len(reasons), len(rows), "; ".join(reasons)),
            data={"claims": rows},
        )


def of_scene(claim: Claim) -> bool:
    """Whether it is about the scene's own slider: a quantity of the slider without arguments."""
    return claim.quantity.startswith("slider.") and not claim.arguments


def computed(claim: Claim, scene: Scene, cache: SolutionCache, **other: Any) -> float:
    """The value of its quantity, with `other` arguments. Raises InputError."""
    defaults = {"model": "segment", "count": scene.motion.size(scene, cache)} if of_scene(claim) else claim.arguments
    arguments = {name: value for name, value in (defaults | other).items() if value is not None}
    value = evaluate(claim.quantity, arguments, scene, cache)
    if not isinstance(value, float | int):
        raise InputError(f"claim.{claim.id}.quantity = {claim.quantity!r} is no real number: claim another quantity")
    return float(value)
