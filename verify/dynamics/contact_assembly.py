"""Sliders, their feet and contact points as the arrays of the contact engine."""

from collections.abc import Sequence

import numpy as np

from verify.contact import state
from verify.dynamics.arguments import PrescribedSlider
from verify.dynamics.stepping import Assembly
from verify.errors import InputError, written
from verify.linear.positions import SLACK
from verify.linear.surface import check_one_range, contact_range, section_at
from verify.linear.time_basis import TimeBasis
from verify.problem.beam import Beam
from verify.problem.slider import Foot, Slider


def assemble(beam: Beam, sliders: Sequence[PrescribedSlider], starts: Sequence[float]) -> Assembly:
    """Sliders without transverse motion, feet at height 0.

    A slider without `contact` is one bilateral point; its normal force is prescribed, or includes the reaction of its
    mass (two-way coupling with normal = "bilateral").
    """
    first = sliders[0].slider
    bodies = [_bodies(one, start - starts[0]) for one, start in zip(sliders, starts, strict=True)]
    half, feet = section_at(beam, starts[0]).surface_distance, 0
    for number, (_, own_feet, points) in enumerate(bodies):
        points["slider"] = number
        points["foot"] += feet
        points["lever"] = half * points["face"] * points["image"]
        feet += len(own_feet)
    two_way, springs = first.coupling == "two-way", first.contact is not None
    bilateral = not springs and first.normal == "bilateral" and two_way
    rows, feet_of_all, points = (np.concatenate(arrays) for arrays in zip(*bodies, strict=True))
    return Assembly(
        start=starts[0],
        sliders=rows,
        feet=feet_of_all,
        points=points,
        contacts=np.zeros(len(points), state.CONTACT),
        kind=state.Kind(
            normal_law=state.SPRING if springs else state.BILATERAL if bilateral else state.PRESCRIBED,
            two_way=two_way,
            normal_two_way=two_way and (springs or bilateral),
            several=two_way and len(points) > 1,
            following=first.kinematics == "following",
            gravity=float(first.gravity),
        ),
        moving_load=all(one.slider.mu == 0.0 and one.speed is not None for one in sliders),
        restitution=first.contact.restitution if first.contact and first.contact.hard else None,
    )


def _bodies(prescribed: PrescribedSlider, offset: float) -> tuple[state.Records, state.Records, state.Records]:
    """A slider `offset` from the first, its feet and points, of which the feet are numbered from 0."""
    row, slider, speed = np.zeros(1, state.SLIDER), prescribed.slider, prescribed.speed
    row["v"], row["inverse_mass"] = (slider.speed, 1.0 / slider.mass) if speed is None else (speed, 0.0)
    row["mu"], row["mu_static"] = slider.mu, slider.mu if slider.mu_static is None else slider.mu_static
    row["steepness"], row["external_force"] = slider.steepness or 0.0, slider.external_force
    row["free"] = 0.0 if prescribed.fixed_position else 1.0
    if slider.contact:
        feet = np.concatenate([_foot(slider, foot) for foot in slider.feet])
        sheets = [_foot_points(slider, foot) for foot in slider.feet]
        points = np.concatenate(sheets)
        points["foot"] = np.repeat(np.arange(len(sheets)), [len(sheet) for sheet in sheets])
    else:
        feet, points = np.zeros(0, state.FOOT), np.zeros(1, state.POINT)
        points["face"], points["image"], points["weight"] = 1.0, 1.0, 1.0
        points["load"], points["mass"] = slider.normal_force, slider.mass
    points["offset"] += offset
    points["law"] = np.where(points["tangential_stiffness"] > 0.0, state.ELASTIC, state.LAWS[slider.law])
    return row, feet, points


def _foot_points(slider: Slider, foot: Foot) -> state.Records:
    """Contact points of a foot; of a foot between two beams those below, then those above."""
    contact = slider.contact
    assert contact is not None
    normal, points = contact.across(foot.length), np.zeros(foot.points, state.POINT)
    points["arm"] = foot.length * ((np.arange(foot.points) + 0.5) / foot.points - 0.5)
    points["offset"] = foot.offset + points["arm"]
    points["stiffness"], points["dashpot"] = normal / foot.points, contact.damping / foot.points
    points["tangential_stiffness"] = contact.along(foot.length) / foot.points
    points["face"], points["image"], points["weight"] = -1.0 if foot.face == "lower" else 1.0, 1.0, 1.0
    if not foot.mirrored:
        return points
    points["weight"] = 0.5
    if normal:
        points["inset"] = slider.preload / len(slider.feet) / normal
    above = points.copy()
    above["face"], above["image"] = -1.0, -1.0
    return np.concatenate([points, above])


def _foot(slider: Slider, foot: Foot) -> state.Records:
    """A foot at height 0 and at rest, (1,)."""
    mass, row = slider.moving_mass(foot), np.zeros(1, state.FOOT)
    inertia = mass * foot.length**2 / 12.0 if foot.inertia is None else foot.inertia
    preload = slider.preload / len(slider.feet)
    force = 0.0 if foot.mirrored else preload if foot.face == "lower" else -preload
    row["inverse_mass"] = 1.0 / mass
    row["inverse_inertia"] = 1.0 / inertia if foot.pitches and foot.points > 1 else 0.0
    row["load"] = force - slider.mass * slider.gravity / len(slider.feet)
    row["spring_rate"] = slider.preload_stiffness
    return row


def contact_rate(assembly: Assembly, sliders: Sequence[Slider], basis: TimeBasis | None) -> float:
    """Upper bound of the natural frequency of spring contact with all points in contact, rad/s; else 0.

    With two-way coupling it includes the compliance of the beam's modes. A dashpot contributes half its rate, which
    has the same stable step.
    """
    if not assembly.springs:
        return 0.0
    p, slider, foot = assembly.points, assembly.points["slider"], assembly.points["foot"]
    feet, along = assembly.feet[foot], np.array([1.0 / one.mass for one in sliders])[slider]
    mobility = feet["inverse_mass"] + p["arm"] ** 2 * feet["inverse_inertia"]
    if basis is not None:
        places = assembly.start + p["offset"]
        mobility = mobility + (basis.shapes(places, 0) ** 2).sum(axis=0)
        along = along + p["lever"] ** 2 * (basis.shapes(places, 1) ** 2).sum(axis=0)
    normal = np.bincount(foot, p["stiffness"] * mobility)
    damped = np.bincount(foot, p["dashpot"] * mobility)
    tangential = np.bincount(slider, p["tangential_stiffness"] * along)
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
