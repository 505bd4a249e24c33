"""Phases, sizes and couples at which something is best, turns or cancels, against roots of what it is made of."""

from collections.abc import Callable
from itertools import pairwise, product
from math import cos, pi, sin, tanh

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.device import Device
from verify.models.arrays import ComplexArray
from verify.stress.judge.sizes_chosen import turned_error
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import PLACES, PLAIN, States
from verify.stress.references.beams import STRIP, held

# --- Phases between two drives ----------------------------------------------------------------------------------------

FORWARD = np.array(
    [[0.9, 0.4j], [0.3 - 0.2j, 0.8], [0.1, 0.7 + 0.6j], [1.1j, 1.0], [0.5, 0.0], [0.0, 0.0], [0.4, 0.6j]]
)
BACKWARD = np.array([[0.2j, 0.7], [0.9, -0.5j], [0.8, 0.3], [0.6, 0.2j], [0.2j, 0.9], [0.7, 0.3], [0.5, 0.48j]])
"""Of the first and of the second drive, a row each: one silent forward, one forward at all, one with equal crosses."""
WITHIN = (-2.2, 0.9)
"""Radians, a part of the turn."""


def phases_error(limit: float) -> float:
    """Radians from where crests run fastest or keep a reflection, found on a grid and by brentq, to what is tried."""
    from verify.waves.best_phase import phases_to_try

    size = np.array([[1.0], [7.0], [1e-6], [1.0], [3.0], [1.0], [2.0]])
    whole = phases_to_try(size * FORWARD, size * BACKWARD, limit, (-pi, pi))
    part = phases_to_try(size * FORWARD, size * BACKWARD, limit, WITHIN)
    worst = float((part < WITHIN[0]).any() or (part > WITHIN[1]).any() or not np.isfinite(whole).all())
    for tried, inner, forward, backward in zip(whole, part, FORWARD, BACKWARD, strict=True):
        for phase in _best_phases(forward, backward, limit):
            worst = largest(worst, float(abs(np.exp(1j * tried) - np.exp(1j * phase)).min()))
            if WITHIN[0] < phase < WITHIN[1]:
                worst = largest(worst, float(abs(inner - phase).min()))
        worst = largest(worst, *(float(abs(inner - end).min()) for end in WITHIN))
    return worst


def _best_phases(forward: ComplexArray, backward: ComplexArray, limit: float) -> list[float]:
    """Where a reflection is at its limit, comes nearest to it, or the speed of crests is stationary."""

    def squares(phase: float) -> tuple[float, float, float, float]:
        """|A+|^2 and |A-|^2, and how they change with the phase."""
        z = np.exp(1j * phase)
        waves, turns = (forward[0] + forward[1] * z, backward[0] + backward[1] * z), (forward[1] * z, backward[1] * z)
        changes = [2.0 * (np.conj(wave) * 1j * turn).real for wave, turn in zip(waves, turns, strict=True)]
        return abs(waves[0]) ** 2, abs(waves[1]) ** 2, float(changes[0]), float(changes[1])

    def stationary(phase: float) -> float:
        plus, minus, rises, falls = squares(phase)
        return (rises - falls) * (plus + minus) - 0.5 * (plus - minus) * (rises + falls)

    found = _roots(stationary)
    for one, other in ((0, 1), (1, 0)):
        kept = _roots(lambda phase, one=one, other=other: squares(phase)[one] - limit**2 * squares(phase)[other])  # type: ignore[misc]
        found += kept
        if not kept:
            turns = _roots(
                lambda phase, one=one, other=other: squares(phase)[2 + one] - limit**2 * squares(phase)[2 + other]  # type: ignore[misc]
            )
            found += sorted(turns, key=lambda phase: abs(squares(phase)[one] - limit**2 * squares(phase)[other]))[:1]
    return found


def _roots(of: Callable[[float], float]) -> list[float]:
    """Where a function changes its sign over a turn, on a grid and then by brentq."""
    from scipy.optimize import brentq

    grid = np.linspace(-pi + 0.01, pi + 0.01, 241)
    values = [of(phase) for phase in grid]
    changing = [(a, b) for (a, b), (low, high) in zip(pairwise(grid), pairwise(values), strict=True) if low * high < 0]
    return [float(brentq(of, a, b, xtol=1e-14)) for a, b in changing]


# --- Sizes at which laws turn -----------------------------------------------------------------------------------------


def turns_error(clamped: float) -> float:
    """Of the turns at which errors of both models cancel or are largest; of the sizes, with so many clamped ends.

    There mu^4 (-1/1440 + c / (12 N)) is nought and then largest; between pins errors are those of a node's equations.
    """
    from scipy.optimize import brentq

    from verify.exact.error_laws import MEAN_LIMIT, last_hump

    if clamped:
        ends = ("clamped", "clamped" if clamped > 1.0 else "free")

        def law(n: float) -> float:
            return n**-4 * (clamped / (12.0 * n) - 1.0 / 1440.0)

        zero = brentq(law, 50.0, 400.0)
        top = brentq(lambda n: law(n + 0.01) - law(n - 0.01), 1.1 * zero, 900.0)
        falls, hump = last_hump("segment", held(*ends), 3)
        return float(largest(abs(falls / zero - 1.0), abs(hump / top - 1.0)))
    cancel = brentq(lambda mu: turned_error("segment", mu) + 3.0 * turned_error("fem", mu), 1.5, 3.0, xtol=1e-14)
    top = brentq(lambda mu: turned_error("fem", mu + 1e-4) - turned_error("fem", mu - 1e-4), 2.7, 3.1)
    hump = last_hump("fem", STRIP, 7)[1]
    never = (*last_hump("fem", held("clamped", "free"), 2), *last_hump("segment", STRIP, 7))
    return float(largest(abs(MEAN_LIMIT / cancel - 1.0), abs(7.0 * pi / hump / top - 1.0), *never))


# --- Devices against turning at the ends ------------------------------------------------------------------------------

TURNED = replace(PLAIN, supports=("pinned", "pinned"))
PUSHED = (PointForce(position=0.23, amplitude=1.4, phase_deg=-35.0), PointForce(position=0.47, phase_deg=80.0))
STOPS = [*PLACES.tolist(), *(force.position for force in PUSHED)]


def turned_ends_error(hertz: float) -> float:
    """Of fields with devices against turning at both pinned ends, or with one that pushes alone, against states.

    At 0 a device alone, undamped, where a spring of EI k in its place would make a resonance: one that the reading by
    three springs tries first.
    """
    from verify.exact.harmonic import solve_harmonic
    from verify.waves.devices import field_with_devices

    first = Device(position=0.0, rotational=0.8, rotational_dashpot=3e-3)
    last = Device(position=TURNED.length, rotary_inertia=2e-5, rotational_dashpot=8e-3)
    devices = (first, last) if hertz else (Device(position=0.0, rotational=0.7),)
    beam, hertz = (replace(TURNED, loss_factor=0.004), hertz) if hertz else (TURNED, _sprung_resonance())
    omega = 2.0 * pi * hertz
    turning = [one.rotational - omega**2 * one.rotary_inertia + 1j * omega * one.rotational_dashpot for one in devices]
    resists = {one.position: (0.0j, stiffness) for one, stiffness in zip(devices, turning, strict=True)}
    pushing = Device(position=PUSHED[1].position, amplitude=PUSHED[1].amplitude, phase_deg=PUSHED[1].phase_deg)
    worst, none = 0.0, dict[float, tuple[complex, complex]]()
    for forces, acting, resisted in ((PUSHED, devices, resists), (PUSHED[:1], (pushing,), none)):
        found = field_with_devices(solve_harmonic, beam, forces, hertz, acting)
        states = States(beam, "euler-bernoulli", omega**2, STOPS, resisted)
        under = states.under(PUSHED)
        exact = np.array([states.read(under, x, 0) for x in PLACES.tolist()])
        worst = largest(worst, float(abs(found.shapes(PLACES, 0) - exact).max() / abs(exact).max()))
    return worst


def _sprung_resonance() -> float:
    """Hertz at which the beam resonates with a spring of EI k against turning at its left end.

    There cot y = 2 + coth y, y = k L.
    """
    from scipy.optimize import brentq

    y = brentq(lambda y: cos(y) - sin(y) * (2.0 + 1.0 / tanh(y)), 4.0 * pi, 4.0 * pi + 1.0, xtol=1e-14, rtol=1e-15)
    return float((y / TURNED.length) ** 2 * TURNED.wave_constant / (2.0 * pi))


# --- Devices on a beam without another end ----------------------------------------------------------------------------

ENDS = {"pinned": (0, 2), "clamped": (0, 1), "free": (2, 3), "guided": (1, 3)}
"""Derivatives that are nought at an end."""
LOST, RUBBER = 0.013, 0.4
WAYS_TO_THE_END = (0.9, 2.94, 3.1, 3.3, 3.5, 3.65, 5.4)
"""k d, at which the best dashpot of rubber before a pinned end is where |Gamma| is least, none, or a place held."""


def absorbers_error(hertz: float) -> float:
    """Of what devices reflect, of those that match and of the best dashpots, against both spans of a beam at once.

    With and without loss, before all ends, across and against turning.
    """
    from verify.waves.absorber import best_dashpot, ending, reflection

    worst, distance = 0.0, 0.017
    for eta, support, turning in product((0.0, LOST), ENDS, (False, True)):
        beam = replace(STRIP, loss_factor=eta)
        end, alone = ending(beam, hertz, distance, support, turning=turning), _Alone(beam, hertz, distance, support)
        size = abs(end.own)
        worst = largest(worst, abs(alone.own(turning) / end.own - 1.0), alone.left(end.matched, turning))
        for impedance in (0.0j, (0.4 - 1.3j) * size, 2.1j * size, 1e7 * size + 0.0j):
            worst = largest(worst, abs(reflection(impedance, end) - alone.left(impedance, turning)))
        resistance, left = best_dashpot(end)
        around = [alone.left(complex(part * resistance), turning) for part in (0.9, 1.0, 1.1)]
        worst = largest(worst, abs(left - around[1]), around[1] - min(*around, alone.left(0.0j, turning)))
        if not eta:
            worst = largest(
                worst, *(abs(each / end.matched - 1.0) for each in _matched(hertz, distance, support, turning))
            )
    rubber = replace(STRIP, loss_factor=RUBBER)
    k = (rubber.mass_per_length * (2.0 * pi * hertz) ** 2 / rubber.bending_stiffness) ** 0.25
    return largest(worst, *(_beaten(rubber, hertz, way / k) for way in WAYS_TO_THE_END))


def _beaten(beam: Beam, hertz: float, distance: float) -> float:
    """By how much any dashpot before a pinned end, none or a place held leaves less than the best that is told."""
    from verify.waves.absorber import best_dashpot, ending

    end, alone = ending(beam, hertz, distance), _Alone(beam, hertz, distance, "pinned")
    resistance, left = best_dashpot(end)
    others = [alone.left(complex(part * abs(end.own)), False) for part in (0.0, *np.geomspace(1e-4, 1e4, 161), 1e11)]
    told = alone.left(complex(min(resistance, 1e11 * abs(end.own))), False)
    return largest(abs(told / left - 1.0), left / min(others) - 1.0)


def _matched(hertz: float, distance: float, support: str, turning: bool) -> list[complex]:
    """Impedances of the devices that match near the left end and near the right one, of two unlike ends."""
    from verify.waves.absorber import matched_device

    other, omega = "guided" if support == "pinned" else "pinned", 2.0 * pi * hertz
    sides = ((held(support, other), distance), (held(other, support), STRIP.length - distance))
    found = [matched_device(beam, hertz, at, turning=turning) for beam, at in sides]
    return [one.turning_impedance(omega) if turning else one.impedance(omega) for one in found]


class _Alone:
    """Waves of a beam that comes from the left, before a device at 0 and between it and an end."""

    def __init__(self, beam: Beam, hertz: float, distance: float, support: str) -> None:
        self.omega = 2.0 * pi * hertz
        stiffness = beam.bending_stiffness * (1.0 + 1j * beam.loss_factor)
        k = (beam.mass_per_length * self.omega**2 / stiffness) ** 0.25
        rates = k * np.array([1j, 1.0, -1j, -1.0, 1j, 1.0])
        """Back to the left: wave and near field; between: four."""
        self.here = np.array([rates**order for order in range(4)])
        self.here[:, 2:] *= -1.0
        self.come = np.array([(-1j * k) ** order for order in range(4)])
        there = np.array([rates**order * np.exp(rates * distance) for order in ENDS[support]])
        there[:, :2] = 0.0
        self.there, self.stiffness = there, stiffness

    def solved(
        self, jumps: tuple[complex, complex], come: float, couple: float = 0.0, force: float = 0.0
    ) -> ComplexArray:
        """All six, where moment and force of a device jump by so much of the slope and the deflection."""
        rows, left = self.here.copy(), np.concatenate([-come * self.come, [0.0, 0.0]])
        for row, order, jump in ((2, 1, jumps[0]), (3, 0, jumps[1])):
            rows[row, :2] += jump * self.here[order, :2]
            left[row] -= come * jump * self.come[order]
        left[2] += couple / self.stiffness
        left[3] -= force / self.stiffness
        return np.asarray(np.linalg.solve(np.vstack([rows, self.there]), left))

    def left(self, impedance: complex, turning: bool) -> float:
        """What a device leaves of a wave that comes."""
        jump = 1j * self.omega * impedance / self.stiffness
        found = self.solved((jump, 0.0j) if turning else (0.0j, -jump), 1.0)
        return float(abs(found[0]))

    def own(self, turning: bool) -> complex:
        """Force over speed of the place, or couple over its speed of turning."""
        found = self.solved((0.0j, 0.0j), 0.0, couple=float(turning), force=float(not turning))
        return complex(1.0 / (1j * self.omega * (self.here[int(turning), :2] @ found[:2])))


ROWS: tuple[Row, ...] = (
    Floor(
        id="phases-tried",
        title="Phases at which crests run fastest, keep a reflection or come nearest to it, against brentq on a grid",
        why="waves/best_phase.py: closed forms; a quartic's root moves by 1e-8 where its first coefficient goes.",
        along="reflection",
        at=(0.05, 0.3, 0.9),
        promise=2e-8,
        error=phases_error,
    ),
    Floor(
        id="where-errors-turn",
        title="Turns at which errors of both models cancel and are largest, and sizes, by brentq on a node's equations",
        why="exact/error_laws.py: written to seven digits and more.",
        along="clamped ends",
        at=(0, 1, 2),
        promise=3e-7,
        error=turns_error,
    ),
    Floor(
        id="devices-at-turning-ends",
        title="The exact field with devices against turning at its ends, also where a spring tried resonates (0)",
        why="waves/devices.py: three springs say what any device does, losing four digits.",
        along="Hz",
        at=(0.0, 53.0, 710.0),
        promise=1e-9,
        error=turned_ends_error,
    ),
    Floor(
        id="absorbers",
        title="What devices reflect before all ends, with loss and without, and the best, against both spans at once",
        why="waves/absorber.py: closed forms, to rounding over a device's own reflection.",
        along="Hz",
        at=(41.0, 370.0, 6100.0),
        promise=1e-9,
        error=absorbers_error,
    ),
)
