"""Charts of a chain's axial inertia."""

from typing import TYPE_CHECKING

import numpy as np

from verify.chain.departure import departure_of, rms
from verify.motion.validity import NONLINEAR
from verify.studies.chart import Axis, Chart, Line
from verify.studies.charting import BROAD, GREY, MEAN_COLOUR, RAYLEIGH, TIMOSHENKO, in_units, line, plain_line, thinned
from verify.studies.told import Column, Table
from verify.units import time_in_words, unit_of, unit_over

if TYPE_CHECKING:
    from verify.studies.axial_inertia.figures import AxialFound

NAMES = {
    "exact": "exact field",
    "fem": "Hermite elements",
    "linear": "linear chain",
    "full": "chain of rigid links",
    "transverse": "rigid links without axial inertia",
    "elastic": "links that stretch by EA/l",
}
_COLOURS = {
    "exact": GREY,
    "fem": "#e8760c",
    "linear": MEAN_COLOUR,
    "full": "#2f80ed",
    "transverse": RAYLEIGH,
    "elastic": TIMOSHENKO,
}


def axial_charts(study: "AxialFound") -> tuple[Chart, ...]:
    """Every model at one force in time, the departure from the linear chain over the force, and one bent far."""
    from verify.studies.axial_inertia.bending_movie import bending_movie

    charts = (_lines(study), _departures(study))
    return (*charts, bending_movie(study.beam, _COLOURS["full"])) if study.beam is not None else charts


def _lines(study: "AxialFound") -> Chart:
    time, up = unit_of(study.duration, "s"), unit_over(w for values in study.lines.values() for w in values)
    times = thinned(study.times)
    return Chart(
        id="axial-models",
        title=f"Deflection at x = {study.x:g} m under {study.shown:g} N, N = {study.count}",
        caption=_apart(study),
        x=Axis(f"time, {time.name}"),
        y=Axis(f"deflection, {up.name}"),
        lines=tuple(
            in_units(_in_time(model, times, thinned(values)), time, up) for model, values in study.lines.items()
        ),
    )


def _in_time(model: str, times: list[float], values: list[float]) -> Line:
    return plain_line(
        NAMES[model],
        _COLOURS[model],
        times,
        values,
        width=BROAD if model == "exact" else 1.6,
        dash="dot" if model in ("transverse", "elastic") else "solid",
    )


def _apart(study: "AxialFound") -> str:
    """How far the chains lie from the linear one, and that from the exact field, as found."""
    lines = {model: np.asarray(values) for model, values in study.lines.items()}
    linear, exact = lines["linear"], lines["exact"]
    off = [
        f"{NAMES[links]} {departure_of(lines[links], linear).rms:.1e}" for links in ("full", "transverse", "elastic")
    ]
    return (
        f"From rest, undamped. Off the linear chain, as rms over its own: {', '.join(off)}. The linear chain lies "
        f"{rms(linear - exact) / rms(exact):.1e} off the exact field, by its division into links alone."
    )


def _departures(study: "AxialFound") -> Chart:
    rows = sorted(study.rows, key=lambda row: row.force)
    forces = [row.force for row in rows]
    size = plain_line("(kL)² ⟨θ²⟩", GREY, forces, [row.size for row in rows], width=BROAD)
    lines = [
        line(
            f"{NAMES[links]}, {word}",
            _COLOURS[links],
            forces,
            [getattr(getattr(row, links), of) for row in rows],
            dash="solid" if of == "at_end" else "dash",
        )
        for links in ("full", "transverse", "elastic")
        for of, word in (("at_end", "at the end"), ("rms", "rms"))
    ]
    return Chart(
        id="axial-departures",
        title=f"Departure from the linear chain at x = {study.x:g} m over the force, N = {study.count}",
        caption="Over the linear chain's rms deflection: at the end of the run, and as rms over the run. Grey: the "
        f"number that decides between linear and nonlinear, felt from {NONLINEAR:g} on: the size of a term, no bound "
        "of what it does in time.",
        x=Axis("force, N", log=True),
        y=Axis("departure, relative", log=True),
        lines=(size, *lines),
    )


def axial_tables(study: "AxialFound") -> tuple[Table, ...]:
    """Departures over the force, and models side by side."""
    return _forces_table(study), _beside_table(study)


def _forces_table(study: "AxialFound") -> Table:
    return Table.of(
        before="Rigid links cannot stretch: bending draws the sliding tip in and takes the mass of the chain along. "
        "This axial inertia, of relative size (kL)² ⟨θ²⟩, makes a chain of rigid links nonlinear, not the amplitude "
        "over the thickness. Below, how far each chain lies from the linear chain of as many links, over the linear "
        f"chain's rms deflection at x = {study.x:g} m, at the end of {time_in_words(study.duration)} from rest (at "
        "end), and as rms over that time (rms). A longer run may depart by more. Other places depart by more or less: "
        "beside it the range of the rigid links' figure at the end over the tenths of the beam.",
        columns=(
            Column("force", "g", unit=" N"),
            Column("rms deflection", ".3g", si="m"),
            Column("(kL)² ⟨θ²⟩", ".1e"),
            Column("decides for", left=True),
            Column("rigid links, at end", ".2e"),
            Column("rms", ".2e"),
            Column("tenths from", ".1e"),
            Column("to", ".1e"),
            Column("no axial inertia, at end", ".2e"),
            Column("rms", ".2e"),
            Column("links EA/l, at end", ".2e"),
            Column("rms", ".2e"),
        ),
        rows=tuple(
            (
                row.force,
                row.deflection_rms,
                row.size,
                "linear" if row.linear else "nonlinear",
                row.full.at_end,
                row.full.rms,
                *row.along,
                row.transverse.at_end,
                row.transverse.rms,
                row.elastic.at_end,
                row.elastic.rms,
            )
            for row in study.rows
        ),
    )


def _beside_table(study: "AxialFound") -> Table:
    return Table.of(
        title="Chains, elements and the exact field side by side",
        columns=(
            Column(f"model at {study.shown:g} N, N = {study.count}", left=True),
            Column("rms of the difference to the exact field over its rms", "size"),
            Column(f"deflection at {time_in_words(study.duration)}", "+.4f", si="m"),
        ),
        rows=tuple((NAMES[row.model], row.error or None, row.at_end) for row in study.beside),
        notes=(
            "The exact field is linear Euler-Bernoulli from rest, undamped like all the others. The beam itself "
            "stretches by its EA, as the links EA/l do: how far those depart is the beam's own, what rigid links "
            "depart by beside it is their model's. After a longer run both may be larger.",
        ),
    )
