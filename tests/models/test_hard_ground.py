"""Beams on ground so hard that all their low modes lie at what it makes of them: each keeps its digits, or none is told.

On ground of 1e16 EI/L^4 what bends a beam is in the last digit of a frequency; rail of a kilometre on ballast has 1e13.
"""

from contextlib import suppress
from math import pi

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given, settings
from hypothesis import strategies as st
from msgspec.structs import replace

from verify import Beam, PointMass, PointSpring, Section, fem_beam, segment_model
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.errors import InputError
from verify.models.eigen import lowest
from verify.models.pencil import restarts
from verify.options import JOINTS, THEORIES, WALLS
from verify.segments.assembly import build_chain, chain_pencil

LENGTH, STIFFNESS, RHO_A = 1.3, 7.0, 0.2
FACES = pytest.mark.parametrize("face", [fem_beam, segment_model], ids=["elements", "segments"])


def bar(ratio, **more):
    """On ground of so many EI/L^4."""
    held = {"length": LENGTH, "bending_stiffness": STIFFNESS, "mass_per_length": RHO_A}
    return Beam(**held, foundation=ratio * STIFFNESS / LENGTH**4, **more)


@FACES
@pytest.mark.parametrize("ratio", [1e4, 1e7, 1e10, 1e13, 1e16])
@pytest.mark.parametrize(
    ("supports", "rigid"), [(("free", "free"), 2), (("guided", "free"), 1), (("pinned", "clamped"), 0)]
)
def test_on_many_parts_every_omega_squared_is_shifted_alike(face, ratio, supports, rigid):
    """Two motions that ground alone holds have one frequency: to Lanczos they may be one."""
    alone = face.solve_modes(bar(0.0, supports=supports), 6 - rigid, 900).frequencies_hz
    found = face.solve_modes(bar(ratio, supports=supports), 6, 900).frequencies_hz
    lifted = ratio * STIFFNESS / LENGTH**4 / RHO_A / (2.0 * pi) ** 2
    assert abs(found / np.sqrt(np.append(np.zeros(rigid), alone**2) + lifted) - 1.0).max() < 1e-12


@FACES
def test_of_few_parts_whose_modes_are_all_alike_as_many_are_told_as_are_asked_for(face, monkeypatch):
    """LAPACK's bisection loses some of such values, on some processors: what it does there is done here."""
    asked, whole = [], scipy.linalg.eigh

    def losing(matrix, **chosen):
        values, vectors = whole(matrix, **chosen)
        asked.append(chosen)
        return (values[:1], vectors[:, :1]) if chosen.get("driver") == "evr" else (values, vectors)

    monkeypatch.setattr(scipy.linalg, "eigh", losing)
    found = face.solve_modes(bar(1e24), 5, 40).frequencies_hz
    lifted = np.sqrt(1e24 * STIFFNESS / LENGTH**4 / RHO_A) / (2.0 * pi)
    assert found == pytest.approx(5 * [lifted], rel=1e-12)
    soft = face.solve_modes(bar(40.0), 5, 40).frequencies_hz
    monkeypatch.undo()
    assert len(asked) >= 2
    assert soft == pytest.approx(face.solve_modes(bar(40.0), 5, 40).frequencies_hz, rel=1e-13)


@FACES
@pytest.mark.parametrize("more", [{"mass": (PointMass(position=0.4, mass=0.1),)}, {"tension": -0.3}])
def test_what_cannot_be_told_apart_is_refused_before_long(face, more):
    """Of 3000 elements a search had not ended after nine minutes."""
    with pytest.raises(InputError, match="too close together to be told apart on so many parts"):
        face.solve_modes(bar(1e15, **more), 5, 1500)


def test_a_search_begins_anew_the_less_often_the_more_it_costs():
    assert [restarts(n) for n in (300, 10_000, 20_000, 45_000, 400_000, 2_000_000)] == [100, 50, 25, 11, 10, 10]


@settings(max_examples=40, deadline=None)
@given(
    ratio=st.floats(1e3, 1e8),
    steps=st.lists(st.tuples(st.floats(0.2, 1.0), st.floats(0.3, 3.0), st.floats(0.3, 3.0)), min_size=1, max_size=3),
    supports=st.sampled_from([("free", "free"), ("clamped", "pinned"), ("guided", "free")]),
    tension=st.sampled_from([0.0, 40.0]),
    spring=st.booleans(),
    theory=st.sampled_from(THEORIES),
    wall=st.sampled_from(WALLS),
    joints=st.sampled_from(JOINTS),
)
def test_ground_lifts_no_mode_less_than_is_said(ratio, steps, supports, tension, spring, theory, wall, joints):
    long = LENGTH / sum(share for share, _, _ in steps)
    sections = tuple(
        Section(length=share * long, width=0.02 * wide, thickness=0.004 * thick) for share, wide, thick in steps
    )
    beam = Beam(
        length=LENGTH,
        width=0.02,
        thickness=0.004,
        youngs_modulus=7e10,
        density=2700.0,
        supports=supports,
        section=sections,
        tension=tension * (theory == "euler-bernoulli"),
        foundation=ratio * 7e10 * 0.02 * 0.004**3 / 12.0 / LENGTH**4,
        spring=(PointSpring(position=0.3, stiffness=500.0),) * spring,
    )
    pencils = [element_pencil(build_elements(beam, 20, theory=theory))]
    with suppress(InputError):
        pencils.append(chain_pencil(build_chain(beam, 30, wall=wall, joints=joints, theory=theory)))
    for pencil in pencils:
        assert 0.0 <= pencil.below < lowest(replace(pencil, below=0.0), 1).values[0]
