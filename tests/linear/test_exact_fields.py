"""Harmonic fields of beams with everything on them: statics, extended precision, reciprocity and power."""

from itertools import pairwise

import numpy as np
import pytest
from msgspec.structs import replace

from verify import analytic_modes
from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.errors import ResonanceError
from verify.section import Section

BAR = Beam(
    length=0.61,
    width=0.023,
    thickness=0.031,
    youngs_modulus=113e9,
    density=4470.0,
    supports=("clamped", "free"),
    loss_factor=0.013,
    section=(Section(length=0.2), Section(length=0.17, thickness=0.019), Section(length=0.24, youngs_modulus=70e9)),
    mass=(
        PointMass(position=0.29, mass=0.3, rotary_inertia=4e-4),
        PointMass(position=0.61, mass=0.11, rotary_inertia=2e-5),
    ),
    spring=(PointSpring(position=0.11, stiffness=2e6, rotational=700.0),),
    foundation=3.1e6,
)
FORCES = (
    PointForce(position=0.07, amplitude=2.0, phase_deg=30.0),
    PointForce(position=0.29, amplitude=1.3),
    PointForce(position=0.61, amplitude=0.4, phase_deg=-110.0),
)
THEORIES = ("euler-bernoulli", "rayleigh", "timoshenko")


def phasors(forces):
    return {f.position: f.amplitude * np.exp(1j * np.deg2rad(f.phase_deg)) for f in forces}


def test_a_slow_cantilever_with_a_shear_spring_and_an_elastic_clamp_is_static():
    """F (L^3 / 3EI + L / kappa G A + L^2 / k_r + 1 / k)."""
    k, turning = 3e5, 8e3
    spring = PointSpring(position=0.0, stiffness=k, rotational=turning)
    beam = Beam(length=0.4, width=0.02, thickness=0.05, youngs_modulus=70e9, density=2700.0, supports=("free", "free"))
    beam = replace(beam, spring=(spring,))
    own, tip = beam.own, np.array([0.4])
    bent = 0.4**3 / 3 / own.bending_stiffness + 0.4**2 / turning + 1 / k
    for hertz in (1e-30, 1e-9, 1e-5):
        for theory, shear in (("euler-bernoulli", 0.0), ("rayleigh", 0.0), ("timoshenko", 0.4 / own.shear_stiffness)):
            found = analytic_modes.solve_harmonic(beam, [PointForce(position=0.4, amplitude=7.0)], hertz, theory)
            assert found.deflection(tip)[0] == pytest.approx(7.0 * (bent + shear), rel=1e-13)


def test_slow_struts_and_ties_bend_as_the_beam_column():
    """Middle of a pinned beam: F L^3 / 48 EI times 3 (tan u - u) / u^3, u = L / 2 sqrt(P / EI); tanh under tension."""
    beam = Beam(length=0.83, width=0.021, thickness=0.0037, youngs_modulus=113e9, density=4470.0)
    euler = np.pi**2 * beam.bending_stiffness / beam.length**2
    force, middle = [PointForce(position=0.415)], np.array([0.415])
    plain = beam.length**3 / 48 / beam.bending_stiffness
    for part in (-0.97, -0.4, 0.3, 40.0):
        u = np.pi / 2 * np.sqrt(abs(part))
        factor = 3 * (np.tan(u) - u) / u**3 if part < 0 else 3 * (u - np.tanh(u)) / u**3
        found = analytic_modes.solve_harmonic(replace(beam, tension=part * euler), force, 1e-7).deflection(middle)
        assert found[0] == pytest.approx(plain * factor, rel=1e-12)


def test_a_long_slow_beam_on_a_foundation_is_hetenyis():
    """F lambda / 2k e^(-lambda x) (cos + sin), lambda = (k / 4EI)^(1/4), far from its ends."""
    beam = Beam(
        length=9.0, width=0.02, thickness=0.004, youngs_modulus=70e9, density=2700.0, supports=("free", "pinned")
    )
    beam = replace(beam, foundation=4e5)
    rate = (beam.foundation / 4 / beam.bending_stiffness) ** 0.25
    assert rate * 4 > 35
    x = np.array([0.0, 0.05, 0.13, 0.4])
    found = analytic_modes.solve_harmonic(beam, [PointForce(position=4.3)], 1e-8).deflection(4.3 + x)
    expected = rate / 2 / beam.foundation * np.exp(-rate * x) * (np.cos(rate * x) + np.sin(rate * x))
    assert found == pytest.approx(expected, rel=1e-11)


def test_a_free_beam_that_nothing_holds_answers_as_a_rigid_body():
    """Slowly driven off its centre: -F / omega^2 (1 / m + (x - c)(a - c) / J), with its body and its steps."""
    beam = replace(BAR, supports=("free", "free"), spring=(), foundation=0.0, loss_factor=0.0)
    starts = np.cumsum([0.0, *(p.length for p in beam.pieces)])
    masses = np.array([p.mass_per_length * p.length for p in beam.pieces] + [m.mass for m in beam.mass])
    places = np.array([*(starts[:-1] + np.diff(starts) / 2), *(m.position for m in beam.mass)])
    centre = masses @ places / masses.sum()
    own = [p.mass_per_length * p.length**3 / 12 for p in beam.pieces] + [m.rotary_inertia for m in beam.mass]
    inertia = masses @ (places - centre) ** 2 + sum(own)
    x, omega = np.array([0.0, 0.2, 0.61]), 2 * np.pi * 1e-4
    found = analytic_modes.solve_harmonic(beam, [PointForce(position=0.17, amplitude=3.0)], 1e-4).deflection(x)
    expected = -3.0 / omega**2 * (1 / masses.sum() + (x - centre) * (0.17 - centre) / inertia)
    assert found == pytest.approx(expected, rel=1e-11)


def test_springs_foundation_and_tension_lose_nothing_and_the_beam_all():
    """Power in, F v / 2, is eta omega / 2 times the integral of EI w''^2: what is lost in bending alone."""
    beam = replace(BAR, tension=2e5)
    field = analytic_modes.solve_harmonic(beam, FORCES, 730.0)
    put_in = sum(
        (np.conj(f) * 2j * np.pi * 730.0 * field.deflection(np.array([at]))[0]).real / 2
        for at, f in phasors(FORCES).items()
    )
    points, weights = np.polynomial.legendre.leggauss(12)
    lost, cuts = 0.0, [0.0, 0.07, 0.11, 0.2, 0.29, 0.37, 0.45, 0.53, 0.61]
    for a, b in pairwise(cuts):
        stiffness = beam.pieces[0 if b <= 0.2 else 1 if b <= 0.37 else 2].bending_stiffness
        bend = field.shapes((a + b) / 2 + (b - a) / 2 * points, 2)
        lost += beam.loss_factor * np.pi * 730.0 * stiffness * float((b - a) / 2 * weights @ abs(bend) ** 2)
    assert put_in == pytest.approx(lost, rel=1e-10)


@pytest.mark.parametrize("theory", THEORIES)
def test_an_undamped_resonance_is_refused_and_its_neighbourhood_is_not(theory):
    beam = replace(BAR, loss_factor=0.0)
    resonance = analytic_modes.exact_frequency_hz(beam, 4, theory)
    with pytest.raises(ResonanceError, match="of mode 4 of the analytic model"):
        analytic_modes.solve_harmonic(beam, FORCES, resonance * (1 + 3e-10), theory)
    nan = analytic_modes.unit_responses(beam, [0.2], np.array([resonance, 1.01 * resonance]), np.array([0.3]), theory)
    assert np.isnan(nan[0]).all()
    assert np.isfinite(nan[1]).all()
    sides = [
        analytic_modes.solve_harmonic(beam, FORCES[:1], resonance * (1 + side * 1e-7), theory)
        .deflection([0.61])[0]
        .real
        for side in (-1, 1)
    ]
    assert sides[0] / sides[1] == pytest.approx(-1.0, rel=1e-4)
