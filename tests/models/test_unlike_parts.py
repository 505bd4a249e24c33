"""Beams of sections that differ by many orders of magnitude: their modes keep their digits, however they are found."""

import numpy as np
import pytest

from verify import Beam, Section
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.models import eigen
from verify.models.eigen import lowest
from verify.options import SUPPORTS

SEEDS = range(12)


def stepped(seed, decades):
    """Up to five sections whose stiffness differs by so many decades, and whose frequencies are much alike."""
    rng = np.random.default_rng(seed)
    lengths = rng.uniform(0.2, 0.7, int(rng.integers(2, 6)))
    stiff = 3.0 * 10.0 ** rng.uniform(-decades / 2, decades / 2, len(lengths))
    mass = 0.1 * stiff * 10.0 ** rng.uniform(-0.5, 0.5, len(lengths))
    sections = tuple(
        Section(length=float(length), bending_stiffness=float(one), mass_per_length=float(other))
        for length, one, other in zip(lengths, stiff, mass, strict=True)
    )
    supports = (SUPPORTS[seed % len(SUPPORTS)], SUPPORTS[(seed // 2) % len(SUPPORTS)])
    whole = {"length": float(sum(one.length for one in sections)), "bending_stiffness": 3.0, "mass_per_length": 0.3}
    return Beam(section=sections, supports=supports, **whole)


def apart(seed, decades):
    """How far values lie from those of Lanczos on the mixed matrix, which never assembles K."""
    pencil = element_pencil(build_elements(stepped(seed, decades), 60, 1.0))
    found = lowest(pencil, 6)
    vectors, strains = eigen._sparse_vectors(pencil, 6)
    known = eigen._in_order(pencil, vectors, "", strains)
    return abs(found.values / known.values - 1.0).max()


@pytest.mark.parametrize("decades", [1, 4, 8])
def test_values_of_stepped_beams_are_those_that_lanczos_finds(decades):
    assert max(apart(seed, decades) for seed in SEEDS) < 5e-12


def test_what_a_vector_has_of_a_rigid_motion_does_not_lower_its_value(monkeypatch):
    """A light end rocks about a heavy one, next to free: how much of the free motion is in it is the processor's."""
    pencil = element_pencil(build_elements(stepped(6, 8), 60, 1.0))
    dense, exact = eigen._dense_vectors, lowest(pencil, 3).values

    def stirred(*given):
        vectors = dense(*given)
        return vectors + 3e-6 * pencil.rigid @ np.ones((1, vectors.shape[1])) * abs(vectors).max(axis=0)

    monkeypatch.setattr(eigen, "_dense_vectors", stirred)
    assert abs(lowest(pencil, 3).values / exact - 1.0).max() < 1e-14
    monkeypatch.setattr(eigen, "_elastic", lambda pencil, vectors: vectors)
    assert abs(lowest(pencil, 3).values / exact - 1.0).max() > 1e-12


def test_assembled_they_would_not_be(monkeypatch):
    monkeypatch.setattr(eigen, "_is_unlike", lambda stiffness, mass: False)
    monkeypatch.setattr(eigen, "_is_soft_between", lambda pencil: False)
    assert max(apart(seed, 8) for seed in SEEDS) > 1e-11
