"""A strip as a thin plate, against Ritz's method with powers across the width, which knows no characteristic equation."""

import numpy as np
import pytest
from scipy.linalg import eigh

from verify.errors import InputError
from verify.exact import plate_strip
from verify.exact.plate import plate_error, stiffening
from verify.problem.beam import Beam


def by_ritz(half_width: float, nu: float, powers: int = 9) -> float:
    """Omega over the beam's, less one: w = sin(kx) sum c_j P_2j(y), the energy of a bent plate over that of its motion.

    Lengths in half widths, so that k is `half_width`; the beam's (1 - nu^2) k^4 is omega^2 there.
    """
    y, weight = np.polynomial.legendre.leggauss(80)
    basis = [np.polynomial.Legendre.basis(2 * j) for j in range(powers)]
    w, slope, bent = (np.array([p.deriv(d)(y) if d else p(y) for p in basis]) for d in range(3))
    along = -(half_width**2) * w  # w_xx
    whole = along + bent
    twist = half_width * slope
    cross = (along * weight) @ bent.T
    energy = (whole * weight) @ whole.T - (1.0 - nu) * (cross + cross.T - 2.0 * (twist * weight) @ twist.T)
    lowest = eigh(energy, (w * weight) @ w.T, eigvals_only=True)[0]
    return float(np.sqrt(lowest / (1.0 - nu * nu)) / half_width**2 - 1.0)


@pytest.mark.parametrize("nu", [0.33, 0.17, 0.48, -0.35])
@pytest.mark.parametrize("half_width", [0.4, 1.38, 3.1, 6.7])
def test_a_strip_is_stiffened_as_ritz_finds_it(half_width, nu):
    assert stiffening(half_width, nu) == pytest.approx(by_ritz(half_width, nu), abs=1e-10)


def test_the_papers_mode_22_is_higher_by_what_its_gate_says(paper_beam):
    half_width = 22 * np.pi / paper_beam.length * paper_beam.width / 2
    assert by_ritz(half_width, 0.33) == pytest.approx(0.0246447583, abs=1e-10)
    assert plate_error(paper_beam, 22) == pytest.approx(0.0246447583, abs=1e-10)


def test_a_narrow_strip_is_a_beam_and_gains_by_the_square_of_its_width():
    for nu in (0.33, 0.2):
        assert stiffening(1e-3, nu) == pytest.approx(nu**2 / (3 * (1 + nu)) * 1e-6, rel=1e-5)
    assert stiffening(2e-2, 0.33) / stiffening(1e-2, 0.33) == pytest.approx(4.0, rel=1e-3)


def test_a_wide_strip_bends_as_a_cylinder_but_for_a_wave_that_keeps_to_its_edges():
    whole = 1 / np.sqrt(1 - 0.3**2) - 1
    assert 0.95 * whole < stiffening(50.0, 0.3) < whole
    lost = [whole - stiffening(q, 0.3) for q in (400.0, 1e4)]  # the edge wave, omega^2 a 0.3 % below
    assert lost[0] == pytest.approx(lost[1], rel=1e-6)


@pytest.mark.parametrize("nu", [0.12, 0.33, 0.45, 0.49])
def test_the_lowest_root_of_a_very_wide_strip_is_konenkovs_wave_along_an_edge(nu):
    """Below what a strip that stays straight across gains."""
    edge = np.sqrt((1 - nu) * (3 * nu - 1 + 2 * np.sqrt(1 - 2 * nu + 2 * nu**2)) / (1 - nu**2)) - 1.0
    assert stiffening(1e5, nu) == pytest.approx(edge, rel=1e-9)
    assert edge < 1.0 / np.sqrt(1.0 - nu**2) - 1.0


def test_without_poissons_ratio_nothing_happens_across():
    assert stiffening(1.7, 0.0) == 0.0


@pytest.mark.parametrize("supports", [("pinned", "guided"), ("guided", "guided")])
def test_ends_that_a_sine_fits_differ_by_their_wavenumber_alone(supports, paper_beam):
    beam = Beam(length=0.31, width=0.023, thickness=0.0012, youngs_modulus=1.1e11, density=4400.0, supports=supports)
    mode = 7
    turns = mode - 0.5 if "pinned" in supports else mode
    expected = stiffening(0.0115 * turns * np.pi / 0.31, beam.poissons_ratio)
    assert plate_error(beam, mode) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"supports": ("clamped", "free")}, "pinned and guided"),
        ({"width": 0.004}, "5 times as wide as thick"),
        ({"foundation": 3e4}, "beam.foundation: a strip with it has no closed form as a plate here, leave it out"),
    ],
)
def test_a_beam_without_a_closed_form_across_says_so(change, said):
    sizes = {"length": 0.31, "width": 0.023, "thickness": 0.0012, "youngs_modulus": 1.1e11, "density": 4400.0}
    with pytest.raises(InputError, match=said):
        plate_error(Beam(**(sizes | change)), 3)


def test_a_tube_has_no_width():
    tube = Beam(length=0.7, shape="tube", diameter=0.02, wall_thickness=0.002, youngs_modulus=2.1e11, density=7800.0)
    with pytest.raises(InputError, match="width"):
        plate_error(tube, 1)


def test_an_edge_without_its_twist_is_seen(monkeypatch):
    true = plate_strip._edge
    monkeypatch.setattr(plate_strip, "_edge", lambda g, q, nu: true(g, q, 0.9 * nu))
    assert abs(stiffening(1.38, 0.33) - by_ritz(1.38, 0.33)) > 1e-3


@pytest.mark.parametrize("mode", [0, -3, 2.5])
def test_a_plates_mode_has_a_whole_number(paper_beam, mode):
    with pytest.raises(InputError, match=f"^mode = {mode}"):
        plate_error(paper_beam, mode)
