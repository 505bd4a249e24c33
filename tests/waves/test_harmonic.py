"""The driven beam: exact field, both discrete models, damping, resonance, drives."""

import sys
from itertools import product

import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes
from verify.elements import linear as fem_beam
from verify.errors import InputError, ResonanceError
from verify.exact import closed_forms
from verify.options import SUPPORTS
from verify.problem.beam import PointForce
from verify.segments import linear as segment_model
from verify.segments.assembly import build_chain
from verify.segments.loads import joint_weights
from verify.waves.imposed import driven_field, held_units

FORCES = (PointForce(position=0.083, amplitude=0.7), PointForce(position=0.611, amplitude=1.3, phase_deg=63.0))
X = np.array([0.0, 0.021, 0.083, 0.3333, 0.52, 0.7, 0.73])
SOLVERS = {"segment": segment_model.solve_harmonic, "fem": fem_beam.solve_harmonic}


def close(found, exact, bound):
    assert abs(found - exact).max() < bound * abs(exact).max()


def error(found, exact):
    return np.linalg.norm(found.deflection(X) - exact.deflection(X)) / np.linalg.norm(exact.deflection(X))


@pytest.mark.parametrize("frequency", [1e-300, 1e-12, 1e-6, 1e-4])
def test_a_slow_force_bends_a_held_beam_as_a_dead_load_does(titanium_strip, frequency):
    """Textbook deflections; the inertia left out is (f / f_1)^2, below 1e-8 here."""
    ei, force, x = (
        titanium_strip.bending_stiffness,
        PointForce(position=0.311, amplitude=1.7),
        np.array([0.05, 0.29, 0.6]),
    )
    a, b = np.minimum(x, 0.311), 0.73 - np.maximum(x, 0.311)
    pinned = 1.7 * a * b * (0.73**2 - a**2 - b**2) / (6 * 0.73 * ei)
    close(analytic_modes.solve_harmonic(titanium_strip, [force], frequency).deflection(x), pinned, 1e-8)
    cantilever = replace(titanium_strip, supports=("clamped", "free"))
    tip = 1.7 * a**2 * (3 * np.maximum(x, 0.311) - a) / (6 * ei)
    close(analytic_modes.solve_harmonic(cantilever, [force], frequency).deflection(x), tip, 1e-8)


def test_a_slow_force_drives_a_free_beam_as_a_rigid_body(titanium_strip):
    free = replace(titanium_strip, supports=("free", "free"))
    mass, omega = free.mass_per_length * 0.73, 2 * np.pi * 1e-5
    x, lever = np.array([0.0, 0.4, 0.73]), 0.611 - 0.365
    rigid = -2.3 / omega**2 * (1 / mass + lever * (x - 0.365) / (mass * 0.73**2 / 12))
    close(
        analytic_modes.solve_harmonic(free, [PointForce(position=0.611, amplitude=2.3)], 1e-5).deflection(x),
        rigid,
        1e-9,
    )
    for supports in (("free", "free"), ("pinned", "free"), ("guided", "guided")):
        with pytest.raises(InputError, match="moves beyond floating point, give a higher frequency_hz"):
            analytic_modes.solve_harmonic(replace(free, supports=supports), FORCES, 1e-160)


def test_the_closed_form_is_the_modal_sum_without_its_truncation(titanium_strip):
    beam = replace(titanium_strip, loss_factor=0.02)
    omega, total = 2 * np.pi * 311.0, 0.0
    for n in range(1, 4001):
        shape = analytic_modes.mode_shape(beam, n, np.array([0.3333, 0.083]))
        stiffness = (2 * np.pi * closed_forms.frequency_hz(beam, n)) ** 2 * (1 + 0.02j)
        total += shape[0] * shape[1] / (stiffness - omega**2)
    found = analytic_modes.solve_harmonic(beam, [PointForce(position=0.083)], 311.0).deflection(0.3333)[0]
    assert found == pytest.approx(total, rel=1e-9)


@pytest.mark.parametrize("supports", list(product(SUPPORTS, SUPPORTS)), ids="-".join)
def test_the_spliced_field_obeys_the_beam_equation_its_ends_and_its_forces(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports, loss_factor=0.05)
    field = analytic_modes.solve_harmonic(beam, FORCES, 777.0)
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
@pytest.mark.parametrize("model", SOLVERS)
def test_both_discrete_models_converge_with_order_four(titanium_strip, supports, model):
    """Forces on joints or nodes at every size, d = L/8 and 5L/6; damping keeps a resonance from shifting the error."""
    beam = replace(titanium_strip, supports=supports, loss_factor=0.05)
    forces = (PointForce(position=0.73 / 8, amplitude=0.7), PointForce(position=0.73 * 5 / 6, phase_deg=63.0))
    exact = analytic_modes.solve_harmonic(beam, forces, 233.0)
    errors = [error(SOLVERS[model](beam, forces, 233.0, n), exact) for n in (120, 240)]
    order = np.log2(errors[0] / errors[1])
    if model == "segment" and "clamped" in supports:  # Gregory's walls: the error changes its sign on the way
        assert order > 3.0
        assert errors[1] < 1e-4
    else:
        assert order == pytest.approx(4.0, abs=0.25)


@pytest.mark.parametrize(
    "supports", [("pinned", "pinned"), ("guided", "guided"), ("free", "free"), ("clamped", "pinned")], ids="-".join
)
@pytest.mark.parametrize("place", [0.0031, 0.0117, 0.4321, 0.7288])
def test_a_force_anywhere_even_in_the_last_link_keeps_the_error_small(titanium_strip, supports, place):
    beam = replace(titanium_strip, supports=supports, loss_factor=0.05)
    forces = (PointForce(position=place),)
    exact = analytic_modes.solve_harmonic(beam, forces, 233.0)
    fine, coarse = (error(segment_model.solve_harmonic(beam, forces, 233.0, n), exact) for n in (160, 40))
    if supports[0] == "clamped" and place < 3 * 0.73 / 160:
        # in the links next to a clamped wall the joints are of order 2, where the beam itself hardly moves
        assert fine < 0.02
    else:
        assert fine < 2e-4
        assert fine < 0.03 * coarse


def test_the_lever_rule_shares_a_force_as_a_rigid_link_does(titanium_strip):
    weights = joint_weights(build_chain(titanium_strip, 10), 0.73 * 0.2375, "lever")
    assert weights[2:4] == pytest.approx([0.625, 0.375])
    assert weights.sum() == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("load", "reading", "expected"),
    [("lever", "raw", 2.0), ("reciprocal", "raw", 2.0), ("reciprocal", "links", 2.0), ("reciprocal", "corrected", 4.0)],
)
def test_orders_of_loads_and_readings(titanium_strip, load, reading, expected):
    forces = (PointForce(position=0.73 / 8, amplitude=0.7), PointForce(position=0.73 * 5 / 6, phase_deg=63.0))
    exact = analytic_modes.solve_harmonic(titanium_strip, forces, 123.0)
    errors = [
        error(segment_model.solve_harmonic(titanium_strip, forces, 123.0, n, load=load, reading=reading), exact)
        for n in (240, 480)
    ]
    band = 0.45 if reading == "links" else 0.25  # how far x lies from the next joint matters to a straight link
    assert np.log2(errors[0] / errors[1]) == pytest.approx(expected, abs=band)


@pytest.mark.parametrize("model", SOLVERS)
def test_one_loss_factor_one_modal_ratio_one_dashpot_damp_a_resonance_alike(titanium_strip, model):
    frequency = sys.modules[SOLVERS[model].__module__].solve_modes(titanium_strip, 3, 60).frequencies_hz[2]
    force = [PointForce(position=0.111)]
    eta = 0.004
    by_loss = SOLVERS[model](replace(titanium_strip, loss_factor=eta), force, float(frequency), 60).deflection(X)
    close(
        SOLVERS[model](titanium_strip, force, float(frequency), 60, modal_damping=eta / 2).deflection(X), by_loss, 0.002
    )
    if model == "segment":
        stiffness = titanium_strip.bending_stiffness / (0.73 / 60)
        dashpot = eta * stiffness / (2 * np.pi * frequency)
        close(
            segment_model.solve_harmonic(titanium_strip, force, float(frequency), 60, joint_dashpot=dashpot).deflection(
                X
            ),
            by_loss,
            1e-10,
        )


@pytest.mark.parametrize("model", ["analytic", *SOLVERS])
def test_an_undamped_resonance_is_refused_with_the_mode_and_the_distance(titanium_strip, model):
    if model == "analytic":
        solve, frequency = analytic_modes.solve_harmonic, closed_forms.frequency_hz(titanium_strip, 7)
        given = ()
    else:
        solve, given = SOLVERS[model], (33,)
        frequency = float(sys.modules[solve.__module__].solve_modes(titanium_strip, 7, 33).frequencies_hz[6])
    for off in (0.0, 3e-10):
        with pytest.raises(InputError, match=rf"resonance of mode 7 of the {model} model"):
            solve(titanium_strip, [PointForce(position=0.1)], frequency * (1 + off), *given)
    assert np.isfinite(
        solve(titanium_strip, [PointForce(position=0.1)], frequency * (1 + 1e-7), *given).deflection(X)
    ).all()
    damped = replace(titanium_strip, loss_factor=1e-4)
    assert np.isfinite(solve(damped, [PointForce(position=0.1)], frequency, *given).deflection(X)).all()


@pytest.mark.parametrize("model", ["analytic", *SOLVERS])
def test_reciprocity_of_force_and_deflection(titanium_strip, model):
    beam = replace(titanium_strip, supports=("clamped", "guided"), loss_factor=0.01)
    a, b = 0.73 * 7 / 41, 0.73 * 30 / 41  # joints and nodes of 41 parts

    def there(source, place):
        given = () if model == "analytic" else (41,)
        solve = analytic_modes.solve_harmonic if model == "analytic" else SOLVERS[model]
        return solve(beam, [PointForce(position=source)], 412.0, *given).deflection(place)[0]

    assert there(a, b) == pytest.approx(there(b, a), rel=1e-11)


@pytest.mark.parametrize("model", ["analytic", *SOLVERS])
def test_imposed_displacements_are_held(titanium_strip, model):
    given = () if model == "analytic" else (48,)
    solve = analytic_modes.solve_harmonic if model == "analytic" else SOLVERS[model]
    field = driven_field(lambda forces, f: solve(titanium_strip, forces, f, *given), FORCES, 411.0, "displacement")
    held = field.deflection([force.position for force in FORCES])
    assert held == pytest.approx([0.7, 1.3 * np.exp(1j * np.deg2rad(63.0))], rel=1e-9)
    twice = (FORCES[0], FORCES[0])
    with pytest.raises(InputError, match="cannot be imposed"):
        driven_field(lambda forces, f: solve(titanium_strip, forces, f, *given), twice, 411.0, "displacement")


def held(model, beam, frequency, kind="displacement"):
    """The field under imposed displacements."""
    given = () if model == "analytic" else (48,)
    solve = analytic_modes.solve_harmonic if model == "analytic" else SOLVERS[model]
    return driven_field(lambda forces, f: solve(beam, forces, f, *given), FORCES, frequency, kind)


@pytest.mark.parametrize("model", ["analytic", *SOLVERS])
def test_a_resonance_of_the_held_beam_is_refused(titanium_strip, model):
    """Found from outside: where the determinant of the receptance changes sign."""
    from scipy.optimize import brentq

    given = () if model == "analytic" else (48,)
    solve = analytic_modes.solve_harmonic if model == "analytic" else SOLVERS[model]
    places = [force.position for force in FORCES]

    def determinant(f):
        fields = [solve(titanium_strip, [PointForce(position=p)], f, *given) for p in places]
        return np.linalg.det(np.array([field.deflection(places).real for field in fields])) * 1e12

    f = np.linspace(300.0, 420.0, 60)
    values = np.array([determinant(g) for g in f])
    zero = np.flatnonzero(
        (values[:-1] * values[1:] < 0) & (abs(values[:-1]) + abs(values[1:]) < 4 * np.median(abs(values)))
    )[0]
    resonance = brentq(determinant, f[zero], f[zero + 1], xtol=1e-12, rtol=1e-14)
    with pytest.raises(ResonanceError, match="resonance of the beam held at its actuators"):
        held(model, titanium_strip, resonance)
    assert np.isfinite(held(model, titanium_strip, resonance * (1 + 1e-6)).deflection(X)).all()
    damped = replace(titanium_strip, loss_factor=1e-4)
    assert np.isfinite(held(model, damped, resonance).deflection(X)).all()
    assert np.isfinite(held(model, titanium_strip, resonance, "force").deflection(X)).all()

    def units(acting, frequencies, x):
        module = {"analytic": analytic_modes, "segment": segment_model, "fem": fem_beam}[model]
        return module.unit_responses(titanium_strip, acting, frequencies, x, *given)

    several = held_units(units, np.array(places), titanium_strip, np.array([resonance, 333.0]), X)
    assert np.isnan(several[0]).all()
    single = held(model, titanium_strip, 333.0).deflection(X)
    close(0.7 * several[1, 0] + 1.3 * np.exp(1j * np.deg2rad(63.0)) * several[1, 1], single, 1e-8)


@pytest.mark.parametrize("model", SOLVERS)
def test_superposed_unit_responses_are_the_direct_field(titanium_strip, model):
    beam = replace(titanium_strip, loss_factor=0.01, supports=("pinned", "free"))
    frequencies = np.array([37.0, 512.0])
    units = segment_model.unit_responses if model == "segment" else fem_beam.unit_responses
    found = units(beam, [f.position for f in FORCES], frequencies, X, 37)
    for i, frequency in enumerate(frequencies):
        direct = SOLVERS[model](beam, FORCES, float(frequency), 37).deflection(X)
        close(0.7 * found[i, 0] + 1.3 * np.exp(1j * np.deg2rad(63.0)) * found[i, 1], direct, 1e-8)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"frequency_hz": float("nan")}, "frequency_hz = nan"),
        ({"frequency_hz": 0.0}, "frequency_hz = 0"),
        ({"forces": ()}, "at least one PointForce"),
        ({"forces": (PointForce(position=0.74),)}, r"force\.position = 0\.74 lies off the beam"),
    ],
)
@pytest.mark.parametrize("model", ["analytic", *SOLVERS])
def test_drives_that_cannot_be_are_refused(titanium_strip, model, change, message):
    asked = {"forces": FORCES, "frequency_hz": 100.0} | change
    given = () if model == "analytic" else (20,)
    solve = analytic_modes.solve_harmonic if model == "analytic" else SOLVERS[model]
    with pytest.raises(InputError, match=message):
        solve(titanium_strip, asked["forces"], asked["frequency_hz"], *given)


def test_damping_that_a_model_cannot_represent_is_refused(titanium_strip):
    with pytest.raises(InputError, match=r"loss_factor = -0\.1: give a finite number of at least 0"):
        replace(titanium_strip, loss_factor=-0.1)
    with pytest.raises(InputError, match="modal_damping"):
        fem_beam.solve_harmonic(titanium_strip, FORCES, 100.0, 20, modal_damping=-0.1)
    with pytest.raises(InputError, match="takes all"):
        fem_beam.solve_harmonic(titanium_strip, FORCES, 100.0, 2000, modal_damping=0.1)
    clamped = replace(titanium_strip, supports=("clamped", "free"))
    with pytest.raises(InputError, match="couple the modes"):
        segment_model.solve_harmonic(clamped, FORCES, 100.0, 20, modal_damping=0.01, joint_dashpot=0.1)
