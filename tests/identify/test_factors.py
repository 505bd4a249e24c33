"""What alone makes one factor on all frequencies of a beam is named by `compare`, and nothing else is."""

import re

import numpy as np
import pytest
from msgspec.structs import replace
from states_reference import frequency_near

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.exact.modes import solve_modes
from verify.identify.causes_told import made_by
from verify.identify.compare import Asked, compared
from verify.identify.reading import Listed
from verify.scenes.scene import load_scene
from verify.section import Section, Sizes
from verify.segments.linear import solve_modes as chain

FACTOR = 0.964
SIZES = {"width": 0.023, "thickness": 0.0031, "youngs_modulus": 190e9, "density": 7700.0}
STRIP = Beam(length=0.43, supports=("clamped", "free"), **SIZES)
BODY = PointMass(position=0.27, mass=0.05)
DISC = PointMass(position=0.27, rotary_inertia=2e-4)
STAY = PointSpring(position=0.31, stiffness=4e3)
TWIST = PointSpring(position=0.31, rotational=30.0)
STEPS = (Section(length=0.19, thickness=0.0052), Section(length=0.24))
METALS = (Section(length=0.19, youngs_modulus=70e9, density=2700.0), Section(length=0.24, width=0.031))
ROD = Beam(
    length=0.43, shape="round", diameter=0.008, youngs_modulus=190e9, density=7700.0, supports=("clamped", "pinned")
)
PLAIN = Beam(length=0.43, bending_stiffness=11.0, mass_per_length=0.55, supports=("clamped", "free"))
BEAMS = {
    "uniform": (STRIP, {"E", "rho", "the thickness", "the length"}),
    "round": (ROD, {"E", "rho", "the diameter", "the length"}),
    "plain": (PLAIN, {"E", "rho", "the length"}),
    "stepped": (replace(STRIP, section=STEPS), {"E", "rho", "the thickness", "the length"}),
    "of two metals": (replace(STRIP, section=METALS), {"E", "rho", "the thickness", "the length"}),
    "body": (replace(STRIP, mass=(BODY,)), {"E"}),
    "disc": (replace(STRIP, mass=(DISC,)), {"E"}),
    "spring": (replace(STRIP, spring=(STAY,)), {"rho"}),
    "rotational spring": (replace(STRIP, spring=(TWIST,)), {"rho"}),
    "foundation": (replace(STRIP, foundation=2e4), {"rho"}),
    "tension": (replace(STRIP, tension=120.0), {"rho"}),
    "stepped and in tension": (replace(STRIP, section=STEPS, tension=120.0), {"rho"}),
    "stepped with a body": (replace(STRIP, section=STEPS, mass=(BODY,)), {"E"}),
    "body and spring": (replace(STRIP, mass=(BODY,), spring=(STAY,)), set()),
}
"""Beams, and what alone may be off."""
CHANGES = {
    "E": {"youngs_modulus": 2.0, "bending_stiffness": 2.0},
    "rho": {"density": -2.0, "mass_per_length": -2.0},
    "the thickness": {"thickness": 1.0},
    "the diameter": {"diameter": 1.0},
    "the length": {"length": -0.5},
}
"""Fields of a beam and its sections, and in which power of the factor each would be off."""


def changed(beam, powers):
    """A beam with what it and its sections state of some fields times the factor to a power each."""

    def scaled(one):
        stated = {field: Sizes.__dict__[field].__get__(one) for field in powers if field != "length"}
        stated |= {"length": one.length} if "length" in powers else {}
        return {field: value * FACTOR ** powers[field] for field, value in stated.items() if value is not None}

    sections = tuple(replace(section, **scaled(section)) for section in beam.section)
    return replace(beam, section=sections, **scaled(beam))


@pytest.mark.parametrize("name", BEAMS)
def test_only_what_alone_leaves_a_common_factor_is_named(name):
    """By the states along the beam as it is and with one thing changed, 30 digits."""
    beam, expected = BEAMS[name]
    exact = solve_modes(beam, 3).frequencies_hz
    before = [frequency_near(beam, "euler-bernoulli", f) for f in exact[[0, 2]]]
    alone = set()
    for what, powers in CHANGES.items():
        other = changed(beam, powers)
        if other != beam:
            near = solve_modes(other, 3).frequencies_hz[[0, 2]]
            after = [frequency_near(other, "euler-bernoulli", f) for f in near]
            alone |= {what} if np.allclose(np.divide(after, before), FACTOR, rtol=1e-10, atol=0.0) else set()
    assert alone == expected
    words = made_by(FACTOR, beam, "euler-bernoulli")
    assert {what for what in CHANGES if re.search(rf"(^|[ ,]){what} (is )?[-+]", words)} == expected
    assert words.startswith("in all sections alike ") == beam.stepped


def test_sizes_are_not_named_by_theories_that_know_how_thick_a_beam_is():
    assert made_by(FACTOR, STRIP, "timoshenko") == "E is -7.07 % or rho +7.61 %"
    assert made_by(FACTOR, STRIP, "euler-bernoulli") == (
        "E is -7.07 % or rho +7.61 %, or the thickness -3.6 %, or the length +1.85 %"
    )


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("body", ": E is -7.07 %."),
        (
            "body and spring",
            ": neither E nor rho nor a size alone makes one on this beam, with its bodies and springs.",
        ),
    ],
)
def test_a_list_is_told_so(name, words):
    beam = BEAMS[name][0]
    hertz = FACTOR * chain(beam, 6, 24).frequencies_hz
    listed = Listed(frequencies_hz=hertz, numbers=None, rounding=np.full(6, 1e-9), source="list", unit="Hz")
    found = compared(replace(load_scene("steel-cantilever"), beam=beam), Asked(count=24), listed, None, 24)
    assert found.answer.startswith(f"All frequencies have the common factor 0.964{words}")
    assert found.plain()["causes"][0]["words"] in found.told[0].words
