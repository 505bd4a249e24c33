"""Long runs: free vibration over many periods, the slider's loop over many steps."""

from collections.abc import Iterator
from decimal import Decimal, localcontext
from functools import cache
from math import pi

import numpy as np

from verify.beam import PointForce
from verify.models.compiling import Call
from verify.motion.result import Motion
from verify.slider import Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP
from verify.stress.references.decimals import PI, cos

HERTZ, SHARE = 731.0, 0.37
"""Of the drive, and its place over the length."""
MODES = 3
PER_PERIOD = 64
SPEED = 0.01
"""M/s across the beam from which a drift is told."""


def phase_error(periods: float) -> float:
    """The frequency error that would explain a mode's deflection after so many of its periods.

    Read where it passes through rest, a quarter of a period on, against decimals.
    """
    from verify.exact.closed_forms import frequency_hz
    from verify.motion.free_vibration import free_vibration

    hertz = frequency_hz(STRIP, 1)
    time = (periods + 0.25) / hertz
    run = free_vibration(STRIP, 1, time, amplitude=1e-3, model="analytic", modes=2, at=[0.5 * STRIP.length], samples=2)
    with localcontext() as context:
        context.prec = 50
        angle = 2 * PI * Decimal(hertz) * Decimal(time)
        return abs(float(Decimal(float(run.deflection[-1, 0])) / Decimal("1e-3") - cos(angle)) / float(angle))


def newmark_phase_error(periods: float) -> float:
    """The same by average acceleration in 64 steps of a period, advanced in closed form: its own phase is exact."""
    turn = 2.0 * np.arctan(pi / PER_PERIOD) * PER_PERIOD / (2.0 * pi)
    return abs(turn - 1.0) if periods else 0.0


def _slider(slope: float = 310.0, mu: float = 0.23) -> Slider:
    return Slider(mass=3e-9, mu=mu, slope=slope, coupling="one-way")


FORCE = (PointForce(position=SHARE * STRIP.length, amplitude=1e-3),)


def _ridden(steps: float, slider: Slider | None = None, *, ledger: bool = True) -> Motion:
    """The driven strip for as long as so many steps take, in these steps where a slider is carried."""
    from verify.motion.simulate import simulate

    step = 1.0 / (PER_PERIOD * HERTZ)
    return simulate(
        STRIP,
        FORCE,
        HERTZ,
        steps * step,
        model="analytic",
        modes=MODES,
        step=step if slider else None,
        slider=slider,
        at=[0.29 * STRIP.length],
        samples=2,
        ledger=ledger,
        patient=True,
    )


def turning_error(steps: float) -> float:
    """Modes turned step by step in the slider's loop: error of the deflection over its size, in roundings per step.

    Against the closed form of the same modes at the same time. One rounding is 1.1e-16.
    """
    ridden = _ridden(steps, _slider(), ledger=False)
    still = _still(steps)
    size = _size()
    assert ridden.statistics.steps >= steps
    return abs(float(ridden.deflection[-1, 0]) - still) / size / (1.1e-16 * ridden.statistics.steps)


@cache
def _still(steps: float) -> float:
    return float(_ridden(steps).deflection[-1, 0])


@cache
def _size() -> float:
    """Largest deflection of the place over some periods, metres."""
    from verify.motion.simulate import simulate

    run = simulate(STRIP, FORCE, HERTZ, 0.2, model="analytic", modes=MODES, at=[0.29 * STRIP.length], samples=2001)
    return float(abs(run.deflection).max())


def central_error(steps: float) -> float:
    """The same of one mode by central differences in as many steps, from its phase: (omega dt)^2 / 24."""
    from verify.exact.closed_forms import frequency_hz

    omega = 2.0 * pi * frequency_hz(STRIP, MODES)
    step = 1.0 / (PER_PERIOD * HERTZ)
    turn = 2.0 * np.arcsin(0.5 * omega * step)
    lag = abs(turn - omega * step) * steps
    return min(float(2.0 * abs(np.sin(0.5 * lag))), 2.0) / (1.1e-16 * steps)


def books_error(slope: float) -> float:
    """What the books of a slider on the driven strip miss over 20 000 steps, over what friction rubs away."""
    return _missed(20_000, slope)


def _missed(steps: float, slope: float) -> float:
    run = _ridden(steps, _slider(slope))
    assert run.ledger is not None
    return abs(run.ledger.residual) / (run.ledger.rubbed + run.ledger.work_in)


def energy_error(steps: float) -> float:
    """The same over so many steps, of the slope that the rows of phase have."""
    return _missed(steps, 310.0)


def bounded_error(mu: float) -> float:
    """How far the friction force exceeds mu m g, and the travel what that could have moved, over 20 000 steps."""
    slider = _slider(1e9, mu)
    run = _ridden(20_000, slider, ledger=False)
    push, time = slider.mu * slider.normal_force, float(run.times[-1])
    worst = float(abs(run.friction).max()) / push
    travel = float(abs(run.travelled).max()) / (0.5 * push / slider.mass * time**2)
    return largest(worst - 1.0, travel - 1.0, 0.0)


def _loops() -> Iterator[Call]:
    """Of a slider that the beam does not feel."""
    from verify.motion.warm import on_beam

    return on_beam("tanh", "one-way")


ROWS: tuple[Row, ...] = (
    Floor(
        id="free-for-long",
        title="A mode let go and read after many periods, as an error of its frequency",
        why="motion/free_vibration.py: exact at any time; the frequency in closed form is right to 6e-16.",
        along="periods",
        at=(1, 1e3, 1e5, 1e7, 1e9),
        promise=1e-15,
        error=phase_error,
        beside=newmark_phase_error,
        textbook="average acceleration, 64 steps a period",
    ),
    Floor(
        id="steps-of-phase",
        title="Modes turned step by step in the slider's loop, in roundings of every step",
        why="motion/stepping.py: modes advance exactly by any step, so that each may add one rounding of 1.1e-16.",
        along="steps",
        at=(1e3, 1e4, 1e5),
        promise=1.0,
        unit="1.1e-16 a step",
        error=turning_error,
        beside=central_error,
        textbook="central differences",
        seconds=20.0,
        quick=False,
        kernels=_loops,
    ),
    Floor(
        id="ten-million-steps",
        title="The same for ten million steps",
        why="The same; half a minute.",
        along="steps",
        at=(1e6, 1e7),
        promise=1.0,
        unit="1.1e-16 a step",
        error=turning_error,
        beside=central_error,
        textbook="central differences",
        seconds=60.0,
        quick=False,
        kernels=_loops,
    ),
    Floor(
        id="energy-of-ten-million-steps",
        title="What the energy books of such a run miss over what is put in, of up to ten million steps",
        why="motion/result.py: quadrature of the power, order 4: 1e-6, however many steps there are.",
        along="steps",
        at=(1e4, 1e6, 1e7),
        promise=1e-6,
        error=energy_error,
        seconds=30.0,
        quick=False,
        kernels=_loops,
    ),
    Floor(
        id="books-over-slope",
        title="What the energy books of a sliding mass miss over what is put in, 20 000 steps",
        why="motion/result.py: quadrature of the power over a step of a 64th of a period, order 4: 1e-6.",
        along="s/m",
        at=(1.0, 1e3, 1e6, 1e9),
        promise=1e-6,
        error=books_error,
        seconds=20.0,
        quick=False,
        kernels=_loops,
    ),
    Floor(
        id="friction-never-too-large",
        title="Friction force over mu m g less one, and travel over what it can move, slope 1e9",
        why="motion/friction_kernels.py: rounding gives no more than friction has.",
        along="mu",
        at=(1e-6, 1.0, 1e3, 1e6),
        promise=1e-12,
        error=bounded_error,
        seconds=20.0,
        quick=False,
        kernels=_loops,
    ),
)
