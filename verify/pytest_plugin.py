"""Gates of scene files as pytest items: `pytest my.toml`, `pytest verify/scenes -m gate`, `my.toml::gate-id`.

Loaded by pytest in every project that has this package installed, so it imports nothing at start.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from verify.judge.workbench import Workbench
    from verify.run.gates import GateResult
    from verify.scenes.scene import Gate, Scene


class GateFailedError(Exception):
    """A gate outside its band; carries the sentence that pytest shows."""


def pytest_configure(config: pytest.Config) -> None:
    """Make `-m gate` known."""
    config.addinivalue_line("markers", "gate: an accuracy gate of a scene file (TOML)")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "SceneFile | None":
    """Collect any .toml named on the command line, and those with gates in the folders that were."""
    if file_path.suffix != ".toml":
        return None
    if not parent.session.isinitpath(file_path) and not _has_gates(file_path):
        return None
    return SceneFile.from_parent(parent, path=file_path)


def _has_gates(path: Path) -> bool:
    """Whether a file found in a folder, not named, is a scene with gates; one that is no TOML is not ours."""
    from verify.errors import InputError
    from verify.scenes.toml import read_toml

    try:
        data = read_toml(path)
    except InputError:
        return False
    return isinstance(data.get("gate"), list) and "beam" in data


class SceneFile(pytest.File):
    """A scene file; its gates share one workbench, so that each model is solved once."""

    def collect(self) -> Iterable["GateItem"]:
        """One item for each gate. A scene that cannot be read is a collection error with its sentence."""
        from verify.errors import InputError
        from verify.patience import own_limit
        from verify.run.runner import workbench_for
        from verify.scenes.scene import load_scene

        try:
            own_limit()
            scene = load_scene(self.path)
        except InputError as error:
            raise self.CollectError("\n".join(error.sentences)) from None
        bench = workbench_for(scene, gates_only=True)
        for gate in scene.gate:
            yield GateItem.from_parent(self, name=gate.id, gate=gate, scene=scene, bench=bench)


class GateItem(pytest.Item):
    """One gate."""

    def __init__(self, *, gate: "Gate", scene: "Scene", bench: "Workbench", **rest: Any) -> None:
        super().__init__(**rest)
        self.gate, self.scene, self.bench = gate, scene, bench
        self.add_marker(pytest.mark.gate)

    def runtest(self) -> None:
        """Judge the gate; its figures become JUnit properties whether it passes or not."""
        from verify.run.gates import judge

        result = judge(self.gate, self.scene, self.bench)
        self.user_properties.extend(properties(result))
        if not result.passed:
            unit = "" if result.unit in ("", "1") else f" {result.unit}"
            raise GateFailedError(f"gate {result.id}: {result.reason} (expected {result.expected}{unit}; {result.why})")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """A gate's own sentence instead of a traceback into this file."""
        if isinstance(excinfo.value, GateFailedError):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Where pytest says the item comes from."""
        return self.path, None, f"gate {self.name}"


def properties(result: "GateResult") -> list[tuple[str, object]]:
    """What JUnit keeps of a gate."""
    given = [(name, getattr(result.band, name)) for name in result.band.__struct_fields__]
    return [
        ("measured", str(result.measured)),
        *((name, repr(value)) for name, value in given if isinstance(value, float | int)),
        ("band", result.expected),
        ("unit", result.unit),
        ("share_of_band_used", "" if result.share is None else f"{result.share:.6g}"),
        ("seconds", f"{result.seconds:.6g}"),
    ]
