"""A run in which the slider gives the beam far more than it and the forces had put in is refused; no sound run is."""

import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.motion import sound_books
from verify.motion.simulate import simulate
from verify.slider import Slider

BEAM = Beam(length=0.37, width=0.02, thickness=0.0043, youngs_modulus=70e9, density=2700.0)
HERTZ = 900.0
FORCES = (PointForce(position=0.05, amplitude=0.007), PointForce(position=0.31, amplitude=0.005, phase_deg=70.0))
GRIP = {"mass": 0.44, "mu": 0.6, "position": 0.14, "preload": 0.3, "coupling": "two-way"}


def ridden(share=None, scale=1.0, turns=5.0, before=None, model="segment", count=40, ledger=True, **given):
    """On a beam that feels its slider; `share` of a period is the step."""
    forces = [replace(one, amplitude=scale * one.amplitude) for one in FORCES]
    settings = {"model": model, "count": count, "continue_from": before, "ledger": ledger}
    step = None if share is None else share / HERTZ
    slider = Slider(**(GRIP | given))
    return simulate(BEAM, forces, HERTZ, turns / HERTZ, slider=slider, step=step, samples=5, **settings)


def given_and_had(run):
    """What the slider gave the beam over the work of the forces."""
    return (run.ledger.contact_on_beam + run.ledger.normal_on_beam) / run.ledger.work_in


@pytest.mark.parametrize(
    ("step", "given"),
    [
        (1 / 64, {"slope": 3e4, "normal": "massless"}),
        (1 / 64, {"law": "coulomb", "normal": "massless"}),
        (1 / 64, {"slope": 3e4}),
        (1 / 64, {"law": "coulomb"}),
    ],
)
def test_a_stick_that_feeds_fast_modes_is_refused_and_the_same_in_shorter_steps_is_not(step, given):
    """Fifty times and more of what was put in, finite to the last digit; half the step, or a quarter, is taken."""
    with pytest.raises(
        InputError, match=r"^step = 1\.74e-05 s: the slider gave the beam .* J, where .* a step of at most"
    ):
        ridden(step, **given)
    share = 0.5 if "slope" in given else 0.25
    assert given_and_had(ridden(share * step, **given)) < 1.0
    assert ridden(step, ledger=False, **given).ledger is None


def test_the_step_that_is_told_is_taken():
    with pytest.raises(InputError) as told:
        ridden(1 / 64, law="coulomb", normal="massless")
    enough = float(str(told.value).split("at most ")[1].split()[0])
    assert given_and_had(ridden(enough * HERTZ, law="coulomb", normal="massless")) < 1.0


@pytest.mark.parametrize(
    "given",
    [
        {"scale": 0.0},
        {"scale": 1e-9},
        {"scale": 0.0, "speed": 0.3},
        {"scale": 0.0, "speed": 1e-3, "normal": "massless"},
        {"scale": 0.0, "speed": -2.0, "kinematics": "following"},
        {"scale": 1e-6, "mass": 1e-5, "preload": 40.0, "speed": 3.0, "position": 0.01, "turns": 60.0},
        {"model": "fem", "count": 12, "scale": 1e-4, "mass": 3.0, "law": "coulomb"},
    ],
)
def test_weight_speed_and_small_forces_are_no_reason(given):
    """Not even where nothing drives: what lies on the beam, or moves, may give what it has."""
    run = ridden(**given)
    assert run.statistics.finished or run.statistics.stopped == "left the beam"
    assert run.ledger is not None


def test_a_beam_that_goes_on_by_itself_is_no_reason():
    """Moving at the start, and driven by nothing: what it has is stored."""
    before = ridden(scale=1e3, slope=50.0)
    run = ridden(scale=0.0, slope=50.0, before=before)
    assert run.ledger.work_in == 0.0
    assert run.ledger.kinetic + run.ledger.elastic > 0.0


def test_what_is_refused_is_what_the_slider_gave(monkeypatch):
    """The bound is on that alone: a sound run is refused where it is taken away, below what it gave."""
    run = ridden(slope=50.0)
    assert 0.0 < given_and_had(run) < 1.0
    monkeypatch.setattr(sound_books, "MOST", 0.0)
    with pytest.raises(
        InputError, match=r"the slider gave the beam .* at most .*, or steps_per_period = \d+, and halve it"
    ):
        ridden(slope=50.0)
