"""What every model's `solve_harmonic` returns, and what it refuses."""

from collections.abc import Callable, Sequence
from math import sqrt

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.checks import check_whole
from verify.errors import InputError, ResonanceError
from verify.linear.places import Forces, Numbers, as_asked, as_forces, in_a_row, keep_lines, places
from verify.problem.beam import Beam, PointForce, check_frequency

LARGEST_SLOPE = 1e100
"""Of a beam under a force, F L^2 / EI."""
SLOW = 0.01
"""Of (kL)^2: drives under which what a beam moves as a whole may be far more than it bends."""
SAMPLED = 41
"""Places at which that is seen."""
ROUNDING, LOST = 64.0 * 2.2e-16, 1e-3
"""Of a deflection that parts are placed by (measured: up to 50 roundings), and of a derivative that is no figure."""
RESONANCE = 1e-9
"""An undamped beam is not driven closer than this (relative) to a resonance: the answer would be rounding."""


class HarmonicField(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Steady motion Re(w(x) e^{+i omega t}) of one model under harmonic point forces."""

    model: str
    """Its name."""
    count: int | None
    """Elements or segments; None for the exact beam."""
    beam: Beam
    """On which it runs."""
    frequency_hz: float
    """Of the drive, hertz."""
    forces: tuple[PointForce, ...]
    """What drives it, newton."""
    shapes: Callable[[Array, int], ComplexArray]
    """(x, derivative) -> (len(x),) complex, metres per metre^derivative."""
    theory: str = "euler-bernoulli"
    """Of the beam."""
    turned: Callable[[Array, int], ComplexArray] | None = None
    """(x, derivative) -> (len(x),) complex: turn psi of the section where shear sets it apart from the slope w'."""
    turning_held: tuple[float, ...] = ()
    """Where devices act against turning, metres: their couples are not among the forces."""

    def __post_init__(self) -> None:
        keep_lines(self, "shapes", "turned")

    @property
    def omega(self) -> float:
        """2 pi f, rad/s."""
        return 2.0 * np.pi * self.frequency_hz

    @property
    def wavenumber(self) -> complex:
        """Of the exact beam by the same theory, 1/m; its imaginary part is never positive."""
        return wavenumber(self.beam, self.frequency_hz, self.theory)

    def deflection(self, x: Numbers) -> ComplexArray:
        """Complex deflection at x (metres), of the shape of x, metres; a number is a row of one.

        Raises InputError off the beam.
        """
        return as_asked(self.shapes(self._on_beam(x), 0), x)

    def slope(self, x: Numbers) -> ComplexArray:
        """Complex slope at x (metres), of the shape of `deflection`, radians. Raises InputError as `derivative`."""
        return self.derivative(x, 1)

    def derivative(self, x: Numbers, order: int) -> ComplexArray:
        """A derivative of the deflection at x (metres), of the shape of `deflection`, metres per metre^order.

        Raises InputError off the beam, and where the beam moves nearly as a whole so far that its parts keep no digit
        of how it bends.
        """
        at = self._on_beam(x)
        if order and self.count is not None and self.omega * self.beam.length**2 < SLOW * self.beam.wave_constant:
            self._check_digits(self.count, order)
        return as_asked(self.shapes(at, order), x)

    def _check_digits(self, count: int, order: int) -> None:
        """Raise InputError where rounding of the parts' places may be a thousandth of a derivative, or more of it."""
        sample = np.linspace(0.0, self.beam.length, SAMPLED)
        size, told = (float(abs(self.shapes(sample, n)).max()) for n in (0, order))
        if ROUNDING * size * (count / self.beam.length) ** order > LOST * told:
            raise InputError(
                f"frequency_hz = {self.frequency_hz!r}: the beam moves by {size:.2g} m nearly as a whole, so that "
                f"count = {count} parts keep no digits of how it bends: give fewer parts, model = analytic, or a "
                "faster drive"
            )

    def turn(self, x: Numbers) -> ComplexArray:
        """Complex turn of the section at x (metres), of the shape of `deflection`, radians: w' where nothing shears.

        Raises InputError off the beam, and for a Timoshenko field of a model that gives none.
        """
        if self.turned is None and self.theory != "timoshenko":
            return self.derivative(x, 1)
        return as_asked(self.turns(self._on_beam(x), 0), x)

    def turns(self, x: Array, derivative: int) -> ComplexArray:
        """That or a derivative of it at x (n,), (n,), radians per metre^derivative. Raises InputError likewise."""
        check_whole("derivative", derivative, 0)
        if self.turned is not None:
            return self.turned(x, derivative)
        if self.theory == "timoshenko":
            raise InputError(
                f"theory = 'timoshenko': fields of model = {self.model!r} tell no turn of the section (turned), with "
                "which a surface moves: ask for a deflection or a slope, or choose another model"
            )
        return self.shapes(x, derivative + 1)

    def _on_beam(self, x: Numbers) -> Array:
        return places("x", x, self.beam.length).ravel()


def wavenumber(beam: Beam, frequency_hz: float, theory: str = "euler-bernoulli") -> complex:
    """At which waves run along the beam's own section, 1/m: (rho A omega^2 / (EI (1 + i eta)))^{1/4} if nothing acts.

    Under a tension T and on a foundation k_f: EI k^4 + T k^2 = rho A omega^2 - k_f; `theory` adds what thickness does.
    """
    if beam.tension or beam.foundation or theory != "euler-bernoulli":
        return _running(beam, 2.0 * np.pi * frequency_hz, theory)
    real = sqrt(2.0 * np.pi * frequency_hz / beam.wave_constant)
    return complex(real * (1.0 + 1j * beam.loss_factor) ** -0.25)


def lossless_wavenumber(beam: Beam, frequency_hz: float) -> complex:
    """The same of a beam without losses, 1/m: real where a wave travels."""
    return wavenumber(replace(beam, loss_factor=0.0), frequency_hz)


def travelling_wavenumber(beam: Beam, frequency_hz: float) -> float | None:
    """The same where a wave travels, 1/m; None below the frequency from which on a foundation lets it."""
    k = lossless_wavenumber(beam, frequency_hz)
    return k.real if k.real > 0.0 == k.imag else None


def _running(beam: Beam, omega: float, theory: str) -> complex:
    """The root k of a k^4 + b k^2 = c that runs: of Euler-Bernoulli, Rayleigh and Timoshenko with both ends' signs.

    Timoshenko (Phil. Mag. 41, 1921) with G = kappa G A: EI G k^4 - omega^2 (rho A EI + rho I G) k^2 =
    rho A omega^2 (G - rho I omega^2), and omega^2 less k_f / rho A where only the deflection is held.
    """
    own, lossy = beam.own, 1.0 + 1j * beam.loss_factor
    stiffness, load = own.bending_stiffness * lossy, own.mass_per_length * omega**2 - beam.foundation
    turning = (own.rotary_inertia or 0.0) * omega**2 if theory != "euler-bernoulli" else 0.0
    a, b, c = stiffness, complex(beam.tension - turning), complex(load)
    if theory == "timoshenko" and own.shear_stiffness is not None:
        shear = own.shear_stiffness * lossy
        a, b, c = stiffness, -(load * stiffness / shear + turning), load * (1.0 - turning / shear)
    square = (-b + np.sqrt(b * b + 4.0 * a * c + 0j)) / (2.0 * a)
    k = complex(np.sqrt(square))
    return k if k.imag <= 0.0 else k.conjugate()


def combined(parts: Sequence[tuple[complex, HarmonicField]]) -> HarmonicField:
    """The weighted sum of fields, else as the first of them."""

    def shapes(x: Array, derivative: int) -> ComplexArray:
        return np.asarray(sum(weight * field.shapes(x, derivative) for weight, field in parts))

    def turned(x: Array, derivative: int) -> ComplexArray:
        return np.asarray(sum(weight * field.turns(x, derivative) for weight, field in parts))

    first = parts[0][1]
    return replace(first, shapes=shapes, turned=None if first.turned is None else turned)


def unit_response(beam: Beam, frequency_hz: float) -> float:
    """The size of an answer to a unit force, min(1/|k|, L)^3 / EI, m/N: what is tiny beside it is rounding."""
    length = min(1.0 / abs(wavenumber(beam, frequency_hz)), beam.length)
    return float(length**3 / beam.bending_stiffness)


def check_drive(beam: Beam, forces: Forces, frequency_hz: float) -> None:
    """Raise InputError for a frequency that is not finite and positive, no force, or a force off the beam or too large.

    Unit forces bend the thinnest beams to F L^2 / EI = 1e60; from LARGEST_SLOPE on resonance leaves no square of it.
    """
    check_frequency("frequency_hz", frequency_hz, beam)
    check_forces(beam, forces)


def check_frequencies(field: str, found: Array, beam: Beam) -> None:
    """Raise InputError, by index, where one of many frequencies (n,) is none that a beam is driven at."""
    for index in (int(np.argmin(found)), int(np.argmax(found))) if len(found) else ():  # a NaN is both
        check_frequency(f"{field}[{index}]", float(found[index]), beam)


def unit_drives(beam: Beam, positions: Numbers, frequencies_hz: Numbers, x: Numbers) -> tuple[Array, Array, Array]:
    """What `unit_responses` of every model is asked for, each in a row: where forces stand, at which hertz, where read.

    Raises InputError for rows of rows, places off the beam and frequencies that are none.
    """
    rows = [in_a_row(name, given, "metres") for name, given in (("positions", positions), ("x", x))]
    for name, row in zip(("positions", "x"), rows, strict=True):
        places(name, row, beam.length)
    frequencies = in_a_row("frequencies_hz", frequencies_hz, "hertz")
    check_frequencies("frequencies_hz", frequencies, beam)
    return np.clip(rows[0], 0.0, beam.length), frequencies, rows[1]


def check_forces(beam: Beam, forces: Forces) -> None:
    """Raise InputError for no force, or a force off the beam or too large for it."""
    forces = as_forces(forces)
    if not forces:
        raise InputError("forces is empty: give at least one PointForce")
    for force in forces:
        if force.position > beam.length:
            raise InputError(
                f"force.position = {force.position!r} lies off the beam: "
                f"give a position between 0 and {beam.length!r} m"
            )
        if (slope := abs(force.amplitude) * beam.length**2 / beam.bending_stiffness) > LARGEST_SLOPE:
            raise InputError(
                f"force.amplitude = {force.amplitude!r} N bends this beam to slopes of about {slope:.0e}, which no "
                "figure can be made of: check its unit, give a smaller force"
            )


def phasor(force: PointForce) -> complex:
    """Amplitude and phase as one complex number, newton."""
    return complex(force.amplitude * np.exp(1j * np.deg2rad(force.phase_deg)))


def refuse_resonance(
    model: str, frequency_hz: float, mode: int, resonance_hz: float, field: str = "frequency_hz"
) -> None:
    """Raise ResonanceError naming the mode of an undamped resonance and the distance to it."""
    distance = abs(frequency_hz / resonance_hz - 1.0)
    raise ResonanceError(
        f"{field} = {frequency_hz!r} lies {distance:.1e} (relative) from the undamped resonance of mode {mode} "
        f"of the {model} model at {resonance_hz!r} Hz: give the beam a loss_factor or choose another frequency"
    )
