"""How many small faults, drawn at random from the suite's own rooms, its packaged gates notice.

    python -m benchmarks.random_faults [ROOM ...] [--number 60] [--seed 1] [--kernels] [--jobs 2] [--json FILE]

A room is a folder of `verify` (default: the models, waves, contact, motion, chain and judge). Each fault changes one
expression of a copy of the package: a sign, an operator, a comparison, a constant by a thousandth, a refusal that is
dropped. First the lines that each gate runs are recorded; then each fault meets the gates that run its line, the
quickest first, until one is red. A fault in a kernel meets all, with nothing compiled before. What none notices is
listed: it changes no figure, or a gate is missing. Nothing in the checkout is written to.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections import Counter, defaultdict
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from queue import Queue
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import NamedTuple

from benchmarks.fault_kinds import Fault, drawn
from verify.files import write_whole

ROOMS = ("models", "segments", "elements", "exact", "judge", "contact", "waves", "chain", "motion")
GATES = "verify/scenes"
COMPILER = "verify.models.kernels"
TOLD = "GATES_SECONDS"
"""The variable of the environment that names the file to which times of gates go."""
ALONE = {"PYTEST_ADDOPTS": "", "OPENBLAS_NUM_THREADS": "1", "VERIFY_JOBS": "1", "PYTHONDONTWRITEBYTECODE": "1"}
WAITED = 90.0
"""Seconds beside thrice what its gates take, after which a fault is held for one that does not end: noticed."""


class Recorded(NamedTuple):
    """What the gates did without a fault."""

    seconds: dict[str, float]
    """By gate."""
    run: dict[str, dict[int, set[str]]]
    """Gates by module and line."""


class Met(NamedTuple):
    """A fault and what became of it."""

    module: str
    fault: Fault
    gate: str
    """The first that noticed it; empty where none did."""


# --- What runs inside pytest while lines are recorded -----------------------------------------------------------------

_seconds: dict[str, float] = {}


def pytest_runtest_setup(item: object) -> None:
    """Lines that run from here on are this gate's, also those whose answers an earlier gate has left behind."""
    import coverage

    _forget()
    measured = coverage.Coverage.current()
    if measured is not None:
        measured.switch_context(item.nodeid)  # type: ignore[attr-defined]
    _seconds[item.nodeid] = perf_counter()  # type: ignore[attr-defined]


def pytest_runtest_teardown(item: object) -> None:
    """How long it took."""
    _seconds[item.nodeid] = perf_counter() - _seconds[item.nodeid]  # type: ignore[attr-defined]


def pytest_sessionfinish() -> None:
    """Leave the times to whoever asked."""
    Path(os.environ[TOLD]).write_text(json.dumps(_seconds))


def _forget() -> None:
    """Empty what functions of the suite keep; those that compile keep theirs."""
    import functools
    import gc

    for one in gc.get_objects():
        own = isinstance(one, functools._lru_cache_wrapper) and one.__module__.startswith("verify.")
        if own and one.__module__ != COMPILER:
            one.cache_clear()


# --- Outside ----------------------------------------------------------------------------------------------------------


def _pytest(tree: Path, gates: Iterable[str], before: tuple[str, ...], waited: float | None, **environment: str) -> str:
    """The first gate that is red in a tree, or how pytest ends otherwise; empty where all hold."""
    words = [sys.executable, "-m", *before, "pytest", "-x", "-q", "-p", "no:cacheprovider", *gates]
    given = os.environ | ALONE | {"PYTHONPATH": str(tree)} | environment
    try:
        run = subprocess.run(words, cwd=tree, env=given, capture_output=True, text=True, timeout=waited, check=False)
    except subprocess.TimeoutExpired:
        return "does not end"
    red = [line.split()[1] for line in run.stdout.splitlines() if line.startswith(("FAILED ", "ERROR "))]
    return (*red, f"pytest ends with {run.returncode}")[0] if run.returncode else ""


def recorded(tree: Path, compiled: str) -> Recorded:
    """Run all gates once and keep which ran what. Raises RuntimeError where one is red."""
    import coverage

    with TemporaryDirectory() as folder:
        lines, told = Path(folder, "lines"), Path(folder, "seconds.json")
        before = ("coverage", "run", "--source=verify", f"--data-file={lines}", "-m")
        plugin = {TOLD: str(told), "NUMBA_CACHE_DIR": compiled}
        red = _pytest(tree, ("-p", "benchmarks.random_faults", GATES), before, None, **plugin)
        if red:
            raise RuntimeError(f"without a fault {red}: mend that first")
        data, run = coverage.CoverageData(basename=str(lines)), dict[str, dict[int, set[str]]]()
        data.read()
        for file in data.measured_files():
            contexts = data.contexts_by_lineno(file)
            run[str(Path(file).relative_to(tree))] = {line: set(gates) - {""} for line, gates in contexts.items()}
        return Recorded(json.loads(told.read_text()), run)


def meeting(module: str, fault: Fault, known: Recorded) -> list[str]:
    """The gates that run the lines of a fault, the quickest first; all of them for one in a kernel."""
    lines = known.run.get(module, {})
    if fault.in_kernel:
        gates = set(known.seconds)
    elif not fault.function:
        gates = set().union(*lines.values())
    else:
        gates = set().union(*(lines.get(line, set()) for line in range(fault.line, fault.last_line + 1)))
    return sorted(gates, key=lambda gate: (known.seconds[gate], gate))


def met(tree: Path, module: str, fault: Fault, known: Recorded, compiled: str) -> Met:
    """Plant a fault in a tree, see what gates say, and take it out again."""
    gates, place = meeting(module, fault, known), tree / module
    if not gates:
        return Met(module, fault, "")
    source = place.read_bytes()
    waited = WAITED + 3.0 * sum(known.seconds[gate] for gate in gates)
    try:
        place.write_bytes(fault.planted(source))
        with TemporaryDirectory() as empty:
            kept = empty if fault.in_kernel or "kernels" in module else compiled
            return Met(module, fault, _pytest(tree, gates, (), waited, NUMBA_CACHE_DIR=kept))
    finally:
        place.write_bytes(source)


def all_met(root: Path, faults: list[tuple[str, Fault]], jobs: int) -> list[Met]:
    """Each of them, on so many copies of a checkout at once; what is done is told on standard error."""
    trees: Queue[Path] = Queue()
    with TemporaryDirectory() as folder, TemporaryDirectory() as compiled:
        for number in range(jobs):
            tree = Path(folder, str(number))
            for part in ("verify", "benchmarks"):
                shutil.copytree(root / part, tree / part, ignore=shutil.ignore_patterns("__pycache__"))
            trees.put(tree)
        known = recorded(Path(folder, "0"), compiled)
        print(f"{len(known.seconds)} gates, {sum(known.seconds.values()):.0f} s", file=sys.stderr)

        def one(given: tuple[str, Fault]) -> Met:
            tree = trees.get()
            try:
                found = met(tree, *given, known, compiled)
            finally:
                trees.put(tree)
            print(_line(found), file=sys.stderr, flush=True)
            return found

        crew = ThreadPoolExecutor(jobs)
        try:
            return list(crew.map(one, faults))
        finally:
            crew.shutdown(cancel_futures=True)


def _line(found: Met) -> str:
    fault = found.fault
    old, new = (" ".join(text.split())[:50] for text in (fault.old, fault.new))
    return f"{found.gate or 'UNNOTICED':40s} {found.module}:{fault.line} {fault.function}: {old} -> {new}"


def table(found: list[Met]) -> str:
    """Noticed of all, by room and together, then what is left."""
    all_, noticed = Counter[str](), Counter[str]()
    left = defaultdict[str, list[str]](list)
    for one in found:
        room = one.module.split("/")[1]
        all_[room] += 1
        noticed[room] += bool(one.gate)
        if not one.gate:
            left[room].append(_line(one))
    rows = [f"{room:12s} {noticed[room]:4d} of {n:4d}" for room, n in sorted(all_.items())]
    n, total = noticed.total(), all_.total()
    share = f"{n / total:.1%}, scatter {(n * (total - n) / total**3) ** 0.5:.1%}" if total else ""
    return "\n".join(
        [*rows, f"{'together':12s} {n:4d} of {total:4d}  {share}", *(line for r in left.values() for line in r)]
    )


def main() -> None:
    """Read the command line, draw, plant, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rooms", nargs="*", default=ROOMS, metavar="ROOM")
    parser.add_argument("--number", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--kernels", action="store_true", help="faults in compiled functions, and in these alone")
    parser.add_argument("--json", type=Path, help="a file for what became of each")
    asked = parser.parse_args()
    root = Path(__file__).resolve().parents[1]
    for room in asked.rooms:
        if not (root / "verify" / room).is_dir():
            parser.error(f"{room} is no folder of verify: give one of {', '.join(ROOMS)} or another")
    for name in ("number", "jobs"):
        if getattr(asked, name) < 1:
            parser.error(f"--{name} = {getattr(asked, name)}: give at least 1")
    files = [file for room in asked.rooms for file in (root / "verify" / room).glob("*.py")]
    sources = {str(file.relative_to(root)): file.read_bytes() for file in files if file.name != "__init__.py"}
    try:
        found = all_met(root, drawn(sources, asked.number, asked.seed, asked.kernels), asked.jobs)
    except RuntimeError as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted: nothing is written")
    if asked.json:
        rows = [{"module": one.module, "gate": one.gate, **vars(one.fault)} for one in found]
        write_whole(asked.json, json.dumps(rows, indent=1), "--json")
    print(table(found))


if __name__ == "__main__":
    main()
