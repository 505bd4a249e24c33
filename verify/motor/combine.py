"""What combines with what under a slider that may leave the surface; the rest is refused by name."""

from collections.abc import Sequence
from itertools import product
from typing import TYPE_CHECKING

from verify.errors import InputError
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.motor.result import MotorState

CHAIN = "chain"
"""The nonlinear chain as a field under a slider, beside the linear models by their names."""
CREEPS = "a layer that gives way along the surface sticks and slips by Coulomb's law"


def check_together(model: str, start: str, sliders: Sequence[Slider]) -> None:
    """Raise InputError for no slider, one that does not combine with the field, or several that do not go together."""
    if not sliders:
        raise InputError("sliders is empty: give one or more")
    for slider in sliders:
        check_combines(model, start, slider)
    kinds = {any(foot.mirrored for foot in slider.feet) for slider in sliders}
    if len(kinds) > 1 and sliders[0].coupling != "one-way":
        raise InputError("sliders: some are between two beams and some on one, which feels them: give all the same")
    for name, own in (("law", "law"), ("slope", "steepness"), ("coupling", "coupling")):
        found = {getattr(slider, own) for slider in sliders}
        if len(found) > 1:
            raise InputError(f"slider.{name} differs among sliders on one beam, {sorted(found)!r}: give all the same")
    if len(sliders) > 1 and any(slider.contact and slider.contact.hard for slider in sliders):
        raise InputError("sliders: a hard contact is of one slider by itself, give slider.contact.stiffness")


def check_goes_on(model: str, before: Sequence["MotorState"]) -> None:
    """Raise InputError for a run that goes on, on a nonlinear chain or from one: it starts at rest, none is kept."""
    if before and model == CHAIN:
        raise InputError(
            "continue_from on a nonlinear chain, which starts at rest: leave it out, and give a longer time"
        )
    if any(state.model == CHAIN for state in before):
        raise InputError(
            "continue_from is a run on a nonlinear chain, whose motion is not kept: give one on a linear model"
        )


def check_combines(model: str, start: str, slider: Slider) -> None:
    """Raise InputError, saying what to change, for a slider, a field and a coupling that are not run together."""
    contact = slider.contact
    if contact is None:
        raise InputError(
            "slider.contact is missing: a slider that may leave the surface needs it; one that never does is run by "
            "simulate"
        )
    if contact.hard:
        _check_hard(model, start, slider)
    for name in ("tangential_stiffness", "layer_tangential_stiffness"):
        if slider.law != "coulomb" and (give := getattr(contact, name)) is not None:
            raise InputError(
                f"slider.law = {slider.law!r} with slider.contact.{name} = {give!r}: what gives way along the surface "
                "sticks until it slips at mu N, give law = 'coulomb' or leave the stiffness out"
            )
    if model == CHAIN and slider.coupling != "one-way":
        raise InputError(
            f"slider.coupling = {slider.coupling!r} on a nonlinear chain, which moves first: give 'one-way'"
        )
    mirrored = [foot.mirrored for foot in slider.feet]
    if any(mirrored) and contact.hard:
        raise InputError("slider.foot.mirrored with a hard contact: give slider.contact.stiffness")
    if any(mirrored) and slider.coupling != "one-way":
        _check_symmetric(slider, all(mirrored))


def _check_symmetric(slider: Slider, all_mirrored: bool) -> None:
    """Raise InputError for two beams that feel a slider between them and would not stay each other's mirror image."""
    for name, value, right in (("gravity", slider.gravity, 0.0), ("preload_stiffness", slider.preload_stiffness, 0.0)):
        if value != right:
            raise InputError(
                f"slider.{name} = {value!r} with slider.foot.mirrored and beams that feel the slider: they would not "
                "stay each other's mirror image, give 0, or coupling = 'one-way'"
            )
    if not all_mirrored:
        raise InputError(
            f"slider.foot: some are mirrored and some are not, with coupling = {slider.coupling!r}: make all of them "
            "mirrored, or give 'one-way'"
        )


def _check_hard(model: str, start: str, slider: Slider) -> None:
    """Raise InputError for what a hard contact is not run with."""
    if slider.coupling != "one-way":
        raise InputError(
            f"slider.coupling = {slider.coupling!r} with a hard contact, whose blows a beam of rigid parts answers "
            "without end: give 'one-way', or slider.contact.stiffness"
        )
    if model == CHAIN or start != "steady":
        raise InputError(
            f"start = {start!r} on model = {model!r} with a hard contact, which needs the surface between steps: give "
            "start = 'steady' of a linear model, or slider.contact.stiffness"
        )
    if slider.preload_stiffness:
        raise InputError(
            f"slider.preload_stiffness = {slider.preload_stiffness!r} with a hard contact, it flies under a constant "
            "force: give preload alone, or slider.contact.stiffness"
        )
    foot = slider.feet[0]
    for name, right in (("face", "upper"), ("length", 0.0), ("offset", 0.0)):
        if (value := getattr(foot, name)) != right:
            raise InputError(
                f"slider.foot.{name} = {value!r} with a hard contact, which is a point on the upper face: leave it out"
            )


def combinations() -> tuple[tuple[str, str, str, str, str, str], ...]:
    """Every cell: (field, friction, normal, slider, coupling, how it is run or why it is not)."""
    cells = product(
        ("analytic", "segment", "fem", CHAIN),
        ("tanh", "coulomb"),
        ("always on", "springs", "hard"),
        ("point", "foot", "layer"),
        ("one-way", "two-way"),
    )
    return tuple((*cell, _run_by(*cell)) for cell in cells)


def _run_by(field: str, friction: str, normal: str, shape: str, coupling: str) -> str:
    if field == CHAIN and coupling == "two-way":
        return "refused: a nonlinear chain carries a slider one way"
    if normal == "springs":
        creeps = shape == "layer" and friction != "coulomb"
        return f"refused: {CREEPS}" if creeps else "run_motor"
    if shape != "point":
        held = "stays on a curved surface at one point alone" if normal == "always on" else "lands at one point alone"
        return f"refused: a rigid foot {held}"
    if normal == "always on":
        return "chain.ride" if field == CHAIN else "simulate"
    if field == CHAIN or coupling == "two-way":
        return "refused: a hard contact is of a steady linear beam that does not feel it"
    return "run_motor"
