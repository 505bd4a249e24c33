"""Bending stiffness, compliance of the clamp and damping of a strip from records of its free vibration.

The exact cantilever on a rotational spring predicts. To first order a compliance C of the clamp changes all frequencies
of a free length L alike, d ln f = -2 C EI/L: one length leaves EI and C to their second order, two lengths separate
them. Damping ratios are a + b f + c/f: of a constant loss factor 2 a, of viscosity, and of drag in proportion to mass.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations, product
from math import sqrt

import numpy as np

from verify.analytic_modes import ExactModel
from verify.arrays import Array
from verify.errors import InputError
from verify.identify.beam import WALLS, frequencies, varied
from verify.identify.fit import REJECTED, Estimate, Fit, Model, Parameter, fit
from verify.identify.ring_down import BRIEF, RingDown, RingMode
from verify.problem.beam import Beam, check_features

STIFFNESS, COMPLIANCE = "bending stiffness", "compliance of the clamp"
SPARE, GUESS, SPREAD, SOFT = 2, 0.01, 0.04, (0.0, 0.03, 0.1, 0.2, 0.35, 0.6)
"""Modes above the number of frequencies that they may be; weight of the stiffness that is given against ratios of
frequencies; spread of the latter beyond which a frequency is of no mode; compliances over L/EI that are tried."""
FIRST, RIGID, WIDE, RANGE = 0.02, 1e-6, 0.5, 1e3
"""Compliance over L/EI: initial, least. Relative half width of an EI that is not known; range of EI, to both sides."""
ROUGH = 1e-3  # Error of a frequency, relative, whose effect on EI is stated
LAWS = {"a constant loss factor": 0.0, "viscosity (in proportion to f)": 1.0, "drag (in proportion to 1/f)": -1.0}
"""Powers of the frequency in damping ratios."""
FAST = 0.45  # Frequency over the sampling rate above which that of a mode above half the rate may appear
ALIKE = 0.01  # Relative difference of frequencies up to which they are one
ROUNDING = 1e-9  # Least sd of a frequency, relative, and of a damping ratio: rounding of a fit without noise
QUANTILE = 1.96  # Half width of a 95 % interval over its standard deviation


@dataclass(frozen=True)
class Damping:
    """Damping ratios by LAWS, `terms` (3,), with covariance (3, 3); zero where fewer are enough. `law`: in words."""

    terms: Array
    covariance: Array
    law: str

    def ratio(self, hz: float) -> tuple[float, float]:
        """(damping ratio, half width of its 95 % interval) at a frequency, Hz."""
        row = hz ** np.array([*LAWS.values()])
        return float(row @ self.terms), QUANTILE * sqrt(float(row @ self.covariance @ row))


@dataclass(frozen=True, eq=False)
class Strip:
    """What records of a strip determine; `stiffness` for a rigid clamp where `compliance` is None.

    `modes`: (record, mode number, mode) of every frequency that is used, `left_out`: those of no mode, Hz.
    """

    stiffness: Estimate
    compliance: Estimate | None
    damping: Damping
    modes: tuple[tuple[int, int, RingMode], ...]
    left_out: tuple[float, ...]
    off: Array  # Frequencies of `modes` over the fitted ones, less 1
    rough: bool  # Whether they differ by more than their noise, so that the intervals are by the misfit
    spread: float
    """Relative change of EI by independent errors of 0.1 % in the frequencies, as of theory; 0 for a rigid clamp."""


def identify_strip(beams: Sequence[Beam], rings: Sequence[RingDown]) -> Strip:
    """The strip of records, with the clamped-free beam of each, which differ in length alone.

    The mass of the beams is taken as given, their stiffness as a guess within a factor of 5. Raises InputError.
    """
    for beam in beams:
        check_features(beam, "identification of a strip", ())
        if beam.supports != ("clamped", "free"):
            raise InputError(f"beam.supports = {'-'.join(beam.supports)}: a strip is clamped-free, give these")
    modes, left_out = _assigned(beams, rings)
    hz, zeta = np.array([(one.hz, one.zeta) for *_, one in modes]).T
    halves = np.array([one.halves for *_, one in modes]) / QUANTILE
    noise, sd = np.maximum([halves[:, 0] / hz, halves[:, 1]], ROUNDING)
    data = np.log([one.undamped_hz for *_, one in modes])
    places = [(record, number) for record, number, _ in modes]
    model, both = _model(beams, places, noise), [STIFFNESS, COMPLIANCE]
    fitted, spread = _fit(model, data / noise, both[: len(modes)]), 0.0
    first = fitted.estimates[STIFFNESS]
    if len(modes) > 1 and first.sd < WIDE / QUANTILE * first.value:
        values = {name: one.value for name, one in fitted.estimates.items()}
        slopes = _model(beams, places, np.full(len(modes), ROUGH)).predict(values)[1]
        assert slopes
        changes = np.linalg.pinv(np.stack([slopes[name] for name in both], axis=1))[0]
        spread = float(np.linalg.norm(changes)) / first.value
    if not 0.0 < spread < WIDE:
        fitted, spread = _fit(model, data / noise, both[:1], {COMPLIANCE: 0.0}), 0.0
    compliance = fitted.estimates.get(COMPLIANCE)
    damping, off = _damping(hz, zeta, sd), fitted.residuals
    more = tuple(left_out), np.expm1(off * noise), fitted.chi2 is None, spread
    return Strip(fitted.estimates[STIFFNESS], compliance, damping, tuple(modes), *more)


def _fit(model: Model, data: Array, names: list[str], start: dict[str, float] | None = None) -> Fit:
    """With the noise of the records, or of the residuals where these are larger."""
    try:
        fitted = fit(model, data, names, start=start or {}, noise=1.0, profiles=False)
    except InputError:
        text = "no strip has the frequencies of these modes, check lengths, section and the signals"
        raise InputError(f"records: {text}") from None
    larger = fitted.fitness is not None and fitted.fitness < REJECTED
    return fit(model, data, names, start=start or {}, profiles=False) if larger else fitted


def _assigned(beams: Sequence[Beam], rings: Sequence[RingDown]) -> tuple[list[tuple[int, int, RingMode]], list[float]]:
    """(record, mode number, mode) of the frequencies that are of modes with one common factor, and the others, Hz."""
    used = [[m for m in ring.modes if abs(m.zeta) < BRIEF and m.hz < FAST * ring.rate] for ring in rings]
    left_out = [m.hz for ring, own in zip(rings, used, strict=True) for m in ring.modes if m not in own]
    longest, misfits = max(beam.length for beam in beams), 0
    while True:
        if not all(used):
            raise InputError("records: a record has no frequency below 0.45 of its sampling rate, film faster")
        count = max(len(modes) for modes in used) + SPARE
        measured = [np.log([one.undamped_hz for one in modes]) for modes in used]
        best = np.inf, tuple[tuple[int, ...], ...]()
        for soft in SOFT:
            logs = [np.log(_on_spring(beam, soft * longest / beam.bending_stiffness, count)) for beam in beams]
            for choice in product(*(combinations(range(count), len(modes)) for modes in used)):
                every = zip(measured, logs, choice, strict=True)
                ratios = np.concatenate([own - exact[list(numbers)] for own, exact, numbers in every])
                best = min(best, (float(np.ptp(ratios)) + GUESS * abs(float(ratios.mean())), choice))
        if best[0] < SPREAD:
            return [
                (record, number + 1, one)
                for record, (modes, numbers) in enumerate(zip(used, best[1], strict=True))
                for one, number in zip(modes, numbers, strict=True)
            ], left_out
        weakest = min((modes for modes in used if len(modes) > 1), key=lambda m: min(map(_size, m)), default=None)
        misfits += 1
        if weakest is None or misfits >= sum(map(len, used)) - 1:  # as many as are left, which are of any strip
            text = "their frequencies are of no strip of these lengths, check length, unit of time"
            for beam, ring in zip(beams, rings, strict=True):
                if (first := float(_on_spring(beam, 0.0, 1)[0])) > FAST * ring.rate:
                    text += f": mode 1 of {beam.length:g} m is near {first:.3g} Hz, more than {FAST} of the"
                    raise InputError(f"records: {text} {ring.rate:.3g} frames a second, film faster")
            raise InputError(f"records: {text}")
        weakest.remove(lost := min(weakest, key=_size))
        left_out.append(lost.hz)


def _on_spring(beam: Beam, compliance: float, count: int) -> Array:
    """Frequencies of the strip on a clamp of a compliance, (count,), Hz."""
    wall = {WALLS[0]: 1.0 / compliance} if compliance else {}
    return ExactModel(varied(beam, wall)).modes(count).frequencies_hz


def _size(mode: RingMode) -> float:
    """Amplitude times the radians that it lasts: a load is fitted by large modes that last a cycle."""
    return max(mode.amplitude) / max(abs(mode.zeta), 1e-4)


def _model(beams: Sequence[Beam], places: Sequence[tuple[int, int]], noise: Array) -> Model:
    """Values of ln f of (record, mode number), over its noise, by EI (N m^2) and compliance (rad/(N m))."""
    stiffness, longest = beams[0].bending_stiffness, max(beam.length for beam in beams)
    scale = longest / stiffness
    known = {STIFFNESS: Parameter(stiffness, "N m^2", stiffness / RANGE, stiffness * RANGE)}
    known[COMPLIANCE] = Parameter(FIRST * scale, "rad/(N m)", 0.0, 1e3 * scale)
    rows = [np.array([i for i, (record, _) in enumerate(places) if record == k]) for k in range(len(beams))]
    each = [
        frequencies(beam, WALLS[:1], np.array([places[i][1] for i in row]))
        for beam, row in zip(beams, rows, strict=True)
    ]

    def predict(values: dict[str, float]) -> tuple[Array, dict[str, Array]]:
        wall = 1.0 / max(values[COMPLIANCE], RIGID * longest / values[STIFFNESS])
        share = values[STIFFNESS] / stiffness
        y, by = np.empty(len(places)), {name: np.empty(len(places)) for name in known}
        for model, row in zip(each, rows, strict=True):
            own = {name: one.value for name, one in model.known.items()}
            modulus = own["youngs_modulus"] * share
            y[row], slopes = model.predict(own | {"youngs_modulus": modulus, WALLS[0]: wall})
            assert slopes
            by[STIFFNESS][row] = slopes["youngs_modulus"] * modulus / values[STIFFNESS]
            by[COMPLIANCE][row] = -(wall**2) * slopes[WALLS[0]]
        return y / noise, {name: one / noise for name, one in by.items()}

    return Model(known, predict, np.arange(float(len(places))), (("frequency", ""), ("ln f over its noise", "")))


def _damping(hz: Array, zeta: Array, sd: Array) -> Damping:
    """Weighted least squares by the fewest positive terms of LAWS whose misfit is noise."""
    from scipy.special import chdtrc

    def solve(terms: tuple[int, ...]) -> tuple[float, Array, Array]:
        """(probability of more misfit by noise, terms, covariance by the larger of noise and misfit)."""
        basis, freedom = hz[:, None] ** np.array([list(LAWS.values())[k] for k in terms]), len(hz) - len(terms)
        basis = basis / sd[:, None]
        inverse = np.linalg.inv(basis.T @ basis)
        value = inverse @ basis.T @ (zeta / sd)
        least = float(((zeta / sd - basis @ value) ** 2).sum())
        every, covariance = np.zeros(len(LAWS)), np.zeros((len(LAWS), len(LAWS)))
        every[list(terms)] = value
        covariance[np.ix_(terms, terms)] = max(least / freedom if freedom else 1.0, 1.0) * inverse
        chance = float(chdtrc(freedom, least)) if freedom else 1.0
        return chance if (value > 0.0).all() else 0.0, every, covariance

    if len(hz) == 1 or np.ptp(hz) < ALIKE * hz.max():
        return Damping(*solve((0,))[1:], "of any law, which one frequency does not tell")
    names = list(LAWS)
    for size in range(1, min(len(LAWS), len(hz)) + 1):
        fits = {terms: one for terms in combinations(range(len(LAWS)), size) if (one := solve(terms))[0] > REJECTED}
        if fits:
            words = " or ".join(" and ".join(names[k] for k in terms) for terms in fits)
            best = max(fits.values(), key=lambda one: one[0])
            return Damping(*best[1:], f"{words}, not separated" if len(fits) > 1 else words)
    return Damping(*solve((0,))[1:], "of no sum of these laws; by a constant loss factor")
