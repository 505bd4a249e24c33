"""Errors that are no number: no row of the stress table passes over one."""

import ast
from math import isnan, nan
from pathlib import Path

import pytest

from verify.stress.largest import largest

ROWS = sorted(Path(__file__).parents[2].glob("verify/stress/*/*.py"))


def test_the_largest_of_errors_is_one_of_them_or_no_number():
    assert largest(0.3, -0.5, 0.7) == 0.7
    assert largest(value**2 for value in (0.3, -0.5)) == 0.25
    for errors in ((nan, 0.3), (0.3, nan), (0.1, nan, 0.3)):
        assert isnan(largest(*errors))
        assert isnan(largest(iter(errors)))


def keeps_a_largest(node):
    """A name that is given the `max` of itself and more, which keeps x where the rest is no number."""
    return (
        isinstance(node, ast.Assign)
        and isinstance(node.value, ast.Call)
        and ast.unparse(node.value.func) == "max"
        and ast.unparse(node.targets[0]) in [ast.unparse(one) for one in node.value.args]
    )


def returns_a_largest(node):
    return (
        isinstance(node, ast.Return)
        and isinstance(node.value, ast.Call)
        and ast.unparse(node.value.func) == "max"
        and "default" not in [one.arg for one in node.value.keywords]
    )


@pytest.mark.parametrize("row", ROWS, ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_no_row_keeps_its_worst_by_what_passes_over_no_number(row):
    found = [
        node.lineno for node in ast.walk(ast.parse(row.read_text())) if keeps_a_largest(node) or returns_a_largest(node)
    ]
    assert found == [], f"{row.name}: verify.stress.largest"
