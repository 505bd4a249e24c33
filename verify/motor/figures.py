"""Figures of a motor: what a slider at a speed is pushed with, where that is nought, how soon it gets there.

A figure at a speed is a mean over whole periods of the drive with the slider held at that speed and at its place, so
that the motion across can repeat itself; blocks of periods go on until two agree. The free run, which moves along the
beam and lets the speed swing within a period, is the check on them.
"""

from collections.abc import Callable, Sequence

import numpy as np

from verify.errors import InputError
from verify.field_docs import Value
from verify.models.arrays import Array
from verify.models.underfoot import standing_at
from verify.motor.case import MotorCase
from verify.motor.repeated import blocks
from verify.motor.result import MotorRun

BLOCK = 12
"""Periods between two looks at whether the means have settled."""
MOST_BLOCKS = 60
SETTLED = 1e-4
"""Of mu times the normal force: as much as the friction of two blocks may differ."""
REACHED = 1.0 - np.exp(-1.0)
"""Of the no-load speed, at the time constant of starting."""
LONGEST = 4000
"""Periods in which a slider has to get under way, or to stop."""
HALVINGS = 40


class AtSpeed(Value, frozen=True, kw_only=True):
    """A motor whose slider is held at one speed, means over the last block of periods."""

    speed: float
    """m/s along +x."""
    force: float
    """Of friction on the slider along +x, newton."""
    normal_force: float
    """Newton, of all points."""
    contact_share: float
    """Of points and time that touch."""
    stuck_share: float
    """Of points and time that stick."""
    given: float
    """Power of the surface on the slider along the beam, W."""
    rubbed: float
    """Power lost in friction, and stored and lost in what gives way along the surface, W."""
    spread: float
    """Of the force between the last two blocks, newton: how far it has settled."""
    periods: int
    """Until then."""

    @property
    def power(self) -> float:
        """On the slider, W: force times speed."""
        return self.force * self.speed + 0.0  # never a negative nought

    @property
    def efficiency(self) -> float | None:
        """Power over what the surface gives along the beam; None where the slider drives the surface."""
        return self.power / self.given if self.given > 0.0 and self.power >= 0.0 else None


def at_speed(case: MotorCase, speed: float, before: MotorRun | None = None) -> AtSpeed:
    """The motor with its slider held at a speed, m/s, at the place where it is put. Raises InputError."""
    return held(case, speed, before)[0]


def held(case: MotorCase, speed: float, before: MotorRun | None = None) -> tuple[AtSpeed, MotorRun]:
    """The same with the last block of periods; `before`, a run held at its place too, is settled already."""
    force, found, run = np.inf, None, _block(case, speed)
    for block in range(1, MOST_BLOCKS + 1):
        before = run(before)
        found = _means(before, speed, abs(float(before.friction[1:].mean()) - force), BLOCK * block)
        force = found.force
        if found.spread <= SETTLED * case.slider.mu * max(found.normal_force, case.slider.normal_force):
            break
    assert found is not None
    assert before is not None
    return found, before


def _block(case: MotorCase, speed: float) -> Callable[[MotorRun | None], MotorRun]:
    """The next block of periods after a run, or the first."""
    if case.start == "steady":
        block = blocks(case, speed, BLOCK, BLOCK + 1)
        return lambda before: block(before.state if before is not None else None)
    return lambda before: case.run(
        BLOCK * case.period, continue_from=before, held_speed=speed, frozen=True, samples=BLOCK + 1
    )


def _means(run: MotorRun, speed: float, spread: float, periods: int) -> AtSpeed:
    """Of a block of whole periods."""
    seconds = run.duration
    return AtSpeed(
        speed=speed,
        force=float(run.friction[1:].mean()),
        normal_force=float(run.normal_force[1:].mean()),
        contact_share=float(run.contact_share[1:].mean()),
        stuck_share=float(run.stuck_share[1:].mean()),
        given=float(run.carried[1:].sum()) / seconds,
        rubbed=float(run.rubbed[1:].sum()) / seconds,
        spread=spread,
        periods=periods,
    )


def stall(case: MotorCase) -> AtSpeed:
    """The motor held still: its force is the stall force."""
    return at_speed(case, 0.0)


def force_speed(case: MotorCase, speeds: Sequence[float]) -> tuple[AtSpeed, ...]:
    """The motor at each speed, m/s."""
    return tuple(at_speed(case, float(speed)) for speed in speeds)


def no_load(case: MotorCase, reach: float | None = None, before: MotorRun | None = None) -> AtSpeed:
    """The speed at which friction gives nothing on the average, by halving up to `reach` either way (m/s).

    Unless given, `reach` is twice the largest speed of the surface at the slider; `before` as for `held`. Raises
    InputError where the force has the same sign at both ends.
    """
    wide = 2.0 * crest_speed(case) if reach is None else reach
    low, high = -wide, wide
    if at_speed(case, low, before).force <= 0.0 or at_speed(case, high, before).force >= 0.0:
        raise InputError(
            f"reach = {wide!r} m/s: friction does not change its way up to there, so that no speed without load is "
            "between: press the slider on more, or give a larger reach"
        )
    found = at_speed(case, 0.0, before)
    for _ in range(HALVINGS):
        low, high = (found.speed, high) if found.force > 0.0 else (low, found.speed)
        if found.force == 0.0 or high - low <= 1e-6 * wide:
            break
        found = at_speed(case, 0.5 * (low + high), before)
    return found


def crest_speed(case: MotorCase) -> float:
    """First-order speed amplitude of the surface where the slider is put, (h/2) omega |w'|, m/s. Raises InputError."""
    from verify.models.catalogue import MODELS

    model, beam = MODELS[case.model], case.beam
    field = model.solve_harmonic(beam, case.forces, case.frequency_hz, case.count)
    x = case.slider.start_on(beam)
    return standing_at(beam, x).surface_distance * field.omega * float(abs(field.slope([x]))[0])


class Timed(Value, frozen=True, eq=False, kw_only=True):
    """How a motor gets from one speed to another."""

    start_speed: float
    """m/s."""
    end_speed: float
    """m/s, at the end of the run."""
    time: float | None
    """Seconds until 1 - 1/e of the way is made; None where it is not made within the run."""
    run: MotorRun
    """Sampled once a period."""


def started(case: MotorCase, target: float, periods: int = LONGEST) -> Timed:
    """From rest, without load: how long until 1 - 1/e of the `target` speed (m/s) is reached."""
    return _timed(case.run(periods * case.period, samples=periods + 1), case.slider.speed, target)


def stopped(case: MotorCase, before: MotorRun, periods: int = LONGEST) -> Timed:
    """After a run, the drive cut at once and a beam that does not swing on: how long until 1/e of the speed is left.

    One-way, on a steady field, which ends with its forces: a beam that rings down brakes longer than that.
    """
    still = case.driven(1e-12)
    run = still.run(periods * case.period, samples=periods + 1, continue_from=before)
    return _timed(run, before.state.speed, 0.0)


def reversed_way(case: MotorCase, before: MotorRun, target: float, periods: int = LONGEST) -> Timed:
    """After a run, the phase turned round at once: how long until 1 - 1/e of the way to `target` (m/s) is made."""
    run = case.turned().run(periods * case.period, samples=periods + 1, continue_from=before)
    return _timed(run, before.state.speed, target)


def _timed(run: MotorRun, start: float, target: float) -> Timed:
    return Timed(start_speed=start, end_speed=float(run.speed[-1]), time=started_of(run, target), run=run)


def started_of(run: MotorRun, target: float) -> float | None:
    """Seconds until 1 - 1/e of the way from a run's first speed to `target` (m/s) is made; None where it is not.

    Between two samples by a straight line.
    """
    start = float(run.speed[0])
    wanted = start + REACHED * (target - start)
    ahead = (run.speed - wanted) * np.sign(target - start)
    past = np.flatnonzero(ahead >= 0.0)
    if not len(past) or past[0] == 0:
        return None
    i = int(past[0])
    share = -ahead[i - 1] / (ahead[i] - ahead[i - 1])
    return float(run.times[i - 1] + share * (run.times[i] - run.times[i - 1]) - run.times[0])


def mean_speed(run: MotorRun, last: int) -> tuple[float, float]:
    """(mean speed over the last so many samples of a free run, how far its two halves differ), m/s."""
    half = last // 2
    position, times = run.travelled[-last - 1 :], run.times[-last - 1 :]
    mean = (position[-1] - position[0]) / (times[-1] - times[0])
    early = (position[half] - position[0]) / (times[half] - times[0])
    late = (position[-1] - position[half]) / (times[-1] - times[half])
    return float(mean), float(abs(late - early))


def phase_portrait(run: MotorRun) -> tuple[Array, Array]:
    """(height, its rate) of the first foot at the samples, metres and m/s, the rate by differences."""
    return run.height[:, 0], np.gradient(run.height[:, 0], run.times)
