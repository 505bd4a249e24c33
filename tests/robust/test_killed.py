"""Runs that are killed at any moment: files whole or absent, and the next run does not notice."""

import json
import signal
import sys
from importlib.util import LazyLoader, module_from_spec, spec_from_file_location
from pathlib import Path
from random import Random
from time import monotonic, sleep

import pytest
from ended import SCENE, started, whole

from verify.ending import TERMINATED, end_tidily

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="signals")
HOW = (signal.SIGKILL, signal.SIGINT, signal.SIGTERM)
SLIDES = """
name = "slides"
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
drive = { frequency_hz = 310.0, force = [{ position = 0.1 }] }
slider = { mass = 1e-4, mu = 0.2 }
[[gate]]
id = "goes"
quantity = "slider.displacement"
arguments = { model = "segment", count = 9, time = 0.02 }
at_most = 1.0
why = "It steps."
"""
"""What compiles, where nothing is compiled yet: killed in the middle of that, the next run has to compile again."""


def killed_at_random(folder, seed, scene, longest):
    """One run ended by one signal after a random time: the process, when it has ended."""
    draw = Random(seed)
    process = started(["run", scene], folder, NUMBA_CACHE_DIR=str(folder / "kernels"))
    sleep(draw.uniform(0.0, longest))
    process.send_signal(HOW[seed % len(HOW)])
    return process, process.communicate()


def parts_in(folder):
    """What was begun and not ended."""
    return {path.name for path in (folder / "reports").rglob(".*")}


def check_left(folder, process, said, parts):
    """The status is the signal's or the run's own; there is no half page; parts are left by SIGKILL alone."""
    how, begins = process.returncode, b"/verify/" not in said[1] and said[1].endswith(b"KeyboardInterrupt\n")
    assert how in (0, -signal.SIGKILL, 130, 143, -signal.SIGINT, -signal.SIGTERM) or (how == 1 and begins), said
    assert b"Traceback" not in said[1] or begins  # Python itself, before the suite is asked
    assert all(whole(page) for page in (folder / "reports").glob("[!.]*.html"))
    kept = [run for home in (folder / "reports").glob("[!.]*/") for run in home.iterdir()]
    assert all({one.name for one in run.iterdir()} == {"index.html", "run.json"} for run in kept)
    assert all(whole(run / "index.html") and json.loads((run / "run.json").read_text("utf-8")) for run in kept)
    new = parts_in(folder) - parts
    assert not new or how == -signal.SIGKILL
    assert all(name.startswith((".mine.", ".slides.")) and name.endswith(".part") for name in new)


def next_run_is_unharmed(folder, name):
    process = started(["run", f"{name}.toml"], folder, NUMBA_CACHE_DIR=str(folder / "kernels"))
    out, err = process.communicate()
    assert (process.returncode, err) == (0, b"")
    assert b"all 1 gates passed" in out
    assert whole(folder / "reports" / f"{name}.html")


def rounds(folder, seeds, longest):
    for name, text in (("mine", SCENE), ("slides", SLIDES)):
        (folder / f"{name}.toml").write_text(text)
    for seed in seeds:
        name = ("mine", "mine", "slides")[seed // 3 % 3] if "slides" in longest else "mine"
        parts = parts_in(folder)
        process, said = killed_at_random(folder, seed, f"{name}.toml", longest[name])
        check_left(folder, process, said, parts)
        if seed % 9 == 8:
            next_run_is_unharmed(folder, "mine")
    next_run_is_unharmed(folder, "mine")


def test_a_run_that_is_killed_leaves_no_half_file(tmp_path):
    rounds(tmp_path, range(6), {"mine": 1.0})


@pytest.mark.hostile
def test_two_hundred_runs_that_are_killed_leave_no_half_file_and_kernels_that_run(tmp_path):
    rounds(tmp_path, range(200), {"mine": 2.0, "slides": 12.0})
    next_run_is_unharmed(tmp_path, "slides")


@pytest.mark.parametrize(("at", "left"), [(1, []), (2, ["mine"])])
def test_a_run_that_is_told_to_end_while_it_writes_takes_its_part_away(tmp_path, monkeypatch, capsys, at, left):
    """Told when the folder of the run, or the latest page, is written and not yet there."""
    import os

    from verify import cli

    (tmp_path / "mine.toml").write_text(SCENE)
    monkeypatch.chdir(tmp_path)
    before = {one: signal.getsignal(one) for one in (signal.SIGTERM, signal.SIGHUP)}
    seen, true = [], os.replace
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)

    def told(source, target):
        if Path(target).resolve().is_relative_to(tmp_path.resolve()):  # and not of what Python compiles
            seen.append(sorted(path.suffix or path.name for path in (tmp_path / "reports").iterdir()))
            if len(seen) == at:
                os.kill(os.getpid(), signal.SIGTERM)
        true(source, target)

    monkeypatch.setattr(os, "replace", told)
    try:
        for one in before:
            signal.signal(one, signal.SIG_DFL)
        end_tidily()
        assert cli.status_of(["run", "mine.toml"]) == TERMINATED
    finally:
        for one, handler in before.items():
            signal.signal(one, handler)
    assert seen == [[".part", "mine"]] * at
    assert [path.name for path in (tmp_path / "reports").iterdir()] == left
    kept = [sorted(one.name for one in run.iterdir()) for run in (tmp_path / "reports").glob("mine/*")]
    assert kept == [["index.html", "run.json"]] * len(left)
    assert capsys.readouterr().err == "verify: terminated; nothing half-written is left\n"


LONG_S = 20.0


def who_asks_while_llvm_writes(number, folder):
    """A small module compiled, and time for the request to be heard."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    module = binding.parse_assembly("define i64 @seven() { ret i64 7 }")
    engine = binding.create_mcjit_compiler(module, binding.Target.from_default_triple().create_target_machine())
    engine.set_object_cache(lambda module, data: signal.raise_signal(number), lambda module: None)
    engine.finalize_object()
    sleep(LONG_S)


def who_asks_while_a_module_wakes(number, folder):
    """One that sleeps is read where it is imported again: what it raises there, Python takes for none."""
    (folder / "dozing.py").write_text(f"import signal\nsignal.raise_signal({int(number)})\nwhole = True\n")
    spec = spec_from_file_location("dozing", folder / "dozing.py")
    spec.loader = LazyLoader(spec.loader)
    sys.modules["dozing"] = module = module_from_spec(spec)
    spec.loader.exec_module(module)
    import dozing

    assert vars(dozing)["whole"]
    sleep(LONG_S)


def who_asks_in_a_destructor(number, folder):
    """Of what comes up there, Python tells and goes on."""

    class Last:
        def __del__(self):
            signal.raise_signal(number)

    Last()
    sleep(LONG_S)


@pytest.mark.parametrize("asks", [who_asks_while_llvm_writes, who_asks_while_a_module_wakes, who_asks_in_a_destructor])
@pytest.mark.parametrize(("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, SystemExit)])
def test_a_request_to_end_where_what_it_raises_would_be_lost_is_heard_a_little_later(
    monkeypatch, tmp_path, asks, number, raised
):
    lost, before = [], {one: signal.getsignal(one) for one in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    monkeypatch.setattr(sys, "unraisablehook", lost.append)
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        end_tidily()
        began = monotonic()
        with pytest.raises(raised):
            asks(number, tmp_path)
        assert monotonic() - began < 0.9 * LONG_S  # who sleeps is woken
    finally:
        sys.modules.pop("dozing", None)
        for one, handler in before.items():
            signal.signal(one, handler)
    assert not lost
