"""Which gate or test runs which line of the suite, and how long each takes.

Inside pytest this module is a plugin: `pytest -p benchmarks.recorded_lines` under `coverage run` names the lines after
the test that runs them, also in processes that the test starts. Outside, `recorded` runs it and reads what it left.
"""

import json
import os
import subprocess
import sys
from collections.abc import Iterable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, NamedTuple

import pytest

COMPILER = "verify.linear.kernels"
TOLD = "GATES_SECONDS"
"""The variable of the environment that names the file to which times go."""
ASKER = "GATES_ASKER"
"""The variable that names the test from which a process of its own is started."""
HOW = "GATES_HOW"
"""The variable that names the file of `CHILDREN`."""
CHILDREN = """\
[run]
source = verify
data_file = {lines}
parallel = true
sigterm = true
patch = _exit
context = ${{{asker}-}}
"""
"""How coverage follows a test into the processes that it starts."""
ALONE = {"OPENBLAS_NUM_THREADS": "1", "VERIFY_JOBS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
GIVEN = "PYTEST_ADDOPTS"


class Recorded(NamedTuple):
    """What gates and tests did without a fault."""

    seconds: dict[str, float]
    """By gate or test, of those that hold."""
    run: dict[str, dict[int, set[str]]]
    """Gates and tests by module and line; a file of tests where all of it shares what ran the line."""

    def running(self, lines: Iterable[tuple[str, int]]) -> set[str]:
        """Those that run one of these (module, line); all that run a module where the line is nought."""
        found = set[str]()
        for module, line in lines:
            run = self.run.get(module, {})
            found |= run.get(line, set()) if line else set().union(*run.values())
        shared = tuple(f"{one}::" for one in found - self.seconds.keys())
        return {one for one in self.seconds if one in found or (shared and one.startswith(shared))}

    def beside(self, other: "Recorded") -> "Recorded":
        """Both."""
        run = {module: dict(lines) for module, lines in self.run.items()}
        for module, lines in other.run.items():
            own = run.setdefault(module, {})
            for line, which in lines.items():
                own[line] = own.get(line, set()) | which
        return Recorded(self.seconds | other.seconds, run)

    def written(self, stamp: str) -> str:
        """As a file of its own, which holds as long as a stamp does."""
        names = set(self.seconds).union(*(which for lines in self.run.values() for which in lines.values()))
        number = {one: i for i, one in enumerate(sorted(names))}
        run = {
            module: {line: [number[one] for one in which] for line, which in lines.items()}
            for module, lines in self.run.items()
        }
        return json.dumps({"stamp": stamp, "names": list(number), "seconds": self.seconds, "run": run})


def read_recorded(kept: Path, stamp: str) -> Recorded | None:
    """What a file has kept; nothing where it is of another stamp. Raises RuntimeError for a file of something else."""
    try:
        data = json.loads(kept.read_bytes())
        told = data["stamp"]
    except (ValueError, KeyError, TypeError):
        raise RuntimeError(f"--recorded: {kept} is no record of lines: give another file, or remove it") from None
    if told != stamp:
        return None
    run = {
        module: {int(line): {data["names"][i] for i in which} for line, which in lines.items()}
        for module, lines in data["run"].items()
    }
    return Recorded(data["seconds"], run)


# --- What runs inside pytest ------------------------------------------------------------------------------------------

_seconds: dict[str, float] = {}


def _switch(context: str) -> None:
    import coverage

    if (measured := coverage.Coverage.current()) is not None:
        measured.switch_context(context)
        os.environ[ASKER] = context
        os.environ["COVERAGE_PROCESS_START"] = os.environ[HOW]


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Lines that run from here on are this test's, also those whose answers an earlier one has left behind."""
    _forget()
    _switch(item.nodeid)
    _seconds[item.nodeid] = perf_counter()


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: Any, request: Any) -> Iterator[None]:
    """What a file shares, all its tests run."""
    if fixturedef.scope == "function":
        return (yield)
    own = request._pyfuncitem.nodeid
    _switch(own.split("::")[0])
    try:
        return (yield)
    finally:
        _switch(own)


def pytest_runtest_teardown(item: pytest.Item) -> None:
    """How long it took."""
    _seconds[item.nodeid] = perf_counter() - _seconds[item.nodeid]


def pytest_sessionfinish() -> None:
    """Leave the times to whoever asked."""
    Path(os.environ[TOLD]).write_text(json.dumps(_seconds))


def _forget() -> None:
    """Empty what functions of the suite keep; those that compile keep theirs, and tests the runs that they share."""
    import functools

    for name, module in list(sys.modules.items()):
        if name.startswith("verify.") and name != COMPILER:
            for one in list(vars(module).values()):
                if isinstance(one, functools._lru_cache_wrapper):
                    one.cache_clear()


# --- Outside ----------------------------------------------------------------------------------------------------------


def run_pytest(
    tree: Path, words: Iterable[str], before: tuple[str, ...] = (), waited: float | None = None, **environment: str
) -> tuple[int, list[str]]:
    """How pytest ends in a tree, and what is red. Raises subprocess.TimeoutExpired, RuntimeError for no such test."""
    command = [sys.executable, "-m", *before, "pytest", "-q", "-p", "no:cacheprovider", *words]
    given = os.environ | ALONE | {GIVEN: "", "PYTHONPATH": str(tree)} | environment
    run = subprocess.run(command, cwd=tree, env=given, capture_output=True, text=True, timeout=waited, check=False)
    lines = [line for line in run.stdout.splitlines() if line.startswith(("FAILED ", "ERROR "))]
    lost = [line for line in run.stderr.splitlines() if line.startswith("ERROR: not found: ")]
    if lost and not lines:
        raise RuntimeError(f"{lost[0].split(': ', 2)[2]} is in no tree: give it a name that is the same in each")
    return run.returncode, [line.split(" ", 1)[1].split(" - ")[0] for line in lines]


def recorded(tree: Path, asked: Iterable[str], compiled: str) -> tuple[Recorded, list[str]]:
    """Run files or folders of gates or tests once: what ran what, and which are red."""
    import coverage

    with TemporaryDirectory() as folder:
        lines, told, how = Path(folder, "lines"), Path(folder, "seconds.json"), Path(folder, "how")
        how.write_text(CHILDREN.format(lines=lines, asker=ASKER))
        before = ("coverage", "run", f"--rcfile={how}", "-m")
        environment = {TOLD: str(told), "NUMBA_CACHE_DIR": compiled, ASKER: "", HOW: str(how)}
        status, red = run_pytest(tree, ("-p", __name__, *asked), before, **environment)
        if not told.exists():
            raise RuntimeError(f"pytest ends with {status} before any test")
        measured, run = coverage.Coverage(data_file=str(lines), config_file=False), dict[str, dict[int, set[str]]]()
        measured.combine([folder])
        data = measured.get_data()
        for file in data.measured_files():
            if Path(file).is_relative_to(tree):  # a process may be given another copy of the suite
                contexts = data.contexts_by_lineno(file)
                run[str(Path(file).relative_to(tree))] = {line: set(which) - {""} for line, which in contexts.items()}
        seconds = {one: took for one, took in json.loads(told.read_text()).items() if one not in red}
        return Recorded(seconds, run), red
