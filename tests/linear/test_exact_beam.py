"""Exact uniform beams: modes, shapes, harmonic fields."""

from itertools import pairwise, product

import mpmath
import numpy as np
import pytest
from msgspec.structs import replace

from tests.beams import PAIRED, cut
from verify.analytic_modes import ExactModel
from verify.errors import InputError, ResonanceError
from verify.exact import closed_forms
from verify.options import SUPPORTS
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.device import Device
from verify.problem.point_attachments import PointMass, PointSpring

# --- Exact modes ---

PAIRS = list(product(SUPPORTS, SUPPORTS))


def characteristic(supports, y):
    """The determinant of the four end conditions over e^{+-ay}, cos, sin in extended precision."""
    conditions = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}

    def row(k, x):
        e, c, s = mpmath.exp(-y * x), mpmath.cos(y * x), mpmath.sin(y * x)
        wave = [(c, s), (-s, c), (-c, -s), (s, -c)][k]
        return [*wave, (-1) ** k * e, mpmath.exp(-y * (1 - x))]

    rows = [row(k, 0) for k in conditions[supports[0]]] + [row(k, 1) for k in conditions[supports[1]]]
    return mpmath.det(mpmath.matrix(rows))


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
@pytest.mark.parametrize("mode", [1, 2, 3, 7, 23])
def test_every_root_solves_its_characteristic_equation_to_rounding(supports, mode):
    found = closed_forms.wavenumber_length(supports, mode)
    with mpmath.workdps(40):
        root = mpmath.findroot(lambda y: characteristic(supports, y), mpmath.mpf(found))
    assert found == pytest.approx(float(root), rel=4e-16)


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_shapes_are_orthonormal_and_meet_their_ends(titanium_strip, supports):
    beam = replace(titanium_strip, supports=supports)
    points, weights = np.polynomial.legendre.leggauss(16)
    cell = beam.length / 60
    x = (np.arange(60)[:, None] * cell + (points + 1) / 2 * cell).ravel()
    mass = np.tile(weights / 2 * cell, 60) * beam.mass_per_length
    modes = ExactModel(beam).modes(30)
    shapes = modes.deflection(x)
    assert abs(shapes * mass @ shapes.T - np.eye(30)).max() < 5e-14
    conditions = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
    for end, support in zip((0.0, beam.length), supports, strict=True):
        for k in conditions[support]:
            size = abs(modes.shapes(x, k)).max(axis=1)
            assert (abs(modes.shapes(np.array([end]), k)[:, 0]) < 2e-14 * size).all()


@pytest.mark.parametrize("mode", [22, 401, 99_991])
def test_shapes_of_high_modes_are_exact_to_the_rounding_of_their_phase(titanium_strip, mode):
    x = np.array([0.0731, 0.3172, 0.69])
    with mpmath.workdps(40):
        exact = [mpmath.sin(mode * mpmath.pi * mpmath.mpf(xi / titanium_strip.length)) for xi in x]
    scale, rounding = np.sqrt(2.0 / (titanium_strip.mass_per_length * titanium_strip.length)), mode * np.pi * 2.2e-16
    found = ExactModel(titanium_strip).mode_shape(mode, x)
    assert found / scale == pytest.approx([float(v) for v in exact], abs=3.0 * rounding)
    arm = replace(titanium_strip, supports=("clamped", "free"))
    tip = ExactModel(arm).mode_shape(mode, arm.length)[0]
    assert abs(tip) == pytest.approx(2 / np.sqrt(arm.mass_per_length * arm.length), rel=3.0 * rounding)


def test_mode_22_of_the_papers_beam_by_three_theories(paper_beam):
    by_hand = (22 * np.pi) ** 2 / (2 * np.pi * 0.25) * np.sqrt(70e9 / 2700 / 12) * 1e-3
    assert closed_forms.frequency_hz(paper_beam, 22) == pytest.approx(by_hand, rel=1e-14)
    b2 = (22 * np.pi * 0.001 / 0.5) ** 2 / 12
    assert closed_forms.frequency_hz(paper_beam, 22, "rayleigh") == pytest.approx(by_hand / np.sqrt(1 + b2), rel=1e-14)
    assert closed_forms.frequency_hz(paper_beam, 22, "timoshenko") == pytest.approx(4455.11, abs=0.005)


def test_timoshenkos_frequency_solves_the_equations_of_motion(titanium_strip):
    """Shear and moment balance of a sine, a 2x2 eigenproblem, in extended precision."""
    beam, mode = titanium_strip, 13
    with mpmath.workdps(40):
        k = mode * mpmath.pi / beam.length
        e_i, rho_a = mpmath.mpf(beam.bending_stiffness), mpmath.mpf(beam.mass_per_length)
        rho_i = mpmath.mpf(beam.density) * beam.own.second_moment
        shear = mpmath.mpf(5) / 6 * beam.youngs_modulus / (2 * (1 + mpmath.mpf(beam.poissons_ratio))) * beam.own.area
        stiffness = mpmath.matrix([[shear * k**2, -shear * k], [-shear * k, e_i * k**2 + shear]])
        trace = stiffness[0, 0] / rho_a + stiffness[1, 1] / rho_i
        det = mpmath.det(stiffness) / (rho_a * rho_i)
        omega2 = trace / 2 - mpmath.sqrt(trace**2 / 4 - det)
        expected = float(mpmath.sqrt(omega2) / (2 * mpmath.pi))
    assert closed_forms.frequency_hz(beam, mode, "timoshenko") == pytest.approx(expected, rel=1e-13)


def test_what_has_no_closed_form_is_refused(titanium_strip):
    clamped = replace(titanium_strip, supports=("clamped", "pinned"))
    with pytest.raises(InputError, match="use euler-bernoulli"):
        closed_forms.frequency_hz(clamped, 3, "rayleigh")
    with pytest.raises(InputError, match="mode = 0"):
        closed_forms.frequency_hz(titanium_strip, 0)
    with pytest.raises(InputError, match="n_modes = 0"):
        ExactModel(titanium_strip).modes(0)
    with pytest.raises(InputError, match=r"x = 0\.74 lies off the beam"):
        ExactModel(titanium_strip).modes(2).deflection([0.1, 0.74])


LONG = Beam(length=0.42, width=0.03, thickness=0.004, youngs_modulus=71e9, density=2710.0, supports=("clamped", "free"))
WORK = [
    (LONG, "euler-bernoulli", 1.5e-5),
    (LONG, "timoshenko", 6e-4),
    (replace(LONG, section=(Section(length=0.22), Section(length=0.2, thickness=0.003))), "euler-bernoulli", 9e-4),
]


@pytest.mark.parametrize("mode", [0, -3, 2.5, "2", None, 10**31, 10**400])
def test_a_mode_that_is_none_or_beyond_all_formulas_is_refused(mode):
    for beam in (WORK[0][0], WORK[2][0]):
        for verb in (ExactModel(beam).frequency_hz, lambda mode, beam=beam: ExactModel(beam).mode_shape(mode, 0.1)):
            with pytest.raises(InputError, match="mode = "):
                verb(mode)


# --- Exact shapes ---

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
    modes = ExactModel(beam, theory).modes(12)
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
    own, omega = plain.own, 2 * np.pi * ExactModel(plain, "timoshenko").frequency_hz(2)
    end = np.array([0.0])
    w, slope, bend, third = (ExactModel(plain, "timoshenko").mode_shape(2, end, d)[0] for d in range(4))
    assert abs(w) < 1e-15
    c, b = 1 / own.shear_stiffness, 1 / own.bending_stiffness
    p, q = -own.rotary_inertia * omega**2, own.mass_per_length * omega**2
    force = -slope / c  # psi = 0
    assert third == pytest.approx(b * force - c * q * slope, rel=1e-12)
    assert slope > 0
    assert bend == pytest.approx(ExactModel(plain, "timoshenko").mode_shape(2, end + 1e-13, 2)[0], rel=1e-9)
    assert p < 0


def test_moments_and_forces_balance_over_what_is_fixed():
    """EI w'' rises by (k_r - J omega^2) w', EI w''' falls by (k - m omega^2) w; EI w'' goes on over a step."""
    mode, omega = 5, 2 * np.pi * ExactModel(BAR).frequency_hz(5)

    def at(x, derivative):
        return ExactModel(BAR).mode_shape(mode, np.array([x]), derivative)[0]

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
    assert ExactModel(beam).mode_shape(2, x) == pytest.approx(sine, abs=3e-3 * abs(sine).max())
    near = ExactModel(beam).mode_shape(2, np.array([0.0, layer, 8 * layer]), 1)
    assert abs(near[0]) < 1e-14 * near[2]
    assert near[1] / near[2] == pytest.approx(1 - np.exp(-1), rel=0.02)


def test_two_strips_that_nearly_mirror_each_other_have_shapes_of_their_own():
    """A pair 2.4e-7 apart: even and odd, orthogonal."""
    x = np.linspace(0.01, 0.19, 9)
    for mode in (4, 5):
        here, there = (ExactModel(PAIRED).mode_shape(mode, places) for places in (x, 0.7 - x))
        parity = np.sign(here @ there)
        assert here == pytest.approx(parity * there, abs=1e-5 * abs(here).max())
    pair = ExactModel(PAIRED).modes(5).deflection(np.concatenate([x, 0.7 - x]))[3:]
    assert pair[0, :9] @ pair[1, :9] == pytest.approx(-(pair[0, 9:] @ pair[1, 9:]), rel=1e-4)


# --- Exact fields ---

BAR_EXACT_FIELDS = Beam(
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
            found = ExactModel(beam, theory).harmonic([PointForce(position=0.4, amplitude=7.0)], hertz)
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
        found = ExactModel(replace(beam, tension=part * euler)).harmonic(force, 1e-7).deflection(middle)
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
    found = ExactModel(beam).harmonic([PointForce(position=4.3)], 1e-8).deflection(4.3 + x)
    expected = rate / 2 / beam.foundation * np.exp(-rate * x) * (np.cos(rate * x) + np.sin(rate * x))
    assert found == pytest.approx(expected, rel=1e-11)


def test_a_free_beam_that_nothing_holds_answers_as_a_rigid_body():
    """Slowly driven off its centre: -F / omega^2 (1 / m + (x - c)(a - c) / J), with its body and its steps."""
    beam = replace(BAR_EXACT_FIELDS, supports=("free", "free"), spring=(), foundation=0.0, loss_factor=0.0)
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


def test_springs_foundation_and_tension_lose_nothing_and_the_beam_all():
    """Power in, F v / 2, is eta omega / 2 times the integral of EI w''^2: what is lost in bending alone."""
    beam = replace(BAR_EXACT_FIELDS, tension=2e5)
    field = ExactModel(beam).harmonic(FORCES, 730.0)
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
    beam = replace(BAR_EXACT_FIELDS, loss_factor=0.0)
    resonance = ExactModel(beam, theory).frequency_hz(4)
    with pytest.raises(ResonanceError, match="of mode 4 of the analytic model"):
        ExactModel(beam, theory).harmonic(FORCES, resonance * (1 + 3e-10))
    nan = ExactModel(beam, theory).receptance([0.2], np.array([resonance, 1.01 * resonance]), np.array([0.3]))
    assert np.isnan(nan[0]).all()
    assert np.isfinite(nan[1]).all()
    sides = [
        ExactModel(beam, theory).harmonic(FORCES[:1], resonance * (1 + side * 1e-7)).deflection([0.61])[0].real
        for side in (-1, 1)
    ]
    assert sides[0] / sides[1] == pytest.approx(-1.0, rel=1e-4)


def test_resonances_of_a_beam_with_devices_and_held_at_imposed_displacements_are_refused():
    beam, force = replace(BAR_EXACT_FIELDS, loss_factor=0.0), PointForce(position=0.07)
    device = Device(position=0.5, mass=0.2, stiffness=4e5, rotational=300.0)
    laden = replace(
        beam,
        mass=(*beam.mass, PointMass(position=0.5, mass=0.2)),
        spring=(*beam.spring, PointSpring(position=0.5, stiffness=4e5, rotational=300.0)),
    )
    resonance = ExactModel(laden).frequency_hz(3)
    with pytest.raises(ResonanceError, match="of mode 3 of the analytic model with its devices"):
        ExactModel(beam).harmonic(force, resonance * (1 + 5e-10), devices=device)
    ExactModel(beam).harmonic(force, resonance * (1 + 3e-9), devices=device)
    drive = PointForce(position=0.61, amplitude=1e-6)
    held = replace(
        beam, supports=("clamped", "pinned"), mass=(beam.mass[0], PointMass(position=0.61, rotary_inertia=2e-5))
    )
    resonance = ExactModel(held).frequency_hz(2)
    with pytest.raises(ResonanceError, match="of mode 2"):
        ExactModel(beam).imposed(drive, resonance * (1 - 5e-10))
    ExactModel(beam).imposed(drive, resonance * (1 - 3e-9))


def test_a_dashpot_on_a_node_leaves_a_resonance_undamped(titanium_strip):
    model, middle = ExactModel(titanium_strip), titanium_strip.length / 2
    resonance, force = model.frequency_hz(2), PointForce(position=0.1)
    with pytest.raises(ResonanceError, match="of mode 2"):
        model.harmonic(force, resonance, devices=Device(position=middle, dashpot=3.0))
    model.harmonic(force, resonance, devices=Device(position=0.9 * middle, dashpot=3.0))
