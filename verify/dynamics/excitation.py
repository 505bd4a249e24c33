"""Rows of a beam in time: modes, alone or with electrical circuits, and their exact response to harmonic forces.

The forces have a polynomial envelope. A circuit is an actuator of capacitance C with the modal loads b per volt, and
branches of resistance R, inductance L and capacitance C_s in series that carry the charges Q into it from a source E:

    L Q'' + R Q' + Q/C_s + V = E,   V = (sum Q - b^T q)/C,   q'' + 2 zeta omega q' + omega^2 q = f + b V.

In x = (q, Q) these are M x'' + D x' + K x = F with symmetric matrices (N. W. Hagood, A. von Flotow, J. Sound Vib.
146:243 (1991), for one mode). Left eigenvectors are therefore the right ones, u, and x = Re(u z) with
z' = lambda z + c u^T F, c = 2 / (u^T (2 lambda M + D) u), half of that for a real rate (F. Tisseur, K. Meerbergen, SIAM
Review 43:235 (2001), sec. 3.5). The spring and the mass of an actuator are part of the beam.
"""

from collections.abc import Callable, Sequence
from typing import Any

import msgspec
import numpy as np

from verify.actuators.on_beam import Mounted
from verify.arrays import Array, ComplexArray
from verify.errors import InputError, ResonanceError
from verify.linear.field import phasor
from verify.linear.time_basis import Ratio, TimeBasis
from verify.problem.beam import Beam, PointLoad
from verify.validation import check_number

RESONANCE = 1e-9  # Relative distance to an undamped resonance within which a drive is an error
CONSTANT = np.array([1.0])
SMOOTH_STEP = np.array([0.0, 0.0, 3.0, -2.0])  # 3 p^2 - 2 p^3: from 0 to 1 with zero slope at both ends
SLOW = 0.5  # |i omega - lambda| T below which the forced part is a power series: the closed form has cancellation
SERIES = 12  # Additional powers of that series: SLOW^12 / 12! is rounding
UNSTABLE = "circuits: a negative capacitance makes the beam unstable, give a smaller one, or in series a larger one"


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


class CircuitRows(Rows, frozen=True, eq=False, kw_only=True):
    """Rows of modal amplitudes (sqrt(kg) m) and charges (C); readings: voltages and charges of all actuators."""

    vectors: ComplexArray  # u, (coordinates, n)
    inertia: Array  # M, (coordinates,): 1 and inductances, H
    damping: Array  # D, (coordinates,): 2 zeta omega and resistances, ohm
    stiffness: Array  # K, (coordinates, coordinates)
    forces: ComplexArray  # Phasors of F, (coordinates,)
    modes: int  # Number of modal amplitudes, the first coordinates

    @property
    def sizes(self) -> tuple[int, ...]:
        """Admissible numbers of coordinates in `of_state`; left out, charges are in equilibrium."""
        return self.modes, len(self.inertia)

    def shapes(self, basis: TimeBasis) -> Callable[[Array, int], ComplexArray]:
        """(x, derivative) -> psi, (n, len(x)), on a basis."""
        mechanical = self.vectors[: self.modes].T
        return lambda x, derivative: np.asarray(mechanical @ basis.shapes(x, derivative))

    def state(self, z: ComplexArray) -> tuple[Array, Array]:
        """(x, dx/dt) of the coordinates."""
        return (self.vectors @ z).real, (self.vectors @ (self.rates * z)).real

    def of_state(self, q: Array, rates: Array) -> ComplexArray:
        """State z of coordinates and their rates, or of modes alone."""
        if len(q) < len(self.inertia):
            own = self.stiffness[self.modes :]
            q = np.append(q, -np.linalg.pinv(own[:, self.modes :]) @ own[:, : self.modes] @ q)
            rates = np.append(rates, np.zeros(len(q) - self.modes))
        momenta = self.vectors.T @ (self.damping * q + self.inertia * rates)
        return np.asarray(self.participations * (momenta + self.rates * (self.vectors.T @ (self.inertia * q))))

    def energies(self, z: ComplexArray) -> tuple[float, float]:
        """Kinetic energy with that of inductances, elastic energy with that of capacitances, J."""
        x, rates = self.state(z)
        return 0.5 * float(self.inertia @ rates**2), 0.5 * float(x @ self.stiffness @ x)

    def accounts(self, forced: Forced) -> tuple[Array, Array]:
        """Tables of the energy balance, see `integrator.add_powers`."""
        drive = self.vectors @ forced.forward + self.vectors.conj() @ forced.backward
        table = [self.forces.real, self.forces.imag, self.damping, np.arange(len(drive)) >= self.modes]
        return np.vstack([self.vectors.real.T, self.vectors.imag.T, interleaved(drive).T]), np.array(table)


def check_circuits(beam: Beam, circuits: Sequence[Mounted], omega: float) -> None:
    """Raise InputError for circuits that have no equivalent in time."""
    for one in circuits:
        one.loads(beam)
        load, where = one.load, f"circuits: actuator at position = {one.position!r} m"
        if complex(one.actuator.port(omega).short_impedance):
            raise InputError(f"{where}: in time its spring and mass are part of the beam, see beam_in_time")
        if load is None:
            raise InputError(f"{where} has no load, give one; voltages and currents alone are forces")
        series = load.connection == "series" and (load.resistance or load.inductance)
        if one.voltage is not None and load.capacitance and not series:
            raise InputError(f"{where}: a source in time is behind a resistance or inductance, drop the capacitance")


def rows_on(
    basis: TimeBasis, forces: Sequence[PointLoad], damping: Ratio, circuits: Sequence[Mounted], omega: float
) -> Rows:
    """Rows of a basis under forces, coupled with circuits whose sources have angular frequency omega, rad/s.

    Raises InputError for truncated modes, an unstable circuit and two equal rates, ResonanceError at an undamped one.
    """
    if not circuits:
        return modal_rows(basis, forces, damping)
    n, (inertia, lossy, stiffness, source, outputs) = len(basis.omegas), _coupled(basis, damping, circuits, omega)
    with_inertia, without, m = np.flatnonzero(inertia), np.flatnonzero(inertia == 0.0), len(inertia)
    a, at = np.zeros((m + len(with_inertia), m + len(with_inertia))), m + np.arange(len(with_inertia))
    a[with_inertia, at], a[without, :m] = 1.0, -stiffness[without] / lossy[without, None]
    a[m:, :m], a[at, at] = (
        -stiffness[with_inertia] / inertia[with_inertia, None],
        -lossy[with_inertia] / inertia[with_inertia],
    )
    values, right = np.linalg.eig(a)
    order = np.argsort(np.where(values.imag > 0.0, values.imag, np.inf), kind="stable")
    order = order[values[order].imag >= 0.0]  # one of a pair by frequency, then real rates
    rates: ComplexArray = values[order].astype(complex)
    u: ComplexArray = right[:m, order].astype(complex)
    if rates.real.max() > 1e-9 * abs(rates).max():
        raise InputError(UNSTABLE)
    size = np.linalg.norm(u[:n], axis=0)  # z is a modal amplitude, by which time steps are chosen
    u = u / np.where(size > 0.0, size, 1.0)
    weights = 2.0 * np.outer(inertia, rates) + lossy[:, None]
    form = (u**2 * weights).sum(axis=0)
    if (abs(form) < 1e-8 * (abs(u) ** 2 * abs(weights)).sum(axis=0)).any():  # half of the digits are lost
        raise InputError("circuits: two natural frequencies and dampings coincide, change a resistance by 1e-6")
    applied = sum((phasor(f) * basis.modal_load(f) for f in forces), np.zeros(n, dtype=complex))
    acting: ComplexArray = np.concatenate([applied, source]).astype(complex)
    if acting.any() and abs(1j * omega - rates).min() < RESONANCE * omega:
        raise ResonanceError("circuits: the drive is at an undamped resonance of beam and circuits, add a resistance")
    return CircuitRows(
        rates=rates,
        participations=np.where(rates.imag > 0.0, 2.0, 1.0) / form,
        loads=u.T @ acting,
        backward_loads=u.conj().T @ acting,
        readings=u.T @ outputs.T,
        vectors=u,
        inertia=inertia,
        damping=lossy,
        stiffness=stiffness,
        forces=acting,
        modes=n,
    )


def _coupled(
    basis: TimeBasis, damping: Ratio, circuits: Sequence[Mounted], omega: float
) -> tuple[Array, Array, Array, ComplexArray, Array]:
    """(M, D, K, sources of the branches, voltages and charges of the actuators as rows over the coordinates)."""
    if basis.tail is not None:
        raise InputError(f"model = {basis.model!r}: circuits act on truncated modes too, give 'fem' or 'segment'")
    n, k = len(basis.omegas), len(circuits)
    coupling, own, total = np.zeros((k, n)), np.zeros(k), np.zeros(k)
    branches: list[tuple[int, float, float, float, complex]] = []  # circuit, R, L, 1/C_s, E
    for i, one in enumerate(circuits):
        port, load = one.actuator.port(omega), one.load
        assert load is not None
        unit = sum((part.amplitude * basis.modal_load(part) for part in one.loads(basis.beam)), np.zeros(n))
        coupling[i] = complex(port.force_factor).real * unit
        own[i] = total[i] = (complex(port.blocked_admittance) / (1j * omega)).real
        r, inductance, c = load.resistance or 0.0, load.inductance or 0.0, load.capacitance or 0.0
        if c and (load.connection == "parallel" or not r + inductance):
            total[i] += c
            c = 0.0
        split = [(r, inductance)] if load.connection == "series" else [(r, 0.0), (0.0, inductance)]
        branches += [(i, *pair, 1.0 / c if c else 0.0, one.voltage or 0.0) for pair in split if any(pair)]
    if total.min() <= 0.0:
        raise InputError(UNSTABLE)
    of, r, inductance, soft, source = np.array(branches or np.zeros((0, 5)), dtype=complex).T
    charges = np.hstack([-coupling, (of.real == np.arange(k)[:, None]).astype(float)])  # on the capacitances
    volts = charges / total[:, None]
    carried = own[:, None] * volts + np.pad(coupling, ((0, 0), (0, len(of))))
    stiffness = charges.T @ volts + np.diag(np.append(basis.omegas**2, soft.real))
    lossy = np.append(2.0 * damping * basis.omegas, r.real)
    return np.append(np.ones(n), inductance.real), lossy, stiffness, source, np.vstack([volts, carried])
