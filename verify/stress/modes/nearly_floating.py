"""Beams that next to nothing holds, driven as slowly as they float: fields against the same matrices in 50 digits."""

from decimal import Decimal, localcontext
from math import pi

from msgspec.structs import replace

from verify.attached import PointSpring
from verify.beam import Beam, PointForce
from verify.models.catalogue import MODELS
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import held
from verify.stress.references.decimals import PI
from verify.stress.references.extended import answered, hermite, links
from verify.stress.references.judged import divided

PARTS = (49, 2100)
"""Of which sevenths are whole."""
LEVERS = {"load": "lever", "attachment": "lever", "reading": "raw"}
"""Forces and springs on the very joints, and joints as they stand."""
OMEGA = 0.6
"""Of what the spring alone would have the beam turn at, about."""


def about_its_pin(softness: float, *sevenths: float) -> Beam:
    """On springs of so many EI / L^3 at sevenths of it, the other end free."""
    beam = held("pinned", "free")
    stiffness = softness * beam.bending_stiffness / beam.length**3
    springs = [PointSpring(position=each / 7.0 * beam.length, stiffness=stiffness) for each in sevenths]
    return replace(beam, spring=tuple(springs))


def floating_error(softness: float) -> float:
    """Worst error of the end's deflection under a slow drive near the pin, of both models, of few parts and many.

    Few stand on two springs as well: more strains than unknowns.
    """
    beam, sprung = about_its_pin(softness, 5.0), about_its_pin(softness, 3.0, 5.0)
    hertz = OMEGA * (softness * beam.bending_stiffness / beam.mass_per_length) ** 0.5 / beam.length**2 / (2.0 * pi)
    cases = [(beam, parts) for parts in PARTS] + [(sprung, PARTS[0])]
    return largest(_error(model, one, hertz, parts) for model in ("segment", "fem") for one, parts in cases)


def _error(model: str, beam: Beam, hertz: float, parts: int) -> float:
    force = 2 * parts // 7
    springs = {round(one.position / beam.length * parts): one.stiffness for one in beam.spring}
    own = replace(divided(beam, parts), springs=springs)
    with localcontext() as context:
        context.prec = 50
        matrices, each = (links(own), 1) if model == "segment" else (hermite(own), 2)
        omega2 = (2 * PI * Decimal(hertz)) ** 2
        # a node's deflection follows its slope, and the pin has none
        end, at = (parts - 1, force - 1) if each == 1 else (2 * parts - 1, 2 * force - 1)
        exact = answered(*matrices, omega2, at)[end]
    drive = PointForce(position=force * beam.length / parts)
    more = LEVERS if model == "segment" else {}
    field = MODELS[model].solve_harmonic(beam, (drive,), hertz, parts, **more)
    return abs(float(Decimal(float(field.deflection(beam.length)[0].real)) / exact - 1))


ROWS: tuple[Row, ...] = (
    Floor(
        id="nearly-floating",
        title="Beams of 49 and 2100 parts about a pin on a spring or two, driven as slowly as they turn, in 50 digits",
        why="docs/limits.md: what next to nothing holds is answered to rounding.",
        along="L^3/EI",
        at=(1e4, 1e14),
        beyond=(1e16, 1e20),
        promise=1e-13,
        error=lambda ratio: floating_error(1.0 / ratio),
        seconds=1.0,
    ),
)
