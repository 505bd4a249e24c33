"""Figures of the theory page and of the limits that no gate prints, each from its formula as the page has it."""

from pathlib import Path

import numpy as np
import pytest
from msgspec.structs import replace
from scipy.linalg import eigh
from verify.quantities.catalogue import QUANTITIES, arguments_of, evaluate
from verify.run.runner import workbench_for

from verify import Beam, analytic_modes, fem_beam, load_scene, segment_model
from verify.elements.mesh import build_elements
from verify.elements.pencil import element_pencil
from verify.segments.assembly import build_chain, chain_pencil
from verify.waves.absorber import ending, reflection

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
    end = ending(BEAM, 4276.0, 0.0, "free")
    own = end.own
    angle = np.angle(own)
    assert abs(angle) == pytest.approx(np.pi / 4, rel=1e-9)
    for s in (0.4, 1.0, 2.0, 3.7):
        left = np.sqrt((s**2 - 2 * s * np.cos(angle) + 1) / (s**2 + 2 * s * np.cos(angle) + 1))
        alone, matched = s * abs(own), s * own.real - 1j * own.imag
        assert reflection(alone, end) == pytest.approx(abs((alone - own.conjugate()) / (alone + own)), rel=1e-12)
        assert reflection(alone, end) == pytest.approx(left, rel=1e-9)
        assert reflection(matched, end) == pytest.approx(abs(s - 1) / (s + 1), abs=1e-12)
    assert reflection(abs(own), end) == pytest.approx(np.tan(abs(angle) / 2), rel=1e-9)
    assert [f"{reflection(s * abs(own), end):.3f}" for s in (1.0, 2.0)] == ["0.414", "0.527"]


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


ENDS = ("pinned", "clamped", "guided", "free")
PAIRS = [pair for i, one in enumerate(ENDS) for pair in ((one, other) for other in ENDS[i:])]
COUNTS = (1, 2, 3, 4, 5, 8, 9, 13, 40)


def highest(pencil):
    """The square root of the largest eigenvalue of the assembled matrices: of parts of length 1."""
    strain = np.asarray(pencil.strain(np.eye(pencil.n)))
    mass = pencil.mass_matrix()
    stiffness = strain.T @ (pencil.stiffness[:, None] * strain)
    return np.sqrt(eigh(stiffness, mass.toarray() if hasattr(mass, "toarray") else mass, eigvals_only=True)[-1])


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_the_highest_frequency_of_links_is_at_most_root_48_and_that_between_guided_ends(supports):
    assert r"is at most $\sqrt{48}$ for a uniform chain of equal links, between any supports" in THEORY
    assert "guided at both ends it is just that, elsewhere less" in THEORY
    beam = replace(BEAM, supports=supports)
    walls = ("gregory", "half", "welded", "third-order", "five-joint") if "clamped" in supports else ("gregory",)
    for wall in walls:
        found = [highest(chain_pencil(build_chain(beam, count, wall=wall))) for count in COUNTS[1:]]
        if supports == ("guided", "guided"):
            assert found == pytest.approx([np.sqrt(48.0)] * len(found), rel=1e-9)
        else:
            assert max(found) < 0.99999 * np.sqrt(48.0)


@pytest.mark.parametrize("supports", PAIRS, ids="-".join)
def test_the_highest_frequency_of_elements_is_bounded_where_no_end_is_free_and_by_one_element_everywhere(supports):
    assert (
        r"at most $\sqrt{2520} = 50.2$ where no end is free (pinned at both ends just that, elsewhere less)" in THEORY
    )
    assert r"What holds for any number, between any supports, is $\sqrt{8400} = 91.7$ of one free element" in THEORY
    counts = [count for count in COUNTS if supports != ("clamped", "clamped") or count > 1]
    beam = replace(BEAM, supports=supports)
    found = np.array([highest(element_pencil(build_elements(beam, count))) for count in counts])
    assert (found < np.sqrt(8400.0) * (1.0 + 1e-9)).all()
    if supports == ("pinned", "pinned"):
        assert found == pytest.approx(np.full(len(found), np.sqrt(2520.0)), rel=1e-9)
    elif "free" not in supports:
        assert (found < 0.99999 * np.sqrt(2520.0)).all()


@pytest.mark.parametrize("other", ENDS)
def test_a_free_end_takes_the_highest_frequency_of_elements_to_59_88_from_below_or_above(other):
    assert "A free end takes it to 59.88 as elements grow in number" in THEORY
    assert "(70.1, 62.3, 60.6 with 1, 2, 3 elements) and where both are free (91.7, 70.1, 64.6)" in THEORY
    assert "so that 60 holds there from 5 and from 9 elements on" in THEORY
    beam = replace(BEAM, supports=(other, "free"))
    found = [highest(element_pencil(build_elements(beam, count))) for count in range(1, 12)]
    least = {"pinned": 5, "free": 9}.get(other, 1)
    assert [count for count, value in enumerate(found, 1) if value < 60.0] == list(range(least, 12))
    rising = other in ("clamped", "guided")
    assert (np.diff(found) > 0.0).all() if rising else (np.diff(found) < 0.0).all()
    first = {"pinned": [70.1, 62.3, 60.6], "free": [91.7, 70.1, 64.6]}
    if not rising:
        assert [round(float(value), 1) for value in found[:3]] == first[other]
    assert highest(element_pencil(build_elements(beam, 40))) == pytest.approx(59.88, abs=0.005)


def test_orders_under_tension_are_those_of_links_that_a_clamped_end_s_layer_is_long_for():
    """A steel strip of 1.4 m, a hundred layers long: 50 links are two layers long each, 400 a quarter of one."""
    page = " ".join((DOCS / "your-beam.md").read_text("utf-8").split())
    assert "with links of two such layers is 0.50 % off with them, 0.13 % in series" in page
    assert "with links of a quarter of one 7.2e-6 and 2.4e-5" in page
    strip = Beam(
        length=1.4, width=0.016, thickness=4e-4, youngs_modulus=200e9, density=7800.0, supports=("pinned", "clamped")
    )
    taut = replace(strip, tension=strip.bending_stiffness * (100.0 / 1.4) ** 2)
    exact = analytic_modes.solve_modes(taut, 1).frequencies_hz[0]

    def off(count, joints):
        return abs(segment_model.solve_modes(taut, 1, count, joints=joints).frequencies_hz[0] / exact - 1.0)

    assert [f"{100 * off(50, joints):.2f}" for joints in ("tensioned", "series")] == ["0.50", "0.13"]
    assert [f"{off(400, joints):.1e}" for joints in ("tensioned", "series")] == ["7.2e-06", "2.4e-05"]
    taut = replace(strip, tension=strip.bending_stiffness * (20.0 / 1.4) ** 2)  # twenty layers
    exact = analytic_modes.solve_modes(taut, 1).frequencies_hz[0]
    assert "one of twenty layers 2.6 % and 0.44 %, then 3.9e-5 and 1.8e-4" in page
    assert [f"{100 * off(10, joints):.2g}" for joints in ("tensioned", "series")] == ["2.6", "0.44"]
    assert [f"{off(80, joints):.1e}" for joints in ("tensioned", "series")] == ["3.9e-05", "1.8e-04"]
