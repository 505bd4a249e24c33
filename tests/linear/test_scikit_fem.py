"""What scikit-fem does in the elements, held to be its doing, and its own element as a subject beside ours."""

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.elements import linear, mesh, pencil
from verify.elements.in_time import time_basis
from verify.elements.stock import stock_frequency_hz
from verify.scene.load import load_scene
from verify.section import Section

PAPER = load_scene("paper").beam
STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
STEPS = (Section(length=0.16), Section(length=0.04, thickness=0.0031), Section(length=0.23, youngs_modulus=61e9))
STEPPED = replace(STRIP, section=STEPS, supports=("clamped", "guided"))
FORCES = [PointForce(position=0.0137), PointForce(position=0.2911, amplitude=0.7, phase_deg=63.0)]
UNEQUAL = np.array([0.0, 0.3, 1.7, 2.2, 4.9, 5.3])


def works():
    """Everything the model is asked for, by name."""
    return {
        "modes": lambda: linear.solve_modes(STRIP, 5, 23).frequencies_hz,
        "modes of many elements": lambda: linear.solve_modes(STEPPED, 5, 300, grading=1.4).frequencies_hz,
        "field": lambda: linear.solve_harmonic(STRIP, FORCES, 777.0, 23).deflection([0.1417]),
        "unit responses": lambda: linear.unit_responses(STRIP, [0.1], np.array([777.0]), np.array([0.1417]), 23),
        "motion on equal elements": lambda: time_basis(STRIP, 23).omegas,
        "motion on a stepped beam": lambda: time_basis(STEPPED, 23).omegas,
    }


def raising(*_, **__):
    raise ZeroDivisionError("scikit-fem's is gone")


@pytest.mark.parametrize("work", works())
@pytest.mark.parametrize("form", ["bending", "inertia"])
def test_without_scikit_fems_assembly_there_is_no_model(form, work, monkeypatch):
    from verify.elements import element

    monkeypatch.setattr(getattr(element, form), "_kernel", raising)
    with pytest.raises(ZeroDivisionError):
        works()[work]()


@pytest.mark.parametrize("form", ["bending", "inertia"])
def test_our_element_assembles_what_scikit_fems_own_does_on_unequal_cells(form):
    """Of the same degrees of freedom in the same order."""
    from skfem import Basis, ElementLineHermite, MeshLine

    from verify.elements import element

    weights = np.array([2.0, 0.3, 5.0, 1.1, 0.7])
    make = mesh.stiffness_matrix if form == "bending" else mesh.mass_matrix
    stock = Basis(MeshLine(UNEQUAL), ElementLineHermite(), intorder=6)
    field = {"stiffness" if form == "bending" else "mass": element.per_cell(weights, stock)}
    expected = getattr(element, form).assemble(stock, **field).toarray()
    found = make(mesh.basis_between(UNEQUAL), weights).toarray()
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-10 * abs(expected).max())


def test_our_readings_are_the_probes_of_scikit_fems_own_element():
    from skfem import Basis, ElementLineHermite, MeshLine

    x = np.array([0.0, 0.11, 0.3, 1.69, 3.3, 5.3])
    stock = Basis(MeshLine(UNEQUAL), ElementLineHermite()).probes(x[None]).toarray()
    basis = mesh.basis_between(UNEQUAL)
    assert mesh.point_loads(basis, x) == pytest.approx(stock, abs=1e-11)
    nodal = np.random.default_rng(3).standard_normal((4, basis.N))
    assert mesh.interpolate(basis, nodal, x) == pytest.approx(nodal @ stock.T, abs=1e-10)


@pytest.mark.parametrize("order", [1, 2])
def test_a_derivative_read_is_the_field_that_scikit_fem_interpolates(order):
    basis = mesh.basis_between(UNEQUAL)
    nodal = np.random.default_rng(4).standard_normal(basis.N)
    points = basis.at("gauss")
    field, places = points.interpolate(nodal), np.array(points.global_coordinates())[0].ravel()
    expected = (field.grad[0] if order == 1 else field.hess[0, 0]).ravel()
    assert mesh.interpolate(basis, nodal[None], places, order)[0] == pytest.approx(expected, abs=1e-10)


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free"), ("guided", "clamped")])
@pytest.mark.parametrize("grading", [1.0, 2.3, 0.02])
@pytest.mark.parametrize("section", [(), STEPS])
def test_the_factored_stiffness_is_the_assembled_one(supports, grading, section):
    beam = replace(STRIP, supports=supports, section=section)
    assert pencil.factor_difference(beam, 61, grading) < 2e-15


@pytest.mark.parametrize("beam", [PAPER, STRIP, replace(STRIP, supports=("clamped", "free"))], ids=str)
@pytest.mark.parametrize(("count", "least", "most"), [(49, 1e-13, 1e-9), (400, 3e-11, 1e-6), (3000, 3e-7, 3e-3)])
def test_scikit_fems_own_element_loses_digits_with_the_size(beam, count, least, most):
    """Mode 1 of the paper's beam: 1e-11, 7e-9, 3e-5. Rounding, so that the bands are wide; it grows about like N^4."""
    off = stock_frequency_hz(beam, 1, count) / linear.solve_modes(beam, 1, count).frequencies_hz[0] - 1
    assert least < abs(off) < most
