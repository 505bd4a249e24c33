"""A beam released from a shape, against its modes by Hermite elements, least squares and closed forms."""

import numpy as np
import pytest
from reference.slider import hermite_modes

from verify.dynamics.free_vibration import CORNERS, free_vibration
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.point_attachments import PointMass

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
ARM = Beam(
    length=0.31, width=0.013, thickness=0.0017, youngs_modulus=71e9, density=2710.0, supports=("clamped", "free")
)
PLACES = (0.07, 0.213)


def tip(x):
    """A cantilever's deflection under a force at its tip, a millimetre there."""
    return 1e-3 * x**2 * (3 * ARM.length - x) / (2 * ARM.length**3)


@pytest.mark.parametrize("damping", [0.0, 0.07])
@pytest.mark.parametrize("mode", [1, 4])
def test_a_released_mode_swings_at_its_own_frequency(mode, damping):
    modes = hermite_modes(STRIP, 6)
    own, shape = (
        modes.own[mode - 1],
        np.array([modes.shape(x, 0)[mode - 1] for x in np.linspace(0, STRIP.length, 2001)]),
    )
    motion = free_vibration(
        STRIP, mode, 4e-3, amplitude=2e-5, model="fem", count=6, at=PLACES, samples=9, modal_damping=damping
    )
    turning = own * np.sqrt(1 - damping**2)
    swing = np.exp(-damping * own * motion.times) * (
        np.cos(turning * motion.times) + damping * own / turning * np.sin(turning * motion.times)
    )
    here = np.array([modes.shape(x, 0)[mode - 1] for x in PLACES]) * 2e-5 / abs(shape).max()
    expected = np.outer(swing, here * np.sign(shape[np.argmax(abs(shape) > 1e-3 * abs(shape).max())]))
    assert motion.deflection == pytest.approx(expected, abs=1e-6 * 2e-5)
    assert motion.truncation == 0.0


def test_a_cubic_shape_is_represented_exactly_by_elements():
    motion = free_vibration(ARM, tip, 2e-3, model="fem", count=5, at=PLACES, samples=5)
    assert motion.truncation < 1e-9
    assert CORNERS not in motion.notes
    assert motion.deflection[0] == pytest.approx([tip(x) for x in PLACES], rel=1e-9)
    stiffness = ARM.bending_stiffness
    assert motion.elastic[0] == pytest.approx(0.5 * 3 * stiffness / ARM.length**3 * 1e-3**2, rel=1e-9)
    assert motion.kinetic + motion.elastic == pytest.approx(motion.elastic[0], rel=1e-9)


def test_mean_square_shares_weigh_bodies_with_their_inertia():
    body = PointMass(position=0.2, mass=0.019, rotary_inertia=4e-6)
    beam = Beam(**{**{f: getattr(ARM, f) for f in ("length", "width", "thickness", "youngs_modulus", "density")},
                   "supports": ("clamped", "free"), "mass": (body,)})  # fmt: skip
    motion = free_vibration(beam, tip, 1e-3, velocity=lambda x: 0.3 * x**2, model="fem", count=5, samples=2)
    x, w = np.polynomial.legendre.leggauss(40)
    x, w = 0.5 * ARM.length * (x + 1), 0.5 * ARM.length * w
    kinetic = 0.5 * (
        ARM.mass_per_length * w @ (0.3 * x**2) ** 2 + body.mass * (0.3 * 0.2**2) ** 2 + 4e-6 * (0.6 * 0.2) ** 2
    )
    assert motion.kinetic[0] == pytest.approx(kinetic, rel=2e-4)


@pytest.mark.parametrize("model", [{"model": "segment", "count": 15}, {"model": "analytic", "modes": 15}])
def test_a_table_with_corners_is_approached_in_the_mean_square(model):
    length = STRIP.length
    table = ([0.0, 0.3 * length, length], [0.0, 1e-4, 0.0])
    motion = free_vibration(STRIP, table, 1e-3, **model, at=[0.3 * length], samples=3)
    assert 1e-3 < motion.truncation < 0.03
    assert motion.deflection[0, 0] == pytest.approx(1e-4, rel=0.06)
    assert CORNERS in motion.notes
    many = free_vibration(STRIP, table, 1e-3, model="analytic", modes=200, at=[0.3 * length], samples=3)
    assert many.truncation < 0.1 * motion.truncation


def test_damping_ratio_follows_the_loss_factor_of_the_beam():
    lossy = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0, loss_factor=0.02)
    motion = free_vibration(lossy, 2, 0.05, amplitude=1e-5, model="fem", count=6, samples=3)
    own = 2 * np.pi * motion.frequencies_hz[1]
    total = motion.kinetic + motion.elastic
    assert np.log(total[0] / total[-1]) == pytest.approx(2 * 0.01 * own * 0.05, rel=0.02)


@pytest.mark.parametrize(
    ("shape", "more", "field"),
    [
        (None, {}, "shape"),
        (9, {"amplitude": 1e-4}, "shape"),
        (1, {}, "amplitude"),
        (tip, {"amplitude": 1e-4}, "amplitude"),
        (tip, {"velocity": 2}, "velocity"),
        (lambda x: 1e-4 + x, {}, "clamped"),
        (([0.0, 0.2], [0.0, 1e-4]), {}, "x that ascends"),
        (lambda x: np.nan * x, {}, "finite"),
    ],
)
def test_bad_shapes_are_refused_by_name(shape, more, field):
    with pytest.raises(InputError, match=field):
        free_vibration(ARM, shape, 1e-3, model="fem", count=4, **more)


def test_a_beam_with_rigid_body_motions_is_refused():
    loose = Beam(
        length=0.3, width=0.01, thickness=0.001, youngs_modulus=7e10, density=2700.0, supports=("free", "free")
    )
    with pytest.raises(InputError, match="rigid"):
        free_vibration(loose, 1, 1e-3, amplitude=1e-5, model="fem", count=4)
