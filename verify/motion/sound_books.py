"""Books that cannot be: a slider that gave its beam far more than was ever put in, by an error of its step."""

from collections.abc import Sequence
from math import ceil

import msgspec
import numpy as np

from verify.errors import InputError
from verify.models.time_basis import TimeBasis
from verify.motion.request import Request
from verify.motion.result import Ledger
from verify.motion.step_size import gripped_step
from verify.motion.surface import Stage
from verify.slider import Slider

MOST = 10.0
"""A slider gives nothing but what it was given. Ten times that is left to what the books themselves do not see: work
that is summed up in steps, the part of the exact beam beyond its last mode, what carries a tangential slider uphill."""


class Excess(msgspec.Struct, frozen=True):
    """What a slider gave its beam, and all that had been put in, joules."""

    made: float
    put_in: float


def excess_of(ledger: Ledger, had: float, way: float, request: Request, basis: TimeBasis) -> Excess | None:
    """What a slider gave the beam where that is more than MOST times what it and the forces had put in.

    `had` is what it had at the start or fell by, joules, `way` how far it came, metres: only where they decide is
    looked up what its weight can give on such a way.
    """
    made, put_in = ledger.contact_on_beam + ledger.normal_on_beam, abs(ledger.work_in) + had
    if made <= MOST * put_in:
        return None
    assert request.slider is not None
    put_in += passed(basis, request.slider, way) if request.slider.normal == "held" else 0.0
    return None if made <= MOST * put_in else Excess(made, put_in)


def check_books(excess: Excess | None, request: Request, stages: Sequence[Stage]) -> None:
    """Raise InputError for a run in these stages whose slider gave its beam what it never had."""
    if excess is None:
        return
    dt = max(stage.dt for stage in stages)
    if not np.isfinite(excess.put_in):
        raise InputError(
            f"step = {dt:.3g} s: what forces, weight and slider put into the beam is beyond all numbers: give smaller "
            "forces or a lighter slider"
        )
    enough = gripped_step(stages, float("inf"), 0.5 * dt)
    per_period = f", or steps_per_period = {ceil(1.0 / (enough * request.frequency_hz))}" * (request.step is None)
    raise InputError(
        f"step = {dt:.3g} s: the slider gave the beam {_joules(excess.made)}, where forces, weight and what moved at "
        f"first had put in {_joules(excess.put_in)}: in such steps its contact makes energy of modes that turn within "
        f"one; give a step of at most {enough:.2g} s{per_period}, and halve it while this is said"
    )


def passed(basis: TimeBasis, slider: Slider, way: float) -> float:
    """What all that presses the slider on gives on a way over its sag: load times sag, by its slope pi/L, joules."""
    x = np.linspace(0.0, basis.beam.length, 101)
    sags = ((basis.shapes(x, 0) / basis.omegas[:, None]) ** 2).sum(axis=0)
    return float(slider.normal_force**2 * sags.max() * min(np.pi * way / basis.beam.length, 1.0))


def _joules(energy: float) -> str:
    """With its unit; without a number where there is none."""
    return f"{energy:.3g} J" if np.isfinite(energy) else "more than any number of joules"
