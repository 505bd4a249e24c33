"""Steady records: amplitude and phase against the exact field, by the modal series of a pinned beam."""

import json
from math import pi

import numpy as np
import pytest

from verify.cli import status_of

LENGTH, EI, MASS, ETA, HZ = 0.7, 41.0, 0.63, 0.02, 57.0
FORCES = ((0.2, 3.0, 25.0), (0.55, 1.7, -80.0))
SCENE = f"""
name = "bar"
[beam]
length = {LENGTH}
bending_stiffness = {EI}
mass_per_length = {MASS}
loss_factor = {ETA}
supports = ["pinned", "pinned"]
[drive]
frequency_hz = {HZ}
""" + "".join(f"[[drive.force]]\nposition = {x}\namplitude = {f}\nphase_deg = {phase}\n" for x, f, phase in FORCES)


def series(x):
    """Complex deflection of the pinned beam under FORCES by 600 modes, m."""
    k = np.arange(1, 601) * pi / LENGTH
    gain = 2.0 / (MASS * LENGTH) / (EI / MASS * k**4 * (1.0 + 1j * ETA) - (2.0 * pi * HZ) ** 2)
    load = sum(f * np.exp(1j * np.radians(phase)) * np.sin(k * at) for at, f, phase in FORCES)
    return complex((gain * load * np.sin(k * x)).sum())


@pytest.fixture
def recorded(tmp_path, monkeypatch):
    """Write bar.toml and the record of two places with noise, offset and drift, in mm over ms."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bar.toml").write_text(SCENE)
    times = np.sort(np.random.default_rng(4).uniform(0.3, 0.6, 900))
    waves = np.stack([(series(x) * np.exp(2j * pi * HZ * times)).real for x in (0.15, 0.4)], axis=1)
    noise = 2e-3 * abs(waves).max() * np.random.default_rng(5).standard_normal(waves.shape)
    y = 1e3 * (waves + noise) + 0.02 * times[:, None] + 0.3
    np.savetxt("steady.csv", np.c_[1e3 * times, y], header="t_ms,a_mm,b_mm", delimiter=",", comments="")


def test_amplitude_and_phase_are_within_their_intervals(recorded, capsys):
    line = ["compare", "bar.toml", "steady.csv", "--drive", "scene", "--at", "150mm", "--at", "0.4"]
    assert status_of([*line, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)["sines"]
    for one, x in zip(found, (0.15, 0.4), strict=True):
        exact = series(x)
        assert one["amplitude"] == pytest.approx(abs(exact), abs=2.0 * one["within"])  # four standard deviations
        assert one["phase"] == pytest.approx(np.degrees(np.angle(exact)), abs=2.0 * one["phase_within"])
        # Two of 900 samples' noise of 0.2 % of the largest amplitude, 1.96 standard deviations:
        assert one["within"] == pytest.approx(
            1.96 * 2e-3 * max(abs(series(p)) for p in (0.15, 0.4)) / 450**0.5, rel=0.2
        )
    assert status_of([*line[:-1], "0.45"]) == 1
    assert "b_mm is" in capsys.readouterr().out


def test_what_is_not_steady_or_sampled_too_slowly_is_refused_or_named(recorded, capsys):
    assert status_of(["compare", "bar.toml", "steady.csv", "--drive", "31Hz"]) == 0
    assert "not white" in " ".join(capsys.readouterr().out.split())
    assert status_of(["compare", "bar.toml", "steady.csv", "--drive", "2kHz"]) == 2
    assert "sampled faster" in capsys.readouterr().err
    status_of(["compare", "bar.toml", "steady.csv"])
    assert "--drive 57Hz" in " ".join(capsys.readouterr().out.split())
