"""Sampled controllers as frozen values, whose `step` maps a state and a measurement to the next state and a command."""

from collections.abc import Callable
from math import inf, pi, sin, sqrt
from typing import Any

import numpy as np
from msgspec import Struct

from verify.errors import InputError
from verify.validation import check_integer, check_number

State = tuple[Any, tuple[Any, ...]]
"""State of a `Controller` between two ticks: integral, and commands that wait for the delay, the next one first."""


class Controller(Struct, frozen=True, kw_only=True):
    """PI controller of a speed, or of a position with an inner loop of the speed. Raises InputError.

    u = sat(f(r) + K_p e + I), e = r - y, I(k+1) = I(k) + h (K_i e + (sat u - u)/T_t): integral by forward differences,
    anti-windup by back-calculation with T_t = K_p/K_i, at least h (K. J. Åström and B. Wittenmark, Computer-Controlled
    Systems, 3rd ed., Prentice Hall 1997, sec. 8.5). Complex signals, as amplitudes of waves, are limited in magnitude.
    """

    gain: complex  # K_p, command per unit of the measured signal
    integral_gain: complex  # K_i, 1/s
    sample_time: float  # h, s
    lower: float = -inf  # Least command; not for complex signals
    upper: float = inf  # Largest command, or magnitude of a complex one
    delay: int = 0  # Computational delay, ticks
    position_gain: float = 0.0  # Gain of the position loop, 1/s; 0: the target is a speed
    feed_forward: Callable[[float], float] = lambda speed: 0.0  # f, steady command at a speed, m/s

    def __post_init__(self) -> None:
        check_number("sample_time", self.sample_time, "seconds", above=0)
        check_integer("delay", self.delay, 0)
        if not self.lower < self.upper:
            raise InputError(f"lower = {self.lower!r} is not below upper = {self.upper!r}: exchange the limits")

    def start(self, command: Any, target: float = 0.0) -> State:
        """The state in equilibrium at this command and target."""
        return command - self.feed_forward(target), (command,) * self.delay

    def step(self, state: State, target: Any, measured: Any, position: float = 0.0) -> tuple[State, Any]:
        """(next state, command from this tick to the next) for a target, m with a position loop."""
        integral, pending = state
        if self.position_gain:
            target = self.position_gain * (target - position)
        error = target - measured
        wanted = self.feed_forward(target) + self.gain * error + integral
        if np.iscomplexobj(wanted):
            command = wanted * np.minimum(1.0, self.upper / np.maximum(abs(wanted), 1e-300))
        else:
            command = min(max(wanted, self.lower), self.upper)
        reset = max(abs(self.gain / self.integral_gain) if self.integral_gain else inf, self.sample_time)
        rate = self.integral_gain * error + (command - wanted) / reset
        pending = (*pending, command)
        return (integral + self.sample_time * rate, pending[1:]), pending[0]


def magnitude_optimum(plant_gain: float, slow: float, fast: float) -> tuple[float, float]:
    """(K_p, K_i) for the plant K/((1 + slow s)(1 + fast s)): K_p/K_i = slow, K_i = 1/(2 K fast), time constants in s.

    `fast` is the sum of all small time constants, to which sampling adds (delay + 1/2) h; the damping ratio is
    1/sqrt(2) (C. Kessler, Regelungstechnik 6:395 and 432, 1958).
    """
    return 0.5 * slow / (plant_gain * fast), 0.5 / (plant_gain * fast)


def phase_locked_loop(
    time_constant: float, frequency_hz: float, sample_time: float, damping_ratio: float = 1.0 / sqrt(2.0)
) -> Controller:
    """Controller of the drive's angular frequency, rad/s, whose target is the phase -pi/2 of the response.

    Near a resonance of envelope time constant tau, s, the steady phase falls by tau per rad/s: the loop s^2 + s/tau +
    K_i has the damping ratio 1/(2 tau sqrt(K_i)). The command is limited to 20 % about `frequency_hz`.
    """
    omega, gain = 2.0 * pi * frequency_hz, -0.25 / (damping_ratio * time_constant) ** 2
    return Controller(gain=0.0, integral_gain=gain, sample_time=sample_time, lower=0.8 * omega, upper=1.2 * omega)


class ExtremumSeeker(Struct, frozen=True, kw_only=True):
    """Extremum seeking by a sinusoidal perturbation (M. Krstic and H.-H. Wang, Automatica 36:595, 2000).

    The mean of 2/a sin(omega t) times the measurement, less its own mean, is the slope of the static map; the estimate
    integrates it. Near a maximum with second derivative f'' it converges as exp(-gain |f''| t).
    """

    dither: float  # Amplitude a of the perturbation, in units of the command
    omega: float  # Its angular frequency, rad/s, well below the rates of the plant
    gain: float  # Rate of the estimate per unit of slope; negative for a minimum
    washout: float  # Corner frequency of the high-pass filter, rad/s, below `omega`
    sample_time: float  # s

    def step(self, state: tuple[float, float, int], measured: float) -> tuple[tuple[float, float, int], float]:
        """(next state, command) for the measurement under the previous command.

        State: estimate, mean of the measurement, number of ticks; it starts as (command, first measurement, 0).
        """
        estimate, mean, n = state
        change, phase = measured - mean, self.omega * self.sample_time
        estimate += self.sample_time * self.gain * 2.0 / self.dither * change * sin(phase * n)
        after = estimate, mean + self.sample_time * self.washout * change, n + 1
        return after, estimate + self.dither * sin(phase * (n + 1))
