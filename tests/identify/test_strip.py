"""A strip from records: EI, clamp and damping of known truth, by the frequency equation of a cantilever on a spring."""

import json
import shlex
from itertools import pairwise
from math import pi
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from verify.cli import status_of

MASS = 7850.0 * 0.025 * 0.0011
"""kg/m"""
STEEL = "0.31 m x 25 x 1.1 mm steel, cantilever"


def roots(softness, n):
    """Roots beta L of a cantilever on a rotational spring k = EI/(softness L).

    1 + cos y cosh y = softness y (sin y cosh y - cos y sinh y) (Blevins, Formulas for Natural Frequency, table 8-2).
    """

    def excess(y):
        return 1.0 / np.cosh(y) + np.cos(y) - softness * y * (np.sin(y) - np.cos(y) * np.tanh(y))

    grid = np.linspace(0.1, pi * (n + 0.5), 400)
    ends = [(a, b) for a, b in pairwise(grid) if excess(a) * excess(b) < 0.0]
    return [brentq(excess, *pair, xtol=1e-13) for pair in ends[:n]]


def hertz(length, stiffness, compliance, n):
    betas = np.array(roots(compliance * stiffness / length, n)) / length
    return betas**2 * np.sqrt(stiffness / MASS) / (2.0 * pi)


def write(path, frequencies, ratio, seed, noise=0.02, sizes=(25.0, 4.0, 1.0), digits=2):
    times, y = np.arange(0.0, 2.2, 1.0 / 480.0), -3.0
    for k, (hz, size) in enumerate(zip(frequencies, sizes, strict=False)):
        zeta = ratio(hz)
        y = y + size * np.exp(-2.0 * pi * zeta * hz * times) * np.cos(
            2.0 * pi * hz * np.sqrt(1.0 - zeta**2) * times + 0.4 + k
        )
    y = y + noise * np.random.default_rng(seed).standard_normal(len(times))
    np.savetxt(
        path, np.c_[1e3 * times, y], fmt=["%.3f", f"%.{digits}f"], header="t_ms,tip_mm", delimiter=",", comments=""
    )


def identified(capsys, *words, beam=STEEL):
    """(data of the result, its summary, the command that it prints)."""
    assert status_of(["identify", "--beam", beam, *words, "--json"]) == 0
    out, command = capsys.readouterr()
    found = json.loads(out)
    return found, found["summary"], command.strip()


def contains(estimate, truth):
    """Within twice the 95 % interval: four standard deviations."""
    low, high = estimate["interval"]
    return abs(estimate["value"] - truth) < high - low


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


@pytest.mark.parametrize(
    ("compliance", "ratio", "law"),
    [
        (0.031, lambda hz: 0.0043, "a constant loss factor"),
        (0.012, lambda hz: 0.00031 * hz, "viscosity"),
        (0.02, lambda hz: 0.002 + 0.0001 * hz, "a constant loss factor and viscosity"),
        (0.02, lambda hz: 0.004 + 0.05 / hz, "a constant loss factor and drag"),
    ],
)
def test_two_lengths_give_stiffness_clamp_and_the_law_of_the_damping(capsys, compliance, ratio, law):
    truth = 0.5371
    for seed, (name, length) in enumerate((("long.csv", 0.31), ("short.csv", 0.22))):
        write(name, hertz(length, truth, compliance, 2), ratio, seed)
    found, summary, command = identified(capsys, "long.csv", "short.csv", "--length", "310mm", "--length", "0.22")
    assert contains(found["bending_stiffness"], truth)
    assert found["bending_stiffness"]["value"] == pytest.approx(truth, rel=2e-3)
    assert contains(found["compliance"], compliance)
    assert found["compliance"]["value"] == pytest.approx(compliance, rel=0.01)
    assert law in found["damping"]["law"]
    first = hertz(0.31, truth, compliance, 1)[0]
    damping = found["damping"]["terms"] @ first ** np.array([0.0, 1.0, -1.0])
    assert damping == pytest.approx(ratio(first), rel=0.03)
    assert "kg/m" in summary  # EI over the mass is all that frequencies determine
    modulus = 12.0 * truth / (0.025 * 0.0011**3)
    words = dict(word.split("=", 1) for word in shlex.split(command) if "=" in word and "x" not in word)
    assert float(words["beam.youngs_modulus"]) == pytest.approx(modulus, rel=2e-3)


def test_its_chain_has_the_frequencies_of_the_record(capsys):
    truth, compliance = 0.5371, 0.031
    for seed, (name, length) in enumerate((("long.csv", 0.31), ("short.csv", 0.22))):
        write(name, hertz(length, truth, compliance, 2), lambda hz: 0.0043, seed)
    _, _, command = identified(capsys, "long.csv", "short.csv", "--length", "310mm", "--length", "0.22")
    words = shlex.split(command)
    assert status_of(words[1:]) == 0
    scene = [word for k, word in enumerate(words[2:], start=2) if {"--set", "--beam"} & {word, words[k - 1]}]
    capsys.readouterr()
    assert status_of(["compare", *scene, "strip.xml", "long.csv", "--mode", "2"]) == 0
    text = " ".join(capsys.readouterr().out.split())
    assert "The record is that of the file as it runs: 2 modes" in text
    assert f"on a spring of {1.0 / compliance:.2g}" in text
    # As for a spring that the file has not, whose joint at the wall is another:
    stiffer = [word.replace("rotational=", "rotational=1") for word in scene]
    assert status_of(["compare", *stiffer, "strip.xml", "--mode", "2"]) == 1


def test_what_records_do_not_separate_is_said(capsys):
    rigid = hertz(0.31, 0.5371, 0.0, 3), hertz(0.22, 0.5371, 0.0, 2)
    for seed, (name, frequencies) in enumerate(zip(("long.csv", "short.csv"), rigid, strict=True)):
        write(name, frequencies, lambda hz: 0.0043, seed)
    found, summary, command = identified(capsys, "long.csv", "short.csv", "--length", "0.31", "--length", "0.22")
    assert contains(found["bending_stiffness"], 0.5371)
    assert found["compliance"]["interval"][0] == 0.0
    assert "at most" in summary
    assert "rotational" not in command
    write("one.csv", hertz(0.31, 0.5371, 0.02, 1), lambda hz: 0.0043, 5)
    found, summary, _ = identified(capsys, "one.csv")
    assert found["compliance"] is None
    assert "do not separate EI from the clamp" in summary
    assert "one frequency does not tell" in summary
    # By Rayleigh's quotient f falls by 2 C EI/L, EI of a rigid clamp by twice that, to first order.
    low = found["bending_stiffness"]["value"] / 0.5371
    assert low == pytest.approx(1.0 - 4.0 * 0.02 * 0.5371 / 0.31, abs=0.02)


def test_without_noise_one_length_leaves_the_clamp_to_errors_of_theory(capsys):
    # A compliance changes all frequencies alike to first order, so that 0.1 % of theory hides it from EI.
    write("clean.csv", hertz(0.31, 0.5371, 0.0, 3), lambda hz: 0.0043, 7, noise=0.0, digits=12)
    found, summary, _ = identified(capsys, "clean.csv")
    assert found["compliance"] is None
    assert found["bending_stiffness"]["value"] == pytest.approx(0.5371, rel=1e-5)
    assert "do not separate EI from the clamp" in summary


def test_a_frequency_of_no_mode_is_left_out_and_of_no_strip_refused(capsys):
    modes = hertz(0.31, 0.5371, 0.02, 2)
    write("ring.csv", [*modes, 31.0], lambda hz: 0.0043, 1)
    found, _, _ = identified(capsys, "ring.csv")
    assert contains(found["bending_stiffness"], 0.5371)
    assert any("31" in text for text in found["warnings"])
    found, _, _ = identified(capsys, "ring.csv", beam=STEEL.replace("1.1 mm", "2 mm"))
    assert any("times the one that is given" in text for text in found["warnings"])
    for words, remedy in (
        ((STEEL.replace("cantilever", "pinned-pinned"), "ring.csv"), "clamped-free"),
        ((STEEL, "ring.csv", "ring.csv", "--length", "0.3"), "one for each"),
        ((STEEL, "ring.csv", "ring.csv", "--length", "0.31", "--length", "0.9"), "of no strip"),
    ):
        assert status_of(["identify", "--beam", *words]) == 2
        assert remedy in capsys.readouterr().err


@pytest.mark.parametrize("share", [0.0, 0.1])
def test_a_hold_before_the_release_and_missing_rows_leave_stiffness_and_clamp(capsys, share):
    truth, compliance, rng = 0.5371, 0.03, np.random.default_rng(1)
    for name, length in (("long.csv", 0.31), ("short.csv", 0.19)):
        write(name, hertz(length, truth, compliance, 2), lambda hz: 0.0043, 3, noise=0.12, sizes=(11.6, 0.36))
        head, *rows = Path(name).read_text().splitlines()
        held = [f"{1e3 * k / 480.0:.3f},7.3" for k in range(24)]
        moved = [f"{float(row.split(',')[0]) + 50.0:.3f},{row.split(',')[1]}" for row in rows]
        kept = [row if rng.random() > share else row.split(",")[0] + "," for row in [*held, *moved]]
        Path(name).write_text("\n".join([head, *kept]) + "\n")
    found, _, _ = identified(capsys, "long.csv", "short.csv", "--length", "310mm", "--length", "190mm")
    assert contains(found["bending_stiffness"], truth)
    assert contains(found["compliance"], compliance)


def test_a_camera_slower_than_the_first_mode_is_named(capsys):
    for name, length in (("long.csv", 0.31), ("short.csv", 0.15)):
        write(name, hertz(length, 0.5371, 0.02, 1), lambda hz: 0.0043, 3)
        table = np.loadtxt(name, delimiter=",", skiprows=1)[::16]  # 30 frames a second for 35 Hz
        np.savetxt(name, table, fmt="%.3f", header="t_ms,tip_mm", delimiter=",", comments="")
    words = ["long.csv", "short.csv", "--length", "310mm", "--length", "150mm"]
    assert status_of(["identify", "--beam", STEEL, *words]) == 2
    assert "film faster" in capsys.readouterr().err
