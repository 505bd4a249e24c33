"""The engines themselves, where they are installed: modes, motions, a slider, and what they do when they break."""

import importlib

import msgspec
import numpy as np
import pytest
from peer_cases import FORCES, FREQUENCY, deflection_error, ride_error

from verify.beam import PointForce
from verify.errors import InputError
from verify.peers import references
from verify.peers.breaking import pushed
from verify.peers.case import case_of, sled_of, surface_speed
from verify.peers.catalogue import PEERS, adapter, installed
from verify.slider import Slider

MODULES = {"Exudyn": "exudyn", "MuJoCo": "mujoco", "Pinocchio": "pinocchio"}
STEPS = {"Exudyn": 4e-6, "MuJoCo": 4e-5, "Pinocchio": 4e-5}
ORDERS = {"Exudyn": (1.9, 2.1), "MuJoCo": (3.7, 5.2), "Pinocchio": (3.7, 5.2)}
END = 2e-3


@pytest.fixture(params=MODULES)
def name(request):
    pytest.importorskip(MODULES[request.param], reason="the peers extra is not installed")
    return request.param


@pytest.fixture
def engine(name):
    return adapter(PEERS[name])


def test_the_version_told_is_the_one_imported(name):
    module = importlib.import_module(MODULES[name])
    assert installed(PEERS[name]) == module.__version__


def test_natural_frequencies_are_the_rigid_chains(engine, asymmetric_case):
    found = engine.frequencies(asymmetric_case)
    assert found.shape == (12,)
    assert found == pytest.approx(references.frequencies(asymmetric_case), rel=1e-9)


def test_the_motion_converges_to_the_exact_linear_chain_at_the_engines_order(name, engine, asymmetric_case):
    run = engine.prepare(asymmetric_case)
    coarse, fine = (run(step, END) for step in (STEPS[name], 0.5 * STEPS[name]))
    errors = [deflection_error(one, lambda t: references.deflection(asymmetric_case, t)) for one in (coarse, fine)]
    assert errors[1] < 1e-3
    low, high = ORDERS[name]
    assert low < np.log2(errors[0] / errors[1]) < high
    assert (coarse.broke, fine.broke) == ("", "")
    assert fine.steps == pytest.approx(2 * coarse.steps, abs=1)
    assert len(fine.times) >= 100
    assert fine.times[-1] == pytest.approx(END, rel=0.03)


def test_a_slider_rides_as_on_the_exact_linear_chain(name, engine, asymmetric_case, sled):
    ride = references.ride(asymmetric_case, sled, END, 8000)
    run = engine.prepare(asymmetric_case, sled)(0.5 * STEPS[name], END)
    assert 1e-9 < ride_error(run, ride.at) < 1e-3
    assert len(run.distance) == len(run.speed) == len(run.times)
    assert deflection_error(run, lambda t: references.deflection(asymmetric_case, t)) < 1e-3


def test_a_slider_on_a_still_chain_slows_down_by_the_exact_law(name, engine, titanium_strip, sled):
    still = case_of(titanium_strip, 13, [PointForce(position=0.2, amplitude=0.0)], FREQUENCY)
    run = engine.prepare(still, sled)(2e-6, 3e-4)
    rate = sled.friction * sled.slope / sled.mass
    exact = np.arcsinh(np.sinh(sled.slope * sled.speed) * np.exp(-rate * run.times)) / sled.slope
    assert run.speed == pytest.approx(exact, rel=1e-3)


def test_the_same_is_given_twice(engine, name, asymmetric_case, sled):
    run = engine.prepare(asymmetric_case, sled)
    first, other, again = run(1e-5, 4e-4), run(2e-5, 4e-4), run(1e-5, 4e-4)
    assert np.array_equal(first.deflection, again.deflection)
    assert np.array_equal(first.speed, again.speed)
    assert not np.array_equal(first.speed[-1], other.speed[-1])


SAYS = {
    "Exudyn": ("raised 'SolveDynamic terminated'", "iteration stalled", "cut its step"),
    "MuJoCo": ("put itself back to its start", "without an exception", "1 warning", "unstable"),
    "Pinocchio": ("a joint has turned by", "nothing was raised"),
}


def test_an_engine_that_breaks_says_when_and_how_and_nothing_else_anywhere(
    name, asymmetric_case, tmp_path, monkeypatch, capfd
):
    monkeypatch.chdir(tmp_path)
    case = msgspec.structs.replace(
        asymmetric_case, forces=tuple(msgspec.structs.replace(f, amplitude=1e3) for f in asymmetric_case.forces)
    )
    row = pushed(name, case, 2e-2)
    assert all(words in row.did for words in SAYS[name])
    time = float(row.did.partition("at t = ")[2].partition(" s ")[0])
    assert row.until <= time < row.asked
    assert row.steps > 0 or time == 0.0
    assert list(tmp_path.iterdir()) == []
    assert capfd.readouterr() == ("", "")


def test_an_engine_that_broke_goes_on_with_the_next_run_as_if_it_had_not(name, engine, asymmetric_case):
    step = 1.2 * references.explicit_limit(asymmetric_case) if name != "Exudyn" else 4e-6
    run = engine.prepare(asymmetric_case)
    before = run(1e-5, 4e-4).deflection
    assert bool(run(step, 2e-2 if name != "Exudyn" else 4e-5).broke) == (name != "Exudyn")
    assert np.array_equal(run(1e-5, 4e-4).deflection, before)


def test_a_slider_on_a_chain_that_breaks_is_told_too(name, engine, asymmetric_case, sled):
    if name == "Exudyn":
        pytest.skip("it has no limit of the step")
    run = engine.prepare(asymmetric_case, sled)(1.5 * references.explicit_limit(asymmetric_case), 2e-2)
    assert run.broke.startswith("at t = 0.00")
    assert len(run.speed) == len(run.times) == run.steps


def test_a_model_that_mujoco_does_not_take_is_told_as_broken_before_its_first_step(titanium_strip):
    pytest.importorskip("mujoco", reason="the peers extra is not installed")
    speck = msgspec.structs.replace(titanium_strip, length=1e-5, width=1e-6, thickness=1e-7)
    run = adapter(PEERS["MuJoCo"]).prepare(case_of(speck, 13, [PointForce(position=2e-6)], FREQUENCY))(1e-9, 1e-8)
    assert "at t = 0 s, before its first step, it refused the model" in run.broke
    assert "\n" not in run.broke
    assert len(run.times) == len(run.deflection) == run.steps == 0


def test_mujoco_is_left_as_it_was_found():
    mujoco = pytest.importorskip("mujoco", reason="the peers extra is not installed")
    assert mujoco.get_mjcb_control() is None
    assert mujoco.get_mju_user_warning() is None


def test_mujocos_callback_in_machine_code_pushes_as_the_case_and_its_slider_have_it(asymmetric_case, sled):
    """Two forces lie on one link; the slider is on the beam, and beyond either end of it."""
    mujoco = pytest.importorskip("mujoco", reason="the peers extra is not installed")
    from verify.peers.mujoco import _called_back, _pushing, model_text

    case = msgspec.structs.replace(
        asymmetric_case, forces=(*asymmetric_case.forces, PointForce(position=0.52, amplitude=0.3, phase_deg=12.0))
    )
    model = mujoco.MjModel.from_xml_string(model_text(case, 1e-6, sled))
    for moved in (0.0113, -0.31, 0.9):
        data = mujoco.MjData(model)
        data.time, data.qpos[-1], data.qvel[:] = 3.7e-4, moved, np.random.default_rng(5).normal(size=14)
        with _called_back(_pushing(case, sled, data)):
            mujoco.mj_forward(model, data)
        due = np.zeros((15, 6))
        for force, now in zip(case.forces, case.now(3.7e-4), strict=True):
            link, at = case.place(force.position)
            due[link + 1, 2] += now
            due[link + 1, 4] -= now * (at - case.link / 2)
        assert data.xfrc_applied == pytest.approx(due, rel=1e-13, abs=1e-16)
        surface = surface_speed(case, sled, np.cumsum(data.qvel[:13]), sled.start + moved)
        assert data.qfrc_applied[-1] == pytest.approx(sled.force(data.qvel[-1] - surface), rel=1e-11)
        assert not data.qfrc_applied[:-1].any()


def test_an_acceleration_of_pinocchios_chain_takes_time_by_its_links_and_not_by_their_cube(titanium_strip):
    pytest.importorskip("pinocchio", reason="the peers extra is not installed")
    sizes, steps = (50, 250), 4
    cases = [case_of(titanium_strip, n, FORCES, FREQUENCY) for n in sizes]
    runs = [adapter(PEERS["Pinocchio"]).prepare(case) for case in cases]
    each = [0.5 * references.explicit_limit(case) for case in cases]
    rounds = [[run(h, steps * h).cpu_s for run, h in zip(runs, each, strict=True)] for _ in range(5)]
    assert np.median([large / small for small, large in rounds]) < 8.0


def test_exudyns_error_still_falls_at_order_2_in_short_steps_of_short_links(titanium_strip):
    """Joints held by their places, index 3, stall Newton's iteration there: it cannot tell its residual from rounding."""
    pytest.importorskip("exudyn", reason="the peers extra is not installed")
    case = case_of(titanium_strip, 60, FORCES, FREQUENCY)
    run = adapter(PEERS["Exudyn"]).prepare(case)
    errors = [deflection_error(run(step, 6e-5), lambda t: references.deflection(case, t)) for step in (4e-8, 2e-8)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.02)


def test_exudyns_slider_does_not_depend_on_when_newtons_iteration_stops(titanium_strip, monkeypatch):
    """Friction is a small part of the residual: where the chain's tolerance is met, the slider's way is 3e-5 off."""
    pytest.importorskip("exudyn", reason="the peers extra is not installed")
    case = case_of(titanium_strip, 99, FORCES, FREQUENCY)
    near = Slider(mass=2.3e-3, mu=0.31, slope=3e3, position=0.12, coupling="one-way")
    run = adapter(PEERS["Exudyn"]).prepare(case, sled_of(titanium_strip, near))
    taken = run(3e-8, 6e-5).distance
    monkeypatch.setattr("verify.peers.exudyn.WITH_SLIDER", 1e-11)
    strict = run(3e-8, 6e-5).distance
    assert np.linalg.norm(taken - strict) < 3e-6 * np.linalg.norm(strict)


def test_how_an_engine_from_outside_breaks_is_not_known(asymmetric_case):
    with PEERS.registered(msgspec.structs.replace(PEERS["MuJoCo"], name="Another")), pytest.raises(InputError):
        pushed("Another", asymmetric_case, 1e-3)
