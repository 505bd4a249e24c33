"""Lists in any layout that tables come in: what is read of them, and which line is wrong; sizes gone through."""

from collections.abc import Callable
from math import ceil, comb, pi
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any

import numpy as np

from verify.errors import InputError
from verify.models.arrays import Array
from verify.stress.kind import Floor, Row
from verify.stress.largest import largest
from verify.stress.limits.as_written import misplaced, taken
from verify.stress.references.beams import STRIP

# --- Texts ------------------------------------------------------------------------------------------------------------

SIX = (0.05 / 6.0, 0.05 / 18.0)
TEXTS: tuple[tuple[str, str | None, tuple[float, ...], tuple[int, ...] | None, tuple[float, ...], str], ...] = (
    ("3.5\n14.02\n31.4e1\n", None, (3.5, 14.02, 314.0), None, (0.05 / 3.5, 0.005 / 14.02, 0.5 / 314.0), "Hz"),
    ("mode,frequency_hz\n1,3.5\n2,14.0\n", None, (3.5, 14.0), (1, 2), (0.05 / 3.5, 0.05 / 14.0), "Hz"),
    ("0;3,50\n1;14,25\n", None, (3.5, 14.25), (1, 2), (0.005 / 3.5, 0.005 / 14.25), "Hz"),
    ("n\tomega (rad/s)\n2\t6.0\n5\t18.0\n", None, (3.0 / pi, 9.0 / pi), (2, 5), (0.05 / 6.0, 0.05 / 18.0), "rad/s"),
    ("# kHz\n\n0.25\n1.5D0\n", None, (250.0, 1500.0), None, (0.005 / 0.25, 0.05 / 1.5), "kHz"),
    ("3,5\n14,25\n", None, (3.5, 14.25), None, (0.05 / 3.5, 0.005 / 14.25), "Hz"),
    ("1,5\n2,25\n3,40\n", None, (5.0, 25.0, 40.0), (1, 2, 3), (0.5 / 5.0, 0.5 / 25.0, 0.5 / 40.0), "Hz"),
    ("1 3,5\n2 14,25\n", None, (3.5, 14.25), (1, 2), (0.05 / 3.5, 0.005 / 14.25), "Hz"),
    ("damping,freq\n0.01,3.5\n0.02,9.25\n", None, (3.5, 9.25), None, (0.05 / 3.5, 0.005 / 9.25), "Hz"),
    ("0\n3.1234567890123456789\n", None, (0.0, 3.1234567890123456789), None, (0.0, 1e-16), "Hz"),
    ("mode number circular frequency [rad/s]\n1 6.0\n2 18.0\n", None, (3.0 / pi, 9.0 / pi), (1, 2), SIX, "rad/s"),
    ("natural frequency in kHz\n0.25\n1.5\n", None, (250.0, 1500.0), None, (0.005 / 0.25, 0.05 / 1.5), "kHz"),
    ("mode,measured\n1,3.5\n2,14.0\n", None, (3.5, 14.0), (1, 2), (0.05 / 3.5, 0.05 / 14.0), "Hz"),
    ("6.0\n18.0\n", "rad/s", (3.0 / pi, 9.0 / pi), None, (0.05 / 6.0, 0.05 / 18.0), "rad/s"),
    ('mode "f"\n"1" "3.5"\n"4" "9"\n', None, (3.5, 9.0), (1, 4), (0.05 / 3.5, 0.5 / 9.0), "Hz"),
)
"""A file, the unit that somebody says; hertz, mode numbers, rounding, unit."""
WRONG: tuple[tuple[str, str], ...] = (
    ("3.5\n-14\n", "line 2 has -14.0: frequencies are not negative"),
    ("3.5\n\n14\n9\n", "line 4: 9.0 lies below 14.0 before it"),
    ("1,3.5\n2,\n", "line 2 has a gap where a frequency should stand"),
    ("3.5\nseven\n", "line 2: 'seven' is no number"),
    ("3.5\nnan\n", "line 2: nan is no frequency"),
    ("1,3.5\n2,4.5,7\n", "line 2 has 3 cells and the first row 2"),
    ("mode,hz\n1,3.5\n1,4.5\n", "line 3: mode number 1 is no whole number above the one before"),
    ("mode,hz\n1.5,3.5\n", "line 2: mode number 1.5 is no whole number"),
    ("mode,hz\n2001,3.5\n", "line 2: mode number 2001"),
    ("1.5,3.5\n2.5,4.5\n", "has 2 columns, and which holds the frequencies cannot be told"),
    ("3,3.5\n4,4.5\n", "has 2 columns"),
    ("a b c d e\n1 3.5 2\n2 4.5 2\n", "has 3 columns, and which"),
    ("mode,x,y\n1,3.5,2\n", "has 3 columns, and which"),
    ("hz\n", "has a head and no numbers"),
    ("# nothing\n", "is empty"),
    ("3\n" * 2001, "has 2001 rows: give at most 2000"),
)
SHAPES: tuple[tuple[str, int, str], ...] = (
    ("x,a\n0,0\n0.3,1\n0.73,0.2\n", 1, ""),
    ("0 0 1\n0.3 1 2\n0.73 0.2 3\n", 2, ""),
    ("0,0\n0.3,1\n0.73,0.2\n", 2, "has 1 mode shapes beside x, and the list 2 frequencies"),
    ("0,0\n0.73,1\n", 1, "has 2 places: give the shapes at three or more"),
    ("0,0\n0.4,1\n0.4,1\n0.73,0\n", 1, "x = 0.4 m does not rise"),
    ("0,0\n0.4,1\n0.74,0\n", 1, "x = 0.74 m lies off the beam"),
    ("-0.01,0\n0.4,1\n0.7,0\n", 1, "x = -0.01 m lies off the beam"),
    ("0,0,1\n0.4,0,1\n0.7,0,2\n", 2, "the shape of mode 1 is zero everywhere"),
)


def _refused(ask: Callable[[], object], said: str) -> bool:
    try:
        ask()
    except InputError as error:
        return bool(said) and said in str(error)
    return not said


def read_error(number: float) -> float:
    """How many lists are read as other hertz, numbers or digits than they have, or their faults not told by line."""
    from verify.identify.reading import read_frequencies, read_shapes

    wrong = 0
    with TemporaryDirectory() as folder:
        path = Path(folder) / "list.txt"
        for text, unit, hertz, numbers, rounding, told in TEXTS:
            path.write_text(text)
            found = read_frequencies(path, unit)
            wrong += not np.allclose(found.frequencies_hz, hertz, rtol=1e-14, atol=0.0) or found.n != len(hertz)
            wrong += found.numbers != numbers or found.unit != told
            wrong += not np.allclose(found.rounding, rounding, rtol=1e-12, atol=0.0)
        for text, said in WRONG:
            path.write_text(text)
            wrong += not _refused(lambda: read_frequencies(path), said)
        for text, modes, said in SHAPES:
            path.write_text(text)
            wrong += not _refused(lambda modes=modes: read_shapes(path, STRIP.length, modes), said)  # type: ignore[misc]
            if not said:
                shapes = read_shapes(path, STRIP.length, modes)
                wrong += shapes.x.tolist() != [0.0, 0.3, 0.73] or shapes.values.shape != (modes, 3)
                wrong += shapes.values[-1].tolist() != ([0.0, 1.0, 0.2] if modes == 1 else [1.0, 2.0, 3.0])
    return float(wrong)


def _listed(hertz: list[float], exact: Array) -> Any:
    from verify.identify.pairing import elastic_of
    from verify.identify.reading import Listed

    n = len(hertz)
    listed = Listed(frequencies_hz=np.array(hertz), numbers=None, rounding=np.zeros(n), source="it", unit="Hz")
    return elastic_of(listed, STRIP, exact)


def entries_error(number: float) -> float:
    """How many limits of entries that are no elastic modes are not where they are written: rigid, twice, too far."""
    exact = np.array([10.0, 40.0, 90.0])
    near = 0.003 * 4.0 * 10.0 / 40.0
    return misplaced(
        (
            (near, True, lambda part: len(_listed([part * 41.0, 41.0, 92.0], exact).kept) == 2),
            (1e-3, True, lambda part: len(_listed([10.0, 40.0, 40.0 * (1.0 + part)], exact).kept) == 2),
            (1e-3, True, lambda part: len(_listed([10.0, 40.0, 40.0 * (1.0 - part)], exact).kept) == 2),
            (3e-3, False, lambda by: len(_listed([10.0, 40.0, 40.01], exact * [1, 1, (1 + by) / 2.25]).kept) == 2),
            (90.0 * 1e6, True, lambda hertz: taken(lambda: _listed([10.0, hertz], exact))),
            (10.0 / 1e6, False, lambda hertz: taken(lambda: _listed([hertz, 40.0 * hertz], exact))),
        )
    )


# --- Sizes ------------------------------------------------------------------------------------------------------------


def gone_through_error(number: float) -> float:
    """How often sizes are gone through otherwise than one by one, 5 % apart, doubled; or the first is missed."""
    from verify.judge.sizing import _ahead, _part_s, _scanned, _walk, walked

    wrong = 0
    for first, dip, guess, uneven in ((31, 9, 5, False), (700, 8, 40, False), (3100, 5, 9, False), (170, 11, 9, True)):

        def reached(count: int, first: int = first, dip: int = dip) -> bool:
            return count >= first or count == dip

        sizes, n, failed = list[int](), 4, 3
        while n <= max(2 * failed, guess, 8):
            sizes.append(n)
            failed = failed if reached(n) else n
            n = n + 1 if n < 100 else ceil(1.05 * n) if uneven or n < 2000 else 2 * n
        enough, smaller, does = _scanned(reached, 4, guess, "segment", 0.01, uneven)
        beside = range(failed + 1, first + 100) if uneven else ()
        wrong += enough != first or smaller != dip or set(does) != {*sizes, *beside}
    wrong += [_walk(n) for n in (7, 60, 150, 1500, 2500)] != [7, 60, 100, 66, 40]
    costs = ((50, False, 3750.0), (150, False, 3000.0), (2500, False, 5000.0), (2500, True, 15e4), (150, True, 18e3))
    wrong += sum(not abs(_ahead(failed, uneven) / told - 1.0) <= 1e-12 for failed, uneven, told in costs)
    last, tried = walked(lambda count: count not in (12, 17), 11, {9: False, 11: False, 14: True})
    wrong += last != 17 or list(tried) != [9, 11, *range(12, 35)]
    laden: Any = SimpleNamespace(added=("section", "mass"))
    stepped: Any = SimpleNamespace(added=("section",))
    wrong += not abs(_part_s(laden, 30) / (1e-4 + 7.0 * 1.5e-6 * 30) - 1.0) <= 1e-12
    wrong += not abs(_part_s(stepped, 30) / (1e-4 + 1.5e-6 * 30) - 1.0) <= 1e-12
    return float(wrong)


def _herm(mu: float) -> float:
    """The error of Hermite elements at a turn of a part, by both of their equations at a node."""
    from scipy.linalg import eigh

    c, s = np.cos(mu), 1j * np.sin(mu)
    stiffness = np.array([[24.0 - 24.0 * c, 12.0 * s], [-12.0 * s, 8.0 + 4.0 * c]])
    mass = np.array([[312.0 + 108.0 * c, -26.0 * s], [26.0 * s, 8.0 - 6.0 * c]]) / 420.0
    return float(np.sqrt(eigh(stiffness, mass, eigvals_only=True)[0]) / mu**2 - 1.0)


def _links(mu: float) -> float:
    square = np.sin(0.5 * mu) ** 2
    return float(np.sqrt(48.0 * square**2 / (3.0 - 2.0 * square)) / mu**2 - 1.0)


def constants_error(number: float) -> float:
    """Of what error laws are made of: Bernoulli's numbers by their sums, where means stop, where elements err most."""
    from verify.exact import error_laws

    known = [1.0, -0.5]
    for n in range(2, 17):
        known.append(-sum(comb(n + 1, k) * one for k, one in enumerate(known)) / (n + 1.0))
    worst = max(abs(value / known[n] - 1.0) for n, value in error_laws._BERNOULLI.items())
    limit, hump = error_laws.MEAN_LIMIT, error_laws._HERMITE_HUMP
    ends = [_links(limit * (1.0 + side)) + 3.0 * _herm(limit * (1.0 + side)) for side in (-1e-10, 1e-10)]
    slopes = [_herm(hump + side + 1e-5) - _herm(hump + side - 1e-5) for side in (-2e-5, 2e-5)]
    return largest(worst, float(ends[0] * ends[1] >= 0.0), float(slopes[0] <= 0.0 or slopes[1] >= 0.0))


ROWS: tuple[Row, ...] = (
    Floor(
        id="lists-in-any-layout",
        title="Fifteen layouts of lists, eight of shapes, sixteen faults told by their line",
        why="identify/reading.py: what is written, to the last digit.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=read_error,
    ),
    Floor(
        id="entries-that-are-no-modes",
        title="Limits of entries that are rigid motions, there twice or of something else, four parts in ten thousand",
        why="identify/pairing.py: what each limit is said to be.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=entries_error,
    ),
    Floor(
        id="sizes-gone-through",
        title="Which sizes are tried until an error is kept for good, and what that is told to take",
        why="judge/sizing.py: one by one, 5 % apart, then doubled.",
        along="1",
        at=(1.0,),
        promise=0.5,
        error=gone_through_error,
    ),
    Floor(
        id="constants-of-error-laws",
        title="Bernoulli's numbers, where the mean of both errors stops telling, where elements err most",
        why="exact/error_laws.py: by their sums, by both models' dispersion.",
        along="1",
        at=(1.0,),
        promise=1e-11,
        error=constants_error,
    ),
)
