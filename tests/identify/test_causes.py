"""Lists of known cause: what is said to be behind them, what is claimed, and what a gate judges."""

import json
from functools import cache

import numpy as np
import pytest
from msgspec.structs import replace

from verify.beam import PointMass
from verify.cli import status_of
from verify.elements.linear import solve_modes as elements
from verify.errors import InputError
from verify.exact.modes import exact_frequency_hz
from verify.identify.causes_told import cause_of
from verify.identify.clamps import clamp_of, clamped_ends, loss_of, softened
from verify.identify.compare import Asked, compared
from verify.identify.reading import Listed
from verify.scenes.scene import load_scene


@cache
def scene(*overrides):
    return load_scene("steel-cantilever", overrides)


BEAM = scene().beam


def links(count, *, wall=2.0, modulus=1.0, clamp=None, tip=0.0, n_modes=6):
    """A cantilever of rigid links by their angles, Hz: `wall` EI/l at the wall, and behind it a spring `clamp` EI/L."""
    link, stiff = BEAM.length / count, BEAM.bending_stiffness
    joints = np.full(count, modulus * stiff / link)
    joints[0] *= wall
    if clamp:
        joints[0] = 1.0 / (1.0 / joints[0] + BEAM.length / (clamp * stiff))
    weight = BEAM.mass_per_length * link
    lever = link * (np.tril(np.ones((count, count)), -1) + 0.5 * np.eye(count))
    bends = np.eye(count) - np.eye(count, k=-1)
    heavy = weight * (lever.T @ lever + link**2 / 12.0 * np.eye(count) + tip * link**2 * np.ones((count, count)))
    squares = np.linalg.eigvals(np.linalg.solve(heavy, bends.T @ np.diag(joints) @ bends)).real
    return np.sqrt(np.sort(squares)[:n_modes]) / (2.0 * np.pi)


def fine(clamp=None, n_modes=6):
    """Two hundred elements, Hz, the wall a spring of `clamp` EI/L."""
    of = BEAM if clamp is None else softened(BEAM, clamp_of(BEAM, ("left",), 1.0 / clamp))
    return elements(of, n_modes, 200).frequencies_hz


def of_list(hertz, count, digits=5, **asked):
    """What is said of a list that was written with so many digits."""
    written = [float(f"{f:.{digits}g}") for f in hertz]
    rounding = np.array([0.5 * 10.0 ** (np.floor(np.log10(f)) - digits + 1) / f for f in written])
    listed = Listed(frequencies_hz=np.array(written), numbers=None, rounding=rounding, source="list", unit="Hz")
    return compared(scene(), Asked(count=count, **asked), listed, None, count)


def kinds(found):
    return [one.kind for one in found.told]


def cause(found):
    return found.plain()["causes"][0]


# --- yours is what was given ---------------------------------------------------------------------------------------


def test_yours_is_what_was_given_and_the_scaled_stands_beside_it():
    """A modulus 3 % too low lowers all frequencies by 1.51 %."""
    given = links(24, modulus=0.97)
    found = of_list(given, 24, digits=12)
    exact = np.array([exact_frequency_hz(BEAM, mode) for mode in range(1, 7)])
    rows = found.plain()["modes"]
    assert [row["frequency_hz"] for row in rows] == pytest.approx(given, rel=1e-11)
    assert [row["given_hz"] for row in rows] == [row["frequency_hz"] for row in rows]
    assert [row["error"] for row in rows] == pytest.approx(given / exact - 1.0, rel=1e-9)
    assert [row["scaled_hz"] for row in rows] == pytest.approx(links(24), rel=1e-9)
    assert [row["scaled_error"] for row in rows] == pytest.approx(links(24) / exact - 1.0, rel=1e-6)
    shown = found.tables()[0]
    names = [column.head for column in shown.columns]
    assert names[2:8] == ["yours, Hz", "exact, Hz", "error, %", "scaled, Hz", "scaled error, %", "best, Hz"]
    assert [row[2] for row in shown.rows] == [row["frequency_hz"] for row in rows]
    assert "over 0.984886" in shown.notes[0]


def test_without_a_diagnosed_factor_nothing_is_scaled():
    found = of_list(links(24), 24)
    assert {row.scaled_hz for row in found.rows} == {None}
    assert "scaled, Hz" not in [column.head for column in found.tables()[0].columns]
    assert found.facts()[1].endswith(f"at mode {max(found.rows, key=lambda row: abs(row.error)).mode}.")


@pytest.mark.parametrize(
    ("factor", "limit"), [(np.sqrt(0.97), 0.02), (np.sqrt(0.97), 0.004), (2.0 * np.pi, 0.02), (1e-3, 0.02)]
)
def test_the_gate_within_judges_what_was_given(factor, limit):
    """Fine elements lie within 1e-6 of the exact beam, so that the factor is all their error."""
    found = of_list(factor * fine(), 200, digits=9, within=limit)
    (gate,) = [gate for gate in found.gates if gate.id == "within"]
    assert gate.measured == pytest.approx(abs(factor - 1.0), rel=1e-3)
    assert gate.passed == (abs(factor - 1.0) <= limit)


def test_a_unit_or_a_modulus_that_is_confirmed_passes(tmp_path, capsys):
    path = str(tmp_path / "list.csv")
    np.savetxt(path, 2.0 * np.pi * np.sqrt(0.97) * fine())
    line = ["compare", path, "--scene", "steel-cantilever", "--count", "200", "--within", "0.1%", "--json"]
    assert status_of(line) == 1
    assert not json.loads(capsys.readouterr().out)["passed"]
    modulus = 0.97 * float(BEAM.own.bending_stiffness / BEAM.second_moment)
    status_of([*line, "--unit", "rad/s", "--set", f"beam.youngs_modulus={modulus!r}"])
    gates = {gate["id"]: gate["passed"] for gate in json.loads(capsys.readouterr().out)["gates"]}
    assert (gates["list"], gates["within"]) == (True, True)


def test_points_that_a_wrong_unit_takes_off_the_chart_are_said_to_be():
    near, far = (of_list(factor * fine(), 200).charts()[0] for factor in (0.98, 2.0 * np.pi))
    assert [one.name for one in near.lines][1:3] == ["yours", "yours, scaled"]
    assert [one.name for one in far.lines][1] == "yours, scaled"
    assert "as given they lie off the chart" in far.caption


# --- lists of known cause ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("count", [12, 24, 60])
@pytest.mark.parametrize("said", [True, False], ids=["size said", "size unknown"])
def test_a_soft_clamp_is_found_beneath_a_coarse_chain(count, said):
    found = of_list(links(count, clamp=40.0), count if said else None)
    assert kinds(found) == ["clamp", "twin"]
    assert cause(found)["clamp"]["k_r_L_over_EI"] == pytest.approx(40.0, rel=2e-3)
    assert cause(found)["clamp"]["k_r"] == pytest.approx(40.0 * BEAM.bending_stiffness / BEAM.length, rel=2e-3)
    assert (found.found.best.candidate.wall, found.found.best.count) == ("half", count)
    assert found.found.best.residual < 1e-5


@pytest.mark.parametrize("stiffness", [10.0, 40.0])
@pytest.mark.parametrize("count", [200, None])
def test_a_soft_clamp_of_a_fine_mesh_is_no_modulus(stiffness, count):
    found = of_list(fine(stiffness), count, within=0.02)
    assert kinds(found) == ["clamp", "twin"]
    assert cause(found)["clamp"]["k_r_L_over_EI"] == pytest.approx(stiffness, rel=2e-3)
    assert "E is" not in found.answer
    assert "do not show how the beam was divided" in found.answer
    assert [gate.id for gate in found.gates if not gate.passed] == ["list", "within"]


@pytest.mark.parametrize(("modulus", "count"), [(1.05, 12), (1.05, 60), (0.97, 24), (1.0 / 1.05, 24)])
def test_a_modulus_or_a_density_is_no_clamp(modulus, count):
    for size in (count, None):
        found = of_list(links(count, modulus=modulus), size)
        assert kinds(found) == ["scale"]
        assert found.found.best.factor == pytest.approx(np.sqrt(modulus), rel=1e-4)
        assert "have the common factor" in found.answer


def test_radians_per_second_are_named_beneath_a_clamp_and_beneath_a_modulus():
    soft = of_list(2.0 * np.pi * links(24, clamp=40.0), 24)
    assert "they are in rad/s, not Hz; the clamped left end turns against a spring of k_r = " in soft.answer
    assert soft.found.best.clamp.stiffness == pytest.approx(40.0, rel=2e-3)
    assert soft.rows[0].scaled_hz == pytest.approx(soft.rows[0].given_hz / (2.0 * np.pi), rel=1e-12)
    low = of_list(2.0 * np.pi * links(24, modulus=0.97), 24)
    assert "too large by 2 pi: they are in rad/s, not Hz; beyond that 0.984885, so that E is -3 %" in low.answer


@pytest.mark.parametrize("count", [12, 24, 60])
def test_a_wall_joint_twice_as_stiff_is_known(count):
    for size in (count, None):
        found = of_list(links(count, wall=4.0), size)
        assert found.answer.startswith("Your chain has a joint 4EI/l at the wall, twice as stiff")
        assert not found.told


def test_a_clamp_that_hardly_gives_is_told_beside_a_modulus_and_neither_is_claimed():
    """To first order both lower every mode of a cantilever alike: the square of its tip is 4 in all of them."""
    found = of_list(fine(2000.0), 200)
    assert kinds(found) == ["causes", "twin"]
    assert "none is claimed: (a) " in found.answer
    assert {one["kind"] for one in found.plain()["causes"]} == {"clamp", "scale"}
    assert not found.plain()["best"]["identified"]
    assert found.told[0].wrong
    assert found.answer.startswith("This list does not say which it is, or whether it is one of them")

    def leaving(cause):
        return replace(cause, fits=tuple(replace(one, residual=1.2e-3) for one in cause.fits))

    loose = replace(leaving(found.found), rivals=tuple(map(leaving, found.found.rivals)))
    (told,) = cause_of(loose, BEAM)
    assert told.words.count("0.1200 %") == 2
    assert "is left, which leaves" not in told.words


def test_what_a_factor_does_not_explain_is_not_claimed_as_one():
    """A wall joint of 3 EI/l, half a link's mass too much at the tip: neither is of the family."""
    for given in (links(12, wall=3.0), links(24, wall=3.0), links(12, tip=0.5), links(24, tip=0.5)):
        found = of_list(given, None)
        assert "have the common factor" not in found.answer
        assert not found.answer.startswith("Your ")


def test_more_than_half_of_a_list_is_never_called_no_bending_modes():
    found = of_list(links(60, tip=0.5), 60)
    assert "no bending modes" not in found.answer
    assert len(found.rows) == 6


# --- the clamp itself ----------------------------------------------------------------------------------------------


def test_a_clamp_that_gives_a_little_lowers_every_mode_by_twice_its_compliance():
    """Of a cantilever: by 2 EI/(k_r L), since its curvature at the wall is twice its wave number squared."""
    loss = loss_of(BEAM, ("left",), 6)
    least = loss.compliances[0]
    assert loss.logs[0] == pytest.approx(np.full(6, -2.0 * least), rel=5e-3)
    at = int(np.searchsorted(loss.compliances, 0.03))
    of = softened(BEAM, clamp_of(BEAM, ("left",), float(loss.compliances[at])))
    known = [np.log(exact_frequency_hz(of, n) / exact_frequency_hz(BEAM, n)) for n in range(1, 7)]
    assert loss.logs[at] == pytest.approx(known, abs=2e-6)


def test_which_ends_may_give():
    assert clamped_ends(BEAM) == (("left",),)
    assert clamped_ends(scene('beam.supports=["pinned","free"]', "beam.spring=[]").beam) == ()
    both = scene('beam.supports=["clamped","clamped"]').beam
    assert clamped_ends(both) == (("left",), ("left", "right"))
    assert clamp_of(both, ("left",), 0.1).words.startswith("one of both clamped ends turns against")
    assert clamp_of(both, ("left", "right"), 0.1).words.startswith("both clamped ends turn against")
    assert clamp_of(BEAM, ("left",), 0.1).words.startswith("the clamped left end turns against")
    body = scene('beam.supports=["clamped","clamped"]', "beam.mass=[{position=0.1, mass=0.1}]").beam
    assert clamped_ends(body) == (("left",), ("right",), ("left", "right"))


def test_an_end_that_is_clamped_holds_no_spring():
    with pytest.raises(InputError, match="would do nothing"):
        load_scene("steel-cantilever", ("beam.spring=[{position=0.0, rotational=1.0}]",))


def lumped(count, wall, tip, n_modes=6):
    """A cantilever of massless links, Hz: masses at the joints, `wall` EI/l at the wall, `tip` masses at the free end."""
    link = BEAM.length / count
    bends, lever = np.eye(count) - np.eye(count, k=-1), link * np.tril(np.ones((count, count)))
    joints, masses = np.full(count, BEAM.bending_stiffness / link), np.full(count, BEAM.mass_per_length * link)
    joints[0], masses[-1] = wall * joints[0], tip * masses[-1]
    squares = np.linalg.eigvals(np.linalg.solve(lever.T @ (masses[:, None] * lever), bends.T @ np.diag(joints) @ bends))
    return np.sqrt(np.sort(squares.real)[:n_modes]) / (2.0 * np.pi)


@pytest.mark.parametrize(("wall", "tip", "said"), [(1.0, 1.0, "a whole mass"), (1e6, 1e-6, "no mass")])
def test_a_wrong_mass_at_the_tip_of_a_lumped_cantilever_is_not_called_a_wrong_wall_alone(wall, tip, said):
    one, other = lumped(23, 2.0, tip, 10), lumped(23, wall, 0.5, 10)
    assert one == pytest.approx(other, rel=2e-5)
    told = " ".join(of_list(one, 23).answer.split())
    assert f"o list can tell it from one with 2EI/l at the wall and {said}" in told


def test_a_lumped_cantilever_that_is_right_has_no_twin():
    assert "twin" not in kinds(of_list(lumped(23, 2.0, 0.5, 10), 23, 9))


@pytest.mark.parametrize("share", [0.031, 0.1019, 0.57])
@pytest.mark.parametrize("end", ["left", "right"])
def test_a_mass_at_the_free_end_is_not_called_a_soft_clamp_alone(share, end):
    """Moments of the one are deflections of the other, turned round: rho A L / kappa does what kappa EI/L does."""
    own = {"left": scene(), "right": scene('beam.supports=["free","clamped"]')}[end]
    beam, tip = own.beam, {"left": own.beam.length, "right": 0.0}[end]
    heavy = replace(beam, mass=(PointMass(position=tip, mass=share * beam.mass_per_length * beam.length),))
    soft = softened(beam, clamp_of(beam, (end,), share))
    listed = [exact_frequency_hz(heavy, mode) for mode in range(1, 7)]
    assert listed == pytest.approx([exact_frequency_hz(soft, mode) for mode in range(1, 7)], rel=1e-12)
    rounding = np.full(6, 1e-12)
    asked = Listed(frequencies_hz=np.array(listed), numbers=None, rounding=rounding, source="list", unit="Hz")
    found = compared(own, Asked(), asked, None, None)
    told = " ".join(found.answer.split())
    mass = heavy.mass[0].mass
    assert f"rigid one with {share:.4g} rho A L ({mass:.4g} kg) at the free end: look at both" in told
