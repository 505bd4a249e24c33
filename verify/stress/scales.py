"""Sizes and materials over many powers of ten, and what stands on a beam from nothing to endless."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.stress.beams import STRIP, held, root_of
from verify.stress.decimals import PI
from verify.stress.extended import Divided, hermite, links, relative_error
from verify.stress.kind import Floor, Refusal, Row

N = 40
GRADED = 120
"""Parts of a graded mesh: more leave less of an assembled stiffness."""
FEW = 4
"""Parts of a mesh in which one is a millionth of the beam."""
SOFT = 1e-5
"""Of the strip's modulus: a stiff piece so short would be refused, by EI / l^3."""
MODE = 3
DISCRETE = ("segment", "fem")


def frequency(model: str, beam: Beam, mode: int, count: int | None, **settings: float | str) -> float:
    """Of one mode by one model, Hz."""
    if model == "analytic":
        from verify.exact.modes import exact_frequency_hz

        return exact_frequency_hz(beam, mode)
    found = MODELS[model].solve_modes(beam, mode, count, **settings).frequencies_hz
    return float(found[mode - 1])


def scale_error(change: Callable[[float], Beam]) -> Callable[[float], float]:
    """How far the dimensionless frequencies of all models lie from those of the strip itself, the worst."""

    def error(value: float) -> float:
        beam = change(value)
        worst = 0.0
        for model, count in (("analytic", None), ("segment", N), ("fem", N)):
            here = root_of(beam, frequency(model, beam, MODE, count), beam.length)
            there = root_of(STRIP, frequency(model, STRIP, MODE, count), STRIP.length)
            worst = max(worst, abs(here / there - 1.0))
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
    from verify.stress.textbook import assembled, dense_frequency

    stiffness, mass = (np.asarray(one.toarray()) for one in assembled("fem", beam.supports, N))
    length = beam.length / N
    units = np.array([1.0, length] * (N + 1))[1:-2]
    units = np.append(units, length)
    stiffness *= np.outer(units, units) * beam.bending_stiffness / length**3
    mass *= np.outer(units, units) * beam.mass_per_length * length
    return root_of(beam, dense_frequency(stiffness, mass, MODE) / (2.0 * pi), beam.length)


def _divided(beam: Beam, count: int, grading: float = 1.0) -> Divided:
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
    from verify.stress.textbook import dense_frequency

    stiffness, mass = (_dense(bands) for bands in hermite(divided))
    return relative_error(hermite(divided), mode, dense_frequency(stiffness, mass, mode))


def _dense(bands: list[list[Decimal]]) -> "np.ndarray[tuple[int, int], np.dtype[np.float64]]":
    n, width = len(bands), len(bands[0])
    full = np.zeros((n, n))
    for i, row in enumerate(bands):
        for k in range(min(width, n - i)):
            full[i, i + k] = full[i + k, i] = float(row[k])
    return full


# --- what stands on the beam

CANTILEVER = held("clamped", "free")
OWN_MASS = CANTILEVER.mass_per_length * CANTILEVER.length
OWN_STIFFNESS = CANTILEVER.bending_stiffness / CANTILEVER.length**3


def with_tip_mass(ratio: float) -> tuple[Beam, Divided]:
    """A cantilever with a tip mass of so many times its own."""
    mass = ratio * OWN_MASS
    beam = replace(CANTILEVER, mass=(PointMass(position=CANTILEVER.length, mass=mass),))
    return beam, replace(_divided(CANTILEVER, N), point_masses={N: mass})


def with_tip_spring(ratio: float) -> tuple[Beam, Divided]:
    """A cantilever with a tip spring of so many times EI / L^3."""
    stiffness = ratio * OWN_STIFFNESS
    beam = replace(CANTILEVER, spring=(PointSpring(position=CANTILEVER.length, stiffness=stiffness),))
    return beam, replace(_divided(CANTILEVER, N), springs={N: stiffness})


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


def grounded_error(ratio: float) -> float:
    """Worst error of all models on a foundation of so many EI / L^4 between pins, mode 2.

    omega^2 grows by exactly k / (rho A) on each: elements and links bear on it as they carry their mass.
    """
    from verify.exact.error_laws import dispersion_frequency_hz

    beam = replace(STRIP, foundation=ratio * STRIP.bending_stiffness / STRIP.length**4)
    worst = 0.0
    with localcontext() as context:
        context.prec = 50
        added = Decimal(beam.foundation) / Decimal(beam.mass_per_length)
        for model, count in (("analytic", None), ("segment", N), ("fem", N)):
            if count is None:
                bare = 2 * (PI / Decimal(beam.length)) ** 2 * 2 * Decimal(beam.wave_constant)
            else:
                bare = 2 * PI * Decimal(dispersion_frequency_hz(model, STRIP, 2, count))
            exact = (bare * bare + added).sqrt() / (2 * PI)
            worst = max(worst, abs(float(Decimal(frequency(model, beam, 2, count)) / exact - 1)))
    return worst


def taut_error(ratio: float) -> float:
    """Error of the exact frequency, mode 3, under a tension of so many EI / L^2 between pins."""
    beam = replace(STRIP, tension=ratio * STRIP.bending_stiffness / STRIP.length**2)
    return abs(float(Decimal(frequency("analytic", beam, 3, None)) / _under_tension(beam, 3) - 1))


def _under_tension(beam: Beam, mode: int) -> Decimal:
    """Hz: (EI beta^4 + T beta^2) / (rho A), pinned."""
    with localcontext() as context:
        context.prec = 50
        square = (mode * PI / Decimal(beam.length)) ** 2
        stiffness = (Decimal(beam.bending_stiffness) * square + Decimal(beam.tension)) * square
        return (stiffness / Decimal(beam.mass_per_length)).sqrt() / (2 * PI)


def compressed(model: str, gap: float) -> tuple[Beam, Divided | None]:
    """The pinned strip at 1 - gap of the load at which the model buckles."""
    beam = replace(STRIP, tension=-(1.0 - gap) * buckling(model))
    return beam, None if model == "analytic" else _divided(beam, N)


def buckling(model: str) -> float:
    """Of the pinned strip by one model, newton."""
    if model == "analytic":
        from verify.exact.buckling import buckling_load as exact_load

        return exact_load(STRIP)
    if model == "fem":
        from verify.elements.linear import buckling_load as elements_load

        return elements_load(STRIP, N)

    from verify.segments.buckling import buckling_load as chain_load

    return chain_load(STRIP, N)


def compressed_error(gap: float) -> float:
    """Worst error of the models' mode 1 close to buckling, times the gap: what a rounding of the load moves is 1 / gap.

    Each against its own frequency in 50 digits.
    """
    worst = 0.0
    for model in ("analytic", "segment", "fem"):
        beam, divided = compressed(model, gap)
        if divided is None:
            error = abs(float(Decimal(frequency(model, beam, 1, None)) / _under_tension(beam, 1) - 1))
        else:
            error = judged(model, beam, divided, 1, N)
        worst = max(worst, gap * error)
    return worst


def crushed(excess: float) -> float:
    """The models' mode 1 beyond buckling, each in turn; the first that answers."""
    from verify.errors import InputError

    said: InputError | None = None
    for model in ("analytic", "segment", "fem"):
        beam = replace(STRIP, tension=-(1.0 + excess) * buckling(model))
        try:
            return frequency(model, beam, 1, None if model == "analytic" else N)
        except InputError as error:
            said = error
    assert said is not None
    raise said


SMALL = 1e-12
"""README: what rounding costs a frequency."""

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
    Floor(
        id="tip-mass",
        title="Mode 1 of a cantilever of elements under a tip mass, against its matrices in 50 digits",
        why="README: rounding below 1e-12; elements keep point masses apart from what bends.",
        along="beam masses",
        at=(1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12),
        beyond=(1e15, 1e18, 1e24),
        promise=SMALL,
        error=lambda ratio: judged("fem", *with_tip_mass(ratio), 1, N),
        beside=lambda ratio: lapack_error(with_tip_mass(ratio)[1], 1),
        textbook="LAPACK on assembled K and M",
        seconds=3.0,
    ),
    Floor(
        id="tip-mass-second-mode",
        title="Mode 2 of the same",
        why="The same.",
        along="beam masses",
        at=(1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12),
        promise=SMALL,
        error=lambda ratio: judged("fem", *with_tip_mass(ratio), 2, N),
        beside=lambda ratio: lapack_error(with_tip_mass(ratio)[1], 2),
        textbook="LAPACK on assembled K and M",
        seconds=3.0,
    ),
    Floor(
        id="tip-spring",
        title="Mode 2 of a cantilever of elements on a tip spring, against its matrices in 50 digits",
        why="The same: springs have rows of their own in the factored stiffness.",
        along="EI/L^3",
        at=(1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9, 1e12),
        beyond=(1e15, 1e18, 1e24),
        promise=SMALL,
        error=lambda ratio: judged("fem", *with_tip_spring(ratio), 2, N),
        beside=lambda ratio: lapack_error(with_tip_spring(ratio)[1], 2),
        textbook="LAPACK on assembled K and M",
        seconds=3.0,
    ),
    *(
        Floor(
            id=f"section-steps-{parts}",
            title=f"Mode {MODE} of a stepped strip of {parts} against its matrices in 50 digits",
            why="README: rounding below 1e-12; steps up to 1e15 of EI / l^3 are taken (beam.py CONTRAST).",
            along="in E",
            at=(1.0, 10.0, 1e3, 1e6),
            beyond=(1e9, 1e12, 1e14, 1e16),
            promise=SMALL,
            error=lambda ratio, model=model: judged(model, stepped(ratio), _divided(stepped(ratio), N), MODE, N),
            beside=(lambda ratio: lapack_error(_divided(stepped(ratio), N), MODE)) if model == "fem" else None,
            textbook="LAPACK on assembled K and M" if model == "fem" else "",
            seconds=2.0,
        )
        for model, parts in (("segment", "segments"), ("fem", "elements"))
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
            why="README: rounding below 1e-12; models/division.py takes gradings from 0.001 to 1000.",
            along="in length",
            at=(1.0, 10.0, 1e3),
            promise=SMALL,
            error=lambda ratio, model=model: judged(model, STRIP, _divided(STRIP, GRADED, ratio), MODE, GRADED, grading=ratio),
            beside=(lambda ratio: lapack_error(_divided(STRIP, GRADED, ratio), MODE)) if model == "fem" else None,
            textbook="LAPACK on assembled K and M" if model == "fem" else "",
            seconds=2.0,
        )
        for model, parts in (("segment", "segments"), ("fem", "elements"))
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
            why="README: rounding below 1e-12; beam.py takes sections from a millionth of the beam (SHORTEST_SECTION).",
            along="L",
            at=(0.1, 1e-2, 1e-3, 1e-4, 1e-6),
            promise=SMALL,
            error=lambda share, m=model: judged(m, short_section(share), _divided(short_section(share), FEW), 2, FEW),
            beside=(lambda share: lapack_error(_divided(short_section(share), FEW), 2)) if model == "fem" else None,
            textbook="LAPACK on assembled K and M" if model == "fem" else "",
            seconds=2.0,
        )
        for model, parts in (("segment", "segments"), ("fem", "elements"))
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
    Floor(
        id="foundation",
        title="Mode 2 of three models between pins on ground from soft to hard",
        why="docs/your-beam.md: omega^2 shifts by exactly k / (rho A).",
        along="EI/L^4",
        at=(1e-12, 1e-6, 1.0, 1e3, 1e6, 1e9, 1e12),
        beyond=(1e15, 1e18, 1e24),
        promise=SMALL,
        error=grounded_error,
        seconds=2.0,
    ),
    Floor(
        id="taut",
        title="Exact mode 3 between pins from a beam to a string",
        why="exact/modes.py: roots to rounding; (EI beta^4 + T beta^2) / (rho A) is the closed form.",
        along="EI/L^2",
        at=(1e-12, 1.0, 1e3, 1e6, 1e9, 1e12),
        beyond=(1e15, 1e20, 1e30),
        promise=SMALL,
        error=taut_error,
    ),
    Floor(
        id="close-to-buckling",
        title="Mode 1 of three models close to their buckling, error times what is left of the load",
        why="omega^2 is the load's distance from buckling: a rounding of 1.1e-16 in it is 1.1e-16 over the gap; of 40 "
        "parts each rounds a few times.",
        along="load left",
        at=(1.0, 1e-3, 1e-6, 1e-9),
        beyond=(1e-11, 1e-13),
        promise=1e-13,
        error=compressed_error,
        seconds=2.0,
    ),
    Refusal(
        id="beyond-buckling",
        title="Compression beyond buckling, three models",
        why="docs/your-beam.md: refused with the load.",
        along="load too much",
        at=(1e-9, 1e-6, 1.0, 1e6),
        names=("beam.tension", "buckl"),
        ask=crushed,
    ),
)
