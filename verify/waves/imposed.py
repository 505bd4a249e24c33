"""What the actuators impose: forces, or displacements, which forces are then found to hold.

Under imposed displacements the beam is held at its actuators and resonates as the beam so held does. Where the
beam under forces resonates, the fields of unit forces have a pole that the held beam's have not: a removable
singularity, which is interpolated from four frequencies around it.
"""

from collections.abc import Callable, Sequence

import numpy as np
from msgspec.structs import replace

from verify.beam import Beam, PointForce
from verify.errors import InputError, ResonanceError
from verify.models.arrays import Array, ComplexArray
from verify.models.fields import RESONANCE, HarmonicField, combined, phasor, unit_response

Solve = Callable[[Sequence[PointForce], float], HarmonicField]
Units = Callable[[Array, Array], ComplexArray]

STEP = 1e-5
"""Relative distance of the frequencies that an interpolation or a derivative takes."""
AROUND = ((-2.0, -1.0 / 6.0), (-1.0, 4.0 / 6.0), (1.0, 4.0 / 6.0), (2.0, -1.0 / 6.0))
"""(steps, weight): exact for cubics."""
_SUSPECT, _SINGULAR = 1e-4, 1e-12
"""Least singular value of a receptance, beside a unit response, below which a resonance is looked for, and below
which nothing can be imposed at all."""


def driven_field(solve: Solve, drives: Sequence[PointForce], frequency_hz: float, kind: str) -> HarmonicField:
    """The field under imposed forces, or under imposed displacements (amplitudes then in metres).

    `solve` gives a model's field under forces at a frequency. Displacements are held by forces at the same
    points: the receptances of unit forces make a small system. Raises InputError where two displacements are
    imposed at one point, or one at a held end, and ResonanceError at an undamped resonance of the held beam.
    """
    if kind == "force":
        return solve(drives, frequency_hz)
    try:
        return _held_field(solve, drives, frequency_hz)
    except HeldResonanceError:
        raise
    except ResonanceError:
        pass  # of the beam under forces: interpolated
    fields = [(weight, _held_field(solve, drives, frequency_hz * (1.0 + s * STEP))) for s, weight in AROUND]
    return _combined(fields, drives, frequency_hz)


class HeldResonanceError(ResonanceError):
    """An undamped beam is driven at a resonance it has when held at its actuators."""


def _held_field(solve: Solve, drives: Sequence[PointForce], frequency_hz: float) -> HarmonicField:
    places = np.array([drive.position for drive in drives])

    def units(frequency: float) -> list[HarmonicField]:
        return [solve([PointForce(position=float(place))], frequency) for place in places]

    def receptance(fields: list[HarmonicField]) -> ComplexArray:
        return np.array([field.deflection(places) for field in fields])

    here = units(frequency_hz)
    own = receptance(here)
    beam = here[0].beam
    if _least(own) < _SUSPECT * unit_response(beam, frequency_hz):
        check_held(own, receptance(units(frequency_hz * (1.0 + STEP))), places, beam, frequency_hz)
    held = np.linalg.solve(own.T, [phasor(drive) for drive in drives])
    return _combined(list(zip(held, here, strict=True)), drives, frequency_hz)


def _combined(
    parts: Sequence[tuple[complex, HarmonicField]], drives: Sequence[PointForce], frequency_hz: float
) -> HarmonicField:
    """The weighted sum of fields; its forces are those that act in it."""
    acting = [
        sum(weight * phasor(force) for weight, field in parts for force in field.forces if force.position == place)
        for place in (drive.position for drive in drives)
    ]
    forces = tuple(
        PointForce(position=drive.position, amplitude=float(abs(f)), phase_deg=float(np.rad2deg(np.angle(f))))
        for drive, f in zip(drives, acting, strict=True)
    )
    return replace(combined(parts), frequency_hz=frequency_hz, forces=forces)


def _least(receptance: ComplexArray) -> Array:
    """The least singular value of (..., n, n)."""
    return np.asarray(np.linalg.svd(receptance, compute_uv=False)[..., -1])


def check_held(here: ComplexArray, beside: ComplexArray, places: Array, beam: Beam, frequency_hz: float) -> None:
    """Raise where displacements cannot be imposed, from the receptances (n, n) there and one STEP above.

    The determinant of the receptance is zero at a resonance of the held beam; its slope gives the distance.
    Raises InputError for places that are held already or equal, HeldResonanceError at an undamped resonance.
    """
    if _least(beside) < _SINGULAR * max(unit_response(beam, frequency_hz), abs(beside).max()):
        raise InputError(
            f"drive.force positions {places.tolist()}: displacements cannot be imposed at a held end or twice at "
            "one point"
        )
    own, other = np.linalg.det(here / abs(here).max()), np.linalg.det(beside / abs(here).max())
    if own == other:
        return  # so far below the first resonance that the determinant stands still
    distance = complex(STEP * own / (own - other))
    if not beam.loss_factor and abs(here.imag).max() < 1e-12 * abs(here).max() and abs(distance) < RESONANCE:
        resonance = frequency_hz * (1.0 + distance.real)
        raise HeldResonanceError(
            f"frequency_hz = {frequency_hz!r} lies {abs(distance):.1e} (relative) from an undamped resonance of the "
            f"beam held at its actuators {places.tolist()} m at {resonance!r} Hz: give the beam a loss_factor or "
            "choose another frequency"
        )


def held_units(units: Units, places: Array, beam: Beam, frequencies_hz: Array, x: Array) -> ComplexArray:
    """Deflection at x under a unit displacement at each place, the others at rest, (n_f, n_places, len(x)).

    `units(frequencies, x)` gives the same for unit forces. NaN at an undamped resonance of the held beam. Raises
    InputError for places that are held already or equal.
    """
    found, receptance = _solved_units(units, places, frequencies_hz, x)
    poles = np.flatnonzero(np.isnan(receptance).any(axis=(1, 2)))
    if len(poles):
        around = [(weight, frequencies_hz[poles] * (1.0 + steps * STEP)) for steps, weight in AROUND]
        found[poles] = sum(weight * _solved_units(units, places, f, x)[0] for weight, f in around)
    small = _SUSPECT * np.array([unit_response(beam, float(f)) for f in frequencies_hz])
    least = np.full(len(frequencies_hz), np.inf)
    known = np.isfinite(receptance).all(axis=(1, 2))
    least[known] = _least(receptance[known])
    suspects = np.flatnonzero(least < small)
    if len(suspects):
        beside = units(frequencies_hz[suspects] * (1.0 + STEP), places)
        for i, other in zip(suspects, beside, strict=True):
            try:
                check_held(receptance[i], other, places, beam, float(frequencies_hz[i]))
            except HeldResonanceError:
                found[i] = np.nan
    return found


def _solved_units(units: Units, places: Array, frequencies_hz: Array, x: Array) -> tuple[ComplexArray, ComplexArray]:
    """(fields of unit displacements, receptances (n_f, n, n) of unit forces), NaN where these have a pole."""
    fields = units(frequencies_hz, np.concatenate([x, places]))
    receptance = fields[:, :, len(x) :]
    solved = np.full((len(frequencies_hz), len(places), len(x)), np.nan, dtype=complex)
    known = np.flatnonzero(np.isfinite(receptance).all(axis=(1, 2)))
    known = known[_least(receptance[known]) > 0.0]
    solved[known] = np.linalg.solve(receptance[known], fields[known, :, : len(x)])
    return solved, receptance
