"""Errors of a run that no step size removes: beam theory, discretisation, linearisation, lift-off."""

from math import pi
from typing import TYPE_CHECKING

import numpy as np

from verify.exact.closed_forms import frequency_hz, wavenumber_length
from verify.exact.error_laws import LAWS, expected_error, leading_error
from verify.linear.field import lossless_wavenumber
from verify.motion.contact import Margins
from verify.problem.beam import Beam
from verify.problem.slider import GRAVITY

if TYPE_CHECKING:
    from verify.motion.request import Request
    from verify.motion.surface import Stage

NONLINEAR = 1e-3
"""From this (kL)^2 <theta^2> on, the linear chain is not the paper's chain."""


def axial_inertia_size(beam: Beam, frequency_hz: float, mean_square_slope: float) -> float:
    """How nonlinear a roller-ended chain of rigid links is: (k L)^2 <theta^2>, relative, through its axial inertia.

    k is that of a wave under tension and on a foundation, without losses, its size where none travels; <theta^2> is the
    mean over the links and over time. A scale, not a bound: on the paper's beam at 4276 Hz the first
    millisecond from rest departs from the linear chain at mid-span by 0.6 of it in the rms, and by 3 at its end; at the
    tenths of the beam that end lies between 0.4 and 3.8 (the study of axial inertia).
    """
    return float(abs(lossless_wavenumber(beam, frequency_hz)) ** 2 * beam.length**2 * mean_square_slope)


def nearest_mode(beam: Beam, drive_hz: float) -> int:
    """The exact mode whose frequency lies nearest a drive's."""
    turns = (2.0 * pi * drive_hz / beam.wave_constant) ** 0.5 * beam.length / pi
    mode = max(int(turns) - 1, 1)
    while frequency_hz(beam, mode) < drive_hz:
        mode += 1
    below = frequency_hz(beam, mode - 1) if mode > 1 else 0.0
    return mode - 1 if mode > 1 and drive_hz - below < frequency_hz(beam, mode) - drive_hz else mode


def model_form(beam: Beam, drive_hz: float) -> float | None:
    """Timoshenko's frequency over Euler-Bernoulli's at the mode nearest the drive, less 1.

    None without closed form, and of a section given plainly whose shear stiffness or rotary inertia nobody has said.
    """
    if beam.supports != ("pinned", "pinned") or not beam.uniform:
        return None
    if any(piece.shear_stiffness is None or piece.rotary_inertia is None for piece in beam.pieces):
        return None
    mode = nearest_mode(beam, drive_hz)
    return frequency_hz(beam, mode, "timoshenko") / frequency_hz(beam, mode) - 1.0


def discretisation(beam: Beam, model: str, count: int | None, drive_hz: float) -> float | None:
    """The leading frequency error of a discrete model at the mode nearest the drive; None where no law knows it.

    Of a chain with clamped ends the whole law: its leading terms have the wrong sign at practical sizes.
    """
    if count is None or not beam.uniform or model not in LAWS:
        return None
    mode = nearest_mode(beam, drive_hz)
    if wavenumber_length(beam.supports, mode) >= pi * count:
        return None
    if "clamped" in beam.supports and LAWS[model].clamped_terms:
        return expected_error(model, beam, mode, count)
    return leading_error(model, beam.supports, mode, count)


def margins_of(request: "Request", stage: "Stage", fall: float | None = None) -> Margins:
    """Margins of a run whose last stage this is.

    `fall` is the largest downward acceleration of the surface under the slider in the run, m/s^2; without a slider
    the largest of the steady motion along the beam.
    """
    x = np.linspace(0.0, request.beam.length, 400)
    steady, slopes = stage.drive_shapes(x, 0)[:2], stage.drive_shapes(x, 1)[:2]
    falling = request.omega**2 * float(np.hypot(*steady).max()) if fall is None else fall
    pressing = request.slider.effective_gravity if request.slider else GRAVITY
    square = 0.5 * float((slopes**2).sum(axis=0).mean())
    return Margins(
        lift_off=falling / pressing if pressing else float("inf"),
        nonlinearity=axial_inertia_size(request.beam, request.frequency_hz, square),
        model_form=model_form(request.beam, request.frequency_hz),
        discretisation=discretisation(request.beam, request.model, request.count, request.frequency_hz),
    )
