"""A beam's derived values, and what it refuses."""

import math

import numpy as np
import pytest
from msgspec.structs import replace

from verify.errors import InputError
from verify.problem.beam import Beam, check_features, features, rigid_lines
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring

SIZES = {"length": 0.73, "width": 0.031, "thickness": 0.0023, "youngs_modulus": 113e9, "density": 4470.0}


def plain(**more):
    return Beam(**{"length": 0.71, "bending_stiffness": 2.3, "mass_per_length": 0.19} | more)


@pytest.mark.parametrize(
    ("shape", "sizes", "area", "moment", "fibre"),
    [
        ("rectangle", {"width": 0.031, "thickness": 0.0023}, 7.13e-5, 0.031 * 0.0023**3 / 12, 0.00115),
        ("round", {"diameter": 0.012}, math.pi * 36e-6, math.pi * 0.012**4 / 64, 0.006),
        (
            "tube",
            {"diameter": 0.025, "wall_thickness": 0.0015},
            math.pi * (0.0125**2 - 0.011**2),
            math.pi * (0.025**4 - 0.022**4) / 64,
            0.0125,
        ),
    ],
)
def test_a_section_is_known_by_its_shape(shape, sizes, area, moment, fibre):
    beam = Beam(length=0.71, youngs_modulus=113e9, density=4470.0, shape=shape, **sizes)
    assert beam.bending_stiffness == pytest.approx(113e9 * moment, rel=1e-13)
    assert beam.mass_per_length == pytest.approx(4470 * area, rel=1e-13)
    assert beam.base_section.rotary_inertia == pytest.approx(4470 * moment, rel=1e-13)
    assert beam.base_section.axial_stiffness == pytest.approx(113e9 * area, rel=1e-13)
    assert beam.surface_distance == pytest.approx(fibre, rel=1e-15)
    assert beam.wave_constant == pytest.approx(math.sqrt(113e9 * moment / (4470 * area)), rel=1e-13)


def kappa(beam):
    """The shear coefficient, from kappa G A."""
    shear_modulus = beam.youngs_modulus / (2 * (1 + beam.poissons_ratio))
    return beam.base_section.shear_stiffness / (shear_modulus * beam.base_section.area)


def test_shear_coefficients_are_those_of_cowper():
    """J. Appl. Mech. 33 (1966): 6 (1 + nu)/(7 + 6 nu) of a circle, 2 (1 + nu)/(4 + 3 nu) of a thin tube.

    Of a hollow circle 6 (1 + nu)(1 + m^2)^2 / ((7 + 6 nu)(1 + m^2)^2 + (20 + 12 nu) m^2), of m = 0.6 by hand.
    """
    round_bar = {"length": 1.0, "youngs_modulus": 70e9, "density": 2700.0, "diameter": 0.02, "poissons_ratio": 0.27}
    assert kappa(Beam(shape="round", **round_bar)) == pytest.approx(6 * 1.27 / (7 + 6 * 0.27), rel=1e-14)
    thin = Beam(shape="tube", wall_thickness=1e-7, **round_bar)
    assert kappa(thin) == pytest.approx(2 * 1.27 / (4 + 3 * 0.27), rel=1e-4)
    thick = Beam(shape="tube", wall_thickness=0.004, **round_bar | {"poissons_ratio": 0.3})
    assert kappa(thick) == pytest.approx(14.42688 / 24.77248, rel=1e-12)
    assert kappa(Beam(shape="round", shear_coefficient=0.81, **round_bar)) == pytest.approx(0.81, rel=1e-14)


def test_a_plain_section_needs_no_sizes_and_says_what_it_does_not_know():
    beam = plain(extreme_fibre=0.004)
    assert (beam.bending_stiffness, beam.mass_per_length, beam.surface_distance) == (2.3, 0.19, 0.004)
    assert replace(beam, bending_stiffness=2.9).wave_constant == pytest.approx(math.sqrt(2.9 / 0.19), rel=1e-15)
    assert beam.base_section.area is None
    with pytest.raises(InputError, match=r"beam\.extreme_fibre is missing"):
        _ = plain().surface_distance
    with pytest.raises(InputError, match=r"has no axial stiffness"):
        _ = beam.base_section.axial_stiffness


def test_a_section_takes_from_its_beam_what_it_does_not_say():
    steps = (Section(length=0.3), Section(length=0.43, thickness=0.0031))
    beam = Beam(**SIZES, section=steps)
    assert [piece.second_moment for piece in beam.pieces] == pytest.approx([0.031 * h**3 / 12 for h in (23e-4, 31e-4)])
    glued = Beam(**SIZES, section=(Section(length=0.3, bending_stiffness=9.1), Section(length=0.43)))
    assert glued.pieces[0].bending_stiffness == 9.1
    assert glued.pieces[0].mass_per_length == glued.mass_per_length
    assert glued.pieces[0].youngs_modulus is None
    shaft = Section(length=0.3, shape="round", diameter=0.009)
    assert Beam(**SIZES, section=(shaft, Section(length=0.43))).pieces[0].area == pytest.approx(math.pi * 0.0045**2)
    with pytest.raises(InputError, match=r"beam\.section\[1\]\.width is missing: a rectangle needs width"):
        plain(section=(Section(length=0.3), Section(length=0.41, thickness=0.002)))


@pytest.mark.parametrize(
    ("supports", "more", "lines"),
    [
        (("free", "free"), {}, [(1.0, 0.0), (-0.365, 1.0)]),
        (("free", "free"), {"spring": (PointSpring(position=0.2, stiffness=1.0),)}, [(-0.2, 1.0)]),
        (("free", "free"), {"spring": (PointSpring(position=0.2, rotational=1.0),)}, [(1.0, 0.0)]),
        (("free", "free"), {"tension": 3.0}, [(1.0, 0.0)]),
        (("free", "free"), {"foundation": 3.0}, []),
        (("pinned", "free"), {}, [(-0.0, 1.0)]),
        (("free", "pinned"), {}, [(-0.73, 1.0)]),
        (("pinned", "free"), {"spring": (PointSpring(position=0.73, stiffness=1.0),)}, []),
        (("guided", "free"), {}, [(1.0, 0.0)]),
        (("guided", "guided"), {"spring": (PointSpring(position=0.4, stiffness=2.0),)}, []),
    ],
)
def test_rigid_motions_are_what_nothing_resists(supports, more, lines):
    assert list(rigid_lines(Beam(**SIZES, supports=supports, **more))) == lines


def test_what_is_added_is_named():
    everything = {
        "section": (Section(length=0.3), Section(length=0.43, thickness=0.003)),
        "mass": (PointMass(position=0.2, mass=0.1),),
        "tension": -0.1,
    }
    beam = Beam(**SIZES, **everything)
    assert features(beam) == ("section", "mass", "tension")
    assert not beam.uniform
    assert Beam(**SIZES, section=(Section(length=0.73),)).uniform
    with pytest.raises(InputError, match=r"beam\.mass: the wheel does not model it, leave it out"):
        check_features(beam, "the wheel", ("section", "tension"))


def test_numbers_of_numpy_and_whole_numbers_become_pythons():
    beam = Beam(**SIZES | {"length": 1, "width": np.float32(0.5), "loss_factor": np.array(0.01)})
    assert [type(one) for one in (beam.length, beam.width, beam.loss_factor)] == [float] * 3
    one = PointMass(position=np.float64(0.2), mass=np.int64(3))
    assert Beam(**SIZES, mass=one) == Beam(**SIZES, mass=[PointMass(position=0.2, mass=3.0)])
