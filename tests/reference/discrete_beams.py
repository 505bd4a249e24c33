"""Models of a uniform beam as others write them down: dense matrices from the textbook, nothing of `verify`'s."""

from itertools import pairwise

import numpy as np
from scipy.linalg import eigh


def hertz(stiffness, mass, free):
    squares = eigh(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)], eigvals_only=True)
    return np.sqrt(abs(squares)) / (2 * np.pi)


def joints_held(supports, n):
    """Positions of joints 0..n that the ends leave free, and whether each end holds its slope."""
    held = {0: supports[0], n: supports[1]}
    return [i for i in range(n + 1) if held.get(i, "free") in ("free", "guided")]


def bending(beam, n, wall=2.0):
    """K of n equal links over joints 0..n: springs EI/l of the angles between them, `wall` EI/l at a clamped end."""
    link, k = beam.length / n, np.zeros((n + 1, n + 1))
    for joint in range(1, n):
        row = np.zeros(n + 1)
        row[joint - 1 : joint + 2] = np.array([1.0, -2.0, 1.0]) / link
        k += np.outer(row, row) * beam.bending_stiffness / link
    for end, beside, support in ((0, 1, beam.supports[0]), (n, n - 1, beam.supports[1])):
        if support == "clamped":
            row = np.zeros(n + 1)
            row[end], row[beside] = -1 / link, 1 / link
            k += wall * np.outer(row, row) * beam.bending_stiffness / link
    return k


def lumped_rod(beam, n):
    """Mass at the joints, half of it at either end."""
    masses = np.full(n + 1, beam.mass_per_length * beam.length / n)
    masses[[0, n]] /= 2
    return hertz(bending(beam, n), np.diag(masses), joints_held(beam.supports, n))


def rigid_links(beam, n, wall=2.0):
    """Links with their own inertia."""
    mass = np.zeros((n + 1, n + 1))
    for i in range(n):
        share = np.array([[1 / 3, 1 / 6], [1 / 6, 1 / 3]])
        mass[i : i + 2, i : i + 2] += beam.mass_per_length * beam.length / n * share
    return hertz(bending(beam, n, wall), mass, joints_held(beam.supports, n))


def links_without_inertia(beam, n):
    """Links whose mass sits in their middles."""
    mass = np.zeros((n + 1, n + 1))
    for i in range(n):
        mass[i : i + 2, i : i + 2] += beam.mass_per_length * beam.length / n / 4
    return hertz(bending(beam, n), mass, joints_held(beam.supports, n))


def lumped_elements(beam, n, rotary=0.0):
    """Hermite elements, half of each mass at either node with `rotary` m l^2; without any the turns are condensed."""
    length, ei = beam.length / n, beam.bending_stiffness
    k = np.zeros((2 * n + 2, 2 * n + 2))
    turn = np.diag([1, length, 1, length])
    element = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    for i in range(n):
        k[2 * i : 2 * i + 4, 2 * i : 2 * i + 4] += ei / length**3 * turn @ element @ turn
    held = {"pinned": (0,), "clamped": (0, 1), "guided": (1,), "free": ()}
    gone = [at + dof for at, support in ((0, beam.supports[0]), (2 * n, beam.supports[1])) for dof in held[support]]
    free = [i for i in range(2 * n + 2) if i not in gone]
    share = np.ones(n + 1)
    share[[0, n]] = 0.5
    m = beam.mass_per_length * length
    masses = np.empty(2 * n + 2)
    masses[0::2], masses[1::2] = m * share, 2 * rotary * m * length**2 * share
    if rotary:
        return hertz(k, np.diag(masses), free)
    moves, turns = [i for i in free if i % 2 == 0], [i for i in free if i % 2]
    condensed = k[np.ix_(moves, moves)] - k[np.ix_(moves, turns)] @ np.linalg.solve(
        k[np.ix_(turns, turns)], k[np.ix_(turns, moves)]
    )
    return np.sqrt(abs(eigh(condensed, np.diag(masses[moves]), eigvals_only=True))) / (2 * np.pi)


def printed_chain(pieces, supports, n):
    """Two sections of n links each, clamped with 2EI/l at the left and pinned at the right, joints by Eq. (1) as printed.

    `pieces` are (length, E, I, rho A); k = 2 E_i E_j I_i I_j / (E_i I_j l_j + E_j I_i l_i).
    """
    assert supports == ("clamped", "pinned")
    links = [(length / count, *rest) for (length, *rest), count in zip(pieces, n, strict=True) for _ in range(count)]
    size = len(links)
    slopes, middles = np.zeros((2, size, size + 1))
    for i, (length, *_) in enumerate(links):
        slopes[i, i : i + 2], middles[i, i : i + 2] = (-1 / length, 1 / length), 0.5
    length, e, i = links[0][:3]
    k = [2 * e * i / length]
    for (l1, e1, i1, _), (l2, e2, i2, _) in pairwise(links):
        k.append(2 * e1 * e2 * i1 * i2 / (e1 * i2 * l2 + e2 * i1 * l1))
    angles = np.diff(slopes, axis=0, prepend=np.zeros((1, size + 1)))
    stiffness = angles.T @ np.diag(k) @ angles
    masses = np.array([length * per_length for length, _, _, per_length in links])
    spins = masses * np.array([length for length, *_ in links]) ** 2 / 12
    mass = middles.T @ np.diag(masses) @ middles + slopes.T @ np.diag(spins) @ slopes
    return hertz(stiffness, mass, list(range(1, size)))
