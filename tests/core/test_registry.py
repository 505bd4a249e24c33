"""Registries with members of other packages, and work shared among processes."""

from types import SimpleNamespace

import pytest

from verify.errors import InputError
from verify.parallel import map_processes
from verify.registry import Registry

NEAR, FAR = SimpleNamespace(name="near"), SimpleNamespace(name="far")


@pytest.fixture
def models(tmp_path, monkeypatch):
    """A registry with one member of its own, beside a package that declares a usable member and a broken one."""
    info = tmp_path / "toys-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: toys\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text("[toys.models]\nfar = toys:FAR\nlost = no_such_module:LOST\n")
    (tmp_path / "toys.py").write_text("from types import SimpleNamespace\nFAR = SimpleNamespace(name='far')\n")
    monkeypatch.syspath_prepend(tmp_path)
    return Registry("model", "toys.models", members=[NEAR])


def test_broken_entry_points_are_left_out(models):
    assert "lost" not in models
    with pytest.raises(InputError, match=r"'lost' of toys, no_such_module:LOST, cannot be used .*No module named"):
        models.named("lost")
    with pytest.raises(InputError, match=r"'nea' is not known: .*near"):
        models.named("nea")


def test_a_registered_member_replaces_the_one_of_its_name(models):
    other = SimpleNamespace(name="near")
    assert models.register(other) is other
    assert models["near"] is other
    with pytest.raises(InputError, match="has no name"):
        models.register(SimpleNamespace())


def _cube(x):
    if x == 7:
        raise InputError("x = 7")
    return x**3


@pytest.mark.parametrize("workers", [1, 3])
def test_parallel_results_keep_their_order(workers):
    done = []
    assert map_processes(_cube, range(6), done.append, workers) == [0, 1, 8, 27, 64, 125]
    assert sorted(done) == [0, 1, 2, 3, 4, 5]
    with pytest.raises(InputError, match="x = 7"):
        map_processes(_cube, range(3, 12), max_workers=workers)


def test_number_of_processes_is_checked(monkeypatch):
    monkeypatch.setenv("VERIFY_JOBS", "two")
    with pytest.raises(InputError, match="VERIFY_JOBS = 'two': give a whole number"):
        map_processes(_cube, range(3))
