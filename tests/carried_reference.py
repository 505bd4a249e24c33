"""What the gates of `instrument-arm`, `taut-strip` and `thick-bar` expect, by formulas and matrices of no model.

Bodies, springs, tension, a foundation and shear by textbook equations, written out for those three beams; chains as
free bodies with springs between, elements by polynomials that are tied together. Imports nothing of the suite.
"""

import numpy as np
from scipy.linalg import eigh, null_space
from scipy.optimize import brentq

GREGORY = np.array([3 / 8, 7 / 6, 23 / 24])


class Arm:
    """The tube: its clamp's springs, its gear box, its instrument."""

    L, A0, M0, M1, J1, K, KR = 0.8, 0.31, 0.15, 0.35, 4e-4, 2e5, 900.0
    OUT, IN = 0.025, 0.025 - 2 * 0.0015
    EI = 70e9 * np.pi * (OUT**4 - IN**4) / 64
    LINE = 2700 * np.pi * (OUT**2 - IN**2) / 4


class Strip:
    """The strip under tension on its bed."""

    L, T, KF = 0.6, 120.0, 3000.0
    EI, LINE = 200e9 * 0.015 * 0.0006**3 / 12, 7850 * 0.015 * 0.0006


class Bar:
    """The thick bar, with 5/6 of its section against shear."""

    L, NU, H, B, E, RHO = 0.3, 0.3, 0.025, 0.04, 210e9, 7850.0
    EI, LINE, ROTARY = E * B * H**3 / 12, RHO * B * H, RHO * B * H**3 / 12
    SHEAR = 5 / 6 * E / (2 * (1 + NU)) * B * H


def hertz(omega2):
    return float(np.sqrt(omega2) / (2 * np.pi))


def arm_conditions(beta):
    """Rows of what A cos + B sin + C cosh + D sinh of both spans must keep, scaled, (8, 8)."""
    omega2 = Arm.EI * beta**4 / Arm.LINE

    def span(x, derivative):
        c, s, grow, fall = np.cos(beta * x), np.sin(beta * x), np.exp(beta * (x - Arm.L)), np.exp(-beta * x)
        waves = ((c, s), (-s, c), (-c, -s), (s, -c))[derivative]
        return np.array([*waves, grow, (-1) ** derivative * fall]) * beta**derivative

    none, at, end = np.zeros(4), Arm.A0, Arm.L
    rows = [
        np.r_[Arm.EI * span(0, 3) + Arm.K * span(0, 0), none],
        np.r_[Arm.EI * span(0, 2) - Arm.KR * span(0, 1), none],
        *(np.r_[span(at, d), -span(at, d)] for d in (0, 1, 2)),
        np.r_[Arm.EI * span(at, 3) + Arm.M0 * omega2 * span(at, 0), -Arm.EI * span(at, 3)],
        np.r_[none, Arm.EI * span(end, 2) - Arm.J1 * omega2 * span(end, 1)],
        np.r_[none, Arm.EI * span(end, 3) + Arm.M1 * omega2 * span(end, 0)],
    ]
    return np.array([row / abs(row).max() for row in rows]), span


def nth(function, start, step, n):
    """The n-th root of a function of one variable, sought in steps."""
    low = start
    while True:
        if function(low) * function(low + step) < 0:
            n -= 1
            if n == 0:
                return float(brentq(function, low, low + step, xtol=1e-15, rtol=1e-15))
        low += step


def arm_beta(mode):
    return nth(lambda beta: np.linalg.det(arm_conditions(beta)[0]), 0.5, 0.05, mode)


def arm_hertz(mode):
    return hertz(Arm.EI * arm_beta(mode) ** 4 / Arm.LINE)


def arm_nodes(mode):
    """Where a mode of the arm stands still, metres."""
    beta = arm_beta(mode)
    conditions, span = arm_conditions(beta)
    parts = np.linalg.svd(conditions)[2][-1]

    def shape(x):
        return span(x, 0) @ (parts[:4] if x < Arm.A0 else parts[4:])

    x = np.linspace(0.001, Arm.L - 0.001, 801)
    values = [shape(one) for one in x]
    return [brentq(shape, x[i], x[i + 1]) for i in range(800) if values[i] * values[i + 1] < 0]


def arm_by_levers(mode, n):
    """The arm as n rigid links on which bodies and springs sit as they stand, Hz."""
    length, size = Arm.L / n, n + 1
    tilt = np.diff(np.eye(size), axis=0) / length
    middle = 0.5 * (np.eye(size)[1:] + np.eye(size)[:-1])
    bend, tip = np.diff(tilt, axis=0), np.eye(size)[-1]
    mass = Arm.LINE * length * (middle.T @ middle + length**2 / 12 * tilt.T @ tilt)
    link = int(Arm.A0 / length)
    box = middle[link] + (Arm.A0 - (link + 0.5) * length) * tilt[link]
    mass += Arm.M0 * np.outer(box, box) + Arm.M1 * np.outer(tip, tip) + Arm.J1 * np.outer(tilt[-1], tilt[-1])
    stiffness = Arm.EI / length * bend.T @ bend + Arm.KR * np.outer(tilt[0], tilt[0])
    stiffness[0, 0] += Arm.K
    return hertz(eigh(stiffness, mass, eigvals_only=True)[mode - 1])


def hermite(length):
    """K of bending, of a tension of 1 and M of an element by its textbook entries, EI = rho A = 1."""
    n = length
    bending = np.array(
        [[12, 6 * n, -12, 6 * n], [0, 4 * n**2, -6 * n, 2 * n**2], [0, 0, 12, -6 * n], [0, 0, 0, 4 * n**2]]
    )
    pulled = np.array(
        [[36, 3 * n, -36, 3 * n], [0, 4 * n**2, -3 * n, -(n**2)], [0, 0, 36, -3 * n], [0, 0, 0, 4 * n**2]]
    )
    mass = np.array(
        [[156, 22 * n, 54, -13 * n], [0, 4 * n**2, 13 * n, -3 * n**2], [0, 0, 156, -22 * n], [0, 0, 0, 4 * n**2]]
    )
    whole = [one + np.triu(one, 1).T for one in (bending, pulled, mass)]
    return whole[0] / n**3, whole[1] / (30 * n), whole[2] * n / 420


def arm_by_elements(mode, counts):
    """The arm on so many Hermite elements before and behind the gear box, Hz."""
    lengths = np.repeat([Arm.A0, Arm.L - Arm.A0], counts) / np.repeat(counts, counts)
    size = 2 * len(lengths) + 2
    stiffness, mass = np.zeros((size, size)), np.zeros((size, size))
    for i, length in enumerate(lengths):
        bending, _, inertia = hermite(length)
        at = slice(2 * i, 2 * i + 4)
        stiffness[at, at] += Arm.EI * bending
        mass[at, at] += Arm.LINE * inertia
    box = 2 * counts[0]
    mass[box, box] += Arm.M0
    mass[-2, -2] += Arm.M1
    mass[-1, -1] += Arm.J1
    stiffness[0, 0] += Arm.K
    stiffness[1, 1] += Arm.KR
    return hertz(eigh(stiffness, mass, eigvals_only=True)[mode - 1])


def strip_hertz(mode):
    """omega^2 = (EI b^4 + T b^2 + k_f) / rho A."""
    b = mode * np.pi / Strip.L
    return hertz((Strip.EI * b**4 + Strip.T * b**2 + Strip.KF) / Strip.LINE)


def strip_by_links(mode, n, eased=0.0):
    """Rigid links between joints of EI/l - eased T l, by their dispersion."""
    length, s2 = Strip.L / n, np.sin(mode * np.pi / (2 * n)) ** 2
    joint = Strip.EI - eased * Strip.T * length**2
    beam = (16 * s2**2 * joint / length**4 + 4 * s2 * Strip.T / length**2) / (1 - 2 * s2 / 3)
    return hertz((beam + Strip.KF) / Strip.LINE)


def strip_by_elements(mode, n):
    """Hermite elements by the two nodal equations of a sine."""
    length, turn = Strip.L / n, mode * np.pi / n
    bending, pulled, inertia = hermite(length)
    wave = np.array([np.exp(1j * turn * side) for side in (0, 1)])
    carry = np.vstack([np.eye(2) * wave[0], np.eye(2) * wave[1]])
    stiff, mass = (carry.conj().T @ m @ carry for m in (Strip.EI * bending + Strip.T * pulled, Strip.LINE * inertia))
    return hertz(eigh(stiff, mass, eigvals_only=True)[0] + Strip.KF / Strip.LINE)


def bar_equation(omega, rotary=Bar.ROTARY, shear=Bar.SHEAR):
    """Huang's for a clamped and a free end (J. Appl. Mech. 28, 1961, Eq. 19 c)."""
    b2 = Bar.LINE * omega**2 * Bar.L**4 / Bar.EI
    r2, s2 = rotary / (Bar.LINE * Bar.L**2), Bar.EI / (shear * Bar.L**2)
    b, root = np.sqrt(b2), np.sqrt((r2 - s2) ** 2 + 4 / b2)
    alpha, beta = np.sqrt((root - r2 - s2) / 2), np.sqrt((root + r2 + s2) / 2)
    both = np.cosh(b * alpha) * np.cos(b * beta), np.sinh(b * alpha) * np.sin(b * beta)
    return 2 + (b2 * (r2 - s2) ** 2 + 2) * both[0] - b * (r2 + s2) / np.sqrt(1 - b2 * r2 * s2) * both[1]


def bar_hertz(mode, rotary=Bar.ROTARY, shear=Bar.SHEAR):
    return nth(lambda omega: bar_equation(omega, rotary, shear), 100.0, 150.0, mode) / (2 * np.pi)


def bar_by_links(mode, n, shear=Bar.SHEAR, eased=False):
    """Links that move and turn freely, a spring against bending and one against slipping in every joint, Hz.

    Joints at the wall are 3/8, 7/6, 23/24 as soft as those inside. `eased`: a twelfth of the links' thickness inertia
    comes off where joints bend, the more the stiffer they are and 5/24 more at the wall, whose whole link's mass is
    behind its slip.
    """
    length, none = Bar.L / n, np.zeros((1, 2 * n))
    z, turn = np.vsplit(np.eye(2 * n), 2)
    bend = np.diff(np.vstack([none, turn]), axis=0)
    slip = z - length / 2 * turn
    slip[1:] -= (z + length / 2 * turn)[:-1]
    soft = np.ones(n)
    soft[:3] = GREGORY
    stiffness = (bend.T * (Bar.EI / length / soft)) @ bend + (slip.T * (shear / length / soft)) @ slip
    link = Bar.LINE * length
    mass = np.diag(np.repeat([link, link * length**2 / 12 + Bar.ROTARY * length], n))
    if eased:
        off, behind = 1 / soft, np.ones(n)
        off[0], behind[0] = (GREGORY[0] + 5 / 24) / GREGORY[0] ** 2, 2
        mass -= Bar.ROTARY * length / 12 * (bend.T * off) @ bend + link / 12 * (slip.T * behind) @ slip
    return hertz(eigh(stiffness, mass, eigvals_only=True)[mode - 1])


def bar_by_elements(mode, n):
    """A cubic w and a turn w' - g with g linear in every element, w and turn tied at the nodes, Hz."""
    length, size = Bar.L / n, 6 * n
    stiffness, mass, ties = np.zeros((size, size)), np.zeros((size, size)), []
    points, weights = np.polynomial.legendre.leggauss(4)

    def rows(i, xi):
        w, slope, bend, shear = np.zeros((4, size))
        at = 6 * i
        w[at : at + 4] = [1, xi, xi**2, xi**3]
        slope[at : at + 4] = np.array([0, 1, 2 * xi, 3 * xi**2]) / length
        bend[at : at + 4] = np.array([0, 0, 2, 6 * xi]) / length**2
        shear[at + 4 : at + 6] = [1, xi]
        bend[at + 5] -= 1 / length
        return w, slope - shear, bend, shear

    for i in range(n):
        for xi, weight in zip(0.5 + 0.5 * points, 0.5 * length * weights, strict=True):
            w, turn, bend, shear = rows(i, xi)
            stiffness += weight * (Bar.EI * np.outer(bend, bend) + Bar.SHEAR * np.outer(shear, shear))
            mass += weight * (Bar.LINE * np.outer(w, w) + Bar.ROTARY * np.outer(turn, turn))
        before = rows(i - 1, 1.0)[:2] if i else np.zeros((2, size))
        ties += [here - there for here, there in zip(rows(i, 0.0)[:2], before, strict=True)]
    basis = null_space(np.array(ties))
    return hertz(eigh(basis.T @ stiffness @ basis, basis.T @ mass @ basis, eigvals_only=True)[mode - 1])


def thin_bar_hertz(mode):
    """By cos y cosh y = -1."""
    y = nth(lambda y: np.cos(y) + 1 / np.cosh(y), 1.0, 0.5, mode)
    return hertz((y / Bar.L) ** 4 * Bar.EI / Bar.LINE)


def enough_links(frequency, exact, error):
    """The number of links from which on, up to twice as many, a frequency stays within a relative error."""
    found = 6
    for n in range(6, 200):
        if abs(frequency(n) / exact - 1) > error:
            found = n + 1
        elif n > 2 * found:
            break
    return found
