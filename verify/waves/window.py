"""Whether a window of a beam suits what drives it: two waves of one length alone, enough of them, not too many."""

from collections.abc import Sequence
from itertools import accumulate
from math import inf

import numpy as np

from verify.checks import plain
from verify.errors import InputError, WindowError, shown
from verify.linear.fields import wavenumber
from verify.problem.beam import Beam
from verify.formatting import as_written

MOST_HALVES = 10_000
"""Half wavelengths of the longest window: its points are held at once."""
_PLAIN = ("bending_stiffness", "mass_per_length", "extreme_fibre")
_OF_WAVES: dict[str, tuple[str, ...]] = {
    "euler-bernoulli": _PLAIN,
    "rayleigh": (*_PLAIN, "rotary_inertia"),
    "timoshenko": (*_PLAIN, "rotary_inertia", "shear_stiffness"),
}
"""Of a section: what its waves by a theory and the way of its surface are made of."""


def _own_section(beam: Beam, start: float, end: float, theory: str) -> bool:
    """Whether a stretch of a beam, from and to metres, has the beam's own section alone, as a theory feels it."""
    own, slack, left = beam.own, 1e-9 * beam.length, 0.0
    for piece in beam.pieces:
        right = left + piece.length
        alike = all(getattr(piece, of) == getattr(own, of) for of in _OF_WAVES[theory])
        if not alike and left < end - slack and right > start + slack:
            return False
        left = right
    return True


def _one_section(beam: Beam, start: float, end: float, theory: str) -> bool:
    """Whether a stretch lies on sections that are alike, whichever is written as the beam's own."""
    slack, ends = 1e-9 * beam.length, list(accumulate(piece.length for piece in beam.pieces))
    spans = zip([0.0, *ends[:-1]], ends, beam.pieces, strict=True)
    there = [piece for left, right, piece in spans if left < end - slack and right > start + slack]
    return all(getattr(piece, of) == getattr(there[0], of) for piece in there for of in _OF_WAVES[theory])


def check_window(
    beam: Beam,
    places: list[float],
    frequency_hz: float,
    window: tuple[float, float],
    turning_held: Sequence[float] = (),
    theory: str = "euler-bernoulli",
) -> None:
    """Raise for a window off the span between two neighbouring forces (at `places`) or too short to measure.

    Nor may a device act against turning in it, at `turning_held` (metres). InputError where it is no window of the
    beam at all, WindowError where it does not suit forces or frequency.
    """
    check_span(beam, places, window, turning_held, theory)
    check_halves(beam, frequency_hz, window, theory)


def check_span(
    beam: Beam,
    places: list[float],
    window: tuple[float, float],
    turning_held: Sequence[float] = (),
    theory: str = "euler-bernoulli",
) -> None:
    """Raise for a window off the span between two neighbouring forces, whatever the frequency, as `check_window`."""
    try:
        start, end = (float(end) for end in window)
    except (TypeError, ValueError):
        raise InputError(f"window = {shown(window)}: give start and end in metres, such as [0.1, 0.3]") from None
    window, told = (start, end), as_written((start, end))
    if not (np.isfinite(start) and np.isfinite(end) and 0.0 <= start < end <= beam.length):
        raise InputError(f"window = {told}: give start and end, ascending, between 0 and {beam.length!r} m")
    check_clear(beam, window, f"window = {told}", "choose a window")
    if turned := [p for p in turning_held if start < p < end]:
        raise WindowError(
            f"window = {told} holds a device against turning at {as_written(turned)} m: two waves alone live beside "
            "it, choose a window without one"
        )
    if not _own_section(beam, start, end, theory):
        remedy = ", or give the beam that section's sizes as its own" if _one_section(beam, start, end, theory) else ""
        raise WindowError(
            f"window = {told} holds a beam.section other than the beam's own: waves of one length run along "
            f"one section, choose a window on the beam's own{remedy}"
        )
    places = sorted(places)
    inside = [p for p in places if start < p < end]
    if inside or (len(places) > 1 and not places[0] <= start < end <= places[-1]):
        raise WindowError(
            f"window = {told} leaves the span between two forces (they act at {as_written(places)} m): "
            "two waves alone live there, choose a window inside it"
        )


def check_clear(beam: Beam, span: tuple[float, float], told: str, remedy: str) -> None:
    """Raise WindowError where a mass or a spring of the beam stands inside a span, metres, `told` as it was given."""
    attached = [mass.position for mass in beam.mass] + [spring.position for spring in beam.spring]
    if standing := [p for p in attached if span[0] < p < span[1]]:
        raise WindowError(
            f"{told} holds a mass or a spring at {as_written(standing)} m: two waves alone live beside it, "
            f"{remedy} without one"
        )


def stated_wavenumber(field: str, given: object, span: tuple[float, float]) -> complex:
    """The wavenumber that is stated for the waves of a span, metres, in 1/m.

    Raises InputError for what is none of a wave e^{-ikx} towards +x, and where the span holds less than one of its half
    waves, or too many.
    """
    k = plain(given)
    number = isinstance(k, int | float | complex) and not isinstance(k, bool) and abs(k) < inf
    if not number or not 0.0 <= -k.imag <= k.real or not k.real:
        raise InputError(
            f"{field} = {shown(given)}: give a finite k of e^{{-ikx}} in 1/m, its real part above 0, its imaginary "
            "part at most 0 and no larger than that"
        )
    halves = (span[1] - span[0]) * k.real / float(np.pi)
    if not 1.0 - 1e-9 <= halves <= MOST_HALVES:
        raise InputError(
            f"{field} = {shown(given)} 1/m: {as_written(span)} m hold {halves:.3g} half waves of it, give one of which "
            f"they hold 1 to {MOST_HALVES}"
        )
    return complex(k)


def check_halves(beam: Beam, frequency_hz: float, window: tuple[float, float], theory: str = "euler-bernoulli") -> None:
    """Raise WindowError for a window of a beam that holds too few or too many half wavelengths of a frequency.

    Likewise where the waves are not of one length.
    """
    _check_one_length(beam, frequency_hz, theory)
    check_room(beam, frequency_hz, window, theory)


def check_room(beam: Beam, frequency_hz: float, window: tuple[float, float], theory: str = "euler-bernoulli") -> None:
    """Raise WindowError likewise, whether or not a second pair of waves runs beside the one that is counted."""
    (start, end), told = window, as_written(window)
    k = wavenumber(beam, frequency_hz, theory)
    if beam.foundation and beam.mass_per_length * (2.0 * np.pi * frequency_hz) ** 2 <= beam.foundation:
        least = float(np.sqrt(beam.foundation / beam.mass_per_length) / (2.0 * np.pi))
        raise WindowError(
            f"frequency_hz = {frequency_hz:g}: no wave runs below {least:.6g} Hz on beam.foundation = "
            f"{beam.foundation:g} N/m^2, raise it or soften the ground"
        )
    half = float(np.pi / k.real)
    if end - start < half:
        raise WindowError(f"window = {told} is shorter than half a wavelength ({half:.4g} m): widen it")
    if end - start > MOST_HALVES * half:
        raise WindowError(
            f"window = {told} spans {(end - start) / half:.2g} half wavelengths of {half:.4g} m, more than "
            f"{MOST_HALVES}: narrow it or lower frequency_hz"
        )


def _check_one_length(beam: Beam, frequency_hz: float, theory: str) -> None:
    """Raise WindowError where waves of two lengths run: Timoshenko's, from sqrt(kappa G A / rho I) on."""
    own = beam.own
    if theory != "timoshenko" or own.shear_stiffness is None or not own.rotary_inertia:
        return
    most = float(np.sqrt(own.shear_stiffness / own.rotary_inertia) / (2.0 * np.pi))
    if frequency_hz >= most:
        raise WindowError(
            f"frequency_hz = {frequency_hz:g}: from {most:.6g} Hz on by theory = 'timoshenko' a second pair of waves "
            "runs along the beam, in which its sections swing: the two that are told are not all, lower it"
        )
