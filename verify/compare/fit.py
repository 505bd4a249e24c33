"""Ranking of candidates by the rms difference of log frequencies, and tests of faults of the list by this rms."""

from collections.abc import Iterable, Iterator, Sequence
from functools import lru_cache
from math import hypot, log, pi

import msgspec
import numpy as np

from verify.analysis.variants import is_uneven
from verify.arrays import Array, Indices
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.clamp import clamp_effect, fit_clamp
from verify.errors import InputError
from verify.problem.beam import Beam

FLOOR, TOLERANCE, AMBIGUOUS = 1e-9, 1e-3, 2.0
"""Relative error of solvers; tolerance of agreement; factor of the rms within which candidates are alternatives."""
EFFECT = 0.02
"""Largest rms over the effect of an accepted fault."""
SMALLEST, SEARCHED, LARGEST = 2, 400, 1000
"""Largest N if it is unknown; largest N of the interpolated spectra."""
FEWEST, REFINED = 3, 5
"""Least number of entries for a fault; number of candidates solved around their interpolated N."""
UNITS = {"rad/s": 2 * pi, "mHz": 1e3, "1/min": 60.0, "divided by 2 pi": 0.5 / pi, "kHz": 1e-3, "1/60 Hz": 1 / 60}
FAULTS = {
    "none": ("none", 0.0, 0),
    "unit": ("wrong unit, factor", 5.0, 0),
    "count": ("another size", 5.0, 1),
    "missing": ("missing mode", 6.0, 1),
    "extra": ("extra entry", 6.0, 2),
    "factor": ("common factor", 9.0, 1),
    "clamp": ("compliant clamp, k_r L/EI", 9.0, 1),
}
"""Title, cost in log likelihood, number of fitted parameters; an extra entry also removes one value."""


class Fault(msgspec.Struct, frozen=True, eq=False):
    """A possible fault of a list, or none; `kind` is a key of FAULTS.

    `entries` of the list, (k,) from 0, are `modes`, (k,) from 0. `label`: unit, mode, entry or ends. `factor` of all
    frequencies, None if fitted. `ends`: compliant clamps.
    """

    kind: str
    entries: Indices
    modes: Indices
    label: str = ""
    factor: float | None = 1.0
    ends: tuple[str, ...] = ()


class Fit(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A candidate and a fault fitted to a list.

    `parameter`: the factor, or the clamp's k_r L/EI. `differences` (k,): relative differences of the corrected list
    from the candidate. `effect`: rms change of log frequency by the fault. `rms` and `largest`: log differences beyond
    the rounding of the list.
    """

    candidate: Candidate
    count: int | None
    fault: Fault
    parameter: float
    differences: Array
    effect: float
    rms: float
    largest: float


class Data(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A list of frequencies and the candidates.

    `logs` (n,) of frequencies in Hz, `rounding` (n,) relative; `entries` (k,) from 0 are those of known `modes` (k,),
    `ordered` if by the order alone. `count` None: any N.
    """

    beam: Beam
    logs: Array
    rounding: Array
    members: tuple[Candidate, ...]
    entries: Indices
    modes: Indices
    ordered: bool
    count: int | None

    @property
    def n_modes(self) -> int:
        """Number of modes, with one more for a missing mode."""
        return int(self.modes.max()) + 2

    @property
    def floor(self) -> float:
        """Rms within the digits of the list."""
        return max(FLOOR, float(np.median(self.rounding)))

    def fitted(self, fit: Fit) -> int:
        """Number of fitted parameters."""
        return FAULTS[fit.fault.kind][2] + (fit.candidate.sized and self.count is None)

    def score(self, fit: Fit) -> float:
        """Minus log likelihood with noise of unknown size, and the cost of the fault."""
        return len(self.logs) * log(hypot(fit.rms, self.floor)) + FAULTS[fit.fault.kind][1]

    def accepts(self, fit: Fit) -> bool:
        """Whether a fit is evidence: small differences, more entries than parameters, and an effective fault."""
        sharp = self.floor <= 1e-8 and fit.rms <= FLOOR
        enough = len(fit.differences) - self.fitted(fit) >= (1 if sharp else 2)
        explains = fit.fault.kind not in ("factor", "clamp") or fit.rms <= EFFECT * fit.effect
        return fit.largest <= TOLERANCE and enough and explains

    def near(self, fit: Fit, best: Fit) -> bool:
        """Whether a fit is within the factor of ambiguity of the best."""
        return hypot(fit.rms, self.floor) <= AMBIGUOUS * hypot(best.rms, self.floor)


class Identification(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """Result of an identification; `status`: identified, ambiguous, exact (no discretisation), few or unknown.

    `ranking`: candidates with the likeliest fault, best first. `equivalent` fits have the frequencies of the best,
    `alternatives` (with any fault) are within a factor of two of its rms. `tested`: the best fit of every kind of
    fault, likeliest first.
    """

    status: str
    ranking: tuple[Fit, ...]
    equivalent: tuple[Fit, ...]
    alternatives: tuple[Fit, ...]
    tested: tuple[Fit, ...]

    @property
    def best(self) -> Fit:
        """The best fit."""
        return self.ranking[0]


def identify(data: Data) -> Identification:
    """Rank all candidates with the likeliest fault of the list. Raises InputError if none has enough modes."""
    tested = {"none": _best(data, [Fault("none", data.entries, data.modes)])}
    if tested["none"][0].rms > data.floor:
        faults = list(_faults(data))
        tested |= {kind: _best(data, [one for one in faults if one.kind == kind]) for kind in {f.kind for f in faults}}
    plain, firsts = tested["none"][0], [fits[0] for fits in tested.values() if fits]
    accepted = [one for one in firsts if data.accepts(one) and data.score(one) <= data.score(plain)]
    likeliest = min(accepted or [plain], key=data.score)
    best, *ranking = _best(data, [likeliest.fault], every=True)
    if data.count is not None and not any(one.candidate.sized for one in (best, *ranking)):
        raise InputError(f"count = {data.count}: no model has {data.n_modes - 1} modes, raise count")
    equal = [one for one in ranking if _same(one, best)]
    close = [one for one in ranking if one not in equal and data.near(one, best)]
    rivals = []
    for kind in tested.keys() - {best.fault.kind}:
        fits = (one for one in tested[kind] if data.near(one, best) and data.fitted(one) <= data.fitted(best))
        rivals += [one for one in fits if data.accepts(one)][:1]
    if not data.accepts(best):
        status = "unknown" if best.largest > TOLERANCE else "few"
    elif best.candidate.sized and not rivals and any(not one.candidate.sized for one in close):
        status = "exact"
    else:
        status = "ambiguous" if close or rivals else "identified"
    return Identification(
        status=status,
        ranking=(best, *ranking),
        equivalent=tuple(equal),
        alternatives=(*close, *rivals),
        tested=tuple(sorted(firsts, key=data.score)),
    )


def _faults(data: Data) -> Iterator[Fault]:
    """All faults that are tested."""
    entries, modes, n = data.entries, data.modes, len(data.logs)
    yield from (Fault("unit", entries, modes, label, factor) for label, factor in UNITS.items())
    if data.count is not None:
        yield Fault("count", entries, modes)
    if len(entries) < FEWEST:
        return
    yield Fault("factor", entries, modes, factor=None)
    clamped = tuple(n for n, held in zip(("left", "right"), data.beam.supports, strict=True) if held == "clamped")
    symmetric = data.beam.mirrored() == data.beam  # there the left end alone equals the right one
    for ends in dict.fromkeys([*((one,) for one in clamped[: 1 if symmetric else None]), clamped] if clamped else []):
        yield Fault("clamp", entries, modes, " and ".join(ends), ends=ends)
    for i in range(n if data.ordered else 0):
        yield Fault("missing", entries, np.delete(np.arange(n + 1), i), f"mode {i + 1}")
        yield Fault("extra", np.delete(entries, i), modes[:-1], f"entry {i + 1}")


def _best(data: Data, faults: Sequence[Fault], *, every: bool = False) -> list[Fit]:
    """Fits of all candidates and faults, best first: the refined ones, or with `every` those of all candidates."""
    order = {candidate: i for i, candidate in enumerate(data.members)}

    def rank(fits: Iterable[Fit | None]) -> list[Fit]:
        there = (one for one in fits if one is not None)
        return sorted(there, key=lambda one: (max(one.rms, FLOOR), order[one.candidate]))

    scanned = rank(_scanned(data, one, fault) for one in data.members for fault in faults)
    near = [*scanned[:REFINED], *[one for one in scanned[REFINED:] if not one.candidate.sized][:1]]
    if faults[0].ends:  # the scan uses the effect on the exact beam, which differs from that on the candidate
        near += [one for one in scanned if one not in near and one.candidate.theory == EULER]
    refined = rank(_refined(data, one) for one in near)
    if faults[0].kind == "none" and is_uneven(data.beam) and refined and refined[0].rms > data.floor:
        refined = rank(_refined(data, one, SEARCHED) for one in near)
    if every:
        solved = {one.candidate for one in refined}
        refined = rank([*refined, *(_solved(data, one, one.count) for one in scanned if one.candidate not in solved)])

    equal = {one.candidate for one in refined if _same(one, refined[0])}  # of these the one with least fitted
    return sorted(refined, key=lambda f: (data.fitted(f), order[f.candidate]) if f.candidate in equal else (9, 0))


def _same(one: Fit, other: Fit) -> bool:
    """Whether two candidates have equal frequencies, to rounding."""
    return bool(abs(one.differences - other.differences).max() <= 10.0 * FLOOR)


def _scanned(data: Data, candidate: Candidate, fault: Fault, counts: Sequence[int | None] = ()) -> Fit | None:
    """The fit at the best of `counts` (default: interpolated N); None if the fault does not apply."""
    if fault.ends and not candidate.springs:
        return None
    if not candidate.sized:
        counts = (None,)
    elif not counts and data.count is not None:
        near = {2 * data.count, data.count // 2, *range(data.count - 2, data.count + 3)} - {data.count}
        counts = sorted(near - set(range(SMALLEST))) if fault.kind == "count" else (data.count,)
    if counts:
        table = np.array([_logs(data.beam, candidate, size, data.n_modes) for size in counts])
    else:
        sizes, table = spectrum(data.beam, candidate, data.n_modes)
        counts, table = sizes[sizes <= SEARCHED].tolist(), table[sizes <= SEARCHED]
    raw = data.logs[fault.entries] - table[:, fault.modes]
    parameters = np.full(len(raw), fault.factor or 1.0)
    if fault.ends:
        try:
            stiffnesses, effect = clamp_effect(data.beam, fault.ends, data.n_modes)
        except InputError:
            return None
        effect = effect[:, fault.modes]
        at = np.argmin(np.sum((raw[:, None, :] - effect) ** 2, axis=2), axis=1)
        parameters, removed = stiffnesses[at], effect[at]
    else:
        factors = np.median(raw, axis=1) if fault.factor is None else np.log(parameters)
        parameters, removed = np.exp(factors), np.repeat(factors[:, None], raw.shape[1], axis=1)
    squares = np.mean((raw - removed) ** 2, axis=1)
    if not np.isfinite(squares).any():
        return None
    i = int(np.nanargmin(squares))
    return _fit(data, candidate, counts[i], fault, float(parameters[i]), raw[i] - removed[i], removed[i])


def _fit(data: Data, one: Candidate, n: int | None, fault: Fault, parameter: float, left: Array, removed: Array) -> Fit:
    """A fit from the remaining log differences `left` (k,) and those `removed` (k,) by the fault."""
    beyond = np.maximum(abs(left) - data.rounding[fault.entries], 0.0)
    effect, rms = (float(np.sqrt(np.mean(values**2))) for values in (removed, beyond))
    sizes = {"effect": effect, "rms": rms, "largest": float(beyond.max())}
    return Fit(candidate=one, count=n, fault=fault, parameter=parameter, differences=np.expm1(left), **sizes)


def _refined(data: Data, fit: Fit, around: float = 0.0) -> Fit | None:
    """The fit at the best N near the interpolated one, within 30 % if errors oscillate with N.

    `around`: least search distance.
    """
    best = _solved(data, fit, fit.count)
    if best is None or best.count is None or data.count is not None or len(data.logs) < FEWEST:
        return best
    wide = is_uneven(data.beam) and not fit.fault.ends
    around = max(around, 2 + best.count * (0.3 if wide else 0.03))
    sizes = range(max(SMALLEST, int(best.count - around)), min(SEARCHED, int(best.count + around)) + 1)
    for size in sorted(sizes, key=lambda size: abs(size - (fit.count or 0))):
        if best.rms <= data.floor:
            break
        other = _solved(data, fit, size)
        best = other if other is not None and other.rms < best.rms else best
    return best


def _solved(data: Data, fit: Fit, count: int | None) -> Fit | None:
    """A fit with the computed frequencies of a candidate at N; None if the model does not exist."""
    fault, candidate = fit.fault, fit.candidate
    if not fault.ends:
        return fit if data.count is not None else _scanned(data, candidate, fault, (count,))
    try:
        logs = data.logs[fault.entries]
        parameter, left = fit_clamp(data.beam, fault.ends, fit.parameter, candidate, count, logs, fault.modes)
    except InputError:
        return None
    return _fit(data, candidate, count, fault, parameter, left, np.full(len(logs), fit.effect))


def _logs(beam: Beam, candidate: Candidate, count: int | None, n_modes: int) -> Array:
    """Log of a candidate's frequencies, (n_modes,), NaN for missing modes."""
    try:
        hertz = frequencies_hz(candidate, beam, count, n_modes)
    except InputError:
        hertz = np.empty(0)
    return np.append(np.log(hertz), np.full(n_modes - len(hertz), np.nan))


@lru_cache(maxsize=500)
def spectrum(beam: Beam, candidate: Candidate, n_modes: int) -> tuple[Indices, Array]:
    """(N (r,), log of frequencies (r, n_modes), NaN for missing modes) of a discrete candidate for all N.

    Interpolated in 1/N between computed N and the exact beam of the same theory.
    """
    from scipy.interpolate import CubicSpline

    knots, sizes = [max(SMALLEST, n_modes // 2)], np.arange(SMALLEST, LARGEST + 1)
    while knots[-1] < 6 * n_modes:
        knots.append(max(knots[-1] + 1, round((1.3 if knots[-1] < 3 * n_modes else 1.5) * knots[-1])))
    solved = np.array([_logs(beam, candidate, size, n_modes) for size in knots])
    logs = np.full((len(sizes), n_modes), np.nan)
    if np.isnan(solved).all():
        return sizes, logs
    limit = np.log(frequencies_hz(Candidate(model=EXACT, theory=candidate.theory), beam, None, n_modes))
    for mode in np.flatnonzero(np.isfinite(solved).sum(axis=0) > 2):
        known = np.isfinite(solved[:, mode])
        x = np.append(0.0, 1.0 / np.array(knots)[known][::-1])
        inside = sizes >= np.array(knots)[known][0]
        logs[inside, mode] = CubicSpline(x, np.append(limit[mode], solved[known, mode][::-1]))(1.0 / sizes[inside])
    return sizes, logs
