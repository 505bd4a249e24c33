"""Candidates ranked by the rms difference of log frequencies, and faults of the list tested by the same rms."""

from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import hypot, log, pi

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.analysis.variants import is_uneven
from verify.arrays import Array, Indices
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.clamp import clamp_effect, clamped_ends, fit_clamp
from verify.errors import InputError
from verify.problem.beam import Beam

FLOOR, TOLERANCE, AMBIGUOUS = 1e-9, 1e-3, 2.0
"""Relative differences that solvers leave, and those up to which a candidate agrees; factor of rms of alternatives."""
EFFECT, FLAT = 0.02, 0.95
"""Largest rms over the effect of a fitted fault; ratio of rms above which neighbouring N are not tried further."""
SMALLEST, SEARCHED, LARGEST = 2, 400, 1000
"""N where the user does not give it; the last of the interpolated spectra."""
FEWEST, REFINED = 3, 5
"""Entries for which a fault is fitted; candidates solved around their interpolated N."""
UNITS = {"rad/s": 2 * pi, "mHz": 1e3, "1/min": 60.0, "divided by 2 pi": 0.5 / pi, "kHz": 1e-3, "1/60 Hz": 1 / 60}
COST = {"none": 0.0, "unit": 5.0, "count": 5.0, "missing": 6.0, "extra": 6.0, "factor": 9.0, "clamp": 9.0}
"""Of faults, in natural logarithms of likelihood."""
FITTED = {"count": 1, "missing": 1, "extra": 2, "factor": 1, "clamp": 1}
"""Fitted parameters of faults; an extra entry is one less to fit as well."""


class Fault(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A possible fault of a list, or none."""

    kind: str
    """A key of COST."""
    entries: Indices
    """(k,), from 0, of the list, that are modes."""
    modes: Indices
    """(k,), from 0."""
    label: str = ""
    """Unit, mode, entry or ends."""
    factor: float | None = 1.0
    """Of all frequencies; None: fitted."""
    ends: tuple[str, ...] = ()
    """Compliant clamped ends."""


class Fit(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A candidate beside a list read with a fault."""

    candidate: Candidate
    count: int | None
    fault: Fault
    parameter: float
    """The factor, or the clamp's k_r L/EI."""
    differences: Array
    """(k,), relative, of the list without its fault from the candidate."""
    effect: float
    """Rms of the log frequency that the fault changes."""
    rms: float
    """Of the log differences beyond the rounding of the list."""
    largest: float
    """Of the same."""


class Data(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A list and what it is compared with."""

    beam: Beam
    logs: Array
    """(n,), of frequencies in Hz."""
    rounding: Array
    """(n,), relative."""
    members: tuple[Candidate, ...]
    entries: Indices
    """(k,), from 0: those of known mode."""
    modes: Indices
    """(k,), from 0."""
    ordered: bool
    """Whether the order alone says which mode an entry is."""
    count: int | None

    @property
    def n_modes(self) -> int:
        """Modes, and one more that may be missing."""
        return int(self.modes.max()) + 2

    @property
    def floor(self) -> float:
        """Rms that the digits of the list do not resolve."""
        return max(FLOOR, float(np.median(self.rounding)))

    def fitted(self, fit: Fit) -> int:
        """Number of fitted parameters."""
        return FITTED.get(fit.fault.kind, 0) + (fit.candidate.sized and self.count is None)

    def score(self, fit: Fit) -> float:
        """Minus log likelihood with noise of unknown size, and the cost of the fault."""
        return len(self.logs) * log(hypot(fit.rms, self.floor)) + COST[fit.fault.kind]

    def accepts(self, fit: Fit) -> bool:
        """Whether a fit is evidence: small differences, more entries than parameters, a fault that explains."""
        sharp = self.floor <= 1e-8 and fit.rms <= FLOOR
        enough = len(fit.differences) - self.fitted(fit) >= (1 if sharp else 2)
        explains = fit.fault.kind not in ("factor", "clamp") or fit.rms <= EFFECT * fit.effect
        return fit.largest <= TOLERANCE and enough and explains

    def near(self, fit: Fit, best: Fit) -> bool:
        """Whether a fit is within the factor of ambiguity of the best."""
        return hypot(fit.rms, self.floor) <= AMBIGUOUS * hypot(best.rms, self.floor)

    def fit(
        self, candidate: Candidate, count: int | None, fault: Fault, parameter: float, left: Array, removed: Array
    ) -> Fit:
        """A fit by the log differences `left` (k,) beside `removed` (k,) by the fault."""
        beyond = np.maximum(abs(left) - self.rounding[fault.entries], 0.0)
        effect, rms = (float(np.sqrt(np.mean(values**2))) for values in (removed, beyond))
        return Fit(
            candidate=candidate, count=count, fault=fault, parameter=parameter, differences=np.expm1(left),
            effect=effect, rms=rms, largest=float(beyond.max()),
        )  # fmt: skip


class Identification(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """What a list is."""

    status: str
    """identified, ambiguous, exact (no division visible), few (frequencies) or unknown."""
    ranking: tuple[Fit, ...]
    """Candidates with the likeliest fault, the best first."""
    equivalent: tuple[Fit, ...]
    """Of these, those with the same frequencies as the best."""
    alternatives: tuple[Fit, ...]
    """Of these, and of other faults, those within a factor of two of its rms."""
    tested: tuple[Fit, ...]
    """The best fit of every kind of fault that was tested, the likeliest first."""

    @property
    def best(self) -> Fit:
        """The best."""
        return self.ranking[0]


def identify(data: Data) -> Identification:
    """Rank all candidates by the likeliest fault of the list. Raises InputError where none has so many modes."""
    tested = {"none": _best(data, [Fault(kind="none", entries=data.entries, modes=data.modes)])}
    if tested["none"][0].rms > data.floor:
        faults = list(_faults(data))
        tested |= {kind: _best(data, [one for one in faults if one.kind == kind]) for kind in {f.kind for f in faults}}
    plain, firsts = tested["none"][0], [fits[0] for fits in tested.values() if fits]
    accepted = [one for one in firsts if data.accepts(one) and data.score(one) <= data.score(plain)]
    likeliest = min(accepted or [plain], key=data.score)
    best, *ranking = _best(data, [likeliest.fault], every=True)
    if data.count is not None and not any(one.candidate.sized for one in (best, *ranking)):
        raise InputError(f"count = {data.count}: no model of so few parts has {data.n_modes - 1} modes, raise count")
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
    """All that are tested."""
    entries, modes, n = data.entries, data.modes, len(data.logs)
    for label, factor in UNITS.items():
        yield Fault(kind="unit", entries=entries, modes=modes, label=label, factor=factor)
    if data.count is not None:
        yield Fault(kind="count", entries=entries, modes=modes)
    if len(entries) < FEWEST:
        return
    yield Fault(kind="factor", entries=entries, modes=modes, factor=None)
    for ends in clamped_ends(data.beam):
        yield Fault(kind="clamp", entries=entries, modes=modes, label=" and ".join(ends), ends=ends)
    for i in range(n if data.ordered else 0):
        yield Fault(kind="missing", entries=entries, modes=np.delete(np.arange(n + 1), i), label=f"mode {i + 1}")
        yield Fault(kind="extra", entries=np.delete(entries, i), modes=modes[:-1], label=f"entry {i + 1}")


def _best(data: Data, faults: Sequence[Fault], *, every: bool = False) -> list[Fit]:
    """The best fits of all candidates and faults, the best first: those refined, or `every` candidate's."""
    order = {candidate: i for i, candidate in enumerate(data.members)}

    def rank(fits: list[Fit]) -> list[Fit]:
        return sorted(fits, key=lambda one: (max(one.rms, FLOOR), order[one.candidate]))

    scanned = rank([fit for one in data.members for fault in faults if (fit := _scanned(data, one, fault)) is not None])
    near = [*scanned[:REFINED], *[one for one in scanned[REFINED:] if not one.candidate.sized][:1]]
    if faults[0].ends:  # scanned with the effect on the exact beam, which is not that on the candidate
        near += [one for one in scanned if one not in near and one.candidate.theory == EULER]
    refined = [fit for one in near if (fit := _refined(data, one)) is not None]
    if every:
        solved = {one.candidate for one in refined}
        refined += [fit for one in scanned if one.candidate not in solved and (fit := _solved(data, one)) is not None]
    ranked = rank(refined)
    first = [one for one in ranked if _same(one, ranked[0])]  # of equal frequencies the one with least fitted
    first.sort(key=lambda one: (data.fitted(one), order[one.candidate]))
    return [*first, *[one for one in ranked if one not in first]]


def _same(one: Fit, other: Fit) -> bool:
    """Whether two candidates have the same frequencies, to rounding."""
    return bool(abs(one.differences - other.differences).max() <= 10.0 * FLOOR)


def _scanned(data: Data, candidate: Candidate, fault: Fault) -> Fit | None:
    """The fit at the best N of its spectrum; None without so many modes, or where the fault does not apply."""
    counts: list[int | None] = [data.count]
    if fault.kind == "count" and data.count is not None:
        near = {2 * data.count, data.count // 2, *range(data.count - 2, data.count + 3)} - {data.count}
        counts = [size for size in sorted(near) if size >= SMALLEST and candidate.sized]
    sizes, table = spectrum(data.beam, candidate, data.n_modes, tuple(counts) if candidate.sized else (None,))
    if data.count is None:
        sizes, table = sizes[sizes <= SEARCHED], table[sizes <= SEARCHED]
    raw = data.logs[fault.entries] - table[:, fault.modes]
    parameters = np.full(len(raw), fault.factor or 1.0)
    if fault.ends:
        try:
            stiffnesses, effect = clamp_effect(data.beam, fault.ends, data.n_modes)
        except InputError:
            return None
        effect = effect[:, fault.modes]
        at = np.clip(np.argmin(np.sum((raw[:, None, :] - effect) ** 2, axis=2), axis=1), 1, len(effect) - 2)
        slope = 0.5 * (effect[at + 1] - effect[at - 1])
        step = np.clip(np.sum(slope * (raw - effect[at]), axis=1) / np.sum(slope**2, axis=1), -1.0, 1.0)
        parameters = stiffnesses[at] * (stiffnesses[1] / stiffnesses[0]) ** step
        removed = effect[at] + step[:, None] * slope
    else:
        factors = np.median(raw, axis=1) if fault.factor is None else np.log(parameters)
        parameters, removed = np.exp(factors), np.repeat(factors[:, None], raw.shape[1], axis=1)
    squares = np.mean((raw - removed) ** 2, axis=1)
    if not np.isfinite(squares).any() or (fault.ends and not candidate.springs):
        return None
    i = int(np.nanargmin(squares))
    size = int(sizes[i]) if candidate.sized else None
    return data.fit(candidate, size, fault, float(parameters[i]), raw[i] - removed[i], removed[i])


def _refined(data: Data, fit: Fit) -> Fit | None:
    """The fit at the best N near the interpolated one; at the best of all where errors do not fall smoothly."""
    best = _solved(data, fit)
    if best is None or best.count is None or data.count is not None:
        return best
    if is_uneven(data.beam):
        whole = fit.fault.kind == "none"
        sizes = range(SMALLEST, SEARCHED + 1) if whole else range(int(best.count / 1.2), int(1.2 * best.count) + 2)
        for size in sizes:
            other = _solved(data, replace(fit, count=size))
            best = other if other is not None and other.rms < best.rms else best
            if best.rms <= data.floor:
                break
        return best
    for step in (1, -1):
        while best.count is not None and SMALLEST < best.count < SEARCHED:
            other = _solved(data, replace(best, count=best.count + step))
            if other is None or other.rms > FLAT * best.rms:
                break
            best = other
    return best


def _solved(data: Data, fit: Fit) -> Fit | None:
    """A fit with the candidate's own frequencies at its N; None where there is no such model."""
    fault, candidate = fit.fault, fit.candidate
    if not fault.ends:
        known = data.count is not None or fit.count is None
        return fit if known else _scanned(replace(data, count=fit.count), candidate, fault)
    try:
        logs = data.logs[fault.entries]
        found, left = fit_clamp(data.beam, fault.ends, fit.parameter, candidate, fit.count, logs, fault.modes)
    except InputError:
        return None
    return data.fit(candidate, fit.count, fault, found, left, np.full(len(logs), fit.effect))


@lru_cache(maxsize=5000)
def spectrum(beam: Beam, candidate: Candidate, n_modes: int, counts: tuple[int | None, ...]) -> tuple[Indices, Array]:
    """(N (r,), log of the frequencies (r, n_modes), NaN for modes that it has not); counts = (None,): of all N.

    All N are interpolated in 1/N between some that are solved and the exact beam of the same theory; where a step or an
    attachment inside a part lets errors fall unevenly, those that are solved stand alone.
    """

    def solve(size: int | None) -> Array:
        try:
            found = frequencies_hz(candidate, beam, size, n_modes)
        except InputError:
            found = np.empty(0)
        return np.append(np.log(found), np.full(n_modes - len(found), np.nan))

    if not candidate.sized or counts != (None,):
        rows = [solve(count) for count in counts]
        return np.array([count or 0 for count in counts]), np.array(rows).reshape(len(rows), n_modes)
    uneven, table, size = is_uneven(beam), {}, max(SMALLEST, n_modes // 2)
    while size < (SEARCHED if uneven else 8 * n_modes):
        table[size] = solve(size)
        size = max(size + 1, round((1.3 if size < 3 * n_modes else 1.5) * size))
    knots, solved = np.array(list(table)), np.array(list(table.values()))
    if uneven or np.isnan(solved).all():
        return knots, solved
    from scipy.interpolate import CubicSpline

    limit = np.log(frequencies_hz(Candidate(model=EXACT, theory=candidate.theory), beam, None, n_modes))
    sizes = np.arange(SMALLEST, LARGEST + 1)
    logs = np.full((len(sizes), n_modes), np.nan)
    for mode in np.flatnonzero(np.isfinite(solved).sum(axis=0) > 2):
        known = np.isfinite(solved[:, mode])
        x, y = np.append(0.0, 1.0 / knots[known][::-1]), np.append(limit[mode], solved[known, mode][::-1])
        inside = sizes >= knots[known][0]
        logs[inside, mode] = CubicSpline(x, y)(1.0 / sizes[inside])
    return sizes, logs
