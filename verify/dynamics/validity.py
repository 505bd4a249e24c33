"""Margins of a run: errors that no time step removes."""

from math import pi
from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct

from verify.exact.closed_forms import frequency_hz, wavenumber_length
from verify.exact.error_laws import LAWS, expected_error, leading_error
from verify.linear.field import lossless_wavenumber
from verify.problem.beam import Beam

if TYPE_CHECKING:
    from verify.dynamics.linear_system import Stage

NONLINEAR = 1e-3
"""(kL)^2 <theta^2> from which the linear chain departs from the paper's nonlinear one."""


class Margins(Struct, frozen=True, kw_only=True):
    """Validity of a run; each margin is small where its assumption holds."""

    lift_off: float
    """Largest downward acceleration of the surface over N / m: a free slider lifts off above 1.

    Under a point slider during the run; else the largest of the steady motion along the beam."""
    nonlinearity: float
    """(kL)^2 <theta^2>: the axial inertia of a roller-ended chain that linear theory leaves out."""
    model_form: float | None
    """Timoshenko's frequency over Euler-Bernoulli's at the mode nearest the drive, less 1.

    None unless the beam is uniform, pinned at both ends and carries nothing: there it has a closed form."""
    discretisation: float | None
    """Leading error of the discrete frequency at that mode; None for the exact beam and where no law is known."""
    presliding: float | None = None
    """2 mu kappa / (kappa_t k h): how little a compliant contact slips before it has deformed tangentially. 0 where it
    is rigid along the surface; None without contact springs, and of a compliant one where no wave travels."""
    contact_step: float = 0.0
    """Natural frequency of the contact times the step, radians; its square over 24 is the relative period error."""
    static_deflection: float | None = None
    """Static deflection under sliders with contact, m; left out by one-way coupling. None without such sliders, and of
    a beam with rigid motions that they would move."""


def axial_inertia_size(beam: Beam, frequency_hz: float, mean_square_slope: float) -> float:
    """Nonlinearity of a roller-ended chain of rigid links, (k L)^2 <theta^2>, relative, through its axial inertia.

    k is the wave's under tension and on a foundation, without losses; <theta^2> is the mean over links and time. A
    scale, not a bound: the paper's beam at 4276 Hz, first millisecond from rest, departs at mid-span by 0.6 of it.
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
    """Timoshenko's frequency over Euler-Bernoulli's at the mode nearest the drive, less 1; None without closed form."""
    unknown = any(piece.shear_stiffness is None or piece.rotary_inertia is None for piece in beam.pieces)
    if beam.supports != ("pinned", "pinned") or not beam.uniform or unknown:
        return None
    mode = nearest_mode(beam, drive_hz)
    return frequency_hz(beam, mode, "timoshenko") / frequency_hz(beam, mode) - 1.0


def discretisation(beam: Beam, model: str, count: int | None, drive_hz: float) -> float | None:
    """The leading frequency error of a discrete model at the mode nearest the drive; None where no law is known.

    The whole law for a chain with clamped ends: its leading terms have the wrong sign at practical sizes.
    """
    if count is None or not beam.uniform or model not in LAWS:
        return None
    mode = nearest_mode(beam, drive_hz)
    if wavenumber_length(beam.supports, mode) >= pi * count:
        return None
    if "clamped" in beam.supports and LAWS[model].clamped_terms:
        return expected_error(model, beam, mode, count)
    return leading_error(model, beam.supports, mode, count)


def margins_of(
    beam: Beam, model: str, count: int | None, stage: "Stage", gravity: float, fall: float | None
) -> Margins:
    """Margins of a run with this last stage; `gravity` is N / m of the slider, m/s^2.

    `fall` is the largest downward acceleration of the surface under a point slider in the run, m/s^2.
    """
    hertz, x = stage.omega / (2.0 * pi), np.linspace(0.0, beam.length, 400)
    falling = stage.omega**2 * float(abs(stage.drive_shapes(x, 0)[0]).max()) if fall is None else fall
    square = 0.5 * float((abs(stage.drive_shapes(x, 1)[0]) ** 2).mean())
    return Margins(
        lift_off=falling / gravity if gravity else float("inf"),
        nonlinearity=axial_inertia_size(beam, hertz, square),
        model_form=model_form(beam, hertz),
        discretisation=discretisation(beam, model, count, hertz),
    )
