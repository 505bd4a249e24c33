"""Sliders that friction alone brakes, that stand on a beam which they tilt, and whether a beam feels them.

By the equation of a mass on a floor, by the energy of beam and feet as their heights and modes are moved, and by
matrices written out.
"""

from collections.abc import Iterator
from functools import cache
from math import exp
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.models.time_basis import TimeBasis
from verify.motor.result import MotorRun
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.sliders import BAR, FORCES, HERTZ, RATIO
from verify.stress.references.dense import Elements

# --- Braked -----------------------------------------------------------------------------------------------------------

MASS, MU, LOAD, SPEED = 0.021, 0.07, 260.0, 0.61
SAMPLES = 12
STILL = tuple(replace(one, amplitude=0.0) for one in FORCES)
"""Forces that move nothing."""


def let_go(speed: float, pull: float = 0.0) -> Slider:
    """A slider that friction of one size brakes, m/s and newton."""
    return Slider(
        mass=MASS,
        mu=MU,
        law="coulomb",
        gravity=0.0,
        preload=LOAD,
        position=0.0579,
        speed=speed,
        coupling="one-way",
        pull=pull,
        contact=Contact(stiffness=2.7e5),
    )


@cache
def _braked(way: float) -> MotorRun:
    """Of a slider let go on a beam that nothing moves, until it has lost two thirds of its speed."""
    from verify.motor.run import run_motor

    slider = let_go(way * SPEED)
    time = 2.0 / 3.0 * SPEED * MASS / (MU * LOAD)
    return run_motor(BAR, STILL, HERTZ, time, slider=slider, model="fem", count=2, samples=SAMPLES, step=1e-5)


def braked_error(way: float) -> float:
    """Of the time to 1 - 1/e of the way to a speed, of mean speeds of the end, of what pushes, over the largest."""
    from verify.motor.figures import comes_to_speed, mean_speed, phase_portrait, pushed_on, started_of

    _braked.cache_clear()  # every row runs what it judges
    run, brake = _braked(way), MU * LOAD / MASS
    off = [abs(float(run.friction[-1]) / (-way * MU * LOAD) - 1.0)]
    for target in (0.0, 0.4 * SPEED):
        wanted = (1.0 - exp(-1.0)) * (SPEED - target) / brake
        found = started_of(run, way * target)
        off.append(abs(found / wanted - 1.0) if found is not None else 1.0)
    missed = started_of(run, -way * SPEED) is not None or started_of(run, 2.0 * way * SPEED) is not None
    for last in (3, 6):
        span = float(run.times[-1] - run.times[-1 - last])
        mean, apart = mean_speed(run, last)
        late = float(run.times[-1] - run.times[-1 - last + last // 2])
        off += [abs(mean - way * (SPEED / 3.0 + 0.5 * brake * span)) / SPEED, abs(apart / (0.5 * brake * span) - 1.0)]
        pushes = MASS * 0.5 * brake * span / float(run.times[-1] - run.times[-1 - last // 2]) / (MU * LOAD)
        off += [abs(pushed_on(run, last) / pushes - 1.0), float(late <= 0.0)]
        missed |= comes_to_speed(run, last, 1e6)
    height, rate = phase_portrait(run)
    off.append(float(abs(height + LOAD / 2.7e5).max() / (LOAD / 2.7e5) + abs(rate).max() / SPEED))
    return largest(*off, float(missed))


# --- At rest ----------------------------------------------------------------------------------------------------------

SOFT = Beam(
    length=0.12, width=0.011, thickness=0.009, youngs_modulus=6e7, density=1190.0, supports=("pinned", "clamped")
)
"""So soft that what stands on it turns what is under it by tenths of a millimetre along."""
STANDS = Slider(
    mass=0.021,
    mu=0.07,
    slope=9.0,
    position=0.0579,
    preload=3.1,
    contact=Contact(stiffness=2.1e4),
    foot=(
        Foot(length=0.013, points=2, offset=-0.004, pitches=False),
        Foot(offset=0.019),
        Foot(offset=-0.017, face="lower"),
    ),
)
RESTS = ((6e7, 0.0), (6e9, 700.0))
"""Modulus of the beam, and stiffness of what presses, N/m."""
AWAY = 1e-4
"""Of a mode's way at rest, or of the largest, by which it is moved."""


def rest_error(number: float) -> float:
    """How far a beam and its feet are from the least of their energy at rest, over the largest force in a mode.

    A foot shares what presses it on among its points, above and below; with the material under it moves its point.
    """
    from verify.motion.surface import basis_of
    from verify.motor.feet import Placed, feet_of
    from verify.motor.resting import weighed

    modulus, spring = RESTS[int(number)]
    basis = basis_of(replace(SOFT, youngs_modulus=modulus), "fem", 6, 11, "spline")
    slider = replace(STANDS, preload_stiffness=spring)
    placed = (Placed(slider, 0.0579),)
    q, feet = weighed(basis, placed), feet_of(placed)
    steps = AWAY * np.diag(np.maximum(abs(q), 0.01 * abs(q).max()))
    pushes = np.array(
        [(_stored(slider, basis, q + one) - _stored(slider, basis, q - one)) / (2.0 * one.max()) for one in steps]
    )
    return float(abs(pushes).max() / abs(basis.omegas**2 * q).max()) + float(len(feet.state) != 3)


def _stored(slider: Slider, basis: TimeBasis, q: Array) -> float:
    """Energy of the beam bent so with its feet where springs and what presses them on balance, joules."""
    total = 0.5 * float((basis.omegas * q) @ (basis.omegas * q))
    for foot in slider.feet:
        arms = np.linspace(-0.25, 0.25, 2) * foot.length if foot.points == 2 else np.zeros(1)
        lever = 0.5 * 0.009 * (-1.0 if foot.face == "lower" else 1.0)
        x = 0.0579 + foot.offset + arms
        under = x + lever * (q @ basis.shapes(x, 1))
        level = float((q @ basis.shapes(under, 0)).mean())
        press = (1.0 if foot.face == "lower" else -1.0) * slider.preload / 3.0 - slider.mass * slider.gravity / 3.0
        stiff, spring = 2.1e4, slider.preload_stiffness
        height = (press + stiff * level) / (stiff + spring)
        total += 0.5 * stiff * (height - level) ** 2 + 0.5 * spring * height**2 - press * height
    return total


# --- Felt or not ------------------------------------------------------------------------------------------------------


def sizes_error(part: float) -> float:
    """Of what all that presses on a slider moves the surface by, over what the drive does, by matrices written out.

    A slider is felt where either is more than a thousandth: by a part less it is not, unless it says so itself or
    nothing turns the surface.
    """
    from verify.motor.coupling import coupled, in_words
    from verify.motor.run import run_motor

    own, x = Elements(BAR, np.linspace(0.0, BAR.length, 3)), 0.0579
    drive = own.under(own.load(FORCES), HERTZ, RATIO)
    lift, turn = (abs(complex(own.row(x, d) @ drive)) for d in (0, 1))
    unit, couple = (
        abs(complex(own.row(x, d) @ own.under(own.row(x, d).astype(np.complex128), HERTZ, RATIO))) for d in (0, 1)
    )
    exact = np.array([unit / lift, MU * BAR.surface_distance * couple / turn])
    given: dict[str, Any] = {"model": "fem", "count": 2, "modal_damping": RATIO, "start": "rest", "samples": 2}
    worst = 0.0
    for factor in (1.0 - part, 1.0 + part):
        load = factor * 1e-3 / float(exact.max())
        slider = Slider(
            mass=MASS, mu=MU, slope=9.0, gravity=0.0, preload=load, position=x, contact=Contact(stiffness=2.7e5)
        )
        found = run_motor(BAR, FORCES, HERTZ, 1e-5, slider=slider, step=1e-5, **given).coupling
        assert found is not None
        sizes = np.array([found.normal_size, found.friction_size])
        worst = largest(worst, float(abs(sizes / (load * exact) - 1.0).max()), float(found.two_way is (factor < 1.0)))
    for choice, across, along, felt in CHOICES:
        told = coupled(replace(slider, coupling=choice), across, along)
        wrong = told.two_way is not felt or (told.normal_size, told.friction_size) != (across, along)
        worst = largest(worst, float(wrong or told.forced is (choice == "auto")))
        worst = largest(worst, float(("friction" in in_words(told)) is (along is None)))
    return largest(worst, float("does not move" not in in_words(coupled(slider, np.inf, None))))


CHOICES: tuple[tuple[Any, float, float | None, bool], ...] = (
    ("auto", 2e-3, 1e-5, True),
    ("auto", 1e-5, 2e-3, True),
    ("auto", 1e-5, None, True),
    ("auto", 1e-5, 2e-5, False),
    ("one-way", 2e-3, 2e-3, False),
    ("two-way", 1e-5, 1e-5, True),
    ("one-way", 2e-3, None, False),
)
"""What a slider says of itself, its sizes across and along, whether it is felt."""


def _braking() -> Iterator[Call]:
    from verify.motor import warm

    return warm.on_springs("coulomb", "one-way")


def _felt() -> Iterator[Call]:
    from verify.motor import warm

    return warm.on_springs("tanh", "auto")


ROWS: tuple[Row, ...] = (
    Floor(
        id="braked-by-friction",
        title="A motor's slider braked by friction alone: time to 1 - 1/e of the way, mean speeds, what pushes it",
        why="motor/figures.py: friction of one size slows it evenly; straight lines between samples are exact.",
        along="way",
        at=(1.0, -1.0),
        promise=1e-10,
        error=braked_error,
        kernels=_braking,
    ),
    Floor(
        id="least-energy-under-feet",
        title="A soft beam that feet above and below bend and tilt, at rest: forces left in its modes",
        why="motor/resting.py: four passes to the material under each point; differences of the energy keep seven "
        "digits, and springs that ease are taken as the beam lies at last.",
        along="case",
        at=(0.0, 1.0),
        promise=5e-8,
        error=rest_error,
    ),
    Floor(
        id="felt-by-size",
        title="What presses a motor's slider on moves the surface by: across and along, felt from a thousandth on",
        why="motor/coupling.py: of the model's own modes, to rounding.",
        along="part",
        at=(1e-6,),
        promise=1e-8,
        error=sizes_error,
        kernels=_felt,
    ),
)
