"""Material, loss factor and wall stiffness of a beam from natural frequencies or from a frequency response.

The exact beam predicts. A frequency has the derivatives, by Rayleigh's quotient with the shape w of modal mass 1,

    d ln f/d k_r = w'^2/(2 omega^2) at a wall of stiffness k_r,
    d ln f/d ln E = (1 - sum k w^2/omega^2)/2 over springs,   d ln f/d ln rho = -(1 - sum m w^2)/2 over bodies:

without springs and bodies E and rho change all frequencies alike, which determine E/rho alone. A receptance H, with the
fields u and v under unit forces at the drive and at the sensor and M = integral of rho A u v, has, by virtual work,

    dH/d k_r = -u' v',   dH/d ln rho = omega^2 M,   dH/d ln E = -A,   dH/d eta = -i A/(1 + i eta),
    A = H - sum k u v + omega^2 (M + sum m u v).
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
from verify.linear.numerics import gauss_rule
from verify.problem.beam import Beam, PointForce, check_features
from verify.problem.cross_section import set_fields
from verify.problem.point_attachments import PointSpring

WALLS = ("wall_left", "wall_right")  # Rotational stiffness of the walls, N m/rad
FIRST_WALL, WALL_RANGE, RANGE = 20.0, (1e-4, 1e6), 1e3
"""Initial stiffness of a clamped wall and its bounds, times EI/L; bounds of E and rho, a factor to both sides."""


def known(beam: Beam, names: Sequence[str]) -> dict[str, Parameter]:
    """E, rho, eta, and those walls of the beam that are in `names`.

    Raises InputError for features whose derivatives are not modelled, and for a wall at an end without support.
    """
    check_features(beam, "identification", ("section", "attached"))
    own, parameters = set_fields(beam), dict[str, Parameter]()
    rows = ("youngs_modulus", "bending_stiffness", "Pa"), ("density", "mass_per_length", "kg/m^3")
    for name, other, unit in rows:
        if name not in own or any({name, other} & set(set_fields(one)) for one in beam.section):
            raise InputError(f"beam.{name}: identification varies that of the whole beam, give it there alone")
        parameters[name] = Parameter(own[name], unit, own[name] / RANGE, own[name] * RANGE)
    parameters["loss_factor"] = Parameter(max(beam.loss_factor, 1e-6), "", 1e-7, 2.0)
    stiffness = beam.bending_stiffness / beam.length
    for wall, support, at in zip(WALLS, beam.supports, (0.0, beam.length), strict=True):
        if wall in names:
            if support not in ("clamped", "pinned"):
                raise InputError(f"parameters: {wall} is for a clamped or a pinned end, and this one is {support}")
            first = sum(one.rotational for one in beam.spring if one.position == at) or FIRST_WALL * stiffness
            parameters[wall] = Parameter(first, "N m/rad", *(edge * stiffness for edge in WALL_RANGE))
    return parameters


def varied(beam: Beam, values: Values) -> Beam:
    """The beam with other E, rho and eta; walls in `values` are pinned ends with a rotational spring."""
    supports, springs = list(beam.supports), list(beam.spring)
    for at, (i, wall) in zip((0.0, beam.length), enumerate(WALLS), strict=True):
        if wall in values:
            supports[i] = "pinned"
            springs = [one for one in springs if one.position != at]
            springs.append(PointSpring(position=at, rotational=values[wall]))
    own = {name: value for name, value in values.items() if name not in WALLS}
    return replace(beam, **own, supports=tuple(supports), spring=tuple(springs))


def frequencies(beam: Beam, names: Sequence[str], modes: Array) -> Model:
    """Logarithms of the frequencies of modes (n,), from 1, by Euler-Bernoulli theory; noise is relative.

    Raises InputError.
    """
    parameters, index = known(beam, names), np.asarray(modes, dtype=int) - 1
    del parameters["loss_factor"]
    if (index != np.asarray(modes) - 1).any() or index.min() < 0:
        raise InputError(f"modes = {modes.tolist()}: give mode numbers from 1")

    def predict(values: Values) -> tuple[Array, dict[str, Array]]:
        own = varied(beam, values)
        solved = ExactModel(own).modes(int(index.max()) + 1)
        hertz = solved.frequencies_hz[index]
        square, stiff, heavy = (2.0 * pi * hertz) ** 2, np.zeros(len(index)), np.zeros(len(index))
        places = np.array([0.0, beam.length, *(one.position for one in own.attached)])
        w, turn = np.zeros((2, len(places), len(index)))
        if own.attached:
            w, turn = (read(places)[index].T ** 2 for read in (solved.deflection, solved.slope))
        for one, across, around in zip(own.attached, w[2:], turn[2:], strict=True):
            heavy += one.mass * across + one.rotary_inertia * around
            stiff += (one.stiffness * across + one.rotational * around) / square
        by = {wall: 0.5 * end / square for wall, end in zip(WALLS, turn[:2], strict=True) if wall in values}
        by["youngs_modulus"] = 0.5 * (1.0 - stiff) / values["youngs_modulus"]
        by["density"] = -0.5 * (1.0 - heavy) / values["density"]
        return np.log(hertz), by

    return Model(parameters, predict, np.asarray(modes), (("mode", ""), ("frequency", "Hz")), logs=True)


def response(
    beam: Beam, names: Sequence[str], hertz: Array, force_at: float, sensor_at: float, *, phase: bool = True
) -> Model:
    """ln|H| of the receptance, (n,), then with `phase` its angle, (n,), at frequencies (n,), by Euler-Bernoulli theory.

    Noise is relative to |H|, and the same in radians. Raises InputError.
    """
    parameters, square = known(beam, names), (2.0 * pi * hertz) ** 2
    bounds = np.cumsum([0.0, *(piece.length for piece in beam.pieces)])
    stops = [*bounds[:-1].tolist(), beam.length, force_at, sensor_at, *(one.position for one in beam.attached)]
    slow = min(piece.bending_stiffness / piece.mass_per_length for piece in beam.pieces)
    wavenumber, rules = float((square.max() / slow) ** 0.25), list[tuple[Array, Array]]()
    for a, b in pairwise(sorted(set(stops))):  # between them the fields are smooth
        own = gauss_rule((a, b), 1 + int(wavenumber * (b - a) / pi))
        rules.append((own.x, (b - a) * own.weights))
    x, weight = map(np.concatenate, zip(*rules, strict=True))
    piece = np.searchsorted(bounds[1:-1], x, side="right")

    def predict(values: Values) -> tuple[Array, dict[str, Array]]:
        own = varied(beam, values)
        u, v = (ExactModel(own).harmonic(PointForce(position=at), hertz) for at in (force_at, sensor_at))
        mass = weight * np.array([one.mass_per_length for one in own.pieces])[piece]
        places = np.array([0.0, beam.length, sensor_at, *(one.position for one in own.attached)])
        read = u.deflection(places)
        if not read[:, 2].all():
            raise InputError("force_at or sensor_at is at a support, where the response is zero: move it")
        h, w, turn = read[:, 2], (read * v.deflection(places)).T, (u.slope(places) * v.slope(places)).T
        inertia = square * ((u.deflection(x) * v.deflection(x)) @ mass)
        work = h + inertia
        for one, across, around in zip(own.attached, w[3:], turn[3:], strict=True):
            work = work + square * (one.mass * across + one.rotary_inertia * around)
            work = work - one.stiffness * across - one.rotational * around
        by = {wall: -end for wall, end in zip(WALLS, turn[:2], strict=True) if wall in values}
        by |= {"youngs_modulus": -work / values["youngs_modulus"], "density": inertia / values["density"]}
        by["loss_factor"] = -1j * work / (1.0 + 1j * own.loss_factor)
        parts = (np.real, np.imag)[: 1 + phase]
        y = np.concatenate([np.log(abs(h)), *([np.angle(h)] if phase else [])])
        return y, {name: np.concatenate([part(one / h) for part in parts]) for name, one in by.items()}

    labels = ("frequency", "Hz"), ("receptance", "m/N")
    return Model(parameters, predict, hertz, labels, 1 + phase, logs=True)
