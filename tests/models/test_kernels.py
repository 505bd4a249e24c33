"""What numba keeps on disk is used again, and is thrown away when a kernel that it was made of is edited."""

import os
import subprocess
import sys

import pytest

OURS = "from verify.models.kernels import compiled\nfrom inner_{kind} import *\n\n@compiled()"
NUMBAS = "from numba import njit\nfrom inner_{kind} import *\n\n@njit(cache=True)"
INNER = {
    "kernels": "from verify.models.kernels import compiled\n\n@compiled()\ndef weight(mass):\n    return 9.81 * mass\n",
    "records": "from typing import NamedTuple\n\nclass Rod(NamedTuple):\n    mass: float\n    length: float\n",
}
OUTER = {
    "kernels": "def outer(x):\n    return weight(x) + 0.5\n\nfound = outer(1.7)\n",
    "records": "def outer(rod):\n    return rod.mass\n\nfound = outer(Rod(mass=1.7, length=0.23))\n",
}
EDITS = {"kernels": ("9.81", "1.62"), "records": ("mass: float\n    length", "length: float\n    mass")}
TRUE = {"kernels": (9.81 * 1.7 + 0.5, 1.62 * 1.7 + 0.5), "records": (1.7, 1.7)}


def outcome(room):
    """(what the outer kernel gives, how often it came from disk) in a process of its own."""
    code = "from outer_kernels import found, outer; print(found, sum(outer.stats.cache_hits.values()))"
    path = os.pathsep.join([str(room), *sys.path])
    environment = {**os.environ, "NUMBA_CACHE_DIR": str(room / "kept"), "PYTHONPATH": path}
    done = subprocess.run(
        [sys.executable, "-B", "-c", code], capture_output=True, text=True, check=True, env=environment, cwd=room
    )
    found, hits = done.stdout.split()
    return float(found), int(hits)


@pytest.mark.parametrize("kind", INNER)
@pytest.mark.parametrize("made", [OURS, NUMBAS], ids=["this suite's stamp", "numba's own"])
def test_an_edit_in_an_imported_kernel_is_seen(tmp_path, kind, made):
    inner = tmp_path / f"inner_{kind}.py"
    inner.write_text(INNER[kind], "utf-8")
    (tmp_path / "outer_kernels.py").write_text(f"{made.format(kind=kind)}\n{OUTER[kind]}", "utf-8")
    before, after = TRUE[kind]
    assert outcome(tmp_path) == (pytest.approx(before), 0)
    assert outcome(tmp_path) == (pytest.approx(before), 1)  # kept
    inner.write_text(INNER[kind].replace(*EDITS[kind]), "utf-8")
    if made is OURS:
        assert outcome(tmp_path) == (pytest.approx(after), 0)
    else:  # what the stamp is for: numba goes on with the old kernel, or reads a field in the place of another
        assert outcome(tmp_path) != (pytest.approx(after), 0)


def test_where_numba_keeps_no_stamp_nothing_is_kept(monkeypatch):
    from numba.core import caching

    from verify.models.kernels import compiled

    class Unstamped:
        def __init__(self, *given, **more):
            pass

    monkeypatch.setattr(caching, "IndexDataCacheFile", Unstamped)

    @compiled()
    def twice(x):
        return 2.0 * x

    assert twice(1.7) == 3.4
    assert not twice.stats.cache_path
