"""A block on a ramp, Coulomb's law: it sticks below the friction angle, and slides back from a launch up beyond it."""

from math import cos, radians, sin

from verify.cases.base import case
from verify.cases.rigid_surface import march, on_surface
from verify.problem.slider import GRAVITY, Slider

COULOMB = "C. A. Coulomb: uniform acceleration, and rest"
FLAT, STEEP = radians(17.0), radians(25.0)


def exact(mu: float, angle: float, speed: float, time: float) -> float:
    """Position up the slope, m, at a `time`, s, after the block has stopped."""
    pull, friction = GRAVITY * sin(angle), mu * GRAVITY * cos(angle)
    after = time - speed / (pull + friction)
    return 0.5 * speed**2 / (pull + friction) - 0.5 * max(pull - friction, 0.0) * after**2


@case("ramp-stick", exact(0.45, FLAT, 0.4, 2.0), 1e-15, COULOMB, mu=0.45, angle=FLAT, speed=0.4, time=2.0)
@case("ramp-slip", exact(0.3, STEEP, 1.1, 1.0), 1e-15, COULOMB, mu=0.3, angle=STEEP, speed=1.1, time=1.0)
def position(mu: float, angle: float, speed: float, time: float, count: int = 1000) -> float:
    """Position up the slope, m, of a slider launched at `speed`, m/s, by the contact engine in `count` steps."""
    slider = Slider(mass=1.0, mu=mu, law="coulomb", gravity=GRAVITY * cos(angle), speed=speed)
    assembly = on_surface(slider)
    assembly.sliders["external_force"] = -GRAVITY * sin(angle)
    march(assembly, count, time / count)
    return float(assembly.sliders["x"][0])
