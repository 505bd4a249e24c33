"""Matrices of a beam of sections, from the textbook's element and link."""

import numpy as np

from verify.scenes.scene import load_scene

PATCHED = load_scene("patched-strip").beam


def written_out(model, counts, grading):
    """K and M of the patched strip for so many parts in each section, from the textbook's element or link, SI."""
    parts = [
        (piece, piece.length * grading ** (i / max(n - 1, 1)) / sum(grading ** (j / max(n - 1, 1)) for j in range(n)))
        for piece, n in zip(PATCHED.pieces, counts, strict=True)
        for i in range(n)
    ]
    n = len(parts)
    if model == "fem":
        stiffness, mass = np.zeros((2, 2 * n + 2, 2 * n + 2))
        for i, (piece, length) in enumerate(parts):
            at, turn = slice(2 * i, 2 * i + 4), np.diag([1, length, 1, length])
            k = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
            m = np.array([[156, 22, 54, -13], [22, 4, 13, -3], [54, 13, 156, -22], [-13, -3, -22, 4]])
            stiffness[at, at] += piece.bending_stiffness / length**3 * turn @ k @ turn
            mass[at, at] += piece.mass_per_length * length / 420 * turn @ m @ turn
        free = [i for i in range(2 * n + 2) if i not in (0, 1, 2 * n)]
    else:
        slopes, middles = np.zeros((2, n, n + 1))
        for i, (_, length) in enumerate(parts):
            slopes[i, i : i + 2], middles[i, i : i + 2] = (-1 / length, 1 / length), 0.5
        angles = np.diff(slopes, axis=0, prepend=np.zeros((1, n + 1)))
        half = np.array([0.5 * length / piece.bending_stiffness for piece, length in parts])
        compliances = half + np.append(half[0], half[:-1])  # behind the wall the first link goes on
        compliances[:3] *= 3 / 8, 7 / 6, 23 / 24
        stiffness = angles.T @ (angles / compliances[:, None])
        masses = np.array([piece.mass_per_length * length for piece, length in parts])
        spins = masses * np.array([length for _, length in parts]) ** 2 / 12
        mass = middles.T @ (masses[:, None] * middles) + slopes.T @ (spins[:, None] * slopes)
        free = list(range(1, n))
    return stiffness[np.ix_(free, free)], mass[np.ix_(free, free)]
