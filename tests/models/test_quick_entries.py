"""Entries of arrays in kernels: what numba reads and writes, in fewer instructions, and for kernels of ours alone."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit
from numba.core.codegen import CPUCodeLibrary

from verify.models import quick_entries
from verify.models.kernels import _ScalarCompiler

lean = njit(pipeline_class=_ScalarCompiler)
"""As kernels are compiled, and not kept on disk."""

PLACES = st.integers(-3, 2)


def mixed(line, table, cube, whole, i, j, k):
    """Reads and writes of one to three indices, from the end too, of numbers and of whole numbers."""
    found = line[i] + 2.0 * table[i, j] - 3.0 * cube[i, j, k] + 0.5 * whole[j] + line[-1] - table[0, -2] + whole[2]
    line[i] = found
    table[j, -1] = 7
    cube[k, i, 1] = found + table[j, i]
    whole[k] = 11
    line[2] += cube[-1, -2, -3] + whole[-1]
    part = table[1]
    part[j] -= 0.25
    table[:, 2] = 1.5
    return found


ours, numbas = lean(mixed), njit(mixed)


def arrays(seed):
    rng = np.random.default_rng(seed)
    return rng.normal(size=3), rng.normal(size=(3, 3)), rng.normal(size=(3, 3, 3)), rng.integers(-9, 9, size=3)


@settings(deadline=None, max_examples=60)
@given(PLACES, PLACES, PLACES, st.integers(0, 99))
def test_entries_are_those_that_python_reads_and_writes(i, j, k, seed):
    expected, found = arrays(seed), arrays(seed)
    answer = mixed(*expected, i, j, k)
    assert ours(*found, i, j, k) == pytest.approx(answer, rel=1e-15, abs=1e-15)
    for one, other in zip(found, expected, strict=True):
        assert one == pytest.approx(other, rel=1e-15, abs=1e-15)


@pytest.mark.parametrize("change", [np.asfortranarray, lambda a: a[:, ::2], lambda a: a.astype(np.float32)])
def test_what_is_no_plain_array_is_left_to_numba(change):
    table = change(np.arange(12.0).reshape(3, 4))
    read = lean(lambda a, i, j: a[i, j])
    assert [read(table, i, j) for i in (0, -1) for j in (1, -2)] == [table[i, j] for i in (0, -1) for j in (1, -2)]


def test_what_llvm_is_given_is_half_as_long(monkeypatch):
    given, true = [], CPUCodeLibrary.add_ir_module

    def add(self, module):
        given[-1].append(len(str(module).splitlines()))
        return true(self, module)

    monkeypatch.setattr(CPUCodeLibrary, "add_ir_module", add)
    for compile_one in (lean, njit):
        given.append([])
        compile_one(lambda a, i, j: a[i, j] + a[j, i] * a[i, -1])(np.eye(4), 1, 2)
    (ours, *_), (numbas, *_) = given  # the function; the second is what Python calls
    assert ours < 0.6 * numbas


def test_only_while_ours_is_compiled(monkeypatch):
    seen = []
    true = quick_entries._entry
    monkeypatch.setattr(quick_entries, "_entry", lambda *given: seen.append(given) or true(*given))
    one = np.arange(3.0)
    assert njit(lambda a, i: a[i])(one, -1) == 2.0
    assert seen == []
    assert lean(lambda a, i: a[i])(one, -1) == 2.0
    assert len(seen) == 1
