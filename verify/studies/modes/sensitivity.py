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
    from verify.studies.modes.sensitivity_figures import SensitivityFound
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

    name, section, work = "sensitivity", Sensitivity, "modes"
    title = "Modulus and density"

    def asked(self, scene: "Scene") -> Sensitivity | None:
        """What the scene asks, where its beam has one modulus and one density to turn."""
        given: Sensitivity | None = getattr(scene, self.name, None)
        return None if given is None or self._missing(scene) else given

    def skipped(self, scene: "Scene") -> str:
        """Why it is left out."""
        return (self._missing(scene) if getattr(scene, self.name, None) else "") or super().skipped(scene)

    def _missing(self, scene: "Scene") -> str:
        beam = scene.beam
        if beam.section:
            return f"a beam of {len(beam.pieces)} sections has more than one modulus and density to turn"
        if beam.youngs_modulus is None or beam.density is None:
            return "a section given by its stiffness and mass has no modulus and density to turn"
        return ""

    def run(
        self, asked: Sensitivity, scene: "Scene", bench: "Workbench", done: "Mapping[str, Found]", step: Progress
    ) -> "SensitivityFound":
        """The exact frequency over modulus for densities around the scene's. Raises InputError."""
        from verify.studies.modes.sensitivity_figures import sensitivity

        step("sensitivity")
        return sensitivity(scene.beam, asked)
