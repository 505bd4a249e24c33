"""Figures of a motor: what a slider at a speed is pushed with, where that is nought, how soon it gets there.

A figure at a speed is a mean over whole periods of the drive with the slider held at that speed and at its place, so
that the motion across can repeat itself; blocks of periods go on until two agree and carry what presses the slider on.
One that bounces without a pattern is read over ever longer windows, with how far their means are off. The free run,
which moves along the beam and lets the speed swing within a period, is the check on them.
"""

from collections.abc import Callable
from typing import Literal, TypeAlias, get_args

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from verify.errors import InputError
from verify.linear.surface import section_at
from verify.motor.case import MotorCase, blocks
from verify.motor.result import MotorRun, uninterrupted
from verify.motor.settling import (
    BALANCED,
    BLOCK,
    SETTLED,
    SMALL,
    Means,
    apart,
    creeps,
    dragged_at,
    means_of,
    missed,
    rows,
    spread_of,
    taken_up,
    told_by_balance,
    widened,
)

Reading: TypeAlias = Literal["force", "normal force", "shares", "powers"]
"""What may settle or not by itself."""
READINGS: tuple[Reading, ...] = get_args(Reading)
STAYS = 1.0 - 1e-9
"""Share of contact from which on nothing leaves, to rounding."""
MOST_BLOCKS = 60
PERIODS = 46_080
"""At most, unless asked for otherwise, that are run until the means settle."""
REACHED = 1.0 - np.exp(-1.0)
"""Of the no-load speed, at the time constant of starting."""
ALIKE = 0.05
"""Of the crests' speed: by so much the halves of a free run's end may differ."""
PUSHED = 0.01
"""Of mu N: so much may still push a free slider along at its end."""
CARRIED = 0.1
"""Of what presses on: by so much the normal force of that end may miss it."""
LONGEST = 4000
"""Periods in which a slider has to get under way, or to stop."""
HALVINGS = 40
UNKNOWN = Means(*6 * (np.inf,))
"""How far a first block is off."""


class AtSpeed(Struct, frozen=True, kw_only=True):
    """A motor whose slider is held at one speed, means over the last block of periods, or over half of all."""

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
    """Of the force, newton: between the last two blocks of a motion that repeats itself, otherwise twice the standard
    error of the mean."""
    normal_spread: float
    """Of the normal force likewise, newton; no less than it misses of the balance of momentum across the beam."""
    share_spread: float
    """Of the shares, the larger one."""
    power_spread: float
    """Of the two powers, the larger one, W."""
    periods: int
    """Until then, but for those in which it is dragged."""
    window: int
    """Periods, the last of these, of which these are means."""
    unsettled: tuple[Reading, ...]
    """What has not settled: its spread is more than a hundredth of mu N, of N, of 1, of mu N times the larger speed."""
    taken_up: float = 0.0
    """Share of the way that what gives way along the surface still takes up: 1 where nothing has slipped yet."""
    crept: bool = False
    """Whether that share alone is what has not settled."""

    @property
    def power(self) -> float:
        """On the slider, W: force times speed."""
        return self.force * self.speed + 0.0  # never a negative nought

    @property
    def bounces(self) -> bool:
        """Whether any point leaves the surface."""
        return self.contact_share < STAYS

    @property
    def efficiency(self) -> float | None:
        """Power over what the surface gives along the beam; None where either is not above 0."""
        return self.power / self.given if self.given > 0.0 and self.power >= 0.0 else None

    def settled(self, *readings: Reading) -> bool:
        """Whether none of these, or of all, has a spread that is not small."""
        return not set(readings or READINGS) & set(self.unsettled)

    @property
    def way(self) -> float:
        """The way that the force is told to push, +1.0 or -1.0; 0.0 where it is within its spread."""
        told = abs(self.force) > self.spread or (self.window == BLOCK and not self.unsettled)
        return float(np.sign(self.force)) if told else 0.0


def at_speed(case: MotorCase, speed: float, before: MotorRun | None = None, periods: int = PERIODS) -> AtSpeed:
    """The motor with its slider held at a speed, m/s, at the place where it is put. Raises InputError."""
    return held(case, speed, before, periods)[0]


def held(
    case: MotorCase, speed: float, before: MotorRun | None = None, periods: int = PERIODS
) -> tuple[AtSpeed, MotorRun]:
    """The same with the last run of periods; `before` is a converged run, held at its place too.

    Blocks of periods run until two agree and carry the preload. A motion that does not repeat itself so runs on in
    windows, each as long as all before it, until the spread of its means is small or `periods` are run. A slider that
    a block at its speed would not make slip is dragged first; those periods come on top.
    """
    most = min(MOST_BLOCKS, periods // BLOCK)
    fast = dragged_at(case.slider, speed, BLOCK * case.period)
    slipping = before if fast is None else _in_blocks(case, fast, before, most)[1]
    found, run = _in_blocks(case, speed, slipping, most)
    while found.unsettled and 2 * found.periods <= periods:
        found, run = _in_window(case, found, run)
    return found, run


def _in_blocks(case: MotorCase, speed: float, before: MotorRun | None, most: int) -> tuple[AtSpeed, MotorRun]:
    """The last of blocks, the first two that agree and carry what presses on; nothing has settled without such two."""
    block = _block(case, speed, BLOCK)
    run = _whole(block(before))
    means, number = means_of(run), 1
    found = _found(case, speed, means, UNKNOWN, BLOCK, BLOCK)
    while number < most:
        number, last, run = number + 1, run, _whole(block(run))
        earlier, means = means, means_of(run)
        off = missed(case.slider, last.state, run)
        spreads = apart(means, earlier, off, told_by_balance(case.slider))
        found = _found(
            case, speed, means, spreads, BLOCK * number, BLOCK, taken_up(case.slider, speed, last.state, run)
        )
        presses = max(found.normal_force, case.slider.normal_force)
        agree = found.spread <= SETTLED * case.slider.mu * presses and off <= BALANCED * presses
        if agree and not found.unsettled:
            return found, run
    spread = max(found.spread, case.slider.mu * found.normal_spread)  # two blocks in flight agree
    return replace(found, spread=spread, unsettled=READINGS), run


def _in_window(case: MotorCase, found: AtSpeed, before: MotorRun) -> tuple[AtSpeed, MotorRun]:
    """Means over as many periods more as there were."""
    run = _whole(_block(case, found.speed, found.periods)(before))
    each = rows(run)
    spreads = spread_of(each, missed(case.slider, before.state, run), told_by_balance(case.slider))
    taken = taken_up(case.slider, found.speed, before.state, run)
    return _found(case, found.speed, means_of(run), spreads, 2 * found.periods, found.periods, taken), run


def _block(case: MotorCase, speed: float, periods: int) -> Callable[[MotorRun | None], MotorRun]:
    """The next block of periods after a run, or the first."""
    if case.start == "steady":
        block = blocks(case, speed, periods, periods + 1)
        return lambda before: block(before.state if before is not None else None)
    return lambda before: case.run(
        periods * case.period,
        continue_from=before,
        held_speed=speed,
        frozen=True,
        samples=periods + 1,
    )


def _whole(run: MotorRun) -> MotorRun:
    """A run that has reached its end. Raises InputError."""
    if not uninterrupted(run).statistics.finished:
        raise InputError(
            f"the slider {run.statistics.stopped} after {run.state.time:.6g} s: give more steps_per_period"
        )
    return run


def _found(
    case: MotorCase, speed: float, means: Means, spreads: Means, periods: int, window: int, taken: float = 0.0
) -> AtSpeed:
    """Means of the last periods, with how far they have settled."""
    presses = max(means.normal_force, case.slider.normal_force)
    crept = creeps(spreads, taken, case.slider, presses)
    spreads = widened(spreads, taken, case.slider.mu * presses, speed)
    found = AtSpeed(
        speed=speed,
        **means._asdict(),
        spread=spreads.force,
        normal_spread=spreads.normal_force,
        share_spread=max(spreads.contact_share, spreads.stuck_share),
        power_spread=max(spreads.given, spreads.rubbed),
        periods=periods,
        window=window,
        unsettled=(),
        taken_up=taken,
        crept=crept,
    )
    return replace(found, unsettled=_unsettled(case, found))


def _unsettled(case: MotorCase, found: AtSpeed) -> tuple[Reading, ...]:
    """What has a spread that is not small against its full scale."""
    presses = max(found.normal_force, case.slider.normal_force)
    friction = case.slider.mu * presses
    wide: dict[Reading, bool] = {
        "force": found.spread > SMALL * friction,
        "normal force": found.normal_spread > SMALL * presses,
        "shares": found.share_spread > SMALL,
        "powers": found.power_spread > SMALL * max(abs(found.given), abs(found.rubbed)),
    }
    if wide["powers"]:  # nothing to speak of where the slider goes with the surface
        wide["powers"] = found.power_spread > SMALL * friction * (crest_speed(case) + abs(found.speed))
    return tuple(one for one, is_wide in wide.items() if is_wide)


def no_load(
    case: MotorCase, reach: float | None = None, before: MotorRun | None = None, periods: int = PERIODS
) -> AtSpeed:
    """The speed at which friction gives nothing on the average, by halving up to `reach` either way (m/s).

    Unless given, `reach` is twice the largest speed of the surface at the slider; `before` and `periods` as for
    `held`. Where the force is within its spread the search ends. Raises InputError where the force has the same sign
    at both ends, or has not converged where the search ends.
    """
    wide = 2.0 * crest_speed(case) if reach is None else reach
    low, high = -wide, wide
    for end, way in ((low, 1.0), (high, -1.0)):
        found = at_speed(case, end, before, periods)
        if not found.way:
            raise InputError(not_converged(found, periods))
        if found.way != way:
            raise InputError(
                f"reach = {wide!r} m/s: friction keeps its sign up to there, so that no speed without load lies "
                "between: give more slider.preload, or a larger reach"
            )
    found = at_speed(case, 0.0, before, periods)
    for _ in range(HALVINGS):
        low, high = (found.speed, high) if found.way > 0.0 else (low, found.speed)
        if not found.way or high - low <= 1e-6 * wide:
            break
        found = at_speed(case, 0.5 * (low + high), before, periods)
    if "force" in found.unsettled:
        raise InputError(not_converged(found, periods))
    return found


def not_converged(found: AtSpeed, periods: int) -> str:
    """Message for a mean friction force that has not converged."""
    return (
        f"periods = {periods!r}: at {found.speed:.6g} m/s the mean friction {found.force:.4g} +- {found.spread:.1g} N "
        "has not converged, give more periods, slider.contact.damping or slider.preload"
    )


def crest_speed(case: MotorCase) -> float:
    """First-order speed amplitude of the surface where the slider is put, (h/2) omega |w'|, m/s. Raises InputError."""
    field, x = case.field(), case.slider.start_on(case.beam)
    return section_at(case.beam, x).surface_distance * field.omega * float(abs(field.slope([x]))[0])


class Timed(Struct, frozen=True, eq=False, kw_only=True):
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
    return _timed(
        case.run(
            periods * case.period,
            samples=periods + 1,
        ),
        case.slider.speed,
        target,
    )


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
    uninterrupted(run)
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


def pushed_on(run: MotorRun, last: int) -> float:
    """What pushes a free slider along in the mean of its last so many samples, over mu N: its momentum tells."""
    slider = run.slider
    assert slider is not None
    seconds = float(run.times[-1] - run.times[-1 - last // 2])
    return float(slider.mass * mean_speed(run, last)[1] / seconds / (slider.mu * slider.normal_force))


def comes_to_speed(run: MotorRun, last: int, crests: float) -> bool:
    """Whether the end of a free run, so many samples, is one: nothing pushes it on and it carries what presses on.

    `crests` is the first-order speed of the surface, m/s, beside which its halves run alike.
    """
    slider = run.slider
    assert slider is not None
    alike = mean_speed(run, last)[1] <= ALIKE * crests and pushed_on(run, last) <= PUSHED
    if not told_by_balance(slider):
        return alike
    off = abs(float(run.normal_force[-last:].mean()) - slider.normal_force)
    return alike and off <= CARRIED * slider.normal_force
