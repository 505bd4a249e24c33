"""Gates of scene files as pytest items: `pytest my.toml`, `pytest verify/scene/data -m gate`, `my.toml::gate-id`.

Loaded by pytest in every project where this package is installed, so it imports nothing at start.
"""

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any
from warnings import warn

import pytest

if TYPE_CHECKING:
    from verify.analysis.solution_cache import SolutionCache
    from verify.scene.model import Gate, Scene


class GateFailedError(Exception):
    """A gate outside its band; carries the sentence that pytest prints."""


def pytest_configure(config: pytest.Config) -> None:
    """Register the marker `gate`."""
    config.addinivalue_line("markers", "gate: an accuracy gate of a scene file (TOML)")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "SceneFile | None":
    """Collect any .toml named on the command line, and those with a beam and gates in folders."""
    if file_path.suffix != ".toml":
        return None
    if not parent.session.isinitpath(file_path):
        from verify.errors import InputError
        from verify.scene.file import read_toml

        try:
            tables = read_toml(file_path)
        except InputError:
            return None
        if not isinstance(tables.get("gate"), list) or "beam" not in tables:
            return None
    return SceneFile.from_parent(parent, path=file_path)


class SceneFile(pytest.File):
    """A scene file; its gates share one solution cache."""

    def collect(self) -> Iterable["GateItem"]:
        """One item for each gate. A scene with errors or without gates is a collection error with a sentence."""
        from verify.analysis.solution_cache import SolutionCache
        from verify.errors import InputError
        from verify.scene.load import load_scene

        try:
            scene = load_scene(self.path)
        except InputError as error:
            raise self.CollectError("\n".join(error.sentences)) from None
        if not scene.gate:
            raise self.CollectError(f"{self.path.name}: it has no gates, so nothing is judged: add a [[gate]]")
        cache = SolutionCache(scene.beam)
        for gate in scene.gate:
            yield GateItem.from_parent(self, name=gate.id, gate=gate, scene=scene, cache=cache)


class GateItem(pytest.Item):
    """One gate."""

    def __init__(self, *, gate: "Gate", scene: "Scene", cache: "SolutionCache", **rest: Any) -> None:
        super().__init__(**rest)
        self.gate, self.scene, self.cache = gate, scene, cache
        self.add_marker(pytest.mark.gate)

    def runtest(self) -> None:
        """Evaluate the gate; its values become JUnit properties whether it passes or not."""
        from verify.analysis.verdict import verdict_of
        from verify.report.summary import expected
        from verify.scene.run import run_gate

        result = run_gate(self.gate, self.scene, self.cache)
        band = expected(self.gate)
        unit = "" if result.unit == "1" else f" {result.unit}"
        values = {"measured": result.value, "expected": band, "unit": result.unit}
        values["fraction"] = "" if result.fraction is None else f"{result.fraction:.6g}"
        values["seconds"] = f"{result.seconds:.6g}"
        verdict = verdict_of(result.margins)
        values["verdict"] = verdict.headline if result.margins else ""
        self.user_properties += [(name, str(value)) for name, value in values.items()]
        if verdict.level == "not trusted":
            warn(pytest.PytestWarning(f"gate {result.id}: {verdict.headline}"), stacklevel=1)
        if not result.passed:
            raise GateFailedError(f"gate {result.id}: {result.reason} (expected {band}{unit}; {self.gate.why})")

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """The gate's sentence instead of a traceback into this file."""
        return str(excinfo.value) if isinstance(excinfo.value, GateFailedError) else super().repr_failure(excinfo)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Location and name of the item."""
        return self.path, None, f"gate {self.name}"
