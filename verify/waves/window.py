"""Checks of windows for the two-wave fit: no force, device or attachment inside, at least half a wavelength."""

from collections.abc import Sequence

import numpy as np

from verify.errors import InputError, WindowError, shown
from verify.formatting import as_written
from verify.linear.field import wavenumber
from verify.problem.beam import Beam
from verify.validation import check_type, python_scalar

Window = tuple[float, float]
MOST_HALVES = 10_000  # Largest number of half wavelengths in a window, limited by memory
_SECTION = ("bending_stiffness", "mass_per_length", "extreme_fibre", "rotary_inertia", "shear_stiffness")
_DEPENDS = {"euler-bernoulli": _SECTION[:3], "rayleigh": _SECTION[:4], "timoshenko": _SECTION}
"""Section properties on which waves and surface motion depend, by theory."""


def middle_half(beam: Beam) -> Window:
    """The default window [L/4, 3L/4], m."""
    check_type("beam", beam, Beam)
    return 0.25 * beam.length, 0.75 * beam.length


def check_span(
    beam: Beam,
    positions: Sequence[float],
    window: Window,
    couples: Sequence[float] = (),
    theory: str = "euler-bernoulli",
) -> None:
    """Raise WindowError for a window with a force, a couple, an attachment or a step inside.

    `positions` of forces, `couples` of devices against rotation, m. Raises InputError for a window off the beam.
    """
    try:
        start, end = (float(end) for end in window)
    except (TypeError, ValueError):
        raise InputError(f"window = {shown(window)}: give start and end in metres, such as [0.1, 0.3]") from None
    name = f"window = {as_written((start, end))}"
    if not (np.isfinite(start) and np.isfinite(end) and 0.0 <= start < end <= beam.length):
        raise InputError(f"{name}: give start and end, ascending, between 0 and {beam.length!r} m")
    check_clear(beam, (start, end), name)
    if inside := [p for p in couples if start < p < end]:
        raise WindowError(
            f"{name} contains a moment, an end of a patch or a device against rotation, at {as_written(inside)} m: "
            "choose another"
        )
    edges = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    for left, right, piece in zip(edges, edges[1:], beam.pieces, strict=False):
        alike = all(getattr(piece, name) == getattr(beam.base_section, name) for name in _DEPENDS[theory])
        if not alike and left < end - 1e-9 * beam.length and right > start + 1e-9 * beam.length:
            raise WindowError(
                f"{name} contains a beam.section that differs from the beam's own section: choose a window on the own "
                "section, or give the beam the sizes of that section"
            )
    positions = sorted(positions)
    if any(start < p < end for p in positions) or (
        len(positions) > 1 and not positions[0] <= start < end <= positions[-1]
    ):
        raise WindowError(
            f"{name} is not between two neighbouring forces (at {as_written(positions)} m): choose a window between "
            "two of them"
        )


def check_clear(beam: Beam, span: Window, name: str) -> None:
    """Raise WindowError for a mass or a spring of the beam inside a span, m; `name` of the span for the message."""
    if inside := [one.position for one in beam.attached if span[0] < one.position < span[1]]:
        raise WindowError(f"{name} contains a mass or a spring at {as_written(inside)} m: choose a window without it")


def check_waves(beam: Beam, frequency_hz: float, window: Window, theory: str = "euler-bernoulli") -> None:
    """Raise WindowError below cut-on, for a second pair of waves, and for too few or many half wavelengths."""
    own, (start, end) = beam.base_section, window
    if theory == "timoshenko" and own.shear_stiffness is not None and own.rotary_inertia:
        second = float(np.sqrt(own.shear_stiffness / own.rotary_inertia) / (2.0 * np.pi))
        if frequency_hz >= second:
            raise WindowError(
                f"frequency_hz = {frequency_hz:g}: from {second:.6g} Hz on theory = 'timoshenko' has a second pair of "
                "propagating waves, lower it"
            )
    least = float(np.sqrt(beam.foundation / beam.mass_per_length) / (2.0 * np.pi))
    if beam.foundation and frequency_hz <= least:
        raise WindowError(
            f"frequency_hz = {frequency_hz:g}: no wave propagates below {least:.6g} Hz on beam.foundation = "
            f"{beam.foundation:g} N/m^2, raise the frequency or lower the foundation"
        )
    half, name = float(np.pi / wavenumber(beam, frequency_hz, theory).real), f"window = {as_written(window)}"
    if end - start < half:
        raise WindowError(f"{name} is shorter than half a wavelength ({half:.4g} m): widen it")
    if end - start > MOST_HALVES * half:
        raise WindowError(f"{name} is longer than {MOST_HALVES} half wavelengths ({half:.4g} m): narrow it")


def check_wavenumber(name: str, value: object, span: Window) -> complex:
    """A prescribed wavenumber of waves e^{-ikx} in a span (m), 1/m.

    Raises InputError for a wave that does not propagate towards +x, and for too few or many half wavelengths.
    """
    k = python_scalar(value)
    number = isinstance(k, int | float | complex) and not isinstance(k, bool) and np.isfinite(k)
    if not number or not 0.0 <= -k.imag <= k.real or not k.real:
        raise InputError(
            f"{name} = {shown(value)}: give a finite k of e^{{-ikx}} in 1/m, Re k > 0 and -Re k <= Im k <= 0"
        )
    halves = (span[1] - span[0]) * k.real / float(np.pi)
    if not 1.0 - 1e-9 <= halves <= MOST_HALVES:
        raise InputError(
            f"{name} = {shown(value)} 1/m: {halves:.3g} half waves in {as_written(span)} m, give 1 to {MOST_HALVES}"
        )
    return complex(k)
