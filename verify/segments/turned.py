"""What a chain whose joints slip says of the turn psi of the beam's section, apart from the slope of its line.

A link turns as the section does, and its turn is that of the beam over its length: psi = theta + l^2 psi''/24 at its
middle, order 4. Corrections a_k of a wall's joints turn the links off that smooth line (`walls`), which is taken back.
"""

from collections.abc import Callable

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.linear.spline import natural_or_flat
from verify.segments.links import Chain
from verify.segments.loaded import angles, end_turns, spans, turns


def section_turns(chain: Chain, free: ComplexArray, corrected: bool) -> Callable[[Array, int], ComplexArray]:
    """Turns of the section of the unknowns (n, k): (x, derivative) -> (k, len(x)), radians per metre^derivative.

    A C2 spline through the middles of the links and the ends. No turn at a wall, no moment at pinned and free ends
    that nothing turns; links as they stand where not `corrected`.
    """
    nodes, turned = chain.nodes, turns(chain, free)
    if corrected:
        turned = turned + _smoothed(chain, free)
    middles = 0.5 * (nodes[1:] + nodes[:-1])
    beyond = _beyond(chain, free)
    left, right = (_at_end(chain, turned, beyond, end) for end in (0, 1))
    values = np.concatenate([left, turned, right]).T / chain.unit
    flat = [0 if jointed else 1 for jointed in chain.jointed]
    line = natural_or_flat(np.concatenate([nodes[:1], middles, nodes[-1:]]), values, (flat[0], flat[1]))
    return lambda x, derivative: np.asarray(line(np.clip(x, nodes[0], nodes[-1]), derivative))


def _smoothed(chain: Chain, free: ComplexArray) -> ComplexArray:
    """What the links' turns lack of the section's at their middles, (N, k)."""
    assert chain.weights is not None
    bent, weights = angles(chain, free), chain.weights[:, None]
    own = _own(chain)[:, None] * bent / weights
    off = np.cumsum((bent * (1.0 - 1.0 / weights))[1:-1], axis=0)
    off = np.concatenate([np.zeros_like(bent[:1]), off])
    curvature = own / spans(chain)[:, None]
    return np.asarray(off[len(off) // 2] - off + chain.lengths[:, None] ** 2 / 24.0 * _change(chain, curvature))


def _change(chain: Chain, curvature: ComplexArray) -> ComplexArray:
    """Of the curvature along each link, (N, k), 1/unit^2."""
    return np.asarray(np.diff(curvature, axis=0) / chain.lengths[:, None])


def _own(chain: Chain) -> Array:
    """How much of a joint's angle bends the beam, (N + 1,): the rest a spring beyond it, all of it where none bends."""
    own, whole = chain.own_compliances, chain.compliances
    return np.divide(own, whole, out=np.ones(len(own)), where=np.isfinite(whole))


def _beyond(chain: Chain, free: ComplexArray) -> ComplexArray:
    """Turns of the ends themselves, (2, k): of a body beyond the joint, or of a spring under the joint's moment."""
    bent = angles(chain, free)[[0, -1]] / chain.compliances[[0, -1], None]
    return np.asarray(
        end_turns(chain, free) + np.array([[1.0], [-1.0]]) * bent * np.array(chain.end_compliances)[:, None]
    )


def _at_end(chain: Chain, turned: ComplexArray, beyond: ComplexArray, end: int) -> ComplexArray:
    """The turn at the left or the right end, (1, k): even in the distance where no moment acts."""
    if chain.jointed[end]:
        return beyond[[end]]
    (first, second), (near, far) = ((a[0], a[1]) if not end else (a[-1], a[-2]) for a in (turned, chain.lengths))
    here, there = (0.5 * near) ** 2, (near + 0.5 * far) ** 2
    return np.asarray(first - (second - first) * here / (there - here))[None]
