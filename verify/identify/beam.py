"""Material, loss factor and wall stiffness of a beam from natural frequencies or from a frequency response.

The exact beam predicts; derivatives are analytic. A frequency with its mass-normalised shape w, by Rayleigh's quotient:

    d ln f/d k_r = w'^2/(2 omega^2) at the wall,
    d ln f/d ln E = (1 - sum k w^2/omega^2)/2 over the springs,   d ln f/d ln rho = -(1 - sum m w^2)/2 over the bodies.

So E and rho of a beam without springs and bodies change all frequencies by the same factor: frequencies alone determine
E/rho, and a fit of both reports neither. A receptance H with the fields w_d and w_r under unit forces at the drive and
at the sensor, by virtual work, with M = integral of rho A w_d w_r:

    dH/d k_r = -w_d' w_r',   dH/d ln rho = omega^2 M,   dH/d ln E = -A,   dH/d eta = -i A/(1 + i eta),
    A = H - sum k w_d w_r + omega^2 (M + sum m w_d w_r).
"""

from collections.abc import Sequence
from itertools import pairwise
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.analytic_modes import ExactModel
from verify.arrays import Array
from verify.errors import InputError
from verify.identify.fit import Model, Parameter, Values
from verify.options import Theory
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import set_fields
from verify.problem.point_attachments import PointMass, PointSpring

WALLS = ("wall_left", "wall_right")
"""Rotational stiffness of the walls, N m/rad."""
FIRST_WALL, WALL_RANGE = 20.0, (1e-4, 1e6)
"""Initial stiffness of a clamped wall, and its bounds, times EI/L."""
RANGE = 1e3
"""Bounds of E and rho: this factor to both sides of the beam's own."""


def known_parameters(beam: Beam, names: Sequence[str]) -> dict[str, Parameter]:
    """E, rho, eta and those walls of the beam that are in `names`.

    Raises InputError for features whose derivatives are not modelled, and for a wall at an end without support.
    """
    beam.check_features("identification", ("section", "mass", "spring"))
    own = set_fields(beam)
    for name, other in (("youngs_modulus", "bending_stiffness"), ("density", "mass_per_length")):
        fields = [set_fields(one) for one in beam.section]
        if name not in own or any({name, other} & set(one) for one in fields):
            raise InputError(f"beam.{name}: identification varies that of the whole beam, give it there alone")
    known = {
        name: Parameter(own[name], unit, own[name] / RANGE, own[name] * RANGE)
        for name, unit in (("youngs_modulus", "Pa"), ("density", "kg/m^3"))
    }
    known["loss_factor"] = Parameter(max(beam.loss_factor, 1e-6), "", 1e-7, 2.0)
    unit = beam.bending_stiffness / beam.length
    for wall, support, at in zip(WALLS, beam.supports, (0.0, beam.length), strict=True):
        if wall in names:
            if support not in ("clamped", "pinned"):
                raise InputError(f"parameters: {wall} is for a clamped or a pinned end, and this one is {support}")
            first = sum(one.rotational for one in beam.spring if one.position == at) or FIRST_WALL * unit
            known[wall] = Parameter(first, "N m/rad", WALL_RANGE[0] * unit, WALL_RANGE[1] * unit)
    return known


def with_values(beam: Beam, values: Values) -> Beam:
    """The beam with other E, rho and eta; walls in `values` become pinned ends with a rotational spring."""
    supports, springs = list(beam.supports), list(beam.spring)
    for i, wall in enumerate(WALLS):
        if wall in values:
            at, supports[i] = i * beam.length, "pinned"
            springs = [one for one in springs if one.position != at]
            springs.append(PointSpring(position=at, rotational=values[wall]))
    own = {name: value for name, value in values.items() if name not in WALLS}
    return replace(beam, **own, supports=(supports[0], supports[1]), spring=tuple(springs))


def frequencies(beam: Beam, names: Sequence[str], modes: Array, theory: Theory = "euler-bernoulli") -> Model:
    """Logarithms of the frequencies of modes (n,), from 1. Raises InputError."""
    known = known_parameters(beam, names)
    bodies = tuple(one.rotary_inertia for one in beam.mass)
    if theory == "timoshenko" and (any(bodies) or set(WALLS) & set(known) or any(s.rotational for s in beam.spring)):
        raise InputError("theory = 'timoshenko': identification with rotational springs or bodies has 'rayleigh'")
    del known["loss_factor"]  # of the response alone
    index = np.asarray(modes, dtype=int) - 1

    def predict(values: Values) -> tuple[Array, dict[str, Array]]:
        own = with_values(beam, values)
        solved = ExactModel(own, theory).modes(int(index.max()) + 1)
        square = (2.0 * pi * solved.frequencies_hz[index]) ** 2
        ends = solved.slope(np.array([0.0, beam.length]))[index].T
        by = {wall: 0.5 * end**2 / square for wall, end in zip(WALLS, ends, strict=True) if wall in known}
        springs, inertia = np.zeros(len(index)), np.zeros(len(index))
        for one in own.attached:
            w, turn = (of(np.array([one.position]))[index, 0] for of in (solved.deflection, solved.slope))
            if isinstance(one, PointSpring):
                springs += (one.stiffness * w**2 + one.rotational * turn**2) / square
            else:
                inertia += one.mass * w**2 + one.rotary_inertia * turn**2
        by["youngs_modulus"] = 0.5 * (1.0 - springs) / values["youngs_modulus"]
        by["density"] = -0.5 * (1.0 - inertia) / values["density"]
        return np.log(solved.frequencies_hz[index]), by

    labels = ("mode", ""), ("frequency", "Hz")
    return Model(known, predict, np.asarray(modes, dtype=float), labels, logs=True)


def response(
    beam: Beam, names: Sequence[str], hertz: Array, force_at: float, sensor_at: float, *, phase: bool = True
) -> Model:
    """Logarithm of the receptance, ln|H| (n,), then with `phase` its angle (n,), at frequencies (n,).

    Noise of the logarithm is relative to |H|, and the same in radians. Raises InputError.
    """
    known = known_parameters(beam, names)
    bounds = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    breaks = np.unique([*bounds[:-1], beam.length, force_at, sensor_at, *(one.position for one in beam.attached)])
    omega = 2.0 * pi * np.asarray(hertz, dtype=float)
    slowest = min(piece.bending_stiffness / piece.mass_per_length for piece in beam.pieces)
    longest = float(np.sqrt(omega.max()) * slowest**-0.25)  # largest wavenumber, 1/m, of the beam as it is
    nodes, weights = list[Array](), list[Array]()
    for a, b in pairwise(breaks.tolist()):
        t, g = np.polynomial.legendre.leggauss(12 + int(1.5 * longest * (b - a)))
        nodes.append(a + 0.5 * (b - a) * (1.0 + t))
        weights.append(0.5 * (b - a) * g)
    x, weight = np.concatenate(nodes), np.concatenate(weights)
    piece = np.clip(np.searchsorted(bounds, x, side="right") - 1, 0, len(beam.pieces) - 1)

    def predict(values: Values) -> tuple[Array, dict[str, Array]]:
        own = with_values(beam, values)
        lossy = 1.0 + 1j * own.loss_factor
        drive, sensor = (
            ExactModel(own).harmonic(PointForce(position=at), hertz) for at in (force_at, sensor_at)
        )
        mass = weight * np.array([one.mass_per_length for one in own.pieces])[piece]
        places = np.array([sensor_at, 0.0, beam.length, *(one.position for one in own.attached)])
        square, h = omega**2, drive.deflection(places)[:, 0]
        across = (drive.deflection(places) * sensor.deflection(places)).T
        around = (drive.slope(places) * sensor.slope(places)).T
        distributed = (drive.deflection(x) * sensor.deflection(x)) @ mass
        work = h + square * distributed
        for one, w, turn in zip(own.attached, across[3:], around[3:], strict=True):
            if isinstance(one, PointMass):
                work = work + square * (one.mass * w + one.rotary_inertia * turn)
            else:
                work = work - one.stiffness * w - one.rotational * turn
        by = {
            "youngs_modulus": -work / values["youngs_modulus"],
            "density": square * distributed / values["density"],
            "loss_factor": -1j * work / lossy,
        }
        by |= {wall: -around[1 + i] for i, wall in enumerate(WALLS) if wall in known}
        logs = {name: one / h for name, one in by.items()}
        if not phase:
            return np.log(abs(h)), {name: one.real for name, one in logs.items()}
        y = np.concatenate([np.log(abs(h)), np.angle(h)])
        return y, {name: np.concatenate([one.real, one.imag]) for name, one in logs.items()}

    n = len(omega)
    labels = ("frequency", "Hz"), ("receptance", "m/N")
    phases, channels = ((n, 2 * n), 2) if phase else ((0, 0), 1)
    return Model(known, predict, np.asarray(hertz, dtype=float), labels, phases, channels, logs=True)
