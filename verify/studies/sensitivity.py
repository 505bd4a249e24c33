"""How one exact frequency moves with modulus and density, beside a figure somebody published."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated

import msgspec
from msgspec import Meta, structs

from verify.beam import check_number
from verify.exact.closed_forms import frequency_hz
from verify.studies.kind import Chart, Found, Progress, Study

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.judge.workbench import Workbench
    from verify.scenes.scene import Scene


class Sensitivity(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Ask how one exact frequency moves with modulus and density, beside a figure somebody published."""

    mode: Annotated[int, Meta(ge=1)]
    published_hz: float | None = None
    modulus_spread: float = 0.03
    density_spread: float = 0.03

    def __post_init__(self) -> None:
        check_number("sensitivity.modulus_spread", self.modulus_spread, "relative", above=0, below=1)
        check_number("sensitivity.density_spread", self.density_spread, "relative", above=0, below=1)
        if self.published_hz is not None:
            check_number("sensitivity.published_hz", self.published_hz, "hertz", above=0)


class SensitivityFound(Found, frozen=True, eq=False, kw_only=True):
    """One exact frequency over modulus and density."""

    mode: int
    moduli: tuple[float, ...]
    densities: tuple[float, ...]
    frequencies_hz: tuple[tuple[float, ...], ...]
    """[density][modulus], Hz."""
    published_hz: float | None

    def charts(self) -> tuple[Chart, ...]:
        """The frequency over the modulus, a line for each density."""
        from verify.studies.mode_charts import sensitivity_chart

        return (sensitivity_chart(self),)


class SensitivityStudy(Study[Sensitivity, SensitivityFound]):
    """Closed forms alone."""

    name, section = "sensitivity", Sensitivity
    title = "Modulus and density"

    def run(
        self, asked: Sensitivity, scene: "Scene", bench: "Workbench", done: Mapping[str, Found], step: Progress
    ) -> SensitivityFound:
        """The exact frequency over modulus for densities around the scene's. Raises InputError."""
        step("sensitivity")
        return sensitivity(scene.beam, asked)


def sensitivity(beam: "Beam", asked: Sensitivity, steps: int = 25) -> SensitivityFound:
    """The exact frequency over modulus (`steps` values) for five densities around the beam's."""

    def spread(value: float, part: float, n: int) -> Iterator[float]:
        return (value * (1.0 + part * (2.0 * i / (n - 1) - 1.0)) for i in range(n))

    moduli = tuple(spread(beam.youngs_modulus, asked.modulus_spread, steps))
    densities = tuple(spread(beam.density, asked.density_spread, 5))
    table = tuple(
        tuple(frequency_hz(structs.replace(beam, youngs_modulus=e, density=rho), asked.mode) for e in moduli)
        for rho in densities
    )
    return SensitivityFound(
        mode=asked.mode, moduli=moduli, densities=densities, frequencies_hz=table, published_hz=asked.published_hz
    )
