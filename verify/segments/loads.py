"""Point forces on a chain of rigid links, and reading it between its joints.

Two rules. The lever rule of a rigid link shares a force between its two joints: order 2, even on a joint. The
reciprocal pair weighs the four joints around with L_j + L_j''/12 (cubic Lagrange polynomials, lengths in links),
for the load and for the reading alike: order 4.
"""

import numpy as np

from verify.arrays import Array
from verify.segments.links import Chain


def joint_weights(chain: Chain, position: float, rule: str) -> Array:
    """Weights of all joints for a force or a reading at `position` (metres), (N + 1,).

    A neighbour beyond a pinned end stands for its odd reflection, beyond a guided end for its even one; at free
    and clamped ends the four joints move inward. Equal links are meant; unequal ones use the lever rule's joint
    and the local spacing.
    """
    nodes = chain.nodes / chain.unit
    place = float(np.clip(position / chain.unit, nodes[0], nodes[-1]))
    link = int(np.clip(np.searchsorted(nodes, place, side="right") - 1, 0, chain.n_segments - 1))
    s = (place - nodes[link]) / chain.lengths[link]
    weights = np.zeros(chain.n_segments + 1)
    if rule == "lever" or chain.n_segments < 3:
        weights[link], weights[link + 1] = 1.0 - s, s
        return weights
    first = _first_of_four(chain, link)
    for at, weight in zip(range(first, first + 4), four_weights(s + link - first), strict=True):
        index, sign = _reflected(chain, at)
        weights[index] += sign * weight
    return weights


def four_weights(s: float) -> Array:
    """L_j(s) + L_j''(s)/12 of the cubic Lagrange polynomials on 0, 1, 2, 3, (4,)."""
    values = np.array(
        [
            -(s - 1) * (s - 2) * (s - 3) / 6,
            s * (s - 2) * (s - 3) / 2,
            -s * (s - 1) * (s - 3) / 2,
            s * (s - 1) * (s - 2) / 6,
        ]
    )
    bends = np.array([2.0 - s, 3.0 * s - 5.0, 4.0 - 3.0 * s, s - 1.0])
    return np.asarray(values + bends / 12.0)


def _first_of_four(chain: Chain, link: int) -> int:
    """The first of the four joints around a link; it may lie one beyond an end that reflects."""
    reflects = [support in ("pinned", "guided") for support in chain.supports]
    lowest, highest = 0 - reflects[0], chain.n_segments - 3 + reflects[1]
    return min(max(link - 1, lowest), highest)


def _reflected(chain: Chain, joint: int) -> tuple[int, float]:
    """A joint on the chain and the sign with which it stands for one that may lie beyond an end."""
    n = chain.n_segments
    if joint < 0:
        return -joint, -1.0 if chain.supports[0] == "pinned" else 1.0
    if joint > n:
        return 2 * n - joint, -1.0 if chain.supports[1] == "pinned" else 1.0
    return joint, 1.0
