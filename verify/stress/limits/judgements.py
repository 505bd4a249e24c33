"""Limits of judgements, and what work is estimated by: taken below and not above, to four parts in ten thousand."""

from collections.abc import Callable, Sequence
from math import sqrt
from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.beam import Beam
from verify.stress.kind import Row
from verify.stress.limits.as_written import Limit, misplaced, row_of, taken
from verify.stress.references.beams import STEPPED, STRIP, held

# --- Judgement --------------------------------------------------------------------------------------------------------

SIZES = (10.0, 20.0, 40.0, 80.0)


def _falls(order: float, due: int | None, least: float = 1.0) -> bool:
    from verify.judge.compare import settled_order

    errors = [least * (80.0 / n) ** 2.0 for n in SIZES]
    errors[0] *= 2.0 ** (order - 2.0)
    return taken(lambda: settled_order(SIZES, errors, due))


def _told(error: float) -> bool:
    """Whether an order is told of an error so small."""
    from verify.judge.compare import observed_order

    return taken(lambda: observed_order(SIZES[:3], [16.0 * error, 4.0 * error, error]))


def _bracketed(width: float) -> bool:
    from verify.judge.compare import bracket

    return taken(lambda: bracket(3.0 * (1.0 - width), 3.0))


def _paired(likeness: float) -> bool:
    """Whether a mode is taken that has so much of the exact one's shape."""
    from verify.judge.compare import paired_index

    shapes = np.array([[sqrt(likeness), sqrt(1.0 - likeness), 0.0], [0.0, 0.0, 1.0]])
    modes: Any = SimpleNamespace(model="fem", count=7, sampled=lambda: shapes)
    return taken(lambda: paired_index(modes, np.eye(3)[[0, 2]], 1, 1))


def _moving(size: float) -> bool:
    from verify.judge.compare import shape_error

    return taken(lambda: shape_error(np.full(3, 7.0 * size), np.ones(3), np.array([0.2, 0.5, 0.3]), 7.0))


def _points(errors: Sequence[float]) -> Any:
    from verify.judge.crossing import Point

    return [Point(1.0 / n, error, n) for n, error in zip(SIZES, errors, strict=False)]


def _converges(errors: Sequence[float], floor: float = 1e-30) -> int:
    """How many sizes are in the stretch that converges at order 2; 0 without one."""
    from verify.judge.crossing import Stretch, converging

    found = converging(_points(errors), (2.0, 2.0), floor)
    return len(found.points) if isinstance(found, Stretch) else 0


def _at_order(order: float) -> bool:
    return _converges([2.0**order * 0.016, 0.016, 0.004, 0.001]) == 4


def _answers(error: float) -> bool:
    return _converges([error, 0.25 * error, 0.0625 * error, error / 64.0]) == 4


def _within(error: float) -> bool:
    """Whether seconds at an error are told by the line from a size whose error is so large."""
    from verify.judge.crossing import within

    return within(_points([error, 0.01]), 0.02) != 20.0


def judgement_error(number: float) -> float:
    """How many limits of judgements are not where they are written: orders, brackets, pairs, what is at rest."""
    return misplaced(
        (
            (3.0, True, lambda order: _falls(order, 2)),
            (1.0, False, lambda order: _falls(order, 2)),
            (3.0, True, lambda order: _falls(order, None)),
            (50.0 * 2e-14, False, _told),
            (10.0 * 2e-14, False, _bracketed),
            (0.5, False, _paired),
            (1e-11, False, _moving),
            (3.0, True, _at_order),
            (1.0, False, _at_order),
            (0.5, True, _answers),
            (0.5, True, _within),
        )
    )


# --- Work -------------------------------------------------------------------------------------------------------------


def _begun(ask: Callable[[], object]) -> Callable[[float], bool]:
    """Whether work is begun where somebody waits for so many seconds."""
    from verify.patience import patient

    def asked(seconds: float) -> bool:
        with patient(seconds):
            return taken(ask)

    return asked


def _above(seconds: Callable[[], float]) -> Callable[[float], bool]:
    return lambda value: seconds() < value


def _paced(evaluations: float) -> Callable[[float], bool]:
    """Whether a chain's run goes on whose rest is reckoned by its pace so far, or of late where that is quicker."""
    from verify.chain.stepping import _Pace

    def asked(most: float) -> bool:
        counts = np.array([0.0, 0.0, 100.0])
        run: Any = SimpleNamespace(
            m=SimpleNamespace(clock=np.array([0.1]), samples=np.array([0.2, 1.1]), counts=counts),
            system=SimpleNamespace(n_links=7),
        )
        pace, told = _Pace(run, 1e9), []
        for time, done, allowed in ((0.3, 100.0, 1e9), (0.5, evaluations, most)):
            run.m.clock[0], counts[2], pace.most = time, done, allowed
            if not taken(lambda: told.append(pace.part())):
                return False
        return bool(np.allclose(told, (0.2, 0.4), rtol=1e-12))

    return asked


def _solving() -> tuple[Limit, ...]:
    """Seconds and bytes of eigenvalue problems."""
    from verify.models import eigen

    return (
        (1e-9 * 210**3, False, _above(lambda: eigen.solve_seconds(210, 9))),
        (1e-9 * 3000**3, False, _above(lambda: eigen.solve_seconds(3000, 751))),
        (3000 * (1.5e-5 + 9e-7 * 750 + 5e-9 * 750**2), False, _above(lambda: eigen.solve_seconds(3000, 750))),
        (251 * (1.5e-5 + 9e-7 + 5e-9), False, _above(lambda: eigen.solve_seconds(251, 1))),
        (64.0 * 250**2, False, _above(lambda: eigen.required_bytes(250, 1))),
        (2.5e-4 + 3e-6 * 700, False, _above(lambda: eigen.field_seconds(700))),
        (5e-4 + 8e-6 * 700, False, _above(lambda: eigen.field_seconds(700, laden=True))),
        (64.0 * 210**2, False, _above(lambda: eigen.required_bytes(210, 9))),
        (3000 * (2000.0 + 32 * 1520), False, _above(lambda: eigen.required_bytes(3000, 750))),
    )


def _riding(felt: bool, dashpot: float = 0.0) -> float:
    """Seconds of 300 steps of a slider on three points, one of them with a dashpot."""
    from verify.motor import records
    from verify.motor.stepping import Riding

    points = np.zeros((3, records.DASHPOT + 1))
    points[:, records.OFFSET] = (0.01, -0.02, 0.02)
    points[1, records.DASHPOT] = dashpot
    own: Any = SimpleNamespace(feet=SimpleNamespace(points=points), two_way=felt)
    return Riding.seconds(own, 300, np.zeros((5, 4, 7)), 0.7)


def _stepping() -> tuple[Limit, ...]:
    """Seconds of steps: of a slider on a beam, of a motor, of a chain."""
    from verify.chain import work
    from verify.motion.stepping import slider_seconds

    near = 2 * 8 + 1 + 5 * 0.04 / 0.7
    ridden, damped = (
        300 * (8e-6 + 3 * (8e-7 + 4e-9 * 4 * 7 + rounds * 7e-10 * 16 * near)) + 14e-10 * 16 * near**2
        for rounds in (4.0, 6.0)
    )
    modal = 1e-3 * 600 * 3 * 40 * (2.0 + 7 / 13.0)
    return (
        (1e5 * (1.5e-6 + 1.5e-8 * 40), False, _above(lambda: slider_seconds(1e5, 40, False))),
        (1e5 * (8e-6 + 6e-8 * 40), False, _above(lambda: slider_seconds(1e5, 40, True))),
        (300 * (1e-6 + 3e-7), False, _above(lambda: _riding(False))),
        (ridden, False, _above(lambda: _riding(True))),
        (damped, False, _above(lambda: _riding(True, 0.3))),
        (19 * (150.0 + 50.0 / 0.2 * 0.6), False, _paced(150.0)),
        (19 * (350.0 + 350.0 / 0.4 * 0.6), False, _paced(350.0)),
        (modal, False, _above(lambda: 1e-3 * work.modal_work(0.6, 1e-3, 3, 40, 7))),
    )


def _waited_for() -> tuple[Limit, ...]:
    """Seconds of comparisons that are begun, and counts beyond which nothing is."""
    from verify.chain import work
    from verify.exact.modes import check_n_modes
    from verify.identify.compare import check_patience
    from verify.models import sweeps

    def exact(beam: Beam, theory: str, n_beams: int = 1) -> Callable[[float], bool]:
        return _begun(lambda: check_n_modes(beam, 700, theory, n_beams))

    thick = "timoshenko"
    return (
        (700 * 1.5e-5, False, exact(held("clamped", "free"), "euler-bernoulli")),
        (700 * 6e-4, False, exact(held("clamped", "free"), thick)),
        (700 * 6e-4, False, exact(STRIP, thick)),
        (5 * 700 * 9e-4, False, exact(STEPPED, "euler-bernoulli", 5)),
        (1.2e-3 * 700 * 2.3, False, _begun(lambda: check_patience(23, 700, 5))),
        (1.2e-3 * 700, False, _begun(lambda: check_patience(7, 700, 5))),
        (5 * (0.1 + 0.55 * 1.7 + 0.2 * 1.7**3), False, _begun(lambda: check_patience(170, None, 5))),
        (5e7 + 0.5, True, lambda n: taken(lambda: sweeps.check_held(round(n), 1, "x"))),
        (1e5, True, lambda n: taken(lambda: work.check_kept(n, 7, "samples"))),
        (2e7 / 700.0, True, lambda n: taken(lambda: work.check_kept(n, 700, "samples"))),
        (3e4, True, lambda n: taken(lambda: work.refuse_work(n, 3e4, 0.1))),
    )


def work_error(number: float) -> float:
    """How many estimates of time and memory, and the counts that bound them, are not what documents have."""
    return misplaced((*_solving(), *_stepping(), *_waited_for()), 1e-9)


ROWS: tuple[Row, ...] = (
    row_of(
        "limits-of-judgements",
        judgement_error,
        "Limits of judgements, likewise: orders, brackets, pairs of modes, shapes at rest, stretches that converge",
        "judge/compare.py, crossing.py: what each limit is said to be.",
    ),
    row_of(
        "estimates-of-work",
        work_error,
        "Seconds, bytes and counts that work is estimated by, and where it is refused, likewise",
        "eigen.py, exact/modes.py, motion/stepping.py, chain/work.py, identify/compare.py: laws of docstrings.",
    ),
)
