"""A figure at a held speed that is withheld: what of it has not settled, and what to do about it."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from verify.patience import VARIABLE

if TYPE_CHECKING:
    from verify.motor.case import MotorCase
    from verify.motor.figures import AtSpeed, Reading
    from verify.slider import Slider


def not_settled(case: "MotorCase", found: "AtSpeed", readings: "Sequence[Reading]", periods: int) -> str:
    """What of these has not settled in at most so many periods, by how much it may be off, and what to do."""
    slider = case.slider
    presses = max(found.normal_force, slider.normal_force)
    told: dict[Reading, str] = {
        "force": f"mean friction {found.force:.4g} +- {found.spread:.1g} N where mu N = {slider.mu * presses:.4g} N",
        "normal force": f"mean normal force {found.normal_force:.4g} +- {found.normal_spread:.1g} N",
        "shares": f"shares of contact and sticking +- {found.share_spread:.1g}",
        "powers": f"rubbed {found.rubbed:.4g} +- {found.power_spread:.1g} W",
    }
    lacking = 2 * found.periods > periods
    longer, give = ("give more periods", "") if lacking else (f"set {VARIABLE} to more seconds", "give ")
    said = ", ".join(told[one] for one in readings if one in found.unsettled)
    if found.crept:
        does = (
            f"what gives way along the surface takes up {100.0 * found.taken_up:.3g} % of the slider's way and has not "
            "all slipped"
        )
        remedy = f"{longer}, or {give}more speed"
    else:
        does = f"the slider {'bounces' if found.bounces else 'stays on the surface,'} and its means have not settled"
        remedy = f"{longer}, {'or ' * bool(give)}{give}{_loss(slider)} or more slider.preload"
    return f"periods = {found.periods!r}: at {found.speed:.6g} m/s {does} by then, {said}: {remedy}"


def _loss(slider: "Slider") -> str:
    """What makes a slider bounce and swing less."""
    hard = slider.contact is not None and slider.contact.hard
    return "less slider.contact.restitution" if hard else "more slider.contact.damping"
