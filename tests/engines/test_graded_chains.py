"""Chains of stepped and tapered rods, joints of half links in series: errors in both planes and torsion, of order two."""

import numpy as np
import pytest
from msgspec.structs import replace
from reference.curved_rods import frequencies
from scipy.optimize import brentq

from verify import Beam, Section
from verify.engines.describe import describe
from verify.exact.torsion import shafts
from verify.problem.beam import in_plane

ROD = Beam(
    length=0.83, width=0.021, thickness=0.009, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free")
)
STEPPED = replace(
    ROD,
    section=(
        Section(length=0.3),
        Section(length=0.2, thickness=0.006, width=0.018),
        Section(length=0.33, thickness=0.004),
    ),
)
L, TAPER = ROD.length, 1.7
"""Both sides of the tapered section fall by exp(-TAPER s/4L): EI, GJ and polar inertia by exp(-TAPER s/L)."""


def tapered(count):
    """One section a link, that of the taper at the link's middle."""
    scale = np.exp(-TAPER * (np.arange(count) + 0.5) / count / 4).tolist()
    return replace(ROD, section=[Section(length=L / count, width=0.021 * one, thickness=0.009 * one) for one in scale])


def bending_hz(rod):
    """Of the taper by Ritz's method."""

    def stiffness(s):
        return np.exp(-TAPER * s / L)[:, None] * [1e9, 1e9, rod.bending_stiffness]  # the others are far above

    straight = lambda s: np.tile(np.eye(3), (len(s), 1, 1))  # noqa: E731
    mass = ROD.mass_per_length
    return frequencies(straight, L, stiffness, lambda s: mass * np.exp(-TAPER * s / L / 2))[:3] / (2 * np.pi)


def torsion_hz():
    """Of the taper: theta = exp(a s/2) sin(q s), a = TAPER/L, with a sin(q L) + 2 q cos(q L) = 0 at the free end."""
    _, stiffness, inertia = shafts(ROD)[0]
    free = lambda q: TAPER * np.sin(q) + 2 * q * np.cos(q)  # noqa: E731
    roots = np.array([brentq(free, (k + 0.5) * np.pi, (k + 1) * np.pi) for k in range(3)])
    return np.sqrt(stiffness / inertia * (roots**2 + TAPER**2 / 4)) / (2 * np.pi * L)


@pytest.mark.parametrize("axis", ["bending", "width", "torsion"])
@pytest.mark.parametrize("wall", ["gregory", "half"])
@pytest.mark.parametrize(
    ("make", "count", "largest"), [(lambda n: STEPPED, 83, 1e-3), (tapered, 40, 3e-3)], ids=["stepped", "tapered"]
)
def test_errors_are_of_order_two(make, count, largest, wall, axis):
    errors = []
    for n in (count, 2 * count):
        flat = in_plane(make(n), axis) if axis != "torsion" else make(n)
        chain = describe(flat, n, wall=wall, in_space=axis == "torsion")
        own = "torsion" if axis == "torsion" else "bending"
        taper = torsion_hz() if axis == "torsion" else bending_hz(in_plane(ROD, axis))
        exact = chain.exact_hz(own, 3) if make(n) is STEPPED else taper
        errors.append(chain.frequencies_hz(own, 3) / exact - 1)
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.1)
    assert abs(errors[0]).max() < largest
