"""How linear a chain of rigid links is: its axial inertia over the force, beside linear models and the beam.

Rigid links cannot stretch, so that bending draws the tip in and takes the mass of the chain along: an inertia of
relative size (kL)^2 <theta^2>, which grows with the square of the force, whatever the amplitude is in thicknesses.
Links that stretch as the beam does (EA / l) have it too, less or more of it. Everything here starts from
rest and is undamped; all forces have one amplitude.
"""

from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.chain.departure import (
    Departure,
    Driven,
    Links,
    along_the_beam,
    chain_deflection,
    departure_of,
    driven_chain,
    elastic_chain,
    linear_chain,
    rigid_chain,
    rms,
)
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.motion.simulate import simulate
from verify.motion.validity import NONLINEAR, axial_inertia_size, field_size
from verify.patience import check_work
from verify.studies.axial_inertia.request import LINK_STEP_S, STEPPED, AxialInertia, n_stepped, steps_of
from verify.studies.chart import Chart
from verify.studies.kind import Progress
from verify.studies.told import Found, Table
from verify.units import time_in_words
from verify.words import percent

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.scenes.scene import Scene


class ForceRow(msgspec.Struct, frozen=True, kw_only=True):
    """One amplitude of the forces."""

    force: float
    """Newton."""
    deflection_rms: float
    """Of the chain of rigid links at the place read, metres."""
    size: float
    """(kL)^2 <theta^2>, the mean over the links and the run."""
    linear: bool
    """Whether that number lets the linear chain stand for it."""
    full: Departure
    transverse: Departure
    elastic: Departure
    along: tuple[float, float]
    """Least and largest `full.at_end` at the tenths of the beam and at the place read."""


class Beside(msgspec.Struct, frozen=True, kw_only=True):
    """One model at the force of the comparison."""

    model: str
    error: float
    """Rms of the difference to the exact field over the exact field's rms."""
    at_end: float
    """Deflection at the end of the run, metres."""


class AxialFound(Found, frozen=True, eq=False, kw_only=True):
    """Everything the report shows of a chain's axial inertia."""

    rows: tuple[ForceRow, ...]
    beside: tuple[Beside, ...]
    """Exact field, Hermite elements, linear chain, nonlinear chains."""
    times: tuple[float, ...]
    lines: dict[str, tuple[float, ...]]
    """Deflection by model as in `beside`, metres."""
    shown: float
    """Newton: the force of the comparison."""
    count: int
    duration: float
    x: float
    """Metres from the left end: the place read."""
    beam: "Beam | None" = None

    def in_short(self) -> str:
        """Up to which force the linear chain will do."""
        linear = [row.force for row in self.rows if row.linear]
        beyond = [row for row in self.rows if not row.linear]
        upto = (
            f"Up to {max(linear):g} N the linear chain stands for the chain of rigid links"
            if linear
            else ("At none of these forces the linear chain stands for the chain of rigid links")
        )
        first = min(beyond, key=lambda row: row.force, default=None)
        apart = f"; at {first.force:g} N they lie {percent(first.full.at_end, sign=False)} apart" if first else ""
        return f"{upto}{apart} (N = {self.count}, x = {self.x:g} m, after {time_in_words(self.duration)})."

    def facts(self) -> tuple[str, ...]:
        """A sentence for each force."""
        return tuple(self._fact(row) for row in self.rows)

    def _fact(self, row: ForceRow) -> str:
        verdict = "linear" if row.linear else "nonlinear"
        low, high = row.along
        return (
            f"{row.force:g} N: {verdict}, (kL)^2 <theta^2> {row.size:.1e}; rigid links lie {row.full.at_end:.1e} off "
            f"after {time_in_words(self.duration)} at x = {self.x:g} m, {low:.1e} to {high:.1e} at the tenths of the "
            "beam"
        )

    def tables(self) -> tuple[Table, ...]:
        """Departures over the force, and models side by side."""
        from verify.studies.axial_inertia.charts import axial_tables

        return axial_tables(self)

    def charts(self) -> tuple[Chart, ...]:
        """Every model at one force in time, and the departure from the linear chain over the force."""
        from verify.studies.axial_inertia.charts import axial_charts

        return axial_charts(self)

    def plain(self) -> Any:
        """Departures over the force, models side by side at one of them."""
        return {
            "count": self.count,
            "duration": self.duration,
            "x": self.x,
            "rows": msgspec.to_builtins(self.rows),
            "shown": self.shown,
            "beside": msgspec.to_builtins(self.beside),
        }

    def records(self) -> list[dict[str, Any]]:
        """A row for each force, SI."""
        return [_flat(row) for row in self.rows]

    def motions(self) -> int:
        """Three under each force, and each model once."""
        return STEPPED * len(self.rows) + len(self.lines)


def _flat(row: ForceRow) -> dict[str, Any]:
    flat: dict[str, Any] = {
        "force": row.force,
        "deflection_rms": row.deflection_rms,
        "size": row.size,
        "linear": row.linear,
        "along_least": row.along[0],
        "along_largest": row.along[1],
    }
    for links, one in (("full", row.full), ("transverse", row.transverse), ("elastic", row.elastic)):
        flat |= {f"{links}_at_end": one.at_end, f"{links}_rms": one.rms}
    return flat


def force_row(driven: Driven, force: float, unit: Array) -> ForceRow:
    """Every chain under one force; `unit` is the linear chain's deflection for 1 N, (n,). Raises InputError."""
    motion, linear = rigid_chain(driven, force), force * unit
    size = axial_inertia_size(driven.beam, driven.frequency_hz, rms(motion.directions()) ** 2)
    rigid = np.asarray(motion.deflection([driven.x])[:, 0])
    return ForceRow(
        force=force,
        deflection_rms=rms(rigid),
        size=size,
        linear=size <= NONLINEAR,
        full=departure_of(rigid, linear),
        transverse=departure_of(chain_deflection(driven, force, "transverse"), linear),
        elastic=departure_of(elastic_chain(driven, force), linear),
        along=along_the_beam(driven, motion, force),
    )


def side_by_side(driven: Driven, force: float, unit: Array) -> dict[str, Array]:
    """Deflections (n,) of every model, the exact field first, metres. Raises InputError."""
    lines = {name: _linear_beam(driven, force, model) for name, model in (("exact", "analytic"), ("fem", "fem"))}
    lines["linear"] = force * unit
    chains: tuple[Links, ...] = ("full", "transverse", "elastic")
    return lines | {links: chain_deflection(driven, force, links) for links in chains}


def _linear_beam(driven: Driven, force: float, model: str) -> Array:
    """Of the exact beam or of as many Hermite elements as links, undamped, exact in time."""
    motion = simulate(
        driven.beam,
        driven.under(force),
        driven.frequency_hz,
        float(driven.times[-1]),
        model=model,
        count=driven.count if MODELS[model].sized else None,
        modal_damping=0.0,
        at=[driven.x],
        samples=len(driven.times),
        ledger=False,
    )
    return np.asarray(motion.deflection[:, 0])


def axial_study(scene: "Scene", asked: AxialInertia, progress: Progress = lambda step: None) -> AxialFound:
    """Everything an [axial_inertia] of a scene asks for. Raises InputError."""
    seconds = LINK_STEP_S * asked.count * n_stepped(asked) * steps_of(asked, scene)
    check_work("axial_inertia.duration", asked.duration, seconds, "shorten it, or give fewer links or forces")
    driven = driven_chain(scene, "axial_inertia", asked.count, asked.duration, asked.x)
    unit, rows = linear_chain(driven), []
    for force in asked.forces:
        progress(f"axial inertia, {force:g} N")
        rows.append(force_row(driven, force, unit))
    progress("axial inertia, models side by side")
    lines = side_by_side(driven, asked.shown, unit)
    exact = lines["exact"]
    beside = tuple(
        Beside(model=model, error=rms(line - exact) / rms(exact), at_end=float(line[-1]))
        for model, line in lines.items()
    )
    return AxialFound(
        rows=tuple(rows),
        beside=beside,
        times=tuple(driven.times.tolist()),
        shown=asked.shown,
        count=asked.count,
        lines={model: tuple(line.tolist()) for model, line in lines.items()},
        duration=asked.duration,
        x=driven.x,
        beam=scene.beam,
    )


def linear_up_to(asked: AxialInertia, scene: "Scene") -> tuple[tuple[str, str], ...]:
    """(up to which force the linear chain will do, the numbers that say so); nothing on a resonance."""
    assert scene.drive is not None
    forces = [replace(force, amplitude=1.0) for force in scene.forces]
    try:
        field = MODELS["analytic"].solve_harmonic(scene.beam, forces, scene.drive.frequency_hz, None)
    except InputError:
        return ()
    size = field_size(field)
    sizes = ", ".join(f"{size * force**2:.1e} at {force:g} N" for force in asked.forces)
    limit = f"up to {(NONLINEAR / size) ** 0.5:.2g} N, nonlinear above" if size else "at any force"
    why = "decided by the axial inertia, (kL)^2 <theta^2> of the steady field"
    return ((f"linear chain {limit}", f"{why}: {sizes} (felt from {NONLINEAR:g} on)"),)
