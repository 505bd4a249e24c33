"""What a random fault is, and that a draw of them is fair and repeats."""

from collections import Counter

import pytest

from benchmarks.fault_kinds import Fault, drawn, faults_of

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
