"""The nonlinear chain written out a second time: dense matrices over absolute angles, closed by multipliers.

Nothing here comes from the compiled chain but the numbers that describe it. Links are straight bars with their mass
at the middle and their rotary inertia; x along the straight chain, y across.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc


def hub(system, t):
    r = system.rotation
    w = 2 * np.pi * r.frequency_hz
    phase = w * t + np.deg2rad(r.phase_deg)
    swing = r.amplitude * np.sin(phase)
    return r.offset + r.rate * t + swing, r.rate + r.amplitude * w * np.cos(phase), -(w**2) * swing


def reach_of(system, link, at):
    """How far a point lies from each joint before it, along the links: its y is reach @ sin(theta)."""
    reach = np.zeros(system.n_links)
    reach[: link - 1] = system.lengths[: link - 1]
    reach[link - 1] = at
    return reach


def held(system, t):
    """(reach, y'' wanted) of roller and actuators."""
    rows = [(reach_of(system, system.n_links, system.lengths[-1]), 0.0)] if system.tip == "roller" else []
    for a in system.actuators:
        w = 2 * np.pi * a.frequency_hz
        rows.append((reach_of(system, a.link, a.at), -a.amplitude * w**2 * np.cos(w * t + np.deg2rad(a.phase_deg))))
    return rows


def equations(system, t, angles, rates):
    """Mass matrix, generalised forces less the inertia of the present rates, constraint rows and their right sides."""
    n = system.n_links
    turn, turning, _ = hub(system, t)
    theta, w = turn + np.cumsum(angles), turning + np.cumsum(rates)
    c, s = np.cos(theta), np.sin(theta)
    moments = -system.stiffness * angles - system.dashpots * rates
    force = moments - np.append(moments[1:], 0.0)
    mass = np.diag(system.inertias.astype(float))
    for i in range(n):
        middle = reach_of(system, i + 1, system.lengths[i] / 2)
        along, across = -middle * s, middle * c
        force += system.masses[i] * (system.gravity[0] * along + system.gravity[1] * across)
        for felt, gradient, bend in ((system.axial_inertia, along, -middle * c), (True, across, -middle * s)):
            if felt:
                mass += system.masses[i] * np.outer(gradient, gradient)
                force -= system.masses[i] * gradient * (bend @ w**2)
    for load in system.loads:
        now = np.cos(2 * np.pi * load.frequency_hz * t + np.deg2rad(load.phase_deg))
        reach = reach_of(system, load.link, load.at)
        force += now * (load.force[1] * reach * c - load.force[0] * reach * s)
        force[load.link - 1] += now * load.moment
    stretch = system.lengths @ (c - 1.0)
    force -= system.axial_spring * stretch * (-system.lengths * s)
    rows = [reach * c for reach, _ in held(system, t)]
    right = [wanted + reach @ (s * w**2) for reach, wanted in held(system, t)]
    return mass, force, np.array(rows).reshape(len(rows), n), np.array(right)


def by_multipliers(system, t, angles, rates):
    """Relative accelerations from the bordered system [[M, G^T], [G, 0]]."""
    mass, force, rows, right = equations(system, t, angles, rates)
    n, m = len(force), len(rows)
    bordered = np.block([[mass, rows.T], [rows, np.zeros((m, m))]])
    return relative(system, t, np.linalg.solve(bordered, np.append(force, right))[:n])


def by_partitioning(system, t, angles, rates, dependent):
    """Relative accelerations with the dependent absolute angles eliminated, no multiplier."""
    mass, force, rows, right = equations(system, t, angles, rates)
    n = len(force)
    free = np.setdiff1d(np.arange(n), dependent)
    basis, offset = np.zeros((n, len(free))), np.zeros(n)
    basis[free, np.arange(len(free))] = 1.0
    basis[dependent] = -np.linalg.solve(rows[:, dependent], rows[:, free])
    offset[dependent] = np.linalg.solve(rows[:, dependent], right)
    own = np.linalg.solve(basis.T @ mass @ basis, basis.T @ (force - mass @ offset))
    return relative(system, t, basis @ own + offset)


def relative(system, t, accelerations):
    return np.diff(accelerations, prepend=hub(system, t)[2])


def elastica_tip(load):
    """(w/L, 1 - x/L) of a cantilever under a dead transverse tip load PL^2/EI, by elliptic integrals.

    K. E. Bisshopp and D. C. Drucker, Quart. Appl. Math. 3 (1945) 272.
    """
    alpha = np.sqrt(load)

    def angle(p):
        return np.arcsin(1 / (p * np.sqrt(2)))

    p = brentq(lambda p: ellipk(p**2) - ellipkinc(angle(p), p**2) - alpha, np.sqrt(0.5) + 1e-15, 1 - 1e-12, xtol=1e-15)
    deflection = 1 - 2 / alpha * (ellipe(p**2) - ellipeinc(angle(p), p**2))
    return deflection, 1 - np.sqrt(2) / alpha * np.sqrt(2 * p**2 - 1)


def woinowsky_krieger(amplitude):
    """Frequency ratio of a hinged beam with immovable ends, amplitude in radii of gyration.

    q'' + q + (a^2/4) q^3 = 0 of unit amplitude: S. Woinowsky-Krieger, J. Appl. Mech. 17 (1950) 35. Exact for the
    first mode where the strain is its mean along the beam and slopes are small.
    """
    cubic = amplitude**2 / 4
    return np.pi * np.sqrt(1 + cubic) / (2 * ellipk(cubic / (2 * (1 + cubic))))
