"""How one exact frequency moves with modulus and density, beside a figure somebody published."""

from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta

from verify.checks import Relative, check_number
from verify.studies.kind import Progress, Study

if TYPE_CHECKING:
    from collections.abc import Mapping

    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene
    from verify.studies.sensitivity_figures import SensitivityFound
    from verify.studies.told import Found


class Sensitivity(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask how one exact frequency moves with modulus and density, beside a figure somebody published."""

    mode: Annotated[int, Meta(ge=1)]
    """Which mode, from 1."""
    published_hz: float | None = None
    """A figure to compare with, hertz."""
    modulus_spread: Relative = 0.03
    """How far the modulus may lie off, relative."""
    density_spread: Relative = 0.03
    """How far the density may lie off, relative."""

    def __post_init__(self) -> None:
        check_number("sensitivity.modulus_spread", self.modulus_spread, "relative", above=0, below=1)
        check_number("sensitivity.density_spread", self.density_spread, "relative", above=0, below=1)
        if self.published_hz is not None:
            check_number("sensitivity.published_hz", self.published_hz, "hertz", above=0)


class SensitivityStudy(Study[Sensitivity, "SensitivityFound"]):
    """Closed forms alone."""

    name, section = "sensitivity", Sensitivity
    title = "Modulus and density"

    def run(
        self, asked: Sensitivity, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "SensitivityFound":
        """The exact frequency over modulus for densities around the scene's. Raises InputError."""
        from verify.studies.sensitivity_figures import sensitivity

        step("sensitivity")
        return sensitivity(scene.beam, asked)
