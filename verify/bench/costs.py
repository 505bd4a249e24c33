"""What a process pays once: imports, and compiling with nothing kept on disk. Each in a process of its own."""

import json
import os
import subprocess
import sys
from statistics import median
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import msgspec

from verify.bench.request import Bench
from verify.bench.rows import ChildCost
from verify.bench.sets import SETS, all_cases
from verify.errors import InputError

if TYPE_CHECKING:
    from verify.scenes.scene import Scene

ROUNDS = 3
SPENT = "import sys, time; sys.stdout.write(str(time.process_time()))"
"""What a process says at its end: seconds of the processor since it began."""
LIBRARIES, ELEMENTS, COMPILER = ("numpy", "scipy.sparse.linalg"), "verify.elements.element", "numba"
"""What all sets import; what is imported, scikit-fem with it, for finite elements; and where loops are compiled."""
PATIENCE_S = 600.0
"""Of one process."""


def import_costs(sets: tuple[str, ...]) -> list[ChildCost]:
    """Seconds of a bare interpreter, and of each library in one, medians of interleaved rounds. Raises InputError."""
    wanted = [*LIBRARIES, *[ELEMENTS] * any(SETS[name].elements for name in sets)]
    wanted += [COMPILER] * any(SETS[name].compiled for name in sets)
    jobs = {"a bare interpreter": "pass", "import verify.cli": "import verify.cli"}
    jobs |= {f"import {name}": f"import {name}" for name in wanted}
    rounds: dict[str, list[float]] = {name: [] for name in jobs}
    for _ in range(ROUNDS):
        for name, code in jobs.items():
            rounds[name].append(float(_child(f"{code}\n{SPENT}", {})))
    return [ChildCost(name, median(times)) for name, times in rounds.items()]


def compile_costs(scene: "Scene", sets: tuple[str, ...]) -> dict[tuple[str, str], float]:
    """Seconds of compiling by set and method, in the order in which they are called. Raises InputError."""
    found: dict[tuple[str, str], float] = {}
    text = msgspec.json.encode(scene).decode()
    for name in (one for one in sets if SETS[one].compiled):
        with TemporaryDirectory() as empty:
            out = _child(f"from verify.bench.costs import tell\ntell({name!r})", {"NUMBA_CACHE_DIR": empty}, text)
        found |= {(name, method): seconds for method, seconds in json.loads(out).items()}
    return found


def _child(code: str, environment: dict[str, str], given: str = "") -> str:
    """What a process of its own wrote. Raises InputError where it did not end well."""
    path = os.pathsep.join(entry for entry in sys.path if entry)
    done = subprocess.run(
        [sys.executable, "-c", code],
        input=given,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
        env={**os.environ, "PYTHONPATH": path, **environment},
    )
    if done.returncode:
        last = (done.stderr.strip().splitlines() or ["no word"])[-1]
        raise InputError(f"bench: a process that times imports or compiling ended with {last}: leave it out")
    return done.stdout


def tell(name: str) -> None:
    """In such a process: what each method's coarsest entry compiles, imports aside, as JSON on standard output."""
    from verify.judge.workbench import Workbench
    from verify.models.compiling import compiled
    from verify.scenes.checked import checked
    from verify.scenes.scene import scene_type

    scene = checked(json.loads(sys.stdin.read()), scene_type())
    cases, *_ = all_cases(Bench(sets=(name,), peers=False), scene, Workbench(scene.beam))  # type: ignore[arg-type]
    found: dict[str, float] = {}
    for entry in (entry for case in cases for entry in case.entries):
        if entry.line.name not in found:
            before = len(compiled)
            entry.prepare()()
            found[entry.line.name] = sum(one.seconds for one in compiled[before:])
    sys.stdout.write(json.dumps({name: seconds for name, seconds in found.items() if seconds}))
