"""In time a beam's loss factor damps each mode by its own share: springs, ground and axial force resist without loss."""

from math import pi

import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes, fem_beam, free_vibration, run_motor, segment_model, simulate
from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce, Section
from verify.errors import InputError
from verify.slider import Contact, Slider

BARE = Beam(length=0.83, width=0.021, thickness=0.0047, youngs_modulus=68e9, density=2650.0, loss_factor=4e-3)
BUCKLING = analytic_modes.buckling_load(BARE)
STEPPED = (Section(length=0.31, thickness=0.006), Section(length=0.52))
HELD = {
    "on ground": replace(BARE, foundation=7e4),
    "pulled": replace(BARE, tension=3.1e3, supports=("clamped", "pinned")),
    "pressed": replace(BARE, tension=-0.87 * BUCKLING),
    "on springs": replace(
        BARE,
        supports=("free", "free"),
        section=STEPPED,
        spring=(PointSpring(position=0.11, stiffness=2.1e4), PointSpring(position=0.7, stiffness=9e3, rotational=31.0)),
        mass=(PointMass(position=0.4, mass=0.05),),
    ),
}
FORCE = (PointForce(position=0.27, amplitude=1.3, phase_deg=20.0),)
X = np.array([0.19, 0.61])
MODULES = {"fem": fem_beam, "segment": segment_model}


def field(model, beam, hertz, **more):
    return MODULES[model].solve_harmonic(beam, FORCE, hertz, 26, **more).deflection(X)


def settled(model, beam, hertz, ratio, **more):
    """Amplitudes at X when a mode of this damping ratio has come to rest on its forced motion, of the last two periods."""
    n = int(16.0 / (2.0 * pi * ratio))
    run = simulate(beam, FORCE, hertz, n / hertz, model=model, count=26, at=X, samples=16 * n + 1, **more)
    last = run.deflection[-33:-1]
    wave = np.exp(-2j * pi * hertz * run.times[-33:-1])
    return 2.0 * (wave @ last) / len(wave)


@pytest.mark.parametrize("mode", [1, 2])
@pytest.mark.parametrize("how", HELD)
@pytest.mark.parametrize("model", MODULES)
def test_a_beam_driven_at_a_resonance_settles_to_its_steady_field(model, how, mode):
    """Of the first order in the losses: what couples the modes is a loss factor smaller than what they do."""
    beam = HELD[how]
    hertz = MODULES[model].solve_modes(beam, mode, 26).frequencies_hz[-1]
    steady = field(model, beam, hertz)
    bare = abs(field(model, replace(beam, loss_factor=0.0), hertz, modal_damping=2e-3))
    ratio = 2e-3 * float((bare / abs(steady)).max())
    assert settled(model, beam, hertz, ratio) == pytest.approx(steady, rel=1e-2)
    assert abs(ratio / 2e-3 - 1.0) > 0.02, "else nothing is told apart"


def test_a_ratio_that_is_given_is_of_every_mode_be_it_half_the_loss_factor():
    """A beam on ground that had the loss too would have half of it."""
    beam = HELD["on ground"]
    hertz = fem_beam.solve_modes(beam, 1, 26).frequencies_hz[0]
    expected = field("fem", replace(beam, loss_factor=0.0), hertz, modal_damping=2e-3)
    assert settled("fem", beam, hertz, 2e-3, modal_damping=2e-3) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("how", HELD)
def test_a_beam_let_go_loses_what_bending_loses(how):
    beam, periods = HELD[how], 75
    hertz = fem_beam.solve_modes(beam, 1, 26).frequencies_hz[0]
    steady = abs(field("fem", beam, hertz))
    ratio = 2e-3 * float((abs(field("fem", replace(beam, loss_factor=0.0), hertz, modal_damping=2e-3)) / steady).max())
    told = free_vibration(beam, 1, periods / hertz, amplitude=1e-3, model="fem", count=26, at=X)
    energy = told.kinetic + told.elastic
    assert energy[-1] / energy[0] == pytest.approx(np.exp(-4.0 * pi * ratio * periods), rel=6e-3)
    assert told.damping[0] == pytest.approx(ratio, rel=2e-3)
    assert "what the loss factor 0.004 comes to in each mode" in " ".join(told.notes)


def test_a_foot_on_a_beam_from_rest_rides_on_the_field_of_a_steady_start():
    beam = replace(HELD["pressed"], loss_factor=0.02)
    hertz = 1.013 * fem_beam.solve_modes(beam, 1, 26).frequencies_hz[0]
    foot = Slider(mass=1e-3, mu=0.2, gravity=0.0, preload=0.3, position=0.33, law="coulomb", coupling="one-way",
                  contact=Contact(stiffness=4e4, damping=20.0))  # fmt: skip
    last = {}
    for start, periods in (("steady", 4), ("rest", 120)):
        run = run_motor(
            beam, FORCE, hertz, periods / hertz, slider=foot, start=start, model="fem", count=26, at=X, frozen=True
        )
        last[start] = run.deflection[-1]
    assert last["rest"] == pytest.approx(last["steady"], rel=5e-3)


def test_a_mode_that_would_creep_back_is_refused():
    beam = replace(BARE, tension=-0.99 * BUCKLING, loss_factor=0.3)
    with pytest.raises(
        InputError, match=r"beam.loss_factor = 0.3 comes to a ratio of 17.1 in mode 1, which does not swing"
    ):
        free_vibration(beam, 1, 0.1, amplitude=1e-3, model="segment", count=26, at=X)
    assert (
        free_vibration(beam, 1, 0.1, amplitude=1e-3, model="segment", count=26, at=X, modal_damping=0.1).times[0] == 0
    )
