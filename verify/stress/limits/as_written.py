"""Limits that stand where they are written, to four parts in ten thousand: what is taken below, and not above.

Each is asked on both sides of its figure as documents and docstrings have it, written down here once more.
"""

from collections.abc import Callable, Sequence
from math import pi, sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.beam import PointForce
from verify.errors import InputError, NoFigureError
from verify.models.arrays import Array, ComplexArray
from verify.stress.kind import Floor, Row
from verify.stress.references.beams import STEPPED, STRIP

HAIR = 4e-4
Taken = Callable[[float], object]
"""A value -> whether it is taken, or what raises InputError where it is not."""
Limit = tuple[float, bool, Callable[[float], bool]]
"""A limit, whether what is below it is taken, a value -> whether it is taken."""


def taken(ask: Callable[[], object]) -> bool:
    """Whether something is done, and not refused."""
    try:
        ask()
    except (InputError, NoFigureError):
        return False
    return True


def misplaced(limits: Sequence[Limit], hair: float = HAIR) -> float:
    """How many limits do not part what is below from what is above."""
    wrong = 0
    for limit, below, ask in limits:
        wrong += bool(ask(limit * (1.0 - hair))) is not below
        wrong += bool(ask(limit * (1.0 + hair))) is below
    return float(wrong)


# --- Waves ------------------------------------------------------------------------------------------------------------

HERTZ = 900.0
K = sqrt(2.0 * pi * HERTZ / STRIP.wave_constant)
HALF = pi / K
UNIT = 1.0 / (K**3 * STRIP.bending_stiffness)
"""Of an answer to a unit force where a wave is shorter than the beam, m/N."""


def _field(shapes: Callable[[Array], ComplexArray], newton: float = 1.0) -> Any:
    from verify.models.fields import HarmonicField

    def read(x: Array, derivative: int) -> ComplexArray:
        return shapes(x) if not derivative else np.zeros(len(x), dtype=complex)

    forces = (PointForce(position=0.01, amplitude=newton),)
    return HarmonicField(model="analytic", count=None, beam=STRIP, frequency_hz=HERTZ, forces=forces, shapes=read)


def _moves(metres: float) -> bool:
    from verify.waves.measures import check_moving

    field = _field(lambda x: np.full(len(x), metres * (0.6 + 0.8j)), 3.7)
    return taken(lambda: check_moving(field, field.deflection([0.2, 0.3])))


def _stands(gamma: float) -> bool:
    from verify.waves.found import TwoWaves

    return not np.isfinite(TwoWaves(wavenumber=K, forward=1.0, backward=gamma, residual=0.0).standing_wave_ratio)


def _in_map(amplitude: float) -> bool:
    """Whether a map has a figure of waves so small beside two unit forces, and counts none that it has not."""
    from verify.waves.unit_waves import Gaps, UnitDrive, UnitWaves, figures_of

    drive = UnitDrive(beam=STRIP, model="analytic", count=None, kind="force", places=(0.1, 0.2), window=(0.3, 0.6))
    one = np.array([[0.6 * amplitude, 0.0], [1.0, 0.0]], dtype=complex)
    waves = UnitWaves(np.array([True, True]), np.array([K, K], dtype=complex), one, np.conj(one) / 0.6 * 1j)
    gaps = Gaps()
    found = figures_of(drive, waves, ("reflection",), np.full(2, HERTZ), 1.0, np.array([2.0 + 0j, -2.0]), gaps)[0]
    said = gaps.reasons(4)
    shown = bool(np.isfinite(found[0]).all())
    right = np.isfinite(found[1]).all() and (not said if shown else [one[:6] for one in said] == ["2 of 4"])
    return shown if right else not shown


def _window(start: float, end: float, beam: Any = STRIP) -> bool:
    from verify.waves.window import check_window

    return taken(lambda: check_window(beam, [0.01, 0.72], HERTZ, (start, end)))


def _many(halves: float) -> bool:
    from verify.waves.window import check_halves

    hertz = STRIP.wave_constant * (halves * pi / 0.5) ** 2 / (2.0 * pi)
    return taken(lambda: check_halves(STRIP, hertz, (0.1, 0.6)))


def _stated(halves: float) -> bool:
    from verify.waves.window import stated_wavenumber

    return taken(lambda: stated_wavenumber("k", halves * pi / 0.5, (0.1, 0.6)))


def _lossy_wave(share: float) -> bool:
    from verify.waves.window import stated_wavenumber

    return taken(lambda: stated_wavenumber("k", 40.0 * (1.0 - 1j * share), (0.1, 0.6)))


def _away(distance: complex) -> bool:
    from verify.waves.poles import is_resonant

    return not is_resonant(STRIP, distance)


def _usual(answer: float) -> bool:
    from verify.waves.poles import is_near

    one, three = np.full((2, 3), 0.4 * answer, dtype=complex), np.full((1, 3), -3j * answer)
    return not is_near([one, three], [1.0, 3.0], UNIT, STRIP, HERTZ)


def waves_error(number: float) -> float:
    """How many limits of waves are not where they are written: resonances, windows, and what is rounding."""
    whole = 1.0 / (STRIP.mass_per_length * STRIP.length * (2.0 * pi * HERTZ) ** 2)
    step, slack = STEPPED.section[0].length, 1e-9 * STEPPED.length
    own = replace(STEPPED, section=STEPPED.section[::-1], thickness=0.0023)
    after = own.section[0].length
    return misplaced(
        (
            (1e-13 * UNIT * 3.7, False, _moves),
            (3e-13 * UNIT, False, _in_map),
            (1e-9, False, _away),
            (1e-9, False, lambda share: _away(-share)),
            (1e-12, False, lambda share: _away(3e-10 + 1j * share)),
            (1e-12, False, lambda share: _away(3e-10 - 1j * share)),
            (1e5 * (UNIT + whole), True, _usual),
            (1e-12, True, lambda off: _stands(1.0 - off)),
            (1e-12, True, lambda off: _stands(1.0 / (1.0 - off))),
            (HALF, False, lambda length: _window(0.1, 0.1 + length)),
            (slack, True, lambda by: _window(0.1, step + by, STEPPED)),
            (slack, True, lambda by: _window(after - by, 0.6, own)),
            (10_000.0, True, _many),
            (1.0 - 1e-9, False, lambda n: _stated(1.0 - (1.0 - n) * 2.5e-6)),
            (10_000.0, True, _stated),
            (1.0, True, _lossy_wave),
        )
    )


# --- Motion -----------------------------------------------------------------------------------------------------------


def _sound(made: float, slider: Any = None, way: float = 0.0) -> bool:
    """Whether a ledger can be of a slider that gave so much, where 3 J were put in."""
    from verify.models.catalogue import MODELS
    from verify.motion.result import Ledger
    from verify.motion.sound_books import excess_of

    rest = dict.fromkeys(("kinetic", "elastic", "slider", "damped", "rubbed", "residual"), 0.0)
    ledger = Ledger(work_in=-1.8, contact_on_beam=0.3 * made, normal_on_beam=0.7 * made, **rest)
    asked: Any = SimpleNamespace(slider=slider or SimpleNamespace(normal="massless"))
    found = excess_of(ledger, 1.2, way, asked, MODELS["analytic"].time_basis(STRIP, None, 80, "spline"))
    return found is None or not abs(found.made - made) <= 1e-12 * made


def _pressing(way: float) -> tuple[float, bool, Callable[[float], bool]]:
    """Of a slider that presses 40 N on: its sag F^2 L^3 / (48 EI), by pi way / L, is put in as well."""
    sag = 40.0**2 * STRIP.length**3 / (48.0 * STRIP.bending_stiffness) * min(pi * way / STRIP.length, 1.0)
    slider = SimpleNamespace(normal="held", normal_force=40.0)
    return 10.0 * (3.0 + sag), True, lambda made: _sound(made, slider, way)


def _began(moved: float) -> bool:
    from verify.chain.stepping import how_started
    from verify.chain.system import ChainState

    start = ChainState(np.array([0.02, -0.3]), np.array([0.7, -5.0]), 0.0)
    said = how_started(moved, start)
    return said == "consistent" or said != f"projected onto the held points: an angle or rate changed by {moved:.3g}"


def _seen(step: float) -> bool:
    from verify.motion.request import check_seen

    return taken(lambda: check_seen(step, 37.0))


def _steps(steps: float) -> bool:
    from verify.motion.request import _longest

    slider: Any = SimpleNamespace()
    return taken(lambda: _longest(37.0, 3.0, 3.0 / steps, 64, slider))


def _stage(omegas: Sequence[float], dt: float) -> Any:
    return SimpleNamespace(dt=dt, modal=SimpleNamespace(omegas=np.array(omegas)))


def _stable(field: str, two_way: bool) -> Callable[[float], bool]:
    """Whether a motor's step is taken that turns its contact, or the fastest mode, by so many radians."""
    from verify.motor.plan import _step

    def ask(radians: float) -> bool:
        request: Any = SimpleNamespace(step=1e-6)
        rate = radians * 1e6 if field == "contact" else 9e4
        omegas = [3e5, radians * 1e6 if field == "mode" else 7e5]
        return taken(lambda: _step(request, rate, _stage(omegas, 1e-6), two_way))

    return ask


def _chosen(rate: float, fastest: float) -> Callable[[float], bool]:
    """Whether the step that is chosen lies above a value, seconds."""
    from verify.motor.plan import _step

    request: Any = SimpleNamespace(step=None)
    return lambda value: _step(request, rate, _stage([0.3 * fastest, fastest], 1e-3), True) > value


def _confirmed(part: float, at_end: bool = True) -> bool:
    """Whether a slider's run is confirmed by one in half the steps that came so far from it."""
    from verify.motion.judged_step import _stands

    def ran(travelled: Sequence[float]) -> Any:
        motion = SimpleNamespace(
            end=SimpleNamespace(time=0.1), travelled=np.array(travelled), statistics=SimpleNamespace(finished=True)
        )
        return SimpleNamespace(motion=motion, excess=None)

    ways = ([0.0, -0.3 - 0.3 * part, 0.2], [0.0, -0.3, 0.2])
    ends = ([0.0, -0.3, 0.2 - 0.2 * part], [0.0, -0.3, 0.2])
    return _stands([ran(one) for one in (ends if at_end else ways)])


def _same_end(part: float) -> bool:
    from verify.motion.judged_step import moved

    def ran(time: float) -> Any:
        return SimpleNamespace(
            end=SimpleNamespace(time=time), travelled=np.zeros(3), statistics=SimpleNamespace(finished=True)
        )

    return moved(ran(0.1 * (1.0 + part)), ran(0.1)) == 0.0


def _once(radians: float) -> bool:
    """Whether a far motion is left to one run: its links turn so far, and a second would not confirm it."""
    return _known(0.5, radians)


def _known(apart: float, radians: float = 0.7) -> bool:
    from verify.chain.far import refuse_unknown

    def motion(by: float) -> Any:
        turn, height = np.array([[0.0, 0.0], [0.5 * radians, -radians]]), np.array([[0.0, 0.0], [0.1, -0.4 - 0.4 * by]])
        ahead = np.pad(np.cumsum(np.cos(turn) - 1.0, axis=1), ((0, 0), (1, 0)))
        aside = np.pad(np.cumsum(np.sin(turn), axis=1), ((0, 0), (1, 0)))
        return SimpleNamespace(
            finished=True,
            times=np.array([0.0, 0.1]),
            system=SimpleNamespace(lengths=np.ones(2)),
            displacements=np.stack([ahead, aside], axis=2),
            directions=lambda: np.arcsin(np.diff(height, axis=1, prepend=0.0)),
            statistics=SimpleNamespace(interrupted=False, stopped="stopped"),
        )

    return taken(lambda: refuse_unknown(motion(0.0), "rk4", 1e-4, lambda other: motion(apart)))


def motion_error(number: float) -> float:
    """How many limits of motions are not where they are written: books, starts, steps, what confirms a run."""
    return misplaced(
        (
            (30.0, True, _sound),
            _pressing(0.1),
            _pressing(0.5),
            (5e-9, True, _began),
            (0.25 / 37.0, True, _seen),
            (2e9, True, _steps),
            (2.0, True, _stable("contact", False)),
            (2.0, True, _stable("contact", True)),
            (pi, True, _stable("mode", True)),
            (0.5 / 7e4, True, _chosen(7e4, 1e5)),
            (0.5 * pi / 9e5, True, _chosen(7e4, 9e5)),
            (1e-3, True, _chosen(0.0, 3.0)),
            (0.004, True, _confirmed),
            (0.004, True, lambda part: _confirmed(part, at_end=False)),
            (0.01, True, _same_end),
            (0.01, True, lambda part: _same_end(-part)),
            (0.3, True, _once),
            (0.01, True, _known),
        )
    )


def row_of(name: str, error: Callable[[float], float], title: str, why: str) -> Row:
    """A row of limits: none of them elsewhere."""
    return Floor(id=name, error=error, title=title, why=why, along="1", at=(1.0,), promise=0.5)


ROWS: tuple[Row, ...] = (
    row_of(
        "limits-of-waves",
        waves_error,
        "Limits of waves, four parts in ten thousand below and above: resonances, windows, stated waves, rounding",
        "waves/poles.py, window.py, measures.py, found.py: what each limit is said to be.",
    ),
    row_of(
        "limits-of-motions",
        motion_error,
        "Limits of motions, likewise: sound books, consistent starts, steps that are taken and chosen, confirmed runs",
        "motion/sound_books.py, request.py, judged_step.py, motor/plan.py, chain/far.py, stepping.py.",
    ),
)
