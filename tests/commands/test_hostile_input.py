"""Input that cannot be used is one sentence and status 2, whichever command reads it, and leaves no half file."""

import json
import os
import re
import subprocess
import sys
from math import pi, sqrt

import pytest

from verify.cli import status_of

BEAM = """name = "bare"
title = "red \\u001b[31m and a null \\u0000"
[beam]
length = 0.43
bending_stiffness = 3.1
mass_per_length = 0.27
supports = ["pinned", "pinned"]
[sweep]
quantities = ["mode.frequency"]
over = { "beam.length" = [0.43, 2020-01-31] }
arguments = { mode = 1, model = "analytic" }
"""
STEPPED = """name = "stepped"
[beam]
length = 0.5
width = 0.02
thickness = 0.002
youngs_modulus = 2e11
density = 7850.0
supports = ["pinned", "pinned"]
section = [{ length = 0.25 }, { length = 0.25, thickness = 2000.0 }]
"""
READERS = {
    "scene": ("plan {}", ".toml"),
    "list": ("compare steel-cantilever {}", ".csv"),
    "solver": ("compare steel-cantilever {}", ".f06"),
    "list without suffix": ("compare steel-cantilever {}", ""),
    "mesh": ("compare steel-cantilever {}", ".vtu"),
    "measured": ("compare steel-cantilever {}", ".uff"),
    "engine": ("compare {}", ".xml"),
    "engine with scene": ("compare steel-cantilever {}", ".urdf"),
    "shapes": ("compare steel-cantilever 27.6 --modes {}", ".txt"),
    "run": ("diff {0} {0}", ".json"),
    "rows": ("sweep steel-cantilever mode.frequency mode=1,2 model=analytic --to {}", ".jsonl"),
}
GATE = {"id": "g", "passed": True, "value": 1.5, "expected": "2"}
RUN = {"report": "a", "verdict": {"level": "trusted", "headline": "h"}, "gates": [GATE], "inputs": {}}
RUN["environment"] = {"numpy": "2"}
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f]")


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "bare.toml").write_text(BEAM)
    (tmp_path / "stepped.toml").write_text(STEPPED)
    return tmp_path


@pytest.fixture
def refused(capsys):
    """Call a command line that is refused; its only sentence."""

    def called(line, *more):
        assert status_of([*line.split(), *more]) == 2
        out, err = capsys.readouterr()
        assert out == ""
        assert err.startswith("verify: ")
        assert err.count("\n") == 1
        assert not re.search(r"regex|Traceback|Error\b|known are\s*$", err)
        assert not CONTROL.search(err[:-1])
        return err

    return called


def _long(path):
    return path.with_name("a" * 300 + path.suffix)


def _pipe(path):
    os.mkfifo(path)
    return path


def _device(path):
    path.symlink_to("/dev/zero")
    return path


def _huge(path):
    with path.open("wb") as stream:
        stream.truncate(2_100_000_000)  # takes no place on disk
    return path


def _closed(path):
    if os.geteuid() == 0:
        pytest.skip("the superuser may enter every folder")
    path.parent.joinpath("closed").mkdir(mode=0)
    return path.parent / "closed" / path.name


@pytest.mark.skipif(sys.platform == "win32", reason="pipes and devices of POSIX")
@pytest.mark.parametrize("make", [_long, _pipe, _device, _huge, _closed])
@pytest.mark.parametrize("reader", READERS)
def test_a_path_that_is_no_ordinary_file_is_one_sentence(folder, refused, reader, make):
    line, suffix = READERS[reader]
    refused(line.format(make(folder / f"file{suffix}")))


def test_a_list_in_one_long_word_is_no_path(capsys):
    status_of(["compare", "steel-cantilever", " ".join(["27.6", "172.6", *["482.60000"] * 30]), "--json"])
    rows = json.loads(capsys.readouterr().out)["tables"][0]["rows"]
    assert [row["listed"] for row in rows] == [27.6, 172.6, *[482.6] * 30]


@pytest.mark.skipif(sys.platform == "win32", reason="limits of POSIX")
def test_a_sweep_beyond_the_limit_of_files_names_the_file_and_continues(folder):
    import resource

    words = [sys.executable, "-m", "verify", "sweep", "bare.toml", "mode.frequency", "mode=1-9", "model=analytic"]

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (1500, 1500))

    whole = subprocess.run([*words, "--to", "whole.jsonl"], capture_output=True, check=True)
    cut = subprocess.run([*words, "--to", "cut.jsonl"], capture_output=True, preexec_fn=limit, text=True, check=False)
    assert cut.returncode == 2
    assert "cut.jsonl" in cut.stderr
    assert cut.stderr.count("\n") == 1
    again = subprocess.run([*words, "--to", "cut.jsonl"], capture_output=True, check=True)
    assert again.stdout == whole.stdout
    assert (folder / "cut.jsonl").read_bytes() == (folder / "whole.jsonl").read_bytes()


@pytest.mark.parametrize("value", [2, "2", [1.5], {"re": 1.5, "im": 0.0}, None, True, 10**400, "\x1b[31m"])
@pytest.mark.parametrize("place", ["value", "passed", "id", "expected", "level", "inputs", "gates"])
def test_runs_of_other_types_are_compared_or_refused(folder, capsys, place, value):
    other = json.loads(json.dumps(RUN))
    target = other["gates"][0] if place in GATE else other["verdict"] if place == "level" else other
    target[place] = value
    for name, run in {"a": RUN, "b": other}.items():
        (folder / f"{name}.json").write_text(json.dumps(run))
    for pair in (("a.json", "b.json"), ("b.json", "a.json")):
        status = status_of(["diff", *pair])
        out, err = capsys.readouterr()
        assert (status in (0, 1)) == (err == "")
        assert not CONTROL.search(out.replace("\n", ""))


def test_a_date_in_a_swept_list_is_a_reason(capsys):
    assert status_of(["table", "bare.toml", "--study", "sweep", "--json"]) == 0
    good, dated = json.loads(capsys.readouterr().out)["tables"][0]["rows"]
    assert good["mode.frequency"] == pytest.approx(pi / 2.0 * sqrt(3.1 / 0.27) / 0.43**2, rel=1e-9)
    assert dated["mode.frequency"] is None
    assert "2020-01-31" in dated["reason"]


def test_modes_within_rounding_are_refused(refused):
    assert "rounding" in refused("chain stepped.toml --count 9")


@pytest.mark.parametrize(
    "line", ["run bare.toml --no-report", "table bare.toml --study sweep", "scenes show bare.toml"]
)
def test_control_characters_do_not_reach_the_terminal(capsys, line):
    status_of(line.split())
    assert not CONTROL.search(capsys.readouterr().out)


@pytest.mark.parametrize(
    "line",
    [
        "plan bare.toml --set name=a/b",
        "plan bare.toml --set gate=[{id='a/b',quantity='drive.moment_per_volt',expect=1,within=1,why='w'}]",
        "measure bare.toml drive.moment_per_volt zzz=1",
        "sweep bare.toml drive.moment_per_volt zzz=1,2",
    ],
)
def test_rules_are_said_in_words(refused, line):
    refused(line)


@pytest.mark.parametrize("text", ["", "<mujoco>", "<sdf/>", "<robot><link/></robot", "\x00", "<mujoco><worldbody/>"])
def test_a_damaged_engine_file_is_refused_in_words(folder, refused, text):
    (folder / "chain.xml").write_text(text)
    refused("compare chain.xml")


def test_charts_are_drawn_whatever_backend_the_environment_names(folder):
    words = [sys.executable, "-m", "verify", "export", "bare.toml", "--what", "modes", "--to", "modes.png"]
    subprocess.run(words, check=True, capture_output=True, env=os.environ | {"MPLBACKEND": "nonsense"})
    assert (folder / "modes.png").read_bytes()[1:4] == b"PNG"


def test_an_interrupt_while_a_file_is_tidied_up_leaves_no_folder(folder):
    script = """
import shutil
from pathlib import Path
from verify.files import write_whole
remove, first = shutil.rmtree, []
def rmtree(*words, **options):
    if not first:
        first.append(1)
        raise KeyboardInterrupt
    remove(*words, **options)
shutil.rmtree = rmtree
write_whole(Path("a.csv"), "text")
"""
    subprocess.run([sys.executable, "-c", script], capture_output=True, check=False)
    assert sorted(one.name for one in folder.iterdir()) == ["a.csv", "bare.toml", "stepped.toml"]
