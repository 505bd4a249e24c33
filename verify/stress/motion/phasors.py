"""What is heard of motions: phasors of series with a trend, notes of runs, surfaces under feet as they are put down."""

from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.models.arrays import Array
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.limits.as_written import misplaced, taken
from verify.stress.motion.sliders import BAR, FORCES, HERTZ
from verify.stress.references.beams import STRIP

# --- Series -----------------------------------------------------------------------------------------------------------

SEEN = np.array([1.3 - 0.4j, -0.2 + 0.9j, 0.7j])


def _series(times: Array, hertz: float) -> Array:
    turn = np.exp(2j * pi * hertz * times)[:, None]
    return np.asarray((SEEN * turn).real + np.array([5.0, -3.0, 0.1]) + np.array([40.0, 0.0, -7.0]) * times[:, None])


def phasors_error(samples: float) -> float:
    """Of phasors of series on a drift, whose beginning before the last whole periods is something else."""
    from verify.waves.series import check_series, phasors

    hertz, n, worst = 37.0, int(samples), 0.0
    for periods in (1.0, 2.63, 4.0):
        count = round(periods * n)
        times = 0.31 + np.arange(count) / (n * hertz)
        values = _series(times, hertz)
        begins = count - int(periods + 1e-9) * n
        values[:begins] += 1e3
        worst = largest(worst, float(abs(phasors(times, values, hertz) - SEEN).max()))

    def fine(step: float) -> bool:
        return taken(lambda: check_series(0.7 + step * np.arange(50.0), np.zeros((50, 2)), hertz))

    def long(count: int, each: int) -> bool:
        times = np.arange(count) / (each * hertz)
        return taken(lambda: phasors(times, _series(times, hertz), hertz))

    wrong = misplaced(((0.5 / hertz, True, fine),))
    wrong += [long(n, n) for n in (7, 8, 9)] != [False, True, True] or long(8, 9) or not long(8, 4)
    return largest(worst, wrong)


# --- Notes ------------------------------------------------------------------------------------------------------------

SOFT = ((0.004, (0.0, 0.0, 3.0, -2.0)),)
HALF = ((0.002, (0.0, 0.5)), (0.003, (0.5, 0.25)))
PUSH = (PointForce(position=0.2, amplitude=0.7),)


def notes_error(number: float) -> float:
    """How often notes of runs are other sentences than what was asked for, what grew and what damps say."""
    from verify.motion.free_vibration import free_vibration
    from verify.motion.simulate import simulate

    given: dict[str, Any] = {"model": "segment", "count": 9, "samples": 3}
    grown = simulate(STRIP, PUSH, 37.0, 0.03, envelope=SOFT, **given)
    half = simulate(STRIP, PUSH, 37.0, 0.03, envelope=HALF, modal_damping=0.02, **given)
    plain = simulate(STRIP, PUSH, 37.0, 0.03, **given)
    steady = simulate(STRIP, PUSH, 37.0, 0.03, start="steady", **given)
    modes = plain.notes[0]
    wrong = int(plain.notes != (modes,) or not modes.startswith("modes: "))
    wrong += grown.notes != (modes, "forces grow over 0.004 s")
    jump = "forces grow over 0.005 s to 0.75 times what is given, and jump to that"
    wrong += half.notes != (modes, "damping: a ratio 0.02 of every mode", jump)
    wrong += steady.notes != ("steady field of the segment model, no modes",)
    x = np.array([0.0, 0.31, 0.73])
    let_go = free_vibration(STRIP, (x, np.array([0.0, 0.002, 0.0])), 0.01, model="fem", count=4)
    off = 0.002 - float(let_go.amplitudes @ _shapes_at(4, 0.31))
    said = f"start: {-off:+.2g} m off the shape at x = 0.31 m, the most at its own places"
    wrong += (let_go.notes[1], let_go.notes[-1]) != ("damping: a ratio 0 of every mode", said)
    share = (let_go.amplitudes * let_go.frequencies_hz) ** 2
    corner = (
        f"energies: {100.0 * share[len(share) // 2 :].sum() / share.sum():.2g} % of the elastic energy at the start"
    )
    wrong += len(let_go.notes) != 4 or not let_go.notes[2].startswith(corner)
    wrong += free_vibration(STRIP, 2, 0.01, amplitude=0.001, model="fem", count=4).notes[2:] != ()
    return float(wrong)


def _shapes_at(count: int, x: float) -> Array:
    from verify.models.catalogue import MODELS

    return np.asarray(MODELS["fem"].time_basis(STRIP, count, 400, "spline").shapes(np.array([x]), 0)[:, 0])


def _free(part: float) -> bool:
    """Whether an undamped mode is driven so near to its own frequency."""
    from verify.motion.forcing import check_no_resonance

    basis: Any = SimpleNamespace(model="fem", omegas=2.0 * pi * np.array([40.0, 90.0, 170.0]))
    if not taken(lambda: check_no_resonance(basis, 90.0, 0.01)):
        return False
    return taken(lambda: check_no_resonance(basis, 90.0 * (1.0 + part), 0.0))


def near_modes_error(number: float) -> float:
    """How often what is driven from rest without losses is not refused within 1e-9 of a mode, or beyond."""
    return misplaced(((1e-9, False, _free), (1e-9, False, lambda part: _free(-part))))


# --- Under feet -------------------------------------------------------------------------------------------------------

PUT = 0.0579
FEET = Slider(
    mass=0.021,
    mu=0.07,
    slope=9.0,
    position=PUT,
    preload=3.0,
    contact=Contact(stiffness=1e5),
    foot=(Foot(offset=-0.02), Foot(length=0.008, points=3, offset=0.011), Foot(offset=0.03, face="lower")),
)


def levels_error(amplitude: float) -> float:
    """Of the surface under every point at the start, of the material X = x + (h/2) w' that has come there, over w."""
    from verify.models.catalogue import MODELS
    from verify.motion.surface import cut, steady_stage
    from verify.motor.feet import Placed, feet_of
    from verify.motor.resting import levels_of

    forces = tuple(replace(one, amplitude=amplitude * one.amplitude) for one in FORCES)
    field = MODELS["fem"].solve_harmonic(BAR, forces, HERTZ, 3)
    placed = (Placed(FEET, PUT),)
    feet = feet_of(placed)
    stage = steady_stage(field, cut(1e-3, 1e-5, 1), 0.0, None, 0.0)
    found = levels_of(stage, np.zeros((2, 0)), BAR, placed, feet)
    stands = PUT + np.array([-0.02, 0.011 - 0.004 * 2.0 / 3.0, 0.011, 0.011 + 0.004 * 2.0 / 3.0, 0.03])
    half = BAR.surface_distance * np.array([1.0, 1.0, 1.0, 1.0, -1.0])
    at = stands
    for _ in range(40):
        at = stands + half * field.slope(at).real
    exact = field.deflection(at).real
    return float(abs(found - exact).max() / abs(exact).max())


ROWS: tuple[Row, ...] = (
    Floor(
        id="phasors-on-a-drift",
        title="Phasors of series on a drift whose beginning is something else, and how few samples are refused",
        why="waves/series.py: the last whole periods, a line beside them.",
        along="samples a period",
        at=(9.0, 16.0),
        promise=1e-12,
        error=phasors_error,
    ),
    Floor(
        id="notes-of-runs",
        title="Notes of runs from rest, grown, let go and steady, sentence by sentence",
        why="motion/simulate.py, free_vibration.py: what acts, and what is missed.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=notes_error,
    ),
    Floor(
        id="modes-driven-from-rest",
        title="Beams driven from rest four parts in ten thousand within and without 1e-9 of a mode, damped or not",
        why="motion/forcing.py: refused where it would grow without end.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=near_modes_error,
    ),
    Floor(
        id="surfaces-as-feet-are-put-down",
        title="The surface under points of feet above and below as they are put on a steady beam, material and all",
        why="motor/resting.py: four passes of a search whose errors fall by the slope.",
        along="of the forces",
        at=(0.1, 1.0),
        promise=5e-6,
        error=levels_error,
    ),
)
