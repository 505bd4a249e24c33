"""Beams that are pulled at, lie on ground, turn or are graded, solved together, against each of them alone."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import PLAIN, SECTIONS

PARTS, MODES, BEAMS = 13, 3, 5
END, START = PointSpring(position=0.61, rotational=2.6), PointSpring(position=0.0, rotational=1.7)
RAYLEIGH: dict[str, Any] = {"theory": "rayleigh"}
CARRYING: tuple[tuple[Beam, dict[str, Any]], ...] = (
    (replace(PLAIN, tension=37.0, foundation=2100.0, section=SECTIONS), {"grading": 1.6}),
    (replace(PLAIN, section=SECTIONS, supports=("guided", "pinned")), RAYLEIGH),
    (replace(PLAIN, tension=21.0, spring=(END,), supports=("clamped", "pinned")), {}),
    (replace(PLAIN, foundation=900.0, supports=("free", "guided")), RAYLEIGH | {"grading": 0.7}),
    (replace(PLAIN, tension=9.0, spring=(START,), supports=("pinned", "clamped")), {}),
)


def together_error(model: str) -> Callable[[float], float]:
    """Case -> worst difference between five beams together and alone, and how many do not settle together."""

    def error(number: float) -> float:
        from verify.models.catalogue import MODELS
        from verify.models.stacks import lowest_of_each

        beam, settings = CARRYING[int(number)]
        several = [_scaled(beam, 1.0 + 0.06 * i) for i in range(BEAMS)]
        room = "elements" if model == "fem" else "segments"
        together = import_module(f"verify.{room}.sweeps").sweep_modes(several, MODES, PARTS, **settings)
        alone = [MODELS[model].solve_modes(one, MODES, PARTS, **settings) for one in several]
        exact = np.array([modes.frequencies_hz for modes in alone])
        values, sure = lowest_of_each(_stack_of(model, several, settings), MODES)
        ratios = np.sqrt(values).T * _units(several) / exact
        left = float((~np.asarray(sure)).sum())
        return largest(float(abs(together / exact - 1.0).max()), float(abs(ratios - 1.0).max()), left)

    return error


def _units(beams: list[Beam]) -> Array:
    """Hz of an omega of 1 in units of a part, (n_beams, 1)."""
    from math import pi

    return np.array([beam.wave_constant * (PARTS / beam.length) ** 2 / (2.0 * pi) for beam in beams])[:, None]


def _stack_of(model: str, beams: list[Beam], settings: dict[str, Any]) -> Any:
    """The stack. Raises ArithmeticError where beams are not of one layout."""
    grading, theory = settings.get("grading", 1.0), settings.get("theory", "euler-bernoulli")
    if model == "fem":
        from verify.elements.stacks import element_stack, layout

        shared = {layout(beam, PARTS, grading, theory) for beam in beams}
        stack = element_stack(beams, PARTS, grading, theory)
    else:
        from verify.segments import stacks
        from verify.segments.linear import settings_of

        given = settings_of("gregory", "series", grading, theory, "reciprocal")
        shared = {stacks.layout(beam, **given) for beam in beams}
        stack = stacks.chain_stack(beams, PARTS, given)
    if len(shared) != 1 or None in shared:
        raise ArithmeticError("beams that are alike are not taken together")
    return stack


def _scaled(beam: Beam, part: float) -> Beam:
    """The same, more or less pulled at, stiff and held."""
    spring = tuple(replace(one, rotational=one.rotational / part) for one in beam.spring)
    own: dict[str, Any] = {"bending_stiffness": (beam.bending_stiffness or 1.0) * part}
    if beam.section:
        first = beam.section[0]
        turning = (first.rotary_inertia or 0.0) * part
        own = {"section": (replace(first, bending_stiffness=3.1 * part, rotary_inertia=turning), *beam.section[1:])}
    return replace(beam, spring=spring, tension=beam.tension * part**2, foundation=beam.foundation / part, **own)


ROWS: tuple[Row, ...] = tuple(
    Floor(
        id=f"carrying-beams-at-once-{'elements' if model == 'fem' else 'segments'}",
        title="Five beams with tension, ground, sections, turning, grading in one call, against each by itself",
        why="models/stacks.py: each as right as if it had been asked for alone.",
        along="case",
        at=(0, 1, 2, 3, 4),
        promise=1e-11,
        error=together_error(model),
    )
    for model in ("fem", "segment")
)
