"""BLAS has one thread inside every public function that computes, and afterwards as many as before."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from threading import Event

import numpy as np
import pytest
import scipy.linalg  # noqa: F401
from threadpoolctl import threadpool_info, threadpool_limits

from verify import Beam, Excitation, PointForce, Slider, free_vibration, load_scene, run_scene, simulate
from verify.analysis.solution_cache import SolutionCache
from verify.linear.base import BeamModel
from verify.linear.modes import Modes
from verify.parallel import map_processes
from verify.quantities.base import Quantity

STRIP = Beam(length=0.31, width=0.017, thickness=0.0023, youngs_modulus=113e9, density=4470.0)
FORCE = PointForce(position=0.11, amplitude=3.0)
SCENE = """
name = "strip"
title = "Strip"
[beam]
length = 0.31
width = 0.017
thickness = 0.0023
youngs_modulus = 113e9
density = 4470.0
[[gate]]
id = "first"
quantity = "mode.frequency"
arguments = { model = "segment", count = 7, mode = 1 }
at_least = 1.0
reference = "closed form"
why = "A frequency is positive."
"""


def threads(*_):
    return {library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"}


@pytest.fixture(autouse=True)
def three_threads():
    with threadpool_limits(3, user_api="blas"):
        if threads() != {3}:
            pytest.skip("this BLAS has no number of threads that can be set")
        yield
        assert threads() == {3}


def in_simulate(inside):
    slider = Slider(mass=0.02, mu=0.2, position=0.117)
    simulate(STRIP, Excitation(FORCE, 700.0), 3e-3, count=7, slider=slider, progress=lambda _: inside.append(threads()))


def in_free_vibration(inside):
    def shape(x):
        inside.append(threads())
        return 1e-6 * x * (STRIP.length - x)

    free_vibration(STRIP, shape, 1e-3, count=7)


def in_a_scene(inside):
    run_scene(load_scene("scene.toml"), progress=lambda _: inside.append(threads()))


def in_a_quantity(inside):
    def own(cache):
        inside.append(threads())
        return 1.0

    Quantity(own, "own", "1").evaluate({}, load_scene("paper"), SolutionCache(STRIP))


def in_a_model_of_another_package(inside):
    @dataclass(frozen=True)
    class Sines(BeamModel):
        beam: Beam
        n: int
        name, n_elastic = "sines", 1000

        def modes(self, n_modes):
            inside.append(threads())
            return Modes.of_shapes(
                np.array([0.0, self.beam.length]), np.sin, model="sines", count=self.n, frequencies_hz=np.ones(n_modes)
            )

    Sines(STRIP, 3).modes(2)


def in_a_task(inside):
    inside += map_processes(threads, [1, 2])


def in_worker_processes(inside):
    inside += map_processes(threads, [1, 2, 3], max_workers=2)


DOORS = [
    in_simulate, in_free_vibration, in_a_scene, in_a_quantity, in_a_model_of_another_package, in_a_task,
    in_worker_processes,
]  # fmt: skip


@pytest.mark.parametrize("door", DOORS)
def test_blas_has_one_thread_inside_and_as_many_as_before_afterwards(door, tmp_path, monkeypatch):
    (tmp_path / "scene.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    inside = []
    door(inside)
    assert inside
    assert inside == [{1}] * len(inside)
    assert threads() == {3}


def test_the_first_of_two_calls_to_return_leaves_one_thread_to_the_other():
    first_began, second_began, first_ended, seen = Event(), Event(), Event(), []

    def first(x):
        first_began.set()
        assert second_began.wait(60)
        return 1e-6 * np.sin(np.pi * x / STRIP.length)

    def second(x):
        second_began.set()
        assert first_ended.wait(60)
        seen.append(threads())
        return 1e-6 * np.sin(np.pi * x / STRIP.length)

    with ThreadPoolExecutor(2) as pool:
        one = pool.submit(free_vibration, STRIP, None, 1e-3, velocity=first, count=7)
        assert first_began.wait(60)
        other = pool.submit(free_vibration, STRIP, None, 1e-3, velocity=second, count=9)
        one.result()
        first_ended.set()
        other.result()
    assert seen
    assert seen == [{1}] * len(seen)
    assert threads() == {3}


def test_a_library_that_the_first_call_loads_has_one_thread_too():
    code = """
from threadpoolctl import threadpool_info
from verify import Beam, free_vibration
seen = []
def shape(x):
    import scipy.linalg
    seen.append({one["num_threads"] for one in threadpool_info() if one["user_api"] == "blas"})
    return 0.0 * x
free_vibration(Beam(length=0.31, width=0.017, thickness=0.0023, youngs_modulus=113e9, density=4470.0), shape, 1e-3, count=7)
assert seen and all(one == {1} for one in seen), seen
"""
    free = {name: value for name, value in os.environ.items() if not name.endswith("_NUM_THREADS")}
    subprocess.run([sys.executable, "-c", code], check=True, env=free)
