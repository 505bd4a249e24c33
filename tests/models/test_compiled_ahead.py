"""Kernels that other processes compile while a run compiles the first: each once, and no process is left behind."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux forks safely")

START = """
import json, os, sys
from verify.models import ahead, compiling
from verify.motion import warm
forked = []
fork = os.fork
def counted():
    child = fork()
    if child:
        forked.append(child)
        print("began", child, flush=True)
    return child
os.fork = counted
"""
RUN = """
def on_belts():
    return [*warm.on_belt("tanh"), *warm.on_belt("coulomb")]
with ahead.compiled_ahead(on_belts):
    for kernel, given in on_belts():
        kernel.compile(tuple(kernel.typeof_pyval(value) for value in given))
names = [one.kernel for one in compiling.compiled if not one.kernel.startswith("numba.")]
print(json.dumps({"forked": len(forked), "kernels": sorted(names)}))
"""


def surroundings(cache, jobs):
    path = os.pathsep.join(sys.path)
    return {**os.environ, "PYTHONPATH": path, "NUMBA_CACHE_DIR": str(cache), "VERIFY_JOBS": str(jobs)}


def told(cache, jobs, code=RUN):
    command = [sys.executable, "-W", "error", "-c", START + code]
    done = subprocess.run(command, capture_output=True, text=True, env=surroundings(cache, jobs), check=False)
    assert done.returncode == 0, done.stderr
    began = [int(line.split()[1]) for line in done.stdout.splitlines() if line.startswith("began")]
    return json.loads(done.stdout.splitlines()[-1]), began


def test_two_processes_compile_what_one_would_and_a_run_that_finds_it_starts_none(tmp_path):
    alone, _ = told(tmp_path / "alone", 1)
    both, began = told(tmp_path / "both", 2)
    assert alone["forked"] == 0
    assert both["forked"] == len(began) == 1
    assert set(both["kernels"]) == set(alone["kernels"])
    loops = [[name for name in one["kernels"] if name.endswith("slide_on_belt")] for one in (alone, both)]
    assert len(loops[0]) == len(loops[1]) == 2  # one for each law, none twice
    assert not any(is_there(child) for child in began)
    assert told(tmp_path / "both", 2)[0] == {"forked": 0, "kernels": []}
    assert not list(tmp_path.rglob("*.tmp.*"))


def test_what_helpers_compile_is_heard_by_nobody(tmp_path):
    """They share the run's terminal, whose line says what the run itself waits for."""
    listens = "compiling.hearers.append(lambda said: print('heard by', os.getpid(), flush=True))\n"
    words = [sys.executable, "-c", f"{START}print('run', os.getpid(), flush=True)\n{listens}{RUN}"]
    run = subprocess.run(words, capture_output=True, text=True, env=surroundings(tmp_path, 2), check=True)
    lines = run.stdout.splitlines()
    began, own, heard = ({line.split()[-1] for line in lines if line.startswith(k)} for k in ("began", "run", "heard"))
    assert len(began) == 1
    assert heard == own


def is_there(process):
    """Whether it runs; one that has ended and that nobody has asked about does not."""
    try:
        return Path(f"/proc/{process}/stat").read_text("ascii").rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


@pytest.mark.parametrize("ended_by", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_no_helper_outlives_a_run_that_is_ended(tmp_path, ended_by):
    """Asked again where it goes on: an interrupt that falls into a destructor or a callback is dropped by Python."""
    command = [sys.executable, "-c", START + RUN]
    run = subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=surroundings(tmp_path, 2), text=True
    )
    helper = int(run.stdout.readline().split()[1])
    time.sleep(0.1)
    while run.poll() is None:
        run.send_signal(ended_by)
        with suppress(subprocess.TimeoutExpired):
            run.wait(1.0)
    run.communicate()
    assert run.returncode != 0
    for _ in range(100):
        if not is_there(helper):
            break
        time.sleep(0.02)
    assert not is_there(helper)


def test_a_helper_that_is_killed_costs_its_work_and_nothing_else(tmp_path):
    killed = """
os.fork = lambda: (lambda child: os._exit(9) if child == 0 else child)(fork())
"""
    found, _ = told(tmp_path, 2, killed + RUN)
    assert sum(name.endswith("slide_on_belt") for name in found["kernels"]) == 2


FIRST = """
import signal
from verify.chain import warm as links
belts, chain = [*warm.on_belt("tanh"), *warm.on_belt("coulomb")], [*links.stretching()]
planned = [*belts, *chain]
def compile_(calls):
    for kernel, given in calls:
        kernel.compile(tuple(kernel.typeof_pyval(value) for value in given))
def needed(one):
    return {"belts": belts, "chain": chain, "one": belts[:1], "other": belts[1:], "none": []}[one]
reading, writing = os.pipe()
def begin_and_stop(crew, pipe):
    assert crew._claimed(1)
    os.write(writing, b"!")
    signal.pause()
ahead._Crew._help = begin_and_stop
"""


def test_what_waits_for_others_comes_after_what_needs_nothing_and_what_is_there(tmp_path):
    """The helper has begun the other belt, and is not done."""
    code = """
with ahead.compiled_ahead(lambda: planned) as first:
    order = [first.first_ready(["belts", "one"], needed)]  # nothing is there: what misses least
    length = {name: ahead._length(needed(name)[0][0]) for name in ("one", "chain")}
    shorter = first.first_ready(["one", "chain"], needed), first.first_ready(["chain", "one"], needed)
    compile_(belts[:1])
    os.read(reading, 1)
    states = [first._state(i) for i in range(len(first.calls))]
    order += [first.first_ready(["belts", "chain", name], needed) for name in ("none", "one")]
    order.append(first.first_ready(["belts", "chain"], needed))
print(json.dumps({"order": order, "states": states, "length": length, "shorter": shorter}))
"""
    found, _ = told(tmp_path, 2, FIRST + code)
    assert found["order"] == ["one", "none", "one", "chain"]
    assert found["shorter"] == 2 * [min(found["length"], key=found["length"].get)]
    assert len(set(found["length"].values())) == 2
    ready, free, begun = 0, 1, 2
    assert found["states"] == [ready, begun, *[free] * (len(found["states"]) - 2)]


def test_while_others_compile_what_all_wait_for_the_run_compiles_what_nobody_has_begun(tmp_path):
    code = """
with ahead.compiled_ahead(lambda: planned) as first:
    compile_(belts[:1])
    os.read(reading, 1)
    chosen = first.first_ready(["belts", "other"], needed)
    states = [first._state(i) for i in range(len(first.calls))]
print(json.dumps({"chosen": chosen, "states": states}))
"""
    found, _ = told(tmp_path, 2, FIRST + code)
    assert found["chosen"] == "belts"
    assert len(found["states"]) > 2
    assert found["states"] == [0, 2, *[0] * (len(found["states"]) - 2)]


def test_helpers_begin_with_the_longest_and_leave_what_the_run_is_about_to_ask_for_to_the_end(monkeypatch):
    from verify.chain import warm as links
    from verify.models import ahead
    from verify.motion import warm

    belts, chain = [*warm.on_belt("tanh"), *warm.on_belt("coulomb")], [*links.stretching()]
    monkeypatch.setattr(ahead, "_is_kept", lambda call: False)
    crew = ahead._Crew(lambda: [*belts, *chain], 0)
    crew.begin()
    assert crew.first_ready([5], lambda _: belts) == 5
    order = crew._longest_first()
    assert order[0] == 1  # a belt is the longest; of its two laws the last that is planned
    assert order[-1] == 0  # which shares its parts
    lengths = [ahead._length(crew.calls[index][0]) for index in order[1:-1]]
    assert all(after < before * ahead.ALIKE for before, after in pairwise(lengths))
    assert crew._choice(order) == order[1]
    assert crew._choice([1, 0]) == 0


def test_the_length_of_a_kernel_counts_each_of_its_parts_once():
    from verify.chain import kernels, recursion_kernels
    from verify.models import ahead

    inner = {one.__name__ for one in ahead._with_parts(kernels.march.py_func, {})}
    assert {"march", "accelerate", "hub_motion"} <= inner
    alone = len(recursion_kernels.hub_motion.py_func.__code__.co_code)
    assert ahead._length(recursion_kernels.hub_motion) == alone < ahead._length(kernels.march) / 20


def test_a_kernel_of_which_numba_does_not_tell_is_taken_for_kept_and_a_damaged_index_for_none():
    from verify.models import ahead

    def broken():
        raise ValueError("damaged")

    unknown = SimpleNamespace()
    assert ahead._is_kept((unknown, ()))
    file = SimpleNamespace(_load_index=broken)
    kept = SimpleNamespace(_cache_file=file, _index_key=lambda types, codegen: types)
    damaged = SimpleNamespace(_cache=kept, targetctx=SimpleNamespace(codegen=lambda: None))
    assert not ahead._is_kept((damaged, ()))
    file._load_index = lambda: {("float64",): "a file"}
    assert ahead._is_kept((damaged, ("float64",)))
    assert not ahead._is_kept((damaged, ("int64",)))
