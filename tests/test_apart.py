"""Work in processes of its own: in order, heard, and what one of them breaks is its own."""

import os
import signal
import sys
from pathlib import Path

import pytest

from verify.apart import Died, each_apart

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="processes are forked on Linux alone")
FATES = {"dies": lambda: os.kill(os.getpid(), signal.SIGKILL), "leaves": lambda: os._exit(7), "breaks": lambda: 1 / 0}


def done(item, say):
    """What it is asked for, told in two steps."""
    say(f"{item} begins")
    FATES.get(item, int)()
    say(f"{item} ends")
    return item, os.getpid()


def test_results_stand_in_order_and_every_step_is_heard(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "3")
    heard = []
    found = each_apart(done, list("abcdefg"), lambda index, words: heard.append((index, words)))
    assert [item for item, _ in found] == list("abcdefg")
    assert len({process for _, process in found} | {os.getpid()}) == 8
    for i, item in enumerate("abcdefg"):
        assert [words for index, words in heard if index == i] == [f"{item} begins", f"{item} ends"]


def test_with_one_job_all_is_done_here(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "1")
    heard = []
    found = each_apart(done, ["a", "b"], lambda index, words: heard.append((index, words)))
    assert found == [("a", os.getpid()), ("b", os.getpid())]
    assert heard == [(0, "a begins"), (0, "a ends"), (1, "b begins"), (1, "b ends")]


def test_a_process_that_dies_takes_its_own_work_with_it_and_nothing_else(monkeypatch, capfd):
    monkeypatch.setenv("VERIFY_JOBS", "2")
    found = each_apart(done, ["a", "dies", "b", "leaves", "breaks", "c"], lambda *_: None)
    assert [found[i][0] for i in (0, 2, 5)] == ["a", "b", "c"]
    assert [found[i] for i in (1, 3, 4)] == [Died(-signal.SIGKILL), Died(7), Died(1)]
    assert capfd.readouterr() == ("", "")


def test_none_is_left_behind_by_an_interrupt(monkeypatch):
    """Which the first thing heard raises, as a key would."""
    monkeypatch.setenv("VERIFY_JOBS", "2")

    def stop(index, words):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        each_apart(lambda item, say: (say("here"), signal.pause()), ["a", "b", "c"], stop)
    tasks = Path(f"/proc/{os.getpid()}/task")
    children = [(task / "children").read_text() for task in tasks.iterdir() if (task / "children").exists()]
    assert not "".join(children).split()
