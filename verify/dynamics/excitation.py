"""Harmonic forces with a polynomial envelope, and the exact response of complex modal rows."""

from collections.abc import Callable, Sequence
from typing import Any

import msgspec
import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import ResonanceError
from verify.linear.field import phasor
from verify.linear.time_basis import Ratio, TimeBasis
from verify.problem.beam import Beam, PointLoad
from verify.validation import check_number

RESONANCE = 1e-9  # Relative distance to an undamped resonance within which a drive is an error
CONSTANT = np.array([1.0])
SMOOTH_STEP = np.array([0.0, 0.0, 3.0, -2.0])  # 3 p^2 - 2 p^3: from 0 to 1 with zero slope at both ends
SLOW = 0.5  # |i omega - lambda| T below which the forced part is a power series: the closed form has cancellation
SERIES = 12  # Additional powers of that series: SLOW^12 / 12! is rounding


class Rows(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Complex modal rows: z' = lambda z + c psi(x) f, with the contribution Re(psi(x) z) to the deflection."""

    rates: ComplexArray  # lambda, (n,), 1/s; of a mode -sigma + i omega_d
    participations: ComplexArray  # c, (n,), s/kg of unit modal mass; of a mode -i / omega_d
    loads: ComplexArray  # psi at the forces times their phasors, (n,), N/sqrt(kg)
    backward_loads: ComplexArray | None = None
    """conj(psi) at the forces times their phasors, (n,), N/sqrt(kg); None for real psi."""
    readings: ComplexArray = np.empty((0, 0), dtype=complex)  # psi of outputs other than the deflection, (n, outputs)

    @property
    def sizes(self) -> tuple[int, ...]:
        """Admissible numbers of coordinates in `of_state`."""
        return (len(self.rates),)

    def shapes(self, basis: TimeBasis) -> Callable[[Array, int], Any]:
        """(x, derivative) -> psi, (n, len(x)), of rows on a basis."""
        return basis.shapes

    def state(self, z: ComplexArray) -> tuple[Array, Array]:
        """(q, dq/dt) of modes, (n,) each."""
        return z.real, (self.rates * z).real

    def energies(self, z: ComplexArray) -> tuple[float, float]:
        """Kinetic and elastic energy, J."""
        q, rates = self.state(z)
        return 0.5 * float(rates @ rates), 0.5 * float(abs(self.rates) ** 2 @ q**2)

    def accounts(self, forced: "Forced") -> tuple[Array, Array]:
        """Tables of the energy balance, see `integrator.add_powers`."""
        table = np.array([self.loads.real, self.loads.imag, -2.0 * self.rates.real, 0.0 * self.rates.real])
        return np.ascontiguousarray(interleaved(forced.forward + forced.backward).T), table

    def of_state(self, q: Array, rates: Array) -> ComplexArray:
        """State z of modes with amplitudes q and rates dq/dt, (n,): Re z = q, Re(lambda z) = dq/dt."""
        return np.asarray(q + 1j * (self.rates.real * q - rates) / self.rates.imag)

    def after(self, z: ComplexArray, t: Any) -> ComplexArray:
        """Free rows at times t after the state z, (*shape of t, n)."""
        return np.asarray(np.exp(np.multiply.outer(t, self.rates)) * z)


class Forced(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """The forced part z = sum_d (t/T)^d (A_d e^{i omega s} + conj(B_d) e^{-i omega s}) of all rows, s = t + origin."""

    forward: ComplexArray  # A, (n, degree + 1)
    backward: ComplexArray
    """B, (n, degree + 1): conjugated, so that the deflection is Re((psi A + conj(psi) B) (t/T)^d e^{i omega s})."""
    omega: float
    origin: float
    unit_s: float  # T

    def at(self, t: float) -> ComplexArray:
        """The state z of every row at time t, (n,)."""
        powers = (t / self.unit_s) ** np.arange(self.forward.shape[1]) * np.exp(1j * self.omega * (t + self.origin))
        return np.asarray(self.forward @ powers + np.conj(self.backward @ powers))

    def drive_shapes(self, psi: Array | ComplexArray) -> ComplexArray:
        """Shapes of the forced deflection, one for each power of t, (degree + 1, len(x)), from `psi` (n, len(x))."""
        if not np.iscomplexobj(psi):
            return np.asarray((self.forward + self.backward).T @ psi)
        return np.asarray(self.forward.T @ psi + self.backward.T @ psi.conj())


def interleaved(amplitudes: ComplexArray) -> Array:
    """Alternate real and imaginary parts, (n, k) complex -> (n, 2 k)."""
    return np.ascontiguousarray(amplitudes, dtype=complex).view(float)


def modal_rows(basis: TimeBasis, forces: Sequence[PointLoad], damping: Ratio) -> Rows:
    """The modes of a basis under forces, with damping ratio `damping`, a number or (n,)."""
    loads = sum((phasor(f) * basis.modal_load(f) for f in forces), np.zeros(len(basis.omegas), dtype=complex))
    damped = basis.omegas * np.sqrt(1.0 - np.square(damping))
    return Rows(
        rates=np.asarray(-damping * basis.omegas + 1j * damped),
        participations=np.asarray(-1j / damped),
        loads=np.asarray(loads, dtype=complex),
    )


_NONE = np.empty(0, dtype=complex)
NO_ROWS = Rows(rates=_NONE, participations=_NONE, loads=_NONE)


def forced_response(rows: Rows, omega: float, envelope: Array, unit_s: float, origin: float = 0.0) -> Forced:
    """The forced part under Re(F sum_d envelope_d (t/T)^d e^{i omega (t + origin)}), 0 <= t <= T.

    Half of the force drives e^{i omega t}, half e^{-i omega t}; each amplitude follows from the highest power down,
    (i omega - lambda) A_d + (d + 1)/T A_{d+1} = c F envelope_d / 2, exact for any polynomial.
    """
    back = rows.loads if rows.backward_loads is None else rows.backward_loads
    pairs = ((rows.rates, rows.participations, rows.loads), (rows.rates.conj(), rows.participations.conj(), back))
    parts = [_amplitudes(1j * omega - rate, 0.5 * np.outer(c * load, envelope), unit_s) for rate, c, load in pairs]
    if parts[0].shape != parts[1].shape:  # one is a series
        width = max(part.shape[1] for part in parts)
        parts = [np.pad(part, ((0, 0), (0, width - part.shape[1]))) for part in parts]
    forward, backward = parts
    return Forced(forward=forward, backward=backward, omega=omega, origin=origin, unit_s=unit_s)


def _amplitudes(stiff: ComplexArray, load: ComplexArray, unit_s: float) -> ComplexArray:
    """Coefficients of powers of t/T of the solution a of a' + stiff a = load, (n, powers).

    The particular polynomial, or for small `stiff` and a growing envelope the series of the solution from rest: near a
    resonance the polynomial is large and cancels against the free part.
    """
    slow = (abs(stiff) * unit_s < SLOW) & (load.shape[1] > 1)
    a, safe = np.zeros_like(load), np.where(slow, 1.0, stiff)
    for d in range(load.shape[1] - 1, -1, -1):
        higher = (d + 1) / unit_s * a[:, d + 1] if d + 1 < load.shape[1] else 0.0
        a[:, d] = (load[:, d] - higher) / safe
    if slow.any():
        a, load = (np.pad(part, ((0, 0), (0, SERIES))) for part in (a, load))
        a[slow] = 0.0
        for d in range(load.shape[1] - 1):
            a[slow, d + 1] = unit_s * (load[slow, d] - stiff[slow] * a[slow, d]) / (d + 1)
    return a


def check_damping(beam: Beam, modal_damping: float | None) -> None:
    """Raise InputError for a damping ratio, `modal_damping` or by the beam's loss factor, outside 0 to 1."""
    own = ("half of beam.loss_factor", 0.5 * beam.loss_factor)
    name, ratio = own if modal_damping is None else ("modal_damping", modal_damping)
    check_number(name, ratio, "ratio of every mode", at_least=0, below=1)


def check_no_resonance(basis: TimeBasis, frequency_hz: float, damping: Ratio) -> None:
    """Raise InputError for an undamped mode that is driven at its natural frequency."""
    ratio = np.abs(2.0 * np.pi * frequency_hz / basis.omegas - 1.0)
    nearest = int(ratio.argmin())
    if ratio[nearest] < RESONANCE and not np.broadcast_to(damping, ratio.shape)[nearest]:
        raise ResonanceError(
            f"frequency_hz = {frequency_hz!r} lies {ratio[nearest]:.1e} (relative) from the undamped resonance of mode "
            f"{nearest + 1} of the {basis.model} model: give the beam a loss_factor or choose another frequency"
        )
