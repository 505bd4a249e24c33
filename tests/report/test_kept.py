"""Runs that are kept: what lies where, what is pruned and what never is, and pages rendered again."""

import json

import pytest
from msgspec.structs import replace
from strip import STRIP

from verify import __version__, run_scene
from verify.cli import status_of
from verify.errors import InputError
from verify.report.html import page
from verify.report.kept import KEPT, keep, read_kept, runs_at, runs_in
from verify.scenes.scene import load_scene


@pytest.fixture
def strip(tmp_path, monkeypatch):
    """The strip's result, in an empty folder with its file."""
    (tmp_path / "strip.toml").write_text(STRIP)
    monkeypatch.chdir(tmp_path)
    return run_scene(load_scene("strip.toml"))


def test_a_run_lies_beside_what_it_says_and_the_latest_page_is_a_copy_of_it(strip, tmp_path, capsys):
    assert status_of(["run", "strip.toml", "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    (run,) = (tmp_path / "reports" / "strip").iterdir()
    assert sorted(path.name for path in run.iterdir()) == ["index.html", "run.json"]
    latest = tmp_path / "reports" / "strip.html"
    assert not latest.is_symlink()
    assert latest.read_bytes() == (run / "index.html").read_bytes()
    assert json.loads((run / "run.json").read_text("utf-8"))["figures"] == told
    assert told["report"] == "reports/strip.html"


def test_a_run_is_told_where_it_is_kept(strip, tmp_path, capsys):
    assert status_of(["run", "strip.toml"]) == 0
    (run,) = (tmp_path / "reports" / "strip").iterdir()
    assert f"kept: {run.relative_to(tmp_path)}\n" in capsys.readouterr().out


def test_the_newest_runs_are_kept_and_no_folder_that_is_not_ours_is_touched(strip, tmp_path):
    """Somebody's note in a run's folder, a folder of another name and a link stay, however old."""
    home = tmp_path / "strip"
    runs = [keep(strip, tmp_path, "strip", "verify run", 9).folder for _ in range(4)]
    old = home / "2001-02-03_04-05-06"
    for name in ("2001-02-03_04-05-07", "mine", "2001-02-03"):
        (home / name).mkdir()
        (home / name / "run.json").write_text("{}")
    (home / "2001-02-03_04-05-07" / "note.txt").write_text("mine")
    (home / "2001-02-03_04-05-08").symlink_to(runs[0])
    runs[0].rename(old)
    assert runs_in(home) == [old, *runs[1:]]
    last = keep(strip, tmp_path, "strip", "verify run", 2).folder
    assert runs_in(home) == [runs[3], last]
    left = {path.name for path in home.iterdir()} - {runs[3].name, last.name}
    assert left == {"2001-02-03_04-05-07", "mine", "2001-02-03", "2001-02-03_04-05-08"}
    assert (home / "2001-02-03_04-05-07" / "note.txt").read_text() == "mine"
    assert not list(tmp_path.glob(".*"))


def test_numbers_behind_a_time_are_counted_and_not_spelt(tmp_path):
    names = ["2001-02-03_04-05-06", "2001-02-03_04-05-06-2", "2001-02-03_04-05-06-10", "2001-02-03_04-05-07"]
    for name in names:
        (tmp_path / name).mkdir()
        (tmp_path / name / "run.json").write_text("{}")
    assert [path.name for path in runs_in(tmp_path)] == names


def test_the_run_that_was_just_made_is_never_the_one_that_is_taken_away(strip, tmp_path):
    """However many there are in one second, of which the first are gone already."""
    for _ in range(7):
        last = keep(strip, tmp_path, "strip", "verify run", 2).folder
        assert runs_in(tmp_path / "strip")[-1] == last
    assert len(runs_in(tmp_path / "strip")) == 2


def test_none_is_kept_where_none_is_wanted_and_the_latest_page_is_there(strip, tmp_path):
    keep(strip, tmp_path, "strip", "verify run")
    written = keep(strip, tmp_path, "strip", "verify run", 0)
    assert written.folder is None
    assert written.latest.is_file()
    assert runs_in(tmp_path / "strip") == []
    from verify.commands.run import run

    assert (
        next(one.default for one in run.params if one.name == "most") == KEPT >= 2
    )  # or `verify diff` had nothing to compare


def test_without_a_report_nothing_is_kept(strip, tmp_path):
    assert status_of(["run", "strip.toml", "--no-report"]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["strip.toml"]


def test_what_set_changes_has_a_name_and_runs_of_its_own(strip, tmp_path):
    assert status_of(["run", "strip.toml", "--set", "beam.length=0.4"]) == 0
    names = sorted(path.name for path in (tmp_path / "reports").iterdir())
    assert names == ["strip--beam.length=0.4", "strip--beam.length=0.4.html"]
    (kept,) = runs_at(tmp_path / "reports", "A").values()
    assert (kept.report, kept.document.name) == ("strip--beam.length=0.4", "strip")


def test_a_file_where_runs_are_to_be_kept_is_told_before_anything_is_run(strip, tmp_path, capsys):
    (tmp_path / "reports").mkdir()
    (tmp_path / "reports" / "strip").write_text("mine")
    assert status_of(["run", "strip.toml"]) == 2
    assert capsys.readouterr() == ("", "verify: reports = 'reports/strip' is no folder, and runs are kept there: move it, or give --keep 0\n")  # fmt: skip
    assert status_of(["run", "strip.toml", "--keep", "0"]) == 0
    assert (tmp_path / "reports" / "strip").read_text() == "mine"


@pytest.mark.parametrize("words", [("report", "RUN", "--to", "RUN"), ("diff", "RUN", "RUN", "--to", "RUN")])
def test_no_page_takes_the_place_of_a_run(strip, tmp_path, capsys, words):
    """`verify diff a.json b.json --to b.json` wrote its page over the run."""
    was = (keep(strip, tmp_path, "strip", "verify run strip").folder / "run.json").rename("a.json").read_bytes()
    assert status_of(["a.json" if word == "RUN" else word for word in words]) == 2
    assert capsys.readouterr().err == "verify: --to = 'a.json' is no name of a page: let it end in .html\n"
    assert (tmp_path / "a.json").read_bytes() == was


@pytest.mark.parametrize("name", ["paper", "patched-strip"])
def test_a_page_rendered_again_is_the_page_that_was(name, tmp_path, capsys):
    """To the last character: charts, tables and gates go through JSON and come back."""
    written = keep(run_scene(name), tmp_path, name, f"verify run {name}")
    was = written.latest.read_text("utf-8")
    assert was.count("<figure") >= 1
    assert status_of(["report", str(written.folder / "run.json"), "--to", str(tmp_path / "again.html")]) == 0
    assert capsys.readouterr().out == f"report: {tmp_path / 'again.html'}\n"
    assert (tmp_path / "again.html").read_text("utf-8") == was
    (written.folder / "index.html").unlink()
    assert status_of(["report", str(written.folder)]) == 0
    assert (written.folder / "index.html").read_text("utf-8") == was


STANDING = """
[drive]
frequency_hz = 777.0
force = [{ position = 0.05 }]
[[gate]]
id = "standing"
quantity = "wave.standing_wave_ratio"
arguments = { model = "analytic", window = [0.1, 0.4] }
at_least = 5.0
why = "One force and no loss: nothing travels."
"""


def test_a_figure_without_bound_is_kept_as_what_it_is(tmp_path, monkeypatch):
    """JSON has no number for it: an undamped beam's standing-wave ratio under one force."""
    from verify.report.html import rendered

    (tmp_path / "strip.toml").write_text(STRIP + STANDING)
    monkeypatch.chdir(tmp_path)
    written = keep(run_scene("strip.toml"), tmp_path, "strip", "verify run")
    document = read_kept(written.folder / "run.json", "A").document
    assert document.gates[-1].measured == float("inf")
    assert rendered(document) == written.latest.read_text("utf-8")


def test_numbers_of_numpy_in_a_chart_of_somebodys_study_are_kept_as_numbers(strip, tmp_path):
    import numpy as np
    from msgspec.structs import replace

    from verify.report.document import document_of
    from verify.report.kept import as_text
    from verify.studies.chart import Axis, Chart, Line

    line = Line(name="a", x=(np.float64(1.5), np.float32(0.25)), y=(np.float64("nan"), 3.0), colour="#000000")
    chart = Chart(id="own", title="Own", caption="", x=Axis("x"), y=Axis("y"), lines=(line,))
    (tmp_path / "run.json").write_text(as_text(replace(document_of(strip, ""), charts=(chart,)), "strip", {}))
    (read,) = read_kept(tmp_path / "run.json", "A").document.charts
    assert (read.lines[0].x, read.lines[0].y) == ((1.5, 0.25), (None, 3.0))


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (None, "cannot be read (No such file or directory): give the run.json of a run that is kept"),
        ("", "is no run that was kept: give the run.json of a run that is kept"),
        ("[1]", "is no run that was kept"),
        ('{"scene": "paper", "passed": true}', "is no run that was kept"),
        (b"\xff\xfe", "is no run that was kept"),
        ('{"layout": 7, "verify": "9.1"}', "was written by verify 9.1, and this is "),
        ('{"layout": 1, "verify": "0.0.9"}', "lays runs out otherwise (Object missing required field `report`): run"),
        (f'{{"layout": 1, "verify": "{__version__}"}}', f"is no run as verify {__version__} keeps it (Object missing"),
    ],
)
def test_anything_else_is_refused_in_one_sentence(tmp_path, capsys, text, said):
    path = tmp_path / "run.json"
    if text is not None:
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
    assert status_of(["report", str(path), "--to", str(tmp_path / "x.html")]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert err.startswith(f"verify: run = '{path}' ")
    assert said in err
    assert not (tmp_path / "x.html").exists()


@pytest.mark.parametrize("value", [1e308, -1e308])
def test_a_number_that_no_axis_holds_is_refused_where_it_is_read(tmp_path, value):
    bar = replace(load_scene("free-free-bar"), gate=(), claim=())
    folder = keep(run_scene(bar), tmp_path, "strip", "verify run", 9).folder
    kept = json.loads((folder / "run.json").read_text("utf-8"))
    chart = next(one for one in charts_in(kept) if one["lines"])
    chart["lines"][0]["y"] = [value] * len(chart["lines"][0]["y"])
    (folder / "run.json").write_text(json.dumps(kept), encoding="utf-8")
    with pytest.raises(InputError, match=r"is no run as verify .* keeps it .*1e.200"):
        read_kept(folder / "run.json", "run")


def charts_in(data):
    """Every chart of a kept run, wherever it stands."""
    if isinstance(data, dict):
        if "lines" in data and "bars" in data:
            yield data
        data = list(data.values())
    for one in data if isinstance(data, list) else ():
        yield from charts_in(one)


def test_the_page_that_is_kept_is_the_page_of_the_result(strip, tmp_path):
    """But for the minute at which it was made."""
    written = keep(strip, tmp_path, "strip", "verify run strip.toml")
    dates = [line for line in written.latest.read_text("utf-8").splitlines() if "UTC" not in line]
    assert dates == [line for line in page(strip, "verify run strip.toml").splitlines() if "UTC" not in line]


def test_a_folder_without_a_run_is_refused(tmp_path):
    (tmp_path / "strip").mkdir()
    with pytest.raises(InputError, match=r"B = '.*' holds no run that was kept: give a run.json"):
        runs_at(tmp_path, "B")
    with pytest.raises(InputError, match=r"A = '.*nowhere' is not there"):
        runs_at(tmp_path / "nowhere", "A")


def test_a_name_that_no_file_can_have_is_refused(capsys):
    assert status_of(["report", "1" * 400]) == 2
    assert "run = " in capsys.readouterr().err
