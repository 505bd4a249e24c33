"""The steady motion of a beam under harmonic forces, at one frequency or at many."""

from collections.abc import Callable, Sequence
from math import sqrt
from typing import Any

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.formatting import one_line
from verify.linear.positions import Numbers, positions_on, reshape_like
from verify.problem.beam import Beam, PointForce, PointLoad, PointMoment
from verify.problem.device import Device


class HarmonicField(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Steady motion Re(w(x) e^{+i omega t}) of one model under harmonic point forces.

    With an array of frequencies every result has a leading axis of that length.
    """

    model: str
    """Name of the model."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    beam: Beam
    frequency_hz: float | Array
    """Drive frequency, Hz: a number, or (n_frequencies,)."""
    forces: tuple[PointForce, ...]
    """Transverse point forces on the beam, N: the drive and, for a single frequency, the reactions of devices and
    imposed displacements."""
    shapes: Callable[[Array, int], ComplexArray]
    """(x, derivative) -> (len(x),), or (n_frequencies, len(x)), in metres per metre^derivative."""
    theory: str = "euler-bernoulli"
    rotation_shapes: Callable[[Array, int], ComplexArray] | None = None
    """Section rotation psi with the arguments of `shapes`, rad; None where it is the slope w'."""
    edges: Array | None = None
    """Ends of the pieces on which the deflection of a discrete model is a polynomial, m; None of the exact beam."""
    couples: tuple[float, ...] = ()
    """Positions of moments and of devices against rotation, m, whose couples are not in `forces`."""
    conjugate: Callable[[PointLoad], complex] | None = None
    """`displacement`, single frequency; None where it is the deflection or the rotation of the section."""
    __repr__ = one_line(model="", count="", frequency_hz="Hz", theory="")

    @property
    def omega(self) -> float:
        """2 pi f, rad/s; single frequency only."""
        return 2.0 * np.pi * float(self.frequency_hz)

    @property
    def wavenumber(self) -> complex:
        """Wavenumber of the exact beam by the same theory, 1/m; its imaginary part is never positive."""
        return wavenumber(self.beam, float(self.frequency_hz), self.theory)

    def deflection(self, x: Numbers) -> ComplexArray:
        """Complex deflection at x (m), (*shape of x), m; (1,) for a number. Raises InputError off the beam."""
        return self.derivative(x, 0)

    def slope(self, x: Numbers) -> ComplexArray:
        """Complex slope at x (m), of the same shape, rad. Raises InputError off the beam."""
        return self.derivative(x, 1)

    def derivative(self, x: Numbers, order: int) -> ComplexArray:
        """A derivative of the deflection at x (m), of the same shape, m per m^order. Raises InputError."""
        return reshape_like(self.shapes(positions_on("x", x, self.beam.length).ravel(), order), x)

    def rotation(self, x: Numbers) -> ComplexArray:
        """Complex rotation of the section at x (m), of the same shape, rad: w' without shear. Raises InputError."""
        return reshape_like(self.rotations(positions_on("x", x, self.beam.length).ravel(), 0), x)

    def displacement(self, load: PointLoad) -> complex:
        """Displacement on which a load does work: deflection at a force, m, rotation at a moment, rad.

        Single frequency only. Discrete models have the weights of a device there, so that displacements due to unit
        loads of two devices or moments are reciprocal, and those at the load itself keep the order of the model.
        """
        if self.conjugate is not None:
            return self.conjugate(load)
        read = self.rotation if isinstance(load, PointMoment) else self.deflection
        return complex(read(load.position)[0])

    def rotations(self, x: Array, derivative: int) -> ComplexArray:
        """Derivative of the section rotation at x (n,), (n,), rad per m^derivative.

        Raises InputError for a Timoshenko field of a model without section rotation.
        """
        if self.rotation_shapes is not None:
            return self.rotation_shapes(x, derivative)
        if self.theory == "timoshenko":
            raise InputError(
                f"theory = 'timoshenko': fields of model = {self.model!r} have no rotation of the section, which moves "
                "the surface: choose another model, or a deflection or a slope"
            )
        return self.shapes(x, derivative + 1)

    def at(self, index: int) -> "HarmonicField":
        """The field at the frequency of an index from 0."""
        read, rotation = self.shapes, self.rotation_shapes
        return replace(
            self,
            frequency_hz=float(np.atleast_1d(self.frequency_hz)[index]),
            shapes=lambda x, derivative: read(x, derivative)[index],
            rotation_shapes=None if rotation is None else lambda x, derivative: rotation(x, derivative)[index],
        )


def wavenumber(beam: Beam, frequency_hz: float, theory: str = "euler-bernoulli") -> complex:
    """Wavenumber of propagating waves in the beam's own section, 1/m.

    (rho A omega^2 / (EI (1 + i eta)))^{1/4}; under a tension T and on a foundation k_f the root of
    EI k^4 + T k^2 = rho A omega^2 - k_f that propagates. Rayleigh's theory adds rotary inertia, Timoshenko's
    (Phil. Mag. 41, 1921) shear, with G = kappa G A: EI G k^4 - omega^2 (rho A EI + rho I G) k^2 =
    rho A omega^2 (G - rho I omega^2), with rho A omega^2 - k_f for rho A omega^2 in the balance of forces.
    """
    lossy = 1.0 + 1j * beam.loss_factor
    if not (beam.tension or beam.foundation) and theory == "euler-bernoulli":
        return complex(sqrt(2.0 * np.pi * frequency_hz / beam.wave_constant) * lossy**-0.25)
    section, omega = beam.base_section, 2.0 * np.pi * frequency_hz
    stiffness, load = section.bending_stiffness * lossy, section.mass_per_length * omega**2 - beam.foundation
    inertia = (section.rotary_inertia or 0.0) * omega**2 if theory != "euler-bernoulli" else 0.0
    # a k^4 + b k^2 = c
    a, b, c = stiffness, complex(beam.tension - inertia), complex(load)
    if theory == "timoshenko" and section.shear_stiffness is not None:
        shear = section.shear_stiffness * lossy
        b, c = -(load * stiffness / shear + inertia), load * (1.0 - inertia / shear)
    k = complex(np.sqrt((-b + np.sqrt(b * b + 4.0 * a * c + 0j)) / (2.0 * a)))
    return k if k.imag <= 0.0 else k.conjugate()


def lossless_wavenumber(beam: Beam, frequency_hz: float) -> complex:
    """Wavenumber of the beam without losses, 1/m: real where a wave propagates."""
    return wavenumber(replace(beam, loss_factor=0.0) if beam.loss_factor else beam, frequency_hz)


def travelling_wavenumber(beam: Beam, frequency_hz: float) -> float | None:
    """Lossless wavenumber where a wave propagates, 1/m; None below the cut-on frequency of a foundation."""
    k = lossless_wavenumber(beam, frequency_hz)
    return k.real if k.real > 0.0 == k.imag else None


def combined(parts: Sequence[tuple[complex, HarmonicField]]) -> HarmonicField:
    """The weighted sum of fields; other data are those of the first."""
    first = parts[0][1]

    def shapes(x: Array, derivative: int) -> ComplexArray:
        return np.asarray(sum(weight * field.shapes(x, derivative) for weight, field in parts))

    def rotations(x: Array, derivative: int) -> ComplexArray:
        return np.asarray(sum(weight * field.rotations(x, derivative) for weight, field in parts))

    def conjugate(load: PointLoad) -> complex:
        return sum(weight * field.displacement(load) for weight, field in parts)

    turned = None if first.rotation_shapes is None else rotations
    return replace(first, shapes=shapes, rotation_shapes=turned, conjugate=conjugate)


def acting_on(loads: Sequence[PointLoad], devices: Sequence[Device]) -> dict[str, Any]:
    """The fields `forces` and `couples` of a `HarmonicField` under loads with devices."""
    forces = tuple(load for load in loads if isinstance(load, PointForce))
    couples = [load.position for load in loads if isinstance(load, PointMoment)]
    return {"forces": forces, "couples": (*couples, *(device.position for device in devices if device.turning))}


def unit_response(beam: Beam, frequency_hz: float) -> float:
    """Scale of the response to a unit force, min(1/|k|, L)^3 / EI, m/N, for comparison with rounding."""
    length = min(1.0 / abs(wavenumber(beam, frequency_hz)), beam.length)
    return float(length**3 / beam.bending_stiffness)


def phasor(force: PointLoad) -> complex:
    """Complex amplitude of a load, N or N m."""
    return complex(force.amplitude * np.exp(1j * np.deg2rad(force.phase_deg)))


def point_force(position: float, value: complex) -> PointForce:
    """The force with a complex amplitude, N."""
    return PointForce(position=position, amplitude=abs(value), phase_deg=float(np.angle(value, deg=True)))
