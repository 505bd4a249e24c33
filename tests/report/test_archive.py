"""Saved runs, their number, and what differs between two."""

import json
from datetime import UTC, datetime, timedelta

import msgspec
import pytest

from verify.errors import InputError
from verify.report import archive
from verify.report.archive import read_runs, report_name, save_run, saved_in
from verify.report.diff import compare_runs
from verify.report.summary import run_data


@pytest.fixture(scope="module")
def bare_run(small_run):
    return msgspec.structs.replace(small_run, results={})


@pytest.fixture
def clock(monkeypatch):
    """Every look at the clock is a second later."""

    class Clock(datetime):
        seconds = 0

        @classmethod
        def now(cls, tz=None):
            cls.seconds += 1
            return datetime(2031, 5, 7, 11, 13, 17, tzinfo=UTC) + timedelta(seconds=cls.seconds)

    monkeypatch.setattr(archive, "datetime", Clock)


def test_newest_runs_are_kept(bare_run, tmp_path, clock):
    folders = [save_run(bare_run, tmp_path, "small", keep=2).folder for _ in range(3)]
    assert saved_in(tmp_path / "small") == folders[1:]
    assert sorted(one.name for one in folders[2].iterdir()) == ["index.html", "run.json"]
    assert (tmp_path / "small.html").read_bytes() == (folders[2] / "index.html").read_bytes()
    assert [one.name for one in tmp_path.iterdir() if one.name.startswith(".")] == []


def test_without_keeping_one_page(bare_run, tmp_path):
    saved = save_run(bare_run, tmp_path, "small", keep=0)
    assert saved.folder is None
    assert [one.name for one in tmp_path.iterdir()] == ["small.html"]


def test_failed_write_leaves_nothing(bare_run, tmp_path):
    (tmp_path / "small").write_text("a file")
    with pytest.raises(InputError, match="--keep 0"):
        save_run(bare_run, tmp_path, "small")
    assert [one.name for one in tmp_path.iterdir()] == ["small"]


def test_runs_are_read_from_every_level(bare_run, tmp_path):
    folder = save_run(bare_run, tmp_path, "small", "verify run small.toml").folder
    for path in (folder / "run.json", folder, tmp_path / "small", tmp_path):
        (run,) = read_runs(path, "A").values()
        assert run["command"] == "verify run small.toml"
        assert run["gates"][0]["value"] == bare_run.gates[0].value


@pytest.mark.parametrize("text", ["{}", "[]", "no json", '{"gates": []}'])
def test_other_json_is_refused(tmp_path, text):
    (tmp_path / "run.json").write_text(text)
    with pytest.raises(InputError, match="no saved run"):
        read_runs(tmp_path / "run.json", "A")


@pytest.mark.parametrize(
    ("overrides", "name"),
    [((), "small"), (("beam.length=0.4",), "small_beam.length=0.4"), (("a=[1, 2]",), "small_a=-1-2")],
)
def test_overrides_name_the_report(overrides, name):
    assert report_name("small", overrides) == name


def data_of(run):
    return {"small": json.loads(json.dumps(run_data(run) | {"report": "small"}))}


def test_equal_runs_do_not_differ(small_run):
    result = compare_runs(data_of(small_run), data_of(small_run))
    assert result.data["broken"] == []
    assert not result.tables


def test_broken_gate_is_reported(small_run, full_run):
    result = compare_runs(data_of(small_run), data_of(full_run))
    assert result.data["broken"] == ["small: elements-lie-above"]
    assert result.tables[0].records()[0]["verdict"] == "pass → FAIL"
    assert compare_runs(data_of(full_run), data_of(small_run)).data["broken"] == []


def test_missing_gate_is_broken(small_run):
    after = data_of(small_run)
    del after["small"]["gates"][0]
    assert compare_runs(data_of(small_run), after).data["broken"] == ["small: third-frequency"]


def test_changed_input_is_named(small_run):
    after = data_of(small_run)
    after["small"]["inputs"]["beam"]["length"] = 0.41
    after["small"]["gates"][0]["value"] *= 1.05
    result = compare_runs(data_of(small_run), after)
    gates, inputs = (table.records() for table in result.tables)
    assert inputs == [{"report": "small", "key": "beam.length", "before": "0.37", "after": "0.41"}]
    assert abs(abs(gates[0]["change"]) - 0.05) < 1e-12
    assert result.data["broken"] == []
