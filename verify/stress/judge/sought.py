"""Sizes that are sought, models of somebody else that are asked, a motor's motion that repeats itself, two on one beam.

By sizes that are told, by sines, by a mass on a spring and a dashpot, and by each slider alone.
"""

from collections.abc import Iterator, Sequence
from math import log, pi
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam
from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.compiling import Call
from verify.slider import Contact, Foot, Slider
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.motion.sliders import BAR, FORCES, HERTZ, RATIO
from verify.stress.references.beams import STRIP

# --- Sizes ------------------------------------------------------------------------------------------------------------

MODES = np.arange(1.0, 6.0)
SIZES = (2, 3, 7, 15, 24, 41, 77, 130, 211, 301, 399)
PLACES = (0.317, 0.73)


def _fit(size: int, right: int, places: Sequence[float]) -> Any:
    """How a size fits a list of another: by the square of parts over waves, and by where places fall within a part."""

    def off(n: int) -> Array:
        within = sum((a * n) % 1.0 * (1.0 - (a * n) % 1.0) for a in places)
        return np.asarray(-0.04 * (MODES / n) ** 2 * (1.0 + 3.0 * within))

    differences = (1.0 + off(right)) / (1.0 + off(size)) - 1.0
    residual = float(np.sqrt(np.mean(np.log1p(differences) ** 2)))
    return SimpleNamespace(count=size, differences=differences, residual=residual, score=log(residual + 1e-15))


def sought_error(places: float) -> float:
    """Of eleven sizes of a list how many are not found, or not by twenty tries, of uneven ones by ninety."""
    from verify.identify.searching import best_size, closest

    wrong, among = 0, PLACES[: int(places)]
    for right in SIZES:
        asked: list[int] = []

        def tried(size: int | None, right: int = right, asked: list[int] = asked) -> Any:
            assert size is not None
            asked.append(size)
            return _fit(size, right, among) if size >= 2 else None

        found = closest(tried, among, (), lambda one: one.residual < 1e-12) if among else best_size(tried)
        wrong += found is None or found.count != right
        wrong += len(asked) > (90 if among else 20) or len(set(asked)) < len(asked)
    return float(wrong + (best_size(lambda size: None) is not None))


# --- Somebody else's --------------------------------------------------------------------------------------------------


class Sines:
    """A model as somebody else may have it: sines between pins, a part in a thousand too high."""

    fewest: ClassVar[int] = 3

    def n_elastic(self, beam: Beam, count: int) -> int:
        """As many as parts."""
        return count

    def solve_modes(self, beam: Beam, n_modes: int, count: int) -> Any:
        """Frequencies and shapes."""
        n = np.arange(1.0, n_modes + 1.0)
        hertz = self.changed(1.001 * n**2 * 0.5 * pi * beam.wave_constant / beam.length**2)
        return SimpleNamespace(frequencies_hz=hertz, deflection=lambda x: np.sin(np.outer(n, pi * x / beam.length)))

    def changed(self, hertz: Any) -> Any:
        """As it should be."""
        return hertz


class Falling(Sines):
    """From high to low."""

    def changed(self, hertz: Any) -> Any:
        """The other way round."""
        return hertz[::-1]


class Rigid(Sines):
    """With a motion that is none of bending."""

    def changed(self, hertz: Any) -> Any:
        """From nought on."""
        return hertz - hertz[0]


class Short(Sines):
    """With fewer than are asked for."""

    def changed(self, hertz: Any) -> Any:
        """One less."""
        return hertz[1:]


class Lossy(Sines):
    """Complex."""

    def changed(self, hertz: Any) -> Any:
        """By a loss."""
        return hertz * (1.0 + 0.1j)


class Broken(Sines):
    """With one that is no number."""

    def changed(self, hertz: Any) -> Any:
        """The third."""
        return np.where(np.arange(len(hertz)) == 2, np.nan, hertz)


class Words(Sines):
    """With none at all."""

    def changed(self, hertz: Any) -> Any:
        """In words."""
        return "soon"


class Raising(Sines):
    """That gives up."""

    def changed(self, hertz: Any) -> Any:
        """By an error of its own."""
        raise KeyError("mode")


class Shapeless(Sines):
    """Without shapes, of no size, and with no word of how many modes it has."""

    sized: ClassVar[bool] = False
    n_elastic: Any = None

    def solve_modes(self, beam: Beam, n_modes: int, count: int | None) -> Any:
        """Frequencies alone."""
        return SimpleNamespace(frequencies_hz=1.0 + np.arange(n_modes))


class Voiceless:
    """Without the verb."""


HERE = "verify.stress.judge.sought"
ASKED: tuple[tuple[str, int | None, str], ...] = (
    ("Falling", 7, "lies below"),
    ("Rigid", 7, "elastic modes are above zero"),
    ("Short", 7, "has the shape (6,), and (7,) was asked for"),
    ("Lossy", 7, "is complex: give real numbers"),
    ("Broken", 7, "frequencies_hz[2] is not finite"),
    ("Words", 7, "is no array of numbers"),
    ("Raising", 7, "solve_modes raises KeyError"),
    ("Voiceless", 7, "has no solve_modes(beam, n_modes, count)"),
    ("Nobody", 7, "has no Nobody"),
    ("Sines", None, "count is missing"),
    ("Sines", 2, "count = 2"),
)
"""Class, parts, what is said of it."""


def asked_error(parts: float) -> float:
    """How often a model of somebody else's is not asked for what it has, or not told what is wrong with it."""
    from verify.identify.outside import asked_of

    n, k = int(parts), pi / STRIP.length
    found, hertz = asked_of(f"{HERE}:Sines", STRIP, n, None), STRIP.wave_constant * k**2 / (2.0 * pi)
    wrong = (
        not abs(found.listed.frequencies_hz / (1.001 * hertz * np.arange(1.0, min(n, 10) + 1.0) ** 2) - 1.0).max()
        <= 1e-13
    )
    x = np.linspace(0.0, STRIP.length, 201)
    shapes = found.shapes
    wrong |= (
        shapes is None or not abs(shapes.values - np.sin(np.outer(np.arange(1, min(n, 10) + 1), k * x))).max() <= 1e-12
    )
    wrong |= found.count != n or len(asked_of(f"{HERE}:Sines", STRIP, n, 2).listed.frequencies_hz) != 2
    plain = asked_of(f"{HERE}:Shapeless", STRIP, None, 4)
    wrong |= plain.shapes is not None or plain.count is not None or len(plain.listed.frequencies_hz) != 4
    missed = 0
    for name, count, said in (*((f"{HERE}:{a}", b, c) for a, b, c in ASKED), *NAMED):
        try:
            asked_of(name, STRIP, count, None)
            missed += 1
        except InputError as error:
            missed += said not in str(error)
    return float(wrong + missed)


NAMED = (
    ("verify.stress.judge.sought", 7, "write it as package.module:Class"),
    (":Sines", 7, "write it as package.module:Class"),
    ("verify.stress.nowhere:Sines", 7, "cannot be imported"),
)


def shuffled_error(first: float) -> float:
    """How often lists in another order, with modes missing or that are none, are not paired by their shapes."""
    from verify.identify.pairing import by_shape, missing, swapped
    from verify.identify.reading import Shapes

    x, start = np.linspace(0.0, STRIP.length, 41), int(first)
    order = np.array([start + 1, start, start + 3, start + 4])
    values = np.sin(np.outer(order, pi * x / STRIP.length)) * np.array([[3.0], [-0.2], [1e-6], [40.0]])
    hump = np.exp(-(((x - 0.1) / 0.02) ** 2))
    kept = np.array([1, 2, 3, 4, 5])
    shapes = Shapes(x=x, values=np.vstack([np.zeros(len(x)), values, hump]))
    pairs, likeness, told = by_shape(STRIP, shapes, kept)
    wrong = pairs.entries.tolist() != [0, 1, 2, 3] or (pairs.modes + 1).tolist() != order.tolist()
    wrong |= not abs(likeness - 1.0).max() <= 1e-9 or [one.words[:31] for one in told] != [
        "the shape of entry 6 is like no"
    ]
    words = [one.words for one in swapped(pairs)]
    wrong |= words != [f"modes {start}, {start + 1} are exchanged: by their shapes they are {start + 1}, {start}"]
    gone = [*range(1, start), start + 2]
    said = f"mode {gone[0]} is missing" if len(gone) == 1 else f"modes {', '.join(map(str, gone))} are missing"
    words = [one.words for one in missing(pairs, kept)]
    wrong |= words != [f"{said} from the list", "entry 6 is none of the beam's bending modes"]
    return float(wrong)


# --- A motion that repeats itself -------------------------------------------------------------------------------------

STIFF, DAMPED = 2.7e5, 31.0
STANDS = Slider(
    mass=0.021,
    mu=0.07,
    slope=9.0,
    gravity=0.0,
    preload=260.0,
    position=0.0579,
    coupling="one-way",
    contact=Contact(stiffness=STIFF, damping=DAMPED),
    foot=(Foot(mass=0.006),),
)


def repeated_error(steps: float) -> float:
    """Of a foot that a small wave moves on its spring and dashpot: height, rate, multipliers, over steps^-2."""
    from verify.motor.case import MotorCase
    from verify.motor.shooting import _size, periodic

    small = tuple(replace(one, amplitude=1e-3 * one.amplitude) for one in FORCES)
    case = MotorCase(
        beam=BAR,
        forces=small,
        frequency_hz=HERTZ,
        slider=STANDS,
        model="fem",
        count=2,
        modal_damping=RATIO,
        steps_per_period=int(steps),
    )
    found, omega, mass = periodic(case, settle=1), 2.0 * pi * HERTZ, 0.006
    lift = complex(case.field().deflection([0.0579])[0])
    swing = lift * (STIFF + 1j * omega * DAMPED) / (STIFF + 1j * omega * DAMPED - mass * omega**2)
    exact = np.array([swing.real - 260.0 / STIFF, -omega * swing.imag])
    off = abs(found.state.feet[0, :2] - exact) / abs(swing) / np.array([1.0, omega])
    rates = np.roots([mass, DAMPED, STIFF])
    own = np.sort_complex(np.exp(rates / HERTZ))
    apart = abs(np.sort_complex(found.multipliers) - own).max()
    sized = _size(found.run) / abs(exact[0]) / np.array([1.0, omega, 1.0, omega])
    return float(largest(*off, apart, found.missed, abs(sized - 1.0).max(), float(not found.stable)))


def each_alone_error(speed: float) -> float:
    """Of two sliders on one beam that does not feel them, against each alone: way, speed, heights, what presses."""
    from verify.motor.run import run_motor, run_motors

    other = replace(STANDS, mass=0.013, position=0.081, preload=120.0, foot=(Foot(length=0.008, points=2, mass=0.004),))
    given: dict[str, Any] = {"model": "fem", "count": 2, "modal_damping": RATIO, "start": "rest", "samples": 4}
    given |= {"step": 2e-6}
    span, worst = 0.4 / HERTZ, 0.0
    pair = run_motors(BAR, FORCES, HERTZ, span, sliders=(STANDS, other), held_speed=(None, speed), **given)
    for run, slider, held in zip(pair, (STANDS, other), (None, speed), strict=True):
        alone = run_motor(BAR, FORCES, HERTZ, span, slider=slider, held_speed=held, **given)
        pairs = [(getattr(run, name), getattr(alone, name)) for name in ("travelled", "speed", "height", "pressures")]
        pairs += [(run.normal_force, alone.normal_force), (run.state.feet, alone.state.feet)]
        worst = largest(worst, *(float(abs(a - b).max() / (abs(b).max() or 1.0)) for a, b in pairs))
    try:
        run_motors(BAR, FORCES, HERTZ, span, sliders=(STANDS, other), held_speed=(speed,), **given)
    except InputError as error:
        return worst if "has 1 of them for 2 sliders" in str(error) else 1.0
    return 1.0


def _loops() -> Iterator[Call]:
    from verify.motor import warm

    return warm.on_springs("tanh", "one-way")


ROWS: tuple[Row, ...] = (
    Floor(
        id="sizes-sought",
        title="Sizes of lists that nobody says, sought among 2 to 400: by powers of 1/N, and of where places fall",
        why="identify/searching.py: the best of all sizes, by few of them.",
        along="places",
        at=(0.0, 2.0),
        promise=0.5,
        error=sought_error,
    ),
    Floor(
        id="models-of-others-asked",
        title="A model of somebody else's asked for its modes, and what is told of twelve that are wrong",
        why="identify/outside.py: what it gives as it gives it, else one sentence.",
        along="parts",
        at=(7.0, 13.0),
        promise=0.5,
        error=asked_error,
    ),
    Floor(
        id="shuffled-lists",
        title="Shapes in another order, of any scale, with modes missing and one that is none, paired and told",
        why="identify/pairing.py: by likeness.",
        along="first mode",
        at=(1.0, 3.0),
        promise=0.5,
        error=shuffled_error,
    ),
    Floor(
        id="foot-that-repeats",
        title="A foot that a wave moves on its spring and dashpot, by shooting: height, rate, multipliers",
        why="motor/shooting.py: the map of a period, whose steps are of order 2.",
        along="steps",
        at=(400.0,),
        promise=2e-4,
        error=repeated_error,
        kernels=_loops,
    ),
    Floor(
        id="two-sliders-each-alone",
        title="Two sliders on one beam that does not feel them, one held at a speed, against each alone",
        why="motor/run.py: to rounding.",
        along="m/s",
        at=(0.3,),
        promise=1e-11,
        error=each_alone_error,
        kernels=_loops,
    ),
)
