"""The nonlinear chain bent, rolled up and turned many times, and its steps about their limit."""

from functools import cache
from math import asin, exp, hypot, inf, pi, sin, sqrt

import numpy as np
from msgspec.structs import replace as changed

from verify.chain import warm
from verify.chain.dynamics import at_rest
from verify.chain.result import ChainMotion
from verify.chain.stepping import simulate, step_limit
from verify.chain.system import ChainState, ChainSystem, build_system
from verify.stress.kind import Floor, Refusal, Row
from verify.stress.largest import largest
from verify.stress.references.beams import STRIP

LINKS = 100
SHORT = 12
"""Links of a chain that runs for long."""
STEPS = 2000
TINY = 1e-7
"""Of the chain's length: an amplitude at which it is linear to 1e-14."""


def rolled_gap(turns: float) -> float:
    """Distance of the ends of a cantilever rolled up so many times, over its length."""
    from verify.chain.problems import rollup_gap

    return rollup_gap(LINKS, "half", turns)


def straight_gap(turns: float) -> float:
    """The same by linear theory: w = M L^2 / 2 EI at x = L."""
    return hypot(1.0, pi * turns)


def tip_error(load: float) -> float:
    """Error of the tip under a dead load P L^2 / EI, over load / (12 N^2).

    Against the elastica by elliptic integrals (Bisshopp and Drucker, Quart. Appl. Math. 3 (1945) 272).
    """
    from verify.chain.problems import cantilever_tip

    found, (deflection, shortening) = cantilever_tip(load, LINKS), elastica(load)
    error = max(abs(found.deflection - deflection), abs(found.shortening - shortening))
    return error / (load / (12.0 * LINKS**2))


@cache
def elastica(load: float) -> tuple[float, float]:
    """(w / L, 1 - x / L) of the tip: sin of the tip's slope by bisection on sqrt(load) = K(k) - F(k, phi)."""
    from scipy.optimize import brentq
    from scipy.special import ellipe, ellipeinc, ellipkinc, ellipkm1

    root = sqrt(load)

    def of(log_rest: float) -> tuple[float, float, float]:
        """k^2, phi and 1 - k^2 of a tip whose slope's sine is 1 - e^log_rest."""
        rest = exp(log_rest)
        return 1.0 - 0.5 * rest, asin(sqrt(1.0 / (2.0 - rest))), 0.5 * rest

    def gap(log_rest: float) -> float:
        m, phi, m1 = of(log_rest)
        return float(ellipkm1(m1) - ellipkinc(phi, m)) - root

    m, phi, _ = of(brentq(gap, -2.0 * root - 9.0, -1e-12, xtol=1e-14))
    return 1.0 - 2.0 / root * float(ellipe(m) - ellipeinc(phi, m)), 1.0 - sqrt(2.0 * (2.0 * m - 1.0)) / root


def linear_tip_error(load: float) -> float:
    """The same of linear theory, w = P L^3 / 3 EI."""
    deflection, shortening = elastica(load)
    return largest(abs(load / 3.0 - deflection), shortening) / (load / (12.0 * LINKS**2))


@cache
def pinned(gravity: float = 0.0) -> ChainSystem:
    """Stiff links on a pin, free at the other end; gravity along x."""
    from verify.segments.links import link_inertia

    lengths, masses = np.full(SHORT, 0.73 / SHORT), np.full(SHORT, 0.31 / SHORT)
    stiffness = np.append(0.0, np.full(SHORT - 1, 2.9))
    return ChainSystem(
        lengths=lengths,
        masses=masses,
        inertias=link_inertia(masses, lengths),
        stiffness=stiffness,
        dashpots=np.zeros(SHORT),
        gravity=(gravity, 0.0),
    )


RATE = 17.3
"""Rad/s of a chain that spins about its pin."""


def spun_error(turns: float) -> float:
    """A straight chain spun about its pin: error of its angle over the angle, and of its bending, after many turns."""
    system = pinned()
    start = ChainState(np.zeros(SHORT), np.append(RATE, np.zeros(SHORT - 1)))
    end = 2.0 * pi * turns / RATE
    motion = simulate(system, start, [end], method="rk4", step=0.5 * step_limit(system, start), ledger=False)
    angles = motion.angles[-1]
    return largest(float(abs(angles[0] / (RATE * end) - 1.0)), float(abs(angles[1:]).max()) / (RATE * end))


TOLERANCE = 1e-10


def whirled_error(turns: float) -> float:
    """A heavy chain whirled over its pin: drift of its energy over the tolerance of every step it took."""
    system = pinned(9.81)
    start = ChainState(np.zeros(SHORT), np.append(RATE, np.zeros(SHORT - 1)))
    motion = simulate(system, start, [0.0, 2.0 * pi * turns / RATE], tolerance=TOLERANCE)
    kinetic = motion.energies()[0][0]
    return float(abs(motion.residual()[-1]) / kinetic / (TOLERANCE * motion.statistics.steps))


@cache
def hinged() -> tuple[ChainSystem, ChainState, float]:
    """The strip as a chain with a roller, off by a wave in every mode, and its step limit."""
    system = build_system(STRIP, SHORT)
    rng = np.random.default_rng(3)
    start = at_rest(system, TINY * rng.standard_normal(SHORT))
    return system, start, step_limit(system, start)


def _stepped(part: float, limit: float | None = None) -> ChainMotion:
    system, start, longest = hinged()
    times = np.array([0.0, STEPS * part * longest])
    return simulate(system, start, times, method="rk4", step=part * longest, limit=limit, ledger=False)


def grown(part: float) -> float:
    """Energy gained in 2000 steps of so many step limits, over that at first; 0 where it is lost."""
    return _gain(_stepped(part))


def unguarded(part: float) -> float:
    """The same of steps that nobody refuses."""
    return _gain(_stepped(part, inf))


def _gain(motion: ChainMotion) -> float:
    if not motion.finished:
        return inf
    kinetic, elastic, _ = motion.energies()
    total = kinetic + elastic
    return largest(float(total[-1] / total[0]) - 1.0, 0.0)


def limit_error(n: float) -> float:
    """Error of the step limit of RK4 against 2 sqrt(2) over the highest mode of so many links, in closed form."""
    system = build_system(STRIP, int(n))
    s2 = sin((n - 1.0) * pi / n / 2.0) ** 2
    highest = sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (n / STRIP.length) ** 2
    return abs(step_limit(system, at_rest(system)) * highest / (2.0 * sqrt(2.0)) - 1.0)


def _folded(load: float) -> float:
    from verify.chain.problems import cantilever_tip

    return cantilever_tip(load, LINKS).deflection


def _too_steep(amplitude: float) -> float:
    from verify.chain.problems import energy_drift

    return energy_drift(changed(STRIP), SHORT, amplitude, 0.1, None, 1e-6)


ROWS: tuple[Row, ...] = (
    Floor(
        id="rolled-up",
        title=f"{LINKS} links rolled up by an end moment, gap of a circle that closes",
        why="docs/findings: equal joints and half a joint at the wall close exactly; the chain's gate asks 1e-12.",
        along="turns",
        at=(1, 5, 20),
        beyond=(40,),
        promise=1e-12,
        error=rolled_gap,
        beside=straight_gap,
        textbook="linear theory",
        seconds=8.0,
    ),
    Floor(
        id="dead-load",
        title=f"{LINKS} links bent by a dead load, over what order 2 leaves",
        why="Of a polygon: kappa^2 l^2 / 24 of a length; curvature is at most sqrt(2 load) / L: load / (12 N^2).",
        along="PL^2/EI",
        at=(0.1, 1.0, 4.0, 10.0, 100.0),
        beyond=(1000.0, 1e4),
        promise=1.0,
        error=tip_error,
        beside=linear_tip_error,
        textbook="linear theory",
        seconds=3.0,
    ),
    Floor(
        id="spun",
        title=f"{SHORT} straight links spun about their pin",
        why="A constant rate is exact in every Runge-Kutta method: roundings of 1.1e-16 in each of some 1e6 steps.",
        along="turns",
        at=(1.0, 10.0, 100.0),
        promise=1e-10,
        error=spun_error,
        seconds=8.0,
        kernels=warm.rigid,
    ),
    Floor(
        id="whirled",
        title=f"{SHORT} heavy links whirled over their pin, drift of energy over the tolerance of all steps",
        why="chain/stepping.py: the error of a step is held to the tolerance; energy is of second degree: twice that.",
        along="turns",
        at=(1.0, 10.0, 30.0),
        promise=2.0,
        error=whirled_error,
        seconds=8.0,
        kernels=warm.rigid,
    ),
    Floor(
        id="steps-below-the-limit",
        title="Energy gained by RK4 on a chain in 2000 steps below its limit",
        why="Below |R(z)| = 1 every mode loses energy; the tiny motion is linear to 1e-12.",
        along="limits",
        at=(0.1, 0.5, 0.9, 0.99),
        promise=1e-12,
        error=grown,
        beside=unguarded,
        beside_at=(0.99, 1.01, 1.05, 2.0),
        textbook="the same loop without the refusal",
        seconds=3.0,
        kernels=warm.rigid,
    ),
    Refusal(
        id="steps-beyond-the-limit",
        title="Fixed steps beyond the stability limit of RK4",
        why="chain/stepping.py: refused above its stability limit, with the limit.",
        along="limits",
        at=(1.01, 2.0, 1e6),
        names=("step", "stability limit", "smaller step"),
        ask=grown,
        taken=(0.5, 0.99),
        kernels=warm.rigid,
    ),
    Floor(
        id="step-limit",
        title="The step limit of a chain against 2 sqrt(2) over its highest mode in closed form",
        why="chain/stepping.py finds the highest rate by Arnoldi to 1e-3 of its square.",
        along="links",
        at=(8, 20, 49, 200, 1000),
        promise=1e-3,
        error=limit_error,
        seconds=4.0,
        kernels=warm.rigid,
    ),
    Refusal(
        id="amplitude-beyond-the-links",
        title="Chains let go from heights that their links do not reach",
        why="chain/problems.py: refused with the height.",
        along="L",
        at=(0.11, 0.5, 1e6),
        names=("amplitude", "L / 10"),
        ask=_too_steep,
        taken=(0.01,),
        kernels=warm.rigid,
    ),
)
