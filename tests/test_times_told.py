"""What is said of a run's own cost: its steps, what each of them asks, and no more time than the clock saw around it."""

import os
import subprocess
import sys
from time import perf_counter

import pytest
from msgspec.structs import replace

from verify import Beam, PointForce
from verify.chain.dynamics import at_rest
from verify.chain.ride import half_steps, ride
from verify.chain.splitting import modal_basis, simulate_linear, simulate_modal
from verify.chain.stepping import simulate
from verify.chain.stretching import simulate_elastic
from verify.chain.system import build_system
from verify.judge.workbench import Workbench
from verify.motion.simulate import simulate as simulate_beam
from verify.slider import Slider

BEAM = Beam(length=0.37, width=0.02, thickness=0.0043, youngs_modulus=70e9, density=2700.0)
HERTZ = 900.0
FORCES = (PointForce(position=0.05, amplitude=0.007), PointForce(position=0.31, amplitude=0.005, phase_deg=70.0))
SLIDER = Slider(mass=2e-3, mu=0.3, slope=40.0, position=0.14, coupling="one-way")
TIMES = half_steps(3e-4, 1e-6)


def chain(**given):
    return build_system(BEAM, 7, FORCES, HERTZ, load="reciprocal", **given)


def stepped():
    return simulate(chain(), at_rest(chain()), TIMES, method="rk4", step=1e-6)


def over_kicks():
    return simulate_modal(modal_basis(chain()), at_rest(chain()), TIMES, step=1e-5)


def stretching():
    return simulate_elastic(chain(), 70e9 * 0.02 * 0.0043, TIMES)


RUNS = {
    "steps of a chain": stepped,
    "kicks": over_kicks,
    "stretching links": stretching,
    "a slider on a chain": lambda: ride(stretching(), BEAM, SLIDER),
    "a beam": lambda: simulate_beam(BEAM, FORCES, HERTZ, 3e-3, count=9, samples=5),
    "a slider": lambda: simulate_beam(BEAM, FORCES, HERTZ, 3e-3, count=9, slider=SLIDER, samples=5),
    "a slider that is felt": lambda: simulate_beam(
        BEAM, FORCES, HERTZ, 3e-3, count=9, slider=replace(SLIDER, coupling="two-way"), samples=5
    ),
}


@pytest.mark.parametrize("kind", RUNS)
def test_setting_up_and_running_take_no_longer_than_the_clock_saw(kind):
    began = perf_counter()
    found = RUNS[kind]().statistics
    seen = perf_counter() - began
    assert min(found.set_up_s, found.wall_s) > 0.0
    assert found.set_up_s + found.wall_s < seen
    assert found.set_up_s != found.wall_s  # each is its own


EACH = {
    "steps of a chain": (300, 4, 0),
    "kicks": (30, 2 * 2, 0),
    "stretching links": (None, 4, 0),
    "a slider on a chain": (300, 2, 1),
    "a beam": (0, 0, 5),
    "a slider": (None, 2, 1),
    "a slider that is felt": (None, 2, 1),
}
"""Steps where they were asked for, evaluations in each, and beside them: Runge and Kutta's stages, two to a kick, both
halves of a contact's step."""


@pytest.mark.parametrize("kind", EACH)
def test_a_run_says_how_many_steps_it_took_how_long_they_were_and_what_they_asked(kind):
    (steps, each, beside), found = EACH[kind], RUNS[kind]()
    told = found.statistics
    assert told.steps == steps or (steps is None and told.steps > 0)
    assert told.evaluations == told.steps * each + beside
    assert told.step_s * told.steps == pytest.approx(found.times[-1] if told.steps else 0.0, rel=1e-12)
    assert told.stopped == "end"


def test_steps_that_were_taken_once_more_are_counted_among_evaluations():
    """Dormand and Prince: six in each, the seventh is the next one's first."""
    told = simulate(chain(), at_rest(chain()), TIMES, tolerance=1e-9).statistics
    assert told.rejected > 0
    assert told.evaluations == 6 * (told.steps + told.rejected)


def test_a_linear_chain_takes_no_longer_than_the_clock_saw():
    basis, start = modal_basis(chain()), at_rest(chain())
    began = perf_counter()
    found = simulate_linear(basis, start, TIMES).statistics
    assert 0.0 < found.wall_s < perf_counter() - began


def test_solves_on_a_bench_take_no_longer_than_the_clock_saw():
    bench, began = Workbench(BEAM), perf_counter()
    for model in ("segment", "fem"):
        bench.modes(model, 31, 4)
    seconds = [solve.seconds for solve in bench.solves]
    assert len(seconds) == 2
    assert min(seconds) > 0.0
    assert sum(seconds) < perf_counter() - began


def test_kernels_take_no_longer_to_compile_than_the_clock_saw(tmp_path):
    """Each its own time, without that of those within it."""
    words = (
        "from time import perf_counter; began = perf_counter()\n"
        "from verify.models import compiling\n"
        "from verify.chain.dynamics import accelerations, at_rest\n"
        "from verify.chain.system import build_system\n"
        "from verify.scenes.scene import load_scene\n"
        "system = build_system(load_scene('steel-cantilever').beam, 5)\n"
        "accelerations(system, at_rest(system))\n"
        "seconds = [one.seconds for one in compiling.compiled]\n"
        "print(len(seconds), min(seconds), sum(seconds), perf_counter() - began)\n"
    )
    given = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path)}
    told = subprocess.run([sys.executable, "-c", words], env=given, capture_output=True, text=True, check=True)
    number, least, together, seen = map(float, told.stdout.split())
    assert number > 1
    assert least > 0.0
    assert together < seen
