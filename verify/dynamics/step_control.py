"""Time steps of sliders: resolution of the motion, step doubling, energy check."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import ceil, inf

import numpy as np
from msgspec.structs import replace

from verify.dynamics.linear_system import Stage
from verify.dynamics.request import Request
from verify.dynamics.result import Motion
from verify.errors import InputError

UNRESOLVED = 1e-4
"""Largest unresolved fraction of the surface speed, rms: a hundredth of the change that `CONVERGED` allows."""
STICKY = 0.1
"""Step times K mu N / m above which a slider with tanh friction nearly sticks to a two-way coupled beam.

The displacement on a strip of 98 segments is off by 5e-4 at a tenth, by 2e-3 at two tenths, with steps above 1.4 rad of
the highest mode."""
CONVERGED = 0.01  # Largest relative change of the displacement with the doubled step of a converged run
CONTACT_RADIANS = 0.5  # Phase of the contact's natural oscillation per step, rad: period error 1 %
MODE_RADIANS = 0.5 * np.pi
"""Phase of the highest mode per step of feet on a two-way coupled beam, rad: four steps a period."""
UNSTABLE = 2.0  # Phase of the contact's natural oscillation per step at the stability limit, rad
COMPARED = 16  # Least number of samples for the comparison of two runs, which may coincide at a single one
MOST_GAIN = 0.01  # Tolerance of created energy and of the residual of the balance, relative to all energy exchanged
ROUNDINGS = 8.0
"""Rounding of the works of a step, in units of that of the elastic energy of contact: up to 1.1 of a clasp at rest."""


def unresolved(request: Request, stages: Sequence[Stage]) -> Callable[[float], float]:
    """Steps of dt, s -> fraction of the surface speed, rms, of a point slider's run that they do not resolve.

    Simpson's rule over a step has the error (omega dt / 2)^4 / 180 in the mean of a cosine; where this exceeds 1 a mode
    counts as unresolved. Modal speeds, up to a common factor, are omega |q| n pi / L, the largest of all stages: n pi/L
    is the slope of the nth mode over its deflection, whose mean square on a uniform beam is 1/mass.
    """
    starts, last, length = [request.released(stages[0])], stages[-1], request.beam.length
    if not (n := len(starts[0])):
        return lambda dt: 0.0
    for before, stage in pairwise(stages):
        end = before.whole(before.rows.after(starts[-1], before.duration), before.duration)
        starts.append(stage.free(end))
    wavenumbers, turning = np.pi / length * np.arange(1.0, n + 1.0), abs(last.rows.rates.imag)
    free = np.abs(starts).max(axis=0) * wavenumbers * turning
    if last.forced is not None:
        driven = np.linalg.norm(abs(last.forced.forward + last.forced.backward)[:, 0] * wavenumbers)
    else:
        x = np.linspace(0.0, length, 129)
        first = np.sqrt((abs(last.shapes(x, 0)[0]) ** 2).mean())
        driven = np.sqrt((abs(last.drive_shapes(x, 1)[0]) ** 2).mean()) / first
    total = np.hypot(last.omega * driven, np.linalg.norm(free))

    def share(dt: float) -> float:
        missed = free * np.minimum((0.5 * turning * dt) ** 4 / 180.0, 1.0)
        return float(np.linalg.norm(missed) / total) if total else 0.0

    return share


def point_stages(request: Request, stages: Sequence[Stage]) -> tuple[list[Stage], tuple[str, ...]]:
    """Stages of point sliders, and a note on a given step that does not resolve their motion.

    Without one the step is the largest of the drive, its half, its quarter, ... that does. Where a two-way coupled
    slider may stick, the phase of the highest mode per step is at most pi.
    """
    share, rate, longest = unresolved(request, stages), 0.0, max(stage.steps.dt for stage in stages)
    fastest = float(abs(stages[0].rows.rates.imag).max(initial=0.0))
    if request.step is None and request.two_way:  # K mu N / m, infinite for Coulomb's law
        rates = ((s.steepness or inf) * s.mu * s.normal_force / s.mass for s in request.sliders if s.mu)
        rate = max(rates, default=0.0)
        if request.sliders[0].normal == "bilateral":
            longest *= 0.5  # the contact excites waves
    step = longest
    while share(step) > UNRESOLVED or (fastest * step > np.pi and rate * step > STICKY):
        step *= 0.5
    if request.step is None:
        return [stage.stepped(step) for stage in stages], ()
    note = f"step: {100 * share(longest):.2g} % of the surface speed is not resolved, give at most {step:.2g} s"
    return list(stages), (note,) * (step < longest)


def feet_stages(request: Request, stages: Sequence[Stage], contact: float, fastest: float) -> list[Stage]:
    """Stages of sliders on springs in steps that resolve their contact and the highest mode, rad/s, or in given ones.

    Raises InputError for an unstable step.
    """
    step = request.step
    if step is None:
        limits = (CONTACT_RADIANS, contact), (MODE_RADIANS, fastest)
        step = min([stages[0].steps.dt, *(radians / omega for radians, omega in limits if omega)])
    elif contact * step >= UNSTABLE:
        raise InputError(f"step = {step!r} s is unstable: give at most {CONTACT_RADIANS / contact:.3g} s")
    return [stage.stepped(step) for stage in stages]


def change(coarse: Motion, fine: Motion) -> float:
    """Relative change of the displacements with the step: larger of that at the end and over all samples.

    Infinite for runs with different ends; 0 for runs without displacement.
    """
    apart = abs(coarse.end.time - fine.end.time)
    if coarse.statistics.finished != fine.statistics.finished or apart > CONVERGED * fine.end.time:
        return inf
    n = min(len(coarse.travelled), len(fine.travelled))
    differs, size = abs(coarse.travelled[:n] - fine.travelled[:n]), abs(fine.travelled[:n] - fine.travelled[0])
    pairs = ((float(differs[rows].max()), float(size[rows].max())) for rows in (slice(-1, None), slice(None)))
    return max(one / of if of else 0.0 if not one else inf for one, of in pairs)


def exchanged(motion: Motion) -> float:
    """Scale of the energy exchanged in a run, J; at least that at which the rounding of the contact reaches MOST_GAIN.

    Springs under constant force do work in every step that adds up to zero but for its rounding.
    """
    energy = motion.energy
    assert energy is not None
    works = (energy.drive_work, energy.tangential_work, energy.normal_work, energy.load_work, energy.elastic)
    size = max(abs(work) for work in works) + abs(energy.friction_loss) + abs(energy.slider) + energy.initial
    sliders = motion.slider if isinstance(motion.slider, tuple) else (motion.slider,)
    preloaded = sum(
        0.5 * slider.static_normal_force(foot) ** 2 / slider.contact.across(foot.length)
        for slider in sliders
        if slider and slider.contact and not slider.contact.hard
        for foot in slider.feet
    )
    rounding = ROUNDINGS * np.finfo(float).eps * motion.statistics.steps * preloaded
    return float(np.maximum(size, rounding / MOST_GAIN))  # not a number where the run is not


def checked(motion: Motion, request: Request, stages: Sequence[Stage]) -> Motion:
    """A motion with notes on its steps. Raises InputError if the energy misses more than 1 % of that exchanged.

    That is the energy that friction creates and the residual of the balance. Notes report the residual of feet, whose
    springs are of order 2 in the step, and of a beam with unresolved motion: modes advance exactly, but the work of the
    drive and the loss in the modes are quadratures.
    """
    energy, statistics, dt, scale = motion.energy, motion.statistics, motion.statistics.step_s, exchanged(motion)
    assert energy is not None
    if not np.isfinite(scale):
        raise InputError(f"step = {dt:.3g} s: the energy overflows; give smaller forces or a lighter slider")
    resolved = request.step is None or unresolved(request, stages)(dt) <= UNRESOLVED
    rest = energy.residual if resolved else energy.slider_residual
    missed = max(-energy.friction_loss, energy.created, 0.0 if request.feet else abs(rest))
    if missed > MOST_GAIN * scale > 0.0:
        raise InputError(
            f"step = {dt:.3g} s: the energy balance misses {missed:.3g} J of {scale:.3g} J exchanged; give a step "
            f"of at most {0.25 * dt:.2g} s ({ceil(4.0 / (dt * request.frequency_hz))} steps per period)"
        )
    notes, share = list(motion.notes), abs(energy.residual) / scale if scale else 0.0
    if share > MOST_GAIN:
        what = (
            "not converged, the energy balance" if request.feet or resolved else "does not resolve the drive, its work"
        )
        notes.append(f"step: {what} misses {100.0 * share:.2g} % of the energy exchanged")
    if statistics.unconverged:
        notes.append(f"step: contact forces did not converge in {statistics.unconverged} of {statistics.steps} steps")
    return replace(motion, notes=tuple(notes))
