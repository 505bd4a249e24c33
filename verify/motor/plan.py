"""The run of sliders that may leave a beam, laid out before its first step: stages, modes, coupling, step."""

from collections.abc import Sequence

import msgspec
import numpy as np

from verify.errors import InputError
from verify.models.arrays import Array
from verify.models.time_basis import TimeBasis
from verify.models.underfoot import check_one_ground, ground_at
from verify.motion.carried import steady_field
from verify.motion.contact import Coupling, Margins
from verify.motion.forcing import check_no_resonance
from verify.motion.going_on import check_same_modes
from verify.motion.margins import margins_of
from verify.motion.request import Request
from verify.motion.step_size import stepped
from verify.motion.surface import Stage, basis_of, on_ground, stages_from_rest, steady_stage
from verify.motor.coupling import coupling_of, in_words
from verify.motor.feet import Placed, check_on_beam
from verify.motor.resting import contact_rate, sag_of, weighed
from verify.motor.result import MotorState

RESOLVED = 0.5
"""Radians of the contact's own swing in a step, unless a step is given: an error of 1 % of its period."""
UNSTABLE = 2.0
SHARP = 0.5 * np.pi
"""Radians of the fastest mode in a step of a beam that feels its slider."""


class Plan(msgspec.Struct, frozen=True, eq=False, kw_only=True):
    """A run laid out, before its first step."""

    request: Request
    placed: tuple[Placed, ...]
    stages: list[Stage]
    tables: tuple[Array, ...]
    """Polynomials of every stage, (pieces, degree + 1, rows)."""
    basis: TimeBasis | None
    """None where no mode is free."""
    z: Array
    """(2, n), the free modes at the start."""
    coupling: Coupling
    contact_rate: float
    """Natural frequency of the contact, rad/s."""
    sag: float | None
    """Static deflection under what presses, metres; None of a beam that nothing holds."""
    margins: Margins
    """What the beam's own assumptions leave out."""
    notes: tuple[str, ...]


def lay_out(request: Request, placed: tuple[Placed, ...], before: Sequence[MotorState]) -> Plan:
    """The stages of a run, its modes, and how the sliders are coupled. Raises InputError."""
    for one in placed:
        check_on_beam(one.slider, request.beam, one.start)
    check_one_ground(request.beam, [one.start for one in placed])
    ground = ground_at(request.beam, placed[0].start)
    origin, basis = before[0].time if before else 0.0, _basis(request)
    stages = _stages(request, basis, origin)
    coupling = coupling_of(request, placed, stages[-1], basis)
    if coupling.two_way and basis is None:
        basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
        stages = _stages(request, basis, origin)
    rate = max(contact_rate(one, basis if coupling.two_way else None) for one in placed)
    stages = stepped(stages, _step(request, rate, stages[0], coupling.two_way))
    stages = [on_ground(stage, ground) for stage in stages]
    return Plan(
        request=request,
        placed=placed,
        stages=stages,
        tables=tuple(stage.table(0, len(stage.edges) - 1) for stage in stages),
        basis=basis,
        z=stages[0].start(*_at_start(request, stages[0], basis if coupling.two_way else None, placed, before)),
        coupling=coupling,
        contact_rate=rate,
        sag=sag_of(request, placed),
        margins=margins_of(request, stages[-1]),
        notes=_notes(request, basis, coupling, len(placed) > 1),
    )


def _at_start(
    request: Request, stage: Stage, basis: TimeBasis | None, placed: Sequence[Placed], before: Sequence[MotorState]
) -> tuple[Array, Array]:
    """(q, dq/dt) of every mode: as the run before left them, else at rest, or bent by what presses the sliders on."""
    n = len(stage.modal.squares)
    if not before:
        return (weighed(basis, placed) if basis else np.zeros(n)), np.zeros(n)
    if n or len(before[0].q):
        check_same_modes(before[0], n, request.start)
    return before[0].q, before[0].rates


def _basis(request: Request) -> TimeBasis | None:
    if request.start == "steady":
        return None
    basis = basis_of(request.beam, request.model, request.count, request.modes, "spline")
    check_no_resonance(basis, request.frequency_hz, request.damping_in(basis))
    return basis


def _stages(request: Request, basis: TimeBasis | None, origin: float) -> list[Stage]:
    if request.start == "rest":
        assert basis is not None
        damping = request.damping_in(basis)
        return stages_from_rest(basis, request.forces, request.omega, damping, request.pieces, origin)
    field = steady_field(request, request.forces)
    damping = request.damping_in(basis)
    return [steady_stage(field, request.pieces[-1].steps, origin, basis, damping)]


def _step(request: Request, rate: float, stage: Stage, two_way: bool) -> float:
    """The step, seconds: as given where it is stable, else of the drive's period, the contact's and the modes' own."""
    longest = stage.dt
    fastest = float(stage.modal.omegas.max()) if two_way and len(stage.modal.omegas) else 0.0
    if request.step is not None:
        for field, turns, most in (("contact", rate, UNSTABLE), ("fastest mode", fastest, np.pi)):
            if turns * request.step >= most:
                raise InputError(
                    f"step = {request.step!r} s is {turns * request.step:.3g} radians of the {field}'s own motion, and "
                    f"that grows without bound from {most:.3g} on: give at most {RESOLVED / turns:.3g} s"
                )
        return longest
    return min(longest, RESOLVED / rate if rate else longest, SHARP / fastest if fastest else longest)


def _notes(request: Request, basis: TimeBasis | None, coupling: Coupling, together: bool) -> tuple[str, ...]:
    modes = f"modes: {basis.method}" if basis else f"steady field of the {request.model} model, no modes"
    return modes, f"coupling: {'two' if coupling.two_way else 'one'}-way; {in_words(coupling, together)}"
