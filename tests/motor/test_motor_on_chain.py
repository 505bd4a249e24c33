"""A motor on the nonlinear chain, beside the same motor on the linear one."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.motor.run import run_motor
from verify.slider import Contact, Foot, Slider

BEAM = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
HERTZ = 900.0
POINT = Slider(mass=2e-3, mu=0.2, slope=100.0, preload=30.0, coupling="one-way", contact=Contact(stiffness=3e5))


def pushed(model, size):
    """Two periods of everything `size` times as large: forces, preload, what friction's slope asks of speeds."""
    forces = [
        PointForce(position=0.04, amplitude=size),
        PointForce(position=0.45, amplitude=0.7 * size, phase_deg=80.0),
    ]
    slider = Slider(
        mass=2e-3,
        mu=0.2,
        slope=100.0 / size,
        gravity=0.0,
        preload=0.3 * size,
        position=0.23,
        coupling="one-way",
        contact=Contact(stiffness=3e5, damping=5.0),
        foot=(Foot(length=0.02, points=3),),
    )
    asked = {"model": model, "count": 9, "start": "rest", "samples": 9, "steps_per_period": 400}
    return run_motor(BEAM, forces, HERTZ, 2.0 / HERTZ, slider=slider, **asked)


def test_on_a_small_motion_the_nonlinear_chain_carries_a_motor_as_the_linear_one_does():
    """Heights part by less than a millionth; speeds by what the chain draws in, of first order beside themselves."""
    sizes, apart = (1.0, 0.25, 0.0625), []
    for size in sizes:
        bent, straight = pushed("chain", size), pushed("segment", size)
        pairs = [(bent.height, straight.height), (bent.speed, straight.speed)]
        apart.append([np.abs(one - other).max() / np.abs(other).max() for one, other in pairs])
    heights, speeds = np.array(apart).T
    assert heights[-1] < 1e-6
    assert np.all(np.diff(heights) < 0.0)
    assert speeds[-1] < 1e-2
    orders = np.log2(speeds[:-1] / speeds[1:]) / 2.0
    assert np.all((orders > 0.9) & (orders < 1.1))


def held_at(place, links):
    """Speeds of the surface under a point that is kept at its place, over a period at 30 N."""
    forces = [PointForce(position=0.04, amplitude=30.0), PointForce(position=0.45, amplitude=21.0, phase_deg=80.0)]
    run = run_motor(
        BEAM,
        forces,
        HERTZ,
        1.0 / HERTZ,
        slider=replace(POINT, position=place),
        model="chain",
        count=9,
        start="rest",
        links=links,
        held_speed=0.0,
        frozen=True,
        samples=62,
    )
    return run.surface_speed[1:]


@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_the_surface_of_a_chain_goes_along_x_with_the_very_point_of_the_link(links):
    """On either side of a joint alike; by the middles of its links it would jump there."""
    joint = 3 * BEAM.length / 9
    left, right = held_at(joint - 1e-9, links), held_at(joint + 1e-9, links)
    assert left == pytest.approx(right, abs=1e-6 * np.nanmax(abs(left)))


def from_rest(model, size=1.0, links="rigid", periods=1.0, **more):
    """A point under forces `size` times as large."""
    forces = [
        PointForce(position=0.04, amplitude=size),
        PointForce(position=0.45, amplitude=0.7 * size, phase_deg=80.0),
    ]
    kind = {"links": links} if model == "chain" else {}
    asked = {"model": model, "count": 9, "start": "rest", "samples": 3} | kind | more
    return run_motor(BEAM, forces, HERTZ, periods / HERTZ, slider=replace(POINT, position=0.23), **asked)


def test_no_run_goes_on_from_a_chain_and_no_chain_from_a_run():
    bent, straight = from_rest("chain"), from_rest("segment")
    assert (bent.state.model, straight.state.model) == ("chain", "segment")
    for before in (bent, straight):
        with pytest.raises(InputError, match="continue_from on a nonlinear chain, which starts at rest: leave it out"):
            from_rest("chain", continue_from=before)
    with pytest.raises(InputError, match="continue_from is a run on a nonlinear chain, whose motion is not kept"):
        from_rest("segment", continue_from=bent)


@pytest.mark.parametrize("links", ["rigid", "stretching"])
def test_a_motor_on_links_that_turn_so_far_that_nobody_knows_them_is_refused(links):
    named = "tolerance" if links == "rigid" else "step of the stretching chain"
    with pytest.raises(InputError, match=rf"{named} = .* leaves the motion unknown after .*; give a shorter time or"):
        from_rest("chain", 4e4, links, periods=8.0)


def test_bending_draws_links_in_with_the_square_of_the_force_and_a_linear_field_has_none_of_it():
    speeds = [from_rest("chain", size).motor_margins.drawn for size in (0.3, 0.6)]
    assert speeds[1] / speeds[0] == pytest.approx(4.0, rel=1e-2)
    assert from_rest("segment").motor_margins.drawn is None
