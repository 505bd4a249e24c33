"""The family itself: declared orders are measured ones, matrices are those of the textbook and of the package."""

import numpy as np
import pytest
from other_models import links_without_inertia, lumped_elements, lumped_rod

from verify.beam import Beam
from verify.elements.linear import solve_modes as solve_elements
from verify.identify import matrices
from verify.identify.family import EXACT, Candidate, exact_hz, family, frequencies_hz
from verify.scenes.scene import load_scene
from verify.segments.linear import solve_modes as solve_segments

SUPPORTS = [("pinned", "pinned"), ("clamped", "free"), ("clamped", "pinned"), ("guided", "clamped"), ("free", "free")]
THICK = {"length": 0.61, "width": 0.03, "thickness": 0.02, "youngs_modulus": 113e9, "density": 4470.0}
"""SI."""


def beam_of(supports):
    return Beam(**THICK, supports=supports)


@pytest.mark.parametrize("supports", SUPPORTS, ids="-".join)
def test_links_lumped_rods_and_lumped_elements_are_those_of_the_textbook(supports):
    beam = beam_of(supports)
    rigid, n = beam.rigid_motions, 19
    plain = {"theory": "euler-bernoulli", "wall": "half"}
    if "guided" not in supports:
        ours = matrices.chain(beam, n, 6, mass="joints", **plain)
        assert ours == pytest.approx(lumped_rod(beam, n)[rigid : rigid + 6], rel=1e-7)
    if "guided" not in supports and rigid == 0:
        ours = matrices.chain(beam, n, 6, mass="points", **plain)
        assert ours == pytest.approx(links_without_inertia(beam, n)[:6], rel=1e-7)
    for name, rotary in (("lumped", 0.0), ("lumped-rotary", 1 / 24), ("hrz", 1 / 78)):
        ours = matrices.elements(beam, n, 6, mass=name, theory="euler-bernoulli")
        assert ours == pytest.approx(lumped_elements(beam, n, rotary)[rigid : rigid + 6], rel=1e-7), name


@pytest.mark.parametrize("supports", SUPPORTS, ids="-".join)
@pytest.mark.parametrize("wall", ["half", "gregory"])
def test_links_with_inertia_are_the_packages_own(supports, wall):
    beam = beam_of(supports)
    ours = matrices.chain(beam, 23, 7, wall=wall, mass="links", theory="euler-bernoulli")
    assert ours == pytest.approx(solve_segments(beam, 7, 23, wall=wall).frequencies_hz, rel=1e-12)


@pytest.mark.parametrize("supports", SUPPORTS, ids="-".join)
def test_one_link_has_no_frequencies(supports):
    """Nothing bends: a chain has its springs between two links."""
    chains = [one for one in family(beam_of(supports)) if one.packaged and one.model == "segment"]
    assert len(chains) > 2
    assert {frequencies_hz(one, beam_of(supports), 1, 5).shape for one in chains} == {(0,)}


def test_large_and_small_sizes_are_solved_alike():
    """Beyond 250 unknowns vectors come from Lanczos: the chain's dispersion holds on both sides."""
    beam = beam_of(("pinned", "pinned"))
    for n in (200, 300):
        mu = np.pi * np.arange(1, 6) / n
        s2 = np.sin(mu / 2) ** 2
        expected = 4 * s2 * beam.wave_constant * (n / beam.length) ** 2 / (2 * np.pi)
        assert matrices.chain(beam, n, 5, wall="half", mass="joints", theory="euler-bernoulli") == pytest.approx(
            expected, rel=1e-11
        )


@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free")], ids="-".join)
def test_links_and_lumped_elements_are_dual(supports):
    """Three-moment flexibility and links' inertia are the same matrix, joints' springs and nodes' masses too."""
    beam = beam_of(supports)
    elements = matrices.elements(beam, 21, 8, mass="lumped", theory="euler-bernoulli")
    assert elements == pytest.approx(solve_segments(beam, 8, 21, wall="half").frequencies_hz, rel=1e-11)


def test_a_rod_that_cannot_shear_is_a_chain_of_lumped_joints():
    stiff = beam_of(("clamped", "free"))
    thin = Beam(**(THICK | {"thickness": 2e-4}), supports=("clamped", "free"))
    ratio = thin.wave_constant / stiff.wave_constant
    for wall in ("half", "full", "rigid"):
        rod = matrices.rod(thin, 15, 5, wall=wall)
        chain = matrices.chain(stiff, 15, 5, wall=wall, mass="joints", theory="euler-bernoulli")
        assert rod == pytest.approx(ratio * chain, rel=3e-5), wall


def test_linear_timoshenko_elements_tend_to_timoshenkos_beam_from_above():
    beam = beam_of(("pinned", "pinned"))
    exact = exact_hz(beam, 3, "timoshenko")
    errors = np.array(
        [matrices.elements(beam, n, 3, mass="linear", theory="timoshenko") / exact - 1 for n in (20, 40, 80)]
    )
    assert (errors > 0).all()
    assert np.log2(errors[:-1] / errors[1:]) == pytest.approx(2.0, abs=0.03)


MEASURED = {
    "pinned-pinned": ("pinned", "pinned"),
    "clamped-free": ("clamped", "free"),
    "clamped-pinned": ("clamped", "pinned"),
}


@pytest.mark.parametrize("supports", MEASURED.values(), ids=MEASURED)
def test_every_order_that_is_declared_is_measured(supports):
    """Gregory's and the five-joint weights change the sign of their error on these sizes: at least order 3 is seen."""
    beam = beam_of(supports)
    exact = exact_hz(beam, 2)[-1]
    for one in family(beam):
        if one.theory != "euler-bernoulli" or one.model == EXACT:
            continue
        errors = [abs(frequencies_hz(one, beam, n, 2)[-1] / exact - 1) for n in (40, 80)]
        order = np.log2(errors[0] / errors[1])
        if one.wall in ("gregory", "five-joint") and one.mass == "links":
            assert order > 3.0
        else:
            assert order == pytest.approx(one.order, abs=0.12), one.words


def test_links_with_the_thickness_of_a_box_are_rayleighs():
    """The paper's chain with m h^2/12 added: -0.5209 % at mode 22, against -0.4280 % of thin links."""
    beam = load_scene("paper").beam
    chain = Candidate(model="segment", joints="series", mass="links", theory="rayleigh", order=2)
    assert frequencies_hz(chain, beam, 49, 22)[-1] / exact_hz(beam, 22)[-1] - 1 == pytest.approx(-0.005209, abs=1e-6)


def test_stepped_beams_have_their_members_too():
    beam = load_scene("stepped-beam").beam
    exact = exact_hz(beam, 1)[0]
    solved = solve_elements(beam, 1, 60).frequencies_hz[0]
    assert solved == pytest.approx(exact, rel=1e-6)
    for one in family(beam):
        if one.theory == "euler-bernoulli" and one.sized and one.wall not in ("full", "rigid", "stiff", "welded"):
            off = abs(frequencies_hz(one, beam, 96, 1)[0] / exact - 1)
            assert off < (0.02 if one.joints == "printed" else 2e-3), one.words


def test_no_two_members_are_called_the_same():
    for name in ("paper", "steel-cantilever", "stepped-beam"):
        words = [one.words for one in family(load_scene(name).beam)]
        assert len(words) == len(set(words))
