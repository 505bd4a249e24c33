"""What a random fault is, and that a draw of them is fair and repeats."""

from collections import Counter

import pytest

from benchmarks.fault_kinds import Fault, drawn, faults_of
from benchmarks.random_faults import Met, Recorded, meeting, met, table

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


def test_a_fault_meets_the_gates_that_run_its_line_the_quickest_first_and_in_a_kernel_all():
    first, *_, last = faults_of(SOURCE)
    inside = next(fault for fault in faults_of(SOURCE) if fault.old == "rise / height")
    known = Recorded({"slow": 3.0, "quick": 0.5, "other": 0.1}, {"a.py": {inside.line: {"slow", "quick"}, 3: {"slow"}}})
    assert meeting("a.py", inside, known) == ["quick", "slow"]
    assert (first.function, meeting("a.py", first, known)) == ("", ["quick", "slow"])
    assert (last.in_kernel, meeting("a.py", last, known)) == (True, ["other", "quick", "slow"])
    assert meeting("b.py", inside, known) == []


def test_a_planted_fault_is_noticed_by_the_gate_that_it_turns_red_and_taken_out_again(tmp_path):
    source = b"def half(x):\n    return 0.5 * x if x > 0.0 else 0.0\n"
    gate = "from lever import half\n\n\ndef test_half():\n    assert half(3.0) == 1.5\n"
    (tmp_path / "lever.py").write_bytes(source)
    (tmp_path / "test_lever.py").write_text(gate)
    known = Recorded({"test_lever.py::test_half": 0.01}, {"lever.py": {2: {"test_lever.py::test_half"}}})
    became = {
        (fault.old, fault.new): met(tmp_path, "lever.py", fault, known, str(tmp_path / "kept")).gate
        for fault in faults_of(source)
        if fault.kind in ("thousandth", "comparison")
    }
    assert became == {
        ("0.5", "0.5005"): "test_lever.py::test_half",
        ("x > 0.0", "(x >= 0.0)"): "",
        ("x > 0.0", "(x < 0.0)"): "test_lever.py::test_half",
    }
    assert (tmp_path / "lever.py").read_bytes() == source


def test_the_table_counts_by_room_and_lists_what_no_gate_notices():
    faults = faults_of(SOURCE)[:3]
    found = [
        Met("verify/waves/a.py", faults[0], "g"),
        Met("verify/waves/a.py", faults[1], ""),
        Met("v/chain/b.py", faults[2], "g"),
    ]
    told = table(found).splitlines()
    assert [line.split()[:4] for line in told[:3]] == [
        ["chain", "1", "of", "1"],
        ["waves", "1", "of", "2"],
        ["together", "2", "of", "3"],
    ]
    assert len(told) == 4
    assert told[3].startswith("UNNOTICED")
    assert "verify/waves/a.py:5 : 0.25 -> 0.25025" in told[3]
