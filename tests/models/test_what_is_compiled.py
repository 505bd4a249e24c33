"""Which kernels a run compiles: those of its law and its coupling, each once; and what is kept of them.

Runs have processes of their own and an empty cache, since a process that has compiled compiles no more.
"""

import errno
import json
import os
import subprocess
import sys

import numpy as np
import pytest

from verify.commands import warm_up
from verify.models import compiling
from verify.models.kernels import compiled, part
from verify.run.kernels_asked import kernels_asked
from verify.scenes.scene import load_scene, packaged_scenes
from verify.slider import GRAVITY

START = """
import json, sys
from verify.beam import Beam, PointForce
from verify.models import compiling
from verify.slider import Slider
STRIP = Beam(length=0.31, width=0.013, thickness=0.0009, youngs_modulus=113e9, density=4430.0)
FORCES = (PointForce(position=0.07, amplitude=0.4), PointForce(position=0.23, amplitude=0.3, phase_deg=70.0))

def slid(**given):
    from verify.motion.simulate import simulate
    slider = Slider(mass=0.003, mu=0.3, position=0.19, **given)
    simulate(STRIP, FORCES, 430.0, 1e-4, count=4, slider=slider, samples=3)

def stepped():
    from verify.chain.dynamics import at_rest
    from verify.chain.stepping import simulate
    from verify.chain.system import build_system
    system = build_system(STRIP, 4, FORCES, 430.0)
    simulate(system, at_rest(system), [1e-5, 2e-5])
"""
END = "\nprint(json.dumps([one.kernel for one in compiling.compiled]))"
LAWS = {"tanh": {"tanh_speed_change", "_held_change", "_swept_change"}, "coulomb": {"coulomb_span", "_first_zero"}}
FELT = {"push_back", "_answer", "_balance", "set_levers", "_reaction"}


def surroundings(cache):
    return {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "NUMBA_CACHE_DIR": str(cache)}


def child(code, cache):
    """Standard output of a process of its own, in which a warning is an error."""
    command = [sys.executable, "-W", "error", "-c", code]
    return subprocess.run(command, capture_output=True, text=True, env=surroundings(cache), check=False)


def compiled_by(what, cache):
    done = child(START + what + END, cache)
    assert done.returncode == 0, done.stderr
    return [name for name in json.loads(done.stdout.splitlines()[-1]) if not name.startswith("numba.")]


@pytest.mark.parametrize(
    ("given", "law", "felt"),
    [
        ("coupling='one-way'", "tanh", False),
        ("coupling='two-way'", "tanh", True),
        ("coupling='one-way', law='coulomb'", "coulomb", False),
    ],
)
def test_a_slider_compiles_its_law_and_its_coupling_each_kernel_once(tmp_path, given, law, felt):
    names = compiled_by(f"slid({given})", tmp_path)
    assert len(names) == len(set(names))
    assert {name.split(".")[0] for name in names} == {"motion"}
    found = {name.rpartition(".")[2] for name in names}
    assert {"slide", "_put_on", "slip"} <= found
    for one, own in LAWS.items():
        assert found & own == (own if one == law else set())
    assert found & FELT == (FELT if felt else set())
    assert compiled_by(f"slid({given})", tmp_path) == []


def test_a_chain_of_rigid_links_compiles_neither_sliders_nor_modes_nor_links_that_stretch(tmp_path):
    names = compiled_by("stepped()", tmp_path)
    assert len(names) == len(set(names))
    assert {name.rpartition(".")[0] for name in names} == {
        "chain.kernels",
        "chain.recursion_kernels",
        "chain.held_kernels",
    }


FEWER = """
from verify.commands import warm_up
from verify.cli import status_of
small = {"friction_kernels.slide_on_belt", "stretching_kernels.march", "hop_kernels.put"}
short = lambda kernel: kernel.py_func.__module__.rpartition(".")[2] + "." + kernel.__name__
rooms = {short(kernel): (kernel, given) for kernel, given in warm_up._calls() if short(kernel) in small}
warm_up._calls = lambda: [*rooms.values()]
"""
"""A small kernel of each room in place of all, which take a minute."""


def test_a_warm_up_keeps_its_kernels_where_it_is_told_to_and_compiles_none_twice(tmp_path):
    first = child(f"{FEWER}\nraise SystemExit(status_of(['warm-up', '--json']))", tmp_path)
    assert first.returncode == 0, first.stderr
    told = json.loads(first.stdout)
    made = {one["kernel"].partition(".")[0] for one in told["kernels"]}
    assert made == {"motion", "motor", "chain"}
    assert len(told["folders"]) == 3
    assert all(folder.startswith(str(tmp_path)) for folder in told["folders"])
    asked = "for kernel, given in rooms.values(): kernel.compile(tuple(map(kernel.typeof_pyval, given)))"
    assert compiled_by(f"{FEWER}\n{asked}", tmp_path) == []
    again = child(f"{FEWER}\nraise SystemExit(status_of(['warm-up']))", tmp_path)
    assert again.stdout.startswith("all kernels were there already")


def test_a_warm_up_compiles_what_packaged_scenes_plan():
    """Which is what they run: tests/run/test_kernels_asked.py."""
    made = {named(*call) for call in warm_up._calls()}
    planned = {scene: {named(*call) for call in kernels_asked(load_scene(scene))} for scene in packaged_scenes()}
    assert sum(map(len, planned.values())) > 20
    assert {scene: kernels - made for scene, kernels in planned.items() if kernels - made} == {}


def named(kernel, given):
    return kernel.py_func.__module__, kernel.__name__, tuple(map(kernel.typeof_pyval, given))


UNWRITABLE = """
from numba.core import caching
def refuse(self): raise OSError(30, "Read-only file system")
caching._CacheLocator.ensure_cache_path = refuse
"""


def test_where_nothing_can_be_kept_a_run_goes_on_and_says_how_to_keep_it(tmp_path):
    run = (
        "from verify.cli import status_of; raise SystemExit(status_of(['run', 'moving-load', '--no-report', '--json']))"
    )
    done = child(UNWRITABLE + run, tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["passed"]
    assert done.stderr == f"verify: {compiling.AT_EVERY_RUN}\n"


@pytest.mark.parametrize(("before", "folder"), [(UNWRITABLE, "kept"), ("", "file/kept")])
def test_a_warm_up_that_can_keep_nothing_is_refused_in_a_sentence(tmp_path, before, folder):
    (tmp_path / "file").write_text("no folder", "utf-8")
    warm_up = "from verify.cli import status_of; raise SystemExit(status_of(['warm-up']))"
    done = child(before + warm_up, tmp_path / folder)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert "NUMBA_CACHE_DIR" in done.stderr


def test_a_full_disk_costs_what_is_kept_and_nothing_else(monkeypatch):
    @compiled()
    def thrice(x):
        return 3.0 * x

    def full(*given):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(compiling, "unkept", [])
    monkeypatch.setattr(thrice._cache._cache_file, "save", full)
    assert thrice(1.7) == 3.0 * 1.7
    assert len(compiling.unkept) == 1


def test_what_cannot_be_read_is_compiled_again(monkeypatch):
    @compiled()
    def fourfold(x):
        return 4.0 * x

    def damaged(*given):
        raise EOFError("Ran out of input")

    monkeypatch.setattr(compiling, "unkept", [])
    monkeypatch.setattr(fourfold._cache._cache_file, "load", damaged)
    assert fourfold(1.7) == 4.0 * 1.7
    assert compiling.unkept == []


DECAY = """
import json
from verify.models import compiling
from verify.motion.rigid_surface import free_decay
print(free_decay(0.3, 140.0, 0.017, 0.0023))
"""


def test_two_processes_that_compile_at_once_both_get_their_figures(tmp_path):
    command, given = [sys.executable, "-W", "error", "-c", DECAY + END], surroundings(tmp_path)
    pair = [subprocess.Popen(command, env=given, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    told = [one.communicate()[0].splitlines() for one in pair]
    assert [one.returncode for one in pair] == [0, 0]
    assert any("motion.friction_kernels.slide_on_belt" in kernels for _, kernels in told)  # one may come late
    last = child(DECAY + END, tmp_path).stdout.splitlines()
    assert {figure for figure, _ in told} == {last[0]}
    # sinh(s v) decays as exp(-mu g s t) under mu g tanh(s v)
    expected = np.arcsinh(np.sinh(140.0 * 0.017) * np.exp(-0.3 * GRAVITY * 140.0 * 0.0023)) / 140.0
    assert float(last[0]) == pytest.approx(expected, rel=1e-9)
    assert json.loads(last[1]) == []
    assert not list(tmp_path.rglob("*.tmp.*"))


def test_a_part_is_no_function_of_python():
    @part()
    def half(x):
        return 0.5 * x

    @compiled()
    def quarter(x):
        return 0.5 * half(x)

    assert quarter(1.7) == 0.25 * 1.7
    with pytest.raises(TypeError, match="by kernels alone"):
        half(1.7)
