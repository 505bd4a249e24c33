"""Many beams and many frequencies in one call: each as right as if it had been asked for alone."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import Beam, PointForce
from verify.judge.crossing import Crossing, Point, Stretch, converging, crossing
from verify.models.arrays import Array
from verify.models.catalogue import MODELS
from verify.section import Section
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP
from verify.stress.references.decimals import PI
from verify.stress.references.extended import hermite, links, relative_error
from verify.stress.references.judged import SMALL, divided
from verify.stress.waves.drives import AT, FROM, N, beam_sum, links_sum, resonance

PARTS, MODES = 24, 3
"""Of every beam."""
STEP = 0.4
"""Of a beam's length: where its section changes, and a mass stands."""


def stepped(i: int, n: int) -> Beam:
    """One of n strips of two sections between pins, no two alike."""
    length, part = 0.73 * (1.0 + i / n), 1.0 + 0.9 * i / n
    sections = (Section(length=STEP * length), Section(length=(1.0 - STEP) * length, thickness=0.0023 * part))
    return replace(STRIP, length=length, section=sections)


def loaded(i: int, n: int, model: str) -> Beam:
    """The same with a mass on its step and a spring at its free end; segments also taut and on ground."""
    beam = stepped(i, n)
    weight, stiffness = beam.mass_per_length * beam.length, beam.bending_stiffness / beam.length**3
    bears = {"tension": 3.0 * stiffness * beam.length, "foundation": 20.0 * stiffness / beam.length}
    return replace(
        beam,
        supports=("pinned", "free"),
        mass=(PointMass(position=STEP * beam.length, mass=0.3 * (1.0 + i / n) * weight),),
        spring=(PointSpring(position=beam.length, stiffness=7.0 * stiffness),),
        **(bears if model == "segment" else {}),
    )


def swept_hertz(model: str, beams: list[Beam]) -> Array:
    """Of all of them in one call, (n, MODES), Hz."""
    if model == "segment":
        from verify.segments.sweeps import sweep_modes

        return sweep_modes(beams, MODES, PARTS, attachment="lever")
    from verify.elements.sweeps import sweep_modes as sweep_elements

    return sweep_elements(beams, MODES, PARTS)


def many_error(model: str, made: Callable[[int, int], Beam]) -> Callable[[float], float]:
    """How many beams -> worst error of the first, the middle and the last, against their matrices in 50 digits."""

    def error(n: float) -> float:
        beams = [made(i, int(n)) for i in range(int(n))]
        hertz, worst = swept_hertz(model, beams), 0.0
        for i in (0, len(beams) // 2, len(beams) - 1):
            bands = _matrices(model, beams[i])
            with localcontext() as context:
                context.prec = 50
                omegas = [2 * PI * Decimal(float(one)) for one in hertz[i]]
            worst = largest(worst, *(relative_error(bands, mode, omega) for mode, omega in enumerate(omegas, start=1)))
        return worst

    return error


def _matrices(model: str, beam: Beam) -> tuple[list[list[Decimal]], list[list[Decimal]]]:
    """K and M in 50 digits, with what stands on nodes."""
    parts = divided(beam, PARTS)
    ends = np.cumsum([0.0, *map(float, parts.lengths)])

    def at(position: float) -> int:
        return int(abs(ends - position).argmin())

    parts = replace(
        parts,
        point_masses={at(mass.position): mass.mass for mass in beam.mass},
        springs={at(spring.position): spring.stiffness for spring in beam.spring},
    )
    return hermite(parts) if model == "fem" else links(parts)


def fields_error(model: str) -> Callable[[float], float]:
    """How many frequencies -> worst error of a field with losses, against its sum over modes in closed form."""

    def error(n: float) -> float:
        beam = replace(STRIP, loss_factor=0.03)
        hertz = resonance("analytic") * np.linspace(0.07, 1.93, int(n))
        more = {"load": "lever", "reading": "raw"} if model == "segment" else {}
        count = N if model == "segment" else None
        sweep = MODELS[model].sweep_harmonic(beam, (PointForce(position=FROM * beam.length / N),), hertz, count, **more)
        found = sweep.deflection([AT * beam.length / N])[:, 0]
        exact = [(links_sum if model == "segment" else beam_sum)(beam, 2.0 * pi * float(f)) for f in hertz]
        return float(abs(found / np.array(exact) - 1.0).max())

    return error


def cost_error(order: float) -> float:
    """Error of what two methods cost at an error and of where they cost the same, all of them powers of n.

    Errors n^-p and 2 n^-p, costs n and n^1.5 times what makes both cost 20 at the error 20^-p.
    """
    sizes, wanted = (12.0, 24.0, 48.0), 20.0**-order
    needed = 20.0 * 2.0 ** (1.0 / order)
    one = converging([Point(1.0 / n, n**-order, n) for n in sizes], (order, order), 1e-30)
    points = [Point(1.0 / n, 2.0 * n**-order, 20.0 * (n / needed) ** 1.5) for n in sizes]
    other = converging(points, (order, order), 1e-30)
    if not (isinstance(one, Stretch) and isinstance(other, Stretch)):
        return float("inf")
    found = crossing(one, other)
    met = found.crossings if isinstance(found, Crossing) else ()
    costs = one.seconds(wanted) / 20.0, other.seconds(wanted) / 20.0
    return largest(*(abs(cost - 1.0) for cost in costs), abs(met[0] / wanted - 1.0) if len(met) == 1 else float("inf"))


COUNTS = (9.0, 40.0, 130.0)
NAMES = (("segment", "segments"), ("fem", "elements"))
ROWS: tuple[Row, ...] = (
    *(
        Floor(
            id=f"many-stepped-{name}",
            title=f"Modes 1 to {MODES} of many stepped strips of {name} in one call, against matrices in 50 digits",
            why="models/stacks.py: each as certain as if it had been solved alone; rounding below 1e-12.",
            along="beams",
            at=COUNTS,
            promise=SMALL,
            error=many_error(model, stepped),
        )
        for model, name in NAMES
    ),
    *(
        Floor(
            id=f"many-loaded-{name}",
            title=f"The same with a mass and a spring on each{', taut and on ground' if model == 'segment' else ''}",
            why="The same.",
            along="beams",
            at=COUNTS,
            promise=SMALL,
            error=many_error(model, lambda i, n, model=model: loaded(i, n, model)),  # type: ignore[misc]
        )
        for model, name in NAMES
    ),
    *(
        Floor(
            id=f"many-frequencies-{name}",
            title=f"Fields of {name} at many frequencies in one call, loss factor 3 %, against all modes",
            why="exact/sweeps.py, segments/sweeps.py: as one by one, 1e-12 of 40 parts.",
            along="frequencies",
            at=(2.0, 9.0, 20.0),
            promise=SMALL,
            error=fields_error(model),
        )
        for model, name in (("analytic", "the-exact-beam"), ("segment", "segments"))
    ),
    Floor(
        id="cost-at-an-error",
        title="What a method costs at an error, and where the cheaper changes, of costs and errors that are powers",
        why="judge/crossing.py: straight lines in logarithms, which powers are.",
        along="order",
        at=(1.0, 2.0, 4.0),
        promise=1e-12,
        error=cost_error,
    ),
)
