"""A beam in one line, and the units of a command line."""

from pathlib import Path

import pytest

from verify.errors import InputError
from verify.problem.beam import Beam
from verify.problem.materials import MATERIALS
from verify.problem.phrase import beam_table
from verify.validation import in_si

PAGE = (Path(__file__).parents[2] / "docs" / "your-beam.md").read_text("utf-8")
STEEL = {"youngs_modulus": 210e9, "density": 7850.0, "poissons_ratio": 0.3}


@pytest.mark.parametrize(
    ("phrase", "fields"),
    [
        ("1 m x 40 x 8 mm steel, clamped-free", {"length": 1.0, "width": 0.04, "thickness": 0.008} | STEEL),
        ("3x2x.5in steel, cantilever", {"length": 0.0762, "width": 0.0508, "thickness": 0.0127} | STEEL),
        ("1.5e3 mm × round 8 mm Steel, Clamped-Free", {"length": 1.5, "shape": "round", "diameter": 0.008} | STEEL),
        (
            "2 ft x tube 1 in x 2 mm E = 1e4 ksi rho=0.1 lb/in3, clamped-free",
            {"length": 0.6096, "shape": "tube", "diameter": 0.0254, "wall_thickness": 0.002}
            | {"youngs_modulus": 6.894757293168361e10, "density": 2767.990471020},
        ),
        (
            "1 x 40 x 8 mm steel, E=69GPa, rho=2700 nu=0.33, clamped-free",
            {"length": 0.001, "width": 0.04, "thickness": 0.008}
            | {"youngs_modulus": 69e9, "density": 2700.0, "poissons_ratio": 0.33},
        ),
    ],
)
def test_phrase_is_a_beam(phrase, fields):
    table = beam_table(phrase)
    assert table.pop("supports") == ["clamped", "free"]
    assert table == {name: pytest.approx(v, rel=1e-11) if isinstance(v, float) else v for name, v in fields.items()}
    assert Beam(**beam_table(phrase)).length == table["length"]


@pytest.mark.parametrize(
    ("phrase", "message"),
    [
        ("1 m x 40 x 8 mm steel", "end it by two of"),
        ("1 m x 40 x 8 mm steel, clamped", "end it by two of"),
        ("1 m x 8 mm steel, clamped-free", "write length, section and material"),
        ("1 m x tube 8 mm steel, clamped-free", "write length, section and material"),
        ("1 m steel x 40 x 8 mm, clamped-free", "write length, section and material"),
        ("steel, clamped-free", "write length, section and material"),
        ("1 m x 40 x 8 mn steel, clamped-free", "beam.thickness = '8 mn'"),
        ("1 m x 40 x 8 mm stel, clamped-free", "did you mean 'steel'"),
        ("1 m x 40 x 8 mm, clamped-free", "material = '' is not known"),
        ("1 m x 40 x 8 mm steel G=3, clamped-free", "G = 3 is no constant"),
        ("1 m x 40 x 8 mm E=3kg rho=2, clamped-free", "beam.youngs_modulus = '3kg'"),
    ],
)
def test_wrong_phrase_is_refused(phrase, message):
    with pytest.raises(InputError, match=message):
        beam_table(phrase)


def test_units_have_their_definitions():
    assert in_si("1 psi", "Pa", "p") == pytest.approx(0.45359237 * 9.80665 / 0.0254**2, rel=1e-14)
    assert in_si("1 lbf", "N", "f") == pytest.approx(0.45359237 * 9.80665, rel=1e-14)
    assert in_si("-2.5e3 µm", "m", "x") == pytest.approx(-2.5e-3, rel=1e-14)
    assert in_si("3 g/cm^3", "kg/m^3", "rho") == in_si("3000", "kg/m^3", "rho") == 3000.0


def test_materials_are_solids_with_sources():
    for name, one in MATERIALS.items():
        assert 3000.0 < (one.youngs_modulus / one.density) ** 0.5 < 9000.0, name
        assert 0.0 < one.poissons_ratio < 0.5
        row = f"| {name} | {one.youngs_modulus / 1e9:g} | {one.density:g} | {one.poissons_ratio:g} | {one.source} |\n"
        assert row in PAGE
