"""Where answers end: on both sides of a resonance in a sweep, of a window's step, of what a run says of its end."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.errors import InputError
from verify.models.compiling import Call
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.braked import LOAD, MU, SPEED, STILL, let_go
from verify.stress.motion.sliders import BAR, HERTZ
from verify.stress.references.beams import STEPPED, STRIP, held

PUSH = (PointForce(position=0.21),)


def refused(ask: Callable[[], object], *words: str) -> bool:
    """Whether something is refused in these words."""
    try:
        ask()
    except InputError as error:
        return all(word in str(error) for word in words)
    return False


def resonances_error(mode: float) -> float:
    """How often sweeps of an undamped beam a hair off a resonance are taken or refused as they should not be."""
    from verify.exact.closed_forms import frequency_hz
    from verify.exact.sweeps import sweep_harmonic

    wrong, n = 0, int(mode)
    for beam in (STRIP, held("clamped", "free")):
        hertz = frequency_hz(beam, n)
        for part, is_refused in ((-3e-9, False), (-3e-10, True), (3e-10, True), (3e-9, False)):
            asked = np.array([0.83 * hertz, hertz * (1.0 + part), 1.21 * hertz])
            wrong += refused(partial(sweep_harmonic, beam, PUSH, asked), "frequencies_hz[1]") is not is_refused
    return float(wrong)


def verbs_error(parts: float) -> float:
    """How many verbs take what is no beam, or do not say so."""
    from verify.elements import linear as elements
    from verify.exact import modes as exact
    from verify.segments import linear as segments

    count, beam = int(parts), {"length": 0.7}
    counted: Any = np.int64(count)
    asks = (
        lambda: exact.solve_modes(beam, 2),  # type: ignore[arg-type]
        lambda: elements.solve_modes(beam, 2, count),  # type: ignore[arg-type]
        lambda: segments.solve_modes(beam=beam, n_modes=2, n_segments=count),  # type: ignore[arg-type]
        lambda: segments.solve_harmonic(beam, PUSH, 31.0, count),  # type: ignore[arg-type]
    )
    taken = sum(not refused(one, "beam = ", "Beam") for one in asks)
    return float(taken + (len(elements.solve_modes(STRIP, 2, counted).frequencies_hz) != 2))


def windows_error(hertz: float) -> float:
    """How often a window beside a step, a hair over it or on it, is taken or refused as it should not be."""
    from verify.waves.window import check_window

    def asked(start: float, end: float) -> Callable[[], object]:
        return lambda: check_window(STEPPED, [0.01], hertz, (start, end))

    hair = 1e-10 * STEPPED.length
    wrong = sum(
        refused(asked(0.1, 0.4 + by), "beam.section") is not no for by, no in ((hair, False), (50.0 * hair, True))
    )
    own = replace(STEPPED, section=STEPPED.section[::-1])
    wrong += refused(lambda: check_window(own, [0.01], hertz, (0.33 - hair, 0.7)), "beam.section")
    thin = asked(0.45, 0.7)
    return float(wrong + (not refused(thin, "give the beam that section's sizes as its own")))


def costs_error(order: float) -> float:
    """How often lines of costs that have no error in common, or finer sizes that fall otherwise, are not told."""
    from verify.judge.crossing import Point, Stretch, Unearned, converging, crossing

    sizes = (10.0, 20.0, 40.0, 80.0)
    coarse = converging([Point(1.0 / n, n**-order, n) for n in sizes], (order, order), 1e-30)
    fine = converging([Point(1.0 / n, (100.0 * n) ** -order, n) for n in sizes], (order, order), 1e-30)
    if not isinstance(coarse, Stretch) or not isinstance(fine, Stretch):
        return 1.0
    apart = crossing(coarse, fine)
    wrong = not isinstance(apart, Unearned) or "no error in common" not in apart.why
    wrong |= isinstance(crossing(coarse, coarse), Unearned)
    late = [Point(1.0 / n, min(n, 40.0) ** -order, n) for n in (5.0, *sizes)]
    stalls = converging(late, (order, order), 1e-30)
    wrong |= not isinstance(stalls, Stretch) or (stalls.n_finer, len(stalls.points)) != (1, 4)
    return float(wrong or coarse.n_finer != 0)


def followed_error(turn: float) -> float:
    """Of what steps miss of a surface's speed, and of the step that misses little enough, by the parabola's error."""
    from verify.motion.step_size import missed

    omegas, free = np.array([40.0, 300.0, 7000.0]), np.array([0.7, 0.2, 0.05])
    dt = 2.0 * turn / omegas[1]
    each = np.minimum((0.5 * omegas * dt) ** 4 / 180.0, 1.0)
    exact = np.linalg.norm(free * each) / np.hypot(1.3, np.linalg.norm(free))
    worst = abs(missed(omegas, free, 1.3, dt) / exact - 1.0)
    alone = missed(omegas[2:], free[2:], 0.0, 1.0)
    return float(largest(worst, abs(alone - 1.0), missed(omegas, 0.0 * free, 0.0, dt)))


def ends_error(pull: float) -> float:
    """How often a slider's run at one speed is not taken for its end, or for one although it floats or speeds up."""
    from verify.motor.figures import comes_to_speed
    from verify.motor.run import run_motor

    slider = let_go(SPEED, MU * LOAD * (1.0 + pull))
    given = {"model": "fem", "count": 2, "step": 1e-5}
    run = run_motor(BAR, STILL, HERTZ, 1e-3, slider=slider, samples=9, **given)  # type: ignore[arg-type]
    lifted = [(0.89, False), (0.91, True), (1.09, True), (1.11, False)]
    wrong = sum(
        comes_to_speed(replace(run, normal_force=share * run.normal_force), 4, 1.0) is not (ends and not pull)
        for share, ends in lifted
    )
    sprung = replace(run, slider=replace(slider, preload_stiffness=1.0), normal_force=0.5 * run.normal_force)
    wrong += comes_to_speed(sprung, 4, 1.0) is not (not pull)
    slow = comes_to_speed(run, 4, 1e-9)
    return float(wrong + (slow is not (not pull)))


def lowest_error(count: float) -> float:
    """Of the lowest modes of a chain alone: one is taken, none and more than there are are not."""
    from verify.chain.modes import lowest_modes
    from verify.chain.system import build_system
    from verify.segments.linear import solve_modes

    n, worst = int(count), 0.0
    for ends, most in ((("clamped", "free"), n), (("pinned", "pinned"), n - 1), (("pinned", "free"), n - 1)):
        system = build_system(held(*ends), n)
        wrong = not all(refused(partial(lowest_modes, system, k), f"1 to {most}") for k in (0, most + 1))
        exact = 2.0 * np.pi * np.asarray(solve_modes(held(*ends), 1, n).frequencies_hz)
        omega = lowest_modes(system, 1)[0] if ends != ("pinned", "free") else exact
        worst = largest(worst, float(wrong), float(abs(omega[0] / exact[0] - 1.0)))
    return worst


def _loops() -> Iterator[Call]:
    from verify.motor import warm

    return warm.on_springs("coulomb", "one-way")


def _row(name: str, error: Callable[[float], float], title: str, why: str, **more: Any) -> Row:
    given: dict[str, Any] = {"along": "mode", "promise": 0.5} | more
    return Floor(id=name, error=error, title=title, why=why, **given)


ROWS: tuple[Row, ...] = (
    _row(
        "beside-resonances-in-a-sweep",
        resonances_error,
        "Undamped sweeps with one frequency a hair below and above a resonance, refused by its index or taken",
        "exact/harmonic.py: within 1e-9 of a resonance there is no answer.",
        at=(1.0, 4.0),
    ),
    _row(
        "verbs-on-what-is-no-beam",
        verbs_error,
        "Verbs asked about what is no beam, by place and by name, and with numpy's whole numbers",
        "models/places.py: one sentence.",
        along="parts",
        at=(9.0,),
    ),
    _row(
        "windows-beside-a-step",
        windows_error,
        "Windows up to a section's step, a hair over it, on another section",
        "waves/window.py: 1e-9 of the length is rounding.",
        along="Hz",
        at=(900.0,),
    ),
    _row(
        "costs-without-an-error-in-common",
        costs_error,
        "Lines of costs that reach no error in common, and a line whose finest size falls no further",
        "judge/crossing.py: nothing is said beyond what both reach.",
        along="order",
        at=(2.0, 4.0),
    ),
    _row(
        "modes-faster-than-steps",
        followed_error,
        "What steps miss of the speed of a surface of three modes, of one that turns faster than they see",
        "motion/step_size.py: the parabola's error, written out.",
        along="rad",
        at=(0.3, 2.0),
        promise=1e-12,
    ),
    _row(
        "ends-of-free-runs",
        ends_error,
        "A slider pulled as much as it is rubbed, and a tenth more: whether its run has come to an end",
        "motor/figures.py: nothing pushes it on and it carries what presses on, to a tenth.",
        along="of mu N",
        at=(0.0, 0.1),
        kernels=_loops,
    ),
    _row(
        "lowest-modes-of-a-chain",
        lowest_error,
        "The lowest mode of a chain of joints alone, none and more than there are",
        "chain/modes.py: the factored pencil's own, to rounding.",
        along="links",
        at=(6.0,),
        promise=1e-10,
    ),
)
