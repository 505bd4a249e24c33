"""How many small faults, drawn at random from the suite's own rooms, its packaged gates notice.

    python -m benchmarks.random_faults [ROOM ...] [--number 60] [--seed 1] [--kernels | --no-kernels]
                                       [--tests FILE ...] [--recorded FILE] [--jobs 2] [--json FILE]

A room is a folder of `verify` (default: the models, waves, contact, motion, chain and judge). Each fault changes one
expression of a copy of the package: a sign, an operator, a comparison, a constant by a thousandth, a refusal that is
dropped. First the lines that each gate runs are recorded; then each fault meets the gates that run its line, one in a
kernel those that run a line from which it is called, the quickest first, until one is red; then the tests that do, if
any are asked. What none notices is listed: a gate is missing, or `reasons.toml` says why none is. What changes nothing,
by that file, is left out of the score. Nothing in the checkout is written to.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from queue import Queue
from tempfile import TemporaryDirectory
from typing import NamedTuple

from benchmarks.fault_kinds import Fault, drawn
from benchmarks.kernel_callers import Line, Name, callers
from benchmarks.reasons import KEPT, NOTHING, Key, Reason, kept_reasons, key_of
from benchmarks.recorded_lines import Recorded, read_recorded, recorded, run_pytest
from verify.files import write_whole

ROOMS = ("models", "segments", "elements", "exact", "judge", "contact", "waves", "chain", "motion")
GATES = "verify/scene/data"
ROOT = Path(__file__).resolve().parents[1]
LEFT = shutil.ignore_patterns(".git", ".*_cache", ".hypothesis", "__pycache__", "*.egg-info")
"""What a copy of a checkout does without."""
WAITED = 90.0
"""Seconds beside thrice what its gates take, after which a fault is held for one that does not end: noticed."""
MOST = 400.0
"""Seconds of tests that a fault meets at most: what none of these notices is told as unnoticed."""


class Met(NamedTuple):
    """A fault and what became of it."""

    module: str
    fault: Fault
    gate: str
    """The first gate that noticed it; empty where none did."""
    test: str = ""
    """The first test that noticed what no gate did; empty where none did or was asked."""


class Known(NamedTuple):
    """What is known before a fault is planted."""

    recorded: Recorded
    callers: dict[Name, set[Line]]


def _runs(module: str, fault: Fault, known: Known) -> set[str]:
    """What runs the lines of a fault: in a kernel, where it is called; at import, the module."""
    if fault.in_kernel:
        return known.recorded.running(known.callers.get((module, fault.function.split(".")[0]), ()))
    lines = (0,) if fault.at_import else range(fault.line, fault.last_line + 1)
    return known.recorded.running((module, line) for line in lines)


def meeting(module: str, fault: Fault, known: Known) -> tuple[list[str], list[str]]:
    """The gates that run the lines of a fault, and the tests that do as far as `MOST` goes; the quickest first."""
    seconds = known.recorded.seconds
    ordered = sorted(_runs(module, fault, known), key=lambda one: (seconds[one], one))
    tests, left = list[str](), MOST
    for one in ordered:
        left -= 0.0 if one.startswith(GATES) else seconds[one]
        if left >= 0.0 and not one.startswith(GATES):
            tests.append(one)
    return [one for one in ordered if one.startswith(GATES)], tests


def _noticed(tree: Path, which: list[str], known: Known, compiled: str) -> str:
    """The first of these that is red in a tree, or how pytest ends otherwise; empty where all hold."""
    if not which:
        return ""
    waited = WAITED + 3.0 * sum(known.recorded.seconds[one] for one in which)
    try:
        status, red = run_pytest(tree, ("-x", *which), waited=waited, NUMBA_CACHE_DIR=compiled)
    except subprocess.TimeoutExpired:
        return "does not end"
    return (*red, f"pytest ends with {status}")[0] if status else ""


def met(tree: Path, module: str, fault: Fault, known: Known, compiled: str) -> Met:
    """Plant a fault in a tree, see what gates say, then tests, and take it out again."""
    gates, tests = meeting(module, fault, known)
    place = tree / module
    source = place.read_bytes()
    try:
        place.write_bytes(fault.planted(source))
        with TemporaryDirectory() as empty:
            kept = empty if fault.in_kernel or "kernels" in module else compiled
            gate = _noticed(tree, gates, known, kept)
            return Met(module, fault, gate, "" if gate else _noticed(tree, tests, known, kept))
    finally:
        place.write_bytes(source)


def _recorded(trees: list[Path], tests: list[str], compiled: str) -> Recorded:
    """What gates and tests run, on all copies at once. Raises RuntimeError where a gate is red."""
    files = [str(file.relative_to(trees[0])) for one in tests for file in _files(trees[0] / one)]
    parts = [(GATES, *files[:: len(trees)]), *(files[i :: len(trees)] for i in range(1, len(trees)))]
    with ThreadPoolExecutor(len(trees)) as crew:
        found = list(
            crew.map(
                lambda given: recorded(given[0], given[1], compiled) if given[1] else None,
                zip(trees, parts, strict=True),
            )
        )
    known, red = Recorded({}, {}), list[str]()
    for one in filter(None, found):
        known, red = known.beside(one[0]), red + one[1]
    if gates := [one for one in red if one.startswith(GATES)]:
        raise RuntimeError(f"without a fault {gates[0]} is red: mend that first")
    for one in red:
        print(f"red without a fault, and left out: {one}", file=sys.stderr)
    return known


def _files(place: Path) -> list[Path]:
    return sorted(place.rglob("test_*.py")) if place.is_dir() else [place]


def _stamp(root: Path, tests: list[str]) -> str:
    """That of sources, gates and all files beside tests, and of which tests are asked."""
    files = [
        file for part in ("verify", "tests") for kind in ("py", "toml") for file in (root / part).rglob(f"*.{kind}")
    ]
    told = [str(file.relative_to(root)).encode() + b"\n" + file.read_bytes() for file in sorted(files)]
    return sha256(b"\0".join([*told, *(one.encode() for one in tests)])).hexdigest()


def _known(root: Path, trees: list[Path], tests: list[str], compiled: str, kept: Path | None) -> Known:
    """What runs what, from a file that keeps it for these sources and tests, or by running them."""
    sources = {str(file.relative_to(root)): file.read_bytes() for file in (root / "verify").rglob("*.py")}
    stamp = _stamp(root, tests)
    if kept and kept.exists() and (found := read_recorded(kept, stamp)):
        return Known(found, callers(sources))
    found = _recorded(trees, tests, compiled)
    if kept:
        write_whole(kept, found.written(stamp), "--recorded")
    return Known(found, callers(sources))


def all_met(
    root: Path, faults: list[tuple[str, Fault]], tests: list[str], jobs: int, kept: Path | None = None
) -> list[Met]:
    """Each of them, on so many copies of a checkout at once; what is done is told on standard error."""
    with TemporaryDirectory() as folder, TemporaryDirectory() as compiled:
        trees = [Path(folder, str(number)) for number in range(jobs)]
        for tree in trees:
            shutil.copytree(root, tree, ignore=LEFT)
        known = _known(root, trees, tests, compiled, kept)
        seconds = known.recorded.seconds.values()
        print(f"{len(seconds)} gates and tests, {sum(seconds):.0f} s", file=sys.stderr)
        free: Queue[Path] = Queue()
        for tree in trees:
            free.put(tree)

        def one(given: tuple[str, Fault]) -> Met:
            tree = free.get()
            try:
                found = met(tree, *given, known, compiled)
            finally:
                free.put(tree)
            print(_line(found), file=sys.stderr, flush=True)
            return found

        crew = ThreadPoolExecutor(jobs)
        try:
            return list(crew.map(one, faults))
        finally:
            crew.shutdown(cancel_futures=True)


def _line(found: Met, reasons: dict[Key, Reason] | None = None) -> str:
    fault = found.fault
    old, new = (" ".join(text.split())[:50] for text in (fault.old, fault.new))
    by = found.gate or found.test or "UNNOTICED"
    why = (reasons or {}).get(key_of(found.module, fault))
    told = f"  ({why.changes}: {why.why})" if why else ""
    return f"{by:40s} {found.module}:{fault.line} {fault.function}: {old} -> {new}{told}"


def _share(name: str, n: int, total: int) -> str:
    """So many of all, and by how much a draw of that size scatters."""
    return f"{name:20s} {n:4d} of {total:4d}  {n / total:.1%}, scatter {(n * (total - n) / total**3) ** 0.5:.1%}"


def table(found: list[Met], tests: bool, reasons: dict[Key, Reason]) -> str:
    """Noticed of all by gates, by room and together, and by tests too where they were asked; then what is left.

    All: what is noticed, and what is not unless a reason says that it changes nothing.
    """
    none = {id(one) for one in found if not (one.gate or one.test) and _changes(one, reasons) == NOTHING}
    counted = [one for one in found if id(one) not in none]
    rooms, noticed = Counter(map(_room, counted)), Counter(_room(one) for one in counted if one.gate)
    rows = [f"{room:20s} {noticed[room]:4d} of {n:4d}" for room, n in sorted(rooms.items())]
    for kind, own in (("kernels", True), ("other functions", False)):
        of_kind = [one for one in counted if one.fault.in_kernel == own]
        rows += [_share(kind, sum(bool(one.gate) for one in of_kind), len(of_kind))] if of_kind else []
    if counted:
        rows.append(_share("together", noticed.total(), len(counted)))
    if counted and tests:
        rows.append(_share("by gates or tests", sum(bool(one.gate or one.test) for one in counted), len(counted)))
    rows.append(f"{len(none)} more change nothing, as benchmarks/{KEPT.name} says")
    left = sorted((one for one in found if not one.gate), key=_room)
    return "\n".join([*rows, *(_line(one, reasons) for one in left)])


def _room(one: Met) -> str:
    return one.module.split("/")[1]


def _changes(one: Met, reasons: dict[Key, Reason]) -> str:
    why = reasons.get(key_of(one.module, one.fault))
    return why.changes if why else ""


def _asked() -> argparse.Namespace:
    """What the command line asks."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rooms", nargs="*", default=ROOMS, metavar="ROOM")
    parser.add_argument("--number", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument(
        "--kernels", action=argparse.BooleanOptionalAction, help="faults in compiled functions alone, or in none"
    )
    parser.add_argument(
        "--tests", nargs="+", default=[], metavar="FILE", help="files or folders of tests for what no gate sees"
    )
    parser.add_argument("--recorded", type=Path, help="a file that keeps which gate and test runs which line")
    parser.add_argument("--json", type=Path, help="a file for what became of each")
    asked = parser.parse_args()
    for room in asked.rooms:
        if not (ROOT / "verify" / room).is_dir():
            parser.error(f"{room} is no folder of verify: give one of {', '.join(ROOMS)} or another")
    for one in asked.tests:
        if not (ROOT / one).exists() or not (ROOT / one).resolve().is_relative_to(ROOT / "tests"):
            parser.error(f"--tests: {one} is no file or folder of tests/ (from where the checkout lies)")
    for name in ("number", "jobs"):
        if getattr(asked, name) < 1:
            parser.error(f"--{name} = {getattr(asked, name)}: give at least 1")
    return asked


def main() -> None:
    """Read the command line, draw, plant, tell."""
    asked = _asked()
    files = [file for room in asked.rooms for file in (ROOT / "verify" / room).glob("*.py")]
    sources = {str(file.relative_to(ROOT)): file.read_bytes() for file in files if file.name != "__init__.py"}
    try:
        faults = drawn(sources, asked.number, asked.seed, asked.kernels)
        found = all_met(ROOT, faults, asked.tests, asked.jobs, asked.recorded)
    except RuntimeError as error:
        sys.exit(str(error))
    except KeyboardInterrupt:
        sys.exit("interrupted: nothing is written")
    if asked.json:
        rows = [{"module": one.module, "gate": one.gate, "test": one.test, **vars(one.fault)} for one in found]
        write_whole(asked.json, json.dumps(rows, indent=1), "--json")
    print(table(found, bool(asked.tests), kept_reasons()))


if __name__ == "__main__":
    main()
