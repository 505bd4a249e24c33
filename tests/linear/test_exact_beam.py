"""Exact shapes and driven fields: orthogonality, ends, balances at attachments, static and rigid limits, power."""

import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import PAIRED, PAIRS, STRIP, cut
from verify import Beam, Device, ExactModel, PointForce, PointMass, PointSpring, Section
from verify.errors import InputError, ResonanceError

BAR = Beam(
    length=0.61, width=0.023, thickness=0.031, youngs_modulus=113e9, density=4470.0, supports=("clamped", "free"),
    section=(Section(length=0.2), Section(length=0.17, thickness=0.019), Section(length=0.24, youngs_modulus=70e9)),
    mass=(PointMass(position=0.29, mass=0.3, rotary_inertia=4e-4),
          PointMass(position=0.61, mass=0.11, rotary_inertia=2e-5)),
    spring=(PointSpring(position=0.11, stiffness=2e6, rotational=700.0),), foundation=3.1e6,
)  # fmt: skip
PLAIN = replace(BAR, section=(), mass=(), spring=(), foundation=0.0)
ZERO = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Derivatives that vanish at an end."""

# --- Shapes ----------------------------------------------------------------------------------------------------------


def gauss(beam, cells):
    """(x, weights, rho A, rho I) of Gauss points on all stretches."""
    points, weights = np.polynomial.legendre.leggauss(14)
    rows = []
    for piece, a, b in cut(beam):
        size = (b - a) / cells
        for start in a + size * np.arange(cells):
            inertia = np.full((2, 14), [[piece.mass_per_length], [piece.rotary_inertia]])
            rows.append([start + size * (points + 1) / 2, size * weights / 2, *inertia])
    return np.concatenate(rows, axis=1)


@pytest.mark.parametrize(
    ("beam", "theory", "modes", "bound"),
    [
        *((replace(STRIP, supports=pair), "euler-bernoulli", 30, 5e-14) for pair in PAIRS),
        *(
            (replace(BAR, supports=pair), theory, 12, 1e-12)
            for pair in (("clamped", "free"), ("free", "free"), ("pinned", "free"))
            for theory in ("euler-bernoulli", "rayleigh")
        ),
        (replace(BAR, tension=2e5), "euler-bernoulli", 12, 1e-12),
    ],
)
def test_shapes_are_orthonormal_in_the_mass_and_rotary_inertia_of_beam_and_bodies(beam, theory, modes, bound):
    found = ExactModel(beam, theory).modes(modes)
    x, weights, mass, turning = gauss(beam, 60 if beam.mass == () else 12)
    w, slope = found.deflection(x), found.slope(x)
    gram = (w * weights * mass) @ w.T
    if theory == "rayleigh":
        gram += (slope * weights * turning) @ slope.T
    for body in beam.mass:
        at = np.array([body.position])
        gram += body.mass * found.deflection(at) @ found.deflection(at).T
        gram += body.rotary_inertia * found.slope(at) @ found.slope(at).T
    assert abs(gram - np.eye(modes)).max() < bound
    if not beam.mass:
        for end, support in zip((0.0, beam.length), beam.supports, strict=True):
            for k in ZERO[support]:
                size = abs(found.shapes(x, k)).max(axis=1)
                assert (abs(found.shapes(np.array([end]), k)[:, 0]) < 2e-14 * size).all()


def test_at_a_clamp_a_timoshenko_shape_has_slope_without_rotation():
    """By M' = V + p psi the third derivative gives kappa G A (w' - psi) = -V with psi = 0."""
    model, own, end = ExactModel(PLAIN, "timoshenko"), PLAIN.base_section, np.array([0.0])
    w, slope, bend, third = (model.mode_shape(2, end, d)[0] for d in range(4))
    assert abs(w) < 2e-14 * abs(model.mode_shape(2, np.linspace(0.0, PLAIN.length, 30))).max()
    square = own.mass_per_length * (2 * np.pi * model.frequency_hz(2)) ** 2
    force = -slope * own.shear_stiffness
    assert third == pytest.approx(force / own.bending_stiffness - square / own.shear_stiffness * slope, rel=1e-12)
    assert slope > 0
    assert bend == pytest.approx(model.mode_shape(2, end + 1e-13, 2)[0], rel=1e-9)


def test_shapes_of_a_beam_under_high_tension_are_sines_with_boundary_layers_at_clamps():
    """Of length sqrt(EI / T)."""
    layer = 2e-3
    beam = replace(PLAIN, supports=("clamped", "clamped"), tension=PLAIN.bending_stiffness / layer**2)
    x = np.linspace(0.05, 0.56, 40)
    reach = beam.length - 2 * layer
    sine = np.sqrt(2 / (beam.mass_per_length * reach)) * np.sin(2 * np.pi * (x - layer) / reach)
    assert ExactModel(beam).mode_shape(2, x) == pytest.approx(sine, abs=3e-3 * abs(sine).max())
    near = ExactModel(beam).mode_shape(2, np.array([0.0, layer, 8 * layer]), 1)
    assert abs(near[0]) < 1e-14 * near[2]
    assert near[1] / near[2] == pytest.approx(1 - np.exp(-1), rel=0.02)


def test_a_close_pair_of_a_symmetric_beam_is_even_and_odd():
    x = np.linspace(0.01, 0.19, 9)
    for mode in (4, 5):
        left, right = (ExactModel(PAIRED).mode_shape(mode, places) for places in (x, 0.7 - x))
        parity = np.sign(left @ right)
        assert left == pytest.approx(parity * right, abs=1e-5 * abs(left).max())
    pair = ExactModel(PAIRED).modes(5).deflection(np.concatenate([x, 0.7 - x]))[3:]
    assert pair[0, :9] @ pair[1, :9] == pytest.approx(-(pair[0, 9:] @ pair[1, 9:]), rel=1e-4)


# --- Driven fields ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("hertz", [1e-30, 1e-9, 1e-5])
def test_compliances_of_bending_shear_and_an_elastic_clamp_add_up(hertz):
    """F (L^3 / 3EI + L / kappa G A + L^2 / k_r + 1 / k)."""
    k, turning = 3e5, 8e3
    beam = Beam(length=0.4, width=0.02, thickness=0.05, youngs_modulus=70e9, density=2700.0, supports=("free", "free"))
    beam = replace(beam, spring=(PointSpring(position=0.0, stiffness=k, rotational=turning),))
    bent = 0.4**3 / 3 / beam.base_section.bending_stiffness + 0.4**2 / turning + 1 / k
    shear = {"euler-bernoulli": 0.0, "rayleigh": 0.0, "timoshenko": 0.4 / beam.base_section.shear_stiffness}
    for theory, own in shear.items():
        found = ExactModel(beam, theory).harmonic([PointForce(position=0.4, amplitude=7.0)], hertz)
        assert found.deflection(0.4)[0] == pytest.approx(7.0 * (bent + own), rel=1e-13)


@pytest.mark.parametrize("part", [-0.97, -0.4, 0.3, 40.0])
def test_the_mid_span_of_a_beam_column(part):
    """F L^3 / 48 EI times 3 (tan u - u) / u^3, u = L / 2 sqrt(P / EI); tanh under tension."""
    beam = Beam(length=0.83, width=0.021, thickness=0.0037, youngs_modulus=113e9, density=4470.0)
    u = np.pi / 2 * np.sqrt(abs(part))
    factor = 3 * (np.tan(u) - u) / u**3 if part < 0 else 3 * (u - np.tanh(u)) / u**3
    loaded = replace(beam, tension=part * np.pi**2 * beam.bending_stiffness / beam.length**2)
    found = ExactModel(loaded).harmonic([PointForce(position=0.415)], 1e-7).deflection(0.415)
    assert found[0] == pytest.approx(beam.length**3 / 48 / beam.bending_stiffness * factor, rel=1e-12)


def test_a_slowly_driven_free_beam_moves_as_a_rigid_body():
    """-F / omega^2 (1 / m + (x - c)(a - c) / J) with bodies and steps."""
    beam = replace(BAR, supports=("free", "free"), spring=(), foundation=0.0)
    starts = np.cumsum([0.0, *(p.length for p in beam.pieces)])
    masses = np.array([p.mass_per_length * p.length for p in beam.pieces] + [m.mass for m in beam.mass])
    places = np.array([*(starts[:-1] + np.diff(starts) / 2), *(m.position for m in beam.mass)])
    centre = masses @ places / masses.sum()
    own = [p.mass_per_length * p.length**3 / 12 for p in beam.pieces] + [m.rotary_inertia for m in beam.mass]
    inertia = masses @ (places - centre) ** 2 + sum(own)
    x, omega = np.array([0.0, 0.2, 0.61]), 2 * np.pi * 1e-4
    found = ExactModel(beam).harmonic([PointForce(position=0.17, amplitude=3.0)], 1e-4).deflection(x)
    expected = -3.0 / omega**2 * (1 / masses.sum() + (x - centre) * (0.17 - centre) / inertia)
    assert found == pytest.approx(expected, rel=1e-11)


def test_a_dashpot_at_a_node_leaves_a_resonance_undamped():
    model, middle, force = ExactModel(STRIP), STRIP.length / 2, PointForce(position=0.1)
    resonance = model.frequency_hz(2)
    with pytest.raises(ResonanceError, match="of mode 2"):
        model.harmonic(force, resonance, devices=Device(position=middle, dashpot=3.0))
    damped = model.harmonic(force, resonance, devices=Device(position=0.9 * middle, dashpot=3.0))
    assert np.isfinite(damped.deflection(0.1)).all()


def test_positions_off_the_beam_and_no_modes_are_an_input_error():
    with pytest.raises(InputError, match="n_modes = 0"):
        ExactModel(STRIP).modes(0)
    with pytest.raises(InputError, match=r"x = 0\.74 lies off the beam"):
        ExactModel(STRIP).modes(2).deflection([0.1, 0.74])
