"""Hermite elements and scikit-fem; elements with shear."""

import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace
from numpy.polynomial import Polynomial

from tests.reference.transfer import frequency_near, state
from verify.elements.stock import stock_frequency_hz
from verify.errors import InputError
from verify.fem_beam import HermiteModel
from verify.problem.beam import Beam, PointForce
from verify.problem.cross_section import Section
from verify.problem.point_attachments import PointMass, PointSpring

# --- Scikit fem ---

PAPER = Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)
STRIP = Beam(length=0.43, width=0.017, thickness=0.0013, youngs_modulus=113e9, density=4470.0)
STEPS = (Section(length=0.16), Section(length=0.04, thickness=0.0031), Section(length=0.23, youngs_modulus=61e9))
STEPPED = replace(STRIP, section=STEPS, supports=("clamped", "guided"))
FORCES = [PointForce(position=0.0137), PointForce(position=0.2911, amplitude=0.7, phase_deg=63.0)]


def works():
    """Everything the model is asked for, by name."""
    return {
        "modes": lambda: HermiteModel(STRIP, 23).modes(5).frequencies_hz,
        "modes of many elements": lambda: HermiteModel(STEPPED, 300, grading=1.4).modes(5).frequencies_hz,
        "field": lambda: HermiteModel(STRIP, 23).harmonic(FORCES, 777.0).deflection([0.1417]),
        "unit responses": lambda: HermiteModel(STRIP, 23).receptance([0.1], np.array([777.0]), np.array([0.1417])),
        "motion on equal elements": lambda: HermiteModel(STRIP, 23).time_basis().omegas,
        "motion on a stepped beam": lambda: HermiteModel(STEPPED, 23).time_basis().omegas,
    }


def raising(*_, **__):
    raise ZeroDivisionError("scikit-fem's is gone")


@pytest.mark.parametrize("work", works())
@pytest.mark.parametrize("form", ["bending", "inertia"])
def test_without_scikit_fems_assembly_there_is_no_model(form, work, monkeypatch):
    from verify.elements import element

    monkeypatch.setattr(getattr(element, form), "_kernel", raising)
    with pytest.raises(ZeroDivisionError):
        works()[work]()


@pytest.mark.parametrize("beam", [PAPER, STRIP, replace(STRIP, supports=("clamped", "free"))], ids=str)
@pytest.mark.parametrize(("count", "least", "most"), [(49, 1e-13, 1e-9), (400, 3e-11, 1e-6), (3000, 3e-7, 3e-3)])
def test_scikit_fems_own_element_loses_digits_with_the_size(beam, count, least, most):
    """Mode 1 of the paper's beam: 1e-11, 7e-9, 3e-5. Rounding, so that the bands are wide; it grows about like N^4."""
    off = stock_frequency_hz(beam, 1, count) / HermiteModel(beam, count).modes(1).frequencies_hz[0] - 1
    assert least < abs(off) < most


# --- Timoshenko elements ---

STRIP_TIMOSHENKO_ELEMENTS = Beam(length=0.43, width=0.017, thickness=0.013, youngs_modulus=113e9, density=4470.0)
L, EI, MASS = (
    STRIP_TIMOSHENKO_ELEMENTS.length,
    STRIP_TIMOSHENKO_ELEMENTS.bending_stiffness,
    STRIP_TIMOSHENKO_ELEMENTS.mass_per_length * STRIP_TIMOSHENKO_ELEMENTS.length,
)
STOCKY = {
    "clamped and pinned": replace(STRIP_TIMOSHENKO_ELEMENTS, supports=("clamped", "pinned")),
    "a cantilever": replace(STRIP_TIMOSHENKO_ELEMENTS, supports=("clamped", "free")),
    "free and thick": replace(STRIP_TIMOSHENKO_ELEMENTS, supports=("free", "free"), thickness=0.06),
    "guided and clamped": replace(STRIP_TIMOSHENKO_ELEMENTS, supports=("guided", "clamped"), thickness=0.03),
    "everything": replace(
        STRIP_TIMOSHENKO_ELEMENTS,
        supports=("clamped", "guided"),
        foundation=900 * EI / L**4,
        mass=(PointMass(position=0.2 * L, mass=0.3 * MASS, rotary_inertia=0.01 * MASS * L**2),),
        spring=(PointSpring(position=0.6 * L, stiffness=300 * EI / L**3, rotational=9 * EI / L),),
        section=(Section(length=0.4 * L), Section(length=0.6 * L, thickness=0.019)),
    ),
}


def written():
    """W and psi of the six basis functions on a cell of unit length, as polynomials written here once more."""
    x = Polynomial([0, 1])
    hermite = [(1 - x) ** 2 * (1 + 2 * x), x * (1 - x) ** 2, x**2 * (3 - 2 * x), x**3 - x**2]
    w = [*hermite, x * (1 - x) * (1 - 2 * x), x**2 - x]
    return w, [*(one.deriv() for one in hermite), 6 * (x**2 - x), 0 * x]


def integrals(functions):
    """Of all products over [0, 1], by Gauss, (6, 6)."""
    points, weights = np.polynomial.legendre.leggauss(5)
    values = np.array([one(0.5 + 0.5 * points) for one in functions])
    return (values * 0.5 * weights) @ values.T


def matrices():
    """Of w w, psi psi, psi' psi' and gamma gamma, of unit length."""
    w, psi = written()
    gamma = [one.deriv() - turn for one, turn in zip(w, psi, strict=True)]
    return [integrals(group) for group in (w, psi, [one.deriv() for one in psi], gamma)]


def discrete_hz(beam, mode, count):
    """A wave through equal elements: four unknowns to each, a Hermitian problem in 40 digits."""
    with mp.workdps(40):
        own, length, mu = beam.own, mp.mpf(beam.length) / count, mode * mp.pi / count
        across, turning, bending, shear = (
            mp.matrix([[mp.mpf(round(v * 420)) / 420 for v in row] for row in m]) for m in matrices()
        )
        stiff, heavy = mp.mpf(own.bending_stiffness), mp.mpf(own.mass_per_length)
        k = bending + shear * (own.shear_stiffness * length**2 / stiff)
        m = across + turning * (own.rotary_inertia / heavy / length**2)
        wave = mp.zeros(6, 4)
        wave[0, 0] = wave[1, 1] = wave[4, 2] = wave[5, 3] = 1
        wave[2, 0] = wave[3, 1] = mp.expj(mu)
        k, m = wave.H * k * wave, wave.H * m * wave
        inverse = mp.cholesky((m + m.H) / 2) ** -1
        square = mp.eighe(inverse * k * inverse.H, eigvals_only=True)[0]
        return mp.sqrt(square * stiff / (heavy * length**4)) / (2 * mp.pi)


def sine(beam, mode, shear=True):
    """(frequency in Hz, psi over k w) of a pinned beam: shear and moment balance of a sine, a two by two problem."""
    with mp.workdps(40):
        own, k = beam.own, mode * mp.pi / mp.mpf(beam.length)
        stiff, heavy, rotary = (mp.mpf(v) for v in (own.bending_stiffness, own.mass_per_length, own.rotary_inertia))
        if not shear:
            return mp.sqrt(stiff * k**4 / (heavy + rotary * k**2)) / (2 * mp.pi), mp.mpf(1)
        g = mp.mpf(own.shear_stiffness)
        a, b, c = heavy * rotary, heavy * (stiff * k**2 + g) + rotary * g * k**2, g * k**2 * stiff * k**2
        square = 2 * c / (b + mp.sqrt(b * b - 4 * a * c))
        return mp.sqrt(square) / (2 * mp.pi), 1 - heavy * square / (g * k**2)


@pytest.mark.parametrize("thickness", [0.0013, 0.013, 0.08])
@pytest.mark.parametrize(("count", "digits"), [(7, 5e-15), (49, 1e-14), (300, 5e-14), (2000, 2e-13)])
def test_frequencies_of_pinned_beams_are_the_discrete_dispersion_slender_or_thick(thickness, count, digits):
    beam = replace(STRIP_TIMOSHENKO_ELEMENTS, thickness=thickness)
    found = HermiteModel(beam, count, theory="timoshenko").modes(4).frequencies_hz
    off = [float(hertz / discrete_hz(beam, n + 1, count) - 1) for n, hertz in enumerate(found)]
    assert off == pytest.approx([0.0] * 4, abs=digits)


@pytest.mark.parametrize("thickness", [0.0013, 0.013, 0.08])
@pytest.mark.parametrize("theory", ["rayleigh", "timoshenko"])
def test_their_error_is_the_hermite_elements(thickness, theory):
    """mu^4 / 1440 with mu = n pi / N, slender or thick."""
    beam, count = replace(STRIP_TIMOSHENKO_ELEMENTS, thickness=thickness), 40
    found = HermiteModel(beam, count, theory=theory).modes(5).frequencies_hz
    for mode, hertz in enumerate(found, 1):
        exact = sine(beam, mode, theory == "timoshenko")[0]
        assert float(hertz / exact - 1) * 1440 / (mode * np.pi / count) ** 4 == pytest.approx(0.997, abs=0.004)


@pytest.mark.parametrize("name", STOCKY)
@pytest.mark.parametrize("theory", ["rayleigh", "timoshenko"])
def test_frequencies_are_of_order_four_from_above(name, theory):
    beam, counts = STOCKY[name], [10, 20, 40, 80]
    fine = HermiteModel(beam, 100, theory=theory).modes(5).frequencies_hz
    exact = np.array([frequency_near(beam, theory, hertz) for hertz in fine])
    found = np.array([HermiteModel(beam, n, theory=theory).modes(5).frequencies_hz / exact - 1 for n in counts])
    assert (found > 0).all()
    orders = np.log2(found[:-1] / found[1:])
    assert (orders > 3.8).all()
    assert (orders < 4.01).all()
    assert orders[-1] == pytest.approx(np.full(5, 3.995), abs=0.01)
    assert 1e-11 < found[-1].min() < found[-1].max() < 3e-6


@pytest.mark.parametrize("count", [2, 5, 49, 300])
def test_where_shear_is_stiff_the_element_is_rayleighs(count):
    """The difference goes as one over kappa G A, down to rounding."""
    stocky, modes = (
        replace(STRIP_TIMOSHENKO_ELEMENTS, thickness=0.03, supports=("clamped", "guided")),
        min(3, 2 * count - 1),
    )
    rayleigh = HermiteModel(stocky, count, theory="rayleigh").modes(modes).frequencies_hz
    off = {}
    for stiff in (1e10, 1e12, 1e40):
        sheared = HermiteModel(replace(stocky, shear_stiffness=stiff), count, theory="timoshenko").modes(modes)
        off[stiff] = sheared.frequencies_hz / rayleigh - 1
    assert (off[1e10] < -1e-5).all()
    assert off[1e12] == pytest.approx(0.01 * off[1e10], rel=1e-3)
    assert off[1e40] == pytest.approx(np.zeros(modes), abs=3e-13)


@pytest.mark.parametrize("theory", ["rayleigh", "timoshenko"])
def test_a_slender_beam_is_euler_bernoullis_less_its_two_small_terms(theory):
    """Omega falls by k^2 (I/A) / 2, and under shear by k^2 EI / (kappa G A) / 2 more."""
    beam = replace(STRIP_TIMOSHENKO_ELEMENTS, thickness=0.00013)
    plain = HermiteModel(beam, 40).modes(3).frequencies_hz
    found = HermiteModel(beam, 40, theory=theory).modes(3).frequencies_hz / plain - 1
    own, k = beam.own, np.arange(1, 4) * np.pi / L
    small = own.rotary_inertia / own.mass_per_length
    small += own.bending_stiffness / own.shear_stiffness if theory == "timoshenko" else 0.0
    assert found == pytest.approx(-0.5 * small * k**2, rel=1e-4)


@pytest.mark.parametrize("loss", [0.0, 0.03])
@pytest.mark.parametrize("name", ["everything", "free and thick"])
def test_driven_fields_are_of_order_four_with_loss_in_bending_and_shear(name, loss):
    beam = replace(STOCKY[name], loss_factor=loss)
    hertz = 1.31 * HermiteModel(beam, 40, theory="timoshenko").modes(2).frequencies_hz[1]
    x, force = np.array([0.1, 0.7, 0.95]) * L, [PointForce(position=0.4 * L)]
    exact = np.array([state(beam, "timoshenko", hertz, 0.4 * L, at)[0] for at in x])
    found = [HermiteModel(beam, n, theory="timoshenko").harmonic(force, hertz).deflection(x) for n in (20, 40, 80)]
    off = np.array([abs(one - exact).max() / abs(exact).max() for one in found])
    assert np.log2(off[:-1] / off[1:]) == pytest.approx(4.0, abs=0.1)
    assert 1e-10 < off[-1] < 3e-6
    unit = HermiteModel(beam, 40, theory="timoshenko").receptance([0.4 * L], np.array([hertz]), x)
    assert unit[0, 0] == pytest.approx(found[1], rel=1e-9)


def test_at_a_force_inside_an_element_shear_is_of_order_one():
    """Its line has a kink there, of F / (kappa G A), which no cubic has; away from it nothing is lost."""
    beam, hertz = replace(STOCKY["a cantilever"], loss_factor=0.03), 400.0
    for at, least, most in ((0.5, 0.8, 1.2), (0.8, 2.8, 4.2)):
        exact = state(beam, "timoshenko", hertz, 0.5 * L, at * L)[0]
        force = [PointForce(position=0.5 * L)]
        off = [
            abs(HermiteModel(beam, n, theory="timoshenko").harmonic(force, hertz).deflection([at * L])[0] / exact - 1)
            for n in (45, 135)
        ]
        assert least < np.log(off[0] / off[1]) / np.log(3) < most


PLAIN = Beam(length=L, bending_stiffness=EI, mass_per_length=MASS / L)


@pytest.mark.parametrize(
    ("beam", "theory", "message"),
    [
        (PLAIN, "rayleigh", "beam.rotary_inertia is missing"),
        (replace(PLAIN, rotary_inertia=1e-5), "timoshenko", "beam.shear_stiffness is missing"),
        (
            replace(STRIP_TIMOSHENKO_ELEMENTS, tension=12.0),
            "rayleigh",
            "beam.tension = 12.0 N with theory = 'rayleigh'",
        ),
        (
            replace(STRIP_TIMOSHENKO_ELEMENTS, tension=-12.0),
            "timoshenko",
            "beam.tension = -12.0 N with theory = 'timoshenko'",
        ),
    ],
)
def test_what_a_theory_lacks_is_refused_by_name(beam, theory, message):
    for work in (
        lambda: HermiteModel(beam, 20, theory=theory),
        lambda: HermiteModel(beam, 20, theory=theory).modes(1),
        lambda: HermiteModel(beam, 20, theory=theory).harmonic([PointForce(position=0.1)], 70.0),
        lambda: HermiteModel(beam, 20, theory=theory).receptance([0.1], np.array([70.0]), np.array([0.2])),
    ):
        with pytest.raises(InputError, match=message):
            work()
