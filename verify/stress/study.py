"""The stress table as a section of a scene."""

from typing import TYPE_CHECKING

import msgspec

from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from verify.judge.workbench import Workbench
    from verify.models.compiling import Call
    from verify.scenes.scene import Scene
    from verify.stress.figures import StressFound
    from verify.studies.told import Found


class Stress(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask for the stress table: promises pushed until they break. Its beams are its own."""

    rows: tuple[str, ...] = ()
    """Ids, as `verify stress --list` has them; every quick one unless given."""


class StressStudy(Study[Stress, "StressFound"]):
    """Measures rows one by one, each once for gates and table."""

    name, section, work = "stress", Stress, "promise"
    title = "Promises pushed until they break"

    def check_run(self, asked: Stress, scene: "Scene") -> None:
        """Raise InputError for a row that is not known."""
        from verify.stress.catalogue import row

        for i, name in enumerate(asked.rows):
            row(name, f"stress.rows[{i}]")

    def told(self, asked: Stress, scene: "Scene") -> str:
        """How many rows."""
        return f"{self.n_steps(asked, scene)} rows, on beams of their own"

    def n_steps(self, asked: Stress, scene: "Scene") -> int:
        """A step for each row."""
        from verify.stress.figures import chosen

        return len(chosen(asked.rows, quick=True))

    def kernels(self, asked: Stress, scene: "Scene") -> "Iterable[Call]":
        """Of its rows, in turn."""
        from verify.stress.figures import chosen

        for row in chosen(asked.rows, quick=True):
            yield from row.kernels()

    def run(
        self, asked: Stress, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "StressFound":
        """See `figures.stress`."""
        from verify.stress.figures import chosen, stress, told

        return told(stress(chosen(asked.rows, quick=True), step, bench))
