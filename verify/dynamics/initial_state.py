"""Initial states of beam and sliders: static deflection, steady state with attached mass, feet in equilibrium."""

import numpy as np

from verify.arrays import Array, ComplexArray, Indices
from verify.dynamics import layout as lay
from verify.dynamics.excitation import RESONANCE
from verify.dynamics.linear_system import Stage
from verify.dynamics.stepping import Contacts
from verify.errors import InputError
from verify.linear.time_basis import Ratio, TimeBasis

PASSES = 4
"""Fixed-point iterations for the material point under a contact point; each reduces the error by (h/2) w''."""


def static_deflection(basis: TimeBasis, contacts: Contacts) -> Array:
    """Modal amplitudes of a beam in static equilibrium under the sliders, (n,), sqrt(kg) m.

    A load acts at the material point x + (h/2) w', normal to the surface, and therefore has the moment (h/2) w' per
    unit load on the section. The points of a foot share its load equally.
    """
    p, x = contacts.points, contacts.start + contacts.points[:, lay.OFFSET]
    foot = contacts.indices[:, lay.OF_FOOT] if len(contacts.feet) else np.arange(len(p))
    share = (foot[:, None] == np.arange(foot.max() + 1)) * p[:, [lay.WEIGHT]]
    share = share / share.sum(axis=0)  # a foot between two mirrored beams loads each with half
    apart = np.where(p[:, lay.IMAGE] > 0.0, p[:, lay.INSET] * p[:, lay.STIFF], 0.0)
    still, slopes = np.zeros(len(basis.omegas)), basis.shapes(x, 1)
    for _ in range(PASSES):
        at = _material(basis, still, x, p[:, lay.LEVER])
        shapes = basis.shapes(at, 0) + p[:, lay.LEVER] * (still @ basis.shapes(at, 1)) * slopes
        loaded = shapes @ share / basis.omegas[:, None]
        still = shapes @ (share @ _loads(contacts, foot, loaded.T @ loaded) - apart) / basis.omegas**2
    return np.asarray(still)


def _material(basis: TimeBasis, q: Array, x: Array, lever: Array) -> Array:
    """Material points at the positions x, m."""
    return np.asarray(np.clip(x + lever * (q @ basis.shapes(x, 1)), 0.0, basis.beam.length))


def _loads(contacts: Contacts, foot: Indices, compliance: Array) -> Array:
    """Static force along z on each foot, N, or minus the load of each point without foot.

    Preload springs relax with the deformation of the beam (`compliance` (feet, feet), m/N) and of the contact.
    """
    if not len(contacts.feet):
        return -contacts.points[:, lay.LOAD]
    press, spring = contacts.feet[:, lay.FOOT_LOAD], contacts.feet[:, lay.SPRING_RATE]
    if not spring.any():
        return press
    deformed = compliance + np.diag(1.0 / np.bincount(foot, contacts.points[:, lay.STIFF]))
    return np.asarray(np.linalg.solve(np.eye(len(press)) + spring[:, None] * deformed, press))


def steady_with_mass(basis: TimeBasis, stage: Stage, contacts: Contacts, damping: Ratio) -> ComplexArray:
    """Modal response z to bilateral masses on a steady beam, at time 0 of the stage, (n,).

    W = W_0 + G m omega^2 W at all points: a mass exerts the force m omega^2 W. Raises InputError at a resonance.
    """
    omega, x = stage.omega, contacts.start + contacts.points[:, lay.OFFSET]
    shapes, mass = basis.shapes(x, 0), contacts.points[:, lay.INERTIA]
    compliance = 1.0 / (basis.omegas**2 - omega**2 + 2j * damping * basis.omegas * omega)
    loop = np.eye(len(x)) - omega**2 * (shapes.T * compliance) @ shapes * mass
    if np.linalg.svd(loop, compute_uv=False).min() < RESONANCE:
        raise InputError(f"slider.mass = {float(mass[0])!r} kg is in resonance with the drive: give beam.loss_factor")
    force = mass * omega**2 * np.linalg.solve(loop, stage.drive_shapes(x, 0)[0]) * np.exp(1j * omega * stage.origin)
    phasors = (shapes @ force) * compliance
    return stage.rows.of_state(phasors.real, (1j * omega * phasors).real)


def set_down(contacts: Contacts, stage: Stage, z: ComplexArray) -> None:
    """Set sliders level in equilibrium on the surface of free rows z: depths, heights of feet, normal velocities.

    Raises InputError for a foot without load.
    """
    p, state, at = contacts.points, contacts.contacts, contacts.start + contacts.points[:, lay.OFFSET]
    x, lever, factors, rates = at, p[:, lay.LEVER], stage.factors(z[None], np.zeros(1))[0], stage.rates_at_start(z)
    for _ in range(PASSES):
        at = np.clip(x + lever * (factors @ stage.columns(at, 1)), 0.0, stage.edges[-1])
    level, slope, bend = (factors @ stage.columns(at, derivative) for derivative in range(3))
    rise, turn = (rates @ stage.columns(at, derivative) for derivative in range(2))
    along = contacts.sliders[contacts.indices[:, lay.OF_SLIDER], lay.V]
    along = along - slope * rise if contacts.following else along
    along = along * contacts.sliders[contacts.indices[:, lay.OF_SLIDER], lay.FREE]
    climb = rise + slope * (along + lever * (turn + bend * along))  # dw/dt + w' dX/dt, X = x + (h/2) w'
    if not len(contacts.feet):
        state[:, lay.RISE_RATE] = climb
        return
    foot, rigid = contacts.indices[:, lay.OF_FOOT], contacts.restitution is not None
    for number, row in enumerate(contacts.feet):
        own = foot == number
        row[lay.HEIGHT] = float(level[own][0]) if rigid else _rest_height(number, p[own], level[own], row)
    if rigid:  # a rigid point moves with the surface from the start
        contacts.feet[:, lay.CLIMB] = climb
    height = contacts.feet[foot, lay.HEIGHT]
    state[:, lay.DEPTH] = p[:, lay.INSET] + p[:, lay.FACE] * (p[:, lay.IMAGE] * level - height)


def _rest_height(number: int, points: Array, level: Array, foot: Array) -> float:
    """Height at which the springs of a level foot carry its load over these levels, m. Raises InputError."""
    from scipy.optimize import brentq

    face, stiff, press = points[:, lay.FACE], points[:, lay.STIFF], float(foot[lay.FOOT_LOAD])
    depth = points[:, lay.INSET] + face * points[:, lay.IMAGE] * level

    def force(z: float) -> float:
        return float((face * stiff * np.maximum(depth - face * z, 0.0)).sum() + press - foot[lay.SPRING_RATE] * z)

    total = float(stiff.sum())
    wide = 2.0 * float(np.abs(level).max()) + 2.0 * (abs(press) + total * points[:, lay.INSET].max()) / total + 1e-12
    if not force(-wide) > 0.0 > force(wide):
        raise InputError(f"slider.preload leaves foot {number + 1} without load or off the beam: raise it")
    return float(brentq(force, -wide, wide, xtol=1e-15 * max(wide, 1e-9), rtol=1e-14))


def deepen_between_beams(basis: TimeBasis, contacts: Contacts, still: Array) -> None:
    """Increase the depth of a foot between two beams by the mean deflection of the beams under its preload."""
    p = contacts.points
    x = contacts.start + p[:, lay.OFFSET]
    bent = still @ basis.shapes(_material(basis, still, x, p[:, lay.LEVER]), 0)
    for number in range(len(contacts.feet)):
        between = (contacts.indices[:, lay.OF_FOOT] == number) & (p[:, lay.WEIGHT] < 1.0)
        if between.any():
            p[between, lay.INSET] -= bent[between].mean()
