"""Arguments of `simulate`: excitation, sliders with prescribed motion, time step, recorded output."""

from collections.abc import Sequence
from math import inf
from typing import Annotated, Any

import msgspec
import numpy as np
from msgspec import Meta
from msgspec.structs import force_setattr

from verify.actuators.on_beam import Mounted
from verify.arrays import Array
from verify.dynamics.excitation import SMOOTH_STEP
from verify.errors import InputError, shown
from verify.linear.positions import Loads, Numbers, as_vector
from verify.problem.beam import PointForce, PointMoment
from verify.problem.slider import Slider
from verify.validation import as_tuple, check_integer, check_number, check_unmasked, unit, validate

SHORTEST = 1e-100
"""Least duration, s, and least growth in periods (a shorter growth is a step): squares do not underflow."""
MOST_SAMPLES = 10_000_000
Envelope = Sequence[tuple[float, Sequence[float]]]
"""Envelope of the forces: pieces (seconds, coefficients of ascending powers of t / seconds)."""


class Excitation(msgspec.Struct, frozen=True):
    """Harmonic excitation of a beam at one frequency, and its growth from rest.

    Forces are amplitude cos(omega t + phase): from rest, phase 0 is a step load. Raises InputError.
    """

    forces: Loads
    """A `PointForce`, a `PointMoment` or several: amplitudes in N or N m, phases in degrees; () for none."""
    frequency_hz: float
    """Common frequency of forces and sources, Hz."""
    soft_start_periods: float = 0.0
    """Periods over which the forces grow as 3 p^2 - 2 p^3."""
    envelope: Envelope = ()
    """Other growth in consecutive pieces (seconds, coefficients): the amplitude has the factor c0 + c1 p + c2 p^2 + ...
    with p from 0 to 1 within the piece; [(0.02, [0, 1])] is linear growth over 20 ms."""
    circuits: Mounted | Sequence[Mounted] = ()
    """Actuators with electrical loads, and sources behind them at `frequency_hz`, whose springs and masses are part of
    the beam (`verify.actuators.on_beam.beam_in_time`)."""

    def __post_init__(self) -> None:
        check_number("frequency_hz", self.frequency_hz, "hertz", above=0)
        check_number("soft_start_periods", self.soft_start_periods, "periods of the drive", at_least=0)
        envelope = _pieces(self.envelope)
        if self.soft_start_periods and envelope:
            one = f"soft_start_periods = {self.soft_start_periods!r}"
            raise InputError(f"{one} and envelope = {shown(envelope)}: give one of the two")
        force_setattr(self, "frequency_hz", float(self.frequency_hz))
        force_setattr(self, "forces", as_tuple("forces", self.forces, PointForce, PointMoment))
        force_setattr(self, "circuits", as_tuple("circuits", self.circuits, Mounted))
        force_setattr(self, "envelope", envelope)

    @property
    def growth(self) -> list[tuple[float, Array]]:
        """Pieces (seconds, coefficients) of the growth of the forces."""
        if self.soft_start_periods >= SHORTEST:
            return [(self.soft_start_periods / self.frequency_hz, SMOOTH_STEP)]
        return [(seconds, np.array(coefficients)) for seconds, coefficients in self.envelope]


def _pieces(envelope: Envelope) -> tuple[tuple[float, tuple[float, ...]], ...]:
    """The pieces of an envelope as tuples of numbers. Raises InputError."""
    check_unmasked("envelope", envelope)
    try:
        pieces = [(float(seconds), np.asarray(c, dtype=float)) for seconds, c in envelope]
        good = all(0.0 < s < inf and c.ndim == 1 and len(c) and np.isfinite(c).all() for s, c in pieces)
    except (TypeError, ValueError):
        pieces, good = [], False
    if not good:
        raise InputError(f"envelope = {shown(envelope)}: give pieces (seconds above 0, finite coefficients)")
    return tuple((seconds, tuple(c.tolist())) for seconds, c in pieces)


class PrescribedSlider(msgspec.Struct, frozen=True):
    """A slider whose speed is prescribed or whose position is fixed. Raises InputError."""

    slider: Slider
    speed: Annotated[float, unit("m/s")] | None = None
    """Prescribed speed along +x, m/s; None: by its equation of motion. With mu = 0 the slider is a moving load, and the
    run continues after it has left the beam."""
    fixed_position: bool = False
    """Whether the position is fixed regardless of the speed, so that the motion is periodic."""

    def __post_init__(self) -> None:
        validate(self, "prescribed_slider")


Sliders = Slider | PrescribedSlider | Sequence[Slider | PrescribedSlider]
"""One slider, free or with prescribed motion, or several."""


def sliders_of(sliders: Sliders | None) -> tuple[PrescribedSlider, ...]:
    """Every slider with its prescribed motion. Raises InputError for other types."""
    items: tuple[Any, ...] = () if sliders is None else as_tuple("slider", sliders, Slider, PrescribedSlider)
    return tuple(one if isinstance(one, PrescribedSlider) else PrescribedSlider(one) for one in items)


class Step(msgspec.Struct, frozen=True):
    """Time step of a slider, by its length or by the least number in a drive period, by default 64, with feet 61.

    Without a length steps also resolve the contact and the modes that the start excites. Raises InputError.
    """

    seconds: Annotated[float, unit("s", gt=0)] | None = None
    """The step, s."""
    per_period: Annotated[int, Meta(ge=1)] | None = None
    """Least number of steps in a drive period."""

    def __post_init__(self) -> None:
        validate(self, "step")
        if self.seconds is not None and self.per_period is not None:
            raise InputError(
                f"step.seconds = {self.seconds!r} and step.per_period = {self.per_period!r}: give one of the two"
            )


class Keep(msgspec.Struct, frozen=True):
    """Recorded output of a run. Raises InputError."""

    at: Numbers = ()
    """Positions of the deflection, (p,), m."""
    samples: int = 201
    """Number of times, evenly spaced on each piece of growth and after it."""

    def __post_init__(self) -> None:
        check_integer("keep.samples", self.samples, 2, MOST_SAMPLES)
        force_setattr(self, "samples", int(self.samples))
        force_setattr(self, "at", tuple(as_vector("keep.at", self.at, "metres").tolist()))
