"""A driven beam in time without a slider, against dense Hermite elements integrated by DOP853."""

import numpy as np
import pytest
from reference.slider import driven, hermite_modes, smooth

from verify import Excitation, Keep, free_vibration, simulate
from verify.dynamics.result import Motion
from verify.errors import InputError, ResonanceError
from verify.problem.beam import Beam, PointForce

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
HERTZ, DURATION, PARTS, PLACES = 1310.0, 3.3e-3, 5, (0.11, 0.297)
FORCES = (
    PointForce(position=0.037, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.402, amplitude=0.8, phase_deg=101.0),
)
MODES = hermite_modes(STRIP, PARTS)
FEM, DRIVE, KEEP = {"model": "fem", "count": PARTS}, Excitation(FORCES, HERTZ), Keep(at=PLACES, samples=12)


def run(excitation=DRIVE, duration=DURATION, **more) -> Motion:
    model = {} if "model" in more else FEM
    return simulate(STRIP, excitation, duration, **{"keep": KEEP, **model, **more})


def deflection(rows):
    shapes = np.stack([MODES.shape(x, 0) for x in PLACES], axis=1)
    return rows[:, : len(MODES.own)] @ shapes


STARTS = {
    "step load": ({}, lambda t: 1.0, ()),
    "soft start": ({"soft_start_periods": 1.7}, lambda t: smooth(t * HERTZ / 1.7), (1.7 / HERTZ,)),
    "envelope": (
        {"envelope": [(6e-4, [0.2, 0.5]), (9e-4, [0.7, 0.0, 0.3])]},
        lambda t: 0.2 + 0.5 * t / 6e-4 if t < 6e-4 else 0.7 + 0.3 * min((t - 6e-4) / 9e-4, 1.0) ** 2,
        (6e-4, 1.5e-3),
    ),
}


@pytest.mark.parametrize("damping", [0.0, 0.013, 0.6])
@pytest.mark.parametrize("start", STARTS)
def test_motion_from_rest_equals_dense_integration(start, damping):
    settings, growth, breaks = STARTS[start]
    motion = run(Excitation(FORCES, HERTZ, **settings), modal_damping=damping)
    times = motion.times[1:].tolist()
    expected = deflection(driven(MODES, FORCES, HERTZ, times, damping=damping, growth=growth, breaks=breaks))
    assert motion.deflection[0] == pytest.approx(0.0, abs=1e-15)
    assert motion.deflection[1:] == pytest.approx(expected, abs=1e-10 * abs(expected).max())


def test_damped_motion_tends_to_the_steady_field():
    late = run(duration=12.0, modal_damping=0.03, keep=Keep(samples=2))
    steady, again = (run(start=start, modal_damping=0.03) for start in ("steady", late))
    phase = np.exp(2j * np.pi * HERTZ * again.times)
    amplitude = np.linalg.lstsq(np.stack([phase.real, -phase.imag], axis=1), again.deflection, rcond=None)[0]
    phase = np.exp(2j * np.pi * HERTZ * steady.times)
    found = phase.real[:, None] * amplitude[0] - phase.imag[:, None] * amplitude[1]
    assert found == pytest.approx(steady.deflection, abs=1e-9 * abs(steady.deflection).max())


@pytest.mark.parametrize("model", [{"model": "segment", "count": 9}, FEM, {"model": "analytic", "modes": 12}])
def test_a_continued_run_equals_one_run(model):
    whole = run(**model, modal_damping=0.01, keep=Keep(at=PLACES, samples=11))
    part = {"duration": 0.5 * DURATION, "modal_damping": 0.01, "keep": Keep(at=PLACES, samples=6), **model}
    rest = run(start=run(**part), **part)
    assert rest.times == pytest.approx(whole.times[5:], rel=1e-12)
    assert rest.deflection == pytest.approx(whole.deflection[5:], abs=1e-11 * abs(whole.deflection).max())


def test_segments_elements_and_exact_beam_converge_to_one_motion():
    motions = {
        name: run(Excitation(FORCES, HERTZ, soft_start_periods=2.0), **model).deflection
        for name, model in {
            "segment": {"model": "segment", "count": 120},
            "fem": {"model": "fem", "count": 60},
            "analytic": {"model": "analytic", "modes": 60},
        }.items()
    }
    scale = abs(motions["analytic"]).max()
    assert motions["fem"] == pytest.approx(motions["analytic"], abs=1e-3 * scale)
    assert motions["segment"] == pytest.approx(motions["analytic"], abs=5e-3 * scale)


@pytest.mark.parametrize("off", [1e-5, -3e-7])
def test_a_soft_start_keeps_its_digits_beside_a_resonance(off):
    """Powers of the growth alone would cancel like (1/(T |omega_n - omega|))^4."""
    hertz = MODES.own[2] / (2 * np.pi) * (1 + off)
    force = [PointForce(position=0.037, amplitude=1.3, phase_deg=17.0)]
    excitation = Excitation(force, hertz, soft_start_periods=2.3)
    motion = run(excitation, 0.03, keep=Keep(at=PLACES, samples=4))
    grown = 2.3 / hertz
    rows = driven(MODES, force, hertz, motion.times[1:].tolist(), growth=lambda t: smooth(t / grown), breaks=(grown,))
    assert motion.deflection[1:] == pytest.approx(deflection(rows), rel=1e-8)


def test_an_undamped_beam_at_its_own_frequency_is_refused():
    hertz = MODES.own[1] / (2 * np.pi)
    with pytest.raises(ResonanceError):
        run(Excitation(FORCES, hertz))


@pytest.mark.parametrize(
    ("settings", "field"),
    [
        ({"start": "moving"}, "start"),
        ({"excitation": Excitation(FORCES, HERTZ, 50.0)}, "soft_start_periods"),
        ({"excitation": Excitation(FORCES, HERTZ, 1.0), "start": "steady"}, "soft_start_periods"),
        ({"modal_damping": 1.0}, "modal_damping"),
        ({"keep": Keep(at=[0.1, 0.44])}, "keep.at"),
        ({"keep": 5}, "keep"),
        ({"step": 1e-6}, "step"),
        ({"model": "mesh"}, "model"),
        ({"count": None}, "count"),
        ({"modes": 4}, "modes"),
    ],
)
def test_bad_arguments_are_refused_by_name(settings, field):
    with pytest.raises(InputError, match=field):
        run(**settings)


@pytest.mark.parametrize("envelope", [[(1e-3, [])], [(0.0, [1.0])], "slow"])
def test_a_growth_that_is_not_a_row_of_polynomials_is_refused(envelope):
    with pytest.raises(InputError, match="envelope"):
        Excitation(FORCES, HERTZ, envelope=envelope)


def test_a_continuation_on_another_beam_or_model_or_with_growth_is_refused():
    before = run()
    with pytest.raises(InputError, match="count"):
        run(count=6, start=before)
    with pytest.raises(InputError, match="soft_start_periods"):
        run(Excitation(FORCES, HERTZ, 1.0), start=before)
    other = free_vibration(Beam(length=0.43, width=0.02, thickness=0.0013, youngs_modulus=113e9, density=4470.0), 1,
                           1e-3, amplitude=1e-5, model="fem", count=PARTS)  # fmt: skip
    with pytest.raises(InputError, match="beam"):
        run(start=other)
