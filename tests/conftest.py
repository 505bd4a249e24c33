"""Beams that no test value is symmetric in, and a way to plant faults."""

import os
import signal
import sys
from functools import lru_cache

import packaged
import pytest
from hypothesis import HealthCheck, settings

from verify.beam import Beam
from verify.cli import status_of

pytest_plugins = ["pytester"]

for library in (
    "OPENBLAS",
    "MKL",
    "OMP",
):  # as the command line has it: matrices are small, and workers share the cores
    os.environ.setdefault(f"{library}_NUM_THREADS", "1")
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # as of a shell's job in the background, which children inherit
    signal.signal(signal.SIGINT, signal.default_int_handler)
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # a thousand command lines would each read all sources anew

settings.register_profile("any machine", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("any machine")  # how long drawing takes is the machine's own affair

KEEPERS = ("verify.elements.linear", "verify.segments.linear", "verify.exact.", "verify.motor.repeated")
"""Modules that keep what they solved for the next who asks: a fault planted below would not be seen."""
READERS = ("verify.field_docs", "verify.registry", "verify.scenes", "verify.models.kernels", "verify.pictures")
"""Modules that keep what they read in files, which no planted fault is in."""


@lru_cache(maxsize=2)
def clears(kept, n_modules):
    """What makes every module so named forget, as long as no module is added."""
    modules = [module for name, module in list(sys.modules.items()) if name.startswith(kept)]
    values = [value for module in modules if not module.__name__.startswith(READERS) for value in vars(module).values()]
    return [value.cache_clear for value in values if hasattr(value, "cache_clear")]


def forget(kept):
    for clear in clears(kept, len(sys.modules)):
        clear()


@pytest.fixture(scope="session", autouse=True)
def runs_are_shared(tmp_path_factory):
    """Among the workers of a session."""
    if "PYTEST_XDIST_WORKER" in os.environ:
        packaged.SHARED = tmp_path_factory.getbasetemp().parent / "packaged"
        packaged.SHARED.mkdir(exist_ok=True)


@pytest.fixture(autouse=True)
def nothing_kept():
    forget(KEEPERS)


@pytest.fixture
def monkeypatch(monkeypatch):
    """Of which no module keeps what it worked out under a fault, or sees less of one for what it kept before."""
    forget("verify.")
    yield monkeypatch
    monkeypatch.undo()
    forget("verify.")


@pytest.fixture
def paper_beam():
    return Beam(length=0.5, width=0.02, thickness=0.001, youngs_modulus=70e9, density=2700.0)


@pytest.fixture
def titanium_strip():
    return Beam(length=0.73, width=0.031, thickness=0.0023, youngs_modulus=113e9, density=4470.0)


@pytest.fixture
def verify(capsys, tmp_path, monkeypatch):
    """Run a command line in an empty folder: (status, standard output, error output)."""
    monkeypatch.chdir(tmp_path)

    def call(*words):
        capsys.readouterr()
        status = status_of([str(word) for word in words])
        out, err = capsys.readouterr()
        return status, out, err

    return call
