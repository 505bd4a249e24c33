"""What scikit-fem does in the elements, held to be its doing, and its own element as a subject beside ours."""

import numpy as np
import pytest
from factored import factor_difference
from msgspec.structs import replace
from packaged_beams import packaged_beam

from verify.beam import Beam, PointForce
from verify.elements import curvatures, linear, mesh
from verify.elements.in_time import time_basis
from verify.elements.stock import stock_frequency_hz
from verify.errors import InputError
from verify.section import Section

PAPER = packaged_beam("paper")
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


@pytest.fixture
def unkept():
    """No basis is kept from before, nor afterwards."""
    mesh._cached.cache_clear()
    yield
    mesh._cached.cache_clear()


def raising(*_, **__):
    raise ZeroDivisionError("scikit-fem's is gone")


@pytest.mark.parametrize("work", works())
@pytest.mark.parametrize("form", ["bending", "inertia"])
def test_without_scikit_fems_assembly_there_is_no_model(form, work, monkeypatch):
    from verify.elements import element

    monkeypatch.setattr(getattr(element, form), "_kernel", raising)
    with pytest.raises(ZeroDivisionError):
        works()[work]()


@pytest.mark.parametrize("work", works())
def test_frequencies_and_answers_follow_scikit_fems_stiffness(work, monkeypatch):
    """Every entry of K 1.21 times as large: frequencies rise by 1.1; a driven beam, no frequency, answers otherwise."""
    from verify.elements import element

    here, true = works()[work](), element.bending._kernel
    monkeypatch.setattr(element.bending, "_kernel", lambda *given: 1.21 * true(*given))
    linear._cached.cache_clear()
    found = works()[work]()
    if np.iscomplexobj(here):
        assert abs(found / here - 1).min() > 0.02
    else:
        assert found == pytest.approx(1.1 * here, rel=1e-12)


@pytest.mark.parametrize("work", works())
def test_without_scikit_fems_degrees_of_freedom_no_support_is_held(work, monkeypatch, unkept):
    from skfem.assembly.dofs import Dofs

    monkeypatch.setattr(Dofs, "__init__", raising)
    with pytest.raises(ZeroDivisionError):
        works()[work]()


@pytest.mark.parametrize("work", works())
def test_without_scikit_fems_mapping_there_is_no_model(work, monkeypatch, unkept):
    from skfem.mapping import MappingAffine

    monkeypatch.setattr(MappingAffine, "invDF", raising)
    with pytest.raises(ZeroDivisionError):
        works()[work]()


def readings():
    """Every way a force enters and a shape is read, by name, of models that are built before."""
    modes, equal, stepped = linear.solve_modes(STEPPED, 3, 23), time_basis(STRIP, 23), time_basis(STEPPED, 23)
    field, x = linear.solve_harmonic(STRIP, FORCES, 777.0, 23), np.array([0.0137, 0.2911])
    return {
        "a force that drives a field": works()["field"],
        "a field": lambda: field.deflection(x),
        "responses to unit forces": works()["unit responses"],
        "modes at the points they are compared at": modes.sampled,
        "their curvatures": modes.curvatures,
        "their slopes": lambda: modes.slope(x),
        "a force on the modes of equal elements": lambda: equal.loads(0.1),
        "those modes": lambda: equal.shapes(x, 1),
        "those modes all along": lambda: equal.shapes(np.linspace(0.001, 0.429, 77), 2),
        "a force on the modes of a stepped beam": lambda: stepped.loads(0.1),
        "modes of a stepped beam": lambda: stepped.shapes(x, 0),
    }


def replacing(monkeypatch, part, make):
    """Puts what `make` makes of its answer in place of a part that is read with.

    The finder is ours in scikit-fem's place for it, and held below to find the cells that scikit-fem's does.
    """
    from skfem.assembly.basis.abstract_basis import AbstractBasis
    from skfem.mapping import MappingAffine

    from verify.elements.element import Line

    if part == "finder":
        finder = Line.element_finder
        monkeypatch.setattr(Line, "element_finder", lambda *a, **k: lambda x: make(finder(*a, **k)(x)))
    elif part == "mapping":
        local = MappingAffine.invF
        monkeypatch.setattr(MappingAffine, "invF", lambda *a, **k: make(local(*a, **k)))
    else:
        numbers = AbstractBasis.element_dofs.fget
        monkeypatch.setattr(AbstractBasis, "element_dofs", property(lambda basis: make(numbers(basis))))


ALTERED = {
    "finder": lambda cells: np.maximum(cells - 1, 0),
    "mapping": lambda xi: 0.9 * xi,
    "degrees of freedom": lambda dofs: dofs[[2, 1, 0, 3]],
}


@pytest.mark.parametrize("part", ALTERED)
@pytest.mark.parametrize("reading", readings())
def test_without_what_scikit_fem_reads_with_no_force_acts_and_no_shape_is_read(part, reading, monkeypatch):
    read = readings()[reading]
    replacing(monkeypatch, part, raising)
    with pytest.raises(ZeroDivisionError):
        read()


@pytest.mark.parametrize("part", ALTERED)
@pytest.mark.parametrize("reading", readings())
def test_forces_and_shapes_follow_what_scikit_fem_reads_with(part, reading, monkeypatch):
    """The neighbour's cell, a point a tenth nearer its left node, deflections of the two nodes exchanged."""
    read = readings()[reading]
    here = read()
    replacing(monkeypatch, part, ALTERED[part])
    assert abs(read() - here).max() > 1e-3 * abs(here).max()


@pytest.mark.parametrize("stretched", ["DF", "invDF"])
def test_slopes_follow_scikit_fems_mapping(stretched, monkeypatch, unkept):
    """Nodal slopes weigh with both stretches in a slope, nodal deflections with that of the mesh to the cell alone."""
    from skfem.mapping import MappingAffine

    true, x = getattr(MappingAffine, stretched), np.array([0.11, 3.3])
    here = mesh.basis_between(UNEQUAL).read(np.eye(12), x, 1)
    mesh._cached.cache_clear()
    monkeypatch.setattr(MappingAffine, stretched, lambda *given: 1.21 * true(*given))
    found = mesh.basis_between(UNEQUAL).read(np.eye(12), x, 1)
    deflections, slopes = slice(0, None, 2), slice(1, None, 2)
    assert found[slopes] == pytest.approx(1.21 * here[slopes], rel=1e-13)
    assert found[deflections] == pytest.approx((1.0 if stretched == "DF" else 1.21) * here[deflections], rel=1e-13)


def test_the_mesh_has_the_beams_own_coordinates():
    elements = mesh.build_elements(STEPPED, 43, 1.7)
    nodes = elements.basis.mesh.p[0] * elements.parts.unit
    assert nodes[[0, -1]] == pytest.approx([0.0, 0.43], abs=1e-15)
    for step in (0.16, 0.20):
        assert abs(nodes - step).min() < 1e-15
    first = np.diff(nodes)[: int(np.searchsorted(nodes, 0.16 - 1e-9))]
    assert first[-1] / first[0] == pytest.approx(1.7, rel=1e-12)
    assert elements.basis.mapping.detDF(np.zeros((1, 1)))[:, 0] == pytest.approx(elements.lengths, rel=1e-15)


@pytest.mark.parametrize("form", ["bending", "inertia"])
def test_our_element_assembles_what_scikit_fems_own_does_on_unequal_cells(form):
    """Of the same degrees of freedom in the same order."""
    from skfem import Basis, ElementLineHermite, MeshLine

    from verify.elements import element

    weights = np.array([2.0, 0.3, 5.0, 1.1, 0.7])
    stock = Basis(MeshLine(UNEQUAL), ElementLineHermite(), intorder=6)
    expected = getattr(element, form).assemble(stock, weight=element.per_cell(weights, stock)).toarray()
    found = mesh.assemble(mesh.basis_between(UNEQUAL), form, weights).toarray()
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-10 * abs(expected).max())


def test_our_readings_are_the_probes_of_scikit_fems_own_element():
    from skfem import Basis, ElementLineHermite, MeshLine

    x = np.array([0.0, 0.11, 0.3, 1.69, 3.3, 5.3])
    stock = Basis(MeshLine(UNEQUAL), ElementLineHermite()).probes(x[None]).toarray()
    basis = mesh.basis_between(UNEQUAL)
    assert mesh.point_loads(basis, x) == pytest.approx(stock, abs=1e-11)
    nodal = np.random.default_rng(3).standard_normal((4, basis.N))
    assert basis.read(nodal, x) == pytest.approx(nodal @ stock.T, abs=1e-10)


@pytest.mark.parametrize("order", [0, 1, 2])
def test_our_readings_are_scikit_fems_probes_to_the_last_digit(order):
    """`probes` reads values: of an element whose values are the derivative of ours that scikit-fem is given."""
    from skfem import CellBasis
    from skfem.element import DiscreteField

    from verify.elements.element import HermiteLine

    class Derived(HermiteLine):
        def gbasis(self, mapping, X, i, tind=None):  # noqa: N803
            field = super().gbasis(mapping, X, i, tind)[0]
            return (DiscreteField((np.asarray(field), field.grad[0], field.hess[0, 0])[order]),)

    rng, basis = np.random.default_rng(6), mesh.basis_between(UNEQUAL)
    x = np.concatenate([UNEQUAL, rng.uniform(0.0, 5.3, 300)])
    nodal = rng.standard_normal((4, basis.N)) + 1j * rng.standard_normal((4, basis.N))
    probes = CellBasis(basis.mesh, Derived()).probes(x[None])
    assert (basis.read(nodal, x, order) == (probes @ nodal.T).T).all()
    if order == 0:
        assert (mesh.point_loads(basis, x) == probes.toarray()).all()


@pytest.mark.parametrize("order", [1, 2])
def test_a_derivative_read_is_the_field_that_scikit_fem_interpolates(order):
    basis = mesh.basis_between(UNEQUAL)
    nodal = np.random.default_rng(4).standard_normal(basis.N)
    points = basis.at("gauss")
    field, places = points.interpolate(nodal), np.array(points.global_coordinates())[0].ravel()
    expected = (field.grad[0] if order == 1 else field.hess[0, 0]).ravel()
    assert basis.read(nodal[None], places, order)[0] == pytest.approx(expected, abs=1e-10)


def test_the_third_derivative_is_the_change_of_the_second_over_its_cell_and_the_fourth_is_none():
    basis = mesh.basis_between(UNEQUAL)
    nodal = np.random.default_rng(7).standard_normal((3, basis.N))
    left, right = UNEQUAL[:-1], UNEQUAL[1:] - 1e-9
    bend = basis.read(nodal, np.concatenate([left, right]), 2)
    change = (bend[:, len(left) :] - bend[:, : len(left)]) / (right - left)
    found = basis.read(nodal, 0.6 * left + 0.4 * right, 3)
    assert found == pytest.approx(change, rel=1e-9)
    assert abs(found).min() > 0.01
    assert not basis.read(nodal, left, 4).any()


def test_our_finder_finds_the_cells_that_scikit_fems_does():
    from skfem.mesh import MeshLine1

    line = mesh.basis_between(UNEQUAL).mesh
    x = np.concatenate([UNEQUAL, np.random.default_rng(5).uniform(0.0, 5.3, 200)])
    assert (line.element_finder()(x) == MeshLine1.element_finder(line)(x)).all()
    assert line.element_finder()(np.array([-1e-9, 5.3 + 1e-9])).tolist() == [0, 4]


def test_factors_read_off_the_stiffness_of_equal_elements_are_the_textbooks_with_no_rounding():
    """EI/l and 3 EI/l, at any size: Simpson's points are floats, those of Gauss are not."""
    found = mesh.assemble(mesh.basis_between(np.arange(1001.0)), "bending", np.ones(1000))
    assert curvatures.curvature_weights(np.ones(1000), found).tolist() == [1.0] * 1000 + [3.0] * 1000


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free"), ("guided", "clamped")])
@pytest.mark.parametrize("grading", [1.0, 2.3, 0.02])
@pytest.mark.parametrize("section", [(), STEPS])
def test_the_factored_stiffness_is_the_assembled_one(supports, grading, section):
    beam = replace(STRIP, supports=supports, section=section)
    assert factor_difference(beam, 61, grading) < 2e-15


@pytest.mark.parametrize("beam", [PAPER, STRIP, replace(STRIP, supports=("clamped", "free"))], ids=str)
@pytest.mark.parametrize(("count", "least", "most"), [(49, 1e-13, 1e-9), (400, 3e-11, 1e-6), (3000, 3e-7, 3e-3)])
def test_scikit_fems_own_element_loses_digits_with_the_size(beam, count, least, most):
    """Mode 1 of the paper's beam: 1e-11, 7e-9, 3e-5. Rounding, so that the bands are wide; it grows about like N^4."""
    off = stock_frequency_hz(beam, 1, count) / linear.solve_modes(beam, 1, count).frequencies_hz[0] - 1
    assert least < abs(off) < most


@pytest.mark.parametrize(
    ("beam", "mode", "count", "message"),
    [
        (STEPPED, 1, 20, "sections"),
        (replace(STRIP, supports=("free", "pinned")), 1, 20, "rigid motions"),
        (STRIP, 10, 5, "one short"),
        (STRIP, 11, 5, "more than the 10"),
    ],
)
def test_what_the_stock_solve_does_not_have_is_refused_in_a_sentence(beam, mode, count, message):
    with pytest.raises(InputError, match=message):
        stock_frequency_hz(beam, mode, count)


@pytest.mark.parametrize("left", ["pinned", "clamped", "guided", "free"])
@pytest.mark.parametrize("right", ["pinned", "clamped", "guided", "free"])
def test_unknowns_counted_without_scikit_fem_are_those_it_leaves(left, right):
    """A plan counts them without loading it; the first free one of the left end is what a mode's sign is taken by."""
    beam = replace(STRIP, supports=(left, right))
    free = mesh.build_elements(beam, 7).free
    assert linear.unknowns(beam, 7) == len(free)
    held = {"pinned": {0}, "clamped": {0, 1}, "guided": {1}, "free": set()}
    assert set(range(16)) - set(free.tolist()) == held[left] | {14 + j for j in held[right]}


def test_small_bases_are_kept_for_who_asks_next_and_large_ones_are_not():
    few, many = np.linspace(0.0, 0.43, 17), np.linspace(0.0, 0.43, mesh.KEPT + 1)
    assert mesh.basis_between(few) is mesh.basis_between(few.copy())
    assert mesh.basis_between(few) is not mesh.basis_between(few, shear=True)
    assert mesh.basis_between(many) is not mesh.basis_between(many)
