"""Ranking of candidates by the rms difference of log frequencies, and tests of faults of the list by this rms."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import lru_cache
from math import hypot, log, pi

import msgspec
import numpy as np
from msgspec.structs import replace

from verify.analysis.variants import is_uneven
from verify.arrays import Array, Indices
from verify.compare.candidates import EULER, EXACT, Candidate, frequencies_hz
from verify.compare.discrete import STEPS
from verify.compare.effects import CAUSES, effect_of, fit_parameter
from verify.errors import InputError
from verify.exact.closed_forms import wavenumber_length
from verify.problem.beam import Beam, features

FLOOR, AGREED, AMBIGUOUS = 1e-9, 3e-6, 2.0
"""Relative error of solvers; difference beyond the digits up to which a candidate agrees with a list; factor of the rms
within which candidates are alternatives."""
PROMISING = 5e-3
"""Largest rms by interpolated N and effects of a fit that is solved."""
EFFECT = 0.02
"""Largest rms over the effect of an accepted fault."""
SMALLEST, EVERY, SEARCHED, LARGEST = 2, 40, 400, 1000
"""Least N; largest N at which other joint rules at steps are solved, if it is unknown, and of interpolated spectra."""
FEWEST, REFINED = 3, 5
"""Least number of entries for a fault; number of candidates solved around their interpolated N."""
FAULTS = {
    "none": ("none", 0.0, 0),
    "shear": ("another kappa G, factor", 4.0, 1),
    "tension": ("another axial force, factor", 5.0, 1),
    "constants": ("constants by hand, beta L to", 4.0, 1),
    "scene": ("part of the scene left out", 5.0, 0),
    "count": ("another size", 5.0, 1),
    "missing": ("missing mode", 6.0, 1),
    "extra": ("extra entry", 6.0, 2),
    "factor": ("common factor", 9.0, 1),
    "tip": ("mass at the free end over rho A L", 9.0, 1),
    "clamp": ("compliant clamp, k_r L/EI", 9.0, 1),
}
"""Title, cost in log likelihood, number of fitted parameters; an extra entry also removes one value."""
EXACTS = ("none", "shear", "constants")
"""Faults with which the exact beam is no discretisation."""


class Fault(msgspec.Struct, frozen=True, eq=False):
    """A possible fault of a list, or none; `kind` is a key of FAULTS.

    `entries` of the list, (k,) from 0, are `modes`, (k,) from 0. `label`: mode, entry, ends or part. `ends`: those
    with a compliant clamp or a mass. `decimals` of constants. `beam`: another than that of the scene.
    """

    kind: str
    entries: Indices
    modes: Indices
    label: str = ""
    ends: tuple[str, ...] = ()
    decimals: int = 0
    beam: Beam | None = None


class Fit(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A candidate and a fault fitted to a list; `digits`: relative last digit of its entries.

    `parameter`: the factor of frequencies, kappa G or axial force, the clamp's k_r L/EI, or the mass over rho A L.
    `differences` (k,): relative ones of the corrected list. `effect`: rms change of log frequency by
    the fault. `rms` and `largest`: log differences beyond the rounding of the list.
    """

    candidate: Candidate
    count: int | None
    fault: Fault
    parameter: float
    differences: Array
    effect: float
    rms: float
    largest: float
    digits: float


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
        return max(FLOOR, float(np.median(self.rounding[self.entries])))

    def fitted(self, fit: Fit) -> int:
        """Number of fitted parameters."""
        return FAULTS[fit.fault.kind][2] + (fit.candidate.sized and self.count is None)

    def score(self, fit: Fit) -> float:
        """Minus log likelihood with noise of unknown size, and the cost of the fault."""
        return len(self.entries) * log(hypot(fit.rms, self.floor)) + FAULTS[fit.fault.kind][1]

    def accepts(self, fit: Fit) -> bool:
        """Whether a fit is evidence: it agrees, with more entries than parameters, and its fault has an effect.

        A factor with an interval that contains 1 has no effect.
        """
        sharp = self.floor <= 1e-8 and fit.rms <= FLOOR
        enough = len(fit.differences) - self.fitted(fit) >= (1 if sharp else 2)
        explains = fit.rms <= EFFECT * fit.effect and fit.effect > 2.0 * self.rounding[fit.fault.entries].max()
        return self.agrees(fit) and enough and (explains or fit.fault.kind not in ("factor", "clamp", "tip", "tension"))

    def agrees(self, fit: Fit) -> bool:
        """Whether all differences are within the digits; the last digit may be off by one."""
        return bool((abs(np.log1p(fit.differences)) <= AGREED + 1.5 * self.rounding[fit.fault.entries]).all())


class Identification(msgspec.Struct, frozen=True, eq=False):
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


def identify(data: Data, progress: Callable[[str], None] = lambda step: None) -> Identification:
    """Rank all candidates with the likeliest fault of the list. Raises InputError if none has enough modes."""
    progress(f"candidates, N {data.count or f'from {SMALLEST} to {SEARCHED}'}")
    none = Fault("none", data.entries, data.modes)
    tested = {"none": _best(data, [none])}
    plain = tested["none"][0]
    if plain.candidate.sized or not data.accepts(plain):
        rivalling = ("factor", *EXACTS) if data.accepts(plain) else FAULTS
        faults = [one for one in _faults(data) if one.kind in rivalling]
        for kind in dict.fromkeys(one.kind for one in faults):
            progress(f"fault of the list: {FAULTS[kind][0].partition(',')[0]}")
            tested[kind] = _best(data, [one for one in faults if one.kind == kind])
    firsts = [fits[0] for fits in tested.values() if fits]
    accepted = [*filter(data.accepts, firsts)]
    likely = [one for one in accepted if data.score(one) <= data.score(plain)]
    exact = [one for fits in tested.values() for one in fits if not one.candidate.sized and one.fault.kind in EXACTS]
    unlikely = [] if any(map(data.agrees, exact)) else accepted  # an unlikely fault agrees, but is no claim
    best = min(likely or unlikely or [plain], key=data.score)
    ranking = _best(data, [best.fault], every=True)
    if data.count is not None and not any(one.candidate.sized for one in ranking):
        raise InputError(f"count = {data.count}: no model has {data.n_modes - 1} modes, raise count")
    best = ranking[0]
    every = [*ranking, *(one for kind, fits in tested.items() if kind != best.fault.kind for one in fits)]
    most = AMBIGUOUS * hypot(best.rms, data.floor)
    near = [one for one in every if hypot(one.rms, data.floor) <= most and data.agrees(one)]
    plain_ones = [one for one in near if not one.candidate.sized]
    exact = [one for one in plain_ones if one.fault.kind in EXACTS]
    plain_ones = [one for one in plain_ones if one.fault.kind == best.fault.kind and data.accepts(one)]
    if firm := exact or plain_ones:  # the exact beam comes before a chain that is as fine
        best = min(firm, key=lambda one: (data.fitted(one), data.score(one)))
        ranking = [best, *(one for one in ranking if one is not best)]
    same = [one for one in ranking[1:] if one.fault is best.fault and _same(one, best)]
    fits_same = (best.count, round(best.parameter, 9))  # another N or parameter is another explanation
    equal = [one for one in same if (one.count, round(one.parameter, 9)) == fits_same]
    close = [o for o in near if o is not best and o not in equal and data.fitted(o) <= data.fitted(best) + 1]
    if best.fault.kind == "none":  # with a common factor these walls are EI/l on a beam of another length
        close = [o for o in close if o.fault.kind != "factor" or o.candidate.wall not in ("welded", "rigid")]
    close = sorted(filter(data.accepts, close), key=lambda one: (one.candidate.sized, data.score(one)))
    status = "exact" if exact else "few" if not likely else "ambiguous" if close else "identified"
    if not data.accepts(best):
        status = "few" if data.agrees(best) else "unknown"
    firsts.sort(key=data.score)
    return Identification(status, tuple(ranking), tuple(equal), tuple(close), tuple(firsts))


def _faults(data: Data) -> Iterator[Fault]:
    """All faults that are tested."""
    entries, modes, n, beam = data.entries, data.modes, len(data.entries), data.beam
    if data.count is not None:
        yield Fault("count", entries, modes)
    for name in features(beam):
        if name != "section":
            without = replace(beam, **{name: () if isinstance(getattr(beam, name), tuple) else 0.0})
            yield Fault("scene", entries, modes, f"beam.{name}", beam=without)
    if len(entries) < FEWEST:
        return
    if beam.base_section.shear_stiffness and beam.base_section.rotary_inertia:
        yield Fault("shear", entries, modes)
    if beam.tension:
        yield Fault("tension", entries, modes)
    for decimals in (2, 3, 4) if beam.uniform else ():
        yield Fault("constants", entries, modes, f"{decimals} decimals", decimals=decimals)
    yield Fault("factor", entries, modes)
    clamped = tuple(n for n, held in zip(("left", "right"), beam.supports, strict=True) if held == "clamped")
    symmetric = beam.mirrored() == beam  # there the left end alone equals the right one
    for ends in dict.fromkeys([*((one,) for one in clamped[: 1 if symmetric else None]), clamped] if clamped else []):
        yield Fault("clamp", entries, modes, " and ".join(ends), ends=ends)
    if "free" in beam.supports and len(set(beam.supports)) == 2:
        end = ("left", "right")[beam.supports.index("free")]
        yield Fault("tip", entries, modes, end, ends=(end,))
    for i in range(n if data.ordered else 0):
        yield Fault("missing", entries, np.delete(np.arange(n + 1), i), f"mode {i + 1}")
        yield Fault("extra", np.delete(entries, i), modes[:-1], f"entry {entries[i] + 1}")


def _best(data: Data, faults: Sequence[Fault], *, every: bool = False) -> list[Fit]:
    """Fits of all candidates and faults, best first: the refined ones, or with `every` those of all candidates."""
    order = {candidate: i for i, candidate in enumerate(data.members)}

    def rank(fits: Iterable[Fit | None]) -> list[Fit]:
        there = (one for one in fits if one is not None)
        return sorted(there, key=lambda one: (max(one.rms, FLOOR), order[one.candidate]))

    scanned = rank(_scanned(data, one, fault) for one in data.members for fault in faults)
    near = [*scanned[:REFINED], *[one for one in scanned[REFINED:] if not one.candidate.sized][:1]]
    cause = faults[0].kind if faults else ""
    if (
        cause in CAUSES and cause != "shear"
    ):  # the scan uses the effect on the exact beam, which differs from the candidate's
        near += [one for one in scanned if one not in near and one.candidate.theory == EULER][:REFINED]
    parts = {"factor": 0.03, "clamp": 0.1, "tip": 0.1}.get(cause, np.inf)
    near = [one for one in near if one.rms < min(PROMISING, parts * one.effect) or is_uneven(data.beam)] or near[:1]
    refined = rank(_refined(data, one) for one in near)
    if faults and faults[0].kind == "none" and is_uneven(data.beam) and refined and refined[0].rms > data.floor:
        refined = rank(_refined(data, one, every=True) for one in near)
    if every:
        solved = {one.candidate for one in refined}
        refined = rank([*refined, *(_solved(data, one, one.count) for one in scanned if one.candidate not in solved)])
    by = {one.candidate: one for one in refined}
    twins = [(one, by.get(replace(one.candidate, joints="series"), one)) for one in refined]
    # joint rules at steps that agree with half links in series are left out
    refined = [one for one, twin in twins if one is twin or not _same(one, twin)]
    equal = {one.candidate for one in refined if _same(one, refined[0])}  # of these the one with least fitted
    return sorted(refined, key=lambda f: (data.fitted(f), order[f.candidate]) if f.candidate in equal else (9, 0))


def _same(one: Fit, other: Fit) -> bool:
    """Whether two candidates have equal frequencies, to rounding."""
    return bool(abs(one.differences - other.differences).max() <= 10.0 * FLOOR)


def _by_hand(data: Data, fault: Fault) -> Array:
    """Log frequency changes, (k,), by beta L or its square cut or rounded to decimals, or by multiples of pi/4.

    Of these the nearest to the list for each entry.
    """
    betas = np.array([wavenumber_length(data.beam.supports, int(mode) + 1) for mode in fault.modes])
    raw = data.logs[fault.entries] - _logs(data.beam, Candidate(model=EXACT), None, data.n_modes)[fault.modes]
    unit, changes = 10.0**fault.decimals, [2.0 * np.log(np.round(4.0 * betas / pi) * pi / 4.0 / betas)]
    for power in (1, 2):
        values = betas**power
        digits = unit / 10.0 ** np.floor(np.log10(values))
        near = np.round(values * unit) / unit, np.floor(values * unit) / unit, np.round(values * digits) / digits
        changes += [2.0 / power * np.log(one / values) for one in near]
    table = np.array(changes)
    return np.asarray(table[np.argmin(abs(raw - table), axis=0), np.arange(len(raw))])


def _scanned(data: Data, candidate: Candidate, fault: Fault, counts: Sequence[int | None] = ()) -> Fit | None:
    """The fit at the best of `counts` (default: interpolated N); None if the fault does not apply."""
    theory = {"shear": "timoshenko", "constants": EULER}.get(fault.kind)
    springs = candidate.packaged and candidate.attachment == "reciprocal" and candidate.wall != "welded"
    varies = fault.kind in CAUSES
    if (varies and not springs) or (theory and (candidate.sized or candidate.theory != theory)):
        return None
    beam = fault.beam or data.beam
    if not candidate.sized:
        counts = (None,)
    elif not counts and data.count is not None:
        near = {2 * data.count, data.count // 2, *range(data.count - 2, data.count + 3)} - {data.count}
        counts = sorted(near - set(range(SMALLEST))) if fault.kind == "count" else (data.count,)
    if counts:
        table = np.array([_logs(beam, candidate, size, data.n_modes) for size in counts])
    else:
        sizes, table = spectrum(beam, candidate, data.n_modes)
        counts = sizes[sizes <= SEARCHED].tolist()
    raw = data.logs[fault.entries] - table[: len(counts), fault.modes]
    parameters, removed = np.ones(len(raw)), np.zeros_like(raw)
    if varies:
        try:
            grid, effect = effect_of(beam, fault.kind, fault.ends, data.n_modes)
        except InputError:
            return None
        effect = effect[:, fault.modes]
        at = np.argmin(np.sum((raw[:, None, :] - effect) ** 2, axis=2), axis=1)
        parameters, removed = grid[at], effect[at]
    elif fault.kind == "constants":
        removed = _by_hand(data, fault)[None, :]
    elif fault.kind == "factor":
        factors = np.median(raw, axis=1)
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
    sizes["digits"] = float(np.median(data.rounding[fault.entries]))
    return Fit(candidate=one, count=n, fault=fault, parameter=parameter, differences=np.expm1(left), **sizes)


def _refined(data: Data, fit: Fit, *, every: bool = False) -> Fit | None:
    """The fit at the best N near the interpolated one, within 30 % if errors oscillate with N.

    `every`: at all N with an interpolated error of a third of the list's or more.
    """
    best = _solved(data, fit, fit.count)
    wide = is_uneven(data.beam) and fit.fault.kind not in CAUSES
    if best is None or best.count is None or data.count is not None or len(data.entries) < FEWEST:
        return best
    off = float(abs(best.differences - fit.differences).max())  # by interpolation: at the right N it is all there is
    if fit.rms > min(PROMISING, 10.0 * off + AGREED) and not wide:
        return best
    around = 2 + best.count * (0.3 if wide else 0.03)
    sizes = list(range(max(SMALLEST, int(best.count - around)), min(SEARCHED, int(best.count + around)) + 1))
    if every:
        known, table = spectrum(data.beam, fit.candidate, data.n_modes)
        exact = _logs(data.beam, Candidate(model=EXACT, theory=fit.candidate.theory), None, data.n_modes)[data.modes]
        errors = abs(table[:, data.modes] - exact).max(axis=1)
        sizes = known[(known <= SEARCHED) & (3.0 * errors >= abs(data.logs[data.entries] - exact).max())].tolist()
    for size in sorted(sizes, key=lambda size: abs(size - (fit.count or 0))):
        if best.rms <= data.floor:
            break
        other = _solved(data, fit, size)
        best = other if other is not None and other.rms < best.rms else best
    return best


def _solved(data: Data, fit: Fit, count: int | None) -> Fit | None:
    """A fit with the computed frequencies of a candidate at N; None if the model does not exist."""
    fault, candidate = fit.fault, fit.candidate
    if fault.kind not in CAUSES or fit.rms > PROMISING:
        return fit if data.count is not None else _scanned(data, candidate, fault, (count,))
    try:
        logs = data.logs[fault.entries]
        cause = fault.kind, fault.ends
        parameter, left = fit_parameter(data.beam, cause, fit.parameter, candidate, count, logs, fault.modes)
    except InputError:
        return None
    grid, effects = effect_of(
        data.beam, *cause, data.n_modes
    )  # of the fitted parameter, not of the nearest in the grid
    removed = [np.interp(parameter, grid, effects[:, mode]) for mode in fault.modes]
    return _fit(data, candidate, count, fault, parameter, left, np.array(removed))


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
        every = candidate.joints in STEPS and knots[-1] < EVERY  # their errors oscillate with N
        factor = 1.0 if every else 1.3 if knots[-1] < 3 * n_modes else 1.5
        knots.append(max(knots[-1] + 1, round(factor * knots[-1])))
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
