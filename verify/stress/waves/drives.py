"""Driven fields close to resonances, heavily damped, slow, short-waved, and at the far end of long beams."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from math import pi

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.models.catalogue import MODELS
from verify.stress.kind import Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP, held
from verify.stress.references.decimals import PI, exp, sin

N = 40
MODE = 3
AT, FROM = 11, 17
"""Joints where the field is read and driven."""
COUNTS = {"analytic": None, "segment": N, "fem": N}


def deflection(model: str, beam: Beam, hertz: float, x: float, at: float, **more: str) -> complex:
    """Of a model at a place under a unit force at x."""
    field = MODELS[model].solve_harmonic(beam, (PointForce(position=x),), hertz, COUNTS[model], **more)
    return complex(field.deflection([at])[0])


def resonance(model: str) -> float:
    """Hz, of mode 3 of the pinned strip, known without a solver."""
    from verify.exact.closed_forms import frequency_hz
    from verify.exact.error_laws import dispersion_frequency_hz

    return frequency_hz(STRIP, MODE) if model == "analytic" else dispersion_frequency_hz(model, STRIP, MODE, N)


def moved_error(model: str) -> Callable[[float], float]:
    """A distance from resonance -> by how much, relative, the frequency would have to be wrong to explain the field.

    Close to it the field is its residue over the distance, and a frequency wrong by e moves it by e over the distance.
    The residue is read at a distance of 1e-5 on both sides, where the rest of the field cancels.
    """

    def error(distance: float) -> float:
        x, at = FROM * STRIP.length / N, AT * STRIP.length / N
        hertz = resonance(model)

        def answer(part: float) -> tuple[float, float]:
            driven = hertz * (1.0 + part)
            real = driven / hertz - 1.0
            return real, deflection(model, STRIP, driven, x, at).real

        (up, above), (down, below) = answer(1e-5), answer(-1e-5)
        # w = r / d + s near d = 0: two readings give r and s, to 1e-10 of w at the distance of 1e-9
        residue = (above - below) / (1.0 / up - 1.0 / down)
        rest = above - residue / up
        real, found = answer(distance)
        return abs(real) * abs(found / (residue / real + rest) - 1.0)

    return error


def loss_error(model: str) -> Callable[[float], float]:
    """A loss factor -> error of the field against its sum over modes, known in closed form.

    Of the exact beam 200 000 of them, whose tail is 1e-16 of it; of links all of theirs: K_n = (2 sin(a/2))^4 and
    M_n = (2 + cos a) / 3 with a = n pi / N, a force and a reading on joints.
    """

    def error(eta: float) -> float:
        beam = replace(STRIP, loss_factor=eta)
        hertz = 1.37 * resonance("analytic")
        x, at = FROM * beam.length / N, AT * beam.length / N
        more = {"load": "lever", "reading": "raw"} if model == "segment" else {}
        found = deflection(model, beam, hertz, x, at, **more)
        exact = (links_sum if model == "segment" else beam_sum)(beam, 2.0 * pi * hertz)
        return abs(found / exact - 1.0)

    return error


def beam_sum(beam: Beam, omega: float) -> complex:
    """A pinned beam's field at `AT` under a unit force at `FROM`, over 200 000 modes, m."""
    n = np.arange(200_000, 0, -1.0)
    squares = (beam.wave_constant * (n * pi / beam.length) ** 2) ** 2
    shapes = np.sin(n * pi * AT / N) * np.sin(n * pi * FROM / N)
    terms = shapes / (squares * (1.0 + 1j * beam.loss_factor) - omega**2)
    return complex(2.0 * terms.sum() / (beam.mass_per_length * beam.length))


def links_sum(beam: Beam, omega: float) -> complex:
    """The same of its chain of N links, over all their modes."""
    angle = np.arange(1, N) * pi / N
    length = beam.length / N
    stiffness = beam.bending_stiffness / length**3 * (2.0 * np.sin(angle / 2.0)) ** 4 * (1.0 + 1j * beam.loss_factor)
    inertia = beam.mass_per_length * length * (2.0 + np.cos(angle)) / 3.0 * omega**2
    shapes = np.sin(AT * angle) * np.sin(FROM * angle)
    return complex((2.0 / N * shapes / (stiffness - inertia)).sum())


def slow_error(hertz: float) -> float:
    """Error of a cantilever's tip under a force there, all but at rest, against F L^3 / 3 EI, the worst model."""
    beam = held("clamped", "free")
    still = beam.length**3 / (3.0 * beam.bending_stiffness)
    tips = (deflection(model, beam, hertz, beam.length, beam.length).real for model in ("analytic", "fem"))
    return largest(abs(float(tip) / still - 1.0) for tip in tips)


def printed_slow_error(hertz: float) -> float:
    """The same by the printed dynamic stiffness, (cosh sin - sinh cos) / (EI k^3 (1 + cos cosh))."""
    beam = held("clamped", "free")
    k = np.sqrt(2.0 * pi * hertz / beam.wave_constant)
    y = k * beam.length
    shape = np.cosh(y) * np.sin(y) - np.sinh(y) * np.cos(y)
    tip = shape / (beam.bending_stiffness * k**3 * (1.0 + np.cos(y) * np.cosh(y)))
    return abs(float(tip) / (beam.length**3 / (3.0 * beam.bending_stiffness)) - 1.0)


def short_wave_error(waves: float) -> float:
    """Half waves along a pinned beam -> error of the exact field over what one rounding of the frequency moves.

    Against its closed form in decimals; the field is read between its nodes.
    """
    beam = replace(STRIP, length=1.0)
    hertz = (waves * pi) ** 2 * beam.wave_constant / (2.0 * pi)
    x, at = 0.4375, 0.28125
    found = deflection("analytic", beam, hertz, x, at).real
    exact, slope = _pinned_field(beam, hertz, at, x)
    return abs(found - float(exact)) / max(abs(float(exact)), abs(float(slope)))


def _pinned_field(beam: Beam, hertz: float, at: float, x: float) -> tuple[Decimal, Decimal]:
    """(deflection under a unit force, k L dw/d(kL) of its waves) by sines of any argument."""
    with localcontext() as context:
        context.prec = 50
        k = (2 * PI * Decimal(hertz) / Decimal(beam.wave_constant)).sqrt()
        length, a, b = Decimal(beam.length), Decimal(at), Decimal(x)
        scale = 1 / (2 * Decimal(beam.bending_stiffness) * k**3)
        running = sin(k * a) * sin(k * (length - b)) / sin(k * length)
        near = exp(-k * (b - a)) * (1 - exp(-2 * k * a)) * (1 - exp(-2 * k * (length - b)))
        still = near / (2 * (1 - exp(-2 * k * length)))
        moved = k * length * scale / sin(k * length) ** 2
        return scale * (running - still), moved


def printed_short_wave_error(waves: float) -> float:
    """The same by hyperbolic sines as printed."""
    beam = replace(STRIP, length=1.0)
    hertz = (waves * pi) ** 2 * beam.wave_constant / (2.0 * pi)
    x, at = 0.4375, 0.28125
    k = np.sqrt(2.0 * pi * hertz / beam.wave_constant)
    parts = [f(k * at) * f(k * (1.0 - x)) / f(k) for f in (np.sin, np.sinh)]
    found = (parts[0] - parts[1]) / (2.0 * beam.bending_stiffness * k**3)
    exact, slope = _pinned_field(beam, hertz, at, x)
    return abs(float(found) - float(exact)) / max(abs(float(exact)), abs(float(slope)))


def far_error(length: float) -> float:
    """Worst difference of a field at the far end of a beam from its mirror image at the near one, three models.

    Force and reading stand on joints within a tenth of the beam; a beam knows of no origin but its left end.
    """
    beam = replace(STRIP, length=length)
    hertz = 1.37 * 9.0 * pi / 2.0 * beam.wave_constant / length**2
    worst = 0.0
    for model in COUNTS:
        x, at = 2 * length / N, 3 * length / N
        near = deflection(model, beam, hertz, x, at)
        far = deflection(model, beam, hertz, length - x, length - at)
        worst = largest(worst, abs(far / near - 1.0))
    return worst


def stock_far_error(start: float) -> float:
    """Stock scikit-fem with its mesh from `start` metres on: mode 3 against that of a mesh from 0 on."""
    from verify.elements.stock import stock_frequency_hz

    beam = replace(STRIP, length=1.0)
    return abs(stock_frequency_hz(beam, MODE, N, start) / stock_frequency_hz(beam, MODE, N) - 1.0)


def _refused_at(model: str) -> Callable[[float], complex]:
    def ask(distance: float) -> complex:
        return deflection(model, STRIP, resonance(model) * (1.0 + distance), 0.3 * STRIP.length, 0.2)

    return ask


def _lossy(eta: float) -> float:
    return replace(STRIP, loss_factor=eta).loss_factor


def _waves(waves: float) -> complex:
    hertz = (waves * pi / STRIP.length) ** 2 * STRIP.wave_constant / (2.0 * pi)
    return deflection("analytic", STRIP, hertz, 0.3, 0.2)


TITLES = {"analytic": "exact beam", "segment": "segments", "fem": "elements"}
ROWS: tuple[Row, ...] = (
    *(
        Floor(
            id=f"near-resonance-{name.replace(' ', '-')}",
            title=f"Undamped {name} close to resonance, as an error of the frequency that would explain the field",
            why="docs/findings: rounding below 1e-12; models/fields.py: driven no closer than 1e-9, refused nearer.",
            along="off resonance",
            at=(1e-6, 1e-7, 1e-8, 3e-9),
            beyond=(1e-9, 1e-10, 1e-12),
            promise=1e-13,
            error=moved_error(model),
        )
        for model, name in TITLES.items()
    ),
    *(
        Refusal(
            id=f"at-resonance-{name.replace(' ', '-')}",
            title=f"Undamped {name} driven within 1e-12 of resonance",
            why="models/fields.py RESONANCE: nearer than 1e-9 the answer would be rounding.",
            along="off resonance",
            at=(0.0, 1e-10, -1e-11, 1e-12),
            names=("frequency_hz", "resonance of mode 3", "loss_factor"),
            ask=_refused_at(model),
            taken=(3e-9, -3e-9),
        )
        for model, name in TITLES.items()
    ),
    Floor(
        id="loss-factors-exact",
        title="The exact field with loss factors from none to ten, against 200 000 modes",
        why="exact/harmonic.py: no truncation; rounding of waves over 4 half waves and of the sum, 1e-12.",
        along="loss factor",
        at=(0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 9.99),
        promise=1e-12,
        error=loss_error("analytic"),
    ),
    Floor(
        id="loss-factors-segments",
        title="The field of segments with loss factors from none to ten, against all their modes",
        why="models/eigen.py: solved through the mixed matrix; 40 parts, 1e-12.",
        along="loss factor",
        at=(0.0, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 9.99),
        promise=1e-12,
        error=loss_error("segment"),
    ),
    Refusal(
        id="loss-factors-beyond",
        title="Loss factors of ten and more, or below none",
        why="beam.py: a loss factor lies from 0 to below 10.",
        along="loss factor",
        at=(10.0, 1e6, -1e-9),
        names=("beam.loss_factor",),
        ask=_lossy,
        taken=(0.0, 9.99),
    ),
    Floor(
        id="slow-drive",
        title="A cantilever's tip driven ever more slowly, against F L^3 / 3 EI",
        why="exact/harmonic.py slow_shapes: as k goes to 0, the static beam; elements bend exactly under a tip force.",
        along="Hz",
        at=(1e-7, 1e-9, 1e-12, 1e-30, 1e-100),
        promise=1e-12,
        error=slow_error,
        beside=printed_slow_error,
        textbook="printed dynamic stiffness",
    ),
    Floor(
        id="short-waves",
        title="The exact field of ever shorter waves against sines of 50 digits, over what k L = 1 moves",
        why="k L is rounded a few times at 1.1e-16 of it each; the error is over k L dw/d(kL).",
        along="half waves",
        at=(3.3, 33.3, 333.3, 3333.3, 33333.3, 333333.3),
        promise=2e-15,
        error=short_wave_error,
        beside=printed_short_wave_error,
        textbook="sines and hyperbolic sines",
    ),
    Refusal(
        id="too-many-waves",
        title="More than a million waves along the beam",
        why="beam.py MOST_WAVES: their phase loses its digits.",
        along="half waves",
        at=(1e7, 1e12, 1e30),
        names=("frequency_hz", "waves"),
        ask=_waves,
        taken=(1e5 + 0.3,),
    ),
    Floor(
        id="far-from-the-origin",
        title="The far end of a long beam against the near one, three models",
        why="Places are counted from the left end, so that x near L has the rounding of x: 1e-12 of 40 parts.",
        along="m",
        at=(1e-3, 1.0, 1e3, 1e6, 1e9),
        promise=1e-12,
        error=far_error,
        beside=stock_far_error,
        beside_at=(0.0, 1.0, 10.0, 100.0, 1e3),
        textbook="stock scikit-fem Hermite, mesh starting so far out",
    ),
)
