"""On what a bench was run, without a name or a path of it."""

import os
import platform
import sys
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path

PACKAGES = ("fem-segment-verify", "numpy", "scipy", "scikit-fem", "numba")


def today() -> str:
    """The date, UTC."""
    return datetime.now(UTC).date().isoformat()


def machine() -> dict[str, str]:
    """Processor, how many of them, system."""
    return {
        "processor": _processor(),
        "cores": f"{_cores()} cores",
        "system": f"{platform.system()} {platform.machine()}",
    }


def _cores() -> int | None:
    """That this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count()


def _processor() -> str:
    """Its name as the system has it."""
    listed = Path("/proc/cpuinfo")
    lines = listed.read_text("utf-8", "replace").splitlines() if listed.is_file() else []
    names = (line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    return next(names, "") or platform.processor() or platform.machine()


def load() -> float | None:
    """Processes that ran or waited, mean of the last minute, over the cores there are; None where nobody counts."""
    if not hasattr(os, "getloadavg"):
        return None
    try:
        return float(f"{os.getloadavg()[0] / (_cores() or 1):.2g}")
    except OSError:
        return None


def versions() -> dict[str, str]:
    """Of Python, this package and what it computes with."""
    return {"Python": platform.python_version()} | {name: metadata.version(name) for name in PACKAGES}
