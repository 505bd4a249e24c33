"""Figures with a law of their own that no scene's beam shows: roots of all supports, splines, contacts, orders."""

from collections.abc import Callable
from decimal import Decimal, localcontext
from math import acos, asin, cos, log, pi, sin, sqrt

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass
from verify.beam import Beam, PointForce
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STEPPED, STRIP, held
from verify.stress.references.decimals import PI
from verify.stress.references.decimals import cos as cosine
from verify.stress.references.decimals import exp as exponential
from verify.stress.references.decimals import sin as sine

# --- Frequencies between all supports ---------------------------------------------------------------------------------

SUPPORTS: dict[tuple[str, str], tuple[str, tuple[int, int, int]]] = {
    ("pinned", "pinned"): ("0", (1, 0, 0)),
    ("guided", "guided"): ("0", (1, 0, 0)),
    ("guided", "pinned"): ("-0.5", (0, 1, 0)),
    ("clamped", "clamped"): ("0.5", (0, 1, -1)),
    ("free", "free"): ("0.5", (0, 1, -1)),
    ("clamped", "free"): ("-0.5", (0, 1, 1)),
    ("clamped", "pinned"): ("0.25", (1, -1, 0)),
    ("pinned", "free"): ("0.25", (1, -1, 0)),
    ("guided", "clamped"): ("-0.25", (1, 1, 0)),
    ("free", "guided"): ("-0.25", (1, 1, 0)),
}
"""Turns beside the mode's number, and s, c, h of s sin y + c cos y + h / cosh y; with s and c, c is over coth y."""


def exact_root(supports: tuple[str, str], mode: int) -> Decimal:
    """Beta L of a mode by Newton in 60 digits, from its turns."""
    turns, (s, c, h) = SUPPORTS[supports]
    with localcontext() as context:
        context.prec = 60
        y = (mode + Decimal(turns)) * PI
        for _ in range(60):
            falling = exponential(-y)
            sech = 2 * falling / (1 + falling * falling)
            tanh = (1 - falling * falling) / (1 + falling * falling) if s and c else Decimal(1)
            rest = s * sine(y) + c * cosine(y) * tanh + h * sech
            slope = s * cosine(y) - c * sine(y) * tanh + (c * cosine(y) * sech**2 if s and c else 0) - h * sech * tanh
            step = rest / slope
            y -= step
            if abs(step) < Decimal(10) ** -40:
                break
        return y


def all_roots_error(mode: float) -> float:
    """Worst relative error of beta L of a mode over ten pairs of supports, and of their mirror images."""
    from verify.exact.closed_forms import wavenumber_length

    worst = 0.0
    for pair in SUPPORTS:
        exact = exact_root(pair, int(mode))
        worst = largest(
            worst, *(abs(float(Decimal(wavenumber_length(p, int(mode))) / exact - 1)) for p in (pair, pair[::-1]))
        )
    return worst


def many_exact_error(n: float) -> float:
    """Worst error of three frequencies each of n uniform beams between all supports in one call."""
    from verify.exact.sweeps import sweep_modes

    pairs = list(SUPPORTS)
    beams = [replace(held(*pairs[i % len(pairs)]), length=0.3 + 0.01 * i) for i in range(int(n))]
    found, worst = sweep_modes(beams, 3), 0.0
    for row, beam in zip(found, beams, strict=True):
        for mode, hertz in enumerate(row, start=1):
            exact = exact_root(beam.supports, mode) ** 2 * Decimal(beam.wave_constant) / Decimal(beam.length) ** 2
            worst = largest(worst, abs(float(2 * PI * Decimal(float(hertz)) / exact - 1)))
    return worst


# --- Splines ----------------------------------------------------------------------------------------------


def spline_error(pieces: float) -> float:
    """Error of a spline and its derivatives through a cubic (one piece: a line, two: a parabola), over nodes^2."""
    from verify.models.spline import natural_or_flat

    n = int(pieces)
    nodes = np.cumsum(1.0 + 0.4 * np.cos(np.arange(n + 1.0)))
    nodes = (nodes - nodes[0]) / (nodes[-1] - nodes[0])
    powers = np.polynomial.Polynomial([0.3, -1.1, 0.7, 1.9][: min(n, 3) + 1])
    found = natural_or_flat(nodes, powers(nodes)[None], (0, 0))
    x, worst = np.linspace(0.0, 1.0, 41)[:-1], 0.0
    for derivative in range(4):
        exact = powers.deriv(derivative)(x) if derivative else powers(x)
        worst = largest(worst, float(abs(found(x, derivative)[0] - exact).max()))
    return worst / float(nodes.size) ** 2


# --- Shapes -----------------------------------------------------------------------------------------------------------


def curvature_error(parts: float) -> float:
    """Curvatures of modes 1 and 2 where models know them best, against -k^2 of their sines, by (k l)^2 / 12.

    And deflections likewise at the points that models know, which lie evenly from end to end.
    """
    from verify.models.catalogue import MODELS

    worst, n = 0.0, int(parts)
    for model, beam, settings in (
        ("segment", STRIP, {}),
        ("segment", TAUT, {"joints": "tensioned"}),
        ("fem", STRIP, {}),
    ):
        modes = MODELS[model].solve_modes(beam, 2, n, **settings)
        even = np.linspace(0.0, beam.length, len(modes.points))
        worst = largest(worst, float(abs(modes.points - even).max()) * n / beam.length)
        for mode, (found, sampled) in enumerate(zip(modes.curvatures(), modes.sampled(), strict=True), start=1):
            k = mode * pi / STRIP.length
            size = sqrt(2.0 / (STRIP.mass_per_length * STRIP.length))
            exact = -size * k**2 * np.sin(k * modes.curvature_points)
            off = abs(found - exact).max() / k**2, abs(sampled - size * np.sin(k * even)).max()
            worst = largest(worst, float(largest(off)) / size / ((mode * pi / n) ** 2 / 12.0))
    return worst


def edges_error(links: float) -> float:
    """Deflection, slope and bend of the rigid links themselves against straight lines between joints of a sine."""
    from verify.models.catalogue import MODELS

    n = int(links)
    basis = MODELS["segment"].time_basis(STRIP, n, 2, "raw")
    x = (np.arange(n) + 0.37) * STRIP.length / n
    places, slopes, bends = (basis.shapes(x, derivative)[0] for derivative in range(3))
    joints = np.sin(pi * np.arange(n + 1.0) / n)
    exact = joints[:-1] + 0.37 * np.diff(joints)
    rises = np.diff(joints) * n / STRIP.length
    size = places[0] / exact[0]
    off = [places / size - exact, (slopes / size - rises) * STRIP.length, bends / size]
    return largest(float(abs(one).max()) for one in off)


def seen_error(places: float) -> float:
    """Of two waves seen in time at so many places: reflection, power and speed of the crests, k given, worst."""
    from verify.waves.series import measure_series

    hertz, forward, backward = 370.0, 1.3e-6, 0.4e-6
    omega, k = 2.0 * pi * hertz, sqrt(2.0 * pi * hertz / STRIP.wave_constant)
    times, x = np.linspace(0.0, 3.0 / hertz, 91)[:-1, None], np.linspace(0.1, 0.6, int(places))
    values = forward * np.cos(omega * times - k * x) + backward * np.cos(omega * times + k * x + 0.7)
    found = measure_series(STRIP, x, times[:, 0], values, hertz, k)
    apart, size = forward**2 - backward**2, sqrt(forward**2 + backward**2)
    power = STRIP.bending_stiffness * k**3 * omega * apart
    crests = -omega * STRIP.surface_distance * k * apart / size
    pairs = ((found.reflection, backward / forward), (found.energy_flux, power), (found.crest_speed, crests))
    return largest(abs(value / exact - 1.0) for value, exact in pairs)


def map_error(phase: float) -> float:
    """Figures of a map under two forces at a phase, degrees, against those of fields by themselves, of waves alone."""
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.measures import measure
    from verify.waves.unit_waves import FIGURES, Gaps, UnitDrive, superposed

    places, window, hertz = (0.1, 0.6), (0.26, 0.44), np.array([37000.0, 39100.0])
    beam = replace(STRIP, loss_factor=0.013)
    drive = UnitDrive(beam=beam, model="analytic", count=None, kind="force", places=places, window=window)
    turned = np.array([0.8 * np.exp(1j * np.deg2rad(phase))])
    found, worst = superposed(drive, tuple(FIGURES), hertz, 1.0 + 0.0j, turned, Gaps()), 0.0
    forces = (PointForce(position=places[0]), PointForce(position=places[1], amplitude=0.8, phase_deg=phase))
    for i, frequency in enumerate(hertz):
        measured = measure(solve_harmonic(beam, forces, float(frequency)), window)
        for name, one in zip(FIGURES, found, strict=True):
            worst = largest(worst, abs(float(one[i, 0]) / getattr(measured, name) - 1.0))
    return worst


# --- Contacts ---------------------------------------------------------------------------------------------------------


def _integral(of: Callable[[float], float], end: float) -> float:
    """From 0 to an end by Gauss's rule of 60 points."""
    x, weights = np.polynomial.legendre.leggauss(60)
    at = 0.5 * end * (x + 1.0)
    return 0.5 * end * float(weights @ [of(float(t)) for t in at])


def contact_error(load: float) -> float:
    """Of contacts under a load below 1, against integrals of their pressure: half angle, forces on both kinds.

    A layer presses with cos s - cos phi, a half-space with cos(s/2) sqrt(sin^2(phi/2) - sin^2(s/2)), where sin(s/2) is
    sqrt(q) sin t; where the surface runs faster than the slider friction drives.
    """
    from verify.contact.foot import contact_half_angle, foot_force
    from verify.contact.layer import half_space_force

    phi, r = contact_half_angle(load), 0.37

    def pressure(s: float) -> float:
        return cos(s) - cos(phi)

    whole = _integral(pressure, phi)
    layer = 2.0 * _integral(pressure, min(acos(r), phi)) / whole - 1.0
    driven = asin(min(sin(0.5 * acos(r)) / sqrt(load), 1.0))
    space = 2.0 * _integral(lambda t: cos(t) ** 2, driven) / (0.25 * pi) - 1.0
    return largest(
        abs(whole / (pi * load) - 1.0), abs(foot_force(load, r) - layer), abs(half_space_force(load, r) - space)
    )


def bounce_error(restitution: float) -> float:
    """Of bouncing in step: at its two limits a multiplier is 1 and -1, the other e^2 of it with its sign."""
    from verify.contact.bouncing import bounce_in_step, bouncing_limits

    square, worst = restitution**2, 0.0
    for ratio, edge in zip(bouncing_limits(restitution), (1.0, -1.0), strict=True):
        multipliers = bounce_in_step(ratio, restitution).multipliers
        worst = largest(
            worst, abs(sum(multipliers) - edge * (1.0 + square)), abs(multipliers[0] * multipliers[1] - square)
        )
    return worst


# --- Orders -----------------------------------------------------------------------------------------------------------

TURNING = replace(STRIP, mass=(PointMass(position=0.29, mass=0.05, rotary_inertia=3e-4),))
CLAMPED, TAUT = held("clamped", "free"), replace(STRIP, tension=70.0)
RULES: tuple[tuple[str, Beam, dict[str, str | float]], ...] = (
    ("segment", STRIP, {}),
    ("segment", STRIP, {"grading": 2.0}),
    ("segment", CLAMPED, {"wall": "half"}),
    ("segment", CLAMPED, {"wall": "welded"}),
    ("segment", CLAMPED, {"wall": "third-order"}),
    ("segment", CLAMPED, {"wall": "five-joint"}),
    ("segment", TAUT, {}),
    ("segment", TAUT, {"joints": "tensioned"}),
    ("segment", TURNING, {}),
    ("segment", STRIP, {"theory": "timoshenko", "joints": "tensioned"}),
    ("fem", CLAMPED, {}),
    ("fem", STEPPED, {"grading": 2.0}),
)


FINER = {"five-joint": (3, 10)}
"""On which mode and at how many times the parts: one order on, its next term is as large as the first elsewhere."""


def order_error(count: float) -> float:
    """How far orders observed on mode 2 at N, 2N and 4N lie from those that models say of beams and rules."""
    from verify.judge.compare import observed_order
    from verify.judge.workbench import Workbench
    from verify.models.catalogue import MODELS

    worst = 0.0
    for model, beam, settings in RULES:
        bench, (mode, finer) = Workbench(beam), FINER.get(str(settings.get("wall")), (2, 1))
        counts = tuple(int(count) * finer * times for times in (1, 2, 4))
        errors = [bench.frequency_error(model, size, mode, tuple(settings.items())) for size in counts]
        worst = largest(worst, abs(observed_order(counts, errors) - (MODELS[model].order(beam, **settings) or 0)))
    return worst


def field_order_error(number: float) -> float:
    """Of the order of a chain's driven field, rms over the beam, between 107 and 863 links, against what is told."""
    from verify.models.catalogue import MODELS

    beam = FIELDS[int(number)]
    places, sizes = np.linspace(0.0, beam.length, 4001), (107, 863)
    exact = MODELS["analytic"].solve_harmonic(beam, FIELD_FORCES, 61.0, None).deflection(places)
    fields = [MODELS["segment"].solve_harmonic(beam, FIELD_FORCES, 61.0, n).deflection(places) for n in sizes]
    coarse, fine = (float(np.sqrt(np.mean(abs(field - exact) ** 2))) for field in fields)
    return abs(log(coarse / fine) / log(sizes[1] / sizes[0]) - float(MODELS["segment"].field_order(beam) or 0.0))


_TURNING = PointMass(position=0.3391, mass=0.02, rotary_inertia=3e-5)
FIELDS = (
    held("pinned", "pinned"),
    held("clamped", "free"),
    replace(held("pinned", "guided"), mass=(_TURNING,)),
    replace(held("pinned", "pinned"), mass=(replace(_TURNING, rotary_inertia=0.0),)),
)
FIELD_FORCES = (PointForce(position=0.2113), PointForce(position=0.5171, amplitude=0.7, phase_deg=80.0))


ROWS: tuple[Row, ...] = (
    Floor(
        id="frequencies-of-all-supports",
        title="Beta L between ten pairs of supports and their mirror images, against Newton in 60 digits",
        why="exact/closed_forms.py: to rounding; five operations on doubles of 1.1e-16 each.",
        along="mode",
        at=(1, 2, 3, 10, 100),
        promise=6e-16,
        error=all_roots_error,
    ),
    Floor(
        id="many-exact-beams",
        title="Three frequencies of many uniform beams between all supports in one call",
        why="exact/sweeps.py: closed forms, a few roundings more.",
        along="beams",
        at=(9, 40),
        promise=2e-15,
        error=many_exact_error,
    ),
    Floor(
        id="splines",
        title="A spline through a cubic, a parabola of two pieces, and derivatives, over the square of its nodes",
        why="models/spline.py: the last two pieces are one cubic, so that a cubic is itself; a third derivative has "
        "the rounding of values over the cube of a piece.",
        along="pieces",
        at=(1, 2, 3, 12, 300),
        promise=1e-11,
        error=spline_error,
    ),
    Floor(
        id="curvatures",
        title="Curvatures and deflections of modes 1 and 2 with their signs, at even places, over (k l)^2 / 12",
        why="segments/links.py, elements/linear.py: read where they are of order 4; a plain difference "
        "leaves a twelfth of (k l)^2.",
        along="parts",
        at=(10, 20, 40),
        promise=0.05,
        error=curvature_error,
    ),
    Floor(
        id="edges-of-links",
        title="Deflection, slope and bend of the rigid links themselves, against lines between joints of a sine",
        why="segments/in_time.py: straight between joints that lie on a sine, to rounding.",
        along="links",
        at=(6, 49),
        promise=1e-12,
        error=edges_error,
    ),
    Floor(
        id="waves-seen-in-time",
        title="Reflection, power and speed of crests of two waves seen in time at some places",
        why="waves/series.py: phasors by least squares, two waves by their wavenumber, to rounding.",
        along="places",
        at=(5, 9, 33),
        promise=1e-11,
        error=seen_error,
    ),
    Floor(
        id="figures-of-a-map",
        title="Reflection, standing-wave ratio, crest speed and power of a map, against fields measured one by one",
        why="waves/unit_waves.py: unit waves superposed, the same waves to rounding.",
        along="degrees",
        at=(10.0, 90.0, 170.0),
        promise=1e-11,
        error=map_error,
    ),
    Floor(
        id="contacts-as-integrals",
        title="Half angle and force of a foot on a layer, force on a half-space, against integrals of their pressures",
        why="contact/foot.py, contact/layer.py: closed forms and a root to rounding.",
        along="load",
        at=(0.01, 0.3, 0.99),
        promise=1e-13,
        error=contact_error,
    ),
    Floor(
        id="bounces-at-their-limits",
        title="Multipliers of bouncing in step at its limits: 1 and -1, product e^2",
        why="contact/bouncing.py: the least ratio is a fold, the largest a doubling of the period.",
        along="restitution",
        at=(0.0, 0.3, 0.9),
        promise=1e-13,
        error=bounce_error,
    ),
    Floor(
        id="orders-as-told",
        title="Observed orders of twelve beams and rules against those that models say",
        why="judge/subjects.py: the leading order; from 20 parts on the next one takes off a tenth at most.",
        along="parts",
        at=(20, 30),
        promise=0.1,
        error=order_error,
    ),
    Floor(
        id="orders-of-fields",
        title="Observed orders of driven fields of four chains, rms over the beam, against those that are told",
        why="segments/orders.py: h^3 or h^2 over a link beside forces, walls and what turns; h^4 is lost beside it.",
        along="chain",
        at=(0, 1, 2, 3),
        promise=0.25,
        error=field_order_error,
    ),
)
