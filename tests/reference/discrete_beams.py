"""Models of uniform beams in the literature: the dense links and elements with other masses and walls, hertz."""

import numpy as np
from scipy.linalg import eigh

from tests.reference.dense import Elements, Links


def hertz(squares):
    return np.sqrt(abs(squares)) / (2 * np.pi)


def links(beam, n, wall=2.0):
    """Equal links with springs EI/l, `wall` EI/l at a clamped end."""
    return Links(beam, np.linspace(0.0, beam.length, n + 1), np.array([1 / wall]))


def lumped_rod(beam, n):
    """Mass at the joints, half of it at either end."""
    chain = links(beam, n)
    masses = np.full(n + 1, beam.mass_per_length * beam.length / n)
    masses[[0, n]] /= 2
    chain.mass = np.diag(masses)
    return hertz(chain.modes[0])


def rigid_links(beam, n, wall=2.0):
    """Links with their own inertia."""
    return hertz(links(beam, n, wall).modes[0])


def links_without_inertia(beam, n):
    """Links with their mass in their middles."""
    chain = links(beam, n)
    chain.mass = np.zeros((n + 1, n + 1))
    for i in range(n):
        chain.mass[i : i + 2, i : i + 2] += beam.mass_per_length * beam.length / n / 4
    return hertz(chain.modes[0])


def lumped_elements(beam, n, rotary=0.0, bodies=()):
    """Hermite elements, half of each mass at either node with `rotary` m l^2; without it rotations are condensed.

    `bodies`: (node, mass).
    """
    elements = Elements(beam, np.linspace(0.0, beam.length, n + 1))
    share = np.ones(n + 1)
    share[[0, n]] = 0.5
    m, k, free = beam.mass_per_length * beam.length / n, elements.bending, elements.free
    elements.mass = np.diag(np.ravel(m * share[:, None] * [1.0, 2 * rotary * (beam.length / n) ** 2]))
    for node, mass in bodies:
        elements.mass[2 * node, 2 * node] += mass
    if rotary:
        return hertz(elements.modes[0])
    moves, turns = ([i for i in free if i % 2 == parity] for parity in (0, 1))
    rotations = -np.linalg.solve(k[np.ix_(turns, turns)], k[np.ix_(turns, moves)])
    condensed = k[np.ix_(moves, moves)] + k[np.ix_(moves, turns)] @ rotations
    vectors = np.zeros((len(k), len(moves)))
    vectors[moves] = eigh(condensed, elements.mass[np.ix_(moves, moves)])[1]
    vectors[turns] = rotations @ vectors[moves]
    return hertz(elements.squares(vectors))


def stepped_chain(beam, n, rule):
    """Links of two sections, clamped with 2EI/l at the left and pinned at the right, joints by Eq. (1) as printed.

    k = 2 E_i E_j I_i I_j / (E_i I_j l_j + E_j I_i l_i). Other rules: EI/l of the outboard or inboard link, mean EI.
    """
    ends = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    parts = [np.linspace(*span, count + 1) for *span, count in zip(ends[:-1], ends[1:], n, strict=True)]
    chain = Links(beam, np.unique(np.concatenate(parts)), np.array([0.5]))
    e, i = np.transpose([(piece.youngs_modulus, piece.second_moment) for piece in chain.pieces])
    k = 2 * e[:-1] * e[1:] * i[:-1] * i[1:]
    k /= e[:-1] * i[1:] * chain.lengths[1:] + e[1:] * i[:-1] * chain.lengths[:-1]
    own = e * i / chain.lengths
    rules = {"outboard": own[1:], "inboard": own[:-1], "mean": (own[1:] + own[:-1]) / 2}
    chain.rigidity[1:] = rules.get(rule, k)
    chain.bending = (chain.bend.T * chain.rigidity) @ chain.bend
    return hertz(chain.modes[0])


def varying_beam(length, stiffness, mass, left, right, crack=None, n=120):
    """Hermite elements with EI(x) and rho A(x) of their middles between clamped, pinned or free ends.

    `crack`: node and rotational spring, N m.
    """
    size, part = 2 * n + 3, length / n
    k = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]]) / part**3
    m = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]]) * part / 420
    scale = np.array([1.0, part, 1.0, part])
    k, m = (matrix * np.outer(scale, scale) for matrix in (k, m))
    stiff, heavy, fixed = np.zeros((size, size)), np.zeros((size, size)), set()
    for i in range(n):
        at = [2 * i, size - 1 if crack and i == crack[0] else 2 * i + 1, 2 * i + 2, 2 * i + 3]
        stiff[np.ix_(at, at)] += stiffness((i + 0.5) * part) * k
        heavy[np.ix_(at, at)] += mass((i + 0.5) * part) * m
    if crack:
        both = [2 * crack[0] + 1, size - 1]
        stiff[np.ix_(both, both)] += crack[1] * np.array([[1, -1], [-1, 1]])
    for node, support in ((0, left), (n, right)):
        fixed |= {"free": set(), "pinned": {2 * node}, "clamped": {2 * node, 2 * node + 1}}[support]
    free = np.array([i for i in range(size) if i not in fixed and (crack or i < size - 1)])
    return hertz(eigh(stiff[np.ix_(free, free)], heavy[np.ix_(free, free)], eigvals_only=True))


def half_links(beam, n):
    """Links with n joints EI/l: half links at both ends, the first fixed at a clamped end; each its own uniform bar."""
    part, m = beam.length / n, beam.mass_per_length
    corners = np.concatenate([[0.0], (np.arange(n) + 0.5) * part, [beam.length]])
    stiff, heavy = np.zeros((n + 2, n + 2)), np.zeros((n + 2, n + 2))
    for i, size in enumerate(np.diff(corners)):
        heavy[i : i + 2, i : i + 2] += m * size * np.array([[2, 1], [1, 2]]) / 6
    for i in range(1, n + 1):
        a, b = corners[i] - corners[i - 1], corners[i + 1] - corners[i]
        jump = np.array([1 / a, -1 / a - 1 / b, 1 / b])
        stiff[i - 1 : i + 2, i - 1 : i + 2] += beam.bending_stiffness / part * np.outer(jump, jump)
    held = {"clamped": [0, 1], "pinned": [0], "free": []}
    fixed = held[beam.supports[0]] + [n + 1 - i for i in held[beam.supports[1]]]
    free = [i for i in range(n + 2) if i not in fixed]
    return hertz(eigh(stiff[np.ix_(free, free)], heavy[np.ix_(free, free)], eigvals_only=True))


def tensioned(beam, tension, n):
    """Pinned beam under an axial force (Weaver, Timoshenko and Young, Vibration Problems in Engineering, 1990)."""
    k = np.arange(1, n + 1) * np.pi / beam.length
    squares = (beam.bending_stiffness * k**4 + tension * k**2) / beam.mass_per_length
    return np.sqrt(squares) / (2 * np.pi)
