"""Figures of the theory page and of the limits that no gate prints, each from its formula as the page has it."""

from pathlib import Path

import numpy as np
import pytest

from verify import analytic_modes, fem_beam, load_scene, segment_model
from verify.quantities.catalogue import QUANTITIES, arguments_of, evaluate
from verify.run.runner import workbench_for
from verify.waves.absorber import beam_impedance, reflection

DOCS = Path(__file__).parents[2] / "docs"
THEORY = " ".join((DOCS / "theory.md").read_text("utf-8").split())
LIMITS = " ".join((DOCS / "limits.md").read_text("utf-8").split())
MU = 0.05
S = np.sin(MU / 2)
BEAM = load_scene("paper").beam


def chain_error(n, count):
    mu, s = n * np.pi / count, np.sin(n * np.pi / (2 * count))
    return np.sqrt(48 * s**4 / (3 - 2 * s**2)) / mu**2 - 1


def test_the_dispersion_is_what_segments_solve_and_its_law_has_a_1440th():
    assert r"\omega^2 = \frac{48\,s^4}{3 - 2 s^2}\,\frac{EI}{\rho A\,l^4}" in THEORY
    solved = segment_model.solve_modes(BEAM, n_modes=17, n_segments=31).frequencies_hz[16]
    exact = analytic_modes.solve_modes(BEAM, n_modes=17).frequencies_hz[16]
    assert solved / exact - 1 == pytest.approx(chain_error(17, 31), rel=1e-10)
    assert r"-\frac{1}{1440}\left(\frac{n\pi}{N}\right)^4" in THEORY
    assert chain_error(1, 100) * 1440 / (np.pi / 100) ** 4 == pytest.approx(-1, rel=1e-3)


def test_without_the_links_inertia_and_with_mass_at_the_joints_the_order_is_two():
    assert r"Without it the error is $+\mu^2/24$" in THEORY
    assert 4 * S**2 / np.cos(MU / 2) / MU**2 - 1 == pytest.approx(MU**2 / 24, rel=1e-2)
    assert r"with the mass lumped at the joints it is $-\mu^2/12$" in THEORY
    lumped = 4 * S**2 / MU**2 - 1
    assert lumped == pytest.approx(-(MU**2) / 12, rel=1e-2)


def test_the_mean_of_both_is_of_order_six_with_a_10800th_and_stops_helping_at_0_696_of_the_parts():
    assert r"$-\mu^6/10800$" in THEORY
    assert "Near $n = 0.696\\,N$" in THEORY
    exact = analytic_modes.solve_modes(BEAM, n_modes=73).frequencies_hz

    def elements_error(n, count):
        return fem_beam.solve_modes(BEAM, n_modes=n, n_elements=count).frequencies_hz[n - 1] / exact[n - 1] - 1

    mean = 0.5 * (chain_error(22, 196) + elements_error(22, 196))
    assert mean * 10800 / (22 * np.pi / 196) ** 6 == pytest.approx(-1, abs=0.02)
    ratios = [-chain_error(n, 100) / elements_error(n, 100) for n in (69, 70)]
    assert ratios[0] < 3 < ratios[1]


def test_a_resistance_that_is_off_leaves_more_where_a_dashpot_stands_alone():
    """Of what stands at a free end of the paper's beam, by the definition of a reflection and by `absorber`."""
    assert r"resistance alone is off by a factor $s$ leaves $|s-1|/(s+1)$" in THEORY
    assert r"leaves $\sqrt{(s^2 - 2s\cos\varphi + 1)/(s^2 + 2s\cos\varphi + 1)}$, at a free end 0.414" in THEORY
    assert "at $s = 2$ 0.527" in THEORY
    own = beam_impedance(BEAM, 4276.0, 0.0, "free")
    angle = np.angle(own)
    assert abs(angle) == pytest.approx(np.pi / 4, rel=1e-9)
    for s in (0.4, 1.0, 2.0, 3.7):
        left = np.sqrt((s**2 - 2 * s * np.cos(angle) + 1) / (s**2 + 2 * s * np.cos(angle) + 1))
        alone, matched = s * abs(own), s * own.real - 1j * own.imag
        assert reflection(alone, own) == pytest.approx(abs((alone - own.conjugate()) / (alone + own)), rel=1e-12)
        assert reflection(alone, own) == pytest.approx(left, rel=1e-9)
        assert reflection(matched, own) == pytest.approx(abs(s - 1) / (s + 1), abs=1e-12)
    assert reflection(abs(own), own) == pytest.approx(np.tan(abs(angle) / 2), rel=1e-9)
    assert [f"{reflection(s * abs(own), own):.3f}" for s in (1.0, 2.0)] == ["0.414", "0.527"]


def shape_error(reading):
    scene, quantity = load_scene("paper"), QUANTITIES["mode.shape_error"]
    given = {"model": "segment", "mode": 7, "count": 140, "reading": reading}
    return evaluate(quantity, arguments_of(quantity, given), scene, workbench_for(scene, gates_only=True))


def test_joints_stand_off_the_line_by_a_twelfth_of_mu_squared_and_corrected_by_far_less():
    assert r"too large by $+\mu^2/12$" in THEORY
    mu = 7 * np.pi / 140
    assert shape_error("raw") == pytest.approx(mu**2 / 12, rel=0.02)
    assert 0 < shape_error("corrected") < mu**4 / 60


def test_the_buckling_load_of_the_chain_is_the_closed_form():
    assert r"P_n = \frac{4EI}{l^2}\sin^2\frac{n\pi}{2N}" in THEORY
    link = BEAM.length / 13
    law = 4 * BEAM.bending_stiffness / link**2 * np.sin(np.pi / 26) ** 2
    assert segment_model.buckling_load(BEAM, 13) == pytest.approx(law, rel=1e-10)


def test_lengths_and_heights_of_the_papers_wave():
    omega = 2 * np.pi * 4276.0
    assert "$1/k$, 7.4 mm" in THEORY
    assert 1e3 / np.sqrt(omega / BEAM.wave_constant) == pytest.approx(7.4, abs=0.05)
    assert "13.6 nm at 4276 Hz" in THEORY
    assert "13.6 nm at 4276 Hz" in LIMITS
    assert 9.81e9 / omega**2 == pytest.approx(13.6, abs=0.05)
    assert "half a wave, 22.7 mm" in LIMITS
    assert 1e3 * BEAM.length / 22 == pytest.approx(22.7, abs=0.05)


def test_a_strip_that_cannot_curve_across_its_width_is_so_much_stiffer():
    assert "a strip that stays straight across gains 5.9 %" in LIMITS
    assert 100 * (1 / np.sqrt(1 - BEAM.poissons_ratio**2) - 1) == pytest.approx(5.9, abs=0.05)
