"""Beams solved side by side have the values that each has alone, or are left to be solved alone: none on trust."""

import sys
from time import process_time
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, InputError, PointMass, PointSpring, Section, cores, fem_beam, segment_model
from verify.elements import stacks as of_elements
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.models import band_stack, stacks, sweeps
from verify.models.eigen import lowest
from verify.models.isolated import isolated
from verify.models.stacks import judged, lowest_of_each
from verify.options import SUPPORTS
from verify.segments import stacks as of_segments
from verify.segments.assembly import build_chain, chain_pencil

L, EI, LINE = 0.73, 3.7, 0.31
MODELS = {"segment": segment_model, "fem": fem_beam}
CHAIN = {
    "wall": "gregory",
    "joints": "series",
    "grading": 1.0,
    "theory": "euler-bernoulli",
    "attachment": "reciprocal",
}
HELD = {"pinned": (True, False), "clamped": (True, True), "guided": (False, True), "free": (False, False)}


def beam_of(rng, supports, n_sections=0, n_masses=0, n_springs=0, **more):
    """A beam of one layout, all its values drawn."""
    length = L * rng.uniform(0.6, 1.7)
    shares = rng.uniform(0.3, 1.0, max(n_sections, 1))
    lengths = [float(share) for share in shares / shares.sum() * length]
    sections = tuple(
        Section(
            length=one,
            bending_stiffness=EI * float(rng.uniform(0.3, 3.0)),
            mass_per_length=LINE * float(rng.uniform(0.5, 2.0)),
        )
        for one in lengths[: n_sections * bool(n_sections)]
    )
    masses = tuple(
        PointMass(position=float(rng.uniform(0.07, 0.93) * length), mass=LINE * L * float(rng.uniform(0.05, 2.0)))
        for _ in range(n_masses)
    )
    if masses:
        masses = (replace(masses[0], rotary_inertia=LINE * L**3 * float(rng.uniform(1e-4, 1e-2))), *masses[1:])
    springs = tuple(
        PointSpring(
            position=float(rng.uniform(0.07, 0.93) * length),
            stiffness=EI / L**3 * float(rng.uniform(1.0, 300.0)),
            rotational=EI / L * float(rng.uniform(0.0, 3.0)),
        )
        for _ in range(n_springs)
    )
    return Beam(
        length=float(sum(lengths)),
        bending_stiffness=EI,
        mass_per_length=LINE,
        supports=supports,
        section=sections,
        mass=masses,
        spring=springs,
        **more,
    )


def many(seed, n=9, supports=("clamped", "pinned"), **layout):
    rng = np.random.default_rng(seed)
    return [beam_of(rng, supports, **layout) for _ in range(n)]


def thick(beams):
    """The same with what Rayleigh's theory takes, unlike in every section."""
    rotary = LINE * 3e-4

    def own(one, i):
        return replace(one, rotary_inertia=rotary * (1.0 + 0.3 * i))

    return [own(replace(b, section=tuple(own(one, i) for i, one in enumerate(b.section))), 1) for b in beams]


def stacked(model, beams, count, **chosen):
    """(the beams' stack, the pencil of each)."""
    if model == "segment":
        pencils = [chain_pencil(build_chain(beam, count, **chosen)) for beam in beams]
        stack = of_segments.chain_stack(beams, count, CHAIN | chosen)
    else:
        pencils = [element_pencil(build_elements(beam, count, **chosen)) for beam in beams]
        stack = of_elements.element_stack(beams, count, **({"grading": 1.0, "theory": "euler-bernoulli"} | chosen))
    return stack, pencils


def layouts(draw):
    return {
        "supports": draw(st.tuples(st.sampled_from(SUPPORTS), st.sampled_from(SUPPORTS))),
        "n_sections": draw(st.integers(0, 4)),
        "n_masses": draw(st.integers(0, 2)),
        "n_springs": draw(st.integers(0, 2)),
    }


@st.composite
def batches(draw):
    """Beams of one layout."""
    return many(draw(st.integers(0, 2**32 - 1)), **layouts(draw))


@settings(max_examples=40, deadline=None)
@given(batches(), st.integers(1, 9), st.integers(24, 90), st.sampled_from(list(MODELS)))
def test_any_beams_of_one_layout_have_the_values_of_each(beams, n_modes, count, model):
    module = MODELS[model]
    found = module.sweep_modes(beams, n_modes, count)
    each = np.array([module.solve_modes(beam, n_modes, count).frequencies_hz for beam in beams])
    assert found == pytest.approx(each, rel=1e-12)


@settings(max_examples=15, deadline=None)
@given(batches(), st.booleans(), st.sampled_from(["lever", "reciprocal"]), st.sampled_from(["half", "five-joint"]))
def test_any_chains_of_one_layout_take_the_settings_of_each(beams, pulled, attachment, wall):
    pull = {"tension": 9.0} if pulled else {"foundation": 170.0}
    beams, chosen = [replace(beam, **pull) for beam in beams], {"attachment": attachment, "wall": wall}
    found = segment_model.sweep_modes(beams, 4, 37, **chosen)
    each = [segment_model.solve_modes(beam, 4, 37, **chosen).frequencies_hz for beam in beams]
    assert found == pytest.approx(np.array(each), rel=1e-12)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("more", "chosen"),
    [
        ({"tension": 9.0}, {"grading": 2.0}),
        ({"foundation": 170.0}, {}),
        ({"tension": 3.0, "foundation": 40.0}, {}),
        ({}, {"theory": "rayleigh", "grading": 0.5}),
        ({"foundation": 90.0}, {"theory": "rayleigh"}),
    ],
)
def test_what_beams_carry_and_are_divided_by_is_swept_together(alone, model, more, chosen):
    beams = thick(many(41, 24, ("free", "pinned"), n_sections=2, n_masses=1, **more))
    found = MODELS[model].sweep_modes(beams, 5, 41, **chosen)
    assert len(alone) <= 3
    each = [MODELS[model].solve_modes(beam, 5, 41, **chosen).frequencies_hz for beam in beams]
    assert found == pytest.approx(np.array(each), rel=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_a_beam_without_what_a_theory_takes_is_refused_by_its_index(model):
    beams = thick(many(43, 12, n_sections=2))
    beams[7] = many(43, 12, n_sections=2)[7]
    with pytest.raises(InputError, match=r"^beams\[7\]: beam.section\[0\].rotary_inertia is missing"):
        MODELS[model].sweep_modes(beams, 3, 30, theory="rayleigh")


@pytest.fixture
def alone(monkeypatch):
    """The pencils that are solved alone: what a stack starts from, and what has not settled."""
    found = []
    plain = sweeps.lowest
    monkeypatch.setattr(sweeps, "lowest", lambda pencil, n: found.append(pencil) or plain(pencil, n))
    return found


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("supports", [(a, b) for i, a in enumerate(SUPPORTS) for b in SUPPORTS[i:]])
@pytest.mark.parametrize(("n_masses", "n_springs"), [(0, 0), (1, 0), (1, 1)])
def test_stepped_beams_settle_in_their_stack(alone, model, supports, n_masses, n_springs):
    beams = many(5, 40, supports, n_sections=3, n_masses=n_masses, n_springs=n_springs)
    MODELS[model].sweep_modes(beams, 5, 49)
    assert len(alone) <= 4


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("supports", [(a, b) for i, a in enumerate(SUPPORTS) for b in SUPPORTS[i:]])
@pytest.mark.parametrize("more", [{}, {"tension": 9.0, "foundation": 170.0}])
def test_no_beam_of_many_modes_is_left_to_be_solved_alone(alone, model, supports, more):
    beams = many(47, 10, supports, n_sections=3, **more)
    found = MODELS[model].sweep_modes(beams, 21, 49)
    assert not alone
    each = [MODELS[model].solve_modes(beam, 21, 49).frequencies_hz for beam in beams]
    assert found == pytest.approx(np.array(each), rel=3e-14)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("most", [1, 20_000])
def test_modes_are_the_same_in_however_many_parts_their_factors_are_taken(monkeypatch, alone, model, most):
    """So large a stack that it does not stay near the processor is taken in parts: here in a few, or each mode by itself."""
    beams = many(61, 10, ("clamped", "free"), n_sections=3, n_masses=1)
    whole, parted = MODELS[model].sweep_modes(beams, 21, 49), band_stack.in_parts
    parts = []
    monkeypatch.setattr(band_stack, "_MOST", most)
    monkeypatch.setattr(stacks, "in_parts", lambda *given: parts.append(len(parted(*given))) or parted(*given))
    assert MODELS[model].sweep_modes(beams, 21, 49) == pytest.approx(whole, rel=3e-14)
    assert max(parts) > 1
    assert not alone


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("n_modes", [3, 5, 8])
def test_no_taut_beam_is_left_alone_however_far_its_modes_are_from_those_of_bending(alone, model, n_modes):
    """Like a string's the lowest modes lie as their square roots do: a grid laid by bending ended before the last."""
    rng = np.random.default_rng(83)
    beams = [beam_of(rng, ("pinned", "clamped"), tension=EI / L**2 * 10.0 ** rng.uniform(-2.0, 4.0)) for _ in range(30)]
    MODELS[model].sweep_modes(beams, n_modes, 49)
    assert not alone


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("n_modes", [1, 8])
def test_stiff_ground_hides_no_mode_from_the_counts(model, n_modes):
    """It lifts all modes to about one value, where two counts tell little: the grid is laid anew until it reaches."""
    rng = np.random.default_rng(83)
    pulls = (10.0 ** rng.uniform((1.0, 1.0), (3.0, 5.0)) for _ in range(40))
    beams = [beam_of(rng, ("pinned", "clamped"), tension=t * EI / L**2, foundation=g * EI / L**4) for t, g in pulls]
    stack, _ = stacked(model, beams, 49)
    with np.errstate(all="ignore"):
        assert np.isfinite(isolated(stack.pencils, stack.rigid_modes, n_modes)).all()


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("supports", [("free", "free"), ("guided", "pinned")])
def test_ground_lifts_every_mode_of_a_plain_beam_and_is_no_reason_to_solve_it_again(alone, model, supports):
    """omega^2 grows by k_f/(rho A), of rigid motions too, which are modes on ground: as many as are asked for or more."""
    rng = np.random.default_rng(31)
    drawn = rng.uniform((0.4, 0.0), (1.9, 7.0), (9, 2))
    beams = [
        Beam(
            length=a * L, bending_stiffness=EI, mass_per_length=LINE, supports=supports, foundation=EI / L**4 * 10.0**g
        )
        for a, g in drawn.tolist()
    ]
    beams[4:4] = [replace(beams[2], foundation=0.0), replace(beams[3], length=1.3 * L)]
    for n_modes in (1, 2, 6):
        alone.clear()
        found = MODELS[model].sweep_modes(beams, n_modes, 23)
        assert len(alone) == 2 - (n_modes <= beams[4].rigid_motions)
        each = [MODELS[model].solve_modes(beam, n_modes, 23).frequencies_hz for beam in beams]
        assert found == pytest.approx(np.array(each), rel=2e-13)


@pytest.mark.parametrize(("model", "most"), [("segment", 10), ("fem", 20)])
def test_ground_gives_a_plain_beam_its_rigid_motions_as_modes_and_no_more(model, most):
    """Nine parts between free ends: all that they have can be asked for, and one more is refused as of one beam."""
    beams = [
        Beam(length=a * L, bending_stiffness=EI, mass_per_length=LINE, supports=("free", "free"), foundation=900.0)
        for a in (1.0, 1.7)
    ]
    module = MODELS[model]
    each = [module.solve_modes(beam, most, 9).frequencies_hz for beam in beams]
    assert module.sweep_modes(beams, most, 9) == pytest.approx(np.array(each), rel=2e-13)
    with pytest.raises(InputError) as alone:
        module.solve_modes(beams[0], most + 1, 9)
    with pytest.raises(InputError) as swept:
        module.sweep_modes(beams, most + 1, 9)
    assert str(swept.value) == f"beams[0]: {alone.value}"
    (stepped,) = many(3, 1, ("free", "free"), n_sections=3)
    with pytest.raises(InputError, match=r"^beams\[0\]: "):  # of several that are refused the first, on ground or not
        module.sweep_modes([stepped, *beams], most + 1, 9)


@pytest.mark.parametrize("model", MODELS)
def test_no_high_mode_of_thick_beams_is_lost(model):
    """They lie closer the higher they are, so that a count tells too short a grid."""
    beams = thick(many(29, 48, ("clamped", "free"), n_sections=3))
    stack, _ = stacked(model, beams, 49, theory="rayleigh")
    with np.errstate(all="ignore"):
        assert np.isfinite(isolated(stack.pencils, stack.rigid_modes, 21)).all()


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(("layout", "most"), [({}, 3.3), ({"n_masses": 2, "n_springs": 1}, 3.9)])
def test_a_grid_tells_nearly_all_modes_where_they_are(monkeypatch, model, layout, most):
    """Of 21 it has 57 points, 2.7 for each; a count at every mode beside them would make it 3.9, of bodies 4.2."""
    stack, _ = stacked(model, many(29, 60, ("clamped", "free"), n_sections=3, **layout), 49)
    counted, plain = [], band_stack.tally
    monkeypatch.setattr("verify.models.isolated.tally", lambda *given: counted.append(given[1].size) or plain(*given))
    with np.errstate(all="ignore"):
        isolated(stack.pencils, stack.rigid_modes, 21)
    assert sum(counted) < most * 21 * 60


@settings(max_examples=12, deadline=None)
@given(st.integers(0, 2**32 - 1), st.tuples(*[st.sampled_from(SUPPORTS)] * 2), st.integers(2, 25), st.integers(43, 60))
def test_shifts_from_counts_stand_at_the_modes_of_any_stepped_beams(seed, supports, n_modes, count):
    """To a hundredth of their distance, told in fourth roots."""
    stack, pencils = stacked("segment", many(seed, 5, supports, n_sections=3), count)
    with np.errstate(all="ignore"):
        shifts = isolated(stack.pencils, stack.rigid_modes, n_modes) ** 0.25
    roots = np.array([lowest(pencil, n_modes + 1).values for pencil in pencils]).T ** 0.25
    steps = np.diff(roots, axis=0, prepend=-roots[:1])
    assert (abs(shifts - roots[:-1]) < 0.01 * np.minimum(steps[1:], steps[:-1])).all()


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("supports", [("guided", "pinned"), ("free", "free"), ("clamped", "free")])
@pytest.mark.parametrize(("n_masses", "n_springs"), [(0, 0), (2, 0), (1, 2)])
@pytest.mark.parametrize(
    ("more", "chosen"),
    [
        ({}, {}),
        ({"tension": 9.0}, {"grading": 2.5}),
        ({"foundation": 170.0}, {"theory": "rayleigh"}),
        ({"tension": 9.0, "foundation": 170.0}, {}),
    ],
)
def test_the_matrices_of_a_stack_are_those_of_each_pencil(model, supports, n_masses, n_springs, more, chosen):
    beams = thick(many(11, 5, supports, n_sections=3, n_masses=n_masses, n_springs=n_springs, **more))
    stack, pencils = stacked(model, beams, 23, **chosen)
    vectors = np.random.default_rng(3).standard_normal((pencils[0].n, 2, 5))
    found = stack.pencils.weighed(vectors)
    diagonals = stack.pencils.diagonals
    for i, pencil in enumerate(pencils):
        stiffness, mass = assembled(pencil), pencil.mass_matrix()
        wanted = mass @ vectors[..., i]
        assert found[..., i] == pytest.approx(wanted, rel=0, abs=1e-12 * abs(wanted).max())
        for diagonal, matrix in zip(diagonals, (stiffness, mass), strict=True):
            assert diagonal[:, i] == pytest.approx(np.diagonal(matrix), rel=1e-11)
    assert_factors_of_each(stack.pencils, pencils, vectors)
    energies = (stack.springs[:, None] * stack.strain(vectors) ** 2).sum(axis=0)
    each = [pencil.stiffness @ pencil.strain(vectors[..., i]) ** 2 for i, pencil in enumerate(pencils)]
    assert energies == pytest.approx(np.array(each).T, rel=1e-12)
    forces = stack.springs[:, None] * stack.strain(vectors)
    found = stack.loads(forces)
    for i, pencil in enumerate(pencils):
        wanted = assembled(pencil) @ vectors[..., i]
        assert found[..., i] == pytest.approx(wanted, rel=0, abs=1e-12 * abs(wanted).max())
    if stack.masses:
        each = [pencil.masses(vectors[..., i]) for i, pencil in enumerate(pencils)]
        assert stack.masses(vectors) == pytest.approx(np.array(each).T, rel=1e-12)


def assert_factors_of_each(stacked_pencils, pencils, loads):
    """Solutions, energies, counts, determinants and growth of K - shift M, at shifts among its eigenvalues."""
    values = np.array([lowest(pencil, 9).values for pencil in pencils]).T
    shifts = np.array([-0.1 * values[8], 0.4 * values[2] + 0.6 * values[3], 0.3 * values[6] + 0.7 * values[7]])
    factors = band_stack.factorised(stacked_pencils, shifts)
    every = np.repeat(loads[:, :1], 3, axis=1).reshape(len(loads), 1, -1)
    solved, energies = factors.solve(every).reshape(len(loads), 3, -1), factors.energy(every).reshape(3, -1)
    below, logs, grown = (each.reshape(-1, 3, len(pencils)) for each in (factors.below, factors.logs, factors.grown))
    for i, pencil in enumerate(pencils):
        for k, rigid in enumerate(shifts[:, i]):
            matrix = assembled(pencil) - rigid * pencil.mass_matrix()
            wanted = np.linalg.solve(matrix, loads[:, 0, i])
            assert solved[:, k, i] == pytest.approx(wanted, rel=0, abs=1e-7 * abs(wanted).max())
            assert energies[k, i] == pytest.approx(loads[:, 0, i] @ wanted, rel=1e-7)
            assert below[0, k, i] == (np.linalg.eigvalsh(matrix) < 0.0).sum()
            assert logs[0, k, i] == pytest.approx(np.linalg.slogdet(matrix)[1], rel=1e-7, abs=1e-7)
            assert (
                grown[: len(loads), k, i] >= (1.0 - 1e-9) * abs(diagonal_without(stacked_pencils, shifts, k, i))
            ).all()


def diagonal_without(pencils, shifts, k, i):
    """Of the bands alone, of a shift and a beam."""
    return pencils.stiffness[:, 0, i] - shifts[k, i] * pencils.mass[:, 0, i]


def assembled(pencil):
    strain = pencil.strain(np.eye(pencil.n))
    return strain.T @ (pencil.stiffness[:, None] * strain)


def told(stack, pencils, modes, top=None):
    """What `judged` makes of some exact modes, counted from 1, of each beam; `top` between the last and the next."""
    pairs = [lowest(pencil, max(modes) + 1) for pencil in pencils]
    vectors = np.array([pair.vectors[:, [mode - 1 for mode in modes]] for pair in pairs])
    between = [0.5 * (pair.values[max(modes) - 1] + pair.values[max(modes)]) for pair in pairs]
    top = np.array(between) if top is None else top
    return judged_of(stack, np.moveaxis(vectors, 0, -1), top)


def judged_of(stack, vectors, top):
    return judged(stack, vectors, stack.pencils.weighed(vectors), top)


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("supports", [("clamped", "pinned"), ("free", "free")])
def test_a_mode_that_was_missed_is_found(model, supports):
    beams = many(7, 9, supports, n_sections=3, n_masses=1)
    stack, pencils = stacked(model, beams, 31)
    values, settled = told(stack, pencils, [1, 2, 3, 4])
    assert settled.all()
    assert values == pytest.approx(np.array([lowest(pencil, 4).values for pencil in pencils]).T, rel=1e-12)
    for missed in ([2, 3, 4], [1, 3, 4], [1, 2, 4]):
        assert not told(stack, pencils, missed)[1].any()
    assert not told(stack, pencils, [1, 2, 2])[1].any()


@pytest.mark.parametrize("model", MODELS)
def test_a_vector_that_is_not_home_does_not_settle(model):
    beams = many(13, 9, n_sections=2)
    stack, pencils = stacked(model, beams, 31)
    pairs = [lowest(pencil, 5) for pencil in pencils]
    vectors = np.moveaxis(np.array([pair.vectors for pair in pairs]), 0, -1)
    top = np.array([0.5 * (pair.values[2] + pair.values[3]) for pair in pairs])
    for share, home in ((0.0, True), (1e-5, False)):
        mixed = vectors[:, :3].copy()
        mixed[:, 1] += share * vectors[:, 4]
        assert (judged_of(stack, mixed, top)[1] == home).all()


@pytest.mark.parametrize("model", MODELS)
def test_a_shift_that_stands_at_another_mode_is_found_out(monkeypatch, model):
    """Two of them lead to one mode, and none to the third."""
    beams = many(17, 9, ("pinned", "free"), n_sections=2)
    stack, pencils = stacked(model, beams, 31)
    values, settled = lowest_of_each(stack, 4)
    assert settled.all()
    assert values == pytest.approx(np.array([lowest(pencil, 4).values for pencil in pencils]).T, rel=1e-12)
    true = isolated

    def astray(*given):
        shifts = true(*given)
        shifts[2, ::2] = 1.001 * shifts[1, ::2]
        return shifts

    monkeypatch.setattr(stacks, "isolated", astray)
    assert (lowest_of_each(stack, 4)[1] == ([False, True] * 5)[:9]).all()


@pytest.mark.parametrize("model", MODELS)
def test_modes_that_lie_close_together_settle(model):
    """Two halves of a beam that a heavy mass parts, one a little longer: pairs within 2 % of each other."""
    half = LINE * L
    beams = [
        Beam(
            length=L,
            bending_stiffness=EI,
            mass_per_length=LINE,
            supports=("clamped", "clamped"),
            mass=(PointMass(position=(0.5 + 0.001 * i) * L, mass=9.0 * half, rotary_inertia=0.07 * half * L**2),),
        )
        for i in range(1, 10)
    ]
    stack, pencils = stacked(model, beams, 44)
    values, settled = lowest_of_each(stack, 12)
    each = np.array([lowest(pencil, 12).values for pencil in pencils]).T
    assert (np.diff(each, axis=0) / each[1:]).min() < 0.02
    assert settled.sum() >= 7
    assert values[:, settled] == pytest.approx(each[:, settled], rel=1e-12)


def test_a_beam_whose_parts_drown_each_other_takes_no_other_with_it():
    """A mass so near a step that its element drowns the rest of K: of 64 such beams 2."""
    beams = many(29, 64, ("clamped", "free"), n_sections=3, n_masses=1)
    stack, pencils = stacked("fem", beams, 49)
    values, settled = lowest_of_each(stack, 20)
    assert 58 <= settled.sum() < 64
    each = np.array([lowest(pencil, 20).values for pencil in pencils]).T
    assert values[:, settled] == pytest.approx(each[:, settled], rel=1e-12)


@pytest.mark.parametrize("model", MODELS)
def test_a_beam_of_unlike_parts_is_solved_alone(alone, model):
    """Its K as a matrix has lost what is soft; neither does it keep the others from settling."""
    thick = Section(length=0.2, bending_stiffness=1e9 * EI, mass_per_length=LINE)
    beams = many(19, 12, ("free", "clamped"), n_sections=2)
    beams[3] = replace(beams[3], length=0.7, section=(thick, replace(thick, length=0.5, bending_stiffness=EI)))
    module = MODELS[model]
    found = module.sweep_modes(beams, 4, 30)
    assert len(alone) == 1
    each = np.array([module.solve_modes(beam, 4, 30).frequencies_hz for beam in beams])
    assert found == pytest.approx(each, rel=1e-12)


def in_fifty_digits(chain, near):
    """The eigenvalue of a clamped-pinned chain next to `near`: its matrices from the links' energies, in 50 digits."""
    with mp.workdps(50):
        lengths, masses, inertias, compliances = (
            [mp.mpf(float(value)) for value in values]
            for values in (chain.lengths, chain.masses, chain.inertias, chain.compliances)
        )
        n = len(lengths)
        stiffness, mass, turns = mp.zeros(n - 1), mp.zeros(n - 1), mp.zeros(n, n - 1)
        for link in range(n):
            for joint, sign in ((link, -1), (link + 1, 1)):
                if 0 < joint < n:
                    turns[link, joint - 1] = sign / lengths[link]
        for link in range(n):
            middle = lengths[link] * turns[link, :] / 2  # and the joint before it
            if link > 0:
                middle[link - 1] += 1
            mass += masses[link] * (middle.T * middle) + inertias[link] * (turns[link, :].T * turns[link, :])
        for joint in range(n):
            angle = turns[joint, :] - (turns[joint - 1, :] if joint else 0 * turns[0, :])
            stiffness += angle.T * angle / compliances[joint]
        vector, shift = mp.matrix([mp.mpf(i + 1) for i in range(n - 1)]), mp.mpf(near) * (1 + mp.mpf(10) ** -7)
        for _ in range(4):
            vector = mp.lu_solve(stiffness - shift * mass, mass * vector)
            vector /= mp.norm(vector)
        return float((vector.T * stiffness * vector)[0] / (vector.T * mass * vector)[0])


def test_values_of_strong_steps_are_those_in_fifty_digits():
    """EI that differs ten-thousandfold, where the matrix of K alone would leave 1e-11."""
    rng = np.random.default_rng(31)
    beams = []
    for beam in many(31, 9, n_sections=2):
        pieces = (replace(piece, bending_stiffness=EI * float(10.0 ** rng.uniform(-2, 2))) for piece in beam.section)
        beams.append(replace(beam, section=tuple(pieces)))
    stack, _ = stacked("segment", beams, 31)
    values, settled = lowest_of_each(stack, 2)
    assert settled.sum() >= 6
    for i in np.flatnonzero(settled)[::3]:
        wanted = in_fifty_digits(build_chain(beams[i], 31), values[0, i])
        assert values[0, i] == pytest.approx(wanted, rel=1e-13)


@pytest.mark.parametrize("model", MODELS)
def test_beams_of_several_layouts_come_back_in_their_order(model):
    kinds = [many(seed, 10, n_sections=2 + seed % 3, n_masses=seed % 2) for seed in range(4)]
    beams = [beam for row in zip(*kinds, strict=True) for beam in row]
    beams += [replace(beams[0], supports=("free", "pinned")), replace(beams[1], section=()), beams[0]]
    module = MODELS[model]
    each = np.array([module.solve_modes(beam, 3, 27).frequencies_hz for beam in beams])
    assert module.sweep_modes(beams, 3, 27) == pytest.approx(each, rel=1e-12)


@pytest.mark.skipif(sys.platform != "linux", reason="work is shared where the system forks safely")
@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize("theory", ["euler-bernoulli", "timoshenko"])
def test_several_cores_give_every_digit_that_one_gives(monkeypatch, model, theory):
    """In stacks, and of beams that are taken one by one."""
    beams = [replace(beam, shear_stiffness=2e3) for beam in thick(many(53, 24, n_sections=1, n_masses=1))]
    beams = [replace(b, section=(), rotary_inertia=3e-4, mass=()) for b in beams[:3]] + beams
    found, began, plain = [], [], cores.start
    monkeypatch.setattr(cores, "start", lambda *given: began.append(1) or plain(*given))
    for name in ("MODES_WORTH", "UNKNOWNS_WORTH"):
        monkeypatch.setattr(sweeps, name, 0)
    monkeypatch.setattr(sweeps, "MODES_TOGETHER", 40)
    for n_jobs in (1, 2, 3):
        monkeypatch.setenv("VERIFY_JOBS", str(n_jobs))
        found.append(MODELS[model].sweep_modes(beams, 5, 30, theory=theory))
        assert bool(began) == (n_jobs > 1)
    assert np.array_equal(found[0], found[1])
    assert np.array_equal(found[0], found[2])


@pytest.mark.parametrize("model", MODELS)
def test_a_beam_that_is_refused_among_many_is_named_by_its_index(model):
    module, beams = MODELS[model], many(23, 12, n_sections=3)
    with pytest.raises(InputError, match=r"^beams\[0\]: n_modes = 90"):
        module.sweep_modes(beams, 90, 40)
    lengths = [beams[5].length / 50] * 50
    beams[5] = replace(beams[5], section=tuple(Section(length=n, bending_stiffness=EI) for n in lengths))
    beams[8] = replace(beams[8], tension=-1e6)
    with pytest.raises(InputError, match=r"^beams\[5\]: count = 40"):
        module.sweep_modes(beams, 3, 40)
    beams[5] = beams[0]
    with pytest.raises(InputError, match=r"^beams\[8\]: .*tension"):
        module.sweep_modes(beams, 3, 40)


@settings(max_examples=60, deadline=None)
@given(st.integers(1, 12), st.integers(1, 4), st.integers(0, 2**32 - 1))
def test_bands_are_their_matrices(n, width, seed):
    """Products, solutions and counts, of three pencils at once."""
    rng = np.random.default_rng(seed)
    shapes = rng.standard_normal((3, n, n)) + 0.0
    near = abs(np.subtract.outer(np.arange(n), np.arange(n))) < width
    stiffness, mass = (near * (one + np.swapaxes(one, 1, 2)) for one in (shapes, 0.1 * shapes[::-1]))
    mass = mass + np.eye(n) * (1.0 + abs(mass).sum(axis=2).max())
    bands, weights = of_matrices(stiffness, width), of_matrices(mass, width)
    pencils = band_stack.banded(bands, weights)
    vectors, shift = rng.standard_normal((n, 2, 3)), rng.standard_normal(3)
    wanted = np.einsum("cij,jkc->ikc", stiffness, vectors)
    assert band_stack.product(bands, vectors) == pytest.approx(wanted, abs=1e-12)
    whole = mass + 0.1 * stiffness
    found = band_stack.factorised(band_stack.banded(of_matrices(whole, width), weights), 0.0 * shift[None]).solve(
        vectors
    )
    definite = np.linalg.eigvalsh(whole)[:, 0] > 1e-3
    back = np.einsum("cij,jkc->ikc", whole, found)
    assert back[..., definite] == pytest.approx(vectors[..., definite], abs=1e-7)
    factors = band_stack.factorised(pencils, shift[None])
    count, grown = factors.below, factors.grown
    lower = np.linalg.inv(np.linalg.cholesky(mass))
    values = np.linalg.eigvalsh(lower @ stiffness @ np.swapaxes(lower, 1, 2))
    told, logs = band_stack.tally(pencils, np.array([shift, 0.7 - shift]))
    assert (told[0] == count).all()
    wanted = np.linalg.slogdet(stiffness - shift[:, None, None] * mass)[1]
    assert logs[0, grown.max(axis=0) < 1e3] == pytest.approx(wanted[grown.max(axis=0) < 1e3], abs=1e-9)
    sure = abs(values - shift[:, None]).min(axis=1) > 1e-13 * grown.max(axis=0)
    assert (grown >= abs((bands - shift * weights)[:, 0]) - 1e-12 * grown).all()
    assert (count[sure] == (values < shift[:, None]).sum(axis=1)[sure]).all()


def of_matrices(matrices, width):
    """Matrices (c, n, n) as bands."""
    bands = np.zeros((matrices.shape[1], width, len(matrices)))
    for above in range(min(width, len(bands))):
        bands[: len(bands) - above, above] = np.diagonal(matrices, above, 1, 2).T
    return bands


def seconds(job):
    start = process_time()
    job()
    return process_time() - start


@pytest.mark.parametrize("model", MODELS)
@pytest.mark.parametrize(
    ("layout", "chosen", "n_modes", "least"),
    [
        ({}, {}, 5, 4.0),
        ({"n_masses": 1}, {}, 5, 4.0),
        ({"tension": 9.0}, {}, 5, 4.0),
        ({"foundation": 170.0}, {"grading": 2.0}, 5, 4.0),
        ({}, {"theory": "rayleigh"}, 5, 4.0),
        ({}, {}, 20, 3.5),
        ({}, {"theory": "rayleigh"}, 20, 3.5),
        ({"n_masses": 1}, {}, 20, 4.5),
        ({"n_masses": 2, "n_springs": 1}, {}, 20, 4.5),
    ],
)
def test_many_stepped_beams_take_a_fraction_of_a_loops_time(model, layout, chosen, n_modes, least):
    """Ten to thirty times faster where nothing else runs, of 20 modes seven to twenty; about half of it is asked for."""
    beams = thick(many(29, 160, ("clamped", "free"), n_sections=3, **layout))
    module, some, ratios = MODELS[model], beams[:16], []
    module.sweep_modes(beams, n_modes, 49, **chosen)
    for _ in range(4):
        loop = seconds(lambda: [module.solve_modes(beam, n_modes, 49, **chosen) for beam in some]) / len(some)
        ratios.append((loop, seconds(lambda: module.sweep_modes(beams, n_modes, 49, **chosen)) / len(beams)))
    loops, swept = zip(*ratios, strict=True)
    assert min(loops) > least * min(swept)


@pytest.mark.parametrize(("wider", "alike"), [(0.98, True), (1.02, False)])
def test_parts_are_unlike_by_how_fast_they_are_and_not_by_how_stiff_or_heavy(wider, alike):
    """Of three beams: one of equal weights, one of equal stiffness, one whose parts are a million times each other."""
    far = wider * stacks._UNLIKE
    stiffness = np.array([[7.0, 7.0, 7.0], [7.0 * far, 7.0, 7e6 * far], [90.0, 7.0, 7e3]])
    mass = np.array([[0.3, 0.3, 0.3], [0.3, 0.3 / far, 0.3e6], [0.3, 0.3, 0.03]])
    given = SimpleNamespace(pencils=SimpleNamespace(diagonals=(stiffness, mass)))
    assert stacks._alike(given).tolist() == [alike] * 3
