"""Records of free vibration as engineers write them: read, or refused with the field and the remedy."""

from math import pi

import numpy as np
import pytest

from verify.cli import status_of
from verify.compare.record import read_record
from verify.errors import InputError
from verify.identify.ring_down import ring_down

TIMES = np.arange(0.0, 1.5, 1.0 / 240.0)
MODES = [(6.83, 0.011, 30.0, 0.3), (42.6, 0.017, 4.0, 1.1)]


def vibration(times, modes=MODES, noise=0.03, seed=2):
    y = 3.0 + noise * np.random.default_rng(seed).standard_normal(len(times))
    for hz, zeta, size, phase in modes:
        rate = 2.0 * pi * hz
        y = y + size * np.exp(-zeta * rate * times) * np.cos(rate * np.sqrt(1.0 - zeta**2) * times + phase)
    return y


def lines(head, *columns, form="{:.9g}", between=","):
    rows = [between.join(form.format(value) for value in row) for row in zip(*columns, strict=True)]
    return [head, *rows] if head else rows


Y = vibration(TIMES)
PLAIN = lines("t,y", TIMES, Y)


@pytest.mark.parametrize(
    "text",
    [
        PLAIN,
        lines("", TIMES, Y),
        lines("t [ms],tip [mm]", 1e3 * TIMES, Y),
        lines('"Time_us";"y"', 1e6 * TIMES, Y, between=";"),
        [line.replace(".", ",") for line in lines("t;y", TIMES, Y, between=";", form="{:.9f}")],
        lines("# time x y", TIMES, 0.01 * Y, Y, between=" "),
        lines("timestamp\tframe\ty", TIMES, 0.0 * TIMES, Y, between="\t"),
        lines("t,y", TIMES, Y, form="{:.3f}"),  # spacing 4.1667 ms
        [f"{line}," for line in PLAIN],
        [line if k % 17 else line.split(",")[0] + "," for k, line in enumerate(PLAIN, start=1)],
        [line if k % 17 else line.split(",")[0] + ",NaN" for k, line in enumerate(PLAIN, start=1)],
        PLAIN[:90] + PLAIN[97:],
        PLAIN[:90] + PLAIN[89:],
        lines("t,y", TIMES.astype(np.float32), Y.astype(np.float32)),
        lines("t,y", np.append(np.arange(80) / 240.0, TIMES + 1.0 / 3.0), np.append(vibration(0.0 * TIMES[:80]), Y)),
        lines("t,y", TIMES + 0.2, np.where(TIMES < 0.3, 110.0 * TIMES, vibration(np.maximum(TIMES - 0.3, 0.0)))),
    ],
)
def test_the_same_vibration_is_read_from_every_file(tmp_path, text):
    (tmp_path / "ring.csv").write_text("\n".join(text) + "\n")
    record = read_record(tmp_path / "ring.csv")
    found = ring_down(record.times, record.signals)
    assert found.white
    assert found.hertz == pytest.approx([hz * np.sqrt(1.0 - zeta**2) for hz, zeta, *_ in MODES], rel=1e-3)
    assert [mode.zeta for mode in found.modes] == pytest.approx([0.011, 0.017], rel=0.05)
    for mode, (hz, zeta, *_) in zip(found.modes, MODES, strict=True):
        assert abs(mode.hz - hz * np.sqrt(1.0 - zeta**2)) < np.diff(mode.hz_interval)[0]  # four standard deviations
        assert abs(mode.zeta - zeta) < np.diff(mode.zeta_interval)[0]


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        (lines("", np.arange(360), Y), "name the columns"),
        (PLAIN + PLAIN[1:], r"row 361: time 0 .* ascending"),
        ([*PLAIN[:90], PLAIN[89].split(",")[0] + ",7", *PLAIN[90:]], "row 90"),
        ([*PLAIN[:90], "lost,7", *PLAIN[90:]], "row 90.* correct it"),
        ([*PLAIN[:90], "0.3704,7,8", *PLAIN[90:]], "row 90.* cut it"),
        (lines("t,y", TIMES, np.nan * TIMES), "0 rows"),
        (lines("t,y", TIMES, 0.0 * TIMES + 2.5), "constant"),
        (lines("t,y", TIMES, vibration(0.0 * TIMES)), "nothing rings|no frequency rings"),
    ],
)
def test_what_is_no_record_is_refused_in_one_sentence(tmp_path, text, remedy):
    (tmp_path / "ring.csv").write_text("\n".join(text) + "\n")
    with pytest.raises(InputError, match=remedy) as refused:
        ring_down(*read_record(tmp_path / "ring.csv")[:2])
    assert len(refused.value.sentences) == 1


def test_a_long_output_of_a_solver_is_a_list_and_no_record(tmp_path):
    rows = [f"{n} {(2 * pi * hz) ** 2:.7E} {2 * pi * hz:.7E} {hz:.7E}" for n, hz in ((1, 27.584), (2, 172.866))]
    text = ["S T E P 1", *["E I G E N V A L U E   O U T P U T"] * 16, *rows]
    (tmp_path / "out.dat").write_text("\n".join(text) + "\n")
    assert read_record(tmp_path / "out.dat") is None


def test_close_modes_and_slow_sampling(tmp_path, capsys):
    times = np.linspace(0.0, 2.0, 1500)
    close = ring_down(times, vibration(times, [(50.0, 0.004, 1.0, 0.2), (51.5, 0.006, 0.7, 1.0)], noise=1e-3))
    assert close.hertz == pytest.approx([50.0, 51.5], rel=1e-4)
    assert [mode.zeta for mode in close.modes] == pytest.approx([0.004, 0.006], rel=0.01)
    times = np.arange(0.0, 2.0, 1.0 / 90.0)  # mode 2 of the cantilever, 172.87 Hz, folds to 7.13 Hz
    y = vibration(times, [(27.584, 0.01, 3.0, 0.2), (172.866, 0.004, 0.5, 1.0)], noise=1e-3)
    (tmp_path / "ring.csv").write_text("\n".join(lines("t,y", times, y)))
    status_of(["compare", "steel-cantilever", str(tmp_path / "ring.csv")])
    text = " ".join(capsys.readouterr().out.split())
    assert "mode 2 of the beam (172.9 Hz) appears at 7.13 Hz" in text
    assert "sample at 432 Hz" in text
