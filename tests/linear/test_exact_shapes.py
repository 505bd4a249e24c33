"""Shapes of beams with everything on them: orthonormal, meeting the ends and joints, and those of Ritz."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import PAIRED, cut
from verify import analytic_modes
from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.errors import InputError
from verify.exact import shapes
from verify.exact.shapes import general_shapes
from verify.section import Section

BAR = Beam(
    length=0.61,
    width=0.023,
    thickness=0.031,
    youngs_modulus=113e9,
    density=4470.0,
    supports=("clamped", "free"),
    section=(Section(length=0.2), Section(length=0.17, thickness=0.019), Section(length=0.24, youngs_modulus=70e9)),
    mass=(
        PointMass(position=0.29, mass=0.3, rotary_inertia=4e-4),
        PointMass(position=0.61, mass=0.11, rotary_inertia=2e-5),
    ),
    spring=(PointSpring(position=0.11, stiffness=2e6, rotational=700.0),),
    foundation=3.1e6,
)


def gauss(beam, cells=12):
    """(x, weights, rho A, rho I) of Gauss points on all stretches."""
    points, weights = np.polynomial.legendre.leggauss(14)
    x, w, mass, turning = [], [], [], []
    for piece, a, b in cut(beam):
        for i in range(cells):
            start, size = a + (b - a) * i / cells, (b - a) / cells
            x += list(start + size * (points + 1) / 2)
            w += list(size * weights / 2)
            mass += [piece.mass_per_length] * 14
            turning += [piece.rotary_inertia] * 14
    return np.array(x), np.array(w), np.array(mass), np.array(turning)


@pytest.mark.parametrize("theory", ["euler-bernoulli", "rayleigh"])
@pytest.mark.parametrize("supports", [("clamped", "free"), ("free", "free"), ("pinned", "free")], ids="-".join)
def test_shapes_are_orthonormal_in_all_that_has_mass(theory, supports):
    beam = replace(BAR, supports=supports)
    modes = analytic_modes.solve_modes(beam, 12, theory)
    x, weights, mass, turning = gauss(beam)
    w, slope = modes.deflection(x), modes.slope(x)
    gram = (w * weights * mass) @ w.T
    if theory == "rayleigh":
        gram += (slope * weights * turning) @ slope.T
    for body in beam.mass:
        at = np.array([body.position])
        gram += body.mass * modes.deflection(at) @ modes.deflection(at).T
        gram += body.rotary_inertia * modes.slope(at) @ modes.slope(at).T
    assert abs(gram - np.eye(12)).max() < 1e-12


def test_a_timoshenko_shape_turns_less_than_its_line_slopes():
    """M' = V + p psi by the third derivative: kappa G A (w' - psi) = -V; the clamp holds psi, not the line."""
    plain = replace(BAR, section=(), mass=(), spring=(), foundation=0.0)
    own, omega = plain.own, 2 * np.pi * analytic_modes.exact_frequency_hz(plain, 2, "timoshenko")
    end = np.array([0.0])
    w, slope, bend, third = (analytic_modes.mode_shape(plain, 2, end, d, "timoshenko")[0] for d in range(4))
    assert abs(w) < 1e-15
    c, b = 1 / own.shear_stiffness, 1 / own.bending_stiffness
    p, q = -own.rotary_inertia * omega**2, own.mass_per_length * omega**2
    force = -slope / c  # psi = 0
    assert third == pytest.approx(b * force - c * q * slope, rel=1e-12)
    assert slope > 0
    assert bend == pytest.approx(analytic_modes.mode_shape(plain, 2, end + 1e-13, 2, "timoshenko")[0], rel=1e-9)
    assert p < 0


def test_moments_and_forces_balance_over_what_is_fixed():
    """EI w'' rises by (k_r - J omega^2) w', EI w''' falls by (k - m omega^2) w; EI w'' goes on over a step."""
    mode, omega = 5, 2 * np.pi * analytic_modes.exact_frequency_hz(BAR, 5)

    def at(x, derivative):
        return analytic_modes.mode_shape(BAR, mode, np.array([x]), derivative)[0]

    body, spring = BAR.mass[0], BAR.spring[0]
    for place, stiffness, k, turning in (
        (body.position, BAR.pieces[1].bending_stiffness, -body.mass * omega**2, -body.rotary_inertia * omega**2),
        (spring.position, BAR.pieces[0].bending_stiffness, spring.stiffness, spring.rotational),
    ):
        moment, force = (stiffness * (at(place + 1e-12, d) - at(place - 1e-12, d)) for d in (2, 3))
        assert moment == pytest.approx(turning * at(place, 1), rel=1e-7)
        assert force == pytest.approx(-k * at(place, 0), rel=1e-7)
    left, right = (BAR.pieces[i].bending_stiffness * at(0.2 + side * 1e-12, 2) for i, side in ((0, -1), (1, 1)))
    assert left == pytest.approx(right, rel=1e-8)
    tip, end = BAR.mass[1], BAR.length
    stiffness = BAR.pieces[2].bending_stiffness
    assert stiffness * at(end, 3) == pytest.approx(-tip.mass * omega**2 * at(end, 0), rel=1e-9)
    assert stiffness * at(end, 2) == pytest.approx(tip.rotary_inertia * omega**2 * at(end, 1), rel=1e-9)


def test_a_beam_under_tension_has_shapes_with_layers_at_its_clamps():
    """A cable: sines, but for ends as short as sqrt(EI / T)."""
    layer = 2e-3
    beam = replace(BAR, section=(), mass=(), spring=(), foundation=0.0, supports=("clamped", "clamped"))
    beam = replace(beam, tension=beam.bending_stiffness / layer**2)
    x = np.linspace(0.05, 0.56, 40)
    reach = beam.length - 2 * layer
    sine = np.sqrt(2 / (beam.mass_per_length * reach)) * np.sin(2 * np.pi * (x - layer) / reach)
    assert analytic_modes.mode_shape(beam, 2, x) == pytest.approx(sine, abs=3e-3 * abs(sine).max())
    near = analytic_modes.mode_shape(beam, 2, np.array([0.0, layer, 8 * layer]), 1)
    assert abs(near[0]) < 1e-14 * near[2]
    assert near[1] / near[2] == pytest.approx(1 - np.exp(-1), rel=0.02)


def test_two_strips_that_nearly_mirror_each_other_have_shapes_of_their_own():
    """A pair 2.4e-7 apart: even and odd, orthogonal."""
    x = np.linspace(0.01, 0.19, 9)
    for mode in (4, 5):
        here, there = (analytic_modes.mode_shape(PAIRED, mode, places) for places in (x, 0.7 - x))
        parity = np.sign(here @ there)
        assert here == pytest.approx(parity * there, abs=1e-5 * abs(here).max())
    pair = analytic_modes.mode_shapes(PAIRED, 5, np.concatenate([x, 0.7 - x]))[3:]
    assert pair[0, :9] @ pair[1, :9] == pytest.approx(-(pair[0, 9:] @ pair[1, 9:]), rel=1e-4)


def test_equations_that_stay_singular_beside_a_resonance_are_refused(monkeypatch):
    def singular(spans):
        raise np.linalg.LinAlgError("Singular matrix")

    monkeypatch.setattr(shapes, "solver", singular)
    beam = Beam(length=0.61, width=0.03, thickness=0.004, youngs_modulus=9e10, density=3100.0)
    with pytest.raises(InputError, match="mode: no shape is found at this frequency"):
        general_shapes(beam, [2], np.array([0.17]), 0, "euler-bernoulli")
