"""What came of a run of a slider on feet."""

from typing import TYPE_CHECKING

import numpy as np

from verify.models.arrays import Array
from verify.motion.margins import margins_of
from verify.motion.result import Statistics
from verify.motor import records
from verify.motor.result import MotorLedger, MotorMargins, MotorRun, MotorState
from verify.motor.stepping import Riding
from verify.slider import Slider

if TYPE_CHECKING:
    from verify.motor.run import Plan


def told(
    plan: "Plan",
    riding: Riding,
    stopped: str,
    modes: tuple[Array, Array],
    clock: tuple[float, float, float],
) -> MotorRun:
    """The run, with its first sample as the slider was put down; `clock` is at request, first step and end, seconds."""
    request, log, feet = plan.request, riding.log, riding.feet
    n = int(log.tally[records.SAMPLES])
    origin = plan.stages[0].origin
    times = np.concatenate([[origin], *(stage.origin + stage.sample_times for stage in plan.stages)])[: n + 1]
    columns = log.kept[:n].T
    lost = int(log.tally[records.EVENTS]) - len(log.events)
    notes = (f"events: the first {len(log.events)} of {len(log.events) + lost}",) * (lost > 0)
    began, ready, end = clock
    assert riding.first is not None
    return MotorRun(
        times=times,
        slider=plan.slider,
        start=plan.start,
        travelled=_led(float(riding.set_off[0]), columns[records.KEPT_X]),
        speed=_led(float(riding.set_off[1]), columns[records.KEPT_V]),
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
        notes=(*plan.notes, *notes),
        model=request.model,
        count=request.count,
        points=request.points,
        deflection=np.concatenate([riding.first[None], log.deflections[:n]]),
        normal_force=_led(plan.slider.normal_force, columns[records.KEPT_PUSH]),
        contact_share=_led(1.0, columns[records.KEPT_TOUCHING]),
        stuck_share=_led(0.0, columns[records.KEPT_STICKING]),
        rubbed=_led(0.0, columns[records.KEPT_RUBBED]),
        carried=_led(0.0, columns[records.KEPT_ALONG]),
        height=np.concatenate([riding.put_down[None, :, 0], log.heights[:n, :, 0]]),
        pitch=np.concatenate([riding.put_down[None, :, 2], log.heights[:n, :, 1]]),
        pressures=np.concatenate([riding.pressed[None], log.pressures[:n]]),
        point_offsets=feet.points[:, records.OFFSET],
        events=log.events[: int(log.tally[records.EVENTS])],
        beam_margins=margins_of(request, plan.stages[-1]),
        motor_margins=motor_margins(plan),
        ledger=ledger(riding),
        state=MotorState(
            time=float(times[-1]),
            q=modes[0],
            rates=modes[1],
            travelled=float(feet.body[records.X]),
            speed=float(feet.body[records.V]),
            feet=feet.state.copy(),
            touch=feet.touch.copy(),
        ),
    )


def _led(first: float, values: Array) -> Array:
    return np.concatenate([[first], values])


def motor_margins(plan: "Plan") -> MotorMargins:
    """What the contact's assumptions leave out."""
    slider, beam = plan.slider, plan.request.beam
    k = float(np.sqrt(plan.request.omega / beam.wave_constant))
    thickness = 2.0 * beam.surface_distance
    return MotorMargins(
        epsilon=layer_epsilon(slider, k, thickness),
        step=plan.contact_rate * plan.stages[-1].dt,
        sag=plan.sag,
        sag_taken=plan.coupling.two_way,
        chain=margins_of(plan.request, plan.stages[-1]).nonlinearity,
    )


def layer_epsilon(slider: Slider, wavenumber: float, thickness: float) -> float | None:
    """2 mu kappa / (kappa_t k h) of the slider's contact; 0 without give along the surface, None of a hard one."""
    contact = slider.contact
    if contact is None or contact.hard:
        return None
    across, along = (max(each(foot.length) for foot in slider.feet) for each in (contact.across, contact.along))
    return 2.0 * slider.mu * across / (along * wavenumber * thickness) if along else 0.0


def ledger(riding: Riding) -> MotorLedger:
    """Where the energy went."""
    sums = riding.feet.sums
    kinetic = riding.energy()[0] - riding.at_start[0]
    stored = float(sums[records.STORED]) - riding.at_start[1]
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
