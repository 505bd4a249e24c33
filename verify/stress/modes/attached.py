"""What stands on a beam from nothing to endless: masses, springs, ground, axial force."""

from decimal import Decimal, localcontext

from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam
from verify.errors import InputError
from verify.models.catalogue import MODELS
from verify.stress.kind import Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held
from verify.stress.references.decimals import PI
from verify.stress.references.extended import Divided
from verify.stress.references.judged import SMALL, N, divided, frequency, judged, lapack_error

CANTILEVER = held("clamped", "free")
FREE = held("free", "free")
FIRST_FREE_ROOT = Decimal("4.7300407448627040260240481")
"""Of cosh x cos x = 1."""
OWN_MASS = CANTILEVER.mass_per_length * CANTILEVER.length
OWN_STIFFNESS = CANTILEVER.bending_stiffness / CANTILEVER.length**3


def with_tip_mass(ratio: float) -> tuple[Beam, Divided]:
    """A cantilever with a tip mass of so many times its own."""
    mass = ratio * OWN_MASS
    beam = replace(CANTILEVER, mass=(PointMass(position=CANTILEVER.length, mass=mass),))
    return beam, replace(divided(CANTILEVER, N), point_masses={N: mass})


def with_tip_spring(ratio: float) -> tuple[Beam, Divided]:
    """A cantilever with a tip spring of so many times EI / L^3."""
    stiffness = ratio * OWN_STIFFNESS
    beam = replace(CANTILEVER, spring=(PointSpring(position=CANTILEVER.length, stiffness=stiffness),))
    return beam, replace(divided(CANTILEVER, N), springs={N: stiffness})


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
            worst = largest(worst, abs(float(Decimal(frequency(model, beam, 2, count)) / exact - 1)))
    return worst


def nearly_rigid_error(ratio: float) -> float:
    """Worst error of modes 1 to 3 of a free bar on ground of so many EI / L^4, soft: it bounces, and bends first.

    Of 49 parts against their own matrices in 50 digits, of 2000 against beam theory, from which they are 1e-13 off.
    """
    beam = replace(FREE, foundation=ratio * FREE.bending_stiffness / FREE.length**4)
    worst = max(judged(model, beam, divided(beam, 49), mode, 49) for model in ("segment", "fem") for mode in (1, 3))
    with localcontext() as context:
        context.prec = 50
        own, added = Decimal(beam.wave_constant), Decimal(beam.foundation) / Decimal(beam.mass_per_length)
        roots = Decimal(0), Decimal(0), FIRST_FREE_ROOT
        exact = [(((root / Decimal(beam.length)) ** 2 * own) ** 2 + added).sqrt() / (2 * PI) for root in roots]
        for model in ("segment", "fem"):
            found = MODELS[model].solve_modes(beam, 3, 2000).frequencies_hz
            worst = largest(worst, *(abs(float(Decimal(float(f)) / e - 1)) for f, e in zip(found, exact, strict=True)))
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
    return beam, None if model == "analytic" else divided(beam, N)


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
        worst = largest(worst, gap * error)
    return worst


def softly_held_buckling_error(softness: float) -> float:
    """Of the loads at which 49 and 2000 parts of a free bar on ground of EI / L^4 over `softness` tip over.

    It turns as a whole, under k L^2 / 12. Of that its bending under k x takes the 2520th part of k L^4 / EI, to first
    order: the integral of M^2 / EI, M'' = -k x between free ends.
    """
    beam = replace(FREE, foundation=FREE.bending_stiffness / FREE.length**4 / softness)
    exact = MODELS["analytic"].buckling_load(beam, None)
    tipping = beam.foundation * beam.length**2 / 12.0 * (1.0 - 1.0 / (2520.0 * softness))
    found = [MODELS[model].buckling_load(beam, count) for model in ("segment", "fem") for count in (49, 2000)]
    return largest(0.0, *(abs(one / exact - 1.0) for one in found), abs(exact / tipping - 1.0))


def crushed(excess: float) -> float:
    """The models' mode 1 beyond buckling, each in turn; the first that answers."""
    said: InputError | None = None
    for model in ("analytic", "segment", "fem"):
        beam = replace(STRIP, tension=-(1.0 + excess) * buckling(model))
        try:
            return frequency(model, beam, 1, None if model == "analytic" else N)
        except InputError as error:
            said = error
    assert said is not None
    raise said


ROWS: tuple[Row, ...] = (
    Floor(
        id="tip-mass",
        title="Mode 1 of a cantilever of elements under a tip mass, against its matrices in 50 digits",
        why="docs/findings: rounding below 1e-12; elements keep point masses apart from what bends.",
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
        id="nearly-rigid",
        title="Modes 1 to 3 of a free bar of 49 and of 2000 parts on ground from the hardest to next to nothing",
        why="docs/your-beam.md: omega^2 shifts by exactly k / (rho A); what bends is not drowned by what bounces, and "
        "what ground lifts all alike is told apart.",
        along="L^4/EI",
        at=(1e-16, 1e-8, 1e6, 1e12),
        promise=SMALL,
        error=lambda ratio: nearly_rigid_error(1.0 / ratio),
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
    Floor(
        id="softly-held-buckling",
        title="Loads at which a free bar on soft ground tips over, 49 and 2000 parts against the exact equation",
        why="models/compression.py: loads are read from strains of a refined solution, whatever holds the beam softly.",
        along="L^4/EI",
        at=(1e6, 1e9, 1e12, 1e15),
        promise=SMALL,
        error=softly_held_buckling_error,
        seconds=4.0,
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
