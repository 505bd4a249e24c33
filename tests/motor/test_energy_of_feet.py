"""Springy feet on a beam that feels them make no energy: nothing drives, damps or rubs, and the whole is kept.

A foot reads w(X) at X = x + (h/2) w'(x). The force of its spring works on every mode by as much as that mode moves
w(X): by virtual work on what the spring's own length is read from, square to the surface.
"""

from types import FunctionType

import numpy as np
import pytest
from books_reference import hermite_modes
from motor_references import Modes
from msgspec.structs import replace
from numba import njit

from verify.beam import Beam, PointForce
from verify.models.kernels import part
from verify.motion.surface import basis_of
from verify.motor import beam_kernels, kernels
from verify.motor.records import AT
from verify.motor.run import run_motor
from verify.slider import Contact, Foot, Slider

BEAM = Beam(length=0.31, width=0.017, thickness=0.0123, youngs_modulus=113e9, density=4470.0)
HERTZ, PLACE, STIFFNESS, LOAD, MASS = 700.0, 0.1187, 6e6, 1e4, 0.02
PERIOD, HALF = 1.0 / HERTZ, 0.5 * BEAM.thickness
FORCES = (
    PointForce(position=0.05, amplitude=1000.0),
    PointForce(position=0.23, amplitude=700.0, phase_deg=77.0),
)
STILL = tuple(replace(force, amplitude=0.0) for force in FORCES)
FEET = {
    "a point": Foot(mass=MASS),
    "below": Foot(mass=MASS, face="lower"),
    "three points that pitch": Foot(mass=MASS, length=0.023, points=3, inertia=1.7e-6),
    "between two beams": Foot(mass=MASS, mirrored=True),
}


def put(name):
    return Slider(
        mass=0.05,
        mu=1e-12,
        law="coulomb",
        gravity=0.0,
        preload=LOAD,
        position=PLACE,
        coupling="two-way",
        contact=Contact(stiffness=STIFFNESS),
        foot=(FEET[name],),
    )


def ridden(name, forces, turns, steps, before=None):
    settings = {"model": "fem", "count": 4, "modal_damping": 0.0, "held_speed": 0.0, "frozen": True, "samples": 2}
    settings |= {"start": "rest", "step": PERIOD / steps, "continue_from": before}
    return run_motor(BEAM, forces, HERTZ, turns * PERIOD, slider=put(name), **settings)


def energy(name, state):
    """(of all, in the beam's motion and bending), joules: of beam, foot, springs and what presses, by what they are."""
    foot, basis = FEET[name], basis_of(BEAM, "fem", 4, 80, "spline")
    q, (height, climb, pitch, turn) = state.q, state.feet[0]
    places = np.linspace(-1.0, 1.0, 2 * foot.points + 1)[1::2] * 0.5 * foot.length
    face = -1.0 if foot.face == "lower" else 1.0
    at = PLACE + places + face * HALF * (q @ basis.shapes(PLACE + places, 1))
    level = q @ basis.shapes(at, 0)
    beam = 0.5 * state.rates @ state.rates + 0.5 * (basis.omegas * q) @ (basis.omegas * q)
    moving = 0.5 * MASS * climb**2 + (0.5 * foot.inertia * turn**2 if foot.inertia else 0.0)
    if foot.mirrored:  # two beams, of which one is kept, press from both sides: at rest with the preload
        deep = LOAD / STIFFNESS + level - lying(basis) + np.array([-height, height])
        assert np.all(deep > 0.0)
        return 2.0 * beam + moving + 0.5 * STIFFNESS * deep @ deep, 2.0 * beam
    deep = face * (level - height - places * pitch)
    assert np.all(deep > 0.0)
    springs = 0.5 * STIFFNESS / foot.points * deep @ deep
    return beam + moving + springs + face * LOAD * height, beam


def lying(basis):
    """Height of what a foot stands on where its preload bends the beam, by virtual work; each pass has 1e-2 left."""
    q, here = np.zeros(len(basis.omegas)), basis.shapes(np.array([PLACE]), 1)[:, 0]
    for _ in range(20):
        at = np.array([PLACE + HALF * (q @ here)])
        lean = HALF * (q @ basis.shapes(at, 1)[:, 0])
        q = -LOAD * (basis.shapes(at, 0)[:, 0] + lean * here) / basis.omegas**2
    return q @ basis.shapes(np.array([PLACE + HALF * (q @ here)]), 0)[:, 0]


def gained(name, steps):
    """What a beam on its own gains with its foot in 18 periods after two of driving, over what it had, every third."""
    run = ridden(name, FORCES, 2, steps)
    (first, beam), found = energy(name, run.state), []
    for _ in range(6):
        run = ridden(name, STILL, 3, steps, run)
        assert run.statistics.finished
        assert run.contact_share[-1] == pytest.approx(1.0, rel=1e-9)
        found.append(energy(name, run.state)[0] - first)
    return np.array(found) / beam


@pytest.mark.parametrize("name", FEET)
def test_energy_is_kept_to_the_second_order_of_the_step(name):
    coarse, fine = (abs(gained(name, steps)).max() for steps in (1000, 4000))
    assert fine < (4e-7 if FEET[name].mirrored else 3e-8)
    assert 14.0 < coarse / fine < 18.0


def _straight_up(i, d, lever, length, touch):
    return touch[i, AT] ** d


def _anew(kernel):
    """A kernel's function under a name of its own, to be compiled with what its module has now, and not kept."""
    true = kernel.py_func
    copy = FunctionType(true.__code__, true.__globals__, f"{true.__name__}_planted")
    copy.__qualname__ = copy.__name__
    return copy


def test_a_force_straight_up_makes_energy_whatever_the_step(monkeypatch):
    """As it was: the same beam's energy goes up and down by parts in ten thousand, at every step alike."""
    monkeypatch.setattr(beam_kernels, "_lift", part()(_straight_up))
    for name in ("_add", "bear", "match", "moved", "_give_way", "_rub_back"):
        own = [one for one in (beam_kernels, kernels) if hasattr(one, name)]
        fresh = part()(_anew(getattr(own[0], name)))
        for one in own:
            monkeypatch.setattr(one, name, fresh)
    monkeypatch.setattr(kernels, "ride", njit(error_model="numpy")(_anew(kernels.ride)))
    coarse, fine = (gained("a point", steps) for steps in (1000, 4000))
    assert abs(fine).max() > 1e-4
    assert coarse == pytest.approx(fine, abs=1e-2 * abs(fine).max())


def test_the_reference_lifts_by_virtual_work():
    """How w(X) changes with every mode, by central differences: what `test_beam_that_feels` holds runs to."""
    own, shape = hermite_modes(BEAM)
    beam = Modes(own, shape, 0.0, (), 1.0, HALF)
    q = 1e-3 * np.sin(1.0 + np.arange(len(own))) / (1.0 + np.arange(len(own)))
    step = 1e-6 * np.eye(len(q))
    found = [(beam.height(q + one, PLACE) - beam.height(q - one, PLACE)) / 2e-6 for one in step]
    lifted, flat = beam.lifted(q, PLACE), shape(PLACE + HALF * (q @ shape(PLACE, 1)), 0)
    assert np.allclose(found, lifted, rtol=0.0, atol=1e-8 * abs(lifted).max())
    assert abs(lifted - flat).max() > 1e-3 * abs(lifted).max()
