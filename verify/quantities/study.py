"""Numbers in the tables of a scene's studies, as an optimum or a share in a variance."""

from typing import Annotated

from msgspec import Meta

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.quantities.base import TABLES, Scene, quantity
from verify.studies.base import OWN, result_of


@quantity("study.value", unit="SI", reads=(*TABLES, *OWN), devices=True)
def value(
    scene: Scene,
    cache: SolutionCache,
    *,
    study: Annotated[str, Meta(description="name of its section, for instance optimise")],
    row: Annotated[str, Meta(description="first entry of the row")],
    column: Annotated[str, Meta(description="heading of the column, without its unit")],
) -> float:
    """A number in a table of a study of the scene, in its SI unit."""
    tables = [table.records() for table in result_of(study, scene, cache).tables]
    for record in (one for records in tables for one in records if str(next(iter(one.values()))) == row):
        if isinstance(found := record.get(column), int | float):
            return float(found)
    raise InputError(
        f"row = {row!r}, column = {column!r}: no table of [{study}] has a number there, see `verify table`"
    )
