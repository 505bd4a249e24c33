"""Sliders, their feet and contact points as the arrays of the contact engine."""

from collections.abc import Sequence

import numpy as np

from verify.arrays import Array
from verify.dynamics import layout as lay
from verify.dynamics.stepping import Contacts
from verify.errors import InputError, written
from verify.linear.positions import SLACK
from verify.linear.surface import check_one_range, contact_range, section_at
from verify.linear.time_basis import TimeBasis
from verify.problem.beam import Beam
from verify.problem.slider import Foot, Slider


def assemble(
    beam: Beam,
    sliders: Sequence[Slider],
    starts: Sequence[float],
    prescribed_speeds: Sequence[float | None],
    fixed: Sequence[bool],
) -> Contacts:
    """Sliders without transverse motion, feet at height 0.

    A slider without `contact` is one bilateral point; its normal force is prescribed, or includes the reaction of its
    mass (two-way coupling with normal = "bilateral").
    """
    two_way, first = sliders[0].coupling == "two-way", sliders[0]
    half = section_at(beam, starts[0]).surface_distance
    rows, sheets, feet, indices = [], list[Array](), list[list[float]](), list[tuple[int, int, int]]()
    for number, (slider, start, speed, stays) in enumerate(zip(sliders, starts, prescribed_speeds, fixed, strict=True)):
        row = np.zeros(lay.SLIDER)
        row[lay.V] = slider.speed if speed is None else speed
        row[lay.INVERSE_MASS] = 1.0 / slider.mass if speed is None else 0.0
        row[lay.MU] = slider.mu
        row[lay.MU_STATIC] = slider.mu if slider.mu_static is None else slider.mu_static
        row[lay.STEEPNESS], row[lay.EXTERNAL_FORCE] = slider.steepness or 0.0, slider.external_force
        row[lay.FREE] = 0.0 if stays else 1.0
        rows.append(row)
        for foot in slider.feet if slider.contact else (None,):
            if foot is None:
                sheet = np.zeros((1, lay.POINT))
                sheet[0, [lay.FACE, lay.IMAGE, lay.WEIGHT]] = 1.0
                sheet[0, [lay.LOAD, lay.INERTIA]] = slider.normal_force, slider.mass
            else:
                sheet = _foot_points(slider, foot)
            sheet[:, lay.OFFSET] += start - starts[0]
            sheet[:, lay.LEVER] = half * sheet[:, lay.FACE] * sheet[:, lay.IMAGE]
            sheets.append(sheet)
            indices += [(number, len(feet), 0)] * len(sheet)
            feet += [] if foot is None else [_foot(slider, foot)]
    bilateral = first.contact is None and first.normal == "bilateral" and two_way
    points = np.concatenate(sheets)
    return Contacts(
        start=starts[0],
        sliders=np.array(rows),
        feet=np.array(feet).reshape(-1, lay.FOOT),
        points=points,
        contacts=np.zeros((len(points), lay.CONTACT)),
        indices=np.array(indices, dtype=np.int64),
        law=lay.SPRING if first.contact else lay.BILATERAL if bilateral else lay.PRESCRIBED,
        two_way=two_way,
        normal_two_way=two_way and (first.contact is not None or bilateral),
        following=first.kinematics == "following",
        gravity=first.gravity,
        moving_load=all(s.mu == 0.0 and v is not None for s, v in zip(sliders, prescribed_speeds, strict=True)),
        restitution=first.contact.restitution if first.contact and first.contact.hard else None,
    )


def _foot_points(slider: Slider, foot: Foot) -> Array:
    """Rows of contact points, (points, POINT); of a foot between two beams those below, then those above."""
    contact = slider.contact
    assert contact is not None
    normal, sheet = contact.across(foot.length), np.zeros((foot.points, lay.POINT))
    sheet[:, lay.ARM] = foot.length * ((np.arange(foot.points) + 0.5) / foot.points - 0.5)
    sheet[:, lay.OFFSET] = foot.offset + sheet[:, lay.ARM]
    sheet[:, lay.STIFF], sheet[:, lay.DASHPOT] = normal / foot.points, contact.damping / foot.points
    sheet[:, lay.TANGENTIAL] = contact.along(foot.length) / foot.points
    sheet[:, lay.FACE], sheet[:, lay.IMAGE] = -1.0 if foot.face == "lower" else 1.0, 1.0
    sheet[:, lay.WEIGHT] = 1.0
    if not foot.mirrored:
        return sheet
    sheet[:, lay.WEIGHT] = 0.5
    if normal:
        sheet[:, lay.INSET] = slider.preload / len(slider.feet) / normal
    above = sheet.copy()
    above[:, [lay.FACE, lay.IMAGE]] = -1.0
    return np.concatenate([sheet, above])


def _foot(slider: Slider, foot: Foot) -> list[float]:
    """One row of `Contacts.feet`, at height 0 and at rest."""
    mass, row = slider.moving_mass(foot), [0.0] * lay.FOOT
    inertia = mass * foot.length**2 / 12.0 if foot.inertia is None else foot.inertia
    preload = slider.preload / len(slider.feet)
    force = 0.0 if foot.mirrored else preload if foot.face == "lower" else -preload
    row[lay.INVERSE_FOOT_MASS] = 1.0 / mass
    row[lay.INVERSE_INERTIA] = 1.0 / inertia if foot.pitches and foot.points > 1 else 0.0
    row[lay.FOOT_LOAD] = force - slider.mass * slider.gravity / len(slider.feet)
    row[lay.SPRING_RATE] = slider.preload_stiffness
    return row


def contact_rate(contacts: Contacts, sliders: Sequence[Slider], basis: TimeBasis | None) -> float:
    """Upper bound of the natural frequency of spring contact with all points in contact, rad/s; else 0.

    With two-way coupling it includes the compliance of the beam's modes. A dashpot contributes half its rate, which
    has the same stable step.
    """
    if contacts.law != lay.SPRING or contacts.restitution is not None:
        return 0.0
    p, slider, foot = contacts.points, contacts.indices[:, lay.OF_SLIDER], contacts.indices[:, lay.OF_FOOT]
    feet, along = contacts.feet[foot], np.array([1.0 / one.mass for one in sliders])[slider]
    mobility = feet[:, lay.INVERSE_FOOT_MASS] + p[:, lay.ARM] ** 2 * feet[:, lay.INVERSE_INERTIA]
    if basis is not None:
        places = contacts.start + p[:, lay.OFFSET]
        mobility = mobility + (basis.shapes(places, 0) ** 2).sum(axis=0)
        along = along + p[:, lay.LEVER] ** 2 * (basis.shapes(places, 1) ** 2).sum(axis=0)
    normal = np.bincount(foot, p[:, lay.STIFF] * mobility)
    damped = np.bincount(foot, p[:, lay.DASHPOT] * mobility)
    tangential = np.bincount(slider, p[:, lay.TANGENTIAL] * along)
    return float(max(np.sqrt(normal.max()), damped.max(), np.sqrt(tangential.max())))


def check_sliders(beam: Beam, sliders: Sequence[Slider], starts: Sequence[float]) -> None:
    """Raise InputError for sliders off the beam, across a step of its surface, or of different kinds."""
    feet = [foot for slider in sliders for foot in slider.feet]
    for slider, start in zip(sliders, starts, strict=True):
        span, near = contact_range(beam, start), SLACK * beam.length
        for foot in slider.feet if slider.contact else ():
            first, last = (start + foot.offset + side * foot.length for side in (-0.5, 0.5))
            if first < 0.0 or last > beam.length or first < span.start - near or last > span.end + near:
                step = span.start if first < span.start else span.end
                over = "" if step in (0.0, beam.length) else f" or across the step of beam.section at {written(step)} m"
                raise InputError(
                    f"slider.position = {start!r} m and slider.foot.length = {foot.length!r} m: the foot from "
                    f"{first:.6g} to {last:.6g} m is off the beam{over}, move the slider or shorten the foot"
                )
    check_one_range(beam, starts)
    for name in ("coupling",) if sliders[0].contact else ("coupling", "normal", "kinematics", "line", "gravity"):
        values = {getattr(slider, name) for slider in sliders}
        if len(values) > 1:
            raise InputError(f"slider.{name} differs among sliders on one beam, {sorted(values)!r}: give all the same")
    if len({slider.contact is None for slider in sliders}) > 1:
        raise InputError("slider.contact is missing in some of the sliders on one beam: give it to all, or to none")
    if any(foot.mirrored for foot in feet) and sliders[0].coupling == "two-way":
        for name in ("gravity", "preload_stiffness"):
            if value := max(getattr(slider, name) for slider in sliders):
                raise InputError(f"slider.{name} = {value!r} breaks the mirror symmetry: give 0, or 'one-way'")
        if not all(foot.mirrored for foot in feet):
            raise InputError("slider.foot: some are mirrored and some are not, give all the same, or 'one-way'")
    if any(slider.contact and slider.contact.hard for slider in sliders):
        _check_hard(sliders)


def _check_hard(sliders: Sequence[Slider]) -> None:
    """Raise InputError for options that hard contact does not model."""
    if len(sliders) > 1:
        raise InputError("slider: hard contact takes one slider, give slider.contact.stiffness for several")
    slider, foot = sliders[0], sliders[0].feet[0]
    own = [(name, getattr(slider, name)) for name in ("coupling", "preload_stiffness")]
    own += [(f"foot.{name}", getattr(foot, name)) for name in ("face", "length", "offset", "mirrored")]
    for (name, value), right in zip(own, ("one-way", 0.0, "upper", 0.0, 0.0, False), strict=True):
        if value != right:
            raise InputError(f"slider.{name} = {value!r} with hard contact: give {right!r} or contact.stiffness")
