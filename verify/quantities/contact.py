"""Quantities of friction and contact laws without a beam: belt, creep, decay, elastic layer, impacts."""

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

Acceleration = Annotated[float, Meta(description="external force over mass, m/s^2")]
Gravity = Annotated[float, Meta(gt=0, description="gravity, m/s^2")]
Stiffness = Annotated[float, Meta(gt=0, description="spring stiffness, N/m")]
Friction = Annotated[float, Meta(gt=0, description="friction force, N")]
HalfAngle = Annotated[float, Meta(ge=1e-3, lt=pi, description="half the contact length, as phase of the wave, rad")]
SpeedRatio = Annotated[float, Meta(description="slider speed over surface speed at the crests")]
SlowerThanWave = Annotated[float, Meta(ge=0, lt=1, description="slider speed over surface speed at the crests")]
Compliance = Annotated[float, Meta(ge=0, description="tangential compliance 2 mu kappa/(kappa_t k h); 0: rigid")]
AccelerationRatio = Annotated[float, Meta(gt=1, le=1e9, description="surface acceleration A omega^2 over g + F/m")]
DampingRatio = Annotated[float, Meta(ge=0, description="c/(2 sqrt(k m)) of mass, spring and dashpot")]
MU = 0.2  # friction coefficient of a foot on a wave; forces over mu N do not depend on it


@quantity("friction.creep_speed", unit="m/s", reads=())
def creep_speed(*, mu: Mu, slope: Slope, acceleration: Acceleration, gravity: Gravity = GRAVITY) -> float:
    """Creep speed of a slider with tanh friction under a constant force below the friction limit."""
    from verify.dynamics.belt import creep_speed

    return creep_speed(mu, slope, acceleration, gravity)


class Belt(msgspec.Struct, frozen=True, kw_only=True):
    """A mass on a spring on a moving belt with Coulomb friction."""

    mass: Mass
    stiffness: Stiffness
    static: Annotated[float, Meta(gt=0, description="static friction limit, N")]
    kinetic: Annotated[float, Meta(gt=0, description="kinetic friction force, N")]
    speed: Annotated[float, Meta(gt=0, description="belt speed, m/s")]

    def times(self) -> tuple[float, float]:
        """(stick, slip) time of a cycle, s."""
        from verify.dynamics.belt import stick_slip_times

        return stick_slip_times(**msgspec.structs.asdict(self))


@quantity("friction.belt_stick_time", unit="s", reads=())
def belt_stick_time(belt: Belt) -> float:
    """Duration of sticking in a stick-slip cycle of a mass on a spring on a belt."""
    return belt.times()[0]


@quantity("friction.belt_slip_time", unit="s", reads=())
def belt_slip_time(belt: Belt) -> float:
    """Duration of slipping in a stick-slip cycle of a mass on a spring on a belt."""
    return belt.times()[1]


@quantity("friction.coulomb_decrement", unit="m", reads=())
def coulomb_decrement(*, mass: Mass, stiffness: Stiffness, force: Friction) -> float:
    """Amplitude loss per cycle of an oscillator with Coulomb friction."""
    from verify.dynamics.belt import coulomb_decrement

    return coulomb_decrement(mass, stiffness, force)


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


@quantity("contact.landing_phase", unit="rad", reads=())
def landing_phase(*, acceleration_ratio: AccelerationRatio) -> float:
    """Phase of a vibrating surface at the first impact of a mass after lift-off."""
    return impact.landing_phase(acceleration_ratio)


@quantity("contact.restitution", unit="1", reads=())
def restitution(*, damping_ratio: DampingRatio) -> float:
    """Coefficient of restitution of an impact on a unilateral spring and dashpot."""
    return impact.restitution(damping_ratio)


class WaveContact(msgspec.Struct, frozen=True, kw_only=True):
    """A rigid foot of springs, one wavelength long, at a fixed height on a travelling wave."""

    contact_half_angle: HalfAngle
    speed_ratio: SpeedRatio
    epsilon: Compliance = 0.0
    steps_per_period: Annotated[int, Meta(ge=4, description="time steps per period of the wave")] = 256

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
    """Friction force over mu N on a rigid foot of springs on a travelling wave, by time integration."""
    return contact.force(scene)


@quantity("slider.wave_force_order", unit="1", reads=("beam", "drive"))
def wave_force_order(scene: Scene, contact: WaveContact, *, counts: Sizes) -> float:
    """Observed order of that force in the number of springs, against the Winkler layer; steps in proportion."""
    from verify.analysis.comparison import observed_order

    check_sizes("counts", counts)
    exact = layer.force(contact.contact_half_angle, contact.speed_ratio, contact.epsilon)
    return observed_order(counts, [contact.force(scene, n, n / counts[0]) - exact for n in counts])
