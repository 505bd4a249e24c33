"""Records of free vibration as lists of frequencies with damping."""

from math import pi

import numpy as np
import pytest
from msgspec.structs import replace

import verify
from verify.errors import InputError

STEEL = verify.Beam(
    length=1.0, width=0.04, thickness=0.008, youngs_modulus=210e9, density=7850.0, supports=("clamped", "free")
)
FULL = [6.3655, 39.9460, 111.985]  # 20 links with EI/l at the wall, 4 to 5 digits
RATIOS = [0.008, 0.011, 0.015]


@pytest.fixture
def ring():
    """(n, 2): times, s, and the tip, m, of the chain that rings in three modes."""
    times, tip = np.arange(0.0, 1.9, 5e-4), 0.002
    for k, (hz, zeta, size) in enumerate(zip(FULL, RATIOS, (1e-3, 3e-4, 1e-4), strict=True)):
        omega = 2.0 * pi * hz
        tip = tip + size * np.exp(-zeta * omega * times) * np.cos(omega * np.sqrt(1.0 - zeta**2) * times + k)
    return np.stack([times, tip + 1e-6 * np.random.default_rng(2).standard_normal(len(times))], axis=1)


@pytest.mark.parametrize(
    ("head", "scale", "between"),
    [("time [ms],tip [m]\n", 1e3, ","), ("", 1.0, " "), ("# t; w\n", 1.0, ";"), ("Time (s)\ttip\n", 1.0, "\t")],
)
def test_a_record_names_the_wall_joint_and_its_damping(tmp_path, ring, head, scale, between):
    path = tmp_path / "ring.csv"
    rows = [f"{scale * t:.9g}{between}{y:.9g}" for t, y in ring]
    path.write_text(head + "\n".join(rows) + "\n")
    result = verify.compare_frequencies(STEEL, path, count=20)
    assert result.data["best"]["wall"] == "full"
    assert not result.data["passed"]
    assert [mode["undamped_hz"] for mode in result.data["record"]] == pytest.approx(FULL, rel=1e-4)
    assert [mode["zeta"] for mode in result.data["record"]] == pytest.approx(RATIOS, rel=2e-2)


def test_a_list_with_mode_numbers_is_no_record(tmp_path):
    path = tmp_path / "list.csv"
    hertz = verify.ExactModel(STEEL).modes(18).frequencies_hz
    path.write_text("".join(f"{i},{hz:.6f}\n" for i, hz in enumerate(hertz, start=1)))
    result = verify.compare_frequencies(STEEL, path)
    assert "record" not in result.data
    assert result.data["passed"]


def test_noise_alone_is_refused(tmp_path):
    path = tmp_path / "noise.csv"
    values = np.random.default_rng(4).standard_normal(300)
    path.write_text("t,y\n" + "".join(f"{0.01 * i:.2f},{y:.6f}\n" for i, y in enumerate(values)))
    with pytest.raises(InputError, match="rings"):
        verify.compare_frequencies(STEEL, path)


def test_a_mode_of_two_cycles_beside_an_aliased_one_is_left_out(tmp_path):
    path, hertz = tmp_path / "ring.csv", verify.ExactModel(STEEL).modes(9).frequencies_hz
    times, tip = np.arange(0.0, 2.0, 0.00105), 0.0  # mode 6 is above half the sampling rate
    for hz in hertz:  # released from a force at the tip, dashpots in proportion to the springs
        zeta, omega = 0.0021 * hz / hertz[0], 2.0 * pi * hz
        tip = tip + np.exp(-zeta * omega * times) * np.cos(omega * np.sqrt(1.0 - zeta**2) * times) / hz**2
    path.write_text("t,tip\n" + "".join(f"{t:.9g},{y:.12g}\n" for t, y in zip(times, tip, strict=True)))
    result = verify.compare_frequencies(STEEL, path)
    assert result.data["passed"]
    assert len(result.data["record"]) > 4
    assert [row["listed"] for row in result.tables[0].records()] == pytest.approx(hertz[:4], rel=5e-3)


@pytest.mark.parametrize("supports", [("clamped", "free"), ("pinned", "pinned")])
def test_tones_of_a_large_vibration_are_no_modes_of_the_beam(tmp_path, supports):
    """A square term of the signal rings at sums and differences; 9 f of pinned ends, f + 8 f, is a mode."""
    beam = replace(STEEL, supports=supports)
    hertz = verify.ExactModel(replace(beam, youngs_modulus=0.9 * 210e9)).modes(3).frequencies_hz
    path, times, small = tmp_path / "ring.csv", np.arange(0.0, 2.0, 4e-4), 0.0
    for hz, size in zip(hertz, (1.0, 0.3, 0.1), strict=True):
        small = small + size * np.exp(-0.003 * 2.0 * pi * hz * times) * np.cos(2.0 * pi * hz * times)
    np.savetxt(
        path, np.stack([times, small + 0.002 * small**2], axis=1), header="t,z", delimiter=",", comments="", fmt="%.10g"
    )
    result = verify.compare_frequencies(beam, path)
    assert len(result.data["record"]) > 4
    assert [row["listed"] for row in result.tables[0].records()] == pytest.approx(hertz, rel=1e-4)
