"""Closed loops: response of a motor to a step of the target, its figures, and the two-phase drive of a wanted wave."""

from collections.abc import Callable

import numpy as np
from msgspec import Struct

from verify.arrays import Array, ComplexArray
from verify.control.controller import Controller
from verify.control.plants import AveragedMotor, FullMotor
from verify.errors import NoFigureError
from verify.waves.best_drive import PROPORTIONAL
from verify.waves.driven_case import UnitWaves

BAND = 0.02
"""Relative band about the target in which a response has settled."""


class Response(Struct, frozen=True, eq=False, kw_only=True):
    """Response to a step of the target at time 0, sampled at the ticks."""

    times: Array
    """(n + 1,), s."""
    controlled: Array
    """(n + 1,): speed, m/s, or position, m."""
    command: Array
    """(n,), from each tick to the next."""
    target: float
    saturated: float
    """Fraction of ticks with the command at a limit."""

    @property
    def fraction(self) -> Array:
        """(n + 1,): 0 at the start, 1 at the target."""
        return np.asarray((self.controlled - self.controlled[0]) / (self.target - self.controlled[0]))

    @property
    def overshoot(self) -> float:
        """Largest excess over the step, a ratio of the step; negative where the target is not reached."""
        return float(self.fraction.max()) - 1.0

    @property
    def settling_time(self) -> float | None:
        """Time from which the response stays within 2 % of the step, s; None without an interval of a tenth."""
        outside = np.flatnonzero(abs(self.fraction - 1.0) > BAND)
        last = int(outside[-1]) + 1 if len(outside) else 0
        return float(self.times[last]) if last <= 0.9 * len(self.command) else None

    @property
    def steady_error(self) -> float:
        """Mean of the last tenth less the target, a ratio of the step."""
        return float(self.fraction[-max(len(self.command) // 10, 1) :].mean()) - 1.0


def closed_loop(
    controller: Controller, plant: AveragedMotor | FullMotor, target: float, duration: float,
    start: tuple[float, float] = (0.0, 0.0), progress: Callable[[float], None] = lambda part: None,
) -> Response:  # fmt: skip
    """The response to a target, m/s (m with a position loop), from a steady state `start`: speed, m/s, and command."""
    ticks, state = max(round(duration / controller.sample_time), 1), plant.start(*start)
    own = controller.start(start[1], start[0])
    rows, commands = [plant.read(state)], list[float]()
    for k in range(ticks):
        progress(k / ticks)
        own, command = controller.step(own, target, rows[-1][1], rows[-1][0])
        state = plant.advance(state, command, controller.sample_time)
        rows.append(plant.read(state))
        commands.append(command)
    position, speed = np.array(rows).T
    return Response(
        times=controller.sample_time * np.arange(ticks + 1),
        controlled=position if controller.position_gain else speed,
        command=np.array(commands),
        target=target,
        saturated=float(np.isin(commands, (controller.lower, controller.upper)).mean()),
    )


def wave_drive(unit: UnitWaves, forward: complex, backward: complex) -> ComplexArray:
    """Complex amplitudes of two actuators, (n, 2), N or m, that make the waves A+ and A- at n frequencies, m.

    Two-phase control in travelling waves: each of the two waves has its own controller, whose commands are wanted
    waves, and this matrix decouples them. Raises NoFigureError where both actuators make the same wave, as at a
    resonance, and for a frequency without waves.
    """
    if unit.missing:
        raise unit.missing[0]
    matrix = np.stack([unit.forward, unit.backward], axis=1)
    sizes = np.linalg.norm(matrix, axis=1).prod(axis=1)
    if (abs(np.linalg.det(matrix)) <= PROPORTIONAL * sizes).any():
        raise NoFigureError("near a resonance both actuators make the same wave: choose another frequency_hz")
    return np.asarray(np.linalg.solve(matrix, np.array([forward, backward], dtype=complex)[:, None])[:, :, 0])
