"""Motors told by their means: when blocks and windows settle, where a motor runs free, how soon; by known runs.

A run here is a list of what it says of each period; verdicts are those of `motor/figures.py`.
"""

from collections.abc import Callable
from math import exp, pi, tanh
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.errors import InputError
from verify.models.arrays import Array
from verify.patience import patient
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.limits.as_written import misplaced, taken
from verify.stress.references.beams import STRIP

HERTZ, MU, LOAD, BLOCK = 340.0, 0.3, 7.0, 12
SLIDER = Slider(
    mass=0.05,
    mu=MU,
    slope=9.0,
    gravity=0.0,
    preload=LOAD,
    position=0.3,
    contact=Contact(stiffness=1e5, damping=3.0),
    foot=(Foot(mass=0.006), Foot(offset=0.02, mass=0.004)),
)
TURN, FREE = 0.013, 0.021
"""Slope of the surface, and the speed at which friction gives nothing, m/s."""
CREST = STRIP.surface_distance * 2.0 * pi * HERTZ * TURN
Says = Callable[[Array, float], Array]
"""(numbers of periods from 0, speed) -> (periods, 6): what `Means` names."""


def pushed(force: Callable[[Array, float], Array]) -> Says:
    """A motor whose mean friction is so much of mu N, all else steady."""

    def says(n: Array, speed: float) -> Array:
        one = np.ones(len(n))
        rest = (LOAD * one, 0.6 * one, 0.2 * one, 0.9 * one, 0.4 * one)
        return np.stack([MU * LOAD * force(n, speed), *rest], axis=1)

    return says


class Motor:
    """A case whose runs are known."""

    beam, start, frequency_hz, period = STRIP, "rest", HERTZ, 1.0 / HERTZ

    def __init__(self, says: Says, *, gains: float = 0.0, seconds: float = 0.0, slider: Slider = SLIDER) -> None:
        self.says, self.gains, self.seconds, self.slider = says, gains, seconds, slider
        self.asked: list[tuple[float, int]] = []

    def run(self, duration: float, *, continue_from: Any = None, held_speed: float = 0.0, **more: Any) -> Any:
        """So many periods more, with what a foot climbs faster at the end of them."""
        n = round(duration * HERTZ)
        begin = continue_from.done if continue_from is not None else 0
        each, steps = self.says(np.arange(begin, begin + n), held_speed), np.full(n, 1.0 / HERTZ)
        rows = np.vstack([np.zeros(6), each * np.column_stack([*4 * [np.ones(n)], steps, steps])])
        climb = (continue_from.state.feet[:, 1] if continue_from is not None else np.zeros(2)) + self.gains
        self.asked.append((duration * HERTZ, more["samples"]))
        names = ("friction", "normal_force", "contact_share", "stuck_share", "carried", "rubbed")
        return SimpleNamespace(
            done=begin + n,
            times=np.arange(n + 1.0) / HERTZ,
            duration=duration,
            statistics=SimpleNamespace(interrupted=False, finished=True, estimated_s=self.seconds * n),
            state=SimpleNamespace(feet=np.column_stack([np.zeros(2), climb]), time=0.1, speed=-0.7),
            speed=-0.7 + 1.7 * (1.0 - np.exp(-np.arange(n + 1.0) / 40.0)),
            turned=more.get("turned", False),
            **dict(zip(names, rows.T, strict=True)),
        )

    def field(self) -> Any:
        """In which the surface has a slope of TURN."""
        return SimpleNamespace(omega=2.0 * pi * HERTZ, slope=lambda x: np.array([1j * TURN]))

    def driven(self, factor: float) -> "Motor":
        """Cut off."""
        return Motor(lambda n, speed: factor * self.says(n, speed))

    def turned(self) -> "Motor":
        """Driven the other way."""
        return Motor(lambda n, speed: -self.says(n, speed))


def at_speed(motor: Any, speed: float, periods: int = 24) -> Any:
    """What it says at a speed."""
    from verify.motor.figures import at_speed as asked

    return asked(motor, speed, None, periods)


def _settles(part: float) -> bool:
    """Whether two blocks agree whose forces lie so far apart, of mu N."""
    return not at_speed(Motor(pushed(lambda n, v: np.where(n < BLOCK, 0.4, 0.4 + part))), 0.1).unsettled


def _balances(off: float) -> bool:
    """Whether two blocks are enough where the normal force misses so much of what presses on."""
    gained = off * LOAD * BLOCK / HERTZ / (SLIDER.moved_by(SLIDER.feet[0]) + SLIDER.moved_by(SLIDER.feet[1]))
    return not at_speed(Motor(pushed(lambda n, v: np.full(len(n), 0.4)), gains=gained), 0.1).unsettled


def _reads(name: str, reading: str) -> Callable[[float], bool]:
    """Whether a reading has settled that has such a spread."""
    from verify.motor.figures import AtSpeed, _unsettled

    def ask(spread: float) -> bool:
        figures = dict.fromkeys(AtSpeed.__struct_fields__, 0.0) | {"speed": -0.2, "normal_force": 9.0, name: spread}
        given: Any = figures | {"given": -2.0, "rubbed": 1.0, "periods": 24, "window": 12, "unsettled": ()}
        found = AtSpeed(**given)
        unsettled = _unsettled(Motor(pushed(np.multiply)), found)  # type: ignore[arg-type]
        return reading not in unsettled

    return ask


def _waited(seconds: float) -> bool:
    """Whether two blocks are begun that take half a second a period, where somebody waits for so long."""
    motor = Motor(pushed(lambda n, v: np.full(len(n), 0.4)), seconds=0.5)
    with patient(seconds):
        return taken(lambda: at_speed(motor, 0.1))


def settling_error(number: float) -> float:
    """How many limits of what settles are not where they are written; means of windows of what does not repeat."""
    powers = 0.01 * MU * 9.0 * (CREST + 0.2)
    wrong = misplaced(
        (
            (1e-4, True, _settles),
            (3e-3, True, _balances),
            (0.01 * MU * 9.0, True, _reads("spread", "force")),
            (0.01 * 9.0, True, _reads("normal_spread", "normal force")),
            (0.01, True, _reads("share_spread", "shares")),
            (max(powers, 0.02), True, _reads("power_spread", "powers")),
            (12.0, False, _waited),
        )
    )
    motor = Motor(pushed(lambda n, v: 0.3 + 0.04 * np.sin(1.7 * n) + 0.03 * np.sin(0.031 * n)))
    found = at_speed(motor, 0.1, 5760)
    window = motor.says(np.arange(found.periods - found.window, found.periods), 0.1).mean(axis=0)
    wrong += found.periods != 2 * found.window or found.periods % 1440 or bool(found.unsettled)
    own = (found.force, found.normal_force, found.contact_share, found.stuck_share, found.given, found.rubbed)
    wrong += not float(abs(np.array(own) / window - 1.0).max()) <= 1e-12
    early = at_speed(motor, 0.1, 720)
    wrong += early.periods != 720 or len(early.unsettled) != 4 or early.way != 1.0
    wrong += [one for one in motor.asked if abs(one[0] + 1.0 - one[1]) > 1e-9] != []
    return wrong


def _said(ask: Callable[[], object]) -> str:
    try:
        ask()
    except InputError as error:
        return str(error)
    return ""


def free_error(speed: float) -> float:
    """How far a motor's free speed is off, over a millionth of what is searched; verdicts and times that are not so."""
    from verify.motor.figures import force_speed, no_load, reversed_way, stall, started, stopped
    from verify.motor.withheld import not_settled

    law = pushed(lambda n, v: np.full(len(n), tanh(9.0 * (speed - v))))
    motor: Any = Motor(law)
    found = no_load(motor)
    wrong = not abs(found.speed - speed) <= 2e-6 * CREST or not abs(found.spread) <= 1e-12 * LOAD
    wrong |= not abs(stall(motor).force - MU * LOAD * tanh(9.0 * speed)) <= 1e-12 or stall(motor).speed != 0.0
    wrong |= [one.speed for one in force_speed(motor, (0.1, -0.2))] != [0.1, -0.2]
    wrong |= "does not change its way" not in _said(lambda: no_load(motor, 0.5 * abs(speed)))
    rough: Any = Motor(pushed(lambda n, v: 0.2 * np.sin(0.1 * n)))
    said = _said(lambda: no_load(rough, 1.0, None, 36))
    parts = ("periods = 36: at -1 m/s the slider bounces", "give more periods, more slider.contact")
    wrong |= not all(part in said for part in parts)
    wild = replace(at_speed(rough, -1.0, 36), spread=0.031, normal_spread=0.2, share_spread=0.04, power_spread=0.5)
    words = not_settled(rough, wild, ("force", "normal force", "shares", "powers"), 72)
    wrong |= words != (
        f"periods = 36: at -1 m/s the slider bounces and its means have not settled by then, mean friction "
        f"{wild.force:.4g} +- 0.03 N where mu N = 2.1 N, mean normal force 7 +- 0.2 N, shares of contact and sticking "
        "+- 0.04, rubbed 0.4 +- 0.5 W: set VERIFY_PATIENCE to more seconds, or give more slider.contact.damping or "
        "more slider.preload"
    )
    before: Any = SimpleNamespace(done=0, state=SimpleNamespace(feet=np.zeros((2, 2)), speed=-0.7))
    for one, start, target in (
        (started(motor, 1.0, 200), SLIDER.speed, 1.0),
        (stopped(motor, before, 200), -0.7, 0.0),
        (reversed_way(motor, before, 0.9, 200), -0.7, 0.9),
    ):
        part = (1.0 - exp(-1.0)) * (target + 0.7) / 1.7
        wrong |= one.time is None or not abs(one.time + 40.0 * np.log1p(-part) / HERTZ) <= 1e-3 * one.time
        wrong |= (one.start_speed, one.end_speed) != (start, float(one.run.speed[-1])) or len(one.run.times) != 201
    return float(wrong or _driven_otherwise())


def _driven_otherwise() -> bool:
    """Whether forces times a factor move the surface by other than that, or turned round by other than its conjugate.

    Of a beam without losses, whose answer to each force is real.
    """
    from verify.motor.case import MotorCase

    forces = (PointForce(position=0.11, amplitude=3.0, phase_deg=20.0), PointForce(position=0.5, phase_deg=70.0))
    case, x = MotorCase(beam=STRIP, forces=forces, frequency_hz=HERTZ, slider=SLIDER), np.array([0.1, 0.31, 0.6])
    moved, half, back = (one.field().deflection(x) for one in (case, case.driven(0.37), case.turned()))
    size = abs(moved).max()
    return bool(not max(abs(half - 0.37 * moved).max(), abs(back - moved.conj()).max()) <= 1e-12 * size)


ROWS: tuple[Row, ...] = (
    Floor(
        id="means-that-settle",
        title="Motors held at a speed, whose blocks agree or not, four parts in ten thousand on both sides; windows",
        why="motor/figures.py, settling.py: what each limit is said to be.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=settling_error,
    ),
    Floor(
        id="free-speeds-of-motors",
        title="Motors of known force over speed: where they run free, stand, how soon they start and turn round",
        why="motor/figures.py: by halving, to a millionth; exponentials.",
        along="m/s",
        at=(FREE, -0.013),
        promise=0.5,
        error=free_error,
    ),
)
