"""Whether the beam feels a slider that may leave it: what all that presses it on moves the surface by."""

import numpy as np

from verify.beam import Beam
from verify.motion.contact import FELT, Coupling
from verify.slider import Slider


def sizes(
    slider: Slider, beam: Beam, omega: float, moved: float, turned: float, receptance: complex
) -> tuple[float, float | None]:
    """What the slider's whole load moves the surface by, over what the drive moves: (across, by friction along).

    `moved` (metres) and `turned` are the drive's amplitudes of deflection and slope under it, `receptance` G(x, x) in
    m/N. Friction is a moment (h/2) mu N on an infinite beam. Along, None where the drive does not turn the surface.
    """
    lever, k = beam.surface_distance, float(np.sqrt(omega / beam.wave_constant))
    rub = slider.mu * slider.normal_force * lever**2 * np.sqrt(2.0) * omega / (4.0 * beam.bending_stiffness * k)
    across = slider.normal_force * abs(receptance) / moved if moved else np.inf
    return float(across), float(rub / (lever * omega * turned)) if turned else None


def coupled(slider: Slider, across: float, along: float | None) -> Coupling:
    """One-way or two-way by these sizes, unless the slider says which."""
    choice = slider.coupling
    return Coupling(
        two_way=choice == "two-way" if choice != "auto" else along is None or max(along, across) > FELT,
        friction_size=along,
        normal_size=across,
        normal="held",
        forced=choice != "auto",
    )


def in_words(coupling: Coupling) -> str:
    """Both sizes."""
    along = "" if coupling.friction_size is None else f", its friction by {coupling.friction_size:.1e} of its speed"
    return f"all that presses the slider on moves the surface by {coupling.normal_size:.1e} of its motion{along}"
