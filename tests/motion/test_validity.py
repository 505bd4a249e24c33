"""Which mode a drive lies nearest, and what a run at that drive cannot be believed beyond."""

from itertools import pairwise, product

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.exact.closed_forms import frequency_hz
from verify.motion.simulate import simulate
from verify.motion.validity import axial_inertia_size, discretisation, model_form, nearest_mode
from verify.options import SUPPORTS
from verify.section import Section


@pytest.mark.parametrize("supports", list(product(SUPPORTS, SUPPORTS)), ids="-".join)
def test_the_nearest_mode_is_nearest_for_every_drive(titanium_strip, supports):
    """By looking at them all: well below the first, on each side of every middle, and on the modes themselves."""
    beam = replace(titanium_strip, supports=supports)
    modes = np.array([frequency_hz(beam, n) for n in range(1, 16)])
    middles = 0.5 * (modes[1:-1] + modes[:-2])
    drives = [0.01 * modes[0], 0.37 * modes[0], *modes[:-2], *(0.9999 * middles), *(1.0001 * middles)]
    drives += [share * a + (1 - share) * b for a, b in pairwise(modes[:-1]) for share in (0.1, 0.8)]
    for drive in drives:
        assert nearest_mode(beam, float(drive)) == int(abs(modes - drive).argmin()) + 1, drive


def test_the_nearest_mode_is_that_of_the_beam_it_is_asked_of(titanium_strip):
    """f_n = n^2 (pi/2 L^2) h sqrt(E / 12 rho): every size of the beam counts."""
    c = 0.0023 * (113e9 / 4470.0 / 12) ** 0.5
    for n in (7, 19):
        drive = n**2 * np.pi / 2 / 0.73**2 * c
        assert nearest_mode(titanium_strip, drive) == n
        for name, factor, expected in (("length", 2.0, 2 * n), ("thickness", 0.25, 2 * n), ("width", 3.0, n)):
            other = replace(titanium_strip, **{name: factor * getattr(titanium_strip, name)})
            assert nearest_mode(other, drive) == expected
        assert nearest_mode(replace(titanium_strip, youngs_modulus=113e9 / 16), drive) == 2 * n
        assert nearest_mode(replace(titanium_strip, density=4470.0 * 16), drive) == 2 * n


@pytest.mark.parametrize(
    ("drive", "mode"), [(0.5, 1), (2.4, 1), (2.6, 2), (6.4, 2), (6.6, 3), (110.0, 10), (111.0, 11)]
)
def test_model_form_and_division_are_those_of_the_mode_nearest_the_drive(titanium_strip, drive, mode):
    """Pinned modes lie at 1, 4, 9, 16, ... times the first, their middles at 2.5, 6.5, ..., 110.5."""
    hertz = drive * frequency_hz(titanium_strip, 1)
    ratio = frequency_hz(titanium_strip, mode, "timoshenko") / frequency_hz(titanium_strip, mode)
    assert model_form(titanium_strip, hertz) == pytest.approx(ratio - 1.0, rel=1e-12)
    assert ratio < 1.0
    mu = mode * np.pi / 37
    assert discretisation(titanium_strip, "segment", 37, hertz) == pytest.approx(-(mu**4) / 1440, rel=1e-12)
    assert discretisation(titanium_strip, "fem", 37, hertz) == pytest.approx(mu**4 / 1440, rel=1e-12)


def test_a_beam_given_by_its_figures_moves_in_time_without_a_margin_of_its_theory():
    """Euler-Bernoulli's theory asks for neither rho I nor kappa G A; where both are given the margin is told."""
    plain = Beam(length=0.1, bending_stiffness=1.0667, mass_per_length=0.1256, extreme_fibre=0.001)
    thick = replace(plain, rotary_inertia=4.2e-8, shear_stiffness=1.1e6)
    forces = (PointForce(position=0.0058, amplitude=60.0), PointForce(position=0.0942, amplitude=50.0, phase_deg=75.0))
    runs = [simulate(beam, forces, 33066.0, 5e-5, model="fem", count=20, at=[0.031]) for beam in (plain, thick)]
    assert runs[0].deflection == pytest.approx(runs[1].deflection)
    assert runs[0].margins.model_form is None
    assert runs[1].margins.model_form < -1e-3
    assert model_form(replace(thick, rotary_inertia=None), 33066.0) is None


def test_what_has_no_closed_form_has_no_margin(titanium_strip):
    stepped = replace(titanium_strip, section=(Section(length=0.23), Section(length=0.5, thickness=0.001)))
    assert model_form(stepped, 100.0) is None
    assert discretisation(stepped, "fem", 40, 100.0) is None
    assert model_form(replace(titanium_strip, supports=("clamped", "pinned")), 100.0) is None
    assert discretisation(replace(titanium_strip, supports=("clamped", "pinned")), "fem", 40, 100.0) > 0
    assert discretisation(titanium_strip, "analytic", None, 100.0) is None


def test_axial_inertia_grows_with_the_square_of_wavenumber_length_and_slope(titanium_strip):
    k2 = 2 * np.pi * 1310.0 / (0.0023 * (113e9 / 4470.0 / 12) ** 0.5)
    assert axial_inertia_size(titanium_strip, 1310.0, 3.1e-5) == pytest.approx(k2 * 0.73**2 * 3.1e-5, rel=1e-12)


def test_axial_inertia_is_of_the_wave_that_runs_under_tension_and_on_ground(titanium_strip):
    piece, ground = titanium_strip.pieces[0], 0.4 * titanium_strip.pieces[0].mass_per_length * (2 * np.pi * 1310.0) ** 2
    held = replace(titanium_strip, tension=310.0, foundation=ground)
    k2 = np.roots([piece.bending_stiffness, 310.0, -1.5 * ground]).max()
    assert axial_inertia_size(held, 1310.0, 3.1e-5) == pytest.approx(k2 * 0.73**2 * 3.1e-5, rel=1e-12)


@pytest.mark.parametrize("model", ["segment", "fem"])
@pytest.mark.parametrize("supports", [("pinned", "pinned"), ("clamped", "free")])
def test_a_model_without_the_mode_has_no_division_error(titanium_strip, supports, model):
    """The leading term of mode 11 on 9 parts would be 15 %, of a mode that the chain has not."""
    beam = replace(titanium_strip, supports=supports)
    hertz = frequency_hz(beam, 11)
    assert discretisation(beam, model, 9, hertz) is None
    assert discretisation(beam, model, 12, hertz) is not None
