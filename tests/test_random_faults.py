"""What a random fault is, and that a draw of them is fair and repeats."""

import shutil
from collections import Counter
from pathlib import Path

import pytest

from benchmarks.fault_kinds import Fault, drawn, faults_of
from benchmarks.kernel_callers import callers
from benchmarks.random_faults import MOST, Known, Met, _stamp, meeting, met, table
from benchmarks.reasons import NOTHING, Reason, kept_reasons, key_of
from benchmarks.recorded_lines import Recorded, read_recorded, recorded, run_pytest

SOURCE = b'''"""Words - not faults."""

from verify.models.kernels import part

EDGE: float = 0.25


def lift(height, at, *, twice=False):
    """Not a fault either: 1 + 1."""
    if not 0.0 <= at < height:
        raise ValueError(f"at = {at - 1} lies outside")
    rise, fall = height - at, at
    return max(rise, fall) if twice else rise / height


@part()
def press(a, b):
    total = 0.5 * a
    total += b
    return total
'''


def written(fault: Fault) -> tuple[str, str]:
    return " ".join(fault.old.split()), fault.new


def test_each_expression_has_its_own_faults_and_words_have_none():
    found = {written(fault) for fault in faults_of(SOURCE)}
    assert {
        ("height - at", "(height + at)"),
        ("height - at", "(-height - at)"),
        ("height - at", "(height)"),
        ("rise / height", "(rise * height)"),
        ("0.25", "0.25025"),
        ("0.25", "0.0"),
        ("False", "True"),
        ("0.0 <= at < height", "(0.0 < at < height)"),
        ("0.0 <= at < height", "(0.0 <= at > height)"),
        ("max(rise, fall)", "(rise)"),
        ("twice", "(not (twice))"),
        ("total += b", "pass"),
        ("height - at, at", "at, height - at"),
    } <= found
    assert not any("1 + 1" in old or "at - 1" in old for old, _ in found if "raise" not in old)
    assert {old for old, new in found if new == "pass" and "raise" in old} == {
        'raise ValueError(f"at = {at - 1} lies outside")'
    }


def test_a_fault_changes_its_place_and_nothing_else():
    for fault in faults_of(SOURCE):
        planted = fault.planted(SOURCE)
        assert planted[: fault.start] == SOURCE[: fault.start]
        assert planted.endswith(SOURCE[fault.end :])
        assert SOURCE[fault.start : fault.end].decode() == fault.old


def test_a_fault_knows_its_function_and_whether_it_is_compiled():
    where = Counter((fault.function, fault.in_kernel) for fault in faults_of(SOURCE))
    assert set(where) == {("", False), ("lift", False), ("press", True)}


def test_a_class_and_the_defaults_of_a_function_run_when_their_module_is_imported():
    source = b"class Cell:\n    nodes = 2\n    def size(self, scale=3.5):\n        return 7 * scale\n"
    assert {(fault.old, fault.function, fault.at_import) for fault in faults_of(source)} == {
        ("2", "Cell", True),
        ("3.5", "Cell.size", True),
        ("7", "Cell.size", False),
        ("7 * scale", "Cell.size", False),
    }
    nodes = next(fault for fault in faults_of(source) if fault.old == "2")
    known = Known(Recorded({GATE: 0.5, TEST: 2.0}, {"cell.py": {2: {GATE}, 4: {TEST}}}), {})
    assert meeting("cell.py", nodes, known) == ([GATE], [TEST])


@pytest.mark.parametrize("kernels", [False, True])
def test_a_seed_draws_the_same_faults_of_the_asked_kind_one_a_line(kernels):
    sources = {"verify/a.py": SOURCE, "verify/b.py": SOURCE.replace(b"0.25", b"0.5")}
    found = drawn(sources, 7, 5, kernels)
    assert found == drawn(sources, 7, 5, kernels)
    assert found != drawn(sources, 7, 6, kernels)
    assert {fault.in_kernel for _, fault in found} == {kernels}
    lines = [(module, fault.line) for module, fault in found]
    assert len(set(lines)) == len(lines)
    for module, fault in found:
        compile(fault.planted(sources[module]), module, "exec")


GATE, SLOW_GATE = "verify/scenes/quick.toml::a", "verify/scenes/slow.toml::b"
TEST, LONG_TEST = "tests/test_lift.py::test_rise", "tests/test_lift.py::test_long"


def test_a_fault_meets_what_runs_its_line_the_quickest_first_and_tests_as_far_as_time_goes():
    first, *_, last = faults_of(SOURCE)
    inside = next(fault for fault in faults_of(SOURCE) if fault.old == "rise / height")
    lines = {inside.line: {SLOW_GATE, GATE, TEST, LONG_TEST}, 3: {SLOW_GATE}}
    recorded = Recorded({SLOW_GATE: 3.0, GATE: 0.5, TEST: 2.0, LONG_TEST: MOST}, {"a.py": lines})
    known = Known(recorded, {("a.py", "press"): {("b.py", 7), ("a.py", 3)}})
    assert meeting("a.py", inside, known) == ([GATE, SLOW_GATE], [TEST])
    assert (first.function, meeting("a.py", first, known)) == ("", ([GATE, SLOW_GATE], [TEST]))
    assert (last.in_kernel, meeting("a.py", last, known)) == (True, ([SLOW_GATE], []))
    assert meeting("b.py", inside, known) == ([], [])


def test_what_a_file_of_tests_shares_all_of_them_run():
    known = Recorded({TEST: 1.0, LONG_TEST: 2.0, GATE: 0.1}, {"a.py": {4: {"tests/test_lift.py"}, 5: {GATE}}})
    assert known.running([("a.py", 4)]) == {TEST, LONG_TEST}
    assert known.running([("a.py", 0)]) == {TEST, LONG_TEST, GATE}
    assert known.running([("a.py", 6), ("b.py", 4)]) == set()


def test_what_was_recorded_is_kept_as_long_as_its_stamp_holds(tmp_path):
    known = Recorded({TEST: 1.25, GATE: 0.1}, {"a.py": {4: {"tests/test_lift.py"}, 5: {GATE, TEST}}})
    (tmp_path / "kept").write_text(known.written("now"))
    assert read_recorded(tmp_path / "kept", "now") == known
    assert read_recorded(tmp_path / "kept", "then") is None
    (tmp_path / "other").write_text("# Words\n")
    with pytest.raises(RuntimeError, match="other is no record of lines: give another file, or remove it"):
        read_recorded(tmp_path / "other", "now")
    other = Recorded({SLOW_GATE: 3.0}, {"a.py": {5: {SLOW_GATE}}, "b.py": {1: {SLOW_GATE}}})
    both = known.beside(other)
    assert both.run == {
        "a.py": {4: {"tests/test_lift.py"}, 5: {GATE, TEST, SLOW_GATE}},
        "b.py": {1: {SLOW_GATE}},
    }
    assert both.seconds == {TEST: 1.25, GATE: 0.1, SLOW_GATE: 3.0}


def test_a_record_holds_for_its_sources_gates_and_tests_as_they_are(tmp_path):
    for name in ("verify/a.py", "verify/scenes/a.toml", "tests/test_a.py"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("a = 1\n")
    stamps = {_stamp(tmp_path, ["tests"]), _stamp(tmp_path, ["tests/waves"])}
    for name in ("verify/a.py", "verify/scenes/a.toml", "tests/test_a.py"):
        (tmp_path / name).write_text("a = 2\n")
        stamps.add(_stamp(tmp_path, ["tests"]))
    assert len(stamps) == 5


def test_a_kernel_is_reached_from_the_lines_of_python_that_call_those_above_it():
    sources = {
        "a/kernels.py": b"@part()\ndef low(x):\n    return x\n\n@lean()\ndef high(x):\n    return low(x)\n",
        "a/use.py": b"from a import kernels as k\n\ndef run(x):\n    return k.high(x)\n",
        "a/table.py": b"from a.kernels import high as up\nTABLE = {1: up}\n",
    }
    found = callers(sources)
    assert found["a/kernels.py", "high"] == {("a/use.py", 4), ("a/table.py", 0)}
    assert found["a/kernels.py", "low"] == found["a/kernels.py", "high"]


def test_lines_are_recorded_by_the_test_that_runs_them_and_what_is_red_is_told(tmp_path):
    shutil.copytree(Path(__file__).parents[1] / "benchmarks", tmp_path / "benchmarks")
    (tmp_path / "verify").mkdir()
    for one in ("__init__.py", "pytest_plugin.py"):  # in place of the package, which pytest knows by its plugin
        (tmp_path / "verify" / one).write_text("")
    (tmp_path / "verify" / "lever.py").write_text(
        "from functools import cache\n\n\n@cache\ndef half(x):\n    return 0.5 * x\n"
    )
    (tmp_path / "test_lever.py").write_text(
        "import subprocess\nimport sys\nimport pytest\nfrom verify.lever import half\n\n\n@pytest.fixture(scope='module')\ndef shared():\n    return half(5.0)\n\n\n"
        "def test_red(shared):\n    assert half(3.0) == 1.0\n\n\ndef test_half():\n    assert half(3.0) == 1.5\n\n\n"
        "def test_apart():\n    subprocess.run([sys.executable, '-c', 'from verify.apart import far; far()'], check=True)\n"
    )
    (tmp_path / "verify" / "apart.py").write_text("def far():\n    return 7\n")
    found, red = recorded(tmp_path, ["test_lever.py"], str(tmp_path / "kept"))
    assert red == ["test_lever.py::test_red"]
    assert set(found.seconds) == {"test_lever.py::test_half", "test_lever.py::test_apart"}
    assert found.run["verify/apart.py"][2] == {"test_lever.py::test_apart"}
    assert found.run["verify/lever.py"][6] == {"test_lever.py", "test_lever.py::test_red", "test_lever.py::test_half"}


def test_a_planted_fault_is_noticed_by_the_gate_or_test_that_it_turns_red_and_taken_out_again(tmp_path):
    source = b"def half(x):\n    return 0.5 * x if x > 0.0 else 0.0\n"
    (tmp_path / "lever.py").write_bytes(source)
    for name, given, right in (("verify/scenes/test_gate.py", 3.0, 1.5), ("test_lever.py", -3.0, 0.0)):
        (tmp_path / name).parent.mkdir(exist_ok=True, parents=True)
        (tmp_path / name).write_text(
            f"from lever import half\n\n\ndef test_half():\n    assert half({given}) == {right}\n"
        )
    gate, test = "verify/scenes/test_gate.py::test_half", "test_lever.py::test_half"
    known = Known(Recorded({gate: 0.02, test: 0.01}, {"lever.py": {2: {gate, test}}}), {})
    became = {
        (fault.old, fault.new): met(tmp_path, "lever.py", fault, known, str(tmp_path / "kept"))[2:]
        for fault in faults_of(source)
        if fault.kind in ("thousandth", "comparison")
        or (fault.kind == "constant" and fault.old == "0.0" and fault.line == 2)
    }
    assert became[("0.5", "0.5005")] == (gate, "")
    assert became[("x > 0.0", "(x >= 0.0)")] == ("", "")
    assert became[("x > 0.0", "(x < 0.0)")] == (gate, "")
    assert became[("0.0", "1.0")] == ("", test)
    assert (tmp_path / "lever.py").read_bytes() == source


def test_a_test_that_a_tree_does_not_have_notices_nothing(tmp_path):
    """One named after where its tree lies ended pytest before any test, which was counted as noticed."""
    (tmp_path / "test_lever.py").write_text("def test_half():\n    assert True\n")
    with pytest.raises(RuntimeError, match=r"test_lever.py::test_third is in no tree: give it a name that is the same"):
        run_pytest(tmp_path, ["test_lever.py::test_half", "test_lever.py::test_third"])
    (tmp_path / "test_lever.py").write_text("import leever\n\n\ndef test_half():\n    assert True\n")
    status, red = run_pytest(tmp_path, ["test_lever.py::test_half"])
    assert status
    assert red == ["test_lever.py"]


def test_the_table_counts_by_room_and_kind_and_lists_what_no_gate_notices():
    faults = faults_of(SOURCE)
    found = [
        Met("verify/waves/a.py", faults[0], "g"),
        Met("verify/waves/a.py", faults[1], "", "t"),
        Met("verify/waves/a.py", faults[2], ""),
        Met("verify/chain/b.py", faults[-1], ""),
    ]
    reasons = {key_of("verify/waves/a.py", faults[2]): Reason(NOTHING, "it is never read")}
    reasons |= {key_of("verify/chain/b.py", faults[-1]): Reason("speed", "one round more")}
    told = table(found, True, reasons).splitlines()
    assert [" ".join(line.split()).split("%")[0] for line in told[:7]] == [
        "chain 0 of 1",
        "waves 1 of 2",
        "kernels 0 of 1 0.0",
        "other functions 1 of 2 50.0",
        "together 1 of 3 33.3",
        "by gates or tests 2 of 3 66.7",
        "1 more change nothing, as benchmarks/reasons.toml says",
    ]
    assert [line.split()[0] for line in told[7:]] == ["UNNOTICED", "t", "UNNOTICED"]
    assert told[7].endswith("(speed: one round more)")
    assert told[9].endswith("(nothing: it is never read)")
    assert not any("by gates or tests" in line for line in table(found, False, {}).splitlines())
    assert "0 of    2" in table([found[2], found[3]], False, {})


def test_every_reason_is_of_a_fault_that_the_sources_still_can_have():
    reasons = kept_reasons()
    root = Path(__file__).parents[1]
    possible = {
        module: {key_of(module, fault) for fault in faults_of((root / module).read_bytes())}
        for module in {key[0] for key in reasons}
    }
    assert [key for key in reasons if key not in possible[key[0]]] == []
    assert all(one.why for one in reasons.values())


def test_a_reason_says_what_its_fault_changes(tmp_path):
    (tmp_path / "r.toml").write_text(
        '[[fault]]\nmodule="a.py"\nfunction="f"\nold="1"\nnew="2"\nchanges="colour"\nwhy="none"\n'
    )
    with pytest.raises(ValueError, match=r"r\.toml: changes = 'colour': give one of nothing, speed, margin"):
        kept_reasons(tmp_path / "r.toml")
