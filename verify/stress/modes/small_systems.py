"""Small systems that links solve for what bodies feel, by numpy's; means over a wave as a loop keeps them."""

from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.stress.kind import Floor, Row
from verify.stress.largest import largest

KERNEL = -np.abs(np.subtract.outer(np.arange(5.0), np.arange(5.0))) + 0.3 * np.eye(5)
WEIGHTS = np.array(
    [[0.1, 0.7, 0.2, 0.0, 0.0], [0.0, 0.4, 0.5, 0.1, 0.0], [0.2, 0.2, 0.2, 0.2, 0.2], [0.0, 0.3, 0.6, 0.1, 0.0]]
)
SHARES = np.array(
    [[0.1, -0.3, 0.3, -0.1, 0.0], [1.0, -4.0, 6.0, -4.0, 1.0], [0.3, 0.0, 0.1, 0.0, 0.2], [0.0, 0.0, 0.0, 0.0, 0.0]]
)
PAIRS = (
    ((2.0, -1.0, 0.3, 4.0), (1.0, -3.0)),
    ((1.0, 2.0, 2.0, 4.0), (1.0, 2.5)),
    ((0.0, 0.0, 0.0, 0.0), (1.0, -2.0)),
    ((1.0, -2.0, -0.5, 1.0 + 1e-13), (0.4, 0.7)),
)
"""Matrices by rows and right sides, the last three singular."""


def solved_error(number: float) -> float:
    """Of pairs of unknowns, together and alone, by numpy's least squares; of weights whose forms are to be nothing."""
    from verify.segments.attached import _solved, _without_self

    worst = 0.0
    for chosen in (slice(0, 1), slice(0, 4)):
        rows, right = (np.array([one[part] for one in PAIRS[chosen]]).T for part in (0, 1))
        found = np.array(_solved((rows[0], rows[1], rows[2], rows[3]), (right[0], right[1]))).T
        for x, (matrix, side) in zip(found, PAIRS[chosen], strict=True):
            exact = np.linalg.lstsq(np.reshape(matrix, (2, 2)), np.array(side), rcond=1e-9)[0]
            worst = largest(worst, float(abs(x - exact).max()))
    for sign in (1.0, -1.0):
        kernel = sign * KERNEL
        found = _without_self(WEIGHTS, SHARES, kernel)
        for own, weights, shares in zip(found, WEIGHTS, SHARES, strict=True):
            a, b, c = (one @ kernel @ other for one, other in ((shares, shares), (weights, shares), (weights, weights)))
            roots = np.roots([a, 2.0 * b, c]) if abs(a) >= 1e-12 else np.zeros(1)
            least = -b / a if abs(a) >= 1e-12 and np.iscomplex(roots).any() else float(min(roots.real, key=abs))
            worst = largest(worst, float(abs(own - weights - least * shares).max()))
    return worst


def wave_means_error(number: float) -> float:
    """Of means over the last of three periods of a wave, their spreads from the one before, and the foot's own."""
    from verify.identify.pairing import by_number
    from verify.motor import records
    from verify.motor.feet import feet_of
    from verify.motor.on_wave import _means, _riding, _slider
    from verify.stress.references.beams import STRIP

    kept = np.zeros((3, 1, 9))
    kept[1, 0], kept[2, 0] = np.arange(9.0), 1.5 * np.arange(9.0) + np.array([0, 0, 3, -9, 2, 1, -4, 5, 0])
    fake: Any = SimpleNamespace(log=SimpleNamespace(kept=kept))
    stage: Any = SimpleNamespace(duration=0.6)
    found, last, apart = _means(fake, stage, -0.3), kept[2, 0], abs(kept[2, 0] - kept[1, 0])
    own = (found.force, found.normal_force, found.contact_share, found.stuck_share, found.given, found.rubbed)
    exact = last[[2, 3, 4, 5, 7, 6]] / np.array([1.0, 1.0, 1.0, 1.0, 0.2, 0.2])
    spreads = (apart[2], apart[3], max(apart[4], apart[5]), max(apart[6], apart[7]) / 0.2)
    off = abs(np.array(own) - exact).max()
    off += abs(
        np.array((found.spread, found.normal_spread, found.share_spread, found.power_spread)) - np.array(spreads)
    ).max()
    wrong = (found.speed, found.periods, found.window, found.unsettled) != (-0.3, 3, 1, ())
    slider = _slider(0.3, 0.02, 40.0, 0.002, 0.15, 7)
    riding = _riding(slider, STRIP, -0.3, 1e-9, 3)
    foot, contact = slider.feet[0], slider.contact
    wrong |= (foot.length, foot.points, foot.offset, foot.pitches, slider.mu) != (0.15, 7, 0.075, False, 0.3)
    wrong |= contact is None or contact.layer_stiffness != 1.0
    along = contact.layer_tangential_stiffness if contact is not None else None
    off += abs((along or 0.0) / (2.0 * 0.3 / (0.02 * 40.0 * 0.002)) - 1.0)
    wrong |= bool(riding.feet.given[:, records.FOOT_INVERSE_MASS].any()) or riding.two_way or riding.log.every != 1
    wrong |= riding.feet.state[:, records.HEIGHT].tolist() != [1e-9] or len(feet_of(riding.placed).points) != 7
    plain = _slider(0.3, 0.0, 40.0, 0.002, 0.15, 7).contact
    wrong |= plain is None or plain.layer_tangential_stiffness is not None
    pairs = by_number((2, 5, 9))
    wrong |= pairs.entries.tolist() != [0, 1, 2] or pairs.modes.tolist() != [1, 4, 8]
    return float(largest(off, float(wrong)))


ROWS: tuple[Row, ...] = (
    Floor(
        id="weights-without-themselves",
        title="Pairs of unknowns, singular ones as well, and weights with the smallest shares that leave nothing",
        why="segments/attached.py: numpy's least squares and roots.",
        along="1",
        at=(1.0,),
        promise=1e-11,
        error=solved_error,
    ),
    Floor(
        id="means-over-a-wave",
        title="Means and spreads of a foot's last period over a wave, and the foot; modes by their numbers",
        why="motor/on_wave.py, identify/pairing.py: as the loop keeps them.",
        along="1",
        at=(1.0,),
        promise=1e-12,
        error=wave_means_error,
    ),
)
