"""Which rows there are, by family; a family is imported when its rows are asked for."""

from functools import cache
from importlib import import_module

from verify.errors import InputError, near_name
from verify.stress.kind import Row

FAMILIES = (
    *(
        "sizes",
        "scales",
        "standing",
        "floating",
        "drive",
        "friction",
        "turns",
        "runs",
        "growth",
        "many",
        "laws",
        "books",
    ),
    *("anything", "written", "moving", "moved", "tableaux", "waves", "sheared", "resonances"),
    *("choices", "rules", "felt", "stacked", "coiled", "bent", "walls", "let_go", "feet", "thrown"),
    *("said", "verdicts", "readings", "sliders", "slips", "stretched", "every", "best", "listed"),
    *("carried", "ridden", "mixed", "sought", "edges", "shown"),
    *("verges", "allowed", "verbs", "ways", "damped", "means", "searches"),
    *("layouts", "heard", "shaped", "worded", "signed", "solved"),
    *("folds", "clasped", "pencils", "enough", "yielded", "tried", "answered", "before"),
    *("refused_verbs", "refused_modes", "refused_waves", "refused_motion", "refused_chain", "refused_runs"),
)
"""Modules of this room with `ROWS`, in the order of the table."""


@cache
def rows() -> dict[str, Row]:
    """Every row by its id."""
    found: dict[str, Row] = {}
    for family in FAMILIES:
        for row in import_module(f"verify.stress.{family}").ROWS:
            found[row.id] = row
    return found


def row(name: str, field: str = "row") -> Row:
    """One of them. Raises InputError with the nearest id."""
    if name not in rows():
        raise InputError(f"{field} = {name!r} is not known: {near_name(name, tuple(rows()))}")
    return rows()[name]
