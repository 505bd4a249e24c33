"""Sliders go on from one instant of one motion, each from where it was put: anything else is refused by name."""

import pytest
from msgspec.structs import replace

from verify import Beam, Contact, InputError, PointForce, Slider, run_motor, run_motors

BEAM = Beam(length=0.23, width=0.012, thickness=0.0015, youngs_modulus=105e9, density=8500.0)
FORCES = [PointForce(position=0.031, amplitude=14.0), PointForce(position=0.171, amplitude=9.0, phase_deg=-70.0)]
HERTZ = 1300.0
FIRST = Slider(
    mass=0.004, mu=0.3, preload=0.4, position=0.11, coupling="two-way", contact=Contact(stiffness=2e4, damping=1.0)
)
SLIDERS = (FIRST, replace(FIRST, position=0.15, mass=0.007))


def together(periods, sliders=SLIDERS, before=(), beam=BEAM, count=6):
    asked = {"sliders": sliders, "continue_from": before, "samples": 2}
    return run_motors(beam, FORCES, HERTZ, periods / HERTZ, model="fem", count=count, **asked)


@pytest.mark.parametrize("coupling", ["one-way", "two-way"])
def test_sliders_go_on_from_one_instant_of_one_motion(coupling):
    own = [replace(one, coupling=coupling) for one in SLIDERS]
    once, later = together(2, own), together(3, own)
    with pytest.raises(InputError, match=r"end at 0\.001538\d* s and 0\.002307\d* s"):
        together(1, own, [once[0], later[1]])
    other = together(2, [own[0], replace(own[1], preload=0.7)])
    if coupling == "two-way":
        with pytest.raises(InputError, match="the beam moves otherwise"):
            together(1, own, [once[0], other[1]])
    assert together(1, own, once)[1].travelled[-1] == pytest.approx(later[1].travelled[-1], rel=1e-9)


def test_a_slider_goes_on_from_where_it_is_on_the_beam_that_it_stood_on():
    """Of a beam that does not feel it too, which has no modes of its own that could tell."""
    own = [replace(one, coupling="one-way") for one in SLIDERS]
    once = together(2, own)
    for given, said in (
        ({"sliders": own[::-1]}, r"put on at 0\.11 m, and slider\.position = 0\.15 m"),
        ({"beam": replace(BEAM, thickness=0.0016)}, "another beam"),
        ({"count": 7}, "count = 6 and this run of model = 'fem', count = 7"),
        ({"sliders": own[:1]}, "2 runs for 1 sliders"),
    ):
        with pytest.raises(InputError, match=said):
            together(1, **{"sliders": own, "before": once, **given})
    kept = run_motor(BEAM, FORCES, HERTZ, 1.0 / HERTZ, slider=own[1], model="fem", count=6, continue_from=once[1])
    assert kept.times[0] == once[1].state.time
