"""The free modes that models bring to time, held against dense solves and against each model's harmonic field."""

import numpy as np
import pytest
from msgspec.structs import replace
from verify.linear.catalogue import MODELS
from verify.linear.fields import phasor

from verify import analytic_modes
from verify.elements import linear as fem_beam
from verify.errors import InputError
from verify.motion.free_vibration import free_vibration
from verify.motion.surface import basis_of
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring
from verify.segments import linear as segment_model

STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
FREQUENCY = 1310.0
FORCES = (
    PointForce(position=0.037, amplitude=1.3, phase_deg=17.0),
    PointForce(position=0.402, amplitude=0.8, phase_deg=101.0),
)

HELD = [("pinned", "pinned"), ("clamped", "free"), ("clamped", "clamped"), ("guided", "pinned"), ("pinned", "clamped")]


def held(supports):
    return Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0, supports=supports)


LOADED = [
    (("pinned", "pinned"), {}),
    (("clamped", "pinned"), {}),
    (("guided", "clamped"), {}),
    (("pinned", "clamped"), {"tension": 20.0}),
    (("clamped", "free"), {"spring": (PointSpring(position=0.3, stiffness=300.0, rotational=2.0),)}),
    (("pinned", "pinned"), {"foundation": 700.0, "mass": (PointMass(position=0.11, mass=0.03, rotary_inertia=4e-6),)}),
    (("clamped", "free"), {"section": (Section(length=0.13, thickness=0.002), Section(length=0.3))}),
]


IN_TIME = [(*given, *of) for of in [("segment", 23, 20), ("fem", 9, 15)] for given in LOADED]


@pytest.mark.parametrize(("supports", "loads", "model", "count", "last"), IN_TIME)
def test_modes_in_time_are_the_models_own_with_their_sign(supports, loads, model, count, last):
    """Eigenvectors have none, shares q of a shape do: they are those of the phi that `solve_modes` gives."""
    beam = replace(held(supports), **loads)
    basis, x = basis_of(beam, model, count, last), np.linspace(0.0, beam.length, 60)[:-1]
    own = MODELS[model].solve_modes(beam, last, count).shapes(x, 0)
    assert abs(basis.shapes(x, 0)[:last] - own).max() < 2e-6 * abs(own).max()
    let_go = free_vibration(beam, 2, 0.01, amplitude=1e-3, model=model, count=count)
    assert let_go.amplitudes[1] > 1e-5
    assert let_go.end.q[1] == pytest.approx(let_go.amplitudes[1] * np.cos(basis.omegas[1] * 0.01), rel=1e-6)


@pytest.mark.parametrize("supports", HELD)
@pytest.mark.parametrize(("model", "count"), [("segment", 33), ("fem", 21)])
def test_the_sum_over_all_modes_is_the_models_own_harmonic_field(model, count, supports):
    """Undamped: modes, their loads and their reading along the beam together."""
    beam = held(supports)
    basis = basis_of(beam, model, count, 0)
    module = {"segment": segment_model, "fem": fem_beam}[model]
    field = module.solve_harmonic(beam, FORCES, FREQUENCY, count)
    share = sum(phasor(f) * basis.loads(f.position) for f in FORCES) / (basis.omegas**2 - (2 * np.pi * FREQUENCY) ** 2)
    x = np.array([0.013, 0.1417, 0.25, 0.3999])
    for derivative in (0, 1, 2):
        assert share @ basis.shapes(x, derivative) == pytest.approx(
            field.shapes(x, derivative), abs=1e-9 * abs(field.shapes(np.linspace(0, beam.length, 99), derivative)).max()
        )


def test_a_stepped_beam_has_its_modes_too():
    steps = (Section(length=0.2), Section(length=0.23, thickness=0.002))
    beam = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0, section=steps)
    for model in ("segment", "fem"):
        basis = basis_of(beam, model, 40, 0)
        module = {"segment": segment_model, "fem": fem_beam}[model]
        assert basis.omegas[:5] / (2 * np.pi) == pytest.approx(
            module.solve_modes(beam, 5, 40).frequencies_hz, rel=1e-10
        )
    exact = basis_of(beam, "analytic", None, 30)
    assert basis.omegas[:3] == pytest.approx(exact.omegas[:3], rel=1e-5)


@pytest.mark.parametrize(("model", "count", "order"), [("segment", 12, 3), ("fem", 12, 2)])
def test_the_surface_is_smooth_across_the_nodes_as_far_as_its_model_says(model, count, order):
    """C2 spline through the joints (Section II.B); C1 Hermite elements; the next derivative jumps."""
    basis = basis_of(STRIP, model, count, 0)
    nodes, tiny = basis.edges[1:-1], 1e-9
    for derivative in range(order + 1):
        left, right = basis.shapes(nodes - tiny, derivative)[:8], basis.shapes(nodes + tiny, derivative)[:8]
        jump = abs(right - left).max() / abs(right).max()
        assert (jump < 1e-5) == (derivative < order), derivative


@pytest.mark.parametrize("supports", [("free", "free"), ("pinned", "free"), ("guided", "guided")])
@pytest.mark.parametrize(("model", "count"), [("segment", 20), ("fem", 20), ("analytic", None)])
def test_a_beam_that_can_drift_away_is_refused(model, count, supports):
    with pytest.raises(InputError, match="rigid motion"):
        basis_of(held(supports), model, count, 20)


def test_exact_modes_with_their_tail_are_the_exact_field():
    """The first modes in their steady state and the rest following at once: nothing is cut off at the drive's frequency."""
    basis = basis_of(STRIP, "analytic", None, 25)
    x = np.array([0.0163, 0.0371, 0.211, 0.4])
    share = sum(phasor(f) * basis.loads(f.position) for f in FORCES) / (basis.omegas**2 - (2 * np.pi * FREQUENCY) ** 2)
    exact = analytic_modes.solve_harmonic(STRIP, FORCES, FREQUENCY)
    rest = basis.tail(FORCES, FREQUENCY, 0.0)
    for derivative in (0, 1):
        kept = share @ basis.shapes(x, derivative)
        assert kept + rest(x, derivative) == pytest.approx(exact.shapes(x, derivative), rel=1e-9)
        assert abs(rest(x, derivative)).max() < 1e-2 * abs(kept).max()
