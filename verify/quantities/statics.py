"""Named figures of beams at rest: the load at which one buckles, a cantilever of links bent far."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from msgspec import Meta

from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.models import catalogue
from verify.models.catalogue import MODELS
from verify.models.naming import model_meta
from verify.quantities.kind import Arguments, Divided, Joints, Quantity, Size, Wall

if TYPE_CHECKING:
    from verify.chain.bending import Bent
    from verify.scenes.scene import Scene


class Compressed(Divided, frozen=True, kw_only=True):
    """One model of the scene's beam under a growing compression."""

    model: Annotated[str, model_meta("which model", "buckling_load")]
    count: Size | None = None

    def __post_init__(self) -> None:
        catalogue.check_count(self.model, self.count)
        known = MODELS.named(self.model).buckling_settings
        for name, value in self.settings:
            if name not in known:
                able = " or ".join(m.name for m in MODELS.values() if name in m.buckling_settings) or "no model"
                raise InputError(f"{name} = {value!r} is a setting of model = {able}, not of {self.model}")


class BentFar(Arguments, frozen=True, kw_only=True):
    """The scene's cantilever as links under a dead load and a moment at its tip."""

    reads: ClassVar[tuple[str, ...]] = ("beam",)
    chained: ClassVar[bool] = True
    count: Annotated[int, Meta(ge=2, description="links of the chain")]
    across: Annotated[float, Meta(description="of the load, newton across the straight beam")] = 0.0
    along: Annotated[float, Meta(description="of the load, newton along the straight beam, away from the wall")] = 0.0
    moment: Annotated[float, Meta(description="at the tip, N m")] = 0.0
    wall: Wall = "gregory"
    joints: Joints = "series"


class BentTip(BentFar, frozen=True, kw_only=True):
    """Its tip."""

    component: Annotated[Literal["deflection", "shortening"], Meta(description="across the beam, or back along it")] = (
        "deflection"
    )


def _buckling_load(a: Compressed, scene: "Scene", bench: Workbench) -> float:
    return MODELS.named(a.model).buckling_load(scene.beam, a.count, **dict(a.settings))


def _bent(read: "Callable[[Any, Bent], float]") -> Callable[[Any, "Scene", Workbench], float]:
    """One figure of the bent cantilever."""

    def evaluate(a: BentFar, scene: "Scene", bench: Workbench) -> float:
        from verify.chain.bending import bend

        load = (a.along, a.across)
        return float(read(a, bend(scene.beam, a.count, load, moment=a.moment, wall=a.wall, joints=a.joints)))

    return evaluate


STATIC_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "beam.buckling_load",
        "N",
        "Compression at which the beam, or a model of it, buckles first; whatever its own axial force is.",
        Compressed,
        "matrices",
        _buckling_load,
    ),
    Quantity(
        "chain.bent_tip",
        "m",
        "Tip of the scene's cantilever as rigid links under a dead load and a moment.",
        BentTip,
        "equilibrium",
        _bent(lambda a, bent: getattr(bent, a.component)),
    ),
    Quantity(
        "chain.bent_energy",
        "J",
        "Elastic energy of these links' joints, and of the half link up to the tip under the moment there.",
        BentFar,
        "equilibrium",
        _bent(lambda a, bent: bent.energy),
    ),
)
