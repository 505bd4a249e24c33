"""What a command line does, counted from outside: a process of its own, in which every call of Python is seen."""

import json
import os
import subprocess
import sys

from msgspec import Struct, convert

WORK = {
    "solves": {("judge/workbench.py", "_solve")},
    "timed": {("timing.py", "_seconds")},
    "eigen-solves": {("models/eigen.py", "lowest")},
    "factorisations": {("models/pencil.py", "factorised"), ("models/banded.py", "solve")},
    "exact roots": {("exact/modes.py", "exact_frequency_hz")},
    "fields": {(f"{room}.py", "solve_harmonic") for room in ("elements/linear", "segments/linear", "exact/harmonic")},
    "time bases": {(f"{room}/in_time.py", "time_basis") for room in ("elements", "segments", "exact")},
    "contact": {("motion/stepping.py", "_run_stage"), ("motion/stepping.py", "window"), ("chain/ride.py", "ride")},
    "simulations": {("motion/simulate.py", "simulate")},
    "held sliders": {("motor/figures.py", "_held")},
    "free runs of motors": {("motor/figures.py", "_timed")},
    "broken engines": {("peers/breaking.py", "pushed")},
    "chain equilibria": {("chain/statics.py", "solve_static"), ("chain/load_path.py", "_followed")},
    "chain motions": {("chain/stepping.py", "simulate"), ("chain/stretching.py", "simulate")},
    "charts": {("", "charts")},
    "pages": {("report/html.py", "rendered")},
    "files": {("files.py", "write_whole"), ("files.py", "write_folder"), ("files.py", "writable_folder")},
    "compilations": {("core/dispatcher.py", "_compile_core"), ("core/dispatcher.py", "compile")},
}
"""What is counted, by the functions that do it: the end of their file's path, and their name."""
_INSIDE = """
import collections, contextlib, io, json, sys
from verify.cli import status_of
seen = collections.Counter()
def note(frame, event, argument):
    if event == "call":
        code = frame.f_code
        if "/verify/" in code.co_filename or code.co_filename.endswith("core/dispatcher.py"):
            seen[code.co_filename, code.co_name] += 1
out, before = io.StringIO(), set(sys.modules)
with contextlib.redirect_stdout(out):
    sys.setprofile(note)
    status = status_of(sys.argv[1:])
    sys.setprofile(None)
calls = [[file.replace("\\\\", "/"), name, times] for (file, name), times in seen.items()]
print(json.dumps({"status": status, "out": out.getvalue(), "modules": sorted(sys.modules), "calls": calls}))
"""


class Counted(Struct):
    """What one command line did."""

    status: int
    out: str
    modules: set[str]
    calls: list[tuple[str, str, int]]

    def times(self, work):
        """How often."""
        wanted = WORK[work]
        return sum(n for file, name, n in self.calls if any(file.endswith(end) and name == one for end, one in wanted))

    @property
    def work(self):
        """All that was done at all."""
        return {name: times for name in WORK if (times := self.times(name))}

    @property
    def libraries(self):
        """Top-level modules."""
        return {name.partition(".")[0] for name in self.modules}

    @property
    def rooms(self):
        """Rooms of the suite that were entered."""
        return {name.split(".")[1] for name in self.modules if name.startswith("verify.") and name.count(".") > 1}

    @property
    def told(self):
        """Its JSON."""
        return json.loads(self.out)


def counted(folder, *words):
    """Run a command line in a folder."""
    env = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    done = subprocess.run(
        [sys.executable, "-c", _INSIDE, *words], cwd=folder, env=env, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return convert(json.loads(done.stdout), Counted)
