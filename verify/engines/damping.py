"""Damping ratios as they are asked for, and the dashpots and the drag of a chain that have them."""

import re
from dataclasses import replace
from math import isfinite, pi
from typing import NamedTuple

import numpy as np

from verify.analysis.verdict import per_cent
from verify.engines.choice import Rayleigh, band, compensated, rayleigh
from verify.engines.description import Axis, RigidChain, Steps, with_dashpots
from verify.engines.integrators import scheme_of
from verify.engines.steps import simulated_chain
from verify.errors import InputError, shown
from verify.linear.step_schemes import TRAPEZOIDAL
from verify.validation import check_number

EXAMPLES = "1%, '1% at 2', '1% 2% at 1,3', '1% 0.8% at 6.9,43 Hz' or '2% 5-50Hz'"
PERMITTED = 0.25
"""Deviation of a ratio from the request, relative, that is accepted unasked: two modes by least squares, R = 3 by both.

Ratios of built beams are known no better.
"""
DRAGGED = "implicit", "implicitfast", "RK4", "discrete"
"""Settings of MuJoCo in which drag acts at the time of the dashpots."""
_NUMBER = r"[\d.]+(?:e[+-]?\d+)?"
_FORM = re.compile(
    rf"({_NUMBER}%?(?:[ ,]+{_NUMBER}%?)*?)"
    rf"(?: at ({_NUMBER}(?:[ ,]+{_NUMBER})*)( ?Hz)?| ({_NUMBER}) ?- ?({_NUMBER}) ?Hz)?"
    rf"( compensated)?(?: within ({_NUMBER}%?))?"
)


class Asked(NamedTuple):
    """Ratios at modes, or at frequencies in Hz; one ratio at two frequencies is that of the band between."""

    ratios: tuple[float, ...] = (0.0,)
    at: tuple[float, ...] = (1.0,)
    in_hz: bool = False
    compensated: bool = False
    within: float = PERMITTED


def asked(damping: str | float) -> Asked:
    """A request such as 0.01, "1%" (of mode 1), and those of `EXAMPLES`. Raises InputError.

    "compensated": that the ratio is of the simulation at its step; "within 40%": a deviation that is accepted.
    """
    try:
        form = _FORM.fullmatch(str(damping).strip())
        found = [_numbers(part) for part in form.group(1, 2, 4, 5, 7)] if form else []
    except ValueError:  # 1.2.3
        found = []
    if not (form and found):
        raise InputError(f"damping = {shown(damping)}: give {EXAMPLES}")
    ratios, modes, low, high, within = found
    for ratio in ratios:
        check_number("damping", ratio, "damping ratio, 0 means none", at_least=0, below=1)
    request = Asked(ratios, modes or low + high or (1.0,), bool(form[3] or low), bool(form[6]), *within)
    alike = len(ratios) == 1 and low < high if low else len(ratios) == len(request.at)
    alike &= 0.0 not in request.at and (request.in_hz or not any(mode % 1.0 for mode in request.at))
    if not alike or (len(ratios) > 1 and not all(ratios)):
        raise InputError(f"damping = {shown(damping)}: give a ratio for each mode, or one for a band: {EXAMPLES}")
    if request.compensated and (len(ratios) > 1 or request.in_hz):
        raise InputError(f"damping = {shown(damping)}: compensate the ratio of one mode alone")
    return request


def _numbers(text: str | None) -> tuple[float, ...]:
    """Numbers, also in per cent."""
    words = re.split("[ ,]+", text) if text else []
    return tuple(float(word.rstrip("%")) / (100.0 if "%" in word else 1.0) for word in words)


def damped(chain: RigidChain, request: Asked, steps: Steps | None, *, drag: bool = False) -> RigidChain:
    """The chain with dashpots in proportion to its springs and, for more than one ratio, drag where that is possible.

    Raises InputError for a request that deviates by more than is accepted, and for an unknown mode.
    """
    ratio, times, scheme = request.ratios[0], dict[Axis, float](), scheme_of(*steps[1:]) if steps else None
    if not ratio:
        return chain
    drag &= bool(steps and steps.integrator in DRAGGED) and chain.straight and not chain.in_space
    if request.compensated and not (steps and isfinite(steps.step)):
        raise InputError("damping: it is compensated for a time step, give step and engine")
    first, fits, factor, remarks = 0.0, dict[Axis, Rayleigh](), dict[Axis, float](), list(chain.remarks)
    sizes = np.ones(1)
    if drag:
        run = simulated_chain(chain, 1.0, TRAPEZOIDAL, "bending")
        shapes = run.modal[2][:, run.rigid :]  # of unit modal mass
        sizes = np.sum(shapes * (replace(chain, viscosity=1.0).drag() @ shapes), axis=0)
    for axis in chain.motions:
        every = 2.0 * pi * chain.frequencies_hz(axis, None if request.in_hz else int(max(request.at)))
        if not request.in_hz and len(every) < max(request.at):
            raise InputError(f"damping at mode {max(request.at):g}: the chain has {len(every)} modes in {axis}")
        omega = [2.0 * pi * hz if request.in_hz else float(every[int(hz) - 1]) for hz in request.at]
        if len(omega) > len(request.ratios):
            fit = band(omega[0], omega[1], ratio, drag=drag, within=request.within)
        else:
            by_mode = drag and not request.in_hz
            shares = np.array([sizes[int(hz) - 1] / sizes[0] if by_mode else float(drag) for hz in request.at])
            fit = rayleigh(omega, request.ratios, drag=shares, within=request.within)
        hinges = chain.axes if axis == "coupled" else (axis,)
        fits[axis], times = fit, times | dict.fromkeys(hinges, fit.dashpots)
        if request.compensated and steps and scheme:
            factor |= dict.fromkeys(hinges, compensated(scheme, ratio, omega[0], steps.step) / ratio)
        first = first or 0.5 * float(fit.dashpots * every[0] + fit.drag / every[0])
    if len(request.at) > 1:
        worst = round(max(float(abs(fit.deviation).max()) for fit in fits.values()), 9)  # rounding
        means = "drag and dashpots" if drag else "dashpots alone"
        remarks.append(f"damping by {means}, {per_cent(worst)} off what was asked at worst; Maxwell branches left out")
    chain = with_dashpots(replace(chain, remarks=tuple(remarks)), times, float(f"{first:.12g}"))
    if factor:
        text = f"dashpots compensated: the asked decay at mode {request.at[0]:g}, at this step alone"
        made = with_dashpots(chain, {axis: factor[axis] * time for axis, time in times.items()}, chain.damping)
        return replace(made, remarks=(*remarks, text), meant=chain)
    return replace(chain, viscosity=float(fits[chain.motions[0]].drag / sizes[0]))
