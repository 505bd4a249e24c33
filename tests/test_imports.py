"""What may import what: the models stay independent, and a command pays only for what it uses."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "verify"
MODELS = {"exact", "elements", "segments"}
NUMERICS = MODELS | {"problem", "linear", "waves", "dynamics", "chain", "motor", "control", "analysis", "cases"}
DOORS = {"scene", "quantities", "studies", "report", "io", "commands", "compare", "bench", "engines", "stress", "cli"}


def imported_rooms(path):
    """Second part of every `verify.x` that a module imports, types included."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("verify."):
            yield node.module.split(".")[1]
        elif isinstance(node, ast.Import):
            yield from (alias.name.split(".")[1] for alias in node.names if alias.name.startswith("verify."))


@pytest.mark.parametrize("room", sorted(MODELS))
def test_models_never_import_each_other(room):
    for path in (PACKAGE / room).rglob("*.py"):
        assert not set(imported_rooms(path)) & (MODELS - {room}), path


@pytest.mark.parametrize("room", sorted(NUMERICS))
def test_numerics_know_nothing_of_scenes_and_reports(room):
    for path in (PACKAGE / room).rglob("*.py"):
        assert not set(imported_rooms(path)) & DOORS, path


@pytest.mark.parametrize(
    ("words", "unloaded"),
    [
        (["--help"], {"numpy", "scipy", "numba", "matplotlib", "skfem", "rich"}),
        (["measure", "paper", "mode.frequency", "model=analytic", "mode=3"], {"numba", "matplotlib", "skfem"}),
        (["scenes"], {"scipy", "numba", "matplotlib", "skfem"}),
    ],
)
def test_a_command_loads_only_what_it_uses(words, unloaded):
    code = (
        "import sys; from verify.cli import main\n"
        f"sys.argv = ['verify', *{words!r}]\n"
        "try:\n    main()\nexcept SystemExit:\n    pass\n"
        "print('LOADED', *sorted({name.partition('.')[0] for name in sys.modules}))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = set(done.stdout.rpartition("LOADED")[2].split())
    assert not loaded & unloaded
