"""Formulas at all their supports, slow and fast drives, contacts that stick and slip, each written out another way."""

from dataclasses import replace as changed
from functools import cache
from math import cos, pi, sin

import numpy as np
from msgspec.structs import replace

from verify.attached import PointMass, PointSpring
from verify.beam import PointForce
from verify.chain import warm
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import States
from verify.stress.modes.laws import SUPPORTS, exact_root
from verify.stress.references.beams import PLAIN, STRIP, held

# --- Between all supports ---------------------------------------------------------------------------------------------

GAUSS = 60
"""Points of a rule over the whole beam."""
ENDS = {"pinned": (0, 2), "clamped": (0, 1), "guided": (1, 3), "free": (2, 3)}
"""Derivatives that are nought there."""


def _waves(y: float, x: Array, derivative: int) -> Array:
    """Cos, sin and both exponentials, each at most 1, and derivatives over y, (4, len(x))."""
    turn = y * x + 0.5 * pi * derivative
    return np.array([np.cos(turn), np.sin(turn), (-1.0) ** derivative * np.exp(-y * x), np.exp(y * (x - 1.0))])


def all_shapes_error(mode: float) -> float:
    """Of a mode between all supports and mirrored, to its third derivative, against null vectors and Gauss's rule."""
    from verify.exact.modes import mode_shape

    x, worst = np.array([0.0, 0.13, 0.41, 0.77, 1.0]), 0.0
    points, weights = np.polynomial.legendre.leggauss(GAUSS)
    for pair in SUPPORTS:
        y = float(exact_root(pair, int(mode)))
        for ends in {pair, pair[::-1]}:
            rows = [_waves(y, np.array([float(at)]), d)[:, 0] for at in (0, 1) for d in ENDS[ends[at]]]
            own = np.linalg.svd(np.array(rows))[2][-1]
            size = 0.5 * float(weights @ (own @ _waves(y, 0.5 * (points + 1.0), 0)) ** 2)
            beam = held(*ends)
            own /= np.sqrt(size * beam.mass_per_length * beam.length)
            for derivative in range(4):
                exact = own @ _waves(y, x, derivative) * (y / beam.length) ** derivative
                found = mode_shape(beam, int(mode), x * beam.length, derivative)
                off = min(abs(found - exact).max(), abs(found + exact).max())
                worst = largest(worst, float(off / abs(exact).max()))
    return worst


EULER = {
    ("pinned", "pinned"): 1.0,
    ("guided", "guided"): 1.0,
    ("guided", "pinned"): 0.25,
    ("clamped", "clamped"): 4.0,
    ("free", "free"): 0.0,
    ("clamped", "free"): 0.25,
    ("clamped", "pinned"): (4.493409457909064 / pi) ** 2,
    ("pinned", "free"): 0.0,
    ("guided", "clamped"): 1.0,
    ("free", "guided"): 0.25,
}
"""Buckling loads over pi^2 EI / L^2; 4.4934... of tan y = y."""


def all_loads_error(size: float) -> float:
    """Of exact loads at which uniform beams buckle, over pi^2 EI / L^2; of parts too where nothing bears on turning."""
    from verify.models.catalogue import MODELS

    worst, beam = 0.0, replace(STRIP, length=size)
    unit = (pi / size) ** 2 * beam.bending_stiffness
    for pair, factor in EULER.items():
        for ends in {pair, pair[::-1]}:
            for name in ("analytic", "fem", "segment") if not factor else ("analytic",):
                load = MODELS[name].buckling_load(replace(beam, supports=ends), 9 if name != "analytic" else None)
                worst = largest(worst, abs(load / unit - factor))
    return worst


SLOW = (0.013, 0.7, 1.9, 67.0)
"""Hz, on both sides of a wave as long as 2 pi beams."""
TWO = (PointForce(position=0.1, amplitude=1.3, phase_deg=20.0), PointForce(position=0.555, amplitude=2.1))


def slow_sweep_error(loss: float) -> float:
    """Of fields in one sweep over slow and fast drives, against states by exponentials."""
    from verify.exact.sweeps import sweep_harmonic

    worst, x = 0.0, np.array([0.0, 0.17, 0.4, 0.61, 0.73])
    for ends in (("pinned", "pinned"), ("clamped", "free"), ("guided", "clamped"), ("free", "pinned")):
        beam = replace(PLAIN, supports=ends, loss_factor=loss)
        sweep = sweep_harmonic(beam, TWO, np.array(SLOW))
        for i, hertz in enumerate(SLOW):
            states = States(beam, "euler-bernoulli", (2.0 * pi * hertz) ** 2, [*x.tolist(), 0.1, 0.555])
            under = states.under(TWO)
            for derivative in range(3):
                exact = np.array([states.read(under, float(at), derivative) for at in x])
                off = abs(sweep.field(i).shapes(x, derivative) - exact).max() / abs(exact).max()
                worst = largest(worst, float(off))
    return worst


def slipping_error(count: float) -> float:
    """Of two frequencies of links that slip under bodies, at guided ends and inside, from N and 2N, against the exact.

    What is left at N and 2N is of order 2, and taken out; on levers of order 1, and a thousandth of it is counted.
    """
    from verify.exact.modes import solve_modes as exact_modes
    from verify.segments.linear import solve_modes

    worst, thick, n = 0.0, replace(PLAIN, shear_stiffness=900.0, rotary_inertia=3e-5), int(count)
    body, spring = PointMass(position=0.0, mass=0.04), PointSpring(position=0.73, stiffness=300.0)
    for beam in (
        replace(thick, supports=("guided", "pinned"), mass=(body,)),
        replace(thick, supports=("clamped", "guided"), mass=(replace(body, position=0.73),), spring=(spring,)),
        replace(thick, supports=("pinned", "pinned"), mass=(replace(body, position=0.365),)),
    ):
        exact = exact_modes(beam, 2, "timoshenko").frequencies_hz
        coarse, fine = (solve_modes(beam, 2, size, theory="timoshenko").frequencies_hz / exact for size in (n, 2 * n))
        levers = solve_modes(beam, 2, 2 * n, theory="timoshenko", attachment="lever").frequencies_hz / exact
        off = (4.0 * fine - coarse) / 3.0 - 1.0, 1e-3 * (levers - 1.0)
        worst = largest(worst, *(float(abs(one).max()) for one in off))
    return worst


# --- Contacts ---------------------------------------------------------------------------------------------------------

STRIPS = 5_000
"""Of a contact that is followed strip by strip."""


def _grid(*values: tuple[float, ...]) -> Array:
    return np.array(np.meshgrid(*values)).reshape(len(values), -1)


def _followed(phi: Array, r: Array, epsilon: Array) -> Array:
    """F/(mu N) on layers that stick and slip: each strip is stretched by what the surface gains, up to its limit."""
    edges = np.linspace(-1.0, 1.0, STRIPS + 1)[:, None] * phi
    gained = np.diff(np.sin(edges) - r * edges, axis=0)
    limits = epsilon * (np.cos(edges) - np.cos(phi))
    stretch, total = np.zeros(len(phi)), np.zeros(len(phi))
    for gain, limit in zip(gained, limits[1:], strict=True):
        before, stretch = stretch, np.clip(stretch + gain, -limit, limit)
        total += 0.5 * (before + stretch)
    return np.asarray(total * (2.0 * phi / STRIPS) / (2.0 * epsilon * (np.sin(phi) - phi * np.cos(phi))))


def layers_error(epsilon: float) -> float:
    """Of forces on layers at many half angles and speeds, followed strip by strip."""
    from verify.contact.layer import force

    phi, r = _grid((0.3, 1.0, 1.6, 2.4, 3.0), (-0.6, 0.0, 0.3, 0.62, 0.9, 1.2))
    found = [force(float(a), float(b), epsilon) for a, b in zip(phi, r, strict=True)]
    return float(abs(np.array(found) - _followed(phi, r, np.full(len(phi), epsilon))).max())


def feet_error(span: float) -> float:
    """Of a short foot's force and rise and of Coulomb's layer and half-space, by sums over a period and a contact."""
    from verify.contact.foot import dead_band, height_swing, short_foot_force, short_foot_speed
    from verify.contact.layer import efficiency, force, half_space_force

    middle = (np.arange(STRIPS) + 0.5) / STRIPS * pi
    under = np.maximum(middle - span, 0.0)
    worst = abs(height_swing(span) - float(np.ptp(np.cos(under))))
    for r in (-1.4, -0.3, 0.0, 0.4, 0.97, 1.6):
        worst = largest(worst, abs(short_foot_force(span, r) - float(np.sign(np.cos(under) - r).mean())))
        half = (np.arange(STRIPS) + 0.5) / STRIPS
        for phi in (0.4, 1.9, 3.0):
            press = np.cos(half * phi) - cos(phi)
            ways = np.sign(np.cos(half * phi) - r)
            given = float(press @ ways / press.sum())
            worst = largest(worst, abs(force(phi, r) - given))
            power = float(press @ (ways * np.cos(half * phi)) / press.sum())
            if 0.0 <= r < 1.0 and power > 0.05:
                worst = largest(worst, abs(efficiency(phi, r) - r * given / power))
    worst = largest(worst, abs(dead_band(span) - short_foot_force(span, 0.0)))
    worst = largest(worst, abs(short_foot_speed(span) - (sin(span) if span < 0.5 * pi else 1.0)))
    return largest(worst, abs(half_space_force(0.4, 3.0) + 1.0), abs(half_space_force(0.4, -0.2) - 1.0))


# --- Chains -----------------------------------------------------------------------------------------------------------

LINKS, WAVES = 12, {1: 1.0, 5: 0.4}
"""Sizes of the modes that a chain is let go in; the higher one is not among those that are kicked."""


BEGUN, HERTZ, PHASE, SHARE = 0.002, 61.0, 0.7, 0.3
"""Seconds, and of the force on the third joint, over what holds the first mode still."""


@cache
def _hinged() -> tuple[Array, Array, Array]:
    """(frequencies of all modes, their heights at joints, their masses)."""
    n = np.arange(1.0, LINKS)
    s2 = np.sin(n * pi / (2 * LINKS)) ** 2
    omega = np.sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (LINKS / STRIP.length) ** 2
    shapes = np.sin(np.outer(n, np.arange(LINKS + 1.0)) * pi / LINKS)
    link = STRIP.mass_per_length * STRIP.length / LINKS
    return omega, shapes, 0.5 * LINKS * link * (1.0 - 2.0 * s2 / 3.0)


def _moved(times: Array) -> tuple[Array, Array]:
    """Joints of the hinged chain at times, and their velocities: waves let go and pushed, and a steady answer."""
    omega, shapes, masses = _hinged()
    heights = np.array([WAVES.get(n, 0.0) for n in range(1, LINKS)])
    turns, driven = np.outer(times - BEGUN, omega), 2.0 * pi * HERTZ
    force = SHARE * masses[0] * omega[0] ** 2 * shapes[:, 3]
    steady = force / masses / (omega**2 - driven**2)
    phase = (driven * times + PHASE)[:, None]
    at = heights * (np.cos(turns) + 0.6 * np.sin(turns)) + steady * np.cos(phase)
    speed = heights * omega * (0.6 * np.cos(turns) - np.sin(turns)) - steady * driven * np.sin(phase)
    return at @ shapes, speed @ shapes


def kicked_error(modes: float) -> float:
    """Of joints of a driven hinged chain whose low modes alone are kicked, let go in a small wave, over its height."""
    from verify.chain.splitting import modal_basis, simulate_modal
    from verify.chain.system import ChainState, LinkLoad, build_system

    size, times = 1e-6 * STRIP.length, np.array([BEGUN, 0.005, 0.009, 0.013])
    omega, _, masses = _hinged()
    push = SHARE * size * float(masses[0] * omega[0] ** 2)
    link = STRIP.length / LINKS
    load = LinkLoad(link=3, at=link, force=(0.0, push), frequency_hz=HERTZ, phase_deg=float(np.rad2deg(PHASE)))
    system = changed(build_system(STRIP, LINKS), loads=(load,))
    heights, speeds = (size * one for one in _moved(times))
    angles = np.arcsin(np.diff(heights[0]) / link)
    spins = np.diff(speeds[0]) / link / np.cos(angles)
    start = ChainState(np.diff(angles, prepend=0.0), np.diff(spins, prepend=0.0), BEGUN)
    run = simulate_modal(modal_basis(system), start, times, step=2e-5, n_modes=int(modes))
    found = run.deflection(system.nodes[1:-1].tolist())
    moving = link * np.cumsum(np.cumsum(run.rates, axis=1), axis=1)
    pairs = ((found, heights[:, 1:-1]), (moving, speeds[:, 1:]))
    return largest(float(abs(seen - exact).max() / abs(exact).max()) for seen, exact in pairs)


def drift_error(periods: float) -> float:
    """Of the energy that RK4 loses of two hinged links, which have one motion: 1 - z^6 / 72 + z^8 / 576 a step."""
    from verify.chain.problems import energy_drift

    s2 = 0.5  # of a quarter turn
    omega = np.sqrt(48.0 * s2 * s2 / (3.0 - 2.0 * s2)) * STRIP.wave_constant * (2.0 / STRIP.length) ** 2
    step = 2.0 * pi * periods / float(omega) / 64.0
    z = float(omega) * step
    exact = 1.0 - (1.0 - z**6 / 72.0 + z**8 / 576.0) ** 64
    return abs(energy_drift(STRIP, 2, 1e-6, periods, step, 1e-9) / exact - 1.0)


ROWS: tuple[Row, ...] = (
    Floor(
        id="shapes-of-all-supports",
        title="A mode between ten pairs of supports and mirrored, to its third derivative, against null vectors",
        why="exact/modes.py: to rounding; a null vector of four waves keeps its digits.",
        along="mode",
        at=(1, 2, 5, 11),
        promise=1e-12,
        error=all_shapes_error,
    ),
    Floor(
        id="buckling-of-all-supports",
        title="Buckling of uniform beams between ten pairs of supports and mirrored, none where they turn as a whole",
        why="exact/buckling.py: Euler's loads to rounding.",
        along="m",
        at=(0.73, 11.0),
        promise=1e-12,
        error=all_loads_error,
    ),
    Floor(
        id="slow-and-fast-in-a-sweep",
        title="Fields of four beams in one sweep from drives slower than a wave to fast ones, against states",
        why="exact/harmonic.py: slow waves by series, fast ones by exponentials, to rounding.",
        along="loss factor",
        at=(0.0, 0.03),
        promise=1e-12,
        error=slow_sweep_error,
    ),
    Floor(
        id="links-that-slip",
        title="Links that slip under bodies at guided ends and inside, from N and 2N, against the exact beam",
        why="segments/carried.py: of order 2 in joints that slip, so that N and 2N leave order 4.",
        along="segments",
        at=(20, 30),
        promise=5e-6,
        error=slipping_error,
    ),
    Floor(
        id="layers-followed",
        title="Forces on layers that stick and slip, at many half angles and speeds, followed strip by strip",
        why="contact/layer.py: closed forms from stick to slip; strips are off by the square of theirs.",
        along="epsilon",
        at=(0.05, 0.4, 2.0, 9.0),
        promise=5e-7,
        error=layers_error,
    ),
    Floor(
        id="feet-summed-up",
        title="Short feet, Coulomb's layer and its efficiency, by sums over a period and over a contact",
        why="contact/foot.py, contact/layer.py: closed forms; a sum of 5000 signs is off by one of them.",
        along="rad",
        at=(0.0, 0.3, 1.2, 2.0, 3.0, 3.5),
        promise=7e-4,
        error=feet_error,
    ),
    Floor(
        id="low-modes-kicked",
        title="A driven hinged chain of which low modes alone are kicked, let go in a small wave, by closed forms",
        why="chain/splitting.py: the others go on by the linear flow; what is left is of the square of the slopes.",
        along="modes",
        at=(3, 8),
        promise=1e-7,
        error=kicked_error,
        kernels=warm.modal,
    ),
    Floor(
        id="energy-that-rk4-loses",
        title="Energy that Runge and Kutta's steps lose of two hinged links, against their factor for one motion",
        why="chain/problems.py: read at the steps themselves; the factor is exact for small motion.",
        along="periods",
        at=(3.0, 6.0),
        promise=1e-8,
        error=drift_error,
        kernels=warm.rigid,
    ),
)
