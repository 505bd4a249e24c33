"""Dashpots, joint armature and the number of links for a time step: what a chain is given so that it runs.

Everything holds for small vibration about rest.
"""

from collections.abc import Sequence
from dataclasses import replace
from math import exp, sqrt
from typing import NamedTuple

import numpy as np

from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.engines.describe import describe
from verify.engines.integrators import EXPLICIT_DASHPOTS, IMPLICIT_DASHPOTS, Scheme
from verify.engines.steps import Simulated, simulated_chain
from verify.errors import InputError
from verify.problem.beam import Beam
from verify.settings import DEFAULT

MARGIN = 0.9
"""Largest fraction of the stability limit: at the limit a motion does not decay."""
FOURTH_ORDER = 1.0 / 12.0
"""Newmark's beta whose frequencies are of order 4: less armature costs accuracy and wins no step."""


class Rayleigh(NamedTuple):
    """C = drag M + dashpots K, 1/s and s; `deviation` of the ratio from the request, relative, at every frequency."""

    drag: float
    dashpots: float
    deviation: Array


def rayleigh(omega: Sequence[float], zeta: Sequence[float], *, drag: bool = True, within: float = 1.0) -> Rayleigh:
    """Drag and dashpots, or dashpots alone, of ratios at frequencies (n,), 1/s: least squares of relative deviations.

    One ratio is exact by dashpots, two by both where neither is negative. Raises InputError where a deviation is beyond
    `within`.
    """
    from scipy.optimize import nnls

    w, z = np.asarray(omega, dtype=float), np.asarray(zeta, dtype=float)
    rows = np.stack([0.5 / (w * z), 0.5 * w / z], axis=1) * [drag and len(w) > 1, 1.0]
    scale = np.where(rows.any(axis=0), abs(rows).max(axis=0), 1.0)
    alpha, b = nnls(rows / scale, np.ones(len(w)))[0] / scale
    return _checked(Rayleigh(float(alpha), float(b), rows @ [alpha, b] - 1.0), w, within, drag)


def band(low: float, high: float, zeta: float, *, drag: bool = True, within: float = 1.0) -> Rayleigh:
    """Drag and dashpots, or dashpots alone, of one ratio between frequencies, 1/s, with the least worst deviation.

    R = high/low: (R^(1/2) - 1)^2/(R^(1/2) + 1)^2 of both, (R - 1)/(R + 1) of dashpots; at low, the mean, high. Raises
    InputError where it is beyond `within`.
    """
    middle, mean = sqrt(low * high), 0.5 * (low + high)
    w, b = np.array([low, middle, high]), 2.0 * zeta / (mean + middle if drag else mean)
    alpha = drag * b * low * high
    fit = Rayleigh(alpha, b, (0.5 * alpha / w + 0.5 * b * w) / zeta - 1.0)
    return _checked(fit, w, within, drag)


def _checked(fit: Rayleigh, omega: Array, within: float, drag: bool) -> Rayleigh:
    worst = int(abs(fit.deviation).argmax())
    if abs(fit.deviation[worst]) <= within:
        return fit
    means, more = ("drag and dashpots", "") if drag else ("dashpots alone", "choose an engine with drag, ")
    raise InputError(
        f"damping: by {means} the ratio at {omega[worst] / (2.0 * np.pi):.4g} Hz deviates by "
        f"{100.0 * fit.deviation[worst]:+.3g} %: {more}narrow the band or permit that deviation"
    )


def compensated(scheme: Scheme, zeta: float, omega: float, step: float) -> float:
    """Ratio of the dashpots by which a mode decays with `zeta` omega in the simulation, right at this step only.

    Raises InputError for a scheme of more than three instants, and where its own damping is more than `zeta`.
    """
    x, growth = omega * step, exp(2.0 * zeta * omega * step)
    if scheme.state or len(scheme.mass) > 3:
        raise InputError(f"damping: that of {scheme.name} is not compensated, write the ratio itself")
    # |lambda|^2 of a pair is the polynomial at lambda = 0, over its highest coefficient; both are linear in 2 zeta x
    m, c, k = (growth * below - above for below, above in zip(scheme.at(-1.0), scheme.powers[-1], strict=True))
    ratio = -(m + k * x**2) / (2.0 * x * c)
    if ratio < 0.0:
        text = f"the integrator alone damps more than {100.0 * zeta:.3g} % at this step"
        raise InputError(f"damping: {text}, give a step below {2.0 * zeta / omega:.3g} s")
    return ratio


def armature(chain: Simulated, beta: float = 0.25) -> Array:
    """Inertias on the hinges, (n,), kg m^2, max(0, beta h^2 k -+ h c/2), by which a step is one of Newmark's method.

    beta = 1/4 is the trapezoidal rule: no linear limit, no numerical damping. For this step only. It does not hold for
    large motion: undamped and about several axes it diverges at 0.01 rad (MuJoCo 4.0.0). Raises InputError for another
    scheme than semi-implicit Euler, and for springs to the ground.
    """
    sign = {IMPLICIT_DASHPOTS.name: -0.5, EXPLICIT_DASHPOTS.name: 0.5}.get(chain.scheme.name)
    if sign is None:
        raise InputError(f"armature: it lowers the frequencies of {chain.scheme.name} and wins no step, leave it out")
    k, c = np.diag(chain.stiffness), np.diag(chain.damping)
    if any((one != np.diag(np.diag(one))).any() for one in (chain.stiffness, chain.damping)):
        raise InputError("armature: springs or dashpots act on several hinges, on which it does not, leave it out")
    return np.where(k > 0.0, np.maximum(beta * chain.step**2 * k + sign * chain.step * c, 0.0), 0.0)


class Candidate(NamedTuple):
    """A number of links at a step, and of its first modes, (m,), what space and time cost.

    `space`, `time`, `error` of both: relative errors of frequency. `numerical`: damping ratio added by the integrator.
    `beta`: of the armature, 0 none. `limit`: stable step, s; with armature that of this file.
    """

    links: int
    beta: float
    omega_max: float
    limit: float
    stable: bool
    space: Array
    time: Array
    error: Array
    numerical: Array


@one_blas_thread()
def trade(
    beam: Beam,
    links: Sequence[int],
    step: float,
    scheme: Scheme,
    *,
    modes: int = 3,
    damping: float = 0.0,
    in_space: bool = False,
    wall: str = DEFAULT.wall,
) -> list[Candidate]:
    """Candidates in bending by number of links; where one does not run, also with armature.

    Armature needs dashpots (ratio `damping` of mode 1) and hinges about one axis (`armature`). Raises InputError.
    """
    found = list[Candidate]()
    for count in links:
        chain = describe(beam, count, wall=wall, in_space=in_space, damping=damping)
        every = simulated_chain(chain, step, scheme)
        plain = simulated_chain(chain, step, scheme, "bending") if in_space else every
        hertz, file = plain.modal[0][:modes] / (2.0 * np.pi), plain.modes
        space = hertz / chain.exact_hz(n_modes=len(hertz)) - 1.0
        betas = [0.0, max(FOURTH_ORDER, 0.25 - (MARGIN / (step * every.omega_max)) ** 2), 0.25]
        heavy = damping and not (in_space or chain.closed) and scheme in (IMPLICIT_DASHPOTS, EXPLICIT_DASHPOTS)
        for beta in betas if heavy else betas[:1]:
            inertias = armature(every, beta) if beta else np.zeros(1)
            run = replace(every, mass=every.mass + np.diag(inertias)) if beta else every
            # beta has its margin already, and its limit is a few percent beyond its own step
            stable = step <= (1.0 if beta else MARGIN) * run.limit
            if beta and not (stable and inertias.any()):
                continue
            after = (run if beta else plain).modes
            time = after.hz[:modes] / file.file_hz[:modes] - 1.0
            error, numerical = (1.0 + space) * (1.0 + time) - 1.0, after.zeta[:modes] - file.file_zeta[:modes]
            found.append(Candidate(count, beta, every.omega_max, run.limit, stable, space, time, error, numerical))
            if stable:
                break
    return found


def choose(candidates: Sequence[Candidate], mode: int, within: float) -> Candidate | None:
    """The stable candidate of fewest links, then of least armature, with an error `within` at a mode, if one has."""
    good = [one for one in candidates if one.stable and abs(one.error[mode - 1]) <= within]
    return min(good, key=lambda one: (one.links, one.beta), default=None)


def largest_mode(candidates: Sequence[Candidate], within: float) -> int:
    """The largest mode up to which one stable candidate has all errors `within`; 0 if none has."""
    good = [np.append(abs(one.error) <= within, False) for one in candidates if one.stable]
    return max((int((~one).argmax()) for one in good), default=0)


def largest_step(chain: Simulated, mode: int, within: float) -> float:
    """Step, s, at which a mode has half the permitted error of frequency, at most half the stability limit."""
    return min(0.5 * chain.limit, chain.step_for(mode, 0.5 * within))
