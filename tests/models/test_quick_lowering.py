"""Kernels of parts, records and loops do what their Python does, in fewer instructions than numba gives LLVM."""

from typing import NamedTuple

import numpy as np
import pytest
from numba import njit, typeof
from numba.core.codegen import CPUCodeLibrary

from verify.models import kernels
from verify.models.kernels import _ScalarCompiler, part


class Spring(NamedTuple):
    """Of a rod."""

    stiffness: float
    rest: float | None
    pulls: bool


class Rod(NamedTuple):
    """With a record, arrays, a number and a truth."""

    loads: np.ndarray
    table: np.ndarray
    stretched: bool
    spring: Spring
    mass: float


def lean():
    """As kernels are compiled, and not kept on disk."""
    return njit(pipeline_class=_ScalarCompiler, _nrt=False)


def plain():
    return lambda function: function


def made(part, lean):
    """A kernel of a part, which is asked for in two places."""

    @part()
    def work(rod, at, free, stiff):
        done = 0.0 if rod.spring.rest is None else rod.spring.rest
        for i in range(free.size - 1, -1, -2):
            if i == at:
                continue
            done += rod.loads[i] * free[i]
            for j in range(1, rod.table.shape[1]):
                done += rod.table[i, j] / (j + rod.mass)
        for i in range(3, at):
            done -= i
        free[at] += 0.25
        if stiff or not rod.spring.pulls:
            return done * rod.spring.stiffness, i
        return done, 7

    @lean()
    def whole(rod, free, steps):
        total, last = 0.0, 0
        row = rod.table[1]
        for step in range(steps):
            before = total
            for turn in range(2):
                one, last = work(rod, step % 3, free if turn else row, rod.stretched)
                total += one * (turn + 1) - 0.125 * before
        return total, before, last

    return whole


KERNEL = made(part, lean)


def given(stretched, pulls, rest):
    rng = np.random.default_rng(3)
    spring = Spring(stiffness=1.7, rest=rest, pulls=pulls)
    rod = Rod(rng.normal(size=4), rng.normal(size=(4, 4)), stretched, spring, mass=0.31)
    return rod, rng.normal(size=4), 5


@pytest.mark.parametrize(("stretched", "pulls"), [(True, True), (False, True), (False, False)])
def test_a_kernel_of_parts_records_and_loops_does_what_its_python_does(stretched, pulls):
    ours, pythons = given(stretched, pulls, 0.013), given(stretched, pulls, 0.013)
    assert KERNEL(*ours) == pytest.approx(made(plain, plain)(*pythons), rel=1e-14)
    for one, other in zip((*ours[0][:2], ours[1]), (*pythons[0][:2], pythons[1]), strict=True):
        assert one == pytest.approx(other, rel=1e-14)


def hung(rod, at, free):
    for i in range(rod.loads.size):
        free[at, i] += rod.loads[i] * rod.spring.stiffness


@pytest.mark.skipif(not kernels.LOWERED, reason="a numba that was not tried lowers by itself")
def test_llvm_is_given_half_of_numbas_instructions(monkeypatch):
    told, true = [], CPUCodeLibrary.add_ir_module

    def add(self, module):
        told.append(str(module).count("\n  "))
        return true(self, module)

    monkeypatch.setattr(CPUCodeLibrary, "add_ir_module", add)
    rod, _, at = given(False, True, None)
    for known in (True, False):
        monkeypatch.setattr(kernels, "LOWERED", known)
        part()(hung).compile((typeof(rod), typeof(at), typeof(rod.table)))
    ours, numbas = told
    assert ours < 0.5 * numbas


@pytest.mark.parametrize("step", [-2, 0, 3])
def test_a_step_that_is_not_written_out_is_left_to_numba(step):

    def of_part(first, last, step):
        return sum_of(first, last, step)

    count = lean()(of_part)
    if step:
        assert count(7, -5, step) == sum(range(7, -5, step))
    else:
        with pytest.raises(ValueError, match="must not be zero"):
            count(7, -5, step)


@part()
def sum_of(first, last, step):
    found = 0
    for i in range(first, last, step):
        found += i
    return found
