"""Sliders on feet as arrays for the kernels, and their rest on a beam: static deflection, heights, contact rate."""

from collections.abc import Sequence

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError
from verify.motor import records
from verify.motor.records import Feet, Rubbing
from verify.problem.beam import Beam
from verify.problem.slider import Foot, Slider

EVENTS = 20_000
PASSES = 4
"""Fixed-point iterations for the material under a point; each reduces the error by (h/2) w'' and more."""
NOTHING = 1e-12
"""Of the forces and of their moments: rounding of a clasp's sum."""
SAGGING = 20
"""Modes of a static deflection."""


def arms(foot: Foot) -> Array:
    """Where its points stand, (points,), metres from its middle."""
    return np.asarray(foot.length * ((np.arange(foot.points) + 0.5) / foot.points - 0.5))


class Placed(msgspec.Struct, frozen=True):
    """A slider and how it is put on."""

    slider: Slider
    start: float
    """Metres from the left end."""
    held_speed: float | None = None
    """m/s; None: friction moves it."""
    frozen: bool = False
    """Whether it stays at its place, whatever its speed."""

    @property
    def speed(self) -> float:
        """At the start, m/s."""
        return self.slider.speed if self.held_speed is None else self.held_speed


def rubbing_of(slider: Slider, beam: Beam) -> Rubbing:
    """The law of friction, all sliders', on this beam's own section."""
    return Rubbing(slope=slider.steepness, half=float(beam.surface_distance))


def feet_of(placed: Sequence[Placed]) -> Feet:
    """The feet at height 0, with their points; distances are from where the first slider is put."""
    feet = [(b, foot) for b, one in enumerate(placed) for foot in one.slider.feet]
    sheets = [_points(placed[b].slider, foot, placed[b].start - placed[0].start) for b, foot in feet]
    points, lengths = np.concatenate(sheets), [len(sheet) for sheet in sheets]
    keeper = _whole(np.array([b for b, _ in feet]))
    return Feet(
        body=np.array([[0.0, one.speed] for one in placed]),
        riders=np.array([_rider(one) for one in placed]),
        means=np.zeros((len(placed), 3)),
        state=np.zeros((len(feet), 4)),
        given=np.array([_given(placed[b].slider, foot) for b, foot in feet]),
        points=points,
        touch=np.zeros((len(points), records.TOUCH)),
        foot=_whole(np.repeat(np.arange(len(feet)), lengths)),
        owner=_whole(np.repeat(keeper, lengths)),
        first=np.searchsorted(np.repeat(keeper, lengths), np.arange(len(placed) + 1)).astype(np.int64),
        keeper=keeper,
        piece=_whole(np.zeros(len(points))),
        kick=np.zeros((len(feet), 2)),
        sums=np.zeros((len(placed), records.SUMS)),
    )


def _rider(one: Placed) -> tuple[float, float, float, float]:
    """(mu, 1/mass, pull, whether it moves along) of a slider."""
    inverse_mass = 0.0 if one.held_speed is not None else 1.0 / one.slider.mass
    return float(one.slider.mu), inverse_mass, float(one.slider.pull), 0.0 if one.frozen else 1.0


def _whole(values: Array) -> Indices:
    return np.asarray(values, dtype=np.int64)


def _given(slider: Slider, foot: Foot) -> tuple[float, float, float, float]:
    """(1/mass, 1/inertia, force along z, stiffness of what presses) of a foot."""
    mass, n = slider.moved_by(foot), len(slider.feet)
    inertia = mass * foot.length**2 / 12.0 if foot.inertia is None else foot.inertia
    weight, preload = slider.mass * slider.gravity / n, slider.preload / n
    pressed = 0.0 if foot.mirrored else preload if foot.face == "lower" else -preload
    turns = foot.pitches and foot.points > 1
    return 1.0 / mass, 1.0 / inertia if turns else 0.0, pressed - weight, float(slider.preload_stiffness)


def _points(slider: Slider, foot: Foot, beyond: float) -> Array:
    """(points, 9): the columns of `Feet.points`; of a foot between two beams those below, then those above."""
    contact = slider.contact
    assert contact is not None
    across = contact.across(foot.length)
    inset = slider.preload / len(slider.feet) / across if foot.mirrored else 0.0
    shares = np.array([across, contact.damping, contact.along(foot.length)]) / foot.points
    face = -1.0 if foot.face == "lower" else 1.0
    sheet = np.zeros((foot.points, 9))
    sheet[:, records.ARM] = arms(foot)
    sheet[:, records.OFFSET] = beyond + foot.offset + sheet[:, records.ARM]
    sheet[:, [records.STIFF, records.DASHPOT, records.GRIP]] = shares
    sheet[:, records.FACE], sheet[:, records.IMAGE], sheet[:, records.INSET] = face, 1.0, inset
    sheet[:, records.WEIGHT] = 0.5 if foot.mirrored else 1.0
    if not foot.mirrored:
        return sheet
    above = sheet.copy()
    above[:, records.FACE], above[:, records.IMAGE] = -1.0, -1.0
    return np.concatenate([sheet, above])


def put_down(feet: Feet, levels: Array) -> None:
    """Set every foot, level, at the height where its springs carry what presses it on; `levels` (points,), metres.

    Raises InputError for a foot that nothing presses on.
    """
    deepest = float(feet.points[:, records.INSET].max())
    for f in range(len(feet.state)):
        own = feet.foot == f
        feet.state[f, records.HEIGHT] = _rest_height(f, feet.points[own], levels[own], feet.given[f], deepest)


def _rest_height(f: int, points: Array, levels: Array, given: Array, deepest: float) -> float:
    """Of foot f on its own points over these levels, metres. Raises InputError."""
    from scipy.optimize import brentq

    face, stiff, press = points[:, records.FACE], points[:, records.STIFF], float(given[records.PRESS])
    depths = points[:, records.INSET] + face * points[:, records.IMAGE] * levels

    def force(z: float) -> float:
        """On the foot at a height, newton: it falls as the foot rises."""
        return float((face * stiff * np.maximum(depths - face * z, 0.0)).sum() + press - given[records.SPRING] * z)

    total = float(stiff.sum())
    wide = 2.0 * float(np.abs(levels).max()) + 2.0 * (abs(press) + total * deepest) / total + 1e-12
    if not force(-wide) > 0.0 > force(wide):
        way = "its weight is more than the preload" if press < 0.0 else "nothing presses it on"
        raise InputError(f"slider.preload leaves foot {f + 1} off the beam, {way}: raise slider.preload")
    return float(brentq(force, -wide, wide, xtol=1e-15 * max(wide, 1e-9), rtol=1e-14))
