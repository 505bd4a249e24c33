"""Feet on the nonlinear chain."""

import numpy as np
import pytest
from driven_strip import STRIP

from verify import Contact, Foot, InputError, PointForce, Slider, simulate
from verify.motor.on_chain import run_on_chain

WIDE = (Foot(length=0.02, points=3),)


def loads(size):
    return [
        PointForce(position=0.04, amplitude=size),
        PointForce(position=0.45, amplitude=0.7 * size, phase_deg=80.0),
    ]


def pressed(size, place=0.23, foot=WIDE):
    own = {"mass": 2e-3, "mu": 0.2, "slope": 100.0 / size, "gravity": 0.0, "preload": 0.3 * size, "position": place}
    return Slider(coupling="one-way", contact=Contact(stiffness=3e5, damping=5.0), foot=foot, **own)


ASKED = {"count": 9, "samples": 9, "steps_per_period": 400}


def test_in_a_small_motion_feet_move_as_on_the_linear_chain():
    """Heights part by less than a millionth; speeds in proportion to the amplitude, by how far the chain shortens."""
    apart = []
    for size in (1.0, 0.25, 0.0625):
        bent = run_on_chain(STRIP, loads(size), 900.0, 2.0 / 900.0, slider=pressed(size), **ASKED)
        straight = simulate(STRIP, loads(size), 900.0, 2.0 / 900.0, slider=pressed(size), start="rest", **ASKED)
        pairs = [(bent.height, straight.height), (bent.speed, straight.speed)]
        apart.append([np.abs(one - other).max() / np.abs(other).max() for one, other in pairs])
    heights, speeds = np.array(apart).T
    assert heights[-1] < 1e-6
    assert speeds[-1] < 1e-2
    assert np.log2(speeds[:-1] / speeds[1:]) / 2.0 == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_the_surface_of_a_chain_is_continuous_at_a_joint(links):
    joint, asked = 3 * STRIP.length / 9, {"prescribed_speed": 0.0, "fixed_position": True, "links": links}
    left, right = (
        run_on_chain(
            STRIP, loads(30.0), 900.0, 2.0 / 900.0, slider=pressed(30.0, place, ()), **ASKED, **asked
        ).surface_speed[1:]
        for place in (joint - 1e-9, joint + 1e-9)
    )
    assert left == pytest.approx(right, abs=1e-6 * np.nanmax(abs(left)))


@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_a_chain_whose_motion_is_not_resolved_is_refused(links):
    with pytest.raises(InputError, match=r"tolerance|step"):
        run_on_chain(STRIP, loads(1e5), 900.0, 3e-3, slider=pressed(1.0), links=links, **ASKED)
