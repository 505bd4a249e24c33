"""Exact values of the sheets of cases, from closed forms and from scipy: nothing of the package."""

from math import pi, sqrt

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc, jn_zeros


def cantilever_hz(length, stiffness, mass_per_length, compliance=0.0):
    """Frequencies 1 to 3 of a cantilever on a clamp of a compliance over L/EI."""

    def off(y):
        return np.cos(y) + 1.0 / np.cosh(y) + compliance * y * (np.cos(y) * np.tanh(y) - np.sin(y))

    roots = [brentq(off, a, a + 1.0, xtol=1e-14) for a in (1.5, 4.4, 7.4)]
    return [y**2 / (2.0 * pi * length**2) * sqrt(stiffness / mass_per_length) for y in roots]


def elastica(load):
    """(deflection, coordinate of the tip along the straight beam) over L at P L^2/EI = load, by elliptic integrals."""

    def phi(m):
        return np.arcsin(1.0 / sqrt(2.0 * m))

    m = brentq(lambda m: ellipk(m) - ellipkinc(phi(m), m) - sqrt(load), 0.5 + 1e-12, 1.0 - 1e-12, xtol=1e-15)
    deflection = 1.0 - 2.0 / sqrt(load) * (ellipe(m) - ellipeinc(phi(m), m))
    return deflection, sqrt(2.0 * (2.0 * m - 1.0) / load)


def bent(load, compliance=0.0, follower=False):
    """`elastica` on a clamp of a compliance over L/EI, or under a force that turns with the tip, from tip to clamp."""

    def shot(tip):
        angle = 0.5 * pi + (tip if follower else 0.0)
        rates = lambda s, y: (y[1], -load * np.sin(angle - y[0]), np.cos(y[0]), np.sin(y[0]))  # noqa: E731
        return solve_ivp(rates, (1.0, 0.0), (tip, 0.0, 0.0, 0.0), rtol=1e-12, atol=1e-14, method="DOP853").y[:, -1]

    def off(tip):
        angle, curvature, _, _ = shot(tip)
        return angle - compliance * curvature

    _, _, x, z = shot(brentq(off, 0.0, 9.0 if follower else 0.5 * pi, xtol=1e-14))
    return -z, -x


def hanging_hz(length, gravity):
    """Frequencies 1 to 5 of a hanging chain."""
    return jn_zeros(0, 5) / 2.0 * sqrt(gravity / length) / (2.0 * pi)


def irvine(squared):
    """Circular frequency times L sqrt(m/H) of the lowest symmetric mode at lambda^2; at 4 pi^2 it is 2 pi."""
    off = lambda x: np.sin(x) - (x - 4.0 * x**3 / squared) * np.cos(x)  # noqa: E731
    return 2.0 * brentq(off, 0.5 * pi + 1e-9, 1.5 * pi - 1e-9, xtol=1e-14)


def standing_hz(length, stiffness, mass_per_length, gravity, compliance=0.0):
    """Frequencies 1 and 2 of a clamped column under its weight: Ritz with Legendre polynomials times x^2.

    A small compliance of the clamp, over L/EI, takes the square of the moment there from the squares.
    """
    x, weights = np.polynomial.legendre.leggauss(60)
    s, weights = 0.5 * (x + 1.0), 0.5 * weights
    forms = [
        np.polynomial.Polynomial([0, 0, 1])
        * np.polynomial.Legendre.basis(k, [0, 1]).convert(kind=np.polynomial.Polynomial)
        for k in range(12)
    ]
    shape, slope, bend = (np.array([form.deriv(d)(s) if d else form(s) for form in forms]) for d in (0, 1, 2))
    weight = mass_per_length * gravity * length**3 / stiffness
    inner = bend * weights @ bend.T - weight * (slope * weights * (1.0 - s)) @ slope.T
    squares, mixes = eigh(inner, shape * weights @ shape.T, subset_by_index=(0, 1))
    moments = np.array([form.deriv(2)(0.0) for form in forms]) @ mixes
    return np.sqrt(squares - compliance * moments**2) / (2.0 * pi) * sqrt(stiffness / mass_per_length) / length**2


def ring_hz(radius, stiffness, mass_per_length):
    """Frequencies of a free ring in its plane with 4, 6, 8 nodes."""
    return [
        sqrt(n**2 * (n**2 - 1) ** 2 / (n**2 + 1) * stiffness / mass_per_length) / (2.0 * pi * radius**2)
        for n in (2, 3, 4)
    ]


def spun_up(rate, duration, length, stiffness, mass_per_length, compliance=0.0, modes=5):
    """Largest lag of the tip, m, of an inextensible cantilever on the hub, to second order in its deflection.

    Assumed modes v = sum q_i phi_i: centrifugal force of the foreshortened beam; the error is of fourth order. A clamp
    of a compliance over L/EI adds the rotation of the straight beam.
    """
    roots = [brentq(lambda y: np.cos(y) + 1.0 / np.cosh(y), a, a + 1.2) for a in (1.5, 4.2, 7.3, 10.5, 13.6)][:modes]
    s, weights = np.polynomial.legendre.leggauss(120)
    s, weights = 0.5 * (s + 1.0), 0.5 * weights
    phi, slope = [], []
    for y in roots:
        ratio = (np.cosh(y) + np.cos(y)) / (np.sinh(y) + np.sin(y))
        phi.append(np.cosh(y * s) - np.cos(y * s) - ratio * (np.sinh(y * s) - np.sin(y * s)))
        slope.append(y * (np.sinh(y * s) + np.sin(y * s) - ratio * (np.cosh(y * s) - np.cos(y * s))))
    turns = compliance > 0.0
    phi, slope = np.array([*phi, *[s] * turns]), np.array([*slope, *[np.ones_like(s)] * turns])
    inertia = phi * weights @ phi.T
    centrifugal = slope * weights * 0.5 * (1.0 - s**2) @ slope.T
    springs = [
        *(y**4 * one for y, one in zip(roots, inertia.diagonal(), strict=False)),
        *([1.0 / compliance] if turns else []),
    ]
    bending = np.diag(springs)
    bending *= stiffness / (mass_per_length * length**4)
    arm = phi @ (weights * s) * length
    tip = np.array([*(2.0 * (-1.0) ** k for k in range(len(roots))), *[1.0] * turns])

    def rates(t, state):
        q, speed = np.split(state, 2)
        w = 2.0 * pi * t / duration
        spin, turn = rate / duration * (t - np.sin(w) * duration / (2.0 * pi)), rate / duration * (1.0 - np.cos(w))
        force = -turn * arm - (bending + spin**2 * (centrifugal - inertia)) @ q
        return np.concatenate([speed, np.linalg.solve(inertia, force)])

    times = np.linspace(6.0, 7.5, 1501)
    run = solve_ivp(rates, (0.0, 7.5), np.zeros(2 * len(tip)), t_eval=times, rtol=1e-9, atol=1e-12, method="LSODA")
    return float((tip @ run.y[: len(tip)]).min())
