"""The exact harmonic field of any beam under point forces: stepped, with masses, springs, axial force, foundation.

E (1 + i eta) is the beam's material: the loss factor acts on its bending and shear stiffness, not on springs,
foundation or axial force, which lose nothing.
"""

from collections.abc import Callable, Sequence
from contextlib import suppress
from math import pi, sqrt
from typing import TypeAlias

import numpy as np

from verify.arrays import Array, ComplexArray
from verify.errors import InputError
from verify.exact.buckling import check_stable
from verify.exact.layout import Lineup, line_up, place_of
from verify.exact.roots import general_frequency_hz, trials
from verify.exact.transfer import TURN, Spans, solver, spans_of
from verify.linear.fields import RESONANCE, check_drive, phasor, refuse_resonance
from verify.problem.beam import Beam, PointForce

Read: TypeAlias = Callable[[Array, int], ComplexArray]
"""(x, derivative of any order) -> (len(x),) complex, SI."""


def general_field(
    beam: Beam, forces: Sequence[PointForce], frequency_hz: float, theory: str
) -> tuple[Read, Read | None]:
    """The field and, where the theory has one of its own, the turn. Raises InputError, for resonances too."""
    check_drive(beam, forces, frequency_hz)
    places = tuple(force.position for force in forces)
    spans, states = _under_unit_forces(beam, places, frequency_hz, theory)
    amplitudes = np.array([phasor(force) for force in forces])

    def shapes(x: Array, derivative: int) -> ComplexArray:
        return _read(beam, spans, states @ amplitudes[:, None], x, derivative)[:, 0]

    def turned(x: Array, derivative: int) -> ComplexArray:
        return _read(beam, spans, states @ amplitudes[:, None], x, derivative, TURN)[:, 0]

    return shapes, turned if theory == "timoshenko" else None


def general_responses(
    beam: Beam, positions: Sequence[float], frequency_hz: float, x: Array, theory: str
) -> ComplexArray:
    """Deflection at x under a unit force at each position, (n_positions, len(x)) complex, m/N. Raises InputError."""
    spans, states = _under_unit_forces(beam, tuple(positions), frequency_hz, theory)
    return _read(beam, spans, states, x, 0).T


def _under_unit_forces(
    beam: Beam, positions: tuple[float, ...], frequency_hz: float, theory: str
) -> tuple[Spans, ComplexArray]:
    """Spans that end at every force, and the states under each force of 1 N, (n + 1, 4, n_forces)."""
    check_stable(beam)
    line = line_up(beam, theory, positions)
    beta_length = sqrt(2.0 * pi * frequency_hz / beam.wave_constant) * beam.length
    if not beam.loss_factor:
        _refuse_resonance(beam, line_up(beam, theory), beta_length, frequency_hz, theory)
    spans = spans_of(line, beta_length**4, beam.loss_factor)
    places = line.places
    jumps = np.zeros((len(spans.ends), 4, len(positions)), dtype=complex)
    for i, position in enumerate(positions):
        at = int(np.searchsorted(spans.stretch, place_of(places, position / beam.length)))
        jumps[at, 3, i] = beam.length**3 / beam.bending_stiffness / spans.sizes[3]
    with suppress(np.linalg.LinAlgError):
        states = solver(spans)(jumps)
        if np.isfinite(states).all():
            return spans, states
    raise InputError(
        f"frequency_hz = {frequency_hz!r}: a beam that no support holds moves beyond floating point, give a higher "
        "frequency_hz or other supports"
    )


def _refuse_resonance(beam: Beam, line: Lineup, beta_length: float, frequency_hz: float, theory: str) -> None:
    """Raise ResonanceError where a frequency lies within RESONANCE of one of the beam's own."""
    say = trials(line)
    below, up_to = (say(beta_length * (1.0 + side * 0.5 * RESONANCE)).below for side in (-1, 1))
    mode = up_to - beam.rigid_motions
    if up_to > below and mode > 0:
        refuse_resonance("analytic", frequency_hz, mode, general_frequency_hz(beam, mode, theory))


def _read(beam: Beam, spans: Spans, states: ComplexArray, x: Array, derivative: int, of: int = 0) -> ComplexArray:
    """Deflections, turns or derivatives, (len(x), n), SI."""
    xi = np.minimum(np.asarray(x, dtype=float) / beam.length, 1.0)
    span, here = spans.states(states, xi)
    found = spans.derivative(span, here, derivative, of)
    return np.asarray(found / beam.length ** (derivative + of), dtype=complex)
