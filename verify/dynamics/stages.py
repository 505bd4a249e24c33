"""Stages of a request: the beam in time from rest, or in its steady state."""

from typing import Any

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.dynamics.circuits import rows_on
from verify.dynamics.excitation import Forced, check_no_resonance, forced_response
from verify.dynamics.linear_system import EXACT_DEGREE, NO_READINGS, Stage, basis_of, steady_beam
from verify.dynamics.request import Request
from verify.linear.time_basis import Ratio, TimeBasis
from verify.problem.beam import Beam


def beam_in_time(request: Request) -> tuple[TimeBasis | None, list[Stage]]:
    """Free modes, None if none respond, and the stages of a run. Raises InputError, also for a resonance."""
    basis = None
    if request.start == "rest" or request.two_way:
        line = request.sliders[0].line if request.sliders else "spline"
        ports = [load for one in request.circuits for load in one.loads(request.beam)]
        loads = [*request.forces, *ports]
        basis = basis_of(request.beam, request.model, request.count, request.modes, line, loads)
    damping = request.damping_in(basis)
    if basis is None or request.start == "steady":
        return basis, [steady_stage(request, basis, damping)]
    if not request.circuits:
        check_no_resonance(basis, request.frequency_hz, damping)
    return basis, stages_from_rest(request, basis, damping)


def stages_from_rest(request: Request, basis: TimeBasis, damping: Ratio) -> list[Stage]:
    """One stage per piece of the envelope, with the quasi-static response of truncated modes."""
    forces, origin, stages = request.forces, request.origin, list[Stage]()
    rows = rows_on(basis, forces, damping, request.circuits, request.omega)
    tail = basis.tail(forces, request.frequency_hz, damping) if basis.tail and forces else None
    if tail:  # its third derivative jumps where a force acts
        basis = replace(basis, edges=np.union1d(basis.edges, [f.position for f in forces]))
    for piece in request.pieces:
        unit, envelope = piece.steps.duration, piece.coefficients
        forced = forced_response(rows, request.omega, envelope, unit, origin)
        growth = np.pad(envelope, (0, forced.forward.shape[1] - len(envelope))) if tail else envelope

        def field(x: Array, derivative: int, psi: Any, forced: Forced = forced, growth: Array = growth) -> ComplexArray:
            shapes = forced.drive_shapes(psi)  # truncated modes follow the envelope without delay
            return shapes + np.outer(growth, tail(x, derivative)) if tail else shapes

        stages.append(
            Stage(
                rows=rows,
                forced=forced,
                shapes=rows.shapes(basis),
                field=field,
                edges=_to_the_end(basis.edges, basis.beam),
                degree=basis.degree,
                omega=request.omega,
                origin=origin,
                unit_s=unit,
                envelope=envelope,
                steps=piece.steps,
                complex_rows=len(rows.rates) * bool(request.circuits),
                readings=forced.drive_shapes(rows.readings) if request.circuits else NO_READINGS,
            )
        )
        origin += unit
    return stages


def steady_stage(request: Request, basis: TimeBasis | None, damping: Ratio) -> Stage:
    """A beam in its steady state; the modes of `basis` start at rest and respond to contact forces."""
    case = request.model, request.count, request.beam, request.forces, request.frequency_hz
    state = steady_beam(*case, request.modal_damping, request.circuits)
    harmonic = state.field
    beam, degree = harmonic.beam, 3
    if harmonic.edges is not None:
        edges = harmonic.edges
    else:
        softest = max(p.mass_per_length / p.bending_stiffness for p in beam.pieces) * beam.wave_constant**2
        cells = int(np.ceil(beam.length * abs(harmonic.wavenumber) * softest**0.25 / 0.3)) + 1
        jumps = [*np.cumsum([piece.length for piece in beam.pieces[:-1]])]
        jumps += [attachment.position for attachment in beam.attached]
        jumps += [force.position for force in harmonic.forces]
        jumps += harmonic.couples
        edges, degree = np.union1d(np.linspace(0.0, beam.length, cells + 1), jumps), EXACT_DEGREE
    if basis:
        edges, degree = np.union1d(edges, basis.edges), max(degree, basis.degree)

    def field(x: Array, derivative: int, psi: Any) -> ComplexArray:
        # w'''' = k^4 w between the forces of a uniform exact beam, whose field has four derivatives
        higher, rest = divmod(derivative, 4) if harmonic.count is None and harmonic.beam.uniform else (0, derivative)
        return np.asarray(harmonic.shapes(x, rest) * harmonic.wavenumber ** (4 * higher))[None, :]

    steady = [one.voltage for one in state.actuators] + [one.current / (1j * harmonic.omega) for one in state.actuators]
    stage = Stage(
        field=field,
        edges=_to_the_end(edges, beam),
        degree=degree,
        omega=harmonic.omega,
        origin=request.origin,
        steps=request.pieces[-1].steps,
        readings=np.array([steady], dtype=complex),
    )
    if basis is None:
        return stage
    rows = rows_on(basis, (), damping, request.circuits, harmonic.omega)
    return replace(stage, rows=rows, shapes=rows.shapes(basis), complex_rows=len(rows.rates) * bool(request.circuits))


def _to_the_end(edges: Array, beam: Beam) -> Array:
    """Edges with the last one set exactly to the beam's end."""
    return np.append(edges[:-1], beam.length)
