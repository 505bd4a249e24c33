"""Actuators with electrical circuits on a beam in time: complex modal rows of beam and circuits together.

A circuit is an actuator of capacitance C with the modal loads b per volt, and branches of resistance R, inductance L
and capacitance C_s in series that carry the charges Q into it from a source E:

    L Q'' + R Q' + Q/C_s + V = E,   V = (sum Q - b^T q)/C,   q'' + 2 zeta omega q' + omega^2 q = f + b V.

In x = (q, Q) these are M x'' + D x' + K x = F with symmetric matrices (N. W. Hagood, A. von Flotow, J. Sound Vib.
146:243 (1991), for one mode). Left eigenvectors are therefore the right ones, u, and x = Re(u z) with
z' = lambda z + c u^T F, c = 2 / (u^T (2 lambda M + D) u), half of that for a real rate (F. Tisseur, K. Meerbergen, SIAM
Review 43:235 (2001), sec. 3.5). The spring and the mass of an actuator are part of the beam.
"""

from collections.abc import Callable, Sequence

import numpy as np

from verify.actuators.on_beam import Mounted
from verify.arrays import Array, ComplexArray
from verify.dynamics.excitation import RESONANCE, Forced, Rows, interleaved, modal_rows
from verify.errors import InputError, ResonanceError
from verify.linear.field import phasor
from verify.linear.time_basis import Ratio, TimeBasis
from verify.problem.beam import Beam, PointLoad

UNSTABLE = "circuits: a negative capacitance makes the beam unstable, give a smaller one, or in series a larger one"


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
