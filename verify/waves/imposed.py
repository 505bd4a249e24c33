"""What the actuators impose: forces, or displacements, which forces are then found to hold.

Under imposed displacements the beam is held at its actuators and resonates as the beam so held does. Where the beam
under forces resonates, the fields of unit forces have a pole that the held beam's have not: they are read apart there
(`poles`).
"""

from collections.abc import Callable, Sequence
from contextlib import suppress

import numpy as np
from msgspec.structs import replace

from verify.arrays import Array, ComplexArray
from verify.errors import InputError, ResonanceError
from verify.linear.fields import RESONANCE, HarmonicField, combined, phasor, unit_response
from verify.problem.beam import Beam, PointForce
from verify.waves.cancelled import check_kept
from verify.waves.poles import (
    STEP,
    Check,
    Conditions,
    UnsettledError,
    around,
    field_at_pole,
    is_near,
    is_resonant,
    large_responses,
    looked_at,
    place_that_moves,
    shares,
)

Solve = Callable[[Sequence[PointForce], float], HarmonicField]
Units = Callable[[Array, Array, Array], ComplexArray]
"""(places of unit forces, frequencies, x) -> deflection, (n_f, n_places, len(x)), NaN at a resonance."""

_SUSPECT, _SINGULAR = 1e-4, 1e-12
"""Least singular value of a receptance, beside a unit response, below which a resonance is looked for, and below
which nothing can be imposed at all."""
_FEW = 8
"""Places of many at which the size of an answer is told."""


def driven_field(solve: Solve, drives: Sequence[PointForce], frequency_hz: float, kind: str) -> HarmonicField:
    """The field under imposed forces, or under imposed displacements (amplitudes then in metres).

    `solve` gives a model's field under forces at a frequency. Displacements are held by forces at the same
    points: the receptances of unit forces make a small system. Raises InputError where two displacements are
    imposed at one point, or one at a held end, and ResonanceError at an undamped resonance of the held beam.
    """
    if kind == "force":
        return solve(drives, frequency_hz)
    loads = [[PointForce(position=drive.position)] for drive in drives]
    try:
        here = [solve(load, frequency_hz) for load in loads]
    except ResonanceError:  # of the beam under forces
        with suppress(UnsettledError):
            return _at_pole(solve, drives, frequency_hz)
        raise
    beam, places = here[0].beam, np.array([drive.position for drive in drives])
    seen, unit = looked_at(places, beam), unit_response(beam, frequency_hz)
    read = [field.shapes(seen, 0) for field in here]
    if is_near(read, [1.0] * len(here), unit, beam, frequency_hz):
        with suppress(UnsettledError):
            return _at_pole(solve, drives, frequency_hz)
    own = np.array(read)[:, : len(places)]
    if _least(own) < _SUSPECT * unit:
        up = frequency_hz * (1.0 + STEP)
        beside = [solve([PointForce(position=float(place))], up).deflection(places) for place in places]
        check_held(own, np.array(beside), places, beam, frequency_hz)
    held = np.asarray(np.linalg.solve(own.T, [phasor(drive) for drive in drives]), dtype=complex)
    check_kept(held.tolist(), read, [1.0] * len(here), unit, frequency_hz)
    return _acting(combined(list(zip(held, here, strict=True))), drives, held, frequency_hz)


class HeldResonanceError(ResonanceError):
    """An undamped beam is driven at a resonance it has when held at its actuators."""


def _at_pole(solve: Solve, drives: Sequence[PointForce], frequency_hz: float) -> HarmonicField:
    """The same at a resonance of the beam under forces, or next to one. Raises as above, and UnsettledError."""
    loads = [[PointForce(position=drive.position)] for drive in drives]
    places = np.array([drive.position for drive in drives])
    imposed = _imposed(np.array([phasor(drive) for drive in drives]).reshape(-1, 1))
    check = _refusing(places, frequency_hz)
    field, forces = field_at_pole(solve, loads, lambda _: imposed, frequency_hz, check)
    return _acting(field, drives, forces, frequency_hz)


def _imposed(displacements: ComplexArray) -> Conditions:
    """Of displacements (n, k) at n places."""
    n = len(displacements)
    return Conditions(np.zeros(n, dtype=complex), np.ones(n, dtype=complex), displacements)


def _acting(
    field: HarmonicField, drives: Sequence[PointForce], forces: ComplexArray, frequency_hz: float
) -> HarmonicField:
    """A field with the forces that act in it."""
    acting = tuple(
        PointForce(position=drive.position, amplitude=float(abs(f)), phase_deg=float(np.rad2deg(np.angle(f))))
        for drive, f in zip(drives, forces, strict=True)
    )
    return replace(field, frequency_hz=frequency_hz, forces=acting)


def _least(receptance: ComplexArray) -> Array:
    """The least singular value of (..., n, n)."""
    return np.asarray(np.linalg.svd(receptance, compute_uv=False)[..., -1])


def check_held(here: ComplexArray, beside: ComplexArray, places: Array, beam: Beam, frequency_hz: float) -> None:
    """Raise where displacements cannot be imposed, from the receptances (n, n) there and one STEP above.

    The determinant of the receptance is zero at a resonance of the held beam; its slope gives the distance.
    Raises InputError for places that are held already or equal, HeldResonanceError at an undamped resonance.
    """
    if _least(beside) < _SINGULAR * max(unit_response(beam, frequency_hz), abs(beside).max()):
        raise _not_imposed(places)
    own, other = np.linalg.det(here / abs(here).max()), np.linalg.det(beside / abs(here).max())
    if own == other:
        return  # so far below the first resonance that the determinant stands still
    distance = complex(STEP * own / (own - other))
    if not beam.loss_factor and abs(here.imag).max() < 1e-12 * abs(here).max() and abs(distance) < RESONANCE:
        raise _resonant(places, frequency_hz, distance)


def _refusing(places: Array, frequency_hz: float) -> Check:
    """What raises the same of answers read apart."""

    def check(beam: Beam, distance: complex, singular: bool) -> None:
        if singular:
            raise _not_imposed(places) from None
        if is_resonant(beam, distance):
            raise _resonant(places, frequency_hz, distance) from None

    return check


def _not_imposed(places: Array) -> InputError:
    return InputError(
        f"drive.force positions {places.tolist()}: displacements cannot be imposed at a held end or twice at one point"
    )


def _resonant(places: Array, frequency_hz: float, distance: complex) -> HeldResonanceError:
    return HeldResonanceError(
        f"frequency_hz = {frequency_hz!r} lies {abs(distance):.1e} (relative) from an undamped resonance of the "
        f"beam held at its actuators {places.tolist()} m at {frequency_hz * (1.0 + distance.real)!r} Hz: give the "
        "beam a loss_factor or choose another frequency"
    )


def held_units(units: Units, places: Array, beam: Beam, frequencies_hz: Array, x: Array) -> ComplexArray:
    """Deflection at x under a unit displacement at each place, the others at rest, (n_f, n_places, len(x)).

    `units(places, frequencies, x)` gives the same for unit forces. NaN at an undamped resonance of the held beam.
    Raises InputError for places that are held already or equal.
    """
    responses = np.array([unit_response(beam, float(f)) for f in frequencies_hz])
    found, receptance, sizes = _solved_units(units, places, frequencies_hz, x)
    near = ~(sizes <= large_responses(beam, responses, frequencies_hz))
    least = np.full(len(frequencies_hz), np.inf)
    known = np.isfinite(receptance).all(axis=(1, 2))
    least[known] = _least(receptance[known])
    suspects = np.flatnonzero(~near & (least < _SUSPECT * responses))
    if len(suspects):
        beside = units(places, frequencies_hz[suspects] * (1.0 + STEP), places)
        for i, other in zip(suspects, beside, strict=True):
            try:
                check_held(receptance[i], other, places, beam, float(frequencies_hz[i]))
            except HeldResonanceError:
                found[i] = np.nan
    for i in np.flatnonzero(near):
        with suppress(UnsettledError):
            found[i] = _units_at_pole(units, places, beam, float(frequencies_hz[i]), x)
    return found


def _solved_units(
    units: Units, places: Array, frequencies_hz: Array, x: Array
) -> tuple[ComplexArray, ComplexArray, Array]:
    """(fields of unit displacements, receptances (n_f, n, n) of unit forces, their sizes (n_f,)).

    NaN where these have a pole.
    """
    fields = units(places, frequencies_hz, np.concatenate([x, places]))
    receptance = fields[:, :, len(x) :]
    solved = np.full((len(frequencies_hz), len(places), len(x)), np.nan, dtype=complex)
    known = np.flatnonzero(np.isfinite(receptance).all(axis=(1, 2)))
    known = known[_least(receptance[known]) > 0.0]
    solved[known] = np.linalg.solve(receptance[known], fields[known, :, : len(x)])
    return solved, receptance, abs(fields[:, :, :: max(len(x) // _FEW, 1)]).max(axis=(1, 2))


def _units_at_pole(units: Units, places: Array, beam: Beam, frequency_hz: float, x: Array) -> ComplexArray:
    """The same at a resonance of the beam under forces, or next to one, (n_places, len(x)). Raises UnsettledError."""
    n, beside = len(places), np.array([frequency_hz * (1.0 + STEP)])
    a = place_that_moves(lambda acting, grid: units(acting, beside, grid)[0], beam)
    answers = units(np.append(places, a), around(frequency_hz), np.concatenate([places, x, [a]]))
    imposed = _imposed(np.eye(n, dtype=complex))
    try:
        found = shares(answers, lambda _: imposed, beam, frequency_hz, _refusing(places, frequency_hz))
    except HeldResonanceError:
        return np.full((n, len(x)), np.nan, dtype=complex)
    return np.asarray(np.einsum("frk,frx->kx", found.of_answers, answers[:, :, n:-1]))
