"""One exact frequency over modulus and density, and how it is told."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from msgspec import structs

from verify.exact.modes import exact_frequency_hz
from verify.studies.chart import Chart
from verify.studies.told import Found

if TYPE_CHECKING:
    from verify.beam import Beam
    from verify.studies.modes.sensitivity import Sensitivity


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
        from verify.studies.modes.charts import sensitivity_chart

        return (sensitivity_chart(self),)

    def records(self) -> list[dict[str, Any]]:
        """A row for each modulus and density."""
        return [
            {"mode": self.mode, "youngs_modulus": modulus, "density": density, "frequency_hz": hertz}
            for density, row in zip(self.densities, self.frequencies_hz, strict=True)
            for modulus, hertz in zip(self.moduli, row, strict=True)
        ]


def sensitivity(beam: "Beam", asked: "Sensitivity", steps: int = 25) -> SensitivityFound:
    """The exact frequency over modulus (`steps` values) for five densities around the beam's."""

    def spread(value: float, part: float, n: int) -> Iterator[float]:
        return (value * (1.0 + part * (2.0 * i / (n - 1) - 1.0)) for i in range(n))

    assert beam.youngs_modulus is not None
    assert beam.density is not None  # the study has checked both
    moduli = tuple(spread(beam.youngs_modulus, asked.modulus_spread, steps))
    densities = tuple(spread(beam.density, asked.density_spread, 5))
    table = tuple(
        tuple(exact_frequency_hz(structs.replace(beam, youngs_modulus=e, density=rho), asked.mode) for e in moduli)
        for rho in densities
    )
    return SensitivityFound(
        mode=asked.mode, moduli=moduli, densities=densities, frequencies_hz=table, published_hz=asked.published_hz
    )
