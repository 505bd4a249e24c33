"""Departure of the nonlinear chain from the linear one over the force, by axial inertia: rigid and stretching links.

All runs start from rest and are undamped; all forces have one amplitude. See `verify.chain.benchmarks`.
"""

from typing import TYPE_CHECKING, Annotated, ClassVar, TypeAlias

from msgspec import Meta
from msgspec.structs import replace

from verify.errors import InputError
from verify.studies.base import Progress, Study
from verify.validation import check_number

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from verify.analysis.solution_cache import SolutionCache
    from verify.options import Inertia
    from verify.report.result import Result
    from verify.scene.model import Scene

Forces: TypeAlias = tuple[Annotated[float, Meta(gt=0)], ...]
CHAINS: "dict[Inertia, tuple[str, str]]" = {
    "full": ("rigid links", "#2f80ed"),
    "transverse": ("without axial inertia", "#8f5bd1"),
    "elastic": ("stretching links", "#cc3f76"),
}
CAPTION = (
    "Over the rms deflection of the linear chain: solid at the end of the run, dashed rms over the run. Grey: (kL)² "
    "⟨θ²⟩, the size of the neglected term."
)


class AxialInertia(Study, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Departure of chains of rigid and stretching links from the linear chain, over the force."""

    name: ClassVar[str] = "axial_inertia"
    title: ClassVar[str] = "Nonlinearity of the chain of rigid links"

    forces: Annotated[Forces, Meta(min_length=1, description="Amplitudes of all forces, N.")] = (1.0, 10.0, 30.0)
    count: Annotated[int, Meta(ge=2, le=250, description="Links.")] = 49
    duration: Annotated[float, Meta(gt=0, description="Duration from rest, s.")] = 1e-3
    x: Annotated[float | None, Meta(description="Position of the deflection, m; mid-span unless set.")] = None

    def __post_init__(self) -> None:
        for i, force in enumerate(self.forces):
            check_number(f"axial_inertia.forces[{i}]", force, "newton", above=0)

    def check(self, scene: "Scene") -> None:
        """Raise InputError unless the beam is a chain with a free or sliding tip, undamped and driven by forces."""
        from verify.chain.system import build_system

        if scene.drive is None or scene.drive.kind != "force" or not scene.forces:
            raise InputError("axial_inertia: the chain is driven by forces, add a [drive] of kind force")
        build_system(scene.beam, self.count)
        if self.x is not None:
            check_number("axial_inertia.x", self.x, "metres, on the beam", above=0, at_most=scene.beam.length)

    def run(self, scene: "Scene", cache: "SolutionCache", progress: Progress) -> "Result":
        """Integrate every chain under every force. Raises InputError."""
        from verify.chain.benchmarks import departure
        from verify.motion.validity import NONLINEAR, axial_inertia_size
        from verify.report.result import Column, Figure, Result, Table

        assert scene.drive is not None
        hertz, rows = scene.drive.frequency_hz, []
        for force in sorted(self.forces):
            progress(f"chains under {force:g} N")
            forces, size = [replace(one, amplitude=force) for one in scene.forces], 0.0
            for inertia, (name, _) in CHAINS.items():
                found = departure(scene.beam, forces, hertz, self.duration, self.count, x=self.x, inertia=inertia)
                size = size or axial_inertia_size(scene.beam, hertz, found.slope**2)
                rows.append((force, size, size <= NONLINEAR, name, found.end, found.rms))
        x = 0.5 * scene.beam.length if self.x is None else self.x
        where = f"x = {x:g} m, N = {self.count}, {1e3 * self.duration:g} ms"
        columns = [Column("force", "N", "g"), Column("(kL)² ⟨θ²⟩", format=".1e"), Column("linear"), Column("chain")]
        columns += [Column("departure at the end", format=".2e"), Column("departure, rms", format=".2e")]

        def draw(ax: "Axes") -> None:
            for name, color in CHAINS.values():
                force, size, _, _, end, rms = zip(*(row for row in rows if row[3] == name), strict=True)
                ax.loglog(force, end, "-o", color=color, label=name)
                ax.loglog(force, rms, "--o", color=color)
            ax.loglog(force, size, color="#7d8590", linewidth=4.0, zorder=0, label="(kL)² ⟨θ²⟩")
            ax.set(xlabel="force, N", ylabel="relative departure")
            ax.legend()

        force, *_, end, _ = rows[-len(CHAINS)]
        return Result(
            summary=f"Rigid links depart from the linear chain by {100 * end:.3g} % at {force:g} N ({where}).",
            tables=[Table(f"Departure from the linear chain, {where}", columns, rows)],
            figures=[Figure("axial-departures", f"Departure from the linear chain, {where}", CAPTION, draw)],
            data={"x": x, "departures": rows},
        )
