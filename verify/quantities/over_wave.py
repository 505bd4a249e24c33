"""Named figures of a foot of springs over a pure travelling wave."""

from typing import TYPE_CHECKING, Annotated, Any

from msgspec import Meta

from verify.checks import check_sizes
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.quantities import compiled
from verify.quantities.cases import drive_frequency
from verify.quantities.kind import AtFrequency, Quantity

if TYPE_CHECKING:
    from verify.scenes.scene import Scene


class _OverWave(AtFrequency, frozen=True, kw_only=True):
    """A rigid foot of one wavelength of springs at a fixed height over a pure travelling wave."""

    contact_half_angle: Annotated[float, Meta(gt=0, lt=3.14159, description="of the wave's phase, radians")]
    speed_ratio: Annotated[float, Meta(description="over the speed of the surface at the crests")]
    epsilon: Annotated[float, Meta(ge=0, description="2 mu kappa/(kappa_t k h); 0 is Coulomb's")] = 0.0
    mu: Annotated[float, Meta(gt=0, description="coefficient of friction")] = 0.2
    steps_per_period: Annotated[int, Meta(ge=4, description="of the wave")] = 256
    amplitude: Annotated[float, Meta(gt=0, description="of the wave, metres")] = 1e-9


class OverWave(_OverWave, frozen=True, kw_only=True):
    """So many of them."""

    points: Annotated[int, Meta(ge=2, description="springs in a wavelength")] = 61


class OverWaveOrder(_OverWave, frozen=True, kw_only=True):
    """Several numbers of them, with steps in proportion to the first."""

    counts: Annotated[tuple[int, ...], Meta(min_length=3, description="three or more numbers of points")]

    def __post_init__(self) -> None:
        check_sizes("counts", self.counts)


def _over_wave(a: OverWave, scene: "Scene", bench: Workbench) -> float:
    """F/(mu N), along the way of the crests. Raises InputError where no spring touches the wave."""
    from verify.motor.on_wave import over_a_wave

    found, _ = over_a_wave(
        scene.beam,
        drive_frequency(a, scene),
        speed_ratio=a.speed_ratio,
        contact_half_angle=a.contact_half_angle,
        epsilon=a.epsilon,
        mu=a.mu,
        points=a.points,
        steps_per_period=a.steps_per_period,
        amplitude=a.amplitude,
    )
    if found.normal_force <= 0.0:
        raise InputError(
            f"points = {a.points!r}: none touches within {a.contact_half_angle!r} rad of a crest, give more"
        )
    return -found.force / (a.mu * found.normal_force)


def _over_wave_order(a: OverWaveOrder, scene: "Scene", bench: Workbench) -> float:
    """Against the closed form of the layer."""
    from verify.contact.layer import force
    from verify.judge.compare import observed_order

    exact = force(a.contact_half_angle, a.speed_ratio, a.epsilon)
    own = {name: getattr(a, name) for name in _OverWave.__struct_fields__}
    steps = [round(a.steps_per_period * n / a.counts[0]) for n in a.counts]
    cases = [OverWave(**{**own, "points": n, "steps_per_period": s}) for n, s in zip(a.counts, steps, strict=True)]
    return observed_order(a.counts, [_over_wave(one, scene, bench) - exact for one in cases])


WAVE_FORCE_QUANTITIES: tuple[Quantity[Any], ...] = (
    Quantity(
        "slider.wave_force",
        "1",
        "F/(mu N) of a rigid foot of springs at a fixed height over a pure wave, stepped.",
        OverWave,
        "in time",
        _over_wave,
        kernels=compiled.over_wave,
    ),
    Quantity(
        "slider.wave_force_order",
        "1",
        "Observed order of that figure in the number of points, against the layer's closed form.",
        OverWaveOrder,
        "in time",
        _over_wave_order,
        kernels=compiled.over_wave,
    ),
)
