"""Quantities of friction and contact laws alone: belt, creep, decay, elastic layer, impacts."""

from math import pi
from typing import Annotated

import msgspec
from msgspec import Meta

from verify.errors import InputError
from verify.exact.contact import impact, layer
from verify.problem.slider import GRAVITY
from verify.quantities.base import Scene, quantity
from verify.quantities.options import Mass, Mu, Sizes, Slope, drive_frequency
from verify.validation import check_sizes

Pull = Annotated[float, Meta(description="external force over mass, m/s^2")]
Gravity = Annotated[float, Meta(gt=0, description="m/s^2")]
Stiffness = Annotated[float, Meta(gt=0, description="N/m")]
Friction = Annotated[float, Meta(gt=0, description="friction, N")]
HalfAngle = Annotated[float, Meta(gt=0, lt=pi, description="of contact, rad of the wave's phase")]
SpeedRatio = Annotated[float, Meta(description="of the slider over the surface at the crests")]
SlowerThanWave = Annotated[float, Meta(ge=0, lt=1, description="of the slider over the surface at the crests")]
Compliance = Annotated[float, Meta(ge=0, description="2 mu kappa/(kappa_t k h), tangential; 0 for Coulomb")]
AccelerationRatio = Annotated[float, Meta(gt=1, description="A omega^2 over the acceleration of the preload")]
DampingRatio = Annotated[float, Meta(ge=0, description="c/(2 sqrt(k m)) of mass, spring and dashpot")]
MU = 0.2
"""Friction coefficient of a foot on a wave; its forces over mu N do not depend on it."""


@quantity("friction.creep_speed", unit="m/s", reads=())
def creep_speed(*, mu: Mu, slope: Slope, pull: Pull, gravity: Gravity = GRAVITY) -> float:
    """Speed under a constant force below the friction limit, tanh friction."""
    from verify.dynamics.belt import creep_speed

    return creep_speed(mu, slope, pull, gravity)


class Belt(msgspec.Struct, frozen=True, kw_only=True):
    """A mass held by a spring on a moving belt, Coulomb friction."""

    mass: Mass
    stiffness: Stiffness
    static: Annotated[float, Meta(gt=0, description="largest friction at rest, N")]
    kinetic: Annotated[float, Meta(gt=0, description="friction in sliding, N")]
    speed: Annotated[float, Meta(gt=0, description="of the belt, m/s")]

    def times(self) -> tuple[float, float]:
        """(stick, slip) time of a cycle, s."""
        from verify.dynamics.belt import stick_slip_times

        return stick_slip_times(**msgspec.structs.asdict(self))


@quantity("friction.belt_stick_time", unit="s", reads=())
def belt_stick_time(belt: Belt) -> float:
    """Time of a stick-slip cycle in which the mass sticks to the belt."""
    return belt.times()[0]


@quantity("friction.belt_slip_time", unit="s", reads=())
def belt_slip_time(belt: Belt) -> float:
    """Time of a stick-slip cycle in which the mass slips."""
    return belt.times()[1]


@quantity("friction.coulomb_decrement", unit="m", reads=())
def coulomb_decrement(*, mass: Mass, stiffness: Stiffness, force: Friction) -> float:
    """Amplitude that an oscillator with Coulomb friction loses in a cycle."""
    from verify.dynamics.belt import coulomb_decrement

    return coulomb_decrement(mass, stiffness, force)


@quantity("slider.winkler_speed_ratio", unit="1", reads=())
def winkler_speed_ratio(*, contact_half_angle: HalfAngle, epsilon: Compliance = 0.0) -> float:
    """No-load speed over crest speed of a rigid slider on a Winkler layer over a wave."""
    return layer.no_load_speed(contact_half_angle, epsilon)


@quantity("slider.layer_force", unit="1", reads=())
def layer_force(*, contact_half_angle: HalfAngle, speed_ratio: SpeedRatio, epsilon: Compliance = 0.0) -> float:
    """Friction force over mu N on a rigid slider on a Winkler layer over a wave."""
    return layer.force(contact_half_angle, speed_ratio, epsilon)


@quantity("slider.layer_efficiency", unit="1", reads=())
def layer_efficiency(*, contact_half_angle: HalfAngle, speed_ratio: SlowerThanWave) -> float:
    """Power of that slider over power into the layer, Coulomb friction."""
    return layer.efficiency(contact_half_angle, speed_ratio)


@quantity("contact.landing_phase", unit="rad", reads=())
def landing_phase(*, acceleration_ratio: AccelerationRatio) -> float:
    """Phase of a vibrating surface at the first impact of a mass that has lifted off."""
    return impact.landing_phase(acceleration_ratio)


@quantity("contact.restitution", unit="1", reads=())
def restitution(*, damping_ratio: DampingRatio) -> float:
    """Coefficient of restitution of an impact on a spring and dashpot that only push."""
    return impact.restitution(damping_ratio)


class WaveContact(msgspec.Struct, frozen=True, kw_only=True):
    """A rigid foot of springs over one wavelength at a fixed height over a pure wave."""

    contact_half_angle: HalfAngle
    speed_ratio: SpeedRatio
    epsilon: Compliance = 0.0
    steps_per_period: Annotated[int, Meta(ge=4, description="of the wave")] = 256

    def force(self, scene: Scene, points: int = 61, refine: float = 1.0) -> float:
        """-F/(mu N) of so many springs, time step over `refine`. Raises InputError where none is in contact."""
        from verify.motor.travelling_wave import foot_on_wave

        foot = msgspec.structs.asdict(self) | {"steps_per_period": round(refine * self.steps_per_period)}
        means, _ = foot_on_wave(scene.beam, drive_frequency(scene), mu=MU, points=points, **foot)
        if means.normal_force <= 0.0:
            raise InputError(f"points = {points!r}: none within {self.contact_half_angle!r} rad of a crest, give more")
        return -means.force / (MU * means.normal_force)


@quantity("slider.wave_force", unit="1", reads=("beam", "drive"))
def wave_force(scene: Scene, contact: WaveContact) -> float:
    """Friction force over mu N on a rigid foot of springs over a pure wave, by time integration."""
    return contact.force(scene)


@quantity("slider.wave_force_order", unit="1", reads=("beam", "drive"))
def wave_force_order(scene: Scene, contact: WaveContact, *, counts: Sizes) -> float:
    """Observed order of that force in the number of springs, against the Winkler layer; steps in proportion."""
    from verify.analysis.comparison import observed_order

    check_sizes("counts", counts)
    exact = layer.force(contact.contact_half_angle, contact.speed_ratio, contact.epsilon)
    return observed_order(counts, [contact.force(scene, n, n / counts[0]) - exact for n in counts])
