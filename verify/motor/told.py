"""What came of a run of a slider on feet."""

from typing import TYPE_CHECKING

import numpy as np

from verify.models.arrays import Array, Indices
from verify.motion.result import Statistics
from verify.motor import records
from verify.motor.result import MotorLedger, MotorMargins, MotorRun, MotorState
from verify.motor.stepping import Riding
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.motor.run import Plan


def told(
    b: int,
    plan: "Plan",
    riding: Riding,
    stopped: str,
    modes: tuple[Array, Array],
    clock: tuple[float, float, float],
) -> MotorRun:
    """The run of slider b, with its first sample as it was put down.

    `clock` is at request, first step and end, seconds.
    """
    request, log, feet, one = plan.request, riding.log, riding.feet, plan.onto[b]
    own, feet_own = feet.owner == b, feet.keeper == b
    n = int(log.tally[records.SAMPLES])
    origin = plan.stages[0].origin
    times = np.concatenate([[origin], *(stage.origin + stage.sample_times for stage in plan.stages)])[: n + 1]
    columns = log.kept[:n, b].T
    lost = int(log.tally[records.EVENTS]) - len(log.events)
    events = _events(log.events[: int(log.tally[records.EVENTS])], np.flatnonzero(own))
    notes = (f"events: the first {len(log.events)} of {len(log.events) + lost}",) * (lost > 0)
    began, ready, end = clock
    assert riding.first is not None
    return MotorRun(
        times=times,
        slider=one.slider,
        start=one.start,
        travelled=_led(float(riding.set_off[b, 0]), columns[records.KEPT_X]),
        speed=_led(float(riding.set_off[b, 1]), columns[records.KEPT_V]),
        friction=_led(0.0, columns[records.KEPT_RUB]),
        surface_speed=_led(np.nan, columns[records.KEPT_SURFACE]),
        coupling=plan.coupling,
        statistics=Statistics(
            steps=riding.steps,
            evaluations=riding.steps,
            step_s=plan.stages[-1].dt,
            set_up_s=ready - began,
            wall_s=end - ready,
            stopped=stopped,
        ),
        notes=(*plan.notes, *notes, *_lost(columns[records.KEPT_PUSH], events, times)),
        model=request.model,
        count=request.count,
        points=request.points,
        deflection=np.concatenate([riding.first[None], log.deflections[:n]]),
        normal_force=_led(one.slider.normal_force, columns[records.KEPT_PUSH]),
        contact_share=_led(1.0, columns[records.KEPT_TOUCHING]),
        stuck_share=_led(0.0, columns[records.KEPT_STICKING]),
        rubbed=_led(0.0, columns[records.KEPT_RUBBED]),
        carried=_led(0.0, columns[records.KEPT_ALONG]),
        height=np.concatenate([riding.put_down[None, feet_own, 0], log.heights[:n, feet_own, 0]]),
        pitch=np.concatenate([riding.put_down[None, feet_own, 2], log.heights[:n, feet_own, 1]]),
        pressures=np.concatenate([riding.pressed[None, own], log.pressures[:n, own]]),
        point_offsets=feet.points[own, records.OFFSET] - (one.start - plan.onto[0].start),
        events=events,
        beam_margins=plan.margins,
        motor_margins=motor_margins(plan, one.slider),
        ledger=ledger(riding, b),
        state=MotorState(
            time=float(times[-1]),
            q=modes[0],
            rates=modes[1],
            travelled=float(feet.body[b, records.X]),
            speed=float(feet.body[b, records.V]),
            feet=feet.state[feet_own].copy(),
            touch=feet.touch[own].copy(),
        ),
    )


def _led(first: float, values: Array) -> Array:
    return np.concatenate([[first], values])


def _lost(push: Array, events: Array, times: Array) -> tuple[str, ...]:
    """Since when nothing has touched, where nothing does at the end; empty otherwise."""
    if not len(push) or push[-1] > 0.0:
        return ()
    left = events[events[:, records.EVENT_KIND] == records.LEAVES, records.EVENT_TIME]
    since = float(left[-1]) if len(left) else float(times[0])
    return (f"the slider is off the beam at the end, {times[-1]:.6g} s, and has been since {since:.6g} s",)


def _events(events: Array, points: Indices) -> Array:
    """Those of a slider's points, numbered from its first."""
    found = events[np.isin(events[:, records.EVENT_POINT], points)].copy()
    found[:, records.EVENT_POINT] -= points[0]
    return found


def motor_margins(plan: "Plan", slider: Slider) -> MotorMargins:
    """What the contact's assumptions leave out."""
    beam = plan.request.beam
    k = float(np.sqrt(plan.request.omega / beam.wave_constant))
    thickness = 2.0 * beam.surface_distance
    return MotorMargins(
        epsilon=layer_epsilon(slider, k, thickness),
        step=plan.contact_rate * plan.stages[-1].dt,
        sag=plan.sag,
        sag_taken=plan.coupling.two_way,
        chain=plan.margins.nonlinearity,
    )


def layer_epsilon(slider: Slider, wavenumber: float, thickness: float) -> float | None:
    """2 mu kappa / (kappa_t k h) of the slider's contact; 0 without give along the surface, None of a hard one."""
    contact = slider.contact
    if contact is None or contact.hard:
        return None
    across, along = (max(each(foot.length) for foot in slider.feet) for each in (contact.across, contact.along))
    return 2.0 * slider.mu * across / (along * wavenumber * thickness) if along else 0.0


def ledger(riding: Riding, b: int) -> MotorLedger:
    """Where slider b's energy went."""
    sums, before = riding.feet.sums[b], riding.at_start
    assert before is not None
    kinetic = float(riding.energy()[b, 0] - before[b, 0])
    stored = float(sums[records.STORED] - before[b, 1])
    names = {"across": records.ACROSS, "along": records.ALONG, "pressed": records.PRESSED, "pulled": records.PULLED}
    given = {name: float(sums[column]) for name, column in names.items()}
    rubbed, damped = float(sums[records.RUBBED]), float(sums[records.DAMPED])
    return MotorLedger(
        kinetic=kinetic,
        stored=stored,
        **given,
        rubbed=rubbed,
        damped=damped if riding.hard is None else 0.0,
        impacts=0.0 if riding.hard is None else damped,
        on_beam=float(sums[records.LIFTED]),
        residual=sum(given.values()) - rubbed - damped - kinetic - stored,
    )
