"""Sliders on feet as arrays for the kernels, and their rest on a beam: static deflection, heights, contact rate."""

from collections.abc import Sequence

import msgspec
import numpy as np

from verify.arrays import Array, Indices
from verify.errors import InputError, written
from verify.linear.positions import SLACK
from verify.linear.surface import contact_range, section_at
from verify.linear.time_basis import TimeBasis
from verify.motion.request import Request
from verify.motion.surface import Stage, basis_of
from verify.motor import records
from verify.motor.records import Feet, Hard, Log, Rubbing
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
    ground, near = contact_range(beam, start), SLACK * beam.length
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


def weighed(basis: TimeBasis, placed: Sequence[Placed]) -> Array:
    """Modes at rest under what presses the feet on, shared by their points, (n,): on the material under them.

    Square to the surface, so that it also turns what is under a point, by (h/2) w'.
    """
    feet, still = feet_of(placed), np.zeros(len(basis.omegas))
    p = feet.points
    share = (feet.foot[:, None] == np.arange(len(feet.state))) * p[:, [records.WEIGHT]]
    share = share / share.sum(axis=0)  # of two beams one is kept
    apart = np.where(p[:, records.IMAGE] > 0.0, p[:, records.INSET] * p[:, records.STIFF], 0.0)
    x, lever = _places(basis, placed, feet)
    here = basis.shapes(x, 1)
    for _ in range(PASSES):
        at = _under(basis, still, x, lever)
        shapes = basis.shapes(at, 0) + lever * (still @ basis.shapes(at, 1)) * here
        eased = shapes @ share / basis.omegas[:, None]
        still = shapes @ (share @ _pressing(feet, eased.T @ eased) - apart) / basis.omegas**2
    return np.asarray(still)


def _places(basis: TimeBasis, placed: Sequence[Placed], feet: Feet) -> tuple[Array, Array]:
    """(places of all points on the beam, how far above its mid-line), (points,) each, metres."""
    p = feet.points
    half = section_at(basis.beam, placed[0].start).surface_distance
    lever = half * p[:, records.FACE] * p[:, records.IMAGE]
    return placed[0].start + p[:, records.OFFSET], lever


def _under(basis: TimeBasis, still: Array, x: Array, lever: Array) -> Array:
    """The material under points at x, (points,), metres, where the beam is bent so."""
    return np.asarray(np.clip(x + lever * (still @ basis.shapes(x, 1)), 0.0, basis.beam.length))


def _pressing(feet: Feet, compliance: Array) -> Array:
    """What presses each foot on where all are at rest, newton along z, (feet,): springs ease as beam and contact yield.

    `compliance` (feet, feet), m/N, is the beam's own.
    """
    press, spring = feet.given[:, records.PRESS], feet.given[:, records.SPRING]
    if not spring.any():
        return press
    stiff = np.bincount(feet.foot, feet.points[:, records.STIFF])
    yielding = compliance + np.diag(1.0 / stiff)
    return np.asarray(np.linalg.solve(np.eye(len(press)) + spring[:, None] * yielding, press))


def press_apart(placed: Sequence[Placed], basis: TimeBasis, feet: Feet) -> None:
    """A foot between two beams sits deeper by as much as its preload has bent the beam away, on the average."""
    still = weighed(basis, placed)
    bent = still @ basis.shapes(_under(basis, still, *_places(basis, placed, feet)), 0)
    for f in range(len(feet.state)):
        between = (feet.foot == f) & (feet.points[:, records.WEIGHT] < 1.0)
        if between.any():
            feet.points[between, records.INSET] -= bent[between].mean()


def sag_of(request: Request, placed: Sequence[Placed]) -> float | None:
    """Largest static deflection of the beam under the sliders' points, metres, by its first modes.

    None where they would push away, or turn away, a beam that nothing holds.
    """
    beam = request.beam
    if beam.rigid_motions and any(_moves(one) for one in placed):
        return None
    if request.model == "analytic" and set(beam.added) - {"section", "mass"}:  # no exact modes of these
        basis = basis_of(beam, "fem", 2 * SAGGING, None)
    else:
        modes = None if request.modes is None else min(request.modes, SAGGING)
        basis = basis_of(beam, request.model, request.count, modes)
    places = np.concatenate([one.start + feet_of((one,)).points[:, records.OFFSET] for one in placed])
    still = weighed(basis, placed)
    return float(np.abs(still @ basis.shapes(places, 0)).max())


def _moves(one: Placed) -> bool:
    """Whether what presses a slider's feet on leaves a force or a moment: those of a clasp's two faces cancel."""
    feet = feet_of((one,))
    share = (feet.given[:, records.PRESS] / np.bincount(feet.foot))[feet.foot]
    offset = feet.points[:, records.OFFSET]
    moment = abs(share @ offset) > NOTHING * (np.abs(share) @ np.abs(offset))
    return bool(abs(share.sum()) > NOTHING * np.abs(share).sum() or moment) or any(
        foot.mirrored for foot in one.slider.feet
    )


def contact_rate(one: Placed, basis: TimeBasis | None) -> float:
    """The fastest natural frequency that the contact may have, rad/s, every point pressed; with the beam's own ease.

    Also at least what a dashpot turns into one: half its rate is as much as a step bears of it.
    """
    feet = feet_of((one,))
    p, given = feet.points, feet.given[feet.foot]
    ease = given[:, records.FOOT_INVERSE_MASS] + p[:, records.ARM] ** 2 * given[:, records.FOOT_INVERSE_INERTIA]
    along = np.full(len(ease), 1.0 / one.slider.mass)
    if basis is not None:
        places, lever = one.start + p[:, records.OFFSET], section_at(basis.beam, one.start).surface_distance
        ease = ease + (basis.shapes(places, 0) ** 2).sum(axis=0)
        along = along + lever**2 * (basis.shapes(places, 1) ** 2).sum(axis=0)
    rates = [np.sqrt(p[:, records.GRIP] @ along)]
    for f in range(len(feet.state)):
        own = feet.foot == f
        rates += [np.sqrt(p[own, records.STIFF] @ ease[own]), p[own, records.DASHPOT] @ ease[own]]
    return float(max(rates))


def levels_of(stage: Stage, z: Array, beam: Beam, placed: Sequence[Placed], feet: Feet) -> Array:
    """The surface under every point at the start, (points,), metres: of the material X = x + face (h/2) w' there."""
    x, p = placed[0].start + feet.points[:, records.OFFSET], feet.points
    half = section_at(beam, placed[0].start).surface_distance
    lever, at = half * p[:, records.FACE] * p[:, records.IMAGE], x
    factors = np.concatenate([z[0], stage.drive_factors(np.zeros(1))[0]])
    for _ in range(PASSES):
        at = np.clip(x + lever * (factors @ stage.rows(at, 1)), 0.0, beam.length)
    return np.asarray(factors @ stage.rows(at))
