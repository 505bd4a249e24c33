"""Why some small faults are left unnoticed: they change nothing, or speed or a margin of safety alone."""

import tomllib
from pathlib import Path
from typing import NamedTuple

from benchmarks.fault_kinds import Fault

KEPT = Path(__file__).with_name("reasons.toml")
NOTHING = "nothing"
CHANGES = (NOTHING, "speed", "margin")
"""What such a fault changes: no figure and no refusal; how long a figure takes; how much safer than need be it is."""


class Reason(NamedTuple):
    """Why a fault may be left unnoticed."""

    changes: str
    why: str


Key = tuple[str, str, str, str]
"""Module, function, what stood there, what stands there now: lines move."""


def key_of(module: str, fault: Fault) -> Key:
    """By what a fault is known when lines have moved."""
    return module, fault.function, " ".join(fault.old.split()), " ".join(fault.new.split())


def kept_reasons(file: Path = KEPT) -> dict[Key, Reason]:
    """Those that are written down. Raises ValueError for one that says what a reason cannot."""
    found = dict[Key, Reason]()
    for one in tomllib.loads(file.read_text()).get("fault", []):
        if one["changes"] not in CHANGES:
            raise ValueError(f"{file.name}: changes = {one['changes']!r}: give one of {', '.join(CHANGES)}")
        key = one["module"], one["function"], one["old"], one["new"]
        found[key] = Reason(one["changes"], one["why"])
    return found
