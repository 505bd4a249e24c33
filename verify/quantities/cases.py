"""Cases of known answer, and closed forms of contact with the user's figures."""

from math import pi
from typing import TYPE_CHECKING, Annotated

from msgspec import Meta

from verify.cases import layer
from verify.quantities.base import quantity
from verify.quantities.options import Sizes
from verify.validation import check_choice, check_sizes

if TYPE_CHECKING:
    from verify.cases.base import Case

Name = Annotated[str, Meta(description="name of the case, a row of `verify.cases.table.CASES`")]
Count = Annotated[int, Meta(ge=1, description="number of links, points or time steps; default: the case's")]
HalfAngle = Annotated[float, Meta(ge=1e-3, lt=pi, description="half the contact length, as phase of the wave, rad")]
SpeedRatio = Annotated[float, Meta(description="slider speed over surface speed at the crests")]
SlowerThanWave = Annotated[float, Meta(ge=0, lt=1, description="slider speed over surface speed at the crests")]
Compliance = Annotated[float, Meta(ge=0, description="tangential compliance 2 mu kappa/(kappa_t k h); 0: rigid")]
DampingRatio = Annotated[float, Meta(ge=0, description="c/(2 sqrt(k m)) of mass, spring and dashpot")]


def named(name: str) -> "Case":
    """The case of that name. Raises InputError for an unknown one."""
    from verify.cases.table import CASES

    check_choice("case", name, tuple(CASES))
    return CASES[name]


@quantity("case.value", unit="SI", reads=())
def value(*, case: Name, count: Count | None = None) -> float:
    """Figure of a case by the model that is run on it, in its SI unit or dimensionless."""
    return named(case).value(count)


@quantity("case.error", unit="1", reads=())
def error(*, case: Name, count: Count | None = None) -> float:
    """Signed error of the model on a case, relative; absolute where the exact value is zero."""
    return named(case).error(count)


@quantity("case.order", unit="1", reads=())
def order(*, case: Name, counts: Sizes) -> float:
    """Observed order of the error of a case in the number of links, points or time steps."""
    from verify.analysis.comparison import observed_order

    check_sizes("counts", counts)
    return observed_order(counts, [named(case).error(n) for n in counts])


@quantity("slider.winkler_speed_ratio", unit="1", reads=())
def winkler_speed_ratio(*, contact_half_angle: HalfAngle, epsilon: Compliance = 0.0) -> float:
    """No-load speed over crest speed of a rigid slider on a travelling wave with a Winkler layer."""
    return layer.no_load_speed(contact_half_angle, epsilon)


@quantity("slider.layer_force", unit="1", reads=())
def layer_force(*, contact_half_angle: HalfAngle, speed_ratio: SpeedRatio, epsilon: Compliance = 0.0) -> float:
    """Friction force over mu N on a rigid slider on a travelling wave with a Winkler layer."""
    return layer.force(contact_half_angle, speed_ratio, epsilon)


@quantity("slider.layer_efficiency", unit="1", reads=())
def layer_efficiency(*, contact_half_angle: HalfAngle, speed_ratio: SlowerThanWave) -> float:
    """Efficiency of a rigid slider on a travelling wave with a Winkler layer, Coulomb friction."""
    return layer.efficiency(contact_half_angle, speed_ratio)


@quantity("contact.restitution", unit="1", reads=())
def restitution(*, damping_ratio: DampingRatio) -> float:
    """Coefficient of restitution of an impact on a unilateral spring and dashpot."""
    from verify.cases import restitution

    return restitution.restitution(damping_ratio)
