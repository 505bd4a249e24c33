"""Models of uniform beams in the literature: the dense links and elements with other masses and walls, hertz."""

from itertools import pairwise

import numpy as np
from scipy.linalg import eigh

from tests.reference.dense import Elements, Links


def hertz(stiffness, mass, free):
    squares = eigh(stiffness[np.ix_(free, free)], mass[np.ix_(free, free)], eigvals_only=True)
    return np.sqrt(abs(squares)) / (2 * np.pi)


def links(beam, n, wall=2.0):
    """Equal links with springs EI/l, `wall` EI/l at a clamped end."""
    return Links(beam, np.linspace(0.0, beam.length, n + 1), np.array([1 / wall]))


def lumped_rod(beam, n):
    """Mass at the joints, half of it at either end."""
    chain = links(beam, n)
    masses = np.full(n + 1, beam.mass_per_length * beam.length / n)
    masses[[0, n]] /= 2
    return hertz(chain.bending, np.diag(masses), chain.free)


def rigid_links(beam, n, wall=2.0):
    """Links with their own inertia."""
    chain = links(beam, n, wall)
    return hertz(chain.bending, chain.mass, chain.free)


def links_without_inertia(beam, n):
    """Links with their mass in their middles."""
    chain, mass = links(beam, n), np.zeros((n + 1, n + 1))
    for i in range(n):
        mass[i : i + 2, i : i + 2] += beam.mass_per_length * beam.length / n / 4
    return hertz(chain.bending, mass, chain.free)


def lumped_elements(beam, n, rotary=0.0):
    """Hermite elements, half of each mass at either node with `rotary` m l^2; without it rotations are condensed."""
    elements = Elements(beam, np.linspace(0.0, beam.length, n + 1))
    share = np.ones(n + 1)
    share[[0, n]] = 0.5
    m, k, free = beam.mass_per_length * beam.length / n, elements.bending, elements.free
    masses = np.ravel(m * share[:, None] * [1.0, 2 * rotary * (beam.length / n) ** 2])
    if rotary:
        return hertz(k, np.diag(masses), free)
    moves, turns = ([i for i in free if i % 2 == parity] for parity in (0, 1))
    coupling = k[np.ix_(moves, turns)]
    condensed = k[np.ix_(moves, moves)] - coupling @ np.linalg.solve(k[np.ix_(turns, turns)], coupling.T)
    return np.sqrt(abs(eigh(condensed, np.diag(masses[moves]), eigvals_only=True))) / (2 * np.pi)


def printed_chain(pieces, supports, n):
    """Sections of links, clamped with 2EI/l at the left and pinned at the right, joints by Eq. (1) as printed.

    `pieces` are (length, E, I, rho A); k = 2 E_i E_j I_i I_j / (E_i I_j l_j + E_j I_i l_i).
    """
    assert supports == ("clamped", "pinned")
    parts = [(length / count, *rest) for (length, *rest), count in zip(pieces, n, strict=True) for _ in range(count)]
    size, (length, e, i, _) = len(parts), parts[0]
    k = [2 * e * i / length]
    for (l1, e1, i1, _), (l2, e2, i2, _) in pairwise(parts):
        k.append(2 * e1 * e2 * i1 * i2 / (e1 * i2 * l2 + e2 * i1 * l1))
    lengths, lines = np.array([one[0] for one in parts]), np.array([one[3] for one in parts])
    eye = np.eye(size + 1)
    slopes, middles = np.diff(eye, axis=0) / lengths[:, None], 0.5 * (eye[1:] + eye[:-1])
    angles = np.diff(slopes, axis=0, prepend=np.zeros((1, size + 1)))
    stiffness = angles.T @ np.diag(k) @ angles
    mass = middles.T @ np.diag(lines * lengths) @ middles + slopes.T @ np.diag(lines * lengths**3 / 12) @ slopes
    return hertz(stiffness, mass, list(range(1, size)))
