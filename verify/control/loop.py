"""The closed loop of a motor, its step response, and the two-phase drive of a travelling wave."""

from typing import Any

import numpy as np
from msgspec import Struct

from verify.arrays import Array, ComplexArray
from verify.control.controller import Controller
from verify.errors import InputError, NoFigureError
from verify.formatting import one_line
from verify.waves.best_drive import PROPORTIONAL
from verify.waves.driven_case import UnitWaves

BAND = 0.02  # Half the band about the target in which a response has settled, relative to the step


class Response(Struct, frozen=True, eq=False):
    """Response to a step of the target at time 0, sampled at the ticks; errors are ratios of the step."""

    times: Array  # (n + 1,), s
    controlled: Array  # (n + 1,): speed, m/s, or position, m
    command: Array  # (n,), from each tick to the next
    target: float
    saturated: float  # Fraction of ticks with the command at a limit
    __repr__ = one_line(times="s", target="", controlled="", saturated="")

    @property
    def error(self) -> Array:
        """(n + 1,): -1 at the start, 0 at the target."""
        return np.asarray((self.controlled - self.target) / (self.target - self.controlled[0]))

    @property
    def overshoot(self) -> float:
        """Largest excess over the target; negative where the target is not reached."""
        return float(self.error.max())

    @property
    def settling_time(self) -> float | None:
        """Time from which the error stays within 2 %, s; None where the last tenth of the response does not."""
        late = np.flatnonzero(abs(self.error) > BAND)
        after = int(late[-1]) + 1 if len(late) else 0
        return float(self.times[after]) if after <= 0.9 * len(self.command) else None

    @property
    def settled_after(self) -> float:
        """`settling_time`, s. Raises InputError where the response does not settle."""
        if (seconds := self.settling_time) is None:
            raise InputError("duration: the response does not settle, give a longer one, or smaller gains")
        return seconds

    @property
    def steady_error(self) -> float:
        """Mean error over the last tenth."""
        return float(self.error[-max(len(self.command) // 10, 1) :].mean())


def closed_loop(
    controller: Controller, plant: Any, target: float, duration: float, start: tuple[float, float] = (0.0, 0.0)
) -> Response:
    """The response of a motor to a target, m/s (m with a position loop), from a steady state.

    `plant` is an `AveragedMotor` or a `FullMotor`, `start` the speed, m/s, and the command before time 0.
    """
    ticks, state = max(round(duration / controller.sample_time), 1), plant.start(*start)
    own, rows, commands = controller.start(start[1], start[0]), [plant.read(state)], list[float]()
    for _ in range(ticks):
        own, command = controller.step(own, target, rows[-1][1], rows[-1][0])
        state = plant.advance(state, command, controller.sample_time)
        rows.append(plant.read(state))
        commands.append(command)
    times: Array = controller.sample_time * np.arange(ticks + 1.0)
    controlled = np.array(rows)[:, 0 if controller.position_gain else 1]
    limited = float(np.isin(commands, (controller.lower, controller.upper)).mean())
    return Response(times, controlled, np.array(commands), target, limited)


def wave_drive(unit: UnitWaves, forward: complex, backward: complex) -> ComplexArray:
    """Complex amplitudes of two actuators, (n, 2), N or m, that make the waves A+ and A- (m) at n frequencies.

    It decouples two controllers, one for each wave. Raises NoFigureError at a frequency without waves, or where both
    actuators make the same wave, as at a resonance.
    """
    if unit.missing:
        raise unit.missing[0]
    matrix = np.stack([unit.forward, unit.backward], axis=1)
    if (abs(np.linalg.det(matrix)) <= PROPORTIONAL * np.linalg.norm(matrix, axis=1).prod(axis=1)).any():
        raise NoFigureError("near a resonance both actuators make the same wave: choose another frequency_hz")
    return np.asarray(np.linalg.solve(matrix, np.array([forward, backward], dtype=complex)))
