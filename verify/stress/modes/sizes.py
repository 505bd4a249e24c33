"""How many parts, how many modes."""

from decimal import Decimal, localcontext
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.models.catalogue import MODELS
from verify.patience import patient
from verify.stress.kind import Figure, Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held
from verify.stress.references.decimals import PI as _PI
from verify.stress.references.decimals import cantilever_root, cos, exp, relative, sin

FIRST = 5
"""Modes of a size that are looked at."""
PARTS = {"segment": "segments", "fem": "elements"}


def dispersion_error(model: str) -> Figure:
    """N -> worst relative error of the first modes against the discrete dispersion in closed form."""

    def error(n: float) -> float:
        from verify.exact.error_laws import dispersion_frequency_hz

        found = MODELS[model].solve_modes(STRIP, FIRST, int(n)).frequencies_hz
        exact = [dispersion_frequency_hz(model, STRIP, mode, int(n)) for mode in range(1, FIRST + 1)]
        return float(abs(found / np.array(exact) - 1.0).max())

    return error


def assembled_error(model: str) -> Figure:
    """The same by eigsh on assembled matrices."""

    def error(n: float) -> float:
        from verify.exact.error_laws import dispersion_frequency_hz
        from verify.stress.references.textbook import assembled_roots, hertz

        roots = assembled_roots(model, STRIP.supports, int(n), FIRST)
        exact = [dispersion_frequency_hz(model, STRIP, mode, int(n)) for mode in range(1, FIRST + 1)]
        found = [hertz(STRIP, root, STRIP.length / n) for root in roots]
        return float(abs(np.array(found) / np.array(exact) - 1.0).max())

    return error


def patient_error(model: str) -> Figure:
    """`dispersion_error` of sizes that take more than is waited for."""

    def error(n: float) -> float:
        with patient(3600.0):
            return dispersion_error(model)(n)

    return error


def counted_error(model: str) -> Figure:
    """N -> error of a cantilever's mode 1, against its matrices counted in 50 digits."""

    def error(n: float) -> float:
        from verify.judge.extended_precision import chain_bands, hermite_bands
        from verify.stress.references.extended import relative_error

        beam = held("clamped", "free")
        found = MODELS[model].solve_modes(beam, 1, int(n)).frequencies_hz[0]
        bands = (chain_bands if model == "segment" else hermite_bands)(beam.supports, int(n))
        root = Decimal(2.0 * float(found)) * _PI / Decimal(beam.wave_constant) * (Decimal(beam.length) / int(n)) ** 2
        return relative_error(bands, 1, root)

    return error


def root_error(mode: float) -> float:
    """Of a cantilever's frequency in closed form."""
    from verify.exact.closed_forms import frequency_hz

    beam = held("clamped", "free")
    with localcontext() as context:
        context.prec = 50
        exact = cantilever_root(int(mode)) ** 2 * Decimal(beam.wave_constant) / Decimal(beam.length) ** 2
        return relative(frequency_hz(beam, int(mode)), exact / (2 * _PI))


def printed_root_error(mode: float) -> float:
    """Of the same from cos y cosh y = -1 as it is printed."""
    from verify.stress.references.textbook import cantilever_wavenumber

    return 2.0 * relative(cantilever_wavenumber(int(mode)), cantilever_root(int(mode)))


PLACES = (0.031, 0.37, 0.61, 0.93)
"""Of a cantilever, over its length."""


def shape_error(mode: float) -> float:
    """Worst error of a cantilever's shape at some places over its largest deflection, 2 / sqrt(rho A L)."""
    from verify.exact.modes import mode_shape

    beam = replace(held("clamped", "free"), length=1.0)
    x = np.array(PLACES)
    found = mode_shape(beam, int(mode), x) * np.sqrt(beam.mass_per_length * beam.length)
    exact = [_exact_shape(int(mode), float(place), beam.length) for place in x]
    return largest(abs(float(Decimal(float(a)) - b)) for a, b in zip(found, exact, strict=True)) / 2.0


def _exact_shape(mode: int, x: float, length: float) -> Decimal:
    """Cosh - cos - sigma (sinh - sin) with the growing exponentials taken together."""
    with localcontext() as context:
        context.prec = 50
        y, z = cantilever_root(mode), Decimal(x) / Decimal(length)
        fall = exp(-y)
        below = 1 + fall * fall + 2 * fall * cos(y)
        rise = (fall + cos(y) + sin(y)) / below  # e^y (1 - sigma) / 2
        sigma = 1 - 2 * fall * rise
        return rise * exp(-y * (1 - z)) + (1 + sigma) / 2 * exp(-y * z) - cos(y * z) + sigma * sin(y * z)


def printed_shape_error(mode: float) -> float:
    """Of the same as it is printed."""
    from verify.stress.references.textbook import cantilever_shape

    y = float(cantilever_root(int(mode)))
    pairs = ((cantilever_shape(y, place), _exact_shape(int(mode), place, 1.0)) for place in PLACES)
    return largest(abs(a - float(b)) for a, b in pairs) / 2.0


GROUND = 1234.5
"""N/m^2: a beam on it has no closed form in the suite, so that its modes are counted."""


def counting_error(mode: float) -> float:
    """Of the counted frequency of a pinned beam on a foundation, and of a taut one on stiff ground: squares are known.

    Below the first frequency of the taut one nothing but real exponentials runs along it, of exponents 73 and 1200.
    """
    from verify.exact.modes import exact_frequency_hz

    beams = replace(STRIP, foundation=GROUND), replace(STRIP, tension=1e7, foundation=1e11)
    return largest(relative(exact_frequency_hz(beam, int(mode)), _on_ground(beam, int(mode))) for beam in beams)


def _on_ground(beam: Beam, mode: int) -> Decimal:
    """Hz: EI (n pi / L)^4 + T (n pi / L)^2 + k over rho A, in decimals."""
    with localcontext() as context:
        context.prec = 50
        beta = mode * _PI / Decimal(beam.length)
        bent, pulled = Decimal(beam.bending_stiffness) * beta**4, Decimal(beam.tension) * beta**2
        square = (bent + pulled + Decimal(beam.foundation)) / Decimal(beam.mass_per_length)
        return square.sqrt() / (2 * _PI)


def determinant_error(mode: float) -> float:
    """Of the same by bisection on the determinant of the four ends' conditions with cosh and sinh."""
    from scipy.optimize import brentq

    beam, n = replace(STRIP, foundation=GROUND), int(mode)
    exact = float(_on_ground(beam, n))

    def determinant(hertz: float) -> float:
        omega2 = (2.0 * pi * hertz) ** 2
        stiffness = (beam.mass_per_length * omega2 - beam.foundation) / beam.bending_stiffness
        y = stiffness**0.25 * beam.length
        rows = [[0, 1, 0, 1], [0, -1, 0, 1]]
        rows += [[np.sin(y), np.cos(y), np.sinh(y), np.cosh(y)], [-np.sin(y), -np.cos(y), np.sinh(y), np.cosh(y)]]
        return float(np.linalg.det(np.array(rows)))

    return abs(float(brentq(determinant, exact * (1 - 0.3 / n), exact * (1 + 0.3 / n), xtol=1e-300)) / exact - 1.0)


def _too_many_modes(model: str) -> Figure:
    return lambda n: float(MODELS[model].solve_modes(STRIP, 2 * int(n) + 5, int(n)).frequencies_hz[-1])


def _one_mode(model: str) -> Figure:
    return lambda n: float(MODELS[model].solve_modes(STRIP, 1, int(n)).frequencies_hz[0])


def _size_rows(model: str) -> tuple[Row, ...]:
    """Rounding over the number of parts, and what a model has not or a machine does not hold."""
    parts = PARTS[model]
    return (*_rounded(model, parts), _counted(model, parts), *_too_large(model, parts))


def _rounded(model: str, parts: str) -> tuple[Row, ...]:
    """Modes of many parts against their dispersion in closed form."""
    return (
        Floor(
            id=f"{parts}-parts",
            title=f"Modes 1 to 5 of many {parts} against their dispersion in closed form",
            why="docs/findings: below 1e-12 in modes of many parts; models/eigen.py: to rounding, at any size.",
            along=parts,
            at=(100, 1000, 10_000, 30_000),
            promise=1e-12,
            error=dispersion_error(model),
            beside=assembled_error(model),
            textbook="eigsh about 0 on assembled K and M",
            seconds=4.0,
        ),
        Floor(
            id=f"{parts}-million",
            title=f"The same of up to a million {parts}",
            why="The same; more than is waited for unasked, which the row sets aside.",
            along=parts,
            at=(100_000, 300_000, 1_000_000),
            promise=1e-12,
            error=patient_error(model),
            beside=assembled_error(model),
            beside_at=(10_000, 30_000, 50_000),
            textbook="eigsh about 0 on assembled K and M, fewer parts",
            seconds=240.0 if model == "fem" else 80.0,
            quick=False,
        ),
    )


def _counted(model: str, parts: str) -> Row:
    """A cantilever of parts against counts of eigenvalues in many digits."""
    return Floor(
        id=f"{parts}-counted",
        title=f"Mode 1 of a cantilever of {parts} against counts in 50 digits",
        why="docs/findings: below 1e-12, counted in 50-digit arithmetic; a solver is no judge of a solver.",
        along=parts,
        at=(60, 400),
        promise=1e-12,
        error=counted_error(model),
        beside=cantilever_beside if model == "fem" else None,
        beside_at=(60, 400),
        textbook="eigsh about 0 on assembled K and M" if model == "fem" else "",
        seconds=4.0,
    )


def _too_large(model: str, parts: str) -> tuple[Row, ...]:
    """What is refused: modes that there are not, and parts that no memory holds."""
    return (
        Refusal(
            id=f"{parts}-too-many-modes",
            title=f"More modes than {parts} have",
            why="DESIGN: more modes than the model has is bad input; docstring of solve_modes.",
            along=parts,
            at=(10, 1000, 100_000),
            names=("n_modes", "count"),
            ask=_too_many_modes(model),
        ),
        Refusal(
            id=f"{parts}-beyond-memory",
            title=f"More {parts} than this machine holds",
            why="models/eigen.py: refused before anything large is allocated.",
            along=parts,
            at=(1e10, 1e12),
            names=("count", "GiB"),
            ask=_one_mode(model),
            taken=(1000,),
        ),
    )


def cantilever_beside(n: float) -> float:
    """Elements' mode 1 of a cantilever by eigsh on assembled matrices, counted as well."""
    from verify.judge.extended_precision import hermite_bands
    from verify.stress.references.extended import relative_error
    from verify.stress.references.textbook import assembled_roots

    supports = ("clamped", "free")
    root = assembled_roots("fem", supports, int(n), 1)[0]
    return relative_error(hermite_bands(supports, int(n)), 1, Decimal(float(root)))


ROWS: tuple[Row, ...] = (
    *_size_rows("segment"),
    *_size_rows("fem"),
    Floor(
        id="closed-form-frequencies",
        title="Frequencies of a cantilever in closed form to mode 100 000",
        why="exact/closed_forms.py: to rounding; five operations on doubles of 1.1e-16 each.",
        along="mode",
        at=(1, 2, 3, 10, 100, 1000, 10_000, 100_000),
        beyond=(1e7, 1e9, 1e12),
        promise=6e-16,
        error=root_error,
        beside=printed_root_error,
        beside_at=(1, 10, 100, 300),
        textbook="Newton on cos y cosh y = -1",
    ),
    Floor(
        id="closed-form-shapes",
        title="Shapes of a cantilever of 1 m in closed form to mode 100 000",
        why="REFERENCE 5: pointwise 4e-16 up to mode 100 000, over shapes of amplitude 2.",
        along="mode",
        at=(1, 2, 5, 50, 1000, 100_000),
        promise=4e-16,
        error=shape_error,
        beside=printed_shape_error,
        beside_at=(1, 5, 10, 15, 300),
        textbook="cosh - cos - sigma (sinh - sin)",
    ),
    Floor(
        id="counted-frequencies",
        title="Frequencies found by counting, beam on a foundation, slack and taut, to mode 100 000",
        why="exact/modes.py: roots to rounding; the square plus what T and k add to it is the closed form.",
        along="mode",
        at=(1, 10, 100, 1000, 10_000, 100_000),
        promise=1e-14,
        error=counting_error,
        beside=determinant_error,
        beside_at=(5, 10, 20, 100, 300),
        textbook="brentq on the 4 x 4 determinant",
    ),
)
