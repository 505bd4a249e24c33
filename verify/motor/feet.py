"""Sliders on feet as the compiled loop sees them: arrays of their feet and points, set down on a beam."""

from collections.abc import Sequence

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError, written
from verify.models.arrays import Array, Indices
from verify.models.places import SLACK
from verify.models.search import zero_between
from verify.models.underfoot import ground_at
from verify.motor import records
from verify.motor.records import Feet, Hard, Log, Rubbing
from verify.slider import Foot, Slider

EVENTS = 20_000


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


def hard_of(slider: Slider) -> Hard | None:
    """A hard contact; None of one on springs."""
    if slider.contact is None or not slider.contact.hard:
        return None
    mass = slider.moved_by(slider.feet[0])
    return Hard(mass, slider.normal_force / mass, float(slider.contact.restitution))


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


def check_on_beam(slider: Slider, beam: Beam, start: float) -> None:
    """Raise InputError for feet longer than the beam, or off it or over a step where the slider is put."""
    ground, near = ground_at(beam, start), SLACK * beam.length
    for foot in slider.feet:
        if foot.length > beam.length:
            raise InputError(
                f"slider.foot.length = {foot.length!r} m is longer than the beam, {beam.length!r} m: shorten the foot"
            )
        first, last = start + foot.offset - 0.5 * foot.length, start + foot.offset + 0.5 * foot.length
        if first < 0.0 or last > beam.length:
            raise InputError(
                f"slider.position = {start!r} m puts a foot from {first:.6g} to {last:.6g} m, off the beam: move the "
                "slider or shorten slider.foot"
            )
        if first < ground.start - near or last > ground.end + near:
            step = ground.start if first < ground.start else ground.end
            raise InputError(
                f"slider.position = {start!r} m puts a foot from {first:.6g} to {last:.6g} m, over the step of the "
                f"surface where beam.section ends at {written(step)} m: move the slider or shorten slider.foot"
            )


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
    return zero_between(force, -wide, wide, 1e-15 * max(wide, 1e-9), 1e-14)


def fresh_log(samples: int, feet: Feet, rows: Array, every: int) -> Log:
    """Room for a run; `rows` (n, rows) read the deflection where it is kept."""
    return Log(
        every=every,
        kept=np.zeros((samples, len(feet.body), 9)),
        heights=np.zeros((samples, len(feet.state), 2)),
        pressures=np.zeros((samples, len(feet.points))),
        points=rows,
        deflections=np.zeros((samples, len(rows))),
        events=np.zeros((EVENTS, 4)),
        tally=np.zeros(3, dtype=np.int64),
        before=np.zeros((len(feet.body), records.SUMS)),
    )
