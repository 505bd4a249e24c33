"""Dashpots, joint armature and the number of links for a time step: what a chain is given so that it runs.

Everything holds for small vibration about rest.
"""

from collections.abc import Iterable, Sequence
from contextlib import suppress
from dataclasses import replace
from math import ceil, exp, inf, isfinite, sqrt
from typing import NamedTuple

import msgspec
import numpy as np

from verify.analysis.verdict import per_cent
from verify.arrays import Array
from verify.blas import one_blas_thread
from verify.engines.description import Axis, Joint, RigidChain, Steps
from verify.engines.integrators import scheme_of
from verify.engines.steps import Simulated, simulated_chain
from verify.errors import InputError
from verify.formatting import floored, with_unit
from verify.linear.step_schemes import EXPLICIT_DASHPOTS, IMPLICIT_DASHPOTS, Scheme

MARGIN = 0.9
"""Largest fraction of the stability limit: at the limit a motion does not decay."""
FOURTH_ORDER = 1.0 / 12.0
"""Newmark's beta whose frequencies are of order 4: less armature costs accuracy and wins no step."""
WEIGHTED = "MuJoCo", "Drake", "Newton"
"""Engines whose joints have an armature."""
ARMATURE = (
    "armature {:.3g} h^2 k {} h c/2: for this step alone, with the dashpots, in one plane, joint angles up to 0.3 rad "
    "(measured at h omega_max up to 12); undamped or about several axes 0.1 rad diverges"
)


class Rayleigh(NamedTuple):
    """C = drag M + dashpots K, 1/s and s; `deviation` of the ratio from the request, relative, at every frequency."""

    drag: float
    dashpots: float
    deviation: Array


def rayleigh(
    omega: Sequence[float], zeta: Sequence[float], *, drag: Array | bool = True, within: float = 1.0
) -> Rayleigh:
    """Drag and dashpots, or dashpots alone, of ratios at frequencies (n,), 1/s: least squares of relative deviations.

    One ratio is exact by dashpots, two by both where neither is negative. `drag`: whether there is, or that at each
    frequency over the first. Raises InputError where a deviation is beyond `within`.
    """
    from scipy.optimize import nnls

    w, z = np.asarray(omega, dtype=float), np.asarray(zeta, dtype=float)
    rows = np.stack([0.5 * drag * (len(w) > 1) / (w * z), 0.5 * w / z], axis=1)
    scale = np.where(rows.any(axis=0), abs(rows).max(axis=0), 1.0)
    alpha, b = nnls(rows / scale, np.ones(len(w)))[0] / scale
    return _checked(Rayleigh(float(alpha), float(b), rows @ [alpha, b] - 1.0), w, within, bool(np.any(drag)))


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
    means, more = "drag and dashpots", ""
    if not drag:
        means, more = "dashpots alone", "choose MuJoCo in a plane, which has drag, "
    raise InputError(
        f"damping: by {means} the ratio at {omega[worst] / (2.0 * np.pi):.4g} Hz deviates by "
        f"{100.0 * fit.deviation[worst]:+.3g} %: {more}"
        f"narrow the band or permit it by 'within {ceil(100.0 * abs(fit.deviation[worst]))}%'"
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
        raise InputError(f"damping: {text}, give a step below {with_unit(2.0 * zeta / omega, 's')}")
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
    """A chain for its steps, and of its first modes in bending, (m,), what space and time cost.

    `space`, `time`, `error` of both: relative errors of frequency. `numerical`: damping ratio that is not meant, of the
    integrator and of compensation. `worst`: largest error up to every mode, of space, of time with damping, of both,
    about every axis; inf: does not run. `beta`: of the armature, 0 none. `limit`: stable step, s; with armature that of
    this file.
    """

    chain: RigidChain
    beta: float
    omega_max: float
    limit: float
    stable: bool
    space: Array
    time: Array
    error: Array
    numerical: Array
    worst: Array


def with_armature(chain: RigidChain, inertias: Array, remark: str) -> RigidChain:
    """The chain with inertias, (n,), kg m^2, on the hinges about one axis, in the order of its unknowns."""
    joints = list(chain.joints)
    for (name, j, _), inertia in zip(chain.unknowns(chain.axes[0]), inertias.tolist(), strict=True):
        if not name.startswith("slide"):
            hinge = msgspec.structs.replace(joints[j].hinges[0], armature=inertia)
            joints[j] = Joint(joints[j].position, (hinge,))
    return replace(chain, joints=tuple(joints), remarks=(*chain.remarks, remark), meant=chain)


@one_blas_thread()
def trade(chains: Iterable[RigidChain], steps: Steps, *, modes: int = 3, armatures: bool = True) -> list[Candidate]:
    """Candidates in bending of chains at a step; where one does not run, also with armature.

    Armature needs dashpots at the joints alone and hinges about one axis (`armature`). Raises InputError.
    """
    scheme, step, found = scheme_of(steps.engine, steps.integrator), steps.step, list[Candidate]()
    for chain in (replace(each, steps=steps) for each in chains):
        every = simulated_chain(chain, step, scheme)
        betas = [0.0, max(FOURTH_ORDER, 0.25 - (MARGIN / (step * every.omega_max)) ** 2), 0.25]
        heavy = armatures and steps.engine in WEIGHTED and chain.damping
        heavy = heavy and not (chain.in_space or chain.closed or chain.viscosity or chain.meant)
        for beta in betas if heavy and scheme in (IMPLICIT_DASHPOTS, EXPLICIT_DASHPOTS) else betas[:1]:
            made, run = chain, every
            if beta:
                text = ARMATURE.format(beta, "-" if scheme is IMPLICIT_DASHPOTS else "+")
                made = with_armature(chain, armature(every, beta), text)
                run = simulated_chain(made, step, scheme)
            # beta has its margin already, and its limit is a few percent beyond its own step
            stable = step <= (1.0 if beta else MARGIN) * run.limit
            if beta and not (stable and (run.mass != every.mass).any()):
                continue
            errors = [step_errors(made, steps, axis, modes) for axis in chain.motions]
            each = [np.stack([abs(one[0]), np.hypot(one[1], one[3]), abs(one[2])]).max(axis=0) for one in errors]
            shared = min(map(len, each))
            worst = np.max([one[:shared] for one in each], axis=0)
            worst = np.maximum.accumulate(np.where(np.isfinite(worst) & stable, worst, inf))
            found.append(Candidate(made, beta, every.omega_max, run.limit, stable, *errors[0], worst))
            if stable:
                break
    return found


def step_errors(chain: RigidChain, steps: Steps, axis: Axis, modes: int) -> tuple[Array, Array, Array, Array]:
    """Of the first elastic modes about an axis, (m,): relative errors by space, by time, by both; damping not meant."""
    scheme = scheme_of(steps.engine, steps.integrator)
    meant, run = (simulated_chain(one, steps.step, scheme, axis) for one in (chain.meant or chain, chain))
    part, file, after = slice(meant.rigid, meant.rigid + modes), meant.modes, run.modes
    omega = meant.modal[0][part]
    space = omega / (2.0 * np.pi) / chain.exact_hz(axis, len(omega)) - 1.0
    hertz = file.file_hz[part]  # 0 of an overdamped mode
    time = np.divide(after.hz[part], hertz, out=np.ones(len(hertz)), where=hertz > 0.0) - 1.0
    return space, time, (1.0 + space) * (1.0 + time) - 1.0, after.zeta[part] - file.file_zeta[part]


def choose(candidates: Sequence[Candidate], mode: int, within: float) -> Candidate | None:
    """The stable candidate of fewest links, then of least armature, with errors `within` up to a mode, if one has."""
    good = [one for one in candidates if len(one.worst) >= mode and one.worst[mode - 1] <= within]
    return min(good, key=lambda one: (one.chain.count, one.beta), default=None)


def largest_mode(candidates: Sequence[Candidate], within: float) -> int:
    """The largest mode up to which one stable candidate has all errors `within`; 0 if none has."""
    return max((int((one.worst <= within).sum()) for one in candidates), default=0)


def largest_step(chain: Simulated, mode: int, within: float) -> float:
    """Step, s, at which an elastic mode has half the permitted errors, at most half the stability limit.

    Of frequency, relative, and of the damping ratio.
    """
    number, error = chain.rigid + mode, 0.5 * within
    return min(0.5 * chain.limit, chain.step_for(number, error), chain.step_for(number, error, damping=True))


def default_steps(chain: RigidChain, steps: Steps | None = None, mode: int = 3, within: float = 0.01) -> RigidChain:
    """The chain for the largest step of an integrator, or of MuJoCo's, that `largest_step` finds about every axis.

    Of the modes up to `mode` that are there and not overdamped.
    """
    engine, setting = steps[1:] if steps else ("MuJoCo", "implicitfast" if chain.damping else "RK4")
    found, limit, scheme = [inf], inf, scheme_of(engine, setting)
    for axis in chain.motions:
        run = simulated_chain(chain, 1.0, scheme, axis)
        limit = min(limit, run.limit)
        found.append(0.5 * run.limit)
        for number in range(1, mode + 1):
            with suppress(InputError):
                found.append(largest_step(run, number, within))
    if not 0.0 < min(found) < inf:
        raise InputError(f"integrator = {setting!r}: no step of it is stable and accurate, choose another")
    text = f"time step: at most half the errors of {per_cent(within)} up to mode {mode}"
    text += f" and half the stability limit, {with_unit(limit, 's')}" * isfinite(limit)
    return replace(chain, steps=Steps(floored(min(found), 2), engine, setting), remarks=(*chain.remarks, text))
