"""What a wave runs in: a beam by a theory, and how its section turns with its slope."""

from typing import Any

import msgspec
import numpy as np

from verify.problem.beam import Beam


class Medium(msgspec.Struct, frozen=True):
    """A beam's own section by a theory."""

    beam: Beam
    theory: str = "euler-bernoulli"

    def turn(self, omega: Any) -> Any:
        """The turn of the section over the slope of the line in a running wave: 1 where nothing shears.

        kappa G A (w'' - psi') + (rho A omega^2 - k_f) w = 0 with w'' = -k^2 w (Timoshenko, Phil. Mag. 41, 1921);
        complex where the beam has losses.
        """
        shear = self.beam.own.shear_stiffness
        if self.theory != "timoshenko" or shear is None:
            return 1.0
        from verify.linear.fields import wavenumber

        hertz = np.asarray(omega) / (2.0 * np.pi)
        k2 = np.vectorize(lambda f: wavenumber(self.beam, float(f), self.theory) ** 2)(hertz)
        loss = self.beam.loss_factor
        held = shear * (1.0 + 1j * loss) * k2 if loss else shear * k2.real
        return 1.0 - (self.beam.mass_per_length * omega**2 - self.beam.foundation) / held

    def beside_shear(self, omega: Any) -> Any:
        """What axial force and rotary inertia add to EI psi'' in the force across, times the slope, newton."""
        turning = (self.beam.own.rotary_inertia or 0.0) * omega**2 if self.theory != "euler-bernoulli" else 0.0
        return turning * self.turn(omega) - self.beam.tension
