"""The waveguide of bending waves, a beam's own section by a beam theory: crest speed and energy flux of two waves."""

from typing import Any

import msgspec
import numpy as np

from verify.linear.field import wavenumber
from verify.problem.beam import Beam


class Waveguide(msgspec.Struct, frozen=True):
    """A beam's own section by a theory. All methods take arrays as well."""

    beam: Beam
    theory: str = "euler-bernoulli"

    def rotation_ratio(self, omega: Any) -> Any:
        """Rotation of the section over the slope of the line in a travelling wave: 1 without shear.

        kappa G A (w'' - psi') + (rho A omega^2 - k_f) w = 0 with w'' = -k^2 w (Timoshenko, Phil. Mag. 41, 1921);
        complex with losses.
        """
        shear, loss = self.beam.own.shear_stiffness, self.beam.loss_factor
        if self.theory != "timoshenko" or shear is None:
            return 1.0
        hertz = np.asarray(omega) / (2.0 * np.pi)
        k2 = np.vectorize(lambda f: wavenumber(self.beam, float(f), self.theory) ** 2)(hertz)
        resisted = shear * (1.0 + 1j * loss) * k2 if loss else shear * k2.real
        return 1.0 - (self.beam.mass_per_length * omega**2 - self.beam.foundation) / resisted

    def axis_ratio(self, omega: Any, k: Any) -> Any:
        """Width over height of the surface ellipse of a pure wave, r = (k h/2) psi/w'."""
        return np.real(k * self.rotation_ratio(omega)) * self.beam.surface_distance

    def crest_speed(self, omega: Any, k: Any, forward: Any, backward: Any) -> Any:
        """Velocity of the surface along +x at the crests of both waves, m/s.

        When w at a point is largest, u_x changes at omega S3 / (2 |w|). S3 = -2 r (|A+|^2 - |A-|^2) is constant; with
        the rms sqrt(|A+|^2 + |A-|^2) of |w| that is -omega r (|A+|^2 - |A-|^2) / sqrt(|A+|^2 + |A-|^2).
        """
        plus, minus = abs(forward) ** 2, abs(backward) ** 2
        return -omega * self.axis_ratio(omega, k) * (plus - minus) / np.sqrt(plus + minus)

    def energy_flux(self, omega: Any, k: Any, forward: Any, backward: Any) -> Any:
        """Power that both waves carry towards +x, W, at the point to which their amplitudes refer.

        Transverse force times velocity and moment times angular velocity, 1/2 Re, with EI (1 + i eta); undamped
        EI k^3 omega (|A+|^2 - |A-|^2). Axial force and rotary inertia contribute to the transverse force.
        """
        beam, k = self.beam, np.asarray(k, dtype=complex)
        deflection, slope, ratio = forward + backward, 1j * k * (backward - forward), self.rotation_ratio(omega)
        stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor) * ratio
        inertia = (beam.own.rotary_inertia or 0.0) * omega**2 if self.theory != "euler-bernoulli" else 0.0
        force = stiffness * 1j * k**3 * (forward - backward) + (inertia * ratio - beam.tension) * slope
        couple = stiffness * k**2 * deflection
        return 0.5 * np.real(force * np.conj(1j * omega * deflection) + couple * np.conj(1j * omega * ratio * slope))
