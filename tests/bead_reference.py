"""A bead on the surface of a driven pinned beam by other means: a Lagrangian of one coordinate, scipy's DOP853.

Nothing of the suite: the beam's modes are sines, its motion from rest is written down, the bead's equation is that of
Lagrange for T = m (x'^2 + y'^2) / 2 on y = w(x, t), with the friction of Eq. (3) as its generalised force.
"""

import numpy as np
from scipy.integrate import solve_ivp


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
        """w_x, w_xx, w_t, w_xt at a place."""
        q, rate = self.motion(t)
        k, turn = self.orders, self.orders * x
        sine, cosine = self.unit * np.sin(turn), self.unit * k * np.cos(turn)
        return q @ cosine, -q @ (k**2 * sine), rate @ sine, rate @ cosine


def mean_speed(beam, start, mu, slope, duration, gravity=9.81, max_step=2e-6):
    """Of the bead along x, m/s: x(duration) - start over the duration, from rest along the tangent.

    p = dT/dx' = x' + w_x y' per mass; dp/dt = y' (w_xt + w_xx x') - g w_x + F s, with s = sqrt(1 + w_x^2) and p = v s.
    """

    def rates(t, y):
        gone, p = y
        wx, wxx, wt, wxt = beam.seen(t, start + gone)
        s = np.hypot(1.0, wx)
        pace = (p - wx * wt) / s**2
        surface = (wx * wt - beam.half * wxt) / s
        friction = -mu * gravity * np.tanh(slope * (p / s - surface))
        return [pace, (wt + wx * pace) * (wxt + wxx * pace) - gravity * wx + friction * s]

    found = solve_ivp(rates, (0.0, duration), [0.0, 0.0], method="DOP853", rtol=1e-9, atol=1e-13, max_step=max_step)
    return found.y[0, -1] / duration
