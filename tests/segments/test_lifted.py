"""What hard ground lifts every mode of a chain above, in the units of its pencil."""

import pytest
from msgspec.structs import replace
from scipy.linalg import eigh

from verify.attached import PointMass
from verify.beam import Beam
from verify.section import Section
from verify.segments.assembly import build_chain, chain_pencil

STRIP = Beam(
    length=0.61,
    width=0.023,
    thickness=0.0021,
    youngs_modulus=113e9,
    density=4470.0,
    supports=("free", "free"),
    section=(Section(length=0.2), Section(length=0.17, density=9100.0), Section(length=0.24, thickness=0.0034)),
)


@pytest.mark.parametrize("ground", [1e9, 1e12])
@pytest.mark.parametrize("count", [9, 23])
def test_no_mode_lies_below_what_ground_lifts_and_the_lowest_just_above(ground, count):
    """The heaviest stretch moves slowest, at k_f / (rho A), whatever the links' lengths."""
    chain = build_chain(replace(STRIP, foundation=ground), count)
    pencil = chain_pencil(chain)
    strains, mass = pencil.strain_matrix().toarray(), pencil.mass_matrix()
    lowest = eigh(strains.T @ (pencil.stiffness[:, None] * strains), mass, eigvals_only=True)[0]
    assert pencil.below == chain.lifted
    assert 0.97 * lowest < chain.lifted <= lowest * (1.0 + 1e-12)


def test_a_body_or_a_push_may_take_a_mode_below_what_ground_lifts():
    for change in ({"mass": (PointMass(position=0.3, mass=0.2),)}, {"tension": -3.0}):
        assert build_chain(replace(STRIP, foundation=1e9, **change), 11).lifted == 0.0
