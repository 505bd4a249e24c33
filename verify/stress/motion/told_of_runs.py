"""What runs say of themselves: which damping acts, how far they can be believed, what they take; readings beside."""

from math import log, pi, sqrt
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.modes.any_beam import PLAIN
from verify.stress.references.beams import STRIP, held

FORCES = (PointForce(position=0.2, amplitude=0.7),)
HERTZ, COUNT = 131.0, 9
LOSS, HELD_PARTS = 0.03, 60
UNSEEN, STICKY = 1e-4, 0.1
"""What steps may miss of the surface's speed, and of friction's own rate in one."""
DAMPINGS: tuple[tuple[str, float, float | None, str, str], ...] = (
    ("rest", 0.0, None, "", ""),
    ("rest", 0.0, 0.02, "a ratio 0.02 of every mode", "a ratio 0.02 of every mode"),
    ("steady", 0.0, None, "", ""),
    (
        "steady",
        0.0,
        0.02,
        "a ratio 0.02 of every mode",
        "a loss factor 0.04 in the steady field in place of a ratio 0.02 of every mode",
    ),
    ("rest", LOSS, None, *(2 * ("a ratio 0.015 of every mode in place of the loss factor 0.03",))),
    ("rest", LOSS, 0.0, *(2 * ("none, in place of the loss factor 0.03",))),
    ("rest", LOSS, 0.02, *(2 * ("a ratio 0.02 of every mode in place of the loss factor 0.03",))),
    ("steady", LOSS, None, *(2 * ("the loss factor 0.03 in the steady field",))),
    (
        "steady",
        LOSS,
        0.0,
        "none, in place of the loss factor 0.03",
        "a loss factor 0 in the steady field in place of a ratio 0 of every mode",
    ),
)
"""Start, loss factor, ratio, what links say, what the exact beam says, whose steady field knows no ratios."""


def damping_error(number: float) -> float:
    """How often a run of links, or of the exact beam, says another damping than acts on it."""
    from verify.motion.simulate import simulate

    wrong, model = 0, ("segment", "analytic")[int(number)]
    for start, loss, ratio, *said in DAMPINGS:
        more: dict[str, Any] = {} if ratio is None else {"modal_damping": ratio}
        more |= {"start": start} | ({"count": 6} if not number else {"modes": 4} if start == "rest" else {})
        run = simulate(replace(STRIP, loss_factor=loss), FORCES, 37.0, 1e-3, model=model, samples=3, **more)
        told = [note.removeprefix("damping: ") for note in run.notes if note.startswith("damping: ")]
        wrong += told != ([said[int(number)]] if said[int(number)] else [])
    return float(wrong)


def _sines(x: Array, derivative: int) -> Array:
    """The steady field of the pinned strip as a series of sines, (len(x),), metres per metre^derivative."""
    n = np.arange(1.0, 801.0)[:, None]
    k = n * pi / STRIP.length
    size = 2.0 * 0.7 / (STRIP.mass_per_length * STRIP.length) * np.sin(k * 0.2)
    turned = np.sin(k * x) if derivative == 0 else k * np.cos(k * x)
    return np.asarray((size * turned / ((STRIP.wave_constant * k**2) ** 2 - (2.0 * pi * HERTZ) ** 2)).sum(axis=0))


def margins_error(parts: float) -> float:
    """Of the margins of a run: lift-off, chain, theory and division, by series and closed forms."""
    from verify.motion.simulate import simulate
    from verify.motion.validity import nearest_mode

    x, omega = np.linspace(0.0, STRIP.length, 400), 2.0 * pi * HERTZ
    mean = float((_sines(x, 1) ** 2).mean())
    kl = sqrt(omega / STRIP.wave_constant) * STRIP.length
    own = [STRIP.wave_constant * (n * pi / STRIP.length) ** 2 for n in range(1, 40)]
    mode = int(np.argmin(abs(np.array(own) - omega))) + 1
    mu = mode * pi / COUNT
    found = {
        model: simulate(STRIP, FORCES, HERTZ, 1e-3, model=model, count=count, start="steady", samples=3).margins
        for model, count in (("segment", COUNT), ("fem", COUNT), ("analytic", None))
    }
    exact = found["analytic"]
    worst = abs(exact.lift_off / (omega**2 * float(abs(_sines(x, 0)).max()) / 9.81) - 1.0)
    worst = largest(worst, abs(exact.nonlinearity / (kl**2 * 0.5 * mean) - 1.0))
    worst = largest(worst, abs((exact.model_form or 0.0) / (timoshenko_rate(mode) / own[mode - 1] - 1.0) - 1.0))
    for model, sign in (("segment", -1.0), ("fem", 1.0)):
        worst = largest(worst, abs((found[model].discretisation or 0.0) / (sign * mu**4 / 1440.0) - 1.0))
    wrong = int(exact.discretisation is not None)
    for hertz in (1.0, 0.99 * parts, parts, 977.0):
        near = int(np.argmin(abs(np.array(own) - 2.0 * pi * hertz))) + 1
        wrong += nearest_mode(STRIP, hertz) != near
    return largest(worst, float(wrong))


def timoshenko_rate(mode: int) -> float:
    """Omega of a mode of the pinned strip by Timoshenko's theory: the lower root of a quadratic in omega^2."""
    own, k = STRIP.own, mode * pi / STRIP.length
    bent, line = own.bending_stiffness, own.mass_per_length
    shear, turning = float(own.shear_stiffness or 0.0), float(own.rotary_inertia or 0.0)
    a, c = line * turning / shear, bent * k**4
    b = line + turning * k**2 + line * bent * k**2 / shear
    return sqrt(2.0 * c / (b + sqrt(b * b - 4.0 * a * c)))


def estimates_error(parts: float) -> float:
    """How many estimates of time, memory and work are not what they grow like, or not what was measured."""
    from verify.chain.work import fixed_steps, modal_work, per_evaluation
    from verify.models.eigen import field_seconds, required_bytes, solve_seconds
    from verify.motion.stepping import slider_seconds

    n, wrong = int(parts), 0
    wrong += not 31.0 < solve_seconds(2_000_000, 5) < 40.0
    wrong += not 8.0 < solve_seconds(1_000_000, 5) < 21.0
    wrong += not solve_seconds(200_000, 30) > solve_seconds(200_000, 5) > 0.5 * solve_seconds(400_000, 5) * 0.99
    wrong += not abs(solve_seconds(240, 2) / solve_seconds(120, 2) - 8.0) <= 1e-9
    wrong += not abs(required_bytes(240, 2) / required_bytes(120, 2) - 4.0) <= 1e-9
    wrong += not 1300.0 < required_bytes(300_000, 5) / 3e5 < 3300.0
    wrong += not required_bytes(300_000, 30) > required_bytes(300_000, 5)
    wrong += not 2.6e-6 * n + 2.5e-4 < field_seconds(n) < 2.0 * (2.6e-6 * n + 2.5e-4)
    wrong += not 6.9e-6 * n + 4e-4 < field_seconds(n, laden=True) < 2.0 * (6.9e-6 * n + 4e-4)
    for two_way in (False, True):
        one, twice = (slider_seconds(steps, n, two_way) for steps in (1e5, 2e5))
        wrong += not abs(twice / one - 2.0) <= 1e-12
        wrong += not 1e-6 < (slider_seconds(1e5, 2 * n, two_way) - one) / (1e5 * n) * 100.0 < 1e-5
        wrong += not 1.0 < slider_seconds(1.0, 0, two_way) * 1e6 < 10.0
    wrong += not slider_seconds(1e5, n, True) > 3.0 * slider_seconds(1e5, n, False)
    wrong += [fixed_steps(1.0, step) for step in (0.3, 0.25, 2.0)] != [4, 4, 1]
    wrong += not per_evaluation(2 * n) > per_evaluation(n) >= n
    work = modal_work(1.0, 1e-3, 2, n, 20)
    wrong += not abs(modal_work(2.0, 1e-3, 2, n, 20) / work - 2.0) <= 1e-2
    wrong += not abs(modal_work(1.0, 5e-4, 2, n, 20) / work - 2.0) <= 1e-2
    wrong += not modal_work(1.0, 1e-3, 3, n, 20) > work < modal_work(1.0, 1e-3, 2, n, 40)
    return float(wrong)


def steps_error(step: float) -> float:
    """Of the speeds by which a run's steps are chosen, and of the steps, of halves of one: by modes one by one.

    Too long ones that are given are told with the figure, of friction that is too steep for them too.
    """
    from verify.models.catalogue import MODELS
    from verify.motion.carried import _in_steps
    from verify.motion.contact import Coupling
    from verify.motion.request import Driven, Modelled, Started, Watched, requested
    from verify.motion.step_size import gripped_step, longest_step, missed, speeds
    from verify.motion.surface import stages_from_rest
    from verify.slider import Slider

    slider, omega = Slider(mass=0.004, mu=0.4, position=0.3, slope=300.0), 2.0 * pi * HERTZ
    given = [Watched((), 3, one, 100, False) for one in (None, step)]
    how = (Driven(STRIP, FORCES, HERTZ, 0.01), Modelled("fem", 13, None, 0.0), Started("rest", 0.0, (), None))
    free, kept = (requested(*how, watched, slider) for watched in given)
    basis = MODELS["fem"].time_basis(STRIP, 13, 26, "spline")
    stages = stages_from_rest(basis, FORCES, omega, 0.0, kept.pieces, 0.0)
    n, none = np.arange(1.0, len(basis.omegas) + 1.0), np.zeros(len(basis.omegas))
    z, dt = stages[0].start(none, none), stages[0].dt
    q = 0.7 * basis.loads(0.2) / (basis.omegas**2 - omega**2)
    turning, driven = n * pi / STRIP.length, omega * sqrt(float(((q * n * pi / STRIP.length) ** 2).sum()))
    own: tuple[Array, Array, float] = (basis.omegas, basis.omegas * abs(q) * turning, driven)
    found = zip(speeds(stages, z, STRIP.length), own, strict=True)
    worst = max(float(np.max(abs(np.asarray(a) / np.asarray(b) - 1.0))) for a, b in found)
    halves = dt * 0.5 ** np.arange(40)
    enough = next(one for one in halves if missed(*own, one) <= UNSEEN)
    fastest, rate = float(basis.omegas[-1]), 300.0 * 0.4 * 9.81
    grip = next(one for one in halves if fastest * one <= pi or rate * one <= STICKY)
    wrong = longest_step(stages, z, STRIP.length, dt) != enough
    wrong += gripped_step(stages, rate, dt) != grip
    coupling = Coupling(two_way=True, friction_size=1.0, normal_size=1.0, normal="massless", forced=True)
    same, said = _in_steps(kept, stages, z, coupling)
    part = 100.0 * missed(*own, dt)
    told = (f"{dt / enough:.3g} times too long", f"misses {part:.2g} % of", f"give at most {enough:.2g} s")
    wrong += same[0].dt != dt or (enough < dt) != any(all(word in note for word in told) for note in said)
    wrong += (grip < dt) != any("half a turn" in note and f"at most {grip:.2g} s" in note for note in said)
    laid = stages_from_rest(basis, FORCES, omega, 0.0, free.pieces, 0.0)
    chosen, quiet = _in_steps(free, laid, z, coupling)
    wrong += bool(quiet) or chosen[0].dt > min(longest_step(laid, z, STRIP.length, laid[0].dt), laid[0].dt)
    wrong += not abs(chosen[0].duration - 0.01) <= 1e-12 or (
        fastest * chosen[0].dt > pi and rate * chosen[0].dt > STICKY
    )
    return largest(worst, float(wrong))


def held_loss_error(ground: float) -> float:
    """Of what a loss factor takes of modes 1 and 2 in forty periods, on ground of so many EI/L^4, over bending's share.

    EI k^4 over EI k^4 + k_f between pinned ends, by links and by elements.
    """
    from verify.models.catalogue import MODELS
    from verify.motion.free_vibration import free_vibration

    foundation = ground * STRIP.bending_stiffness / STRIP.length**4
    beam, worst = replace(held("pinned", "pinned"), loss_factor=LOSS, foundation=foundation), 0.0
    for model, mode in ((model, mode) for model in ("segment", "fem") for mode in (1, 2)):
        bending = (mode * pi) ** 4
        ratio = 0.5 * LOSS * bending / (bending + ground)
        hertz = float(MODELS[model].solve_modes(beam, mode, HELD_PARTS).frequencies_hz[-1])
        seconds = 40.0 / (hertz * sqrt(1.0 - ratio**2))
        run = free_vibration(beam, mode, seconds, amplitude=1e-4, model=model, count=HELD_PARTS, samples=2)
        energy = run.kinetic + run.elastic
        told = -log(energy[-1] / energy[0]) / (4.0 * pi * hertz * seconds)
        worst = largest(worst, abs(told / ratio - 1.0))
    return worst


THICK = replace(PLAIN, shear_stiffness=900.0, loss_factor=0.02, supports=("clamped", "free"))


def links_error(links: float) -> float:
    """Of links as they stand, slipping or not: straight, at their slope, and at joints in the middle of both."""
    from verify.models.catalogue import MODELS

    n, worst = int(links), 0.0
    nodes = np.linspace(0.0, THICK.length, n + 1)
    middles, step = 0.5 * (nodes[1:] + nodes[:-1]), 0.2 * THICK.length / n
    for theory in ("euler-bernoulli", "timoshenko"):
        given: dict[str, Any] = {"theory": theory}
        ask = MODELS["segment"].solve_harmonic
        stand = ask(THICK, FORCES, HERTZ, n, reading="links", **given)
        joints = ask(THICK, FORCES, HERTZ, n, reading="raw", **given)
        inner, size = nodes[1:-1], abs(joints.shapes(nodes, 0)).max()
        worst = largest(worst, float(abs(stand.shapes(inner, 0) - joints.shapes(inner, 0)).max() / size))
        rise = (stand.shapes(middles + step, 0) - stand.shapes(middles - step, 0)) / (2.0 * step)
        slopes = stand.shapes(middles, 1)
        worst = largest(worst, float(abs(rise - slopes).max() / abs(slopes).max()))
        between = 0.5 * (slopes[1:] + slopes[:-1])
        worst = largest(worst, float(abs(stand.shapes(inner, 1) - between).max() / abs(slopes).max()))
        ends = [stand.shapes(inner + side * step, 0) for side in (-1.0, 1.0)]
        ends = [
            end - side * step * one for end, side, one in zip(ends, (-1.0, 1.0), (slopes[:-1], slopes[1:]), strict=True)
        ]
        apart = abs(ends[1] - ends[0]).max() / size
        worst = largest(worst, float(apart) if theory == "euler-bernoulli" else float(apart < 1e-3))
        worst = largest(worst, float(abs(stand.shapes(inner, 2)).max()))
    return worst


def read_error(parts: float) -> float:
    """Of slopes and deflections by the names that users read them by, against shapes: modes, sweeps, bases."""
    from verify.models.catalogue import MODELS

    n, x, worst = int(parts), np.array([0.11, 0.4, 0.62]), 0.0
    for model, count in (("segment", n), ("fem", n), ("analytic", None)):
        modes = MODELS[model].solve_modes(STRIP, 3, n)
        sweep = MODELS[model].sweep_harmonic(STRIP, FORCES, np.array([37.0, HERTZ]), count)
        basis = MODELS[model].time_basis(STRIP, count, 3, "spline")
        field = MODELS[model].solve_harmonic(STRIP, FORCES, HERTZ, count)
        pairs = [(modes.slope(x), modes.shapes(x, 1)), (sweep.slope(x)[1], field.shapes(x, 1))]
        pairs += [(sweep.deflection(x)[1], field.shapes(x, 0)), (basis.deflection(x), basis.shapes(x, 0))]
        pairs += [(field.slope(x), field.shapes(x, 1)), (field.deflection(x), field.shapes(x, 0))]
        pairs += [(modes.deflection(x), modes.shapes(x, 0))]
        worst = largest(worst, *(float(abs(a - b).max() / abs(b).max()) for a, b in pairs))
    return worst


ROWS: tuple[Row, ...] = (
    Floor(
        id="damping-as-told",
        title="Runs of links and of the exact beam that say another damping than acts on them",
        why="motion/simulate.py: a ratio and a loss factor twice it agree at a resonance only.",
        along="model",
        at=(0, 1),
        promise=0.5,
        error=damping_error,
    ),
    Floor(
        id="losses-of-held-beams",
        title="What a loss factor takes of modes on ground that has no loss, over the share of bending in them",
        why="models/time_basis.py: half of it by the share of a mode's stiffness that has the loss; order 4, 60 parts.",
        along="EI/L^4",
        at=(1.0, 1e3, 1e6),
        promise=3e-7,
        error=held_loss_error,
    ),
    Floor(
        id="margins-of-runs",
        title="Lift-off, axial inertia, theory and division of a run, by a series of sines and closed forms",
        why="motion/validity.py: means over 400 places; a series of 800 sines.",
        along="Hz",
        at=(131.0,),
        promise=1e-4,
        error=margins_error,
    ),
    Floor(
        id="estimates-as-measured",
        title="Estimates of time, memory and work that do not grow as they should, or leave what was measured",
        why="models/eigen.py, motion/stepping.py, chain/work.py: from above, in proportion.",
        along="parts",
        at=(50, 900),
        promise=0.5,
        error=estimates_error,
    ),
    Floor(
        id="steps-as-chosen",
        title="Speeds by which steps are chosen, the longest that will do of one's halves, and what is said of others",
        why="motion/step_size.py: modes one by one; halves.",
        along="s",
        at=(1e-6, 3e-4, 1.7e-3),
        promise=1e-9,
        error=steps_error,
    ),
    Floor(
        id="links-as-they-stand",
        title="Links in a field as they stand, slipping and not: straight, at their slope, joints in their middle",
        why="segments/linear.py: between links that slip, the mean of both.",
        along="links",
        at=(11,),
        promise=1e-11,
        error=links_error,
    ),
    Floor(
        id="read-by-name",
        title="Slopes and deflections of modes, sweeps, fields and bases by their names, against shapes",
        why="models: the same numbers, alone and in a sweep to rounding.",
        along="parts",
        at=(11,),
        promise=1e-11,
        error=read_error,
    ),
)
