"""Waves along a chain of equal links: dispersion and cut-off, dimensionless with l as unit of length.

In a wave e^{-i mu j} over links j with rotation theta and deflection w of the middles, joints bend by 2 i s theta and
slip by 2 i s w + c theta, s = sin(mu/2), c = cos(mu/2).
"""

from typing import Any

import numpy as np

from verify.arrays import Array


def phase(
    omega2: float,
    joint: complex,
    slip: complex = 0.0,
    *,
    spin: float = 0.0,
    tension: float = 0.0,
    foundation: float = 0.0,
    tensioned: bool = False,
) -> complex:
    """Phase mu of a wave from one link to the next at omega^2.

    `joint` is k of a joint with its losses, `slip` its slip compliance g, `spin` rho I of the links. With
    L = omega^2 - k_f, B = T + k_f/12 - (1/12 + rho I) omega^2 and S = s^2 the determinant of the force and moment
    balances vanishes for 16 k S^2 + (4 B + L - 4 k g L) S = (1 + g B) L.
    """
    load, spun = omega2 - foundation, spin * omega2
    if tensioned:  # the corrections of these joints are axial force, rotary inertia and mass of a twelfth
        joint, slip = joint - (tension - spun) / 12.0, slip / (1.0 + slip * omega2 / 12.0)
    turn = tension - load / 12.0 - spun
    b, c = 4.0 * turn + load - 4.0 * joint * slip * load, (1.0 + slip * turn) * load
    # the lower branch, without a difference of large numbers
    return complex(2.0 * np.arcsin(np.sqrt(2.0 * c / (b + np.sqrt(b * b + 64.0 * joint * c + 0j)) + 0j)))


def cut_off2(
    lengths: Array, stiffnesses: Array, masses: Array, inertias: Array, shears: Any, tension: float, foundation: float
) -> float:
    """Squared cut-off frequency, mu = pi, the least over links (N,) of EI, m, J and kappa G A (infinite: no shear).

    48 EI/(rho A l^4) without tension, foundation and shear (links rotate); else the lower of rotation and slip.
    """
    turning = 4.0 * stiffnesses / lengths + tension * lengths + foundation * lengths**3 / 12.0
    slipping = 4.0 * shears / lengths + foundation * lengths
    return max(float(np.minimum(turning / inertias, slipping / masses).min()), 0.0)
