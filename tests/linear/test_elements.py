"""Hermite elements: dispersion, orders, driven fields, buckling; with rotary inertia and shear, with attachments."""

import mpmath as mp
import numpy as np
import pytest
from msgspec.structs import replace
from numpy.polynomial import Polynomial

from tests.beams import mass, spring, supported
from tests.reference.transfer import state
from verify import Beam, ExactModel, HermiteModel, PointForce, Section, SegmentModel
from verify.elements.stock import stock_frequency_hz
from verify.errors import InputError

EULER, RAYLEIGH, TIMOSHENKO = "euler-bernoulli", "rayleigh", "timoshenko"
STRIP = Beam(length=0.43, width=0.017, thickness=0.013, youngs_modulus=113e9, density=4470.0)
L, EI = STRIP.length, STRIP.bending_stiffness
STEPS = {"section": (Section(length=0.4 * L), Section(length=0.6 * L, thickness=0.019))}
MANY_STEPS = (Section(length=0.16), Section(length=0.04, thickness=0.031), Section(length=0.23, youngs_modulus=61e9))


def on(letters, **changes):
    return supported(STRIP, letters, **changes)


PROPPED = on("CP")
ALL = {"foundation": 900 * EI / L**4, "spring": spring(STRIP, 0.6, 300, 9), "mass": mass(STRIP, 0.2, 0.3, 0.01)}
BEAMS = {
    "clamped-pinned": PROPPED,
    "cantilever": on("CF"),
    "thick and free": on("FF", thickness=0.06),
    "guided-clamped": on("GC", thickness=0.03),
    "tip body": on("CF", mass=mass(STRIP, 1.0, 0.7, 0.02)),
    "masses": on("CP", mass=mass(STRIP, 0.2, 0.3) + mass(STRIP, 0.6, 0.7)),
    "rotary inertia": on("CP", mass=mass(STRIP, 0.6, rotary=0.02)),
    "spring": on("CP", spring=spring(STRIP, 0.6, 300)),
    "rotational spring": on("CP", spring=spring(STRIP, 0.6, rotational=30)),
    "elastic clamp": on("FP", spring=spring(STRIP, 0.0, 300, 7)),
    "rotational spring on a pin": on("PP", spring=spring(STRIP, 1.0, rotational=7)),
    "foundation": on("CP", foundation=900 * EI / L**4),
    "everything": on("CG", **ALL, **STEPS),
}
TAUT = {
    "tension": on("CP", tension=23 * EI / L**2),
    "compression": on("CP", tension=-11 * EI / L**2),
    "everything in tension": on("FG", tension=9 * EI / L**2, **ALL, **STEPS),
}
CASES = [(name, EULER) for name in BEAMS | TAUT if name != "thick and free"]
CASES += [
    (name, theory)
    for name in ("clamped-pinned", "cantilever", "thick and free", "guided-clamped", "everything")
    for theory in (RAYLEIGH, TIMOSHENKO)
]


def errors(beam, counts, modes, theory=EULER, **settings):
    """Relative errors of frequencies, (counts, modes)."""
    exact = ExactModel(beam, theory).modes(modes).frequencies_hz
    models = [HermiteModel(beam, n, theory=theory, **settings) for n in counts]
    return np.array([model.modes(modes).frequencies_hz / exact - 1 for model in models])


@pytest.mark.parametrize(("name", "theory"), CASES)
def test_frequencies_are_of_order_four_from_above(name, theory):
    found = errors((BEAMS | TAUT)[name], (10, 20, 40, 80), 5, theory)
    assert (found > 0).all()
    orders = np.log2(found[:-1] / found[1:])
    assert (orders > 3.8).all()
    assert (orders < 4.01).all()
    assert orders[-1] == pytest.approx(np.full(5, 3.995), abs=0.01)
    assert 1e-12 < found[-1].min() < found[-1].max() < 3e-6


@pytest.mark.parametrize("settings", [{}, {"grading": 0.6}])
def test_elements_that_end_on_steps_are_of_order_four(settings):
    found = errors(on("CG", section=MANY_STEPS), (24, 48), 4, **settings)[:, 3]
    assert np.log2(found[0] / found[1]) == pytest.approx(4.0, abs=0.06)


@pytest.mark.parametrize(
    "added",
    [
        {"mass": mass(STRIP, 0.137, 0.7)},
        {"mass": mass(STRIP, 0.137, rotary=0.02)},
        {"spring": spring(STRIP, 0.137, 3000)},
        {"spring": spring(STRIP, 0.137, rotational=30)},
    ],
)
def test_attachments_between_the_nodes_of_equal_elements_leave_order_four(added):
    """Numbers of elements per stretch are uneven on coarse meshes: the mean order over four doublings."""
    found = errors(on("CP", **added), (20, 320), 5)
    assert np.log2(found[0] / found[1]) / 4 == pytest.approx(np.full(5, 4.01), abs=0.02)


# --- Dispersion ------------------------------------------------------------------------------------------------------


def unit_matrices():
    """Integrals of w w, w' w', psi psi, psi' psi' and gamma gamma of six functions on a cell of unit length."""
    x = Polynomial([0, 1])
    w = [
        (1 - x) ** 2 * (1 + 2 * x),
        x * (1 - x) ** 2,
        x**2 * (3 - 2 * x),
        x**3 - x**2,
        x * (1 - x) * (1 - 2 * x),
        x**2 - x,
    ]
    psi = [*(one.deriv() for one in w[:4]), 6 * (x**2 - x), 0 * x]
    gamma = [one.deriv() - turn for one, turn in zip(w, psi, strict=True)]
    points, weights = np.polynomial.legendre.leggauss(5)

    def integral(functions):
        values = np.array([one(0.5 + 0.5 * points) for one in functions])
        return mp.matrix([[mp.mpf(round(v * 420)) / 420 for v in row] for row in (values * 0.5 * weights) @ values.T])

    return [integral(f) for f in (w, [one.deriv() for one in w], psi, [one.deriv() for one in psi], gamma)]


def discrete_hz(beam, mode, count, theory):
    """A wave through equal elements, a Hermitian problem of two or four unknowns in 40 digits."""
    with mp.workdps(40):
        own, length, mu = beam.base_section, mp.mpf(beam.length) / count, mode * mp.pi / count
        across, slope, turning, bending, shear = unit_matrices()
        stiff, heavy = mp.mpf(own.bending_stiffness), mp.mpf(own.mass_per_length)
        k = bending + across * (beam.foundation * length**4 / stiff) + slope * (beam.tension * length**2 / stiff)
        m, size = across, 4 if theory == TIMOSHENKO else 2
        if theory == TIMOSHENKO:
            k += shear * (own.shear_stiffness * length**2 / stiff)
            m += turning * (own.rotary_inertia / heavy / length**2)
        wave = mp.zeros(6, size)
        wave[0, 0] = wave[1, 1] = 1
        wave[2, 0] = wave[3, 1] = mp.expj(mu)
        for i in range(2, size):
            wave[i + 2, i] = 1
        k, m = wave.H * k * wave, wave.H * m * wave
        inverse = mp.cholesky((m + m.H) / 2) ** -1
        square = mp.eighe(inverse * k * inverse.H, eigvals_only=True)[0]
        return mp.sqrt(square * stiff / (heavy * length**4)) / (2 * mp.pi)


@pytest.mark.parametrize(("count", "digits"), [(7, 4e-15), (49, 1e-14), (300, 5e-14), (2000, 2e-13)])
@pytest.mark.parametrize(
    ("theory", "change"),
    [
        (EULER, {}),
        (EULER, {"tension": 7 * EI / L**2, "foundation": 900 * EI / L**4}),
        (EULER, {"tension": -9 * EI / L**2, "foundation": 900 * EI / L**4}),
        (EULER, {"tension": -9 * EI / L**2}),
        *((TIMOSHENKO, {"thickness": thickness}) for thickness in (0.0013, 0.013, 0.08)),
    ],
)
def test_frequencies_of_pinned_beams_are_those_of_the_dispersion(theory, change, count, digits):
    beam = replace(STRIP, **change)
    found = HermiteModel(beam, count, theory=theory).modes(6 if theory == EULER else 4).frequencies_hz
    exact = [discrete_hz(beam, n + 1, count, theory) for n in range(len(found))]
    off = [float(hertz / one - 1) for hertz, one in zip(found, exact, strict=True)]
    if beam.tension < 0.0:  # bending and compression nearly cancel: rounding is relative to bending
        bending = [discrete_hz(replace(beam, tension=0.0), n + 1, count, theory) for n in range(len(found))]
        off = [one * float(hertz / most) ** 2 for one, hertz, most in zip(off, exact, bending, strict=True)]
    assert off == pytest.approx([0.0] * len(off), abs=digits if theory == EULER else max(digits, 5e-15))


@pytest.mark.parametrize("letters", ["PP", "CF"])
@pytest.mark.parametrize(("count", "least", "most"), [(49, 1e-13, 1e-9), (400, 3e-11, 1e-6), (3000, 3e-7, 3e-3)])
def test_scikit_fems_element_in_metres_loses_digits_with_the_number_of_elements(letters, count, least, most):
    """Mode 1 of the paper's beam: 1e-11, 7e-9, 3e-5, the most of four counts. Rounding, about like N^4."""
    beam, counts = on(letters, thickness=0.0013), range(count, count + 4)
    exact = [HermiteModel(beam, n).modes(1).frequencies_hz[0] for n in counts]
    off = [abs(stock_frequency_hz(beam, 1, n) / one - 1) for n, one in zip(counts, exact, strict=True)]
    assert least < max(off) < most


# --- Driven fields ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("loss", [0.0, 0.03])
@pytest.mark.parametrize(
    ("name", "theory"),
    [
        ("everything in tension", EULER),
        ("compression", EULER),
        ("elastic clamp", EULER),
        ("tip body", EULER),
        ("everything", TIMOSHENKO),
        ("thick and free", TIMOSHENKO),
    ],
)
def test_driven_fields_are_of_order_four_with_loss_in_bending_and_shear_alone(name, theory, loss):
    """Springs, axial force and foundation have no loss."""
    beam = replace((BEAMS | TAUT)[name], loss_factor=loss)
    hertz, x = 1.31 * HermiteModel(beam, 40, theory=theory).modes(2).frequencies_hz[1], np.array([0.1, 0.7, 0.95]) * L
    w, turn = np.array([state(beam, theory, hertz, 0.4 * L, at)[:2] for at in x]).T
    force = PointForce(position=0.4 * L)
    found = [HermiteModel(beam, n, theory=theory).harmonic(force, hertz) for n in (20, 40, 80)]
    off = np.array([abs(field.deflection(x) - w).max() / abs(w).max() for field in found])
    assert np.log2(off[:-1] / off[1:]) == pytest.approx(4.0, abs=0.1)
    assert 1e-10 < off[-1] < (1e-6 if theory == EULER else 3e-6)
    turned = abs(found[-1].slope(x) - turn).max() / abs(turn).max()
    assert theory == TIMOSHENKO or 1e-11 < turned < 1e-6


def test_shear_at_a_force_inside_an_element_is_of_order_one():
    """The line has a kink F / (kappa G A) at the force, cubics have none; elsewhere the order is higher."""
    beam, hertz = replace(BEAMS["cantilever"], loss_factor=0.03), 400.0
    for at, least, most in ((0.5, 0.8, 1.2), (0.8, 2.8, 4.2)):
        exact = state(beam, TIMOSHENKO, hertz, 0.5 * L, at * L)[0]
        models = (HermiteModel(beam, n, theory=TIMOSHENKO) for n in (45, 135))
        fields = [model.harmonic(PointForce(position=0.5 * L), hertz).deflection(at * L)[0] for model in models]
        off = [abs(one / exact - 1) for one in fields]
        assert least < np.log(off[0] / off[1]) / np.log(3) < most


# --- Buckling --------------------------------------------------------------------------------------------------------

WAVES = {"PP": np.pi, "CF": np.pi / 2, "CC": 2 * np.pi, "CP": 4.493409457909064, "GG": np.pi}


@pytest.mark.parametrize("letters", WAVES)
def test_elements_buckle_above_eulers_load_by_mu4_over_720(letters):
    """mu: wave number of the buckled shape times the length of an element."""
    off = {n: HermiteModel(on(letters), n).buckling_load() * L**2 / EI / WAVES[letters] ** 2 - 1 for n in (10, 20)}
    for count, error in off.items():
        assert error == pytest.approx((WAVES[letters] / count) ** 4 / 720, rel=0.1)
    assert 3.85 < np.log2(off[10] / off[20]) < 4.01


def test_compression_up_to_the_buckling_of_the_mesh_is_solved_and_refused_beyond():
    load = HermiteModel(PROPPED, 20).buckling_load()
    below = HermiteModel(replace(PROPPED, tension=-0.9999 * load), 20).modes(1).frequencies_hz[0]
    assert below == pytest.approx(0.01 * HermiteModel(PROPPED, 20).modes(1).frequencies_hz[0], rel=0.05)
    beyond = HermiteModel(replace(PROPPED, tension=-1.0001 * load), 20)
    for work in (
        lambda: beyond.modes(1),
        lambda: beyond.harmonic([PointForce(position=0.1)], 70.0),
        lambda: beyond.receptance([0.1], np.array([70.0]), np.array([0.2])),
        beyond.time_basis,
    ):
        with pytest.raises(InputError, match=r"exceeds the buckling load [0-9.]+ N of 20 elements"):
            work()


def test_elements_carry_waves_up_to_a_half_wave_each_on_the_worst_section():
    """By the fastest waves of elements in closed form; softer with shear, lower on a section of half the thickness."""
    beam = Beam(length=0.43, width=0.019, thickness=0.003, youngs_modulus=113e9, density=4470.0, poissons_ratio=0.31)
    model = HermiteModel(beam, 11)
    assert model.cut_off_hz == pytest.approx((1680 / 17) ** 0.5 * beam.wave_constant / (2 * np.pi * model.unit**2))
    assert model.wavenumber(model.cut_off_hz * (1 - 1e-9)) * model.unit == pytest.approx(np.pi, abs=1e-4)
    assert 0.9 < HermiteModel(beam, 11, theory="timoshenko").cut_off_hz / model.cut_off_hz < 0.999
    stepped = replace(beam, section=(Section(length=0.23), Section(length=0.2, thickness=0.0015)))
    for kind in (HermiteModel, SegmentModel):
        assert kind(stepped, 43).cut_off_hz == pytest.approx(0.5 * kind(beam, 43).cut_off_hz)
