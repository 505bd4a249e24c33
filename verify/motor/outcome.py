"""Result of a run of a slider on feet, from the arrays of the kernels."""

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from verify.arrays import Array
from verify.linear.field import travelling_wavenumber
from verify.linear.surface import section_at
from verify.motion.result import Statistics
from verify.motion.slider_run import reached
from verify.motor import records
from verify.motor.result import MotorLedger, MotorMargins, MotorRun, MotorState
from verify.motor.stepping import Riding
from verify.problem.slider import Slider

if TYPE_CHECKING:
    from verify.motor.setup import Setup


class Ended(NamedTuple):
    """How a run came to its end."""

    stopped: str
    """'end', or why it ended before."""
    q: Array
    """(n,), of every free mode."""
    rates: Array
    """(n,), dq/dt."""
    set_up_s: float
    wall_s: float


def outcome(b: int, setup: "Setup", riding: Riding, ended: Ended) -> MotorRun:
    """The run of slider b, with its first sample as it was put down."""
    request, one, n = setup.request, setup.placed[b], int(riding.log.tally[records.SAMPLES])
    stages = (stage.origin + stage.sample_times for stage in setup.stages)
    times = np.concatenate([[setup.stages[0].origin], *stages])[: n + 1]
    log, feet, put, (events, notes) = riding.log, riding.feet, riding.put_down, _events(riding, b)
    own, own_feet = feet.owner == b, feet.keeper == b
    beam = section_at(request.beam, one.start)
    k = travelling_wavenumber(beam, request.frequency_hz)
    assert riding.first is not None
    return MotorRun(
        model=request.model,
        count=request.count,
        slider=one.slider,
        start=one.start,
        times=times,
        points=request.points,
        deflection=np.concatenate([riding.first[None], log.deflections[:n]]),
        **_along(b, n, one.slider, riding),
        height=np.concatenate([put[None, own_feet, records.HEIGHT], log.heights[:n, own_feet, 0]]),
        pitch=np.concatenate([put[None, own_feet, records.PITCH], log.heights[:n, own_feet, 1]]),
        pressures=np.concatenate([riding.pressed[None, own], log.pressures[:n, own]]),
        point_offsets=feet.points[own, records.OFFSET] - (one.start - setup.placed[0].start),
        events=events,
        notes=(*setup.notes, *notes),
        coupling=setup.coupling,
        beam_margins=setup.margins,
        motor_margins=MotorMargins(
            epsilon=layer_epsilon(one.slider, k, 2.0 * beam.surface_distance),
            step=setup.contact_rate * setup.stages[-1].dt,
            sag=setup.sag,
            sag_taken=setup.coupling.two_way,
            chain=setup.margins.nonlinearity,
        ),
        ledger=ledger(riding, b),
        state=MotorState(
            beam=request.beam,
            model=request.model,
            count=request.count,
            time=reached(setup.stages, riding.steps),
            q=ended.q,
            rates=ended.rates,
            steady=request.start == "steady",
            travelled=float(feet.body[b, records.X]),
            speed=float(feet.body[b, records.V]),
            feet=feet.state[own_feet].copy(),
            touch=feet.touch[own].copy(),
        ),
        statistics=Statistics(
            steps=riding.steps,
            evaluations=riding.steps,
            step_s=setup.stages[-1].dt,
            set_up_s=ended.set_up_s,
            wall_s=ended.wall_s,
            stopped=ended.stopped,
        ),
    )


def _along(b: int, n: int, slider: Slider, riding: Riding) -> dict[str, Array]:
    """What slider b did along the beam, and what its points together gave it, (n + 1,) each."""
    kept, off = riding.log.kept[:n, b].T, riding.set_off[b]
    columns = {
        "travelled": (float(off[records.X]), records.KEPT_X),
        "speed": (float(off[records.V]), records.KEPT_V),
        "friction": (0.0, records.KEPT_RUB),
        "surface_speed": (np.nan, records.KEPT_SURFACE),
        "normal_force": (slider.normal_force, records.KEPT_PUSH),
        "contact_share": (1.0, records.KEPT_TOUCHING),
        "stuck_share": (0.0, records.KEPT_STICKING),
        "rubbed": (0.0, records.KEPT_RUBBED),
        "carried": (0.0, records.KEPT_ALONG),
    }
    return {name: np.concatenate([[first], kept[column]]) for name, (first, column) in columns.items()}


def _events(riding: Riding, b: int) -> tuple[Array, tuple[str, ...]]:
    """(events of slider b's points, numbered from its first; notes on lost events and lost contact)."""
    log, feet = riding.log, riding.feet
    n, points = int(log.tally[records.EVENTS]), np.arange(feet.first[b], feet.first[b + 1])
    found = log.events[: min(n, len(log.events))]
    found = found[np.isin(found[:, records.EVENT_POINT], points)].copy()
    found[:, records.EVENT_POINT] -= feet.first[b]
    notes = [f"events: the first {len(log.events)} of {n}"] * (n > len(log.events))
    push = log.kept[: int(log.tally[records.SAMPLES]), b, records.KEPT_PUSH]
    if len(push) and push[-1] <= 0.0:
        left = found[found[:, records.EVENT_KIND] == records.LEAVES, records.EVENT_TIME]
        notes.append(f"contact: lost at the end, since {left[-1]:.6g} s" if len(left) else "contact: none")
    return found, tuple(notes)


def layer_epsilon(slider: Slider, wavenumber: float | None, thickness: float) -> float | None:
    """2 mu kappa / (kappa_t k h) of the slider's contact, of the foot where it is most.

    0 without give along the surface. None of a hard one, and of one that gives way where no wave travels.
    """
    contact = slider.contact
    if contact is None or contact.hard:
        return None
    gives = [(contact.across(foot.length), contact.along(foot.length)) for foot in slider.feet]
    if not all(along for _, along in gives):
        return 0.0
    most = max(across / along for across, along in gives)
    return 2.0 * slider.mu * most / (wavenumber * thickness) if wavenumber else None


def ledger(riding: Riding, b: int) -> MotorLedger:
    """Where slider b's energy went."""
    sums, before = riding.feet.sums[b], riding.at_start
    assert before is not None
    kinetic = float(riding.energy(0.0)[b, 0] - before[b, 0])
    stored = float(sums[records.STORED] - before[b, 1])
    names = {
        "across": records.ACROSS,
        "uphill": records.UPHILL,
        "along": records.ALONG,
        "pressed": records.PRESSED,
        "pulled": records.PULLED,
    }
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
