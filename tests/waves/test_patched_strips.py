"""Waves on a strip with patches under its actuators: measured where the strip is itself, refused where it is not."""

import pytest

from verify.errors import WindowError
from verify.judge.cache import SolutionCache
from verify.quantities.base import evaluate
from verify.scene.load import scene_from

PATCH = {"bending_stiffness": 0.35, "mass_per_length": 0.11}
SECTIONS = [{"length": 0.03}, {"length": 0.03, **PATCH}, {"length": 0.3}, {"length": 0.03, **PATCH}, {"length": 0.03}]
SCENE = {
    "name": "patches",
    "beam": {
        "length": 0.42,
        "width": 0.018,
        "thickness": 0.0012,
        "youngs_modulus": 70e9,
        "density": 2700.0,
        "supports": ["free", "free"],
        "loss_factor": 1e-3,
        "section": SECTIONS,
        "spring": [{"position": 0.0, "stiffness": 3e5}, {"position": 0.42, "stiffness": 2e5}],
    },
    "drive": {"frequency_hz": 1700.0, "force": [{"position": 0.045}, {"position": 0.372, "phase_deg": 90.0}]},
}


def scene(**tables):
    return scene_from(SCENE | tables)


def figure(name, whole=None, **asked):
    loaded = whole or scene()
    return evaluate(name, asked, loaded, SolutionCache(loaded.beam))


def test_both_models_come_to_the_exact_standing_wave_ratio_of_a_patched_strip():
    exact = figure("wave.standing_wave_ratio", model="analytic")
    for model in ("segment", "fem"):
        coarse, fine = (abs(figure("wave.standing_wave_ratio", model=model, count=n) / exact - 1) for n in (140, 280))
        assert coarse < 2e-3, model
        assert 3.0 < coarse / fine < 20.0, model


def test_the_flux_through_the_strip_is_the_same_all_along_it_but_for_losses():
    lossless = scene(beam=SCENE["beam"] | {"loss_factor": 0.0})
    left, right = (
        figure("wave.energy_flux", lossless, model="analytic", window=w) for w in ([0.16, 0.21], [0.21, 0.26])
    )
    assert left == pytest.approx(right, rel=2e-4)


def test_a_window_over_a_patch_is_refused_and_one_beside_it_is_not():
    with pytest.raises(WindowError, match=r"holds a beam\.section other than the beam's own"):
        figure("wave.standing_wave_ratio", model="analytic", window=[0.05, 0.25])
    assert figure("wave.standing_wave_ratio", model="analytic", window=[0.06, 0.25]) > 1.0
