"""Every command as it is called: exit status, what stands on which stream, and the numbers."""

import json
from math import pi, sqrt
from pathlib import Path

import pytest

from verify.cli import COMMANDS, status_of
from verify.scene.load import load_scene

SMALL = str(Path(__file__).parents[1] / "report" / "small.toml")
BARE = """name = "bare"
[beam]
length = 0.43
bending_stiffness = 3.1
mass_per_length = 0.27
supports = ["pinned", "pinned"]
[spectrum]
modes = 3
count = 9
[[gate]]
id = "fundamental"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 1 }
expect = 28.7860404
within = 1e-4
why = "Closed form."
"""
FUNDAMENTAL = pi / 2.0 * sqrt(3.1 / 0.27) / 0.43**2


@pytest.fixture
def bare(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bare.toml").write_text(BARE)


@pytest.fixture
def call(capsys):
    """Call a command line; (exit status, standard output, error stream)."""

    def called(line, *more):
        status = status_of([*line.split(), *more])
        out, err = capsys.readouterr()
        return status, out, err

    return called


@pytest.fixture
def data(call):
    """JSON on standard output of a command that succeeds."""

    def called(line, *more):
        status, out, err = call(line, "--json", *more)
        assert (status, err) == (0, "")
        return json.loads(out)

    return called


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_has_help(call, name):
    status, out, _ = call(f"{name} --help")
    assert status == 0
    assert out.startswith(f"Usage: verify {name}")


@pytest.mark.parametrize("name", ["chain", "choose", "compare", "export", "measure", "sweep", "table"])
def test_a_command_alone_shows_one_that_works(call, name):
    status, out, err = call(name)
    assert (status, out) == (2, "")
    assert f"Usage: verify {name}" in err
    assert f"for example: verify {name} " in err


REFUSED = [
    ("runn", "No such command"),
    ("measure bare.toml", "Missing argument 'QUANTITY'"),
    ("measure nowhere mode.frequency model=fem mode=1 count=4", "neither a packaged scene nor a file"),
    ("measure bare.toml mode.frequency model=fem mode=40 count=4", "mode = 40"),
    ("measure bare.toml mode.frequency model=fem mode=1 count=4 --set beam.length=-1", "beam.length = -1"),
    ("table bare.toml --study spektrum", "did you mean 'spectrum'"),
    ("table bare.toml --study wave", "[drive]"),
    ("table bare.toml moods=1", "did you mean 'modes'"),
    ("table bare.toml --csv --json", "exclude each other"),
    ("choose bare.toml --mode 2 --error 5", "per cent"),
    ("choose bare.toml --mode 0 --error 1%", "mode = '0'"),
    ("choose bare.toml --mode 1,3 --error 1%", "the last mode, or all of a range"),
    ("choose bare.toml --mode 2 --error 1% wall", "RULE=VALUE"),
    ("quantities nothing-like-it", "no quantity matches"),
    ("scenes init bare.toml", "exists"),
    ("choose --mode 1 --error 1% --beam", "requires an argument"),
    ("choose bare.toml --mode 1 --error 1% --beam=1mx2x1mm_steel,clamped-free", "rule = 'bare.toml'"),
    ("measure --beam=1mx40x8mm,pinned mode.frequency model=analytic mode=1", "end it by two of pinned"),
    ("schema beam.sprung", "did you mean 'beam.spring'"),
    ("diff bare.toml bare.toml", "no saved run"),
    ("diff here there", "does not exist"),
    ("export bare.toml --to a.doc", "no file type"),
    ("run bare.toml --keep -1", "--keep"),
    ("sweep bare.toml", "sweep"),
    ("sweep bare.toml count=4,8", "QUANTITY is missing"),
]


@pytest.mark.parametrize(("line", "message"), REFUSED)
def test_bad_input_is_one_message(call, bare, tmp_path, line, message):
    status, out, err = call(line)
    assert (status, out) == (2, "")
    assert message in err
    assert "Traceback" not in err
    assert [one.name for one in tmp_path.iterdir()] == ["bare.toml"]


def test_measure_is_the_closed_form(call, data, bare):
    line = "measure bare.toml mode.frequency model=analytic mode=1"
    assert data(line)["value"] == pytest.approx(FUNDAMENTAL, rel=1e-12)
    assert call(line)[1].splitlines()[-1] == f"mode.frequency = {FUNDAMENTAL:.12g} Hz"
    longer = data(line, "--set", "beam.length=0.86")
    assert longer["value"] == pytest.approx(FUNDAMENTAL / 4.0, rel=1e-12)


def test_a_beam_in_one_line_stands_for_a_scene(data, call):
    words = (
        "measure mode.frequency model=analytic mode=1",
        "--beam",
        "30 in x tube 25 x 1.5mm aluminium, pinned-guided",
    )
    section = pi / 64.0 * (0.025**4 - 0.022**4), pi / 4.0 * (0.025**2 - 0.022**2)
    speed = sqrt(70e9 * section[0] / (2700.0 * section[1]))
    assert data(*words)["value"] == pytest.approx(pi / 8.0 * speed / 0.762**2, rel=1e-12)
    longer = data(*words, "--set", "beam.length=60in", "--set", "beam.density=2.7g/cm³")
    assert longer["value"] == pytest.approx(pi / 32.0 * speed / 0.762**2, rel=1e-12)
    rows = data("sweep mode.frequency model=analytic mode=1 beam.length=3in,30in", *words[1:])["tables"][0]["rows"]
    assert rows[0]["mode.frequency"] == pytest.approx(100.0 * rows[1]["mode.frequency"], rel=1e-12)
    status, out, _ = call("choose --mode 3 --error 1%", *words[1:])
    assert (status, "segments" in out) == (0, True)


def test_a_mode_needs_no_window_of_the_wave(call, data):
    loaded = "--set", "beam.mass=[{position=0.25,mass=0.01}]"  # at the middle of 27 g; [wave] has its window there
    with_mass, without = (
        data("measure paper mode.frequency model=analytic mode=1", *words)["value"] for words in (loaded, ())
    )
    assert 0.756 < with_mass / without < (1.0 + 2.0 * 0.01 / 0.027) ** -0.5  # Rayleigh's bound from above
    for refused in (
        "plan paper",
        "table paper --study wave",
        "measure paper mode.frequency mode=1 model=analytic wave",
    ):
        assert call(refused, *loaded)[0] == 2


def test_plan_lists_parts(data, bare):
    (table,) = data("plan bare.toml")["tables"]
    rows = {row["what"]: row for row in table["rows"]}
    assert rows["fundamental"]["runs"] is True
    assert rows["spectrum"]["runs"] is True
    assert rows["motion"]["runs"] is False
    (table,) = data("plan bare.toml", "--set", "beam.length=0.5")["tables"]
    assert "beam.length" in table["rows"][0]["quantity, or why skipped"]


def test_scenes_in_every_format(call, data):
    names = [row["scene"] for row in data("scenes")["tables"][0]["rows"]]
    assert {"paper", "steel-cantilever"} <= set(names)
    assert call("scenes --csv")[1].splitlines()[0] == "scene,title,gates"
    assert call("scenes --markdown")[1].count("\n") == len(names) + 2
    assert all(name in call("scenes")[1] for name in names)


def test_scenes_show_the_file_or_the_values(call, bare):
    assert call("scenes show bare.toml")[1] == BARE
    _, out, _ = call("scenes show bare.toml --set beam.length=0.86")
    assert "length = 0.86" in out


def test_new_scenes_are_valid(call, bare):
    assert call("scenes init mine.toml")[0] == 0
    assert call("plan mine.toml")[0] == 0
    assert call("scenes init copy.toml --from steel-cantilever")[0] == 0
    shown = call("scenes show steel-cantilever")[1]
    assert Path("copy.toml").read_text().endswith(shown.partition('name = "steel-cantilever"')[2])
    assert 'name = "copy"' in Path("copy.toml").read_text()
    assert call("scenes init copy.toml --from bare.toml --force")[0] == 0
    assert call("plan copy.toml")[0] == 0
    tube = "0.9 m x tube 30 x 2 mm steel, clamped-free"
    assert call("scenes init tube.toml --beam", tube)[0] == 0
    assert load_scene("tube.toml").beam == load_scene(f"beam: {tube}").beam
    assert call("bench modes --mode 2 --sizes 7,9 --seconds 0.01 --beam", tube)[0] == 0


def test_quantities_are_searched(call, data):
    every, few = data("quantities"), data("quantities mode order")
    assert len(every) > len(few) > 0
    assert {"mode.order"} <= {one["name"] for one in few}
    assert "Arguments of mode.plate_error" in call("quantities mode.plate_error")[1]


def test_table_in_every_format(call, data, bare):
    line = "table bare.toml modes=1,2 counts=5,7,9"
    first = data(line)["tables"][0]["rows"]
    assert sorted({row["N"] for row in first}) == [5, 7, 9]
    assert len(call(f"{line} --csv")[1].splitlines()) == len(first) + 1
    assert call(f"{line} --markdown")[1].startswith("| mode |")
    assert "order" in call(line)[1]


FEET = """name = "feet"
[beam]
length = 0.43
width = 0.017
thickness = 0.0023
youngs_modulus = 113e9
density = 4470.0
supports = ["clamped", "free"]
loss_factor = 0.02
[drive]
frequency_hz = 171.0
force = [{ position = 0.13, amplitude = 0.7 }]
[slider]
mass = 0.011
mu = 0.23
law = "coulomb"
position = 0.29
preload = 1.7
coupling = "one-way"
contact = { stiffness = 2.3e5, damping = 3.1 }
foot = [{ length = 0.017, points = 3 }]
[motion]
duration = 0.023
soft_start_periods = 1.5
count = 7
samples = 12
"""


def test_a_slider_that_may_leave_the_beam_moves_by_table_run_and_measure(data, bare):
    Path("feet.toml").write_text(FEET)
    rows = data("table feet.toml --study motion")["tables"][0]["rows"]
    by_run = data("run feet.toml --no-report")["results"]["motion"]["tables"][0]["rows"]
    assert [row["displacement"] for row in rows] == [row["displacement"] for row in by_run]
    for row, model in zip(rows, ("model=analytic", "model=segment count=7", "model=fem count=7"), strict=True):
        measured = data(f"measure feet.toml slider.displacement {model}")["value"]
        assert row["displacement"] == pytest.approx(measured, rel=1e-2)  # samples cut its steps
        assert row["mean speed"] == pytest.approx(row["displacement"] / 0.023, rel=1e-9)
        assert row["energy imbalance"] < 0.01


def test_charts_are_written(call, bare):
    assert call("table bare.toml --study spectrum --charts charts")[0] == 0
    assert any(one.read_text().startswith("<svg") for one in Path("charts").glob("*.svg"))
    assert len(list(Path("charts").glob("*.png"))) == len(list(Path("charts").glob("*.svg"))) > 0


def test_choose_takes_ranges_and_rules(data):
    rows = data(f"choose {SMALL} wall=half,gregory --mode 1-3 --error 1%")["tables"][0]["rows"]
    assert len(rows) == 3
    assert max(row["N"] for row in rows) < 60


def test_a_sweep_without_any_value_is_bad_input(call, bare):
    status, out, err = call("sweep bare.toml mode.frequency model=fem mode=40 count=4,5")
    assert (status, "2 combinations, 2 without a value" in out) == (2, True)
    assert "no combination has a value, the first one because mode = 40" in " ".join(err.split())


def test_schema_of_sections(call, data):
    assert "beam.spring" in call("schema")[1]
    assert "stiffness" in call("schema beam.spring")[1]
    assert data("schema")["properties"]["beam"]
    assert data("schema beam")["required"] == ["length"]


def test_export_by_command(call, bare):
    status, out, _ = call("export bare.toml --what modes --mode 3 --to m.csv")
    assert (status, out) == (0, "wrote m.csv: modes 1 to 3, 9 segments\n")
