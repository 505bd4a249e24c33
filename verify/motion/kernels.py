"""Compiled loops of a slider on a moving surface. One file: numba's cache does not see edits in an imported one.

The surface is a set of rows: row j has a deflection shape, on every piece of the beam a polynomial in the local
coordinate xi in [0, 1], and a time factor q_j(t). Rows 0..n-1 are modes that vibrate freely, q = Re z with
z' = (-sigma + i omega) z, which a rotation advances exactly by any step. The rest belong to the drive: real and
imaginary part of (t/T)^d e^{i omega t}.
"""

from functools import partial
from typing import Any

import numpy as np
from numba import njit

# nothing here allocates: without numba's memory runtime no loop counts references, which doubles the speed
_compiled = partial(njit, _nrt=False)
_FAST = {"reassoc", "contract", "nsz"}
# entries of `motion`: what the slider carries from step to step; height and climb are those of a slider held on the
# surface, its normal reaction is the mean over the step, and the fall is the largest downward acceleration so far
X, V, STUCK, HEIGHT, CLIMB, NORMAL, FALL = range(7)
# columns of `seen`, one row each for the start, the middle and the end of a step
SURFACE, PULL, DRIFT, POWER, LOSS, LEVEL = range(6)
# entries of `law`; LOAD is the weight and what else presses the slider on, newton
KIND, KINETIC, STATIC, SLOPE, MASS, HALF, GRAVITY, FOLLOWING, HELD, LOAD = range(10)
TANH, COULOMB = 0.0, 1.0
# entries of `ledger`; LIFTED is the work of the normal reaction on the beam
ON_BEAM, ON_SLIDER, DRIVEN, DAMPED, RUBBED, LIFTED = range(6)
# entries of `tally`: steps of this stage, samples and events of the whole run
STEP, SAMPLES, EVENTS = range(3)
# why a loop came back
DONE, OFF_PIECES, NOT_FINITE = range(3)
# kinds of events
STICKS, SLIPS, TURNS = 1.0, 2.0, 3.0


# rows of `modes`, (11, n): the state z' = (-sigma + i omega) z, its turns over half a step and a whole one, levers of a
# tangential force and of a normal one in mid-step, deflection under the slider at the end
Z_RE, Z_IM, SIGMA, OMEGA, HALF_RE, HALF_IM, FULL_RE, FULL_IM, LEVER, LIFT, READ = range(11)
# rows of `factors`, (2, rows), and of `local`, (3, degree + 1): deflection, velocity, deflection a step before
STILL, MOVING, BEFORE = range(3)
# entries of `drive`; from GROWTH on, the forces' amplitude as a polynomial in t/RAMP; RAMP is the rows' unit of time
FREQUENCY, ORIGIN, RAMP, GROWTH = range(4)
# entries of `slip`: what friction adds to the speed, sticking at the end, what else adds, how many events, and from
# FIRST_EVENT on their times within the step and their kinds in turns
CHANGE, STICKING, GIVEN_MIDDLE, GIVEN_END, N_EVENTS, FIRST_EVENT = range(6)
SPANS = 20  # of a step, between which friction changes its mind
# columns of `kept`
KEPT_X, KEPT_V, KEPT_FRICTION, KEPT_SURFACE, KEPT_NORMAL = range(5)


@_compiled(cache=True)
def tanh_speed_change(r: float, a: float, b: float, slope: float, dt: float) -> float:
    """What friction -b tanh(slope r) adds to a slider's speed in dt, while r' = -b tanh(slope r) - a exactly.

    r is the relative speed at the start and `a` the constant acceleration of the surface. Solved in closed form
    up to one monotone scalar equation, so any slope and any step are stable and exact.
    """
    if b <= 0.0 or dt <= 0.0:
        return 0.0
    alpha, tau = a / b, slope * b * dt
    side = -1.0 if alpha < 0.0 else 1.0  # mirrored, so that the surface accelerates forward
    alpha, rho = side * alpha, side * slope * r
    if (1.0 + alpha) * tau < 0.01:
        return float(side * _brief_change(rho, alpha, tau) / slope)
    if min(rho, rho - (alpha + 1.0) * tau) > 20.0:
        return -side * b * dt  # |tanh| is 1 throughout, to e^-40
    if max(rho, rho - (alpha - 1.0) * tau) < -20.0:
        return side * b * dt
    if abs(alpha - 1.0) < 1e-7:
        alpha = 1.0 + (1e-7 if alpha >= 1.0 else -1e-7)  # 1e-7 of b in this step; the formulas part there
    change = _held_change(rho, alpha, tau) if alpha < 1.0 else _swept_change(rho, alpha, tau)
    added = min(max(change + alpha * tau, -tau), tau)  # rounding gives no more than friction has
    return float(side * added / slope)


@_compiled(cache=True)
def _brief_change(rho: float, alpha: float, tau: float) -> float:
    """What friction adds to rho in a short tau: four stages, off by less than 1e-11 of it, where logarithms cancel."""
    first = np.tanh(rho)
    second = np.tanh(rho - 0.5 * tau * (first + alpha))
    third = np.tanh(rho - 0.5 * tau * (second + alpha))
    fourth = np.tanh(rho - tau * (third + alpha))
    return float(-tau * (first + 2.0 * second + 2.0 * third + fourth) / 6.0)


@_compiled(cache=True, error_model="numpy")
def _swept_change(rho: float, alpha: float, tau: float) -> float:
    """Change of rho in tau under rho' = -(tanh rho + alpha), alpha > 1: there is no speed at rest with the surface.

    alpha delta - ln cosh delta falls by (alpha^2 - 1) tau, with delta = rho + artanh(1/alpha). Newton's method on
    the change; it stops where the next step would be rounding.
    """
    grip = np.tanh(rho)
    lean = (alpha * grip + 1.0) / (alpha + grip)  # tanh delta
    fall = (alpha * alpha - 1.0) * tau
    change = -(alpha + np.tanh(rho - 0.5 * (alpha + grip) * tau)) * tau
    for _ in range(80):
        if abs(change) < 4.0:
            grown = np.expm1(change)
            sine, cosine = 0.5 * (grown + grown / (grown + 1.0)), 0.5 * grown * grown / (grown + 1.0)
            inner = cosine + lean * sine
            value, end = np.log1p(inner), (lean * (1.0 + cosine) + sine) / (1.0 + inner)
        else:
            delta = rho + np.arctanh(1.0 / alpha)
            value, end = _ln_cosh(delta + change) - _ln_cosh(delta), np.tanh(delta + change)
        step = (alpha * change - value + fall) / (alpha - end)
        change -= step
        if abs(step) <= 1e-8 * (abs(change) + 1e-8):
            break
    return float(change)


@_compiled(cache=True)
def _ln_cosh(delta: float) -> float:
    """Ln(2 cosh delta), without overflow."""
    return float(abs(delta) + np.log1p(np.exp(-2.0 * abs(delta))))


@_compiled(cache=True)
def _held_change(rho: float, alpha: float, tau: float) -> float:
    """Change of rho in tau under rho' = -(tanh rho + alpha), 0 <= alpha < 1: rho tends to rest = -artanh alpha.

    With eta = |rho - rest|, ln sinh eta - s alpha eta falls by (1 - alpha^2) tau; solved for ln sinh eta, in which
    the slope lies between 1 - alpha and 1 + alpha.
    """
    rest = -np.arctanh(alpha)
    side = 1.0 if rho > rest else -1.0
    eta = abs(rho - rest)
    if eta == 0.0:
        return 0.0
    lean = side * alpha
    start = _ln_sinh(eta)
    goal = start - lean * eta - (1.0 - alpha * alpha) * tau
    level = min(start, goal + lean * eta)
    for _ in range(80):
        here = _arsinh_exp(level)
        step = (level - lean * here - goal) / (1.0 - lean * np.tanh(here))
        level -= step
        if abs(step) <= 1e-8:  # the next would be its square
            break
    return float(side * _arsinh_exp(level) + rest - rho)


@_compiled(cache=True)
def _ln_sinh(eta: float) -> float:
    return float(np.log(np.sinh(eta))) if eta < 1.0 else eta - np.log(2.0) + np.log1p(-np.exp(-2.0 * eta))


@_compiled(cache=True)
def _arsinh_exp(level: float) -> float:
    return float(np.arcsinh(np.exp(level))) if level < 20.0 else level + np.log(2.0)


@_compiled(cache=True)
def coulomb_span(r: float, a0: float, a1: float, kinetic: float, static: float, dt: float, stuck: bool) -> Any:
    """Until friction changes its mind: (time used, r at its end, whether stuck then, kind of event or 0).

    `a0` and `a1` are the acceleration of the surface relative to a slider free of friction, at the start and the
    end of dt, linear between. A slider at rest on the surface stays while |a| <= static; one that slips does so
    under `kinetic` until r = 0, where it sticks if it can.
    """
    rate = (a1 - a0) / dt
    if stuck and abs(a0) > static * (1.0 + 1e-12):
        return 0.0, 0.0, False, SLIPS
    if stuck:
        for bound in (static, -static):
            beyond = (a1 - bound) * (1.0 if bound > 0.0 else -1.0)
            if beyond > 0.0 and rate != 0.0:
                return min(max((bound - a0) / rate, 0.0), dt), 0.0, False, SLIPS
        return dt, 0.0, True, 0.0
    side = np.sign(r) if r != 0.0 else -np.sign(a0 if a0 != 0.0 else rate)
    slowing = kinetic * side + a0  # r(t) = r - slowing t - rate t^2 / 2
    used = _first_zero(r, slowing, rate, dt)
    if used >= dt:
        return dt, r - slowing * dt - 0.5 * rate * dt * dt, False, 0.0
    return used, 0.0, abs(a0 + rate * used) <= static, STICKS if abs(a0 + rate * used) <= static else TURNS


@_compiled(cache=True)
def _first_zero(r: float, slowing: float, rate: float, dt: float) -> float:
    """The first t in (0, dt) where r - slowing t - rate t^2/2 changes sign, else dt."""
    if r == 0.0:
        # leaves zero now; it comes back where slowing + rate t / 2 = 0
        back = -2.0 * slowing / rate if rate != 0.0 else dt
        return back if 0.0 < back < dt else dt
    discriminant = slowing * slowing + 2.0 * rate * r
    if discriminant < 0.0:
        return dt
    root = np.sqrt(discriminant)
    q = slowing + root if slowing >= 0.0 else slowing - root
    first, second = (2.0 * r / q if q != 0.0 else dt), (-q / rate if rate != 0.0 else dt)
    best = dt
    for t in (first, second):
        if 0.0 < t < best:
            best = t
    return best


@_compiled(cache=True)
def _tanh_on_belt(
    x: float, v: float, dt: float, kinetic: float, slope: float, belt: float, stiffness: float, pull: float
) -> Any:
    """(x, v) after a step of a spring-held slider under Eq. (3): the spring's mean force, friction solved exactly."""
    start = pull - stiffness * x
    rate = start - kinetic * np.tanh(slope * (v - belt))
    middle = pull - stiffness * (x + 0.5 * dt * v + 0.125 * dt * dt * rate)
    end = pull - stiffness * (x + dt * v + 0.5 * dt * dt * rate)
    given = dt * (start + 4.0 * middle + end) / 6.0
    v1 = v + given + tanh_speed_change(v - belt, -given / dt, kinetic, slope, dt)
    rate1 = end - kinetic * np.tanh(slope * (v1 - belt))
    return x + 0.5 * dt * (v + v1) + dt * dt * (rate - rate1) / 12.0, v1


@_compiled(cache=True)
def slide_on_belt(
    n_steps: int, dt: float, law: Any, belt: float, stiffness: float, pull: float, state: Any, events: Any
) -> int:
    """A slider held by a spring to the ground on a surface of constant speed; returns the number of events.

    `state` is (x, v, stuck) and is advanced in place; `stiffness` is k/m, `pull` an acceleration. `events` is
    (capacity, 3): time, kind, x; a turn of the velocity relative to the surface is an event as well.
    """
    x, v, stuck = state[0], state[1], state[2] > 0.0
    kind, kinetic, static, slope = law[KIND], law[KINETIC], law[STATIC], law[SLOPE]
    n_events = 0
    for step in range(n_steps):
        left = dt
        while left > 0.0:
            force0 = pull - stiffness * x
            if kind == TANH:
                x, v = _tanh_on_belt(x, v, dt, kinetic, slope, belt, stiffness, pull)
                break
            rate = 0.0 if stuck else force0 - kinetic * np.sign(v - belt)
            end = pull - stiffness * (x + left * v + 0.5 * left * left * rate)
            used, r1, stuck1, event = coulomb_span(v - belt, -force0, -end, kinetic, static, left, stuck)
            rate1 = 0.0 if stuck else force0 + (end - force0) * used / left - kinetic * np.sign(v - belt)
            x += 0.5 * used * (v + belt + r1) + used * used * (rate - rate1) / 12.0
            v, stuck, left = belt + r1, stuck1, left - used
            if event != 0.0 and n_events < len(events):
                events[n_events, 0], events[n_events, 1], events[n_events, 2] = (step + 1) * dt - left, event, x
                n_events += 1
            if used <= 0.0 and event == 0.0:
                left = 0.0
    state[0], state[1], state[2] = x, v, 1.0 if stuck else 0.0
    return n_events


@_compiled(cache=True, fastmath=_FAST)
def _rotate_half(modes: Any) -> None:
    """Advance every free mode by half a step."""
    for j in range(modes.shape[1]):
        real = modes[Z_RE, j] * modes[HALF_RE, j] - modes[Z_IM, j] * modes[HALF_IM, j]
        modes[Z_IM, j] = modes[Z_RE, j] * modes[HALF_IM, j] + modes[Z_IM, j] * modes[HALF_RE, j]
        modes[Z_RE, j] = real


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _set_factors(time: float, modes: Any, drive: Any, factors: Any) -> None:
    """Time factors of all rows and their rates: modes first, then (t/ramp)^d (cos, -sin) of the drive."""
    n = modes.shape[1]
    for j in range(n):
        factors[STILL, j] = modes[Z_RE, j]
        factors[MOVING, j] = -modes[SIGMA, j] * modes[Z_RE, j] - modes[OMEGA, j] * modes[Z_IM, j]
    omega, unit = drive[FREQUENCY], drive[RAMP]
    angle = omega * (drive[ORIGIN] + time)
    c, s = np.cos(angle), np.sin(angle)
    power, growth = 1.0, 0.0
    for d in range((factors.shape[1] - n) // 2):
        j = n + 2 * d
        factors[STILL, j], factors[STILL, j + 1] = power * c, -power * s
        factors[MOVING, j] = growth * c - power * omega * s
        factors[MOVING, j + 1] = -growth * s - power * omega * c
        growth = (d + 1) * power / unit
        power = power * time / unit


@_compiled(cache=True, fastmath=_FAST)
def _set_local(table: Any, piece: int, factors: Any, local: Any) -> None:
    """Polynomials of deflection and velocity on one piece; table is (pieces, degree + 1, rows)."""
    for d in range(table.shape[1]):
        still, moving = 0.0, 0.0
        for j in range(table.shape[2]):
            still += table[piece, d, j] * factors[STILL, j]
            moving += table[piece, d, j] * factors[MOVING, j]
        local[STILL, d], local[MOVING, d] = still, moving


@_compiled(cache=True)
def find_piece(edges: Any, x: float, piece: int) -> int:
    """The piece that holds x, from the one that did; -1 off the pieces."""
    while piece >= 0 and x < edges[piece]:
        piece -= 1
    if piece < 0:
        return -1
    while piece < len(edges) - 1 and x > edges[piece + 1]:
        piece += 1
    return piece if piece < len(edges) - 1 else -1


@_compiled(cache=True, error_model="numpy", inline="always")
def _material(local: Any, edges: Any, piece: int, x: float, half: float) -> float:
    """The local coordinate of the material point under x: X = x + (h/2) w'."""
    length = edges[piece + 1] - edges[piece]
    xi = (x - edges[piece]) / length
    value, first = 0.0, 0.0
    for d in range(local.shape[1] - 1, 0, -1):
        value = value * xi + local[STILL, d]
        first = first * xi + value
    return float(xi + half * first / (length * length))


@_compiled(cache=True, error_model="numpy", inline="always")
def _touch(local: Any, edges: Any, piece: int, x: float, speed: float, law: Any, seen: Any, row: int) -> None:
    """The surface under x: tangential velocity of its material, and what a slider that follows it feels.

    The material point over x stands at X = x + (h/2) w'(X) of the mid-line and moves with (-(h/2) dw'/dt, dw/dt).
    """
    length = edges[piece + 1] - edges[piece]
    at = _material(local, edges, piece, x, law[HALF])
    deflection, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):  # Horner for values and derivatives together
        bend = bend * at + slope
        slope = slope * at + deflection
        deflection = deflection * at + local[STILL, d]
        turn = turn * at + rise
        rise = rise * at + local[MOVING, d]
    slope, turn = slope / length, turn / length
    seen[row, SURFACE] = (rise * slope - law[HALF] * turn) / np.sqrt(1.0 + slope * slope)
    seen[row, PULL], seen[row, DRIFT], seen[row, LEVEL] = 0.0, 0.0, deflection
    if law[FOLLOWING] > 0.0:
        seen[row, PULL] = rise * (turn + 2.0 * bend / (length * length) * speed) - law[GRAVITY] * slope
        seen[row, DRIFT] = -slope * rise


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _set_levers(table: Any, piece: int, edges: Any, local: Any, x: float, half: float, modes: Any) -> Any:
    """How unit forces on the surface at x load every mode: a tangential one -(h/2) on its slope, w' on its rise.

    A normal one acts on its rise. Returns the local coordinate of the material there and w'.
    """
    length = edges[piece + 1] - edges[piece]
    at = _material(local, edges, piece, x, half)
    slope, deflection = 0.0, 0.0
    for d in range(table.shape[1] - 1, -1, -1):
        slope = slope * at + deflection
        deflection = deflection * at + local[STILL, d]
    slope /= length
    stretch = np.sqrt(1.0 + slope * slope)
    for j in range(modes.shape[1]):
        value, first = 0.0, 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            first = first * at + value
            value = value * at + table[piece, d, j]
        modes[LEVER, j] = (slope * value - half * first / length) / stretch
        modes[LIFT, j] = value
    return at, slope


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _set_reads(table: Any, piece: int, edges: Any, local: Any, x: float, half: float, modes: Any) -> None:
    """The deflection of every mode under the slider at x."""
    at = _material(local, edges, piece, x, half)
    for j in range(modes.shape[1]):
        value = 0.0
        for d in range(table.shape[1] - 1, -1, -1):
            value = value * at + table[piece, d, j]
        modes[READ, j] = value


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _mobility(modes: Any, acts: int, turn: int) -> float:
    """Tangential speed of the surface after a constant unit force has acted for half a step or a whole one, m/s per N.

    `acts` is the row of the force's levers.
    """
    total = 0.0
    for j in range(modes.shape[1]):
        total += modes[LEVER, j] * modes[acts, j] * modes[turn, j] / modes[OMEGA, j]
    return total


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _compliance(modes: Any, acts: int) -> float:
    """How far a constant unit force lifts the surface under the slider in a step, m/N."""
    total = 0.0
    for j in range(modes.shape[1]):
        decay, omega = modes[SIGMA, j], modes[OMEGA, j]
        gain = 1.0 - modes[FULL_RE, j] - modes[FULL_IM, j] * decay / omega
        total += modes[READ, j] * modes[acts, j] * gain / (omega * omega + decay * decay)
    return total


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _press(force: float, acts: int, modes: Any) -> None:
    """Add what a constant force over the whole step adds to the modes: (1 - turn) about the shifted rest position."""
    for j in range(modes.shape[1]):
        decay, omega = modes[SIGMA, j], modes[OMEGA, j]
        real = force * modes[acts, j] / (omega * omega + decay * decay)
        imaginary = -real * decay / omega
        modes[Z_RE, j] += real - (modes[FULL_RE, j] * real - modes[FULL_IM, j] * imaginary)
        modes[Z_IM, j] += imaginary - (modes[FULL_RE, j] * imaginary + modes[FULL_IM, j] * real)


@_compiled(cache=True, fastmath=_FAST, error_model="numpy")
def _power(drive: Any, loads: Any, forces: Any, time: float, factors: Any) -> float:
    """Power of the driving forces, watts; loads is (n_forces, rows), forces (2, n_forces) real and imaginary."""
    angle = drive[FREQUENCY] * (drive[ORIGIN] + time)
    c, s = np.cos(angle), np.sin(angle)
    part, grown = time / drive[RAMP], 0.0
    for d in range(len(drive) - 1, GROWTH - 1, -1):
        grown = grown * part + drive[d]
    total = 0.0
    for f in range(loads.shape[0]):
        speed = 0.0
        for j in range(loads.shape[1]):
            speed += loads[f, j] * factors[MOVING, j]
        total += grown * (forces[0, f] * c - forces[1, f] * s) * speed
    return total


@_compiled(cache=True, fastmath=_FAST)
def _loss(modes: Any, answers: Any, factors: Any) -> float:
    """Power lost in the modes, watts; answers is (n, drive rows), the forced part of every mode."""
    total, n = 0.0, modes.shape[1]
    for j in range(n):
        rate = factors[MOVING, j]
        for d in range(answers.shape[1]):
            rate += answers[j, d] * factors[MOVING, n + d]
        total += 2.0 * modes[SIGMA, j] * rate * rate
    return total


@_compiled(cache=True, fastmath=_FAST)
def _given_way(modes: Any, acts: int) -> float:
    """How far the free modes have moved the surface along a force's levers, metres."""
    total = 0.0
    for j in range(modes.shape[1]):
        total += modes[acts, j] * modes[Z_RE, j]
    return total


@_compiled(cache=True, error_model="numpy")
def _carried(local: Any, edges: Any, piece: int, at: float, slope: float, half: float) -> float:
    """How far the whole motion moves the surface in a step, at `at` along a tangent of this slope, metres."""
    value, first = 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):
        first = first * at + value
        value = value * at + local[STILL, d] - local[BEFORE, d]
    return float((slope * value - half * first / (edges[piece + 1] - edges[piece])) / np.sqrt(1.0 + slope * slope))


@_compiled(cache=True)
def _climbed(local: Any, at: float) -> float:
    """How far the whole motion lifts the surface in a step, at `at`, metres."""
    value = 0.0
    for d in range(local.shape[1] - 1, -1, -1):
        value = value * at + local[STILL, d] - local[BEFORE, d]
    return float(value)


@_compiled(cache=True, inline="always")
def _friction(r: float, law: Any) -> float:
    """Friction per mass at relative speed r where it does not depend on sticking."""
    if law[KIND] == TANH:
        return float(-law[KINETIC] * np.tanh(law[SLOPE] * r))
    return float(-law[KINETIC] * np.sign(r))


@_compiled(cache=True, error_model="numpy", inline="always")
def _slip(
    v: float, stuck: bool, push: float, half: float, full: float, law: Any, dt: float, seen: Any, slip: Any
) -> float:
    """Speed change by friction in one step under a contact force `push` on the beam; fills `slip`.

    For tanh the speed of the surface is replaced by its least-squares line, which keeps both moments: order 4
    where friction is smooth, exact where it is steep. Coulomb's law follows the parabola, with sticking and
    slipping located on it.
    """
    s0 = seen[0, SURFACE]
    sm = seen[1, SURFACE] - slip[GIVEN_MIDDLE] + push * half
    s1 = seen[2, SURFACE] - slip[GIVEN_END] + push * full
    slip[STICKING], slip[N_EVENTS] = 0.0, 0.0
    if law[KIND] == TANH:
        mean, rise = (s0 + 4.0 * sm + s1) / 6.0, s1 - s0
        slip[CHANGE] = tanh_speed_change(v - mean + 0.5 * rise, rise / dt, law[KINETIC], law[SLOPE], dt)
        return float(slip[CHANGE])
    a0, a1 = (4.0 * sm - 3.0 * s0 - s1) / dt, (3.0 * s1 - 4.0 * sm + s0) / dt
    r, used = 0.0 if stuck else v - s0, 0.0
    if abs(r) <= 1e-9 * law[KINETIC] * dt and abs(a0) <= law[STATIC]:
        r, stuck = 0.0, True  # put on a surface at rest, to rounding
    for _ in range(SPANS):
        span, r, stuck, event = coulomb_span(
            r, a0 + (a1 - a0) * used / dt, a1, law[KINETIC], law[STATIC], dt - used, stuck
        )
        used += span
        if event in (STICKS, SLIPS):
            here = FIRST_EVENT + 2 * int(slip[N_EVENTS])
            slip[here], slip[here + 1] = used, event
            slip[N_EVENTS] += 1.0
        if used >= dt or (span <= 0.0 and event == 0.0):
            break
    slip[CHANGE], slip[STICKING] = r + s1 - v, 1.0 if stuck else 0.0
    return float(slip[CHANGE])


@_compiled(cache=True, error_model="numpy")
def _balance(v: float, stuck: bool, half: float, full: float, law: Any, dt: float, seen: Any, slip: Any) -> float:
    """The contact force, newton, mean over the step, at which slider and beam agree: regula falsi (Illinois).

    The slider's impulse falls as the beam gives way, so there is one root between the limits of friction.
    """
    per = law[MASS] / dt
    high = 1.000001 * law[MASS] * max(law[KINETIC], law[STATIC])
    low = -high
    at_low = per * _slip(v, stuck, -low, half, full, law, dt, seen, slip) - low
    at_high = per * _slip(v, stuck, -high, half, full, law, dt, seen, slip) - high
    force = per * _slip(v, stuck, 0.0, half, full, law, dt, seen, slip)
    for _ in range(60):
        force = min(max(force, low), high)
        miss = per * _slip(v, stuck, -force, half, full, law, dt, seen, slip) - force
        if abs(miss) <= 1e-14 * (high - low) or abs(miss) <= 1e-15 * abs(force):
            break
        if miss > 0.0:
            low, at_low, at_high = force, miss, 0.5 * at_high
        else:
            high, at_high, at_low = force, miss, 0.5 * at_low
        force = (low * at_high - high * at_low) / (at_high - at_low)
    return float(force)


@_compiled(cache=True, inline="always")
def _see(
    row: int,
    time: float,
    x: float,
    speed: float,
    piece: int,
    modes: Any,
    drive: Any,
    table: Any,
    edges: Any,
    law: Any,
    loads: Any,
    forces: Any,
    answers: Any,
    accounts: bool,
    factors: Any,
    local: Any,
    seen: Any,
    fresh: bool,
) -> None:
    """Fill one row of `seen`: the surface at x and, with accounts, the powers of drive and damping."""
    if fresh:
        _set_factors(time, modes, drive, factors)
        _set_local(table, piece, factors, local)
    _touch(local, edges, piece, x, speed, law, seen, row)
    if accounts:
        seen[row, POWER] = _power(drive, loads, forces, time, factors)
        seen[row, LOSS] = _loss(modes, answers, factors)


@_compiled(cache=True)
def _held(dt: float, modes: Any, motion: Any, law: Any, seen: Any) -> Any:
    """The normal reaction, mean over a step, that keeps a slider with inertia on the surface.

    (N without a tangential force on the beam, what each newton of that adds.)
    Beam and slider move exactly under one constant force and meet at the end of the step. With fixed levers their
    energy is conserved, so that no step is unstable. Height and climb are the slider's own: what the point under it
    does along x (w' dx/dt and all convective terms) is in the height of the surface where it ends up.
    """
    stiff = 2.0 * law[MASS] / (dt * dt)
    own = 1.0 + stiff * _compliance(modes, LIFT)
    free = law[LOAD] + stiff * (seen[2, LEVEL] - motion[HEIGHT] - dt * motion[CLIMB])
    return free / own, stiff * _compliance(modes, LEVER) / own


@_compiled(cache=True)
def _push_back(
    v: float,
    stuck: bool,
    dt: float,
    at: float,
    slope: float,
    piece: int,
    modes: Any,
    edges: Any,
    local: Any,
    motion: Any,
    law: Any,
    seen: Any,
    slip: Any,
) -> Any:
    """Let slider and beam agree on the contact forces of a step and give them to the modes; their work on the beam.

    (Of friction, of the normal reaction), joules. The levers are those of mid-step, so that the forces are off by the
    square of the step.
    """
    half, full = _mobility(modes, LEVER, HALF_IM), _mobility(modes, LEVER, FULL_IM)
    normal, per_push = 0.0, 0.0
    if law[HELD] > 0.0:
        normal, per_push = _held(dt, modes, motion, law, seen)
        across_half, across = _mobility(modes, LIFT, HALF_IM), _mobility(modes, LIFT, FULL_IM)
        seen[1, SURFACE] -= normal * across_half
        seen[2, SURFACE] -= normal * across
        half, full = half - per_push * across_half, full - per_push * across
    force = _balance(v, stuck, half, full, law, dt, seen, slip)
    way, climb = _carried(local, edges, piece, at, slope, law[HALF]) - _given_way(modes, LEVER), 0.0
    if law[HELD] > 0.0:
        normal -= per_push * force
        climb = _climbed(local, at) - _given_way(modes, LIFT)
        _press(-normal, LIFT, modes)
        gained = dt * (normal - law[LOAD]) / law[MASS]
        motion[HEIGHT] += dt * (motion[CLIMB] + 0.5 * gained)
        motion[CLIMB] += gained
        motion[NORMAL] = normal
    _press(-force, LEVER, modes)
    seen[2, SURFACE] -= force * full
    lifted = -normal * (climb + _given_way(modes, LIFT)) if law[HELD] > 0.0 else 0.0
    return -force * (way + _given_way(modes, LEVER)), lifted


@_compiled(cache=True, inline="always")
def _feel(dt: float, motion: Any, law: Any, seen: Any) -> None:
    """The slider's normal reaction and how fast the surface falls away under it, where it does not push back."""
    lift = 4.0 * (seen[0, LEVEL] - 2.0 * seen[1, LEVEL] + seen[2, LEVEL]) / (dt * dt)
    motion[NORMAL] = law[LOAD] + (law[MASS] * lift if law[HELD] > 0.0 else 0.0)
    motion[FALL] = max(motion[FALL], -lift)


@_compiled(cache=True)
def _correct_pull(
    dt: float, x: float, speed: float, piece: int, edges: Any, local: Any, law: Any, seen: Any, slip: Any
) -> None:
    """Inertia and drift along the surface at the end of a step with what the contact has added, half at mid-step."""
    surface, pull, drift = seen[2, SURFACE], seen[2, PULL], seen[2, DRIFT]
    _touch(local, edges, piece, x, speed, law, seen, 2)
    seen[2, SURFACE] = surface
    seen[1, DRIFT] += 0.5 * (seen[2, DRIFT] - drift)
    slip[GIVEN_END] += 0.5 * dt * (seen[2, PULL] - pull)


@_compiled(cache=True)
def _correct_powers(
    time: float, modes: Any, drive: Any, loads: Any, forces: Any, answers: Any, factors: Any, seen: Any
) -> None:
    """Powers at the end of a step with what the contact has added to the speeds since its start, half at mid-step."""
    power, loss = _power(drive, loads, forces, time, factors), _loss(modes, answers, factors)
    seen[1, POWER] += 0.5 * (power - seen[2, POWER])
    seen[1, LOSS] += 0.5 * (loss - seen[2, LOSS])
    seen[2, POWER], seen[2, LOSS] = power, loss


@_compiled(cache=True, inline="always")
def _account(
    v: float, v1: float, moved: float, pressed: float, two_way: bool, dt: float, law: Any, seen: Any, ledger: Any
) -> None:
    """Add one step to the ledger. `pressed` is the work of friction on the beam (two-way)."""
    ledger[DRIVEN] += dt * (seen[0, POWER] + 4.0 * seen[1, POWER] + seen[2, POWER]) / 6.0
    ledger[DAMPED] += dt * (seen[0, LOSS] + 4.0 * seen[1, LOSS] + seen[2, LOSS]) / 6.0
    on_slider = 0.5 * law[MASS] * (v1 * v1 - v * v)
    if not two_way:  # the integral of friction times the surface's line, by parts
        mean = (seen[0, SURFACE] + 4.0 * seen[1, SURFACE] + seen[2, SURFACE]) / 6.0
        rise = seen[2, SURFACE] - seen[0, SURFACE]
        pressed = -law[MASS] * (v1 * (mean + 0.5 * rise) - v * (mean - 0.5 * rise) - rise / dt * moved)
    ledger[ON_BEAM] += pressed
    ledger[ON_SLIDER] += on_slider
    ledger[RUBBED] -= on_slider + pressed


@_compiled(cache=True)
def _give(dt: float, seen: Any, slip: Any) -> None:
    """What everything but friction adds to the speed by the middle and the end of a step."""
    slip[GIVEN_MIDDLE] = dt * (5.0 * seen[0, PULL] + 8.0 * seen[1, PULL] - seen[2, PULL]) / 24.0
    slip[GIVEN_END] = dt * (seen[0, PULL] + 4.0 * seen[1, PULL] + seen[2, PULL]) / 6.0


@_compiled(cache=True)
def _advance(dt: float, rate: float, motion: Any, law: Any, seen: Any, slip: Any) -> float:
    """Move the slider to the end of a step; the distance that its own speed made. `rate` was its acceleration."""
    v = motion[V]
    v1 = v + slip[GIVEN_END] + slip[CHANGE]
    if slip[STICKING] > 0.0:
        v1, rate1 = seen[2, SURFACE], rate
    else:
        rate1 = seen[2, PULL] + _friction(v1 - seen[2, SURFACE], law)
    moved = 0.5 * dt * (v + v1) + dt * dt * (rate - rate1) / 12.0
    motion[X] += moved + dt * (seen[0, DRIFT] + 4.0 * seen[1, DRIFT] + seen[2, DRIFT]) / 6.0
    motion[V], motion[STUCK] = v1, slip[STICKING]
    return float(moved)


@_compiled(cache=True, error_model="numpy", inline="always")
def _step(
    number: int,
    dt: float,
    piece: int,
    fresh: bool,
    modes: Any,
    drive: Any,
    table: Any,
    edges: Any,
    motion: Any,
    law: Any,
    two_way: bool,
    loads: Any,
    forces: Any,
    answers: Any,
    accounts: bool,
    ledger: Any,
    factors: Any,
    local: Any,
    seen: Any,
    slip: Any,
) -> None:
    """One step of beam and slider."""
    x, v, stuck = motion[X], motion[V], motion[STUCK] > 0.0
    _see(
        0,
        number * dt,
        x,
        v,
        piece,
        modes,
        drive,
        table,
        edges,
        law,
        loads,
        forces,
        answers,
        accounts,
        factors,
        local,
        seen,
        fresh,
    )
    rate = seen[0, PULL] + (0.0 if stuck else _friction(v - seen[0, SURFACE], law))
    along = v + seen[0, DRIFT]
    at, slope, pressed, lifted, x1, v1 = 0.0, 0.0, 0.0, 0.0, x, v
    held = two_way and law[HELD] > 0.0
    if two_way:
        for d in range(local.shape[1]):
            local[BEFORE, d] = local[STILL, d]
    for row in range(1, 3):
        _rotate_half(modes)
        t = 0.5 * row * dt
        x1, v1 = x + t * along + 0.5 * t * t * rate, v + t * rate
        _see(
            row,
            (number + 0.5 * row) * dt,
            x1,
            v1,
            piece,
            modes,
            drive,
            table,
            edges,
            law,
            loads,
            forces,
            answers,
            accounts,
            factors,
            local,
            seen,
            True,
        )
        if two_way and row == 1:
            at, slope = _set_levers(table, piece, edges, local, x1, law[HALF], modes)
    _give(dt, seen, slip)
    if not held:
        _feel(dt, motion, law, seen)
    if two_way:
        if held:
            _set_reads(table, piece, edges, local, x1, law[HALF], modes)
        pressed, lifted = _push_back(v, stuck, dt, at, slope, piece, modes, edges, local, motion, law, seen, slip)
        if held:
            motion[FALL] = max(motion[FALL], (law[LOAD] - motion[NORMAL]) / law[MASS])
        _set_factors((number + 1) * dt, modes, drive, factors)
        if accounts:
            _correct_powers((number + 1) * dt, modes, drive, loads, forces, answers, factors, seen)
        if law[FOLLOWING] > 0.0:
            _set_local(table, piece, factors, local)
            _correct_pull(dt, x1, v1, piece, edges, local, law, seen, slip)
    else:
        _slip(v, stuck, 0.0, 0.0, 0.0, law, dt, seen, slip)
    moved = _advance(dt, rate, motion, law, seen, slip)
    if accounts:
        _account(v, motion[V], moved, pressed, two_way, dt, law, seen, ledger)
        ledger[LIFTED] += lifted


@_compiled(cache=True)
def slide(
    n_steps: int,
    dt: float,
    modes: Any,
    drive: Any,
    table: Any,
    edges: Any,
    motion: Any,
    law: Any,
    two_way: bool,
    loads: Any,
    forces: Any,
    answers: Any,
    accounts: bool,
    ledger: Any,
    every: int,
    kept: Any,
    points: Any,
    deflections: Any,
    events: Any,
    tally: Any,
    factors: Any,
    local: Any,
    seen: Any,
    slip: Any,
) -> int:
    """Advance beam and slider by up to n_steps from step number tally[STEP]; why it came back.

    Time is the step's number times dt. `modes`, `motion`, `ledger` and `tally` are advanced in place, together, so
    that they agree whenever the caller is interrupted. `kept` is (capacity, 5), filled every `every` steps together
    with the deflections at `points` (n_points, rows); `events` is (capacity, 3): time, kind, x at the end of the step.
    """
    piece, fresh = 0, True
    for _ in range(n_steps):
        here = find_piece(edges, motion[X], max(piece, 0))
        if here < 0:
            return OFF_PIECES
        fresh = fresh or here != piece or two_way
        piece, number = here, tally[STEP]
        _step(
            number,
            dt,
            piece,
            fresh,
            modes,
            drive,
            table,
            edges,
            motion,
            law,
            two_way,
            loads,
            forces,
            answers,
            accounts,
            ledger,
            factors,
            local,
            seen,
            slip,
        )
        fresh = False
        tally[STEP] += 1
        if not np.isfinite(motion[V] + factors[STILL, 0]):
            return NOT_FINITE
        if slip[N_EVENTS] > 0.0:
            _note_events(drive[ORIGIN] + number * dt, motion[X], slip, events, tally)
        if tally[STEP] % every == 0:
            _keep(motion, law, slip[CHANGE] / dt, seen, factors, points, kept, deflections, tally[SAMPLES])
            tally[SAMPLES] += 1
    return DONE


@_compiled(cache=True)
def _note_events(time: float, x: float, slip: Any, events: Any, tally: Any) -> None:
    """Write down all events of a step, as long as there is room; all of them are counted."""
    for i in range(int(slip[N_EVENTS])):
        row, here = tally[EVENTS], FIRST_EVENT + 2 * i
        if row < len(events):
            events[row, 0], events[row, 1], events[row, 2] = time + slip[here], slip[here + 1], x
        tally[EVENTS] += 1


@_compiled(cache=True)
def _keep(
    motion: Any,
    law: Any,
    mean_friction: float,
    seen: Any,
    factors: Any,
    points: Any,
    kept: Any,
    deflections: Any,
    row: int,
) -> None:
    """Write one sample."""
    surface = seen[2, SURFACE]
    kept[row, KEPT_X], kept[row, KEPT_V], kept[row, KEPT_SURFACE] = motion[X], motion[V], surface
    kept[row, KEPT_NORMAL] = motion[NORMAL]
    kept[row, KEPT_FRICTION] = mean_friction if motion[STUCK] > 0.0 else _friction(motion[V] - surface, law)
    for p in range(points.shape[0]):
        total = 0.0
        for j in range(points.shape[1]):
            total += points[p, j] * factors[STILL, j]
        deflections[row, p] = total


@_compiled(cache=True)
def slide_given(
    n_steps: int, dt: float, local: Any, along: Any, edges: Any, motion: Any, law: Any, kept: Any, seen: Any, slip: Any
) -> int:
    """The same steps on a surface that is given at every half step, one way; how many were done on its piece.

    `local` is (2 n + 1, 2, degree + 1), `along` (2 n + 1,) a speed of the whole surface along x, `edges` (2,).
    """
    for number in range(n_steps + 1):
        x, v, stuck = motion[X], motion[V], motion[STUCK] > 0.0
        if x < edges[0] or x > edges[1]:
            return max(number - 1, 0)
        _touch(local[2 * number], edges, 0, x, v, law, seen, 0)
        seen[0, SURFACE] += along[2 * number]
        rate = seen[0, PULL] + (0.0 if stuck else _friction(v - seen[0, SURFACE], law))
        kept[number, KEPT_X], kept[number, KEPT_V], kept[number, KEPT_SURFACE] = x, v, seen[0, SURFACE]
        kept[number, KEPT_FRICTION] = slip[CHANGE] / dt if stuck else rate - seen[0, PULL]
        if number == n_steps:
            break
        ahead = v + seen[0, DRIFT]
        for row in range(1, 3):
            t = 0.5 * row * dt
            _touch(local[2 * number + row], edges, 0, x + t * ahead + 0.5 * t * t * rate, v + t * rate, law, seen, row)
            seen[row, SURFACE] += along[2 * number + row]
        _give(dt, seen, slip)
        _slip(v, stuck, 0.0, 0.0, 0.0, law, dt, seen, slip)
        _advance(dt, rate, motion, law, seen, slip)
    return n_steps


@_compiled(cache=True)
def look(
    modes: Any, drive: Any, table: Any, edges: Any, motion: Any, law: Any, factors: Any, local: Any, seen: Any
) -> Any:
    """(speed of the surface under the slider, friction per mass) at time 0; sets the slider's height and climb."""
    piece = max(find_piece(edges, motion[X], 0), 0)
    _set_factors(0.0, modes, drive, factors)
    _set_local(table, piece, factors, local)
    _touch(local, edges, piece, motion[X], motion[V], law, seen, 0)
    speed = seen[0, SURFACE]
    motion[HEIGHT], motion[NORMAL] = seen[0, LEVEL], law[LOAD]
    motion[CLIMB] = _climb(local, edges, piece, motion[X], motion[V] + seen[0, DRIFT], law[HALF])
    return speed, 0.0 if motion[STUCK] > 0.0 else _friction(motion[V] - speed, law)


@_compiled(cache=True, error_model="numpy")
def _climb(local: Any, edges: Any, piece: int, x: float, along: float, half: float) -> float:
    """Speed across the beam of a point on the surface over x that moves along x: dw/dt + w' dX/dt at its material."""
    length = edges[piece + 1] - edges[piece]
    at = _material(local, edges, piece, x, half)
    value, slope, bend, rise, turn = 0.0, 0.0, 0.0, 0.0, 0.0
    for d in range(local.shape[1] - 1, -1, -1):
        bend = bend * at + slope
        slope = slope * at + value
        value = value * at + local[STILL, d]
        turn = turn * at + rise
        rise = rise * at + local[MOVING, d]
    bend = 2.0 * bend / (length * length)
    return float(rise + slope / length * (along + half * (turn / length + bend * along)))
