"""Figures with a law of their own that no scene's beam shows: roots of all supports, splines, schemes, contacts."""

from collections.abc import Callable
from dataclasses import replace as changed
from decimal import Decimal, localcontext
from math import acos, asin, cos, pi, sin, sqrt

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.stress.beams import STEPPED, STRIP, held
from verify.stress.decimals import PI
from verify.stress.decimals import cos as cosine
from verify.stress.decimals import exp as exponential
from verify.stress.decimals import sin as sine
from verify.stress.kind import Floor, Row

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
        worst = max(
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
            worst = max(worst, abs(float(2 * PI * Decimal(float(hertz)) / exact - 1)))
    return worst


# --- Splines and schemes ----------------------------------------------------------------------------------------------


def spline_error(pieces: float) -> float:
    """Error of a spline through a cubic and of its derivatives, over the largest value of each; a parabola of two."""
    from verify.models.spline import natural_or_flat

    n = int(pieces)
    nodes = np.cumsum(1.0 + 0.4 * np.cos(np.arange(n + 1.0)))
    nodes = (nodes - nodes[0]) / (nodes[-1] - nodes[0])
    powers = np.polynomial.Polynomial([0.3, -1.1, 0.7, 1.9][: min(n, 3) + (1 if n < 3 else 0) + (n > 2)])
    found = natural_or_flat(nodes, powers(nodes)[None], (0, 0))
    x, worst = np.linspace(0.0, 1.0, 41)[:-1], 0.0
    for derivative in range(4):
        exact = powers.deriv(derivative)(x) if derivative else powers(x)
        worst = max(worst, float(abs(found(x, derivative)[0] - exact).max()))
    return worst / float(nodes.size) ** 2


def kicks_error(kicks: float) -> float:
    """Error of a scheme of so many kicks as Gauss's quadrature of a step: moments up to 2 kicks - 1."""
    from verify.chain.splitting import SCHEMES

    flows, weights = SCHEMES[int(kicks)]
    at = np.cumsum(flows)
    moments = [abs(float(np.dot(weights, at[:-1] ** p)) - 1.0 / (p + 1)) for p in range(2 * int(kicks))]
    return max(*moments, abs(float(at[-1]) - 1.0))


# --- The chain about rest ---------------------------------------------------------------------------------------------

CLAMPED, TAUT = held("clamped", "free"), replace(STRIP, tension=70.0)
FINE = 0.025
"""Of the longest step of links that stretch: what RK4 takes off their waves is then nothing."""
FEW = 4
"""Of its lowest modes."""


def chain_modes_error(n: float) -> float:
    """Of n hinged links, all modes and the lowest alone: frequencies in closed form, and duals of their modes."""
    from verify.chain.splitting import modal_basis
    from verify.chain.system import build_system

    system, worst = build_system(STRIP, int(n)), 0.0
    for basis in (modal_basis(system), modal_basis(system, n_modes=FEW)):
        omega = basis.omega[:-1]  # last stands the motion off the roller's line
        s2 = np.sin(np.arange(1.0, len(omega) + 1.0) * pi / (2.0 * n)) ** 2
        exact = np.sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (n / STRIP.length) ** 2
        apart = basis.duals @ basis.modes.T - np.eye(len(basis.omega))
        worst = max(worst, float(abs(omega[:FEW] / exact[:FEW] - 1.0).max()), float(abs(apart).max()))
    return worst


def bent_rest_error(n: float) -> float:
    """By how much a chain that hangs still by its weight moves by linear flow, over how far it is bent."""
    from verify.chain.splitting import modal_basis, simulate_linear
    from verify.chain.statics import solve_static
    from verify.chain.system import build_system

    system = changed(build_system(held("clamped", "free"), int(n)), gravity=(0.0, -9.81))
    rest = solve_static(system)
    moved = simulate_linear(modal_basis(system, rest), rest, np.linspace(0.0, 0.3, 5))
    return float(abs(moved.angles - rest.angles).max() / abs(rest.angles).max())


def late_books_error(n: float) -> float:
    """What is missing in the books of a driven chain that are opened late, over what was put in, by its tolerance."""
    from verify.chain.dynamics import at_rest
    from verify.chain.stepping import simulate
    from verify.chain.system import build_system

    beam, tolerance = held("clamped", "free"), 1e-9
    system = build_system(beam, int(n), (PointForce(position=0.6, amplitude=0.3),), 9.0, joint_dashpot=1e-3)
    motion = simulate(system, at_rest(system), np.linspace(0.05, 0.2, 4), tolerance=tolerance)
    given = float(np.ptp(motion.work_in)) + float(np.ptp(motion.dissipated))
    return float(abs(motion.residual()).max()) / given / (tolerance * motion.statistics.steps)


def stretching_books_error(n: float) -> float:
    """Energy of links let go from a sine and followed, against its closed form at first.

    Joints bend by 4 sin^2(pi / 2N) A / l sin(pi j / N) each, links stretch by half the square of their slopes,
    2 sin(pi / 2N) A / l cos(pi (j - 1/2) / N); what is left out is the square of the largest slope.
    """
    from verify.chain.stretching import elastic_step_limit, simulate_elastic
    from verify.chain.system import build_system

    links, size, stiffness = int(n), 1e-4 * STRIP.length, 8.05e6
    system = build_system(STRIP, links)
    link = STRIP.length / links
    shape = size * np.sin(pi * np.arange(links + 1.0) / links)
    step = FINE * elastic_step_limit(system, stiffness)
    motion = simulate_elastic(system, stiffness, np.linspace(0.0, 1e-3, 3), step=step, deflected=shape)
    slope = 2.0 * sin(pi / (2.0 * links)) * size / link
    bent = STRIP.bending_stiffness / link * (2.0 * sin(pi / (2.0 * links)) * slope) ** 2 * links / 4.0
    stretched = stiffness * link * slope**4 * 3.0 * links / 64.0
    return max(abs(float(energy) / (bent + stretched) - 1.0) for energy in motion.energies) / slope**2


def stretching_work_error(n: float) -> float:
    """Energy of links that a constant force pulls along and across, over its work, less one."""
    from verify.chain.stretching import elastic_step_limit, simulate_elastic
    from verify.chain.system import LinkLoad, build_system

    links, stiffness, along, across = int(n), 8.05e6, 300.0, 0.2
    system = build_system(CLAMPED, links)
    end = LinkLoad(link=links, at=STRIP.length / links, force=(along, across))
    system = changed(system, loads=(end,))
    step = FINE * elastic_step_limit(system, stiffness)
    motion = simulate_elastic(system, stiffness, np.linspace(0.0, 1e-3, 4), step=step)
    x, y = motion.displacements[1:, -1].T
    return float(abs((motion.energies[1:] - motion.energies[0]) / (along * x + across * y) - 1.0).max())


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
    return max(abs(whole / (pi * load) - 1.0), abs(foot_force(load, r) - layer), abs(half_space_force(load, r) - space))


def bounce_error(restitution: float) -> float:
    """Of bouncing in step: at its two limits a multiplier is 1 and -1, the other e^2 of it with its sign."""
    from verify.contact.bouncing import bounce_in_step, bouncing_limits

    square, worst = restitution**2, 0.0
    for ratio, edge in zip(bouncing_limits(restitution), (1.0, -1.0), strict=True):
        multipliers = bounce_in_step(ratio, restitution).multipliers
        worst = max(worst, abs(sum(multipliers) - edge * (1.0 + square)), abs(multipliers[0] * multipliers[1] - square))
    return worst


# --- Orders -----------------------------------------------------------------------------------------------------------

RULES: tuple[tuple[str, Beam, dict[str, str | float]], ...] = (
    ("segment", STRIP, {}),
    ("segment", STRIP, {"grading": 2.0}),
    ("segment", CLAMPED, {"wall": "half"}),
    ("segment", CLAMPED, {"wall": "third-order"}),
    ("segment", TAUT, {}),
    ("segment", TAUT, {"joints": "tensioned"}),
    ("segment", STRIP, {"theory": "timoshenko", "joints": "tensioned"}),
    ("fem", CLAMPED, {}),
    ("fem", STEPPED, {"grading": 2.0}),
)


def order_error(count: float) -> float:
    """How far orders observed on mode 2 at N, 2N and 4N lie from those that models say of beams and rules."""
    from verify.judge.compare import observed_order
    from verify.judge.workbench import Workbench
    from verify.models.catalogue import MODELS

    worst, counts = 0.0, tuple(int(count) * times for times in (1, 2, 4))
    for model, beam, settings in RULES:
        bench = Workbench(beam)
        errors = [bench.frequency_error(model, size, 2, tuple(settings.items())) for size in counts]
        worst = max(worst, abs(observed_order(counts, errors) - (MODELS[model].order(beam, **settings) or 0)))
    return worst


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
        id="kick-schemes",
        title="Steps of 1, 2 and 3 kicks as Gauss's quadrature, moments up to twice the kicks less one",
        why="chain/splitting.py: kicks stand and weigh as Gauss's points do.",
        along="kicks",
        at=(1, 2, 3),
        promise=1e-15,
        error=kicks_error,
    ),
    Floor(
        id="chain-modes",
        title="All modes of hinged links, and the lowest alone: frequencies in closed form, duals of their modes",
        why="chain/splitting.py, chain/modes.py: K is assembled, whose rounding grows like N^4.",
        along="links",
        at=(8, 12, 20),
        promise=2e-11,
        error=chain_modes_error,
    ),
    Floor(
        id="linear-about-bent",
        title="A chain that hangs still by its weight, moved by the linear flow about there",
        why="chain/splitting.py: an equilibrium stands still to rounding.",
        along="links",
        at=(6, 20),
        promise=1e-13,
        error=bent_rest_error,
    ),
    Floor(
        id="books-opened-late",
        title="Work, loss and energy of a driven chain from a later time on, over the tolerance of all steps",
        why="chain/stepping.py: the error of a step is held to the tolerance; energy is of second degree: twice that.",
        along="links",
        at=(6, 12),
        promise=2.0,
        error=late_books_error,
    ),
    Floor(
        id="stretching-energy",
        title="Energy of links that stretch, let go from a sine, over the square of its slope",
        why="Half the square of the slope is left out of a link's stretch, and a quarter of its joints' angles.",
        along="links",
        at=(6, 20),
        promise=1.0,
        error=stretching_books_error,
    ),
    Floor(
        id="stretching-work",
        title="Energy of links that stretch under a constant force along and across, against its work",
        why="Energy is work; RK4 in a fortieth of its limit loses 4e-8.",
        along="links",
        at=(6, 20),
        promise=1e-7,
        error=stretching_work_error,
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
        title="Observed orders of nine beams and rules against those that models say",
        why="judge/subjects.py: the leading order; from 20 parts on the next one takes off a tenth at most.",
        along="parts",
        at=(20, 30),
        promise=0.1,
        error=order_error,
    ),
)
