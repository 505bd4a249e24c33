"""Nothing is missed and nothing counted twice, whatever stands on the beam."""

import numpy as np
import pytest
from exact_reference import a_root_lies_within
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.elements import linear as elements
from verify.errors import InputError
from verify.exact import roots
from verify.exact.buckling import buckling_load
from verify.exact.lineup import line_up
from verify.exact.modes import exact_frequency_hz, solve_modes
from verify.exact.roots import modes_below
from verify.options import SUPPORTS, THEORIES
from verify.section import Section

LENGTH = 0.83
WHOLE = Beam(length=LENGTH, width=0.02, thickness=0.03, youngs_modulus=70e9, density=2700.0)
UNIT = WHOLE.bending_stiffness / LENGTH**3
MASS = WHOLE.mass_per_length * LENGTH

powers = st.floats(-2.0, 3.0)
within = st.floats(0.05, 0.95)
free_ends = st.sampled_from([("free", "free"), ("clamped", "free"), ("pinned", "free"), ("guided", "free")])


@st.composite
def beams(draw):
    """Sections, a mass and a spring within and at a free end, tension, compression or a foundation."""
    cuts = sorted({round(c, 3) for c in draw(st.lists(within, max_size=2))})
    ends = [0.0, *cuts, 1.0]
    parts = np.diff(ends)
    sections = tuple(
        Section(
            length=LENGTH * part,
            thickness=draw(st.floats(0.012, 0.05)),
            density=draw(st.floats(1e3, 9e3)),
        )
        for part in parts
    )
    supports = draw(free_ends | st.tuples(st.sampled_from(SUPPORTS), st.sampled_from(SUPPORTS)))
    at = LENGTH if supports[1] == "free" and draw(st.booleans()) else LENGTH * draw(within)
    body = PointMass(
        position=at, mass=MASS * 10 ** draw(powers), rotary_inertia=MASS * LENGTH**2 * 10 ** (draw(powers) - 3)
    )
    held = LENGTH * draw(within)
    spring = PointSpring(
        position=at if abs(held - at) < 1e-6 * LENGTH else held,  # nearer than that is the same place to a beam
        stiffness=UNIT * 10 ** draw(powers),
        rotational=UNIT * LENGTH**2 * 10 ** draw(powers),
    )
    beam = replace(
        WHOLE,
        supports=supports,
        section=sections if len(sections) > 1 else (),
        mass=(body,) if draw(st.booleans()) else (),
        spring=(spring,) if draw(st.booleans()) else (),
        foundation=draw(st.sampled_from([0.0, 1.0, 1e3])) * UNIT / LENGTH,
    )
    theory = draw(st.sampled_from(THEORIES))
    if theory == "euler-bernoulli":
        beam = replace(beam, tension=draw(st.sampled_from([0.0, 3.0, 300.0])) * UNIT * LENGTH**2)
        if draw(st.booleans()) and (load := buckling_load(beam)):
            beam = replace(beam, tension=-draw(st.floats(0.1, 0.95)) * load)
    return beam, theory


@settings(max_examples=20, deadline=None)
@given(one=beams())
def test_every_frequency_has_its_own_number(one):
    """Each rises the count by one, no interval between neighbours has another, and the figure is a root to 2e-13."""
    beam, theory = one
    found = solve_modes(beam, 9, theory).frequencies_hz
    assert (np.diff(found) > 0.0).all() or beam.foundation
    for mode, hertz in enumerate(found, 1):
        y = np.sqrt(2 * np.pi * hertz / beam.wave_constant) * beam.length
        below, above = (modes_below(beam, y * (1 + side * 1e-9), theory) - beam.rigid_motions for side in (-1, 1))
        assert below < mode <= above
    if np.diff(found[:7])[4] > 1e-6 * found[5]:
        assert a_root_lies_within(beam, theory, found[4], 2e-13, 90)


@settings(max_examples=15, deadline=None)
@given(one=beams())
def test_the_number_of_a_frequency_is_that_of_the_elements(one):
    """Cubic elements lie above, by their own error: 5e-5 at most in 150 beams. Polynomials by Ritz lose low modes.

    A beam that is pulled at hard bends within sqrt(EI/T) of its ends and bodies alone, which takes shorter elements.
    """
    beam, theory = one
    bends = min(piece.bending_stiffness for piece in beam.pieces)
    taut = beam.tension > 0.0 and np.sqrt(bends / beam.tension) < beam.length / 24
    others = elements.solve_modes(beam, 5, 144 if taut else 48, theory=theory).frequencies_hz
    above = others / solve_modes(beam, 5, theory).frequencies_hz - 1
    assert above.min() > -1e-8
    assert above.max() < 3e-4


@settings(max_examples=25, deadline=None)
@given(one=beams(), mode=st.integers(1, 25))
def test_a_beam_seen_from_the_other_side_has_the_same_frequencies(one, mode):
    beam, theory = one
    here, there = (exact_frequency_hz(b, mode, theory) for b in (beam, beam.mirrored()))
    assert abs(here / there - 1) < 5e-13


@settings(max_examples=25, deadline=None)
@given(one=beams(), mode=st.integers(1, 12), more=st.floats(0.1, 10.0))
def test_a_spring_raises_and_a_mass_lowers_every_frequency(one, mode, more):
    """But never past the neighbour's, Rayleigh's theorem of one constraint."""
    beam, theory = one
    if beam.tension < 0.0:
        return
    spring = PointSpring(position=0.37 * LENGTH, stiffness=more * 100 * UNIT)
    body = PointMass(position=0.37 * LENGTH, mass=more * MASS)
    rigid = beam.rigid_motions
    plain = exact_frequency_hz(beam, mode, theory) * (1 + 1e-12)
    stiffer = replace(beam, spring=(*beam.spring, spring))
    heavier = replace(beam, mass=(*beam.mass, body))
    raised = exact_frequency_hz(stiffer, mode + rigid - stiffer.rigid_motions, theory)
    assert raised >= plain * (1 - 2e-12)
    assert raised <= exact_frequency_hz(beam, mode + 1, theory) * (1 + 1e-12)
    assert exact_frequency_hz(heavier, mode, theory) <= plain


def test_a_root_is_found_by_its_minor_as_soon_as_it_is_alone_whichever_it_is():
    """Of 52 bits of a root halving asks for each; a minor that changes its sign gives a dozen of them at a time."""
    beam = Beam(
        length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free")
    )
    say = roots.trials(line_up(beam, "euler-bernoulli"))
    for wanted, known in ((1, 1.875104068711961), (3, 7.854757438237613), (11, 10.5 * np.pi)):
        asked = []
        root = roots.nth_root(lambda value, asked=asked: asked.append(value) or say(value), wanted)
        assert abs(root - known) < 1e-12 * known
        assert len(set(asked)) < 36


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("ends", [("clamped", "free"), ("pinned", "guided")])
def test_the_largest_trial_is_counted_by_the_phase_of_its_waves_and_a_larger_one_refused(ends, theory):
    """Over pi: that of bending waves; far above the cut-off those of shear and of turning, each by its own speed."""
    sections = Section(length=0.3, thickness=0.012), Section(length=0.53, thickness=0.05, density=4100.0)
    beam = replace(WHOLE, supports=ends, section=sections)
    largest = roots.LARGEST_TRIAL
    omega = largest**2 * beam.wave_constant / LENGTH**2
    turns = 0.0
    for piece in beam.pieces:
        bending = np.sqrt(piece.rotary_inertia / piece.bending_stiffness)
        shear = np.sqrt(piece.mass_per_length / piece.shear_stiffness)
        waves = {
            "euler-bernoulli": np.sqrt(omega * np.sqrt(piece.mass_per_length / piece.bending_stiffness)),
            "rayleigh": omega * bending,
            "timoshenko": omega * (bending + shear),
        }
        turns += waves[theory] * piece.length / np.pi
    assert modes_below(beam, largest, theory) == pytest.approx(turns, rel=1e-11)
    with pytest.raises(InputError, match=r"^beta_length = 2e\+30"):
        modes_below(beam, 2.0 * largest, theory)
