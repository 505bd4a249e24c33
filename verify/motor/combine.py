"""Combinations of slider, field and coupling that `run_motor` refuses."""

from collections.abc import Sequence

from verify.errors import InputError
from verify.problem.slider import Slider

CHAIN = "chain"
"""Name of the nonlinear chain beside the linear models."""


def check_together(model: str, start: str, sliders: Sequence[Slider]) -> None:
    """Raise InputError for no slider, one that does not combine with the field, or several that do not go together."""
    if not sliders:
        raise InputError("sliders is empty: give one or more")
    for slider in sliders:
        check_combines(model, start, slider)
    kinds = {any(foot.mirrored for foot in slider.feet) for slider in sliders}
    if len(kinds) > 1 and sliders[0].coupling != "one-way":
        raise InputError("sliders: some are between two beams and some on one, coupled two-way: give all the same")
    for name, own in (("law", "law"), ("slope", "steepness"), ("coupling", "coupling")):
        found = {getattr(slider, own) for slider in sliders}
        if len(found) > 1:
            raise InputError(f"slider.{name} differs among sliders on one beam, {sorted(found)!r}: give all the same")
    if len(sliders) > 1 and any(slider.contact and slider.contact.hard for slider in sliders):
        raise InputError("sliders: a hard contact is of one slider by itself, give slider.contact.stiffness")


def check_combines(model: str, start: str, slider: Slider) -> None:
    """Raise InputError for a slider that is not run on this field with this coupling."""
    contact, mirrored = slider.contact, [foot.mirrored for foot in slider.feet]
    if contact is None:
        raise InputError("slider.contact is missing: run_motor takes it, a slider that never leaves runs in simulate")
    for name in ("tangential_stiffness", "layer_tangential_stiffness"):
        if slider.law != "coulomb" and (give := getattr(contact, name)) is not None:
            raise InputError(
                f"slider.law = {slider.law!r} with slider.contact.{name} = {give!r}: tangential stiffness slips at "
                "mu N, give law = 'coulomb' or leave the stiffness out"
            )
    if model == CHAIN and slider.coupling != "one-way":
        raise InputError(
            f"slider.coupling = {slider.coupling!r} on a nonlinear chain, which moves first: give 'one-way'"
        )
    if contact.hard:
        _check_hard(model, start, slider)
    elif any(mirrored) and slider.coupling != "one-way":
        for name in ("gravity", "preload_stiffness"):
            if value := getattr(slider, name):
                raise InputError(
                    f"slider.{name} = {value!r} with slider.foot.mirrored and two-way coupling: the beams would not "
                    "stay mirror images, give 0, or coupling = 'one-way'"
                )
        if not all(mirrored):
            raise InputError("slider.foot: some are mirrored and some are not, give all the same, or 'one-way'")


def _check_hard(model: str, start: str, slider: Slider) -> None:
    """Raise InputError for what a hard contact is not run with."""
    if slider.coupling != "one-way":
        raise InputError(
            f"slider.coupling = {slider.coupling!r} with a hard contact, whose impacts excite all modes: give "
            "'one-way', or slider.contact.stiffness"
        )
    if model == CHAIN or start != "steady":
        raise InputError(
            f"start = {start!r} on model = {model!r} with a hard contact: give start = 'steady' of a linear model, or "
            "slider.contact.stiffness"
        )
    if slider.preload_stiffness:
        raise InputError(
            f"slider.preload_stiffness = {slider.preload_stiffness!r} with a hard contact, which flies under a "
            "constant force: give preload alone, or slider.contact.stiffness"
        )
    foot = slider.feet[0]
    for name, right in (("face", "upper"), ("length", 0.0), ("offset", 0.0), ("mirrored", False)):
        if (value := getattr(foot, name)) != right:
            raise InputError(
                f"slider.foot.{name} = {value!r} with a hard contact, which is a point on the upper face: leave it out"
            )
