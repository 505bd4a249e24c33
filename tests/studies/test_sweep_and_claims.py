"""Sweeps keep the order of their lists and the rows of failures; claims are compared with quantities."""

import os
import signal
import subprocess
import sys
from time import sleep

import pytest
from msgspec.structs import replace

from verify.analysis.solution_cache import SolutionCache
from verify.errors import InputError
from verify.exact.closed_forms import frequency_hz
from verify.parallel import CLIENT, cluster
from verify.quantities.base import QUANTITIES, evaluate, quantity
from verify.scene.load import load_scene
from verify.scene.model import Claim
from verify.studies.base import studies_of
from verify.studies.claims import Claims
from verify.studies.optimise import Optimise, Variable
from verify.studies.sweep import Sweep


def column(table, name):
    return [record[name] for record in table.records()]


PAPER = load_scene("paper")
FREQUENCY = {"model": "analytic", "mode": 3}


def run_sweep(scene, quantities, over, **settings):
    return Sweep(quantities=tuple(quantities), over=over, **settings).run(scene, None, lambda step: None)


def test_rows_follow_the_lists_with_the_first_key_slowest():
    result = run_sweep(
        PAPER,
        ["mode.frequency"],
        {"beam.density": [2500.0, 2900.0], "beam.length": [0.4, 0.7, 0.5]},
        arguments=FREQUENCY,
    )
    table = result.tables[0]
    assert column(table, "beam.density") == [2500.0] * 3 + [2900.0] * 3
    assert column(table, "beam.length") == [0.4, 0.7, 0.5] * 2
    for row in table.records():
        beam = replace(PAPER.beam, density=row["beam.density"], length=row["beam.length"])
        assert row["mode.frequency"] == pytest.approx(frequency_hz(beam, 3), rel=1e-13)


def test_failed_combinations_are_rows_with_the_reason():
    over = {"beam.density": [2700.0, -1.0, 3100.0]}
    result = run_sweep(PAPER, ["mode.frequency"], over, arguments=FREQUENCY)
    good, bad, other = result.tables[0].records()
    assert good["mode.frequency"] > other["mode.frequency"]
    assert bad["mode.frequency"] is None
    assert "beam.density = -1.0" in bad["reason"]
    assert "1 without a value" in result.summary
    assert result.verdict.level == "conditional"
    none = run_sweep(PAPER, ["mode.frequency"], {"beam.density": [-2.0, -1.0]}, arguments=FREQUENCY).verdict
    assert (none.level, none.margins[0].harm) == ("not trusted", "void")


def test_keys_joined_by_commas_vary_together():
    over = {"drive.force.*.amplitude, drive.frequency_hz": [[1.0, 4276.0], [3.0, 4290.0]]}
    table = run_sweep(load_scene("paper-wave"), ["wave.crest_speed"], over, arguments={"model": "analytic"}).tables[0]
    assert column(table, "drive.frequency_hz") == [4276.0, 4290.0]
    slow, fast = column(table, "wave.crest_speed")
    assert 2.5 < fast / slow < 3.5


def test_sweeps_render(renders):
    one = run_sweep(PAPER, ["mode.frequency"], {"mode": [1, 2, 40]}, arguments={"model": "analytic"})
    axes = renders(one)["sweep-mode.frequency"]
    assert axes.get_xlabel() == "mode"
    assert axes.get_ylabel() == "mode.frequency, Hz"
    two = run_sweep(PAPER, ["mode.frequency"], {"model": ["fem", "segment"], "count": [9, 21]}, arguments={"mode": 4})
    assert [text.get_text() for text in renders(two)["sweep-mode.frequency"].get_xticklabels()] == ["fem", "segment"]


@pytest.mark.parametrize(
    ("quantities", "over", "word"),
    [
        (["mode.frequencey"], {"mode": [1]}, "mode.frequency"),
        (["mode.frequency"], {"mod": [1]}, "'mode'"),
        (["mode.frequency"], {"beam.lenght": [1.0]}, "'length'"),
        (["mode.frequency"], {"drive.force.7.amplitude": [1.0]}, "7 is not known"),
        (["mode.frequency"], {"mode": list(range(1, 1000)), "count": list(range(1, 1000))}, "combinations"),
    ],
)
def test_wrong_sweeps_are_refused_before_they_run(quantities, over, word):
    with pytest.raises(InputError, match=word):
        run_sweep(PAPER, quantities, over, arguments={"model": "segment"})


# --- Executors and files ---

OVER = {"count": [7, 12, 20], "mode": [1, 2, 9], "beam.length": [0.4, 0.7]}  # of seven segments there is no ninth mode


def written(
    file, step=lambda text: None, scene=PAPER, quantities=("mode.frequency", "mode.frequency_error"), over=OVER
):
    """(table, contents of the file) of a sweep."""
    study = Sweep(quantities=quantities, over=over, arguments={"model": "segment"})
    return study.run(scene, None, step, file).tables[0], file.read_bytes()


@pytest.fixture
def fragile():
    """A quantity that records its calls in this process, and ends a worker process at the fifth mode."""
    calls, parent = [], os.getpid()

    @quantity("mode.fragile", unit="1")
    def fragile_mode(scene, *, mode: int) -> float:
        """For tests."""
        if mode == 5 and os.getpid() != parent:
            sleep(0.3)  # others are complete
            os.kill(os.getpid(), signal.SIGKILL)
        calls.append(mode)
        return 0.1 * mode

    yield calls
    del QUANTITIES._members["mode.fragile"]


def fragile_sweep(file, modes=8):
    study = Sweep(quantities=("mode.fragile",), over={"mode": list(range(1, modes + 1))})
    return study.run(PAPER, None, lambda step: None, file).tables[0]


def test_one_process_two_and_a_cluster_with_a_killed_worker_write_the_same_file(tmp_path, monkeypatch):
    pytest.importorskip("distributed")
    monkeypatch.setenv("VERIFY_JOBS", "1")
    alone = written(tmp_path / "one")
    study = Optimise(
        quantity="wave.reflection",
        variable=(Variable(key="phase_deg", low=0.0, high=180.0, start=90.0),),
        evaluations=30,
    )
    wave = load_scene("paper-wave")
    found = study.run(wave, None, lambda step: None).data
    monkeypatch.setenv("VERIFY_JOBS", "2")
    assert written(tmp_path / "two") == alone
    assert study.run(wave, None, lambda step: None).data == found
    with cluster(2):
        first = next(iter(CLIENT.get().cluster.workers.values()))
        killed = []

        def kill(text):
            if not killed:
                killed.append(os.kill(first.pid, signal.SIGKILL))

        assert written(tmp_path / "cluster", kill) == alone
        assert killed
        assert study.run(wave, None, lambda step: None).data == found
    assert CLIENT.get() is None


def test_a_sweep_continues_from_its_file(tmp_path, monkeypatch, fragile):
    monkeypatch.setenv("VERIFY_JOBS", "1")
    table = fragile_sweep(tmp_path / "whole")
    text = (tmp_path / "whole").read_bytes()
    lines = text.splitlines(keepends=True)
    assert len(lines) == 9
    fragile.clear()
    (tmp_path / "cut").write_bytes(b"".join((lines[0], lines[3], lines[1], lines[7][:40])))  # a kill within a line
    assert fragile_sweep(tmp_path / "cut") == table
    assert fragile == [2, 4, 5, 6, 7, 8]
    assert (tmp_path / "cut").read_bytes() == text


@pytest.mark.skipif(sys.platform != "linux", reason="forks")
def test_a_killed_process_leaves_the_rows_that_are_complete(tmp_path, monkeypatch, fragile):
    monkeypatch.setenv("VERIFY_JOBS", "2")
    file = tmp_path / "rows"
    with pytest.raises(InputError, match="a worker process was killed"):
        fragile_sweep(file)
    assert 2 <= len(file.read_bytes().splitlines()) < 9
    monkeypatch.setenv("VERIFY_JOBS", "1")
    assert column(fragile_sweep(file), "mode.fragile") == [0.1 * mode for mode in range(1, 9)]


def test_rows_of_another_sweep_are_refused(tmp_path, fragile):
    file = tmp_path / "rows"
    fragile_sweep(file, 2)
    with pytest.raises(InputError, match="other sweep"):
        fragile_sweep(file, 3)
    with pytest.raises(InputError, match=r"other .*sha256 of the scene"):
        Sweep(quantities=("mode.fragile",), over={"mode": [1, 2]}).run(load_scene("paper-wave"), None, print, file)
    file.write_text("of somebody\n")
    with pytest.raises(InputError, match="other contents"):
        fragile_sweep(file, 2)
    assert file.read_text() == "of somebody\n"


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.parametrize("name", ["SIGINT", "SIGKILL"])
def test_ctrl_c_and_a_kill_leave_whole_lines_and_no_process(tmp_path, name):
    how = getattr(signal, name)
    words = "sweep paper-wave wave.reflection model=segment count=400 phase_deg=1-900 --to rows"
    process = subprocess.Popen(
        [sys.executable, "-m", "verify", *words.split()], cwd=tmp_path, stderr=subprocess.PIPE, start_new_session=True,
        env=os.environ | {"VERIFY_JOBS": "2"},
    )  # fmt: skip
    while not (tmp_path / "rows").exists() or (tmp_path / "rows").read_bytes().count(b"\n") < 4:
        sleep(0.02)
    (os.killpg if how == signal.SIGINT else os.kill)(process.pid, how)
    error = process.communicate(timeout=60)[1].strip()  # returns when no worker has the pipe any more
    assert (error, process.returncode) == ((b"verify: interrupted", 130) if how == signal.SIGINT else (b"", -how))
    assert 4 <= (tmp_path / "rows").read_bytes().count(b"\n") < 900
    assert (tmp_path / "rows").read_bytes().endswith(b"\n")


def test_a_cluster_that_does_not_exist_is_refused(monkeypatch):
    monkeypatch.setattr("verify.parallel.PATIENCE", 0.3)
    pytest.importorskip("distributed")
    with pytest.raises(InputError, match="has no usable worker"), cluster("tcp://127.0.0.1:9"):
        pass
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(InputError, match=r"pip install 'fem-segment-verify\[cluster\]'"), cluster(1):
        pass


# --- Claims ---


def claim(**other):
    own = {"id": "a", "source": "somebody", "quantity": "mode.frequency", "arguments": FREQUENCY, "read": "stated"}
    return Claim(**own | other)


def test_claims_equal_the_quantities(run, renders):
    claims = (
        claim(value=83.1, tolerance=0.1),
        claim(id="b", value="negative"),
        claim(id="c", arguments={"mode": 2}, value="positive"),
    )
    result = run(replace(PAPER.bare, claim=claims), Claims())
    expected = evaluate("mode.frequency", FREQUENCY, PAPER, SolutionCache(PAPER.beam))
    assert column(result.tables[0], "computed")[:2] == pytest.approx([expected] * 2)
    assert column(result.tables[0], "agrees") == [True, False, None]
    assert column(result.tables[0], "claimed") == ["83.1 ± 0.1", "negative", "positive"]
    assert result.verdict.level == "conditional"
    assert "1 of 3 claims have no value (c: " in result.verdict.headline
    assert result.summary.startswith("1 of 2 ")
    renders(result)


def test_claims_of_the_slider_are_computed_on_the_scene(run):
    table = run("paper-slider", Claims()).tables[0]
    rows = {row["claim"]: row for row in table.records()}
    assert rows["to-the-left"]["agrees"] is True
    assert rows["mean-speed"]["agrees"] is False
    assert rows["to-the-left"]["computed"] == pytest.approx(-1.3833e-9, rel=1e-3)
    assert rows["to-the-left"]["exact beam"] == pytest.approx(-9.107e-10, rel=1e-3)


def test_sections_and_what_they_imply():
    assert [name for name, _ in studies_of(load_scene("paper-slider"))] == ["wave", "motion", "claims", "sweep"]
    assert "motion" not in dict(studies_of(replace(load_scene("paper-slider").bare, slider=None)))
    assert [name for name, _ in studies_of(load_scene("taut-strip"))] == ["spectrum", "convergence"]
