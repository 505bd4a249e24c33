"""Named figures of the nonlinear chain."""

from typing import TYPE_CHECKING, Annotated, Any, Literal

from msgspec import Meta

from verify import options
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities.kind import Arguments, Mode, Quantity, Wall

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

Links = Annotated[int, Meta(ge=1, description="links of the chain; segments and count mean the same")]
Load = Annotated[float, Meta(description="P L^2 / EI of a dead transverse force at the tip")]
Component = Annotated[
    Literal["deflection", "shortening"], Meta(description="of the tip: w/L, or 1 - x/L along the beam")
]
Radii = Annotated[float, Meta(gt=0, description="at mid-span, in radii of gyration h / sqrt(12)")]
Step = Annotated[float, Meta(gt=0, description="fixed step of the motion, s; adaptive unless given")]
Method = Annotated[
    Literal["adaptive", "rk4", "modal", "linear"],
    Meta(description="modal: exact linear flow and kicks; linear: that flow alone; default rk4 with a step"),
]
Inertia = Annotated[
    Literal["full", "transverse"], Meta(description="of the links: transverse takes the inertia along x away")
]


class Chained(Arguments, frozen=True, kw_only=True):
    """A chain of so many links."""

    segments: Links

    @property
    def links(self) -> int:
        """N."""
        return self.segments


class TipUnderLoad(Chained, frozen=True, kw_only=True):
    """A loaded cantilever."""

    load: Load
    component: Component = "deflection"
    wall: Wall = "gregory"


class RolledUp(Chained, frozen=True, kw_only=True):
    """A cantilever rolled up once."""

    wall: Wall = "half"


class Hanging(Chained, frozen=True, kw_only=True):
    """One mode of a hanging chain."""

    mode: Mode


class Turning(Chained, frozen=True, kw_only=True):
    """One mode of a cantilever whose clamp turns."""

    mode: Mode
    speed: Annotated[float, Meta(ge=0, le=1e3, description="of the clamp, in sqrt(EI / (rho A L^4))")]
    wall: Wall = "gregory"


class LargeAmplitude(Chained, frozen=True, kw_only=True):
    """A hinged beam between immovable ends."""

    amplitude: Radii


class FreeMotion(Chained, frozen=True, kw_only=True):
    """An undamped chain let go."""

    amplitude: Annotated[float, Meta(gt=0, le=0.1, description="at mid-span, over L")] = 0.05
    periods: Annotated[float, Meta(gt=0, le=1000, description="of the linear first mode")] = 1.0
    step: Step | None = None
    tolerance: Annotated[float, Meta(gt=0, lt=0.1, description="of the adaptive step alone; default 1e-8")] | None = (
        None
    )

    def __post_init__(self) -> None:
        if self.step is not None and self.tolerance is not None:
            raise InputError(f"tolerance = {self.tolerance!r} with step = {self.step!r}: give one of the two")


class Departing(Chained, frozen=True, kw_only=True):
    """A nonlinear chain beside the linear one, driven from rest."""

    force: Annotated[float, Meta(gt=0, description="N, of every force of the scene's drive")]
    time: Annotated[float, Meta(gt=0, lt=0.1, description="s after the forces set in")] = 1e-3
    inertia: Annotated[
        options.Inertia,
        Meta(description="transverse: rigid links without inertia along x; elastic: links that stretch by EA / l"),
    ] = "full"
    of: Annotated[Literal["end", "rms"], Meta(description="the departure at that time, or its rms until then")] = "end"
    x: Annotated[float, Meta(gt=0, description="m from the left end; default mid-span")] | None = None


class FromRest(Chained, frozen=True, kw_only=True):
    """The driven chain at one time and place."""

    time: Annotated[float, Meta(gt=0, description="s after the forces of the scene's drive set in")]
    x: Annotated[float, Meta(ge=0, description="m from the left end, on the links")]
    step: Step | None = None
    force: Annotated[float, Meta(gt=0, description="N, of every force; default those of the scene's drive")] | None = (
        None
    )
    method: Method | None = None
    inertia: Inertia = "full"
    tolerance: Annotated[float, Meta(gt=0, lt=0.1, description="of the adaptive step alone; default 1e-9")] | None = (
        None
    )


def _cantilever_tip(a: TipUnderLoad, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return float(getattr(chain_studies.cantilever_tip(a.load, a.links, a.wall), a.component))


def _rollup_gap(a: RolledUp, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.rollup_gap(a.links, a.wall)


def _hanging_frequency(a: Hanging, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.hanging_frequency(a.mode, a.links)


def _turning_frequency(a: Turning, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.turning_frequency(a.mode, a.links, a.speed, a.wall)


def _large_amplitude_frequency(a: LargeAmplitude, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.large_amplitude_frequency(scene.beam, a.amplitude, a.links, bench.tell)


def _energy_drift(a: FreeMotion, scene: "Scene", bench: Workbench) -> float:
    from verify.chain import problems as chain_studies

    return chain_studies.energy_drift(
        scene.beam, a.links, a.amplitude, a.periods, a.step, a.tolerance or 1e-8, bench.tell
    )


def _transient_deflection(a: FromRest, scene: "Scene", bench: Workbench) -> float:
    from msgspec.structs import replace

    from verify.chain import problems as chain_studies
    from verify.studies.axial_inertia import point_forces

    forces = point_forces(scene, "chain.transient_deflection")
    assert scene.drive is not None
    if a.x > scene.beam.length:
        raise InputError(f"x = {a.x!r} lies off the chain: give up to {scene.beam.length!r} m")
    if a.force is not None:
        forces = tuple(replace(force, amplitude=a.force) for force in forces)
    method = a.method or ("rk4" if a.step is not None else "adaptive")
    motion = chain_studies.transient(
        scene.beam,
        forces,
        scene.drive.frequency_hz,
        [a.time],
        a.links,
        step=a.step,
        method=method,
        axial_inertia=a.inertia == "full",
        tolerance=a.tolerance,
        progress=bench.tell,
    )
    return float(motion.deflection([a.x])[0, 0])


def _axial_departure(a: Departing, scene: "Scene", bench: Workbench) -> float:
    from verify.studies.axial_inertia import departure, driven_chain

    driven = driven_chain(scene, "chain.axial_departure", a.links, a.time, a.x)
    found = departure(driven, a.force, a.inertia, bench.tell)
    return found.at_end if a.of == "end" else found.rms


def _nothing(a: Any, scene: "Scene") -> tuple[()]:
    """The nonlinear chain takes no modes of others."""
    return ()


def _no_modes(a: Any, scene: "Scene") -> tuple[()]:
    """The same, for a figure of the scene's own beam. Raises InputError for a beam that is no nonlinear chain."""
    from verify.chain.system import check_buildable

    check_buildable(scene.beam)
    return ()


CHAIN_QUANTITIES = (
    Quantity(
        "chain.cantilever_tip",
        "1",
        "Tip of a cantilever under a dead transverse force: w/L or 1 - x/L.",
        TipUnderLoad,
        _nothing,
        _cantilever_tip,
    ),
    Quantity(
        "chain.rollup_gap",
        "1",
        "Distance of the ends over L under an end moment 2 pi EI/L.",
        RolledUp,
        _nothing,
        _rollup_gap,
    ),
    Quantity(
        "chain.hanging_frequency",
        "1",
        "Omega sqrt(L/g) of a hanging chain of uniform links.",
        Hanging,
        _nothing,
        _hanging_frequency,
    ),
    Quantity(
        "chain.turning_frequency",
        "1",
        "Omega sqrt(rho A L^4/EI), lead-lag, of a cantilever whose clamp turns.",
        Turning,
        _nothing,
        _turning_frequency,
    ),
    Quantity(
        "chain.large_amplitude_frequency",
        "1",
        "First frequency between immovable hinges over the linear one.",
        LargeAmplitude,
        _no_modes,
        _large_amplitude_frequency,
    ),
    Quantity(
        "chain.energy_drift",
        "1",
        "Largest change of energy of an undamped chain over its energy.",
        FreeMotion,
        _no_modes,
        _energy_drift,
    ),
    Quantity(
        "chain.transient_deflection",
        "m",
        "Deflection of the chain from rest under the scene's forces.",
        FromRest,
        _no_modes,
        _transient_deflection,
    ),
    Quantity(
        "chain.axial_departure",
        "1",
        "Nonlinear chain less the linear one, from rest, over the linear one's rms.",
        Departing,
        _no_modes,
        _axial_departure,
    ),
)
