"""Lists in the layouts that others write them in, and what is wrong with some, in one sentence each."""

from io import BytesIO, TextIOWrapper
from pathlib import Path

import numpy as np
import pytest

from verify.cli import status_of
from verify.errors import InputError
from verify.identify.reading import read_frequencies, read_shapes

HERTZ = [27.57, 172.561, 482.627]


@pytest.fixture
def read(tmp_path):
    def call(text, **settings):
        path = tmp_path / "list.csv"
        path.write_text(text, encoding="utf-8")
        return read_frequencies(path, **settings)

    return call


@pytest.mark.parametrize(
    "text",
    [
        "27.57\n172.561\n482.627\n",
        "frequency_hz\n27.57\n172.561\n482.627",
        "27,57\n172,561\n482,627\n",
        "1,27.57\n2,172.561\n3,482.627\n",
        "0;27,57\n1;172,561\n2;482,627\n",
        "mode;f [Hz]\n1;27,57\n2;172,561\n3;482,627\n",
        "mode\tfrequency\n1\t27.57\n2\t172.561\n3\t482.627\n",
        "  1   27.57\n  2  172.561\n  3  482.627\n",
        "1 27,57\n2 172,561\n3 482,627\n",
        "Mode number, Frequency (Hz)\n1, 27.57\n2, 172.561\n3, 482.627\n",
        "# f/Hz\n2.757e1\n1.72561e2\n4.82627e+02\n",
        "\ufeffn;omega [rad/s];f [Hz];damping\n1;173,2;27,57;0,01\n2;1084,2;172,561;0,01\n3;3032,4;482,627;0,02\n",
        '"mode","freq"\n"1","27.57"\n"2","172.561"\n"3","482.627"\n',
        "27.57\r\n172.561\r\n\r\n482.627\r\n",
    ],
)
def test_every_layout_reads_the_same(read, text):
    assert read(text).frequencies_hz == pytest.approx(HERTZ, rel=1e-12)


def test_a_dash_is_what_is_piped_in(monkeypatch):
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(b"f_kHz\n1.5\n2.5\n")))
    listed = read_frequencies(Path("-"))
    assert (listed.frequencies_hz.tolist(), listed.unit) == ([1500.0, 2500.0], "kHz")
    assert listed.source == "frequencies on standard input"
    for nothing in (TextIOWrapper(BytesIO(b"")), None):
        monkeypatch.setattr("sys.stdin", nothing)
        with pytest.raises(InputError, match=r"^frequencies on standard input is empty: give a number on each line"):
            read_frequencies(Path("-"))
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(b"3\xff")))
    with pytest.raises(InputError, match=r"^frequencies on standard input is not text in UTF-8"):
        read_frequencies(Path("-"))


@pytest.mark.parametrize(
    ("head", "unit", "factor"),
    [
        ("omega", None, 2 * np.pi),
        ("mode;ω (rad/s)", None, 2 * np.pi),
        ("circular frequency rad/s", None, 2 * np.pi),
        ("f_kHz", None, 1e-3),
        ("f_Hz", "rad/s", 2 * np.pi),
        ("", "kHz", 1e-3),
    ],
)
def test_the_unit_is_that_of_the_head_unless_one_is_given(read, head, unit, factor):
    numbered = head.startswith("mode")
    rows = [f"{i};{f * factor!r}" if numbered else repr(f * factor) for i, f in enumerate(HERTZ, 1)]
    listed = read("\n".join(filter(None, [head, *rows])), unit=unit)
    assert listed.frequencies_hz == pytest.approx(HERTZ, rel=1e-12)
    assert listed.unit != "Hz"


@pytest.mark.parametrize("scatter", ["freq std", "σ [Hz]", "frequency error (Hz)", "f_sd"])
def test_the_scatter_of_frequencies_is_not_taken_for_them(read, scatter):
    listed = read("\n".join([f"mode,{scatter},freq mean", *(f"{i},0.05,{f!r}" for i, f in enumerate(HERTZ, 1))]))
    assert listed.frequencies_hz == pytest.approx(HERTZ, rel=1e-12)


@pytest.mark.parametrize("beside", ["damping ratio", "zeta", "Q", "frequency error (Hz)"])
@pytest.mark.parametrize(
    "name", ["frequency (Hz) ±0.1 %", "frequency (Hz) (std 0.1)", "f +/- 0.3 Hz", "f (±0.2)", "freq (σ = 1e-3 Hz)"]
)
def test_frequencies_whose_head_says_how_far_they_scatter_are_frequencies(read, name, beside):
    rows = (f"{i},{f!r},0.0{i + 1}" for i, f in enumerate(HERTZ, 1))
    listed = read("\n".join([f"mode,{name},{beside}", *rows]))
    assert listed.frequencies_hz == pytest.approx(HERTZ, rel=1e-12)


def test_mode_numbers_and_rounding_are_kept(read):
    listed = read("mode,f\n2,10.5\n5,1.25e3\n")
    assert listed.numbers == (2, 5)
    assert listed.rounding == pytest.approx([0.05 / 10.5, 5.0 / 1250.0])


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("27.57\nabout 170\n482.6\n", "line 2"),
        ("27.57\nhundred\n482.6\n", "line 2: 'hundred' is no number"),
        ("mode;f\n1;27.57\n2;\n3;482.6\n", "line 3 has a gap where a frequency should stand"),
        ("1,27.57\n2\n3,482.6\n", "line 2 has 1 cells and the first row 2"),
        ("27.57\n482.6\n172.5\n", "line 3: 172.5 lies below 482.6 before it"),
        ("27.57\n-172.5\n", "line 2 has -172.5: frequencies are not negative"),
        ("27.57\nnan\n482.6\n", "line 2: nan is no frequency"),
        ("27.57\ninf\n", "line 2: inf is no frequency"),
        ("", "is empty"),
        ("mode,frequency\n", "a head and no numbers"),
        ("1.5 27.5 3\n2.5 172.5 4\n", "which holds the frequencies cannot be told"),
        ("mode,f\n1,27.5\n1,172.5\n", "line 3: mode number 1 is no whole number above the one before"),
        (
            "mode,freq exact,freq mine\n1,27.5,27.4\n",
            "has 2 columns of frequencies, 'freq exact' and 'freq mine': leave the one",
        ),
        (
            "mode,frequency (Hz) ±0.1 %,freq exact\n1,27.5,27.4\n",
            "has 2 columns of frequencies, 'frequency (Hz) ±0.1 %' and 'freq exact': leave the one",
        ),
        (
            "mode,freq std,zeta\n1,27.5,0.02\n",
            "'freq std' is named after frequencies and after scatter, 'zeta' after neither: name the one to compare "
            "'frequency_hz'",
        ),
        ("0\n0\n", "holds zeros alone"),
        ("1e-200\n2e-200\n", "1e-200 Hz, and the beam's modes lie from 9.23541 Hz on: check the scene, or the unit"),
    ],
)
def test_a_list_that_is_none_gets_one_sentence_and_status_2(tmp_path, capsys, text, said):
    path = tmp_path / "list.csv"
    path.write_text(text)
    assert status_of(["compare", str(path), "--scene", "paper", "--count", "20"]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ((), "give a file of frequencies, or --model"),
        (("nowhere.csv",), "cannot be read: No such file"),
        (("list.csv", "--mode", "4"), "mode = 4: frequencies file 'list.csv' has 3 modes, ask for one of them"),
        (("list.csv", "--count", "0"), "count = '0': give a whole number from 1"),
        (("list.csv", "--count", "1"), "no model of so few parts has the 3 modes"),
        (("list.csv", "--theory", "cosserat"), "theory = 'cosserat' is not known"),
        (("list.csv", "--within", "-1%"), "within = '-1%': give a relative error"),
        (("list.csv", "--modes", "few.csv"), "has 2 mode shapes beside x, and the list 3 frequencies"),
        (("list.csv", "--modes", "off.csv"), "x = 0.7 m lies off the beam"),
        (("list.csv", "--modes", "rest.csv"), "the shape of mode 2 is zero everywhere"),
        (("list.csv", "--modes", "back.csv"), "x = 0.1 m does not rise"),
        (("list.csv", "--modes", "text.csv"), "line 2: 'x1' is no number"),
        (("list.csv", "--model", "a:B"), "one of them"),
        (("--model", "json:JSONDecoder", "--unit", "Hz", "--count", "4"), "--unit belongs to a file"),
    ],
)
def test_other_bad_input_gets_one_sentence_and_status_2(tmp_path, monkeypatch, capsys, words, said):
    monkeypatch.chdir(tmp_path)
    shapes = {
        "few": "0.0 0 0\n0.2 1 1\n0.4 1 0",
        "off": "0.0 0 0 0\n0.2 1 1 1\n0.7 1 0 1",
        "rest": "0.0 0 0 0\n0.2 1 0 1\n0.4 1 0 1",
        "back": "0.0 0 0 0\n0.2 1 1 1\n0.1 1 0 1",
        "text": "0.0 0 0 0\nx1 1 1 1\n0.3 1 0 1",
    }
    for name, text in shapes.items():
        (tmp_path / f"{name}.csv").write_text(text)
    (tmp_path / "list.csv").write_text("9.2\n36.9\n83.1\n")
    assert status_of(["compare", *words, "--scene", "paper"]) == 2
    err = capsys.readouterr().err
    assert said in err
    assert err.count("\n") == 1


def test_an_unsorted_list_is_taken_where_shapes_say_which_mode_is_which(read):
    with pytest.raises(InputError, match="sort the list, or give the shapes"):
        read("83.1\n9.2\n")
    assert list(read("83.1\n9.2\n", sorted_list=False).frequencies_hz) == [83.1, 9.2]


def test_shapes_are_columns_beside_x(tmp_path):
    path = tmp_path / "shapes.csv"
    path.write_text("x;mode 1;mode 2\n0,0;0;0\n0,2;0,9;1,5\n0,5;0;-2\n")
    shapes = read_shapes(path, 0.5, 2)
    assert list(shapes.x) == [0.0, 0.2, 0.5]
    assert shapes.values.tolist() == [[0.0, 0.9, 0.0], [0.0, 1.5, -2.0]]
