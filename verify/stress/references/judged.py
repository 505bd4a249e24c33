"""How a model's frequency is judged: by its own matrices in 50 digits, beside LAPACK on assembled ones."""

from decimal import Decimal, localcontext

import numpy as np

from verify.beam import Beam
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.stress.references.decimals import PI
from verify.stress.references.extended import Divided, hermite, links, relative_error

N = 40
"""Parts, where nothing else is said."""
SMALL = 1e-12
"""docs/findings/other-beams.md: what rounding costs a frequency."""


def frequency(model: str, beam: Beam, mode: int, count: int | None, **settings: float | str) -> float:
    """Of one mode by one model, Hz."""
    if model == "analytic":
        from verify.exact.modes import exact_frequency_hz

        return exact_frequency_hz(beam, mode)
    found = MODELS[model].solve_modes(beam, mode, count or N, **settings).frequencies_hz
    return float(found[mode - 1])


def divided(beam: Beam, count: int, grading: float = 1.0) -> Divided:
    """The beam in the very parts that the models take, in metres."""
    from verify.models.division import divide

    parts = divide(beam, count, grading)
    own = beam.own
    with localcontext() as context:
        context.prec = 50
        unit, ei, ra = Decimal(parts.unit), Decimal(own.bending_stiffness), Decimal(own.mass_per_length)
        return Divided(
            supports=beam.supports,
            lengths=[Decimal(float(x)) * unit for x in parts.lengths],
            stiffnesses=[Decimal(float(x)) * ei for x in parts.stiffnesses],
            masses=[Decimal(float(x)) * ra for x in parts.masses_per_length],
            foundation=Decimal(beam.foundation),
            tension=Decimal(beam.tension),
        )


def judged(model: str, beam: Beam, divided: Divided, mode: int, count: int, **settings: float | str) -> float:
    """Error of a model's frequency against its own matrices in 50 digits."""
    with localcontext() as context:
        context.prec = 50
        omega = 2 * PI * Decimal(frequency(model, beam, mode, count, **settings))
        return relative_error((hermite if model == "fem" else links)(divided), mode, omega)


def lapack_error(divided: Divided, mode: int) -> float:
    """Error of Hermite elements by LAPACK on assembled matrices."""
    from verify.stress.references.textbook import dense_frequency

    stiffness, mass = (_dense(bands) for bands in hermite(divided))
    return relative_error(hermite(divided), mode, dense_frequency(stiffness, mass, mode))


def _dense(bands: list[list[Decimal]]) -> Array:
    n, width = len(bands), len(bands[0])
    full = np.zeros((n, n))
    for i, row in enumerate(bands):
        for k in range(min(width, n - i)):
            full[i, i + k] = full[i + k, i] = float(row[k])
    return full
