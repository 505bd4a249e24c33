"""The step of a slider that the beam feels is halved until its way stands, and what does not stand is said."""

import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.errors import InputError
from verify.judge.workbench import Workbench
from verify.motion import judged_step, stepping
from verify.motion.judged_step import KNOWN, moved
from verify.motion.simulate import simulate
from verify.quantities.simulated import SliderInTime, with_slider
from verify.scenes.scene import load_scene
from verify.slider import Slider

STEEL = Beam(
    length=0.1, width=0.008, thickness=0.002, youngs_modulus=205e9, density=7850.0, supports=("clamped", "free")
)
SHAKEN = (PointForce(position=0.0958, amplitude=60.0), PointForce(position=0.03, amplitude=50.0, phase_deg=75.0))
HERTZ = 33066.0
PRESSED = Slider(mass=0.010, mu=0.23, preload=2.0, position=0.047, coupling="two-way")


def ridden(samples=2, count=24, turns=10.0, model="fem", progress=lambda part: None, step=None, **given):
    """On a short beam, driven fast, that feels what rubs on it."""
    rider = replace(PRESSED, **given)
    settings = {"model": model, "count": count, "samples": samples, "step": step, "progress": progress}
    return simulate(STEEL, SHAKEN, HERTZ, turns / HERTZ, slider=rider, **settings)


@pytest.mark.parametrize(
    ("chosen", "given"),
    [
        (1.19e-7, {"count": 37, "normal": "massless"}),
        (1.19e-7, {"count": 37, "law": "coulomb", "normal": "massless"}),
        (2.37e-7, {"model": "segment", "count": 49}),
    ],
)
def test_the_way_stands_where_a_step_by_the_start_alone_is_off(chosen, given):
    """`chosen` is what the start alone asks for: several per cent off, in tens of nanometres."""
    found, exact = ridden(**given), ridden(step=4e-9, **given).displacement
    assert found.displacement == pytest.approx(exact, rel=KNOWN)
    assert 0.0 < found.statistics.moved <= KNOWN
    assert found.statistics.step_s < 0.3 * chosen
    assert abs(ridden(step=chosen, **given).displacement / exact - 1.0) > 1.5 * KNOWN


def test_samples_are_those_asked_for_however_the_step_is_judged():
    few, many = ridden(samples=2), ridden(samples=41)
    assert len(few.times) == len(few.travelled) == len(few.deflection) == 2
    assert len(many.times) == len(many.speed) == len(many.normal_force) == 41
    assert few.times == pytest.approx(many.times[[0, -1]], rel=1e-14)
    assert few.displacement == pytest.approx(many.displacement, rel=KNOWN)


def test_samples_at_every_step_leave_a_shorter_one_to_compare_with():
    dense = ridden(samples=5001, turns=3.0)
    assert dense.statistics.steps >= 2 * 5000
    assert 0.0 < dense.statistics.moved <= KNOWN
    assert len(dense.times) == 5001


def test_a_step_that_is_given_or_that_no_beam_feels_is_taken_as_it_is():
    assert ridden(step=1e-7).statistics.moved is None
    assert ridden(coupling="one-way").statistics.moved is None


def test_what_all_runs_took_is_told_of_the_last():
    parts = []
    found = ridden(progress=parts.append)
    assert parts == sorted(parts)
    assert parts[-1] == 1.0
    alone = ridden(step=found.statistics.step_s)
    assert found.statistics.loop_s > 1.3 * alone.statistics.loop_s


def test_what_is_waited_for_is_all_of_them(monkeypatch):
    """Of runs in 1, 2, 4 and 8 steps the last two are begun for 7 and 15: each by itself was thought to be short."""
    asked = []
    monkeypatch.setattr(judged_step, "waited_for", lambda seconds: asked.append(seconds) or True)
    monkeypatch.setattr(stepping, "table_seconds", lambda table: 0.0)  # what they read of the beam on the way
    ridden(count=37, normal="massless")
    assert len(asked) >= 2
    assert asked[1] / asked[0] == pytest.approx(15.0 / 7.0, rel=0.02)


def test_an_interrupt_ends_all_of_it():
    def stop(part):
        raise KeyboardInterrupt

    found = ridden(progress=stop)
    assert found.statistics.interrupted
    assert found.statistics.moved is None


def test_a_way_that_does_not_stand_is_said_and_refused_as_a_figure(monkeypatch, tmp_path):
    monkeypatch.setattr(judged_step, "HALVINGS", 0)
    found = ridden(normal="massless", count=37)
    assert found.statistics.moved > KNOWN
    assert "give a shorter step" in found.notes[-1]
    assert f"{100.0 * found.statistics.moved:.2g} %" in found.notes[-1]
    (tmp_path / "steel.toml").write_text(SCENE)
    asked = {"model": "fem", "count": 37, "time": 10.0 / HERTZ}
    scene = load_scene(tmp_path / "steel.toml")
    with pytest.raises(InputError, match=r"^step, which is not given: in steps of .* is not known to 1 %"):
        with_slider(SliderInTime(**asked), scene, Workbench(scene.beam))
    assert with_slider(SliderInTime(**asked, step=1e-7), scene, Workbench(scene.beam)).displacement != 0.0


def test_a_slider_that_leaves_at_another_time_has_not_been_confirmed():
    one, other = (ridden(step=1e-7, turns=turns) for turns in (4.0, 4.1))
    assert moved(one, other) == float("inf")
    assert moved(one, one) == 0.0


SCENE = """
name = "steel"
beam = { length = 0.1, width = 0.008, thickness = 0.002, youngs_modulus = 205e9, density = 7850.0, \
supports = ["clamped", "free"] }
drive = { frequency_hz = 33066.0, force = [{ position = 0.0958, amplitude = 60.0 }, \
{ position = 0.03, amplitude = 50.0, phase_deg = 75.0 }] }
slider = { mass = 0.010, mu = 0.23, preload = 2.0, position = 0.047, coupling = "two-way", normal = "massless" }
motion = { duration = 3e-4, soft_start_periods = 0.0, steps_per_period = 64 }
"""
