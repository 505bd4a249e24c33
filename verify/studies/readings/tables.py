"""Tables of the readings of a slider."""

from typing import TYPE_CHECKING

from verify.studies.readings.words import (
    best_cells,
    cm_per_s,
    group_cells,
    legend,
    letter,
    met_words,
    turn_words,
)
from verify.studies.told import Column, Table

if TYPE_CHECKING:
    from verify.studies.readings.figures import Reading, ReadingsFound

_HEAD = tuple(Column(head, left=True) for head in ("model", "kinematics", "start", "place"))
_OTHERS = ("slider.mean_friction", "slider.largest_friction", "slider.mean_surface_speed")


def reading_tables(study: "ReadingsFound") -> tuple[Table, ...]:
    """What each group meets, the best of each, what verdicts turn with, all readings."""
    turns = (_turns(study),) if study.turns else ()
    return (_met(study), _best(study), *turns, _all(study))


def _met(study: "ReadingsFound") -> Table:
    letters = [letter(i) for i in range(len(study.claims))]
    each = len(study.groups[0].readings)
    counted = f", and how many of {each} readings each claim holds in:" if study.claims else f" of {each} readings:"
    return Table(
        before=f"mean speeds from and to, cm/s{counted} {legend(study)}".rstrip(),
        columns=(*_HEAD, Column("from"), Column("to"), *(Column(one) for one in letters)),
        rows=tuple(
            (
                *group_cells(group),
                *(cm_per_s(v) for v in group.speeds or (None, None)),
                *(group.n_meeting(i) for i in range(len(letters))),
            )
            for group in study.groups
        ),
        shown="both",
    )


def _best(study: "ReadingsFound") -> Table:
    chosen = "the first of those that meet most claims" if study.claims else "the first of each row"
    names = ("N", "mu", "K", "cm/s", "meets", "exact", "meets")
    return Table(
        before=f"{chosen}, and the same on the exact beam",
        columns=(
            *_HEAD,
            *(Column(name) for name in names),
            Column("lift-off", ".3g", wide=True),
            Column("nonlinearity", ".1e", wide=True),
        ),
        rows=tuple(
            (*group_cells(group), *best_cells(group), group.best.lift_off, group.best.nonlinearity)
            for group in study.groups
        ),
        shown="both",
    )


def _turns(study: "ReadingsFound") -> Table:
    return Table(
        before="what a verdict turns with: share of neighbouring linear readings, one thing apart, that differ",
        columns=(Column("claim", left=True), Column("turns with", left=True)),
        rows=tuple(turn_words(study)),
        shown="both",
    )


def _all(study: "ReadingsFound") -> Table:
    return Table.of(
        title=f"All {len(study.readings)} readings",
        columns=(
            *_HEAD[:3],
            Column("place, m", "g"),
            Column("force, N"),
            Column("mu", "g"),
            Column("K, s/m", "g"),
            Column("mass, g", ".3g", 1e3),
            Column("cm/s"),
            Column("mean friction", "+.3g", si="N"),
            Column("largest", "+.3g", si="N"),
            Column("mean surface speed, mm/s", "+.3g", 1e3),
            Column("holds", left=True),
        ),
        rows=tuple(_reading_cells(one) for one in study.readings),
        notes=(
            "Lift-off and nonlinearity above are those of the slider's own run: a linear model leaves the latter out "
            "whatever the force, the nonlinear chain keeps it, the shortening of its links included.",
        ),
        folded=True,
    )


def _reading_cells(one: "Reading") -> tuple[str | float | None, ...]:
    how = one.condition
    return (
        how.kind_words,
        how.kinematics,
        how.start_words,
        how.position,
        how.force_words.removesuffix(" N"),
        how.mu,
        how.slope,
        one.mass,
        cm_per_s(one.speed),
        *(one.figures.get(name) for name in _OTHERS),
        met_words(one),
    )
