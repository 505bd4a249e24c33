"""What is told of a list before or without a model: time that a search takes, supports that are nearest.

And series whose length is next to whole periods, kept whole or not.
"""

from collections.abc import Iterator
from math import pi
from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.errors import InputError
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.references.beams import held
from verify.stress.references.lists import FREE, data_of, family_of, fit_of, told_of

# --- Time and periods -------------------------------------------------------------------------------------------------


def _times() -> Iterator[float]:
    """Of times that are told, relative to what was measured, and of supports."""
    from verify.identify.compare import _apart, _held_otherwise, _search_seconds, _sizes_seconds

    for modes, took in ((14, 0.18), (50, 0.40), (100, 0.73)):
        told = _search_seconds(modes, 7) / 7.0
        yield float(not 0.98 * took < told < 1.2 * took)
        yield abs(told / (0.1 + 0.0055 * modes + 2e-7 * modes**3) - 1.0)
    yield abs(_sizes_seconds(7, [30, 41]) / (1.2e-3 * 71.0) - 1.0) + abs(_sizes_seconds(25, [41]) / 0.123 - 1.0)
    yield abs(_apart(np.array([1.0, 2.0]), np.array([1.1, 3.0])) / np.log(1.5) - 1.0)
    others = [one.supports for one in _held_otherwise(FREE)]
    pairs = {frozenset(one) for one in others}
    yield float(len(others) != 9 or len(pairs) != 9 or frozenset(("clamped", "free")) in pairs)


def _periods() -> Iterator[float]:
    """Of series nearly as long as whole periods: half a thousandth less is less, a part in 1e10 is none."""
    from verify.waves.series import phasors

    hertz, each = 37.0, 40
    for short, kept in ((1e-10, 3), (5e-4, 2)):
        step = (3.0 - 3.0 * short) / (3 * each * hertz)
        times = 0.2 + step * np.arange(3 * each)
        values: Array = np.cos(2.0 * pi * hertz * times + 0.4)[:, None]
        values[: each // 2] += 50.0
        found = float(abs(phasors(np.asarray(times, dtype=float), values, hertz)[0] - np.exp(0.4j)))
        yield found if kept == 2 else float(found < 1.0)


def before_error(number: float) -> float:
    """How far times that are told before lie from what they are said to be; and series kept whole or not."""
    return float(np.max([*_times(), *_periods()]))


def supports_error(number: float) -> float:
    """How often a list that nothing explains is not told which supports it is nearest to, or where it leaves them."""
    from verify.identify.compare import _of_supports
    from verify.identify.family import exact_hz

    wrong, rough = 0, told_of(fit_of(residual=0.3))
    scene: Any = SimpleNamespace(beam=FREE)
    own, other = exact_hz(FREE, 8), exact_hz(held("pinned", "guided"), 8)
    bent = own * np.array([1.0, 1.001, 0.999, 1.0, 1.0, 1.07, 1.2, 1.3])
    noisy = other * np.array([1.0, 1.013, 1.0, 1.0, 1.5, 1.0, 2.0, 1.0])
    strange = own * np.array([1.0, 1.3, 0.6, 1.0, 1.4, 1.0, 1.0, 1.0])
    for listed, said in (
        (bent, "the first 4 frequencies lie within 0.1 % of those of the scene's beam, and number 6 is the first that"),
        (noisy, "the first 4 frequencies lie within 1.3 % of those of a pinned-guided beam, and the scene's is not"),
        (strange, ""),
        (own, ""),
        (bent[:1], ""),
    ):
        told = [one.words for one in _of_supports(scene, rough, data_of(FREE, listed, ()))]
        wrong += len(told) != bool(said) or not all(said in words for words in told)
    wrong += _of_supports(scene, told_of(fit_of(residual=0.0199)), data_of(FREE, bent, ())) != ()
    return float(wrong + _refused())


def _refused() -> bool:
    """Whether a list is taken that no model of so few parts has."""
    from verify.identify.causes import identify
    from verify.identify.compare import _of_that_size
    from verify.identify.family import exact_hz

    if identify(data_of(FREE, exact_hz(FREE, 5), (family_of(None)["half"],)), 2) is not None:
        return True
    exact = told_of(fit_of(candidate=family_of(None)["analytic"], count=None))
    data = data_of(FREE, np.ones(5), ())
    if _of_that_size(exact, data, None) is not exact or _of_that_size(told_of(fit_of()), data, 3) is None:
        return True
    for found, count in ((exact, 3), (None, 3), (None, None)):
        try:
            _of_that_size(found, data, count)
        except InputError as error:
            if f"count = {count}: no model of so few parts has the 5 modes of the list" in str(error):
                continue
        return True
    return False


ROWS: tuple[Row, ...] = (
    Floor(
        id="before-it-is-solved",
        title="Time that searches are told to take; series a little shorter than whole periods",
        why="identify/compare.py: 0.18, 0.40 and 0.85 s for each candidate; waves/series.py: whole periods.",
        along="1",
        at=(1.0,),
        promise=1e-9,
        error=before_error,
    ),
    Floor(
        id="supports-that-are-nearest",
        title="Lists that nothing explains, told which supports they are nearest to or which mode leaves the beam",
        why="identify/compare.py: the lower half, within 2 %.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=supports_error,
    ),
)
