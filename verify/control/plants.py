"""Plants as frozen values, whose `advance` maps a state and a command, constant over a tick, to the state after it."""

from collections.abc import Callable
from math import asin, pi
from typing import Any, NamedTuple

import numpy as np
from msgspec import Struct
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.dynamics.arguments import Excitation, Keep
from verify.dynamics.result import Motion
from verify.dynamics.simulate import simulate
from verify.errors import InputError
from verify.linear.field import phasor, point_force
from verify.linear.positions import Numbers
from verify.motor.steady_state import MotorCase, crest_speed, steady_state
from verify.problem.beam import PointForce

Force = Callable[[float, float], float]  # (speed, m/s, constant command) -> mean force along +x, N
MOST_PERIODS = 400  # Drive periods until the mean force of unilateral contact converges


def commanded(case: MotorCase, command: float, output: str) -> MotorCase:
    """The motor under a command: a factor of all amplitudes, or the phase of the last force, degrees."""
    forces = case.forces
    if output == "phase":
        return replace(case, forces=(*forces[:-1], replace(forces[-1], phase_deg=command)))
    return replace(case, forces=tuple(replace(one, amplitude=command * one.amplitude) for one in forces))


def mean_force(case: MotorCase, speed: float) -> float:
    """Mean force along +x on a slider at a prescribed speed and a fixed position, N; bilateral: over one period."""
    if case.slider.contact is None:
        return float(case.run(1.0, 2, None, speed).mean_friction)
    return steady_state(case, speed, MOST_PERIODS).means.force + case.slider.external_force


def force_map(case: MotorCase, limits: tuple[float, float], output: str, size: tuple[int, int]) -> Force:
    """Bicubic spline of the mean force, from constant commands within limits x prescribed speeds, `size` of each.

    It is a spline in s, speed = crest speed times sin s: at the crest speed the derivative of Coulomb friction by the
    speed is infinite, by s it is not. Beyond, the force is constant. Raises InputError for zero amplitude.
    """
    from scipy.interpolate import RectBivariateSpline

    (lower, upper), scaled = limits, output == "amplitude"
    if not lower < upper or (scaled and lower <= 0.0):
        raise InputError(f"lower = {lower!r}: give it below upper = {upper!r}, and above 0 for an amplitude")
    top = crest_speed(case if scaled else commanded(case, 90.0, output))
    grid, angles = np.linspace(lower, upper, size[0]), np.linspace(-0.5, 0.5, size[1]) * pi
    motors = [(commanded(case, command, output), top * (command if scaled else 1.0)) for command in grid.tolist()]
    table = [[mean_force(motor, v) for v in (fastest * np.sin(angles)).tolist()] for motor, fastest in motors]
    spline = RectBivariateSpline(grid, angles, table, kx=min(3, size[0] - 1), ky=3)

    def force(v: float, y: float) -> float:
        at = min(max(y, lower), upper)
        return float(spline.ev(at, asin(min(max(v / (top * (at if scaled else 1.0)), -1.0), 1.0))))

    return force


class AveragedMotor(Struct, frozen=True, kw_only=True):
    """m dv/dt = F(v, y), dy/dt = (u - y)/tau_e: the wave follows the command u as the envelope of one resonance.

    State: position, speed, envelope.
    """

    mass: float  # kg
    force: Force
    time_constant: float  # tau_e = 2Q/omega, s

    def start(self, speed: float, command: float) -> Array:
        """The state in equilibrium."""
        return np.array([0.0, speed, command])

    def advance(self, state: Array, command: float, seconds: float) -> Array:
        """The state after `seconds`."""
        from scipy.integrate import solve_ivp

        def rates(_: float, now: Array) -> list[float]:
            _, v, y = now.tolist()
            return [v, self.force(v, y) / self.mass, (command - y) / self.time_constant]

        solved = solve_ivp(rates, (0.0, seconds), state, "DOP853", rtol=1e-10, atol=1e-13)
        return np.asarray(solved.y[:, -1])

    def read(self, state: Array) -> tuple[float, float]:
        """(position, speed)."""
        return float(state[0]), float(state[1])

    def command_at(self, speed: float, lower: float, upper: float) -> float:
        """The steady command at a speed, m/s: the nearer limit where none within the limits has it."""
        from scipy.optimize import brentq

        net = [self.force(speed, limit) for limit in (lower, upper)]
        if net[0] * net[1] >= 0.0:
            return lower if abs(net[0]) <= abs(net[1]) else upper
        return float(brentq(lambda y: self.force(speed, y), lower, upper, xtol=1e-12 * (upper - lower)))

    def linearised(self, speed: float, command: float) -> "tuple[AveragedMotor, float, float]":
        """(linear motor, gain dv/du of the steady state, time constant m/|dF/dv|, s) about a speed and a command.

        Raises InputError where the force does not fall with the speed.
        """
        dv, dy = 1e-5 * max(abs(speed), 0.01), 1e-5 * max(abs(command), 1.0)  # central differences of a cubic spline
        by_speed = (self.force(speed + dv, command) - self.force(speed - dv, command)) / (2.0 * dv)
        by_command = (self.force(speed, command + dy) - self.force(speed, command - dy)) / (2.0 * dy)
        if by_speed >= 0.0:
            raise InputError(f"target = {speed!r} m/s: the force does not fall with the speed there, change it")

        def force(v: float, y: float) -> float:
            return by_speed * (v - speed) + by_command * (y - command)

        return replace(self, force=force), -by_command / by_speed, -self.mass / by_speed


class FullMotor(Struct, frozen=True, kw_only=True):
    """Beam and slider in time: every tick continues the run under a new command."""

    case: MotorCase  # With start = 'rest', so that the field grows and decays by its modes
    output: str  # amplitude or phase
    settling: float  # Time at the initial speed and command before the first tick, s

    def start(self, speed: float, command: float) -> Motion:
        """The run at a prescribed speed and a fixed position, and a first free period with that mean speed.

        A released slider keeps the phase of its ripple, so that its mean speed differs from that of its release.
        """
        period = self.case.period
        held = self.advance(None, command, self.settling, speed)
        released = self.read(self.advance(held, command, period))[1]
        return self.advance(self.advance(held, command, period, 2.0 * speed - released), command, period)

    def advance(self, state: Motion | None, command: float, seconds: float, speed: float | None = None) -> Motion:
        """The run of the next `seconds`. Raises InputError where the slider leaves the beam."""
        periods = seconds / self.case.period
        run = commanded(self.case, command, self.output).run(periods, max(round(periods), 1) + 1, state, speed)
        if not run.statistics.finished:
            raise InputError(f"duration: the slider {run.statistics.stopped} after {run.end.time:.4g} s, shorten it")
        return run

    def read(self, state: Motion) -> tuple[float, float]:
        """(position, mean speed over the last drive period of the tick, of whole periods)."""
        times, travelled = state.times, state.travelled
        return float(travelled[-1]), float((travelled[-1] - travelled[-2]) / (times[-1] - times[-2]))


class Resonance(Struct, frozen=True, kw_only=True):
    """The envelope of a resonance, a' = -(1/tau + i (omega - omega_n)) a - i/tau; the command is omega, rad/s.

    a is the response over its amplitude at resonance, its phase relative to the drive; a tick is exact.
    """

    omega: float  # omega_n, rad/s
    time_constant: float  # tau = 2Q/omega_n, s

    def start(self, command: float) -> complex:
        """The steady state."""
        return -1j / (1.0 + 1j * (command - self.omega) * self.time_constant)

    def advance(self, state: complex, command: float, seconds: float) -> complex:
        """The envelope after `seconds`."""
        rate, steady = -(1.0 / self.time_constant + 1j * (command - self.omega)), self.start(command)
        return complex(steady + (state - steady) * np.exp(rate * seconds))


class BeamTick(NamedTuple):
    """A tick of a beam without slider."""

    run: Motion
    phase: float  # of the drive at the end, rad
    phasors: ComplexArray  # (p,), m: response at `at` over the last 1.5 periods, relative to the drive


def beam_tick(
    forces: tuple[PointForce, ...],
    omega: float,
    seconds: float,
    before: BeamTick | None = None,
    *,
    at: Numbers,
    **settings: Any,
) -> BeamTick:
    """A beam in time under forces at omega, rad/s, with continuous phase; `at`: positions of the response, (p,), m.

    `settings` as in `simulate`.
    """
    from verify.travelling_wave import phasors

    hertz, begin, phase = omega / (2.0 * pi), *((before.run.end.time, before.phase) if before else (0.0, 0.0))
    turn = complex(np.exp(1j * (phase - omega * begin)))
    excitation = Excitation([point_force(force.position, turn * phasor(force)) for force in forces], hertz)
    keep = Keep(at=at, samples=16 * round(seconds * hertz + 1.0))
    if before is not None:
        settings["start"] = before.run
    run = simulate(excitation=excitation, duration=seconds, keep=keep, **settings)
    last = run.times > run.times[-1] - 1.5 / hertz
    return BeamTick(run, phase + omega * seconds, phasors(run.times[last], run.deflection[last], hertz) / turn)
