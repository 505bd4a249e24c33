"""Which errors a run carries that no step size removes: the theory's and the division's."""

from math import pi

from verify.beam import Beam
from verify.closed_forms import frequency_hz
from verify.error_laws import leading_error


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
    if beam.supports != ("pinned", "pinned") or beam.stepped:
        return None
    mode = nearest_mode(beam, drive_hz)
    return frequency_hz(beam, mode, "timoshenko") / frequency_hz(beam, mode) - 1.0


def discretisation(beam: Beam, model: str, count: int | None, drive_hz: float) -> float | None:
    """The leading frequency error of a discrete model at the mode nearest the drive; None for the exact beam."""
    if count is None or beam.stepped:
        return None
    return leading_error(model, beam.supports, nearest_mode(beam, drive_hz), count)
