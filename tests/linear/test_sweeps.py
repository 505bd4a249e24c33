"""Sweeps are loops over the single verbs, to rounding, with the same refusals and in a fraction of the time."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify import (
    Beam,
    InputError,
    PointForce,
    analytic_modes,
    fem_beam,
    segment_model,
)
from verify.errors import ResonanceError

BEAM = Beam(length=0.47, width=0.017, thickness=0.0012, youngs_modulus=71e9, density=2710.0)
FORCES = (
    PointForce(position=0.0613, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.4019, amplitude=0.4, phase_deg=-71.0),
)
X = np.array([[0.0, 0.013, 0.17], [0.2611, 0.401, 0.47]])
WIDE = np.geomspace(3.0, 5200.0, 23)
SIZED = {"segment": (segment_model, (41,)), "fem": (fem_beam, (41,)), "analytic": (analytic_modes, ())}


def compared(model, beam, frequencies, **settings):
    """(read from a sweep, read from single fields) of deflection, slope and curvature, each (n, ...)."""
    module, size = SIZED[model]
    sweep = module.sweep_harmonic(beam, FORCES, frequencies, *size, **settings)
    singles = [module.solve_harmonic(beam, FORCES, float(f), *size, **settings) for f in frequencies]
    yield sweep.deflection(X), np.array([one.deflection(X) for one in singles])
    yield sweep.slope(X), np.array([one.slope(X) for one in singles])
    yield sweep.shapes(X.ravel(), 2), np.array([one.shapes(X.ravel(), 2) for one in singles])
    yield sweep.field(-1).deflection(X)[None], singles[-1].deflection(X)[None]


@pytest.mark.parametrize(
    ("model", "settings"),
    [
        ("segment", {"joint_dashpot": 2e-4}),
        ("segment", {"modal_damping": 0.013}),
        ("segment", {"reading": "links"}),
        ("segment", {"reading": "raw", "load": "lever", "wall": "half", "grading": 1.7}),
        ("segment", {"theory": "timoshenko"}),
        ("fem", {"modal_damping": 0.013, "grading": 1.7}),
        ("fem", {"theory": "timoshenko"}),
        ("analytic", {"theory": "timoshenko"}),
    ],
)
def test_a_sweep_takes_the_settings_of_a_single_field(model, settings):
    beam = replace(BEAM, supports=("clamped", "pinned"), poissons_ratio=0.3)
    beam = beam if "modal_damping" in settings else replace(beam, loss_factor=0.004)
    for swept, single in compared(model, beam, WIDE[::3], **settings):
        assert swept == pytest.approx(single, rel=0.0, abs=1e-12 * abs(single).max())


@pytest.mark.parametrize("model", SIZED)
@pytest.mark.parametrize("n_frequencies", [3, 30])
def test_a_resonance_in_a_sweep_is_refused_by_its_index(model, n_frequencies):
    module, size = SIZED[model]
    resonance = float(module.solve_modes(BEAM, 5, *size).frequencies_hz[4])
    frequencies = np.linspace(71.0, 93.0, n_frequencies)
    frequencies[2] = resonance * (1.0 + 3e-10)
    with pytest.raises(ResonanceError, match=rf"frequencies_hz\[2\] = .*mode 5 of the {model} model"):
        module.sweep_harmonic(BEAM, FORCES, frequencies, *size)
    frequencies[2] = resonance * (1.0 + 3e-8)
    assert np.isfinite(module.sweep_harmonic(BEAM, FORCES, frequencies, *size).deflection(0.1)).all()
    assert len(module.sweep_harmonic(replace(BEAM, loss_factor=1e-3), FORCES, [resonance], *size)) == 1


@pytest.mark.parametrize("model", SIZED)
@pytest.mark.parametrize(
    ("frequencies", "said"),
    [
        ([50.0, 60.0, float("nan")], r"frequencies_hz\[2\] = nan"),
        ([50.0, -60.0, 70.0], r"frequencies_hz\[1\] = -60.0"),
        ([50.0, 60.0, 0.0, 80.0], r"frequencies_hz\[2\] = 0.0"),
        ([float("inf"), 60.0], r"frequencies_hz\[0\] = inf"),
        ([], "frequencies_hz is empty"),
        (["fifty"], "frequencies_hz = "),
        (np.full(10_000_000, 50.0), "more than 5e\\+07: give fewer"),
    ],
)
def test_a_sweep_refuses_what_a_field_refuses_and_says_where(model, frequencies, said):
    module, size = SIZED[model]
    with pytest.raises(InputError, match=said):
        module.sweep_harmonic(BEAM, FORCES, frequencies, *size)


def test_a_beam_that_is_refused_is_named_by_its_index():
    crushed = replace(BEAM, tension=-1e4)
    for model, (module, size) in SIZED.items():
        with pytest.raises(InputError, match=r"^beams\[1\]: .*tension"):
            module.sweep_modes([BEAM, crushed], 3, *size)
        with pytest.raises(InputError, match="beams is empty"):
            module.sweep_modes([], 3, *size)
        with pytest.raises(
            InputError, match=r"^beams: 3 beams of 20000000 numbers each are more than 5e\+07: give fewer"
        ):
            module.sweep_modes([BEAM] * 3, 20_000_000, *size)
        if model != "analytic":
            with pytest.raises(InputError, match=r"beams\[0\]: n_modes = 300"):
                module.sweep_modes([BEAM], 300, *size)


@pytest.mark.parametrize("name", SIZED)
def test_beams_may_be_any_that_can_be_gone_through_a_generator_too(name):
    module, size = SIZED[name]
    beams = [replace(BEAM, length=0.3 + 0.1 * i) for i in range(3)]
    assert np.array_equal(module.sweep_modes(iter(beams), 4, *size), module.sweep_modes(beams, 4, *size))
    with pytest.raises(InputError, match="beams has 3: give a Beam"):
        module.sweep_modes((one for one in (BEAM, 3)), 4, *size)
