"""Tables of the slider: how far its runs can be believed, and run time against error."""

from typing import TYPE_CHECKING

from verify.models.catalogue import MODELS
from verify.motion.contact import FELT
from verify.studies.told import Column, Read, Table

if TYPE_CHECKING:
    from verify.motion.result import Motion
    from verify.studies.slider.figures import SliderFound
    from verify.studies.slider.work_precision import Work


NEAREST = ", at the mode nearest the drive."
LIFT_OFF = (
    "Lift-off is the largest acceleration of the surface over what presses the slider on: above 1 a real slider leaves "
    "the surface, which this law forbids it."
)
NONLINEARITY = "Nonlinearity is (kL)² ⟨θ²⟩, the axial inertia of a roller-ended chain."
LEFT_OVER = "Energy left over is what the books miss, of the work of the forces."
COUPLING = (
    "The coupling is one-way where the larger of the two sizes that act, of friction and of the inertia of a slider "
    f"held on the surface, is below {FELT:g}, unless the scene says which."
)

MARGINS = (
    Column("model", left=True),
    Column("displacement", "+.4g", si="m"),
    Column("steps"),
    Column("coupling", left=True, said=COUPLING),
    Column("lift-off", ".3g", said=LIFT_OFF),
    Column("nonlinearity", ".1e", said=NONLINEARITY),
    Column("theory", "percent", said=f"Theory is Timoshenko against Euler-Bernoulli{NEAREST}"),
    Column("division", "percent", said=f"Division is the discrete frequency error{NEAREST}"),
    Column("energy left over", ".1e", said=LEFT_OVER),
)
"""Of how far a run can be believed."""


def margins_table(study: "SliderFound") -> Table:
    """Every run with its coupling, its margins and its books."""
    rows = tuple((MODELS[model].title, *_margins(run)) for model, run in study.runs.items())
    return Table.of(
        MARGINS,
        rows,
        title="How far these runs can be believed",
        before=f"{study.condition.words[:1].upper()}{study.condition.words[1:]}; all models under the same condition.",
    )


def _margins(run: "Motion") -> tuple[str | float | None, ...]:
    coupling, margins, ledger = run.coupling, run.margins, run.ledger
    assert coupling is not None
    how = ("two-way: " if coupling.two_way else "one-way: ") + coupling.told
    return (
        run.displacement,
        run.statistics.steps,
        f"{how}; {coupling.simplified}" if coupling.simplified else how,
        margins.lift_off,
        margins.nonlinearity,
        margins.model_form,
        margins.discretisation,
        ledger.residual / ledger.work_in if ledger and ledger.work_in else None,
    )


def work_table(work: "Work") -> Table:
    """Displacement, error and run time of every model at every size."""
    return Table.over(
        work.rows,
        WORK,
        title="Run time against error",
        notes=(
            "Errors against the exact beam at the same step, half of which changes it by "
            f"{100 * work.step_floor:.1g} %; run time of the loop for a simulated millisecond, and set-up "
            "(modes, tables, margins): processor time in one thread, medians of interleaved rounds. All of it one-way: "
            "the beam does not feel the slider.",
            *_not_its_own(work.felt),
        ),
    )


def _not_its_own(felt: str) -> tuple[str, ...]:
    """A note where the beam feels the scene's own slider, which these runs are not of."""
    if not felt:
        return ()
    return (
        f"The beam feels the scene's own slider, two-way ({felt}): these displacements and errors are of "
        "coupling = 'one-way', not the scene's.",
    )


WORK: tuple[Read, ...] = (
    (Column("model", left=True), lambda r: r.model),
    (Column("N"), lambda r: r.count),
    (Column("modes"), lambda r: r.rows),
    (Column("displacement", "+.6f", si="m"), lambda r: r.displacement),
    (Column("error %", "bare percent"), lambda r: r.error),
    (Column("order", ".2f"), lambda r: r.order),
    (Column("ms per ms", ".3g"), lambda r: r.run_ms_per_ms),
    (
        Column("spread %", ".0f", 100.0, wide=True, said="Spread: of the loop's run time."),
        lambda r: r.run_spread,
    ),
    (Column("set-up ms", ".3g"), lambda r: r.set_up_ms),
)
