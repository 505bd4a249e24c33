"""Departure of a nonlinear chain from the linear one over the force: its axial inertia, beside linear models.

Rigid links cannot stretch, so that bending draws the tip in and accelerates the mass of the chain along the beam: an
inertia of relative size (kL)² <theta²>, which grows with the square of the force. Links that stretch as the beam does
(EA/l) have part of it. All runs start from rest and are undamped; all forces have one amplitude.
"""

from math import ceil
from typing import TYPE_CHECKING, Annotated, Any, ClassVar

from msgspec import Meta

from verify.errors import InputError
from verify.studies.base import Progress, Study
from verify.studies.charts import model_style, percent, plot_lines, si
from verify.validation import check_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.analysis.solution_cache import SolutionCache
    from verify.arrays import Array
    from verify.options import Inertia
    from verify.report.result import Result
    from verify.scene.model import Scene

CHAINS: "dict[Inertia, str]" = {
    "full": "rigid links",
    "transverse": "without axial inertia",
    "elastic": "stretching links",
}
NAMES: dict[str, str] = {"exact": "exact beam", "fem": "Hermite elements", "linear": "linear chain"}
NAMES |= {str(links): name for links, name in CHAINS.items()}
STYLES: dict[str, dict[str, Any]] = {
    "linear": {"color": "#2a9d5c"},
    "full": {"color": "#2f80ed"},
    "transverse": {"color": "#8f5bd1", "linestyle": ":"},
    "elastic": {"color": "#cc3f76", "linestyle": ":"},
}
FORCES = (0.1, 1.0, 10.0, 30.0)
SUPPORTS = (("pinned", "pinned"), ("clamped", "pinned"), ("clamped", "free"))
DEPARTURES = (
    "Over the rms deflection of the linear chain: solid at the end of the run, dashed rms over the run. Grey: (kL)² "
    "⟨θ²⟩, the size of the neglected term."
)


class AxialInertia(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Departure of chains of rigid and stretching links from the linear chain, over the force."""

    name: ClassVar[str] = "axial_inertia"
    title: ClassVar[str] = "Nonlinearity of the chain of rigid links"

    forces: Annotated[tuple[float, ...], Meta(min_length=1, description="Amplitudes of all forces in turn, N.")] = (
        FORCES
    )
    shown: Annotated[float, Meta(description="Amplitude at which all models are compared, N.")] = 10.0
    count: Annotated[int, Meta(ge=2, le=250, description="Links, and elements beside them.")] = 49
    duration: Annotated[float, Meta(description="Duration from rest, s.")] = 1e-3
    x: Annotated[float | None, Meta(description="Position of the deflection, m; mid-span unless set.")] = None

    def __post_init__(self) -> None:
        for i, force in enumerate(self.forces):
            check_number(f"axial_inertia.forces[{i}]", force, "newton", above=0)
        for name, unit in (("shown", "newton"), ("duration", "seconds"), ("x", "metres")):
            if getattr(self, name) is not None:
                check_number(f"axial_inertia.{name}", getattr(self, name), unit, above=0)

    def check(self, scene: "Scene") -> None:
        """Raise InputError unless the beam is a chain with a sliding tip, undamped and driven by forces."""
        beam = scene.beam
        if scene.drive is None or scene.drive.kind != "force" or not scene.forces:
            raise InputError("axial_inertia: the chain is driven by forces, add a [drive] of kind force")
        beam.check_added("axial_inertia")
        if beam.supports not in SUPPORTS:
            raise InputError(
                f"axial_inertia with beam.supports = {list(beam.supports)!r}: give pinned-pinned, clamped-pinned or "
                "clamped-free"
            )
        if beam.loss_factor:
            raise InputError(
                f"axial_inertia with beam.loss_factor = {beam.loss_factor!r}: its chains are undamped, give 0"
            )
        if self.x is not None and self.x > beam.length:
            raise InputError(f"axial_inertia.x = {self.x!r} lies off the beam: give up to {beam.length!r} m")

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Integrate every chain under every force. Raises InputError."""
        import numpy as np

        from verify.chain import departure as chains
        from verify.dynamics.simulate import simulate
        from verify.dynamics.validity import NONLINEAR, axial_inertia_size
        from verify.report.result import Column, Figure, Result, Table

        assert scene.drive is not None
        hertz = scene.drive.frequency_hz
        n = max(chains.SAMPLES, ceil(chains.SAMPLES_PER_PERIOD * hertz * self.duration) + 1)
        driven = chains.Driven(
            beam=scene.beam,
            forces=scene.forces,
            frequency_hz=hertz,
            count=self.count,
            x=0.5 * scene.beam.length if self.x is None else self.x,
            times=np.linspace(0.0, self.duration, n),
        )
        unit = chains.linear_chain(driven)
        rows: list[dict[str, Any]] = []
        for force in self.forces:
            progress(f"chains under {force:g} N")
            motion = chains.rigid_chain(driven, force)
            size = axial_inertia_size(driven.beam, driven.frequency_hz, chains.rms(motion.directions()) ** 2)
            rigid = np.asarray(motion.deflection([driven.x])[:, 0])
            row: dict[str, Any] = {"force": force, "deflection_rms": chains.rms(rigid), "size": size}
            row |= {"linear": size <= NONLINEAR, "full": chains.departure_of(rigid, force * unit)}
            for links in ("transverse", "elastic"):
                deflection = chains.chain_deflection(driven, force, links)
                row[links] = chains.departure_of(deflection, force * unit)
            rows.append(row | {"along": chains.along_the_beam(driven, motion, force)})
        progress(f"all models under {self.shown:g} N")
        lines: dict[str, Array] = {}
        for name, model, count in (("exact", "analytic", None), ("fem", "fem", self.count)):
            run = simulate(
                driven.beam,
                driven.under(self.shown),
                driven.frequency_hz,
                float(driven.times[-1]),
                model=model,
                count=count,
                modal_damping=0.0,
                at=[driven.x],
                samples=len(driven.times),
            )
            lines[name] = np.asarray(run.deflection[:, 0])
        lines["linear"] = self.shown * unit
        for chain in CHAINS:
            lines[chain] = chains.chain_deflection(driven, self.shown, chain)
        scale = chains.rms(lines["exact"])
        beside = [(NAMES[m], chains.rms(w - lines["exact"]) / scale or None, float(w[-1])) for m, w in lines.items()]

        columns = [Column("force", "N", "g"), Column("(kL)² ⟨θ²⟩", format=".1e"), Column("linear"), Column("chain")]
        columns += [Column("departure at the end", format=".2e"), Column("departure, rms", format=".2e")]
        columns += [Column("least along the beam", format=".1e"), Column("largest along the beam", format=".1e")]
        cells = [
            (row["force"], row["size"], row["linear"], name, row[chain].at_end, row[chain].rms)
            + (row["along"] if chain == "full" else (None, None))
            for row in rows
            for chain, name in CHAINS.items()
        ]
        compared = [Column("model"), percent("rms difference from the exact beam"), si("final deflection", "m", "+.5g")]
        where = f"x = {driven.x:g} m, N = {self.count}, {1e3 * self.duration:g} ms"
        worst = max(rows, key=lambda row: row["force"])
        apart = f"{100 * worst['full'].at_end:.3g} % from the linear chain at {worst['force']:g} N"
        styles = {"exact": model_style("analytic"), "fem": model_style("fem")} | STYLES
        deflections = [(NAMES[m], driven.times, w, styles[m]) for m, w in lines.items()]
        return Result(
            summary=f"The chain of rigid links lies {apart} ({where}).",
            tables=[
                Table(f"Departure from the linear chain, {where}", columns, cells),
                Table(f"All models at {self.shown:g} N, {where}", compared, beside),
            ],
            figures=[
                Figure(
                    "axial-models",
                    f"Deflection under {self.shown:g} N, {where}",
                    "From rest, undamped.",
                    lambda ax: plot_lines(ax, deflections, ("time", "s"), ("deflection", "m")),
                ),
                Figure(
                    "axial-departures",
                    f"Departure from the linear chain, {where}",
                    DEPARTURES,
                    lambda ax: _draw_departures(ax, sorted(rows, key=lambda row: float(row["force"]))),
                ),
            ],
            data={"x": driven.x, "rows": rows},
        )


def _draw_departures(ax: "Axes", rows: list[dict[str, Any]]) -> None:
    forces = [row["force"] for row in rows]
    ax.loglog(forces, [row["size"] for row in rows], color="#7d8590", linewidth=4.0, label="(kL)² ⟨θ²⟩")
    for links, name in CHAINS.items():
        color = STYLES[links]["color"]
        ax.loglog(forces, [row[links].at_end for row in rows], "-o", color=color, label=name)
        ax.loglog(forces, [row[links].rms for row in rows], "--o", color=color)
    ax.set(xlabel="force, N", ylabel="relative departure")
    ax.legend()
