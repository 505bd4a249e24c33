"""Independent work on several cores gives what one core gives, and leaves nobody behind."""

import mmap
import os
import signal
import subprocess
import sys
import time

import pytest

from verify.cores import at_once, for_each, start
from verify.errors import InputError

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="work is shared where the system forks safely")


def children():
    """Processes that this one has started and not yet waited for."""
    try:
        return os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return "none"


@pytest.mark.parametrize("n_jobs", [1, 2, 3, 40])
def test_results_come_in_order_whoever_is_done_first(monkeypatch, n_jobs):
    monkeypatch.setenv("VERIFY_JOBS", str(n_jobs))
    heard = []

    def work(item):
        time.sleep(0.003 * (7 - item % 8))
        return item**0.5, os.getpid()

    found = for_each(work, range(17), heard.append)
    assert [root for root, _ in found] == [item**0.5 for item in range(17)]
    assert heard == list(range(1, 18))
    assert found[0][1] == os.getpid()
    assert len({process for _, process in found}) == (1 if n_jobs == 1 else min(n_jobs, 16) + 1)
    assert children() == "none"


@pytest.mark.parametrize("n_jobs", [1, 2, 3, 40])
def test_what_is_done_at_once_is_shared_with_here_and_comes_in_order(monkeypatch, n_jobs):
    monkeypatch.setenv("VERIFY_JOBS", str(n_jobs))
    found = at_once(lambda item: (item**0.5, os.getpid()), range(7))
    assert [root for root, _ in found] == [item**0.5 for item in range(7)]
    assert found[0][1] == os.getpid()
    assert len({process for _, process in found}) == min(n_jobs, 7)
    assert at_once(abs, []) == []
    assert children() == "none"


def test_who_works_beside_does_not_wait_until_it_is_heard(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "2")
    done, here = mmap.mmap(-1, 1), os.getpid()

    def work(item):
        if os.getpid() == here:
            until = time.monotonic() + 10.0
            while not done[0] and time.monotonic() < until:
                time.sleep(0.001)
            return done[0]
        done[0] = item == 7
        return bytes(50_000)

    assert at_once(work, range(8)) == [1, bytes(50_000)] * 4


@pytest.mark.parametrize("share", [at_once, lambda work, items: for_each(work, items, lambda number: None)])
@pytest.mark.parametrize("n_jobs", [1, 2, 5])
def test_of_several_refusals_the_first_is_raised_as_it_is(monkeypatch, share, n_jobs):
    monkeypatch.setenv("VERIFY_JOBS", str(n_jobs))

    def work(item):
        time.sleep(0.02 if item == 3 else 0.0)
        if item in (3, 4, 9):
            raise InputError(f"item = {item} is no good: take another")
        return item

    with pytest.raises(InputError, match=r"^item = 3 is no good"):
        share(work, range(12))
    assert children() == "none"


def test_what_a_process_that_dies_leaves_undone_is_done_here(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "2")
    here = os.getpid()

    def work(item):
        if item == 5 and os.getpid() != here:
            os._exit(9)
        return item, os.getpid() == here

    found = for_each(work, range(9), lambda number: None)
    assert [item for item, _ in found] == list(range(9))
    assert [item for item, done_here in found if done_here] == [0, 5, 7]
    assert children() == "none"


def test_an_interrupt_ends_all_processes(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "2")

    def stop(number):
        if number == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        for_each(lambda item: time.sleep(0.01 if item < 4 else 30.0), range(20), stop)
    assert children() == "none"


@pytest.mark.parametrize("given", ["0", "-2", "two", "1.5", "\u00b2"])
def test_a_number_of_jobs_that_is_none_is_refused(monkeypatch, given):
    monkeypatch.setenv("VERIFY_JOBS", given)
    with pytest.raises(InputError, match=r"VERIFY_JOBS = .* give a whole number of processes"):
        for_each(abs, [1, 2, 3], lambda number: None)


FORKED = """
import os, signal, sys
from verify.cores import start
signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(143))
os.register_at_fork(after_in_parent=lambda: [os.kill(os.getpid(), signal.NUMBER) for _ in range(1)])
kept = []
try:
    BEGIN
    status = 7
except BaseException as asked:
    status = 130 if isinstance(asked, KeyboardInterrupt) else asked.code
for child in kept:
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
raise SystemExit(status)
"""
PLAIN = "kept.append(child) if (child := os.fork()) else os._exit(3)"
OURS = "start(lambda: os._exit(3), kept.append)"


@pytest.mark.parametrize(
    ("begin", "number", "status"),
    [(OURS, "SIGTERM", 143), (OURS, "SIGINT", 130), (PLAIN, "SIGTERM", 7), (PLAIN, "SIGINT", 7)],
)
def test_a_request_to_end_while_a_process_begins_is_heard_and_the_process_known(begin, number, status):
    """What is raised where other libraries are told of a fork is lost, as the plain way shows."""
    code = FORKED.replace("NUMBER", number).replace("BEGIN", begin)
    env = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (status, "3\n")
    assert ("Exception ignored" in done.stderr) == (begin is PLAIN)


def test_a_process_that_begins_answers_as_the_one_that_began_it():
    """A child told to end ends: nothing is noted for later there."""
    kept = []

    def sleeps():
        time.sleep(30.0)
        os._exit(0)

    start(sleeps, kept.append)
    before = signal.getsignal(signal.SIGTERM)
    assert before is signal.SIG_DFL
    time.sleep(0.1)
    os.kill(kept[0], signal.SIGTERM)
    assert os.waitstatus_to_exitcode(os.waitpid(kept[0], 0)[1]) == -signal.SIGTERM


def test_what_was_written_before_a_process_began_is_written_once():
    """What a stream still holds would be a copy in the child, which writes it again where it ends with a flush."""
    code = (
        "import os, sys; from verify.cores import start; kept = []\n"
        "sys.stdout.write('once'), sys.stderr.write('told')\n"
        "start(lambda: (sys.stdout.flush(), sys.stderr.flush(), os._exit(0)), kept.append)\n"
        "os.waitpid(kept[0], 0)"
    )
    env = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path), "PYTHONUNBUFFERED": ""}
    done = subprocess.run([sys.executable, "-c", code], env=env, capture_output=True, text=True, check=True)
    assert (done.stdout, done.stderr) == ("once", "told")
