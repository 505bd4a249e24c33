"""The chain that engines get, and each engine where it is installed, against the linear chain."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import SegmentModel
from verify.chain.departure import linear_deflection
from verify.chain.motion import step_limit
from verify.chain.system import build_system
from verify.engines.base import ENGINES, chain_of, missing
from verify.errors import InputError
from verify.problem.beam import PointForce

FORCES = (
    PointForce(position=0.0731, amplitude=0.013, phase_deg=-37.0),
    PointForce(position=0.5219, amplitude=0.021, phase_deg=71.0),
    PointForce(position=0.0797, amplitude=0.005, phase_deg=160.0),
)
"""The first and the last on one link of 13, none on a joint."""
FREQUENCY, END = 1234.5, 2e-3
STEPS = {"Exudyn": 500, "MuJoCo": 50, "Pinocchio": 50}
ORDERS = {"Exudyn": (1.9, 2.1), "MuJoCo": (3.7, 5.2), "Pinocchio": (3.7, 5.2)}


@pytest.fixture
def chain(titanium_strip):
    return chain_of(titanium_strip, 13, FORCES, FREQUENCY)


@pytest.fixture
def system(titanium_strip):
    return build_system(titanium_strip, 13, list(FORCES), FREQUENCY)


@pytest.fixture(params=ENGINES.built_in)
def engine(request):
    if why := missing(ENGINES[request.param]):
        pytest.skip(why)
    return ENGINES[request.param]


def relative_rms(values, exact):
    return float(np.sqrt(np.mean((values - exact) ** 2) / np.mean(exact**2)))


def test_forces_are_on_their_links_with_their_phases(chain):
    beyond = 0.0731 * 13 / 0.73 - 1.0
    assert chain.shares[0, :4] == pytest.approx([0.0, 1.0 - beyond, beyond, 0.0], abs=1e-12)
    phases = 2 * np.pi * FREQUENCY * 1.3e-4 + np.radians([-37.0, 71.0, 160.0])
    assert chain.force_values(1.3e-4) == pytest.approx([0.013, 0.021, 0.005] * np.cos(phases), rel=1e-12)


@pytest.mark.parametrize(
    ("change", "count", "message"),
    [
        ({"supports": ("clamped", "pinned")}, 13, "beam.supports"),
        ({"tension": 3.0}, 13, "beam.tension"),
        ({"loss_factor": 0.01}, 13, "beam.loss_factor = 0.01"),
        ({"length": 0.5}, 13, r"force\[1\].position"),
        ({}, 1, "count = 1"),
    ],
)
def test_other_beams_are_rejected(titanium_strip, change, count, message):
    with pytest.raises(InputError, match=message):
        chain_of(replace(titanium_strip, **change), count, FORCES, FREQUENCY)


def test_missing_engine_is_named(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    for engine in ENGINES.values():
        with pytest.raises(InputError, match=f"{engine.name} is not installed: pip install {engine.package}"):
            engine.adapter()


def test_engine_frequencies_are_the_chains(engine, chain, titanium_strip):
    exact = SegmentModel(titanium_strip, 13).modes(12).frequencies_hz
    assert engine.adapter().frequencies(chain) == pytest.approx(exact, rel=1e-9)


def test_engine_converges_at_its_order(engine, chain, system):
    steps = STEPS[engine.name]
    runs = [engine.adapter().run(chain, n, END) for n in (steps, 2 * steps)]
    errors = [
        relative_rms(chain.deflection(run.angles, 0.365), linear_deflection(system, run.times, 0.365)) for run in runs
    ]
    low, high = ORDERS[engine.name]
    assert low < np.log2(errors[0] / errors[1]) < high
    assert errors[1] < 1e-3
    assert [run.failure for run in runs] == ["", ""]
    assert len(runs[1].times) == 2 * steps + 1


def test_rule_of_one_stage_has_order_two_from_a_soft_start(engine, titanium_strip):
    chain = chain_of(titanium_strip, 13, FORCES, FREQUENCY, load="reciprocal", soft_start_periods=1.7)
    fine = engine.adapter().run(chain, 3200, END)
    errors = []
    for part in (8, 4):
        run = engine.adapter().run(chain, 3200 // part, END, order=2)
        turns = [relative_rms(getattr(run, name)[:, 6], getattr(fine, name)[::part, 6]) for name in ("angles", "rates")]
        errors.append(max(turns))
    assert 1.9 < np.log2(errors[0] / errors[1]) < 2.2
    assert errors[1] < 1e-2


def test_unstable_step_is_reported(engine, chain, system, capfd):
    if engine.implicit:
        pytest.skip("it has no stability limit")
    run = engine.adapter().run(chain, round(2e-2 / (1.5 * step_limit(system))), 2e-2)
    assert "at t = 0.0" in run.failure
    assert run.times[-1] < 2e-2
    assert capfd.readouterr() == ("", "")
