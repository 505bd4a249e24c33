"""Units: beams that exist, however large, small, soft or light, and the same values in another unit."""

import pytest

from verify import Beam
from verify.analysis.margins import beam_margins
from verify.analysis.plausibility import unit_margins
from verify.analysis.solution_cache import SolutionCache
from verify.analysis.verdict import verdict_of

STEEL, HELD = {"youngs_modulus": 206e9, "density": 7850.0}, ("clamped", "free")


def bar(length, width, thickness, modulus=206e9, density=7850.0, supports=HELD, **more):
    own = {"width": width, "thickness": thickness, "youngs_modulus": modulus, "density": density}
    return Beam(length=length, supports=supports, **own, **more)


def blade():
    """A tapered blade of 117 m in 49 sections."""
    z = [(i + 0.5) / 49.0 for i in range(49)]
    own = [(7e10 * 10 ** (-4.0 * x**2), 2300.0 * (1.0 - x) ** 2 + 15.0) for x in z]
    parts = [{"bending_stiffness": stiffness, "mass_per_length": mass} for stiffness, mass in own]
    return Beam(length=117.0, supports=HELD, section=[one | {"length": 117.0 / 49} for one in parts], **parts[0])


REAL = {
    "blade": blade(),
    "girder at 2.24 Hz": Beam(length=40.0, bending_stiffness=4.17e10, mass_per_length=8000.0),
    "bridge": Beam(length=80.0, bending_stiffness=5e10, mass_per_length=8000.0),
    "block at 43 Hz": bar(10.0, 2.0, 1.84, supports=("pinned", "pinned")),
    "cantilevered block at 43 Hz": bar(10.0, 5.0, 5.2),
    "rail of 120 m": Beam(length=120.0, bending_stiffness=6.3e6, mass_per_length=60.0),
    "ship's shaft": Beam(length=60.0, shape="round", diameter=0.9, **STEEL),
    "concrete slab": bar(30.0, 10.0, 0.8, 32e9, 2450.0, ("pinned", "pinned")),
    "taut pipeline": Beam(length=1000.0, shape="tube", diameter=0.8, wall_thickness=0.02, tension=1e6, **STEEL),
    "wind tower": Beam(length=100.0, shape="tube", diameter=5.0, wall_thickness=0.03, supports=HELD, **STEEL),
    "steel tape": bar(5.0, 0.025, 1e-4),
    "MEMS": bar(100e-6, 20e-6, 2e-6, 169e9, 2330.0),
    "AFM tip at 300 kHz": bar(125e-6, 30e-6, 3.4e-6, 169e9, 2330.0),
    "graphene": bar(1e-6, 1e-7, 5e-8, 1e12, 2200.0, ("clamped", "clamped")),
    "glass fibre": Beam(length=1.0, shape="round", diameter=125e-6, youngs_modulus=72e9, density=2200.0),
    "foam": bar(1.0, 0.1, 0.05, 1e5, 30.0),
    "rubber": bar(0.3, 0.02, 0.01, 1e6, 1100.0),
    "wood": bar(4.0, 0.1, 0.2, 11e9, 450.0),
    "lead": bar(0.5, 0.03, 0.003, 16e9, 11340.0),
    "beryllium": bar(0.1, 0.01, 0.001, 303e9, 1850.0),
    "carbon fibre": bar(1.0, 0.02, 0.001, 140e9, 1600.0),
}
MISTAKEN = {
    "all in millimetres": (bar(185.0, 14.0, 1.2, 200e9, 7900.0), "24600 t"),
    "a stub in millimetres": (bar(40.0, 8.0, 8.0), "mass"),
    "a light spring in millimetres": (bar(30.0, 3.0, 0.5), "mass"),
    "carbon fibre in millimetres": (bar(100.0, 10.0, 1.0, 140e9, 1600.0), "mass"),
    "acrylic in millimetres": (bar(300.0, 30.0, 3.0, 3e9, 1190.0), "mass"),
    "a tube in millimetres": (Beam(length=500.0, shape="tube", diameter=20.0, wall_thickness=1.0, **STEEL), "mass"),
    "length in millimetres": (bar(730.0, 0.031, 0.0023), "first frequency"),
    "thickness in millimetres": (bar(0.3, 0.025, 3.0), "m thick"),
    "width in millimetres": (bar(0.3, 25.0, 0.003), "m wide"),
    "gigapascals": (bar(0.185, 0.014, 0.0012, 206.0), "speed of sound"),
    "megapascals": (bar(0.185, 0.014, 0.0012, 206e3), "speed of sound"),
    "grams a cubic centimetre": (bar(0.185, 0.014, 0.0012, density=7.85), "speed of sound"),
    "tonnes a cubic millimetre": (bar(0.185, 0.014, 0.0012, density=7.85e-9), "speed of sound"),
    "millimetres, newtons, tonnes": (bar(185.0, 14.0, 1.2, 206e3, 7.85e-9), "speed of sound"),
    "a density in g/m^3": (bar(0.185, 0.014, 0.0012, 206e12, 7.85e6), "above that of any solid"),
    "EI in GPa m^4": (Beam(length=0.3, bending_stiffness=2.06e-9, mass_per_length=0.2), "first frequency"),
    "length beside EI in millimetres": (Beam(length=300.0, bending_stiffness=2.0, mass_per_length=0.2), "frequency"),
    "EI of a blade in N mm^2": (Beam(length=117.0, bending_stiffness=7e16, mass_per_length=400.0), "faster than sound"),
}


@pytest.mark.parametrize("name", REAL)
def test_a_beam_that_exists_is_unmarked(name):
    assert unit_margins(REAL[name]) == []


@pytest.mark.parametrize("name", MISTAKEN)
def test_a_wrong_unit_leads_the_verdict(name):
    beam, words = MISTAKEN[name]
    verdict = verdict_of(beam_margins(SolutionCache(beam), [("fem", 2 * len(beam.pieces) + 3)], mode=1))
    assert verdict.level == "not trusted"
    assert verdict.margins[0].name == "units"
    assert words in verdict.margins[0].failure
