"""Commands as processes of their own, begun where and as they are not meant to be."""

import os
import subprocess
import sys

SMALL = ("run", "mine.toml")
SCENE = """
name = "mine"
title = "A strip"
beam = { length = 0.61, width = 0.03, thickness = 0.002, youngs_modulus = 71e9, density = 2710.0 }
[[gate]]
id = "second"
quantity = "mode.frequency"
arguments = { model = "analytic", mode = 2 }
expect = 49.90041
within = 1e-3
why = "2 pi sqrt(E h^2 / 12 rho) / L^2."
"""
"""A scene that takes no time, its report a page without charts."""
RUNS = [sys.executable, "-m", "verify"]


def shell(line, folder, **environment):
    """A line of sh in a folder, with $V for verify: (status, standard output, error output)."""
    env = os.environ | {"V": " ".join(RUNS), "PYTHONPATH": os.pathsep.join(sys.path)} | environment
    done = subprocess.run(["bash", "-c", line], cwd=folder, env=env, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout, done.stderr


def started(words, folder, *, start_new_session=False, **environment):
    """A command that goes on by itself, in a session of its own where its processes are counted."""
    env = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)} | environment
    how = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "start_new_session": start_new_session}
    return subprocess.Popen([*RUNS, *words], cwd=folder, env=env, **how)


def whole(path):
    """Whether a report is all there."""
    return path.read_bytes().rstrip().endswith(b"</html>")
