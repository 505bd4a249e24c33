"""The chain's named figures: what they take, what they refuse, and the orders behind their gates."""

import numpy as np
import pytest
from chain_reference import elastica_tip, woinowsky_krieger

from verify.errors import InputError
from verify.quantities import arguments_of, evaluate, quantity
from verify.run import workbench_for
from verify.scene import load_scene

CHAIN = load_scene("chain")


def figure(name, scene=CHAIN, **arguments):
    found = quantity(f"chain.{name}")
    return evaluate(found, arguments_of(found, arguments), scene, workbench_for(scene))


ASKED = {
    "cantilever_tip": {"load": 1.7},
    "rollup_gap": {"wall": "gregory"},
    "hanging_frequency": {"mode": 2},
    "large_amplitude_frequency": {"amplitude": 1.3},
    "energy_drift": {"step": 2e-4},
    "transient_deflection": {"time": 2e-4, "x": 0.1, "force": 2.0},
}


@pytest.mark.parametrize("name", ASKED)
def test_segments_and_count_are_one_argument(name):
    assert figure(name, segments=9, **ASKED[name]) == figure(name, count=9, **ASKED[name])


@pytest.mark.parametrize("name", ASKED)
def test_a_chain_needs_its_number_of_links_once(name):
    with pytest.raises(InputError, match="segments is missing"):
        figure(name, **ASKED[name])
    with pytest.raises(InputError, match="count = 10 and segments = 9 mean the same"):
        figure(name, segments=9, count=10, **ASKED[name])


@pytest.mark.parametrize("component", ["deflection", "shortening"])
def test_the_cantilevers_tip_tends_to_the_elastica(component):
    exact = elastica_tip(2.5)[component == "shortening"]
    errors = [figure("cantilever_tip", load=2.5, segments=n, component=component) - exact for n in (30, 60)]
    assert abs(errors[1]) < 1e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.1)


def test_amplitudes_are_in_radii_of_gyration_of_the_scenes_beam():
    assert figure("large_amplitude_frequency", amplitude=1.5, segments=7) == pytest.approx(
        woinowsky_krieger(1.5), rel=1e-5
    )


def test_energy_drifts_with_order_four_in_the_step():
    drifts = [figure("energy_drift", segments=6, step=h, periods=0.5) for h in (2.4e-4, 1.2e-4)]
    assert np.log2(drifts[0] / drifts[1]) == pytest.approx(4.1, abs=0.3)


@pytest.mark.parametrize("more", [{"step": 1e-6}, {"method": "modal", "step": 5e-6}, {"method": "rk4", "step": 1e-6}])
def test_every_method_gives_the_same_transient(more):
    asked = {"time": 3e-4, "x": 0.06, "segments": 20, "force": 5.0}
    assert figure("transient_deflection", **asked, **more) == pytest.approx(
        figure("transient_deflection", **asked), rel=1e-5
    )


def test_the_linear_transient_is_in_proportion_to_the_force():
    asked = {"time": 8e-4, "x": 0.21, "segments": 20}
    big, small = (figure("transient_deflection", **asked, method="linear", force=force) for force in (30.0, 1.0))
    assert big == pytest.approx(30 * small, rel=5e-5)  # the links are read by their sines
    assert abs(figure("transient_deflection", **asked, force=30.0) / big - 1) > 1e-4


@pytest.mark.parametrize(
    ("name", "arguments", "message"),
    [
        ("transient_deflection", {"time": 1e-3, "x": 0.1, "segments": 49, "step": 3e-5}, "above the stability limit 2.898e-05 s of rk4"),
        ("transient_deflection", {"time": 1e-3, "x": 0.1, "segments": 9, "method": "modal"}, "step is missing"),
        ("transient_deflection", {"time": 1e-3, "x": 0.6, "segments": 9}, "lies off the chain"),
        ("transient_deflection", {"time": -1e-3, "x": 0.1, "segments": 9}, "time = -0.001"),
        ("hanging_frequency", {"mode": 5, "segments": 4}, "mode = 5"),
        ("large_amplitude_frequency", {"amplitude": 1e5, "segments": 9}, "up to L / 10"),
        ("cantilever_tip", {"load": 1.0, "segments": 9, "component": "slope"}, "component = 'slope' is not known"),
    ],
)  # fmt: skip
def test_bad_questions_are_refused(name, arguments, message):
    with pytest.raises(InputError, match=message):
        figure(name, **arguments)


def test_a_scene_without_forces_has_no_transient():
    with pytest.raises(InputError, match="has no drive by forces"):
        figure("transient_deflection", load_scene("steel-cantilever"), time=1e-3, x=0.1, segments=9)
