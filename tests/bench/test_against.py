"""An earlier bench: a faster machine moves nothing, a slower method is named, and so is another answer."""

import json

import msgspec
import pytest
from msgspec.structs import replace

from verify.bench.against import Earlier, beside, moved, read_earlier
from verify.bench.found import BenchFound
from verify.bench.machine import load
from verify.bench.rows import Row
from verify.errors import InputError

BASE = Row(
    set="modes",
    about="mode 5",
    method="segments",
    model="segment",
    settings={},
    count=49,
    error=-7.5e-6,
    reference="exact",
    reference_uncertainty=9e-16,
    warm_s=5e-4,
    spread_s=3e-5,
    rounds=9,
)
ROWS = (
    BASE,
    replace(BASE, method="Hermite elements", model="fem", warm_s=2.1e-3, error=7.3e-6),
    replace(BASE, method="stock scikit-fem", model="", warm_s=5.3e-3, error=7.3e-6, set_up_s=1e-3),
    replace(BASE, count=98, warm_s=1.7e-3, error=-4.6e-7),
    replace(BASE, count=98, method="Hermite elements", model="fem", warm_s=7.9e-3, error=4.6e-7),
    replace(BASE, method="exact", model="analytic", count=None, warm_s=4e-6, spread_s=1e-7, error=0.0),
)


def texts(new, old=ROWS):
    return [one.text for one in moved(old, new, "2026-01-02")]


def doctored(i, **change):
    return tuple(replace(row, **change) if k == i else row for k, row in enumerate(ROWS))


def test_nothing_moves_where_nothing_changed():
    (text,) = texts(ROWS)
    assert text == "against 2026-01-02: of 6 rows no ratio between methods moved beyond its spread, and no error of 6"


def test_a_machine_three_times_as_fast_moves_nothing():
    faster = (
        replace(r, warm_s=r.warm_s / 3, set_up_s=r.set_up_s and r.set_up_s / 3, spread_s=r.spread_s / 3) for r in ROWS
    )
    assert "no ratio" in texts(tuple(faster))[0]


@pytest.mark.parametrize("i", [0, 1, 2, 5])
def test_a_method_that_became_slower_is_named_and_nothing_else(i):
    (text,) = texts(doctored(i, warm_s=1.8 * ROWS[i].warm_s))
    assert f"{ROWS[i].method} in modes, mode 5" in text
    size = 1.8 if ROWS[i].set_up_s is None else (1.8 * 5.3 + 1.0) / 6.3
    assert f"takes {size:.2f} times what it took" in text


def test_a_change_within_the_spread_of_both_is_none():
    assert "no ratio" in texts(doctored(1, warm_s=1.25 * 2.1e-3, spread_s=0.2 * 2.1e-3))[0]
    assert "takes 1.25 times" in texts(doctored(1, warm_s=1.25 * 2.1e-3))[0]


def test_of_a_row_that_stands_alone_no_ratio_is_said_not_to_move():
    pair, alone = ROWS[:2], replace(BASE, set="harmonic", about="", count=7)
    (text,) = texts((*pair, alone), (*pair, alone))
    assert "of 2 rows no ratio" in text
    assert text.endswith("and no error of 3")
    (lonely,) = moved((alone,), (alone,), "2026-01-02")
    assert "no ratio" not in lonely.text
    assert not lonely.earned


@pytest.mark.parametrize("wrong", [{"warm_s": -5.0}, {"warm_s": 1e308}, {"set_up_s": -1.0}])
def test_times_that_no_clock_gives_are_refused(tmp_path, wrong):
    """Their logarithms would be a traceback, and their ratio no number."""
    file = tmp_path / "earlier.json"
    file.write_bytes(msgspec.json.encode({"scene": "paper", "rows": [msgspec.to_builtins(BASE) | wrong]}))
    with pytest.raises(InputError, match=f"rows.0..{next(iter(wrong))}"):
        read_earlier(file)


@pytest.mark.parametrize("seconds", [0.0, 1e-320])
def test_a_row_that_a_coarse_clock_saw_take_no_time_has_no_ratio(tmp_path, seconds):
    """Such a file is a bench's own; of the others ratios are told."""
    rows = [msgspec.to_builtins(row) for row in doctored(0, warm_s=seconds)]
    file = tmp_path / "earlier.json"
    file.write_bytes(msgspec.json.encode({"scene": "paper", "rows": rows}))
    (text,) = texts(ROWS, read_earlier(file).rows)
    assert "nan" not in text
    assert text.endswith("no error of 5")


def test_another_answer_is_named():
    (text,) = texts(doctored(3, error=-4.7e-7))
    assert text == "against 2026-01-02: the error of segments in modes, mode 5, N = 98 is -4.7e-07 and was -4.6e-07"


def test_two_benches_without_a_row_in_common_are_refused():
    with pytest.raises(InputError, match="no timed row in common"):
        moved(ROWS, (replace(BASE, about="mode 7"),), "before")


@pytest.mark.parametrize("text", ["", "[]", '{"rows": 3}', '{"scene": "paper", "rows": [{"set": "none"}]}', "\x00"])
def test_a_file_that_is_no_bench_is_refused_by_name(tmp_path, text):
    path = tmp_path / "old.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"old\.json' is no output of `verify bench --json`"):
        read_earlier(path)
    with pytest.raises(InputError, match="cannot be read"):
        read_earlier(tmp_path / "none.json")


def test_what_json_wrote_is_read_again(tmp_path):
    import msgspec

    path = tmp_path / "old.json"
    path.write_text(json.dumps({"scene": "s", "date": "d", "rows": msgspec.to_builtins(ROWS), "more": 1}))
    assert read_earlier(path).rows == ROWS


@pytest.mark.parametrize(
    ("then", "now", "said"),
    [
        (0.6, 0.9, ""),
        (None, None, ""),
        (3.2, 0.8, " (3.2 processes to a core then)"),
        (0.5, 2.7, " (2.7 processes to a core now)"),
        (1.4, 1.6, " (1.4 processes to a core then, 1.6 processes to a core now)"),
    ],
)
def test_a_busy_machine_is_named_beside_what_moved(then, now, said):
    """Ratios of the same code moved by a quarter under a load of three to seven."""
    found = BenchFound(
        scene="s", date="d", machine={}, versions={}, costs=(), rows=doctored(1, warm_s=9e-3), sentences=(), load=now
    )
    (told,) = beside(found, Earlier(scene="s", rows=ROWS, date="2026-01-02", load=then)).moved
    assert told.text.startswith(f"against 2026-01-02{said}: Hermite elements in modes, mode 5")


def test_the_load_is_told_for_a_core_and_not_where_nobody_counts(monkeypatch):
    monkeypatch.setattr("os.getloadavg", lambda: (3.14159, 9.0, 9.0))
    monkeypatch.setattr("verify.bench.machine._cores", lambda: 2)
    assert load() == 1.6
    monkeypatch.delattr("os.getloadavg")
    assert load() is None
