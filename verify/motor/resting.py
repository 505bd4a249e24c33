"""Sliders at rest on a beam: how it bends under them, where their points stand, how stiff they stand on it."""

from collections.abc import Sequence

import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array
from verify.models.time_basis import TimeBasis
from verify.models.underfoot import standing_at
from verify.motion.request import Request
from verify.motion.surface import Stage, basis_of
from verify.motor import records
from verify.motor.feet import Placed, feet_of
from verify.motor.records import Feet

PASSES = 4
"""Each shortens what is left of the way to the material under a point by (h/2) w'' and more."""
NOTHING = 1e-12
"""Of the forces and of their moments: what rounding leaves of a clasp's."""
SAGGING = 20
"""Modes that a static deflection is read from."""


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
    half = standing_at(basis.beam, placed[0].start).surface_distance
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
    if request.beam.rigid_motions and any(_moves(one) for one in placed):
        return None
    basis = _slow_modes(request)
    places = np.concatenate([one.start + feet_of((one,)).points[:, records.OFFSET] for one in placed])
    still = weighed(basis, placed)
    return float(np.abs(still @ basis.shapes(places, 0)).max())


def _slow_modes(request: Request) -> TimeBasis:
    """Of the model; of elements for an exact beam of more than sections and bodies, whose modes are not had."""
    beam, n = request.beam, min(request.modes, SAGGING)
    if request.model == "analytic" and set(beam.added) - {"section", "mass"}:
        return basis_of(beam, "fem", 2 * SAGGING, n, "spline")
    return basis_of(beam, request.model, request.count, n, "spline")


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
        places, lever = one.start + p[:, records.OFFSET], standing_at(basis.beam, one.start).surface_distance
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
    half = standing_at(beam, placed[0].start).surface_distance
    lever, at = half * p[:, records.FACE] * p[:, records.IMAGE], x
    factors = np.concatenate([z[0], stage.drive_factors(np.zeros(1))[0]])
    for _ in range(PASSES):
        at = np.clip(x + lever * (factors @ stage.rows(at, 1)), 0.0, beam.length)
    return np.asarray(factors @ stage.rows(at))
