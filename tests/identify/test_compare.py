"""Other people's models told what they are, from their frequencies alone."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from other_models import links_without_inertia, lumped_elements, lumped_rod, printed_chain, rigid_links

from verify import analytic_modes
from verify.cli import status_of
from verify.elements.linear import solve_modes as fem_modes
from verify.errors import InputError
from verify.exact.closed_forms import frequency_hz
from verify.exact.modes import exact_frequency_hz
from verify.identify.compare import Asked, check_patience, compare
from verify.identify.matrices import chain
from verify.scenes.scene import load_scene
from verify.segments.linear import solve_modes as segment_modes

DATA = Path(__file__).parent / "data"
CLAMPED_PINNED = ('beam.supports=["clamped","pinned"]',)


@cache
def scene(name, *overrides):
    return load_scene(name, overrides)


@pytest.fixture
def told(tmp_path):
    """What is said of a list of frequencies, as plain data."""

    def call(frequencies, of="steel-cantilever", overrides=(), **asked):
        path = tmp_path / "list.csv"
        path.write_text("\n".join(repr(float(f)) for f in frequencies))
        found = compare(scene(of, *overrides), Asked(frequencies=path, **asked))
        return found.plain()

    return call


def recorded(name, of, **asked):
    return compare(scene(of), Asked(frequencies=DATA / name, **asked)).plain()


def analytic_hz(beam, n):
    return analytic_modes.solve_modes(beam, n).frequencies_hz


def kinds(found):
    return [one["kind"] for one in found["told"]]


def chosen(found, *names):
    return tuple(found["best"][name] for name in names)


CANTILEVER = scene("steel-cantilever").beam
PAPER = scene("paper").beam


# --- recorded from other packages ---------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [30, None])
def test_an_exudyn_cantilever_follows_the_rule_of_a_rigid_neighbour_at_the_wall(count):
    found = recorded("exudyn-cantilever.csv", "steel-cantilever", count=count)
    assert chosen(found, "model", "wall", "joints", "mass", "theory", "order", "count") == (
        "segment",
        "half",
        "series",
        "links",
        "euler-bernoulli",
        2,
        30,
    )
    assert found["answer"].startswith("Your chain follows the 2EI/l rule at the wall, order 2; 89 links for 0.1 %")
    assert found["best"]["residual"] < 1e-8
    assert found["modes"][7]["error"] == pytest.approx(-0.008887, abs=1e-6)
    assert found["passed"]


def test_shapes_pair_the_modes_of_the_exudyn_cantilever():
    found = recorded(
        "exudyn-cantilever.csv", "steel-cantilever", count=30, shapes=DATA / "exudyn-cantilever-shapes.csv"
    )
    assert [row["mode"] for row in found["modes"]] == list(range(1, 9))
    assert min(row["likeness"] for row in found["modes"]) == pytest.approx(0.9963, abs=1e-4)
    assert found["passed"]


def test_a_mujoco_chain_of_the_papers_beam_has_the_papers_links(told):
    found = recorded("mujoco-paper.tsv", "paper", count=49)
    assert found["unit"] == "rad/s"
    assert chosen(found, "model", "wall", "joints", "mass", "order") == ("segment", None, "series", "links", 4)
    assert found["modes"][21]["error"] == pytest.approx(-0.00428024, abs=5e-8)
    assert found["parts_needed"]["count"] == 68
    assert found["passed"]


def test_a_rod_of_pyelastica_is_known_by_its_lumped_mass_and_its_shear():
    found = recorded("pyelastica-paper.txt", "paper", count=49)
    assert chosen(found, "model", "mass", "theory", "order") == ("segment", "joints", "timoshenko", 2)
    assert "rod" in found["best"]["words"]
    assert found["modes"][21]["error"] == pytest.approx(-0.157552, abs=2e-6)
    assert found["certainty"]["told_apart"]


# --- written down independently -----------------------------------------------------------------------------------


def test_a_lumped_mass_rod_is_of_order_2_and_far_off_at_mode_22(told):
    found = told(lumped_rod(PAPER, 49)[:22], "paper", count=49)
    assert chosen(found, "model", "mass", "theory", "order") == ("segment", "joints", "euler-bernoulli", 2)
    assert found["modes"][21]["error"] == pytest.approx(-0.15518, abs=1e-5)
    assert found["certainty"]["told_apart"]
    assert found["parts_needed"]["better_count"] == 68


def test_links_without_inertia_are_of_order_2_too_and_lie_above(told):
    found = told(links_without_inertia(PAPER, 49)[:22], "paper", count=49)
    assert chosen(found, "mass", "order") == ("points", 2)
    assert all(row["error"] > 0.0 for row in found["modes"])


@pytest.mark.parametrize(
    ("rotary", "mass", "order"), [(0.0, "lumped", 4), (1 / 24, "lumped-rotary", 2), (1 / 78, "hrz", 2)]
)
def test_elements_with_lumped_mass_are_told_from_each_other_and_from_every_chain(told, rotary, mass, order):
    beam = scene("steel-cantilever", *CLAMPED_PINNED).beam
    found = told(lumped_elements(beam, 25, rotary)[:9], overrides=CLAMPED_PINNED, count=25)
    assert chosen(found, "model", "mass", "order", "wall") == ("fem", mass, order, None)
    assert found["certainty"]["told_apart"]
    assert found["certainty"]["next_over_best"] > 1e3


def test_on_a_cantilever_lumped_elements_have_the_frequencies_of_the_chain_with_2ei_l(told):
    """A duality: moments of the one are deflections of the other seen from the far end. No list can tell them apart."""
    found = told(lumped_elements(CANTILEVER, 30)[:8], count=30)
    assert chosen(found, "model", "wall") == ("segment", "half")
    assert [one["mass"] for one in found["certainty"]["alike"]] == ["lumped"]
    assert (
        "no list can tell it from cubic Hermite elements with mass lumped at the nodes with N = 30" in found["answer"]
    )
    built = told(lumped_elements(CANTILEVER, 30)[:8], count=30, kind="elements")
    assert chosen(built, "model", "mass") == ("fem", "lumped")


def test_nineteen_links_do_what_sixty_nine_do_with_2ei_l(told):
    chain = np.loadtxt(DATA / "exudyn-cantilever.csv", delimiter=",", skiprows=1)[:5, 1]
    found = told(chain, count=30)
    assert found["answer"].startswith(
        "Your chain follows the 2EI/l rule at the wall, order 2; 69 links for 0.1 % at mode 5 "
        "(19 with Gregory's weights 3/8, 7/6, 23/24 at the wall)."
    )


def test_eq_1_as_printed_is_found_on_a_stepped_beam(told):
    beam = scene("stepped-beam").beam
    pieces = [(p.length, p.youngs_modulus, p.second_moment, p.mass_per_length) for p in beam.pieces]
    found = told(printed_chain(pieces, beam.supports, (20, 28))[:8], "stepped-beam", count=48)
    assert chosen(found, "model", "wall", "joints", "order") == ("segment", "half", "printed", 1)
    assert "takes Eq. (1) as printed" in found["answer"]
    assert found["certainty"]["told_apart"]


# --- bodies that fall anywhere within a link, sections that share the parts ----------------------------------------


def arm(place, mass, rotary=0.0):
    return scene("steel-cantilever", f"beam.mass=[{{position={place!r}, mass={mass!r}, rotary_inertia={rotary!r}}}]")


@pytest.mark.parametrize("drawn", range(8))
def test_a_chain_with_a_body_is_found_at_its_size_without_being_told(told, tmp_path, drawn):
    """The error of a body on a rigid link goes up and down with N; whatever the beam, the size is found again."""
    random = np.random.default_rng(700 + drawn)
    attachment, wall = ("lever", "reciprocal")[drawn % 4 == 3], ("half", "gregory")[drawn // 4]
    beam = scene("steel-cantilever").beam
    whole = sum(piece.mass_per_length * piece.length for piece in beam.pieces)
    rotary = 0.0 if drawn % 2 else 1e-4 * whole * beam.length**2
    of = arm(float(random.uniform(0.15, 0.9) * beam.length), float(random.uniform(0.2, 1.5) * whole), rotary)
    count = int(random.integers(15, 220))
    given = segment_modes(of.beam, 8, n_segments=count, attachment=attachment, wall=wall).frequencies_hz
    path = tmp_path / "list.csv"
    path.write_text("\n".join(repr(float(f)) for f in given))
    found = compare(of, Asked(frequencies=path, mode=1, error=0.5)).plain()
    assert chosen(found, "model", "wall", "count") == ("segment", wall, count)
    assert found["best"]["residual"] < 1e-8
    assert ("links as they are" in found["answer"]) == (attachment == "lever")
    assert not found["told"]
    assert found["passed"]


def test_a_chain_on_an_elastic_clamp_is_found_with_its_wall(told):
    beam = scene("instrument-arm").beam
    for settings in ({"attachment": "lever"}, {"wall": "half"}):
        given = segment_modes(beam, 8, n_segments=49, **settings).frequencies_hz
        found = told(given, "instrument-arm", mode=1, error=0.5)
        assert found["best"]["count"] == 49
        assert found["best"]["residual"] < 1e-8
        assert found["best"]["wall"] == settings.get("wall")
        assert not found["told"]


def test_such_a_chain_in_another_unit_is_found_too(told):
    beam = arm(0.21, 0.03).beam
    given = 2 * np.pi * segment_modes(beam, 8, n_segments=41, attachment="lever").frequencies_hz
    body = ("beam.mass=[{position=0.21, mass=0.03}]",)
    found = told(given, "steel-cantilever", body, mode=1, error=0.5)
    assert kinds(found) == ["unit"]
    assert (found["best"]["count"], found["best"]["residual"] < 1e-8) == (41, True)


@pytest.mark.parametrize(("settings", "count"), [({}, 37), ({"joints": "printed"}, 61)])
def test_a_stepped_chain_is_found_at_its_size(told, settings, count):
    given = segment_modes(scene("stepped-beam").beam, 8, n_segments=count, **settings).frequencies_hz
    found = told(given, "stepped-beam", mode=1, error=0.5)
    assert found["best"]["count"] == count
    assert found["best"]["residual"] < 1e-8
    assert not found["told"]


def test_parts_needed_of_a_body_on_its_link_hold_for_larger_numbers_too(told):
    of = arm(0.2113, 0.05)
    given = segment_modes(of.beam, 6, n_segments=40, attachment="lever", wall="half").frequencies_hz
    found = told(given, overrides=("beam.mass=[{position=0.2113, mass=0.05, rotary_inertia=0.0}]",), count=40, mode=4)
    needed = found["parts_needed"]
    assert needed["known_by"].startswith(f"all N from {needed['count']} to ")
    exact = exact_frequency_hz(of.beam, 4)

    def off(n):
        modes = segment_modes(of.beam, 4, n_segments=n, attachment="lever", wall="half")
        return abs(float(modes.frequencies_hz[3]) / exact - 1.0)

    assert off(needed["count"] - 1) > 1e-3
    assert max(off(n) for n in range(needed["count"], needed["count"] + 30)) <= 1e-3


# --- what is wrong with a list ------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("read_as", "said"),
    [
        ("kHz", "too large by 1000: they are in Hz, not in kHz"),
        ("rad/s", "too small by 2 pi: they are in Hz, not in rad/s"),
    ],
)
def test_a_list_in_hertz_that_was_read_in_another_unit_is_said_to_be_in_hertz(told, read_as, said):
    found = told(lumped_rod(PAPER, 49)[:22], "paper", unit=read_as, count=49)
    assert kinds(found) == ["unit"]
    assert said in found["answer"]


@pytest.mark.parametrize(
    ("factor", "said"),
    [
        (2 * np.pi, "too large by 2 pi: they are in rad/s"),
        (1e-3, "too small by 1000: they are in kHz"),
        (60.0, "too large by 60: they are per minute"),
    ],
)
def test_a_wrong_unit_is_named_and_the_model_found_beneath_it(told, factor, said):
    found = told(factor * lumped_rod(PAPER, 49)[:22], "paper", count=49)
    assert kinds(found) == ["unit"]
    assert said in found["answer"]
    assert chosen(found, "mass", "order") == ("joints", 2)
    assert not found["passed"]
    assert [gate["id"] for gate in found["gates"] if not gate["passed"]] == ["list"]


@pytest.mark.parametrize("gone", [(3,), (7, 8), (2, 19), (21,)])
def test_missing_modes_are_named(told, gone):
    whole = lumped_rod(PAPER, 49)[:22]
    found = told([f for mode, f in enumerate(whole, start=1) if mode not in gone], "paper", count=49)
    modes = ", ".join(map(str, gone))
    assert found["told"][0]["words"] == (f"mode {modes} is" if len(gone) == 1 else f"modes {modes} are") + (
        " missing from the list"
    )
    assert [row["read_as"] for row in found["modes"]] == [mode for mode in range(1, 23) if mode not in gone]
    assert chosen(found, "mass") == ("joints",)
    assert not found["passed"]


def test_a_mode_that_is_missing_by_its_number_needs_no_guess(tmp_path):
    path = tmp_path / "list.csv"
    whole = lumped_rod(PAPER, 20)
    path.write_text(
        "mode;f/Hz\n" + "".join(f"{mode};{whole[mode - 1]:.9f}\n".replace(".", ",") for mode in (1, 2, 5, 9))
    )
    found = compare(scene("paper"), Asked(frequencies=path, count=20)).plain()
    assert [row["mode"] for row in found["modes"]] == [1, 2, 5, 9]
    assert chosen(found, "mass") == ("joints",)


def test_a_mode_of_another_kind_is_no_bending_mode(told):
    whole = lumped_rod(PAPER, 49)[:14]
    found = told(np.sort(np.append(whole, 0.6 * whole[7] + 0.4 * whole[8])), "paper", count=49)
    assert found["told"][0]["words"] == "entry 9 is none of the beam's bending modes"
    assert chosen(found, "mass") == ("joints",)


def test_rigid_motions_are_left_out_and_told_where_the_beam_has_none(told):
    found = told([0.0, 1e-4, *lumped_rod(PAPER, 49)[:12]], "paper", count=49)
    assert kinds(found) == ["rigid"]
    assert "the first 2 entries are rigid motions, left out; the scene's beam has none" in found["told"][0]["words"]
    assert [row["entry"] for row in found["modes"]][:2] == [3, 4]
    assert not found["passed"]


def test_rigid_motions_of_a_free_bar_are_as_they_should_be(told):
    bar = scene("free-free-bar").beam
    elastic = lumped_rod(bar, 40)[2:10]
    found = told([3e-5, 7e-5, *elastic], "free-free-bar", count=40)
    assert kinds(found) == ["rigid"]
    assert found["passed"]
    assert chosen(found, "mass", "wall") == ("joints", None)


def test_modes_that_stand_twice_are_named(told):
    whole = lumped_rod(PAPER, 49)[:12]
    found = told(np.sort(np.append(whole, whole[4] * (1 + 2e-5))), "paper", count=49)
    assert found["told"][0]["words"] == "entry 6 of the list repeats the one before: a mode is there twice"
    assert not found["passed"]


@pytest.mark.parametrize("count", [31, 29])
def test_another_number_of_links_than_was_said_is_told(count):
    found = recorded("exudyn-cantilever.csv", "steel-cantilever", count=count)
    assert found["told"][0]["words"] == f"the list is that of 30 parts, not of the {count} that --count says"
    assert not found["passed"]


def test_one_common_factor_is_named_with_its_size(told):
    """A modulus 3 % too high, or a beam 1.5 % too short."""
    found = told(np.sqrt(1.03) * lumped_rod(PAPER, 49)[:22], "paper", count=49)
    assert kinds(found) == ["scale"]
    assert found["factor"] == pytest.approx(np.sqrt(1.03), rel=1e-7)
    assert "E is +3 % or rho -2.91 %" in found["answer"]
    assert "the length -0.736 %" in found["answer"]
    assert chosen(found, "mass") == ("joints",)


def test_a_beam_of_another_length_shows_as_a_factor_too(told):
    longer = scene("paper", "beam.length=0.53").beam
    found = told(lumped_rod(longer, 49)[:22], "paper", count=49)
    assert kinds(found) == ["scale"]
    assert "the length +6 %" in found["answer"]


def test_other_supports_are_recognised(told):
    other = scene("steel-cantilever", *CLAMPED_PINNED).beam
    found = told([frequency_hz(other, mode) for mode in range(1, 9)], count=30)
    assert kinds(found) == ["supports"]
    assert "pinned-clamped beam" in found["answer"]
    assert "None of the known family fits" in found["answer"]


@pytest.mark.parametrize("ends", [("clamped", "free"), ("free", "clamped"), ("guided", "pinned")])
def test_a_list_that_leaves_the_beam_halfway_is_not_told_to_be_held_otherwise(told, ends):
    """The scene is held so: "and the scene's is not held so" was said of it, and failed the gate of the list."""
    held = f'beam.supports=["{ends[0]}","{ends[1]}"]'
    beam = scene("steel-cantilever", held).beam
    given = analytic_hz(beam, 8) * [1, 1, 1, 1, 1.06, 0.95, 1.08, 0.9]
    found = told(given, overrides=(held,))
    assert kinds(found) == ["leaving"]
    assert "within 0.01 % of those of the scene's beam, and number 5 is the first" in found["answer"]
    assert "+6.0000 % off" in found["answer"]
    assert {gate["id"]: gate["passed"] for gate in found["gates"]} == {"list": True, "identified": False}


@pytest.mark.parametrize("ends", [("clamped", "pinned"), ("pinned", "clamped")])
def test_other_supports_of_a_beam_with_a_body_are_recognised_from_either_side(told, ends):
    """With a body off the middle the mirror image is another beam, and was never looked at."""
    body = "beam.mass=[{position=0.11, mass=0.4}]"
    other = scene("steel-cantilever", body, f'beam.supports=["{ends[0]}","{ends[1]}"]').beam
    found = told(analytic_hz(other, 8) * 1.001 ** np.arange(8), overrides=(body,))
    assert kinds(found)[-1] == "supports"
    assert f"of a {'-'.join(ends)} beam, and the scene's is not held so" in found["answer"]


def test_random_frequencies_are_none_of_the_family(told):
    random = np.sort(np.random.default_rng(20).uniform(9.0, 4500.0, 22))
    found = told(random, "paper", count=49)
    assert found["answer"].startswith("None of the known family fits")
    assert not found["told"]
    assert not found["best"]["identified"]
    assert [gate["id"] for gate in found["gates"] if not gate["passed"]] == ["identified"]


def test_a_model_beside_the_family_is_not_taken_for_its_nearest(told):
    """A wall joint of 2.06 EI/l: what is left over goes smoothly with the mode, as noise would not."""
    found = told(rigid_links(CANTILEVER, 30, wall=2.06)[:8], count=30)
    assert found["certainty"]["systematic"]
    assert found["answer"].startswith("Nothing of the known family is it quite: the nearest")
    assert not found["passed"]


# --- how surely ---------------------------------------------------------------------------------------------------


def test_noise_lowers_the_confidence_and_does_not_change_the_answer(told):
    chain = np.loadtxt(DATA / "exudyn-cantilever.csv", delimiter=",", skiprows=1)[:, 1]
    noisy = chain * (1 + 1e-4 * np.random.default_rng(4).standard_normal(8))
    clean, found = told(chain, count=30), told(noisy, count=30)
    assert chosen(found, "wall", "order") == ("half", 2)
    assert 3e-5 < found["best"]["residual"] < 2e-4
    assert clean["certainty"]["next_over_best"] > 1e5
    assert 3.0 < found["certainty"]["next_over_best"] < 50.0
    assert found["passed"]


def test_noise_as_large_as_what_tells_two_theories_apart_leaves_both(told):
    """The section's rotary inertia lowers mode 10 by 1.6e-4, the links by 4e-3."""
    links = rigid_links(PAPER, 20)[:10]
    clean = told(links, "paper", count=20)
    assert {one["theory"] for one in clean["certainty"]["alike"]} == {"euler-bernoulli"}
    assert not clean["answer"].startswith("Probably")
    assert clean["best"]["identified"]
    assert clean["certainty"]["sure"]
    found = told(links * (1 + 1e-4 * np.random.default_rng(5).standard_normal(10)), "paper", count=20)
    theories = {found["best"]["theory"], *(one["theory"] for one in found["certainty"]["alike"])}
    assert theories == {"euler-bernoulli", "rayleigh"}
    assert found["answer"].startswith("Probably your ")
    assert found["best"]["identified"]
    assert not found["certainty"]["sure"]
    assert "this list does not tell it from" in found["answer"]
    assert found["passed"]


def test_a_list_rounded_to_a_tenth_of_a_hertz_is_judged_beyond_its_rounding(tmp_path):
    path = tmp_path / "list.txt"
    path.write_text("\n".join(f"{f:.1f}" for f in lumped_rod(PAPER, 49)[:22]))
    found = compare(scene("paper"), Asked(frequencies=path, count=49)).plain()
    assert chosen(found, "mass", "order") == ("joints", 2)
    assert found["best"]["residual"] < 1e-9
    assert found["certainty"]["told_apart"]


def test_a_chain_too_fine_to_see_its_rule_is_said_to_be(told):
    found = told(
        [frequency_hz(PAPER, mode) * (1 + e) for mode, e in ((1, 2e-6), (2, -3e-6), (3, 1e-6))], "paper", count=300
    )
    assert not found["certainty"]["told_apart"]
    assert not found["certainty"]["sure"]
    assert "do not show how the beam was divided" in found["answer"] or found["best"]["model"] == "analytic"


def test_one_mode_alone_tells_no_rule(told):
    found = told([27.5699789014317])
    assert len(found["certainty"]["alike"]) > 10
    assert found["answer"].startswith("These frequencies do not show how the beam was divided")


# --- shapes -------------------------------------------------------------------------------------------------------


def written(tmp_path, frequencies, shapes):
    given, other = tmp_path / "list.csv", tmp_path / "shapes.csv"
    given.write_text("\n".join(repr(float(f)) for f in frequencies))
    np.savetxt(other, shapes, delimiter=";", header="x;" + ";".join("u" * (shapes.shape[1] - 1)))
    return Asked(frequencies=given, shapes=other, count=30)


def exudyn():
    frequencies = np.loadtxt(DATA / "exudyn-cantilever.csv", delimiter=",", skiprows=1)[:, 1]
    return frequencies, np.loadtxt(DATA / "exudyn-cantilever-shapes.csv", delimiter=",", skiprows=1)


def test_modes_that_were_exchanged_are_paired_by_shape_and_named(tmp_path):
    frequencies, shapes = exudyn()
    order = [0, 1, 3, 2, 4, 5, 6, 7]
    found = compare(
        scene("steel-cantilever"), written(tmp_path, frequencies[order], shapes[:, [0, *(i + 1 for i in order)]])
    ).plain()
    assert found["told"][0]["words"] == "modes 3, 4 are exchanged: by their shapes they are 4, 3"
    assert [row["entry"] for row in found["modes"]] == [1, 2, 4, 3, 5, 6, 7, 8]
    assert chosen(found, "wall", "order") == ("half", 2)


def test_columns_of_shapes_that_were_exchanged_do_not_exchange_the_frequencies(tmp_path):
    frequencies, shapes = exudyn()
    found = compare(
        scene("steel-cantilever"), written(tmp_path, frequencies, shapes[:, [0, 1, 2, 3, 4, 6, 5, 7, 8]])
    ).plain()
    assert found["told"][0]["words"].startswith(
        "the columns of shapes are exchanged, the frequencies are not: modes 5, 6"
    )
    assert found["best"]["residual"] < 1e-8
    assert not found["passed"]


def test_shapes_name_the_mode_that_is_missing(tmp_path):
    frequencies, shapes = exudyn()
    keep = [0, 1, 2, 4, 5, 6]
    found = compare(
        scene("steel-cantilever"), written(tmp_path, frequencies[keep], shapes[:, [0, *(i + 1 for i in keep)]])
    ).plain()
    assert found["told"][0]["words"] == "mode 4 is missing from the list"
    assert [row["mode"] for row in found["modes"]] == [1, 2, 3, 5, 6, 7]


# --- the command --------------------------------------------------------------------------------------------------


@pytest.fixture
def verify(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def call(*words):
        capsys.readouterr()
        status = status_of(["compare", *map(str, words)])
        out, err = capsys.readouterr()
        return status, out, err

    return call


LIST = DATA / "exudyn-cantilever.csv"


def test_the_answer_comes_first_and_fits_into_eighty_columns(verify, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    status, out, err = verify(LIST, "--scene", "steel-cantilever", "--count", "30")
    assert (status, err) == (0, "")
    assert out.startswith("Your chain follows the 2EI/l rule at the wall, order 2;")
    assert max(len(line.rstrip()) for line in out.splitlines()) <= 80


def test_json_has_the_best_the_candidates_the_modes_and_the_verdict(verify):
    status, out, _ = verify(LIST, "--scene", "steel-cantilever", "--count", "30", "--json")
    data = json.loads(out)
    assert status == 0
    assert {"model", "wall", "joints", "theory", "order", "mass", "count", "residual"} <= set(data["best"])
    residuals = [one["residual"] for one in data["candidates"]]
    assert len(residuals) > 20
    assert residuals[2:] == sorted(residuals[2:])
    assert len(data["modes"]) == 8
    assert data["passed"] is True
    assert data["answer"].startswith("Your chain")


@pytest.mark.parametrize(("within", "status"), [("1%", 0), ("0.5%", 1)])
def test_errors_against_the_exact_beam_are_gated_on_demand(verify, within, status):
    """The eighth mode is -0.89 % off, the fifth -0.52 %, the fourth -0.41 %."""
    code, out, _ = verify(LIST, "--scene", "steel-cantilever", "--count", "30", "--within", within)
    assert code == status
    assert ("beyond it: modes 5, 6, 7, 8" in out) == bool(status)


def test_a_report_is_written_where_one_is_asked_for(verify, tmp_path):
    status, out, _ = verify(LIST, "--scene", "steel-cantilever", "--count", "30", "--reports", "here")
    page = (tmp_path / "here" / "compare-steel-cantilever.html").read_text("utf-8")
    assert status == 0
    assert "report: here/compare-steel-cantilever.html" in out
    assert "follows the 2EI/l rule" in page
    assert 'id="compare"' in page
    assert "candidates solved in" in page


def test_parts_are_counted_for_another_error_at_another_mode(verify):
    _, out, _ = verify(LIST, "--scene", "steel-cantilever", "--count", "30", "--mode", "3", "--error", "1%", "--json")
    needed = json.loads(out)["parts_needed"]
    assert needed["mode"] == 3
    assert needed["error"] == 0.01
    assert 10 < needed["count"] < 25


def commands():
    text = (Path(__file__).parents[2] / "docs" / "compare.md").read_text("utf-8")
    return [line for line in text.splitlines() if line.startswith("verify compare")]


@pytest.mark.parametrize("command", commands())
def test_the_pages_commands_run(command, monkeypatch, capsys):
    monkeypatch.chdir(Path(__file__).parents[2])
    assert status_of(command.split()[1:]) == 0
    assert " ".join(capsys.readouterr().out.split()).startswith(
        "Your chain follows the 2EI/l rule at the wall, order 2;"
    )


def test_the_page_quotes_what_its_command_answers(monkeypatch, capsys):
    monkeypatch.chdir(Path(__file__).parents[2])
    status_of(commands()[0].split()[1:])
    text = Path("docs/compare.md").read_text("utf-8")
    quoted = " ".join(line.removeprefix("> ") for line in text.splitlines() if line.startswith("> "))
    assert quoted in " ".join(capsys.readouterr().out.split())


# --- what would take too long, or leave floating point --------------------------------------------------------------


@pytest.mark.parametrize(("asked", "field"), [({}, "modes = 204"), ({"count": 200_000}, "count = 200000")])
def test_a_list_that_would_take_minutes_is_refused_with_its_estimate(told, asked, field):
    with pytest.raises(InputError, match=rf"^{field} would take about .* more than the 20 s .*VERIFY_PATIENCE"):
        told([9.0 * (n - 0.5) ** 2 for n in range(1, 201)], **asked)


def test_a_list_of_forty_modes_and_a_known_size_of_two_thousand_are_begun():
    check_patience(44, None, 40)
    check_patience(24, 2000, 40)


def test_a_list_is_refused_for_the_candidates_that_it_is_held_against_and_no_others(told):
    """Of 45 candidates 17 are elements, or exact."""
    hertz = fem_modes(CANTILEVER, 60, 130).frequencies_hz
    with pytest.raises(InputError, match=r"^modes = 64 would take about .*--kind, what you built"):
        told(hertz)
    assert chosen(told(hertz, kind="elements"), "model", "mass", "count") == ("fem", "consistent", 130)


def test_other_sizes_than_the_one_said_are_looked_for_where_that_is_no_work_and_else_it_is_told(told):
    """A list of 60 modes that is no model of 700 parts: seven more sizes, and all up to 400, would take half a minute."""
    found = told([9.0 * n**1.9 for n in range(1, 61)], count=700)
    assert kinds(found)[-1] == "unsearched"
    assert "count = 'other than 700' would take about" in found["told"][-1]["words"]
    assert "unsearched" not in kinds(told([9.0 * n**1.9 for n in range(1, 9)], count=40))


def test_shapes_may_be_in_any_unit_however_large(tmp_path):
    model = fem_modes(CANTILEVER, 4, 12)
    x = np.linspace(0.0, CANTILEVER.length, 13)
    (tmp_path / "f.csv").write_text("\n".join(map(repr, map(float, model.frequencies_hz))))
    told = []
    for unit in (1.0, 1e200):
        table = np.column_stack([x, unit * model.deflection(x).T])
        np.savetxt(tmp_path / "shapes.csv", table, delimiter=",")
        asked = Asked(frequencies=tmp_path / "f.csv", shapes=tmp_path / "shapes.csv", count=12)
        told.append([row.likeness for row in compare(scene("steel-cantilever"), asked).rows])
    assert told[1] == pytest.approx(told[0], rel=1e-9)
    assert min(told[0]) > 0.999


@pytest.mark.parametrize("supports", ['["guided","free"]', '["guided","guided"]', '["free","free"]'])
def test_links_of_point_masses_have_frequencies_between_any_ends(supports):
    """No end held: links that do not feel their turning would leave joints up and down without mass."""
    beam = scene("steel-cantilever", f"beam.supports={supports}").beam
    exact = np.array([frequency_hz(beam, n) for n in (1, 2, 3)])
    coarse, fine = (
        chain(beam, n, 3, wall="half", mass="points", theory="euler-bernoulli") / exact - 1 for n in (20, 40)
    )
    assert (np.log2(coarse / fine) > 1.8).all()
    assert (np.log2(coarse / fine) < 2.2).all()


# --- what a stranger's chain carries, and what is not so sure -------------------------------------------------------


def bodies_on_the_last_link(beam, count, mass, rotary):
    """A chain with 2EI/l at the wall and a body fixed to its last link, by deflections of the joints alone, Hz."""
    link = beam.length / count
    turns = (np.eye(count + 1, k=1) - np.eye(count + 1))[:count] / link
    middles = 0.5 * (np.eye(count + 1, k=1) + np.eye(count + 1))[:count]
    bends = np.vstack([turns[:1], np.diff(turns, axis=0)])
    springs = beam.bending_stiffness / link * np.array([2.0, *[1.0] * (count - 1)])
    stiff = bends.T @ np.diag(springs) @ bends
    weight = beam.mass_per_length * link
    heavy = weight * middles.T @ middles + weight * link**2 / 12.0 * turns.T @ turns
    heavy[-1, -1] += mass
    heavy += rotary * np.outer(turns[-1], turns[-1])
    squares = np.linalg.eigvals(np.linalg.solve(heavy[1:, 1:], stiff[1:, 1:])).real
    return np.sqrt(np.sort(squares)[:8]) / (2.0 * np.pi)


def test_a_body_fixed_to_the_last_link_is_known_as_that_and_of_order_one(told):
    listed = bodies_on_the_last_link(CANTILEVER, 30, 0.05, 2e-5)
    on_it = ("beam.mass=[{position=0.3, mass=0.05, rotary_inertia=2e-5}]",)
    found = told(listed, overrides=on_it, count=30)
    assert (found["best"]["attachment"], *chosen(found, "wall", "order", "identified")) == ("lever", "half", 1, True)
    assert found["best"]["residual"] < 1e-7
    assert "reciprocal weights" in found["parts_needed"]["better"]


def test_another_number_of_parts_far_from_the_one_said_is_found(told):
    listed = scene("steel-cantilever").beam
    from verify.elements.linear import solve_modes

    found = told(solve_modes(listed, 9, 12).frequencies_hz, count=30)
    assert kinds(found) == ["count"]
    assert chosen(found, "model", "mass", "count") == ("fem", "consistent", 12)


def test_a_factor_that_does_not_explain_a_list_is_not_stated_as_one(told):
    stiffer = rigid_links(CANTILEVER, 30)[:10]
    stiffer = stiffer * (1.0 + 0.011 + 0.0004 * np.linspace(-1.0, 1.0, 10) ** 3)
    found = told(stiffer, count=30)
    assert not found["best"]["identified"]
    assert "have the common factor" not in found["answer"]


def test_a_unit_is_taken_in_any_letters(verify):
    """A list in hertz, taken for one in rad/s."""
    asked = (LIST, "--scene", "steel-cantilever", "--count", 30, "--kind", "segments")
    (status, out, _), (_, known, _) = (verify(*asked, "--unit", unit, "--json") for unit in ("RAD/s", "rad/s"))
    assert status in (0, 1)
    assert json.loads(out)["modes"] == json.loads(known)["modes"]
    assert json.loads(out)["modes"] != json.loads(verify(*asked, "--json")[1])["modes"]
