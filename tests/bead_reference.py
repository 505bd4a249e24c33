"""A bead on a moving curve by other means: a Lagrangian of one coordinate, integrated by scipy's DOP853.

Nothing of the suite: the beam's modes are sines and its motion from rest is written down, a chain's curve is drawn anew
through its joints; the bead's equation is Lagrange's for T = m (x'^2 + y'^2) / 2, with the friction of Eq. (3).
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline


class PinnedBeam:
    """Undamped, from rest, under forces F cos(omega t + phase) that act at once; the first `n` sines."""

    def __init__(self, length, width, thickness, modulus, density, forces, frequency, n=160):
        """`forces` are (position, amplitude, phase in radians)."""
        order = np.arange(1, n + 1) * np.pi / length
        mass = density * width * thickness
        self.half, self.orders = 0.5 * thickness, order
        self.unit = np.sqrt(2.0 / (mass * length))
        self.own = order**2 * np.sqrt(modulus * width * thickness**3 / (12.0 * mass))
        self.omega, self.forces = 2.0 * np.pi * frequency, forces
        self.parts = [
            (self.unit * np.sin(order * x) * f / (self.own**2 - self.omega**2), phase) for x, f, phase in forces
        ]

    def motion(self, t):
        """Every mode's q and dq/dt: the forced part, and the free one that makes both vanish at t = 0."""
        q, rate = np.zeros_like(self.own), np.zeros_like(self.own)
        c, s = np.cos(self.own * t), np.sin(self.own * t)
        for part, phase in self.parts:
            now = self.omega * t + phase
            q += part * (np.cos(now) - np.cos(phase) * c + np.sin(phase) * self.omega / self.own * s)
            rate += part * (-self.omega * np.sin(now) + np.cos(phase) * self.own * s + np.sin(phase) * self.omega * c)
        return q, rate

    def seen(self, t, x):
        """w_x, w_xx, w_t, w_xt at a place, and the speed of the curve along x, which a linear beam has none of."""
        q, rate = self.motion(t)
        k, turn = self.orders, self.orders * x
        sine, cosine = self.unit * np.sin(turn), self.unit * k * np.cos(turn)
        return q @ cosine, -q @ (k**2 * sine), rate @ sine, rate @ cosine, 0.0


class ChainCurve:
    """A moved chain near one place: its joints' heights by differences, its shortening by the sines of its angles.

    `angles` and `rates` (n, N) are relative; a bead stays within micrometres of `x0`, so that the curve is a cubic there.
    """

    def __init__(self, times, angles, rates, link, x0, thickness):
        theta, spin = np.cumsum(angles, axis=1), np.cumsum(rates, axis=1)
        self.half, self.x0 = 0.5 * thickness, x0
        still = np.zeros((len(times), 1))
        heights = np.hstack([still, np.cumsum(link * np.sin(theta), axis=1)])
        rises = np.hstack([still, np.cumsum(link * np.cos(theta) * spin, axis=1)])
        along = np.hstack([still, np.cumsum(-link * np.sin(theta) * spin, axis=1)])
        first = int(x0 / link) - 3
        near = slice(first, first + 8)
        powers = np.vander(link * np.arange(first, first + 8) - x0, 8, increasing=True)
        fit = np.linalg.inv(powers)[:4]  # the polynomial through eight joints
        columns = [self.corrected(joints)[:, near] @ fit.T for joints in (heights, rises)]
        speed = np.array([np.interp(x0, link * np.arange(row.size), row) for row in along])
        self.known = CubicSpline(times, np.hstack([*columns, speed[:, None]]))

    @staticmethod
    def corrected(joints):
        found = joints.copy()
        found[:, 1:-1] += np.diff(joints, 2, axis=1) / 12.0
        return found

    def seen(self, t, x):
        """w_x, w_xx, w_t, w_xt at a place, and the speed of the curve along x."""
        _, a, b, c, rise, d, e, f, along = self.known(t)
        s = x - self.x0
        return (
            a + 2 * b * s + 3 * c * s**2,
            2 * b + 6 * c * s,
            rise + d * s + e * s**2 + f * s**3,
            d + 2 * e * s + 3 * f * s**2,
            along,
        )


def mean_speed(curve, start, mu, slope, duration, gravity=9.81, max_step=2e-6):
    """(of the bead along x, m/s; of friction over mass, m/s^2), from rest, means over the duration.

    The curve x = xi + u(t), y = w(xi, t); p = dT/dxi' = x' + w_x y' per mass, dp/dt = y' (w_xt + w_xx xi') - g w_x + F s
    with s = sqrt(1 + w_x^2) and p = v s.
    """

    def rates(t, y):
        gone, p, _, _ = y
        wx, wxx, wt, wxt, along = curve.seen(t, start + gone)
        s = np.hypot(1.0, wx)
        pace = (p - along - wx * wt) / s**2
        surface = (along + wx * wt - curve.half * wxt) / s
        friction = -mu * gravity * np.tanh(slope * (p / s - surface))
        turning = (wt + wx * pace) * (wxt + wxx * pace) - gravity * wx + friction * s
        return [pace, turning, pace + along, friction]

    found = solve_ivp(rates, (0.0, duration), [0.0] * 4, method="DOP853", rtol=1e-9, atol=1e-13, max_step=max_step)
    return found.y[2, -1] / duration, found.y[3, -1] / duration
