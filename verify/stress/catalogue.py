"""Which rows there are, by family; a family is imported when its rows are asked for."""

from functools import cache
from importlib import import_module

from verify.errors import InputError, near_name
from verify.stress.kind import Row

GROUPS = {
    "modes": (
        *("sizes", "scales", "attached", "nearly_floating", "many_at_once", "laws", "all_supports"),
        *("any_beam", "written_out", "stacks", "mixed_stacks", "pencils", "felt", "mended"),
        *("small_systems", "searches", "rules", "read_off"),
    ),
    "waves": ("drives", "closed_forms", "resonances", "shear", "best_drives", "two_waves", "readings"),
    "motion": (
        *("long_runs", "in_time", "let_go", "damped_books", "phasors", "told_of_runs"),
        *("friction", "friction_branches", "sliders", "braked", "tableaux"),
    ),
    "chain": ("turned", "books", "written_out", "coils", "beyond_buckling", "folds", "stretching", "riders"),
    "motor": ("feet", "hard_points", "means", "gripping", "two_beams"),
    "judge": ("sizes_chosen", "sizes_enough", "side_by_side", "error_laws", "sought", "words", "defaults"),
    "limits": ("as_written", "judgements", "edges", "ways", "growth"),
    "lists": ("members", "layouts", "shapes", "clamps", "sizes_in_turn", "tables", "answers", "beforehand"),
    "refused": ("verbs", "modes", "waves", "motion", "chain", "runs"),
}
"""Folders of this room and their modules with `ROWS`, in the order of the table."""
FAMILIES = tuple(f"{group}.{module}" for group, modules in GROUPS.items() for module in modules)


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
