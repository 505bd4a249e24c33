"""What every engine is given: a uniform pinned chain with a roller end, its forces, and a slider that rides on it."""

from collections.abc import Sequence
from math import cos, isfinite, nan, pi, radians, tanh
from time import perf_counter, process_time

from verify.beam import Beam, PointForce, check_frequency
from verify.checks import check_number, check_whole
from verify.errors import InputError
from verify.field_docs import Value
from verify.models.arrays import Array
from verify.slider import Slider

LEAST = 6
"""Links: the surface under a slider is read from six of them."""
SAMPLES = 200
"""Kept of a run at least, where it has so many steps."""


class Case(Value, frozen=True, kw_only=True):
    """A chain of n equal rigid links, pinned at x = 0 and on a roller at its end, driven from rest. SI."""

    n: int
    """How many links."""
    link: float
    """Length of a link, metres."""
    mass: float
    """Of one link, kg."""
    inertia: float
    """Of one link about its middle, kg m^2."""
    spring: float
    """At each of the n - 1 inner joints, N m/rad."""
    frequency: float
    """Of all forces, hertz."""
    forces: tuple[PointForce, ...]
    """Transverse, amplitude cos(omega t + phase), switched on at t = 0."""

    @property
    def length(self) -> float:
        """Of the chain, metres."""
        return self.n * self.link

    def now(self, t: float) -> list[float]:
        """The forces at a time, newton."""
        omega = 2.0 * pi * self.frequency
        return [force.amplitude * cos(omega * t + radians(force.phase_deg)) for force in self.forces]

    def place(self, x: float) -> tuple[int, float]:
        """The link, from 0, that holds x, and the place on it, metres from its near end."""
        i = min(int(x / self.link + 1e-12), self.n - 1)
        return i, x - i * self.link


def case_of(beam: Beam, n: int, forces: Sequence[PointForce], frequency_hz: float) -> Case:
    """The chain of n links of a uniform pinned beam, springs EI/l. Raises InputError for any other beam."""
    if beam.supports != ("pinned", "pinned"):
        raise InputError(f"beam.supports = {beam.supports!r}: the peers' chain is pinned, give ('pinned', 'pinned')")
    beam.check_added("the peers' chain")
    if beam.loss_factor:
        raise InputError(f"beam.loss_factor = {beam.loss_factor!r}: the peers' chain is undamped, give 0")
    check_whole("count", n, LEAST)
    check_frequency("frequency_hz", frequency_hz, beam)
    for i, force in enumerate(forces):
        if force.position > beam.length:
            raise InputError(
                f"force[{i}].position = {force.position!r} lies off the beam: give one between 0 and {beam.length!r} m"
            )
    link = beam.length / n
    mass = beam.mass_per_length * link
    return Case(
        n=n,
        link=link,
        mass=mass,
        inertia=mass * link**2 / 12.0,
        spring=beam.bending_stiffness / link,
        frequency=frequency_hz,
        forces=tuple(forces),
    )


class Sled(Value, frozen=True, kw_only=True):
    """A point mass on the surface, one-way: it has the speed that friction of Eq. (3) gives it and presses nothing."""

    mass: float
    """Kg."""
    friction: float
    """Mu N, newton."""
    slope: float
    """K of Eq. (3), s/m."""
    half_thickness: float
    """From the neutral line to the surface, metres."""
    start: float
    """Metres from the left end."""
    speed: float = 0.0
    """At the start, m/s."""

    def force(self, relative_speed: float) -> float:
        """Friction on the slider, newton, by its speed less the surface's, m/s."""
        return -self.friction * tanh(self.slope * relative_speed)


def sled_of(beam: Beam, slider: Slider) -> Sled:
    """The slider as engines take it. Raises InputError for one that does more than they are asked to."""
    for field, takes in (("law", "tanh"), ("kinematics", "tangential"), ("coupling", "one-way")):
        if (word := getattr(slider, field)) != takes:
            raise InputError(f"slider.{field} = {word!r}: the peers' slider has {takes!r} alone, give that")
    assert slider.steepness is not None
    return Sled(
        mass=slider.mass,
        friction=slider.mu * slider.normal_force,
        slope=slider.steepness,
        half_thickness=beam.surface_distance,
        start=slider.start_on(beam),
        speed=slider.speed,
    )


def surface_speed(case: Case, sled: Sled, spins: Sequence[float] | Array, x: float, first: int = 0) -> float:
    """Speed of the surface at x, m/s, from angular velocities of links, counter-clockwise positive; O(1).

    -(h/2) times their smooth reading: means of two links at every joint, a cubic through four joints (E. Catmull and
    R. Rom, 1974) between. `spins` are of links `first` on, at least of those two before and behind the link under x.
    """
    i = near(case, x)
    s, k = x / case.link - i, i - first
    e, f, g, h, m = spins[k - 2], spins[k - 1], spins[k], spins[k + 1], spins[k + 2]
    a, b, c, d = 0.5 * (e + f), 0.5 * (f + g), 0.5 * (g + h), 0.5 * (h + m)
    cubic = 2.0 * b + s * (c - a + s * (2.0 * a - 5.0 * b + 4.0 * c - d + s * (3.0 * (b - c) + d - a)))
    return float(-0.5 * sled.half_thickness * cubic)


def near(case: Case, x: float) -> int:
    """The link, from 0, whose cubic holds at x: two links on either side of it are needed; any where x is no number."""
    return min(max(int(x / case.link), 2), case.n - 3) if isfinite(x) else 2


class PeerRun(Value, frozen=True, eq=False, kw_only=True):
    """What an engine gave. Where it broke, what it gave until then."""

    times: Array
    """(m,), seconds."""
    deflection: Array
    """(m,), of mid-span, metres."""
    distance: Array
    """(m,), travelled by the slider, metres; empty without one."""
    speed: Array
    """(m,), of the slider, m/s; empty without one."""
    seconds: float
    """Wall time of the steps."""
    cpu_s: float = nan
    """Processor time of the steps, which other work on the machine does not lengthen as it does wall time; nan where it
    was not taken."""
    set_up_s: float
    """Wall time of what a run of this step needs before its first one, also where it was kept from an earlier run."""
    steps: int
    """That the engine took, which may be others than it was asked for."""
    broke: str = ""
    """What it did when it broke, and at which time; empty where it did not."""


def count(step: float, end: float) -> tuple[int, float]:
    """The number of steps up to the end, and the step that fits, seconds. Raises InputError."""
    check_number("step", step, "seconds", above=0)
    check_number("end", end, "seconds", above=0)
    steps = max(round(end / step), 1)
    return steps, end / steps


def every(steps: int) -> int:
    """After how many steps to look, for at least SAMPLES looks where there are so many steps."""
    return max(steps // SAMPLES, 1)


def clocks() -> tuple[float, float]:
    """Wall time and processor time, seconds from anywhere."""
    return perf_counter(), process_time()


def since(then: tuple[float, float]) -> tuple[float, float]:
    """(wall, processor) seconds from a reading of the clocks."""
    now = clocks()
    return now[0] - then[0], now[1] - then[1]
