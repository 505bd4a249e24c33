"""A slider on feet as the compiled loop sees it: arrays of its feet and points, laid on a beam."""

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array, Indices
from verify.models.search import zero_between
from verify.motor.records import Feet, Hard, Log, Rubbing
from verify.slider import Foot, Slider

EVENTS = 20_000


def arms(foot: Foot) -> Array:
    """Where its points stand, (points,), metres from its middle."""
    return np.asarray(foot.length * ((np.arange(foot.points) + 0.5) / foot.points - 0.5))


def shared_mass(slider: Slider, foot: Foot) -> float:
    """What of the slider moves with one foot across the beam, kg."""
    return slider.mass / len(slider.feet) if foot.mass is None else foot.mass


class Onto(msgspec.Struct, frozen=True):
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
    """The law of friction, all sliders'."""
    slope = None if slider.law == "coulomb" else float(slider.slope)
    return Rubbing(slope=slope, half=float(beam.surface_distance))


def hard_of(slider: Slider) -> Hard | None:
    """A hard contact; None of one on springs."""
    if slider.contact is None or not slider.contact.hard:
        return None
    mass = shared_mass(slider, slider.feet[0])
    return Hard(mass, slider.normal_force / mass, float(slider.contact.restitution))


def feet_of(onto: Sequence[Onto]) -> Feet:
    """The feet at height 0, with their points; distances are from where the first slider is put."""
    feet = [(b, foot) for b, one in enumerate(onto) for foot in one.slider.feet]
    sheets = [_points(onto[b].slider, foot, onto[b].start - onto[0].start) for b, foot in feet]
    points, lengths = np.concatenate(sheets), [len(sheet) for sheet in sheets]
    keeper = _whole(np.array([b for b, _ in feet]))
    return Feet(
        body=np.array([[0.0, one.speed] for one in onto]),
        riders=np.array([_rider(one) for one in onto]),
        means=np.zeros((len(onto), 3)),
        state=np.zeros((len(feet), 4)),
        given=np.array([_given(onto[b].slider, foot) for b, foot in feet]),
        points=points,
        touch=np.zeros((len(points), 12)),
        foot=_whole(np.repeat(np.arange(len(feet)), lengths)),
        owner=_whole(np.repeat(keeper, lengths)),
        keeper=keeper,
        piece=_whole(np.zeros(len(points))),
        kick=np.zeros((len(feet), 2)),
        sums=np.zeros((len(onto), 13)),
    )


def _rider(one: Onto) -> tuple[float, float, float, float]:
    """(mu, 1/mass, pull, whether it moves along) of a slider."""
    light = 0.0 if one.held_speed is not None else 1.0 / one.slider.mass
    return float(one.slider.mu), light, float(one.slider.pull), 0.0 if one.frozen else 1.0


def _whole(values: Array) -> Indices:
    return np.asarray(values, dtype=np.int64)


def _given(slider: Slider, foot: Foot) -> tuple[float, float, float, float]:
    """(1/mass, 1/inertia, force along z, stiffness of what presses) of a foot."""
    mass, n = shared_mass(slider, foot), len(slider.feet)
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
    sheet[:, 1] = arms(foot)
    sheet[:, 0] = beyond + foot.offset + sheet[:, 1]
    sheet[:, 2:5], sheet[:, 5], sheet[:, 6], sheet[:, 7] = shares, face, 1.0, inset
    sheet[:, 8] = 0.5 if foot.mirrored else 1.0
    if not foot.mirrored:
        return sheet
    above = sheet.copy()
    above[:, 5], above[:, 6] = -1.0, -1.0
    return np.concatenate([sheet, above])


def check_on_beam(slider: Slider, beam: Beam, start: float) -> None:
    """Raise InputError for feet longer than the beam, or off it where the slider is put."""
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


def put_down(feet: Feet, levels: Array) -> None:
    """Set every foot, level, at the height where its springs carry what presses it on; `levels` (points,), metres.

    Raises InputError for a foot that nothing presses on.
    """
    points = feet.points
    for f in range(len(feet.state)):
        own = feet.foot == f
        face, stiff = points[own, 5], points[own, 2]
        touching = points[own, 7] + face * points[own, 6] * levels[own]

        def force(z: float, f: int = f, face: Array = face, stiff: Array = stiff, touching: Array = touching) -> float:
            pushes = face * stiff * np.maximum(touching - face * z, 0.0)
            return float(pushes.sum() + feet.given[f, 2] - feet.given[f, 3] * z)

        feet.state[f, 0] = _balanced(force, float(np.abs(levels[own]).max()), float(stiff.sum()), f, feet)


def _balanced(falls: Callable[[float], float], reach: float, stiff: float, f: int, feet: Feet) -> float:
    wide = 2.0 * reach + 2.0 * (abs(float(feet.given[f, 2])) + stiff * float(feet.points[:, 7].max())) / stiff + 1e-12
    if not falls(-wide) > 0.0 > falls(wide):
        way = "its weight is more than the preload" if feet.given[f, 2] < 0.0 else "nothing presses it on"
        raise InputError(f"slider.preload leaves foot {f + 1} off the beam, {way}: raise slider.preload")
    return zero_between(falls, -wide, wide, 1e-15 * max(wide, 1e-9), 1e-14)


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
        before=np.zeros((len(feet.body), 13)),
    )
