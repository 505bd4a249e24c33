"""The faults that were drawn on an older checkout, planted again where the same expression still stands.

    python -m benchmarks.same_faults OLD_CHECKOUT --seeds 101 102 103 104 105 [--number 150] [--tests FILE ...]
                                     [--recorded FILE] [--jobs 2] [--json FILE]

A fault is the same where function, kind, old and new text agree: in its own module, else in exactly one other. The rest
is code that is gone. The score is told by room, as `random_faults` tells it.
"""

import argparse
import json
from collections import Counter, defaultdict
from pathlib import Path

from benchmarks.fault_kinds import Fault, drawn, faults_of
from benchmarks.random_faults import ROOT, all_met, table
from verify.files import write_whole

ROOMS = ("models", "segments", "elements", "exact", "judge", "contact", "waves", "chain", "motion", "motor")


def sources_of(root: Path) -> dict[str, bytes]:
    """The modules of the numerical rooms, by path."""
    files = [file for room in ROOMS for file in (root / "verify" / room).glob("*.py") if file.name != "__init__.py"]
    return {str(file.relative_to(root)): file.read_bytes() for file in files}


def key_of(fault: Fault) -> tuple[str, str, str, str]:
    """What makes two faults the same."""
    return fault.function.rpartition(".")[2], fault.kind, fault.old, fault.new


def again(old: list[tuple[str, Fault]], now: dict[str, bytes]) -> tuple[list[tuple[str, Fault]], Counter[str]]:
    """(faults in today's sources, number by room of those whose code is gone)."""
    places: dict[tuple[str, str, str, str], list[tuple[str, Fault]]] = defaultdict(list)
    for module, source in now.items():
        for fault in faults_of(source):
            places[key_of(fault)].append((module, fault))
    found, gone = [], Counter[str]()
    for module, fault in old:
        same = [one for one in places[key_of(fault)] if one[0] == module]
        others = places[key_of(fault)]
        if same:
            found.append(min(same, key=lambda one: abs(one[1].line - fault.line)))
        elif len(others) == 1:
            found.append(others[0])
        else:
            gone[module.split("/")[1]] += 1
    return found, gone


def main() -> None:
    """Read the command line, draw, map, plant, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("--seeds", type=int, nargs="+", required=True)
    parser.add_argument("--number", type=int, default=150)
    parser.add_argument("--tests", nargs="+", default=[])
    parser.add_argument("--recorded", type=Path)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--json", type=Path)
    asked = parser.parse_args()
    before = sources_of(asked.old)
    faults = [fault for seed in asked.seeds for fault in drawn(before, asked.number, seed, None)]
    planted, gone = again(faults, sources_of(ROOT))
    print(f"{len(faults)} drawn, {len(planted)} planted again; code gone: {dict(gone)}")
    found = all_met(ROOT, planted, asked.tests, asked.jobs, asked.recorded)
    if asked.json:
        rows = [{"module": one.module, "gate": one.gate, "test": one.test, **vars(one.fault)} for one in found]
        write_whole(asked.json, json.dumps(rows, indent=1), "--json")
    print(table(found, bool(asked.tests), {}))


if __name__ == "__main__":
    main()
