"""The driven beam: exact field, both discrete models, damping, resonance, imposed displacements."""

from itertools import product

import numpy as np
import pytest
from msgspec.structs import replace

from tests.reference import transfer
from verify.analytic_modes import ExactModel
from verify.errors import InputError, ResonanceError
from verify.exact import closed_forms
from verify.fem_beam import HermiteModel
from verify.options import SUPPORTS
from verify.problem.beam import PointForce
from verify.problem.device import Device
from verify.segment_model import SegmentModel

FORCES = (PointForce(position=0.083, amplitude=0.7), PointForce(position=0.611, amplitude=1.3, phase_deg=63.0))
X = np.array([0.0, 0.021, 0.083, 0.3333, 0.52, 0.7, 0.73])
DISCRETE = {"segment": SegmentModel, "fem": HermiteModel}
MODELS = ["analytic", *DISCRETE]


def built(model, beam, count=41):
    return ExactModel(beam) if model == "analytic" else DISCRETE[model](beam, count)


def close(found, exact, bound):
    assert abs(found - exact).max() < bound * abs(exact).max()


def error(found, exact):
    return np.linalg.norm(found.deflection(X) - exact.deflection(X)) / np.linalg.norm(exact.deflection(X))


@pytest.mark.parametrize("frequency", [1e-12, 1e-6, 1e-4])
def test_a_slow_force_bends_a_held_beam_as_a_dead_load_does(titanium_strip, frequency):
    """Textbook deflections; the inertia left out is (f / f_1)^2, below 1e-8 here."""
    ei, force = titanium_strip.bending_stiffness, PointForce(position=0.311, amplitude=1.7)
    x = np.array([0.05, 0.29, 0.6])
    a, b = np.minimum(x, 0.311), 0.73 - np.maximum(x, 0.311)
    pinned = 1.7 * a * b * (0.73**2 - a**2 - b**2) / (6 * 0.73 * ei)
    close(ExactModel(titanium_strip).harmonic(force, frequency).deflection(x), pinned, 1e-8)
    cantilever = replace(titanium_strip, supports=("clamped", "free"))
    tip = 1.7 * a**2 * (3 * np.maximum(x, 0.311) - a) / (6 * ei)
    close(ExactModel(cantilever).harmonic(force, frequency).deflection(x), tip, 1e-8)


@pytest.mark.parametrize("supports", list(product(SUPPORTS, SUPPORTS)), ids="-".join)
def test_the_exact_field_obeys_the_beam_equation_its_ends_and_its_forces(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports, loss_factor=0.05)
    field = ExactModel(beam).harmonic(FORCES, 777.0)
    conditions = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
    k = abs(field.wavenumber)
    size = abs(field.deflection(np.linspace(0, 0.73, 200))).max()
    for end, support in zip((0.0, 0.73), supports, strict=True):
        for derivative in conditions[support]:
            assert abs(field.shapes(np.array([end]), derivative)[0]) < 1e-11 * size * k**derivative
    step = np.array([0.611 - 1e-9, 0.611 + 1e-9])
    jump = np.diff(field.shapes(step, 3))[0] * beam.bending_stiffness * (1 + 0.05j)
    assert jump == pytest.approx(1.3 * np.exp(1j * np.deg2rad(63.0)), rel=1e-5)
    # w'''' = k^4 w by an integral over a stretch without a force, not by differences
    points, weights = np.polynomial.legendre.leggauss(12)
    x, w = 0.31 + (points + 1) / 2 * 0.01, weights / 2 * 0.01
    rise = np.diff(field.shapes(np.array([0.31, 0.32]), 3))[0]
    assert rise == pytest.approx(field.wavenumber**4 * (w @ field.deflection(x)), rel=1e-9)


@pytest.mark.parametrize(
    "supports", [("pinned", "pinned"), ("clamped", "free"), ("free", "free"), ("guided", "clamped")], ids="-".join
)
@pytest.mark.parametrize("model", DISCRETE)
def test_both_discrete_models_converge_with_order_four(titanium_strip, supports, model):
    """Forces on joints or nodes at every size, d = L/8 and 5L/6; damping keeps a resonance from shifting the error."""
    beam = replace(titanium_strip, supports=supports, loss_factor=0.05)
    forces = (PointForce(position=0.73 / 8, amplitude=0.7), PointForce(position=0.73 * 5 / 6, phase_deg=63.0))
    exact = ExactModel(beam).harmonic(forces, 233.0)
    errors = [error(built(model, beam, n).harmonic(forces, 233.0), exact) for n in (120, 240)]
    order = np.log2(errors[0] / errors[1])
    if model == "segment" and "clamped" in supports:  # Gregory's walls: the error changes its sign on the way
        assert order > 3.0
        assert errors[1] < 1e-4
    else:
        assert order == pytest.approx(4.0, abs=0.25)


@pytest.mark.parametrize("model", DISCRETE)
def test_a_loss_factor_and_a_modal_ratio_damp_a_resonance_alike(titanium_strip, model):
    hertz = float(built(model, titanium_strip, 60).modes(3).frequencies_hz[2])
    force, eta = PointForce(position=0.111), 0.004
    by_loss = built(model, replace(titanium_strip, loss_factor=eta), 60).harmonic(force, hertz).deflection(X)
    close(built(model, titanium_strip, 60).harmonic(force, hertz, modal_damping=eta / 2).deflection(X), by_loss, 0.002)
    if model == "segment":
        dashpot = eta * titanium_strip.bending_stiffness / (0.73 / 60) / (2 * np.pi * hertz)
        by_dashpot = SegmentModel(titanium_strip, 60, joint_dashpot=dashpot).harmonic(force, hertz).deflection(X)
        close(by_dashpot, by_loss, 1e-10)


@pytest.mark.parametrize("model", MODELS)
def test_an_undamped_resonance_is_refused(titanium_strip, model):
    one = built(model, titanium_strip, 33)
    exact = closed_forms.frequency_hz(titanium_strip, 7)
    frequency = exact if model == "analytic" else float(one.modes(7).frequencies_hz[6])
    for off in (0.0, 3e-10):
        with pytest.raises(ResonanceError, match=rf"resonance.* of the {model} model"):
            one.harmonic(PointForce(position=0.1), frequency * (1 + off))
    assert np.isfinite(one.harmonic(PointForce(position=0.1), frequency * (1 + 1e-7)).deflection(X)).all()
    damped = built(model, replace(titanium_strip, loss_factor=1e-4), 33)
    assert np.isfinite(damped.harmonic(PointForce(position=0.1), frequency).deflection(X)).all()


@pytest.mark.parametrize("model", MODELS)
def test_reciprocity_of_force_and_deflection(titanium_strip, model):
    one = built(model, replace(titanium_strip, supports=("clamped", "guided"), loss_factor=0.01))
    a, b = 0.73 * 7 / 41, 0.73 * 30 / 41  # joints and nodes of 41 parts
    ahead, back = (one.harmonic(PointForce(position=p), 412.0).deflection(q)[0] for p, q in ((a, b), (b, a)))
    assert ahead == pytest.approx(back, rel=1e-11)


@pytest.mark.parametrize("model", MODELS)
def test_fields_at_many_frequencies_and_receptances_superposed_are_the_field_of_each(titanium_strip, model):
    one = built(model, replace(titanium_strip, loss_factor=0.01, supports=("pinned", "free")), 37)
    frequencies = np.array([37.0, 211.0, 512.0])
    units = one.receptance([f.position for f in FORCES], frequencies, X)
    several = one.harmonic(FORCES, frequencies)
    for i, frequency in enumerate(frequencies):
        direct = one.harmonic(FORCES, float(frequency)).deflection(X)
        close(0.7 * units[i, 0] + 1.3 * np.exp(1j * np.deg2rad(63.0)) * units[i, 1], direct, 1e-8)
        close(several.at(i).deflection(X), direct, 1e-8)


# --- Imposed displacements ---


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("devices", [(), (Device(position=0.41, dashpot=0.9, stiffness=71.0),)])
def test_imposed_displacements_are_kept_by_forces_that_make_the_same_field(titanium_strip, model, devices):
    one = built(model, titanium_strip, 48)
    field = one.imposed(FORCES, 411.0, devices=devices)
    kept = field.deflection([force.position for force in FORCES])
    tolerance = 2e-2 if model == "segment" else 1e-9  # its corrected reading is not the row on which a force acts
    assert kept == pytest.approx([0.7, 1.3 * np.exp(1j * np.deg2rad(63.0))], rel=tolerance)
    close(one.harmonic(field.forces[:2], 411.0, devices=devices).deflection(X), field.deflection(X), 1e-8)


@pytest.mark.parametrize("model", MODELS)
def test_two_displacements_at_one_place_cannot_be_imposed(titanium_strip, model):
    for twice in ((FORCES[0], FORCES[0]), (FORCES[0], PointForce(position=0.73))):
        with pytest.raises(InputError, match="imposed"):
            built(model, titanium_strip).imposed(twice, 411.0)


@pytest.mark.parametrize("off", [0.3, 1e-2, 1e-4])
@pytest.mark.parametrize("part", [0.0, -3e-10, 1e-5])
def test_a_displacement_near_a_node_of_a_resonance_of_the_free_beam_is_imposed(titanium_strip, off, part):
    """The field under forces has a pole there, that under displacements has none."""
    hertz, place = closed_forms.frequency_hz(titanium_strip, 7) * (1.0 + part), (3.0 + off) * 0.73 / 7
    x = np.array([0.1, 0.33, 0.6])
    found = ExactModel(titanium_strip).imposed(PointForce(position=place), hertz).deflection(x)
    reference = transfer.deflection(
        titanium_strip, "euler-bernoulli", hertz, (PointForce(position=place),), [*x, place], 60
    )
    close(found, reference[:-1] / reference[-1], 1e-6)


@pytest.mark.parametrize("model", ["analytic", "fem"])
def test_a_resonance_of_the_beam_at_rest_at_its_actuators_is_refused(titanium_strip, model):
    """Found from outside: where the determinant of the receptance changes sign without a pole."""
    from scipy.optimize import brentq

    one, places = built(model, titanium_strip, 48), [force.position for force in FORCES]

    def determinant(f):
        fields = [one.harmonic(PointForce(position=p), f) for p in places]
        return np.linalg.det(np.array([field.deflection(places).real for field in fields])) * 1e12

    f = np.linspace(300.0, 420.0, 60)
    values = np.array([determinant(g) for g in f])
    smooth = abs(values[:-1]) + abs(values[1:]) < 4 * np.median(abs(values))
    zero = np.flatnonzero((values[:-1] * values[1:] < 0) & smooth)[0]
    resonance = brentq(determinant, f[zero], f[zero + 1], xtol=1e-12, rtol=1e-14)
    with pytest.raises(ResonanceError, match="resonance"):
        one.imposed(FORCES, resonance)
    assert np.isfinite(one.imposed(FORCES, resonance * (1 + 1e-6)).deflection(X)).all()
    damped = built(model, replace(titanium_strip, loss_factor=1e-4), 48)
    assert np.isfinite(damped.imposed(FORCES, resonance).deflection(X)).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequency_hz": float("nan")}, "frequency_hz = nan"),
        ({"frequency_hz": 0.0}, "frequency_hz = 0"),
        ({"forces": ()}, "give a PointForce"),
        ({"forces": (PointForce(position=0.74),)}, r"force\.position = 0\.74 lies off the beam"),
    ],
)
@pytest.mark.parametrize("model", MODELS)
def test_drives_that_cannot_be_are_refused(titanium_strip, model, change, message):
    given = {"forces": FORCES, "frequency_hz": 100.0} | change
    with pytest.raises(InputError, match=message):
        built(model, titanium_strip, 20).harmonic(given["forces"], given["frequency_hz"])
