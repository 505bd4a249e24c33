"""Sizes and materials over many powers of ten, and what stands on a beam from nothing to endless."""

from collections.abc import Callable
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.section import Section
from verify.stress.kind import Figure, Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, root_of
from verify.stress.references.judged import SMALL, N, divided, frequency, judged, lapack_error

GRADED = 120
"""Parts of a graded mesh: more leave less of an assembled stiffness."""
FEW = 4
"""Parts of a mesh in which one is a millionth of the beam."""
SOFT = 1e-5
"""Of the strip's modulus: a stiff piece so short would be refused, by EI / l^3."""
MODE = 3
DISCRETE = ("segment", "fem")


def scale_error(change: Callable[[float], Beam]) -> Callable[[float], float]:
    """How far the dimensionless frequencies of all models lie from those of the strip itself, the worst."""

    def error(value: float) -> float:
        beam = change(value)
        worst = 0.0
        for model, count in (("analytic", None), ("segment", N), ("fem", N)):
            here = root_of(beam, frequency(model, beam, MODE, count), beam.length)
            there = root_of(STRIP, frequency(model, STRIP, MODE, count), STRIP.length)
            worst = largest(worst, abs(here / there - 1.0))
        return worst

    return error


def longer(length: float) -> Beam:
    """The strip at another size, its shape kept."""
    ratio = length / STRIP.length
    assert STRIP.width is not None
    assert STRIP.thickness is not None
    return replace(STRIP, length=length, width=STRIP.width * ratio, thickness=STRIP.thickness * ratio)


def dense_scale_error(change: Callable[[float], Beam]) -> Callable[[float], float]:
    """The same of Hermite elements by LAPACK on matrices in SI units."""

    def error(value: float) -> float:
        return abs(_dense_root(change(value)) / _dense_root(STRIP) - 1.0)

    return error


def _dense_root(beam: Beam) -> float:
    from verify.stress.references.textbook import assembled, dense_frequency

    stiffness, mass = (np.asarray(one.toarray()) for one in assembled("fem", beam.supports, N))
    length = beam.length / N
    units = np.array([1.0, length] * (N + 1))[1:-2]
    units = np.append(units, length)
    stiffness *= np.outer(units, units) * beam.bending_stiffness / length**3
    mass *= np.outer(units, units) * beam.mass_per_length * length
    return root_of(beam, dense_frequency(stiffness, mass, MODE) / (2.0 * pi), beam.length)


def stepped(ratio: float) -> Beam:
    """A pinned strip, 0.3 of it so many times as stiff (E)."""
    assert STRIP.youngs_modulus is not None
    stiff = Section(length=0.3 * STRIP.length, youngs_modulus=STRIP.youngs_modulus * ratio)
    return replace(STRIP, section=(stiff, Section(length=STRIP.length - 0.3 * STRIP.length)))


def short_section(share: float) -> Beam:
    """A pinned strip of which a short piece in front is a little heavier and soft: a mesh graded by that piece."""
    assert STRIP.density is not None
    assert STRIP.youngs_modulus is not None
    first = share * STRIP.length
    piece = Section(length=first, density=1.1 * STRIP.density, youngs_modulus=SOFT * STRIP.youngs_modulus)
    return replace(STRIP, section=(piece, Section(length=STRIP.length - first)))


def short_and_stiff(share: float) -> Beam:
    """The same with a piece as stiff as the rest."""
    first = share * STRIP.length
    assert STRIP.density is not None
    piece = Section(length=first, density=1.1 * STRIP.density)
    return replace(STRIP, section=(piece, Section(length=STRIP.length - first)))


def stepped_error(model: str) -> Figure:
    """Ratio of moduli -> error of the stepped strip."""
    return lambda ratio: judged(model, stepped(ratio), divided(stepped(ratio), N), MODE, N)


def graded_error(model: str) -> Figure:
    """Grading -> error of the strip in graded parts."""
    return lambda ratio: judged(model, STRIP, divided(STRIP, GRADED, ratio), MODE, GRADED, grading=ratio)


def short_error(model: str) -> Figure:
    """Share of a short section -> error in few parts."""
    return lambda share: judged(model, short_section(share), divided(short_section(share), FEW), 2, FEW)


PARTS = (("segment", "segments"), ("fem", "elements"))


ROWS: tuple[Row, ...] = (
    Floor(
        id="nanometres-to-kilometres",
        title="Dimensionless frequency of one shape of beam at every size, three models",
        why="models/eigen.py works in units of a part, so that no figure knows of metres: roundings of a few products.",
        along="m",
        at=(1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6),
        beyond=(1e12, 1e24),
        promise=1e-14,
        error=scale_error(longer),
        beside=dense_scale_error(longer),
        textbook="LAPACK on K and M in SI units",
    ),
    Floor(
        id="modulus",
        title="The same over Young's modulus",
        why="The same.",
        along="Pa",
        at=(1.0, 1e3, 1e6, 1e9, 1e12, 1e15),
        beyond=(1e30, 1e60),
        promise=1e-14,
        error=scale_error(lambda e: replace(STRIP, youngs_modulus=e)),
        beside=dense_scale_error(lambda e: replace(STRIP, youngs_modulus=e)),
        textbook="LAPACK on K and M in SI units",
    ),
    Floor(
        id="density",
        title="The same over the density",
        why="The same.",
        along="kg/m^3",
        at=(1e-6, 1e-3, 1.0, 1e6, 1e12),
        beyond=(1e30, 1e60),
        promise=1e-14,
        error=scale_error(lambda rho: replace(STRIP, density=rho)),
        beside=dense_scale_error(lambda rho: replace(STRIP, density=rho)),
        textbook="LAPACK on K and M in SI units",
    ),
    Refusal(
        id="off-the-scale",
        title="Lengths whose fourth power leaves floating point",
        why="section.py: derived figures beyond 1e100 are refused with the figure.",
        along="m",
        at=(1e30, 1e100, 1e300),
        names=("beam", "check their units"),
        ask=longer,
        taken=(1e-9, 1e6),
    ),
    *(
        Floor(
            id=f"section-steps-{parts}",
            title=f"Mode {MODE} of a stepped strip of {parts} against its matrices in 50 digits",
            why="docs/findings: rounding below 1e-12; steps up to 1e15 of EI / l^3 are taken (beam.py CONTRAST).",
            along="in E",
            at=(1.0, 10.0, 1e3, 1e6),
            beyond=(1e9, 1e12, 1e14, 1e16),
            promise=SMALL,
            error=stepped_error(model),
            beside=(lambda ratio: lapack_error(divided(stepped(ratio), N), MODE)) if model == "fem" else None,
            textbook="LAPACK on assembled K and M" if model == "fem" else "",
            seconds=2.0,
        )
        for model, parts in PARTS
    ),
    Refusal(
        id="section-steps-beyond",
        title="Sections beyond 1e15 apart in EI / l^3",
        why="beam.py CONTRAST: beyond it the softer one is lost.",
        along="in E",
        at=(1e17, 1e30),
        names=("beam.section", "EI / l^3"),
        ask=stepped,
        taken=(1e6, 1e12),
    ),
    *(
        Floor(
            id=f"graded-{parts}",
            title=f"Mode {MODE} of {parts} graded from one end to the other, against their matrices in 50 digits",
            why="docs/findings: rounding below 1e-12; models/division.py takes gradings from 0.001 to 1000.",
            along="in length",
            at=(1.0, 10.0, 1e3),
            promise=SMALL,
            error=graded_error(model),
            beside=(lambda ratio: lapack_error(divided(STRIP, GRADED, ratio), MODE)) if model == "fem" else None,
            textbook="LAPACK on assembled K and M" if model == "fem" else "",
            seconds=2.0,
        )
        for model, parts in PARTS
    ),
    Refusal(
        id="graded-beyond",
        title="Gradings beyond a thousand",
        why="models/division.py: refused by name.",
        along="in length",
        at=(1001.0, 1e6, 1e300),
        names=("grading", "1000"),
        ask=lambda ratio: [frequency(model, STRIP, 1, N, grading=ratio) for model in DISCRETE],
        taken=(1000.0,),
    ),
    *(
        Floor(
            id=f"mesh-a-million-to-one-{parts}",
            title=f"Mode 2 of {FEW} {parts}, the first of which is a millionth of the beam",
            why="docs/findings: rounding below 1e-12; beam.py takes sections from a millionth (SHORTEST_SECTION).",
            along="L",
            at=(0.1, 1e-2, 1e-3, 1e-4, 1e-6),
            promise=SMALL,
            error=short_error(model),
            beside=(lambda share: lapack_error(divided(short_section(share), FEW), 2)) if model == "fem" else None,
            textbook="LAPACK on assembled K and M" if model == "fem" else "",
            seconds=2.0,
        )
        for model, parts in PARTS
    ),
    Refusal(
        id="shorter-than-a-millionth",
        title="Sections shorter than a millionth of the beam",
        why="beam.py SHORTEST_SECTION.",
        along="L",
        at=(9e-7, 1e-12),
        names=("beam.section[0].length", "beam.length"),
        ask=short_section,
        taken=(1.1e-6,),
    ),
    Refusal(
        id="short-and-stiff",
        title="A piece as stiff as the rest and so short that nothing of the rest is left beside it",
        why="beam.py CONTRAST: 1e15 of EI / l^3.",
        along="L",
        at=(9e-6, 1.1e-6),
        names=("beam.section", "EI / l^3", "too short to bend"),
        ask=short_and_stiff,
        taken=(1.1e-5,),
    ),
)
